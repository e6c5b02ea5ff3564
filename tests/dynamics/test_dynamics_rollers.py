"""Rolling bearings in the statics of bodies: limits, balance, clearance, planets on their pins."""

from functools import cache

import numpy as np
import pytest

from fe_drivetrain.bearing.arrangements import cylindrical, double_row_tapered, tapered_row
from fe_drivetrain.bearing.contact import ContactLaw
from fe_drivetrain.bearing.contact_forces import forces
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.rolling import equilibrium
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import CarrierComponent, library_component
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import assembly, machine_system, steady_load
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.bodies.roller_seats import (
    OnRollers,
    machine_seat,
    planet_seats,
    seat,
    static_on_rollers,
)
from fe_drivetrain.dynamics.bodies.springs import Place, bushing
from fe_drivetrain.dynamics.bodies.static import static
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame

AT = (0.3, 0.1, -0.2)
SHAFT = Place("shaft", (0.0, 0.0, 0.0))


def tapered(law: ContactLaw | None = None, clearance: float = -20e-6) -> Bearing:
    return double_row_tapered(
        "pair", 20, 0.03, 0.04, 0.3, 15, 0.08, "O", law, laminae=0, clearance=clearance
    )


def on_bushing(stiffness: Floats, name: str = "b") -> System:
    """A shaft in one bearing, held in rotation."""
    turning = bushing("turn", SHAFT, None, AT, (0, 0, 0, 1e6, 0, 0))
    return assemble(
        [Body("shaft", mass=100.0)], [*bushing(name, SHAFT, None, AT, stiffness), *turning]
    )


def load_of(size: float, system: System) -> Floats:
    return size * system.load_on("shaft", np.array([3e3, -2e3, 5e3, 100.0, 400.0, -300.0]))


WEAK = np.array([1e8, 1e8, 1e8, 0.0, 1e6, 1e6])


def test_with_a_linear_law_and_preload_it_is_its_tangent() -> None:
    bearing = tapered(ContactLaw(5e8, 1.0))
    whole = np.zeros((6, 6))
    five = [0, 1, 2, 4, 5]
    preload, tangents = forces(bearing, np.zeros((1, 5)))
    whole[np.ix_(five, five)] = tangents[0]
    exact = on_bushing((whole + whole.T) / 2)
    given = on_bushing(WEAK)
    found = static_on_rollers(given, load_of(0.5, given), [seat("b", bearing, SHAFT, None, AT)])
    assert np.abs(preload).max() < 1e-6
    assert found.converged
    expected = static(exact, load_of(0.5, exact)).q
    assert found.static.q == pytest.approx(expected, rel=1e-8, abs=1e-8 * np.abs(expected).max())


def test_small_loads_see_the_tangent_and_the_difference_is_proportional_to_them() -> None:
    bearing, given = tapered(), on_bushing(WEAK)
    tangent = forces(bearing, np.zeros((1, 5)))[1][0]
    where = [seat("b", bearing, SHAFT, None, AT)]

    def difference(size: float) -> float:
        found = static_on_rollers(given, load_of(size, given), where)
        assert found.converged
        linear = np.linalg.solve(tangent, found.loads[0])
        return float(np.abs(found.motions[0] - linear).max() / np.abs(linear).max())

    assert difference(0.02) < 2e-3
    assert difference(0.01) / difference(0.02) == pytest.approx(0.5, abs=0.02)


@pytest.mark.parametrize("clearance", [-10e-6, 0.0, 30e-6])
def test_it_is_the_equilibrium_of_the_bearing_alone(clearance: float) -> None:
    bearing, given = tapered(clearance=clearance), on_bushing(WEAK)
    load = load_of(10.0, given)
    found = static_on_rollers(given, load, [seat("b", bearing, SHAFT, None, AT)])
    alone = equilibrium(bearing, found.loads)
    assert found.converged
    assert alone.displacements[0] == pytest.approx(found.motions[0], rel=1e-6, abs=1e-12)
    # the wrench at the shaft's centre, from that at the bearing
    F = np.array([*found.loads[0, :3]])
    M = np.array([0.0, *found.loads[0, 3:]]) + np.cross(AT, F)
    assert load[:3] == pytest.approx(F, rel=1e-7)
    assert load[4:] == pytest.approx(M[1:], rel=1e-7)


def test_inside_its_clearance_a_bearing_carries_nothing() -> None:
    given = on_bushing(WEAK)
    beside = bushing("guide", SHAFT, None, AT, 10 * WEAK)
    body = [Body("shaft", mass=100.0)]
    turning = bushing("turn", SHAFT, None, AT, (0, 0, 0, 1e6, 0, 0))
    system = assemble(body, [*bushing("b", SHAFT, None, AT, WEAK), *beside, *turning])
    loose = cylindrical("loose", 16, 0.04, 0.05, 0.225, laminae=5, clearance=200e-6)
    found = static_on_rollers(system, load_of(1.0, system), [seat("b", loose, SHAFT, None, AT)])
    assert found.converged
    assert not found.loads.any()
    assert found.static.force("guide uy") == pytest.approx(-2e3)
    assert found.static.force("b ux") == pytest.approx(3e3 / 11)  # guides stay, rollers float
    # with nothing beside it, the bearing takes up its clearance and carries all
    force = np.array([3e3, -2e3, 5e3])
    load = given.load_on("shaft", np.concatenate([force, np.cross(AT, force)]))
    found = static_on_rollers(given, load, [seat("b", loose, SHAFT, None, AT)])
    assert found.converged
    assert found.radial("b") == pytest.approx(np.hypot(2e3, 5e3), rel=1e-8)
    assert np.hypot(*found.motions[0, 1:3]) > 200e-6


def test_a_bearing_that_is_pushed_open_is_flagged() -> None:
    given = on_bushing(WEAK)
    single = Bearing("single", (tapered_row(20, 0.03, 0.04, 0.3, 15, laminae=0),))
    where = [seat("b", single, SHAFT, None, AT)]
    force = np.array([5e3, 0.0, 0.0])
    push = given.load_on("shaft", np.concatenate([force, np.cross(AT, force)]))
    assert static_on_rollers(given, push, where).converged
    assert not static_on_rollers(given, -push, where).converged
    with pytest.raises(InputError, match="no springs of a bearing"):
        static_on_rollers(given, push, [seat("c", single, SHAFT, None, AT)])
    with pytest.raises(InputError, match="same name"):
        static_on_rollers(given, push, where + where)


PLANET = cylindrical("planet bearing", 16, 0.04, 0.05, 0.225, laminae=6, crown=0.35e-3 * 0.04)


@cache
def machine_on_rollers(clearance: float, azimuth: float) -> OnRollers:
    machine = library_machine("nrel_750kw")
    system = machine_system(machine, azimuth=azimuth, held_generator=True)
    hub = np.array([0.0, 0, 0, 0, -2e5, 0])
    load = steady_load(machine, system, 3.25e5, hub)
    bearing = PLANET.with_rows(clearance=clearance)
    seats = planet_seats(machine, 1, bearing, azimuth)
    return static_on_rollers(system, load, seats)


@pytest.mark.parametrize("clearance", [0.0, 50e-6])
def test_planets_on_rollers_carry_the_torque(clearance: float) -> None:
    found = machine_on_rollers(clearance, 0.7)
    assert found.converged
    tangential = found.loads[:, 2].sum()  # on the pins
    assert abs(tangential) == pytest.approx(3.25e5 / 0.308, rel=1e-7)
    assert not any(
        found.static.force(f"stage 1 pin 1 {side} uy") for side in ("upwind", "downwind")
    )


def test_a_third_of_a_turn_later_the_next_planet_is_there() -> None:
    one, later = (machine_on_rollers(50e-6, a) for a in (0.7, 0.7 + 2 * np.pi / 3))
    for side in ("upwind", "downwind"):
        before = one.radial(f"stage 1 pin 2 {side}")
        assert later.radial(f"stage 1 pin 1 {side}") == pytest.approx(before, rel=1e-6)


def test_a_carrier_bearing_with_clearance_lets_the_carrier_settle() -> None:
    machine = library_machine("nrel_750kw")
    system = machine_system(machine, held_generator=True)
    whole = assembly(machine, held_generator=True)
    load = steady_load(machine, system, 3.25e5, np.zeros(6))
    fall = []
    for clearance in (0.0, 100e-6):
        bearing = cylindrical("PLC", 44, 0.036, 0.05, 0.52, laminae=4, clearance=clearance)
        seats = [machine_seat(whole, name, bearing) for name in ("PLC-A", "PLC-B")]
        found = static_on_rollers(system, load, seats)
        assert found.converged
        fall.append(found.static.q[system.place("stage 1 carrier uz")])
    assert fall[1] < fall[0] < 0
    with pytest.raises(InputError, match="no bearing 'PLC'"):
        machine_seat(whole, "PLC", PLANET)


def test_pins_of_a_flexible_carrier_stay_when_rollers_take_the_place_of_springs() -> None:
    machine = library_machine("nrel_5mw")
    component = library_component("planet_carrier")
    assert isinstance(component, CarrierComponent)
    carrier = Flexible({1: carrier_frame(component)})
    bearing = cylindrical("planet", 20, 0.06, 0.2, 0.5, laminae=4, clearance=80e-6)
    seats = planet_seats(machine, 1, bearing, flexible=carrier)
    reduced = machine_system(machine, held_generator=True, flexible=carrier)
    with pytest.raises(InputError, match="'stage 1 pin 1 upwind uy' holds a body without mass"):
        static_on_rollers(reduced, steady_load(machine, reduced, 3.9e6, np.zeros(6)), seats)
    with pytest.raises(InputError, match="cannot change"):
        static(reduced, np.zeros(len(reduced.names)), {"stage 1 pin 2 downwind uz": 1e-5})
    parts = assembly(machine, held_generator=True, flexible=carrier)
    whole = assemble(parts.bodies, parts.springs, parts.superelements)
    found = static_on_rollers(whole, steady_load(machine, whole, 3.9e6, np.zeros(6)), seats)
    assert found.converged
    # bearings of the carrier carry no torque
    assert abs(found.loads[:, 2].sum()) == pytest.approx(3.9e6 / 0.863, rel=1e-6)
