"""Never more threads than cores: how many there are, and what numerical libraries may take of them.

Most numerical libraries read the number of their threads from the environment when they are first
imported; `threadpoolctl` changes it in those that are loaded already.
"""

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from functools import cache
from typing import Any

from fe_drivetrain.common.errors import InputError

CORES_VARIABLE = "FE_DRIVETRAIN_CORES"
"""Environment variable: the most cores to use; with 1 there is one process with one thread."""

_THREADS = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "BLIS_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
    "NUMEXPR_NUM_THREADS",
    "NUMBA_NUM_THREADS",
    "VTK_SMP_MAX_THREADS",
    "LP_NUM_THREADS",  # Mesa's software renderer, which draws the pictures
)


def cores() -> int:
    """Cores to share among processes: those the system gives this one, or as `CORES_VARIABLE` says.

    Returns
    -------
    count : int
        At least 1.

    Raises
    ------
    InputError
        The variable holds no whole number from 1 on.
    """
    named = os.environ.get(CORES_VARIABLE, "").strip()
    if named:
        if not named.isdecimal() or int(named) < 1:
            raise InputError(
                f"{CORES_VARIABLE} is {named!r}: give a whole number of cores, from 1 on"
            )
        return int(named)
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def thread_limits(threads: int) -> dict[str, str]:
    """Environment variables that limit numerical libraries which are not imported yet.

    Parameters
    ----------
    threads : int
        The most threads of each library; fewer where the user has set fewer.

    Returns
    -------
    variables : dict
        Values by name.
    """
    limits = {}
    for name in _THREADS:
        given = os.environ.get(name, "")
        fewer = given.isdecimal() and 0 < int(given) < threads
        limits[name] = given if fewer else str(threads)
    return limits


def hold_threads() -> None:
    """Where the user limits the cores, limit what this process imports from now on to as many.

    OpenBLAS gets one thread, unless the user says otherwise: matrices that go to it are small. On a
    machine with nothing else to do, two threads are no faster; where others work on it, too, they
    wait for each other in each of thousands of calls, and modes of a drivetrain take three times as
    long. Where it is given several, they sleep when idle: they would spin for tens of milliseconds
    after each call, and take the cores from compiled loops. Threads of compiled loops would spin as
    long at the end of each for the last to come: a study then took three times as long. They spin
    for about a millisecond, which is longer than from one loop of a solver to the next: where they
    slept at once, small systems would take a third longer.
    """
    os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")
    os.environ.setdefault("OPENBLAS_THREAD_TIMEOUT", "4")  # 2^4 cycles
    os.environ.setdefault(
        "GOMP_SPINCOUNT", "20000"
    )  # of GNU's OpenMP, which numba's threads are of
    if os.environ.get(CORES_VARIABLE):
        limits = thread_limits(cores())
        if "numba" in sys.modules:  # which fails at another number once its threads run
            del limits["NUMBA_NUM_THREADS"]
        os.environ.update(limits)


@contextmanager
def one_blas_thread() -> Iterator[None]:
    """Hold the BLAS of NumPy and SciPy to one thread, at little cost.

    Where it does next to nothing: afterwards its idle threads spin, and take the cores from
    compiled loops. Those loaded after the first call are not held.
    """
    with _controller().limit(limits=1, user_api="blas"):
        yield


@cache
def _controller() -> Any:
    import scipy.linalg  # noqa: F401
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()


@contextmanager
def held_to_one_thread() -> Iterator[None]:
    """Keep the numerical libraries of this process, which are loaded already, to one thread."""
    from threadpoolctl import threadpool_limits  # type: ignore[import-untyped]

    numba = sys.modules.get("numba")
    before = numba.get_num_threads() if numba is not None else 0
    if numba is not None:
        numba.set_num_threads(1)
    try:
        with threadpool_limits(1):
            yield
    finally:
        if numba is not None:
            numba.set_num_threads(before)
