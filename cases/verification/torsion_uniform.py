"""Torsion of a uniform shaft, solid and bored, against GJ / L."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
from fe_drivetrain.operator import nodal_stresses
from fe_drivetrain.report import trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target, column, grouped
from fe_drivetrain.validation import solid_shafts
from fe_drivetrain.validation.shaft_theory import (
    Tube,
    parabola_shortfall,
    parabola_slope,
    recovery_error,
)

STEEL = MATERIALS["steel"]
OUTER, BORES, LENGTH = 0.4, (0.0, 0.28), 0.8  # m
ANGLE = 1e-3  # rad, between the ends

SHAFT, TURN = "shaft", "elements round a turn"
STIFFNESS, MESHED = "torsional stiffness [N m/rad]", "G J / L of the mesh [N m/rad]"
EXACT = "G J / L [N m/rad]"
SHOWN = (SHAFT, TURN, "unknowns", STIFFNESS, MESHED, EXACT)


def twisted(run: Run, tube: Tube, refinement: int) -> Record:
    """The ends turned by an exact rotation, on one mesh."""
    name = "bored" if tube.inner else "solid"
    with run.step(f"{name}: mesh and solve"):
        shaft = solid_shafts.straight((0.0, LENGTH), OUTER, tube.inner)
        mesh = solid_shafts.solid(shaft, refinement, size=LENGTH)
        solution, by_torque, by_energy = solid_shafts.twist(mesh, STEEL, ANGLE)
    with run.step(f"{name}: stress"):
        s = nodal_stresses(mesh.points, mesh.cells, solution.u[:, 0], STEEL.lame)
    middle = mesh.section_nodes(LENGTH / 2)
    r = np.hypot(mesh.points[middle, 1], mesh.points[middle, 2])
    skin = middle[r > 0.5 * OUTER * (1 - 1e-9)]
    exact = tube.GJ / LENGTH
    return {
        SHAFT: name,
        TURN: mesh.per_turn,
        "unknowns": mesh.n_unknowns,
        STIFFNESS: by_torque,
        MESHED: STEEL.shear_modulus * solid_shafts.meshed_moment(mesh) / LENGTH**2,
        EXACT: exact,
        "error": float(abs(by_torque / exact - 1.0)),
        "by energy [N m/rad]": by_energy,
        "shear stress on the surface [Pa]": float(np.hypot(s[skin, 3], s[skin, 5]).mean()),
    }


@case(
    "Torsion of a uniform shaft, solid and bored",
    source="Closed form G J / L (Saint-Venant; Timoshenko and Goodier, Theory of Elasticity)",
)
def run(run: Run, page: Page) -> None:
    """Turn the ends by an exact rotation, on three meshes each."""
    rows: list[Record] = []
    for bore in BORES:
        tube = Tube(OUTER, bore, LENGTH, STEEL)
        series = [twisted(run, tube, r) for r in ((1, 2, 3) if run.quick else (2, 3, 4))]
        check(page, series)
        rows += series
    by_shaft = grouped(rows, SHAFT)
    error = max(series[-1]["error"] for _, series in by_shaft)
    page.answer(
        f"G J / L is met to {error:.1g} (relative) with {rows[-1][TURN]} elements of 27 nodes "
        "round a turn, solid and bored; what is left is that they describe the circle by "
        "parabolas, and follows the formula for that."
    )
    page.section("Torsional stiffness")
    show_inputs(
        page,
        ("outer diameter", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
        ("bore of the bored shaft", BORES[-1], "m", "chosen"),
        ("length", LENGTH, "m", "chosen: the answer does not depend on it"),
        *steel_rows(STEEL),
    )
    many = range(4, 33)
    points = [
        trace(f"{name}, finite elements", column(s, TURN), column(s, "error"), True)
        | {"marker": {"size": 9}}
        for name, s in by_shaft
    ]
    formula = [4 * parabola_shortfall(n) for n in many]
    page.chart(
        "Relative error of the stiffness; the line is no fit, but four times the mean shortfall "
        "of the radius of as many parabolic arcs",
        [*points, trace("shortfall of parabolic arcs", many, formula)],
        TURN,
        "relative error",
        ("x", "y"),
    )
    page.table("Stiffness between ends that turn as rigid planes", rows, SHOWN)
    page.text(
        "A rotation that grows along the axis is a product of x with y and z. Elements that are "
        "drawn out along x hold it exactly, however curved their section, so the only error left "
        "is the section's."
    )
    page.data("relative_error", error)


def check(page: Page, series: list[Record]) -> None:
    """Stiffness, energy, order and stress of one shaft."""
    before, best = series[-2:]
    name, turn = best[SHAFT], best[TURN]
    shortfall = 4 * parabola_shortfall(turn)
    arcs = f"{turn} parabolic arcs round a turn fall short of the circle: J is {shortfall:.2g} "
    arcs += "too low by their formula; twice that is allowed"
    title, exact, within = f"{name}: torsional stiffness", best[EXACT], 2 * shortfall
    target = Target(STIFFNESS, exact, within, arcs, "closed form G J / L", title, order=4.0)
    page.finest(MeshSeries(series, TURN), target)
    by_torque, by_energy = best[STIFFNESS], best["by energy [N m/rad]"]
    page.equals(
        f"{name}: torsional stiffness of the meshed section [N m/rad]",
        by_torque,
        best[MESHED],
        within=parabola_slope(turn) ** 2,
        why="the exact displacement is one of the element's; the meshed surface leans against the "
        f"circle by at most {parabola_slope(turn):.2g} rad, and what that warps is of second order",
        source="G / L^2 times the integral of y^2 + z^2 over the mesh",
        band=abs(by_torque - by_energy) + 1e-9 * best[MESHED],
    )
    page.vanishes(
        f"{name}: torque over angle against twice the energy over its square",
        by_torque / by_energy - 1.0,
        within=1e-8,
        why="round-off of the solver",
        source="exact: work done equals energy stored",
    )
    page.equals(
        f"{name}: order of convergence of the stiffness",
        float(np.log(before["error"] / best["error"]) / np.log(turn / before[TURN])),
        4.0,
        within=0.2,
        relative=False,
        why="the next term of the shortfall's series is a few per cent of the first",
        source="the shortfall of parabolic arcs is of fourth order",
        measure="order",
    )
    stress, coarser = (row["shear stress on the surface [Pa]"] for row in (best, before))
    page.equals(
        f"{name}: shear stress on the surface at mid length, mean round the turn [Pa]",
        stress,
        STEEL.shear_modulus * ANGLE * OUTER / 2 / LENGTH,
        within=recovery_error(turn),
        why="stress is recovered linearly in each element: h^2 / 12 for the arc h of an element, "
        "and as much for the radius",
        source="G theta R / L",
        band=abs(stress - coarser),
    )
