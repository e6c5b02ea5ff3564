"""What a rating of gears finds of each gear, mesh and level."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.gear.involute import Pair
from fe_drivetrain.gear.load_factors import LoadFactors
from fe_drivetrain.studies.gear_levels import Spread
from fe_drivetrain.studies.tooth_damage import FlankDamage


@dataclass(frozen=True, eq=False)
class MeshAnswer:
    """One mesh at the reference torque.

    Attributes
    ----------
    name : str
        As `machine_pairs` names it.
    pair : Pair or None
        Its gears; None where the file does not give them in full.
    torque : float
        Torque on the first gear in one planet's mesh, equally shared [N m]; NaN without a pair.
    force : float
        Tangential force at its reference circle, F_t [N]; NaN without a pair.
    factors : LoadFactors
        Load factors with which it is rated.
    spread : Spread
        How it spreads its load at the level of the rating.
    sharing_band, face_band : float
        Numerical uncertainty of K_gamma and of K_Hbeta by fewer azimuths and slices.
    stress_band : float
        The same of the load that both make, relative.
    balance : float
        Mean force of the meshes by statics over that of the torque; NaN where there are no statics.
    """

    name: str
    pair: Pair | None
    torque: float
    force: float
    factors: LoadFactors
    spread: Spread
    sharing_band: float
    face_band: float
    stress_band: float
    balance: float

    __repr__ = short_repr

    @property
    def along(self) -> Floats:
        """Load over the mean along the face, (s,), at the azimuth and planet with most of it."""
        local = self.spread.share[..., None] * self.spread.face
        at, planet, _ = np.unravel_index(int(np.argmax(local)), local.shape)
        return np.asarray(local[at, planet])

    @property
    def places(self) -> Floats:
        """(s,) places of `along` on the face, from -0.5 at the smallest x to 0.5."""
        count = len(self.along)
        if count < 3:
            return np.zeros(count)
        middles = (np.arange(count - 2) + 0.5) / (count - 2) - 0.5
        return np.concatenate([[-0.5], middles, [0.5]])


@dataclass(frozen=True)
class LifeBands:
    """Numerical uncertainty of what a spectrum does to a flank.

    Attributes
    ----------
    damage : float
        That of the largest damage.
    contact_safety, root_safety : float
        That of the factors that just bring failure.
    """

    damage: float
    contact_safety: float
    root_safety: float


@dataclass(frozen=True, eq=False)
class GearAnswer:
    """One flank of a gear at the reference torque, and over the spectrum.

    Attributes
    ----------
    name : str
        As `loads_per_turn` names it, "stage 1 sun".
    mesh : str
        Its mesh.
    contact_stress : float
        sigma_H [Pa].
    root_stress : float or None
        sigma_F [Pa]; None of a ring whose cutter is not given.
    contact_safety, root_safety : float or None
        S_H and S_F at the reference torque over the hours asked for; None where the strength is not
        stated.
    contact_band, root_band : float or None
        Their numerical uncertainty.
    required : tuple of float or None
        Least S_H and S_F.
    life : FlankDamage or None
        Damage over the spectrum, or of the constant torque.
    bands : LifeBands or None
        Numerical uncertainty of what is over the spectrum.
    life_hours : float
        Hours until failure with the safety required; infinite without damage, NaN where the
        strength is not stated.
    missing : tuple of str
        Keys that the file lacks.
    """

    name: str
    mesh: str
    contact_stress: float
    root_stress: float | None
    contact_safety: float | None
    root_safety: float | None
    contact_band: float | None
    root_band: float | None
    required: tuple[float, float] | None
    life: FlankDamage | None
    bands: LifeBands | None
    life_hours: float
    missing: tuple[str, ...]

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class LevelAnswer:
    """One level of the ladder at the reference torque.

    Attributes
    ----------
    name : str
        Name of the level.
    seconds : float
        Time taken [s].
    factors : dict of str to tuple of float
        K_gamma and K_Hbeta of each mesh.
    difference : float
        Largest difference of a contact stress from that of the finest level, relative.
    """

    name: str
    seconds: float
    factors: dict[str, tuple[float, float]]
    difference: float


@dataclass(frozen=True)
class Safety:
    """A safety factor with its band and the least that is asked for."""

    value: float
    band: float
    required: float


def safeties(gear: GearAnswer, varies: bool) -> tuple[Safety | None, Safety | None]:
    """S_H and S_F: over the spectrum where there is one of several torques.

    Parameters
    ----------
    gear : GearAnswer
        A flank.
    varies : bool
        Whether there is such a spectrum.
    """
    if gear.required is None:
        return None, None
    values = (gear.contact_safety, gear.contact_band), (gear.root_safety, gear.root_band)
    if varies and gear.life is not None and gear.bands is not None:
        life, bands = gear.life, gear.bands
        values = (
            (life.contact_safety, bands.contact_safety),
            (life.root_safety, bands.root_safety),
        )
    contact, root = (
        None if value is None else Safety(value, band or 0.0, least)
        for (value, band), least in zip(values, gear.required, strict=True)
    )
    return contact, root


def largest_difference(
    mine: dict[str, tuple[float, float]], finest: dict[str, tuple[float, float]]
) -> float:
    """Largest relative difference of a contact stress, by the root of the load of each mesh."""
    loads = [np.prod(mine[name]) / np.prod(finest[name]) for name in finest]
    return float(max(abs(np.sqrt(load) - 1.0) for load in loads))
