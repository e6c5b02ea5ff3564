"""A shoulder fillet in curved tetrahedra, against the same fillet in its meridian."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: D/d, r/d.
WIDE, RADIUS = 1.6, 0.25
#: Elements along the fillet, coarse first. With 3 and 5 torsion is 1.8 % off, its band 1.4 %:
#: not yet in the range where second order shows.
PER_FILLET = (6, 11)
QUICK = (4, 6)
#: Of stress in elements of second order.
ORDER = 2.0
#: Degree of the polynomial that is laid through the stress along the arc.
DEGREE = 6


def run(run: Run) -> Any:
    """Tension, bending and torsion on one mesh, three meshes."""
    import numpy as np

    from fe_drivetrain.compare import DOUBTFUL, richardson
    from fe_drivetrain.report import Chart, Section, Table, Text, judge
    from fe_drivetrain.validation import (
        fillet_factors,
        solid_fillet,
    )

    with run.step("meridian"):
        flat = {
            load: fillet_factors.factor(load, WIDE, RADIUS, 4 if run.quick else 8)
            for load in fillet_factors.LOADS
        }
    meshes = QUICK if run.quick else PER_FILLET
    found = []
    for n in meshes:
        with run.step(f"solid, {n} elements along the fillet"):
            found.append(solid_fillet.solve(WIDE, RADIUS, n))
    verdicts, sections = [], []
    rows: list[list[Any]] = []
    share: dict[str, float] = {}
    for load in fillet_factors.LOADS:
        f = flat[load]
        values = [s.factor(load, DEGREE) for s in found]
        sizes = [1.0 / n for n in meshes]
        limit = richardson(sizes, values, ORDER)
        missing = DOUBTFUL * abs(limit - values[-1])
        # what the polynomial itself leaves out, on a profile that is known
        angle, factor = f.peak.profile.T
        fitted = abs(solid_fillet.fitted_peak(angle, factor, DEGREE) - f.peak.factor)
        band = missing + fitted
        share[load] = values[-1] / f.peak.factor - 1.0
        verdicts.append(
            judge(
                f"K_t in {load}",
                values[-1],
                f.peak.factor,
                tolerance=(band + f.band) / f.peak.factor,
                unit="-",
                source=f"the same shoulder in its meridian, fifth order (band {f.band:.1g})",
                reason="the bands of both: grid convergence index of two meshes at second "
                "order, safety factor 3, and what a polynomial "
                f"of degree {DEGREE} along the arc leaves out ({fitted:.1g})",
                measure="stress",
                band=band,
            )
        )
        rows.append([load, *values, limit, band, f.peak.factor, f.band])
        nodes = found[-1].profile(load)
        step = max(1, len(nodes) // 400)
        sections.append(
            Chart(
                caption=f"Stress along the fillet in {load}",
                figure={
                    "data": [
                        {
                            "type": "scatter",
                            "mode": "markers",
                            "name": f"nodes of the solid, {meshes[-1]} elements along the fillet",
                            "x": [round(v, 3) for v in nodes[::step, 0]],
                            "y": [round(v, 4) for v in nodes[::step, 1]],
                            "marker": {"size": 4},
                        },
                        {
                            "type": "scatter",
                            "mode": "lines",
                            "name": "meridian",
                            "x": [round(v, 3) for v in angle[::4]],
                            "y": [round(v, 5) for v in factor[::4]],
                        },
                    ],
                    "layout": {
                        "xaxis": {
                            "title": {"text": "angle on the arc, from the thinner shaft [deg]"}
                        },
                        "yaxis": {"title": {"text": "local stress / nominal stress [-]"}},
                    },
                },
            )
        )
    worst = max(share, key=lambda load: abs(share[load]))
    return CASE.results(
        run,
        summary=[
            f"With {found[-1].unknowns:,} unknowns curved tetrahedra find K_t of the meridian "
            f"within {100 * abs(share[worst]):.1f} % in all of tension, bending and torsion.",
        ],
        verdicts=verdicts,
        sections=[
            Section(title="Result", items=sections),
            Section(
                title="Details",
                items=[
                    Table(
                        caption=f"K_t of D/d = {WIDE:g}, r/d = {RADIUS:g}",
                        columns=[
                            "load",
                            *(f"solid, {s.unknowns:,} unknowns [-]" for s in found),
                            "extrapolated [-]",
                            "band [-]",
                            "meridian [-]",
                            "its band [-]",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="Second-order tetrahedra, all whose nodes on the fillet lie on it, "
                        "growing away from it. Recovered stress at those nodes: along the arc in "
                        "tension and bending, between arc and circumference in torsion. In bending "
                        "each node counts by the cosine of its place round the shaft, least "
                        "squares over all. K_t is the peak of a polynomial along the arc. Three "
                        "meshes of free tetrahedra gave no steady order, so two far apart are "
                        "compared, with the safety factor for that (Roache 1994)."
                    ),
                ],
            ),
        ],
        figures={
            "per_fillet": list(meshes),
            "unknowns": [s.unknowns for s in found],
            "K_t": {
                row[0]: [float(np.round(v, 6)) for v in row[1 : 1 + len(meshes)]] for row in rows
            },
            "meridian": {load: flat[load].peak.factor for load in flat},
        },
    )


CASE = Case(
    name="verification/fillet_solid",
    title="Shoulder fillet in curved tetrahedra and in the meridian",
    source="Meridian in harmonics 0 and 1; itself against Peterson's charts in fillet_*",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
