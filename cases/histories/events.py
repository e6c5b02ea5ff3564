"""A computed shutdown counted as the thesis counts; events that are drawn to its statistics."""

from dataclasses import replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.histories.computed_stop import (
    COMPUTED,
    STATES,
    TWO_MW,
    ComputedStop,
    check_counts,
    computed_rows,
    computed_stop,
    equivalent,
    largest_range,
    show_computed,
)
from fe_drivetrain.comparison import ConvergenceInTime, InTime, converge_in_time, peak_between
from fe_drivetrain.dynamics import energy_error, equations_of_motion, spring_laws, varying
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time
from fe_drivetrain.turbine_loads.histories import rainflow_cycles
from fe_drivetrain.turbine_loads.hub_loads import (
    Event,
    Rotor,
    grid_loss,
    grid_loss_twist,
    made_event,
    similar_turbine,
)

SHOWN = 0.84e6  # N m, torque before the grid loss that is shown
#: What made events are drawn to: median range, median mean (normal operation over it),
#: negative mean, equivalent load; the thesis gives equivalent loads of the fast shaft.
STATED: dict[str, dict[str, tuple[float | None, ...]]] = {
    "fast": {
        "normal operation": (5.0, None, None, 3.65),
        "emergency stop": (1.0, 2.0, 1.0, 1.0),
        "normal stop": (1.3, 1.92, 4.0, 1.1),
        "start-up": (1.76, 2.47, 5.8, 1.43),
    },
    "slow": {
        "normal operation": (8.9, None, None, None),
        "emergency stop": (1.0, 2.2, 1.0, None),
        "normal stop": (1.5, 2.1, None, None),
        "start-up": (1.92, 2.6, None, None),
    },
}
LOWEST, HIGHEST = "least torque over that before", "largest torque after it over that before"
TORQUE = "Torque of the slow shaft: start-up, stops, and a grid loss at 0 s"
QUANTITIES = (
    "median range, emergency stop over this",
    "median mean, normal operation over this",
    "least mean, emergency stop over this",
    "equivalent load, emergency stop over this",
)


@case(
    "Torque cycles of a computed shutdown, events made to stated statistics, and a grid loss",
    source="Al-Hamadani 2018, chapter 3",
    settings={"drivetrain": "FILE, or a name of the library (otherwise synthetic_2mw)"},
)
def run(run: Run, page: Page) -> None:
    """Count a computed shutdown beside what is stated; make events to what is stated; grid loss."""
    chosen = run.drivetrain(TWO_MW)
    chosen.state(page, topic="Torque cycles of a computed shutdown")
    with run.step("computed shutdown"):
        of = computed_stop(run, chosen)
    rows = [] if chosen.own else computed_rows(of)
    show_computed(page, of, rows)
    check_counts(page, of)
    if chosen.own:
        own_answer(page, of)
        return
    seeds = range(2 if run.quick else 50)
    for shaft in STATED:
        with run.step(f"{shaft} shaft"):
            found = [of_seed(shaft, seed) for seed in seeds]
        table(page, shaft, found)
    draw(page)
    with page.of(None):
        check_grid_loss(page)
        lost = check_energy(page)
    answer(page, lost, of, rows)


def answer(page: Page, lost: ConvergenceInTime, of: ComputedStop, rows: list[Record]) -> None:
    """State how many of the thesis's statements a computed shutdown meets."""
    tested = [row for row in rows if row["verdict"] != "not testable"]
    met = sum(row["verdict"] == "holds" for row in tested)
    ratio = of.ratio("slow", largest_range)
    low, high = (
        page.value(f"grid loss: {name}", lost.value(key))
        for name, key in (
            ("lowest torque over that before", LOWEST),
            ("highest torque of the swing back over that before", HIGHEST),
        )
    )
    page.answer(
        "Does a computed shutdown have the torque cycles that the thesis counted?",
        f"{met} of {len(tested)} testable statements hold: in a shutdown the low-speed shaft's "
        f"torque range is {formatted(ratio, 3)} times that of normal operation.",
        [
            page.value(
                "low-speed shaft: largest torque range, shutdown over normal operation",
                ratio,
                beside=8.0,
                by="thesis",
            ),
            page.value(
                "high-speed shaft: largest torque range in the shutdown [kN m]",
                largest_range(of.counts["fast", STATES[1]]),
                of.bands["fast"],
                beside=19.0,
                by="thesis",
            ),
            page.value(
                "high-speed shaft: equivalent torque, shutdown over normal operation",
                of.ratio("fast", equivalent),
                beside=3.65,
                by="thesis",
            ),
            low,
            high,
        ],
        hero=COMPUTED,
        cautions=[
            "The brake is sized to a printed peak, and the wind is simulated: measured records are "
            "private.",
            "Synthetic events below are made to have the thesis's ratios: they are no evidence for "
            "them.",
            "The thesis says nothing of grid loss, which is computed here with two masses on a "
            "shaft.",
        ],
        claim="holds" if met == len(tested) else "holds in part" if met else "does not hold",
    )


def own_answer(page: Page, of: ComputedStop) -> None:
    """State how much larger the torque cycles of a user's drivetrain are in a shutdown."""
    ratio = of.ratio("slow", largest_range)
    page.answer(
        "How much larger are cycles of torque in a shutdown than in normal operation?",
        f"The slow shaft's torque ranges {formatted(ratio, 3)} times as far in the shutdown as in "
        "normal operation.",
        [
            page.value("slow shaft: largest range, shutdown over normal", ratio),
            page.value("fast shaft: largest range", of.ratio("fast", largest_range)),
            page.value(
                "fast shaft: equivalent load, shutdown over normal", of.ratio("fast", equivalent)
            ),
        ],
        hero=COMPUTED,
        cautions=["Normal operation is that of a generic turbine in wind of 16 m/s."],
    )


def of_seed(shaft: str, seed: int) -> dict[str, Record]:
    """Statistics of each state."""
    return {s: counted(made_event(s, shaft, seed)) for s in STATED[shaft]}  # type: ignore[arg-type]


def counted(event: Event) -> Record:
    """Statistics of the cycles of a history that is followed by itself, as in the thesis."""
    cycles = rainflow_cycles(event.torque / 1e3, "repeated")
    seconds = float(event.time[-1])
    return {
        "largest range [kN m]": float(cycles.ranges.max()),
        "median range [kN m]": float(np.median(cycles.ranges)),
        "median mean [kN m]": float(np.median(cycles.means)),
        "least mean [kN m]": float(cycles.means.min()),
        "equivalent load, m = 6 [kN m]": float(
            (cycles.counts @ cycles.ranges**6 / seconds) ** (1 / 6)
        ),
        "duration [s]": seconds,
    }


def table(page: Page, shaft: str, found: list[dict[str, Record]]) -> None:
    """Statistics of made events, and ratios that they are drawn to: no checks of the thesis."""
    page.section(f"Made events, the {shaft} shaft")
    first = found[0]
    page.table(
        "Statistics of the first seed; rainflow counting, the history followed by itself",
        [{"state": state, **row} for state, row in first.items()],
    )
    page.data(f"{shaft} shaft", [{"state": s, **row} for s, row in first.items()])
    rows: list[Record] = []
    for state, values in STATED[shaft].items():
        for k, (quantity, value) in enumerate(zip(QUANTITIES, values, strict=True)):
            if value is None or value == 1.0:
                continue
            names = ("median range", "median mean", "least mean", "equivalent load, m = 6")
            key = f"{names[k]} [kN m]"
            over = "normal operation" if k == 1 else "emergency stop"
            ratios = [float(f[over][key]) / float(f[state][key]) for f in found]  # type: ignore[arg-type]
            rows.append(
                {
                    "state": state,
                    "ratio": quantity,
                    "drawn to": value,
                    "least": min(ratios),
                    "largest": max(ratios),
                }
            )
    page.table(f"Ratios that the events are drawn to, and those of {len(found)} seeds", rows)


def draw(page: Page) -> None:
    """Torque and thrust of each."""
    page.section("Histories")
    events = [made_event(s, "slow", 0) for s in ("start-up", "normal stop", "emergency stop")]
    events.append(grid_loss(similar_turbine(Rotor()), SHOWN))
    torque = chart(
        TORQUE,
        [trace(e.name, e.time, e.torque / 1e3) for e in events],
        "time [s]",
        "torque [kN m]",
    )
    page.add(mark_events(torque, {f"end of the {e.name}": float(e.time[-1]) for e in events[:3]}))
    page.chart(
        "Thrust over that of operation",
        [trace(e.name, e.time, e.thrust) for e in events],
        "time [s]",
        "thrust over that of operation [-]",
    )


def check_grid_loss(page: Page) -> None:
    """The first swing, without damping and before thrust falls."""
    turbine = replace(similar_turbine(Rotor()), shaft_damping=1e-3)
    event = grid_loss(turbine, 1e6, 0.2, 1000.0)
    whole = turbine.rotor_inertia + turbine.generator_inertia
    rate = np.sqrt(
        turbine.shaft_stiffness * whole / turbine.rotor_inertia / turbine.generator_inertia
    )
    share = turbine.generator_inertia / whole
    exact = share + (1.0 - share) * np.cos(rate * event.time)
    page.vanishes(
        "grid loss: torque less that of two undamped masses, over torque before, to 0.2 s",
        float(np.abs(event.torque / 1e6 - exact).max()),
        within=0.005,
        why="thrust has fallen by 1 % after 0.2 s, of which the generator's inertia takes a share",
        source="two masses on a spring, closed form",
    )


def check_energy(page: Page) -> ConvergenceInTime:
    """Energy of the grid loss that is shown, in the motion of rotor against generator."""
    turbine = similar_turbine(Rotor())
    k, c = turbine.shaft_stiffness, turbine.shaft_damping
    whole = turbine.rotor_inertia + turbine.generator_inertia
    share = turbine.generator_inertia / whole
    equations = equations_of_motion([share * turbine.rotor_inertia], spring_laws([[1.0]], k, c))

    def run(step: float, _: int) -> InTime:
        twist = grid_loss_twist(turbine, SHOWN, rate=1.0 / step)
        torque = (k * twist.angle + c * twist.speed) / SHOWN
        values = {
            LOWEST: -peak_between(-torque),
            HIGHEST: peak_between(torque[torque.argmin() :]),
        }
        loads = varying([share * SHOWN], twist.time, twist.thrust)
        moved = twist.angle[:, None], twist.speed[:, None]
        return InTime(values, energy_error(equations, loads, twist.time, *moved))

    found = converge_in_time(run, 2.5e-3)
    check_in_time(
        page,
        "grid loss",
        found,
        dict.fromkeys(found.finest.values, 0.005),
        energy=1e-6,
        why="integrals of the fourth order of the step, over what the shaft holds",
    )
    return found
