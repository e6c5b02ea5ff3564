"""Pure bending of a shaft: the exact three-dimensional solution, with anticlastic curvature."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_inputs, steel_rows
from fe_drivetrain.common import Floats
from fe_drivetrain.report import trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target, column
from fe_drivetrain.validation import end_loaded, solid_shafts
from fe_drivetrain.validation import shaft_theory as theory

STEEL = MATERIALS["steel"]
E, NU = STEEL.youngs_modulus, STEEL.poisson_ratio
OUTER, BORES, LENGTH = 0.4, {"solid": 0.0, "bored": 0.28}, 0.8  # m
CURVATURE = 1e-3  # 1/m

SHAFT, REFINEMENT, EXACT = "shaft", "refinement", "E I [N m^2]"
STIFFNESS = "bending stiffness M L / theta [N m^2]"
SAG = "mean deflection of the far end [m]"
SIDEWAYS = "sideways displacement of the skin at mid length, at 45 degrees [m]"
ERROR = "largest difference from the exact displacements, over the largest"
STRESS = "stress at the top of the skin at mid length [Pa]"
FIELD = "Timoshenko and Goodier, article 102"


def traction(positions: Floats, normals: Floats) -> Floats:
    """Linear, on the end sections."""
    pull = np.zeros_like(positions)
    pull[:, 0] = -E * CURVATURE * positions[:, 2] * normals[:, 0]
    return pull


def bent(name: str, refinement: int) -> Record:
    """Linear tractions on both ends of one mesh."""
    shaft = solid_shafts.straight((0.0, LENGTH / 2, LENGTH), OUTER, BORES[name])
    mesh = solid_shafts.solid(shaft, refinement)
    exact = theory.pure_bending_field(mesh.points, CURVATURE, NU)
    front, rear = end_loaded.end_forces(mesh, traction)
    found = end_loaded.solve_loaded(mesh, STEEL, front + rear, like=exact)
    sag, slope = found.means(mesh.rear)
    moment = -rear.reshape(-1, 3)[:, 0] @ mesh.points[:, 2]
    skin, (_, y, z) = end_loaded.skin_nodes(mesh, LENGTH / 2), mesh.points.T
    skin = skin[np.argsort(np.arctan2(z[skin], y[skin]))]
    rim, top = skin[np.abs(y + z)[skin].argmax()], skin[z[skin].argmax()]
    angle = np.degrees(np.arctan2(z[skin], y[skin]))
    return {
        SHAFT: name,
        REFINEMENT: refinement,
        "unknowns": mesh.n_unknowns,
        STIFFNESS: float(moment * LENGTH / slope),
        EXACT: theory.Tube(OUTER, BORES[name], LENGTH, STEEL).EI,
        ERROR: found.error(exact),
        # u_z of the exact field has no mean but k x^2 / 2 where the section is round
        SAG: float(sag[2]),
        SIDEWAYS: float(found.u[rim, 1]),
        "exact " + SIDEWAYS: float(exact[rim, 1]),
        STRESS: float(found.stress[top, 0]),
        "per turn": mesh.per_turn,
        "skin": (angle, 1e6 * found.u[skin, 1], 1e6 * exact[skin, 1]),
    }


@case(
    "Pure bending of a shaft, solid and bored, in three dimensions",
    source="Timoshenko and Goodier, Theory of Elasticity, article 102 (3rd edition)",
)
def run(run: Run, page: Page) -> None:
    """Linear tractions on both ends, on three meshes each."""
    rows: list[Record] = []
    for name in BORES:
        refinements = (1, 2, 3) if run.quick else (2, 3, 4)
        series = [run.timed(f"{name}: mesh and solve", bent, name, r) for r in refinements]
        check(page, series)
        rows += series
    finest = rows[len(refinements) - 1 :: len(refinements)]
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
        ("bore of the bored shaft", BORES["bored"], "m", "chosen"),
        ("length", LENGTH, "m", "chosen"),
        ("curvature", CURVATURE, "1/m", "chosen: 40 MPa at the skin"),
        *steel_rows(STEEL),
    )
    profiles = []
    for row in finest:
        angle, u, exact = row["skin"]
        profiles.append(trace(f"{row[SHAFT]}, finite elements", angle, u, True))
        profiles.append(trace(f"{row[SHAFT]}, exact", angle, exact))
    title = "Anticlastic bending: sideways displacement of the skin round the shaft, at mid length"
    page.chart(title, profiles, "angle from the neutral axis [degrees]", "u_y [micrometres]")
    shown = SHAFT, "unknowns", STIFFNESS, EXACT, ERROR
    title, axis = "Error of the displacements", "relative error"
    page.sweep(title, rows, "unknowns", ERROR, by=SHAFT, log="xy", axis=axis, table=shown)
    page.text(
        "The field is quadratic, so elements of 27 nodes with straight sides would hold it; curved "
        "ones do not quite, and converge on it."
    )
    page.data("largest_error", worst)


def check(page: Page, rows: list[Record]) -> None:
    """Stiffness, deflections, field and stress of one shaft."""
    before, best = rows[-2:]
    name, turn = best[SHAFT], best["per turn"]
    within, arcs = theory.within_arcs(turn, "I", 4)
    follow = "as for the stiffness; the section's error enters only where the elements cannot "
    follow += "follow the anticlastic field"
    skin = "as for the stiffness; and at a single node parabolas round the turn miss sin 2t by "
    skin += "8 h^3 / (72 sqrt 3), h their arc"
    curvature = "k L^2 / 2: the tractions belong to a curvature, whatever the section"
    sag, wide = CURVATURE * LENGTH**2 / 2, within + theory.anticlastic_error(turn)
    sideways = best["exact " + SIDEWAYS]
    for target in (
        Target(STIFFNESS, best[EXACT], within, arcs, "closed form E I"),
        Target(SAG, sag, within, follow, curvature),
        Target(SIDEWAYS, sideways, wide, skin, f"nu k y z: {FIELD}"),
    ):
        title = f"{name}: {target.key.split(' [')[0]}"
        page.finest(MeshSeries(rows, REFINEMENT), target._replace(name=title, order=4.0))
    page.vanishes(
        f"{name}: {ERROR}",
        best[ERROR],
        within=within,
        why="as for the stiffness, at the worst node",
        source=FIELD,
        measure="deflection",
        band=abs(best[ERROR] - before[ERROR]),
    )
    stress, within = -E * CURVATURE * OUTER / 2, theory.recovery_error(turn)
    target = Target(f"{name}: {STRESS}", stress, within, theory.RECOVERED, "-E k z")
    page.meets(best[STRESS], target, abs(best[STRESS] - before[STRESS]))
