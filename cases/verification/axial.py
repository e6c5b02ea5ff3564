"""Tension of a uniform shaft against EA / L, and what held ends add."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

OUTER, BORES = 0.4, (0.0, 0.28)
#: Lengths over the outer diameter: free ends, held ends in three dimensions, held ends.
FREE, HELD = 2.0, 1.0
RATIOS = (0.5, 1.0, 2.0, 4.0, 8.0)
QUICK_RATIOS = (1.0, 4.0, 8.0)


def run(run: Run) -> Any:
    """Uniform traction on the ends, then ends that are held flat and round."""
    import numpy as np

    from fe_drivetrain.cases.verification import shaft_inputs
    from fe_drivetrain.compare import grid_convergence
    from fe_drivetrain.mesh import Grading, face_weights
    from fe_drivetrain.operator import nodal_stresses, traction_loads
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.revolution import end_stiffness
    from fe_drivetrain.scene import MATERIALS
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation import (
        solid_shafts,
    )
    from fe_drivetrain.validation.shaft_theory import (
        Tube,
        parabola_shortfall,
    )

    steel = MATERIALS["steel"]
    E, nu = steel.youngs_modulus, steel.poisson_ratio
    sigma = 1e8
    refinements = (1, 2, 3) if run.quick else (2, 3, 4)
    length = FREE * OUTER
    ratios = QUICK_RATIOS if run.quick else RATIOS
    verdicts, traces = [], []
    rows: list[Any] = []
    for bore in BORES:
        name = "bored" if bore else "solid"
        tube = Tube(OUTER, bore, length, steel)
        found = []
        for refinement in refinements:
            with run.step(f"{name}: mesh and solve"):
                mesh = solid_shafts.solid(
                    solid_shafts.straight((0.0, length), OUTER, bore), refinement, size=length
                )
                x, y, z = mesh.points.T
                exact = sigma / E * np.column_stack([x, -nu * y, -nu * z])
                ends = [mesh.section_facets(end) for end in (mesh.front, mesh.rear)]
                pull = np.array([sigma, 0.0, 0.0])
                F: Any = sum(
                    sign * traction_loads(mesh.points, facets, pull)
                    for sign, facets in zip((-1, 1), ends, strict=True)
                )
                solution = solve_solid(
                    mesh.points,
                    mesh.cells,
                    steel.lame,
                    [],
                    F,
                    solid_shafts.pinned_like(mesh, exact),
                )
            u = solution.u[:, 0].reshape(-1, 3)
            area = float(face_weights(mesh.points, ends[1], len(mesh.points)).sum())
            weights = face_weights(mesh.points, ends[1], len(mesh.points)) / area
            stretch = float(weights @ u[:, 0])
            found.append(sigma * area / stretch)
        s = nodal_stresses(mesh.points, mesh.cells, solution.u[:, 0], steel.lame)
        turn = mesh.per_turn
        series = grid_convergence(1.0 / np.array(refinements), found, expected_order=4.0)
        shortfall = 2 * parabola_shortfall(turn)
        size = float(np.abs(exact).max())
        verdicts += [
            judge(
                f"{name}: axial stiffness",
                found[-1],
                tube.EA / length,
                tolerance=2 * shortfall,
                unit="N/m",
                source="closed form E A / L",
                reason=f"{turn} parabolic arcs round a turn: the area is {shortfall:.2g} too "
                "small by their formula; twice that is allowed",
                measure="stiffness",
                band=series.uncertainty,
            ),
            judge(
                f"{name}: largest difference from the exact displacements, over the largest",
                float(np.abs(u - exact).max()) / size,
                0.0,
                tolerance=1e-8,
                relative=False,
                source="u = sigma / E (x, -nu y, -nu z)",
                reason="the exact displacements are linear, and so the elements': round-off of "
                "the solver",
                measure="identity",
            ),
            judge(
                f"{name}: largest difference from the uniform stress, over it",
                float(np.abs(s - sigma * np.array([1, 0, 0, 0, 0, 0])).max()) / sigma,
                0.0,
                tolerance=1e-7,
                relative=False,
                source="sigma_x = F / A and nothing else",
                reason="as for the displacements, one derivative on",
                measure="identity",
            ),
        ]
        with run.step(f"{name}: ends held flat and round, meridian"):
            stiffer = []
            for ratio in ratios:
                shaft = solid_shafts.straight((0.0, ratio * OUTER), OUTER, bore)
                k = end_stiffness(shaft, steel)[6, 6]
                stiffer.append(float(k * ratio * OUTER / tube.EA - 1))
        by_mesh = []
        for refinement in (1, 2):
            with run.step(f"{name}: ends held flat and round, mesh and solve"):
                shaft = solid_shafts.straight((0.0, HELD * OUTER), OUTER, bore)
                held = solid_shafts.solid(
                    shaft, refinement, Grading(ends=1 if run.quick else 2), size=OUTER
                )
                field = np.zeros_like(held.points)
                rear = held.section_nodes(held.rear)
                field[rear, 0] = 1e-4
                nodes = np.concatenate([held.section_nodes(held.front), rear])
                pulled = solve_solid(
                    held.points,
                    held.cells,
                    steel.lame,
                    [],
                    np.zeros(held.n_unknowns),
                    solid_shafts.prescribed_on(held, nodes, field),
                )
                k = 2 * float(pulled.energy[0]) / 1e-8
                across = face_weights(held.points, held.section_facets(0.0), len(held.points)).sum()
                # of the meshed area: what is left is the ends' doing
                by_mesh.append(float(k * HELD * OUTER / (E * across)))
        # the coarsest elements are half a diameter long, the layers at the ends 0.3 of that each
        edge = 2 * 0.5 / 2 * 0.3 ** (1 if run.quick else 2)
        traces += [
            trace(f"{name}, meridian", ratios, 100 * np.array(stiffer)),
            trace(
                f"{name}, hexahedra",
                [HELD],
                [100 * (by_mesh[-1] - 1)],
                True,
                marker={"size": 9},
            ),
        ]
        # a shaft of length L - e: k = E A / (L - e)
        shorter = [ratio * e / (1 + e) for ratio, e in zip(ratios, stiffer, strict=True)]
        rows += [
            [name, ratio, 100 * e, d] for ratio, e, d in zip(ratios, stiffer, shorter, strict=True)
        ]
        verdicts += [
            judge(
                f"{name}: stiffness over E A / L between held ends, L = {HELD:g} D",
                by_mesh[-1],
                1 + stiffer[ratios.index(HELD)],
                tolerance=0.1 * edge**1.4,
                source="Fourier harmonics in the meridian (fe_drivetrain.revolution.harmonics)",
                reason="stress is singular along held edges, of exponent 0.71 in steel; elements "
                f"there are {edge:.2g} radii long, what they miss goes as that to the power 1.4, "
                "and a tenth of the energy is at the ends at most",
                measure="stiffness",
                band=solid_shafts.mesh_band((1, 2), by_mesh, 1.4),
            ),
            judge(
                f"{name}: length that held ends take off, L = {RATIOS[-1]:g} D against "
                f"{RATIOS[-2]:g} D",
                shorter[-1],
                shorter[-2],
                tolerance=1e-3,
                relative=False,
                unit="diameters",
                source="Saint-Venant's principle: the ends' disturbance dies out within a few "
                "diameters, and is then the same whatever the length",
                reason="the slowest even self-balanced disturbance of a round bar fades by "
                "exp(-2.7 x / R) (Little and Childs 1967; recalled, not re-read): 2e-5 over two "
                "diameters; and the meridian's own error at held edges",
                measure="deflection",
            ),
        ]
    return CASE.results(
        run,
        summary=[
            f"E A / L is met to {abs(verdicts[0].computed / verdicts[0].reference - 1):.1g}, and "
            "the exact linear displacements to round-off. Ends that are held flat and round take "
            f"{rows[len(ratios) - 1][3]:.3f} diameters off a solid shaft's length, "
            f"{rows[-1][3]:.3f} off a bored one's.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Tension",
                items=[
                    shaft_inputs.inputs(
                        ("outer diameter", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
                        ("bore of the bored shaft", BORES[-1], "m", "chosen"),
                        ("length of the free-ended shaft", length, "m", "chosen"),
                        ("tension on the ends", sigma / 1e6, "MPa", "chosen"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                    chart(
                        "What ends that can neither contract nor warp add to E A / L",
                        traces,
                        "length over diameter",
                        "stiffer by [%]",
                        ("x", "y"),
                    ),
                    Table(
                        caption="Ends held flat and round, against E A / L, by Fourier harmonics",
                        columns=[
                            "shaft",
                            "length over diameter",
                            "stiffer by [%]",
                            "length taken off, over diameter",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="Traction leaves the ends free to contract, and the stress is uniform "
                        "to the ends. A rigid flange does not: the shaft is stiffer, as if shorter "
                        "by a fixed part of its diameter."
                    ),
                ],
            )
        ],
        figures={"held_ends_diameters_solid": rows[len(ratios) - 1][3]},
    )


CASE = Case(
    name="verification/axial",
    title="Tension of a uniform shaft, and what held ends add",
    source="Closed form E A / L with uniform stress",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
