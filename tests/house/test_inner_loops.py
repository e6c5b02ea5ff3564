"""Loops that only other loops may call: without what lets Python call them, a call ends Python."""

import ast
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).parents[2]
FOLDERS = ("fe_drivetrain", "geometry", "cases", "tests")


def decorated(node: ast.AST, *names: str) -> bool:
    """Whether a function has a decorator with one of these names."""
    return isinstance(node, ast.FunctionDef) and any(
        ast.unparse(one).partition("(")[0] in names for one in node.decorator_list
    )


def dotted(node: ast.AST) -> str:
    """A name, or names joined by dots; empty of anything else."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute) and (before := dotted(node.value)):
        return f"{before}.{node.attr}"
    return ""


def calls_from_python(tree: ast.AST, names: dict[str, str]) -> Iterator[str]:
    """Loops that are used outside compiled functions, but for their Python ``py_func``."""
    if decorated(tree, "njit", "inner_loop"):
        return
    if isinstance(tree, ast.Attribute) and tree.attr == "py_func":
        return
    if name := names.get(dotted(tree)):
        yield name
    for child in ast.iter_child_nodes(tree):
        yield from calls_from_python(child, names)


def known_as(tree: ast.Module, module: str, loops: set[str]) -> dict[str, str]:
    """What a module calls each loop, and the loop."""
    own = f"{module}."
    names = {loop.removeprefix(own): loop for loop in loops if loop.startswith(own)}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom):
            for one in node.names:
                at, known = f"{node.module}.{one.name}", one.asname or one.name
                names |= {
                    known + loop.removeprefix(at): loop
                    for loop in loops
                    if loop == at or loop.startswith(f"{at}.")
                }
    return names


def found(sources: dict[str, str]) -> tuple[set[str], list[str]]:
    """Loops of `inner_loop`, and where Python calls one of them."""
    trees = {module: ast.parse(text) for module, text in sources.items() if "inner_loop" in text}
    loops = {
        f"{module}.{node.name}"
        for module, tree in trees.items()
        for node in tree.body
        if isinstance(node, ast.FunctionDef) and decorated(node, "inner_loop")
    }
    files = {loop.split(".")[-2] for loop in loops}
    for module, text in sources.items():
        if module not in trees and any(file in text for file in files):
            trees[module] = ast.parse(text)
    calls = [
        f"{module}: {loop}"
        for module, tree in trees.items()
        if (names := known_as(tree, module, loops))
        for loop in calls_from_python(tree, names)
    ]
    return loops, calls


def test_python_calls_no_loop_that_only_loops_may_call() -> None:
    sources = {
        ".".join(path.relative_to(ROOT).with_suffix("").parts): path.read_text("utf-8")
        for folder in FOLDERS
        for path in sorted((ROOT / folder).rglob("*.py"))
    }
    loops, calls = found(sources)
    assert len(loops) > 30
    assert calls == []


def test_calls_by_any_name_are_found() -> None:
    loop = "@inner_loop\ndef loop(x): return x\n"
    sources = {
        "a.bb": loop + "@njit\ndef outer(x): return loop(x)\ndef wrong(x): return loop(x)\n",
        "a.c": "from a.bb import loop as other\nother(1)\nother.py_func(1)\n",
        "a.d": "from a import bb\nbb.loop(1)\n",
        "a.e": "def loop(x): return x\nloop(1)  # of bb\n",
    }
    loops, calls = found(sources)
    assert loops == {"a.bb.loop"}
    assert calls == [f"{module}: a.bb.loop" for module in ("a.bb", "a.c", "a.d")]
