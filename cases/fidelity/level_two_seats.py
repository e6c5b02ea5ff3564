"""Level 2 between seats: the meridian in harmonics against solids whose seats are rigid."""

import time
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.shaft_ends import SHAFTS, STEEL, limit_of
from fe_drivetrain.common import (
    Floats,
    rigid_motions,
)
from fe_drivetrain.elasticity.mesh import shaft_hexahedra
from fe_drivetrain.elasticity.revolution import seat_stiffness
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.report import Difference, Verdict, difference_chart, trace
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite import Page, Record, Run

#: A seat on each of the shafts [m].
SEATS = {"bored": (0.6, 0.85), "stepped": (1.0, 1.2)}
CUTS, QUICK_CUTS = (1, 2, 3), (1, 2)
SIZE, TURN = 0.3, 8
LIMIT, MERIDIAN = "its limit", "meridian"

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


def rigid_motion_error(K: Floats, where: list[tuple[float, float]]) -> float:
    """Largest force of a stiffness (18, 18) under a rigid motion, over the terms of its sum."""
    rigid = np.zeros((18, 6))
    for k, (low, high) in enumerate(where):
        rigid[6 * k : 6 * k + 3] = rigid_motions(np.array([[(low + high) / 2, 0.0, 0.0]]))
        rigid[6 * k + 3 : 6 * k + 6] = np.eye(6)[3:]
    terms = np.abs(K) @ np.abs(rigid)
    return float((np.abs(K @ rigid) / np.where(terms > 0, terms, 1.0)).max())


@dataclass(frozen=True, eq=False)
class Seated:
    """A shaft with a rigid seat between its rigid ends, by the meridian and by solids.

    Attributes
    ----------
    name : str
        The shaft.
    where : list of tuple
        From where to where front, seat and rear are rigid [m].
    flat, rough : Floats
        (18, 18) of the meridian, and of one with an order and a layer less.
    milliseconds : float
        Time that the meridian takes.
    solids : list[Floats]
        (18, 18) of the solid, by cut.
    unknowns : list[int]
        Unknowns of the solid, by cut.
    """

    name: str
    where: list[tuple[float, float]]
    flat: Floats
    rough: Floats
    milliseconds: float
    solids: list[Floats]
    unknowns: list[int]

    @property
    def unit(self) -> Floats:
        """(18, 18) roots of both diagonal terms."""
        scale = np.sqrt(self.flat.diagonal())
        return np.outer(scale, scale)

    @property
    def differences(self) -> list[float]:
        """Largest difference of each solid from the meridian, of the roots of diagonals."""
        return [float(np.abs((K - self.flat) / self.unit).max()) for K in self.solids]


def seated(run: Run, name: str, cuts: tuple[int, ...]) -> Seated:
    """Solve a shaft with its seat by the meridian and as solids."""
    shaft, seat = SHAFTS[name], SEATS[name]
    where = [(shaft.front, shaft.front), seat, (shaft.rear, shaft.rear)]
    with run.step(f"{name}: meridian"):
        rough = seat_stiffness(shaft, STEEL, where, order=5, layers=3)
        seat_stiffness(shaft, STEEL, where)  # what is done once for all is done
        start = time.perf_counter()
        flat = seat_stiffness(shaft, STEEL, where)
        milliseconds = 1e3 * (time.perf_counter() - start)
    solids, unknowns = [], []
    for cut in cuts:
        with run.step(f"{name}: solid"):
            K, size = solid(shaft, seat, cut)
            solids.append(K)
            unknowns.append(size)
    return Seated(name, where, flat, rough, milliseconds, solids, unknowns)


def judge(page: Page, one: Seated, cuts: tuple[int, ...]) -> list[Record]:
    """Entries of the meridian against the limit of the solids, and its equilibrium."""
    rows: list[Record] = []
    for entry, i, j, of in ENTRIES:
        values = [float(K[i, j]) for K in one.solids]
        limit, band, words = limit_of(cuts, values)
        flat, own = float(one.flat[i, j]), abs(float(one.flat[i, j] - one.rough[i, j]))
        page.equals(
            f"{one.name}: {entry}",
            flat,
            limit,
            within=band / abs(limit),
            why=words,
            source=f"hexahedra of 27 nodes, {one.unknowns[-1]:,} unknowns",
            unit=of,
            measure="stiffness",
            band=own,
        )
        rows.append(
            {
                "shaft": one.name,
                "entry": entry,
                "unit": of,
                **{f"solid, cut {cut}": value for cut, value in zip(cuts, values, strict=True)},
                LIMIT: limit,
                "its band": band,
                MERIDIAN: flat,
                "band of the meridian": own,
            }
        )
    page.vanishes(
        f"{one.name}: force under a rigid motion of the 18 x 18, over its terms",
        rigid_motion_error(one.flat, one.where),
        within=1e-9,
        why="round-off of a direct solve: 1e-16 times a condition number of 1e6 or so",
        source="equilibrium of the free body",
    )
    return rows


def differences(one: Seated, rows: list[Record]) -> list[Difference]:
    """Entries of the meridian less their limits [% of the root of both diagonal terms]."""
    return [
        Difference(
            f"{one.name}: {name}",
            *(
                100.0 * float(value) / float(one.unit[i, j])
                for value in (
                    row[MERIDIAN] - row[LIMIT],
                    row["band of the meridian"],
                    row["its band"],
                )
            ),
        )
        for row, (name, i, j, _) in zip(rows, ENTRIES, strict=True)
    ]


SHOWN = 9  # stiffnesses, on the first screen
HERO = f"Meridian less solids: the {SHOWN} stiffnesses that use most of the bands of the solids"
BY_MESH = "Largest difference of solids from the meridian, on ever finer meshes"


def stiffnesses(page: Page) -> list[Verdict]:
    """Checks of entries of the stiffness against solids."""
    return [check for check in page.checks if check.measure == "stiffness"]


def with_range(figure: KeyFigure) -> KeyFigure:
    """A key figure that prints its reference with the range that is allowed."""
    reference = value_text(figure.limit or 0.0, band=figure.allowed)
    return figure.model_copy(update={"printed": reference})


def answer(page: Page, largest: float, milliseconds: float) -> None:
    """State how far the meridian is from solids [%], and the time that it takes [ms]."""
    terms = stiffnesses(page)
    agree = all(check.passed for check in terms)
    shown_first = (
        ("bored: tension at the seat", "tension at the seat, bored", "GN/m"),
        ("bored: bending at the seat", "bending at the seat, bored", "GN m/rad"),
        ("stepped: torsion at the seat", "torsion at the seat, stepped", "GN m/rad"),
    )
    page.answer(
        "Is an axisymmetric model of a shaft between its seats as accurate as a solid one?",
        f"{'All' if agree else 'Not all'} {len(terms)} stiffnesses of the axisymmetric model agree "
        f"with the solid model within its uncertainty; they differ by {largest:.2g}\u00a0% at "
        "most.",
        [
            page.value("largest difference from the converged solid model [%]", largest),
            page.value("stiffnesses compared", len(terms)),
            page.value("computing time, axisymmetric model [ms]", milliseconds),
            *(
                with_range(page.judged(quantity, name, "solids", unit=unit))
                for quantity, name, unit in shown_first
            ),
        ],
        hero=HERO,
        cautions=[
            "Stress is singular at the ends of a rigid seat: the solid model converges slowly, "
            "and its uncertainty limits the comparison.",
            "A difference of K_ij is relative to the square root of K_ii K_jj.",
        ],
    )


@case(
    "Level 2 between seats, against solids",
    source="Solids of 27-node hexahedra; equilibrium",
)
def run(run: Run, page: Page) -> None:
    """Two shafts, each with a rigid seat between its rigid ends."""
    cuts = QUICK_CUTS if run.quick else CUTS
    shafts = [seated(run, name, cuts) for name in SEATS]
    rows = {one.name: judge(page, one, cuts) for one in shafts}
    largest = max(abs(d.error) for one in shafts for d in differences(one, rows[one.name]))
    milliseconds = [one.milliseconds for one in shafts]
    answer(page, largest, max(milliseconds))
    page.section("Result")
    worst = sorted(
        (d for one in shafts for d in differences(one, rows[one.name])), key=lambda d: d.share
    )
    axis = "difference from the limit of the solids [%]"
    page.add(difference_chart(HERO, worst[-SHOWN:][::-1], axis))
    page.chart(
        BY_MESH,
        [trace(one.name, one.unknowns, one.differences) for one in shafts],
        "unknowns of the solid",
        "difference [-]",
        "xy",
    )
    page.table("Stiffness of front, seat and rear", [row for of in rows.values() for row in of])
    page.text(
        "The seat is the outer surface between two stations, rigid as the two end faces are. "
        "Stress is singular at its ends, so that the solid converges slowly; the meridian has four "
        "layers of ever smaller elements there, and its band is what one order and one layer "
        "changed."
    )
    page.data("largest", largest / 100.0)
    page.data("milliseconds", milliseconds)
