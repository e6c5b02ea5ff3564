"""Bearings of a user's planets on the rollers of their catalogue entries, over a turn."""

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.bearing import load_zones, pressures
from fe_drivetrain.cases.dynamics.planets_on_pins import TURNS, first_stage
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.common.typeset import MINUS
from fe_drivetrain.drivetrain_file.carriers import carriers_of
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics import (
    Flexible,
    Level,
    Machine,
    OnRollers,
    Operation,
    Rung,
    Static,
    azimuths,
    machine_of,
    machine_system,
    on_catalogue,
    static,
    steady_load,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import ChosenDrivetrain, Page, Record, Run
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame

TURN = "Radial load of the bearings of planet 1 on rollers, {}"
LINEAR, TIGHT, LOOSE = "linear bearings", "rollers without clearance", "rollers"
RIGID, GIVES = "rigid carrier", "carrier of the file"
TANGENTIAL = "sum of the tangential loads of the planets' bearings"


@dataclass(frozen=True)
class Loads:
    """Radial loads [N], (azimuths, planets, bearings of a pin), and the equilibria on rollers."""

    loads: Floats
    found: list[OnRollers]


def own(run: Run, page: Page, chosen: ChosenDrivetrain) -> None:
    """Equilibria over a turn of the first carrier of a user's drivetrain, model by model.

    Raises
    ------
    InputError
        The first stage is not planetary, its pins name no catalogue entry, or the file states no
        operation.
    """
    chosen.state(page)
    machine, torque = machine_of(chosen.drivetrain), chosen.rated_torque()
    stage, pins = first_stage(machine)
    for place, pin in enumerate(stage.pins):
        if pin.catalogue is None:
            raise InputError(
                f"bearing {pin.name!r} of the planets of {chosen.title!r} names no rollers: give "
                f"gearbox.stages.0.pins.{place}.catalogue"
            )
    moments = {TURNS[0]: 0.0, TURNS[1]: -torque}
    page.assume("moment about y at the hub", -torque / 1e3, "kN m", "as large as the torque")
    angles = azimuths((2 if run.quick else 8) * stage.planets)
    carriers = {RIGID: Flexible()}
    if 1 in (components := carriers_of(chosen.drivetrain)):
        carriers[GIVES] = Flexible({1: carrier_frame(components[1])})
    found: dict[tuple[str, str], Loads] = {}
    for turn, moment in moments.items():
        for carrier, gives in carriers.items():
            for bearings in (LINEAR, TIGHT, LOOSE):
                name = f"{bearings}, {carrier}"
                with run.step(f"{name}, {turn}"):
                    operation = Operation(torque, moment)
                    found[turn, name] = turned(machine, bearings, gives, operation, angles)
    last = f"{LOOSE}, {list(carriers)[-1]}"
    check(page, stage, found, last, torque)
    rows = [row_of(stage, pins, turn, name, one) for (turn, name), one in found.items()]
    show(page, found, angles, last, pins)
    page.table("Loads, rollers and pressures", rows)
    page.data("loads", rows)
    answer(page, chosen, rows, list(carriers))
    page.assume_all(machine.assumptions())


def turned(
    machine: Machine, bearings: str, gives: Flexible, operation: Operation, angles: Floats
) -> Loads:
    """Equilibria of one model with the carrier at one azimuth after the other."""
    stage, pins = first_stage(machine)
    names = [f"stage 1 pin {pin}".strip() for pin in pins]
    of = without_clearance(machine) if bearings == TIGHT else machine
    found: list[OnRollers] = []
    loads = np.zeros((len(angles), stage.planets, len(pins)))
    for i, azimuth in enumerate(float(a) for a in angles):
        if bearings == LINEAR:
            linear = at_rest(machine, gives, operation, azimuth)
            radial = linear.radial
        else:
            rung = Rung(Level.RIGID, gives, "planets on rollers")
            one = on_catalogue(of, rung, operation, names, azimuth=azimuth)
            found.append(one)
            radial = one.radial
        loads[i] = [
            [radial(f"stage 1 pin {k + 1} {pin}".strip()) for pin in pins]
            for k in range(stage.planets)
        ]
    return Loads(loads, found)


def at_rest(machine: Machine, gives: Flexible, operation: Operation, azimuth: float) -> Static:
    """Equilibrium with the bearings' own springs."""
    system = machine_system(machine, Level.RIGID, azimuth, held_generator=True, flexible=gives)
    hub = np.array([0.0, 0.0, 0.0, 0.0, operation.moment, 0.0])
    return static(system, steady_load(machine, system, operation.torque, hub))


def without_clearance(machine: Machine) -> Machine:
    """The machine with no clearance in the bearings of the first stage's planets."""
    stage, _ = first_stage(machine)
    pins = tuple(pin.model_copy(update={"clearance": 0.0}) for pin in stage.pins)
    first = stage.model_copy(update={"pins": pins})
    return machine.model_copy(update={"stages": (first, *machine.stages[1:])})


def check(
    page: Page,
    stage: PlanetaryData,
    found: dict[tuple[str, str], Loads],
    last: str,
    torque: float,
) -> None:
    """Convergence, balance and symmetry."""
    page.holds(
        "every equilibrium with rollers has converged",
        all(one.converged for turn in found.values() for one in turn.found),
        why="the energy is convex",
        source="residual below 1e-9 of the load",
    )
    of = found[TURNS[0], last]
    seats = stage.planets * len(stage.pins)
    along = np.array([np.abs(one.loads[:seats, 2].sum()) for one in of.found])
    page.equals(
        f"{TANGENTIAL} [kN]",
        float(along.mean()) / 1e3,
        torque / stage.centre_distance / 1e3,
        within=1e-6,
        why="solver; the bearings of the carrier carry no torque",
        source="statics: the torque over the radius of the pins",
    )
    if stage.planets > 1:
        one, two = of.loads[:, 0], of.loads[:, 1]
        page.vanishes(
            "planet 2 has planet 1's loads earlier by its angle: relative difference",
            float(np.abs(np.roll(one, -len(one) // stage.planets, axis=0) - two).max() / one.max()),
            within=1e-6,
            why="the iteration; planets are equal, and rollers stand still against their pin",
            source="symmetry",
        )


def row_of(stage: PlanetaryData, pins: list[str], turn: str, name: str, of: Loads) -> Record:
    """One row of the table."""
    row: Record = {"load case": turn, "model": name}
    means = of.loads.mean(axis=(0, 1)) / 1e3
    row |= {f"{pin}, mean [kN]": float(m) for pin, m in zip(pins, means, strict=True)}
    row["largest load [kN]"] = float(of.loads.max()) / 1e3
    row["first over last, of means"] = float(means[0] / means[-1])
    row["loaded rollers"] = row["pressure [MPa]"] = None
    if of.found:
        seats = of.found[0].seats[: stage.planets * len(pins)]
        motions = np.array([one.motions[: len(seats)] for one in of.found])
        counts, peaks = [], []
        for k, seat in enumerate(seats):
            counts.append(load_zones(seat.bearing, motions[:, k])[0].loaded)
            peaks.append(pressures(seat.bearing, motions[:, k])[0][0].max())
        row["loaded rollers"] = f"{np.min(counts):g} to {np.max(counts):g}"
        row["pressure [MPa]"] = float(np.max(peaks)) / 1e6
    return row


def show(
    page: Page,
    found: dict[tuple[str, str], Loads],
    angles: Floats,
    last: str,
    pins: list[str],
) -> None:
    """Show the loads of planet 1 over a turn, on rollers beside linear bearings."""
    page.section("Over a turn")
    linear = last.replace(LOOSE, LINEAR)
    for turn in TURNS:
        page.chart(
            TURN.format(turn),
            [
                trace(f"{pin}, {name}", np.degrees(angles), found[turn, model].loads[:, 0, p] / 1e3)
                for p, pin in enumerate(pins)
                for name, model in (("rollers", last), ("linear", linear))
            ],
            "azimuth of the carrier [deg]",
            "radial load [kN]",
        )


def answer(page: Page, chosen: ChosenDrivetrain, rows: list[Record], carriers: list[str]) -> None:
    """State the largest load on rollers beside that of linear bearings, and the pressure."""
    by = {(str(row["load case"]), str(row["model"])): row for row in rows}
    worst = by[TURNS[1], f"{LOOSE}, {carriers[-1]}"]
    linear = by[TURNS[1], f"{LINEAR}, {carriers[-1]}"]
    calm = by[TURNS[0], f"{LOOSE}, {carriers[-1]}"]
    key = "largest load [kN]"
    most, rest = float(str(worst[key])), float(str(linear[key]))
    pressure = float(str(worst["pressure [MPa]"]))
    more = f"{100 * (most / rest - 1):+.2g}\u00a0%".replace("-", MINUS)
    cautions = [f"{chosen.title}: rings are rigid, and so is the gearbox's housing."]
    if len(carriers) == 1:
        cautions.append("The carrier is rigid: the file names no carrier.component.")
    page.answer(
        "What do rollers and clearance do to the loads of the planets' bearings?",
        f"With rollers modelled, a planet bearing carries up to {value_text(most, 'kN')}, {more} "
        f"from linear bearings; its contact pressure is {value_text(pressure, 'MPa')}.",
        [
            page.value(
                "largest load, with a tilt moment at the hub, too [kN]",
                most,
                beside=rest,
                by="linear",
            ),
            page.value(
                "largest load, torque and gravity [kN]",
                calm[key],
                beside=by[TURNS[0], f"{LINEAR}, {carriers[-1]}"][key],
                by="linear",
            ),
            page.value("largest contact pressure [MPa]", pressure),
            page.value(
                "first bearing of a pin over its last, of means", calm["first over last, of means"]
            ),
            page.judged(TANGENTIAL, "sum of the planets' tangential loads", "statics"),
        ],
        TURN.format(TURNS[1]),
        cautions,
    )
