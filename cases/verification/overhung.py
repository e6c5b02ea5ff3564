"""An overhung shaft on two supports, as a rotor's: closed forms, the frame, and the solid."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

OUTER, OVERHANG, SPAN = 0.4, 2.145, 2.615


def run(run: Run) -> Any:
    """A force and a moment at the hub."""
    import numpy as np

    from fe_drivetrain.beam import Beam, BeamSection, Support, pinned_reaction, solve
    from fe_drivetrain.cases.verification import shaft_inputs
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import MATERIALS
    from fe_drivetrain.validation import (
        solid_shafts,
    )
    from fe_drivetrain.validation.shaft_theory import (
        Spring,
        Tube,
        evenly_loaded_shear,
        macaulay,
        parabola_shortfall,
    )

    steel = MATERIALS["steel"]
    a, L = OVERHANG, SPAN
    tube = Tube(OUTER, 0.0, a + L, steel)
    EI, kGA = tube.EI, tube.kGA
    stations = [0.0, a, a + L / 2, a + L]
    loads = {"force": (1e6, 0.0), "moment": (0.0, 1e6)}
    # at the hub; a moment about y lifts what lies upwind of it
    closed = {
        "force": (
            1e6 * (a**2 * (a + L) / (3 * EI) + a / kGA + a**2 / (L * kGA)),
            1e6 * (a**2 / (2 * EI) + a * L / (3 * EI) + a / (L * kGA)),
        ),
        "moment": (
            1e6 * (a**2 / (2 * EI) + a * L / (3 * EI) + a / (L * kGA)),
            1e6 * (a / EI + L / (3 * EI) + 1 / (L * kGA)),
        ),
    }
    rigid = np.inf
    beam = Beam(
        [BeamSection(a + L, OUTER)],
        [
            Support("bearing", a, (rigid, rigid, rigid, 0, 0, 0)),
            Support("gearbox", a + L, (0, rigid, rigid, rigid, 0, 0)),
        ],
        material=steel,
    )
    refinements = (1, 2) if run.quick else (1, 2, 3)
    shaft = solid_shafts.straight(stations, OUTER)
    stiffness = np.zeros((len(stations), 2))
    stiffness[[1, 3], 0] = rigid
    solids: dict[str, list[Any]] = {name: [] for name in loads}
    for refinement in refinements:
        with run.step("mesh and solve"):
            mesh = solid_shafts.solid(shaft, refinement, size=2.75 * OUTER)
            C = solid_shafts.sectional_compliance(mesh, steel, stations)
        for name, load in loads.items():
            at = np.zeros((len(stations), 2))
            at[0] = load
            solids[name].append(solid_shafts.on_springs(C, stiffness, at))
    turn = mesh.per_turn
    section = 2 * 4 * parabola_shortfall(turn)
    local = solid_shafts.local_compliance(tube)
    verdicts, traces = [], []
    rows: list[Any] = []
    fine = np.linspace(0.0, a + L, 96)
    supports = [Spring(a, np.inf), Spring(a + L, np.inf)]
    for name, (force, moment) in loads.items():
        hub = np.array([0.0, 0.0, force, 0.0, moment, 0.0])
        with run.step("frame"):
            frame = solve(beam, 0.0, hub, stations)
        bearing, gearbox = (frame.reaction(s) for s in ("bearing", "gearbox"))
        even = macaulay(
            a + L, EI, evenly_loaded_shear(tube), supports, [(0.0, force, -moment)], [0.0]
        )
        # what each support's local yielding would do to the hub
        lever = np.array([a / L, 1 + a / L])
        slack = local * (abs(force) * (force != 0) + lever @ np.abs([gearbox[2], bearing[2]]))
        turn_slack = local * (abs(gearbox[2]) + abs(bearing[2])) / L
        for part, which, sign, extra in (
            ("deflection", 0, 1, slack),
            ("rotation", 1, 1, turn_slack),
        ):
            value = closed[name][which]
            by_frame = sign * float(frame.displacements[0, (2, 4)[which]])
            by_mesh = [sign * float(s.motions[0, which]) for s in solids[name]]
            band = solid_shafts.mesh_band(refinements, by_mesh)
            unit = "m" if which == 0 else "rad"
            expected = float((even.deflection, -even.slope)[which][0])
            rows.append([f"{part} by a {name}", value, by_frame, by_mesh[-1], band])
            verdicts += [
                judge(
                    f"{part} of the hub by a {name}, frame",
                    by_frame,
                    value,
                    tolerance=1e-10,
                    unit=unit,
                    source="closed form with shear",
                    reason="the frame's sections are exact: round-off",
                    measure="deflection" if which == 0 else "rotation",
                ),
                judge(
                    f"{part} of the hub by a {name}, solid",
                    by_mesh[-1],
                    expected,
                    tolerance=float(section + extra / abs(value)),
                    unit=unit,
                    source="Macaulay's brackets with shear of evenly loaded sections (Hutchinson "
                    "2001)",
                    reason=f"{turn} parabolic arcs round a turn; and loads that enter evenly over "
                    f"a section, {solid_shafts.LOCAL:.0%} of what one diameter shears",
                    measure="deflection" if which == 0 else "rotation",
                    band=band,
                ),
            ]
        statics = float(pinned_reaction(force, moment, a, L))
        verdicts += [
            judge(
                f"load on the bearing by a {name}, {who}",
                value,
                statics,
                tolerance=tolerance,
                unit="N",
                source="statics: Stirling 2023, Eq 3.1, (M + (L1 + L2) B) / L2",
                reason="statically determinate: round-off",
                measure="reaction",
                band=band,
            )
            for who, value, tolerance, band in (
                ("frame", float(bearing[2]), 1e-10, None),
                ("solid", -float(solids[name][-1].reactions[1, 0]), 1e-7, 1e-7 * abs(statics)),
            )
        ]
        curve = macaulay(a + L, EI, kGA, supports, [(0.0, force, -moment)], fine).deflection
        traces += [
            trace(f"{name}, beam", fine, 1e3 * curve),
            trace(f"{name}, solid", stations, 1e3 * solids[name][-1].motions[:, 0], True),
        ]
    return CASE.results(
        run,
        summary=[
            "The frame meets the closed forms with shear, and the solid the frame: "
            + ", ".join(f"{r[0]} {100 * (r[3] / r[2] - 1):+.3f} %" for r in rows)
            + ".",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Overhung shaft",
                items=[
                    shaft_inputs.inputs(
                        ("diameter, solid", OUTER, "m", "Stirling 2023, Table 3.1"),
                        ("overhang L1, hub to bearing", a, "m", "Stirling 2023, Table 3.1"),
                        ("span L2, bearing to gearbox", L, "m", "Stirling 2023, Table 3.1"),
                        ("supports", "rigid, free to turn", "", "chosen: determinate"),
                        ("force and moment at the hub", 1, "MN, MN m", "chosen"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                    chart(
                        "Deflection: Macaulay's beam with shear, and the means of the solid's "
                        "sections",
                        traces,
                        "x from the hub [m]",
                        "u_z [mm]",
                    ),
                    Table(
                        caption="Hub [m, rad]",
                        columns=["quantity", "closed form", "frame", "solid", "band of the solid"],
                        rows=rows,
                    ),
                    Text(
                        text="Both cross terms, deflection by a moment and rotation by a force, "
                        "are one number, as Maxwell's theorem demands."
                    ),
                ],
            )
        ],
        figures={r[0]: r[3] / r[2] - 1 for r in rows},
    )


CASE = Case(
    name="verification/overhung",
    title="Overhung shaft on two supports: closed forms, frame and solid",
    source="Closed forms with shear; dimensions of Stirling 2023, Table 3.1",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
