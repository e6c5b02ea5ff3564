"""Thick cylinder under internal pressure, with every element, against Lame."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.loaded_blocks import fourth_power, within_surface
from fe_drivetrain.cases.references.plane_rings import Lame, Plane, plane_strain
from fe_drivetrain.cases.references.ring_slices import eighth_of, pressed_ring
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.report.number_text import certain_value, percent_text
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target, grouped, order_of

E, NU = 200e9, 0.3
STEEL = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0)
RING = Lame(inner=0.3, outer=0.6, inside=100e6)  # m, Pa
WALL = RING.outer - RING.inner
#: Elements through the wall, by the nodes of an element; a quick run has the first three.
DIVISIONS = {4: (4, 8, 16), 8: (4, 8, 16, 32), 10: (2, 4, 8), 20: (2, 4, 8, 16), 27: (2, 4, 8, 16)}
NAMES = {4: "tetrahedra of 4 nodes", 10: "curved tetrahedra of 10 nodes"}
NAMES |= {n: f"hexahedra of {n} nodes" for n in (8, 20, 27)}
ORDERS = {NAMES[4]: 2.0, NAMES[8]: 2.0}  # of the others 4
ELEMENT, THROUGH = "element", "elements through the wall"
MOVED = "mean radial displacement of the bore [µm]"
HOOP, RADIAL = "hoop stress at the bore [MPa]", "radial stress at the bore [MPa]"
EXACT = {
    MOVED: 1e6 * float(RING.displacement(RING.inner, plane_strain(E, NU))),
    HOOP: RING.hoop_at(RING.inner) / 1e6,
    RADIAL: float(RING.radial(RING.inner)) / 1e6,
}
ERRORS = {key: f"error of the {key.partition(' [')[0]}" for key in EXACT}
ORDER = "order of the bore's mean displacement"
LAME = "Lame 1852; Timoshenko and Goodier 1970, art 28"


def solve(nodes: int, n: int, free_ends: bool = False) -> Record:
    """The bore on one mesh."""
    found = pressed_ring(RING, STEEL, nodes, n, free_ends)
    values = {MOVED: 1e6 * found.moved, HOOP: found.hoop / 1e6, RADIAL: found.radial / 1e6}
    # no smaller than a chart can show
    errors = {ERRORS[key]: max(abs(v / EXACT[key] - 1), 1e-10) for key, v in values.items()}
    return {ELEMENT: NAMES[nodes], THROUGH: n, **values, **errors}


def answer(page: Page, best: Record) -> None:
    """State how far the bore opens and what it carries, by the best mesh."""
    moved, hoop = (key.partition(" [")[0] for key in (MOVED, HOOP))
    best_of, tetrahedra = (f"{NAMES[nodes]}, plane strain" for nodes in (27, 10))
    opens = page.judged(f"{best_of}: {moved}", "opening of the bore, hexahedra", "Lame")
    stress = page.judged(f"{best_of}: {hoop}", "hoop stress at the bore, hexahedra", "Lame")
    page.answer(
        "How far does a thick cylinder open under internal pressure, and what does it carry?",
        f"The bore opens by {certain_value(opens)} and carries a hoop stress of "
        f"{certain_value(stress)}: {percent_text(best[ERRORS[MOVED]])} and "
        f"{percent_text(best[ERRORS[HOOP]])} from Lame's solution.",
        [
            opens,
            stress,
            page.judged(f"{tetrahedra}: {moved}", "opening of the bore, tetrahedra", "Lame"),
            page.judged(f"{tetrahedra}: {hoop}", "hoop stress at the bore, tetrahedra", "Lame"),
            page.judged(f"free ends: {moved}", "opening of the bore, free ends", "Lame"),
        ],
        hero=ERRORS[MOVED].capitalize(),
    )


@case(
    "Thick cylinder under internal pressure",
    source="Lame 1852; Timoshenko and Goodier 1970, Theory of Elasticity, art 28",
)
def run(run: Run, page: Page) -> None:
    """Solve an eighth of the ring on ever finer meshes."""
    divisions = {nodes: some[:3] if run.quick else some for nodes, some in DIVISIONS.items()}
    rows = [run.timed(NAMES[k], solve, k, n) for k, some in divisions.items() for n in some]
    free = [run.timed("free ends", solve, 27, n, free_ends=True) for n in divisions[27]]
    tolerance = 1e-3 if run.quick else 1e-4
    eighth = "an eighth of the order: the coarse meshes of a series are not yet in its asymptotic "
    eighth += "range, the less so the higher the order; one lost order would show as 1 or 2 less"
    twice = "twice the order of the strains: the mean displacement is an energy"
    for name, meshes in grouped(rows, ELEMENT):
        series, n, order = MeshSeries(meshes, THROUGH), meshes[-1][THROUGH], ORDERS.get(name, 4.0)
        page.meets(series.order(MOVED), order_of(ORDER, order, order / 8, eighth, twice), of=name)
        if name in ORDERS:
            continue
        curvature, h = 6.0 * (EXACT[HOOP] - EXACT[RADIAL]) / 2.0 / RING.inner**2, WALL / n
        far = f"{fourth_power(h, RING.inner)}, and its factor may be some units; rounded up to the "
        far += "next power of ten that a stiffness needs"
        within, near = within_surface(curvature, h)
        moved = Target(MOVED, EXACT[MOVED], tolerance, far, LAME, order=4.0)
        of_stress = within, f"{near}; tetrahedra are less even", LAME, "", False
        stresses = (Target(key, EXACT[key], *of_stress) for key in (HOOP, RADIAL))
        page.finest(series, moved, *stresses, of=f"{name}, plane strain")
    uniform = "as in plane strain: the axial strain is uniform, and adds no error of its own"
    opens = 1e6 * float(RING.displacement(RING.inner, Plane(E, NU)))
    target = Target(MOVED, opens, tolerance, uniform, LAME, order=4.0)
    page.finest(MeshSeries(free, THROUGH), target, of="free ends")
    answer(page, rows[-1])
    page.say(
        "Elements of second order converge with the fourth power of their size, those of first "
        "order with the second."
    )
    page.section("Convergence")
    for key, table in ((MOVED, (ELEMENT, THROUGH, *EXACT)), (HOOP, False)):
        title = ERRORS[key].capitalize()
        page.sweep(title, rows, THROUGH, ERRORS[key], by=ELEMENT, log="xy", table=table)
    page.text(
        "An eighth of the ring between planes of symmetry, one element wide. Mid-side nodes lie "
        "on the true circles. The mean displacement of the bore is the work of the pressure over "
        "pressure and area."
    )
    page.image("The eighth of the ring that is solved", run.sketch(eighth_of(RING, 27, 4)))
