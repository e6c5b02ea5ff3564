"""Factors of a tooth's load over its share of the torque: ISO 6336-1, method B.

Deviations of the teeth, running-in, resonance of a pair, misalignment over the face width. The
standard itself was not read: equations stand in public programs and in IACS UR M56, and the cases
set printed results beside them.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import inf, pi, sin, sqrt

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.involute import Gear, Pair
from fe_drivetrain.gear.strength import GearMaterial


@dataclass(frozen=True)
class LoadFactors:
    """Factors on the load of a mesh, and on its stresses (ISO 6336-1).

    Attributes
    ----------
    K_A : float
        Application factor: what the machine does to the torque.
    K_gamma : float
        Mesh load factor of the planet, or path, with the maximum load.
    K_v : float
        Dynamic factor, from within the mesh.
    K_Hbeta, K_Fbeta : float
        Maximum over mean load per face width: of the flank, of the root.
    K_Halpha, K_Falpha : float
        Maximum load of a pair of teeth over that of teeth without deviations.
    """

    K_A: float = 1.0
    K_gamma: float = 1.0
    K_v: float = 1.0
    K_Hbeta: float = 1.0
    K_Fbeta: float = 1.0
    K_Halpha: float = 1.0
    K_Falpha: float = 1.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if isinstance(value, bool) or not 0.0 < value < inf:
                raise InputError(f"load factor {name} is {value:g}: give a positive one")

    @property
    def contact(self) -> float:
        """All factors on the load that presses the flanks, multiplied."""
        return self.K_A * self.K_gamma * self.K_v * self.K_Hbeta * self.K_Halpha

    @property
    def root(self) -> float:
        """All factors on the load that bends the root, multiplied."""
        return self.K_A * self.K_gamma * self.K_v * self.K_Fbeta * self.K_Falpha


def relative_mass(gear: Gear, inner_diameter: float, density: float) -> float:
    """Mass of a gear at its base circle, per face width.

    Parameters
    ----------
    gear : Gear
        External or internal.
    inner_diameter : float
        Diameter of the gear's bore; of an internal gear the outer diameter [m].
    density : float
        Density of the gear [kg/m^3].

    Returns
    -------
    float
        Inertia over b r_b^2 of a disc up to the middle of the teeth, m* [kg/m].
    """
    middle = gear.tip_radius + gear.root_radius
    inertia = pi / 32.0 * density * abs(middle**4 - inner_diameter**4)
    return inertia / gear.base_radius**2


def reduced_mass(first: float, second: float, meshes: int = 1) -> float:
    """Mass that swings in the mesh, per face width.

    Parameters
    ----------
    first : float
        Relative mass of the pinion, or of the sun [kg/m].
    second : float
        Relative mass of the wheel, or of one planet; infinite for a gear that is fixed [kg/m].
    meshes : int
        Number of planets round the sun.

    Returns
    -------
    float
        m1 m2 / (m1 + p m2) [kg/m]; of a planet in a fixed ring its own.
    """
    return first / (first / second + meshes)


def resonance_speed(stiffness: float, mass: float, teeth: int) -> float:
    """Speed of a gear at which its teeth meet at the natural frequency of the mesh.

    Parameters
    ----------
    stiffness : float
        Mean mesh stiffness per face width, c_gamma_alpha [N/m^2].
    mass : float
        Reduced mass, per face width [kg/m].
    teeth : int
        Number of teeth of the gear.

    Returns
    -------
    float
        Resonance speed [rad/s]; n_E1 of ISO 6336-1 is 30 / pi times that.
    """
    return sqrt(stiffness / mass) / abs(teeth)


def running_in(material: GearMaterial, deviation: float, speed: float) -> float:
    """Part of a deviation of pitch or profile that a gear loses by running in.

    Parameters
    ----------
    material : GearMaterial
        Material of the gear.
    deviation : float
        Base pitch or profile form deviation [m].
    speed : float
        Speed at the pitch circle [m/s].

    Returns
    -------
    float
        y_alpha, y_p, y_f [m]; of a pair the mean of both gears.
    """
    if material.kind != "through-hardened":
        return min(0.075 * deviation, 3e-6)
    strength = 1e-6 * material.contact_limit
    limit = 12800e-6 / strength if speed > 5.0 else float("inf")
    limit = 6400e-6 / strength if speed > 10.0 else limit
    return min(160.0 / strength * deviation, limit)


def running_in_relief(first: GearMaterial, second: GearMaterial) -> float:
    """Tip relief that teeth without any get by running in, C_ay.

    Parameters
    ----------
    first, second : GearMaterial
        Materials of both gears.

    Returns
    -------
    float
        Mean of both [m].
    """
    both = (((1e-6 * m.contact_limit / 97.0 - 18.45) ** 2 / 18.0 + 1.5) for m in (first, second))
    return 0.5e-6 * sum(both)


@dataclass(frozen=True)
class Deviations:
    """Deviations of a pair that stay after running in.

    Attributes
    ----------
    pitch : float
        Effective base pitch deviation, f_pb less y_p [m].
    profile : float
        Effective profile form deviation, f_f_alpha less y_f [m].
    relief : float
        Tip relief, C_a or that of running in [m].
    grade : int
        Accuracy grade of ISO 1328; from 6 on, tip relief does not count (B_k = 1).
    """

    pitch: float
    profile: float
    relief: float = 0.0
    grade: int = 6


def dynamic_factor(
    resonance_ratio: float,
    line_load: float,
    stiffness: float,
    contact_ratio: float,
    deviations: Deviations,
) -> float:
    """Dynamic factor K_v by method B.

    Parameters
    ----------
    resonance_ratio : float
        N, speed over resonance speed.
    line_load : float
        F_t K_A K_gamma / b [N/m].
    stiffness : float
        Stiffness of one pair of teeth per face width, c' [N/m^2].
    contact_ratio : float
        Total contact ratio, epsilon_gamma.
    deviations : Deviations
        Deviations of pitch and profile, and the relief, of the pair.

    Returns
    -------
    float
        Dynamic factor, at least 1 below resonance: ranges up to N_S, to 1.15, to 1.5, and above.
    """
    B_p = stiffness * deviations.pitch / line_load
    B_f = stiffness * deviations.profile / line_load
    B_k = abs(1.0 - stiffness * deviations.relief / line_load) if deviations.grade < 6 else 1.0
    low = min(line_load / 1e5, 1.0)
    N, N_S = resonance_ratio, (0.5 + 0.35 * sqrt(low))
    c2, c3, c4, c6, c7 = _dynamic_constants(contact_ratio)
    if N <= N_S:
        return 1.0 + N * (0.32 * B_p + c2 * B_f + c3 * B_k)
    resonant = 1.0 + 0.32 * B_p + c2 * B_f + c4 * B_k
    beyond = 0.47 * B_p + c6 * B_f + c7
    if N <= 1.15:
        return resonant
    return beyond + (resonant - beyond) * max(1.5 - N, 0.0) / 0.35


def _dynamic_constants(ratio: float) -> tuple[float, float, float, float, float]:
    """C_v2, C_v3, C_v4, C_v6 and C_v7 over the total contact ratio."""
    if ratio <= 2.0:
        c2, c3, c4, c6 = 0.34, 0.23, 0.90, 0.47
    else:
        c2, c3 = 0.57 / (ratio - 0.3), 0.096 / (ratio - 1.56)
        c4, c6 = (0.57 - 0.05 * ratio) / (ratio - 1.44), 0.12 / (ratio - 1.74)
    if ratio <= 1.5:
        return c2, c3, c4, c6, 0.75
    c7 = 0.125 * sin(pi * (ratio - 2.0)) + 0.875 if ratio <= 2.5 else 1.0
    return c2, c3, c4, c6, c7


def face_factor(misalignment: float, stiffness: float, line_load: float) -> float:
    """Face load factor K_Hbeta of a linear misalignment, in closed form.

    Parameters
    ----------
    misalignment : float
        Gap between the flanks at one end of the face, the other end touching, F_betay [m].
    stiffness : float
        Mesh stiffness per face width, c_gamma_beta [N/m^2].
    line_load : float
        Mean, F_m / b with F_m = F_t K_A K_gamma K_v [N/m], so that the stress of a fixed
        misalignment falls with the torque.

    Returns
    -------
    float
        1 + F c / (2 w) while the whole face carries, sqrt(2 F c / w) beyond 2.
    """
    ratio = abs(misalignment) * stiffness / line_load
    return 1.0 + 0.5 * ratio if ratio <= 2.0 else sqrt(2.0 * ratio)


def root_face_factor(K_Hbeta: float, face_width: float, tooth_height: float) -> float:
    """Face load factor of the root, K_Fbeta = K_Hbeta^N_F.

    Parameters
    ----------
    K_Hbeta : float
        Face load factor of the flank.
    face_width : float
        b [m].
    tooth_height : float
        The larger one of both gears, h [m]; counts up to b / 3.

    Returns
    -------
    float
        N_F = (b/h)^2 / (1 + b/h + (b/h)^2).
    """
    ratio = max(face_width / tooth_height, 3.0)
    return float(K_Hbeta ** (ratio**2 / (1.0 + ratio + ratio**2)))


def transverse_factors(
    pair: Pair, stiffness: float, deviation: float, line_load: float
) -> tuple[float, float]:
    """Transverse load factors K_Halpha and K_Falpha by method B.

    Parameters
    ----------
    pair : Pair
        Two gears.
    stiffness : float
        Mean mesh stiffness per face width, c_gamma_alpha [N/m^2].
    deviation : float
        Maximum base pitch or profile form deviation less running in [m].
    line_load : float
        F_t K_A K_gamma K_v K_Hbeta / b [N/m].

    Returns
    -------
    tuple of float
        K_Halpha and K_Falpha, between 1 and what one pair alone would have to carry.
    """
    gamma, alpha = pair.contact_ratio, pair.transverse_ratio
    spread = stiffness * deviation / line_load
    if gamma <= 2.0:
        K = 0.5 * gamma * (0.9 + 0.4 * spread)
    else:
        K = 0.9 + 0.4 * sqrt(2.0 * (gamma - 1.0) / gamma) * spread
    Z_eps = contact_ratio_factor(alpha, pair.overlap_ratio)
    most = gamma / (alpha * Z_eps**2), gamma / (0.25 * alpha + 0.75)
    return max(min(K, most[0]), 1.0), max(min(K, most[1]), 1.0)


def contact_ratio_factor(transverse_ratio: float, overlap_ratio: float) -> float:
    """Contact ratio factor Z_epsilon of ISO 6336-2.

    Parameters
    ----------
    transverse_ratio : float
        epsilon_alpha.
    overlap_ratio : float
        epsilon_beta.

    Returns
    -------
    float
        sqrt((4 - epsilon_alpha) / 3) of spur gears, sqrt(1 / epsilon_alpha) from a whole overlap,
        squares in proportion between.

    Raises
    ------
    InputError
        epsilon_alpha is not 1 to 4, or epsilon_beta is negative.
    """
    if not (1.0 <= transverse_ratio < 4.0 and overlap_ratio >= 0.0):
        raise InputError(
            f"contact ratios are {transverse_ratio:.4g} (transverse) and {overlap_ratio:.4g} "
            "(overlap) but must be 1 to 4 and at least 0: correct teeth, tips or helix"
        )
    overlap = min(overlap_ratio, 1.0)
    spur, helical = (4.0 - transverse_ratio) / 3.0, 1.0 / transverse_ratio
    return sqrt(spur * (1.0 - overlap) + helical * overlap)
