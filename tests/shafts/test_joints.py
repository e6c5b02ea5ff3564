"""Joints between bearing and housing: their limits, their balance, and what they add up to."""

from typing import Any

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.joint_springs import joint_stiffness, roller_lines
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.interfaces.joints import in_series, roller_loads
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.shafts.fidelity.bearing_units import unit_stiffness
from fe_drivetrain.shafts.response.model import Model, build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import Response, unit_load_response

HELD: list[Any] = ["rigid", "rigid", "rigid"]
ROWS = [{"x": -0.05, "contact_angle": -20.0}, {"x": 0.05, "contact_angle": 20.0}]
BEDPLATE = [2e9, 3e9, 4e9, 5e8, 6e8, "rigid"]


def with_unit(scene: Scene, **unit: Any) -> Scene:
    return change_scene(scene, {f"bearing_units.0.{key}": value for key, value in unit.items()})


def solved(scene: Scene, mesh: Mesh | None = None) -> tuple[Model, Response]:
    model = build_model(scene, mesh_scene(scene) if mesh is None else mesh)
    return model, unit_load_response(model)


def tapered(**more: Any) -> Scene:
    """A ring on two rows of rollers, in an O arrangement."""
    rollers = {"count": 20, "stiffness": 1e9, "rows": ROWS}
    return with_unit(coarse_scene("bonded"), interface="rollers", rollers=rollers, **more)


def test_a_row_of_rollers_adds_up_as_theory_has_it() -> None:
    k, n, x, lean = 3e8, 17, 0.04, np.radians(12.0)
    row = {"x": x, "contact_angle": 12.0}
    rollers = {"count": n, "stiffness": k, "rows": [row]}
    unit = with_unit(coarse_scene("bonded"), interface="rollers", rollers=rollers).bearing_units[0]
    r = unit.bearing.raceway_diameter / 2
    K = joint_stiffness(unit)
    radial = n / 2 * k * np.cos(lean) ** 2
    arm = r * np.sin(lean) - x * np.cos(lean)
    expected = [n * k * np.sin(lean) ** 2, radial, radial, 0.0, *[n / 2 * k * arm**2] * 2]
    np.testing.assert_allclose(K.diagonal(), expected, rtol=1e-12, atol=1e-9 * radial)


def test_rollers_know_their_bearing_s_centre_and_no_other_point() -> None:
    unit = tapered().bearing_units[0]
    moved = unit.model_copy(update={"bearing": unit.bearing.model_copy(update={"x": 1.7})})
    assert unit.bearing.x != 1.7
    for of in (joint_stiffness, roller_lines):
        size = np.abs(of(unit)).max()
        np.testing.assert_allclose(of(moved), of(unit), rtol=1e-9, atol=1e-9 * size)


def test_rollers_on_a_sphere_carry_no_moment() -> None:
    rollers = {"count": 11, "stiffness": 1e9, "rows": [{"x": -0.06}, {"x": 0.05}]}
    unit = with_unit(coarse_scene("spherical"), interface="rollers", rollers=rollers)
    K = joint_stiffness(unit.bearing_units[0])
    assert np.abs(K[3:]).max() < 1e-9 * K[1, 1]
    assert K[0, 0] > 0


def test_springs_in_series(rng: np.random.Generator) -> None:
    A, B = (a @ a.T for a in rng.normal(size=(2, 6, 6)))
    both = np.linalg.inv(np.linalg.inv(A) + np.linalg.inv(B))
    np.testing.assert_allclose(in_series(A, B), both, rtol=1e-9)
    np.testing.assert_allclose(in_series(A, np.diag(np.full(6, np.inf))), A, rtol=1e-9)
    # free in rotation: what is left of A where its rotations carry nothing
    ball = in_series(A, np.diag(np.r_[[np.inf] * 3, [0.0] * 3]))
    np.testing.assert_allclose(ball[:3, :3], np.linalg.inv(np.linalg.inv(A)[:3, :3]), rtol=1e-9)
    assert not ball[3:].any()
    mixed = in_series(A, np.diag([np.inf, 2.0, 0.0, 0.0, 0.0, 3.0]))
    soft = np.linalg.inv(A)[np.ix_([0, 1, 5], [0, 1, 5])] + np.diag([0.0, 0.5, 1 / 3])
    np.testing.assert_allclose(mixed[np.ix_([0, 1, 5], [0, 1, 5])], np.linalg.inv(soft), rtol=1e-9)


def test_a_spring_without_tilt_stiffness_is_the_averaged_joint(
    spherical_mesh: Mesh, spherical_responses: dict[str, tuple[Model, Response]]
) -> None:
    scene = with_unit(coarse_scene("spherical"), interface="spring", stiffness=[*HELD, 0, 0, 0])
    _, found = solved(scene, spherical_mesh)
    reference = spherical_responses["averaged"][1]
    for name in ("main_bearing", "gearbox"):
        np.testing.assert_allclose(found.reactions[name], reference.reactions[name], atol=1e-7)
    expected = reference.motions["hub"]
    size = np.abs(expected).max()
    np.testing.assert_allclose(found.motions["hub"], expected, atol=1e-8 * size)


def test_a_spring_carries_what_stretches_it(spherical_mesh: Mesh) -> None:
    K = np.diag([1e9, 2e9, 3e9, 1e7, 2e7, 3e7])
    K[1, 5] = K[5, 1] = 1e8
    scene = with_unit(coarse_scene("spherical"), interface="spring", stiffness=K.tolist())
    model, found = solved(scene, spherical_mesh)
    assert found.equilibrium_error < 1e-7
    carried = K @ found.motions["main_bearing.joint"]
    np.testing.assert_allclose(
        carried, found.reactions["main_bearing.outer"], atol=1e-7 * np.abs(carried).max()
    )
    assert "main_bearing.joint" in model.points


def test_more_tilt_stiffness_moves_the_hub_less(spherical_mesh: Mesh) -> None:
    tilts = []
    for k in (0.0, 1e8, 1e9, "rigid"):
        scene = with_unit(coarse_scene("spherical"), interface="spring", stiffness=[*HELD, 0, k, k])
        tilts.append(solved(scene, spherical_mesh)[1].motions["hub"][4, 4])
    assert np.all(np.diff(tilts) < 0)


def test_rollers_balance_what_the_joint_carries() -> None:
    scene = tapered()
    _, found = solved(scene)
    unit = scene.bearing_units[0]
    loads = roller_loads(unit, found.motions)
    assert loads.shape == (2, 20, 10)
    total = roller_lines(unit).T @ loads.reshape(-1, 10)
    carried = found.reactions["main_bearing.outer"]
    np.testing.assert_allclose(total, carried, atol=1e-7 * np.abs(carried).max())
    # pushed up at the hub, the rollers above are pressed more than those below
    up = loads.sum(axis=0)[:, 2]
    assert up[5] > 0 > up[15]


def test_a_unit_on_rollers_turns_freely_and_lies_between_its_bounds() -> None:
    scene = tapered()
    soft, stiff = (unit_stiffness(scene, "main_bearing", c) for c in ("averaged", "rigid"))
    assert np.abs(soft[3]).max() < 1e-9 * np.abs(soft).max()
    held = np.ix_([0, 1, 2, 4, 5], [0, 1, 2, 4, 5])
    rings = joint_stiffness(scene.bearing_units[0])[held]
    size = np.sqrt(rings.diagonal())
    for less, more in ((soft[held], stiff[held]), (stiff[held], rings)):
        gap = (more - less) / np.outer(size, size)
        assert np.linalg.eigvalsh(gap)[0] > -1e-9


@pytest.mark.parametrize("kind", ["bonded", "spherical"])
def test_a_bedplate_is_in_series_with_its_housing(kind: str) -> None:
    scene = coarse_scene(kind)
    h = scene.bearing_units[0].housing.centre_height
    held = unit_stiffness(scene, "main_bearing")
    sprung = unit_stiffness(with_unit(scene, bedplate=BEDPLATE), "main_bearing")
    lever = wrench_transport(np.array([0.0, 0.0, h])).T
    give = lever @ np.diag([1 / 2e9, 1 / 3e9, 1 / 4e9, 1 / 5e8, 1 / 6e8, 0.0]) @ lever.T
    n = 6 if kind == "bonded" else 3
    expected = np.linalg.inv(held[:n, :n]) + give[:n, :n]
    np.testing.assert_allclose(np.linalg.inv(sprung[:n, :n]), expected, rtol=1e-6, atol=1e-15)


def test_a_bedplate_carries_what_it_gives_under(bonded_response: Response) -> None:
    scene = with_unit(coarse_scene("bonded"), bedplate=BEDPLATE)
    model, found = solved(scene)
    assert found.equilibrium_error < 1e-7
    k = np.array([2e9, 3e9, 4e9, 5e8, 6e8])
    arm = model.points["main_bearing.base"].position
    at_base = wrench_transport(-arm) @ found.reactions["main_bearing"]
    np.testing.assert_allclose(
        k[:, None] * found.motions["main_bearing.base"][:5],
        at_base[:5],
        atol=1e-7 * np.abs(at_base).max(),
    )
    assert found.motions["main_bearing.base"][5] == pytest.approx(np.zeros(10), abs=1e-14)
    softer = found.motions["hub"].diagonal()[:6] / bonded_response.motions["hub"].diagonal()[:6]
    assert (softer[[0, 1, 2, 3, 4]] > 1.0).all()


def test_a_rigid_bedplate_is_the_ground(bonded_response: Response) -> None:
    _, found = solved(with_unit(coarse_scene("bonded"), bedplate=["rigid"] * 6))
    for name, expected in bonded_response.reactions.items():
        np.testing.assert_allclose(
            found.reactions[name], expected, atol=1e-7 * max(1.0, np.abs(expected).max())
        )


def test_rollers_without_thrust_leave_the_shaft_free() -> None:
    radial = {"count": 12, "stiffness": 1e9, "rows": [{"x": -0.04}, {"x": 0.04}]}
    scene = with_unit(coarse_scene("bonded"), interface="rollers", rollers=radial)
    with pytest.raises(InputError, match="main_bearing can move freely along x"):
        change_scene(scene, {"gearbox.stiffness": [0, 8e7, 8e7, "rigid", 0, 0]})


@pytest.mark.parametrize(
    ("kind", "unit", "message"),
    [
        ("bonded", {"interface": "spring"}, "no stiffness: add it"),
        ("bonded", {"stiffness": [1e9] * 6}, "and stiffness: leave stiffness out"),
        ("bonded", {"interface": "rollers"}, "no rollers: add it"),
        ("bonded", {"bedplate": [1e9, 1e9, 0, 1e8, 1e8, 1e8]}, "0 must be a number from"),
        ("bonded", {"bedplate": [1e9] * 5}, "at least 6 values"),
        ("bonded", {"interface": "spring", "stiffness": [-1.0] * 6}, "must be 0, a number from"),
        ("bonded", {"interface": "spring", "stiffness": [[1.0] * 6, 0, 0, 0, 0, 0]}, "six rows"),
        (
            "bonded",
            {"interface": "spring", "stiffness": (np.eye(6) + np.eye(6, k=1)).tolist()},
            "symmetric",
        ),
        ("bonded", {"interface": "spring", "stiffness": (-np.eye(6)).tolist()}, "drives a motion"),
        (
            "bonded",
            {"interface": "rollers", "rollers": {"count": 9, "stiffness": 1e9, "rows": [{"x": 1}]}},
            "within half the bearing's width",
        ),
        (
            "spherical",
            {"interface": "rollers", "rollers": {"count": 9, "stiffness": 1e9, "rows": ROWS}},
            "contact_angle is -20 deg",
        ),
        (
            "bonded",
            {
                "interface": "rollers",
                "rollers": {"count": 9, "stiffness": 1e9, "rows": [{"x": 0}, {"x": 0}]},
            },
            "must differ",
        ),
        ("bonded", {"interface": "rollers", "rollers": {"count": 2, "stiffness": 1}}, "at least 3"),
    ],
)
def test_what_cannot_be_is_said(kind: str, unit: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        with_unit(coarse_scene(kind), **unit)
