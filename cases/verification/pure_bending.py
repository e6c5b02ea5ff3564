"""Pure bending of a shaft: the exact three-dimensional solution, with anticlastic curvature."""

from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
from fe_drivetrain.common import Floats
from fe_drivetrain.mesh import face_weights
from fe_drivetrain.operator import nodal_stresses, traction_loads
from fe_drivetrain.report import trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target, column
from fe_drivetrain.validation import solid_shafts
from fe_drivetrain.validation.shaft_theory import (
    Tube,
    anticlastic_error,
    parabola_shortfall,
    pure_bending_field,
    recovery_error,
)

STEEL = MATERIALS["steel"]
E, NU = STEEL.youngs_modulus, STEEL.poisson_ratio
OUTER, BORES, LENGTH = 0.4, (0.0, 0.28), 0.8  # m
CURVATURE = 1e-3  # 1/m

SHAFT, REFINEMENT, EXACT = "shaft", "refinement", "E I [N m^2]"
STIFFNESS = "bending stiffness M L / theta [N m^2]"
SAG = "mean deflection of the far end [m]"
SIDEWAYS = "sideways displacement of the skin at mid length, at 45 degrees [m]"
ERROR = "largest difference from the exact displacements, over the largest"
STRESS = "stress at the top of the skin at mid length [Pa]"


def traction(positions: Floats, normals: Floats) -> Floats:
    """Linear, on the end sections."""
    pull = np.zeros_like(positions)
    pull[:, 0] = -E * CURVATURE * positions[:, 2] * normals[:, 0]
    return pull


def bent(run: Run, tube: Tube, refinement: int) -> Record:
    """Linear tractions on both ends of one mesh."""
    name = "bored" if tube.inner else "solid"
    with run.step(f"{name}: mesh and solve"):
        shaft = solid_shafts.straight((0.0, LENGTH / 2, LENGTH), OUTER, tube.inner)
        mesh = solid_shafts.solid(shaft, refinement)
        points = mesh.points
        exact = pure_bending_field(points, CURVATURE, NU)
        ends = [mesh.section_facets(end) for end in (mesh.front, mesh.rear)]
        front, rear = (traction_loads(points, facets, traction) for facets in ends)
        held = solid_shafts.pinned_like(mesh, exact)
        found = solve_solid(points, mesh.cells, STEEL.lame, [], front + rear, held)
    u = found.u[:, 0].reshape(-1, 3)
    weights = face_weights(points, ends[1], len(points))
    z = points[:, 2]
    slope = -(weights @ (z * u[:, 0])) / (weights @ z**2)
    moment = rear.reshape(-1, 3)[:, 0] @ -z
    middle = mesh.section_nodes(LENGTH / 2)
    at = points[middle]
    rim = middle[np.abs(at[:, 1] + at[:, 2]).argmax()]
    skin = middle[np.hypot(at[:, 1], at[:, 2]) > 0.5 * OUTER * (1 - 1e-9)]
    angle = np.degrees(np.arctan2(points[skin, 2], points[skin, 1]))
    order = np.argsort(angle)
    s = nodal_stresses(points, mesh.cells, found.u[:, 0], STEEL.lame)
    return {
        SHAFT: name,
        REFINEMENT: refinement,
        "unknowns": mesh.n_unknowns,
        STIFFNESS: float(moment * LENGTH / slope),
        EXACT: tube.EI,
        ERROR: float(np.abs(u - exact).max() / np.abs(exact).max()),
        # u_z of the exact field has no mean but k x^2 / 2 where the section is round
        SAG: float(weights @ u[:, 2] / weights.sum()),
        SIDEWAYS: float(u[rim, 1]),
        "exact " + SIDEWAYS: float(exact[rim, 1]),
        STRESS: float(s[middle[at[:, 2].argmax()], 0]),
        "per turn": mesh.per_turn,
        "skin": (angle[order], 1e6 * u[skin[order], 1], 1e6 * exact[skin[order], 1]),
    }


@case(
    "Pure bending of a shaft, solid and bored, in three dimensions",
    source="Timoshenko and Goodier, Theory of Elasticity, article 102 (3rd edition)",
)
def run(run: Run, page: Page) -> None:
    """Linear tractions on both ends, on three meshes each."""
    refinements = (1, 2, 3) if run.quick else (2, 3, 4)
    rows: list[Record] = []
    for bore in BORES:
        tube = Tube(OUTER, bore, LENGTH, STEEL)
        series = [bent(run, tube, refinement) for refinement in refinements]
        check(page, series)
        rows += series
    finest = [row for row in rows if row[REFINEMENT] == refinements[-1]]
    solid, bored = (abs(row[STIFFNESS] / row[EXACT] - 1) for row in finest)
    worst = max(column(finest, ERROR))
    page.answer(
        f"E I is met to {solid:.1g} (solid) and {bored:.1g} (bored), and every node lies within "
        f"{worst:.1g} of the exact field, over the largest displacement."
    )
    page.section("Pure bending")
    show_inputs(
        page,
        ("outer diameter", OUTER, "m", "Stirling 2023, Table 3.1, in size"),
        ("bore of the bored shaft", BORES[-1], "m", "chosen"),
        ("length", LENGTH, "m", "chosen"),
        ("curvature", CURVATURE, "1/m", "chosen: 40 MPa at the skin"),
        *steel_rows(STEEL),
    )
    profiles: list[Any] = []
    for row in finest:
        angle, u, exact = row["skin"]
        profiles.append(trace(f"{row[SHAFT]}, finite elements", angle, u, True))
        profiles.append(trace(f"{row[SHAFT]}, exact", angle, exact))
    page.chart(
        "Anticlastic bending: sideways displacement of the skin round the shaft, at mid length",
        profiles,
        "angle from the neutral axis [degrees]",
        "u_y [micrometres]",
    )
    shown = SHAFT, "unknowns", STIFFNESS, EXACT, ERROR
    page.sweep(
        "Error of the displacements", rows, "unknowns", ERROR, by=SHAFT, log="xy", table=shown
    )
    page.text(
        "The field is quadratic, so elements of 27 nodes with straight sides would hold it; curved "
        "ones do not quite, and converge on it."
    )
    page.data("largest_error", worst)


def check(page: Page, rows: list[Record]) -> None:
    """Stiffness, deflections, field and stress of one shaft."""
    series, (before, best) = MeshSeries(rows, REFINEMENT), rows[-2:]
    name, turn = best[SHAFT], best["per turn"]
    shortfall = 4 * parabola_shortfall(turn)
    arcs = f"{turn} parabolic arcs round a turn: I is {shortfall:.2g} too low by their formula; "
    arcs += "twice that is allowed"
    follow = "as for the stiffness; the section's error enters only where the elements cannot "
    follow += "follow the anticlastic field"
    skin = "as for the stiffness; and at a single node parabolas round the turn miss sin 2t by "
    skin += "8 h^3 / (72 sqrt 3), h their arc"
    curvature = "k L^2 / 2: the tractions belong to a curvature, whatever the section"
    anticlastic = "nu k y z: Timoshenko and Goodier, article 102"
    sag, wide = CURVATURE * LENGTH**2 / 2, 2 * shortfall + anticlastic_error(turn)
    for target in (
        Target(STIFFNESS, best[EXACT], 2 * shortfall, arcs, "closed form E I"),
        Target(SAG, sag, 2 * shortfall, follow, curvature),
        Target(SIDEWAYS, best["exact " + SIDEWAYS], wide, skin, anticlastic),
    ):
        title = f"{name}: {target.key.split(' [')[0]}"
        page.finest(series, target._replace(name=title, order=4.0))
    page.vanishes(
        f"{name}: {ERROR}",
        best[ERROR],
        within=2 * shortfall,
        why="as for the stiffness, at the worst node",
        source="Timoshenko and Goodier, article 102",
        measure="deflection",
        band=abs(best[ERROR] - before[ERROR]),
    )
    page.equals(
        f"{name}: {STRESS.split(' [')[0]} [Pa]",
        best[STRESS],
        -E * CURVATURE * OUTER / 2,
        within=recovery_error(turn),
        why="stress is recovered linearly in each element: h^2 / 12 for the arc h of an element, "
        "and as much for the radius",
        source="-E k z",
        band=abs(best[STRESS] - before[STRESS]),
    )
