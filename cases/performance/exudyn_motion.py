"""Exudyn's generalised alpha on equations of motion of this project: an independent integrator.

The matrices go into an ObjectGenericODE2; what the laws of springs and the loads add is its force,
a function of time, displacements and velocities, with the derivative that Newton's method takes.
"""

from importlib import import_module
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics.bodies.equations import Equations, Loads
from fe_drivetrain.dynamics.bodies.steady_state import restoring
from fe_drivetrain.dynamics.time.motion import State, at_rest
from fe_drivetrain.export.programs.exudyn_system import exudyn_version


def exudyn_motion(
    equations: Equations,
    loads: Loads,
    duration: float,
    dt: float,
    spectral_radius: float = 1.0,
    start: State | None = None,
) -> tuple[Floats, Floats]:
    """Motion as Exudyn integrates it.

    Parameters
    ----------
    equations : Equations
        What moves; dampers of springs with gaps work whenever they are in contact.
    loads : Loads
        On it.
    duration, dt : float
        Of all and of a step [s].
    spectral_radius : float
        Of generalised alpha at infinite frequency; 1 is without numerical damping.
    start : State, optional
        Displacements and velocities at time 0, at rest where left out.

    Returns
    -------
    times : Floats
        (k,) [s].
    q : Floats
        (k, n).

    Raises
    ------
    MissingToolError
        Exudyn is not installed.
    ArithmeticError
        Its Newton's method does not converge.
    """
    exudyn_version()
    exudyn = import_module("exudyn")
    container = exudyn.SystemContainer()  # the system does not outlive it
    system = container.AddSystem()
    sensor = fill(system, equations, loads, start or at_rest(equations))
    settings = settings_of(exudyn, duration, dt, spectral_radius)
    if not system.SolveDynamic(settings):
        raise ArithmeticError("Exudyn's time integration does not converge")
    found = np.asarray(system.GetSensorStoredData(sensor))
    return found[:, 0], found[:, 1:]


def fill(system: Any, equations: Equations, loads: Loads, begin: State) -> Any:
    """Add the equations to Exudyn's system; return the sensor of its coordinates."""
    items = import_module("exudyn.itemInterface")
    n = len(equations.mass)
    node = system.AddNode(
        items.NodeGenericODE2(
            referenceCoordinates=[0.0] * n,
            initialCoordinates=begin.q.tolist(),
            initialCoordinates_t=begin.velocity.tolist(),
            numberOfODE2Coordinates=n,
        )
    )
    system.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=equations.mass,
            stiffnessMatrix=equations.K,
            dampingMatrix=equations.C,
            **laws_of(equations, loads),
        )
    )
    return assembled(system, node)


def assembled(system: Any, node: Any) -> Any:
    """Assemble Exudyn's system, and return the sensor of a node's coordinates."""
    exudyn, items = import_module("exudyn"), import_module("exudyn.itemInterface")
    sensor = system.AddSensor(
        items.SensorNode(
            nodeNumber=node,
            storeInternal=True,
            outputVariableType=exudyn.OutputVariableType.Coordinates,
        )
    )
    system.Assemble()
    return sensor


def laws_of(equations: Equations, loads: Loads) -> dict[str, Any]:
    """Forces beside K and C as a function, and their tangent where springs have a law."""
    K, C = equations.K, equations.C

    def force(_: Any, t: float, __: int, q: Any, velocity: Any) -> Floats:
        at, rate = np.array(q), np.array(velocity)
        inside = restoring(equations, t, at, rate)[0]
        return np.asarray(loads.at(t) - inside + K @ at + C @ rate)

    def jacobian(_: Any, t: float, __: int, q: Any, v: Any, by_q: float, by_v: float) -> Floats:
        tangent = restoring(equations, t, np.array(q), np.array(v))[1]
        return np.asarray(-by_q * tangent - by_v * C)

    laws: dict[str, Any] = {"forceUserFunction": force}
    return laws | ({"jacobianUserFunction": jacobian} if equations.springs.special.any() else {})


def settings_of(exudyn: Any, duration: float, dt: float, spectral_radius: float) -> Any:
    """Exudyn's settings of its time integration."""
    settings = exudyn.SimulationSettings()
    time = settings.timeIntegration
    time.numberOfSteps = round(duration / dt)
    time.endTime = duration
    time.verboseMode = 0
    time.newton.useModifiedNewton = False
    time.generalizedAlpha.spectralRadius = spectral_radius
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = dt
    return settings
