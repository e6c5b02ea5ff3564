"""Several solids of a STEP file in the open gmsh model: named, and glued where they touch, in mm.

This runs in a process of its own, see `reading`; it imports little else than gmsh and numpy.
"""

from __future__ import annotations

import math
from collections import Counter
from typing import Any

import gmsh

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.foreign.step_fit import area_and_middle

MAX_SOLIDS = 100
"""Maximum number of solids of a file."""

_TOUCH = 1e-6  # of the size: faces of two solids that are closer are one
_SAME = 1e-5  # of area and of size: faces that are the same


def solids() -> list[dict[str, Any]]:
    """Name, tag, volume and centre of each solid, in the file's order."""
    found = []
    for number, (_, tag) in enumerate(gmsh.model.getEntities(3), 1):
        name = gmsh.model.getEntityName(3, tag).rpartition("/")[2].strip()
        found.append(
            {
                "tag": tag,
                "name": name or f"solid {number}",
                "volume": float(gmsh.model.occ.getMass(3, tag)),
                "centre": [float(x) for x in gmsh.model.occ.getCenterOfMass(3, tag)],
            }
        )
    return found


def keep(file: str, name: str) -> None:
    """Leave one solid in the model, by its name, or as "solid K" in the file's order.

    Raises
    ------
    InputError
        No solid, or several, have that name.
    """
    there = solids()
    wanted = [
        s for k, s in enumerate(there, 1) if name.lower() in (s["name"].lower(), f"solid {k}")
    ]
    if len(wanted) != 1:
        listed = ", ".join(f"solid {k} ({s['name']!r})" for k, s in enumerate(there[:20], 1))
        raise InputError(
            f"{file}: {len(wanted)} solids are named {name!r} but one must be: use one of {listed}"
        )
    others = [(3, s["tag"]) for s in there if s is not wanted[0]]
    gmsh.model.occ.remove(others, recursive=True)
    gmsh.model.occ.synchronize()


def glue(file: str, size: float, looks: dict[int, str]) -> dict[int, str]:
    """Make the faces in which solids touch common faces, so that their meshes share nodes there.

    Parameters
    ----------
    file : str
        Name of the file, for messages.
    size : float
        Size of all solids together [mm].
    looks : dict
        Colours of faces by tag.

    Returns
    -------
    dict
        Colours of the faces that are left, by their new tags.

    Raises
    ------
    InputError
        Two solids overlap, or one touches no other in a face.
    """
    occ, before = gmsh.model.occ, solids()
    faces = gmsh.model.getEntities(2)
    whole = all_placed()
    gmsh.option.setNumber("Geometry.ToleranceBoolean", _TOUCH * size)
    _, history = occ.fragment([(3, s["tag"]) for s in before], faces)
    gmsh.option.setNumber("Geometry.ToleranceBoolean", 0.0)
    occ.synchronize()
    pieces = [{t for d, t in piece if d == 3} for piece in history[: len(before)]]
    _refuse_overlaps(file, before, pieces)
    _refuse_loose(file, before, [next(iter(piece)) for piece in pieces])
    found: dict[int, str] = {}
    now = all_placed()
    for (_, old), piece in zip(faces, history[len(before) :], strict=True):
        found |= dict.fromkeys(became(whole[old], piece, size, now), looks.get(old, ""))
    return found


Place = tuple[float, tuple[float, float, float]]


def placed(face: int) -> Place:
    """Area and middle of a face [mm^2, mm]."""
    area, middle = area_and_middle(face)
    x, y, z = middle.tolist()
    return area, (x, y, z)


def all_placed() -> dict[int, Place]:
    """Area and middle of each face by its tag; taken once, since splines are integrated."""
    return {tag: placed(tag) for _, tag in gmsh.model.getEntities(2)}


def became(
    old: Place, piece: list[tuple[int, int]], size: float, now: dict[int, Place]
) -> set[int]:
    """Tags of the faces that a face became where all was cut by one another.

    Parameters
    ----------
    old : Place
        Place of the face before, see `placed`.
    piece : list of tuple of int
        History of the face from gmsh. Of a face that stays whole that may be its old tag, which
        another face has now; so faces count only where they have its area and its middle.
    size : float
        Size of all solids together [mm].
    now : dict of int to Place
        All faces that there are, see `all_placed`.
    """
    tags = {t for d, t in piece if d == 2}
    if tags and _same(old, [now[t] for t in tags], size):
        return tags
    return {t for t, place in now.items() if _same(old, [place], size)}


def _same(old: Place, new: list[Place], size: float) -> bool:
    area, middle = old
    total = math.fsum(a for a, _ in new)
    if abs(total / area - 1) > _SAME:
        return False
    mean = [math.fsum(a * m[k] for a, m in new) / total for k in range(3)]
    return math.dist(mean, middle) < _SAME * size


def outside() -> list[int]:
    """Tags of the faces of one solid alone, ascending."""
    count = Counter(t for faces in _boundaries().values() for t in faces)
    return sorted(t for t, n in count.items() if n == 1)


def common() -> list[int]:
    """Tags of the faces that two solids have in common, ascending."""
    count = Counter(t for faces in _boundaries().values() for t in faces)
    return sorted(t for t, n in count.items() if n > 1)


def loose_solids(joined: set[int]) -> list[int]:
    """Tags of the solids that are not joined to the first one, or if that is loose, the others.

    Parameters
    ----------
    joined : set of int
        Tags of faces in which solids are joined.
    """
    bounds = {tag: faces & joined for tag, faces in _boundaries().items()}
    together = {next(iter(bounds))}
    while more := {
        t for t in bounds if t not in together and any(bounds[t] & bounds[o] for o in together)
    }:
        together |= more
    loose = [t for t in bounds if t not in together]
    return loose if 2 * len(loose) <= len(bounds) else [t for t in bounds if t in together]


def _boundaries() -> dict[int, set[int]]:
    return {
        tag: {t for _, t in gmsh.model.getBoundary([(3, tag)], combined=False, oriented=False)}
        for _, tag in gmsh.model.getEntities(3)
    }


def _refuse_overlaps(file: str, solids: list[dict[str, Any]], pieces: list[set[int]]) -> None:
    owners = Counter(t for piece in pieces for t in piece)
    shared = [t for t, n in owners.items() if n > 1]
    if shared:
        one, two, *_ = (
            s["name"] for s, piece in zip(solids, pieces, strict=True) if shared[0] in piece
        )
        volume = gmsh.model.occ.getMass(3, shared[0])
        raise InputError(
            f"{file}: solids {one!r} and {two!r} overlap in {volume:.4g} mm^3 round "
            f"{_xyz(gmsh.model.occ.getCenterOfMass(3, shared[0]))} mm, but may touch alone: cut "
            "one by the other in the CAD program"
        )


def _refuse_loose(file: str, solids: list[dict[str, Any]], tags: list[int]) -> None:
    apart = loose_solids(set(common()))
    loose = [s for s, t in zip(solids, tags, strict=True) if t in apart]
    if loose:
        first = loose[0]
        others = f" (and {len(loose) - 1} more)" if len(loose) > 1 else ""
        raise InputError(
            f"{file}: solid {first['name']!r} of {first['volume']:.6g} mm^3 round "
            f"{_xyz(first['centre'])} mm{others} touches none of the others in a face, but all "
            "must hang together: move it in the CAD program, choose one solid by 'part', or put it "
            "under 'parts'"
        )


def _xyz(place: Any) -> str:
    return "({:.4g}, {:.4g}, {:.4g})".format(*place)
