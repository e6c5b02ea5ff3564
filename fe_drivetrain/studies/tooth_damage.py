"""Damage of teeth under a torque spectrum, place by place: over the face, and round a ring."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.gear.damage import ToothDamage
from fe_drivetrain.gear.load_factors import LoadFactors
from fe_drivetrain.gear.strength import LifeCurve
from fe_drivetrain.studies.gear_levels import LoadSpread, Spread
from fe_drivetrain.studies.gear_spectra import TorqueSpectrum
from fe_drivetrain.studies.gear_stresses import MeshStresses

_STEPS = 50  # of a bisection between factors
_FACTORS = (0.02, 50.0)


@dataclass(frozen=True, eq=False)
class FlankDamage:
    """Damage of one flank of a gear, with the safety that is required on its stresses.

    Attributes
    ----------
    damage : ToothDamage
        Damage of the tooth and place with most of it; 1 is failure.
    along : ndarray, (s,)
        Damage of the driving flank over the face, of the tooth with most.
    of_classes : ndarray, (n,)
        Damage of the driving flank by class of torque, at the place with most.
    of_teeth : ndarray, (a,) or (0,)
        Damage of the driving flank of the ring's teeth, by azimuth; empty of gears whose teeth
        all see the same.
    contact_safety, root_safety : float or None
        Factor on all stresses with which the spectrum just brings failure (ISO 6336-6); None of a
        root that is not rated, NaN where they were not asked for.
    """

    damage: ToothDamage
    along: Floats
    of_classes: Floats
    of_teeth: Floats
    contact_safety: float
    root_safety: float | None

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class _Loading:
    """Stresses (n, a, p, s) of one flank over a spectrum, and loads of a tooth (n,) in each class.

    ``ring`` says that its teeth are told apart.
    """

    stress: Floats
    counts: Floats
    curve: LifeCurve
    forward: Bools
    ring: bool

    def by_place(self, safety: float, side: Bools) -> Floats:
        """(teeth, n, s) damage of each class, of the teeth that are told apart."""
        counts = np.where(side, self.counts, 0.0)[:, None, None, None]
        with np.errstate(divide="ignore", invalid="ignore"):
            once = np.where(counts > 0.0, counts / self.curve.endured(safety * self.stress), 0.0)
        if not self.ring:
            return np.asarray(once.mean(axis=(1, 2))[None])
        count, planets = once.shape[1:3]
        # the tooth at an azimuth meets planet k where the carrier is a k-th of a turn behind
        shifted = [
            np.roll(once[:, :, k], round(k * count / planets), axis=1) for k in range(planets)
        ]
        return np.asarray(np.mean(shifted, axis=0).transpose(1, 0, 2))

    def largest(self, safety: float) -> float:
        """Damage of the worst tooth, place and side."""
        return max(
            float(self.by_place(safety, side).sum(axis=1).max())
            for side in (self.forward, ~self.forward)
        )

    def safety(self) -> float:
        """Factor on the stresses with which the damage is 1."""
        low, high = _FACTORS
        for _ in range(_STEPS):
            middle = np.sqrt(low * high)
            low, high = (middle, high) if self.largest(middle) < 1.0 else (low, middle)
        return float(low)


def mesh_damage(
    stresses: MeshStresses,
    spectrum: TorqueSpectrum,
    spreads: Sequence[Spread],
    application: float,
    factors: bool = True,
) -> dict[str, FlankDamage]:
    """Damage of both flanks of a mesh.

    Parameters
    ----------
    stresses : MeshStresses
        The mesh, rated.
    spectrum : TorqueSpectrum
        Torques and turns of the rotor.
    spreads : sequence of Spread
        How the mesh spreads its load in each class.
    application : float
        K_A; 1 of a spectrum that has the loads of the machine in it.
    factors : bool
        Whether factors that just bring failure are asked for, which takes most of the time.

    Returns
    -------
    damage : dict of str to FlankDamage
        By the names of the flanks; empty where the strength is not stated.
    """
    mesh, strength = stresses.mesh, stresses.mesh.strength
    curves = stresses.curves(float(np.abs(spectrum.torques).max()))
    if curves is None or strength is None:
        return {}
    share = np.array([one.share for one in spreads])[..., None]
    face = np.array([one.face for one in spreads])
    K = _dynamics(stresses, spectrum, spreads, application)
    contact = stresses.contact(spectrum.torques, np.array([one.contact for one in K]))
    roots = stresses.root(spectrum.torques, np.array([one.root for one in K]))
    forward, found = spectrum.torques > 0.0, {}
    for number, flank in enumerate(mesh.flanks):
        counts = spectrum.turns * flank.loads
        ring = mesh.turns_with_rotor and flank.gear.internal and face.shape[1] > 1
        pressed = contact[:, number, None, None, None] * np.sqrt(share * face)
        of_flank = _Loading(pressed, counts, curves[number].contact, forward, ring)
        of_root, curve = None, curves[number].root
        if roots is not None and curve is not None:
            bent = roots[:, number, None, None, None] * share * face**stresses.root_exponent
            of_root = _Loading(bent, counts, curve, forward, ring)
        required = strength.contact_safety, strength.root_safety
        found[flank.name] = _damage(of_flank, of_root, required, factors)
    return found


def _damage(
    flank: _Loading, root: _Loading | None, required: tuple[float, float], factors: bool
) -> FlankDamage:
    places = flank.by_place(required[0], flank.forward)
    teeth = places.sum(axis=1)
    tooth, place = np.unravel_index(int(np.argmax(teeth)), teeth.shape)
    back = float(flank.by_place(required[0], ~flank.forward).sum(axis=1).max())
    of_root = [0.0, 0.0]
    if root is not None:
        of_root = [
            float(root.by_place(required[1], side).sum(axis=1).max())
            for side in (root.forward, ~root.forward)
        ]
    return FlankDamage(
        ToothDamage(float(teeth.max()), back, *of_root),
        teeth[tooth],
        places[tooth, :, place],
        teeth.max(axis=1) if flank.ring else np.zeros(0),
        flank.safety() if factors else np.nan,
        None if root is None else root.safety() if factors else np.nan,
    )


def _dynamics(
    stresses: MeshStresses,
    spectrum: TorqueSpectrum,
    spreads: Sequence[Spread],
    application: float,
) -> list[LoadFactors]:
    """K_v and the transverse factors of each class; the spread is in the local loads."""
    rated = stresses.conditions.speed or 0.0
    found = []
    for torque, speed, spread in zip(
        spectrum.torques.tolist(), spectrum.speeds(rated).tolist(), spreads, strict=True
    ):
        given = LoadFactors(application, spread.sharing, 1.0, spread.face_load)
        if torque == 0.0:
            found.append(LoadFactors(application))
            continue
        whole = stresses.factors(torque, speed, given)
        found.append(
            LoadFactors(
                application, K_v=whole.K_v, K_Halpha=whole.K_Halpha, K_Falpha=whole.K_Falpha
            )
        )
    return found


def gear_damage(
    stresses: Mapping[str, MeshStresses],
    spectrum: TorqueSpectrum,
    loads: LoadSpread,
    application: Mapping[str, float],
    half: int | None = None,
) -> dict[str, FlankDamage]:
    """Damage of all flanks that are rated.

    Parameters
    ----------
    stresses : mapping of str to MeshStresses
        Meshes by name.
    spectrum : TorqueSpectrum
        Torques and turns of the rotor, with the other loads of the hub.
    loads : LoadSpread
        How a level spreads them.
    application : mapping of str to float
        K_A by mesh.
    half : int or None
        Every other azimuth alone, from the first (0) or the second (1); None takes all.
    """
    rated = next((one.conditions.speed for one in stresses.values()), None) or 0.0
    rows = zip(
        spectrum.torques.tolist(), spectrum.hub, spectrum.speeds(rated).tolist(), strict=True
    )
    classes = [loads.under(torque, hub, speed, application) for torque, hub, speed in rows]
    found: dict[str, FlankDamage] = {}
    for name, one in stresses.items():
        spreads = [each[name] if half is None else each[name].halves[half] for each in classes]
        found |= mesh_damage(one, spectrum, spreads, application[name])
    return found
