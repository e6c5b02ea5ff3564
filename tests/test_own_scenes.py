"""Main-bearing cases on a user's scene: the page is about that scene, and says what is not."""

import re

import numpy as np
import pytest
import yaml
from coarse_scenes import COARSE, FINER, coarse_scene

from fe_drivetrain.cases.main_bearing import loads, study
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.geometry.fits import check_parts
from fe_drivetrain.geometry.walls import check_sizes
from fe_drivetrain.hub_loads.surrogate import Condition
from fe_drivetrain.report.results import Chart, Results, Text, read_results
from fe_drivetrain.scene.reading import change_scene, library_text
from fe_drivetrain.scene.scene import coarser_scene
from fe_drivetrain.suite.case import all_cases
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.run import Run
from fe_drivetrain.suite.suite import run_cases

pytestmark = pytest.mark.usefixtures("kept_between_runs")

#: Cases that take a scene of the user's; what each needs its bearing to be.
NEEDS = {
    "bonded": "bonded",
    "mesh_convergence": "bonded",
    "rmse": "bonded",
    "shaft_thickness": "bonded",
    "spherical": "spherical",
    "torsional_stiffness": "bonded",
}
#: Takes minutes, and reads its scene as these do.
SLOW = {"secant_stiffness"}


@pytest.fixture(scope="module")
def pages(tmp_path_factory, without_pictures) -> dict[str, Results]:
    """Results of each case on a small scene with a sliding bearing; what they say is asked."""
    folder = tmp_path_factory.mktemp("own")
    scene = coarse_scene("spherical", title="Turbine of mine", **FINER).model_dump(mode="json")
    (folder / "mine.yaml").write_text(yaml.safe_dump(scene))
    time = 0.05 * np.arange(40)
    forces = np.array([2e5, 0, -3.7e5, 1.1e6, 6e5, 0]) + 1e4 * np.sin(time)[:, None]
    table = np.column_stack([time, forces])
    header = "time [s],Fx [N],Fy [N],Fz [N],Mx [N m],My [N m],Mz [N m]"
    np.savetxt(folder / "loads.csv", table, delimiter=",", header=header, comments="")
    settings = {"scene": str(folder / "mine.yaml"), "loads": str(folder / "loads.csv")}
    cases = [all_cases()[f"main_bearing/{name}"] for name in NEEDS]
    assert run_cases(cases, folder / "reports", settings, quick=True) == {}
    return {
        name: read_results(folder / "reports/main_bearing" / name / "results.json")
        for name in NEEDS
    }


def test_these_are_all_cases_that_take_a_scene():
    found = {n.partition("/")[2] for n, case in all_cases().items() if "scene" in case.settings}
    assert found == set(NEEDS) | SLOW


@pytest.mark.parametrize("name", NEEDS)
def test_the_page_is_about_the_users_scene(pages, name):
    results = pages[name]
    assert results.title.startswith("Turbine of mine: ")
    assert re.fullmatch(r"scene .*mine\.yaml", results.source)
    assert "thesis" not in results.model_dump_json().lower()
    # the source of a formula is named where it is used, that of a default where it is listed
    text = results.model_dump_json(exclude={"assumptions"})
    assert re.findall(r"Stirling 2023(?!, Eq)", text) == []


@pytest.mark.parametrize("name", NEEDS)
def test_another_bearing_than_the_scenes_is_the_first_that_is_said(pages, name):
    quick, *notes = pages[name].notes
    assert quick.startswith("Quick run")
    exchanged = [note for note in notes if note.startswith("Another bearing")]
    if NEEDS[name] == "spherical":
        assert exchanged == []
    else:
        (note,) = exchanged
        assert note == notes[0]
        assert "'main_bearing' of the scene is sliding" in note
        assert "needs a bonded one" in note
        assert "made bonded, not of the scene as it was given" in note


def test_the_study_begins_with_the_bearing_that_the_scene_has(pages):
    assert "spherical bearing" in pages["rmse"].summary[0]


@pytest.mark.parametrize("kind", ["spherical", "bonded"])
@pytest.mark.parametrize("interface", ["bonded", "sliding", "averaged", "rigid"])
def test_no_bearing_is_exchanged_in_silence(tmp_path, kind, interface):
    """Of the library's scene with the user's change as of a file."""
    bearing = "ring" if interface == "bonded" else "spherical"
    changes = {
        "bearing_units.0.interface": interface,
        "bearing_units.0.bearing.kind": bearing,
    }
    page = Page()
    scene = study.scene_of(Run(COARSE | changes, False, tmp_path), page, kind)
    assert study.kind_of(scene) == kind
    kept = scene.bearing_units[0].interface == interface
    assert kept == (page.notes == [])
    assert kept == ((interface == "bonded") == (kind == "bonded"))
    assert page.subject == ""


def test_a_quick_look_at_a_thin_wall_is_as_coarse_as_the_wall_allows():
    sections = [{"length": 2.0, "outer_diameter": 0.5, "inner_diameter": 0.46}]
    changes = {"shaft.sections": sections, "mesh.shaft": 0.05, "mesh.elements_per_turn": 8}
    scene = change_scene(coarse_scene("bonded"), changes)
    quick = coarser_scene(scene, 2.0, 8)
    assert quick.mesh.shaft == pytest.approx(3 * 0.02)  # three times the wall, not 0.1
    assert quick.mesh.bearing_edge == 2.0 * scene.mesh.bearing_edge
    (unit,) = scene.bearing_units
    parts = scene.shaft, [unit.bearing], {unit.bearing.name: unit.housing}
    bores = check_parts(*parts)
    check_sizes(*parts, bores, quick.mesh)
    with pytest.raises(InputError, match="thinnest wall"):
        check_sizes(*parts, bores, scene.mesh.scaled(2.0, 8))


def test_several_bearings_are_sent_to_the_study(tmp_path):
    file = tmp_path / "mine.yaml"
    file.write_text(library_text("two_bearings"))
    run = Run({"scene": str(file)}, False, tmp_path)
    with pytest.raises(InputError, match=r"2 bearing units.*fe-drivetrain study"):
        study.given_scene(run, "bonded")


def test_errors_of_round_off_are_a_sentence_and_not_a_chart(rng):
    conditions = [Condition(wind, "medium", 0.2, seed) for wind in (8.0, 16.0) for seed in (1, 2)]
    fe = {"bonded": 1e5 * rng.normal(size=(4, 50, 6))}
    noise = rng.normal(size=(4, 50, 6))
    pairs = {
        "exact against FE": ("bonded", fe["bonded"] + 1e-7 * noise),
        "near against FE": ("bonded", fe["bonded"] + 1.0 * noise),
    }
    page = Page()
    loads.rmse_charts(page, conditions, fe, pairs)
    (section,) = page.sections
    texts = [item.text for item in section.items if isinstance(item, Text)]
    charts = [item.caption for item in section.items if isinstance(item, Chart)]
    assert ["exact" in text and "round-off" in text for text in texts] == [True]
    assert len(charts) == 2
    assert all("near" in caption for caption in charts)
