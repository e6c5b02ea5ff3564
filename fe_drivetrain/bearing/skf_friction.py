"""Friction moment of rolling bearings by the model that SKF publishes: rolling and sliding.

M = M_rr + M_sl: phi_ish phi_rs G_rr (nu n)^0.6 with inlet shear heating and starvation, and
G_sl mu_sl, where mu_sl goes from boundary to full-film friction as the film grows. Forms of G and
of the factors: SKF, Rolling bearings (2016), p. 106, and public programs that use them. Constants
of deep groove balls and of the spherical series 222 E are those of such programs; all others are
from memory of the same publication and not verified. Seals are those of the catalogue of 2006 as a
public program (thermca) has them. Drag in an oil bath is left out: its diagram V_M was not found.
"""

from __future__ import annotations

from collections.abc import Mapping
from math import radians, sin

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.friction import (
    FrictionBearing,
    FrictionMoment,
    Supply,
    axial_of_rows,
)
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import RPM
from fe_drivetrain.common.errors import InputError

Constants = Mapping[str, tuple[float, ...]]

BALLS: Constants = {
    "62": (3.9e-7, 1.7, 3.23e-3, 36.5),
    "63": (3.7e-7, 1.7, 2.84e-3, 92.8),
    "60": (4.1e-7, 1.7, 3.73e-3, 14.6),
    "64": (3.6e-7, 1.7, 2.43e-3, 198.0),
    "160": (4.3e-7, 1.7, 4.63e-3, 4.25),
    "619": (4.3e-7, 1.7, 4.75e-3, 3.6),
}
"""R1, R2, S1, S2 of deep groove ball bearings by series."""

ANGULAR_BALLS: Constants = {"72": (5.03e-7, 1.97, 1.90e-12, 1.30e-2, 0.68, 1.91e-12)}
"""R1, R2, R3, S1, S2, S3 of single-row angular contact ball bearings."""

CYLINDRICAL: Constants = {
    "NU2": (1.09e-6, 0.16, 0.0015),
    "NU4": (1.00e-6, 0.16, 0.0015),
    "NU10": (1.12e-6, 0.16, 0.0015),
    "NU20": (1.23e-6, 0.16, 0.0015),
    "NU22": (1.40e-6, 0.16, 0.0015),
    "NU23": (1.48e-6, 0.16, 0.0015),
    "NCF": (2.13e-6, 0.16, 0.0015),
}
"""R1, S1, S2 of cylindrical roller bearings; NU is N, NJ and NUP, too, NCF all without a cage."""

TAPERED: Constants = {
    "302": (1.76e-6, 10.9, 0.017, 2.0),
    "303": (1.69e-6, 10.9, 0.017, 2.0),
    "313": (1.84e-6, 10.9, 0.048, 2.0),
    "320X": (2.38e-6, 10.9, 0.014, 2.0),
    "322": (2.27e-6, 10.9, 0.018, 2.0),
    "322B": (2.38e-6, 10.9, 0.026, 2.0),
    "323": (2.38e-6, 10.9, 0.019, 2.0),
    "323B": (2.79e-6, 10.9, 0.030, 2.0),
    "329": (2.31e-6, 10.9, 0.009, 2.0),
    "330": (2.71e-6, 11.3, 0.010, 2.0),
    "331": (2.71e-6, 10.9, 0.015, 2.0),
    "332": (2.71e-6, 10.9, 0.018, 2.0),
}
"""R1, R2, S1, S2 of single-row tapered roller bearings."""

SPHERICAL: Constants = {
    "222E": (1.6e-6, 5.84, 2.81e-6, 5.8, 3.62e-3, 508.0, 8.8e-3, 117.0),
    "222": (2.0e-6, 5.54, 2.92e-6, 5.5, 5.10e-3, 414.0, 9.7e-3, 100.0),
    "223": (1.7e-6, 4.1, 3.13e-6, 4.05, 6.92e-3, 124.0, 1.7e-2, 41.0),
    "223E": (1.6e-6, 4.1, 3.14e-6, 4.05, 6.23e-3, 124.0, 1.7e-2, 41.0),
    "230": (2.4e-6, 6.44, 3.76e-6, 6.4, 4.13e-3, 755.0, 1.1e-2, 160.0),
    "231": (2.4e-6, 4.7, 4.04e-6, 4.72, 6.70e-3, 231.0, 1.7e-2, 65.0),
    "232": (2.3e-6, 4.1, 4.00e-6, 4.05, 8.66e-3, 126.0, 2.1e-2, 41.0),
    "238": (3.1e-6, 12.1, 3.82e-6, 12.0, 1.74e-3, 9495.0, 5.9e-3, 1057.0),
    "239": (2.7e-6, 8.53, 3.87e-6, 8.47, 2.77e-3, 2330.0, 8.5e-3, 371.0),
    "240": (2.9e-6, 4.87, 4.78e-6, 4.84, 6.95e-3, 240.0, 2.1e-2, 68.0),
    "241": (2.6e-6, 3.8, 4.79e-6, 3.7, 1.0e-2, 86.7, 2.9e-2, 31.0),
    "248": (3.8e-6, 9.4, 5.09e-6, 9.3, 2.80e-3, 3415.0, 1.2e-2, 486.0),
    "249": (3.0e-6, 6.67, 5.09e-6, 6.62, 3.90e-3, 887.0, 1.7e-2, 180.0),
}
"""R1 to R4, S1 to S4 of spherical roller bearings."""

TOROIDAL: Constants = {
    "C22": (1.17e-6, 2.08e-6, 1.32e-3, 0.8e-2),
    "C23": (1.20e-6, 2.28e-6, 1.24e-3, 0.9e-2),
    "C30": (1.40e-6, 2.59e-6, 1.58e-3, 1.0e-2),
    "C31": (1.37e-6, 2.77e-6, 1.30e-3, 1.1e-2),
    "C32": (1.33e-6, 2.63e-6, 1.31e-3, 1.1e-2),
    "C39": (1.45e-6, 2.55e-6, 1.84e-3, 1.0e-2),
    "C40": (1.53e-6, 3.15e-6, 1.50e-3, 1.3e-2),
    "C41": (1.49e-6, 3.11e-6, 1.32e-3, 1.3e-2),
}
"""R1, R2, S1, S2 of toroidal roller bearings with a cage."""

SERIES: Mapping[str, Constants] = {
    "ball": BALLS,
    "cylindrical": CYLINDRICAL,
    "single_row_tapered": TAPERED,
    "double_row_tapered": TAPERED,
    "spherical_roller": SPHERICAL,
    "toroidal": TOROIDAL,
}
"""Series by kind of bearing."""

K_Z = {
    "ball": 3.1,
    "angular ball": 4.4,
    "cylindrical": 5.1,
    "full complement": 6.2,
    "single_row_tapered": 6.0,
    "double_row_tapered": 6.0,
    "spherical_roller": 5.5,
    "toroidal": 5.3,
}
"""Constant of the geometry in starvation; those of balls in public programs, others from memory."""

K_RS = {"grease": 6e-8, "oil bath": 3e-8, "oil jet": 3e-8}
"""Constant of starvation by how the lubricant comes."""

FULL_FILM = {"cylindrical": 0.02, "single_row_tapered": 0.002, "double_row_tapered": 0.002}
"""Friction coefficient in a full film by kind of bearing."""

MINERAL_FILM = 0.05
"""The same of all other kinds, with mineral oil."""

SEALS = {
    "ball": (2.25, 0.018, 0.0),
    "cylindrical": (2.0, 0.032, 50.0),
    "spherical_roller": (2.0, 0.057, 50.0),
}
"""beta, K_S1, K_S2 of two seals by kind of bearing; balls from an outside diameter of 100 mm."""

BOUNDARY, STARTING = 0.12, 0.15
"""Friction coefficient without a film: in motion, and at standstill."""


def skf_friction(
    bearing: FrictionBearing,
    radial: ArrayLike,
    axial: ArrayLike,
    speed: ArrayLike,
    viscosity: float,
    supply: Supply = "oil jet",
    static_rating: float | None = None,
) -> FrictionMoment:
    """Friction moment by SKF's model, without drag in an oil bath.

    Parameters
    ----------
    bearing : FrictionBearing
        The bearing.
    radial, axial : array_like
        Forces on it, without a sign [N].
    speed : array_like
        Speed of one ring against the other, whose sign does not matter [rad/s].
    viscosity : float
        Kinematic viscosity of the oil, or base oil, in operation [m^2/s].
    supply : {"grease", "oil bath", "oil jet"}
        How it comes to the rollers.
    static_rating : float, optional
        C0 of balls in deep grooves under axial force [N].

    Returns
    -------
    moment : FrictionMoment
        Of the bearing's series; where that is not known, the median of all series of its kind, and
        the least and the largest of them.

    Raises
    ------
    InputError
        There is no such series, or C0 is missing.
    """
    Fr, Fa, n = np.broadcast_arrays(
        np.abs(np.asarray(radial, dtype=float)),
        np.abs(np.asarray(axial, dtype=float)),
        np.abs(np.asarray(speed, dtype=float)) * RPM,
    )
    nu = 1e6 * viscosity
    coefficient = sliding_coefficient(bearing, speed, viscosity)
    reduced = _reduction(bearing, n, nu, supply) * (nu * n) ** 0.6
    found = []
    for constants in _constants(bearing).values():
        rolling, sliding = _variables(bearing, constants, Fr, Fa, n, static_rating)
        found.append((reduced * rolling / 1e3, coefficient * sliding / 1e3))
    rubbed = seal_moment(bearing)
    viscous, loaded = (np.median([one[k] for one in found], axis=0) for k in (0, 1))
    loaded = loaded + rubbed
    sums = np.array([loaded + viscous, *(one[0] + one[1] + rubbed for one in found)])
    return FrictionMoment(loaded, viscous, sums.min(axis=0), sums.max(axis=0))


def seal_moment(bearing: FrictionBearing) -> float:
    """Moment of both seals of a bearing [N m]: K_S1 d_s^beta + K_S2; 0 of an open one.

    Parameters
    ----------
    bearing : FrictionBearing
        The bearing.

    Raises
    ------
    InputError
        Constants of seals of its kind are not known.
    """
    if bearing.seal_diameter is None:
        return 0.0
    if bearing.kind not in SEALS:
        raise InputError(
            f"friction of bearing {bearing.name!r}: seals of kind {bearing.kind} have no "
            f"constants, those of {', '.join(SEALS)} have: leave seal_diameter out"
        )
    power, by_size, fixed = SEALS[bearing.kind]
    return float((by_size * (1e3 * bearing.seal_diameter) ** power + fixed) / 1e3)


def sliding_coefficient(bearing: FrictionBearing, speed: ArrayLike, viscosity: float) -> Floats:
    """Friction coefficient of what slides, between no film and a full one.

    Parameters
    ----------
    bearing : FrictionBearing
        The bearing.
    speed : array_like
        Speed of one ring against the other, whose sign does not matter [rad/s].
    viscosity : float
        Kinematic viscosity of the oil, or base oil, in operation [m^2/s].

    Returns
    -------
    coefficient : Floats
        phi_bl mu_bl + (1 - phi_bl) mu_EHL with phi_bl = exp(-2.6e-8 (n nu)^1.4 d_m).
    """
    n = np.abs(np.asarray(speed, dtype=float)) * RPM
    dry = np.exp(-2.6e-8 * (n * 1e6 * viscosity) ** 1.4 * 1e3 * bearing.mean_diameter)
    wet = FULL_FILM.get(bearing.kind, MINERAL_FILM)
    return np.asarray(dry * np.where(n > 0.0, BOUNDARY, STARTING) + (1.0 - dry) * wet)


def _constants(bearing: FrictionBearing) -> Constants:
    """Constants of the bearing's series, or of all series of its kind."""
    if bearing.kind == "ball" and bearing.contact_angle > 0.0:
        return ANGULAR_BALLS
    known = SERIES[bearing.kind]
    if bearing.series is None:
        return {name: of for name, of in known.items() if name != "NCF"}
    if bearing.series not in known:
        raise InputError(
            f"friction of bearing {bearing.name!r}: series {bearing.series!r} of kind "
            f"{bearing.kind} has no constants: use one of {', '.join(known)}, or leave it out"
        )
    return {bearing.series: known[bearing.series]}


def _reduction(bearing: FrictionBearing, n: Floats, nu: float, supply: Supply) -> Floats:
    """Factors of inlet shear heating and of starvation, phi_ish phi_rs."""
    bore, outside, d = 1e3 * bearing.bore, 1e3 * bearing.outside, 1e3 * bearing.mean_diameter
    angular = bearing.kind == "ball" and bearing.contact_angle > 0.0
    K = K_Z["angular ball" if angular else bearing.factor_key]
    heated = 1.0 / (1.0 + 1.84e-9 * (n * d) ** 1.28 * nu**0.64)
    starved = K_RS[supply] * nu * n * (bore + outside) * np.sqrt(K / (2.0 * (outside - bore)))
    return np.asarray(heated * np.exp(-starved))


def _variables(
    bearing: FrictionBearing,
    of: tuple[float, ...],
    Fr: Floats,
    Fa: Floats,
    n: Floats,
    static_rating: float | None,
) -> tuple[Floats, Floats]:
    """G_rr and G_sl [N mm] of a series."""
    d = 1e3 * bearing.mean_diameter
    if bearing.kind == "ball":
        if bearing.contact_angle > 0.0:
            return _angular(of, d, Fr, Fa, n)
        return _deep_groove(bearing, of, d, Fr, Fa, static_rating)
    if bearing.kind == "cylindrical":
        return of[0] * d**2.41 * Fr**0.31, of[1] * d**0.9 * Fa + of[2] * d * Fr
    if bearing.kind == "single_row_tapered":
        return _tapered(of, d, bearing.axial_factor, Fr, Fa)
    if bearing.kind == "double_row_tapered":
        rows = [
            _tapered(of, d, bearing.axial_factor, 0.5 * Fr, axial)
            for axial in axial_of_rows(bearing, Fr, Fa)
        ]
        return rows[0][0] + rows[1][0], rows[0][1] + rows[1][1]
    if bearing.kind == "spherical_roller":
        R1, R2, R3, R4, S1, S2, S3, S4 = of
        rolling = np.minimum(
            R1 * d**1.85 * (Fr + R2 * Fa) ** 0.54, R3 * d**2.3 * (Fr + R4 * Fa) ** 0.31
        )
        sliding = np.minimum(
            S1 * d**0.25 * np.cbrt(Fr**4 + S2 * Fa**4), S3 * d**0.94 * np.cbrt(Fr**3 + S4 * Fa**3)
        )
        return rolling, sliding
    R1, R2, S1, S2 = of
    return (
        np.minimum(R1 * d**1.97 * Fr**0.54, R2 * d**2.37 * Fr**0.31),
        np.minimum(S1 * d**-0.19 * Fr ** (5.0 / 3.0), S2 * d**1.05 * Fr),
    )


def _tapered(
    of: tuple[float, ...], d: float, Y: float, Fr: Floats, Fa: Floats
) -> tuple[Floats, Floats]:
    R1, R2, S1, S2 = of
    return R1 * d**2.38 * (Fr + R2 * Y * Fa) ** 0.31, S1 * d**0.82 * (Fr + S2 * Y * Fa)


def _angular(
    of: tuple[float, ...], d: float, Fr: Floats, Fa: Floats, n: Floats
) -> tuple[Floats, Floats]:
    R1, R2, R3, S1, S2, S3 = of
    spun = d**4 * n**2
    rolling = R1 * d**1.97 * (Fr + R3 * spun + R2 * Fa) ** 0.54
    sliding = S1 * d**0.26 * ((Fr + S3 * spun) ** (4.0 / 3.0) + S2 * Fa ** (4.0 / 3.0))
    return rolling, sliding


def _deep_groove(
    bearing: FrictionBearing,
    of: tuple[float, ...],
    d: float,
    Fr: Floats,
    Fa: Floats,
    static_rating: float | None,
) -> tuple[Floats, Floats]:
    R1, R2, S1, S2 = of
    if not Fa.any():
        return R1 * d**1.96 * Fr**0.54, S1 * d**-0.26 * Fr ** (5.0 / 3.0)
    if static_rating is None:
        raise InputError(
            f"friction of bearing {bearing.name!r}: balls in deep grooves under axial force need "
            "the static rating C0: give ratings.C0"
        )
    angle = radians(24.6) * (Fa / static_rating) ** 0.24
    sine = np.where(Fa > 0.0, np.sin(angle), sin(1.0))
    rolling = R1 * d**1.96 * (Fr + R2 / sine * Fa) ** 0.54
    sliding = np.cbrt(Fr**5 + S2 * d**1.5 / sine * Fa**4)
    return rolling, np.where(Fa > 0.0, S1 * d**-0.145 * sliding, S1 * d**-0.26 * Fr ** (5.0 / 3.0))
