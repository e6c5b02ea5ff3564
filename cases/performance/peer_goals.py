"""How many times faster than every other tool this project is, mesh by mesh, and the goal."""

import math
from collections.abc import Iterable, Sequence

from fe_drivetrain.cases.performance.peer_settings import OURS
from fe_drivetrain.cases.performance.peers import Benchmark, Row, rounds
from fe_drivetrain.report.suite import Page, Record

COMPARED_FROM = 9_000
"""Unknowns from which on being faster than every other is the goal: meshes of some 10,000, too."""

FASTER, FASTER_TOGETHER, MANY_MOTIONS = 1.5, 4.0, 10
"""Goals: so many times faster than every other; so many with this number of right-hand sides."""


def significant(value: float | None, digits: int = 3) -> float | None:
    """A number of so many digits."""
    return None if value is None else float(f"{value:.{digits}g}")


def meshes_of(rows: Sequence[Row]) -> list[int]:
    """Numbers of unknowns, ascending."""
    return sorted({row.unknowns for row in rows})


def of_mesh(rows: Sequence[Row], unknowns: int) -> list[Row]:
    """The rows of one mesh."""
    return [row for row in rows if row.unknowns == unknowns]


def own(rows: Iterable[Row]) -> Row | None:
    """This project's row of a mesh: what auto chose, or else the fastest that was asked for."""
    ours = [row for row in rows if row.variant.tool == OURS]
    auto = [row for row in ours if row.variant.key == "auto"]
    return min(auto or ours, key=lambda row: row.seconds or math.inf, default=None)


def goals(benchmark: Benchmark, rows: Sequence[Row], motions: int) -> list[Record]:
    """How many times faster than the fastest other this project is on each mesh, and the goal.

    Where every other that might reach the same error is ended, or not begun, for its time, that
    limit is the least that the fastest takes.
    """
    found: list[Record] = []
    goal = FASTER if motions < MANY_MOTIONS else FASTER_TOGETHER
    for n in meshes_of(rows):
        here = of_mesh(rows, n)
        ours, others = own(here), [r for r in here if r.variant.tool != OURS]
        if n < COMPARED_FROM or ours is None or not others:
            continue
        peer, lean = rounds.fastest_peer(here), rounds.leanest_direct_peer(here)
        late = [r.min_seconds for r in others if r.min_seconds is not None]
        name, least, known = "none reaches it", None, False
        if peer is not None:
            name, least, known = peer.variant.name, peer.seconds, True
        elif late:
            name, least = f"none below {min(late):g} s", min(late)
        mine = ours.seconds if ours.reaches else None
        times = least / mine if least and mine else None
        reached = "yes" if times is not None and times >= goal else "no" if known else "not known"
        found.append(
            {
                "problem": benchmark.title,
                "unknowns": n,
                "fastest other": name,
                "its time over ours": None if times is None else significant(times),
                "goal, at least": goal,
                "reached": reached,
                "leanest direct other": lean.variant.name if lean else "none",
                "its peak memory over ours": significant(lean.bytes / ours.bytes)
                if ours.bytes and lean and lean.bytes
                else None,
            }
        )
    return found


def show_goals(page: Page, table: list[Record], motions: int) -> None:
    """The goals of all meshes, and how many are reached."""
    page.section("Goals")
    page.table(
        f"Median time of the fastest other tool at equal error over this project's (auto), from "
        f"{COMPARED_FROM:,} unknowns on, with {motions} right-hand side{'s' * (motions > 1)}: the "
        f"goal is {FASTER:g} with one, {FASTER_TOGETHER:g} with {MANY_MOTIONS}",
        table,
    )
    page.data("goals", table)
    reached = sum(row["reached"] == "yes" for row in table)
    goal = table[0]["goal, at least"]
    page.text(
        f"This project is at least {goal:g} times as fast as every other tool, the goal, on "
        f"{reached} of {len(table)} meshes of {COMPARED_FROM:,} unknowns or more."
    )
