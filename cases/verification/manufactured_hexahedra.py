"""Orders of convergence of hexahedra for a manufactured solution; what trapezoids do to them."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import manufactured as m
from fe_drivetrain.cases.verification.orders import (
    SOLUTION,
    add_convergence,
    add_manufactured,
    captioned,
    check_orders,
)
from fe_drivetrain.report.suite import Page, Run

ARNOLD = "Arnold, Boffi and Falk 2002, Math. Comp. 71, 909-922"


@case(
    "Manufactured solution: order of convergence of hexahedra of 8, 20 and 27 nodes",
    source="exact: manufactured displacement; orders k + 1 in L2 and k in the energy norm, Ciarlet "
    "1978, The Finite Element Method for Elliptic Problems (recalled, not re-read); loss of order "
    "of serendipity elements Arnold, Boffi and Falk 2002, Math. Comp. 71, 909-922",
)
def run(run: Run, page: Page) -> None:
    """Errors of hexahedra on a curved body, and of quadratic ones on trapezoids."""
    linear = (4, 6, 9) if run.quick else (4, 8, 12, 16)
    quadratic = (2, 3, 4) if run.quick else (2, 4, 6, 8)
    series = []
    for nodes, theory, divisions in (
        (8, (2.0, 1.0), linear),
        (20, (3.0, 2.0), quadratic),
        (27, (3.0, 2.0), quadratic),
    ):
        label = f"hexahedra of {nodes} nodes"
        with run.step(label):
            mesh = m.regular(nodes, m.quarter_ring)
            # assembled with degree 3 and 4, which are two and three points a direction
            series.append(
                m.convergence(label, divisions, mesh, m.RING, m.three_waves(), theory, degree=7)
            )
    add_manufactured(
        run,
        page,
        series,
        "Serendipity elements contain all quadratic polynomials only where their map is affine. A "
        "smooth body cut ever finer has elements ever nearer to parallelepipeds: their distortion "
        "falls with their size, and the order is kept.",
    )
    serendipity, full = trapezoids(run)
    check_orders(run, page, [full], ARNOLD)
    check_loss(page, serendipity, run.quick)
    answer(page)
    page.section("Meshes that stay distorted")
    page.text(
        "A square of one element's thickness is cut into trapezoids whose parallel sides stay 3 : "
        "1 however fine the mesh. There the 20-node element, which does not contain some of the "
        "products of quadratic terms, falls towards the order of linear elements, the 27-node "
        "element keeps its own. Meshes of shafts and rings are not of that kind."
    )
    add_convergence(page, "Errors on trapezoids", [serendipity, full])
    page.image(
        "The quarter ring, in two, four and two elements",
        run.sketch(m.regular(27, m.quarter_ring)(2)),
    )


def answer(page: Page) -> None:
    """State the orders in L2 of all three elements, and what trapezoids do to one of them."""
    kinds = [f"hexahedra of {nodes} nodes" for nodes in (8, 20, 27)]
    orders = [
        page.judged(f"{kind}: order in L2 norm", f"order in L2, {kind}", "theory") for kind in kinds
    ]
    lost, kept = (
        page.judged(f"{n} nodes, trapezoids: order in energy norm", f"{n} nodes, {where}", "theory")
        for n, where in ((20, "trapezoids, energy"), (27, "trapezoids, energy"))
    )
    theory = all(one.status == "good" for one in (*orders, kept))
    *first, last = (f"{one.value:.2f}" for one in orders)
    page.answer(
        "Do hexahedra converge with the orders of theory?",
        f"{'Yes' if theory else 'No'}: in the L2 norm, hexahedra of 8, 20 and 27 nodes converge "
        f"with orders of {', '.join(first)} and {last}.",
        [*orders, kept, lost],
        hero=captioned(SOLUTION),
        cautions=[
            f"On meshes of trapezoids, however fine, elements of 20 nodes fall to an order of "
            f"{lost.value:.2f} in the energy norm."
        ],
    )


def trapezoids(run: Run) -> list[m.Series]:
    """Errors of quadratic elements that stay distorted, with 20 nodes and with 27."""
    coarse, fine = ((2, 4, 8), (4, 8, 16)) if run.quick else ((4, 8, 16), (4, 8, 16, 32))
    found = []
    for nodes, theory, divisions in ((20, (2.0, 1.0), fine), (27, (3.0, 2.0), coarse)):
        label = f"{nodes} nodes, trapezoids"
        with run.step(label):
            mesh = m.trapezoids(nodes)
            found.append(
                m.convergence(label, divisions, mesh, m.BAR, m.plane_waves(), theory, degree=7)
            )
    return found


def check_loss(page: Page, serendipity: m.Series, quick: bool) -> None:
    """Elements of 20 nodes come down to the order of linear ones."""
    for name, limit in serendipity.orders.items():
        if quick and name == "L2 norm":
            continue  # comes down later than the energy norm, on finer meshes than these
        order, change = serendipity.order(name)
        page.equals(
            f"{serendipity.label}: order in {name}",
            order,
            limit,
            within=0.5,
            relative=False,
            why="the order comes down from that of affine elements, one more, to this limit as the "
            "mesh is refined; less than half way from it shows that the loss is there",
            source=ARNOLD,
            measure="order",
            band=change,
        )
