"""Stresses of a mesh by ISO 6336 over torque and local load, with its K factors and strength."""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import log

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.gear.load_factors import LoadFactors, face_factor, root_face_factor
from fe_drivetrain.gear.pair_factors import RunningPair, method_b_factors
from fe_drivetrain.gear.rating import (
    Running,
    contact_stress,
    endured_contact,
    endured_root,
    root_stress,
)
from fe_drivetrain.gear.strength import LifeCurve
from fe_drivetrain.studies.gear_meshes import GearMesh

SHARING = {1: 1.0, 2: 1.0, 3: 1.10, 4: 1.25, 5: 1.35, 6: 1.43, 7: 1.50}
"""K_gamma of planets in a stage of good accuracy, by their number (IEC 61400-4; second-hand)."""


@dataclass(frozen=True)
class Conditions:
    """How the gears run.

    Attributes
    ----------
    speed : float or None
        Rated speed of the rotor [rad/s].
    viscosity : float or None
        Kinematic viscosity of the oil at 40 degC [m^2/s].
    """

    speed: float | None
    viscosity: float | None


@dataclass(frozen=True)
class Curves:
    """What one flank endures: contact and root stress over loads of a tooth."""

    contact: LifeCurve
    root: LifeCurve | None


class MeshStresses:
    """Stresses of a mesh under any torque of the rotor.

    Parameters
    ----------
    mesh : GearMesh
        The mesh.
    conditions : Conditions
        Rated speed, and oil.

    Attributes
    ----------
    rated : bool
        Whether there is all that safety factors need.
    """

    def __init__(self, mesh: GearMesh, conditions: Conditions) -> None:
        self.mesh, self.conditions = mesh, conditions
        one = contact_stress(mesh.pair, 1.0, LoadFactors(), mesh.materials)
        self._contact = np.array(one.Z_BD) * one.nominal
        self.roots = None
        if mesh.knows_roots:
            rims = [None if f.steel is None else f.steel.rim for f in mesh.flanks]
            self.roots = root_stress(mesh.pair, 1.0, LoadFactors(), mesh.cutter, (rims[0], rims[1]))
        self.rated = mesh.strength is not None and None not in (
            conditions.speed,
            conditions.viscosity,
        )

    def torque(self, rotor: float) -> float:
        """Torque on the first gear in one planet's mesh, equally shared [N m]."""
        return abs(rotor) * self.mesh.torque_ratio

    def line_load(self, rotor: float) -> float:
        """Tangential force per face width, F_t / b [N/m]."""
        pair = self.mesh.pair
        return pair.tangential_force(self.torque(rotor)) / pair.face_width

    def contact(self, rotor: Floats | float, factor: Floats | float = 1.0) -> Floats:
        """(..., 2) contact stress of both gears under a torque and a factor on the load [Pa]."""
        load = np.abs(np.asarray(rotor)) * self.mesh.torque_ratio * np.asarray(factor)
        return np.asarray(np.sqrt(load)[..., None] * self._contact)

    def root(self, rotor: Floats | float, factor: Floats | float = 1.0) -> Floats | None:
        """(..., 2) root stress of both gears [Pa]; None of a ring whose cutter is not known."""
        if self.roots is None:
            return None
        load = np.abs(np.asarray(rotor)) * self.mesh.torque_ratio * np.asarray(factor)
        return np.asarray(load[..., None] * np.array([one.nominal for one in self.roots]))

    @property
    def root_exponent(self) -> float:
        """N_F of K_Fbeta = K_Hbeta^N_F."""
        mesh = self.mesh
        return log(root_face_factor(np.e, mesh.pair.face_width, mesh.tooth_height))

    def misaligned(self, rotor: float, speed: float | None, start: LoadFactors) -> float:
        """K_Hbeta by the helix deviation of the accuracy grade alone; 1 without a grade.

        The deviation is fixed, so that the factor grows as the load falls. That load is F_m = F_t
        K_A K_gamma K_v: less would let the stress grow as the torque of a turning gear falls.

        Parameters
        ----------
        rotor : float
            Torque of the rotor [N m].
        speed : float or None
            Its speed [rad/s]; without one K_v is that of `start`.
        start : LoadFactors
            With K_A and K_gamma.
        """
        deviations = self.mesh.deviations
        if deviations is None:
            return 1.0
        K = self._with_dynamics(rotor, speed, start, transverse=False)
        load = self.line_load(rotor) * K.K_A * K.K_gamma * K.K_v
        return face_factor(deviations[2], self.mesh.stiffness.misaligned, load)

    def formula(self, rotor: float, speed: float | None, application: float) -> tuple[float, float]:
        """K_gamma and K_Hbeta as given, or by formula: of the torsional level.

        Parameters
        ----------
        rotor : float
            Torque of the rotor [N m].
        speed : float or None
            Its speed [rad/s].
        application : float
            K_A.
        """
        mesh, given = self.mesh, self.mesh.strength
        sharing = SHARING.get(mesh.planets, SHARING[7])
        if given is not None and given.sharing is not None and mesh.planets > 1:
            sharing = given.sharing
        faces = {} if given is None else given.face_load or {}
        if mesh.key in faces:
            return sharing, faces[mesh.key]
        return sharing, self.misaligned(rotor, speed, LoadFactors(application, sharing))

    def factors(self, rotor: float, speed: float | None, start: LoadFactors) -> LoadFactors:
        """Load factors at a torque and speed of the rotor, those of `start` given.

        Parameters
        ----------
        rotor : float
            Torque of the rotor [N m].
        speed : float or None
            Its speed [rad/s].
        start : LoadFactors
            With K_A, K_gamma and K_Hbeta.
        """
        return self._with_dynamics(rotor, speed, start, transverse=True)

    def _with_dynamics(
        self, rotor: float, speed: float | None, start: LoadFactors, transverse: bool
    ) -> LoadFactors:
        mesh, given, deviations = self.mesh, self.mesh.strength, self.mesh.deviations
        dynamic = None if given is None else (given.dynamic or {}).get(mesh.key)
        start = start if dynamic is None else replace(start, K_v=dynamic)
        if deviations is None or not speed:
            beta = start.K_Hbeta**self.root_exponent
            return replace(start, K_Fbeta=beta)
        of = RunningPair(
            mesh.pair,
            mesh.materials,
            self._running(rotor, speed),
            (mesh.stiffness.single, mesh.stiffness.mesh),
            mesh.mass,
            deviations[:2],
            mesh.tooth_height,
        )
        return method_b_factors(of, start, dynamic is None, transverse)

    def _running(self, rotor: float, speed: float) -> Running:
        flank, fillet = (4.8e-6, 4.8e-6), (20e-6, 20e-6)
        steels = [f.steel for f in self.mesh.flanks if f.steel is not None]
        if len(steels) == 2:
            flank = (steels[0].flank_roughness, steels[1].flank_roughness)
            fillet = (steels[0].root_roughness, steels[1].root_roughness)
        turning = abs(speed) * self.mesh.speed_ratio
        oil = self.conditions.viscosity or 320e-6
        return Running(self.torque(rotor), turning, oil, flank, fillet)

    def curves(self, rotor: float) -> tuple[Curves, Curves] | None:
        """What both flanks endure at the rated speed; None where strength is not stated."""
        speed = self.conditions.speed
        if not self.rated or speed is None:
            return None
        mesh, running = self.mesh, self._running(rotor, speed)
        contact = endured_contact(mesh.pair, running, mesh.materials)
        found = []
        for number, flank in enumerate(mesh.flanks):
            root = None
            if self.roots is not None:
                root = endured_root(
                    flank.gear,
                    self.roots[number].root,
                    flank.material,
                    running.root_roughness[number],
                    flank.mean_stress,
                ).curve
            found.append(Curves(contact[number].curve, root))
        return found[0], found[1]


def spread_at_ends(slices: Floats) -> Floats:
    """Loads (..., s) of slices with both ends of the face: (..., s + 2); at least 0.

    The ends are where the last two slices go on in a straight line, as `peak_over_mean` has it.
    """
    if slices.shape[-1] < 2:
        return slices
    low = 1.5 * slices[..., :1] - 0.5 * slices[..., 1:2]
    high = 1.5 * slices[..., -1:] - 0.5 * slices[..., -2:-1]
    return np.asarray(np.maximum(np.concatenate([low, slices, high], axis=-1), 0.0))
