"""Rigid-body motions cause no stress: curved meshes of every element, and a bearing housing."""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification import scenes
from fe_drivetrain.common import Floats, Ints, rigid_motions
from fe_drivetrain.interfaces import dofs
from fe_drivetrain.mesh import brick, renumbered
from fe_drivetrain.operator import stresses
from fe_drivetrain.report import trace
from fe_drivetrain.solve import solve_solid
from fe_drivetrain.suite import Page, Record, Run
from fe_drivetrain.validation import distorted_blocks
from fe_drivetrain.validation import manufactured as m

MOTIONS = ("x", "y", "z", "about x", "about y", "about z")

#: Divisions of the quarter ring.
DIVISIONS = (3, 6, 3)

FOLLOWS, REACTION, STRESS = "displacement less the rigid motion [m]", "reaction [-]", "stress [-]"

#: By column: what is checked, its tolerance, and why.
CHECKS = {
    FOLLOWS: (
        "displacement less the rigid motion, of 1 m",
        1e-10,
        "round-off times the condition number of a held body of some thousand nodes",
    ),
    REACTION: (
        "reaction, of the forces that cancel at a node",
        1e-12,
        "round-off of sums of some hundred terms",
    ),
    STRESS: (
        "stress, of a strain of 1 m over the body's size",
        1e-9,
        "that of the displacement, times the body's size over the smallest element's",
    ),
}


class Body(NamedTuple):
    """A mesh, the nodes of the face that is moved, and Lame's constants [Pa]."""

    label: str
    points: Floats
    cells: Ints
    face: Ints
    lame: tuple[float, float]


def bodies(run: Run) -> Iterator[Body]:
    """A quarter ring of every kind of element, and the housing."""
    for nodes in (4, 10, 8, 20, 27):
        block = brick(DIVISIONS, nodes, m.quarter_ring)
        kind = "tetrahedra" if nodes in (4, 10) else "hexahedra"
        label = f"quarter ring, {nodes}-node {kind}"
        yield Body(label, block.points, block.cells, block.face_nodes("y0"), m.LAME)
    scene, mesh = scenes.meshed(run, "bonded")
    name = f"{scene.bearing_units[0].bearing.name}.housing"
    part = renumbered(mesh.points, mesh.cells[mesh.part_cells(name)])
    base = part.nodes(mesh.face_nodes(f"{name}.base"))
    lame = scene.material_of(name).lame
    yield Body("housing of the main bearing", part.points, part.cells, base, lame)


def moved(body: Body) -> dict[str, Floats]:
    """By quantity, what each of the six rigid motions of the face leaves, (6,)."""
    points, cells = body.points, body.cells
    size = float(np.ptp(points, axis=0).max())
    motions = rigid_motions(points, points.mean(axis=0))
    motions[:, 3:] /= size  # all move the body by about 1 m
    held = dofs(body.face).ravel()
    static = solve_solid(
        points,
        cells,
        body.lame,
        [],
        np.zeros(motions.shape),
        prescribed=(held, motions[held]),
        method="superlu",
    )
    # what a node would feel if the forces of its neighbours did not cancel
    force = (abs(static.K) @ np.abs(motions)).max(axis=0)
    at = distorted_blocks.reference_points(cells.shape[1])
    stress = [np.abs(stresses(points, cells, u, body.lame, at)).max() for u in static.u.T]
    return {
        FOLLOWS: np.abs(static.u - motions).max(axis=0),
        REACTION: np.abs(static.reactions["prescribed"]).max(axis=0) / force,
        STRESS: np.array(stress) / (sum(body.lame) / size),
    }


@case(
    "Rigid motions give no stress and no reaction",
    source="exact: a rigid motion has no strain",
)
def run(run: Run, page: Page) -> None:
    """Move one face of a body as a rigid body: the rest must follow, and no force may be needed."""
    rows: list[Record] = []
    curves = []
    for body in bodies(run):
        found = run.timed(body.label, moved, body)
        worst = {column: float(values.max()) for column, values in found.items()}
        for column, (what, tolerance, reason) in CHECKS.items():
            page.vanishes(
                f"{body.label}: {what}, largest of six motions",
                worst[column],
                within=tolerance,
                why=reason,
                source="exact: a rigid motion has no strain",
            )
        rows.append(
            {"body": body.label, "elements": len(body.cells), "unknowns": body.points.size, **worst}
        )
        curve = trace(body.label, range(6), np.maximum(found[STRESS], 1e-17), mode="lines+markers")
        curves.append(curve | {"x": list(MOTIONS)})
    page.answer(
        f"Six rigid motions of {len(rows)} bodies cause no more than "
        f"{max(row[STRESS] for row in rows):.0e} of stress and "
        f"{max(row[REACTION] for row in rows):.0e} of reaction: round-off."
    )
    page.section("Rigid motions")
    page.text(
        "One face is moved as a rigid body (of the quarter ring its plane end, of the housing its "
        "base), everything else is free. The rest must follow without stress, and no force may be "
        "needed."
    )
    page.table("Largest of six motions, each of about 1 m", rows)
    page.chart(
        "Largest stress by rigid motion, relative to that of a strain of 1 m over the body's size",
        curves,
        "rigid motion",
        "false stress [-]",
        "y",
    )
