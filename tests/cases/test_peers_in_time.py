"""The comparison in time: equal errors, the same equations in other coordinates, and who wins."""

from functools import partial

import numpy as np
import pytest
from conftest import QuickRun
from numpy.testing import assert_allclose

from fe_drivetrain.cases.performance import motion_problems, peers_in_time
from fe_drivetrain.cases.performance.motion_programs import EXUDYN, OURS, Method, coordinates
from fe_drivetrain.cases.performance.motion_sweeps import Point, at_equal_error, seconds_at
from fe_drivetrain.common import Times
from fe_drivetrain.report.suite import Record


def points(program: str, *of: tuple[int, float, float]) -> list[Point]:
    """Runs of a method: steps between records, error, time [s]."""
    method = Method(program, "a method", False, lambda _: partial(np.zeros, (1, 1)))
    return [Point(method, steps, error, Times((time,))) for steps, error, time in of]


def test_a_time_between_two_runs_is_interpolated_in_logarithms() -> None:
    runs = points(OURS, (1, 1e-2, 1.0), (10, 1e-4, 10.0))
    between, longest = seconds_at(runs, 1e-3), seconds_at(runs, 0.1)
    assert between is not None
    assert longest is not None
    assert_allclose(between[0].seconds, [np.sqrt(10.0)] * 3)
    assert between[1] == pytest.approx(np.sqrt(10.0))
    assert (longest[0].median, longest[1]) == (1.0, 1.0)
    assert seconds_at(runs, 1e-5) is None


def test_the_best_method_of_a_program_is_compared() -> None:
    pair = motion_problems.gear_pair(0.01)
    slow, fast = points(EXUDYN, (1, 1e-6, 3.0)), points(EXUDYN, (2, 1e-6, 2.0))
    rows = at_equal_error(pair, [points(OURS, (1, 1e-6, 1.0)), slow, fast])
    assert [row["time over ours"] for row in rows] == [1.0, 2.0, 1.0, 2.0]


@pytest.mark.parametrize(
    "problem",
    [motion_problems.gear_pair(0.01, 0.25), motion_problems.planetary_stage(0.01, 0.25)],
    ids=["pair", "stage"],
)
def test_elongations_of_meshes_are_coordinates_and_loads_stay(
    problem: motion_problems.Problem,
) -> None:
    T, places = coordinates(problem)
    unit = np.zeros_like(problem.rows)
    unit[np.arange(problem.meshes), places] = 1.0
    assert_allclose(problem.rows @ T, unit, rtol=0, atol=1e-12)
    pattern = problem.loads.patterns[:, 0]
    assert_allclose(T.T @ pattern, pattern, rtol=0, atol=1e-9 * np.abs(pattern).max())


def test_torques_are_balanced() -> None:
    """No torque is left that would turn all bodies ever faster."""
    for problem in (motion_problems.gear_pair(0.01), motion_problems.planetary_stage(0.01)):
        e, pattern = problem.equations, problem.loads.patterns[:, 0]
        moved = np.linalg.lstsq(e.K, pattern, rcond=1e-12)[0]
        assert_allclose(e.K @ moved, pattern, rtol=0, atol=1e-6 * np.abs(pattern).max())


def row(program: str, ratio: float) -> Record:
    """A row of what is compared."""
    return {
        "problem": "gear pair, a mesh",
        "error": 1e-3,
        "program": program,
        peers_in_time.TIME: 2.0 * ratio,
        peers_in_time.RATIO: ratio,
    }


def test_the_verdict_says_who_wins() -> None:
    own = [row(OURS, 1.0)]
    faster = peers_in_time.verdict(peers_in_time.nearest_peers([*own, row(EXUDYN, 2.0)]), own)
    assert "2 times as fast as the fastest other program; nearest is Exudyn" in faster
    beaten = peers_in_time.verdict(peers_in_time.nearest_peers([*own, row(EXUDYN, 0.5)]), own)
    assert "fastest in 0 of 1 comparisons; Exudyn is 2 times as fast" in beaten
    assert "no other program was compared" in peers_in_time.verdict([], own)


@pytest.mark.quick("performance/peers_in_time")
def test_a_quick_run_agrees_with_the_reference(quick_run: QuickRun) -> None:
    results = quick_run("performance/peers_in_time")
    assert [v.quantity for v in results.verdicts if not v.passed] == []
    errors = [v for v in results.verdicts if "error of exponentials" in v.quantity]
    assert len(errors) == 4
