"""High-speed shaft from a tenth to ten times its stiffness: frequencies and torques of A to D."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.drivetrains import Rated, own_or_published
from fe_drivetrain.cases.references import published_drivetrains as published
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import InTime, converge_in_time, decades, peak_between
from fe_drivetrain.dynamics import StopSequence, shutdown
from fe_drivetrain.dynamics.torsion import (
    GearTable,
    Torsional,
    changed,
    gear_masses,
    natural_modes,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time
from fe_drivetrain.report.suite.chosen import SETTING

FACTOR = "stiffness of the high-speed shaft over the tabled one"
#: A generator's spring over its inertia, of drivetrain D: that of A is not printed.
SPRING = 2.81e4 / 24.0
FACTORS = (0.1, 1.0, 10.0)
STILL = 1.0  # %, of a frequency that the stiffness does not move
MOVING = "{}: frequencies that move by more than 0.1 %"
LOST = "lowest torque over rated after loss of the generator, {} of the stiffness"


@case(
    "Stiffness of the high-speed shaft from 10 to 1000 %: frequencies and torque after a loss of "
    "the generator",
    source="Al-Hamadani 2018, section 6.2.4, Figure 6.20, Tables 4.2 and 4.3",
    settings={"drivetrain": "FILE, or a name of the library (otherwise A to D of the thesis)"},
)
def run(run: Run, page: Page) -> None:
    """Sweep the shaft of all drivetrains; A with the generator's spring, too."""
    factors = decades(-1.0, 1.0, 8 if run.quick else 40)
    own, trains = SETTING in run.settings, own_or_published(run, page)
    with run.step("frequencies"):
        systems = (
            {} if own else {"A, generator fixed": (gear_masses(sprung(trains[0]), "fixed"), "HSS")}
        )
        systems |= {
            f"{one.letter}, generator free": (gear_masses(one.table, "free"), one.fast)
            for one in trains
        }
        rows = [sweep(page, name, *given, factors) for name, given in systems.items()]
    with run.step("torque"):
        page.section("Loss of the generator in time")
        torques = torque_rows(page, trains, run.quick)
    if own:
        own_answer(page, rows[0], torques[0])
    else:
        answer(page, rows[0], torques[0])
        page.assume(
            "generator's spring of A",
            "as that of D for its inertia",
            "",
            "the thesis does not print it",
        )
    page.section("What moves")
    page.table("Frequencies of a shaft ten times as stiff over those of a tenth", rows)
    page.section("Torque after a loss of the generator")
    page.table("Least torque of the high-speed shaft over rated", torques)


def sprung(one: Rated) -> GearTable:
    """A table with a generator's spring in proportion to its inertia."""
    spring = SPRING * one.table.generator.inertia
    return published.with_values(one.table, {"generator.stiffness": spring})


def own_answer(page: Page, first: Record, torque: Record) -> None:
    """State what the stiffness moves of a user's drivetrain."""
    most, lowest = first["by [%]"], first["lowest rises by [%]"]
    hz = value_text(first["rises most, as tabled [Hz]"], "Hz")
    page.answer(
        "Which frequencies does the stiffness of the high-speed shaft move?",
        f"From a tenth to ten times its stiffness, the shaft raises the mode at {hz} by "
        f"{most:.0f}\u00a0% and the lowest by {lowest:.2g}\u00a0%.",
        [
            page.value("largest rise of a mode [%]", most),
            page.value("rise of the lowest mode [%]", lowest),
            page.value("rise of the highest mode [%]", first["highest rises by [%]"]),
            *(
                page.value(LOST.format(k), torque[k])
                for k in (f"{100 * factor:g} %" for factor in FACTORS)
            ),
        ],
        MOVING.format(first["drivetrain"]),
    )


def answer(page: Page, first: Record, torque: Record) -> None:
    """State what the stiffness moves of drivetrain A, and what not, beside the thesis."""
    lowest, most, highest = (
        first[key] for key in ("lowest rises by [%]", "by [%]", "highest rises by [%]")
    )
    holds = highest < STILL < most
    hz = f"{first['rises most, as tabled [Hz]']:.0f}"
    still = f"less than {STILL:g}\u00a0%" if highest < STILL else f"{highest:.2g}\u00a0%"
    page.answer(
        "Which frequencies does the stiffness of the high-speed shaft move?",
        f"From a tenth to ten times the stiffness, drivetrain A's {hz}\u00a0Hz mode rises by "
        f"{most:.0f}\u00a0%, its highest by {still}, {'as' if holds else 'not as'} the thesis "
        "states.",
        [
            page.value(f"rise of the {hz} Hz mode [%]", most),
            page.value("rise of the lowest mode [%]", lowest),
            page.value(
                "rise of the highest mode [%]", highest, at_most=STILL, by="thesis: unmoved"
            ),
            *(
                page.value(LOST.format(k), torque[k])
                for k in (f"{100 * factor:g} %" for factor in FACTORS)
            ),
        ],
        MOVING.format(first["drivetrain"]),
        ["The generator's spring of A is not printed: it is scaled from that of D by inertia."],
        claim="holds" if holds else "does not hold",
    )


def sweep(page: Page, name: str, system: Torsional, shaft: str, factors: Floats) -> Record:
    """Frequencies over the stiffness, monotone, with slopes of half the energy share."""
    tabled = next(e.stiffness for e in system.elements if e.name == shaft)
    f = np.array([natural_modes(changed(system, {shaft: k * tabled})).frequencies for k in factors])
    page.holds(
        f"{name}: no frequency falls when the shaft is stiffened",
        bool((np.diff(f, axis=0) >= -1e-9 * f.max()).all()),
        why="a stiffness adds to Rayleigh's quotient of every motion",
        source="Courant and Fischer",
    )
    step = 1e-4
    up, down = (
        natural_modes(changed(system, {shaft: (1.0 + s) * tabled})).frequencies
        for s in (step, -step)
    )
    modes = natural_modes(system)
    place = [e.name for e in system.elements].index(shaft)
    swings = modes.frequencies > 0.0
    slope = np.log(up[swings] / down[swings]) / (2.0 * step)
    page.vanishes(
        f"{name}: slopes ln f over ln k less half of the strain energy's share, largest",
        float(np.abs(slope - modes.stiffness_shares[place, swings] / 2.0).max()),
        within=1e-6,
        why="differences over 1e-4 leave their square",
        source="Rayleigh's quotient is stationary",
    )
    chosen = np.flatnonzero(swings & (np.ptp(np.log(np.maximum(f, 1e-9)), axis=0) > 1e-3))
    page.section(name)
    page.chart(
        MOVING.format(name),
        [trace(f"{modes.frequencies[m]:.4g} Hz as tabled", factors, f[:, m]) for m in chosen],
        FACTOR,
        "frequency [Hz]",
        "xy",
    )
    page.data(name, {"factor": factors, "frequencies": f})
    rise = 100.0 * (f[-1, swings] / f[0, swings] - 1.0)
    return {
        "drivetrain": name,
        "lowest rises by [%]": float(rise[0]),
        "rises most, as tabled [Hz]": float(modes.frequencies[swings][rise.argmax()]),
        "by [%]": float(rise.max()),
        "highest rises by [%]": float(rise[-1]),
    }


def torque_rows(page: Page, trains: list[Rated], quick: bool) -> list[Record]:
    """Least torque after loss of the generator, for three stiffnesses."""

    def run(dt: float, _: int) -> InTime:
        values, lost = {}, 0.0
        for one in trains:
            for factor in FACTORS:
                least, error = min_torque(one, factor, dt)
                values[f"{one.letter}, {100 * factor:g} %: least torque over rated"] = least
                lost = max(lost, error)
        return InTime(values, lost)

    found = converge_in_time(run, 1.25e-4 if quick else 3e-5)
    check_in_time(
        page,
        "loss of the generator",
        found,
        dict.fromkeys(found.finest.values, 0.02),
        energy=1e-8,
        why="average acceleration conserves the energy of a linear system, to round-off",
        scale=dict.fromkeys(found.finest.values, 1.0),
    )
    return [
        {
            "drivetrain": one.letter,
            **{
                f"{100 * factor:g} %": found.value(
                    f"{one.letter}, {100 * factor:g} %: least torque over rated"
                )
                for factor in FACTORS
            },
        }
        for one in trains
    ]


def min_torque(one: Rated, factor: float, dt: float) -> tuple[float, float]:
    """Torque of the high-speed shaft over rated, and the error of the energy."""
    when = StopSequence(off=0.1, pitched=1e3, left=1.0, end=1.5)
    last = len(one.table.shafts) - 1
    k = factor * one.table.shafts[last].stiffness
    table = published.with_values(one.table, {f"shafts.{last}.stiffness": k})
    found = shutdown(table, one.torque, one.speed, 0.0, when, dt=dt, ratios=one.ratios)
    least = -peak_between(-found.ratio(one.fast))
    return least, found.motion.relative_imbalance
