"""How the cases of manufactured solutions judge and show observed orders."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.cases.verification import manufactured as m
from fe_drivetrain.report import Results, Section, Text, Verdict, judge
from fe_drivetrain.suite import Case, Run

SIZE = "element size relative to the body [-]"

#: Allowed difference of observed order and theory. On the coarser meshes of a quick run terms of
#: the next order are still seen: of a relative size of h, they move the order by about as much.
FULL, QUICK = 0.1, 0.2


def order_verdicts(run: Run, series: Sequence[m.Series], source: str) -> list[Verdict]:
    """Each observed order against theory."""
    tolerance, reason = FULL, "the usual margin of a code verification by orders: terms of higher "
    reason += "order are still in the error of finite meshes"
    if run.quick:
        tolerance, reason = QUICK, f"{reason}, more so on the coarser meshes of a quick run"
    verdicts = []
    for one in series:
        for name, theory in one.orders.items():
            order, change = one.order(name)
            verdicts.append(
                judge(
                    f"{one.label}: order in {name}",
                    order,
                    theory,
                    tolerance=tolerance / theory,
                    source=source,
                    reason=reason,
                    measure="order",
                    band=change,
                )
            )
    return verdicts


def field_verdicts() -> list[Verdict]:
    """The hand-made derivatives of the manufactured solution against the complex step."""
    places = np.random.default_rng(0).uniform(-1.0, 2.0, (200, 3))
    errors = m.three_waves().derivative_errors(places)
    return [
        judge(
            f"manufactured {what}: closed form against complex-step derivative",
            error,
            0.0,
            tolerance=1e-13,
            relative=False,
            source="Squire and Trapp 1998, SIAM Review 40, 110-112 (recalled, not re-read)",
            reason="both are exact to round-off; sums of a few dozen terms lose two digits",
            measure="identity",
            band=0.0,
        )
        for what, error in zip(("gradient", "body force"), errors, strict=True)
    ]


PROBLEM = (
    "Displacements are three plane waves, u = sum a sin(k·x + phase), and the body force that "
    "keeps them in balance follows in closed form. The body is a thick quarter ring (radii 1 and "
    "2 m, 1 m high) made of a unit cube, or a bar of 1 x 2 x 1 m. The inner cylinder is displaced "
    "as the exact solution says, the outer one carries its traction, evaluated on the true "
    "cylinder with its true normal; the four plane faces have their normal displacement "
    "prescribed and their tangential traction applied. Every edge is then by reflection a smooth "
    "boundary, so no singularity of the dual problem can spoil the order in L2. Norms are "
    "integrated over the elements with a rule of higher degree than that of the stiffness."
)


def results(case: Case, run: Run, series: Sequence[m.Series], notes: Sequence[str]) -> Results:
    """Summary, verdicts, chart and table of a manufactured solution."""
    said = "; ".join(
        f"{one.label} {' and '.join(f'{one.order(name)[0]:.2f}' for name in one.errors)}"
        for one in series
    )
    items: list[Any] = [
        m.convergence_chart("Errors of the manufactured solution", series, SIZE),
        m.convergence_table(series, SIZE),
        *(Text(text=note) for note in notes),
    ]
    return case.results(
        run,
        summary=[f"Observed orders in L2 and energy norm: {said}."],
        verdicts=[
            *order_verdicts(run, series, "theory, see the source of the case"),
            *field_verdicts(),
        ],
        sections=[
            Section(title="Problem", items=[Text(text=PROBLEM)]),
            Section(title="Convergence", items=items),
        ],
        figures={
            one.label: {"sizes": one.sizes, "unknowns": one.unknowns, "errors": one.errors}
            for one in series
        },
    )
