"""How much damping keeps a varying mesh from parametric resonance."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.mathieu import stepped_growth
from fe_drivetrain.report import marked, trace
from fe_drivetrain.report.suite import Page, Run

DEPTHS = (0.05, 0.1, 0.2, 0.4)
DAMPING = "damping ratio over a quarter of the stiffness's variation"
STEPS = 128


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
            f"variation {e}: damping ratio over e / 4 at which growth stops",
            bound,
            1.0,
            within=0.01 + e**2 / 8.0,
            why="the next order is of the square of the variation",
            source="averaging, first order in the variation",
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
    page.say(
        "A stiffness that varies by e of its mean at twice a natural frequency makes motion grow "
        "unless the damping ratio exceeds e / 4: with e = 0.2, 5 % of critical damping.",
    )
    page.section("Growth over damping")
    page.chart(
        "Rate of growth over e w / 4, at twice the natural frequency; shaded: no growth",
        [marked(f"e = {e}", over, rate) for e, rate in rates.items()]
        + [trace("first order", over, 1.0 - over, line={"dash": "dot"})],
        DAMPING,
        "rate of growth over e w / 4",
        safe=(1.0, None),
    )
    page.data("growth", {"damping": over, **{f"e = {e}": rate for e, rate in rates.items()}})
