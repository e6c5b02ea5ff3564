"""Bearings of a drivetrain's file with the rollers of their catalogue entries, in statics."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.bearing.catalogue import catalogue_bearing, catalogue_entry
from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.mounted_bearings import clearance_change, row_clearance
from fe_drivetrain.drivetrain_file.turning_parts import BearingData, PinData
from fe_drivetrain.dynamics.bodies.advice import Operation, Rung
from fe_drivetrain.dynamics.bodies.bodies import assemble
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import Assembly, assembly, steady_load
from fe_drivetrain.dynamics.bodies.roller_seats import (
    OnRollers,
    Seat,
    machine_seat,
    planet_seats,
    static_on_rollers,
)
from fe_drivetrain.dynamics.bodies.system import springs_named


def catalogued(machine: MachineTable) -> dict[str, BearingData | PinData]:
    """Bearings with a catalogue entry by name; those of planets "stage 1 pin upwind" and so on.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    """
    rows: dict[str, BearingData | PinData] = {row.name: row for row in machine.bearings}
    for number, stage in enumerate(machine.stages, start=1):
        if isinstance(stage, PlanetaryData):
            rows |= {f"stage {number} pin {pin.name}".strip(): pin for pin in stage.pins}
    return {name: row for name, row in rows.items() if row.catalogue is not None}


def main_names(machine: MachineTable) -> tuple[str, ...]:
    """Names of the bearings of the rotor and of the shaft that it drives."""
    holds = ("rotor", machine.shafts[0].name)
    return tuple(bearing.name for bearing in machine.bearings if bearing.holds in holds)


def on_catalogue(
    machine: MachineTable,
    rung: Rung,
    operation: Operation,
    names: Sequence[str] | None = None,
    *,
    catalogues: Sequence[str | Path] = (),
    azimuth: float = 0.0,
    hub: ArrayLike = (0.0,) * 6,
    pressing: Sequence[str] = (),
) -> OnRollers:
    """Equilibrium of a machine on the rollers of its catalogued bearings, with their clearances.

    A bearing on rollers has rigid rings, its outer one in the housing of the rung, or the ground: a
    main bearing's own housing is left out. What rollers do not resist keeps the spring of its row.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    rung : Rung
        Level, and what gives; not the torsional one.
    operation : Operation
        Loads; gravity acts, too, and the generator is held.
    names : sequence of str, optional
        Names of `catalogued` bearings; all of them where left out. One of planets stands for those
        of all planets of its stage.
    catalogues : sequence of str or Path
        Catalogue files beside the package's.
    azimuth : float
        Azimuth of the rotor's shaft [rad].
    hub : array_like, (6,)
        Forces and moments on the rotor beside those of the operation [N, N m].
    pressing : sequence of str
        Names of meshes, whose slices then only press.

    Returns
    -------
    OnRollers
        Converged, or flagged.

    Raises
    ------
    InputError
        A bearing has no catalogue entry, or one that is in no catalogue; its stiffness is six rows;
        or something moves freely.
    """
    known = catalogued(machine)
    chosen = list(known) if names is None else list(names)
    for name in chosen:
        if name not in known:
            raise InputError(
                f"bearing {name!r} has no catalogue entry, whose rollers could carry: give "
                f"catalogue, or use one of {', '.join(known) or 'none'}"
            )
    if not chosen:
        raise InputError("no bearing has a catalogue entry, whose rollers could carry: give some")
    kinds = {name: bearing_of(known[name], catalogues) for name in chosen}
    gives = without_housings(rung.flexible, chosen)
    found = assembly(machine, rung.level, azimuth, held_generator=True, flexible=gives)
    system = assemble(found.bodies, found.springs, found.superelements)
    seats = seats_of(machine, found, kinds, gives, azimuth)
    wrench = np.array(hub, dtype=float)
    wrench[4] += operation.moment
    load = steady_load(machine, system, operation.torque, wrench)
    names = system.spring_names
    contacts = [names[k] for mesh in pressing for k in springs_named(names, mesh)]
    return static_on_rollers(system, load, seats, contacts=contacts)


def bearing_of(row: BearingData | PinData, catalogues: Sequence[str | Path] = ()) -> Bearing:
    """The rolling bearing of a row: its catalogue entry, with the row's clearance or mounting.

    Parameters
    ----------
    row : BearingData or PinData
        Row with a catalogue entry.
    catalogues : sequence of str or Path
        Catalogue files beside the package's.

    Raises
    ------
    InputError
        It is in no catalogue.
    """
    assert row.catalogue is not None  # of `catalogued`
    entry = catalogue_entry(row.catalogue, *catalogues)
    changes = clearance_change(row.clearance, row_clearance(row, entry))
    return catalogue_bearing(row.catalogue, *catalogues, **changes)


def without_housings(gives: Flexible, names: Iterable[str]) -> Flexible:
    """What gives, without the own housings of bearings on rollers.

    Parameters
    ----------
    gives : Flexible
        What gives at a level.
    names : iterable of str
        Names of the bearings.
    """
    return replace(gives, bearings={k: v for k, v in gives.bearings.items() if k not in names})


def seats_of(
    machine: MachineTable,
    found: Assembly,
    kinds: Mapping[str, Bearing],
    gives: Flexible,
    azimuth: float = 0.0,
) -> list[Seat]:
    """Seats of bearings on rollers: those in housings, then those of planets by stage.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    found : Assembly
        Its assembly at a level.
    kinds : mapping of str to Bearing
        Bearings by the names of `catalogued`.
    gives : Flexible
        What gives there.
    azimuth : float
        Azimuth of the rotor's shaft [rad].
    """
    seats = [
        machine_seat(found, name, bearing) for name, bearing in kinds.items() if name in found.seats
    ]
    for number, stage in enumerate(machine.stages, start=1):
        if not isinstance(stage, PlanetaryData):
            continue
        for pin in stage.pins:
            bearing = kinds.get(f"stage {number} pin {pin.name}".strip())
            if bearing is None:
                continue
            own = {f"stage {number} pin {k + 1} {pin.name}".strip() for k in range(stage.planets)}
            of_all = planet_seats(machine, number, bearing, azimuth, gives)
            seats += [one for one in of_all if one.name in own]
    return seats
