"""Pages of studies: each shows one result and nothing else, and commands make none."""

import importlib
import inspect
import sys
from pathlib import Path
from types import NoneType
from typing import get_type_hints

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs"))

import house  # noqa: E402

from fe_drivetrain import studies  # noqa: E402
from fe_drivetrain.report.suite.page import Page  # noqa: E402
from fe_drivetrain.report.suite.run import Run  # noqa: E402
from fe_drivetrain.studies.result import Result  # noqa: E402

#: Studies whose result a command prints.
WITHOUT_PAGE = {"part"}

RESULTS = {
    found.STUDY: found
    for found in (getattr(studies, name) for name in studies.__all__)
    if inspect.isclass(found) and issubclass(found, Result) and found is not Result
}


@pytest.mark.parametrize("study", sorted(RESULTS.keys() - WITHOUT_PAGE))
def test_a_page_takes_a_run_a_page_and_a_result_and_nothing_else(study: str) -> None:
    module = importlib.import_module(f"fe_drivetrain.pages.{study}")
    shown = {"run": Run, "page": Page, "result": RESULTS[study], "return": NoneType}
    assert get_type_hints(getattr(module, f"show_{study}"), vars(module)) == shown


def test_every_page_is_that_of_a_study() -> None:
    pages = {
        name: path.stem
        for path in (ROOT / "fe_drivetrain" / "pages").glob("*.py")
        for name in vars(importlib.import_module(f"fe_drivetrain.pages.{path.stem}"))
        if name.startswith("show_")
    }
    assert pages == {f"show_{study}": study for study in RESULTS.keys() - WITHOUT_PAGE}


def test_no_command_makes_a_chart() -> None:
    modules = house.modules()
    commands = [name for name in modules if house.room_of(name) == "command_line"]
    assert commands
    for name in commands:
        targets = house.used(modules[name], name)
        assert not [t for t in targets if t == "report.charts" or house.room_of(t) == "plots"]
