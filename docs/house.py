"""The rooms of the package and what each imports, read from the code; the picture of CONTRIBUTING.

``python docs/house.py`` draws the picture again. tests/house/test_house.py pins what it shows:
every import goes to a lower floor, and none in a circle; and by `users` that the library has no
module for one case alone.
"""

from __future__ import annotations

import ast
import re
from collections.abc import Callable, Iterator, Mapping
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parents[1]
PACKAGE = "fe_drivetrain"
TOP_LEVEL = ("geometry", "cases")  # installed as subpackages
BEGIN, END = "<!-- floors: python docs/house.py -->", "<!-- end of floors -->"


@cache
def modules() -> dict[str, Path]:
    """Every module of the installed package, by its dotted name below the package."""
    found = {}
    for folder in (ROOT / PACKAGE, *(ROOT / name for name in TOP_LEVEL)):
        for path in sorted(folder.rglob("*.py")):
            start = ROOT / PACKAGE if folder.name == PACKAGE else ROOT
            parts = path.relative_to(start).with_suffix("").parts
            found[".".join(parts[:-1] if parts[-1] == "__init__" else parts)] = path
    return found


@cache
def imports(path: Path, name: str) -> tuple[str, ...]:
    """Modules and rooms of the package that a file imports, wherever in the file it does."""
    return tuple(_imports(path, name))


def _imports(path: Path, name: str) -> Iterator[str]:
    package = name.split(".") if path.name == "__init__.py" else name.split(".")[:-1]
    for node in _statements(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.ImportFrom):
            if node.level:
                base = package[: len(package) - node.level + 1]
                whole = ".".join([*base, *([node.module] if node.module else [])])
            elif (node.module or "").partition(".")[0] == PACKAGE:
                whole = (node.module or "").partition(".")[2]
            else:
                continue
            for alias in node.names:
                yield f"{whole}.{alias.name}".strip(".")
        elif isinstance(node, ast.Import):
            for alias in node.names:
                if alias.name.partition(".")[0] == PACKAGE:
                    yield alias.name.partition(".")[2]


def _statements(block: ast.AST) -> Iterator[ast.AST]:
    """Every statement in a block, without what it computes, which is most of a program."""
    for part in ("body", "orelse", "handlers", "finalbody", "cases"):
        for node in getattr(block, part, ()):
            yield node
            yield from _statements(node)


@cache
def faces() -> dict[str, dict[str, str]]:
    """Public names of every package that has a face, each with the module or face it is from."""
    return {
        name: {
            alias.asname or alias.name: f"{name}.{node.module or alias.name}".strip(".")
            for node in ast.parse(stub.read_text(encoding="utf-8")).body
            if isinstance(node, ast.ImportFrom) and node.level == 1
            for alias in node.names
        }
        for name, path in modules().items()
        if (stub := path.with_suffix(".pyi")).is_file()
    }


def home(target: str) -> str:
    """The module that has what is imported as "room.name"; itself, where it is a face or none."""
    room, _, name = target.rpartition(".")
    if target in modules():
        return target
    if name in faces().get(room, {}):
        origin = faces()[room][name]
        return home(f"{origin}.{name}") if origin in faces() else origin
    return room if room in modules() else target


def used(path: Path, name: str) -> set[str]:
    """Modules that a file takes names from: straight, through a face, or as ``face.name``."""
    found = {home(target) for target in imports(path, name)}
    taken = found & faces().keys()
    if taken:
        attributes = {
            node.attr
            for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
            if isinstance(node, ast.Attribute)
        }
        found |= {home(f"{face}.{a}") for face in taken for a in attributes & faces()[face].keys()}
    return found - {name}


@cache
def users() -> dict[str, set[str]]:
    """By module those that take names from it."""
    found: dict[str, set[str]] = {name: set() for name in modules()}
    for name, path in modules().items():
        for target in used(path, name) & found.keys():
            found[target].add(name)
    return found


@cache
def scripts() -> set[str]:
    """Modules that declare a case."""
    return {
        name
        for name, path in modules().items()
        if name.startswith("cases.")
        and re.search(r"^@cases?\(", path.read_text(encoding="utf-8"), re.MULTILINE)
    }


def cases_with(name: str) -> set[str]:
    """Scripts that take names from a module of the cases or the library, or through others."""
    found: set[str] = set()
    seen, ahead = {name}, [name]
    while ahead:
        new = users()[ahead.pop()] - seen
        seen |= new
        found |= new & scripts()
        ahead += new - scripts()
    return found


def room_of(name: str) -> str:
    """The room of a module: the first part of its name."""
    return name.partition(".")[0]


def folder_of(name: str) -> str:
    """The folder of a room that a module is in: of ``shafts.beam.sections`` ``shafts.beam``."""
    parts = name.split(".")
    longer = (".".join(parts[:n]) for n in range(len(parts), 1, -1))
    return next((part for part in longer if part in faces()), parts[0])


def rooms(part_of: Callable[[str], str] = room_of) -> dict[str, set[str]]:
    """Every room, and the rooms that it imports.

    Parameters
    ----------
    part_of : callable
        The part of the package that a module is of: `room_of`, or `folder_of` for what a room has
        inside.
    """
    found: dict[str, set[str]] = {}
    for name, path in modules().items():
        if not name:
            continue
        taken = {part_of(target) for target in imports(path, name) if target}
        found.setdefault(part_of(name), set()).update(taken)
    return {room: (taken & found.keys()) - {room} for room, taken in sorted(found.items())}


def floors(graph: Mapping[str, set[str]]) -> dict[str, int]:
    """The floor of each room: one above the highest that it imports; the ground floor is 1.

    Raises
    ------
    ValueError
        Rooms import each other in a circle.
    """
    found: dict[str, int] = {}
    while len(found) < len(graph):
        ready = [r for r, below in graph.items() if r not in found and below <= found.keys()]
        if not ready:
            raise ValueError(f"a circle among {', '.join(sorted(graph.keys() - found.keys()))}")
        found |= {room: 1 + max((found[b] for b in graph[room]), default=0) for room in ready}
    return found


def direct(graph: Mapping[str, set[str]]) -> dict[str, set[str]]:
    """The arrows that are left when those that a longer way replaces are taken out."""

    def reach(room: str) -> set[str]:
        return set().union(*({below} | reach(below) for below in graph[room]))

    return {
        room: {b for b in below if not any(b in reach(other) for other in below - {b})}
        for room, below in graph.items()
    }


def picture() -> str:
    """The floors as a Mermaid chart: what imports stands above what is imported."""
    graph = rooms()
    on = floors(graph)
    lines = ["```mermaid", "flowchart TB"]
    for floor in sorted(set(on.values()), reverse=True):
        lines.append(f'  subgraph floor{floor}["floor {floor}"]')
        lines += [f"    {room}" for room in sorted(on) if on[room] == floor]
        lines.append("  end")
    lines += [f"  {a} --> {b}" for a, below in direct(graph).items() for b in sorted(below)]
    return "\n".join([*lines, "```"])


def with_picture(text: str) -> str:
    """A text with the picture between its two marks brought up to date."""
    pattern = re.compile(f"{re.escape(BEGIN)}.*{re.escape(END)}", re.DOTALL)
    return pattern.sub(lambda _: f"{BEGIN}\n{picture()}\n{END}", text)


if __name__ == "__main__":
    file = ROOT / "CONTRIBUTING.md"
    file.write_text(with_picture(file.read_text(encoding="utf-8")), encoding="utf-8")
