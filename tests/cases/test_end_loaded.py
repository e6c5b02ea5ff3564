"""Shafts with loaded ends, a ring pressed on a shaft, bent blocks: exact answers of test solids."""

import numpy as np
import pytest

from fe_drivetrain.cases.references import end_loaded, solid_shafts
from fe_drivetrain.cases.references.interference_fits import exact_fit, press
from fe_drivetrain.cases.verification.bent_blocks import BentBlock
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.materials import Material

STEEL = Material(youngs_modulus=200e9, poisson_ratio=0.3, density=0.0)


@pytest.fixture(scope="module")
def shaft() -> solid_shafts.Solid:
    return solid_shafts.solid(solid_shafts.straight((0.0, 0.3, 0.6), 0.4), 1, size=0.6)


def test_uniform_tension_stretches_a_shaft_by_hooke(shaft: solid_shafts.Solid) -> None:
    def tension(positions: Floats, normals: Floats) -> Floats:
        return 1e6 * normals * [1.0, 0.0, 0.0]

    exact = 1e6 / 200e9 * shaft.points * [1.0, -0.3, -0.3]
    front, rear = end_loaded.end_forces(shaft, tension)
    force = 1e6 * end_loaded.section_area(shaft, 0.0)
    assert rear.reshape(-1, 3).sum(axis=0) == pytest.approx([force, 0.0, 0.0], abs=1e-6)
    found = end_loaded.solve_loaded(shaft, STEEL, front + rear, like=exact)
    assert found.error(exact) < 1e-9
    assert found.stress[:, 0] == pytest.approx(np.full(len(shaft.points), 1e6), rel=1e-7)
    mean, slope = found.means(0.6)
    assert mean == pytest.approx([0.6 * 1e6 / 200e9, 0.0, 0.0], abs=1e-9 * 0.6 * 1e6 / 200e9)
    assert slope == pytest.approx(0.0, abs=1e-12)


def test_forces_are_balanced_at_the_front(shaft: solid_shafts.Solid) -> None:
    F = np.zeros(shaft.n_unknowns)
    F[3 * shaft.section_nodes(0.6)[0] + 2] = 5.0
    left = solid_shafts.resultant(shaft.points, end_loaded.balanced(shaft, F))
    assert left == pytest.approx(np.zeros(6), abs=1e-9)


def test_a_rigid_end_is_as_stiff_as_its_reciprocal_says(shaft: solid_shafts.Solid) -> None:
    K = end_loaded.between_rigid_ends(shaft, STEEL, [2, 4])
    assert K[0, 1] == pytest.approx(K[1, 0], rel=1e-9)
    assert np.linalg.eigvalsh(K).min() > 0.0
    # a stretched shaft between rigid ends is stiffer than one that may contract
    (axial,) = end_loaded.between_rigid_ends(shaft, STEEL, [0]).ravel()
    assert axial > 200e9 * end_loaded.section_area(shaft, 0.0) / 0.6


def test_the_skin_is_the_outermost_ring_of_nodes(shaft: solid_shafts.Solid) -> None:
    skin = shaft.points[end_loaded.skin_nodes(shaft, 0.3)]
    assert skin[:, 0] == pytest.approx(0.3)
    assert np.hypot(skin[:, 1], skin[:, 2]) == pytest.approx(0.2)


def test_a_ring_is_pressed_on_as_two_cylinders_of_lame() -> None:
    radii, misfit = (0.15, 0.3175, 0.348), 1e-4
    iron = Material(youngs_modulus=169e9, poisson_ratio=0.275, density=0.0)
    materials = iron, STEEL
    found, exact = press(radii, misfit, materials, 1), exact_fit(radii, misfit, materials)
    assert exact.ring_moved - exact.shaft_moved == pytest.approx(misfit)
    assert exact.ring.radial(0.3175) == pytest.approx(-exact.pressure)
    assert found.pressure == pytest.approx(exact.pressure, rel=1e-3)
    assert found.ring_moved - found.shaft_moved == pytest.approx(misfit, rel=1e-9)
    assert found.energy == pytest.approx(exact.energy, rel=1e-3)


def test_shear_and_bending_of_a_block_store_what_the_closed_forms_say() -> None:
    block = BentBlock(0.6, 0.2, 0.15, STEEL)
    for field, energy in (
        (lambda p: block.sheared(p, 1e-3), block.shear_energy(1e-3)),
        (lambda p: block.bent(p, 1e-3), block.bending_energy(1e-3)),
    ):
        assert block.displaced_energy(20, field) == pytest.approx(energy, rel=1e-9)
    missed = block.cantilever_energy(27, 2, 1e6) / block.flexure_energy(1e6) - 1.0
    assert -0.01 < missed < 0.0
