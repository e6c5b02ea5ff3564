"""Torsion of a uniform shaft, solid and bored, against GJ / L."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_uniform
from fe_drivetrain.report import trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target, column
from fe_drivetrain.validation import shaft_theory as theory
from fe_drivetrain.validation.end_loaded import skin_nodes
from fe_drivetrain.validation.exact_shafts import twisted
from fe_drivetrain.validation.solid_shafts import meshed_moment

STEEL = MATERIALS["steel"]
OUTER, BORE, LENGTH = 0.4, 0.28, 0.8  # m
TUBES = {
    name: theory.Tube(OUTER, b, LENGTH, STEEL) for name, b in (("solid", 0.0), ("bored", BORE))
}
ANGLE = 1e-3  # rad, between the ends

SHAFT, TURN = "shaft", "elements round a turn"
STIFFNESS, MESHED = "torsional stiffness [N m/rad]", "G J / L of the mesh [N m/rad]"
EXACT, BY_ENERGY = "G J / L [N m/rad]", "by energy [N m/rad]"
ENERGY = "torque over angle against twice the energy over its square"
STRESS = "shear stress on the surface at mid length, mean round the turn [Pa]"


def solve(name: str, refinement: int) -> Record:
    """The ends turned by an exact rotation, on one mesh."""
    tube = TUBES[name]
    shaft, by_torque, by_energy = twisted(tube, ANGLE, refinement)
    mesh, s = shaft.mesh, shaft.found.stress[skin_nodes(shaft.mesh, LENGTH / 2)]
    return {
        SHAFT: name,
        TURN: mesh.per_turn,
        "unknowns": mesh.n_unknowns,
        STIFFNESS: by_torque,
        MESHED: STEEL.shear_modulus * meshed_moment(mesh) / LENGTH**2,
        EXACT: tube.GJ / LENGTH,
        "error": float(abs(by_torque / (tube.GJ / LENGTH) - 1.0)),
        BY_ENERGY: by_energy,
        ENERGY: by_torque / by_energy - 1.0,
        STRESS: float(np.hypot(s[:, 3], s[:, 5]).mean()),
    }


@case(
    "Torsion of a uniform shaft, solid and bored",
    source="Closed form G J / L (Saint-Venant; Timoshenko and Goodier, Theory of Elasticity)",
)
def run(run: Run, page: Page) -> None:
    """Turn the ends by an exact rotation, on three meshes each."""
    refinements = (1, 2, 3) if run.quick else (2, 3, 4)
    finest, many = [], range(4, 33)
    missed = [4 * theory.parabola_shortfall(n) for n in many]
    curves = [trace("shortfall of parabolic arcs", many, missed)]
    rows: list[Record] = []
    for name in TUBES:
        meshes = [run.timed(f"{name}: mesh and solve", solve, name, r) for r in refinements]
        check(page, name, MeshSeries(meshes, TURN))
        errors = column(meshes, "error")
        points = trace(f"{name}, finite elements", column(meshes, TURN), errors, True)
        curves.append(points | {"marker": {"size": 9}})
        finest.append(errors[-1])
        rows += meshes
    page.answer(
        f"G J / L is met to {max(finest):.1g} (relative) with {rows[-1][TURN]} elements of 27 "
        "nodes round a turn, solid and bored; what is left is that they describe the circle by "
        "parabolas, and follows the formula for that."
    )
    page.section("Torsional stiffness")
    length = "length", LENGTH, "m", "chosen: the answer does not depend on it"
    show_uniform(page, OUTER, BORE, length, steel=STEEL)
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
    page.data("relative_error", max(finest))


def check(page: Page, name: str, series: MeshSeries) -> None:
    """Stiffness, energy, order and stress of one shaft."""
    before, best = series.rows[-2:]
    turn = best[TURN]
    within, arcs = theory.within_arcs(turn, "J", 4)
    target = Target(STIFFNESS, best[EXACT], within, arcs, "closed form G J / L", order=4.0)
    page.finest(series, target, of=name)
    section, leans = theory.within_lean(turn)
    title = "torsional stiffness of the meshed section [N m/rad]"
    meshed, source = best[MESHED], "G / L^2 times the integral of y^2 + z^2 over the mesh"
    band = abs(best[STIFFNESS] - best[BY_ENERGY]) + 1e-9 * meshed
    page.meets(best[STIFFNESS], Target(title, meshed, section, leans, source), band, name)
    balance, exact = "round-off of the solver", "exact: work done equals energy stored"
    page.meets(best[ENERGY], Target(ENERGY, 0.0, 1e-8, balance, exact), of=name)
    order = float(np.log(before["error"] / best["error"]) / np.log(turn / before[TURN]))
    why = "the next term of the shortfall's series is a few per cent of the first"
    fourth, title = "the shortfall of parabolic arcs is of fourth order", "order of convergence of "
    title += "the stiffness"
    page.meets(order, Target(title, 4.0, 0.2, why, fourth, "", False, "order"), of=name)
    stress, within = STEEL.shear_modulus * ANGLE * OUTER / 2 / LENGTH, theory.recovery_error(turn)
    page.settled(series, Target(STRESS, stress, within, theory.RECOVERED, "G theta R / L"), of=name)
