"""Interface loads and motions of a drivetrain on three points that moves: three bodies on springs.

Shaft, gearbox and generator are rigid bodies with six degrees of freedom each. The shaft stands on
the main bearing and in the gearbox, the gearbox on two torque arms; the turning parts wind up one
spring by ``i phi_shaft + (1 - i) phi_gearbox - phi_generator`` (i the ratio), so that the housing
takes T_LSS - T_HSS as it moves. Motions are from steady turning, small, and without gyroscopic
terms: those of the rotor are in the loads at the hub.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import wrench_transport
from fe_drivetrain.dynamics.bodies.bodies import Body, assemble
from fe_drivetrain.dynamics.bodies.equations import Loads, equations_of, varying
from fe_drivetrain.dynamics.bodies.springs import Place, Spring, bushing
from fe_drivetrain.dynamics.bodies.system import System, with_proportional_damping
from fe_drivetrain.dynamics.time.motion import State
from fe_drivetrain.dynamics.time.superposition import energy_error, exact_steps
from fe_drivetrain.procedure.interface_loads import Body as TableBody
from fe_drivetrain.procedure.interface_loads import Interface, LoadTable
from fe_drivetrain.procedure.three_points import ThreePoints


@dataclass(frozen=True)
class Mounts:
    """Stiffness and inertia of a drivetrain on three points.

    Attributes
    ----------
    bearing : tuple of float
        Main bearing along x, y, z [N/m]; it carries no moments.
    entrance : tuple of float
        Shaft in the gearbox: along x, y, z, about y, z [N/m, N m/rad].
    arm : tuple of float
        Each torque arm along x, y, z [N/m].
    supports : tuple of float
        Generator on its frame: along x, y, z, about y, z [N/m, N m/rad].
    torsion : float
        Torsional stiffness of all that winds up, referred to the high-speed shaft [N m/rad].
    grid : float
        Stiffness of the generator's torque against turning from steady turning [N m/rad].
    shaft, gearbox, generator : tuple of float
        Inertia about x and across it, about the centre of mass [kg m^2]; of the generator about x
        that of its rotor.
    seconds : float
        Damping over stiffness of all springs [s].
    """

    bearing: tuple[float, float, float]
    entrance: tuple[float, float, float, float, float]
    arm: tuple[float, float, float]
    supports: tuple[float, float, float, float, float]
    torsion: float
    grid: float
    shaft: tuple[float, float]
    gearbox: tuple[float, float]
    generator: tuple[float, float]
    seconds: float

    def __post_init__(self) -> None:
        stiff = (*self.bearing, *self.entrance, *self.arm, *self.supports, self.torsion, self.grid)
        inertias = (*self.shaft, *self.gearbox, *self.generator)
        if min(stiff) < 0.0 or min(inertias) <= 0.0 or self.seconds < 0.0:
            raise InputError(
                f"stiffnesses from {min(stiff):g}, inertias from {min(inertias):g}, damping over "
                f"stiffness {self.seconds:g} s: the first and the last must be 0 or more, "
                "inertias above 0"
            )


def moving_three_points(
    places: ThreePoints, mounts: Mounts, time: Floats, hub: Floats, weight: bool = True
) -> LoadTable:
    """Loads, displacements and accelerations at all interfaces under loads at the hub.

    The loads are straight between samples, for which the motion is exact; it begins in equilibrium
    with the first of them. Motions at an interface are those of the body that takes its loads.

    Parameters
    ----------
    places : ThreePoints
        Places, masses, ratio.
    mounts : Mounts
        Stiffness, inertia, damping.
    time : ndarray, (n,)
        Times of uniform step [s].
    hub : ndarray, (n, 6)
        Loads of the rotor on the shaft, at the hub [N, N m].
    weight : bool
        Whether the bodies have weight.

    Returns
    -------
    LoadTable
        Each body is in equilibrium with its weight and inertia in every row.

    Raises
    ------
    InputError
        A mass is not above zero.
    """
    at, centres = places.positions, places.centres
    driven = _driven(places, mounts, time, hub, weight)
    system, q, v = driven.system, driven.q, driven.velocity
    force = driven.history @ driven.patterns.T
    a = np.linalg.solve(system.mass, (force - q @ system.K - v @ system.C).T).T
    stretch = q @ system.rows.T * system.stiffness + v @ system.rows.T * system.damping
    loads = {"hub": np.asarray(hub, dtype=np.float64)}
    for name, rows in driven.parts.items():
        loads[name] = np.zeros((len(time), 6))
        for spring, direction in rows:
            loads[name] += stretch[:, [system.spring(spring)]] * direction
    interfaces = []
    for name, of, on in places.interfaces:
        body = 6 * list(centres).index(on)
        carry = wrench_transport(at[name] - centres[on]).T
        interfaces.append(
            Interface(
                name,
                of,
                on,
                at[name],
                loads[name],
                q[:, body : body + 6] @ carry.T,
                a[:, body : body + 6] @ carry.T,
            )
        )
    inertia = -a @ system.mass
    inertia += driven.patterns[:, 6]
    return LoadTable(
        np.asarray(time, dtype=np.float64),
        tuple(interfaces),
        tuple(
            TableBody(name, centre, inertia[:, 6 * k : 6 * k + 6])
            for k, (name, centre) in enumerate(centres.items())
        ),
    )


def moving_energy_error(
    places: ThreePoints, mounts: Mounts, time: Floats, hub: Floats, weight: bool = True
) -> float:
    """Energy that appears from nowhere in the motion of `moving_three_points`, over the largest.

    Work and losses are integrals over the given times, which must resolve the motion: give loads
    that are interpolated between their samples where these are far apart.

    Parameters
    ----------
    places, mounts : ThreePoints, Mounts
        The same as for `moving_three_points`.
    time, hub, weight : ndarray, ndarray, bool
        As there.

    Returns
    -------
    float
        Error as `fe_drivetrain.dynamics.energy_error` gives it.

    Raises
    ------
    InputError
        A mass is not above zero.
    """
    driven = _driven(places, mounts, time, hub, weight)
    equations = equations_of(driven.system)
    return energy_error(equations, driven.loads, driven.loads.times, driven.q, driven.velocity)


_Parts = dict[str, list[tuple[str, Floats]]]


@dataclass(frozen=True, eq=False)
class _Driven:
    """Bodies on springs, what loads them, and how they move."""

    system: System
    parts: _Parts
    patterns: Floats  # (18, 7), of the hub's six loads and of the weights
    history: Floats  # (n, 7)
    loads: Loads
    q: Floats
    velocity: Floats


def _driven(
    places: ThreePoints, mounts: Mounts, time: Floats, hub: Floats, weight: bool
) -> _Driven:
    """Exact motion under loads that are straight between samples."""
    masses = (places.shaft_mass, places.gearbox_mass, places.generator_mass)
    if min(masses) <= 0.0:
        raise InputError(f"masses are {masses} kg but must be above 0 in motion: state them")
    centres = places.centres
    inertias = (mounts.shaft, mounts.gearbox, mounts.generator)
    bodies = [
        Body(name, tuple(centre), mass, polar, across)
        for (name, centre), mass, (polar, across) in zip(
            centres.items(), masses, inertias, strict=True
        )
    ]
    springs, parts = _springs(places, mounts)
    system = with_proportional_damping(assemble(bodies, springs), mounts.seconds)
    own = np.array([0.0, 0.0, -GRAVITY if weight else 0.0])
    step = float(time[1] - time[0])
    patterns = np.zeros((18, 7))
    patterns[:6, :6] = wrench_transport(places.positions["hub"] - centres["shaft"])
    patterns[:, 6] = system.gravity(own)
    history = np.column_stack([hub, np.ones(len(time))])
    loads = varying(patterns, np.arange(len(time)) * step, history)
    start = np.linalg.solve(system.K, patterns @ history[0])
    _, q, v = exact_steps(
        equations_of(system),
        loads,
        (len(time) - 1) * step,
        step,
        State(start, np.zeros(18), np.zeros(18)),
    )
    return _Driven(system, parts, patterns, history, loads, q, v)


def _springs(places: ThreePoints, mounts: Mounts) -> tuple[list[Spring], _Parts]:
    """Springs, and of each interface those that it has, with what a unit force of each is there."""
    at, centres = places.positions, places.centres
    place = {name: Place(name, tuple(centre)) for name, centre in centres.items()}
    five = (0, 1, 2, 4, 5)
    springs: list[Spring] = []
    parts: _Parts = {}

    def add(name: str, one: str, other: str | None, k: Floats, sign: float) -> None:
        held = bushing(name, place[one], None if other is None else place[other], at[name], k)
        springs.extend(held)
        numbers = np.flatnonzero(k)
        parts[name] = [
            (spring.name, sign * np.eye(6)[i]) for spring, i in zip(held, numbers, strict=True)
        ]

    # a stretched spring pulls its first body back, and the other along
    add("main bearing", "shaft", None, _six((0, 1, 2), mounts.bearing), -1.0)
    add("gearbox entrance", "shaft", "gearbox", _six(five, mounts.entrance), 1.0)
    add("left arm", "gearbox", None, _six((0, 1, 2), mounts.arm), -1.0)
    add("right arm", "gearbox", None, _six((0, 1, 2), mounts.arm), -1.0)
    supports = _six((*five, 3), (*mounts.supports, mounts.grid))
    add("generator supports", "generator", None, supports, -1.0)
    turn = np.eye(6)[3]
    ratio = places.ratio
    by = {"shaft": ratio * turn, "gearbox": (1.0 - ratio) * turn, "generator": -turn}
    springs.append(Spring("winding", by, mounts.torsion))
    parts["gearbox entrance"].append(("winding", ratio * turn))
    parts["high-speed shaft"] = [("winding", -turn)]
    return springs, parts


def _six(which: tuple[int, ...], values: tuple[float, ...]) -> Floats:
    found = np.zeros(6)
    found[list(which)] = values
    return found
