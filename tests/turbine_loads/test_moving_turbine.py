"""A turbine whose speed and pitch vary: steady states, balances, poles, modes, imbalance."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.integrate import trapezoid

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads import turbine_air as air
from fe_drivetrain.turbine_loads.hub_loads import turbine_kernel as kernel
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import (
    Rotor,
    aerodynamic_hub_loads,
    polar,
    steady_state,
)
from fe_drivetrain.turbine_loads.hub_loads.controller import (
    CUT_IN_SHARE,
    FULL_SHARE,
    Tuning,
    designed_controller,
    speed_poles,
    steady_operation,
)
from fe_drivetrain.turbine_loads.hub_loads.moving_turbine import (
    simulate,
    turbine_histories,
    turbine_history,
)
from fe_drivetrain.turbine_loads.hub_loads.recorded import read_recorded
from fe_drivetrain.turbine_loads.hub_loads.surrogate import Condition
from fe_drivetrain.turbine_loads.hub_loads.turbine import (
    _MASS,
    _PLACES,
    _TWIST,
    EDGE_SHAPE,
    FLAP_SHAPE,
    RIGID,
    Physics,
    Turbine,
    blade_modes,
    natural_frequencies,
    similar_turbine,
)
from fe_drivetrain.turbine_loads.hub_loads.turbine_parts import Inflow, even_inflow, kernel_parts
from fe_drivetrain.turbine_loads.hub_loads.wind import at_azimuth

FX, FY, FZ, MX, MY, MZ = range(6)
PITCH, TORQUE, POWER, WIND, STATE = 0, 1, 2, 3, 4
SPEED, TWIST, GENERATOR = (STATE + k for k in (air.SPEED, air.TWIST, air.GENERATOR))
NREL_5MW = Rotor(
    radius=63.0,
    hub_height=90.0,
    rotor_mass=110e3,
    rated_power=5.2966e6,
    tip_speed_limit=12.1 * math.pi / 30.0 * 63.0,
    design_tip_speed_ratio=7.55,
    blade_start=9.5,
)
LEVEL = similar_turbine(Rotor(shaft_tilt=0.0))
CONTROLLER = designed_controller(LEVEL)
NO_FILTER = replace(CONTROLLER, tuning=Tuning(filter=1e3))


def waves(signal: Floats, azimuth: Floats, orders: int = 9) -> Floats:
    """Amplitudes of a signal (n, ...) at 1P to 9P, by least squares in the azimuth."""
    base = [np.ones_like(azimuth)]
    for order in range(1, orders + 1):
        base += [np.cos(order * azimuth), np.sin(order * azimuth)]
    fit = np.linalg.lstsq(np.stack(base, axis=1), signal, rcond=None)[0]
    return np.hypot(fit[1::2], fit[2::2])


# --- the compiled equations against those written for arrays ------------------------------------


def test_compiled_aerofoil_is_that_of_the_rotor() -> None:
    parts = kernel_parts(LEVEL, RIGID, even_inflow(LEVEL, 10.0, [0.0], 10.0))
    attack = np.linspace(-1.0, 1.5, 101)
    found = np.array([air.coefficients(parts, a) for a in attack]).T
    np.testing.assert_allclose(found, polar(LEVEL.rotor, attack), rtol=1e-12, atol=1e-14)


def test_rigid_turbine_with_frozen_wake_has_the_loads_of_the_rotor_in_the_same_wind() -> None:
    turbine = similar_turbine(Rotor(), cone=1e-300)
    controller = designed_controller(turbine)
    rotor = turbine.rotor
    drawn = np.random.default_rng(1).normal(size=(4, 7, rotor.elements)).astype(np.float32)
    physics = replace(RIGID, wake="frozen")
    inflow = Inflow(14.0, 0.2, drawn, 20.0)
    loads, beside = simulate(turbine, controller, inflow, physics, azimuth=0.3, held=True)
    point = steady_operation(turbine, controller, 14.0)
    radius = rotor.element_radius()[0]
    wind = np.empty((3, 1, radius.size))
    for blade in range(3):
        angle = np.array([0.3 + 2.0 * np.pi * blade / 3.0])
        height = rotor.hub_height + radius * np.cos(angle) * np.cos(rotor.shaft_tilt)
        wind[blade] = 14.0 * (height / rotor.hub_height) ** 0.2
        wind[blade] += at_azimuth(np.moveaxis(drawn[:1], 0, -1), angle)
    expected = aerodynamic_hub_loads(rotor, point, wind, [0.3])[0] + rotor.weight()
    # the shaft has what the rotor's inertia leaves of the torque of the air
    assert beside[0, POWER] == pytest.approx(expected[MX] * point.rotor_speed, rel=1e-6)
    share = turbine.generator_inertia / (turbine.generator_inertia + turbine.rotor_inertia)
    expected[MX] = beside[0, TORQUE] + share * (expected[MX] - beside[0, TORQUE])
    np.testing.assert_allclose(loads[0], expected, rtol=1e-6, atol=1.0)


# --- the controller ------------------------------------------------------------------------------


def test_gains_of_a_similar_rotor_are_near_those_published_for_the_nrel_5_mw() -> None:
    """Jonkman 2009, Table 7-2, at the fast shaft: the rotor here has blades of its own."""
    found = designed_controller(similar_turbine(NREL_5MW))
    assert found.optimal / 97.0**3 == pytest.approx(2.332287, rel=0.05)
    assert found.doubling == pytest.approx(math.radians(6.302336), rel=0.1)
    assert found.proportional / 97.0 == pytest.approx(0.01882681, rel=0.35)
    assert found.integral / 97.0 == pytest.approx(0.008068634, rel=0.35)


def test_torque_is_continuous_from_region_to_region() -> None:
    full = FULL_SHARE * CONTROLLER.torque_speed
    for speed in (full, CONTROLLER.transition, CONTROLLER.torque_speed):
        below, above = (CONTROLLER.torque(speed * (1.0 + e)) for e in (-1e-9, 1e-9))
        assert below == pytest.approx(above, rel=1e-6)
    assert CONTROLLER.torque(CUT_IN_SHARE * CONTROLLER.torque_speed) == 0.0


@pytest.mark.parametrize("wind", [4.0, 8.0, 10.0, 17.0])
def test_speed_and_pitch_come_to_the_state_of_momentum_theory(wind: float) -> None:
    begin = steady_operation(LEVEL, CONTROLLER, wind)
    start = 0.95 * begin.rotor_speed, begin.pitch + 0.02 * (wind > 12.0)
    inflow = even_inflow(LEVEL, wind, np.zeros(4000), 10.0)
    loads, beside = simulate(LEVEL, CONTROLLER, inflow, RIGID, start=start)
    assert beside[-1, SPEED] == pytest.approx(begin.rotor_speed, rel=1e-6)
    assert beside[-1, PITCH] == pytest.approx(begin.pitch, abs=1e-6)
    assert loads[-1, [FX, MX]] == pytest.approx([begin.thrust, begin.torque], rel=1e-5)
    if wind == 8.0:  # region 2 holds the best tip-speed ratio
        ratio = beside[-1, SPEED] * LEVEL.rotor.radius / wind
        assert ratio == pytest.approx(LEVEL.rotor.design_tip_speed_ratio, rel=1e-6)


def test_wake_follows_a_step_of_pitch_late_so_that_thrust_overshoots() -> None:
    wind = even_inflow(LEVEL, 14.0, np.zeros(1200), 10.0)
    point = steady_operation(LEVEL, CONTROLLER, 14.0)
    heavy = replace(LEVEL, rotor_inertia=1e15, generator_inertia=1e15)  # keeps its speed
    start = point.rotor_speed, point.pitch + math.radians(2.0)
    loads, _ = simulate(heavy, CONTROLLER, wind, RIGID, held=True, start=start)
    end = steady_state(LEVEL.rotor, 14.0, *start)
    assert loads[-1, FX] == pytest.approx(end.thrust, rel=1e-4)
    assert loads[0, FX] < end.thrust - 0.05 * (point.thrust - end.thrust)


@pytest.mark.parametrize("torsion", [False, True])
def test_energy_of_the_air_is_generated_kept_in_rotation_or_lost_in_the_shaft(
    torsion: bool,
) -> None:
    time = np.arange(2400) / 80.0
    inflow = even_inflow(LEVEL, 8.0, 1.5 * np.sin(0.7 * time), 80.0)
    physics = replace(FROZEN, torsion=torsion)  # a wake that moves has energy, too
    _, beside = simulate(LEVEL, CONTROLLER, inflow, physics)
    _, torque, power = beside[:, :3].T
    rotor, twist, generator = beside[:, [SPEED, TWIST, GENERATOR]].T
    lost = LEVEL.shaft_damping * (rotor - generator) ** 2 * torsion
    # torque is held over a step: its work is that over the mean speed
    given = (
        trapezoid(power - lost, dx=1 / 80)
        - torque[:-1] @ (0.5 * (generator[1:] + generator[:-1])) / 80
    )
    stored = 0.5 * LEVEL.rotor_inertia * rotor**2 + 0.5 * LEVEL.generator_inertia * generator**2
    stored += 0.5 * LEVEL.shaft_stiffness * twist**2 * torsion
    assert np.ptp(stored) > 0.5e6
    assert beside[:, PITCH].max() == 0.0
    assert given == pytest.approx(stored[-1] - stored[0], abs=1e-4 * float(np.ptp(stored)))


@pytest.mark.parametrize("wind", [13.0, 22.0])
def test_speed_decays_with_the_poles_of_the_linear_equation(wind: float) -> None:
    point = steady_operation(LEVEL, NO_FILTER, wind)
    one, other = speed_poles(LEVEL, NO_FILTER, point)
    time = np.arange(1500) / 100.0
    begin = 1e-4 * point.rotor_speed
    # from x(0) = 1, x'(0) = one + other, since pitch begins with the error's proportional part
    linear = (one * np.exp(one * time) - other * np.exp(other * time)) / (one - other)
    inflow = even_inflow(LEVEL, wind, np.zeros(time.size), 100.0)
    physics = replace(RIGID, wake="frozen")
    start = point.rotor_speed + begin, point.pitch
    _, beside = simulate(LEVEL, NO_FILTER, inflow, physics, start=start)
    found = (beside[:, SPEED] - point.rotor_speed) / begin
    # the controller acts in steps of 0.01 s: a lag of half a step
    assert np.abs(found - linear.real).max() < 0.01
    assert np.abs(linear.real).min() < 0.02


def test_pitch_and_torque_keep_their_rate_limits() -> None:
    gust = np.where(np.arange(600) > 100, 8.0, 0.0)
    loads, beside = simulate(LEVEL, CONTROLLER, even_inflow(LEVEL, 11.0, gust, 20.0), RIGID)
    pitch, torque = np.diff(beside[:, :2], axis=0).T * 20.0
    assert np.abs(pitch).max() == pytest.approx(CONTROLLER.tuning.pitch_rate, rel=1e-9)
    limit = CONTROLLER.tuning.torque_rate * CONTROLLER.rated_torque
    assert np.abs(torque).max() <= limit * (1.0 + 1e-9)
    assert np.isfinite(loads).all()


# --- imbalance, modes, tower ---------------------------------------------------------------------


@pytest.fixture(scope="module")
def calm() -> tuple[Floats, Floats]:
    """Rigid, even wind, pitch, torque and wake held."""
    return simulate(HEAVY, CONTROLLER, STEADY, FROZEN, held=True)


HEAVY = replace(LEVEL, rotor_inertia=3e12, generator_inertia=1e12)  # keeps its speed
STEADY = even_inflow(LEVEL, 14.0, np.zeros(1200), 20.0)
FROZEN = replace(RIGID, wake="frozen")


def test_surplus_of_mass_pulls_with_its_centrifugal_force_and_weighs_on_the_torque(
    calm: tuple[Floats, Floats],
) -> None:
    moment = 500.0
    spoilt = replace(HEAVY, mass_imbalance=moment)
    loads, beside = simulate(spoilt, CONTROLLER, STEADY, FROZEN, held=True)
    found = waves(loads - calm[0], beside[:, STATE])
    speed = beside[:, SPEED].mean()
    assert found[0, [FY, FZ]] == pytest.approx(2 * [moment * speed**2], rel=1e-6)
    # the generator's inertia, a quarter of all, takes a quarter of the weight's moment
    assert found[0, MX] == pytest.approx(0.25 * moment * LEVEL.rotor.gravity, rel=1e-4)
    assert found[1:].max() < 1e-4 * found[0, MX]


def test_one_blade_at_another_pitch_shakes_at_1p_and_three_do_not(
    calm: tuple[Floats, Floats],
) -> None:
    error = math.radians(0.3)
    one, all_three = (
        simulate(replace(HEAVY, pitch_errors=errors), CONTROLLER, STEADY, FROZEN, held=True)
        for errors in ((error, 0.0, 0.0), (error, error, error))
    )
    single = waves(one[0], one[1][:, STATE])
    assert single[0, MY] == pytest.approx(single[0, MZ], rel=1e-3)
    # three times the moment of one blade's root, turning: thrust changes by that of three
    thrust = (all_three[0] - calm[0])[0, FX] / 3.0
    assert 0.5 < single[0, MY] / abs(thrust) / LEVEL.rotor.radius < 0.85
    assert waves(all_three[0], all_three[1][:, STATE]).max() < 1e-3 * single[0, MY]


PITCHED = 0.2


def jacobian(turbine: Turbine, physics: Physics, speed: float) -> Floats:
    """Of the rates by the state, without air, weight and damping."""
    rotor = replace(turbine.rotor, gravity=1e-30)
    bare = replace(turbine, rotor=rotor, blade_damping=1e-30, tower_damping=1e-30)
    bare = replace(bare, shaft_damping=1e-30, cone=0.0)
    parts = kernel_parts(bare, physics, even_inflow(bare, 10.0, [0.0], 10.0))
    state = np.zeros(air.STATES)
    state[air.SPEED] = state[air.GENERATOR] = speed
    found = np.zeros((air.STATES, air.STATES))
    for k in range(air.STATES):
        both = []
        for sign in (-1.0, 1.0):
            moved, rates = state.copy(), np.zeros(air.STATES)
            moved[k] += sign * 1e-4
            kernel.moving(parts, moved, np.zeros((5, 10)), PITCHED, 0.0, rates, np.zeros(6))
            both.append(rates)
        found[:, k] = (both[1] - both[0]) / 2e-4
    return found


@pytest.mark.parametrize("speed", [0.0, 1.5])
def test_modes_of_the_equations_have_their_closed_frequencies(speed: float) -> None:
    known = natural_frequencies(LEVEL, speed, PITCHED)

    def frequencies(physics: Physics) -> Floats:
        values = np.linalg.eigvals(jacobian(LEVEL, physics, speed)).imag / (2.0 * np.pi)
        return np.sort(values[values > 1e-3])

    blades = frequencies(replace(RIGID, blades=True))
    together = LEVEL.generator_inertia + LEVEL.rotor_inertia
    whole = replace(LEVEL, rotor_inertia=together)  # with a rigid shaft, it turns with the rotor
    answering = natural_frequencies(whole, speed, PITCHED)
    expected = [known["flap"], known["edge"]] * 2
    expected += [answering["flap, all blades"], answering["edge, all blades"]]
    np.testing.assert_allclose(blades, sorted(expected), rtol=1e-6)
    torsion = frequencies(replace(RIGID, torsion=True))
    np.testing.assert_allclose(torsion, [known["torsion"]], rtol=1e-6)
    tower = frequencies(replace(RIGID, tower=True))
    np.testing.assert_allclose(tower, 2 * [LEVEL.tower_frequency], rtol=1e-6)


def test_edge_modes_stand_in_the_spectrum_of_the_side_force_one_turn_beside_their_own() -> None:
    from fe_drivetrain.turbine_loads.histories.spectra import spectrum

    turbine = similar_turbine(Rotor(elements=5, harmonics=7))
    condition = Condition(16.0, "medium", 0.2, 1)
    found = {}
    for blades in (True, False):
        made = turbine_history(
            condition, turbine, CONTROLLER, replace(RIGID, blades=blades), 160.0, 10.0
        )
        found[blades] = spectrum(made.history.component("Fy"), 0.1)
    turn = float(made.rotor_speed.mean()) / (2.0 * np.pi)
    edge = natural_frequencies(turbine, made.rotor_speed.mean())["edge"]
    for frequency in (edge - turn, edge + turn):
        assert found[True].amplitude(frequency) > 2.0 * found[False].amplitude(frequency)
    assert found[True].amplitude(turn) < 1.5 * found[False].amplitude(turn)


def test_tower_slows_the_wind_as_a_cylinder_does_and_shakes_at_3p_alone(
    calm: tuple[Floats, Floats],
) -> None:
    physics = replace(FROZEN, shadow=True)
    parts = kernel_parts(LEVEL, physics, STEADY)
    radius = 30.0
    height = LEVEL.rotor.hub_height - radius
    size = LEVEL.tower_foot + (LEVEL.tower_head - LEVEL.tower_foot) * height / LEVEL.tower_height
    before = LEVEL.overhang + radius * math.sin(LEVEL.cone)
    left = air.slowed(parts, radius, math.pi)
    assert left == pytest.approx(1.0 - (size / before) ** 2, rel=1e-12)
    assert air.slowed(parts, radius, 0.0) == 1.0
    beside = [air.slowed(parts, radius, math.pi + e) for e in (-0.1, 0.1)]
    assert left < beside[0] == pytest.approx(beside[1], rel=1e-12)
    loads, state = simulate(HEAVY, CONTROLLER, STEADY, physics, held=True)
    found = waves(loads, state[:, STATE])
    for component in (FX, MY, MZ):
        assert found[2, component] > 20.0 * found[[0, 1, 3, 4], component].max()
        assert found[2, component] > 1e3 * waves(calm[0], calm[1][:, STATE])[2, component]


def test_blades_are_those_of_the_nrel_5_mw() -> None:
    """First moment about the root: 362 133 kg m, OpenFAST's summary of the turbine."""
    turbine = similar_turbine(NREL_5MW)
    modes = blade_modes(turbine)
    scale = 17536.614 / turbine.blade_mass
    about_root = scale * (modes.first_moment - turbine.blade_mass * turbine.blade_root)
    assert about_root == pytest.approx(362_132.653, rel=2e-3)
    # shapes keep their size at the tip: twist turns them, and there a little
    tips = np.hypot(*modes.shape[:, :, -1].T)
    assert tips == pytest.approx([1.0, 1.0], abs=0.02)
    assert abs(modes.mass[0, 1]) < 0.1 * modes.mass[0, 0]
    found = natural_frequencies(turbine, 0.0)
    assert found["flap"] == pytest.approx(0.6993, rel=0.01)
    assert found["edge"] == pytest.approx(1.0793, rel=0.01)


def test_cone_puts_the_weight_of_the_blades_before_the_hub(calm: tuple[Floats, Floats]) -> None:
    arm = 3.0 * blade_modes(LEVEL).first_moment * LEVEL.cone
    expected = -LEVEL.rotor.gravity * arm
    assert calm[0][:, MY].mean() == pytest.approx(expected, rel=1e-9)


# --- histories -----------------------------------------------------------------------------------


def test_histories_that_were_kept_are_those_that_are_made(tmp_path: Path) -> None:
    turbine = similar_turbine(Rotor(elements=4, harmonics=3))
    grid = [Condition(12.0, "medium", 0.2, seed) for seed in (1, 2)]
    done: list[int] = []
    settings = {"duration": 20.0, "rate": 10.0, "cache": Cache(tmp_path), "progress": done.append}
    first = next(iter(turbine_histories(grid, turbine, CONTROLLER, **settings)))  # stopped
    again = list(turbine_histories(grid, turbine, CONTROLLER, **settings))
    assert done == [1, 1, 2]
    assert np.array_equal(first.history.loads, again[0].history.loads)
    alone = turbine_history(grid[1], turbine, CONTROLLER, duration=20.0, rate=10.0)
    for name in ("azimuth", "rotor_speed", "pitch", "generator_torque", "power", "wind_speed"):
        assert np.array_equal(getattr(again[1], name), getattr(alone, name))
    assert alone.history.loads.shape == (200, 6)
    file = tmp_path / "made.csv"
    alone.write(file)
    read = read_recorded(file)
    assert np.array_equal(read.history.loads, alone.history.loads)
    assert read.rotor_speed is not None
    assert np.array_equal(read.rotor_speed, alone.rotor_speed)
    assert read.wind_speed is not None
    assert np.array_equal(read.wind_speed, alone.wind_speed)
    turned = trapezoid(alone.rotor_speed, dx=0.1)
    assert alone.azimuth[-1] - alone.azimuth[0] == pytest.approx(turned, rel=1e-3)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"blade_mass": -1.0}, "blade_mass is -1.0 kg; it must be positive"),
        ({"pitch_errors": (0.0, 0.0)}, "pitch_errors three"),
        ({"tower_height": 95.0}, "tower_height is 95.0 m; it must be below hub_height 80.0 m"),
    ],
)
def test_turbines_that_cannot_be_are_refused(changes: dict[str, float], message: str) -> None:
    with pytest.raises(InputError, match=message):
        similar_turbine(Rotor(), **changes)


def test_what_has_no_motion_is_refused() -> None:
    with pytest.raises(InputError, match="2 blades"):
        similar_turbine(Rotor(blades=2))
    with pytest.raises(InputError, match="is no history"):
        turbine_history(Condition(12.0, "low", 0.2, 1), LEVEL, CONTROLLER, duration=0.0)
    with pytest.raises(InputError, match="pitch_rate is 0"):
        Tuning(pitch_rate=0.0)


def test_each_mode_bends_about_its_sections_as_structural_twist_turns_them() -> None:
    """The suction side of a twisted section looks downwind and into the sense of rotation, its
    leading edge upwind: so a blade that the air bends downwind moves as the rotor turns."""
    modes = blade_modes(LEVEL, 4000)
    root = modes.place < 2.0 / 17.0  # up to there twist is the same
    flap, edge = modes.shape[0][:, root], modes.shape[1][:, root]
    slope = math.tan(math.radians(13.308))
    np.testing.assert_allclose(flap[1] / flap[0], slope, rtol=1e-9)
    np.testing.assert_allclose(edge[0] / edge[1], -slope, rtol=1e-9)
    assert modes.shape[0, 1, -1] > 0.0 > modes.shape[1, 0, -1]
    # twice integrated to the tip, where both shapes have 1 without a twist
    twist = np.radians(np.interp(modes.place, _PLACES, _TWIST))
    for mode, polynomial in enumerate((FLAP_SHAPE, EDGE_SHAPE)):
        bent = (1.0 - modes.place) * polynomial.deriv(2)(modes.place)
        along = float((np.cos(twist) * bent).mean())
        across = float((np.sin(twist) * bent).mean()) * (1.0 - 2.0 * mode)
        np.testing.assert_allclose(modes.shape[mode, mode, -1], along, rtol=1e-3)
        np.testing.assert_allclose(modes.shape[mode, 1 - mode, -1], across, rtol=3e-3)


def test_tension_takes_the_work_that_shortening_a_turning_blade_does() -> None:
    """A bent blade draws its mass in against the centrifugal force m r W^2, by integrals of half of
    the slopes squared."""
    modes = blade_modes(LEVEL, 4000)
    length = LEVEL.rotor.radius - LEVEL.blade_root
    density = np.interp(modes.place, _PLACES, _MASS)
    mass = LEVEL.blade_mass * density / density.sum()
    radius = LEVEL.blade_root + length * modes.place
    slope = np.gradient(modes.shape, modes.place, axis=2)
    products = np.einsum("acx,bcx->abx", slope, slope)
    drawn_in = np.cumsum(products, axis=2) / modes.place.size / length
    np.testing.assert_allclose(modes.stiffening, drawn_in @ (mass * radius), rtol=2e-3)


def test_frequencies_of_a_similar_turbine_grow_with_its_speed() -> None:
    small = similar_turbine(Rotor(radius=31.5, hub_height=60.0, rotor_mass=20e3))
    large = similar_turbine(Rotor(radius=63.0, hub_height=90.0, rotor_mass=110e3))
    rate = small.rotor.tip_speed_limit / 31.5 / (large.rotor.tip_speed_limit / 63.0)
    assert rate > 1.5
    one, other = natural_frequencies(small, 0.9 * rate, 0.1), natural_frequencies(large, 0.9, 0.1)
    assert {k: v / rate for k, v in one.items()} == pytest.approx(other, rel=1e-9)


@pytest.mark.parametrize("azimuth", [0.3, 2.1, 4.6])
def test_force_on_the_shaft_is_the_weight_less_the_momentum_that_the_rotor_takes(
    azimuth: float,
) -> None:
    """In still air, all moving: hub, blades that bend, and a surplus of mass on one of them."""
    turbine = replace(LEVEL, mass_imbalance=4e4)
    parts = kernel_parts(turbine, Physics(), even_inflow(turbine, 10.0, [0.0], 10.0))
    state = np.zeros(air.STATES)
    state[[air.PSI, air.SPEED, air.TWIST, air.GENERATOR]] = azimuth, 1.3, 0.01, 1.2
    at = air.RATES + np.array([[6 * a + i for a in range(2)] for i in range(3)])
    state[at] = np.random.default_rng(4).normal(size=(3, 2))
    rates, loads = np.zeros(air.STATES), np.zeros(6)
    kernel.moving(parts, state, np.zeros((5, 20)), 0.0, 1e6, rates, loads)
    speed, faster = state[air.SPEED], rates[air.SPEED]
    assert abs(faster) > 1e-2
    angle = azimuth + 2.0 * np.pi * np.arange(3) / 3.0
    # x, y and z: along the blades, and as these turn
    out = np.stack([0.0 * angle, -np.sin(angle), np.cos(angle)], axis=1)
    along = np.stack([0.0 * angle, -np.cos(angle), -np.sin(angle)], axis=1)
    hub = np.array([rates[air.FORE_RATE], rates[air.SIDE_RATE], 0.0])
    momentum = turbine.rotor.rotor_mass * hub
    # d2/dt2 of S e, S the bent blade's first moment along e, which turns; no blade is bent yet
    momentum += np.outer(rates[at] @ parts.force[:, 0], [1.0, 0.0, 0.0]).sum(axis=0)
    bends, bent = state[at] @ parts.force[:, 1], rates[at] @ parts.force[:, 1]
    momentum += (bent[:, None] * along - 2.0 * speed * bends[:, None] * out).sum(axis=0)
    momentum += turbine.mass_imbalance * (faster * along[0] - speed**2 * out[0])
    weight = np.array([0.0, 0.0, -turbine.rotor.rotor_mass * turbine.rotor.gravity])
    np.testing.assert_allclose(loads[:3], weight - momentum, atol=1e-6 * np.abs(weight).max())
    # the tower, which stands straight and still, holds nothing yet: its top takes the same force
    rest = turbine.top_mass - turbine.rotor.rotor_mass
    np.testing.assert_allclose(rest * hub[:2], loads[:2], atol=1e-6 * np.abs(weight).max())
