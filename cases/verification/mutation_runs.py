"""Runs of tests on copies of the program with one fault each, and what they say of it."""

import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

from fe_drivetrain.cases.verification.mutation_rows import Fault, copy_of, with_fault
from fe_drivetrain.common import CORES_VARIABLE, Progress

PASSED, SKIPPED, ASSERTION = "passed", "skipped", "assertion"

CAUGHT, SURVIVES = "caught", "survives"
HANGS = "survives: its tests do not end in time"
RAISES = "survives: its tests end in errors, not in failed checks"

#: Variables of this process that would lead the tests to other programs, loops or results.
NOT_PASSED_ON = ("PYTHONSAFEPATH", "NUMBA_CACHE_DIR", "PYTEST_ADDOPTS", "PYTHONDONTWRITEBYTECODE")
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


@dataclass(frozen=True)
class Tried:
    """What tests say of a fault.

    Attributes
    ----------
    fault : Fault
        The fault.
    outcome : str
        `CAUGHT`, or one of the kinds of survivors.
    by : str
        The first test one of whose assertions fails, or the error that ended the tests.
    seconds : float
        Wall time [s].
    """

    fault: Fault
    outcome: str
    by: str
    seconds: float

    @property
    def caught(self) -> bool:
        """Whether an assertion failed of a test that passes without the fault."""
        return self.outcome == CAUGHT


class Bench:
    """A copy of the program without faults, and processes of tests beside it.

    Parameters
    ----------
    root : Path
        The clone.
    folder : Path
        An empty folder for all copies.
    limit : float
        Longest time of the tests of a fault [s].
    """

    def __init__(self, root: Path, folder: Path, limit: float) -> None:
        self.base = folder / "base"
        self.base.mkdir()
        self._folder = folder
        self._limit = limit
        self._processes: set[subprocess.Popen[str]] = set()
        self._lock = threading.Lock()
        self._ended = False
        copy_of(root, self.base)

    def control(self, tests: Sequence[str]) -> tuple[set[str], dict[str, str]]:
        """Run tests of a file without any fault.

        Parameters
        ----------
        tests : sequence of str
            Rows of one file.

        Returns
        -------
        passed : set
            Names of those that pass.
        others : dict
            Names of the others, or of the file, and what became of them.
        """
        lines, end = self._pytest(self.base, tests, False, 10.0 * self._limit)
        passed: set[str] = set()
        others: dict[str, str] = {}
        for test, when, outcome in lines:
            if outcome != PASSED:
                others[test] = outcome
            elif when == "call":
                passed.add(test)
        passed -= others.keys()
        if not passed:
            others.setdefault(" ".join(tests), f"no test passes: {end}")
        return passed, others

    def tried(self, fault: Fault, passing: set[str]) -> Tried:
        """Run the tests of a fault on a copy that has it.

        Parameters
        ----------
        fault : Fault
            The fault.
        passing : set of str
            Tests that pass without it.

        Returns
        -------
        Tried
        """
        start = time.monotonic()
        with self._copy(fault) as folder:
            lines, end = self._pytest(folder, fault.tests, True, self._limit)
        catches = [test for test, _, how in lines if how == ASSERTION and test in passing]
        silent = (PASSED, SKIPPED, ASSERTION)
        errors = [f"{test}: {how}" for test, _, how in lines if how not in silent]
        if catches:
            outcome, by = CAUGHT, catches[0]
        elif end == HANGS:
            outcome, by = HANGS, ""
        elif errors or end:
            outcome, by = RAISES, (errors or [end])[0]
        else:
            outcome, by = SURVIVES, ""
        return Tried(fault, outcome, by, time.monotonic() - start)

    def end(self) -> None:
        """End all processes that still run, and start no more."""
        with self._lock:
            self._ended = True
            for process in self._processes:
                _kill(process)

    @contextmanager
    def _copy(self, fault: Fault) -> Iterator[Path]:
        folder = Path(tempfile.mkdtemp(dir=self._folder)) / "copy"
        try:
            with_fault(self.base, folder, fault)
            yield folder
        finally:
            shutil.rmtree(folder.parent, ignore_errors=True)

    def _pytest(
        self, copy: Path, tests: Sequence[str], until: bool, limit: float
    ) -> tuple[list[tuple[str, str, str]], str]:
        """Test, phase and outcome of each line of the log; why there is less than all, or ""."""
        folder = Path(tempfile.mkdtemp(dir=self._folder))
        log = folder / "outcomes.jsonl"
        log.touch()
        options = ["-q", "-p", "no:cacheprovider", "-p", "outcome_log", f"--outcome-log={log}"]
        options += [f"--basetemp={folder / 'tmp'}", *(["--until-assertion"] if until else [])]
        command = [sys.executable, "-m", "pytest", *options, *(f"tests/{test}" for test in tests)]
        status, printed = self._run(command, copy, limit)
        rows = [json.loads(line) for line in log.read_text(encoding="utf-8").splitlines()]
        shutil.rmtree(folder, ignore_errors=True)
        lines = [(row["test"], row["when"], row["outcome"]) for row in rows]
        if status is None:
            return lines, HANGS
        last = (printed.strip().splitlines() or [""])[-1]
        # the first failed assertion stops pytest, which then ends as if it were interrupted
        sound = (0, 1, 2) if any(how == ASSERTION for *_, how in lines) else (0, 1)
        return lines, "" if status in sound and lines else f"status {status}: {last}"

    def _run(self, command: Sequence[str], copy: Path, limit: float) -> tuple[int | None, str]:
        """Exit status, or None where it took too long, and what it printed."""
        with self._lock:
            if self._ended:
                raise KeyboardInterrupt
            process = subprocess.Popen(
                command,
                cwd=copy,
                env=_environment(copy),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.STDOUT,
                text=True,
                start_new_session=True,
            )
            self._processes.add(process)
        try:
            printed, _ = process.communicate(timeout=limit)
        except subprocess.TimeoutExpired:
            _kill(process)
            process.communicate()
            return None, ""
        finally:
            self._processes.discard(process)
        return process.returncode, printed


def _environment(copy: Path) -> Mapping[str, str]:
    """Variables of a process that takes program and tests from a copy."""
    others = {
        name: value
        for name, value in os.environ.items()
        if name not in NOT_PASSED_ON and not name.startswith("FE_DRIVETRAIN_")
    }
    path = [str(copy), str(copy / "tests"), *(p for p in sys.path if p)]
    threads = {**dict.fromkeys(THREADS, "1"), CORES_VARIABLE: "1"}
    return {**others, **threads, "PYTHONPATH": os.pathsep.join(path)}


def _kill(process: subprocess.Popen[str]) -> None:
    """End a process and all that it has started."""
    with suppress(ProcessLookupError):
        os.killpg(process.pid, signal.SIGKILL)


def controlled(
    bench: Bench, faults: Sequence[Fault], jobs: int, report: Progress
) -> tuple[set[str], dict[str, str]]:
    """Run all tests of all faults once without any fault; see `Bench.control`."""
    by_file: dict[str, list[str]] = {}
    for test in dict.fromkeys(test for fault in faults for test in fault.tests):
        by_file.setdefault(test.partition("::")[0], []).append(test)
    # a whole file holds its tests
    files = [[file] if file in tests else tests for file, tests in by_file.items()]
    passed: set[str] = set()
    others: dict[str, str] = {}
    with _threads(bench, jobs) as threads:
        waiting = [threads.submit(bench.control, tests) for tests in files]
        for count, done in enumerate(as_completed(waiting), start=1):
            passed |= done.result()[0]
            others |= done.result()[1]
            report(f"tests without a fault ({count} of {len(files)} files)")
    return passed, others


def all_tried(
    bench: Bench, faults: Sequence[Fault], passing: set[str], jobs: int, report: Progress
) -> list[Tried]:
    """Try all faults, some at a time; in their order."""
    with _threads(bench, jobs) as threads:
        waiting = [threads.submit(bench.tried, fault, passing) for fault in faults]
        for count, _ in enumerate(as_completed(waiting), start=1):
            report(f"faults ({count} of {len(faults)})")
    return [one.result() for one in waiting]


@contextmanager
def _threads(bench: Bench, jobs: int) -> Iterator[ThreadPoolExecutor]:
    """Threads that wait for processes, which end where this one is interrupted."""
    with ThreadPoolExecutor(jobs) as threads:
        try:
            yield threads
        except BaseException:
            bench.end()
            threads.shutdown(wait=False, cancel_futures=True)
            raise
