"""Tilting stiffness at fixed displacements: the scenarios of Stirling 2023, Table 4.2."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.contact_forces import forces
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.common.arrays import Floats

#: Names of the eight scenarios: axial and radial displacement.
SCENARIOS = (
    ("0", "0"),
    ("min", "0"),
    ("max", "0"),
    ("0", "min"),
    ("0", "max"),
    ("min", "min"),
    ("max", "max"),
    ("mean", "mean"),
)


@dataclass(frozen=True, eq=False)
class TiltCurve:
    """Moment against tilt with all other displacements held.

    Attributes
    ----------
    tilts : Floats
        Tilts (n,) about y [rad].
    moments : Floats
        Moments (n,) about y [N m].
    stiffness : Floats
        Tangent stiffness (n,), dM / d theta [N m/rad], Stirling 2023, Eq 4.20.
    """

    tilts: Floats
    moments: Floats
    stiffness: Floats


def displacement_scenarios(axial: ArrayLike, radial: ArrayLike) -> Floats:
    """Axial and radial displacements of the eight scenarios, (8, 2) [m].

    Parameters
    ----------
    axial, radial : array_like
        Displacements met in operation; the radial ones without sign.

    Returns
    -------
    displacements : Floats
        Displacements (8, 2) [m], in the order of `SCENARIOS`.
    """
    values = []
    for seen in (np.asarray(axial, dtype=float), np.asarray(radial, dtype=float)):
        values.append({"0": 0.0, "min": seen.min(), "max": seen.max(), "mean": seen.mean()})
    return np.array([[values[0][a], values[1][r]] for a, r in SCENARIOS])


def tilt_curve(bearing: Bearing, axial: float, radial: float, tilts: ArrayLike) -> TiltCurve:
    """Moment and stiffness over the tilt about y, at fixed axial and downward displacement.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    axial, radial : float
        Downwind, and down [m].
    tilts : array_like
        Tilts (n,) about y [rad].

    Returns
    -------
    curve : TiltCurve
        Curve over the tilts.
    """
    theta = np.asarray(tilts, dtype=float)
    u = np.zeros((len(theta), 5))
    u[:, 0], u[:, 2], u[:, 3] = axial, -radial, theta
    F, K = forces(bearing, u)
    return TiltCurve(theta, F[:, 3], K[:, 3, 3])


def best_fit(curves: Sequence[TiltCurve]) -> float:
    """Slope of the straight line through all points of several curves [N m/rad].

    Parameters
    ----------
    curves : Sequence
        Tilt curves, each a `TiltCurve`.

    Returns
    -------
    stiffness : float
        Slope by least squares, the line having an offset of its own [N m/rad].
    """
    tilts = np.concatenate([curve.tilts for curve in curves])
    moments = np.concatenate([curve.moments for curve in curves])
    return float(np.polyfit(tilts, moments, 1)[0])
