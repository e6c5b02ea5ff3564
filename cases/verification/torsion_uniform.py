"""Torsion of a uniform shaft, solid and bored, against GJ / L."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Outer diameter, bores and length [m].
OUTER, BORES, LENGTH = 0.4, (0.0, 0.28), 0.8
REFINEMENTS = (2, 3, 4)
QUICK_REFINEMENTS = (1, 2, 3)


def run(run: Run) -> Any:
    """Turn the ends by an exact rotation, on three meshes each."""
    import numpy as np

    from fe_drivetrain.cases.verification import shaft_inputs
    from fe_drivetrain.compare import grid_convergence
    from fe_drivetrain.operator import nodal_stresses
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import MATERIALS
    from fe_drivetrain.validation import (
        solid_shafts,
    )
    from fe_drivetrain.validation.shaft_theory import (
        Tube,
        parabola_shortfall,
        parabola_slope,
        recovery_error,
    )

    steel = MATERIALS["steel"]
    refinements = QUICK_REFINEMENTS if run.quick else REFINEMENTS
    angle = 1e-3
    verdicts, traces, errors = [], [], []
    rows: list[Any] = []
    for bore in BORES:
        name = "bored" if bore else "solid"
        tube = Tube(OUTER, bore, LENGTH, steel)
        exact = tube.GJ / LENGTH
        turns, found, stresses = [], [], []
        for refinement in refinements:
            with run.step(f"{name}: mesh and solve"):
                shaft = solid_shafts.straight((0.0, LENGTH), OUTER, bore)
                mesh = solid_shafts.solid(shaft, refinement, size=LENGTH)
                solution, by_torque, by_energy = solid_shafts.twist(mesh, steel, angle)
            meshed = steel.shear_modulus * solid_shafts.meshed_moment(mesh) / LENGTH**2
            with run.step(f"{name}: stress"):
                s = nodal_stresses(mesh.points, mesh.cells, solution.u[:, 0], steel.lame)
            middle = mesh.section_nodes(LENGTH / 2)
            r = np.hypot(mesh.points[middle, 1], mesh.points[middle, 2])
            skin = middle[r > 0.5 * OUTER * (1 - 1e-9)]
            stresses.append(float(np.hypot(s[skin, 3], s[skin, 5]).mean()))
            turns.append(mesh.per_turn)
            found.append(by_torque)
            rows.append([name, mesh.per_turn, mesh.n_unknowns, by_torque, meshed, exact])
        series = grid_convergence(1.0 / np.array(turns), found, expected_order=4.0)
        error = np.abs(np.array(found) / exact - 1.0)
        errors.append(error[-1])
        turn = turns[-1]
        shortfall = 4 * parabola_shortfall(turn)
        verdicts += [
            judge(
                f"{name}: torsional stiffness",
                found[-1],
                exact,
                tolerance=2 * shortfall,
                unit="N m/rad",
                source="closed form G J / L",
                reason=f"{turn} parabolic arcs round a turn fall short of the circle: J is "
                f"{shortfall:.2g} too low by their formula; twice that is allowed",
                measure="stiffness",
                band=series.uncertainty,
            ),
            judge(
                f"{name}: torsional stiffness of the meshed section",
                found[-1],
                meshed,
                tolerance=parabola_slope(turn) ** 2,
                unit="N m/rad",
                source="G / L^2 times the integral of y^2 + z^2 over the mesh",
                reason="the exact displacement is one of the element's; the meshed surface leans "
                f"against the circle by at most {parabola_slope(turn):.2g} rad, and what that "
                "warps is of second order",
                measure="stiffness",
                band=abs(found[-1] - by_energy) + 1e-9 * meshed,
            ),
            judge(
                f"{name}: torque over angle against twice the energy over its square",
                by_torque / by_energy - 1.0,
                0.0,
                tolerance=1e-8,
                relative=False,
                source="exact: work done equals energy stored",
                reason="round-off of the solver",
                measure="identity",
            ),
            judge(
                f"{name}: order of convergence of the stiffness",
                float(np.log(error[-2] / error[-1]) / np.log(turns[-1] / turns[-2])),
                4.0,
                tolerance=0.2,
                relative=False,
                source="the shortfall of parabolic arcs is of fourth order",
                reason="the next term of the shortfall's series is a few per cent of the first",
                measure="order",
            ),
            judge(
                f"{name}: shear stress on the surface at mid length, mean round the turn",
                stresses[-1],
                steel.shear_modulus * angle * OUTER / 2 / LENGTH,
                tolerance=recovery_error(turn),
                unit="Pa",
                source="G theta R / L",
                reason="stress is recovered linearly in each element: h^2 / 12 for the arc h of an "
                "element, and as much for the radius",
                measure="stress",
                band=abs(stresses[-1] - stresses[-2]),
            ),
        ]
        traces += [
            trace(f"{name}, finite elements", turns, error, True, marker={"size": 9}),
        ]
    many = range(4, 33)
    traces.append(
        trace("shortfall of parabolic arcs", many, [4 * parabola_shortfall(n) for n in many])
    )
    return CASE.results(
        run,
        summary=[
            f"G J / L is met to {max(errors):.1g} (relative) with {turns[-1]} elements of 27 nodes "
            "round a turn, solid and bored; what is left is that they describe the circle by "
            "parabolas, and follows the formula for that.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Torsional stiffness",
                items=[
                    shaft_inputs.inputs(
                        ("outer diameter", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
                        ("bore of the bored shaft", BORES[-1], "m", "chosen"),
                        ("length", LENGTH, "m", "chosen: the answer does not depend on it"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                    chart(
                        "Relative error of the stiffness; the line is no fit, but four times the "
                        "mean shortfall of the radius of as many parabolic arcs",
                        traces,
                        "elements round a turn",
                        "relative error",
                        ("x", "y"),
                    ),
                    Table(
                        caption="Stiffness between ends that turn as rigid planes",
                        columns=[
                            "shaft",
                            "elements round a turn",
                            "unknowns",
                            "finite elements [N m/rad]",
                            "G J / L of the mesh [N m/rad]",
                            "G J / L [N m/rad]",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="A rotation that grows along the axis is a product of x with y and z. "
                        "Elements that are drawn out along x hold it exactly, however curved their "
                        "section, so the only error left is the section's."
                    ),
                ],
            )
        ],
        figures={"relative_error": max(errors)},
    )


CASE = Case(
    name="verification/torsion_uniform",
    title="Torsion of a uniform shaft, solid and bored",
    source="Closed form G J / L (Saint-Venant; Timoshenko and Goodier, Theory of Elasticity)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
