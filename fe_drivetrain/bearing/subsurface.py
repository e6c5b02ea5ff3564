"""Stresses below a Hertz contact, and the margin of a surface-hardened race against core crushing.

Races of slewing bearings are hardened at their surface alone: what fails first may be the softer
core below the case (PROTEST 2010, section 7.1.1.2). Along the normal through the middle of a
contact the principal directions stay those of the contact, so that the maximum shear stress is half
of the maximum difference of the three normal stresses there (Johnson 1985, Contact mechanics,
sections 3.4 and 4.2). It is compared, depth by depth, with the shear strength of the material
there.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.contact import STEEL_NU, PointContact
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

_POINTS = 40
_OVER, _TABLE = (0.1, 100.0), 200  # depths over the short half axis


def stresses_below_ellipse(
    depths: ArrayLike,
    half_axes: tuple[float, float],
    pressure: float,
    poisson_ratio: float = STEEL_NU,
) -> Floats:
    """Normal stresses below the middle of an elliptic contact, by Boussinesq's solution.

    Parameters
    ----------
    depths : array_like, (n,)
        Depths, above zero [m]; below a tenth of the short half axis the quadrature loses digits.
    half_axes : tuple of float
        Half axes of the contact along x and y [m].
    pressure : float
        Maximum pressure [Pa].
    poisson_ratio : float
        Poisson ratio of the body.

    Returns
    -------
    ndarray, (n, 3)
        Stresses along x, y and the normal [Pa], compression below zero.

    Raises
    ------
    InputError
        A depth or a half axis is not above zero.
    """
    a, b = half_axes
    z = np.atleast_1d(np.asarray(depths, dtype=np.float64))[:, None, None]
    if min(a, b) <= 0.0 or not (z > 0.0).all():
        raise InputError(
            f"stresses at {float(z.min()):g} m below a contact of half axes {a:g} and {b:g} m: all "
            "three must be above 0"
        )
    # a quarter of the contact: x over sinh, dense near the middle by the depth; y over an angle, in
    # which the pressure is smooth
    nodes, weights = np.polynomial.legendre.leggauss(_POINTS)
    nodes, weights = 0.5 * (nodes + 1.0), 0.5 * weights
    end = np.arcsinh(a / z)
    x = z * np.sinh(end * nodes[:, None])
    chord = np.clip(1.0 - (x / a) ** 2, 0.0, None)
    phi = 0.5 * np.pi * nodes
    dx = z * np.cosh(end * nodes[:, None]) * end * weights[:, None]
    x2, y2 = x**2, chord * (b * np.sin(phi)) ** 2
    # p dx dy with p = p0 sqrt(chord) cos(phi), dy = b sqrt(chord) cos(phi) dphi
    force = 4.0 * pressure * chord * dx * b * np.cos(phi) ** 2 * 0.5 * np.pi * weights
    flat = x2 + y2
    rho = np.sqrt(flat + z**2)
    # (1 - z / rho) / r^2 without the difference
    near = 1.0 / (rho * (rho + z))
    share = (1.0 - 2.0 * poisson_ratio) / flat

    def along(one: Floats, other: Floats) -> Floats:
        surface = share * (near * (one - other) + z * other / rho**3)
        return np.asarray((force * (surface - 3.0 * z * one / rho**5)).sum(axis=(1, 2)))

    normal = -(force * 3.0 * z**3 / rho**5).sum(axis=(1, 2))
    return np.column_stack([along(x2, y2), along(y2, x2), normal]) / (2.0 * np.pi)


def max_shear(stresses: Floats) -> Floats:
    """Half of the maximum difference of the principal stresses [Pa].

    Parameters
    ----------
    stresses : ndarray, (n, 3)
        Principal [Pa].
    """
    return np.asarray(0.5 * np.ptp(stresses, axis=1))


@dataclass(frozen=True)
class HardenedCase:
    """Shear strength of a race over depth: that of the case, a transition, that of the core.

    Attributes
    ----------
    case, core : float
        Shear strength at the surface and in the core [Pa]; against yielding half of the yield
        stress.
    depth : float
        Depth to which the case is as hard as at the surface [m].
    transition : float
        Length over which the strength then falls to that of the core, straight [m].

    Raises
    ------
    InputError
        A strength or the depth is not above zero, or the core is stronger than the case.
    """

    case: float
    core: float
    depth: float
    transition: float

    def __post_init__(self) -> None:
        if not (0.0 < self.core <= self.case and self.depth > 0.0 and self.transition >= 0.0):
            raise InputError(
                f"a case of {self.case:g} Pa to {self.depth:g} m over a core of {self.core:g} Pa, "
                f"with a transition of {self.transition:g} m: give a core above 0 and not above "
                "the case, a depth above 0, a transition from 0"
            )

    def strength(self, depths: ArrayLike) -> Floats:
        """Shear strength at depths [Pa].

        Parameters
        ----------
        depths : array_like
            Depths [m].
        """
        ends = [self.depth, self.depth + max(self.transition, 1e-9 * self.depth)]
        return np.asarray(
            np.interp(np.asarray(depths, dtype=np.float64), ends, [self.case, self.core])
        )


@dataclass(frozen=True)
class Exposure:
    """Share of the strength that a contact uses.

    Attributes
    ----------
    case, core : float
        Maximum shear stress over strength, down to the end of the case, and below it.
    case_depth, core_depth : float
        Depths of these maxima [m].
    """

    case: float
    core: float
    case_depth: float
    core_depth: float

    @property
    def crushes(self) -> bool:
        """Whether the core is nearer to its strength than the case."""
        return self.core > self.case


def exposure(depths: Floats, stresses: Floats, race: HardenedCase) -> Exposure:
    """Shear stress over strength in case and core.

    Parameters
    ----------
    depths : ndarray, (n,)
        Depths, ascending, into the core [m].
    stresses : ndarray, (n, 3)
        Normal stresses from `stresses_below_ellipse` [Pa].
    race : HardenedCase
        Material of the race.

    Returns
    -------
    Exposure

    Raises
    ------
    InputError
        The depths do not reach from the case into the core.
    """
    inside = depths <= race.depth
    if not inside.any() or inside.all():
        raise InputError(
            f"depths from {depths[0]:g} to {depths[-1]:g} m: let them reach from the case into "
            f"the core, on both sides of {race.depth:g} m"
        )
    share = max_shear(stresses) / race.strength(depths)
    places = [int(np.where(part, share, -1.0).argmax()) for part in (inside, ~inside)]
    shares, where = share[places], depths[places]
    return Exposure(float(shares[0]), float(shares[1]), float(where[0]), float(where[1]))


def shear_at_depth(contact: PointContact, loads: ArrayLike, depth: float) -> Floats:
    """Maximum shear stress below the middle of a contact at one depth, for each of its loads.

    Half axes and pressure grow with the cube root of the load, so that the stress is the pressure
    times one function of the depth over the half axis. For a history of loads of the contact that
    carries the most, it is the history of stress at the end of a hardened case.

    Parameters
    ----------
    contact : PointContact
        Contact of ball and race.
    loads : array_like, (n,)
        Loads from 0 on [N].
    depth : float
        Depth, above zero [m].

    Returns
    -------
    ndarray, (n,)
        Shear stress [Pa].

    Raises
    ------
    InputError
        The depth is not above zero.
    """
    if depth <= 0.0:
        raise InputError(f"shear stress at a depth of {depth:g} m: give one above 0")
    given = np.asarray(loads, dtype=np.float64)
    a, b = contact.half_axes
    over = np.geomspace(*_OVER, _TABLE)
    shear = max_shear(stresses_below_ellipse(over * b, (a, b), 1.0))
    size = b * np.cbrt(np.maximum(given, (depth / (b * _OVER[1])) ** 3))
    found = np.exp(np.interp(np.log(depth / size), np.log(over), np.log(shear)))
    return np.asarray(np.where(given > 0.0, contact.pressure(given) * found, 0.0))
