"""Bored stepped shafts that are searched: the scene, searches at each level, and their cost."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.common.cache import switched_off
from fe_drivetrain.comparison.constrained_minimum import Minimum, slopes
from fe_drivetrain.drivetrain_file import Scene, change_scene, library_scene
from fe_drivetrain.report.suite import Record
from fe_drivetrain.studies.design_minima import (
    Problem,
    correction,
    log_ratios,
    minima_of,
    with_slopes,
)
from fe_drivetrain.studies.design_quantities import DesignQuantities
from fe_drivetrain.studies.design_request import design_request
from fe_drivetrain.studies.design_trials import DesignTrials

LENGTHS, OUTER = (0.5, 0.9, 0.8), (0.6, 0.5, 0.4)
"""Lengths and diameters of the sections [m]."""
BORES = tuple(f"shaft.sections.{k}.inner_diameter" for k in range(3))
RANGES = dict(zip(BORES, ((0.02, 0.47), (0.02, 0.37), (0.02, 0.37)), strict=True))
LOAD = {"hub.Fz": -3e5, "hub.My": 2e5, "gravity.z": -9.81}
_COARSE = {
    "mesh.shaft": 0.3,
    "mesh.bearing": 0.14,
    "mesh.housing": 0.18,
    "mesh.bearing_edge": 0.14,
    "mesh.elements_per_turn": 8,
    "shaft.front": -1.0,
}


def stepped_scene() -> Scene:
    """The bonded main bearing with a shaft of three bored sections, coarsely meshed."""
    steps = [
        {"length": length, "outer_diameter": outer, "inner_diameter": 0.1}
        for length, outer in zip(LENGTHS, OUTER, strict=True)
    ]
    return change_scene(library_scene("main_bearing_bonded"), {**_COARSE, "shaft.sections": steps})


def problem_of(
    scene: Scene,
    limit: str,
    keys: tuple[str, ...] = BORES,
    model: str = "cheap",
    load: Mapping[str, float] | None = None,
    minimise: str = "mass.shaft",
) -> Problem:
    """The search for the lightest shaft within one limit, at one level.

    Parameters
    ----------
    scene : Scene
        The scene.
    limit : str
        Limit as `fe_drivetrain.studies.design_request` writes it.
    keys : tuple of str
        Bores that are free.
    model : str
        Level, of `fe_drivetrain.studies.design_quantities.MODELS`.
    load : mapping of str to float, optional
        The load.
    minimise : str
        What shall be least.
    """
    ranges = {key: RANGES[key] for key in keys}
    asked = DesignQuantities(scene, design_request(ranges, minimise, [limit], load=load or {}))
    now = asked.values(scene)
    trials = DesignTrials(asked, {name: len(values) for name, values in now.items()}, {}, model)
    return Problem(trials, minimise, asked.request.limits, float(now[minimise][0]))


def quiet(_: str) -> None:
    """Show nothing."""


def timed_levels(scene: Scene, limit: str, keys: tuple[str, ...], rounds: int) -> list[Record]:
    """The lightest shaft by level 1, by level 1 corrected so many times, and by level 2.

    Parameters
    ----------
    scene, limit, keys : Scene, str, tuple of str
        See `problem_of`.
    rounds : int
        Number of corrections.

    Returns
    -------
    list of dict
        Time in seconds of the processor, designs at both levels, mass, and by how much level 2
        says that the limit is broken; the last row is that of level 2 alone, begun where the
        corrected search ends: from elsewhere it costs more.
    """
    with switched_off():  # or an earlier run would have paid
        return _timed_levels(scene, limit, keys, rounds)


def _timed_levels(scene: Scene, limit: str, keys: tuple[str, ...], rounds: int) -> list[Record]:
    start = np.full(len(keys), 0.3)
    cheap = problem_of(scene, limit, keys, load=LOAD)
    direct = problem_of(scene, limit, keys, "better", LOAD)
    better = problem_of(scene, limit, keys, "better", LOAD).trials
    for trials in (cheap.trials, direct.trials, better):
        trials.quantities(start)  # what all share, as the housing, is nobody's cost
    rows: list[Record] = []
    spent = 0.0
    shared = better.made

    def ratios(at: Floats) -> Mapping[str, Floats] | None:
        there, below = better.quantities(at), cheap.trials.quantities(at)
        return None if there is None or below is None else log_ratios(there, below)

    for number in range(rounds + 1):
        begun = time.process_time()
        (found,) = minima_of(cheap, [start], quiet, [])
        start = found.at
        spent += time.process_time() - begun
        words = f"level 1, corrected {number} times" if number else "level 1"
        rows.append(_row(words, spent, cheap, found, better.made - shared, better))
        begun = time.process_time()
        exact, own = better.quantities(found.at), cheap.trials.quantities(found.at)
        assert exact is not None
        assert own is not None
        now = correction(cheap.corrected_by, start, exact, own)
        now = with_slopes(now, ratios) if now.is_far else now
        spent += time.process_time() - begun
        cheap = replace(cheap, corrected_by=now)
    begun = time.process_time()
    (found,) = minima_of(direct, [start], quiet, [])
    spent = time.process_time() - begun
    rows.append(_row("level 2", spent, direct, found, direct.trials.made, better))
    exact_mass = rows[-1]["mass [kg]"]
    for row in rows:
        row["error of the mass [%]"] = 100.0 * abs(row["mass [kg]"] / exact_mass - 1.0)
    return rows


def _row(
    words: str, spent: float, problem: Problem, found: Minimum, checks: int, better: DesignTrials
) -> Record:
    limit = problem.limits[0]
    values = better.quantities(found.at)
    assert values is not None
    return {
        "search": words,
        "processor time [s]": spent,
        "designs at level 1": 0 if words == "level 2" else problem.trials.made,
        "designs at level 2": checks,
        "mass [kg]": float(found.values[0]) * problem.size,
        "limit broken at level 2 [%]": 100.0
        * float(np.expm1(problem.excess(limit, values[limit.name])[0])),
    }


def gradient_errors(problem: Problem, at: Floats, exact: Floats, steps: Floats) -> list[Record]:
    """Error of the gradient of the limit by differences of each step, relative.

    Parameters
    ----------
    problem : Problem
        The search.
    at, exact : Floats
        Place, and gradient of its one limit there.
    steps : Floats
        Steps, as shares of the ranges.
    """
    size = float(np.linalg.norm(exact))
    return [
        {
            "step over the range": float(step),
            "error of the gradient": float(
                np.linalg.norm(slopes(problem.functions, at, float(step))[1] - exact)
            )
            / size,
        }
        for step in steps
    ]
