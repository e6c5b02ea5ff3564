"""Contact of a rolling element: load over deflection, profiles, Hertz pressure.

A law is Q = K delta^n, of both contacts of a rolling element (inner and outer) in series, delta the
approach of the two races along the common normal; no load where they are apart.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import ellipe, ellipkm1

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

STEEL_E = 206e9
"""Young's modulus of bearing steel [Pa], as the constants of ISO 281 take it."""

STEEL_NU = 0.3


@dataclass(frozen=True)
class ContactLaw:
    """Load of one rolling element over the approach of its two races.

    Attributes
    ----------
    stiffness : float
        K [N/m^n], both contacts in series.
    exponent : float
        n, from 1 (linear) to 2.
    """

    stiffness: float
    exponent: float

    def __post_init__(self) -> None:
        if not (np.isfinite(self.stiffness) and self.stiffness > 0.0):
            raise InputError(
                f"contact stiffness is {self.stiffness:g} N/m^n: it must be positive and finite"
            )
        if not 1.0 <= self.exponent <= 2.0:
            raise InputError(
                f"contact exponent is {self.exponent:g}: give 1 (linear), 1.1 or 10/9 (line), "
                "3/2 (point), or another from 1 to 2"
            )

    def load(self, approach: Floats) -> Floats:
        """Load [N] at an approach [m], of any shape; zero where it is negative."""
        return self.stiffness * np.maximum(approach, 0.0) ** self.exponent


def houpert(length: float, diameter: float) -> ContactLaw:
    """Line contact of a roller between two races after Houpert.

    Parameters
    ----------
    length, diameter : float
        Length and diameter of the roller [m].

    Returns
    -------
    law : ContactLaw
        K = 6.39e10 L^0.991 D^0.1034, n = 1.1 (Houpert 1997, Tribology Transactions 40, as quoted by
        Stirling 2023, Eq 4.14-4.15).
    """
    _positive(roller_length=length, roller_diameter=diameter)
    return ContactLaw(6.39e10 * length**0.991 * diameter**0.1034, 1.1)


def iso_line(length: float) -> ContactLaw:
    """Line contact of a steel roller between two steel races after ISO/TS 16281.

    Parameters
    ----------
    length : float
        Effective length of the roller [m].

    Returns
    -------
    law : ContactLaw
        K = 35948 L^(8/9) in N and mm, n = 10/9, both contacts (the constant was read in public code
        that follows ISO/TS 16281:2008, not in the standard).
    """
    _positive(roller_length=length)
    return ContactLaw(35948e6 * length ** (8.0 / 9.0), 10.0 / 9.0)


def palmgren_line(length: float, youngs_modulus: float = STEEL_E) -> ContactLaw:
    """Line contact by Palmgren's formula with the elasticity of both bodies, both contacts.

    Parameters
    ----------
    length : float
        Length of the roller [m].
    youngs_modulus : float
        Young's modulus of rollers and rings [Pa]; their Poisson ratio is 0.3.

    Returns
    -------
    law : ContactLaw
        One contact has C = 0.7117 E_R L^(8/9) (Al-Hamadani 2018, Eq 5.12), 1 / E_R = 2 (1 - nu^2) /
        E, n = 10/9; two in series have C / 2^n.
    """
    _positive(roller_length=length, youngs_modulus=youngs_modulus)
    n = 10.0 / 9.0
    # In N and mm: [MPa mm^(8/9)] is 1e-6 1e3^(8/9) 1e3^(10/9) = 1 of SI.
    one = 0.7117 * 0.5 * youngs_modulus / (1.0 - STEEL_NU**2) * length ** (8.0 / 9.0)
    return ContactLaw(one / 2.0**n, n)


def linear(stiffness: float) -> ContactLaw:
    """A spring that pushes and does not pull.

    Parameters
    ----------
    stiffness : float
        Stiffness of one rolling element with both its contacts [N/m].

    Returns
    -------
    law : ContactLaw
        Law with n = 1.
    """
    return ContactLaw(stiffness, 1.0)


@dataclass(frozen=True)
class PointContact:
    """An elliptic contact of two elastic bodies after Hertz.

    Attributes
    ----------
    stiffness : float
        K of Q = K delta^(3/2) [N/m^1.5].
    half_axes : tuple of float
        Long and short half axis over Q^(1/3) [m/N^(1/3)].
    """

    stiffness: float
    half_axes: tuple[float, float]

    def pressure(self, load: Floats) -> Floats:
        """Maximum pressure [Pa] under a load [N]: 3 Q / (2 pi a b)."""
        a, b = self.half_axes
        return 1.5 * np.cbrt(np.maximum(load, 0.0)) / (np.pi * a * b)


def point_contact(
    curvatures: tuple[float, float],
    youngs_modulus: float = STEEL_E,
    poisson_ratio: float = STEEL_NU,
) -> PointContact:
    """Hertz's contact of two bodies of one material.

    Parameters
    ----------
    curvatures : tuple of float
        Sums of the curvatures of both bodies in the two principal planes [1/m], both positive.
    youngs_modulus, poisson_ratio : float
        Young's modulus [Pa] and Poisson ratio of both bodies.

    Returns
    -------
    contact : PointContact
        Contact, exact, with complete elliptic integrals (Hertz 1882; Johnson 1985, Contact
        mechanics, section 4.2).

    Raises
    ------
    InputError
        A sum of curvatures is not positive: the bodies do not touch in a point.
    """
    from scipy.optimize import brentq

    low, high = sorted(curvatures)
    if not low > 0.0:
        raise InputError(
            f"sum of curvatures is {low:g} 1/m: it must be positive; make the groove's radius "
            "larger than half the diameter of the ball"
        )
    effective = youngs_modulus / (1.0 - poisson_ratio**2) / 2.0  # E*, two equal bodies

    # k = b / a solves high / low = (E / k^2 - K) / (K - E) of modulus e^2 = 1 - k^2 (Johnson 4.28)
    def excess(log_ratio: float) -> float:
        k2 = np.exp(2.0 * log_ratio)
        K, E = ellipkm1(k2), ellipe(1.0 - k2)
        return float(np.log((E / k2 - K) / (K - E)) - np.log(high / low))

    # nearer to a circle the differences round off
    k = float(np.exp(brentq(excess, -12.0, -1e-4))) if high / low > 1.001 else 1.0
    K, E = float(ellipkm1(k * k)), float(ellipe(1.0 - k * k))
    ratio = (E / (k * k) - K) / (1.0 - k * k) if k < 1.0 else 0.25 * np.pi
    a = np.cbrt(1.5 * ratio / (np.pi * effective * 0.5 * high))
    delta = 1.5 * K / (np.pi * effective * a)  # over Q^(2/3)
    return PointContact(float(delta**-1.5), (float(a), float(a * k)))


def in_series(*contacts: PointContact) -> ContactLaw:
    """A ball between its races: the approaches of its contacts add.

    Parameters
    ----------
    *contacts : PointContact
        Inner and outer.

    Returns
    -------
    law : ContactLaw
        Exponent 3/2.
    """
    return ContactLaw(sum(c.stiffness ** (-2.0 / 3.0) for c in contacts) ** -1.5, 1.5)


def line_pressure(
    load_per_length: Floats, curvature: float, youngs_modulus: float = STEEL_E
) -> Floats:
    """Maximum Hertz pressure of a line contact of two bodies of steel.

    Parameters
    ----------
    load_per_length : Floats
        Load per length [N/m], any shape.
    curvature : float
        Sum of the curvatures of both bodies [1/m].
    youngs_modulus : float
        Young's modulus of both bodies [Pa]; their Poisson ratio is 0.3.

    Returns
    -------
    pressure : Floats
        p = sqrt(q E_R / (pi R)), 1 / E_R = 2 (1 - nu^2) / E, 1 / R the sum of curvatures [Pa]
        (Al-Hamadani 2018, Eq 5.14-5.16, with R as it must be; Johnson 1985, Eq 4.45).
    """
    reduced = youngs_modulus / (2.0 * (1.0 - STEEL_NU**2))
    return np.sqrt(np.maximum(load_per_length, 0.0) * reduced * curvature / np.pi)


def log_profile(places: Floats, length: float, drop: float) -> Floats:
    """Gap that a crowned roller leaves to one race, at places along it.

    Parameters
    ----------
    places : Floats
        Distances from the middle of the roller [m].
    length : float
        Effective length [m].
    drop : float
        The factor [m] of ln(1 / (1 - (2 x / L)^2)): 0.00035 D for cylindrical rollers, 0.00045 D
        for tapered ones in ISO/TS 16281 (read in public code, not in the standard).

    Returns
    -------
    free : Floats
        Gap at each place [m].
    """
    return -drop * np.log1p(-((2.0 * np.asarray(places) / length) ** 2))


def lamina_places(length: float, laminae: int) -> Floats:
    """Middles of equal laminae along a roller, from its middle [m].

    Parameters
    ----------
    length : float
        Length of the roller [m].
    laminae : int
        Number of laminae.

    Returns
    -------
    places : Floats
        Places of the middles, (laminae,) [m].
    """
    return length * ((np.arange(laminae) + 0.5) / laminae - 0.5)


def _positive(**sizes: float) -> None:
    for name, value in sizes.items():
        if not (np.isfinite(value) and value > 0.0):
            raise InputError(
                f"{name.replace('_', ' ')} is {value:g}: it must be positive, in SI units"
            )
