"""Beams against FE over the loads of a study, and which level each reaction needs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fe_drivetrain.commands.study_loads import StudyLoads
from fe_drivetrain.commands.study_measures import measures
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.compare.time_weighted import weighted_rms
from fe_drivetrain.fidelity.over_loads import (
    COARSER_ASSEMBLY,
    ROUND_OFF,
    Levels,
    reaction_history,
    relative_errors,
)
from fe_drivetrain.fidelity.shaft_bands import COARSER
from fe_drivetrain.response.entering import entering, joined
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record

ENOUGH = 0.05
"""Of the root mean square: what the study takes for accurate enough."""

SLIGHT = 1e-3
"""Of the largest reaction, a moment over the shaft's length: what is less decides no level."""

_KINDS = ("force", "moment")
_SHOWN_UNITS = 3 * ("kN",) + 3 * ("kN\u00a0m",)


def errors(
    page: Page, scene: Scene, levels: Levels, loads: StudyLoads, slopes: Sequence[float]
) -> int:
    """RMSE of each level against the assembly, and the cheapest level that is enough.

    Parameters
    ----------
    page : Page
        Takes the tables and the answer.
    scene : Scene
        The scene.
    levels : Levels
        All levels.
    loads : StudyLoads
        Hub loads.
    slopes : sequence of float
        Of S-N curves.

    Returns
    -------
    int
        The cheapest of levels 1 and 2 that is enough for all, or the more accurate one.
    """
    page.section("Beams against FE")
    others = list(levels.models)[:-1]
    hub = joined([entering(scene, history) for history in loads.histories])
    weights = loads.weights
    weight, length = scene.gearbox.weight, scene.shaft.length
    absolute: list[Record] = []
    shares: dict[str, dict[str, float]] = {}
    sizes: dict[str, float] = {}
    for name in levels.reference.reaction_matrices:
        reference = reaction_history(levels.reference, name, hub, weight, loads.gravity)
        rmse: dict[str, Floats] = {}
        relative: dict[str, Floats] = {}
        for label in others:
            found = reaction_history(levels.models[label], name, hub, weight, loads.gravity)
            rmse[label] = weighted_rms(found - reference, weights)
            relative[label] = relative_errors(reference, found, length, weights)
        size = weighted_rms(reference, weights)
        for k, kind in enumerate(_KINDS):
            if np.isnan(relative[others[0]][k]):
                continue
            shares[f"{name}, {kind}"] = {label: float(relative[label][k]) for label in others}
            sizes[f"{name}, {kind}"] = float(
                np.linalg.norm(size[3 * k : 3 * k + 3]) / (1.0, length)[k]
            )
            for c in range(3 * k, 3 * k + 3):
                if size[c] <= ROUND_OFF * size[3 * k : 3 * k + 3].max():
                    continue
                absolute.append(
                    {
                        "reaction": f"{name}, {FORCES[c]} [{_SHOWN_UNITS[c]}]",
                        "rms of FE": size[c] / 1e3,
                        **{label: rmse[label][c] / 1e3 for label in others},
                    }
                )
    rows: list[Record] = [
        {"reaction": reaction, **{label: 100.0 * share for label, share in of.items()}}
        for reaction, of in shares.items()
    ]
    page.table(
        "Error of each reaction as a vector over all load steps: root mean square of the "
        "difference to the assembly over that of the assembly's [%]",
        rows,
    )
    page.table("RMSE of each component against the assembly over all load steps", absolute)
    note = ""
    if levels.stiff:
        note = "Stiff and soft housings are the two bounds of the bearing units. "
    if COARSER_ASSEMBLY in levels.models:
        note += (
            f"The assembly on a mesh {COARSER:g} times coarser shows what the mesh does to the "
            "reference: differences as small as that are not errors of a beam. "
        )
    else:
        note += f"The mesh cannot be {COARSER:g} times coarser, so its own error is not shown. "
    slight = slight_reactions(sizes)
    if slight:
        note += (
            f"{' and '.join(slight)}: less than {100 * SLIGHT:g} % of the largest reaction "
            "(a moment over the shaft's length), by which no level is judged for all. "
        )
    page.text(f"{note}Forces and moments that are the mesh's noise are left out.")
    page.data("error_percent", rows)
    page.data("rmse_kN", absolute)
    judged = [reaction for reaction in shares if reaction not in slight]
    worst = {label: max(shares[reaction][label] for reaction in judged) for label in others}
    page.answer(_enough(worst, levels.bounds))
    _advice(page, levels, shares)
    measures(page, scene, levels, loads, slopes, ENOUGH, judged)
    # the last of each number has housings as springs, where there are housings
    sampled = {int(label[0]): label for label in levels.bounds}
    errors_of = {n: max(worst[m] for m in levels.bounds[label]) for n, label in sampled.items()}
    enough = [level for level, error in errors_of.items() if error <= ENOUGH]
    return enough[0] if enough else min(errors_of, key=lambda level: errors_of[level])


def slight_reactions(sizes: Mapping[str, float]) -> list[str]:
    """Reactions that are too small beside the largest for a level to be judged by.

    Parameters
    ----------
    sizes : Mapping[str, float]
        Root mean square of each force, and of each moment over the shaft's length [N].

    Returns
    -------
    list[str]
        Those of less than `SLIGHT` of the largest.
    """
    return [name for name, size in sizes.items() if size < SLIGHT * max(sizes.values())]


def _advice(page: Page, levels: Levels, shares: Mapping[str, Mapping[str, float]]) -> None:
    """The cheapest level for each reaction, the band of the assembly's own mesh included."""
    rows: list[Record] = []
    for reaction, of in shares.items():
        band = 0.0
        if levels.coarser is not None:
            band = float(levels.band(np.array(of[COARSER_ASSEMBLY])))
        found = {
            label: max(of[model] for model in models) for label, models in levels.bounds.items()
        }
        enough = [label for label, error in found.items() if error + band <= ENOUGH]
        needed = enough[0] if enough else "4 assembly of solids"
        if not enough and band > ENOUGH:
            needed = "none: a finer mesh of the assembly"
        rows.append(
            {
                "reaction": reaction,
                "level that it needs": needed,
                "error of that level [%]": 100.0 * found[enough[0]] if enough else None,
                "± mesh of the assembly [%]": None if levels.coarser is None else 100.0 * band,
            }
        )
    page.table(
        f"The cheapest level that has each reaction within {100 * ENOUGH:g} % over these loads"
        + (", for either bound of the housings" if levels.stiff else ""),
        rows,
    )
    page.text(
        "'fe-drivetrain advise' answers for one quantity and another tolerance, ranks the details "
        "of the scene, and says what each level takes."
    )
    page.data("advice", rows)


def _enough(worst: Mapping[str, float], bounds: Mapping[str, Sequence[str]]) -> str:
    """The cheapest level whose reactions are all within the tolerance, for either bound."""
    share = f"{100 * ENOUGH:g} %"
    for labels in bounds.values():
        largest = max(worst[label] for label in labels)
        if largest <= ENOUGH:
            return (
                f"Over these loads {' and '.join(labels)} {'is' if len(labels) == 1 else 'are'} "
                f"enough: every reaction is within "
                f"{share} of the assembly's (root mean square of force and of moment; the worst "
                f"{100 * largest:.2g} %)."
            )
    # a level is as good as the worse of its bounds
    by_level = {level: max(worst[label] for label in labels) for level, labels in bounds.items()}
    best = min(by_level, key=lambda level: by_level[level])
    return (
        f"Over these loads no level below the assembly has every reaction within {share} of it; "
        f"the nearest, {' and '.join(bounds[best])}, is within {100 * by_level[best]:.2g} %."
    )
