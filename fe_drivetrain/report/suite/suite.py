"""Several cases in parallel, except those that measure time; and a page that lists them."""

from __future__ import annotations

import math
import platform
import threading
import traceback
from collections.abc import Collection, Mapping, Sequence
from concurrent.futures import Future
from pathlib import Path
from typing import Any

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import sentence_about
from fe_drivetrain.common.folders import HiddenFolder, empty
from fe_drivetrain.common.jobs import Pool, pool
from fe_drivetrain.common.processes import Processes
from fe_drivetrain.common.progress import OVERALL, Progress, silent
from fe_drivetrain.common.repeated import Repeated
from fe_drivetrain.common.stopped import stop_status
from fe_drivetrain.report.results import Problem
from fe_drivetrain.report.suite.case import Case, all_cases
from fe_drivetrain.report.suite.ownership import require_reports
from fe_drivetrain.report.suite.result_folders import (
    NOT_RUN,
    PLANNED,
    RUNNING,
    new_folder,
    problem_of,
    put_in_place,
    removed_in_one_sentence,
    result_folder,
    run_into,
)
from fe_drivetrain.report.suite.settings import settings_by_case


def run_cases(
    cases: Sequence[Case],
    out: Path,
    settings: Mapping[str, Any] | None = None,
    quick: bool = False,
    report: Progress = silent,
    kept: Collection[str] = (),
) -> dict[str, Problem]:
    """Run cases, each into ``out/GROUP/NAME``, and write ``out/index.html``.

    Independent cases run in processes side by side, as many as the cores allow, or on a cluster
    (`scheduled_by`), those first that took longest before; those that are to be `alone` come after
    them on this machine, one by one, each in a process that starts afresh. A case that fails does
    not keep the others from their work. Each result folder appears whole or not at all; when
    stopped, those of finished cases stay, and the page lists the others as not run.

    Parameters
    ----------
    cases : sequence of Case
        Which, each once.
    out : Path
        The folder above theirs.
    settings : mapping, optional
        As in `Run`; each case is given those that it takes.
    quick : bool
        As in `Run`.
    report : callable
        As in `Run`; the name of a step follows that of its case.
    kept : collection of str
        Names of cases whose results are there and stay, see `finished_cases`.

    Returns
    -------
    dict
        Why there are no results, by the name of the case.

    Raises
    ------
    InputError
        A result folder cannot be written or holds something else, or no case takes a setting.
    """
    out = Path(out)
    taken = settings_by_case(cases, settings or {})
    require_reports(out)
    left = [case for case in cases if case.name not in kept]
    listed = _Listed(out, {case.name for case in cases}, left, report)
    try:
        listed.begin()
        _run_all(left, listed, taken, quick)
    finally:
        listed.end()
    return listed.problems


def _run_all(
    cases: Sequence[Case],
    listed: _Listed,
    settings: Mapping[str, Mapping[str, Any]],
    quick: bool,
) -> None:
    """Run cases side by side, and then one by one those that are to be alone."""
    from fe_drivetrain.report.history import seconds_before

    took = seconds_before(listed.out, quick)

    def start(workers: Pool, case: Case) -> Future[Problem | None]:
        folder = listed.folders[case.name].path
        return workers.start(_run, case, folder, settings[case.name], quick, listed.out)

    # at the end no process waits for another's long one; nobody knows how long a new one is
    beside = sorted(
        (case for case in cases if not case.runs_alone(quick)),
        key=lambda case: -took.get(case.name, math.inf),
    )
    with pool(len(beside), listed.show, each_for_itself=True) as workers:
        jobs = {start(workers, case): case for case in beside}
        for job in workers.finished(jobs):
            listed.finish(jobs[job], _outcome(job))
    for case in (case for case in cases if case.runs_alone(quick)):
        with Processes(1, listed.show, always=True, each_for_itself=True) as processes:
            listed.finish(case, _outcome(start(processes, case)))


class _Listed:
    """Cases of a run in a folder of reports: how each stands, and the page that lists them.

    Attributes
    ----------
    out : Path
        The folder of reports.
    folders : dict
        Hidden folder of each case, by its name.
    problems : dict
        Why there are no results, by the name of the case.
    """

    def __init__(
        self, out: Path, asked: Collection[str], cases: Sequence[Case], report: Progress
    ) -> None:
        from fe_drivetrain.report.index import problems_before

        self.folders: dict[str, HiddenFolder] = {}
        self.problems: dict[str, Problem] = {}
        self.out, self._cases, self._report = out, cases, report
        self._others = {n: why for n, why in problems_before(out).items() if n not in asked}
        self._pending = {case.name: PLANNED for case in cases}
        self._known = list(all_cases())
        self._changing = threading.Lock()  # steps are reported by several threads
        # a run that is killed could write no pages of what it has done
        self._pages = Repeated(lambda: self._write(self._pending))

    def begin(self) -> None:
        """Make a folder for each case, and list all of them."""
        from fe_drivetrain.report.history import check_history

        for case in self._cases:
            self.folders[case.name] = new_folder(result_folder(self.out, case))
        check_history(self.out)
        self._pages.soon()
        self._count()

    def show(self, step: str, lane: int = 0) -> None:
        """Report a step, and list the case that it belongs to as running."""
        name = step.partition(": ")[0]
        if lane != OVERALL and self._pending.get(name) is PLANNED:
            with self._changing:
                if name in self._pending:
                    self._pending[name] = RUNNING
            self._pages.soon()
        self._report(step, lane)

    def finish(self, case: Case, problem: Problem | None) -> None:
        """Put the results of a case in place, or keep why there are none."""
        from fe_drivetrain.report.history import record_run
        from fe_drivetrain.report.results import read_results

        if problem:
            self.problems[case.name] = problem
        else:
            folder = self.folders[case.name]
            # whoever is stopped in between runs the case again: no result is without its history
            record_run(self.out, read_results(folder.path / "results.json"))
            put_in_place(folder, result_folder(self.out, case))
        with self._changing:
            del self._pending[case.name]
        self._pages.soon()
        self._count()

    def end(self) -> None:
        """Remove what is left of folders, and list cases without results as not run."""
        self._pages.stop()
        for folder in self.folders.values():
            folder.discard()
        if len(self.folders) == len(self._cases):  # else nothing was begun
            self._write(dict.fromkeys(self._pending, NOT_RUN))

    def _write(self, pending: dict[str, Problem]) -> None:
        from fe_drivetrain.report.index import write_index

        write_index(self.out, self._others | self.problems | pending, self._known)

    def _count(self) -> None:
        if len(self._cases) > 1:
            done = len(self._cases) - len(self._pending)
            self._report(f"cases ({done} of {len(self._cases)})", OVERALL)


def _outcome(job: Future[Problem | None]) -> Problem | None:
    """What a case's process said of it, or how it died."""
    try:
        return job.result()
    except (InputError, RuntimeError) as error:
        return Problem(str(error))


def _run(
    report: Progress,
    case: Case,
    folder: Path,
    settings: Mapping[str, Any],
    quick: bool,
    shared: Path,
) -> Problem | None:
    """Run a case into a folder; why there are no results, if there are none."""

    def named(step: str, lane: int = 0) -> None:
        report(f"{case.name}: {step}" if step else "", lane)

    try:
        if not folder.is_dir():
            raise InputError(
                f"{platform.node()} does not see {folder}: give a folder with --out that "
                "all workers share"
            )
        empty(folder)  # a worker may have died half-way
        with removed_in_one_sentence(folder):
            run_into(case, folder, settings, quick, named, shared)
    except InputError as error:
        return problem_of(error)
    except Exception as error:
        if stop_status(error) is not None:
            raise
        sentence = sentence_about(error) if isinstance(error, OSError) else None
        if sentence is not None:
            return Problem(sentence)
        traceback.print_exc()
        return Problem(f"ended by an error of its own, {type(error).__name__}: {error}")
    return None
