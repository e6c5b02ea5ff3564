"""Modes of solids: exact waves, free motions, and what a constraint does to them."""

import numpy as np
import pytest

from fe_drivetrain.cases.references.loaded_blocks import supports
from fe_drivetrain.cases.verification.vibrating_plates import bending_wave, block_modes, thick_plate
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.mesh.blocks import brick

STEEL = Material(youngs_modulus=200e9, poisson_ratio=0.3, density=8000.0)


def test_waves_are_those_of_a_thin_plate_and_of_its_faces_at_the_ends() -> None:
    """Kirchhoff's plate where waves are long, Rayleigh's wave where they are short."""
    k, t = 0.02, 1.0
    D = STEEL.youngs_modulus * t**3 / (12.0 * (1.0 - 0.3**2))
    thin = k**2 * np.sqrt(D / (STEEL.density * t)) / (2.0 * np.pi)
    # rotary inertia and shear are of second order
    assert bending_wave(STEEL, t, k) == pytest.approx(thin, rel=(k * t) ** 2)
    assert thick_plate(STEEL, t, k) == pytest.approx(thin, rel=(k * t) ** 2)
    # Rayleigh's cubic (c / c_T)^2 = x: x^3 - 8 x^2 + 8 x (3 - 2 s) - 16 (1 - s), s = c_T^2 / c_L^2
    s = 0.5 * (1.0 - 2.0 * 0.3) / (1.0 - 0.3)
    x = min(np.roots([1.0, -8.0, 8.0 * (3.0 - 2.0 * s), -16.0 * (1.0 - s)]).real)
    speed = np.sqrt(x * STEEL.shear_modulus / STEEL.density)
    k = 80.0
    assert bending_wave(STEEL, t, k) == pytest.approx(speed * k / (2.0 * np.pi), rel=1e-9)


def test_thick_plates_are_right_to_second_order() -> None:
    """Mindlin's factor is that of the first thickness shear: the theories part with (k t)^2."""
    for k in (0.1, 0.3):
        exact = bending_wave(STEEL, 1.0, k)
        assert thick_plate(STEEL, 1.0, k) == pytest.approx(exact, rel=0.05 * k**2)


def test_a_bar_along_its_axis_has_the_frequencies_of_a_rod() -> None:
    """Held to its axis, nu = 0: f = (2 n - 1) c / (4 L), each mode of unit mass."""
    rod = Material(youngs_modulus=200e9, poisson_ratio=0.0, density=8000.0)
    bar = brick((8, 1, 1), 27, lambda p: p * [3.0, 0.2, 0.2])
    across = (np.arange(len(bar.points)), "yz")
    frequencies, shapes = block_modes(bar, rod, supports(bar, across, x0="x"), 2)
    exact = np.array([1.0, 3.0]) * np.sqrt(200e9 / 8000.0) / (4.0 * 3.0)
    assert frequencies == pytest.approx(exact, rel=2e-4)
    # unit mass of a quarter sine: an amplitude of sqrt(2 / m)
    tip = np.abs(shapes[:, bar.points[:, 0] == 3.0, 0]).max(axis=1)
    assert tip == pytest.approx(np.sqrt(2.0 / (8000.0 * 3.0 * 0.04)), rel=2e-3)


def test_what_moves_freely_has_no_frequency() -> None:
    """A block held along one direction keeps its two translations and a turn about that axis."""
    block = brick((2, 2, 1), 20)
    held = supports(block, z0="z")
    frequencies, shapes = block_modes(block, STEEL, held, 4, 100.0)
    assert frequencies[:3].max() < 1e-3 * frequencies[3]
    assert np.abs(shapes[:, block.face_nodes("z0"), 2]).max() < 1e-12 * np.abs(shapes).max()
