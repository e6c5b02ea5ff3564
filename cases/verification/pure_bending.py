"""Pure bending of a shaft: the exact three-dimensional solution, with anticlastic curvature."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import shaft_theory as theory
from fe_drivetrain.cases.references.exact_shafts import bent
from fe_drivetrain.cases.verification import shaft_inputs as inputs
from fe_drivetrain.cases.verification.shaft_inputs import ERROR, SHAFT
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import certain_value, percent_text
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target, column

STEEL = MATERIALS["steel"]
OUTER, BORE, LENGTH, CURVATURE = 0.4, 0.28, 0.8, 1e-3  # m, and 1/m
TUBES = theory.solid_and_bored(OUTER, BORE, LENGTH, STEEL)
STIFFNESS, SAG = "bending stiffness M L / theta [N m^2]", "mean deflection of the far end [m]"
SIDEWAYS = "sideways displacement of the skin at mid length, at 45 degrees [m]"
ANTICLASTIC = (
    "Anticlastic bending: sideways displacement of the skin round the shaft, at mid length"
)
EXACT, STRESS = "E I [N m^2]", "stress at the top of the skin at mid length [Pa]"
FIELD = "Timoshenko and Goodier, article 102"


def solve(name: str, refinement: int) -> Record:
    """Linear tractions on both ends of one mesh."""
    shaft = bent(TUBES[name], CURVATURE, refinement)
    sag, slope = shaft.found.means(LENGTH)
    _, y, z = shaft.mesh.points[shaft.skin].T
    rim, top = abs(y + z).argmax(), shaft.skin[z.argmax()]
    moved, exact = shaft.found.u[shaft.skin, 1], shaft.exact[shaft.skin, 1]
    return {
        **inputs.of_mesh(name, refinement, shaft),
        STIFFNESS: float(shaft.rear_moment * LENGTH / slope),
        EXACT: shaft.tube.EI,
        # u_z of the exact field has no mean but k x^2 / 2 where the section is round
        SAG: float(sag[2]),
        SIDEWAYS: float(moved[rim]),
        "exact " + SIDEWAYS: float(exact[rim]),
        STRESS: float(shaft.found.stress[top, 0]),
        "skin": (shaft.angle, 1e6 * moved, 1e6 * exact),
    }


def answer(page: Page, finest: list[Record]) -> None:
    """State the bending stiffness of both shafts, and how far it is from E I."""
    solid, bored = (
        page.judged(
            f"{name}: bending stiffness M L / theta",
            f"bending stiffness, {name} shaft",
            "E I",
            unit="MN m^2",
        )
        for name in TUBES
    )
    sideways = page.judged(
        "bored: sideways displacement of the skin at mid length, at 45 degrees",
        "sideways displacement of the skin, bored shaft",
        "exact",
        unit="µm",
    )
    largest = max(abs(row[STIFFNESS] / row[EXACT] - 1) for row in finest)
    page.answer(
        "How stiff is a meshed shaft in pure bending, and how does its section deform?",
        f"The bending stiffness is within {percent_text(largest)} of E\u00a0I, solid or bored; the "
        f"bored shaft's skin moves sideways by {certain_value(sideways)}, "
        f"{percent_text(sideways.value / (sideways.limit or 1.0) - 1)} from exact.",
        [
            solid,
            bored,
            sideways,
            page.judged(
                "bored: stress at the top of the skin at mid length",
                "bending stress of the skin, bored shaft",
                "exact",
                unit="MPa",
            ),
        ],
        hero=ANTICLASTIC,
    )


@case(
    "Pure bending of a shaft, solid and bored, in three dimensions",
    source="Timoshenko and Goodier, Theory of Elasticity, article 102 (3rd edition)",
)
def run(run: Run, page: Page) -> None:
    """Linear tractions on both ends, on three meshes each."""
    refinements = (1, 2) if run.quick else (2, 3, 4)
    rows, finest, profiles = [], [], []
    follow = "as for the stiffness; the section's error enters only where the elements cannot "
    follow += "follow the anticlastic field"
    skin = "as for the stiffness; and at a single node parabolas round the turn miss sin 2t by "
    skin += "8 h^3 / (72 sqrt 3), h their arc"
    uniform = "k L^2 / 2: the tractions belong to a curvature, whatever the section"
    worst_node = "as for the stiffness, at the worst node"
    for name in TUBES:
        meshes = [run.timed(f"{name}: mesh and solve", solve, name, r) for r in refinements]
        series, best, turn = MeshSeries(meshes, "refinement"), meshes[-1], meshes[-1]["per turn"]
        within, arcs = theory.within_arcs(turn, "I", 4)
        wide, exact = within + theory.anticlastic_error(turn), best["exact " + SIDEWAYS]
        pull = -STEEL.youngs_modulus * CURVATURE * OUTER / 2
        stiffness = Target(STIFFNESS, best[EXACT], within, arcs, "closed form E I", order=4.0)
        sag = Target(SAG, CURVATURE * LENGTH**2 / 2, within, follow, uniform, order=4.0)
        sideways = Target(SIDEWAYS, exact, wide, skin, f"nu k y z: {FIELD}", order=4.0)
        error = Target(ERROR, 0.0, within, worst_node, FIELD, measure="deflection")
        stress = Target(STRESS, pull, *theory.within_recovery(turn), "-E k z")
        page.finest(series, stiffness, sag, sideways, of=name)
        page.settled(series, error, stress, of=name)
        rows += meshes
        finest.append(best)
        angle, moved, exact = best["skin"]
        profiles.append(trace(f"{name}, finite elements", angle, moved, True))
        profiles.append(trace(f"{name}, exact", angle, exact))
    worst = max(column(finest, ERROR))
    answer(page, finest)
    page.say(
        f"Every node lies within {percent_text(worst)} of the exact field, over the largest "
        "displacement."
    )
    sizes, curved = (OUTER, BORE), ("curvature", CURVATURE, "1/m", "chosen: 40 MPa at the skin")
    length = "length", LENGTH, "m"
    inputs.begin_uniform(run, page, "Pure bending", sizes, length, curved, steel=STEEL)
    page.chart(ANTICLASTIC, profiles, "angle from the neutral axis [degrees]", "u_y [µm]")
    listed = SHAFT, "unknowns", STIFFNESS, EXACT, ERROR
    inputs.show_errors(page, "Error of the displacements", rows, table=listed)
    page.text(
        "The field is quadratic, so elements of 27 nodes with straight sides would hold it; curved "
        "ones do not quite, and converge on it."
    )
    page.data("largest_error", worst)
