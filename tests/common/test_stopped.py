"""Ctrl-C ends every program with status 130, wherever it arrives."""

import os
import random
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from faulty_cases import fill
from numba import njit
from tiny_case import Result

from fe_drivetrain.command_line import terminal
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.stopped import (
    EARLIER,
    NOTHING,
    STOPPED,
    TERMINATED,
    causes,
    stop_status,
    until_stopped,
)
from fe_drivetrain.common.threads import CORES_VARIABLE
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.result_folders import run_case
from fe_drivetrain.report.suite.run import Run


def caused_by(error: BaseException, depth: int) -> BaseException:
    for _ in range(depth):
        outer = SystemError("returned a result with an exception set")
        outer.__cause__, error = error, outer
    return error


def handled(error: BaseException) -> BaseException:
    outer = ValueError("while another was handled")
    outer.__context__ = error
    return outer


@pytest.mark.parametrize("depth", [0, 1, 2, 20_000])
@pytest.mark.parametrize("between", [handled, lambda error: error])
@pytest.mark.parametrize(
    ("stop", "status"), [(KeyboardInterrupt(), STOPPED), (SystemExit(TERMINATED), TERMINATED)]
)
def test_a_stop_is_found_however_deep(
    depth: int,
    between: Callable[[BaseException], BaseException],
    stop: BaseException,
    status: int,
) -> None:
    assert stop_status(caused_by(between(caused_by(stop, 1)), depth)) == status


def test_a_circle_of_errors_has_an_end_and_other_errors_are_no_stop() -> None:
    first, second = ValueError("first"), SystemExit(2)
    first.__cause__, second.__context__ = second, first
    assert list(causes(first)) == [first, second]
    assert stop_status(first) is None
    assert stop_status(None) is None
    assert stop_status(InputError("a mistake")) is None
    second.__cause__ = KeyboardInterrupt()
    assert stop_status(first) == STOPPED


@pytest.mark.parametrize(
    ("error", "status"),
    [(caused_by(KeyboardInterrupt(), 2), STOPPED), (SystemExit(TERMINATED), TERMINATED)],
)
def test_a_program_that_others_start_ends_with_the_status_of_a_stop(
    error: BaseException, status: int
) -> None:
    def work() -> int:
        raise error

    assert until_stopped(work) == status
    assert until_stopped(lambda: 3) == 3
    assert until_stopped(lambda: None) == 0
    with pytest.raises(ValueError, match="no stop"):
        until_stopped(lambda: int("no stop"))


@njit  # type: ignore[untyped-decorator]
def many_objects(n):  # type: ignore[no-untyped-def]
    """Python makes each on the way out of compiled code, and looks for signals meanwhile."""
    made = []
    for k in range(n):
        made.append((np.ones(1), k))
    return made


def test_ctrl_c_on_the_way_out_of_compiled_code_is_no_traceback(
    capsys: pytest.CaptureFixture[str],
) -> None:
    many_objects(1)
    pause = random.Random(0)
    for _ in range(10):
        begun = threading.Event()

        def work(begun: threading.Event = begun) -> int:
            begun.set()
            while True:
                many_objects(20_000)

        def press(begun: threading.Event = begun) -> None:
            begun.wait()
            time.sleep(0.03 * pause.random())
            os.kill(os.getpid(), signal.SIGINT)

        thread = threading.Thread(target=press)
        thread.start()
        assert terminal.guarded(work) == STOPPED
        thread.join()
    err = capsys.readouterr().err
    assert err == 10 * f"fe-drivetrain: stopped; {NOTHING}\n"


def test_a_stop_within_one_of_several_cases_stops_all(
    invoke: Callable[..., Result], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv(CORES_VARIABLE, "1")
    begun: list[str] = []

    def work(run: Run, page: Page) -> None:
        begun.append(run.folder.name)
        raise caused_by(KeyboardInterrupt(), 2)

    status, out, err = invoke("run", "tiny", "other", work=work)
    assert (status, out, len(begun)) == (STOPPED, "", 1)
    assert "stopped; finished cases are kept" in err


SLOW = """
import time
from fe_drivetrain.command_line import app
def slow(*arguments):
    print("begun", flush=True)
    time.sleep(60.0)
app.get_command = slow
app.main([])
"""


def test_ctrl_c_before_a_command_begins_is_no_traceback() -> None:
    with subprocess.Popen(
        [sys.executable, "-c", SLOW], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    ) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == "begun\n"
        process.send_signal(signal.SIGINT)
        _, err = process.communicate(timeout=60)
    assert (process.returncode, err) == (STOPPED, "")


def test_results_of_an_earlier_run_are_named_where_there_are_any(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    stops = [True, False, True]

    def work(run: Run, page: Page) -> None:
        if stops.pop():
            raise KeyboardInterrupt
        fill(run, page)

    case = Case("a/b", "t", "s", work)

    def run_it() -> int:
        run_case(case, tmp_path / "out")
        return 0

    said = []
    while stops:
        terminal.guarded(run_it)
        said.append(capsys.readouterr().err.rpartition("stopped; ")[2].strip())
    assert said == [NOTHING, "", EARLIER]
