"""Shutdowns of a user's drivetrain: its own brake counts, with the time in which it grows."""

from pathlib import Path

import pytest

from fe_drivetrain.cases.dynamics.drivetrains import Rated, own_or_published
from fe_drivetrain.cases.dynamics.shutdown_runs import SEQUENCE, stop
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run

OWN = """
title: Turbine of a user
rotor: {inertia: 5.0e5}
shaft: {name: slow, torsion: 3.0e7}
gearbox:
  stages:
    - {kind: parallel, teeth: {gear: 88, pinion: 22}, stiffness_of: axis, gear: {inertia: 20},
       pinion: {inertia: 0.3}, stiffness: 5.0e7}
  shafts:
    - {name: quick, torsion: 2.0e6}
generator: {inertia: 3000}
operation: {rated_power: 7.5e5, rotor_speed: [1.0, 2.3]}
"""


def rated(brake: str, tmp_path: Path) -> Rated:
    file = tmp_path / "mine.yaml"
    file.write_text(f"{OWN}brake: {brake}\n", "utf-8")
    (found,) = own_or_published(Run({"drivetrain": str(file)}, True, tmp_path), Page())
    return found


def test_a_brake_grows_as_the_file_states(tmp_path: Path) -> None:
    at_once = stop(rated("{shaft: quick, torque: 2.0e5}", tmp_path), 2e-3)
    slowly = stop(rated("{shaft: quick, torque: 2.0e5, rise: 1.0}", tmp_path), 2e-3)
    assert at_once.brake == slowly.brake == pytest.approx(2e5 * 4 / (7.5e5 / 2.3))
    grows = slowly.done.motion
    for since in (0.25, 0.5, 1.0):
        step = int((SEQUENCE.braked + since) / 2e-3)
        torque = abs(grows.braking.torque[step - 1, 0])
        assert torque == pytest.approx(2e5 * since, rel=0.01)
    assert slowly.stops > at_once.stops + 0.3


def test_a_brake_that_does_not_stop_the_drivetrain_is_refused(tmp_path: Path) -> None:
    weak = rated("{shaft: quick, torque: 2.0e4, rise: 40}", tmp_path)
    with pytest.raises(InputError, match="grows in 40 s, and does not stop"):
        stop(weak, 1e-2)
