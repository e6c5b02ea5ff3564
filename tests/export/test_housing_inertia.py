"""Bearing units with their mass: what the shaft feels of a housing that moves with it."""

from functools import cache

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.measures import mass_moments
from fe_drivetrain.export.craig_bampton import craig_bampton_shaft
from fe_drivetrain.export.from_scene import unit_superelement
from fe_drivetrain.export.lumped_shaft import rigid_mass
from fe_drivetrain.export.modes import natural_frequencies
from fe_drivetrain.export.programs import exudyn_system, ross_rotor
from fe_drivetrain.shafts.fidelity.bearing_units import (
    UnitMatrices,
    scene_supports,
    unit_matrices,
    unit_stiffness,
    without_shaft,
)

UNIT = "bearing_units.main_bearing"
SOFT = {f"{UNIT}.bedplate": [1e8, 1e8, 1e8, 1e8, 1e8, 1e8]}


def solid_inertia(scene: Scene, parts: dict[str, bool]) -> Floats:
    """(6, 6) rigid-body mass of the mesh of a unit about the bearing's centre."""
    name = scene.bearing_units[0].bearing.name
    at = np.array([scene.bearing_units[0].bearing.x, 0.0, 0.0])
    together, _ = without_shaft(scene, {name: True})
    mesh = together.mesh
    total = np.zeros((6, 6))
    for part, counted in parts.items():
        if not counted:
            continue
        volume, centre, inertia = mass_moments(mesh.points, mesh.cells[mesh.part_cells(part)])
        density = scene.material_of(part).density
        arm = centre - at
        about = inertia + volume * (arm @ arm * np.eye(3) - np.outer(arm, arm))
        total += rigid_mass(density * volume, arm, density * about)
    return total


@cache
def grounded() -> UnitMatrices:
    return unit_matrices(coarse_scene("bonded"), "main_bearing")


@cache
def on_bedplate() -> UnitMatrices:
    return unit_matrices(coarse_scene("bonded", **SOFT), "main_bearing")


def test_on_the_softest_bedplate_a_unit_has_the_inertia_of_its_solid() -> None:
    """It moves as a rigid body then: mass, centre and inertia of the mesh, ring and housing."""
    change = {f"{UNIT}.bedplate": [1e3] * 6}
    scene = coarse_scene("bonded", **change)
    found = unit_matrices(scene, "main_bearing").mass
    expected = solid_inertia(scene, {"main_bearing": True, "main_bearing.housing": True})
    size = np.sqrt(np.outer(expected.diagonal(), expected.diagonal()))
    assert np.abs((found - expected) / size).max() < 1e-5


def test_a_unit_on_the_ground_moves_less_than_all_of_its_mass() -> None:
    """Its foot stays: along each axis it is a mean of displacements squared, below that of 1."""
    scene = coarse_scene("bonded")
    found = grounded()
    whole = solid_inertia(scene, {"main_bearing": True, "main_bearing.housing": True})
    ring = solid_inertia(scene, {"main_bearing": True, "main_bearing.housing": False})
    assert np.linalg.eigvalsh(found.mass).min() > 0.0
    # the ring, in the bore, comes along with nearly all that it has
    for axis in range(3):
        assert 0.9 * ring[axis, axis] < found.mass[axis, axis] < whole[axis, axis]
    same = unit_stiffness(scene, "main_bearing", "rigid")
    np.testing.assert_allclose(found.stiffness, same, rtol=1e-12, atol=1e-12 * same.max())


def test_a_spherical_joint_takes_no_inertia_about_its_centre_along() -> None:
    """The shaft turns in it; the ring is the shaft's, so that only the housing has mass."""
    scene = coarse_scene("spherical")
    found = unit_matrices(scene, "main_bearing").mass
    housing = solid_inertia(scene, {"main_bearing": False, "main_bearing.housing": True})
    size = found.diagonal()[:3].max()
    assert np.abs(found[3:]).max() < 1e-9 * size
    assert np.linalg.eigvalsh(found[:3, :3]).min() > 0.0
    assert (found.diagonal()[:3] < housing.diagonal()[:3]).all()


def test_behind_a_spring_the_housing_follows_as_two_springs_in_series_do() -> None:
    """Its bore moves by K_h^-1 K of the shaft's motion, with K of both in series."""
    joint = [2e9, 4e9, 3e9, 1e8, 2e8, 3e8]
    ways = {"interface": "spring", "stiffness": ["rigid"] * 6}
    base = {f"{UNIT}.{key}": value for key, value in ways.items()} | SOFT
    rigid = unit_matrices(coarse_scene("bonded", **base), "main_bearing")
    base[f"{UNIT}.stiffness"] = joint
    found = unit_matrices(coarse_scene("bonded", **base), "main_bearing")
    follows = np.linalg.solve(rigid.stiffness, found.stiffness)
    expected = follows.T @ rigid.mass @ follows
    size = np.sqrt(np.outer(expected.diagonal(), expected.diagonal()))
    assert np.abs((found.mass - expected) / size).max() < 1e-8


def test_a_ring_on_rollers_turns_and_slides_with_the_shaft() -> None:
    """Radial rollers leave both free, so that the ring alone is felt in them, as a rigid body."""
    rollers = {"count": 10, "stiffness": 1e9, "rows": [{"x": -0.05}, {"x": 0.05}]}
    change = {f"{UNIT}.interface": "rollers", f"{UNIT}.rollers": rollers}
    scene = coarse_scene("bonded", **change)
    found = unit_matrices(scene, "main_bearing").mass
    ring = solid_inertia(scene, {"main_bearing": True, "main_bearing.housing": False})
    for free in (0, 3):
        assert found[free, free] == pytest.approx(ring[free, free], rel=1e-6)
    for carried in (1, 2):
        assert found[carried, carried] > 1.01 * ring[carried, carried]


def test_a_condensed_housing_has_no_mass() -> None:
    stiffness = (1e9 * np.eye(6)).tolist()
    scene = coarse_scene("bonded", **{f"{UNIT}.housing": {"stiffness": stiffness}})
    with pytest.raises(InputError, match="stiffness alone, which has no mass"):
        unit_matrices(scene, "main_bearing")


def test_the_superelement_has_the_mass_where_it_is_asked_for() -> None:
    scene = coarse_scene("bonded")
    element = unit_superelement(scene, "main_bearing", mass=True)
    assert element.mass is not None
    np.testing.assert_allclose(element.mass, grounded().mass)
    assert unit_superelement(scene, "main_bearing").mass is None


def test_mass_on_supports_lowers_frequencies_and_needs_a_point() -> None:
    """Rayleigh: mass more, and no frequency is higher."""
    scene, unit = coarse_scene("bonded", **SOFT), on_bedplate()
    shaft = craig_bampton_shaft(scene, 4, order=3)
    body = shaft.points, shaft.stiffness, shaft.mass
    supports = scene_supports(scene, {"main_bearing": unit.stiffness})
    without = natural_frequencies(*body, supports)
    found = natural_frequencies(*body, supports, {"main_bearing": unit.mass})
    assert (found <= without * (1 + 1e-9)).all()
    assert (found[:6] < 0.95 * without[:6]).any()
    with pytest.raises(InputError, match="mass of 'nowhere' is at none of the points hub"):
        natural_frequencies(*body, supports, {"nowhere": unit.mass})


@pytest.mark.needs("ross")
def test_ross_has_the_housings_mass_at_its_node_and_does_not_spin_it() -> None:
    scene, unit = coarse_scene("bonded", **SOFT), on_bedplate()
    stiffness, inertia = {"main_bearing": unit.stiffness}, {"main_bearing": unit.mass}
    light = ross_rotor.rotor_of_scene(scene, stiffness)
    heavy = ross_rotor.rotor_of_scene(scene, stiffness, inertia=inertia)
    first = 6 * heavy.supports["main_bearing"][0]
    more = heavy.matrix("M") - light.matrix("M")
    expected = np.zeros_like(more)
    expected[first : first + 6, first : first + 6] = unit.mass
    np.testing.assert_allclose(more, expected, atol=1e-9 * unit.mass.max())
    np.testing.assert_array_equal(heavy.rotor.G(), light.rotor.G())
    K, M = heavy.matrix("K"), heavy.matrix("M")
    expected = natural_frequencies([], K, M)
    # eigenvalues are known to the last digits of the largest one, and are squares of frequencies
    known = np.finfo(float).eps * (expected[-1] / expected[:8]) ** 2
    assert known.max() < 1e-4
    assert (np.abs(heavy.frequencies(8) / expected[:8] - 1.0) <= known).all()
    # the shaft's weight alone, as without the mass
    sag = [rotor.deflections({}, (0.0, 0.0, -9.81)) for rotor in (light, heavy)]
    np.testing.assert_allclose(sag[1], sag[0], rtol=0, atol=1e-9 * np.abs(sag[0]).max())
    with pytest.raises(InputError, match="mass of 'nowhere' is at none of the supports"):
        ross_rotor.rotor_of_scene(scene, stiffness, inertia={"nowhere": unit.mass})


@pytest.mark.needs("exudyn")
def test_exudyn_has_the_frequencies_with_the_housings_mass() -> None:
    scene, unit = coarse_scene("bonded", **SOFT), on_bedplate()
    shaft = craig_bampton_shaft(scene, 4, order=3)
    supports = scene_supports(scene, {"main_bearing": unit.stiffness})
    inertia = {"main_bearing": unit.mass}
    system = exudyn_system.flexible_system(shaft, supports, inertia=inertia)
    own = natural_frequencies(shaft.points, shaft.stiffness, shaft.mass, supports, inertia)
    np.testing.assert_allclose(system.frequencies(), own, rtol=1e-9)
