"""Load ratings of bearings from their insides: C of ISO 281, C0 of ISO 76, C_u of ISO 281.

They show whether assumed rollers fit a catalogue's ratings. The constants were not read in the
standards: of rollers, C0 and C_u give those of a bearing in the program MASTA to 1e-7, C to 0.1 %;
f_c of balls is a table that public code prints, and Lundberg's and Palmgren's formula times 0.957
within the rounding of its digits.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos
from typing import TypeVar

import numpy as np

from fe_drivetrain.bearing.geometry import BallRow, Bearing, RollerRow, pitch_ratio
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

LAMBDA = 0.83
"""Reduction of line contact for edge stress, in f_c."""

# f_c of single-row radial ball bearings at gamma = 0.01, 0.02, ... 0.4 (ISO 281, table 2).
_F_C_OF_BALLS = (
    *(29.1, 35.8, 40.3, 43.8, 46.7, 49.1, 51.1, 52.8, 54.3, 55.5),
    *(56.6, 57.5, 58.2, 58.8, 59.3, 59.6, 59.8, 59.9, 60.0, 59.9),
    *(59.8, 59.6, 59.3, 59.0, 58.6, 58.2, 57.7, 57.1, 56.6, 56.0),
    *(55.3, 54.6, 53.9, 53.2, 52.4, 51.7, 50.9, 50.0, 49.2, 48.4),
)


OneRow = TypeVar("OneRow", RollerRow, BallRow)


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
        Factor b_m of ISO 281: 1.1 for tapered and cylindrical rollers; 1.15 for spherical ones
        (from memory, not verified).

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
    row, i = _equal_rows(bearing, RollerRow, "rollers"), len(bearing.rows)
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
        Factor for N and mm.
    """
    return float(capacity_factors(np.asarray(gamma)))


def capacity_factors(gamma: Floats) -> Floats:
    """f_c of roller bearings, of any shape; see `capacity_factor`."""
    opening = ((1.0 - gamma) / (1.0 + gamma)) ** (143.0 / 108.0)
    return np.asarray(
        207.9
        * LAMBDA
        * gamma ** (2.0 / 9.0)
        * (1.0 - gamma) ** (29.0 / 27.0)
        / (1.0 + gamma) ** 0.25
        * (1.0 + (1.04 * opening) ** 4.5) ** (-2.0 / 9.0)
    )


def ball_dynamic_rating(bearing: Bearing, b_m: float = 1.3) -> float:
    """C of a radial ball bearing of equal rows, its grooves of at most 0.52 and 0.53 diameters.

    Parameters
    ----------
    bearing : Bearing
        Equal rows of balls.
    b_m : float
        Factor b_m of ISO 281: 1.3 for deep grooves and angular contact.

    Returns
    -------
    C : float
        b_m f_c (i cos)^0.7 Z^(2/3) D^1.8, and 3.647 D^1.4 for D^1.8 above 25.4 mm; N and mm.

    Raises
    ------
    InputError
        The rows are not balls, or not equal, or gamma is beyond the table of f_c.
    """
    row, i = _equal_rows(bearing, BallRow, "balls"), len(bearing.rows)
    D, size = 1e3 * row.diameter, ball_capacity_factor(pitch_ratio(row))
    grown = D**1.8 if D <= 25.4 else 3.647 * D**1.4
    return float(b_m * size * (i * cos(row.angle)) ** 0.7 * row.balls ** (2 / 3) * grown)


def ball_capacity_factor(gamma: float) -> float:
    """f_c of ISO 281 for radial ball bearings, between the values of its table.

    Parameters
    ----------
    gamma : float
        D cos(alpha) / D_pw.

    Returns
    -------
    f_c : float
        Factor for N and mm.

    Raises
    ------
    InputError
        gamma is below 0.01 or above 0.4.
    """
    if not 0.01 <= gamma <= 0.4:
        raise InputError(
            f"D cos(alpha) / D_pw of the balls is {gamma:.3g}: f_c of ISO 281 goes from 0.01 to "
            "0.4; give the rating from a catalogue"
        )
    return float(ball_capacity_factors(np.asarray(gamma)))


def ball_capacity_factors(gamma: Floats) -> Floats:
    """f_c of ball bearings, of any shape, from 0.01 to 0.4; see `ball_capacity_factor`."""
    count = len(_F_C_OF_BALLS)
    return np.asarray(np.interp(gamma, np.arange(1, count + 1) / 100.0, _F_C_OF_BALLS))


def _equal_rows(bearing: Bearing, kind: type[OneRow], what: str) -> OneRow:
    """The first row of a bearing, all of whose rows are of a kind and equal."""
    rows = [row for row in bearing.rows if isinstance(row, kind)]
    different = {
        (count, r.radius, abs(r.angle), r.diameter, getattr(r, "length", None))
        for count, r in zip(bearing.counts, rows, strict=False)
    }
    if len(rows) != len(bearing.rows) or len(different) != 1:
        raise InputError(
            f"ratings of {bearing.name}: its rows must be {what}, equal in number, size and "
            "contact angle"
        )
    return rows[0]
