"""Levels against the assembly in the measures of design: means, extremes, durations, damage."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.ladder import LevelModel
from fe_drivetrain.shafts.fidelity.over_loads import (
    ROUND_OFF,
    Levels,
    reaction_history,
)
from fe_drivetrain.studies.study_loads import EnteredLoads
from fe_drivetrain.turbine_loads.histories.model_errors import (
    USES,
    damage_ratio,
    good_enough_for,
    measured,
    model_errors,
)

_MAXIMUM = 12
"""Histories that are counted, evenly over all: a count takes longer than a reaction."""


@dataclass(frozen=True, eq=False)
class DesignMeasures:
    """Errors of levels in the measures that a part is designed for.

    Attributes
    ----------
    errors : Mapping[str, Mapping[str, Mapping[str, float]]]
        By level and reaction, as "front, Fz": error of each measure, as a share; NaN where there
        is no such load.
    enough : Mapping[str, str or None]
        By use, as "fatigue": the cheapest level within the tolerance; None where there is none.
    tolerance : float
        What is good enough, as a share.
    histories : int
        Number of histories that were counted.
    """

    errors: Mapping[str, Mapping[str, Mapping[str, float]]]
    enough: Mapping[str, str | None]
    tolerance: float
    histories: int

    def sentence(self) -> str:
        """Which level is good enough for means, extremes and fatigue, and what fails."""
        failures = {
            use: failure(self.errors, use) for use, level in self.enough.items() if level is None
        }
        return sentence(self.enough, failures, self.tolerance)

    def rows(self, slopes: Sequence[float]) -> list[Record]:
        """Records of the errors of each reaction at each level [%], and of damage.

        Parameters
        ----------
        slopes : sequence of float
            Slopes of S-N curves; damage is that of the last one.
        """
        reactions = dict.fromkeys(name for own in self.errors.values() for name in own)
        return [
            {
                "reaction": reaction,
                "level": level,
                **{f"{what} [%]": 100.0 * e for what, e in own[reaction].items()},
                **{
                    f"damage over it, m = {m:g}": damage_ratio(own[reaction][f"DEL, m = {m:g}"], m)
                    for m in list(slopes)[-1:]
                },
            }
            for reaction in reactions
            for level, own in self.errors.items()
        ]


def design_measures(
    scene: Scene,
    levels: Levels,
    loads: EnteredLoads,
    slopes: Sequence[float],
    within: float,
    judged: Collection[str],
) -> DesignMeasures:
    """Errors of each level by measure, of the component across the shaft that varies most.

    Parameters
    ----------
    scene : Scene
        The scene.
    levels : Levels
        All levels.
    loads : EnteredLoads
        Hub loads.
    slopes : sequence of float
        Slopes of S-N curves.
    within : float
        What is good enough, as a share.
    judged : collection of str
        Reactions by which levels are judged: "NAME, force" and "NAME, moment".
    """
    count = len(loads.each)
    chosen = np.unique(np.linspace(0, count - 1, min(count, _MAXIMUM)).astype(int))
    steps = [loads.given.histories[k].step for k in chosen]
    weight, gravity = scene.gearbox.weight, loads.given.gravity

    def histories_of(model: LevelModel, name: str) -> list[Floats]:
        return [reaction_history(model, name, loads.each[k], weight, gravity) for k in chosen]

    worst: dict[str, dict[str, float]] = {level: {} for level in levels.bounds}
    seen: dict[str, dict[str, Mapping[str, float]]] = {level: {} for level in levels.bounds}
    for name in levels.reference.reaction_matrices:
        reference = histories_of(levels.reference, name)
        models = {
            m: histories_of(levels.models[m], name) for own in levels.bounds.values() for m in own
        }
        for kind, first in (("force", 1), ("moment", 4)):
            c = _varying(reference, first) if f"{name}, {kind}" in judged else None
            if c is None:
                continue
            of_levels = {
                level: [[h[:, c] for h in models[m]] for m in own]
                for level, own in levels.bounds.items()
            }
            found = load_errors([h[:, c] for h in reference], of_levels, steps, slopes)
            for level, errors in found.items():
                worst[level] = _larger([worst[level], errors])
                seen[level][f"{name}, {FORCES[c]}"] = errors
    return DesignMeasures(seen, good_enough_for(worst, within), within, len(chosen))


def _varying(reference: Sequence[Floats], first: int) -> int | None:
    """The component across the shaft that varies most; None where the support holds neither."""
    whole = np.concatenate(reference)
    spread = whole[:, first : first + 2].std(axis=0)
    return None if spread.max() <= ROUND_OFF * np.abs(whole).max() else first + int(spread.argmax())


def load_errors(
    reference: Sequence[Floats],
    models: Mapping[str, Sequence[Sequence[Floats]]],
    steps: Sequence[float],
    slopes: Sequence[float],
) -> dict[str, dict[str, float]]:
    """Errors of models of one load by what a part is designed for.

    Parameters
    ----------
    reference : sequence of ndarray, (n,)
        The load in each history.
    models : mapping
        By level: the same histories by each of its models, the worst of which counts.
    steps : sequence of float
        Step of each history [s].
    slopes : sequence of float
        Slopes of S-N curves.

    Returns
    -------
    dict
        By level and measure, as shares; see `fe_drivetrain.turbine_loads.histories.model_errors`.
    """
    truth = measured(reference, steps, slopes)
    return {
        level: _larger([model_errors(measured(m, steps, slopes), truth) for m in own])
        for level, own in models.items()
    }


def failure(seen: Mapping[str, Mapping[str, Mapping[str, float]]], use: str) -> str:
    """What keeps every level from being good enough for a use: the reaction, and its error.

    Parameters
    ----------
    seen : mapping
        By level and reaction: errors by measure, as shares; NaN where there is no such load.
    use : str
        A key of `fe_drivetrain.turbine_loads.histories.model_errors.USES`.

    Returns
    -------
    str
        The worst error of the level whose worst error is least.
    """
    found = [
        max(
            (abs(error), f"{reaction}: {100 * error:+.2g} % in the {measure} at {level}")
            for reaction, errors in reactions.items()
            for measure, error in errors.items()
            if measure.startswith(USES[use]) and not np.isnan(error)
        )
        for level, reactions in seen.items()
    ]
    return min(found)[1]


def sentence(found: Mapping[str, str | None], failures: Mapping[str, str], within: float) -> str:
    """Which model is good enough for means, extremes and fatigue.

    Parameters
    ----------
    found : mapping
        Model by use, from `good_enough_for`.
    failures : mapping
        By use for which there is none: see `failure`.
    within : float
        The tolerance, as a share.
    """
    share = f"{100 * within:g} %"
    if not any(found.values()):
        return (
            "For the component across the shaft that varies most in each reaction, no level below "
            f"the assembly has the mean, extreme, or damage-equivalent load within {share}: none "
            f"is good enough for means, extremes or fatigue ({failures['fatigue']})."
        )
    words = [f"for {use} {model or f'none ({failures[use]})'}" for use, model in found.items()]
    return (
        f"For the component across the shaft that varies most in each reaction, the cheapest level "
        f"within {share} of the assembly is {'; '.join(words)} (fatigue: damage-equivalent loads "
        "of every slope)."
    )


def _larger(errors: Sequence[Mapping[str, float]]) -> dict[str, float]:
    """The largest of several errors of each measure, by size; NaN only where all are."""
    names = dict.fromkeys(name for own in errors for name in own)
    found = {}
    for name in names:
        known = [own[name] for own in errors if name in own and not np.isnan(own[name])]
        found[name] = max(known, key=abs) if known else float("nan")
    return found
