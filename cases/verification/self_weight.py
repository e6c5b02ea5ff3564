"""Sag of an overhung shaft under its own weight: solid against beams with shear."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import solid_shafts
from fe_drivetrain.cases.references.shaft_theory import Tube, evenly_loaded_shear, sag, within_arcs
from fe_drivetrain.cases.references.supported_shafts import (
    EVENLY,
    Load,
    SupportedShaft,
    sag_over_beam,
)
from fe_drivetrain.cases.verification.shaft_inputs import SIZE, begin, check_motion, show_inputs
from fe_drivetrain.common import GRAVITY
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.report.number_text import percent_text, value_text
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target, column

STEEL = MATERIALS["steel"]
OUTER, RATIO, DOWN = 0.4, 6.0, -GRAVITY  # diameter [m], overhang over it, m/s^2
LENGTH = RATIO * OUTER
TUBE = Tube(OUTER, 0.0, LENGTH, STEEL)
SHAFT = SupportedShaft(TUBE, (0.0, LENGTH), ((np.inf, np.inf), (0.0, 0.0)))
Q = STEEL.density * TUBE.area * DOWN  # N/m
ROTATION = -Q * LENGTH**3 / (6 * TUBE.EI)  # rad
RATIOS = (1.5, 2.0, 3.0, 4.0)  # of the chart
OVERHANG, FOUND, EVEN = "overhang over diameter", "solid", "beam, evenly held"
BEYOND = "Sag of the solid beyond Timoshenko's beam with Cowper's coefficient, of the meshed "
BEYOND += "section; beside it the beam with that of an evenly held root"
COWPER = "q L^4 / 8EI + q L^2 / 2kGA, k of Cowper 1966"
RECIPROCAL = "q L^3 / 6EI: exact for a root held evenly, by reciprocity with pure bending"
SAG, TURNED, MASS, TURN = "sag [m]", "rotation [rad]", "mass [kg]", "elements round a turn"


def solid(refinement: int) -> Record:
    """Sag, rotation and mass of one mesh, its root held by its mean motion."""
    turn, C = SHAFT.compliance(refinement, 1.5 * OUTER)
    down, turned = DOWN * C.weight[1]
    moved = {SAG: float(down), TURNED: float(turned)}
    return {TURN: turn, **moved, MASS: float(C.weight_resultant[0])}


def beyond_the_beam(ratio: float) -> Record:
    """Sag beyond Timoshenko's beam with Cowper's coefficient [%], at another length."""
    excess = sag_over_beam(Tube(OUTER, 0.0, ratio * OUTER, STEEL))
    return {OVERHANG: ratio, FOUND: 100 * (excess[0] - 1), EVEN: 100 * (excess[1] - 1)}


def answer(page: Page, over_cowper: float, over_even: float) -> None:
    """State the sag, and how far it is from the two beams."""
    sag = page.judged(
        "sag of the tip, solid", "displacement of the tip", "beam, root held evenly", unit="mm"
    )
    page.answer(
        "How far does an overhung shaft sag under its own weight?",
        f"A shaft with {RATIO:g} diameters of overhang sags by "
        f"{value_text(-sag.value, sag.unit, sag.band, with_band=False)}; a beam with Cowper's "
        f"shear coefficient differs by {percent_text(over_cowper)}.",
        [
            sag,
            page.judged("rotation of the tip, solid", "rotation of the tip", "beam", unit="µrad"),
            page.judged("mass", by="density times volume"),
            page.value("solid beyond a beam with Cowper's coefficient [%]", 100 * over_cowper),
            page.value("solid beyond a beam held evenly [%]", 100 * over_even),
        ],
        hero=BEYOND,
        cautions=[
            f"With the shear coefficient of a root that is held evenly, the beam differs by "
            f"{percent_text(over_even)}."
        ],
    )


@case(
    "Sag of an overhung shaft under its own weight",
    source="Closed form q L^4 / 8EI + q L^2 / 2kGA (Cowper 1966; Hutchinson 2001)",
)
def run(run: Run, page: Page) -> None:
    """Gravity on the solid, its root held by its mean motion."""
    closed, even = (sag(Q, TUBE.EI, k, LENGTH) for k in (TUBE.kGA, evenly_loaded_shear(TUBE)))
    frame = run.timed("frame", SHAFT.frame, Load(1, gravity=DOWN)).motions[1]
    meshes = [run.timed("mesh and solve", solid, r) for r in ((1, 2) if run.quick else (1, 2, 3))]
    ratios = RATIOS[:2] if run.quick else RATIOS
    sweep = [run.timed("other lengths", beyond_the_beam, ratio) for ratio in ratios]
    turn, series = meshes[-1][TURN], MeshSeries(meshes, TURN)
    local = abs(Q) * LENGTH * solid_shafts.local_compliance(TUBE) / abs(closed)
    section, arcs = within_arcs(turn, "I over weight", 2)
    evenly = f"{arcs}; and the root's reaction enters evenly, {solid_shafts.LOCAL:.0%} of what one "
    evenly += "diameter shears"
    weight, density = STEEL.density * TUBE.area * LENGTH, "density times volume"
    cowper, found = (closed, COWPER), (even, section + local, evenly, EVENLY)
    rotation, exact = (ROTATION, "q L^3 / 6EI"), (ROTATION, section, arcs, RECIPROCAL)
    down, turned = (column(meshes, key) for key in (SAG, TURNED))
    sagging = check_motion(page, "sag of the tip", "m", cowper, frame[0], down, found)
    turning = check_motion(page, "rotation of the tip", "rad", rotation, frame[1], turned, exact)
    page.finest(series, Target(MASS, weight, *within_arcs(turn, "the area", 2), density, order=4.0))
    over_cowper, over_even = down[-1] / closed - 1, down[-1] / even - 1
    answer(page, over_cowper, over_even)
    sizes = ("diameter, solid", OUTER, "m", SIZE), ("overhang", LENGTH, "m")
    begin(run, page, "Sag", solid_shafts.straight((0.0, LENGTH), OUTER))
    show_inputs(page, *sizes, steel=STEEL, gravity=DOWN)
    curves = {FOUND: FOUND, EVEN: EVEN}
    page.sweep(BEYOND, sweep, OVERHANG, curves, axis="difference [%]", table=False)
    tip = {"quantity": SAG, EVEN: even} | sagging, {"quantity": TURNED, EVEN: ROTATION} | turning
    page.table("Tip", tip)
    page.text(
        "A shaft that carries its own weight is also stressed across, since each slice hangs on "
        "its neighbours by shear that is not as even as the weight; Poisson's ratio turns that "
        "into curvature. An evenly held root turns the other way under its shear force, twice as "
        "much at the tip. Together they are as if the shear coefficient were not Cowper's, "
        "6 (1 + nu) / (7 + 6 nu), but 6 (1 + nu)^2 / (7 + 12 nu + 4 nu^2)."
    )
    page.data("over_cowper", over_cowper)
    page.data("over_even", over_even)
