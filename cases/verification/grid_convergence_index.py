"""Richardson extrapolation and grid convergence index on series whose limit is known."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.comparison import (
    GridConvergence,
    grid_convergence,
    round_off,
)
from fe_drivetrain.report import trace
from fe_drivetrain.report.suite import Page, Record, Run

#: The worked set: cells in two dimensions, and solutions, coarse first.
CELLS, SOLUTIONS = (4500, 8000, 18000), (5.863, 5.972, 6.063)
CELIK = "worked example of Celik et al. 2008, J. Fluids Eng. 130, 078001, Table 1"

#: Orders of series without noise: what elements of first and second order give in energy and in
#: displacement, and a singular corner.
ORDERS = (0.5, 1.09, 2.0, 3.0, 4.0)
RATIOS = {
    "halved": (1.0, 0.5, 0.25),
    "unequal": (1.0, 0.7, 0.55, 0.35),
}
EXACT = "the series' own definition, f0 + c h^p"

DISTANCES = "Distance to the extrapolated limit: straight lines of slope p"

#: Series without an order, of sizes 1, 1/2 and 1/4.
IRREGULAR = {
    "oscillating, f0 = 10": (10.3, 9.85, 10.075),
    "turns round at the end": (10.3, 10.1, 10.1),
    "differences grow": (10.0, 10.1, 10.3),
    "round-off": (10.0, 10.0 + 2e-15, 10.0),
    "mixture 0.1 h + h^2, f0 = 10": tuple(10 + 0.1 * s + s * s for s in (1.0, 0.5, 0.25)),
}


@case(
    "Grid convergence index: series of known order, and a published worked example",
    source="Roache 1994, J. Fluids Eng. 116, 405-413; Celik et al. 2008, J. Fluids Eng. 130, "
    "078001; ASME V&V 20-2009",
)
def run(run: Run, page: Page) -> None:
    """Judge series of known order, the published set, and series without order."""
    page.section("Series of known order")
    run.timed("series", known_orders, page)
    worked = grid_convergence(np.array(CELLS) ** -0.5, SOLUTIONS)
    check_worked(page, worked)
    page.section("The worked set")
    page.text(f"In two dimensions (size = cells^-1/2): {worked.sentence()}.")
    solid = grid_convergence(np.array(CELLS) ** (-1 / 3), SOLUTIONS)
    page.text(
        "Cell counts say nothing of the dimension. In three (cells^-1/3) the observed order is "
        f"{solid.order:.2f} in place of {worked.order:.2f}, and the GCI the same, "
        f"{100 * solid.gci_fine:.2f} %: only r^p enters it."
    )
    page.section("Series without an order")
    without_order(page)
    answer(page)
    page.say(
        "Order and limit of series f0 + c h^p are found to round-off, for sizes of equal and of "
        "unequal ratio. Oscillating and diverging series are recognised as such, with a wide band "
        "or none."
    )
    page.data("gci_fine", worked.gci_fine)
    page.data("gci_coarse", worked.gci_coarse)


def answer(page: Page) -> None:
    """State the published example beside what the program finds."""
    coarse, fine, order, ratio = (
        page.judged(f"worked set: {quantity}", name, "Celik et al.", printed)
        for quantity, name, printed in (
            ("GCI of the coarse and the middle grid", "GCI, coarse and middle grid", "4.11"),
            ("GCI of the middle and the fine grid", "GCI, middle and fine grid", "2.17"),
            ("observed order", "observed order", "1.53"),
            ("asymptotic ratio", "asymptotic ratio", "1.015"),
        )
    )
    agree = all(one.status == "good" for one in (coarse, fine, order, ratio))
    page.answer(
        "Does the grid convergence index (GCI) reproduce the published worked example?",
        f"{'Yes' if agree else 'No'}: GCIs of {coarse.value:.2f}\u00a0% and "
        f"{fine.value:.2f}\u00a0% and an order of {order.value:.2f} "
        f"{'agree' if agree else 'do not all agree'} with the digits printed by Celik et al.",
        [
            coarse,
            fine,
            order,
            ratio,
            page.judged(
                "oscillating, f0 = 10, least order 1: distance to the limit over the band",
                "oscillating series: error over band",
            ),
        ],
        hero=DISTANCES,
        cautions=[
            "With an order observed on the same three grids, the asymptotic ratio is that of the "
            "two finest solutions, and tests nothing."
        ],
    )


def known_orders(page: Page) -> None:
    """Order and limit of f = 10 + 0.3 h^p."""
    rows, traces = [], []
    for name, sizes in RATIOS.items():
        for order in ORDERS:
            h = np.array(sizes)
            values = 10.0 + 0.3 * h**order
            found = grid_convergence(h, values)
            error = found.finest - 10.0
            page.equals(
                f"order {order:g}, sizes {name}: observed order",
                found.order,
                order,
                within=1e-6,
                why="differences of numbers near 10 lose ten digits at the most",
                source=EXACT,
                measure="order",
            )
            page.vanishes(
                f"order {order:g}, sizes {name}: extrapolated less limit, over the error of the "
                "finest value",
                (found.extrapolated - 10.0) / error,
                within=1e-6,
                why="round-off of the same differences",
                source=EXACT,
            )
            rows.append(
                {
                    "sizes": name,
                    "order": order,
                    "observed order": found.order,
                    "extrapolated": found.extrapolated,
                    "error of the finest": error,
                    "± finest": found.uncertainty,
                }
            )
            label = f"order {order:g}, {name}"
            distance = np.abs(values - found.extrapolated)
            traces.append(trace(label, h, distance, mode="lines+markers"))
    page.chart(
        DISTANCES,
        traces,
        "size h",
        "|f(h) - extrapolated|",
        "xy",
    )
    page.table("f = 10 + 0.3 h^p", rows)
    page.data("f = 10 + 0.3 h^p", rows)


def check_worked(page: Page, worked: GridConvergence) -> None:
    """The published set, to the digits printed."""
    for quantity, value, printed, half, unit in (
        ("GCI of the coarse and the middle grid", 100 * worked.gci_coarse, 4.11, 0.005, "%"),
        ("GCI of the middle and the fine grid", 100 * worked.gci_fine, 2.17, 0.005, "%"),
        ("asymptotic ratio", worked.asymptotic_ratio, 1.015, 0.0005, ""),
    ):
        page.equals(
            f"worked set: {quantity}",
            value,
            printed,
            within=half,
            relative=False,
            why="half of the last digit printed",
            source=CELIK,
            unit=unit,
        )
    for quantity, value, printed, half in (
        ("observed order", worked.order, 1.53, 0.005),
        ("extrapolated value", worked.extrapolated, 6.1685, 0.00005),
    ):
        page.equals(
            f"worked set: {quantity}",
            value,
            printed,
            within=half,
            relative=False,
            why="half of the last digit printed",
            source=f"{CELIK} (this entry recalled, not re-read)",
            basis="second-hand",
        )
    page.vanishes(
        "worked set: asymptotic ratio less the ratio of the two finest solutions",
        worked.asymptotic_ratio - SOLUTIONS[2] / SOLUTIONS[1],
        **round_off(
            100 * SOLUTIONS[2] / (SOLUTIONS[2] - SOLUTIONS[1]),
            "differences of solutions, whose order is found to the rounding of them",
        ),
        source="algebra: with the order observed on the same grids both are one number",
        basis="self-consistency",
    )


def without_order(page: Page) -> None:
    """What is reported of irregular series, with and without a least order."""
    rows: list[Record] = []
    for name, given in IRREGULAR.items():
        for label, min_order in ((name, None), (f"{name}; least order 1", 1.0)):
            found = grid_convergence((1.0, 0.5, 0.25), given, min_order=min_order)
            finite = np.isfinite(found.uncertainty)
            rows.append(
                {
                    "series": label,
                    **dict(zip(("f(1)", "f(1/2)", "f(1/4)"), given, strict=True)),
                    "behaviour": found.behaviour,
                    "±": found.uncertainty if finite else "none",
                    "in words": found.sentence(),
                }
            )
        if "f0 = 10" in name:
            page.at_most(
                f"{name}, least order 1: distance to the limit over the band",
                abs(given[-1] - 10.0) / found.uncertainty,
                1.0,
                why="the band must contain the limit",
                source=EXACT,
            )
    page.table(
        "What is reported of them; a least order is what the user may count on",
        rows,
    )
