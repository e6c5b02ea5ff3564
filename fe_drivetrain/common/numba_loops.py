"""Loops that only other compiled loops call, and whole numbers that are one type to all of them."""

from collections.abc import Callable, Sequence
from typing import Any, TypeVar

import numpy as np
from numba import njit

_F = TypeVar("_F", bound=Callable[..., Any])


def inner_loop(function: _F) -> _F:
    """Compile a function for other compiled loops alone.

    What lets Python and C call a loop takes as long to compile as the loop itself, where it takes
    many arrays. Without that a call by Python ends the process, so that no module may make one.

    Parameters
    ----------
    function : callable
        With types that numba knows. Division by zero gives infinity, as in NumPy.

    Returns
    -------
    callable
        What a function that `numba.njit` compiles may call.
    """
    options: dict[str, Any] = {"no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    compiled: _F = njit(cache=True, error_model="numpy", **options)(function)
    return compiled


def places(count: int, first: int = 0) -> Sequence[int]:
    """Whole numbers in order, to name places of an array.

    They are NumPy's: each of Python's is a type of its own to numba, which compiles a function
    again for every place that it is called with.

    Parameters
    ----------
    count : int
        How many.
    first : int
        The least.

    Returns
    -------
    sequence of int
    """
    numbers: list[Any] = list(np.arange(first, first + count))
    return numbers
