"""Load loops: excursions of a load in a plane that come back to where they began within seconds.

Hart 2020 (doi 10.1002/we.2549) and Stirling 2023, section 3.5, describe them by eye and give no
definition that can be computed; this one is ours. The path of (x, y), straight between samples,
closes where it crosses itself, and the part between the two passages is a loop if

- it takes no longer than ``longest``,
- it leads away from the crossing by at least ``excursion``, and
- its area is at least ``ROUNDNESS`` of that excursion squared (a circle has pi/4): forth and back
  along a line is no loop, with noise either.

Of loops that overlap as many are kept as fit one after another (of equal numbers those that lead
farther); then they are cut out of the path, and what is left is searched again, so that a loop with
a smaller one on it counts with it. Only distances and areas decide: turning or mirroring the plane,
and running the time backwards, change nothing.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import inner_loop, njit
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr

LONGEST = 2.0
"""Longest loop [s]: the thesis shows loops of 1 to 2 s."""

SHARE = 0.1
"""Smallest excursion over the mean magnitude of the load."""

ROUNDNESS = 0.1
"""Smallest area over the excursion squared: an ellipse of 1 to 8."""

Plane = NDArray[np.complex128]
"""Vectors of the plane, x + 1j y."""

_TOUCH = 1e-9
"""Of a step: a path that repeats itself touches its own vertices up to round-off."""

_AT_X, _AT_Y = 7, 8


@dataclass(frozen=True, eq=False)
class Loops:
    """Loops in the order of their starts, each quantity an array (loops,).

    Attributes
    ----------
    start, end : Floats
        When the path leaves the crossing and returns to it [s].
    excursion : Floats
        Largest distance from the crossing [unit of x].
    area : Floats
        Enclosed, positive where it turns from x to y [unit of x squared]; without that of smaller
        loops on it.
    lowest, highest : Floats
        Magnitude of the load on the loop [unit of x].
    swept : Floats
        Range of the load's direction on the loop [rad]; 2 pi or more where it turns all round.
    """

    start: Floats
    end: Floats
    excursion: Floats
    area: Floats
    lowest: Floats
    highest: Floats
    swept: Floats

    __repr__ = short_repr

    def __len__(self) -> int:
        return len(self.start)

    @property
    def duration(self) -> Floats:
        """(loops,) [s]."""
        return self.end - self.start


def find_loops(
    time: ArrayLike,
    x: ArrayLike,
    y: ArrayLike,
    *,
    longest: float = LONGEST,
    excursion: float | None = None,
) -> Loops:
    """Loops of a load in a plane.

    Parameters
    ----------
    time : array_like
        (n,) increasing [s].
    x, y : array_like
        (n,) two components of a force or of a moment, of one unit.
    longest : float
        Longest loop [s].
    excursion : float, optional
        Smallest distance to which a loop leads [unit of x]; ``SHARE`` of the mean magnitude if not
        given.

    Returns
    -------
    loops : Loops
        None of them where nothing moves, or where it moves along a line.

    Raises
    ------
    InputError
        The arrays disagree, time does not increase, a value is no number, or a threshold is not
        positive.
    """
    t, z = _checked(time, x, y)
    if not 0.0 < longest < np.inf:
        raise InputError(f"longest is {longest:g} s: give a positive number of seconds, as 2")
    if excursion is None:
        excursion = SHARE * float(np.abs(z).mean())
    elif not 0.0 < excursion < np.inf:
        raise InputError(f"excursion is {excursion:g}: give a positive distance, in the unit of x")
    found: list[_Part] = []
    while excursion > 0.0 and (closed := _closed_parts(t, z, longest, excursion)):
        found += closed
        t, z = _without(t, z, closed)
    columns = np.array(sorted(part.loop for part in found)).reshape(-1, len(fields(Loops))).T
    return Loops(*columns)


def loop_statistics(
    loops: Loops, duration: float, blade_passing: float | None = None
) -> dict[str, float]:
    """Numbers of a set of loops for a table.

    Parameters
    ----------
    loops : Loops
        Loops of one history.
    duration : float
        Length of the history [s].
    blade_passing : float, optional
        Frequency of the blades' passing (3P of a three-bladed rotor) [Hz].

    Returns
    -------
    statistics : dict[str, float]
        ``count``, ``share of time`` that is on a loop, ``rate [1/s]``, ``rate over 3P`` (where
        the frequency is given), and of the loops ``median duration [s]``, ``median swept angle
        [deg]``, ``largest swept angle [deg]``, ``median magnitude range`` and ``largest magnitude
        range`` [unit of the load]; medians of none are NaN.
    """
    if not duration > 0.0:
        raise InputError(f"duration is {duration:g} s: give the length of the history, in seconds")
    rate = len(loops) / duration
    result = {
        "count": float(len(loops)),
        "share of time": time_on_loops(loops) / duration,
        "rate [1/s]": rate,
    }
    if blade_passing is not None:
        if not blade_passing > 0.0:
            raise InputError(f"blade_passing is {blade_passing:g} Hz: give a positive frequency")
        result["rate over 3P"] = rate / blade_passing
    ranges, swept = loops.highest - loops.lowest, np.degrees(loops.swept)
    middle, most = (
        (np.median, np.max) if len(loops) else (lambda _: float("nan"), lambda _: float("nan"))
    )
    return result | {
        "median duration [s]": float(middle(loops.duration)),
        "median swept angle [deg]": float(middle(swept)),
        "largest swept angle [deg]": float(most(swept)),
        "median magnitude range": float(middle(ranges)),
        "largest magnitude range": float(most(ranges)),
    }


def time_on_loops(loops: Loops) -> float:
    """Time that is on one loop or more [s].

    Parameters
    ----------
    loops : Loops
        Loops of one history; some may lie on others.

    Returns
    -------
    time : float
        [s].
    """
    if not len(loops):
        return 0.0
    reached = np.maximum.accumulate(loops.end)
    before = np.concatenate([[-np.inf], reached[:-1]])
    return float(np.maximum(loops.end - np.maximum(loops.start, before), 0.0).sum())


def _checked(time: ArrayLike, x: ArrayLike, y: ArrayLike) -> tuple[Floats, Plane]:
    t, a, b = (np.asarray(v, dtype=float) for v in (time, x, y))
    if t.ndim != 1 or not t.shape == a.shape == b.shape:
        raise InputError(
            f"time, x and y have the shapes {t.shape}, {a.shape} and {b.shape}: give three series "
            "of one length"
        )
    if not (np.isfinite(t).all() and np.isfinite(a).all() and np.isfinite(b).all()):
        raise InputError("time, x or y has a value that is no finite number: leave such steps out")
    if (np.diff(t) <= 0.0).any():
        raise InputError("time does not increase everywhere: sort the series, or cut it into parts")
    return t, a + 1j * b


class _Part(NamedTuple):
    """A loop; the steps in which the path enters and leaves it, and where they cross."""

    first: int
    last: int
    at: complex
    loop: tuple[float, ...]

    @property
    def start(self) -> float:
        return self.loop[0]

    @property
    def end(self) -> float:
        return self.loop[1]

    @property
    def excursion(self) -> float:
        return self.loop[2]


def _closed_parts(t: Floats, z: Plane, longest: float, excursion: float) -> list[_Part]:
    """Loops that do not overlap."""
    t = t.copy()  # times that may not be written to would be compiled for once more
    capacity = len(t)
    while True:
        steps = np.empty((capacity, 2), np.int64)
        values = np.empty((capacity, _AT_Y + 1))
        number = _crossings(t, z.real.copy(), z.imag.copy(), longest, excursion, steps, values)
        if number <= capacity:
            break
        capacity = number
    steps, values = steps[:number], values[:number]
    kept = _innermost(values[:, 0], values[:, 1])
    parts = [
        _Part(int(i), int(j), complex(v[_AT_X], v[_AT_Y]), tuple(map(float, v[:_AT_X])))
        for (i, j), v in zip(steps[kept], values[kept], strict=True)
    ]
    return _one_after_another(parts, _TOUCH * longest)


@inner_loop
def _extremes(
    x: Floats, y: Floats, i: int, j: int, px: float, py: float
) -> tuple[float, float, float]:
    """Minimum and maximum size along a part from its crossing p and back, and range of its turn."""
    before = np.arctan2(py, px)
    turned, least, most = 0.0, 0.0, 0.0
    lowest = highest = np.hypot(px, py)
    for k in range(i + 1, j + 1):
        size, here = np.hypot(x[k], y[k]), np.arctan2(y[k], x[k])
        lowest, highest = min(lowest, size), max(highest, size)
        change = here - before
        turned += change - 2.0 * np.pi * np.round(change / (2.0 * np.pi))
        least, most, before = min(least, turned), max(most, turned), here
    change = np.arctan2(py, px) - before
    turned += change - 2.0 * np.pi * np.round(change / (2.0 * np.pi))
    return lowest, highest, max(most, turned) - min(least, turned)


@njit(cache=True, nogil=True, error_model="numpy")
def _crossings(
    t: Floats,
    x: Floats,
    y: Floats,
    longest: float,
    excursion: float,
    steps: Ints,
    values: Floats,
) -> int:
    """Closed parts of the path that are loops, overlapping or not; how many there are.

    Fills the steps (m, 2) that cross and what `Loops` has of each, then the crossing's place; what
    exceeds m is counted alone.
    """
    number, n = 0, len(t) - 1
    for i in range(n):
        ax, ay = x[i + 1] - x[i], y[i + 1] - y[i]
        # Steps within round-off of each other touch.
        mx, my = _TOUCH * abs(ax), _TOUCH * abs(ay)
        left, right = min(x[i], x[i + 1]) - mx, max(x[i], x[i + 1]) + mx
        low, high = min(y[i], y[i + 1]) - my, max(y[i], y[i + 1]) + my
        for j in range(i + 2, n):
            if t[j] - t[i + 1] > longest:
                break
            if (x[j] > right and x[j + 1] > right) or (x[j] < left and x[j + 1] < left):
                continue
            if (y[j] > high and y[j + 1] > high) or (y[j] < low and y[j + 1] < low):
                continue
            bx, by = x[j + 1] - x[j], y[j + 1] - y[j]
            across = ax * by - ay * bx
            if across == 0.0:
                continue
            dx, dy = x[j] - x[i], y[j] - y[i]
            on_i, on_j = (dx * by - dy * bx) / across, (dx * ay - dy * ax) / across
            if abs(on_i - 0.5) > 0.5 + _TOUCH or abs(on_j - 0.5) > 0.5 + _TOUCH:
                continue
            on_i, on_j = min(max(on_i, 0.0), 1.0), min(max(on_j, 0.0), 1.0)
            start = t[i] + on_i * (t[i + 1] - t[i])
            end = t[j] + on_j * (t[j + 1] - t[j])
            if end - start > longest:
                continue
            px, py = x[i] + on_i * ax, y[i] + on_i * ay
            far, twice = 0.0, 0.0
            for k in range(i + 1, j + 1):
                ux, uy = x[k] - px, y[k] - py
                far = max(far, ux * ux + uy * uy)
                if k < j:
                    twice += ux * (y[k + 1] - py) - uy * (x[k + 1] - px)
            if far < excursion * excursion or 0.5 * abs(twice) < ROUNDNESS * far:
                continue
            if number < len(steps):
                steps[number, 0], steps[number, 1] = i, j
                found = values[number]
                found[0], found[1], found[2] = start, end, np.sqrt(far)
                found[3] = 0.5 * twice
                found[4], found[5], found[6] = _extremes(x, y, i, j, px, py)
                found[_AT_X], found[_AT_Y] = px, py
            number += 1
    return number


def _innermost(start: Floats, end: Floats) -> Ints:
    """Those that contain no other, in order of start and end."""
    order = np.lexsort((end, -start))
    reached = np.minimum.accumulate(np.concatenate([[np.inf], end[order]]))
    return np.asarray(order[end[order] < reached[:-1]][::-1])


def _one_after_another(parts: list[_Part], touch: float) -> list[_Part]:
    """The largest number that fits; of equal numbers, those that lead farther together."""
    ends = [part.end for part in parts]
    best = [(0, 0.0)]
    before: list[int] = []
    for k, part in enumerate(parts):
        before.append(bisect_right(ends, part.start + touch, 0, k))
        count, far = best[before[k]]
        best.append(max(best[k], (count + 1, far + part.excursion)))
    chosen: list[_Part] = []
    k = len(parts)
    while k > 0:
        if best[k] == best[k - 1]:
            k -= 1
        else:
            chosen.append(parts[k - 1])
            k = before[k - 1]
    return chosen[::-1]


def _without(t: Floats, z: Plane, parts: list[_Part]) -> tuple[Floats, Plane]:
    """The path with loops cut out: of each stay its crossing, when it began and when it ended."""
    times: list[Floats] = []
    points: list[Plane] = []
    first = 0
    for part in parts:
        times += [t[first : part.first + 1], np.array([part.start, part.end])]
        points += [z[first : part.first + 1], np.array([part.at, part.at])]
        first = part.last + 1
    return np.concatenate([*times, t[first:]]), np.concatenate([*points, z[first:]])
