"""Bearings of gearboxes by reactions: L10 by hand, azimuths, axial loads of each kind."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.bearing.answers import load_zones
from fe_drivetrain.bearing.arrangements import cylindrical, spherical_roller, tapered_row
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.bearing_life.coupled.reaction_paths import (
    ReactionPath,
    carried_loads,
    damage_of_forces,
    one_sided,
)
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.rated import rated_bearing
from fe_drivetrain.bearing_life.life.roller_damage import damage_of_history
from fe_drivetrain.common.errors import InputError

PLANET = rated_bearing(cylindrical("planet", 16, 0.04, 0.05, 0.225, laminae=10), 1e6, 1.2e6, 1.5e5)
RADIUS, RATIO = 0.3, 2.5


def of_torque(azimuths: int = 1) -> np.ndarray:
    """Reactions of which a third of the torque over the radius is along the tangent."""
    matrix = np.zeros((azimuths, 6, 6))
    matrix[:, 2, 3] = 1.0 / (3 * RADIUS)
    return matrix


def test_life_under_a_constant_torque_is_that_of_iso_281() -> None:
    """(C / P)^(10/3) million turns of one ring against the other, in the rotor's time."""
    torque, rotor = 1.5e5, 12.0  # N m, 1/min
    path = ReactionPath("planet", PLANET, of_torque(), np.zeros((1, 6)), RATIO)
    damage = damage_of_history(
        path.steps([[0, 0, 0, torque, 0, 0]] * 3, rotor, 20.0), PLANET, LifeRules()
    )
    expected = (1e6 / (torque / (3 * RADIUS))) ** (10 / 3)
    assert damage.lives("Mrev")["L10"] == pytest.approx(expected, rel=1e-12)
    hours = expected * 1e6 / (RATIO * rotor * 60)
    assert damage.lives("hours")["L10"] == pytest.approx(hours, rel=1e-12)
    assert damage.seconds == pytest.approx(60.0)


def test_a_load_that_turns_is_averaged_over_its_azimuths() -> None:
    """Weight that turns with the carrier, beside a tangential load that stands in its frame."""
    torque, count = 9e4, 6
    turned = np.arange(count) * 2 * np.pi / count
    weight = np.zeros((count, 6))
    weight[:, 1], weight[:, 2] = -3e4 * np.sin(turned), -3e4 * np.cos(turned)
    path = ReactionPath("planet", PLANET, of_torque(count), weight, RATIO)
    hub = [[0, 0, 0, torque, 0, 0], [0, 0, 0, 2 * torque, 0, 0]]
    assert path.repeats == count
    assert_allclose(path.carried(hub).loads[:count, 2], 1e5 - 3e4 * np.cos(turned))
    steps = list(path.steps(hub, 10.0, 1.0, chunk=1))
    assert [len(one.loads) for one in steps] == [count, count]
    damage = damage_of_history(steps, PLANET, LifeRules())
    assert damage.seconds == pytest.approx(2.0)
    fine = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    P = [np.hypot(3e4 * np.sin(fine), f - 3e4 * np.cos(fine)) for f in (1e5, 2e5)]
    used = np.mean((np.array(P) / 1e6) ** (10 / 3)) * 2.0 * RATIO * 10.0 / 60 * 1e-6
    assert damage.totals["L10"] == pytest.approx(used, rel=1e-4)


def test_rollers_without_a_contact_angle_leave_axial_loads_to_flanges() -> None:
    loads = [[4e4, 1e5, 0, 7.0, 0, 0], [0, 0, 2e5, 0, 0, 0]]
    found = carried_loads(PLANET, loads)
    assert_allclose(found.loads, [[0, 1e5, 0, 0, 0], [0, 0, 2e5, 0, 0]], atol=1e-6)
    assert_allclose(found.flanges, [4e4, 0])
    # one that aligns itself carries both, and no moment
    aligning = rated_bearing(spherical_roller("s", 28, 0.058, 0.06, 0.61, 8.5))
    given = [[4e4, 1e5, 0, 0, 3e3, 0]]
    found = carried_loads(aligning, given)
    assert_allclose(found.loads, [[4e4, 1e5, 0, 0, 0]], atol=1e-6)
    assert not found.flanges.any()


def test_a_single_tapered_row_is_pressed_by_its_own_radial_load() -> None:
    """At its pressure centre it is loaded on about half of its circle, without tilt."""
    row = tapered_row(20, 0.02, 0.03, 0.2, 15.0, laminae=10)
    rated = rated_bearing(Bearing("tapered", (row,)))
    assert one_sided(rated.bearing)
    radial = 5e4
    found = carried_loads(rated, [[0, 0, -radial, 0, 0, 0], [-9e4, 0, -radial, 0, 0, 0]])
    least = radial / (2 * 0.4 / np.tan(np.radians(15.0)))
    assert_allclose(found.loads[:, 0], [least, 9e4])
    # the lines of contact meet on the axis, where the radial force acts
    centre = row.place - row.radius * np.tan(row.angle)
    assert_allclose(found.loads[:, 3], -centre * -radial)
    solved = equilibrium(rated.bearing, found.loads)
    assert solved.converged.all()
    share = load_zones(rated.bearing, solved.displacements)[0].loaded / 20
    assert 0.4 <= share[0] <= 0.7
    tilt_at_ends = np.abs(solved.displacements[:, 3:]).max() * 0.1
    assert tilt_at_ends < 0.05 * np.abs(solved.displacements[:, :3]).max()


def test_forces_of_a_transient_do_the_damage_of_their_steps() -> None:
    forces = [[0, 0, 1e5, 0, 0, 0], [0, 2e5, 0, 0, 0, 0], [3e4, -1.5e5, 0, 0, 0, 0]]
    speeds, seconds = [30.0, 40.0, -20.0], [1.0, 0.5, 2.0]
    damage = damage_of_forces(PLANET, forces, speeds, seconds, LifeRules(turning="outer"))
    turns = np.abs(speeds) / 60 * seconds
    used = 1e-6 * turns * (np.array([1e5, 2e5, 1.5e5]) / 1e6) ** (10 / 3)
    assert damage.totals["L10"] == pytest.approx(used.sum(), rel=1e-12)
    assert damage.turns == pytest.approx(turns.sum())
    assert damage.limits.reversals == 1


def test_hub_loads_of_another_shape_are_refused() -> None:
    path = ReactionPath("planet", PLANET, of_torque(), np.zeros((1, 6)), RATIO)
    with pytest.raises(InputError, match="Fx, Fy, Fz"):
        path.carried([[1.0, 2.0, 3.0]])
