"""Cases of one machine, scene or gear table say so, by its hash: or here is why they do not."""

import ast
from functools import cache
from pathlib import Path

import pytest

import fe_drivetrain.cases
from fe_drivetrain.cases.drivetrain import two_masses
from fe_drivetrain.cases.dynamics import normal_operation, park_bending, planet_bearings
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import parse_drivetrain
from fe_drivetrain.dynamics import library_machine
from fe_drivetrain.procedure.answers import quantities_of
from fe_drivetrain.report.results import Results
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.report.suite.case import Case, all_cases
from fe_drivetrain.report.suite.chosen import chosen_drivetrain
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
        "of a component, and of no whole drivetrain": ("fidelity/gearbox_housing",),
        "of random shafts, and of shafts with one fillet that the case makes": (
            "verification/band_coverage",
        ),
        "of the time that a method takes, with a drivetrain for its size": (
            "performance/deflation",
            "performance/drivetrain_in_time",
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
    own = drivetrain_hash(published.drivetrain("nrel_750kw"))
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
    page.about(published.drivetrain("nrel_750kw"))
    with page.of(machine, "other"):
        page.found("inside", 1.0)
    page.found("outside", 1.0)
    with page.of(None):
        page.found("none", 1.0)
    assert [figure.of for figure in page.figures] == [
        drivetrain_hash(machine),
        drivetrain_hash(published.drivetrain("nrel_750kw")),
        OF_NONE,
    ]
    assert [record.name for record in page.drivetrains] == ["", "other"]


GROUPS = ("drivetrain/", "dynamics/", "gear/", "procedure/")
"""Groups of cases that show methods on a drivetrain."""

OF_NO_OTHER = {
    name: reason
    for reason, names in {
        "of integrators, on a few masses whose motion has a closed form": ("dynamics/integrators",),
        "of one equation whose stability chart is exact": ("dynamics/mathieu",),
        "of a drill pipe whose frequencies a manual prints": (
            "drivetrain/vm57_torsion_of_a_drill_pipe",
        ),
        "of one stage with printed frequencies at a speed: `modes` has those of a drivetrain": (
            "dynamics/cooley_parker",
        ),
        "of one stage with printed frequencies at rest: `modes` has those of a drivetrain": (
            "dynamics/lin_parker",
        ),
        "of a rotor whose whirl is published: dynamics/whirl has that of a drivetrain": (
            "dynamics/nelson_mcvaugh",
            "dynamics/zorzi_nelson",
        ),
        "of a theorem on a stage by itself: the next stage of a drivetrain breaks its symmetry": (
            "dynamics/helical_planets",
        ),
        "of a shaft's bending as Park et al. print it, with terms that no other model has": (
            "dynamics/park_bending",
        ),
        "of a claim of Park et al., that stiffness goes by angle, on their own drivetrain": (
            "dynamics/park_by_angle",
        ),
        "of words of Park et al. on backlash, in their figures: `transient --backlash` takes any": (
            "dynamics/park_backlash",
        ),
        "of what a thesis prints of its drivetrain: values and sentences are held to its data": (
            "drivetrain/drivetrains_a_b_c",
            "drivetrain/generator_data",
        ),
        "of the pair of gears of a standard's example, whose printed stiffness it recomputes; "
        "gear/nrel_750kw does so with a user's": ("gear/iso_example",),
        "of the pair of gears of a standard's example, whose printed rating it recomputes; "
        "gear/nrel_5mw_rating does so with a user's": ("gear/iso_tr_example",),
        "of twenty identities, each on the smallest system that shows it": ("procedure/checks",),
        "of misprints in a report, on numbers that show each": ("procedure/errata",),
        "of blades' bearings and yaw drives, which are no part of a drivetrain's file": (
            "procedure/measured_tables",
            "procedure/pitch_and_yaw",
            "procedure/pitch_bearing",
        ),
    }.items()
    for name in names
}
"""Why a case of these groups takes no drivetrain of a user."""


def test_cases_of_drivetrains_take_another_or_say_here_why_not() -> None:
    cases = {name: case for name, case in all_cases().items() if name.startswith(GROUPS)}
    taking_another = {name for name, case in cases.items() if "drivetrain" in case.settings}
    assert cases.keys() - taking_another == OF_NO_OTHER.keys()
    for name in taking_another:
        assert "otherwise" in cases[name].settings["drivetrain"], name  # type: ignore[call-overload]


OWN = """
title: Turbine of a user
rotor: {inertia: 5.0e5}
shaft: {name: slow, torsion: 3.0e7}
gearbox:
  stages:
    - {kind: planetary, teeth: {ring: 99, planet: 39, sun: 21}, planets: 3, stiffness_of: axis,
       carrier: {inertia: 60}, planet: {inertia: 3}, sun: {inertia: 1}, ring_planet: 5.0e7,
       sun_planet: 5.0e7}
    - {kind: parallel, teeth: {gear: 88, pinion: 22}, stiffness_of: axis, gear: {inertia: 20},
       pinion: {inertia: 0.3}, stiffness: 5.0e7}
  shafts:
    - {name: middle, torsion: 2.0e7}
    - {name: quick, torsion: 2.0e6}
generator: {inertia: 30}
operation: {rated_power: 7.5e5, rotor_speed: [1.0, 2.3]}
"""

PRINTED_NAMES = (
    "750 kW",
    "5 MW",
    "2 MW",
    "thesis",
    "Al-Hamadani",
    "drivetrain A",
    "drivetrain D",
    "A to D",
)
"""Words of the cases' own drivetrains, which have no place in the answer on another one."""


@pytest.mark.parametrize(
    "name",
    [
        "drivetrain/two_masses",
        "drivetrain/five_masses",
        "drivetrain/eleven_masses",
        "drivetrain/from_table",
        "dynamics/campbell_table",
        "dynamics/hss_stiffness",
        "dynamics/normal_operation",
        "dynamics/round_robin",
        "dynamics/torque_histories",
        "dynamics/two_mass_transients",
        "procedure/campaign",
        "procedure/identification",
    ],
)
def test_a_case_answers_for_a_drivetrain_of_the_users(name: str, tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(OWN, "utf-8")
    case = all_cases()[name]
    results = case.results(Run({"drivetrain": str(file)}, True, tmp_path))
    own = drivetrain_hash(parse_drivetrain(OWN))
    assert [record.hash for record in results.drivetrains] == [own]
    assert {verdict.of for verdict in results.verdicts} <= {own}
    assert results.verdicts
    assert results.passed
    answer = results.answer.model_dump_json()
    assert not [word for word in PRINTED_NAMES if word in answer + results.title]
    assert any("printed numbers" in note for note in results.notes)


@pytest.mark.parametrize(
    ("settings", "message"),
    [
        ({"drivetrain": 3}, "drivetrain = 3 must be a file or a name of the library"),
        ({"drivetrain": "nrel_6mw"}, "no scene 'nrel_6mw' in the library"),
        ({"drivetrain": "mine.yaml"}, "mine.yaml' does not state operation: add it, as in"),
        ({"drivetrain": "park_2021"}, "shaft of gear 2' of .* is rigid"),
    ],
)
def test_a_drivetrain_that_a_case_cannot_take_is_refused(
    settings: dict[str, object],
    message: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.yaml").write_text(OWN.partition("operation:")[0], "utf-8")
    with pytest.raises(InputError, match=message):
        ran(normal_operation.run, tmp_path, **settings)


def test_the_default_by_name_is_the_default() -> None:
    own = chosen_drivetrain("nrel_750kw", "nrel_750kw")
    assert not own.own
    assert chosen_drivetrain("nrel_5mw", "nrel_750kw").own
    assert chosen_drivetrain(None, "nrel_750kw") == own


def test_a_case_about_gears_refuses_a_direct_drive() -> None:
    name = "iea_15mw_main_shaft"
    assert chosen_drivetrain(name, "").own
    with pytest.raises(InputError, match=f"drivetrain '{name}' has no gears: give gearbox.stages"):
        chosen_drivetrain(name, "", gears=True)


@pytest.mark.parametrize(
    "case",
    [
        "dynamics/campbell_table",
        "dynamics/contact_stresses",
        "dynamics/park_time",
        "gear/nrel_5mw",
        "procedure/run_up",
    ],
)
def test_cases_about_gears_ask_for_them(case: str, tmp_path: Path) -> None:
    """Each of these ended in a traceback."""
    with pytest.raises(InputError, match="has no gears"):
        ran(all_cases()[case].run, tmp_path, drivetrain="iea_15mw_main_shaft")
