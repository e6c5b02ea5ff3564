"""Modules that docstrings and comments name are there, under their name of today."""

import ast
import importlib
import re
import sys
import tokenize
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))

import house

MODULES = house.modules()

#: A dotted name between single backticks whose first part is in lower case, as modules are.
NAME = re.compile(r"(?<!`)`([a-z]\w*(?:\.\w+)+)`(?!`)")


def texts(file: Path) -> Iterator[tuple[str, set[str]]]:
    """Docstrings and comments of a file, with the parameters that may be meant."""
    for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Module | ast.ClassDef | ast.FunctionDef):
            of = node.args if isinstance(node, ast.FunctionDef) else None
            own = {a.arg for a in (*of.args, *of.kwonlyargs)} if of else set()
            yield ast.get_docstring(node) or "", own
    with tokenize.open(file) as stream:
        for token in tokenize.generate_tokens(stream.readline):
            if token.type == tokenize.COMMENT:
                yield token.string, set()


def resolves(name: str) -> bool:
    """Whether a name leads to something from any module that it may begin with."""
    first, _, rest = name.partition(".")
    ends = [module for module in MODULES if module.rpartition(".")[2] == first]
    starts = [name, *(f"{house.PACKAGE}.{module}.{rest}" for module in ends)]
    return any(leads_somewhere(start) for start in starts)


def leads_somewhere(path: str) -> bool:
    parts = path.split(".")
    for count in range(len(parts), 0, -1):
        try:
            found: Any = importlib.import_module(".".join(parts[:count]))
        except ImportError:
            continue
        for part in parts[count:]:
            if part in getattr(found, "__annotations__", {}):  # a field without a default
                return True
            if not hasattr(found, part):
                return False
            found = getattr(found, part)
        return True
    return False


@pytest.mark.parametrize("room", sorted({house.room_of(module) for module in MODULES} - {""}))
def test_named_modules_and_what_they_hold_are_there(room: str) -> None:
    missing = [
        (module, name)
        for module, file in MODULES.items()
        if house.room_of(module) == room
        for text, own in texts(file)
        for name in NAME.findall(text)
        if name.partition(".")[0] not in own and not resolves(name)
    ]
    assert not missing


def test_a_module_of_yesterday_is_noticed() -> None:
    assert resolves("ladder.shaft_level")
    assert resolves("fe_drivetrain.shafts.fidelity.LevelModel")
    assert not resolves("levels.shaft_level")
    assert not resolves("mesh_checks.Fault")
