"""Straight-sided second-order tetrahedra on curved surfaces: the loss of order."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.manufactured import NORMS, Series
from fe_drivetrain.cases.verification import round_shafts as bodies
from fe_drivetrain.cases.verification.orders import (
    add_convergence,
    captioned,
    check_orders,
)
from fe_drivetrain.elasticity.mesh import straightened
from fe_drivetrain.report.number_text import formatted, percent_text
from fe_drivetrain.report.suite import Page, Run, Target

WALLS, QUICK_WALLS = (3, 6, 9, 12), (2, 3, 4)  # elements through; eight times as many round
SHAFT, BUSH = bodies.Torsion(), bodies.Bush()
STIFFNESS, ENERGY = "torsional stiffness", NORMS[1]
#: Of the stiffness, and of the norms L2 and energy.
ORDERS = {"straight": (2.0, (2.0, 1.5)), "curved": (4.0, (3.0, 2.0))}
THEORY = (
    "derived on this page: chords lie up to R (pi / n)^2 / 2 inside the circle; curved elements "
    "keep the orders of smooth solutions. The same in Strang and Fix 1973, ch. 4.4, and Lenoir "
    "1986 (second-hand: neither was read itself); that straight elements lose their order on a "
    "curved boundary, and curved ones keep it, in Ruas 2017, J. Appl. Math. Phys. 5(11), abstract"
)
TWISTED = "Torsion of a bored shaft"
SIZE = "element over circumference [-]"


def answer(page: Page, sides: int, chords: float, arcs: float) -> None:
    """State the error of the torsional rigidity with straight and with curved elements."""
    page.answer(
        "How much accuracy do elements with straight sides lose on a curved surface?",
        f"With {sides} elements round a shaft, straight sides err by {percent_text(chords, 3)} in "
        f"its torsional rigidity, curved sides by {percent_text(arcs)}, "
        f"{formatted(abs(chords / arcs), 2)} times less.",
        [
            page.judged(
                f"shaft, straight P2, {sides} sides: torsional rigidity less GJ, relative",
                "error of the rigidity, straight sides",
                "polygon",
                unit="%",
            ),
            page.judged(
                f"shaft, curved P2, {sides} elements round: torsional rigidity",
                "torsional rigidity, curved sides",
                "G J",
                unit="GN m²",
            ),
            page.judged(
                "shaft, straight P2: order in torsional stiffness",
                "order, straight sides",
                "theory",
            ),
            page.judged(
                "shaft, curved P2: order in torsional stiffness", "order, curved sides", "theory"
            ),
        ],
        hero=captioned(TWISTED),
    )


@case(
    "Straight-sided second-order tetrahedra on a curved surface lose their order",
    source="exact: torsion of a round shaft, GJ (Saint-Venant), and a bush in axial shear; order: "
    "derived on its page, as in Strang and Fix 1973, An Analysis of the Finite Element Method, "
    "ch. 4.4 (second-hand)",
)
def run(run: Run, page: Page) -> None:
    """Mesh a shaft and a bush with straight and with curved elements on the same corners."""
    walls = QUICK_WALLS if run.quick else WALLS
    blocks, sides = [bodies.slice_of_tube(wall) for wall in walls], 8 * walls[-1]
    sizes, unknowns = [1.0 / (8 * wall) for wall in walls], [block.points.size for block in blocks]
    straight = [straightened(block.points, block.cells) for block in blocks]
    shafts, bushes, last = [], [], []
    for kind, points in (("straight", straight), ("curved", [b.points for b in blocks])):
        errors = run.timed("torsion", SHAFT.errors, blocks, points)
        stiffness = {STIFFNESS: [abs(error) for error in errors]}
        norms = run.timed("bush", BUSH.errors, blocks, points)
        order, orders = {STIFFNESS: ORDERS[kind][0]}, dict(zip(NORMS, ORDERS[kind][1], strict=True))
        shafts.append(Series(f"shaft, {kind} P2", sizes, unknowns, stiffness, order))
        bushes.append(Series(f"bush, {kind} P2", sizes, unknowns, norms, orders))
        last.append(errors[-2:])
    check_orders(run, page, [*shafts, *bushes], THEORY)
    (before, chords), (coarser, arcs), ratio = *last, sizes[-1] / sizes[-2]
    title = f"shaft, straight P2, {sides} sides: torsional rigidity less GJ, relative"
    polygon, within = bodies.polygon_deficit(sides), 2.0 * np.pi / sides
    why = "terms of the next order are smaller by about the angle of a side"
    target = Target(title, polygon, within, why, bodies.FIRST_VARIATION, measure="stiffness")
    page.meets(chords, target, abs(chords - before * ratio**2))
    title = f"shaft, curved P2, {sides} elements round: torsional rigidity [N m²]"
    good = "a tenth of a percent is what a stiffness of the suite should be good for"
    exact = SHAFT.rigidity, 1e-3, good, "exact: GJ, Saint-Venant"
    band = SHAFT.rigidity * abs(arcs - coarser) * ratio**4 / (1.0 - ratio**4)
    page.meets(SHAFT.rigidity * (1.0 + arcs), Target(title, *exact, measure="stiffness"), band)
    answer(page, sides, chords, arcs)
    page.say(
        "On a surface that is held the energy norm falls from order "
        f"{bushes[1].order(ENERGY)[0]:.2f} to {bushes[0].order(ENERGY)[0]:.2f}."
    )
    page.section("Free surface: a bored shaft in torsion")
    add_convergence(page, TWISTED, shafts, SIZE)
    page.text(
        "A slice of a bored shaft, one element thick, held on one side, under a torque on the "
        "other. The exact displacement is quadratic, so straight P2 elements hold it: all of their "
        "error comes from the shape. Chords leave out slivers up to R (π/n)²/2 deep at n sides, so "
        "the stiffness converges with the square of the element's size. The false tractions on the "
        "chords, whose normals have errors of up to π/n, change sign within each element; theory, "
        "which only knows their size, allows an energy norm of order 1.5. On this regular mesh "
        "their nodal forces cancel; the held surface below shows the loss. Curved edges are "
        "parabolas: the stiffness converges with the fourth power."
    )
    page.section("Held surface: a bush")
    add_convergence(page, "A bush pushed along its axis", bushes, SIZE)
    page.text(
        "A tube is held outside, its inner surface pushed along the axis: u_x = U ln(r/R_o) / "
        "ln(R_i/R_o). Nodes on the chords have the displacement of the surface, which the exact "
        "solution has a depth of up to R (π/n)²/2 beside them. That difference swells and ends on "
        "every chord, so it dies out within a layer as deep as a chord is long: a gradient of the "
        "order of h in a volume of the order of h, √(h² h) = h^1.5 in the energy norm. Its mean "
        "shifts all displacements by h²."
    )
    page.image("The slice of a tube, coarsest mesh", run.sketch(blocks[0]))
