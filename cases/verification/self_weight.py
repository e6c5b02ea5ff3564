"""Sag of an overhung shaft under its own weight, to the order that a beam can tell."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

OUTER = 0.4
RATIO = 6.0
#: Lengths over diameter of the chart.
RATIOS = (1.5, 2.0, 3.0, 4.0)


def run(run: Run) -> Any:
    """Gravity on the solid, its root held by its mean motion."""
    import numpy as np

    from fe_drivetrain.beam import Beam, BeamSection, Support, solve
    from fe_drivetrain.cases.verification import shaft_inputs
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import MATERIALS
    from fe_drivetrain.validation import (
        solid_shafts,
    )
    from fe_drivetrain.validation.shaft_theory import (
        Tube,
        evenly_loaded_shear,
        parabola_shortfall,
    )

    steel = MATERIALS["steel"]
    gravity = -9.80665
    refinements = (1, 2) if run.quick else (1, 2, 3)
    length = RATIO * OUTER
    tube = Tube(OUTER, 0.0, length, steel)
    q = steel.density * tube.area * gravity
    closed = q * length**4 / (8 * tube.EI) + q * length**2 / (2 * tube.kGA)
    even = q * length**4 / (8 * tube.EI) + q * length**2 / (2 * evenly_loaded_shear(tube))
    beam = Beam([BeamSection(length, OUTER)], [Support("root", 0.0, [np.inf] * 6)], material=steel)
    with run.step("frame"):
        frame = solve(beam, length, np.zeros(6), length, (0.0, 0.0, gravity))
    by_frame, frame_turn = float(frame.displacements[2]), float(frame.displacements[4])
    by_mesh, turns, masses = [], [], []
    for refinement in refinements:
        with run.step("mesh and solve"):
            mesh = solid_shafts.solid(
                solid_shafts.straight((0.0, length), OUTER), refinement, size=1.5 * OUTER
            )
            C = solid_shafts.sectional_compliance(mesh, steel, (0.0, length))
        by_mesh.append(gravity * float(C.weight[1, 0]))
        turns.append(gravity * float(C.weight[1, 1]))
        masses.append(float(C.weight_resultant[0]))
    turn = mesh.per_turn
    section = 2 * 2 * parabola_shortfall(turn)
    bands = [solid_shafts.mesh_band(refinements, v) for v in (by_mesh, turns, masses)]
    local = abs(q) * length * solid_shafts.local_compliance(tube)
    arcs = (
        f"{turn} parabolic arcs round a turn: weight over I is wrong by twice the radius's "
        "shortfall, twice that is allowed"
    )
    verdicts = [
        judge(
            "sag of the tip, frame",
            by_frame,
            closed,
            tolerance=1e-10,
            unit="m",
            source="q L^4 / 8EI + q L^2 / 2kGA, k of Cowper 1966",
            reason="the frame's sections are exact: round-off",
            measure="deflection",
        ),
        judge(
            "sag of the tip, solid",
            by_mesh[-1],
            even,
            tolerance=section + local / abs(closed),
            unit="m",
            source="q L^4 / 8EI + q L^2 / 2k'GA, k' of evenly loaded sections (Hutchinson 2001)",
            reason=f"{arcs}; and the root's reaction enters evenly, {solid_shafts.LOCAL:.0%} of "
            "what one diameter shears",
            measure="deflection",
            band=bands[0],
        ),
        judge(
            "rotation of the tip, solid",
            turns[-1],
            -q * length**3 / (6 * tube.EI),
            tolerance=section,
            unit="rad",
            source="q L^3 / 6EI: exact for a root held evenly, by reciprocity with pure bending",
            reason=arcs,
            measure="rotation",
            band=bands[1],
        ),
        judge(
            "rotation of the tip, frame",
            frame_turn,
            -q * length**3 / (6 * tube.EI),
            tolerance=1e-10,
            unit="rad",
            source="q L^3 / 6EI",
            reason="the frame's sections are exact: round-off",
            measure="rotation",
        ),
        judge(
            "mass",
            masses[-1],
            steel.density * tube.area * length,
            tolerance=section,
            unit="kg",
            source="density times volume",
            reason=f"{turn} parabolic arcs round a turn: twice the area's shortfall",
            measure="mass",
            band=bands[2],
        ),
    ]
    rows: list[Any] = [["sag [m]", closed, even, by_frame, by_mesh[-1], bands[0]]]
    rows.append(
        ["rotation [rad]", *[-q * length**3 / (6 * tube.EI)] * 2, frame_turn, turns[-1], bands[1]]
    )
    ratios = RATIOS[:2] if run.quick else RATIOS
    differences, expected = [], []
    for ratio in ratios:
        with run.step("other lengths"):
            short = Tube(OUTER, 0.0, ratio * OUTER, steel)
            mesh = solid_shafts.solid(
                solid_shafts.straight((0.0, short.length), OUTER), 2, size=OUTER
            )
            C = solid_shafts.sectional_compliance(mesh, steel, (0.0, short.length))
        # with the mesh's own mass and I, so that what is left is not the section's error
        load = float(C.weight_resultant[0]) / short.length
        rigidity = steel.youngs_modulus * solid_shafts.meshed_moment(mesh) / short.length / 2
        bend = load * short.length**4 / (8 * rigidity)
        sag = bend + load * short.length**2 / (2 * short.kGA)
        other = bend + load * short.length**2 / (2 * evenly_loaded_shear(short))
        differences.append(100 * (float(C.weight[1, 0]) / sag - 1))
        expected.append(100 * (other / sag - 1))
    traces = [
        trace("solid", ratios, differences, True, marker={"size": 9}),
        trace("beam, evenly held", ratios, expected),
    ]
    return CASE.results(
        run,
        summary=[
            f"An overhang of {RATIO:g} diameters sags {-1e3 * by_mesh[-1]:.4f} mm; by Timoshenko's "
            f"beam {-1e3 * closed:.4f} mm with Cowper's shear coefficient "
            f"({100 * (by_mesh[-1] / closed - 1):+.3f} %), {-1e3 * even:.4f} mm with that of an "
            f"evenly held root ({100 * (by_mesh[-1] / even - 1):+.3f} %).",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Sag",
                items=[
                    shaft_inputs.inputs(
                        ("diameter, solid", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
                        ("overhang", length, "m", "chosen"),
                        ("gravity", gravity, "m/s^2", "standard"),
                        ("density", steel.density, "kg/m^3", "steel, assumed"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                    chart(
                        "Sag of the solid beyond Timoshenko's beam with Cowper's coefficient, of "
                        "the meshed section; the line is the beam with that of an evenly held root",
                        traces,
                        "overhang over diameter",
                        "difference [%]",
                    ),
                    Table(
                        caption="Tip",
                        columns=[
                            "quantity",
                            "beam with shear",
                            "beam, evenly held",
                            "frame",
                            "solid",
                            "band of the solid",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="A shaft that carries its own weight is also stressed across, since "
                        "each slice hangs on its neighbours by shear that is not as even as the "
                        "weight; Poisson's ratio turns that into curvature. An evenly held root "
                        "turns the other way under its shear force, twice as much at the tip. "
                        "Together they are as if the shear coefficient were not Cowper's, "
                        "6 (1 + nu) / (7 + 6 nu), but 6 (1 + nu)^2 / (7 + 12 nu + 4 nu^2)."
                    ),
                ],
            )
        ],
        figures={"over_cowper": by_mesh[-1] / closed - 1, "over_even": by_mesh[-1] / even - 1},
    )


CASE = Case(
    name="verification/self_weight",
    title="Sag of an overhung shaft under its own weight",
    source="Closed form q L^4 / 8EI + q L^2 / 2kGA (Cowper 1966; Hutchinson 2001)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
