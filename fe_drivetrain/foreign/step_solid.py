"""A STEP file's solid in the open gmsh model, in mm: healed, described, picked, cut and meshed.

This runs in a process of its own, see `reading`; it imports little else than gmsh and numpy.
"""

from __future__ import annotations

import math
import re
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import Any

import gmsh
import numpy as np

from fe_drivetrain.common.errors import InputError

VOLUME_TOLERANCE = 1e-4
"""Relative change of a volume by healing that is refused."""

LARGEST_MESH = 400_000
"""Most elements of a part."""

_MOST_FACES = 20_000
_ALIGNED = 1e-6  # sine of the angle between directions that are the same
_SAME = 1e-6  # of a solid's size: places that are the same
_SURFACES = {  # as STEP and gmsh call them
    "PLANE": "Plane",
    "CYLINDRICAL_SURFACE": "Cylinder",
    "CONICAL_SURFACE": "Cone",
    "SPHERICAL_SURFACE": "Sphere",
    "TOROIDAL_SURFACE": "Torus",
}


def opened(path: str, smallest_detail: float = 0.0) -> dict[str, Any]:
    """Import and heal a STEP file of one solid; what is known of it, for `Survey`."""
    name, occ = Path(path).name, gmsh.model.occ
    for option in ("FixDegenerated", "FixSmallEdges", "FixSmallFaces", "SewFaces", "MakeSolids"):
        gmsh.option.setNumber(f"Geometry.OCC{option}", 0)
    gmsh.option.setNumber("Geometry.OCCAutoFix", 0)
    gmsh.option.setNumber("Geometry.OCCImportLabels", 1)
    try:
        occ.importShapes(path)
    except Exception as error:
        raise InputError(
            f"{name} cannot be read as STEP ({reason(error)}): export it again, whole, as AP214 "
            "or AP242"
        ) from None
    occ.synchronize()
    before = _counted()
    if before["solids"] != 1:
        raise InputError(
            f"{name} has {before['solids']} solids but must have one: save the one part, as a "
            "solid, in a file of its own"
        )
    if before["faces"] > _MOST_FACES:
        raise InputError(
            f"{name} has {before['faces']} faces but must have at most {_MOST_FACES}: leave out "
            "threads, lettering and other small details"
        )
    colours = {t: _colour(t) for _, t in gmsh.model.getEntities(2)}
    labels = _labels(path)
    try:
        occ.healShapes([], smallest_detail or 1e-8, True, smallest_detail > 0, smallest_detail > 0)
    except Exception as error:
        raise InputError(
            f"{name} cannot be healed ({reason(error)}{where(reason(error))}): repair that "
            "face in the CAD program, or leave it out"
        ) from None
    occ.synchronize()
    after = _counted()
    change = abs(after["volume"] - before["volume"]) / max(abs(before["volume"]), 1e-300)
    if after["solids"] != 1 or not change <= VOLUME_TOLERANCE or not after["volume"] > 0:
        raise InputError(
            f"{name} has {before['solids']} solid of {before['volume']:.9g} mm^3 before and "
            f"{after['solids']} of {after['volume']:.9g} mm^3 after healing, but must have one of "
            f"the same volume, to {VOLUME_TOLERANCE:g}: repair its faces in the CAD program"
        )
    faces = [_face(t) for _, t in gmsh.model.getEntities(2)]
    kept = after["faces"] == before["faces"]
    for number, face in enumerate(faces):
        face["colour"] = colours.get(face["tag"], "") if kept else ""
        same = (
            kept
            and len(labels) == len(faces)
            and all(
                _SURFACES.get(kind, f["kind"]) == f["kind"]
                for (_, kind), f in zip(labels, faces, strict=True)
            )
        )
        face["label"] = labels[number][0] if same else ""
    return {
        "name": name,
        "before": before,
        "after": after,
        "box": _box(),
        "faces": faces,
        "size": math.dist(_box()[:3], _box()[3:]),
    }


def reason(error: Exception) -> str:
    """What gmsh says of its failure, in one line."""
    found = str(gmsh.logger.getLastError() or error or "no reason given")
    return " ".join(found.split())[:200].rstrip(".")


def _counted() -> dict[str, Any]:
    solids = gmsh.model.getEntities(3)
    return {
        "solids": len(solids),
        "faces": len(gmsh.model.getEntities(2)),
        "edges": len(gmsh.model.getEntities(1)),
        "volume": math.fsum(gmsh.model.occ.getMass(3, t) for _, t in solids),
        "area": math.fsum(gmsh.model.occ.getMass(2, t) for _, t in gmsh.model.getEntities(2)),
    }


def _box() -> list[float]:
    return [float(x) for x in gmsh.model.getBoundingBox(-1, -1)]


def _colour(face: int) -> str:
    r, g, b, a = gmsh.model.getColor(2, face)
    return f"#{r:02x}{g:02x}{b:02x}" if a else ""


def _labels(path: str) -> list[tuple[str, str]]:
    """Names of faces and kinds of their surfaces, in the order of the solid's one shell.

    gmsh does not read names of faces. It numbers them as they stand in the shell, and `opened`
    compares kinds of surfaces before it believes so.
    """
    text = Path(path).read_text("latin-1")
    shells = re.findall(r"CLOSED_SHELL\s*\(\s*'[^']*'\s*,\s*\(([^()]*)\)", text)
    if len(shells) != 1:
        return []
    names = dict(
        (number, (name, surface))
        for number, name, surface in re.findall(
            r"#(\d+)\s*=\s*ADVANCED_FACE\s*\(\s*'([^']*)'\s*,\s*\([^()]*\)\s*,\s*#(\d+)", text
        )
    )
    kinds = dict(re.findall(r"#(\d+)\s*=\s*([A-Z_]+_SURFACE|PLANE)\s*\(", text))
    found = re.findall(r"#(\d+)", shells[0])
    if not all(number in names for number in found):
        return []
    return [(names[n][0].strip(), kinds.get(names[n][1], "")) for n in found]


def _face(tag: int) -> dict[str, Any]:
    kind, occ = gmsh.model.getType(2, tag), gmsh.model.occ
    face: dict[str, Any] = {
        "tag": tag,
        "kind": kind,
        "area": float(occ.getMass(2, tag)),
        "middle": [float(x) for x in occ.getCenterOfMass(2, tag)],
    }
    _, reals = gmsh.model.getEntityProperties(2, tag)
    if kind == "Plane":
        (u0, v0), (u1, v1) = gmsh.model.getParametrizationBounds(2, tag)
        face["normal"] = [
            float(x) for x in gmsh.model.getNormal(tag, [(u0 + u1) / 2, (v0 + v1) / 2])
        ]
    elif kind == "Cylinder":
        place, axis = np.array(reals[:3]), np.array(reals[3:6])
        (_, v0), (_, v1) = gmsh.model.getParametrizationBounds(2, tag)
        ends = sorted((float(v0), float(v1)))
        face |= {
            "axis": axis.tolist(),
            "radius": float(reals[6]),
            "centre": (place + axis * (ends[0] + ends[1]) / 2).tolist(),
            "length": ends[1] - ends[0],
            "hole": _is_hole(tag, place, axis),
        }
    elif kind == "Sphere":
        face |= {"centre": [float(x) for x in reals[:3]], "radius": float(reals[-1])}
        face["hole"] = _is_hole(tag, np.array(face["centre"]), np.zeros(3))
    return face


def _is_hole(tag: int, place: Any, axis: Any) -> bool:
    """Whether the outward normal points to the axis, or the centre."""
    (u0, v0), (u1, v1) = gmsh.model.getParametrizationBounds(2, tag)
    at = [(u0 + u1) / 2, (v0 + v1) / 2]
    out = np.array(gmsh.model.getValue(2, tag, at)) - place
    out -= (out @ axis) * axis
    return bool(np.array(gmsh.model.getNormal(tag, at)) @ out < 0)


def picked(survey: dict[str, Any], pick: dict[str, Any], what: str) -> list[int]:
    """Tags of the faces of a pick.

    Raises
    ------
    InputError
        There are none, or it is ambiguous.
    """
    faces, size = survey["faces"], survey["size"]
    found = [face for face in faces if _meant(face, pick, size)]
    if set(pick) == {"point"}:
        near = {face["tag"]: _distance(face["tag"], pick["point"]) for face in faces}
        least = min(near.values())
        found = [face for face in faces if near[face["tag"]] <= least + _SAME * size]
        found = found[:1]
    if not found:
        raise InputError(
            f"{survey['name']}: there is no face for the {what}: {_nearest(faces, pick)}"
        )
    return [face["tag"] for face in found]


def _distance(tag: int, point: Sequence[float]) -> float:
    """Of a point from a face; its own middle counts where the projection is outside of it."""
    closest, at = gmsh.model.getClosestPoint(2, tag, list(point))
    if gmsh.model.isInside(2, tag, list(at), parametric=True):
        return math.dist(closest, point)
    edges = gmsh.model.getBoundary([(2, tag)], combined=False, oriented=False)
    return min(
        (math.dist(gmsh.model.getClosestPoint(1, t, list(point))[0], point) for _, t in edges),
        default=math.inf,
    )


def _meant(face: dict[str, Any], pick: dict[str, Any], size: float) -> bool:
    keys = set(pick)
    if "label" in keys or "colour" in keys:
        (key,) = keys
        return bool(face[key].lower() == pick[key].lower())
    if keys == {"point", "normal"}:
        if face["kind"] != "Plane":
            return False
        normal = np.array(pick["normal"]) / np.linalg.norm(pick["normal"])
        own = np.array(face["normal"])
        away = (np.array(face["middle"]) - pick["point"]) @ normal
        return bool(np.linalg.norm(np.cross(own, normal)) < 1e-4 and abs(away) < 1e-5 * size)
    if "radius" in keys:
        kind = "Sphere" if "centre" in keys else "Cylinder"
        if face["kind"] != kind and not (keys == {"radius"} and face["kind"] == "Sphere"):
            return False
        if not face["hole"] or abs(face["radius"] - pick["radius"]) > 1e-4 * pick["radius"]:
            return False
        if "centre" in keys:
            return bool(math.dist(face["centre"], pick["centre"]) < 1e-4 * pick["radius"])
        axis = np.array(face.get("axis", (0, 0, 0)))
        if "axis" in keys:
            way = np.array(pick["axis"]) / np.linalg.norm(pick["axis"])
            if np.linalg.norm(np.cross(axis, way)) > 1e-4:
                return False
        if "point" in keys:
            off = np.array(pick["point"]) - face["centre"]
            return bool(np.linalg.norm(off - (off @ axis) * axis) < 1e-3 * pick["radius"])
        return True
    return False


def _nearest(faces: Sequence[dict[str, Any]], pick: dict[str, Any]) -> str:
    """What there is instead, in words."""
    given = " and ".join(f"{key} {value}" for key, value in pick.items())
    if "radius" in pick:
        radii = sorted({round(f["radius"], 4) for f in faces if f.get("hole")})
        there = ", ".join(f"{r:g}" for r in radii[:20]) or "none"
        return f"no bore has {given}; radii of bores are {there} mm: use one of these"
    if "label" in pick or "colour" in pick:
        (key,) = pick
        there = ", ".join(sorted({f[key] for f in faces if f[key]})[:20]) or "none"
        return f"no face has {given}; there are {there}: use one of these, or pick by a point"
    return f"no face lies at {given}: see the list that fe-drivetrain part prints"


def seat_cylinders(survey: dict[str, Any]) -> list[dict[str, Any]]:
    """Bores, faces on one surface taken together, the widest first."""
    found: list[dict[str, Any]] = []
    size = survey["size"]
    holes = [face for face in survey["faces"] if face.get("hole")]
    # along one line, in order
    for face in sorted(holes, key=lambda f: [round(x / size, 7) for x in f["centre"]]):
        axis, centre = np.array(face.get("axis", (0.0,) * 3)), np.array(face["centre"])
        half = face.get("length", 2 * face["radius"]) / 2
        for seat in found:
            off = centre - seat["place"]
            along = off @ seat["axis"]
            same = (
                seat["kind"] == face["kind"]
                and abs(seat["radius"] - face["radius"]) < _SAME * size
                and np.linalg.norm(np.cross(axis, seat["axis"])) < _ALIGNED
                and np.linalg.norm(off - along * seat["axis"]) < _SAME * size
            )
            ends = (min(seat["ends"][0], along - half), max(seat["ends"][1], along + half))
            # bores of the same line with a gap between them are two seats
            if (
                same
                and ends[1] - ends[0] <= seat["ends"][1] - seat["ends"][0] + 2 * half + _SAME * size
            ):
                seat["ends"], seat["tags"] = ends, [*seat["tags"], face["tag"]]
                seat["label"] = seat["label"] or face["label"]
                seat["colour"] = seat["colour"] or face["colour"]
                break
        else:
            keys = ("kind", "radius", "label", "colour")
            found.append(
                {key: face[key] for key in keys}
                | {"axis": axis, "place": centre, "ends": (-half, half), "tags": [face["tag"]]}
            )
    return [
        {
            "kind": seat["kind"],
            "radius": seat["radius"],
            "label": seat["label"],
            "colour": seat["colour"],
            "axis": seat["axis"].tolist(),
            "length": seat["ends"][1] - seat["ends"][0],
            "centre": (seat["place"] + seat["axis"] * sum(seat["ends"]) / 2).tolist(),
            "tags": seat["tags"],
        }
        for seat in sorted(found, key=lambda s: -s["radius"])
    ]


def where(message: str) -> str:
    """Places of surfaces that a message of gmsh names, and of those that it could not mesh."""
    tags = [int(n) for n in re.findall(r"[Ss]urface (\d+)", message)]
    with suppress(Exception):
        tags += [tag for dim, tag in gmsh.model.mesh.getLastEntityError() if dim == 2]
    places = []
    for tag in dict.fromkeys(tags):
        try:
            x, y, z = gmsh.model.occ.getCenterOfMass(2, tag)
            kind = gmsh.model.getType(2, tag).lower()
        except Exception:
            continue
        places.append(f"face {tag}, a {kind}, round ({x:.4g}, {y:.4g}, {z:.4g}) mm")
    return f"; {', '.join(places[:3])}" if places else ""


def cut(survey: dict[str, Any], request: dict[str, Any]) -> dict[str, list[int]]:
    """Divide the faces of the solid at the sides of the bearing and round the bolts.

    Parameters
    ----------
    survey : dict
        Of `opened`.
    request : dict
        "seat", "held" and "bolts" as in the scene, "low" and "high", distances of the bearing's
        sides from the seat's middle along "along", the direction of x [mm].

    Returns
    -------
    dict
        Tags of the faces "bore", "seat" and "base", and of "head 1", "head 2", ... .
    """
    occ, name = gmsh.model.occ, survey["name"]
    ((_, volume),) = gmsh.model.getEntities(3)
    seat_tags = picked(survey, request["seat"], "seat")
    (seat, *others) = [s for s in seat_cylinders(survey) if set(s["tags"]) & set(seat_tags)] or [{}]
    if not seat or others:
        raise InputError(
            f"{name}: the seat must be one bore, a cylinder or a sphere, but {len(others) + 1} "
            "are picked: give its axis and a point on that"
            if seat
            else f"{name}: the seat must be a bore, a cylinder or a sphere: pick another face"
        )
    base_tags = list(
        dict.fromkeys(t for pick in request["held"] for t in picked(survey, pick, "held face"))
    )
    if set(base_tags) & set(seat["tags"]):
        raise InputError(f"{name}: a face of the seat is held, too: hold another face")
    holes = bolt_holes(survey, request, base_tags) if request.get("bolts") else []

    along, centre, radius = np.array(request["along"]), np.array(seat["centre"]), seat["radius"]
    if request["centre"] is not None:  # of the bearing
        centre = np.array(request["centre"])
    _check_seat(name, seat, request, along, centre)
    low, high = request["low"], request["high"]
    start = centre + low * along
    reach = 1.1 * radius if seat["kind"] == "Sphere" else radius
    slab = occ.addCylinder(*start, *((high - low) * along), reach)
    if seat["kind"] == "Sphere":
        ((_, slab),), _ = occ.intersect([(3, occ.addSphere(*seat["centre"], radius))], [(3, slab)])
    rings, groups = [], []
    for hole in holes:
        for which in ("foot", "head") if request["bolts"]["hold"] == "beams" else ("foot",):
            ring = _annulus(hole[which], hole["axis"], request["bolts"])
            rings.append(ring)
            groups.append(f"{which} {hole['number']}")
    objects = [(2, t) for t in seat["tags"]] + [(2, t) for t in base_tags]
    heads = [hole["head face"] for hole in holes if request["bolts"]["hold"] == "beams"]
    objects += [(2, t) for t in dict.fromkeys(heads)]
    mass = occ.getMass(3, volume)
    _, pieces = occ.fragment([(3, volume)], [(3, slab), *((2, r) for r in rings), *objects])
    occ.synchronize()
    bodies = [t for d, t in pieces[0] if d == 3]
    if len(bodies) != 1 or abs(occ.getMass(3, bodies[0]) / mass - 1) > VOLUME_TOLERANCE:
        raise InputError(
            f"{name}: the solid does not stay whole where the bearing's sides cut its seat: the "
            f"bearing overlaps it there, or the seat of radius {radius:.6g} mm is not round"
        )
    body = bodies[0]
    surface = {t for _, t in gmsh.model.getBoundary([(3, body)], combined=False, oriented=False)}
    n = len(seat["tags"])
    at = 2 + len(rings)
    faces_of = {face["tag"]: face for face in survey["faces"]}

    def became(tag: int, piece: Any) -> set[int]:
        # what stays whole is in no history: it has its area and its middle still
        if piece:
            return {t for d, t in piece if d == 2} & surface
        old = faces_of[tag]
        return {
            t
            for t in surface
            if abs(occ.getMass(2, t) / old["area"] - 1) < 1e-6
            and math.dist(occ.getCenterOfMass(2, t), old["middle"]) < _SAME * survey["size"]
        }

    after = pieces[at:]
    on_seat = set().union(*map(became, seat["tags"], after[:n]))
    on_base = set().union(*map(became, base_tags, after[n : n + len(base_tags)]))
    on_ring = [{t for d, t in piece if d == 2} & surface for piece in pieces[2:at]]
    faces: dict[str, list[int]] = {"seat": sorted(on_seat)}
    bore = []
    for t in on_seat:
        x = (np.array(occ.getCenterOfMass(2, t)) - centre) @ along
        if low < x < high:
            bore.append(t)
    faces["bore"] = sorted(bore)
    if request.get("bolts"):
        feet = [r for r, g in zip(on_ring, groups, strict=True) if g.startswith("foot")]
        on_base &= set().union(*feet)
        for under, group in zip(on_ring, groups, strict=True):
            if request["bolts"]["hold"] == "beams":
                faces[group] = sorted(under)
    faces["base"] = sorted(on_base)
    for key, tags in faces.items():
        if not tags:
            raise InputError(
                f"{name}: nothing is left of the {key} where it is cut at the bearing's sides and "
                "round the bolts: check the washers' diameter and the placement"
            )
    width, length = high - low, _length(faces["bore"], along)
    if length < width * (1 - 1e-4):
        raise InputError(
            f"{name}: its seat covers {length:.6g} mm of the bearing's width of {width:.6g} mm, "
            "but must cover all of it: move the part, or make the bearing narrower"
        )
    for d, t in gmsh.model.getEntities(3):
        if t != body:
            gmsh.model.removeEntities([(d, t)])
    gmsh.model.addPhysicalGroup(3, [body], name="body")
    for key, tags in faces.items():
        gmsh.model.addPhysicalGroup(2, tags, name=f"body.{key}")
    return faces


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
    """Of faces along a direction, from points on their edges."""
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
                and _distance(f["tag"], head.tolist()) < 1.01 * seat["radius"]
            ]
            if bolts["hold"] == "beams" and not tops:
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


def _annulus(place: Sequence[float], axis: Sequence[float], bolts: dict[str, Any]) -> int:
    occ = gmsh.model.occ
    outer, inner = bolts["washer_diameter"] / 2, bolts["hole_radius"]
    ring, _ = occ.cut(
        [(2, occ.addDisk(*place, outer, outer, zAxis=list(axis)))],
        [(2, occ.addDisk(*place, inner, inner, zAxis=list(axis)))],
    )
    ((_, tag),) = ring
    return int(tag)


def mesh(survey: dict[str, Any], size: float, per_turn: int) -> None:
    """Mesh the one solid with curved second-order tetrahedra of a size [mm]."""
    name = survey["name"]
    elements = 6 * math.sqrt(2) * survey["after"]["volume"] / size**3
    if elements > LARGEST_MESH:
        raise InputError(
            f"{name}: elements of {size:g} mm make about {elements:.1g}, but must make at most "
            f"{LARGEST_MESH:.0g}: choose {size * (elements / LARGEST_MESH) ** (1 / 3):.2g} mm or "
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
    try:
        for dim in (1, 2, 3):
            gmsh.model.mesh.generate(dim)
            if dim == 2 and (n := _count(2)) > LARGEST_MESH:
                raise InputError(
                    f"{name}: {n} triangles are on its faces, but at most {LARGEST_MESH:.0g} may "
                    "be: leave out small fillets, threads and lettering"
                )
        gmsh.model.mesh.setOrder(2)
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
