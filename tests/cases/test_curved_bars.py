"""A curved bar as a solid under the exact tractions of its ends."""

import numpy as np
import pytest

from fe_drivetrain.cases.references.loaded_blocks import within_surface
from fe_drivetrain.cases.references.plane_rings import CurvedBar, plane_strain
from fe_drivetrain.cases.verification.curved_bars import bent_and_pulled, curvature_of
from fe_drivetrain.drivetrain_file.materials import Material


def test_a_bent_and_pulled_bar_turns_and_stores_what_theory_says():
    bar, steel = CurvedBar(0.1, 0.2), Material(youngs_modulus=2e11, poisson_ratio=0.3, density=0.0)
    plane = plane_strain(2e11, 0.3)
    found = bent_and_pulled(bar, steel, 1e4, 1e5, 3)
    rotation = abs(bar.bending_rotation(1e4, plane)) * 0.5 * np.pi
    assert found.rotation == pytest.approx(rotation, rel=5e-3)
    # the moments do the work, half of moment times rotation
    assert found.bent.energy / found.width == pytest.approx(0.5e4 * found.rotation, rel=5e-3)
    energy = bar.end_force_energy(1e5, 0.5 * np.pi, plane)
    assert found.pulled.energy / found.width == pytest.approx(energy, rel=5e-3)
    # nothing but the tractions loads the bar: what holds it under the force carries none
    held = found.pulled.static.reactions["supports"]
    assert np.abs(held).max() < 1e-3 * 1e5 * found.width


def test_a_parabola_misses_a_twelfth_of_its_second_derivative():
    """At the end of an element of height h, of the line through its two Gauss points."""
    second, h = curvature_of(lambda r: 3.0 * r**2, 2.0, 1e-3), 0.1
    gauss = 2.0 + 0.5 * h * (1.0 + np.array([-1.0, 1.0]) / np.sqrt(3.0))
    line = np.polynomial.Polynomial.fit(gauss, 3.0 * gauss**2, 1)
    within, why = within_surface(second, h)
    assert second == pytest.approx(6.0)
    # the line through the points of a parabola 3 r^2 is wrong by 3 (h / 2)^2 (1 - 1/3)
    assert within == pytest.approx(4.0 * 6.0 * h**2 / 12.0)
    assert abs(line(2.0) - 12.0) <= within
    assert "0.005 MPa" in why
