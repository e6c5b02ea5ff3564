"""The rooms of the package: imports go down, faces are true, the picture shows what is there."""

import ast
import importlib
import re
import sys
import tomllib
from pathlib import Path
from typing import Any

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT / "docs"))

import house  # noqa: E402

from fe_drivetrain.export.files import FORMATS, READ_ALONE  # noqa: E402
from fe_drivetrain.export.turning_files import TURNING_FORMATS  # noqa: E402

LIBRARY = sorted(path.parent.name for path in (ROOT / "fe_drivetrain").glob("*/__init__.py"))
FACES = sorted(house.faces().keys() - {""})

#: From the ground floor up: a room imports from lower floors only.
FLOORS = (
    {"common"},
    {"geometry", "comparison", "plots"},
    {"bearing", "turbine_loads"},
    {"gear"},
    {"drivetrain_file"},
    {"elasticity"},
    {"foreign"},
    {"shafts"},
    {"bearing_life", "dynamics", "report"},
    {"export", "procedure"},
    {"studies"},
    {"pages"},
    {"command_line"},
    {"cases"},
)


def test_every_room_has_a_floor_and_imports_from_lower_ones_only() -> None:
    on = {room: number for number, floor in enumerate(FLOORS) for room in floor}
    graph = house.rooms()
    assert on.keys() == graph.keys() == {*LIBRARY, "geometry", "cases"}
    upward = [(room, b) for room, below in graph.items() for b in below if on[b] >= on[room]]
    assert not upward


def test_no_circle_among_the_folders_of_rooms() -> None:
    graph = house.rooms(house.folder_of)
    assert {"shafts.beam", "elasticity.mesh", "report.suite"} <= graph.keys()
    assert graph.keys() <= {*FACES, "cases"}
    assert max(house.floors(graph).values()) > 1


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


@pytest.mark.parametrize("room", FACES)
def test_a_face_says_what_its_room_is_for_and_shows_only_what_is_there(room: str) -> None:
    face = importlib.import_module(f"fe_drivetrain.{room}")
    assert face.__doc__
    assert "In: " in face.__doc__
    assert "Out: " in face.__doc__
    assert face.__all__
    for name in face.__all__:
        assert getattr(face, name) is not None, name


#: Modules for users, which one case tries or none: the page that tells them to take its names.
FOR_USERS = {
    # what is condensed of a drivetrain's file, at every level of its ladder
    "dynamics.bodies.housing_bounds": "dynamics.md",
    "bearing.subsurface": "procedure.md",
    # answers of a bearing to millions of loads, from one grid of solves
    "bearing.tables": "bearing.md",
    "export.formats.windio": "how-to/shafts-of-a-gearbox.md",
    "gear.coupled_slices": "gear_rating.md",
    "studies.openmdao_component": "python.md",
    "turbine_loads.hub_loads.events": "turbine.md",
    "turbine_loads.hub_loads.wind_boxes": "loads.md",
    # loads at the interfaces of any scene, from a level of the ladder
    "procedure.levels": "procedure.md",
    # reads the scripts of a user's own campaign
    "procedure.measurement_cases": "procedure.md",
    # the accelerations at interfaces that a load table asks for, of any three-point drivetrain
    "procedure.moving": "procedure.md",
    # ranks and locks the degrees of freedom of any machine, under a user's load case
    "procedure.reduction": "procedure.md",
    # writes the page of a result from a script
    "pages.written": "python.md",
}

#: Modules that are started or imported by a name in a string, and by what.
BY_NAME = {
    "command_line.entry": "pyproject.toml",
    "foreign.child": "fe_drivetrain/foreign/reading.py",
    "elasticity.solve.petsc_ranks": "fe_drivetrain/elasticity/solve/petsc.py",
}


def of_library(module: str) -> bool:
    is_face = house.modules()[module].name == "__init__.py"
    return not is_face and house.room_of(module) != "cases"


def test_the_library_has_no_module_for_one_case_alone() -> None:
    rows = (*FORMATS.values(), *TURNING_FORMATS.values())
    modules = [*(row.module for row in rows), *READ_ALONE.values()]
    formats = {f"export.formats.{module}" for module in modules}
    alone = {
        name
        for name in filter(of_library, house.modules())
        if not any(map(of_library, house.users()[name])) and len(house.cases_with(name)) < 2
    }
    assert alone - formats == FOR_USERS.keys() | BY_NAME.keys()


@pytest.mark.parametrize(("module", "page"), FOR_USERS.items())
def test_what_is_for_users_is_on_a_page_for_users(module: str, page: str) -> None:
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    tree = ast.parse(house.modules()[module].read_text(encoding="utf-8"))
    made = {node.name for node in tree.body if isinstance(node, ast.FunctionDef | ast.ClassDef)}
    assert any(re.search(rf"\b{name}\b", text) for name in made)


@pytest.mark.parametrize(("module", "file"), BY_NAME.items())
def test_what_is_started_by_its_name_is_named_there(module: str, file: str) -> None:
    text = (ROOT / file).read_text(encoding="utf-8")
    assert f"fe_drivetrain.{module}" in text or f'"{module.rpartition(".")[2]}.py"' in text


#: Cases that are about the command line itself: they kill it, and give it faults at set moments.
WITH_COMMANDS = {
    "cases.stability.fault_moments",
    "cases.verification.command_kills",
}


def of_cases() -> dict[str, set[str]]:
    """What each module below the cases takes names from."""
    names = (name for name in house.modules() if name.startswith("cases."))
    return {name: house.used(house.modules()[name], name) for name in names}


def test_no_case_imports_a_command() -> None:
    found = {
        name
        for name, targets in of_cases().items()
        if any(house.room_of(target) == "command_line" for target in targets)
    }
    assert found == WITH_COMMANDS


def test_no_case_imports_the_script_of_another() -> None:
    assert len(house.scripts()) > 200
    assert not [
        (name, target)
        for name, targets in of_cases().items()
        for target in targets & house.scripts()
    ]


def test_references_serve_two_cases_and_other_bodies_stand_beside_theirs() -> None:
    shared = "cases.references."
    for name in house.modules():
        if not name.startswith("cases.") or name in house.scripts():
            continue
        if name.startswith(shared):
            assert len(house.cases_with(name)) > 1, f"{name} belongs beside its case"
        else:
            group = ".".join(name.split(".")[:2])
            elsewhere = [u for u in house.users()[name] if not u.startswith(f"{group}.")]
            assert not elsewhere, f"{name} belongs into the references"


#: Lines of a function of a case, with its description.
LONGEST = 60


def long_functions(source: str) -> list[str]:
    """Functions, nested ones too, with more lines than a case may have in one."""
    return [
        node.name
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.FunctionDef) and (node.end_lineno or 0) - node.lineno + 1 > LONGEST
    ]


def test_long_functions_are_found() -> None:
    lines = "    x = 1\n" * (LONGEST - 1)
    assert long_functions(f"def short():\n{lines}") == []
    assert long_functions(f"class A:\n  def long(self):\n{lines}    x = 2\n") == ["long"]


def test_no_function_of_a_case_is_long() -> None:
    found = {
        name: long
        for name, path in house.modules().items()
        if name.startswith("cases.") and (long := long_functions(path.read_text(encoding="utf-8")))
    }
    assert found == {}


def test_names_are_found_through_faces() -> None:
    assert house.home("report.rolling_elements") == "report.pictures.rollers"
    assert house.home("cases.references.plane_rings") == "cases.references.plane_rings"
    assert "export.files" in house.users().keys() & house.used(
        house.modules()["cases.export.matrix_files"], "cases.export.matrix_files"
    )


def installed() -> dict[str, Any]:
    """What of the repository a wheel takes."""
    tool = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]
    return tool["setuptools"]


def test_every_package_is_installed() -> None:
    packages = set(installed()["packages"])
    there = {
        f"fe_drivetrain.{name}".rstrip(".")
        for name, path in house.modules().items()
        if path.name == "__init__.py"
    }
    assert there <= packages


def test_what_lies_beside_modules_at_the_top_level_is_installed() -> None:
    data = installed()["package-data"]
    folders = [ROOT / name for name in house.TOP_LEVEL]
    there = [p for folder in folders for end in ("pyi", "yaml") for p in folder.rglob(f"*.{end}")]
    assert there
    for path in there:
        package = ".".join((house.PACKAGE, *path.parent.relative_to(ROOT).parts))
        assert any(path.match(pattern) for pattern in data.get(package, ())), path


def test_the_picture_of_the_floors_is_up_to_date() -> None:
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    assert house.picture() in text
    assert house.with_picture(text) == text


def test_tests_are_in_folders_of_rooms() -> None:
    tests = ROOT / "tests"
    assert not list(tests.glob("test_*.py"))
    folders = {path.parent.relative_to(tests).as_posix() for path in tests.rglob("test_*.py")}
    assert folders - {*house.rooms(), "docs", "house"} == set()
