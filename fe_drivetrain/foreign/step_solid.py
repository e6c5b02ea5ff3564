"""Solids of a STEP, IGES or BREP file in the open gmsh model, in mm: healed, glued and described.

This runs in a process of its own, see `reading`; it imports little else than gmsh and numpy.
"""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import gmsh
import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.foreign.brep_text import in_time, refuse_cut_off
from fe_drivetrain.foreign.face_messages import nearly
from fe_drivetrain.foreign.iges_lines import refuse_damaged
from fe_drivetrain.foreign.step_fit import area_and_middle, on_edges, recognised
from fe_drivetrain.foreign.step_heal import counted, free_edges, heal, reason, sewn
from fe_drivetrain.foreign.step_solids import MAX_SOLIDS, glue, keep, outside, solids
from fe_drivetrain.foreign.step_text import refuse_damaged_step
from fe_drivetrain.foreign.telling import tell

_MAX_FACES = 20_000
_MIN_VOLUME = 1e-9  # of the cube of its size
_TORN = 0.01  # of its radius: edges that are farther from a cylinder or sphere are not its own
_ALIGNED = 1e-6  # sine of the angle between directions that are the same
_FORMATS = {".igs": "IGES", ".iges": "IGES", ".brep": "BREP"}
_CHECKS = {"IGES": refuse_damaged, "BREP": refuse_cut_off, "STEP": refuse_damaged_step}
SAME = 1e-6  # of a solid's size: places that are the same
_SURFACES = {  # as STEP and gmsh call them
    "PLANE": "Plane",
    "CYLINDRICAL_SURFACE": "Cylinder",
    "CONICAL_SURFACE": "Cone",
    "SPHERICAL_SURFACE": "Sphere",
    "TOROIDAL_SURFACE": "Torus",
}


def opened(
    path: str,
    smallest_detail: float = 0.0,
    part: str | None = None,
    known: Mapping[str, Any] | None = None,
) -> dict[str, Any]:
    """Import and heal the solids of a STEP file, or one of them; returns its survey, for `Survey`.

    Several solids are glued: they share the faces in which they touch.

    Parameters
    ----------
    path : str
        Path of the file.
    smallest_detail : float
        Size below which details are removed, see `heal` [mm].
    part : str or None
        Name of the solid that is wanted alone.
    known : Mapping[str, Any] or None
        Value "healed" of an earlier result for the same file, detail and part.
    """
    try:
        return _opened(path, smallest_detail, part, known)
    except Exception as error:
        if type(error) is not Exception:  # gmsh reports its own failures as bare ones
            raise
        raise _unread(path, error) from None


def _opened(
    path: str, smallest_detail: float, part: str | None, known: Mapping[str, Any] | None
) -> dict[str, Any]:
    name = Path(path).name
    for option in ("FixDegenerated", "FixSmallEdges", "FixSmallFaces", "SewFaces", "MakeSolids"):
        gmsh.option.setNumber(f"Geometry.OCC{option}", 0)
    _refuse_damaged(path)
    gmsh.option.setNumber("Geometry.OCCAutoFix", 0)
    gmsh.option.setNumber("Geometry.OCCImportLabels", 1)
    tell(f"reading {Path(path).stat().st_size / 1e6:.1f} MB")
    _read(path)
    closed = _closed(path, sound=known is not None)
    if not 1 <= (n := len(gmsh.model.getEntities(3))) <= MAX_SOLIDS:
        raise InputError(
            f"{name} has {n} solids but must have 1 to {MAX_SOLIDS}: save the "
            "parts that carry, as solids, in a file of their own"
        )
    if part is not None:
        keep(name, part)
    _refuse_many_faces(name, len(gmsh.model.getEntities(2)))
    box, before = _box(), counted()
    _refuse_flat(name, box, before["volume"])
    colours = {t: _colour(t) for _, t in gmsh.model.getEntities(2)}
    labels = _labels(path)

    def again() -> None:
        _read(path)
        if closed:
            sewn(lambda: _read(path), sound=True)
        if part is not None:
            keep(name, part)

    after, words, step = heal(name, before, again, smallest_detail, known, bool(closed))
    kept = after["faces"] == before["faces"]
    if after["solids"] > 1:
        gmsh.model.mesh.clear()
        colours = glue(name, math.dist(_box()[:3], _box()[3:]), colours if kept else {})
    tell(f"looking for bores and planes in {after['faces']:,} faces")
    faces = _named_faces(labels, colours, kept)
    _refuse_torn(name, faces)
    return {
        "name": name,
        "before": before,
        "after": after,
        "healing": "; ".join(filter(None, (closed, words))),
        "healed": {"words": words, "step": step},
        "solids": solids(),
        "box": _box(),
        "faces": faces,
        "size": math.dist(_box()[:3], _box()[3:]),
    }


def _closed(path: str, sound: bool) -> str:
    """How faces without a solid were sewn to one; empty where there is a solid."""
    name, faces = Path(path).name, [t for _, t in gmsh.model.getEntities(2)]
    if not faces or gmsh.model.getEntities(3):
        return ""
    _refuse_many_faces(name, len(faces))
    if closed := sewn(lambda: _read(path), sound=sound):
        return closed
    open_at = free_edges(faces)
    raise InputError(
        f"{name} has {len(faces)} faces that enclose no solid"
        f"{f'; {open_at}' if open_at else ''}: close the shell in the CAD program, and "
        "save it as a solid"
    )


def _refuse_flat(name: str, box: Sequence[float], volume: float) -> None:
    """Refuse a solid that encloses next to nothing."""
    if abs(volume) < _MIN_VOLUME * math.dist(box[:3], box[3:]) ** 3:
        x, y, z = ((a + b) / 2 for a, b in zip(box[:3], box[3:], strict=True))
        raise InputError(
            f"{name}: its solid round ({x:.4g}, {y:.4g}, {z:.4g}) mm encloses "
            f"{volume:.3g} mm^3, next to nothing for its size: it is flat, or its faces "
            "cross; repair it in the CAD program"
        )


def _refuse_torn(name: str, faces: Sequence[dict[str, Any]]) -> None:
    """Refuse a cylinder or sphere whose edges lie elsewhere; a plane's middle is of its edges."""
    for face in faces:
        if face["kind"] not in ("Cylinder", "Sphere") or "described" in face:
            continue
        away = on_edges(face["tag"]) - face["centre"]
        if axis := face.get("axis"):
            away -= (away @ np.array(axis))[:, None] * axis
        off = np.abs(np.linalg.norm(away, axis=1) - face["radius"]).max(initial=0.0)
        if off > _TORN * face["radius"]:
            x, y, z = face["middle"]
            raise InputError(
                f"{name}: its {face['kind'].lower()} of radius {face['radius']:.6g} mm round "
                f"({x:.4g}, {y:.4g}, {z:.4g}) mm has edges {off:.3g} mm off it, but must have "
                f"them within {_TORN:g} of the radius: repair that face in the CAD program"
            )


def _named_faces(
    labels: Sequence[tuple[str, str]], colours: Mapping[int, str], kept: bool
) -> list[dict[str, Any]]:
    """Faces of the outside, with labels and colours where healing has kept them."""
    faces = [face_data(t) for t in outside()]
    same = (
        kept
        and len(labels) == len(faces)
        and all(
            _SURFACES.get(kind, f["kind"]) == f["kind"]
            for (_, kind), f in zip(labels, faces, strict=True)
        )
    )
    for number, face in enumerate(faces):
        face["colour"] = colours.get(face["tag"], "") if kept else ""
        face["label"] = labels[number][0] if same else ""
    return faces


def _read(path: str) -> None:
    """Put what is in the file into the open model."""
    limited = in_time(path) if Path(path).suffix.lower() in _FORMATS else nullcontext()
    try:
        with limited:
            gmsh.model.occ.importShapes(path)
    except Exception as error:
        raise _unread(path, error) from None
    gmsh.model.occ.synchronize()


def _unread(path: str, error: Exception) -> InputError:
    kind = _FORMATS.get(Path(path).suffix.lower(), "STEP")
    return InputError(
        f"{Path(path).name} cannot be read as {kind} ({reason(error)}): export it again, whole"
        f"{', as AP214 or AP242' * (kind == 'STEP')}"
    )


def _refuse_many_faces(name: str, faces: int) -> None:
    if faces > _MAX_FACES:
        raise InputError(
            f"{name} has {faces} faces but must have at most {_MAX_FACES}: leave out "
            "threads, lettering and other small details"
        )


def _refuse_damaged(path: str) -> None:
    """Refuse a file whose text is damaged: readers hang on it, or leave a part of it out."""
    _CHECKS[_FORMATS.get(Path(path).suffix.lower(), "STEP")](path)


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


def face_data(tag: int) -> dict[str, Any]:
    """Facts of a face: kind, area and middle, and what describes its surface."""
    kind = gmsh.model.getType(2, tag)
    area, middle = area_and_middle(tag)
    face: dict[str, Any] = {"tag": tag, "kind": kind, "area": area, "middle": middle.tolist()}
    face |= recognised(tag, kind)
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


def has_splines(survey: dict[str, Any]) -> bool:
    """Whether faces are described as splines, so that OpenCASCADE's volumes are inexact."""
    return any("described" in face for face in survey["faces"])


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
        near = {face["tag"]: distance(face["tag"], pick["point"]) for face in faces}
        least = min(near.values())
        found = [face for face in faces if near[face["tag"]] <= least + SAME * size]
        found = found[:1]
    if not found:
        raise InputError(
            f"{survey['name']}: there is no face for the {what}: {_nearest(faces, pick)}"
        )
    return [face["tag"] for face in found]


def distance(tag: int, point: Sequence[float]) -> float:
    """Distance of a point from a face, or from its middle where the projection is outside of it."""
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
    """Sentence on what there is instead."""
    given = " and ".join(f"{key} {value}" for key, value in pick.items())
    if "radius" in pick:
        radii = sorted({round(f["radius"], 4) for f in faces if f.get("hole")})
        others = [nearly(f) for f in faces if "nearly" in f]
        almost = f"; a face is {others[0]}" if others else ""
        if not radii:
            return (
                f"no bore has {given}, for there are no bores{almost}: give the part with its seat"
            )
        there = ", ".join(f"{r:g}" for r in radii[:20])
        return f"no bore has {given}{almost}; radii of bores are {there} mm: use one of these"
    if "label" in pick or "colour" in pick:
        (key,) = pick
        there = ", ".join(sorted({f[key] for f in faces if f[key]})[:20]) or "none"
        return f"no face has {given}; there are {there}: use one of these, or pick by a point"
    return f"no face lies at {given}: see the list that fe-drivetrain part prints"


def seat_cylinders(survey: dict[str, Any]) -> list[dict[str, Any]]:
    """Bores, faces on one surface taken together, the widest first."""
    found: list[dict[str, Any]] = []
    size = survey["size"]
    own = {face["tag"]: face for face in survey["faces"]}
    holes = [face for face in survey["faces"] if face.get("hole")]
    # along one line, in order
    for face in sorted(holes, key=lambda f: [round(x / size, 7) for x in f["centre"]]):
        axis, centre = np.array(face.get("axis", (0.0,) * 3)), np.array(face["centre"])
        apart = SAME * size + 4 * face.get("off", 0.0)  # of fits to pieces of one spline
        half = face.get("length", 2 * face["radius"]) / 2
        for seat in found:
            off = centre - seat["place"]
            along = off @ seat["axis"]
            same = (
                seat["kind"] == face["kind"]
                and abs(seat["radius"] - face["radius"]) < apart
                and np.linalg.norm(np.cross(axis, seat["axis"])) < _ALIGNED * apart / (SAME * size)
                and np.linalg.norm(off - along * seat["axis"]) < apart
            )
            ends = (min(seat["ends"][0], along - half), max(seat["ends"][1], along + half))
            # bores of the same line with a gap between them are two seats
            if (
                same
                and ends[1] - ends[0] <= seat["ends"][1] - seat["ends"][0] + 2 * half + SAME * size
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
            "off": max(own[t].get("off", 0.0) for t in seat["tags"]),
            "described": next(
                (own[t]["described"] for t in seat["tags"] if "described" in own[t]), ""
            ),
        }
        for seat in sorted(found, key=lambda s: -s["radius"])
    ]
