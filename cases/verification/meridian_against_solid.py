"""Stiffness between rigid ends: the meridian in harmonics against solids."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

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


def run(run: Run) -> Any:
    """Uniform, bored, stepped, conical and filleted shafts."""
    import time

    import numpy as np

    from fe_drivetrain.compare import grid_convergence, richardson
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.revolution import end_stiffness
    from fe_drivetrain.validation import (
        shaft_ends,
    )
    from fe_drivetrain.validation.torsion_meridian import (
        torsion_bounds,
    )

    steel = shaft_ends.STEEL
    verdicts, traces, milliseconds = [], [], []
    rows: list[list[Any]] = []
    cost: list[list[Any]] = []
    largest = 0.0
    names = QUICK if run.quick else list(shaft_ends.SHAFTS)
    for name in names:
        shaft = shaft_ends.SHAFTS[name]
        filleted = shaft_ends.has_fillets(shaft)
        with run.step(f"{name}: meridian"):
            rough = end_stiffness(shaft, steel, order=5, layers=3, per_fillet=2)
            end_stiffness(shaft, steel, per_fillet=2)  # what is done once for all is done
            start = time.perf_counter()
            flat = end_stiffness(shaft, steel, per_fillet=2)
            seconds = time.perf_counter() - start
        bands = np.abs(flat - rough)
        cuts = CUTS[:2] if run.quick else CUTS
        solids = []
        for cut in cuts:
            with run.step(f"{name}: solid"):
                solids.append(shaft_ends.solid_stiffness(shaft, steel, cut))
        scale = np.sqrt(flat.diagonal())
        unit = np.outer(scale, scale)
        gaps = [np.abs(s.K / unit - flat / unit).max() for s in solids]
        traces.append(trace(name, [s.unknowns for s in solids], gaps, points=False))
        for entry, i, j, of in ENTRIES:
            values = [s.K[i, j] for s in solids]
            if run.quick:
                limit = richardson([1 / c for c in cuts], values, 1.0)
                band = abs(values[-1] - values[-2])
                words = "what the finer of two meshes of the solid changed"
            else:
                grid = grid_convergence([1 / c for c in cuts], values, least_order=1.0)
                limit, band = grid.extrapolated, grid.extrapolated_uncertainty
                band = max(band, abs(values[-1] - limit))
                words = f"the band of three meshes of the solid ({grid.behaviour})"
            verdicts.append(
                judge(
                    f"{name}: {entry}",
                    flat[i, j],
                    limit,
                    tolerance=band / abs(limit),
                    unit=of,
                    source=f"{'curved tetrahedra' if filleted else 'hexahedra of 27 nodes'}, "
                    f"{solids[-1].unknowns:,} unknowns",
                    reason=words,
                    measure="stiffness",
                    band=bands[i, j],
                )
            )
            rows.append([name, entry, of, *values, limit, band, flat[i, j], bands[i, j]])
            largest = max(largest, abs(flat[i, j] / limit - 1.0))
        if not filleted:  # the bounds are of straight outlines
            with run.step(f"{name}: bounds of torsion"):
                bounds = torsion_bounds(shaft, steel.shear_modulus, 0.15, 6 if run.quick else 10)
            half = max(bounds.half_width, ROUND_OFF * bounds.middle)
            verdicts.append(
                judge(
                    f"{name}: torsion between its bounds",
                    flat[3, 3],
                    bounds.middle,
                    tolerance=(half + bands[3, 3]) / bounds.middle,
                    unit="N m/rad",
                    source="two bounds, by displacements and by the torsion function "
                    "(Michell 1899)",
                    reason="half the distance of the bounds, and the band of the meridian",
                    measure="stiffness",
                    band=bands[3, 3],
                )
            )
        verdicts.append(
            judge(
                f"{name}: force under a rigid motion of the 12 x 12, over its terms",
                shaft_ends.imbalance(flat, shaft),
                0.0,
                tolerance=1e-9,
                relative=False,
                unit="-",
                source="equilibrium of the free body",
                reason="round-off of a direct solve: 1e-16 times a condition number of 1e6 or so",
                measure="identity",
                band=0.0,
            )
        )
        milliseconds.append(1000.0 * seconds)
        cost.append([name, milliseconds[-1], solids[-1].unknowns, solids[-1].seconds])
    return CASE.results(
        run,
        summary=[
            f"The meridian has every stiffness of the solids within their bands, at most "
            f"{100 * largest:.2g} % from their limit, in {min(milliseconds):.0f} to "
            f"{max(milliseconds):.0f} ms a shaft.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Result",
                items=[
                    chart(
                        "Largest difference of the 12 x 12 from the meridian's, scaled to 1 on the "
                        "diagonal",
                        traces,
                        "unknowns of the solid",
                        "difference [-]",
                        logarithmic="xy",
                    ),
                    Table(
                        caption="Time",
                        columns=[
                            "shaft",
                            "meridian, from the shaft to the 12 x 12 [ms]",
                            "unknowns of the finest solid",
                            "its assembly and solve [s]",
                        ],
                        rows=cost,
                    ),
                ],
            ),
            Section(
                title="Details",
                items=[
                    Table(
                        caption="Stiffness at the front, rear held",
                        columns=[
                            "shaft",
                            "entry",
                            "unit",
                            *(f"solid, cut {c}" for c in cuts),
                            "its limit",
                            "its band",
                            "meridian",
                            "its band",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="Both ends rigid. Meridian: quadrilaterals of sixth order, and four "
                        "layers of ever smaller ones at re-entrant corners and the ends; its band "
                        "is what one order and one layer changed. Solid: hexahedra, every one cut "
                        "into 2 or 3 along each direction, or with fillets tetrahedra of second "
                        "order, on their arcs, of a half and a third of the size; its matrix by "
                        "the energy of six motions of the front; nothing is shared with the "
                        "meridian but the shaft and the material."
                    ),
                ],
            ),
        ],
        figures={"names": list(names), "milliseconds": milliseconds},
    )


CASE = Case(
    name="verification/meridian_against_solid",
    title="Meridian in harmonics against solids: stiffness between rigid ends",
    source="Solids of 27-node hexahedra, with fillets of tetrahedra; two bounds of torsion "
    "(Michell 1899); equilibrium",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
