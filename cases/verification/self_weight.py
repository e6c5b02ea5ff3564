"""Sag of an overhung shaft under its own weight: solid against beams with shear."""

import numpy as np

from fe_drivetrain.beam import Beam, BeamSection, Support, solve
from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import Page, Record, Run, Target, column
from fe_drivetrain.validation import solid_shafts
from fe_drivetrain.validation.shaft_theory import Tube, evenly_loaded_shear, parabola_shortfall

STEEL = MATERIALS["steel"]
GRAVITY = -9.80665  # m/s^2
OUTER, RATIO = 0.4, 6.0  # diameter [m], overhang over it
TUBE = Tube(OUTER, 0.0, RATIO * OUTER, STEEL)
LENGTH = TUBE.length
Q = STEEL.density * TUBE.area * GRAVITY  # N/m
ROTATION = -Q * LENGTH**3 / (6 * TUBE.EI)  # rad
#: Lengths over diameter of the chart.
RATIOS = (1.5, 2.0, 3.0, 4.0)

OVERHANG = "overhang over diameter"
FOUND, EVEN = "solid", "beam, evenly held"
SAG, TURNED, MASS = "sag [m]", "rotation [rad]", "mass [kg]"
HUTCHINSON = "q L^4 / 8EI + q L^2 / 2k'GA, k' of evenly loaded sections (Hutchinson 2001, as "
HUTCHINSON += "quoted by Stephen 2001; derived again)"


def sag(load: float, rigidity: float, shear: float, length: float) -> float:
    """Of a cantilever's tip under a load per length, with shear [m]."""
    return load * length**4 / (8 * rigidity) + load * length**2 / (2 * shear)


def solid(refinement: int) -> Record:
    """Sag, rotation and mass of one mesh, its root held by its mean motion."""
    shaft = solid_shafts.straight((0.0, LENGTH), OUTER)
    mesh = solid_shafts.solid(shaft, refinement, size=1.5 * OUTER)
    C = solid_shafts.sectional_compliance(mesh, STEEL, (0.0, LENGTH))
    by_weight = GRAVITY * C.weight[1]
    return {
        "refinement": refinement,
        "per turn": mesh.per_turn,
        SAG: float(by_weight[0]),
        TURNED: float(by_weight[1]),
        MASS: float(C.weight_resultant[0]),
    }


def beyond_the_beam(ratio: float) -> Record:
    """Sag beyond Timoshenko's beam with Cowper's coefficient [%], at another length."""
    short = Tube(OUTER, 0.0, ratio * OUTER, STEEL)
    mesh = solid_shafts.solid(solid_shafts.straight((0.0, short.length), OUTER), 2, size=OUTER)
    C = solid_shafts.sectional_compliance(mesh, STEEL, (0.0, short.length))
    # with the mesh's own mass and I, so that what is left is not the section's error
    load = float(C.weight_resultant[0]) / short.length
    rigidity = STEEL.youngs_modulus * solid_shafts.meshed_moment(mesh) / short.length / 2
    cowper = sag(load, rigidity, short.kGA, short.length)
    even = sag(load, rigidity, evenly_loaded_shear(short), short.length)
    excess = {FOUND: float(C.weight[1, 0]) / cowper, EVEN: even / cowper}
    return {OVERHANG: ratio} | {name: 100 * (of - 1) for name, of in excess.items()}


@case(
    "Sag of an overhung shaft under its own weight",
    source="Closed form q L^4 / 8EI + q L^2 / 2kGA (Cowper 1966; Hutchinson 2001)",
)
def run(run: Run, page: Page) -> None:
    """Gravity on the solid, its root held by its mean motion."""
    closed, even = (sag(Q, TUBE.EI, k, LENGTH) for k in (TUBE.kGA, evenly_loaded_shear(TUBE)))
    beam = Beam([BeamSection(LENGTH, OUTER)], [Support("root", 0.0, [np.inf] * 6)], material=STEEL)
    with run.step("frame"):
        frame = solve(beam, LENGTH, np.zeros(6), LENGTH, (0.0, 0.0, GRAVITY)).displacements
    meshes = [run.timed("mesh and solve", solid, r) for r in ((1, 2) if run.quick else (1, 2, 3))]
    ratios = RATIOS[:2] if run.quick else RATIOS
    sweep = [run.timed("other lengths", beyond_the_beam, ratio) for ratio in ratios]

    best, refinements = meshes[-1], column(meshes, "refinement")
    band = {key: solid_shafts.mesh_band(refinements, column(meshes, key)) for key in best}
    turn = best["per turn"]
    section = 2 * 2 * parabola_shortfall(turn)
    local = abs(Q) * LENGTH * solid_shafts.local_compliance(TUBE) / abs(closed)
    arcs = f"{turn} parabolic arcs round a turn: weight over I is wrong by twice the radius's "
    arcs += "shortfall, twice that is allowed"
    evenly = f"{arcs}; and the root's reaction enters evenly, {solid_shafts.LOCAL:.0%} of what one "
    evenly += "diameter shears"
    area = f"{turn} parabolic arcs round a turn: twice the area's shortfall"
    exact = "the frame's sections are exact: round-off"
    cowper = "q L^4 / 8EI + q L^2 / 2kGA, k of Cowper 1966"
    reciprocal = "q L^3 / 6EI: exact for a root held evenly, by reciprocity with pure bending"
    weight, tip = STEEL.density * TUBE.area * LENGTH, "of the tip"
    of_solid, turned = best[SAG], best[TURNED]
    sags = Target(f"sag {tip}, solid [m]", even, section + local, evenly, HUTCHINSON)
    turns = Target(f"rotation {tip}, solid [rad]", ROTATION, section, arcs, reciprocal)
    turns_beam = Target(f"rotation {tip}, frame [rad]", ROTATION, 1e-10, exact, "q L^3 / 6EI")
    page.meets(float(frame[2]), Target(f"sag {tip}, frame [m]", closed, 1e-10, exact, cowper))
    page.meets(of_solid, sags, band[SAG])
    page.meets(turned, turns, band[TURNED])
    page.meets(float(frame[4]), turns_beam)
    page.meets(best[MASS], Target(MASS, weight, section, area, "density times volume"), band[MASS])
    over_cowper, over_even = of_solid / closed - 1, of_solid / even - 1
    page.answer(
        f"An overhang of {RATIO:g} diameters sags {-1e3 * of_solid:.4f} mm; by Timoshenko's beam "
        f"{-1e3 * closed:.4f} mm with Cowper's shear coefficient ({100 * over_cowper:+.3f} %), "
        f"{-1e3 * even:.4f} mm with that of an evenly held root ({100 * over_even:+.3f} %)."
    )
    page.section("Sag")
    show_inputs(
        page,
        ("diameter, solid", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
        ("overhang", LENGTH, "m"),
        ("gravity", GRAVITY, "m/s^2", "standard"),
        ("density", STEEL.density, "kg/m^3", "steel, assumed"),
        steel=STEEL,
    )
    title = "Sag of the solid beyond Timoshenko's beam with Cowper's coefficient, of the meshed "
    title += "section; beside it the beam with that of an evenly held root"
    keys = {FOUND: FOUND, EVEN: EVEN}
    page.sweep(title, sweep, OVERHANG, keys, axis="difference [%]", table=False)
    page.table(
        "Tip",
        [
            (SAG, closed, even, float(frame[2]), of_solid, band[SAG]),
            (TURNED, ROTATION, ROTATION, float(frame[4]), turned, band[TURNED]),
        ],
        ["quantity", "beam with shear", EVEN, "frame", FOUND, "band of the solid"],
    )
    page.text(
        "A shaft that carries its own weight is also stressed across, since each slice hangs on "
        "its neighbours by shear that is not as even as the weight; Poisson's ratio turns that "
        "into curvature. An evenly held root turns the other way under its shear force, twice as "
        "much at the tip. Together they are as if the shear coefficient were not Cowper's, "
        "6 (1 + nu) / (7 + 6 nu), but 6 (1 + nu)^2 / (7 + 12 nu + 4 nu^2)."
    )
    page.data("over_cowper", over_cowper)
    page.data("over_even", over_even)
