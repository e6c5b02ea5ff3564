"""Pitch and yaw drives: power balance, signs, friction, duty, teeth, tower shear."""

import numpy as np
import pytest

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.duty import (
    moves,
    peak_times,
    thermal_torque,
    tooth_counts,
    with_transients,
)
from fe_drivetrain.procedure.slewing import (
    SlewingDrive,
    drive_torque,
    friction_torque,
    gyroscopic_torque,
    holding_torque,
    printed_drive_torque,
    ring_torque,
    shear_between,
)
from fe_drivetrain.turbine_loads.histories.levels import time_at_level

DRIVE = SlewingDrive(part=12e3, drive=0.02, ratio=1500.0)
STEP = 1e-3
TIME = np.arange(0.0, 4.0 + STEP / 2, STEP)
#: From rest and back to rest, smooth.
SPEED = 0.1 * np.sin(np.pi * TIME / 4.0) ** 2
ACCELERATION = 0.1 * np.pi / 4.0 * np.sin(np.pi * TIME / 2.0)
LOAD = 20e3 + 5e3 * np.cos(3.0 * TIME)
FRICTION = np.full(len(TIME), 40e3)


def work(torque: Floats, speed: Floats) -> float:
    power = torque * speed
    return float(STEP * (power[1:] + power[:-1]).sum() / 2)


def test_the_motor_gives_the_work_of_load_and_friction() -> None:
    motor = drive_torque(DRIVE, LOAD, FRICTION, SPEED, ACCELERATION)
    given = work(motor, DRIVE.ratio * SPEED)
    used = work(LOAD, SPEED) + work(FRICTION, np.abs(SPEED))
    assert given == pytest.approx(used, rel=1e-9)
    half = slice(0, len(TIME) // 2 + 1)
    kinetic = 0.5 * DRIVE.inertia * SPEED[half][-1] ** 2
    stored = work(motor[half], DRIVE.ratio * SPEED[half]) - work(
        (LOAD + FRICTION)[half], SPEED[half]
    )
    assert stored == pytest.approx(kinetic, rel=1e-6)


def test_as_printed_friction_gives_power_and_the_inertia_is_negative() -> None:
    still = 0.0 * ACCELERATION
    printed = printed_drive_torque(DRIVE, LOAD, FRICTION, SPEED, still)
    right = drive_torque(DRIVE, LOAD, FRICTION, SPEED, still)
    given = work(printed, DRIVE.ratio * SPEED) - work(LOAD, SPEED)
    assert given == pytest.approx(-work(FRICTION, SPEED), rel=1e-9)
    assert work(right, DRIVE.ratio * SPEED) - work(LOAD, SPEED) > 0.0
    assert DRIVE.printed_inertia < 0.0 < DRIVE.inertia


def test_a_blade_that_pushes_is_the_same_drive_with_loads_reversed() -> None:
    motor = drive_torque(DRIVE, -LOAD, FRICTION, SPEED, ACCELERATION)
    # Eq 5.1 with the sign of J a put right: the blade gives M_Z, motor and drive take it
    taken = LOAD - np.sign(SPEED) * FRICTION - DRIVE.part * ACCELERATION
    taken = (taken - DRIVE.ratio**2 * DRIVE.drive * ACCELERATION) / DRIVE.ratio
    assert motor == pytest.approx(-taken, rel=1e-12)


def test_reversing_motion_and_load_reverses_the_torque() -> None:
    forward = drive_torque(DRIVE, LOAD, FRICTION, SPEED, ACCELERATION)
    assert drive_torque(DRIVE, -LOAD, FRICTION, -SPEED, -ACCELERATION) == pytest.approx(-forward)


def test_a_part_that_stands_needs_its_load_less_what_friction_holds() -> None:
    zero = np.zeros(3)
    load = np.array([-50e3, 10e3, 50e3])
    friction = np.full(3, 40e3)
    assert (ring_torque(DRIVE, load, friction, zero, zero) == load).all()
    assert (holding_torque(load, friction) == [-10e3, 0.0, 10e3]).all()


def test_friction_of_the_makers_formula() -> None:
    found = friction_torque(3000e3, 200e3, 100e3, 2.0)
    assert found == pytest.approx(43.0836e3, rel=1e-12)
    assert friction_torque(-6000e3, 400e3, -200e3, 2.0) == pytest.approx(2 * found)
    assert friction_torque(3000e3, 200e3, 100e3, 2.0, 0.008) == pytest.approx(found * 8 / 6)
    # the same in kN and mm would be 1e-6 times as much: every term has one length and one force
    assert friction_torque(3e9, 200e3, 100e3, 2e3) == pytest.approx(1e3 * found)
    assert friction_torque(0.0, 0.0, 0.0, 2.0, constant=3e3, viscous=1e3) == 4e3
    with pytest.raises(InputError, match="diameter"):
        friction_torque(1.0, 1.0, 1.0, 0.0)


def test_a_spinning_rotor_gives_no_torque_about_the_axis_of_yaw() -> None:
    for tilt in (0.0, 0.1):
        spin = 2.0 * np.array([np.cos(tilt), 0.0, np.sin(tilt)])
        found = gyroscopic_torque(1e6, spin, np.array([0.0, 0.0, 0.01]))
        assert found == pytest.approx([0.0, -1e6 * 2.0 * np.cos(tilt) * 0.01, 0.0])


def test_shear_between_bridges_is_exact_without_wind_and_high_with_it() -> None:
    force, above, distance, q = 5e4, 2.0, 35.576, 100.0

    def bending(depth: float) -> float:
        return force * depth + q * depth**2 / 2

    found = shear_between(bending(above), bending(above + distance), distance)
    assert found - (force + q * above) == pytest.approx(q * distance / 2, rel=1e-9)
    free = shear_between(force * above, force * (above + distance), distance)
    assert free == pytest.approx(force, rel=1e-12)
    with pytest.raises(InputError, match="distance"):
        shear_between(0.0, 1.0, 0.0)


def test_moves_of_regular_yawing() -> None:
    step = 0.5
    event = np.concatenate([np.zeros(240), np.full(24, np.radians(5.0) / 12.0)])
    found = moves(np.concatenate([*[event] * 20, np.zeros(240)]), step, 1e-6)
    assert found.starts == len(found.first) == 20
    assert found.durations == pytest.approx(12.0)
    assert found.pauses == pytest.approx(120.0)
    assert np.degrees(found.angle) == pytest.approx(5.0)
    assert moves(np.tile(event, 20), step, 1e-6).duty == pytest.approx(12 / 132)


def test_the_peak_of_a_shutdown_is_where_it_accelerates() -> None:
    speed = np.interp(TIME, [0.5, 0.8, 3.2, 3.5], [0.0, 0.1, 0.1, 0.0])
    torque = drive_torque(DRIVE, LOAD, FRICTION, speed, np.gradient(speed, STEP))
    at = peak_times(torque, moves(speed, STEP, 1e-9))
    assert len(at) == 1
    assert 0.0 <= at[0] < 0.1


def test_rms_of_a_constant_torque_is_itself_and_of_ten_minutes_the_worst() -> None:
    assert thermal_torque(np.full(100, -7.0), 1.0) == pytest.approx(7.0)
    torque = np.concatenate([np.full(900, 3.0), np.full(600, 4.0), np.full(900, 3.0)])
    assert thermal_torque(torque, 1.0) == pytest.approx(4.0)
    assert thermal_torque(torque, 1.0, 1200.0) == pytest.approx(np.sqrt((9 + 16) / 2))


def test_teeth_are_counted_one_by_one() -> None:
    pitch = 2 * np.pi / 100
    # from the middle of tooth 0 to the middle of tooth 2 and back
    triangle = np.interp(np.arange(41), [0, 20, 40], [0.5, 2.5, 0.5]) * pitch
    counts = tooth_counts(triangle, 100)
    assert counts[:4] == pytest.approx([1.0, 2.0, 1.0, 0.0])
    walk = np.cumsum(np.random.default_rng(1).normal(size=500)) * pitch
    assert tooth_counts(walk, 100).sum() == pytest.approx(np.abs(np.diff(walk)).sum() / pitch)
    turns = tooth_counts(np.linspace(0.0, 6 * np.pi, 999), 100)
    assert turns == pytest.approx(3.0)
    doubled = tooth_counts(walk, 100, np.full(499, 2.0))
    assert doubled == pytest.approx(2 * tooth_counts(walk, 100))


def test_transients_add_their_time_and_no_other() -> None:
    levels = time_at_level(np.array([1.0, 2.0, 2.0]), 10.0, np.arange(0.0, 10.5, 0.5))
    added = with_transients(levels, 6.2, 1000)
    assert added.amount.sum() - levels.amount.sum() == pytest.approx(30.0)
    assert added.amount[12] == pytest.approx(30.0)
    with pytest.raises(InputError, match="outside"):
        with_transients(levels, 20.0, 1)
