"""Examples of the public names of ``fe_drivetrain``: the blocks of ``docs/python.md``.

The page of the API shows each name with the block that uses it first; tests/docs/test_face.py runs
the blocks, and pins that each name has one.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

PAGE = Path(__file__).parent / "python.md"
PACKAGE = "fe_drivetrain"


def blocks() -> list[str]:
    """The page's blocks of Python, in order."""
    return re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.DOTALL | re.M)


def taken(block: str) -> set[str]:
    """Names that a block imports from the package itself."""
    return {
        alias.name
        for node in ast.parse(block).body
        if isinstance(node, ast.ImportFrom) and node.module == PACKAGE
        for alias in node.names
    }


def used(block: str) -> set[str]:
    """Names that a block does something with, beside importing them."""
    return {
        node.id
        for node in ast.walk(ast.parse(block))
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load)
    }


def examples() -> list[tuple[list[str], str]]:
    """Each block with the names that it is the first to use, sorted; the others are left out."""
    found: list[tuple[list[str], str]] = []
    imported: set[str] = set()
    shown: set[str] = set()
    for block in blocks():
        imported |= taken(block)
        names = (imported & used(block)) - shown
        shown |= names
        if names:
            found.append((sorted(names), block))
    return found
