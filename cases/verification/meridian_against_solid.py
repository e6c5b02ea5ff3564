"""Stiffness between rigid ends: the meridian in harmonics against solids."""

import time

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.shaft_ends import (
    SHAFTS,
    STEEL,
    Solid,
    has_fillets,
    imbalance,
    solid_stiffness,
)
from fe_drivetrain.cases.references.torsion_meridian import torsion_bounds
from fe_drivetrain.comparison import grid_convergence, richardson
from fe_drivetrain.elasticity.revolution import end_stiffness
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run, column

#: Elements per coarsest element, in all three directions.
CUTS = (1, 2, 3)
#: Where both bounds are exact, round-off is what is left, relative.
ROUND_OFF = 1e-10
#: Shafts of a quick run.
QUICK = ("bored", "stepped")
#: Rows and columns that are not zero or another's by symmetry, with names and units.
ENTRIES = (
    ("tension", 0, 0, "N/m"),
    ("shear", 1, 1, "N/m"),
    ("shear by rotation", 1, 5, "N/rad"),
    ("torsion", 3, 3, "N m/rad"),
    ("bending", 5, 5, "N m/rad"),
)


def limit_of(values: list[float], quick: bool) -> tuple[float, float, str]:
    """Where a series of meshes goes, its band, and what the band is."""
    sizes = [1 / cut for cut in CUTS[: len(values)]]
    if quick:
        limit = richardson(sizes, values, 1.0)
        return (
            limit,
            abs(values[-1] - values[-2]),
            "what the finer of two meshes of the solid changed",
        )
    grid = grid_convergence(sizes, values, least_order=1.0)
    limit = grid.extrapolated
    band = max(grid.extrapolated_uncertainty, abs(values[-1] - limit))
    return limit, band, f"the band of three meshes of the solid ({grid.behaviour})"


@case(
    "Stiffness between rigid ends: Fourier harmonics in the meridian against solids",
    source="Solids of 27-node hexahedra, with fillets of tetrahedra; two bounds of torsion "
    "(Michell 1899); equilibrium",
)
def run(run: Run, page: Page) -> None:
    """Uniform, bored, stepped, conical and filleted shafts."""
    cuts = CUTS[:2] if run.quick else CUTS
    traces = []
    rows: list[Record] = []
    cost: list[Record] = []
    for name in QUICK if run.quick else SHAFTS:
        shaft = SHAFTS[name]
        with run.step(f"{name}: meridian"):
            rough = end_stiffness(shaft, STEEL, order=5, layers=3, per_fillet=2)
            end_stiffness(shaft, STEEL, per_fillet=2)  # what is done once for all is done
            start = time.perf_counter()
            flat = end_stiffness(shaft, STEEL, per_fillet=2)
            seconds = time.perf_counter() - start
        bands = np.abs(flat - rough)
        solids: list[Solid] = []
        for cut in cuts:
            solids.append(run.timed(f"{name}: solid", solid_stiffness, shaft, STEEL, cut))
        scale = np.sqrt(flat.diagonal())
        unit = np.outer(scale, scale)
        gaps = [np.abs(s.K / unit - flat / unit).max() for s in solids]
        traces.append(trace(name, [s.unknowns for s in solids], gaps))
        for entry, i, j, of in ENTRIES:
            values = [s.K[i, j] for s in solids]
            limit, band, words = limit_of(values, run.quick)
            kind = "curved tetrahedra" if has_fillets(shaft) else "hexahedra of 27 nodes"
            page.equals(
                f"{name}: {entry}",
                flat[i, j],
                limit,
                within=band / abs(limit),
                why=words,
                source=f"{kind}, {solids[-1].unknowns:,} unknowns",
                unit=of,
                measure="stiffness",
                band=bands[i, j],
            )
            rows.append(
                {
                    "shaft": name,
                    "entry": entry,
                    "unit": of,
                    **{f"solid, cut {c}": v for c, v in zip(cuts, values, strict=True)},
                    "its limit": limit,
                    "its band": band,
                    "meridian": flat[i, j],
                    "band of the meridian": bands[i, j],
                }
            )
        if not has_fillets(shaft):  # the bounds are of straight outlines
            check_torsion(run, page, name, shaft, flat[3, 3], bands[3, 3])
        page.vanishes(
            f"{name}: force under a rigid motion of the 12 x 12, over its terms [-]",
            imbalance(flat, shaft),
            within=1e-9,
            why="round-off of a direct solve: 1e-16 times a condition number of 1e6 or so",
            source="equilibrium of the free body",
        )
        cost.append(
            {
                "shaft": name,
                "meridian, from the shaft to the 12 x 12 [ms]": 1000.0 * seconds,
                "unknowns of the finest solid": solids[-1].unknowns,
                "its assembly and solve [s]": solids[-1].seconds,
            }
        )
    largest = max(abs(row["meridian"] / row["its limit"] - 1.0) for row in rows)
    milliseconds = column(cost, "meridian, from the shaft to the 12 x 12 [ms]")
    page.answer(
        "The meridian has every stiffness of the solids within their bands, at most "
        f"{100 * largest:.2g} % from their limit, in {min(milliseconds):.0f} to "
        f"{max(milliseconds):.0f} ms a shaft."
    )
    page.section("Result")
    page.chart(
        "Largest difference of the 12 x 12 from the meridian's, scaled to 1 on the diagonal",
        traces,
        "unknowns of the solid",
        "difference [-]",
        "xy",
    )
    page.table("Time", cost)
    page.section("Details")
    page.table("Stiffness at the front, rear held", rows)
    page.text(
        "Both ends rigid. Meridian: quadrilaterals of sixth order, and four layers of ever smaller "
        "ones at re-entrant corners and the ends; its band is what one order and one layer "
        "changed. Solid: hexahedra, every one cut into 2 or 3 along each direction, or with "
        "fillets tetrahedra of second order, on their arcs, of a half and a third of the size; its "
        "matrix by the energy of six motions of the front; nothing is shared with the meridian but "
        "the shaft and the material."
    )
    page.image("The last of the shafts", run.sketch(shaft))
    page.data("stiffness", rows)
    page.data("time", cost)


def check_torsion(
    run: Run, page: Page, name: str, shaft: Shaft, stiffness: float, band: float
) -> None:
    """Torsion between two bounds, by displacements and by the torsion function."""
    with run.step(f"{name}: bounds of torsion"):
        bounds = torsion_bounds(shaft, STEEL.shear_modulus, 0.15, 6 if run.quick else 10)
    reach = max(bounds.half_width, ROUND_OFF * bounds.middle) + band
    page.between(
        f"{name}: torsion between its bounds [N m/rad]",
        stiffness,
        bounds.middle - reach,
        bounds.middle + reach,
        why="the two bounds, each wider by the band of the meridian",
        source="two bounds, by displacements and by the torsion function (Michell 1899)",
        band=band,
    )
