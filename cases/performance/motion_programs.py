"""Programs that integrate the same equations in time, each by the methods that serve it best.

Exudyn is given the matrices as an ObjectGenericODE2. A mesh whose stiffness varies is one of its
springs between a coordinate and ground, with a symbolic force that it evaluates without Python; for
that, elongations of meshes take the place of as many coordinates. ROSS builds the gear pair by its
own MultiRotor; its Newmark method takes any matrices, of the stage, too, and those that vary by a
Python function, which is quicker than a MultiRotor that assembles its matrices in each step.
"""

from __future__ import annotations

import contextlib
import io
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

import numpy as np
from scipy import linalg

from fe_drivetrain.cases.performance.exudyn_motion import assembled
from fe_drivetrain.cases.performance.motion_problems import (
    BEARING,
    BEARING_DAMPING,
    DRIVEN,
    DRIVING,
    LENGTH,
    MESH,
    MODULE,
    PRESSURE_ANGLE,
    RECORD,
    SPEED,
    STEEL,
    TEETH,
    Problem,
    Shaft,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.common.arrays import Ints
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics import AVERAGE, Loads, exponential_steps, integrate
from fe_drivetrain.export.programs.exudyn_system import exudyn_version
from fe_drivetrain.export.programs.ross_rotor import FROM_PROJECT, ross_version

OURS, EXUDYN, ROSS = "this project", "Exudyn", "ROSS"

Solve = Callable[[int], Callable[[], Floats]]
"""From a number of steps between records to what is timed: displacements at the records."""


@dataclass(frozen=True)
class Method:
    """A method of a program on a problem.

    Attributes
    ----------
    program : str
        `OURS`, `EXUDYN` or `ROSS`.
    name : str
        The method in its words.
    exact : bool
        Whether its steps have no error here, so that the longest is the one to take.
    solve : callable
        From steps between records to the run.
    """

    program: str
    name: str
    exact: bool
    solve: Solve

    __repr__ = short_repr


def own_methods(problem: Problem) -> list[Method]:
    """This project's: exponentials, and average acceleration, which most programs have."""
    e, loads, duration = problem.equations, problem.loads, problem.duration

    def exponentials(steps: int) -> Callable[[], Floats]:
        return lambda: exponential_steps(e, loads, duration, RECORD / steps, every=steps).q

    def average(steps: int) -> Callable[[], Floats]:
        return lambda: integrate(e, loads, duration, RECORD / steps, AVERAGE, every=steps).q

    return [
        Method(OURS, "exponentials", not problem.varies, exponentials),
        Method(OURS, "average acceleration", False, average),
    ]


# --- Exudyn ---


def fast_exudyn_version() -> str:
    """The version of Exudyn, whose build without checks of ranges is taken if none is loaded yet.

    Raises
    ------
    MissingToolError
        Exudyn is not installed.
    """
    sys.__dict__.setdefault("exudynFast", True)
    return exudyn_version()


def exudyn_methods(problem: Problem) -> list[Method]:
    """Generalised alpha without numerical damping, and explicit methods of order 4, 5 and 6.

    Raises
    ------
    MissingToolError
        Exudyn is not installed.
    """
    fast_exudyn_version()
    exudyn = import_module("exudyn")
    kinds = exudyn.DynamicSolverType
    return [
        Method(EXUDYN, name, False, _exudyn_run(exudyn, problem, kind))
        for name, kind in (
            ("generalised alpha", kinds.GeneralizedAlpha),
            ("RK44", kinds.RK44),
            ("RK67", kinds.RK67),
        )
    ]


def _exudyn_run(exudyn: Any, problem: Problem, kind: Any) -> Solve:
    """Runs of one system that is assembled once; only its solver is timed."""

    def prepared(steps: int) -> Callable[[], Floats]:
        container = exudyn.SystemContainer()
        system = container.AddSystem()
        sensor, back, kept = _fill(exudyn, system, problem)
        settings = exudyn.SimulationSettings()
        time = settings.timeIntegration
        time.numberOfSteps = steps * problem.records
        time.endTime = problem.duration
        time.verboseMode = 0
        time.newton.useModifiedNewton = True
        time.generalizedAlpha.spectralRadius = 1.0
        settings.linearSolver.solverType = exudyn.LinearSolverType.EXUdense
        settings.solution.file.write = False
        settings.solution.sensors.writePeriod = RECORD
        settings.parallel.numberOfThreads = 1

        def run() -> Floats:
            assert container is not None  # the system does not outlive it, nor its functions
            assert kept
            if not system.SolveDynamic(settings, solverType=kind):
                raise ArithmeticError("Exudyn's time integration does not converge")
            return np.asarray(system.GetSensorStoredData(sensor))[:, 1:] @ back.T

        return run

    return prepared


def _fill(exudyn: Any, system: Any, problem: Problem) -> tuple[Any, Floats, list[Any]]:
    """The problem in Exudyn's system; the sensor of its coordinates z, T of q = T z, functions."""
    items, e = import_module("exudyn.itemInterface"), problem.equations
    n = len(e.mass)
    T, meshes = coordinates(problem) if problem.varies else (np.eye(n), np.zeros(0, np.int64))
    node = system.AddNode(
        items.NodeGenericODE2(
            referenceCoordinates=[0.0] * n,
            initialCoordinates=[0.0] * n,
            initialCoordinates_t=[0.0] * n,
            numberOfODE2Coordinates=n,
        )
    )
    system.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=T.T @ e.mass @ T,
            stiffnessMatrix=T.T @ e.K @ T,
            dampingMatrix=T.T @ e.C @ T,
        )
    )
    functions = [
        *_add_loads(exudyn, system, node, problem.loads, T),
        *_add_meshes(exudyn, system, node, problem, meshes),
    ]
    return assembled(system, node), T, functions


def _symbolic(system: Any, function: Any, name: str, kind: str) -> Any:
    """A function as Exudyn's expression; it lives as long as it is kept."""
    make = import_module("exudyn.advancedUtilities").CreateSymbolicUserFunction
    return make(system, function=function, userFunctionName=name, itemTypeName=kind)


def _marker(system: Any, node: Any, coordinate: int) -> Any:
    items = import_module("exudyn.itemInterface")
    return system.AddMarker(items.MarkerNodeCoordinate(nodeNumber=node, coordinate=coordinate))


def _add_loads(exudyn: Any, system: Any, node: Any, loads: Loads, T: Floats) -> list[Any]:
    """Loads on the coordinates, and their functions."""
    items, functions = import_module("exudyn.itemInterface"), []
    force = T.T @ loads.patterns[:, 0]
    torque = _history(exudyn.symbolic, loads.times, loads.histories[:, 0])
    for coordinate in np.flatnonzero(np.abs(force) > 1e-12 * np.abs(force).max()).tolist():
        functions.append(_symbolic(system, torque, "loadUserFunction", "LoadCoordinate"))
        system.AddLoad(
            items.LoadCoordinate(
                markerNumber=_marker(system, node, coordinate),
                load=float(force[coordinate]),
                loadUserFunction=functions[-1],
            )
        )
    return functions


def _add_meshes(exudyn: Any, system: Any, node: Any, problem: Problem, meshes: Ints) -> list[Any]:
    """What varies of each mesh, as a spring between its elongation and ground; their functions."""
    items, functions = import_module("exudyn.itemInterface"), []
    ground = _marker(system, system.AddNode(items.NodePointGround()), 0)
    for k, coordinate in enumerate(meshes.tolist()):
        wave = _wave(exudyn.symbolic, problem.frequency, float(problem.phases[k]))
        functions.append(
            _symbolic(
                system, wave, "springForceUserFunction", "ObjectConnectorCoordinateSpringDamper"
            )
        )
        system.AddObject(
            items.CoordinateSpringDamper(
                markerNumbers=[ground, _marker(system, node, coordinate)],
                stiffness=float(problem.depth * problem.stiffness[k]),
                springForceUserFunction=functions[-1],
            )
        )
    return functions


def _history(symbolic: Any, times: Floats, values: Floats) -> Any:
    """A load times a history that is linear between its times, as Exudyn's symbols."""
    slopes = np.diff(values) / np.diff(times)
    bends = np.diff(np.concatenate([[0.0], slopes]))

    def load(_: Any, t: Any, value: Any) -> Any:
        found = symbolic.Real(float(values[0]))
        for at, bend in zip(times.tolist(), bends.tolist(), strict=False):
            if bend:
                found = found + bend * symbolic.max(t - at, symbolic.Real(0.0))
        return value * found

    return load


def _wave(symbolic: Any, frequency: float, phase: float) -> Any:
    """A spring whose stiffness is a cosine of time, as Exudyn's symbols."""

    def force(_: Any, t: Any, __: Any, u: Any, ___: Any, k: Any, ____: Any, _____: Any) -> Any:
        return k * u * symbolic.cos(2.0 * np.pi * frequency * t + 2.0 * np.pi * phase)

    return force


def coordinates(problem: Problem) -> tuple[Floats, Ints]:
    """T of q = T z whose z are q, but elongations of meshes in place of some that have no load.

    Returns
    -------
    T, places : Floats, Ints
        (n, n), and places (meshes,) of the elongations among z.
    """
    H, n = problem.rows, problem.rows.shape[1]
    root = np.sqrt(np.diag(problem.equations.mass))
    free = np.flatnonzero(problem.loads.patterns[:, 0] == 0.0)
    pivots = linalg.qr((H / root)[:, free], mode="r", pivoting=True)[1]
    places = free[pivots[: problem.meshes]]
    Z = np.eye(n)
    Z[places] = H
    return np.asarray(np.linalg.inv(Z), dtype=np.float64), np.asarray(places, dtype=np.int64)


# --- ROSS ---


def ross_methods(problem: Problem) -> list[Method]:
    """Newmark's method; and of the gear pair with constant matrices SciPy's exponentials.

    Raises
    ------
    MissingToolError
        ROSS is not installed.
    """
    ross_version()
    found = [Method(ROSS, "Newmark", False, _ross_newmark(problem))]
    if not problem.varies and problem.meshes == 1:
        found.insert(0, Method(ROSS, "exponentials, of SciPy", True, _ross_exponentials(problem)))
    return found


def _forces(problem: Problem, steps: int) -> tuple[Floats, Floats]:
    times = RECORD / steps * np.arange(steps * problem.records + 1, dtype=np.float64)
    return times, problem.loads.at(times)


def _ross_newmark(problem: Problem) -> Solve:
    e, newmark = problem.equations, import_module("ross.utils").newmark
    M, C, K = e.mass, e.C, e.K
    H, varied = problem.rows, problem.depth * problem.stiffness

    def prepared(steps: int) -> Callable[[], Floats]:
        times, F = _forces(problem, steps)
        angles = 2.0 * np.pi * (problem.frequency * times[:, None] + problem.phases)
        stiffness = varied * np.cos(angles)

        def constant(step: int, **_: Any) -> tuple[Floats, Floats, Floats, Floats]:
            return M, C, K, F[step]

        def varying(step: int, **_: Any) -> tuple[Floats, Floats, Floats, Floats]:
            return M, C, K + (H.T * stiffness[step]) @ H, F[step]

        def run() -> Floats:
            system = varying if problem.varies else constant
            # its limit of a step's residual is that of a force [N]: below what its steps leave
            return np.asarray(newmark(system, times, len(M), tol=1e-5)[::steps])

        return run

    return prepared


def _ross_exponentials(problem: Problem) -> Solve:
    rotor, order = ross_pair(), ross_order()

    def prepared(steps: int) -> Callable[[], Floats]:
        times, F = _forces(problem, steps)
        F = F[:, order]

        def run() -> Floats:
            with contextlib.redirect_stdout(io.StringIO()):
                found = rotor.time_response(SPEED, F, times)[1]
            return np.asarray(found[::steps, np.argsort(order)])

        return run

    return prepared


def ross_order() -> Ints:
    """Places of ROSS's degrees of freedom among those of the gear pair."""
    return np.asarray(np.add.outer(6 * np.arange(6), FROM_PROJECT).ravel())


def ross_pair() -> Any:
    """The gear pair as ROSS's MultiRotor.

    Raises
    ------
    MissingToolError
        ROSS is not installed.
    """
    ross_version()
    ross = import_module("ross")
    # a shaft without mass, as near as ROSS lets it
    steel = ross.Material(
        name="massless", rho=1e-9, E=STEEL.youngs_modulus, G_s=STEEL.shear_modulus
    )
    rotors = [
        _ross_rotor(ross, steel, shaft, teeth)
        for shaft, teeth in zip((DRIVING, DRIVEN), TEETH, strict=True)
    ]
    return ross.MultiRotor(*rotors, coupled_nodes=(1, 1), gear_mesh_stiffness=MESH)


def _ross_rotor(ross: Any, material: Any, shaft: Shaft, teeth: int) -> Any:
    elements = [
        ross.ShaftElement(
            L=LENGTH,
            idl=0.0,
            odl=shaft.diameter,
            material=material,
            shear_effects=True,
            shear_method_calc="cowper",
        )
        for _ in range(2)
    ]
    first, gear, last = shaft.discs
    discs = [
        ross.DiskElement(n=0, m=first.mass, Id=first.across, Ip=first.polar),
        ross.GearElement(
            n=1,
            m=gear.mass,
            Id=gear.across,
            Ip=gear.polar,
            n_teeth=teeth,
            pitch_diameter=MODULE * teeth,
            pr_angle=PRESSURE_ANGLE,
        ),
        ross.DiskElement(n=2, m=last.mass, Id=last.across, Ip=last.polar),
    ]
    along, across, _ = BEARING
    bearings = [
        ross.BearingElement(n=node, kxx=across, kyy=across, kzz=along, cxx=BEARING_DAMPING)
        for node in (0, 2)
    ]
    return ross.Rotor(elements, discs, bearings)
