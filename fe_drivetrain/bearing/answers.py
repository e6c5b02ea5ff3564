"""Answers at given displacements: load zones, laminae, pressures, stiffness."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.contact import STEEL_E, PointContact, line_pressure, point_contact
from fe_drivetrain.bearing.contact_forces import elements, forces
from fe_drivetrain.bearing.geometry import BallRow, Bearing, RollerRow, Row, angles, pitch_ratio
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr

_GAUSS_POINTS = 32


@dataclass(frozen=True)
class LoadZone:
    """Which rolling elements of one row carry, over n cases.

    Attributes
    ----------
    loaded : Ints
        Number (n,) of loaded rolling elements.
    peak, total : Floats
        Maximum load (n,), and sum of all loads [N].
    at_deg : Floats
        Angle (n,) of the maximum load [deg], 0 to 360.
    centre_deg : Floats
        Direction (n,) of the row's radial force [deg]; not a number without one.
    """

    loaded: Ints
    peak: Floats
    total: Floats
    at_deg: Floats
    centre_deg: Floats

    __repr__ = short_repr


def by_row(bearing: Bearing, values: Floats) -> list[Floats]:
    """Columns of all rolling elements, row by row.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    values : Floats
        Values (n, total), as from `roller_loads`.

    Returns
    -------
    rows : list of Floats
        Values (n, elements of the row) of each row.
    """
    return np.split(values, np.cumsum(bearing.counts)[:-1], axis=1)


def load_zones(bearing: Bearing, displacements: ArrayLike) -> list[LoadZone]:
    """The load zone of each row.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    displacements : array_like
        Displacements (n, 5) [m, rad].

    Returns
    -------
    zones : list of LoadZone
        One for each row.
    """
    loads, _, contact_angles = elements(bearing, displacements)
    found = []
    for row, Q, alpha in zip(
        bearing.rows, by_row(bearing, loads), by_row(bearing, contact_angles), strict=True
    ):
        psi = angles(row)
        radial = (Q * np.cos(alpha)) @ np.exp(1j * psi)
        none = np.abs(radial) <= 1e-9 * Q.sum(axis=1)
        centre = np.where(none, np.nan, np.degrees(np.angle(radial)) % 360.0)
        found.append(
            LoadZone(
                (Q > 0.0).sum(axis=1),
                Q.max(axis=1),
                Q.sum(axis=1),
                np.degrees(psi[Q.argmax(axis=1)]) % 360.0,
                centre,
            )
        )
    return found


def lamina_loads(row: RollerRow, displacements: ArrayLike) -> Floats:
    """Load of each lamina of each roller of a row.

    Parameters
    ----------
    row : RollerRow
        Row with one lamina or more.
    displacements : array_like
        Displacements (n, 5) or (5,) [m, rad].

    Returns
    -------
    loads : Floats
        Loads (n, rollers, laminae) [N].
    """
    n_laminae = max(row.laminae, 1)
    return row.law.load(approaches(row, displacements)) / n_laminae


def laminae_of_contacts(row: RollerRow, approach: ArrayLike, lean: ArrayLike) -> Floats:
    """Load of each lamina where every roller has its own deflection, as on elastic rings.

    Parameters
    ----------
    row : RollerRow
        Row with one lamina or more.
    approach, lean : array_like
        Approach (n, rollers) of the races at the roller's middle [m], and lean along the roller
        [rad], as `fe_drivetrain.bearing_life.rings.AssemblyEquilibrium.deflections` has them.

    Returns
    -------
    loads : Floats
        Loads (n, rollers, laminae) [N].
    """
    middle, t = np.asarray(approach, dtype=float), np.asarray(lean, dtype=float)
    along = 0.0 * row.places if row.aligning else row.places
    whole = middle[..., None] + t[..., None] * along - row.clearance - row.free
    return row.law.load(whole) / max(row.laminae, 1)


def approaches(row: RollerRow, displacements: ArrayLike) -> Floats:
    """Approach of the races at each lamina, negative where they are apart.

    Parameters
    ----------
    row : RollerRow
        Row with one lamina or more.
    displacements : array_like
        Displacements (n, 5) or (5,) [m, rad].

    Returns
    -------
    approach : Floats
        Approach (n, rollers, laminae) [m]: Stirling 2023, Eq 4.13, less clearance and profile.
    """
    u = np.atleast_2d(np.asarray(displacements, dtype=float))
    psi = angles(row)
    e_r = np.vstack([-np.cos(psi), np.sin(psi)])
    tangent = np.vstack([-np.sin(psi), -np.cos(psi)])
    w, t = u[:, 1:3] @ e_r, u[:, 3:] @ tangent
    lean = 0.0 if row.aligning else 1.0
    middle = u[:, :1] * np.sin(row.angle) + w * np.cos(row.angle) + lean * row.arm * t
    along = lean * row.places
    whole: Floats = middle[..., None] + t[..., None] * along - row.clearance - row.free
    return whole


def end_loads(row: RollerRow, displacements: ArrayLike) -> Floats:
    """Relative load of each roller's ends: load per length there over that of the whole roller.

    Parameters
    ----------
    row : RollerRow
        Row with laminae.
    displacements : array_like
        Displacements (n, 5) [m, rad].

    Returns
    -------
    ends : Floats
        Relative end loads (n, rollers, 2), upwind end first: 1 is an even load, more is edge
        loading, 0 an end that is free; 0 of unloaded rollers. The thesis's difference of two end
        laminae is the difference of these two times the load over the number of laminae.
    """
    q = lamina_loads(row, displacements)
    mean = q.mean(axis=2, keepdims=True)
    ends: Floats = np.divide(
        q[..., [0, -1]], mean, out=np.zeros((*q.shape[:2], 2)), where=mean > 0.0
    )
    return ends


def ball_contacts(
    row: BallRow, youngs_modulus: float = STEEL_E
) -> tuple[PointContact, PointContact]:
    """Hertz's contacts of a ball with the inner and the outer race.

    Parameters
    ----------
    row : BallRow
        Row of balls.
    youngs_modulus : float
        Young's modulus of balls and rings [Pa].

    Returns
    -------
    inner, outer : PointContact
        Contacts with curvatures at the unloaded contact angle.
    """
    across, gamma = 2.0 / row.diameter, pitch_ratio(row)
    inner, outer = (
        point_contact(
            (across * (1.0 + side * gamma / (1.0 - side * gamma)), across - 1.0 / groove),
            youngs_modulus,
        )
        for side, groove in ((1.0, row.inner_groove), (-1.0, row.outer_groove))
    )
    return inner, outer


def pressures(
    bearing: Bearing, displacements: ArrayLike, youngs_modulus: float = STEEL_E
) -> list[tuple[Floats, Floats]]:
    """Maximum Hertz pressure of each rolling element on the inner and on the outer race.

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    displacements : array_like
        Displacements (n, 5) [m, rad].
    youngs_modulus : float
        Young's modulus of rolling elements and rings [Pa].

    Returns
    -------
    pressures : list of tuple
        Pressures for each row, (n, elements) on the inner and on the outer race [Pa]: line contact
        of the lamina with the maximum load (a barrel roller counts as a cylinder), point contact of
        balls.
    """
    loads = by_row(bearing, elements(bearing, displacements)[0])
    return [
        race_pressures(row, Q, 1, youngs_modulus)
        if isinstance(row, BallRow)
        else race_pressures(
            row,
            lamina_loads(row, displacements).max(axis=2),
            max(row.laminae, 1),
            youngs_modulus,
        )
        for row, Q in zip(bearing.rows, loads, strict=True)
    ]


def race_pressures(
    row: Row, loads: ArrayLike, laminae: int = 1, youngs_modulus: float = STEEL_E
) -> tuple[Floats, Floats]:
    """Maximum Hertz pressures on inner and outer race under loads of laminae, or balls.

    Parameters
    ----------
    row : RollerRow or BallRow
        Row of rollers or balls.
    loads : array_like
        Loads of laminae, or of balls [N], any shape.
    laminae : int
        Number of equal laminae that a roller is cut into.
    youngs_modulus : float
        Young's modulus of rolling elements and rings [Pa].

    Returns
    -------
    inner, outer : Floats
        Pressures in the shape of the loads [Pa]: line contact of a lamina, point contact of a ball.
    """
    Q = np.asarray(loads, dtype=float)
    if isinstance(row, BallRow):
        inner, outer = ball_contacts(row, youngs_modulus)
        return inner.pressure(Q), outer.pressure(Q)
    gamma, q = pitch_ratio(row), Q * laminae / row.length
    return (
        line_pressure(q, 2.0 / row.diameter / (1.0 - gamma), youngs_modulus),
        line_pressure(q, 2.0 / row.diameter / (1.0 + gamma), youngs_modulus),
    )


def truncations(
    row: BallRow,
    displacements: ArrayLike,
    shoulders: tuple[float, float] = (0.2, 0.2),
    youngs_modulus: float = STEEL_E,
) -> tuple[Floats, Floats]:
    """Share of each ball's contact ellipse that runs over the shoulder of its groove.

    Parameters
    ----------
    row : BallRow
        Row of balls, treated as a bearing of its own.
    displacements : array_like
        Displacements (n, 5) or (5,) [m, rad].
    shoulders : tuple of float
        Height of the inner and of the outer ring's shoulder above the bottom of the groove, over
        the ball's diameter; catalogues do not give it, a fifth is assumed.
    youngs_modulus : float
        Young's modulus of balls and rings [Pa].

    Returns
    -------
    inner, outer : Floats
        Share (n, balls) of the ellipse's long axis beyond the shoulder: 0 where it ends in the
        groove. Contact is still that of whole ellipses: a share that is not zero says that pressure
        and deflection are too low, and that the edge is loaded.

    Raises
    ------
    InputError
        A shoulder is not between 0 and half of the ball.

    Notes
    -----
    The ellipse lies on a surface whose radius is the mean of ball and groove in curvature (Harris
    and Kotzalas 2007, Rolling bearing analysis, section 6.3, as quoted); the shoulder begins where
    the groove has risen to its height.
    """
    loads, _, contact_angles = elements(Bearing("balls", (row,)), displacements)
    found = []
    for contact, groove, height, name in zip(
        ball_contacts(row, youngs_modulus),
        (row.inner_groove, row.outer_groove),
        shoulders,
        ("inner", "outer"),
        strict=True,
    ):
        if not 0.0 < height < 0.5:
            raise InputError(
                f"{name} shoulder is {height:g} of the ball's diameter: give more than 0 and less "
                "than 0.5"
            )
        surface = 2.0 * groove * row.diameter / (2.0 * groove + row.diameter)
        half = np.arcsin(np.minimum(contact.half_axes[0] * np.cbrt(loads) / surface, 1.0))
        edge = np.arccos(1.0 - height * row.diameter / groove)
        over = np.abs(contact_angles) + half - edge
        share = np.divide(over, 2.0 * half, out=np.zeros_like(over), where=half > 0.0)
        found.append(np.clip(share, 0.0, 1.0))
    return found[0], found[1]


def toroidal_clearance_loss(width: float, axial: ArrayLike, factor: float = 0.1) -> Floats:
    """Radial internal clearance that a toroidal bearing (CARB) loses as it floats.

    Parameters
    ----------
    width : float
        B [m].
    axial : array_like
        Displacement of one ring from the middle of the other [m].
    factor : float
        k_2 of the catalogue, some 0.1.

    Returns
    -------
    lost : Floats
        k_2 s^2 / B [m], of the diametral clearance: what two circular profiles with centres B / k_2
        apart lose. SKF's catalogue has B, k_2 and the loss (C 3052: 104 mm, 0.096); the formula is
        recalled from it, not read again. Along the contact normal it is half of that, to be taken
        from `RollerRow.clearance`; as long as some is left, floating needs no axial force.

    Raises
    ------
    InputError
        Width or factor is not positive.
    """
    for name, value in (("width", width), ("factor", factor)):
        if not value > 0.0:
            raise InputError(f"{name} of a toroidal bearing is {value:g}: it must be positive")
    return np.asarray(factor * np.asarray(axial, dtype=float) ** 2 / width)


def secant_stiffness(bearing: Bearing, displacements: ArrayLike) -> Floats:
    """The stiffness that a linear spring would need: K_s u = F(u) - F(0).

    Parameters
    ----------
    bearing : Bearing
        The bearing.
    displacements : array_like
        Displacements (n, 5) or (5,) [m, rad].

    Returns
    -------
    secants : Floats
        Secant stiffness (n, 5, 5): the mean of the tangent stiffness on the straight way to u;
        symmetric. At zero clearance it is the tangent over the exponent of the contact law.
    """
    u = np.atleast_2d(np.asarray(displacements, dtype=float))
    x, w = np.polynomial.legendre.leggauss(_GAUSS_POINTS)  # type: ignore[no-untyped-call]
    s = 0.5 * (x + 1.0)
    total = np.zeros((len(u), 5, 5))
    # t = s^4: tangents go as t^(1/10) near zero
    for here, weight in zip(s, w, strict=True):
        total += 0.5 * weight * 4.0 * here**3 * forces(bearing, here**4 * u)[1]
    return total
