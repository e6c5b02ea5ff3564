"""Bending stiffness of a shaft with a sharp step: meshes refined by their indicators, and uniform
ones.
"""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

SHAFT = "stepped, sharp"
LOAD = "bending"

#: Element sizes [m] of uniform meshes, coarse first, and as many elements a turn as are that large.
UNIFORM = ((0.19, 10), (0.135, 14), (0.1, 19), (0.073, 26))
QUICK_UNIFORM = ((0.19, 10), (0.11, 17))
#: Where refinement starts. So many elements a turn keep the error of the shape far below that of
#: the step on all meshes here.
START = (0.25, 14)
STEPS, QUICK_STEPS = 4, 1
#: Refinement ends at so many unknowns.
MOST = 60_000


def run(run: Run) -> Any:
    """Refine step by step, and compare with uniform meshes."""
    import numpy as np

    from fe_drivetrain.cases.verification import rigid_balance
    from fe_drivetrain.mesh import marked, refined_sizes
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation import (
        rigid_ended_shafts,
    )

    shaft = rigid_ended_shafts.SHAFTS[SHAFT]
    with run.step("reference"):
        exact = rigid_ended_shafts.exact(shaft, 0.1, 10)[LOAD]
        rough = rigid_ended_shafts.exact(shaft, 0.1, 5)[LOAD]

    rows: list[list[Any]] = []
    imbalances: list[float] = []

    def add(kind: str, found: Any, marks: int) -> tuple[int, float]:
        k, estimate = found.stiffness[LOAD], found.estimate[LOAD]
        error = k / exact - 1.0
        imbalances.append(found.imbalance)
        rows.append(
            [
                kind,
                len(found.mesh.cells),
                marks,
                found.unknowns,
                k / 1e6,
                estimate.band(k) / 1e6,
                100 * error,
                100 * estimate.relative,
                100 * (estimate.improved(k) / exact - 1.0),
            ]
        )
        return found.unknowns, error

    uniform = []
    for size, turn in QUICK_UNIFORM if run.quick else UNIFORM:
        with run.step("uniform meshes"):
            mesh = rigid_ended_shafts.meshed(shaft, size, turn)
        with run.step("uniform: solve and estimate"):
            found = rigid_ended_shafts.solved(mesh, shaft, (LOAD,))
        uniform.append(add("uniform", found, 0))

    adaptive = []
    local = None
    for _ in range(1 + (QUICK_STEPS if run.quick else STEPS)):
        with run.step("adaptive meshes"):
            mesh = rigid_ended_shafts.meshed(shaft, *START, local)
        with run.step("adaptive: solve and estimate"):
            found = rigid_ended_shafts.solved(mesh, shaft, (LOAD,))
            cells = marked(found.estimate[LOAD].indicators)
            local = refined_sizes(mesh, cells)
        adaptive.append(add("adaptive", found, len(cells)))
        run.report(f"adaptive: {found.unknowns:,} unknowns, error {adaptive[-1][1]:.2g}")
        if found.unknowns > MOST:
            break

    unknowns, errors = np.array(adaptive).T
    of_uniform = np.array(uniform)
    last = int(np.flatnonzero(unknowns <= of_uniform[-1, 0]).max())
    same = float(np.exp(np.interp(np.log(unknowns[last]), *np.log(of_uniform.T))))
    k, estimate = found.stiffness[LOAD], found.estimate[LOAD]
    slope = [
        float(np.polyfit(np.log(n), np.log(e), 1)[0]) for n, e in (of_uniform.T, (unknowns, errors))
    ]
    verdicts = [
        rigid_balance.balance_verdict(imbalances),
        judge(
            f"error of the adaptive mesh of {int(unknowns[last]):,} unknowns over that of a "
            "uniform one of as many",
            float(errors[last] / same),
            0.0,
            tolerance=1.0,
            relative=False,
            source="uniform meshes of this case, between two of them on logarithmic scales",
            reason="refinement that does not beat uniform meshes is not worth its solves",
        ),
        judge(
            "bending stiffness on the last adaptive mesh",
            k,
            exact,
            tolerance=estimate.band(k) / exact,
            unit="N m/rad",
            source="the shaft's meridian in fourth-order elements, graded to its corners; "
            f"uncertain by {abs(rough / exact - 1):.1g}",
            reason="the band, three times the error estimated on that one mesh",
            measure="stiffness",
            band=estimate.band(k),
        ),
    ]
    return CASE.results(
        run,
        summary=[
            f"At {int(unknowns[last]):,} unknowns the adaptive mesh is off by "
            f"{100 * errors[last]:.2g} %, a uniform one of as many by {100 * same:.2g} %.",
            f"Error falls with unknowns to the power {slope[1]:.2f} on adaptive meshes, "
            f"{slope[0]:.2f} on uniform ones: the sharp step holds these back.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Error against unknowns",
                items=[
                    chart(
                        "Error of the bending stiffness, true and as estimated on each mesh",
                        [
                            trace("uniform", *of_uniform.T, mode="lines+markers"),
                            trace("adaptive", unknowns, errors, mode="lines+markers"),
                            *(
                                trace(
                                    f"{kind}, estimated",
                                    [r[3] for r in rows if r[0] == kind],
                                    [r[7] / 100 for r in rows if r[0] == kind],
                                    mode="lines+markers",
                                    line={"dash": "dot"},
                                )
                                for kind in ("uniform", "adaptive")
                            ),
                        ],
                        "unknowns",
                        "relative error",
                        ("x", "y"),
                    ),
                    Table(
                        caption="Meshes of curved tetrahedra; marked cells hold half of the "
                        "estimated error and are halved in size on the next mesh",
                        columns=[
                            "meshes",
                            "elements",
                            "marked",
                            "unknowns",
                            "stiffness [MN m/rad]",
                            "± stiffness [MN m/rad]",
                            "true error [%]",
                            "estimated error [%]",
                            "error with the estimate taken out [%]",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="Each mesh is made anew from the shape, with sizes from the one "
                        "before, so that its curved surfaces are as exact as it is fine."
                    ),
                ],
            )
        ],
        figures={
            "uniform": {"unknowns": of_uniform[:, 0].tolist(), "error": of_uniform[:, 1].tolist()},
            "adaptive": {"unknowns": unknowns.tolist(), "error": errors.tolist()},
        },
    )


CASE = Case(
    name="verification/adaptive_stiffness",
    title="Adaptive against uniform meshes: bending stiffness of a shaft with a sharp step",
    source="Doerfler 1996, SIAM J. Numer. Anal. 33, 1106-1124; Zienkiewicz and Zhu 1992, Int. J. "
    "Numer. Meth. Eng. 33, 1331-1364; reference from the shaft's meridian",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
