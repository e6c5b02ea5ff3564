"""Exact plane solutions of rings and curved bars, in polar coordinates.

Stresses do not depend on the elastic constants, but for those of rotation. Displacements are
written for plane stress; plane strain is the same with the constants of `plane_strain`.
"""

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache

import numpy as np

from fe_drivetrain.common import Floats, Ints

#: Where stresses of `CurvedBar` come from, for the source of a check.
CURVED_BAR = (
    "theory: stresses in equilibrium and compatible, with free surfaces and the given resultant "
    "(tests/cases/test_plane_rings.py checks each); the form is Golovin's, 1881"
)


@dataclass(frozen=True)
class Plane:
    """Elastic constants of a plane problem.

    Attributes
    ----------
    E : float
        Modulus in the plane [Pa].
    nu : float
        Poisson ratio in the plane.
    """

    E: float
    nu: float

    @property
    def G(self) -> float:
        """Shear modulus [Pa]: the same in plane stress and in plane strain."""
        return self.E / (2.0 * (1.0 + self.nu))


def plane_strain(E: float, nu: float) -> Plane:
    """The constants with which formulas of plane stress hold for plane strain."""
    return Plane(E / (1.0 - nu**2), nu / (1.0 - nu))


@dataclass(frozen=True)
class Lame:
    """A ring under uniform pressure inside and outside (Lame 1852; Timoshenko and Goodier art 28).

    Attributes
    ----------
    inner, outer : float
        Radii [m].
    inside, outside : float
        Pressures [Pa].
    """

    inner: float
    outer: float
    inside: float = 0.0
    outside: float = 0.0

    def radial(self, r: float | Floats) -> Floats:
        """Radial stress [Pa]."""
        return self._mean - self._varying / np.asarray(r) ** 2

    def hoop(self, r: float | Floats) -> Floats:
        """Hoop stress [Pa]."""
        return self._mean + self._varying / np.asarray(r) ** 2

    def hoop_at(self, r: float) -> float:
        """Hoop stress at one radius [Pa]."""
        return float(self.hoop(r))

    def displacement(self, r: float | Floats, plane: Plane) -> Floats:
        """Radial displacement [m]."""
        return np.asarray(r) / plane.E * (self.hoop(r) - plane.nu * self.radial(r))

    @property
    def _mean(self) -> float:
        a2, b2 = self.inner**2, self.outer**2
        return (self.inside * a2 - self.outside * b2) / (b2 - a2)

    @property
    def _varying(self) -> float:
        a2, b2 = self.inner**2, self.outer**2
        return (self.inside - self.outside) * a2 * b2 / (b2 - a2)


def interference_pressure(misfit: float, shaft: Lame, ring: Lame, on: Plane, of: Plane) -> float:
    """Pressure between a shaft and a ring pressed on it [Pa].

    The outer radius of the shaft and the inner radius of the ring are one; the displacements under
    the pressure close the misfit.

    Parameters
    ----------
    misfit : float
        By how much the shaft's radius exceeds the ring's, free [m].
    shaft, ring : Lame
        Their radii; the pressures are not looked at.
    on, of : Plane
        Constants of the shaft and of the ring.
    """
    c = ring.inner
    shrinks = -Lame(shaft.inner, c, 0.0, 1.0).displacement(np.array(c), on)
    grows = Lame(c, ring.outer, 1.0, 0.0).displacement(np.array(c), of)
    return float(misfit / (shrinks + grows))


@dataclass(frozen=True)
class Rotating:
    """A ring that turns about its axis (Timoshenko and Goodier art 32).

    In plane stress, a thin disc. With the constants of plane strain, a long cylinder; a uniform
    axial strain on top of it, as of free ends, changes none of these stresses.

    Attributes
    ----------
    inner, outer : float
        Radii [m].
    force : float
        Density times the square of the angular velocity [N/m^4].
    plane : Plane
        Elastic constants.
    """

    inner: float
    outer: float
    force: float
    plane: Plane

    def body_force(self, x: Floats) -> Floats:
        """Force per volume [N/m^3] at (..., 3) positions; the axis of rotation is x."""
        return np.asarray(self.force * x * [0.0, 1.0, 1.0])

    def radial(self, r: float | Floats) -> Floats:
        """Radial stress [Pa]."""
        a2, b2, r2 = self.inner**2, self.outer**2, np.asarray(r) ** 2
        return np.asarray(self.force * (3.0 + self.plane.nu) / 8.0 * (a2 + b2 - a2 * b2 / r2 - r2))

    def hoop(self, r: float | Floats) -> Floats:
        """Hoop stress [Pa]."""
        a2, b2, r2 = self.inner**2, self.outer**2, np.asarray(r) ** 2
        nu = self.plane.nu
        share = (1.0 + 3.0 * nu) / (3.0 + nu)
        return self.force * (3.0 + nu) / 8.0 * (a2 + b2 + a2 * b2 / r2 - share * r2)


@dataclass(frozen=True)
class Harmonics:
    """A ring under tractions that vary as cos(n t) (radial) and sin(n t) (shear), n of 2 or more.

    Michell's stress function (1899; Timoshenko and Goodier art 43): four powers r^k of each order,
    k = n, -n, n + 2, 2 - n, each scaled at the surface where it is greatest, so that high orders
    neither overflow nor cancel.

    Attributes
    ----------
    orders : Ints
        (m,) n.
    coefficients : Floats
        (m, 4) [Pa].
    inner, outer : float
        Radii [m].
    """

    orders: Ints
    coefficients: Floats
    inner: float
    outer: float

    def stress_amplitudes(self, r: float) -> Floats:
        """(3, m) amplitudes of radial stress, hoop stress (cos) and shear (sin) [Pa]."""
        n = self.orders[:, None]
        k, power = _powers(self.orders, self.inner, self.outer, r)
        c = self.coefficients * power
        parts = [(k - n**2) * c, k * (k - 1) * c, n * (k - 1) * c]
        return np.array([part.sum(axis=1) for part in parts])

    def displacement_amplitudes(self, r: float, plane: Plane) -> Floats:
        """(2, m) amplitudes of the radial (cos) and tangential (sin) displacement [m]."""
        n = self.orders[:, None]
        k, power = _powers(self.orders, self.inner, self.outer, r)
        c = self.coefficients * power * r / plane.E
        radial = ((k - n**2) - plane.nu * k * (k - 1)) / (k - 1)
        hoop = k * (k - 1) - plane.nu * (k - n**2)
        return np.array([(radial * c).sum(axis=1), ((hoop - radial) / n * c).sum(axis=1)])


def harmonics(
    orders: Ints, inner: float, outer: float, inside: Floats, outside: Floats
) -> Harmonics:
    """Solve a ring under pressures of the amplitudes given, without shear on its surfaces.

    Parameters
    ----------
    orders : Ints
        (m,) n, each 2 or more.
    inner, outer : float
        Radii [m].
    inside, outside : Floats
        (m,) amplitudes of the pressure that varies as cos(n t) [Pa].
    """
    n = orders[:, None]
    rows = []
    for r in (inner, outer):
        k, power = _powers(orders, inner, outer, r)
        rows += [(k - n**2) * power, n * (k - 1) * power]
    matrix = np.stack(rows, axis=1)
    right = np.zeros((len(orders), 4))
    right[:, 0], right[:, 2] = -inside, -outside
    solved = np.asarray(np.linalg.solve(matrix, right[..., None])[..., 0], dtype=float)
    return Harmonics(orders, solved, inner, outer)


def inextensible_ring(
    orders: Ints, inner: float, outer: float, pressure: float, plane: Plane
) -> Floats:
    """Radial amplitudes of a thin ring that does not stretch, p R^4 / (E I (n^2 - 1)^2), inwards.

    Parameters
    ----------
    orders : Ints
        (m,) n, each 2 or more.
    inner, outer : float
        Radii [m].
    pressure : float
        Amplitude on the outside of the pressure that varies as cos(n t) [Pa].
    plane : Plane
        Elastic constants.

    Returns
    -------
    amplitudes : Floats
        (m,) [m], negative where the pressure is positive.
    """
    middle = 0.5 * (inner + outer)
    stiffness = plane.E * (outer - inner) ** 3 / 12.0 * (np.asarray(orders) ** 2 - 1.0) ** 2
    return np.asarray(-pressure * middle**4 / stiffness)


def _powers(orders: Ints, inner: float, outer: float, r: float) -> tuple[Floats, Floats]:
    """(m, 4) exponents k of the stress function, and r^(k - 2) scaled."""
    n = np.asarray(orders, dtype=float)
    k = np.column_stack([n, -n, n + 2.0, 2.0 - n])
    scale = np.array([outer, inner, outer, inner])
    return k, (r / scale) ** (k - 2.0)


@cache
def _gauss(n: int) -> tuple[Floats, Floats]:
    x, w = np.polynomial.legendre.leggauss(n)
    return x, w


def even_amplitudes(load: Callable[[Floats], Floats], reach: float, n_orders: int) -> Floats:
    """Fourier amplitudes of a load about t = 0 that is repeated about t = pi.

    Parameters
    ----------
    load : callable
        Even function of the angle, looked at from 0 to `reach`, and zero beyond.
    reach : float
        Half of the loaded arc [rad].
    n_orders : int
        How many even orders: 0, 2, 4, ...

    Returns
    -------
    (n_orders,) amplitudes of cos(n t), the first one the mean.
    """
    x, w = _gauss(300)
    t, w = 0.5 * reach * (1.0 + x), 0.5 * reach * w
    n = 2 * np.arange(n_orders)
    found = 4.0 / np.pi * np.cos(n[:, None] * t) @ (w * load(t))
    found[0] /= 2.0
    return np.asarray(found)


@dataclass(frozen=True)
class CurvedBar:
    """A bar of rectangular cross-section with a circular axis, of unit width.

    Attributes
    ----------
    inner, outer : float
        Radii [m].
    """

    inner: float
    outer: float

    def bending(self, r: Floats, moment: float) -> tuple[Floats, Floats]:
        """Radial and hoop stress under end moments that straighten the bar [Pa].

        Golovin 1881. Written from memory, and checked by itself: it is in equilibrium, compatible,
        free on its surfaces, and has this moment (``tests/cases/test_plane_rings.py``).

        Parameters
        ----------
        r : Floats
            Radius [m].
        moment : float
            Per width [N].
        """
        a, b, r = self.inner, self.outer, np.asarray(r)
        log = np.log(b / a)
        N = (b**2 - a**2) ** 2 - 4.0 * a**2 * b**2 * log**2
        common = b**2 * np.log(r / b) + a**2 * np.log(a / r)
        ring = a**2 * b**2 / r**2 * log
        factor = -4.0 * moment / N
        return factor * (common + ring), factor * (common - ring + b**2 - a**2)

    def bending_rotation(self, moment: float, plane: Plane) -> float:
        """Rotation of the ends against each other, per angle of the bar.

        Sections stay plane, v = 4 B r t / E. Written from memory, and checked by itself: the work
        of the moment is the strain energy (``tests/cases/test_plane_rings.py``).
        """
        a, b = self.inner, self.outer
        N = (b**2 - a**2) ** 2 - 4.0 * a**2 * b**2 * np.log(b / a) ** 2
        return float(8.0 * moment * (b**2 - a**2) / (N * plane.E))

    def end_force(self, r: Floats, t: Floats, force: float) -> tuple[Floats, Floats, Floats]:
        """Radial and hoop stress and shear under a radial force on the end at t = 0 [Pa].

        Written from memory, and checked by itself: it is in equilibrium, compatible, free on its
        surfaces, and has this resultant (``tests/cases/test_plane_rings.py``).

        Parameters
        ----------
        r, t : Floats
            Radius [m] and angle from the loaded end [rad].
        force : float
            Per width, towards the centre [N/m].
        """
        a, b, r = self.inner, self.outer, np.asarray(r)
        N = a**2 - b**2 + (a**2 + b**2) * np.log(b / a)
        A, B, D = force / (2 * N), -force * a**2 * b**2 / (2 * N), -force * (a**2 + b**2) / N
        radial = 2.0 * A * r - 2.0 * B / r**3 + D / r
        hoop = 6.0 * A * r + 2.0 * B / r**3 + D / r
        return radial * np.sin(t), hoop * np.sin(t), -radial * np.cos(t)

    def end_force_energy(self, force: float, angle: float, plane: Plane) -> float:
        """Strain energy per width under a force on the end [J/m], the stresses integrated."""
        x, w = np.polynomial.legendre.leggauss(40)
        r = self.inner + 0.5 * (self.outer - self.inner) * (1.0 + x)
        t = 0.5 * angle * (1.0 + x)
        r, t = np.meshgrid(r, t, indexing="ij")
        weight = np.outer(w, w) * 0.25 * (self.outer - self.inner) * angle * r
        sr, st, shear = self.end_force(r, t, force)
        normal = (sr**2 + st**2 - 2.0 * plane.nu * sr * st) / (2.0 * plane.E)
        return float((weight * (normal + shear**2 / (2.0 * plane.G))).sum())

    def winkler(self, r: Floats, moment: float) -> Floats:
        """Hoop stress under end moments if sections stay plane and nothing presses radially [Pa].

        Winkler 1858; as used for hooks.
        """
        height = self.outer - self.inner
        neutral = height / np.log(self.outer / self.inner)
        offset = 0.5 * (self.inner + self.outer) - neutral
        return np.asarray(moment * (neutral - r) / (height * offset * r))
