"""Joints between solids that bolts hold together: annuli round their holes, in mm.

This runs in a process of its own, see `reading`; it imports little else than gmsh and numpy.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import gmsh
import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.foreign.step_solid import SAME, distance, face_data
from fe_drivetrain.foreign.step_solids import common, loose_solids, solids

_ALONG = 1e-4  # sine of the angle between a hole and the normal of the joint


def annulus(place: Sequence[float], axis: Sequence[float], inner: float, outer: float) -> int:
    """Add a plane ring to the open model.

    Parameters
    ----------
    place, axis : Sequence[float]
        Middle and normal (3,) of the annulus.
    inner, outer : float
        Radii of the annulus.
    """
    occ = gmsh.model.occ
    ring, _ = occ.cut(
        [(2, occ.addDisk(*place, outer, outer, zAxis=list(axis)))],
        [(2, occ.addDisk(*place, inner, inner, zAxis=list(axis)))],
    )
    ((_, tag),) = ring
    return int(tag)


def rings_round_bolts(
    survey: dict[str, Any], bolted: dict[str, float], faces: Iterable[int], what: str
) -> list[int]:
    """Add a ring round each hole of the bolts' radius that ends on one of the faces.

    Parameters
    ----------
    survey : dict
        Survey from `fe_drivetrain.foreign.step_solid.opened`.
    bolted : dict
        Sizes "hole_radius" and "pressed_diameter" [mm].
    faces : Iterable[int]
        Tags of faces of the joint; holes end on planes.
    what : str
        Name of the joint, for messages.

    Raises
    ------
    InputError
        There is no such hole.
    """
    radius, near = bolted["hole_radius"], SAME * survey["size"]
    planes = [f for f in map(face_data, faces) if f["kind"] == "Plane"]
    found: list[Any] = []
    rings = []
    for hole in survey["faces"]:
        if not hole.get("hole") or abs(hole["radius"] - radius) > 1e-3 * radius:
            continue
        axis, half = np.array(hole.get("axis", (0, 0, 0))), hole.get("length", 0) / 2
        for end in (np.array(hole["centre"]) + side * half * axis for side in (-1, 1)):
            if any(math.dist(end, other) < 10 * near for other in found):
                continue
            for plane in planes:
                normal = np.array(plane["normal"])
                if (
                    np.linalg.norm(np.cross(normal, axis)) < _ALONG
                    and abs((end - plane["middle"]) @ normal) < 10 * near
                    and distance(plane["tag"], end.tolist()) < 1.01 * radius
                ):
                    found.append(end)
                    outer = bolted["pressed_diameter"] / 2
                    rings.append(annulus(end.tolist(), normal.tolist(), radius, outer))
                    break
    if not rings:
        raise InputError(
            f"{survey['name']}: no hole of radius {radius:g} mm ends on {what}: check hole_radius "
            "of bolted, or leave bolted out"
        )
    return rings


def drop_loose_faces() -> None:
    """Take what is left of rings beside the solids out of the model, so that it is not meshed."""
    bounds = gmsh.model.getBoundary(gmsh.model.getEntities(3), combined=False, oriented=False)
    used = {tag for _, tag in bounds}
    loose = [(2, t) for _, t in gmsh.model.getEntities(2) if t not in used]
    gmsh.model.removeEntities(loose, recursive=True)


def open_joint(name: str, pressed: set[int]) -> dict[str, list[int]]:
    """Faces between the solids of the model that stay joined, "pressed", and the "open" others.

    Parameters
    ----------
    name : str
        Name of the file, for messages.
    pressed : set of int
        Tags of faces round the bolts; those that solids have in common count.

    Raises
    ------
    InputError
        A solid is held by no bolt.
    """
    between = set(common())
    kept = between & pressed
    if loose := loose_solids(kept):
        there = solids()
        centre = next(s["centre"] for s in there if s["tag"] == loose[0])
        x, y, z = (round(value, 6) + 0.0 for value in centre)
        raise InputError(
            f"{name}: the solid round ({x:.4g}, {y:.4g}, {z:.4g}) mm is joined to the others by no "
            "bolt: give it holes of the same radius, or leave bolted out"
        )
    return {"pressed": sorted(kept), "open": sorted(between - kept)}
