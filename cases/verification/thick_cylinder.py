"""Thick cylinder under internal pressure, with every element, against Lame."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.compare import observed_order
from fe_drivetrain.scene import Material
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target, column, grouped
from fe_drivetrain.validation.plane_rings import Lame, Plane, plane_strain
from fe_drivetrain.validation.ring_slices import pressed_ring

INNER, OUTER = 0.3, 0.6  # m
PRESSURE = 100e6  # Pa
E, NU = 200e9, 0.3
STEEL = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0)

#: Elements through the wall, by the nodes of an element; a quick run has the first three.
DIVISIONS = {4: (4, 8, 16), 8: (4, 8, 16, 32), 10: (2, 4, 8), 20: (2, 4, 8, 16), 27: (2, 4, 8, 16)}
NAMES = {4: "tetrahedra of 4 nodes", 10: "curved tetrahedra of 10 nodes"}
NAMES |= {n: f"hexahedra of {n} nodes" for n in (8, 20, 27)}
FIRST_ORDER = NAMES[4], NAMES[8]
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
    """The bore on one mesh."""
    found = pressed_ring(EXACT, STEEL, nodes, n, free_ends)
    values = {MOVED: 1e6 * found.moved, HOOP: found.hoop / 1e6, RADIAL: found.radial / 1e6}
    # no smaller than a chart can show
    errors = {error_of(key): max(abs(v / REFERENCES[key] - 1), 1e-10) for key, v in values.items()}
    return {ELEMENT: name, THROUGH: n, **values, **errors}


@case(
    "Thick cylinder under internal pressure",
    source="Lame 1852; Timoshenko and Goodier 1970, Theory of Elasticity, art 28",
)
def run(run: Run, page: Page) -> None:
    """Solve an eighth of the ring on ever finer meshes."""
    divisions = {nodes: some[:3] if run.quick else some for nodes, some in DIVISIONS.items()}
    rows = [
        run.timed(NAMES[k], solve, NAMES[k], k, n) for k, some in divisions.items() for n in some
    ]
    free = [run.timed("free ends", solve, "", 27, n, free_ends=True) for n in divisions[27]]
    by_element = dict(grouped(rows, ELEMENT))
    tolerance = 1e-3 if run.quick else 1e-4
    for name, series in by_element.items():
        check(page, name, series, tolerance)
    uniform = "as in plane strain: the axial strain is uniform, and adds no error of its own"
    moved = 1e6 * float(EXACT.displacement(INNER, Plane(E, NU)))
    target = Target(MOVED, moved, tolerance, uniform, LAME, order=4.0)
    page.finest(MeshSeries(free, THROUGH), target, of="free ends")
    best = rows[-1]
    page.headline = "hexahedra of 27 nodes: mean radial displacement of the bore, plane strain"
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
    order = 2.0 if name in FIRST_ORDER else 4.0
    last, n = series[-3:], series[-1][THROUGH]
    observed = observed_order(1.0 / np.array(column(last, THROUGH)), column(last, MOVED))
    eighth = "an eighth of the order: the coarse meshes of a series are not yet in its asymptotic "
    eighth += "range, the less so the higher the order; one lost order would show as 1 or 2 less"
    twice = "twice the order of the strains: the mean displacement is an energy"
    title = "order of the bore's mean displacement"
    page.meets(
        observed, Target(title, order, order / 8, eighth, twice, "", False, "order"), of=name
    )
    if name in FIRST_ORDER:
        return
    far = "(h/r)^4 of the finest mesh, with h an element at the bore, is "
    far += f"{(1.0 / n) ** 4:.0e}, and its factor may be some units; rounded up to the next "
    far += "power of ten that a stiffness needs"
    # a linear field through Gauss points at 0.577 misses f'' h^2 / 12 at the surface
    curvature = 6.0 * (REFERENCES[HOOP] - REFERENCES[RADIAL]) / 2.0 / INNER**2
    missed = curvature * ((OUTER - INNER) / n) ** 2 / 12.0
    near = "four times s'' h^2 / 12, what a linear stress through the Gauss points of a "
    near += f"hexahedron misses at its surface ({missed:.2g} MPa); tetrahedra are less even"
    for key, reference in REFERENCES.items():
        title = f"{key.split(' [')[0]}, plane strain"
        stress = Target(key, reference, 4.0 * missed, near, LAME, title, relative=False)
        moved = Target(key, reference, tolerance, far, LAME, title, order=4.0)
        page.finest(MeshSeries(series, THROUGH), moved if key == MOVED else stress, of=name)
