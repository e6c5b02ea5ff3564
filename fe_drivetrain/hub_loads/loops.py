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
from fe_drivetrain.common.errors import InputError

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


def _cross(a: Plane, b: Plane) -> Floats:
    """Product of two vectors of the plane, a_x b_y - a_y b_x."""
    return np.asarray((np.conj(a) * b).imag)


def _crossings(t: Floats, z: Plane, longest: float) -> tuple[Ints, Ints, Floats, Floats]:
    """Pairs of steps i < j that cross, and where on each, from 0 to 1."""
    step = np.diff(z)
    low = np.minimum(z.real[:-1], z.real[1:]) + 1j * np.minimum(z.imag[:-1], z.imag[1:])
    high = np.maximum(z.real[:-1], z.real[1:]) + 1j * np.maximum(z.imag[:-1], z.imag[1:])
    # Steps within round-off of each other touch.
    slack = _TOUCH * (high - low)
    low, high = low - slack, high + slack
    parts: list[tuple[Ints, Ints, Floats, Floats]] = []
    for apart in range(2, len(step)):
        i = np.flatnonzero(t[apart:-1] - t[1:-apart] <= longest)
        if not len(i):
            break
        j = i + apart
        near = (low.real[i] <= high.real[j]) & (low.real[j] <= high.real[i])
        near &= (low.imag[i] <= high.imag[j]) & (low.imag[j] <= high.imag[i])
        i, j = i[near], j[near]
        across = _cross(step[i], step[j])
        crossing = across != 0.0
        i, j, across = i[crossing], j[crossing], across[crossing]
        between = z[j] - z[i]
        on_i, on_j = _cross(between, step[j]) / across, _cross(between, step[i]) / across
        met = np.abs(on_i - 0.5) <= 0.5 + _TOUCH
        met &= np.abs(on_j - 0.5) <= 0.5 + _TOUCH
        parts.append((i[met], j[met], np.clip(on_i[met], 0, 1), np.clip(on_j[met], 0, 1)))
    if not parts:
        return np.empty(0, int), np.empty(0, int), np.empty(0), np.empty(0)
    i, j, on_i, on_j = (np.concatenate(column) for column in zip(*parts, strict=True))
    return i, j, on_i, on_j


class _Part(NamedTuple):
    """A loop, and where the path enters and leaves it."""

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
    if len(z) < 4:
        return []
    i, j, on_i, on_j = _crossings(t, z, longest)
    start = t[i] + on_i * (t[i + 1] - t[i])
    end = t[j] + on_j * (t[j + 1] - t[j])
    at = z[i] + on_i * (z[i + 1] - z[i])
    # About a middle, so that an origin far away costs no digits.
    about, here = z - z.mean(), at - z.mean()
    sums = np.concatenate([[0.0], np.cumsum(_cross(about[:-1], about[1:]))])
    area = 0.5 * (sums[j] - sums[i + 1] + _cross(here, about[i + 1]) + _cross(about[j], here))
    possible = (end - start <= longest) & (np.abs(area) >= ROUNDNESS * excursion**2)
    parts: list[_Part] = []
    for k in np.flatnonzero(possible):
        on = np.concatenate([[at[k]], z[i[k] + 1 : j[k] + 1], [at[k]]])
        far = float(np.abs(on - at[k]).max())
        if far >= excursion and abs(area[k]) >= ROUNDNESS * far**2:
            size, swept = np.abs(on), float(np.ptp(np.unwrap(np.angle(on))))
            loop = (start[k], end[k], far, area[k], size.min(), size.max(), swept)
            parts.append(_Part(int(i[k]), int(j[k]), complex(at[k]), loop))
    return _one_after_another(_innermost(parts), _TOUCH * longest)


def _innermost(parts: list[_Part]) -> list[_Part]:
    """Those that contain no other, in order of start and end."""
    kept: list[_Part] = []
    for part in sorted(parts, key=lambda p: (-p.start, p.end)):
        if not kept or part.end < kept[-1].end:
            kept.append(part)
    return kept[::-1]


def _one_after_another(parts: list[_Part], touch: float) -> list[_Part]:
    """As many as fit; of equal numbers, those that lead farther together."""
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
