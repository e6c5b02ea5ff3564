"""Four drivetrains that are stopped: blades pitched, generator off, disc brake, standstill."""

from math import isnan
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.drivetrains import RATIOS, Rated, own_or_published
from fe_drivetrain.cases.dynamics.shutdown_runs import (
    PEAK,
    SEQUENCE,
    Stopped,
    check_backlash,
    check_dips,
    check_peaks,
    peak_of,
    sequence,
    stop,
    stopped_by,
)
from fe_drivetrain.comparison import ConvergenceInTime, InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import StopSequence
from fe_drivetrain.dynamics.torsion import changed, natural_modes, two_masses
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

NORMAL = 0.237
"""Range of torque in normal operation over rated: 250 kN m of 1.055 MN m, measured (chapter 3)."""
LIMIT = 1.35  # of torque over rated, of the design loads
SHUTDOWN = "Drivetrain {}: torque over rated torque in the shutdown"
STEP, QUICK_STEP = 1.25e-4, 5e-4
LINES = 4
"""Periods of the first mode that a spectrum needs for a line of its own."""


@case(
    "Shutdown of drivetrains A to D: torque over rated torque, reversal, what rings",
    source="Al-Hamadani 2018, sections 4.5, 6.1.4 and 6.2.2-6.2.3, Tables 4.2 and 4.3",
    settings={"drivetrain": "FILE, or a name of the library (otherwise A to D of the thesis)"},
)
def run(run: Run, page: Page) -> None:
    """Stop each drivetrain with a brake that gives the printed peak; what follows from it."""
    dt = QUICK_STEP if run.quick else STEP
    trains = own_or_published(run, page, "Shutdown: torque over rated torque, reversal, what rings")
    stopped = []
    for one in trains:
        with run.step(f"drivetrain {one.letter}"):
            stopped.append(stop(one, dt))
    own = SETTING in run.settings
    if not own:
        with run.step("instants of the brake"):
            page.section("Instants of the brake")
            instants = check_instants(page, trains, run.quick)
    with run.step("loss of the generator"):
        losses = check_losses(page, trains, dt / 4.0)
    rows = [row_of(each) for each in stopped]
    swings = [check_frequencies(page, each) for each in stopped]
    with run.step("convergence of the shutdowns"):
        page.section("Shutdown")
        check_stops(page, stopped, dt)
    with run.step("dips of the grid"):
        page.section("A dip of the grid")
        dips = check_dips(page, trains, 5e-5 if run.quick else 2.5e-5)
    with run.step("backlash"):
        page.section("With backlash")
        knocks = check_backlash(page, stopped, run.quick)
    if own:
        own_answer(page, stopped[0], rows[0], losses[0], swings[0])
    else:
        answer(page, rows, instants[2], losses, swings)
        assume(page)
        show_shutdown(page, losses, rows, instants)
    for each in stopped:
        show(page, each)
    show_others(page, dips, knocks, swings)


def own_answer(page: Page, one: Stopped, row: Record, loss: Record, swing: Record) -> None:
    """State the torques of a user's drivetrain in a shutdown."""
    least = loss["all gears, HSS"]
    turns = "reverses it" if least < 0.0 else "does not reverse it"
    page.answer(
        "How high do torques go when the drivetrain is shut down, and do they reverse?",
        f"The fast shaft reaches {row['HSS, peak over rated']:.2f} times rated torque when the "
        f"brake holds; losing the generator {turns}: its lowest is {value_text(least)} of rated.",
        [
            page.value("peak over rated, fast shaft", row["HSS, peak over rated"]),
            page.value("peak over rated, main shaft", row["LSS, peak over rated"]),
            page.value(
                "lowest torque of the main shaft in the shutdown, over rated", row["LSS, least"]
            ),
            page.value("lowest torque after loss of the generator, over rated", least),
            page.value(
                "ringing with the brake on [Hz]",
                swing["spectrum [Hz]"],
                0.5 * swing["its resolution [Hz]"],
                beside=swing["first mode [Hz]"],
                by="first mode",
            ),
            page.value("brake over the generator's rated torque", one.brake),
        ],
        SHUTDOWN.format(one.of.letter),
    )
    page.assume("sequence", "generator off at 1 s, brake at 3 s", "", "of the case")
    page.assume("aerodynamic torque", "from rated to 0 in 2 s, evenly", "", "of the case")
    page.assume("generator", "slip of 1 % at rated torque", "", "of the case")
    page.assume("rise of the brake", one.of.rise, "s", "of the file, 0 where none is stated")
    if one.of.brake is None:
        words = "the file states no brake; the printed peak of drivetrain B of Al-Hamadani 2018"
        page.assume("brake", f"so large that the main shaft reaches {PEAK} of rated", "", words)
    page.section("Shutdown, in numbers")
    page.table("Torques over rated, a mass for each gear", [row])
    page.table("Least torque over rated after loss of the generator", [loss])


def answer(
    page: Page, rows: list[Record], by_instant: Record, losses: list[Record], swings: list[Record]
) -> None:
    """State peaks in a shutdown, where torque is reversed and what rings, beside the thesis."""
    fast = {row["drivetrain"]: row["HSS, peak over rated"] for row in rows}
    lowest = min(fast, key=lambda name: fast[name])
    turned = [str(row["drivetrain"]) for row in losses if row["reversed"]]
    holds = lowest == "C" and fast["C"] < LIMIT
    page.answer(
        "How high do torques go when drivetrains A to D are shut down, and where do they reverse?",
        f"C's high-speed shaft peaks at {fast['C']:.2f} times rated torque, "
        f"{'the lowest of all, as' if holds else 'not as'} the thesis states; generator loss "
        f"reverses torque in {', '.join(turned)}.",
        [
            page.value(
                "peak torque over rated, high-speed shaft of C", fast["C"], beside=1.32, by="thesis"
            ),
            page.value(
                "the same with the brake at its worst instant",
                by_instant["HSS, largest peak over rated"],
                at_most=LIMIT,
                by="design loads",
            ),
            page.value("lowest torque of C in the shutdown, over rated", rows[2]["LSS, least"]),
            page.value(
                "lowest torque of B after loss of the generator, over rated",
                losses[1]["all gears, HSS"],
            ),
            *(
                page.value(
                    f"ringing of {row['drivetrain']} with the brake on [Hz]",
                    row["spectrum [Hz]"],
                    0.5 * row["its resolution [Hz]"],
                    beside=row["printed [Hz]"],
                    by="thesis",
                )
                for row in swings[2:]
            ),
        ],
        SHUTDOWN.format("C"),
        [
            f"Brakes are sized so that the low-speed shaft reaches the printed {PEAK} of its rated "
            "torque; when they come is not printed.",
            "Ranges of torque are larger than the printed ones: nothing but the printed damping "
            "ratios lets the first mode decay.",
        ],
        claim="holds in part" if holds else "does not hold",
    )
    page.say(
        "In B, where the generator, seen from the rotor, is the heavier mass, loss of the "
        "generator's torque alone does not turn the torque round.",
    )


def assume(page: Page) -> None:
    """State the values that the thesis does not print."""
    page.assume("sequence", "generator off at 1 s, brake at 3 s", "", "not printed")
    page.assume("aerodynamic torque", "from rated to 0 in 2 s, evenly", "", "not printed")
    page.assume("brake", f"so large that LSS reaches {PEAK} of rated", "", "by trial in the thesis")
    page.assume("generator", "slip of 1 % at rated torque", "", "its controls are not printed")
    page.assume(
        "damping of A, B, C",
        f"{RATIOS[0]} of shafts, {RATIOS[1]} of meshes",
        "-",
        "section 4.1; D has the dampers of Table 4.2",
    )


def show_shutdown(
    page: Page, losses: list[Record], rows: list[Record], instants: list[Record]
) -> None:
    """Show losses of the generator and shutdowns in numbers."""
    page.section("Loss of the generator's torque, in numbers")
    page.table("Least torque over rated; below zero it is reversed", losses)
    page.section("Shutdown, in numbers")
    page.table("Torques over rated, a mass for each gear", rows)
    page.table("Printed, ours, verdict", verdicts(rows, instants))
    page.table(
        f"The same with brakes that come later by parts of the first swing, each sized for {PEAK} "
        "at the low-speed shaft",
        instants,
    )
    page.text(
        "The brake alone is sized, on the low-speed shaft; all else follows. Ranges are larger "
        "than the printed ones since nothing but the printed damping ratios lets the first mode "
        "decay: Eq 4.5 with the inertias next to a shaft leaves it less than a thousandth of "
        "critical damping, so that the swing of the generator's loss is still there when the "
        "brake comes."
    )


def show_others(page: Page, dips: list[Record], knocks: list[Record], swings: list[Record]) -> None:
    """Show dips, backlash and frequencies in numbers."""
    page.section("Dips of the grid, in numbers")
    page.table(
        "Generator off and on again, rotor's torque held: torque of the high-speed shaft over "
        "rated",
        dips,
    )
    page.text(
        "What a dip does depends on where it ends in the swing of the first mode, and on how much "
        "speed the drivetrain has gained: the slip line has no breakdown torque, while a real "
        "machine carries no more than two to three times its rated torque."
    )
    page.section("Backlash, in numbers")
    page.table(
        f"Torques over rated up to {SEQUENCE.braked + 3:g} s, the same brakes, backlash of all "
        "meshes about the planet's or the gear's axis",
        knocks,
    )
    page.text(
        "The thesis has one linear spring in both directions (section 4.6). With backlash, teeth "
        "that part where torque is reversed strike their other flanks, and torques beyond the "
        "printed ones come of it. How large they are depends on the damping of the meshes, which "
        "is only estimated; where the band of a peak is wide, impacts follow so closely on each "
        "other that it is no more than a size."
    )
    page.section("What rings")
    page.table("Frequencies of the torque of the high-speed shaft", swings)
    page.text(
        "A spectrum resolves no more than one over its time; with the brake on, the drivetrain is "
        "free at both ends, and its first mode is the only one that is excited. The thesis prints "
        "peaks 0.6 to 7 % above its own first modes (9.049, 4.54, 2.37 and 2.44 Hz), which a "
        "linear model cannot do but by resolution."
    )


def check_instants(page: Page, trains: list[Rated], quick: bool) -> list[Record]:
    """Peaks of the high-speed shaft with brakes that come at other points of the first swing."""
    shares = (0.0, 0.5) if quick else tuple(np.arange(8) / 8.0)
    dt = QUICK_STEP if quick else STEP
    sized: dict[str, list[tuple[float, Stopped]]] = {}
    for one in trains:
        period = 1.0 / float(natural_modes(two_masses(one.table, "free")).frequencies[1])
        lates = [float(share) * period for share in shares]
        sized[one.letter] = [
            (late, stop(one, dt, late, SEQUENCE.braked + late + 1.0)) for late in lates
        ]

    def run(step: float, _: int) -> InTime:
        values, lost = {}, 0.0
        for letter, each in sized.items():
            peaks = []
            for late, one in each:
                braked = SEQUENCE.braked + late
                when = sequence(one.of, braked + 1.0, late)
                found = stopped_by(one.of, one.brake, when, step)
                motion = found.motion
                peaks.append(peak_between(found.ratio(one.of.fast)[motion.times >= braked]))
                lost = max(lost, motion.relative_imbalance)
            values[f"{letter}, HSS: least peak over rated"] = min(peaks)
            values[f"{letter}, HSS: largest peak over rated"] = max(peaks)
        return InTime(values, lost)

    found = converge_in_time(run, 0.5 * dt)
    check_peaks(page, "instants of the brake", found)
    return [
        {
            "drivetrain": letter,
            "HSS, least peak over rated": found.value(f"{letter}, HSS: least peak over rated"),
            "HSS, largest peak over rated": found.value(f"{letter}, HSS: largest peak over rated"),
            "least brake over rated": min(one.brake for _, one in each),
            "largest brake over rated": max(one.brake for _, one in each),
        }
        for letter, each in sized.items()
    ]


def check_stops(page: Page, stopped: list[Stopped], dt: float) -> None:
    """Energy, and peaks of the same shutdowns with longer steps."""
    braked = SEQUENCE.braked

    def run(step: float, _: int) -> InTime:
        values, lost = {}, 0.0
        for one in stopped:
            when = sequence(one.of, braked + one.of.rise + 2.0)
            found = stopped_by(one.of, one.brake, when, step)
            motion = found.motion
            for shaft, own in (("LSS", one.of.slow), ("HSS", one.of.fast)):
                after = found.ratio(own)[motion.times >= braked]
                values[f"{one.of.letter}, {shaft}: peak over rated"] = peak_between(after)
                values[f"{one.of.letter}, {shaft}: least over rated"] = -peak_between(-after)
            lost = max(lost, motion.relative_imbalance)
        return InTime(values, lost)

    found = converge_in_time(run, dt)
    check_peaks(page, "shutdown", found)


def check_losses(page: Page, trains: list[Rated], dt: float) -> list[Record]:
    """Least torque of two masses against the closed form, and of all gears."""
    when = StopSequence(off=0.2, pitched=1e3, left=1.0, end=1.2)
    kinds: dict[str, dict[str, Any]] = {
        "two masses, undamped": {"lumped": True, "ratios": (0.0, 0.0)},
        "two masses, damped": {"lumped": True},
        "all gears, HSS": {},
    }

    def run(step: float, _: int) -> InTime:
        values, lost = {}, 0.0
        for one in trains:
            for kind, given in kinds.items():
                found = stopped_by(one, 0.0, when, step, **given)
                torque = found.ratio("shafts" if "lumped" in given else one.fast)
                values[f"{one.letter}, {kind}: least over rated"] = -peak_between(-torque)
                lost = max(lost, found.motion.relative_imbalance)
        return InTime(values, lost)

    found = converge_in_time(run, dt)
    page.section("Loss of the generator's torque, the rotor's held")
    check_peaks(page, "loss of the generator", found)
    return [check_loss(page, one, found) for one in trains]


def check_loss(page: Page, one: Rated, found: ConvergenceInTime) -> Record:
    """Check the loss of the generator of one drivetrain."""
    undamped, damped, gears = (
        f"{one.letter}, {kind}: least over rated"
        for kind in ("two masses, undamped", "two masses, damped", "all gears, HSS")
    )
    J1, J2 = two_masses(one.table, "free").J
    exact = float((J2 - J1) / (J1 + J2))
    page.equals(
        f"drivetrain {one.letter}, two masses: least torque over rated after loss of the generator",
        found.value(undamped),
        exact,
        within=2e-3,
        relative=False,
        why="a lowest point between two steps",
        source="two masses: the shaft swings between T and T (J2 - J1) / (J1 + J2)",
        band=found.band(undamped),
    )
    page.holds(
        f"drivetrain {one.letter}, all gears: torque "
        + ("stays positive" if one.tripped > 0.0 else "is reversed"),
        (found.value(gears) > 0.0) == (one.tripped > 0.0),
        why="gears knock on their other flanks where torque is reversed",
        source="sign of J2 - J1",
    )
    return {
        "drivetrain": one.letter,
        "two masses, closed form": exact,
        "two masses, damped": found.value(damped),
        "all gears, HSS": found.value(gears),
        "reversed": found.value(gears) < 0.0,
    }


def row_of(one: Stopped) -> Record:
    """Peaks and ranges of a shutdown."""
    t = one.done.motion.times
    low, high = one.done.ratio(one.of.slow), one.done.ratio(one.of.fast)
    after = t >= SEQUENCE.braked
    return {
        "drivetrain": one.of.letter,
        "brake over rated": one.brake,
        "stands after [s]": one.stops,
        "LSS, peak over rated": float(low[after].max()),
        "HSS, peak over rated": float(high[after].max()),
        "LSS, least": float(low.min()),
        "HSS, least": float(high.min()),
        "LSS, range over that in normal operation": float(np.ptp(low)) / NORMAL,
        "largest torque that the brake held": float(
            np.abs(one.done.motion.braking.torque[one.done.motion.braking.held]).max()
            / abs(one.done.torque / one.done.speeds["generator"])
        ),
    }


def verdicts(rows: list[Record], instants: list[Record]) -> list[Record]:
    """What the thesis says of shutdowns, beside what is found here."""
    least = min(rows, key=lambda row: row["HSS, peak over rated"])
    ranges = [row["LSS, range over that in normal operation"] for row in rows[:3]]
    return [
        {
            "statement": "highest ratio: LSS of B",
            "printed": "1.38",
            "ours": f"{rows[1]['LSS, peak over rated']:.3f}",
            "verdict": "sized",
        },
        {
            "statement": "lowest ratio: HSS of C",
            "printed": "1.32",
            "ours": f"{rows[2]['HSS, peak over rated']:.3f}, lowest: {least['drivetrain']}; "
            f"{instants[2]['HSS, least peak over rated']:.2f} to "
            f"{instants[2]['HSS, largest peak over rated']:.2f} by the instant of the brake",
            "verdict": "order agrees; the figure depends on the instant"
            if least["drivetrain"] == "C"
            else "differs",
        },
        {
            "statement": "A and B exceed 1.35 (LSS), C's HSS does not",
            "printed": "yes",
            "ours": ", ".join(
                f"{row['drivetrain']} {row['HSS, peak over rated']:.2f}" for row in rows
            ),
            "verdict": "agrees" if rows[2]["HSS, peak over rated"] < LIMIT else "differs",
        },
        {
            "statement": "range of torque over that in normal operation",
            "printed": "5 to 6.5 computed, 8 measured (LSS of C)",
            "ours": ", ".join(f"{value:.1f}" for value in ranges),
            "verdict": "larger here: see below",
        },
        {
            "statement": "torque is reversed in the shutdown",
            "printed": "yes, to a mean of -0.4 of rated",
            "ours": ", ".join(f"{row['LSS, least']:.2f}" for row in rows),
            "verdict": "agrees in kind",
        },
    ]


def check_frequencies(page: Page, one: Stopped) -> Record:
    """Spectra while the brake slips and while it holds, against modes."""
    t = one.done.motion.times
    torque = one.done.ratio(one.of.fast)
    first = one.done.motion.braking.events[0][0]
    mode = float(natural_modes(one.done.system).frequencies[1])
    grown = SEQUENCE.braked + one.of.rise
    # a brake that still grows is no steady one, unless the disc stands before it has
    begin = grown if (first - grown) * mode > LINES else SEQUENCE.braked
    ringing, resolution = peak_of(t, torque, begin, first)
    page.equals(
        f"drivetrain {one.of.letter}, brake on: frequency of the torque [Hz]",
        ringing,
        mode,
        within=0.5 * resolution,
        relative=False,
        why="half a line of the spectrum of that time",
        source="natural modes of the same masses, free at both ends",
    )
    swinging, fine = peak_of(t, torque, one.stops, SEQUENCE.end)
    generator = {"generator": 1e9 * one.of.table.generator.inertia}
    held = float(natural_modes(changed(one.done.system, generator)).frequencies[1])
    page.equals(
        f"drivetrain {one.of.letter}, brake holds: frequency of the torque [Hz]",
        swinging,
        held,
        within=0.5 * fine,
        relative=False,
        why="half a line of the spectrum of that time",
        source="natural modes of the same masses with the generator held",
    )
    return {
        "drivetrain": one.of.letter,
        "spectrum [Hz]": ringing,
        "its resolution [Hz]": resolution,
        "first mode [Hz]": mode,
        **printed_peak(one.of, ringing),
        "brake holds [Hz]": swinging,
        "its mode [Hz]": held,
        **({} if isnan(one.of.held) else {"two masses [Hz]": one.of.held}),
    }


def printed_peak(one: Rated, ringing: float) -> Record:
    """The printed peak of a spectrum [Hz] beside ours; nothing of a drivetrain without one."""
    if isnan(one.peak):
        return {}
    return {
        "printed [Hz]": one.peak,
        "printed over ours - 1 [%]": 100.0 * (one.peak / ringing - 1.0),
    }


def show(page: Page, one: Stopped) -> None:
    """Torques of the slow and the fast shaft."""
    t = one.done.motion.times
    every = slice(None, None, max(1, len(t) // 4000))
    events = {"generator off": SEQUENCE.off, "brake on": SEQUENCE.braked}
    first, what = one.done.motion.braking.events[0]
    events[f"disc {what}"] = first
    drawn = chart(
        SHUTDOWN.format(one.of.letter),
        [trace(name, t[every], one.done.ratio(name)[every]) for name in (one.of.slow, one.of.fast)],
        "time [s]",
        "torque over rated",
    )
    page.add(mark_events(drawn, events))
    page.data(f"drivetrain {one.of.letter}, brake over rated", one.brake)
