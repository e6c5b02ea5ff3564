"""A campaign by hand: every measurement case as a script, run, measured, and what each tells."""

import re
from collections.abc import Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.known_drivetrain import KNOWN, STEP, Known, known_of
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
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time
from fe_drivetrain.report.suite.chosen import SETTING

FREE = {"STB": (11.05, 13.95), "STD": (12.2, 13.95)}  # s, from the loss of torque to the braking
SHOWN = ("NTA", "STB", "STD")
TORQUE = "Torque of the shaft, high-speed side, while torque is lost and brakes act"
CLEAN, NOISY = "by the twist", "by the twist with noise, three peaks"
NOISE = 1e-4 * KNOWN.stiffness / KNOWN.torque
"""Noise of the measured twist, over that under rated torque: 0.1 mrad of the case's own."""
RATED_SPEED = 1510 * np.pi / 30.0
"""Speed of the generator in the scripts [rad/s]."""


@case(
    "A campaign by hand: eleven measurement cases, run and measured",
    source="PROTEST 2010, ECN-E--10-100, section 4.6.2.5, Table 4.9",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise the case's own, of two inertias)"
    },
)
def run(run: Run, page: Page) -> None:
    """Run each script on a known drivetrain, measure it, and identify damping from the stops."""
    known, cases = KNOWN, protest_measurement_cases()
    if SETTING in run.settings:
        chosen = run.drivetrain("")
        chosen.state(page)
        known = known_of(page, chosen)
        cases = cases.model_copy(update={"cases": tuple(fitted(c, known) for c in cases.cases)})
    mode = damped_modes(known.system)
    step = min(1.0, known.slower) * STEP
    with run.step("cases"):
        found = {of.code: case_channels(of, known.system, known.torque, step) for of in cases.cases}
    with run.step("over the step"):
        check_steps(page, known, cases.cases, step)
    rows = []
    for of in cases.cases:
        rows.append(torques_of(known, of, found[of.code]))
        momentum(page, known, of, found[of.code])
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
    damping = stops(page, known, found, float(mode.ratios[0]))
    least, good = sampling_rates(float(mode.frequencies[0]))
    page.text(
        f"The drivetrain's mode at {float(mode.frequencies[0]):.2f} Hz asks for {least:.1f} to "
        f"{good:.1f} samples a second, and is recorded with {1.0 / step:.4g}. A user's own scripts "
        "are read likewise (read_measurement_cases)."
    )
    answer(page, known, rows, damping)
    if known is KNOWN:
        page.assume("rated torque, high-speed side", KNOWN.torque, "N m", "the report prints none")


def fitted(case: MeasurementCase, known: Known) -> MeasurementCase:
    """A script at the speeds of another drivetrain, without the speeds in its words."""
    share = known.speed / RATED_SPEED
    return case.model_copy(
        update={
            "title": re.sub(r" (at|from) [\d to]+rpm", "", case.title),
            "corners": tuple((time, share * rpm, torque) for time, rpm, torque in case.corners),
        }
    )


def answer(page: Page, known: Known, rows: list[Record], damping: list[Record]) -> None:
    """State which case loads and reverses the shaft most, and the damping that stops give."""
    rated = known.torque
    largest = max(rows, key=lambda row: float(row["largest [N m]"]))
    reversed_by = min(rows, key=lambda row: float(row["shaft torque, least [N m]"]))
    most, least = float(largest["largest [N m]"]), float(reversed_by["shaft torque, least [N m]"])
    off = max(
        abs(float(row[key]) / float(row["true"]) - 1.0) for row in damping for key in (CLEAN, NOISY)
    )
    page.answer(
        "Which measurement case loads the shaft most, and do stops give the damping?",
        f"{str(largest['what']).capitalize()} loads the shaft most, {most / rated:.2f} times "
        f"rated torque; stops give the damping within {percent_text(off)}.",
        [
            page.value("largest torque of the shaft [N m]", most, beside=rated, by="rated"),
            page.value("lowest torque of the shaft [N m]", least, beside=rated, by="rated"),
            *(
                page.value(
                    f"damping ratio after stop {row['case']}, {name} [%]",
                    100.0 * float(row[key]),
                    beside=100.0 * float(row["true"]),
                    by="truth",
                )
                for row in damping
                for name, key in (
                    ("exact twist", CLEAN),
                    (f"noise of {1e3 * noise_of(known):.2g} mrad", NOISY),
                )
            ),
        ],
        hero=TORQUE,
        cautions=[
            "Times, speeds and torques of the cases are assumed: the report only names them."
        ],
    )


def noise_of(known: Known) -> float:
    """Noise of the measured twist [rad]."""
    return NOISE * known.torque / known.stiffness


def check_steps(page: Page, known: Known, cases: Sequence[MeasurementCase], step: float) -> None:
    """Energy and convergence of all scripts."""
    page.section("In time")
    series = converge_in_time(lambda dt, _: extremes_of_torque(known, cases, dt), step)
    check_in_time(
        page,
        "scripts",
        series,
        dict.fromkeys(series.finest.values, 0.05),
        energy=1e-2,
        why="integrals over the corners of the scripts, which samples round off",
        scale=dict.fromkeys(series.finest.values, known.torque),
    )


def torques_of(known: Known, of: MeasurementCase, channels: dict[str, Floats]) -> Record:
    """Ends of the shaft's torque in one case, and as a strain gauge has it."""
    torque = measured(known.gauge, channels["shaft torque"], 1)
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


def extremes_of_torque(known: Known, cases: Sequence[MeasurementCase], step: float) -> InTime:
    """Ends of the shaft's torque in each case, and the worst error of the energy."""
    values, lost = {}, 0.0
    equations = torsional_equations(known.system)
    for of in cases:
        found = case_channels(of, known.system, known.torque, step)
        torque, time = found["shaft torque"], found["time"]
        values[f"{of.code}: largest torque of the shaft [N m]"] = peak_between(torque)
        values[f"{of.code}: least torque of the shaft [N m]"] = -peak_between(-torque)
        acting = np.stack([found["rotor torque"], -found["generator torque"]], axis=1)
        angle = np.stack([found["twist"], np.zeros(len(time))], axis=1)
        speed = np.stack([found["rotor speed"], found["generator speed"]], axis=1)
        loads = varying(np.eye(2), time, acting)
        lost = max(lost, energy_error(equations, loads, time, angle, speed))
    return InTime(values, lost)


def momentum(page: Page, known: Known, of: MeasurementCase, channels: dict[str, Floats]) -> None:
    """The speed of all inertias together is that of the script."""
    both = known.front * channels["rotor speed"] + known.rear * channels["generator speed"]
    together = both / (known.front + known.rear)
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


def stops(
    page: Page, known: Known, found: dict[str, dict[str, Floats]], ratio: float
) -> list[Record]:
    """Damping from the decay of the twist after the torque is lost, true and measured."""
    rows: list[Record] = []
    for code, (first, last) in FREE.items():
        channels = found[code]
        part = (channels["time"] > first) & (channels["time"] < last)
        step = float(channels["time"][1])
        exact = logarithmic_decrement(channels["twist"][part], step, 6)
        noisy = measured(Sensor(noise=noise_of(known)), channels["twist"][part], 3)
        twist = logarithmic_decrement(noisy, step, 3)
        page.equals(
            f"{code}: damping ratio from the decay of the twist",
            exact.ratio,
            ratio,
            within=0.01,
            why="peaks at parabolas through samples, which are at most a 79th of a period",
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
