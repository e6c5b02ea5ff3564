"""A shaft on two simple supports: closed forms, the frame, and the solid."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

OUTER, LENGTH = 0.4, 2.4


def run(run: Run) -> Any:
    """A force at mid span, a moment at an end, and the shaft's weight."""
    import numpy as np

    from fe_drivetrain.beam import Beam, BeamSection, Support, solve
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
    tube = Tube(OUTER, 0.0, LENGTH, steel)
    L, EI, kGA = LENGTH, tube.EI, tube.kGA
    force, moment, gravity = 1e6, 1e6, -9.80665
    weight = steel.density * tube.area * gravity
    stations = [0.0, L / 4, L / 2, 3 * L / 4, L]
    middle = 2

    rigid = np.inf
    beam = Beam(
        [BeamSection(L, OUTER)],
        [
            Support("upwind", 0.0, (rigid, rigid, rigid, rigid, 0, 0)),
            Support("downwind", L, (0, rigid, rigid, 0, 0, 0)),
        ],
        material=steel,
    )
    at_middle, at_end = np.zeros((2, 6)), np.zeros((2, 6))
    at_middle[0, 2], at_end[1, 4] = force, moment
    with run.step("frame"):
        frames = {
            "force at mid span": solve(beam, [L / 2, L], at_middle, stations),
            "moment at the end": solve(beam, [L / 2, L], at_end, stations),
            "own weight": solve(beam, [L / 2, L], np.zeros((2, 6)), stations, (0.0, 0.0, gravity)),
        }
    # of the deflection at mid span
    closed = {
        "force at mid span": force * (L**3 / (48 * EI) + L / (4 * kGA)),
        "moment at the end": moment * L**2 / (16 * EI),
        "own weight": weight * (5 * L**4 / (384 * EI) + L**2 / (8 * kGA)),
    }
    refinements = (1, 2) if run.quick else (1, 2, 3)
    shaft = solid_shafts.straight(stations, OUTER)
    stiffness = np.zeros((len(stations), 2))
    stiffness[[0, -1], 0] = rigid
    solids: dict[str, list[Any]] = {name: [] for name in closed}
    for refinement in refinements:
        with run.step("mesh and solve"):
            mesh = solid_shafts.solid(shaft, refinement)
            C = solid_shafts.sectional_compliance(mesh, steel, stations)
        loads = np.zeros((len(stations), 2))
        loads[middle, 0] = force
        solids["force at mid span"].append(solid_shafts.on_springs(C, stiffness, loads))
        loads = np.zeros((len(stations), 2))
        loads[-1, 1] = moment
        solids["moment at the end"].append(solid_shafts.on_springs(C, stiffness, loads))
        solids["own weight"].append(
            solid_shafts.on_springs(C, stiffness, np.zeros((len(stations), 2)), gravity)
        )
    turn = mesh.per_turn
    section = 2 * 4 * parabola_shortfall(turn)
    local = solid_shafts.local_compliance(tube)
    # of the force and of its two reactions; a moment's reactions move both ends alike, and the
    # weight's are half of it each
    slack = {
        "force at mid span": force * local * 1.5,
        "moment at the end": moment / L * local,
        "own weight": abs(weight) * L / 2 * local,
    }
    ends = [Spring(0.0, np.inf), Spring(L, np.inf)]
    cases = {
        "force at mid span": ([(L / 2, force, 0.0)], 0.0),
        "moment at the end": ([(L, 0.0, -moment)], 0.0),
        "own weight": ([], weight),
    }
    even = {
        name: float(
            macaulay(L, EI, evenly_loaded_shear(tube), ends, *_at(case, L / 2)).deflection[0]
        )
        for name, case in cases.items()
    }
    verdicts = []
    rows: list[Any] = []
    for name, value in closed.items():
        frame = frames[name]
        by_frame = float(frame.displacements[middle, 2])
        by_mesh = [float(s.motions[middle, 0]) for s in solids[name]]
        band = solid_shafts.mesh_band(refinements, by_mesh)
        rows.append([name, value, by_frame, even[name], by_mesh[-1], band])
        verdicts += [
            judge(
                f"{name}: deflection at mid span, frame",
                by_frame,
                value,
                tolerance=1e-10,
                unit="m",
                source="closed form with shear",
                reason="the frame's sections are exact: round-off",
                measure="deflection",
            ),
            judge(
                f"{name}: deflection at mid span, solid",
                by_mesh[-1],
                even[name],
                tolerance=section + slack[name] / abs(value),
                unit="m",
                source="Macaulay's brackets with shear of evenly loaded sections (Hutchinson 2001)",
                reason=f"{turn} parabolic arcs round a turn; and loads that enter evenly over a "
                f"section, {solid_shafts.LOCAL:.0%} of what one diameter shears",
                measure="deflection",
                band=band,
            ),
            judge(
                f"{name}: reaction of the downwind support, solid",
                float(solids[name][-1].reactions[-1, 0]),
                -float(frame.reaction("downwind")[2]),
                tolerance=section if name == "own weight" else 1e-7,
                unit="N",
                source="Timoshenko frame of the library",
                reason="statically determinate: the meshed section's weight"
                if name == "own weight"
                else "statically determinate: round-off of the solver",
                measure="reaction",
                band=section * abs(weight) * L / 2
                if name == "own weight"
                else 1e-7 * abs(float(frame.reaction("downwind")[2])),
            ),
        ]
    fine = np.linspace(0.0, L, 81)
    traces = []
    for name, case in cases.items():
        curve = macaulay(L, EI, kGA, ends, *_at(case, fine)).deflection
        size = np.abs(curve).max()
        traces += [
            trace(f"{name}, beam", fine, curve / size),
            trace(f"{name}, solid", stations, solids[name][-1].motions[:, 0] / size, True),
        ]
    return CASE.results(
        run,
        summary=[
            "The frame meets the closed forms with shear to round-off. The solid, held and loaded "
            "through the mean motions of its sections, differs from it by "
            + ", ".join(f"{100 * (r[4] / r[2] - 1):+.3f} % ({r[0]})" for r in rows)
            + f" at L = {L / OUTER:g} D.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Simple supports",
                items=[
                    shaft_inputs.inputs(
                        ("diameter, solid", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
                        ("span", LENGTH, "m", "chosen"),
                        ("force at mid span", force / 1e6, "MN", "chosen"),
                        ("moment at the downwind end", moment / 1e6, "MN m", "chosen"),
                        ("gravity", gravity, "m/s^2", "standard"),
                        ("density", steel.density, "kg/m^3", "steel, assumed"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                    chart(
                        "Deflection over its largest: Macaulay's beam with shear, and the means of "
                        "the solid's sections",
                        traces,
                        "x [m]",
                        "deflection over the largest",
                    ),
                    Table(
                        caption="Deflection at mid span [m]",
                        columns=[
                            "load",
                            "closed form",
                            "frame",
                            "beam, evenly loaded",
                            "solid",
                            "band of the solid",
                        ],
                        rows=rows,
                    ),
                    Text(
                        text="The solid's sections keep their freedom to warp: supports and loads "
                        "act on their mean displacement, evenly. The shear "
                        "coefficient for that is not Cowper's, 6 (1 + nu) / (7 + 6 nu), but 6 (1 + "
                        "nu)^2 / (7 + 12 nu + 4 nu^2): 4 % less shear deflection. A support on the "
                        "skin, as of a bearing, "
                        "adds the local yielding of the skin, which no beam has."
                    ),
                ],
            )
        ],
        figures={r[0]: r[4] / r[2] - 1 for r in rows},
    )


def _at(case: Any, x: Any) -> Any:
    """Arguments of `macaulay`: loads, stations, load per length."""
    loads, per_length = case
    return loads, x, per_length


CASE = Case(
    name="verification/simply_supported",
    title="Shaft on two simple supports: closed forms, frame and solid",
    source="Closed forms with shear: F L^3 / 48EI + F L / 4kGA, M L^2 / 16EI, "
    "5 q L^4 / 384EI + q L^2 / 8kGA",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
