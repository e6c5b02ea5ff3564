"""The elastic operator against scikit-fem's own assembly and against exact fields."""

import numpy as np
import pytest
from skfem import Basis, ElementTetP2, ElementVector, MeshTet, MeshTet2
from skfem.models.elasticity import linear_elasticity

from fe_drivetrain.elasticity import (
    assemble,
    face_weights,
    is_straight,
    rigid_motions,
    volume_weights,
)
from fe_drivetrain.materials import MATERIALS, Material

STEEL = MATERIALS["steel"]


def curved_mesh(amount, rng, refinements=1):
    """A cube of ten-node tetrahedra, its nodes moved at random: really curved elements."""
    mesh = MeshTet2.from_mesh(MeshTet().refined(refinements))
    points = mesh.doflocs.T + amount * rng.uniform(-1, 1, mesh.doflocs.T.shape)
    # VTK order, as the project's meshes have it.
    cells = mesh.dofs.element_dofs.T
    return points, cells


def as_scikit_fem(points, cells):
    return MeshTet2(points.T.copy(), cells.T.copy(), sort_t=False)


@pytest.mark.parametrize("amount", [0.0, 0.02])
def test_equals_scikit_fem(amount, rng):
    points, cells = curved_mesh(amount, rng)
    assert is_straight(points, cells).all() == (amount == 0.0)
    own = assemble(points, cells, STEEL.lame, points.size)

    basis = Basis(as_scikit_fem(points, cells), ElementVector(ElementTetP2()))
    generic = linear_elasticity(*STEEL.lame).assemble(basis)
    # scikit-fem numbers freedoms its own way: match them by element, node and component.
    local = np.empty(basis.element_dofs.shape, dtype=int)
    for k in range(30):
        node, axis = divmod(k, 3)
        local[k] = 3 * cells[:, node] + axis
    number = np.empty(points.size, dtype=int)
    number[basis.element_dofs.ravel()] = local.ravel()
    own = own[number][:, number]
    assert abs(own - generic).max() < 1e-12 * abs(generic).max()


def test_symmetric_and_rigid_motions_are_free(rng):
    points, cells = curved_mesh(0.02, rng)
    K = assemble(points, cells, STEEL.lame, points.size)
    size = abs(K).max()
    assert abs(K - K.T).max() < 1e-14 * size
    assert np.abs(K @ rigid_motions(points)).max() < 1e-13 * size * np.abs(points).max()


def test_constant_strain_energy_is_exact_on_curved_elements(rng):
    """Patch: u = A x has the energy V (lam tr(e)^2 + 2 mu e:e) / 2 on any mesh."""
    points, cells = curved_mesh(0.02, rng)
    material = Material(youngs_modulus=7e9, poisson_ratio=0.2, density=1.0)
    K = assemble(points, cells, material.lame, points.size)
    gradient = rng.standard_normal((3, 3))
    strain = 0.5 * (gradient + gradient.T)
    lam, mu = material.lame
    density = 0.5 * (lam * np.trace(strain) ** 2 + 2 * mu * np.sum(strain**2))
    u = (points @ gradient.T).ravel()
    volume = volume_weights(points, cells, len(points)).sum()
    assert 0.5 * u @ (K @ u) == pytest.approx(density * volume, rel=1e-12)


def test_interior_forces_of_constant_strain_vanish(rng):
    """The patch test proper: no force on a node inside the body, curved faces or not."""
    points, cells = curved_mesh(0.02, rng)
    K = assemble(points, cells, STEEL.lame, points.size)
    mesh = as_scikit_fem(points, cells)
    basis = Basis(mesh, ElementTetP2())
    on_boundary = np.zeros(len(points), dtype=bool)
    boundary = basis.get_dofs().all()
    node_of = np.empty(basis.N, dtype=int)
    node_of[basis.element_dofs.ravel()] = cells.T.ravel()
    on_boundary[node_of[boundary]] = True
    assert (~on_boundary).sum() > 5
    u = (points @ rng.standard_normal((3, 3))).ravel()
    forces = (K @ u).reshape(-1, 3)
    assert np.abs(forces[~on_boundary]).max() < 1e-11 * np.abs(forces).max()


def test_volume_and_face_weights(rng):
    """Weights integrate any field of the elements: here x^2 over the unit cube and a face."""
    points, cells = curved_mesh(0.0, rng)
    weights = volume_weights(points, cells, len(points))
    assert weights @ np.ones(len(points)) == pytest.approx(1.0, rel=1e-13)
    assert weights @ points[:, 0] ** 2 == pytest.approx(1.0 / 3.0, rel=1e-13)
    triangle = np.array([[0, 1, 2, 3, 4, 5]])
    corners = np.array([[0, 0, 0], [2, 0, 0], [0, 1, 0]], dtype=float)
    nodes = np.vstack([corners, (corners + np.roll(corners, -1, axis=0)) / 2])
    area = face_weights(nodes, triangle, 6)
    assert area.sum() == pytest.approx(1.0, rel=1e-13)
    # A straight quadratic triangle carries its mean on the mid-side nodes alone.
    np.testing.assert_allclose(area, [0, 0, 0, 1 / 3, 1 / 3, 1 / 3], atol=1e-14)


def test_extra_freedoms_are_left_empty(rng):
    points, cells = curved_mesh(0.0, rng)
    K = assemble(points, cells, STEEL.lame, points.size + 6)
    assert K.shape == (points.size + 6,) * 2
    assert K[points.size :].nnz == 0
