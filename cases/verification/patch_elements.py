"""Patch tests: constant strain and stress, reproduced by every element in every shape."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import distorted_blocks as blocks
from fe_drivetrain.common import STRESSES
from fe_drivetrain.elasticity.mesh import element_kind
from fe_drivetrain.report import bars, trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, Target

DEGREES = (1, 2, 3, 4, 5, 6)  # of quadrature, tried for the forces on nodes inside
ROUND_OFF = "round-off: some thousand operations of 1e-16 each"
CONDITIONED = "round-off times the condition number of a block held statically, 1e5 to 1e6"
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


LARGEST = "Largest error of each block under six constant strains, of the largest value of each"


def answer(page: Page, rows: list[Record]) -> None:
    """State how exactly the elements reproduce constant strain."""
    worst = {what: max(row[what] for row in rows) for what in CHECKS}
    largest = max(worst.values())
    exact = "Yes" if all(check.passed for check in page.checks) else "No"
    page.answer(
        "Does every element reproduce a constant strain exactly, distorted and curved ones too?",
        f"{exact}: on all {len(rows)} blocks, distorted and curved ones too, displacements and "
        f"stresses err by at most {formatted(largest, 2, '')} of their largest value.",
        [
            page.value(f"largest error, {what}", worst[what], at_most=within, by="round-off")
            for what, (within, _) in CHECKS.items()
        ],
        hero=LARGEST,
    )


@case(
    "Patch tests: constant strain in every element, straight, distorted and curved",
    source="exact: linear displacement",
)
def run(run: Run, page: Page) -> None:
    """Six strain states on distorted blocks: displacements given all round, then tractions."""
    rows: list[Record] = []
    traces = []
    for patch in blocks.patches():
        with run.step("six strain states"):
            found = dict(zip(CHECKS, blocks.patch_test(patch), strict=True))
        for what, (within, why) in CHECKS.items():
            title = f"{what}, largest error of six strain states"
            page.meets(found[what], Target(title, 0.0, within, why, CONSTANT), of=patch.label)
        quadratic = blocks.quadratic_error(patch)
        if patch.holds_quadratics:
            title = "interpolated quadratic field, largest error of strain"
            page.meets(quadratic, Target(title, 0.0, 1e-12, ROUND_OFF, CONTAINED), of=patch.label)
        interpolated = {"strain of an interpolated quadratic field": quadratic}
        rows.append({**patch.size(), **found, **interpolated})
        if (nodes := patch.block.cells.shape[1]) > 4:
            step = "forces by degree of quadrature"
            forces = np.maximum(run.timed(step, blocks.forces_by_degree, patch, DEGREES), 1e-17)
            marks = {"size": [14 if d == element_kind(nodes).degree else 6 for d in DEGREES]}
            traces.append(trace(patch.label, DEGREES, forces, mode="lines+markers", marker=marks))
    answer(page, rows)
    page.section("Patch tests")
    errors = {
        given: {
            row["element"]: max(row[what] for what in CHECKS if what.startswith(given))
            for row in rows
        }
        for given in ("displacements given", "tractions given")
    }
    page.add(bars(LARGEST, errors, "largest error [-]", least=1e-17))
    title = f"Largest errors over six strain states ({', '.join(STRESSES)}), relative to the "
    title += "largest value of each. Nodes are moved at random, inside and on the surface"
    page.table(title, rows)
    page.text(
        "Displacements given all round: nodes inside must follow the linear field. Tractions: the "
        "exact stress times the outward normal, also on curved outer faces, with the six degrees "
        "of freedom of a rigid body prescribed; the supports must then feel nothing."
    )
    page.section("Why curved elements pass, and what it takes")
    page.text(
        "An isoparametric element contains every linear field whatever its shape, since x itself "
        "is a combination of its shape functions: the curved 20-node element passes, too. Of "
        "quadratic fields see the last column: ten-node tetrahedra and 27-node hexahedra contain "
        "them with straight edges, 20-node hexahedra only as parallelepipeds, none when curved. "
        "The forces of a constant stress on a node must cancel between elements besides, which "
        "takes a quadrature that integrates cofactors of the map times gradients exactly: degree 3 "
        "for curved ten-node tetrahedra (the assembly uses 4); in each direction 2 for 8-node "
        "hexahedra (two points integrate 3) and 5 for curved 20- and 27-node ones (three points "
        "integrate just 5). One point less, the usual reduced integration, and curved ones fail."
    )
    title = "Force of a constant stress on nodes inside, by degree of the quadrature, relative to "
    title += "the largest of one element on a node; the large marker is the assembly's own rule"
    page.chart(title, traces, "degree of the quadrature", "false force on nodes inside [-]", "y")
    sketch = run.sketch(blocks.patches()[-1].block)
    page.image("The last of the patches: hexahedra of 27 nodes, curved", sketch)
    page.data("largest errors", rows)
