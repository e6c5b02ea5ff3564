"""Condensed bodies: rigid motions, balance, and closed forms."""

from functools import partial

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.solve.condensation import Condensed, condense, supported
from fe_drivetrain.shafts.fidelity.shafts import beam_shaft, meridian_shaft, solid_shaft

#: Without rings but for the solid's, so that closed forms hold.
SHAFTS = {
    "beam": partial(beam_shaft, rings=False),
    "meridian": partial(meridian_shaft, rings=False),
    "solid": solid_shaft,
}


@pytest.fixture(scope="module")
def scene() -> Scene:
    return coarse_scene("spherical")


@pytest.fixture(scope="module")
def bodies(scene: Scene) -> dict[str, Condensed]:
    return {name: condenser(scene) for name, condenser in SHAFTS.items()}


@pytest.mark.parametrize("name", SHAFTS)
def test_no_force_resists_a_rigid_motion(bodies: dict[str, Condensed], name: str) -> None:
    K = bodies[name].stiffness
    size = np.abs(K) @ np.abs(bodies[name].rigid_motions)
    assert np.abs(K @ bodies[name].rigid_motions).max() < 1e-11 * size.max()
    np.testing.assert_allclose(K, K.T, atol=1e-12 * np.abs(K).max())


@pytest.mark.parametrize("name", ["beam", "meridian"])
def test_gravity_on_the_points_has_the_weight_and_its_moment(
    scene: Scene, bodies: dict[str, Condensed], name: str
) -> None:
    body, shaft = bodies[name], scene.shaft
    section = shaft.sections[0]
    area = np.pi / 4 * (section.outer_diameter**2 - section.inner_diameter**2)
    mass = scene.material_of("shaft").density * area * section.length
    centre = np.array([section.length / 2, 0.0, 0.0])
    expected = mass * wrench_transport(centre)[:, :3]
    np.testing.assert_allclose(
        body.rigid_motions.T @ body.gravity, expected, atol=1e-9 * mass * section.length
    )


@pytest.mark.parametrize("name", ["beam", "meridian"])
def test_a_uniform_shaft_twists_stretches_and_bends_by_the_closed_forms(
    scene: Scene, bodies: dict[str, Condensed], name: str
) -> None:
    """Held at one end face on average: pure torsion, tension and bending, without end effects."""
    body = bodies[name]
    material, section = scene.material_of("shaft"), scene.shaft.sections[0]
    L, d = section.length, section.outer_diameter
    E, G = material.youngs_modulus, material.shear_modulus
    A, second = np.pi / 4 * d**2, np.pi / 64 * d**4
    found = supported(body, {"gearbox": np.diag(np.full(6, np.inf))}).motions[body.rows("hub")]
    hub = found[:, body.rows("hub")]
    assert hub[3, 3] == pytest.approx(L / (2 * G * second), rel=1e-9)
    # the seat's mean motion has no part in what the hub does: it carries no load
    assert hub[0, 0] == pytest.approx(L / (E * A), rel=1e-9)
    assert hub[4, 4] == pytest.approx(L / (E * second), rel=1e-9)


@pytest.mark.parametrize("name", ["meridian", "solid"])
def test_condensed_mass_has_the_inertia_of_the_rigid_body(
    scene: Scene, bodies: dict[str, Condensed], name: str
) -> None:
    body, shaft = bodies[name], scene.shaft
    inertia = body.rigid_motions.T @ np.asarray(body.mass) @ body.rigid_motions
    L, d = shaft.length, shaft.sections[0].outer_diameter
    mass = scene.material_of("shaft").density * np.pi / 4 * d**2 * L
    expected = [mass, mass, mass, mass * d**2 / 8, *[mass * (d**2 / 16 + L**2 / 3)] * 2]
    if name == "meridian":
        np.testing.assert_allclose(inertia.diagonal(), expected, rtol=1e-9)
    else:  # its ring adds to it
        assert (inertia.diagonal() > np.array(expected)).all()
    assert np.linalg.eigvalsh(np.asarray(body.mass)).min() > -1e-9 * mass


def test_solid_and_meridian_agree_but_for_the_ring_and_the_mesh() -> None:
    """A ring of hardly any stiffness leaves the shaft alone."""
    soft = {"youngs_modulus": 1e6, "poisson_ratio": 0.3, "density": 0.0}
    scene = coarse_scene(
        "spherical",
        **{
            "materials.soft": soft,
            "bearing_units.main_bearing.bearing.material": "soft",
            "mesh.elements_per_turn": 12,
        },
    )
    solid, exact = solid_shaft(scene), meridian_shaft(scene)
    ends = [
        supported(body, {"gearbox": np.diag(np.full(6, np.inf))}).motions[:6, :6]
        for body in (solid, exact)
    ]
    # 12 curved elements round a turn: 1e-3 is what such a mesh gives (work_precision)
    np.testing.assert_allclose(np.diag(ends[0]), np.diag(ends[1]), rtol=3e-3)


def test_rings_in_the_meridian_are_those_of_the_solid(bodies: dict[str, Condensed]) -> None:
    """As cylinders of the same volume; without them the shaft is softer by much more."""
    ringed = meridian_shaft(coarse_scene("spherical"))
    solid, bare = bodies["solid"], bodies["meridian"]
    clamp = {"gearbox": np.diag(np.full(6, np.inf))}
    sway, short = (
        [supported(b, clamp).motions[k, k] for b in (ringed, bare, solid)] for k in (4, 3)
    )
    for with_rings, without, reference in (sway, short):
        assert abs(with_rings / reference - 1) < 0.25 * abs(without / reference - 1)


def test_reactions_balance_any_load(bodies: dict[str, Condensed]) -> None:
    body = bodies["meridian"]
    spring = np.diag([1e8, 2e8, 3e8, 1e6, 2e6, 3e6])
    found = supported(
        body, {"main_bearing": spring, "gearbox": np.diag([np.inf, 1e7, 1e7, np.inf, 0, 0])}
    )
    applied = body.rigid_motions.T @ np.hstack([np.eye(18), body.gravity])
    reacted = sum(
        wrench_transport(body.positions[body.names.index(name)] - body.positions[0]) @ reaction
        for name, reaction in found.reactions.items()
    )
    np.testing.assert_allclose(reacted, applied, atol=1e-9 * np.abs(applied).max())


def test_a_free_body_is_refused(bodies: dict[str, Condensed]) -> None:
    with pytest.raises(InputError, match="leave the body free to move"):
        supported(bodies["beam"], {"main_bearing": np.diag([1e8, 1e8, 1e8, 0, 0, 0])})


def test_one_point_has_no_stiffness() -> None:
    with pytest.raises(InputError, match="at the point 'a' alone"):
        condense(
            ["a"], np.zeros((1, 3)), np.eye(6), np.zeros((6, 3)), np.zeros((6, 3)), lambda F: F
        )
