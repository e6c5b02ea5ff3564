"""The four-point rule of rainflow counting, compiled: cycles closed whatever lies around them."""

from __future__ import annotations

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.compiled import njit


@njit(cache=True, nogil=True, error_model="numpy")
def close_inner_cycles(points: Floats, cycles: Floats, stack: Floats) -> tuple[int, int]:
    """Take turning points one after the other, and write the cycles that they close.

    Of the last four points that are left, the inner two are a cycle where their range is no larger
    than those of both sides (credited to Clormann and Seeger 1986, not read). No point around these
    four can change that, so that the order does not matter in which parts of a history are taken.

    Parameters
    ----------
    points : ndarray, (n,)
        Turning points.
    cycles : ndarray, (n, 2)
        Takes the two points of each cycle.
    stack : ndarray, (n,)
        Takes the points that are left.

    Returns
    -------
    number, left : int
        How many rows of the cycles, and how many points of the stack, are filled.
    """
    number, left = 0, 0
    for k in range(len(points)):
        stack[left] = points[k]
        left += 1
        while left >= 4:
            one, two = stack[left - 4], stack[left - 3]
            three, four = stack[left - 2], stack[left - 1]
            inner = abs(three - two)
            if inner > abs(two - one) or inner > abs(four - three):
                break
            cycles[number, 0], cycles[number, 1] = two, three
            number += 1
            stack[left - 3] = four
            left -= 2
    return number, left
