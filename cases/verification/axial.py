"""Tension of a uniform shaft, solid and bored, against EA / L."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import shaft_theory as theory
from fe_drivetrain.cases.references.end_loaded import section_area
from fe_drivetrain.cases.references.exact_shafts import pulled
from fe_drivetrain.cases.verification.shaft_inputs import begin_uniform
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target, column

STEEL = MATERIALS["steel"]
OUTER, BORE, LENGTH = 0.4, 0.28, 0.8  # m
TUBES = theory.solid_and_bored(OUTER, BORE, LENGTH, STEEL)
SIGMA = 1e8  # Pa

SHAFT, REFINEMENT, STIFFNESS = "shaft", "refinement", "axial stiffness [N/m]"
EXACT, ERROR = "E A / L [N/m]", "error of the stiffness"
MOVED = "largest difference from the exact displacements, over the largest"
ERRORS = "Error of the stiffness: of the area, which parabolic arcs make too small"
STRESSED = "largest difference from the uniform stress, over it"


def solve(name: str, refinement: int) -> Record:
    """Uniform traction on both ends of one mesh."""
    shaft = pulled(TUBES[name], SIGMA, refinement)
    uniform = SIGMA * np.array([1, 0, 0, 0, 0, 0])
    force = SIGMA * section_area(shaft.mesh, shaft.mesh.rear)
    stiffness = force / float(shaft.found.means(shaft.mesh.rear)[0][0])
    exact = TUBES[name].EA / LENGTH
    return {
        SHAFT: name,
        REFINEMENT: refinement,
        "per turn": shaft.mesh.per_turn,
        STIFFNESS: stiffness,
        EXACT: exact,
        ERROR: abs(stiffness / exact - 1),
        MOVED: shaft.error,
        STRESSED: float(np.abs(shaft.found.stress - uniform).max()) / SIGMA,
    }


def answer(page: Page, finest: list[Record]) -> None:
    """State the stiffness of both shafts, and how far it is from the closed form."""
    solid, bored = (
        page.judged(f"{row[SHAFT]}: axial stiffness", f"{row[SHAFT]} shaft", "E A / L", unit="GN/m")
        for row in finest
    )
    page.answer(
        "How stiff is a uniform shaft in tension?",
        f"The axial stiffness is {certain_value(solid)} for the solid shaft and "
        f"{certain_value(bored)} for the bored one, both within "
        f"{100 * max(column(finest, ERROR)):.1g}\u00a0% of E\u00a0A\u00a0/\u00a0L.",
        [
            solid,
            bored,
            page.value("stiffness that is lost to the bore [%]", 100 * BORE**2 / OUTER**2),
            page.value("stress in both, uniform [MPa]", SIGMA / 1e6),
        ],
        hero=ERRORS,
        cautions=["The ends are free to contract sideways; clamped ends make a shaft stiffer."],
    )


@case("Tension of a uniform shaft", source="Closed form E A / L with uniform stress")
def run(run: Run, page: Page) -> None:
    """Uniform traction on the ends, on three meshes each."""
    refinements = (1, 2, 3) if run.quick else (2, 3, 4)
    rows: list[Record] = []
    for name in TUBES:
        meshes = [run.timed(f"{name}: mesh and solve", solve, name, r) for r in refinements]
        series, best = MeshSeries(meshes, REFINEMENT), meshes[-1]
        within, arcs = theory.within_arcs(best["per turn"], "the area", 2)
        linear = "the exact displacements are linear, and so the elements': round-off of the solver"
        derived = "round-off of the solver, magnified by the derivative over an element"
        axial = Target(STIFFNESS, best[EXACT], within, arcs, "closed form E A / L", order=4.0)
        moved = Target(MOVED, 0.0, 1e-8, linear, "u = sigma / E (x, -nu y, -nu z)")
        stressed = Target(STRESSED, 0.0, 1e-7, derived, "sigma_x = F / A and nothing else")
        page.finest(series, axial, of=name)
        for target in (moved, stressed):
            page.meets(best[target.key], target, of=name)
        rows += meshes
    answer(page, rows[len(refinements) - 1 :: len(refinements)])
    pull = "tension on the ends", SIGMA / 1e6, "MPa"
    length = "length", LENGTH, "m"
    begin_uniform(run, page, "Tension", (OUTER, BORE), length, pull, steel=STEEL)
    page.sweep(
        ERRORS,
        rows,
        "per turn",
        ERROR,
        by=SHAFT,
        log="xy",
        axis="relative error",
    )
    page.text(
        "Traction leaves the ends free to contract, and the stress is uniform to the ends. A rigid "
        "flange does not: see the case of held ends."
    )
