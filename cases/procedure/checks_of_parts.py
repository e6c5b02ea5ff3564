"""Checks of parts: misaligned shafts, pitch and yaw drives, rings, teeth, tower shear."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import round_off
from fe_drivetrain.procedure import (
    RingShape,
    SlewingDrive,
    drive_torque,
    friction_torque,
    holding_torque,
    influence_of_offsets,
    printed_drive_torque,
    ring_under_forces,
    shear_between,
    thermal_torque,
    tooth_counts,
    with_transients,
)
from fe_drivetrain.shafts.beam import Beam, BeamSection, condensed_beam
from fe_drivetrain.turbine_loads.histories import time_at_level

PITCH = SlewingDrive(part=12e3, drive=0.02, ratio=1500.0)
TIME = np.arange(0.0, 4.0005, 1e-3)
SPEED = 0.1 * np.sin(np.pi * TIME / 4.0) ** 2
ACCELERATION = 0.1 * np.pi / 4.0 * np.sin(np.pi * TIME / 2.0)
LOAD = 20e3 + 5e3 * np.cos(3.0 * TIME)
RESISTS = np.full(len(TIME), 40e3)


ROUNDED = round_off(1e4, "sums and products of a thousand numbers of order 1 to 10")


class Found(NamedTuple):
    """One check: what, ours, exact or printed and where from, allowed difference and why.

    Where `most` is true, no difference above the exact value is allowed but that, any below.
    """

    what: str
    ours: float
    exact: float
    source: str
    within: float = ROUNDED["within"]
    why: str = ROUNDED["why"]
    most: bool = False


def _work(torque: Floats) -> float:
    power = torque * SPEED
    return 1e-3 * float((power[1:] + power[:-1]).sum()) / 2.0


def misaligned() -> list[Found]:
    """Forces of offsets: none, linear, symmetric, scaling with stiffness."""
    at = np.array([-1.5, 0.0, 1.2, 2.2])
    K = condensed_beam(Beam([BeamSection(3.7, 0.6)], [], start=at[0]), tuple("abcd"), at).stiffness
    held = [(1, 0), (1, 1), (1, 2), (3, 1), (3, 2), (3, 3), (2, 1), (2, 2)]
    H = np.zeros((8, len(K)))
    for row, (station, direction) in zip(H, held, strict=True):
        row[6 * station + direction] = 1.0
    names, k = tuple(f"{s}{d}" for s, d in held), np.full(8, 1e9)
    three = influence_of_offsets(K, H[:6], k[:6], names[:6])
    four = influence_of_offsets(K, H, k, names)
    soft = influence_of_offsets(0.5 * K, H, 0.5 * k, names)
    u = np.random.default_rng(1).normal(size=8) * 1e-3
    size = float(np.abs(four.influence).max())
    return [
        Found(
            "largest force of statically determinate supports [N]",
            float(np.abs(three.influence).max()),
            0.0,
            "no state of self-stress",
            0.0,
            "nothing is added up: supports that can give way to an offset take no force of it",
        ),
        Found(
            "forces of offsets and of twice their reverse, over the largest",
            float(np.abs(four.forces(-2.0 * u) + 2.0 * four.forces(u)).max())
            / float(np.abs(four.forces(u)).max()),
            0.0,
            "linear",
        ),
        Found(
            "asymmetry of the influence, over its largest entry",
            float(np.abs(four.influence - four.influence.T).max()) / size,
            0.0,
            "Maxwell",
        ),
        Found(
            "forces with half of every stiffness, over half of them",
            float(np.abs(2.0 * soft.influence - four.influence).max()) / size,
            0.0,
            "scaling",
            1e-6,
            "rounding times the condition of a stiff shaft",
        ),
    ]


def slewing() -> list[Found]:
    """Power of a pitch motor, holding, reversing; Eq 5.1 as printed."""
    motor = drive_torque(PITCH, LOAD, RESISTS, SPEED, ACCELERATION)
    back = drive_torque(PITCH, -LOAD, RESISTS, -SPEED, -ACCELERATION)
    printed = printed_drive_torque(PITCH, LOAD, RESISTS, SPEED, 0.0 * SPEED)
    held = holding_torque(np.array([-50e3, 10e3, 50e3]), np.full(3, 40e3))
    ratio = PITCH.ratio
    return [
        Found(
            "work of the motor over that of load and friction",
            ratio * _work(motor) / (_work(LOAD) + _work(RESISTS)),
            1.0,
            "rest before and after",
            1e-9,
            "trapezia of smooth motions",
        ),
        Found(
            "work that friction takes, over its size: Eq 5.1 as printed",
            (ratio * _work(printed) - _work(LOAD)) / _work(RESISTS),
            -1.0,
            "friction with that sign gives power",
        ),
        Found(
            "sum of torques forth and back [N m]",
            float(np.abs(motor + back).max()),
            0.0,
            "symmetry",
        ),
        Found(
            "held, of 50 kN m with 40 kN m of friction [kN m]",
            float(held[2]) / 1e3,
            10.0,
            "statics",
        ),
        Found(
            "inertia of the whole by Eq 5.1 over the right one",
            PITCH.printed_inertia / PITCH.inertia,
            (12e3 - 45e3) / (12e3 + 45e3),
            "J_B -+ i^2 J_A",
            1e-12,
            "below zero: a motor would speed up when braked",
        ),
    ]


def friction() -> list[Found]:
    """The maker's formula of friction."""
    base = float(friction_torque(3000e3, 200e3, 100e3, 2.0))
    double = float(friction_torque(-6000e3, 400e3, -200e3, 2.0))
    metres = float(friction_torque(3e9, 200e3, 100e3, 2e3))
    return [
        Found(
            "friction of 3 MN m, 200 kN, 100 kN at 2 m [kN m]",
            base / 1e3,
            43.084,
            "by hand",
            5e-4,
            "half of the last digit that is printed",
        ),
        Found("of twice the loads, over it", double / base, 2.0, "homogeneous"),
        Found("in N mm, over it in N m", metres / base, 1e3, "one length in each term"),
        Found(
            "with mu 0.008 for 0.006, over it",
            float(friction_torque(3e6, 2e5, 1e5, 2.0, 0.008)) / base,
            8 / 6,
            "linear",
        ),
    ]


def ring() -> list[Found]:
    """A ring that keeps its length."""
    oval = RingShape(1.0, np.array([2]), np.array([1e-3]), np.zeros(1))
    angle = np.linspace(0.0, 2.0 * np.pi, 400, endpoint=False)
    stretch = np.gradient(oval.tangential(angle), angle[1]) + oval.radial(angle)
    along, across = oval.diameter([0.0, np.pi / 2.0])
    pulled = ring_under_forces(1.0, 1.0, [0.0, np.pi], [1.0, 1.0])
    return [
        Found(
            "change of length over the oval's amplitude",
            float(np.abs(stretch[1:-1]).max()) * 1e3,
            0.0,
            "u_t = -(w / 2) sin 2a",
            2e-4,
            "differences over 0.9 degrees",
        ),
        Found("diameter along over that across", along / across, -1.0, "+-2 w"),
        Found(
            "mean strain at gauges over the largest",
            float(oval.strain(angle, 0.05).mean() / oval.strain(0.0, 0.05)),
            0.0,
            "bending alone",
        ),
        Found(
            "strain over c w / R^2",
            float(oval.strain(0.0, 0.05)) / (0.05e-3),
            3.0,
            "3 c w cos 2a / R^2",
        ),
        Found(
            "two forces, along, over F R^3 / (E I)",
            float(pulled.diameter(0.0)),
            np.pi / 4 - 2 / np.pi,
            "pi / 4 - 2 / pi = 0.1488",
            1e-5,
            "60 waves",
        ),
        Found(
            "two forces, across",
            float(pulled.diameter(np.pi / 2)),
            0.5 - 2 / np.pi,
            "-(2 / pi - 1 / 2) = -0.1366",
            1e-5,
            "60 waves",
        ),
    ]


def teeth() -> list[Found]:
    """Tooth by tooth."""
    pitch = 2.0 * np.pi / 100
    walk = np.cumsum(np.random.default_rng(1).normal(size=500)) * pitch
    triangle = np.interp(np.arange(41), [0, 20, 40], [0.5, 2.5, 0.5]) * pitch
    turns = tooth_counts(np.linspace(0.0, 6.0 * np.pi, 999), 100)
    return [
        Found(
            "meshes over travel / pitch",
            float(tooth_counts(walk, 100).sum() / (np.abs(np.diff(walk)).sum() / pitch)),
            1.0,
            "a sum",
        ),
        Found(
            "three turns: meshes of the tooth with least and most, difference",
            float(np.ptp(turns)),
            0.0,
            "uniform",
        ),
        Found(
            "half a tooth, a tooth, half a tooth and back: error of the four counts",
            float(np.abs(tooth_counts(triangle, 100)[:4] - [1.0, 2.0, 1.0, 0.0]).max()),
            0.0,
            "by hand",
        ),
    ]


def thermal() -> list[Found]:
    """Heat of a constant torque."""
    return [
        Found(
            "root mean square of 600 s of -7 N m",
            thermal_torque(np.full(1000, -7.0), 1.0),
            7.0,
            "itself",
        )
    ]


def transients() -> list[Found]:
    """Time of transients in load durations."""
    before = time_at_level(np.array([1.0, 2.0, 2.0]), 10.0, np.arange(0.0, 10.5, 0.5))
    after = with_transients(before, 6.2, 1000)
    return [
        Found(
            "time that 1000 starts of 30 ms add [s]",
            float(after.amount.sum() - before.amount.sum()),
            30.0,
            "30 ms each",
        ),
        Found("of that, at their level [s]", float(after.amount[12]), 30.0, "6.2 is in 6 to 6.5"),
    ]


def shear() -> list[Found]:
    """Shear from two bridges."""
    force, above, distance, q = 5e4, 2.0, 35.576, 100.0

    def bending(depth: float, wind: float) -> float:
        return force * depth + wind * depth**2 / 2.0

    free, windy = (
        float(shear_between(bending(above, w), bending(above + distance, w), distance))
        for w in (0.0, q)
    )
    return [
        Found("free tower: estimate over the force", free / force, 1.0, "dM/dx"),
        Found(
            "wind q: estimate beyond the force at the upper bridge, over q L / 2",
            (windy - force - q * above) / (q * distance / 2.0),
            1.0,
            "above, not below",
        ),
    ]
