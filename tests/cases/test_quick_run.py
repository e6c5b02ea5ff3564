"""Results of quick cases stand for all tests, and for the next run of them."""

import sys
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any

import pytest
from conftest import QuickRun
from tiny_case import count

from fe_drivetrain.report.suite import case as case_module
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run

NAME = "group/tiny"


@pytest.mark.parametrize(
    ("computed", "given", "runs"), [(1.01, False, 1), (2.0, False, 2), (2.0, True, 1)]
)
def test_a_case_runs_again_where_a_kept_check_failed(
    computed: float, given: bool, runs: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    found = _two_results(partial(count, computed=computed), given, tmp_path, monkeypatch)
    assert found == runs


def test_a_case_runs_again_where_the_program_is_another(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    assert _two_results(count, False, tmp_path, monkeypatch) == 1
    assert _two_results(count, False, tmp_path, monkeypatch) == 0
    module = sys.modules["fe_drivetrain.report.environment"]
    monkeypatch.setattr(module, "program_hash", lambda: "another")
    assert _two_results(count, False, tmp_path, monkeypatch) == 1


def _two_results(
    work: Callable[..., Any], given: bool, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> int:
    """How often a case ran whose results are asked for twice."""
    ran = []

    def counted(run: Run, page: Page) -> None:
        ran.append(run)
        work(run, page)

    case = Case(NAME, "A tiny case", "nobody", counted)
    monkeypatch.setattr(case_module, "all_cases", lambda: {NAME: case})
    for _ in range(2):
        results = QuickRun(folder, folder, given)(NAME)
        assert len(results.verdicts) == 2
    return len(ran)
