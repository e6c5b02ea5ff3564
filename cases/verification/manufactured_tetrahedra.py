"""Orders of convergence of tetrahedra for a manufactured solution, on a bar and a curved body."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import manufactured as m
from fe_drivetrain.cases.verification.orders import SOLUTION, add_manufactured, captioned
from fe_drivetrain.report.suite import Page, Run


def answer(page: Page) -> None:
    """State the orders in L2 and in energy of linear and quadratic tetrahedra."""
    labels = {"P1, quarter ring": "P1", "P2 straight, bar": "P2", "P2 curved, quarter ring": "P2"}
    l2, energy = (
        [page.judged(f"{label}: order in {norm}", f"{label}, {norm}", "theory") for label in labels]
        for norm in ("L2 norm", "energy norm")
    )
    theory = all(one.status == "good" for one in (*l2, *energy))
    page.answer(
        "Do linear and quadratic tetrahedra converge with the orders of theory?",
        f"{'Yes' if theory else 'No'}: in the L2 norm linear ones converge with order "
        f"{l2[0].value:.2f}, quadratic ones with {l2[1].value:.2f} on a bar and "
        f"{l2[2].value:.2f} on a curved ring.",
        [*l2, *energy],
        hero=captioned(SOLUTION),
        cautions=[
            "On a curved body quadratic tetrahedra keep their order only if their sides are curved."
        ],
    )


@case(
    "Manufactured solution: order of convergence of P1 and P2 tetrahedra",
    source="exact: manufactured displacement; orders k + 1 in L2 and k in the energy norm, Ciarlet "
    "1978, The Finite Element Method for Elliptic Problems (recalled, not re-read); isoparametric "
    "on curved domains Lenoir 1986, SIAM J. Numer. Anal. 23, 562-580 (recalled, not re-read)",
)
def run(run: Run, page: Page) -> None:
    """Errors of P1, of straight P2 on a bar, and of curved P2, on ever finer meshes."""
    p1 = (4, 6, 9) if run.quick else (4, 8, 12, 16)
    p2 = (2, 3, 4) if run.quick else (2, 4, 6, 8)
    series = []
    for label, nodes, shape, domain, theory, divisions in (
        ("P1, quarter ring", 4, m.quarter_ring, m.RING, (2.0, 1.0), p1),
        ("P2 straight, bar", 10, m.bar, m.BAR, (3.0, 2.0), p2),
        ("P2 curved, quarter ring", 10, m.quarter_ring, m.RING, (3.0, 2.0), p2),
    ):
        with run.step(label):
            mesh = m.regular(nodes, shape)
            # assembled with degree 2 and 4
            series.append(
                m.convergence(label, divisions, mesh, domain, m.three_waves(), theory, degree=6)
            )
    add_manufactured(
        run, page, series, "Straight P2 on a curved body: see the case straight_on_curved."
    )
    answer(page)
    page.image(
        "The quarter ring in curved tetrahedra", run.sketch(m.regular(10, m.quarter_ring)(2))
    )
