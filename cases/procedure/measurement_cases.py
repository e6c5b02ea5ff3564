"""A campaign by hand: every measurement case as a script, run, measured, and what each tells."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.known_drivetrain import FRONT, GAUGE, MEAN, REAR, SYSTEM
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import energy_error, torsional_equations, varying
from fe_drivetrain.dynamics.torsion import damped_modes
from fe_drivetrain.procedure import (
    MeasurementCase,
    Sensor,
    case_channels,
    logarithmic_decrement,
    measured,
    protest_measurement_cases,
    sampling_rates,
)
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time

STEP = 0.005  # s
FREE = {"STB": (11.05, 13.95), "STD": (12.2, 13.95)}  # s, from the loss of torque to the braking
SHOWN = ("NTA", "STB", "STD")
TORQUE = "Torque of the shaft, high-speed side, while torque is lost and brakes act"
CLEAN, NOISY = "by the twist", "by the twist with noise of 0.1 mrad, three peaks"


@case(
    "A campaign by hand: eleven measurement cases, run and measured",
    source="PROTEST 2010, ECN-E--10-100, section 4.6.2.5, Table 4.9",
)
def run(run: Run, page: Page) -> None:
    """Run each script on a known drivetrain, measure it, and identify damping from the stops."""
    cases = protest_measurement_cases()
    mode = damped_modes(SYSTEM)
    with run.step("cases"):
        found = {of.code: case_channels(of, SYSTEM, MEAN, STEP) for of in cases.cases}
    with run.step("over the step"):
        check_steps(page, cases.cases)
    rows = []
    for of in cases.cases:
        rows.append(torques_of(of, found[of.code]))
        momentum(page, of, found[of.code])
    page.section("Cases")
    page.table("Each case by its script; torque of the shaft, and as a strain gauge has it", rows)
    torque = chart(
        TORQUE,
        [
            trace(
                f"{code}, {cases.of(code).title}",
                found[code]["time"][::4],
                found[code]["shaft torque"][::4],
            )
            for code in SHOWN
        ],
        "time [s]",
        "torque [N m]",
    )
    events = {f"{code}: torque is lost": first for code, (first, _) in FREE.items()}
    page.add(mark_events(torque, events | {"braking": FREE["STB"][1]}))
    page.data("cases", rows)
    damping = stops(page, found, float(mode.ratios[0]))
    least, good = sampling_rates(float(mode.frequencies[0]))
    page.text(
        f"The drivetrain's mode at {float(mode.frequencies[0]):.2f} Hz asks for {least:.1f} to "
        f"{good:.1f} samples a second, and is recorded with {1.0 / STEP:g}. A user's own scripts "
        "are read likewise (read_measurement_cases)."
    )
    answer(page, rows, damping)
    page.assume("rated torque, high-speed side", MEAN, "N m", "the report prints none")


def answer(page: Page, rows: list[Record], damping: list[Record]) -> None:
    """State which case loads and reverses the shaft most, and the damping that stops give."""
    largest = max(rows, key=lambda row: float(row["largest [N m]"]))
    reversed_by = min(rows, key=lambda row: float(row["shaft torque, least [N m]"]))
    most, least = float(largest["largest [N m]"]), float(reversed_by["shaft torque, least [N m]"])
    turned = "reversed" if largest is reversed_by else f"{reversed_by['case']} reverses it"
    page.answer(
        "Which measurement case loads the shaft most, and what do stops tell of damping?",
        f"{str(largest['what']).capitalize()} loads the shaft most: {most / MEAN:.2f} times rated "
        f"torque, {turned} to {formatted(least / MEAN, 2)} times.",
        [
            page.value("largest torque of the shaft [N m]", most, beside=MEAN, by="rated"),
            page.value("least torque of the shaft [N m]", least, beside=MEAN, by="rated"),
            *(
                page.value(
                    f"damping ratio after {row['case']}, {name} [%]",
                    100.0 * float(row[key]),
                    beside=100.0 * float(row["true"]),
                    by="truth",
                )
                for row in damping
                for name, key in (("exact twist", CLEAN), ("noise of 0.1 mrad", NOISY))
            ),
        ],
        hero=TORQUE,
        cautions=[
            "Times, speeds and torques of the scripts are assumed: the report has codes and words."
        ],
    )


def check_steps(page: Page, cases: Sequence[MeasurementCase]) -> None:
    """Energy and convergence of all scripts."""
    page.section("In time")
    series = converge_in_time(lambda dt, _: extremes_of_torque(cases, dt), STEP)
    check_in_time(
        page,
        "scripts",
        series,
        dict.fromkeys(series.finest.values, 0.05),
        energy=1e-2,
        why="integrals over the corners of the scripts, which samples round off",
        scale=dict.fromkeys(series.finest.values, MEAN),
    )


def torques_of(of: MeasurementCase, channels: dict[str, Floats]) -> Record:
    """Ends of the shaft's torque in one case, and as a strain gauge has it."""
    torque = measured(GAUGE, channels["shaft torque"], 1)
    return {
        "case": of.code,
        "what": of.title,
        "duration [s]": of.seconds,
        "generator, last [rpm]": float(channels["generator speed"][-1]) * 30.0 / np.pi,
        "shaft torque, least [N m]": float(channels["shaft torque"].min()),
        "largest [N m]": float(channels["shaft torque"].max()),
        "measured: least [N m]": float(torque.min()),
        "measured: largest [N m]": float(torque.max()),
    }


def extremes_of_torque(cases: Sequence[MeasurementCase], step: float) -> InTime:
    """Ends of the shaft's torque in each case, and the worst error of the energy."""
    values, lost = {}, 0.0
    equations = torsional_equations(SYSTEM)
    for of in cases:
        found = case_channels(of, SYSTEM, MEAN, step)
        torque, time = found["shaft torque"], found["time"]
        values[f"{of.code}: largest torque of the shaft [N m]"] = peak_between(torque)
        values[f"{of.code}: least torque of the shaft [N m]"] = -peak_between(-torque)
        acting = np.stack([found["rotor torque"], -found["generator torque"]], axis=1)
        angle = np.stack([found["twist"], np.zeros(len(time))], axis=1)
        speed = np.stack([found["rotor speed"], found["generator speed"]], axis=1)
        loads = varying(np.eye(2), time, acting)
        lost = max(lost, energy_error(equations, loads, time, angle, speed))
    return InTime(values, lost)


def momentum(page: Page, of: MeasurementCase, channels: dict[str, Floats]) -> None:
    """The speed of all inertias together is that of the script."""
    both = FRONT * channels["rotor speed"] + REAR * channels["generator speed"]
    together = both / (FRONT + REAR)
    script = of.speed(channels["time"])
    page.vanishes(
        f"{of.code}: mean speed of both inertias and speed of the script, largest difference "
        "[rad/s]",
        float(np.abs(together - script).max()),
        within=float(np.abs(np.diff(script)).max()) + 1e-9,
        why="one sample's change of the script's speed, at its corners",
        source="angular momentum",
        basis="self-consistency",
    )


def stops(page: Page, found: dict[str, dict[str, Floats]], ratio: float) -> list[Record]:
    """Damping from the decay of the twist after the torque is lost, true and measured."""
    rows: list[Record] = []
    for code, (first, last) in FREE.items():
        channels = found[code]
        part = (channels["time"] > first) & (channels["time"] < last)
        exact = logarithmic_decrement(channels["twist"][part], STEP, 6)
        noisy = measured(Sensor(noise=1e-4), channels["twist"][part], 3)
        twist = logarithmic_decrement(noisy, STEP, 3)
        page.equals(
            f"{code}: damping ratio from the decay of the twist",
            exact.ratio,
            ratio,
            within=0.01,
            why="peaks at parabolas through samples of 5 ms, which are a 79th of a period",
            source="eigenvalues of the drivetrain",
            measure="frequency",
            basis="self-consistency",
        )
        rows.append(
            {
                "case": code,
                "true": ratio,
                CLEAN: exact.ratio,
                NOISY: twist.ratio,
            }
        )
    page.section("Stops")
    page.table("Damping ratio by the logarithmic decrement after the loss of torque", rows)
    return rows
