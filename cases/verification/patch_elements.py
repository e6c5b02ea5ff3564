"""Patch tests: constant strain and stress, reproduced by every element in every shape."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import STRESSES
from fe_drivetrain.mesh import element_kind
from fe_drivetrain.report import trace
from fe_drivetrain.suite import Page, Record, Run
from fe_drivetrain.validation.distorted_blocks import (
    SIGMAS,
    inner_forces,
    patch_test,
    patches,
    quadratic_error,
)

#: Degrees of quadrature that are tried for the forces on nodes inside.
DEGREES = (1, 2, 3, 4, 5, 6)

ROUND_OFF = "round-off: some thousand operations of 1e-16 each"
CONDITIONED = (
    "round-off times the condition number of a block on six degrees of freedom, 1e5 to 1e6"
)
CONSTANT = "exact: linear displacement, constant stress (patch test)"
CONTAINED = "exact: the element contains all quadratic polynomials in this shape"
#: Allowed error of each check, and why.
CHECKS = {
    "displacements given, displacement": (1e-12, ROUND_OFF),
    "displacements given, stress": (1e-12, ROUND_OFF),
    "tractions given, displacement": (1e-10, CONDITIONED),
    "tractions given, stress": (1e-10, CONDITIONED),
    "tractions given, reaction of the supports": (1e-12, ROUND_OFF),
}


@case(
    "Patch tests: constant strain in every element, straight, distorted and curved",
    source="exact: linear displacement",
)
def run(run: Run, page: Page) -> None:
    """Six strain states on distorted blocks: displacements given all round, then tractions."""
    rows: list[Record] = []
    traces = []
    for patch in patches():
        cells = patch.block.cells
        found = dict(zip(CHECKS, run.timed("six strain states", patch_test, patch), strict=True))
        for what, (within, why) in CHECKS.items():
            title = f"{patch.label}: {what}, largest error of six strain states"
            page.vanishes(title, found[what], within=within, why=why, source=CONSTANT)
        quadratic = quadratic_error(patch)
        if patch.holds_quadratics:
            title = f"{patch.label}: interpolated quadratic field, largest error of strain"
            page.vanishes(title, quadratic, within=1e-12, why=ROUND_OFF, source=CONTAINED)
        rows.append(
            {
                "element": patch.label,
                "elements": len(cells),
                "nodes": len(patch.block.points),
                "smallest over largest Jacobian in an element": patch.jacobian_ratio(),
                **found,
                "strain of an interpolated quadratic field": quadratic,
            }
        )
        if cells.shape[1] > 4:
            with run.step("forces by degree of quadrature"):
                forces = [
                    max(inner_forces(patch, sigma, degree) for sigma in SIGMAS)
                    for degree in DEGREES
                ]
            own = element_kind(cells.shape[1]).degree
            marks = {"size": [14 if d == own else 6 for d in DEGREES]}
            shown = np.maximum(forces, 1e-17)
            traces.append(trace(patch.label, DEGREES, shown, mode="lines+markers", marker=marks))

    given = [what for what in CHECKS if what.startswith("displacements given")]
    worst = max(row[what] for row in rows for what in given)
    page.answer(
        f"All {len(rows)} blocks reproduce the six constant strains, displacement and stress, to "
        f"{worst:.0e} with displacements given all round, and with tractions on six held degrees "
        "of freedom to round-off; curved serendipity elements among them."
    )
    page.section("Patch tests")
    page.table(
        f"Largest errors over six strain states ({', '.join(STRESSES)}), relative to the largest "
        "value of each. Nodes are moved at random, inside and on the surface",
        rows,
    )
    page.text(
        "Displacements given all round: nodes inside must follow the linear field. Tractions: the "
        "exact stress times the outward normal, also on curved outer faces, with the six degrees "
        "of freedom of a rigid body prescribed; the supports must then feel nothing."
    )
    page.section("Why curved elements pass, and what it takes")
    page.text(
        "An isoparametric element contains every linear field whatever its shape: x itself is a "
        "combination of its shape functions. So the curved 20-node element passes too. Quadratic "
        "fields are another matter, the last column: ten-node tetrahedra contain them with "
        "straight edges, 27-node hexahedra with straight edges, 20-node hexahedra only as "
        "parallelepipeds, none when curved. A patch test also needs the forces of a constant "
        "stress on a node to cancel between elements, and that takes a quadrature that integrates "
        "cofactors of the map times gradients exactly: degree 3 for curved ten-node tetrahedra "
        "(the assembly uses 4), 2 in each direction for 8-node hexahedra (two points integrate 3 "
        "exactly), 5 in each direction for curved 20- and 27-node hexahedra (three points "
        "integrate just 5). One point less a direction, the usual reduced integration, and curved "
        "quadratic hexahedra fail."
    )
    title = "Force of a constant stress on nodes inside, by degree of the quadrature, relative to "
    title += "the largest of one element on a node; the large marker is the assembly's own rule"
    x, y = "degree asked of the quadrature", "false force on nodes inside [-]"
    page.chart(title, traces, x, y, "y")
    page.data("largest errors", rows)
