"""Whether parts from files keep clear of the shaft and the bearings that they go round."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.elasticity.mesh.mesh import Mesh, boundary
from fe_drivetrain.geometry import Bearing, ForeignFile, Shaft

# Distance over the radius that nodes of seats may lie within their bearing's raceway; and facets
# of a mesh whose edges are chords, six round a turn.
_NODES, _CHORDS = 2e-3, 0.15
_DEGREE = 8  # of the places on a facet: 16 of them


def check_clear(shaft: Shaft | None, units: Sequence[BearingUnit], mesh: Mesh) -> None:
    """Refuse parts from files that reach into the shaft or into a bearing.

    Parameters
    ----------
    shaft : Shaft or None
        The shaft, where there is one.
    units : Sequence[BearingUnit]
        The bearing units.
    mesh : Mesh
        Mesh with all parts from files in their places.

    Raises
    ------
    InputError
    """
    for unit in units:
        for part, solid in unit.housing_parts.items():
            if not isinstance(solid, ForeignFile):
                continue
            facets = boundary(mesh, part)
            corners = mesh.points[np.unique(facets[:, :3])]
            faces = facet_points(mesh.points, facets, _DEGREE).positions.reshape(-1, 3)
            places = np.vstack([corners, faces])
            if shaft is not None:
                radii = (1 - _NODES) * _shaft_radii(shaft, places[:, 0])
                _refuse_inside(part, solid, "shaft", places, radii)
            least = 1 - np.repeat([_NODES, _CHORDS], [len(corners), len(faces)])
            for other in units:
                name = f"bearing {other.bearing.name!r}"
                radii = least * _bearing_radii(other.bearing, places[:, 0])
                _refuse_inside(part, solid, name, places, radii)


def _refuse_inside(part: str, solid: ForeignFile, what: str, places: Floats, radii: Floats) -> None:
    """Refuse places that are nearer to the axis than the surface of a body of revolution."""
    from_axis = np.hypot(places[:, 1], places[:, 2])
    depth = radii - from_axis
    worst = int(depth.argmax())
    if depth[worst] > 0:
        raise InputError(
            f"{part} from {Path(solid.file).name} overlaps the {what}: at x = "
            f"{places[worst, 0]:.4g} m it comes to {from_axis[worst]:.4g} m from the axis, but "
            f"must stay {radii[worst]:.3g} m away there: correct the part's unit, 'rotate' or "
            "'translate', or its shape"
        )


def _shaft_radii(shaft: Shaft, x: Floats) -> Floats:
    """Outer radius of the shaft at each x, fillets left out; 0 beside it."""
    radii = np.zeros_like(x)
    for piece, (low, high) in zip(shaft.pieces, pairwise(shaft.stations), strict=True):
        own = np.interp(x, (low, high), (piece.outer_diameter / 2, piece.end_diameter / 2))
        radii = np.where((x > low) & (x < high), own, radii)
    return radii


def _bearing_radii(bearing: Bearing, x: Floats) -> Floats:
    """Outer radius of a bearing at each x; 0 beside it."""
    away, radius = np.abs(x - bearing.x), bearing.raceway_diameter / 2
    outer = np.full_like(x, radius)
    if bearing.kind == "spherical":
        outer = np.sqrt(np.maximum(radius**2 - away**2, 0.0))
    return np.where(away < bearing.width / 2, outer, 0.0)
