"""Lives of a drivetrain's bearings that are given by their catalogue's page."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.bearing.catalogue import fitted_entry, insides_of_page
from fe_drivetrain.bearing.catalogue_page import CataloguePage
from fe_drivetrain.bearing.fitted_rollers import fitted_rollers
from fe_drivetrain.bearing.geometry import RollerRow
from fe_drivetrain.bearing_life.life.rated import rated_from_catalogue
from fe_drivetrain.bearing_life.life.roller_models import rigid_rings
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import silent
from fe_drivetrain.common.reading import changed
from fe_drivetrain.drivetrain_file import read_drivetrain
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.turning_parts import BearingData
from fe_drivetrain.dynamics.bodies.catalogue_seats import bearing_of
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.shafts.uncertainty.sampling import sample
from fe_drivetrain.studies.bearing_lives import LifeResult, life
from fe_drivetrain.studies.life_inside import insides_of
from fe_drivetrain.studies.life_options import LifeOptions
from fe_drivetrain.studies.named_bearings import entry_of
from fe_drivetrain.studies.rolling_bearings import OneBearing
from fe_drivetrain.studies.turning_uncertainty import (
    TurningSamples,
    drawn_insides,
    turning_study,
)
from fe_drivetrain.turbine_loads.hub_loads.csv_table import write_hub_loads
from fe_drivetrain.turbine_loads.hub_loads.surrogate import Condition, hub_load_set

PAGE: dict[str, Any] = {
    "designation": "230/600",
    "C": 6.0e6,
    "C0": 1.14e7,
    "Cu": 7.5e5,
    "e": 0.22,
    "Y1": 3.0,
    "Y2": 4.6,
    "Y0": 2.8,
}


def scene_with(page: dict[str, Any]) -> Scene:
    return changed(
        library_scene("three_point_suspension"), {"bearing_units.0.catalogue": page}, "test"
    )


@pytest.fixture(scope="module")
def loads(tmp_path_factory: pytest.TempPathFactory) -> Path:
    (history,) = hub_load_set([Condition(12.0, "low", shear=0.2, seed=1)], 12.0, 5.0)
    path = tmp_path_factory.mktemp("loads") / "w12.csv"
    write_hub_loads(history, path)
    return path


def life_of(page: dict[str, Any], loads: Path, support: str = "rollers") -> LifeResult:
    options = LifeOptions(rotor_speed_rpm=12.0, support=support)
    return life(scene_with(page), loads, options=options)


@pytest.fixture(scope="module")
def by_page(loads: Path) -> LifeResult:
    return life_of(PAGE, loads)


def test_bands_hold_the_inside_that_is_taken(by_page: LifeResult) -> None:
    one = by_page.bearings["main_bearing"]
    band = one.inside
    assert band is not None
    for kind, (low, high) in band.years.items():
        assert low < one.years[kind] < high
    assert band.pressure[0] <= one.limits.max_pressure <= band.pressure[1]
    taken, low, high = band.stiffness
    assert low <= taken <= high
    assert len(by_page.tables["insides"]) == 6
    assert any("does not print what is inside" in note for note in by_page.notes)


def test_lives_of_iso_281_follow_from_the_page_alone(loads: Path) -> None:
    # pinned: on its rollers the shaft gives a stiffer bearing more of the load
    known = {**PAGE, "elements": 24, "pitch_diameter": 0.75}
    one, other = (life_of(page, loads, "pinned").bearings["main_bearing"] for page in (PAGE, known))
    assert one.rows != other.rows
    for kind in ("L10", "L10m"):
        assert one.years[kind] == pytest.approx(other.years[kind], rel=1e-12)
    assert one.years["L10r"] != pytest.approx(other.years["L10r"], rel=1e-6)
    assert one.inside is not None
    assert other.inside is not None
    spans = [found.stiffness[2] / found.stiffness[1] for found in (other.inside, one.inside)]
    assert spans[0] < spans[1]  # what is known narrows the band


def test_scene_with_a_page_is_the_same_when_it_is_read_again() -> None:
    scene = scene_with(PAGE)
    assert isinstance(scene.bearing_units[0].catalogue, CataloguePage)
    assert Scene.model_validate(scene.model_dump(mode="json")) == scene


def test_faults_of_a_page_in_a_scene_come_together() -> None:
    with pytest.raises(InputError, match=r"2 faults: .*C is 6000 N .*e is 0.9 and Y1 3"):
        scene_with({**PAGE, "C": 6000, "e": 0.9, "Y2": None})


def test_bearing_of_a_gearbox_takes_a_page_with_the_clearance_of_its_row() -> None:
    row = BearingData.model_validate(
        {
            "name": "HSS-A",
            "holds": "stage 2 pinion",
            "stiffness": [0, 6e8, 6e8, 0, 0, 0],
            "catalogue": {"designation": "NU 2220", "C": 3.8e5, "C0": 4.5e5, "Cu": 5.4e4},
            "clearance": 4e-5,
        }
    )
    found = bearing_of(row)
    assert found.name == "NU 2220"
    assert [one.clearance for one in found.rows] == [4e-5]


def test_each_inside_has_the_clearance_and_profile_of_its_own() -> None:
    page = CataloguePage.read(
        {"designation": "NU 2220", "C": 3.8e5, "C0": 4.5e5, "Cu": 5.4e4}, "page"
    )
    rated = rated_from_catalogue(page, clearance=3e-5)
    nowhere: Any = None
    one = OneBearing("x", "x", fitted_entry(page), rated, nowhere, None, rigid_rings)
    fitted = fitted_rollers(page)
    insides = insides_of(one, profiled=True)
    assert len(insides) == len(fitted)
    for k, inside in enumerate(insides):
        (row,) = inside.rows
        assert isinstance(row, RollerRow)
        assert row.clearance == 3e-5
        assert row.crown / row.diameter == pytest.approx(3.5e-4 * fitted.crown[k], rel=1e-12)
    straight = [inside.rows[0] for inside in insides_of(one, profiled=False)]
    assert {row.crown for row in straight if isinstance(row, RollerRow)} == {0.0}


NU: dict[str, Any] = {"designation": "NU 2220", "C": 3.8e5, "C0": 4.5e5, "Cu": 5.4e4}
INERTIA = {"generator.inertia": {"uniform": 0.05}}
LIFE = "life.IMS-PLC-A.L10mr"


def test_a_page_may_state_which_inside_it_has() -> None:
    page = CataloguePage.read(NU, "page")
    fitted, taken = insides_of_page(page), fitted_entry(page)
    assert fitted_entry(CataloguePage.read({**NU, "inside": fitted.middle}, "page")) == (
        taken.model_copy(update={"page": page.model_copy(update={"inside": fitted.middle})})
    )
    lengths = [
        fitted_entry(CataloguePage.read({**NU, "inside": k}, "page")).element_length
        for k in range(len(fitted))
    ]
    assert lengths == pytest.approx(list(fitted.length))
    with pytest.raises(InputError, match="inside is 24 but must be less than 24"):
        CataloguePage.read({**NU, "inside": 24}, "page")


def test_samples_draw_every_inside_as_often_as_any_other() -> None:
    drivetrain = read_drivetrain(
        "nrel_5mw", {"gearbox.bearings.2.catalogue": NU, "uncertainty": INERTIA}
    )
    (key,) = drawn = drawn_insides(drivetrain, (LIFE, "modes.torsional.1"))
    assert drawn == {"gearbox.bearings.2.catalogue.inside": 24}
    assert drawn_insides(drivetrain, ("modes.torsional.1",)) == {}
    stated = read_drivetrain("nrel_5mw", {"gearbox.bearings.2.catalogue": {**NU, "inside": 3}})
    assert drawn_insides(stated, (LIFE,)) == {}

    def inside(sampled: Drivetrain) -> dict[str, float]:
        page = sampled.gearbox.bearings[2].catalogue
        assert isinstance(page, CataloguePage)
        return {"inside": -1.0 if page.inside is None else float(page.inside)}

    found = sample(drivetrain, inside, 48, drawn={key: 24})["inside"]
    assert found.nominal == -1.0  # the middle
    assert sorted(found.values.tolist()) == sorted([*range(24)] * 2)


def test_a_life_is_as_uncertain_as_the_inside_of_its_bearing() -> None:
    """The generator's inertia changes no life at rated torque, so that only the insides do."""
    asked = TurningSamples((LIFE,), 0.05, "rigid", 4, 0, 0)
    scatter = []
    for page in (NU, {**NU, "inside": 3}):
        changes = {"gearbox.bearings.2.catalogue": page, "uncertainty": INERTIA}
        found = Findings()
        known = turning_study(read_drivetrain("nrel_5mw", changes), asked, found, silent)
        scatter.append(np.ptp(known.samples[LIFE].values) / known.samples[LIFE].nominal)
        assert any("Samples draw one of the insides" in one for one in found.notes) == (page is NU)
    assert scatter[0] > 0.05
    assert scatter[1] < 1e-9


def test_a_designation_without_its_ratings_asks_for_the_page() -> None:
    with pytest.raises(InputError, match=r"as in \{designation: 230/500, C: \.\.\., C0"):
        entry_of("rear", "230/500", {})
