"""Whirl with internal damping: Zorzi and Nelson's shaft, and how many elements it needs."""

import time
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.published_rotors import (
    RPM,
    ZORZI_NELSON,
    ZORZI_NELSON_DAMPING,
    ZORZI_NELSON_LIMIT,
    ZORZI_NELSON_SPEEDS,
    PublishedRotor,
    criticals_rpm,
    input_rounding,
)
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics.whirl import (
    THEORIES,
    Theory,
    critical_speeds,
    rigid_rotor,
    stability_limit,
    whirl_chart,
)
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.studies import campbell_of

SOURCE = "Zorzi and Nelson 1977, as printed by VM261"
HERO = "Logarithmic decrements of the first whirls over the speed: internal damping alone"
ERRORS = "Error of the first forward critical speed against processor time, by elements and theory"
HIGHEST = 1.2e4 * RPM
"""Highest speed that is looked at [rad/s]."""
FORWARD = (1, 3)
"""Places of forward critical speeds among all."""
HALF_DIGITS = (("outer", 0.05), ("modulus", 0.05e11), ("density", 50.0), ("stiffness", 0.005e7))
"""Half of the last printed digit of each input."""
LOSS = 2e-4
"""Loss factor of the shaft with hysteresis."""


def uniform(elements: int) -> PublishedRotor:
    """The shaft in so many elements."""
    stations = tuple(np.linspace(0.0, ZORZI_NELSON.stations[-1], elements + 1).tolist())
    return replace(
        ZORZI_NELSON,
        stations=stations,
        outer=ZORZI_NELSON.outer[:1] * elements,
        bore=(0.0,) * elements,
        bearings=(0, elements),
    )


def forward_rpm(published: PublishedRotor, theory: Theory = "timoshenko") -> Floats:
    """Its first two forward critical speeds [rpm]."""
    found = [one for one in critical_speeds(published.rotor(theory), HIGHEST) if one.sense >= 0]
    return np.array([one.speed for one in found[:2]]) / RPM


@dataclass(frozen=True)
class Level:
    """Error of the first forward critical speed at a number of elements, and its time."""

    theory: Theory
    elements: int
    error: float
    seconds: float


def levels(most: int, repeats: int) -> list[Level]:
    """Errors against the finest Timoshenko shaft, of each theory and number of elements.

    Parameters
    ----------
    most : int
        Largest number of elements, a power of two; the reference has twice as many.
    repeats : int
        Times that each is solved, of which the shortest counts.
    """
    best = float(forward_rpm(uniform(2 * most))[0])
    counts = [2**k for k in range(1, int(np.log2(most)) + 1)]
    found = []
    for theory in THEORIES:
        for count in counts:
            seconds = []
            for _ in range(repeats):
                begin = time.process_time()
                # equal planes: of the Euler shaft both whirls have one speed, the second of a pair
                speed = float(criticals_rpm(uniform(count).rotor(theory))[1])
                seconds.append(time.process_time() - begin)
            found.append(Level(theory, count, abs(speed / best - 1), min(seconds)))
    return found


@case(
    "Whirl with internal damping: Zorzi and Nelson's shaft",
    source="Zorzi and Nelson 1977, as printed by VM261",
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Critical speeds, stability with internal damping, error against time."""
    shaft = uniform(16)
    with run.step("critical speeds"):
        speeds = forward_rpm(shaft)
        allowed = input_rounding(shaft, forward_rpm, HALF_DIGITS[1:])
        # one diameter, of all elements
        thicker = replace(shaft, outer=tuple(d + HALF_DIGITS[0][1] for d in shaft.outer))
        allowed = allowed + np.abs(forward_rpm(thicker) - speeds)
    with run.step("stability"):
        viscous = shaft.rotor("timoshenko", viscous=ZORZI_NELSON_DAMPING)
        hysteretic = shaft.rotor("timoshenko", loss_factor=LOSS)
        limits = [(stability_limit(one, HIGHEST) or np.nan) / RPM for one in (viscous, hysteretic)]
    with run.step("levels"):
        found = levels(8 if run.quick else 32, 1 if run.quick else 5)
    check_speeds(page, speeds, allowed)
    check_stability(page, limits, float(speeds[0]), float(allowed[0]))
    check_orders(page)
    answer(page, speeds, limits, found)
    page.section("Stability")
    show_decrements(page, viscous, run.quick)
    page.section("Whirl over the speed")
    over = np.linspace(HIGHEST / 24, HIGHEST, 24)
    met = (criticals_rpm(shaft.rotor("timoshenko"), count=4) * RPM).tolist()
    page.add(
        campbell_of(
            whirl_chart(shaft.rotor("timoshenko"), over.tolist(), 6),
            met,
            "Campbell diagram of Zorzi and Nelson's shaft: forward and backward whirl",
        )
    )
    page.section("Levels of the model")
    show_levels(page, found)


def check_orders(page: Page) -> None:
    """Order of each theory's error in the size of elements, against its own limit."""
    orders: tuple[tuple[Theory, float, str], ...] = (
        ("euler", 4.0, "consistent masses of cubic shapes: fourth order"),
        ("timoshenko", 2.0, "shear is constant in an element, which the inertia does not know"),
    )
    for theory, order, source in orders:
        counts = (4, 8, 16) if order > 3 else (8, 16, 32)
        best = float(criticals_rpm(uniform(8 * counts[-1] // 2).rotor(theory))[1])
        speeds = [float(criticals_rpm(uniform(count).rotor(theory))[1]) for count in counts]
        page.exponent(
            f"order of the critical speed's error in the size of elements, {theory}",
            [1 / count for count in counts],
            [abs(speed / best - 1) for speed in speeds],
            order,
            within=0.5,
            relative=False,
            why="the next order is in the coarsest of three numbers of elements, and the limit is "
            "one of four times as many as the finest",
            source=source,
        )


def check_speeds(page: Page, speeds: Floats, allowed: Floats) -> None:
    """Forward critical speeds against print."""
    for number, printed in enumerate(ZORZI_NELSON_SPEEDS):
        page.equals(
            f"forward critical speed {number + 1} [rpm]",
            float(speeds[number]),
            printed,
            within=float(allowed[number]) + 5.0,
            relative=False,
            why="half of the last printed digit of diameter, modulus, density and stiffness, in "
            "sum, and of the speed in tens",
            source=SOURCE,
            basis="second-hand",
        )


def check_stability(page: Page, limits: list[float], first: float, allowed: float) -> None:
    """Where whirl begins to grow with damping in the shaft alone."""
    page.equals(
        "speed from which whirl grows, internal viscous damping [rpm]",
        limits[0],
        ZORZI_NELSON_LIMIT,
        within=allowed + 5.0,
        relative=False,
        why="as the first forward critical speed; the source says about 5000 rpm",
        source=SOURCE,
        basis="second-hand",
    )
    for name, limit in zip(("viscous", "hysteretic"), limits, strict=True):
        page.equals(
            f"speed from which whirl grows over the first forward critical speed, {name} damping",
            limit / first,
            1.0,
            within=1e-4,
            why="of the second order in the damping ratio, some 1e-3 at these frequencies",
            source="damping of the turning shaft alone: it drives all forward whirl below its "
            "speed",
            measure="frequency",
        )


def show_decrements(page: Page, rotor: object, quick: bool) -> None:
    """Logarithmic decrements over the speed."""
    over = np.linspace(HIGHEST / 40, HIGHEST, 20 if quick else 60)
    chart = whirl_chart(rotor, over.tolist(), 4)  # type: ignore[arg-type]
    curves = [
        trace(
            f"{'forward' if chart.senses[1, k] > 0 else 'backward'} {k // 2 + 1}",
            chart.speeds[1:] / RPM,
            chart.decrements[1:, k],
        )
        for k in range(chart.decrements.shape[1])
    ]
    page.chart(
        HERO,
        curves,
        "speed [rpm]",
        "logarithmic decrement",
        events={"4950 rpm": ZORZI_NELSON_SPEEDS[0]},
    )


def show_levels(page: Page, found: list[Level]) -> None:
    """Error against time by theory and number of elements."""
    curves = [
        marked(
            theory,
            [one.seconds for one in found if one.theory == theory],
            [100 * one.error for one in found if one.theory == theory],
        )
        for theory in THEORIES
    ]
    page.chart(ERRORS, curves, "processor time [s]", "error [%]", logarithmic=("x", "y"))
    rows: list[Record] = [
        {
            "theory": one.theory,
            "elements": one.elements,
            "error [%]": 100 * one.error,
            "processor time [s]": one.seconds,
        }
        for one in found
    ]
    page.table("Levels: theory and number of elements", rows)


def answer(page: Page, speeds: Floats, limits: list[float], found: list[Level]) -> None:
    """State where the shaft whirls and where it loses its stability."""
    rigid = critical_speeds(rigid_rotor(uniform(16).rotor("timoshenko")), HIGHEST)
    few = min(one.elements for one in found if one.theory == "timoshenko" and one.error < 1e-3)
    page.answer(
        "Where does a shaft with internal damping lose its stability?",
        f"Internal damping makes the shaft unstable above {formatted(limits[0], 4)}\u00a0rpm, its "
        "first forward critical speed, as published.",
        [
            page.judged("forward critical speed 1", "forward critical speed 1", "published"),
            page.judged("forward critical speed 2", "forward critical speed 2", "published"),
            page.judged(
                "speed from which whirl grows, internal viscous damping",
                "limit of stability, viscous damping",
                "published",
            ),
            page.value("limit of stability, hysteretic damping [rpm]", limits[1]),
            page.value(
                "first critical speed of a rigid shaft [rpm]",
                rigid[0].speed / RPM,
                beside=float(speeds[0]),
                by="shaft that bends",
            ),
            page.value("elements needed for an error of the critical speed below 0.1 %", few),
        ],
        hero=HERO,
        cautions=["Bearings have no damping here: any damping of theirs raises the limit."],
    )
