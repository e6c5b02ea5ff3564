"""Tubes of a wall down to 1/2000 of the radius: multigrid, direct solvers and patches."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

DIAMETER, LENGTH = 3.0, 3.0
#: Radius over wall.
THINNESS = (5, 20, 40, 75, 150, 400, 2000)
QUICK = (5, 40, 400)
#: Elements round the tube and along it.
MESH, QUICK_MESH = (14, 4), (8, 3)

BOUNDED = 2.0

#: Patches of so many nodes and thresholds of the coarse space that are compared at the thinnest.
OPTIONS = ((100, 0.03), (100, 0.1), (100, 0.3), (60, 0.1), (200, 0.1))


def run(run: Run) -> Any:
    """Sweep the wall of a tube under torsion and under a pressure that makes it oval."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        thin_and_slender as shared,
    )
    from fe_drivetrain.report import Limit, Section, Table, Text, judge
    from fe_drivetrain.solve import multigrid, schwarz, solvers

    turn, along = QUICK_MESH if run.quick else MESH
    points = []
    for thinness in QUICK if run.quick else THINNESS:
        shaft = shared.uniform(DIAMETER, DIAMETER / 2.0 / thinness, LENGTH)
        with run.step(f"radius over wall {thinness}"):
            problem = shared.cantilever(shaft, LENGTH / along * (1.0 + 1e-9), turn, rigid=False)
            # the oval has no closed form on a mesh: the refined factors of all solvers, their mean
            oval = [shared.factored(problem, m).refined[1] for m in shared.installed()]
            reference = np.array([shared.torsional_compliance(problem), np.mean(oval)])
            points.append(shared.measured(float(thinness), problem, reference))
            points_spread = float(np.ptp(oval) / np.mean(oval))
    x = [p.value for p in points]

    tried: list[list[Any]] = []
    for nodes, threshold in () if run.quick else OPTIONS:
        with run.step("options of patches"):
            options = schwarz.Options(nodes=nodes, threshold=threshold)
            made = schwarz.build(problem.system, options)
            found = multigrid.conjugate_gradients(
                problem.system.K, problem.F, made.precondition, solvers.TOLERANCE
            )
        share = made.n_coarse / problem.system.n_free
        tried.append([nodes, threshold, found.iterations, 100.0 * share, made.bytes / 2**20])

    direct = shared.fastest()
    arrived = [p.iterations["multigrid"].arrived for p in points]
    safe_multigrid = shared.largest_safe(x, arrived)
    errors = [p.factored_error(direct, True) for p in points]
    safe_direct = shared.largest_safe(x, [e <= shared.RIGHT for e in errors])
    patches = [p.iterations["schwarz"].iterations for p in points]
    wrong = [f"{m} at {p.value:g}" for p in points for m in p.silently_wrong]
    thin = [p for p in points if p.value >= 40]
    exponent = float(
        np.polyfit(np.log([p.value for p in thin]), np.log([p.condition for p in thin]), 1)[0]
    )
    torsion = max(
        abs(f.refined[0] / p.reference[0] - 1.0)
        for p in points
        for f in p.factors.values()
        if f is not None
    )
    patch_error = max(p.iterations_error("schwarz") for p in points)
    worst = max(points, key=lambda p: p.iterations_error("multigrid"))

    verdicts = [
        judge(
            "condition number over radius / wall, from 40 on: exponent",
            exponent,
            2.0,
            tolerance=0.4,
            relative=False,
            source="energy of bending over that of stretching a shell's element, (t / R)^2",
            reason="one power is the shell's, the other the element's own flatness; the estimate "
            "is of a one-norm, here over a decade",
            measure="order",
            band=0.3,
        ),
        judge(
            "torsional compliance, all direct solvers: largest error",
            torsion,
            0.0,
            tolerance=1e-7,
            relative=False,
            source="L / (G J) of the meshed cross-section, exact in these elements",
            reason="four decades of a condition number of 1e11 are left at 1e-16",
            measure="identity",
        ),
        judge(
            "compliance of torsion and of the oval by patches: largest error",
            patch_error,
            0.0,
            tolerance=1e-7,
            relative=False,
            source="torsion exact; oval by direct solvers",
            reason="iterations stop at an energy error of 1e-9; round-off is above",
            measure="identity",
        ),
        judge(
            "patches: most iterations over least",
            max(patches) / min(patches),
            1.0,
            tolerance=BOUNDED - 1.0,
            relative=False,
            source="Spillane et al. 2014, theorem 3.22: bounded, whatever the wall",
            reason="a bound, so twice is as good as the same; multigrid grows seven times, and "
            "stops",
        ),
        judge(
            "multigrid fails within the sweep",
            float(not all(arrived)),
            1.0,
            tolerance=0.0,
            source="aggregates that move as rigid bodies know no bending of a wall",
            reason="yes or no",
        ),
        judge(
            "answers off by more than their own bound of round-off, and more than 1e-4",
            float(len(wrong)),
            0.0,
            tolerance=0.0,
            relative=False,
            source="the program's protection: fall back, or refuse",
            reason="none may be",
            measure="identity",
        ),
    ]
    limits = [
        Limit(
            method="multigrid (smoothed aggregation under quadratic elements)",
            parameter=f"radius over wall of a tube, {turn} elements round it",
            low=None,
            high=safe_multigrid,
            criterion=f"energy error of 1e-9 within {shared.ITERATIONS} iterations",
            beyond=f"a true failure: compliance wrong by {worst.iterations_error('multigrid'):.1%} "
            f"at {worst.value:g}",
            program="auto does not choose it; where asked for it, gives up early, takes a direct "
            "factor or patches, and says so",
            remedy="patches with a spectral coarse space: "
            f"{min(patches)} to {max(patches)} iterations",
        ),
        Limit(
            method="direct solvers in double precision",
            parameter=f"radius over wall of a tube, {turn} elements round it",
            low=None,
            high=safe_direct,
            criterion="error of the compliance below 1e-4, refined",
            beyond="not reached: condition number "
            f"{points[-1].condition:.0e} at {points[-1].value:g}",
            program="gives a bound of round-off with each answer, here at most "
            f"{max(p.answers['auto'].round_off for p in points):.0e}",
            remedy="none needed",
        ),
    ]
    sections = [
        Section(
            title="Iterations",
            items=[
                shared.iteration_chart(points, "radius over wall", (None, safe_multigrid)),
                *(
                    [
                        Table(
                            caption="Patches of other sizes, other coarse spaces, thinnest wall",
                            columns=[
                                "nodes of a patch",
                                "threshold",
                                "iterations",
                                "coarse space over unknowns (%)",
                                "memory (MiB)",
                            ],
                            rows=tried,
                        )
                    ]
                    if tried
                    else []
                ),
            ],
        ),
        Section(
            title="Residual and true error",
            items=[
                shared.error_chart(
                    points,
                    "radius over wall",
                    (None, safe_multigrid),
                    "True error of the compliance, in torsion or of the oval, whichever is worse. "
                    "Shaded: multigrid gets there",
                ),
                Text(text=shared.failures(points, "radius over wall")),
                Text(
                    text="The reference of the oval is the mean of all direct solvers, refined; at "
                    f"the thinnest wall they differ by {points_spread:.1e}."
                ),
                shared.table_of(points, "radius over wall"),
            ],
        ),
        Section(
            title="Condition number",
            items=[shared.condition_chart(points, "radius over wall", (None, safe_direct))],
        ),
    ]
    return CASE.results(
        run,
        summary=[
            f"Multigrid holds up to a radius of {safe_multigrid or 0:g} walls and is wrong by "
            f"{worst.iterations_error('multigrid'):.1%} at {worst.value:g}. Patches with a "
            f"spectral coarse space take {min(patches)} to {max(patches)} iterations down to a "
            f"wall of 1/{x[-1]:g} of the radius, and are right to {patch_error:.0e}.",
            f"Direct solvers are right to {torsion:.0e} in torsion at all of them: the condition "
            f"number grows as (R/t)^{exponent:.2f} only.",
        ],
        verdicts=verdicts,
        sections=sections,
        limits=limits,
        figures={
            "thinness": x,
            "multigrid_iterations": [p.iterations["multigrid"].iterations for p in points],
            "patch_iterations": patches,
        },
    )


CASE = Case(
    name="stability/thin_walls",
    title="Thin walls: where multigrid stops, and what holds",
    source="Spillane, Dolean, Hauret, Nataf, Pechstein and Scheichl 2014, Numer. Math. 126, "
    "741-770; Saint-Venant's torsion",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
