"""Torsion of a conical shaft: Michell's exact field, and the integral of dx / GJ."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
from fe_drivetrain.cases.verification.torsion_bound import BOUNDS, check_plane_sections
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.report import trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import Page, Record, Run, Target, column
from fe_drivetrain.validation import solid_shafts
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
    ends = np.concatenate([mesh.section_nodes(x) for x in (mesh.front, mesh.rear)])
    held = solid_shafts.prescribed_on(mesh, ends, field)
    F = np.zeros(mesh.n_unknowns)
    found = solve_solid(mesh.points, mesh.cells, STEEL.lame, [], F, held)
    difference = np.abs(found.u[:, 0] - field.ravel()).max() / np.abs(field).max()
    return {
        "unknowns": mesh.n_unknowns,
        "per turn": mesh.per_turn,
        "torque [N m]": solid_shafts.axial_torque(mesh, found),
        "error": float(difference),
        "rigid ends [N m/rad]": solid_shafts.twist(mesh, STEEL)[1],
    }


def too_stiff(degrees: float) -> Record:
    """How much too stiff the integral of dx / GJ is [%], by the half angle."""
    simple = elementary(degrees)
    flat = torsion_bounds(cone(degrees), G, RADII[0] / 2, 2).middle
    return {
        ANGLE: degrees,
        FLAT: 100 * (simple / flat - 1),
        SPHERES: 100 * (simple / between_spheres(degrees) - 1),
    }


@case(
    "Torsion of a conical shaft: Michell's exact field, and the integral of dx / GJ",
    source="Michell 1899; Timoshenko and Goodier, Theory of Elasticity, article 119 (3rd edition)",
)
def run(run: Run, page: Page) -> None:
    """A cone between flat ends: Michell's displacements prescribed there, then rigid ends."""
    shaft = cone(HALF_ANGLE)
    refinements = (1, 2) if run.quick else (1, 2, 3)
    with run.step("mesh and solve"):
        meshes = [solved(shaft, refinement) for refinement in refinements]
    with run.step("bounds from the meridian"):
        bounds = torsion_bounds(shaft, G, RADII[0] / (2 if run.quick else 3), 2)
        sweep = [too_stiff(angle) for angle in (QUICK_ANGLES if run.quick else ANGLES)]
    before, best = meshes[-2:]
    shortfall = 4 * parabola_shortfall(best["per turn"])
    torques, rigid = column(meshes, "torque [N m]"), column(meshes, "rigid ends [N m/rad]")
    arcs = f"{best['per turn']} parabolic arcs round a turn: J is {shortfall:.2g} too low, and "
    arcs += "three times that is allowed, since the elements do not contain this field"
    michell = "Michell 1899: 2 pi G (2 - 3 cos a + cos^3 a) for u_t = -r / R^3"
    title = "torque of Michell's displacements on the ends [N m]"
    target = Target(title, TORQUE, 3 * shortfall, arcs, michell, measure="stiffness")
    page.meets(torques[-1], target, solid_shafts.mesh_band(refinements, torques))
    page.vanishes(
        "largest difference from Michell's displacements, relative to the largest",
        best["error"],
        within=3 * shortfall,
        why="as for the torque",
        source="Michell 1899, u_t = -r / R^3",
        measure="deflection",
        band=abs(best["error"] - before["error"]),
    )
    by_rigid = solid_shafts.mesh_band(refinements, rigid)
    title, within = "stiffness between rigid flat ends [N m/rad]", 3 * shortfall
    within += bounds.half_width / bounds.middle
    why = "as for the torque, and the bounds' own width"
    page.meets(rigid[-1], Target(title, bounds.middle, within, why, BOUNDS), by_rigid)
    simple = elementary(HALF_ANGLE)
    check_plane_sections(
        page, "excess of the upper bound over 1 / integral of dx / GJ", bounds, simple
    )
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
        f"The solid cone meets Michell's torque to {abs(torques[-1] / TORQUE - 1):.1g} and his "
        f"displacements to {best['error']:.1g}. Between rigid flat ends the integral of dx / GJ is "
        f"{excess:.2f} % too stiff at a half angle of {HALF_ANGLE:g} degrees."
    )
    page.section("Cone")
    show_inputs(
        page,
        ("radius at the thin end", RADII[0], "m", "chosen"),
        ("radius at the thick end", RADII[1], "m", "chosen"),
        ("half angle of the cone", HALF_ANGLE, "degrees", "chosen"),
        ("length", shaft.length, "m", "of these"),
        *steel_rows(STEEL),
    )
    page.chart(
        "How much too stiff the integral of dx / GJ is: against rigid flat ends, and against "
        "Michell's cone between spheres through the ends' centres",
        [trace(name, column(sweep, ANGLE), column(sweep, name)) for name in (FLAT, SPHERES)],
        ANGLE,
        "too stiff by [%]",
    )
    unknowns = column(meshes, "unknowns")
    page.chart(
        "Convergence on Michell's field",
        [
            trace("torque", unknowns, np.abs(np.array(torques) / TORQUE - 1)),
            trace("displacement, largest", unknowns, column(meshes, "error")),
        ],
        "unknowns",
        "relative error",
        ("x", "y"),
    )
    page.table(
        "Stiffness between rigid flat ends [N m/rad]",
        [
            ("1 / integral of dx / GJ", simple, None),
            ("two bounds", bounds.middle, bounds.half_width),
            ("three dimensions", rigid[-1], by_rigid),
        ],
        ["by", "stiffness", "half width of bounds or band"],
    )
    page.text(
        "On a complete cone, u_t / r is constant on spheres about the apex, and the surface is "
        "free of stress whatever the angle. With these displacements on its flat ends the solid "
        "must find them inside."
    )
    page.data("series_too_stiff_percent", excess)
    page.data("integral of dx / GJ too stiff [%], by half angle", sweep)
