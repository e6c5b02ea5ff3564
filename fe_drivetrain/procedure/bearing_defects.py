"""Defect frequencies of all bearings of a machine, and the excitations that defects would make."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import pi
from pathlib import Path

from fe_drivetrain.bearing.catalogue import (
    Entry,
    catalogue_entry,
    fitted_entry,
    name_of,
    read_bearing_catalogue,
)
from fe_drivetrain.bearing.defect_frequencies import DefectFrequencies, defect_frequencies
from fe_drivetrain.bearing.fitted_rollers import fitted_rollers
from fe_drivetrain.bearing.geometry import Row, count
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.catalogue_seats import bearing_of, catalogued
from fe_drivetrain.procedure.resonance import Excitation

ONCE_A_SECOND = 2.0 * pi
"""Speed of the rotor [rad/s] at which a frequency in Hz is a number of periods per turn."""

STRIKES = {"BPFO": 1.0, "BPFI": 1.0, "BSF": 2.0, "FTF": 1.0}
"""Strikes for each period of a defect: a place on a rolling element meets both rings."""


@dataclass(frozen=True)
class BearingDefects:
    """Defect frequencies of a bearing in its drivetrain.

    Attributes
    ----------
    name, entry : str
        Name of the bearing, and of its catalogue entry; of planets "stage 1 pin upwind".
    per_turn : DefectFrequencies
        Periods for one turn of the rotor, all rows being equal; of a planet's bearing as its
        carrier has them.
    rows, elements : int
        Number of rows, and of rolling elements in one row.
    speed_ratio : float
        Speed of one ring against the other over that of the rotor, without a sign.
    parts : tuple of str
        Springs of the bearing in a model; of planets those of each.
    insides : tuple of DefectFrequencies
        `per_turn` of every inside that fits its catalogue's page; empty of an inside that is known.
    """

    name: str
    entry: str
    per_turn: DefectFrequencies
    rows: int
    elements: int
    speed_ratio: float
    parts: tuple[str, ...]
    insides: tuple[DefectFrequencies, ...] = ()

    __repr__ = short_repr

    def ends(self, kind: str) -> tuple[float, float] | None:
        """Least and most periods of a defect over all insides that fit the page; None of others."""
        of_all = [one.by_name()[kind] for one in self.insides]
        return (min(of_all), max(of_all)) if of_all else None

    def excitations(self, parts: Mapping[str, object]) -> tuple[Excitation, ...]:
        """Excitations by a defect of each kind, as far as a model has springs of the bearing.

        Parameters
        ----------
        parts : mapping of str to object
            Parts of the model, as `SystemModes.energy_shares`.
        """
        known = tuple(part for part in self.parts if part in parts)
        found = []
        for kind, periods in self.per_turn.by_name().items():
            strikes = STRIKES[kind]
            name = f"{self.name} {kind}" if strikes == 1.0 else f"{self.name} 2x {kind}"
            if known and periods > 0.0:
                found.append(Excitation(name, strikes * periods, known))
        return tuple(found)


def bearing_defects(
    machine: MachineTable, catalogues: Sequence[str | Path] = ()
) -> tuple[tuple[BearingDefects, ...], tuple[str, ...]]:
    """Defect frequencies of all bearings of a machine that have a catalogue entry.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    catalogues : sequence of str or Path
        Catalogue files beside the package's.

    Returns
    -------
    found : tuple of BearingDefects
        Main bearings and bearings in the housing in the order of the machine, then of planets.
    unknown : tuple of str
        Names of bearings without an entry, or with one that is in no catalogue.
    """
    known = read_bearing_catalogue(*catalogues)
    rows = catalogued(machine)
    ratios = ring_speeds(machine)
    found, unknown = [], []
    for name, ratio in ratios.items():
        row = rows.get(name)
        named = None if row is None else row.catalogue
        if row is None or named is None or (isinstance(named, str) and named not in known):
            unknown.append(name)
            continue
        own = bearing_of(row, catalogues).rows
        planets = _planets(machine, name)
        # a planet turns on its pin: the outer ring moves in the frame of the carrier
        speeds = (0.0, ratio) if planets else (ratio, 0.0)
        frequencies = defect_frequencies(own[0], *(ONCE_A_SECOND * one for one in speeds))
        parts = tuple(name.replace(" pin", f" pin {k + 1}") for k in range(planets)) or (name,)
        insides = tuple(
            defect_frequencies(row, *(ONCE_A_SECOND * one for one in speeds))
            for row in _insides(catalogue_entry(named, *catalogues))
        )
        found.append(
            BearingDefects(
                name,
                name_of(named),
                frequencies,
                len(own),
                count(own[0]),
                abs(ratio),
                parts,
                insides,
            )
        )
    return tuple(found), tuple(unknown)


def _insides(entry: Entry) -> list[Row]:
    """First row of every inside that fits an entry's page; none of an inside that is known."""
    if entry.page is None or not entry.fitted:
        return []
    fitted = fitted_rollers(entry.page)
    return [
        fitted_entry(entry.page, member, fitted).bearing(entry.title).rows[0]
        for member in range(len(fitted))
    ]


def ring_speeds(machine: MachineTable) -> dict[str, float]:
    """Speed of the turning ring against the other over that of the rotor, of all bearings by name.

    Parameters
    ----------
    machine : MachineTable
        The machine.

    Returns
    -------
    ratios : dict of str to float
        With signs; those of planets' bearings in the frame of the carrier.
    """
    shafts = dict(zip((one.name for one in machine.shafts), machine.speeds, strict=True))
    found = {}
    for bearing in machine.bearings:
        if bearing.holds in shafts:
            found[bearing.name] = shafts[bearing.holds]
            continue
        stage, _, body = bearing.holds.removeprefix("stage ").partition(" ")
        if body:
            driven = body in ("sun", "pinion")
            found[bearing.name] = machine.speeds[int(stage) - (0 if driven else 1)]
        else:
            found[bearing.name] = machine.speeds[0 if bearing.holds == "rotor" else -1]
    for number, stage_data in enumerate(machine.stages, start=1):
        if isinstance(stage_data, PlanetaryData):
            sun = machine.speeds[number] - machine.speeds[number - 1]
            radius = stage_data.sun_radius
            planet = -sun * radius / (stage_data.centre_distance - radius)
            names = (f"stage {number} pin {pin.name}".strip() for pin in stage_data.pins)
            found |= dict.fromkeys(names, planet)
    return found


def _planets(machine: MachineTable, name: str) -> int:
    """Number of planets with a bearing of a name; 0 of one in the housing."""
    if name in {bearing.name for bearing in machine.bearings}:
        return 0
    stage = machine.stages[int(name.split()[1]) - 1]
    return stage.planets if isinstance(stage, PlanetaryData) else 0
