"""Parts put together in the open gmsh model: conforming solids with named volumes and faces."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from itertools import combinations
from types import MappingProxyType

import gmsh

from fe_drivetrain.common.errors import InputError

from .bearing import Bearing
from .element_sizes import MeshSizes, apply_sizes
from .faces import CAD_TOLERANCE, at_radius, boundary, in_plane, middle, shared
from .fits import Band, check_bands, check_parts
from .housing import Housing
from .shaft import Shaft
from .walls import check_sizes

NO_BANDS: Mapping[str, Band] = MappingProxyType({})
"""No bands: loads enter the shaft at its ends and seats alone."""


def build(
    shaft: Shaft | None,
    bearings: Sequence[Bearing],
    housings: Mapping[str, Housing],
    sizes: MeshSizes,
    bonded: frozenset[str] = frozenset(),
    bands: Mapping[str, Band] = NO_BANDS,
) -> None:
    """Build the assembly in the open gmsh model, with physical groups and element sizes.

    All parts are made conforming, joints included: the nodes of a joint that is not bonded are
    doubled when the mesh is read (`fe_drivetrain.elasticity.mesh.generation`), so that the two
    sides match exactly.

    Parameters
    ----------
    shaft : Shaft or None
        The shaft, or None for bearings and housings alone.
    bearings : Sequence[Bearing]
        The bearings on the shaft.
    housings : Mapping[str, Housing]
        Housing of each bearing, by the bearing's name; a bearing may have none.
    sizes : MeshSizes
        Element sizes.
    bonded : frozenset[str]
        Names of the bearings whose outer face is bonded to the housing. It does not change the
        CAD model; it is checked here and used when the mesh is read.
    bands : Mapping[str, Band]
        Further bands where loads enter the shaft, by name. Each becomes a face, "shaft.band.NAME".

    Raises
    ------
    InputError
        The parts do not fit together.
    """
    bores = check_parts(shaft, bearings, housings, bonded)
    if shaft is not None:
        check_bands(shaft, bands, bearings)
    check_sizes(shaft, bearings, housings, bores, sizes)

    solids: dict[str, int] = {}
    washers: list[tuple[str, int]] = []
    points: dict[str, int] = {}
    if shaft is not None:
        outside = [band[:2] for band in bands.values() if not band.inside]
        inside = [band[:2] for band in bands.values() if band.inside]
        solids["shaft"] = shaft.build([*(b.span for b in bearings), *outside], inside)
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
    faces = {name: boundary([(3, tag)]) for name, tag in parts.items()}
    _check_contacts(faces)
    bases: dict[str, set[int]] = {owner: set() for owner, _ in washers}
    for (owner, _), piece in zip(washers, in_washers, strict=True):
        bases[owner] |= {tag for _, tag in piece}

    for name, tag in parts.items():
        gmsh.model.addPhysicalGroup(3, [tag], name=name)
    _name_faces(shaft, bearings, housings, bores, faces, bases)
    if shaft is not None:
        _name_bands(shaft, bands, faces["shaft"])
    for name, piece in zip(points, in_points, strict=True):
        gmsh.model.addPhysicalGroup(0, [tag for _, tag in piece], name=name)
    apply_sizes(sizes, parts, faces)


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
        name_faces("shaft.front", in_plane(faces["shaft"], 0, shaft.front))
        name_faces("shaft.rear", in_plane(faces["shaft"], 0, shaft.rear))
        bore = _shaft_bore(shaft, faces["shaft"])
        if bore:
            name_faces("shaft.bore", bore)
    for bearing in bearings:
        name, owner = bearing.name, f"{bearing.name}.housing"
        if shaft is not None:
            seat = shared(faces, "shaft", name)
            name_faces(f"shaft.seat.{name}", seat)
        else:
            seat = at_radius(faces[name], bores[name] / 2)
        name_faces(f"{name}.bore", seat)
        if name not in housings:
            name_faces(f"{name}.outer", at_radius(faces[name], bearing.raceway_diameter / 2))
            continue
        contact = shared(faces, name, owner)
        name_faces(f"{name}.outer", contact)
        name_faces(f"{owner}.bore", contact)
        if housings[name].base == "bolted":
            name_faces(f"{owner}.base", bases[owner])
        else:
            name_faces(f"{owner}.base", in_plane(faces[owner], 2, -housings[name].centre_height))


def _name_bands(shaft: Shaft, bands: Mapping[str, Band], faces: set[int]) -> None:
    """Give the parts of the shaft's faces where loads enter their names."""
    for name, (low, high, inside) in bands.items():
        x = (low + high) / 2
        around = at_radius(faces, shaft.inner_radius(x) if inside else shaft.outer_radius(x))
        here = sorted(tag for tag in around if low < middle(tag)[0] < high)
        gmsh.model.addPhysicalGroup(2, here, name=f"shaft.band.{name}")


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
    curves = {name: boundary([(2, tag) for tag in tags]) for name, tags in faces.items()}
    for first, second in combinations(faces, 2):
        meant = first == "shaft" and not second.endswith(".housing")
        meant = meant or second == f"{first}.housing"
        if not meant and curves[first] & curves[second]:
            raise InputError(
                f"parts {first!r} and {second!r} touch, but must be apart: move one of them or "
                "make it smaller"
            )


def _shaft_bore(shaft: Shaft, faces: set[int]) -> set[int]:
    """Cylindrical walls of the bore of the shaft."""
    found: set[int] = set()
    for piece, x0, x1 in zip(shaft.pieces, shaft.stations, shaft.stations[1:], strict=False):
        if piece.inner_diameter == 0:
            continue
        for tag in at_radius(faces, piece.inner_diameter / 2):
            if x0 - CAD_TOLERANCE < middle(tag)[0] < x1 + CAD_TOLERANCE:
                found.add(tag)
    return found
