"""Losses of a drivetrain for ``gears``: heat of bearings and teeth, torque at the generator."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from time import process_time

import numpy as np

from fe_drivetrain.bearing.catalogue import read_bearing_catalogue
from fe_drivetrain.bearing_life.life.lubricants import GRADES, Lubricant
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.bearing_reactions import BearingModel
from fe_drivetrain.dynamics.bodies.catalogue_seats import catalogued, main_names
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.power_losses import (
    Film,
    FrictionModel,
    Losses,
    LossModel,
    LossyBearing,
    LossyMesh,
    LossySeal,
)
from fe_drivetrain.gear.losses import OVER_RA
from fe_drivetrain.procedure.bearing_defects import ring_speeds
from fe_drivetrain.studies.gear_loads import GearLoads
from fe_drivetrain.studies.gear_machine import GearTrain
from fe_drivetrain.studies.gear_meshes import GearMesh
from fe_drivetrain.studies.gear_spectra import TORQUE
from fe_drivetrain.studies.gearbox_bearings import gearbox_oil
from fe_drivetrain.studies.named_bearings import entry_of
from fe_drivetrain.studies.rolling_bearings import Oil

CONSTANT = "constant efficiency"
LEVELS: Mapping[str, FrictionModel] = {
    "factors f0 and f1": "palmgren",
    "SKF's model": "skf",
    "sum over rollers": "rollers",
}
"""Levels beyond the constant efficiency by their names, from the cheapest."""

ANSWER = "SKF's model"
"""Level of the answer; what others differ from it is its band."""

GREASE = Lubricant(*GRADES["VG 460"], temperature=50.0)
"""Lubricant of main bearings, as ``life`` assumes it."""

RZ = 4.8e-6
"""R_z of flanks whose file states none [m], as a rating takes it."""


@dataclass(frozen=True, eq=False)
class LossLevel:
    """Losses by one level.

    Attributes
    ----------
    name : str
        Name of the level.
    losses : Losses
        At the reference torque, then at each class of the spectrum.
    seconds : float
        Processor time [s].
    energy : float
        Heat over the life asked for [J].
    difference : float
        Its heat over that of the level of the answer, less 1.
    """

    name: str
    losses: Losses
    seconds: float
    energy: float
    difference: float


@dataclass(frozen=True, eq=False)
class DrivetrainLosses:
    """Losses of a drivetrain at its reference torque and over its life.

    Attributes
    ----------
    levels : tuple of LossLevel
        The ladder, from the cheapest.
    answer : LossLevel
        That of the answer.
    band : Floats
        Half width (n,) of the uncertainty of the torque that all parts take, at the rotor [N m]:
        the largest difference of another model, what the models leave open, and the loads of
        bearings under the torque that is left behind all losses.
    bearings, meshes : tuple of str
        Parts that are counted.
    left_out : dict of str to str
        Why others are not, by name.
    film : Film
        Oil of the gearbox.
    oil : Lubricant
        The same with its grade and temperature.
    assumed : tuple of str
        What of the oil nobody stated.
    seconds : Floats
        Time (n - 1,) of each class over the life asked for [s].
    shafts : tuple of str
        Names of the shafts along the way of the torque.
    ratios : tuple of float
        Their speeds over the rotor's.
    """

    levels: tuple[LossLevel, ...]
    answer: LossLevel
    band: Floats
    bearings: tuple[str, ...]
    meshes: tuple[str, ...]
    left_out: dict[str, str]
    film: Film
    oil: Lubricant
    assumed: tuple[str, ...]
    seconds: Floats
    shafts: tuple[str, ...]
    ratios: tuple[float, ...]

    @property
    def efficiency_band(self) -> Floats:
        """Half width (n,) of the uncertainty of the efficiency [-]."""
        torque = np.abs(self.answer.losses.torque)
        return np.divide(self.band, torque, out=np.zeros_like(torque), where=torque > 0.0)


def drivetrain_losses(
    drivetrain: Drivetrain,
    train: GearTrain,
    meshes: Mapping[str, GearMesh],
    left_out: Mapping[str, str],
    given: GearLoads,
    grade: float | None = None,
) -> DrivetrainLosses:
    """Losses of a drivetrain by all levels.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    train : GearTrain
        Its machine, its reference torque and speed.
    meshes : mapping of str to GearMesh
        Meshes whose gears are given in full.
    left_out : mapping of str to str
        Why other meshes are not, by name.
    given : GearLoads
        What loads the gears.
    grade : float or None
        Viscosity of the oil at 40 degC [mm2/s]; None takes the file's.

    Raises
    ------
    InputError
        No speed of the rotor is known, or the oil is of a grade that is not known.
    """
    oil = check_losses(drivetrain, train, grade)
    machine = train.machine
    film = Film(1e-6 * oil.lubricant.viscosity)
    bearings, unknown = lossy_bearings(machine, film)
    rung = _statics_rung(train)
    reactions = BearingModel(machine, rung.level, flexible=rung.flexible).reactions()
    teeth = [_lossy(mesh) for mesh in meshes.values()]
    seals = _seals(drivetrain, machine)
    model = LossModel(reactions, bearings, teeth, film, machine.speeds[-1], seals)
    hub, speed, seconds = _points(train, given)
    levels = _ladder(model, hub, speed, seconds)
    answer = next(one for one in levels if one.name == ANSWER)
    why = dict.fromkeys(unknown, "it has no entry of the bearing catalogue")
    return DrivetrainLosses(
        levels,
        answer,
        _band(model, hub, speed, levels, answer),
        tuple(one.name for one in bearings),
        tuple(meshes),
        {**why, **left_out},
        film,
        oil.lubricant,
        tuple(name for name in oil.assumed if name != "cleanliness"),
        seconds,
        tuple(shaft.name for shaft in machine.shafts),
        machine.speeds,
    )


def check_losses(drivetrain: Drivetrain, train: GearTrain, grade: float | None) -> Oil:
    """Refuse what has no losses before any work is done; the oil of the gearbox.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    train : GearTrain
        Its machine, its reference torque and speed.
    grade : float or None
        Viscosity of the oil at 40 degC [mm2/s]; None takes the file's.

    Raises
    ------
    InputError
        See `drivetrain_losses`.
    """
    if train.conditions.speed is None:
        raise InputError(
            f"losses of {train.machine.title!r} need the speed of the rotor: give "
            "operation.rotor_speed in the file"
        )
    _statics_rung(train)
    operation = drivetrain.operation
    stated = None if operation is None else operation.lubricant
    name = stated if grade is None else f"VG {grade:g}"
    return gearbox_oil(name, None if operation is None else operation.temperature, "-/17/14")


def lossy_bearings(
    machine: MachineTable, film: Film
) -> tuple[tuple[LossyBearing, ...], tuple[str, ...]]:
    """Bearings with a catalogue entry on the way of the torque, and names of the others.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    film : Film
        Oil of the gearbox; main bearings have grease.
    """
    rows, known, main = catalogued(machine), read_bearing_catalogue(), main_names(machine)
    shafts = {shaft.name: number for number, shaft in enumerate(machine.shafts)}
    held = {bearing.name: bearing.holds for bearing in machine.bearings}
    grease = Film(1e-6 * GREASE.viscosity, "grease")
    found, unknown = [], []
    for name in ring_speeds(machine):
        named = rows[name].catalogue if name in rows else None
        if named is None or (isinstance(named, str) and named not in known):
            unknown.append(name)
            continue
        entry = entry_of(name, named, known)
        place = _place(held.get(name, name), shafts)
        found.append(LossyBearing(name, place, entry, grease if name in main else film))
    return tuple(found), tuple(unknown)


def _seals(drivetrain: Drivetrain, machine: MachineTable) -> list[LossySeal]:
    """Seals of the gearbox that rub."""
    numbers = {shaft.name: number for number, shaft in enumerate(machine.shafts)}
    return [
        LossySeal(
            one.name,
            numbers[one.shaft],
            one.diameter,
            abs(machine.speeds[numbers[one.shaft]]),
        )
        for one in drivetrain.gearbox.seals
    ]


def _place(holds: str, shafts: Mapping[str, int]) -> float:
    """Where a bearing is: the number of the shaft that it holds, k - 0.5 on a pin of stage k."""
    if holds in shafts:
        return shafts[holds]
    words = holds.split()
    if words[0] != "stage":
        return 0.0 if holds == "rotor" else len(shafts) - 1.0
    if words[2] == "pin":
        return float(words[1]) - 0.5
    return float(words[1]) - (0.0 if words[2] in ("sun", "pinion") else 1.0)


def _lossy(mesh: GearMesh) -> LossyMesh:
    """A mesh as its losses need it."""
    rough = [RZ if flank.steel is None else flank.steel.flank_roughness for flank in mesh.flanks]
    return LossyMesh(
        mesh.name,
        mesh.stage,
        mesh.pair,
        mesh.planets,
        mesh.torque_ratio,
        mesh.speed_ratio,
        0.5 * sum(rough) / OVER_RA,
    )


def _statics_rung(train: GearTrain) -> Rung:
    """The finest plain level that has forces of bearings."""
    known = [r for r in train.rungs if r.level is not Level.TORSIONAL and not r.rollers]
    if not known:
        raise InputError(
            "losses of bearings need their loads, and the file states what turns alone: give "
            f"{', '.join(train.machine.not_given)}"
        )
    return known[-1]


def _points(train: GearTrain, given: GearLoads) -> tuple[Floats, Floats, Floats]:
    """Hub loads (n, 6), speeds (n,) and times (n - 1,): the reference torque, then all classes."""
    speed = train.conditions.speed
    assert speed is not None
    spectrum = given.spectrum
    assert spectrum is not None
    hub = np.vstack([given.hub, spectrum.hub])
    hub[:, TORQUE] = [train.torque, *spectrum.torques]
    if given.weight:
        hub[:, 2] -= GRAVITY * train.machine.rotor.apart[0]
    return hub, np.array([speed, *spectrum.speeds(speed)]), spectrum.seconds


def _ladder(model: LossModel, hub: Floats, speed: Floats, seconds: Floats) -> tuple[LossLevel, ...]:
    """All levels; the constant efficiency is that of the first one beyond it, at the reference."""
    found: dict[str, tuple[Losses, float]] = {}
    for name, friction in LEVELS.items():
        start = process_time()
        found[name] = model.losses(hub, speed, friction), process_time() - start
    start = process_time()
    first = model.losses(hub[:1], speed[:1], LEVELS[next(iter(LEVELS))])
    shares = first.taken / np.abs(first.torque)
    whole = found[ANSWER][0]
    taken = shares * np.abs(whole.torque)
    constant = replace(whole, taken=taken, low=taken, high=taken)
    rows = {CONSTANT: (constant, process_time() - start), **found}
    energies = {name: _energy(losses, seconds) for name, (losses, _) in rows.items()}
    best = energies[ANSWER]
    return tuple(
        # a rotor that stands in all classes makes no heat by any level
        LossLevel(name, losses, spent, energies[name], energies[name] / best - 1.0 if best else 0.0)
        for name, (losses, spent) in rows.items()
    )


def _energy(losses: Losses, seconds: Floats) -> float:
    """Heat over the life asked for [J]."""
    return float(losses.heat[:, 1:].sum(axis=0) @ seconds)


def _band(
    model: LossModel,
    hub: Floats,
    speed: Floats,
    levels: Sequence[LossLevel],
    answer: LossLevel,
) -> Floats:
    """Half width (n,) of the uncertainty of the torque that all parts take [N m]."""
    own = answer.losses
    whole = own.taken.sum(axis=0)
    others = [one.losses.taken.sum(axis=0) for one in levels if one.name != CONSTANT]
    models = np.abs(np.array(others) - whole).max(axis=0)
    open_for = np.maximum(own.high.sum(axis=0) - whole, whole - own.low.sum(axis=0))
    behind = hub.copy()
    behind[:, TORQUE] = np.sign(own.torque) * np.maximum(np.abs(own.torque) - whole, 0.0)
    eased = model.losses(hub, speed, LEVELS[ANSWER], carried=behind)
    return np.asarray(models + open_for + np.abs(eased.taken.sum(axis=0) - whole))
