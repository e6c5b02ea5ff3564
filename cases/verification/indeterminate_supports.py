"""Two and three supports, rigid or on springs: the frame, Macaulay's beam, and the solid."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

OUTER = 0.4
#: Hub, main bearing, second bearing, gearbox [m] from the hub.
STATIONS = (0.0, 1.2, 2.8, 4.8)
#: Radial stiffness of the bearings and of the gearbox [N/m], tilt of the main bearing [N m/rad].
RADIAL, GEARBOX, TILT = 2e9, 8e7, 145e6


def run(run: Run) -> Any:
    """Several sets of supports under a hub force and a hub moment."""
    import numpy as np

    from fe_drivetrain.beam import Beam, BeamSection, Support, solve, torsional_spring_reaction
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
    length = STATIONS[-1]
    tube = Tube(OUTER, 0.0, length, steel)
    rigid = float("inf")
    # (force, moment) stiffness at the main bearing, the second one and the gearbox
    sets = {
        "bearing with tilt, gearbox": ((RADIAL, TILT), (0.0, 0.0), (GEARBOX, 0.0)),
        "clamped in the bearing, gearbox": ((rigid, rigid), (0.0, 0.0), (rigid, 0.0)),
        "three rigid supports": ((rigid, 0.0), (rigid, 0.0), (rigid, 0.0)),
        "two bearings, soft gearbox": ((RADIAL, 0.0), (RADIAL, 0.0), (GEARBOX, 0.0)),
        "two bearings with tilt, gearbox": ((RADIAL, TILT), (RADIAL, TILT), (GEARBOX, 0.0)),
    }
    load = {"force": (1e6, 0.0), "moment": (0.0, 1e6)}
    names = ("main bearing", "second bearing", "gearbox")

    even = evenly_loaded_shear(tube)
    local = solid_shafts.local_compliance(tube)
    # a moment that enters inside the shaft bends it anticlastically on one side only
    turning = solid_shafts.LOCAL * OUTER / tube.EI

    def by_macaulay(
        springs: Any, force: float, moment: float, kGA: float = tube.kGA, softer: bool = False
    ) -> Any:
        """Forces and moments (6,) that the shaft puts on the supports, and the hub's motion (2,).

        The slope is minus the rotation about y.
        """
        supports = [
            Spring(x, _softened(k, softer * local), _softened(m, softer * turning))
            for x, (k, m) in zip(STATIONS[1:], springs, strict=True)
        ]
        found = macaulay(length, tube.EI, kGA, supports, [(0.0, force, -moment)], [0.0])
        loads = np.column_stack([-found.forces, found.moments]).ravel()
        return loads, np.array([found.deflection[0], -found.slope[0]])

    def by_frame(springs: Any, force: float, moment: float, shear: bool = True) -> Any:
        supports = []
        for name, x, (k, m) in zip(names, STATIONS[1:], springs, strict=True):
            # the gearbox also locates the shaft and takes the torque
            along = rigid if name == "gearbox" else 0.0
            if k > 0:
                supports.append(Support(name, x, (along, k, k, along, m, m)))
        beam = Beam([BeamSection(length, OUTER)], supports, material=steel, shear=shear)
        found = solve(beam, 0.0, np.array([0, 0, force, 0, moment, 0]), 0.0)
        loads = np.zeros((3, 2))
        for i, name in enumerate(names):
            if any(s.name == name for s in supports):
                loads[i] = found.reaction(name)[[2, 4]]
        return loads.ravel()

    refinements = (1, 2) if run.quick else (2, 3)
    shaft = solid_shafts.straight(STATIONS, OUTER)
    compliances = []
    for refinement in refinements:
        with run.step("mesh and solve"):
            mesh = solid_shafts.solid(shaft, refinement, size=3 * OUTER)
            compliances.append(solid_shafts.sectional_compliance(mesh, steel, STATIONS))

    def by_solid(C: Any, springs: Any, force: float, moment: float) -> Any:
        loads = np.zeros((4, 2))
        loads[0] = force, moment
        found = solid_shafts.on_springs(C, [(0.0, 0.0), *springs], loads)
        return -found.reactions[1:].ravel(), found.motions[0]

    turn = mesh.per_turn
    section = 2 * 4 * parabola_shortfall(turn)
    verdicts = []
    rows: list[Any] = []
    for label, springs in sets.items():
        for kind, (force, moment) in load.items():
            size = 1e6
            framed = by_frame(springs, force, moment)
            same, _ = by_macaulay(springs, force, moment)
            exact, hub = by_macaulay(springs, force, moment, even)
            meshed = [by_solid(C, springs, force, moment) for C in compliances]
            softer, softer_hub = by_macaulay(springs, force, moment, even, True)
            bands = [
                3 * np.abs(m - f) / ((refinements[1] / refinements[0]) ** 4 - 1)
                for m, f in zip(*meshed, strict=True)
            ]
            worst = int(np.abs(exact[::2]).argmax()) * 2
            if abs(exact[worst]) < 1.0:  # a clamp takes a moment, and no force
                worst = 1
            where = names[worst // 2]
            slack = abs(softer[worst] - exact[worst])
            hub_at = 0 if kind == "force" else 1
            hub_slack = abs(softer_hub[hub_at] / hub[hub_at] - 1) + local * (
                force / abs(hub[0]) if kind == "force" else 0.0
            )
            rows.append([label, kind, where, exact[worst], framed[worst], meshed[-1][0][worst]])
            verdicts += [
                judge(
                    f"{label}, {kind}: largest difference of a reaction, frame",
                    float(np.abs(framed - same).max()) / size,
                    0.0,
                    tolerance=1e-8,
                    relative=False,
                    source="Macaulay's brackets with shear, solved for the reactions",
                    reason="two exact solutions of one beam: round-off; over the hub load",
                    measure="identity",
                ),
                judge(
                    f"{label}, {kind}: load on the {where}, solid",
                    meshed[-1][0][worst],
                    exact[worst],
                    tolerance=section + slack / abs(exact[worst]),
                    unit="N m" if worst % 2 else "N",
                    source="Macaulay's brackets with shear of evenly loaded sections "
                    "(Hutchinson 2001)",
                    reason=f"{turn} parabolic arcs round a turn; and what supports would change "
                    f"that are softer by {solid_shafts.LOCAL:.0%} of what one diameter shears, or "
                    "bends",
                    measure="reaction",
                    band=float(bands[0][worst]),
                ),
                judge(
                    f"{label}, {kind}: "
                    f"{'deflection' if kind == 'force' else 'rotation'} of the hub, solid",
                    float(meshed[-1][1][hub_at]),
                    float(hub[hub_at]),
                    tolerance=section + hub_slack,
                    unit="m" if kind == "force" else "rad",
                    source="Macaulay's brackets with shear of evenly loaded sections "
                    "(Hutchinson 2001)",
                    reason="as for the load",
                    measure="deflection" if kind == "force" else "rotation",
                    band=float(bands[1][hub_at]),
                ),
            ]
    # Eq 3.18 and 3.19 of the thesis are this beam without shear, on a radially rigid bearing
    thesis = ((rigid, TILT), (0.0, 0.0), (GEARBOX, 0.0))
    R, M = torsional_spring_reaction(
        1e6, 1e6, STATIONS[1], length - STATIONS[1], tube.EI, GEARBOX, TILT
    )
    plain = by_frame(thesis, 1e6, 1e6, shear=False)
    verdicts += [
        judge(
            f"{what} on the bearing with tilt, frame without shear",
            value,
            float(expected),
            tolerance=1e-9,
            unit=unit,
            source="Stirling 2023, Eq 3.18-3.19",
            reason="the same beam: round-off",
            measure="reaction",
        )
        for what, value, expected, unit in (
            ("force", plain[0], R, "N"),
            ("moment", plain[1], M, "N m"),
        )
    ]
    stiff = np.logspace(6, 11, 41)
    shown = stiff[::8]

    def second(k: float) -> Any:
        return ((RADIAL, 0.0), (k, 0.0), (GEARBOX, 0.0))

    traces = []
    for i, name in enumerate(names):
        exact_line = [by_macaulay(second(k), 1e6, 0.0)[0][2 * i] / 1e6 for k in stiff]
        points = [by_solid(compliances[-1], second(k), 1e6, 0.0)[0][2 * i] / 1e6 for k in shown]
        traces += [trace(name, stiff, exact_line), trace(f"{name}, solid", shown, points, True)]
    largest = max(abs(r[5] / r[3] - 1) for r in rows)
    return CASE.results(
        run,
        summary=[
            "On five sets of supports the frame and Macaulay's beam agree to round-off, and the "
            f"solid's largest reactions differ from them by at most {100 * largest:.2f} %.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Indeterminate supports",
                items=[
                    shaft_inputs.inputs(
                        ("diameter, solid", OUTER, "m", "Stirling 2023, Table 3.1"),
                        ("main bearing from the hub", STATIONS[1], "m", "chosen"),
                        ("second bearing from the hub", STATIONS[2], "m", "chosen"),
                        ("gearbox from the hub", STATIONS[3], "m", "Table 3.1, nearly (4.76 m)"),
                        ("radial stiffness of a bearing", RADIAL / 1e9, "GN/m", "chosen"),
                        ("radial stiffness of the gearbox", GEARBOX / 1e6, "MN/m", "Table 3.1"),
                        ("tilt stiffness of a bearing", TILT / 1e6, "MN m/rad", "section 3.3.1"),
                        ("force and moment at the hub", 1, "MN, MN m", "chosen"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                    chart(
                        "Loads on three supports under a hub force of 1 MN, as the second bearing "
                        "is made stiffer: Macaulay's beam, and the solid by its compliance",
                        traces,
                        "radial stiffness of the second bearing [N/m]",
                        "load [MN]",
                        ("x",),
                    ),
                    Table(
                        caption="Largest load on a support [N]",
                        columns=["supports", "hub", "support", "Macaulay", "frame", "solid"],
                        rows=rows,
                    ),
                    Text(
                        text="The solid is solved once, for unit loads on its sections; springs "
                        "are added to its compliance afterwards, so that any stiffness, rigid "
                        "ones too, costs nothing more."
                    ),
                ],
            )
        ],
        figures={"largest_difference": largest},
    )


def _softened(stiffness: float, compliance: float) -> float:
    return 1.0 / (1.0 / stiffness + compliance) if stiffness > 0 and compliance > 0 else stiffness


CASE = Case(
    name="verification/indeterminate_supports",
    title="Two and three supports on springs: frame, Macaulay's beam and solid",
    source="Macaulay's brackets with shear; Stirling 2023, Eq 3.18-3.19",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
