"""Beams against FE in the measures of design: means, extremes, time at level, damage."""

import numpy as np

from fe_drivetrain.cases.main_bearing.comparison import Comparison
from fe_drivetrain.common import Floats
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.histories import (
    Measured,
    damage_ratio,
    good_enough_for,
    measured,
    model_errors,
)
from fe_drivetrain.turbine_loads.hub_loads import HubLoadSet

WITHIN = 0.05
SLOPES = (3.0, 4.0, 10.0)


def section(run: Run, page: Page, hub: HubLoadSet, found: Comparison) -> None:
    """Errors of each beam by measure, and what each is good enough for.

    Parameters
    ----------
    run : Run
        The run that this is a step of.
    page : Page
        Takes the table and the answer.
    hub : HubLoadSet
        The histories.
    found : Comparison
        Reactions of FE and beams.
    """
    steps = len(hub) * [float(np.median(np.diff(hub.time)))]

    def radial(reaction: Floats) -> Measured:
        return measured(list(np.hypot(reaction[..., 1], reaction[..., 2])), steps, SLOPES)

    with run.step("damage, extremes, time at level"):
        truth = {kind: radial(reaction) for kind, reaction in found.fe.items()}
        models = {id(model): model for _, model in found.pairs.values()}  # two are of one beam
        of_model = {key: radial(model) for key, model in models.items()}
        errors = {
            label: model_errors(of_model[id(model)], truth[kind])
            for label, (kind, model) in found.pairs.items()
        }
    rows: list[Record] = [
        {
            "comparison": label,
            **{f"{what} [%]": 100.0 * error for what, error in own.items()},
            f"damage over that of FE, m = {SLOPES[-1]:g}": damage_ratio(
                own[f"DEL, m = {SLOPES[-1]:g}"], SLOPES[-1]
            ),
        }
        for label, own in errors.items()
    ]
    page.section("For means, extremes and fatigue")
    page.table(
        "Resultant radial force on the main bearing over all histories together, beam against FE: "
        "difference of means and area between the load durations over the mean of FE; extreme and "
        "damage-equivalent load (DEL, 1 Hz, rainflow after ASTM E1049) over those of FE, less one",
        rows,
    )
    page.data("design_measures", rows)
    on_bonded = {label: own for label, own in errors.items() if found.pairs[label][0] == "bonded"}
    enough = good_enough_for(on_bonded, WITHIN)
    words = [f"for {use}: {label or 'none'}" for use, label in enough.items()]
    page.answer(
        f"Good enough within {100 * WITHIN:g} % on a bonded bearing, the cheapest is "
        f"{'; '.join(words)} (fatigue: damage-equivalent loads of slopes "
        f"{', '.join(f'{m:g}' for m in SLOPES)})."
    )
    steepest = f"DEL, m = {SLOPES[-1]:g}"
    page.text(
        "What an error of the mean says of damage: "
        + "; ".join(
            f"{label}: {100 * abs(own['mean']):.2g} % in the mean, "
            f"{100 * abs(damage_ratio(own[steepest], SLOPES[-1]) - 1.0):.2g} % in damage at "
            f"m = {SLOPES[-1]:g}"
            for label, own in list(on_bonded.items())[1:]
        )
        + "."
    )
