"""Studies as functions: what a result holds, and how it goes into JSON, tables and charts."""

import dataclasses
import json
import math
from collections.abc import Callable
from concurrent.futures import Future
from pathlib import Path
from typing import Any, Literal

import numpy as np
import pytest
from answer_rules import broken_by, broken_rules
from coarse_scenes import coarse_scene
from small_drivetrain import GENERATOR, two_masses
from small_project import OWN, Content, small_project
from test_commands_life import write_history
from test_scene_study import HISTORIES

from fe_drivetrain import export, pages
from fe_drivetrain.common import InputError
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.drivetrain_file import change_scene, library_component, library_scene
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.elasticity.mesh import Mesh, cached_mesh
from fe_drivetrain.elasticity.mesh import write as write_mesh
from fe_drivetrain.export import Superelement
from fe_drivetrain.geometry import MeshSizes, Section, Shaft
from fe_drivetrain.pages.advise import show_advise
from fe_drivetrain.pages.check import show_check
from fe_drivetrain.pages.compare import show_compare
from fe_drivetrain.pages.gears import show_gears
from fe_drivetrain.pages.life import show_life
from fe_drivetrain.pages.loads import show_loads
from fe_drivetrain.pages.modes import show_modes
from fe_drivetrain.pages.study import show_study
from fe_drivetrain.pages.transient import show_transient
from fe_drivetrain.pages.uncertainty import show_uncertainty
from fe_drivetrain.pages.validate import show_validate
from fe_drivetrain.procedure import Project
from fe_drivetrain.report.pictures import Picture
from fe_drivetrain.report.suite import Case, Page, Run
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.shafts.response import Model
from fe_drivetrain.studies import (
    AdviseResult,
    CheckResult,
    CompareResult,
    ExportResult,
    GearOptions,
    GearsResult,
    LifeOptions,
    LifeResult,
    LoadOptions,
    LoadsResult,
    ModesResult,
    PartResult,
    Result,
    StudyResult,
    TransientResult,
    UncertaintyResult,
    ValidateResult,
    advise,
    check,
    compare,
    gears,
    life,
    loads,
    modes,
    part,
    prepare_export,
    study,
    transient,
    uncertainty,
    validate,
)
from fe_drivetrain.studies.design_comparison import Varied
from fe_drivetrain.turbine_loads.histories import Site
from fe_drivetrain.turbine_loads.hub_loads import LoadHistory, write_hub_loads

HOLLOW = Shaft(front=0.0, sections=(Section(length=0.6, outer_diameter=0.3, inner_diameter=0.1),))
STIFFNESS = np.diag([1e9, 2e9, 3e9, 1e7, 4e7, 5e7])


@pytest.fixture(scope="module")
def checked() -> CheckResult:
    return check(coarse_scene("bonded"))


@pytest.fixture(scope="module")
def compared() -> CompareResult:
    scene, key, values = coarse_scene("bonded"), "gearbox.weight", (1e5, 2e5)
    designs = {f"{value:g}": change_scene(scene, {key: value}) for value in values}
    return compare(designs, tolerance=0.5, varied=Varied(key, values))


@pytest.fixture(scope="module")
def advised() -> AdviseResult:
    load = {"hub.My": 1e6}
    return advise(coarse_scene("bonded"), "main_bearing.My", tolerance=0.5, load=load)


@pytest.fixture(scope="module")
def uncertain() -> UncertaintyResult:
    spreads = {"gearbox.stiffness.2": {"uniform": 0.2}, "shaft.front": {"uniform": 0.01}}
    scene = coarse_scene("bonded", uncertainty=spreads)
    return uncertainty(scene, ["main_bearing.My"], {"hub.My": 1e6}, level=1, samples=40)


@pytest.fixture(scope="module")
def validated(tmp_path_factory: pytest.TempPathFactory) -> ValidateResult:
    folder = tmp_path_factory.mktemp("project")
    return validate(Project.model_validate(small_project(folder)), folder)


@pytest.fixture(scope="module")
def shaped(tmp_path_factory: pytest.TempPathFactory) -> PartResult:
    """A hollow cylinder, meshed."""
    sizes = MeshSizes(shaft=0.15, elements_per_turn=8)
    mesh = cached_mesh(HOLLOW, [], {}, sizes, frozenset())
    path = tmp_path_factory.mktemp("part") / "hollow.vtu"
    write_mesh(mesh, path)
    return part(path)


@pytest.fixture(scope="module")
def condensed(tmp_path_factory: pytest.TempPathFactory) -> PartResult:
    """A housing on springs of its own, as a superelement."""
    path = tmp_path_factory.mktemp("superelement") / "mine.csv"
    place = np.zeros((1, 3))
    export.write_superelement(
        path, Superelement("mine", ("bore",), place, STIFFNESS, supported=True), "csv"
    )
    return part(path)


@pytest.fixture(scope="module")
def exported() -> ExportResult:
    return prepare_export(coarse_scene("bonded"), at=["hub", "gearbox"])


@pytest.fixture(scope="module")
def loaded(tmp_path_factory: pytest.TempPathFactory) -> LoadsResult:
    """Three cycles of My of a range of 2 kN m, and noise."""
    file = tmp_path_factory.mktemp("loads") / "wave.csv"
    time = np.arange(301) * 0.1
    samples = np.random.default_rng(3).standard_normal((301, 6))
    samples[:, 4] = 1e3 * np.sin(2.0 * np.pi * time / 10.0)
    write_hub_loads(LoadHistory("wave", time, samples), file)
    options = LoadOptions(slopes=(3.0, 5.0), rotor_speed_rpm=45.0 / np.pi, ultimate={"My": 1e6})
    return loads([file], options, scene=coarse_scene("bonded"))


@pytest.fixture(scope="module")
def vibrating() -> ModesResult:
    return modes(read_drivetrain("park_2021"), level="rigid", speeds=(0.6, 1.2))


@pytest.fixture(scope="module")
def meshed() -> GearsResult:
    options = GearOptions(azimuths=6, slices=3, level="rigid")
    return gears(read_drivetrain("nrel_5mw"), options=options)


@pytest.fixture(scope="module")
def lived(tmp_path_factory: pytest.TempPathFactory) -> LifeResult:
    folder = tmp_path_factory.mktemp("histories")
    for wind in (8.0, 14.0):
        write_history(folder / f"v{wind:g}.csv", wind)
    return life(library_scene("main_bearing_spherical"), folder / "*.csv", Site(8.5))


@pytest.fixture(scope="module")
def timed() -> TransientResult:
    return transient(two_masses(), "grid_loss", {"off": 0.1}, duration=0.6)


@pytest.fixture(scope="module")
def studied() -> StudyResult:
    return study(coarse_scene("bonded"), HISTORIES, slopes=(4.0,))


PAGES: dict[str, Callable[[Run, Page, Any], None]] = {
    "studied": show_study,
    "checked": show_check,
    "compared": show_compare,
    "advised": show_advise,
    "uncertain": show_uncertainty,
    "validated": show_validate,
    "lived": show_life,
    "loaded": show_loads,
    "timed": show_transient,
    "vibrating": show_modes,
    "meshed": show_gears,
}
"""What shows a result on a page."""

RESULTS = (
    "studied",
    *("checked", "compared", "advised", "uncertain", "validated", "lived", "loaded"),
    *("timed", "vibrating", "meshed", "shaped", "condensed", "exported"),
)


@pytest.fixture(params=RESULTS)
def result(request: pytest.FixtureRequest) -> Result:
    found: Result = request.getfixturevalue(request.param)
    return found


def test_the_json_of_a_result_is_strict_and_names_its_schema(result: Result) -> None:
    def refuse(constant: str) -> Any:
        raise AssertionError(constant)

    found = json.loads(result.to_json(), parse_constant=refuse)
    assert found["schema"] == f"fe-drivetrain/{result.STUDY}/{result.SCHEMA_VERSION}"
    assert [one["hash"] for one in found["drivetrains"]] == [d.hash for d in result.drivetrains]
    assert found["details"] == list(result.details)
    assert len(found["checks"]) == len(result.checks)
    assert found["tables"].keys() == result.all_tables().keys() >= result.tables.keys()
    # keys and units can be typed: no space that does not break
    assert "\u00a0" not in json.dumps(found["tables"], ensure_ascii=False)


def test_a_result_cannot_be_changed_and_prints_in_one_line(result: Result) -> None:
    with pytest.raises(dataclasses.FrozenInstanceError):
        result.answer = ()  # type: ignore[misc]
    assert "\n" not in repr(result)
    assert result.answer.verdict.removesuffix(".") in repr(result)
    assert len(repr(result)) < 300


def test_the_answer_of_a_study_keeps_the_rules(
    result: Result,
    request: pytest.FixtureRequest,
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
) -> None:
    # what is drawn takes seconds, and is tried elsewhere
    monkeypatch.setattr(pages.study, "model_pictures", lambda *_: [])
    drawn: Future[None] = Future()
    drawn.set_result(None)
    monkeypatch.setattr(pages.check, "picture_of_model", lambda *_: Picture(drawn))
    name = request.node.callspec.params["result"]
    if name not in PAGES:  # its command writes no page
        assert broken_by(result.answer, [result.chart().caption], result.checks) == []
        return

    def work(run: Run, page: Page) -> None:
        page.take(result)
        PAGES[name](run, page, result)

    case = Case("study/of", "A study", "the user's scene", work)
    results = case.results(Run({}, quick=False, folder=tmp_path))
    assert results.answer is not None
    assert results.answer.verdict == result.answer.verdict
    assert broken_rules(results) == []


def test_what_has_no_answer_cannot_be_a_result() -> None:
    with pytest.raises(RuntimeError, match="has no answer"):
        Findings().frozen({})


def test_a_result_is_drawn_by_plotly(result: Result) -> None:
    figure = result.plot()
    assert figure.layout.title.text
    assert len(figure.data) > 0
    assert len(figure.data[0].x) > 0


def test_a_result_has_frames_of_its_figures_and_tables(result: Result) -> None:
    pytest.importorskip("pandas")
    assert len(result.to_frame()) == len(result.figures)
    with pytest.raises(InputError, match="is no table: choose of"):
        result.to_frame("nosuch")


def test_numbers_that_are_none_are_words_in_the_json(compared: CompareResult) -> None:
    odd = compared.checks[0].model_copy(update={"computed": math.nan, "band": math.inf})
    found = json.loads(dataclasses.replace(compared, checks=(odd,)).to_json())
    assert (found["checks"][0]["computed"], found["checks"][0]["band"]) == ("nan", "inf")


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"ultimate": {"my": 1e6}}, "channel with an ultimate load"),
        ({"ultimate": {"My": -1.0}}, "ultimate load of My is -1 N or N m but must be above 0"),
        ({"frequency": 0.0}, "frequency of equivalent loads is 0 Hz but must be above 0"),
        ({"gate": 1.0}, "gate is 1 of the largest range but must be at least 0 and below 1"),
        ({"skip": -1.0}, "skip is -1 s but must be at least 0"),
        ({"rotor_speed_rpm": math.nan}, "rotor speed is nan 1/min but must be at least 0"),
        ({"rotor_speed_rpm": 0.0}, "rotor speed is 0 1/min but must be above 0"),
        ({"residue": "none"}, "residue of cycles"),
    ],
)
def test_options_of_loads_out_of_their_range_are_refused(
    options: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        LoadOptions(**options)


def test_words_and_counts_that_no_study_takes_are_refused(tmp_path: Path) -> None:
    scene = coarse_scene("bonded")
    write_history(tmp_path / "one.csv", 8.0)
    with pytest.raises(InputError, match="level of reactions to load histories"):
        loads(tmp_path / "one.csv", scene=scene, level=2)
    with pytest.raises(InputError, match="kind of export"):
        prepare_export(scene, "drawing")  # type: ignore[arg-type]
    with pytest.raises(InputError, match="39 samples show no band of 95 %: take 40 or more"):
        uncertainty(scene, samples=39)


def test_masses_and_costs_are_numbers(checked: CheckResult) -> None:
    assert checked.model is not None
    assert checked.mass == pytest.approx(float(checked.model.mass.sum()))
    assert [row["unknowns"] for row in checked.tables["levels"]] == [
        one.unknowns for one in checked.costs
    ]
    assert all(math.isfinite(one.seconds) for one in checked.costs)


def test_a_drivetrain_without_sections_is_checked_by_what_turns() -> None:
    found = check(read_drivetrain("park_2021"))
    assert found.turning is not None
    # 1 + (a + r_p) / r_s of the planetary stage, and the radii of the two others
    ratio = (1 + 0.43 / 0.11) * 0.29 / 0.095 * 0.185 / 0.08
    assert found.turning.ratio == pytest.approx(ratio, rel=1e-3)
    assert found.turning.degrees == {"torsional": 10, "rigid bodies": 60, "flexible shafts": 60}
    assert len(found.described["Gear stages, from the rotor on"]) == 3
    assert any("lengths of shafts" in row.source for row in found.assumptions)


@pytest.mark.parametrize(
    "asked",
    [
        lambda drivetrain, file: study(drivetrain),
        lambda drivetrain, file: advise(drivetrain, "main_bearing.Fz"),
        lambda drivetrain, file: loads(file, scene=drivetrain),
    ],
)
def test_what_needs_a_shaft_with_sections_refuses_one_without(
    asked: Callable[[Any, Path], object], tmp_path: Path
) -> None:
    file = tmp_path / "a.csv"
    write_history(file, 8.0)
    with pytest.raises(InputError, match="the main shaft has no sections, which this needs"):
        asked(two_masses(), file)


def test_a_grid_that_holds_the_generator_is_not_in_the_frequency_of_check() -> None:
    """`modes` has it: its first mode is then another one, and the name says so."""
    one = {"inertia": GENERATOR}
    free, held = (check(two_masses(generator=one | of)) for of in ({}, {"stiffness": 1e5}))
    for found in (free, held):
        figures = found.answer.figures
        (figure,) = [one for one in figures if one.name.startswith("first torsional")]
        assert figure.name.endswith("generator free of its grid")
        assert found.turning is not None
        assert free.turning is not None
        assert found.turning.first_torsional == pytest.approx(free.turning.first_torsional)


def test_a_figure_is_found_by_its_name(compared: CompareResult) -> None:
    for figure in compared.figures:
        assert compared[figure.quantity] is figure
    with pytest.raises(KeyError, match="is no figure of this result; its figures are:"):
        compared["nosuch"]


def test_what_differs_between_designs_is_named(compared: CompareResult) -> None:
    assert compared.inputs == {"200000": [("gearbox.weight", 1e5, 2e5)]}


def test_a_level_that_is_enough_is_within_the_tolerance(advised: AdviseResult) -> None:
    chosen = advised.chosen
    assert chosen is not None
    assert chosen.model.level == advised.level
    (figure,), (check,) = advised.figures, advised.checks
    assert figure.computed == pytest.approx(100 * check.computed)
    assert check.computed <= advised.advice.tolerance
    # one figure, from the advice and from the result
    mine, its = advised.plot().data, advised.advice.plot().data
    assert [(t.name, t.x, t.y) for t in mine] == [(t.name, t.x, t.y) for t in its]
    # the change of each detail, the largest first
    changes = [abs(effect.change) for effect in advised.effects]
    assert changes == sorted(changes, reverse=True)
    assert [row["detail left out"] for row in advised.all_tables()["details"]] == [
        effect.detail for effect in advised.effects
    ]


def test_a_band_is_of_the_inputs_and_stands_beside_the_error(uncertain: UncertaintyResult) -> None:
    moment, spring = "main_bearing.My", "gearbox.stiffness.2"
    assert next(iter(uncertain.bands)) == moment
    band = uncertain.bands[moment]
    assert band.low < uncertain.nominal[moment] < band.high
    # first order: two uniform values of known spread, so that the band lies within their reach
    slopes = uncertain.sensitivities[moment]
    reach = abs(slopes[spring]) * 0.2 + abs(slopes["shaft.front"]) * 0.01
    half = (band.high - band.low) / 2 / abs(uncertain.nominal[moment])
    assert 0.5 * reach < half < 1.1 * reach
    assert uncertain.units.keys() == uncertain.errors.keys() == uncertain.bands.keys()
    assert [row["quantity"] for row in uncertain.all_tables()["bands"]] == list(uncertain.bands)


def test_what_statics_decide_is_certain_in_words() -> None:
    """The gearbox's share of a moment: no stiffness is in it, but for round-off."""
    scene = change_scene(
        library_scene("three_point_suspension"),
        {"uncertainty": {"gearbox.stiffness.1": {"uniform": 0.05}}},
    )
    found = uncertainty(scene, ["gearbox.Fz"], {"hub.My": 1e6}, level=1, samples=40)
    assert found.answer.verdict.endswith(
        "0\u00a0% to 0\u00a0% by its inputs and ±\u00a00\u00a0% by the model."
    )


def test_no_samples_of_uncertain_values_are_in_the_json(uncertain: UncertaintyResult) -> None:
    found = uncertain.to_dict()
    assert found["tables"]["samples"] == found["options"]["samples"] == 40

    def longest(value: Any) -> int:
        if isinstance(value, dict):
            return max(map(longest, value.values()), default=0)
        if isinstance(value, list):
            return max([len(value), *map(longest, value)])
        return 0

    # the longest list is the quantities, each with its digest
    assert longest(found["tables"]) == len(uncertain.bands) < 40
    assert (uncertain.seed, found["seed"]) == (0, 0)


def test_a_load_that_a_scene_does_not_have_is_refused() -> None:
    scene = coarse_scene("bonded")
    with pytest.raises(InputError, match=r"load 'hub.Fq' is unknown: use one of hub.Fx"):
        advise(scene, "main_bearing.My", load={"hub.Fq": 1.0})
    with pytest.raises(InputError, match=r"load 'hub.Fx' is nan but must be finite"):
        advise(scene, "main_bearing.My", load={"hub.Fx": math.nan})


def test_a_project_is_signed_for_what_it_is(validated: ValidateResult, tmp_path: Path) -> None:
    assert [state.lacks for state in validated.states] == 6 * [()]
    assert validated.drivetrain is not None
    assert validated.drivetrain.hash == OWN.hash
    assert validated["complete steps of six"].computed == 6.0
    content: Content = small_project(tmp_path)

    def signed(digest: str) -> ValidateResult:
        content["signed"] = [
            {"name": "N", "role": "engineer", "date": "2026-01-31", "digest": digest}
        ]
        return validate(Project.model_validate(content), tmp_path)

    other = signed("0" * 16)
    assert not other.passed
    again = signed(other.digest)
    assert again.passed
    assert again.holds(again.project.signed[0])
    # a step that is not complete: there is nothing to sign
    content["campaign"] = None
    open_ = signed(other.digest)
    assert (open_.digest, open_.complete) == ("", False)
    assert not open_.holds(open_.project.signed[0])
    assert open_["complete steps of six"].computed == 5.0


def test_bores_planes_and_volume_of_a_part_are_numbers(shaped: PartResult) -> None:
    assert shaped.survey is not None
    bore, outside = shaped.survey.bores
    assert (bore.name, bore.hole, outside.hole) == ("S1", True, False)
    assert bore.radius == pytest.approx(0.05, rel=1e-6)
    assert bore.length == pytest.approx(0.6, rel=1e-9)
    assert np.abs(bore.axis) == pytest.approx([1.0, 0.0, 0.0], abs=1e-9)
    area = math.pi / 4 * (0.3**2 - 0.1**2)
    # facets within the circles: the mesh has eight elements a turn
    ends = shaped.survey.planes[:2]
    assert sorted(plane.point[0] for plane in ends) == pytest.approx([0.0, 0.6], abs=1e-9)
    assert [plane.area for plane in ends] == pytest.approx(2 * [area], rel=0.11)
    (volume,) = shaped.figures
    assert volume.computed == pytest.approx(0.6 * area, rel=5e-3)


def test_a_superelement_has_its_stiffness_at_the_bore(condensed: PartResult) -> None:
    assert condensed.housing is not None
    np.testing.assert_array_equal(condensed.housing.stiffness, STIFFNESS)
    for k, motion in enumerate(MOTIONS):
        unit = "N/m" if k < 3 else "N m/rad"
        found = condensed[f"{motion} at the bore, other motions held"]
        assert (found.computed, found.unit) == (STIFFNESS[k, k], unit)


def test_what_is_exported_has_the_facts_of_its_header(exported: ExportResult) -> None:
    element = exported.content
    assert isinstance(element, Superelement)
    assert exported.points == element.points == ("hub", "gearbox")
    assert exported.level.startswith("2 ")
    assert exported.band == element.band
    inertia = element.inertia()
    assert inertia is not None
    assert exported["mass"].computed == inertia[0, 0] == pytest.approx(inertia[2, 2], rel=1e-9)
    assert [row["point"] for row in exported.tables["points"]] == ["hub", "gearbox"]
    assert exported.tables["checks"]["force against rigid motions"] < 1e-9


@pytest.mark.parametrize("kind", ["mesh", "model"])
def test_a_mesh_is_counted_by_part(kind: Literal["mesh", "model"]) -> None:
    result = prepare_export(coarse_scene("bonded"), kind)
    mesh = result.content.mesh if isinstance(result.content, Model) else result.content
    assert isinstance(mesh, Mesh)
    counts = {row["part"]: row["elements"] for row in result.tables["elements"]}
    assert sum(counts.values()) == len(mesh.cells)
    assert result.details[0].startswith(f"{len(mesh.cells):,} elements")
    assert result.chart().figure["data"][0]["x"] == list(counts.values())


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"kind": "modes", "what": "seats"}, "is for the free shaft, not for `what='seats'`"),
        ({"kind": "modes", "level": 3}, "is for the shaft of level 2, not `level=3`"),
        ({"what": "tower"}, "'tower' cannot be exported: use one of shaft"),
        ({"level": 7}, "level 7 of shaft is unknown"),
        ({"modes": 3}, "`modes` is not used by an export of kind 'superelement': leave it out"),
        ({"kind": "mesh", "at": ["hub"]}, "`at` is not used by an export of kind 'mesh'"),
        ({"kind": "summary", "at": ["hub"]}, "is not used by `kind='summary'`"),
    ],
)
def test_what_cannot_be_exported_is_refused(options: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        prepare_export(coarse_scene("bonded"), **options)


def test_points_of_a_mesh_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"`held=.*foot.*` names points of a superelement"):
        part(tmp_path / "any.vtu", held=["foot"])


def test_a_component_is_no_model() -> None:
    component = library_component("planet_carrier")
    for kind in ("model", "summary"):
        with pytest.raises(InputError, match="is a component: export its mesh"):
            prepare_export(component, kind)
    with pytest.raises(InputError, match="`kind='modes'` is for the shaft of a scene"):
        prepare_export(component, "modes", modes=1)


def test_equivalent_loads_are_those_of_a_sine(loaded: LoadsResult) -> None:
    found = loaded.equivalent_loads["My"]
    # from 0 by 1, -1, 1, -1, 1, -1 to 0 kN m: five half cycles of 2 kN m, two of 1 kN m
    for slope, one in found.items():
        load = ((2.5 * 2e3**slope + 1e3**slope) / 30.1) ** (1.0 / slope)
        assert one.load == pytest.approx(load, rel=1e-6)
        assert one.band is not None
        assert one.load + one.band == pytest.approx(load * 2.0 ** (1.0 / slope), rel=1e-6)
    figure = loaded["equivalent load of My, slope 3"]
    assert (figure.unit, figure.computed) == ("kN m", found[3.0].load / 1e3)
    reaction = loaded.reactions["main_bearing"].equivalent_load("Fz", 3.0, loaded.asked)
    assert reaction.load > 0.0
    rows = {row["reaction"]: row for row in loaded.tables["reactions"]}
    assert rows["main_bearing, Fz [kN]"]["DEL, m = 3"] == pytest.approx(reaction.load / 1e3)
    assert loaded.capture is None
    assert loaded.lifetime is None


def test_long_tables_of_loads_are_frames(loaded: LoadsResult) -> None:
    pytest.importorskip("pandas")
    found = loaded.to_frame("equivalent_loads")
    assert set(found["file"]) == {"all", "wave"}
    my = found[(found["channel"] == "My") & (found["slope"] == 5.0)]["DEL at 1 Hz"]
    assert list(my) == [loaded.equivalent_loads["My"][5.0].load] * 2
    assert "windows" not in loaded.to_dict()["tables"]


def test_distributions_hold_all_time_and_turns(loaded: LoadsResult) -> None:
    levels = loaded.hub.levels
    assert levels.seconds["Mx"].amount.sum() == pytest.approx(30.1)
    assert levels.turns["bending moment"].amount.sum() == pytest.approx(30.1 * 1.5 / 2 / np.pi)
    tables = loaded.file_tables()
    assert sum(row["amount"] for row in tables["levels"] if row["of"] == "seconds") == (
        pytest.approx(8 * 30.1)
    )
    assert [row["frequency [Hz]"] for row in tables["spectra"]] == pytest.approx(
        [line / 60.0 for line in range(300)]  # up to half of 10 Hz
    )


def test_loads_without_files_winds_or_slopes_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there are no files"):
        loads([])
    still = tmp_path / "still.csv"
    write_hub_loads(LoadHistory("still", np.arange(20) * 0.1, np.ones((20, 6))), still)
    with pytest.raises(InputError, match="no wind speed, by which `site` weights"):
        loads([still], site=Site(8.5))
    with pytest.raises(InputError, match="events of a lifetime: give `site`, too"):
        loads(still, transients=[(700.0, still)])
    with pytest.raises(InputError, match="no slope of an S-N curve"):
        LoadOptions(slopes=())
    with pytest.raises(InputError, match="must be from 1 to 20"):
        LoadOptions(slopes=(0.5,))


def test_a_lifetime_is_that_of_its_winds_and_events(tmp_path: Path) -> None:
    """Winds by their hours over the time of their files, stops of unlike damage by their mean."""
    time, slope = np.arange(201) * 0.1, 4.0

    def written(name: str, size: float, wind: float) -> Path:
        samples = np.full((201, 6), 1.0)
        samples[:, 4] = size * np.sin(2.0 * np.pi * time / 10.0)
        table = np.column_stack([time, samples, np.full(201, wind)])
        header = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m],wind speed [m/s]"
        file = tmp_path / f"{name}.csv"
        np.savetxt(file, table, delimiter=",", header=header, comments="", fmt="%.9g")
        return file

    def damage(size: float) -> float:  # 0, 1, -1, 1, -1, 0: three half cycles of 2, two of 1
        return (1.5 * 2.0**slope + 1.0) * size**slope

    written("calm", 1e3, 8.0)
    written("storm", 2e3, 12.0)
    stops = [written("stop", 3e3, 9.0), written("other_stop", 4e3, 9.0)]
    found = loads(
        tmp_path / "*m.csv",  # calm and storm
        LoadOptions(slopes=(slope,)),
        site=Site(9.0),
        transients=[(500.0, stops)],
    ).lifetime
    assert found is not None
    hours = Site(9.0).hours([6.0, 10.0, 14.0])
    parts = [3600.0 * h / 20.1 * damage(size) for h, size in zip(hours, (1e3, 2e3), strict=True)]
    parts.append(500.0 * 20.0 * (damage(3e3) + damage(4e3)) / 2.0)
    assert found.sources == ("8 m/s", "12 m/s", "stop and 1 more")
    np.testing.assert_allclose(found.damage[4, 0], parts, rtol=1e-6)
    equivalent = found.equivalent_loads([slope])[4, 0]
    assert equivalent == pytest.approx((sum(parts) / 1e7) ** (1.0 / slope), rel=1e-6)
    of_events = 500.0 * 20.0 * 20.1 / 3600.0
    assert found.hours_at_level["Mx"].amount.sum() == pytest.approx(hours.sum() + of_events)


def test_files_of_one_stem_are_told_apart(tmp_path: Path) -> None:
    files = [tmp_path / folder / "same.csv" for folder in "ab"]
    for file, wind in zip(files, (8.0, 14.0), strict=True):
        file.parent.mkdir()
        write_history(file, wind)
    found = life(library_scene("main_bearing_spherical"), files, options=LifeOptions(every=4))
    names = [str(file) for file in files]
    assert [row["file"] for row in found.all_tables()["files"]] == names
    assert found.options["files"] == names
    assert loads(files).options["files"] == names


def test_a_life_is_a_number_with_what_takes_it(lived: LifeResult) -> None:
    (one,) = lived.bearings.values()
    years = one.years["L10mr"]
    assert lived["L10mr of bearing main_bearing"].computed == years
    assert one.site is not None
    turns = one.million_revolutions["L10mr"] / one.damage.turns * 1e6  # in a year at the site
    assert turns == pytest.approx(years, rel=1e-12)
    assert one.damage.of_rows(True).sum() == pytest.approx(1.0 / years, rel=1e-9)
    assert one.site.of_winds("L10mr").sum() == pytest.approx(1.0)
    whole = sum(f.damage.seconds for f in one.files)
    mean = one.mean_load.mean(axis=1)
    assert whole == pytest.approx(20.0)
    assert (one.peak_load.max(axis=1) >= mean).all()


def test_tables_of_lives_by_file_and_place_are_frames(lived: LifeResult) -> None:
    pytest.importorskip("pandas")
    assert list(lived.to_frame("files")["file"]) == ["v14", "v8"]
    places, rings = lived.to_frame("places"), lived.to_frame("rings")
    (one,) = lived.bearings.values()
    by_place = places["outer ring, damage by L10mr"].sum()
    outer = rings[rings["ring"] == "outer"]["share of L10mr's damage [%]"].sum()
    assert by_place * one.years["L10mr"] == pytest.approx(0.01 * outer, rel=1e-9)
