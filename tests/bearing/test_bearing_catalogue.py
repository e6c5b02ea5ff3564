"""Bearings by name: what the catalogue says is complete, sourced, and fits the printed ratings."""

from pathlib import Path

import numpy as np
import pytest
from conftest import QuickRun
from numpy.testing import assert_allclose

from fe_drivetrain.bearing.catalogue import catalogue_bearing, read_bearing_catalogue
from fe_drivetrain.bearing.distribution import effective_centre
from fe_drivetrain.bearing.rating import ratings
from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.bearing.seats import check_seat
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_scene

MINE = """
mine:
  title: Mine
  kind: cylindrical
  elements: 20
  element_diameter: 0.03
  element_length: 0.04
  pitch_diameter: 0.3
  law: iso
  sources: {elements: plan, element_diameter: plan, element_length: plan, pitch_diameter: plan}
"""


@pytest.mark.parametrize("name", read_bearing_catalogue())
def test_every_bearing_carries_a_radial_load(name: str) -> None:
    entry = read_bearing_catalogue()[name]
    bearing = entry.bearing(name)
    axial = 1.5 * np.tan(bearing.rows[0].angle) if len(bearing.rows) == 1 else 0.0
    load = [1e5 * axial, 0, -1e5, 0, 0]
    if axial:
        load[3] = -effective_centre(bearing.rows[0]) * load[2]  # so that no moment acts there
    found = equilibrium(bearing, load)
    assert found.converged.all()
    assert found.rollers.max() > 0.0


def test_scenes_that_bearings_stand_in_are_in_the_library() -> None:
    named = {scene for entry in read_bearing_catalogue().values() for scene in entry.scenes}
    for scene in named:
        assert library_scene(scene).title
    assert {"three_point_suspension", "iea_15mw_main_shaft", "main_bearing_bonded"} <= named


def test_assumed_rollers_fit_the_printed_ratings() -> None:
    """Bearing S is sized at 20 deg; MASTA's bearing is given with its rollers."""
    for name, within in (
        ("bearing_s_o20", 0.03),
        ("bearing_s_x20", 0.03),
        ("masta_single", 1e-3),
        ("nrel_5mw_planet", 0.02),
        ("nrel_5mw_carrier_upwind", 0.05),
        ("nrel_5mw_carrier_downwind", 0.02),
    ):
        entry = read_bearing_catalogue()[name]
        found = ratings(entry.bearing(name))
        assert entry.ratings is not None
        printed = (entry.ratings.C, entry.ratings.C0, entry.ratings.Cu)
        for own, value in zip((found.dynamic, found.static, found.fatigue), printed, strict=True):
            assert value is None or abs(own / value - 1.0) < within, name


def test_effective_centres_of_the_pair_are_mastas() -> None:
    upwind, downwind = catalogue_bearing("masta_pair").rows
    assert_allclose(effective_centre(downwind) - effective_centre(upwind), 3.616662, rtol=3e-3)


def test_a_users_file_extends_the_catalogue(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(MINE, encoding="utf-8")
    assert {"mine", "bearing_s"} <= read_bearing_catalogue(file).keys()
    assert catalogue_bearing("mine", file, clearance=1e-5).rows[0].clearance == 1e-5
    assert catalogue_bearing("bearing_s", contact_angle=20, arrangement="O").rows[0].angle > 0


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("elements: 20", "elements: 40", "overlap"),
        ("elements: 20", "elements: many", "elements"),
        ("elements: plan, ", "", "sources of 'Mine'"),
        ("  law: iso\n", "", "law of 'Mine' is missing"),
        ("  law: iso\n", "  law: iso\n  spread: 0.1\n", "spread of 'Mine' is given"),
        ("cylindrical", "plain", "kind"),
        ("0.03", ".inf", "element_diameter"),
    ],
)
def test_mistakes_in_a_file_are_named(tmp_path: Path, old: str, new: str, words: str) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(MINE.replace(old, new, 1), encoding="utf-8")
    with pytest.raises(InputError, match=words) as caught:
        read_bearing_catalogue(file)
    assert "\n" not in str(caught.value)


def test_an_unknown_name_lists_those_that_are_there() -> None:
    with pytest.raises(InputError, match="bearing_s"):
        catalogue_bearing("skf")


@pytest.mark.quick("performance/bearing_equilibrium")
def test_every_step_of_the_speed_case_converges(quick_run: QuickRun) -> None:
    results = quick_run("performance/bearing_equilibrium")
    assert all(verdict.passed for verdict in results.verdicts)
    assert len(results.verdicts) >= 2


def test_bores_are_compared_with_shafts() -> None:
    entry = read_bearing_catalogue()["three_point_main"]
    assert check_seat("a", "three_point_main", entry, 0.6) is None
    assert check_seat("a", "three_point_main", entry, 0.62) is None  # rounded, or assumed
    thin = check_seat("a", "three_point_main", entry, 0.4)
    assert thin is not None
    assert "entry three_point_main is 600 mm, the shaft at its seat 400 mm" in thin
    with pytest.raises(InputError, match=r"600 mm, the shaft at its seat 640 mm.* at most 630 mm"):
        check_seat("a", "three_point_main", entry, 0.64)


def test_a_shaft_stays_inside_the_rollers_where_no_bore_is_given() -> None:
    entry = read_bearing_catalogue()["iea_15mw_upwind"]
    assert entry.bore is None
    assert check_seat("a", "iea_15mw_upwind", entry, 3.0) is None
    assert "is 3372 mm, the shaft" in str(check_seat("a", "iea_15mw_upwind", entry, 0.9))
    with pytest.raises(InputError, match=r"circle inside the rolling elements .* 3372 mm"):
        check_seat("a", "iea_15mw_upwind", entry, 3.4)


def test_a_bore_that_reaches_into_the_rollers_is_refused(tmp_path: Path) -> None:
    text = MINE.replace("  law: iso", "  bore: 0.28\n  law: iso")
    (tmp_path / "mine.yaml").write_text(text.replace("{elements", "{bore: plan, elements"))
    with pytest.raises(InputError, match=r"'Mine' is 0.28 m but must be less than 0.27"):
        read_bearing_catalogue(tmp_path / "mine.yaml")


@pytest.mark.parametrize("name", ["nrel_750kw_low_speed_shaft", "three_point_suspension"])
def test_bearings_of_library_scenes_fit_their_seats(name: str) -> None:
    scene = library_scene(name)
    (unit,) = scene.bearing_units
    seat = scene.shaft.seat_diameter(unit.bearing.x, unit.bearing.width, unit.bearing.name)
    assert unit.catalogue is not None
    assert check_seat("a", unit.catalogue, read_bearing_catalogue()[unit.catalogue], seat) is None
