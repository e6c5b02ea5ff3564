"""A moved mesh: volumes of the changed solids, exact surfaces, and a new mesh where it must be."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.elasticity.mesh.facets import volume_weights
from fe_drivetrain.elasticity.mesh.moving import MovableMesh, shapes_of
from fe_drivetrain.foreign.assembly import solids_of_unit
from fe_drivetrain.shafts.response.conditions import joint_pairs
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.neighbours import parts_of

UNIT = "bearing_units.main_bearing"
STEPPED = {
    "shaft.sections": [
        {"length": 1.4, "outer_diameter": 0.46, "inner_diameter": 0.1, "fillet": 0.02},
        {"length": 0.8, "outer_diameter": 0.4, "inner_diameter": 0.1, "outer_diameter_end": 0.36},
    ]
}


@pytest.fixture(scope="module", params=["bonded", "spherical"])
def scene(request):
    return coarse_scene(request.param, **STEPPED)


@pytest.fixture(scope="module")
def movable(scene):
    return MovableMesh(mesh_scene(scene), parts_of(scene))


def volumes(mesh):
    n = len(mesh.points)
    return {
        part: float(volume_weights(mesh.points, mesh.cells[mesh.part_cells(part)], n).sum())
        for part in mesh.part_names
    }


@pytest.mark.parametrize(
    "changes",
    [
        {"shaft.sections.0.inner_diameter": 0.12, "shaft.sections.1.inner_diameter": 0.12},
        {"shaft.sections.0.outer_diameter": 0.464},
        {"shaft.sections.0.length": 1.5, "shaft.sections.0.fillet": 0.022},
        {f"{UNIT}.housing.wall": 0.125, f"{UNIT}.housing.pedestal_width": 0.86},
        {f"{UNIT}.housing.centre_height": 0.45, f"{UNIT}.housing.foot_thickness": 0.11},
        {f"{UNIT}.housing.width": 0.32, f"{UNIT}.housing.foot_length": 1.3},
        {f"{UNIT}.bearing.raceway_diameter": 0.62, f"{UNIT}.bearing.width": 0.22},
    ],
)
def test_volumes_are_those_of_a_mesh_of_its_own(scene, movable, changes):
    changed = change_scene(scene, changes)
    moved = movable.moved(parts_of(changed), most_stretch=1.5)
    assert moved.mesh is not None, moved.reason
    own = volumes(mesh_scene(changed))
    before = volumes(movable.mesh)
    for part, volume in volumes(moved.mesh).items():
        # both hold curved surfaces by the same few elements
        assert volume == pytest.approx(own[part], rel=4e-3)
        if abs(own[part] / before[part] - 1.0) > 0.02:
            assert abs(volume / own[part] - 1.0) < 0.2 * abs(own[part] / before[part] - 1.0)
    solids = solids_of_unit(changed.bearing_units[0], 0.46, changed.mesh)
    assert set(solids) < set(own)
    build_model(changed, moved.mesh)  # which checks it like a mesh of its own


def test_surfaces_are_exact(scene, movable):
    changed = change_scene(
        scene, {"shaft.front": -1.05, f"{UNIT}.housing.centre_height": 0.44} | wider(0.464)
    )
    moved = movable.moved(parts_of(changed), most_stretch=1.5)
    assert moved.mesh is not None, moved.reason
    mesh = moved.mesh
    at = {name: mesh.points[mesh.face_nodes(name)] for name in mesh.faces}
    assert at["shaft.front"][:, 0] == pytest.approx(-1.05, abs=1e-12)
    seat = at["shaft.seat.main_bearing"]
    assert np.hypot(seat[:, 1], seat[:, 2]) == pytest.approx(0.232, abs=1e-9)
    assert [seat[:, 0].min(), seat[:, 0].max()] == pytest.approx([-0.1, 0.1], abs=1e-9)
    assert at["main_bearing.housing.base"][:, 2] == pytest.approx(-0.44, abs=1e-9)
    if scene.bearing_units[0].interface != "bonded":
        joint_pairs(mesh, "main_bearing")  # refuses nodes that are apart


def wider(diameter):
    return {"shaft.sections.0.outer_diameter": diameter}


def test_a_linear_motion_is_carried_exactly():
    scene = coarse_scene("bonded")
    longer = change_scene(
        scene,
        {
            f"{UNIT}.bearing.width": 0.22,
            f"{UNIT}.housing.width": 0.33,
            f"{UNIT}.housing.foot_width": 0.396,
            "shaft.front": -1.1,
            "shaft.sections.0.length": 2.42,
        },
    )
    movable = MovableMesh(mesh_scene(scene), parts_of(scene))
    found = movable.moved(parts_of(longer)).mesh.points
    expected = movable.mesh.points * [1.1, 1.0, 1.0]
    np.testing.assert_allclose(found, expected, atol=1e-9)


def test_the_same_parts_are_the_same_mesh(scene, movable):
    other = change_scene(scene, {"gearbox.weight": 1.0})
    assert movable.moved(parts_of(other)).mesh is movable.mesh


@pytest.mark.parametrize(
    ("changes", "reason"),
    [
        ({"shaft.sections.0.inner_diameter": 0.3}, "has another outline"),
        ({"shaft.sections.0.length": 1.31}, "an edge would change by a factor"),
        ({"mesh.shaft": 0.2}, "other sizes of elements"),
        ({f"{UNIT}.housing.base": "bolted"}, "has other faces"),
    ],
)
def test_what_cannot_be_moved_is_meshed_again(scene, movable, changes, reason):
    changed = change_scene(scene, changes)
    found = movable.moved(parts_of(changed), most_stretch=1.2)
    assert found.mesh is None
    assert reason in found.reason


def test_elements_that_would_lose_their_shape_are_meshed_again(scene, movable):
    thin = change_scene(scene, {f"{UNIT}.housing.wall": 0.061})
    found = movable.moved(parts_of(thin), most_stretch=10.0)
    assert found.mesh is not None
    assert found.shape < 0.85
    refused = movable.moved(parts_of(thin), found.shape + 1e-6, 10.0)
    assert refused.mesh is None
    assert "of its shape" in refused.reason


def test_bolt_holes_stay_round_and_move_along():
    scene = coarse_scene("bonded", **{f"{UNIT}.housing.base": "bolted"})
    changed = change_scene(scene, {f"{UNIT}.housing.bolt_spacing_y": 1.08})
    movable = MovableMesh(mesh_scene(scene), parts_of(scene))
    mesh = movable.moved(parts_of(changed), most_stretch=1.5).mesh
    places = mesh.points[mesh.face_nodes("main_bearing.housing.base")]
    away = np.hypot(np.abs(places[:, 0]) - 0.1, np.abs(places[:, 1]) - 0.54)
    assert away.min() == pytest.approx(0.026, rel=1e-3)
    assert away.max() == pytest.approx(0.046, rel=1e-3)


def test_the_shape_of_tetrahedra():
    regular = np.array([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1.0]])
    turned, flat = regular[[1, 0, 2, 3]], regular * [1, 1, 1e-9]
    points = np.concatenate([regular, turned, flat])
    sizes = np.abs(shapes_of(points, np.arange(12).reshape(3, 4)))
    np.testing.assert_allclose(sizes[:2], 1.0, rtol=1e-12)
    signs = shapes_of(points, np.arange(8).reshape(2, 4))
    assert signs[0] == pytest.approx(-signs[1])
    assert sizes[2] < 1e-5
