"""Shaft on two simple supports: closed forms, frame and solid."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.shaft_theory import Tube
from fe_drivetrain.cases.references.solid_shafts import local_compliance, mesh_band, straight
from fe_drivetrain.cases.references.supported_shafts import (
    EVENLY,
    Load,
    SupportedShaft,
    within_evenly,
)
from fe_drivetrain.cases.verification import shaft_inputs as inputs
from fe_drivetrain.common import GRAVITY
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.report.number_text import certain_value, percent_text
from fe_drivetrain.report.suite import Page, Record, Run, Target

STEEL, OUTER, L = MATERIALS["steel"], 0.4, 2.4  # m
TUBE = Tube(OUTER, 0.0, L, STEEL)
STATIONS = (0.0, L / 4, L / 2, 3 * L / 4, L)
MIDDLE, END = 2, 4
PINNED, FREE = (np.inf, 0.0), (0.0, 0.0)
SHAFT = SupportedShaft(TUBE, STATIONS, (PINNED, FREE, FREE, FREE, PINNED))
F, M, DOWN = 1e6, 1e6, -GRAVITY  # N, N m, m/s^2
W = STEEL.density * TUBE.area * DOWN * L  # N
BENT, SHEARED = L**3 / TUBE.EI, L / TUBE.kGA  # m/N
#: Of each load the closed form with shear at mid span [m], and the force of load and supports that
#: enters evenly, and moves mid span [N]. A moment's reactions move both ends by the same amount,
#: and the weight's are half of it each.
LOADS = {
    "force at mid span": (Load(MIDDLE, force=F), F * (BENT / 48 + SHEARED / 4), 1.5 * F),
    "moment at the end": (Load(END, moment=M), M / L * BENT / 16, M / L),
    "own weight": (Load(MIDDLE, gravity=DOWN), W * (5 * BENT / 384 + SHEARED / 8), abs(W) / 2),
}
DEFLECTED = "Deflection over its largest: Macaulay's beam with shear, and the means of the solid's "
DEFLECTED += "sections"
FRAME, REACTION = "Timoshenko frame of the library", "reaction of the downwind support, solid [N]"


def answer(page: Page, largest: float) -> None:
    """State the deflection at mid span, and the largest difference of solid and beam."""
    name = "{}: deflection at mid span, solid"
    by_force, by_moment, by_weight = (
        page.judged(
            name.format(load), f"deflection at mid span, {words}", "beam with shear", unit=unit
        )
        for load, words, unit in (
            ("force at mid span", "1 MN at mid span", "mm"),
            ("moment at the end", "1 MN m at the end", "mm"),
            ("own weight", "own weight", "µm"),
        )
    )
    reaction = f"own weight: {REACTION.partition(' [')[0]}"
    page.answer(
        "How far does a shaft on two simple supports deflect at mid span?",
        f"A force of 1\u00a0MN at mid span deflects the shaft by {certain_value(by_force)}; solid "
        f"mesh and beam with shear differ by at most {percent_text(largest)}.",
        [
            by_force,
            by_moment,
            by_weight,
            page.judged(reaction, "reaction to the own weight", "statics", unit="kN"),
        ],
        hero=DEFLECTED,
    )


@case(
    "Shaft on two simple supports: closed forms, frame and solid",
    source="Closed forms with shear: F L^3 / 48EI + F L / 4kGA, M L^2 / 16EI, "
    "5 q L^4 / 384EI + q L^2 / 8kGA",
)
def run(run: Run, page: Page) -> None:
    """A force at mid span, a moment at an end, and the shaft's weight."""
    refinements = (1, 2) if run.quick else (1, 2, 3)
    meshes = [run.timed("mesh and solve", SHAFT.compliance, r) for r in refinements]
    section, evenly = within_evenly(meshes[-1][0])
    rows: list[Record] = []
    traces, fine = [], np.linspace(0.0, L, 81)
    for name, (load, closed, local) in LOADS.items():
        frame, solids = SHAFT.frame(load), [SHAFT.solid(C, load) for _, C in meshes]
        even = float(SHAFT.evenly(load).motions[MIDDLE, 0])
        beside = even, section + local * local_compliance(TUBE) / abs(closed), evenly, EVENLY
        of_frame, by_mesh = float(frame.motions[MIDDLE, 0]), [s.motions[MIDDLE, 0] for s in solids]
        exact, title = (closed, "closed form with shear"), f"{name}: deflection at mid span"
        row = inputs.check_motion(page, title, "m", exact, of_frame, by_mesh, beside)
        rows.append({"load": name, "beam, evenly loaded": even} | row)
        page.data(name, row["solid"] / row["frame"] - 1)
        reactions, band = [float(s.reactions[END, 0]) for s in solids], None
        within, why = 1e-7, "statically determinate: round-off of the solver"
        if load.gravity:  # the mesh enters the reaction by its weight only
            within, why = section, "statically determinate: the meshed section's weight"
            band = mesh_band(refinements, reactions)
        target = Target(REACTION, float(frame.reactions[END, 0]), within, why, FRAME)
        page.meets(reactions[-1], target, band, name)
        traces += inputs.beside_beam(name, SHAFT, load, fine, solids[-1], over_max=True)
    differences = {row["load"]: row["solid"] / row["frame"] - 1 for row in rows}
    answer(page, max(map(abs, differences.values())))
    page.say(
        "The solid, held and loaded through the mean motions of its sections, differs from the "
        "frame by "
        + ", ".join(f"{100 * d:+.3f} % ({name})" for name, d in differences.items())
        + "."
    )
    inputs.begin(run, page, "Simple supports", straight((0.0, L), OUTER))
    inputs.show_inputs(
        page,
        ("diameter, solid", OUTER, "m", inputs.SIZE),
        ("span", L, "m"),
        ("force at mid span", F / 1e6, "MN"),
        ("moment at the downwind end", M / 1e6, "MN m"),
        steel=STEEL,
        gravity=DOWN,
    )
    page.chart(DEFLECTED, traces, "x [m]", "deflection over the largest")
    page.table("Deflection at mid span [m]", rows)
    page.text(
        "The solid's sections are free to warp: supports and loads act on their mean displacement, "
        "evenly. The shear coefficient for that is not Cowper's, 6 (1 + nu) / (7 + 6 nu), but "
        "6 (1 + nu)^2 / (7 + 12 nu + 4 nu^2): 4 % less shear deflection. A support on the skin, as "
        "of a bearing, adds the local yielding of the skin, which no beam has."
    )
