"""Shaft on two simple supports: closed forms, frame and solid."""

from typing import NamedTuple

import numpy as np

from fe_drivetrain.beam import Beam, BeamSection, BeamSolution, Support, solve
from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs
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
WEIGHT = STEEL.density * TUBE.area * GRAVITY * LENGTH  # N
STATIONS = [0.0, LENGTH / 4, LENGTH / 2, 3 * LENGTH / 4, LENGTH]
MIDDLE, END = 2, 4
RIGID = np.inf
BEAM = Beam(
    [BeamSection(LENGTH, OUTER)],
    [
        Support("upwind", 0.0, (RIGID, RIGID, RIGID, RIGID, 0, 0)),
        Support("downwind", LENGTH, (0, RIGID, RIGID, 0, 0, 0)),
    ],
    material=STEEL,
)
FRAME, EVEN, SOLID = "frame", "beam, evenly loaded", "solid"
BRACKETS = "Macaulay's brackets with shear of evenly loaded sections (Hutchinson 2001, as "
BRACKETS += "quoted by Stephen 2001; derived again)"


class Load(NamedTuple):
    """A load.

    Attributes
    ----------
    station : int
        Where force and moment act.
    force, moment : float
        Along z [N] and about y [N m].
    gravity : float
        Along z [m/s^2].
    closed : float
        Deflection at mid span in closed form, with shear [m].
    local : float
        The force of load and supports that enters evenly, and moves mid span [N].
    """

    station: int
    force: float
    moment: float
    gravity: float
    closed: float
    local: float

    def macaulay(self, kGA: float, at: float | Floats) -> Floats:
        """Deflection [m] of the beam by Macaulay's brackets."""
        ends = [Spring(0.0, RIGID), Spring(LENGTH, RIGID)]
        load = [(STATIONS[self.station], self.force, -self.moment)]
        weight = STEEL.density * TUBE.area * self.gravity
        return macaulay(LENGTH, TUBE.EI, kGA, ends, load, at, weight).deflection

    def frame(self) -> BeamSolution:
        """The library's frame."""
        load = np.array([0.0, 0.0, self.force, 0.0, self.moment, 0.0])
        return solve(BEAM, STATIONS[self.station], load, STATIONS, (0.0, 0.0, self.gravity))

    def solid(self, C: solid_shafts.Compliance) -> solid_shafts.Supported:
        """A solid of that compliance."""
        stiffness, at = np.zeros((2, len(STATIONS), 2))
        stiffness[[0, -1], 0] = RIGID
        at[self.station] = self.force, self.moment
        return solid_shafts.on_springs(C, stiffness, at, self.gravity)


BENT, SHEARED = LENGTH**3 / TUBE.EI, LENGTH / TUBE.kGA  # m/N
#: A moment's reactions move both ends by the same amount, and the weight's are half of it each.
LOADS = {
    "force at mid span": Load(
        MIDDLE, FORCE, 0.0, 0.0, FORCE * (BENT / 48 + SHEARED / 4), 1.5 * FORCE
    ),
    "moment at the end": Load(END, 0.0, MOMENT, 0.0, MOMENT / LENGTH * BENT / 16, MOMENT / LENGTH),
    "own weight": Load(
        MIDDLE, 0.0, 0.0, GRAVITY, WEIGHT * (5 * BENT / 384 + SHEARED / 8), abs(WEIGHT) / 2
    ),
}


def meshed(refinement: int) -> tuple[int, solid_shafts.Compliance]:
    """Elements round a turn of a mesh, and how its sections move."""
    mesh = solid_shafts.solid(solid_shafts.straight(STATIONS, OUTER), refinement)
    return mesh.per_turn, solid_shafts.sectional_compliance(mesh, STEEL, STATIONS)


@case(
    "Shaft on two simple supports: closed forms, frame and solid",
    source="Closed forms with shear: F L^3 / 48EI + F L / 4kGA, M L^2 / 16EI, "
    "5 q L^4 / 384EI + q L^2 / 8kGA",
)
def run(run: Run, page: Page) -> None:
    """A force at mid span, a moment at an end, and the shaft's weight."""
    refinements = (1, 2) if run.quick else (1, 2, 3)
    meshes = [run.timed("mesh and solve", meshed, refinement) for refinement in refinements]
    turn, finest = meshes[-1]
    rows = []
    for name, load in LOADS.items():
        solids = [load.solid(C) for _, C in meshes]
        rows.append(check(page, name, load, solids, refinements, turn))
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
        ("span", LENGTH, "m"),
        ("force at mid span", FORCE / 1e6, "MN"),
        ("moment at the downwind end", MOMENT / 1e6, "MN m"),
        ("gravity", GRAVITY, "m/s^2", "standard"),
        ("density", STEEL.density, "kg/m^3", "steel, assumed"),
        steel=STEEL,
    )
    fine = np.linspace(0.0, LENGTH, 81)
    traces = []
    for name, load in LOADS.items():
        curve, found = load.macaulay(TUBE.kGA, fine), load.solid(finest).motions[:, 0]
        size = np.abs(curve).max()
        traces.append(trace(f"{name}, beam", fine, curve / size))
        traces.append(trace(f"{name}, solid", STATIONS, found / size, True))
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


def check(
    page: Page,
    name: str,
    load: Load,
    solids: list[solid_shafts.Supported],
    refinements: tuple[int, ...],
    turn: int,
) -> Record:
    """Deflection of frame and solid, and the reaction, under one load."""
    section, frame = 2 * 4 * parabola_shortfall(turn), load.frame()
    slack = load.local * solid_shafts.local_compliance(TUBE)
    of_frame = float(frame.displacements[MIDDLE, 2])
    even = float(load.macaulay(evenly_loaded_shear(TUBE), LENGTH / 2)[0])
    by_mesh = [float(s.motions[MIDDLE, 0]) for s in solids]
    reactions = [float(s.reactions[-1, 0]) for s in solids]
    band = solid_shafts.mesh_band(refinements, by_mesh)
    title, within = f"{name}: deflection at mid span", section + slack / abs(load.closed)
    exact, sheared = "the frame's sections are exact: round-off", "closed form with shear"
    evenly = f"{turn} parabolic arcs round a turn; and loads that enter evenly over a section, "
    evenly += f"{solid_shafts.LOCAL:.0%} of what one diameter shears"
    page.meets(of_frame, Target(f"{title}, frame [m]", load.closed, 1e-10, exact, sheared))
    page.meets(by_mesh[-1], Target(f"{title}, solid [m]", even, within, evenly, BRACKETS), band)
    title, why = f"{name}: reaction of the downwind support, solid [N]", "statically determinate: "
    by_frame, timoshenko = -float(frame.reaction("downwind")[2]), "Timoshenko frame of the library"
    if load.gravity:  # the mesh enters the reaction by its weight only
        why += "the meshed section's weight"
        weight = Target(title, by_frame, section, why, timoshenko)
        page.meets(reactions[-1], weight, solid_shafts.mesh_band(refinements, reactions))
    else:
        why += "round-off of the solver"
        page.meets(reactions[-1], Target(title, by_frame, 1e-7, why, timoshenko))
    return {
        "load": name,
        "closed form": load.closed,
        FRAME: of_frame,
        EVEN: even,
        SOLID: by_mesh[-1],
        "band of the solid": band,
    }
