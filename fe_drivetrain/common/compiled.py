"""Compiled loops: numba's, each compiled by the process that first needs it, and shared by all.

Numba keeps what it has compiled on disk, but two processes that need a loop at the same time both
compile it. Here the second waits for the first, and loads what that has made.
"""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Sequence
from contextlib import suppress
from typing import Any, TypeVar, overload

import numba
import numpy as np
from numba.core.caching import FunctionCache

_PATIENCE = 120.0
"""How long a process waits for another that compiles, before it compiles itself [s]."""
_PAUSE = 0.01  # between two looks [s]

_F = TypeVar("_F", bound=Callable[..., Any])


def njit(**options: Any) -> Callable[[_F], _F]:
    """Compile a function at its first call, as `numba.njit`; no two processes compile it at once.

    It has no entry for programs in C, which none of ours calls: a tenth of the time to compile.

    Parameters
    ----------
    **options : Any
        Those of `numba.njit`.

    Returns
    -------
    decorator : callable
        Takes the function.
    """

    def compiled(function: _F) -> _F:
        jit: Any = numba.njit  # whose types know some of its options
        dispatcher: Any = jit(no_cfunc_wrapper=True, **options)(function)
        if options.get("cache"):
            shared: Any = _SharedCache
            dispatcher._cache = shared(dispatcher.py_func)
        return dispatcher  # type: ignore[no-any-return]

    return compiled


@overload
def inner_loop(function: _F) -> _F: ...


@overload
def inner_loop(function: None = None, **options: Any) -> Callable[[_F], _F]: ...


def inner_loop(function: Any = None, **options: Any) -> Any:
    """Compile a function for other compiled loops alone.

    What lets Python and C call a loop takes as long to compile as the loop itself, where it takes
    many arrays. Without that a call by Python ends the process, so that no module may make one.

    Parameters
    ----------
    function : callable
        With types that numba knows. Division by zero gives infinity, as in NumPy.
    **options : Any
        Others of `numba.njit`, where the function is not given: as `njit` it is a decorator then.

    Returns
    -------
    callable
        What a function that `njit` compiles may call.
    """
    made = njit(**{"cache": True, "error_model": "numpy", "no_cpython_wrapper": True} | options)
    return made if function is None else made(function)


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


_FunctionCache: Any = FunctionCache


class _SharedCache(_FunctionCache):  # type: ignore[misc]
    """Compiled forms of a function on disk; who finds none has the others wait until it has one.

    Functions wait for those that they call, never the other way round, and a process that dies
    lets go of what it holds.
    """

    _held: int | None = None

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """The compiled form, or None: then it is for this process to make it and to keep it."""
        found = super().load_overload(sig, target_context)
        if found is not None:
            return found
        self._hold()
        found = super().load_overload(sig, target_context)
        if found is not None:
            self._let_go()
        return found

    def save_overload(self, sig: Any, data: Any) -> None:
        """Keep what was compiled, and let others load it."""
        try:
            super().save_overload(sig, data)
        finally:
            self._let_go()

    def _hold(self) -> None:
        try:
            import fcntl
        except ImportError:  # on Windows each process compiles for itself
            return
        if self._held is not None:
            return  # of a form that could not be compiled
        with suppress(OSError):  # a folder without locks: each process compiles for itself
            self._impl.locator.ensure_cache_path()
            place = os.path.join(self._cache_path, f"{self._impl.filename_base}.lock")
            held = os.open(place, os.O_RDWR | os.O_CREAT | os.O_CLOEXEC, 0o600)
            last = time.monotonic() + _PATIENCE
            while time.monotonic() < last:
                try:
                    fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
                except BlockingIOError:
                    time.sleep(_PAUSE)
                except OSError:
                    break
                else:
                    self._held = held
                    return
            os.close(held)

    def _let_go(self) -> None:
        if self._held is not None:
            os.close(self._held)
            self._held = None
