"""The cases of what a user waits for, and why, run and check what time must not change."""

import pytest
from conftest import QuickRun

from fe_drivetrain.report.suite.case import all_cases

#: All that measure; of the comparison with other tools `test_performance_peers` runs a small part.
MEASURING = [
    name for name in all_cases() if name.startswith("performance/") and name != "performance/peers"
]


@pytest.mark.parametrize("name", [pytest.param(n, marks=pytest.mark.quick(n)) for n in MEASURING])
def test_what_time_must_not_change_holds(every_quick_run: QuickRun, name: str) -> None:
    results = every_quick_run(name)
    assert not [(v.quantity, v.computed, v.reference) for v in results.verdicts if not v.passed]
    assert results.verdicts


@pytest.mark.parametrize("name", MEASURING)
def test_a_quick_run_judges_no_time(name: str) -> None:
    assert not all_cases()[name].runs_alone(quick=True)


@pytest.mark.quick("performance/mesh_generation")
def test_gmsh_repeats_a_mesh_and_every_stage_takes_time(quick_run: QuickRun) -> None:
    results = quick_run("performance/mesh_generation")
    (row,) = results.figures["over_sizes"]
    stages = sum(row[f"{stage} [s]"] for stage in ("surfaces", "volumes", "curved", "read"))
    assert stages == pytest.approx(row["median [s]"])
    # side by side the volumes take no less than the longest of them
    parts = results.figures["parts"]
    best = parts["meshing, volumes side by side, at best [s]"]
    assert 0 < parts["longest volume alone [s]"] < best


@pytest.mark.quick("performance/start_to_answer")
def test_a_command_takes_no_less_than_its_processes_need(quick_run: QuickRun) -> None:
    results = quick_run("performance/start_to_answer")
    (row,) = results.figures["waits"]
    assert 0 < row["least [s]"] <= row["median [s]"] <= row["most [s]"]
    assert row["on processors [s]"] > 0


@pytest.mark.quick("performance/distance_from_limit")
def test_every_phase_has_a_floor_in_proportion_to_what_it_moves(quick_run: QuickRun) -> None:
    results = quick_run("performance/distance_from_limit")
    rate = max(results.figures["bandwidths"])
    rows = {row["phase"]: row for row in results.figures["phases"]}
    for row in rows.values():
        assert row["floor [s]"] * rate == pytest.approx(1e6 * row["bytes [MB]"])
    # conjugate gradients and a cycle: the stiffness once in double and twice in single precision
    (beside,) = results.figures["products"]
    blocks = beside["matrix [MB]"] / 76
    each = rows["iterations"]["bytes [MB]"] / results.figures["iterations"]
    assert 1.0 < each / (blocks * (76 + 2 * 40)) < 1.5
    # assembly writes each block once, set-up is the sum of its steps
    assert blocks * 72 < rows["elements"]["bytes [MB]"] < blocks * 76 * 1.5
    steps = [row for phase, row in rows.items() if phase.startswith("set-up:")]
    for what in ("bytes [MB]", "floor [s]"):
        assert sum(row[what] for row in steps) == pytest.approx(rows["set-up"][what])
    for phase in ("pattern", "elements"):
        assert rows[phase]["every access [MB]"] > rows[phase]["bytes [MB]"]
    assert beside["no matrix [MB]"] < 0.5 * beside["matrix [MB]"]
