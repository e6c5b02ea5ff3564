"""Overhung shaft on two supports, as of a rotor: closed forms, frame and solid."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.shaft_theory import Tube
from fe_drivetrain.cases.references.solid_shafts import local_compliance, straight
from fe_drivetrain.cases.references.supported_shafts import (
    EVENLY,
    Load,
    SupportedShaft,
    within_evenly,
)
from fe_drivetrain.cases.verification import shaft_inputs as inputs
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.report.number_text import certain_value, percent_text
from fe_drivetrain.report.suite import Page, Record, Run, Target
from fe_drivetrain.shafts.beam import pinned_reaction

STEEL = MATERIALS["steel"]
OUTER, L1, L2 = 0.4, 2.145, 2.615  # m: diameter, hub to bearing, bearing to gearbox
LENGTH = L1 + L2
TUBE = Tube(OUTER, 0.0, LENGTH, STEEL)
STATIONS = (0.0, L1, L1 + L2 / 2, LENGTH)
PINNED, FREE = (np.inf, 0.0), (0.0, 0.0)
SHAFT = SupportedShaft(TUBE, STATIONS, (FREE, PINNED, FREE, PINNED))
HUB, BEARING, GEARBOX = 0, 1, 3
LOADS = {"force": Load(HUB, force=1e6), "moment": Load(HUB, moment=1e6)}
BENT = "Deflection: Macaulay's beam with shear, and the means of the solid's sections"
SHEARED = "closed form with shear"
STATICS = "statics: Stirling 2023, Eq 3.1, (M + (L1 + L2) B) / L2"
EI, KGA = TUBE.EI, TUBE.kGA
CROSS = 1e6 * (L1**2 / (2 * EI) + L1 * L2 / (3 * EI) + L1 / (L2 * KGA))
#: Deflection [m] and rotation [rad] of the hub; a moment about y lifts what is upwind of it.
CLOSED = {
    "force": (1e6 * (L1**2 * (L1 + L2) / (3 * EI) + L1 / KGA + L1**2 / (L2 * KGA)), CROSS),
    "moment": (CROSS, 1e6 * (L1 / EI + L2 / (3 * EI) + 1 / (L2 * KGA))),
}


def answer(page: Page, rows: list[Record]) -> None:
    """State how far the hub moves, and how far solid and beam are from each other."""
    sag = page.judged(
        "deflection of the hub by a force, solid",
        "deflection of the hub under 1 MN, solid",
        "beam with shear",
        unit="mm",
    )
    largest = max(abs(row["solid"] / row["frame"] - 1) for row in rows)
    page.answer(
        "How far does the hub of an overhung main shaft move under its loads?",
        f"A force of 1\u00a0MN moves the hub by {certain_value(sag)}; solid mesh and beam with "
        f"shear differ by at most {percent_text(largest)} in all hub motions.",
        [
            sag,
            page.judged(
                "rotation of the hub by a moment, solid",
                "rotation of the hub under 1 MN m, solid",
                "beam with shear",
                unit="mrad",
            ),
            page.judged(
                "load on the bearing by a force, solid",
                "load on the bearing under 1 MN, solid",
                "statics",
                unit="MN",
            ),
            page.judged(
                "deflection of the hub by a force, frame",
                "deflection of the hub under 1 MN, frame",
                "closed form",
                unit="mm",
            ),
        ],
        hero=BENT,
    )


@case(
    "Overhung shaft on two supports: closed forms, frame and solid",
    source="Closed forms with shear; dimensions of Stirling 2023, Table 3.1",
)
def run(run: Run, page: Page) -> None:
    """A force and a moment at the hub."""
    refinements = (1, 2) if run.quick else (1, 2, 3)
    meshes = [run.timed("mesh and solve", SHAFT.compliance, r, 2.75 * OUTER) for r in refinements]
    section, evenly = within_evenly(meshes[-1][0])
    rows: list[Record] = []
    traces = []
    fine = np.linspace(0.0, LENGTH, 96)
    for name, load in LOADS.items():
        frame = SHAFT.frame(load)
        solids = [SHAFT.solid(C, load) for _, C in meshes]
        bearing, gearbox = (-float(frame.reactions[k, 0]) for k in (BEARING, GEARBOX))
        # what each support's local yielding would do to the hub
        at_supports = np.array([L1 / L2, 1 + L1 / L2]) @ np.abs([gearbox, bearing])
        slack = abs(load.force) + at_supports, (abs(gearbox) + abs(bearing)) / L2
        for k, (part, unit) in enumerate((("deflection", "m"), ("rotation", "rad"))):
            title, value = f"{part} of the hub by a {name}", CLOSED[name][k]
            within = float(section + local_compliance(TUBE) * slack[k] / abs(value))
            even = SHAFT.evenly(load).motions[HUB, k], within, evenly, EVENLY
            by_frame, by_mesh = frame.motions[HUB, k], [s.motions[HUB, k] for s in solids]
            found = inputs.check_motion(
                page, title, unit, (value, SHEARED), by_frame, by_mesh, even
            )
            rows.append({"quantity": f"{part} by a {name}"} | found)
        statics = float(pinned_reaction(load.force, load.moment, L1, L2))
        left = "what the iterations leave of the solid's balance"
        for who, value, within, why in (
            ("frame", bearing, 1e-10, "round-off of a few equations"),
            ("solid", -float(solids[-1].reactions[BEARING, 0]), 1e-7, left),
        ):
            title, why = f"load on the bearing by a {name}", f"statically determinate: {why}"
            page.meets(value, Target(f"{title}, {who} [N]", statics, within, why, STATICS))
        traces += inputs.beside_beam(name, SHAFT, load, fine, solids[-1])
    answer(page, rows)
    met = ", ".join(f"{r['quantity']} {100 * (r['solid'] / r['frame'] - 1):+.3f} %" for r in rows)
    page.say(f"The solid beside the frame: {met}.")
    inputs.begin(run, page, "Overhung shaft", straight((0.0, LENGTH), OUTER))
    inputs.show_inputs(
        page,
        ("diameter, solid", OUTER, "m", "Stirling 2023, Table 3.1"),
        ("overhang L1, hub to bearing", L1, "m", "Stirling 2023, Table 3.1"),
        ("span L2, bearing to gearbox", L2, "m", "Stirling 2023, Table 3.1"),
        ("supports", "rigid, free to turn", "", "chosen: determinate"),
        ("force and moment at the hub", 1, "MN, MN m"),
        steel=STEEL,
    )
    page.chart(BENT, traces, "x from the hub [m]", "u_z [mm]")
    page.table("Hub [m, rad]", rows)
    page.text(
        "Both cross terms, deflection by a moment and rotation by a force, are one number, as "
        "Maxwell's theorem demands."
    )
    page.data("hub [m, rad]", rows)
