"""No number of a case that stands as computed is typed in: read in the scripts of all cases."""

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

CASES = Path(__file__).parents[2] / "cases"
SCRIPTS = sorted(CASES.rglob("*.py"))
JUDGES = ("equals", "vanishes", "at_most", "at_least", "between", "found")
#: Words of headings whose cells are this program's own.
OWN = re.compile(r"\b(ours|computed|this program|this run)\b")


def is_typed(node: ast.expr) -> bool:
    """A number, or words with a digit, that nothing was computed for."""
    if isinstance(node, ast.UnaryOp):
        return is_typed(node.operand)
    if not isinstance(node, ast.Constant) or isinstance(node.value, bool):
        return False
    value = node.value
    return isinstance(value, int | float) or (
        isinstance(value, str) and bool(re.search(r"\d", value))
    )


def of_checks(tree: ast.AST) -> Iterator[ast.expr]:
    """What checks of a page, and its answers, are given as computed."""
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
            continue
        of_page = isinstance(node.func.value, ast.Name) and node.func.value.id == "page"
        if of_page and node.func.attr in JUDGES and len(node.args) > 1:
            yield node.args[1]


def of_records(tree: ast.AST) -> Iterator[ast.expr]:
    """Values of records under keys that say that they are this program's."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Dict):
            for key, value in zip(node.keys, node.values, strict=True):
                if isinstance(key, ast.Constant) and OWN.search(str(key.value)):
                    yield value


def of_tables(tree: ast.AST) -> Iterator[ast.expr]:
    """Cells of plain rows in columns that say that they are this program's."""
    for node in ast.walk(tree):
        if not (isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute)):
            continue
        if node.func.attr != "table" or len(node.args) < 3:
            continue
        rows, columns = node.args[1:3]
        if not (isinstance(rows, ast.List) and isinstance(columns, ast.List)):
            continue
        names = [str(c.value) if isinstance(c, ast.Constant) else "" for c in columns.elts]
        for row in rows.elts:
            if isinstance(row, ast.List | ast.Tuple) and len(row.elts) == len(names):
                yield from (
                    cell for name, cell in zip(names, row.elts, strict=True) if OWN.search(name)
                )


def typed_in(source: str) -> list[str]:
    """Each typed result by its line."""
    tree = ast.parse(source)
    found = (node for of in (of_checks, of_records, of_tables) for node in of(tree))
    return [f"line {node.lineno}: {ast.unparse(node)}" for node in found if is_typed(node)]


@pytest.mark.parametrize(
    "source",
    [
        'page.equals("force [N]", 12.5, reference, within=0.1)',
        'page.found("force [N]", -3)',
        'rows = [{"statement": "least force", "ours": "0.5"}]',
        'page.table("Words", [["least force", "0", "0"]], ["statement", "printed", "ours"])',
    ],
)
def test_typed_results_are_found(source: str) -> None:
    assert len(typed_in(source)) == 1


def test_what_is_printed_or_computed_is_not() -> None:
    source = (
        'page.table("Words", [["least force", "0", f"{least:.2f}"]], '
        '["statement", "printed", "ours"])\n'
        'page.equals("force", found, 3.0, within=0.1)\n'
        'rows = [{"ours": value, "printed": 4.0}]'
    )
    assert not typed_in(source)


def test_no_case_has_typed_results() -> None:
    assert len(SCRIPTS) > 200
    found = {str(p.relative_to(CASES)): typed_in(p.read_text(encoding="utf-8")) for p in SCRIPTS}
    assert {name: lines for name, lines in found.items() if lines} == {}
