"""Stiffness between rigid ends: the meridian in harmonics against solids."""

import time
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.shaft_ends import (
    SHAFTS,
    STEEL,
    Solid,
    has_fillets,
    imbalance,
    limit_of,
    solid_stiffness,
)
from fe_drivetrain.cases.references.torsion_meridian import torsion_bounds
from fe_drivetrain.common import Floats
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
GAPS = "Largest difference of the 12 x 12 from the meridian's, scaled to 1 on the diagonal"
MERIDIAN_TIME = "meridian, from the shaft to the 12 x 12 [ms]"


@dataclass(frozen=True)
class Compared:
    """A shaft's 12 x 12, its band and its time [s] by the meridian, and solids, coarse to fine."""

    flat: Floats
    bands: Floats
    seconds: float
    solids: list[Solid]


def compared(run: Run, name: str, cuts: tuple[int, ...]) -> Compared:
    """Solve a shaft in its meridian and as ever finer solids."""
    shaft = SHAFTS[name]
    with run.step(f"{name}: meridian"):
        rough = end_stiffness(shaft, STEEL, order=5, layers=3, per_fillet=2)
        end_stiffness(shaft, STEEL, per_fillet=2)  # what is done once for all is done
        start = time.perf_counter()
        flat = end_stiffness(shaft, STEEL, per_fillet=2)
        seconds = time.perf_counter() - start
    solids = [run.timed(f"{name}: solid", solid_stiffness, shaft, STEEL, cut) for cut in cuts]
    return Compared(flat, np.abs(flat - rough), seconds, solids)


def check_entries(page: Page, name: str, found: Compared, cuts: tuple[int, ...]) -> list[Record]:
    """Each entry against the limit of the solids; rows of a table."""
    solids, rows = found.solids, []
    kind = "curved tetrahedra" if has_fillets(SHAFTS[name]) else "hexahedra of 27 nodes"
    for entry, i, j, unit in ENTRIES:
        values = [s.K[i, j] for s in solids]
        limit, band, words = limit_of(cuts, values)
        page.equals(
            f"{name}: {entry}",
            found.flat[i, j],
            limit,
            within=band / abs(limit),
            why=words,
            source=f"{kind}, {solids[-1].unknowns:,} unknowns",
            unit=unit,
            measure="stiffness",
            band=found.bands[i, j],
        )
        rows.append(
            {
                "shaft": name,
                "entry": entry,
                "unit": unit,
                **{f"solid, cut {c}": v for c, v in zip(cuts, values, strict=True)},
                "its limit": limit,
                "its band": band,
                "meridian": found.flat[i, j],
                "band of the meridian": found.bands[i, j],
            }
        )
    return rows


@case(
    "Stiffness between rigid ends: Fourier harmonics in the meridian against solids",
    source="Solids of 27-node hexahedra, with fillets of tetrahedra; two bounds of torsion "
    "(Michell 1899); equilibrium",
)
def run(run: Run, page: Page) -> None:
    """Uniform, bored, stepped, conical and filleted shafts."""
    cuts = CUTS[:2] if run.quick else CUTS
    rows: list[Record] = []
    by_name = {}
    for name in QUICK if run.quick else SHAFTS:
        shaft, found = SHAFTS[name], compared(run, name, cuts)
        by_name[name] = found
        rows += check_entries(page, name, found, cuts)
        if not has_fillets(shaft):  # the bounds are of straight outlines
            check_torsion(run, page, name, shaft, found.flat[3, 3], found.bands[3, 3])
        page.vanishes(
            f"{name}: force under a rigid motion of the 12 x 12, over its terms [-]",
            imbalance(found.flat, shaft),
            within=1e-9,
            why="round-off of a direct solve: 1e-16 times a condition number of 1e6 or so",
            source="equilibrium of the free body",
        )
    cost = [
        {
            "shaft": name,
            MERIDIAN_TIME: 1000.0 * found.seconds,
            "unknowns of the finest solid": found.solids[-1].unknowns,
            "its assembly and solve [s]": found.solids[-1].seconds,
        }
        for name, found in by_name.items()
    ]
    answer(page, rows, cost)
    show(page, by_name, rows, cost)
    page.image("The last of the shafts", run.sketch(shaft))
    page.data("stiffness", rows)
    page.data("time", cost)


def answer(page: Page, rows: list[Record], cost: list[Record]) -> None:
    """State how far the meridian is from the limit of the solids, and what it costs."""
    largest = max(abs(row["meridian"] / row["its limit"] - 1.0) for row in rows)
    figures = [
        page.judged(f"stepped: {entry}", f"{entry}, stepped shaft", "solids", unit=unit)
        for entry, unit in (
            ("tension", "GN/m"),
            ("torsion", "MN m/rad"),
            ("bending", "MN m/rad"),
        )
    ]
    entries = {f"{row['shaft']}: {row['entry']}" for row in rows}
    good = all(check.passed for check in page.checks if check.quantity in entries)
    slowest = max(column(cost, MERIDIAN_TIME))
    page.answer(
        "Can an axisymmetric model replace a solid mesh for the stiffness of a shaft?",
        f"{'Yes' if good else 'No'}: for {len(cost)} shafts it is within "
        f"{100 * largest:.2g}\u00a0% of the solid's extrapolated stiffness, "
        f"{'inside' if good else 'not always inside'} the uncertainty, and takes at most "
        f"{slowest:.0f}\u00a0ms.",
        [
            page.value("largest difference from the solids, extrapolated [%]", 100 * largest),
            *figures,
            page.value("longest time, axisymmetric model [ms]", slowest),
            page.value(
                "longest time, solid: assembly and solve [s]",
                max(column(cost, "its assembly and solve [s]")),
            ),
        ],
        hero=GAPS,
        cautions=["Both ends are rigid: bearing seats that deform are not covered."],
    )


def convergence(name: str, found: Compared) -> Any:
    """Differences of the solids from the meridian, scaled, as a line of a chart."""
    scale = np.sqrt(found.flat.diagonal())
    unit = np.outer(scale, scale)
    gaps = [np.abs(s.K / unit - found.flat / unit).max() for s in found.solids]
    return trace(name, [s.unknowns for s in found.solids], gaps)


def show(page: Page, by_name: dict[str, Compared], rows: list[Record], cost: list[Record]) -> None:
    """Differences by the solid's size, and stiffness in numbers."""
    page.section("Result")
    page.chart(
        GAPS,
        [convergence(name, found) for name, found in by_name.items()],
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
