"""The spherical joint between two elastic shells, against the exact answer of each of its forms."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Radii of core, joint and outside [m]: those of a main bearing's ring and housing.
CORE, JOINT, OUTSIDE = 0.2, 0.3, 0.41
INNER = (200e9, 0.3)  # steel
OUTER = (169e9, 0.275)  # ductile iron
PRESSURE = 1e6  # Pa

#: Elements along a quarter of a turn, and through each shell.
LEVELS = ((1, 1), (2, 2), (4, 4))
QUICK_LEVELS = ((1, 1), (2, 1), (3, 2))


def run(run: Run) -> Any:
    """Move, turn and press the joint on several meshes."""
    import numpy as np

    from fe_drivetrain.compare import grid_convergence
    from fe_drivetrain.report import AssumptionRow, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.scene import Material
    from fe_drivetrain.validation.spherical_shells import (
        AXIS,
        JOINTS,
        Moved,
        Pressed,
        Shell,
        core_stiffness,
        displaced_core,
        mesh_of,
        move_core,
        press,
        squeezed,
        turning_stiffness,
    )

    inner, outer = (
        Shell(a, b, Material(youngs_modulus=e, poisson_ratio=nu, density=0.0).lame)
        for a, b, (e, nu) in ((CORE, JOINT, INNER), (JOINT, OUTSIDE, OUTER))
    )
    levels = QUICK_LEVELS if run.quick else LEVELS
    moved: dict[str, list[Moved]] = {joint: [] for joint in JOINTS}
    pressed: list[Pressed] = []
    for across, through in levels:
        with run.step(f"{across} elements a quarter turn"):
            separate, whole = (
                mesh_of(inner, outer, across, through, bonded) for bonded in (False, True)
            )
            for joint in JOINTS:
                mesh = whole if joint == "bonded" else separate
                moved[joint].append(move_core(mesh, (inner, outer), joint))
            pressed.append(press(separate, (inner, outer), PRESSURE))
    sizes = [1.0 / across for across, _ in levels]

    def band(values: list[float]) -> float:
        return grid_convergence(sizes, values, expected_order=4.0).uncertainty

    exact = {joint: core_stiffness(inner, outer, joint) for joint in JOINTS}
    turn = turning_stiffness(inner, outer)
    lame = squeezed(inner, outer, PRESSURE)
    source = "exact, from Navier's equation: the four solutions with one wave round the sphere"
    tolerance = float(np.pi / 4 / levels[-1][0]) ** 4
    reason = (
        f"curved quadratic elements leave an error of the order of (h/2)^4, h being their angle of "
        f"{90 / levels[-1][0]:g} degrees: {(np.pi / 4 / levels[-1][0]) ** 4:.1e}"
    )
    verdicts = []
    for joint in JOINTS:
        values = [m.stiffness / 1e9 for m in moved[joint]]
        verdicts.append(
            judge(
                f"{joint} joint: stiffness of the core",
                values[-1],
                exact[joint] / 1e9,
                tolerance=tolerance,
                unit="GN/m",
                source=source,
                reason=reason,
                measure="stiffness",
                band=band(values),
            )
        )
    for joint in JOINTS[:-1]:
        moment = max(float(np.abs(m.moments).max()) for m in moved[joint])
        verdicts.append(
            judge(
                f"{joint} joint: moment of a core that turns, over that of a bonded one",
                moment / turn,
                0.0,
                tolerance=1e-9,
                relative=False,
                source="a sphere without friction carries no moment",
                reason="exact in the discrete model, too, on each mesh: round-off of the solver",
                measure="identity",
                band=0.0,
            )
        )
    values = [float(m.moments @ AXIS) / 1e6 for m in moved["bonded"]]
    verdicts.append(
        judge(
            "bonded joint: moment of a core that turns",
            values[-1],
            turn / 1e6,
            tolerance=tolerance,
            unit="MN m/rad",
            source="exact: shells in series, u = (A r + B / r^2) sin(theta)",
            reason=reason,
            measure="stiffness",
            band=band(values),
        )
    )
    wanted: list[tuple[str, str, Any, list[float], float]] = [
        (
            "radial displacement of the outside",
            "µm",
            "deflection",
            [1e6 * p.outside for p in pressed],
            1e6 * (lame.outer[0] * OUTSIDE + lame.outer[1] / OUTSIDE**2),
        ),
        (
            "radial displacement of the joint",
            "µm",
            "deflection",
            [1e6 * p.joint for p in pressed],
            1e6 * (lame.outer[0] * JOINT + lame.outer[1] / JOINT**2),
        ),
        (
            "mean contact pressure",
            "MPa",
            "stress",
            [p.contact / 1e6 for p in pressed],
            lame.contact / 1e6,
        ),
    ]
    for name, unit, measure, values, reference in wanted:
        verdicts.append(
            judge(
                f"sliding joint under {PRESSURE / 1e6:g} MPa from outside: {name}",
                values[-1],
                reference,
                tolerance=tolerance,
                unit=unit,
                source="Lame 1852, thick spheres, two of them on a rigid core",
                reason=reason,
                measure=measure,
                band=band(values),
            )
        )

    errors = {
        joint: [abs(m.stiffness / exact[joint] - 1.0) for m in moved[joint]] for joint in JOINTS
    }
    convergence = chart(
        "Error of the stiffness of the core against the exact one",
        [
            *(trace(joint, sizes, errors[joint], mode="lines+markers") for joint in JOINTS),
            trace(
                "fourth order",
                sizes,
                [errors["sliding"][-1] * (s / sizes[-1]) ** 4 for s in sizes],
                line={"dash": "dot"},
            ),
        ],
        "element size, quarters of a turn [-]",
        "relative error [-]",
        logarithmic=("x", "y"),
    )
    profiles = chart(
        "Displacement along the motion, on the radius at right angles to it, core moved by 1: "
        "lines exact, points the finest mesh",
        _profiles(
            {j: displaced_core(inner, outer, j) for j in JOINTS},
            {j: (mesh_of(inner, outer, *levels[-1], j == "bonded"), moved[j][-1]) for j in JOINTS},
            trace,
        ),
        "radius [m]",
        "displacement along the motion [-]",
    )
    worst = max(e[-1] for e in errors.values())
    return CASE.results(
        run,
        summary=[
            f"All four joints have the stiffness of the exact solution within {worst:.1e}: sliding "
            f"{exact['sliding'] / 1e9:.4g}, averaged {exact['averaged'] / 1e9:.4g}, rigid faces "
            f"{exact['rigid'] / 1e9:.4g}, bonded {exact['bonded'] / 1e9:.4g} GN/m.",
            "The three spherical forms carry no moment on any mesh; the bonded one carries "
            f"{turn / 1e9:.4g} GN m/rad.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Displaced core",
                items=[
                    convergence,
                    profiles,
                    Table(
                        caption="Stiffness of the core [GN/m]",
                        columns=["joint", *(f"{a} x {t} elements" for a, t in levels), "exact"],
                        rows=[
                            [j, *(m.stiffness / 1e9 for m in moved[j]), exact[j] / 1e9]
                            for j in JOINTS
                        ],
                    ),
                ],
            ),
            Section(
                title="Problem",
                items=[
                    Text(
                        text="Two concentric shells meet in a sphere; the inner one is bonded to a "
                        "rigid core, the outer one to rigid surroundings. The core is moved along "
                        "x, turned about an axis that is none of the mesh's, or held while "
                        "pressure acts from outside, where the outer shell is free. The joint is "
                        "made by the functions that make the spherical joint of a drivetrain."
                    ),
                    Text(
                        text="Exact: with u_r = f(r) cos(theta), u_theta = g(r) sin(theta), "
                        "Navier's equation leaves the powers 0, 2, -1 and -3 of r. Two conditions "
                        "at the core, two outside and four at the joint give the eight factors. "
                        "Sliding: equal f and radial stress, no shear. Averaged: the traction is "
                        "the same vector everywhere, and the means of both faces are equal. Rigid: "
                        "each face moves as a rigid sphere. Bonded: all equal."
                    ),
                ],
            ),
        ],
        assumptions=[
            AssumptionRow(
                name="radii of core, joint and outside",
                value=f"{CORE:g}, {JOINT:g}, {OUTSIDE:g}",
                unit="m",
                source="seat, raceway and shell of the library's main bearing, as spheres",
            )
        ],
        figures={
            joint: {"exact": exact[joint], "computed": [m.stiffness for m in moved[joint]]}
            for joint in JOINTS
        },
    )


def _profiles(exact: Any, found: Any, trace: Any) -> list[Any]:
    """Displacement along x over the radius, on the ray along y, of each form of the joint."""
    import numpy as np

    colours = {"sliding": "#0072b2", "averaged": "#009e73", "rigid": "#d55e00", "bonded": "#1f2933"}
    curves = []
    for joint, colour in colours.items():
        # a gap between the shells: a jump is not a line
        radii, values = [], []
        for wave in exact[joint]:
            r = np.linspace(wave.shell.inner, wave.shell.outer, 25)
            u = wave.displacement(np.column_stack([0 * r, r, 0 * r]))[:, 0]
            radii += [*r.tolist(), None]
            values += [*u.tolist(), None]
        line = trace(f"{joint}, exact", [], [], line={"color": colour})
        curves.append(line | {"x": radii, "y": values, "connectgaps": False})
        mesh, moved = found[joint]
        ray = (np.abs(mesh.points[:, [0, 2]]).max(axis=1) < 1e-9) & (mesh.points[:, 1] > 0)
        curves.append(
            trace(
                f"{joint}, nodes",
                mesh.points[ray, 1],
                moved.displacements[ray, 0],
                points=True,
                marker={"color": colour},
                showlegend=False,
            )
        )
    return curves


CASE = Case(
    name="verification/sliding_sphere",
    title="Spherical joint between elastic shells: all its forms against the exact solution",
    source="Navier's equation in a sphere, solutions of first order (own derivation; the rigid "
    "sphere in an infinite solid is Kelvin's), and Lame 1852 for pressure",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
