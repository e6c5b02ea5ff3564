"""A drivetrain at a rung of its ladder, and the quantities of all that turns that it answers."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fe_drivetrain.bearing_life.coupled.reaction_paths import damage_of_forces
from fe_drivetrain.bearing_life.life.roller_damage import Damage
from fe_drivetrain.common.components import GRAVITY, RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics import (
    Asked,
    Level,
    Machine,
    Operation,
    Rung,
    machine_of,
)
from fe_drivetrain.dynamics.bodies.bearing_reactions import BearingModel
from fe_drivetrain.procedure.drivetrain_events import EVENTS
from fe_drivetrain.studies.gear_answers import GearAnswer, MeshAnswer
from fe_drivetrain.studies.gear_loads import GearLoading, loads_of
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_ratings import prepared
from fe_drivetrain.studies.gear_stresses import MeshStresses
from fe_drivetrain.studies.part_bearings import counted_parts
from fe_drivetrain.studies.part_damage import PartUse
from fe_drivetrain.studies.rated_gears import GearRating
from fe_drivetrain.studies.tooth_damage import gear_damage
from fe_drivetrain.studies.transient_events import event_at, rated_of
from fe_drivetrain.studies.transient_parts import DAMAGE, part_question
from fe_drivetrain.studies.transient_runs import Extreme

_NO_LOADS = GearLoading((), None, None, None, False)


class TurningModel:
    """A drivetrain at a rung of its ladder; what several quantities need is solved once.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    rung : Rung
        Level, and what gives.
    reference : Asked or None
        Machine at the finest level, whose modes give numbered frequencies their number; None for
        those of this model.
    """

    def __init__(self, drivetrain: Drivetrain, rung: Rung, reference: Asked | None = None) -> None:
        self.drivetrain, self.rung = drivetrain, rung
        self._reference = reference
        self._events: dict[str, Mapping[str, Extreme]] = {}
        self._parts: dict[str, PartUse | None] = {}

    @cached_property
    def machine(self) -> Machine:
        """The machine."""
        return machine_of(self.drivetrain)

    @cached_property
    def asked(self) -> Asked:
        """The machine at this rung, its generator free to turn."""
        return Asked(self.machine, self.rung, Operation(0.0))

    @property
    def reference(self) -> Asked:
        """Machine whose modes give numbered frequencies their number."""
        return self.asked if self._reference is None else self._reference

    @cached_property
    def rating(self) -> GearRating:
        """Rating of the gears under the reference torque for the life asked for."""
        options = GearOptions()
        train, meshes, _ = prepared(self.drivetrain, None, options, _NO_LOADS)
        stresses = {name: MeshStresses(one, train.conditions) for name, one in meshes.items()}
        steps = Steps()
        return GearRating(
            train, options, stresses, loads_of(train, options, _NO_LOADS, steps.report), steps
        )

    @cached_property
    def meshes(self) -> dict[str, MeshAnswer]:
        """Each mesh at the reference torque."""
        return self.rating.mesh_answers(self.rating.spread_at(self.rung))

    @cached_property
    def gears(self) -> dict[str, GearAnswer]:
        """Each flank at the reference torque."""
        return self.rating.gear_answers(self.meshes, {})

    @cached_property
    def damage(self) -> dict[str, float]:
        """Damage of each flank in the hours of the life asked for, the larger of face and root."""
        made, _ = self.rating, self.meshes  # the spread of the loads is that of the meshes
        rated = {name: one for name, one in made.stresses.items() if one.rated}
        if made.given.spectrum is None or not rated:
            return {}
        application = {name: made.application(name) for name in rated}
        found = gear_damage(rated, made.given.spectrum, made.chosen, application)
        return {name: one.damage.largest for name, one in found.items()}

    def damage_band(self, flank: str) -> float:
        """Numerical uncertainty of the damage of a flank, by coarser spreads of the loads."""
        made, _ = self.rating, self.meshes
        return made.damage()[flank][1].damage

    def peak(self, event: str, channel: str) -> Extreme | None:
        """Extremes of a channel in an event; None where this level does not have them."""
        if self.rung.level not in EVENTS[event].levels:
            return None
        if event not in self._events:
            self._events[event] = event_at(self.drivetrain, event, self.rung).extremes
        return self._events[event].get(channel)

    def parts(self, event: str) -> PartUse | None:
        """What an event does to gears and bearings; None where this level does not have it."""
        if self.rung.level not in EVENTS[event].levels:
            return None
        if event not in self._parts:
            question = part_question(self.drivetrain, self.machine, DAMAGE, strict=False)
            run = event_at(self.drivetrain, event, self.rung, question.counted)
            self._parts[event] = question.of_event(run, rated_of(self.drivetrain).torque)
        return self._parts[event]

    @cached_property
    def lives(self) -> dict[str, Damage]:
        """Damage of each bearing of the catalogue by an hour at rated torque and speed."""
        if self.rung.level is Level.TORSIONAL:
            return {}
        rated, machine, options = rated_of(self.drivetrain), self.machine, DAMAGE.lives
        counted, _ = counted_parts(self.drivetrain, machine, options, True, strict=False)
        names = [one.name for one in counted.bearings]
        model = BearingModel(machine, self.rung.level, flexible=self.rung.flexible)
        reactions = model.reactions(of=names)
        weight = GRAVITY * machine.rotor.apart[0]
        hub, found = np.array([0.0, 0.0, -weight, rated.torque, 0.0, 0.0]), {}
        for one in counted.bearings:
            loads = reactions[one.name].under(hub[None])[0]
            rpm = reactions[one.name].speed_ratio * rated.rotor_speed * RPM
            seconds = np.full(len(loads), 3600.0 / len(loads))
            found[one.name] = damage_of_forces(one.rated, loads, rpm, seconds, one.rules)
        return found


@dataclass(frozen=True)
class TurningQuantity:
    """A number of all that turns.

    Attributes
    ----------
    name, unit : str
        Name, and unit of the value; "-" without one.
    of : callable
        Its value of a `TurningModel`; None where the model's level has none.
    own : callable
        Numerical uncertainty of the value [unit]; NaN where it is not known.
    """

    name: str
    unit: str
    of: Callable[[TurningModel], float | None]
    own: Callable[[TurningModel], float]

    @property
    def numbered(self) -> bool:
        """Whether it is a frequency by the number of its mode at the finest level."""
        return self.name.startswith("modes.frequency.")

    __repr__ = short_repr

    def value(self, model: TurningModel) -> float:
        """Its value.

        Raises
        ------
        InputError
            The model has none: its level neglects what it needs, or no mode moves like the one
            asked for.
        """
        found = self.of(model)
        if found is None:
            raise InputError(
                f"{self.name} has no value at the level {model.rung.name!r} of "
                f"{model.drivetrain.title!r}: ask for another level, or for another quantity"
            )
        if not np.isfinite(found):
            raise InputError(
                f"{self.name} is infinite at the level {model.rung.name!r} of "
                f"{model.drivetrain.title!r}, which has no relative error: ask for another quantity"
            )
        return found
