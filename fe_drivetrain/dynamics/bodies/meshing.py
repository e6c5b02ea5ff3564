"""Gear meshes whose stiffness varies as pairs of teeth come and go: waves, frequencies, phases.

The stiffness of a mesh with the contact ratio C is n + 1 pairs' for the share C - n of a period, n
its whole part, and n pairs' else: C pairs' on average (Parker and Lin 2004; Park et al. 2021, Eq
4-9, whose sign makes it low where it should be high).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from math import pi
from typing import Literal

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics.bodies.equations import (
    Equations,
    equations_of,
    equations_of_motion,
    spring_laws,
    wave_table,
)
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.dynamics.bodies.mesh_errors import MeshError
from fe_drivetrain.dynamics.bodies.planetary import equal_angles
from fe_drivetrain.dynamics.bodies.steady_state import free_motions
from fe_drivetrain.dynamics.bodies.system import System, springs_named
from fe_drivetrain.gear.meshes import MeshStiffness, StiffnessTable, square_wave_series
from fe_drivetrain.gear.planets import ring_phases, sun_phases

HARMONICS = 8
"""Number of harmonics of the square wave, as in Park et al. 2021, Eq 10."""

INTERVALS = 256
"""Number of intervals of a wave's spline in a period."""

_ABOUT_AXIS = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0])


def contact_wave(contact_ratio: float, harmonics: int = HARMONICS) -> Floats:
    """Square wave of the pairs in contact over its mean, as a Fourier series; as `wave_table`.

    Parameters
    ----------
    contact_ratio : float
        Contact ratio C, at least 1; a whole number is without variation.
    harmonics : int
        Number of harmonics of the series, whose peaks pass the levels by some 9 %.

    Returns
    -------
    wave : Floats
        Wave that rises in the middle of the jump at phase 0.

    Raises
    ------
    InputError
        The contact ratio is below 1.
    """
    return wave_of(square_wave_series(1.0, contact_ratio, harmonics))


def wave_of(stiffness: MeshStiffness | StiffnessTable) -> Floats:
    """The course of a mesh stiffness over its mean, as `wave_table`."""
    phases = np.arange(INTERVALS) / INTERVALS
    return wave_table(stiffness.at(phases) / stiffness.mean)


@dataclass(frozen=True)
class Meshing:
    """Variation of a mesh's stiffness.

    Attributes
    ----------
    contact_ratio : float
        Mean number of pairs of teeth in contact.
    frequency : float
        Mesh frequency [Hz].
    phase : float
        Phase at t = 0 [periods].
    course : MeshStiffness or StiffnessTable, optional
        Stiffness of `fe_drivetrain.gear`, whose course over its mean is taken in place of the
        square wave; the mean is that of the system's spring.
    error : MeshError, optional
        Transmission error without load, along the normal of the teeth.
    """

    contact_ratio: float
    frequency: float
    phase: float = 0.0
    course: MeshStiffness | StiffnessTable | None = None
    error: MeshError | None = None

    def wave(self, harmonics: int = HARMONICS) -> Floats:
        """Course of the stiffness over its mean, as `wave_table`.

        Parameters
        ----------
        harmonics : int
            Number of harmonics of the square wave, where no course is given.
        """
        if self.course is None:
            return contact_wave(self.contact_ratio, harmonics)
        return wave_of(self.course)


def machine_meshing(
    machine: Machine,
    speed: float,
    contact_ratios: Mapping[str, float],
    courses: Mapping[str, MeshStiffness | StiffnessTable] | None = None,
    errors: Mapping[str, MeshError] | None = None,
) -> dict[str, Meshing]:
    """Frequencies and phases of all meshes of a machine, from its teeth.

    The constant phase between the two meshes of one planet, of its tooth's thickness, is not in it.

    Parameters
    ----------
    machine : Machine
        Table of the machine, with teeth.
    speed : float
        Speed of the rotor [rad/s].
    contact_ratios : Mapping[str, float]
        Contact ratios by "stage 1 sun-planet", "stage 1 ring-planet", "stage 2 mesh" and so on.
    courses : Mapping[str, MeshStiffness or StiffnessTable], optional
        Courses by the same names, of meshes that vary otherwise than as a square wave.
    errors : Mapping[str, MeshError], optional
        Transmission errors by the same names: of planets all with the phase of their mesh.

    Returns
    -------
    meshing : dict[str, Meshing]
        Variations by the names of the meshes of the machine's system.

    Raises
    ------
    InputError
        A contact ratio is missing, or a stage has no teeth.
    """
    found, given, faults = {}, courses or {}, errors or {}
    for number, ((_, teeth), stage) in enumerate(
        zip(machine.meshing, machine.stages, strict=True), start=1
    ):
        frequency = abs(speed * machine.speeds[number - 1]) * teeth[0] / (2.0 * pi)
        if isinstance(stage, PlanetaryData):
            places = np.array(equal_angles(stage.planets))
            phases = (of(teeth[1], teeth[0], places) for of in (sun_phases, ring_phases))
            for kind, of in zip(("sun-planet", "ring-planet"), phases, strict=True):
                mesh = f"stage {number} {kind}"
                ratio = _ratio(contact_ratios, mesh)
                for planet, phase in enumerate(of, start=1):
                    name = f"stage {number} {kind} {planet}"
                    turned = -float(phase) % 1.0
                    found[name] = Meshing(
                        ratio, frequency, turned, given.get(mesh), faults.get(mesh)
                    )
        else:
            name = f"stage {number} mesh"
            ratio = _ratio(contact_ratios, name)
            found[name] = Meshing(ratio, frequency, course=given.get(name), error=faults.get(name))
    return found


def _ratio(contact_ratios: Mapping[str, float], name: str) -> float:
    if name not in contact_ratios:
        raise InputError(f"no contact ratio of {name!r} is given: add it")
    return contact_ratios[name]


def varying_equations(
    system: System,
    meshing: Mapping[str, Meshing],
    speed: float = 0.0,
    *,
    backlash: float | None = None,
    damping: float = 0.0,
    harmonics: int = HARMONICS,
    by: Literal["time", "angle"] = "time",
) -> Equations:
    """Equations of motion of a system whose meshes vary with time or angle, and have errors.

    Parameters
    ----------
    system : System
        System in a frame at rest.
    meshing : Mapping[str, Meshing]
        Variations by the name of a mesh; all of its slices vary together.
    speed : float
        Reference speed of the rotor, for gyroscopic terms [rad/s].
    backlash : float, optional
        Backlash of all these meshes along their lines of action [m]: teeth part, and touch with
        their other flanks; without, meshes pull as they push.
    damping : float
        Damping of the system: C is this time [s] times the stiffness of the springs, beside their
        dampers.
    harmonics : int
        Number of harmonics of the waves.
    by : "time" or "angle"
        Whether phases go with the time, at the frequencies of the meshes, or with the angle of the
        carrier or gear that drives the stage, which passes as many periods at the reference speed
        (Park et al. 2021, Table 1: K(t) and K(theta)). Angles are then those since t = 0, whole
        turns with them.

    Returns
    -------
    equations : Equations

    Raises
    ------
    InputError
        A mesh is not in the system, a body without mass was eliminated by it, or angles are asked
        for without a reference speed, or of a system that does not turn freely.
    """
    count = len(system.spring_names)
    wave, phase, frequency = np.full(count, -1), np.zeros(count), np.zeros(count)
    half = np.zeros(count)
    error, error_phase, error_turns = np.full(count, -1), np.zeros(count), np.ones(count)
    waves: list[Floats] = []
    errors: list[Floats] = []
    for name, mesh in meshing.items():
        of = springs_named(system.spring_names, name, "mesh")
        for i in of:
            system.changeable(system.spring_names[i])
        waves.append(mesh.wave(harmonics))
        wave[of] = len(waves) - 1
        phase[of], frequency[of] = mesh.phase, mesh.frequency
        half[of] = 0.5 * (backlash or 0.0)
        if mesh.error is not None:
            errors.append(mesh.error.table)
            error[of] = len(errors) - 1
            error_phase[of], error_turns[of] = mesh.error.phase, mesh.error.turns
    dampers = system.damping + damping * system.stiffness
    springs = spring_laws(system.rows, system.stiffness, dampers, lower=-half, upper=half)
    if by == "time":
        springs = springs.in_phase(phase, frequency)
    else:
        springs = springs.in_phase(phase, 0.0, _periods_a_radian(system, frequency, speed))
    if waves:
        springs = springs.with_waves(np.stack(waves), wave)
    if errors:
        springs = springs.with_errors(np.stack(errors), error, phase=error_phase, turns=error_turns)
    return equations_of_motion(
        system.mass,
        springs,
        speed * system.gyroscopic,
        system.extra - speed**2 * system.centripetal,
    )


def _periods_a_radian(system: System, frequency: Floats, speed: float) -> Floats:
    """(m, n) mesh periods of each spring by the angle of the gear that drives its stage [1/rad]."""
    if not speed > 0.0:
        raise InputError(
            f"meshes that vary by angle have a reference speed of {speed:g} rad/s but need one "
            "above 0: give the speed at which their frequencies are"
        )
    found = np.zeros((len(frequency), len(system.names)))
    if not frequency.any():
        return found
    free = free_motions(equations_of(system))
    if free.shape[1] != 1:
        raise InputError(
            f"meshes that vary by angle need one way to turn, but the system has {free.shape[1]}: "
            "leave out what holds the generator"
        )
    rigid = free[:, 0]
    rotor = system.load_on("rotor", _ABOUT_AXIS)
    for i in np.flatnonzero(frequency):
        stage = " ".join(system.spring_names[i].split()[:2])
        carrier = f"{stage} carrier"
        row = system.load_on(carrier if carrier in system.bodies else f"{stage} gear", _ABOUT_AXIS)
        found[i] = frequency[i] / (speed * float(row @ rigid) / float(rotor @ rigid)) * row
    return found
