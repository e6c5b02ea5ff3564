"""Exact and independent answers for shafts: Saint-Venant fields, Michell's cone, beams on springs.

Nothing here uses the finite elements or the frame of the library; a shaft lies along x, z is up.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import brentq

from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.shafts.beam import cowper_shear_coefficient

#: Where `flexure_field` and `flexure_stress` come from, for the source of a check.
FLEXURE = (
    "theory: Saint-Venant's flexure, its stresses those of its displacements, in equilibrium, "
    "free on the surface and with the given resultant "
    "(tests/cases/test_shaft_theory.py checks each)"
)


@dataclass(frozen=True)
class Tube:
    """A uniform circular shaft.

    Attributes
    ----------
    outer, inner : float
        Diameters [m]; inner 0 where solid.
    length : float
        [m].
    material : Material
        Material of the shaft.
    """

    outer: float
    inner: float
    length: float
    material: Material

    @property
    def area(self) -> float:
        """[m^2]."""
        return float(np.pi / 4 * (self.outer**2 - self.inner**2))

    @property
    def inertia(self) -> float:
        """Second moment of area about a diameter [m^4]."""
        return float(np.pi / 64 * (self.outer**4 - self.inner**4))

    @property
    def polar(self) -> float:
        """J [m^4]."""
        return 2 * self.inertia

    @property
    def EI(self) -> float:
        """Bending rigidity [N m^2]."""
        return self.material.youngs_modulus * self.inertia

    @property
    def GJ(self) -> float:
        """Torsional rigidity [N m^2]."""
        return self.material.shear_modulus * self.polar

    @property
    def EA(self) -> float:
        """Axial rigidity [N]."""
        return self.material.youngs_modulus * self.area

    @property
    def shear_coefficient(self) -> float:
        """Cowper's [-]."""
        ratio = self.inner / self.outer
        return float(cowper_shear_coefficient(self.material.poisson_ratio, ratio))

    @property
    def kGA(self) -> float:
        """Shear rigidity with Cowper's coefficient [N]."""
        return self.shear_coefficient * self.material.shear_modulus * self.area


def solid_and_bored(
    outer: float, bore: float, length: float, material: Material
) -> dict[str, Tube]:
    """The same shaft "solid" and "bored"; diameters and length in m."""
    return {
        name: Tube(outer, inner, length, material)
        for name, inner in (("solid", 0.0), ("bored", bore))
    }


def evenly_loaded_shear(tube: Tube) -> float:
    """Shear rigidity [N] of a beam whose loads and supports act evenly over its sections.

    Cowper's beam is that of Saint-Venant's tractions. Evenly spread shear has no resultant beside
    theirs, but works on the anticlastic part of a bending field, and so (by reciprocity) turns a
    section where the shear force changes: 1 / k'GA is 1 / kGA less `extra_curvature`. Of a solid
    circle k' is 6 (1 + nu)^2 / (7 + 12 nu + 4 nu^2): Hutchinson 2001, J. Appl. Mech. 68, 87-92, as
    quoted by Stephen 2001 (discussion, J. Appl. Mech. 68, 959-960), whose own earlier expression is
    the same; derived again here.
    """
    return 1.0 / (1.0 / tube.kGA - extra_curvature(tube))


def sag(load: float, EI: float, kGA: float, length: float) -> float:
    """Deflection of a cantilever's tip under a load per length [N/m], with shear [m]."""
    return load * length**4 / (8 * EI) + load * length**2 / (2 * kGA)


def within_recovery(per_turn: int) -> tuple[float, str]:
    """How far stress recovered at the skin of a bent or twisted shaft may be wrong, relative; why.

    A straight line through the two Gauss points of an element of arc h misses a function of unit
    second derivative by h^2 / 12 at its end; the same again for the radius.
    """
    why = "stress is recovered linearly in each element: h^2 / 12 for the arc h of an element, and "
    return float((2 * np.pi / per_turn) ** 2 / 6), why + "as much for the radius"


def anticlastic_error(per_turn: int) -> float:
    """Error of a displacement that goes as sin 2t round the shaft, over its amplitude.

    Interpolated by parabolas of arc h: 8 h^3 / (72 sqrt 3).
    """
    return float(8 * (2 * np.pi / per_turn) ** 3 / (72 * np.sqrt(3)))


def polar_moment(outer: float, inner: float = 0.0) -> float:
    """J = pi/32 (D^4 - d^4) [m^4] of diameters [m]."""
    return float(np.pi / 32 * (outer**4 - inner**4))


def solid_diameter(polar: float) -> float:
    """Diameter [m] of the solid circle of polar moment J [m^4]."""
    return float((32 * polar / np.pi) ** 0.25)


def parabola_shortfall(per_turn: int) -> float:
    """Mean shortfall of the radius, relative, of a circle of so many parabolic arcs.

    The parabola through three points of an arc of half angle t lies at r^2 / R^2 = 1 -
    (1 - cos t)^2 s^2 (1 - s^2), s from -1 to 1; the mean of s^2 (1 - s^2) is 2/15. Areas fall short
    by twice, second moments of area by four times as much.
    """
    return float((1 - np.cos(np.pi / per_turn)) ** 2 / 15)


def parabola_slope(per_turn: int) -> float:
    """Largest angle [rad] between such a parabola and the circle: (1 - cos t)^2 / t."""
    half = np.pi / per_turn
    return float((1 - np.cos(half)) ** 2 / half)


def within_lean(per_turn: int) -> tuple[float, str]:
    """How much of the meshed section's stiffness parabolic arcs may miss, relative, and why.

    They lean against the circle: `parabola_slope` squared, and that in words.
    """
    slope = parabola_slope(per_turn)
    why = "the exact displacement is one of the element's; the meshed surface leans against the "
    return (
        slope**2,
        why + f"circle by at most {slope:.2g} rad, and what that warps is of second order",
    )


def within_arcs(per_turn: int, what: str, power: int, held: bool = True) -> tuple[float, str]:
    """How much of a section's property parabolic arcs round a turn may miss, relative, and why.

    Parameters
    ----------
    per_turn : int
        Arcs round a turn.
    what : str
        The property: "I".
    power : int
        Its power of the radius: 2 of an area, 4 of a second moment.
    held : bool
        Whether the elements hold the exact field, but for their arcs.

    Returns
    -------
    within, why : float, str
        Twice what `parabola_shortfall` says, three times of a field that the elements do not hold,
        and that in words.
    """
    missed = power * parabola_shortfall(per_turn)
    why = f"{per_turn} parabolic arcs round a turn: {what} is {missed:.2g} too low by their formula"
    if held:
        return 2 * missed, f"{why}; twice that is allowed"
    return 3 * missed, f"{why}; three times that is allowed, since elements do not hold this field"


def missed_at_held_edge(edge: float) -> tuple[float, str]:
    """How much of the energy beside a held edge of a steel shaft elements may miss, and why.

    Stress goes as the distance from the edge to the power 0.71 - 1, and the error of the energy as
    the elements' length to twice 0.71.

    Parameters
    ----------
    edge : float
        Length of the elements there, over the radius.
    """
    why = "stress is singular along held edges, of exponent 0.71 in steel: what elements of "
    return edge**1.4, f"{why}{edge:.2g} radii there miss goes as that to the power 1.4"


def pure_bending_field(points: Floats, curvature: float, poisson_ratio: float) -> Floats:
    """Displacements (n, 3) [m] of a bar bent to a curvature [1/m] in the plane of x and z.

    u_x = -k x z, u_y = nu k y z, u_z = k (x^2 + nu (z^2 - y^2)) / 2: Timoshenko and Goodier,
    Theory of Elasticity, article 102 (3rd edition), in this frame. The stress is sigma_x = -E k z
    and nothing else, so the field is exact for a prism of any section.
    """
    x, y, z = np.asarray(points).T
    k, nu = curvature, poisson_ratio
    return np.column_stack([-k * x * z, nu * k * y * z, 0.5 * k * (x**2 + nu * (z**2 - y**2))])


def flexure_field(points: Floats, force: float, tube: Tube) -> Floats:
    """Displacements (n, 3) [m] of Saint-Venant's flexure by a force along z at x = L.

    Love 1927, A Treatise on the Mathematical Theory of Elasticity, articles 229-231, with the
    flexure function of a circle or of two concentric circles. Written from memory, and checked by
    itself: equilibrium, free surfaces, resultant, and stresses that are those of its displacements
    (``tests/cases/test_shaft_theory.py``).
    """
    x, y, z = np.asarray(points).T
    nu, L = tube.material.poisson_ratio, tube.length
    c = force / tube.EI
    chi = _flexure_function(y, z, tube)[0]
    return np.column_stack(
        [
            -c * (z * (L * x - 0.5 * x**2) + chi + z * y**2),
            c * (L - x) * nu * y * z,
            c * (0.5 * (L - x) * nu * (z**2 - y**2) + 0.5 * L * x**2 - x**3 / 6),
        ]
    )


def flexure_stress(points: Floats, force: float, tube: Tube) -> Floats:
    """(n, 6) stresses xx, yy, zz, xy, yz, zx [Pa] of `flexure_field`."""
    x, y, z = np.asarray(points).T
    nu = tube.material.poisson_ratio
    _, chi_y, chi_z = _flexure_function(y, z, tube)
    scale = -force / (2 * (1 + nu) * tube.inertia)
    zero = np.zeros_like(x)
    return np.column_stack(
        [
            -force / tube.inertia * (tube.length - x) * z,
            zero,
            zero,
            scale * (chi_y + (2 + nu) * y * z),
            zero,
            scale * (chi_z + 0.5 * nu * z**2 + (1 - 0.5 * nu) * y**2),
        ]
    )


def _flexure_function(y: Floats, z: Floats, tube: Tube) -> tuple[Floats, Floats, Floats]:
    """chi [m^3] and its derivatives along y and z."""
    a, b = tube.outer / 2, tube.inner / 2
    A = 0.75 + 0.5 * tube.material.poisson_ratio
    chi = -A * (a**2 + b**2) * z + 0.25 * (z**3 - 3 * z * y**2)
    along_y = -1.5 * y * z
    along_z = -A * (a**2 + b**2) + 0.75 * (z**2 - y**2)
    if b > 0:
        r2 = y**2 + z**2
        chi = chi - A * a**2 * b**2 * z / r2
        along_y = along_y + A * a**2 * b**2 * 2 * y * z / r2**2
        along_z = along_z - A * a**2 * b**2 * (y**2 - z**2) / r2**2
    return chi, along_y, along_z


def extra_curvature(tube: Tube) -> float:
    """Curvature [1/m] that a load along z of 1 N per metre adds to M / EI, in its own direction.

    Cross-sections that carry their own weight are also stressed sideways: with moments z and
    (z^2 - y^2) / 2 of equilibrium in the section, ``integral z (sigma_y + sigma_z) dA`` is that of
    ``(z^2 - y^2) / 2 d(tau_xz)/dx + y z d(tau_xy)/dx``, where tau is Saint-Venant's for a shear
    force that falls by 1 N/m; and the axial strain is sigma_x / E less nu / E times as much. Exact
    for a uniform load.
    """
    a, b = tube.outer / 2, tube.inner / 2
    t, w = np.polynomial.legendre.leggauss(12)
    r = 0.5 * (a - b) * (t + 1) + b
    angle = 2 * np.pi * np.arange(24) / 24
    y, z = r[:, None] * np.sin(angle), r[:, None] * np.cos(angle)
    points = np.column_stack([np.zeros(y.size), y.ravel(), z.ravel()])
    s = flexure_stress(points, 1.0, tube).reshape(*y.shape, 6)
    weight = (w * 0.5 * (a - b) * r)[:, None] * (2 * np.pi / 24)
    moment = (weight * (0.5 * (z**2 - y**2) * s[..., 5] + y * z * s[..., 3])).sum()
    return float(-tube.material.poisson_ratio * moment / tube.EI)


def michell_torque(half_angle: float, shear_modulus: float) -> float:
    """Torque [N m] of the field u_t = -r / R^3 on a cone: 2 pi G (2 - 3 cos a + cos^3 a).

    u_t / r is constant on spheres about the apex, where R is the distance to it: Michell 1899;
    Timoshenko and Goodier, article 119 (3rd edition). Derived again: -1 / R^3 solves
    div(r^3 grad(u_t / r)) = 0, the equation of shafts of variable diameter (Sadd, Elasticity,
    section 9.7, Eq 9.7.3), its gradient is along the cone's surface, which is so free of stress,
    and the torque is the integral over such a sphere of 3 G r^2 / R^4, the stress times its arm.
    """
    c = np.cos(half_angle)
    return float(2 * np.pi * shear_modulus * (2 - 3 * c + c**3))


def between_spheres(radii: tuple[float, float], half_angle: float, shear_modulus: float) -> float:
    """Stiffness [N m/rad] of Michell's cone between spheres about its apex.

    Parameters
    ----------
    radii : tuple of float
        Radii of the flat ends through whose centres the spheres go [m].
    half_angle : float
        Half angle of the cone [rad].
    shear_modulus : float
        G [Pa].
    """
    near, far = (r / np.tan(half_angle) for r in radii)
    return float(michell_torque(float(half_angle), shear_modulus) / (near**-3 - far**-3))


def two_mass_frequencies(stiffness: float, rotor: float, generator: float) -> tuple[float, float]:
    """Natural frequencies [Hz]: both masses free, and the generator held.

    Parameters
    ----------
    stiffness : float
        k [N m/rad] on the rotor's side.
    rotor, generator : float
        Moments of inertia on the rotor's side [kg m^2].
    """
    free = np.sqrt(stiffness * (1 / rotor + 1 / generator))
    return float(free / (2 * np.pi)), float(np.sqrt(stiffness / rotor) / (2 * np.pi))


def chain_frequencies(inertias: ArrayLike, springs: ArrayLike, ground: float = 0.0) -> Floats:
    """Natural frequencies [Hz] of inertias in a row, ascending.

    Parameters
    ----------
    inertias : ArrayLike
        (n,) [kg m^2].
    springs : ArrayLike
        (n - 1,) between neighbours [N m/rad].
    ground : float
        Stiffness of the last inertia to the ground [N m/rad].
    """
    J, k = np.asarray(inertias, dtype=float), np.asarray(springs, dtype=float)
    K = np.diag(np.concatenate([k, [ground]]) + np.concatenate([[0.0], k]))
    K -= np.diag(k, 1) + np.diag(k, -1)
    root = np.sqrt(J)
    squares = np.linalg.eigvalsh(K / np.outer(root, root))
    return np.asarray(np.sqrt(np.maximum(squares, 0.0)) / (2 * np.pi))


def rod_frequency(stiffness: float, inertia: float, rotor: float, generator: float) -> float:
    """Lowest free-free frequency [Hz] of two inertias on a shaft that has one of its own.

    ``tan(b) (b^2 m M - 1) = b (m + M)`` with m, M the end inertias over the shaft's and b = 2 pi f
    sqrt(I / k): a uniform rod in torsion (Rao, Mechanical Vibrations; derived again).
    """
    m, M = rotor / inertia, generator / inertia

    def excess(b: float) -> float:
        return float(np.sin(b) * (b**2 * m * M - 1) - b * np.cos(b) * (m + M))

    # without the rod's own inertia b is this, with it a little less
    b0 = float(np.sqrt(1 / m + 1 / M))
    b = brentq(excess, 0.5 * b0, min(1.5 * b0, np.pi), xtol=1e-15, rtol=1e-14)
    return float(b * np.sqrt(stiffness / inertia) / (2 * np.pi))
