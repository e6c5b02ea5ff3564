"""Damage and static safety of gears and bearings in events, and lives at rated torque, by name."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import TypeVar

from fe_drivetrain.bearing_life.life.roller_damage import KINDS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.procedure.drivetrain_events import EVENTS
from fe_drivetrain.studies.gear_machine import gear_train
from fe_drivetrain.studies.gear_meshes import gear_meshes
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.part_bearings import counted_parts
from fe_drivetrain.studies.part_damage import BearingUse
from fe_drivetrain.studies.part_gears import FlankUse
from fe_drivetrain.studies.transient_events import rated_of
from fe_drivetrain.studies.transient_parts import DAMAGE
from fe_drivetrain.studies.turning_model import TurningModel, TurningQuantity

_Use = TypeVar("_Use", FlankUse, BearingUse)


def part_quantities(drivetrain: Drivetrain, machine: Machine) -> list[TurningQuantity]:
    """Quantities of gears and bearings in all events, and of lives at rated torque.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    machine : Machine
        Its machine.

    Raises
    ------
    InputError
        It states no rated torque or speed.
    """
    torque = rated_of(drivetrain).torque
    turns = bool(machine.not_given)
    bearings = []
    if not turns:
        counted, _ = counted_parts(drivetrain, machine, DAMAGE.lives, False, strict=False)
        bearings = [one.name for one in counted.bearings]
    meshes: list[str] = []
    with suppress(InputError):  # without gears
        train = gear_train(drivetrain, GearOptions(), torque)
        given, _ = gear_meshes(machine, train.strengths)
        meshes = [] if train.missing else [n for n, one in given.items() if one.strength]
    found = []
    for event, kind in EVENTS.items():
        if (Level.TORSIONAL if turns else Level.FLEXIBLE) not in kind.levels:
            continue
        found += [_teeth(event, mesh) for mesh in meshes]
        for name in bearings:
            found += _of_bearing(event, name)
    return found + [_life(name, kind) for name in bearings for kind in KINDS]


def _teeth(event: str, mesh: str) -> TurningQuantity:
    """Largest damage of the flanks and roots of a mesh by an event."""

    def one(model: TurningModel) -> FlankUse | None:
        parts = model.parts(event)
        return None if parts is None else parts.of_mesh(mesh)

    return _quantity(
        f"transient.{event}.{mesh}.damage",
        one,
        lambda found: found.damage.largest,
        lambda found: found.band,
    )


def _of_bearing(event: str, name: str) -> list[TurningQuantity]:
    """Damage by L10, and least static safety, of a bearing in an event."""

    def one(model: TurningModel) -> BearingUse | None:
        parts = model.parts(event)
        return None if parts is None else parts.bearings.get(name)

    return [
        _quantity(
            f"transient.{event}.{name}.damage",
            one,
            lambda found: found.damage["L10"],
            lambda found: found.band,
        ),
        _quantity(
            f"transient.{event}.{name}.S0",
            one,
            lambda found: found.static_safety,
            lambda found: found.static_band,
        ),
    ]


def _quantity(
    name: str,
    one: Callable[[TurningModel], _Use | None],
    value: Callable[[_Use], float],
    band: Callable[[_Use], float],
) -> TurningQuantity:
    def of(model: TurningModel) -> float | None:
        found = one(model)
        return None if found is None else value(found)

    def own(model: TurningModel) -> float:
        """What the step, classes of torque, azimuths and slices leave uncertain."""
        found = one(model)
        return float("nan") if found is None else band(found)

    return TurningQuantity(name, "-", of, own)


def _life(name: str, kind: str) -> TurningQuantity:
    """Life of a bearing at rated torque, the rotor's weight beside it."""

    def of(model: TurningModel) -> float | None:
        found = model.lives.get(name)
        return None if found is None else found.lives("years")[kind]

    # the mean of six azimuths is exact for a load that turns once; a constant load has no step
    return TurningQuantity(f"life.{name}.{kind}", "years", of, lambda _: 0.0)
