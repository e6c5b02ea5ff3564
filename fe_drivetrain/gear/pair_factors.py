"""Dynamic and transverse load factors of a pair, from its deviations, stiffness and mass."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fe_drivetrain.gear.involute import Pair
from fe_drivetrain.gear.load_factors import (
    Deviations,
    LoadFactors,
    dynamic_factor,
    resonance_speed,
    root_face_factor,
    running_in,
    running_in_relief,
    transverse_factors,
)
from fe_drivetrain.gear.rating import Running
from fe_drivetrain.gear.strength import GearMaterial


@dataclass(frozen=True)
class RunningPair:
    """A pair with what its dynamic and transverse load factors need.

    Attributes
    ----------
    pair : Pair
        Two gears.
    materials : tuple of GearMaterial
        Materials of both gears.
    running : Running
        Torque and speed.
    stiffness : tuple of float
        c' and c_gamma_alpha [N/m^2].
    mass : float
        Reduced mass per face width [kg/m].
    deviations : tuple of float
        Largest base pitch and profile form deviation [m].
    tooth_height : float
        The larger one of both gears [m].
    """

    pair: Pair
    materials: tuple[GearMaterial, GearMaterial]
    running: Running
    stiffness: tuple[float, float]
    mass: float
    deviations: tuple[float, float]
    tooth_height: float


def method_b_factors(
    of: RunningPair, given: LoadFactors, dynamic: bool = True, transverse: bool = True
) -> LoadFactors:
    """Load factors of a pair by method B of ISO 6336-1.

    Parameters
    ----------
    of : RunningPair
        The pair, as it runs.
    given : LoadFactors
        Factors that are given; K_Fbeta follows from K_Hbeta.
    dynamic : bool
        Whether K_v is computed, or as given.
    transverse : bool
        Whether K_Halpha and K_Falpha are computed, or as given.

    Returns
    -------
    LoadFactors
        K_v of deviations less running-in and of the relief by running-in; K_Halpha of the larger
        deviation less the running-in of the pitch.
    """
    pair, running = of.pair, of.running
    c_single, c_mesh = of.stiffness
    speed = running.speed * pair.first.reference_radius
    pitch, profile = of.deviations

    def lost(deviation: float) -> float:
        return 0.5 * sum(running_in(m, deviation, speed) for m in of.materials)

    load = pair.tangential_force(running.torque) * given.K_A * given.K_gamma / pair.face_width
    K_v = given.K_v
    if dynamic:
        ratio = running.speed / resonance_speed(c_mesh, of.mass, pair.first.teeth)
        relief = running_in_relief(*of.materials)
        stays = Deviations(pitch - lost(pitch), profile - lost(profile), relief)
        K_v = dynamic_factor(ratio, load, c_single, pair.contact_ratio, stays)
    K_H, K_F = given.K_Halpha, given.K_Falpha
    if transverse:
        worst = max(of.deviations) - lost(pitch)
        K_H, K_F = transverse_factors(pair, c_mesh, worst, load * K_v * given.K_Hbeta)
    K_Fbeta = root_face_factor(given.K_Hbeta, pair.face_width, of.tooth_height)
    return replace(given, K_v=K_v, K_Fbeta=K_Fbeta, K_Halpha=K_H, K_Falpha=K_F)
