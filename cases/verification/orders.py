"""Checks and charts of observed orders, shared by the cases of manufactured solutions."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.cases.references.manufactured import Series, three_waves
from fe_drivetrain.plots import PALETTE
from fe_drivetrain.report import Cell, Chart, Table, chart, trace
from fe_drivetrain.report.suite import Page, Run

SOLUTION = "Errors of the manufactured solution"
SIZE = "element size relative to the body [-]"

#: Allowed difference of observed order and theory. On the coarser meshes of a quick run terms of
#: the next order are still seen: of a relative size of h, they move the order by about as much.
FULL, QUICK = 0.1, 0.2

#: Where the orders k + 1 and k come from.
THEORY = (
    "theory: the energy of the error is the least that the elements allow (Cea), h^k of "
    "polynomials of degree k; in L2 one power more by duality (Aubin, Nitsche). Elements of a "
    "smooth body cut ever finer become affine, and keep it"
)

PROBLEM = (
    "Displacements are three plane waves, u = sum a sin(k·x + phase), and the body force that "
    "keeps them in balance follows in closed form. The body is a thick quarter ring (radii 1 and "
    "2 m, 1 m high) made of a unit cube, or a bar of 1 x 2 x 1 m. The inner cylinder has the "
    "displacement of the exact solution, the outer one carries its traction, evaluated on the true "
    "cylinder with its true normal; the four plane faces have their normal displacement "
    "prescribed and their tangential traction applied. Every edge is then by reflection a smooth "
    "boundary, so no singularity of the dual problem can spoil the order in L2. Norms are "
    "integrated over the elements with a rule of higher degree than that of the stiffness."
)


def _margin(run: Run) -> tuple[float, str]:
    """Allowed difference of observed order and theory, and why."""
    reason = "the usual margin of a code verification by orders: terms of higher order are still "
    reason += "in the error of finite meshes"
    if run.quick:
        return QUICK, f"{reason}, more so on the coarser meshes of a quick run"
    return FULL, reason


def check_orders(run: Run, page: Page, series: Sequence[Series], source: str) -> None:
    """Each observed order against theory."""
    tolerance, reason = _margin(run)
    for one in series:
        for name, theory in one.orders.items():
            order, change = one.order(name)
            page.equals(
                f"{one.label}: order in {name}",
                order,
                theory,
                within=tolerance / theory,
                why=reason,
                source=source,
                measure="order",
                band=change,
            )


def check_fields(page: Page) -> None:
    """The hand-made derivatives of the manufactured solution against the complex step."""
    places = np.random.default_rng(0).uniform(-1.0, 2.0, (200, 3))
    errors = three_waves().derivative_errors(places)
    for what, error in zip(("gradient", "body force"), errors, strict=True):
        page.vanishes(
            f"manufactured {what}: closed form against complex-step derivative",
            error,
            within=1e-13,
            why="both are exact to round-off; sums of a few dozen terms lose two digits",
            source="complex step, Im f(x + i h) / h: an error of order h^2, and no difference that "
            "cancels (manual of statsmodels, numdiff.approx_fprime_cs)",
        )


def add_manufactured(run: Run, page: Page, series: Sequence[Series], *notes: str) -> None:
    """Checks, chart and table of a manufactured solution; the chart is `captioned(SOLUTION)`."""
    check_orders(run, page, series, THEORY)
    check_fields(page)
    page.section("Problem")
    page.text(PROBLEM)
    page.section("Convergence")
    add_convergence(page, SOLUTION, series)
    for note in notes:
        page.text(note)


def add_convergence(page: Page, caption: str, series: Sequence[Series], size: str = SIZE) -> None:
    """Chart, table and data of errors over element size; `size` is its name, with the unit."""
    page.add(convergence_chart(caption, series, size), convergence_table(series, size))
    for one in series:
        page.data(one.label, {"sizes": one.sizes, "unknowns": one.unknowns, "errors": one.errors})


def captioned(caption: str) -> str:
    """The whole caption of the chart of `add_convergence`."""
    return (
        f"{caption}. In the legend the observed order of the two finest meshes; thin dotted lines "
        "have the order of theory"
    )


def convergence_chart(caption: str, series: Sequence[Series], size: str) -> Chart:
    """Errors over element size, both logarithmic, with the slopes of theory through the finest."""
    lines = []
    for colour, one in zip(PALETTE, series, strict=False):
        h = np.array(one.sizes)
        for k, (name, values) in enumerate(one.errors.items()):
            style = {"color": colour, "dash": ("solid", "dash", "dashdot")[k]}
            label = f"{one.label}, {name}: {one.order(name)[0]:.2f}"
            lines.append(trace(label, h, values, mode="lines+markers", line=style))
            theory = values[-1] * (h / h[-1]) ** one.orders[name]
            dots = {"color": colour, "dash": "dot", "width": 1}
            label = f"order {one.orders[name]:g}"
            lines.append(trace(label, h, theory, line=dots, showlegend=False))
    return chart(
        captioned(caption),
        lines,
        size,
        "relative error",
        "xy",
    )


def convergence_table(series: Sequence[Series], size: str) -> Table:
    """Errors and observed orders mesh by mesh."""
    rows: list[list[Cell]] = []
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
