"""The 2 MW machine with what the thesis does not print: its bearings, its steels, its wind."""

from __future__ import annotations

import json
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from fe_drivetrain.bearing.catalogue import read_bearing_catalogue
from fe_drivetrain.cases.references.operated_machines import (
    EVENT_STEP,
    HISTORY_STEP,
    Rig,
    driving,
    rig_of,
    scaled_to,
    stop_values,
    turbine_in_wind,
)
from fe_drivetrain.drivetrain_file import Drivetrain, read_drivetrain
from fe_drivetrain.dynamics import Level
from fe_drivetrain.report.suite.chosen import ChosenDrivetrain
from fe_drivetrain.studies import DamageOptions, LifeOptions, TransientResult, transient
from fe_drivetrain.studies.part_bearings import counted_parts
from fe_drivetrain.studies.part_loads import ForcedBearing
from fe_drivetrain.turbine_loads.hub_loads.drive_history import DriveHistory

TWO_MW = "synthetic_2mw"
ALLOWED = 1.45e9
"""Contact stress that gears endure [Pa]: the thesis, section 7.2.2, after ISO 6336-5."""

STEEL = {"steel": "case-hardened", "contact_limit": ALLOWED, "root_limit": 4.3e8}
GEARS = (("ring", "planet", "sun"), ("gear", "pinion"), ("gear", "pinion"))

SCALE = (1.055e6 / 3.25e5) ** 0.5
"""Size of the 2 MW machine's bearings over those of the public 750 kW gearbox, whose names of
bearings the thesis has: the root of the ratio of rated torques, which leaves stresses the same."""

CLEARANCE = 1e-4
"""Diametral clearance of planet bearings [m]; not printed."""

PLANET = "planet"
BEARINGS = {
    PLANET: "planet_nj2232",
    "PLC-A": "cylindrical_sl181892",
    "PLC-B": "cylindrical_sl181880",
    "IS1-A": "cylindrical_sl181856",
    "IS1-B": "tapered_pair_32948",
    "IS2-A": "cylindrical_nu2220",
    "IS2-B": "tapered_pair_32032",
    "HS-A": "cylindrical_nu2220",
    "HS-B": "tapered_pair_32222",
}
"""Entry of the 750 kW gearbox's bearing in each place."""

_LENGTHS = ("element_diameter", "element_length", "pitch_diameter", "bore", "spread")


def thesis_machine() -> Drivetrain:
    """The library's 2 MW machine with steels, oil and names of planet bearings."""
    changes: dict[str, Any] = {"operation.lubricant": "VG 320"}
    for number, names in enumerate(GEARS):
        gears = {name: dict(STEEL) for name in names}
        changes[f"gearbox.stages.{number}.strength"] = {"gears": gears, "grade": 6}
    for number in (0, 1):
        changes[f"gearbox.stages.0.pins.{number}.catalogue"] = PLANET
    return read_drivetrain(TWO_MW, changes)


def scaled_bearings(folder: Path, size: float = 1.0, clearance: float = CLEARANCE) -> LifeOptions:
    """Bearings of the public 750 kW gearbox in the size of the 2 MW machine, as a catalogue.

    Parameters
    ----------
    folder : Path
        Takes the catalogue, ``bearings.json``.
    size : float
        Their size over that by torque.
    clearance : float
        Diametral clearance of the planets' [m].
    """
    known = read_bearing_catalogue()
    entries = {}
    for name, of in BEARINGS.items():
        data = known[of].model_dump(exclude_none=True)
        data |= {key: size * SCALE * data[key] for key in _LENGTHS if key in data}
        data |= {"clearance": 0.5 * clearance if name == PLANET else 0.0, "scenes": []}
        data["title"] = f"{data['title']}, scaled by {size * SCALE:.3g}"
        entries[name] = data
    file = folder / "bearings.json"
    file.write_text(json.dumps(entries, indent=1), encoding="utf-8")
    named = {name: name for name in BEARINGS if name != PLANET}
    return LifeOptions(catalogues=(file,), bearings=named)


@dataclass(frozen=True, eq=False)
class Chain:
    """Normal operation and a shutdown of one machine, each by the study of transients.

    Attributes
    ----------
    drivetrain : Drivetrain
        The machine.
    rig : Rig
        It at its level.
    history : DriveHistory
        What drives it in normal operation.
    values : dict
        Values of the stop.
    normal, stop : TransientResult
        Both.
    bearings : dict[str, ForcedBearing]
        Bearings whose rollers are known, by name.
    """

    drivetrain: Drivetrain
    rig: Rig
    history: DriveHistory
    values: dict[str, float | str]
    normal: TransientResult
    stop: TransientResult
    bearings: dict[str, ForcedBearing]


def chain(
    chosen: ChosenDrivetrain,
    folder: Path,
    level: Level,
    lives: LifeOptions,
    *,
    damage: bool = True,
) -> Chain:
    """Run normal operation and a shutdown.

    Parameters
    ----------
    chosen : ChosenDrivetrain
        The drivetrain.
    folder : Path
        Takes the history of normal operation, ``normal_operation.csv``.
    level : Level
        What may move.
    lives : LifeOptions
        Catalogue entries of bearings.
    damage : bool
        Whether damage is counted, too; else steps of the stop are twice as long.
    """
    drivetrain, speed = chosen.drivetrain, chosen.rotor_speeds()[1]
    rig = rig_of(drivetrain, level)
    made = scaled_to(turbine_in_wind(), chosen.rated_torque() * speed, speed)
    file = folder / "normal_operation.csv"
    made.write(file)
    values = stop_values(drivetrain, rig)
    counts = DamageOptions(lives=lives) if damage else None
    happen = partial(transient, drivetrain, level=level.name.lower(), damage=counts)
    counted, _ = counted_parts(drivetrain, rig.machine, lives, False)
    return Chain(
        drivetrain,
        rig,
        driving(made),
        values,
        happen("operation", loads=file, step=HISTORY_STEP),
        happen("stop", values, step=None if damage else 2.0 * EVENT_STEP),
        {one.name: one for one in counted.bearings},
    )


def other_level(one: Chain, level: Level) -> Rig:
    """The machine of a chain at another level."""
    return replace(one.rig, rung=rig_of(one.drivetrain, level).rung)
