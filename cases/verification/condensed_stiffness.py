"""The condensed stiffness of a body between two rigid ends: symmetric, six zero modes, no less."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Bored shaft: outer and inner diameter, length [m].
OUTER, BORE, LENGTH = 0.7, 0.3, 2.0


def run(run: Run) -> Any:
    """Condense bodies to the twelve motions of two end points, and look at the eigenvalues."""
    import numpy as np

    from fe_drivetrain.common import rigid_motions
    from fe_drivetrain.geometry import Section as ShaftSection
    from fe_drivetrain.geometry import Shaft
    from fe_drivetrain.mesh import brick, shaft_hexahedra
    from fe_drivetrain.report import Chart, Section, Table, Text, judge, trace
    from fe_drivetrain.validation import (
        condensed_bodies,
    )
    from fe_drivetrain.validation import (
        manufactured as m,
    )

    shaft = Shaft(
        front=0.0,
        sections=(ShaftSection(length=LENGTH, outer_diameter=OUTER, inner_diameter=BORE),),
    )
    meshes = [
        shaft_hexahedra(shaft, 0.2 if run.quick else 0.1, 20, elements_per_turn=n)
        for n in ((8, 12) if run.quick else (12, 16))
    ]
    ends = np.array([[0.0, 0.0, 0.0], [LENGTH, 0.0, 0.0]])
    with run.step("shaft"):
        coarse, fine = (
            condensed_bodies.condense(mesh.points, mesh.cells, (mesh.front, mesh.rear), ends)
            for mesh in meshes
        )
    with run.step("quarter ring"):
        n = 2 if run.quick else 3
        block = brick((n, 2 * n, n), 10, m.quarter_ring)
        middle = 0.5 * (m.INNER + m.OUTER)
        ring_ends = np.array([[middle, 0.0, 0.5 * m.HEIGHT], [0.0, middle, 0.5 * m.HEIGHT]])
        faces = block.face_nodes("y0"), block.face_nodes("y1")
        ring = condensed_bodies.condense(block.points, block.cells, faces, ring_ends)

    verdicts, traces = [], []
    rows: list[list[Any]] = []
    exact = "exact: reciprocity, and rigid motions without strain"
    for label, found, positions in (
        ("bored shaft, 20-node hexahedra", fine, ends),
        ("quarter ring, curved tetrahedra", ring, ring_ends),
    ):
        # Rotations in units of the body's length: translations and rotations then compare.
        length = float(np.linalg.norm(positions[1] - positions[0]))
        scale = np.tile([1.0, 1.0, 1.0, 1 / length, 1 / length, 1 / length], 2)
        S = found.by_energy * np.outer(scale, scale)
        by_reactions = found.by_reactions * np.outer(scale, scale)
        size = np.abs(S).max()
        values = np.asarray(np.linalg.eigvalsh(0.5 * (S + S.T)), dtype=float)
        zeros, gap = condensed_bodies.zeros_by_gap(values)
        motions = np.zeros((12, 6))
        for k, place in enumerate(positions):
            motions[6 * k : 6 * k + 3] = rigid_motions(place[None], positions.mean(axis=0))
            motions[6 * k + 3 : 6 * k + 6, 3:] = np.eye(3)
        motions /= scale[:, None]
        rigid = np.abs(by_reactions @ motions).max() / (size * np.abs(motions).max())
        held = np.linalg.eigvalsh(0.5 * (S + S.T)[6:, 6:])
        checks: list[tuple[str, float, float, float, str]] = [
            (
                "asymmetry of the reactions to unit motions, of the largest term",
                float(np.abs(by_reactions - by_reactions.T).max() / size),
                0.0,
                1e-10,
                "round-off of sums over the nodes of a face, times their leverage",
            ),
            (
                "reactions to unit motions less the energy's second derivatives, of the largest",
                float(np.abs(by_reactions - S).max() / size),
                0.0,
                1e-10,
                "two ways to the same matrix: round-off",
            ),
            (
                "negative part of the least eigenvalue, of the largest",
                float(min(values[0], 0.0) / values[-1]),
                0.0,
                1e-12,
                "strain energy is never negative: round-off",
            ),
            (
                "zero modes when free, counted below the widest gap",
                float(zeros),
                6.0,
                0.0,
                "a count: exact",
            ),
            (
                "eigenvalue below the gap over the one above",
                gap,
                0.0,
                1e-9,
                "round-off against a stiffness: nothing lies between the two",
            ),
            (
                "forces under the six rigid motions, of the largest term",
                float(rigid),
                0.0,
                1e-10,
                "round-off",
            ),
            (
                "negative part of the least eigenvalue with one end held, of the largest",
                float(min(held[0], 0.0) / held[-1]),
                0.0,
                0.0,
                "a held body is stable: positive definite, no allowance",
            ),
        ]
        verdicts += [
            judge(
                f"{label}: {what}",
                computed,
                reference,
                tolerance=tolerance,
                relative=False,
                source=exact,
                reason=reason,
                measure="identity",
                band=0.0,
            )
            for what, computed, reference, tolerance, reason in checks
        ]
        rows.append([label, zeros, gap, float(values[0]), float(values[6]), float(values[-1])])
        shown = np.maximum(np.abs(values) / values[-1], 1e-18)
        traces.append(trace(label, np.arange(1, 13), shown, mode="lines+markers"))

    torsion = m.LAME[1] * np.pi / 32.0 * (OUTER**4 - BORE**4) / LENGTH
    twist, twist_coarse = fine.by_energy[9, 9], coarse.by_energy[9, 9]
    # order 4 in the elements round the axis: (16 / 12)^4 - 1 = 2.2, (12 / 8)^4 - 1 = 4.1
    ratio = (12 / 8 if run.quick else 16 / 12) ** 4
    verdicts.append(
        judge(
            "bored shaft: twist of one end against the other",
            float(twist),
            torsion,
            tolerance=2e-3 if run.quick else 5e-4,
            source="exact: GJ/L; rigid ends do not disturb torsion (Saint-Venant)",
            reason="the circle as parabolas: its order is 4 in the elements round the axis, and "
            f"{'12' if run.quick else '16'} of them leave some 1e-4",
            unit="N m/rad",
            measure="stiffness",
            band=float(abs(twist - twist_coarse) / (ratio - 1.0)),
        )
    )
    chart = Chart(
        caption="Eigenvalues of the condensed stiffness of a free body, of the largest; rotations "
        "in units of its length. Magnitudes of those that are zero but for round-off",
        figure={
            "data": traces,
            "layout": {
                "xaxis": {"title": {"text": "number"}, "dtick": 1},
                "yaxis": {
                    "title": {"text": "eigenvalue, relative"},
                    "type": "log",
                    "exponentformat": "power",
                },
            },
        },
    )
    return CASE.results(
        run,
        summary=[
            "The 12 x 12 stiffness of a free body between two rigid ends has exactly six zero "
            f"modes: the widest gap, a factor of {1 / max(r[2] for r in rows):.0e} or more, lies "
            "between the sixth and the seventh eigenvalue. It is symmetric, and with one end held "
            "positive definite.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Condensed stiffness",
                items=[
                    Text(
                        text="Both ends are rigid faces with a reference point each. Each of the "
                        "twelve motions of the two points is given once as a unit, the others held "
                        "at zero; S_ij is the energy's second derivative u_i·K u_j, and once more "
                        "the force or moment that holds motion i in state j. The rank is decided "
                        "by the widest gap between neighbours in the sorted eigenvalues."
                    ),
                    chart,
                    Table(
                        caption="Eigenvalues [N/m], rotations in units of the body's length",
                        columns=[
                            "body",
                            "zero modes",
                            "below the gap over above [-]",
                            "least",
                            "seventh",
                            "largest",
                        ],
                        rows=rows,
                    ),
                ],
            )
        ],
    )


CASE = Case(
    name="verification/condensed_stiffness",
    title="Condensed stiffness: symmetric, positive semidefinite, six zero modes when free",
    source="exact: reciprocity and rigid motions; GJ/L of Saint-Venant",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
