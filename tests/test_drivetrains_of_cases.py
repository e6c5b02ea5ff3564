"""Cases of one machine, scene or gear table say so, by its hash: or here is why they do not."""

import ast
from collections.abc import Iterator
from functools import cache
from pathlib import Path

import pytest

import fe_drivetrain.cases
import fe_drivetrain.validation
from fe_drivetrain.cases.drivetrain import two_masses
from fe_drivetrain.cases.dynamics import park_bending, planet_bearings
from fe_drivetrain.dynamics import library_machine
from fe_drivetrain.procedure.answers import quantities_of
from fe_drivetrain.report.results import Results
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.suite.case import Case, all_cases
from fe_drivetrain.suite.page import OF_NONE, Page
from fe_drivetrain.suite.run import Run

PLACES = {
    module.__name__: Path(module.__path__[0])
    for module in (fe_drivetrain.cases, fe_drivetrain.validation)
}

READERS = frozenset(
    {
        *("library_machine", "named_machine", "read_machine", "parse_machine"),
        *("library_scene", "named_scene", "read_scene", "parse_scene"),
        *("read_drivetrain", "parse_drivetrain"),
    }
)
"""Functions that give a machine, a scene or a gear table."""

STAMPS = frozenset({"about", "of"})
"""Methods of a page that state its drivetrain."""

UNSTAMPED: dict[str, str] = {}
"""Why a case that takes such a file states none."""

Name = tuple[str, str]  # module, and what it defines


@cache
def modules() -> dict[str, ast.Module]:
    return {
        ".".join((package, *path.relative_to(place).with_suffix("").parts)): ast.parse(
            path.read_text("utf-8")
        )
        for package, place in PLACES.items()
        for path in sorted(place.glob("**/*.py"))
    }


@cache
def imported(module: str) -> dict[str, str]:
    """What names of a module stand for: "module.name" of what it imports."""
    found = {}
    for node in ast.walk(modules()[module]):
        if isinstance(node, ast.ImportFrom) and node.module:
            for name in node.names:
                found[name.asname or name.name] = f"{node.module}.{name.name}"
    return found


@cache
def defined(module: str) -> dict[str, ast.stmt]:
    """Functions, classes and values of a module."""
    found: dict[str, ast.stmt] = {}
    for node in modules()[module].body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef):
            found[node.name] = node
        elif isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            found |= {n.id: node for t in targets for n in ast.walk(t) if isinstance(n, ast.Name)}
    return found


def mentioned(module: str, node: ast.AST) -> Iterator[str]:
    """Names that a node uses, with their modules where these are imported."""
    names = imported(module)
    for part in ast.walk(node):
        if isinstance(part, ast.Name):
            yield names.get(part.id, f"{module}.{part.id}")
        elif isinstance(part, ast.Attribute) and isinstance(part.value, ast.Name):
            yield f"{names.get(part.value.id, module)}.{part.attr}"


def reached(module: str, name: str) -> tuple[set[str], set[str]]:
    """Readers and stamps that a function comes to, by way of other cases and `validation`."""
    readers, stamps, seen, left = set(), set(), set(), [(module, name)]
    while left:
        place = left.pop()
        node = defined(place[0]).get(place[1]) if place[0] in modules() else None
        if node is None or place in seen:
            continue
        seen.add(place)
        for part in ast.walk(node):
            if isinstance(part, ast.Attribute) and part.attr in STAMPS:
                if isinstance(part.value, ast.Name) and part.value.id == "page":
                    stamps.add(part.attr)
        for full in mentioned(place[0], node):
            of, _, own = full.rpartition(".")
            if own in READERS and of not in modules():
                readers.add(own)
            left.append((of, own))
    return readers, stamps


def module_of(case: Case) -> str:
    return str(case.run.args[0])  # type: ignore[attr-defined]


TAKING = {name: case for name, case in all_cases().items() if reached(module_of(case), "run")[0]}


def test_cases_that_take_a_drivetrain_are_found() -> None:
    assert {"dynamics/park_time", "drivetrain/two_masses", "fidelity/bearing_joints"} <= set(TAKING)
    assert "verification/units" not in TAKING
    asked = {name for name, case in all_cases().items() if "machine" in case.settings}
    asked |= {n for n, case in all_cases().items() if case.changes == "scene"}
    assert asked <= set(TAKING)


@pytest.mark.parametrize("name", sorted(TAKING))
def test_a_case_of_a_drivetrain_states_it_or_says_here_why_not(name: str) -> None:
    _, stamps = reached(module_of(TAKING[name]), "run")
    assert bool(stamps) != (name in UNSTAMPED), f"{name}: page.about(...), or a reason in UNSTAMPED"


def test_reasons_are_of_cases_that_there_are() -> None:
    assert set(UNSTAMPED) <= set(TAKING)
    assert all(len(reason) > 20 for reason in UNSTAMPED.values())
