"""The plane bracket: its shape, and the beam that its leg is."""

import numpy as np
import pytest
from scipy.integrate import trapezoid

from fe_drivetrain.cases.verification.bracket_plane import Bracket, plane_answer
from fe_drivetrain.drivetrain_file.materials import Material

BRACKET = Bracket(fillet=0.5, height=1.0, arm=3.0, leg=2.0)
SOFT = Material(youngs_modulus=2e6, poisson_ratio=0.3, density=0.0)


def test_shape_is_continuous_and_as_long_as_its_parts():
    along = np.linspace(0.0, 1.0, 4001)
    for share, radius in ((0.0, 0.5), (0.5, 1.0), (1.0, 1.5)):
        line = BRACKET.place(np.full_like(along, share), along)
        length = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
        assert length == pytest.approx(5.0 + 0.5 * np.pi * radius, rel=1e-5)


def test_shear_on_the_end_carries_the_force():
    z = np.linspace(0.5, 1.5, 2001)
    assert trapezoid(BRACKET.end_shear(z, 7.0), z) == pytest.approx(7.0, rel=1e-6)


def test_energy_goes_with_the_square_of_the_force_and_stress_with_the_force():
    energy, stress = plane_answer(BRACKET, SOFT, 1.0, 2)
    more, higher = plane_answer(BRACKET, SOFT, 3.0, 2)
    assert more == pytest.approx(9.0 * energy, rel=1e-9)
    assert higher == pytest.approx(3.0 * stress, rel=1e-9)


def test_long_arms_make_it_a_frame():
    """Energy of bending alone, P^2 / (2 E' I) (arm^3 / 3 + leg arm^2), when the arms are long."""
    long = Bracket(fillet=0.5, height=1.0, arm=60.0, leg=40.0)
    E, nu = SOFT.youngs_modulus, SOFT.poisson_ratio
    reach = np.linspace(0.0, 60.0, 20001)
    corner = 0.5 * np.pi
    along = trapezoid(reach**2, reach)
    frame = 12.0 * (1.0 - nu**2) / (2.0 * E) * (along + corner * 61.0**2 + 40.0 * 61.0**2)
    energy, _ = plane_answer(long, SOFT, 1.0, 1)
    assert energy == pytest.approx(frame, rel=0.01)
