"""A shutdown of the 2 MW drivetrain by its equations of motion, counted as the thesis counts."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.cases.references.operated_machines import (
    EVENT_STEP,
    PEAK,
    Rig,
    driving,
    rig_of,
    scaled_to,
    stop_values,
    turbine_in_wind,
)
from fe_drivetrain.cases.references.printed_values import against
from fe_drivetrain.common import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.dynamics import Level
from fe_drivetrain.report import chart, mark_events, trace
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.report.suite.chosen import ChosenDrivetrain
from fe_drivetrain.studies import LoadOptions, loads
from fe_drivetrain.studies.transient_runs import LevelRun
from fe_drivetrain.turbine_loads.histories import rainflow_cycles
from fe_drivetrain.turbine_loads.hub_loads import LoadHistory, write_hub_loads

TWO_MW = "synthetic_2mw"
STATES = ("normal operation", "emergency stop")
LASTING = 30.0
"""Length of the shutdown in the thesis [s]."""

SLOPE = 6.0
GATES = (1e-3, 1e-2, 5e-2)
"""Cycles that are left out of medians: below so much of the largest range of the shutdown."""

NEAR = 0.1
"""A stated ratio holds where ours is within so much of it."""

COMPUTED = "Torque of the slow shaft in the computed shutdown"
SMALL = "where small cycles are left out changes a median: the thesis does not say"
SIZED = f"brake sized to the printed peak of {PEAK}; the swing after the generator's loss adds"


@dataclass(frozen=True, eq=False)
class Counts:
    """Torque of a shaft in a state, counted.

    Attributes
    ----------
    ranges, means : ndarray, (n,)
        Ranges and means of rainflow cycles, the history followed by itself [kN m].
    equivalent : float
        Damage-equivalent load at 1 Hz, slope 6, by the study ``loads`` [kN m].
    """

    ranges: Floats
    means: Floats
    equivalent: float

    def medians(self, gate: float) -> tuple[float, float]:
        """Median range and mean of cycles of at least a range [kN m]."""
        kept = self.ranges >= gate
        return float(np.median(self.ranges[kept])), float(np.median(self.means[kept]))


@dataclass(frozen=True, eq=False)
class ComputedStop:
    """Both states of a drivetrain, counted by shaft: "slow" and "fast".

    Attributes
    ----------
    runs : dict[str, LevelRun]
        Each state.
    channels : dict[str, str]
        Torque of each shaft.
    counts : dict[tuple[str, str], Counts]
        By shaft and state.
    other : dict[tuple[str, str], list[Counts]]
        The same with other winds, other instants of the brake, and another brake.
    bands : dict[str, float]
        What the step leaves uncertain of the largest range in the shutdown, by shaft [kN m].
    """

    runs: dict[str, LevelRun]
    channels: dict[str, str]
    counts: dict[tuple[str, str], Counts]
    other: dict[tuple[str, str], list[Counts]]
    bands: dict[str, float]

    def ratio(self, shaft: str, value: Callable[[Counts], float]) -> float:
        """Value of the shutdown over that of normal operation."""
        normal, stop = (value(self.counts[shaft, state]) for state in STATES)
        return stop / normal

    def span(self, shaft: str, value: Callable[[Counts], float]) -> tuple[float, float]:
        """Least and largest value of the shutdown over that of normal operation, of all runs."""
        normal, stop = (
            [value(one) for one in (self.counts[shaft, state], *self.other[shaft, state])]
            for state in STATES
        )
        return min(stop) / max(normal), max(stop) / min(normal)


def largest_range(of: Counts) -> float:
    """Largest range [kN m]."""
    return float(of.ranges.max())


def equivalent(of: Counts) -> float:
    """Damage-equivalent load [kN m]."""
    return of.equivalent


def computed_stop(run: Run, chosen: ChosenDrivetrain) -> ComputedStop:
    """Run both states by bodies that turn, write their torque, and count it by ``loads``.

    Parameters
    ----------
    run : Run
        Its folder takes the records.
    chosen : ChosenDrivetrain
        The drivetrain.
    """
    drivetrain, speed = chosen.drivetrain, chosen.rotor_speeds()[1]
    power = chosen.rated_torque() * speed
    rig: Rig = rig_of(drivetrain, Level.TORSIONAL)
    values = stop_values(drivetrain, rig)
    made = driving(scaled_to(turbine_in_wind(), power, speed))
    both = rig.normal(made), rig.stop(values, duration=LASTING)
    runs = dict(zip(STATES, both, strict=True))
    shafts = rig.machine.shafts
    channels = {"slow": f"torque of {shafts[0].name}", "fast": f"torque of {shafts[-1].name}"}
    counts = {
        (shaft, state): counted_record(
            runs[state].samples.times,
            runs[state].samples.of(channel),
            run.folder / f"{state}_{shaft}_shaft.csv".replace(" ", "_"),
        )
        for shaft, channel in channels.items()
        for state in STATES
    }
    others = {
        STATES[0]: other_winds(rig, power, speed, run.quick),
        STATES[1]: other_stops(rig, values, run.quick),
    }
    other = {
        (shaft, state): [summed(one, channel) for one in found]
        for shaft, channel in channels.items()
        for state, found in others.items()
    }
    coarse = rig.stop(values, 2.0 * EVENT_STEP, LASTING)
    bands = {
        shaft: abs(largest_range(summed(coarse, channel)) - largest_range(counts[shaft, STATES[1]]))
        for shaft, channel in channels.items()
    }
    return ComputedStop(runs, channels, counts, other, bands)


WINDS = (("high", 1), ("low", 1), ("medium", 2), ("high", 2))
"""Turbulence and seed of other winds."""

LATER = (0.1, 0.2, 0.3)
"""How much later the brake comes, within a swing of 0.42 s [s]."""


def other_winds(rig: Rig, power: float, speed: float, quick: bool) -> list[LevelRun]:
    """Normal operation in other winds; in the first of them where `quick`."""
    winds = WINDS[: 1 if quick else None]
    made = [turbine_in_wind(turbulence=kind, seed=seed) for kind, seed in winds]
    return [rig.normal(driving(scaled_to(one, power, speed))) for one in made]


def other_stops(rig: Rig, values: dict[str, float | str], quick: bool) -> list[LevelRun]:
    """Stops with the brake later, and with a brake half as strong; two where `quick`."""
    changed: list[dict[str, float | str]] = [{"brake": 0.5 * float(values["brake"])}]
    changed += [{"braked": 3.0 + late} for late in LATER]
    return [
        rig.stop({**values, **one}, duration=LASTING) for one in changed[: 2 if quick else None]
    ]


def summed(run: LevelRun, channel: str) -> Counts:
    """Cycles of a torque and their equivalent load, without a record."""
    cycles = rainflow_cycles(run.samples.of(channel) / 1e3, "repeated")
    return Counts(cycles.ranges, cycles.means, equivalent_of(cycles.ranges, run.samples.times))


def equivalent_of(ranges: Floats, times: Floats) -> float:
    """Damage-equivalent load of whole cycles at 1 Hz [kN m]."""
    return float(((ranges**SLOPE).sum() / float(times[-1] - times[0])) ** (1.0 / SLOPE))


def counted_record(times: Floats, torque: Floats, file: Path) -> Counts:
    """Write a record of torque, and count it.

    Parameters
    ----------
    times, torque : ndarray, (n,)
        Even steps [s], torque [N m].
    file : Path
        Takes the record.
    """
    even = np.linspace(times[0], times[-1], len(times))
    table = np.full((len(even), 6), np.nan)
    table[:, FORCES.index("Mx")] = np.interp(even, times, torque)
    write_hub_loads(LoadHistory(file.stem, even - even[0], table, measured=True), file)
    found = loads(file, LoadOptions(slopes=(SLOPE,), residue="repeated"))
    cycles = rainflow_cycles(table[:, FORCES.index("Mx")] / 1e3, "repeated")
    return Counts(cycles.ranges, cycles.means, found.equivalent_loads["Mx"][SLOPE].load / 1e3)


def computed_rows(of: ComputedStop) -> list[Record]:
    """What the thesis says of the shutdown against normal operation, beside ours, with verdicts."""
    return [
        row
        for shaft, stated in STATED_OF_SHUTDOWN.items()
        for row in (
            *ranges_of(of, shaft, *stated.ranges),
            *medians_of(of, shaft, *stated.medians),
            *signs_of(of, shaft, stated.equivalent),
        )
    ]


@dataclass(frozen=True)
class Stated:
    """What the thesis states of a shaft.

    Attributes
    ----------
    ranges : tuple of float
        Largest range in normal operation and in the shutdown [kN m].
    medians : tuple of float
        Median range, shutdown over normal; median mean, normal over shutdown.
    equivalent : float
        Damage-equivalent load, shutdown over normal.
    """

    ranges: tuple[float, float]
    medians: tuple[float, float]
    equivalent: float


STATED_OF_SHUTDOWN = {
    "fast": Stated((3.8, 19.0), (5.0, 2.0), 3.65),
    "slow": Stated((250.0, 2000.0), (8.9, 2.2), 3.65),
}
"""Al-Hamadani 2018, section 3.4."""


def row_of(words: str, printed: str, ours: str, stands: str, reason: str) -> Record:
    """A statement with its verdict."""
    return {
        "statement": words,
        "printed": printed,
        "ours": ours,
        "verdict": stands,
        "reason": reason,
    }


def by_guesses(span: tuple[float, float]) -> str:
    """What wind and brake do to a ratio, in words."""
    return f"{span[0]:.3g} to {span[1]:.3g} by wind, brake and its instant"


def ranges_of(of: ComputedStop, shaft: str, normal: float, stop: float) -> list[Record]:
    """Largest ranges of both states, and their ratio."""
    ours = [float(of.counts[shaft, state].ranges.max()) for state in STATES]
    words = f"{shaft} shaft: largest range"
    ratio = ours[1] / ours[0]
    span = of.span(shaft, largest_range)
    return [
        row_of(
            f"{words}, normal operation",
            f"{normal:g} kN m",
            f"{ours[0]:.3g} kN m",
            "not testable",
            "of the measured record; ours is of simulated wind of 16 m/s, 20 s",
        ),
        row_of(
            f"{words}, shutdown",
            f"above {stop:g} kN m",
            f"{ours[1]:.4g} kN m",
            "holds" if ours[1] > stop else "does not hold",
            SIZED,
        ),
        row_of(
            f"{words}, shutdown over normal",
            f"{round(stop / normal)}",
            f"{ratio:.2f}",
            against(ratio, stop / normal, span, NEAR),
            by_guesses(span),
        ),
    ]


def medians_of(of: ComputedStop, shaft: str, ranges: float, means: float) -> list[Record]:
    """Ratios of medians, with several least ranges."""
    normal, stop = (of.counts[shaft, state] for state in STATES)
    largest = float(stop.ranges.max())
    found = []
    for gate in GATES:
        (range_n, mean_n), (range_s, mean_s) = (
            one.medians(gate * largest) if (one.ranges >= gate * largest).any() else (np.nan,) * 2
            for one in (normal, stop)
        )
        found.append((range_s / range_n, mean_n / mean_s))
    return [
        row_of(
            f"{shaft} shaft: median {name}",
            f"{printed:g}",
            ", ".join(f"{pair[k]:.3g}" for pair in found if np.isfinite(pair[k])),
            "not testable",
            SMALL,
        )
        for k, (name, printed) in enumerate(
            (
                ("range, shutdown over normal", ranges),
                ("mean, normal over shutdown", means),
            )
        )
    ]


def signs_of(of: ComputedStop, shaft: str, printed: float) -> list[Record]:
    """Reversal, mean above rated, and equivalent load."""
    normal, stop = (of.counts[shaft, state] for state in STATES)
    rated = of.runs[STATES[1]].extremes[of.channels[shaft]].rated / 1e3
    ratio, span = stop.equivalent / normal.equivalent, of.span(shaft, equivalent)
    least, most = float(stop.means.min()), float(stop.means.max())
    large = stop.ranges >= GATES[1] * stop.ranges.max()
    found = [
        row_of(
            f"{shaft} shaft: means turn negative in the shutdown, not in normal operation",
            "yes",
            f"{least:.3g} kN m against {float(normal.means.min()):.3g} kN m",
            "holds" if least < 0.0 < float(normal.means.min()) else "does not hold",
            "the shaft unwinds when the generator lets go",
        ),
        row_of(
            f"{shaft} shaft: largest mean over rated torque, shutdown",
            "up to 1.3",
            f"{float(stop.means[large].max()) / rated:.2f}; of small cycles {most / rated:.2f}",
            "not testable",
            "small cycles at the top of a swing have the largest means; see medians",
        ),
        row_of(
            f"{shaft} shaft: equivalent load, shutdown over normal",
            f"{printed:g}",
            f"{ratio:.2f}",
            against(ratio, printed, span, NEAR),
            f"{by_guesses(span)}; his Eq 3.6 takes means of cycles in place of ranges",
        ),
    ]
    if shaft == "fast":
        least_of_all = [float(one.means.min()) for one in of.other[shaft, STATES[1]]]
        low, high = min(least, *least_of_all), max(least, *least_of_all)
        found.append(
            row_of(
                "fast shaft: least mean in the shutdown",
                "-4 kN m",
                f"{least:.3g} kN m",
                against(least, -4.0, (low, high), NEAR),
                f"one small cycle at the bottom of a swing; {low:.3g} to {high:.3g} by the brake",
            )
        )
    return found


def show_computed(page: Page, of: ComputedStop, rows: list[Record]) -> None:
    """Show both torques, and each statement with its verdict."""
    page.section("The computed shutdown")
    run = of.runs[STATES[1]]
    traces = [
        trace(f"{shaft} shaft", *scaled_course(run, channel))
        for shaft, channel in of.channels.items()
    ]
    page.add(mark_events(chart(COMPUTED, traces, "time [s]", "torque over rated"), run.marks))
    if not rows:
        return
    page.table("Printed, ours, verdict", rows)
    page.data("computed shutdown", rows)
    page.text(
        "Start-up and normal stop are left out: they are those of a controller of which the thesis "
        "says nothing, so that its ratios to them (1.3 and 1.76, 1.92 and 2.47, 4 and 5.8, 1.1 and "
        "1.43) cannot be tested. Records of torque are among the files of this page; the study "
        "``loads`` counts them."
    )


def scaled_course(run: LevelRun, channel: str) -> tuple[Floats, Floats]:
    """Times and torque over rated."""
    times, values = run.samples.course(channel, 3000)
    return times, values / run.extremes[channel].rated


def check_counts(page: Page, of: ComputedStop) -> None:
    """Check equivalent loads of the study against whole cycles summed, and bands by the step."""
    for shaft, band in of.bands.items():
        page.at_most(
            f"{shaft} shaft: change of the largest range with twice the step, over it",
            band / largest_range(of.counts[shaft, STATES[1]]),
            0.01,
            why="steps are some hundredth of a period of the first mode",
            source="twice the step",
            basis="self-consistency",
        )
    for (shaft, state), one in of.counts.items():
        page.equals(
            f"{shaft} shaft, {state}: equivalent load [kN m]",
            one.equivalent,
            equivalent_of(one.ranges, of.runs[state].samples.times),
            within=1e-3,
            why="the study's length of a record is one step longer",
            source="whole cycles summed",
        )
