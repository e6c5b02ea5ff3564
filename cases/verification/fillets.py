"""Stress concentration at the shoulder fillet of a round shaft: the published fits, and elasticity.

Everything is in units of the thinner diameter, d = 1 m, and of a nominal stress of 1 Pa.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.report import Chart, Results, Table, Text, Verdict, judge
from fe_drivetrain.report import Section as Part
from fe_drivetrain.revolution import (
    Meridian,
    Traction,
    Where,
    along_sides,
    freedoms,
    harmonic_response,
    meridian,
    stresses,
    surface_loads,
)
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import Case, Run

STEEL = MATERIALS["steel"]

LOADS = ("tension", "bending", "torsion")

#: Length of shaft on either side of the shoulder, in the larger diameter: what the shoulder adds to
#: the exact end stresses has died down to 1e-4 or less there (the slowest of the axisymmetric end
#: effects decays as exp(-2.72 x / R), Little and Childs 1967; recalled, not re-read).
REACH = 2.0

#: D/d and r/d of the sweep.
WIDES = (1.1, 1.5, 2.0, 3.0)
RADII = (0.03, 0.05, 0.12, 0.2, 0.3)
#: Those judged one by one: a low, a middle and a high step.
JUDGED = ((1.1, 0.05), (1.5, 0.12), (2.0, 0.2))


PETERSON = (
    "Pilkey and Pilkey 2008, Peterson's Stress Concentration Factors, 3rd ed., charts 3.4, "
    "3.10 and 3.12"
)
TIPTON = (
    "Tipton, Sorem and Rolovic 1996, J. Mech. Des. 118, 321-327, as in Pilkey and Pilkey 2008, "
    "eqs 3.8 and 3.11 (equation numbers recalled, not re-read)"
)

PER_FILLET = 8
"""Elements along the fillet."""

OF_A_FIT = 0.05
"""Relative; two published fits of Peterson's charts differ by as much."""

Formula = Callable[[str, float, float], float]
"""Of load, D/d and r/d."""

#: Coefficients of C1 to C4 by 1, sqrt(t/r), t/r, with the range of t/r that they are for.
FITS: dict[str, tuple[tuple[float, float, tuple[tuple[float, float, float], ...]], ...]] = {
    "tension": (
        (
            *(0.1, 2.0),
            (
                (0.926, 1.157, -0.099),
                (0.012, -3.036, 0.961),
                (-0.302, 3.977, -1.744),
                (0.365, -2.098, 0.878),
            ),
        ),
        (
            *(2.0, 20.0),
            (
                (1.200, 0.860, -0.022),
                (-1.805, -0.346, -0.038),
                (2.198, -0.486, 0.165),
                (-0.593, -0.028, -0.106),
            ),
        ),
    ),
    "bending": (
        (
            *(0.1, 2.0),
            (
                (0.947, 1.206, -0.131),
                (0.022, -3.405, 0.915),
                (0.869, 1.777, -0.555),
                (-0.810, 0.422, -0.260),
            ),
        ),
        (
            *(2.0, 20.0),
            (
                (1.232, 0.832, -0.008),
                (-3.813, 0.968, -0.260),
                (7.423, -4.868, 0.869),
                (-3.839, 3.070, -0.600),
            ),
        ),
    ),
    "torsion": (
        (
            *(0.25, 4.0),
            (
                (0.905, 0.783, -0.075),
                (-0.437, -1.969, 0.553),
                (1.557, 1.073, -0.578),
                (-1.061, 0.171, 0.086),
            ),
        ),
    ),
}


def peterson(load: str, wide: float, radius: float) -> float:
    """K_t of the charts' fits; NaN outside their range.

    Parameters
    ----------
    load
        One of `LOADS`.
    wide, radius
        D/d and r/d.
    """
    t = (wide - 1.0) / 2.0
    for low, high, rows in FITS[load]:
        if low <= t / radius <= high:
            terms = np.array([1.0, math.sqrt(t / radius), t / radius])
            powers = (2.0 * t / wide) ** np.arange(4)
            return float(np.array(rows) @ terms @ powers)
    return math.nan


def tipton(load: str, wide: float, radius: float) -> float:
    """K_t of formulae fitted to finite elements, of largest principal stress; tension, bending."""
    s = wide * wide
    if load == "tension":
        root = (3.43 - 3.41 * s - 0.0232 * s * s) / (1.0 - 8.85 * s - 0.078 * s * s)
        return float(0.493 + 0.48 * wide**-2.43 + radius**-0.48 * math.sqrt(root))
    if load == "bending":
        root = (-0.14 - 0.363 * s + 0.503 * s * s) / (1.0 - 2.39 * s + 3.368 * s * s)
        return float(0.632 + 0.377 * wide**-4.4 + radius**-0.5 * math.sqrt(root))
    return math.nan


def published_scatter(load: str, wide: float, radius: float) -> float:
    """Relative difference of the two published formulae, and what the better one allows itself."""
    return abs(peterson(load, wide, radius) / tipton(load, wide, radius) - 1.0) + OF_A_FIT


def of_a_fit(load: str, wide: float, radius: float) -> float:
    """What a formula through computed points may be off by itself, relative."""
    return OF_A_FIT


def shouldered(wide: float, radius: float) -> Shaft:
    """A solid shaft, D for x < 0 and d = 1 m behind, with a fillet."""
    length = REACH * wide
    return Shaft(
        front=-length,
        sections=(
            Section(length=length, outer_diameter=wide, fillet=radius),
            Section(length=length, outer_diameter=1.0),
        ),
    )


def end_stress(load: str, places: Floats, diameter: float) -> Floats:
    """(k, 3) stress xx, xr, xt on a section of a diameter, for a nominal stress of 1 Pa in d.

    Saint-Venant's, exact far from the shoulder: uniform, linear in the height, or in the radius.
    """
    r = places[:, 1]
    zero = np.zeros_like(r)
    if load == "tension":
        return np.column_stack([zero + 1.0 / diameter**2, zero, zero])
    linear = 2.0 * r / diameter**4
    return np.column_stack([linear, zero, zero] if load == "bending" else [zero, zero, linear])


@dataclass(frozen=True)
class Peak:
    """The largest stress of a fillet.

    Attributes
    ----------
    factor
        K_t: of largest principal, in torsion of shear stress, over the nominal one in d.
    angle
        Where it is on the arc, from the end on the thinner shaft [degrees].
    profile
        (k, 2) angle and local factor along the arc.
    """

    factor: float
    angle: float
    profile: Floats


def peak(load: str, wide: float, radius: float, per_fillet: int, order: int = 5) -> Peak:
    """K_t by elements of the meridian, with exact stresses on both ends."""
    shaft = shouldered(wide, radius)
    mesh = meridian(shaft, 0.35, order=order, layers=0, per_fillet=per_fillet)
    n = 1 if load == "bending" else 0
    F = np.zeros(3 * len(mesh.nodes))
    for x, diameter in ((shaft.front, wide), (shaft.rear, 1.0)):
        F += surface_loads(mesh, n, mesh.sides(_at(x)), _traction(load, diameter))
    rear = mesh.where(lambda x, r: x > shaft.rear - 1e-9)
    outer = rear[mesh.nodes[rear, 1].argmax()]
    held = np.array([freedoms(outer, 0), freedoms(outer, 2 if n == 0 else 1)])
    u = harmonic_response(mesh, STEEL, n, F, (held, np.zeros(2))).u[..., 0]
    return _along_fillet(load, mesh, n, u, radius)


def _at(x: float) -> Where:
    return lambda along, radius: np.abs(along - x) < 1e-9


def _traction(load: str, diameter: float) -> Traction:
    return lambda at, normal: end_stress(load, at, diameter) * normal[:, :1]


def _along_fillet(load: str, mesh: Meridian, n: int, u: Floats, radius: float) -> Peak:
    centre = np.array([radius, 0.5 + radius])
    near = 1e-6 * radius
    arc = mesh.sides(lambda x, r: np.abs(np.hypot(x - centre[0], r - centre[1]) - radius) < near)
    along = np.linspace(0.0, 1.0, 33)
    rows = []
    for side in np.unique(arc[:, 1]):
        cells = arc[arc[:, 1] == side, 0]
        at = along_sides(mesh, int(side), cells, along)[1]
        s = stresses(mesh, STEEL, n, u, mesh.element.side_places(int(side), along), cells)
        angle = np.degrees(np.arctan2(centre[0] - at[..., 0], centre[1] - at[..., 1]))
        rows.append(np.column_stack([angle.ravel(), local_factor(load, s).ravel()]))
    profile = np.vstack(rows)
    profile = profile[profile[:, 0].argsort()]
    top = profile[:, 1].argmax()
    return Peak(float(profile[top, 1]), float(profile[top, 0]), profile)


def local_factor(load: str, s: Floats) -> Floats:
    """(...) largest principal stress of (..., 6) where the cosine is 1; in torsion shear stress."""
    xx, rr, tt, xr, xt, rt = np.moveaxis(s, -1, 0)
    if load == "torsion":
        return np.asarray(np.hypot(xt, rt))
    in_plane = (xx + rr) / 2.0 + np.hypot((xx - rr) / 2.0, xr)
    return np.asarray(np.maximum(in_plane, tt))


@dataclass(frozen=True)
class Factor:
    """K_t of one geometry, on two meshes, beside what is published.

    Attributes
    ----------
    wide, radius
        D/d and r/d.
    peak
        Of the finer mesh.
    band
        Half width: what a third more elements along the fillet changed, which at fifth order is
        several times what is left.
    """

    wide: float
    radius: float
    peak: Peak
    band: float


def factor(load: str, wide: float, radius: float, per_fillet: int = PER_FILLET) -> Factor:
    """K_t with its band, from two meshes."""
    rough, fine = (peak(load, wide, radius, n) for n in (3 * per_fillet // 4, per_fillet))
    return Factor(wide, radius, fine, abs(fine.factor - rough.factor))


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
