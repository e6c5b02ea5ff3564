"""Stress at fillets as their radius goes to zero, in thin tubes, and in threads of grooves."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import decades, safe_range
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.strength import (
    LOADS,
    FilletFactor,
    Shoulder,
    fillet_factor,
    shouldered,
    turned_factors,
)

STEP = 1.2
FIVE_PERCENT = 0.05
RADIUS, BORE = "radius over diameter", "bore over diameter"
SHARP = "Stress concentration as the radius goes to zero"
THIN = "Error of the formulas of solid shafts where the shaft is bored; shaded: below 5 %"
#: Stress grows as the radius to minus these: of a corner of 270 deg, with stress r^(lambda - 1).
#: In plane strain lambda is the root of sin(3 pi lambda / 2) = -lambda sin(3 pi / 2); in
#: torsion 2/3.
WILLIAMS = {"tension": 1.0 - 0.5444837, "bending": 1.0 - 0.5444837, "torsion": 1.0 / 3.0}
#: Largest radius of the fit, over the height of the step.
SMALL = 0.05


def sharp_factors(radii: Floats) -> list[tuple[float, dict[str, FilletFactor]]]:
    """Factors of a step with ever smaller fillets."""
    return [
        (r, {load: fillet_factor(load, Shoulder(1.0, STEP, r)) for load in LOADS})
        for r in radii.tolist()
    ]


@case(
    "Fillets of a shaft: the radius to zero, thin tubes",
    source="Williams 1952: orders of stress at a corner; DIN 743-2 for the formulas",
)
def run(run: Run, page: Page) -> None:
    """Sweep the radius of a fillet over decades, then the bore of the shaft."""
    with run.step("radius to zero"):
        slopes, band = radius_to_zero(page, decades(-4, -1, 3 if run.quick else 6))
    with run.step("thin tubes"):
        last = thin_tubes(page, (0.0, 0.5, 0.7, 0.8, 0.9, 0.95))
    answer(page, slopes, last, band)
    page.image("The shoulder", run.sketch(shouldered(Shoulder(1.0, STEP, 0.05))))


def radius_to_zero(page: Page, radii: Floats) -> tuple[dict[str, float], float]:
    """Exponents of the stress in the radius; the largest band of a factor."""
    found = sharp_factors(radii)
    rows: list[Record] = []
    for r, factors in found:
        formula = dict(
            zip(LOADS, turned_factors("shoulder", 1.0, 0.5 * (STEP - 1.0), r), strict=True)
        )
        for load, one in factors.items():
            rows.append(
                {
                    "load": load,
                    RADIUS: r,
                    "K_t": one.peak.factor,
                    "± K_t": one.band,
                    "by formula": float(formula[load]),
                    "formula, error [%]": 100.0 * (float(formula[load]) / one.peak.factor - 1.0),
                }
            )
    slopes = {}
    small = radii <= SMALL * 0.5 * (STEP - 1.0)
    for load in LOADS:
        values = np.array([factors[load].peak.factor for _, factors in found])
        slopes[load] = -page.exponent(
            f"K_t over the radius in {load}, to its exponent",
            radii[small],
            values[small],
            -WILLIAMS[load],
            within=0.02,
            relative=False,
            why="the exponent of a sharp corner, to what the next term of its series leaves at "
            "radii of 1 to 50 thousandths of the step",
            source="Williams 1952, corner of 270 degrees",
        )
    band = max(float(one.band / one.peak.factor) for _, f in found for one in f.values())
    page.at_most(
        "largest band of any factor, relative [-]",
        band,
        5e-3,
        why="half a per cent, far below what the formulas differ by",
        source="the same with three quarters of the elements along the fillet",
    )
    page.limit(
        "stress at a fillet by elasticity of its meridian",
        RADIUS,
        low=float(radii[0]),
        high=float(radii[-1]),
        criterion="band below 0.5 %",
        beyond="stress grows without end: a sharp corner has none that could be assessed",
        program="names a step without a fillet, and does not rate it",
        remedy="state the fillet that is on the drawing",
    )
    page.section("Radius to zero")
    page.sweep(SHARP, rows, RADIUS, "K_t", by="load", log="xy")
    return slopes, band


def thin_tubes(page: Page, bores: tuple[float, ...]) -> float:
    """Largest bore up to which formulas of solid shafts hold 5 %, with their error when solid."""
    rows: list[Record] = []
    errors: dict[str, list[float]] = {load: [] for load in LOADS}
    for bore in bores:
        step = Shoulder(1.0, STEP, 0.05, bore, bore)
        formula = turned_factors("shoulder", 1.0, step.depth, step.radius)
        for k, load in enumerate(LOADS):
            one = fillet_factor(load, step)
            error = abs(float(formula[k]) / one.peak.factor - 1.0)
            errors[load].append(error)
            rows.append(
                {
                    "load": load,
                    BORE: bore,
                    "K_t": one.peak.factor,
                    "± K_t": one.band,
                    "by formula": float(formula[k]),
                    "error": error,
                }
            )
    worst = np.max([errors[load] for load in LOADS], axis=0)
    _, high = safe_range(np.array(bores), worst, FIVE_PERCENT)
    last = float(bores[-1]) if high is None else float(high)
    page.limit(
        "stress concentration of a bored shaft by formulas of solid ones",
        BORE,
        low=0.0,
        high=last,
        criterion="error below 5 %",
        beyond="the wall bends by itself beside the step, which a solid shaft cannot",
        program="solves the step with its bore by elasticity, but for --formulas",
        remedy="leave --formulas out",
    )
    page.section("Thin tubes")
    page.sweep(THIN, rows, BORE, "error", by="load", log="y", safe=(0.0, last))
    return last


def answer(page: Page, slopes: dict[str, float], last: float, band: float) -> None:
    """State how stress grows, and where formulas end."""
    page.answer(
        "How does stress grow at a small fillet, and up to which bore do formulas apply?",
        f"Halving a very small radius raises the bending stress by "
        f"{100 * (2 ** slopes['bending'] - 1):.0f}\u00a0%; formulas for solid shafts are within "
        f"5\u00a0% up to a bore of {last:.2g} diameters.",
        [
            page.value("exponent of 1/radius, tension", round(slopes["tension"], 3)),
            page.value("exponent of 1/radius, bending", round(slopes["bending"], 3)),
            page.value("exponent of 1/radius, torsion", round(slopes["torsion"], 3)),
            page.value("bore over diameter up to which formulas are within 5 %", last),
            page.value("largest uncertainty of a stress concentration factor [%]", 100 * band),
        ],
        hero=SHARP,
        cautions=[
            "Radii below a thousandth of the step are for study only: no drawing has such a fillet."
        ],
    )
