"""Questions to the open gmsh model about faces: where they lie, and which parts share them."""

import math
from collections.abc import Mapping

import gmsh

from fe_drivetrain.common.errors import InputError

CAD_TOLERANCE = 1e-6
"""Two positions of CAD entities closer than this (m) are the same; bounding boxes err by 1e-7."""


def boundary(entities: list[tuple[int, int]]) -> set[int]:
    """Tags of what bounds entities of gmsh, given as dimension and tag; each once."""
    return {tag for _, tag in gmsh.model.getBoundary(entities, combined=False, oriented=False)}


def shared(faces: Mapping[str, set[int]], first: str, second: str) -> set[int]:
    """Faces that two parts have in common.

    Raises
    ------
    InputError
        They do not touch.
    """
    tags = faces[first] & faces[second]
    if not tags:
        raise InputError(
            f"parts {first!r} and {second!r} do not touch, but must share a face: check their "
            "diameters and positions"
        )
    return tags


def in_plane(faces: set[int], axis: int, at: float) -> set[int]:
    """Faces that lie in the plane where coordinate `axis` is `at`."""
    found = set()
    for tag in faces:
        box = gmsh.model.getBoundingBox(2, tag)
        if abs(box[axis] - at) < CAD_TOLERANCE and abs(box[axis + 3] - at) < CAD_TOLERANCE:
            found.add(tag)
    return found


def parameters(face: int) -> list[list[float]]:
    """Parameters (u, v) of the middle and the corners of a face's rectangle of parameters."""
    (u0, v0), (u1, v1) = gmsh.model.getParametrizationBounds(2, face)
    return [[(u0 + u1) / 2, (v0 + v1) / 2], [u0, v0], [u0, v1], [u1, v0], [u1, v1]]


def middle(tag: int) -> tuple[float, float, float]:
    """Point of the surface (untrimmed) of a face, in the middle of its parameters."""
    x, y, z = gmsh.model.getValue(2, tag, parameters(tag)[0])
    return x, y, z


def at_radius(faces: set[int], radius: float) -> set[int]:
    """Curved faces about the x axis whose middle lies at a radius."""
    found = set()
    for tag in faces:
        if gmsh.model.getType(2, tag) == "Plane":
            continue
        _, y, z = middle(tag)
        if abs(math.hypot(y, z) - radius) < CAD_TOLERANCE:
            found.add(tag)
    return found


def revolved_ranges(face: int) -> tuple[float, float, float, float] | None:
    """Ranges (x0, x1, r0, r1) of x and radius of a face that goes round the x axis, else None."""
    x0, y0, z0, x1, y1, z1 = gmsh.model.getBoundingBox(2, face)
    if abs(y0 + y1) > CAD_TOLERANCE or abs(z0 + z1) > CAD_TOLERANCE:
        return None
    if gmsh.model.getType(2, face) == "Plane":
        boxes = [gmsh.model.getBoundingBox(1, tag) for tag in boundary([(2, face)])]
        radii = [box[5] for box in boxes]
        return x0, x1, min(radii) if len(radii) > 1 else 0.0, max(radii)
    at = [gmsh.model.getValue(2, face, p) for p in parameters(face)]
    radii = [math.hypot(y, z) for _, y, z in at]
    return x0, x1, min(radii), max(radii)
