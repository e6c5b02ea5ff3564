"""A cantilever bent by a force: Saint-Venant's exact flexure, and Cowper's shear."""

from fe_drivetrain.beam import cowper_shear_coefficient
from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.shaft_inputs import SIZE, show_inputs
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.suite import MeshSeries, Page, Record, Run, Target
from fe_drivetrain.validation import shaft_theory as theory
from fe_drivetrain.validation.exact_shafts import flexed, neutral_shear, tip_deflection

STEEL = MATERIALS["steel"]
OUTER, LENGTH, FORCE = 0.4, 0.8, 1e6  # m, m, N
#: Bore over outer diameter.
WALLS = (0.0, 0.5, 0.9)

SHAFT, UNKNOWNS, REFINEMENT = "shaft", "unknowns", "refinement"
TIP, CLOSED = "mean deflection of the tip from the tangent at the root [m]", "closed form [m]"
COEFFICIENT, STRESS = "shear coefficient", "shear stress on the neutral axis [Pa]"
ERROR = "largest difference from the exact displacements, over the largest"
COWPER = "Cowper 1966, J. Appl. Mech. 33, 335-340"


def solve(tube: theory.Tube, refinement: int) -> Record:
    """Saint-Venant's tractions on both ends of one mesh."""
    shaft = flexed(tube, FORCE, refinement)
    tip, (stress, exact, largest) = tip_deflection(shaft), neutral_shear(shaft, FORCE)
    sheared = tip - FORCE * LENGTH**3 / (3 * tube.EI)
    return {
        SHAFT: f"bore {tube.inner / OUTER:g} D" if tube.inner else "solid",
        REFINEMENT: refinement,
        UNKNOWNS: shaft.mesh.n_unknowns,
        "per turn": shaft.mesh.per_turn,
        TIP: tip,
        COEFFICIENT: float(FORCE * LENGTH / (sheared * STEEL.shear_modulus * tube.area)),
        ERROR: shaft.error,
        STRESS: stress,
        "exact " + STRESS: exact,
        "largest of the section [Pa]": largest,
    }


@case(
    "Cantilever with shear: Saint-Venant's flexure and Cowper's coefficient",
    source="Love 1927, A Treatise on the Mathematical Theory of Elasticity, articles 229-231; "
    "Cowper 1966, J. Appl. Mech. 33, 335-340",
)
def run(run: Run, page: Page) -> None:
    """Exact tractions on both ends."""
    rows, table = [], []
    for wall in WALLS:
        tube = theory.Tube(OUTER, wall * OUTER, LENGTH, STEEL)
        refinements = (1, 2) if run.quick else (1, 2, 3)
        meshes = [run.timed(f"bore {wall:g} D", solve, tube, r) for r in refinements]
        table.append(check(page, tube, MeshSeries(meshes, REFINEMENT)))
        rows += meshes
    met = max(abs(row[TIP] / row[CLOSED] - 1) for row in table)
    page.answer(
        "Under Saint-Venant's tractions the solid's mean deflection is F L^3 / 3EI + F L / kGA "
        f"with Cowper's k to {met:.1g}, solid and bored."
    )
    page.section("Saint-Venant's flexure")
    show_inputs(
        page,
        ("outer diameter", OUTER, "m", SIZE),
        ("length", LENGTH, "m", "chosen: short, so that shear counts"),
        ("force at the tip", FORCE / 1e6, "MN"),
        steel=STEEL,
    )
    page.table("Mean deflection of the tip, from the mean tangent at the root", table)
    title, axis = ERROR.capitalize(), "relative error"
    page.sweep(title, rows, UNKNOWNS, ERROR, by=SHAFT, log="xy", axis=axis, table=False)
    page.text(
        "Cowper's coefficient speaks of the mean deflection and of the least-squares rotation of a "
        "section. An averaged reference point moves by these very means, so a beam describes a "
        "solid that is loaded through such points."
    )


def check(page: Page, tube: theory.Tube, series: MeshSeries) -> Record:
    """Deflection, shear coefficient, field and stress of the finest mesh; its row of the table."""
    best, turn = series.last, series.last["per turn"]
    closed = FORCE * LENGTH**3 / (3 * tube.EI) + FORCE * LENGTH / tube.kGA
    share = FORCE * LENGTH / tube.kGA / closed
    cowper = float(cowper_shear_coefficient(STEEL.poisson_ratio, tube.inner / tube.outer))
    within, arcs = theory.within_arcs(turn, "I", 4)
    of_tip = f"the tip's tolerance, of which shear is {100 * share:.2g} %"
    beam = "F L^3 / 3EI + F L / kGA, k of Cowper 1966"
    worst = "as for the deflection, at the worst node"
    where = f"shear stress on the neutral axis, {'at the skin' if tube.inner else 'at the centre'}"
    exact, love = best["exact " + STRESS], "Saint-Venant's flexure, Love 1927, articles 230-231"
    of_largest = theory.recovery_error(turn) * best["largest of the section [Pa]"] / abs(exact)
    why = f"{theory.RECOVERED}, of the largest stress of the section"
    shear = Target(COEFFICIENT, cowper, within / share, of_tip, COWPER, "", True, "stiffness", 4.0)
    error = Target(ERROR, 0.0, within, worst, "Love 1927, articles 229-231", measure="deflection")
    page.finest(series, Target(TIP, closed, within, arcs, beam, order=4.0), shear, of=best[SHAFT])
    page.settled(series, error, Target(STRESS, exact, of_largest, why, love, where), of=best[SHAFT])
    return {
        SHAFT: best[SHAFT],
        TIP: best[TIP],
        "band [m]": series.band(TIP, 4.0),
        CLOSED: closed,
        "shear's share [%]": 100 * share,
        "shear coefficient, finite elements": best[COEFFICIENT],
        "Cowper": cowper,
    }
