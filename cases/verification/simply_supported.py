"""Shaft on two simple supports: closed forms, frame and solid."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import SIZE, check_motion, show_inputs
from fe_drivetrain.report import trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import Page, Record, Run, Target
from fe_drivetrain.validation.shaft_theory import Tube
from fe_drivetrain.validation.solid_shafts import Supported, local_compliance, mesh_band
from fe_drivetrain.validation.supported_shafts import EVENLY, Load, SupportedShaft, within_evenly

STEEL, OUTER, LENGTH = MATERIALS["steel"], 0.4, 2.4
TUBE = Tube(OUTER, 0.0, LENGTH, STEEL)
STATIONS = (0.0, LENGTH / 4, LENGTH / 2, 3 * LENGTH / 4, LENGTH)
MIDDLE, END = 2, 4
PINNED, FREE = (np.inf, 0.0), (0.0, 0.0)
SHAFT = SupportedShaft(TUBE, STATIONS, (PINNED, FREE, FREE, FREE, PINNED))
FORCE, MOMENT, GRAVITY = 1e6, 1e6, -9.80665  # N, N m, m/s^2
WEIGHT = STEEL.density * TUBE.area * GRAVITY * LENGTH  # N
BENT, SHEARED = LENGTH**3 / TUBE.EI, LENGTH / TUBE.kGA  # m/N
#: Of each load the closed form with shear at mid span [m], and the force of load and supports that
#: enters evenly, and moves mid span [N]. A moment's reactions move both ends by the same amount,
#: and the weight's are half of it each.
LOADS = {
    "force at mid span": (
        Load(MIDDLE, force=FORCE),
        FORCE * (BENT / 48 + SHEARED / 4),
        1.5 * FORCE,
    ),
    "moment at the end": (Load(END, moment=MOMENT), MOMENT / LENGTH * BENT / 16, MOMENT / LENGTH),
    "own weight": (
        Load(MIDDLE, gravity=GRAVITY),
        WEIGHT * (5 * BENT / 384 + SHEARED / 8),
        abs(WEIGHT) / 2,
    ),
}
EVEN, FRAME = "beam, evenly loaded", "Timoshenko frame of the library"


@case(
    "Shaft on two simple supports: closed forms, frame and solid",
    source="Closed forms with shear: F L^3 / 48EI + F L / 4kGA, M L^2 / 16EI, "
    "5 q L^4 / 384EI + q L^2 / 8kGA",
)
def run(run: Run, page: Page) -> None:
    """A force at mid span, a moment at an end, and the shaft's weight."""
    refinements = (1, 2) if run.quick else (1, 2, 3)
    meshes = [run.timed("mesh and solve", SHAFT.compliance, r) for r in refinements]
    rows, traces = [], []
    fine = np.linspace(0.0, LENGTH, 81)
    for name, (load, _, _) in LOADS.items():
        solids = [SHAFT.solid(C, load) for _, C in meshes]
        rows.append(check(page, name, solids, meshes[-1][0]))
        curve, found = SHAFT.beam(load, fine).motions[:, 0], solids[-1].motions[:, 0]
        size = np.abs(curve).max()
        traces.append(trace(f"{name}, beam", fine, curve / size))
        traces.append(trace(f"{name}, solid", STATIONS, found / size, True))
    differences = {row["load"]: row["solid"] / row["frame"] - 1 for row in rows}
    page.answer(
        "The frame meets the closed forms with shear to round-off. The solid, held and loaded "
        "through the mean motions of its sections, differs from it by "
        + ", ".join(f"{100 * d:+.3f} % ({name})" for name, d in differences.items())
        + f" at L = {LENGTH / OUTER:g} D."
    )
    page.section("Simple supports")
    show_inputs(
        page,
        ("diameter, solid", OUTER, "m", SIZE),
        ("span", LENGTH, "m"),
        ("force at mid span", FORCE / 1e6, "MN"),
        ("moment at the downwind end", MOMENT / 1e6, "MN m"),
        ("gravity", GRAVITY, "m/s^2", "standard"),
        ("density", STEEL.density, "kg/m^3", "steel, assumed"),
        steel=STEEL,
    )
    title = "Deflection over its largest: Macaulay's beam with shear, and the means of the solid's "
    page.chart(f"{title}sections", traces, "x [m]", "deflection over the largest")
    page.table("Deflection at mid span [m]", rows)
    page.text(
        "The solid's sections keep their freedom to warp: supports and loads act on their mean "
        "displacement, evenly. The shear coefficient for that is not Cowper's, "
        "6 (1 + nu) / (7 + 6 nu), but 6 (1 + nu)^2 / (7 + 12 nu + 4 nu^2): 4 % less shear "
        "deflection. A support on the skin, as of a bearing, adds the local yielding of the skin, "
        "which no beam has."
    )
    for name, difference in differences.items():
        page.data(name, difference)


def check(page: Page, name: str, solids: list[Supported], turn: int) -> Record:
    """Deflection of frame and solid, and the reaction, under one load."""
    load, closed, local = LOADS[name]
    frame, even = SHAFT.frame(load), float(SHAFT.evenly(load).motions[MIDDLE, 0])
    of_frame, by_mesh = float(frame.motions[MIDDLE, 0]), [s.motions[MIDDLE, 0] for s in solids]
    section, evenly = within_evenly(turn)
    within = section + local * local_compliance(TUBE) / abs(closed)
    title = f"{name}: deflection at mid span"
    beams = (closed, "closed form with shear"), of_frame, by_mesh, (even, within, evenly, EVENLY)
    row = check_motion(page, title, "m", *beams)
    title, why = f"{name}: reaction of the downwind support, solid [N]", "statically determinate: "
    reactions = [float(s.reactions[END, 0]) for s in solids]
    by_frame = float(frame.reactions[END, 0])
    target = Target(title, by_frame, 1e-7, f"{why}round-off of the solver", FRAME)
    if load.gravity:  # the mesh enters the reaction by its weight only
        target = target._replace(within=section, why=f"{why}the meshed section's weight")
    band = mesh_band(range(1, len(solids) + 1), reactions) if load.gravity else None
    page.meets(reactions[-1], target, band)
    return {"load": name, EVEN: even} | row
