"""Second-order tetrahedra with straight sides on round surfaces: the order that they lose."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Elements through the wall; eight times as many round it.
WALLS, QUICK_WALLS = (3, 6, 9, 12), (2, 3, 4)

STIFFNESS, L2, ENERGY = "torsional stiffness", "L2 norm", "energy norm"

TORSION_ORDERS = {"straight": {STIFFNESS: 2.0}, "curved": {STIFFNESS: 4.0}}
BUSH_ORDERS = {"straight": {L2: 2.0, ENERGY: 1.5}, "curved": {L2: 3.0, ENERGY: 2.0}}


def run(run: Run) -> Any:
    """Mesh a shaft and a bush with straight and with curved elements on the same corners."""
    import numpy as np

    from fe_drivetrain.cases.verification import orders
    from fe_drivetrain.mesh import straightened
    from fe_drivetrain.report import Section, Text, judge
    from fe_drivetrain.validation import (
        manufactured as m,
    )
    from fe_drivetrain.validation.round_shafts import (
        Bush,
        Torsion,
        slice_of_tube,
    )

    def both(block: Any) -> dict[str, Any]:
        return {"straight": straightened(block.points, block.cells), "curved": block.points}

    def empty(theory: dict[str, dict[str, float]]) -> dict[str, dict[str, list[float]]]:
        return {kind: {name: [] for name in names} for kind, names in theory.items()}

    torsion, bush = Torsion(), Bush()
    walls = QUICK_WALLS if run.quick else WALLS
    blocks = [slice_of_tube(wall) for wall in walls]
    unknowns = [3 * len(block.points) for block in blocks]
    sizes = [1.0 / (8 * wall) for wall in walls]
    off: dict[str, list[float]] = {"straight": [], "curved": []}  # of the stiffness, with its sign
    of_shaft, of_bush = empty(TORSION_ORDERS), empty(BUSH_ORDERS)
    with run.step("torsion"):
        for block in blocks:
            for kind, points in both(block).items():
                rigidity = torsion.solve(block, points)
                off[kind].append(rigidity / torsion.rigidity - 1.0)
                of_shaft[kind][STIFFNESS].append(abs(off[kind][-1]))

    with run.step("bush"):
        for block in blocks:
            for kind, points in both(block).items():
                u = bush.solve(block, points)
                found = m.relative_errors(points, block.cells, u, bush, m.LAME, degree=6)
                for name, error in zip((L2, ENERGY), found, strict=True):
                    of_bush[kind][name].append(error)

    shafts = [
        m.Series(f"shaft, {kind} P2", sizes, unknowns, of_shaft[kind], TORSION_ORDERS[kind])
        for kind in off
    ]
    bushes = [
        m.Series(f"bush, {kind} P2", sizes, unknowns, of_bush[kind], BUSH_ORDERS[kind])
        for kind in off
    ]
    source = "theory: Strang and Fix 1973, ch. 4.4; Lenoir 1986 (recalled, not re-read)"
    verdicts = orders.order_verdicts(run, [*shafts, *bushes], source)

    sides, ratio = 8 * walls[-1], sizes[-1] / sizes[-2]
    straight, curved = off["straight"][-1], off["curved"][-1]
    change = curved - off["curved"][-2]
    verdicts += [
        judge(
            f"shaft, straight P2, {sides} sides: torsional rigidity less GJ, relative",
            straight,
            -4.0 / 3.0 * (np.pi / sides) ** 2,
            tolerance=2.0 * np.pi / sides,
            source="first variation of J: on a circle it sees the mean of the missing depth alone, "
            "R (pi / n)^2 / 3 of a polygon of n sides, so dJ / J = -4 (pi / n)^2 / 3",
            reason="terms of the next order are smaller by about the angle of a side",
            measure="stiffness",
            band=abs(straight - off["straight"][-2] * ratio**2),
        ),
        judge(
            f"shaft, curved P2, {sides} elements round: torsional rigidity",
            torsion.rigidity * (1.0 + curved),
            torsion.rigidity,
            tolerance=1e-3,
            source="exact: GJ, Saint-Venant",
            reason="a tenth of a percent is what a stiffness of the suite should be good for",
            unit="N m²",
            measure="stiffness",
            band=torsion.rigidity * abs(change) * ratio**4 / (1.0 - ratio**4),
        ),
    ]
    size = "element over circumference [-]"
    return CASE.results(
        run,
        summary=[
            f"With {sides} elements round the shaft straight-sided P2 is {straight:.1e} off GJ "
            f"and converges with order {shafts[0].order(STIFFNESS)[0]:.2f}, curved P2 on the same "
            f"corners {curved:.1e} with order {shafts[1].order(STIFFNESS)[0]:.2f}: "
            f"{abs(straight / curved):,.0f} times nearer at the same number of unknowns.",
            f"On a surface that is held the energy norm falls from order "
            f"{bushes[1].order(ENERGY)[0]:.2f} to {bushes[0].order(ENERGY)[0]:.2f}.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Free surface: a bored shaft in torsion",
                items=[
                    Text(
                        text="A slice of a bored shaft, one element thick, for nothing changes "
                        "along it: held on one side, under a torque on the other."
                    ),
                    orders.convergence_chart("Torsion of a bored shaft", shafts, size),
                    orders.convergence_table(shafts, size),
                    Text(
                        text="The exact displacement is quadratic, so straight P2 elements hold "
                        "it: all of their error comes from the shape. Chords leave out slivers of "
                        "a depth of up to R (π/n)²/2 at n sides, so the stiffness "
                        "converges with the square of the element's size. The "
                        "false tractions on the chords, whose normals are off by up to π/n, "
                        "change sign within each element; theory, which only knows their size, "
                        "allows an energy norm of order 1.5. On this "
                        "regular mesh their nodal forces cancel; the held surface below shows the "
                        "loss. Curved edges are parabolas: the stiffness converges with the "
                        "fourth power."
                    ),
                ],
            ),
            Section(
                title="Held surface: a bush",
                items=[
                    Text(
                        text="A tube is held outside, and its inner surface pushed along the axis: "
                        "u_x = U ln(r/R_o)/ln(R_i/R_o). Nodes on the chords have the displacement "
                        "of the surface, which the exact solution has a depth of up to "
                        "R (π/n)²/2 beside them. That difference swells and ends on every chord, "
                        "so it dies out within a layer as deep as a chord is long: a gradient of "
                        "the order of h in a volume of the order of h, √(h² h) = h^1.5 in the "
                        "energy norm. Its mean shifts all displacements by h²."
                    ),
                    orders.convergence_chart("A bush pushed along its axis", bushes, size),
                    orders.convergence_table(bushes, size),
                ],
            ),
        ],
        figures={
            one.label: {"sizes": one.sizes, "errors": one.errors} for one in [*shafts, *bushes]
        },
    )


CASE = Case(
    name="verification/straight_on_curved",
    title="Straight-sided second-order tetrahedra on a curved surface lose their order",
    source="exact: torsion of a round shaft, GJ (Saint-Venant), and a bush in axial shear; order: "
    "Strang and Fix 1973, An Analysis of the Finite Element Method, ch. 4.4 "
    "(recalled, not re-read)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
