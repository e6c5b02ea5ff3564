"""Shafts that a table implies, and their torsion by finite elements."""

import pytest

from fe_drivetrain.validation.implied_shafts import DAMPING_RATIO, SHEAR_MODULUS, implied
from fe_drivetrain.validation.shaft_theory import polar_moment
from fe_drivetrain.validation.twisted_tubes import twisted_tube


def test_an_implied_shaft_has_the_stiffness_and_damping_that_it_was_made_of() -> None:
    shaft = implied(3.69e7, 2.396e5)
    stiffness = SHEAR_MODULUS * polar_moment(shaft.diameter) / shaft.length
    assert stiffness == pytest.approx(3.69e7)
    assert 2 * DAMPING_RATIO * (stiffness * shaft.polar) ** 0.5 == pytest.approx(2.396e5)


def test_a_twisted_tube_is_softer_than_the_circle_by_what_parabolas_leave_out() -> None:
    found = twisted_tube(1.0, 0.8, 2.0, 80e9, quick=True)
    closed = 80e9 * polar_moment(1.0, 0.8) / 2.0
    assert found.stiffness / closed - 1 == pytest.approx(-found.tolerance / 2, rel=0.1)
