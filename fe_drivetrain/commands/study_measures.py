"""Levels of a study against the assembly in the measures of design: damage, extremes, duration."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence

import numpy as np

from fe_drivetrain.commands.study_loads import StudyLoads
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.fidelity.ladder import LevelModel
from fe_drivetrain.fidelity.over_loads import (
    ROUND_OFF,
    Levels,
    reaction_history,
)
from fe_drivetrain.histories.model_errors import (
    USES,
    Measured,
    damage_ratio,
    good_enough_for,
    measured,
    model_errors,
)
from fe_drivetrain.response.entering import entering
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record

_MOST = 12
"""Histories that are counted, evenly over all: a count takes longer than a reaction."""


def measures(
    page: Page,
    scene: Scene,
    levels: Levels,
    loads: StudyLoads,
    slopes: Sequence[float],
    within: float,
    judged: Collection[str],
) -> None:
    """Add a table of errors by measure, and which level is good enough for what.

    Parameters
    ----------
    page : Page
        Takes the table and the answer.
    scene : Scene
        The scene.
    levels : Levels
        All levels.
    loads : StudyLoads
        Hub loads.
    slopes : sequence of float
        Of S-N curves.
    within : float
        What is good enough, as a share.
    judged : collection of str
        By which reactions levels are judged: "NAME, force" and "NAME, moment".
    """
    bounds, count = levels.bounds, len(loads.histories)
    places = np.unique(np.linspace(0, count - 1, min(count, _MOST)).astype(int))
    chosen = [loads.histories[k] for k in places]
    weight = scene.gearbox.weight

    driving = [entering(scene, history) for history in chosen]

    def of(model: LevelModel, name: str) -> list[Floats]:
        return [reaction_history(model, name, one, weight, loads.gravity) for one in driving]

    worst: dict[str, dict[str, float]] = {level: {} for level in bounds}
    seen: dict[str, dict[str, Mapping[str, float]]] = {level: {} for level in bounds}
    rows: list[Record] = []
    for name in levels.reference.reaction_matrices:
        reference = of(levels.reference, name)
        models = {m: of(levels.models[m], name) for own in bounds.values() for m in own}
        for kind, first in (("force", 1), ("moment", 4)):
            if f"{name}, {kind}" not in judged:
                continue
            spread = np.concatenate(reference)[:, first : first + 2].std(axis=0)
            if spread.max() <= ROUND_OFF * np.abs(np.concatenate(reference)).max():
                continue  # a component that this support does not hold
            c = first + int(np.argmax(spread))

            def counted(histories: Sequence[Floats], c: int = c) -> Measured:
                return measured([h[:, c] for h in histories], [h.step for h in chosen], slopes)

            truth = counted(reference)
            for level, own in bounds.items():
                errors = _larger([model_errors(counted(models[m]), truth) for m in own])
                worst[level] = _larger([worst[level], errors])
                seen[level][f"{name}, {FORCES[c]}"] = errors
                rows.append(
                    {
                        "reaction": f"{name}, {FORCES[c]}",
                        "level": level,
                        **{f"{what} [%]": 100.0 * error for what, error in errors.items()},
                        **{
                            f"damage over it, m = {m:g}": damage_ratio(errors[f"DEL, m = {m:g}"], m)
                            for m in list(slopes)[-1:]
                        },
                    }
                )
    of_all = "" if len(chosen) == count else f" in {len(chosen)} of the {count} histories"
    worse = ", the worse of both bounds of the housings" if levels.stiff else ""
    page.table(
        f"Error of each level by what a part is designed for{of_all}: the component across the "
        f"shaft that varies most{worse}. Mean and load duration "
        "over the mean size; extreme, and damage-equivalent load (DEL), over the assembly's",
        rows,
    )
    page.data("design_measures", rows)
    found = good_enough_for(worst, within)
    failures = {use: failure(seen, use) for use, model in found.items() if model is None}
    page.answer(sentence(found, failures, within))


def failure(seen: Mapping[str, Mapping[str, Mapping[str, float]]], use: str) -> str:
    """What keeps every level from being good enough for a use: the reaction, and its error.

    Parameters
    ----------
    seen : mapping
        By level and reaction: errors by measure, as shares; NaN where there is no such load.
    use : str
        Of `fe_drivetrain.histories.model_errors.USES`.

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
        Of `good_enough_for`.
    failures : mapping
        By use for which there is none: see `failure`.
    within : float
        The tolerance, as a share.
    """
    share = f"{100 * within:g} %"
    if not any(found.values()):
        return (
            "Of the component across the shaft that varies most in each reaction, no level below "
            f"the assembly has the mean, extreme, or damage-equivalent load within {share}: none "
            f"is good enough for means, extremes or fatigue ({failures['fatigue']})."
        )
    words = [f"for {use} {model or f'none ({failures[use]})'}" for use, model in found.items()]
    return (
        f"Of the component across the shaft that varies most in each reaction, the cheapest level "
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
