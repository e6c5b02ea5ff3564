"""Tables 5.3, 6.3 and 6.4 of quantities at pitch and yaw interfaces, filled from simulations."""

import json

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.pitch_loads import Pitched, pitched
from fe_drivetrain.cases.procedure.slewing_drives import PITCH, YAW
from fe_drivetrain.common import Floats, wrench_transport
from fe_drivetrain.comparison import round_off
from fe_drivetrain.procedure import (
    drive_torque,
    filled_table,
    friction_torque,
    listed_quantities,
    ring_torque,
)
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.turbine_loads.hub_loads import ROOT_LOADS

OVERHANG, HEIGHT = 3.5, 2.0  # m, hub before the tower's axis and above its top
NACELLE = 80e3 * 9.81, 0.8  # N without the rotor, m behind the tower's axis
TORQUE = "Torque of the pitch motor at 17 m/s"
PINION = 12.0  # turns of the pinion for one of the blade


@case(
    "Quantities to be measured at pitch and yaw interfaces, from simulations",
    source="PROTEST 2010, ECN-E--10-100, Tables 5.3, 6.3, 6.4",
)
def run(run: Run, page: Page) -> None:
    """One wind speed above rated: pitch system, and the tower's top while the nacelle yaws."""
    with run.step("turbine"):
        one = pitched(17.0, 60.0 if run.quick else 600.0)
    made, step = one.roots.made, one.step
    of_pitch, motor = pitch_channels(one)
    channels = of_pitch | yaw_channels(made.history.loads, step)
    listed = listed_quantities()
    tables = {name: filled_table(listed.of(name), channels, step) for name in ("5.3", "6.3", "6.4")}
    show_tables(page, tables)
    with (run.folder / "tables.json").open("w", encoding="utf-8") as file:
        json.dump(tables, file)
    rows = [row for table in tables.values() for row in table]
    given = [row for row in rows if row["given"]]
    by_name = {row["channel"]: row for row in reversed(given)}
    check_durations(page, given, step * len(made.pitch))
    page.equals(
        "tower top: mean axial force [kN]",
        by_name["tower top axial force"]["mean"] / 1e3,
        (float(made.history.loads[:, 2].mean()) - NACELLE[0]) / 1e3,
        **round_off(len(made.pitch), "a mean over all samples, in another order"),
        source="hub force and weight of the nacelle",
    )
    mandatory = [row for row in tables["6.4"] if row["rank"] == "mandatory"]
    page.holds(
        "Table 6.4: all that is mandatory is given",
        all(row["given"] for row in mandatory),
        why="tower top loads follow from those of the hub",
        source="PROTEST 2010, Table 6.4",
    )
    draw_torque(page, made.history.time, channels["motor torque"])
    missing = [str(row["channel"]) for row in rows if not row["given"]]
    answer(page, (given, rows), mandatory, float(by_name["motor torque"]["rms of 600 s"]), motor)
    page.text("Not given by these models: " + ", ".join(dict.fromkeys(missing)) + ".")
    page.assume("nacelle: weight, place behind the tower's axis", "80, 0.8", "t, m", "assumed")
    page.assume("hub: before the tower's axis, above its top", "3.5, 2", "m", "assumed")


def draw_torque(page: Page, time: Floats, motor: Floats) -> None:
    """Torque of the pitch motor, its largest value marked."""
    page.section("Torque of the pitch motor")
    largest = float(time[int(np.abs(motor).argmax())])
    torque = chart(
        TORQUE,
        [trace("pitch motor", time, motor)],
        "time [s]",
        "torque [N m]",
    )
    page.add(mark_events(torque, {"largest": largest}))


def answer(
    page: Page,
    channels: tuple[list[Record], list[Record]],
    mandatory: list[Record],
    thermal: float,
    motor: float,
) -> None:
    """State how many channels are given, and the torque of the pitch motor."""
    given, rows = channels
    page.answer(
        "Which quantities of PROTEST's pitch and yaw tables do simulations give?",
        f"Simulations give {len(given)} of the {len(rows)} channels that the tables ask for; the "
        f"pitch motor's torque, for example, peaks at {value_text(motor, 'N m')}.",
        [
            page.value("channels that are given", len(given), beside=len(rows), by="asked for"),
            page.value(
                "mandatory channels of Table 6.4 that are given",
                sum(bool(row["given"]) for row in mandatory),
                at_least=len(mandatory),
                by="PROTEST",
            ),
            page.value("root mean square torque of the pitch motor [N m]", thermal),
            page.value("peak torque of the pitch motor [N m]", motor),
            page.judged(
                "tower top: mean axial force",
                "mean axial force at the tower's top",
                "hub and weight",
            ),
        ],
        hero=TORQUE,
        cautions=[
            "Torsion at the blade root comes from bent blades alone: the aerofoils' pitching "
            "moments are left out."
        ],
    )


def show_tables(page: Page, tables: dict[str, list[Record]]) -> None:
    """What each table asks for, and what is given."""
    for name, rows in tables.items():
        page.section(f"Table {name}")
        shown: list[Record] = [
            {key: value for key, value in row.items() if key not in ("levels", "seconds", "table")}
            | {"given": "yes" if row["given"] else "no"}
            for row in rows
        ]
        page.table("Channels that the table asks for; durations are in tables.json", shown)


def check_durations(page: Page, given: list[Record], duration: float) -> None:
    """Every sample is at one level."""
    seconds = [sum(row["seconds"]) for row in given if row["seconds"]]
    page.equals(
        "load durations: shortest and longest sum [s]",
        min(seconds) + max(seconds),
        2.0 * duration,
        within=1e-9,
        why="every sample is at one level",
        source="duration of the simulation",
        measure="identity",
    )


def pitch_channels(one: Pitched) -> tuple[dict[str, Floats], float]:
    """Loads of the bearing, motion and torques of the pitch drive, and its largest torque."""
    load, resists, motor = one.about_axis(), one.friction(), one.motor()
    ring = ring_torque(PITCH, load, resists, one.speed, one.acceleration)
    found = {
        **{name: one.loads[:, k] for k, name in enumerate(ROOT_LOADS)},
        "pitch angle": one.pitch,
        "pitch speed": one.speed,
        "pinion torque": ring / PINION,
        "motor torque": motor,
        "motor speed": PITCH.ratio * one.speed,
        "angle of pinion against ring": (PINION - 1.0) * one.pitch,
        "reaction of the transmission": -ring / PINION,
    }
    return found, float(np.abs(motor).max())


def yaw_channels(loads: Floats, step: float) -> dict[str, Floats]:
    """Loads at the tower's top from those of the hub, and a steady motion of the nacelle."""
    moved = loads @ wrench_transport(np.array([-OVERHANG, 0.0, HEIGHT])).T
    weight, behind = NACELLE
    time = np.arange(len(loads)) * step
    rate = np.radians(5.0) / 12.0
    bending = np.hypot(moved[:, 3], moved[:, 4] + weight * behind)
    resists = friction_torque(
        bending, moved[:, 2] - weight, np.hypot(moved[:, 0], moved[:, 1]), 2.2
    )
    speed = np.full(len(loads), rate)
    torque = drive_torque(YAW, -moved[:, 5], resists, speed, 0.0 * speed)
    return {
        "tower top shear force x": moved[:, 0],
        "tower top shear force y": moved[:, 1],
        "tower top axial force": moved[:, 2] - weight,
        "tower top bending x": moved[:, 3],
        "tower top bending y": moved[:, 4] + weight * behind,
        "tower top torsion": moved[:, 5],
        "yaw angle": rate * time,
        "yaw speed": speed,
        "yaw command": rate * time,
        "yaw gear torque": torque,
        "yaw power": np.asarray(YAW.ratio * torque * rate),
    }
