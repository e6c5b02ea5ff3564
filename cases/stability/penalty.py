"""Couplings by penalty springs instead of elimination: wrong when soft, wrong when stiff."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

NAMES = {
    "tie": "tie of two halves that do not match",
    "rigid": "rigid end face",
    "averaged": "mean motion of the end face, held",
}


#: Multigrid stops converging before some of the couplings are good to four digits.
ONE_PERCENT = 1e-2


def run(run: Run) -> Any:
    """Sweep the penalty of three couplings, with direct and iterative solvers."""
    import numpy as np

    from fe_drivetrain.cases.stability.decades import (
        FOUR_DIGITS,
        crosses,
        decades,
        safe_range,
        shown,
        slope,
    )
    from fe_drivetrain.common import InputError
    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import change_scene, library_scene
    from fe_drivetrain.solve import solve
    from fe_drivetrain.validation import (
        penalised_couplings,
    )

    penalties = decades(-3, 14, 1 if run.quick else 3)
    iterated_penalties = decades(-2, 10, 0.25 if run.quick else 0.5)
    # Round-off scatters by a decade from point to point: over so few the slope does, too.
    stiff_tolerance = 0.4 if run.quick else 0.15
    verdicts, limits, sections, figures = [], [], [], {}
    rows: list[list[Any]] = []
    words: list[str] = []
    for kind in penalised_couplings.KINDS:
        with run.step(f"{kind}: elimination"):
            bar = penalised_couplings.bar(kind, 2)
            system, F = penalised_couplings.eliminated(bar)
            exact = penalised_couplings.work(system, F, "superlu")
            by_iteration, iterations, _ = penalised_couplings.iterated(system, F)
            # a stiffness scaled by a third rounds differently everywhere
            other = penalised_couplings.work(_scaled(system, 1.0 / 3.0), F, "superlu") / 3.0
        uncertain = float(np.abs(other / exact - 1.0).max())
        with run.step(f"{kind}: penalty, direct"):
            direct = np.array(
                [
                    penalised_couplings.work(
                        *penalised_couplings.penalised(bar, penalty), "superlu"
                    )
                    for penalty in penalties
                ]
            )
        error = np.abs(direct / exact - 1.0).max(axis=1)
        spread = np.sqrt(((direct / exact - 1.0) ** 2).mean(axis=1))
        with run.step(f"{kind}: penalty, multigrid"):
            found = [
                penalised_couplings.iterated(*penalised_couplings.penalised(bar, penalty))
                for penalty in iterated_penalties
            ]
        iterated_error = np.array([np.abs(w / exact - 1.0).max() for w, _, _ in found])
        arrived = np.array([ok for _, _, ok in found])

        low, high = safe_range(penalties, error, FOUR_DIGITS)
        iterated_safe = np.where(arrived, iterated_error, np.nan)
        iterated_low, iterated_high = safe_range(iterated_penalties, iterated_safe, ONE_PERCENT)
        best = int(np.nanargmin(error))
        soft = slope(penalties[: best + 1], spread[: best + 1], (1e-6, 1e-2))
        stiff = slope(penalties[best:], spread[best:], (2.0 * spread[best], 0.1))
        verdicts += [
            judge(
                f"{kind}: error of a soft penalty, exponent",
                soft,
                -1.0,
                tolerance=0.05,
                source="springs in series: the penalty's own compliance is added",
                reason="first order in the compliance: a hundredth of the leading error at most",
                measure="order",
                band=0.01,
            ),
            judge(
                f"{kind}: error of a stiff penalty, exponent",
                stiff,
                1.0,
                tolerance=stiff_tolerance,
                source="round-off of penalty terms, 2e-16 of them, is added to the elastic ones",
                reason="round-off scatters by about a decade over the decades of the fit",
                measure="order",
                band=stiff_tolerance / 2,
            ),
            judge(
                f"{kind}: elimination, stiffness scaled by a third against unscaled",
                uncertain,
                0.0,
                tolerance=1e-10,
                relative=False,
                source="a linear system",
                reason="round-off times the condition number of the bar",
                measure="identity",
            ),
            judge(
                f"{kind}: elimination, multigrid against direct",
                float(np.abs(by_iteration / exact - 1.0).max()),
                0.0,
                tolerance=1e-10,
                relative=False,
                source="the same discrete model",
                reason="iterations stop at 1e-9 in the energy norm, which counts squared",
                measure="identity",
            ),
        ]
        rows.append(
            [NAMES[kind], low, high, float(penalties[best]), float(error[best]), soft, stiff]
        )
        figures[kind] = {
            "penalty": penalties.tolist(),
            "error": error.tolist(),
            "iterated_penalty": iterated_penalties.tolist(),
            "iterated_error": iterated_error.tolist(),
            "iterations": [count for _, count, _ in found],
        }
        lost = ~np.isfinite(error)
        limits += [
            Limit(
                method=f"penalty in place of elimination, direct solver: {NAMES[kind]}",
                parameter="penalty over the mean diagonal of the stiffness",
                low=low,
                high=high,
                criterion="error of the compliance below 1e-4",
                beyond="below: the coupling gives, error as 1 / penalty; above: round-off, error "
                f"as the penalty, and no answer at all from {penalties[lost].min():.0e} on"
                if lost.any()
                else "below: the coupling gives; above: round-off",
                program="eliminates all couplings; springs above 1e16 N/m are refused",
                remedy=f"elimination: right to {uncertain:.0e}",
            ),
            Limit(
                method=f"penalty in place of elimination, multigrid: {NAMES[kind]}",
                parameter="penalty over the mean diagonal of the stiffness",
                low=iterated_low,
                high=iterated_high,
                criterion="converged, and error of the compliance below 1 %",
                beyond="no convergence: the smoother and the aggregates do not know the springs",
                program="gives up early and takes a direct factor, and says so",
                remedy=f"elimination: {iterations} iterations",
            ),
        ]
        words.append(f"{kind} {shown(low)} to {shown(high)}")
        sections.append(
            Section(
                title=NAMES[kind].capitalize(),
                items=[
                    chart(
                        f"Error of the compliance of a bar, {NAMES[kind]}. Shaded: safe with the "
                        "direct solver. Where a curve ends the solver refuses",
                        [
                            trace("penalty, direct", penalties[~lost], error[~lost], mode="lines"),
                            trace(
                                "penalty, multigrid, converged",
                                iterated_penalties[arrived],
                                iterated_error[arrived],
                                True,
                            ),
                            crosses(
                                "penalty, multigrid, not converged",
                                iterated_penalties[~arrived],
                                iterated_error[~arrived],
                            ),
                            trace(
                                "elimination, direct: its round-off",
                                [penalties[0], penalties[-1]],
                                [max(uncertain, 1e-16)] * 2,
                                line={"dash": "dash"},
                            ),
                        ],
                        "penalty over the mean diagonal of the stiffness",
                        "relative error",
                        ("x", "y"),
                        (low, high),
                    )
                ],
            )
        )
    with run.step("what the program does"):
        bar = penalised_couplings.bar("averaged", 2)
        exact = penalised_couplings.work(*penalised_couplings.eliminated(bar), "superlu")
        system, F = penalised_couplings.penalised(bar, 1e6)
        instead = solve(system, F, "multigrid")
        error_instead = np.abs(np.einsum("nm,nm->m", F, instead.x) / exact - 1.0).max()
        try:
            change_scene(
                library_scene("main_bearing_bonded"),
                {"gearbox.stiffness": [0, 1e17, 1e17, "rigid", 0, 0]},
            )
            refused = 0.0
        except InputError:
            refused = 1.0
    verdicts += [
        judge(
            "multigrid asked for at a penalty of 1e6: a direct factor instead",
            float(instead.method != "multigrid"),
            1.0,
            tolerance=0.0,
            source="the iteration does not converge there",
            reason="yes or no",
            measure="identity",
        ),
        judge(
            "error of the compliance that comes of it",
            float(error_instead),
            0.0,
            tolerance=FOUR_DIGITS,
            relative=False,
            source="elimination",
            reason="four digits of stiffness",
            measure="identity",
        ),
        judge(
            "a scene with a gearbox spring of 1e17 N/m is refused",
            refused,
            1.0,
            tolerance=0.0,
            source="such a spring is a penalty: 'rigid' is eliminated",
            reason="yes or no",
            measure="identity",
        ),
    ]
    return CASE.results(
        run,
        summary=[
            "A penalty in place of a constraint keeps four digits of stiffness with a direct "
            f"solver from and to, in units of the mean diagonal: {'; '.join(words)}.",
            "On either side the error grows tenfold a decade, as theory says: the compliance of "
            "the springs below, their round-off above. Multigrid stops converging decades earlier.",
            "Elimination, which the program uses throughout, has no such parameter.",
        ],
        verdicts=verdicts,
        sections=[
            *sections,
            Section(
                title="Ranges",
                items=[
                    Table(
                        caption="Penalty over the mean diagonal: range with four digits, best "
                        "value, and exponents of the error on either side",
                        columns=[
                            "coupling",
                            "safe from",
                            "to",
                            "best",
                            "least error",
                            "exponent, soft",
                            "exponent, stiff",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="Each row of the coupling has unit length, and the penalty is the "
                        "stiffness of a spring on it. The reference is the same mesh with the same "
                        "rows eliminated, so that nothing but the penalty is in the error."
                    ),
                ],
            ),
        ],
        limits=limits,
        figures=figures,
    )


def _scaled(system: Any, factor: float) -> Any:
    """The same system in other units."""
    from dataclasses import replace

    return replace(system, K=(factor * system.K).tobsr((3, 3)))


CASE = Case(
    name="stability/penalty",
    title="Penalty against elimination: too soft, too stiff, and what needs no penalty",
    source="Felippa 2004, Introduction to finite element methods, ch. 9 (the square root rule); "
    "Bathe 1996, Finite element procedures, sec. 3.4",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
