"""How loose an iterative solver may be for four digits of stiffness."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run


def run(run: Run) -> Any:
    """Follow conjugate gradients step by step, and the stiffnesses that each step would give."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        solver_steps,
    )
    from fe_drivetrain.cases.stability.decades import (
        FOUR_DIGITS,
        decades,
        safe_range,
        shown,
        slope,
    )
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.solve import TOLERANCE

    tolerances = decades(-12, -1, 2)
    verdicts, limits, sections = [], [], []
    rows: list[list[Any]] = []
    loosest: list[float] = []
    loose_of: dict[str, float] = {}
    for name, build in solver_steps.PROBLEMS.items():
        with run.step(f"{name}: mesh, assembly and direct solution"):
            problem = build(run.quick)
        with run.step(f"{name}: multigrid"):
            steps = solver_steps.followed(problem)
        energy = steps.energy_error
        traces, names = [], list(problem.figures)
        # below it, round-off of the direct solution counts, too
        floor = 1e-12
        for figure in names:
            error = steps.error[figure]
            own = figure == problem.own
            exponent = slope(energy, error, (1e2 * floor, 1e-1))
            traces.append(trace(figure, energy, np.maximum(error, 1e-16), mode="lines+markers"))
            if own:
                verdicts.append(
                    judge(
                        f"{name}, {figure}: error against the energy error, exponent",
                        exponent,
                        2.0,
                        tolerance=0.02,
                        source="Galerkin orthogonality: f.(u - u_k) is the squared energy error",
                        reason="exact in exact arithmetic, from a start at zero",
                        measure="order",
                        band=0.005,
                    )
                )
            else:
                verdicts.append(
                    judge(
                        f"{name}, {figure}: error against the energy error, exponent",
                        exponent,
                        1.0,
                        tolerance=0.3,
                        source="Cauchy and Schwarz: |l.(u - u_k)| is within the energy error times "
                        "the energy norm of what l would do as a load",
                        reason="its sign changes as the iteration goes on, and with it its size by "
                        "a decade",
                        measure="order",
                        band=0.15,
                    )
                )
            # the error of the first iterate that the estimate lets through
            stopped = [
                float(error[int(np.argmax(steps.estimate <= t))])
                if (steps.estimate <= t).any()
                else float("nan")
                for t in tolerances
            ]
            _, high = safe_range(tolerances, stopped, FOUR_DIGITS)
            loose_of[f"{name}, {figure}"] = tolerances[-1] if high is None else high
            loosest.append(loose_of[f"{name}, {figure}"])
            at = int(np.argmin(np.abs(tolerances / TOLERANCE - 1.0)))
            rows.append(
                [
                    name,
                    figure,
                    exponent,
                    high,
                    int(np.argmax(steps.estimate <= (high or tolerances[-1]))) + 1,
                    int(np.argmax(steps.estimate <= TOLERANCE)) + 1,
                    stopped[at],
                ]
            )
            limits.append(
                Limit(
                    method=f"multigrid: {name}, {figure}",
                    parameter="tolerance of the energy error",
                    high=high,
                    criterion="error of the stiffness below 1e-4",
                    beyond="the error of the stiffness goes as the tolerance to the power of "
                    f"{exponent:.1f}",
                    program=f"stops at {TOLERANCE:.0e}",
                    remedy=f"at {TOLERANCE:.0e} the error is {stopped[at]:.0e}",
                )
            )
            verdicts.append(
                judge(
                    f"{name}, {figure}: error at the program's tolerance of {TOLERANCE:.0e}",
                    stopped[at],
                    0.0,
                    tolerance=1e-7,
                    relative=False,
                    source="the same system by a direct solver",
                    reason="a rotation read off one place is bound by the energy error times the "
                    "root of its own compliance over the load's: below a hundred",
                    measure="identity",
                    band=floor,
                )
            )
        usable = (energy > 1e-8) & (steps.estimate > 0)
        effectivity = steps.estimate[usable] / energy[usable]
        verdicts.append(
            judge(
                f"{name}: estimated over true energy error, the least",
                float(np.log10(effectivity.min())),
                0.0,
                tolerance=0.5,
                relative=False,
                unit="decades",
                source="true energy error, from the direct solution",
                reason="half a decade: the estimate is of use where the tolerance is known to that",
                measure="identity",
                band=0.01,
            )
        )
        own_error = steps.error[problem.own]
        sections.append(
            Section(
                title=name.capitalize(),
                items=[
                    chart(
                        f"Error of stiffnesses over the energy error of each step of conjugate "
                        f"gradients, {problem.unknowns:,} unknowns. Shaded: four digits of every "
                        "one of them",
                        [
                            *traces,
                            trace(
                                "energy error squared",
                                energy,
                                np.maximum(energy**2, 1e-16),
                                line={"dash": "dash"},
                            ),
                            trace("estimated energy error", energy, steps.estimate, True),
                            trace(
                                "relative residual",
                                energy,
                                steps.residual,
                                line={"dash": "dot"},
                            ),
                        ],
                        "relative error in the energy norm",
                        "relative",
                        ("x", "y"),
                        (None, float(energy[_first_safe(steps.error.values())])),
                    ),
                    Text(
                        text="The residual is "
                        f"{steps.residual[_first_safe([own_error])]:.1e} where {problem.own} has "
                        "four digits: it says little about a stiffness."
                    ),
                ],
            )
        )
    worst = min(loosest)
    return CASE.results(
        run,
        summary=[
            "Four digits of a stiffness need a tolerance of the energy error of "
            + "; ".join(f"{shown(v)} ({k})" for k, v in loose_of.items())
            + ".",
            f"The loosest that does for all of them is {worst:.1g}. The program stops at "
            f"{TOLERANCE:.0e}.",
            "The error of a load's own stiffness is the square of the energy error, as theory "
            "says; that of a motion elsewhere falls as the energy error itself.",
        ],
        verdicts=verdicts,
        sections=[
            *sections,
            Section(
                title="Loosest tolerances",
                items=[
                    Table(
                        caption="Loosest tolerance with four digits, and iterations that it takes "
                        "and that the program's takes",
                        columns=[
                            "problem",
                            "stiffness",
                            "exponent of the error",
                            "loosest tolerance",
                            "iterations",
                            f"iterations to {TOLERANCE:.0e}",
                            f"error at {TOLERANCE:.0e}",
                        ],
                        rows=rows,
                    )
                ],
            ),
        ],
        limits=limits,
        figures={"loosest": loose_of},
    )


def _first_safe(errors: Any) -> int:
    """The first step from which on every error stays below four digits."""
    import numpy as np

    from fe_drivetrain.cases.stability.decades import (
        FOUR_DIGITS,
    )

    bad = np.max(np.array(list(errors)), axis=0) >= FOUR_DIGITS
    return int(np.flatnonzero(bad)[-1] + 1) if bad.any() else 0


CASE = Case(
    name="stability/solver_tolerance",
    title="Tolerance of the solver against the error of a stiffness",
    source="Hestenes and Stiefel 1952, J. Res. Nat. Bur. Stand. 49, 409; Meurant, Papez, Tichy "
    "2021, Accurate error estimation in CG",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
