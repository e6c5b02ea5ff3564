"""Exudyn's generalised alpha on equations of motion of this project: an independent integrator.

The matrices go into an ObjectGenericODE2; what the laws of springs and the loads add is its force,
a function of time, displacements and velocities, with the derivative that Newton's method takes.
"""

from importlib import import_module
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics.equations import Equations, Loads
from fe_drivetrain.dynamics.motion import State, at_rest
from fe_drivetrain.dynamics.steady_state import restoring
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
    exudyn, items = import_module("exudyn"), import_module("exudyn.itemInterface")
    n = len(equations.mass)
    K, C = equations.K, equations.C
    begin = start or at_rest(equations)
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    node = system.AddNode(
        items.NodeGenericODE2(
            referenceCoordinates=[0.0] * n,
            initialCoordinates=begin.q.tolist(),
            initialCoordinates_t=begin.velocity.tolist(),
            numberOfODE2Coordinates=n,
        )
    )

    def force(_: Any, t: float, __: int, q: Any, velocity: Any) -> Floats:
        at, rate = np.array(q), np.array(velocity)
        inside = restoring(equations, t, at, rate)[0]
        return np.asarray(loads.at(t) - inside + K @ at + C @ rate)

    laws: dict[str, Any] = {}
    if equations.springs.special.any():

        def jacobian(_: Any, t: float, __: int, q: Any, v: Any, by_q: float, by_v: float) -> Floats:
            tangent = restoring(equations, t, np.array(q), np.array(v))[1]
            return np.asarray(-by_q * tangent - by_v * C)

        laws["jacobianUserFunction"] = jacobian
    system.AddObject(
        items.ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=equations.mass,
            stiffnessMatrix=K,
            dampingMatrix=C,
            forceUserFunction=force,
            **laws,
        )
    )
    sensor = system.AddSensor(
        items.SensorNode(
            nodeNumber=node,
            storeInternal=True,
            outputVariableType=exudyn.OutputVariableType.Coordinates,
        )
    )
    system.Assemble()
    settings = exudyn.SimulationSettings()
    time = settings.timeIntegration
    time.numberOfSteps = round(duration / dt)
    time.endTime = duration
    time.verboseMode = 0
    time.newton.useModifiedNewton = False
    time.generalizedAlpha.spectralRadius = spectral_radius
    settings.solutionSettings.writeSolutionToFile = False
    settings.solutionSettings.sensorsWritePeriod = dt
    if not system.SolveDynamic(settings):
        raise ArithmeticError("Exudyn's time integration does not converge")
    found = np.asarray(system.GetSensorStoredData(sensor))
    return found[:, 0], found[:, 1:]
