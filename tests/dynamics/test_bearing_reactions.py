"""Loads of bearings by hub loads: statics by hand, balance of the whole, planets, speeds."""

from math import cos, pi, radians, tan

import numpy as np
import pytest
from numpy.testing import assert_allclose

from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.bearing_reactions import BearingModel, bearing_reactions
from fe_drivetrain.dynamics.bodies.bodies import assemble
from fe_drivetrain.dynamics.bodies.levels import Level, assembly, steady_load
from fe_drivetrain.dynamics.bodies.machine import Machine, library_machine
from fe_drivetrain.dynamics.bodies.static import static

TORQUE = 2e4  # N m
TORQUE_ALONE = [0.0, 0.0, 0.0, TORQUE, 0.0, 0.0]
FRONT, REAR = -0.10, 0.25  # m, bearings of the pinion from its middle
PINION = 60.0  # kg
GEAR_RADIUS, PINION_RADIUS = 0.45 * 80 / 105, 0.45 * 25 / 105


def pair(**changes: object) -> Machine:
    """A gear that drives a pinion, each on two bearings, one of which holds it axially."""
    stage = {
        "kind": "parallel",
        "radii": {"gear": GEAR_RADIUS, "pinion": PINION_RADIUS},
        "helix": 12.0,
        "hand": 1,
        "centre_distance": 0.45,
        "face_width": 0.15,
        "stiffness_of": "line",
        "gear": {"inertia": 25.0, "mass": 400.0},
        "pinion": {"inertia": 0.4, "mass": PINION},
        "stiffness": 2e9,
    } | changes
    rigid = [0.0, 1e9, 1e9, 0.0, 0.0, 0.0]
    held = [1e9, *rigid[1:]]
    return Machine.model_validate(
        {
            "title": "a pair of gears",
            "rotor": {"inertia": 100.0, "mass": 200.0},
            "shafts": [
                {"name": "LSS", "length": 0.5, "outer": 0.2},
                {"name": "HSS", "length": 0.5, "outer": 0.1, "kind": "coupling"},
            ],
            "stages": [stage],
            "generator": {"inertia": 5.0},
            "bearings": [
                {"name": "LS-A", "holds": "stage 1 gear", "at": -0.2, "stiffness": rigid},
                {"name": "LS-B", "holds": "stage 1 gear", "at": 0.2, "stiffness": held},
                {"name": "HS-A", "holds": "stage 1 pinion", "at": FRONT, "stiffness": rigid},
                {"name": "HS-B", "holds": "stage 1 pinion", "at": REAR, "stiffness": held},
            ],
        }
    )


def of_pinion() -> tuple[np.ndarray, float, float]:
    """Force of the gear's teeth on the pinion by textbook: tangential, radial and axial [N]."""
    tangential = TORQUE / GEAR_RADIUS
    # without a module the angles are those at the base circle and the working transverse one
    across, helix = radians(20.0), radians(12.0)
    radial, axial = tangential * tan(across), tangential * tan(helix) / cos(across)
    # the gear is on the left of the pinion (at +y) and turns about +x: its teeth go along +z there
    return np.array([-axial, radial, tangential]), radial, axial


@pytest.mark.parametrize("level", [Level.RIGID, Level.FLEXIBLE])
def test_bearings_of_a_pinion_carry_what_statics_say(level: Level) -> None:
    """Lever arms of the tooth force, of its axial part at the pitch circle, and of the weight."""
    force, _, axial = of_pinion()
    found = bearing_reactions(pair(), level)
    front, rear = (found[name].under([TORQUE_ALONE])[0, 0] for name in ("HS-A", "HS-B"))
    half_shaft = pi / 4 * 0.1**2 * 0.5 * 7850.0 / 2  # of the shaft behind, which hangs on it
    weight = np.array([0.0, 0.0, (PINION + half_shaft) * GRAVITY])
    # moments about the rear bearing; the teeth are at y = -r of the pinion
    across_y = (force[1] * REAR - force[0] * PINION_RADIUS) / (REAR - FRONT)
    across_z = (force[2] - weight[2]) * REAR / (REAR - FRONT)
    assert_allclose(front, [0.0, across_y, across_z, 0.0, 0.0, 0.0], rtol=1e-6, atol=1e-3)
    assert_allclose(front[:3] + rear[:3], force - weight, rtol=1e-6)
    assert rear[0] == pytest.approx(-axial, rel=1e-6)
    assert found["HS-A"].speed_ratio == pytest.approx(80 / 25)
    assert found["LS-B"].speed_ratio == 1.0


def at_origin(wrench: np.ndarray, place: tuple[float, float, float]) -> np.ndarray:
    """A force and moment at a place, about the origin."""
    moment = wrench[3:] + np.cross(place, wrench[:3])
    return np.concatenate([wrench[:3], moment])


@pytest.mark.parametrize("machine", [pair(), library_machine("nrel_750kw")], ids=["pair", "750 kW"])
def test_bearings_balance_hub_loads_weight_and_what_else_holds_the_machine(
    machine: Machine,
) -> None:
    """Six sums of forces and moments about the origin; the ring and the generator hold the rest."""
    hub = np.array([2e5, -3e4, 5e4, TORQUE, 8e4, -6e4])
    built = assembly(machine, Level.RIGID, held_generator=True)
    system = assemble(built.bodies, built.springs, built.superelements)
    load = steady_load(machine, system, 0.0, hub)
    load += GRAVITY * machine.rotor.apart[0] * system.load_on("rotor", np.eye(6)[2])
    solved = static(system, load)
    whole = np.zeros(6)
    for name, one in bearing_reactions(machine, Level.RIGID).items():
        if not one.planets:
            whole += at_origin(one.under([hub])[0, 0], built.seats[name][1])
    centres = {body.name: body.position for body in built.bodies}
    for spring, force in zip(built.springs, solved.forces, strict=True):
        if "stage 1 ring" in spring.by:  # the teeth push the ring, which is held
            whole += at_origin(-force * spring.by["stage 1 ring"], centres["stage 1 ring"])
        if spring.name.startswith("HSS") and "generator" in spring.by:
            whole += at_origin(-force * spring.by["generator"], centres["generator"])
    generator = centres["generator"]  # hangs on its foundation, where it has no mass
    weights = sum(
        at_origin(np.array([0, 0, -GRAVITY * body.mass, 0, 0, 0]), body.position)
        for body in built.bodies
        if body.name != "generator"
    )
    # the rotor's own weight is in the loads of the hub
    weights += np.array([0, 0, GRAVITY * machine.rotor.apart[0], 0, 0, 0])
    assert generator[0] > 0
    assert_allclose(whole, hub + weights, atol=1e-6 * np.abs(hub).max())


def of_planets_alone() -> Machine:
    """The planetary stage of 750 kW, whose sun no other gear pushes aside."""
    data = library_machine("nrel_750kw").model_dump(exclude_none=True)
    data["stages"] = data["stages"][:1]
    data["shafts"] = [data["shafts"][0], data["shafts"][-1]]
    axial = {"name": "thrust", "holds": "stage 1 sun", "stiffness": [1e8, 0, 0, 0, 0, 0]}
    data["bearings"] = [*data["bearings"][:3], axial]
    return Machine.model_validate(data)


def test_a_planets_bearings_carry_two_tooth_forces_where_planets_share_equally() -> None:
    torque = 3.25e5
    hub = [[0, 0, 0, torque, 0, 0]]
    tooth = torque / (2 * 3 * 0.308)  # N, of each of the two meshes of a planet

    def both(machine: Machine, weight: bool) -> np.ndarray:
        found = bearing_reactions(machine, Level.RIGID)
        two = [found[f"stage 1 pin {side}"] for side in ("upwind", "downwind")]
        assert two[0].planets == 3
        # a planet turns against its carrier by the teeth of ring and planet
        assert two[0].speed_ratio == pytest.approx(99 / 39, rel=1e-9)
        return np.asarray(sum(np.broadcast_to(one.under(hub, weight)[0], (6, 6)) for one in two))

    alone = both(of_planets_alone(), weight=False)
    assert_allclose(alone[:, 2], 2 * tooth, rtol=1e-6)
    assert_allclose(alone[:, :2], 0.0, atol=1e-4 * tooth)
    # the weight turns once with the carrier, as the push of the next gear on the sun: over a turn
    # they have no mean
    heavy = both(library_machine("nrel_750kw"), weight=True)
    assert_allclose(heavy[:, 2].mean(), 2 * tooth, rtol=1e-6)
    assert np.ptp(heavy[:, 2]) > 2 * 104 * GRAVITY


def test_bearings_in_the_housing_feel_no_azimuth_of_equal_planets() -> None:
    machine = library_machine("nrel_750kw")
    for level in (Level.RIGID, Level.FLEXIBLE):
        found = bearing_reactions(machine, level)
        assert {len(one.by_hub) for one in found.values() if not one.planets} == {1}
        assert {len(one.by_hub) for one in found.values() if one.planets} == {6}


def test_softer_bearings_give_load_to_others_where_there_are_more_than_statics_need() -> None:
    machine = library_machine("nrel_5mw")
    model = BearingModel(machine, Level.RIGID, count=1)
    hub = [[0, 0, 0, 4e6, 0, 0]]

    def loads(factors: dict[str, float]) -> dict[str, float]:
        found = model.reactions(factors)
        return {n: float(np.hypot(*one.under(hub)[0, 0, 1:3])) for n, one in found.items()}

    as_stated, softer = loads({}), loads({"HS-A": 0.5})
    assert softer["HS-A"] < 0.99 * as_stated["HS-A"]
    assert softer["HS-B"] > 1.01 * as_stated["HS-B"]
    # that is the same as a machine whose file says so
    data = machine.model_dump(exclude_none=True)
    for bearing in data["bearings"]:
        if bearing["name"] == "HS-A":
            bearing["stiffness"] = [0.5 * k for k in bearing["stiffness"]]
    changed = bearing_reactions(Machine.model_validate(data), Level.RIGID, count=1)
    again = float(np.hypot(*changed["HS-A"].under(hub)[0, 0, 1:3]))
    assert softer["HS-A"] == pytest.approx(again, rel=1e-9)
    # all planets have it
    pins = loads({"stage 1 pin upwind": 0.5})
    assert pins["stage 1 pin upwind"] < as_stated["stage 1 pin upwind"]


def test_levels_without_forces_and_names_of_no_bearing_are_refused() -> None:
    machine = pair()
    with pytest.raises(InputError, match="no forces of bearings"):
        bearing_reactions(machine, Level.TORSIONAL)
    with pytest.raises(InputError, match="HS-C"):
        BearingModel(machine, Level.RIGID).reactions({"HS-C": 0.5})
