"""Solids under prescribed forces and displacements, and their stresses."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.elasticity.interfaces.constraints import (
    dofs,
    fixed,
    held_nodes,
    rigid_face,
    rigid_point,
)
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.operator.loads import traction_loads
from fe_drivetrain.elasticity.operator.stress import nodal_stresses, principal, tensor, von_mises
from fe_drivetrain.elasticity.solve.solid import solve_solid

E, NU = 3.0, 0.25
LAME = (E * NU / ((1 + NU) * (1 - 2 * NU)), E / (2 * (1 + NU)))
KINDS = (4, 10, 8, 20, 27)


def bar(nodes=27, divisions=(4, 2, 2)):
    return brick(divisions, nodes, lambda p: p * [4.0, 1.0, 1.0])


def symmetry(block, n):
    return [
        held_nodes(f"{axis}0", block.face_nodes(f"{axis}0"), [k], n) for k, axis in enumerate("xyz")
    ]


@pytest.mark.parametrize("nodes", KINDS)
def test_bar_in_tension(nodes):
    """u = (s/E) (x, -nu y, -nu z), and the supports carry the force."""
    block = bar(nodes)
    n = block.points.size
    F = traction_loads(block.points, block.faces["x1"], np.array([0.6, 0.0, 0.0]))
    static = solve_solid(block.points, block.cells, LAME, symmetry(block, n), F)
    exact = 0.6 / E * block.points * [1.0, -NU, -NU]
    np.testing.assert_allclose(static.u.reshape(-1, 3), exact, atol=1e-9)
    assert static.reactions["x0"].sum() == pytest.approx(-0.6, rel=1e-9)
    assert static.energy[0] == pytest.approx(0.5 * 0.6**2 / E * 4.0, rel=1e-9)
    s = nodal_stresses(block.points, block.cells, static.u[:, 0], LAME)
    np.testing.assert_allclose(s, np.outer(np.ones(len(s)), [0.6, 0, 0, 0, 0, 0]), atol=1e-8)
    np.testing.assert_allclose(von_mises(s), 0.6, atol=1e-8)


@pytest.mark.parametrize("nodes", [10, 20, 27])
def test_stress_of_bending_is_linear_at_the_nodes(nodes):
    """Prescribed displacements of pure bending: the recovered stress is its exact field."""
    block = bar(nodes)
    x, y, z = block.points.T
    u = np.column_stack([x * z, -NU * y * z, -(x**2 + NU * (z**2 - y**2)) / 2.0])
    s = nodal_stresses(block.points, block.cells, u.ravel(), LAME)
    np.testing.assert_allclose(s[:, 0], E * z, atol=1e-12)
    np.testing.assert_allclose(s[:, 1:], 0.0, atol=1e-12)


def test_prescribed_displacements_and_forces_are_one_problem():
    """Pulling with a force, then prescribing what it displaced: the force comes back."""
    block = bar()
    n = block.points.size
    end = block.face_nodes("x1")
    base = fixed("base", block.face_nodes("x0"), n)
    F = traction_loads(block.points, block.faces["x1"], np.array([0.1, 0.0, 0.3]))
    pulled = solve_solid(block.points, block.cells, LAME, [base], F)
    columns = dofs(end).ravel()
    again = solve_solid(
        block.points, block.cells, LAME, [base], np.zeros(n), (columns, pulled.u[columns])
    )
    np.testing.assert_allclose(again.u, pulled.u, atol=1e-8)
    np.testing.assert_allclose(again.reactions["prescribed"][columns, 0], F[columns], atol=1e-7)


def test_motion_of_a_reference_point_is_prescribed():
    """A rigid end turned and moved as the whole bar: no energy."""
    block = bar()
    n = block.points.size + 6
    point = rigid_point("end", np.array([4.0, 0.5, 0.5]), n - 6, n)
    ends = [rigid_face("end", block.face_nodes("x1"), block.points, point)]
    held = block.face_nodes("x0")
    motion = rigid_motions(block.points[held], point.position)
    columns = np.concatenate([dofs(held).ravel(), np.arange(n - 6, n)])
    values = np.vstack([motion, np.eye(6)])
    static = solve_solid(block.points, block.cells, LAME, ends, np.zeros((n, 6)), (columns, values))
    np.testing.assert_allclose(
        static.u[: n - 6], rigid_motions(block.points, point.position), atol=1e-8
    )
    assert np.abs(static.energy).max() < 1e-12


def test_two_materials_in_series():
    """1/k = L1/(E1 A) + L2/(E2 A), with nu = 0 for no lateral strain."""
    block = brick((4, 1, 1), 27, lambda p: p * [2.0, 1.0, 1.0])
    n = block.points.size
    near = block.points[block.cells].mean(axis=1)[:, 0] < 1.0
    parts = [(block.cells[near], (0.0, 0.5)), (block.cells[~near], (0.0, 2.0))]
    F = traction_loads(block.points, block.faces["x1"], np.array([1.0, 0.0, 0.0]))
    static = solve_solid(block.points, parts, None, symmetry(block, n), F)
    assert F @ static.u[:, 0] == pytest.approx(1.0 / 1.0 + 1.0 / 4.0, rel=1e-9)


def test_principal_stresses_do_not_turn_with_the_frame(rng):
    s = rng.standard_normal((5, 6))
    turn = np.linalg.qr(rng.standard_normal((3, 3)))[0]
    turned = turn @ tensor(s) @ turn.T
    np.testing.assert_allclose(np.linalg.eigvalsh(turned), principal(s), atol=1e-13)
    deviator = tensor(s) - np.trace(tensor(s), axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3)
    np.testing.assert_allclose(
        von_mises(s), np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2))), rtol=1e-13
    )


def test_an_element_without_volume_is_said() -> None:
    block = brick((2, 2, 2), nodes=4)
    points = block.points.copy()
    corners = block.cells[0]
    points[corners[3]] = points[corners[:3]].mean(axis=0)
    n = points.size
    held = fixed("x0", block.face_nodes("x0"), n)
    F = np.zeros((n, 1))
    F[3 * block.face_nodes("x1") + 2] = 1.0
    with pytest.raises(InputError, match="is folded over, flat or turned inside out"):
        solve_solid(points, block.cells, (1.2e11, 8e10), [held], F, method="multigrid")
