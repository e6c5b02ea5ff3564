"""Stiffness of teeth in mesh by ISO 6336-1 method B: mean values for steel gears.

All are in the transverse plane along the line of action, per length of face: N/m^2, where
1 N/(mm um) is 1e9 N/m^2. Formulas and constants of ISO 6336-1:2006, clause 9; they give the digits
printed in ISO/TR 6336-30 and in reports of KISSsoft 03/2017 (`cases/gear`).
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, degrees, exp, log

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.involute import Gear, Pair

UNIT = 1e9
"""N/m^2 in 1 N/(mm um)."""

CORRECTION = 0.8
"""C_M: measured stiffness over the theoretical one of solid discs."""

LOW_LOAD = 1e5
"""Specific load below which stiffness falls with load: 100 N/mm in N/m."""

STEEL = 206e9
"""Young's modulus that the formulas are for [Pa]."""


@dataclass(frozen=True)
class IsoStiffness:
    """Stiffness by ISO 6336-1 method B [N/m^2].

    Attributes
    ----------
    theoretical : float
        c'_th, of one pair of solid discs, without corrections.
    single : float
        c', maximum stiffness of one pair over the path of contact.
    mesh : float
        c_gamma_alpha, mean of all pairs in contact.
    misaligned : float
        c_gamma_beta, for the distribution of load over the face width.
    """

    theoretical: float
    single: float
    mesh: float
    misaligned: float


def theoretical_stiffness(pair: Pair) -> float:
    """Single-pair stiffness of solid discs in the normal section, c'_th = 1 / q'.

    Parameters
    ----------
    pair : Pair
        External or internal; an internal gear has infinite z_n2 and its own shift. The pinion, of
        index 1 in the formula, is the gear with fewer teeth, whichever comes first.

    Returns
    -------
    float
        Stiffness per face width [N/m^2].
    """
    first, second = sorted((pair.first, pair.second), key=lambda gear: abs(gear.teeth))
    one = 1.0 / first.virtual_teeth
    two = 0.0 if second.internal else 1.0 / second.virtual_teeth
    x1, x2 = first.shift, second.shift
    flexibility = (
        0.04723
        + 0.15551 * one
        + 0.25791 * two
        - 0.00635 * x1
        - 0.11654 * x1 * one
        - 0.00193 * x2
        - 0.24188 * x2 * two
        + 0.00529 * x1**2
        + 0.00182 * x2**2
    )
    return UNIT / flexibility


def blank_factor(web: float, rim: float) -> float:
    """Factor of the gear blank, C_R.

    Parameters
    ----------
    web : float
        Thickness of the web over the face width, b_s / b; held between 0.2 and 1.2 as the standard
        has it.
    rim : float
        Thickness of the rim below the teeth over the normal module, s_R / m_n, 1 or more.

    Returns
    -------
    float
        1 for a solid disc (web = 1).

    Raises
    ------
    InputError
        If a thickness is not positive, or the rim thinner than a module.
    """
    if not web > 0.0:
        raise InputError(f"a web of {web:g} face widths: it must be positive, 1 for a solid disc")
    if not rim >= 1.0:
        raise InputError(
            f"a rim of {rim:g} modules below the teeth: the factor of the blank holds from 1 on"
        )
    return 1.0 + log(min(max(web, 0.2), 1.2)) / (5.0 * exp(rim / 5.0))


def rack_factor(gear: Gear) -> float:
    """Factor of the basic rack, C_B.

    Parameters
    ----------
    gear : Gear
        Gear whose rack it is.

    Returns
    -------
    float
        1 for a dedendum of 1.2 modules and 20 degrees.
    """
    height = 1.0 + 0.5 * (1.2 - gear.rack.dedendum)
    return height * (1.0 - 0.02 * (20.0 - degrees(gear.pressure_angle)))


def iso_gear_stiffness(
    pair: Pair,
    specific_load: float | None = None,
    blank: float = 1.0,
    youngs_modulus: float = STEEL,
) -> IsoStiffness:
    """Stiffness of a pair by ISO 6336-1 method B.

    Parameters
    ----------
    pair : Pair
        External or internal.
    specific_load : float, optional
        F_t K_A / b [N/m]; below 100 N/mm stiffness falls with its fourth root. Without one it
        is taken as at least that.
    blank : float
        C_R, mean of both gears: see `blank_factor`.
    youngs_modulus : float
        Young's modulus of both gears [Pa]; stiffness goes with E / E_steel.

    Returns
    -------
    IsoStiffness
        The mesh's is c' (0.75 epsilon_alpha + 0.25), the misaligned 0.85 of that.

    Raises
    ------
    InputError
        If the specific load, the blank's factor or the modulus is not positive.
    """
    for name, value in (
        ("specific load", LOW_LOAD if specific_load is None else specific_load),
        ("factor of the blank", blank),
        ("Young's modulus", youngs_modulus),
    ):
        if not value > 0.0:
            raise InputError(f"the {name} of a gear pair is {value:g}: it must be positive")
    theoretical = theoretical_stiffness(pair)
    rack = 0.5 * (rack_factor(pair.first) + rack_factor(pair.second))
    single = theoretical * CORRECTION * blank * rack * cos(pair.first.helix)
    single *= youngs_modulus / STEEL
    if specific_load is not None and specific_load < LOW_LOAD:
        single *= (specific_load / LOW_LOAD) ** 0.25
    mesh = single * (0.75 * pair.transverse_ratio + 0.25)
    return IsoStiffness(theoretical, single, mesh, 0.85 * mesh)
