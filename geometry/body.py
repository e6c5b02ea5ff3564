"""Base of bodies of one volume: element sizes, named faces, and how faces are found."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from itertools import product

import gmsh
from pydantic import Field

from fe_drivetrain.common.errors import InputError

from .element_sizes import GROWTH, MAX_ELEMENTS
from .faces import CAD_TOLERANCE
from .part import Part, dimension
from .session import integrate_sizes

Vector = tuple[float, float, float]

_PER_VOLUME = 6 * math.sqrt(2)  # regular tetrahedra of edge 1 in a volume of 1

_STEP = 1e-3  # of an edge's length: so far from it the material is looked for


class BodySizes(Part):
    """Edge lengths of the elements of a body."""

    size: float = dimension(0.12, of="maximum element size", gt=0)
    edge: float = dimension(
        0.06, of="element size along inner edges, where stress is singular", gt=0
    )
    elements_per_turn: int = Field(
        default=12, ge=6, le=360, description="minimum number of elements round any cylinder"
    )

    def scaled(self, factor: float) -> BodySizes:
        """All sizes times a factor: above 1 for a coarser mesh."""
        turn = max(6, round(self.elements_per_turn / factor))
        return BodySizes(size=self.size * factor, edge=self.edge * factor, elements_per_turn=turn)


def name_and_size(
    name: str, volume: int, faces: Mapping[str, Iterable[int]], sizes: BodySizes, copies: int
) -> None:
    """Make a volume and its faces physical groups of the open gmsh model, and set element sizes.

    Parameters
    ----------
    name : str
        Name of the body; a face's group is called NAME.FACE.
    volume : int
        Tag of the volume.
    faces : Mapping[str, Iterable[int]]
        Tags of the faces of each name.
    sizes : BodySizes
        Element sizes.
    copies : int
        Number of copies of the volume in the body.

    Raises
    ------
    InputError
        A face is not there, or the sizes make too many elements.
    """
    edges = inner_edges(volume)
    length = sum(gmsh.model.occ.getMass(1, edge) for edge in edges)
    elements = gmsh.model.occ.getMass(3, volume) * _PER_VOLUME / sizes.size**3
    # three quarters of a turn round each edge, elements growing away from it
    elements += _PER_VOLUME * length * 0.75 * math.pi / (GROWTH**2 * sizes.edge)
    elements *= copies
    if elements > MAX_ELEMENTS:
        raise InputError(
            f"body {name!r}: mesh sizes {sizes.size:g} m, and {sizes.edge:g} m along inner edges, "
            f"make about {elements:.1g} elements, but must make at most {MAX_ELEMENTS:.0e}: "
            "choose larger ones"
        )
    gmsh.model.addPhysicalGroup(3, [volume], name=name)
    for face, found in faces.items():
        tags = sorted(found)
        if not tags:
            raise InputError(f"body {name!r} has no face {face!r}: check that its dimensions fit")
        gmsh.model.addPhysicalGroup(2, tags, name=f"{name}.{face}")
    for option, value in (
        ("Mesh.MeshSizeMax", sizes.size),
        ("Mesh.MeshSizeFromPoints", 0),
        ("Mesh.MeshSizeFromCurvature", sizes.elements_per_turn),
    ):
        gmsh.option.setNumber(option, value)
    if edges:
        integrate_sizes()
        field = gmsh.model.mesh.field
        distance = field.add("Distance")
        field.setNumbers(distance, "CurvesList", edges)
        field.setNumber(distance, "Sampling", 200)
        growing = field.add("MathEval")
        field.setString(growing, "F", f"{sizes.edge:.9f} + {GROWTH} * F{distance}")
        field.setAsBackgroundMesh(growing)


def inner_edges(volume: int) -> list[int]:
    """Curves of a volume where it fills more than half of the space round them, as in a corner."""
    faces = [tag for _, tag in gmsh.model.getBoundary([(3, volume)], oriented=False)]
    beside: dict[int, list[int]] = {}
    for face in faces:
        for _, curve in gmsh.model.getBoundary([(2, face)], oriented=False):
            beside.setdefault(curve, []).append(face)
    found = []
    for curve, pair in sorted(beside.items()):
        if len(set(pair)) != 2:
            continue
        (low,), (high,) = gmsh.model.getParametrizationBounds(1, curve)
        middle = gmsh.model.getValue(1, curve, [(low + high) / 2])
        first, second = (_normal(face, middle) for face in pair)
        if abs(_product(first, second)) > 1.0 - CAD_TOLERANCE:
            continue  # flat
        # the two faces part what is near into four: of an inner corner, three are filled
        step = _STEP * gmsh.model.occ.getMass(1, curve)
        empty = 0
        for a, b in product((step, -step), repeat=2):
            near = [m + a * p + b * q for m, p, q in zip(middle, first, second, strict=True)]
            empty += not gmsh.model.isInside(3, volume, near)
            if empty > 1:  # asking takes longer than all else here
                break
        if empty == 1:
            found.append(curve)
    return found


def _normal(face: int, at: Iterable[float]) -> list[float]:
    """Unit normal of a face at a point, to either side."""
    parameters = gmsh.model.getParametrization(2, face, list(at))
    return [float(n) for n in gmsh.model.getNormal(face, parameters)]


def cylinder_faces(faces: Iterable[int], radius: float, y: float = 0.0, z: float = 0.0) -> set[int]:
    """Faces on the cylinder of a radius about the line along x through (y, z), m."""
    found = set()
    for tag in faces:
        if gmsh.model.getType(2, tag) != "Cylinder":
            continue
        (u0, v0), (u1, v1) = gmsh.model.getParametrizationBounds(2, tag)
        _, at_y, at_z = gmsh.model.getValue(2, tag, [(u0 + u1) / 2, (v0 + v1) / 2])
        if abs(math.hypot(at_y - y, at_z - z) - radius) < CAD_TOLERANCE:
            found.add(tag)
    return found


def plane_faces(faces: Iterable[int], normal: Vector, at: float = 0.0) -> set[int]:
    """Flat faces in the plane of the points whose product with a unit normal is ``at``, m."""
    found = set()
    for tag in faces:
        if gmsh.model.getType(2, tag) != "Plane":
            continue
        distance = _product(gmsh.model.occ.getCenterOfMass(2, tag), normal) - at
        along = _product(gmsh.model.getNormal(tag, [0.0, 0.0]), normal)
        if abs(abs(along) - 1.0) < CAD_TOLERANCE and abs(distance) < CAD_TOLERANCE:
            found.add(tag)
    return found


def half_plane_faces(faces: Iterable[int], angle: float) -> set[int]:
    """Flat faces in the half plane from the x axis on that stands at an angle to z, rad about x."""
    outward, normal = ((0.0, -math.sin(angle), math.cos(angle)),
                       (0.0, math.cos(angle), math.sin(angle)))  # fmt: skip
    return {
        tag
        for tag in plane_faces(faces, normal)
        if _product(gmsh.model.occ.getCenterOfMass(2, tag), outward) > 0
    }


def _product(first: Iterable[float], second: Iterable[float]) -> float:
    return sum(a * b for a, b in zip(first, second, strict=True))


def annulus(
    start: float, length: float, inner: float, outer: float, angle: float, turn: float
) -> int:
    """A sector of an annulus about the x axis, in the open gmsh model; its tag.

    Parameters
    ----------
    start, length : float
        Start and length along x [m].
    inner, outer : float
        Radii [m].
    angle, turn : float
        Angle where it begins and angle that it spans about x, from the z axis on [rad].
    """
    occ = gmsh.model.occ
    corners = [(start, inner), (start + length, inner), (start + length, outer), (start, outer)]
    points = [occ.addPoint(x, 0.0, r) for x, r in corners]
    lines = [occ.addLine(a, b) for a, b in zip(points, points[1:] + points[:1], strict=True)]
    face = occ.addPlaneSurface([occ.addCurveLoop(lines)])
    occ.rotate([(2, face)], 0, 0, 0, 1, 0, 0, angle)
    swept = occ.revolve([(2, face)], 0, 0, 0, 1, 0, 0, turn)
    (tag,) = (tag for dim, tag in swept if dim == 3)
    return int(tag)
