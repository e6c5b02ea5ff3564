"""How much damping keeps a varying mesh from parametric resonance."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.mathieu import exact_growth, stepped_growth, varying_spring
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.dynamics import parametric_growth
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run

DEPTHS = (0.05, 0.1, 0.2, 0.4)
DAMPING = "damping ratio over a quarter of the stiffness's variation"
STEPS = 128
#: Variation that the answer is of.
ANSWERED = 0.2
STOPPED = "variation {}: damping ratio over e / 4 at which growth stops"
GROWTH = "Rate of growth over the damping, at twice the natural frequency; shaded: no growth"


def answer(page: Page, bounds: dict[float, float], undamped: dict[float, float]) -> None:
    """State the damping that stops growth, by variation; undamped are rates over e w / 4."""
    others = [e for e in bounds if e != ANSWERED]
    needed = {e: 100.0 * bounds[e] * e / 4.0 for e in (ANSWERED, *others)}
    grown = float(np.exp(2.0 * np.pi * undamped[ANSWERED] * ANSWERED / 4.0))
    page.answer(
        "How much damping stops a varying gear mesh stiffness from making vibration grow?",
        f"A mesh stiffness that varies by ±{100 * ANSWERED:g}\u00a0% at twice a natural frequency "
        f"needs {formatted(needed[ANSWERED], 3)}\u00a0% of critical damping; with less, vibration "
        "grows until the teeth separate.",
        [
            *(
                page.value(
                    f"damping needed, stiffness varying by ±{100 * e:g} % [%]",
                    rounded([percent], 3)[0],
                    beside=100.0 * e / 4.0,
                    by="first order",
                )
                for e, percent in needed.items()
            ),
            page.judged(
                STOPPED.format(ANSWERED),
                f"damping ratio over a quarter of the variation, ±{100 * ANSWERED:g} %",
                "first order",
            ),
            page.value(
                f"growth factor per natural period, undamped, ±{100 * ANSWERED:g} %",
                grown,
                beside=float(np.exp(np.pi * ANSWERED / 2.0)),
                by="first order",
            ),
        ],
        hero=GROWTH,
        cautions=[
            "Modes and frequency responses with a mean stiffness do not show this growth; only "
            "integration in time does."
        ],
    )


@case(
    "Parametric resonance of a varying mesh: damping that stops it",
    source="x'' + 2 z w x' + w^2 (1 + e cos 2 w t) x = 0: grows at w (e / 4 - z) to first order",
)
def run(run: Run, page: Page) -> None:
    """Growth over damping at twice the natural frequency."""
    over = np.linspace(0.0, 2.0, 9 if run.quick else 33)
    rates, bounds = {}, {}
    with run.step("growth"):
        for e in DEPTHS[1:3] if run.quick else DEPTHS:
            ratios = [float(z) * e / 4.0 for z in over]
            found = np.array([stepped_growth(e, 2.0, STEPS, ratio) for ratio in ratios])
            rates[e] = found / (e / 4.0)
            # the rate falls evenly: between the last that grows and the first that does not
            bounds[e] = float(np.interp(0.0, -rates[e], over))
    for e, bound in bounds.items():
        page.equals(
            STOPPED.format(e),
            bound,
            1.0,
            within=0.01 + e**2 / 8.0,
            why="the next order is of the square of the variation",
            source="averaging, first order in the variation",
        )
        page.equals(
            f"variation {e}: growth without damping by multipliers of exact steps [1/s]",
            max(parametric_growth(varying_spring(e, 2.0)).values()),
            exact_growth(e, 2.0),
            within=1e-3,
            why="steps are of second order",
            source="Mathieu's equation, an explicit method",
            measure="frequency",
        )
    page.limit(
        "a mesh whose stiffness varies at twice a natural frequency",
        DAMPING,
        low=1.0,
        criterion="motion does not grow",
        beyond="it grows by exp(pi e / 2) in each natural period without damping, until teeth part",
        program="integrates it as it is; frequency response and modes with a mean stiffness do not "
        "see it",
        remedy="damping, or a contact ratio nearer to a whole number",
    )
    answer(page, bounds, {e: float(rate[0]) for e, rate in rates.items()})
    page.say("The bound is a quarter of the variation, in any mesh.")
    page.section("Growth over damping")
    page.chart(
        GROWTH,
        [marked(f"e = {e}", over, rate) for e, rate in rates.items()]
        + [trace("first order", over, 1.0 - over, line={"dash": "dot"})],
        DAMPING,
        "rate of growth over e w / 4",
        safe=(1.0, None),
    )
    page.data("growth", {"damping": over, **{f"e = {e}": rate for e, rate in rates.items()}})
