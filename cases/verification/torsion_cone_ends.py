"""Torsion of a cone between rigid flat ends, and the error of the integral of dx / GJ."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import solid_shafts
from fe_drivetrain.cases.references.shaft_theory import between_spheres, within_arcs
from fe_drivetrain.cases.references.torsion_meridian import Bounds, series_stiffness, torsion_bounds
from fe_drivetrain.cases.verification.conical_shaft import HALF_ANGLE, INPUTS, RADII, SHAFT, STEEL
from fe_drivetrain.cases.verification.shaft_inputs import begin, show_inputs
from fe_drivetrain.cases.verification.torsion_bound import between, check_plane_sections
from fe_drivetrain.report.number_text import certain_value, percent_text, value_with_band
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target

G = STEEL.shear_modulus
ANGLES, QUICK_ANGLES = (2.5, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0), (5.0, 10.0, 20.0, 30.0)

TOO_STIFF = "How much too stiff the integral of dx / GJ is: against rigid flat ends, and against "
TOO_STIFF += "Michell's cone between spheres through the ends' centres"
ANGLE, FLAT, SPHERES = "half angle [degrees]", "rigid flat ends", "spheres"
TURN, RIGID = "per turn", "stiffness between rigid flat ends [N m/rad]"


def solve(refinement: int) -> Record:
    """Rigid flat ends, on one mesh."""
    mesh = solid_shafts.solid(SHAFT, refinement, size=SHAFT.length / 2)
    return {TURN: mesh.per_turn, RIGID: solid_shafts.twist(mesh, STEEL)[1]}


def too_stiff(degrees: float) -> Record:
    """How much too stiff the integral of dx / GJ is [%], by the half angle."""
    shaft = solid_shafts.cone(RADII, degrees)
    flat = torsion_bounds(shaft, G, RADII[0] / 2, 2).middle
    # Michell's cone, as long on its axis as the flat-ended one
    by = {FLAT: flat, SPHERES: between_spheres(RADII, np.radians(degrees), G)}
    simple = series_stiffness(shaft, G)
    return {ANGLE: degrees} | {name: 100 * (simple / k - 1) for name, k in by.items()}


def answer(page: Page, simple: float, bounds: Bounds, widest: Record) -> float:
    """State how much too stiff the integral is [%], and return it.

    Parameters
    ----------
    page : Page
        With the checks of the cone.
    simple : float
        Stiffness by the integral [N m/rad].
    bounds : Bounds
        Of the exact stiffness [N m/rad].
    widest : dict
        The same of the widest cone of the sweep.
    """
    middle, excess = bounds.middle / 1e6, 100 * (simple / bounds.middle - 1)
    exact = page.value("exact stiffness [MN m/rad]", middle, bounds.half_width / 1e6)
    solid = page.judged(
        RIGID.partition(" [")[0], "stiffness of a solid mesh", "exact", unit="MN m/rad"
    )
    digits, unit = certain_value(exact).split("\u00a0", 1)
    by_integral = page.value(
        "stiffness by the integral [MN m/rad]",
        simple / 1e6,
        beside=middle,
        by="exact",
        printed=digits,
    )
    angle = widest[ANGLE]
    page.answer(
        "How good is the integral of dx / GJ for a conical shaft between rigid ends?",
        f"At a half angle of {HALF_ANGLE:g}° the integral is {percent_text(excess / 100, 3)} too "
        f"stiff ({value_with_band(by_integral).removesuffix(unit).strip()} instead of "
        f"{certain_value(exact)}); at {angle:g}° it is {percent_text(widest[FLAT] / 100, 3)} too "
        "stiff.",
        [
            page.value(f"integral too stiff by, half angle of {HALF_ANGLE:g} degrees [%]", excess),
            page.value(f"integral too stiff by, half angle of {angle:g} degrees [%]", widest[FLAT]),
            by_integral,
            exact,
            solid,
        ],
        hero=TOO_STIFF,
        cautions=["The exact stiffness is the middle between an upper and a lower bound."],
    )
    return excess


@case(
    "Torsion of a cone between rigid flat ends, and the integral of dx / GJ",
    source="Two bounds from the meridian (Michell 1899; Timoshenko and Goodier, Theory of "
    "Elasticity, article 119, 3rd edition)",
)
def run(run: Run, page: Page) -> None:
    """A cone between flat ends by solids, by two bounds, and by the integral of dx / GJ."""
    meshes = [run.timed("mesh and solve", solve, r) for r in ((1, 2) if run.quick else (1, 2, 3))]
    with run.step("bounds from the meridian"):
        bounds = torsion_bounds(SHAFT, G, RADII[0] / (2 if run.quick else 3), 2)
        sweep = [too_stiff(angle) for angle in (QUICK_ANGLES if run.quick else ANGLES)]
    series, simple = MeshSeries(meshes, TURN), series_stiffness(SHAFT, G)
    arcs = within_arcs(series.last[TURN], "J", 4, held=False)
    page.finest(series, between(bounds, RIGID, *arcs, order=4.0))
    title = "excess of the upper bound over 1 / integral of dx / GJ"
    check_plane_sections(page, title, bounds, simple)
    title = f"1 / integral of dx / GJ at a half angle of {HALF_ANGLE:g} degrees [N m/rad]"
    first = "of a complete cone between spheres the integral is 5/3 a^2 too stiff to first order "
    first += "in the half angle a; flat rigid ends stiffen the cone, so it is less"
    within = float(np.tan(np.radians(HALF_ANGLE)) ** 2) * 5 / 3
    meridian = "between two bounds from the meridian"
    page.meets(simple, Target(title, bounds.middle, within, first, meridian))
    excess = answer(page, simple, bounds, sweep[-1])
    begin(run, page, "Cone", SHAFT, "The cone")
    show_inputs(page, *INPUTS, steel=STEEL)
    curves = {FLAT: FLAT, SPHERES: SPHERES}
    page.sweep(TOO_STIFF, sweep, ANGLE, curves, axis="too stiff by [%]", table=False)
    page.table(
        "Stiffness between rigid flat ends [N m/rad]",
        [
            ("1 / integral of dx / GJ", simple, None),
            ("two bounds", bounds.middle, bounds.half_width),
            ("three dimensions", series.last[RIGID], series.band(RIGID, 4.0)),
        ],
        ["by", "stiffness", "half width of bounds or band"],
    )
    page.data("series_too_stiff_percent", excess)
