"""Bar tightened in a cut at its middle: verification problem VM225 of Ansys."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.interference_fits import pressed_pairs
from fe_drivetrain.cases.verification.units import INCH, POUND, PSI
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.comparison import round_off
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import held_dofs, held_nodes
from fe_drivetrain.elasticity.mesh import Block, brick
from fe_drivetrain.elasticity.operator import nodal_stresses
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.report import Measure, trace
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.suite import Page, Run

LENGTH, WIDTH, HEIGHT = 12.0 * INCH, 1.0 * INCH, 0.5 * INCH
FORCE = 125.0 * POUND  # on this half of the bar
STEEL = Material(youngs_modulus=30e6 * PSI, poisson_ratio=0.3, density=0.0)
TARGETS = {"stress along the bar [psi]": 250.0, "closing of the cut [in]": 1e-4}
ALONG = (
    "Displacement along the bar: its halves stretch, and the cut between them closes by the jump"
)
UNIFORM = "a uniform stress is in every element's space; a condition number of 1e4"
MANUAL = "Ansys Mechanical APDL verification manual, VM225, as quoted; F / A and F L / (E A)"


def halves() -> Block:
    """Both halves of the bar, of elements as in one bar, that share no node at the cut."""
    size = np.array([0.5 * LENGTH, WIDTH, HEIGHT])
    one = brick((3, 2, 1), 27, lambda p: p * size)
    two = brick((3, 2, 1), 27, lambda p: (p + np.array([1.0, 0.0, 0.0])) * size)
    n = len(one.points)
    faces = {"x0": one.faces["x0"], "x1": two.faces["x1"] + n}
    faces |= {"cut, left": one.faces["x1"], "cut, right": two.faces["x0"] + n}
    faces |= {name: np.vstack([one.faces[name], two.faces[name] + n]) for name in ("y0", "z0")}
    return Block(np.vstack([one.points, two.points]), np.vstack([one.cells, two.cells + n]), faces)


def sides(bar: Block) -> list[Ints]:
    """Nodes on either side of the cut, in one order."""
    found = []
    for name in ("cut, left", "cut, right"):
        nodes = bar.face_nodes(name)
        found.append(nodes[np.lexsort(bar.points[nodes, 1:].round(9).T)])
    return found


def tighten(bar: Block) -> tuple[Floats, Floats, float]:
    """Stress and displacement along the bar at all nodes, and how far the cut closes [Pa, m, m]."""
    # after the nodes' degrees of freedom comes a block of three, whose first opens the cut
    opening, size = bar.points.size, bar.points.size + 3
    left, right = sides(bar)
    along = np.tile([1.0, 0.0, 0.0], (len(left), 1))
    ends = np.union1d(bar.face_nodes("x0"), bar.face_nodes("x1"))
    constraints = [
        pressed_pairs("cut", left, right, along, opening, size),
        held_nodes("ends", ends, [0], size),
        held_nodes("side", bar.face_nodes("y0"), [1], size),
        held_nodes("bottom", bar.face_nodes("z0"), [2], size),
        held_dofs("rest of the block", opening + np.array([1, 2]), size),
    ]
    F = np.zeros(size)
    F[opening] = -FORCE
    u = solve_solid(bar.points, bar.cells, STEEL.lame, constraints, F).u[:, 0]
    stress = nodal_stresses(bar.points, bar.cells, u[:opening], STEEL.lame)
    return stress[:, 0], u[:opening:3], -float(u[opening])


def answer(page: Page, closed: float, spread: float) -> None:
    """State by how much the cut closes [m], and the stress; `spread` is that of the stress."""
    stress = page.judged("stress along the bar", by="VM225", printed="250")
    target = 1e6 * TARGETS["closing of the cut [in]"] * INCH
    closing = page.value("closing of the cut [µm]", 1e6 * closed, beside=target, by="VM225")
    same = "as" if all(check.passed for check in page.checks) else "not as"
    page.answer(
        "How far does the cut in a bar close when the bar is tightened, and what does it carry?",
        f"Tightened with 125\u00a0lbf, the cut closes by {certain_value(closing)} and the bar "
        f"carries {certain_value(stress)}, both {same} VM225 prints.",
        [
            closing,
            stress,
            page.value(
                "unevenness of the stress, over its mean",
                spread,
                at_most=round_off(1e4, UNIFORM)["within"],
                by="F / A",
            ),
        ],
        hero=ALONG,
    )


def show_displacement(page: Page, bar: Block, moved: Floats) -> None:
    """Displacement along the bar, over the bar, with its jump at the cut, and in closed form."""
    x, half = bar.points[:, 0], len(bar.points) // 2
    curves = []
    for name, own in (("left half", slice(None, half)), ("right half", slice(half, None))):
        at, first = np.unique(x[own].round(9), return_index=True)
        curves.append(trace(f"{name}, nodes", 1e3 * at, 1e6 * moved[own][first], True))
    strain = FORCE / (WIDTH * HEIGHT * STEEL.youngs_modulus)
    ends = np.array([0.0, 0.5 * LENGTH, 0.5 * LENGTH, LENGTH])
    jump = strain * np.array([0.0, 0.5 * LENGTH, -0.5 * LENGTH, 0.0])
    curves.append(trace("F x / (E A)", 1e3 * ends, 1e6 * jump))
    page.chart(ALONG, curves, "x along the bar [mm]", "displacement along the bar [µm]")


@case(
    "Bar tightened in a cut at its middle (VM225)",
    source="Ansys Mechanical APDL verification manual, VM225",
)
def run(run: Run, page: Page) -> None:
    """Pull both sides of the cut over each other with the force of the problem."""
    bar = halves()
    with run.step("tighten"):
        stress, moved, closed = tighten(bar)
    found = float(stress.mean()) / PSI, closed / INCH
    measures: tuple[Measure, ...] = "stress", "deflection"
    for (quantity, target), value, measure in zip(TARGETS.items(), found, measures, strict=True):
        rounded = round_off(1e4, UNIFORM)
        page.equals(quantity, value, target, **rounded, source=MANUAL, measure=measure)
    spread = float(np.ptp(stress) / stress.mean())
    page.vanishes(
        "stress, largest less least, over its mean",
        spread,
        **round_off(1e4, UNIFORM),
        source="F / A in every section",
    )
    answer(page, closed, spread)
    show_displacement(page, bar, moved)
    page.text(
        "Both ends are held along the bar. Nodes on the two sides of the cut lie at the same "
        "places; each pair may slide, and along the bar they differ by one degree of freedom that "
        "all share and that the force acts on, as a bolt's preload does."
    )
    page.image("Both halves of the bar", run.sketch(bar))
