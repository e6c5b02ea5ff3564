"""Nested dissection of a mesh of a meridian: in which order elements are taken and joined."""

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints

JOIN = -1
"""In a dissection: join the last two."""


def dissection(centres: Floats) -> Ints:
    """Order in which to take and to join elements, from their centres (ne, 2).

    Halves across the longer side, halved again. Returns (2 ne - 1,): an element's number where it
    is taken, `JOIN` where the last two are joined.

    Not compiled: of the few hundred elements of a meridian it takes milliseconds, and to load it
    compiled takes longer.
    """
    x, r = centres.T.tolist()
    # ties are broken by the other coordinate, so that cuts are straight
    along = [a + 1e-6 * b for a, b in zip(x, r, strict=True)]
    across = [b + 1e-6 * a for a, b in zip(x, r, strict=True)]
    program = []
    some = list(range(len(x)))
    waiting = [(0, len(x))]  # parts of ``some``, an empty one to join
    while waiting:
        first, end = waiting.pop()
        if end - first < 2:
            program.append(some[first] if end > first else JOIN)
            continue
        here = some[first:end]
        wide = [x[e] for e in here]
        high = [r[e] for e in here]
        is_long = max(wide) - min(wide) >= max(high) - min(high)
        middle = first + (end - first) // 2
        _part(some, along if is_long else across, first, middle, end)
        waiting += [(0, 0), (first, middle), (middle, end)]
    return np.array(program, dtype=np.int64)


def _part(some: list[int], key: list[float], first: int, middle: int, end: int) -> None:
    """Bring those with the least keys before the middle (Hoare 1961, Comm. ACM 4, 321: FIND)."""
    low, high = first, end - 1
    while low < high:
        pivot, i, j = key[some[middle]], low, high
        while i <= j:
            while key[some[i]] < pivot:
                i += 1
            while pivot < key[some[j]]:
                j -= 1
            if i <= j:
                some[i], some[j] = some[j], some[i]
                i += 1
                j -= 1
        if j < middle:
            low = i
        if middle < i:
            high = j
