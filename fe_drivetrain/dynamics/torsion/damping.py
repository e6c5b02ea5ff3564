"""Dampings of shafts and meshes of which a damping ratio is known."""

from math import sqrt


def shaft_damping(ratio: float, inertia: float, stiffness: float) -> float:
    """C = 2 zeta sqrt(J k) [N m s/rad] (Eq 4.5), with J an inertia [kg m^2].

    For two inertias J_1 and J_2 on the shaft, J_1 J_2 / (J_1 + J_2) makes zeta the damping ratio of
    the two against each other.
    """
    return 2 * ratio * sqrt(inertia * stiffness)


def mesh_damping(
    ratio: float, stiffness: float, driving: float, driven: float, gear: float
) -> float:
    """Damping of a gear mesh about the driving gear's axis [N m s/rad], after Eq 4.7.

    C = 2 zeta sqrt(k_mesh J), with J the inertia that the two gears oppose to each other in the
    mesh, about the driving one: r_1^2 J_1 J_2 / (r_1^2 J_2 + r_2^2 J_1). Eq 4.7 is printed as
    r_1^2 r_2^2 J_1 J_2 / (r_1^2 J_1 + r_2^2 J_2), which is a length squared more and gives each
    inertia the other's radius; with one of the two fixed, it must leave the other alone.

    Parameters
    ----------
    ratio : float
        zeta.
    stiffness : float
        Mesh stiffness about the driving gear [N m/rad].
    driving, driven : float
        Inertias J_1, J_2 about their own axes [kg m^2].
    gear : float
        r_1 / r_2, the speed ratio.
    """
    inertia = gear**2 * driving * driven / (gear**2 * driven + driving)
    return shaft_damping(ratio, inertia, stiffness)
