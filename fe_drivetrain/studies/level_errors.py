"""Errors of each level against the assembly over load histories, and the level that is enough."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.components import FORCES
from fe_drivetrain.comparison.time_weighted import weighted_rms
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.judgement import Judged, Judgement, is_within
from fe_drivetrain.shafts.fidelity.over_loads import (
    COARSER_ASSEMBLY,
    ROUND_OFF,
    Levels,
    reaction_history,
    relative_errors,
)
from fe_drivetrain.studies.shown_units import SHOWN_UNITS
from fe_drivetrain.studies.study_loads import EnteredLoads

ENOUGH = 0.05
"""Share of the root mean square that the study takes for accurate enough."""

_KINDS = ("force", "moment")


@dataclass(frozen=True)
class ComponentError:
    """Error of each model in one component of a reaction.

    Attributes
    ----------
    reaction, component : str
        Name of a bearing, or "gearbox", and "Fx" to "Mz".
    rms : float
        Root mean square of the assembly's [N, N m].
    rmse : Mapping[str, float]
        Root mean square of the difference to the assembly's, by model [N, N m].
    """

    reaction: str
    component: str
    rms: float
    rmse: Mapping[str, float]

    def row(self) -> Record:
        """A row of a table [kN, kN m]."""
        unit = SHOWN_UNITS[FORCES.index(self.component)]
        return {
            "reaction": f"{self.reaction}, {self.component} [{unit}]",
            "rms of FE": self.rms / 1e3,
            **{model: error / 1e3 for model, error in self.rmse.items()},
        }


@dataclass(frozen=True)
class VectorError:
    """Error of each model in the force or the moment of a reaction, as a vector.

    Attributes
    ----------
    reaction, kind : str
        Name of a bearing, or "gearbox", and "force" or "moment".
    shares : Mapping[str, float]
        Error over the assembly's, by model.
    """

    reaction: str
    kind: str
    shares: Mapping[str, float]

    @property
    def name(self) -> str:
        """What it is of, as tables have it."""
        return f"{self.reaction}, {self.kind}"

    def row(self) -> Record:
        """A row of a table [%]."""
        shares = {model: 100.0 * share for model, share in self.shares.items()}
        return {"reaction": self.name, **shares}


@dataclass(frozen=True)
class LevelErrors:
    """Errors of all levels over load histories.

    Attributes
    ----------
    components : tuple of ComponentError
        Each component of each reaction that is more than round-off.
    vectors : tuple of VectorError
        Force and moment of each reaction, where they are more than round-off.
    judged : Sequence[Judged]
        Each reaction at the levels below the assembly, the worse bound of the housings counting.
    """

    components: tuple[ComponentError, ...]
    vectors: tuple[VectorError, ...]
    judged: Sequence[Judged]


def level_errors(scene: Scene, levels: Levels, loads: EnteredLoads) -> LevelErrors:
    """Errors of all levels against the assembly over all load steps.

    Parameters
    ----------
    scene : Scene
        The scene.
    levels : Levels
        All levels.
    loads : EnteredLoads
        Hub loads.
    """
    others, weights = list(levels.models)[:-1], loads.given.weights
    components: list[ComponentError] = []
    vectors: list[VectorError] = []
    judged: list[Judged] = []
    for name in levels.reference.reaction_matrices:
        histories = {
            label: reaction_history(
                model, name, loads.together, scene.gearbox.weight, loads.given.gravity
            )
            for label, model in levels.models.items()
        }
        (*_, reference) = histories.values()
        size = weighted_rms(reference, weights)
        rmse = {m: weighted_rms(histories[m] - reference, weights) for m in others}
        relative = {
            m: relative_errors(reference, histories[m], scene.shaft.length, weights) for m in others
        }
        for k, kind in enumerate(_KINDS):
            if np.isnan(relative[others[0]][k]):
                continue
            of = VectorError(name, kind, {m: float(relative[m][k]) for m in others})
            own = size[3 * k : 3 * k + 3]
            vectors.append(of)
            judged.append(_judged(of, float(np.linalg.norm(own)), levels))
            components += [
                ComponentError(
                    name, FORCES[c], float(size[c]), {m: float(rmse[m][c]) for m in others}
                )
                for c in range(3 * k, 3 * k + 3)
                if size[c] > ROUND_OFF * own.max()
            ]
    return LevelErrors(tuple(components), tuple(vectors), judged)


def _judged(of: VectorError, size: float, levels: Levels) -> Judged:
    """A reaction at each level below the assembly: the worse of both bounds of the housings."""
    by_level = {level: max(of.shares[m] for m in models) for level, models in levels.bounds.items()}
    band = 0.0
    if levels.coarser is not None:
        band = float(levels.band(np.array(of.shares[COARSER_ASSEMBLY])))
    return Judged(of.name, of.kind, size, by_level, band)


def needed_levels(judged: Sequence[Judged], with_band: bool) -> list[Record]:
    """The cheapest level for each reaction, the band of the assembly's own mesh included.

    Parameters
    ----------
    judged : sequence of Judged
        Reactions with their errors at each level.
    with_band : bool
        Whether the band of the assembly's mesh is known.
    """
    rows: list[Record] = []
    for reaction in judged:
        level = reaction.cheapest(ENOUGH)
        needed = level or "4 assembly of solids"
        if not is_within(0.0, reaction.band, ENOUGH):
            needed = "none: a finer mesh of the assembly"
        rows.append(
            {
                "reaction": reaction.name,
                "level that it needs": needed,
                "error of that level [%]": 100.0 * reaction.errors[level] if level else None,
                "± mesh of the assembly [%]": 100.0 * reaction.band if with_band else None,
            }
        )
    return rows


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
