"""Thick cylinder under internal pressure, with every element, against Lame."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

INNER, OUTER = 0.3, 0.6  # m
PRESSURE = 100e6  # Pa
E, NU = 200e9, 0.3
EIGHTH = 0.7853981633974483  # rad: 45 degrees, between planes of symmetry

#: Elements through the wall, by the nodes of an element.
DIVISIONS = {4: (4, 8, 16), 8: (4, 8, 16, 32), 10: (2, 4, 8), 20: (2, 4, 8, 16), 27: (2, 4, 8, 16)}
QUICK_DIVISIONS = {4: (4, 8, 16), 8: (4, 8, 16), 10: (2, 4, 8), 20: (2, 4, 8), 27: (2, 4, 8)}

NAMES = {
    4: "tetrahedra of 4 nodes",
    10: "curved tetrahedra of 10 nodes",
    8: "hexahedra of 8 nodes",
    20: "hexahedra of 20 nodes",
    27: "hexahedra of 27 nodes",
}


def run(run: Run) -> Any:
    """Solve an eighth of the ring on ever finer meshes."""
    import numpy as np

    from fe_drivetrain.compare import (
        band_of,
        observed_order,
    )
    from fe_drivetrain.interfaces import held_nodes
    from fe_drivetrain.operator import nodal_stresses, pressure, traction_loads
    from fe_drivetrain.report import Cell, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import Material
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation.plane_rings import (
        Lame,
        Plane,
        plane_strain,
    )
    from fe_drivetrain.validation.ring_solids import (
        node_at,
        plane_strain_hold,
        polar_stresses,
        ring_sector,
        sector_symmetry,
    )

    lame = Material(youngs_modulus=E, poisson_ratio=NU, density=0.0).lame
    exact = Lame(INNER, OUTER, inside=PRESSURE)
    bore = np.array(INNER)

    def solve(nodes: int, n: int, free_ends: bool = False) -> dict[str, float]:
        """Mean displacement of the bore by the work of the pressure, and stresses at its end."""
        width = (OUTER - INNER) / n
        # so divided that elements at the bore are about square
        block = ring_sector(INNER, OUTER, width, EIGHTH, (n, n, 1), nodes)
        size = block.points.size
        ends = (
            held_nodes("end", block.face_nodes("z0"), [0], size)
            if free_ends
            else plane_strain_hold(block)
        )
        F = traction_loads(block.points, block.faces["x0"], pressure(PRESSURE))
        static = solve_solid(
            block.points, block.cells, lame, [*sector_symmetry(block, EIGHTH), ends], F
        )
        s = nodal_stresses(block.points, block.cells, static.u[:, 0], lame)
        t = 0.5 * EIGHTH
        middle = node_at(block.points, [0.0, INNER * np.cos(t), INNER * np.sin(t)])
        polar = polar_stresses(s[middle], block.points[middle])
        area = EIGHTH * INNER * width
        return {
            "displacement": float(F @ static.u[:, 0]) / (PRESSURE * area),
            "hoop": float(polar.hoop),
            "radial": float(polar.radial),
        }

    divisions = QUICK_DIVISIONS if run.quick else DIVISIONS
    found: dict[int, list[dict[str, float]]] = {}
    for nodes, counts in divisions.items():
        with run.step(NAMES[nodes]):
            found[nodes] = [solve(nodes, n) for n in counts]
    with run.step("free ends"):
        free = [solve(27, n, free_ends=True) for n in divisions[27]]

    source = "Lame 1852; Timoshenko and Goodier 1970, art 28"
    references = {
        "displacement": float(exact.displacement(bore, plane_strain(E, NU))),
        "hoop": float(exact.hoop(bore)),
        "radial": float(exact.radial(bore)),
    }
    verdicts = []
    for nodes, counts in divisions.items():
        order = 2.0 if nodes in (4, 8) else 4.0
        sizes = 1.0 / np.array(counts)
        series = [f["displacement"] for f in found[nodes]]
        verdicts.append(
            judge(
                f"{NAMES[nodes]}: order of the bore's mean displacement",
                observed_order(sizes[-3:], np.array(series[-3:])),
                order,
                tolerance=0.25 if nodes in (4, 8) else 0.5,
                relative=False,
                source="twice the order of the strains: the mean displacement is an energy",
                reason="one lost order would show as 1 or 2 less; the coarse meshes of a series "
                "are not yet in its asymptotic range, least so of order 4",
                measure="order",
            )
        )
        if order == 2.0:
            continue
        verdicts.append(
            judge(
                f"{NAMES[nodes]}: mean radial displacement of the bore, plane strain",
                1e6 * series[-1],
                1e6 * references["displacement"],
                tolerance=1e-3 if run.quick else 1e-4,
                unit="µm",
                source=source,
                reason="(h/r)^4 of the finest mesh, with h an element at the bore, is "
                f"{(1.0 / counts[-1]) ** 4:.0e}, and its factor may be some units; rounded up "
                "to the next power of ten that a stiffness needs",
                measure="deflection",
                band=1e6 * band_of(sizes, series, order),
            )
        )
        # a linear field through Gauss points at 0.577 misses f'' h^2 / 12 at the surface
        h = (OUTER - INNER) / counts[-1]
        curvature = 6.0 * (references["hoop"] - references["radial"]) / 2.0 / INNER**2
        missed = curvature * h**2 / 12.0
        for quantity, name in (("hoop", "hoop stress"), ("radial", "radial stress")):
            stress = [f[quantity] for f in found[nodes]]
            verdicts.append(
                judge(
                    f"{NAMES[nodes]}: {name} at the bore, plane strain",
                    stress[-1] / 1e6,
                    references[quantity] / 1e6,
                    tolerance=4.0 * missed / 1e6,
                    relative=False,
                    unit="MPa",
                    source=source,
                    reason="four times s'' h^2 / 12, what a linear stress through the Gauss points "
                    f"of a hexahedron misses at its surface ({missed / 1e6:.2g} MPa); tetrahedra "
                    "are less even",
                    measure="stress",
                    band=band_of(sizes, stress) / 1e6,
                )
            )
    series = [f["displacement"] for f in free]
    verdicts.append(
        judge(
            "free ends: mean radial displacement of the bore",
            1e6 * series[-1],
            1e6 * float(exact.displacement(bore, Plane(E, NU))),
            tolerance=1e-3 if run.quick else 1e-4,
            unit="µm",
            source=source,
            reason="as in plane strain: the axial strain is uniform, and no error of its own",
            measure="deflection",
            band=1e6 * band_of(1.0 / np.array(divisions[27]), series, 4.0),
        )
    )

    def errors(nodes: int, quantity: str) -> Any:
        values = np.array([f[quantity] for f in found[nodes]])
        return np.maximum(np.abs(values / references[quantity] - 1.0), 1e-10)

    charts = [
        chart(
            f"Error of the {title} against the elements through the wall",
            [
                trace(NAMES[nodes], counts, errors(nodes, quantity), mode="lines+markers")
                for nodes, counts in divisions.items()
            ],
            "elements through the wall",
            "relative error",
            ("x", "y"),
        )
        for quantity, title in (
            ("displacement", "bore's mean radial displacement"),
            ("hoop", "hoop stress at the bore"),
        )
    ]
    rows: list[list[Cell]] = [
        [
            NAMES[nodes],
            counts[-1],
            1e6 * found[nodes][-1]["displacement"],
            found[nodes][-1]["hoop"] / 1e6,
            found[nodes][-1]["radial"] / 1e6,
        ]
        for nodes, counts in divisions.items()
    ]
    rows.append(
        [
            "Lame",
            None,
            1e6 * references["displacement"],
            references["hoop"] / 1e6,
            references["radial"] / 1e6,
        ]
    )
    best = errors(27, "displacement")[-1]
    return CASE.results(
        run,
        summary=[
            f"The bore opens by {1e6 * references['displacement']:.2f} µm; {divisions[27][-1]} "
            f"hexahedra of 27 nodes through the wall are within {best:.1e} of it, and its hoop "
            f"stress within {errors(27, 'hoop')[-1]:.1e}.",
            "Elements of second order converge with the fourth power of their size, those of first "
            "order with the second.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Convergence",
                items=[
                    *charts,
                    Table(
                        caption="The bore on the finest mesh of each element, plane strain",
                        columns=[
                            "element",
                            "elements through the wall",
                            "displacement [µm]",
                            "hoop stress [MPa]",
                            "radial stress [MPa]",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="An eighth of the ring between planes of symmetry, one element wide. "
                        "Mid-side nodes lie on the true circles. The mean displacement of the bore "
                        "is the work of the pressure over pressure and area."
                    ),
                ],
            )
        ],
        figures={
            "exact": references,
            "divisions": {str(k): v for k, v in divisions.items()},
            "values": {str(k): v for k, v in found.items()},
        },
    )


CASE = Case(
    name="verification/thick_cylinder",
    title="Thick cylinder under internal pressure",
    source="Lame 1852; Timoshenko and Goodier 1970, Theory of Elasticity, art 28",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
