"""Structured hexahedra of shafts: exact surfaces, sound and conforming, of the right stiffness."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from skfem import Basis, ElementHex1, ElementHex2, ElementVector, MeshHex1, MeshHex2
from skfem.models.elasticity import linear_elasticity

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.elasticity.mesh.generation import generate
from fe_drivetrain.elasticity.mesh.hexahedra import VTK_LATTICE, shaft_hexahedra
from fe_drivetrain.elasticity.mesh.linear import first_order, straightened
from fe_drivetrain.elasticity.mesh.shaft_section import Grading
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator.elasticity import assemble
from fe_drivetrain.geometry import Flange, MeshSizes, Section, Shaft

STEEL = MATERIALS["steel"]

TUBE = Shaft(front=-2.0, sections=[Section(length=2.0, outer_diameter=0.7, inner_diameter=0.3)])
ROD = Shaft(front=-2.0, sections=[Section(length=2.0, outer_diameter=0.7)])
STEPPED = Shaft(
    front=-2.0,
    sections=[
        Section(length=1.0, outer_diameter=0.7, inner_diameter=0.3),
        Section(length=1.0, outer_diameter=0.5, inner_diameter=0.3),
    ],
)
# everything at once: flange, tapers both ways, steps of bore and outside, solid lengths
WILD = Shaft(
    front=-0.5,
    flange=Flange(outer_diameter=1.0, thickness=0.1),
    sections=[
        Section(length=1.0, outer_diameter=0.7, inner_diameter=0.3, outer_diameter_end=0.6),
        Section(length=0.5, outer_diameter=0.5, inner_diameter=0.2),
        Section(length=0.7, outer_diameter=0.8, outer_diameter_end=0.4),
        Section(length=0.3, outer_diameter=0.4),
        Section(length=0.3, outer_diameter=0.4, inner_diameter=0.1),
    ],
)
SHAFTS = {"tube": TUBE, "rod": ROD, "stepped": STEPPED, "wild": WILD}
GRADED = Grading(steps=2, ends=1)

FACES = [np.flatnonzero(VTK_LATTICE[:, axis] == side) for axis in range(3) for side in (0, 2)]


def jacobians(mesh):
    """Jacobian determinants (ne, q) at Gauss points of degree 6, and the points' weights."""
    gradients, weights = element_kind(mesh.cells.shape[1]).table(6)
    matrices = np.einsum("eai,qka->eqik", mesh.points[mesh.cells], gradients)
    return np.linalg.det(matrices), weights


def volume(mesh):
    determinants, weights = jacobians(mesh)
    return float((determinants * weights).sum())


def exact_volume(shaft):
    total = 0.0
    for piece in shaft.pieces:
        a, b = piece.outer_diameter / 2, piece.end_diameter / 2
        ring = (a * a + a * b + b * b) / 3 - piece.inner_diameter**2 / 4
        total += np.pi * piece.length * ring
    return total


def twist_stiffness(mesh, shaft):
    """Energy stiffness of u = (x - front) / L e_x cross r: exact for a cylinder."""
    share = (mesh.points[:, 0] - shaft.front) / shaft.length
    r = np.column_stack([np.zeros(len(share)), -mesh.points[:, 2], mesh.points[:, 1]])
    u = (share[:, None] * r).ravel()
    return float(u @ (assemble(mesh.points, mesh.cells, STEEL.lame) @ u))


def polar_stiffness(shaft):
    """GJ / L of a shaft of one section."""
    (piece,) = shaft.pieces
    J = np.pi / 32 * (piece.outer_diameter**4 - piece.inner_diameter**4)
    return STEEL.shear_modulus * J / piece.length


@pytest.mark.parametrize("name", SHAFTS)
@pytest.mark.parametrize("nodes", [8, 20, 27])
def test_volume_converges_at_the_order_of_the_geometry(name, nodes):
    """Chords leave out h^2 of a circle, parabolas through three of its points h^4."""
    shaft, order = SHAFTS[name], 2 if nodes == 8 else 4
    errors = [
        1 - volume(shaft_hexahedra(shaft, 0.4, nodes, refinement=n)) / exact_volume(shaft)
        for n in (1, 2)
    ]
    assert 0 < errors[1] < errors[0]
    assert np.log2(errors[0] / errors[1]) == pytest.approx(order, abs=0.1)


@pytest.mark.parametrize("name", SHAFTS)
@pytest.mark.parametrize("grading", [Grading(), GRADED, Grading(3, 3, 0.1)])
@pytest.mark.parametrize("nodes", [8, 20, 27])
def test_jacobians_are_positive_all_over_the_element(name, grading, nodes):
    mesh = shaft_hexahedra(SHAFTS[name], 0.3, nodes, elements_per_turn=8, grading=grading)
    assert jacobians(mesh)[0].min() > 0
    # and at the corners, where elements fold first
    kind = element_kind(nodes)
    corners = VTK_LATTICE[:8].T / 2.0
    _, gradients = kind.shape(corners)
    matrices = np.einsum("eai,qka->eqik", mesh.points[mesh.cells], gradients)
    assert np.linalg.det(matrices).min() > 0


@pytest.mark.parametrize("name", SHAFTS)
def test_conforming_and_closed(name):
    """Each face belongs to two cells, which share all its nine nodes, or lies on the surface."""
    shaft = SHAFTS[name]
    mesh = shaft_hexahedra(shaft, 0.25, 27, grading=Grading(1, 1))
    assert not cKDTree(mesh.points).query_pairs(1e-9)
    assert len(np.unique(mesh.cells)) == len(mesh.points)
    faces = np.sort(np.concatenate([mesh.cells[:, f] for f in FACES]), axis=1)
    outside = np.concatenate([mesh.cells[:, f] for f in FACES])
    _, first, count = np.unique(faces, axis=0, return_index=True, return_counts=True)
    assert set(count) == {1, 2}
    for points in mesh.points[outside[first[count == 1]]]:
        x, r = points[:, 0], np.hypot(points[:, 1], points[:, 2])
        on = [np.ptp(x) < 1e-9 and np.abs(np.array(shaft.stations) - x[0]).min() < 1e-9]
        for piece, x0 in zip(shaft.pieces, shaft.stations, strict=False):
            slope = (piece.end_diameter - piece.outer_diameter) / 2 / piece.length
            inside = (x > x0 - 1e-9) & (x < x0 + piece.length + 1e-9)
            outer = np.abs(r - piece.outer_diameter / 2 - slope * (x - x0)) < 1e-9
            on.append((inside & outer).all())
            on.append((inside & (np.abs(r - piece.inner_diameter / 2) < 1e-9)).all())
        assert any(on), "a face of one cell alone lies inside the shaft"


@pytest.mark.parametrize("nodes", [20, 27])
def test_twist_of_a_cylinder_is_off_by_its_geometry_alone(nodes):
    """u = theta x / L e_x cross r is linear in y and z: only the curved surface has an error."""
    for shaft in (TUBE, ROD):
        errors = [
            1
            - twist_stiffness(shaft_hexahedra(shaft, 2.0, nodes, elements_per_turn=n), shaft)
            / polar_stiffness(shaft)
            for n in (8, 16)
        ]
        assert np.log2(errors[0] / errors[1]) == pytest.approx(4, abs=0.15)
        # the ring's J grows with the fourth power of its radius, its volume with the second
        assert errors[1] < 2e-4


#: A cone with a core before a bore: of 27 nodes, scikit-fem takes long for each element.
BORED_CONE = Shaft(
    front=0.0,
    sections=[
        Section(length=0.7, outer_diameter=0.8, outer_diameter_end=0.4),
        Section(length=0.3, outer_diameter=0.4, inner_diameter=0.1),
    ],
)


@pytest.mark.parametrize(("shaft", "nodes"), [(WILD, 8), (BORED_CONE, 27)])
def test_stiffness_equals_scikit_fem(shaft, nodes):
    """The order of the nodes is the one that the operator reads: curved, graded, with a core."""
    mesh = shaft_hexahedra(shaft, 0.5, nodes, elements_per_turn=4, grading=Grading(1, 0))
    kind = element_kind(nodes)
    # scikit-fem's own order of the nodes in a cell, found from their places in it
    by_skfem = mesh.cells[:, kind.order.argsort()]
    skfem_mesh, element = {8: (MeshHex1, ElementHex1), 27: (MeshHex2, ElementHex2)}[nodes]
    other = skfem_mesh(mesh.points.T.copy(), by_skfem.T.copy(), sort_t=False)
    basis = Basis(other, ElementVector(element()), intorder=kind.degree)
    generic = linear_elasticity(*STEEL.lame).assemble(basis)
    number = np.empty(mesh.points.size, dtype=int)
    local = (3 * by_skfem[:, :, None] + np.arange(3)).reshape(len(by_skfem), -1)
    number[basis.element_dofs.T.ravel()] = local.ravel()
    own = assemble(mesh.points, mesh.cells, STEEL.lame).tocsr()[number][:, number]
    assert abs(own - generic).max() < 1e-12 * abs(generic).max()


def test_nodes_stand_in_the_order_of_vtk():
    """Mid-side, face and body nodes are the means of their corners, in x, radius and angle."""
    between = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4)]
    between += [(0, 4), (1, 5), (2, 6), (3, 7)]
    between += [(0, 4, 7, 3), (1, 5, 6, 2), (0, 1, 5, 4), (3, 2, 6, 7), (0, 1, 2, 3), (4, 5, 6, 7)]
    between += [tuple(range(8))]
    mesh = shaft_hexahedra(STEPPED, 0.3, 27, grading=GRADED)
    x, y, z = np.moveaxis(mesh.points[mesh.cells], -1, 0)
    r, angle = np.hypot(y, z), np.arctan2(z, y)
    # from the first corner on, so that no element has the cut at half a turn inside
    angle = (angle - angle[:, :1] + np.pi) % (2 * np.pi) - np.pi
    for node, corners in enumerate(between, start=8):
        for coordinate in (x, r, angle):
            mean = coordinate[:, list(corners)].mean(axis=1)
            np.testing.assert_allclose(coordinate[:, node], mean, atol=1e-13)


def test_node_sets_are_the_faces():
    seats = {"main": (0.8, 1.0), "rear": (1.9, 2.05)}
    mesh = shaft_hexahedra(WILD, 0.3, 27, seats=seats)
    assert np.all(mesh.points[mesh.front, 0] == WILD.front)
    np.testing.assert_allclose(mesh.points[mesh.rear, 0], WILD.rear, atol=1e-12)
    everything = mesh.points
    for nodes, x in ((mesh.front, WILD.front), (mesh.rear, WILD.rear)):
        assert len(nodes) == (np.abs(everything[:, 0] - x) < 1e-9).sum()
    seat = mesh.points[mesh.seats["main"]]
    np.testing.assert_allclose(np.hypot(seat[:, 1], seat[:, 2]), 0.25, rtol=1e-14)
    assert seat[:, 0].min() == pytest.approx(0.8)
    assert seat[:, 0].max() == pytest.approx(1.0)
    # rings of nodes at the two edges of the seat, and at the middle of the element between
    assert len(seat) == 3 * 24


def test_seat_off_a_cylinder_is_refused():
    with pytest.raises(InputError, match=r"bearing 'b'.*one cylindrical length"):
        shaft_hexahedra(WILD, 0.3, seats={"b": (0.0, 0.2)})


def test_grading_makes_elements_small_at_the_step_and_nowhere_else():
    mesh = shaft_hexahedra(STEPPED, 0.5, 27, grading=Grading(steps=3, ratio=0.2))
    x = np.unique(mesh.points[:, 0].round(9))
    at = np.searchsorted(x, -1.0)
    assert x[at] == pytest.approx(-1.0)
    # half an element: its middle node comes first
    assert x[at + 1] - x[at] == pytest.approx(0.5 * 0.2**3 / 2)
    assert x[at] - x[at - 1] == pytest.approx(0.5 * 0.2**3 / 2)
    assert x[1] - x[0] == pytest.approx(0.25)
    r = np.unique(np.hypot(mesh.points[:, 1], mesh.points[:, 2]).round(9))
    edge = np.searchsorted(r, 0.25)
    assert r[edge] == pytest.approx(0.25)
    for gap in (r[edge + 1] - r[edge], r[edge] - r[edge - 1]):
        assert gap == pytest.approx(0.1 * 0.2**3 / 2)


def held_twist(mesh):
    """Torsional stiffness between rigid ends, everything else in equilibrium."""
    from scipy.sparse.linalg import spsolve

    K = assemble(mesh.points, mesh.cells, STEEL.lame).tocsr()
    u = np.zeros((len(mesh.points), 3))
    y, z = mesh.points[mesh.front, 1], mesh.points[mesh.front, 2]
    u[mesh.front] = np.column_stack([np.zeros(len(y)), -z, y])
    held = np.zeros((len(mesh.points), 3), dtype=bool)
    held[mesh.front] = held[mesh.rear] = True
    free, u = ~held.ravel(), u.ravel()
    u[free] = spsolve(K[free][:, free].tocsc(), -(K @ u)[free])
    return float(u @ (K @ u))


def test_nested_meshes_soften_a_step():
    """Finer along x and radius only: richer displacements, less energy, and below GJ / L."""
    coarse, graded, both = (
        held_twist(shaft_hexahedra(STEPPED, size, 27, elements_per_turn=4, grading=g))
        for size, g in ((0.5, Grading()), (0.5, Grading(1)), (0.5, Grading(2, 1)))
    )
    assert both < graded < coarse


def test_refinement_cuts_every_element():
    one, two = (shaft_hexahedra(WILD, 0.3, 8, refinement=n, grading=GRADED) for n in (1, 2))
    assert len(two.cells) == 8 * len(one.cells)
    distance, _ = cKDTree(two.points).query(one.points)
    assert distance.max() < 1e-12


@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_any_shaft_without_fillets(data):
    """Random pieces: always sound, closed, of the right volume."""
    pieces = []
    diameter = st.floats(0.3, 1.0)
    for _ in range(data.draw(st.integers(1, 4))):
        bore = data.draw(st.one_of(st.just(0.0), st.floats(0.05, 0.2)))
        end = data.draw(st.one_of(st.none(), diameter))
        length = data.draw(st.floats(0.1, 1.0))
        pieces.append(
            Section(
                length=length,
                outer_diameter=data.draw(diameter),
                outer_diameter_end=end,
                inner_diameter=bore,
            )
        )
    shaft = Shaft(front=0.0, sections=pieces)
    mesh = shaft_hexahedra(shaft, 0.4, 27, elements_per_turn=8)
    assert jacobians(mesh)[0].min() > 0
    assert volume(mesh) == pytest.approx(exact_volume(shaft), rel=2e-3)
    faces = np.sort(np.concatenate([mesh.cells[:, f] for f in FACES]), axis=1)
    assert set(np.unique(faces, axis=0, return_counts=True)[1]) == {1, 2}


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"size": 0.0}, "size is 0 but must be greater than 0"),
        ({"size": float("nan")}, "size is nan"),
        ({"nodes": 10}, "nodes is 10 but must be 8, 20 or 27"),
        ({"refinement": 0}, "refinement is 0"),
        ({"elements_per_turn": 3}, "elements_per_turn is 3"),
        ({"elements_per_turn": 10}, "elements_per_turn is 10.*multiple of 4"),
        ({"grading": Grading(ratio=1.0)}, "ratio is 1"),
        ({"grading": Grading(steps=-1)}, "steps is -1"),
        ({"grading": Grading(ends=-1)}, "ends is -1"),
    ],
)
def test_wrong_settings_are_refused(change, message):
    with pytest.raises(InputError, match=message):
        shaft_hexahedra(ROD, **({"size": 0.5} | change))


def test_fillet_is_refused_with_the_fix():
    shaft = Shaft(
        front=0.0,
        sections=[
            Section(length=1.0, outer_diameter=0.5, inner_diameter=0.1, fillet=0.02),
            Section(length=1.0, outer_diameter=0.7, inner_diameter=0.1),
        ],
    )
    with pytest.raises(InputError, match=r"x = 1 m: fillet is 0.02 m.*set it to 0.*tetrahedra"):
        shaft_hexahedra(shaft, 0.3)


def test_straightened_tetrahedra_keep_corners_and_halve_edges():
    mesh = generate(TUBE, sizes=MeshSizes(shaft=0.3, elements_per_turn=8))
    points = straightened(mesh.points, mesh.cells)
    corners = np.unique(mesh.cells[:, :4])
    np.testing.assert_array_equal(points[corners], mesh.points[corners])
    for k, (a, b) in enumerate([(0, 1), (1, 2), (0, 2), (0, 3), (1, 3), (2, 3)]):
        middle = points[mesh.cells[:, [a, b]]].mean(axis=1)
        np.testing.assert_allclose(points[mesh.cells[:, 4 + k]], middle, atol=1e-15)
    assert np.abs(points - mesh.points).max() > 1e-3
    with pytest.raises(InputError, match="no element has 11 nodes"):
        straightened(points, np.zeros((1, 11), dtype=int))


def test_straightened_hexahedra_lose_the_volume_under_the_arcs():
    mesh = shaft_hexahedra(ROD, 0.5, 20)
    straight = replace(mesh, points=straightened(mesh.points, mesh.cells))
    polygon = 12 / 2 * np.sin(2 * np.pi / 12) * 0.35**2
    assert volume(straight) == pytest.approx(2.0 * polygon, rel=1e-12)


def test_first_order_keeps_the_corners_and_the_node_sets():
    mesh = shaft_hexahedra(STEPPED, 0.5, 27)
    linear = first_order(mesh.points, mesh.cells)
    assert linear.cells.shape == (len(mesh.cells), 8)
    np.testing.assert_array_equal(linear.points[linear.cells], mesh.points[mesh.cells[:, :8]])
    assert len(np.unique(linear.cells)) == len(linear.points)
    front = linear.nodes(mesh.front)
    assert 0 < len(front) < len(mesh.front)
    assert np.all(linear.points[front, 0] == STEPPED.front)
    direct = shaft_hexahedra(STEPPED, 0.5, 8)
    assert len(direct.points) == len(linear.points)
    assert volume(direct) == pytest.approx(volume(linear), rel=1e-13)
    with pytest.raises(InputError, match="no element has 5 nodes"):
        first_order(mesh.points, mesh.cells[:, :5])
