"""The commands ``list`` and ``run``: find cases, run them, and print each verdict."""

from __future__ import annotations

import sys
from collections.abc import Callable, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.core import TyperCommand

from fe_drivetrain.command_line.answer_text import several_results_text, show_outcome, write_json
from fe_drivetrain.command_line.names import complete_case
from fe_drivetrain.command_line.options import Scheduler
from fe_drivetrain.command_line.output_options import open_if_asked, wants_json
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.settings import CaseSettings, parse_settings
from fe_drivetrain.command_line.terminal import FAILED, MISTAKE, PASSED, guarded, write
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import scheduled_by
from fe_drivetrain.common.threads import hold_threads

if TYPE_CHECKING:
    from fe_drivetrain.report.results import Problem, Results
    from fe_drivetrain.report.suite.case import Case

OutFolder = Annotated[
    Path | None,
    typer.Option(
        "--out",
        metavar="DIR",
        help="Result folder: new, empty, or of an earlier run, whose own files are replaced; files "
        "of yours in it stay. "
        "Default: reports/GROUP/NAME in the current folder. For several cases, the folder above "
        "their result folders: DIR/GROUP/NAME.",
    ),
]
Quick = Annotated[bool, typer.Option("--quick", help="Coarser and smaller, for a first look.")]


def list_command(
    words: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="WORD",
            help="Cases whose group, name or title has this in it; of several, all of them.",
        ),
    ] = None,
    settings: Annotated[
        bool, typer.Option("--settings", help="Show what --set changes of each case, too.")
    ] = False,
) -> None:
    """List the validation cases, or those with a word in group, name or title."""

    def work() -> int:
        from fe_drivetrain.report.suite.case import all_cases

        cases = _with_words(all_cases(), words or ())
        taken = {}
        if settings:
            from fe_drivetrain.report.suite.settings import settings_in_words

            taken = {name: settings_in_words(case) for name, case in cases.items()}
        if wants_json():
            write_json(
                [
                    {"name": name, "title": one.title, "source": one.source}
                    | ({"settings": taken[name]} if settings else {})
                    for name, one in cases.items()
                ]
            )
            return PASSED
        write(sys.stdout, cases_text({name: case.title for name, case in cases.items()}, taken))
        return PASSED

    raise typer.Exit(guarded(work))


def _with_words(cases: Mapping[str, Case], words: Sequence[str]) -> dict[str, Case]:
    """Cases whose name or title has each of the words in it; those of a group by its name alone.

    Raises
    ------
    InputError
        There is none.
    """
    if len(words) == 1:
        group = {name: one for name, one in cases.items() if name.startswith(f"{words[0]}/")}
        if group:
            return group
    found = {
        name: one
        for name, one in cases.items()
        if all(word.lower() in f"{name} {one.title}".lower() for word in words)
    }
    if not found:
        raise InputError(
            f"no case has {' and '.join(map(repr, words))} in group, name or title: leave it out "
            "to list all"
        )
    return found


def run_command(
    cases: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="CASE",
            autocompletion=complete_case,
            help="GROUP/NAME, NAME if it is unique, or GROUP for all its cases. CASE --help shows "
            "what --set changes of it.",
        ),
    ] = None,
    all_: Annotated[bool, typer.Option("--all", help="Run every case.")] = False,
    out: OutFolder = None,
    set_: CaseSettings = None,
    quick: Quick = False,
    resume: Annotated[
        bool,
        typer.Option(
            "--resume",
            help="Go on where a run of several cases was stopped: leave out those whose results "
            "are there, made by the same program with the same settings. A case with a file of "
            "your own (scene, loads) runs again.",
        ),
    ] = False,
    junit: Annotated[
        Path | None,
        typer.Option(
            "--junit", metavar="FILE", help="Write the verdicts as JUnit XML, for CI servers."
        ),
    ] = None,
    scheduler: Scheduler = None,
) -> None:
    """Run validation cases and write their reports.

    Several cases run in parallel processes, as many as there are cores, or on a cluster, except
    those that measure time, which run one by one at the end, on this machine; in quick runs only
    those whose checks depend on it. An index.html lists all of them.

    The exit status is 0 if every check passes, 1 if one fails, 2 for a wrong option or setting,
    and 130 if stopped. A case that needs a program that is not installed is listed as skipped.
    """
    names = cases or []

    def find() -> list[Case]:
        from fe_drivetrain.report.suite.case import all_cases, find_cases

        if all_ and names:
            raise InputError(f"--all runs {', '.join(names)} too: leave one of the two out")
        if not all_ and not names:
            raise InputError("Missing CASE: name one or more, or give --all")
        if all_:
            return list(all_cases().values())
        found = [case for name in names for case in find_cases(name)]
        return list({case.name: case for case in found}.values())

    raise typer.Exit(run_and_print(find, out, set_ or (), quick, junit, resume, scheduler))


class HelpOfCases(TyperCommand):
    """Help that ends with the source and the settings of the cases that were named."""

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Keep what was typed: ``--help`` ends the program before arguments are read.

        Parameters
        ----------
        ctx : click.Context
            Keeps it.
        args : list of str
            What was typed.

        Returns
        -------
        list of str
        """
        ctx.meta["typed"] = list(args)
        return super().parse_args(ctx, args)

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help, and what is said of the cases, if there are any.

        Parameters
        ----------
        ctx : click.Context
            With what was typed.
        formatter : click.HelpFormatter
            As of click.
        """
        super().format_help(ctx, formatter)
        if words := [word for word in ctx.meta.get("typed", ()) if not word.startswith("-")]:
            write(sys.stdout, help_of_cases(words))


def help_of_cases(names: Sequence[str]) -> str:
    """Title, source and settings of cases in plain text.

    Parameters
    ----------
    names : sequence of str
        As typed; an unknown one is said to be unknown.

    Returns
    -------
    str
    """
    from fe_drivetrain.report.suite.case import find_cases
    from fe_drivetrain.report.suite.settings import settings_in_words

    lines = []
    for name in names:
        try:
            found = find_cases(name)
        except InputError as error:
            lines += [f"{error}", ""]
            continue
        for case in found:
            taken = settings_in_words(case) or "nothing"
            lines += [case.name, f"  {case.title}", f"  Source: {case.source}"]
            lines += [f"  --set: {taken}", ""]
    return "\n".join(lines)


def run_and_print(
    find: Callable[[], Sequence[Case]],
    out: Path | None = None,
    settings: Sequence[str] = (),
    quick: bool = False,
    junit: Path | None = None,
    resume: bool = False,
    scheduler: str | None = None,
) -> int:
    """Run cases, several of them in parallel, and print the verdicts.

    Parameters
    ----------
    find : callable
        Returns the cases.
    out : Path or None
        Result folder of one case, or the folder above those of several; None for ``reports``.
    settings : sequence of str
        Each "KEY=VALUE".
    quick : bool
        Coarser and smaller.
    junit : Path or None
        File for the verdicts as JUnit XML.
    resume : bool
        Leave out cases whose results are there already; for several cases.
    scheduler : str or None
        Address of the cluster that does the work.

    Returns
    -------
    int
        Exit status.
    """

    def work() -> int:
        hold_threads()
        values = parse_settings(settings)
        if junit is not None:
            _prepare_junit(junit)
        cases = find()
        if resume and len(cases) == 1:
            raise InputError(
                "--resume is for several cases, and a long one goes on by itself: leave it out"
            )
        results: dict[str, Results]
        problems: dict[str, Problem] = {}
        # stays if the run is stopped
        _write_junit(junit, cases)
        with scheduled_by(scheduler):
            if len(cases) == 1:
                results = {cases[0].name: _run_one(cases[0], out, values, quick)}
            else:
                results, problems = _run_several(cases, out, values, quick, resume)
        _write_junit(junit, cases, results, problems)
        if any(problem.state != "skipped" for problem in problems.values()):
            return MISTAKE
        return PASSED if all(found.passed for found in results.values()) else FAILED

    return guarded(work, "finished cases are kept, others are as they were")


def _prepare_junit(file: Path) -> None:
    """Refuse a file that cannot be written, and remove that of an earlier run."""
    from fe_drivetrain.report.junit import check_junit

    if not file.resolve().parent.is_dir():
        raise InputError(f"--junit {file}: there is no folder {file.parent}: create it first")
    check_junit(file)
    # of an earlier run: it says nothing of this one
    file.resolve().unlink(missing_ok=True)


def _write_junit(
    file: Path | None,
    cases: Sequence[Case],
    results: Mapping[str, Results] | None = None,
    problems: Mapping[str, Problem] | None = None,
) -> None:
    """Write the verdicts where a file is given for them; without any, all cases as not run."""
    if file is None:
        return
    from fe_drivetrain.report.junit import write_junit
    from fe_drivetrain.report.suite.result_folders import NOT_RUN

    names = [case.name for case in cases]
    missing = dict.fromkeys(names, NOT_RUN) if problems is None else problems
    write_junit(file, names, results or {}, missing)


def _run_one(case: Case, out: Path | None, settings: Mapping[str, Any], quick: bool) -> Results:
    from fe_drivetrain.report.suite.result_folders import run_case

    folder = Path("reports", *case.name.split("/")) if out is None else out
    with show_steps() as report:
        # a link or "." is resolved, so that the folder it leads to is replaced, not the link
        results = run_case(case, folder.resolve(), settings, quick, report)
    show_outcome(results, folder / "report.html")
    return results


def _run_several(
    cases: Sequence[Case],
    out: Path | None,
    settings: Mapping[str, Any],
    quick: bool,
    resume: bool,
) -> tuple[dict[str, Results], dict[str, Problem]]:
    from fe_drivetrain.report.results import read_results
    from fe_drivetrain.report.suite.result_folders import result_folder
    from fe_drivetrain.report.suite.resuming import finished_cases
    from fe_drivetrain.report.suite.suite import run_cases

    folder = Path("reports") if out is None else out
    kept = finished_cases(cases, folder.resolve(), settings, quick) if resume else []
    if kept:
        write(sys.stderr, f"{len(kept)} of {len(cases)} cases are there from an earlier run\n")
    with show_steps() as report:
        problems = run_cases(cases, folder.resolve(), settings, quick, report, kept)
    results = {
        case.name: read_results(result_folder(folder, case) / "results.json")
        for case in cases
        if case.name not in problems
    }
    names, page = [case.name for case in cases], folder / "index.html"
    if wants_json():
        write_json({name: _as_json(results.get(name), problems.get(name)) for name in names})
    else:
        write(sys.stdout, several_results_text(names, results, problems, page))
    open_if_asked(page)
    return results, problems


def _as_json(results: Results | None, problem: Problem | None) -> Any:
    """The answer of a case; or why there is none."""
    if problem is not None:
        return {"state": problem.state, "message": problem.message}
    answer = None if results is None else results.answer
    return None if answer is None else answer.model_dump(mode="json")


def cases_text(titles: Mapping[str, str], settings: Mapping[str, str]) -> str:
    """Names and titles of cases, one a line, under their groups.

    Parameters
    ----------
    titles : mapping
        Title by "GROUP/NAME", in order.
    settings : mapping
        What can be set, by the same names, for a line below; none where there is nothing.

    Returns
    -------
    str
    """
    width = max((len(name) for name in titles), default=0)
    groups = []
    for group, names in groupby(titles, lambda name: name.partition("/")[0]):
        lines = [group]
        for name in names:
            lines.append(f"  {name:<{width}}  {titles[name]}")
            if settings.get(name):
                lines.append(f"  {'':<{width}}  --set: {settings[name]}")
        groups.append("\n".join([*lines, ""]))
    return "\n".join(groups)
