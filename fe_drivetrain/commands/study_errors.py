"""Beams against FE over the loads of a study, and which level each reaction needs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.commands.study_loads import StudyLoads
from fe_drivetrain.commands.study_measures import measures
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.compare.time_weighted import weighted_rms
from fe_drivetrain.fidelity.judgement import Judged, Judgement, is_within, judge_levels
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
"""Share of the root mean square that the study takes for accurate enough."""

_KINDS = ("force", "moment")
_SHOWN_UNITS = 3 * ("kN",) + 3 * ("kN\u00a0m",)


@dataclass(frozen=True)
class LevelErrors:
    """Errors of all levels over load histories.

    Attributes
    ----------
    components : Sequence[Record]
        RMSE of each component of each reaction.
    shares : Mapping[str, Mapping[str, float]]
        By reaction and model: error of the force or moment as a vector, relative.
    judged : Sequence[Judged]
        Each reaction at the levels below the assembly, the worse bound of the housings counting.
    """

    components: Sequence[Record]
    shares: Mapping[str, Mapping[str, float]]
    judged: Sequence[Judged]


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
    found = level_errors(scene, levels, loads)
    judgement = judge_levels(found.judged, ENOUGH, scene.shaft.length)
    rows: list[Record] = [
        {"reaction": reaction, **{label: 100.0 * share for label, share in of.items()}}
        for reaction, of in found.shares.items()
    ]
    page.table(
        "Error of each reaction as a vector over all load steps: root mean square of the "
        "difference to the assembly over that of the assembly's [%]",
        rows,
    )
    page.table("RMSE of each component against the assembly over all load steps", found.components)
    page.text(_notes(levels, judgement))
    page.data("error_percent", rows)
    page.data("rmse_kN", list(found.components))
    page.answer(enough(judgement, levels.bounds))
    _advice(page, levels, found.judged)
    judged = [q.name for q in found.judged if q not in judgement.slight]
    measures(page, scene, levels, loads, slopes, ENOUGH, judged)
    return int(judgement.nearest[0])


def level_errors(scene: Scene, levels: Levels, loads: StudyLoads) -> LevelErrors:
    """Errors of all levels against the assembly over all load steps.

    Parameters
    ----------
    scene : Scene
        The scene.
    levels : Levels
        All levels.
    loads : StudyLoads
        Hub loads.
    """
    others = list(levels.models)[:-1]
    hub = joined([entering(scene, history) for history in loads.histories])
    components: list[Record] = []
    shares: dict[str, dict[str, float]] = {}
    judged: list[Judged] = []
    for name in levels.reference.reaction_matrices:
        histories = {
            label: reaction_history(model, name, hub, scene.gearbox.weight, loads.gravity)
            for label, model in levels.models.items()
        }
        (*_, reference) = histories.values()
        size = weighted_rms(reference, loads.weights)
        rmse = {m: weighted_rms(histories[m] - reference, loads.weights) for m in others}
        relative = {
            m: relative_errors(reference, histories[m], scene.shaft.length, loads.weights)
            for m in others
        }
        for k, kind in enumerate(_KINDS):
            if np.isnan(relative[others[0]][k]):
                continue
            of = {m: float(relative[m][k]) for m in others}
            shares[f"{name}, {kind}"] = of
            own = size[3 * k : 3 * k + 3]
            judged.append(_judged(f"{name}, {kind}", kind, float(np.linalg.norm(own)), of, levels))
            components += [
                {
                    "reaction": f"{name}, {FORCES[c]} [{_SHOWN_UNITS[c]}]",
                    "rms of FE": size[c] / 1e3,
                    **{m: rmse[m][c] / 1e3 for m in others},
                }
                for c in range(3 * k, 3 * k + 3)
                if size[c] > ROUND_OFF * own.max()
            ]
    return LevelErrors(components, shares, judged)


def _judged(
    name: str, kind: str, size: float, shares: Mapping[str, float], levels: Levels
) -> Judged:
    """A reaction at each level below the assembly: the worse of both bounds of the housings."""
    by_level = {level: max(shares[m] for m in models) for level, models in levels.bounds.items()}
    band = 0.0
    if levels.coarser is not None:
        band = float(levels.band(np.array(shares[COARSER_ASSEMBLY])))
    return Judged(name, kind, size, by_level, band)


def _notes(levels: Levels, judgement: Judgement) -> str:
    """Notes on the tables: bounds, what the mesh does, and what does not decide."""
    notes = []
    if levels.stiff:
        notes.append("Stiff and soft housings are the two bounds of the bearing units.")
    if COARSER_ASSEMBLY in levels.models:
        notes.append(
            f"The assembly on a mesh {COARSER:g} times coarser shows what the mesh does to the "
            "reference: differences as small as that are not errors of a beam."
        )
    else:
        notes.append(f"The mesh cannot be {COARSER:g} times coarser: its own error is not shown.")
    if judgement.slight:
        slight = "; ".join(q.words(judgement.largest[q.kind]) for q in judgement.slight)
        notes.append(f"Too small beside the largest of their kind to judge a level by: {slight}.")
    notes.append("Forces and moments that are the mesh's noise are left out.")
    return " ".join(notes)


def _advice(page: Page, levels: Levels, judged: Sequence[Judged]) -> None:
    """The cheapest level for each reaction, the band of the assembly's own mesh included."""
    rows: list[Record] = []
    for reaction in judged:
        level = reaction.cheapest(ENOUGH)
        needed = level or "4 assembly of solids"
        if not is_within(0.0, reaction.band, ENOUGH):
            needed = "none: a finer mesh of the assembly"
        band = None if levels.coarser is None else 100.0 * reaction.band
        rows.append(
            {
                "reaction": reaction.name,
                "level that it needs": needed,
                "error of that level [%]": 100.0 * reaction.errors[level] if level else None,
                "± mesh of the assembly [%]": band,
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


def enough(judgement: Judgement, bounds: Mapping[str, Sequence[str]]) -> str:
    """Sentence on the cheapest level whose deciding reactions are all within the tolerance.

    Parameters
    ----------
    judgement : Judgement
        Judgement of the levels below the assembly.
    bounds : Mapping[str, Sequence[str]]
        Names of the models of each level.
    """
    share = f"{100 * judgement.tolerance:g} %"
    models = bounds[judgement.nearest]
    if judgement.level is None:
        return (
            f"Over these loads no level below the assembly has every reaction within {share} of "
            f"it; at the nearest, {' and '.join(models)}, {judgement.failure()}."
        )
    return (
        f"Over these loads {' and '.join(models)} {'is' if len(models) == 1 else 'are'} enough: "
        f"every reaction that counts is within {share} of the assembly's; the worst, "
        f"{judgement.failure()}."
    )
