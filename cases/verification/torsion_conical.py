"""Torsion of a conical shaft: Michell's exact field, and the integral of dx / GJ."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
from fe_drivetrain.cases.verification.torsion_bound import BOUNDS, check_plane_sections
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import Page, Record, Run, Target, column
from fe_drivetrain.validation import end_loaded, solid_shafts
from fe_drivetrain.validation.shaft_theory import michell_torque, parabola_shortfall
from fe_drivetrain.validation.torsion_meridian import torsion_bounds

STEEL = MATERIALS["steel"]
G = STEEL.shear_modulus
#: Radii at the ends [m] and half angle of the cone [degrees].
RADII, HALF_ANGLE = (0.15, 0.3), 10.0
ANGLES = (2.5, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0)
QUICK_ANGLES = (5.0, 10.0, 20.0, 30.0)
#: Of Michell's displacements: u_t = -SCALE r / R^3 [m^3].
SCALE = 1e-3 * RADII[0] ** 3
TORQUE = SCALE * michell_torque(np.radians(HALF_ANGLE), G)

ANGLE, FLAT, SPHERES = "half angle [degrees]", "rigid flat ends", "spheres"
UNKNOWNS, TURN, RIGID = "unknowns", "per turn", "stiffness between rigid flat ends [N m/rad]"
TAKEN, ERROR = "torque of Michell's displacements on the ends [N m]", "displacement, largest"
MICHELL = "Michell 1899: 2 pi G (2 - 3 cos a + cos^3 a) for u_t = -r / R^3"


def cone(degrees: float) -> Shaft:
    """Between flat ends, its apex at the origin."""
    start, end = (r / np.tan(np.radians(degrees)) for r in RADII)
    thin, thick = (2 * r for r in RADII)
    length = float(end - start)
    section = Section(length=length, outer_diameter=thin, outer_diameter_end=thick)
    return Shaft(front=float(start), sections=(section,))


def elementary(degrees: float) -> float:
    """1 over the integral of dx / GJ, in closed form [N m/rad]."""
    tangent = np.tan(np.radians(degrees))
    integral = (RADII[0] ** -3 - RADII[1] ** -3) / (3 * tangent)
    return float(G * np.pi / 2 / integral)


def between_spheres(degrees: float) -> float:
    """Michell's stiffness of a cone as long, on its axis, as the flat-ended one [N m/rad]."""
    angle = np.radians(degrees)
    # spheres through the centres of the flat ends
    near, far = (r / np.tan(angle) for r in RADII)
    return float(michell_torque(float(angle), G) / (near**-3 - far**-3))


def solved(shaft: Shaft, refinement: int) -> Record:
    """Michell's displacements prescribed on the ends, then rigid ends, on one mesh."""
    mesh = solid_shafts.solid(shaft, refinement, size=shaft.length / 2)
    R = np.linalg.norm(mesh.points, axis=1)
    field = solid_shafts.rotation_of(mesh.points, -SCALE / R**3)
    found = end_loaded.solve_displaced(mesh, STEEL, field)
    torque = solid_shafts.axial_torque(mesh, found.static)
    return {
        "refinement": refinement,
        UNKNOWNS: mesh.n_unknowns,
        TURN: mesh.per_turn,
        TAKEN: torque,
        "torque": abs(torque / TORQUE - 1),
        ERROR: found.error(field),
        RIGID: solid_shafts.twist(mesh, STEEL)[1],
    }


def too_stiff(degrees: float) -> Record:
    """How much too stiff the integral of dx / GJ is [%], by the half angle."""
    simple = elementary(degrees)
    flat = torsion_bounds(cone(degrees), G, RADII[0] / 2, 2).middle
    by = {FLAT: flat, SPHERES: between_spheres(degrees)}
    return {ANGLE: degrees} | {name: 100 * (simple / k - 1) for name, k in by.items()}


@case(
    "Torsion of a conical shaft: Michell's exact field, and the integral of dx / GJ",
    source="Michell 1899; Timoshenko and Goodier, Theory of Elasticity, article 119 (3rd edition)",
)
def run(run: Run, page: Page) -> None:
    """A cone between flat ends: Michell's displacements prescribed there, then rigid ends."""
    shaft, simple = cone(HALF_ANGLE), elementary(HALF_ANGLE)
    refinements = (1, 2) if run.quick else (1, 2, 3)
    meshes = [run.timed("mesh and solve", solved, shaft, r) for r in refinements]
    with run.step("bounds from the meridian"):
        bounds = torsion_bounds(shaft, G, RADII[0] / (2 if run.quick else 3), 2)
        sweep = [too_stiff(angle) for angle in (QUICK_ANGLES if run.quick else ANGLES)]
    before, best = meshes[-2:]
    width = bounds.half_width / bounds.middle
    shortfall = 4 * parabola_shortfall(best[TURN])
    arcs = f"{best[TURN]} parabolic arcs round a turn: J is {shortfall:.2g} too low, and three "
    arcs += "times that is allowed, since the elements do not contain this field"
    of_ends, within = "as for the torque, and the bounds' own width", 3 * shortfall
    band = {key: solid_shafts.mesh_band(refinements, column(meshes, key)) for key in (TAKEN, RIGID)}
    target = Target(TAKEN, TORQUE, within, arcs, MICHELL, measure="stiffness")
    page.meets(best[TAKEN], target, band[TAKEN])
    page.vanishes(
        "largest difference from Michell's displacements, relative to the largest",
        best[ERROR],
        within=within,
        why="as for the torque",
        source="Michell 1899, u_t = -r / R^3",
        measure="deflection",
        band=abs(best[ERROR] - before[ERROR]),
    )
    rigid = Target(RIGID, bounds.middle, within + width, of_ends, BOUNDS)
    page.meets(best[RIGID], rigid, band[RIGID])
    title = "excess of the upper bound over 1 / integral of dx / GJ"
    check_plane_sections(page, title, bounds, simple)
    page.equals(
        f"1 / integral of dx / GJ at a half angle of {HALF_ANGLE:g} degrees [N m/rad]",
        simple,
        bounds.middle,
        within=float(np.tan(np.radians(HALF_ANGLE)) ** 2) * 5 / 3,
        why="of a complete cone between spheres the integral is 5/3 a^2 too stiff to first order "
        "in the half angle a; flat rigid ends stiffen the cone, so it is less",
        source="between two bounds from the meridian",
    )
    excess = 100 * (simple / bounds.middle - 1)
    page.answer(
        f"The solid cone meets Michell's torque to {best['torque']:.1g} and his displacements to "
        f"{best[ERROR]:.1g}. Between rigid flat ends the integral of dx / GJ is "
        f"{excess:.2f} % too stiff at a half angle of {HALF_ANGLE:g} degrees."
    )
    page.section("Cone")
    show_inputs(
        page,
        ("radius at the thin end", RADII[0], "m"),
        ("radius at the thick end", RADII[1], "m"),
        ("half angle of the cone", HALF_ANGLE, "degrees"),
        ("length", shaft.length, "m", "of these"),
        steel=STEEL,
    )
    title = "How much too stiff the integral of dx / GJ is: against rigid flat ends, and against "
    title += "Michell's cone between spheres through the ends' centres"
    curves = {FLAT: FLAT, SPHERES: SPHERES}
    page.sweep(title, sweep, ANGLE, curves, axis="too stiff by [%]", table=False)
    title, curves = "Convergence on Michell's field", {"torque": "torque", ERROR: ERROR}
    page.sweep(title, meshes, UNKNOWNS, curves, log="xy", axis="relative error", table=False)
    page.table(
        "Stiffness between rigid flat ends [N m/rad]",
        [
            ("1 / integral of dx / GJ", simple, None),
            ("two bounds", bounds.middle, bounds.half_width),
            ("three dimensions", best[RIGID], band[RIGID]),
        ],
        ["by", "stiffness", "half width of bounds or band"],
    )
    page.text(
        "On a complete cone, u_t / r is constant on spheres about the apex, and the surface is "
        "free of stress whatever the angle. With these displacements on its flat ends the solid "
        "must find them inside."
    )
    page.data("series_too_stiff_percent", excess)
