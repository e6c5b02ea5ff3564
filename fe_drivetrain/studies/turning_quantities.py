"""Quantities of all that turns by name: frequencies, load sharing, factors and safeties of gears.

``modes.torsional.1`` is the first torsional frequency, ``modes.frequency.3`` the third of all,
``gears.stage 1 sun-planet.sharing`` the load of the most loaded planet over the mean,
``gears.stage 3 mesh.K_Hbeta`` that along the face, ``gears.stage 3 pinion.S_H`` a safety factor,
``transient.stop.force of stage 3 mesh.peak`` the largest force of a mesh in an emergency stop,
``transient.stop.stage 3 mesh.damage`` what that does to its teeth, ``transient.stop.PLC-A.S0`` the
static safety of a bearing, ``life.PLC-A.L10mr`` its life at rated torque. Each is asked of a
drivetrain at a rung of its ladder.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.near_words import did_you_mean
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics import (
    Level,
    Machine,
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
from fe_drivetrain.studies.gear_loads import GearLoading
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_ratings import prepared
from fe_drivetrain.studies.mode_levels import BANDED, element_bands
from fe_drivetrain.studies.part_quantities import part_quantities
from fe_drivetrain.studies.transient_events import rated_of
from fe_drivetrain.studies.turning_model import TurningModel, TurningQuantity

_FREQUENCIES = 16
"""Number of the first frequencies that have a name, of drivetrains with all motions."""
_NO_LOADS = GearLoading((), None, None, None, False)


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
    for quantities in (_of_gears, _of_events, part_quantities):
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
    shown += [name for name in names if name.startswith("life.") and name.endswith(".L10mr")]
    of_parts = [one.split(".", 2) for one in names if one.endswith((".damage", ".S0"))]
    parts = dict.fromkeys(one[2] for one in of_parts if one[0] == "transient")
    shown += [f"transient.EVENT.{one}" for one in parts]
    peaks = [n.split(".", 2)[1:] for n in names if n.startswith("transient.") and ".peak" in n]
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
