"""Rigid motions stress nothing: curved meshes of every element, and the main bearing's housing."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

MOTIONS = ("x", "y", "z", "about x", "about y", "about z")

#: Divisions of the quarter ring.
DIVISIONS = (3, 6, 3)


def run(run: Run) -> Any:
    """Move one face of a body as a rigid body: the rest must follow, and no force may be needed."""
    import numpy as np

    from fe_drivetrain.cases.verification import (
        scenes,
    )
    from fe_drivetrain.common import rigid_motions
    from fe_drivetrain.interfaces import freedoms
    from fe_drivetrain.mesh import brick, renumbered
    from fe_drivetrain.operator import stresses
    from fe_drivetrain.report import Chart, Section, Table, Text, judge, trace
    from fe_drivetrain.solve import solve_solid
    from fe_drivetrain.validation import (
        distorted_blocks,
    )
    from fe_drivetrain.validation import (
        manufactured as m,
    )

    # label, points, cells, nodes of the face that is moved, Lame's constants
    bodies: list[tuple[str, Any, Any, Any, tuple[float, float]]] = []
    for nodes in (4, 10, 8, 20, 27):
        block = brick(DIVISIONS, nodes, m.quarter_ring)
        kind = "tetrahedra" if nodes in (4, 10) else "hexahedra"
        label = f"quarter ring, {nodes}-node {kind}"
        bodies.append((label, block.points, block.cells, block.face_nodes("y0"), m.LAME))
    scene, mesh = scenes.meshed(run, "bonded")
    name = f"{scene.bearing_units[0].bearing.name}.housing"
    part = renumbered(mesh.points, mesh.cells[mesh.part_cells(name)])
    base = part.nodes(mesh.face_nodes(f"{name}.base"))
    lame = scene.material_of(name).lame
    bodies.append(("housing of the main bearing", part.points, part.cells, base, lame))

    rows: list[list[Any]] = []
    verdicts, traces = [], []
    for label, points, cells, face, lame in bodies:
        with run.step(label):
            size = float(np.ptp(points, axis=0).max())
            motions = rigid_motions(points, points.mean(axis=0))
            motions[:, 3:] /= size  # all move the body by about 1 m
            held = freedoms(face).ravel()
            static = solve_solid(
                points,
                cells,
                lame,
                [],
                np.zeros(motions.shape),
                prescribed=(held, motions[held]),
                method="superlu",
            )
            follows = np.abs(static.u - motions).max(axis=0)
            # What a node would feel if the forces of its neighbours did not cancel, and the stress
            # of a strain of one over the body's size.
            force = (abs(static.K) @ np.abs(motions)).max(axis=0)
            reaction = np.abs(static.reactions["prescribed"]).max(axis=0) / force
            at = distorted_blocks.reference_points(cells.shape[1])
            scale = sum(lame) / size
            stress = np.array(
                [
                    np.abs(stresses(points, cells, static.u[:, k], lame, at)).max() / scale
                    for k in range(6)
                ]
            )
        for what, values, tolerance, reason in (
            (
                "displacement less the rigid motion, of 1 m",
                follows,
                1e-10,
                "round-off times the condition number of a held body of some thousand nodes",
            ),
            (
                "reaction, of the forces that cancel at a node",
                reaction,
                1e-12,
                "round-off of sums of some hundred terms",
            ),
            (
                "stress, of a strain of 1 m over the body's size",
                stress,
                1e-9,
                "that of the displacement, times the body's size over the smallest element's",
            ),
        ):
            verdicts.append(
                judge(
                    f"{label}: {what}, largest of six motions",
                    float(values.max()),
                    0.0,
                    tolerance=tolerance,
                    relative=False,
                    source="exact: a rigid motion has no strain",
                    reason=reason,
                    measure="identity",
                    band=0.0,
                )
            )
        worst = [float(v.max()) for v in (follows, reaction, stress)]
        rows.append([label, len(cells), 3 * len(points), *worst])
        curve = trace(label, range(6), np.maximum(stress, 1e-17), mode="lines+markers")
        traces.append(curve | {"x": list(MOTIONS)})

    chart = Chart(
        caption="Largest stress by rigid motion, relative to that of a strain of 1 m over the "
        "body's size",
        figure={
            "data": traces,
            "layout": {
                "xaxis": {"title": {"text": "rigid motion"}},
                "yaxis": {
                    "title": {"text": "false stress [-]"},
                    "type": "log",
                    "exponentformat": "power",
                },
            },
        },
    )
    return CASE.results(
        run,
        summary=[
            f"Six rigid motions of {len(bodies)} bodies cause no more than "
            f"{max(r[5] for r in rows):.0e} of stress and {max(r[4] for r in rows):.0e} of "
            "reaction: round-off.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Rigid motions",
                items=[
                    Text(
                        text="One face is moved as a rigid body (of the quarter ring its plane "
                        "end, of the housing its base), everything else is free. The rest must "
                        "follow without stress, and no force may be needed."
                    ),
                    Table(
                        caption="Largest of six motions, each of about 1 m",
                        columns=[
                            "body",
                            "elements",
                            "unknowns",
                            "displacement less the rigid motion [m]",
                            "reaction [-]",
                            "stress [-]",
                        ],
                        rows=rows,
                    ),
                    chart,
                ],
            )
        ],
    )


CASE = Case(
    name="verification/rigid_motion",
    title="Rigid motions give no stress and no reaction",
    source="exact: a rigid motion has no strain",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
