"""Rotor aerodynamics against momentum theory, kinematics, invariance and energy."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.aero_rotor import (
    Rotor,
    aerodynamic_hub_loads,
    assumptions,
    operating_point,
    polar,
    steady_state,
)

BETZ = 16.0 / 27.0
LEVEL = Rotor(shaft_tilt=0.0)
SPEEDS = [5.0, 8.0, 10.0, 12.0, 16.0, 20.0, 25.0]


def uniform(rotor: Rotor, speed: float, samples: int = 1) -> np.ndarray:
    return np.full((rotor.blades, samples, rotor.elements), speed)


def turned(loads: np.ndarray, angle: float) -> np.ndarray:
    """Force and moment vectors turned about +x."""
    cos, sin = np.cos(angle), np.sin(angle)
    about_x = np.array([[1.0, 0.0, 0.0], [0.0, cos, -sin], [0.0, sin, cos]])
    return np.concatenate((loads[..., :3] @ about_x.T, loads[..., 3:] @ about_x.T), axis=-1)


# --- mean state ----------------------------------------------------------------------------------


@pytest.mark.parametrize("speed", SPEEDS)
def test_blade_forces_balance_the_momentum_lost_by_the_air(speed: float) -> None:
    """Sum over annuli of dT = CT rho V^2 pi r dr and dQ = 4 F a' (1 - a) rho V Omega pi r^3 dr.

    CT = 4 F a (1 - a) up to a = 0.4, and Glauert's empirical line in Buhl's form beyond
    (Buhl 2005, NREL/TP-500-36834): 8/9 + (4 F - 40/9) a + (50/9 - 4 F) a^2.
    """
    point = operating_point(LEVEL, speed)
    r, dr = LEVEL.element_radius()
    a, loss = point.axial, point.loss
    momentum = 4.0 * loss * a * (1.0 - a)
    empirical = 8.0 / 9.0 + (4.0 * loss - 40.0 / 9.0) * a + (50.0 / 9.0 - 4.0 * loss) * a**2
    flow = LEVEL.air_density * speed * np.pi * r * dr
    thrust = np.sum(np.where(a <= 0.4, momentum, empirical) * flow * speed)
    torque = np.sum(4.0 * loss * point.tangential * (1.0 - a) * flow * point.rotor_speed * r**2)
    loads = aerodynamic_hub_loads(LEVEL, point, uniform(LEVEL, speed), [0.3])[0]
    assert loads[0] == pytest.approx(thrust, rel=1e-9)
    assert loads[3] == pytest.approx(torque, rel=1e-9)


def test_momentum_balance_is_tried_on_both_sides_of_heavy_loading() -> None:
    assert operating_point(LEVEL, 8.0).axial.max() > 0.4
    assert operating_point(LEVEL, 16.0).axial.max() < 0.4


@pytest.mark.parametrize("speed", SPEEDS)
def test_thrust_and_power_stay_below_their_limits(speed: float) -> None:
    point = operating_point(LEVEL, speed)
    pressure = 0.5 * LEVEL.air_density * np.pi * LEVEL.radius**2 * speed**2
    assert 0.0 < point.power < BETZ * pressure * speed
    assert 0.0 < point.thrust < pressure
    # The air that passes the disc at (1 - a) V cannot give more than thrust times its speed.
    assert point.power < point.thrust * speed


def test_betz_holds_at_any_pitch_and_speed_of_rotation() -> None:
    pressure = 0.5 * LEVEL.air_density * np.pi * LEVEL.radius**2 * 8.0**3
    best = 0.0
    for ratio in np.linspace(5.0, 9.0, 9):
        for pitch in np.deg2rad(np.linspace(-2.0, 8.0, 11)):
            power = steady_state(LEVEL, 8.0, ratio * 8.0 / LEVEL.radius, pitch).power
            best = max(best, power / pressure)
    assert 0.44 < best < BETZ  # a sound design comes near, none reaches it
    design = operating_point(LEVEL, 8.0)
    assert design.power / pressure > 0.99 * best  # zero pitch and the design ratio are the optimum


def test_power_is_regulated_above_rated_and_similar_below() -> None:
    for speed in (12.0, 16.0, 20.0, 25.0):
        assert operating_point(Rotor(), speed).power == pytest.approx(2.0e6, rel=1e-6)
    pitches = [operating_point(Rotor(), speed).pitch for speed in (12.0, 16.0, 20.0, 25.0)]
    assert np.all(np.diff(pitches) > 0.0)
    slow, fast = operating_point(Rotor(), 5.0), operating_point(Rotor(), 8.0)
    # Equal tip-speed ratio: power goes with the cube of the wind, thrust with its square.
    assert fast.power / slow.power == pytest.approx((8.0 / 5.0) ** 3, rel=1e-9)
    assert fast.thrust / slow.thrust == pytest.approx((8.0 / 5.0) ** 2, rel=1e-9)


def test_thrust_is_greatest_near_rated_wind() -> None:
    thrusts = [operating_point(Rotor(), speed).thrust for speed in (8.0, 11.0, 16.0, 25.0)]
    assert thrusts[1] == max(thrusts)


def test_impossible_winds_and_rotors_are_refused() -> None:
    with pytest.raises(InputError, match=r"wind speed 40\.0 m/s is outside"):
        operating_point(Rotor(), 40.0)
    with pytest.raises(InputError, match=r"shaft_tilt is 5\.0 rad"):
        Rotor(shaft_tilt=5.0)
    with pytest.raises(InputError, match="must increase in this order"):
        Rotor(hub_height=30.0)
    with pytest.raises(InputError, match="rotor_mass is 0"):
        Rotor(rotor_mass=0.0)


# --- aerofoil ------------------------------------------------------------------------------------


def test_aerofoil_never_gives_energy() -> None:
    _, drag = polar(LEVEL, np.linspace(-np.pi, np.pi, 4001))
    assert drag.min() > 0.0


def test_aerofoil_lift_line_and_stall() -> None:
    rotor = Rotor()
    lift, _ = polar(rotor, rotor.zero_lift_angle)
    assert lift == pytest.approx(0.0, abs=1e-12)
    small = np.deg2rad(1.0)
    lift, drag = polar(rotor, rotor.zero_lift_angle + np.array([-small, small]))
    assert (lift[1] - lift[0]) / (2.0 * small) == pytest.approx(rotor.lift_slope, rel=0.01)
    np.testing.assert_allclose(drag, rotor.min_drag, rtol=0.05)
    angle = np.deg2rad(np.linspace(0.0, 25.0, 501))
    lift, drag = polar(rotor, angle)
    peak = angle[np.argmax(lift)]
    assert abs(peak - rotor.stall_angle) < np.deg2rad(2.0)
    assert lift[-1] < 0.8 * lift.max()
    assert drag[-1] > 10.0 * rotor.min_drag


# --- loads ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("speed", [10.0, 16.0])
def test_even_wind_gives_constant_thrust_and_torque_alone(speed: float) -> None:
    point = operating_point(LEVEL, speed)
    psi = np.linspace(0.0, 7.0, 50)
    loads = aerodynamic_hub_loads(LEVEL, point, uniform(LEVEL, speed, psi.size), psi)
    np.testing.assert_allclose(loads[:, 0], point.thrust, rtol=1e-9)
    np.testing.assert_allclose(loads[:, 3], point.torque, rtol=1e-9)
    np.testing.assert_allclose(loads[:, [1, 2]], 0.0, atol=1e-9 * point.thrust)
    np.testing.assert_allclose(loads[:, [4, 5]], 0.0, atol=1e-9 * point.thrust * LEVEL.radius)


def test_turning_rotor_and_wind_together_turns_the_loads() -> None:
    point = operating_point(LEVEL, 12.0)
    generator = np.random.default_rng(1)
    wind = 12.0 + generator.standard_normal((3, 8, LEVEL.elements))
    psi = generator.uniform(0.0, 6.0, 8)
    loads = aerodynamic_hub_loads(LEVEL, point, wind, psi)
    moved = aerodynamic_hub_loads(LEVEL, point, wind, psi + 0.7)
    np.testing.assert_allclose(moved, turned(loads, 0.7), rtol=1e-9, atol=1e-3)


def test_a_gust_on_one_blade_acts_where_the_blade_is() -> None:
    """The change of the hub load is one of forces along x and e_t at points along e_r."""
    point = operating_point(LEVEL, 12.0)
    for azimuth in np.linspace(0.0, 6.0, 13):
        still = aerodynamic_hub_loads(LEVEL, point, uniform(LEVEL, 12.0), [azimuth])[0]
        wind = uniform(LEVEL, 12.0)
        wind[0] += 1.0
        change = aerodynamic_hub_loads(LEVEL, point, wind, [azimuth])[0] - still
        along = turned(np.array([0.0, 0.0, 1.0, 0.0, 0.0, 0.0]), azimuth)[:3]
        force, moment = change[:3], change[3:]
        assert force @ along == pytest.approx(0.0, abs=1e-6)
        assert moment @ along == pytest.approx(0.0, abs=1e-5)
        # Thrust at a mean radius r: M = r e_r cross Fx x, in the outer half of the blade.
        flap = np.cross(along, [1.0, 0.0, 0.0]) @ moment
        assert force[0] > 0.0
        assert 0.5 < flap / (force[0] * LEVEL.radius) < 1.0


def test_more_wind_above_tilts_and_more_wind_at_positive_y_yaws() -> None:
    """M = r cross F: z Fx is a positive My, y Fx a negative Mz."""
    point = operating_point(LEVEL, 12.0)
    psi = np.linspace(0.0, 2.0 * np.pi, 30, endpoint=False)
    r, _ = LEVEL.element_radius()
    above, right = uniform(LEVEL, 12.0, psi.size), uniform(LEVEL, 12.0, psi.size)
    for blade in range(3):
        angle = psi + 2.0 * np.pi * blade / 3.0
        above[blade] += 0.02 * np.outer(np.cos(angle), r)
        right[blade] += 0.02 * np.outer(-np.sin(angle), r)
    tilting = aerodynamic_hub_loads(LEVEL, point, above, psi).mean(axis=0)
    yawing = aerodynamic_hub_loads(LEVEL, point, right, psi).mean(axis=0)
    assert tilting[4] > 1e5
    assert yawing[5] < -1e5
    assert abs(tilting[5]) < 0.02 * tilting[4]
    # The same gradient turned a quarter turn about +x, from +z to -y, turns the load as well.
    np.testing.assert_allclose(yawing, turned(tilting, -np.pi / 2), atol=0.02 * tilting[4])


def test_tilted_shaft_loads_the_blade_that_comes_down() -> None:
    """Wind crosses a tilted disc upwards: the blade coming down, at -y, meets it head-on.

    With the lift well below stall its thrust rises with its speed through the air, so the force
    acts at negative y and M = r cross F gives a positive Mz.  Tilting the other way is the same
    flow seen after half a turn.
    """
    psi = np.linspace(0.0, 2.0 * np.pi, 30, endpoint=False)

    def loads(tilt: float, start: float) -> np.ndarray:
        rotor = Rotor(shaft_tilt=tilt)
        point = operating_point(rotor, 8.0)
        return aerodynamic_hub_loads(rotor, point, uniform(rotor, 8.0, psi.size), psi + start)

    up = loads(0.1, 0.0)
    assert up[:, 5].mean() > 2e4
    assert up[:, 0].mean() == pytest.approx(loads(0.0, 0.0)[:, 0].mean(), rel=0.03)
    np.testing.assert_allclose(loads(-0.1, np.pi), turned(up, np.pi), rtol=1e-9, atol=1e-3)


def test_a_stronger_even_wind_presses_and_drives_more() -> None:
    point = operating_point(LEVEL, 16.0)
    calm, strong = (
        aerodynamic_hub_loads(LEVEL, point, uniform(LEVEL, v), [0.0])[0] for v in (15.0, 17.0)
    )
    assert strong[0] > calm[0]
    assert strong[3] > calm[3]


# --- weight and assumptions ----------------------------------------------------------------------


@pytest.mark.parametrize("degrees", [-3.0, 0.0, 5.0, 6.0])
def test_weight_is_the_whole_weight_and_hangs_from_the_tilted_shaft(degrees: float) -> None:
    tilt = np.deg2rad(degrees)
    rotor = Rotor(shaft_tilt=float(tilt))
    weight = rotor.weight()
    # Ground axes in the shaft frame: the shaft points downwind and, with positive tilt, down.
    up = np.array([-np.sin(tilt), 0.0, np.cos(tilt)])
    np.testing.assert_allclose(weight[:3], -rotor.rotor_mass * rotor.gravity * up, atol=1e-9)
    np.testing.assert_array_equal(weight[3:], 0.0)
    if degrees > 0.0:
        assert weight[0] > 0.0


def test_rotor_mass_follows_its_source() -> None:
    # Fingersh, Hand and Laxson 2006: baseline blade, hub, pitch system, nose cone.
    rotor = Rotor()
    blade = 0.1452 * rotor.radius**2.9158
    hub = 0.954 * blade + 5680.3
    pitch = 1.328 * (0.1295 * 3.0 * blade + 491.31) + 555.0
    nose = 18.5 * 2.0 * rotor.radius - 520.5
    assert rotor.rotor_mass == pytest.approx(3.0 * blade + hub + pitch + nose, rel=2e-3)


def test_every_assumption_is_listed_with_unit_and_source() -> None:
    rotor = replace(Rotor(), hub_height=67.0)
    listed = assumptions(rotor)
    assert [name for name, *_ in listed] == [f.name for f in fields(Rotor)]
    assert dict((name, value) for name, value, *_ in listed)["hub_height"] == 67.0
    for _, _, unit, source in listed:
        assert unit
        assert len(source) > 5
