"""Quantities of all that turns by name: frequencies, load sharing, factors and safeties of gears.

``modes.torsional.1`` is the first torsional frequency, ``modes.frequency.3`` the third of all,
``gears.stage 1 sun-planet.sharing`` the load of the most loaded planet over the mean,
``gears.stage 3 mesh.K_Hbeta`` that along the face, ``gears.stage 3 pinion.S_H`` a safety factor,
``transient.stop.force of stage 3 mesh.peak`` the largest force of a mesh in an emergency stop.
Each is asked of a drivetrain at a rung of its ladder.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.near_words import did_you_mean
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.dynamics import (
    Asked,
    Level,
    Machine,
    Operation,
    Rung,
    like_mode,
    machine_of,
    plain_rungs,
    torsional,
    torsional_frequency,
)
from fe_drivetrain.dynamics.bodies.mesh_loads import mesh_springs
from fe_drivetrain.dynamics.time.machine_channels import UNITS, machine_channels
from fe_drivetrain.dynamics.torsion.system import natural_modes
from fe_drivetrain.procedure.drivetrain_events import EVENTS
from fe_drivetrain.studies.drivetrain_transient import event_at, rated_of
from fe_drivetrain.studies.gear_answers import GearAnswer, MeshAnswer
from fe_drivetrain.studies.gear_loads import GearLoading, loads_of
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_ratings import prepared
from fe_drivetrain.studies.gear_stresses import MeshStresses
from fe_drivetrain.studies.mode_levels import BANDED, element_bands
from fe_drivetrain.studies.rated_gears import GearRating
from fe_drivetrain.studies.tooth_damage import gear_damage
from fe_drivetrain.studies.transient_runs import Extreme

FIRST = "modes.torsional.1"
"""What is asked for where nothing is, of a main shaft without sections."""
STUDIES = ("modes", "gears", "transient")
"""Studies whose quantities have a name, the first part of it."""
_FREQUENCIES = 16
"""Number of the first frequencies that have a name, of drivetrains with all motions."""
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
        return found


def is_turning(name: str, drivetrain: Drivetrain) -> bool:
    """Whether a name is meant as that of a quantity of all that turns, not of a bearing.

    Parameters
    ----------
    name : str
        Name of a quantity.
    drivetrain : Drivetrain
        The drivetrain, whose bearings may have any name.
    """
    owner = name.partition(".")[0]
    return owner in STUDIES and owner not in getattr(drivetrain, "bearing_names", ())


def turning_names(
    drivetrain: Drivetrain, names: Sequence[str], load: Mapping[str, float] | None
) -> tuple[str, ...]:
    """Names of what turns, where that is asked for.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    names : sequence of str
        Names that are asked for; without any, and without sections of the main shaft, the first
        torsional frequency is.
    load : mapping of str to float, or None
        Load of the hub, which is for reactions.

    Raises
    ------
    InputError
        Reactions or stiffnesses are asked for beside, or a load is given.
    """
    turning = tuple(name for name in names if is_turning(name, drivetrain))
    if not names and not isinstance(drivetrain, Scene):
        turning = (FIRST,)
    if turning and len(turning) < len(names):
        other = next(name for name in names if name not in turning)
        raise InputError(
            f"{other} and {turning[0]} are of different models, that of the main shaft and that of "
            "all that turns: ask for them one by one"
        )
    if turning and load is not None:
        raise InputError(
            f"a load is given for {turning[0]} but is for reactions: leave it out, gears are under "
            "the torque of the rated power and the weight of the rotor"
        )
    return turning


def turning_quantities(drivetrain: Drivetrain) -> dict[str, TurningQuantity]:
    """Quantities of all that turns that a drivetrain's file has data for, by name.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain, with a rotor and a generator.

    Raises
    ------
    InputError
        It has no rotor or no generator; the message names the missing key.
    """
    machine = machine_of(drivetrain)
    count = int((natural_modes(torsional(machine, False)).frequencies > 0.0).sum())
    found = [_torsional(number) for number in range(1, count + 1)]
    every = count if machine.not_given else _FREQUENCIES
    found += [_frequency(number) for number in range(1, every + 1)]
    for quantities in (_of_gears, _of_events):
        with suppress(InputError):  # without gears, a torque or a speed: none of these
            found += quantities(drivetrain, machine)
    return {one.name: one for one in found}


def _of_gears(drivetrain: Drivetrain, machine: Machine) -> list[TurningQuantity]:
    """Quantities of gears."""
    _, rated, _ = prepared(drivetrain, None, GearOptions(), _NO_LOADS)
    found = []
    for mesh, springs in mesh_springs(machine).items():
        found += [_sharing(mesh)] if len(springs) > 1 else []
        found.append(_face_load(mesh))
    for one in rated.values():
        for flank in one.flanks:
            found += [_stress(flank.name)]
            found += [] if one.strength is None else _endured(flank.name)
    return found


def _of_events(drivetrain: Drivetrain, machine: Machine) -> list[TurningQuantity]:
    """Peaks of all channels in all events that can happen to a drivetrain."""
    finest = plain_rungs(drivetrain, machine)[-1]
    level = finest.level
    running = rated_of(drivetrain).running(machine, finest)
    channels = machine_channels(running)
    return [
        _peak(event, name, UNITS[kind])
        for event, kind_of in EVENTS.items()
        if level in kind_of.levels
        for name, kind in zip(channels.names, channels.kinds, strict=True)
    ]


def _peak(event: str, channel: str, unit: str) -> TurningQuantity:
    def own(model: TurningModel) -> float:
        """What the step leaves uncertain."""
        one = model.peak(event, channel)
        bands = () if one is None else (one.most_band, one.least_band)
        return max((band for band in bands if band is not None), default=float("nan"))

    def of(model: TurningModel) -> float | None:
        one = model.peak(event, channel)
        return None if one is None else one.largest

    return TurningQuantity(f"transient.{event}.{channel}.peak", unit, of, own)


def turning_quantity(drivetrain: Drivetrain, name: str) -> TurningQuantity:
    """The quantity of a name.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    name : str
        Its name.

    Raises
    ------
    InputError
        The drivetrain has no such quantity; the message lists those that it has.
    """
    known = turning_quantities(drivetrain)
    if name in known:
        return known[name]
    near = did_you_mean(name, known)
    raise InputError(
        f"quantity {name!r} is unknown of {drivetrain.title!r}: {near + ' ' if near else ''}"
        f"use one of {', '.join(_shortened(list(known)))}"
    )


def _shortened(names: Sequence[str]) -> list[str]:
    """Names with those of the frequencies as a range, of peaks by event and channel."""
    shown = []
    for kind in ("torsional", "frequency"):
        of = [name for name in names if name.startswith(f"modes.{kind}.")]
        shown += of if len(of) < 3 else [f"{of[0]} to {of[-1]}"]
    shown += [name for name in names if name.startswith("gears.")]
    peaks = [name.split(".", 2)[1:] for name in names if name.startswith("transient.")]
    if peaks:
        events, channels = (list(dict.fromkeys(part)) for part in zip(*peaks, strict=True))
        shown.append(
            f"transient.EVENT.CHANNEL.peak, EVENT of {', '.join(events)}, CHANNEL of "
            f"{', '.join(one.removesuffix('.peak') for one in channels)}"
        )
    return shown


def _torsional(number: int) -> TurningQuantity:
    ask = torsional_frequency(number)
    return _of_modes(f"modes.torsional.{number}", lambda model: ask(model.asked))


def _frequency(number: int) -> TurningQuantity:
    return _of_modes(
        f"modes.frequency.{number}",
        lambda model: like_mode(model.reference, number)(model.asked),
    )


def _of_modes(name: str, of: Callable[[TurningModel], float | None]) -> TurningQuantity:
    def own(model: TurningModel) -> float:
        """What the number of elements of the shafts leaves open, without anything condensed."""
        if model.rung.level is not Level.FLEXIBLE:
            return 0.0
        finest = plain_rungs(model.drivetrain, model.machine)[-1]
        plain = TurningModel(model.drivetrain, finest, model.reference)
        value = of(plain)
        if value is None:
            return float("nan")
        frequencies = plain.asked.modes.frequencies
        nearest = int(abs(frequencies[frequencies > 0.0] - value).argmin())
        bands = element_bands(model.machine, False, BANDED, finest.flexible)
        return float(bands[nearest]) if nearest < len(bands) else float("nan")

    return TurningQuantity(name, "Hz", of, own)


def _sharing(mesh: str) -> TurningQuantity:
    return TurningQuantity(
        f"gears.{mesh}.sharing",
        "-",
        lambda model: model.meshes[mesh].spread.sharing,
        lambda model: model.meshes[mesh].sharing_band,
    )


def _face_load(mesh: str) -> TurningQuantity:
    return TurningQuantity(
        f"gears.{mesh}.K_Hbeta",
        "-",
        lambda model: model.meshes[mesh].spread.face_load,
        lambda model: model.meshes[mesh].face_band,
    )


def _stress(flank: str) -> TurningQuantity:
    def own(model: TurningModel) -> float:
        one = model.gears[flank]
        return 0.5 * model.meshes[one.mesh].stress_band * one.contact_stress

    return TurningQuantity(
        f"gears.{flank}.sigma_H", "Pa", lambda model: model.gears[flank].contact_stress, own
    )


def _endured(flank: str) -> list[TurningQuantity]:
    """Safety factors and damage of a flank whose strength is stated."""

    def known(band: float | None) -> float:
        return float("nan") if band is None else band

    return [
        TurningQuantity(
            f"gears.{flank}.S_H",
            "-",
            lambda model: model.gears[flank].contact_safety,
            lambda model: known(model.gears[flank].contact_band),
        ),
        TurningQuantity(
            f"gears.{flank}.S_F",
            "-",
            lambda model: model.gears[flank].root_safety,
            lambda model: known(model.gears[flank].root_band),
        ),
        TurningQuantity(
            f"gears.{flank}.damage",
            "-",
            lambda model: model.damage.get(flank),
            lambda model: model.damage_band(flank),
        ),
    ]
