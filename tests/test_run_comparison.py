"""What changed between two runs, and what cannot be compared."""

from collections.abc import Callable
from pathlib import Path

import pytest
from tiny_case import Result, count

from fe_drivetrain.suite.case import Case
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.run import Run
from fe_drivetrain.suite.run_comparison import compare_runs
from fe_drivetrain.suite.suite import run_cases

CASE = Case("group/tiny", "A tiny case", "nobody", count)


def test_a_quick_run_against_a_full_one_is_named(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    for name, quick in (("full", False), ("again", False), ("quick", True)):
        run_cases([CASE], tmp_path / name, quick=quick)
    (change,) = compare_runs(tmp_path / "full", tmp_path / "quick").changes
    assert (change.kind, change.before, change.after) == ("mode", "full", "quick")
    assert compare_runs(tmp_path / "full", tmp_path / "again").changes == []
    status, out, _ = invoke("compare-runs", "quick", "full")
    assert status == 0
    assert out.startswith("quick against full: 1 of 1 cases ran quick in one run and not")
    assert "against" not in invoke("compare-runs", "full", "again")[1]


def answers(run: Run, page: Page) -> None:
    page.found("stiffness [MN m/rad]", 579.0 * float(run.settings["k"]))


@pytest.mark.parametrize(
    ("factor", "kinds"), [(1.0, []), (1.0 + 1e-12, ["rounding"]), (1.01, ["value"])]
)
def test_answers_that_moved_are_named(tmp_path: Path, factor: float, kinds: list[str]) -> None:
    case = Case("group/tiny", "A tiny case", "nobody", answers, settings=("k",))
    run_cases([case], tmp_path / "one", {"k": 1.0})
    run_cases([case], tmp_path / "other", {"k": factor})
    changes = compare_runs(tmp_path / "one", tmp_path / "other").changes
    assert [change.kind for change in changes] == kinds
    assert all(change.what == "stiffness" for change in changes)
