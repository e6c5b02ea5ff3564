"""A cantilever bent by a force: Saint-Venant's exact flexure, and Cowper's shear."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import shaft_theory as theory
from fe_drivetrain.cases.references.exact_shafts import flexed, neutral_shear, tip_deflection
from fe_drivetrain.cases.references.solid_shafts import straight
from fe_drivetrain.cases.verification import shaft_inputs as inputs
from fe_drivetrain.cases.verification.shaft_inputs import ERROR, SHAFT, TURN
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target

STEEL = MATERIALS["steel"]
OUTER, LENGTH, FORCE = 0.4, 0.8, 1e6  # m, m, N
TUBES = [theory.Tube(OUTER, bore * OUTER, LENGTH, STEEL) for bore in (0.0, 0.5, 0.9)]

TIP, CLOSED = "mean deflection of the tip from the tangent at the root [m]", "closed form [m]"
COEFFICIENT, STRESS = "shear coefficient", "shear stress on the neutral axis [Pa]"
COWPER = "Cowper 1966, J. Appl. Mech. 33, 335-340"


def solve(tube: theory.Tube, refinement: int) -> Record:
    """Saint-Venant's tractions on both ends of one mesh."""
    shaft, name = flexed(tube, FORCE, refinement), f"bore {tube.inner / OUTER:g} D"
    tip, (stress, exact, largest) = tip_deflection(shaft), neutral_shear(shaft, FORCE)
    bent, sheared = FORCE * LENGTH**3 / (3 * tube.EI), FORCE * LENGTH / tube.kGA
    return {
        **inputs.of_mesh(name if tube.inner else "solid", refinement, shaft),
        TIP: tip,
        CLOSED: bent + sheared,
        COEFFICIENT: float(FORCE * LENGTH / ((tip - bent) * STEEL.shear_modulus * tube.area)),
        "shear's share": sheared / (bent + sheared),
        STRESS: stress,
        "exact " + STRESS: exact,
        "largest of the section [Pa]": largest,
    }


@case(
    "Cantilever with shear: Saint-Venant's flexure and Cowper's coefficient",
    source="theory: Saint-Venant's flexure, in equilibrium, free on its surfaces and with the "
    "given resultant (tests/cases/test_shaft_theory.py); Cowper 1966, J. Appl. Mech. 33, 335-340",
)
def run(run: Run, page: Page) -> None:
    """Exact tractions on both ends."""
    title, bored = "Saint-Venant's flexure", straight((0.0, LENGTH), OUTER, 0.5 * OUTER)
    inputs.begin(run, page, title, bored, "Shaft with a bore of half its diameter")
    inputs.show_inputs(
        page,
        ("outer diameter", OUTER, "m", inputs.SIZE),
        ("length", LENGTH, "m", "chosen: short, so that shear counts"),
        ("force at the tip", FORCE / 1e6, "MN"),
        steel=STEEL,
    )
    rows, met = [], []
    for tube in TUBES:
        refinements = (1, 2) if run.quick else (1, 2, 3)
        meshes = [run.timed(f"bore {tube.inner:g} m", solve, tube, r) for r in refinements]
        met.append(check(page, tube, MeshSeries(meshes, TURN)))
        rows += meshes
    answer(page, max(met), rows[0]["shear's share"])
    inputs.show_errors(page, ERROR.capitalize(), rows, table=False)
    page.text(
        "Cowper's coefficient speaks of the mean deflection and of the least-squares rotation of a "
        "section. An averaged reference point moves by these very means, so a beam describes a "
        "solid that is loaded through such points."
    )


def answer(page: Page, error: float, share: float) -> None:
    """State deflection and shear coefficient beside those of the beam; shares of the deflection."""
    names = ["solid", "bore 0.5 D", "bore 0.9 D"]
    tip, coefficient = TIP.removesuffix(" [m]"), COEFFICIENT
    figures = [
        page.judged(f"{name}: {tip}", f"tip deflection, {name}", "beam", unit="mm")
        for name in names
    ]
    figures += [
        page.judged(f"{name}: {coefficient}", f"shear coefficient, {name}", "Cowper")
        for name in names
    ]
    page.answer(
        "How far does the tip of a short cantilever move when shear counts?",
        f"The solid cantilever's tip moves by {certain_value(figures[0])}, "
        f"{100 * share:.2g}\u00a0% of it by shear; beams with Cowper's shear coefficient agree "
        f"within {100 * error:.1g}\u00a0%, solid or bored.",
        figures,
        hero="Deflections and shear coefficients against the closed forms",
        cautions=["Both ends carry Saint-Venant's tractions; a flat clamped end makes it stiffer."],
    )
    page.errors("Deflections and shear coefficients against the closed forms", figures)


def check(page: Page, tube: theory.Tube, series: MeshSeries) -> float:
    """Deflection, shear coefficient, field and stress; error of the deflection [-]."""
    best = series.last
    name, share, exact = (best[key] for key in (SHAFT, "shear's share", "exact " + STRESS))
    within, arcs = theory.within_arcs(best[TURN], "I", 4)
    beam = "F L^3 / 3EI + F L / kGA, k of Cowper 1966"
    of_tip = f"the tip's tolerance, of which shear is {100 * share:.2g} %"
    k, wide = tube.shear_coefficient, within / share
    coefficient = Target(COEFFICIENT, k, wide, of_tip, COWPER, "", True, "stiffness", 4.0)
    tip = Target(TIP, best[CLOSED], within, arcs, beam, order=4.0)
    page.targets(f"By mesh, {name}", series, [tip, coefficient], "closed form", name)
    worst = "as for the deflection, at the worst node"
    error = Target(ERROR, 0.0, within, worst, theory.FLEXURE, measure="deflection")
    where = f"shear stress on the neutral axis, {'at the skin' if tube.inner else 'at the centre'}"
    recovered, why = theory.within_recovery(best[TURN])
    near = recovered * best["largest of the section [Pa]"] / abs(exact)
    why += ", of the largest stress of the section"
    page.settled(series, error, Target(STRESS, exact, near, why, theory.FLEXURE, where), of=name)
    return float(abs(best[TIP] / best[CLOSED] - 1))
