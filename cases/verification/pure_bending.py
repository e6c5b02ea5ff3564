"""Pure bending of a shaft: the exact three-dimensional solution, with anticlastic curvature."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import show_uniform
from fe_drivetrain.report import trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target, column
from fe_drivetrain.validation import shaft_theory as theory
from fe_drivetrain.validation.exact_shafts import ExactShaft, bent

STEEL = MATERIALS["steel"]
OUTER, BORE, LENGTH = 0.4, 0.28, 0.8  # m
TUBES = theory.solid_and_bored(OUTER, BORE, LENGTH, STEEL)
CURVATURE = 1e-3  # 1/m

SHAFT, REFINEMENT, EXACT = "shaft", "refinement", "E I [N m^2]"
STIFFNESS, SAG = "bending stiffness M L / theta [N m^2]", "mean deflection of the far end [m]"
SIDEWAYS = "sideways displacement of the skin at mid length, at 45 degrees [m]"
ERROR = "largest difference from the exact displacements, over the largest"
STRESS = "stress at the top of the skin at mid length [Pa]"
FIELD = "Timoshenko and Goodier, article 102"


def shown(name: str, refinement: int, shaft: ExactShaft) -> Record:
    """What is judged of one mesh."""
    sag, slope = shaft.found.means(LENGTH)
    _, y, z = shaft.mesh.points[shaft.skin].T
    rim = shaft.skin[abs(y + z).argmax()]
    return {
        SHAFT: name,
        REFINEMENT: refinement,
        "unknowns": shaft.mesh.n_unknowns,
        "per turn": shaft.mesh.per_turn,
        STIFFNESS: float(shaft.rear_moment * LENGTH / slope),
        EXACT: shaft.tube.EI,
        ERROR: shaft.error,
        # u_z of the exact field has no mean but k x^2 / 2 where the section is round
        SAG: float(sag[2]),
        SIDEWAYS: float(shaft.found.u[rim, 1]),
        "exact " + SIDEWAYS: float(shaft.exact[rim, 1]),
        STRESS: float(shaft.found.stress[shaft.skin[z.argmax()], 0]),
    }


@case(
    "Pure bending of a shaft, solid and bored, in three dimensions",
    source="Timoshenko and Goodier, Theory of Elasticity, article 102 (3rd edition)",
)
def run(run: Run, page: Page) -> None:
    """Linear tractions on both ends, on three meshes each."""
    refinements = (1, 2, 3) if run.quick else (2, 3, 4)
    rows, finest, profiles = [], [], []
    for name, tube in TUBES.items():
        shafts = [
            run.timed(f"{name}: mesh and solve", bent, tube, CURVATURE, r) for r in refinements
        ]
        meshes = [shown(name, *of) for of in zip(refinements, shafts, strict=True)]
        check(page, name, MeshSeries(meshes, REFINEMENT))
        rows += meshes
        finest.append(meshes[-1])
        u, exact = (
            1e6 * field[shafts[-1].skin, 1] for field in (shafts[-1].found.u, shafts[-1].exact)
        )
        profiles.append(trace(f"{name}, finite elements", shafts[-1].angle, u, True))
        profiles.append(trace(f"{name}, exact", shafts[-1].angle, exact))
    solid, bored = (abs(row[STIFFNESS] / row[EXACT] - 1) for row in finest)
    worst = max(column(finest, ERROR))
    page.answer(
        f"E I is met to {solid:.1g} (solid) and {bored:.1g} (bored), and every node lies within "
        f"{worst:.1g} of the exact field, over the largest displacement."
    )
    page.section("Pure bending")
    curved = "curvature", CURVATURE, "1/m", "chosen: 40 MPa at the skin"
    show_uniform(page, OUTER, BORE, ("length", LENGTH, "m"), curved, steel=STEEL)
    title = "Anticlastic bending: sideways displacement of the skin round the shaft, at mid length"
    page.chart(title, profiles, "angle from the neutral axis [degrees]", "u_y [µm]")
    listed = SHAFT, "unknowns", STIFFNESS, EXACT, ERROR
    title, axis = "Error of the displacements", "relative error"
    page.sweep(title, rows, "unknowns", ERROR, by=SHAFT, log="xy", axis=axis, table=listed)
    page.text(
        "The field is quadratic, so elements of 27 nodes with straight sides would hold it; curved "
        "ones do not quite, and converge on it."
    )
    page.data("largest_error", worst)


def check(page: Page, name: str, series: MeshSeries) -> None:
    """Stiffness, deflections, field and stress of one shaft."""
    best, turn = series.last, series.last["per turn"]
    within, arcs = theory.within_arcs(turn, "I", 4)
    follow = "as for the stiffness; the section's error enters only where the elements cannot "
    follow += "follow the anticlastic field"
    skin = "as for the stiffness; and at a single node parabolas round the turn miss sin 2t by "
    skin += "8 h^3 / (72 sqrt 3), h their arc"
    curvature = "k L^2 / 2: the tractions belong to a curvature, whatever the section"
    sag, wide = CURVATURE * LENGTH**2 / 2, within + theory.anticlastic_error(turn)
    stress, near = -STEEL.youngs_modulus * CURVATURE * OUTER / 2, theory.recovery_error(turn)
    field = "as for the stiffness, at the worst node"
    page.finest(
        series,
        Target(STIFFNESS, best[EXACT], within, arcs, "closed form E I", order=4.0),
        Target(SAG, sag, within, follow, curvature, order=4.0),
        Target(SIDEWAYS, best["exact " + SIDEWAYS], wide, skin, f"nu k y z: {FIELD}", order=4.0),
        of=name,
    )
    page.settled(
        series,
        Target(ERROR, 0.0, within, field, FIELD, measure="deflection"),
        Target(STRESS, stress, near, theory.RECOVERED, "-E k z"),
        of=name,
    )
