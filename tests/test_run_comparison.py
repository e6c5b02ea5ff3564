"""What changed between two runs, and what cannot be compared."""

from collections.abc import Callable
from pathlib import Path

from tiny_case import Result, count

from fe_drivetrain.suite.case import Case
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
