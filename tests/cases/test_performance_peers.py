"""The benchmark beside other tools: the same answer from each, and honest bookkeeping."""

import json
import os
import re
import signal
import subprocess
import sys
import time
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.cases.performance import (
    peer_comparison,
    peer_settings,
    two_million_unknowns,
)
from fe_drivetrain.cases.performance.peers import launching, problems, rounds, runner
from fe_drivetrain.cases.performance.peers.launching import Limits, Outcome, Variant
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.interpreter import interpreters
from fe_drivetrain.elasticity.mesh.mesh import FACETS
from fe_drivetrain.report.suite import Page
from fe_drivetrain.report.suite.case import find_cases
from fe_drivetrain.report.suite.result_folders import run_case
from fe_drivetrain.report.suite.run import Run

PEERS = launching.parse(
    [
        "calculix.spooles",
        "ngsolve.multigrid",
        "sfepy.superlu",
        "felupe.superlu",
        "dolfinx.mumps",
        "dolfinx.bddc",
        "kratos.amgcl",
        "scikit_fem.mumps",
    ]
)
BEYOND = launching.parse(["mfem", "fedoo", "torch_fem", "scikit_fem.cholmod", "dolfinx.hpddm"])
"""Tools that .ci/consumers leaves out, for their size or what they need."""
LIMITS = Limits(60.0, 8 * 2.0**30, 1)


@pytest.fixture(scope="module")
def shaft():
    """The hollow shaft, as coarse as it goes."""
    return problems.of_size(problems.hollow_shaft(), 4_000)


@pytest.fixture(scope="module")
def assembly():
    """The main-bearing assembly, as coarse as it goes."""
    return problems.of_size(problems.main_bearing(), 9_000)


@pytest.fixture(scope="module")
def bar():
    """A straight cube of two materials in series, pulled: ten-node tetrahedra, exact solution.

    With Poisson's ratio zero the two halves are springs E A / l in series.
    """
    return pulled_bar((2e11, 1e11))


def pulled_bar(youngs_modulus, length=2.0):
    """A bar of unit cross-section along x, halves of different stiffness."""
    from skfem import MeshTet, MeshTet2

    x = np.linspace(0.0, length, 5)
    y = np.linspace(0.0, 1.0, 3)
    mesh = MeshTet2.from_mesh(MeshTet.init_tensor(x, y, y))
    points, cells = mesh.doflocs.T.copy(), mesh.dofs.element_dofs.T.copy()
    corners = points[cells[:, :4]]
    inverted = np.linalg.det(corners[:, 1:] - corners[:, :1]) < 0
    cells[inverted] = cells[inverted][:, [0, 2, 1, 3, 6, 5, 4, 7, 9, 8]]
    material = (points[cells[:, :4], 0].mean(axis=1) > length / 2).astype(np.int64)
    facets = cells[:, FACETS].reshape(-1, 6)
    ends = [facets[(np.abs(points[facets, 0] - at) < 1e-9).all(axis=1)] for at in (0.0, length)]
    rule = problems.get_quadrature(problems.RefTet, problems.DEGREE)
    return runner.Problem(
        points=points,
        cells=cells.astype(np.int64),
        material=material,
        youngs_modulus=np.array(youngs_modulus),
        poisson_ratio=np.zeros(2),
        fixed=ends[0],
        moved=ends[1],
        motions=np.eye(3, 4, 3)[None],
        rule_points=rule[0].T.copy(),
        rule_weights=rule[1],
    )


def stiffnesses_by(tool, variant, problem):
    """The stiffness of each motion that a tool finds in this process."""
    module = runner.load_tool(tool)
    return module.solve(module.load(problem), variant, runner.Clock())


def stiffness_by(tool, variant, problem):
    """That of one motion."""
    (stiffness,) = stiffnesses_by(tool, variant, problem)
    return stiffness


@pytest.fixture(scope="module")
def looked_for():
    """What an interpreter has said that it does not have; it takes a process to hear so."""
    return {}


@pytest.fixture
def measured(looked_for, tmp_path):
    """A tool in a process of its own, in whichever Python has it."""

    def run(variant, problem, limits=LIMITS):
        path = tmp_path / "problem.npz"
        runner.write_problem(problem, path)
        for interpreter in interpreters():
            key = variant, interpreter
            outcome = looked_for.get(key) or launching.launch(
                variant, path, path, limits, interpreter
            )
            if outcome.status != "missing":
                return outcome
            looked_for[key] = outcome
        return outcome

    return run


# --- the same answer


@pytest.mark.parametrize("name", ["shaft", "assembly"])
def test_this_project_and_plain_scikit_fem_find_the_same_stiffness(name, request):
    problem = request.getfixturevalue(name)
    ours = stiffness_by("this_project", "superlu", problem)
    theirs = stiffness_by("scikit_fem", "superlu", problem)
    assert ours == pytest.approx(theirs, rel=1e-9)


def test_the_iterative_solver_leaves_less_than_the_common_accuracy(shaft, assembly):
    for problem in (shaft, assembly):
        exact = stiffness_by("this_project", "superlu", problem)
        near = stiffness_by("this_project", "multigrid", problem)
        # the energy is least at the solution
        assert -1e-12 <= near / exact - 1 < rounds.EQUAL


def test_torsional_stiffness_is_g_j_over_l_but_for_the_shape_of_the_elements():
    benchmark = problems.hollow_shaft()
    errors = []
    for size in (4_000, 20_000):
        problem = problems.of_size(benchmark, size)
        errors.append(stiffness_by("this_project", "multigrid", problem) / benchmark.exact - 1)
    # A parabola through three points of an arc of angle a is off by about a^4 / 500 of its radius;
    # the coarser mesh has six elements or so round the bore, and K goes with the fourth power.
    assert abs(errors[0]) < 4 * (2 * np.pi / 6) ** 4 / 500
    assert abs(errors[1]) < abs(errors[0]) / 5


@pytest.mark.parametrize("name", ["tube", "slender"])
def test_thin_and_slender_bodies_turn_as_saint_venant_says(name):
    benchmark = problems.BENCHMARKS[name]()
    coarsest = benchmark.at(9.0 if name == "tube" else 1.6)
    found = stiffness_by("this_project", "auto", coarsest)
    # six elements a turn, at least: 4 a^4 / 500, as for the hollow shaft
    assert found == pytest.approx(benchmark.exact, rel=4 * (2 * np.pi / 6) ** 4 / 500)


@pytest.mark.parametrize(
    ("tool", "variant"),
    [("this_project", "superlu"), ("this_project", "multigrid"), ("scikit_fem", "superlu")],
)
def test_two_materials_in_series_are_springs_in_series(tool, variant, bar):
    springs = bar.youngs_modulus  # A / l = 1 of each half
    expected = 1.0 / (1.0 / springs).sum()
    assert stiffness_by(tool, variant, bar) == pytest.approx(expected, rel=1e-6)


@pytest.mark.needs  # looked for in the process of its own
@pytest.mark.parametrize("variant", PEERS, ids=str)
def test_installed_peers_agree_where_quadrature_is_exact(variant, bar, measured):
    outcome = measured(variant, bar)
    if outcome.status == "missing":
        pytest.skip(f"{variant.tool_name} is not installed: {outcome.reason}")
    assert outcome.status == "done", outcome.reason
    expected = 1.0 / (1.0 / bar.youngs_modulus).sum()
    assert outcome.found["stiffness"] == pytest.approx([expected], rel=rounds.EQUAL)


@pytest.mark.parametrize("variant", BEYOND, ids=str)
def test_peers_beyond_the_usual_ones_agree_on_every_motion_of_the_face(variant, bar, measured):
    problem = problems.with_motions(bar, 10)
    outcome = measured(variant, problem)
    if outcome.status == "missing":
        pytest.skip(f"{variant.tool_name} is not installed: {outcome.reason}")
    assert outcome.status == "done", outcome.reason
    expected = stiffnesses_by("this_project", "superlu", problem)
    assert outcome.found["stiffness"] == pytest.approx(expected, rel=rounds.EQUAL)


@pytest.mark.needs  # looked for in the process of its own
@pytest.mark.parametrize("variant", PEERS, ids=str)
def test_installed_peers_agree_on_every_motion_of_the_face(variant, bar, measured):
    problem = problems.with_motions(bar, 10)
    outcome = measured(variant, problem)
    if outcome.status == "missing":
        pytest.skip(f"{variant.tool_name} is not installed: {outcome.reason}")
    assert outcome.status == "done", outcome.reason
    expected = stiffnesses_by("this_project", "superlu", problem)
    assert outcome.found["stiffness"] == pytest.approx(expected, rel=rounds.EQUAL)


def test_motions_are_independent_and_solved_together_or_apart_alike(shaft, bar):
    for body in (shaft, bar):
        problem = problems.with_motions(body, problems.MAX_MOTIONS)
        assert np.linalg.matrix_rank([problem.prescribed(k)[1].ravel() for k in range(10)]) == 9
        np.testing.assert_array_equal(problem.motions[0], body.motions[0])
        together = stiffnesses_by("this_project", "superlu", problem)
        theirs = stiffnesses_by("scikit_fem", "superlu", problem)
        np.testing.assert_allclose(together, theirs, rtol=1e-9)
        near = stiffnesses_by("this_project", "multigrid", problem)
        assert np.abs(np.divide(near, together) - 1).max() < rounds.EQUAL
    apart = [stiffness_by("scikit_fem", "superlu", one) for one in problem.one_by_one()]
    np.testing.assert_allclose(together, apart, rtol=1e-9)


# --- the deck and what ccx says


def test_a_deck_says_the_whole_problem_again(shaft):
    module = runner.load_tool("calculix")
    lines = module.deck(shaft, "spooles").splitlines()
    numbers = re.compile(r"^\d+,[-+0-9.e,]+$")
    nodes = [line for line in lines[1:] if numbers.match(line)][: len(shaft.points)]
    points = np.array([[float(v) for v in line.split(",")[1:]] for line in nodes])
    np.testing.assert_allclose(points, shaft.points, atol=1e-12)
    # ccx reads twenty characters of a number, no more
    assert max(len(word) for line in nodes for word in line.split(",")) <= 20
    start = lines.index("*ELEMENT, TYPE=C3D10, ELSET=E0") + 1
    cells = np.array([[int(v) for v in lines[start + k].split(",")] for k in range(3)])
    np.testing.assert_array_equal(cells[:, 1:] - 1, shaft.cells[:3])
    held = lines[lines.index("*BOUNDARY") + 1 : lines.index("*EL PRINT, ELSET=EALL, TOTALS=ONLY")]
    given = np.zeros((len(shaft.points), 3))
    for line in held:
        node, first, last, value = line.split(",")
        assert first == last
        given[int(node) - 1, int(first) - 1] = float(value)
    ids, values = shaft.prescribed()
    assert len(held) == 3 * len(ids)
    np.testing.assert_allclose(given[ids], values, atol=1e-12)


def test_the_corrected_deck_moves_little_and_says_so():
    module = runner.load_tool("calculix")
    text = module.deck(pulled_bar((1e11, 1e11)), "corrected")
    assert "*STEP, NLGEOM" in text
    assert "SOLVER=ITERATIVE CHOLESKY" in text
    assert f",1,1,{module.SMALL:.12e}" in text


def test_energy_is_read_from_the_last_total():
    module = runner.load_tool("calculix")
    text = (
        "\n total internal energy for set EALL and time  0.5000000E+00\n\n        1.000000E+08\n"
        "\n total internal energy for set EALL and time  0.1000000E+01\n\n        4.380604E+08\n"
    )
    assert module.read_energy(text) == 4.380604e8
    with pytest.raises(ValueError, match="no total internal energy"):
        module.read_energy("")


def test_the_log_of_ccx_is_split_into_reading_assembly_and_solving():
    module = runner.load_tool("calculix")
    lines = [
        (0.1, "nodes:        17328"),
        (0.3, "STEP            1"),
        (0.4, "Using up to 2 cpu(s) for the stress calculation."),
        (1.0, "Factoring the system of equations using the symmetric spooles solver"),
        (1.1, "Using up to 2 cpu(s) for spooles."),
        (8.0, "Using up to 2 cpu(s) for the stress calculation."),
        (8.2, "Job finished"),
    ]
    found = module.read_log(lines)
    assert found["reading"] == 0.3
    assert found["assembly"] == pytest.approx(0.7)
    assert found["solve"] == pytest.approx(7.0)
    assert found["iterations"] is None
    assert found["threads"] == "2"
    again = [
        *lines,
        (9.0, "Solving the system of equations using the iterative solver"),
        (9.5, "# of iterations = 33"),
        (9.6, "Using up to 2 cpu(s) for the stress calculation."),
    ]
    found = module.read_log(again)
    assert found["solve"] == pytest.approx(7.6)
    assert found["iterations"] == 33
    with pytest.raises(ValueError, match="first step"):
        module.read_log(lines[:1])


# --- processes and their limits


def test_a_process_measures_what_this_one_finds(bar, measured):
    outcome = measured(Variant("this_project", "superlu"), bar)
    assert outcome.status == "done", outcome.reason
    found = outcome.found
    assert found["stiffness"] == pytest.approx(
        [stiffness_by("this_project", "superlu", bar)], rel=1e-9
    )
    assert 0 < sum(found["steps"].values()) <= found["seconds"] < outcome.elapsed
    # at the least the matrix, at the most what this machine could have
    assert 5e6 < found["baseline_bytes"] <= found["peak_bytes"] < 8 * 2**30


def test_a_run_over_its_time_or_memory_is_ended(bar, measured):
    variant = Variant("scikit_fem", "superlu")
    slow = measured(variant, bar, replace(LIMITS, seconds=1e-3))
    assert slow.status == "over time"
    large = measured(variant, bar, replace(LIMITS, bytes=1e6))
    assert large.status == "over memory"


def test_what_is_not_installed_is_missing_not_failed(shaft, tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    path = tmp_path / "problem.npz"
    runner.write_problem(shaft, path)
    outcome = launching.launch(Variant("calculix", "spooles"), path, path, LIMITS, sys.executable)
    assert outcome.status == "missing"
    assert "ccx" in outcome.reason
    for tool in launching.TOOLS:
        assert re.match(r"(pip|apt-get) install ", launching.how_to_install(tool))


@pytest.mark.parametrize("ends_first", [False, True])
def test_children_end_with_their_parent(ends_first, tmp_path):
    note = tmp_path / "pid"
    script = (
        "import pathlib, subprocess, sys, time\n"
        "child = subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(60)'])\n"
        f"pathlib.Path({str(note)!r}).write_text(str(child.pid))\n"
        f"time.sleep({0 if ends_first else 60})\n"
    )
    process = subprocess.Popen([sys.executable, "-c", script], start_new_session=True)
    while not (note.exists() and note.read_text()):
        time.sleep(0.02)
    if ends_first:
        process.wait()
    launching._end(process)
    child = Path(f"/proc/{note.read_text()}/stat")
    for _ in range(200):
        try:
            state = child.read_text().rpartition(")")[2].split()[0]
        except OSError:
            return
        if state == "Z":  # it has ended, and waits for whoever inherited it
            return
        time.sleep(0.02)
    os.kill(int(note.read_text()), signal.SIGKILL)
    pytest.fail("the child lives on")


def test_a_problem_comes_back_from_its_file(bar, tmp_path):
    runner.write_problem(bar, tmp_path / "bar.npz")
    again = runner.read_problem(tmp_path / "bar.npz")
    for name, value in vars(bar).items():
        np.testing.assert_array_equal(getattr(again, name), value)
    assert again.n_unknowns == 3 * (len(bar.points) - len(np.unique(bar.fixed)) * 2)


# --- rounds


def plan(repetitions=3):
    return rounds.Plan(repetitions, Limits(30.0, 2.0**30, 1))


def row(variant, unknowns, seconds=None, bytes_=1e8, stiffness=1.0, trouble=""):
    found = []
    if seconds is not None:
        found = [
            {
                "seconds": seconds,
                "load_seconds": 0.0,
                "peak_bytes": bytes_,
                "stiffness": [stiffness],
                "steps": {},
                "iterations": None,
                "notes": {},
            }
        ]
    return rounds.Row(variant, unknowns, found, trouble)


def test_rounds_are_interleaved_and_slow_rows_run_as_often_as_others(tmp_path):
    quick, slow = Variant("ngsolve", "multigrid"), Variant("scikit_fem", "superlu")
    order = []

    def start(variant, problem, warm_up, limits, interpreter):
        order.append(variant)
        seconds = 1.0 if variant == quick else 9.0
        return Outcome("done", row(variant, 1, seconds).found[0])

    rows = rounds.run_rounds(
        [(quick, ""), (slow, "")], tmp_path, tmp_path, 1000, plan(), start=start
    )
    assert [len(r.found) for r in rows] == [3, 3]
    assert order[:2] == [quick, slow]
    assert all(set(pair) == {quick, slow} for pair in zip(order[::2], order[1::2], strict=True))


def test_no_tool_always_runs_after_the_same_other(tmp_path):
    own = [Variant("this_project", name) for name in ("auto", "multigrid", "superlu")]
    tools = [*own, Variant("ngsolve", "multigrid")]
    order = []

    def start(variant, problem, warm_up, limits, interpreter):
        order.append(variant)
        return Outcome("done", row(variant, 1, 1.0).found[0])

    rounds.run_rounds([(t, "") for t in tools], tmp_path, tmp_path, 1000, plan(5), start=start)
    before = {t: {a for a, b in pairwise(order) if b == t} - {t} for t in tools}
    assert len(order) == 20
    assert all(len(others) > 1 for others in before.values())


def test_a_row_in_trouble_is_left_and_larger_meshes_not_begun(tmp_path):
    variant = Variant("scikit_fem", "superlu")
    calls = []

    def start(*_):
        calls.append(1)
        return Outcome("over time")

    small = rounds.run_rounds([(variant, "")], tmp_path, tmp_path, 1000, plan(), start=start)
    assert small[0].trouble == "over 30 s"
    assert small[0].min_seconds == 30.0
    large = rounds.run_rounds([(variant, "")], tmp_path, tmp_path, 9000, plan(), small, start=start)
    assert large[0].trouble == "not run: over 30 s before"
    assert large[0].min_seconds == 30.0
    assert len(calls) == 1


def test_what_would_go_over_a_limit_is_foreseen():
    variant = Variant("ngsolve", "cholesky")
    limits = plan().limits
    # time grows with the square of the unknowns: 1, 4, 16, 64 s
    done = [row(variant, 1000, 1.0), row(variant, 2000, 4.0)]
    assert rounds.foreseen(rounds.Row(variant, 4000), done, limits) == ("", None)
    trouble, least = rounds.foreseen(rounds.Row(variant, 8000), done, limits)
    assert trouble == "not run: would take about 64 s"
    assert least == 30.0
    # memory in proportion: half a GiB, then one and a half
    done = [row(variant, 1000, 1e-3, 2.0**28), row(variant, 2000, 2e-3, 2.0**29)]
    trouble, least = rounds.foreseen(rounds.Row(variant, 6000), done, limits)
    assert trouble == "not run: would take about 1.5 GiB"
    assert least is None


def test_a_power_law_is_continued_and_never_below_linear():
    assert rounds.extrapolated([10, 100], [1.0, 100.0], 1000) == pytest.approx(10_000.0)
    assert rounds.extrapolated([10, 100], [1.0, 1.1], 1000) == pytest.approx(11.0)
    assert rounds.extrapolated([100], [2.0], 300) == pytest.approx(6.0)


def test_errors_are_against_the_direct_solvers_of_the_same_rule():
    direct = row(Variant("this_project", "superlu"), 10, 1.0, stiffness=100.0)
    iterative = row(Variant("ngsolve", "multigrid"), 10, 1.0, stiffness=100.001)
    own = row(Variant("ngsolve", "multigrid_own"), 10, 1.0, stiffness=99.0)
    printed = row(Variant("calculix", "spooles"), 10, 1.0, stiffness=99.00001)
    rough = row(Variant("calculix", "cholesky"), 10, 1.0, stiffness=99.0099)
    rows = [direct, iterative, own, printed, rough]
    references = rounds.judge_errors(rows)
    assert references == {"common": 100.0, "4 points": 99.0}
    assert direct.error == 0.0
    assert iterative.error == pytest.approx(1e-5)
    assert rough.error == pytest.approx(1e-4)
    assert [r.reaches for r in rows] == [True, False, True, True, False]
    # and only those that reach it are compared
    assert rounds.fastest_peer(rows).variant.tool in ("ngsolve", "calculix")
    assert rounds.fastest_peer([rough]) is None


# --- settings and the page


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"tools": ["abaqus"]}, "abaqus"),
        ({"tools": ["ngsolve.pardiso"]}, r"ngsolve\.pardiso"),
        ({"problems": ["plate"]}, "plate"),
        ({"sizes": [10]}, "from 1000"),
        ({"sizes": []}, "empty"),
        ({"repetitions": 0}, "repetitions"),
        ({"repetitions": 1.5}, "whole"),
        ({"time_limit": "long"}, "time_limit"),
        ({"threads": True}, "threads"),
    ],
)
def test_wrong_settings_are_named(settings, message, tmp_path):
    with pytest.raises(InputError, match=message):
        peer_settings.settings_of(Run(settings, False, tmp_path))


def test_quick_is_small_and_gives_way_to_settings(tmp_path):
    quick = peer_settings.settings_of(Run({}, True, tmp_path))
    assert max(quick["sizes"]) <= 10_000
    assert quick["repetitions"] == 1
    assert peer_settings.settings_of(Run({"sizes": 2000}, True, tmp_path))["sizes"] == [2000]


def test_slower_or_hungrier_than_a_peer_is_shown():
    benchmark = problems.hollow_shaft()
    ours = row(Variant("this_project", "auto"), 50_000, 2.0, 3e8)
    peer = row(Variant("ngsolve", "multigrid"), 50_000, 1.0, 2e8)
    direct = row(Variant("ngsolve", "cholesky"), 50_000, 4.0, 2e8)
    rows = [ours, peer, direct]
    rounds.judge_errors(rows)
    (found,) = peer_comparison.goals(benchmark, rows, 1)
    assert found["fastest other"] == peer.variant.name
    assert found["its time over ours"] == pytest.approx(0.5)
    assert found["reached"] == "no"
    assert found["leanest direct other"] == direct.variant.name
    assert found["its peak memory over ours"] == pytest.approx(0.667)
    # a peer that does not reach the accuracy is no peer
    peer.error = 1e-3
    (found,) = peer_comparison.goals(benchmark, rows, 1)
    assert found["fastest other"] == direct.variant.name
    assert (found["its time over ours"], found["reached"]) == (2.0, "yes")
    # with ten right-hand sides twice as fast is not enough
    (found,) = peer_comparison.goals(benchmark, rows, 10)
    assert (found["goal, at least"], found["reached"]) == (4.0, "no")
    # nothing is known of what came to no end that counts
    direct.error = 1e-3
    (found,) = peer_comparison.goals(benchmark, rows, 1)
    assert (found["its time over ours"], found["reached"]) == (None, "not known")
    late = row(Variant("calculix", "spooles"), 50_000, trouble="over 30 s")
    late.min_seconds = 30.0
    (found,) = peer_comparison.goals(benchmark, [*rows, late], 1)
    assert (found["its time over ours"], found["reached"]) == (15.0, "yes")
    # small meshes, and runs without another tool, are not compared
    assert peer_comparison.goals(benchmark, [ours], 1) == []
    assert peer_comparison.goals(benchmark, [row(r.variant, 8_000, 1.0) for r in rows], 1) == []


def test_the_case_runs_and_its_page_says_what_is_missing(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))  # no ccx there
    settings = {
        "tools": ["this_project.auto", "calculix.spooles"],
        "sizes": [4000],
        "problems": ["shaft"],
        "threads": 1,
    }
    results = run_case(find_cases("performance/peers")[0], tmp_path / "out", settings, quick=True)
    (ours,) = results.figures["shaft"]
    exact = problems.hollow_shaft().exact
    assert ours["stiffness"] == pytest.approx(exact, rel=1e-2)
    assert len(ours["seconds"]) == 1
    assert all(v.passed for v in results.verdicts)
    data = json.loads((tmp_path / "out" / "results.json").read_text())
    assert data["sections"][0]["title"] == "Time at equal error"
    page = (tmp_path / "out" / "report.html").read_text()
    assert "this project: auto" in page
    assert "apt-get install calculix-ccx" in page


def test_without_an_answer_of_our_own_the_case_fails():
    auto, page = Variant("this_project", "auto"), Page()
    exact = problems.hollow_shaft().exact
    solved = row(auto, 50_000, 2.0, stiffness=exact)
    peer_comparison.check(
        page, problems.hollow_shaft(), [row(auto, 10_000, trouble="over 30 s"), solved]
    )
    assert [v.passed for v in page.checks] == [False, True]


def test_growth_is_that_of_one_solver():
    """Fitted over a direct solver's size, too, a slender shaft's exponent was 0.35."""
    auto = Variant("this_project", "auto")

    def solved(unknowns, seconds, method):
        one = row(auto, unknowns, seconds)
        return replace(one, found=[found | {"notes": {"method": method}} for found in one.found])

    rows = [solved(10**5 * 10**k, 2.0 * 10**k, "multigrid") for k in range(2)]
    first = solved(30_000, 5.0, "superlu")
    time_law, _ = two_million_unknowns.laws_of([first, *rows])
    assert time_law.exponent == pytest.approx(1.0)
    assert two_million_unknowns.laws_of([first, rows[0]]) is None


@pytest.mark.quick("performance/two_million_unknowns")
def test_growth_of_each_body_is_shown_with_the_goal_of_its_memory(quick_run, tmp_path):
    results = quick_run("performance/two_million_unknowns")
    small, large = results.figures["shaft"]
    assert small["unknowns"] < large["unknowns"]
    assert [row["runs"] for row in (small, large)] == [1, 1]
    assert all(v.passed for v in results.verdicts)
    growth = [t for s in results.sections if s.title == "Growth" for t in s.items]
    assert any(getattr(table, "rows", []) for table in growth)
    # what was not run is not said to be reached
    assert results.figures["goals"][0]["reached"] == "not known: fewer unknowns"
    case = find_cases("performance/two_million_unknowns")[0]
    settings = {"problems": ["shaft"], "sizes": [3000], "repetitions": 2}
    results = run_case(case, tmp_path, settings, quick=True)
    (row,) = results.figures["shaft"]
    assert row["runs"] == 2
    assert row["least [s]"] <= row["median [s]"] <= row["most [s]"]
    assert all(v.passed for v in results.verdicts)
    for wrong in ({"sizes": [10]}, {"sizes": []}, {"problems": ["plate"]}):
        with pytest.raises(InputError, match=next(iter(wrong))):
            run_case(case, tmp_path / "wrong", wrong, quick=True)
