"""The history of runs: every run is in it, a drift is seen, and nothing of it is lost."""

import math
import re
import sqlite3
from collections.abc import Callable
from pathlib import Path

import pytest
from test_report import results, verdict
from tiny_case import Result, check_one

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.answer import Answer, KeyFigure
from fe_drivetrain.report.headline import values_found
from fe_drivetrain.report.history import (
    FILE,
    Point,
    carry_history,
    past_runs,
    points_over_runs,
    record_run,
)
from fe_drivetrain.report.results import Results
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.ownership import claim_reports
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.result_folders import run_case, shared_folder
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.report.suite.suite import run_cases
from fe_drivetrain.report.trend import change_text, relative_change, sparkline


def found(computed: float, quick: bool = False, band: float | None = None) -> Results:
    content = results("g/c", verdicts=[verdict(computed, band=band), verdict(1.0)])
    settings = {"quick": quick, "settings": {"k": 1}, "date": "2030-01-02 03:04 UTC"}
    environment = content.environment.model_copy(update=settings)
    return content.model_copy(update={"environment": environment})


def test_a_recorded_run_is_read_as_it_was(tmp_path: Path) -> None:
    record_run(tmp_path, found(1.02, band=0.01))
    record_run(tmp_path, found(math.nan, quick=True))
    first, second = past_runs(tmp_path)
    assert (first.name, first.quick, first.settings) == ("g/c", False, {"k": 1})
    assert (first.checks, first.failed, first.seconds) == (2, 1, 1.5)
    assert (first.quantity, first.unit, first.computed, first.band) == ("force", "N", 1.02, 0.01)
    assert second.quick
    assert second.computed is None
    assert past_runs(tmp_path, "g/other") == []


def test_a_run_is_recorded_with_its_answer(tmp_path: Path) -> None:
    figures = [
        {"name": "peak roller load", "value": 412.3, "unit": "kN", "band": 3.1, "status": "none"},
        {"name": "the force", "value": 1.02, "unit": "N", "status": "bad", "quantity": "force"},
    ]
    answer = {"question": "Which?", "verdict": "It is 412 kN.", "figures": figures, "status": "bad"}
    content = Results.model_validate({**found(1.02).model_dump(), "answer": answer})
    record_run(tmp_path, content)
    (run,) = past_runs(tmp_path)
    assert (run.quantity, run.unit, run.computed, run.band) == (
        "peak roller load",
        "kN",
        412.3,
        3.1,
    )
    assert run.verdict == "Not to be relied on, 1 of 2 checks fail: It is 412 kN."
    assert run.status == "bad"
    # a key figure that is a check stands once
    quantities = [one.quantity for one in values_found(content)]
    assert quantities == ["peak roller load", "force", "force"]
    assert values_found(content)[1] is content.verdicts[0]


def test_a_history_of_an_older_program_takes_the_next_run(tmp_path: Path) -> None:
    record_run(tmp_path, found(1.0))
    with sqlite3.connect(tmp_path / FILE) as database:
        database.execute("ALTER TABLE runs DROP COLUMN verdict")
        database.execute("ALTER TABLE runs DROP COLUMN status")
    record_run(tmp_path, found(1.0))
    assert [(run.verdict, run.computed) for run in past_runs(tmp_path)] == [("", 1.0)] * 2


def test_a_key_figure_that_is_no_check_is_what_a_run_is_told_by(tmp_path: Path) -> None:
    figure = KeyFigure(name="peers that are beaten", value=7.0, unit="", status="none")
    answer = Answer(question="q?", verdict="v.", figures=[figure], status="none")
    record_run(tmp_path, found(1.02).model_copy(update={"answer": answer}))
    (one,) = past_runs(tmp_path)
    assert (one.quantity, one.computed, one.checks) == ("peers that are beaten", 7.0, 2)


def test_only_runs_of_the_same_mode_and_settings_are_compared(tmp_path: Path) -> None:
    for computed, quick in ((1.0, False), (1.5, True), (1.001, False)):
        record_run(tmp_path, found(computed, quick))
    other = found(2.0)
    environment = other.environment.model_copy(update={"settings": {"k": 2}})
    record_run(tmp_path, other.model_copy(update={"environment": environment}))
    content = found(1.0)
    points = points_over_runs(tmp_path, content, content.verdicts[0], 5)
    assert {point.computed for point in points} == {1.0, 1.001}


def points(*values: float) -> list[Point]:
    return [Point(f"2030-01-{k + 1:02} 00:00 UTC", "", v, v < 9.0) for k, v in enumerate(values)]


@pytest.mark.parametrize(
    ("values", "text"),
    [
        ((), ""),
        ((1.0,), ""),
        ((1.0, 1.0 + 1e-12, 1.0), "the same in 3 runs"),
        ((1.0, 2.0, 2.0), "moved +50\u00a0%, 2030-01-02"),
        ((1.0, 2.0, 1.99), "moved -0.5\u00a0%, 2030-01-03"),
        ((1.0, math.nan), "moved to or from no number, 2030-01-02"),
    ],
)
def test_the_last_change_is_named(values: tuple[float, ...], text: str) -> None:
    assert change_text(points(*values)) == text


def test_a_change_is_relative_and_without_round_off() -> None:
    assert relative_change(-2.0, -1.0) == 0.5
    assert relative_change(0.0, 0.0) == 0.0
    assert relative_change(1.0, 1.0 + 1e-10) == 0.0
    assert relative_change(math.nan, math.nan) == 0.0
    assert relative_change(0.0, 1e-300) == 1.0


def test_a_sparkline_spans_its_height_and_marks_failures() -> None:
    drawn = str(sparkline(points(1.0, 9.5, 2.0)))
    heights = [float(y) for y in re.findall(r",([\d.]+)", drawn.partition("polyline")[2])]
    assert heights == [19.0, 3.0, pytest.approx(19.0 - 16.0 / 8.5, abs=0.06)]
    assert drawn.count('class="missed"') == 1
    assert drawn.count('class="passed"') == 1
    level = str(sparkline(points(1.0, 1.0 + 1e-13)))
    assert set(re.findall(r",([\d.]+)", level.partition("polyline")[2])) == {"11.0"}
    assert sparkline(points(1.0)) == ""
    assert "nan" not in str(sparkline(points(1.0, math.nan, 2.0))).partition("polyline")[2]


def growing(run: Run, page: Page) -> None:
    check_one(page, float(run.settings.get("k", 1.0)))


def test_every_run_writes_its_history_wherever_it_goes(tmp_path: Path) -> None:
    case = Case("g/c", "t", "s", growing, settings=("k",))
    assert shared_folder(tmp_path / "g/c", case) == tmp_path
    assert shared_folder(tmp_path / "other", case) is None
    run_case(case, tmp_path / "g/c")
    run_cases([case], tmp_path)
    assert len(past_runs(tmp_path)) == 2
    assert not (tmp_path / "g/c" / FILE).exists()
    assert "the same in 2 runs" in (tmp_path / "index.html").read_text("utf-8")
    for _ in range(2):
        run_case(case, tmp_path / "own")
    assert len(past_runs(tmp_path / "own")) == 2


def test_a_folder_that_is_replaced_takes_its_history_along(tmp_path: Path) -> None:
    for name in ("a", "b"):
        (tmp_path / name).mkdir()
    carry_history(tmp_path / "a", tmp_path / "b")
    assert not (tmp_path / "b" / FILE).exists()
    record_run(tmp_path / "a", found(1.0))
    carry_history(tmp_path / "a", tmp_path / "b")
    assert past_runs(tmp_path / "b") == past_runs(tmp_path / "a")


def test_a_file_that_is_no_history_is_refused_before_any_work(tmp_path: Path) -> None:
    assert claim_reports(tmp_path)
    (tmp_path / FILE).write_text("years of work, in a file of another kind" * 30)
    worked = []
    case = Case("g/c", "t", "s", lambda run, page: worked.append(1))
    for work in (run_case, run_cases):
        with pytest.raises(InputError, match=r"history of the runs.*move it away"):
            work(*((case, tmp_path / "g/c") if work is run_case else ([case], tmp_path)))  # type: ignore[operator]
    assert worked == []
    assert (tmp_path / FILE).read_text().startswith("years")


def test_the_history_is_plain_sqlite(tmp_path: Path) -> None:
    record_run(tmp_path, found(1.25))
    database = sqlite3.connect(tmp_path / FILE)
    query = "SELECT computed FROM runs JOIN checks USING (run) WHERE place = 0"
    assert database.execute(query).fetchall() == [(1.25,)]
    database.close()


def test_the_command_prints_runs_and_what_moved(invoke: Callable[..., Result]) -> None:
    code, _, error = invoke("history")
    assert code == 2
    assert "reports has no history.sqlite: run a case into it" in error
    for _ in range(2):
        invoke("run", "group/tiny")
    invoke("run", "group/tiny", "--quick")
    code, printed, _ = invoke("history", "tiny")
    assert code == 0
    head, *lines = printed.splitlines()
    assert head.split() == [
        "when",
        "case",
        "program",
        "mode",
        "verdict",
        "answer",
        "change",
        "time",
    ]
    assert ["same" in line for line in lines] == [False, True, False]
    assert ["quick" in line for line in lines] == [False, False, True]
    assert all("one: 1.01\u00a0N m/rad" in line and "pass" in line for line in lines)
    code, _, error = invoke("history", "tinny")
    assert code == 2
    assert "did you mean" in error
