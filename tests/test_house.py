"""The rooms of the package: imports go down, faces are true, the picture shows what is there."""

import importlib
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "docs"))

import house  # noqa: E402

LIBRARY = sorted(path.parent.name for path in (ROOT / "fe_drivetrain").glob("*/__init__.py"))

#: From the ground floor up: a room imports from lower floors only.
FLOORS = (
    {"common"},
    {"geometry", "compare", "histories", "plots"},
    {"bearing", "gear", "mesh", "scene", "torsion", "hub_loads"},
    {"life", "operator", "revolution"},
    {"interfaces"},
    {"foreign", "solve"},
    {"beam", "response"},
    {"dynamics", "fidelity", "peers", "report", "rings"},
    {"coupled", "export", "procedure", "suite", "uncertainty"},
    {"studies"},
    {"pages", "validation"},
    {"commands"},
    {"cases"},
)


def test_every_room_has_a_floor_and_imports_from_lower_ones_only() -> None:
    on = {room: number for number, floor in enumerate(FLOORS) for room in floor}
    graph = house.rooms()
    assert on.keys() == graph.keys() == {*LIBRARY, "geometry", "cases"}
    upward = [(room, b) for room, below in graph.items() for b in below if on[b] >= on[room]]
    assert not upward


def test_no_circle_among_modules() -> None:
    modules = house.modules()
    graph = {}
    for name, path in modules.items():
        targets = set()
        for target in house.imports(path, name):
            # "room.name" is a module, or a name out of a module or face
            found = target if target in modules else target.rpartition(".")[0]
            if found in modules and found != name and modules[found].name != "__init__.py":
                targets.add(found)
        graph[name] = targets
    assert max(house.floors(graph).values()) > 1


def test_a_circle_is_noticed() -> None:
    with pytest.raises(ValueError, match="circle among a, b"):
        house.floors({"a": {"b"}, "b": {"a"}, "c": set()})


def test_nothing_stands_at_the_root() -> None:
    files = {path.name for path in (ROOT / "fe_drivetrain").iterdir() if path.is_file()}
    assert files == {"__init__.py", "__init__.pyi", "py.typed"}


@pytest.mark.parametrize("room", [*LIBRARY, "geometry"])
def test_a_face_says_what_its_room_is_for_and_shows_only_what_is_there(room: str) -> None:
    face = importlib.import_module(f"fe_drivetrain.{room}")
    assert face.__doc__
    assert "In: " in face.__doc__
    assert "Out: " in face.__doc__
    assert face.__all__
    for name in face.__all__:
        assert getattr(face, name) is not None, name


def test_every_package_is_installed() -> None:
    packages = set(
        tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["setuptools"]["packages"]
    )
    there = {
        f"fe_drivetrain.{name}".rstrip(".")
        for name, path in house.modules().items()
        if path.name == "__init__.py"
    }
    assert there <= packages


def test_the_picture_of_the_floors_is_up_to_date() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    assert house.picture() in text
    assert house.with_picture(text) == text
