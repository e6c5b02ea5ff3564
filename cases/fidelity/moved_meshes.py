"""Dimensions of a bonded main bearing changed by moving the nodes of one mesh.

The errors of two meshes that are made separately differ by more than a small change of a dimension
does; a mesh whose nodes move along with the surfaces keeps its errors, so differences of solutions
are smooth. Each move is linear between surfaces, and carries each of them exactly onto that of the
changed scene.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.shafts.uncertainty.sampling import with_values

OUTER, BORE = "shaft.sections.0.outer_diameter", "shaft.sections.0.inner_diameter"
FRONT = "shaft.front"
PEDESTAL = "bearing_units.main_bearing.housing.pedestal_width"
WALL = "bearing_units.main_bearing.housing.wall"


def moved(scene: Scene, mesh: Mesh, key: str, value: float) -> tuple[Scene, Mesh]:
    """The scene with another value, and its mesh moved accordingly.

    Parameters
    ----------
    scene : Scene
        One bonded bearing at x = 0 on a bored shaft of one section; flanks of the pedestal that
        go straight from shell to foot.
    mesh : Mesh
        Of that scene.
    key : str
        `OUTER`, `BORE`, `FRONT`, `PEDESTAL` or `WALL`.
    value : float
        [m].

    Returns
    -------
    changed : Scene
        With that value.
    moved : Mesh
        The same elements, on the surfaces of the changed scene.
    """
    changed = with_values(scene, {key: value})
    points = mesh.points
    if key in (OUTER, BORE):
        points = _stretched(points, _radii(scene), _radii(changed))
    elif key == FRONT:
        on_shaft = np.unique(mesh.cells[mesh.part_cells("shaft")])
        points = points.copy()
        points[on_shaft, 0] = np.interp(points[on_shaft, 0], _stations(scene), _stations(changed))
    else:
        points = _reshaped(scene, changed, points)
    return changed, replace(mesh, points=points)


def _radii(scene: Scene) -> list[float]:
    (section,) = scene.shaft.sections
    raceway = scene.bearing_units[0].bearing.raceway_diameter
    return [0.0, section.inner_diameter / 2, section.outer_diameter / 2, raceway / 2, 10 * raceway]


def _stations(scene: Scene) -> list[float]:
    return [scene.shaft.front, *scene.bearing_units[0].bearing.span, scene.shaft.rear]


def _stretched(points: Floats, before: list[float], after: list[float]) -> Floats:
    """Points moved along their radius about the x axis."""
    radius = np.hypot(points[:, 1], points[:, 2])
    factor = np.ones(len(points))
    off = radius > 0
    factor[off] = np.interp(radius[off], before, after) / radius[off]
    return np.column_stack([points[:, 0], points[:, 1:] * factor[:, None]])


def _reshaped(scene: Scene, changed: Scene, points: Floats) -> Floats:
    """Points of the housing with another wall or pedestal: the bore and the foot's outline stay."""
    bearing, housing = scene.bearing_units[0].bearing, scene.bearing_units[0].block
    other = changed.bearing_units[0].block
    bore = bearing.raceway_diameter / 2
    outer, new_outer = housing.outer_radius(bearing), other.outer_radius(bearing)
    half, new_half = housing.pedestal_width / 2, other.pedestal_width / 2
    far = housing.foot_length / 2
    drop = housing.centre_height - housing.foot_thickness
    found = points.copy()
    _, y, z = points.T
    outside = np.hypot(y, z) > bore
    above = outside & (z >= 0)
    upper = _stretched(points, [0.0, bore, outer], [0.0, bore, new_outer])
    found[above] = upper[above]
    body = outside & (z < 0) & (z >= -drop)
    depth = np.clip(-z / drop, 0.0, 1.0)
    flank = outer + (half - outer) * depth
    shift = (new_outer - outer) * (1.0 - depth) + (new_half - half) * depth
    inner = np.sqrt(np.maximum(bore**2 - z**2, 0.0))
    share = (np.abs(y) - inner) / (flank - inner)
    # beside the body there is only the top of the foot
    side = np.interp(np.abs(y), [0.0, half, far], [0.0, new_half, far])
    on_foot = z <= -drop * (1 - 1e-9)
    found[body, 1] = (y + np.sign(y) * shift * share)[body]
    found[on_foot, 1] = (np.sign(y) * side)[on_foot]
    return found
