"""Mesh convergence of reactions, stiffness and deflection of the bonded main bearing."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Factors on the scene's mesh sizes, from coarse to fine.
FACTORS = (2.0, 1.4, 1.0, 0.75)
QUICK_FACTORS = (2.0, 1.5, 1.2)


def run(run: Run) -> Any:
    """Solve one scene on meshes from coarse to fine."""
    import numpy as np

    from fe_drivetrain.cases.main_bearing import (
        bands,
        study,
    )
    from fe_drivetrain.compare import grid_convergence, richardson
    from fe_drivetrain.report import Chart, Section, Table, Text, judge, trace

    scene = study.scene_of(run, "bonded", coarsen=False)
    factors = QUICK_FACTORS if run.quick else FACTORS
    finer_scenes = {f"sizes x {factor:g}": bands.coarser(scene, factor) for factor in factors}
    with run.side_by_side(len(factors)) as jobs:
        # the finest first: it takes longest
        solving = {
            label: jobs.start(study.solve_level, finer, label)
            for label, finer in reversed(finer_scenes.items())
        }
        levels = {label: solving[label].result() for label in finer_scenes}

    solutions, verdicts = {}, []
    values: dict[str, list[float]] = {}
    seconds = []
    for label, (solved, tilt, taken) in levels.items():
        seconds.append(taken)
        solutions[label] = solved
        verdicts += study.check_verdicts(solved, label)
        verdicts += study.check_verdicts(tilt.free, f"{label}, without gearbox")
        reaction = solved.response.reactions[solved.bearing]
        motion = solved.response.motions["hub"]
        for quantity, value in (
            ("Fz at the bearing per hub Fz [N/N]", reaction[2, 2]),
            ("My at the bearing per hub Fz [N m/N]", reaction[4, 2]),
            ("Fy at the bearing per hub Fy [N/N]", reaction[1, 1]),
            ("hub deflection per Fz [nm/N]", 1e9 * motion[2, 2]),
            ("hub twist per Mx [nrad/(N m)]", 1e9 * motion[3, 3]),
            *(
                (f"K_R {plane}, {estimator} [MN m/rad]", k / 1e6)
                for plane, estimators in tilt.by_plane.items()
                for estimator, k in estimators.items()
            ),
        ):
            values.setdefault(quantity, []).append(float(value))

    unknowns = [s.response.n_unknowns for s in solutions.values()]
    found = {
        q: grid_convergence(factors, v, least_order=bands.LEAST_ORDER) for q, v in values.items()
    }
    # Meshes are not nested, so that the order three of them show is not to be relied upon. Stress
    # is singular along the bearings' sharp edges, so convergence is taken as first order, as the
    # series shows nearly: f(h) = f(0) + c h from the two finest meshes. The band is wider.
    last = factors[-2]
    limits = {q: richardson(factors[-2:], v[-2:], 1.0) for q, v in values.items()}
    errors = {q: [100.0 * (x / limits[q] - 1.0) for x in v] for q, v in values.items()}
    for quantity, error in errors.items():
        is_stiffness = quantity.startswith("K_R")
        verdicts.append(
            judge(
                f"{quantity}: estimated error of sizes x {last:g}",
                error[-2],
                0.0,
                tolerance=5.0 if is_stiffness else 2.0,
                relative=False,
                unit="%",
                source="extrapolated to element size zero, first order",
                band=100.0 * found[quantity].uncertainty / abs(limits[quantity]),
                reason="a tenth of an error of K_R reaches the reactions of the beam that uses it"
                if is_stiffness
                else "small beside what beam and solid differ by",
            )
        )
    finest = {q: np.abs(np.array(v[:-1]) / v[-1] - 1.0) * 100.0 for q, v in values.items()}
    chart = Chart(
        caption="Difference from the finest mesh",
        figure={
            "data": [
                trace(
                    q.partition(" [")[0],
                    unknowns[:-1],
                    np.maximum(d, 1e-6),
                    mode="lines+markers",
                    marker={"symbol": k, "size": 9},
                    line={"dash": "solid" if q.startswith("K_R") else "dot"},
                )
                for k, (q, d) in enumerate(finest.items())
            ],
            "layout": {
                "xaxis": {"title": {"text": "unknowns"}, "type": "log"},
                "yaxis": {"title": {"text": "difference from the finest [%]"}, "type": "log"},
            },
        },
    )
    reactions = max(abs(e[-2]) for q, e in errors.items() if "at the bearing" in q)
    stiffness = max(abs(e[-2]) for q, e in errors.items() if q.startswith("K_R"))
    return CASE.results(
        run,
        summary=[
            f"With sizes x {last:g} ({unknowns[-2]:,} unknowns) the reactions are within "
            f"{reactions:.2g} % and K_R within {stiffness:.2g} % of their values extrapolated to "
            "element size zero, at first order.",
            "The finest mesh's own band, to the limit at the observed order or at order "
            f"{bands.LEAST_ORDER:g}, whichever is farther, is at most ± "
            f"{max(100 * c.relative_uncertainty for q, c in found.items() if 'at the' in q):.2g} % "
            "of the reactions and ± "
            f"{max(100 * c.relative_uncertainty for q, c in found.items() if q[0] == 'K'):.2g} % "
            "of K_R.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Convergence",
                items=[
                    chart,
                    Table(
                        caption="Quantities by mesh, and extrapolated at first order",
                        columns=[
                            "quantity",
                            *(f"{n:,} unknowns" for n in unknowns),
                            "± finest",
                            "extrapolated",
                            f"error of sizes x {last:g} [%]",
                            "convergence of the last three",
                            "observed order",
                        ],
                        rows=[
                            [
                                q,
                                *v,
                                found[q].uncertainty,
                                limits[q],
                                errors[q][-2],
                                found[q].behaviour,
                                None if found[q].order != found[q].order else found[q].order,
                            ]
                            for q, v in values.items()
                        ],
                    ),
                    Table(
                        caption="Cost, each level on its share of the cores",
                        columns=["unknowns", "assembly and solve of ten unit loads [s]"],
                        rows=[[n, t] for n, t in zip(unknowns, seconds, strict=True)],
                    ),
                    Text(
                        text="Stress is singular along the sharp edges where ring, housing and "
                        "shaft meet. Stiffness converges all the same, but slowly, in about "
                        "proportion to the element size there. Meshes are not nested, so the "
                        "series is not quite regular, the observed order of three of them says "
                        "little, and the extrapolation is an estimate. The band of the finest "
                        "mesh reaches to the limit at the observed order, where there is one, and "
                        f"to that of order {bands.LEAST_ORDER:g}; where differences of the last "
                        "three meshes do not shrink as they should, also over their range."
                    ),
                ],
            ),
            Section(title="Mesh and solution", items=[study.mesh_table(solutions)]),
        ],
        assumptions=study.assumptions(scene),
        figures={
            "unknowns": unknowns,
            "values": values,
            "extrapolated": limits,
            "uncertainty_of_finest": {q: c.uncertainty for q, c in found.items()},
        },
    )


CASE = Case(
    name="main_bearing/mesh_convergence",
    title="Mesh convergence of reactions, stiffness and deflection",
    source="Stirling 2023, PhD thesis, section 3.2: 'a convergence study was again undertaken'",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
