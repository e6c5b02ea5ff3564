"""Shafts of 5 to 5000 diameters: multigrid, direct solvers and patches, against exact answers."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

DIAMETER, WALL = 0.7, 0.175
#: Elements along a shaft, at most, and round it.
ALONG, TURN = 12, 6

SLENDERNESS = (5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000)
QUICK = (5, 100, 500, 5000)

#: Iterations may grow by no more than this over the sweep, where a method holds.
BOUNDED = 2.0


def run(run: Run) -> Any:
    """Sweep the slenderness of a cantilever under torsion and under a moment."""
    import numpy as np

    from fe_drivetrain.cases.stability import (
        thin_and_slender as shared,
    )
    from fe_drivetrain.report import Limit, Section, Text, judge

    points = []
    for slenderness in QUICK if run.quick else SLENDERNESS:
        count = min(ALONG, slenderness)
        size = slenderness * DIAMETER / count
        shaft = shared.uniform(DIAMETER, WALL, slenderness * DIAMETER)
        with run.step(f"L/D = {slenderness}"):
            problem = shared.cantilever(shaft, size * (1.0 + 1e-9), TURN)
            reference = np.array(
                [
                    shared.torsional_compliance(problem),
                    shared.bending_compliance(DIAMETER, WALL, size, TURN, count),
                ]
            )
            points.append(shared.measured(float(slenderness), problem, reference))
    x = [p.value for p in points]
    direct = shared.fastest()

    multigrid = [p.iterations["multigrid"] for p in points]
    patches = [p.iterations["schwarz"] for p in points]
    arrived = [i.arrived for i in multigrid]
    safe_multigrid = shared.largest_safe(x, arrived)
    direct_errors = [p.factored_error(direct, True) for p in points]
    safe_direct = shared.largest_safe(x, [e <= shared.RIGHT for e in direct_errors])
    refused = [p.value for p in points if not p.answers["auto"].method]
    # what the program still answers, patches solve as well
    answered = [i for p, i in zip(points, patches, strict=True) if p.answers["auto"].method]
    growth = max(i.iterations for i in answered) / min(i.iterations for i in answered)
    long = [p for p in points if p.value >= 100 and p.value <= 1000]
    exponent = float(
        np.polyfit(np.log([p.value for p in long]), np.log([p.condition for p in long]), 1)[0]
    )
    wrong = [f"{m} at L/D = {p.value:g}" for p in points for m in p.silently_wrong]
    within = [
        p.error(a.compliance) / max(a.round_off, 1e-5)
        for p in points
        for a in p.answers.values()
        if a.compliance is not None
    ]
    torsion = max(
        abs(f.refined[0] / p.reference[0] - 1.0)
        for p in points
        for f in p.factors.values()
        if f is not None and p.value <= 500
    )

    verdicts = [
        judge(
            "condition number over L/D, as many elements from 100 diameters on: exponent",
            exponent,
            4.0,
            tolerance=0.4,
            relative=False,
            source="bending energy over the energy of one element, Euler-Bernoulli: (L/D)^-4",
            reason="a one-norm is estimated within a small factor, here over a decade of L/D",
            measure="order",
            band=0.3,
        ),
        judge(
            "torsional compliance, all direct solvers up to 500 diameters: largest error",
            torsion,
            0.0,
            tolerance=1e-7,
            relative=False,
            source="L / (G J) of the meshed cross-section, exact in these elements",
            reason="its condition number is about the square root of that of bending",
            measure="identity",
        ),
        judge(
            "patches: most iterations over least, wherever the program answers",
            growth,
            1.0,
            tolerance=BOUNDED - 1.0,
            relative=False,
            source="Spillane et al. 2014, theorem 3.22: bounded, whatever the slenderness",
            reason="a bound, so twice is as good as the same; multigrid grows six times and stops",
        ),
        judge(
            "multigrid fails within the sweep",
            float(not all(arrived)),
            1.0,
            tolerance=0.0,
            source="aggregates that move as rigid bodies make a chain of them too stiff",
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
        judge(
            "the program refuses within the sweep",
            float(bool(refused)),
            1.0,
            tolerance=0.0,
            source="a bound of first order bounds nothing where it is not small",
            reason="yes or no",
        ),
    ]

    limits = [
        Limit(
            method="multigrid (smoothed aggregation under quadratic elements)",
            parameter=f"L/D of a shaft in {ALONG} elements along it",
            low=None,
            high=safe_multigrid,
            criterion=f"energy error of 1e-9 within {shared.ITERATIONS} iterations",
            beyond="iterations grow with the slenderness; then a true failure, compliance wrong by "
            f"{max(p.iterations_error('multigrid') for p in points if p.value <= 500):.0%} up to "
            "L/D = 500",
            program="auto does not choose it; where asked for it, gives up early, takes a direct "
            "factor or patches, and says so",
            remedy=f"patches with a spectral coarse space: at most "
            f"{max(i.iterations for i in answered)} iterations",
        ),
        Limit(
            method="direct solvers in double precision, and any other",
            parameter=f"L/D of a shaft in {ALONG} elements along it",
            low=None,
            high=safe_direct,
            criterion="error of the compliance in bending below 1e-4, refined",
            beyond="the rounding of the stiffness itself, not the solver: refinement does not help",
            program=f"gives a bound with each answer, tells it from 1e-4 on, refuses above 0.1: "
            f"here from L/D = {min(refused):g} on"
            if refused
            else "gives a bound",
            remedy="a beam, or one element for many diameters",
        ),
    ]
    sections = [
        Section(
            title="Iterations",
            items=[shared.iteration_chart(points, "L/D", (None, safe_multigrid))],
        ),
        Section(
            title="Residual and true error",
            items=[
                shared.error_chart(
                    points,
                    "L/D",
                    (None, safe_direct),
                    "True error of the compliance, in bending or torsion, whichever is worse. "
                    "Shaded: direct solvers give four digits",
                ),
                Text(text=shared.failures(points, "L/D")),
                Text(
                    text="The reference of bending is put together from short shafts of the same "
                    "elements, and exact to about 1e-6: errors below are its own. That of torsion "
                    "is exact."
                ),
                shared.table_of(points, "L/D"),
            ],
        ),
        Section(
            title="Condition number",
            items=[shared.condition_chart(points, "L/D", (None, safe_direct))],
        ),
    ]
    return CASE.results(
        run,
        summary=[
            f"Multigrid holds up to L/D = {safe_multigrid or 0:g}; patches with a spectral coarse "
            f"space need {min(i.iterations for i in answered)} to "
            f"{max(i.iterations for i in answered)} iterations up to L/D = "
            f"{max(p.value for p in points if p.answers['auto'].method):g}.",
            f"Beyond L/D = {safe_direct or 0:g} no solver has four digits in bending: the "
            f"condition number grows as (L/D)^{exponent:.2f}, and rounding has already changed the "
            "stiffness. The program bounds that, and what it answers is off by at most "
            f"{max(within):.2g} of its bound.",
        ],
        verdicts=verdicts,
        sections=sections,
        limits=limits,
        figures={
            "slenderness": x,
            "multigrid_iterations": [i.iterations for i in multigrid],
            "patch_iterations": [i.iterations for i in patches],
        },
    )


CASE = Case(
    name="stability/slender_shafts",
    title="Slender shafts: where multigrid stops, and where double precision ends",
    source="Spillane, Dolean, Hauret, Nataf, Pechstein and Scheichl 2014, Numer. Math. 126, "
    "741-770; Skeel 1979, J. ACM 26, 494-526; Saint-Venant's torsion; Euler-Bernoulli",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
