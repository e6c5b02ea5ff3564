"""Statistics of reactions over load histories: extremes, means, damage-equivalent loads, bands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.comparison.time_weighted import weighted_statistics
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.ladder import LevelModel
from fe_drivetrain.shafts.fidelity.over_loads import Levels, reaction_history
from fe_drivetrain.studies.shown_units import SHOWN_UNITS
from fe_drivetrain.studies.study_loads import EnteredLoads
from fe_drivetrain.turbine_loads.histories.cycles import Cycles, rainflow_cycles
from fe_drivetrain.turbine_loads.histories.damage import damage_equivalent_load
from fe_drivetrain.turbine_loads.histories.windows import COLUMNS

_ROUND_OFF = 1e-9  # of a reaction's largest component: shown as zero


@dataclass(frozen=True, eq=False)
class Statistics:
    """Statistics of one reaction over all histories together, or over one of them.

    Attributes
    ----------
    values : ndarray, (6, 4)
        Min, mean, max, standard deviation of each component [N, N m].
    band : ndarray, (6,) or None
        What the mesh may change of any of these [N, N m]; None where it is not known.
    equivalent : ndarray, (6, s)
        Ranges of the damage-equivalent loads for s slopes [N, N m].
    """

    values: Floats
    band: Floats | None
    equivalent: Floats

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class ReactionStatistics:
    """Statistics of one reaction.

    Attributes
    ----------
    whole : Statistics
        Over all histories together, each sample by the time that it stands for.
    by_history : tuple of Statistics
        Over each history, in their order.
    """

    whole: Statistics
    by_history: tuple[Statistics, ...]


def reaction_statistics(
    name: str,
    scene: Scene,
    levels: Levels,
    loads: EnteredLoads,
    slopes: Sequence[float],
) -> ReactionStatistics:
    """Statistics of one reaction of the assembly.

    Parameters
    ----------
    name : str
        Name of a bearing, or "gearbox".
    scene : Scene
        The scene.
    levels : Levels
        The assembly, and one on a coarser mesh, which the band comes from.
    loads : EnteredLoads
        Hub loads, each history with its own time.
    slopes : sequence of float
        Slopes of S-N curves.
    """
    weight, gravity = scene.gearbox.weight, loads.given.gravity

    def histories_of(level: LevelModel) -> list[Floats]:
        return [reaction_history(level, name, one, weight, gravity) for one in loads.each]

    samples = histories_of(levels.reference)
    coarse = None if levels.coarser is None else histories_of(levels.coarser)
    least = _ROUND_OFF * max(float(np.abs(part).max()) for part in samples)
    cycles = [[_cycles(c, least) for c in part.T] for part in samples]

    def over(chosen: Sequence[int], weights: Floats, seconds: float) -> Statistics:
        fine = weighted_statistics(np.concatenate([samples[k] for k in chosen]), weights)
        band = None
        if coarse is not None:
            other = weighted_statistics(np.concatenate([coarse[k] for k in chosen]), weights)
            band = levels.band(other - fine).max(axis=1)
        equivalent = [
            [damage_equivalent_load([cycles[k][c] for k in chosen], seconds, m) for m in slopes]
            for c in range(6)
        ]
        return Statistics(fine, band, np.reshape(equivalent, (6, len(slopes))))

    histories = loads.given.histories
    return ReactionStatistics(
        over(range(len(histories)), loads.given.weights, loads.given.seconds),
        tuple(
            over([k], np.full(len(history), 1.0 / len(history)), history.seconds)
            for k, history in enumerate(histories)
        ),
    )


def peak_across(name: str, of: Statistics) -> tuple[str, float, float | None]:
    """Peak of the force across the shaft: the component and the end that are farthest from zero.

    Parameters
    ----------
    name : str
        Name of a bearing.
    of : Statistics
        Statistics of its reaction.

    Returns
    -------
    quantity : str
        What it is, with its unit.
    peak, band : float, float or None
        Value with its sign, and what the mesh may change of it [kN].
    """
    component = component_across(of)
    row = FORCES.index(component)
    ends = of.values[row, [0, 2]]
    band = None if of.band is None else float(of.band[row]) / 1e3
    return f"peak {component} on {name} [kN]", float(ends[np.abs(ends).argmax()]) / 1e3, band


def component_across(of: Statistics) -> str:
    """Which force across the shaft comes farthest from zero, "Fy" or "Fz".

    Parameters
    ----------
    of : Statistics
        Statistics of a reaction.
    """
    farthest = np.abs(of.values[1:3][:, [0, 2]]).max(axis=1)
    return FORCES[1 + int(farthest.argmax())]


def _cycles(samples: Floats, least: float) -> Cycles:
    """Rainflow cycles; none where a component is round-off beside the others."""
    if np.ptp(samples) <= least:
        return Cycles(np.zeros(0), np.zeros(0), np.zeros(0))
    return rainflow_cycles(samples)


def statistics_rows(name: str, found: Statistics, slopes: Sequence[float]) -> list[Record]:
    """Records of the components of one reaction [kN, kN m], round-off as zero.

    Parameters
    ----------
    name : str
        Name of the reaction.
    found : Statistics
        Its statistics.
    slopes : sequence of float
        Slopes of S-N curves.
    """
    least = _ROUND_OFF * float(np.abs(found.values).max())
    shown = np.where(np.abs(found.values) < least, 0.0, found.values) / 1e3
    return [
        {
            "reaction": name,
            "component": f"{component} [{unit}]",
            **dict(zip(COLUMNS, shown[c].tolist(), strict=True)),
            "± mesh": None if found.band is None else float(found.band[c]) / 1e3,
            **{
                f"DEL, m = {m:g}": value / 1e3
                for m, value in zip(slopes, found.equivalent[c].tolist(), strict=True)
            },
        }
        for c, (component, unit) in enumerate(zip(FORCES, SHOWN_UNITS, strict=True))
    ]
