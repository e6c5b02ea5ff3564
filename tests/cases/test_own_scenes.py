"""What of a main bearing the user may change in its cases, and what is sent to the study."""

import re
from pathlib import Path

import pytest
from coarse_scenes import COARSE, coarse_scene

from fe_drivetrain.cases.main_bearing import bearing_scenes, charts
from fe_drivetrain.command_line.settings import parse_settings
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.drivetrain_file.scene import coarser_scene
from fe_drivetrain.geometry.fits import check_parts
from fe_drivetrain.geometry.walls import check_sizes
from fe_drivetrain.report.results import Chart, Text
from fe_drivetrain.report.suite.case import all_cases
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.report.suite.settings import settings_by_case
from fe_drivetrain.turbine_loads.hub_loads.surrogate import Condition


@pytest.mark.parametrize(
    ("setting", "command"),
    [
        ("scene=mine.yaml", "fe-drivetrain study FILE)"),
        ("loads=outputs", "fe-drivetrain study FILE --loads FILES)"),
        ("skip=60", "fe-drivetrain study FILE --loads FILES --skip SECONDS)"),
        ("self_weight=false", "fe-drivetrain study FILE --no-weight)"),
    ],
)
def test_a_drivetrain_of_ones_own_is_sent_to_the_study(setting: str, command: str) -> None:
    cases = [case for name, case in all_cases().items() if name.startswith("main_bearing/")]
    with pytest.raises(InputError, match=re.escape(command)):
        settings_by_case(cases, parse_settings([setting]))


def test_no_case_takes_a_scene_of_ones_own() -> None:
    assert [name for name, case in all_cases().items() if "scene" in case.settings] == []


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
    scene = bearing_scenes.scene_of(Run(COARSE | changes, False, tmp_path), page, kind)
    allowed = bearing_scenes.SPHERICAL if kind == "spherical" else ("bonded",)
    assert scene.bearing_units[0].interface in allowed
    kept = scene.bearing_units[0].interface == interface
    assert kept == (page.notes == [])
    assert kept == ((interface == "bonded") == (kind == "bonded"))


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


@pytest.mark.parametrize(
    ("scene", "has"), [("two_bearings", "2 bearing units"), ("iea_15mw_shaft_on_nose", "a nose")]
)
def test_several_bearings_and_a_nose_are_sent_to_the_study(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, scene: str, has: str
) -> None:
    monkeypatch.setattr(bearing_scenes, "library_scene", lambda name: library_scene(scene))
    run = Run({}, False, tmp_path)
    with pytest.raises(InputError, match=rf"has {has}.*run fe-drivetrain study"):
        bearing_scenes.changed_scene(run, "bonded")


def test_load_points_are_left_out_aloud(tmp_path: Path) -> None:
    brake = {"name": "brake", "x": 0.8, "width": 0.1, "weight": 2e4}
    page = Page()
    run = Run(COARSE | {"load_points": [brake]}, False, tmp_path)
    assert bearing_scenes.scene_of(run, page, "bonded").load_points == ()
    assert page.notes[0].startswith("Without the loads and weights at brake")


def test_errors_of_round_off_are_a_sentence_and_not_a_chart(rng):
    conditions = [Condition(wind, "medium", 0.2, seed) for wind in (8.0, 16.0) for seed in (1, 2)]
    fe = {"bonded": 1e5 * rng.normal(size=(4, 50, 6))}
    noise = rng.normal(size=(4, 50, 6))
    pairs = {
        "exact against FE": ("bonded", fe["bonded"] + 1e-7 * noise),
        "near against FE": ("bonded", fe["bonded"] + 1.0 * noise),
    }
    page = Page()
    charts.rmse_charts(page, conditions, fe, pairs)
    (section,) = page.sections
    texts = [item.text for item in section.items if isinstance(item, Text)]
    drawn = [item.caption for item in section.items if isinstance(item, Chart)]
    assert ["exact" in text and "round-off" in text for text in texts] == [True]
    assert len(drawn) == 2
    assert all("near" in caption for caption in drawn)
