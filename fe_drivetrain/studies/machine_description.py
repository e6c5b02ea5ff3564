"""What turns in a drivetrain: tables of stages, shafts and bearings, ratio, first mode."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from math import prod

from fe_drivetrain.bearing.catalogue_page import entry_name
from fe_drivetrain.common.typeset import with_prefix
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData
from fe_drivetrain.drivetrain_file.left_out import LeftOut
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.stage_completion import NotGivenError
from fe_drivetrain.drivetrain_file.turning_parts import ShaftData, SixOrMatrix, diagonal
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.catalogue_seats import main_names
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system, torsional
from fe_drivetrain.dynamics.bodies.machine import Machine, derived_values, machine_of
from fe_drivetrain.dynamics.torsion.gear_table import GRID
from fe_drivetrain.dynamics.torsion.system import natural_modes
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.scene_description import springs_in_words


def assume_housings(found: Findings, assumes: Iterable[str]) -> None:
    """State what a level assumes of housings and what gives, as rows of assumptions.

    Parameters
    ----------
    found : Findings
        Takes the rows.
    assumes : iterable of str
        As "name: what is assumed", see `Rung`.
    """
    for what in assumes:
        name, _, stands = what.partition(": ")
        value, since, why = stands.partition(", since ")
        found.assume(name, value, "", f"assumed{since}{why}")


def housings_in_words(rung: Rung, machine: MachineTable) -> str:
    """What the housings of a drivetrain do at a level, as a sentence.

    Parameters
    ----------
    rung : Rung
        The level, and what gives.
    machine : MachineTable
        The drivetrain's machine.
    """
    if rung.level is Level.TORSIONAL:
        return "Bodies only turn at the torsional level: neither mount nor housings act there."
    gives = rung.flexible
    own = {*main_names(machine)}
    mains = "give way" if gives.bearings.keys() & own else "are rigid and stand on the ground"
    if not machine.stages:
        return f"Housings of main bearings {mains}."
    words = " Catalogued bearings are on their rollers." if rung.rollers else ""
    if gives.bearings.keys() - own:
        words = " Catalogued bearings of the gearbox have the stiffness of their rollers."
    stands = "on its mount" if gives.housing is not None else "on the ground"
    return (
        f"The gearbox's housing is rigid in itself and stands {stands}; housings of main bearings "
        f"{mains}.{words}"
    )


@dataclass(frozen=True)
class Turning:
    """All that turns in a drivetrain, as far as its file states it.

    Attributes
    ----------
    machine : Machine
        Bodies, shafts, stages and bearings.
    ratio : float
        Speed of the generator over that of the rotor, without sign.
    first_torsional : float
        First frequency of torsion above zero, generator free, of a grid too [Hz].
    degrees : Mapping[str, int]
        Degrees of freedom of each level that the file allows, by its name.
    """

    machine: Machine
    ratio: float
    first_torsional: float
    degrees: Mapping[str, int]


def turning_parts(drivetrain: Drivetrain) -> tuple[Turning | None, str]:
    """All that turns in a drivetrain; None, and what its file lacks, where it does not state it.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.

    Raises
    ------
    InputError
        Something moves freely, or what is given contradicts itself.
    """
    try:
        machine = machine_of(drivetrain)
    except NotGivenError as error:
        return None, str(error)
    levels = [Level.TORSIONAL] if machine.not_given else list(Level)
    system = torsional(machine)
    off_grid = tuple(one for one in system.elements if one.name != GRID)
    first = natural_modes(replace(system, elements=off_grid)).frequencies[1]
    return Turning(
        machine,
        abs(machine.speeds[-1]),
        float(first),
        {level.value: len(machine_system(machine, level).names) for level in levels},
    ), ""


def stated(drivetrain: Drivetrain) -> Iterator[LeftOut]:
    """Assumptions that a drivetrain's file states, and what was derived or assumed in its place."""
    for number, text in enumerate(drivetrain.assumed, start=1):
        yield LeftOut(f"assumed in the file, {number}", "", "", text)
    yield from derived_values(drivetrain)


def turning_tables(turning: Turning) -> dict[str, list[Record]]:
    """Tables of stages, shafts and bearings, by their captions.

    Parameters
    ----------
    turning : Turning
        What turns.
    """
    machine, speeds = turning.machine, turning.machine.speeds
    tables: dict[str, list[Record]] = {}
    if machine.stages:
        tables["Gear stages, from the rotor on"] = [
            _stage_row(number, stage) for number, stage in enumerate(machine.stages, start=1)
        ]
    tables["Shafts, from the rotor on"] = [
        _shaft_row(shaft, speed) for shaft, speed in zip(machine.shafts, speeds, strict=True)
    ]
    pins = [
        {
            "bearing": f"stage {number} pin {pin.name}".strip(),
            "holds": f"stage {number} planets",
            "at [m]": pin.offset,
            "stiffness": _springs(pin.stiffness),
            "catalogue": entry_name(pin.catalogue),
        }
        for number, stage in enumerate(machine.stages, start=1)
        if isinstance(stage, PlanetaryData)
        for pin in stage.pins
    ]
    pins += [
        {
            "bearing": f"stage {number} bushings",
            "holds": f"stage {number} pins",
            "at [m]": 0.0,
            "stiffness": _springs(stage.bushing),
            "catalogue": None,
        }
        for number, stage in enumerate(machine.stages, start=1)
        if isinstance(stage, PlanetaryData) and stage.bushing is not None
    ]
    bearings: list[Record] = [
        {
            "bearing": bearing.name,
            "holds": bearing.holds,
            "at [m]": bearing.at,
            "stiffness": _springs(bearing.stiffness),
            "catalogue": entry_name(bearing.catalogue),
        }
        for bearing in machine.bearings
    ]
    if bearings or pins:
        tables["Bearings of all shafts; main bearings in rigid housings"] = [*bearings, *pins]
    return tables


def ratio_in_words(machine: Machine) -> str:
    """The ratio of all stages, as in "99:21 planetary, 82:23, 88:22"."""
    if not machine.stages:
        return "direct drive"
    said = []
    for stage in machine.stages:
        kind = "planetary " if isinstance(stage, PlanetaryData) else ""
        said.append(f"{kind}{stage.speed_ratio:.4g}")
    whole = prod(stage.speed_ratio for stage in machine.stages)
    return f"{' x '.join(said)} = {whole:.5g}"


def _stage_row(number: int, stage: PlanetaryData | ParallelData) -> Record:
    teeth = stage.teeth
    named = "" if teeth is None else ", ".join(f"{k} {v}" for k, v in teeth._asdict().items())
    stiffness = (
        {
            "sun": stage.along_line(stage.sun_planet) / 1e9,
            "ring": stage.along_line(stage.ring_planet) / 1e9,
        }
        if isinstance(stage, PlanetaryData)
        else {"mesh": stage.along_line(stage.stiffness) / 1e9}
    )
    return {
        "stage": f"{number} {stage.name}".strip(),
        "kind": stage.kind,
        "ratio": stage.speed_ratio,
        "teeth": named,
        "planets": stage.planets if isinstance(stage, PlanetaryData) else None,
        "module [mm]": None if stage.module is None else 1e3 * stage.module,
        "helix [deg]": stage.helix,
        "centre distance [mm]": 1e3 * stage.centre_distance,
        "face width [mm]": 1e3 * stage.face_width,
        "mesh stiffness [N/nm]": ", ".join(f"{k} {v:.3g}" for k, v in stiffness.items()),
    }


def _shaft_row(shaft: ShaftData, speed: float) -> Record:
    size = f"torsion {with_prefix(shaft.torsion, 'N m/rad')}" if shaft.torsion else "rigid"
    if shaft.sections is not None:
        widest = max(max(s.outer_diameter, s.end_diameter) for s in shaft.sections)
        count = len(shaft.sections)
        size = f"{count} section{'s' if count > 1 else ''}, up to {widest:g} m wide"
    elif shaft.outer is not None:
        size = f"{shaft.outer:g} m wide" + (f", bore {shaft.inner:g} m" if shaft.inner else "")
    return {
        "shaft": shaft.name,
        "kind": shaft.kind,
        "length [m]": shaft.length,
        "size": size + _spline(shaft),
        "speed over the rotor's": speed,
    }


def _spline(shaft: ShaftData) -> str:
    """The spline that a shaft begins with, in words."""
    if shaft.spline is None:
        return ""
    return f", on a spline of {shaft.spline.teeth} teeth, {shaft.spline.diameter:g} m wide"


def _springs(stiffness: SixOrMatrix) -> str:
    """Springs in words; of a matrix its diagonal."""
    coupled = ", with couplings" if isinstance(stiffness[0], tuple) else ""
    return springs_in_words(diagonal(stiffness)) + coupled
