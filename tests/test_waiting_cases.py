"""The cases of what a user waits for run, and check what time must not change."""

import pytest
from conftest import QuickRun


@pytest.mark.quick("performance/mesh_generation")
def test_gmsh_repeats_a_mesh_and_every_stage_takes_time(quick_run: QuickRun) -> None:
    results = quick_run("performance/mesh_generation")
    assert all(verdict.passed for verdict in results.verdicts)
    (row,) = results.figures["over_sizes"]
    stages = sum(row[f"{stage} [s]"] for stage in ("surfaces", "volumes", "curved", "read"))
    assert stages == pytest.approx(row["median [s]"])


@pytest.mark.quick("performance/start_to_answer")
def test_a_command_takes_no_less_than_its_processes_need(quick_run: QuickRun) -> None:
    results = quick_run("performance/start_to_answer")
    assert all(verdict.passed for verdict in results.verdicts)
    (row,) = results.figures["waits"]
    assert 0 < row["least [s]"] <= row["median [s]"] <= row["most [s]"]
    assert row["on processors [s]"] > 0
