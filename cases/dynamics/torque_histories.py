"""Drivetrains on torque histories of normal operation: speed, power, spectra, cycles of meshes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.drivetrains import Rated, first_held, own_or_published
from fe_drivetrain.cases.dynamics.mesh_spectra import spectrum_of
from fe_drivetrain.cases.dynamics.torque_digests import (
    DOMINANT,
    ERROR,
    HIGH_MEAN,
    HIGH_SWING,
    LEAST,
    LOW_MEAN,
    LOW_SWING,
    MESH,
    POWER,
    POWER_SWING,
    SPECTRUM_STEP,
    SWING_RATIO,
    TORQUE,
    WINDS,
    ByWind,
    Cycled,
    Operated,
    Spread,
    by_wind,
    digest,
    in_operation,
    in_stop,
    operated,
    stops_by_guess,
)
from fe_drivetrain.cases.dynamics.torque_runs import (
    HOLD,
    SECONDS,
    SETTLED,
    SHEAR,
    TURBULENCE,
    WIND,
    Driven,
    Generator,
    air_on,
    driven,
    exact,
    measured,
)
from fe_drivetrain.cases.dynamics.torque_words import (
    Chapter,
    answer,
    own_answer,
    show_verdicts,
)
from fe_drivetrain.comparison import InTime, converge_in_time
from fe_drivetrain.report import Chart, chart, mark_events, trace
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time
from fe_drivetrain.report.suite.chosen import SETTING

TOPIC = "Normal operation on torque histories: speed, power, spectra, cycles of mesh forces"
SPRING = Generator("spring to the grid", stiffness=28_100.0)
"""Generator of drivetrain D, after Mandic et al. 2012 (section 4.1)."""
PRINTED_SLIP = Generator("slip of 0.5 %", 0.005)
"""1809 rpm over the 1800 rpm of four poles at 60 Hz (Table 4.6)."""
LINES = (PRINTED_SLIP, Generator("slip of 1 %", 0.01), Generator("slip of 2 %", 0.02))
USUAL = LINES[1].name
STOP_STEP, QUICK_STOP_STEP = 1.25e-4, 5e-4
SPECTRA = "Drivetrain {}: spectrum of the high-speed shaft's torque, by how the generator is held"
CYCLES = "Drivetrain {}: range and mean of cycles of the mesh force over that at rated torque"


@case(
    "Chapter 6 on torque histories: speed, power, spectra, cycles of mesh forces",
    source="Al-Hamadani 2018, chapter 6, Figures 6.2, 6.10, 6.12, 6.15 and 6.16",
    settings={"drivetrain": "FILE, or a name of the library (otherwise A to D of the thesis)"},
)
def run(run: Run, page: Page) -> None:
    """Put the torque of a gauge on the rotor, and read what the thesis reads."""
    trains = own_or_published(run, page, TOPIC, gears=True)
    dt, seeds = (5e-3, (1, 2)) if run.quick else (1.25e-3, (1, 2, 3, 4, 5, 6))
    stop_step = QUICK_STOP_STEP if run.quick else STOP_STEP
    if SETTING in run.settings:
        of_own(run, page, trains[0], seeds, dt, stop_step)
        return
    by_letter = {one.letter: one for one in trains}
    with run.step("drivetrain D"):
        d = operated(by_letter["D"], [SPRING, *LINES], seeds, dt, PRINTED_SLIP)
    with run.step("drivetrains A to C"):
        c = operated(by_letter["C"], LINES, seeds, dt)
        others = [operated(by_letter[k], LINES[1:2], seeds, dt, gauge=c.gauge) for k in "AB"]
    with run.step("convergence"):
        page.section("In time")
        check_steps(page, by_letter["D"], [SPRING, PRINTED_SLIP], 0.5 * dt, PRINTED_SLIP)
        check_steps(page, by_letter["C"], [LINES[1]], dt)
        check_exact(page, by_letter["D"], dt)
    with run.step("winds"):
        lines = LINES[1], PRINTED_SLIP
        winds = by_wind(by_letter["C"], by_letter["D"], lines, dt, 2 if run.quick else len(WINDS))
    with run.step("shutdowns"):
        stops = {k: in_stop(by_letter[k], stop_step) for k in "AB"}
        guesses = stops_by_guess(by_letter["C"], stop_step)
        stops["C"] = next(iter(guesses.values()))
    found = Chapter(d, c, others, stops, guesses, winds, SPRING.name, PRINTED_SLIP.name, USUAL)
    answer(page, found, SPECTRA.format("D"))
    assume(page, trains[0].per_minute)
    show(page, d)
    show(page, c)
    show_cycles(page, c, stops["C"], guesses)
    show_winds(page, winds)
    show_verdicts(page, found)


def of_own(
    run: Run, page: Page, one: Rated, seeds: Sequence[int], dt: float, stop_step: float
) -> None:
    """Normal operation of a user's drivetrain, and its shutdown beside it."""
    with run.step("normal operation"):
        found = operated(one, LINES, seeds, dt)
    with run.step("convergence"):
        page.section("In time")
        check_steps(page, one, [LINES[1]], dt)
        check_exact(page, one, dt)
    with run.step("shutdown"):
        guesses = stops_by_guess(one, stop_step)
    stop = next(iter(guesses.values()))
    own_answer(page, found, stop, CYCLES.format(one.letter))
    assume(page, one.per_minute)
    show(page, found)
    show_cycles(page, found, stop, guesses)


def assume(page: Page, per_minute: float) -> None:
    """State what no source gives."""
    page.assume(
        "wind",
        f"{WIND:g} m/s, {TURBULENCE} turbulence, shear exponent {SHEAR:g}",
        "",
        "measured torque is not public; 16 m/s is that of section 7.3",
    )
    page.assume("turbine", "similar to the generic one of 2 MW, area as power", "", "not described")
    page.assume(
        "generator of the turbine itself",
        f"torque as its controller asks, held to its speed in {HOLD:g} s; of D a slip of 0.5 %",
        "",
        "its controls are not printed",
    )
    page.assume("history", SECONDS - SETTLED, "s", f"after {SETTLED:g} s; the thesis has 20 and 90")


def check_steps(
    page: Page,
    one: Rated,
    generators: Sequence[Generator],
    dt: float,
    turbine: Generator | None = None,
) -> None:
    """Energy and convergence of what is read from a run."""
    keys = (TORQUE, LOW_SWING, HIGH_SWING, POWER_SWING, MESH)
    air = air_on(one, 1)

    def run(step: float, _: int) -> InTime:
        true = measured(one, air, step, turbine)
        values: dict[str, float] = {}
        lost = true.motion.relative_imbalance
        for held in generators:
            found = driven(one, true.motion.times, true.torque(one.slow), held, step)
            read = digest(found)
            values |= {f"{held.name}, {key}": read[key] for key in keys}
            lost = max(lost, found.motion.relative_imbalance)
        return InTime(values, lost)

    series = converge_in_time(run, dt)
    check_in_time(
        page,
        f"drivetrain {one.letter}",
        series,
        dict.fromkeys(series.finest.values, 0.02),
        energy=1e-6,
        why="average acceleration conserves the energy of a linear system, to round-off of modes "
        "of some kHz",
    )


def check_exact(page: Page, one: Rated, dt: float) -> None:
    """A run against the matrix exponential of the same masses."""
    air = air_on(one, 1)
    found, coarse = (driven(one, air.times, air.torque, PRINTED_SLIP, h) for h in (dt, 2.0 * dt))
    fine, rough = (
        np.interp(air.times, each.motion.times, each.torque(one.fast)) for each in (found, coarse)
    )
    page.vanishes(
        f"drivetrain {one.letter}: torque of the fast shaft in time less the exact one, over rated",
        float(np.abs(fine - exact(found, air.times, air.torque, one.fast)).max()),
        within=float(np.abs(fine - rough).max()),
        why="twice the step moves the torque by three times the error of a method of second order",
        source="matrix exponential of the state, exact for a load of straight lines",
    )


def row_of(name: str, found: Mapping[str, Spread]) -> Record:
    """Digest of runs over seeds as a row of a table."""
    row: Record = {"generator": name}
    for key in (LOW_MEAN, LOW_SWING, HIGH_MEAN, HIGH_SWING, POWER, POWER_SWING, TORQUE, DOMINANT):
        row[key] = found[key].mean
    torque = found[TORQUE]
    row["torque, by seed"] = f"{torque.least:.3g} to {torque.largest:.3g}"
    row["generator's swing over the rotor's"] = found[HIGH_SWING].mean / found[LOW_SWING].mean
    return row


def show(page: Page, of: Operated) -> None:
    """Speeds, power and spectra of a drivetrain, by how its generator is held."""
    letter = of.one.letter
    page.section(f"Drivetrain {letter}: speed, power and torque in operation")
    rows = [row_of("turbine itself, driven by the air", of.spread(""))]
    rows += [row_of(name, of.spread(name)) for name in of.runs]
    page.table(
        "Mean of all seeds; below the first row the torque of the low-speed shaft is put on the "
        "rotor, as in the thesis",
        rows,
    )
    page.data(f"operation of {letter}", rows)
    page.table(
        "The high-speed shaft's torque beside that of the turbine whose torque was taken",
        [
            {
                "generator": name,
                SWING_RATIO: (found := of.errors(name))[SWING_RATIO].mean,
                "by seed": f"{found[SWING_RATIO].least:.2f} to {found[SWING_RATIO].largest:.2f}",
                ERROR: found[ERROR].mean,
            }
            for name in of.runs
        ],
    )
    page.text(
        "The torque of a shaft has the resonance of the drivetrain in it already; on the rotor of "
        "a model it meets the same resonance again. What belongs on the rotor is the torque of "
        "the shaft and what speeds the rotor up, J w', by which the first row comes back."
    )
    page.add(spectra(of))
    page.chart(
        f"Drivetrain {letter}: torque of the high-speed shaft over rated",
        [
            history("turbine itself", of.gauge[0]),
            *(history(name, runs[0]) for name, runs in of.runs.items()),
        ],
        "time [s]",
        "torque over rated",
    )


def history(name: str, run: Driven) -> object:
    """Torque of the fast shaft, as a curve."""
    every = max(1, len(run.motion.times[run.late]) // 1800)
    times = run.motion.times[run.late][::every]
    return trace(name, times, run.torque(run.one.fast)[run.late][::every])


def spectra(of: Operated) -> Chart:
    """Spectra of the fast shaft's torque of the first seed."""
    turn = of.one.per_minute / 60.0
    curves = []
    shown = {"turbine itself": of.gauge[0], **{name: runs[0] for name, runs in of.runs.items()}}
    for name, run in shown.items():
        late, dt = run.late, float(run.motion.times[1] - run.motion.times[0])
        every = max(1, round(SPECTRUM_STEP / dt))
        values = run.torque(of.one.fast)[late][::every]
        found = spectrum_of(values, every * dt)
        near = (found.frequencies > 0.2) & (found.frequencies < 3.0)
        # of Hann's window, whose mean is a half
        size = 4.0 * found.size[near] / len(values)
        curves.append(trace(name, found.frequencies[near][::4], np.maximum(size[::4], 1e-4)))
    drawn = chart(
        SPECTRA.format(of.one.letter),
        curves,
        "frequency [Hz]",
        "amplitude over rated torque",
        ("y",),
    )
    lines = {
        "3P": 3.0 * turn,
        "generator held": first_held(of.one),
    }
    return mark_events(drawn, lines)


def show_cycles(page: Page, of: Operated, stop: Cycled, guesses: Mapping[str, Cycled]) -> None:
    """Mesh forces in operation and in a shutdown: history, cycles, guesses."""
    letter = of.one.letter
    run = of.runs[USUAL][0]
    normal = in_operation(run)
    page.section(f"Drivetrain {letter}: mesh force in operation and in a shutdown")
    page.chart(
        f"Drivetrain {letter}: {run.mesh}, force over that at rated torque",
        [normal.curve("normal operation"), stop.curve("shutdown")],
        "time [s]",
        "force over that at rated torque",
    )
    page.chart(
        CYCLES.format(letter),
        [
            trace(name, one.cycles.ranges, one.cycles.means, points=True)
            for name, one in (("normal operation", normal), ("shutdown", stop))
        ],
        "range over rated",
        "mean over rated",
    )
    found = of.spread(USUAL)
    page.table(
        "Normal operation, the generator on a line of 1 %",
        [
            {
                "range in 20 s": found[MESH].mean,
                "by seed": f"{found[MESH].least:.3f} to {found[MESH].largest:.3f}",
                "least force": found[LEAST].least,
            }
        ],
    )
    page.table(
        "Shutdown, by what is not printed",
        [
            {
                "guess": name,
                "largest range": one.range,
                "over that in operation": one.range / found[MESH].mean,
                "least force": float(one.force.min()),
                "least mean of a cycle": one.least_mean(),
            }
            for name, one in guesses.items()
        ],
    )


def show_winds(page: Page, winds: Mapping[str, ByWind]) -> None:
    """What other winds do, and what the turbine's generator does."""
    page.table(
        "By wind, the first seed: range of C's low-speed shaft in 20 s over rated, which is 0.24 "
        "(250 kN m) in the thesis, and D's swing over the true one",
        [
            {
                "wind": name,
                "generator of C behind a converter": one.converter,
                "on the grid, slip of 1 %": one.direct,
                "swing of D over the true one, slip of 0.5 %": one.twice,
            }
            for name, one in winds.items()
        ],
    )
