"""Patch tests: constant strain and stress, reproduced by every element in every shape."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Degrees of quadrature that are tried for the forces on nodes inside.
DEGREES = (1, 2, 3, 4, 5, 6)


def run(run: Run) -> Any:
    """Six strain states on distorted blocks: displacements given all round, then tractions."""
    import numpy as np

    from fe_drivetrain.common import STRESSES
    from fe_drivetrain.interfaces import freedoms
    from fe_drivetrain.mesh import element_kind
    from fe_drivetrain.operator import tensor, traction_loads
    from fe_drivetrain.report import Chart, Section, Table, Text, judge, trace
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation import (
        distorted_blocks,
    )
    from fe_drivetrain.validation.manufactured import (
        LAME,
    )

    lam, mu = LAME
    strains = tensor(np.eye(6))  # one component of the tensor each, shear ones both ways
    sigmas = lam * np.trace(strains, axis1=1, axis2=2)[:, None, None] * np.eye(3) + 2 * mu * strains

    rows: list[list[Any]] = []
    verdicts, traces = [], []
    for patch in distorted_blocks.patches():
        block = patch.block
        points, cells, n = block.points, block.cells, 3 * len(block.points)
        exact = np.einsum("kij,nj->nik", strains, points).reshape(n, 6)

        with run.step("displacements given all round"):
            held = freedoms(patch.outer).ravel()
            strong = solve_solid(
                points,
                cells,
                LAME,
                [],
                np.zeros((n, 6)),
                prescribed=(held, exact[held]),
                method="superlu",
            )
        with run.step("tractions, six freedoms held"):
            F = np.zeros((n, 6))
            for k, sigma in enumerate(sigmas):
                for facets in block.faces.values():
                    F[:, k] += traction_loads(
                        points, facets, distorted_blocks.constant_traction(sigma)
                    )
            origin, along_x, along_y = freedoms(patch.holders)
            minimal = np.array([*origin, along_x[1], along_x[2], along_y[2]])
            weak = solve_solid(
                points,
                cells,
                LAME,
                [],
                F,
                prescribed=(minimal, exact[minimal]),
                method="superlu",
            )
        by_displacements = distorted_blocks.worst_errors(patch, strong.u, exact, sigmas)
        by_tractions = distorted_blocks.worst_errors(patch, weak.u, exact, sigmas)
        reaction = np.abs(weak.reactions["prescribed"]).max() / np.abs(F).sum(axis=0).min()
        found = {
            "displacements given, displacement": (by_displacements[0], 1e-12),
            "displacements given, stress": (by_displacements[1], 1e-12),
            "tractions given, displacement": (by_tractions[0], 1e-10),
            "tractions given, stress": (by_tractions[1], 1e-10),
            "tractions given, reaction of the supports": (reaction, 1e-12),
        }
        reasons = {
            1e-12: "round-off: some thousand operations of 1e-16 each",
            1e-10: "round-off times the condition number of a block on six freedoms, 1e5 to 1e6",
        }
        verdicts += [
            judge(
                f"{patch.label}: {what}, largest error of six strain states",
                error,
                0.0,
                tolerance=tolerance,
                relative=False,
                source="exact: linear displacement, constant stress (patch test: Bazeley, "
                "Cheung, Irons and Zienkiewicz 1965; recalled, not re-read)",
                reason=reasons[tolerance],
                measure="identity",
                band=0.0,
            )
            for what, (error, tolerance) in found.items()
        ]
        quadratic = distorted_blocks.quadratic_error(patch)
        if patch.holds_quadratics:
            verdicts.append(
                judge(
                    f"{patch.label}: interpolated quadratic field, largest error of strain",
                    quadratic,
                    0.0,
                    tolerance=1e-12,
                    relative=False,
                    source="exact: the element holds all quadratic polynomials in this shape",
                    reason=reasons[1e-12],
                    measure="identity",
                    band=0.0,
                )
            )
        rows.append(
            [
                patch.label,
                len(cells),
                len(points),
                patch.jacobian_ratio(),
                *(error for error, _ in found.values()),
                quadratic,
            ]
        )
        if cells.shape[1] > 4:
            with run.step("forces by degree of quadrature"):
                forces = [
                    max(distorted_blocks.inner_forces(patch, sigma, degree) for sigma in sigmas)
                    for degree in DEGREES
                ]
            own = element_kind(cells.shape[1]).degree
            marks = {"size": [14 if d == own else 6 for d in DEGREES]}
            shown = np.maximum(forces, 1e-17)
            traces.append(trace(patch.label, DEGREES, shown, mode="lines+markers", marker=marks))

    worst = max(v.computed for v in verdicts if "displacements given" in v.quantity)
    chart = Chart(
        caption="Force of a constant stress on nodes inside, by degree of the quadrature, relative "
        "to the largest of one element on a node; the large marker is the assembly's own rule",
        figure={
            "data": traces,
            "layout": {
                "xaxis": {"title": {"text": "degree asked of the quadrature"}, "dtick": 1},
                "yaxis": {
                    "title": {"text": "false force on nodes inside [-]"},
                    "type": "log",
                    "exponentformat": "power",
                },
            },
        },
    )
    return CASE.results(
        run,
        summary=[
            f"All {len(rows)} blocks reproduce the six constant strains, displacement and stress, "
            f"to {worst:.0e} with displacements given all round, and with tractions on six held "
            "freedoms to round-off; curved serendipity elements among them.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Patch tests",
                items=[
                    Table(
                        caption="Largest errors over six strain states "
                        f"({', '.join(STRESSES)}), relative to the largest value of each. Nodes "
                        "are moved at random, inside and on the surface",
                        columns=[
                            "element",
                            "elements",
                            "nodes",
                            "smallest over largest Jacobian in an element",
                            *(what for what in found),
                            "strain of an interpolated quadratic field",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="Displacements given all round: nodes inside must follow the linear "
                        "field. Tractions: the exact stress times the outward normal, also on "
                        "curved outer faces, with the six freedoms of a rigid body prescribed; the "
                        "supports must then feel nothing."
                    ),
                ],
            ),
            Section(
                title="Why curved elements pass, and what it takes",
                items=[
                    Text(
                        text="An isoparametric element holds every linear field whatever its "
                        "shape: x itself is a combination of its shape functions. So the curved "
                        "20-node element passes too. Quadratic fields are another matter, the last "
                        "column: ten-node tetrahedra hold them with straight edges, 27-node "
                        "hexahedra with straight edges, 20-node hexahedra only as "
                        "parallelepipeds, none when curved. A patch test also needs the forces of"
                        " a constant stress on a node to cancel between elements, and that takes "
                        "a quadrature that integrates cofactors of the map times gradients "
                        "exactly: degree 3 for curved ten-node tetrahedra (the assembly uses 4), "
                        "2 in each direction for 8-node hexahedra (two points hold 3), 5 in each "
                        "direction for curved 20- and 27-node hexahedra (three points hold just "
                        "5). One point less a direction, the usual reduced integration, and "
                        "curved quadratic hexahedra fail."
                    ),
                    chart,
                ],
            ),
        ],
    )


CASE = Case(
    name="verification/patch_elements",
    title="Patch tests: constant strain in every element, straight, distorted and curved",
    source="exact: linear displacement",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
