"""Torque of each shaft in normal operation over that of the rotor: what follows, and what rings."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.dynamics.drivetrains import (
    Rated,
    damped_masses,
    first_held,
    mean_torques,
    own_or_published,
    unit,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import InTime, converge_in_time
from fe_drivetrain.dynamics import (
    Equations,
    Loads,
    Motion,
    State,
    integrate,
    joined_laws,
    slip_line,
    steady,
    summed,
    torsional_equations,
    varying,
    wind_up,
)
from fe_drivetrain.dynamics.torsion import (
    Torsional,
    gear_speeds,
)
from fe_drivetrain.report import Cell, chart, mark_events, trace
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time
from fe_drivetrain.report.suite.chosen import SETTING

PRINTED, LIMIT = 1.26, 1.35
"""Largest torque over rated in normal operation, drivetrain B; limit of the design loads."""
APART = "low-speed over high-speed shaft, torques over their mean: largest difference"
ORDERS = (1, 3, 6)
"""Of the rotor's speed."""
SLIP = 0.01
SAME = 0.005
RESPONSE = "Swing of the high-speed shaft's torque over its mean, of the rotor's as 1"
LASTING = 20.0  # s
SHAFTS = {"LSS": 0, "ISS1": 1, "HSS": -1}
"""Places of shafts among those from the rotor on."""


@case(
    "Normal operation of drivetrains A to D: torque of each shaft over that of the rotor",
    source="Al-Hamadani 2018, section 6.2.2, Figure 6.17",
    settings={"drivetrain": "FILE, or a name of the library (otherwise A to D of the thesis)"},
)
def run(run: Run, page: Page) -> None:
    """Swings of the rotor's torque at 1P, 3P and 6P, in time and by frequency response."""
    rows: list[Record] = []
    trains = own_or_published(run, page, "Normal operation: torque of each shaft over the rotor's")
    page.section("In time")
    for one in trains:
        with run.step(f"drivetrain {one.letter}"):
            rows += rows_of(page, one, 1e-2 if run.quick else 2e-3)
    apart = max(abs(float(str(row["LSS"])) / float(str(row["HSS"])) - 1) for row in rows)
    if SETTING in run.settings:
        page.found(APART, apart)
    else:
        check_apart(page, apart)
    page.section("Swing of each shaft's torque over its mean, of the rotor's one as 1")
    page.table("Generator on a slip line", rows)
    thrice = {
        str(row["drivetrain"]): float(str(row["LSS"])) for row in rows if row["order"] == "3P"
    }
    if SETTING in run.settings:
        own_answer(page, rows, apart, trains[0])
    else:
        beside_thesis(page, rows, apart, trains)
        answer(page, apart, thrice)
    with run.step("frequency response"):
        show_response(page, trains, 60 if run.quick else 200)
    page.assume(
        "generator", f"slip of {100 * SLIP:g} % at rated torque", "", "controls not printed"
    )


def check_apart(page: Page, apart: float) -> None:
    """All shafts of the thesis's drivetrains swing by the same share of their torque."""
    page.at_most(
        APART,
        apart,
        0.01,
        why="inertias between the shafts are small against those of rotor and generator",
        source=f"{PRINTED} of LSS, ISS1 and HSS of drivetrain B",
    )


def beside_thesis(page: Page, rows: list[Record], apart: float, trains: list[Rated]) -> None:
    """Show printed statements on drivetrains B, C and D beside ours."""
    swings = [float(str(row["LSS"])) for row in rows if row["drivetrain"] == "B"]
    least, largest = min(swings), max(swings)
    page.table(
        "Printed, ours, verdict",
        verdicts(apart, least, largest),
        ["statement", "printed", "ours", "verdict"],
    )
    first = {one.letter: first_held(one) for one in trains}
    page.text(
        f"C and D have their first mode, with the generator held, at {first['C']:.2f} and "
        f"{first['D']:.2f} Hz, next to 3P; what damps it there is the slip of the generator. "
        "The thesis puts the measured torque of a 2 MW turbine on the rotor of A and B, too, "
        "scaled by their diameters."
    )
    page.say(
        "Up to 6P the shafts of B follow the torque of the rotor within "
        f"{100 * max(abs(largest - 1), abs(least - 1)):.0f} %.",
    )


def own_answer(page: Page, rows: list[Record], apart: float, one: Rated) -> None:
    """State how much more than the rotor's the shafts of a user's drivetrain swing."""
    most = max(rows, key=lambda row: float(str(row["HSS"])))
    first = first_held(one)
    page.answer(
        "How much more does the torque of the shafts swing in operation than that of the rotor?",
        f"Shafts swing up to {float(str(most['HSS'])):.2f} times as much as the rotor's torque, at "
        f"{most['order']}; the first mode with the generator held is at "
        f"{value_text(first, 'Hz')}.",
        [
            page.judged(
                APART,
                "largest difference between shafts",
                unit="%",
            ),
            *(
                page.judged(
                    f"drivetrain {one.letter}, {row['order']}: swing of the HSS in time, of the "
                    "rotor's as 1",
                    f"swing at {row['order']}",
                    "frequency response",
                )
                for row in rows
            ),
            page.value("first mode, generator held [Hz]", first),
        ],
        RESPONSE,
    )


def answer(page: Page, apart: float, thrice: dict[str, float]) -> None:
    """State how equally the shafts swing, and how much more than the rotor at 3P."""
    fast = {
        letter: page.judged(
            f"drivetrain {letter}, 3P: swing of the HSS in time, of the rotor's as 1",
            f"swing of the high-speed shaft at 3P over the rotor's, drivetrain {letter}",
            "frequency response",
        )
        for letter in thrice
    }
    most = max(fast, key=lambda letter: fast[letter].value)
    same = apart < SAME
    page.answer(
        "Does torque over rated swing equally in all shafts of a drivetrain in normal operation?",
        f"Torque over rated swings equally in all shafts within {percent_text(apart)}, "
        f"{'as' if same else 'not as'} printed for B; at 3P, {most}'s high-speed shaft swings "
        f"{fast[most].value:.2f} times the rotor's torque.",
        [page.judged(APART, "largest difference between shafts", unit="%"), *fast.values()],
        RESPONSE,
        [
            f"The printed factor of {PRINTED} is not computed: it belongs to a measured torque "
            "that is not public."
        ],
        claim="holds" if same else "does not hold",
    )


def show_response(page: Page, trains: list[Rated], count: int) -> None:
    """Swing of the high-speed shafts over the order of the rotor's speed."""
    orders = np.linspace(0.2, 7.0, count)
    traces = []
    for one in trains:
        system = damped_masses(one)
        generator = float(gear_speeds(one.table)["generator"])
        k = [e.name for e in system.elements].index(one.fast)
        swings = [amplified(system, one, generator, n * one.speed)[k] for n in orders.tolist()]
        traces.append(trace(f"drivetrain {one.letter}", orders, swings))
    page.section("Between the orders")
    drawn = chart(
        RESPONSE, traces, "frequency over the rotor's speed", "swing, of the rotor's as 1"
    )
    page.add(mark_events(drawn, {f"{order}P": float(order) for order in ORDERS}))


def verdicts(apart: float, least: float, largest: float) -> list[list[Cell]]:
    """Printed statements on drivetrain B beside ours.

    Parameters
    ----------
    apart : float
        Largest difference of the shafts' torques over their mean.
    least, largest : float
        Swing of the low-speed shaft over that of the rotor.
    """
    return [
        [
            "largest torque of B over rated is the same at LSS, ISS1 and HSS",
            f"{PRINTED} at all three",
            f"the same within {100 * apart:.1g} %, whatever the rotor's torque",
            "agrees" if apart < SAME else "differs",
        ],
        [
            "that it is 1.26",
            f"{PRINTED}",
            f"the rotor's own swing times {least:.3f} to {largest:.3f}",
            "of the measured torque, which is not public: not computed",
        ],
        [
            "below the limit of the design loads",
            f"{PRINTED} < {LIMIT}",
            f"as long as the rotor's torque is below {1 + (LIMIT - 1) / largest:.2f} of rated",
            "agrees for such a torque",
        ],
    ]


def rows_of(page: Page, one: Rated, dt: float) -> list[Record]:
    """Amplification of each shaft at each order."""
    system = damped_masses(one)
    generator = float(gear_speeds(one.table)["generator"])
    names = [e.name for e in system.elements]
    rows: list[Record] = []
    k = names.index(one.fast)
    keys = {order: f"{order}P: swing of the HSS" for order in ORDERS}

    def run(step: float, _: int) -> InTime:
        motions = {n: swinging(system, one, generator, n * one.speed, step) for n in ORDERS}
        values = {
            keys[n]: float(swung(system, one, generator, n * one.speed, motion)[k])
            for n, motion in motions.items()
        }
        return InTime(values, max(motion.relative_imbalance for motion in motions.values()))

    series = converge_in_time(run, dt)
    check_in_time(
        page,
        f"drivetrain {one.letter}",
        series,
        dict.fromkeys(keys.values(), 0.02),
        energy=1e-8,
        why="average acceleration conserves the energy of a linear system, to round-off",
    )
    for order in ORDERS:
        w = order * one.speed
        exact = amplified(system, one, generator, w)
        page.equals(
            f"drivetrain {one.letter}, {order}P: swing of the HSS in time, of the rotor's as 1",
            series.value(keys[order]),
            float(exact[k]),
            within=(w * dt) ** 2 / 4.0 + 2e-4,
            why="(w dt)^2 / 12 of the load of straight lines and of the method's period, times the "
            "slope of the response; the start rings on",
            source="frequency response of the same masses",
        )
        row: Record = {"drivetrain": one.letter, "order": f"{order}P", "[Hz]": w / (2 * np.pi)}
        shafts = one.table.shafts
        for shaft, place in SHAFTS.items():
            at = names.index(shafts[place].name) if place < len(shafts) else None
            row[shaft] = None if at is None else float(exact[at])
        rows.append(row)
    return rows


def steepness(one: Rated, generator: float) -> float:
    """Steepness of the generator's line [N m s/rad]."""
    return one.torque / (SLIP * one.speed * generator**2)


def amplified(system: Torsional, one: Rated, generator: float, w: float) -> Floats:
    """Swing of each element's torque over its mean, of the rotor's one, by frequency response."""
    pull = unit(system, "generator")
    c = np.array([element.damping for element in system.elements])
    spring = system.k + 1j * w * c
    line = 1j * w * steepness(one, generator) * np.outer(pull, pull)
    A = system.B.T @ (spring[:, None] * system.B) - w**2 * np.diag(system.J) + line
    swing = spring * (system.B @ np.linalg.solve(A, unit(system, "rotor").astype(complex)))
    return np.asarray(np.abs(swing / mean_torques(system, generator)), dtype=np.float64)


def swinging(system: Torsional, one: Rated, generator: float, w: float, dt: float) -> Motion:
    """Under rated torque that swings by a tenth."""
    chain = torsional_equations(system)
    rated = one.torque / generator
    law, pull = slip_line(unit(system, "generator"), rated, 0.0, steepness(one, generator))
    equations = Equations(chain.mass, joined_laws(chain.springs, law), chain.damping, chain.extra)
    times = np.arange(0.0, LASTING + dt, dt)
    wind: Loads = varying(
        unit(system, "rotor"), times, one.torque * (1.0 + 0.1 * np.sin(w * times))
    )
    acting = summed(wind, steady(pull.at(0.0)))
    still = np.zeros(len(system.J))
    start = wind_up(equations, one.torque * unit(system, "rotor") + pull.at(0.0), still)
    return integrate(
        equations, acting, LASTING, dt, start=State(start.q, still, start.acceleration)
    )


def swung(system: Torsional, one: Rated, generator: float, w: float, motion: Motion) -> Floats:
    """The same as `amplified` in time, of the second half of a run."""
    late = motion.times > LASTING / 2.0
    t = motion.times[late]
    weight = np.hanning(len(t))[:, None]
    waves = np.column_stack([np.ones_like(t), np.sin(w * t), np.cos(w * t)])
    forces = motion.forces[late][:, : len(system.elements)]
    found = np.linalg.lstsq(weight * waves, weight * forces, rcond=None)[0]
    size = np.hypot(found[1], found[2]) / (0.1 * one.torque)
    return np.asarray(np.abs(size / mean_torques(system, generator)), dtype=np.float64)
