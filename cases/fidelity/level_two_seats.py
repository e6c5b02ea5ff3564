"""Level 2 between seats: the meridian in harmonics against solids whose seats are rigid."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Shafts of verification/shaft_ends, and a seat on each [m].
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


def run(run: Run) -> Any:
    """Two shafts, each with a rigid seat between its rigid ends."""
    import time

    import numpy as np

    from fe_drivetrain.common import rigid_motions
    from fe_drivetrain.compare import grid_convergence, richardson
    from fe_drivetrain.mesh import shaft_hexahedra
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.revolution import seat_stiffness
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation import (
        shaft_ends,
    )

    steel = shaft_ends.STEEL

    def solid(shaft: Any, seat: tuple[float, float], cut: int) -> tuple[Any, int]:
        """(18, 18) by the energies of unit motions."""
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
            middle = np.array([x, 0.0, 0.0])
            values[rows, 6 * k : 6 * k + 6] = rigid_motions(mesh.points[some], middle)
            first += len(some)
        which = (3 * nodes[:, None] + np.arange(3)).ravel()
        nothing = np.zeros((mesh.points.size, 18))
        found = solve_solid(mesh.points, mesh.cells, steel.lame, [], nothing, (which, values))
        return found.u.T @ (found.K @ found.u), mesh.points.size

    verdicts, traces = [], []
    rows: list[list[Any]] = []
    largest, milliseconds = 0.0, []
    cuts = QUICK_CUTS if run.quick else CUTS
    for name, seat in SEATS.items():
        shaft = shaft_ends.SHAFTS[name]
        where = [(shaft.front, shaft.front), seat, (shaft.rear, shaft.rear)]
        with run.step(f"{name}: meridian"):
            rough = seat_stiffness(shaft, steel, where, order=5, layers=3)
            seat_stiffness(shaft, steel, where)  # what is done once for all is done
            start = time.perf_counter()
            flat = seat_stiffness(shaft, steel, where)
            milliseconds.append(1e3 * (time.perf_counter() - start))
        solids, unknowns = [], []
        for cut in cuts:
            with run.step(f"{name}: solid"):
                K, size = solid(shaft, seat, cut)
            solids.append(K)
            unknowns.append(size)
        scale = np.sqrt(flat.diagonal())
        unit = np.outer(scale, scale)
        traces.append(
            trace(name, unknowns, [float(np.abs((K - flat) / unit).max()) for K in solids])
        )
        for entry, i, j, of in ENTRIES:
            values = [float(K[i, j]) for K in solids]
            if run.quick:
                limit = richardson([1 / c for c in cuts], values, 1.0)
                band = abs(values[-1] - values[-2])
                words = "what the finer of two meshes of the solid changed"
            else:
                grid = grid_convergence([1 / c for c in cuts], values, least_order=1.0)
                limit, band = grid.extrapolated, grid.extrapolated_uncertainty
                band = max(band, abs(values[-1] - limit))
                words = f"the band of three meshes of the solid ({grid.behaviour})"
            own = abs(float(flat[i, j] - rough[i, j]))
            verdicts.append(
                judge(
                    f"{name}: {entry}",
                    float(flat[i, j]),
                    limit,
                    tolerance=band / abs(limit),
                    unit=of,
                    source=f"hexahedra of 27 nodes, {unknowns[-1]:,} unknowns",
                    reason=words,
                    measure="stiffness",
                    band=own,
                )
            )
            rows.append([name, entry, of, *values, limit, band, float(flat[i, j]), own])
            largest = max(largest, abs(float(flat[i, j]) - limit) / float(unit[i, j]))
        rigid = np.zeros((18, 6))
        for k, (low, high) in enumerate(where):
            rigid[6 * k : 6 * k + 3] = rigid_motions(np.array([[(low + high) / 2, 0.0, 0.0]]))
            rigid[6 * k + 3 : 6 * k + 6] = np.eye(6)[3:]
        terms = np.abs(flat) @ np.abs(rigid)
        verdicts.append(
            judge(
                f"{name}: force under a rigid motion of the 18 x 18, over its terms",
                float((np.abs(flat @ rigid) / np.where(terms > 0, terms, 1.0)).max()),
                0.0,
                tolerance=1e-9,
                relative=False,
                source="equilibrium of the free body",
                reason="round-off of a direct solve: 1e-16 times a condition number of 1e6 or so",
                measure="identity",
                band=0.0,
            )
        )
    return CASE.results(
        run,
        summary=[
            f"Between rigid ends and a rigid seat the meridian has every stiffness of the solids "
            f"within their bands, at most {100 * largest:.2g} % from their limit (of the root of "
            f"both diagonal terms), in {max(milliseconds):.0f} ms.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Result",
                items=[
                    chart(
                        "Largest difference of the 18 x 18 from the meridian's, scaled to 1 on the "
                        "diagonal",
                        traces,
                        "unknowns of the solid",
                        "difference [-]",
                        logarithmic="xy",
                    ),
                    Table(
                        caption="Stiffness of front, seat and rear",
                        columns=[
                            "shaft",
                            "entry",
                            "unit",
                            *(f"solid, cut {c}" for c in cuts),
                            "its limit",
                            "its band",
                            "meridian",
                            "its band",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="The seat is the outer surface between two stations, rigid as the two "
                        "end faces are. Stress is singular at its ends, so that the solid is "
                        "slow to settle; the meridian has four layers of ever smaller elements "
                        "there, and its band is what one order and one layer changed."
                    ),
                ],
            )
        ],
        figures={"largest": largest, "milliseconds": milliseconds},
    )


CASE = Case(
    name="fidelity/level_two_seats",
    title="Level 2 between seats, against solids",
    source="Solids of 27-node hexahedra; equilibrium",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
