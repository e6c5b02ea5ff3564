"""What the strength of a shaft needs of one history, in little memory whatever its length."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.components import ONE_RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.provenance import program_hash
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.entrance import Entrance
from fe_drivetrain.drivetrain_file.shaft_strength import FlangeBolts
from fe_drivetrain.shafts.response.entering import AtFront, entering
from fe_drivetrain.shafts.strength.din743 import (
    SectionStrength,
    combined_safety,
    endured_amplitudes,
    equivalent_mean,
)
from fe_drivetrain.shafts.strength.fatigue import (
    FACTORS,
    Rule,
    TurningStress,
    damage_at_factors,
    damage_of_point,
    damage_of_torque,
    turning_stress,
)
from fe_drivetrain.shafts.strength.joints import JointSafety, flange_safety, press_safety
from fe_drivetrain.shafts.strength.section_loads import SectionLoads
from fe_drivetrain.studies.history_options import HistoryOptions
from fe_drivetrain.turbine_loads.histories.cycles import Cycles
from fe_drivetrain.turbine_loads.hub_loads.recorded import read_recorded
from fe_drivetrain.turbine_loads.hub_loads.table_kinds import history_digest


@dataclass(frozen=True)
class FitSeat:
    """A press fit with its pressure.

    Attributes
    ----------
    name : str
        Its name.
    diameter, length : float
        Size of the seat [m].
    pressure : float
        Pressure of the fit [Pa].
    friction : float
        Friction of its faces.
    section : int
        Number of the section whose torque and axial force it takes.
    """

    name: str
    diameter: float
    length: float
    pressure: float
    friction: float
    section: int


@dataclass(frozen=True, eq=False)
class StrengthModel:
    """A shaft whose sections are ready for loads.

    Attributes
    ----------
    entrance : Entrance
        Where loads enter.
    bounds : tuple of SectionLoads
        Internal forces, with housings at each of their bounds; those of the assessed sections come
        first.
    moduli : ndarray, (s, 3)
        Section moduli of the assessed sections.
    strengths : tuple of SectionStrength
        What these endure.
    rule : Rule
        How cycles are assessed.
    points : int
        Points round the shaft whose stress is counted.
    flange : FlangeBolts or None
        Bolts of the front flange.
    fits : tuple of FitSeat
        Press fits.
    along : ndarray, (p, 3)
        Moduli of the stations along the shaft, behind the assessed sections, at which the largest
        nominal stress is asked for.
    """

    entrance: Entrance
    bounds: tuple[SectionLoads, ...]
    moduli: Floats
    strengths: tuple[SectionStrength, ...]
    rule: Rule
    points: int
    flange: FlangeBolts | None
    fits: tuple[FitSeat, ...]
    along: Floats

    __repr__ = short_repr

    @property
    def joints(self) -> int:
        """Number of joints: the flange, then press fits."""
        return (self.flange is not None) + len(self.fits)


@dataclass(frozen=True, eq=False)
class StrengthSums:
    """One history, or a class of loads.

    Attributes
    ----------
    seconds, wind : float
        How long it is [s], and its mean wind speed [m/s]; NaN where the file has none.
    static : ndarray, (b, s)
        Least S_F of each section, for each bound of the housings.
    endurance : ndarray, (b, s)
        S_D of the largest range as if it came for ever.
    stresses : ndarray, (b, s, 6)
        Largest nominal stress of axial force, bending and torque, largest half range of normal
        stress at a point and of torsion, and mean of torsion [Pa].
    means : ndarray, (b, s)
        Mean axial stress [Pa].
    damage : ndarray, (b, s, points + 1, factors)
        Damage at each of `FACTORS` at points round the shaft, then of the torque.
    slip, opening : ndarray, (b, joints)
        Least safety of joints against slip and separation.
    along : ndarray, (p,)
        Largest equivalent nominal stress (von Mises) at the stations along the shaft [Pa].
    turns : float
        Turns of the shaft.
    """

    seconds: float
    wind: float
    static: Floats
    endurance: Floats
    stresses: Floats
    means: Floats
    damage: Floats
    slip: Floats
    opening: Floats
    along: Floats
    turns: float

    __repr__ = short_repr


def history_sums(
    model: StrengthModel,
    values: Floats,
    speed: Floats,
    step: float,
    wind: float = float("nan"),
) -> StrengthSums:
    """Strength of all sections under a history.

    Parameters
    ----------
    model : StrengthModel
        The shaft.
    values : ndarray, (n, 6 + 6 m)
        Loads as they enter.
    speed : ndarray, (n,)
        Speed of the rotor [rad/s].
    step : float
        Between two samples [s].
    wind : float
        Mean wind speed [m/s].
    """
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * step)])
    found = _empty(model)
    for b, loads in enumerate(model.bounds):
        for s, strength in enumerate(model.strengths):
            stress = turning_stress(loads.at(s, values), model.moduli[s], angle)
            places = 2.0 * np.pi * np.arange(model.points) / model.points
            ranges = [float(np.ptp(stress.of_point(p) + stress.tension)) for p in places.tolist()]
            _state_stress(found, b, s, stress, strength, model.rule, max(ranges))
            for k, place in enumerate(places.tolist()):
                found["damage"][b, s, k] = damage_of_point(stress, strength, model.rule, place)
            found["damage"][b, s, -1] = damage_of_torque(stress, strength, model.rule)
        _joints(found, b, model, loads, values)
    turns = float(np.abs(np.diff(angle)).sum() / (2.0 * np.pi))
    return StrengthSums(len(values) * step, wind, turns=turns, **found)


def class_sums(model: StrengthModel, values: Floats, turns: float, seconds: float) -> StrengthSums:
    """Strength of all sections under loads that stay, the shaft turning in them.

    Parameters
    ----------
    model : StrengthModel
        The shaft.
    values : ndarray, (6 + 6 m,)
        Loads as they enter.
    turns : float
        Number of turns, each a cycle of bending.
    seconds : float
        How long they last [s].
    """
    found = _empty(model)
    for b, loads in enumerate(model.bounds):
        for s, strength in enumerate(model.strengths):
            stress = turning_stress(loads.at(s, values[None]), model.moduli[s], np.zeros(1))
            bent = float(stress.bending[0])
            _state_stress(found, b, s, stress, strength, model.rule, 2.0 * bent)
            if bent > 0.0:
                cycles = Cycles(np.array([2.0 * bent]), np.array([turns]), stress.tension)
                beside = float(stress.torsion[0])
                found["damage"][b, s, :-1] = damage_at_factors(strength, model.rule, cycles, beside)
        _joints(found, b, model, loads, values[None])
    return StrengthSums(seconds, float("nan"), turns=turns, **found)


def _empty(model: StrengthModel) -> dict[str, Floats]:
    b, s, j = len(model.bounds), len(model.strengths), model.joints
    return {
        "static": np.full((b, s), np.inf),
        "endurance": np.full((b, s), np.inf),
        "stresses": np.zeros((b, s, 6)),
        "means": np.zeros((b, s)),
        "damage": np.zeros((b, s, model.points + 1, len(FACTORS))),
        "slip": np.full((b, j), np.inf),
        "opening": np.full((b, j), np.inf),
        "along": np.zeros(len(model.along)),
    }


def _state_stress(
    found: dict[str, Floats],
    b: int,
    s: int,
    stress: TurningStress,
    strength: SectionStrength,
    rule: Rule,
    largest: float,
) -> None:
    """Static safety, endurance of the largest range, and the stresses of a section."""
    acting = np.column_stack([stress.tension, stress.bending, stress.torsion])
    found["static"][b, s] = combined_safety(acting, strength.yields).min()
    mean = np.array([stress.tension.mean(), 0.0, stress.torsion.mean()])
    amplitudes = np.array([0.0, 0.5 * largest, 0.5 * float(np.ptp(stress.torsion))])
    endured = endured_amplitudes(strength, amplitudes, equivalent_mean(*mean), rule.case)
    found["endurance"][b, s] = combined_safety(amplitudes, endured)
    found["stresses"][b, s] = [*np.abs(acting).max(axis=0), *amplitudes[1:], mean[2]]
    found["means"][b, s] = mean[0]


def _joints(
    found: dict[str, Floats], b: int, model: StrengthModel, loads: SectionLoads, values: Floats
) -> None:
    safeties: list[JointSafety] = []
    if model.flange is not None:
        bolts = model.flange
        safeties.append(
            flange_safety(values[:, :6], bolts.count, bolts.circle, bolts.preload, bolts.friction)
        )
    for fit in model.fits:
        forces = loads.at(fit.section, values)
        safeties.append(press_safety(forces, fit.diameter, fit.length, fit.pressure, fit.friction))
    first = len(model.strengths)
    for p, moduli in enumerate(model.along):
        stress = turning_stress(loads.at(first + p, values), moduli, np.zeros(len(values)))
        normal = np.abs(stress.tension) + stress.bending
        largest = float(np.sqrt(normal**2 + 3.0 * stress.torsion**2).max())
        found["along"][p] = max(found["along"][p], largest)
    for j, one in enumerate(safeties):
        found["slip"][b, j], found["opening"][b, j] = one.slip.min(), one.opening.min()


def file_sums(
    report: Progress,
    file: Path,
    model: StrengthModel,
    options: HistoryOptions,
    content: dict[str, Any],
    resume: bool,
) -> StrengthSums:
    """Strength of all sections under a file, or what an earlier run kept where asked for.

    Parameters
    ----------
    report : Progress
        Told which file is read.
    file : Path
        File with hub loads.
    model : StrengthModel
        The shaft.
    options : HistoryOptions
        How it is read.
    content : dict
        All that the model depends on, for the cache.
    resume : bool
        Take what is kept.

    Raises
    ------
    InputError
        The file cannot be read, or has no rotor speed and none is known.
    """
    report(f"{file.stem}: sections")
    whole = {
        "code": program_hash(),
        "file": history_digest(file),
        "mapping": options.names.content(),
        "reading": [options.skip, options.rotor_speed_rpm],
        **content,
    }
    cache = user_cache()
    kept = cache.load_record("shaft-strength", whole, StrengthSums) if resume else None
    if kept is None:
        kept = _read(file, model, options)
        cache.keep_record("shaft-strength", whole, kept)
    return kept


def _read(file: Path, model: StrengthModel, options: HistoryOptions) -> StrengthSums:
    found = read_recorded(file, options.names, options.skip)
    history, speed = found.history, found.rotor_speed
    if speed is None and options.rotor_speed_rpm is None:
        raise InputError(
            f"hub loads '{file}': there is no rotor speed, by which the shaft turns in its "
            f"bending: give {argument('rotor_speed_rpm')} in 1/min, or its channel, as in "
            "`ChannelMap(channels={'rotor speed': 'RotSpeed'})`"
        )
    if speed is None:
        speed = np.full(len(history), (options.rotor_speed_rpm or 0.0) * ONE_RPM)
    wind = float("nan") if found.wind_speed is None else float(found.wind_speed.mean())
    values = entering(AtFront(model.entrance), history).values
    return history_sums(model, values, speed, history.step, wind)


def worst_of(parts: Sequence[StrengthSums], name: str) -> Floats:
    """Least safety of a name over all, or largest of "stresses" and "along"."""
    rows = np.stack([getattr(one, name) for one in parts])
    return np.asarray(rows.max(axis=0) if name in ("stresses", "along") else rows.min(axis=0))
