"""The three-point rule of rainflow counting, compiled."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import njit


@njit(cache=True, nogil=True, error_model="numpy")
def close_cycles(
    points: Floats, still_open: Floats, table: Floats, stack: Floats
) -> tuple[int, int]:
    """Take turning points one after the other, and write the cycles that they close.

    ASTM E1049-85 (2017), 5.4.4: of the last three points that are left, the range of the first two
    is a cycle once that of the last two is as large; half a cycle where it holds the first point of
    all, which is then left behind.

    Parameters
    ----------
    points : ndarray, (n,)
        Turning points.
    still_open : ndarray, (m,)
        Points that earlier ones left.
    table : ndarray, (n + m, 4)
        Takes range, mean, count and first point of each cycle.
    stack : ndarray, (n + m,)
        Takes the points that are left.

    Returns
    -------
    cycles, left : int
        How many rows of the table, and how many points of the stack, are filled.
    """
    left, first, number = 0, 0, 0
    for k in range(len(still_open) + len(points)):
        stack[left] = still_open[k] if k < len(still_open) else points[k - len(still_open)]
        left += 1
        while left - first >= 3:
            one, two, three = stack[left - 3], stack[left - 2], stack[left - 1]
            if abs(three - two) < abs(two - one):
                break
            table[number, 0], table[number, 1] = abs(two - one), 0.5 * (one + two)
            table[number, 3] = one
            if left - first == 3:
                table[number, 2] = 0.5
                first += 1
            else:
                table[number, 2] = 1.0
                stack[left - 3] = three
                left -= 2
            number += 1
    for k in range(first, left):
        stack[k - first] = stack[k]
    return number, left - first


def half_cycles(points: Floats) -> Floats:
    """What is left at the end, as half cycles: (n - 1, 3) range, mean and count.

    Parameters
    ----------
    points : ndarray, (n,)
        Turning points that no cycle closed.
    """
    one, two = points[:-1], points[1:]
    return np.column_stack([np.abs(two - one), 0.5 * (one + two), np.full(len(one), 0.5)])
