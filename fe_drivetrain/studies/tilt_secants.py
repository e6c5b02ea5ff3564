"""K_R of each bearing in the drivetrain, as a secant over load steps, beside that of its unit."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from fe_drivetrain.bearing_life.coupled.body import factors_of
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.bearing_units import UnitBounds
from fe_drivetrain.shafts.fidelity.quantities import unit_numbers
from fe_drivetrain.shafts.response.secant_stiffness import (
    fitted_spring,
    parts_of,
    secant,
    statement,
)
from fe_drivetrain.shafts.response.unit_loads import Response
from fe_drivetrain.studies.study_loads import EnteredLoads

#: Load steps that are taken, evenly over all.
_MAXIMUM = 5000
_AXES = {4: ("y", "tilt"), 5: ("z", "yaw")}


@dataclass(frozen=True)
class TiltSecant:
    """K_R of a bearing about one axis, as load steps in the drivetrain show it.

    Attributes
    ----------
    bearing, axis : str
        Which, and "y" or "z".
    stiffness : float
        Sum of M theta over sum of theta^2 [N m/rad].
    scatter : float
        Standard deviation of the secants over `stiffness`.
    bounds : tuple of float, float
        K_R of the unit by itself, soft and stiff [N m/rad].
    statement : str
        Whether one torsional spring is the right form, and if not, what breaks it.
    """

    bearing: str
    axis: str
    stiffness: float
    scatter: float
    bounds: tuple[float, float]
    statement: str


def tilt_secants(
    scene: Scene, response: Response, units: Mapping[str, UnitBounds], loads: EnteredLoads
) -> tuple[TiltSecant, ...]:
    """K_R of each bearing that carries moments, over at most 5,000 load steps.

    Parameters
    ----------
    scene : Scene
        The scene.
    response : Response
        Unit loads on its assembly; the weight of shaft, bearings and housings is left out.
    units : Mapping[str, UnitBounds]
        Stiffness of each bearing unit by itself.
    loads : EnteredLoads
        Hub loads.
    """
    every = -(-len(loads.together) // _MAXIMUM)
    weights = loads.given.weights[::every]
    factors = factors_of(loads.together[::every], scene.gearbox.weight).values
    return tuple(
        found
        for name, unit in units.items()
        for found in _of_bearing(name, unit, response, factors, weights / weights.sum())
    )


def loads_and_motions(response: Response, name: str, factors: Floats) -> tuple[Floats, Floats]:
    """Loads on a bearing and motions of its seat.

    Parameters
    ----------
    response : Response
        Unit loads on the assembly.
    name : str
        Name of the bearing.
    factors : ndarray, (n, k)
        Factors of the k unit loads, see `fe_drivetrain.bearing_life.coupled.factors_of`.

    Returns
    -------
    loads, motions : ndarray, (n, 6)
        What the drivetrain puts on the bearing [N, N m], about its centre, and the mean motion of
        its seat [m, rad].
    """
    return factors @ response.reactions[name].T, factors @ response.motions[f"{name}.seat"].T


def _of_bearing(
    name: str, unit: UnitBounds, response: Response, factors: Floats, weights: Floats
) -> Iterator[TiltSecant]:
    """K_R about y and z; none of a bearing that gives way to both."""
    soft, stiff = unit_numbers(unit.soft), unit_numbers(unit.stiff)
    on_bearing, motions = loads_and_motions(response, name, factors)
    spring = None
    for a, (axis, key) in _AXES.items():
        if stiff[key] == 0.0 or not motions[:, a].any():
            continue
        spring = fitted_spring(on_bearing, motions, weights) if spring is None else spring
        found = secant(on_bearing, motions, a, weights)
        try:
            words = statement(found, parts_of(on_bearing, motions, spring.matrix, a, weights))
        except InputError as reason:
            words = str(reason)
        yield TiltSecant(name, axis, found.stiffness, found.scatter, (soft[key], stiff[key]), words)


def secant_rows(found: Sequence[TiltSecant]) -> list[Record]:
    """Records of K_R in the drivetrain and alone [MN m/rad].

    Parameters
    ----------
    found : sequence of TiltSecant
        Secants of each bearing and axis.
    """
    return [
        {
            "bearing": one.bearing,
            "axis": one.axis,
            "secant [MN m/rad]": one.stiffness / 1e6,
            "scatter [%]": 100.0 * one.scatter,
            "unit alone, soft [MN m/rad]": one.bounds[0] / 1e6,
            "unit alone, stiff [MN m/rad]": one.bounds[1] / 1e6,
        }
        for one in found
    ]
