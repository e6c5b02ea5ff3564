"""Nested dissection of a mesh of a meridian: in which order elements are taken and joined."""

import numpy as np
from numba import njit

from fe_drivetrain.common.arrays import Floats, Ints

JOIN = -1
"""In a dissection: join the last two."""


@njit(cache=True)  # type: ignore[untyped-decorator]
def dissection(centres: Floats) -> Ints:
    """Order in which to take and to join elements, from their centres (ne, 2).

    Halves across the longer side, halved again. Returns (2 ne - 1,): an element's number where it
    is taken, `JOIN` where the last two are joined.
    """
    ne = len(centres)
    program = np.empty(2 * ne - 1, dtype=np.int64)
    some, key = np.arange(ne), np.empty(ne)
    waiting = np.empty((2 * ne + 1, 2), dtype=np.int64)  # parts of ``some``, an empty one to join
    waiting[0, 0], waiting[0, 1] = 0, ne
    count, length = 1, 0
    while count > 0:
        count -= 1
        first, end = waiting[count, 0], waiting[count, 1]
        if end - first < 2:
            program[length] = some[first] if end > first else -1
            length += 1
            continue
        left = right = centres[some[first], 0]
        low = high = centres[some[first], 1]
        for i in range(first, end):
            x, r = centres[some[i], 0], centres[some[i], 1]
            left, right, low, high = min(left, x), max(right, x), min(low, r), max(high, r)
        for i in range(first, end):
            x, r = centres[some[i], 0], centres[some[i], 1]
            # ties are broken by the other coordinate, so that cuts are straight
            key[i] = x + 1e-6 * r if right - left >= high - low else r + 1e-6 * x
        middle = first + (end - first) // 2
        _part(some, key, first, middle, end)
        waiting[count, 0], waiting[count, 1] = 0, 0
        waiting[count + 1, 0], waiting[count + 1, 1] = first, middle
        waiting[count + 2, 0], waiting[count + 2, 1] = middle, end
        count += 3
    return program


@njit(cache=True)  # type: ignore[untyped-decorator]
def _part(some: Ints, key: Floats, first: int, middle: int, end: int) -> None:
    """Bring the least keys before the middle (Hoare 1961, Comm. ACM 4, 321: FIND).

    NumPy's sort would take two seconds to compile.
    """
    low, high = first, end - 1
    while low < high:
        pivot, i, j = key[middle], low, high
        while i <= j:
            while key[i] < pivot:
                i += 1
            while pivot < key[j]:
                j -= 1
            if i <= j:
                key[i], key[j] = key[j], key[i]
                some[i], some[j] = some[j], some[i]
                i += 1
                j -= 1
        if j < middle:
            low = i
        if middle < i:
            high = j
