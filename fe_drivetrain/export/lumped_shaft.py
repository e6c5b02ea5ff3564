"""The shaft as rigid bodies at its points, with the beam between them as springs.

For programs that know rigid bodies and springs only: each point has the piece of shaft that is
nearer to it than to its neighbours, with that piece's mass, centre and inertia, so the whole has
the shaft's own; how it deforms is the beam's.
"""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.export.from_scene import shaft_superelement
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.shafts.beam.of_scene import beam_of_scene
from fe_drivetrain.shafts.beam.sections import BeamSection
from fe_drivetrain.shafts.fidelity.shafts import ringed_shaft


def lumped_superelement(scene: Scene) -> Superelement:
    """The free shaft at level 1, with the mass of rigid bodies at its points.

    Returns
    -------
    Its stiffness is a chain of springs along the shaft, and its mass has no entries between points.
    """
    element = shaft_superelement(scene, 1)
    x = element.positions[:, 0]
    stations = np.sort(x)
    nothing = {unit.bearing.name: np.zeros(6) for unit in scene.bearing_units}
    ringed = scene.model_copy(update={"shaft": ringed_shaft(scene)[0]})
    beam = beam_of_scene(ringed, nothing)
    cuts = [stations[0], *(0.5 * (stations[1:] + stations[:-1])), stations[-1]]
    mass = np.zeros_like(element.stiffness)
    for place, (low, high) in zip(stations, pairwise(cuts), strict=True):
        rows = 6 * int(np.flatnonzero(x == place)[0]) + np.arange(6)
        for (start, end), section in zip(pairwise(beam.ends), beam.sections, strict=True):
            if min(end, high) > max(start, low):
                assert isinstance(section, BeamSection)
                inside = (max(start, low) - start, min(end, high) - start)
                mass[np.ix_(rows, rows)] += beam.material.density * _moments(
                    section, inside, start - place
                )
    title = "1 Timoshenko beam, mass of rigid bodies at the points"
    return replace(element, mass=mass, origin=replace(element.origin, level=title))


def rigid_mass(mass: float, centre: Floats, inertia: Floats) -> Floats:
    """(6, 6) mass matrix of a rigid body about a point.

    Parameters
    ----------
    mass : float
        [kg].
    centre : Floats
        (3,) of its mass from the point [m].
    inertia : Floats
        (3, 3) about the point [kg m^2].
    """
    x, y, z = mass * np.asarray(centre)
    arm = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.block([[mass * np.eye(3), -arm], [arm, np.asarray(inertia)]])


def _moments(section: BeamSection, inside: tuple[float, float], offset: float) -> Floats:
    """(6, 6) mass matrix of a part of a section, about a point on the axis, over its density.

    Gauss's three points are exact: diameters are linear, and none of it is beyond the fifth power.
    """
    points, weights = np.polynomial.legendre.leggauss(3)
    low, high = inside
    s = low + (high - low) * (points + 1.0) / 2.0
    weights = weights * (high - low) / 2.0
    (outer0, outer1), (inner0, inner1) = section.end_diameters
    share = s / section.length
    outer, inner = outer0 + (outer1 - outer0) * share, inner0 + (inner1 - inner0) * share
    area = np.pi / 4.0 * (outer**2 - inner**2)
    second = np.pi / 64.0 * (outer**4 - inner**4)
    arm = s + offset
    volume, first = weights @ area, weights @ (area * arm)
    across = weights @ (second + area * arm**2)
    return rigid_mass(
        float(volume),
        np.array([first / volume, 0.0, 0.0]),
        np.diag([2.0 * weights @ second, across, across]),
    )
