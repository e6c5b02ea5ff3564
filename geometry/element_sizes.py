"""Sizes of the elements: by part, finer on tightly curved and narrow faces, growing away."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping

import gmsh
from pydantic import Field

from fe_drivetrain.common.errors import InputError

from .faces import boundary, parameters, revolved_ranges
from .part import Part, dimension
from .session import integrate_sizes

GROWTH = 0.4
"""Growth of the element size with the distance from a tightly curved face, m per m."""


MAX_ELEMENTS = 1e6
"""More elements than this in one part, four million unknowns, are taken for a slip of the pen in
its mesh size or in a detail."""


_PER_VOLUME = 6 * math.sqrt(2)  # regular tetrahedra of edge 1 in a volume of 1


SIZE_PER_WALL = 3.0
"""Maximum mesh size, in thicknesses of the thinnest wall: elements flatter than this fold over."""


MIN_TURN, SOUND_TURN, MAX_TURN = 6, 8, 360
"""Elements round any cylinder or sphere: minimum, minimum that seldom folds over, and maximum."""


class MeshSizes(Part):
    """Edge lengths of the elements of each kind of part."""

    shaft: float = dimension(0.12, of="element size in the shaft", gt=0)
    bearing: float = dimension(0.05, of="element size in the bearings and on their seats", gt=0)
    housing: float = dimension(0.06, of="element size in the housings", gt=0)
    bearing_edge: float = dimension(
        0.03, of="element size along the edges of the bearings, where stress is singular", gt=0
    )
    elements_per_turn: int = Field(
        default=12,
        ge=MIN_TURN,
        le=MAX_TURN,
        description="minimum number of elements round any cylinder or sphere",
    )

    def scaled(self, factor: float, elements_per_turn: int | None = None) -> MeshSizes:
        """Sizes times a factor, above 1 for a coarser mesh.

        Curved faces set many of the sizes: the elements a turn are divided by the factor, so that
        all sizes are times it, down to the fewest that make sound elements.

        Parameters
        ----------
        factor : float
            Factor on all sizes.
        elements_per_turn : int or None
            Number of elements per turn in place of the sizes' own, where a mesh is wanted that is
            coarse and sound, not one of a series.
        """
        turn = self.elements_per_turn
        turn = max(min(turn, SOUND_TURN), round(turn / factor))
        return MeshSizes(
            shaft=self.shaft * factor,
            bearing=self.bearing * factor,
            housing=self.housing * factor,
            bearing_edge=self.bearing_edge * factor,
            elements_per_turn=elements_per_turn or turn,
        )

    def finer(self, kinds: Iterable[str], factor: float) -> MeshSizes:
        """Sizes of some kinds of part divided by a factor.

        For the shaft, the elements a turn rise as well: on fillets and bores they set the size.

        Parameters
        ----------
        kinds : Iterable[str]
            Kinds of parts: any of 'shaft', 'bearing', 'housing'.
        factor : float
            Factor, above 1 for a finer mesh.
        """
        update: dict[str, float] = {kind: getattr(self, kind) / factor for kind in kinds}
        if "shaft" in update:
            update["elements_per_turn"] = math.ceil(self.elements_per_turn * factor)
        return self.model_copy(update=update)


def size_name(part: str) -> str:
    """Name of the mesh size that applies to a part."""
    if part == "shaft":
        return part
    return "housing" if "." in part else "bearing"


def apply_sizes(sizes: MeshSizes, parts: Mapping[str, int], faces: Mapping[str, set[int]]) -> None:
    """Set the element sizes: by part, finer on tightly curved faces and growing away from them."""
    for option, value in (
        ("Mesh.MeshSizeFromPoints", 0),
        ("Mesh.MeshSizeFromCurvature", 0),
        # inside the volumes only: on a face between two fillets, small edges would fill it whole
        ("Mesh.MeshSizeExtendFromBoundary", -3),
    ):
        gmsh.option.setNumber(option, value)
    integrate_sizes()
    field = gmsh.model.mesh.field
    fields = []
    for name, tag in parts.items():
        size = getattr(sizes, size_name(name))
        near_faces = elements_within(name, gmsh.model.occ.getMass(3, tag), size)
        fields.append(field.add("Constant"))
        field.setNumber(fields[-1], "VIn", size)
        field.setNumber(fields[-1], "VOut", 1e22)
        field.setNumbers(fields[-1], "VolumesList", [tag])
        for face in sorted(faces[name]):
            limit = _size_limit(face, sizes.elements_per_turn)
            if limit < size:
                near_faces += _elements_beside(face, limit)
                box = gmsh.model.getBoundingBox(2, face)
                refuse_too_many(name, (box[0], box[3]), (box[1], box[4]), limit, near_faces)
                fields.append(field.add("MathEval"))
                field.setString(fields[-1], "F", f"{limit:.9f} + {GROWTH} * {_distance(face)}")
        if size_name(name) == "bearing":
            fields.append(_finer_along_edges(tag, sizes.bearing_edge))
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", fields)
    field.setAsBackgroundMesh(least)


def elements_within(name: str, volume: float, size: float) -> float:
    """Approximate number of elements of a size that fill a part.

    Parameters
    ----------
    name : str
        Name of the part.
    volume, size : float
        Volume of the part, m^3, and size of its elements, m.

    Raises
    ------
    InputError
        They are more than `MAX_ELEMENTS`.
    """
    elements = volume * _PER_VOLUME / size**3
    if elements > MAX_ELEMENTS:
        raise InputError(
            f"part {name!r}: mesh size {size_name(name)!r} is {size:g} m, which makes about "
            f"{elements:.1g} elements, but must make at most {MAX_ELEMENTS:.0e}: choose "
            f"{size * (elements / MAX_ELEMENTS) ** (1 / 3):.2g} m or more"
        )
    return elements


def _elements_beside(face: int, size: float) -> float:
    """Approximate number of elements that a face of the open gmsh model makes."""
    area, meridian = gmsh.model.occ.getMass(2, face), revolved_ranges(face)
    box = gmsh.model.getBoundingBox(2, face)
    length = math.dist(box[:3], box[3:])
    if meridian is not None:
        x0, x1, r0, r1 = meridian
        length = max(2 * math.pi * r1, math.hypot(x1 - x0, r1 - r0))
    return elements_beside(area, length, size)


def elements_beside(area: float, length: float, size: float) -> float:
    """Approximate number of elements at a face of small ones, those that grow away from it
    included.

    The integral of 6 sqrt(2) / h^3 with h = h0 + g d at the distance d: over one side of a wide
    face A / (2 g h0^2), over half the space round a narrow one of length L pi L / (2 g^2 h0).

    Parameters
    ----------
    area, length, size : float
        Area and length of the face, m^2 and m, and size of its elements, m.
    """
    wide, narrow = area / (2 * GROWTH * size**2), math.pi * length / (2 * GROWTH**2 * size)
    return float(_PER_VOLUME * (wide + narrow))


def refuse_too_many(
    name: str,
    x: tuple[float, float],
    y: tuple[float, float],
    size: float,
    elements: float,
) -> None:
    """Refuse a face whose small elements are too many.

    Parameters
    ----------
    name : str
        Name of the part.
    x, y : tuple[float, float]
        Ranges of x and y that the face spans, m.
    size, elements : float
        Size of its elements, m, and how many elements the part has with them.

    Raises
    ------
    InputError
        They are more than `MAX_ELEMENTS`.
    """
    if elements > MAX_ELEMENTS:
        raise InputError(
            f"part {name!r}: a bore, fillet or narrow face at x = {x[0]:.6g} to {x[1]:.6g} m, "
            f"y = {y[0]:.6g} to {y[1]:.6g} m needs elements of {size:.2g} m, which make about "
            f"{elements:.1g} elements, but must make at most {MAX_ELEMENTS:.0e}: leave that "
            "detail out, enlarge it, or lower elements_per_turn"
        )


def _finer_along_edges(tag: int, size: float) -> int:
    """A field of small elements along the edges of a bearing, growing away from them.

    Where the side of a bearing meets shaft and housing, stress is singular: that is what holds
    up the convergence of the stiffness.
    """
    field = gmsh.model.mesh.field
    circles = [
        curve
        for curve in boundary([(2, face) for face in boundary([(3, tag)])])
        if gmsh.model.getType(1, curve) != "Line"
    ]
    refuse_fine_edges(math.fsum(gmsh.model.occ.getMass(1, curve) for curve in circles), size)
    distance = field.add("Distance")
    field.setNumbers(distance, "CurvesList", circles)
    field.setNumber(distance, "Sampling", 200)
    growing = field.add("MathEval")
    field.setString(growing, "F", f"{size:.9f} + {GROWTH} * F{distance}")
    return int(growing)


def refuse_fine_edges(length: float, size: float) -> None:
    """Refuse elements along the edges of a bearing that are too many.

    Parameters
    ----------
    length, size : float
        Length of all edges, and size of the elements along them, m.

    Raises
    ------
    InputError
        They are more than `MAX_ELEMENTS`.
    """
    # an eighth of a turn round each edge, elements growing away from it
    elements = _PER_VOLUME * length * math.pi / 8 / (GROWTH**2 * size)
    if elements > MAX_ELEMENTS:
        raise InputError(
            f"mesh size 'bearing_edge' is {size:g} m, which makes about {elements:.1g} elements, "
            f"but must make at most {MAX_ELEMENTS:.0e}: choose "
            f"{size * elements / MAX_ELEMENTS:.2g} m or more"
        )


def _size_limit(face: int, elements_per_turn: int) -> float:
    """Maximum element size that a face allows, whatever its part is given, m.

    A curved face gets its number of elements a turn; a fillet (torus) is allowed elements half as
    long again, since its arc is a quarter of a turn or less, and small elements all round the
    shaft are expensive. A narrow ring (a low step, the rim beside a bearing) gets chords whose
    sagitta, size^2 / (8 radius), is at most half its width: the edges on its two sides would cross.
    """
    kind, limit = gmsh.model.getType(2, face), math.inf
    if kind != "Plane":
        largest, smallest, _, _ = gmsh.model.getPrincipalCurvatures(face, parameters(face)[0])
        curvature = max(abs(float(largest[0])), abs(float(smallest[0])))
        limit = curved_limit(curvature, kind == "Torus", elements_per_turn)
    meridian = revolved_ranges(face)
    if meridian is not None:
        x0, x1, r0, r1 = meridian
        limit = min(limit, narrow_limit(math.hypot(x1 - x0, r1 - r0), r1))
    return limit


def curved_limit(curvature: float, fillet: bool, elements_per_turn: int) -> float:
    """Maximum element size that a curved face allows; see `_size_limit`.

    Parameters
    ----------
    curvature : float
        Maximum curvature of the face, 1/m.
    fillet : bool
        Whether it is a fillet.
    elements_per_turn : int
        Elements per turn of a scene.
    """
    if curvature == 0:
        return math.inf
    return (1.5 if fillet else 1.0) * 2 * math.pi / curvature / elements_per_turn


def narrow_limit(width: float, radius: float) -> float:
    """Maximum element size that a ring of a width and its larger radius allows, m."""
    return 2 * math.sqrt(radius * width)


def _distance(face: int) -> str:
    """Distance from a face's bounding box, as a formula for gmsh.

    The box is one of (x, radius) where the face goes round the x axis, of (x, y, z) elsewhere.
    """
    meridian = revolved_ranges(face)
    if meridian is not None:
        low, high = meridian[::2], meridian[1::2]
        ranges = list(zip(("x", "sqrt(y*y + z*z)"), low, high, strict=True))
    else:
        box = gmsh.model.getBoundingBox(2, face)
        ranges = list(zip(("x", "y", "z"), box[:3], box[3:], strict=True))
    # |t - a| + |t - b| - (b - a) is twice the distance of t from the interval [a, b]
    terms = [
        f"((abs({_less(t, a)}) + abs({_less(t, b)}) - {b - a:.9f}) / 2)^2" for t, a, b in ranges
    ]
    return f"sqrt({' + '.join(terms)})"


def _less(term: str, number: float) -> str:
    """`term - number` in gmsh's formulas, which know neither exponents nor a sign after another."""
    return f"{term} {'-' if number >= 0 else '+'} {abs(number):.9f}"
