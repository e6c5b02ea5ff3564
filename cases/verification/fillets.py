"""What the cases of fillets share: the sweep, its checks, charts and table."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.report import Chart, Results, Table, Text, Verdict, judge
from fe_drivetrain.report import Section as Part
from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run
from fe_drivetrain.validation.fillet_factors import (
    JUDGED,
    PETERSON,
    RADII,
    TIPTON,
    WIDES,
    Factor,
    Formula,
    factor,
    of_a_fit,
    peterson,
    published_scatter,
    tipton,
)


def sweep(run: Run, load: str, pairs: Iterable[tuple[float, float]]) -> list[Factor]:
    """Every pair of D/d and r/d that leaves room for the fillet and is in the fit's range."""
    found = []
    with run.step("mesh and solve every shoulder"):
        for wide, radius in pairs:
            if radius <= (wide - 1.0) / 2.0 and not math.isnan(peterson(load, wide, radius)):
                found.append(factor(load, wide, radius))
    return found


def verdicts(
    load: str,
    factors: Sequence[Factor],
    published: Mapping[str, tuple[Formula, Formula, str]],
    judged: Sequence[tuple[float, float]],
) -> list[Verdict]:
    """Chosen geometries against each published formula, and how well resolved all are.

    Parameters
    ----------
    load, factors
        The sweep.
    published
        By source: the formula, the relative tolerance, and its reason.
    judged
        (D/d, r/d) of the chosen.
    """
    found = []
    for f in factors:
        if (f.wide, f.radius) not in judged:
            continue
        for source, (formula, tolerance, reason) in published.items():
            found.append(
                judge(
                    f"K_t, D/d = {f.wide:g}, r/d = {f.radius:g}",
                    f.peak.factor,
                    formula(load, f.wide, f.radius),
                    tolerance=tolerance(load, f.wide, f.radius),
                    unit="-",
                    source=source,
                    reason=reason,
                    measure="stress",
                    band=f.band,
                )
            )
    worst = max(f.band / f.peak.factor for f in factors)
    found.append(
        judge(
            "largest band of any K_t, relative",
            worst,
            0.0,
            tolerance=1e-3,
            relative=False,
            unit="-",
            source="the same with three quarters of the elements along the fillet",
            reason="a tenth of a per cent, so that what is left over belongs to the formulae",
            measure="identity",
            band=worst,
        )
    )
    return found


def deviations(load: str, factors: Sequence[Factor], formula: Formula) -> Floats:
    """Published over computed, less 1."""
    return np.array([formula(load, f.wide, f.radius) / f.peak.factor - 1.0 for f in factors])


def sections(load: str, factors: Sequence[Factor]) -> list[Part]:
    """Charts of the sweep and along one fillet, and the table of all."""
    wides = sorted({f.wide for f in factors})
    colours = ("#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e")
    data: list[dict[str, Any]] = []
    for wide, colour in zip(wides, colours, strict=False):
        mine = [f for f in factors if f.wide == wide]
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": f"D/d = {wide:g}, finite elements",
                "x": [f.radius for f in mine],
                "y": [round(f.peak.factor, 5) for f in mine],
                "error_y": {"type": "data", "array": [float(f"{f.band:.2g}") for f in mine]},
                "marker": {"color": colour},
            }
        )
        radii = np.geomspace(min(f.radius for f in mine), max(f.radius for f in mine), 25)
        for name, formula, dash in (("Peterson", peterson, "solid"), ("Tipton", tipton, "dot")):
            values = [formula(load, wide, radius) for radius in radii]
            if not all(math.isnan(v) for v in values):
                data.append(
                    {
                        "type": "scatter",
                        "mode": "lines",
                        "name": f"D/d = {wide:g}, {name}",
                        "x": [float(f"{r:.5g}") for r in radii],
                        "y": [None if math.isnan(v) else round(v, 5) for v in values],
                        "line": {"color": colour, "dash": dash},
                    }
                )
    curves = Chart(
        caption=f"Stress concentration in {load}: computed, and as published",
        figure={
            "data": data,
            "layout": {
                "xaxis": {"title": {"text": "r/d [-]"}, "type": "log"},
                "yaxis": {"title": {"text": "K_t [-]"}},
            },
        },
    )
    sharpest = min(factors, key=lambda f: (f.radius, -f.wide))
    step = max(1, len(sharpest.peak.profile) // 120)
    profile = sharpest.peak.profile[::step]
    along = Chart(
        caption=f"Along the fillet of D/d = {sharpest.wide:g}, r/d = {sharpest.radius:g}",
        figure={
            "data": [
                {
                    "type": "scatter",
                    "mode": "lines",
                    "name": "stress over nominal stress",
                    "x": [round(v, 3) for v in profile[:, 0]],
                    "y": [round(v, 5) for v in profile[:, 1]],
                }
            ],
            "layout": {
                "xaxis": {"title": {"text": "angle on the arc, from the thinner shaft [deg]"}},
                "yaxis": {"title": {"text": "local stress / nominal stress [-]"}},
            },
        },
    )
    rows: list[list[Any]] = []
    for f in factors:
        row: list[Any] = [f.wide, f.radius, f.peak.factor, f.band, f.peak.angle]
        for formula in (peterson, tipton):
            value = formula(load, f.wide, f.radius)
            known = not math.isnan(value)
            row += [value, 100.0 * (value / f.peak.factor - 1.0)] if known else [None, None]
        rows.append(row)
    table = Table(
        caption="Every shoulder",
        columns=[
            "D/d [-]",
            "r/d [-]",
            "K_t computed [-]",
            "band [-]",
            "where on the arc [deg]",
            "Peterson's fit [-]",
            "its deviation [%]",
            "Tipton's fit [-]",
            "its deviation [%]",
        ],
        rows=rows,
    )
    text = Text(
        text="Solid shaft, nominal stress in the thinner diameter d; far ends carry the exact "
        "stresses of a uniform shaft, so that nothing is held rigidly. Fifth-order curved "
        "triangles in the meridian, harmonic 0 or 1 round the axis, finest along the fillet. The "
        "band is what a third more elements along the fillet changed. Peterson's curves are fits "
        "to charts, whose own sources are photoelastic tests and early computations."
    )
    return [Part(title="Result", items=[curves, along]), Part(title="Details", items=[text, table])]


def figures(load: str, factors: Sequence[Factor]) -> dict[str, Any]:
    """Numbers of the sweep for other programs."""
    return {
        "load": load,
        "D/d": [f.wide for f in factors],
        "r/d": [f.radius for f in factors],
        "K_t": [f.peak.factor for f in factors],
        "band": [f.band for f in factors],
    }


def against_two_fits(run: Run, case: Case, load: str) -> Results:
    """Sweep step and fillet in bending or tension, against Peterson's fit and Tipton's."""
    pairs = [(wide, radius) for wide in WIDES for radius in RADII]
    factors = sweep(run, load, JUDGED if run.quick else pairs)
    known = {
        PETERSON: (
            peterson,
            published_scatter,
            "the charts are drawn from photoelastic tests: allowed is what their fit differs from "
            "the published formula for finite elements by, and the 5 % of that formula",
        ),
        TIPTON: (
            tipton,
            of_a_fit,
            "a formula of nine constants through the results of finite elements, for D/d from "
            "just above 1 to 6: a few per cent off by itself",
        ),
    }
    deviation = 100.0 * deviations(load, factors, peterson)
    worst = int(np.abs(deviation).argmax())
    f = factors[worst]
    summary = [
        f"Over {len(factors)} shoulders Peterson's fit is {deviation.mean():+.1f} % off the "
        f"finite elements on average and at worst {deviation[worst]:+.1f} % "
        f"(D/d = {f.wide:g}, r/d = {f.radius:g}: K_t = {f.peak.factor:.4f}, band {f.band:.1g}).",
    ]
    other = 100.0 * deviations(load, factors, tipton)
    summary.append(
        f"The formula of Tipton, Sorem and Rolovic, itself from finite elements, is "
        f"{other.mean():+.1f} % off on average and {np.abs(other).max():.1f} % at worst."
    )
    return case.results(
        run,
        summary=summary,
        verdicts=verdicts(load, factors, known, JUDGED),
        sections=sections(load, factors),
        figures=figures(load, factors),
    )
