"""Load capacity of a pair of gears by ISO 6336: contact stress, root stress, and what is endured.

The equations are those of the edition of 2006, in which S-N curves fall to 0.85 of their limit at
1e10 cycles.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, degrees, inf, log, pi, sqrt, tan

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.involute import Gear, Pair
from fe_drivetrain.gear.load_factors import LoadFactors, contact_ratio_factor
from fe_drivetrain.gear.root_geometry import Cutter, ToothRoot, tooth_root
from fe_drivetrain.gear.strength import (
    CONTACT_LIFE,
    LONG_LIFE,
    ROOT_LIFE,
    GearMaterial,
    LifeCurve,
    equivalent_roughness,
    hardness_factor,
    lubricant_factor,
    notch_factor,
    roughness_factor,
    size_factor,
    surface_factor,
    velocity_factor,
)


@dataclass(frozen=True)
class Running:
    """Operating conditions of a pair.

    Attributes
    ----------
    torque : float
        Torque on the first gear in this mesh [N m].
    speed : float
        Speed of the first gear, against the carrier in a planetary stage [rad/s].
    viscosity : float
        Kinematic viscosity of the oil at 40 degrees Celsius [m^2/s].
    flank_roughness : tuple of float
        R_z of both flanks [m], such as 4.8e-6.
    root_roughness : tuple of float
        R_z of both fillets [m], such as 20e-6.
    """

    torque: float
    speed: float
    viscosity: float
    flank_roughness: tuple[float, float]
    root_roughness: tuple[float, float]

    def __post_init__(self) -> None:
        for name in ("torque", "speed", "viscosity"):
            if not 0.0 < getattr(self, name) < inf:
                raise InputError(
                    f"{name} of a pair of gears to be rated is {getattr(self, name):g}: give a "
                    "positive one, of the flank in question"
                )
        for name in ("flank_roughness", "root_roughness"):
            if not all(0.0 < roughness < 1e-3 for roughness in getattr(self, name)):
                raise InputError(
                    f"{name} of a pair of gears to be rated is {getattr(self, name)} m: give R_z "
                    "of both gears, above 0 and below 1e-3 m"
                )


@dataclass(frozen=True)
class ContactStress:
    """Hertz pressure of a pair by ISO 6336-2.

    Attributes
    ----------
    Z_H, Z_E, Z_epsilon, Z_beta : float
        Zone, elasticity [sqrt(Pa)], contact ratio and helix factor.
    Z_BD : tuple of float
        Single pair contact factors of both gears, Z_B and Z_D.
    nominal : float
        sigma_H0 at the pitch point [Pa].
    at_pitch_point : float
        Pressure at the pitch point with all load factors, sigma_Hw [Pa].
    stress : tuple of float
        sigma_H of both gears [Pa].
    """

    Z_H: float
    Z_E: float
    Z_epsilon: float
    Z_beta: float
    Z_BD: tuple[float, float]
    nominal: float
    at_pitch_point: float
    stress: tuple[float, float]


@dataclass(frozen=True)
class RootStress:
    """Root stress of one gear by ISO 6336-3.

    Attributes
    ----------
    root : ToothRoot
        Root section, with Y_F and Y_S.
    Y_beta, Y_B : float
        Helix and rim factor.
    nominal : float
        sigma_F0 [Pa].
    stress : float
        sigma_F [Pa].
    """

    root: ToothRoot
    Y_beta: float
    Y_B: float
    nominal: float
    stress: float


def check_rated(pair: Pair) -> None:
    """Refuse a pair outside of what ISO 6336 rates.

    Raises
    ------
    InputError
        The transverse contact ratio is not within 1 and 2.5 (ISO 6336-1, scope).
    """
    if not 1.0 <= pair.transverse_ratio <= 2.5:
        raise InputError(
            f"the transverse contact ratio of gears of {pair.first.teeth} and {pair.second.teeth} "
            f"teeth is {pair.transverse_ratio:.4g} but must be within 1 and 2.5 to be rated by ISO "
            "6336: change the tip diameters"
        )


def zone_factor(pair: Pair) -> float:
    """Zone factor Z_H: curvature at the pitch point, and force there.

    Parameters
    ----------
    pair : Pair
        Two gears.

    Returns
    -------
    float
        sqrt(2 cos(beta_b) / (cos^2(alpha_t) tan(alpha_wt))).
    """
    first = pair.first
    squared = cos(first.transverse_angle) ** 2 * tan(pair.working_angle)
    return sqrt(2.0 * cos(first.base_helix) / squared)


def elasticity_factor(first: GearMaterial, second: GearMaterial) -> float:
    """Elasticity factor Z_E.

    Parameters
    ----------
    first, second : GearMaterial
        Materials of both gears.

    Returns
    -------
    float
        Elasticity factor [sqrt(Pa)]; 189.8 sqrt(MPa) of steel on steel.
    """
    yields = sum((1.0 - m.poisson_ratio**2) / m.youngs_modulus for m in (first, second))
    return sqrt(1.0 / (pi * yields))


def single_pair_factors(pair: Pair) -> tuple[float, float]:
    """Factors Z_B and Z_D, from the pitch point to the inner points of single contact.

    Parameters
    ----------
    pair : Pair
        Two gears.

    Returns
    -------
    tuple of float
        Roots of the ratios of curvature, at least 1; 1 from a whole overlap on, in proportion below
        it; 1 of an internal gear.
    """
    path = pair.path
    at = pair.curvatures(np.array([path.pitch, path.single_start, path.single_end]))
    product = at[0] * at[1]
    M = [sqrt(product[0] / product[1]), sqrt(product[0] / product[2])]
    overlap = min(pair.overlap_ratio, 1.0)
    Z_B, Z_D = (max(m - overlap * (m - 1.0), 1.0) for m in M)
    return Z_B, 1.0 if pair.internal else Z_D


def contact_stress(
    pair: Pair, torque: float, factors: LoadFactors, materials: tuple[GearMaterial, GearMaterial]
) -> ContactStress:
    """Hertz pressure of a pair.

    Parameters
    ----------
    pair : Pair
        Two gears.
    torque : float
        Torque on the first gear in this mesh [N m].
    factors : LoadFactors
        Load factors of this mesh.
    materials : tuple of GearMaterial
        Materials of both gears.

    Returns
    -------
    ContactStress
        sigma_H0 = Z_H Z_E Z_epsilon Z_beta sqrt(F_t (u + 1) / (d_1 b u)), u negative with an
        internal gear; sigma_H = Z_B,D sigma_H0 sqrt(K_A K_gamma K_v K_Hbeta K_Halpha).
    """
    check_rated(pair)
    F_t, u = pair.tangential_force(torque), pair.second.teeth / pair.first.teeth
    Z_H, Z_E = zone_factor(pair), elasticity_factor(*materials)
    Z_epsilon = contact_ratio_factor(pair.transverse_ratio, pair.overlap_ratio)
    Z_beta = 1.0 / sqrt(cos(pair.first.helix))
    load = F_t / (2.0 * pair.first.reference_radius * pair.face_width) * (u + 1.0) / u
    nominal = Z_H * Z_E * Z_epsilon * Z_beta * sqrt(load)
    at_pitch = nominal * sqrt(factors.contact)
    Z_BD = single_pair_factors(pair)
    return ContactStress(
        Z_H,
        Z_E,
        Z_epsilon,
        Z_beta,
        Z_BD,
        nominal,
        at_pitch,
        (Z_BD[0] * at_pitch, Z_BD[1] * at_pitch),
    )


def helix_factor(gear: Gear, overlap_ratio: float) -> float:
    """Helix factor Y_beta of the root.

    Parameters
    ----------
    gear : Gear
        One of the pair.
    overlap_ratio : float
        Overlap ratio of the pair; counts up to 1, the helix angle up to 30 degrees.

    Returns
    -------
    float
        1 - epsilon_beta beta / 120 degrees.
    """
    return 1.0 - min(overlap_ratio, 1.0) * min(degrees(abs(gear.helix)), 30.0) / 120.0


def rim_factor(gear: Gear, rim: float | None) -> float:
    """Rim thickness factor Y_B.

    Parameters
    ----------
    gear : Gear
        One of the pair.
    rim : float or None
        Thickness below the teeth [m]; None is a solid gear.

    Returns
    -------
    float
        1 of a thick rim.

    Raises
    ------
    InputError
        A rim below half a tooth's height, or 1.75 modules of an internal gear.
    """
    if rim is None:
        return 1.0
    height = abs(gear.tip_radius - gear.root_radius)
    unit, least, thick, slope, scale = (
        (gear.normal_module, 1.75, 3.5, 1.15, 8.324)
        if gear.internal
        else (height, 0.5, 1.2, 1.6, 2.242)
    )
    if rim <= least * unit:
        raise InputError(
            f"the rim of a gear is {1e3 * rim:.4g} mm thick: ISO 6336-3 needs more than "
            f"{1e3 * least * unit:.4g} mm"
        )
    return 1.0 if rim >= thick * unit else slope * log(scale * unit / rim)


def root_stress(
    pair: Pair,
    torque: float,
    factors: LoadFactors,
    cutter: Cutter | None = None,
    rims: tuple[float | None, float | None] = (None, None),
) -> tuple[RootStress, RootStress]:
    """Root stress of both gears of a pair.

    Parameters
    ----------
    pair : Pair
        Two gears.
    torque : float
        Torque on the first gear in this mesh [N m].
    factors : LoadFactors
        Load factors of this mesh.
    cutter : Cutter, optional
        Tool that makes an internal gear.
    rims : tuple of float or None
        Thickness of the rims [m].

    Returns
    -------
    tuple of RootStress
        sigma_F0 = F_t / (b m_n) Y_F Y_S Y_beta Y_B, of the common face width; sigma_F = sigma_F0
        K_A K_gamma K_v K_Fbeta K_Falpha. A deep tooth factor is not in it.
    """
    check_rated(pair)
    load = pair.tangential_force(torque) / (pair.face_width * pair.first.normal_module)

    def of(gear: Gear, rim: float | None) -> RootStress:
        root = tooth_root(gear, pair.transverse_ratio, cutter)
        Y_beta, Y_B = helix_factor(gear, pair.overlap_ratio), rim_factor(gear, rim)
        nominal = load * root.Y_F * root.Y_S * Y_beta * Y_B
        return RootStress(root, Y_beta, Y_B, nominal, nominal * factors.root)

    return of(pair.first, rims[0]), of(pair.second, rims[1])


@dataclass(frozen=True)
class Endured:
    """Strength of one gear of a pair.

    Attributes
    ----------
    influence : float
        Product of all factors but the life factor, at the knee.
    curve : LifeCurve
        Stress [Pa] over cycles, without a safety factor; straight from static strength, where
        oil, roughness, notch and size do not count, to the knee.
    """

    influence: float
    curve: LifeCurve


def endured_contact(
    pair: Pair, running: Running, materials: tuple[GearMaterial, GearMaterial], endless: bool = True
) -> tuple[Endured, Endured]:
    """Hertz pressure that both gears endure, sigma_HG over cycles.

    Parameters
    ----------
    pair : Pair
        Two gears.
    running : Running
        Speed, oil and roughness.
    materials : tuple of GearMaterial
        Materials of both gears.
    endless : bool
        Whether less than the stress of 1e10 cycles is endured for ever.

    Returns
    -------
    tuple of Endured
        sigma_Hlim Z_NT Z_L Z_v Z_R Z_W; Z_X = 1.
    """
    softer = min(materials, key=lambda m: m.contact_limit)
    speed = abs(running.speed) * pair.first.reference_radius
    radius = relative_radius(pair)
    film = (
        lubricant_factor(softer.contact_limit, running.viscosity)
        * velocity_factor(softer.contact_limit, speed)
        * roughness_factor(softer.contact_limit, 0.5 * sum(running.flank_roughness), radius)
    )

    def of(number: int) -> Endured:
        own, mate = materials[number], materials[1 - number]
        Z_W = Z_W_static = 1.0
        if own.kind == "through-hardened" and mate.kind != "through-hardened":
            hard, soft = running.flank_roughness[1 - number], running.flank_roughness[number]
            felt = equivalent_roughness(hard, soft, radius, running.viscosity, speed)
            Z_W = hardness_factor(own.brinell, felt)
            Z_W_static = hardness_factor(own.brinell, static=True)
        first, static, knee = CONTACT_LIFE[own.kind]
        at_knee = own.contact_limit * film * Z_W
        stresses = (own.contact_limit * static * Z_W_static, at_knee, 0.85 * at_knee)
        return Endured(film * Z_W, LifeCurve((first, knee, LONG_LIFE), stresses, endless))

    return of(0), of(1)


def endured_root(
    gear: Gear,
    root: ToothRoot,
    material: GearMaterial,
    roughness: float,
    mean_stress: float,
    endless: bool = True,
) -> Endured:
    """Root stress that a gear endures, sigma_FG over cycles.

    Parameters
    ----------
    gear : Gear
        One of the pair.
    root : ToothRoot
        Root of the gear.
    material : GearMaterial
        Steel of the gear.
    roughness : float
        R_z of the fillet [m].
    mean_stress : float
        Y_M: 0.7 of a planet, which is bent both ways, 1 otherwise.
    endless : bool
        Whether less than the stress of 1e10 cycles is endured for ever.

    Returns
    -------
    Endured
        2 sigma_Flim Y_M Y_NT Y_delta_relT Y_R_relT Y_X. Static strength is taken without notch,
        surface and size factor: the standard's own static notch factor is not in it.
    """
    influence = (
        mean_stress
        * notch_factor(material, root.notch)
        * surface_factor(material, roughness)
        * size_factor(material, gear.normal_module)
    )
    first, static, knee = ROOT_LIFE[material.kind]
    limit = 2.0 * material.root_limit
    stresses = (limit * static * mean_stress, limit * influence, 0.85 * limit * influence)
    return Endured(influence, LifeCurve((first, knee, LONG_LIFE), stresses, endless))


def relative_radius(pair: Pair) -> float:
    """Radius of relative curvature at the pitch point, in the transverse plane.

    Parameters
    ----------
    pair : Pair
        Two gears.

    Returns
    -------
    float
        rho_1 rho_2 / (rho_1 + rho_2) [m], rho_2 negative with an internal gear.
    """
    one, two = pair.curvatures(pair.path.pitch)
    return float(one * two / (one + two))
