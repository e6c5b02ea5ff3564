"""Stiffness, damping and inertia from measured signals: printed equations beside the truth."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.procedure.independent_run import OF, elsewhere, shares_of_braking
from fe_drivetrain.cases.procedure.known_drivetrain import (
    BRAKING,
    BROAD,
    KNOWN,
    NARROW,
    STEP,
    USED,
    Known,
    known_of,
    simulated,
)
from fe_drivetrain.cases.procedure.lost_torque import judge_stop
from fe_drivetrain.cases.procedure.measured_identification import MEASURED, identified_record
from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.procedure import (
    Motions,
    Solutions,
    Twist,
    band_torque,
    counted_angle,
    element_torques,
    least_squares,
    measured,
    method_a,
    method_b,
    method_c,
    periodic_motions,
    ratio_by_ranges,
    scaled_to_power,
    spectral_fit,
    stiffness_by_ranges,
    timed_angle,
)
from fe_drivetrain.report import bars, mark_events
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import SETTING

BY_METHOD = "Damping that each method finds, over the truth"
REPEATS = 20
MARGIN = 40  # samples left out at either end of a record
ENCODERS = 4096, 60  # pulses a turn of low- and high-speed shaft


@case(
    "Stiffness, damping and inertia of a drivetrain, identified: equations 2 to 13 of PROTEST",
    source="PROTEST 2010, ECN-E--10-100, section 4.6.2.6, Eq 1 to 13",
    settings={
        "drivetrain": "FILE, or a name of the library (otherwise the case's own, of two inertias)",
        "measured": "FILE (CSV of a record, in place of a simulated one, of your own drivetrain)",
        "torque_column": "torque (column of the torque in the record)",
        "front_column": "front (column of the angle at the front end)",
        "rear_column": "rear (column of the angle at the rear end)",
        "shaft": "NUMBER (of the shaft between both ends, otherwise all from rotor to generator)",
        "stop": "NUMBER (s, when the torque was lost, of a record of a stop)",
    },
)
def run(run: Run, page: Page) -> None:
    """Put the printed methods, least squares and fits of spectra to a drivetrain that is known."""
    known, title = KNOWN, ""
    if SETTING not in run.settings:
        refuse_record_alone(run)
    if SETTING in run.settings:
        chosen = run.drivetrain("")
        chosen.state(page)
        if MEASURED in run.settings:
            identified_record(run, page, chosen)
            return
        known, title = known_of(page, chosen), chosen.title
    seconds = 190.0 if run.quick else 570.0
    rows: list[Record] = []
    for name, band, braking in (("broadband", BROAD, BRAKING), ("resonance", NARROW, 0.0)):
        with run.step(name):
            twists = simulated(round(seconds / STEP), band, braking, known=known)
            rows += printed(page, known, name, twists) + fitted(page, known, name, twists)
    page.section("Printed, ours, truth")
    page.table("Medians of all answers, and of those above zero, over the truth", rows)
    page.data("methods", rows)
    if known is KNOWN:
        elsewhere(page, rows)
        shares_of_braking(page)
    page.text(
        "Eq 1 writes T = I x'' + D x' + K x for the twist x. The torque in a shaft is K x + D x', "
        "with no inertia; I x'' belongs to the reduced torque J* (T_aero / J_r + T_gen / J_g), "
        "J* = J_r J_g / (J_r + J_g). Eq 5 sets a sum of two positive ranges to zero: its sign is "
        "left out here. One side of Eq 13 is printed as a sample, and is a range here. Ranges drop "
        "the phase: acceleration opposes displacement, so that Eq 7 to 13 add what subtracts, and "
        "at one frequency the two equations of a pair are the same. At one frequency Eq 5 is 1 / w "
        "whatever I and D are, so that method A sees K x + D x' as D x' / (1 - tan w t) and has "
        "half of D as its median."
    )
    page.section("Measured")
    with run.step("measured"):
        noisy = campaign(page, known, seconds)
    page.table("Sensors with noise: first fit, and how often 95 % bands hold the truth", noisy)
    with run.step("stop"):
        judge_stop(page, known)
    for name, value, unit in (
        ("J_r, J_g", f"{KNOWN.front:g}, {KNOWN.rear:g}", "kg m^2"),
        ("K", KNOWN.stiffness, "N m/rad"),
        ("damping ratio", KNOWN.ratio, ""),
    ):
        if known is KNOWN:
            why = "of the size of a 750 kW drivetrain; the report prints none"
            page.assume(name, value, unit, why)
    answer(page, rows, noisy, title)
    page.say(
        "With pulses timed, noise and gain of the bridge a fit to lines of the spectra has "
        f"damping {noisy[0][OF[1]]:.3f} and stiffness {noisy[0][OF[2]]:.3f} of the truth; with "
        f"pulses counted {noisy[1][OF[1]]:.2f} and {noisy[1][OF[2]]:.2f}, where least squares of "
        f"samples have {noisy[1]['least squares: damping / truth']:.2g} and "
        f"{noisy[1]['least squares: stiffness / truth']:.2g}.",
    )


def refuse_record_alone(run: Run) -> None:
    """Refuse settings of a record where no drivetrain of the user's own is named."""
    for key in run.settings:
        if key != SETTING:
            raise InputError(
                f"{key} = {run.settings[key]!r} is of a record of your own drivetrain: name it, as "
                f"in {SETTING}=mine.yaml"
            )


def answer(page: Page, rows: list[Record], noisy: list[Record], title: str) -> None:
    """State what the printed methods give, beside fits that hold."""
    page.section("Damping by each method")
    shown = [row for row in rows if row[OF[1]] is not None]
    by_run = {
        run: {
            f"{row['method']}, {row['torque']} torque": float(row[OF[1]])
            for row in shown
            if row["run"] == run
        }
        for run in dict.fromkeys(str(row["run"]) for row in shown)
    }
    damping = bars(BY_METHOD, by_run, "damping over the truth [-]")
    page.add(mark_events(damping, {"truth": 1.0}))
    stiffness = max(
        100.0 * abs(row[OF[2]] - 1.0) for row in rows if row["method"].startswith("Eq 4")
    )
    printed = [float(row[OF[1]]) for row in shown if row["method"][0] in "ABC"]
    low, high = min(printed), max(printed)
    right = low > 0.8 and high < 1.2
    page.answer(
        "Do PROTEST's equations identify a drivetrain's stiffness, damping and inertia?",
        f"PROTEST's Eq 4 finds the stiffness within {stiffness:.1g}\u00a0%, "
        f"{'and' if right else 'but'} methods A to C {'find' if right else 'do not find'} the "
        f"damping: {formatted(low, 2)} to {formatted(high, 2)} times the true one.",
        [
            page.judged("resonance, Eq 4: stiffness", "stiffness by Eq 4", "closed form"),
            page.value(
                "lowest damping by methods A to C, over the truth", low, beside=1.0, by="truth"
            ),
            page.value(
                "highest damping by methods A to C, over the truth", high, beside=1.0, by="truth"
            ),
            page.value(
                "damping by fits of spectra, sensors with noise, over the truth",
                noisy[0][OF[1]],
                noisy[0]["its band"],
                beside=1.0,
                by="truth",
            ),
            page.value(
                "stiffness by fits of spectra, sensors with noise, over the truth",
                noisy[0][OF[2]],
                noisy[0]["band of that"],
                beside=1.0,
                by="truth",
            ),
        ],
        hero=BY_METHOD,
        cautions=[
            f"The record is simulated, of two inertias that stand for {title}."
            if title
            else "The drivetrain is simulated and known; inertia and stiffness are assumed, of the "
            "size of a 750 kW machine.",
            "With exact samples least squares on the reduced torque find all three without error; "
            "with noisy sensors use fits of spectra.",
        ],
        claim="" if title else "holds" if right else "holds in part",
    )


def printed(page: Page, known: Known, run: str, twists: dict[str, Twist]) -> list[Record]:
    """Eq 4, Eq 5 and methods A to C as printed."""
    shaft = twists["shaft"]
    stiffness = float(np.median(stiffness_by_ranges(shaft)))
    ratio = float(np.median(ratio_by_ranges(shaft)))
    rows = [
        line(run, "Eq 4, ranges", "shaft", [None, None, stiffness / known.stiffness], None, None),
        line(run, "Eq 5, ranges", "shaft", [None, None, None], None, f"I / D = {ratio:.4f} s"),
    ]
    for name, twist in twists.items():
        for method, found in (
            ("A, time", method_a(twist, stiffness, ratio)),
            ("B, differential", method_b(twist, known.turn)),
            ("C, constant", method_c(twist, known.turn, stiffness)),
        ):
            rows.append(median_line(known, run, method, name, found))
    if run == "resonance":
        check_resonance(page, known, stiffness, ratio, rows)
    if known is not KNOWN:
        return rows
    near = [row for row in rows[2:] if abs(row[OF[0]] - 1.0) < 0.2 and abs(row[OF[1]] - 1.0) < 0.2]
    page.holds(
        f"{run}: no printed method has inertia and damping within 20 % of the truth",
        not near,
        why="equations that are right would have both",
        source="the simulated drivetrain",
    )
    return rows


def check_resonance(
    page: Page, known: Known, stiffness: float, ratio: float, rows: list[Record]
) -> None:
    """What printed equations have to give at one frequency."""
    page.equals(
        "resonance, Eq 4: stiffness [N m/rad]",
        stiffness,
        float(np.hypot(known.stiffness, known.damping * known.omega)),
        within=1e-3,
        why="the frequency in a window is within 6 % of the natural one, and damping adds 0.2 %",
        source="a sine at w: sqrt(K^2 + (w D)^2)",
        measure="stiffness",
    )
    page.equals(
        "resonance, Eq 5: inertia over damping [s]",
        ratio,
        1.0 / known.omega,
        within=0.02,
        why="the band is 6 % wide to either side",
        source=f"1 / w of one frequency, where the truth is {known.reduced / known.damping:.3f} s",
        measure="identity",
    )
    for torque, damping, expected, source in (
        ("shaft's", rows[2][OF[1]], 0.5, "median of 1 / (1 - tan u) over a turn of u"),
        (
            "reduced",
            rows[5][OF[1]],
            0.5 * (1.0 + 0.5 / known.ratio),
            "(D + J* w) / 2, by the same median",
        ),
    ):
        page.equals(
            f"resonance, method A on the {torque} torque: damping over the truth",
            float(damping),
            expected,
            within=0.05,
            why="one frequency, but for a narrow band",
            source=source,
            measure="identity",
        )


def median_line(known: Known, run: str, method: str, torque: str, found: Solutions) -> Record:
    """Medians over the truth."""
    inertia, damping = found.medians()
    kept = found.medians(plausible=True)
    share = float(found.plausible.mean())
    words = f"{kept[0] / known.reduced:.2g}, {kept[1] / known.damping:.2g}" if share else "none"
    return line(
        run, method, torque, [inertia / known.reduced, damping / known.damping, None], share, words
    )


def line(
    run: str,
    method: str,
    torque: str,
    values: list[float | None],
    share: float | None,
    words: str | None,
) -> Record:
    """A row of the table."""
    return {
        "run": run,
        "method": method,
        "torque": torque,
        **dict(zip(OF, values, strict=True)),
        "share above zero": share,
        "of these": words,
    }


def fitted(page: Page, known: Known, run: str, twists: dict[str, Twist]) -> list[Record]:
    """Least squares of all samples, for each torque."""
    rows = []
    expected = {"shaft": [0.0, 1.0, 1.0], "reduced": [1.0, 1.0, 1.0]}
    if run == "resonance":
        expected["aerodynamic"] = [known.front / known.reduced] * 3
    for name, twist in twists.items():
        found = least_squares(twist).values / known.truth
        rows.append(line(run, "least squares", name, [float(v) for v in found], None, None))
        for key, value, wanted in zip(OF, found, expected.get(name, ()), strict=False):
            page.equals(
                f"{run}, least squares on the {name} torque: {key}",
                float(value),
                wanted,
                within=1e-8,
                relative=False,
                why="exact samples and an exact equation: rounding",
                source="two free masses; J_r / J* where only the rotor is driven",
                measure="identity",
            )
    return rows


def recorded(signal: Floats) -> Floats:
    """Samples of a fine signal that are recorded, without its ends."""
    return signal[::5][MARGIN:-MARGIN]


def campaign(page: Page, known: Known, seconds: float) -> list[Record]:
    """Strain gauges scaled by power, pulses timed or counted; fits with bands."""
    fine, size, gauge = 0.001 * known.slower, known.stronger, known.gauge
    samples, band = round(seconds / 0.001), (BROAD[0] / known.slower, BROAD[1] / known.slower)
    driving = band_torque(samples, fine, band, 400.0 * size, 1)
    load = band_torque(samples, fine, band, 160.0 * size, 2)
    motions = periodic_motions(known.system, np.stack([driving, -load]), fine)
    turned = [angle + known.speed * motions.time for angle in motions.angle]
    exact = recorded(turned[0] - turned[1])
    # scaling by the mean turns an offset into an error of gain
    left = 1.0 / (1.0 + gauge.offset / (gauge.gain * known.torque))
    bridges = [gauged(known, motions, seed) for seed in range(2 * REPEATS)]
    rows = [
        {
            "twist": name,
            "error of the twist, rms [mrad]": 1e3 * float((twist - exact).std()),
            **identified(known, twist, bridges, left),
        }
        for name, twist in encoded(known, motions.time, turned).items()
    ]
    page.between(
        f"pulses timed: share of 95 % bands that hold the truth, {3 * REPEATS} of them",
        rows[0]["bands that hold"],
        0.85,
        1.0,
        why="three standard deviations of a share of 0.95 of sixty are 0.085",
        source="the simulated drivetrain, times the gain that the bridge's offset leaves",
        measure="identity",
        basis="self-consistency",
    )
    page.text(
        f"Bridge: gain {gauge.gain:g}, offset {gauge.offset:.4g} N m, noise {gauge.noise:.4g} N m, "
        f"scaled so that its mean is that of the electrical power and losses; a second bridge is "
        f"the instrument. Of the offset an error of gain of {left - 1:.2%} stays, which no band "
        "shows. Encoders of "
        f"{ENCODERS[0]} and {ENCODERS[1]} pulses a turn, by a clock of 32 MHz or by counting: a "
        f"pulse is {360 * known.gear / ENCODERS[0]:.1f} and {360 / ENCODERS[1]:.1f} deg of the "
        "high-speed shaft. Repeats differ in the noise of the bridges alone."
    )
    return rows


def gauged(known: Known, motions: Motions, seed: int) -> Floats:
    """Torque as recorded by a strain gauge, scaled to electrical power."""
    torque = element_torques(known.system, motions)[0] + known.torque
    record = measured(known.gauge, torque, seed)
    power = np.full(len(record), 0.95 * known.torque * known.speed)
    return recorded(record * scaled_to_power(record, motions.speed[1] + known.speed, power, 0.95))


def encoded(known: Known, time: Floats, turned: list[Floats]) -> dict[str, Floats]:
    """The twist by encoders at both ends, whose pulses are timed or counted."""
    timed, counted = [], []
    for angle, pulses, at in zip(turned, ENCODERS, (1.0 / known.gear, 1.0), strict=True):
        timed.append(timed_angle(time, angle * at, pulses, recorded(time)) / at)
        counted.append(recorded(counted_angle(angle * at, pulses)) / at)
    return {"pulses timed": timed[0] - timed[1], "pulses counted": counted[0] - counted[1]}


def identified(known: Known, twist: Floats, bridges: list[Floats], left: float) -> Record:
    """Fits of spectra by pairs of bridges, and least squares of samples by the first."""
    pairs = list(zip(bridges[::2], bridges[1::2], strict=True))
    step, used = STEP * known.slower, (USED[0] / known.slower, USED[1] / known.slower)
    fits = [spectral_fit(one, twist, step, used, other) for one, other in pairs]
    wanted = np.array([0.0, known.damping, known.stiffness]) * left
    rate = np.gradient(twist, step)
    naive = least_squares(Twist(step, bridges[0], twist, rate, np.gradient(rate, step))).values
    return {
        OF[1]: float(fits[0].values[1] / known.damping),
        "its band": float(fits[0].bands[1] / known.damping),
        OF[2]: float(fits[0].values[2] / known.stiffness),
        "band of that": float(fits[0].bands[2] / known.stiffness),
        "bands that hold": float(np.mean([np.abs(f.values - wanted) < f.bands for f in fits])),
        "least squares: damping / truth": float(naive[1] / known.damping),
        "least squares: stiffness / truth": float(naive[2] / known.stiffness),
    }
