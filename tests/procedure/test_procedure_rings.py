"""Shapes of rings of constant length: strains, diameters, thin rings under forces, fits."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.ring_shapes import (
    GAUGES,
    RingShape,
    fitted_shape,
    ring_under_forces,
)

RADIUS, OUTSIDE = 1.0, 0.05
ROUND = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
SHAPE = RingShape(RADIUS, np.array([2, 3]), np.array([1e-3, 2e-4]), np.array([3e-4, -1e-4]))


def test_an_oval_has_opposite_diameters_and_the_strain_of_its_curvature() -> None:
    oval = RingShape(RADIUS, np.array([2]), np.array([1e-3]), np.zeros(1))
    assert oval.diameter([0.0, np.pi / 2]) == pytest.approx([2e-3, -2e-3])
    assert oval.tangential(ROUND) == pytest.approx(-0.5e-3 * np.sin(2 * ROUND))
    assert oval.strain(ROUND, OUTSIDE) == pytest.approx(3 * OUTSIDE * 1e-3 * np.cos(2 * ROUND))


def test_a_ring_keeps_its_length_and_strains_have_no_mean() -> None:
    step = 1e-4
    stretch = (SHAPE.tangential(ROUND + step) - SHAPE.tangential(ROUND - step)) / (2 * step)
    assert np.abs(stretch + SHAPE.radial(ROUND)).max() < 1e-10
    assert abs(SHAPE.strain(ROUND, OUTSIDE).mean()) < 1e-18
    # a fibre outside of the neutral line is longer by c over R times the turning of the section
    bending = SHAPE.radial(ROUND + step) - 2 * SHAPE.radial(ROUND) + SHAPE.radial(ROUND - step)
    curvature = -(SHAPE.radial(ROUND) + bending / step**2) / RADIUS**2
    assert SHAPE.strain(ROUND, OUTSIDE) == pytest.approx(OUTSIDE * curvature, abs=1e-9)


def test_a_ring_pulled_at_two_ends_is_the_textbooks() -> None:
    force, bending = 1e4, 1e6
    pulled = ring_under_forces(RADIUS, bending, [0.0, np.pi], [force, force])
    along, across = pulled.diameter([0.0, np.pi / 2]) * bending / (force * RADIUS**3)
    assert along == pytest.approx(np.pi / 4 - 2 / np.pi, rel=1e-5)
    assert across == pytest.approx(-(2 / np.pi - 1 / 2), rel=1e-5)
    energy = 0.5 * force * (pulled.radial(0.0) + pulled.radial(np.pi))
    kappa = pulled.strain(ROUND, 1.0)
    assert 0.5 * bending * np.mean(kappa**2) * 2 * np.pi * RADIUS == pytest.approx(energy, rel=1e-3)


def test_strains_at_gauges_give_the_shape_back() -> None:
    angles = np.linspace(0.0, 2 * np.pi, 8, endpoint=False) + 0.1
    found = fitted_shape(RADIUS, OUTSIDE, angles, SHAPE.strain(angles, OUTSIDE) + 5e-5, [2, 3])
    assert found.shape.cosine == pytest.approx(SHAPE.cosine)
    assert found.shape.sine == pytest.approx(SHAPE.sine)
    assert found.offset == pytest.approx(5e-5)
    assert found.residual < 1e-15
    assert found.condition < 1.5


def test_gauges_on_one_half_tell_waves_apart_worse_than_gauges_all_round() -> None:
    even = np.linspace(0.0, 2 * np.pi, 8, endpoint=False)
    conditions = [
        fitted_shape(RADIUS, OUTSIDE, at, np.zeros(8), [2, 3]).condition for at in (GAUGES, even)
    ]
    assert conditions[0] > 1.5 * conditions[1]


def test_faults_are_sentences() -> None:
    with pytest.raises(InputError, match="orders from 2"):
        RingShape(1.0, np.array([1]), np.ones(1), np.ones(1))
    with pytest.raises(InputError, match="apart"):
        fitted_shape(1.0, 0.05, [0.0, 1.0], [0.0, 0.0], [2])
    with pytest.raises(InputError, match="bending"):
        ring_under_forces(1.0, 0.0, [0.0], [1.0])
