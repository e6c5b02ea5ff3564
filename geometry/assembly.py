"""Parts put together in the open gmsh model: conforming solids with named volumes and faces."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from itertools import combinations

import gmsh
from pydantic import Field

from fe_drivetrain.common.errors import InputError

from .bearing import Bearing
from .housing import Housing
from .part import LENGTH_TOLERANCE, Part, dimension
from .shaft import Shaft

CAD_TOLERANCE = 1e-6
"""Two positions of CAD entities closer than this (m) are the same; bounding boxes err by 1e-7."""

GROWTH = 0.4
"""Growth of the element size with the distance from a tightly curved face, m per m."""

MOST_ELEMENTS = 1e6
"""More elements than this in one part, four million unknowns, are taken for a slip of the pen in
its mesh size or in a detail."""

WIDEST, LONGEST = 50.0, 1000.0
"""A part wider or longer than this (m) is in millimetres: the widest rotors of turbines have 12 m.
"""

_PER_VOLUME = 6 * math.sqrt(2)  # regular tetrahedra of edge 1 in a volume of 1

SIZE_PER_WALL = 3.0
"""Largest mesh size, in thicknesses of the thinnest wall: elements flatter than this fold over."""


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
        ge=6,
        le=360,
        description="least number of elements round any cylinder or sphere",
    )

    def scaled(self, factor: float) -> MeshSizes:
        """Sizes times a factor: above 1 for a coarser mesh."""
        return MeshSizes(
            shaft=self.shaft * factor,
            bearing=self.bearing * factor,
            housing=self.housing * factor,
            bearing_edge=self.bearing_edge * factor,
            elements_per_turn=self.elements_per_turn,
        )

    def finer(self, kinds: Iterable[str], factor: float) -> MeshSizes:
        """Sizes of some kinds of part divided by a factor.

        For the shaft, the elements a turn rise as well: on fillets and bores they set the size.

        Parameters
        ----------
        kinds
            Any of 'shaft', 'bearing', 'housing'.
        factor
            Above 1 for a finer mesh.
        """
        update: dict[str, float] = {kind: getattr(self, kind) / factor for kind in kinds}
        if "shaft" in update:
            update["elements_per_turn"] = math.ceil(self.elements_per_turn * factor)
        return self.model_copy(update=update)


def size_name(part: str) -> str:
    """Name of the mesh size that applies to a part."""
    if part == "shaft":
        return part
    return "housing" if part.endswith(".housing") else "bearing"


def build(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    sizes: MeshSizes,
    bonded: frozenset[str] = frozenset(),
) -> None:
    """Build the assembly in the open gmsh model, with physical groups and element sizes.

    All parts are made conforming, joints included: the nodes of a joint that is not bonded are
    doubled when the mesh is read (`fe_drivetrain.mesh.generation`), so that the two sides match
    exactly.

    Parameters
    ----------
    shaft
        The shaft, or None for bearings and housings alone.
    bearings
        The bearings on the shaft.
    housings
        Housing of each bearing, by the bearing's name; a bearing may have none.
    sizes
        Element sizes.
    bonded
        Names of the bearings whose outer face is bonded to the housing. It does not change the
        CAD model; it is checked here and used when the mesh is read.

    Raises
    ------
    InputError
        The parts do not fit together.
    """
    _check_names(shaft, bearings, housings, bonded)
    _check_units(shaft, bearings, housings)
    bores = {b.name: _bore(shaft, b) for b in bearings}
    for bearing in bearings:
        bearing.check_bore(bores[bearing.name])
        if bearing.name in housings:
            housings[bearing.name].check_fits(bearing, shaft)
    _check_sizes(shaft, bearings, housings, bores, sizes)

    solids: dict[str, int] = {}
    washers: list[tuple[str, int]] = []
    points: dict[str, int] = {}
    if shaft is not None:
        solids["shaft"] = shaft.build(b.span for b in bearings)
    for bearing in bearings:
        solids[bearing.name] = bearing.build(bores[bearing.name])
        if bearing.name in housings:
            owner = f"{bearing.name}.housing"
            solid = housings[bearing.name].build(bearing)
            solids[owner] = solid.volume
            washers += [(owner, tag) for tag in solid.washers]
            points.update({f"{owner}.{where}": tag for where, tag in solid.points.items()})

    occ = gmsh.model.occ
    targets = [(3, tag) for tag in solids.values()]
    tools = [(2, tag) for _, tag in washers] + [(0, tag) for tag in points.values()]
    # pieces[i] is what became of the i-th input: the way from a part to its entities that needs
    # no search by position
    pieces = [[t] for t in targets]
    if len(targets) + len(tools) > 1:
        _, pieces = occ.fragment(targets, tools)
    occ.synchronize()
    in_volumes, in_washers, in_points = (
        pieces[: len(targets)],
        pieces[len(targets) : len(targets) + len(washers)],
        pieces[len(targets) + len(washers) :],
    )
    parts = _volumes(list(solids), in_volumes)
    faces = {name: _boundary([(3, tag)]) for name, tag in parts.items()}
    _check_contacts(faces)
    bases: dict[str, set[int]] = {owner: set() for owner, _ in washers}
    for (owner, _), piece in zip(washers, in_washers, strict=True):
        bases[owner] |= {tag for _, tag in piece}

    for name, tag in parts.items():
        gmsh.model.addPhysicalGroup(3, [tag], name=name)
    _name_faces(shaft, bearings, housings, bores, faces, bases)
    for name, piece in zip(points, in_points, strict=True):
        gmsh.model.addPhysicalGroup(0, [tag for _, tag in piece], name=name)
    _apply_sizes(sizes, parts, faces)


def _name_faces(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    bores: Mapping[str, float],
    faces: Mapping[str, set[int]],
    bases: Mapping[str, set[int]],
) -> None:
    """Give every face that the mechanics needs its name, as a physical group."""

    def name_faces(name: str, tags: set[int]) -> None:
        gmsh.model.addPhysicalGroup(2, sorted(tags), name=name)

    if shaft is not None:
        name_faces("shaft.front", _in_plane(faces["shaft"], 0, shaft.front))
        name_faces("shaft.rear", _in_plane(faces["shaft"], 0, shaft.rear))
        bore = _shaft_bore(shaft, faces["shaft"])
        if bore:
            name_faces("shaft.bore", bore)
    for bearing in bearings:
        name, owner = bearing.name, f"{bearing.name}.housing"
        if shaft is not None:
            seat = _shared(faces, "shaft", name)
            name_faces(f"shaft.seat.{name}", seat)
        else:
            seat = _at_radius(faces[name], bores[name] / 2)
        name_faces(f"{name}.bore", seat)
        if name not in housings:
            name_faces(f"{name}.outer", _at_radius(faces[name], bearing.raceway_diameter / 2))
            continue
        contact = _shared(faces, name, owner)
        name_faces(f"{name}.outer", contact)
        name_faces(f"{owner}.bore", contact)
        if housings[name].base == "bolted":
            name_faces(f"{owner}.base", bases[owner])
        else:
            name_faces(f"{owner}.base", _in_plane(faces[owner], 2, -housings[name].centre_height))


def _check_names(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    bonded: frozenset[str],
) -> None:
    names = [b.name for b in bearings]
    known = ", ".join(names) or "none"
    if shaft is None and not names:
        raise InputError("assembly: it has no shaft and no bearing: give at least one part")
    for first, second in combinations(names, 2):
        if first == second:
            raise InputError(f"bearing {first!r} is given twice: give each bearing its own name")
    for name in housings:
        if name not in names:
            raise InputError(f"housing {name!r} has no bearing of that name: use one of {known}")
    for name in sorted(bonded):
        if name not in housings:
            raise InputError(
                f"bonded bearing {name!r} has no bearing and housing of that name: use one of "
                f"{', '.join(housings) or 'none'}"
            )


def _check_units(
    shaft: Shaft | None, bearings: Sequence[Bearing], housings: Mapping[str, Housing]
) -> None:
    """Refuse parts of a size that only millimetres taken for metres explain."""
    extents = [(f"bearing {b.name!r}", b.width, b.raceway_diameter) for b in bearings]
    extents += [
        (f"housing of {name!r}", max(h.width, h.foot_width), max(h.foot_length, h.centre_height))
        for name, h in housings.items()
    ]
    if shaft is not None:
        wide = max(max(p.outer_diameter, p.end_diameter) for p in shaft.pieces)
        extents.append(("shaft", shaft.length, wide))
    for part, long, wide in extents:
        refuse_millimetres(part, long, wide)


def refuse_millimetres(part: str, long: float, wide: float) -> None:
    """Refuse a part of implausible size.

    Parameters
    ----------
    part
        What it is, for the message.
    long, wide
        Its extents along x and across, m.

    Raises
    ------
    InputError
    """
    if long > LONGEST or wide > WIDEST:
        raise InputError(
            f"{part} is {long:g} m long and {wide:g} m wide, but must be at most {LONGEST:g} m "
            f"long and {WIDEST:g} m wide: lengths are in metres, {long / 1000:g} and "
            f"{wide / 1000:g} m if these were millimetres"
        )


def _bore(shaft: Shaft | None, bearing: Bearing) -> float:
    """Diameter of the bore of a bearing, m."""
    if shaft is None:
        if bearing.bore_diameter is None:
            raise InputError(
                f"bearing {bearing.name!r} has no bore_diameter and there is no shaft to take it "
                "from: give bore_diameter in m"
            )
        return bearing.bore_diameter
    seat = shaft.seat_diameter(bearing.x, bearing.width, bearing.name)
    bore = bearing.bore_diameter
    if bore is not None and abs(bore - seat) > LENGTH_TOLERANCE:
        raise InputError(
            f"parts 'shaft' and {bearing.name!r} do not fit: bore_diameter is {bore:g} m but the "
            f"shaft is {seat:g} m there: leave bore_diameter out or make the two equal"
        )
    return seat


def _check_sizes(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    bores: Mapping[str, float],
    sizes: MeshSizes,
) -> None:
    """Refuse elements so large that no sound element can fill the wall."""
    walls: list[tuple[str, float]] = []
    if shaft is not None:
        wall = min(min(p.outer_diameter, p.end_diameter) - p.inner_diameter for p in shaft.pieces)
        walls.append(("shaft", wall / 2))
    for bearing in bearings:
        ring = bearing.edge_radius - bores[bearing.name] / 2
        walls.append((bearing.name, ring))
        if bearing.name in housings:
            owner = f"{bearing.name}.housing"
            housing = housings[bearing.name]
            floor = housing.centre_height - bearing.raceway_diameter / 2
            walls.append((owner, min(housing.wall, floor)))
    for part, wall in walls:
        kind = size_name(part)
        size = getattr(sizes, kind)
        if part == "shaft" and shaft is not None:
            widest = max(max(p.outer_diameter, p.end_diameter) for p in shaft.pieces)
            size = min(size, math.pi * widest / sizes.elements_per_turn)
        if size > SIZE_PER_WALL * wall:
            raise InputError(
                f"part {part!r}: mesh size {kind!r} is {size:g} m but must be at most "
                f"{SIZE_PER_WALL * wall:.3g} m, {SIZE_PER_WALL:g} times its thinnest wall of "
                f"{wall:.3g} m: reduce the size or thicken the wall"
            )


def _boundary(entities: list[tuple[int, int]]) -> set[int]:
    return {tag for _, tag in gmsh.model.getBoundary(entities, combined=False, oriented=False)}


def _volumes(names: Sequence[str], pieces: Sequence[Sequence[tuple[int, int]]]) -> dict[str, int]:
    """The one volume that each part has become.

    Raises
    ------
    InputError
        Two parts own the same volume: they overlap.
    """
    owned = {
        name: {tag for dim, tag in piece if dim == 3}
        for name, piece in zip(names, pieces, strict=True)
    }
    for first, second in combinations(names, 2):
        if owned[first] & owned[second]:
            raise InputError(
                f"parts {first!r} and {second!r} overlap, but must not: move them apart or make "
                "one smaller"
            )
    for name, tags in owned.items():
        if len(tags) != 1:
            raise InputError(
                f"part {name!r} falls into {len(tags)} pieces but must be one: check that its "
                "dimensions leave it whole"
            )
    return {name: tags.pop() for name, tags in owned.items()}


def _check_contacts(faces: Mapping[str, set[int]]) -> None:
    """Refuse parts that touch without being meant to: the mesh would bond them.

    Raises
    ------
    InputError
    """
    curves = {name: _boundary([(2, tag) for tag in tags]) for name, tags in faces.items()}
    for first, second in combinations(faces, 2):
        meant = first == "shaft" and not second.endswith(".housing")
        meant = meant or second == f"{first}.housing"
        if not meant and curves[first] & curves[second]:
            raise InputError(
                f"parts {first!r} and {second!r} touch, but must be apart: move one of them or "
                "make it smaller"
            )


def _shared(faces: Mapping[str, set[int]], first: str, second: str) -> set[int]:
    tags = faces[first] & faces[second]
    if not tags:
        raise InputError(
            f"parts {first!r} and {second!r} do not touch, but must share a face: check their "
            "diameters and positions"
        )
    return tags


def _in_plane(faces: set[int], axis: int, at: float) -> set[int]:
    """Faces that lie in the plane where coordinate `axis` is `at`."""
    found = set()
    for tag in faces:
        box = gmsh.model.getBoundingBox(2, tag)
        if abs(box[axis] - at) < CAD_TOLERANCE and abs(box[axis + 3] - at) < CAD_TOLERANCE:
            found.add(tag)
    return found


def _middle(tag: int) -> tuple[float, float, float]:
    """Point of the surface (untrimmed) of a face, in the middle of its parameters."""
    x, y, z = gmsh.model.getValue(2, tag, _parameters(tag)[0])
    return x, y, z


def _at_radius(faces: set[int], radius: float) -> set[int]:
    """Curved faces about the x axis whose middle lies at a radius."""
    found = set()
    for tag in faces:
        if gmsh.model.getType(2, tag) == "Plane":
            continue
        _, y, z = _middle(tag)
        if abs(math.hypot(y, z) - radius) < CAD_TOLERANCE:
            found.add(tag)
    return found


def _shaft_bore(shaft: Shaft, faces: set[int]) -> set[int]:
    """Cylindrical walls of the bore of the shaft."""
    found: set[int] = set()
    for piece, x0, x1 in zip(shaft.pieces, shaft.stations, shaft.stations[1:], strict=False):
        if piece.inner_diameter == 0:
            continue
        for tag in _at_radius(faces, piece.inner_diameter / 2):
            if x0 - CAD_TOLERANCE < _middle(tag)[0] < x1 + CAD_TOLERANCE:
                found.add(tag)
    return found


def _apply_sizes(sizes: MeshSizes, parts: Mapping[str, int], faces: Mapping[str, set[int]]) -> None:
    """Set the element sizes: by part, finer on tightly curved faces and growing away from them."""
    for option, value in (
        ("Mesh.MeshSizeFromPoints", 0),
        ("Mesh.MeshSizeFromCurvature", 0),
        # inside the volumes only: on a face between two fillets, small edges would fill it whole
        ("Mesh.MeshSizeExtendFromBoundary", -3),
    ):
        gmsh.option.setNumber(option, value)
    field = gmsh.model.mesh.field
    fields = []
    for name, tag in parts.items():
        size = getattr(sizes, size_name(name))
        elements = near_faces = gmsh.model.occ.getMass(3, tag) * _PER_VOLUME / size**3
        if elements > MOST_ELEMENTS:
            raise InputError(
                f"part {name!r}: mesh size {size_name(name)!r} is {size:g} m, which makes about "
                f"{elements:.1g} elements, but must make at most {MOST_ELEMENTS:.0e}: choose "
                f"{size * (elements / MOST_ELEMENTS) ** (1 / 3):.2g} m or more"
            )
        fields.append(field.add("Constant"))
        field.setNumber(fields[-1], "VIn", size)
        field.setNumber(fields[-1], "VOut", 1e22)
        field.setNumbers(fields[-1], "VolumesList", [tag])
        for face in sorted(faces[name]):
            limit = _size_limit(face, sizes.elements_per_turn)
            if limit < size:
                near_faces += _elements_beside(face, limit)
                _refuse_too_many(name, face, limit, near_faces)
                fields.append(field.add("MathEval"))
                field.setString(fields[-1], "F", f"{limit:.9f} + {GROWTH} * {_distance(face)}")
        if size_name(name) == "bearing":
            fields.append(_finer_along_edges(tag, sizes.bearing_edge))
    least = field.add("Min")
    field.setNumbers(least, "FieldsList", fields)
    field.setAsBackgroundMesh(least)


def _elements_beside(face: int, size: float) -> float:
    """About how many elements a face of small ones makes, those that grow away from it included.

    The integral of 6 sqrt(2) / h^3 with h = h0 + g d at the distance d: over one side of a wide
    face A / (2 g h0^2), over half the space round a narrow one of length L pi L / (2 g^2 h0).
    """
    area, meridian = gmsh.model.occ.getMass(2, face), _meridian(face)
    box = gmsh.model.getBoundingBox(2, face)
    length = math.dist(box[:3], box[3:])
    if meridian is not None:
        x0, x1, r0, r1 = meridian
        length = max(2 * math.pi * r1, math.hypot(x1 - x0, r1 - r0))
    wide, narrow = area / (2 * GROWTH * size**2), math.pi * length / (2 * GROWTH**2 * size)
    return float(_PER_VOLUME * (wide + narrow))


def _refuse_too_many(name: str, face: int, size: float, elements: float) -> None:
    if elements > MOST_ELEMENTS:
        x0, y0, _, x1, y1, _ = gmsh.model.getBoundingBox(2, face)
        raise InputError(
            f"part {name!r}: a bore, fillet or narrow face at x = {x0:.6g} to {x1:.6g} m, "
            f"y = {y0:.6g} to {y1:.6g} m needs elements of {size:.2g} m, which make about "
            f"{elements:.1g} elements, but must make at most {MOST_ELEMENTS:.0e}: leave that "
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
        for curve in _boundary([(2, face) for face in _boundary([(3, tag)])])
        if gmsh.model.getType(1, curve) != "Line"
    ]
    length = math.fsum(gmsh.model.occ.getMass(1, curve) for curve in circles) / 2  # each is twice
    # a quarter of a turn round each edge, elements growing away from it
    elements = _PER_VOLUME * length * math.pi / 4 / (GROWTH**2 * size)
    if elements > MOST_ELEMENTS:
        raise InputError(
            f"mesh size 'bearing_edge' is {size:g} m, which makes about {elements:.1g} elements, "
            f"but must make at most {MOST_ELEMENTS:.0e}: choose "
            f"{size * elements / MOST_ELEMENTS:.2g} m or more"
        )
    distance = field.add("Distance")
    field.setNumbers(distance, "CurvesList", circles)
    field.setNumber(distance, "Sampling", 200)
    growing = field.add("MathEval")
    field.setString(growing, "F", f"{size:.9f} + {GROWTH} * F{distance}")
    return int(growing)


def _parameters(face: int) -> list[list[float]]:
    """Parameters (u, v) of the middle and the corners of a face's rectangle of parameters."""
    (u0, v0), (u1, v1) = gmsh.model.getParametrizationBounds(2, face)
    return [[(u0 + u1) / 2, (v0 + v1) / 2], [u0, v0], [u0, v1], [u1, v0], [u1, v1]]


def _size_limit(face: int, elements_per_turn: int) -> float:
    """Largest element size that a face allows, whatever its part is given, m.

    A curved face gets its number of elements a turn; a fillet (torus) is allowed elements half as
    long again, since its arc is a quarter of a turn or less, and small elements all round the
    shaft are expensive. A narrow ring (a low step, the rim beside a bearing) gets chords whose
    sagitta, size^2 / (8 radius), is at most half its width: the edges on its two sides would cross.
    """
    kind, limit = gmsh.model.getType(2, face), math.inf
    if kind != "Plane":
        largest, smallest, _, _ = gmsh.model.getPrincipalCurvatures(face, _parameters(face)[0])
        curvature = max(abs(float(largest[0])), abs(float(smallest[0])))
        if curvature > 0:
            limit = (1.5 if kind == "Torus" else 1.0) * 2 * math.pi / curvature / elements_per_turn
    meridian = _meridian(face)
    if meridian is not None:
        x0, x1, r0, r1 = meridian
        limit = min(limit, 2 * math.sqrt(r1 * math.hypot(x1 - x0, r1 - r0)))
    return limit


def _meridian(face: int) -> tuple[float, float, float, float] | None:
    """Ranges (x0, x1, r0, r1) of x and radius of a face that goes round the x axis, else None."""
    x0, y0, z0, x1, y1, z1 = gmsh.model.getBoundingBox(2, face)
    if abs(y0 + y1) > CAD_TOLERANCE or abs(z0 + z1) > CAD_TOLERANCE:
        return None
    if gmsh.model.getType(2, face) == "Plane":
        boxes = [gmsh.model.getBoundingBox(1, tag) for tag in _boundary([(2, face)])]
        radii = [box[5] for box in boxes]
        return x0, x1, min(radii) if len(radii) > 1 else 0.0, max(radii)
    at = [gmsh.model.getValue(2, face, p) for p in _parameters(face)]
    radii = [math.hypot(y, z) for _, y, z in at]
    return x0, x1, min(radii), max(radii)


def _distance(face: int) -> str:
    """Distance from a face's bounding box, as a formula for gmsh.

    The box is one of (x, radius) where the face goes round the x axis, of (x, y, z) elsewhere.
    """
    meridian = _meridian(face)
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
