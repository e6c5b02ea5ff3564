"""A bearing with its load ratings, and the equivalent loads of ISO 281 and ISO 76.

Factors X, Y and e are those of the standards' tables as public code and catalogues print them; the
standards were not read. A moment on a bearing is not in these loads: that is what ISO/TS 16281 is
for (`fe_drivetrain.bearing_life.life.roller_damage`).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import degrees, radians, tan
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.catalogue import Entry, Named, catalogue_entry, name_of
from fe_drivetrain.bearing.catalogue_page import CataloguePage
from fe_drivetrain.bearing.fitted_rollers import B_M
from fe_drivetrain.bearing.geometry import BallRow, Bearing
from fe_drivetrain.bearing.rating import ball_dynamic_rating, ratings
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

BALL_RATIO = (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89)
"""f_0 F_a / C_0 of deep grooves, for e and Y below (ISO 281, table 3, and catalogues)."""

BALL_E = (0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44)
BALL_Y = (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00)

ANGULAR = {
    20.0: (0.57, 0.43, 1.00, 1.09, 0.70, 1.63),
    25.0: (0.68, 0.41, 0.87, 0.92, 0.67, 1.41),
    30.0: (0.80, 0.39, 0.76, 0.78, 0.63, 1.24),
    35.0: (0.95, 0.37, 0.66, 0.66, 0.60, 1.07),
    40.0: (1.14, 0.35, 0.57, 0.55, 0.57, 0.93),
    45.0: (1.34, 0.33, 0.50, 0.47, 0.54, 0.81),
}
"""Angular contact by angle [deg]: e; X and Y of a single row; Y1, X2, Y2 of two (ISO 281, table 3,
from memory)."""

STATIC_Y = (0.42, 0.38, 0.33, 0.29, 0.26, 0.22)
"""Y_0 of a single row at the same angles (ISO 76, from memory)."""

F_0 = 14.0
"""Factor f_0 of deep grooves where none is given; catalogues have 11 to 17."""

STATIC_PRESSURE = {"rollers": 4.0e9, "balls": 4.2e9}
"""Pressure of the most loaded contact [Pa] that C_0 stands for (ISO 76, not read there; the 44 of
C_0 of rollers gives 3,981 MPa). Self-aligning balls, of which there are none here, have 4.6e9."""

FATIGUE_OF_BALLS = 22.0
"""C_0 / C_u of ball bearings up to a pitch diameter of 100 mm (ISO 281, annex B, from memory)."""


@dataclass(frozen=True)
class Factors:
    """X, Y and e of a radial bearing.

    Attributes
    ----------
    e : float
        Axial over radial force at which the factors change.
    below, above : tuple of float
        X and Y up to e, and beyond it.
    static : tuple of float
        X_0 and Y_0 (ISO 76).
    """

    e: float
    below: tuple[float, float]
    above: tuple[float, float]
    static: tuple[float, float]


@dataclass(frozen=True)
class RatedBearing:
    """A bearing and its load ratings.

    Attributes
    ----------
    bearing : Bearing
        Bearing with rollers or with balls, not both.
    dynamic, static, fatigue : float
        C, C_0 and C_u of the whole bearing [N].
    sources : tuple of str
        Where each of the three comes from.
    factors : Factors or None
        Factors of a catalogue; those of the geometry where not given.
    f_0 : float
        Factor f_0 of deep grooves.
    limiting_speed_rpm : float or None
        Limiting speed of a catalogue [1/min].
    mean_diameter : float or None
        Mean of bore and outside diameter of a catalogue's page [m], in place of the pitch diameter.
    """

    bearing: Bearing
    dynamic: float
    static: float
    fatigue: float
    sources: tuple[str, str, str]
    factors: Factors | None = None
    f_0: float = F_0
    limiting_speed_rpm: float | None = None
    mean_diameter: float | None = None

    def __post_init__(self) -> None:
        if len({isinstance(row, BallRow) for row in self.bearing.rows}) > 1:
            raise InputError(f"{self.bearing.name} has rows of balls and of rollers: rate each")
        for name, value in zip(("C", "C0", "Cu"), self.three, strict=True):
            if not 0.0 < value < np.inf:
                raise InputError(f"{name} of {self.bearing.name} is {value:g} N: give more than 0")

    @property
    def three(self) -> tuple[float, float, float]:
        """C, C_0 and C_u [N]."""
        return self.dynamic, self.static, self.fatigue

    @property
    def balls(self) -> bool:
        """Whether its rolling elements are balls."""
        return isinstance(self.bearing.rows[0], BallRow)

    @property
    def exponent(self) -> float:
        """Exponent from load to life: 3 for balls, 10/3 for rollers."""
        return 3.0 if self.balls else 10.0 / 3.0

    @property
    def static_pressure(self) -> float:
        """Pressure of the most loaded contact that C_0 stands for [Pa] (ISO 76)."""
        return STATIC_PRESSURE["balls" if self.balls else "rollers"]

    @property
    def pressure_exponent(self) -> float:
        """Power of a contact's pressure that its load goes with: 2 in line, 3 in point contact."""
        return 3.0 if self.balls else 2.0

    @property
    def pitch_diameter(self) -> float:
        """D_pw of lubrication and speed [m]."""
        return 2.0 * self.bearing.arm if self.mean_diameter is None else self.mean_diameter

    def equivalent_load(self, loads: ArrayLike) -> Floats:
        """Dynamic equivalent load P of ISO 281.

        Parameters
        ----------
        loads : array_like
            (n, 5) on the bearing [N, N m], of which moments are left out.

        Returns
        -------
        loads : Floats
            (n,) X F_r + Y F_a [N].
        """
        radial, axial = _parts(loads)
        given = self.factors or of_geometry(self.bearing)
        if self.factors is None and _deep_groove(self.bearing):
            ratio = self.f_0 * axial / self.static
            e, Y = (np.interp(ratio, BALL_RATIO, table) for table in (BALL_E, BALL_Y))
            return np.where(axial <= e * radial, radial, 0.56 * radial + Y * axial)
        (X1, Y1), (X2, Y2) = given.below, given.above
        low = axial <= given.e * radial
        return np.where(low, X1 * radial + Y1 * axial, X2 * radial + Y2 * axial)

    def static_load(self, loads: ArrayLike) -> Floats:
        """Static equivalent load P_0 of ISO 76, (n,) [N]; see `equivalent_load`."""
        radial, axial = _parts(loads)
        X, Y = (self.factors or of_geometry(self.bearing)).static
        return np.maximum(X * radial + Y * axial, radial)


def of_geometry(bearing: Bearing) -> Factors:
    """X, Y and e of ISO 281, and X_0 and Y_0 of ISO 76, from number of rows and contact angle.

    Parameters
    ----------
    bearing : Bearing
        One or two rows, equal but for the sign of their angles.

    Returns
    -------
    factors : Factors
        Rollers: e = 1.5 tan(alpha); one row 1, 0 and 0.4, 0.4 cot; two rows 1, 0.45 cot and 0.67,
        0.67 cot; static 0.5, 0.22 cot and 1, 0.44 cot. Deep grooves have those of a vanishing axial
        force; e and Y grow with it (`RatedBearing.equivalent_load`).

    Raises
    ------
    InputError
        Balls with an angle outside of 20 to 45 deg, or more than two rows.
    """
    row, rows = bearing.rows[0], len(bearing.rows)
    alpha = abs(row.angle)
    if rows > 2:
        raise InputError(f"{bearing.name} has {rows} rows: give the X, Y and e of its catalogue")
    if isinstance(row, BallRow):
        return _of_balls(bearing, degrees(alpha), rows)
    if alpha < 1e-6:  # a cylindrical or toroidal bearing
        return Factors(np.inf, (1.0, 0.0), (1.0, 0.0), (1.0, 0.0))
    cot, e = 1.0 / tan(alpha), 1.5 * tan(alpha)
    # Two rows that open to one side act as one; a pair facing each other shares.
    if rows == 1:
        return Factors(e, (1.0, 0.0), (0.4, 0.4 * cot), (0.5, 0.22 * cot))
    return Factors(e, (1.0, 0.45 * cot), (0.67, 0.67 * cot), (1.0, 0.44 * cot))


def _of_balls(bearing: Bearing, alpha: float, rows: int) -> Factors:
    if _deep_groove(bearing):
        return Factors(BALL_E[0], (1.0, 0.0), (0.56, BALL_Y[0]), (0.6, 0.5))
    if not 20.0 <= alpha <= 45.0:
        raise InputError(
            f"contact angle of {bearing.name} is {alpha:g} deg: X, Y and e are known for deep "
            "grooves and from 20 to 45 deg; give those of its catalogue"
        )
    grid = np.array([[angle, *values] for angle, values in ANGULAR.items()]).T
    e, X, Y, Y1, X2, Y2 = (float(np.interp(alpha, grid[0], column)) for column in grid[1:])
    static = float(np.interp(alpha, grid[0], STATIC_Y))
    if rows == 1:
        return Factors(e, (1.0, 0.0), (X, Y), (0.5, static))
    return Factors(e, (1.0, Y1), (X2, Y2), (1.0, 2.0 * static))


def _deep_groove(bearing: Bearing) -> bool:
    return all(isinstance(row, BallRow) and abs(row.angle) < 1e-6 for row in bearing.rows)


def _parts(loads: ArrayLike) -> tuple[Floats, Floats]:
    """Sizes of radial and axial force."""
    F = np.atleast_2d(np.asarray(loads, dtype=float))
    return np.hypot(F[:, 1], F[:, 2]), np.abs(F[:, 0])


def rated_bearing(
    bearing: Bearing,
    dynamic: float | None = None,
    static: float | None = None,
    fatigue: float | None = None,
    *,
    b_m: float = 1.1,
    factors: Factors | None = None,
) -> RatedBearing:
    """A bearing with ratings that are printed, and those from its rollers where none is.

    Parameters
    ----------
    bearing : Bearing
        Bearing of one kind of rolling elements.
    dynamic, static, fatigue : float, optional
        C, C_0 and C_u [N].
    b_m : float
        See `fe_drivetrain.bearing.ratings`.
    factors : Factors, optional
        Factors of a catalogue.

    Returns
    -------
    rated : RatedBearing
        With the source of each rating.

    Raises
    ------
    InputError
        The rows differ from each other, or are beyond the tables of the standards.
    """
    given = (dynamic, static, fatigue)
    if isinstance(bearing.rows[0], BallRow):
        of_balls = static if static is not None else ball_static_rating(bearing)
        smaller = min(0.1 / (2.0 * bearing.arm), 1.0) ** 0.5
        moving = dynamic if dynamic is not None else ball_dynamic_rating(bearing)
        own = (moving, of_balls, of_balls / FATIGUE_OF_BALLS * smaller)
    elif None in given:
        computed = ratings(bearing, b_m)
        given_over_own = 1.0 if static is None else static / computed.static
        own = (computed.dynamic, computed.static, computed.fatigue * given_over_own)
    else:
        own = (1.0, 1.0, 1.0)
    C, C0, C_u = (o if g is None else g for g, o in zip(given, own, strict=True))
    words = [f"from its rolling elements by {by}" for by in ("ISO 281", "ISO 76", "ISO 281")]
    sources = ["given" if g is not None else w for g, w in zip(given, words, strict=True)]
    return RatedBearing(bearing, C, C0, C_u, (sources[0], sources[1], sources[2]), factors)


def ball_static_rating(bearing: Bearing) -> float:
    """C_0 = f_0 i Z D^2 cos(alpha) of radial ball bearings, f_0 being 14 (ISO 76), N and mm."""
    row = bearing.rows[0]
    assert isinstance(row, BallRow)
    return float(F_0 * sum(bearing.counts) * (1e3 * row.diameter) ** 2 * np.cos(row.angle))


def rated_from_catalogue(name: Named, *more: str | Path, **changes: Any) -> RatedBearing:
    """A bearing of a catalogue with the ratings that it prints, and those from its rollers.

    Parameters
    ----------
    name : str or CataloguePage
        Name of the entry, or a page, whose ratings and factors are then taken alone.
    *more : str or Path
        Catalogue files beside the package's.
    **changes : Any
        Fields of `fe_drivetrain.bearing.Entry`, as ``crown=0.00045``.

    Returns
    -------
    rated : RatedBearing
        Named as the entry.

    Raises
    ------
    InputError
        No such entry, or values that do not fit.
    """
    return rated_entry(catalogue_entry(name, *more, **changes), name_of(name))


def rated_entry(entry: Entry, name: str) -> RatedBearing:
    """An entry of a catalogue with the ratings that it prints, and those from its rollers.

    Parameters
    ----------
    entry : Entry
        The entry. One of a catalogue's page has the factors of the page, and its mean diameter.
    name : str
        Name of the bearing.

    Raises
    ------
    InputError
        The rows differ from each other, or are beyond the tables of the standards.
    """
    printed = entry.ratings or entry.page
    ratings_of = (None, None, None) if printed is None else (printed.C, printed.C0, printed.Cu)
    b_m = B_M.get(entry.kind, 1.1)
    rated = rated_bearing(entry.bearing(name), *ratings_of, b_m=b_m)
    source = entry.sources.get("ratings", entry.page.source if entry.page else "given")
    words = [source if text == "given" else text for text in rated.sources]
    found = replace(
        rated, sources=(words[0], words[1], words[2]), limiting_speed_rpm=entry.limiting_speed_rpm
    )
    page = entry.page
    if page is None:
        return found
    return replace(
        found,
        factors=page_factors(page),
        f_0=F_0 if page.f0 is None else page.f0,
        mean_diameter=page.mean_diameter,
    )


def page_factors(page: CataloguePage) -> Factors | None:
    """X, Y and e as a catalogue's page prints them, what is left out by the contact angle.

    Parameters
    ----------
    page : CataloguePage
        The page.

    Returns
    -------
    factors : Factors or None
        None where the page says nothing of axial loads, and of deep grooves, whose factors follow
        the load.
    """
    if page.e is None and page.Y is None and page.Y1 is None and page.Y2 is None:
        return None
    if page.of_kind == "ball" or page.angle is None:
        return None
    e = page.e if page.e is not None else 1.5 * tan(radians(page.angle))
    if page.row_count == 1:
        Y, Y0 = page.Y or 0.6 / e, page.Y0 or 0.33 / e
        return Factors(e, (1.0, 0.0), (0.4, Y), (0.5, Y0))
    Y1, Y2, Y0 = page.Y1 or 0.675 / e, page.Y2 or 1.005 / e, page.Y0 or 0.66 / e
    return Factors(e, (1.0, Y1), (0.67, Y2), (1.0, Y0))
