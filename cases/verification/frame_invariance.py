"""Results do not depend on the origin and the orientation of the coordinate frame."""

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references.manufactured import quarter_ring, regular
from fe_drivetrain.cases.verification import scenes
from fe_drivetrain.cases.verification import turned_frames as turned
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, Target, column, grouped
from fe_drivetrain.shafts.response import build_model, unit_load_response

#: Distances of the origin that are tried [m].
DISTANCES = (1.0, 10.0, 100.0, 1e3, 1e4, 1e5)
SEED = 7
#: Allowed difference, relative.
ROUND_OFF = 1e-9

AWAY = "Largest relative difference of results, turned and taken away from the origin"


def check(page: Page, body: str, frame: str, found: dict[str, float]) -> list[Record]:
    """All quantities of one body in one frame; their rows of the table."""
    title = f"largest difference of {', '.join(found)}, relative"
    why = "coordinates lose a digit for each power of ten of the distance over the body's size; "
    why += "solver round-off, up to 1e-10 with these condition numbers, is more"
    same = "exact: the equations of elasticity are the same in every frame"
    page.meets(max(found.values()), Target(title, 0.0, ROUND_OFF, why, same), of=f"{body}, {frame}")
    return [
        {"body": body, "frame": frame, "quantity": what, "difference [-]": value}
        for what, value in found.items()
    ]


def answer(page: Page, worst: dict[str, float]) -> None:
    """State what results change by when a body is turned and moved, for each body."""
    most = max(worst.values())
    same = most <= ROUND_OFF
    page.answer(
        "Do results depend on where the origin is, and which way the axes point?",
        f"{'No' if same else 'Yes'}: when a model is turned and moved by 10\u00a0m, "
        f"displacements, reactions and stiffness change by at most {formatted(most, 2, '')} of "
        "their size.",
        [
            page.value(f"largest difference, {body}", value, at_most=ROUND_OFF, by="round-off")
            for body, value in worst.items()
        ],
        hero=AWAY,
        cautions=[
            "Coordinates lose one digit for every factor of ten in distance from the origin."
        ],
    )


@case(
    "Reactions and stiffness do not depend on the frame's origin and orientation",
    source="exact: invariance under rigid motions of the frame",
)
def run(run: Run, page: Page) -> None:
    """Solve solids, and the main bearing, again after a random rotation and a translation."""
    page.seed = SEED
    Q, away = turned.random_frame(SEED)
    still, here, far = np.eye(3), np.zeros(3), 10.0 * away
    frames = {"turned": (Q, here), "10 m away": (still, far), "turned, 10 m away": (Q, far)}
    rows: list[Record] = []
    traces = []
    for nodes, label in ((10, "curved tetrahedra"), (27, "27-node hexahedra")):
        body = f"quarter ring, {label}"
        with run.step(body):
            fixed = turned.solve_ring(nodes, still, here)
            for frame, (turn, shift) in frames.items():
                moved = turned.solve_ring(nodes, turn, shift)
                rows += check(page, body, frame, turned.differences(fixed, moved, turn))
            taken = [
                turned.differences(fixed, turned.solve_ring(nodes, Q, d * away), Q)
                for d in DISTANCES
            ]
            largest = [max(found.values()) for found in taken]
            traces.append(trace(body, DISTANCES, largest, mode="lines+markers"))
    for kind in ("spherical",) if run.quick else scenes.KINDS:
        # direct, since what iterations leave depends on the frame; on a mesh that suits that
        scene, mesh = scenes.meshed(run, kind, scenes.QUICK)
        with run.step(f"main bearing, {kind}"):
            model = build_model(scene, mesh)
            both = model, turned.moved_model(model, Q, far)
            one, two = (unit_load_response(m, "superlu") for m in both)
        found = turned.response_differences(one, two, Q)
        rows += check(page, f"main bearing, {kind}", "turned, 10 m away", found)

    worst = {body: max(column(of, "difference [-]")) for body, of in grouped(rows, "body")}
    answer(page, worst)
    page.section("Quarter ring")
    page.text(
        "One plane end is fixed, the other is a rigid face with six unit loads at its reference "
        "point; pressure on the inner cylinder, and a uniform body force. Mesh, supports and loads "
        "are turned and moved together; results are turned back and compared."
    )
    label, eps = "round-off of the coordinates, 1 m", np.finfo(float).eps
    traces.append(trace(label, DISTANCES, eps * np.array(DISTANCES), line={"dash": "dot"}))
    page.chart(AWAY, traces, "distance of the origin [m]", "relative difference [-]", "xy")
    page.section("All differences")
    page.text(
        "Of the main bearing the mesh itself is moved, not generated again: a mesh generator could "
        "make another one. Joint, springs, gravity and hub loads turn with it."
    )
    page.table("Largest differences, relative to the largest value of each load", rows)
    page.image("The quarter ring", run.sketch(regular(27, quarter_ring)(2)))
    page.data("differences", rows)
