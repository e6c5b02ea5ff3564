"""Parametric resonance: one mesh whose stiffness varies, against Mathieu's equation."""

from functools import partial

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.mathieu import exact_growth, stepped_growth
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import InTime, converge_in_time
from fe_drivetrain.dynamics import (
    State,
    equations_of_motion,
    fourier_wave,
    integrate,
    spring_laws,
    steady,
)
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.suite import Page, Record, Run, check_in_time

DEPTHS = (0.02, 0.05, 0.1, 0.2)
STEPS = 128
"""Steps in a period of the mesh."""


GROWTH = "growth [1/s]"
TONGUE = "Rate of growth beside twice the natural frequency, variation ±{}, w = 1 rad/s"


def growth_in_time(depth: float, step: float, _: int) -> InTime:
    """Rate of growth of Mathieu's equation, and the error of the energy over ten periods."""
    period = 2.0 * np.pi / 2.0
    wave = fourier_wave([depth], [0.0])
    one = equations_of_motion(
        [1.0], spring_laws([[1.0]], 1.0).in_phase(frequency=1.0 / period).with_waves([wave])
    )
    start = State(np.ones(1), np.zeros(1), np.zeros(1))
    motion = integrate(one, steady([0.0]), 10.0 * period, step, start=start)
    growth = stepped_growth(depth, 2.0, round(period / step))
    return InTime({GROWTH: growth}, motion.relative_imbalance, motion.converged)


def check_growth(page: Page, depth: float) -> Record:
    """Check the growth at twice the natural frequency against Floquet's multiplier."""
    found, right = stepped_growth(depth, 2.0, STEPS), exact_growth(depth, 2.0)
    page.equals(
        f"depth {depth}: growth at twice the natural frequency [1/s]",
        found,
        right,
        within=2e-3,
        why=f"{STEPS} steps in a period of the mesh leave a thousandth of its square",
        source="Floquet multiplier of Mathieu's equation by an explicit method of order 8",
        measure="frequency",
    )
    return {
        "depth of the variation": depth,
        "growth [1/s]": found,
        "Floquet [1/s]": right,
        "first order, e w / 4 [1/s]": depth / 4.0,
    }


@case(
    "A mesh whose stiffness varies: growth of Mathieu's equation, bounds of the resonance",
    source="x'' + w^2 (1 + e cos W t) x = 0: McLachlan 1947; first order in e: e w / 4 at W = 2 w",
)
def run(run: Run, page: Page) -> None:
    """Growth at and beside twice the natural frequency."""
    with run.step("growth at twice the natural frequency"):
        rows = [check_growth(page, depth) for depth in (DEPTHS[1:] if run.quick else DEPTHS)]
    slope = rows[0]["growth [1/s]"] / rows[0]["first order, e w / 4 [1/s]"]
    page.equals(
        "growth over e w / 4, least depth",
        slope,
        1.0,
        within=1e-2,
        why="the next order is of the square of the depth",
        source="averaging, first order in the depth",
    )
    depth = 0.1
    page.section("Over the step")
    series = converge_in_time(partial(growth_in_time, depth), 2.0 * np.pi / 2.0 / STEPS)
    check_in_time(
        page,
        f"depth {depth}, twice the natural frequency",
        series,
        {GROWTH: 1e-2},
        energy=1e-2,
        why="what the clock of the stiffness puts in, by trapezia over the step",
    )
    at = np.linspace(1.9, 2.1, 10 if run.quick else 40)
    with run.step("tongue"):
        ours = np.array([stepped_growth(depth, float(W), STEPS) for W in at])
        exact = np.array([exact_growth(depth, float(W)) for W in at])
    inside = np.abs(at - 2.0) < depth / 2.0
    page.holds(
        f"depth {depth}: motion grows where |W - 2 w| < e w / 2, and is bounded elsewhere",
        bool((ours[inside] > 1e-3).all() and (np.abs(ours[~inside]) < 1e-3).all()),
        why="the edges are that far but for the square of the depth",
        source="averaging, first order in the depth",
    )
    answer(page, depth)
    show(page, depth, rows, at, ours, exact)


def answer(page: Page, depth: float) -> None:
    """State how fast motion grows at twice the natural frequency, and what stops it."""
    growth = stepped_growth(depth, 2.0, STEPS)
    more = 100.0 * float(np.expm1(2.0 * np.pi * growth))
    page.answer(
        "How fast does motion grow when a mesh stiffness varies at twice the natural frequency?",
        f"A stiffness variation of ±{100 * depth:g}\u00a0% makes motion grow by {more:.0f}\u00a0% "
        f"in each natural period; a damping ratio of {depth / 4:g} stops the growth.",
        [
            page.value(f"growth in a natural period, variation ±{depth} [%]", more),
            *(
                page.judged(
                    f"depth {one}: growth at twice the natural frequency",
                    f"rate of growth, variation ±{one}",
                    "Floquet",
                )
                for one in DEPTHS[1:]
            ),
            page.judged(
                "growth over e w / 4, least depth",
                "rate of growth over theory for small variations, e w / 4",
                "averaging",
            ),
        ],
        TONGUE.format(depth),
    )


def show(
    page: Page, depth: float, rows: list[Record], at: Floats, ours: Floats, exact: Floats
) -> None:
    """Show the rates of growth at and beside twice the natural frequency."""
    page.section("At twice the natural frequency")
    page.table("Rate of growth for w = 1 rad/s", rows)
    page.section("Beside it")
    low = np.sqrt(np.maximum(depth**2 / 16.0 - (at / 2.0 - 1.0) ** 2, 0.0))
    page.chart(
        TONGUE.format(depth),
        [
            marked("time integration", at, ours),
            trace("Floquet", at, exact),
            trace("first order", at, low, line={"dash": "dot"}),
        ],
        "frequency of the mesh over the natural frequency",
        "growth [1/s]",
        beside="Floquet",
    )
    page.data("tongue", {"W": at, "growth": ours, "exact": exact})
