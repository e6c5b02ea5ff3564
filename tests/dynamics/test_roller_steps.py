"""Rolling bearings in time: static equilibrium after damping, small vibrations, energy, laws."""

from functools import cache

import numpy as np
import pytest

from fe_drivetrain.bearing.arrangements import cylindrical, double_row_tapered
from fe_drivetrain.bearing.contact import ContactLaw
from fe_drivetrain.bearing.contact_forces import forces
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.stored_energy import energy_of
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.equations import equations_of, steady
from fe_drivetrain.dynamics.bodies.gear_pairs import contact_ratios
from fe_drivetrain.dynamics.bodies.levels import machine_system, steady_load
from fe_drivetrain.dynamics.bodies.machine import library_machine
from fe_drivetrain.dynamics.bodies.meshing import Meshing, machine_meshing, varying_equations
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.roller_seats import (
    planet_seats,
    seat,
    static_on_rollers,
    without_bearings,
)
from fe_drivetrain.dynamics.bodies.springs import Place, bushing
from fe_drivetrain.dynamics.bodies.system import System, with_proportional_damping
from fe_drivetrain.dynamics.time.integration import integrate
from fe_drivetrain.dynamics.time.motion import Motion, State
from fe_drivetrain.dynamics.time.rolling_bearings import rolling_bearings
from fe_drivetrain.dynamics.time.schemes import generalised_alpha

AT = (0.3, 0.1, -0.2)
SHAFT = Place("shaft", (0.0, 0.0, 0.0))
WEAK = np.array([1e8, 1e8, 1e8, 0.0, 1e6, 1e6])


def tapered(law: ContactLaw | None = None, clearance: float = -20e-6, laminae: int = 0) -> Bearing:
    return double_row_tapered(
        "pair", 20, 0.03, 0.04, 0.3, 15, 0.08, "O", law, laminae=laminae, clearance=clearance
    )


def on_bushing(stiffness: Floats) -> System:
    """A shaft in one bearing, held in rotation."""
    turning = bushing("turn", SHAFT, None, AT, (0, 0, 0, 1e6, 0, 0))
    body = Body("shaft", mass=100.0, polar=4.0, transverse=9.0)
    return assemble([body], [*bushing("b", SHAFT, None, AT, stiffness), *turning])


def load_of(size: float, system: System) -> Floats:
    return size * system.load_on("shaft", np.array([3e3, -2e3, 5e3, 100.0, 400.0, -300.0]))


@cache
def loose() -> Bearing:
    return tapered(clearance=30e-6)


def in_time(
    bearing: Bearing,
    size: float,
    duration: float,
    dt: float,
    turning: float = 0.0,
    damping: float = 0.0,
    **given: object,
) -> Motion:
    """From rest; `turning` is the damping of what holds the rotation [s]."""
    system = on_bushing(WEAK)
    seats = [seat("b", bearing, SHAFT, None, AT)]
    bare = with_proportional_damping(without_bearings(system, seats), turning)
    return integrate(
        equations_of(bare),
        [steady(load_of(size, system)), rolling_bearings(bare, seats, damping)],
        duration,
        dt,
        **given,  # type: ignore[arg-type]
    )


BEARINGS = {
    "line integral": tapered(),
    "laminae": tapered(laminae=7),
    "clearance": cylindrical("loose", 16, 0.04, 0.05, 0.225, laminae=21, clearance=20e-6),
}


@pytest.mark.parametrize("kind", BEARINGS)
def test_forces_are_the_gradient_of_the_energy(kind: str) -> None:
    bearing = BEARINGS[kind]
    rng = np.random.default_rng(3)
    u = rng.normal(size=(4, 5)) * [20e-6, 40e-6, 40e-6, 3e-4, 3e-4]
    h = 1e-9
    found = forces(bearing, u)[0]
    for i in range(5):
        step = h * np.eye(5)[i]
        slope = (energy_of(bearing, u + step) - energy_of(bearing, u - step)) / (2 * h)
        assert slope == pytest.approx(found[:, i], rel=1e-5, abs=1e-5 * np.abs(found).max())
    assert np.all(energy_of(bearing, 3 * u) > energy_of(bearing, u))


def test_damped_it_comes_to_rest_in_the_static_equilibrium() -> None:
    system = on_bushing(WEAK)
    still = static_on_rollers(system, load_of(10.0, system), [seat("b", loose(), SHAFT, None, AT)])
    found = in_time(loose(), 10.0, 0.3, 5e-4, 2e-3, damping=1e-3, scheme=generalised_alpha(0.6))
    assert found.converged
    assert found.q[-1] == pytest.approx(
        still.static.q, rel=1e-6, abs=1e-6 * np.abs(still.static.q).max()
    )
    assert found.bearings.radial("b")[-1] == pytest.approx(still.radial("b"), rel=1e-6)
    # the scheme damps, too
    assert found.imbalance[-1] < 0.0


def test_small_vibrations_have_the_frequencies_of_the_tangent() -> None:
    bearing, system = tapered(), on_bushing(WEAK)
    seats = [seat("b", bearing, SHAFT, None, AT)]
    load = load_of(10.0, system)
    still = static_on_rollers(system, load, seats)
    whole, five = np.zeros((6, 6)), [0, 1, 2, 4, 5]
    tangent = forces(bearing, still.motions)[1][0]
    whole[np.ix_(five, five)] = (tangent + tangent.T) / 2
    modes = system_modes(on_bushing(whole))
    shape, frequency = modes.shapes[:, 2], float(modes.frequencies[2])
    bare = without_bearings(system, seats)
    missed = []
    for size in (2e-3, 1e-3):
        # a share of the deflection
        push = size * np.abs(still.static.q).max() / np.abs(shape).max() * shape
        begin = State(still.static.q + push, np.zeros(6), np.zeros(6))
        period, steps = 1.0 / frequency, 400
        acting = [steady(load), rolling_bearings(bare, seats)]
        found = integrate(equations_of(bare), acting, period, period / steps, start=begin)
        end = found.q[-1] - still.static.q
        missed.append(float(np.abs(end - push).max() / np.abs(push).max()))
    # a period later it is where it was: steps turn by 2 atan(w dt / 2), 2e-5 of a turn too little
    assert missed[0] < 3e-3
    assert missed[1] < 0.75 * missed[0]


def test_energy_is_kept_but_for_the_error_of_the_steps() -> None:
    coarse, fine = (in_time(loose(), 10.0, 0.02, dt) for dt in (1e-4, 5e-5))
    assert coarse.converged
    for found in (coarse, fine):
        inside = np.abs(found.bearings.loads).max(axis=(1, 2))
        assert inside.min() == 0.0  # it leaves its rollers, and comes back
    lost = [one.relative_imbalance for one in (coarse, fine)]
    assert lost[0] / lost[1] > 3.0
    assert np.all(fine.energies[:, 3] == 0.0)


def test_a_linear_law_is_a_bushing_in_time() -> None:
    bearing = tapered(ContactLaw(5e8, 1.0))
    whole, five = np.zeros((6, 6)), [0, 1, 2, 4, 5]
    tangent = forces(bearing, np.zeros((1, 5)))[1][0]
    whole[np.ix_(five, five)] = (tangent + tangent.T) / 2
    linear = on_bushing(whole)
    equations = equations_of(linear)
    exact = integrate(equations, steady(load_of(0.5, linear)), 0.01, 1e-4)
    found = in_time(bearing, 0.5, 0.01, 1e-4)
    scale = np.abs(exact.q).max()
    assert found.q == pytest.approx(exact.q, rel=1e-7, abs=1e-8 * scale)
    # but for the energy of its preload
    assert np.diff(found.energy) == pytest.approx(
        np.diff(exact.energy), abs=1e-8 * exact.energy.max()
    )


def test_damping_takes_energy_out_and_refusals() -> None:
    found = in_time(tapered(), 10.0, 0.02, 2e-4, damping=1e-4)
    lost = found.energies[:, 3]
    assert np.all(np.diff(lost) >= 0.0)
    assert lost[-1] > 0.05 * found.energies[:, 1].max()
    finer = in_time(tapered(), 10.0, 0.02, 1e-4, damping=1e-4)
    # the tangent of a damper is that at the beginning of its step: exact balance all the same
    assert found.relative_imbalance / finer.relative_imbalance > 3.0
    with pytest.raises(InputError, match="damping of bearings is -1 s"):
        in_time(tapered(), 1.0, 1.0, 0.1, damping=-1.0)
    with pytest.raises(InputError, match="no rolling bearing 'x': use one of b"):
        found.bearings.of("x")


def test_planets_on_rollers_stay_in_their_equilibrium_and_leave_it_as_teeth_come_and_go() -> None:
    machine = library_machine("nrel_750kw")
    system = machine_system(machine, held_generator=True)
    rollers = cylindrical("planet bearing", 16, 0.04, 0.05, 0.225, laminae=5, clearance=50e-6)
    seats = planet_seats(machine, 1, rollers)
    load = steady_load(machine, system, 325e3, np.zeros(6))
    still = static_on_rollers(system, load, seats)
    bare = without_bearings(system, seats)
    zero = np.zeros(len(load))
    begin = State(still.static.q, zero, zero)
    name = "stage 1 pin 1 upwind"

    def radial(meshing: dict[str, Meshing]) -> Floats:
        acting = [steady(load), rolling_bearings(bare, seats)]
        found = integrate(varying_equations(bare, meshing), acting, 3e-3, 1e-4, start=begin)
        assert found.converged
        return found.bearings.radial(name)

    meshing = machine_meshing(machine, 2.31, contact_ratios(machine))
    assert radial({}) == pytest.approx(still.radial(name), rel=1e-7)
    varied = radial({n: m for n, m in meshing.items() if n.startswith("stage 1")})
    assert np.ptp(varied) > 1e-3 * still.radial(name)
    assert varied.mean() == pytest.approx(still.radial(name), rel=0.1)
