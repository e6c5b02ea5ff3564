"""Richardson extrapolation and grid convergence index on series whose limit is known."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: The worked set: cells in two dimensions, and solutions, coarse first.
CELLS, SOLUTIONS = (4500, 8000, 18000), (5.863, 5.972, 6.063)

#: Orders of series without noise: what elements of first and second order give in energy and in
#: displacement, and a singular corner.
ORDERS = (0.5, 1.09, 2.0, 3.0, 4.0)
RATIOS = {
    "halved": (1.0, 0.5, 0.25),
    "unequal": (1.0, 0.7, 0.55, 0.35),
}


def run(run: Run) -> Any:
    """Judge series of known order, the published set, and series without order."""
    import numpy as np

    from fe_drivetrain.compare import grid_convergence
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace

    exact = "the series' own definition, f0 + c h^p"
    rows: list[list[Any]] = []
    verdicts, traces = [], []
    with run.step("series"):
        for name, sizes in RATIOS.items():
            for order in ORDERS:
                h = np.array(sizes)
                values = 10.0 + 0.3 * h**order
                found = grid_convergence(h, values)
                error = found.finest - 10.0
                verdicts.append(
                    judge(
                        f"order {order:g}, sizes {name}: observed order",
                        found.order,
                        order,
                        tolerance=1e-6,
                        source=exact,
                        reason="differences of numbers near 10 lose ten digits at the most",
                        measure="order",
                    )
                )
                verdicts.append(
                    judge(
                        f"order {order:g}, sizes {name}: extrapolated less limit, over the error "
                        "of the finest value",
                        (found.extrapolated - 10.0) / error,
                        0.0,
                        tolerance=1e-6,
                        relative=False,
                        source=exact,
                        reason="round-off of the same differences",
                        measure="identity",
                    )
                )
                rows.append(
                    [name, order, found.order, found.extrapolated, error, found.uncertainty]
                )
                traces.append(
                    trace(
                        f"order {order:g}, {name}",
                        h,
                        np.abs(values - found.extrapolated),
                        mode="lines+markers",
                    )
                )

        published = "worked example of Celik et al. 2008, J. Fluids Eng. 130, 078001, Table 1"
        h = np.array(CELLS) ** -0.5
        worked = grid_convergence(h, SOLUTIONS)
        digits = "half of the last digit printed"
        for quantity, value, printed, half, unit in (
            ("GCI of the coarse and the middle grid", 100 * worked.gci_coarse, 4.11, 0.005, "%"),
            ("GCI of the middle and the fine grid", 100 * worked.gci_fine, 2.17, 0.005, "%"),
            ("asymptotic ratio", worked.asymptotic_ratio, 1.015, 0.0005, ""),
        ):
            verdicts.append(
                judge(
                    f"worked set: {quantity}",
                    value,
                    printed,
                    tolerance=half,
                    relative=False,
                    unit=unit,
                    source=published,
                    reason=digits,
                )
            )
        for quantity, value, printed, half, unit in (
            ("observed order", worked.order, 1.53, 0.005, ""),
            ("extrapolated value", worked.extrapolated, 6.1685, 0.00005, ""),
        ):
            verdicts.append(
                judge(
                    f"worked set: {quantity}",
                    value,
                    printed,
                    tolerance=half,
                    relative=False,
                    unit=unit,
                    source=f"{published} (recalled, not re-read)",
                    reason=digits,
                )
            )
        verdicts.append(
            judge(
                "worked set: asymptotic ratio less the ratio of the two finest solutions",
                worked.asymptotic_ratio - SOLUTIONS[2] / SOLUTIONS[1],
                0.0,
                tolerance=1e-9,
                relative=False,
                source="algebra: with the order observed on the same grids both are one number",
                reason="round-off",
                measure="identity",
            )
        )

        irregular = {
            "oscillating, f0 = 10": (10.3, 9.85, 10.075),
            "turns round at the end": (10.3, 10.1, 10.1),
            "differences grow": (10.0, 10.1, 10.3),
            "round-off": (10.0, 10.0 + 2e-15, 10.0),
            "mixture 0.1 h + h^2, f0 = 10": tuple(10 + 0.1 * s + s * s for s in (1.0, 0.5, 0.25)),
        }
        told: list[list[Any]] = []
        for name, given in irregular.items():
            free = grid_convergence((1.0, 0.5, 0.25), given)
            least = grid_convergence((1.0, 0.5, 0.25), given, least_order=1.0)
            told.append([name, *given, free.behaviour, _finite(free.uncertainty), free.sentence()])
            told.append(
                [
                    f"{name}; least order 1",
                    *given,
                    least.behaviour,
                    _finite(least.uncertainty),
                    least.sentence(),
                ]
            )
            if "f0 = 10" in name:
                verdicts.append(
                    judge(
                        f"{name}, least order 1: distance to the limit over the band",
                        abs(given[-1] - 10.0) / least.uncertainty,
                        0.5,
                        tolerance=0.5,
                        relative=False,
                        source=exact,
                        reason="the band must hold the limit: at most 1",
                    )
                )

    solid = grid_convergence(np.array(CELLS) ** (-1 / 3), SOLUTIONS)
    return CASE.results(
        run,
        summary=[
            "Order and limit of series f0 + c h^p come out to round-off, for sizes of equal and of "
            "unequal ratio.",
            f"The worked set follows from the formulas: GCI {100 * worked.gci_coarse:.2f} % and "
            f"{100 * worked.gci_fine:.2f} %, asymptotic ratio {worked.asymptotic_ratio:.3f}, "
            f"order {worked.order:.2f}. That ratio is only the ratio of the two finest solutions: "
            "with an order observed on the same three grids it tests nothing.",
            "Oscillating and diverging series are told as such, with a wide band or none.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Series of known order",
                items=[
                    chart(
                        "Distance to the extrapolated limit: straight lines of slope p",
                        traces,
                        "size h",
                        "|f(h) - extrapolated|",
                        ("x", "y"),
                    ),
                    Table(
                        caption="f = 10 + 0.3 h^p",
                        columns=[
                            "sizes",
                            "order",
                            "observed order",
                            "extrapolated",
                            "error of the finest",
                            "± finest",
                        ],
                        rows=rows,
                    ),
                ],
            ),
            Section(
                title="The worked set",
                items=[
                    Text(text=f"In two dimensions (size = cells^-1/2): {worked.sentence()}."),
                    Text(
                        text="Cell counts say nothing of the dimension. In three (cells^-1/3) the "
                        f"observed order is {solid.order:.2f} in place of {worked.order:.2f}, and "
                        f"the GCI the same, {100 * solid.gci_fine:.2f} %: only r^p enters it."
                    ),
                ],
            ),
            Section(
                title="Series without an order",
                items=[
                    Table(
                        caption="What is told of them; a least order is what the user may count on",
                        columns=[
                            "series",
                            "f(1)",
                            "f(1/2)",
                            "f(1/4)",
                            "behaviour",
                            "±",
                            "in words",
                        ],
                        rows=told,
                    )
                ],
            ),
        ],
        figures={"gci_fine": worked.gci_fine, "gci_coarse": worked.gci_coarse},
    )


def _finite(value: float) -> float | str:
    return "none" if value == float("inf") else value


CASE = Case(
    name="verification/grid_convergence_index",
    title="Grid convergence index: series of known order, and a published worked set",
    source="Roache 1994, J. Fluids Eng. 116, 405-413; Celik et al. 2008, J. Fluids Eng. 130, "
    "078001; ASME V&V 20-2009",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
