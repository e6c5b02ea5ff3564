"""Faces of a STEP file that are described as splines or swept curves: what they are, in mm.

CAD programs write planes and bores as B-splines when a part was scaled, bent or converted. Points
of such a face lie on the plane, the cylinder or the sphere that it is, or it is none.

This runs in a process of its own, see `reading`; it imports little else than gmsh and numpy.
"""

from __future__ import annotations

import math
from typing import Any

import gmsh
import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.foreign.face_messages import ROUND
from fe_drivetrain.foreign.fitting import Fit, fitted_cylinder, fitted_plane, fitted_sphere

_SAME = 1e-6  # of a solid's size: places that are the same
_FLAT = 1e-6  # of its size: a face that deviates more from a plane is none
_NEARLY = 0.05  # of its radius: what a face is nearly, and said to be
_EXACT = ("Plane", "Cylinder", "Cone", "Sphere", "Torus")  # as gmsh calls them
_WORDS = {"BSpline surface": "B-spline surface", "Unknown": "surface of a swept curve"}
_ACROSS, _ALONG = 25, 33  # points of a face each way, and of an edge
_ARC = 0.3  # sine of the angle between normals: flatter ones do not determine a radius
_PIECES, _GAUSS = 120, np.polynomial.legendre.leggauss(4)  # of an edge: knots fall between
_STRAIGHT = 1e-3  # cosine of the angle between a cylinder's normals and its axis


def recognised(tag: int, kind: str) -> dict[str, Any]:
    """Recognise a plane, cylinder or sphere in a face that is described as a spline or by a curve.

    Parameters
    ----------
    tag : int
        Tag of the face in the open gmsh model.
    kind : str
        Kind of its surface, as gmsh calls it.

    Returns
    -------
    dict
        Facts by name; none of a face that is described as what it is. Else "off", the maximum
        distance of its points from the surface that fits best [mm], and "described", as what; of
        one that fits "kind" and, as of faces described as such, "normal", or "radius", "centre",
        "axis", "length" and "hole"; of a hollow one that does not quite fit "nearly", the radius of
        the cylinder or sphere.
    """
    if kind in _EXACT:
        return {}
    at, normals = _inside(tag)
    if len(at) < 6:
        return {}
    points = np.concatenate([at, on_edges(tag)])
    flat, extent = fitted_plane(points), float(np.linalg.norm(np.ptp(points, axis=0)))
    described = {"described": _WORDS.get(kind, kind.lower())}
    if flat.off <= _FLAT * extent:
        normal = flat.axis * np.sign(flat.axis @ normals.mean(axis=0))
        return described | {"kind": "Plane", "normal": normal.tolist(), "off": flat.off}
    axis = np.linalg.svd(normals, full_matrices=False)[2][2]
    turned = np.linalg.norm(np.cross(normals, normals[0]), axis=1).max()
    if turned < _ARC:
        return described
    fits = {"Cylinder": fitted_cylinder(points, axis), "Sphere": fitted_sphere(points)}
    found = min(fits, key=lambda key: fits[key].off / max(fits[key].radius, 1e-300))
    best = fits[found]
    share = best.off / max(best.radius, 1e-300)
    tilted = np.abs(normals @ best.axis).max() > max(_STRAIGHT, 10.0 * math.sqrt(share))
    if not best.radius < extent * 10 or share > _NEARLY or (found == "Cylinder" and tilted):
        return described
    shape = _round(best, points, at, normals)
    if share > ROUND and not shape["hole"]:
        return described
    if share > ROUND:
        return described | {"nearly": best.radius, "shape": found.lower(), "off": best.off}
    return described | {"kind": found, "off": best.off} | shape


def _round(best: Fit, points: Floats, at: Floats, normals: Floats) -> dict[str, Any]:
    """The fit of a cylinder or sphere, as if the file had described it as such."""
    axis, centre = best.axis, best.centre
    out = at - centre
    out = out - (out @ axis)[:, None] * axis
    found: dict[str, Any] = {"radius": best.radius}
    found["hole"] = bool(np.einsum("ni,ni->n", out, normals).mean() < 0)
    if axis.any():
        axis = axis * np.sign(axis[np.argmax(np.abs(axis))])
        heights = (points - centre) @ axis
        centre = centre + axis * (heights.max() + heights.min()) / 2
        found |= {"axis": axis.tolist(), "length": float(np.ptp(heights))}
    return found | {"centre": centre.tolist()}


def _inside(tag: int) -> tuple[Floats, Floats]:
    """Points inside of a face and its outward normals there."""
    (u0, v0), (u1, v1) = gmsh.model.getParametrizationBounds(2, tag)
    u, v = (
        low + (high - low) * (np.arange(_ACROSS) + 0.5) / _ACROSS
        for low, high in ((u0, u1), (v0, v1))
    )
    grid = np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1).reshape(-1, 2)
    within = [bool(gmsh.model.isInside(2, tag, one, parametric=True)) for one in grid.tolist()]
    chosen = grid[within].ravel().tolist()
    if not chosen:
        return np.zeros((0, 3)), np.zeros((0, 3))
    at = np.reshape(gmsh.model.getValue(2, tag, chosen), (-1, 3))
    normals = np.reshape(gmsh.model.getNormal(tag, chosen), (-1, 3))
    return np.asarray(at, dtype=np.float64), np.asarray(normals, dtype=np.float64)


def lies_on(tag: int, face: dict[str, Any], size: float) -> bool:
    """Whether a face is a piece of the cylinder or sphere of another one, within its length.

    Parameters
    ----------
    tag : int
        Tag of the face that may be a piece.
    face : dict
        Facts of the other face, from `recognised` or as described: "radius", "centre", "axis",
        "length".
    size : float
        Size of all solids together [mm].
    """
    allowed = 2.0 * face.get("off", 0.0) + _SAME * size
    axis, centre = np.array(face.get("axis", (0.0, 0.0, 0.0))), np.array(face["centre"])

    def lie(points: Floats) -> bool:
        away = points - centre
        heights = away @ axis
        off = np.linalg.norm(away - heights[:, None] * axis, axis=1) - face["radius"]
        beyond = np.abs(heights) - face.get("length", 0.0) / 2
        return bool(np.maximum(np.abs(off), beyond).max(initial=-math.inf) <= allowed)

    if not lie(on_edges(tag)):  # most faces lie elsewhere, and to find points inside takes long
        return False
    at, _ = _inside(tag)
    return len(at) > 0 and lie(at)


def on_edges(tag: int) -> Floats:
    """Points on the edges of a face.

    Parameters
    ----------
    tag : int
        Tag of the face.

    Returns
    -------
    (n, 3) [mm], ends included.
    """
    found = [np.zeros((0, 3))]
    for _, edge in gmsh.model.getBoundary([(2, tag)], combined=False, oriented=False):
        if gmsh.model.getType(1, edge) == "Unknown":  # the pole of a sphere
            continue
        (low,), (high,) = gmsh.model.getParametrizationBounds(1, edge)
        at = np.linspace(low, high, _ALONG)
        found.append(np.reshape(gmsh.model.getValue(1, edge, at.tolist()), (-1, 3)))
    return np.concatenate(found)


def area_and_middle(tag: int) -> tuple[float, Floats]:
    """Area and centroid of a face, of a plane one from its edges.

    OpenCASCADE integrates splines over few points: of a plane with holes it misses 3e-4.

    Parameters
    ----------
    tag : int
        Tag of the face.

    Returns
    -------
    float
        Area [mm^2].
    Floats
        Centroid (3,) [mm].
    """
    occ = gmsh.model.occ
    area, middle = float(occ.getMass(2, tag)), np.array(occ.getCenterOfMass(2, tag))
    if gmsh.model.getType(2, tag) in _EXACT:
        return area, middle
    (u0, v0), (u1, v1) = gmsh.model.getParametrizationBounds(2, tag)
    places = [w for u in np.linspace(u0, u1, 5) for v in np.linspace(v0, v1, 5) for w in (u, v)]
    normals = np.reshape(gmsh.model.getNormal(tag, places), (-1, 3))
    normal = normals[len(normals) // 2]
    if np.abs(np.cross(normals, normal)).max() > _FLAT:
        return area, middle
    across = np.linalg.svd(normal[None])[2][1:]
    moments = np.zeros(3)
    for _, edge in gmsh.model.getBoundary([(2, tag)], combined=False, oriented=True):
        (low,), (high,) = gmsh.model.getParametrizationBounds(1, abs(edge))
        ends = np.linspace(low, high, _PIECES + 1)
        at = ((ends[:-1] + ends[1:])[:, None] / 2 + np.diff(ends)[:, None] / 2 * _GAUSS[0]).ravel()
        weights = (np.diff(ends)[:, None] / 2 * _GAUSS[1]).ravel() * np.sign(edge)
        flat, along = (
            (np.reshape(values, (-1, 3)) - origin) @ across.T
            for values, origin in (
                (gmsh.model.getValue(1, abs(edge), at.tolist()), middle),
                (gmsh.model.getDerivative(1, abs(edge), at.tolist()), np.zeros(3)),
            )
        )
        (p, q), (dp, dq) = flat.T, along.T
        moments += [weights @ (p * dq), weights @ (p * p * dq) / 2, -weights @ (q * q * dp) / 2]
    return abs(float(moments[0])), middle + moments[1:] / moments[0] @ across
