"""Two masses on a shaft: loss of the generator, a brake, a step of torque, against exact motion."""

from functools import partial

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.drivetrains import Rated, own_or_published
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import (
    AVERAGE,
    Brake,
    Motion,
    Phase,
    Scheme,
    State,
    equations_of_motion,
    generalised_alpha,
    integrate,
    spring_laws,
    steady,
    transient,
    wind_up,
)
from fe_drivetrain.dynamics.torsion import natural_modes, two_masses
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time

PER_PERIOD = (20, 40, 80, 160)
QUICK = (20, 40)
BRAKED = "Drivetrain {} as two masses, stopped by a brake of 1.2 times rated torque"
BRAKE = 1.2
"""Friction of the brake over rated torque."""


@case(
    "Exact transients of two masses: loss of the generator, brake and stick, torque step",
    source="Al-Hamadani 2018, Tables 4.2 and 4.3, as two masses; closed forms",
    settings={"drivetrain": "FILE, or a name of the library (otherwise A to D of the thesis)"},
)
def run(run: Run, page: Page) -> None:
    """Four drivetrains, two schemes, ever shorter steps."""
    rows: list[Record] = []
    trains = own_or_published(run, page)
    for one in trains:
        with run.step(f"drivetrain {one.letter}"):
            system = two_masses(one.table, "free")
            J, k = system.J, float(system.k[0])
            rows += [
                transients(page, one.letter, J, k, one.torque, n, scheme)
                for n in (QUICK if run.quick else PER_PERIOD)
                for scheme in (AVERAGE, generalised_alpha(0.8))
            ]
    last = rows[-1]["steps a period"]
    finest = [row for row in rows if row["steps a period"] == last]
    page.section("Error over the step")
    page.table("Two masses", rows)
    page.data("transients", rows)
    show(page, trains[-1])
    answer(page, trains[-1], finest)


def answer(page: Page, last: Rated, finest: list[Record]) -> None:
    """State how exact torques are with the shortest steps, and what the brake does."""
    key = "error of the torque, loss [%]"
    by = {
        method: max(row[key] for row in finest if row["method"] == method)
        for method in dict.fromkeys(str(row["method"]) for row in finest)
    }
    others = [
        f"{percent_text(worst / 100.0)} by {method}"
        for method, worst in by.items()
        if method != AVERAGE.name
    ]
    wound = page.judged(
        f"drivetrain {last.letter}, brake of 1.2 rated: largest torque of the shaft over rated",
        "largest torque of the braked shaft, over rated",
        "twice the mean",
    )
    page.answer(
        "How accurate are torques of two masses on a shaft after generator loss or braking?",
        f"With {finest[0]['steps a period']} steps a period shaft torques err by at most "
        f"{value_text(by[AVERAGE.name], '%')} of rated torque; braking winds the shaft up to "
        f"{wound.value:.2f} times rated torque.",
        [
            *(
                page.value(
                    f"largest error after loss of the generator, drivetrain {row['drivetrain']} "
                    "[% of rated]",
                    row[key],
                )
                for row in finest
                if row["method"] == AVERAGE.name
            ),
            wound,
            page.judged(
                f"drivetrain {last.letter}, disc held: frequency of the rotor",
                "frequency of the rotor, disc held",
                "closed form",
            ),
        ],
        BRAKED.format(last.letter),
        [
            f"Errors are the largest over three periods by {AVERAGE.name}"
            + (f"; they are {', '.join(others)}." if others else ".")
        ],
    )
    page.say(
        "The brake step winds the shaft up to twice its mean, and where the disc stands it holds "
        "what the shaft carries and no more than its friction.",
    )


def transients(
    page: Page, letter: str, J: Floats, k: float, torque: float, steps: int, scheme: Scheme
) -> Record:
    """One drivetrain: errors of torque over rated, and its checks with the finest steps."""
    omega = float(np.sqrt(k * (1.0 / J[0] + 1.0 / J[1])))
    period = 2.0 * np.pi / omega
    dt = period / steps
    shaft = equations_of_motion(J, spring_laws([[1.0, -1.0]], k))
    begin = wind_up(shaft, [torque, -torque])
    zero = np.zeros(2)
    loss = integrate(
        shaft, steady([torque, 0.0]), 3 * period, dt, scheme, State(begin.q, zero, zero)
    )
    mean = J[1] / J.sum()
    exact = torque * (mean + (1.0 - mean) * np.cos(omega * loss.times))
    wound = integrate(shaft, steady([0.0, -torque]), period, dt, scheme)
    share = J[0] / J.sum()
    row: Record = {
        "drivetrain": letter,
        "method": scheme.name,
        "steps a period": steps,
        "frequency [Hz]": 1.0 / period,
        "least torque after loss, over rated": float(loss.forces.min() / torque),
        "closed form": float((J[1] - J[0]) / J.sum()),
        "error of the torque, loss [%]": 100.0
        * float(np.abs(loss.forces[:, 0] - exact).max() / torque),
        "peak by the brake over its mean": float(wound.forces.max() / (share * torque)),
        "energy from nowhere over the largest": max(
            loss.relative_imbalance, wound.relative_imbalance
        ),
        "momentum, relative error": float(
            np.abs(loss.velocity @ J - torque * loss.times).max() / (torque * loss.times[-1])
        ),
    }
    if scheme is AVERAGE:
        late = 2.0 * np.pi * 3.0 * (omega * dt) ** 2 / 12.0
        page.vanishes(
            f"drivetrain {letter}, {steps} steps a period: error of torque after loss, over rated",
            row["error of the torque, loss [%]"] / 100.0,
            within=1.1 * (1.0 - mean) * late,
            why="phase lost in three periods by a period that is (w dt)^2 / 12 too long",
            source="T (J2 + J1 cos w t) / (J1 + J2)",
        )
        page.vanishes(
            f"drivetrain {letter}, {steps} steps a period: energy from nowhere over the largest",
            row["energy from nowhere over the largest"],
            within=1e-9,
            why="average acceleration conserves the energy of a linear system, to round-off",
            source="work of the torques is kinetic and strain energy",
        )
        page.vanishes(
            f"drivetrain {letter}, {steps} steps a period: momentum about the free axis",
            row["momentum, relative error"],
            within=1e-9,
            why="round-off, of angles that grow to many times their winding",
            source="T t",
        )
    return row


def braked(one: Rated, dt: float) -> Motion:
    """A drivetrain with a brake that slips, sticks and lets go."""
    system = two_masses(one.table, "free")
    J, k = system.J, float(system.k[0])
    shaft = equations_of_motion(J, spring_laws([[1.0, -1.0]], k))
    disc = np.array([0.0, 1.0])
    brake = Brake(disc, BRAKE * one.torque, 0.5)
    speed = np.full(2, one.speed)
    zero = np.zeros(2)
    return transient([Phase(16.0, shaft, [brake])], dt, State(zero, speed, zero))


def of_brake(one: Rated, dt: float, _: int) -> InTime:
    """Torques over rated, and when the disc stops."""
    found, rated = braked(one, dt), one.torque
    shaft = found.forces[:, 0] / rated
    stops = found.braking.events[0][0]
    values = {
        "largest torque of the shaft over rated": peak_between(shaft[found.times < stops]),
        "least torque of the shaft over rated": -peak_between(-shaft),
        "disc stops after [s]": stops,
    }
    return InTime(values, found.relative_imbalance)


def show(page: Page, one: Rated) -> None:
    """Checks and charts of the brake."""
    system = two_masses(one.table, "free")
    J, k = system.J, float(system.k[0])
    step = min(2e-3, 1 / (190 * float(natural_modes(system).frequencies[1])))
    series = converge_in_time(partial(of_brake, one), step)
    page.section("A brake that slips, sticks and lets go")
    check_in_time(
        page,
        f"drivetrain {one.letter}, brake of 1.2 rated",
        series,
        dict.fromkeys(series.finest.values, 1e-2),
        energy=1e-9,
        why="average acceleration conserves the energy of a linear system, and events end steps",
    )
    motion = braked(one, step)
    check_brake(page, motion, J, k, one)
    first, what = motion.braking.events[0]
    drawn = chart(
        BRAKED.format(one.letter),
        [
            trace("shaft", motion.times, motion.forces[:, 0] / one.torque),
            trace("brake", motion.times, motion.braking.torque[:, 0] / one.torque),
            trace(
                "generator's speed over its first", motion.times, motion.velocity[:, 1] / one.speed
            ),
        ],
        "time [s]",
        "torque over rated; speed",
    )
    page.add(mark_events(drawn, {f"disc {what}": first}))


def check_brake(page: Page, motion: Motion, J: Floats, k: float, one: Rated) -> None:
    """Check torques while the brake slips and holds, and the frequency at standstill."""
    torque, held = motion.braking.torque[:, 0], motion.braking.held[:, 0]
    slipping = (motion.times > 0.5) & (motion.times < motion.braking.events[0][0])
    page.equals(
        f"drivetrain {one.letter}, brake of 1.2 rated: largest torque of the shaft over rated",
        float(motion.forces[slipping].max() / one.torque),
        2.0 * BRAKE * J[0] / J.sum(),
        within=1e-3,
        why="a highest point between two steps",
        source="twice the mean T_b J1 / (J1 + J2)",
    )
    page.vanishes(
        f"drivetrain {one.letter}: torque of the brake that holds less the shaft's, over rated",
        float(np.abs(torque + motion.forces[:, 0])[held].max() / one.torque),
        within=1e-7,
        why="round-off of a step in which the disc stops",
        source="equilibrium of a disc that stands",
    )
    page.at_most(
        f"drivetrain {one.letter}: largest torque of the brake over its friction",
        float(np.abs(torque).max() / (BRAKE * one.torque)),
        1.0 + 1e-7,
        why="the instant of slipping is found to a billionth of a step",
        source="dry friction",
        measure="identity",
    )
    held = np.sqrt(k / J[0]) / (2.0 * np.pi)
    after = motion.times > motion.braking.events[-1][0]
    turned = motion.times[after][1:][np.diff(np.sign(motion.velocity[after, 0])) != 0]
    page.equals(
        f"drivetrain {one.letter}, disc held: frequency of the rotor [Hz]",
        float(0.5 / np.diff(turned).mean()),
        float(held),
        within=1e-3,
        why="crossings are found to a step",
        source="sqrt(k / J1) / 2 pi",
    )
