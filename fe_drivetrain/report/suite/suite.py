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
from fe_drivetrain.common.jobs import pool
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
        As of `Run`; each case is given those that it takes.
    quick : bool
        As of `Run`.
    report : callable
        As of `Run`; the name of a step follows that of its case.
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
    from fe_drivetrain.report.history import check_history, record_run, seconds_before
    from fe_drivetrain.report.index import problems_before, write_index
    from fe_drivetrain.report.results import read_results

    out = Path(out)
    taken = settings_by_case(cases, settings or {})
    require_reports(out)
    asked = {case.name for case in cases}
    cases = [case for case in cases if case.name not in kept]
    known = list(all_cases())
    others = {name: why for name, why in problems_before(out).items() if name not in asked}
    problems: dict[str, Problem] = {}
    folders: dict[str, HiddenFolder] = {}
    pending = {case.name: PLANNED for case in cases}
    changing = threading.Lock()  # steps are reported by several threads

    def list_all() -> None:
        write_index(out, others | problems | pending, known)

    # a run that is killed could write no pages of what it has done
    pages = Repeated(list_all)

    def show(step: str, lane: int = 0) -> None:
        name = step.partition(": ")[0]
        if lane != OVERALL and pending.get(name) is PLANNED:
            with changing:
                if name in pending:
                    pending[name] = RUNNING
            pages.soon()
        report(step, lane)

    def finish(case: Case, problem: Problem | None) -> None:
        if problem:
            problems[case.name] = problem
        else:
            # whoever is stopped in between runs the case again: no result is without its history
            record_run(out, read_results(folders[case.name].path / "results.json"))
            put_in_place(folders[case.name], result_folder(out, case))
        with changing:
            del pending[case.name]
        pages.soon()
        count()

    def count() -> None:
        if len(cases) > 1:
            report(f"cases ({len(cases) - len(pending)} of {len(cases)})", OVERALL)

    try:
        for case in cases:
            folders[case.name] = new_folder(result_folder(out, case))
        check_history(out)
        pages.soon()
        count()
        took = seconds_before(out, quick)
        # at the end no process waits for another's long one; nobody knows how long a new one is
        beside = sorted(
            (case for case in cases if not case.runs_alone(quick)),
            key=lambda case: -took.get(case.name, math.inf),
        )
        with pool(len(beside), show, each_for_itself=True) as workers:
            jobs: dict[Future[Problem | None], Case] = {
                workers.start(
                    _run, case, folders[case.name].path, taken[case.name], quick, out
                ): case
                for case in beside
            }
            for job in workers.finished(jobs):
                finish(jobs[job], _outcome(job))
        for case in cases:
            if case.runs_alone(quick):
                with Processes(1, show, always=True, each_for_itself=True) as processes:
                    job = processes.start(
                        _run, case, folders[case.name].path, taken[case.name], quick, out
                    )
                    finish(case, _outcome(job))
    finally:
        pages.stop()
        for folder in folders.values():
            folder.discard()
        if len(folders) == len(cases):  # else nothing was begun
            write_index(out, others | problems | dict.fromkeys(pending, NOT_RUN), known)
    return problems


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
