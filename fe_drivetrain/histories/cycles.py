"""Load cycles of a history by rainflow counting, exact and in bounded memory.

Counting follows ASTM E1049-85 (2017), 5.4.4, as the package `rainflow` does it: no classes and no
hysteresis filter, so that a cycle has the range and the mean that the samples have. (A faster
package, `rfcnt`, decides by at most 1024 classes which cycles close, whatever its input: it is a
peer in the tests, not the count.) What is left over at the end, the residue, counts by a rule that
goes with every count.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from itertools import islice
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError

Residue = Literal["half", "closed", "repeated"]

RESIDUES: dict[str, str] = {
    "half": "half cycles of the residue count as halves",
    "closed": "half cycles of the residue count as whole ones, an upper bound",
    "repeated": "the history is followed by itself, so that whole cycles alone are left",
}
"""What may be done with cycles that the end of a history leaves open."""

BLOCK = 65536
"""Cycles that a streamed count keeps in memory."""


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

    Memory is that of one piece, of `BLOCK` cycles and of the cycles that are still open.

    Parameters
    ----------
    chunks : iterable of array_like
        Pieces of one history, of any length, one after the other.
    residue : str
        As of `rainflow_cycles`.

    Yields
    ------
    Cycles
        Up to `BLOCK` of them.

    Raises
    ------
    InputError
        As of `rainflow_cycles`.
    """
    if residue not in RESIDUES:
        raise InputError(f"residue '{residue}' is not a rule: choose one of {', '.join(RESIDUES)}")
    rest: list[float] = []
    last: list[float] = []
    found = _extracted(_noting_last(_turning(chunks), last), rest)
    while block := list(islice(found, BLOCK)):
        table = np.array(block)
        half = table[:, 2] < 1.0
        if residue == "closed":
            table[half, 2] = 1.0
        elif residue == "repeated":
            for mean in table[half, 1].tolist():  # each begins where the one before ended
                rest.append(2.0 * mean - rest[-1])
            table = table[~half]
        if len(table):
            yield Cycles(table[:, 0], table[:, 2], table[:, 1], residue)
    if residue == "repeated" and len(rest) > 1:
        # to the last digit, or a history that ends where it began would close with a cycle of one
        yield _closed([*rest[:-1], *last])


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
        Of any count.
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
        Of any count.

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
        Of any count.
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
        turns = values[1:-1][np.diff(values[:-1]) * np.diff(values[1:]) < 0.0]
        if len(values) and not begun:
            begun = True
            yield values[:1]
        yield turns
        open_end = np.concatenate([turns[-1:] if len(turns) else values[:1], values[-1:]])
        if len(values) < 2:
            open_end = values
    if len(open_end) > 1:
        yield open_end[-1:]


def _noting_last(points: Iterable[Floats], last: list[float]) -> Iterator[Floats]:
    for part in points:
        last[:] = part[-1:].tolist() or last
        yield part


def _extracted(
    points: Iterable[Floats], first: list[float]
) -> Iterator[tuple[float, float, float]]:
    """Range, mean and count of each cycle, by the package; `first` takes the first value."""
    from rainflow import extract_cycles

    values = (value for part in points for value in part.tolist())
    head = list(islice(values, 3))
    first.extend(head[:1])
    if len(head) == 2:  # for which the package yields nothing
        yield abs(head[1] - head[0]), 0.5 * (head[0] + head[1]), 0.5
        return

    def every() -> Iterator[float]:
        yield from head
        yield from values

    for size, mean, count, _, _ in extract_cycles(every()):
        yield size, mean, count


def _closed(rest: Sequence[float]) -> Cycles:
    """Cycles of a residue that is followed by itself: from its largest value to itself."""
    circle = np.array(rest)
    start = int(np.argmax(circle))
    turned = np.concatenate([circle[start:], circle[: start + 1]])
    table = np.array(list(_extracted(_turning([turned]), [])))
    half = table[:, 2] < 1.0
    # from the largest value down and back: half cycles come in pairs of one range
    table = np.concatenate([table[~half], table[half][::2]])
    return Cycles(table[:, 0], np.ones(len(table)), table[:, 1], "repeated")
