"""Load ratings of roller bearings from their insides: C of ISO 281, C0 of ISO 76, C_u of ISO 281.

They show whether assumed rollers fit a catalogue's ratings. The constants were not read in the
standards: C0 and C_u give those of a bearing in the program MASTA to 1e-7, C to 0.1 %.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos

from fe_drivetrain.bearing.geometry import Bearing, RollerRow, pitch_ratio
from fe_drivetrain.common.errors import InputError

LAMBDA = 0.83
"""Reduction of line contact for edge stress, in f_c."""


@dataclass(frozen=True)
class Ratings:
    """Load ratings of a bearing.

    Attributes
    ----------
    dynamic, static, fatigue : float
        C, C0 and C_u [N].
    """

    dynamic: float
    static: float
    fatigue: float


def ratings(bearing: Bearing, b_m: float = 1.1) -> Ratings:
    """C, C0 and C_u of a radial roller bearing of equal rows.

    Parameters
    ----------
    bearing : Bearing
        Equal rows of rollers.
    b_m : float
        Of ISO 281: 1.1 for tapered and cylindrical rollers; 1.15 for spherical ones (from memory,
        not verified).

    Returns
    -------
    ratings : Ratings
        C = b_m f_c (i L cos)^(7/9) Z^(3/4) D^(29/27), C0 = 44 (1 - gamma) i Z L D cos,
        C_u = C0 / 8.2 (100 / D_pw)^0.3 above a pitch diameter of 100 mm; N and mm.

    Raises
    ------
    InputError
        The rows are not rollers, or not equal.
    """
    rows = [row for row in bearing.rows if isinstance(row, RollerRow)]
    different = {(r.rollers, r.radius, abs(r.angle), r.diameter, r.length) for r in rows}
    if len(rows) != len(bearing.rows) or len(different) != 1:
        raise InputError(
            f"ratings of {bearing.name}: its rows must be rollers, equal in number, size and "
            "contact angle"
        )
    row, i = rows[0], len(rows)
    gamma, cosine = pitch_ratio(row), cos(row.angle)
    D, L, pitch = 1e3 * row.diameter, 1e3 * row.length, 2e3 * row.radius
    C = (
        b_m
        * capacity_factor(gamma)
        * (i * L * cosine) ** (7.0 / 9.0)
        * row.rollers**0.75
        * D ** (29.0 / 27.0)
    )
    C0 = 44.0 * (1.0 - gamma) * i * row.rollers * L * D * cosine
    return Ratings(C, C0, C0 / 8.2 * min(100.0 / pitch, 1.0) ** 0.3)


def capacity_factor(gamma: float) -> float:
    """f_c of ISO 281 for roller bearings, as the formula behind its table.

    Parameters
    ----------
    gamma : float
        D cos(alpha) / D_pw.

    Returns
    -------
    f_c : float
        For N and mm.
    """
    opening = ((1.0 - gamma) / (1.0 + gamma)) ** (143.0 / 108.0)
    return float(
        207.9
        * LAMBDA
        * gamma ** (2.0 / 9.0)
        * (1.0 - gamma) ** (29.0 / 27.0)
        / (1.0 + gamma) ** 0.25
        * (1.0 + (1.04 * opening) ** 4.5) ** (-2.0 / 9.0)
    )
