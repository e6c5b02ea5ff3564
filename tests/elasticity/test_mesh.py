"""The mesh: exact shapes, named faces, joints, element quality, and the files it writes."""

import math

import gmsh
import meshio
import numpy as np
import pytest
from skfem import Basis, ElementTetP2, Functional

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.elasticity.mesh.files import write
from fe_drivetrain.elasticity.mesh.generation import GMSH_TO_VTK, generate, relax_flat_cells
from fe_drivetrain.elasticity.mesh.measures import (
    CUBIC,
    area,
    area_vectors,
    inverted_cells,
    jacobians,
    quality,
    scaled_jacobians,
    volume,
)
from fe_drivetrain.elasticity.mesh.mesh import Mesh, boundary, part_of
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES
from fe_drivetrain.geometry import (
    Bearing,
    Flange,
    Housing,
    MeshSizes,
    Section,
    Shaft,
    build,
    gmsh_session,
)

COARSE = MeshSizes(shaft=0.2, bearing=0.1, housing=0.12)
TURN = COARSE.elements_per_turn


def sagging(turn):
    """Relative error of a circle's area when drawn with parabolas through `turn` + `turn` points.

    Each parabola has two thirds of the area of the rectangle round it.
    """
    a = math.pi / turn
    drawn = turn * (math.sin(a) * math.cos(a) + 4 / 3 * math.sin(a) * (1 - math.cos(a)))
    return 1 - drawn / math.pi


# an element may come out longer than the size asked for: three quarters of the number a turn
SHAPE_ERROR = sagging(0.75 * TURN)


def plain_shaft(length=1.0, outer=0.4, inner=0.0, front=-0.5):
    section = Section(length=length, outer_diameter=outer, inner_diameter=inner)
    return Shaft(front=front, sections=(section,))


def unit(bonded, **housing):
    bearing = Bearing()
    return generate(
        plain_shaft(),
        [bearing],
        {bearing.name: Housing(**housing)},
        COARSE,
        frozenset({bearing.name}) if bonded else frozenset(),
    )


@pytest.fixture(scope="module")
def joint():
    return unit(bonded=False)


@pytest.fixture(scope="module")
def bonded():
    return unit(bonded=True)


@pytest.fixture(scope="module")
def two():
    bearings = [
        Bearing(name="front", x=-0.6),
        Bearing(name="rear", x=0.7, kind="ring", raceway_diameter=0.56, width=0.16),
    ]
    return generate(
        Shaft(
            front=-1.2,
            flange=Flange(outer_diameter=0.8, thickness=0.1),
            sections=(
                Section(length=1.1, outer_diameter=0.4, inner_diameter=0.2, fillet=0.04),
                Section(length=0.2, outer_diameter=0.5, inner_diameter=0.2),
                Section(length=0.8, outer_diameter=0.4, inner_diameter=0.2),
                Section(
                    length=0.3, outer_diameter=0.4, outer_diameter_end=0.36, inner_diameter=0.2
                ),
            ),
        ),
        bearings,
        {"front": Housing(), "rear": Housing(base="bolted")},
        COARSE,
        frozenset({"rear"}),
    )


# shapes


@pytest.mark.parametrize(
    ("shaft", "exact"),
    [
        (plain_shaft(), math.pi * 0.2**2),
        (plain_shaft(inner=0.2), math.pi * (0.2**2 - 0.1**2)),
        (plain_shaft(inner=0.3), math.pi * (0.2**2 - 0.15**2)),
        (
            Shaft(
                front=0,
                sections=(
                    Section(length=0.6, outer_diameter=0.4),
                    Section(length=0.4, outer_diameter=0.5),
                ),
            ),
            math.pi * (0.6 * 0.2**2 + 0.4 * 0.25**2),
        ),
        (
            Shaft(
                front=0,
                sections=(Section(length=1, outer_diameter=0.6, outer_diameter_end=0.3),),
            ),
            math.pi / 3 * (0.3**2 + 0.3 * 0.15 + 0.15**2),
        ),
        # the fillet's volume by Pappus, see test_geometry
        (
            Shaft(
                front=0,
                sections=(
                    Section(length=0.6, outer_diameter=0.4, fillet=0.05),
                    Section(length=0.4, outer_diameter=0.5),
                ),
            ),
            math.pi * (0.6 * 0.2**2 + 0.4 * 0.25**2)
            + 2
            * math.pi
            * (0.2 + 0.05 * (10 - 3 * math.pi) / (12 - 3 * math.pi))
            * 0.05**2
            * (1 - math.pi / 4),
        ),
    ],
    ids=["solid", "bore 0.2", "bore 0.3", "stepped", "tapered", "filleted"],
)
def test_volume_of_a_curved_shaft_mesh(shaft, exact):
    mesh = generate(shaft, sizes=COARSE)
    outer = max(p.outer_diameter for p in shaft.pieces) / 2
    # a bore too large and an outside too small by the shape error, at worst
    worst = SHAPE_ERROR * math.pi * outer**2
    assert volume(mesh) == pytest.approx(exact, abs=worst)
    assert quality(mesh).inverted == 0


def test_volume_converges_with_the_fourth_power_of_the_element_size():
    exact = math.pi * 0.2**2
    errors = []
    for turn in (6, 12):
        sizes = MeshSizes(shaft=1, elements_per_turn=turn)
        errors.append(abs(volume(generate(plain_shaft(), sizes=sizes)) / exact - 1))
    # straight-sided elements would gain 4, curved ones 16, give or take how edges divide the turn
    assert errors[0] / errors[1] > 8


def test_volume_of_bearing_and_housing(joint):
    housing = Housing()
    zone = [math.pi * (0.3**2 * w - w**3 / 12) for w in (0.2, housing.width)]
    block = housing.width * (math.pi * 0.41**2 / 2 + 0.82 * 0.32)
    foot = housing.foot_length * housing.foot_width * housing.foot_thickness
    bearing = zone[0] - math.pi * 0.2**2 * 0.2
    assert volume(joint, "main_bearing") == pytest.approx(bearing, abs=SHAPE_ERROR * zone[0])
    assert volume(joint, "main_bearing.housing") == pytest.approx(
        block + foot - zone[1], abs=SHAPE_ERROR * block
    )
    parts = [volume(joint, name) for name in joint.part_names]
    assert volume(joint) == pytest.approx(math.fsum(parts), rel=1e-12)


def test_areas_of_the_named_faces(joint, two):
    disc, housing = math.pi * 0.2**2, Housing()
    for mesh, face, exact, rounding in (
        (joint, "shaft.front", disc, SHAPE_ERROR),
        (joint, "shaft.rear", disc, SHAPE_ERROR),
        (joint, "shaft.seat.main_bearing", math.pi * 0.4 * 0.2, SHAPE_ERROR),
        (joint, "main_bearing.bore", math.pi * 0.4 * 0.2, SHAPE_ERROR),
        (joint, "main_bearing.outer", 2 * math.pi * 0.3 * 0.2, SHAPE_ERROR),
        (joint, "main_bearing.housing.bore", 2 * math.pi * 0.3 * 0.2, SHAPE_ERROR),
        (joint, "main_bearing.housing.base", 1.25 * 0.36, 1e-12),
        (two, "rear.outer", math.pi * 0.56 * 0.16, SHAPE_ERROR),
        (two, "shaft.bore", math.pi * 0.2 * 2.5, SHAPE_ERROR),
    ):
        assert area(mesh, face) == pytest.approx(exact, rel=rounding), face
    ring = math.pi * (housing.washer_diameter**2 - housing.bolt_diameter**2)
    circle = math.pi * housing.washer_diameter**2
    assert area(two, "rear.housing.base") == pytest.approx(ring, abs=SHAPE_ERROR * circle)


def test_every_node_of_a_named_face_lies_on_it(joint, two):
    def radii(mesh, face, x, sphere):
        points = mesh.points[mesh.face_nodes(face)] - [x, 0, 0]
        return np.linalg.norm(points if sphere else points[:, 1:], axis=1)

    for mesh, face, x, sphere, radius in (
        (joint, "shaft.seat.main_bearing", 0, False, 0.2),
        (joint, "main_bearing.bore", 0, False, 0.2),
        (joint, "main_bearing.outer", 0, True, 0.3),
        (joint, "main_bearing.housing.bore", 0, True, 0.3),
        (two, "front.outer", -0.6, True, 0.3),
        (two, "front.housing.bore", -0.6, True, 0.3),
        (two, "shaft.seat.rear", 0.7, False, 0.2),
        (two, "rear.housing.bore", 0.7, False, 0.28),
        (two, "shaft.bore", 0, False, 0.1),
    ):
        np.testing.assert_allclose(radii(mesh, face, x, sphere), radius, rtol=0, atol=1e-12)
    for face, axis, at in (
        ("shaft.front", 0, -1.2),
        ("shaft.rear", 0, 1.3),
        ("front.housing.base", 2, -0.42),
        ("rear.housing.base", 2, -0.42),
    ):
        np.testing.assert_allclose(two.points[two.face_nodes(face), axis], at, rtol=0, atol=1e-12)


def test_a_seat_begins_and_ends_exactly_where_its_bearing_does(joint, two):
    for mesh, face, low, high in (
        (joint, "shaft.seat.main_bearing", -0.1, 0.1),
        (joint, "main_bearing.housing.bore", -0.1, 0.1),
        (two, "shaft.seat.rear", 0.62, 0.78),
    ):
        x = mesh.points[mesh.face_nodes(face), 0]
        assert [x.min(), x.max()] == pytest.approx([low, high], abs=1e-12)


def test_named_points_are_nodes_at_their_places(joint, two):
    for mesh, name, x in (
        (joint, "main_bearing", 0),
        (two, "front", -0.6),
    ):
        places = {
            "top": (x, 0, 0.41),
            "side_left": (x, 0.41, 0),
            "side_right": (x, -0.41, 0),
            "bedplate": (x, 0, -0.42),
        }
        for where, place in places.items():
            node = mesh.named_points[f"{name}.housing.{where}"]
            np.testing.assert_allclose(mesh.points[node], place, rtol=0, atol=1e-12)
            assert node in mesh.part_nodes(f"{name}.housing")
    assert two.named_points["front.housing.bedplate"] in two.face_nodes("front.housing.base")


# topology


def facets_of(mesh):
    """Sorted corners of every facet of every cell, (4 ne, 3), and how often each occurs."""
    corners = np.sort(mesh.cells[:, [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 3]]], axis=2)
    return np.unique(corners.reshape(-1, 3), axis=0, return_counts=True)


def rows(array):
    return {tuple(row) for row in np.sort(array, axis=1)}


def test_no_facet_belongs_to_more_than_two_cells_and_no_node_to_none(joint, bonded, two):
    for mesh in (joint, bonded, two):
        facets, count = facets_of(mesh)
        assert set(count) == {1, 2}
        assert rows(boundary(mesh)[:, :3]) == rows(facets[count == 1])
        np.testing.assert_array_equal(np.unique(mesh.cells), np.arange(len(mesh.points)))


def test_the_surface_of_each_part_is_closed_and_encloses_its_volume(joint, two):
    for mesh in (joint, two):
        for part in mesh.part_names:
            facets = boundary(mesh, part)
            vectors = area_vectors(mesh.points, facets)
            np.testing.assert_allclose(vectors.sum(axis=0), 0, atol=1e-14)
            # one third of the flux of x out of the surface, each facet by its mid-side nodes:
            # exact for flat facets only, so the curved ones set the tolerance
            middles = mesh.points[facets[:, 3:]].mean(axis=1)
            flux = np.einsum("fi,fi->", middles, vectors) / 3
            assert flux == pytest.approx(volume(mesh, part), rel=0.02)


def test_named_faces_point_outward_from_their_part(joint):
    def outward(face, direction):
        facets = joint.faces[face]
        vectors = area_vectors(joint.points, facets)
        middles = joint.points[facets[:, 3:]].mean(axis=1)
        return np.einsum("fi,fi->f", vectors, direction(middles))

    away = {"shaft.seat.main_bearing": 1, "main_bearing.bore": -1}
    for face, sign in away.items():
        assert (sign * outward(face, lambda p: p * [0, 1, 1]) > 0).all(), face
    for face, sign in {"main_bearing.outer": 1, "main_bearing.housing.bore": -1}.items():
        assert (sign * outward(face, lambda p: p) > 0).all(), face
    for face, normal in (
        ("shaft.front", [-1, 0, 0]),
        ("shaft.rear", [1, 0, 0]),
        ("main_bearing.housing.base", [0, 0, -1]),
    ):
        total = area_vectors(joint.points, joint.faces[face]).sum(axis=0)
        np.testing.assert_allclose(total, area(joint, face) * np.array(normal), atol=1e-12)


def test_each_named_face_belongs_to_its_own_part(joint, bonded, two):
    for mesh in (joint, bonded, two):
        for face, facets in mesh.faces.items():
            assert rows(facets) <= rows(boundary(mesh, part_of(face, mesh.part_names))), face


def test_part_of_takes_the_longest_name():
    names = ("shaft", "a", "a.housing")
    assert part_of("a.housing.bore", names) == "a.housing"
    assert part_of("a.outer", names) == "a"
    assert part_of("shaft.seat.a", names) == "shaft"


def test_a_bonded_face_shares_its_nodes(bonded):
    outer, bore = (bonded.face_nodes(f"main_bearing.{n}") for n in ("outer", "housing.bore"))
    np.testing.assert_array_equal(outer, bore)
    shared = np.intersect1d(
        bonded.part_nodes("main_bearing"), bonded.part_nodes("main_bearing.housing")
    )
    np.testing.assert_array_equal(shared, outer)
    seat = np.intersect1d(bonded.part_nodes("shaft"), bonded.part_nodes("main_bearing"))
    np.testing.assert_array_equal(seat, bonded.face_nodes("shaft.seat.main_bearing"))


def test_the_two_sides_of_a_joint_match_node_for_node_and_share_none(joint, bonded):
    housing = joint.part_nodes("main_bearing.housing")
    assert len(np.intersect1d(housing, joint.part_nodes("main_bearing"))) == 0
    assert len(np.intersect1d(housing, joint.part_nodes("shaft"))) == 0
    outer, bore = (
        joint.points[joint.face_nodes(f"main_bearing.{n}")] for n in ("outer", "housing.bore")
    )

    def ordered(points):
        return points[np.lexsort(points.T)]

    np.testing.assert_array_equal(ordered(outer), ordered(bore))
    assert len(np.unique(outer, axis=0)) == len(outer)
    # the facets match too, so that the nodes' areas do
    assert area(joint, "main_bearing.outer") == pytest.approx(
        area(joint, "main_bearing.housing.bore"), rel=1e-14
    )
    # the joint is the bonded mesh with its face doubled, nothing else
    assert len(joint.points) == len(bonded.points) + len(outer)
    split, whole = (
        ordered(mesh.points[mesh.cells].reshape(len(mesh.cells), -1)) for mesh in (joint, bonded)
    )
    np.testing.assert_array_equal(split, whole)


def test_neighbours_have_numbers_near_each_other(joint):
    """A numbering at random has cells that span half of all the nodes."""
    span = np.ptp(joint.cells, axis=1) / len(joint.points)
    assert np.median(span) < 0.1


def test_each_bearing_is_bonded_or_not_on_its_own(two):
    for name, shared in (("front", False), ("rear", True)):
        common = np.intersect1d(two.part_nodes(name), two.part_nodes(f"{name}.housing"))
        assert (len(common) > 0) is shared


def test_same_input_same_mesh(joint):
    again = unit(bonded=False)
    for name in ("points", "cells", "part"):
        np.testing.assert_array_equal(getattr(again, name), getattr(joint, name))
    assert list(again.faces) == list(joint.faces)
    for name, facets in again.faces.items():
        np.testing.assert_array_equal(facets, joint.faces[name])
    assert again.named_points == joint.named_points


def test_bearing_unit_and_shaft_can_stand_alone():
    bearing = Bearing(bore_diameter=0.4)
    alone = generate(None, [bearing], {bearing.name: Housing()}, COARSE)
    assert alone.part_names == ("main_bearing", "main_bearing.housing")
    assert area(alone, "main_bearing.bore") == pytest.approx(math.pi * 0.4 * 0.2, rel=SHAPE_ERROR)
    shaft = generate(plain_shaft(), sizes=COARSE)
    assert shaft.part_names == ("shaft",)
    assert set(shaft.faces) == {"shaft.front", "shaft.rear"}
    without = generate(plain_shaft(), [Bearing()], sizes=COARSE)
    assert area(without, "main_bearing.outer") == pytest.approx(
        2 * math.pi * 0.3 * 0.2, rel=SHAPE_ERROR
    )


def test_details_far_smaller_than_the_mesh_size_fold_nothing():
    # a step of half a millimetre in radius: straight edges on its two circles would cross
    low_step = Shaft(
        front=0,
        sections=(
            Section(length=0.5, outer_diameter=0.458),
            Section(length=0.5, outer_diameter=0.459),
        ),
    )
    mesh = generate(low_step, sizes=COARSE)
    assert quality(mesh).inverted == 0
    exact = math.pi / 8 * (0.458**2 + 0.459**2)
    assert volume(mesh) == pytest.approx(exact, rel=SHAPE_ERROR)
    # a housing two millimetres wider than its bearing on either side
    ring = Bearing(kind="ring", raceway_diameter=0.6, width=0.146)
    rim = generate(plain_shaft(), [ring], {ring.name: Housing(width=0.15)}, COARSE)
    assert quality(rim).inverted == 0


def test_finer_sizes_leave_the_other_kinds_alone():
    finer = COARSE.finer({"housing"}, 1.5)
    assert finer == COARSE.model_copy(update={"housing": COARSE.housing / 1.5})
    assert COARSE.finer({"shaft"}, 1.5).elements_per_turn == 18


def test_scaled_sizes_make_a_coarser_mesh(joint):
    bearing = Bearing()
    housings = {bearing.name: Housing()}
    finer = generate(plain_shaft(), [bearing], housings, COARSE.scaled(0.6))
    assert len(finer.points) > 1.5 * len(joint.points)


def test_unknown_names_are_refused(joint):
    with pytest.raises(InputError, match="no part 'hub'"):
        joint.part_cells("hub")
    with pytest.raises(InputError, match=r"no face 'shaft\.side'"):
        joint.face_nodes("shaft.side")


# quality

REFERENCE = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])


def one_cell(shift=0.0, seed=0):
    """The reference tetrahedron, its ten nodes moved at random by up to `shift`."""
    nodes = np.concatenate(
        [REFERENCE, [(REFERENCE[a] + REFERENCE[b]) / 2 for a, b in TETRAHEDRON_EDGES]]
    )
    nodes = nodes + np.random.default_rng(seed).uniform(-shift, shift, nodes.shape)
    return Mesh(nodes, np.arange(10)[None], np.zeros(1, dtype=int), ("shaft",), {}, {})


def lattice(order):
    return (
        np.array(
            [
                (order - i - j - k, i, j, k)
                for i in range(order + 1)
                for j in range(order + 1 - i)
                for k in range(order + 1 - i - j)
            ]
        )
        / order
    )


def test_a_straight_element_has_scaled_jacobian_one_and_its_own_volume():
    cell = one_cell()
    assert quality(cell).minimum_scaled_jacobian == pytest.approx(1, rel=1e-14)
    assert volume(cell) == pytest.approx(1 / 6, rel=1e-14)
    np.testing.assert_allclose(jacobians(cell.points, cell.cells, lattice(5)), 1, rtol=1e-13)


def test_validity_agrees_with_dense_sampling_inside_the_element():
    dense = lattice(24)
    seen = {True: 0, False: 0}
    for seed in range(300):
        cell = one_cell(shift=0.2, seed=seed)
        least = jacobians(cell.points, cell.cells, dense).min()
        # between these the sampling itself cannot tell
        if abs(least) > 0.02:
            valid = len(inverted_cells(cell)) == 0
            assert valid == (least > 0), seed
            seen[valid] += 1
    assert min(seen.values()) > 50


def test_an_element_that_folds_between_its_nodes_is_found():
    for seed in range(2000):
        cell = one_cell(shift=0.2, seed=seed)
        at_nodes = jacobians(cell.points, cell.cells, np.eye(4)).min()
        inside = jacobians(cell.points, cell.cells, lattice(24)).min()
        if at_nodes > 0.1 and inside < -0.05:
            break
    else:
        pytest.fail("no such element among the trials")
    assert list(inverted_cells(cell)) == [0]
    assert quality(cell).inverted == 1


def test_jacobians_agree_with_gmsh():
    bearing = Bearing()
    with gmsh_session():
        build(plain_shaft(), [bearing], {bearing.name: Housing()}, COARSE)
        gmsh.model.mesh.generate(3)
        gmsh.model.mesh.setOrder(2)
        tags, coordinates, _ = gmsh.model.mesh.getNodes()
        elements, nodes = gmsh.model.mesh.getElementsByType(11)
        least = gmsh.model.mesh.getElementQualities(elements, "minDetJac")
        scaled = gmsh.model.mesh.getElementQualities(elements, "minSJ")
    order = np.argsort(tags)
    points = coordinates.reshape(-1, 3)[order]
    cells = np.searchsorted(tags[order], nodes.reshape(-1, 10))[:, GMSH_TO_VTK]
    # gmsh samples other points of some elements, and narrows the least Jacobian to a tolerance
    np.testing.assert_allclose(scaled_jacobians(points, cells), scaled, rtol=5e-3)
    ours = jacobians(points, cells, CUBIC).min(axis=1)
    np.testing.assert_allclose(ours, least, rtol=5e-3)
    assert scaled.min() < 0.9, "some elements must be curved for this to mean anything"


def test_a_straight_element_turned_inside_out_is_found():
    cell = one_cell()
    mirrored = Mesh(cell.points * [-1, 1, 1], cell.cells, cell.part, cell.part_names, {}, {})
    assert list(inverted_cells(cell)) == []
    assert list(inverted_cells(mirrored)) == [0]
    flat = Mesh(cell.points * [1, 1, 0], cell.cells, cell.part, cell.part_names, {}, {})
    assert list(inverted_cells(flat)) == [0]


def test_quality_counts_and_parts(joint):
    report = quality(joint)
    assert (report.elements, report.nodes) == (len(joint.cells), len(joint.points))
    assert report.inverted == 0
    assert set(report.minimum_scaled_jacobian_of) == set(joint.part_names)
    assert report.minimum_scaled_jacobian == min(report.minimum_scaled_jacobian_of.values())
    assert 0 < report.minimum_scaled_jacobian <= 1


def folded():
    """Two cells side by side, the edge they share pushed far into the first."""
    corners = np.concatenate([REFERENCE, [[1.0, 1, 1]]])
    cells, nodes, mids = [], list(corners), {}
    for tetrahedron in ((0, 1, 2, 3), (1, 2, 3, 4)):
        cell = list(tetrahedron)
        for a, b in TETRAHEDRON_EDGES:
            edge = tuple(sorted((tetrahedron[a], tetrahedron[b])))
            if edge not in mids:
                mids[edge] = len(nodes)
                nodes.append((corners[edge[0]] + corners[edge[1]]) / 2)
            cell.append(mids[edge])
        cells.append(cell)
    points = np.array(nodes)
    points[mids[1, 2]] = [0.1, 0.1, 0.1]
    return points, np.array(cells), mids


def test_relaxing_mends_a_folded_cell_and_moves_no_other_node():
    points, cells, mids = folded()
    mesh = Mesh(points, cells, np.zeros(2, dtype=int), ("shaft",), {}, {})
    assert len(inverted_cells(mesh)) > 0
    relaxed = relax_flat_cells(mesh)
    assert len(inverted_cells(relaxed)) == 0
    moved = np.flatnonzero(np.abs(relaxed.points - points).max(axis=1) > 1e-15)
    assert list(moved) == [mids[1, 2]]


def test_relaxing_leaves_seats_and_joints_exactly_where_they_are():
    points, cells, mids = folded()
    face = np.array([[1, 2, 3, mids[1, 2], mids[2, 3], mids[1, 3]]])
    mesh = Mesh(points, cells, np.zeros(2, dtype=int), ("shaft",), {"shaft.seat.a": face}, {})
    np.testing.assert_array_equal(relax_flat_cells(mesh).points, points)


def test_elements_that_stay_inverted_are_refused_with_their_place(monkeypatch):
    monkeypatch.setattr(
        "fe_drivetrain.elasticity.mesh.generation.inverted_cells", lambda mesh: np.array([0])
    )
    with pytest.raises(InputError, match=r"part 'shaft': 1 of its .* near \(.*\) m.*reduce"):
        generate(plain_shaft(), sizes=COARSE)


# other libraries and files


@Functional
def one(w):
    return 1.0 + 0.0 * w.x[0]


def test_scikit_fem_finds_the_same_volume_and_boundary(joint):
    for part in (None, *joint.part_names):
        mesh = joint.as_skfem(part)
        basis = Basis(mesh, ElementTetP2(), intorder=4)
        assert one.assemble(basis) == pytest.approx(volume(joint, part), rel=1e-12)
        assert len(mesh.boundary_facets()) == len(boundary(joint, part))
        nodes = len(joint.points) if part is None else len(joint.part_nodes(part))
        assert mesh.doflocs.shape == (3, nodes)


@pytest.mark.parametrize("suffix", [".vtu", ".msh"])
def test_a_written_mesh_reads_back(joint, tmp_path, suffix):
    displacement = joint.points * [1, 2, 3]
    heat = joint.points[:, 0].copy()
    path = tmp_path / f"unit{suffix}"
    write(joint, path, {"displacement": displacement, "heat": heat})
    assert [p.name for p in tmp_path.iterdir()] == [path.name]
    read = meshio.read(path)
    np.testing.assert_allclose(read.points, joint.points, rtol=0, atol=1e-15)
    np.testing.assert_allclose(read.point_data["displacement"], displacement, atol=1e-15)
    np.testing.assert_allclose(np.ravel(read.point_data["heat"]), heat, atol=1e-15)
    key = "part" if suffix == ".vtu" else "gmsh:physical"
    blocks = zip(read.cells, read.cell_data[key], strict=True)
    solids = [(b.data, tags) for b, tags in blocks if b.type == "tetra10"]
    cells = np.concatenate([c for c, _ in solids])
    tags = np.concatenate([t for _, t in solids])
    np.testing.assert_array_equal(cells, joint.cells)
    if suffix == ".vtu":
        np.testing.assert_array_equal(tags, joint.part)
        return
    names = {int(tag): name for name, (tag, dim) in read.field_data.items() if dim == 3}
    assert [names[int(t)] for t in tags] == [joint.part_names[i] for i in joint.part]


def test_gmsh_opens_the_written_mesh_and_finds_it_sound(joint, tmp_path):
    write(joint, tmp_path / "unit.msh", {"heat": joint.points[:, 0]})
    with gmsh_session():
        gmsh.merge(str(tmp_path / "unit.msh"))
        groups = {
            gmsh.model.getPhysicalName(dim, tag): (dim, tag)
            for dim, tag in gmsh.model.getPhysicalGroups()
        }
        assert set(groups) == {*joint.part_names, *joint.faces, *joint.named_points}
        for name in joint.part_names:
            (entity,) = gmsh.model.getEntitiesForPhysicalGroup(*groups[name])
            elements, _ = gmsh.model.mesh.getElementsByType(11, entity)
            assert len(elements) == len(joint.part_cells(name))
            # wrongly ordered mid-side nodes would fold the elements over
            assert gmsh.model.mesh.getElementQualities(elements, "minDetJac").min() > 0
            at, weights = gmsh.model.mesh.getIntegrationPoints(11, "Gauss4")
            _, determinants, _ = gmsh.model.mesh.getJacobians(11, at, entity)
            total = (determinants.reshape(len(elements), -1) @ weights).sum()
            assert total == pytest.approx(volume(joint, name), rel=1e-10)


def test_vtk_opens_the_written_mesh_and_finds_the_same_volume(joint, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    write(joint, tmp_path / "unit.vtu")
    grid = pyvista.read(tmp_path / "unit.vtu")
    assert grid.n_cells == len(joint.cells)
    assert set(grid.celltypes) == {24}, "VTK_QUADRATIC_TETRA"
    # VTK measures the straight-sided pieces of a curved cell
    assert grid.volume == pytest.approx(volume(joint), rel=0.02)


def test_a_failed_write_leaves_the_last_good_file(joint, tmp_path, monkeypatch):
    path = tmp_path / "unit.vtu"
    write(joint, path)
    good = path.read_bytes()

    def breaks(target, *_, **__):
        target.write_text("half a file")
        raise OSError("disk full")

    monkeypatch.setattr(meshio, "write", breaks)
    with pytest.raises(OSError, match="disk full"):
        write(joint, path)
    assert path.read_bytes() == good
    assert list(tmp_path.iterdir()) == [path]


@pytest.mark.parametrize(
    ("name", "data", "words"),
    [
        ("unit.stl", {}, r"use \.vtu or \.msh"),
        ("missing/unit.vtu", {}, "there is no folder"),
        ("unit.vtu", {"u": np.zeros((3, 3))}, r"'u' has shape \(3, 3\) but must have"),
    ],
)
def test_a_wrong_file_or_wrong_data_is_refused(joint, tmp_path, name, data, words):
    with pytest.raises(InputError, match=words):
        write(joint, tmp_path / name, data)
    assert list(tmp_path.iterdir()) == []
