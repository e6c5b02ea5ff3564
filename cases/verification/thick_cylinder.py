"""Thick cylinder under internal pressure, with every element, against Lame."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.compare import band_of, observed_order
from fe_drivetrain.interfaces import held_nodes
from fe_drivetrain.operator import nodal_stresses, pressure, traction_loads
from fe_drivetrain.report import trace
from fe_drivetrain.scene import Material
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import Page, Record, Run, column
from fe_drivetrain.validation.plane_rings import Lame, Plane, plane_strain
from fe_drivetrain.validation.ring_solids import (
    node_at,
    plane_strain_hold,
    polar_stresses,
    ring_sector,
    sector_symmetry,
)

INNER, OUTER = 0.3, 0.6  # m
PRESSURE = 100e6  # Pa
E, NU = 200e9, 0.3
STEEL = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0)
EIGHTH = 0.25 * np.pi  # rad, between planes of symmetry

#: Elements through the wall, by the nodes of an element.
DIVISIONS = {4: (4, 8, 16), 8: (4, 8, 16, 32), 10: (2, 4, 8), 20: (2, 4, 8, 16), 27: (2, 4, 8, 16)}
QUICK_DIVISIONS = {4: (4, 8, 16), 8: (4, 8, 16), 10: (2, 4, 8), 20: (2, 4, 8), 27: (2, 4, 8)}

NAMES = {
    4: "tetrahedra of 4 nodes",
    10: "curved tetrahedra of 10 nodes",
    8: "hexahedra of 8 nodes",
    20: "hexahedra of 20 nodes",
    27: "hexahedra of 27 nodes",
}
ELEMENT, THROUGH = "element", "elements through the wall"
MOVED, HOOP, RADIAL = "displacement [m]", "hoop stress [Pa]", "radial stress [Pa]"

EXACT = Lame(INNER, OUTER, inside=PRESSURE)
BORE = np.array(INNER)
#: Of the bore.
REFERENCES = {
    MOVED: float(EXACT.displacement(BORE, plane_strain(E, NU))),
    HOOP: float(EXACT.hoop(BORE)),
    RADIAL: float(EXACT.radial(BORE)),
}
STRESSES = (HOOP, RADIAL)
LAME = "Lame 1852; Timoshenko and Goodier 1970, art 28"


def solve(nodes: int, n: int, free_ends: bool = False) -> Record:
    """Mean displacement of the bore by the work of the pressure, and stresses at its end."""
    width = (OUTER - INNER) / n
    # so divided that elements at the bore are about square
    block = ring_sector(INNER, OUTER, width, EIGHTH, (n, n, 1), nodes)
    points = block.points
    free = held_nodes("end", block.face_nodes("z0"), [0], points.size) if free_ends else None
    supports = [*sector_symmetry(block, EIGHTH), free or plane_strain_hold(block)]
    F = traction_loads(points, block.faces["x0"], pressure(PRESSURE))
    static = solve_solid(points, block.cells, STEEL.lame, supports, F)
    s = nodal_stresses(points, block.cells, static.u[:, 0], STEEL.lame)
    t = 0.5 * EIGHTH
    middle = node_at(points, [0.0, INNER * np.cos(t), INNER * np.sin(t)])
    polar = polar_stresses(s[middle], points[middle])
    area = EIGHTH * INNER * width
    return {
        ELEMENT: NAMES[nodes],
        THROUGH: n,
        MOVED: float(F @ static.u[:, 0]) / (PRESSURE * area),
        HOOP: float(polar.hoop),
        RADIAL: float(polar.radial),
    }


def errors(series: list[Record], quantity: str) -> Floats:
    """Relative, and no smaller than a chart can show."""
    values = np.array(column(series, quantity))
    return np.asarray(np.maximum(np.abs(values / REFERENCES[quantity] - 1.0), 1e-10))


@case(
    "Thick cylinder under internal pressure",
    source="Lame 1852; Timoshenko and Goodier 1970, Theory of Elasticity, art 28",
)
def run(run: Run, page: Page) -> None:
    """Solve an eighth of the ring on ever finer meshes."""
    divisions = QUICK_DIVISIONS if run.quick else DIVISIONS
    found: dict[int, list[Record]] = {}
    for nodes, counts in divisions.items():
        with run.step(NAMES[nodes]):
            found[nodes] = [solve(nodes, n) for n in counts]
    with run.step("free ends"):
        free = [solve(27, n, free_ends=True) for n in divisions[27]]
    tolerance = 1e-3 if run.quick else 1e-4
    for nodes, series in found.items():
        check_order(page, nodes, series)
        if nodes not in (4, 8):
            check_values(page, series, tolerance)
    page.equals(
        "free ends: mean radial displacement of the bore",
        1e6 * free[-1][MOVED],
        1e6 * float(EXACT.displacement(BORE, Plane(E, NU))),
        within=tolerance,
        why="as in plane strain: the axial strain is uniform, and adds no error of its own",
        source=LAME,
        unit="µm",
        measure="deflection",
        band=1e6 * band_of(1.0 / np.array(divisions[27]), column(free, MOVED), 4.0),
    )
    best = found[27]
    page.answer(
        f"The bore opens by {1e6 * REFERENCES[MOVED]:.2f} µm; {best[-1][THROUGH]} hexahedra of 27 "
        f"nodes through the wall are within {errors(best, MOVED)[-1]:.1e} of it, and its hoop "
        f"stress within {errors(best, HOOP)[-1]:.1e}.",
        "Elements of second order converge with the fourth power of their size, those of first "
        "order with the second.",
    )
    page.section("Convergence")
    for quantity, title in (
        (MOVED, "bore's mean radial displacement"),
        (HOOP, "hoop stress at the bore"),
    ):
        page.chart(
            f"Error of the {title} against the elements through the wall",
            [
                trace(NAMES[nodes], divisions[nodes], errors(series, quantity))
                | {"mode": "lines+markers"}
                for nodes, series in found.items()
            ],
            THROUGH,
            "relative error",
            ("x", "y"),
        )
    finest = [series[-1] for series in found.values()]
    page.table(
        "The bore on the finest mesh of each element, plane strain",
        [
            (row[ELEMENT], row.get(THROUGH), 1e6 * row[MOVED], *(row[s] / 1e6 for s in STRESSES))
            for row in (*finest, {ELEMENT: "Lame", **REFERENCES})
        ],
        [ELEMENT, THROUGH, "displacement [µm]", "hoop stress [MPa]", "radial stress [MPa]"],
    )
    page.text(
        "An eighth of the ring between planes of symmetry, one element wide. Mid-side nodes lie "
        "on the true circles. The mean displacement of the bore is the work of the pressure over "
        "pressure and area."
    )
    page.data("exact", REFERENCES)
    page.data("by nodes of the element", found)


def check_order(page: Page, nodes: int, series: list[Record]) -> None:
    """Twice the order of the strains."""
    order = 2.0 if nodes in (4, 8) else 4.0
    last = series[-3:]
    page.equals(
        f"{NAMES[nodes]}: order of the bore's mean displacement",
        observed_order(1.0 / np.array(column(last, THROUGH)), np.array(column(last, MOVED))),
        order,
        within=order / 8,
        relative=False,
        why="an eighth of the order: the coarse meshes of a series are not yet in its asymptotic "
        "range, the less so the higher the order; one lost order would show as 1 or 2 less",
        source="twice the order of the strains: the mean displacement is an energy",
        measure="order",
    )


def check_values(page: Page, series: list[Record], tolerance: float) -> None:
    """Displacement and stresses of an element of second order on its finest mesh."""
    best = series[-1]
    name, counts = best[ELEMENT], column(series, THROUGH)
    sizes = 1.0 / np.array(counts)
    page.equals(
        f"{name}: mean radial displacement of the bore, plane strain",
        1e6 * best[MOVED],
        1e6 * REFERENCES[MOVED],
        within=tolerance,
        why="(h/r)^4 of the finest mesh, with h an element at the bore, is "
        f"{(1.0 / counts[-1]) ** 4:.0e}, and its factor may be some units; rounded up to the next "
        "power of ten that a stiffness needs",
        source=LAME,
        unit="µm",
        measure="deflection",
        band=1e6 * band_of(sizes, column(series, MOVED), 4.0),
    )
    # a linear field through Gauss points at 0.577 misses f'' h^2 / 12 at the surface
    h = (OUTER - INNER) / counts[-1]
    curvature = 6.0 * (REFERENCES[HOOP] - REFERENCES[RADIAL]) / 2.0 / INNER**2
    missed = curvature * h**2 / 12.0
    for quantity, title in ((HOOP, "hoop stress"), (RADIAL, "radial stress")):
        page.equals(
            f"{name}: {title} at the bore, plane strain",
            best[quantity] / 1e6,
            REFERENCES[quantity] / 1e6,
            within=4.0 * missed / 1e6,
            relative=False,
            why="four times s'' h^2 / 12, what a linear stress through the Gauss points of a "
            f"hexahedron misses at its surface ({missed / 1e6:.2g} MPa); tetrahedra are less even",
            source=LAME,
            unit="MPa",
            measure="stress",
            band=band_of(sizes, column(series, quantity)) / 1e6,
        )
