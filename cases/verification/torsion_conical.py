"""Torsion of a conical shaft: Michell's exact field, and the integral of dx / GJ."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Radii at the ends [m] and half angle of the cone [degrees].
RADII, HALF_ANGLE = (0.15, 0.3), 10.0
ANGLES = (2.5, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0)
QUICK_ANGLES = (5.0, 10.0, 20.0, 30.0)


def run(run: Run) -> Any:
    """A cone between flat ends: Michell's displacements prescribed there, then rigid ends."""
    import numpy as np

    from fe_drivetrain.cases.verification import shaft_inputs
    from fe_drivetrain.geometry import Section as Length
    from fe_drivetrain.geometry import Shaft
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import MATERIALS
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation import (
        solid_shafts,
    )
    from fe_drivetrain.validation.shaft_theory import (
        michell_torque,
        parabola_shortfall,
    )
    from fe_drivetrain.validation.torsion_meridian import (
        torsion_bounds,
    )

    steel = MATERIALS["steel"]
    G = steel.shear_modulus

    def cone(degrees: float) -> Shaft:
        start, end = (r / np.tan(np.radians(degrees)) for r in RADII)
        return Shaft(
            front=float(start),
            sections=(
                Length(
                    length=float(end - start),
                    outer_diameter=2 * RADII[0],
                    outer_diameter_end=2 * RADII[1],
                ),
            ),
        )

    def elementary(degrees: float) -> float:
        """1 over the integral of dx / GJ, in closed form."""
        tangent = np.tan(np.radians(degrees))
        integral = (RADII[0] ** -3 - RADII[1] ** -3) / (3 * tangent)
        return float(G * np.pi / 2 / integral)

    shaft = cone(HALF_ANGLE)
    scale = 1e-3 * RADII[0] ** 3
    torque = scale * michell_torque(np.radians(HALF_ANGLE), G)
    refinements = (1, 2) if run.quick else (1, 2, 3)
    torques, errors, rigid, unknowns = [], [], [], []
    for refinement in refinements:
        with run.step("mesh and solve"):
            mesh = solid_shafts.solid(shaft, refinement, size=shaft.length / 2)
            R = np.linalg.norm(mesh.points, axis=1)
            field = solid_shafts.rotation_of(mesh.points, -scale / R**3)
            ends = np.concatenate([mesh.section_nodes(x) for x in (mesh.front, mesh.rear)])
            found = solve_solid(
                mesh.points,
                mesh.cells,
                steel.lame,
                [],
                np.zeros(mesh.n_unknowns),
                solid_shafts.prescribed_on(mesh, ends, field),
            )
            torques.append(solid_shafts.axial_torque(mesh, found))
            rigid.append(solid_shafts.twist(mesh, steel)[1])
        difference = np.abs(found.u[:, 0] - field.ravel()).max() / np.abs(field).max()
        errors.append(float(difference))
        unknowns.append(mesh.n_unknowns)
    turn = mesh.per_turn
    by_torque = solid_shafts.mesh_band(refinements, torques)
    by_rigid = solid_shafts.mesh_band(refinements, rigid)
    shortfall = 4 * parabola_shortfall(turn)
    with run.step("bounds from the meridian"):
        bounds = torsion_bounds(shaft, G, RADII[0] / (2 if run.quick else 3), 2)
        angles = QUICK_ANGLES if run.quick else ANGLES
        others = [torsion_bounds(cone(a), G, RADII[0] / 2, 2) for a in angles]
    simple = np.array([elementary(a) for a in angles])
    middle = np.array([b.middle for b in others])
    spheres = []
    for a in np.radians(angles):
        # as long as the flat-ended cone on its axis: spheres through the centres of its ends
        near, far = (r / np.tan(a) for r in RADII)
        spheres.append(michell_torque(float(a), G) / (near**-3 - far**-3))
    too_stiff = 100 * (elementary(HALF_ANGLE) / bounds.middle - 1)
    verdicts = [
        judge(
            "torque of Michell's displacements on the ends",
            torques[-1],
            torque,
            tolerance=3 * shortfall,
            unit="N m",
            source="Michell 1899: 2 pi G (2 - 3 cos a + cos^3 a) for u_t = -r / R^3",
            reason=f"{turn} parabolic arcs round a turn: J is {shortfall:.2g} too low, and three "
            "times that is allowed, since the field is none of the element's here",
            measure="stiffness",
            band=by_torque,
        ),
        judge(
            "largest difference from Michell's displacements, relative to the largest",
            errors[-1],
            0.0,
            tolerance=3 * shortfall,
            relative=False,
            source="Michell 1899, u_t = -r / R^3",
            reason="as for the torque",
            measure="deflection",
            band=abs(errors[-1] - errors[-2]),
        ),
        judge(
            "stiffness between rigid flat ends",
            rigid[-1],
            bounds.middle,
            tolerance=3 * shortfall + bounds.half_width / bounds.middle,
            unit="N m/rad",
            source="between two bounds from the meridian (displacements; torsion function)",
            reason="as for the torque, and the bounds' own width",
            measure="stiffness",
            band=by_rigid,
        ),
        judge(
            "excess of the upper bound over 1 / integral of dx / GJ, where there is one",
            max(0.0, bounds.upper / elementary(HALF_ANGLE) - 1.0),
            0.0,
            tolerance=1e-9,
            relative=False,
            source="plane sections are one of the displacements over which the energy is least",
            reason="none is allowed but round-off",
            measure="identity",
        ),
        judge(
            f"1 / integral of dx / GJ at a half angle of {HALF_ANGLE:g} degrees",
            elementary(HALF_ANGLE),
            bounds.middle,
            tolerance=float(np.tan(np.radians(HALF_ANGLE)) ** 2) * 5 / 3,
            unit="N m/rad",
            source="between two bounds from the meridian",
            reason="of a complete cone between spheres the integral is 5/3 a^2 too stiff to first "
            "order in the half angle a; flat rigid ends stiffen the cone, so it is less",
            measure="stiffness",
        ),
    ]
    return CASE.results(
        run,
        summary=[
            f"The solid cone meets Michell's torque to {abs(torques[-1] / torque - 1):.1g} and his "
            f"displacements to {errors[-1]:.1g}. Between rigid flat ends the integral of dx / GJ "
            f"is {too_stiff:.2f} % too stiff at a half angle of {HALF_ANGLE:g} degrees.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Cone",
                items=[
                    shaft_inputs.inputs(
                        ("radius at the thin end", RADII[0], "m", "chosen"),
                        ("radius at the thick end", RADII[1], "m", "chosen"),
                        ("half angle of the cone", HALF_ANGLE, "degrees", "chosen"),
                        ("length", shaft.length, "m", "of these"),
                        *shaft_inputs.steel_rows(steel),
                    ),
                    chart(
                        "How much too stiff the integral of dx / GJ is: against rigid flat ends, "
                        "and against Michell's cone between spheres through the ends' centres",
                        [
                            trace("rigid flat ends", angles, 100 * (simple / middle - 1)),
                            trace("spheres", angles, 100 * (simple / np.array(spheres) - 1)),
                        ],
                        "half angle [degrees]",
                        "too stiff by [%]",
                    ),
                    chart(
                        "Convergence on Michell's field",
                        [
                            trace("torque", unknowns, np.abs(np.array(torques) / torque - 1)),
                            trace("displacement, largest", unknowns, errors),
                        ],
                        "unknowns",
                        "relative error",
                        ("x", "y"),
                    ),
                    Table(
                        caption="Stiffness between rigid flat ends [N m/rad]",
                        columns=["by", "stiffness", "half width of bounds or band"],
                        rows=[
                            ["1 / integral of dx / GJ", elementary(HALF_ANGLE), None],
                            ["two bounds", bounds.middle, bounds.half_width],
                            ["three dimensions", rigid[-1], by_rigid],
                        ],
                    ),
                    Text(
                        text="On a complete cone, u_t / r is constant on spheres about the apex, "
                        "and the surface is free of stress whatever the angle. With these "
                        "displacements on its flat ends the solid must find them inside."
                    ),
                ],
            )
        ],
        figures={"series_too_stiff_percent": too_stiff},
    )


CASE = Case(
    name="verification/torsion_conical",
    title="Torsion of a conical shaft: Michell's exact field, and the integral of dx / GJ",
    source="Michell 1899; Timoshenko and Goodier, Theory of Elasticity, article 119 (3rd edition)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
