"""Orders of convergence of hexahedra for a manufactured solution; what trapezoids do to them."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run


def run(run: Run) -> Any:
    """Errors of hexahedra on a curved body, and of quadratic ones on trapezoids."""
    from fe_drivetrain.cases.verification import orders
    from fe_drivetrain.report import Section, Text, judge
    from fe_drivetrain.validation import (
        manufactured as m,
    )

    linear = (4, 6, 9) if run.quick else (4, 8, 12, 16)
    quadratic = (2, 3, 4) if run.quick else (2, 4, 6, 8)
    series = []
    for label, nodes, theory, divisions in (
        ("hexahedra of 8 nodes", 8, (2.0, 1.0), linear),
        ("hexahedra of 20 nodes", 20, (3.0, 2.0), quadratic),
        ("hexahedra of 27 nodes", 27, (3.0, 2.0), quadratic),
    ):
        with run.step(label):
            mesh = m.regular(nodes, m.quarter_ring)
            # assembled with degree 3 and 4, which are two and three points a direction
            one = m.convergence(label, divisions, mesh, m.RING, m.three_waves(), theory, degree=7)
            series.append(one)

    found = orders.results(
        CASE,
        run,
        series,
        [
            "Serendipity elements hold all quadratic polynomials only where their map is affine. A "
            "smooth body cut ever finer has elements ever nearer to parallelepipeds: their "
            "distortion falls with their size, and the order is kept."
        ],
    )

    coarse, fine = ((2, 4, 8), (4, 8, 16)) if run.quick else ((4, 8, 16), (4, 8, 16, 32))
    trapezoids = []
    for label, nodes, theory, divisions in (
        ("20 nodes, trapezoids", 20, (2.0, 1.0), fine),
        ("27 nodes, trapezoids", 27, (3.0, 2.0), coarse),
    ):
        with run.step(label):
            one = m.convergence(
                label, divisions, m.trapezoids(nodes), m.BAR, m.plane_waves(), theory, degree=7
            )
            trapezoids.append(one)
    serendipity, full = trapezoids
    source = "Arnold, Boffi and Falk 2002, Math. Comp. 71, 909-922"
    verdicts = orders.order_verdicts(run, [full], source)
    for name, limit in serendipity.orders.items():
        if run.quick and name == "L2 norm":
            continue  # comes down later than the energy norm, on finer meshes than these
        order, change = serendipity.order(name)
        verdicts.append(
            judge(
                f"{serendipity.label}: order in {name}",
                order,
                limit,
                tolerance=0.5,
                relative=False,
                source=source,
                reason="the order comes down from that of affine elements, one more, to this limit "
                "as the mesh is refined; less than half way from it says that the loss is there",
                measure="order",
                band=change,
            )
        )
    lost, kept = (one.order("energy norm")[0] for one in trapezoids)
    section = Section(
        title="Meshes that stay distorted",
        items=[
            Text(
                text="A square of one element's thickness is cut into trapezoids whose parallel "
                "sides stay 3 : 1 however fine the mesh. There the 20-node element, which lacks "
                "some of the products of quadratic terms, falls towards the order of linear "
                "elements, the 27-node element keeps its own. Meshes of shafts and rings are not "
                "of that kind."
            ),
            orders.convergence_chart("Errors on trapezoids", trapezoids, orders.SIZE),
            orders.convergence_table(trapezoids, orders.SIZE),
        ],
    )
    return found.model_copy(
        update={
            "summary": [
                *found.summary,
                f"On meshes of trapezoids 20 nodes fall to order {lost:.2f} in the energy norm, "
                f"27 nodes keep {kept:.2f}.",
            ],
            "verdicts": [*found.verdicts, *verdicts],
            "sections": [*found.sections, section],
            "times": run.times,
        }
    )


CASE = Case(
    name="verification/manufactured_hexahedra",
    title="Manufactured solution: order of convergence of hexahedra of 8, 20 and 27 nodes",
    source="exact: manufactured displacement; orders k + 1 in L2 and k in the energy norm, Ciarlet "
    "1978, The Finite Element Method for Elliptic Problems (recalled, not re-read); "
    "loss of order of serendipity elements "
    "Arnold, Boffi and Falk 2002, Math. Comp. 71, 909-922",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
