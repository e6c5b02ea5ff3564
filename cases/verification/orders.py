"""How the cases of manufactured solutions judge and show observed orders."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.report import Chart, Results, Section, Table, Text, Verdict, judge, trace
from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run
from fe_drivetrain.validation import manufactured as m
from fe_drivetrain.validation.manufactured import Series

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
        convergence_chart("Errors of the manufactured solution", series, SIZE),
        convergence_table(series, SIZE),
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


def convergence_chart(caption: str, series: Sequence[Series], size: str) -> Chart:
    """Errors over element size, both logarithmic, with the slopes of theory through the finest.

    Parameters
    ----------
    size
        What the sizes are, with their unit.
    """
    colours = ("#1f77b4", "#d62728", "#2ca02c", "#9467bd", "#ff7f0e", "#8c564b")
    data = []
    for colour, one in zip(colours, series, strict=False):
        h = np.array(one.sizes)
        for k, (name, values) in enumerate(one.errors.items()):
            style = {"color": colour, "dash": ("solid", "dash", "dashdot")[k]}
            label = f"{one.label}, {name}: {one.order(name)[0]:.2f}"
            data.append(trace(label, h, values, mode="lines+markers", line=style))
            theory = values[-1] * (h / h[-1]) ** one.orders[name]
            dots = {"color": colour, "dash": "dot", "width": 1}
            label = f"order {one.orders[name]:g}"
            data.append(trace(label, h, theory, line=dots, showlegend=False))
    return Chart(
        caption=f"{caption}. In the legend the observed order of the two finest meshes; thin "
        "dotted lines have the order of theory",
        figure={
            "data": data,
            "layout": {
                "xaxis": {"title": {"text": size}, "type": "log"},
                "yaxis": {
                    "title": {"text": "relative error"},
                    "type": "log",
                    "exponentformat": "power",
                },
            },
        },
    )


def convergence_table(series: Sequence[Series], size: str) -> Table:
    """Errors and observed orders mesh by mesh."""
    rows: list[list[Any]] = []
    for one in series:
        for name, values in one.errors.items():
            slopes = [None, *(float(s) for s in one.slopes(name))]
            for h, n, error, slope in zip(one.sizes, one.unknowns, values, slopes, strict=True):
                rows.append([one.label, name, h, n, error, slope, one.orders[name]])
    return Table(
        caption="Errors, and observed order from the mesh before",
        columns=["element", "error in", size, "unknowns", "relative error", "order", "theory"],
        rows=rows,
    )
