"""Torsion of a uniform shaft, solid and bored, against GJ / L."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import shaft_theory as theory
from fe_drivetrain.cases.references.exact_shafts import twisted
from fe_drivetrain.cases.references.solid_shafts import meshed_moment
from fe_drivetrain.cases.verification.shaft_inputs import begin_uniform
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import certain_value, percent_text
from fe_drivetrain.report.suite import (
    MeshSeries,
    Page,
    Record,
    Run,
    Target,
    column,
    grouped,
    order_of,
)

STEEL = MATERIALS["steel"]
OUTER, BORE, LENGTH, ANGLE = 0.4, 0.28, 0.8, 1e-3  # m, and rad between the ends
TUBES = theory.solid_and_bored(OUTER, BORE, LENGTH, STEEL)
SHAFT, TURN, ERROR = "shaft", "elements round a turn", "relative error"
STIFFNESS, MESHED = "torsional stiffness [N m/rad]", "G J / L of the mesh [N m/rad]"
SHORTFALL = "Relative error of the stiffness; the line is four times the mean shortfall of arcs"
EXACT, BY_ENERGY = "G J / L [N m/rad]", "by energy [N m/rad]"
BALANCE = "torque over angle against twice the energy over its square"
STRESS = "shear stress on the surface at mid length, mean round the turn [Pa]"
SKIN = STEEL.shear_modulus * ANGLE * OUTER / 2 / LENGTH  # Pa
ORDER = "order of convergence of the stiffness"
OF_SECTION = "torsional stiffness of the meshed section"
INTEGRAL = "G / L^2 times the integral of y^2 + z^2 over the mesh"


def solve(name: str, refinement: int) -> Record:
    """The ends turned by an exact rotation, on one mesh."""
    shaft, by_torque, by_energy = twisted(TUBES[name], ANGLE, refinement)
    mesh, s = shaft.mesh, shaft.found.stress[np.sort(shaft.skin)]
    return {
        SHAFT: name,
        TURN: mesh.per_turn,
        "unknowns": mesh.n_unknowns,
        STIFFNESS: by_torque,
        MESHED: STEEL.shear_modulus * meshed_moment(mesh) / LENGTH**2,
        EXACT: shaft.tube.GJ / LENGTH,
        ERROR: float(abs(by_torque / (shaft.tube.GJ / LENGTH) - 1.0)),
        BY_ENERGY: by_energy,
        BALANCE: by_torque / by_energy - 1.0,
        STRESS: float(np.hypot(s[:, 3], s[:, 5]).mean()),
    }


def answer(page: Page, turn: int, largest: float) -> None:
    """State the stiffness with the finest mesh, and how far it is from G J / L."""
    solid, bored = (
        page.judged(
            f"{name}: torsional stiffness",
            f"torsional stiffness, {name} shaft",
            "G J / L",
            unit="MN m/rad",
        )
        for name in TUBES
    )
    order, stress = ORDER, STRESS.partition(" [")[0]
    page.answer(
        "How many elements round the circumference does a shaft's torsional stiffness need?",
        f"With {turn} elements the torsional stiffness is {certain_value(solid)} (solid shaft) and "
        f"{certain_value(bored)} (bored), at most {percent_text(largest)} from "
        "G\u00a0J\u00a0/\u00a0L.",
        [
            solid,
            bored,
            page.judged(f"solid: {order}", "order of convergence, solid shaft", "parabolic arcs"),
            page.judged(
                f"solid: {stress}",
                "shear stress of the surface, solid shaft",
                "G theta R / L",
                unit="MPa",
            ),
        ],
        hero=SHORTFALL,
    )


@case(
    "Torsion of a uniform shaft, solid and bored",
    source="Closed form G J / L (Saint-Venant; Timoshenko and Goodier, Theory of Elasticity)",
)
def run(run: Run, page: Page) -> None:
    """Turn the ends by an exact rotation, on three meshes each."""
    refinements = (1, 2, 3) if run.quick else (2, 3, 4)
    small = "the next term of the shortfall's series is a few per cent of the first"
    fourth = "the shortfall of parabolic arcs is of fourth order"
    solver, works = "round-off of the solver", "exact: work done equals energy stored"
    rows: list[Record] = []
    for name in TUBES:
        meshes = [run.timed(f"{name}: mesh and solve", solve, name, r) for r in refinements]
        series, before, best, turn = MeshSeries(meshes, TURN), *meshes[-2:], meshes[-1][TURN]
        arcs, skin = theory.within_arcs(turn, "J", 4), theory.within_recovery(turn)
        closed = Target(STIFFNESS, best[EXACT], *arcs, "closed form G J / L", order=4.0)
        page.finest(series, closed, of=name)
        section = Target(MESHED, best[MESHED], *theory.within_lean(turn), INTEGRAL, OF_SECTION)
        band = abs(best[STIFFNESS] - best[BY_ENERGY]) + 1e-9 * best[MESHED]
        page.meets(best[STIFFNESS], section, band, name)
        page.meets(best[BALANCE], Target(BALANCE, 0.0, 1e-8, solver, works), of=name)
        order = float(np.log(before[ERROR] / best[ERROR]) / np.log(turn / before[TURN]))
        page.meets(order, order_of(ORDER, 4.0, 0.2, small, fourth), of=name)
        page.settled(series, Target(STRESS, SKIN, *skin, "G theta R / L"), of=name)
        rows += meshes
    finest = max(row[ERROR] for row in rows if row[TURN] == rows[-1][TURN])
    answer(page, rows[-1][TURN], finest)
    page.say("What is left is what the parabolic edges of the elements miss of the circle.")
    length = "length", LENGTH, "m", "chosen: the answer does not depend on it"
    begin_uniform(run, page, "Torsional stiffness", (OUTER, BORE), length, steel=STEEL)
    curves = [trace(of, column(r, TURN), column(r, ERROR), True) for of, r in grouped(rows, SHAFT)]
    missed = [4 * theory.parabola_shortfall(n) for n in range(4, 33)]
    curves.append(trace("shortfall of parabolic arcs", range(4, 33), missed))
    page.chart(SHORTFALL, curves, TURN, ERROR, "xy")
    shown = SHAFT, TURN, "unknowns", STIFFNESS, MESHED, EXACT
    page.table("Stiffness between ends that turn as rigid planes", rows, shown)
    page.text(
        "A rotation that grows along the axis is a product of x with y and z. Elements drawn out "
        "along x hold it exactly, however curved their section; the error left is the section's."
    )
    page.data("relative_error", finest)
