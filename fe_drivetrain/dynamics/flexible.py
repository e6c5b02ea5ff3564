"""Flexible parts of a machine: carriers and a housing that are condensed elsewhere.

A carrier comes as a free body at its hub and the middles of its pins, of beams or of finite
elements (`fe_drivetrain.fidelity.component_frames`, `component_solid`); a housing as the spring
that it is, on its supports, at the axis of its ring.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from math import cos, sin

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import along_x, wrench_transport
from fe_drivetrain.dynamics.bodies import Body, Superelement
from fe_drivetrain.dynamics.planetary import PlanetarySet
from fe_drivetrain.dynamics.springs import Place
from fe_drivetrain.solve.condensation import Condensed

#: Of the length: where a pin of a carrier may be, from where its planet is.
PLACED = 1e-6


@dataclass(frozen=True)
class Housing:
    """A housing that is rigid in itself, on elastic supports.

    Attributes
    ----------
    position : tuple[float, float, float]
        Of the point where its stiffness is given [m].
    stiffness : Floats
        (6, 6) of its supports and arms there [N/m, N, N m/rad].
    mass, polar, transverse : float
        [kg], about x and across it [kg m^2].
    """

    position: tuple[float, float, float]
    stiffness: Floats
    mass: float
    polar: float
    transverse: float


@dataclass(frozen=True)
class Flexible:
    """What of a machine gives beside shafts and bearings.

    Attributes
    ----------
    carriers : Mapping[int, Condensed]
        By the number of the planetary stage, from 1: a free body with the points "hub", "pin_1" and
        so on.
    housing : Housing or None
        That rings and bearings are in; none where they are in the ground.
    """

    carriers: Mapping[int, Condensed] = field(default_factory=dict)
    housing: Housing | None = None


def carrier_element(
    body: Condensed, stage: PlanetarySet, carrier: str
) -> tuple[list[Body], Superelement, tuple[Place, ...]]:
    """A carrier's pins as bodies, and what joins them to its hub.

    The hub moves with the carrier's own body, which keeps all of its mass; pins have none. The
    condensed body is turned to the angle of the first planet, and moved so that its pins are there.

    Parameters
    ----------
    body : Condensed
        Free, "hub" and as many pins as planets.
    stage : PlanetarySet
        The stage at its azimuth.
    carrier : str
        Name of the carrier's body.

    Raises
    ------
    InputError
        Pins are not where planets are.
    """
    names = [f"pin_{k + 1}" for k in range(len(stage.angles))]
    wanted = ("hub", *names)
    if set(body.names) != set(wanted):
        raise InputError(
            f"carrier of {stage.name!r} has the points {', '.join(body.names)} but must have "
            f"{', '.join(wanted)}, one pin for each planet: condense it at these"
        )
    order = [body.names.index(name) for name in wanted]
    rows = np.concatenate([6 * k + np.arange(6) for k in order])
    own = body.positions[order]
    first = np.arctan2(own[1][2], own[1][1])
    angle = stage.angles[0] - first
    turn = np.array([[1, 0, 0], [0, cos(angle), -sin(angle)], [0, sin(angle), cos(angle)]])
    shift = np.asarray(stage.position) - along_x(own[1][0])
    places = own @ turn.T + shift
    centres = np.array([stage.centre(), *(stage.centre(k) for k in range(len(stage.angles)))])
    apart = float(np.abs(places[1:] - centres[1:]).max())
    if apart > PLACED * stage.centre_distance:
        raise InputError(
            f"carrier of {stage.name!r} has pins {apart:.3g} m from where its planets are: give "
            f"one with pins at equal angles on a circle of {2 * stage.centre_distance:g} m"
        )
    whole = np.kron(np.eye(2 * len(own)), turn)
    K = whole @ body.stiffness[np.ix_(rows, rows)] @ whole.T
    arm = np.eye(6 * len(own))
    arm[:6, :6] = wrench_transport(places[0] - centres[0])
    K = arm @ K @ arm.T
    pins = tuple(
        Place(f"{stage.name} pin body {k + 1}", stage.centre(k)) for k in range(len(stage.angles))
    )
    bodies = [Body(pin.body, pin.centre) for pin in pins]
    joined = (carrier, *(pin.body for pin in pins))
    return bodies, Superelement(f"{stage.name} carrier", joined, (K + K.T) / 2), pins


def housing_body(housing: Housing) -> tuple[Body, Superelement]:
    """The housing's body, and its spring to the ground."""
    body = Body("housing", housing.position, housing.mass, housing.polar, housing.transverse)
    return body, Superelement("housing", ("housing",), np.asarray(housing.stiffness, dtype=float))
