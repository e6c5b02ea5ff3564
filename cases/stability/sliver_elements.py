"""Slivers driven flat, and through to the other side: the condition, the solvers, the answer."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Heights of the slivers, in cubes.
HEIGHTS = (0.5, 1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-14)
QUICK_HEIGHTS = (0.5, 1e-2, 1e-4, 1e-6, 1e-8, 1e-11, 1e-14)
#: Flat, and inside out.
BEYOND = (0.0, -1e-4, -1e-2, -0.1, -0.3)
ACROSS, QUICK_ACROSS = 4, 2

#: Six digits of a stiffness are more than any use of it needs.
CRITERION = 1e-6


def run(run: Run) -> Any:
    """Bend a bar with a layer of slivers."""
    import numpy as np

    from fe_drivetrain.mesh import FLATTEST, find_faults, flatness
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.solve import MAX_ITERATIONS
    from fe_drivetrain.validation import (
        slivers,
    )

    across = QUICK_ACROSS if run.quick else ACROSS
    heights = QUICK_HEIGHTS if run.quick else HEIGHTS
    rows: list[list[Any]] = []
    flat, direct, iterated, linear, mended, refused = [], [], [], [], [], []
    for height in heights:
        run.report(f"slivers of height {height:g}")
        with run.step("bars with slivers"):
            mesh = slivers.bar(height, across)
            flat.append(float(flatness(mesh.points, mesh.cells).min()))
            refused.append(bool(find_faults(mesh)))
            direct.append(slivers.bent(mesh, "superlu", condition=True))
            iterated.append(slivers.bent(mesh, "multigrid"))
            linear.append(slivers.bent(slivers.bar(height, across, 4), "superlu"))
        with run.step("optimised by gmsh"):
            mended.append(slivers.bent(slivers.optimised(mesh), "multigrid"))
        rows.append(
            [
                height,
                flat[-1],
                direct[-1].condition,
                direct[-1].bending,
                iterated[-1].iterations,
                iterated[-1].solver[:60],
                refused[-1],
                mended[-1].iterations,
                mended[-1].bending,
            ]
        )
    inside_out: list[list[Any]] = []
    beyond_refused = []
    with run.step("flat and inside out"):
        for height in BEYOND:
            mesh = slivers.bar(height, across)
            found = slivers.bent(mesh, "multigrid")
            faults = find_faults(mesh)
            beyond_refused.append(bool(faults))
            inside_out.append(
                [
                    height,
                    float(flatness(mesh.points, mesh.cells).min()),
                    found.bending,
                    found.shear,
                    found.solver[:60],
                    faults[0].sentence if faults else "nothing found",
                ]
            )

    x = np.array(flat)
    error = np.abs([b.bending for b in direct])
    condition = np.array([b.condition for b in direct])
    steps = np.array([b.iterations for b in iterated])
    theory = (x < 1e-2) & (condition < 1e14)
    slope = float(np.polyfit(np.log10(x[theory]), np.log10(condition[theory]), 1)[0])
    wrong = ~(error < CRITERION)
    alone = np.array([b.solver != "multigrid" for b in iterated])
    # from the roundest on, before the first that fails
    safe = float(x[: int(wrong.argmax())].min()) if wrong.any() else None
    safe_steps = float(x[: int(alone.argmax())].min()) if alone.any() else None
    missed = int(np.count_nonzero(wrong & ~np.array(refused)))
    missed += beyond_refused.count(False)
    needless = int(np.count_nonzero(np.array(refused) & (x >= FLATTEST)))
    worst_mended = max(abs(b.bending) for b in mended)
    most = max(b.iterations for b in mended)
    theory_source = "Shewchuk 2002, What is a good linear finite element? (recalled, not re-read)"
    verdicts = [
        judge(
            "order of the condition number in the flatness of the slivers",
            slope,
            -1.0,
            tolerance=0.1,
            relative=False,
            source=theory_source,
            reason="the stiffness of a sliver is its volume over its height squared; a tenth "
            "for what the sound elements add at the round end",
            measure="order",
            band=0.1,
        ),
        judge(
            "the sweep goes on until the answer is wrong: flattest bar that is solved wrong or "
            "not at all",
            float(wrong[-1]),
            1.0,
            tolerance=0.0,
            relative=False,
            source="round-off times the condition number reaches one",
            reason="yes or no",
            measure="identity",
        ),
        judge(
            "bars that are solved wrong, flat or inside out, and that the check of the mesh "
            "lets through",
            float(missed),
            0.0,
            tolerance=0.0,
            relative=False,
            source="fe_drivetrain.mesh.checks",
            reason="none may get through",
            measure="identity",
        ),
        judge(
            f"bars with slivers less flat than {FLATTEST:g} that the check refuses",
            float(needless),
            0.0,
            tolerance=0.0,
            relative=False,
            source="fe_drivetrain.mesh.checks",
            reason="what is solved right must not be refused",
            measure="identity",
        ),
        judge(
            "bending stiffness after gmsh has taken the slivers out, worst of all heights, over "
            "the exact one, less one",
            worst_mended,
            0.0,
            tolerance=1e-8,
            relative=False,
            source="Euler-Bernoulli, exact without lateral contraction",
            reason="quadratic elements hold the solution; iterations end at an energy error of "
            "1e-9 and round-off is below",
            measure="stiffness",
            band=1e-9,
        ),
        judge(
            "most iterations of multigrid after that, over those of the bar with the roundest "
            "slivers",
            most / steps[0],
            1.0,
            tolerance=0.25,
            source="this sweep",
            reason="meshes of one size and about one shape: a quarter more or less",
        ),
    ]
    failed = [k for k, b in enumerate(iterated) if not np.isfinite(b.bending)]
    floor = np.finfo(float).eps
    traces = [
        trace("direct, 10 nodes, bending (held exactly)", x, np.maximum(error, floor)),
        trace("multigrid, the same", x, np.maximum(np.abs([b.bending for b in iterated]), floor)),
        trace("direct, 10 nodes, shear", x, np.abs([b.shear for b in direct])),
        trace("direct, 4 nodes, shear", x, np.abs([b.shear for b in linear])),
        trace("slivers taken out, bending", x, [max(abs(b.bending), floor) for b in mended]),
        trace(
            "no answer",
            x[failed],
            [1.0] * len(failed),
            points=True,
            marker={"symbol": "x", "size": 11, "color": "#c62828"},
        ),
    ]
    traces = [{**t, "mode": "lines+markers"} if t["mode"] == "lines" else t for t in traces]
    work = [
        trace("condition number over 1e6", x, condition / 1e6, mode="lines+markers"),
        trace(
            "iterations of multigrid",
            x[~alone],
            steps[~alone],
            mode="lines+markers",
        ),
        trace(
            "multigrid gives up, a direct solver answers",
            x[alone],
            [MAX_ITERATIONS] * int(alone.sum()),
            points=True,
            marker={"symbol": "x", "size": 11, "color": "#c62828"},
        ),
        trace(
            "iterations after the slivers are taken out",
            x,
            [b.iterations for b in mended],
            mode="lines+markers",
        ),
    ]
    label = "least height over longest edge of the flattest element"
    worst = max(inside_out, key=lambda row: abs(row[2]) if np.isfinite(row[2]) else 0.0)
    return CASE.results(
        run,
        summary=[
            f"One layer of slivers makes the condition number grow as their flatness to the "
            f"power {slope:.2f}. Multigrid alone holds down to a flatness of "
            f"{_number(safe_steps)}; "
            f"the stiffness has six digits down to {_number(safe)}; there is no answer at "
            f"{x[-1]:.1g}.",
            f"The program refuses a mesh whose flattest element is below {FLATTEST:g}, with "
            "element and place; all that is solved wrong in this sweep lies beyond. gmsh takes the "
            f"slivers out: then at most {most} iterations, and {worst_mended:.1e} of error.",
            f"Elements turned inside out give no sign of themselves: at a height of {worst[0]:g} "
            f"the solver converges and the bending stiffness is off by {worst[2]:.1e}. Only the "
            "check of the Jacobian finds them.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="The answer",
                items=[
                    chart(
                        "Error of the stiffness of a bar with a layer of slivers. The elements' "
                        "own error hardly changes; round-off grows until nothing is left",
                        traces,
                        label,
                        "relative error of the stiffness",
                        ("x", "y"),
                        safe=(safe, None),
                    ),
                    Text(
                        text="Bending by couples is held exactly by quadratic elements with "
                        "straight edges, slivers or not, so that its error is the solver's alone. "
                        "Shear shows that the slivers cost little accuracy as elements: "
                        "the layer is thin, and what it forbids, warping of the squares, matters "
                        "little beside the elements' own error."
                    ),
                ],
            ),
            Section(
                title="The solvers",
                items=[
                    chart(
                        "Condition number and iterations. Multigrid stops early where it cannot "
                        "do it, and a direct solver answers",
                        work,
                        label,
                        "iterations; condition number / 1e6",
                        ("x", "y"),
                        safe=(safe_steps, None),
                    ),
                    Table(
                        caption="Slivers driven flat",
                        columns=[
                            "height / cube",
                            "flatness",
                            "condition number",
                            "error of bending, direct",
                            "iterations, multigrid",
                            "answered by",
                            "refused by the check",
                            "iterations, mended",
                            "error, mended",
                        ],
                        rows=rows,
                    ),
                ],
            ),
            Section(
                title="Through to the other side",
                items=[
                    Table(
                        caption="Slivers of no height, and inside out: what multigrid says without "
                        "the check, and what the check says",
                        columns=[
                            "height / cube",
                            "flatness",
                            "error of bending",
                            "error of shear",
                            "answered by",
                            "the check",
                        ],
                        rows=[
                            [None if isinstance(c, float) and np.isnan(c) else c for c in row]
                            for row in inside_out
                        ],
                    )
                ],
            ),
        ],
        limits=[
            Limit(
                method="stiffness from a mesh with slivers, direct solver",
                parameter="least height over longest edge of the flattest element [-]",
                low=safe,
                high=None,
                criterion=f"error of round-off below {CRITERION:g}",
                beyond="digits are lost as 1 / flatness; at 1e-14 the matrix is singular; inside "
                "out a wrong answer without any sign",
                program=f"refuses below {FLATTEST:g}, and anything inside out, with element and "
                "place",
                remedy=f"optimisation by gmsh: error {worst_mended:.1e}",
            ),
            Limit(
                method="multigrid on a mesh with slivers",
                parameter="least height over longest edge of the flattest element [-]",
                low=safe_steps,
                high=None,
                criterion=f"converged within {MAX_ITERATIONS} iterations",
                beyond="the iteration stalls: nodes of a sliver move together more slowly than "
                "the smoother sees",
                program="stops early, and a direct solver answers, with the reason",
                remedy=f"optimisation by gmsh: at most {most} iterations",
            ),
        ],
        figures={"flatness": flat, "condition": condition.tolist()},
    )


def _number(value: float | None) -> str:
    return "the last of the sweep" if value is None else f"{value:.1g}"


CASE = Case(
    name="stability/sliver_elements",
    title="Sliver elements driven flat: condition, iterations, error, and what takes them out",
    source="Shewchuk 2002, What is a good linear finite element?; Timoshenko and Goodier 1970, "
    "Theory of Elasticity, art. 21",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
