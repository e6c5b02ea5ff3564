"""Beams against FE in the measures of design: means, extremes, time at level, damage."""

import numpy as np

from fe_drivetrain.cases.main_bearing.comparison import Comparison
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import statistics
from fe_drivetrain.report.suite import Page, Run
from fe_drivetrain.studies.design_measures import DesignMeasures, load_errors
from fe_drivetrain.studies.level_errors import ENOUGH
from fe_drivetrain.turbine_loads.histories import damage_ratio, good_enough_for
from fe_drivetrain.turbine_loads.histories.damage import SLOPES
from fe_drivetrain.turbine_loads.hub_loads import HubLoadSet

REACTION = "radial force on the main bearing"


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
    with run.step("damage, extremes, time at level"):
        measures = measured_beams(hub, found)
    page.section("For means, extremes and fatigue")
    rows = measures.rows(SLOPES)
    page.table(
        "Resultant radial force on the main bearing over all histories together, beam against FE: "
        "difference of means and area between the load durations over the mean of FE; extreme and "
        "damage-equivalent load (DEL, 1 Hz, rainflow after ASTM E1049) over those of FE, less one",
        rows,
    )
    page.data("design_measures", rows)
    words = [f"for {use}: {label or 'none'}" for use, label in measures.enough.items()]
    page.say(
        f"Good enough within {100 * measures.tolerance:g} % on a bonded bearing, the cheapest is "
        f"{'; '.join(words)} (fatigue: damage-equivalent loads of slopes "
        f"{', '.join(f'{m:g}' for m in SLOPES)})."
    )
    page.text(f"What an error of the mean says of damage: {mean_and_damage(measures, found)}.")


def measured_beams(hub: HubLoadSet, found: Comparison) -> DesignMeasures:
    """Errors of each comparison, and the cheapest beam that is enough on a bonded bearing."""
    steps = len(hub) * [float(np.median(np.diff(hub.time)))]

    def radial(reaction: Floats) -> list[Floats]:
        return list(statistics.resultant(reaction[..., 1], reaction[..., 2]))

    of_kind = {
        kind: load_errors(
            radial(fe),
            {label: [radial(model)] for label, (of, model) in found.pairs.items() if of == kind},
            steps,
            SLOPES,
        )
        for kind, fe in found.fe.items()
    }
    errors = {label: {REACTION: of_kind[kind][label]} for label, (kind, _) in found.pairs.items()}
    return DesignMeasures(errors, good_enough_for(of_kind["bonded"], ENOUGH), ENOUGH, len(hub))


def mean_and_damage(measures: DesignMeasures, found: Comparison) -> str:
    """Errors of the mean and of damage of the beams with a stiffness, in words."""
    slope = SLOPES[-1]
    bonded = [label for label, (kind, _) in found.pairs.items() if kind == "bonded"]
    return "; ".join(
        f"{label}: {100 * abs(own['mean']):.2g} % in the mean, "
        f"{100 * abs(damage_ratio(own[f'DEL, m = {slope:g}'], slope) - 1.0):.2g} % in damage at "
        f"m = {slope:g}"
        for label, own in ((label, measures.errors[label][REACTION]) for label in bonded[1:])
    )
