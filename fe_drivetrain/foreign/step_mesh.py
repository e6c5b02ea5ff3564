"""The solids of a STEP file divided where a bearing and bolts touch it, and meshed, in mm.

This runs in a process of its own, see `reading`; it imports little else than gmsh and numpy.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import gmsh
import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.foreign.face_messages import nearly
from fe_drivetrain.foreign.step_fit import lies_on
from fe_drivetrain.foreign.step_heal import VOLUME_TOLERANCE, reason, where
from fe_drivetrain.foreign.step_joint import (
    annulus,
    drop_loose_faces,
    open_joint,
    rings_round_bolts,
)
from fe_drivetrain.foreign.step_solid import (
    distance,
    has_splines,
    picked,
    seat_cylinders,
)
from fe_drivetrain.foreign.step_solids import Place, all_placed, became, common, outside
from fe_drivetrain.foreign.telling import tell

MAX_MESH = 400_000
"""Maximum number of elements of a part."""


def cut(survey: dict[str, Any], request: dict[str, Any]) -> dict[str, list[int]]:
    """Divide the faces of the solid at the sides of the bearing and round the bolts.

    Parameters
    ----------
    survey : dict
        Survey from `opened`.
    request : dict
        Values "seat", "held" and "bolts" as in the scene, "low" and "high", distances of the
        bearing's sides from the seat's middle along "along", the direction of x [mm].

    Returns
    -------
    dict
        Tags of the faces "bore", "seat" and "base", of "head 1", "head 2", ..., and of a bolted
        joint "pressed" and "open".
    """
    occ, name = gmsh.model.occ, survey["name"]
    solids = gmsh.model.getEntities(3)
    seat = seat_of(survey, request)
    base_tags = list(
        dict.fromkeys(t for pick in request["held"] for t in picked(survey, pick, "held face"))
    )
    if set(base_tags) & set(seat["tags"]):
        raise InputError(f"{name}: a face of the seat is held, too: hold another face")
    holes = bolt_holes(survey, request, base_tags) if request.get("bolts") else []

    along, centre = np.array(request["along"]), np.array(seat["centre"])
    if request["centre"] is not None:  # of the bearing
        centre = np.array(request["centre"])
    _check_seat(name, seat, request, along, centre)
    within = _between_sides(survey, seat, request, along, centre)
    rings, groups = _washers(holes, request)
    joint: list[int] = []
    if request.get("bolted"):
        joint = rings_round_bolts(survey, request["bolted"], common(), "a face between two solids")
    cutters = [*rings, *joint]
    heads = dict.fromkeys(hole["head face"] for hole in holes if _has_heads(request))
    were = [(float(occ.getMass(2, r)), occ.getCenterOfMass(2, r)) for r in cutters]  # planes
    objects = [*within, *((2, t) for t in (*cutters, *seat["tags"], *base_tags, *heads))]
    bodies, pieces = _divided(survey, solids, objects, seat["radius"])
    surface, now = set(outside()), all_placed()
    was = {face["tag"]: face for face in survey["faces"]}
    at = len(solids) + len(within) + len(cutters)
    cut_faces = [*seat["tags"], *base_tags]
    after = [
        _left(was[tag], piece, surface, survey["size"], now)
        for tag, piece in zip(cut_faces, pieces[at : at + len(cut_faces)], strict=True)
    ]
    n = len(seat["tags"])
    on_seat, on_base = set().union(*after[:n]), set().union(*after[n:])
    pieces_of_rings = [
        became(ring, piece, survey["size"], now)
        for ring, piece in zip(were, pieces[at - len(cutters) : at], strict=True)
    ]
    faces: dict[str, list[int]] = {"seat": sorted(on_seat)}
    faces["bore"] = sorted(_between(on_seat, request, along, centre))
    if request.get("bolts"):
        on_ring = [tags & surface for tags in pieces_of_rings[: len(rings)]]
        under = dict(zip(groups, on_ring, strict=True))
        if request["bolts"]["hold"] != "clamped":
            on_base &= set().union(*(r for group, r in under.items() if group.startswith("foot")))
        if _has_heads(request):
            faces |= {group: sorted(tags) for group, tags in under.items()}
    if base_tags:
        faces["base"] = sorted(on_base)
    if joint:
        faces |= open_joint(name, set().union(*pieces_of_rings[len(rings) :]))
    _refuse_lost(name, faces, request, along)
    drop_loose_faces()
    gmsh.model.addPhysicalGroup(3, bodies, name="body")
    for key, tags in faces.items():
        if tags:
            gmsh.model.addPhysicalGroup(2, tags, name=f"body.{key}")
    return faces


def _between_sides(
    survey: dict[str, Any], seat: dict[str, Any], request: dict[str, Any], along: Any, centre: Any
) -> list[tuple[int, int]]:
    """What divides the seat at the sides of the bearing."""
    occ, radius, low, high = gmsh.model.occ, seat["radius"], request["low"], request["high"]
    start, across = centre + low * along, (high - low) * along
    reach = 1.1 * radius if seat["kind"] == "Sphere" else radius
    was = {face["tag"]: face for face in survey["faces"]}
    if any("described" in was[t] for t in seat["tags"]):
        return _pieces_at(seat["tags"], [start, start + across], along, reach)
    slab = occ.addCylinder(*start, *across, reach)
    if seat["kind"] == "Sphere":
        ball = occ.addSphere(*seat["centre"], radius)
        ((_, slab),), _ = occ.intersect([(3, ball)], [(3, slab)])
    return [(3, slab)]


def _washers(
    holes: Sequence[dict[str, Any]], request: dict[str, Any]
) -> tuple[list[int], list[str]]:
    """Rings under washers at the foot, and under heads, and the names of their faces."""
    rings, groups = [], []
    for hole in holes:
        for which in ("foot", "head") if _has_heads(request) else ("foot",):
            outer, inner = request["bolts"]["washer_diameter"] / 2, request["bolts"]["hole_radius"]
            rings.append(annulus(hole[which], hole["axis"], inner, outer))
            groups.append(f"{which} {hole['number']}")
    return rings, groups


def _divided(
    survey: dict[str, Any],
    solids: Sequence[tuple[int, int]],
    objects: Sequence[tuple[int, int]],
    radius: float,
) -> tuple[list[int], list[list[tuple[int, int]]]]:
    """Divide the solids, which stay whole; their tags, and what each thing has become."""
    occ = gmsh.model.occ
    mass = math.fsum(occ.getMass(3, t) for _, t in solids)
    _, pieces = occ.fragment(solids, objects)
    occ.synchronize()
    bodies = [t for piece in pieces[: len(solids)] for d, t in piece if d == 3]
    left = math.fsum(occ.getMass(3, t) for t in bodies)
    # of splines volumes are too inexact to tell; what a bearing overlaps is a body more
    lost = not has_splines(survey) and abs(left / mass - 1) > VOLUME_TOLERANCE
    if len(bodies) != len(solids) or lost:
        raise InputError(
            f"{survey['name']}: the solid does not stay whole where the bearing's sides cut its "
            f"seat: the bearing overlaps it there, or the seat of radius {radius:.6g} mm is not "
            "round"
        )
    gmsh.model.removeEntities([e for e in gmsh.model.getEntities(3) if e[1] not in bodies])
    return bodies, pieces


def _between(on_seat: set[int], request: dict[str, Any], along: Any, centre: Any) -> list[int]:
    """Faces of the seat between the sides of the bearing."""
    bore = []
    for t in on_seat:
        x = (np.array(gmsh.model.occ.getCenterOfMass(2, t)) - centre) @ along
        if request["low"] < x < request["high"]:
            bore.append(t)
    return bore


def _refuse_lost(
    name: str, faces: dict[str, list[int]], request: dict[str, Any], along: Any
) -> None:
    """Refuse a part of which a face is lost, or whose seat is narrower than the bearing."""
    for key, tags in faces.items():
        if not tags and key != "open":  # where bolts press all of the joint
            raise InputError(
                f"{name}: nothing is left of the {key} where it is cut at the bearing's sides and "
                "round the bolts: check the washers' diameter and the placement"
            )
    width, length = request["high"] - request["low"], _length(faces["bore"], along)
    if length < width * (1 - 1e-4):
        raise InputError(
            f"{name}: its seat covers {length:.6g} mm of the bearing's width of {width:.6g} mm, "
            "but must cover all of it: move the part, or make the bearing narrower"
        )


def seat_of(survey: dict[str, Any], request: dict[str, Any]) -> dict[str, Any]:
    """Bore that is picked as the seat, see `seat_cylinders`.

    Raises
    ------
    InputError
        It is none, or several.
    """
    name, tags = survey["name"], picked(survey, request["seat"], "seat")
    seats = [s for s in seat_cylinders(survey) if set(s["tags"]) & set(tags)]
    if len(seats) > 1:
        raise InputError(
            f"{name}: the seat must be one bore, a cylinder or a sphere, but {len(seats)} are "
            "picked: give its axis and a point on that"
        )
    if not seats:
        almost = [nearly(f) for f in survey["faces"] if f["tag"] in tags and "nearly" in f]
        what = f", but it is {almost[0]}" if almost else ""
        raise InputError(
            f"{name}: the seat must be a bore, a cylinder or a sphere{what}: pick another face"
        )
    return seats[0]


def _pieces_at(
    seat: Sequence[int], sides: Sequence[Any], along: Any, reach: float
) -> list[tuple[int, int]]:
    """Copies of a seat's faces divided at the bearing's sides.

    A solid of the bearing would have a face almost on these splines, which OpenCASCADE takes for
    another one.
    """
    occ = gmsh.model.occ
    copies = occ.copy([(2, t) for t in seat])
    disks = [(2, occ.addDisk(*at, 1.1 * reach, 1.1 * reach, zAxis=list(along))) for at in sides]
    made, pieces = occ.fragment(copies, disks)
    kept = list(dict.fromkeys(p for piece in pieces[: len(copies)] for p in piece))
    occ.remove([p for p in made if p not in kept], recursive=True)
    return kept


def _left(
    face: dict[str, Any],
    piece: list[tuple[int, int]],
    surface: set[int],
    size: float,
    now: dict[int, Place],
) -> set[int]:
    """Tags of what is left of a face; areas of splines are too inexact to know a bore's by."""
    if "described" in face and "radius" in face:
        splines = {t for t in surface if gmsh.model.getType(2, t) != "Plane"}
        return {t for t in splines if lies_on(t, face, size)}
    return became((face["area"], face["middle"]), piece, size, now) & surface


def _has_heads(request: dict[str, Any]) -> bool:
    """Whether bolts are bodies that pull at the holes' upper ends."""
    return bool(request["bolts"]["hold"] != "washers")


def name_faces(survey: dict[str, Any], request: dict[str, Any]) -> None:
    """Name the tied and held faces of a part without a seat, "body.tie 1" ... and "body.held".

    Where a part is joined round the bolts of a tied face alone, "body.open 1" ... is the rest of
    it.
    """
    name = survey["name"]
    faces = {
        f"tie {k}": picked(survey, pick, "tied face") for k, pick in enumerate(request["tied"], 1)
    }
    # several parts may lie on one face, each once
    used = [(t, to) for tags, to in zip(faces.values(), request["to"], strict=True) for t in tags]
    if request["held"]:
        held = [t for pick in request["held"] for t in picked(survey, pick, "held face")]
        faces["held"] = list(dict.fromkeys(held))
        used += [(t, to) for t in faces["held"] for to in dict.fromkeys(request["to"])]
    if len(set(used)) < len(used):
        twice = next(t for t, to in used if used.count((t, to)) > 1)
        middle = next(f["middle"] for f in survey["faces"] if f["tag"] == twice)
        raise InputError(
            f"{name}: the face round {_xyz(middle)} mm is picked twice, to be tied or held: pick "
            "each face once"
        )
    if any(request["bolted"]):
        faces = _round_bolts(survey, request, faces)
    gmsh.model.addPhysicalGroup(3, [t for _, t in gmsh.model.getEntities(3)], name="body")
    for key, found in faces.items():
        if found:
            gmsh.model.addPhysicalGroup(2, found, name=f"body.{key}")


def _round_bolts(
    survey: dict[str, Any], request: dict[str, Any], faces: dict[str, list[int]]
) -> dict[str, list[int]]:
    """Divide tied faces round their bolts: "tie 1" is what is joined, "open 1" the rest."""
    occ, size, name = gmsh.model.occ, survey["size"], survey["name"]
    solids, was = gmsh.model.getEntities(3), all_placed()
    rings = {
        f"tie {k}": rings_round_bolts(survey, bolted, faces[f"tie {k}"], f"tied face {k}")
        for k, bolted in enumerate(request["bolted"], 1)
        if bolted
    }
    flat = [ring for made in rings.values() for ring in made]
    were = {ring: (float(occ.getMass(2, ring)), occ.getCenterOfMass(2, ring)) for ring in flat}
    old = list(dict.fromkeys(t for tags in faces.values() for t in tags))
    _, pieces = occ.fragment(solids, [(2, t) for t in [*flat, *old]])
    occ.synchronize()
    if len(gmsh.model.getEntities(3)) != len(solids):
        raise InputError(f"{name}: the solid does not stay whole where it is cut round its bolts")
    surface, now = set(outside()), all_placed()
    after = dict(zip([*flat, *old], pieces[len(solids) :], strict=True))

    def left(place: Place, tag: int) -> set[int]:
        return became(place, after[tag], size, now) & surface

    found = {}
    for key, tags in faces.items():
        whole = set().union(*(left(was[t], t) for t in tags))
        if key in rings:
            pressed = whole & set().union(*(left(were[r], r) for r in rings[key]))
            found[key.replace("tie", "open")] = sorted(whole - pressed)
            whole = pressed
        if not whole:
            raise InputError(
                f"{name}: nothing is left of {key} where it is cut round its bolts: check their "
                "pressed_diameter and the file"
            )
        found[key] = sorted(whole)
    drop_loose_faces()
    return found


def _check_seat(
    name: str, seat: dict[str, Any], request: dict[str, Any], along: Any, centre: Any
) -> None:
    """Refuse a seat that is not that of the bearing: kind, radius, direction or place."""
    kind, radius, axis = request["kind"], request["radius"], np.array(seat["axis"])
    if seat["kind"] != kind:
        raise InputError(
            f"{name}: the seat is a {seat['kind'].lower()}, but the bearing needs a "
            f"{kind.lower()}: give the bearing the kind 'ring' for a cylinder, 'spherical' for a "
            "sphere, or pick another face"
        )
    if abs(seat["radius"] - radius) > request["tolerance"] * radius:
        raise InputError(
            f"{name}: the seat has a radius of {seat['radius']:.7g} mm, but the bearing's raceway "
            f"{radius:.7g} mm: make the bearing's raceway_diameter twice the seat's radius, pick "
            "another seat, or correct the unit"
        )
    off = centre - np.array(seat["centre"])
    if kind == "Cylinder":
        angle = math.degrees(math.asin(min(1.0, float(np.linalg.norm(np.cross(axis, along))))))
        if angle > 0.01:
            raise InputError(
                f"{name}: the seat's axis is {angle:.3g} degrees from the scene's x axis, but must "
                "be along it: correct 'rotate'"
            )
        off = off - (off @ axis) * axis
    if (apart := float(np.linalg.norm(off))) > 10 * request["tolerance"] * radius:
        raise InputError(
            f"{name}: the seat's axis is {apart:.4g} mm from the bearing's centre, but must go "
            "through it: correct 'translate', or leave it out"
        )


def _length(tags: Sequence[int], along: Any) -> float:
    """Length of faces along a direction, from points on their edges."""
    values: list[float] = []
    for _, edge in gmsh.model.getBoundary([(2, t) for t in tags], combined=False, oriented=False):
        low, high = (float(b[0]) for b in gmsh.model.getParametrizationBounds(1, edge))
        at = np.linspace(low, high, 9)
        values += (np.reshape(gmsh.model.getValue(1, edge, at.tolist()), (-1, 3)) @ along).tolist()
    return max(values) - min(values) if values else 0.0


def bolt_holes(
    survey: dict[str, Any], request: dict[str, Any], base: Sequence[int]
) -> list[dict[str, Any]]:
    """Holes of the bolts' radius that end on a held face: where they begin, and end."""
    bolts, faces = request["bolts"], {face["tag"]: face for face in survey["faces"]}
    planes = [faces[t] for t in base if faces[t]["kind"] == "Plane"]
    tolerance = 1e-5 * survey["size"]
    found: list[dict[str, Any]] = []
    for seat in seat_cylinders(survey):
        if (
            seat["kind"] != "Cylinder"
            or abs(seat["radius"] - bolts["hole_radius"]) > 1e-3 * seat["radius"]
        ):
            continue
        axis, centre = np.array(seat["axis"]), np.array(seat["centre"])
        for plane in planes:
            normal = np.array(plane["normal"])
            if np.linalg.norm(np.cross(normal, axis)) > 1e-4:
                continue
            up = -normal  # into the solid
            foot = centre - up * seat["length"] / 2
            if abs((foot - plane["middle"]) @ normal) > tolerance:
                continue
            head = centre + up * seat["length"] / 2
            tops = [
                f["tag"]
                for f in survey["faces"]
                if f["kind"] == "Plane"
                and np.linalg.norm(np.cross(f["normal"], axis)) < 1e-4
                and abs((head - np.array(f["middle"])) @ axis) < tolerance
                and distance(f["tag"], head.tolist()) < 1.01 * seat["radius"]
            ]
            if _has_heads(request) and not tops:
                raise InputError(
                    f"{survey['name']}: the hole at {_xyz(foot)} mm does not end on a plane face, "
                    "on which a bolt's head could press: hold 'washers'"
                )
            found.append(
                {
                    "number": len(found) + 1,
                    "foot": foot.tolist(),
                    "head": head.tolist(),
                    "axis": up.tolist(),
                    "length": seat["length"],
                    "head face": tops[0] if tops else 0,
                }
            )
            break
    if not found:
        raise InputError(
            f"{survey['name']}: no hole of radius {bolts['hole_radius']:g} mm ends on a held face: "
            "check hole_radius, or hold the face that the bolts go through"
        )
    return found


def _xyz(place: Any) -> str:
    return "({:.4g}, {:.4g}, {:.4g})".format(*place)


def mesh(survey: dict[str, Any], size: float, per_turn: int, optimise: bool) -> None:
    """Mesh the solids with curved second-order tetrahedra of a size [mm].

    Having gmsh move nodes where they fold over, along faces, too (optimise), takes ten times as
    long, and ends a little elsewhere each time.
    """
    name = survey["name"]
    elements = 6 * math.sqrt(2) * survey["after"]["volume"] / size**3
    if elements > MAX_MESH:
        raise InputError(
            f"{name}: elements of {size:g} mm make about {elements:.1g}, but must make at most "
            f"{MAX_MESH:.0g}: choose {size * (elements / MAX_MESH) ** (1 / 3):.2g} mm or "
            "more for the housing"
        )
    for option, value in (
        ("MeshSizeFromPoints", 0),
        ("MeshSizeFromCurvature", per_turn),
        ("MeshSizeExtendFromBoundary", 1),
        ("MeshSizeMax", size),
        ("MeshSizeMin", size / 50),
    ):
        gmsh.option.setNumber(f"Mesh.{option}", value)
    tell(f"meshing with elements of {size:.3g} mm")
    gmsh.model.mesh.clear()  # what healing has tried
    try:
        for dim in (1, 2, 3):
            gmsh.model.mesh.generate(dim)
            if dim == 2 and (n := _count(2)) > MAX_MESH:
                raise InputError(
                    f"{name}: {n} triangles are on its faces, but at most {MAX_MESH:.0g} may "
                    "be: leave out small fillets, threads and lettering"
                )
        gmsh.model.mesh.setOrder(2)
        if optimise:
            gmsh.model.mesh.optimize("HighOrder")
    except InputError:
        raise
    except Exception as error:
        why = reason(error)
        raise InputError(
            f"gmsh cannot mesh {name} ({why}{where(why)}): repair or leave out that detail, "
            "or choose smaller elements"
        ) from None
    if _count(3) == 0:
        raise InputError(f"gmsh has made no elements in {name}{where('')}: repair its faces")


def _count(dim: int) -> int:
    _, tags, _ = gmsh.model.mesh.getElements(dim)
    return sum(len(t) for t in tags)
