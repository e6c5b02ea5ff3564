"""Damage of gears by the turns at each torque: how often a tooth is loaded, and what that does.

A flank is pressed from nothing to its full load each time its tooth meshes, so that turns at each
level of torque are what counts, not cycles of the torque's history (IEC 61400-4, ISO 6336-6). A
torque of the other sign loads the other flank, and bends the root the other way: both are kept
apart.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import log

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.gear.strength import LifeCurve
from fe_drivetrain.turbine_loads.histories.levels import Levels


@dataclass(frozen=True)
class PlanetaryStage:
    """Teeth of a planetary stage with a fixed ring; the carrier drives.

    Attributes
    ----------
    sun, planet, ring : int
        Teeth, counted positive.
    planets : int
        Number of planets.
    """

    sun: int
    planet: int
    ring: int
    planets: int = 3

    @property
    def ratio(self) -> float:
        """Turns of the sun per turn of the carrier."""
        return 1.0 + self.ring / self.sun


@dataclass(frozen=True)
class ParallelStage:
    """Teeth of a pair; the gear drives.

    Attributes
    ----------
    gear, pinion : int
        Teeth.
    """

    gear: int
    pinion: int

    @property
    def ratio(self) -> float:
        """Turns of the pinion per turn of the gear."""
        return self.gear / self.pinion


def loads_per_turn(stages: Sequence[PlanetaryStage | ParallelStage]) -> dict[str, float]:
    """Number of loads of one flank of a tooth per turn of the first shaft.

    Parameters
    ----------
    stages : sequence
        Stages, from the slow shaft to the fast one.

    Returns
    -------
    dict
        Loads of one flank per turn, by name ("stage 1 ring" and so on): the ring's once by each
        planet, the sun's by each planet as it turns against the carrier, a planet's z_r / z_p times
        on the flank that meets the sun, and as often on the one that meets the ring: these are two
        flanks.

    Raises
    ------
    InputError
        Teeth or planets are not positive.
    """
    found: dict[str, float] = {}
    turns = 1.0
    for number, stage in enumerate(stages, start=1):
        if min(vars(stage).values()) < 1:
            raise InputError(f"stage {number} has {vars(stage)}: give positive numbers of teeth")
        name = f"stage {number} "
        if isinstance(stage, PlanetaryStage):
            found[name + "ring"] = turns * stage.planets
            found[name + "planet, flank to ring"] = turns * stage.ring / stage.planet
            found[name + "planet, flank to sun"] = turns * stage.ring / stage.planet
            found[name + "sun"] = turns * stage.planets * (stage.ratio - 1.0)
        else:
            found[name + "gear"] = turns
            found[name + "pinion"] = turns * stage.ratio
        turns *= stage.ratio
    return found


@dataclass(frozen=True)
class RatedTooth:
    """A tooth, with its stresses under one torque of a reference shaft, and what it endures.

    Attributes
    ----------
    name : str
        Name of the gear, or of its flank.
    loads_per_turn : float
        Loads of one flank, per turn of the reference shaft.
    torque : float
        Torque of the reference shaft [N m].
    contact : float
        Contact stress sigma_H under the torque, with a safety factor if one is asked for [Pa].
    root : float
        Root stress sigma_F under the torque [Pa].
    contact_curve, root_curve : LifeCurve
        Stresses endured over loads of one flank.
    """

    name: str
    loads_per_turn: float
    torque: float
    contact: float
    root: float
    contact_curve: LifeCurve
    root_curve: LifeCurve

    def __post_init__(self) -> None:
        for name in ("loads_per_turn", "torque", "contact", "root"):
            if not getattr(self, name) > 0.0:
                raise InputError(
                    f"{name.replace('_', ' ')} of {self.name} is {getattr(self, name):g}: give a "
                    "positive one"
                )


@dataclass(frozen=True)
class ToothDamage:
    """Damage of both flanks and of both sides of the root; 1 is failure (Miner's rule).

    Attributes
    ----------
    flank, back : float
        Damage of the flank that a positive torque loads, and of the other.
    root, root_back : float
        Damage of the fillets on either side.
    """

    flank: float
    back: float
    root: float
    root_back: float

    @property
    def largest(self) -> float:
        """Maximum of the four damages."""
        return max(self.flank, self.back, self.root, self.root_back)

    def __add__(self, other: ToothDamage) -> ToothDamage:
        """Sum of the damages of both."""
        return ToothDamage(*(getattr(self, n) + getattr(other, n) for n in vars(self)))

    def times(self, count: float) -> ToothDamage:
        """Damage of the same, that many times.

        Parameters
        ----------
        count : float
            Number of times.

        Returns
        -------
        ToothDamage
            Each multiplied.
        """
        return ToothDamage(*(count * value for value in vars(self).values()))


def damage_of_turns(tooth: RatedTooth, torques: ArrayLike, turns: ArrayLike) -> ToothDamage:
    """Damage of turns at torques of the reference shaft.

    Parameters
    ----------
    tooth : RatedTooth
        Gear tooth, with its stresses and life curves.
    torques : array_like, (n,)
        Torques of the reference shaft [N m]; negative ones load the other flank.
    turns : array_like, (n,)
        Turns of the reference shaft at each torque.

    Returns
    -------
    ToothDamage
        Damage with contact stress that goes with the root of the torque, and root stress with the
        torque: load factors stay as they are at the torque of the rating.
    """
    load = np.asarray(torques, dtype=np.float64) / tooth.torque
    counts = np.asarray(turns, dtype=np.float64) * tooth.loads_per_turn

    def of(side: float) -> tuple[float, float]:
        share = np.maximum(side * load, 0.0)
        flank = _miner(tooth.contact * np.sqrt(share), counts, tooth.contact_curve)
        return flank, _miner(tooth.root * share, counts, tooth.root_curve)

    (flank, root), (back, root_back) = of(1.0), of(-1.0)
    return ToothDamage(flank, back, root, root_back)


def damage_of_levels(tooth: RatedTooth, levels: Levels) -> ToothDamage:
    """Damage of a load revolution distribution.

    Parameters
    ----------
    tooth : RatedTooth
        Gear tooth, with its stresses and life curves.
    levels : Levels
        Turns of the reference shaft at levels of its torque (`histories.revolutions_at_level`).

    Returns
    -------
    ToothDamage
        Damage with every level at its middle.
    """
    return damage_of_turns(tooth, levels.middles, levels.amount)


def damage_of_history(
    tooth: RatedTooth, torque: ArrayLike, speed: ArrayLike, step: float
) -> ToothDamage:
    """Damage of a history of torque and speed, sample by sample.

    Parameters
    ----------
    tooth : RatedTooth
        Gear tooth, with its stresses and life curves.
    torque : array_like, (n,)
        Torque of the reference shaft [N m].
    speed : array_like, (n,) or float
        Speed of the reference shaft [rad/s].
    step : float
        Time between two samples [s].

    Returns
    -------
    ToothDamage
        Damage of the whole history.
    """
    turns = np.abs(np.asarray(speed, dtype=np.float64)) * step / (2.0 * np.pi)
    return damage_of_turns(tooth, torque, np.broadcast_to(turns, np.shape(torque)))


def _miner(stress: Floats, counts: Floats, curve: LifeCurve) -> float:
    loaded = (stress > 0.0) & (counts > 0.0)
    with np.errstate(divide="ignore"):
        return float(np.sum(counts[loaded] / curve.endured(stress[loaded])))


def torque_exponent(curve: LifeCurve, root: bool = False, segment: int = 0) -> float:
    """Exponent of the torque in damage, on one straight part of a life curve.

    Parameters
    ----------
    curve : LifeCurve
        Life curve of contact or root stress.
    root : bool
        Whether stress goes with the torque, as in the root; with its root in contact.
    segment : int
        Index of the straight part, from the first.

    Returns
    -------
    float
        p of the equivalent torque (sum n T^p / sum n)^(1/p), `histories.equivalent_level`.
    """
    here, there = segment, segment + 1
    fall = log(curve.stresses[here] / curve.stresses[there])
    slope = log(curve.cycles[there] / curve.cycles[here]) / fall
    return slope if root else 0.5 * slope
