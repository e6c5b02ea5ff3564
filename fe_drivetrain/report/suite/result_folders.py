"""Result folders: a case runs into one, which appears whole or not at all."""

from __future__ import annotations

import os
import threading
import warnings
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager, nullcontext, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fe_drivetrain.common.errors import InputError, MissingToolError
from fe_drivetrain.common.folders import HiddenFolder
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.stopped import replacing
from fe_drivetrain.report.results import Problem
from fe_drivetrain.report.suite.case import Case, all_cases
from fe_drivetrain.report.suite.ownership import (
    check_result_folder,
    claim_reports,
    not_writable,
    own_files,
)
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.report.suite.settings import settings_by_case

if TYPE_CHECKING:
    from fe_drivetrain.report.results import Results

NOT_RUN = Problem("not run: the run has not come to its end", "not run")
"""Of a case that has not had its turn, or not come to its end."""
PLANNED = Problem("waits for its turn", "planned")
"""Of a case whose turn comes."""
RUNNING = Problem("at work", "running")
"""Of a case whose turn it is."""

_ONE_BY_ONE = threading.RLock()
"""Held by a thread that writes into a folder of reports; the same thread may take it again."""


def problem_of(error: InputError) -> Problem:
    """Why there are no results: an input's fault, or a program that is missing."""
    return Problem(str(error), "skipped" if isinstance(error, MissingToolError) else "failed")


def result_folder(out: Path, case: Case) -> Path:
    """Where the results of a case go below a folder for several."""
    return out.joinpath(*case.name.split("/"))


def shared_folder(out: Path, case: Case) -> Path | None:
    """The folder whose pages share a history and scripts; None where ``out`` stands by itself.

    Parameters
    ----------
    out : Path
        The result folder.
    case : Case
        Whose it is.

    Returns
    -------
    Path or None
        ``reports`` of ``reports/GROUP/NAME``.
    """
    name = tuple(case.name.split("/"))
    return out.parents[len(name) - 1] if out.parts[-len(name) :] == name else None


def run_case(
    case: Case,
    out: Path,
    settings: Mapping[str, Any] | None = None,
    quick: bool = False,
    report: Progress = silent,
    into: Callable[..., Results] | None = None,
) -> Results:
    """Run a case and write its result folder: results.json, report.html and what else it makes.

    Everything is written to a hidden folder beside ``out`` first, so that a run that fails or is
    stopped leaves what was there before. Of a run that was killed, the next one into the same place
    removes that folder. Files in ``out`` that the earlier run did not write, or that were changed
    since, stay: under another name where this run writes one of the same name. Where ``out`` is
    GROUP/NAME of a folder of reports, the pages that list the cases there are written again.

    Parameters
    ----------
    case : Case
        What to run.
    out : Path
        The result folder. It must not exist, be empty, or be of an earlier run.
    settings : mapping, optional
        As in `Run`.
    quick : bool
        As in `Run`.
    report : callable
        As in `Run`.
    into : callable, optional
        Runs it into a folder in place of `run_into`, in another process, say.

    Raises
    ------
    InputError
        The settings are wrong, or ``out`` cannot be written or holds something else.
    """
    from fe_drivetrain.report.history import carry_history, check_history, record_run

    out = Path(out)
    taken = settings_by_case([case], settings or {})[case.name]
    check_result_folder(out)
    replacing((out / "results.json").is_file())
    shared = shared_folder(out, case)
    with _ONE_BY_ONE:
        if shared is not None and not claim_reports(shared):
            shared = None  # of somebody else: no page of ours goes there
        folder = new_folder(out)
    try:
        if shared is None:
            carry_history(out, folder.path)
        check_history(shared or folder.path)
        with removed_in_one_sentence(folder.path), _listed(case, shared):
            results = (into or run_into)(case, folder.path, taken, quick, report, shared)
            with _ONE_BY_ONE:
                # before others see the folder, and may put another in its place
                record_run(shared or folder.path, results)
                put_in_place(folder, out)
    finally:
        folder.discard()
    return results


@contextmanager
def _listed(case: Case, shared: Path | None) -> Iterator[None]:
    """Let the pages of a folder of reports say that a case runs, and then what came of it."""
    if shared is None:
        yield
        return
    from fe_drivetrain.report.index import problems_before, write_index

    def write(own: Mapping[str, Problem]) -> None:
        with _ONE_BY_ONE:
            before = problems_before(shared).items()
            others = {name: why for name, why in before if name != case.name}
            write_index(shared, {**others, **own}, known)

    known = list(all_cases())
    write({case.name: RUNNING})
    left = {case.name: NOT_RUN}
    try:
        yield
        left = {}
    except InputError as error:
        left = {case.name: problem_of(error)}
        raise
    finally:
        write(left)


def run_into(
    case: Case,
    folder: Path,
    settings: Mapping[str, Any],
    quick: bool,
    report: Progress,
    shared: Path | None = None,
) -> Results:
    """Run a case and write its results and its page into a folder as it goes; see `run_case`.

    Parameters
    ----------
    case : Case
        What to run.
    folder : Path
        Where it writes.
    settings : mapping
        As in `Run`.
    quick : bool
        As in `Run`.
    report : callable
        As in `Run`.
    shared : Path, optional
        As in `fe_drivetrain.report.write_page`.

    Returns
    -------
    Results
        As written.
    """
    from fe_drivetrain.common import cache
    from fe_drivetrain.report.page import write_page

    run = Run(settings, quick, folder, report)
    with cache.switched_off() if case.alone else nullcontext():
        results = case.results(run)
    with run.step("report"):
        (folder / "results.json").write_text(results.model_dump_json(indent=1), "utf-8")
        write_page(folder, shared)
    return results


def new_folder(out: Path) -> HiddenFolder:
    """A hidden folder beside the result folder ``out``, for `put_in_place` when it is complete.

    Raises
    ------
    InputError
        ``out`` cannot be written or holds something else.
    """
    check_result_folder(out)
    try:
        return HiddenFolder(out, own_files)
    except OSError as error:
        raise not_writable(out.parent, error) from error


def put_in_place(folder: HiddenFolder, out: Path) -> None:
    """Put a complete folder of `new_folder` in the place of an older one.

    What is in the older one and was not written by the run that made it goes over.

    Raises
    ------
    InputError
        ``out`` cannot be written; it is as it was.
    """
    try:
        here = Path.cwd()
    except FileNotFoundError:  # somebody has removed it
        here = Path(out.anchor)
    try:
        folder.put_in_place()
    except OSError as error:
        raise not_writable(out, error) from error
    if here.is_relative_to(out.resolve()):
        # this process would stay in the folder that has gone; a shell does
        with suppress(OSError):
            os.chdir(here)
        warnings.warn(
            f"you are in {here}, which has been replaced: type cd . to see the new results",
            stacklevel=2,
        )


@contextmanager
def removed_in_one_sentence(folder: Path) -> Iterator[None]:
    """Tell the user of a folder that somebody has removed while a run wrote into it."""
    try:
        yield
    except FileNotFoundError as error:
        if folder.is_dir():
            raise
        raise InputError(
            f"{folder.parent} was removed, or what the run was writing in it: run it again"
        ) from error
