"""Damage of teeth by the forces of their meshes in time, and their static safety at the peak."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.mesh_loads import MeshLoads
from fe_drivetrain.gear.damage import ToothDamage
from fe_drivetrain.studies.gear_levels import LoadSpread, Spread
from fe_drivetrain.studies.gear_machine import GearTrain
from fe_drivetrain.studies.gear_meshes import GearMesh, gear_meshes
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_spectra import TorqueSpectrum, merged
from fe_drivetrain.studies.gear_stresses import MeshStresses
from fe_drivetrain.studies.part_loads import PartDigest
from fe_drivetrain.studies.tooth_damage import FlankDamage, mesh_damage

_ONCE = 1e-9  # turns at a peak: too few for any damage but that of what yields at once

Pair = tuple[PartDigest, PartDigest]
"""The same history with a step, and with twice that step."""


@dataclass(frozen=True, eq=False)
class FlankUse:
    """What histories do to one flank of a gear.

    Attributes
    ----------
    name, mesh : str
        As `gears` names them: "stage 1 sun", "stage 1 sun-planet".
    damage : ToothDamage
        Damage of an event, or of a year, with the safety that is required; 1 is failure.
    band : float
        Numerical uncertainty of the largest of it.
    peak : float
        Largest torque of the rotor that the force of its mesh stands for, of either sign [N m].
    contact_safety, root_safety : float or None
        Static safety of flank and root at that torque; None of a root that is not rated.
    required : tuple of float
        Least safety of flank and root.
    of_histories : tuple of float
        Largest damage of each history, as often as it is itself.
    """

    name: str
    mesh: str
    damage: ToothDamage
    band: float
    peak: float
    contact_safety: float
    root_safety: float | None
    required: tuple[float, float]
    of_histories: tuple[float, ...] = ()

    __repr__ = short_repr


class GearUses:
    """Gears of a drivetrain at a level, ready for what histories count.

    Parameters
    ----------
    train : GearTrain
        The machine.
    rung : Rung
        Level by which meshes spread their load, and what gives.

    Attributes
    ----------
    left_out : tuple of str
        What is not rated and why, as sentences.
    """

    def __init__(self, train: GearTrain, rung: Rung) -> None:
        self._train, self._rung = train, rung
        meshes, lacking = gear_meshes(train.machine, train.strengths)
        made = {name: MeshStresses(one, train.conditions) for name, one in meshes.items()}
        self._rated = {name: one for name, one in made.items() if one.rated}
        said = [
            f"Teeth of {name} are not rated: {why} not stated." for name, why in lacking.items()
        ]
        for name, mesh in meshes.items():
            said += self._said(name, mesh)
        self.left_out = tuple(said)

    def _said(self, name: str, mesh: GearMesh) -> list[str]:
        """What is not rated of a mesh whose gears are given."""
        if name not in self._rated:
            keys = [key for key in mesh.missing if not key.endswith("grade")]
            keys += self._train.missing
            return [f"Teeth of {name} are not rated: {', '.join(keys)} not stated."]
        return [] if mesh.knows_roots else [f"Roots of {name} are not rated: cutter not stated."]

    def under(
        self, digests: Sequence[PartDigest], times: Sequence[float], coarser: Pair | None
    ) -> dict[str, FlankUse]:
        """What histories that come so many times do to all flanks.

        Parameters
        ----------
        digests : sequence of PartDigest
            Each history.
        times : sequence of float
            How often each comes.
        coarser : tuple of PartDigest or None
            One history with two steps, for the band of the step.
        """
        if not self._rated:
            return {}
        alone = any(one.alone for one in digests)
        fine, coarse = (
            self._spreads(count, alone)
            for count in (GearOptions.slices, (GearOptions.slices + 1) // 2)
        )
        found: dict[str, FlankUse] = {}
        for name, stresses in self._rated.items():
            parts = [one.meshes[name].times(n) for one, n in zip(digests, times, strict=True)]
            of = _Mesh(name, stresses, merged(parts, parts[0].width), fine, coarse)
            pair = [] if coarser is None else [one.meshes[name] for one in coarser]
            found |= of.uses(digests, pair)
        return found

    def _spreads(self, slices: int, alone: bool) -> _Spreads:
        train = self._train
        loads = LoadSpread(
            train.machine,
            self._rated,
            self._rung,
            GearOptions.azimuths,
            slices,
            alone,  # hub loads of files hold the weight of the rotor already
            train.torque,
        )
        return _Spreads(loads, alone)


class _Spreads:
    """Spreads of loads over planets and face, of each class of torque once."""

    def __init__(self, loads: LoadSpread, alone: bool) -> None:
        self._loads, self._alone = loads, alone
        self._found: dict[tuple[float, int], MeshLoads | None] = {}

    def of(self, spectrum: TorqueSpectrum, mesh: str) -> list[Spread]:
        """Spread of a mesh in each class of a spectrum."""
        rows = zip(
            spectrum.torques.tolist(), spectrum.hub, spectrum.speeds(0.0).tolist(), strict=True
        )
        return [self.one(*row, spectrum.width)[mesh] for row in rows]

    def one(self, torque: float, hub: Floats, speed: float, width: float) -> dict[str, Spread]:
        """Spread of all meshes in a class: by statics of what asked for it first."""
        key = (width, round(torque / width))
        if key not in self._found:
            self._found[key] = self._loads.statics(torque, np.zeros(6) if self._alone else hub)
        return self._loads.spread(self._found[key], torque, speed)


@dataclass(frozen=True)
class _Mesh:
    """A mesh whose flanks have a strength, with its turns by torque and how it spreads them."""

    name: str
    stresses: MeshStresses
    whole: TorqueSpectrum
    fine: _Spreads
    coarse: _Spreads

    def uses(
        self, digests: Sequence[PartDigest], pair: Sequence[TorqueSpectrum]
    ) -> dict[str, FlankUse]:
        """What is done to both flanks."""
        spreads, strength = self.fine.of(self.whole, self.name), self.stresses.mesh.strength
        assert strength is not None
        best, others = self._damage(self.whole, spreads), self._others(spreads)
        peak = max((value for one in digests for value in one.peaks[self.name]), key=abs)
        at_peak = self._at_peak(peak)
        steps, each = (
            [self._damage(one, self.fine.of(one, self.name)) for one in of]
            for of in (pair, [one.meshes[self.name] for one in digests])
        )
        found = {}
        for name, one in best.items():
            band = sum(abs(_largest(other[name]) - _largest(one)) for other in others)
            if steps and _largest(steps[0][name]):
                moved = abs(_largest(steps[1][name]) / _largest(steps[0][name]) - 1.0)
                band += moved * _largest(one)
            found[name] = FlankUse(
                name,
                self.name,
                one.damage,
                band,
                peak,
                at_peak[name].contact_safety,
                at_peak[name].root_safety,
                (strength.contact_safety, strength.root_safety),
                tuple(_largest(of[name]) for of in each),
            )
        return found

    def _damage(
        self, spectrum: TorqueSpectrum, spreads: Sequence[Spread], factors: bool = False
    ) -> dict[str, FlankDamage]:
        """Damage of both flanks; K_A is 1, since the forces hold what it stands for."""
        return mesh_damage(self.stresses, spectrum, spreads, 1.0, factors)

    def _others(self, spreads: Sequence[Spread]) -> list[dict[str, FlankDamage]]:
        """The same with half the azimuths, fewer slices, and classes of twice the width."""
        wide = self.whole.coarser()
        return [
            *(self._damage(self.whole, [one.halves[half] for one in spreads]) for half in (0, 1)),
            self._damage(self.whole, self.coarse.of(self.whole, self.name)),
            self._damage(wide, self.fine.of(wide, self.name)),
        ]

    def _at_peak(self, peak: float) -> dict[str, FlankDamage]:
        """Both flanks at the largest torque, once, at the speed of the class that is nearest."""
        nearest = int(np.abs(self.whole.torques - peak).argmin())
        hub, speed = self.whole.hub[nearest], float(self.whole.speeds(0.0)[nearest])
        turns, seconds = np.array([_ONCE]), np.ones(1)
        if speed > 0.0:
            seconds = 2.0 * np.pi * turns / speed
        once = TorqueSpectrum(abs(peak), np.array([peak]), seconds, turns, hub[None])
        return self._damage(once, [self.fine.one(peak, hub, speed, 1.0)[self.name]], factors=True)


def _largest(one: FlankDamage) -> float:
    """Largest damage of a flank, or of its root."""
    return one.damage.largest
