"""Steps as lines: on a terminal, in a log file, and of parallel processes."""

import io
import sys

import pytest

from fe_drivetrain.command_line import progress
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import OVERALL


def test_a_step_in_a_log_has_one_line_at_its_beginning(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with show_steps() as report:
        report("part [bold]")
        assert capsys.readouterr().err == "part [bold] ...\n"
        report("")
    assert capsys.readouterr() == ("", "")


def test_a_step_that_counts_is_one_step(capsys: pytest.CaptureFixture[str]) -> None:
    with show_steps() as report:
        report("part")
        report("loads (1 of 2)")
        report("loads (2 of 2)")
        report("last")
    lines = capsys.readouterr().err.splitlines()
    assert lines == ["part ...", "loads ...", "last ..."]


def test_a_step_that_counts_says_how_long_the_rest_takes(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    clock = iter([0.0, 40.0, 80.0, 120.0])
    monkeypatch.setattr(progress.time, "perf_counter", lambda: next(clock))
    with show_steps() as report:
        for count in (10, 11, 12, 13):  # what was done before it began is not its pace
            report(f"cases ({count} of 100)", OVERALL)
    lines = capsys.readouterr().err.splitlines()
    assert lines == [
        "cases ...",
        "cases (11 of 100), about 59 min left",  # 40 s a case
        "cases (12 of 100), about 59 min left",
        "cases (13 of 100), about 58 min left",
    ]


def test_steps_of_parallel_processes_begin_each_in_its_lane(
    capsys: pytest.CaptureFixture[str],
) -> None:
    with show_steps() as report:
        report("before")
        report("")
        report("one (1 of 2)", 1)
        report("two", 2)
        report("here")
        report("one (2 of 2)", 1)
        report("three", 1)
        report("", 2)
        report("", 1)
        report("after")
    lines = capsys.readouterr().err.splitlines()
    steps = ["before", "one", "two", "here", "three", "after"]
    assert lines == [f"{step} ..." for step in steps]


def test_steps_that_an_error_ends_are_not_finished(capsys: pytest.CaptureFixture[str]) -> None:
    def stopped() -> None:
        with show_steps() as report:
            report("here")
            report("there", 1)
            report("", 1)
            report("there again", 1)
            raise InputError("x")

    with pytest.raises(InputError):
        stopped()
    lines = capsys.readouterr().err.splitlines()
    assert lines[:-2] == ["here ...", "there ...", "there again ..."]
    assert sorted(lines[-2:]) == ["here ... not finished", "there again ... not finished"]


def test_a_long_line_is_not_wrapped(capsys: pytest.CaptureFixture[str]) -> None:
    with show_steps() as report:
        report("step " * 100 + "end")
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith("end ...")


def test_on_a_terminal_steps_end_as_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    class Terminal(io.StringIO):
        def isatty(self) -> bool:
            return True

    terminal = Terminal()
    monkeypatch.setattr(sys, "stderr", terminal)
    monkeypatch.setenv("TERM", "xterm")
    with show_steps() as report:
        report("part [bold]")
        report("loads (1 of 2)")
        report("loads (2 of 2)")
        report("beside", 1)
        report("", 1)
    shown = terminal.getvalue()
    assert shown.count("beside ... ") == 1
    assert "part [bold] ... " in shown
    assert shown.count("loads ... ") == 1
