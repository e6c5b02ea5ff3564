"""Hertz line contact: pressure between two cylinders, and stress below it.

Frame of the contact: x along the surface, across the strip; y along the cylinders; z into the body.
Both bodies have one Poisson ratio; strain along y is none. Al-Hamadani 2018, section 5.3, with the
radius of Eq 5.13 put right: what the half width needs is 1 / (1/R1 + 1/R2), not the mean curvature.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from math import cos, pi, sqrt

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.involute import Pair


def reduced_modulus(youngs_modulus: float = 206e9, poisson_ratio: float = 0.3) -> float:
    """Modulus of two bodies of one steel.

    Parameters
    ----------
    youngs_modulus : float
        Young's modulus of both bodies [Pa].
    poisson_ratio : float
        Poisson ratio of both bodies.

    Returns
    -------
    float
        E_R = E / (2 (1 - nu^2)) [Pa].
    """
    return youngs_modulus / (2.0 * (1.0 - poisson_ratio**2))


def half_width(load: float, radius: float | Floats, modulus: float) -> Floats:
    """Half the width of a line contact, a = sqrt(4 q R / (pi E_R)) [m] (Hertz 1881).

    Parameters
    ----------
    load : float
        Load per length of face [N/m].
    radius : float or ndarray
        Relative radius of curvature [m].
    modulus : float
        Reduced modulus E_R, see `reduced_modulus` [Pa].
    """
    return np.asarray(np.sqrt(4.0 * load * radius / (pi * modulus)), dtype=np.float64)


@dataclass(frozen=True)
class LineContact:
    """Two cylinders pressed together.

    Attributes
    ----------
    load : float
        Load per length [N/m].
    radius : float
        Relative radius of curvature, 1 / (1/R1 + 1/R2) [m]; R2 negative of a hollow.
    modulus : float
        E_R [Pa].
    """

    load: float
    radius: float
    modulus: float

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if not value > 0.0:
                raise InputError(
                    f"{name} of a line contact is {value:g}: it must be positive; a hollow must be "
                    "wider than the cylinder in it"
                )

    @property
    def half_width(self) -> float:
        """Half width of the strip, a = sqrt(4 q R / (pi E_R)) [m]."""
        return float(half_width(self.load, self.radius, self.modulus))

    @property
    def pressure(self) -> float:
        """Maximum pressure, p_0 = sqrt(q E_R / (pi R)) [Pa]."""
        return sqrt(self.load * self.modulus / (pi * self.radius))

    def pressure_at(self, x: ArrayLike) -> Floats:
        """Pressure across the strip.

        Parameters
        ----------
        x : array_like, (n,)
            Distance from the middle of the strip [m].

        Returns
        -------
        ndarray, (n,)
            p_0 sqrt(1 - x^2 / a^2), none beyond the strip [Pa].
        """
        inside = 1.0 - (np.asarray(x, dtype=np.float64) / self.half_width) ** 2
        return np.asarray(self.pressure * np.sqrt(np.maximum(inside, 0.0)), dtype=np.float64)

    def stresses(self, x: ArrayLike, z: ArrayLike, poisson_ratio: float = 0.3) -> Floats:
        """Stresses below the surface.

        Parameters
        ----------
        x : array_like, (n,)
            Distance from the middle of the strip [m].
        z : array_like, (n,)
            Depth [m], above 0.
        poisson_ratio : float
            Poisson ratio of both bodies.

        Returns
        -------
        ndarray, (n, 4)
            s_xx, s_yy, s_zz, s_xz [Pa] (McEwen 1949, as in Johnson 1985, Eq 4.49 and 4.50).
        """
        a, p = self.half_width, self.pressure
        x, z = np.broadcast_arrays(np.asarray(x, float) / a, np.asarray(z, float) / a)
        sum_ = 1.0 - x**2 + z**2
        root = np.sqrt(sum_**2 + 4.0 * x**2 * z**2)
        m = np.sqrt(0.5 * (root + sum_))
        n = np.copysign(np.sqrt(np.maximum(0.5 * (root - sum_), 0.0)), x)
        ratio = (z**2 + n**2) / (m**2 + n**2)
        xx = -p * (m * (1.0 + ratio) - 2.0 * z)
        zz = -p * m * (1.0 - ratio)
        xz = -p * n * (m**2 - z**2) / (m**2 + n**2)
        return np.stack([xx, poisson_ratio * (xx + zz), zz, xz], axis=-1)

    @property
    def max_shear(self) -> tuple[float, float]:
        """Maximum shear stress in the plane of x and z, and its depth [Pa, m]."""
        stress, depth = _largest("shear", 0.3)
        return stress * self.pressure, depth * self.half_width

    def max_von_mises(self, poisson_ratio: float = 0.3) -> tuple[float, float]:
        """Maximum von Mises stress and its depth.

        Parameters
        ----------
        poisson_ratio : float
            Poisson ratio of both bodies.

        Returns
        -------
        tuple of float
            Stress and depth [Pa, m]; 0.5575 p_0 at 0.704 a with 0.3.
        """
        stress, depth = _largest("von Mises", poisson_ratio)
        return stress * self.pressure, depth * self.half_width


def shear_stress(stresses: Floats) -> Floats:
    """Maximum shear stress in the plane of x and z.

    Parameters
    ----------
    stresses : ndarray, (..., 4)
        Stresses from `LineContact.stresses` [Pa].

    Returns
    -------
    ndarray, (...)
        Shear stress [Pa].
    """
    xx, _, zz, xz = np.moveaxis(stresses, -1, 0)
    return np.asarray(np.hypot(0.5 * (xx - zz), xz), dtype=np.float64)


def von_mises(stresses: Floats) -> Floats:
    """Von Mises stress of a plane state of strain.

    Parameters
    ----------
    stresses : ndarray, (..., 4)
        Stresses from `LineContact.stresses` [Pa].

    Returns
    -------
    ndarray, (...)
        Von Mises stress [Pa].
    """
    xx, yy, zz, xz = np.moveaxis(stresses, -1, 0)
    squares = (xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2 + 6.0 * xz**2
    return np.asarray(np.sqrt(0.5 * squares), dtype=np.float64)


@cache
def _largest(kind: str, poisson_ratio: float) -> tuple[float, float]:
    """Maximum stress under the middle of a strip over p_0, and its depth over a."""
    from scipy.optimize import minimize_scalar

    unit = LineContact(1.0, 1.0, 1.0)
    measure = shear_stress if kind == "shear" else von_mises

    def less(depth: float) -> float:
        at = unit.stresses(0.0, depth * unit.half_width, poisson_ratio)
        return -float(measure(at)) / unit.pressure

    found = minimize_scalar(less, bounds=(0.3, 1.5), method="bounded", options={"xatol": 1e-9})
    return -float(found.fun), float(found.x)


def tooth_contact(pair: Pair, place: float, load: float, modulus: float) -> LineContact:
    """Contact of two teeth as that of cylinders.

    Parameters
    ----------
    pair : Pair
        Two gears.
    place : float
        Distance from T1 along the line of action [m].
    load : float
        Force in the transverse plane per face width, that one pair of teeth carries [N/m].
    modulus : float
        E_R [Pa].

    Returns
    -------
    LineContact
        The contact line is longer than the face by 1 / cos(beta_b), and so is the normal force:
        load per length is that per face width; the radius of relative curvature in the normal
        plane is the transverse one over cos(beta_b).
    """
    one, two = (float(r) for r in pair.curvatures(place))
    curvature = (1.0 / one + 1.0 / two) * cos(pair.first.base_helix)
    return LineContact(load, 1.0 / curvature, modulus)
