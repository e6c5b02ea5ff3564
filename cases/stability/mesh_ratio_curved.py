"""Ties of a curved face whose meshes differ up to twenty times: torque lost, stress, refusals."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import tied_rings
from fe_drivetrain.cases.references.tied_rings import TIES, Tie, Twisted
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import fitted_exponent, last_within
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run, column, grouped

#: Elements round the coarser ring, and how many times as many round the finer.
COARSE, QUICK_COARSE = 5, 4
RATIOS = (1, 2, 3, 5, 8, 12, 20)
QUICK_RATIOS = (1, 2, 8)
SIDES = ("finer", "coarser")
#: Elements round the coarser ring in the sweep of its facets, the finer having twice as many.
ROUND = (3, 4, 6, 8, 12, 16, 24, 32)
QUICK_ROUND = (3, 6, 12, 24)
NODES = {10: "curved tetrahedra", 8: "straight hexahedra"}
#: Power of the facet's size by which two meshes of a cylinder lie apart.
ORDERS = {10: 3.0, 8: 2.0}

LOST = 0.01  # of a torque, that is accepted
SETTLED = 1e-10  # of a torque, that settled nodes may lose to round-off
FACTOR = 2.0  # on the error of rings that share their nodes, that is accepted

TORQUE = (
    "Share of the torque that a tie loses, over the elements round; slave twice as fine; shaded: "
    f"curved elements below {100 * LOST:g} %"
)
GAP, FINER, APART = "fail to balance", "finer face", "lie further apart"
"""Words by which the messages of ties are recognised."""


def reports(tie: Tie, words: str) -> bool:
    """Whether a tie warns, or refuses, with these words."""
    return any(words in message for message in tie.messages)


def settled_ties(run: Run, coarse: int, ratios: Sequence[int]) -> list[Record]:
    """Twisted rings of curved tetrahedra, either one the finer, their nodes settled."""
    rows: list[Record] = []
    for side in SIDES:
        for ratio in ratios:
            own, other = (coarse * ratio, coarse) if side == "finer" else (coarse, coarse * ratio)
            for kind in TIES:
                run.report(f"{own} on {other}, {kind}")
                tie = tied_rings.tied(own, other, kind)
                found = tied_rings.twist(tie.settled())
                rows.append(
                    {
                        "ratio": ratio,
                        "slave": side,
                        "tie": kind,
                        "stiffness over the exact one": found.stiffness,
                        "torque lost": found.unbalanced,
                        "error of the stress": found.stress,
                        "warned": reports(tie, FINER),
                    }
                )
    return rows


def ties_as_meshed(run: Run, turns: Sequence[int]) -> list[Record]:
    """Twisted rings of ever more facets, the slave twice as fine; refused ones without a torque."""
    rows: list[Record] = []
    for nodes, name in NODES.items():
        for kind in ("standard", "node by node"):
            for turn in turns:
                run.report(f"{2 * turn} on {turn}, {name}, {kind}")
                tie = tied_rings.tied(2 * turn, turn, kind, nodes)
                found = None if tie.tie is None else tied_rings.twist(tie)
                remedied = found and nodes == 8 and kind == "standard"
                rows.append(
                    {
                        "elements": name,
                        "tie": kind,
                        "elements round": turn,
                        "torque lost": np.nan if found is None else found.unbalanced,
                        "once settled": tied_rings.twist(tie.settled()).unbalanced
                        if remedied
                        else np.nan,
                        "warned": reports(tie, GAP),
                    }
                )
    return rows


def series(rows: list[Record], kind: str, side: str, what: str) -> Floats:
    """One quantity of settled ties over the ratios."""
    return np.array([r[what] for r in rows if r["tie"] == kind and r["slave"] == side])


@case(
    "Ties of a cylinder with meshes up to twenty times apart: balance, stress, stiffness",
    source="closed form of the twisted ring; Puso 2004, Int. J. Numer. Meth. Engng 59, 315",
)
def run(run: Run, page: Page) -> None:
    """Twist tied rings at each ratio, either side the slave, as meshed and settled."""
    coarse = QUICK_COARSE if run.quick else COARSE
    ratios = QUICK_RATIOS if run.quick else RATIOS
    with run.step("shared nodes"):
        shared = tied_rings.shared(coarse)
    with run.step("ratios, settled"):
        settled = settled_ties(run, coarse, ratios)
    with run.step("facets, as meshed"):
        as_meshed = ties_as_meshed(run, QUICK_ROUND if run.quick else ROUND)
    with run.step("straight facets, coarser slave"):
        coarse_slaves = [tied_rings.tied(8, 8 * ratio, "standard", 8) for ratio in ratios]
    check_remedy(page, settled, as_meshed, shared)
    check_failures(page, settled, as_meshed, FACTOR * shared.stress)
    check_protection(page, settled, as_meshed, coarse_slaves)
    show(page, settled, as_meshed)
    show_facets(page, as_meshed, ratios, coarse_slaves)
    show_ratios(page, settled, shared)
    page.image(
        "Rings that are tied, eight elements round on sixteen",
        run.sketch(tied_rings.tied(8, 16, "standard").bodies),
    )
    page.data("settled", settled)
    page.data("as meshed", as_meshed)
    page.data("shared", {"stress": shared.stress, "stiffness": shared.stiffness})


def check_remedy(
    page: Page, settled: list[Record], as_meshed: list[Record], shared: Twisted
) -> None:
    """Settled ties lose no torque, and have the stiffness of the elements."""
    page.vanishes(
        "remedy: torque lost by settled ties, of the torque, worst of all ratios, sides and ties",
        max(column(settled, "torque lost")),
        within=SETTLED,
        why="round-off times the condition of the finer ring",
        source="settled nodes fulfil the tie in every rigid motion, so its forces balance",
    )
    page.vanishes(
        "remedy: torque lost by straight facets once settled",
        np.nanmax(column(as_meshed, "once settled")),
        within=SETTLED,
        why="round-off times the condition of the finer ring",
        source="settled nodes fulfil the tie in every rigid motion, so its forces balance",
    )
    ratios = list(dict.fromkeys(column(settled, "ratio")))
    own = abs(shared.stiffness - 1.0)
    for side in SIDES:
        values = series(settled, "standard", side, "stiffness over the exact one")
        worst = int(np.argmax(np.abs(values - 1.0)))
        page.equals(
            f"remedy: torsional stiffness, standard multipliers, settled, slave {side}, worst "
            f"ratio ({ratios[worst]} to 1), over the exact one",
            values[worst],
            1.0,
            within=2.0 * own,
            why="twice the error of rings that share the coarser mesh's nodes: a tie of optimal "
            "order adds no more than the elements' own",
            source="closed form: shear stress falls with r^-2",
            measure="stiffness",
            band=own,
        )


def check_failures(
    page: Page, settled: list[Record], as_meshed: list[Record], allowed: float
) -> None:
    """The order of the torque lost, and ties node by node."""
    for nodes, order in ORDERS.items():
        rows = [
            r
            for r in as_meshed
            if (r["elements"], r["tie"]) == (NODES[nodes], "standard")
            and np.isfinite(r["torque lost"])
        ][-3:]
        exponent, band = fitted_exponent(
            column(rows, "elements round"), column(rows, "torque lost")
        )
        page.at_least(
            f"failure: torque lost as meshed, {NODES[nodes]}: order in the facets' size",
            -exponent,
            order - 0.25,
            why=f"the order is {order:g} in the limit of small facets; facets of 22 degrees, the "
            "coarsest of the three meshes fitted (60 in a quick run), still have higher powers: a "
            "quarter",
            source="the gap between two meshes of a cylinder: the square of a straight facet's "
            "size, the cube of a curved quadratic one's",
            measure="order",
            band=band,
        )
    node = series(settled, "node by node", "coarser", "error of the stress")
    page.equals(
        "failure: node by node, slave coarser: ratios over one with an error of the stress of more "
        f"than {FACTOR:g} times that of shared nodes",
        (node[1:] > allowed).sum(),
        len(node) - 1,
        within=0.0,
        why="the forces arrive at the wrong nodes at every ratio, so none can pass",
        source="forces arrive at few of the master's nodes",
        measure="identity",
    )


def check_protection(
    page: Page, settled: list[Record], as_meshed: list[Record], coarse_slaves: list[Tie]
) -> None:
    """Whether the program warns, or refuses, wherever a tie is wrong."""
    page.vanishes(
        f"protection: ties that lose more than {100 * LOST:g} % of a torque without a warning",
        sum(r["torque lost"] > LOST and not r["warned"] for r in as_meshed),
        within=0.0,
        why="a torque that is lost shows in no other way",
        source="`mortar` warns of faces that lie apart by a hundredth of the face's radius",
    )
    page.vanishes(
        "protection: straight facets, 8 round, slave coarser: ratios over one that are neither "
        "refused with the cause nor warned of",
        sum(not (reports(tie, APART) or reports(tie, GAP)) for tie in coarse_slaves[1:]),
        within=0.0,
        why="the gap is a large part of a fine facet at each of these ratios",
        source="gap of an octagon: 1 - cos(22.5 degrees) = 7.6 % of the radius, against a quarter "
        "of ever smaller facets",
    )
    page.vanishes(
        "protection: curved facets, warnings of a coarse slave, where it is coarser by three or "
        "more and where it is finer: missing ones and needless ones",
        sum(
            r["warned"] != (r["slave"] == "coarser")
            for r in settled
            if r["ratio"] >= 3 or (r["slave"] == "finer" and r["ratio"] > 1)
        ),
        within=0.0,
        why="a missing warning leaves an error unseen, and a needless one teaches to ignore it",
        source="`mortar` warns of a slave with less than half of the master's nodes to an area",
    )


def show(page: Page, settled: list[Record], as_meshed: list[Record]) -> None:
    """The answer."""
    node = series(settled, "node by node", "coarser", "error of the stress")
    stiffness = [
        abs(r["stiffness over the exact one"] - 1) for r in settled if r["tie"] == "standard"
    ]
    of = {nodes: [r for r in as_meshed if r["elements"] == name] for nodes, name in NODES.items()}
    needed = {nodes: round_needed(rows) for nodes, rows in of.items()}
    worst = 100 * np.nanmax(column(of[8], "torque lost"))
    lost, ratio = max(column(settled, "torque lost")), settled[-1]["ratio"]
    unequal = min(r["ratio"] for r in settled if r["ratio"] > 1)
    page.answer(
        "How many elements round does a tied cylinder need to pass on its torque?",
        f"A tied cylinder needs {needed[10]} curved or {needed[8]} straight elements round to lose "
        f"under {100 * LOST:g}\u00a0% of its torque; node-by-node ties miss the stress by "
        f"{100 * node.max():.0f}\u00a0%.",
        [
            page.value(
                f"curved elements round for under {100 * LOST:g} % of torque lost", needed[10]
            ),
            page.value(
                f"straight elements round for under {100 * LOST:g} % of torque lost", needed[8]
            ),
            page.value("worst torque lost, straight elements, nodes not moved [%]", worst),
            page.value(
                "worst torque lost, nodes moved onto the other face [%]",
                100 * lost,
                at_most=100 * SETTLED,
            ),
            page.value("worst error of torsional stiffness, nodes moved [%]", 100 * max(stiffness)),
            page.value("worst error of the stress, tied node by node [%]", round(100 * node.max())),
        ],
        hero=TORQUE,
        cautions=[
            "Dangerous: a coarser slave tied node by node gives wrong stresses at every ratio of "
            f"element sizes from {unequal}\u00a0:\u00a01, even with nodes moved: use mortar ties.",
            "Nodes of the slave moved onto the master's face lose "
            + ("no torque" if lost < SETTLED else f"{formatted(100 * lost, 2)}\u00a0% of torque")
            + f", with elements up to {ratio:g} times as many as on the other face; if they are "
            "not moved, the program only warns.",
        ],
    )
    page.say(
        "Tied as meshed, a curved face loses torque, since two meshes of it lie apart.",
        f"Node by node with a coarser slave stress has errors of {100 * node[1]:.0f} to "
        f"{100 * node.max():.0f} %.",
    )


def round_needed(rows: list[Record]) -> int:
    """Elements round a cylinder from which on no tie as meshed loses more than is accepted."""
    turns: list[int] = sorted(set(column(rows, "elements round")))
    bad = [r["elements round"] for r in rows if r["torque lost"] > LOST]
    return min((turn for turn in turns if turn > max(bad, default=0)), default=turns[-1])


def show_facets(
    page: Page, as_meshed: list[Record], ratios: Sequence[int], coarse_slaves: list[Tie]
) -> None:
    """Torque lost by facets that lie apart: limits, chart, table."""
    traces, safe = [], None
    for nodes, name in NODES.items():
        for kind, rows in grouped([r for r in as_meshed if r["elements"] == name], "tie"):
            tied = [r for r in rows if np.isfinite(r["torque lost"])]
            turns, lost = column(tied, "elements round"), column(tied, "torque lost")
            least = min_round(turns, lost)
            safe = least if (nodes, kind) == (10, "standard") else safe
            traces.append(curve(f"{name}, {kind}", turns, lost))
            page.limit(
                f"tie of a cylinder as meshed, {name}, {kind}",
                "elements round the coarser face",
                low=least,
                criterion=f"torque lost below {100 * LOST:g} %",
                beyond=f"reactions out of balance by up to {100 * max(lost):.2g} %",
                program="warns of faces further apart than a hundredth of their radius",
                remedy="`mortar.settled`: nothing is lost",
            )
    limit_straight(page, ratios, coarse_slaves)
    traces += [remedied(as_meshed), *refusals(as_meshed)]
    page.section("Gaps between facets")
    page.chart(
        TORQUE,
        traces,
        "elements round the coarser ring",
        "torque lost",
        "xy",
        (safe, None),
    )
    page.text(
        "The bore is held, the outside turned. What is lost shows as a difference between the two "
        "reactions, which rigid rotations of the tied faces do work on. An octagon of straight "
        "facets lies 7.6 % inside its cylinder."
    )
    page.table(
        "Straight hexahedra, 8 round the slave, standard multipliers: what the program reports",
        [
            {"ratio": f"{ratio} to 1", "message": "; ".join(tie.messages) or "nothing"}
            for ratio, tie in zip(ratios, coarse_slaves, strict=True)
        ],
    )


def limit_straight(page: Page, ratios: Sequence[int], coarse_slaves: list[Tie]) -> None:
    """State the ratio at which straight facets no longer meet."""
    refused = next(
        (
            ratio
            for ratio, tie in zip(ratios, coarse_slaves, strict=True)
            if tie.tie is None and reports(tie, APART)
        ),
        None,
    )
    page.limit(
        "mortar tie of a cylinder, straight facets, slave coarser (8 round)",
        "elements of the finer face to one of the coarser",
        high=None if refused is None else max([r for r in ratios if r < refused] or [refused]),
        criterion="tied at all",
        beyond="facets lie further apart than a quarter of a fine facet, and do not meet",
        program="refuses, names the gap and the fix",
        remedy="the finer face as the slave, or curved facets",
    )


def remedied(as_meshed: list[Record]) -> Any:
    """Curve of straight facets after the tie is settled."""
    settled = [r for r in as_meshed if np.isfinite(r["once settled"])]
    return curve(
        "straight hexahedra, settled (remedy)",
        column(settled, "elements round"),
        column(settled, "once settled"),
        {"dash": "dash"},
    )


def refusals(as_meshed: list[Record]) -> list[Any]:
    """Crosses of the ties that are refused, drawn at 1."""
    no_tie = [r for r in as_meshed if np.isnan(r["torque lost"])]
    if not no_tie:
        return []
    names = [f"{r['elements']}, {r['tie']}" for r in no_tie]
    at = column(no_tie, "elements round")
    return [trace("refused", at, [1.0] * len(at), True, text=names, marker={"symbol": "x"})]


def show_ratios(page: Page, settled: list[Record], shared: Twisted) -> None:
    """Stress and stiffness of settled ties over the ratio: limits, chart, table."""
    ratios = list(dict.fromkeys(column(settled, "ratio")))
    allowed = FACTOR * shared.stress
    stress = {
        (kind, side): series(settled, kind, side, "error of the stress")
        for side in SIDES
        for kind in TIES
    }
    most = {key: last_within(ratios, errors, allowed) for key, errors in stress.items()}
    limit_ratios(page, settled, stress, most)
    page.section("Mesh ratio")
    page.chart(
        "Stress in the outer ring, settled ties of curved tetrahedra: root mean square error over "
        "the shear stress at the tie. Shaded where ties node by node, slave coarser, are within "
        f"{FACTOR:g} times that of shared nodes",
        [
            *(
                curve(
                    f"{kind}, slave {side}",
                    ratios,
                    errors,
                    {} if side == "finer" else {"dash": "dash"},
                )
                for (kind, side), errors in stress.items()
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
        "xy",
        (None, most["node by node", "coarser"] or ratios[0]),
    )
    page.table("Settled ties of curved tetrahedra", settled)


def limit_ratios(
    page: Page,
    settled: list[Record],
    stress: dict[tuple[str, str], Floats],
    most: dict[tuple[str, str], float | None],
) -> None:
    """State the ratios up to which each tie has the stress of shared nodes."""
    node = stress["node by node", "coarser"]
    by_node = series(settled, "node by node", "coarser", "stiffness over the exact one")
    page.limit(
        "tie of a cylinder node by node, settled, slave coarser",
        "elements of the finer face to one of the coarser",
        high=most["node by node", "coarser"],
        criterion=f"error of the stress within {FACTOR:g} times that of shared nodes",
        beyond=f"stress in error by up to {100 * node.max():.0f} %, stiffness by "
        f"{100 * np.abs(by_node - 1).max():.2g} %",
        program="warns of a slave that is the coarser",
        remedy="mortar tie, or the finer face as the slave",
    )
    for kind in ("standard", "dual"):
        for side in SIDES:
            high = most[kind, side]
            page.limit(
                f"mortar tie of a cylinder, {kind} multipliers, settled, slave {side}",
                "elements of the finer face to one of the coarser",
                high=None if high == settled[-1]["ratio"] else high,
                criterion=f"error of the stress within {FACTOR:g} times that of shared nodes",
                beyond="largest error of the stress in the sweep "
                f"{100 * stress[kind, side].max():.2g} %",
                program="warns of a slave that is the coarser"
                if side == "coarser"
                else "nothing to be done",
                remedy="the finer face as the slave",
            )


def curve(name: str, x: Sequence[int], y: Any, line: dict[str, str] | None = None) -> Any:
    """Values on a logarithmic axis, zero at round-off."""
    return trace(name, x, np.maximum(y, 1e-16), mode="lines+markers", line=line or {})


def min_round(turns: Sequence[int], lost: Sequence[float]) -> float | None:
    """Least number of elements from which on all lose less than is accepted; None if all do."""
    bad = [turn for turn, value in zip(turns, lost, strict=True) if value > LOST]
    if not bad:
        return None
    return float(min((turn for turn in turns if turn > max(bad)), default=turns[-1]))
