"""Straight-sided second-order tetrahedra on curved surfaces: the loss of order."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.orders import add_convergence, check_orders
from fe_drivetrain.mesh import straightened
from fe_drivetrain.suite import Page, Run
from fe_drivetrain.validation import manufactured as m
from fe_drivetrain.validation.round_shafts import Bush, Torsion, slice_of_tube

#: Elements through the wall; eight times as many round it.
WALLS, QUICK_WALLS = (3, 6, 9, 12), (2, 3, 4)

STIFFNESS, L2, ENERGY = "torsional stiffness", "L2 norm", "energy norm"

TORSION_ORDERS = {"straight": {STIFFNESS: 2.0}, "curved": {STIFFNESS: 4.0}}
BUSH_ORDERS = {"straight": {L2: 2.0, ENERGY: 1.5}, "curved": {L2: 3.0, ENERGY: 2.0}}

THEORY = (
    "derived on this page: chords lie up to R (pi / n)^2 / 2 inside the circle; curved elements "
    "keep the orders of smooth solutions. The same in Strang and Fix 1973, ch. 4.4, and Lenoir "
    "1986 (second-hand: neither was read itself); that straight elements lose their order on a "
    "curved boundary, and curved ones keep it, in Ruas 2017, J. Appl. Math. Phys. 5(11), abstract"
)
SIZE = "element over circumference [-]"


@case(
    "Straight-sided second-order tetrahedra on a curved surface lose their order",
    source="exact: torsion of a round shaft, GJ (Saint-Venant), and a bush in axial shear; order: "
    "derived on its page, as in Strang and Fix 1973, An Analysis of the Finite Element Method, "
    "ch. 4.4 (second-hand)",
)
def run(run: Run, page: Page) -> None:
    """Mesh a shaft and a bush with straight and with curved elements on the same corners."""
    torsion, bush = Torsion(), Bush()
    walls = QUICK_WALLS if run.quick else WALLS
    blocks = [slice_of_tube(wall) for wall in walls]
    sides = 8 * walls[-1]
    sizes = [1.0 / (8 * wall) for wall in walls]
    unknowns = [block.points.size for block in blocks]
    error: dict[str, list[float]] = {}  # of the stiffness, with its sign
    shafts, bushes = [], []
    for kind in ("straight", "curved"):
        places = [
            straightened(block.points, block.cells) if kind == "straight" else block.points
            for block in blocks
        ]
        with run.step("torsion"):
            rigidities = [torsion.solve(*pair) for pair in zip(blocks, places, strict=True)]
        error[kind] = [rigidity / torsion.rigidity - 1.0 for rigidity in rigidities]
        errors = {STIFFNESS: [abs(value) for value in error[kind]]}
        shafts.append(m.Series(f"shaft, {kind} P2", sizes, unknowns, errors, TORSION_ORDERS[kind]))
        with run.step("bush"):
            norms = [
                m.relative_errors(
                    points, block.cells, bush.solve(block, points), bush, m.LAME, degree=6
                )
                for block, points in zip(blocks, places, strict=True)
            ]
        errors = {L2: [l2 for l2, _ in norms], ENERGY: [energy for _, energy in norms]}
        bushes.append(m.Series(f"bush, {kind} P2", sizes, unknowns, errors, BUSH_ORDERS[kind]))

    check_orders(run, page, [*shafts, *bushes], THEORY)
    ratio = sizes[-1] / sizes[-2]
    straight, curved = error["straight"][-1], error["curved"][-1]
    page.equals(
        f"shaft, straight P2, {sides} sides: torsional rigidity less GJ, relative",
        straight,
        -4.0 / 3.0 * (np.pi / sides) ** 2,
        within=2.0 * np.pi / sides,
        why="terms of the next order are smaller by about the angle of a side",
        source="first variation of J: on a circle it sees the mean of the missing depth alone, "
        "R (pi / n)^2 / 3 of a polygon of n sides, so dJ / J = -4 (pi / n)^2 / 3",
        measure="stiffness",
        band=abs(straight - error["straight"][-2] * ratio**2),
    )
    change = abs(curved - error["curved"][-2])
    page.equals(
        f"shaft, curved P2, {sides} elements round: torsional rigidity [N m²]",
        torsion.rigidity * (1.0 + curved),
        torsion.rigidity,
        within=1e-3,
        why="a tenth of a percent is what a stiffness of the suite should be good for",
        source="exact: GJ, Saint-Venant",
        measure="stiffness",
        band=torsion.rigidity * change * ratio**4 / (1.0 - ratio**4),
    )
    page.headline = "shaft, curved P2: order in torsional stiffness"
    page.answer(
        f"With {sides} elements round the shaft the torsional rigidity of straight-sided P2 has an "
        f"error of {straight:.1e} and converges with order {shafts[0].order(STIFFNESS)[0]:.2f}, "
        f"that of curved P2 on the same corners {curved:.1e} and order "
        f"{shafts[1].order(STIFFNESS)[0]:.2f}: {abs(straight / curved):,.0f} times less at the "
        "same number of unknowns.",
        f"On a surface that is held the energy norm falls from order "
        f"{bushes[1].order(ENERGY)[0]:.2f} to {bushes[0].order(ENERGY)[0]:.2f}.",
    )
    page.section("Free surface: a bored shaft in torsion")
    page.text(
        "A slice of a bored shaft, one element thick, for nothing changes along it: held on one "
        "side, under a torque on the other."
    )
    add_convergence(page, "Torsion of a bored shaft", shafts, SIZE)
    page.text(
        "The exact displacement is quadratic, so straight P2 elements hold it: all of their error "
        "comes from the shape. Chords leave out slivers of a depth of up to R (π/n)²/2 at n sides, "
        "so the stiffness converges with the square of the element's size. The false tractions on "
        "the chords, whose normals have errors of up to π/n, change sign within each element; "
        "theory, which only knows their size, allows an energy norm of order 1.5. On this regular "
        "mesh their nodal forces cancel; the held surface below shows the loss. Curved edges are "
        "parabolas: the stiffness converges with the fourth power."
    )
    page.section("Held surface: a bush")
    page.text(
        "A tube is held outside, and its inner surface pushed along the axis: "
        "u_x = U ln(r/R_o)/ln(R_i/R_o). Nodes on the chords have the displacement of the surface, "
        "which the exact solution has a depth of up to R (π/n)²/2 beside them. That difference "
        "swells and ends on every chord, so it dies out within a layer as deep as a chord is long: "
        "a gradient of the order of h in a volume of the order of h, √(h² h) = h^1.5 in the energy "
        "norm. Its mean shifts all displacements by h²."
    )
    add_convergence(page, "A bush pushed along its axis", bushes, SIZE)
