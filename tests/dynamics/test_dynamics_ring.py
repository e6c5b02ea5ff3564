"""A ring gear that bends: free rings, thin-ring statics, and its limits in a planetary stage."""

import numpy as np
import pytest

from fe_drivetrain.cases.references.published_planetary import (
    LIN_PARKER_STAGE,
    plane_stage,
    plane_supports,
    plane_system,
)
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.dynamics.bodies.bodies import assemble
from fe_drivetrain.dynamics.bodies.elastic_ring import Rim, with_rim
from fe_drivetrain.dynamics.bodies.modes import distinct, system_modes
from fe_drivetrain.dynamics.bodies.planetary import bodies_of, springs_of
from fe_drivetrain.dynamics.bodies.system import System

STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=7850.0)
HARMONICS = tuple(range(2, 12))


def rim(thickness: float) -> Rim:
    stage = plane_stage(LIN_PARKER_STAGE, 3)
    teeth = stage.centre_distance + stage.planet_ring_radius
    return Rim(teeth + thickness / 2, thickness, 0.03, STEEL)


def elastic(planets: int, thickness: float) -> System:
    stage = plane_stage(LIN_PARKER_STAGE, planets)
    coordinates, springs = with_rim(stage, springs_of(stage), rim(thickness), HARMONICS)
    springs += plane_supports(LIN_PARKER_STAGE, stage)
    return assemble([*bodies_of(stage), *coordinates], springs)


def test_a_free_ring() -> None:
    ring = rim(0.01)
    area, inertia = 0.03 * 0.01, 0.03 * 0.01**3 / 12
    for n in (2, 3, 5):
        w2 = 210e9 * inertia / (7850 * area * ring.radius**4)
        exact = np.sqrt(w2 * n**2 * (n**2 - 1) ** 2 / (n**2 + 1)) / (2 * np.pi)
        assert ring.frequency(n) == pytest.approx(exact, rel=1e-14)


def test_a_ring_squeezed_across_its_diameter() -> None:
    ring, load = rim(0.01), 1000.0
    w = sum(2 * load / ring.stiffness(n) for n in range(2, 400, 2))
    inertia = 0.03 * 0.01**3 / 12
    exact = load * ring.radius**3 / (210e9 * inertia) * (np.pi / 4 - 2 / np.pi)
    assert 2 * w == pytest.approx(exact, rel=1e-6)


def test_the_first_harmonic_would_be_a_translation() -> None:
    # n = 1 has no bending, and moves every radius equally along y
    ring = rim(0.02)
    assert ring.stiffness(1) == 0.0
    for radius in (0.9 * ring.radius, ring.radius):
        radial, tangential = ring.motion(1, 0.4, radius)[:, 0]
        assert (radial, tangential) == pytest.approx((np.cos(0.4), -np.sin(0.4)))


def test_a_rim_that_does_not_give_is_the_rigid_ring() -> None:
    rigid = system_modes(plane_system(LIN_PARKER_STAGE, 3)).frequencies
    stage = plane_stage(LIN_PARKER_STAGE, 3)
    hard = Rim(0.15, 0.02, 0.03, STEEL, radial=1e16)
    coordinates, springs = with_rim(stage, springs_of(stage), hard, (2, 3, 4))
    springs += plane_supports(LIN_PARKER_STAGE, stage)
    found = system_modes(assemble([*bodies_of(stage), *coordinates], springs)).frequencies
    assert np.allclose(found[1 : len(rigid)], rigid[1:], rtol=1e-5)


@pytest.mark.parametrize(("planets", "singles", "pairs"), [(3, 12, 13), (4, 19, 11)])
def test_a_thinner_rim_is_softer_and_keeps_the_symmetry(
    planets: int, singles: int, pairs: int
) -> None:
    # of N planets, harmonics that are a multiple of N join the rotational modes, those that are
    # one more or less than a multiple the pairs; with four planets, the others the planet modes
    thick, thin = (system_modes(elastic(planets, t)).frequencies for t in (0.03, 0.02))
    assert thin[1] < thick[1]
    counts = [count for _, count in distinct(thin, 1e-7)]
    assert (counts.count(1), counts.count(2), max(counts)) == (singles, pairs, 2)


def test_the_rim_stands_still_in_the_free_turn() -> None:
    one = elastic(3, 0.02)
    shape = system_modes(one).shapes[:, 0]
    turned = [k for k, name in enumerate(one.names) if "rim" in name]
    assert np.abs(shape[turned]).max() < 1e-6 * np.abs(shape).max()
