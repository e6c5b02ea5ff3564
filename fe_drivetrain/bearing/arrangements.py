"""Rows and whole bearings from catalogue data: diameters in metres, contact angles in degrees."""

from __future__ import annotations

from math import cos, radians, tan
from typing import Literal

from fe_drivetrain.bearing.contact import (
    ContactLaw,
    houpert,
    in_series,
    iso_line,
    point_contact,
)
from fe_drivetrain.bearing.geometry import BallRow, Bearing, RollerRow, check_sizes
from fe_drivetrain.common.errors import InputError, require_known

Arrangement = Literal["X", "O"]
"""Face to face (X, TDI: contact lines meet outside) or back to back (O, TDO)."""


def tapered_row(
    rollers: int,
    diameter: float,
    length: float,
    pitch_diameter: float,
    contact_angle_deg: float,
    place: float = 0.0,
    thrust: Literal[1, -1] = 1,
    law: ContactLaw | None = None,
    **more: float | int,
) -> RollerRow:
    """One row of tapered rollers; their taper is neglected (Stirling 2023, 4.2.2).

    Parameters
    ----------
    rollers : int
        Number of rollers.
    diameter, length, pitch_diameter : float
        Sizes of a roller, and diameter of the circle of their middles [m].
    contact_angle_deg : float
        Mean contact angle of inner and outer race [deg], between 0 and 90.
    place : float
        Axial place x of the rollers' middles [m].
    thrust : int
        1: it carries an inner ring that is pushed downwind; -1: upwind.
    law : ContactLaw, optional
        Contact law of a roller; `houpert` where left out.
    **more : float
        Further fields of `RollerRow`: clearance, laminae, crown, phase.

    Returns
    -------
    row : RollerRow
        Row of tapered rollers.

    Raises
    ------
    InputError
        The thrust is neither 1 nor -1, or sizes do not fit each other.
    """
    require_known("thrust of a tapered row", thrust, (1, -1))
    alpha = _inclined("tapered row", contact_angle_deg)
    return RollerRow(
        rollers,
        place,
        0.5 * pitch_diameter,
        thrust * alpha,
        diameter,
        length,
        law or houpert(length, diameter),
        **more,  # type: ignore[arg-type]
    )


def double_row_tapered(
    name: str,
    rollers: int,
    diameter: float,
    length: float,
    pitch_diameter: float,
    contact_angle_deg: float,
    spread: float,
    arrangement: Arrangement,
    law: ContactLaw | None = None,
    **more: float | int,
) -> Bearing:
    """Two rows of tapered rollers about the bearing's centre.

    Parameters
    ----------
    name : str
        Name of the bearing.
    rollers : int
        Number of rollers in each row.
    diameter, length, pitch_diameter : float
        Sizes of a roller, and diameter of the circle of their middles [m].
    contact_angle_deg : float
        Contact angle [deg], between 0 and 90.
    spread : float
        Distance of the rows' middles [m].
    arrangement : str
        "X": a push downwind loads the downwind row (TDI); "O": the upwind row (TDO).
    law : ContactLaw, optional
        Contact law of a roller; `houpert` where left out.
    **more : float
        Further fields of `RollerRow`: clearance, laminae, crown, phase.

    Returns
    -------
    bearing : Bearing
        Bearing with the upwind row first.
    """
    if arrangement not in ("X", "O"):
        raise InputError(f"arrangement {arrangement!r} of {name}: give X (face to face) or O")
    if not spread > 0.0:
        raise InputError(f"rows of {name} are {spread:g} m apart: give a positive distance")
    sign: Literal[1, -1] = 1 if arrangement == "X" else -1
    upwind: Literal[1, -1] = -1 if sign == 1 else 1
    return Bearing(
        name,
        tuple(
            tapered_row(
                rollers,
                diameter,
                length,
                pitch_diameter,
                contact_angle_deg,
                place,
                thrust,
                law,
                **more,
            )
            for place, thrust in ((-0.5 * spread, upwind), (0.5 * spread, sign))
        ),
    )


def spherical_roller(
    name: str,
    rollers: int,
    diameter: float,
    length: float,
    pitch_diameter: float,
    contact_angle_deg: float,
    law: ContactLaw | None = None,
    **more: float | int,
) -> Bearing:
    """Two rows of barrel rollers on an outer race that is a sphere about the bearing's centre.

    Parameters
    ----------
    name : str
        Name of the bearing.
    rollers : int
        Number of rollers in each row.
    diameter, length, pitch_diameter : float
        Sizes of a roller, and diameter of the circle of their middles [m].
    contact_angle_deg : float
        Contact angle [deg], between 0 and 90; the rows stand where their contact normals meet in
        the centre.
    law : ContactLaw, optional
        Contact law of a roller; `iso_line` where left out: the conformity is close, and a roller
        under load touches along its length.
    **more : float
        Further fields of `RollerRow`: clearance, laminae, crown, phase.

    Returns
    -------
    bearing : Bearing
        Bearing that carries no moment: a load with one is refused.
    """
    alpha = _inclined("spherical roller bearing", contact_angle_deg)
    rows = tuple(
        RollerRow(
            rollers,
            side * 0.5 * pitch_diameter * tan(alpha),
            0.5 * pitch_diameter,
            side * alpha,
            diameter,
            length,
            law or iso_line(length),
            aligning=True,
            **more,  # type: ignore[arg-type]
        )
        for side in (-1.0, 1.0)
    )
    return Bearing(name, rows)


def cylindrical(
    name: str,
    rollers: int,
    diameter: float,
    length: float,
    pitch_diameter: float,
    places: tuple[float, ...] = (0.0,),
    law: ContactLaw | None = None,
    **more: float | int,
) -> Bearing:
    """Rows of cylindrical rollers: they float along the axis, and carry tilt by their length.

    Parameters
    ----------
    name : str
        Name of the bearing.
    rollers : int
        Number of rollers in each row.
    diameter, length, pitch_diameter : float
        Sizes of a roller, and diameter of the circle of their middles [m].
    places : tuple of float
        Axial place x of each row's middles [m].
    law : ContactLaw, optional
        Contact law of a roller; `iso_line` where left out.
    **more : float
        Further fields of `RollerRow`: clearance, laminae, crown, phase.

    Returns
    -------
    bearing : Bearing
        Bearing that carries no axial force: a load with one is refused.
    """
    rows = tuple(
        RollerRow(
            rollers,
            place,
            0.5 * pitch_diameter,
            0.0,
            diameter,
            length,
            law or iso_line(length),
            **more,  # type: ignore[arg-type]
        )
        for place in places
    )
    return Bearing(name, rows)


def toroidal(
    name: str,
    rollers: int,
    diameter: float,
    length: float,
    pitch_diameter: float,
    law: ContactLaw | None = None,
    **more: float | int,
) -> Bearing:
    """One row of long barrel rollers on toroidal races (CARB): it floats along the axis and tilts.

    Parameters
    ----------
    name : str
        Name of the bearing.
    rollers : int
        Number of rollers.
    diameter, length, pitch_diameter : float
        Sizes of a roller, and diameter of the circle of their middles [m].
    law : ContactLaw, optional
        Contact law of a roller; `iso_line` where left out.
    **more : float
        Further fields of `RollerRow`: clearance, laminae, crown, phase.

    Returns
    -------
    bearing : Bearing
        Bearing that carries radial force alone. Loss of its clearance by floating is not in it: see
        `toroidal_clearance_loss`.
    """
    row = RollerRow(
        rollers,
        0.0,
        0.5 * pitch_diameter,
        0.0,
        diameter,
        length,
        law or iso_line(length),
        aligning=True,
        **more,  # type: ignore[arg-type]
    )
    return Bearing(name, (row,))


def ball_row(
    balls: int,
    diameter: float,
    pitch_diameter: float,
    contact_angle_deg: float = 0.0,
    place: float = 0.0,
    inner_conformity: float = 0.52,
    outer_conformity: float = 0.53,
    radial_clearance: float = 0.0,
    youngs_modulus: float = 206e9,
    phase: float = 0.0,
) -> BallRow:
    """A row of balls, deep groove or angular contact, with Hertz's law from its curvatures.

    Parameters
    ----------
    balls : int
        Number of balls.
    diameter, pitch_diameter : float
        Diameter of a ball, and of the circle of their centres [m].
    contact_angle_deg : float
        Contact angle [deg]: 0 is a deep groove; its sign says which push of the inner ring the row
        carries.
    place : float
        Axial place x of the balls' centres [m].
    inner_conformity, outer_conformity : float
        Radius of a groove over the diameter of a ball; the defaults are those of ISO/TS 16281.
    radial_clearance : float
        Radial internal clearance [m], of the diameter.
    youngs_modulus : float
        Young's modulus of balls and rings [Pa].
    phase : float
        Angle of the first ball [rad].

    Returns
    -------
    row : BallRow
        Row of balls.
    """
    if not -90.0 < contact_angle_deg < 90.0:
        raise InputError(
            f"contact angle of {contact_angle_deg:g} deg: a ball bearing with races inside each "
            "other needs one between -90 and 90 deg"
        )
    alpha = radians(contact_angle_deg)
    check_sizes(diameter, 0.5 * pitch_diameter)
    gamma = diameter * cos(alpha) / pitch_diameter
    across = 2.0 / diameter
    contacts = [
        point_contact(
            (
                across * (1.0 + sign * gamma / (1.0 - sign * gamma)),
                across - 1.0 / (conformity * diameter),
            ),
            youngs_modulus,
        )
        for sign, conformity in ((1.0, inner_conformity), (-1.0, outer_conformity))
    ]
    return BallRow(
        balls,
        place,
        0.5 * pitch_diameter,
        alpha,
        diameter,
        inner_conformity * diameter,
        outer_conformity * diameter,
        in_series(*contacts),
        0.5 * radial_clearance * cos(alpha),
        phase,
    )


def _inclined(what: str, contact_angle_deg: float) -> float:
    """A contact angle that must carry both axial and radial force [rad]."""
    if not 0.0 < contact_angle_deg < 90.0:
        raise InputError(
            f"contact angle of a {what} is {contact_angle_deg:g} deg: it must be between 0 and 90 "
            "deg; use a cylindrical bearing for 0"
        )
    return radians(contact_angle_deg)
