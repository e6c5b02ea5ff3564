"""A deformed model for the browser: its surface with displacements and von Mises stresses.

The surface is written in 16 bits a number, tenths of a millimetre of a shaft of some metres:
for looking at, not for computing with.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.mesh.mesh import Mesh, boundary
from fe_drivetrain.operator.stress import nodal_stresses, von_mises
from fe_drivetrain.report.pictures.deformation import exaggeration, picture_of_deformation
from fe_drivetrain.report.results import Image, Solid

if TYPE_CHECKING:
    from fe_drivetrain.response.model import Model
    from fe_drivetrain.response.unit_loads import Response

MOST_TRIANGLES = 100_000
"""Of a surface: with its values it then takes less than 3 MB."""

_FINE = ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5))  # flat pieces of a six-node triangle
_COARSE = ((0, 1, 2),)
_STEPS = 32767


def deformed_shape(
    model: Model, response: Response, load_factors: Floats, folder: Path, what: str
) -> Solid | Image:
    """Draw a deformed model, and write it for the browser.

    Parameters
    ----------
    model, response : Model, Response
        A model and its response to the unit loads.
    load_factors : Floats
        (10,) multiples of the loads of `fe_drivetrain.response.LOADS`.
    folder : Path
        Takes deformed.png and deformed.3d.json.
    what : str
        The loads in words.

    Returns
    -------
    item : Solid or Image
        For the page; the picture alone where the surface is too fine for a browser.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    """
    picture, view = "deformed.png", "deformed.3d.json"
    factor = picture_of_deformation(model, response, load_factors, folder / picture)
    mesh, scene = model.mesh, model.scene
    lame = {part: scene.material_of(part).lame for part in mesh.part_names}
    u = response.displacements @ np.asarray(load_factors, dtype=np.float64)
    caption = f"Deformed shape, displacements times {factor:,.0f}, under {what}"
    if not write_solid_view(mesh, u, lame, folder / view):
        return Image(caption=caption, file=picture)
    return Solid(caption=caption, file=view, still=picture)


def write_solid_view(
    mesh: Mesh, u: Floats, lame: Mapping[str, tuple[float, float]], path: Path
) -> bool:
    """Write what a page needs to show a deformed mesh in three dimensions.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    u : Floats
        (n, 3) displacements of its nodes [m].
    lame : mapping
        Lame's constants (lambda, mu) [Pa] of the material of each part, by the part's name.
    path : Path
        JSON to write.

    Returns
    -------
    bool
        False, and nothing written, where the surface has more than `MOST_TRIANGLES`.
    """
    facets = {part: boundary(mesh, part) for part in mesh.part_names}
    count = sum(map(len, facets.values()))
    if count > MOST_TRIANGLES:
        return False
    pieces = _FINE if len(_FINE) * count <= MOST_TRIANGLES else _COARSE
    parts, shown, triangles, stress = [], [], [], []
    first = vertices = 0
    for part, six in facets.items():
        corners = six[:, np.array(pieces)].reshape(-1, 3)
        nodes, numbers = np.unique(corners, return_inverse=True)
        shown.append(nodes)
        triangles.append(numbers.reshape(-1, 3) + vertices)
        own = nodal_stresses(mesh.points, mesh.cells[mesh.part_cells(part)], u.ravel(), lame[part])
        stress.append(von_mises(own[nodes]))
        parts.append({"name": part, "first": first, "count": len(corners)})
        first, vertices = first + len(corners), vertices + len(nodes)
    path.write_text(
        json.dumps(
            _content(mesh.points, u, np.concatenate(shown), np.concatenate(stress))
            | {"parts": parts, "triangles": _packed(np.concatenate(triangles), "<u4")}
        ),
        encoding="utf-8",
    )
    return True


def _content(points: Floats, u: Floats, nodes: Ints, stress: Floats) -> dict[str, Any]:
    """Positions, displacements and stresses of vertices, each with the value of a whole unit."""
    low, high = points[nodes].min(axis=0), points[nodes].max(axis=0)
    middle, reach = 0.5 * (low + high), 0.5 * float((high - low).max())
    size = np.linalg.norm(u[nodes], axis=1)
    largest = float(size.max())
    greatest = float(stress.max())

    def units(values: Floats, whole: float) -> str:
        return _packed(np.rint(_STEPS * values / (whole or 1.0)), "<i2")

    return {
        "middle": middle.tolist(),
        "reach": reach,
        "largest": largest,
        "greatest": greatest,
        "factor": exaggeration(largest, 2.0 * reach),
        "positions": units(points[nodes] - middle, reach),
        "displacements": units(u[nodes], largest),
        "stresses": units(stress, greatest),
    }


def _packed(values: Floats | Ints, kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values.astype(kind)).tobytes()).decode()
