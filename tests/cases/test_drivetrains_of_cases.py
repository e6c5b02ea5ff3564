"""Cases of one machine, scene or gear table say so, by its hash: or here is why they do not."""

import ast
from functools import cache
from pathlib import Path

import pytest

import fe_drivetrain.cases
from fe_drivetrain.cases.drivetrain import two_masses
from fe_drivetrain.cases.dynamics import park_bending, planet_bearings
from fe_drivetrain.dynamics import library_machine
from fe_drivetrain.procedure.answers import quantities_of
from fe_drivetrain.report.results import Results
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.report.suite.case import Case, all_cases
from fe_drivetrain.report.suite.findings import OF_NONE
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run

PLACES = {fe_drivetrain.cases.__name__: Path(fe_drivetrain.cases.__path__[0])}

READERS = frozenset(
    {
        *("library_machine", "named_machine", "named_scene"),
        *("library_scene", "read_drivetrain", "read_scene", "parse_scene", "parse_drivetrain"),
        "Run.drivetrain",
    }
)
"""Functions that give a drivetrain, or a machine of one."""

STAMPS = frozenset({"about", "of"})
"""Methods of a page that state its drivetrain."""

UNSTAMPED = {
    name: reason
    for reason, names in {
        "of four drivetrains of a thesis at once, which it compares": (
            "verification/drivetrain_shafts",
        ),
        "of a bearing in a housing that the case makes, on a library's shaft for its size": (
            "bearing/assembly_on_rollers",
            "bearing/flexible_ladder",
            "bearing/flexible_rings",
            "bearing/flexible_rings_calculix",
            "life/choice_of_model",
            "life/uncertainty",
            "performance/bearing_equilibrium",
        ),
        "of files and of programs that read them: several scenes stand for any": (
            "export/calculix_matrix",
            "export/exudyn_drivetrain",
            "export/matrix_files",
            "export/nastran",
            "export/ross_rotor",
            "verification/kept_files",
        ),
        "of sample parts, each held in several ways in a scene that the case makes": (
            "foreign/bolted_cap",
            "foreign/further_part",
            "foreign/held_by_bolts",
            "foreign/preloaded_bolts",
            "foreign/round_trip",
            "foreign/shared_bedplate",
        ),
        "of a component or of pairs of gears, and of no whole drivetrain": (
            "fidelity/gearbox_housing",
            "gear/subsurface",
        ),
        "of random shafts, and of shafts with one fillet that the case makes": (
            "verification/band_coverage",
        ),
        "of the time that a method takes, with a drivetrain for its size": (
            "performance/drivetrain_transient",
            "performance/level_two",
            "performance/mesh_generation",
            "performance/solvers",
            "performance/work_precision",
        ),
        "of what a procedure prints, and of formulas": (
            "procedure/checks",
            "procedure/errata",
        ),
        "of the limit of a method: values are varied over decades, or an input is spoilt": (
            "stability/mesh_faults",
            "stability/near_mechanisms",
            "stability/near_singular_carriers",
            "stability/penalty",
            "stability/single_precision",
            "stability/solver_tolerance",
            "stability/springs",
            "stability/stiff_limits",
            "stability/tilt_estimators",
            "stability/time_step",
            "verification/mutated_machines",
            "verification/mutated_scenes",
        ),
        "of a theorem that holds for any scene, on two scenes and on plain bodies": (
            "verification/energy_balance",
            "verification/frame_invariance",
            "verification/reciprocity",
            "verification/rigid_motion",
            "verification/spherical_joint_moment",
        ),
    }.items()
    for name in names
}
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


@cache
def mentioned(module: str, name: str) -> tuple[frozenset[str], frozenset[str]]:
    """Stamps of a definition, and names that it uses, with the modules that they are from."""
    node = defined(module).get(name) if module in modules() else None
    if node is None:
        return frozenset(), frozenset()
    names, stamps, found = imported(module), set(), set()
    for part in ast.walk(node):
        stamps.add(stated_by(part))
        if isinstance(part, ast.Name):
            found.add(names.get(part.id, f"{module}.{part.id}"))
        elif isinstance(part, ast.Attribute) and isinstance(part.value, ast.Name):
            if (part.value.id, part.attr) == ("run", "drivetrain"):
                found.add("report.Run.drivetrain")
            found.add(f"{names.get(part.value.id, module)}.{part.attr}")
    return frozenset(stamps - {""}), frozenset(found)


def reached(module: str, name: str) -> tuple[set[str], set[str]]:
    """Readers and stamps that a function comes to, by way of other modules of cases."""
    readers: set[str] = set()
    stamps: set[str] = set()
    seen: set[Name] = set()
    left: list[Name] = [(module, name)]
    while left:
        place = left.pop()
        if place in seen:
            continue
        seen.add(place)
        stated, names = mentioned(*place)
        stamps |= stated
        for full in names:
            of, _, own = full.rpartition(".")
            if (own in READERS and of not in modules()) or full == "report.Run.drivetrain":
                readers.add(own)
            left.append((of, own))
    return readers, stamps


def stated_by(node: ast.AST) -> str:
    """The stamp that a call is, as `page.about(machine)`; empty of others, and of None."""
    match node:
        case ast.Call(func=ast.Attribute(ast.Name("page"), stamp), args=[first, *_]):
            none = isinstance(first, ast.Constant) and first.value is None
            return stamp if stamp in STAMPS and not none else ""
        case ast.Call(func=ast.Attribute(_, "state"), args=[ast.Name("page")]):
            return "about"  # of the drivetrain that the user has chosen
    return ""


def test_none_is_no_stamp() -> None:
    calls = {"page.about(machine)": "about", "page.of(table)": "of", "page.of(None)": ""}
    calls |= {"one.of(table)": "", "page.note(text)": "", "chosen.state(page)": "about"}
    for text, stamp in calls.items():
        assert stated_by(ast.parse(text, mode="eval").body) == stamp


def module_of(case: Case) -> str:
    return str(case.run.args[0])  # type: ignore[attr-defined]


@cache
def taking() -> dict[str, Case]:
    """Cases that take a drivetrain's file; not at import, since all modules are parsed for it."""
    return {name: case for name, case in all_cases().items() if reached(module_of(case), "run")[0]}


def test_cases_that_take_a_drivetrain_are_found() -> None:
    assert {
        "dynamics/park_time",
        "drivetrain/two_masses",
        "fidelity/bearing_joints",
    } <= taking().keys()
    assert "verification/units" not in taking()
    asked = {name for name, case in all_cases().items() if "drivetrain" in case.settings}
    asked |= {n for n, case in all_cases().items() if case.changes == "scene"}
    assert asked <= taking().keys()


def test_a_case_of_a_drivetrain_states_it_or_says_here_why_not() -> None:
    stamped = {name for name, case in taking().items() if reached(module_of(case), "run")[1]}
    assert taking().keys() - stamped == UNSTAMPED.keys(), "page.about(...), or a reason here"


def test_reasons_are_words() -> None:
    assert all(len(reason) > 20 for reason in UNSTAMPED.values())


def ran(run: object, tmp_path: Path, **settings: object) -> Page:
    page = Page()
    run(Run(settings, True, tmp_path), page)  # type: ignore[operator]
    return page


def test_what_a_source_restores_is_not_of_the_table(tmp_path: Path) -> None:
    page = ran(two_masses.run, tmp_path)
    (record,) = page.drivetrains
    own = drivetrain_hash(two_masses.TABLE)
    assert record.hash == own
    of = {verdict.quantity: verdict.of for verdict in page.checks}
    assert set(of.values()) == {own, OF_NONE}
    assert {name for name, of_ in of.items() if of_ == OF_NONE} == {
        name for name in of if "that it needs" in name or "Table 6.2 needs" in name
    }
    results = Results.model_construct(
        answers=[], verdicts=page.checks, drivetrains=page.drivetrains
    )
    counted = [one.quantity for one in quantities_of(results, own)]
    assert counted == [name for name, of_ in of.items() if of_ == own]


def test_what_a_source_prints_is_not_of_the_machine(tmp_path: Path) -> None:
    page = ran(park_bending.run, tmp_path)
    own = drivetrain_hash(library_machine("park_2021"))
    assert [record.hash for record in page.drivetrains] == [own]
    for verdict in page.checks:
        printed = verdict.quantity.startswith(("as printed", "every reading"))
        assert verdict.of == (OF_NONE if printed else own), verdict.quantity


def test_a_machine_that_a_case_changes_is_stated_as_it_was_solved(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    class StopError(Exception):
        pass

    def stop() -> None:
        raise StopError

    monkeypatch.setattr(planet_bearings, "own_carrier", stop)
    page = Page()
    with pytest.raises(StopError):
        planet_bearings.run(Run({}, True, tmp_path), page)
    (record,) = page.drivetrains
    library = library_machine("nrel_750kw")
    assert record.hash == drivetrain_hash(planet_bearings.linearised(library))
    assert record.hash != drivetrain_hash(library)


def test_of_ends_where_its_block_ends() -> None:
    page, machine = Page(), library_machine("park_2021")
    page.about(two_masses.TABLE)
    with page.of(machine, "other"):
        page.found("inside", 1.0)
    page.found("outside", 1.0)
    with page.of(None):
        page.found("none", 1.0)
    assert [figure.of for figure in page.figures] == [
        drivetrain_hash(machine),
        drivetrain_hash(two_masses.TABLE),
        OF_NONE,
    ]
    assert [record.name for record in page.drivetrains] == ["", "other"]
