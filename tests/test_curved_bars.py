"""A curved bar as a solid under the exact tractions of its ends."""

import numpy as np
import pytest

from fe_drivetrain.scene.materials import Material
from fe_drivetrain.validation.curved_bars import bent_and_pulled, missed_at_surface
from fe_drivetrain.validation.plane_rings import CurvedBar, plane_strain


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
    assert missed_at_surface(lambda r: 3.0 * r**2, 2.0, 0.1, 1e-3) == pytest.approx(
        6.0 * 0.01 / 12.0
    )
