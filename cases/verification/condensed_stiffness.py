"""Condensed stiffness of a body between two rigid ends: symmetric, with exactly six zero modes."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import manufactured
from fe_drivetrain.cases.verification.condensed_bodies import Condensed, condense, zeros_by_gap
from fe_drivetrain.common import Floats, rigid_motions
from fe_drivetrain.elasticity.mesh import Block, brick, shaft_hexahedra
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column

#: Bored shaft: outer and inner diameter, length [m].
OUTER, BORE, LENGTH = 0.7, 0.3, 2.0
ENDS = np.array([[0.0, 0.0, 0.0], [LENGTH, 0.0, 0.0]])

EXACT = "exact: reciprocity, and rigid motions without strain"
EIGENVALUES = "Eigenvalues of the condensed stiffness of a free body, of the largest; rotations in "
EIGENVALUES += "units of its length. Magnitudes of those that are zero but for round-off"
TWIST = "bored shaft: twist of one end against the other"
GAP = "below the gap over above [-]"


def shaft(turn: int, quick: bool) -> Condensed:
    """The bored shaft between rigid ends, with so many elements a turn."""
    section = Section(length=LENGTH, outer_diameter=OUTER, inner_diameter=BORE)
    one = Shaft(front=0.0, sections=(section,))
    mesh = shaft_hexahedra(one, 0.2 if quick else 0.1, 20, elements_per_turn=turn)
    return condense(mesh.points, mesh.cells, (mesh.front, mesh.rear), ENDS)


def eigenvalues(S: Floats) -> Floats:
    """Eigenvalues of the symmetric part, ascending."""
    return np.asarray(np.linalg.eigvalsh(0.5 * (S + S.T)), dtype=float)


def scaled(found: Condensed, positions: Floats) -> tuple[Floats, Floats, Floats]:
    """Stiffness by energy and by reactions, and six rigid motions of both ends.

    Rotations are in units of the body's length: translations and rotations then compare.
    """
    # Rotations in units of the body's length: translations and rotations then compare.
    length = float(np.linalg.norm(positions[1] - positions[0]))
    scale = np.tile([1.0, 1.0, 1.0, 1 / length, 1 / length, 1 / length], 2)
    unit = np.outer(scale, scale)
    motions = np.zeros((12, 6))
    for k, place in enumerate(positions):
        motions[6 * k : 6 * k + 3] = rigid_motions(place[None], positions.mean(axis=0))
        motions[6 * k + 3 : 6 * k + 6, 3:] = np.eye(3)
    return found.by_energy * unit, found.by_reactions * unit, motions / scale[:, None]


def check(page: Page, label: str, found: Condensed, positions: Floats) -> tuple[Record, Floats]:
    """Symmetry, zero modes and definiteness of one body; its row of the table, its eigenvalues."""
    S, by_reactions, motions = scaled(found, positions)
    size = np.abs(S).max()
    values = eigenvalues(S)
    zeros, gap = zeros_by_gap(values)
    rigid = np.abs(by_reactions @ motions).max() / (size * np.abs(motions).max())
    held = eigenvalues(S[6:, 6:])
    check_symmetry(page, label, S, by_reactions)
    check_zero_modes(page, label, values, zeros, gap)
    page.vanishes(
        f"{label}: forces under the six rigid motions, of the largest term",
        float(rigid),
        within=1e-10,
        why="round-off of the same sums",
        source=EXACT,
    )
    page.at_least(
        f"{label}: least eigenvalue with one end held, of the largest",
        float(held[0] / held[-1]),
        0.0,
        why="a held body resists every motion: its least eigenvalue is a stiffness, far above "
        "round-off",
        source=EXACT,
        measure="identity",
    )
    return {
        "body": label,
        "zero modes": zeros,
        GAP: gap,
        "least": float(values[0]),
        "seventh": float(values[6]),
        "largest": float(values[-1]),
    }, values


def check_symmetry(page: Page, label: str, S: Floats, by_reactions: Floats) -> None:
    """Reciprocity, and the same matrix from reactions as from the energy."""
    size = np.abs(S).max()
    page.vanishes(
        f"{label}: asymmetry of the reactions to unit motions, of the largest term",
        float(np.abs(by_reactions - by_reactions.T).max() / size),
        within=1e-10,
        why="round-off of sums over the nodes of a face, times their leverage",
        source=EXACT,
    )
    page.vanishes(
        f"{label}: reactions to unit motions less the energy's second derivatives, of the largest",
        float(np.abs(by_reactions - S).max() / size),
        within=1e-10,
        why="two ways to the same matrix: round-off",
        source=EXACT,
    )


def check_zero_modes(page: Page, label: str, values: Floats, zeros: int, gap: float) -> None:
    """No eigenvalue below zero, and six that are zero."""
    page.at_least(
        f"{label}: least eigenvalue, of the largest",
        float(values[0] / values[-1]),
        -1e-12,
        why="strain energy is never negative, but for round-off of the largest stiffness",
        source=EXACT,
        measure="identity",
    )
    page.equals(
        f"{label}: zero modes when free, counted below the widest gap",
        float(zeros),
        6.0,
        within=0.0,
        relative=False,
        why="a free body has six rigid motions, and every other motion of its ends strains it",
        source=EXACT,
        measure="identity",
    )
    page.vanishes(
        f"{label}: eigenvalue below the gap over the one above",
        gap,
        within=1e-9,
        why="round-off against a stiffness: nothing lies between the two",
        source=EXACT,
    )


@case(
    "Condensed stiffness: symmetric, positive semidefinite, six zero modes when free",
    source="exact: reciprocity and rigid motions; GJ/L of Saint-Venant",
)
def run(run: Run, page: Page) -> None:
    """Condense bodies to the twelve motions of two end points, and look at the eigenvalues."""
    turns = (8, 12) if run.quick else (12, 16)
    with run.step("shaft"):
        coarse, fine = (shaft(turn, run.quick) for turn in turns)
    block, ring, ring_ends = run.timed("quarter ring", quarter_ring, run.quick)
    rows, traces = [], []
    for label, body, positions in (
        ("bored shaft, 20-node hexahedra", fine, ENDS),
        ("quarter ring, curved tetrahedra", ring, ring_ends),
    ):
        row, values = check(page, label, body, positions)
        rows.append(row)
        shown = np.maximum(np.abs(values) / values[-1], 1e-18)
        traces.append(trace(label, np.arange(1, 13), shown, mode="lines+markers"))
    check_twist(page, coarse, fine, turns, run.quick)
    answer(page, rows)
    page.section("Condensed stiffness")
    page.text(
        "Both ends are rigid faces with a reference point each. Each of the twelve motions of the "
        "two points is given once as a unit, the others held at zero; S_ij is the energy's second "
        "derivative u_i·K u_j, and once more the force or moment that holds motion i in state j. "
        "The rank is decided by the widest gap between neighbours in the sorted eigenvalues."
    )
    page.chart(
        EIGENVALUES,
        traces,
        "number",
        "eigenvalue, relative",
        "y",
    )
    page.table("Eigenvalues [N/m], rotations in units of the body's length", rows)
    page.image("The quarter ring, the second of the bodies", run.sketch(block))
    page.data("eigenvalues [N/m], rotations in units of the body's length", rows)


def answer(page: Page, rows: list[Record]) -> None:
    """State how many rigid motions a condensed free body has, and how clearly."""
    gap, six = max(column(rows, GAP)), all(row["zero modes"] == 6 for row in rows)
    page.answer(
        "Does the condensed stiffness of a free body leave its six rigid motions free?",
        f"{'Yes' if six else 'No'}: the condensed shaft and quarter ring have "
        f"{' and '.join(str(row['zero modes']) for row in rows)} free motions, with at most "
        f"{formatted(gap, 1, '')} of the stiffness of the softest elastic motion.",
        [
            *(
                page.value(f"free motions, {row['body']}", row["zero modes"], beside=6, by="exact")
                for row in rows
            ),
            page.value("stiffness of the sixth motion over that of the seventh", gap, at_most=1e-9),
            page.judged(TWIST, "torsional stiffness of the shaft", "GJ / L", unit="MN m/rad"),
        ],
        hero=EIGENVALUES,
        cautions=["Both ends are rigid faces: bodies whose end faces deform are not covered."],
    )


def quarter_ring(quick: bool) -> tuple[Block, Condensed, Floats]:
    """A quarter ring of curved tetrahedra, condensed, and the middles of its end faces."""
    n = 2 if quick else 3
    block = brick((n, 2 * n, n), 10, manufactured.quarter_ring)
    middle = 0.5 * (manufactured.INNER + manufactured.OUTER)
    half = 0.5 * manufactured.HEIGHT
    ring_ends = np.array([[middle, 0.0, half], [0.0, middle, half]])
    faces = block.face_nodes("y0"), block.face_nodes("y1")
    return block, condense(block.points, block.cells, faces, ring_ends), ring_ends


def check_twist(
    page: Page, coarse: Condensed, fine: Condensed, turns: tuple[int, int], quick: bool
) -> None:
    """The shaft's torsional stiffness in closed form."""
    twist, twist_coarse = fine.by_energy[9, 9], coarse.by_energy[9, 9]
    page.equals(
        f"{TWIST} [N m/rad]",
        float(twist),
        manufactured.LAME[1] * np.pi / 32.0 * (OUTER**4 - BORE**4) / LENGTH,
        within=2e-3 if quick else 5e-4,
        why="the circle as parabolas: its order is 4 in the elements round the axis, and "
        f"{turns[1]} of them leave some 1e-4",
        source="exact: GJ/L; rigid ends do not disturb torsion (Saint-Venant)",
        # order 4 in the elements round the axis: (16 / 12)^4 - 1 = 2.2, (12 / 8)^4 - 1 = 4.1
        band=float(abs(twist - twist_coarse) / ((turns[1] / turns[0]) ** 4 - 1.0)),
    )
