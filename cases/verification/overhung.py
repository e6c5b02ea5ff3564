"""Overhung shaft on two supports, as of a rotor: closed forms, frame and solid."""

import numpy as np

from fe_drivetrain.beam import Beam, BeamSection, Support, pinned_reaction, solve
from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
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
OUTER, OVERHANG, SPAN = 0.4, 2.145, 2.615
LENGTH = OVERHANG + SPAN
TUBE = Tube(OUTER, 0.0, LENGTH, STEEL)
STATIONS = [0.0, OVERHANG, OVERHANG + SPAN / 2, LENGTH]
SUPPORTS = [Spring(OVERHANG, np.inf), Spring(LENGTH, np.inf)]
#: Force along z [N] and moment about y [N m] at the hub.
LOADS = {"force": (1e6, 0.0), "moment": (0.0, 1e6)}
RIGID = np.inf
BEAM = Beam(
    [BeamSection(LENGTH, OUTER)],
    [
        Support("bearing", OVERHANG, (RIGID, RIGID, RIGID, 0, 0, 0)),
        Support("gearbox", LENGTH, (0, RIGID, RIGID, RIGID, 0, 0)),
    ],
    material=STEEL,
)
#: What is judged at the hub: name, component of a section's motion and of the frame's, unit.
MOTIONS = (("deflection", 0, 2, "m"), ("rotation", 1, 4, "rad"))
SHEARED = "closed form with shear"
STATICS = "statics: Stirling 2023, Eq 3.1, (M + (L1 + L2) B) / L2"
BRACKETS = "Macaulay's brackets with shear of evenly loaded sections (Hutchinson 2001)"


def closed_forms() -> dict[str, tuple[float, float]]:
    """Deflection [m] and rotation [rad] of the hub; a moment about y lifts what is upwind of it."""
    a, L, EI, kGA = OVERHANG, SPAN, TUBE.EI, TUBE.kGA
    cross = 1e6 * (a**2 / (2 * EI) + a * L / (3 * EI) + a / (L * kGA))
    return {
        "force": (1e6 * (a**2 * (a + L) / (3 * EI) + a / kGA + a**2 / (L * kGA)), cross),
        "moment": (cross, 1e6 * (a / EI + L / (3 * EI) + 1 / (L * kGA))),
    }


def solids(refinement: int) -> tuple[int, dict[str, solid_shafts.Supported]]:
    """Arcs round a turn of a mesh, and the solid under each load."""
    shaft = solid_shafts.straight(STATIONS, OUTER)
    mesh = solid_shafts.solid(shaft, refinement, size=2.75 * OUTER)
    C = solid_shafts.sectional_compliance(mesh, STEEL, STATIONS)
    stiffness, none = np.zeros((2, len(STATIONS), 2))
    stiffness[[1, 3], 0] = RIGID
    hub = np.arange(len(STATIONS))[:, None] == 0
    return mesh.per_turn, {
        name: solid_shafts.on_springs(C, stiffness, np.where(hub, load, none))
        for name, load in LOADS.items()
    }


@case(
    "Overhung shaft on two supports: closed forms, frame and solid",
    source="Closed forms with shear; dimensions of Stirling 2023, Table 3.1",
)
def run(run: Run, page: Page) -> None:
    """A force and a moment at the hub."""
    refinements = (1, 2) if run.quick else (1, 2, 3)
    meshes = [run.timed("mesh and solve", solids, refinement) for refinement in refinements]
    turn, finest = meshes[-1]
    section = 2 * 4 * parabola_shortfall(turn)
    local = solid_shafts.local_compliance(TUBE)
    evenly = f"{turn} parabolic arcs round a turn; and loads that enter evenly over a section, "
    evenly += f"{solid_shafts.LOCAL:.0%} of what one diameter shears"
    rows: list[Record] = []
    traces = []
    for name, (force, moment) in LOADS.items():
        hub = np.array([0.0, 0.0, force, 0.0, moment, 0.0])
        frame = run.timed("frame", solve, BEAM, 0.0, hub, STATIONS)
        bearing, gearbox = (frame.reaction(s) for s in ("bearing", "gearbox"))
        load = [(0.0, force, -moment)]
        at_hub = macaulay(LENGTH, TUBE.EI, evenly_loaded_shear(TUBE), SUPPORTS, load, [0.0])
        even = float(at_hub.deflection[0]), -float(at_hub.slope[0])
        # what each support's local yielding would do to the hub
        lever = np.array([OVERHANG / SPAN, 1 + OVERHANG / SPAN])
        slack = (
            local * (abs(force) * (force != 0) + lever @ np.abs([gearbox[2], bearing[2]])),
            local * (abs(gearbox[2]) + abs(bearing[2])) / SPAN,
        )
        for part, which, component, unit in MOTIONS:
            value = closed_forms()[name][which]
            by_frame = float(frame.displacements[0, component])
            by_mesh = [float(found[name].motions[0, which]) for _, found in meshes]
            band = solid_shafts.mesh_band(refinements, by_mesh)
            title = f"{part} of the hub by a {name}"
            exact, even_value = "the frame's sections are exact: round-off", even[which]
            within = float(section + slack[which] / abs(value))
            frame_target = Target(f"{title}, frame [{unit}]", value, 1e-10, exact, SHEARED)
            solid_target = Target(f"{title}, solid [{unit}]", even_value, within, evenly, BRACKETS)
            page.meets(by_frame, frame_target)
            page.meets(by_mesh[-1], solid_target, band)
            rows.append(
                {
                    "quantity": f"{part} by a {name}",
                    "closed form": value,
                    "frame": by_frame,
                    "solid": by_mesh[-1],
                    "band of the solid": band,
                }
            )
        statics = float(pinned_reaction(force, moment, OVERHANG, SPAN))
        left = "what the iterations leave of the solid's balance"
        by_solid = -float(finest[name].reactions[1, 0])
        for who, value, within, why in (
            ("frame", float(bearing[2]), 1e-10, "round-off of a few equations"),
            ("solid", by_solid, 1e-7, left),
        ):
            title, why = f"load on the bearing by a {name}", f"statically determinate: {why}"
            page.meets(value, Target(f"{title}, {who} [N]", statics, within, why, STATICS))
        fine = np.linspace(0.0, LENGTH, 96)
        curve = macaulay(LENGTH, TUBE.EI, TUBE.kGA, SUPPORTS, load, fine).deflection
        traces += [
            trace(f"{name}, beam", fine, 1e3 * curve),
            trace(f"{name}, solid", STATIONS, 1e3 * finest[name].motions[:, 0], True),
        ]
    met = ", ".join(f"{r['quantity']} {100 * (r['solid'] / r['frame'] - 1):+.3f} %" for r in rows)
    page.answer(f"The frame meets the closed forms with shear, and the solid the frame: {met}.")
    page.section("Overhung shaft")
    show_inputs(
        page,
        ("diameter, solid", OUTER, "m", "Stirling 2023, Table 3.1"),
        ("overhang L1, hub to bearing", OVERHANG, "m", "Stirling 2023, Table 3.1"),
        ("span L2, bearing to gearbox", SPAN, "m", "Stirling 2023, Table 3.1"),
        ("supports", "rigid, free to turn", "", "chosen: determinate"),
        ("force and moment at the hub", 1, "MN, MN m", "chosen"),
        *steel_rows(STEEL),
    )
    title = "Deflection: Macaulay's beam with shear, and the means of the solid's sections"
    page.chart(title, traces, "x from the hub [m]", "u_z [mm]")
    page.table("Hub [m, rad]", rows)
    page.text(
        "Both cross terms, deflection by a moment and rotation by a force, are one number, as "
        "Maxwell's theorem demands."
    )
    page.data("hub [m, rad]", rows)
