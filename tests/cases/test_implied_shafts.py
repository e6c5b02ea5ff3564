"""Solid shafts that stand for tabled stiffnesses."""

import numpy as np
import pytest

from fe_drivetrain.cases.references import published_drivetrains
from fe_drivetrain.cases.references.implied_shafts import SHEAR_MODULUS, of_stiffness
from fe_drivetrain.cases.references.shaft_theory import polar_moment


@pytest.mark.parametrize("letter", list(published_drivetrains.RATED))
def test_solid_shafts_have_the_tabled_stiffness_whatever_their_length(letter: str) -> None:
    shafts = of_stiffness(letter, (0.5, 1.0, 2.0))
    table = published_drivetrains.table(published_drivetrains.RATED[letter][0])
    assert list(shafts) == [shaft.name for shaft in table.shafts]
    for tabled in table.shafts:
        for length, diameter in shafts[tabled.name].diameters.items():
            stiffness = SHEAR_MODULUS * polar_moment(diameter) / length
            assert stiffness == pytest.approx(tabled.stiffness, rel=1e-9)


def test_rated_stress_carries_the_rated_power() -> None:
    _, power, rpm = published_drivetrains.RATED["A"]
    slowest = next(iter(of_stiffness("A", (1.0,)).values()))
    torque = slowest.rated_stress * np.pi * slowest.diameters[1.0] ** 3 / 16
    assert torque * rpm * 2 * np.pi / 60 == pytest.approx(power, rel=1e-9)
