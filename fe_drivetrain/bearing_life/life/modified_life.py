"""Modified reference rating life: lubricant, contamination and fatigue limit, lamina by lamina.

Constants of the life factor are those of ISO 281 as public code and Stirling (2023, eqs 5.11 to
5.13) have them: none was read in the standard.
Additives, wear, sliding and micropitting are not covered.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.rating import LAMBDA
from fe_drivetrain.bearing_life.life.reference_life import LINE, SLOPE, RowLoads
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, require_known

MAXIMUM = 50.0
"""Largest life factor."""

MINIMUM = 0.1
"""Smallest life factor."""

BRANCHES = (
    (0.1, 1.3993, 0.054381),
    (0.4, 1.2348, 0.19087),
    (1.0, 1.2348, 0.071739),
)
"""From which kappa on, and the constants a and b of a / kappa^b."""

BALL_BRANCHES = (
    (0.1, 2.2649, 0.054381),
    (0.4, 1.9987, 0.19087),
    (1.0, 1.9987, 0.071739),
)
"""The same of balls. Public code has 0.019087 in the second branch, with which it would jump at
kappa = 0.4; 0.19087 meets the first branch to five digits."""

Contact = Literal["line", "point"]

FACTORS = {
    "line": (1.5859, 1.0, 0.4, 9.185, BRANCHES),
    "point": (2.5671, 0.83, 1.0 / 3.0, 9.3, BALL_BRANCHES),
}
"""Of a_ISO by contact: the largest slope, exponents of slope, ratio and bracket, branches."""

LAST_KAPPA = 4.0
"""Viscosity beyond this ratio brings nothing."""

MIX = 0.323 / LAMBDA
"""Equivalent load of a row from its laminae, without reduction for edge stress: some 0.389."""


def viscosity(
    temperature: ArrayLike, known: tuple[tuple[float, float], tuple[float, float]]
) -> Floats:
    """Kinematic viscosity of a mineral oil at a temperature (ASTM D341).

    Parameters
    ----------
    temperature : array_like
        [degC].
    known : tuple of tuple
        Two pairs of temperature [degC] and viscosity [mm2/s], as ((40, 460), (100, 30.5)).

    Returns
    -------
    viscosity : Floats
        [mm2/s], with log10 log10 (nu + 0.7) linear in the logarithm of the absolute temperature;
        above 2 mm2/s, where the further terms of ASTM D341 vanish.

    Raises
    ------
    InputError
        The temperatures are the same, or a viscosity is not above 2 mm2/s.
    """
    (T1, nu1), (T2, nu2) = known
    if T1 == T2 or min(nu1, nu2) <= 2.0:
        raise InputError(
            f"viscosity {nu1:g} mm2/s at {T1:g} degC and {nu2:g} at {T2:g}: give values above "
            "2 mm2/s at two temperatures, as at 40 and 100 degC"
        )
    x1, x2 = np.log(T1 + 273.15), np.log(T2 + 273.15)
    y1, y2 = (np.log(np.log10(nu + 0.7)) for nu in (nu1, nu2))
    x = np.log(np.asarray(temperature, dtype=float) + 273.15)
    y = y1 + (y2 - y1) * (x - x1) / (x2 - x1)
    return np.asarray(10.0 ** np.exp(y) - 0.7)


def needed_viscosity(speed_rpm: ArrayLike, pitch_diameter: float) -> Floats:
    """Viscosity nu_1 that kappa = nu / nu_1 relates the lubricant's to (ISO 281).

    Parameters
    ----------
    speed_rpm : array_like
        [1/min].
    pitch_diameter : float
        D_pw [m].

    Returns
    -------
    viscosity : Floats
        [mm2/s], with D_pw in mm: 45000 n^-0.83 D_pw^-0.5 below 1000/min, 4500 n^-0.5 D_pw^-0.5 from
        there on.

    Notes
    -----
    At 1000/min the second formula is 2.3 % below the first: both are as they stand.
    """
    n = np.asarray(speed_rpm, dtype=float)
    slow, fast = 45000.0 * n**-0.83, 4500.0 * n**-0.5
    return np.asarray(np.where(n < 1000.0, slow, fast) / np.sqrt(1e3 * pitch_diameter))


def life_factor(ratio: ArrayLike, kappa: ArrayLike, contact: Contact = "line") -> Floats:
    """a_ISO of radial bearings.

    Parameters
    ----------
    ratio : array_like
        e_C C_u / P.
    kappa : array_like
        Viscosity ratio; above 4 it counts as 4, below 0.1 the method does not hold and a_ISO is its
        smallest value.
    contact : {"line", "point"}
        Line contact of rollers, or point contact of balls.

    Returns
    -------
    a_ISO : Floats
        Rollers: 0.1 (1 - (1.5859 - a / kappa^b) ratio^0.4)^-9.185; balls:
        0.1 (1 - (2.5671 - a / kappa^b)^0.83 ratio^(1/3))^-9.3; both from 0.1 to 50, of both
        arguments' common shape.

    Raises
    ------
    InputError
        There is no such contact.
    """
    require_known("kind of contact (line of rollers, point of balls)", contact, FACTORS)
    whole, of_slope, of_ratio, power, branches = FACTORS[contact]
    x = np.asarray(ratio, dtype=float)
    k = np.minimum(np.asarray(kappa, dtype=float), LAST_KAPPA)
    film = np.full(k.shape, np.inf)
    for start, a, b in branches:
        with np.errstate(divide="ignore"):
            film = np.where(k >= start, a / k**b, film)
    slope = np.where(k < branches[0][0], 0.0, np.maximum(whole - film, 0.0) ** of_slope)
    with np.errstate(invalid="ignore"):
        bracket = np.maximum(np.where(slope == 0.0, 1.0, 1.0 - slope * x**of_ratio), 0.0)
    with np.errstate(divide="ignore"):
        return np.asarray(np.minimum(MINIMUM * bracket**-power, MAXIMUM))


def equivalent_loads(row: RowLoads) -> Floats:
    """Dynamic equivalent load of each lamina, as a radial load of the whole row.

    Parameters
    ----------
    row : RowLoads
        The row.

    Returns
    -------
    loads : Floats
        (n, laminae) P_ks [N]: Stirling 2023, eq. 5.10, of whose printed denominator a surplus
        q_kee^4.5 is left out. Its constant is 0.323 at the standard's reduction
        for edge stress, and in proportion to the row's `edge`.

    Notes
    -----
    It is the load of one row. The fatigue limit C_u to set against it is that of a row, half of
    what a catalogue gives for two; with the whole C_u life factors are larger.
    """
    capacity_ratio = row.inner_capacity / row.outer_capacity
    weight = (1.038 * capacity_ratio) ** LINE
    mixed = (row.inner**LINE + weight * row.outer**LINE) / (1.0 + weight)
    n_rollers, laminae = row.row.rollers, row.inner.shape[1]
    scale = MIX * row.edge * n_rollers * np.cos(row.row.angle) * laminae
    return np.asarray(scale * mixed ** (1.0 / LINE))


def modified_lamina_life(
    rows: Sequence[RowLoads], factors: Sequence[ArrayLike], reliability: float = 1.0
) -> Floats:
    """Modified reference rating life L_nmr.

    Parameters
    ----------
    rows : sequence of RowLoads
        All rows of a bearing.
    factors : sequence of array_like
        For each row (n, laminae) or what broadcasts to it: a_ISO of each lamina.
    reliability : float
        a_1: 1 at 90 %.

    Returns
    -------
    life : Floats
        (n,) [million revolutions]: each lamina's damage times a_ISO^(-9/8) (Stirling 2023, eqs 5.14
        and 5.15).
    """
    risk = np.sum(
        [
            np.sum(row.damage * np.asarray(a, dtype=float) ** -SLOPE, axis=1)
            for row, a in zip(rows, factors, strict=True)
        ],
        axis=0,
    )
    with np.errstate(divide="ignore"):
        return np.asarray(reliability * risk ** (-1.0 / SLOPE))
