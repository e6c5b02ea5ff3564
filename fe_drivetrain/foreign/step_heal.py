"""Healing of a STEP file's solids in the open gmsh model, in mm: only where needed.

Healing can lose a sound solid: sewing takes a torus, one face without an edge, for no shell. So a
file is taken as it is where its shells are closed and gmsh meshes their faces; else the steps of
healing are tried from the smallest to the largest, each from the file as it was read.

This runs in a process of its own, see `reading`; it imports little else than gmsh and numpy.
"""

from __future__ import annotations

import math
import re
from collections import Counter
from collections.abc import Callable, Collection, Mapping
from contextlib import suppress
from typing import Any, NamedTuple

import gmsh

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.foreign.step_fit import area_and_middle
from fe_drivetrain.foreign.telling import tell

VOLUME_TOLERANCE = 1e-4
"""Relative change of a volume by healing that is refused."""

_SAME = 1e-6  # of a solid's size: edges and gaps that are nothing
_COARSE, _FINE, _PER_TURN = 25, 500, 16  # of its size, and elements of a turn: to see if it meshes
_FINER = 2.5
_TIMES = 3  # that faces which gmsh names get smaller elements
_MANY = 50_000  # triangles of a coarse mesh: a finer one, or many of them, take minutes
_DELAUNAY, _HXT = 1, 10  # gmsh's numbers: HXT is ten times as fast, Delaunay says what is wrong


class Step(NamedTuple):
    """One step of healing.

    Attributes
    ----------
    words : str
        Sentence that says what was done, for users.
    flags : tuple[bool, bool, bool, bool, bool]
        Degenerated edges, small edges and small faces repaired; faces sewn, solids made of shells.
    """

    words: str
    flags: tuple[bool, bool, bool, bool, bool]


_STEPS = (
    Step("degenerated edges were repaired", (True, False, False, False, False)),
    Step("degenerated and small edges were repaired", (True, True, False, False, False)),
    Step("small edges and faces were repaired", (True, True, True, False, False)),
    Step("faces were sewn to solids", (True, False, False, True, True)),
    Step("small edges and faces were repaired, and faces sewn to solids", (True,) * 5),
)
_REMOVING = [step for step in _STEPS if step.flags[2]]  # where small details are to be removed


class Healed(NamedTuple):
    """Contents of the model after healing, and the step that it took.

    Attributes
    ----------
    after : dict[str, Any]
        Counts after healing, from `counted`.
    words : str
        Sentence that says what was done.
    step : int or None
        Place of the step of healing among those tried; None where there was none.
    """

    after: dict[str, Any]
    words: str
    step: int | None


def counted() -> dict[str, Any]:
    """Number of solids, faces and edges, volume [mm^3] and area [mm^2]."""
    there = gmsh.model.getEntities(3)
    return {
        "solids": len(there),
        "words": f"{len(there)} solid{'s' if len(there) != 1 else ''}",
        "faces": len(gmsh.model.getEntities(2)),
        "edges": len(gmsh.model.getEntities(1)),
        "volume": math.fsum(gmsh.model.occ.getMass(3, t) for _, t in there),
        "area": math.fsum(area_and_middle(t)[0] for _, t in gmsh.model.getEntities(2)),
    }


def size_of_all() -> float:
    """Diagonal of the box round all that is there [mm]."""
    box = [float(x) for x in gmsh.model.getBoundingBox(-1, -1)]
    return math.dist(box[:3], box[3:])


def fault() -> str:
    """Sentence on what is wrong with the solids; "" where they are sound.

    They are where each encloses a volume, no edge of its shells ends in free air, and gmsh can
    mesh their faces.
    """
    for _, tag in gmsh.model.getEntities(3):
        if not gmsh.model.occ.getMass(3, tag) > 0:
            return "a solid is inside out, or encloses nothing"
        if words := free_edges([f for _, f in gmsh.model.getBoundary([(3, tag)], False, False)]):
            return words
    return _unmeshed()


def free_edges(faces: list[int]) -> str:
    """Sentence on where the shells of faces are open; "" where they are closed.

    Parameters
    ----------
    faces : list of int
        Tags of the faces; each edge must bound an even number of them, a seam the same face twice.
    """
    count = Counter(
        edge
        for face in faces
        for _, edge in gmsh.model.getBoundary([(2, face)], combined=False, oriented=False)
        if gmsh.model.getType(1, edge) != "Unknown"  # the pole of a sphere
    )
    free = [edge for edge, times in count.items() if times % 2]
    if not free:
        return ""
    x, y, z = gmsh.model.occ.getCenterOfMass(1, free[0])
    at = f"({x:.4g}, {y:.4g}, {z:.4g}) mm"
    return f"{len(free)} edges belong to one face alone, the first round {at}"


def surface_mesh(finer: float = 1.0) -> None:
    """Mesh all faces coarsely, for a picture or to see whether gmsh can, if they are not meshed.

    Parameters
    ----------
    finer : float
        Factor by which elements are smaller.
    """
    if any(map(len, gmsh.model.mesh.getElements(2)[1])):
        return
    size = size_of_all() / finer
    gmsh.option.setNumber("Mesh.MeshSizeMax", size / _COARSE)
    gmsh.option.setNumber("Mesh.MeshSizeMin", size / _FINE)
    gmsh.option.setNumber("Mesh.MeshSizeFromCurvature", _PER_TURN * finer)
    gmsh.model.mesh.generate(2)


def _unmeshed() -> str:
    """Why gmsh cannot mesh the solids.

    Chords of coarse elements may cross: faces that gmsh names get smaller ones, and last all do.
    """
    # after an error that is raised, gmsh meshes nothing any more, and says nothing
    raised = gmsh.option.getNumber("General.AbortOnError")
    gmsh.option.setNumber("General.AbortOnError", 1)
    refined: set[int] = set()
    try:
        words = _unmeshed_at()
        for _ in range(_TIMES):
            new = set(_named(words)) - refined
            if not new:
                break
            refined |= new
            _refine(new)
            words = _unmeshed_at()
        if words and not _many():
            gmsh.model.mesh.removeConstraints()
            words = _unmeshed_at(_FINER)
    finally:
        gmsh.model.mesh.removeConstraints()
        gmsh.option.setNumber("General.AbortOnError", raised)
    return words


def _many() -> bool:
    """Whether the coarse mesh that is there has so many triangles that another takes long."""
    return sum(map(len, gmsh.model.mesh.getElements(2)[1])) > _MANY


def _refine(faces: Collection[int]) -> None:
    """Divide the edges of faces into more elements than the mesh that is there has."""
    edges = gmsh.model.getBoundary([(2, t) for t in faces], combined=False, oriented=False)
    for _, edge in dict.fromkeys(edges):
        _, elements, _ = gmsh.model.mesh.getElements(1, edge)
        if number := sum(map(len, elements)):
            gmsh.model.mesh.setTransfiniteCurve(edge, math.ceil(_FINER * number) + 1)


def _unmeshed_at(finer: float = 1.0) -> str:
    gmsh.model.mesh.clear()
    surface_mesh(finer)
    why = " ".join(gmsh.logger.getLastError().split())
    if not why:
        why = _unfilled(_HXT) and _unfilled(_DELAUNAY)
    gmsh.option.setNumber("Mesh.Algorithm3D", _DELAUNAY)
    return f"gmsh cannot mesh it ({why}{where(why)})" if why else ""


def _unfilled(mesher: int) -> str:
    """Why a mesher fills solids with no elements, in gmsh's words; nothing if it does."""
    gmsh.option.setNumber("Mesh.Algorithm3D", mesher)
    optimised = gmsh.option.getNumber("Mesh.Optimize")
    gmsh.option.setNumber("Mesh.Optimize", 0)  # takes six times as long as all else
    try:
        gmsh.model.mesh.generate(3)
    finally:
        gmsh.option.setNumber("Mesh.Optimize", optimised)
    why = " ".join(gmsh.logger.getLastError().split())
    _, made, _ = gmsh.model.mesh.getElements(3)
    gmsh.model.mesh.clear(gmsh.model.getEntities(3))
    return why or ("" if made else "it makes no elements")


def reason(error: Exception) -> str:
    """Reason of gmsh's failure, in one line."""
    found = str(gmsh.logger.getLastError() or error or "no reason given")
    return " ".join(found.split())[:200].rstrip(".")


def heal(
    name: str,
    before: dict[str, Any],
    read: Callable[[], None],
    smallest_detail: float,
    known: Mapping[str, Any] | None = None,
    sound: bool = False,
) -> Healed:
    """Leave sound solids in the model: as they are read, or with the minimum healing that they
    need.

    Parameters
    ----------
    name : str
        Name of the file, for messages.
    before : dict[str, Any]
        Counts from `counted`, of what is in the model now.
    read : callable
        Function that puts what is in the file into an empty model.
    smallest_detail : float
        Size below which edges and small faces are removed; none are if 0 [mm].
    known : Mapping[str, Any] or None
        Values "words" and "step" of `Healed`, as found before for the same file: it is not tried
        again.
    sound : bool
        Whether what is in the model is known to be sound.

    Returns
    -------
    Healed

    Raises
    ------
    InputError
        No step leaves as many solids of the same volume with closed shells.
    """
    steps = _REMOVING if smallest_detail > 0 else _STEPS
    if known:
        step = known["step"]
        after = before if step is None else _tried(read, steps[step], smallest_detail)
        return Healed(after, known["words"], step)
    tell(f"trying to mesh its {before['faces']:,} faces")
    wrong = "" if sound else fault()
    if not wrong and not smallest_detail > 0:
        return Healed(before, "not healed: its shells are closed, and gmsh meshes them", None)
    if "intersect" in wrong and _many():  # healing hardly ever removes it, and takes minutes here
        raise InputError(
            f"{name}: {wrong}, with smaller elements there, too: its faces cross, so repair it in "
            "the CAD program"
        )
    why = f"{wrong}; " if wrong else ""
    after, best = before, None
    for number, step in enumerate(steps):
        tell(f"healing {before['faces']:,} faces, way {number + 1} of {len(steps)}")
        after = _tried(read, step, smallest_detail)
        if not _as_before(before, after):
            continue
        best = number
        if not (left := fault()):
            return Healed(after, f"healed: {why}{step.words}", number)
    if best is None:
        raise InputError(
            f"{name} has {before['words']} of {before['volume']:.9g} mm^3 before and "
            f"{after['solids']} of {after['volume']:.9g} mm^3 after healing"
            f"{f' ({wrong})' if wrong else ''}, but must have as many "
            f"of the same volume, to {VOLUME_TOLERANCE:g}: repair its faces in the CAD program"
        )
    after = _tried(read, steps[best], smallest_detail)
    if left := free_edges([t for _, t in gmsh.model.getEntities(2)]):
        raise InputError(
            f"{name}: {left}, and healing does not close them: close the shell in the CAD program"
        )
    if "intersect" in (left := fault()):
        raise InputError(
            f"{name}: {left}, as it is and healed: its faces cross, so repair it in the CAD program"
        )
    # other elements than these coarse ones may do: what is wrong is said where it is meshed
    return Healed(after, f"healed, but not sound: {left}", best)


def _tried(read: Callable[[], None], step: Step, smallest_detail: float) -> dict[str, Any]:
    """Contents after one step, of the file as it was read."""
    gmsh.clear()
    read()
    return _after(step, smallest_detail)


def _after(step: Step, smallest_detail: float) -> dict[str, Any]:
    """Contents after one step, of what is in the model."""
    occ, there = gmsh.model.occ, gmsh.model.getEntities(3)
    edges, faces = step.flags[1:3]
    tolerance = smallest_detail or _SAME * size_of_all()
    # healed together, touching solids would be sewn into none
    each = [[one] for one in there] if len(there) > 1 else [[]]
    try:
        for one in each:
            occ.healShapes(one, tolerance, step.flags[0], edges, faces, *step.flags[3:])
        occ.synchronize()
    except Exception as error:
        if type(error) is not Exception:  # gmsh reports its own failures as bare ones
            raise
        gmsh.clear()
    return counted()


def _as_before(before: dict[str, Any], after: dict[str, Any]) -> bool:
    """Whether there are as many solids of the same volume."""
    change = abs(after["volume"] - before["volume"]) / max(abs(before["volume"]), 1e-300)
    return bool(
        after["solids"] == before["solids"] and change <= VOLUME_TOLERANCE and after["volume"] > 0
    )


def sewn(read: Callable[[], None], sound: bool) -> str:
    """Make solids of faces that enclose some but are not sewn together; what was done, or "".

    The solids must have all of the faces' area, since there is no volume to compare with.

    Parameters
    ----------
    read : callable
        Function that puts what is in the file, and is in the model, into an empty one.
    sound : bool
        Whether the solids are known to be sound; else that is found out.
    """
    before = counted()
    tell(f"sewing {before['faces']:,} loose faces")
    after = _after(_STEPS[3], 0.0)
    same = abs(after["area"] / before["area"] - 1) <= VOLUME_TOLERANCE
    if after["solids"] and same and (sound or not fault()):
        return f"healed: {before['faces']} loose faces were sewn to {after['words']}"
    gmsh.clear()
    read()
    return ""


def where(message: str) -> str:
    """Places of surfaces that a message of gmsh names, and of those that it could not mesh."""
    places = []
    for tag in _named(message):
        try:
            x, y, z = gmsh.model.occ.getCenterOfMass(2, tag)
            kind = gmsh.model.getType(2, tag).lower()
        except Exception:
            continue
        places.append(f"face {tag}, a {kind}, round ({x:.4g}, {y:.4g}, {z:.4g}) mm")
    return f"; {', '.join(places[:3])}" if places else ""


def _named(message: str) -> list[int]:
    """Tags of surfaces that a message of gmsh names, and of those that it could not mesh."""
    tags = [int(n) for n in re.findall(r"(?:[Ss]urface|face) (\d+)", message)]
    with suppress(Exception):
        tags += [tag for dim, tag in gmsh.model.mesh.getLastEntityError() if dim == 2]
    return list(dict.fromkeys(tags))
