"""Block in shear, in bending and as a cantilever: strain energies known in closed form."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.bent_blocks import BentBlock
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.mesh import ELEMENT_NAMES as NAMES
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target, column, order_of

IRON = Material(youngs_modulus=169e9, poisson_ratio=0.275, density=0.0)
BLOCK = BentBlock(length=0.6, height=0.2, width=0.15, material=IRON)  # m
SHEAR, CURVATURE, FORCE = 1e-3, 1e-3, 1e6  # rad, 1/m, N/m of width

SECOND_ORDER = (10, 20, 27)
#: Elements through the height, by the nodes of an element; three times as many along the block.
DIVISIONS = {4: (8, 16, 32), 8: (8, 16, 32), 10: (2, 4, 8), 20: (2, 4, 8), 27: (2, 4, 8)}
EXACT = {"shear": BLOCK.shear_energy(SHEAR), "bending": BLOCK.bending_energy(CURVATURE)}
EXACT["cantilever"] = BLOCK.flexure_energy(FORCE)
#: Displacements, and where the energy comes from.
FIELDS = {
    "shear": (lambda p: BLOCK.sheared(p, SHEAR), "G gamma^2 V / 2"),
    "bending": (lambda p: BLOCK.bent(p, CURVATURE), "E kappa^2 I L / 2 (Saint-Venant)"),
}
FLEXURE = "Timoshenko and Goodier 1970, art 21: P^2 L^3/(6 E' I) + 3 P^2 L/(5 G A)"
THROUGH = "elements through the height"
ENERGY, MISSED = "energy per width [J/m]", "1 - energy / exact energy"


def solve(nodes: int, n: int) -> Record:
    """The cantilever on one mesh."""
    energy = BLOCK.cantilever_energy(nodes, n, FORCE)
    share = max(1.0 - energy / EXACT["cantilever"], 1e-12)
    return {"element": NAMES[nodes], THROUGH: n, ENERGY: energy, MISSED: share}


def answer(page: Page, missed: dict[str, float]) -> None:
    """State the energy [%] that eight elements of each kind through the height miss."""
    best, linear = missed[NAMES[27]], missed[NAMES[4]]
    title = "cantilever, hexahedra of 27 nodes: strain energy per width"
    page.answer(
        "How much of a bent block's strain energy do different finite elements miss?",
        f"With eight elements through the height, hexahedra of 27 nodes miss "
        f"{formatted(best, 2, '%')}\u00a0% of a cantilever's strain energy; linear tetrahedra miss "
        f"{formatted(linear, 2, '%')}\u00a0%.",
        [
            *(
                page.value(f"missed by {NAMES[n]} [%]", missed[NAMES[n]])
                for n in (27, 20, 10, 8, 4)
            ),
            page.judged(title, "energy, hexahedra of 27 nodes", "closed form"),
        ],
        hero="Strain energy of the cantilever that is missed",
        cautions=[
            "A mesh that misses energy is too stiff by the same share.",
            "In shear alone and in pure bending every second-order element is exact.",
        ],
    )


@case(
    "Block in shear, bending and as a cantilever: strain energies in closed form",
    source="Saint-Venant's bending; Timoshenko and Goodier 1970, Theory of Elasticity, art 21",
)
def run(run: Run, page: Page) -> None:
    """Energy of three fields with every element."""
    displaced: list[Record] = []
    contained = "the field is in the elements' own space: round-off"
    for nodes, name in NAMES.items():
        displaced.append({"element": name})
        for field, (moved, source) in FIELDS.items():
            energy = run.timed("shear and bending", BLOCK.displaced_energy, nodes, moved)
            displaced[-1][f"{field}, energy over the exact one"] = share = energy / EXACT[field]
            if field == "shear" or nodes in SECOND_ORDER:
                title = f"{field}, {name}: strain energy, relative to the exact one"
                page.meets(share - 1.0, Target(title, 0.0, 1e-9, contained, source))
    lost = "one lost order of the strains would show as 2 less; coarse meshes of linear elements "
    lost += "lock, and are barely in their asymptotic range"
    quadratic = "the stress is quadratic, of strains that are linear in an element (1/8)^2 is "
    quadratic += "missed, and in energy the square of that, 2e-4, times a small factor"
    rows: list[Record] = []
    for nodes, name in NAMES.items():
        order, of = (4.0 if nodes in SECOND_ORDER else 2.0), f"cantilever, {name}"
        series = MeshSeries([run.timed(of, solve, nodes, n) for n in DIVISIONS[nodes]], THROUGH)
        rows += series.rows
        title, source = "order of the strain energy", "twice the order of the strains"
        page.meets(series.order(ENERGY), order_of(title, order, 0.3, lost, source), of=of)
        if nodes in SECOND_ORDER:
            exact, title = EXACT["cantilever"], "strain energy per width"
            target = Target(ENERGY, exact, 1e-4, quadratic, FLEXURE, title, order=order)
            page.finest(series, target, of=of)
    above = sum(energy > EXACT["cantilever"] * (1.0 + 1e-9) for energy in column(rows, ENERGY))
    title = "cantilever: meshes whose energy is above the exact one"
    strict = "the bound is strict for elements that conform and loads that are integrated exactly: "
    strict += "a single mesh above it has a fault in one of them"
    least = "minimum of the potential energy: under given forces, an element mesh is too stiff"
    page.meets(above, Target(title, 0.0, 0.0, strict, least))
    answer(page, {row["element"]: 100 * row[MISSED] for row in rows if row[THROUGH] == 8})
    page.section("Energy of the cantilever")
    page.image("The block", run.sketch(BLOCK.mesh(20, (12, 4, 3), BLOCK.width)))
    page.sweep(
        "Strain energy of the cantilever that is missed",
        rows,
        THROUGH,
        MISSED,
        by="element",
        log="xy",
    )
    page.table("Shear and bending, four elements along the block and two through it", displaced)
    page.text(
        "Shear and bending: the displacement of the whole surface is that of the exact field. "
        "Cantilever: plane strain; both ends carry the exact tractions, so the stress is that of "
        "the closed form to the last corner."
    )
    page.data("exact [J, J/m]", EXACT)
    page.data("displaced", displaced)
