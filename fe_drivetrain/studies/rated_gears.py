"""Gears rated step by step: levels, meshes, damage, and what each flank endures."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np

from fe_drivetrain.common.steps import Steps
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import Level
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
        self.level = train.level

    def _spread(self, level: Level, slices: int, flexible: Flexible | None = None) -> LoadSpread:
        return LoadSpread(
            self.train.machine,
            self.stresses,
            level,
            self.asked.azimuths,
            slices,
            self.given.weight,
            self.train.torque,
            flexible,
        )

    def spread_at(self, rung: Rung) -> dict[str, Spread]:
        """Spread at the reference torque at one rung, at which all that follows is rated."""
        slices = self.asked.slices
        self.chosen = self._spread(rung.level, slices, rung.flexible)
        self.coarse = self._spread(rung.level, (slices + 1) // 2, rung.flexible)
        return self.chosen.under(self.train.torque, self.given.hub)

    def ladder(self) -> tuple[tuple[LevelAnswer, ...], dict[Level, dict[str, Spread]]]:
        """All levels at the reference torque; the finest is what others are compared with."""
        found: dict[Level, dict[str, Spread]] = {}
        factors, seconds = {}, {}
        with self.steps.step("levels"):
            for level in self.train.levels:
                start = perf_counter()
                loads = self._spread(level, self.asked.slices)
                if level is self.level:
                    self.chosen = loads
                found[level] = loads.under(self.train.torque, self.given.hub)
                seconds[level] = perf_counter() - start
                factors[level] = {n: (s.sharing, s.face_load) for n, s in found[level].items()}
            self.coarse = self._spread(self.level, (self.asked.slices + 1) // 2)
        finest = factors[self.train.levels[-1]]
        levels = tuple(
            LevelAnswer(one.value, seconds[one], of, largest_difference(of, finest))
            for one, of in factors.items()
        )
        return levels, found

    def mesh_answers(self, spreads: Mapping[str, Spread]) -> dict[str, MeshAnswer]:
        """Each mesh at the reference torque, with bands by fewer azimuths and slices."""
        torque, found = self.train.torque, {}
        coarse = self.coarse.under(torque, self.given.hub)
        for name, spread in spreads.items():
            others = (coarse[name], *spread.halves)
            sharing = sum(abs(spread.sharing - one.sharing) for one in others)
            face = sum(abs(spread.face_load - one.face_load) for one in others)
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
        """Damage of all flanks with its bands: fewer azimuths, slices and classes of torque."""
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
        return {
            name: (one, _bands(one, [other[name] for other in others]))
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


def _bands(one: FlankDamage, others: Sequence[FlankDamage]) -> LifeBands:
    """Sums of what coarser models change."""

    def moved(value: Callable[[FlankDamage], float]) -> float:
        return sum(abs(value(other) - value(one)) for other in others)

    return LifeBands(
        moved(lambda each: each.damage.largest),
        moved(lambda each: each.contact_safety),
        moved(lambda each: each.root_safety or 0.0),
    )
