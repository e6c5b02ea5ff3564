"""Torsion of a conical shaft: Michell's exact field in solid elements."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import end_loaded, solid_shafts
from fe_drivetrain.cases.references.shaft_theory import michell_torque, within_arcs
from fe_drivetrain.cases.verification.conical_shaft import HALF_ANGLE, INPUTS, RADII, SHAFT, STEEL
from fe_drivetrain.cases.verification.shaft_inputs import begin, show_inputs
from fe_drivetrain.report.number_text import certain_value, percent_text
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target

#: Of Michell's displacements: u_t = -SCALE r / R^3 [m^3].
SCALE = 1e-3 * RADII[0] ** 3
TORQUE = SCALE * michell_torque(np.radians(HALF_ANGLE), STEEL.shear_modulus)

UNKNOWNS, TURN, MISSED = "unknowns", "per turn", "error of the torque"
CONVERGENCE = "Convergence on Michell's field"
TAKEN = "torque of Michell's displacements on the ends [N m]"
ERROR = "largest difference from Michell's displacements, relative to the largest"
MICHELL = "Michell 1899: 2 pi G (2 - 3 cos a + cos^3 a) for u_t = -r / R^3"


def solve(refinement: int) -> Record:
    """Michell's displacements prescribed on the ends, on one mesh."""
    mesh = solid_shafts.solid(SHAFT, refinement, size=SHAFT.length / 2)
    R = np.linalg.norm(mesh.points, axis=1)
    field = solid_shafts.rotation_of(mesh.points, -SCALE / R**3)
    found = end_loaded.solve_displaced(mesh, STEEL, field)
    torque = solid_shafts.axial_torque(mesh, found.static)
    return {
        UNKNOWNS: mesh.n_unknowns,
        TURN: mesh.per_turn,
        TAKEN: torque,
        MISSED: abs(torque / TORQUE - 1),
        ERROR: found.error(field),
    }


def answer(page: Page, before: Record, best: Record) -> None:
    """State the torque of the cone, and how far the solid is from Michell."""
    torque = page.judged(TAKEN.partition(" [")[0], "torque of the cone", "Michell", unit="kN m")
    page.answer(
        "Which torque twists a conical shaft, and does a solid mesh find Michell's exact solution?",
        f"The cone needs a torque of {certain_value(torque)}, {percent_text(best[MISSED])} from "
        f"Michell's exact solution; its displacements err by at most {percent_text(best[ERROR])}.",
        [
            torque,
            page.value("largest error of the displacements, finest mesh [%]", 100 * best[ERROR]),
            page.value("error of the torque on the coarser mesh [%]", 100 * before[MISSED]),
            page.value("elements round a turn", best[TURN]),
        ],
        hero=CONVERGENCE,
    )


@case(
    "Torsion of a conical shaft: Michell's exact field",
    source="Michell 1899; Timoshenko and Goodier, Theory of Elasticity, article 119 (3rd edition)",
)
def run(run: Run, page: Page) -> None:
    """Prescribe Michell's displacements on the flat ends of a cone."""
    meshes = [run.timed("mesh and solve", solve, r) for r in ((1, 2) if run.quick else (1, 2, 3))]
    series, best = MeshSeries(meshes, TURN), meshes[-1]
    within, arcs = within_arcs(best[TURN], "J", 4, held=False)
    torque = Target(TAKEN, TORQUE, within, arcs, MICHELL, measure="stiffness", order=4.0)
    same, field = "as for the torque", "Michell 1899, u_t = -r / R^3"
    page.finest(series, torque)
    page.settled(series, Target(ERROR, 0.0, within, same, field, measure="deflection"))
    answer(page, *meshes[-2:])
    begin(run, page, "Cone", SHAFT, "The cone")
    show_inputs(page, *INPUTS, steel=STEEL)
    curves = {MISSED: "torque", ERROR: "displacement, largest"}
    page.sweep(CONVERGENCE, meshes, UNKNOWNS, curves, log="xy", axis="relative error")
    page.text(
        "On a complete cone, u_t / r is constant on spheres about the apex, and the surface is "
        "free of stress whatever the angle. With these displacements on its flat ends the solid "
        "must find them inside."
    )
