"""One tetrahedron of 10 nodes under pressure, as MSC Nastran solves it."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.loaded_blocks import face_loads, solve_block
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import fixed
from fe_drivetrain.elasticity.mesh import TETRAHEDRON_EDGES, Block
from fe_drivetrain.elasticity.operator import pressure
from fe_drivetrain.report import Cell
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Run, Target

MATERIAL = Material(youngs_modulus=3e7, poisson_ratio=0.3, density=0.0)
#: Grids 21 to 24, then 25 to 30 on edges 21-22, 22-23, 21-23, 21-24, 22-24 and 23-24.
CORNERS = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
#: Displacements of grids, along x, y and z.
PRINTED = {
    24: (-2.6452167e-7, -2.6452167e-7, -7.627743e-9),
    26: (1.0724060e-8, 1.0724060e-8, 2.5696144e-7),
}
AGAINST = "Displacements against Nastran's, over what single precision rounds"
#: Two roundings of numbers of 24 bits, relative.
SINGLE = 2.0 * 2.0**-24
SOURCE = "MSC Nastran, pyNastran's models/unit/pload4/ctetra10, as quoted"


def tetrahedron() -> Block:
    """The element with its base, turned outward."""
    middles = np.array([CORNERS[list(edge)].mean(axis=0) for edge in TETRAHEDRON_EDGES])
    at = {frozenset(edge): 4 + i for i, edge in enumerate(map(tuple, TETRAHEDRON_EDGES))}
    base = [0, 2, 1, *(at[frozenset(edge)] for edge in ((0, 2), (1, 2), (0, 1)))]
    return Block(np.vstack([CORNERS, middles]), np.arange(10)[None], {"base": np.array([base])})


def answer(page: Page, worst: float) -> None:
    """State how far displacements are from Nastran's, over the largest of their grid."""
    figures = [
        page.judged(
            f"grid {grid}: displacement along {axis}",
            f"grid {grid}, along {axis}",
            "Nastran",
            unit="µm",
        )
        for grid in PRINTED
        for axis in "xz"
    ]
    same = worst <= SINGLE
    page.answer(
        "Does a tetrahedron under pressure move as in MSC Nastran?",
        f"{'Yes' if same else 'No'}: its six displacements differ from Nastran's by at most "
        f"{formatted(worst, 1, '')} of the largest, {'no more' if same else 'more'} than the "
        "round-off of single precision.",
        [
            page.value("largest difference, over the grid's largest", worst, at_most=SINGLE),
            *figures,
        ],
        hero=AGAINST,
        cautions=[
            "The source does not say where each grid point lies: one arrangement fits all digits."
        ],
    )
    page.errors(AGAINST, figures)


@case(
    "Tetrahedron of 10 nodes under pressure, against MSC Nastran",
    source="pyNastran, models/unit/pload4/ctetra10 (solved by MSC Nastran)",
)
def run(run: Run, page: Page) -> None:
    """Press the base of the element, its three corners held."""
    element = tetrahedron()
    with run.step("solve"):
        held = fixed("corners", np.arange(3), element.points.size)
        found = solve_block(element, MATERIAL, face_loads(element, base=pressure(1.0)), held)
    single = "two roundings of numbers of 24 bits, in which loads and results are kept, of the "
    single += "largest component"
    rows: list[list[Cell]] = []
    worst = 0.0
    for grid, printed in PRINTED.items():
        largest = float(np.abs(printed).max())
        within = SINGLE * largest
        for axis, value, own in zip("xyz", printed, found.u[grid - 21].tolist(), strict=True):
            key = f"grid {grid}: displacement along {axis} [m]"
            target = Target(key, value, within, single, SOURCE, relative=False, basis="second-hand")
            page.meets(own, target)
            apart = (own - value) / largest
            worst = max(worst, abs(apart))
            rows.append([grid, axis, own, value, apart])
    heads = ["grid", "along", "found", "Nastran", "difference, over the grid's largest"]
    page.table("Displacements, in the units of the file", rows, heads)
    answer(page, worst)
    page.text(
        "The unit tetrahedron has E = 3e7 and nu = 0.3, and a pressure of 1 on its base, z = 0. "
        "What was read does not say which grid is where. This is the reading that gives the "
        "printed digits: 21 at the origin, 22, 23 and 24 at 1 along x, y and z, grids on edges in "
        "the order of Nastran's element, so that 26 is between 22 and 23; and clamped are the "
        "three corners of the base, 21 to 23, not the grids between them. Those too clamped, the "
        "element does not move at all; 21 and 23 alone, it can turn about their line."
    )
    page.image("The element", run.sketch(element))
