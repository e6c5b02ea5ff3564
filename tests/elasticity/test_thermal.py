"""Free strains by temperature: what expands freely has no stress, what is held that of theory."""

import numpy as np
import pytest

from fe_drivetrain.elasticity.interfaces.constraints import held_dofs
from fe_drivetrain.elasticity.mesh import brick
from fe_drivetrain.elasticity.operator import nodal_stresses, thermal_loads
from fe_drivetrain.elasticity.solve import solve_solid

E, NU = 200e9, 0.3
LAME = (E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU)))


def bent(unit: np.ndarray) -> np.ndarray:
    """A block whose elements are not cubes."""
    x, y, z = unit.T
    return np.column_stack([x + 0.1 * y * z, y + 0.1 * x**2, 1.2 * z + 0.05 * x * y])


@pytest.mark.parametrize("nodes", [8, 10, 20, 27])
def test_a_free_solid_expands_without_stress(nodes: int) -> None:
    """A linear field of temperature with three supports strains a free solid of any shape alone."""
    block = brick((2, 2, 2), nodes, bent)
    free = np.full(len(block.points), 1e-3)
    if nodes in (20, 27, 10):
        free = free + 2e-4 * block.points[:, 0]
    F = thermal_loads(block.points, block.cells, LAME, free)
    moments = np.cross(block.points, F.reshape(-1, 3)).sum(axis=0)
    assert np.abs(F.reshape(-1, 3).sum(axis=0)).max() < 1e-6 * np.abs(F).max()
    assert np.abs(moments).max() < 1e-6 * np.abs(F).max()
    corner = np.argmin(np.linalg.norm(block.points - block.points.min(axis=0), axis=1))
    along = np.argmax(block.points[:, 0] - np.abs(block.points[:, 1:]).sum(axis=1))
    across = np.argmax(block.points[:, 1] - np.abs(block.points[:, [0, 2]]).sum(axis=1))
    held = [
        3 * corner,
        3 * corner + 1,
        3 * corner + 2,
        3 * along + 1,
        3 * along + 2,
        3 * across + 2,
    ]
    static = solve_solid(
        block.points, block.cells, LAME, [held_dofs("held", held, block.points.size)], F
    )
    u = static.u[: block.points.size, 0]
    stress = nodal_stresses(block.points, block.cells, u, LAME, free)
    # against that of the same strain if it were held; hexahedra of 20 nodes that are no cubes have
    # no quadratic displacements exactly
    whole = E * 1e-3 / (1 - 2 * NU)
    assert (
        np.abs(stress).max()
        < (1e-2 if nodes == 20 else 5e-3 if nodes in (10, 27) else 1e-9) * whole
    )


def test_held_on_all_sides_it_has_the_pressure_of_theory() -> None:
    """sigma = -E e / (1 - 2 nu), and uniaxially -E e."""
    block = brick((2, 1, 1), 27)
    free = np.full(len(block.points), 1e-4)
    F = thermal_loads(block.points, block.cells, LAME, free)
    everywhere = held_dofs("held", np.arange(block.points.size), block.points.size)
    static = solve_solid(block.points, block.cells, LAME, [everywhere], F)
    u = static.u[: block.points.size, 0]
    stress = nodal_stresses(block.points, block.cells, u, LAME, free)
    assert stress[:, :3] == pytest.approx(-E * 1e-4 / (1 - 2 * NU))
    ends = np.concatenate([3 * block.face_nodes("x0"), 3 * block.face_nodes("x1")])
    more = [3 * block.face_nodes("y0") + 1, 3 * block.face_nodes("z0") + 2]
    held = held_dofs("held", np.concatenate([ends, *more]), block.points.size)
    static = solve_solid(block.points, block.cells, LAME, [held], F)
    u = static.u[: block.points.size, 0]
    stress = nodal_stresses(block.points, block.cells, u, LAME, free)
    assert stress[:, 0] == pytest.approx(-E * 1e-4)
    assert np.abs(stress[:, 1:]).max() < 1e-6 * E * 1e-4
