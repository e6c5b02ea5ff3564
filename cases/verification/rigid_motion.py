"""Rigid-body motions cause no stress: curved meshes of every element, and a bearing housing."""

from collections.abc import Iterator

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.verification import scenes
from fe_drivetrain.cases.verification.moved_bodies import MOTIONS, Body, moved, quarter_ring
from fe_drivetrain.elasticity.mesh import renumbered
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run

FOLLOWS, REACTION, STRESS = "displacement less the rigid motion [m]", "reaction [-]", "stress [-]"
FALSE_STRESS = (
    "Largest stress by rigid motion, relative to that of a strain of 1 m over the body's size"
)
EXACT = "exact: a rigid motion has no strain"
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


def bodies(run: Run) -> Iterator[Body]:
    """A quarter ring of every kind of element, and the housing."""
    for nodes in (4, 10, 8, 20, 27):
        yield quarter_ring(nodes)
    scene, mesh = scenes.meshed(run, "bonded")
    name = f"{scene.bearing_units[0].bearing.name}.housing"
    part = renumbered(mesh.points, mesh.cells[mesh.part_cells(name)])
    base = part.nodes(mesh.face_nodes(f"{name}.base"))
    lame = scene.material_of(name).lame
    yield Body("housing of the main bearing", part.points, part.cells, base, lame)


def answer(page: Page, rows: list[Record]) -> None:
    """State the false stress, reaction and displacement of rigid motions."""
    worst = {column: max(row[column] for row in rows) for column in CHECKS}
    stress = formatted(worst[STRESS], 2, "")
    free = "Yes" if all(check.passed for check in page.checks) else "No"
    page.answer(
        "Does a body that moves rigidly stay free of stress, whatever its elements?",
        f"{free}: six rigid motions of {len(rows)} bodies cause false stresses of at most {stress} "
        "of those by a strain of the same displacement.",
        [
            page.value(f"largest {name}", worst[column], at_most=CHECKS[column][1], by="round-off")
            for column, name in (
                (STRESS, "false stress, of that of a strain of 1 m over the body's size"),
                (REACTION, "false reaction, of the forces that cancel at a node"),
                (FOLLOWS, "distance from a rigid motion of 1 m [m]"),
            )
        ],
        hero=FALSE_STRESS,
    )


@case("Rigid motions give no stress and no reaction", source="exact: a rigid motion has no strain")
def run(run: Run, page: Page) -> None:
    """Move one face of a body as a rigid body: the rest must follow, and no force may be needed."""
    rows: list[Record] = []
    curves = []
    for body in bodies(run):
        found = run.timed(body.label, moved, body)
        by_column = (FOLLOWS, found.apart), (REACTION, found.reaction), (STRESS, found.stress)
        worst = {column: float(values.max()) for column, values in by_column}
        for column, (what, within, why) in CHECKS.items():
            title = f"{body.label}: {what}, largest of six motions"
            page.vanishes(title, worst[column], within=within, why=why, source=EXACT)
        size = {"elements": len(body.cells), "unknowns": body.points.size}
        rows.append({"body": body.label, **size, **worst})
        shown = np.maximum(found.stress, 1e-17)
        curve = trace(body.label, range(6), shown, mode="lines+markers")
        curves.append(curve | {"x": list(MOTIONS)})
    answer(page, rows)
    page.section("Rigid motions")
    page.image("The housing of the main bearing, the last of the bodies", run.sketch(body))
    page.text(
        "One face is moved as a rigid body (of the quarter ring its plane end, of the housing its "
        "base), everything else is free. The rest must follow without stress, and no force may be "
        "needed."
    )
    page.table("Largest of six motions, each of about 1 m", rows)
    page.chart(FALSE_STRESS, curves, "rigid motion", "false stress [-]", "y")
