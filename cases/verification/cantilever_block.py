"""Block in shear, in bending and as a cantilever: strain energies known in closed form."""

from collections.abc import Callable

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.compare import observed_order
from fe_drivetrain.interfaces import held_nodes
from fe_drivetrain.mesh import FACES, Block, brick
from fe_drivetrain.scene import Material
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target, column, grouped
from fe_drivetrain.validation.loaded_blocks import face_loads, solve_block, supports
from fe_drivetrain.validation.plane_rings import plane_strain
from fe_drivetrain.validation.ring_solids import node_at

LENGTH, HEIGHT, WIDTH = 0.6, 0.2, 0.15  # m
E, NU = 169e9, 0.275
IRON = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0)
PLANE = plane_strain(E, NU)
SHEAR, CURVATURE = 1e-3, 1e-3  # rad, 1/m
FORCE = 1e6  # N/m, per width

NAMES = {n: f"tetrahedra of {n} nodes" for n in (4, 10)}
NAMES |= {n: f"hexahedra of {n} nodes" for n in (8, 20, 27)}
SECOND_ORDER = (10, 20, 27)

#: Elements through the height, by the nodes of an element; three times as many along the block.
DIVISIONS = {4: (8, 16, 32), 8: (8, 16, 32), 10: (2, 4, 8), 20: (2, 4, 8), 27: (2, 4, 8)}

EXACT = {
    "shear": 0.5 * IRON.shear_modulus * SHEAR**2 * LENGTH * HEIGHT * WIDTH,
    "bending": 0.5 * E * CURVATURE**2 * (WIDTH * HEIGHT**3 / 12.0) * LENGTH,
    # per width: bending and the shear of a parabola, of the plane solution with E'
    "cantilever": FORCE**2
    * (LENGTH**3 / (6.0 * PLANE.E * HEIGHT**3 / 12.0) + 0.6 * LENGTH / (PLANE.G * HEIGHT)),
}
SOURCES = {"shear": "G gamma^2 V / 2", "bending": "E kappa^2 I L / 2 (Saint-Venant)"}
FLEXURE = "Timoshenko and Goodier 1970, art 21: P^2 L^3/(6 E' I) + 3 P^2 L/(5 G A)"
THROUGH, ENERGY, MISSED = (
    "elements through the height",
    "energy per width [J/m]",
    "1 - energy / exact energy",
)


def mesh(nodes: int, divisions: tuple[int, int, int], width: float) -> Block:
    """The block in elements of so many nodes."""
    size = np.array([LENGTH, width, HEIGHT])
    return brick(divisions, nodes, lambda p: size * (p - [0.0, 0.5, 0.5]))


def sheared(p: Floats) -> Floats:
    """Simple shear."""
    return SHEAR * np.column_stack([p[:, 2], np.zeros(len(p)), np.zeros(len(p))])


def bent(p: Floats) -> Floats:
    """Pure bending with the section's own distortion: the stress is E kappa z along x alone."""
    x, y, z = p.T
    drop = -0.5 * (x**2 + NU * (z**2 - y**2))
    return CURVATURE * np.column_stack([x * z, -NU * y * z, drop])


def under_displacement(nodes: int, field: Callable[[Floats], Floats]) -> float:
    """Strain energy when the whole surface is displaced as by the field."""
    block = mesh(nodes, (4, 2, 2), WIDTH)
    surface = np.unique(np.concatenate([block.face_nodes(face) for face in FACES]))
    moved = (3 * surface[:, None] + np.arange(3)).ravel()
    values = field(block.points[surface]).ravel()
    n = block.points.size
    static = solve_solid(block.points, block.cells, IRON.lame, [], np.zeros(n), (moved, values))
    return float(static.energy[0])


def stress(x: Floats, normal: Floats) -> Floats:
    """Tractions of the plane cantilever with its force at x = 0 (parabolic shear)."""
    inertia, c = HEIGHT**3 / 12.0, 0.5 * HEIGHT
    along = FORCE * x[:, 0] * x[:, 2] / inertia
    shear = FORCE * (c**2 - x[:, 2] ** 2) / (2.0 * inertia)
    return np.asarray(normal[:, :1] * np.column_stack([along, np.zeros(len(x)), shear]))


def cantilever(nodes: int, n: int) -> float:
    """Strain energy per width under the exact tractions on both ends, in plane strain."""
    width = HEIGHT / n
    block = mesh(nodes, (3 * n, 1, n), width)
    top, bottom = (
        node_at(block.points, [LENGTH, -0.5 * width, z]) for z in (0.5 * HEIGHT, -0.5 * HEIGHT)
    )
    flat = held_nodes("plane strain", np.arange(len(block.points)), [1], block.points.size)
    held = supports(block, (top, "x"), (bottom, "xz"))
    F = face_loads(block, x0=stress, x1=stress)
    return solve_block(block, IRON, F, flat, held).energy / width


@case(
    "Block in shear, bending and as a cantilever: strain energies in closed form",
    source="Saint-Venant's bending; Timoshenko and Goodier 1970, Theory of Elasticity, art 21",
)
def run(run: Run, page: Page) -> None:
    """Energy of three fields with every element."""
    displaced: list[Record] = []
    for nodes, name in NAMES.items():
        displaced.append({"element": name})
        for field, moved in (("shear", sheared), ("bending", bent)):
            energy = run.timed("shear and bending", under_displacement, nodes, moved)
            displaced[-1][f"{field}, energy over the exact one"] = energy / EXACT[field]
    rows: list[Record] = []
    for nodes, name in NAMES.items():
        for n in DIVISIONS[nodes]:
            energy = run.timed(f"cantilever, {name}", cantilever, nodes, n)
            share = max(1.0 - energy / EXACT["cantilever"], 1e-12)
            rows.append({"element": name, THROUGH: n, ENERGY: energy, MISSED: share})

    for (nodes, name), row in zip(NAMES.items(), displaced, strict=True):
        for field, source in SOURCES.items():
            if field == "shear" or nodes in SECOND_ORDER:
                page.vanishes(
                    f"{field}, {name}: strain energy, relative to the exact one",
                    row[f"{field}, energy over the exact one"] - 1.0,
                    within=1e-9,
                    why="the field is in the elements' own space: round-off",
                    source=source,
                )
    for nodes, name in NAMES.items():
        series = MeshSeries([row for row in rows if row["element"] == name], THROUGH)
        order = 4.0 if nodes in SECOND_ORDER else 2.0
        page.equals(
            f"cantilever, {name}: order of the strain energy",
            observed_order(1.0 / np.array(DIVISIONS[nodes]), column(series.rows, ENERGY)),
            order,
            within=0.3,
            relative=False,
            why="one lost order of the strains would show as 2 less; coarse meshes of linear "
            "elements lock, and are barely in their asymptotic range",
            source="twice the order of the strains",
            measure="order",
        )
        if nodes in SECOND_ORDER:
            why = "the stress is quadratic, of strains that are linear in an element (1/8)^2 is "
            why += "missed, and in energy the square of that, 2e-4, times a small factor"
            title = f"cantilever, {name}: strain energy per width"
            exact = EXACT["cantilever"]
            page.finest(series, Target(ENERGY, exact, 1e-4, why, FLEXURE, title, order=order))
    page.vanishes(
        "cantilever: meshes whose energy is above the exact one",
        sum(energy > EXACT["cantilever"] * (1.0 + 1e-9) for energy in column(rows, ENERGY)),
        within=0.0,
        why="the bound is strict for elements that conform and loads that are integrated exactly: "
        "a single mesh above it has a fault in one of them",
        source="minimum of the potential energy: under given forces, an element mesh is too stiff",
    )
    missed = {name: column(series, MISSED) for name, series in grouped(rows, "element")}
    page.answer(
        f"The cantilever stores {EXACT['cantilever']:.2f} J a metre of width; eight hexahedra of "
        f"27 nodes through its height miss {missed[NAMES[27]][-1]:.1e} of it, as many of 8 nodes "
        f"{100 * missed[NAMES[8]][0]:.1f} %, of tetrahedra of 4 nodes "
        f"{100 * missed[NAMES[4]][0]:.0f} %. Shear and pure bending are exact with every element "
        "of second order."
    )
    page.section("Energy of the cantilever")
    page.sweep("Strain energy that is missed", rows, THROUGH, MISSED, by="element", log="xy")
    page.table("Shear and bending, four elements along the block and two through it", displaced)
    page.text(
        "Shear and bending: the displacement of the whole surface is that of the exact field. "
        "Cantilever: plane strain; both ends carry the exact tractions, so the stress is that of "
        "the closed form to the last corner."
    )
    page.data("exact [J, J/m]", EXACT)
    page.data("displaced", displaced)
