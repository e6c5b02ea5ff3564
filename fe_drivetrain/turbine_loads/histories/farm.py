"""Histories of any length in pieces that are counted apart, here or on a cluster, and put together.

A farm's years are 1e11 samples. Each piece leaves some turning points open, and all else that it
holds adds up without rounding: cycles in classes of a width that is given, powers of ranges as
exact sums, time in classes. So the whole is the same to the last digit however it is cut and
whatever counts it, and a piece of any length leaves some kilobytes.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from itertools import groupby, islice
from operator import itemgetter
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.exact_sums import ExactSum, exact_sum
from fe_drivetrain.common.jobs import AT_ONCE, mapped
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.histories.classes import Classes, added, in_classes
from fe_drivetrain.turbine_loads.histories.cycles import (
    BLOCK,
    Cycles,
    Residue,
    rainflow_cycles,
    reversals,
)
from fe_drivetrain.turbine_loads.histories.damage import SLOPES, check_slope
from fe_drivetrain.turbine_loads.histories.four_points import close_inner_cycles

LONGEST_RUN = 32
"""Pieces that one job counts, at most."""


@dataclass(frozen=True)
class Counting:
    """What is counted.

    Attributes
    ----------
    power : int
        Classes of ranges and of levels are 2^power wide, in the unit of the history; twice as wide,
        and twice again, where there would be more than `classes.MAXIMUM` of them.
    slopes : tuple of float
        Exponents of S-N curves.
    """

    power: int
    slopes: tuple[float, ...] = SLOPES


@dataclass(frozen=True, eq=False)
class Count:
    """What adds up over pieces and histories.

    Attributes
    ----------
    samples : int
        Number of samples of the histories.
    cycles : Classes
        Number of cycles by range; halves count as halves.
    damage : tuple of ExactSum
        Sums of n r^m, of each slope.
    levels : Classes
        Samples by level: load duration in steps of time.
    """

    samples: int
    cycles: Classes
    damage: tuple[ExactSum, ...]
    levels: Classes

    def __add__(self, other: Count) -> Count:
        """Both together."""
        return Count(
            self.samples + other.samples,
            _together(self.cycles, other.cycles),
            tuple(a + b for a, b in zip(self.damage, other.damage, strict=True)),
            _together(self.levels, other.levels),
        )


@dataclass(frozen=True, eq=False)
class Piece:
    """A piece of a history, or several that follow each other.

    Attributes
    ----------
    counting : Counting
        What is counted.
    open : ndarray
        Its turning points that no cycle has taken, with its first value and its last.
    count : Count
        Count of cycles that are closed whatever lies before and behind.
    """

    counting: Counting
    open: Floats
    count: Count

    __repr__ = short_repr

    def __add__(self, behind: Piece) -> Piece:
        """This piece with the one that follows it."""
        points = reversals(np.concatenate([self.open, behind.open]))
        left, cycles = _inner(points)
        return Piece(
            self.counting,
            left,
            self.count + behind.count + _count(cycles, self.counting),
        )

    def whole(self, residue: Residue = "half") -> Count:
        """The history of this piece alone, with the cycles that its end leaves open.

        Parameters
        ----------
        residue : str
            "half" or "repeated", as of `rainflow_cycles`.

        Raises
        ------
        InputError
            The rule is another: which of several equal ranges are half cycles is not known of a
            piece, and they are not all counted as whole ones.
        """
        if residue not in ("half", "repeated"):
            raise InputError(
                f"residue '{residue}' cannot be counted in pieces: choose half or repeated"
            )
        return self.count + _count(rainflow_cycles(self.open, residue), self.counting)


def piece(values: ArrayLike, counting: Counting) -> Piece:
    """Count a piece of a history.

    Parameters
    ----------
    values : array_like, (n,)
        Its samples, one at least.
    counting : Counting
        What is counted.

    Raises
    ------
    InputError
        There are no values, or one is not finite.
    """
    for slope in counting.slopes:
        check_slope(slope)
    samples = np.asarray(values, dtype=np.float64)
    if not samples.size:
        raise InputError("a piece of a history has no samples: leave it out")
    left, count = np.zeros(0), _count(_no_cycles(), counting)
    points = reversals(samples)
    if len(points) < 2:  # a constant turns nowhere
        points = samples[:1]
    for start in range(0, len(points), BLOCK):
        left, cycles = _inner(np.concatenate([left, points[start : start + BLOCK]]))
        count = count + _count(cycles, counting)
    levels = _classes(samples, np.ones(len(samples)), counting)
    held = Count(len(samples), count.levels, tuple(ExactSum() for _ in counting.slopes), levels)
    return Piece(counting, left, count + held)


def counted_histories(
    read: Callable[..., ArrayLike],
    pieces: Iterable[tuple[str, tuple[Any, ...]]],
    counting: Counting,
    residue: Residue = "half",
    local: int = 1,
    report: Progress = silent,
) -> Iterator[tuple[str, Count]]:
    """Count histories that come in pieces, on as many workers as there are.

    Parameters
    ----------
    read : callable
        ``read(*arguments)`` gives the samples of a piece, where it is counted; of a module.
    pieces : iterable of (str, tuple)
        Name of the history, and arguments of `read`: all pieces of a history in order, one history
        after the other. They are taken as they are needed.
    counting : Counting
        What is counted.
    residue : str
        Residue, see `Piece.whole`.
    local : int
        Number of processes, see `fe_drivetrain.common.jobs.pool`.
    report : Progress
        Called with what is being done, see `pool`.

    Yields
    ------
    name, count
        Name and count of each history, once its last piece is there.
    """
    items = ((read, name, several, counting) for name, several in _runs(pieces))
    for name, group in groupby(mapped(_piece_of, items, local, report), itemgetter(0)):
        parts = (part for _, part in group)
        found = next(parts)
        for part in parts:
            found = found + part
        yield name, found.whole(residue)


def _runs(
    pieces: Iterable[tuple[str, tuple[Any, ...]]],
) -> Iterator[tuple[str, list[tuple[Any, ...]]]]:
    """Pieces of a history that follow each other: one at first, to begin on all workers, then more.

    A run is one job, and its pieces are added where they are: so neither the scheduler nor who adds
    the runs has as much to do as there are pieces.
    """
    number = 0
    for name, group in groupby(pieces, itemgetter(0)):
        while several := [*islice(group, min(LONGEST_RUN, 1 << number // AT_ONCE))]:
            yield name, [arguments for _, arguments in several]
            number += 1


def _piece_of(
    _report: Progress,
    read: Callable[..., ArrayLike],
    name: str,
    several: list[tuple[Any, ...]],
    counting: Counting,
) -> tuple[str, Piece]:
    first, *others = several
    found = piece(read(*first), counting)
    for arguments in others:
        found = found + piece(read(*arguments), counting)
    return name, found


def _inner(points: Floats) -> tuple[Floats, Cycles]:
    """Points that are left, and whole cycles."""
    pairs, stack = np.empty((len(points), 2)), np.empty(len(points))
    number, left = close_inner_cycles(points, pairs, stack)
    one, two = pairs[:number].T
    found = Cycles(np.abs(two - one), np.ones(number), 0.5 * (one + two))
    return stack[:left].copy(), found


def _no_cycles() -> Cycles:
    return Cycles(np.zeros(0), np.zeros(0), np.zeros(0))


def _count(cycles: Cycles, counting: Counting) -> Count:
    damage = tuple(exact_sum(cycles.counts * cycles.ranges**m) for m in counting.slopes)
    ranges = _classes(cycles.ranges, cycles.counts, counting)
    return Count(0, ranges, damage, _classes(np.zeros(0), np.zeros(0), counting))


def _classes(values: Floats, weights: Floats, counting: Counting) -> Classes:
    """Counts as of `in_classes`; without values no class at all, not even that of zero."""
    if not len(values):
        return Classes((counting.power,), (0,), np.zeros(0))
    return in_classes(values, weights=weights, power=counting.power)


def _together(one: Classes, other: Classes) -> Classes:
    some = [part for part in (one, other) if part.amount.size]
    return added(some) if some else one
