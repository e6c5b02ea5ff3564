"""Load cycles of a history by rainflow counting, exact and in bounded memory.

Counting follows ASTM E1049-85 (2017), 5.4.4: no classes and no hysteresis filter, so that a cycle
has the range and the mean that the samples have. The loop is compiled here, since none of the
packages counts so in bounded memory at the speed of a compiled loop: `rainflow` is exact, in plain
Python; `rfcnt` decides by at most 1024 classes which cycles close, whatever its input; `pylife`
leaves the residue out of its cycles. They are peers in the tests. What is left over at the end, the
residue, counts by a rule that goes with every count.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.histories.three_points import close_cycles, half_cycles

Residue = Literal["half", "closed", "repeated"]

RESIDUES: dict[str, str] = {
    "half": "half cycles of the residue count as halves",
    "closed": "half cycles of the residue count as whole ones, an upper bound",
    "repeated": "the history is followed by itself, so that whole cycles alone are left",
}
"""What may be done with cycles that the end of a history leaves open."""

BLOCK = 65536
"""Turning points that a count takes at once, and cycles that it hands on at once."""


@dataclass(frozen=True, eq=False)
class Cycles:
    """Cycles of one history or of several, and how they were counted.

    Attributes
    ----------
    ranges : ndarray, (n,)
        Largest less smallest value of each, in the unit of the history.
    counts : ndarray, (n,)
        1 for a whole cycle, 0.5 for a half.
    means : ndarray, (n,)
        Halfway between both values.
    residue : str
        Rule for cycles that the end leaves open, of `RESIDUES`.
    gate : float
        Cycles of a smaller range were left out.
    left_out : float
        How many these were.
    """

    ranges: Floats
    counts: Floats
    means: Floats
    residue: Residue = "half"
    gate: float = 0.0
    left_out: float = 0.0

    __repr__ = short_repr

    @property
    def rule(self) -> str:
        """How they were counted, for a caption."""
        text = f"rainflow counting, ASTM E1049-85, without classes; {RESIDUES[self.residue]}"
        if self.gate:
            text += f"; {self.left_out:g} cycles of a range below {self.gate:g} are left out"
        return text


RULE = Cycles(np.zeros(0), np.zeros(0), np.zeros(0)).rule
"""How cycles are counted where nothing else is asked for."""


def reversals(signal: ArrayLike) -> Floats:
    """Values at which a history turns, with its first and its last.

    Parameters
    ----------
    signal : array_like, (n,)
        The history.

    Returns
    -------
    ndarray, (m,)
    """
    return np.concatenate([np.zeros(0), *_turning([signal])])


def rainflow_cycles(signal: ArrayLike, residue: Residue = "half") -> Cycles:
    """Count the cycles of a history.

    Parameters
    ----------
    signal : array_like, (n,)
        The history; the time between its samples does not matter.
    residue : str
        Rule for what the end leaves open, of `RESIDUES`.

    Returns
    -------
    Cycles
        None of a history that is constant.

    Raises
    ------
    InputError
        A value is not finite, or there is no such rule.
    """
    return joined(list(streamed_cycles([signal], residue)), residue)


def streamed_cycles(chunks: Iterable[ArrayLike], residue: Residue = "half") -> Iterator[Cycles]:
    """Count the cycles of a history that comes in pieces; the same cycles as of the whole.

    Memory is that of one piece, of `BLOCK` turning points and of those that are still open.

    Parameters
    ----------
    chunks : iterable of array_like
        Pieces of one history, of any length, one after the other.
    residue : str
        Residue, see `rainflow_cycles`.

    Yields
    ------
    Cycles
        Up to `BLOCK` of them.

    Raises
    ------
    InputError
        The same as for `rainflow_cycles`.
    """
    if residue not in RESIDUES:
        raise InputError(f"residue '{residue}' is not a rule: choose one of {', '.join(RESIDUES)}")
    still_open, behind = np.zeros(0), [np.zeros(0)]
    for points in _in_blocks(_turning(chunks)):
        table = np.empty((len(still_open) + len(points), 4))
        stack = np.empty(len(table))
        number, left = close_cycles(points, still_open, table, stack)
        table, still_open = table[:number], stack[:left].copy()
        if residue == "repeated":  # half cycles leave their first points behind
            half = table[:, 2] < 1.0
            behind.append(table[half, 3])
            table = table[~half]
        yield from _blocks_of(table, residue)
    if residue == "repeated":
        rest = np.concatenate([*behind, still_open])
        if len(rest) > 1:
            yield _closed(rest)
    elif len(still_open) > 1:
        yield from _blocks_of(half_cycles(still_open), residue)


def joined(parts: Sequence[Cycles], residue: Residue = "half") -> Cycles:
    """Cycles of several counts together.

    Parameters
    ----------
    parts : sequence of Cycles
        Counted by one rule.
    residue : str
        The rule where there are none.

    Raises
    ------
    InputError
        They were counted by different rules.
    """
    rules = {(part.residue, part.gate) for part in parts} or {(residue, 0.0)}
    if len(rules) > 1:
        raise InputError(
            "cycles to be joined were counted by different rules of residue or gate: count all of "
            "them by one"
        )
    ((residue, gate),) = rules
    empty = [np.zeros(0)]
    return Cycles(
        np.concatenate([part.ranges for part in parts] or empty),
        np.concatenate([part.counts for part in parts] or empty),
        np.concatenate([part.means for part in parts] or empty),
        residue,
        gate,
        sum(part.left_out for part in parts),
    )


def gated(cycles: Cycles, gate: float) -> Cycles:
    """Cycles of at least some range; how many were left out stays known.

    The gate acts on counted cycles. It is no filter of the history, which would count what it
    leaves in other pairs.

    Parameters
    ----------
    cycles : Cycles
        Cycles of any count.
    gate : float
        Least range, in the unit of the history.
    """
    kept = cycles.ranges >= gate
    return replace(
        cycles,
        ranges=cycles.ranges[kept],
        counts=cycles.counts[kept],
        means=cycles.means[kept],
        gate=max(gate, cycles.gate),
        left_out=cycles.left_out + float(cycles.counts[~kept].sum()),
    )


def exceedance(cycles: Cycles) -> tuple[Floats, Floats]:
    """How many cycles have a range or a larger one.

    Parameters
    ----------
    cycles : Cycles
        Cycles of any count.

    Returns
    -------
    ranges : ndarray, (n,)
        Each that occurs, from the largest down.
    counts : ndarray, (n,)
        Cycles of it and of larger ones.
    """
    ranges, place = np.unique(cycles.ranges, return_inverse=True)
    counts = np.bincount(place, cycles.counts, len(ranges))
    return ranges[::-1], np.cumsum(counts[::-1])


def range_mean_matrix(cycles: Cycles, ranges: ArrayLike, means: ArrayLike) -> Floats:
    """Cycles by range and mean, in classes.

    Parameters
    ----------
    cycles : Cycles
        Cycles of any count.
    ranges, means : array_like
        Limits of the classes, rising.

    Returns
    -------
    ndarray, (len(ranges) - 1, len(means) - 1)
        Number of cycles.

    Raises
    ------
    InputError
        A cycle is in no class.
    """
    limits = [np.asarray(ranges, dtype=float), np.asarray(means, dtype=float)]
    for name, values, edges in zip(
        ("range", "mean"), (cycles.ranges, cycles.means), limits, strict=True
    ):
        if len(values) and not edges[0] <= values.min() <= values.max() <= edges[-1]:
            raise InputError(
                f"cycles have a {name} from {values.min():g} to {values.max():g}, and the classes "
                f"reach from {edges[0]:g} to {edges[-1]:g}: let them hold every cycle"
            )
    table, _, _ = np.histogram2d(cycles.ranges, cycles.means, bins=limits, weights=cycles.counts)
    return np.asarray(table)


def _turning(chunks: Iterable[ArrayLike]) -> Iterator[Floats]:
    """Turning points of a history in pieces, with its first value and its last."""
    open_end = np.zeros(0)  # the last turning point, and the last value, which may become one
    begun = False
    for chunk in chunks:
        values = np.asarray(chunk, dtype=float)
        if not np.isfinite(values).all():
            raise InputError(
                "a history to count cycles of holds a value that is not finite: remove it"
            )
        values = np.concatenate([open_end, values])
        values = values[np.diff(values, prepend=np.nan) != 0.0]  # a plateau is one value
        rises = np.diff(values) > 0.0
        turns = values[1:-1][rises[:-1] != rises[1:]]
        if len(values) and not begun:
            begun = True
            yield values[:1]
        yield turns
        open_end = np.concatenate([turns[-1:] if len(turns) else values[:1], values[-1:]])
        if len(values) < 2:
            open_end = values
    if len(open_end) > 1:
        yield open_end[-1:]


def _in_blocks(parts: Iterable[Floats]) -> Iterator[Floats]:
    """Turning points in blocks."""
    for part in parts:
        for start in range(0, len(part), BLOCK):
            yield part[start : start + BLOCK]


def _blocks_of(table: Floats, residue: Residue) -> Iterator[Cycles]:
    """Cycles of rows of range, mean and count, in blocks."""
    for start in range(0, len(table), BLOCK):
        part = table[start : start + BLOCK]
        counts = np.ones(len(part)) if residue == "closed" else part[:, 2].copy()
        yield Cycles(part[:, 0].copy(), counts, part[:, 1].copy(), residue)


def _closed(rest: Floats) -> Cycles:
    """Cycles of a residue that is followed by itself: from its largest value to itself."""
    start = int(np.argmax(rest))
    turned = np.concatenate([rest[start:], rest[: start + 1]])
    found = joined(list(streamed_cycles([turned])))
    half = found.counts < 1.0
    # from the largest value down and back: half cycles come in pairs of one range
    ranges, means = (
        np.concatenate([values[~half], values[half][::2]]) for values in (found.ranges, found.means)
    )
    return Cycles(ranges, np.ones(len(ranges)), means, "repeated")
