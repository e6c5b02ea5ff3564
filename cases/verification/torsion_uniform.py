"""Torsion of a uniform shaft, solid and bored, against GJ / L."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
from fe_drivetrain.report import trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target, column, grouped
from fe_drivetrain.validation import end_loaded, solid_shafts
from fe_drivetrain.validation import shaft_theory as theory

STEEL = MATERIALS["steel"]
OUTER, BORES, LENGTH = 0.4, {"solid": 0.0, "bored": 0.28}, 0.8  # m
ANGLE = 1e-3  # rad, between the ends

SHAFT, TURN = "shaft", "elements round a turn"
STIFFNESS, MESHED = "torsional stiffness [N m/rad]", "G J / L of the mesh [N m/rad]"
ENERGY, EXACT = "by energy [N m/rad]", "G J / L [N m/rad]"
STRESS = "shear stress on the surface at mid length, mean round the turn [Pa]"


def twisted(name: str, refinement: int) -> Record:
    """The ends turned by an exact rotation, on one mesh."""
    shaft = solid_shafts.straight((0.0, LENGTH), OUTER, BORES[name])
    mesh = solid_shafts.solid(shaft, refinement, size=LENGTH)
    solution, by_torque, by_energy = solid_shafts.twist(mesh, STEEL, ANGLE)
    s = end_loaded.EndLoaded(mesh, STEEL, solution).stress
    skin = end_loaded.skin_nodes(mesh, LENGTH / 2)
    exact = theory.Tube(OUTER, BORES[name], LENGTH, STEEL).GJ / LENGTH
    return {
        SHAFT: name,
        TURN: mesh.per_turn,
        "unknowns": mesh.n_unknowns,
        STIFFNESS: by_torque,
        MESHED: STEEL.shear_modulus * solid_shafts.meshed_moment(mesh) / LENGTH**2,
        EXACT: exact,
        "error": float(abs(by_torque / exact - 1.0)),
        ENERGY: by_energy,
        STRESS: float(np.hypot(s[skin, 3], s[skin, 5]).mean()),
    }


@case(
    "Torsion of a uniform shaft, solid and bored",
    source="Closed form G J / L (Saint-Venant; Timoshenko and Goodier, Theory of Elasticity)",
)
def run(run: Run, page: Page) -> None:
    """Turn the ends by an exact rotation, on three meshes each."""
    rows: list[Record] = []
    for name in BORES:
        refinements = (1, 2, 3) if run.quick else (2, 3, 4)
        series = [run.timed(f"{name}: mesh and solve", twisted, name, r) for r in refinements]
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
        ("bore of the bored shaft", BORES["bored"], "m", "chosen"),
        ("length", LENGTH, "m", "chosen: the answer does not depend on it"),
        *steel_rows(STEEL),
    )
    many = range(4, 33)
    missed = [4 * theory.parabola_shortfall(n) for n in many]
    curves = [trace("shortfall of parabolic arcs", many, missed)]
    for name, of in by_shaft:
        points = trace(f"{name}, finite elements", column(of, TURN), column(of, "error"), True)
        curves.append(points | {"marker": {"size": 9}})
    title = "Relative error of the stiffness; the line is no fit, but four times the mean "
    title += "shortfall of the radius of as many parabolic arcs"
    page.chart(title, curves, TURN, "relative error", "xy")
    shown = SHAFT, TURN, "unknowns", STIFFNESS, MESHED, EXACT
    page.table("Stiffness between ends that turn as rigid planes", rows, shown)
    page.text(
        "A rotation that grows along the axis is a product of x with y and z. Elements that are "
        "drawn out along x hold it exactly, however curved their section, so the only error left "
        "is the section's."
    )
    page.data("relative_error", error)


def check(page: Page, series: list[Record]) -> None:
    """Stiffness, energy, order and stress of one shaft."""
    before, best = series[-2:]
    name, turn, slope = best[SHAFT], best[TURN], theory.parabola_slope(best[TURN])
    within, arcs = theory.within_arcs(turn, "J", 4)
    title, closed = f"{name}: torsional stiffness", "closed form G J / L"
    target = Target(STIFFNESS, best[EXACT], within, arcs, closed, title, order=4.0)
    page.finest(MeshSeries(series, TURN), target)
    why = "the exact displacement is one of the element's; the meshed surface leans against the "
    why += f"circle by at most {slope:.2g} rad, and what that warps is of second order"
    meshed, source = best[MESHED], "G / L^2 times the integral of y^2 + z^2 over the mesh"
    section = Target(f"{title} of the meshed section [N m/rad]", meshed, slope**2, why, source)
    page.meets(best[STIFFNESS], section, abs(best[STIFFNESS] - best[ENERGY]) + 1e-9 * meshed)
    page.vanishes(
        f"{name}: torque over angle against twice the energy over its square",
        best[STIFFNESS] / best[ENERGY] - 1.0,
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
    stress, within = STEEL.shear_modulus * ANGLE * OUTER / 2 / LENGTH, theory.recovery_error(turn)
    skin = Target(f"{name}: {STRESS}", stress, within, theory.RECOVERED, "G theta R / L")
    page.meets(best[STRESS], skin, abs(best[STRESS] - before[STRESS]))
