"""Bracket with a fillet under an end force, against a plane solution by scikit-fem."""

from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.compare import band_of
from fe_drivetrain.interfaces import held_dofs
from fe_drivetrain.mesh import brick
from fe_drivetrain.operator import nodal_stresses, principal, traction_loads
from fe_drivetrain.report import trace
from fe_drivetrain.scene import Material
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import Page, Record, Run, column
from fe_drivetrain.validation.bracket_plane import Bracket, plane_answer
from fe_drivetrain.validation.ring_solids import node_at, plane_strain_hold

FILLET, HEIGHT, ARM, LEG = 0.05, 0.1, 0.3, 0.2  # m
BRACKET = Bracket(FILLET, HEIGHT, ARM, LEG)
FORCE = 1e6  # N/m, per width
IRON = Material(youngs_modulus=169e9, poisson_ratio=0.275, density=0.0)

#: Hexahedra through the height.
THROUGH = (2, 4, 8)
QUICK_THROUGH = (2, 3, 6)
#: Quartic triangles through the height, of the reference and of one coarser.
REFERENCE = (4, 6)

ENERGY, PEAK, BASE = (
    "energy per width [J/m]",
    "fillet's greatest stress [MPa]",
    "base's stress [MPa]",
)


def traction(x: Floats, normal: Floats) -> Floats:
    """A parabola of shear on the end of the arm."""
    zero = np.zeros(len(x))
    return np.column_stack([zero, zero, BRACKET.end_shear(x[:, 2], FORCE)])


def solve(n: int) -> tuple[Record, tuple[Floats, Floats]]:
    """One mesh, and the greatest principal stress along the inside."""
    width = HEIGHT / n
    along = BRACKET.edges(n)

    def shape(unit: Floats) -> Floats:
        return np.column_stack([width * unit[:, 2], BRACKET.place(unit[:, 0], unit[:, 1])])

    # thinner elements at the inside, whose stress is what is looked for
    through = (np.arange(n + 1) / n) ** 1.5
    block = brick((n, len(along) - 1, 1), 27, shape, (through, along, None))
    points, size = block.points, block.points.size
    inside = node_at(points, [0.0, -FILLET, -LEG])
    base = np.append(3 * block.face_nodes("y1") + 2, 3 * inside + 1)
    held = [plane_strain_hold(block), held_dofs("base", base, size)]
    F = traction_loads(points, block.faces["y0"], traction)
    static = solve_solid(points, block.cells, IRON.lame, held, F)
    s = nodal_stresses(points, block.cells, static.u[:, 0], IRON.lame)
    edge = block.face_nodes("x0")
    edge = edge[points[edge, 0] == 0.0]
    place = BRACKET.along_inside(points[edge, 1:])
    edge = edge[np.argsort(place)]
    corner = edge[(points[edge, 1] < 1e-9) & (points[edge, 2] > -1e-9)]
    row = {
        "mesh": f"{n} hexahedra of 27 nodes through the height",
        ENERGY: float(static.energy[0]) / width,
        PEAK: float(principal(s[corner])[:, 2].max()) / 1e6,
        BASE: float(s[inside, 2]) / 1e6,
    }
    return row, (np.sort(place), principal(s[edge])[:, 2] / 1e6)


@case(
    "Bracket with a fillet under an end force",
    source="Plane solution of the same bracket by scikit-fem (quartic triangles); beam theory in "
    "the leg",
)
def run(run: Run, page: Page) -> None:
    """Solve the bracket as a solid on three meshes, and as a plane problem."""
    levels = QUICK_THROUGH if run.quick else THROUGH
    solids = []
    for n in levels:
        row, profile = run.timed(f"solid, {n} hexahedra through the height", solve, n)
        solids.append(row)
    with run.step("plane problem, scikit-fem"):
        E, nu = IRON.youngs_modulus, IRON.poisson_ratio
        planes: list[dict[str, Any]] = []
        for n in REFERENCE:
            energy, peak = plane_answer(BRACKET, E, nu, FORCE, n)
            mesh = f"{n} quartic triangles, plane"
            planes.append({"mesh": mesh, ENERGY: energy, PEAK: peak / 1e6, BASE: None})
    last, reference = solids[-1], planes[-1]
    lever = ARM + FILLET + 0.5 * HEIGHT
    nominal = (FORCE / HEIGHT + 6.0 * FORCE * lever / HEIGHT**2) / 1e6
    doubt = {key: abs(reference[key] / planes[0][key] - 1.0) for key in (ENERGY, PEAK)}
    sizes = 1.0 / np.array(levels)
    first = HEIGHT / levels[-1] ** 1.5
    missed = 0.5 * (first / FILLET) ** 2
    plane = "the same bracket in plane strain by scikit-fem: quartic triangles, own assembly"
    page.equals(
        "stiffness P^2 / (2 U) per width",
        0.5e-9 * FORCE**2 / last[ENERGY],
        0.5e-9 * FORCE**2 / reference[ENERGY],
        within=2e-3 if run.quick else 5e-4,
        why="energy of elements of second order, which are at most a quarter of the fillet's "
        "radius long there (a third in a quick run), to the fourth power, in a part of the "
        f"bracket; the reference moves by {doubt[ENERGY]:.0e} from its next coarser mesh",
        source=plane,
        unit="GN/m/m",
        measure="stiffness",
        band=0.5e-9 * FORCE**2 * band_of(sizes, column(solids, ENERGY), 4.0) / last[ENERGY] ** 2,
    )
    page.equals(
        "greatest principal stress of the fillet",
        last[PEAK],
        reference[PEAK],
        within=0.02 if run.quick else 0.01,
        why="hoop stress falls at most as 1 / r^2 from the fillet: recovered stress misses "
        f"6 (h/r)^2 / 12 = {100 * missed:.2f} % of it, with h the first element's height; as much "
        f"again for its varying along the fillet. The reference moves by {doubt[PEAK]:.0e} from "
        "its next coarser mesh",
        source=plane,
        unit="MPa",
        measure="stress",
        band=band_of(sizes, column(solids, PEAK)),
    )
    page.equals(
        "stress of the base's inner fibre",
        last[BASE],
        nominal,
        within=2e-3,
        why="what the corner disturbs decays as exp(-4.2 x / h), 2e-4 at the base, two heights "
        "away, of a disturbance as great as the stress itself",
        source="P / h + 6 P (lever) / h^2, Saint-Venant",
        unit="MPa",
        measure="stress",
        band=band_of(sizes, column(solids, BASE)),
    )
    page.answer(
        f"The solid bracket is within {100 * abs(reference[ENERGY] / last[ENERGY] - 1):.3f} % of "
        "the plane solution's stiffness and within "
        f"{100 * abs(last[PEAK] / reference[PEAK] - 1):.2f} % of its greatest stress in the "
        f"fillet, {reference[PEAK]:.1f} MPa: {reference[PEAK] / nominal:.2f} times the nominal "
        "stress of the leg."
    )
    page.section("Stress along the inside")
    ends = [ARM, ARM + 0.5 * np.pi * FILLET]
    dotted = {"dash": "dot"}
    page.chart(
        "Greatest principal stress from the end of the arm to the base",
        [
            trace("solid, finest mesh", *profile),
            trace(
                "greatest in the fillet, plane problem", ends, [reference[PEAK]] * 2, line=dotted
            ),
            trace("leg, beam theory", [ends[1], ends[1] + LEG], [nominal] * 2, line=dotted),
        ],
        "distance along the inside [m]",
        "stress [MPa]",
    )
    page.table("By mesh", [*solids, *planes])
    page.text(
        "A strip bent by a quarter circle, its leg's end on a plane of symmetry: half of a "
        "C-frame. The force on the end of the arm is a parabola of shear, so that nothing is "
        "singular. Plane strain."
    )
    page.assume(
        "fillet, height, arm, leg",
        f"{FILLET} / {HEIGHT} / {ARM} / {LEG}",
        "m",
        "a bracket of ordinary proportions; there is no published one with these",
    )
    page.data("meshes", [*solids, *planes])
