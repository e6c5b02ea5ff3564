"""Stress concentration of shoulder fillets of a shaft, against the published fits."""

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from fe_drivetrain.cases import cases
from fe_drivetrain.cases.references.fillet_factors import (
    PETERSON,
    TIPTON,
    Factor,
    Formula,
    factor,
    of_a_fit,
    peterson,
    published_scatter,
    shouldered,
    tipton,
)
from fe_drivetrain.plots import PALETTE
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run

CHARTS = {"torsion": "The chart is from a mathematical analysis; its fit is within 5 % of it."}
CURVES = "Stress concentration in {}: computed, and as published"
#: r/d of the sweep.
RADII = (0.03, 0.05, 0.12, 0.2, 0.3)

#: By load: source, formula, tolerance of (load, D/d, r/d), and why.
Published = Sequence[tuple[str, Formula, Formula, str]]
OF_TWO_FITS: Published = (
    (
        PETERSON,
        peterson,
        published_scatter,
        "the charts are drawn from photoelastic tests: allowed is what their fit differs from the "
        "published formula for finite elements by, and the 5 % of that formula",
    ),
    (
        TIPTON,
        tipton,
        of_a_fit,
        "a formula of nine constants through the results of finite elements, for D/d from just "
        "above 1 to 6: an error of a few per cent by itself",
    ),
)
PUBLISHED: Mapping[str, Published] = {
    "tension": OF_TWO_FITS,
    "bending": OF_TWO_FITS,
    "torsion": (
        (
            PETERSON,
            peterson,
            of_a_fit,
            "the fit of a chart that is from a mathematical analysis, not measured (section 3.2 "
            "of that book), within 5 % of it",
        ),
    ),
}


def deviations(load: str, factors: Sequence[Factor], formula: Formula) -> Any:
    """Published over computed, less 1 [%]."""
    return 100.0 * np.array(
        [formula(load, f.wide, f.radius) / f.peak.factor - 1.0 for f in factors]
    )


@cases("fillets.yaml")
def run(run: Run, page: Page, row: Mapping[str, Any]) -> None:
    """Sweep the step and the fillet under one load."""
    load, judged = row["load"], [tuple(pair) for pair in row["judged"]]
    pairs = judged if run.quick else [(wide, radius) for wide in row["steps"] for radius in RADII]
    with run.step("mesh and solve every shoulder"):
        # those that leave room for the fillet and are in the fit's range
        factors = [
            factor(load, wide, radius)
            for wide, radius in pairs
            if radius <= (wide - 1.0) / 2.0 and not math.isnan(peterson(load, wide, radius))
        ]
    check(page, load, factors, judged)
    answer(page, row["question"], load, factors)
    page.section("Result")
    add_curves(page, load, factors)
    add_profile(page, factors)
    page.section("Details")
    page.text(
        "Solid shaft, nominal stress in the thinner diameter d; far ends carry the exact stresses "
        "of a uniform shaft, so that nothing is held rigidly. Fifth-order curved triangles in the "
        "meridian, harmonic 0 or 1 round the axis, finest along the fillet. The band is what a "
        "third more elements along the fillet changed. Peterson's curves are fits to charts, whose "
        "own sources are photoelastic tests and early computations."
    )
    rows = [shoulder(load, f) for f in factors]
    page.table("Every shoulder", rows)
    f = _sharpest(factors)
    page.image("The sharpest of the shoulders", run.sketch(shouldered(f.wide, f.radius)))
    page.data(f"shoulders in {load}", rows)


def answer(page: Page, question: str, load: str, factors: Sequence[Factor]) -> None:
    """State how far the published fits are from the finite elements, and the worst shoulder."""
    fits = {"Peterson": deviations(load, factors, peterson)}
    if len(PUBLISHED[load]) == 2:
        fits["Tipton"] = deviations(load, factors, tipton)
    off = fits["Peterson"]
    worst = int(np.abs(off).argmax())
    f, mean, most = factors[worst], float(off.mean()), float(off[worst])
    peak = {name: float(np.abs(of).max()) for name, of in fits.items()}
    other = f"; Tipton's formula is within {peak['Tipton']:.2g} %" if "Tipton" in fits else ""
    page.answer(
        question,
        f"In {load} Peterson's chart is {_too(mean)} on average and {_too(most)} at worst{other}.",
        [
            page.value("Peterson's fit, mean difference [%]", mean),
            page.value("Peterson's fit, worst difference [%]", most),
            *(
                page.value(f"{name}'s fit, worst difference [%]", peak[name])
                for name in [*fits][1:]
            ),
            page.value(
                f"K_t at D/d = {f.wide:g}, r/d = {f.radius:g}",
                f.peak.factor,
                f.band,
                beside=peterson(load, f.wide, f.radius),
                by="Peterson",
            ),
            page.value("shoulders compared", len(factors)),
        ],
        hero=CURVES.format(load),
        cautions=[CHARTS.get(load, "The charts are drawn from photoelastic tests.")],
    )


def _too(difference: float) -> str:
    """A difference [%] in words."""
    return f"{abs(difference):.2g} % too {'low' if difference < 0 else 'high'}"


def _sharpest(factors: Sequence[Factor]) -> Factor:
    return min(factors, key=lambda f: (f.radius, -f.wide))


def check(page: Page, load: str, factors: Sequence[Factor], judged: Sequence[Any]) -> None:
    """Chosen geometries against each published formula, and how well resolved all are."""
    for f in factors:
        if (f.wide, f.radius) not in judged:
            continue
        for source, formula, tolerance, why in PUBLISHED[load]:
            page.equals(
                f"K_t, D/d = {f.wide:g}, r/d = {f.radius:g} [-]",
                f.peak.factor,
                formula(load, f.wide, f.radius),
                within=tolerance(load, f.wide, f.radius),
                why=why,
                source=source,
                measure="stress",
                band=f.band,
            )
    page.at_most(
        "largest band of any K_t, relative [-]",
        max(f.band / f.peak.factor for f in factors),
        1e-3,
        why="a tenth of a per cent, so that any larger difference is due to the formulae",
        source="the same with three quarters of the elements along the fillet",
    )


def shoulder(load: str, f: Factor) -> Record:
    """One geometry beside the two fits; None outside a fit's range."""

    def known(formula: Formula, of: Callable[[float], float]) -> float | None:
        value = formula(load, f.wide, f.radius)
        return None if math.isnan(value) else of(value)

    return {
        "D/d [-]": f.wide,
        "r/d [-]": f.radius,
        "K_t computed [-]": f.peak.factor,
        "band [-]": f.band,
        "where on the arc [deg]": f.peak.angle,
        "Peterson's fit [-]": known(peterson, lambda v: v),
        "its deviation [%]": known(peterson, lambda v: 100.0 * (v / f.peak.factor - 1.0)),
        "Tipton's fit [-]": known(tipton, lambda v: v),
        "Tipton's deviation [%]": known(tipton, lambda v: 100.0 * (v / f.peak.factor - 1.0)),
    }


def add_curves(page: Page, load: str, factors: Sequence[Factor]) -> None:
    """K_t over r/d: points of finite elements, lines of the fits."""
    lines = []
    for wide, colour in zip(sorted({f.wide for f in factors}), PALETTE, strict=False):
        mine = [f for f in factors if f.wide == wide]
        lines.append(
            trace(
                f"D/d = {wide:g}, finite elements",
                [f.radius for f in mine],
                [f.peak.factor for f in mine],
                points=True,
                error_y={"type": "data", "array": [float(f"{f.band:.2g}") for f in mine]},
                marker={"color": colour},
            )
        )
        # as far as the shoulder leaves room, also beside a single point
        radii = np.geomspace(min(RADII), min(max(RADII), (wide - 1.0) / 2.0), 25)
        for name, formula, dash in (("Peterson", peterson, "solid"), ("Tipton", tipton, "dot")):
            values = np.array([formula(load, wide, radius) for radius in radii])
            inside = ~np.isnan(values)  # of the fit's range
            if inside.any():
                style = {"color": colour, "dash": dash}
                lines.append(
                    trace(f"D/d = {wide:g}, {name}", radii[inside], values[inside], line=style)
                )
    page.chart(CURVES.format(load), lines, "r/d [-]", "K_t [-]", "x")


def add_profile(page: Page, factors: Sequence[Factor]) -> None:
    """Stress along the sharpest fillet."""
    sharpest = _sharpest(factors)
    step = max(1, len(sharpest.peak.profile) // 120)
    page.chart(
        f"Along the fillet of D/d = {sharpest.wide:g}, r/d = {sharpest.radius:g}",
        [trace("stress over nominal stress", *sharpest.peak.profile[::step].T)],
        "angle on the arc, from the thinner shaft [deg]",
        "local stress / nominal stress [-]",
    )
