"""Cases of a main bearing on a user's drivetrain: their rotor, their answers, and mistakes."""

import re
from pathlib import Path

import numpy as np
import pytest

from fe_drivetrain.cases.bearing import stiffness_scenarios
from fe_drivetrain.cases.histories import operating_range
from fe_drivetrain.cases.life import by_wind_speed
from fe_drivetrain.cases.references.main_bearings import own_bearing, own_rotor, thesis_in_shaft
from fe_drivetrain.cases.references.studied_lives import Winds
from fe_drivetrain.cases.references.thesis_beam import BEAM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.suite.chosen import chosen_drivetrain
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.turbine_loads.hub_loads.surrogate import Condition

OWN = """
title: Main shaft of a user (5 MW)
shaft:
  front: -2.5
  sections:
    - {length: 5.5, outer_diameter: 0.45}
  material: steel
bearing_units:
  - bearing: {name: front, kind: ring, material: steel}
    housing: {material: ductile_iron}
    interface: bonded
    catalogue: bearing_s_o20
gearbox: {stiffness: [4.0e6, 8.0e7, 8.0e7, rigid, 0, 0], weight: 5.0e5}
operation: {rated_power: 5.0e6, rotor_speed: [0.7226, 1.2671]}
"""
PRINTED = ("thesis", "1.5 MW", "bearing S", "statements")


@pytest.fixture(scope="module")
def file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("own") / "mine.yaml"
    path.write_text(OWN)
    return path


def ran(case: object, file: Path, folder: Path) -> Page:
    page = Page()
    case.run(Run({"drivetrain": str(file)}, True, folder), page)  # type: ignore[attr-defined]
    return page


@pytest.mark.parametrize("case", [stiffness_scenarios, by_wind_speed, operating_range])
def test_a_users_bearing_is_answered_by_itself(
    case: object, file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    sets = (("medium", 0.1), ("medium", 0.2), ("medium", 0.4))
    grid = [Condition(wind, *own, 1) for wind in (4.0, 12.0) for own in sets]
    monkeypatch.setattr(operating_range, "operating_grid", lambda: grid)
    made = operating_range.turbine_histories
    monkeypatch.setattr(
        operating_range,
        "turbine_histories",
        lambda *given, duration, **more: made(*given, duration=0.2 * duration, **more),
    )
    monkeypatch.setattr(by_wind_speed, "Winds", lambda *_: Winds("medium", 0.1, 2, 8.0, 1.0))
    page = ran(case, file, tmp_path)
    answer = page.answered
    assert answer is not None
    words = answer.verdict + answer.question + "".join(f.quantity for f in answer.figures)
    assert not [one for one in PRINTED if one in words]
    assert page.subject == "Main shaft of a user (5 MW)"
    assert all(check.passed for check in page.checks)


def test_the_rotor_is_brought_to_rated_power_and_speed(file: Path) -> None:
    page = Page()
    found = own_rotor(page, chosen_drivetrain(str(file), ""))
    assert found.radius == pytest.approx(63.25, abs=0.01)  # that of the NREL 5 MW turbine is 63 m
    assert found.tip_speed_limit == pytest.approx(80.1, abs=0.1)  # its 80 m/s
    assert found.rotor_mass == pytest.approx(110e3, rel=0.01)  # its 110 t
    assert found.rotor_speed(20.0) == pytest.approx(1.2671)
    whole = chosen_drivetrain("nrel_5mw", "")
    assert own_rotor(Page(), whole).rotor_mass == 1.1e5  # as its file says
    assert {one.name for one in page.assumptions} >= {"rotor mass", "hub loads", "housing"}


def test_the_thesis_bearing_balances_its_beam() -> None:
    hub = np.array([[2e5, 1e4, -3.8e5, 0.0, 4e5, 1e5]])
    for arrangement in ("X, 38 deg", "O, 20 deg"):
        found = thesis_in_shaft(arrangement).under(hub)
        assert found.converged.all()
        assert found.imbalance() == pytest.approx(0.0, abs=1e-3)
        carried = found.of("bearing")[0, :3] + found.reactions()["gearbox"][0, :3]
        assert carried == pytest.approx(hub[0, :3] - [0.0, 0.0, BEAM.gearbox_weight], abs=1e-2)


@pytest.mark.parametrize(
    ("change", "settings", "words"),
    [
        (("catalogue: bearing_s_o20", ""), {}, "bearing 'front' of .* has no rollers"),
        (("operation:", "# operation:"), {}, "does not state operation: add it"),
        (("", ""), {"bearing": "rear"}, "no such main bearing: name one of front"),
        (("bearing_s_o20", "main_bearing_spherical"), {}, "aligns itself and resists no tilt"),
    ],
)
def test_what_is_missing_is_asked_for(
    change: tuple[str, str], settings: dict[str, str], words: str, tmp_path: Path
) -> None:
    path = tmp_path / "mine.yaml"
    path.write_text(OWN.replace(*change))
    run = Run({"drivetrain": str(path), **settings}, True, tmp_path)
    with pytest.raises(InputError, match=words):
        own_bearing(run, Page(), "Stiffness", moments=True)


def test_settings_of_a_bearing_need_a_drivetrain(tmp_path: Path) -> None:
    assert own_bearing(Run({}, True, tmp_path), Page(), "Stiffness") is None
    with pytest.raises(InputError, match=re.escape("give drivetrain=FILE, too")):
        own_bearing(Run({"bearing": "front"}, True, tmp_path), Page(), "Stiffness")
    with pytest.raises(InputError, match=re.escape("does not state shaft.sections")):
        own_bearing(Run({"drivetrain": "park_2021"}, True, tmp_path), Page(), "Stiffness")
