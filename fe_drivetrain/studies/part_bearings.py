"""Bearings of a drivetrain whose loads are those of a history in time, and which have no entry."""

from __future__ import annotations

from fe_drivetrain.bearing.catalogue import name_of, read_bearing_catalogue
from fe_drivetrain.bearing_life.life.rated import rated_from_catalogue
from fe_drivetrain.bearing_life.life.reference_life import Turning
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.mounted_bearings import clearance_change, row_clearance
from fe_drivetrain.dynamics.bodies.bearing_reactions import planet_bearing_name
from fe_drivetrain.dynamics.bodies.catalogue_seats import catalogued, main_names
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.studies.gearbox_bearings import (
    catalogue_entries,
    require_bearings,
)
from fe_drivetrain.studies.life_options import LifeOptions
from fe_drivetrain.studies.named_bearings import entry_of
from fe_drivetrain.studies.part_loads import CountedParts, ForcedBearing
from fe_drivetrain.studies.rolling_bearings import own_rules, profile_of


def counted_parts(
    drivetrain: Drivetrain,
    machine: Machine,
    options: LifeOptions,
    rollers: bool,
    strict: bool = True,
) -> tuple[CountedParts, tuple[str, ...]]:
    """Bearings that have an entry of the catalogue, and the names of the others.

    Parameters
    ----------
    drivetrain : Drivetrain
        Names the entries.
    machine : Machine
        Its machine.
    options : LifeOptions
        Catalogues, lubricants and rules of lives.
    rollers : bool
        Whether rollers are brought into equilibrium.
    strict : bool
        Whether entries that are in no catalogue are refused; else their bearings are among the
        others, as where nobody can give a catalogue.

    Raises
    ------
    InputError
        An entry is unknown and `strict`, or of a bearing that there is not.
    """
    choices, rules = options.choices, options.rules
    entries = {**catalogue_entries(drivetrain), **choices.named}
    planets = {
        planet_bearing_name(number, pin.name): True
        for number, stage in enumerate(machine.stages, start=1)
        if isinstance(stage, PlanetaryData)
        for pin in stage.pins
    }
    names = [*(bearing.name for bearing in machine.bearings), *planets]
    require_bearings(names, entries, choices.only)
    known, main = read_bearing_catalogue(*choices.catalogues), main_names(machine)
    rows = catalogued(machine)
    if not strict:
        entries = {
            name: entry
            for name, entry in entries.items()
            if not isinstance(entry, str) or entry in known
        }
    oil = options.oil(drivetrain.operation)
    found = []
    for name in names:
        if name not in entries or choices.only not in (None, name):
            continue
        entry = entry_of(name, entries[name], known)
        changes = profile_of(entry, choices.profiled)
        if (row := rows.get(name)) is not None:
            changes |= clearance_change(row.clearance, row_clearance(row, entry))
        rated = rated_from_catalogue(entries[name], *choices.catalogues, **changes)
        turning: Turning | None = None
        if name not in main:
            turning = "outer" if name in planets else "inner"
        own = own_rules(rules, turning, None if name in main else oil)
        found.append(ForcedBearing(name, name_of(entries[name]), entry, rated, own))
    others = tuple(name for name in names if name not in entries)
    return CountedParts(tuple(found), rollers), others
