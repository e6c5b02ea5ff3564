"""Rings pressed on each other and turning: thick cylinders in plane stress, free along the axis.

Lame 1852 for pressure (Timoshenko and Goodier, Theory of Elasticity, art. 28) and the turning disc
with a hole (same, art. 32); a fit that is loose has no pressure, never a negative one.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf

from fe_drivetrain.common.errors import InputError


@dataclass(frozen=True)
class RingMaterial:
    """An elastic material that expands.

    Attributes
    ----------
    youngs_modulus : float
        Modulus E [Pa].
    poisson_ratio : float
        Poisson's ratio [-].
    density : float
        Density [kg/m^3].
    expansion : float
        Coefficient of thermal expansion [1/K].
    """

    youngs_modulus: float
    poisson_ratio: float
    density: float
    expansion: float


@dataclass(frozen=True)
class Ring:
    """A thick cylinder.

    Attributes
    ----------
    inner, outer : float
        Radii [m]; an inner one of 0 is a solid shaft, an outer one without end a thick housing.
    material : RingMaterial
        Its material.

    Raises
    ------
    InputError
        There is no wall.
    """

    inner: float
    outer: float
    material: RingMaterial

    def __post_init__(self) -> None:
        if not 0.0 <= self.inner < self.outer:
            raise InputError(
                f"a ring from {2e3 * self.inner:.6g} to {2e3 * self.outer:.6g} mm diameter has no "
                "wall: correct the diameters"
            )

    def outer_growth(self, pressure: float) -> float:
        """Radial displacement of the outside under a pressure on the inside [m]."""
        a, b = self.inner, self.outer
        return 2.0 * pressure * a**2 * b / (self.material.youngs_modulus * (b**2 - a**2))

    def bore_growth(self, pressure: float) -> float:
        """Radial displacement of the inside under a pressure there [m]."""
        ratio = 0.0 if self.outer == inf else (self.inner / self.outer) ** 2
        E, nu = self.material.youngs_modulus, self.material.poisson_ratio
        return pressure * self.inner / E * ((1.0 + ratio) / (1.0 - ratio) + nu)

    def outer_shrink(self, pressure: float) -> float:
        """Radial displacement inwards of the outside under a pressure there [m]."""
        ratio = (self.inner / self.outer) ** 2
        E, nu = self.material.youngs_modulus, self.material.poisson_ratio
        return pressure * self.outer / E * ((1.0 + ratio) / (1.0 - ratio) - nu)

    def bore_shrink(self, pressure: float) -> float:
        """Radial displacement inwards of the inside under a pressure on the outside [m]."""
        a, b = self.inner, self.outer
        return 2.0 * pressure * b**2 * a / (self.material.youngs_modulus * (b**2 - a**2))

    def hoop_stress(self, inside: float) -> float:
        """Hoop stress at the inside under a pressure there [Pa]: the largest of the ring."""
        ratio = 0.0 if self.outer == inf else (self.inner / self.outer) ** 2
        return inside * (1.0 + ratio) / (1.0 - ratio)

    def turning_growth(self, r: float, speed: float) -> float:
        """Radial displacement at a radius of a ring that turns freely [m].

        Parameters
        ----------
        r : float
            Radius [m].
        speed : float
            Speed of rotation [rad/s].
        """
        if speed == 0.0:
            return 0.0
        a2, b2, m = self.inner**2, self.outer**2, self.material
        nu = m.poisson_ratio
        # the term with the hole vanishes at the centre of a solid shaft
        hole = (1.0 + nu) * (3.0 + nu) * a2 * b2 / r**2 if a2 else 0.0
        whole = (1.0 - nu) * (3.0 + nu) * (a2 + b2) + hole - (1.0 - nu**2) * r**2
        return m.density * speed**2 * r * whole / (8.0 * m.youngs_modulus)


def fit_pressure(inner: Ring, outer: Ring, interference: float) -> float:
    """Pressure between two rings with an interference (Lame 1852).

    Parameters
    ----------
    inner, outer : Ring
        Rings, the outside of one at the inside of the other.
    interference : float
        Interference of the diameters [m]; negative is a gap.

    Returns
    -------
    pressure : float
        Pressure [Pa]; zero where there is a gap.
    """
    soft = inner.outer_shrink(1.0) + outer.bore_growth(1.0)
    return max(interference, 0.0) / (2.0 * soft)
