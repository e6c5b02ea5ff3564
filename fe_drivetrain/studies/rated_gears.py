"""Gears rated step by step: levels, meshes, damage, and what each flank endures."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np

from fe_drivetrain.common.steps import Steps
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.condensed_rungs import SOFT_SEATS, STIFF_SEATS
from fe_drivetrain.gear.load_factors import LoadFactors
from fe_drivetrain.studies.gear_answers import (
    GearAnswer,
    LevelAnswer,
    LifeBands,
    MeshAnswer,
    largest_difference,
)
from fe_drivetrain.studies.gear_levels import LoadSpread, Spread
from fe_drivetrain.studies.gear_loads import GearLoads
from fe_drivetrain.studies.gear_machine import GearTrain
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_stresses import MeshStresses
from fe_drivetrain.studies.tooth_damage import FlankDamage, gear_damage


class GearRating:
    """A rating of gears in its steps.

    Parameters
    ----------
    train : GearTrain
        The machine, its reference torque and speed.
    asked : GearOptions
        Choices of the rating.
    stresses : mapping of str to MeshStresses
        Meshes whose gears are given in full, by name.
    given : GearLoads
        What loads the gears.
    steps : Steps
        The clock.
    """

    def __init__(
        self,
        train: GearTrain,
        asked: GearOptions,
        stresses: Mapping[str, MeshStresses],
        given: GearLoads,
        steps: Steps,
    ) -> None:
        self.train, self.asked, self.stresses = train, asked, stresses
        self.given, self.steps = given, steps
        self.bounds: tuple[LoadSpread, LoadSpread] | None = None

    def _spread(self, rung: Rung, slices: int) -> LoadSpread:
        return LoadSpread(
            self.train.machine,
            self.stresses,
            rung,
            self.asked.azimuths,
            slices,
            self.given.weight,
            self.train.torque,
        )

    def spread_at(self, rung: Rung) -> dict[str, Spread]:
        """Spread at the reference torque at one rung, at which all that follows is rated."""
        slices = self.asked.slices
        self.chosen = self._spread(rung, slices)
        self.coarse = self._spread(rung, (slices + 1) // 2)
        return self._at_reference(self.chosen)

    def _at_reference(self, loads: LoadSpread) -> dict[str, Spread]:
        """Spread under the reference torque at the rated speed."""
        application = {name: self.application(name, rated=True) for name in self.stresses}
        speed = self.train.conditions.speed
        return loads.under(self.train.torque, self.given.hub, speed, application)

    def ladder(self) -> tuple[tuple[LevelAnswer, ...], dict[str, Spread]]:
        """All levels at the reference torque, and the spread of the one that is rated.

        The finest is what others are compared with. Where housings of main bearings give way at the
        level that is rated, both of their bounds count in what follows.
        """
        loads: dict[str, LoadSpread] = {}
        found: dict[str, dict[str, Spread]] = {}
        seconds, condensed = {}, 0.0
        with self.steps.step("levels"):
            for rung in self.train.rungs:
                start, condensed = perf_counter(), condensed + rung.seconds
                loads[rung.name] = self._spread(rung, self.asked.slices)
                found[rung.name] = self._at_reference(loads[rung.name])
                seconds[rung.name] = perf_counter() - start + condensed
            self.coarse = self._spread(self.train.rung, (self.asked.slices + 1) // 2)
        self.chosen = loads[self.train.rung.name]
        if self.train.rung.flexible.bearings:
            self.bounds = loads[SOFT_SEATS], loads[STIFF_SEATS]
        factors = {
            rung: {name: (one.sharing, one.face_load) for name, one in of.items()}
            for rung, of in found.items()
        }
        finest = factors[self.train.rungs[-1].name]
        levels = tuple(
            LevelAnswer(name, seconds[name], of, largest_difference(of, finest))
            for name, of in factors.items()
        )
        return levels, found[self.train.rung.name]

    def mesh_answers(self, spreads: Mapping[str, Spread]) -> dict[str, MeshAnswer]:
        """Each mesh at the reference torque, with bands: fewer azimuths and slices, and bounds."""
        torque, found = self.train.torque, {}
        coarse = self._at_reference(self.coarse)
        bounds = [self._at_reference(one) for one in self.bounds or ()]
        for name, spread in spreads.items():
            pairs = [(spread, one) for one in (coarse[name], *spread.halves)]
            if bounds:
                pairs.append((bounds[0][name], bounds[1][name]))
            sharing = sum(abs(one.sharing - other.sharing) for one, other in pairs)
            face = sum(abs(one.face_load - other.face_load) for one, other in pairs)
            load = sharing / spread.sharing + face / spread.face_load
            own = self.stresses.get(name)
            start = LoadFactors(1.0, spread.sharing, 1.0, spread.face_load)
            pair, first, force, factors, balance = None, np.nan, np.nan, start, np.nan
            if own is not None:
                pair, first = own.mesh.pair, own.torque(torque)
                force, balance = (
                    pair.tangential_force(first),
                    spread.mean / pair.normal_force(first),
                )
                start = replace(start, K_A=self.application(name, rated=True))
                factors = own.factors(torque, self.train.conditions.speed, start)
            found[name] = MeshAnswer(
                name, pair, first, force, factors, spread, sharing, face, load, balance
            )
        return found

    def application(self, name: str, rated: bool = False) -> float:
        """K_A: of the reference torque as stated; 1 of a spectrum, which takes its place."""
        strength = self.stresses[name].mesh.strength
        if strength is None or strength.application is None:
            return 1.0
        return strength.application if rated or not self.given.varies else 1.0

    def damage(self) -> dict[str, tuple[FlankDamage, LifeBands]]:
        """Damage of all flanks, with bands: azimuths, slices, classes of torque, and bounds."""
        spectrum = self.given.spectrum
        rated = {name: one for name, one in self.stresses.items() if one.rated}
        if spectrum is None or not rated:
            return {}
        application = {name: self.application(name) for name in rated}
        with self.steps.step("damage"):
            found = gear_damage(rated, spectrum, self.chosen, application)
            others = [gear_damage(rated, spectrum, self.coarse, application)]
            others += [
                gear_damage(rated, spectrum, self.chosen, application, half) for half in (0, 1)
            ]
            if self.given.varies:
                others.append(gear_damage(rated, spectrum.coarser(), self.chosen, application))
            pairs = [(found, other) for other in others]
            if self.bounds is not None:
                low, high = self.bounds
                soft = gear_damage(rated, spectrum, low, application)
                pairs.append((soft, gear_damage(rated, spectrum, high, application)))
        return {
            name: (one, _bands([(first[name], other[name]) for first, other in pairs]))
            for name, one in found.items()
        }

    def gear_answers(
        self,
        meshes: Mapping[str, MeshAnswer],
        damage: Mapping[str, tuple[FlankDamage, LifeBands]],
    ) -> dict[str, GearAnswer]:
        """Each flank of each gear that is given in full."""
        found = {}
        for name, own in self.stresses.items():
            for number, flank in enumerate(own.mesh.flanks):
                answer = self._gear_answer(own, meshes[name], number)
                life, bands = damage.get(flank.name, (None, None))
                hours = np.nan
                if life is not None:
                    largest = life.damage.largest
                    hours = self.given.hours / largest if largest else np.inf
                found[flank.name] = replace(answer, life=life, bands=bands, life_hours=hours)
        return found

    def _gear_answer(self, own: MeshStresses, mesh: MeshAnswer, number: int) -> GearAnswer:
        torque, flank, strength = self.train.torque, own.mesh.flanks[number], own.mesh.strength
        sigma_H = float(own.contact(torque, mesh.factors.contact)[number])
        roots = own.root(torque, mesh.factors.root)
        sigma_F = None if roots is None else float(roots[number])
        curves, spectrum = own.curves(torque), self.given.spectrum
        S_H = S_F = H_band = F_band = required = None
        if curves is not None and strength is not None and spectrum is not None:
            cycles = float(spectrum.turns.sum()) * flank.loads
            required = strength.contact_safety, strength.root_safety
            S_H = curves[number].contact.at(cycles) / sigma_H
            H_band = 0.5 * mesh.stress_band * S_H
            of_root = curves[number].root
            if of_root is not None and sigma_F is not None:
                S_F = of_root.at(cycles) / sigma_F
                F_band = mesh.stress_band * S_F
        missing = (*own.mesh.missing, *(self.train.missing if strength else ()))
        return GearAnswer(
            flank.name,
            own.mesh.name,
            sigma_H,
            sigma_F,
            S_H,
            S_F,
            H_band,
            F_band,
            required,
            None,
            None,
            np.nan,
            missing,
        )


def _bands(pairs: Sequence[tuple[FlankDamage, FlankDamage]]) -> LifeBands:
    """Sums of what pairs of models differ by."""

    def moved(value: Callable[[FlankDamage], float]) -> float:
        return sum(abs(value(other) - value(one)) for one, other in pairs)

    return LifeBands(
        moved(lambda each: each.damage.largest),
        moved(lambda each: each.contact_safety),
        moved(lambda each: each.root_safety or 0.0),
    )
