"""The page of a result from Python: what its command writes, but for tables as files."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.result_folders import run_case
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.result import Result

PAGES = frozenset(
    {
        *("advise", "advise_turning", "check", "compare", "export", "gears", "life", "loads"),
        *("modes", "study", "transient", "uncertainty", "validate"),
    }
)
"""Studies with a page: each has a module of its name in this room."""


def write_page(result: Result, folder: str | Path) -> Path:
    """Write a result's report.html and results.json, which `validate` takes as evidence.

    Parameters
    ----------
    result : Result
        Result of a study.
    folder : str or Path
        Result folder, as in "reports/modes/mine": a project links it by its last two parts. It must
        not exist, be empty, or be of an earlier result.

    Returns
    -------
    Path
        The page.

    Raises
    ------
    InputError
        The study has no page, or the folder has other files.
    """
    study = result.STUDY
    if study not in PAGES:
        raise InputError(
            f"{study or 'this result'} has no page: write one of {', '.join(sorted(PAGES))}, or "
            "take its to_json()"
        )
    show = getattr(import_module(f"fe_drivetrain.pages.{study}"), f"show_{study}")
    out = Path(folder).resolve()

    def work(run: Run, page: Page) -> None:
        run.take(result)
        page.take(result)
        show(run, page, result)

    titles = " and ".join(dict.fromkeys(one.title for one in result.drivetrains))
    name = study.replace("_", " ")
    case = Case(
        f"{out.parent.name}/{out.name}",
        f"{titles}: {name}" if titles else name,
        "the user's drivetrain",
        work,
        command=f"a script: {study}(...)",
    )
    run_case(case, out)
    return out / "report.html"
