"""Structured blocks, their facets and loads: volumes, areas, resultants that are known."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.elasticity.mesh.blocks import FACES, brick, joined
from fe_drivetrain.elasticity.mesh.facets import facet_points, local_facets
from fe_drivetrain.elasticity.mesh.measures import mass_moments
from fe_drivetrain.elasticity.operator.elasticity import assemble
from fe_drivetrain.elasticity.operator.loads import body_loads, pressure, traction_loads
from fe_drivetrain.elasticity.operator.mass import mass_matrix
from fe_drivetrain.elasticity.operator.stress import nodal_stresses, tensor

KINDS = (4, 10, 8, 20, 27)
LAME = (1.0, 0.7)


def ring(points):
    """A closed ring: radius 1 to 2, height 3."""
    r, t = 1.0 + points[:, 0], 2.0 * np.pi * points[:, 1]
    return np.column_stack([r * np.cos(t), r * np.sin(t), 3.0 * points[:, 2]])


def skewed(points):
    x, y, z = points.T
    return np.column_stack([2.0 * x + 0.3 * y, y + 0.2 * z, 1.5 * z - 0.1 * x])


@pytest.mark.parametrize("nodes", KINDS)
def test_faces_close_the_block(nodes):
    """The normals of a closed surface sum to zero, and x . n integrates to three volumes."""
    block = brick((2, 3, 2), nodes, skewed)
    volume = np.linalg.det([[2.0, 0.0, -0.1], [0.3, 1.0, 0.0], [0.0, 0.2, 1.5]])
    total, content = np.zeros(3), 0.0
    for name in FACES:
        at = facet_points(block.points, block.faces[name])
        vectors = at.normals * at.areas[:, :, None]
        total += vectors.sum(axis=(0, 1))
        content += float((at.positions * vectors).sum()) / 3.0
    np.testing.assert_allclose(total, 0.0, atol=1e-13)
    assert content == pytest.approx(volume, rel=1e-13)


@pytest.mark.parametrize("nodes", KINDS)
def test_every_facet_is_shared_by_two_cells_or_on_a_face(nodes):
    block = brick((2, 2, 3), nodes)
    facets = block.cells[:, local_facets(nodes)].reshape(-1, local_facets(nodes).shape[1])
    n_corners = 3 if facets.shape[1] in (3, 6) else 4
    _, count = np.unique(np.sort(facets[:, :n_corners], axis=1), axis=0, return_counts=True)
    outside = sum(len(f) for f in block.faces.values())
    assert set(count) == {1, 2}
    assert (count == 1).sum() == outside


@pytest.mark.parametrize("nodes", KINDS)
def test_volume_of_a_closed_ring_converges(nodes):
    """Chords of n sides lose n/(2 pi) sin(2 pi/n); quadratic elements lose far less."""
    block = joined(brick((1, 12, 1), nodes, ring))
    weight = body_loads(block.points, block.cells, np.array([0.0, 0.0, -1.0]))
    exact = 3.0 * np.pi * (2.0**2 - 1.0**2)
    chords = 12 / (2 * np.pi) * np.sin(2 * np.pi / 12)
    if nodes in (4, 8):
        assert -weight.sum() == pytest.approx(chords * exact, rel=1e-12)
    else:
        assert -weight.sum() == pytest.approx(exact, rel=1e-3)
    # it closes: a ring is one body with six rigid motions, and nothing else is free
    K = assemble(block.points, block.cells, LAME)
    motions = rigid_motions(block.points)
    assert np.abs(K @ motions).max() < 1e-11 * abs(K).max()
    values = np.linalg.eigvalsh(K.toarray())
    assert (values < 1e-9 * values[-1]).sum() == 6


@pytest.mark.parametrize("nodes", KINDS)
def test_pressure_all_round_is_in_equilibrium(nodes):
    block = joined(brick((1, 8, 2), nodes, ring))
    forces = sum(
        traction_loads(block.points, block.faces[name], pressure(2.0))
        for name in ("x0", "x1", "z0", "z1")
    )
    resultant = rigid_motions(block.points).T @ forces
    np.testing.assert_allclose(resultant, 0.0, atol=1e-11)


@pytest.mark.parametrize("nodes", KINDS)
def test_divergence_theorem_of_a_quadratic_traction(nodes):
    """Nodal forces do the work of the traction on any linear displacement."""
    block = brick((2, 2, 2), nodes, skewed)

    def traction(x, normal):
        return np.column_stack([x[:, 0] * x[:, 1], x[:, 2] ** 2, x[:, 0]]) * normal[:, :1]

    forces = traction_loads(block.points, block.faces["x1"], traction)
    at = facet_points(block.points, block.faces["x1"], degree=8)
    t = traction(at.positions.reshape(-1, 3), at.normals.reshape(-1, 3))
    displaced = at.positions.reshape(-1, 3)[:, [1, 2, 0]]
    work = float(np.einsum("qi,qi,q->", t, displaced, at.areas.ravel()))
    assert forces @ block.points[:, [1, 2, 0]].ravel() == pytest.approx(work, rel=1e-12)


@pytest.mark.parametrize("nodes", KINDS)
def test_body_loads_of_the_fifth_degree_do_their_exact_work(nodes):
    """On displacements that the elements hold: linear ones, and squares of quadratic elements."""
    block = brick((2, 2, 2), nodes)
    power = 1 if nodes in (4, 8) else 2
    forces = body_loads(block.points, block.cells, lambda x: x**5 * [1.0, 2.0, -3.0])
    moved = block.points**power * [1.0, 0.5, 2.0]
    exact = (1.0 + 1.0 - 6.0) / (6.0 + power)  # of integrals from 0 to 1 of x^(5 + power)
    assert forces @ moved.ravel() == pytest.approx(exact, rel=1e-12)
    # and no force is lost
    assert forces.reshape(-1, 3).sum(axis=0) == pytest.approx(np.array([1, 2, -3]) / 6, rel=1e-12)


@pytest.mark.parametrize("nodes", KINDS)
def test_a_parallelepiped_has_the_mass_centre_and_inertia_of_its_edges(nodes):
    """The second moments of one with the edges A about its centre are V A A^T / 12."""
    block = brick((2, 1, 2), nodes, lambda p: skewed(p) + np.array([5.0, -7.0, 11.0]))
    A = skewed(np.eye(3)).T
    V, density = abs(np.linalg.det(A)), 7.0
    centre = A @ [0.5, 0.5, 0.5] + [5.0, -7.0, 11.0]
    second = V * A @ A.T / 12.0
    inertia = np.trace(second) * np.eye(3) - second
    volume, middle, about = mass_moments(block.points, block.cells)
    assert volume == pytest.approx(V, rel=1e-12)
    np.testing.assert_allclose(middle, centre, rtol=1e-12)
    np.testing.assert_allclose(about, inertia, atol=1e-11 * np.abs(inertia).max())
    motions = rigid_motions(block.points, centre)
    M = motions.T @ mass_matrix(block.points, block.cells, density, block.points.size) @ motions
    rigid = np.zeros((6, 6))
    rigid[:3, :3], rigid[3:, 3:] = density * V * np.eye(3), density * inertia
    np.testing.assert_allclose(M, rigid, atol=1e-10 * np.abs(rigid).max())


@pytest.mark.parametrize("nodes", KINDS)
def test_stresses_of_a_uniform_displacement_gradient_are_hookes_law(nodes):
    block = brick((1, 2, 1), nodes, skewed)
    H = np.random.default_rng(2).standard_normal((3, 3))
    u = (block.points @ H.T).ravel()
    found = tensor(nodal_stresses(block.points, block.cells, u, LAME))
    lam, mu = LAME
    expected = lam * np.trace(H) * np.eye(3) + mu * (H + H.T)
    np.testing.assert_allclose(found, np.broadcast_to(expected, found.shape), atol=1e-11)


def test_graded_edges_are_kept():
    block = brick((0, 1, 1), 8, edges=([0.0, 0.1, 1.0], None, None))
    assert set(np.round(block.points[:, 0], 12)) == {0.0, 0.1, 1.0}


def test_left_handed_map_is_refused():
    with pytest.raises(InputError, match="inside out"):
        brick((1, 1, 1), 8, lambda p: p * [-1.0, 1.0, 1.0])
    with pytest.raises(InputError, match="use tetrahedra"):
        brick((1, 1, 1), 11)
