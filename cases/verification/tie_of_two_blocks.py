"""A square bar cut by a plane tie of meshes that do not match: twisted, bent and loaded across."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

LENGTH = 3.0  # m, of a bar of section 1 m x 1 m, cut in its middle
E, NU = 210e9, 0.3

#: Divisions of the section's sides: of the slave, of the master.
RATIOS = ((2, 4), (2, 3), (2, 2), (3, 2), (4, 2))
QUICK_RATIOS = ((2, 3), (2, 2), (3, 2))
TIES = ("dual", "standard", "node by node")
UNCUT = (2, 3, 4)
QUICK_UNCUT = (1, 2, 3)


def run(run: Run) -> Any:
    """Stiffness of the tied bar beside that of the whole one."""
    import numpy as np

    from fe_drivetrain.compare import grid_convergence
    from fe_drivetrain.report import Section, Table, Text, chart, judge, trace

    ratios = QUICK_RATIOS if run.quick else RATIOS
    with run.step("uncut bar"):
        meshes = QUICK_UNCUT if run.quick else UNCUT
        uncut = {n: stiffnesses(bar(n)) for n in meshes}
        across = grid_convergence(
            [1.0 / n for n in meshes], [float(uncut[n]["across"]) for n in meshes]
        )
    with run.step("tied bars"):
        tied: dict[str, list[dict[str, Any]]] = {
            kind: [stiffnesses(*tied_bar(own, other, kind)) for own, other in ratios]
            for kind in TIES
        }
    exact = {
        "twist": torsion_stiffness(),
        "bend": E / 12.0 / LENGTH,
        "across": across.extrapolated,
    }
    titles = {"twist": "torsion", "bend": "pure bending", "across": "force across a clamped bar"}
    coarse = {q: abs(uncut[2][q] / exact[q] - 1.0) for q in exact}

    def errors(kind: str, quantity: str) -> Any:
        return np.abs([found[quantity] / exact[quantity] - 1.0 for found in tied[kind]])

    verdicts = []
    for quantity, reason in (
        (
            "twist",
            "twice the error of the whole bar of the coarser mesh: a tie of optimal order adds no "
            "more than the elements' own error",
        ),
        (
            "across",
            "twice the error of the whole bar of the coarser mesh, and the band of the reference",
        ),
    ):
        extra = across.extrapolated_uncertainty / exact[quantity] if quantity == "across" else 0.0
        for kind in ("dual", "standard"):
            worst = int(np.argmax(errors(kind, quantity)))
            own, other = ratios[worst]
            computed = float(tied[kind][worst][quantity])
            verdicts.append(
                judge(
                    f"{titles[quantity]}: stiffness, {kind} multipliers, worst of all ratios "
                    f"({own} on {other})",
                    computed,
                    float(exact[quantity]),
                    tolerance=2.0 * coarse[quantity] + extra,
                    unit="N/m" if quantity == "across" else "N m/rad",
                    source="St Venant's series for the square bar (Timoshenko and Goodier art 109)"
                    if quantity == "twist"
                    else f"whole bar, {across.sentence('N/m')}",
                    reason=reason,
                    measure="stiffness",
                    band=coarse[quantity] * exact[quantity],
                )
            )
    verdicts.append(
        judge(
            "pure bending: stiffness, standard multipliers, worst of all ratios",
            1.0 + float(errors("standard", "bend").max()),
            1.0,
            tolerance=1e-10,
            source="E I / L; displacements are quadratic, tractions linear",
            reason="elements and multipliers hold both exactly; round-off times the condition",
            measure="identity",
        )
    )
    verdicts.append(
        judge(
            "pure bending: stiffness, dual multipliers, worst of all ratios",
            float(tied["dual"][int(np.argmax(errors("dual", "bend")))]["bend"]),
            float(exact["bend"]),
            tolerance=2.0 * coarse["twist"],
            unit="N m/rad",
            source="E I / L",
            reason="twice the error of torsion of the coarser mesh: dual multipliers hold only "
            "constant tractions; their error with linear ones is to stay below the elements'",
            measure="stiffness",
            band=float(errors("dual", "bend").max()) * exact["bend"],
        )
    )
    for name, key in (("forces", "unbalanced force"), ("moments", "unbalanced moment")):
        verdicts.append(
            judge(
                f"{name} on both sides of the tie, of the end's, worst of all",
                max(found[key] for kind in ("dual", "standard") for found in tied[kind]),
                0.0,
                tolerance=1e-10,
                relative=False,
                source="equilibrium: the rows of the tie hold every rigid motion",
                reason="round-off times the bar's condition",
                measure="identity",
            )
        )

    labels = [f"{own} on {other}" for own, other in ratios]
    charts = []
    for quantity, title in titles.items():
        traces = []
        for kind in TIES:
            line = trace(kind, [], np.maximum(errors(kind, quantity), 1e-15))
            traces.append(line | {"x": labels, "mode": "lines+markers"})
        if coarse[quantity] > 1e-9:
            line = trace("whole bar, 2 divisions", [], [coarse[quantity]] * len(labels))
            traces.append(line | {"x": labels, "line": {"dash": "dot"}})
        charts.append(
            chart(
                f"Error of the stiffness: {title}",
                traces,
                "divisions of the slave on those of the master",
                "relative error",
                logarithmic="y",
            )
        )
    entries: list[list[Any]] = [[label] for label in labels]
    for kind in TIES:
        for row, found in zip(entries, tied[kind], strict=True):
            row.append(int(found["row"]))
    with run.step("fill"):
        fill = fill_in(4 if run.quick else 8)
    largest = max(
        float(errors(kind, q).max()) for kind in ("dual", "standard") for q in ("twist", "across")
    )
    return CASE.results(
        run,
        summary=[
            f"A bar cut in two and tied with meshes of ratios up to "
            f"{max(max(r) / min(r) for r in ratios):g} to 1 is within {100 * largest:.2g} % of the "
            "whole bar, whichever side is the slave; the coarser half alone accounts for "
            f"{100 * max(coarse['twist'], coarse['across']):.2g} %.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Stiffness against mesh ratio",
                items=[
                    *charts,
                    Text(
                        text="In torsion ends turn rigidly in their plane and are free to warp, so "
                        "St Venant's solution is exact in the whole bar. In pure bending the "
                        "displacements are quadratic and the tractions on the tie linear: "
                        "elements and standard multipliers hold both exactly, dual multipliers "
                        "hold constant tractions only. The clamped bar, loaded across its end, "
                        "has no closed form: the reference is the whole bar, extrapolated."
                    ),
                ],
            ),
            Section(
                title="Standard and dual multipliers",
                items=[
                    Text(
                        text="Standard multipliers are the more accurate ones, as pure bending "
                        "shows. With them every node of the slave follows all nodes of the master: "
                        "on large faces the stiffness fills up, and dual multipliers, which are "
                        "local, are the better bargain."
                    ),
                    Table(
                        caption="Faces that do not match, n on n - 1 divisions: entries of a row "
                        "of the tie (mean), and of the stiffness that is factorised",
                        columns=[
                            "divisions",
                            "slave nodes",
                            "row, dual",
                            "row, standard",
                            "stiffness, dual",
                            "stiffness, standard",
                        ],
                        rows=fill,
                    ),
                    Table(
                        caption="Entries of a row of the tie in the bars above (mean)",
                        columns=["slave on master", *TIES],
                        rows=entries,
                    ),
                ],
            ),
        ],
        figures={
            "ratios": labels,
            "errors": {q: {k: errors(k, q).tolist() for k in TIES} for q in exact},
            "whole bar": {q: [float(uncut[n][q]) for n in meshes] for q in exact},
        },
    )


def lame() -> tuple[float, float]:
    return E * NU / ((1.0 + NU) * (1.0 - 2.0 * NU)), E / (2.0 * (1.0 + NU))


def torsion_stiffness() -> float:
    """G J / L of the square section, side 1 m: J = 1/3 - 64/pi^5 sum tanh(k pi/2) / k^5, k odd."""
    import math

    series = sum(math.tanh(0.5 * k * math.pi) / k**5 for k in range(1, 40, 2))
    return E / (2.0 * (1.0 + NU)) * (1.0 / 3.0 - 64.0 / math.pi**5 * series) / LENGTH


def part(n: int, start: float, stop: float) -> Any:
    """The bar between two stations, its axis on x, n divisions across."""
    from fe_drivetrain.mesh import brick

    def shape(x: Any) -> Any:
        return x * [stop - start, 1.0, 1.0] + [start, -0.5, -0.5]

    return brick((max(round(n * (stop - start)), 1), n, n), 10, shape)


def bar(n: int) -> Any:
    from fe_drivetrain.validation import (
        two_bodies,
    )

    return two_bodies.together(part(n, 0.0, LENGTH))


def tied_bar(own: int, other: int, kind: Any) -> tuple[Any, Any]:
    """Both halves, and the tie between them; the slave is the first."""
    from fe_drivetrain.interfaces import mortar_tie, node_tie
    from fe_drivetrain.validation import (
        two_bodies,
    )

    # The slave's inner nodes are moved: the same number of divisions does not match either.
    half = 0.5 * LENGTH
    bodies = two_bodies.together(moved(part(own, 0.0, half)), part(other, half, LENGTH))
    faces = bodies.faces[0]["x1"], bodies.faces[1]["x0"]
    n = bodies.points.size
    if kind == "node by node":
        return bodies, node_tie("tie", bodies.points, *faces, n)
    return bodies, mortar_tie("tie", bodies.points, *faces, n, kind)


def moved(block: Any) -> Any:
    """The half with the inner nodes of its section moved along y and z."""
    from dataclasses import replace

    from fe_drivetrain.mesh import straightened

    points = block.points.copy()
    points[:, 1:] += 0.2 * (0.25 - points[:, 1:] ** 2)
    return replace(block, points=straightened(points, block.cells))


def stiffnesses(bodies: Any, tie: Any = None) -> dict[str, float]:
    """Stiffness in torsion, pure bending and across; what is out of balance between the halves."""
    import numpy as np

    from fe_drivetrain.common import rigid_motions
    from fe_drivetrain.interfaces import held_dofs, held_nodes
    from fe_drivetrain.operator import traction_loads
    from fe_drivetrain.validation import (
        two_bodies,
    )

    points, n = bodies.points, bodies.points.size
    K = bodies.stiffness(lame())
    ties = [] if tie is None else [tie]
    front, rear = np.unique(bodies.faces[0]["x0"]), bodies.faces[-1]["x1"]
    ends = np.concatenate([front, np.unique(rear)])
    y, z = points[ends, 1], points[ends, 2]

    # Ends turned by half a radian either way, free to warp.
    across = (3 * ends[:, None] + [1, 2]).ravel()
    turned = np.where(points[ends, 0] > 0.5 * LENGTH, 0.5, -0.5)
    g = np.column_stack([-turned * z, turned * y]).ravel()
    centre = front[np.argmin(np.abs(points[front, 1:]).sum(axis=1))]
    supports = [
        held_dofs("ends", across, n),
        held_nodes("axial", np.array([centre]), (0,), n),
    ]
    twisted = two_bodies.solve(K, [*ties, *supports], np.zeros((n, 1)), {"ends": g[:, None]})
    twist = float(twisted.u[:, 0] @ (K @ twisted.u[:, 0]))

    def bending(positions: Any, normals: Any) -> Any:
        return positions[:, [2]] * normals

    bend_load = traction_loads(points, bodies.faces[0]["x0"], bending, n)
    bend_load = (bend_load + traction_loads(points, rear, bending, n))[:, None]
    bent = two_bodies.solve(K, [*ties, two_bodies.isostatic(points, front, n)], bend_load)
    moment = 1.0 / 12.0
    bend = moment**2 / (bend_load[:, 0] @ bent.u[:, 0])

    force = traction_loads(points, rear, np.array([0.0, 0.0, 1.0]), n)[:, None]
    clamped = two_bodies.solve(K, [*ties, held_nodes("clamp", front, (0, 1, 2), n)], force)
    found = {
        "twist": twist,
        "bend": float(bend),
        "across": float(1.0 / (force.T @ clamped.u)[0, 0]),
    }
    if tie is not None:
        unbalanced = []
        for state, sizes in ((twisted, (1.0, twist)), (bent, (1.0, moment)), (clamped, (1.0, 1.5))):
            resultant = np.abs(rigid_motions(points).T @ state.carried("tie"))[:, 0]
            unbalanced.append((resultant[:3].max() / sizes[1], resultant[3:].max() / sizes[1]))
        found["unbalanced force"] = float(max(force for force, _ in unbalanced))
        found["unbalanced moment"] = float(max(moment for _, moment in unbalanced))
        found["row"] = tie.rows.nnz / tie.rows.shape[0]
    return found


def fill_in(largest: int) -> list[list[Any]]:
    """Rows of ties and entries of stiffnesses on ever finer faces."""
    import numpy as np

    from fe_drivetrain.interfaces import eliminate, mortar_tie
    from fe_drivetrain.mesh import brick
    from fe_drivetrain.validation import (
        two_bodies,
    )

    rows = []
    n = 4
    while n <= largest:
        bodies = two_bodies.together(
            brick((1, n, n), 10), brick((1, n - 1, n - 1), 10, lambda x: x + np.eye(3)[0])
        )
        K = bodies.stiffness(lame())
        faces = bodies.faces[0]["x1"], bodies.faces[1]["x0"]
        lengths, entries = [], []
        for kind in ("dual", "standard"):
            tie = mortar_tie("tie", bodies.points, *faces, bodies.points.size, kind)
            elimination = eliminate([tie], bodies.points.size)
            T = elimination.T[:, elimination.free]
            lengths.append(tie.rows.nnz / tie.rows.shape[0])
            entries.append(int((T.T @ K @ T).nnz))
        rows.append([n, tie.rows.shape[0] // 3, *lengths, *entries])
        n *= 2
    return rows


CASE = Case(
    name="verification/tie_of_two_blocks",
    title="A bar cut in two and tied: stiffness against mesh ratio",
    source="St Venant's torsion and bending of a square bar; the whole bar",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
