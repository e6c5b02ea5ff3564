"""Results do not know where the frame's origin is, nor how its axes are turned."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Distances of the origin that are tried [m].
DISTANCES = (1.0, 10.0, 100.0, 1e3, 1e4, 1e5)
SEED = 7

ROUND_OFF = (
    "coordinates lose a digit for each power of ten of the distance over the body's size; solver "
    "round-off, up to 1e-10 with these condition numbers, is more"
)


def run(run: Run) -> Any:
    """Solve solids, and the main bearing, again after a random rotation and a translation."""
    import numpy as np
    from scipy.spatial.transform import Rotation

    from fe_drivetrain.cases.verification import (
        scenes,
    )
    from fe_drivetrain.report import Chart, Section, Table, Text, judge, trace
    from fe_drivetrain.response import build_model, unit_load_response
    from fe_drivetrain.validation import (
        turned_frames,
    )

    rng = np.random.default_rng(SEED)
    Q = Rotation.random(random_state=rng).as_matrix()
    away = rng.normal(size=3)
    away /= np.linalg.norm(away)
    still = np.eye(3)

    moves = {
        "turned": (Q, np.zeros(3)),
        "10 m away": (still, 10.0 * away),
        "turned, 10 m away": (Q, 10.0 * away),
    }
    rows: list[list[Any]] = []
    verdicts, traces = [], []

    def judged(body: str, move: str, differences: dict[str, float]) -> None:
        rows.extend([body, move, what, value] for what, value in differences.items())
        verdicts.append(
            judge(
                f"{body}, {move}: largest difference of {', '.join(differences)}, relative",
                max(differences.values()),
                0.0,
                tolerance=1e-9,
                relative=False,
                source="exact: the equations of elasticity are the same in every frame",
                reason=ROUND_OFF,
                measure="identity",
                band=0.0,
            )
        )

    for nodes, label in ((10, "curved tetrahedra"), (27, "27-node hexahedra")):
        with run.step(f"quarter ring, {label}"):
            here = turned_frames.solve_ring(nodes, still, np.zeros(3))
            for move, (turn, shift) in moves.items():
                there = turned_frames.solve_ring(nodes, turn, shift)
                judged(f"quarter ring, {label}", move, turned_frames.differences(here, there, turn))
            far = [
                max(
                    turned_frames.differences(
                        here, turned_frames.solve_ring(nodes, Q, d * away), Q
                    ).values()
                )
                for d in DISTANCES
            ]
            traces.append(trace(f"quarter ring, {label}", DISTANCES, far, mode="lines+markers"))

    for kind in ("spherical",) if run.quick else scenes.KINDS:
        # Direct, since what iterations leave depends on the frame; on a mesh that suits that.
        scene, mesh = scenes.meshed(run, kind, scenes.QUICK)
        with run.step(f"main bearing, {kind}"):
            model = build_model(scene, mesh)
            moved = turned_frames.moved_model(model, Q, 10.0 * away)
            one, other = (unit_load_response(m, "superlu") for m in (model, moved))
            differences = turned_frames.response_differences(one, other, Q)
        judged(f"main bearing, {kind}", "turned, 10 m away", differences)

    round_off = np.finfo(float).eps * np.array(DISTANCES)
    label = "round-off of the coordinates, 1 m"
    traces.append(trace(label, DISTANCES, round_off, line={"dash": "dot"}))
    chart = Chart(
        caption="Largest relative difference of results, turned and taken away from the origin",
        figure={
            "data": traces,
            "layout": {
                "xaxis": {"title": {"text": "distance of the origin [m]"}, "type": "log"},
                "yaxis": {
                    "title": {"text": "relative difference [-]"},
                    "type": "log",
                    "exponentformat": "power",
                },
            },
        },
    )
    worst = {
        body: max(r[3] for r in rows if r[0] == body) for body in dict.fromkeys(r[0] for r in rows)
    }
    return CASE.results(
        run,
        seed=SEED,
        summary=[
            "Turned at random and moved by 10 m, displacements, reactions and stiffness turn along "
            f"and stay the same: {'; '.join(f'{b} {w:.0e}' for b, w in worst.items())}.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Quarter ring",
                items=[
                    Text(
                        text="One plane end is fixed, the other is a rigid face with six unit "
                        "loads at its reference point; pressure on the inner cylinder, and a "
                        "uniform body force. Mesh, supports and loads are turned and moved "
                        "together; results are turned back and compared."
                    ),
                    chart,
                ],
            ),
            Section(
                title="All differences",
                items=[
                    Text(
                        text="Of the main bearing the mesh itself is moved, not made again: a mesh "
                        "generator could make another one. Joint, springs, gravity and hub loads "
                        "turn with it."
                    ),
                    Table(
                        caption="Largest differences, relative to the largest value of each load",
                        columns=["body", "frame", "quantity", "difference [-]"],
                        rows=rows,
                    ),
                ],
            ),
        ],
    )


CASE = Case(
    name="verification/frame_invariance",
    title="Reactions and stiffness do not depend on the frame's origin and rotation",
    source="exact: invariance under rigid motions of the frame",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
