"""Each public function and class of the library has a use: in it, in a case, or on a page."""

import ast
import json
import re
import sys
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs"))

import house  # noqa: E402

BLOCK = re.compile(r"^```python\n(.*?)^```", re.DOTALL | re.MULTILINE)

#: Found by a name in a string.
BY_NAME = {"export.limited_reading.arrays_of"}


@cache
def words(source: str) -> frozenset[str]:
    """Names and attributes that a program does something with, not those that it imports."""
    return frozenset(
        node.id if isinstance(node, ast.Name) else node.attr
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.Name | ast.Attribute)
    )


def on_pages() -> set[str]:
    """Names that blocks of pages and cells of notebooks use, all of which run in tests."""
    pages = [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    sources = [block for page in pages for block in BLOCK.findall(page.read_text("utf-8"))]
    for path in (ROOT / "docs" / "notebooks").glob("*.ipynb"):
        cells = json.loads(path.read_text("utf-8"))["cells"]
        sources += ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
    return set().union(*map(words, sources))


def definitions(module: str) -> list[str]:
    """Public functions and classes of a module, without commands, which Typer calls."""
    tree = ast.parse(house.modules()[module].read_text("utf-8"))
    return [
        node.name
        for node in tree.body
        if isinstance(node, ast.FunctionDef | ast.ClassDef)
        and not node.name.startswith("_")
        and not any("command" in ast.unparse(one) for one in node.decorator_list)
    ]


def unused(module: str, shown: set[str]) -> list[str]:
    """Definitions of a module that neither it, nor another, nor a page uses."""
    readers = {module, *house.users()[module]}
    found = set().union(*(words(house.modules()[name].read_text("utf-8")) for name in readers))
    return [f"{module}.{n}" for n in definitions(module) if n not in found and n not in shown]


def test_no_public_definition_is_for_tests_alone() -> None:
    shown = on_pages()
    left = {
        name
        for module, path in house.modules().items()
        if path.name != "__init__.py"
        and not module.startswith(("cases.", "export.formats."))  # formats: found by `FORMATS`
        for name in unused(module, shown)
    }
    assert left == BY_NAME, "use it, show it on a page, or take it out with its tests"


def test_a_definition_without_a_use_is_noticed() -> None:
    """Those that pages alone use would be found without the pages."""
    assert "gear.iso.blank_factor" in unused("gear.iso", set())
    assert not unused("gear.iso", {"blank_factor"})
