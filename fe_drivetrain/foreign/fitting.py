"""Planes, cylinders and spheres fitted to points by least squares of their distances."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats

_STEPS = 30
_SETTLED = 1e-14  # of the radius: a step of the fit that is round-off


class Fit(NamedTuple):
    """A surface fitted to points.

    Attributes
    ----------
    centre : Floats
        Point (3,) on a plane or on a cylinder's axis, in the mean of the points; of a sphere its
        centre.
    axis : Floats
        Normal (3,) of a plane, direction of a cylinder; zeros of a sphere.
    radius : float
        Radius of cylinder or sphere; 0 of a plane.
    off : float
        Maximum distance of a point from the surface.
    """

    centre: Floats
    axis: Floats
    radius: float
    off: float


def fitted_plane(at: Floats) -> Fit:
    """The plane through points.

    Parameters
    ----------
    at : Floats
        Points (n, 3), n at least 3.
    """
    middle = at.mean(axis=0)
    normal = np.linalg.svd(at - middle, full_matrices=False)[2][2]
    return Fit(middle, normal, 0.0, float(np.abs((at - middle) @ normal).max()))


def fitted_sphere(at: Floats) -> Fit:
    """The sphere through points: algebraic fit, then Gauss-Newton on the distances.

    Parameters
    ----------
    at : Floats
        Points (n, 3), n at least 4.
    """
    middle = at.mean(axis=0)
    away = at - middle
    A = np.column_stack([2 * away, np.ones(len(at))])
    *shift, k = np.linalg.lstsq(A, (away**2).sum(axis=1), rcond=None)[0].tolist()
    centre = middle + shift
    radius = math.sqrt(max(k + float(np.dot(shift, shift)), 0.0))
    for _ in range(_STEPS):
        away = at - centre
        distance = np.linalg.norm(away, axis=1)
        out = away / np.maximum(distance, np.finfo(float).tiny)[:, None]
        A = np.column_stack([out, np.ones(len(at))])
        step = np.linalg.lstsq(A, distance - radius, rcond=None)[0]
        centre, radius = centre + step[:3], radius + float(step[3])
        if np.abs(step).max() < _SETTLED * abs(radius):
            break
    off = np.abs(np.linalg.norm(at - centre, axis=1) - radius).max()
    return Fit(centre, np.zeros(3), float(radius), float(off))


def fitted_cylinder(at: Floats, axis: Floats) -> Fit:
    """The cylinder through points near an axis' direction: Gauss-Newton on the distances.

    Parameters
    ----------
    at : Floats
        Points (n, 3), n at least 5.
    axis : Floats
        Direction (3,) to begin with, such as the minimum principal direction of the normals.
    """
    middle = at.mean(axis=0)
    axis = axis / np.linalg.norm(axis)
    centre, radius = fitted_circle(at, axis)
    for _ in range(_STEPS):
        across = np.linalg.svd(axis[None])[2][1:]
        away = at - centre
        height = away @ axis
        away = away - height[:, None] * axis
        distance = np.linalg.norm(away, axis=1)
        out = (away / np.maximum(distance, np.finfo(float).tiny)[:, None]) @ across.T
        reach = max(float(np.abs(height).max()), np.finfo(float).tiny)
        A = np.column_stack([out, height[:, None] / reach * out, np.ones(len(at))])
        step = np.linalg.lstsq(A, distance - radius, rcond=1e-12)[0]
        centre = centre + step[:2] @ across
        axis = axis + step[2:4] / reach @ across
        axis = axis / np.linalg.norm(axis)
        radius = radius + float(step[4])
        if np.abs(step).max() < _SETTLED * abs(radius):
            break
    centre = centre + ((middle - centre) @ axis) * axis
    off = np.abs(from_axis(at, centre, axis) - radius).max()
    return Fit(centre, axis, float(radius), float(off))


def fitted_circle(at: Floats, axis: Floats) -> tuple[Floats, float]:
    """Centre in the mean height of points, and radius, of the circle about an axis (Kasa 1976).

    Parameters
    ----------
    at : Floats
        Points (n, 3).
    axis : Floats
        Unit vector (3,) along the axis.
    """
    across = np.linalg.svd(axis[None])[2][1:]
    middle = at.mean(axis=0)
    flat = (at - middle) @ across.T
    A = np.column_stack([2 * flat, np.ones(len(flat))])
    u, v, k = np.linalg.lstsq(A, (flat**2).sum(axis=1), rcond=None)[0].tolist()
    return middle + np.array([u, v]) @ across, math.sqrt(max(k + u * u + v * v, 0.0))


def from_axis(at: Floats, centre: Floats, axis: Floats) -> Floats:
    """Distances of points from an axis.

    Parameters
    ----------
    at : Floats
        (..., 3) points.
    centre, axis : Floats
        Point (3,) on the axis, and its unit vector.
    """
    away = at - centre
    away = away - (away @ axis)[..., None] * axis
    return np.asarray(np.linalg.norm(away, axis=-1), dtype=np.float64)
