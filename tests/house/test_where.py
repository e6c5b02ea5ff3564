"""The table "Where is what" of CONTRIBUTING.md names functions and classes that are there."""

import ast
import difflib
import re
import sys
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs"))

import house  # noqa: E402

TEXT = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")


def named(text: str) -> list[str]:
    """Names of the table's second column."""
    table = text.partition("### Where is what")[2].partition("\n## ")[0]
    cells = [line.split("|")[2] for line in table.splitlines() if line.startswith("| ")]
    return [name for cell in cells for name in re.findall(r"`([^`]+)`", cell)]


@cache
def defined() -> dict[str, list[str]]:
    """Public functions and classes, each with the modules that define one of that name."""
    found: dict[str, list[str]] = {}
    for module, path in house.modules().items():
        for node in ast.parse(path.read_text(encoding="utf-8")).body:
            if isinstance(node, ast.FunctionDef | ast.ClassDef):
                found.setdefault(node.name, []).append(module)
    return found


def fault(name: str) -> str:
    """What to write in place of a name that is not there; empty where it is."""
    module, _, definition = name.rpartition(".")
    places = defined().get(definition, [])
    if module in places:
        return ""
    if places:
        now = " or ".join(f"{place}.{definition}" for place in places)
        return f"CONTRIBUTING.md, Where is what: {name} is now {now}: change the row"
    like = difflib.get_close_matches(definition, defined(), n=3)
    near = ", ".join(f"{place}.{one}" for one in like for place in defined()[one]) or "nothing"
    return f"CONTRIBUTING.md, Where is what: {name} is gone; near it: {near}: change the row"


@pytest.mark.parametrize("name", named(TEXT))
def test_what_the_table_names_is_there(name: str) -> None:
    assert not fault(name), fault(name)


def test_the_table_has_what_newcomers_looked_for() -> None:
    table = TEXT.partition("### Where is what")[2].partition("\n## ")[0]
    for words in ("K_R", "bonded", "ISO/TS 16281", "mesh stiffness", "rainflow", "Timoshenko"):
        assert words in table
    assert len(named(TEXT)) > 25


def test_a_row_that_is_out_of_date_says_what_to_change() -> None:
    assert "is now comparison.convergence.grid_convergence" in fault("nowhere.grid_convergence")
    assert "comparison.convergence.grid_convergence" in fault("nowhere.grid_convergences")
