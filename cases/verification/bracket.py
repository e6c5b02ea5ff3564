"""Bracket with a fillet under an end force, against a plane solution by scikit-fem."""

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification.bracket_plane import Bracket, plane_answer
from fe_drivetrain.cases.verification.bracket_solid import meshed, solid_answer
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import MeshSeries, Page, Record, Run, Target

FILLET, HEIGHT, ARM, LEG = 0.05, 0.1, 0.3, 0.2  # m
BRACKET = Bracket(FILLET, HEIGHT, ARM, LEG)
FORCE = 1e6  # N/m, per width
IRON = Material(youngs_modulus=169e9, poisson_ratio=0.275, density=0.0)
#: Of the leg's inner fibre, by beam theory [MPa].
LEVER = ARM + FILLET + 0.5 * HEIGHT
NOMINAL = (FORCE / HEIGHT + 6.0 * FORCE * LEVER / HEIGHT**2) / 1e6

THROUGH = "hexahedra through the height"
STIFFNESS = "stiffness P^2 / (2 U) per width [GN/m/m]"
PEAK = "greatest principal stress of the fillet [MPa]"
BASE = "stress of the base's inner fibre [MPa]"
PLANE = "the same bracket in plane strain by scikit-fem: quartic triangles, own assembly"


def stiffness(energy: float) -> float:
    """Stiffness of an energy per width [GN/m/m]."""
    return 0.5e-9 * FORCE**2 / energy


def solve(n: int) -> Record:
    """One mesh."""
    found = solid_answer(BRACKET, IRON, FORCE, n)
    return {
        THROUGH: n,
        STIFFNESS: stiffness(found.energy),
        PEAK: found.peak / 1e6,
        BASE: found.base / 1e6,
    }


def plane(n: int) -> tuple[float, float]:
    """Energy per width [J/m] and greatest stress [MPa] of the plane problem."""
    energy, peak = plane_answer(BRACKET, IRON, FORCE, n)
    return energy, peak / 1e6


def answer(page: Page) -> None:
    """State the stress of the fillet, beside the plane solution and the leg's nominal stress."""
    names = ("greatest principal stress of the fillet", "peak stress in the fillet")
    peak = page.judged(*names, "scikit-fem")
    figures = [
        peak,
        page.judged("stress of the base's inner fibre", "stress at the base", "beam theory"),
        page.judged("stiffness P^2 / (2 U) per width", "stiffness per width", "scikit-fem"),
        page.value(
            "peak over nominal stress of the leg",
            peak.value / NOMINAL,
            None if peak.band is None else peak.band / NOMINAL,
        ),
    ]
    error = 100 * abs(peak.value / (peak.limit or 1.0) - 1)
    page.answer(
        "Which stress does the fillet of a bent bracket carry?",
        f"The fillet carries {certain_value(peak)}, {certain_value(figures[-1])} times the leg's "
        f"nominal stress; an independent plane solution differs by {error:.2g}\u00a0%.",
        figures,
        hero="Solid bracket against the plane solution and beam theory",
        cautions=["The bracket is computed in plane strain, as in the middle of a wide bracket."],
    )
    page.errors("Solid bracket against the plane solution and beam theory", figures)


@case(
    "Bracket with a fillet under an end force",
    source="Plane solution of the same bracket by scikit-fem (quartic triangles); beam theory in "
    "the leg",
)
def run(run: Run, page: Page) -> None:
    """Solve the bracket as a solid on three meshes, and as a plane problem."""
    levels = (2, 3, 6) if run.quick else (2, 4, 8)
    rows = [run.timed(f"solid, {n} {THROUGH}", solve, n) for n in levels]
    series = MeshSeries(rows, THROUGH)
    # quartic triangles through the height, of a coarser mesh and of the reference
    planes = [run.timed("plane problem, scikit-fem", plane, n) for n in (4, 6)]
    (energy, peak), before = planes[-1], planes[0]
    moved = [abs(now / old - 1.0) for now, old in zip(planes[-1], before, strict=True)]
    missed = 0.5 * (HEIGHT / levels[-1] ** 1.5 / FILLET) ** 2
    of_energy = "energy of elements of second order, which are at most a quarter of the fillet's "
    of_energy += "radius long there (a third in a quick run), to the fourth power, in a part of "
    of_energy += f"the bracket; the reference moves by {moved[0]:.0e} from its next coarser mesh"
    of_peak = "hoop stress falls at most as 1 / r^2 from the fillet: recovered stress misses "
    of_peak += f"6 (h/r)^2 / 12 = {100 * missed:.2f} % of it, with h the first element's height; "
    of_peak += "as much again for its varying along the fillet. The reference moves by "
    of_peak += f"{moved[1]:.0e} from its next coarser mesh"
    decay = "what the corner disturbs decays as exp(-4.2 x / h), 2e-4 at the base, two heights "
    decay += "away, of a disturbance as great as the stress itself"
    saint_venant = "P / h + 6 P (lever) / h^2, Saint-Venant"
    stiff, close = (2e-3, 0.02) if run.quick else (5e-4, 0.01)
    k = Target(STIFFNESS, stiffness(energy), stiff, of_energy, PLANE, "", True, "stiffness", 4.0)
    at_base = Target(BASE, NOMINAL, 2e-3, decay, saint_venant)
    targets = [k, Target(PEAK, peak, close, of_peak, PLANE), at_base]
    page.targets("By mesh", series, targets, "reference")
    answer(page)
    page.text(
        "A strip bent by a quarter circle, its leg's end on a plane of symmetry: half of a "
        "C-frame. The force on the end of the arm is a parabola of shear, so that nothing is "
        "singular. Plane strain."
    )
    size = f"{FILLET} / {HEIGHT} / {ARM} / {LEG}"
    chosen = "a bracket of ordinary proportions; there is no published one with these"
    page.image("The bracket, coarsest mesh", run.sketch(meshed(BRACKET, levels[0])))
    page.assume("fillet, height, arm, leg", size, "m", chosen)
