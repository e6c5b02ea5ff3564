"""Chapter 3 of a thesis on two housings: when its statements hold, and whose scene it is."""

from pathlib import Path

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.cases.main_bearing import bearing_scenes, calibrated
from fe_drivetrain.cases.main_bearing.calibrated import Errors, conclusions, statements
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.closed_forms import ForceComparison

AS_PRINTED = Errors((22.74, 0.7781), (1.0, 0.9999), (1.61, 0.9996), 1.3, {"thrust": 0.1})
WORSE = Errors((5.0, 0.95), (2.5, 0.9999), (3.0, 0.9991), 1.02, {"thrust": 0.2})


def test_statements_hold_where_the_numbers_are_as_printed() -> None:
    said = statements({"generic": AS_PRINTED, "calibrated": WORSE})
    assert all(of["generic"][1] for _, of in said)
    assert not any(of["calibrated"][1] for _, of in said)
    rows = conclusions({"generic": AS_PRINTED, "calibrated": WORSE})
    assert {row["conclusion"]: row["thesis"] for row in rows if row["thesis"] is not None} == {
        "pinned beam: mean error [%]": 22.74,
        "pinned beam: correlation": 0.7781,
        "torsional springs, K_R by four nodes: mean error [%]": 1.61,
        "torsional springs, K_R by four nodes: correlation": 0.9996,
        "torsional springs, K_R by the averaged seat: mean error [%]": 1.61,
        "how many times smaller springs make the error": pytest.approx(14.12, abs=0.01),
    }
    for row in rows:  # ours as the thesis's where they are its numbers
        if row["thesis"] is not None and "averaged seat" not in str(row["conclusion"]):
            assert row["generic"] == pytest.approx(row["thesis"])


def test_another_scene_has_no_calibrated_one_beside_it(tmp_path: Path) -> None:
    own = calibrated.scene_beside(Run({"solver": "superlu"}, False, tmp_path))
    assert own == library_scene("main_bearing_calibrated")
    for settings in ({"gearbox.weight": 4e5}, {"drivetrain": "main_bearing_spherical"}):
        assert calibrated.scene_beside(Run(settings, False, tmp_path)) is None


def test_a_drivetrain_takes_the_place_of_the_scene(tmp_path: Path) -> None:
    page = Page()
    run = Run({"drivetrain": "main_bearing_calibrated", "gearbox.weight": 4e5}, False, tmp_path)
    scene = bearing_scenes.scene_of(run, page, "bonded")
    assert scene.bearing_units[0].bearing.width == 0.1382
    assert scene.gearbox.weight == 4e5
    assert page.subject == scene.title
    for name, words in (
        ("two_bearings", "2 bearing units"),
        ("park_2021", r"does not state shaft\.sections"),
    ):
        with pytest.raises(InputError, match=words):
            bearing_scenes.scene_of(Run({"drivetrain": name}, False, tmp_path), page, "bonded")


def test_errors_are_those_of_beams_against_the_solids(tmp_path: Path) -> None:
    scene = coarse_scene("bonded")
    run = Run({}, False, tmp_path)
    housed = calibrated.Housed(
        bearing_scenes.solve(run, scene, "coarse"),
        bearing_scenes.solve_seat(run, scene, "coarse, no gearbox"),
        calibrated.bands.Series(({},)),
    )
    loads = np.zeros((1, 50, 6))
    phase = np.linspace(0.0, 6.0, 50)
    loads[0, :, 2] = -3.8e5 + 3e4 * np.sin(phase)
    loads[0, :, 4] = 3e5 * np.cos(phase)
    found = calibrated.errors_of(loads, ForceComparison(list(loads)), housed)
    assert found.pinned_band is None  # of one mesh
    assert 0.0 < found.sprung[0] < found.pinned[0]
    # neither thrust nor torque is there
    assert found.without == pytest.approx(dict.fromkeys(found.without, found.sprung[0]))
    assert housed.solved is not None
    whole = np.hstack([loads[0], np.tile([0.0, 0.0, 0.0, scene.gearbox.weight], (50, 1))])
    force = whole @ housed.solved.response.reactions[housed.solved.bearing].T
    front, place = scene.shaft.front, scene.bearing_units[0].bearing.x
    span = front + sum(section.length for section in scene.shaft.sections) - place
    arm = place - front
    pinned = loads[0, :, 2] * (1.0 + arm / span) + loads[0, :, 4] / span
    exact = np.abs(pinned).mean() / np.hypot(force[:, 1], force[:, 2]).mean()
    assert found.overestimate == pytest.approx(exact, rel=1e-6)
