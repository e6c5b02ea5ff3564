"""Errors as one sentence, signals, and streams whose reader went away."""

import errno
import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from xml.etree import ElementTree

import pytest
from tiny_case import Result

from fe_drivetrain.command_line.app import main_of_case
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run


def test_a_mistake_is_one_sentence(invoke: Callable[..., Result], tmp_path: Path) -> None:
    def work(run: Run, page: Page) -> None:
        with run.step("read"):
            raise InputError("shaft: length is -1 but must be greater than 0: give a length")

    status, _, err = invoke("run", "tiny", work=work)
    assert status == 2
    assert err.splitlines()[-1] == (
        "fe-drivetrain: shaft: length is -1 but must be greater than 0: give a length"
    )
    assert not any((tmp_path / "reports").rglob("results.json"))
    kept = json.loads((tmp_path / "reports" / "problems.json").read_text("utf-8"))
    assert "must be greater than 0" in str(kept)


def test_a_full_disk_exits_2(invoke: Callable[..., Result]) -> None:
    def work(run: Run, page: Page) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC), "big.vtu")

    status, _, err = invoke("run", "tiny", work=work)
    assert status == 2
    assert "big.vtu: No space left" in err


def test_a_missing_system_library_is_named(invoke: Callable[..., Result]) -> None:
    def work(run: Run, page: Page) -> None:
        raise OSError("libGLU.so.1: cannot open shared object file: No such file or directory")

    status, _, err = invoke("run", "tiny", work=work)
    assert status == 2
    assert "libGLU.so.1" in err
    assert "libglu1-mesa" in err


def test_our_own_faults_are_not_blamed_on_the_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def work(run: Run, page: Page) -> None:
        raise FileNotFoundError(errno.ENOENT, "no such file", "template")

    case = Case("group/tiny", "t", "s", work)
    monkeypatch.setattr(sys, "argv", ["tiny.py", "--out", str(tmp_path / "out")])
    with pytest.raises(FileNotFoundError):
        main_of_case(case)


def test_ctrl_c_exits_130_and_keeps_the_earlier_results(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    def work(run: Run, page: Page) -> None:
        with run.step("long"):
            raise KeyboardInterrupt

    assert invoke("run", "tiny")[0] == 0
    before = (tmp_path / "reports/group/tiny/results.json").read_bytes()
    status, out, err = invoke("run", "tiny", work=work)
    assert (status, out) == (130, "")
    assert "stopped" in err
    assert (tmp_path / "reports/group/tiny/results.json").read_bytes() == before
    assert os.listdir(tmp_path / "reports/group") == ["tiny"]


def test_verdicts_of_an_earlier_run_do_not_outlive_a_stopped_one(
    invoke: Callable[..., Result], tmp_path: Path
) -> None:
    def stop(run: Run, page: Page) -> None:
        raise KeyboardInterrupt

    verdicts = tmp_path / "verdicts.xml"
    assert invoke("run", "tiny", "--junit", "verdicts.xml")[0] == 0
    assert 'name="ratio"' in verdicts.read_text()
    assert invoke("run", "tiny", "--junit", "verdicts.xml", work=stop)[0] == 130
    (test,) = ElementTree.parse(verdicts).iter("testcase")
    error = test.find("error")
    assert error is not None
    assert "not run" in error.attrib["message"]
    assert invoke("run", "tiny", "--junit", "verdicts.xml")[0] == 0
    assert invoke("run", "tinny", "--junit", "verdicts.xml")[0] == 2
    assert not verdicts.exists()


@pytest.mark.parametrize(("sent", "status"), [(signal.SIGINT, 130), (signal.SIGTERM, 143)])
def test_a_signal_leaves_nothing_behind(
    script: Path, tmp_path: Path, sent: signal.Signals, status: int
) -> None:
    command = [sys.executable, str(script), "--out", "out/x", "--set", "work=forever"]
    with subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True) as process:
        assert process.stderr is not None
        assert process.stderr.readline() == "work ...\n"
        (hidden,) = (tmp_path / "out").iterdir()
        assert hidden.name.startswith(".x-")
        process.send_signal(sent)
        err = process.stderr.read()
        assert process.wait(60) == status
    assert "Traceback" not in err
    assert list((tmp_path / "out").iterdir()) == []


@pytest.mark.parametrize("arguments", [["--out", "x"], ["--help"]])
def test_a_reader_that_goes_away_is_no_error(
    script: Path, tmp_path: Path, arguments: list[str]
) -> None:
    command = [sys.executable, str(script), *arguments]
    read, write = os.pipe()
    os.close(read)
    try:
        done = subprocess.run(
            command, cwd=tmp_path, stdout=write, stderr=subprocess.PIPE, text=True, check=False
        )
    finally:
        os.close(write)
    assert "Traceback" not in done.stderr
    assert "BrokenPipe" not in done.stderr
    if arguments != ["--help"]:
        assert done.returncode == 0
        assert (tmp_path / "x" / "report.html").is_file()


@pytest.mark.parametrize("on_terminal", [{}, {"FORCE_COLOR": "1", "TERM": "xterm"}])
def test_progress_nobody_reads_does_not_stop_a_run(
    script: Path, tmp_path: Path, on_terminal: dict[str, str]
) -> None:
    read, write = os.pipe()
    os.close(read)
    try:
        done = subprocess.run(
            [sys.executable, str(script), "--out", "x"],
            cwd=tmp_path,
            stdout=subprocess.PIPE,
            stderr=write,
            env={**os.environ, **on_terminal},
            text=True,
            check=False,
        )
    finally:
        os.close(write)
    assert done.returncode == 0
    assert "1 of 1 checks pass" in done.stdout


def test_a_narrow_encoding_is_no_error(script: Path, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, str(script), "--out", "x"],
        cwd=tmp_path,
        env={**os.environ, "PYTHONIOENCODING": "ascii"},
        capture_output=True,
        check=False,
    )
    assert done.returncode == 0
    assert b"? one" in done.stdout
