"""Solid cylinder, taper and sphere under a field of temperature: NAFEMS benchmark LE11."""

from functools import cache

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import loaded_blocks as blocks
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.mesh import Block, brick
from fe_drivetrain.elasticity.operator import nodal_stresses, thermal_loads
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target, grouped

STEEL = Material(youngs_modulus=210e9, poisson_ratio=0.3, density=0.0, thermal_expansion=2.3e-4)
HEIGHT, POINT_A, TARGET = 1.79, (1.0, 0.0, 0.0), -105.0  # m, m, MPa
NAFEMS = "NAFEMS, The Standard NAFEMS Benchmarks, TNSB rev. 3, 1990, LE11"
STRESS, BALANCE = "sigma_zz at A [MPa]", "vertical forces on both ends over one of them"

#: Elements through the wall, along the meridian, round the quarter.
DIVISIONS = ((2, 8, 2), (4, 16, 4), (8, 32, 4))
QUICK_DIVISIONS = ((1, 4, 2), (2, 8, 2), (4, 16, 2))
NAMES = {n: f"hexahedra of {n} nodes" for n in (20, 27)}


def meridian(along: Floats) -> tuple[Floats, Floats]:
    """Points (n, 2) of inside and outside, radius and height [m], at four quarters of the length.

    Inside a sphere of 1 m up to 45 deg, then a cylinder; outside a sphere of 1.4 m up to 30 deg, a
    cone, and a cylinder of 1 m.
    """
    s = 4.0 * along
    edge, top = np.sqrt(0.5), HEIGHT
    angle = np.radians(22.5) * np.minimum(s, 2.0)
    up = np.interp(s, [2.0, 4.0], [edge, top])
    low = s <= 2.0
    inside = np.column_stack([np.where(low, np.cos(angle), edge), np.where(low, np.sin(angle), up)])
    angle = np.radians(30.0) * np.minimum(s, 1.0)
    foot = 1.4 * np.cos(np.radians(30.0)), 1.4 * np.sin(np.radians(30.0))
    radius = np.interp(s, [1.0, 3.0, 4.0], [foot[0], 1.0, 1.0])
    height = np.interp(s, [1.0, 3.0, 4.0], [foot[1], 1.39, top])
    ball = s <= 1.0
    outside = np.column_stack(
        [np.where(ball, 1.4 * np.cos(angle), radius), np.where(ball, 1.4 * np.sin(angle), height)]
    )
    return inside, outside


def quarter(divisions: tuple[int, int, int], nodes: int) -> Block:
    """A quarter of the solid: x0 inside, x1 outside, y0 and y1 the ends, z0 and z1 its planes.

    Elements are finer towards A; boundaries stay at the corners of the meridian.
    """

    def place(unit: Floats) -> Floats:
        inside, outside = meridian(unit[:, 1])
        r, z = ((1.0 - unit[:, :1]) * inside + unit[:, :1] * outside).T
        turn = 0.5 * np.pi * (1.0 - unit[:, 2])
        return np.column_stack([r * np.cos(turn), r * np.sin(turn), z])

    through, along, _ = divisions
    each = along // 4
    quarters = 0.25 * (np.arange(along + 1) / each)
    quarters[: each + 1] = 0.25 * (np.arange(each + 1) / each) ** 1.5
    return brick(
        divisions, nodes, place, ((np.arange(through + 1) / through) ** 1.5, quarters, None)
    )


@cache
def heated(nodes: int, divisions: tuple[int, int, int]) -> tuple[blocks.LoadedBlock, Floats]:
    """The solid at T = (x^2 + y^2)^(1/2) + z, its ends held along z; and its stresses [Pa]."""
    solid = quarter(divisions, nodes)
    x, y, z = solid.points.T
    free = STEEL.expansion("solid") * (np.hypot(x, y) + z)
    F = thermal_loads(solid.points, solid.cells, STEEL.lame, free)
    held = blocks.supports(solid, y0="z", y1="z", z0="x", z1="y")
    found = blocks.solve_block(solid, STEEL, F, held)
    stress = nodal_stresses(solid.points, solid.cells, found.u.ravel(), STEEL.lame, free)
    return found, stress


def solve(nodes: int, divisions: tuple[int, int, int]) -> Record:
    """What one mesh gives."""
    found, stress = heated(nodes, divisions)
    forces = found.static.reactions["supports"].reshape(-1, 3)[:, 2]
    ends = [float(forces[found.block.face_nodes(face)].sum()) for face in ("y0", "y1")]
    return {
        "element": NAMES[nodes],
        "unknowns": found.unknowns,
        STRESS: float(stress[found.node(*POINT_A), 2]) / 1e6,
        BALANCE: sum(ends) / ends[0],
    }


def answer(page: Page, kinds: list[str]) -> None:
    """State the stress at A."""
    figures = [
        page.judged(f"{kind}: sigma_zz at A", f"sigma_zz at A, {kind}", "NAFEMS", "-105")
        for kind in reversed(kinds)
    ]
    best = figures[0]
    page.answer(
        "Which stress does a varying temperature cause in the solid of NAFEMS LE11 at point A?",
        f"{kinds[-1].capitalize()} give a stress sigma_zz of {certain_value(best)} at point A, "
        f"{100 * abs(best.value / TARGET - 1):.2g}\u00a0% from NAFEMS's −105\u00a0MPa.",
        [
            *figures,
            page.value(
                f"difference from NAFEMS, {kinds[-1]} [%]", 100 * abs(best.value / TARGET - 1)
            ),
        ],
        hero=STRESS,
        cautions=[],
    )


@case(
    "Cylinder, taper and sphere under a field of temperature (NAFEMS LE11)",
    source="NAFEMS, The Standard NAFEMS Benchmarks, TNSB rev. 3, 1990, test LE11",
)
def run(run: Run, page: Page) -> None:
    """Solve the quarter with several elements, on ever finer meshes."""
    kinds, divisions = (20, 27), QUICK_DIVISIONS if run.quick else DIVISIONS
    rows = [run.timed(NAMES[n], solve, n, some) for n in kinds for some in divisions]
    peak = "a stress recovered at the corner of a mesh, and given with three digits; public finite "
    peak += "elements are some percent from it on coarse meshes. A quick run has coarser meshes"
    for name, series in grouped(rows, "element"):
        target = Target(
            STRESS, TARGET, 0.03 if run.quick else 0.01, peak, NAFEMS, f"{name}: sigma_zz at A"
        )
        page.finest(MeshSeries(series, "unknowns", dimension=3), target)
    residual = "of the residual that the solver leaves: a heated solid pushes both ends equally"
    page.meets(rows[-1][BALANCE], Target("forces on both ends", 0.0, 1e-6, residual, "equilibrium"))
    answer(page, [NAMES[n] for n in kinds])
    page.section("Stress at A")
    shown, nafems = ("element", "unknowns", STRESS), {"NAFEMS": TARGET}
    page.sweep(
        STRESS, rows, "unknowns", STRESS, by="element", log="x", reference=nafems, table=shown
    )
    coarse = heated(kinds[-1], QUICK_DIVISIONS[1])[0]
    still = run.sketch(coarse.block)
    page.image("Quarter of the solid, as meshed", still)
    page.text(
        "A quarter of a solid of revolution: inside a sphere of 1 m and a cylinder, outside a "
        "sphere of 1.4 m, a cone and a cylinder; 1.79 m high, both ends held along the axis, T = "
        "r + z in degC. A is at the inside in the plane z = 0. The temperature acts as a free "
        "strain, expansion times temperature, which loads the solid and causes no stress itself."
    )
