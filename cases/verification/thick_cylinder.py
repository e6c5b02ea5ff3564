"""Thick cylinder under internal pressure, with every element, against Lame."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.compare import observed_order
from fe_drivetrain.interfaces import held_nodes
from fe_drivetrain.operator import pressure
from fe_drivetrain.scene import Material
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target, column, grouped
from fe_drivetrain.validation.loaded_blocks import face_loads, solve_block
from fe_drivetrain.validation.plane_rings import Lame, Plane, plane_strain
from fe_drivetrain.validation.ring_solids import plane_strain_hold, ring_sector, sector_symmetry

INNER, OUTER = 0.3, 0.6  # m
PRESSURE = 100e6  # Pa
E, NU = 200e9, 0.3
STEEL = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0)
EIGHTH = 0.25 * np.pi  # rad, between planes of symmetry

#: Elements through the wall, by the nodes of an element.
DIVISIONS = {4: (4, 8, 16), 8: (4, 8, 16, 32), 10: (2, 4, 8), 20: (2, 4, 8, 16), 27: (2, 4, 8, 16)}
QUICK_DIVISIONS = {4: (4, 8, 16), 8: (4, 8, 16), 10: (2, 4, 8), 20: (2, 4, 8), 27: (2, 4, 8)}
FIRST_ORDER = {4: "tetrahedra of 4 nodes", 8: "hexahedra of 8 nodes"}
SECOND_ORDER = {
    10: "curved tetrahedra of 10 nodes",
    20: "hexahedra of 20 nodes",
    27: "hexahedra of 27 nodes",
}
ELEMENT, THROUGH = "element", "elements through the wall"
MOVED = "mean radial displacement of the bore [µm]"
HOOP, RADIAL = "hoop stress at the bore [MPa]", "radial stress at the bore [MPa]"

EXACT = Lame(INNER, OUTER, inside=PRESSURE)
REFERENCES = {
    MOVED: 1e6 * float(EXACT.displacement(INNER, plane_strain(E, NU))),
    HOOP: float(EXACT.hoop(INNER)) / 1e6,
    RADIAL: float(EXACT.radial(INNER)) / 1e6,
}
LAME = "Lame 1852; Timoshenko and Goodier 1970, art 28"


def error_of(key: str) -> str:
    """Key of the relative error of a quantity."""
    return f"error of the {key.partition(' [')[0]}"


def solve(name: str, nodes: int, n: int, free_ends: bool = False) -> Record:
    """Mean displacement of the bore by the work of the pressure, and stresses at its end."""
    width = (OUTER - INNER) / n
    # so divided that elements at the bore are about square
    block = ring_sector(INNER, OUTER, width, EIGHTH, (n, n, 1), nodes)
    free = held_nodes("end", block.face_nodes("z0"), [0], block.points.size) if free_ends else None
    F = face_loads(block, x0=pressure(PRESSURE))
    held = [*sector_symmetry(block, EIGHTH), free or plane_strain_hold(block)]
    found = solve_block(block, STEEL, F, *held)
    t = 0.5 * EIGHTH
    middle = found.node(0.0, INNER * np.cos(t), INNER * np.sin(t))
    work = float(F @ found.u.ravel())
    return {
        ELEMENT: name,
        THROUGH: n,
        MOVED: 1e6 * (work / (PRESSURE * (EIGHTH * INNER * width))),
        HOOP: float(found.polar.hoop[middle]) / 1e6,
        RADIAL: float(found.polar.radial[middle]) / 1e6,
    }


@case(
    "Thick cylinder under internal pressure",
    source="Lame 1852; Timoshenko and Goodier 1970, Theory of Elasticity, art 28",
)
def run(run: Run, page: Page) -> None:
    """Solve an eighth of the ring on ever finer meshes."""
    divisions = QUICK_DIVISIONS if run.quick else DIVISIONS
    names = dict(sorted((FIRST_ORDER | SECOND_ORDER).items()))
    rows = [
        run.timed(name, solve, name, nodes, n)
        for nodes, name in names.items()
        for n in divisions[nodes]
    ]
    free = [run.timed("free ends", solve, "", 27, n, free_ends=True) for n in divisions[27]]
    by_element = dict(grouped(rows, ELEMENT))
    tolerance = 1e-3 if run.quick else 1e-4
    for name, series in by_element.items():
        check(page, name, series, tolerance)
    uniform = "as in plane strain: the axial strain is uniform, and adds no error of its own"
    moved = 1e6 * float(EXACT.displacement(INNER, Plane(E, NU)))
    name = "free ends: mean radial displacement of the bore"
    target = Target(MOVED, moved, tolerance, uniform, LAME, name, order=4.0)
    page.finest(MeshSeries(free, THROUGH), target)
    for row in rows:  # no smaller than a chart can show
        errors = {key: abs(row[key] / exact - 1.0) for key, exact in REFERENCES.items()}
        row |= {error_of(key): max(error, 1e-10) for key, error in errors.items()}
    best = rows[-1]
    page.answer(
        f"The bore opens by {REFERENCES[MOVED]:.2f} µm; {divisions[27][-1]} hexahedra of 27 "
        f"nodes through the wall are within {best[error_of(MOVED)]:.1e} of it, and its hoop "
        f"stress within {best[error_of(HOOP)]:.1e}.",
        "Elements of second order converge with the fourth power of their size, those of first "
        "order with the second.",
    )
    page.section("Convergence")
    for key in (MOVED, HOOP):
        error = error_of(key)
        page.sweep(error.capitalize(), rows, THROUGH, error, by=ELEMENT, log="xy", table=False)
    finest = [series[-1] for series in by_element.values()]
    page.table(
        "The bore on the finest mesh of each element, plane strain",
        [*finest, {ELEMENT: "Lame", **REFERENCES}],
        [ELEMENT, THROUGH, *REFERENCES],
    )
    page.text(
        "An eighth of the ring between planes of symmetry, one element wide. Mid-side nodes lie "
        "on the true circles. The mean displacement of the bore is the work of the pressure over "
        "pressure and area."
    )


def check(page: Page, name: str, series: list[Record], tolerance: float) -> None:
    """Order of an element, twice that of the strains; the bore, where it is of second order."""
    order = 2.0 if name in FIRST_ORDER.values() else 4.0
    last = series[-3:]
    page.equals(
        f"{name}: order of the bore's mean displacement",
        observed_order(1.0 / np.array(column(last, THROUGH)), np.array(column(last, MOVED))),
        order,
        within=order / 8,
        relative=False,
        why="an eighth of the order: the coarse meshes of a series are not yet in its asymptotic "
        "range, the less so the higher the order; one lost order would show as 1 or 2 less",
        source="twice the order of the strains: the mean displacement is an energy",
        measure="order",
    )
    if name in FIRST_ORDER.values():
        return
    of, n = MeshSeries(series, THROUGH), series[-1][THROUGH]
    why = "(h/r)^4 of the finest mesh, with h an element at the bore, is "
    why += f"{(1.0 / n) ** 4:.0e}, and its factor may be some units; rounded up to the next "
    why += "power of ten that a stiffness needs"
    title = f"{name}: mean radial displacement of the bore, plane strain"
    page.finest(of, Target(MOVED, REFERENCES[MOVED], tolerance, why, LAME, title, order=4.0))
    # a linear field through Gauss points at 0.577 misses f'' h^2 / 12 at the surface
    curvature = 6.0 * (REFERENCES[HOOP] - REFERENCES[RADIAL]) / 2.0 / INNER**2
    missed = curvature * ((OUTER - INNER) / n) ** 2 / 12.0
    why = "four times s'' h^2 / 12, what a linear stress through the Gauss points of a "
    why += f"hexahedron misses at its surface ({missed:.2g} MPa); tetrahedra are less even"
    for key in (HOOP, RADIAL):
        title, value = f"{name}: {key.split(' [')[0]}, plane strain", REFERENCES[key]
        page.finest(of, Target(key, value, 4.0 * missed, why, LAME, title, relative=False))
