"""A mesh is sound before it is solved: each fault is found, and named with its place."""

from dataclasses import replace

import numpy as np
import pytest

from fe_drivetrain.cases.references import slivers
from fe_drivetrain.cases.stability import faulty_meshes
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, library_scene
from fe_drivetrain.elasticity.mesh.checks import FLATTEST, find_faults, flatness, refuse_unsound
from fe_drivetrain.elasticity.mesh.shared_facets import facet_keys
from fe_drivetrain.shafts.response.conditions import needed_faces
from fe_drivetrain.shafts.response.model import build_model, mesh_scene


@pytest.fixture(scope="module")
def sound():
    return faulty_meshes.sound()


@pytest.fixture(scope="module")
def faulty(sound):
    return {fault.label: fault for fault in faulty_meshes.faulty(sound)}


def test_a_mesh_as_the_program_makes_it_has_no_fault(sound):
    assert find_faults(sound, faulty_meshes.NEEDED) == []
    refuse_unsound(sound, faulty_meshes.NEEDED)


def test_every_fault_is_named_with_its_part_and_place(faulty):
    assert len(faulty) == 13
    for label, fault in faulty.items():
        found = find_faults(fault.mesh, faulty_meshes.NEEDED)
        assert found[0].kind == fault.kind, label
        assert found[0].part == fault.part, label
        assert np.linalg.norm(np.subtract(found[0].place, fault.place)) <= fault.reach, label
        assert "\n" not in found[0].sentence
        assert ": " in found[0].sentence
        with pytest.raises(InputError) as caught:
            refuse_unsound(fault.mesh, faulty_meshes.NEEDED)
        assert found[0].sentence in str(caught.value)


def test_the_element_that_is_named_is_the_one_that_was_spoilt(sound, faulty):
    changed = np.flatnonzero(
        (faulty["two corners exchanged"].mesh.cells != sound.cells).any(axis=1)
    )
    (fault,) = find_faults(faulty["two corners exchanged"].mesh)
    assert [fault.element] == list(changed)
    assert fault.count == 1


def test_nodes_of_a_joint_stand_at_one_place_and_those_of_a_bonded_bearing_must_not(sound):
    assert find_faults(sound, joints=["main_bearing"]) == []
    (fault,) = find_faults(sound, joints=[])
    assert fault.kind == "crack"
    assert fault.count == len(sound.face_nodes("main_bearing.outer"))


def test_a_hinge_is_no_single_piece():
    """Two tetrahedra that share an edge only."""
    corners = np.array([[0, 1, 2, 3], [0, 1, 4, 5]])
    points = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, -1, 0], [0, 0, -1.0]])
    mesh = slivers.as_mesh(points, corners, 10)
    assert find_faults(mesh)[0].kind == "pieces"


def test_flatness_of_known_tetrahedra():
    regular = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1.0]])
    cell = np.array([[0, 1, 2, 3]])
    assert abs(flatness(regular, cell)[0]) == pytest.approx(np.sqrt(2 / 3), rel=1e-14)
    assert flatness(regular, cell[:, [1, 0, 2, 3]])[0] == pytest.approx(
        -flatness(regular, cell)[0], rel=1e-14
    )
    flat = regular * [1, 1, 0]
    assert flatness(flat, cell)[0] == 0.0
    # a corner of a cube: height 1/sqrt(3) over the long facet, longest edge sqrt(2)
    corner = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1.0]])
    assert flatness(corner, cell)[0] == pytest.approx(1 / np.sqrt(6), rel=1e-14)
    turned = corner @ np.linalg.qr(np.random.default_rng(0).standard_normal((3, 3)))[0] * 7.0
    assert abs(flatness(turned, cell)[0]) == pytest.approx(1 / np.sqrt(6), rel=1e-12)


def test_slivers_are_refused_just_where_they_are_too_flat():
    unit = flatness(*_bar(1e-4))[:].min() / 1e-4  # flatness is proportional to the height
    for share, refused in ((2.0, False), (0.5, True), (-0.5, True)):
        mesh = slivers.bar(share * FLATTEST / unit, 2)
        kinds = {fault.kind for fault in find_faults(mesh)}
        assert bool(kinds) is refused
        assert ("inverted" in kinds) is (share < 0)


def _bar(height):
    mesh = slivers.bar(height, 2)
    return mesh.points, mesh.cells


def test_faults_do_not_depend_on_the_numbering(faulty):
    rng = np.random.default_rng(1)
    for label in ("two corners exchanged", "one node of one element doubled"):
        mesh = faulty[label].mesh
        order = rng.permutation(len(mesh.points))
        number = np.argsort(order)
        shuffled = replace(
            mesh,
            points=mesh.points[order],
            cells=number[mesh.cells],
            faces={name: number[face] for name, face in mesh.faces.items()},
        )
        one, two = find_faults(mesh), find_faults(shuffled)
        assert [(f.kind, f.part, f.count) for f in one] == [(f.kind, f.part, f.count) for f in two]
        np.testing.assert_allclose(one[0].place, two[0].place, atol=1e-12)


def test_facets_have_one_key_whatever_their_order():
    corners = np.array([[3, 1, 2], [2, 3, 1], [1, 2, 4], [0, 5, 5]])
    keys = facet_keys(corners, 6)
    assert keys[0] == keys[1]
    assert len(set(keys.tolist())) == 3


def test_a_crack_costs_stiffness_and_merging_its_nodes_gives_it_back():
    torn = faulty_meshes.cracked_bar(0.5, 4)
    assert slivers.bent(torn, "superlu").bending < -0.3
    assert find_faults(torn)[0].kind == "crack"
    merged = faulty_meshes.merged(torn)
    assert find_faults(merged) == []
    assert slivers.bent(merged, "superlu").bending == pytest.approx(0, abs=1e-9)


def test_a_model_is_not_assembled_from_a_faulty_mesh():
    scene = library_scene("main_bearing_spherical")
    sizes = {f"mesh.{kind}": 0.2 for kind in ("shaft", "bearing", "housing", "bearing_edge")}
    scene = change_scene(scene, {**sizes, "mesh.elements_per_turn": 6})
    mesh = mesh_scene(scene)
    assert find_faults(mesh, needed_faces(scene)) == []
    cells = mesh.cells.copy()
    cells[5, [0, 1]] = cells[5, [1, 0]]
    with pytest.raises(InputError, match=r"inverted or fold over.*element 5, near"):
        build_model(scene, replace(mesh, cells=cells))
    faces = {n: f for n, f in mesh.faces.items() if not n.endswith("housing.base")}
    with pytest.raises(InputError, match=r"housing\.base.*is missing"):
        build_model(scene, replace(mesh, faces=faces))
