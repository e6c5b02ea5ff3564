"""Spherical joint between two elastic shells, each of its forms against the exact solution."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.spherical_shells import (
    AXIS,
    JOINTS,
    Joint,
    Mesh,
    Moved,
    Pressed,
    Shell,
    core_stiffness,
    cut_open,
    displaced_core,
    mesh_of,
    move_core,
    press,
    squeezed,
    turning_stiffness,
)
from fe_drivetrain.comparison import grid_convergence
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.report import Measure, trace
from fe_drivetrain.report.number_text import certain_value, percent_text
from fe_drivetrain.report.suite import Page, Run

#: Radii of core, joint and outside [m]: those of a main bearing's ring and housing.
CORE, JOINT, OUTSIDE = 0.2, 0.3, 0.41
STEEL = Material(youngs_modulus=200e9, poisson_ratio=0.3, density=0.0)
DUCTILE_IRON = Material(youngs_modulus=169e9, poisson_ratio=0.275, density=0.0)
INNER = Shell(CORE, JOINT, STEEL.lame)
OUTER = Shell(JOINT, OUTSIDE, DUCTILE_IRON.lame)
PRESSURE = 1e6  # Pa

ALONG_RADIUS = "Displacement along the motion, on the radius at right angles to it, core moved by "
ALONG_RADIUS += "1: lines exact, points the finest mesh"

#: Elements along a quarter of a turn, and through each shell.
LEVELS = ((1, 1), (2, 2), (4, 4))
QUICK_LEVELS = ((1, 1), (2, 1), (3, 2))

COLOURS: dict[Joint, str] = {
    "sliding": "#0072b2",
    "averaged": "#009e73",
    "rigid": "#d55e00",
    "bonded": "#1f2933",
}


def solve_all(
    run: Run, levels: Sequence[tuple[int, int]]
) -> tuple[dict[Joint, Mesh], dict[Joint, list[Moved]], list[Pressed]]:
    """The finest meshes, and what moved and pressed cores give on all."""
    moved: dict[Joint, list[Moved]] = {joint: [] for joint in JOINTS}
    pressed: list[Pressed] = []
    for level in levels:
        with run.step(f"{level[0]} elements a quarter turn"):
            separate, whole = (mesh_of(INNER, OUTER, *level, bonded) for bonded in (False, True))
            meshes = {joint: whole if joint == "bonded" else separate for joint in JOINTS}
            for joint, mesh in meshes.items():
                moved[joint].append(move_core(mesh, (INNER, OUTER), joint))
            pressed.append(press(separate, (INNER, OUTER), PRESSURE))
    return meshes, moved, pressed


@case(
    "Spherical joint between elastic shells: all its forms against the exact solution",
    source="Navier's equation in a sphere, solutions of first order (own derivation; the rigid "
    "sphere in an infinite solid is Kelvin's), and Lame 1852 for pressure",
)
def run(run: Run, page: Page) -> None:
    """Move, turn and press the joint on several meshes."""
    levels = QUICK_LEVELS if run.quick else LEVELS
    meshes, moved, pressed = solve_all(run, levels)
    sizes = [1.0 / across for across, _ in levels]
    exact = {joint: core_stiffness(INNER, OUTER, joint) for joint in JOINTS}
    turn = turning_stiffness(INNER, OUTER)
    check(page, sizes, moved, exact, turn)
    check_pressed(page, sizes, pressed)
    errors = {
        joint: [abs(m.stiffness / exact[joint] - 1.0) for m in moved[joint]] for joint in JOINTS
    }
    answer(page, max(e[-1] for e in errors.values()))
    page.say("The three spherical forms carry no moment on any mesh; the bonded one does.")
    page.section("Displaced core")
    show_errors(page, sizes, errors)
    page.chart(
        ALONG_RADIUS,
        [t for j in JOINTS for t in profile(j, meshes[j], moved[j][-1])],
        "radius [m]",
        "displacement along the motion [-]",
    )
    page.table(
        "Stiffness of the core [GN/m]",
        [(j, *(m.stiffness / 1e9 for m in moved[j]), exact[j] / 1e9) for j in JOINTS],
        ["joint", *(f"{a} x {t} elements" for a, t in levels), "exact"],
    )
    show_problem(page)
    for joint in JOINTS:
        computed = [m.stiffness for m in moved[joint]]
        page.data(joint, {"exact": exact[joint], "computed": computed})
    page.image("Half of both shells", run.sketch(cut_open(mesh_of(INNER, OUTER, 4, 2))))


def answer(page: Page, largest: float) -> None:
    """State the stiffness of each joint, and the largest error of all."""
    forms = {
        joint: page.judged(
            f"{joint} joint: stiffness of the core", f"stiffness, {joint} joint", "exact"
        )
        for joint in JOINTS
    }
    found = {joint: certain_value(figure) for joint, figure in forms.items()}
    page.answer(
        "How does the stiffness of a spherical bearing depend on the model of its joint?",
        f"The bearing has {found['sliding']} if its joint slides and {found['bonded']} if it is "
        f"bonded; all {len(forms)} joint models are within {percent_text(largest)} of exact.",
        [
            *forms.values(),
            page.judged(
                "bonded joint: moment of a core that turns",
                "tilt stiffness, bonded joint",
                "exact",
                unit="GN m/rad",
            ),
        ],
        hero=ALONG_RADIUS,
    )


def show_errors(page: Page, sizes: list[float], errors: dict[Joint, list[float]]) -> None:
    """Error of the stiffness over the size of the elements."""
    fourth = [errors["sliding"][-1] * (s / sizes[-1]) ** 4 for s in sizes]
    page.chart(
        "Error of the stiffness of the core against the exact one",
        [
            *(trace(joint, sizes, errors[joint], mode="lines+markers") for joint in JOINTS),
            trace("fourth order", sizes, fourth, line={"dash": "dot"}),
        ],
        "element size, quarters of a turn [-]",
        "relative error [-]",
        ("x", "y"),
    )


def show_problem(page: Page) -> None:
    """What is solved, and how the exact solution is found."""
    page.section("Problem")
    page.text(
        "Two concentric shells meet in a sphere; the inner one is bonded to a rigid core, the "
        "outer one to rigid surroundings. The core is moved along x, turned about an axis along "
        "none of the mesh's directions, or held while pressure acts from outside, where the outer "
        "shell is free. The joint is made by the functions that make the spherical joint of a "
        "drivetrain."
    )
    page.text(
        "Exact: with u_r = f(r) cos(theta), u_theta = g(r) sin(theta), Navier's equation leaves "
        "the powers 0, 2, -1 and -3 of r. Two conditions at the core, two outside and four at the "
        "joint give the eight factors. Sliding: equal f and radial stress, no shear. Averaged: the "
        "traction is the same vector everywhere, and the means of both faces are equal. Rigid: "
        "each face moves as a rigid sphere. Bonded: all equal."
    )
    page.assume(
        "radii of core, joint and outside",
        f"{CORE:g}, {JOINT:g}, {OUTSIDE:g}",
        "m",
        "seat, raceway and shell of the library's main bearing, as spheres",
    )


def band(sizes: list[float], values: list[float]) -> float:
    """Numerical uncertainty of the finest mesh's value."""
    return grid_convergence(sizes, values, expected_order=4.0).uncertainty


def interpolation(sizes: list[float]) -> tuple[float, str]:
    """Allowed relative error of the finest mesh, and why."""
    allowed = float(np.pi / 4 * sizes[-1]) ** 4
    return allowed, (
        "curved quadratic elements leave an error of the order of (h/2)^4, h being their angle of "
        f"{90 * sizes[-1]:g} degrees: {allowed:.1e}"
    )


def check(
    page: Page,
    sizes: list[float],
    moved: dict[Joint, list[Moved]],
    exact: dict[Joint, float],
    turn: float,
) -> None:
    """Stiffness of the core in every joint, and the moment of a core that turns."""
    allowed, why = interpolation(sizes)
    for joint in JOINTS:
        values = [m.stiffness / 1e9 for m in moved[joint]]
        page.equals(
            f"{joint} joint: stiffness of the core [GN/m]",
            values[-1],
            exact[joint] / 1e9,
            within=allowed,
            why=why,
            source="exact, from Navier's equation: the four solutions with one wave round the "
            "sphere",
            measure="stiffness",
            band=band(sizes, values),
        )
    for joint in JOINTS[:-1]:
        moment = max(float(np.abs(m.moments).max()) for m in moved[joint])
        page.vanishes(
            f"{joint} joint: moment of a core that turns, over that of a bonded one",
            moment / turn,
            within=1e-9,
            why="exact in the discrete model, too, on each mesh: round-off of the solver",
            source="a sphere without friction carries no moment",
        )
    values = [float(m.moments @ AXIS) / 1e6 for m in moved["bonded"]]
    page.equals(
        "bonded joint: moment of a core that turns [MN m/rad]",
        values[-1],
        turn / 1e6,
        within=allowed,
        why=why,
        source="exact: shells in series, u = (A r + B / r^2) sin(theta)",
        band=band(sizes, values),
    )


def check_pressed(page: Page, sizes: list[float], pressed: list[Pressed]) -> None:
    """The sliding joint under pressure from outside."""
    lame = squeezed(INNER, OUTER, PRESSURE)
    a, b = lame.outer
    wanted: tuple[tuple[str, str, Measure, list[float], float], ...] = (
        (
            "radial displacement of the outside",
            "µm",
            "deflection",
            [1e6 * p.outside for p in pressed],
            1e6 * (a * OUTSIDE + b / OUTSIDE**2),
        ),
        (
            "radial displacement of the joint",
            "µm",
            "deflection",
            [1e6 * p.joint for p in pressed],
            1e6 * (a * JOINT + b / JOINT**2),
        ),
        (
            "mean contact pressure",
            "MPa",
            "stress",
            [p.contact / 1e6 for p in pressed],
            lame.contact / 1e6,
        ),
    )
    allowed, why = interpolation(sizes)
    for name, unit, measure, values, reference in wanted:
        page.equals(
            f"sliding joint under {PRESSURE / 1e6:g} MPa from outside: {name}",
            values[-1],
            reference,
            within=allowed,
            why=why,
            source="Lame 1852, thick spheres, two of them on a rigid core",
            unit=unit,
            measure=measure,
            band=band(sizes, values),
        )


def profile(joint: Joint, mesh: Mesh, moved: Moved) -> list[Any]:
    """Displacement along x over the radius, on the ray along y: exact and of the nodes."""
    # a gap between the shells: a jump is not a line
    radii: list[float | None] = []
    values: list[float | None] = []
    for wave in displaced_core(INNER, OUTER, joint):
        r = np.linspace(wave.shell.inner, wave.shell.outer, 25)
        u = wave.displacement(np.column_stack([0 * r, r, 0 * r]))[:, 0]
        radii += [*r.tolist(), None]
        values += [*u.tolist(), None]
    colour = {"color": COLOURS[joint]}
    line = trace(f"{joint}, exact", [], [], line=colour)
    ray = (np.abs(mesh.points[:, [0, 2]]).max(axis=1) < 1e-9) & (mesh.points[:, 1] > 0)
    along, u = mesh.points[ray, 1], moved.displacements[ray, 0]
    return [
        line | {"x": radii, "y": values, "connectgaps": False},
        trace(f"{joint}, nodes", along, u, True, marker=colour, showlegend=False),
    ]
