"""One gear pair and one planetary stage in time: equations, a torque history, and the reference.

The pair has two shafts without mass of two beam elements each, on bearings at their ends, discs at
all nodes, and a spring along the line of action between the two in the middle. Its degrees of
freedom are ux (along the shaft), uy, uz, rx, ry, rz of each node; the driven shaft's angle counts
against that of the driving one, as in ROSS's MultiRotor. The stage is Lin and Parker's of 1999.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from scipy.integrate import solve_ivp

from fe_drivetrain.cases.references.published_planetary import lin_parker_stage, plane_system
from fe_drivetrain.common import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.dynamics import (
    Equations,
    Loads,
    equations_of_motion,
    fourier_wave,
    spring_laws,
    varying,
)
from fe_drivetrain.dynamics.bodies.equations import SpringLaws
from fe_drivetrain.shafts.beam.frame import beam_stiffness, round_section

STEEL = Material(youngs_modulus=2.1e11, poisson_ratio=0.3, density=0.0)
PRESSURE_ANGLE = np.radians(20.0)
TEETH = (25, 50)
MODULE = 0.004  # m
MESH = 3e8  # N/m
LENGTH = 0.15  # m, of each of the two elements of a shaft
BEARING = (5e7, 2e8, 2e8)  # N/m along the shaft and across it
BEARING_DAMPING = 2e3  # N s/m, across the shaft
SPEED = 2.0 * np.pi * 25.0  # rad/s, of the driving shaft
DEPTH = 0.25
"""Amplitude of a mesh stiffness that varies, over its mean."""

RECORD = 5e-4
"""Time between records, at which all programs are compared [s]."""

#: Torque on the driving side over its nominal value at times [s]: a ramp, and a loss of half.
TIMES, HISTORY = (0.0, 0.005, 0.03, 0.032, 1.0), (0.0, 1.0, 1.0, 0.5, 0.5)


class Disc(NamedTuple):
    """Mass [kg], inertia about the shaft and across it [kg m^2] of a rigid disc."""

    mass: float
    polar: float
    across: float


class Shaft(NamedTuple):
    """Diameter [m] and discs of a shaft: on its first bearing, the gear, on its second bearing."""

    diameter: float
    discs: tuple[Disc, Disc, Disc]


DRIVING = Shaft(0.04, (Disc(5.0, 0.02, 0.012), Disc(3.1, 3.9e-3, 2.6e-3), Disc(1.0, 5e-4, 3e-4)))
DRIVEN = Shaft(0.06, (Disc(1.5, 1e-3, 6e-4), Disc(12.3, 0.0617, 0.034), Disc(15.0, 0.15, 0.09)))


@dataclass(frozen=True)
class Problem:
    """What all programs integrate from rest.

    Attributes
    ----------
    title : str
        What it is.
    equations : Equations
        Mass, dampers, springs; those of the meshes stand first.
    loads : Loads
        Torque history, linear between its times.
    duration : float
        Duration [s], a whole number of records.
    meshes : int
        Number of springs that are meshes.
    depth : float
        Amplitude of their stiffness over its mean; 0 where it is constant.
    frequency : float
        How often it repeats [Hz].
    phases : Floats
        Periods (meshes,) at time 0.
    """

    title: str
    equations: Equations
    loads: Loads
    duration: float
    meshes: int
    depth: float
    frequency: float
    phases: Floats

    __repr__ = short_repr

    @property
    def varies(self) -> bool:
        """Whether stiffness varies."""
        return self.depth > 0.0

    @property
    def rows(self) -> Floats:
        """(meshes, n) elongation of each mesh by the degrees of freedom."""
        return self.equations.springs.rows[: self.meshes]

    @property
    def stiffness(self) -> Floats:
        """(meshes,) mean stiffness [N/m]."""
        return self.equations.springs.stiffness[: self.meshes]

    @property
    def records(self) -> int:
        """Number of intervals between records."""
        return round(self.duration / RECORD)


def gear_pair(duration: float, depth: float = 0.0) -> Problem:
    """The gear pair, at a quarter of the mesh stiffness's mean more and less where it varies."""
    mass, gyroscopic, shafts = np.zeros((36, 36)), np.zeros((36, 36)), np.zeros((36, 36))
    ratio = TEETH[0] / TEETH[1]
    for s, (shaft, speed) in enumerate(((DRIVING, SPEED), (DRIVEN, -ratio * SPEED))):
        element = beam_stiffness(round_section(shaft.diameter, 0.3), LENGTH, STEEL)
        for k, disc in enumerate(shaft.discs):
            at = 6 * (3 * s + k) + np.arange(6)
            mass[at, at] = [*[disc.mass] * 3, disc.polar, disc.across, disc.across]
            # a disc that turns about x at that speed
            gyroscopic[at[4], at[5]], gyroscopic[at[5], at[4]] = (
                speed * disc.polar,
                -speed * disc.polar,
            )
            if k < 2:
                both = 6 * (3 * s + k) + np.arange(12)
                shafts[np.ix_(both, both)] += element
    sine, cosine = np.sin(PRESSURE_ANGLE), np.cos(PRESSURE_ANGLE)
    bases = [0.5 * MODULE * z * cosine for z in TEETH]
    mesh = np.zeros(36)
    mesh[6:12] = [0.0, sine, cosine, bases[0], 0.0, 0.0]
    mesh[24:30] = [0.0, -sine, -cosine, -bases[1], 0.0, 0.0]
    places = [6 * node + d for node in (0, 2, 3, 5) for d in range(3)]
    springs = np.vstack([mesh, np.eye(36)[places]])
    stiffness = np.concatenate([[MESH], np.tile(BEARING, 4)])
    damping = np.concatenate([[0.0], np.tile([0.0, BEARING_DAMPING, BEARING_DAMPING], 4)])
    pattern = np.zeros(36)
    pattern[3], pattern[33] = 200.0, -200.0 * bases[1] / bases[0]
    frequency = SPEED / (2.0 * np.pi) * TEETH[0]
    laws = spring_laws(springs, stiffness, damping)
    what = "a mesh stiffness that varies" if depth else "a constant mesh stiffness"
    return _problem(
        f"gear pair, {what}",
        (mass, laws, gyroscopic, shafts),
        varying(pattern, TIMES, HISTORY),
        (duration, 1, depth, frequency),
    )


def planetary_stage(duration: float, depth: float = 0.0) -> Problem:
    """Lin and Parker's stage of four planets; torque on the sun against the carrier.

    Damping is 1 % of critical at 2 kHz, in proportion to the stiffness.
    """
    system = plane_system(lin_parker_stage(4), 4)
    meshes = [k for k, name in enumerate(system.spring_names) if "-planet " in name]
    order = [*meshes, *(k for k in range(len(system.rows)) if k not in meshes)]
    laws = spring_laws(
        system.rows[order],
        system.stiffness[order],
        0.01 / (np.pi * 2000.0) * system.stiffness[order],
    )
    sun = system.load_on("sun", np.array([0, 0, 0, 100.0, 0, 0]))
    carrier = system.load_on("carrier", np.array([0, 0, 0, 1.0, 0, 0]))
    turns = _turning(system.mass, laws.rows, laws.stiffness)
    pattern = sun - carrier * (turns @ sun) / (turns @ carrier)
    what = "mesh stiffnesses that vary" if depth else "constant mesh stiffnesses"
    return _problem(
        f"planetary stage, {what}",
        (system.mass, laws, None, None),
        varying(pattern, TIMES, HISTORY),
        (duration, len(meshes), depth, 1000.0),
    )


def _turning(mass: Floats, rows: Floats, stiffness: Floats) -> Floats:
    """The motion (n,) that no spring resists."""
    root = np.sqrt(np.diag(mass))
    K = rows.T @ (stiffness[:, None] * rows) / np.outer(root, root)
    return np.asarray(np.linalg.eigh(K)[1][:, 0] / root)


def _problem(
    title: str,
    parts: tuple[Floats, SpringLaws, Floats | None, Floats | None],
    loads: Loads,
    given: tuple[float, int, float, float],
) -> Problem:
    mass, laws, damping, extra = parts
    duration, meshes, depth, frequency = given
    phases = np.arange(meshes) / meshes
    if depth:
        phase, number = np.zeros(len(laws.rows)), np.full(len(laws.rows), -1)
        phase[:meshes], number[:meshes] = phases, 0
        laws = laws.in_phase(phase, frequency).with_waves([fourier_wave([depth], [0.0])], number)
    equations = equations_of_motion(mass, laws, damping, extra)
    return Problem(title, equations, loads, duration, meshes, depth, frequency, phases)


def elongations(problem: Problem, q: Floats) -> Floats:
    """(records + 1, meshes) elongations of the meshes at the records [m], of displacements."""
    return np.asarray(q @ problem.rows.T)


def reference(problem: Problem) -> Floats:
    """Elongations at the records, by SciPy's explicit method of eighth order to twelve digits.

    Its own rates, from matrices and cosines; it begins again at each kink of the load.
    """
    e, n = problem.equations, len(problem.equations.mass)
    inverse = np.linalg.inv(e.mass)
    A = np.block([[np.zeros((n, n)), np.eye(n)], [-inverse @ e.K, -inverse @ e.C]])
    B = np.vstack([np.zeros((n, 1)), inverse @ problem.loads.patterns])
    H = np.hstack([problem.rows, np.zeros_like(problem.rows)])
    pushes = np.vstack([np.zeros((n, problem.meshes)), inverse @ problem.rows.T])
    varied = problem.depth * problem.stiffness

    def rates(t: float, y: Floats) -> Floats:
        torque = np.interp(t, problem.loads.times, problem.loads.histories[:, 0])
        found = A @ y + B[:, 0] * torque
        if problem.varies:
            wave = np.cos(2.0 * np.pi * (problem.frequency * t + problem.phases))
            found -= pushes @ (varied * wave * (H @ y))
        return np.asarray(found)

    times = RECORD * np.arange(problem.records + 1)
    kinks = [t for t in problem.loads.times if t < problem.duration * (1.0 - 1e-9)]
    state, found = np.zeros(2 * n), [np.zeros((2 * n, 1))]
    for begin, end in zip(kinks, [*kinks[1:], problem.duration], strict=True):
        at = times[(times > begin + 1e-9) & (times < end + 1e-9)]
        scale = 1e-13 * np.concatenate([np.full(n, 1e-5), np.full(n, 1e-1)])
        run = solve_ivp(rates, (begin, end), state, "DOP853", at, rtol=1e-12, atol=scale)
        found.append(run.y)
        state = run.y[:, -1]
    return elongations(problem, np.hstack(found)[:n].T)


def error_of(problem: Problem, q: Floats, exact: Floats) -> float:
    """Largest error of a mesh's elongation at the records, over the largest elongation."""
    return float(np.abs(elongations(problem, q) - exact).max() / np.abs(exact).max())
