"""Shafts that a table implies, and their torsion by finite elements."""

import pytest

from fe_drivetrain.cases.references.implied_shafts import (
    DAMPING_RATIO,
    SHEAR_MODULUS,
    diameter,
    implied,
)
from fe_drivetrain.cases.references.shaft_theory import polar_moment
from fe_drivetrain.cases.references.solid_shafts import stepped
from fe_drivetrain.cases.references.torsion_meridian import (
    added_length,
    series_stiffness,
    torsion_bounds,
)
from fe_drivetrain.cases.references.twisted_tubes import material_of, twisted_step, twisted_tube


def test_an_implied_shaft_has_the_stiffness_and_damping_that_it_was_made_of() -> None:
    shaft = implied(3.69e7, 2.396e5)
    stiffness = SHEAR_MODULUS * polar_moment(shaft.diameter) / shaft.length
    assert stiffness == pytest.approx(3.69e7)
    assert 2 * DAMPING_RATIO * (stiffness * shaft.polar) ** 0.5 == pytest.approx(2.396e5)
    assert diameter(stiffness, shaft.length) == pytest.approx(shaft.diameter)


def test_a_twisted_tube_is_softer_than_the_circle_by_what_parabolas_leave_out() -> None:
    found = twisted_tube(1.0, 0.8, 2.0, 80e9, quick=True)
    closed = 80e9 * polar_moment(1.0, 0.8) / 2.0
    assert found.stiffness / closed - 1 == pytest.approx(-found.tolerance / 2, rel=0.1)


def test_a_step_adds_length_that_the_series_does_not_have() -> None:
    shaft = stepped((0.6, 0.4), 0.6, 0.2)
    assert added_length(shaft, 80e9, series_stiffness(shaft, 80e9)) == pytest.approx(0.0, abs=1e-12)
    # twice as compliant as the thin part alone: all of it again, and what the thick part twists
    thin, thick = (80e9 * polar_moment(d, 0.2) / 0.6 for d in (0.4, 0.6))
    assert added_length(shaft, 80e9, thin / 2) == pytest.approx((1 - thin / thick) * 0.6 / 0.4)


def test_a_twisted_step_lies_where_the_meridian_bounds_it() -> None:
    found = twisted_step((0.6, 0.4), 0.6, 0.2, material_of(80e9), (1, 2))
    bounds = torsion_bounds(stepped((0.6, 0.4), 0.6, 0.2), 80e9, 0.1, 4)
    assert found.stiffness == pytest.approx(bounds.middle, rel=found.tolerance)
    assert found.stiffness - found.band < bounds.upper
