"""Sections of a shaft: shape or rigidities, and their flexibility by Gauss quadrature.

The flexibility of a length of shaft (the motion of its right end for a force there, left end
clamped) is the integral of moment arms over rigidities along it. Unlike a stiffness matrix from
shape functions, that integral is exact for a cone too, so one element does for any taper.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import max_difference
from fe_drivetrain.common.spatial import along_x, wrench_transport
from fe_drivetrain.drivetrain_file.materials import Material


def cowper_shear_coefficient(poisson_ratio: float, diameter_ratio: ArrayLike = 0.0) -> Floats:
    """Shear coefficient of a solid or hollow circular section.

    Cowper 1966, "The shear coefficient in Timoshenko's beam theory", J. Appl. Mech. 33, 335-340:
    ``6 (1 + nu) (1 + m^2)^2 / ((7 + 6 nu) (1 + m^2)^2 + (20 + 12 nu) m^2)``.

    Parameters
    ----------
    poisson_ratio : float
        nu, -1 < nu <= 0.5.
    diameter_ratio : array_like
        m, inner over outer diameter, 0 (solid) to 1 (thin wall), any shape.

    Returns
    -------
    ndarray
        Shear area over area, the shape of `diameter_ratio`.

    Raises
    ------
    InputError
        If `poisson_ratio` or `diameter_ratio` is outside its range.
    """
    if not -1.0 < poisson_ratio <= 0.5:
        raise InputError(
            f"Poisson's ratio {poisson_ratio:g} must be above -1 and at most 0.5: steel has 0.3."
        )
    m2 = np.asarray(diameter_ratio, dtype=float) ** 2
    if not np.all(m2 <= 1.0):
        raise InputError(
            f"diameter ratio {np.max(np.abs(diameter_ratio)):g} must be between 0 (solid) and "
            "1 (thin wall): give inner diameter over outer diameter."
        )
    square = (1.0 + m2) ** 2
    nu = poisson_ratio
    ratio = 6 * (1 + nu) * square / ((7 + 6 * nu) * square + (20 + 12 * nu) * m2)
    return np.asarray(ratio, dtype=float)


@dataclass(frozen=True)
class BeamSection:
    """A length of shaft, cylindrical or conical, solid or bored.

    Attributes
    ----------
    length : float
        Length along x, m.
    outer_diameter, inner_diameter : float
        Diameters at the section's start, m.
    outer_diameter_end, inner_diameter_end : float, optional
        Diameters at the section's end, m; the same as at the start when left out. Both vary
        linearly.

    Raises
    ------
    InputError
        If a length or diameter is not positive, or the bore leaves no wall.
    """

    length: float
    outer_diameter: float
    inner_diameter: float = 0.0
    outer_diameter_end: float | None = None
    inner_diameter_end: float | None = None

    def __post_init__(self) -> None:
        _check_positive("beam section length", self.length, "m")
        for outer, inner in zip(*self.end_diameters, strict=True):
            _check_positive("beam section outer diameter", outer, "m")
            if not 0.0 <= inner < outer:
                raise InputError(
                    f"beam section inner diameter {inner:g} m must be at least 0 and less than "
                    f"the outer diameter {outer:g} m: make the bore smaller."
                )

    @property
    def end_diameters(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Outer and inner diameters, each at the start and at the end, m."""
        outer_end, inner_end = self.outer_diameter_end, self.inner_diameter_end
        return (
            (self.outer_diameter, self.outer_diameter if outer_end is None else outer_end),
            (self.inner_diameter, self.inner_diameter if inner_end is None else inner_end),
        )

    @property
    def uniform(self) -> bool:
        """Whether the section is a cylinder."""
        return all(start == end for start, end in self.end_diameters)


@dataclass(frozen=True)
class RigiditySection:
    """A uniform length of shaft given by its rigidities rather than its shape.

    Attributes
    ----------
    length : float
        Length along x, m.
    axial, shear, bending, torsion : float
        EA (N), shear rigidity k G A (N), EI (N m^2) and GJ (N m^2); `inf` is rigid.
    mass_per_length : float
        kg/m.

    Raises
    ------
    InputError
        If the length is not positive and finite, a rigidity not positive, or the mass negative.
    """

    length: float
    axial: float
    shear: float
    bending: float
    torsion: float
    mass_per_length: float = 0.0

    def __post_init__(self) -> None:
        _check_positive("beam section length", self.length, "m")
        for name in ("axial", "shear", "bending", "torsion"):
            value = getattr(self, name)
            if not value > 0.0:
                raise InputError(
                    f"beam section {name} rigidity {value:g} must be positive, or inf for rigid: "
                    "give the product of modulus and section property in SI units."
                )
        _check_not_negative("beam section mass per length", self.mass_per_length, "kg/m")

    @property
    def uniform(self) -> bool:
        """Always true: rigidities do not vary along this section."""
        return True


Section = BeamSection | RigiditySection


@dataclass(frozen=True, eq=False)
class ElementIntegrals:
    """Flexibility and weight of a length of shaft, clamped at its left end.

    Attributes
    ----------
    flexibility : ndarray, (6, 6)
        Motion of the right end per unit force there.
    sag : ndarray, (6, 3)
        Motion of the right end under the length's own weight, per m/s^2 along x, y, z.
    weight : ndarray, (6, 3)
        Weight as force and moment at the left end, per m/s^2 along x, y, z.
    """

    flexibility: Floats
    sag: Floats
    weight: Floats


def element_integrals(
    section: Section, material: Material, shear: bool, begin: float, end: float
) -> ElementIntegrals:
    """Integrate a section from `begin` to `end`, both in m from its start.

    Cylinders exactly; cones with twice the points until nothing changes.

    Raises
    ------
    InputError
        If a wall vanishes so nearly at one end that the flexibility does not settle.
    """
    # Two points are exact for a cylinder: the integrand of its sag is a cubic.
    points = 2 if section.uniform else 8
    result = _integrate(section, material, shear, begin, end, points)
    while not section.uniform:
        points *= 2
        finer = _integrate(section, material, shear, begin, end, points)
        change = max_difference(result.flexibility, finer.flexibility)
        result = finer
        # Gauss converges geometrically: after a change this small only rounding is left.
        if change <= 1e-12:
            break
        if points >= 1024:
            raise InputError(
                f"beam section of {section.length:g} m tapers too sharply to integrate, its wall "
                "nearly vanishes at one end: leave more wall there."
            )
    return result


@cache
def _gauss(points: int) -> tuple[Floats, Floats]:
    abscissa, weight = np.polynomial.legendre.leggauss(points)
    return abscissa, weight


def gauss_points(begin: float, end: float, points: int) -> tuple[Floats, Floats]:
    """Places (points,) of Gauss quadrature from `begin` to `end`, and their weights [m]."""
    abscissa, weight = _gauss(points)
    return begin + (end - begin) * (abscissa + 1.0) / 2.0, weight * (end - begin) / 2.0


def flexibility(compliance: Floats, arm: Floats) -> Floats:
    """Motion of the right end of a beam for forces there, its left end clamped.

    Parameters
    ----------
    compliance : ndarray, (q, 6)
        Strains of pieces of the beam per force and moment in them, times their lengths: weights of
        a quadrature over rigidities.
    arm : ndarray, (q,)
        Distance from each piece to the right end, m.

    Returns
    -------
    ndarray, (6, 6)
    """
    carried = wrench_transport(along_x(arm))
    return np.asarray(np.einsum("iab,ia,iac->bc", carried, compliance, carried))


def stiffness_of_ends(compliance: Floats, length: float) -> Floats:
    """(12, 12) stiffness of both ends of a free beam from the flexibility (6, 6) of its right end.

    The forces on the left end balance those on the right one (Przemieniecki 1968, Theory of Matrix
    Structural Analysis, section 5.6).
    """
    stiffness = np.linalg.inv(compliance)
    stiffness = (stiffness + stiffness.T) / 2.0
    balance = np.vstack([-wrench_transport(along_x(length)), np.eye(6)])
    return np.asarray(balance @ stiffness @ balance.T)


def _integrate(
    section: Section, material: Material, shear: bool, begin: float, end: float, points: int
) -> ElementIntegrals:
    s, weight = gauss_points(begin, end, points)
    compliance, _ = _properties(section, material, shear, s)
    weighted = compliance * weight[:, None]
    carried = wrench_transport(along_x(end - s))

    # The weight to the right of s. Three points are exact: mass is at most a quadratic, times arm.
    inner_abscissa, inner_weight = _gauss(3)
    left = np.append(s, begin)[:, None]
    t = left + (end - left) * (inner_abscissa + 1.0) / 2.0
    _, mass = _properties(section, material, shear, t.ravel())
    piece = mass.reshape(t.shape) * inner_weight * (end - left) / 2.0
    beyond = np.einsum("ij,ijab->iab", piece, wrench_transport(along_x(t - left)))[:, :, :3]
    return ElementIntegrals(
        flexibility=flexibility(weighted, end - s),
        sag=np.einsum("iab,ia,iac->bc", carried, weighted, beyond[:-1]),
        weight=beyond[-1],
    )


def _properties(
    section: Section, material: Material, shear: bool, s: Floats
) -> tuple[Floats, Floats]:
    """Compliance per length, (n, 6), and mass per length, (n,), at s from the section's start."""
    compliance = np.zeros((s.size, 6))
    if isinstance(section, RigiditySection):
        rigidity = section.axial, section.shear, section.torsion, section.bending
        axial, slide, twist, bend = (np.full(s.size, 1.0 / value) for value in rigidity)
        mass = np.full(s.size, section.mass_per_length)
    else:
        (outer0, outer1), (inner0, inner1) = section.end_diameters
        share = s / section.length
        outer = outer0 + (outer1 - outer0) * share
        inner = inner0 + (inner1 - inner0) * share
        area = np.pi / 4.0 * (outer - inner) * (outer + inner)
        inertia = area * (outer**2 + inner**2) / 16.0
        E, G = material.youngs_modulus, material.shear_modulus
        axial, bend, twist = 1.0 / (E * area), 1.0 / (E * inertia), 0.5 / (G * inertia)
        slide = axial * E / G / cowper_shear_coefficient(material.poisson_ratio, inner / outer)
        mass = material.density * area
    compliance[:, 0], compliance[:, 3] = axial, twist
    compliance[:, 4] = compliance[:, 5] = bend
    if shear:
        compliance[:, 1] = compliance[:, 2] = slide
    return compliance, mass


def _check_positive(what: str, value: float, unit: str) -> None:
    if not (value > 0.0 and np.isfinite(value)):
        raise InputError(f"{what} {value:g} {unit} must be positive and finite: correct the value.")


def _check_not_negative(what: str, value: float, unit: str) -> None:
    if not (value >= 0.0 and np.isfinite(value)):
        raise InputError(
            f"{what} {value:g} {unit} must be 0 or more and finite: correct the value."
        )
