"""Ties of a curved face whose meshes differ up to twenty times: torque lost, stress, refusals."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Elements round the coarser ring, and how many times as many round the finer.
COARSE, QUICK_COARSE = 5, 4
RATIOS = (1, 2, 3, 5, 8, 12, 20)
QUICK_RATIOS = (1, 2, 8)
#: Elements round the coarser ring in the sweep of its facets, the finer having twice as many.
ROUND = (3, 4, 6, 8, 12, 16, 24, 32)
QUICK_ROUND = (3, 6, 12, 24)
NODES = {10: "curved tetrahedra", 8: "straight hexahedra"}
#: Power of the facet's size by which two meshes of a cylinder lie apart.
ORDERS = {10: 3.0, 8: 2.0}

LOST = 0.01  # of a torque, that is let pass
FACTOR = 2.0  # on the error of rings that share their nodes, that is let pass


def run(run: Run) -> Any:
    """Twist tied rings at each ratio, either side the slave, as meshed and settled."""
    import numpy as np

    from fe_drivetrain.report import Limit, Section, Table, Text, chart, judge, trace
    from fe_drivetrain.validation import (
        tied_rings,
    )
    from fe_drivetrain.validation.tied_rings import (
        TIES,
        Tie,
        Twisted,
    )

    coarse = QUICK_COARSE if run.quick else COARSE
    ratios = QUICK_RATIOS if run.quick else RATIOS
    turns = QUICK_ROUND if run.quick else ROUND
    sides = ("finer", "coarser")

    with run.step("shared nodes"):
        shared = tied_rings.shared(coarse)
    settled: dict[tuple[str, str], list[Twisted]] = {}
    warned: dict[tuple[str, str], list[bool]] = {}
    with run.step("ratios, settled"):
        for side in sides:
            for ratio in ratios:
                pair = (coarse * ratio, coarse)
                own, other = pair if side == "finer" else pair[::-1]
                for kind in TIES:
                    run.report(f"{own} on {other}, {kind}")
                    tie = tied_rings.tied(own, other, kind)
                    settled.setdefault((kind, side), []).append(tied_rings.twist(tie.settled()))
                    warned.setdefault((kind, side), []).append(_said(tie, "finer face"))
    as_meshed: dict[tuple[int, str], list[Twisted]] = {}
    round_of: dict[tuple[int, str], list[int]] = {}
    no_tie: list[tuple[str, str, int]] = []
    mended: list[Twisted] = []
    ties: list[tuple[Tie, Twisted]] = []
    with run.step("facets, as meshed"):
        for nodes in NODES:
            for kind in ("standard", "node by node"):
                for turn in turns:
                    run.report(f"{2 * turn} on {turn}, {NODES[nodes]}, {kind}")
                    tie = tied_rings.tied(2 * turn, turn, kind, nodes)
                    if tie.tie is None:
                        no_tie.append((NODES[nodes], kind, turn))
                        continue
                    found = tied_rings.twist(tie)
                    as_meshed.setdefault((nodes, kind), []).append(found)
                    round_of.setdefault((nodes, kind), []).append(turn)
                    ties.append((tie, found))
                    if (nodes, kind) == (8, "standard"):
                        mended.append(tied_rings.twist(tie.settled()))
    with run.step("straight facets, coarser slave"):
        refused = [tied_rings.tied(8, 8 * ratio, "standard", 8) for ratio in ratios]

    def of(kind: str, side: str, what: str) -> Any:
        return np.array([getattr(found, what) for found in settled[kind, side]])

    def lost(nodes: int, kind: str) -> Any:
        return np.array([found.unbalanced for found in as_meshed[nodes, kind]])

    allowed = FACTOR * shared.stress
    stiff = abs(shared.stiffness - 1.0)
    verdicts = [
        judge(
            "remedy: torque lost by settled ties, of the torque, worst of all ratios, sides and "
            "ties",
            max(float(of(kind, side, "unbalanced").max()) for kind, side in settled),
            0.0,
            tolerance=1e-10,
            relative=False,
            source="settled nodes fulfil the tie in every rigid motion, so what it carries "
            "balances",
            reason="round-off times the condition",
            measure="identity",
        ),
        judge(
            "remedy: torque lost by straight facets once settled",
            max(found.unbalanced for found in mended),
            0.0,
            tolerance=1e-10,
            relative=False,
            source="the same",
            reason="round-off times the condition",
            measure="identity",
        ),
    ]
    for side in sides:
        values = of("standard", side, "stiffness")
        worst = int(np.argmax(np.abs(values - 1.0)))
        verdicts.append(
            judge(
                f"remedy: torsional stiffness, standard multipliers, settled, slave {side}, worst "
                f"ratio ({ratios[worst]} to 1), over the exact one",
                float(values[worst]),
                1.0,
                tolerance=2.0 * stiff,
                source="closed form: shear stress falls with r^-2",
                reason="twice the error of rings that share the coarser mesh's nodes: a tie of "
                "optimal order adds no more than the elements' own",
                measure="stiffness",
                band=stiff,
            )
        )
    for nodes, order in ORDERS.items():
        values = lost(nodes, "standard")[-3:]
        seen = -float(np.polyfit(np.log(round_of[nodes, "standard"][-3:]), np.log(values), 1)[0])
        verdicts.append(
            judge(
                f"failure: torque lost as meshed, {NODES[nodes]}: order in the facets' size that "
                f"it lacks to {order:g}",
                max(order - seen, 0.0),
                0.0,
                tolerance=0.25,
                relative=False,
                source="the gap between two meshes of a cylinder: the square of a straight facet's "
                "size, the cube of a curved quadratic one's",
                reason="a quarter for an order seen on three meshes",
                measure="order",
                band=0.25,
            )
        )
    node = of("node by node", "coarser", "stress")
    verdicts.append(
        judge(
            "failure: node by node, slave coarser: ratios over one at which the stress is off by "
            f"more than {FACTOR:g} times that of shared nodes",
            float((node[1:] > allowed).sum()),
            float(len(ratios) - 1),
            tolerance=0.0,
            source="forces arrive at few of the master's nodes",
            reason="a count",
            measure="identity",
        )
    )
    silent = sum(
        found.unbalanced > LOST and not _said(tie, "fail to balance") for tie, found in ties
    )
    verdicts.append(
        judge(
            f"protection: ties that lose more than {100 * LOST:g} % of a torque without a warning",
            float(silent),
            0.0,
            tolerance=0.0,
            relative=False,
            source="`mortar` warns of faces that lie apart by a hundredth of the face's radius",
            reason="a count",
            measure="identity",
        )
    )
    coarse_slave = [
        ratio
        for ratio, tie in zip(ratios, refused, strict=True)
        if tie.tie is None and _said(tie, "lie further apart")
    ]
    lowest_refused = min(coarse_slave, default=None)
    verdicts.append(
        judge(
            "protection: straight facets, 8 round, slave coarser: ratios over one that are neither "
            "refused with the cause nor warned of",
            float(
                sum(
                    not (_said(tie, "lie further apart") or _said(tie, "fail to balance"))
                    for tie in refused[1:]
                )
            ),
            0.0,
            tolerance=0.0,
            relative=False,
            source="gap of an octagon: 1 - cos(22.5 degrees) = 7.6 % of the radius, against a "
            "quarter of ever smaller facets",
            reason="a count",
            measure="identity",
        )
    )
    verdicts.append(
        judge(
            "protection: curved facets, warnings of a coarse slave, where it is coarser by three "
            "or more and where it is finer",
            float(
                sum(
                    flag != (side == "coarser")
                    for (_, side), flags in warned.items()
                    for ratio, flag in zip(ratios, flags, strict=True)
                    if ratio >= 3 or (side == "finer" and ratio > 1)
                )
            ),
            0.0,
            tolerance=0.0,
            relative=False,
            source="`mortar` warns of a slave with less than half of the master's nodes to an area",
            reason="a count of those that are wrong",
            measure="identity",
        )
    )

    least = {
        (nodes, kind): _least_round(round_of[nodes, kind], lost(nodes, kind))
        for nodes in NODES
        for kind in ("standard", "node by node")
    }
    most = {
        (kind, side): _last_ratio(ratios, of(kind, side, "stress"), allowed)
        for kind, side in settled
    }
    octagon = lost(8, "node by node").max()
    return CASE.results(
        run,
        summary=[
            f"Tied as meshed, a curved face loses torque, since two meshes of it lie apart: up to "
            f"{100 * max(lost(10, k).max() for k in ('standard', 'node by node')):.2g} % with "
            f"curved facets and {100 * octagon:.2g} % with straight ones. Settled, ties of every "
            "ratio lose nothing.",
            f"Settled mortar ties hold up to {ratios[-1]:g} to 1: torsional stiffness within "
            f"{100 * max(np.abs(of('standard', s, 'stiffness') - 1).max() for s in sides):.2g} %. "
            "Node by node with a coarser slave stress is off by "
            f"{100 * node[1]:.0f} to {100 * node.max():.0f} % and the stiffness by "
            f"{100 * np.abs(of('node by node', 'coarser', 'stiffness') - 1).max():.2g} %.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Gaps between facets",
                items=[
                    chart(
                        "Torque that the tie loses, of the torque; slave twice as fine. Shaded "
                        f"where curved facets lose less than {100 * LOST:g} %",
                        [
                            *(
                                trace(
                                    f"{NODES[nodes]}, {kind}",
                                    round_of[nodes, kind],
                                    np.maximum(lost(nodes, kind), 1e-16),
                                    mode="lines+markers",
                                )
                                for nodes, kind in as_meshed
                            ),
                            trace(
                                "straight hexahedra, settled (remedy)",
                                round_of[8, "standard"],
                                [max(found.unbalanced, 1e-16) for found in mended],
                                mode="lines+markers",
                                line={"dash": "dash"},
                            ),
                            *(
                                [
                                    trace(
                                        "refused",
                                        [turn for *_, turn in no_tie],
                                        [1.0] * len(no_tie),
                                        points=True,
                                        text=[f"{name}, {kind}" for name, kind, _ in no_tie],
                                        marker={"symbol": "x"},
                                    )
                                ]
                                if no_tie
                                else []
                            ),
                        ],
                        "elements round the coarser ring",
                        "torque lost",
                        logarithmic="xy",
                        safe=(least[10, "standard"], None),
                    ),
                    Text(
                        text="The bore is held, the outside turned. What is lost shows as a "
                        "difference between the two reactions, which rigid rotations of the "
                        "tied faces do work on. An octagon of straight facets lies 7.6 % inside "
                        "its cylinder."
                    ),
                    Table(
                        caption="Straight hexahedra, 8 round the slave, standard multipliers: what "
                        "the program says",
                        columns=["ratio", "said"],
                        rows=[
                            [f"{ratio} to 1", "; ".join(tie.said) or "nothing"]
                            for ratio, tie in zip(ratios, refused, strict=True)
                        ],
                    ),
                ],
            ),
            Section(
                title="Mesh ratio",
                items=[
                    chart(
                        "Stress in the outer ring, settled ties of curved tetrahedra: root mean "
                        "square error over the shear stress at the tie. Shaded where ties node by "
                        f"node, slave coarser, are within {FACTOR:g} times that of shared nodes",
                        [
                            *(
                                trace(
                                    f"{kind}, slave {side}",
                                    ratios,
                                    of(kind, side, "stress"),
                                    mode="lines+markers",
                                    line={} if side == "finer" else {"dash": "dash"},
                                )
                                for kind, side in settled
                            ),
                            trace(
                                "shared nodes, coarser mesh",
                                [ratios[0], ratios[-1]],
                                [shared.stress] * 2,
                                line={"dash": "dot"},
                            ),
                        ],
                        "elements of the finer ring to one of the coarser",
                        "error of the stress",
                        logarithmic="xy",
                        safe=(None, most["node by node", "coarser"] or ratios[0]),
                    ),
                    Table(
                        caption="Settled ties of curved tetrahedra: torsional stiffness over the "
                        "exact one, less one",
                        columns=["ratio", "slave", *TIES],
                        rows=[
                            [
                                f"{ratio} to 1",
                                side,
                                *(settled[kind, side][k].stiffness - 1.0 for kind in TIES),
                            ]
                            for k, ratio in enumerate(ratios)
                            for side in sides
                        ],
                    ),
                ],
            ),
        ],
        limits=[
            *(
                Limit(
                    method=f"tie of a cylinder as meshed, {NODES[nodes]}, {kind}",
                    parameter="elements round the coarser face",
                    low=least[nodes, kind],
                    criterion=f"torque lost below {100 * LOST:g} %",
                    beyond=f"reactions out of balance by up to "
                    f"{100 * lost(nodes, kind).max():.2g} %",
                    program="warns of faces further apart than a hundredth of their radius",
                    remedy="`mortar.settled`: nothing is lost",
                )
                for nodes, kind in as_meshed
            ),
            Limit(
                method="mortar tie of a cylinder, straight facets, slave coarser (8 round)",
                parameter="elements of the finer face to one of the coarser",
                high=_before(ratios, lowest_refused),
                criterion="tied at all",
                beyond="facets lie further apart than a quarter of a fine facet, and do not meet",
                program="refuses, names the gap and the mend",
                remedy="the finer face as the slave, or curved facets",
            ),
            Limit(
                method="tie of a cylinder node by node, settled, slave coarser",
                parameter="elements of the finer face to one of the coarser",
                high=most["node by node", "coarser"],
                criterion=f"error of the stress within {FACTOR:g} times that of shared nodes",
                beyond=f"stress off by up to {100 * node.max():.0f} %, stiffness by "
                f"{100 * np.abs(of('node by node', 'coarser', 'stiffness') - 1).max():.2g} %",
                program="warns of a slave that is the coarser",
                remedy="mortar tie, or the finer face as the slave",
            ),
            *(
                Limit(
                    method=f"mortar tie of a cylinder, {kind} multipliers, settled, slave {side}",
                    parameter="elements of the finer face to one of the coarser",
                    high=None if most[kind, side] == ratios[-1] else most[kind, side],
                    criterion=f"error of the stress within {FACTOR:g} times that of shared nodes",
                    beyond=f"largest error of the stress in the sweep "
                    f"{100 * of(kind, side, 'stress').max():.2g} %",
                    program="warns of a slave that is the coarser"
                    if side == "coarser"
                    else "nothing to be done",
                    remedy="the finer face as the slave",
                )
                for kind in ("standard", "dual")
                for side in sides
            ),
        ],
        figures={
            "ratios": list(ratios),
            "stress": {f"{k}, slave {s}": of(k, s, "stress").tolist() for k, s in settled},
            "stiffness": {f"{k}, slave {s}": of(k, s, "stiffness").tolist() for k, s in settled},
            "shared": {"stress": shared.stress, "stiffness": shared.stiffness},
            "elements round": list(turns),
            "torque lost": {
                f"{NODES[nodes]}, {kind}": lost(nodes, kind).tolist() for nodes, kind in as_meshed
            },
        },
    )


def _said(tie: Any, words: str) -> bool:
    return any(words in sentence for sentence in tie.said)


def _least_round(turns: Any, lost: Any) -> float | None:
    """Least number of elements from which on all lose less than is let pass; None if all do."""
    bad = [turn for turn, value in zip(turns, lost, strict=True) if value > LOST]
    if not bad:
        return None
    return float(min((turn for turn in turns if turn > max(bad)), default=turns[-1]))


def _last_ratio(ratios: Any, errors: Any, allowed: float) -> float | None:
    """The last ratio up to which the error is let pass; None where it never is."""
    last = None
    for ratio, error in zip(ratios, errors, strict=True):
        if error > allowed:
            break
        last = float(ratio)
    return last


def _before(ratios: Any, refused: float | None) -> float | None:
    """The last ratio before one that is refused."""
    if refused is None:
        return None
    return float(max((ratio for ratio in ratios if ratio < refused), default=refused))


CASE = Case(
    name="stability/mesh_ratio_curved",
    title="Ties of a cylinder with meshes up to twenty times apart: balance, stress, stiffness",
    source="closed form of the twisted ring; Puso 2004, Int. J. Numer. Meth. Engng 59, 315",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
