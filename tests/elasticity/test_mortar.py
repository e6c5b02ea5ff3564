"""Ties of non-matching faces: what passes them, and what they refuse."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.elasticity.interfaces.constraints import eliminate
from fe_drivetrain.elasticity.interfaces.mortar import mortar_tie, node_tie, settled
from fe_drivetrain.elasticity.mesh.blocks import brick, joined
from fe_drivetrain.elasticity.operator.elasticity import assemble
from fe_drivetrain.elasticity.operator.loads import traction_loads

# Nothing is parallel to an axis, no angle is a right one.
OBLIQUE = np.array([[0.9, 0.3, -0.4], [-0.2, 1.1, 0.3], [0.5, -0.1, 0.8]])
KINDS = [(10, 10), (27, 10), (10, 27), (20, 20), (8, 4), (4, 8), (27, 20), (4, 10), (10, 8)]


def two_blocks(own, other, nodes=(10, 10), larger=0.0):
    """Two oblique blocks on one another: the slave's top on the master's bottom."""

    def placed(bottom, larger):
        def shape(x):
            stretched = x * [1 + 2 * larger, 1 + 2 * larger, 0.5] + [-larger, -larger, bottom]
            return stretched @ OBLIQUE.T

        return shape

    graded = np.linspace(0, 1, own + 1) ** 1.3
    slave = brick((own, own, 1), nodes[0], placed(0.0, 0.0), edges=(graded, graded, None))
    master = brick((other, other, 1), nodes[1], placed(0.5, larger))
    return together(slave, master, "z1", "z0")


def two_rings(own, other, nodes=10):
    """A ring in another, turned by a share of its divisions."""

    def ring(radii, twist):
        def shape(x):
            r = radii[0] + x[:, 0] * (radii[1] - radii[0])
            turn = 2 * np.pi * (x[:, 1] + twist)
            return np.column_stack([r * np.cos(turn), r * np.sin(turn), x[:, 2]])

        return shape

    inner = joined(brick((1, own, max(own // 8, 1)), nodes, ring((0.6, 1.0), 0.0)))
    outer = joined(brick((1, other, max(other // 6, 1)), nodes, ring((1.0, 1.5), 0.3 / other)))
    return together(inner, outer, "x1", "x0")


def together(slave, master, own_face, other_face):
    points = np.vstack([slave.points, master.points])
    shift = len(slave.points)
    return points, slave.faces[own_face], master.faces[other_face] + shift


def following(constraint, points):
    """(n_nodes, n_nodes) P of u_slave = P u_master, from the x degrees of freedom's rows."""
    return -constraint.rows[::3][:, : 3 * len(points) : 3]


@pytest.mark.filterwarnings("ignore:tie 't'. the master face has:UserWarning")
@pytest.mark.parametrize("multipliers", ["dual", "standard"])
@pytest.mark.parametrize("nodes", KINDS)
@pytest.mark.parametrize(("own", "other"), [(3, 2), (1, 4)])
def test_linear_displacements_and_uniform_tractions_pass(nodes, own, other, multipliers, rng):
    """Both halves of the patch test: kinematics, and the forces that equal tractions become."""
    points, slave, master = two_blocks(own, other, nodes)
    n = points.size
    tie = mortar_tie("t", points, slave, master, n, multipliers)
    linear = points @ rng.standard_normal((3, 3)) + rng.standard_normal(3)
    assert np.abs(tie.rows @ linear.ravel()).max() < 1e-12 * np.abs(linear).max()

    traction = rng.standard_normal(3)
    on_slave = traction_loads(points, slave, traction, n)
    on_master = traction_loads(points, master, traction, n)
    passed = on_slave - tie.rows.T @ on_slave[tie.pivots]
    np.testing.assert_allclose(passed, on_master, atol=1e-13 * np.abs(traction).max())


def test_a_tie_of_nodes_fails_where_the_mortar_tie_passes(rng):
    points, slave, master = two_blocks(3, 2)
    tie = node_tie("t", points, slave, master, points.size)
    linear = points @ rng.standard_normal((3, 3))
    assert np.abs(tie.rows @ linear.ravel()).max() < 1e-12
    on_slave = traction_loads(points, slave, np.array([1.0, 0.0, 0.0]), points.size)
    on_master = traction_loads(points, master, np.array([1.0, 0.0, 0.0]), points.size)
    passed = on_slave - tie.rows.T @ on_slave[tie.pivots]
    assert np.abs(passed - on_master).max() > 0.05 * on_master.max()


@pytest.mark.parametrize("make", [mortar_tie, node_tie])
@pytest.mark.parametrize("nodes", [4, 10, 8, 20, 27])
def test_matching_meshes_are_joined_node_by_node(make, nodes):
    slave = brick((3, 2, 1), nodes, lambda x: (x - [0, 0, 1]) @ OBLIQUE.T)
    master = brick((3, 2, 1), nodes, lambda x: x @ OBLIQUE.T)
    points, own, other = together(slave, master, "z1", "z0")
    tie = make("t", points, own, other, points.size)
    P = following(tie, points)
    nodes_of_rows = tie.pivots[::3] // 3
    twins = np.abs(points[nodes_of_rows][:, None] - points[None]).max(axis=2) < 1e-9
    twins[:, np.unique(own)] = False
    expected = twins.astype(float)
    expected[np.arange(len(nodes_of_rows)), nodes_of_rows] = -1.0
    np.testing.assert_allclose(P.toarray(), expected, atol=1e-12)


@pytest.mark.parametrize("multipliers", ["dual", "standard"])
def test_a_master_that_is_larger_covers(multipliers, rng):
    points, slave, master = two_blocks(4, 3, larger=0.35)
    tie = mortar_tie("t", points, slave, master, points.size, multipliers)
    linear = points @ rng.standard_normal((3, 3))
    assert np.abs(tie.rows @ linear.ravel()).max() < 1e-12 * np.abs(linear).max()
    # Forces and moments pass whole, wherever the slave lies on the master.
    forces = rng.standard_normal(len(tie.pivots))
    motions = rigid_motions(points)
    assert np.abs(motions.T @ (tie.rows.T @ forces)).max() < 1e-11


def test_dual_multipliers_keep_rows_short():
    """A slave node follows what lies opposite to its facets, and not the whole face."""
    points, slave, master = two_blocks(8, 8)
    rows = {
        kind: np.diff(mortar_tie("t", points, slave, master, points.size, kind).rows.indptr)
        for kind in ("dual", "standard")
    }
    assert rows["dual"].mean() < 0.25 * rows["standard"].mean()


@pytest.mark.parametrize("multipliers", ["dual", "standard"])
def test_the_mean_of_a_tied_field_is_that_of_the_slave(multipliers):
    """A smooth field follows with the accuracy of the elements: order three of quadratic facets."""
    error = []
    for n in (4, 8):
        points, slave, master = two_blocks(n, n - 1)
        tie = mortar_tie("t", points, slave, master, points.size, multipliers)
        field = np.zeros((len(points), 3))
        field[:, 0] = np.sin(2 * points[:, 0] + points[:, 1])
        error.append(np.abs(tie.rows @ field.ravel()).max())
    assert np.log2(error[0] / error[1]) > 2.5


def test_rings_settle_to_fit_and_then_turn_freely():
    """On a curved face a gap is left; nodes moved by it fulfil the tie in every rigid motion."""
    moved, sizes = [], np.array([8, 16])
    for n in sizes:
        points, slave, master = two_rings(n, n - 2)
        tie = mortar_tie("t", points, slave, master, points.size)
        fitted = settled(points, tie)
        assert np.abs(tie.rows @ rigid_motions(fitted)).max() < 1e-13
        change = np.abs(fitted - points).max(axis=1)
        assert not change[np.setdiff1d(np.arange(len(points)), slave)].any()
        moved.append(change.max())
    assert moved[0] < 0.01
    assert np.log2(moved[0] / moved[1]) > 2.5  # the cube of the facets' size


def pressure_errors(turns, multipliers):
    """Relative error of the nodal forces of a pressure, passed through a cylinder."""
    found = []
    for n in turns:
        points, slave, master = two_rings(n, n - 2)
        tie = mortar_tie("t", points, slave, master, points.size, multipliers)
        on_slave = traction_loads(points, slave, lambda x, normal: normal)
        on_master = -traction_loads(points, master, lambda x, normal: normal)
        passed = on_slave - tie.rows.T @ on_slave[tie.pivots]
        found.append(np.abs(passed - on_master).sum() / np.abs(on_master).sum())
    return np.array(found)


def test_traction_passes_a_cylinder_as_well_as_facets_meet_it():
    """The normals of quadratic facets are of second order."""
    error = pressure_errors((8, 16, 32), "standard")
    assert (np.log2(error[:-1] / error[1:]) > 2.0).all()
    assert error[-1] < 1e-3


def test_dual_multipliers_pass_what_is_constant_in_a_facet():
    """Across half a facet of the cylinder a pressure turns by pi / n."""
    assert pressure_errors((16,), "dual") < np.pi / 16


def test_tied_blocks_have_six_rigid_motions_and_no_more():
    slave = brick((2, 2, 1), 10, lambda x: (x * [1, 1, 0.5]) @ OBLIQUE.T)
    master = brick((3, 3, 1), 10, lambda x: (x * [1, 1, 0.5] + [0, 0, 0.5]) @ OBLIQUE.T)
    points, own, other = together(slave, master, "z1", "z0")
    cells = np.vstack([slave.cells, master.cells + len(slave.points)])
    K = assemble(points, cells, (1.0, 1.0))
    for tie in (own, other), (other, own):
        elimination = eliminate([mortar_tie("t", points, *tie, points.size)], points.size)
        T = elimination.T[:, elimination.free]
        modes = np.linalg.eigvalsh((T.T @ K @ T).toarray())
        assert np.abs(modes[:6]).max() < 1e-12 * modes[-1]
        assert modes[6] > 1e-6 * modes[-1]


def test_faces_that_do_not_cover_are_refused():
    points, slave, master = two_blocks(3, 2, larger=-0.1)
    with pytest.raises(InputError, match=r"covers 64 % of the slave face"):
        mortar_tie("seat", points, slave, master, points.size)
    with pytest.raises(InputError, match="lies outside of the master face"):
        node_tie("seat", points, slave, master, points.size)


def test_other_mistakes_are_named():
    points, slave, master = two_blocks(2, 3)
    inside_out = master[:, [0, 2, 1, 5, 4, 3]]
    with pytest.raises(InputError, match="covers 0 %"):
        mortar_tie("seat", points, slave, inside_out, points.size)
    apart = points.copy()
    apart[np.unique(master)] += 0.5
    with pytest.raises(InputError, match="covers 0 %"):
        mortar_tie("seat", apart, slave, master, points.size)
    twice = np.vstack([master, master])
    with pytest.raises(InputError, match="covers 200 %"):
        mortar_tie("seat", points, slave, twice, points.size)
    with pytest.raises(InputError, match="share nodes"):
        mortar_tie("seat", points, slave, slave, points.size)


def two_polygons(own, other):
    """Rings of straight hexahedra: their faces are polygons, which lie apart."""
    return two_rings(own, other, nodes=8)


@pytest.mark.parametrize("make", [mortar_tie, node_tie])
def test_a_slave_that_is_much_coarser_is_warned_of(make):
    points, coarse, fine = two_blocks(1, 4)
    with pytest.warns(UserWarning, match="take the finer face as the slave"):
        make("t", points, coarse, fine, points.size)


@pytest.mark.parametrize("make", [mortar_tie, node_tie])
@pytest.mark.parametrize(("own", "other"), [(3, 3), (4, 3), (8, 1)])
def test_a_finer_slave_is_not_warned_of(make, own, other, recwarn):
    points, slave, master = two_blocks(own, other)
    make("t", points, slave, master, points.size)
    assert not recwarn.list


@pytest.mark.parametrize("make", [mortar_tie, node_tie])
def test_faces_that_lie_apart_are_warned_of_until_settled(make):
    points, slave, master = two_polygons(16, 8)
    with pytest.warns(UserWarning, match="by which moments fail to balance"):
        tie = make("t", points, slave, master, points.size)
    moments = rigid_motions(points)[:, 3:]
    assert np.abs(tie.rows @ moments).max() > 0.01
    assert np.abs(tie.rows @ rigid_motions(settled(points, tie))).max() < 1e-13


@pytest.mark.parametrize("make", [mortar_tie, node_tie])
def test_curved_facets_meet_their_cylinder_closely_enough(make, recwarn):
    points, slave, master = two_rings(10, 8)
    make("t", points, slave, master, points.size)
    assert not recwarn.list


def test_faces_too_far_apart_are_told_from_faces_that_do_not_cover():
    points, slave, master = two_polygons(8, 64)
    with (
        pytest.warns(UserWarning, match="finer face"),
        pytest.raises(InputError, match=r"lie further apart than 0\.25 of a master facet"),
    ):
        mortar_tie("seat", points, slave, master, points.size)
    points, slave, master = two_blocks(3, 2, larger=-0.1)
    with pytest.raises(InputError, match="take the smaller face as the slave"):
        mortar_tie("seat", points, slave, master, points.size)
