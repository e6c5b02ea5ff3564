"""Level 2 between seats: the meridian in harmonics against solids whose seats are rigid."""

import time

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.shaft_ends import SHAFTS, STEEL
from fe_drivetrain.common import (
    Floats,
    rigid_motions,
)
from fe_drivetrain.comparison import grid_convergence, richardson
from fe_drivetrain.elasticity.mesh import shaft_hexahedra
from fe_drivetrain.elasticity.revolution import seat_stiffness
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.report import Cell, trace
from fe_drivetrain.report.suite import Page, Run

#: A seat on each of the shafts [m].
SEATS = {"bored": (0.6, 0.85), "stepped": (1.0, 1.2)}
CUTS, QUICK_CUTS = (1, 2, 3), (1, 2)
SIZE, TURN = 0.3, 8

#: Of the 18 x 18 of front, seat and rear: rows and columns, names and units.
ENTRIES = (
    ("tension at the seat", 6, 6, "N/m"),
    ("shear at the seat", 7, 7, "N/m"),
    ("shear by rotation at the seat", 7, 11, "N/rad"),
    ("torsion at the seat", 9, 9, "N m/rad"),
    ("bending at the seat", 11, 11, "N m/rad"),
    ("tension, front by seat", 0, 6, "N/m"),
    ("shear, front by seat", 1, 7, "N/m"),
    ("torsion, front by seat", 3, 9, "N m/rad"),
    ("bending, rear by seat", 17, 11, "N m/rad"),
)


def solid(shaft: Shaft, seat: tuple[float, float], cut: int) -> tuple[Floats, int]:
    """(18, 18) by the energies of unit motions, and the unknowns."""
    mesh = shaft_hexahedra(
        shaft, SIZE, 27, elements_per_turn=TURN, refinement=cut, seats={"seat": seat}
    )
    sets = [
        (mesh.front, shaft.front),
        (mesh.seats["seat"], sum(seat) / 2),
        (mesh.rear, shaft.rear),
    ]
    nodes = np.concatenate([some for some, _ in sets])
    values = np.zeros((3 * len(nodes), 18))
    first = 0
    for k, (some, x) in enumerate(sets):
        rows = slice(3 * first, 3 * (first + len(some)))
        values[rows, 6 * k : 6 * k + 6] = rigid_motions(mesh.points[some], np.array([x, 0.0, 0.0]))
        first += len(some)
    which = (3 * nodes[:, None] + np.arange(3)).ravel()
    nothing = np.zeros((mesh.points.size, 18))
    found = solve_solid(mesh.points, mesh.cells, STEEL.lame, [], nothing, (which, values))
    return found.u.T @ (found.K @ found.u), mesh.points.size


def limit_of(cuts: tuple[int, ...], values: list[float]) -> tuple[float, float, str]:
    """Limit of a solid's entry on ever finer meshes, its band, and how that was found."""
    sizes = [1 / cut for cut in cuts]
    if len(cuts) == 2:
        limit = richardson(sizes, values, 1.0)
        return (
            limit,
            abs(values[-1] - values[-2]),
            "what the finer of two meshes of the solid changed",
        )
    grid = grid_convergence(sizes, values, least_order=1.0)
    band = max(grid.extrapolated_uncertainty, abs(values[-1] - grid.extrapolated))
    return grid.extrapolated, band, f"the band of three meshes of the solid ({grid.behaviour})"


def rigid_motion_error(K: Floats, where: list[tuple[float, float]]) -> float:
    """Largest force of a stiffness (18, 18) under a rigid motion, over the terms of its sum."""
    rigid = np.zeros((18, 6))
    for k, (low, high) in enumerate(where):
        rigid[6 * k : 6 * k + 3] = rigid_motions(np.array([[(low + high) / 2, 0.0, 0.0]]))
        rigid[6 * k + 3 : 6 * k + 6] = np.eye(6)[3:]
    terms = np.abs(K) @ np.abs(rigid)
    return float((np.abs(K @ rigid) / np.where(terms > 0, terms, 1.0)).max())


@case(
    "Level 2 between seats, against solids",
    source="Solids of 27-node hexahedra; equilibrium",
)
def run(run: Run, page: Page) -> None:
    """Two shafts, each with a rigid seat between its rigid ends."""
    cuts = QUICK_CUTS if run.quick else CUTS
    rows: list[list[Cell]] = []
    traces, milliseconds, errors = [], [], []
    for name, seat in SEATS.items():
        shaft = SHAFTS[name]
        where = [(shaft.front, shaft.front), seat, (shaft.rear, shaft.rear)]
        with run.step(f"{name}: meridian"):
            rough = seat_stiffness(shaft, STEEL, where, order=5, layers=3)
            seat_stiffness(shaft, STEEL, where)  # what is done once for all is done
            start = time.perf_counter()
            flat = seat_stiffness(shaft, STEEL, where)
            milliseconds.append(1e3 * (time.perf_counter() - start))
        solids = []
        for cut in cuts:
            with run.step(f"{name}: solid"):
                solids.append(solid(shaft, seat, cut))
        unknowns = [size for _, size in solids]
        scale = np.sqrt(flat.diagonal())
        unit = np.outer(scale, scale)
        traces.append(
            trace(name, unknowns, [float(np.abs((K - flat) / unit).max()) for K, _ in solids])
        )
        for entry, i, j, of in ENTRIES:
            values = [float(K[i, j]) for K, _ in solids]
            limit, band, words = limit_of(cuts, values)
            own = abs(float(flat[i, j] - rough[i, j]))
            page.equals(
                f"{name}: {entry}",
                float(flat[i, j]),
                limit,
                within=band / abs(limit),
                why=words,
                source=f"hexahedra of 27 nodes, {unknowns[-1]:,} unknowns",
                unit=of,
                measure="stiffness",
                band=own,
            )
            rows.append([name, entry, of, *values, limit, band, float(flat[i, j]), own])
            errors.append(abs(float(flat[i, j]) - limit) / float(unit[i, j]))
        page.vanishes(
            f"{name}: force under a rigid motion of the 18 x 18, over its terms",
            rigid_motion_error(flat, where),
            within=1e-9,
            why="round-off of a direct solve: 1e-16 times a condition number of 1e6 or so",
            source="equilibrium of the free body",
        )
    page.answer(
        f"Between rigid ends and a rigid seat the meridian has every stiffness of the solids "
        f"within their bands, at most {100 * max(errors):.2g} % from their limit (of the root of "
        f"both diagonal terms), in {max(milliseconds):.0f} ms."
    )
    page.section("Result")
    page.chart(
        "Largest difference of the 18 x 18 from the meridian's, scaled to 1 on the diagonal",
        traces,
        "unknowns of the solid",
        "difference [-]",
        "xy",
    )
    page.table(
        "Stiffness of front, seat and rear",
        rows,
        [
            "shaft",
            "entry",
            "unit",
            *(f"solid, cut {cut}" for cut in cuts),
            "its limit",
            "its band",
            "meridian",
            "band of the meridian",
        ],
    )
    page.text(
        "The seat is the outer surface between two stations, rigid as the two end faces are. "
        "Stress is singular at its ends, so that the solid converges slowly; the meridian has four "
        "layers of ever smaller elements there, and its band is what one order and one layer "
        "changed."
    )
    page.data("largest", max(errors))
    page.data("milliseconds", milliseconds)
