"""Shaft on two simple supports: closed forms, frame and solid."""

import numpy as np

from fe_drivetrain.beam import Beam, BeamSection, BeamSolution, Support, solve
from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
from fe_drivetrain.common import Floats
from fe_drivetrain.report import trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import Page, Record, Run, Target
from fe_drivetrain.validation import solid_shafts
from fe_drivetrain.validation.shaft_theory import (
    Spring,
    Tube,
    evenly_loaded_shear,
    macaulay,
    parabola_shortfall,
)

STEEL = MATERIALS["steel"]
OUTER, LENGTH = 0.4, 2.4
TUBE = Tube(OUTER, 0.0, LENGTH, STEEL)
FORCE, MOMENT, GRAVITY = 1e6, 1e6, -9.80665  # N, N m, m/s^2
WEIGHT = STEEL.density * TUBE.area * GRAVITY  # N/m
STATIONS = [0.0, LENGTH / 4, LENGTH / 2, 3 * LENGTH / 4, LENGTH]
MIDDLE = 2

AT_MIDDLE, AT_END, OWN = "force at mid span", "moment at the end", "own weight"
#: For `macaulay`: station, force and moment of the load, and load per length.
LOADS: dict[str, tuple[list[tuple[float, float, float]], float]] = {
    AT_MIDDLE: ([(LENGTH / 2, FORCE, 0.0)], 0.0),
    AT_END: ([(LENGTH, 0.0, -MOMENT)], 0.0),
    OWN: ([], WEIGHT),
}

FRAME, EVEN, SOLID = "frame", "beam, evenly loaded", "solid"


def closed_forms() -> dict[str, float]:
    """Deflection at mid span, with shear [m]."""
    L, EI, kGA = LENGTH, TUBE.EI, TUBE.kGA
    return {
        AT_MIDDLE: FORCE * (L**3 / (48 * EI) + L / (4 * kGA)),
        AT_END: MOMENT * L**2 / (16 * EI),
        OWN: WEIGHT * (5 * L**4 / (384 * EI) + L**2 / (8 * kGA)),
    }


def macaulay_deflection(name: str, kGA: float, at: float | Floats) -> Floats:
    """Deflection [m] of the beam by Macaulay's brackets."""
    loads, per_length = LOADS[name]
    ends = [Spring(0.0, np.inf), Spring(LENGTH, np.inf)]
    return macaulay(LENGTH, TUBE.EI, kGA, ends, loads, at, per_length).deflection


def by_frame() -> dict[str, BeamSolution]:
    """The library's frame under each load."""
    rigid, at = np.inf, [LENGTH / 2, LENGTH]
    beam = Beam(
        [BeamSection(LENGTH, OUTER)],
        [
            Support("upwind", 0.0, (rigid, rigid, rigid, rigid, 0, 0)),
            Support("downwind", LENGTH, (0, rigid, rigid, 0, 0, 0)),
        ],
        material=STEEL,
    )
    force, moment, none = np.zeros((3, 2, 6))
    force[0, 2], moment[1, 4] = FORCE, MOMENT
    return {
        AT_MIDDLE: solve(beam, at, force, STATIONS),
        AT_END: solve(beam, at, moment, STATIONS),
        OWN: solve(beam, at, none, STATIONS, (0.0, 0.0, GRAVITY)),
    }


def by_solid(refinement: int) -> tuple[int, dict[str, solid_shafts.Supported]]:
    """Elements round a turn of a mesh, and the solid under each load."""
    mesh = solid_shafts.solid(solid_shafts.straight(STATIONS, OUTER), refinement)
    C = solid_shafts.sectional_compliance(mesh, STEEL, STATIONS)
    stiffness, force, moment, none = np.zeros((4, len(STATIONS), 2))
    stiffness[[0, -1], 0] = np.inf
    force[MIDDLE, 0], moment[-1, 1] = FORCE, MOMENT
    return mesh.per_turn, {
        AT_MIDDLE: solid_shafts.on_springs(C, stiffness, force),
        AT_END: solid_shafts.on_springs(C, stiffness, moment),
        OWN: solid_shafts.on_springs(C, stiffness, none, GRAVITY),
    }


@case(
    "Shaft on two simple supports: closed forms, frame and solid",
    source="Closed forms with shear: F L^3 / 48EI + F L / 4kGA, M L^2 / 16EI, "
    "5 q L^4 / 384EI + q L^2 / 8kGA",
)
def run(run: Run, page: Page) -> None:
    """A force at mid span, a moment at an end, and the shaft's weight."""
    frames = run.timed("frame", by_frame)
    refinements = (1, 2) if run.quick else (1, 2, 3)
    with run.step("mesh and solve"):
        meshes = [by_solid(refinement) for refinement in refinements]
    turn = meshes[-1][0]
    rows = []
    for name, closed in closed_forms().items():
        series = [solids[name] for _, solids in meshes]
        rows.append(check(page, name, closed, frames[name], series, refinements, turn))
    differences = {row["load"]: row[SOLID] / row[FRAME] - 1 for row in rows}
    page.answer(
        "The frame meets the closed forms with shear to round-off. The solid, held and loaded "
        "through the mean motions of its sections, differs from it by "
        + ", ".join(f"{100 * d:+.3f} % ({name})" for name, d in differences.items())
        + f" at L = {LENGTH / OUTER:g} D."
    )
    page.section("Simple supports")
    show_inputs(
        page,
        ("diameter, solid", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
        ("span", LENGTH, "m", "chosen"),
        ("force at mid span", FORCE / 1e6, "MN", "chosen"),
        ("moment at the downwind end", MOMENT / 1e6, "MN m", "chosen"),
        ("gravity", GRAVITY, "m/s^2", "standard"),
        ("density", STEEL.density, "kg/m^3", "steel, assumed"),
        *steel_rows(STEEL),
    )
    fine = np.linspace(0.0, LENGTH, 81)
    traces = []
    for name in LOADS:
        curve = macaulay_deflection(name, TUBE.kGA, fine)
        size = np.abs(curve).max()
        found = meshes[-1][1][name].motions[:, 0]
        traces += [
            trace(f"{name}, beam", fine, curve / size),
            trace(f"{name}, solid", STATIONS, found / size, True),
        ]
    page.chart(
        "Deflection over its largest: Macaulay's beam with shear, and the means of the solid's "
        "sections",
        traces,
        "x [m]",
        "deflection over the largest",
    )
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


def check(
    page: Page,
    name: str,
    closed: float,
    frame: BeamSolution,
    solids: list[solid_shafts.Supported],
    refinements: tuple[int, ...],
    turn: int,
) -> Record:
    """Deflection of frame and solid, and the reaction, under one load."""
    section = 2 * 4 * parabola_shortfall(turn)
    local = solid_shafts.local_compliance(TUBE)
    # of the force and of its two reactions; a moment's reactions move both ends by the same
    # amount, and the weight's are half of it each
    slack = {
        AT_MIDDLE: FORCE * local * 1.5,
        AT_END: MOMENT / LENGTH * local,
        OWN: abs(WEIGHT) * LENGTH / 2 * local,
    }[name]
    of_frame = float(frame.displacements[MIDDLE, 2])
    even = float(macaulay_deflection(name, evenly_loaded_shear(TUBE), LENGTH / 2)[0])
    by_mesh = [float(s.motions[MIDDLE, 0]) for s in solids]
    band = solid_shafts.mesh_band(refinements, by_mesh)
    title, within = f"{name}: deflection at mid span", section + slack / abs(closed)
    exact = "the frame's sections are exact: round-off"
    evenly = f"{turn} parabolic arcs round a turn; and loads that enter evenly over a section, "
    evenly += f"{solid_shafts.LOCAL:.0%} of what one diameter shears"
    brackets = "Macaulay's brackets with shear of evenly loaded sections (Hutchinson 2001, as "
    brackets += "quoted by Stephen 2001; derived again)"
    sheared = "closed form with shear"
    page.meets(of_frame, Target(f"{title}, frame [m]", closed, 1e-10, exact, sheared))
    page.meets(by_mesh[-1], Target(f"{title}, solid [m]", even, within, evenly, brackets), band)
    reactions = [float(s.reactions[-1, 0]) for s in solids]
    of_mesh = name == OWN
    page.equals(
        f"{name}: reaction of the downwind support, solid [N]",
        reactions[-1],
        -float(frame.reaction("downwind")[2]),
        within=section if of_mesh else 1e-7,
        why="statically determinate: "
        + ("the meshed section's weight" if of_mesh else "round-off of the solver"),
        source="Timoshenko frame of the library",
        # the mesh enters the reaction by its weight only
        band=solid_shafts.mesh_band(refinements, reactions) if of_mesh else None,
    )
    return {
        "load": name,
        "closed form": closed,
        FRAME: of_frame,
        EVEN: even,
        SOLID: by_mesh[-1],
        "band of the solid": band,
    }
