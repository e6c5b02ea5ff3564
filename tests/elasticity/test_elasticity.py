"""The elastic operator against scikit-fem's own assembly and against exact fields."""

import numpy as np
import pytest
from skfem import (
    Basis,
    ElementHex1,
    ElementHex2,
    ElementHexS2,
    ElementTetP1,
    ElementTetP2,
    ElementVector,
    MeshHex,
    MeshTet,
    MeshTet2,
)
from skfem.models.elasticity import linear_elasticity
from skfem.quadrature import get_quadrature

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.drivetrain_file.materials import MATERIALS, Material
from fe_drivetrain.elasticity.mesh.blocks import brick
from fe_drivetrain.elasticity.mesh.facets import face_weights, volume_weights
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator.elasticity import assemble, sparsity
from fe_drivetrain.elasticity.operator.element_loops import is_straight

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


def moved_mesh(n_nodes, amount, rng):
    """A cube of any element kind in VTK order, its nodes moved at random."""
    if n_nodes in (4, 10):
        points, cells = curved_mesh(0.0, rng)
        cells = cells[:, :n_nodes]
    else:
        ends = np.linspace(0.0, 1.0, 3)
        corners = np.array([(x, y, z) for z in ends for y in ends for x in ends])
        first = [x + 3 * y + 9 * z for z in (0, 1) for y in (0, 1) for x in (0, 1)]
        bricks = np.array(first)[:, None] + np.array([0, 1, 4, 3, 9, 10, 13, 12])
        weights = element_kind(n_nodes).corner_weights()
        everywhere = np.einsum("nc,ecd->end", weights, corners[bricks])
        points, cells = np.unique(everywhere.reshape(-1, 3), axis=0, return_inverse=True)
        cells = cells.reshape(len(bricks), n_nodes)
    used, cells = np.unique(cells, return_inverse=True)
    points = points[used]
    return points + amount * rng.uniform(-1, 1, points.shape), cells.reshape(-1, n_nodes)


def generic_assembly(points, cells, lame):
    """scikit-fem's own form on the same elements, its degrees of freedom numbered as ours."""
    kind = element_kind(cells.shape[1])
    order = np.argsort(kind.order)  # VTK's place of each of scikit-fem's nodes
    X, W = get_quadrature(kind.element.refdom, kind.degree)
    k = cells.shape[1]
    lam, mu = lame
    K = np.zeros((points.size, points.size))
    tables = [kind.element.lbasis(X, i)[1] for i in range(k)]
    for cell in cells[:, order]:
        J = np.einsum("ni,nkq->ikq", points[cell], np.array(tables))
        inverse = np.linalg.inv(J.transpose(2, 0, 1))
        size = np.abs(np.linalg.det(J.transpose(2, 0, 1))) * W
        g = np.einsum("qki,nkq->nqi", inverse, np.array(tables))
        for a in range(k):
            for b in range(k):
                H = np.einsum("q,qi,qj->ij", size, g[a], g[b])
                block = lam * H + mu * H.T + mu * np.trace(H) * np.eye(3)
                rows, columns = 3 * cell[a] + np.arange(3), 3 * cell[b] + np.arange(3)
                K[np.ix_(rows, columns)] += block
    return K


@pytest.mark.parametrize("amount", [0.0, 0.02])
def test_equals_scikit_fem(amount, rng):
    points, cells = curved_mesh(amount, rng)
    assert is_straight(points, cells).all() == (amount == 0.0)
    own = assemble(points, cells, STEEL.lame).toarray()

    basis = Basis(as_scikit_fem(points, cells), ElementVector(ElementTetP2()))
    generic = linear_elasticity(*STEEL.lame).assemble(basis)
    # scikit-fem numbers degrees of freedom its own way: match them by element, node and component.
    local = np.empty(basis.element_dofs.shape, dtype=int)
    for k in range(30):
        node, axis = divmod(k, 3)
        local[k] = 3 * cells[:, node] + axis
    number = np.empty(points.size, dtype=int)
    number[basis.element_dofs.ravel()] = local.ravel()
    own = own[number][:, number]
    assert abs(own - generic).max() < 1e-12 * abs(generic).max()


@pytest.mark.parametrize("n_nodes", [4, 8, 20, 27])
def test_other_elements_equal_scikit_fem(n_nodes, rng):
    """Matched where a node stands: the two number nodes differently, and so do their meshes."""
    points, cells = moved_mesh(n_nodes, 0.02, rng)
    kind = element_kind(n_nodes)
    # scikit-fem's hexahedral meshes have trilinear maps: distorted, their edges straight.
    points = on_corners(points, cells)
    if n_nodes == 4:
        mesh, element = MeshTet(points.T.copy(), cells.T.copy(), sort_t=False), ElementTetP1()
    else:
        mesh = hexahedral_mesh(points, cells[:, :8])
        element = {8: ElementHex1, 20: ElementHexS2, 27: ElementHex2}[n_nodes]()
    basis = Basis(mesh, ElementVector(element), intorder=kind.degree)
    generic = linear_elasticity(*STEEL.lame).assemble(basis).toarray()
    where = np.round(basis.doflocs.T, 9)
    place = {tuple(x): node for node, x in enumerate(np.round(points, 9))}
    component = np.empty(basis.N, dtype=int)
    component[basis.element_dofs.ravel()] = np.tile(np.arange(3), n_nodes).repeat(len(cells))
    number = np.array([3 * place[tuple(x)] for x in where]) + component
    own = assemble(points, cells, STEEL.lame).toarray()[np.ix_(number, number)]
    assert np.abs(own - generic).max() < 1e-12 * np.abs(generic).max()


@pytest.mark.parametrize("n_nodes", [4, 8, 10, 20, 27])
def test_curved_elements_equal_their_definition(n_nodes, rng):
    """The same integrals by dense loops over scikit-fem's shape functions and quadrature."""
    points, cells = moved_mesh(n_nodes, 0.02, rng)
    cells = cells[:4]
    own = assemble(points, cells, STEEL.lame).toarray()
    expected = generic_assembly(points, cells, STEEL.lame)
    assert np.abs(own - expected).max() < 1e-12 * np.abs(expected).max()


def hexahedral_mesh(points, corners):
    used, cells = np.unique(corners, return_inverse=True)
    order = np.argsort(element_kind(8).order)
    return MeshHex(points[used].T.copy(), cells.reshape(-1, 8)[:, order].T.copy(), sort_t=False)


def on_corners(points, cells):
    """Mid-side, face and centre nodes moved to where the corners' trilinear map has them."""
    moved = points.copy()
    weights = element_kind(cells.shape[1]).corner_weights()
    moved[cells] = np.einsum("nc,ecd->end", weights, points[cells[:, : weights.shape[1]]])
    return moved


def test_a_mixture_of_straight_and_curved_elements(rng):
    """The affine path and the integrated one meet in one matrix."""
    points, cells = curved_mesh(0.0, rng)
    points[cells[0, 9]] += 0.01  # one curved edge
    straight = is_straight(points, cells)
    assert straight.any()
    assert not straight.all()
    expected = generic_assembly(points, cells, STEEL.lame)
    own = assemble(points, cells, STEEL.lame).toarray()
    assert np.abs(own - expected).max() < 1e-12 * np.abs(expected).max()


def test_sparsity_is_reused_for_another_material_and_shape(rng):
    points, cells = curved_mesh(0.02, rng)
    pattern = sparsity(cells, len(points))
    other = Material(youngs_modulus=7e9, poisson_ratio=0.2, density=1000.0).lame
    moved = 1.1 * points
    again = assemble(moved, cells, other, pattern=pattern)
    assert np.shares_memory(again.indices, pattern.indices)
    assert abs(again - assemble(moved, cells, other)).max() == 0.0


def test_unknown_element_is_refused():
    with pytest.raises(InputError, match="no element has 6 nodes"):
        assemble(np.zeros((6, 3)), np.arange(6)[None], STEEL.lame)


def test_symmetric_and_rigid_motions_are_free(rng):
    points, cells = curved_mesh(0.02, rng)
    K = assemble(points, cells, STEEL.lame, points.size)
    size = abs(K).max()
    assert abs(K - K.T).max() < 1e-14 * size
    assert np.abs(K @ rigid_motions(points)).max() < 1e-13 * size * np.abs(points).max()


def test_constant_strain_energy_is_exact_on_curved_elements(rng):
    """Patch: u = A x has the energy V (lam tr(e)^2 + 2 mu e:e) / 2 on any mesh."""
    points, cells = curved_mesh(0.02, rng)
    material = Material(youngs_modulus=7e9, poisson_ratio=0.2, density=1000.0)
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


def test_extra_degrees_of_freedom_are_left_empty(rng):
    points, cells = curved_mesh(0.0, rng)
    K = assemble(points, cells, STEEL.lame, points.size + 6)
    assert K.shape == (points.size + 6,) * 2
    assert K.tocsr()[points.size :].nnz == 0


@pytest.mark.parametrize("nodes", [4, 8, 10, 20, 27])
def test_volume_weights_sum_to_the_volume_of_any_element(nodes, rng):
    """And their first moment is its centre: what a mass under gravity needs."""
    block = brick((2, 2, 2), nodes, shape=lambda x: x * [2.0, 1.0, 0.5])
    weights = volume_weights(block.points, block.cells, len(block.points))
    assert weights.sum() == pytest.approx(1.0, rel=1e-13)
    centre = (block.points.min(axis=0) + block.points.max(axis=0)) / 2
    np.testing.assert_allclose(weights @ block.points, centre, rtol=1e-12, atol=1e-13)


def test_an_element_without_volume_has_a_stiffness_of_no_numbers():
    """It raises nothing here: who checks the mesh says which element it is."""
    points = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]])
    with np.errstate(all="ignore"):
        K = assemble(points, np.arange(4)[None], (1.0, 1.0))
    assert not np.isfinite(K.data).any()
