"""A deformed model for the browser: its surface with displacements and von Mises stresses.

The surface is written in 16 bits a number, tenths of a millimetre of a shaft of some metres:
for looking at, not for computing with.
"""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.mesh.facets import outside
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.operator.stress import nodal_stresses, von_mises
from fe_drivetrain.report.pictures.deformation import exaggeration, picture_of_deformation
from fe_drivetrain.report.pictures.drawing_process import NoPictureError, Picture
from fe_drivetrain.report.pictures.model import picture_of_model
from fe_drivetrain.report.results import Image, Solid, Text

if TYPE_CHECKING:
    from fe_drivetrain.shafts.response.model import Model
    from fe_drivetrain.shafts.response.unit_loads import Response

MAX_TRIANGLES = 100_000
"""Of a surface: with its values it then takes less than 3 MB."""
MAX_BYTES = 3_000_000
"""Of a file: as many loads are in it as fit, one at least."""

SHOWN_LOADS = {
    "Fx": "1 MN along x",
    "Fz": "1 MN along z",
    "Mx": "1 MN m about x",
    "My": "1 MN m about y",
}
"""At the hub, for comparison with the load that a page is about."""
_MEGA = 1e6
_DEFORMED = "deformed.png"

# flat pieces of a facet with so many nodes, with its mid-side nodes and without
_FINE = {
    3: ((0, 1, 2),),
    4: ((0, 1, 2), (0, 2, 3)),
    6: ((0, 3, 5), (3, 1, 4), (5, 4, 2), (3, 4, 5)),
    8: ((0, 4, 7), (4, 1, 5), (5, 2, 6), (6, 3, 7), (4, 5, 6), (4, 6, 7)),
    9: ((0, 4, 8), (4, 1, 8), (1, 5, 8), (5, 2, 8), (2, 6, 8), (6, 3, 8), (3, 7, 8), (7, 0, 8)),
}
_COARSE = {count: _FINE[3] if count in (3, 6) else _FINE[4] for count in _FINE}
_STEPS = 32767


@dataclass(frozen=True)
class Parts:
    """Nodes that parts share or not, and the elements of each part: of one kind in one part.

    Attributes
    ----------
    points : Floats
        (n, 3) positions of the nodes [m].
    cells : Mapping[str, Ints]
        By the part's name (ne, k) node numbers in VTK's order: tetrahedra of 4 or 10 nodes,
        hexahedra of 8, 20 or 27.
    """

    points: Floats
    cells: Mapping[str, Ints]

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class PicturesBegun:
    """Pictures of a model in the making, beside other work.

    Attributes
    ----------
    title : str
        Title of the scene.
    model, deformed : Picture
        The two.
    factor : float
        Times which displacements are drawn.
    """

    title: str
    model: Picture
    deformed: Picture
    factor: float

    def items(self, shape: Solid | Image) -> Sequence[Image | Solid | Text]:
        """Both for a page, when they are there; the second as `deformed_view` has it."""
        self.model.wait()
        self.deformed.wait()
        caption = f"{self.title}: parts, loads and supports"
        return [Image(caption=caption, file="model.png"), shape]


def begin_pictures(
    model: Model, response: Response, load_factors: Floats, folder: Path
) -> PicturesBegun:
    """Begin to draw a model and its deformed shape.

    Parameters
    ----------
    model, response : Model, Response
        A model and its response to the unit loads.
    load_factors : Floats
        (10,) multiples of the loads of `fe_drivetrain.shafts.response.LOADS`.
    folder : Path
        Takes model.png and deformed.png.

    Raises
    ------
    NoPictureError
        This machine cannot draw.
    """
    of_model = picture_of_model(model, folder / "model.png")
    factor, deformed = picture_of_deformation(model, response, load_factors, folder / _DEFORMED)
    return PicturesBegun(model.scene.title, of_model, deformed, factor)


def deformed_view(
    model: Model,
    response: Response,
    load_factors: Floats,
    folder: Path,
    what: str,
    factor: float,
) -> Solid | Image:
    """Write a deformed model for the browser, beside its picture.

    Parameters
    ----------
    model, response, load_factors : Model, Response, Floats
        See `begin_pictures`.
    folder : Path
        Takes deformed.3d.json.
    what : str
        The loads in words.
    factor : float
        Times which displacements are drawn in the picture.

    Returns
    -------
    item : Solid or Image
        For the page; the picture alone where the surface is too fine for a browser.
    """
    mesh, scene = model.mesh, model.scene
    lame = {part: scene.material_of(part).lame for part in mesh.part_names}
    fields = {what: response.displacements @ np.asarray(load_factors, dtype=np.float64)}
    for component, name in SHOWN_LOADS.items():
        column = FORCES.index(component)
        fields[f"{name} at the hub"] = _MEGA * response.displacements[..., column]
    caption = f"Deformed shape, displacements times {factor:,.0f}, under {what}"
    return solid_or_picture(caption, mesh, fields, lame, folder, _DEFORMED)


def model_pictures(
    model: Model, response: Response, load_factors: Floats, folder: Path, what: str
) -> Sequence[Image | Solid | Text]:
    """Draw a model and its deformed shape; where nothing can be drawn, say why.

    Parameters
    ----------
    model, response : Model, Response
        A model and its response to the unit loads.
    load_factors : Floats
        (10,) multiples of the unit loads.
    folder : Path
        Takes model.png, deformed.png and deformed.3d.json.
    what : str
        The loads in words.

    Returns
    -------
    items : sequence of Image, Solid or Text
        For the page.
    """
    try:
        begun = begin_pictures(model, response, load_factors, folder)
    except NoPictureError as reason:
        return [no_picture(reason)]
    shape = deformed_view(model, response, load_factors, folder, what, begun.factor)
    return begun.items(shape)


def no_picture(reason: NoPictureError) -> Text:
    """What a page has in the place of a picture."""
    return Text(text=f"No picture: {reason}")


def solid_or_picture(
    caption: str,
    mesh: Mesh | Parts,
    fields: Mapping[str, Floats],
    lame: Mapping[str, tuple[float, float]],
    folder: Path,
    picture: str,
) -> Solid | Image:
    """Write a deformed mesh for the browser, beside a picture of it.

    Parameters
    ----------
    caption : str
        Of either.
    mesh, fields, lame : Mesh or Parts, Mapping, Mapping
        See `write_solid_view`.
    folder : Path
        Has the picture, and takes a JSON of the same name.
    picture : str
        Its file.

    Returns
    -------
    item : Solid or Image
        For the page; the picture alone where the surface is too fine for a browser.
    """
    view = f"{Path(picture).stem}.3d.json"
    if not write_solid_view(mesh, fields, lame, folder / view):
        return Image(caption=caption, file=picture)
    return Solid(caption=caption, file=view, still=picture)


def write_solid_view(
    mesh: Mesh | Parts,
    fields: Mapping[str, Floats],
    lame: Mapping[str, tuple[float, float]],
    path: Path,
) -> bool:
    """Write what a page needs to show a deformed mesh in three dimensions.

    Parameters
    ----------
    mesh : Mesh or Parts
        The mesh; parts of other elements than curved tetrahedra as `Parts`.
    fields : Mapping[str, Floats]
        (n, 3) displacements of its nodes [m] by the load in words, the first of which is shown
        first. Those that come last are left out where the file would be larger than `MAX_BYTES`.
    lame : mapping
        Lame's constants (lambda, mu) [Pa] of the material of each part, by the part's name.
    path : Path
        JSON to write.

    Returns
    -------
    bool
        False, and nothing written, where the surface has more than `MAX_TRIANGLES`.
    """
    bodies = mesh if isinstance(mesh, Parts) else _parts_of(mesh)
    surface = _surface(bodies)
    if surface is None:
        return False
    nodes = np.concatenate(surface.nodes)
    low, high = bodies.points[nodes].min(axis=0), bodies.points[nodes].max(axis=0)
    middle, reach = 0.5 * (low + high), 0.5 * float((high - low).max())
    # in letters of 6 bits: positions and triangles; then displacements and stresses of each load
    count, vertices = len(surface.triangles), len(nodes)
    shape, field = (8 / 6 * size for size in (6 * vertices + 12 * count, 8 * vertices))
    most = max(1, int((MAX_BYTES - shape) / max(field, 1.0)))
    content = {
        "middle": middle.tolist(),
        "reach": reach,
        "positions": _units(bodies.points[nodes] - middle, reach),
        "parts": surface.parts,
        "triangles": _packed(surface.triangles, "<u4"),
        "loads": [
            {"name": name, **_field(bodies, u, surface.nodes, lame, reach)}
            for name, u in list(fields.items())[:most]
        ],
    }
    path.write_text(json.dumps(content), encoding="utf-8")
    return True


class _Surface(NamedTuple):
    """The outside of parts: name, first triangle and how many; nodes; triangles (n, 3)."""

    parts: list[dict[str, Any]]
    nodes: list[Ints]
    triangles: Ints


def _surface(bodies: Parts) -> _Surface | None:
    """The outside in flat triangles, as fine as a browser takes; None where it is too fine."""
    facets = {part: outside(cells) for part, cells in bodies.cells.items()}
    fine, least = (
        sum(len(of) * len(pieces[of.shape[1]]) for of in facets.values())
        for pieces in (_FINE, _COARSE)
    )
    if least > MAX_TRIANGLES:
        return None
    pieces = _FINE if fine <= MAX_TRIANGLES else _COARSE
    parts, shown, triangles = [], [], []
    first = vertices = 0
    for part, of in facets.items():
        corners = of[:, np.array(pieces[of.shape[1]])].reshape(-1, 3)
        nodes, numbers = np.unique(corners, return_inverse=True)
        shown.append(nodes)
        triangles.append(numbers.reshape(-1, 3) + vertices)
        parts.append({"name": part, "first": first, "count": len(corners)})
        first, vertices = first + len(corners), vertices + len(nodes)
    return _Surface(parts, shown, np.concatenate(triangles))


def _parts_of(mesh: Mesh) -> Parts:
    return Parts(mesh.points, {p: mesh.cells[mesh.part_cells(p)] for p in mesh.part_names})


def _field(
    bodies: Parts,
    u: Floats,
    shown: Sequence[Ints],
    lame: Mapping[str, tuple[float, float]],
    reach: float,
) -> dict[str, Any]:
    """Displacements and stresses of the vertices, each with the value of a whole unit."""
    stresses = []
    for (part, cells), nodes in zip(bodies.cells.items(), shown, strict=True):
        own = nodal_stresses(bodies.points, cells, u.ravel(), lame[part])
        stresses.append(von_mises(own[nodes]))
    moved, stress = u[np.concatenate(shown)], np.concatenate(stresses)
    largest, greatest = float(np.linalg.norm(moved, axis=1).max()), float(stress.max())
    return {
        "largest": largest,
        "greatest": greatest,
        "factor": exaggeration(largest, 2.0 * reach),
        "displacements": _units(moved, largest),
        "stresses": _units(stress, greatest),
    }


def _units(values: Floats, whole: float) -> str:
    return _packed(np.rint(_STEPS * values / (whole or 1.0)), "<i2")


def _packed(values: Floats | Ints, kind: str) -> str:
    return base64.b64encode(np.ascontiguousarray(values.astype(kind)).tobytes()).decode()
