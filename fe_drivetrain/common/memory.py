"""Memory of this process: how much it took, and that it uses again what it has."""

import atexit
import ctypes
import gc
import os
import sys
from pathlib import Path

STATUS = Path("/proc/self/status")

# Of mallopt(3): from which size on an array is mapped by itself, from how much free memory on the
# system gets it back, and how many threads have memory of their own.
_MAXIMUM = 2**30
_OPTIONS = {
    "MALLOC_MMAP_THRESHOLD_": (-3, _MAXIMUM),
    "MALLOC_TRIM_THRESHOLD_": (-1, _MAXIMUM),
    "MALLOC_ARENA_MAX": (-8, 1),
}

# Of gc.set_threshold: passes through what is younger before one through all; 10 is Python's own.
_SELDOM = 100


def collect_lasting_seldom() -> None:
    """Let the collector of garbage seldom go through what has lasted, and not at the end.

    For a program, whose modules and compiled loops last to its end: to go through all of them each
    time that a quarter has been added took a twentieth of `advise` in a first run, and at the end
    some tenths of a second. What is young is collected as before, so that an array in a cycle does
    not stay.
    """
    young, middle, _ = gc.get_threshold()
    gc.set_threshold(young, middle, _SELDOM)
    atexit.register(gc.freeze)


def keep_freed_memory() -> None:
    """Let new arrays take the memory of freed ones, up to 1 GiB, before the system is asked.

    GNU's C library hands the memory of large arrays back to the system at once, which then clears
    every page of the next array again: at 10 k unknowns a fifth of a solve, and most of the time
    that the kernel takes at a million. And arrays of another thread would not take what this one
    has freed. A user's ``MALLOC_MMAP_THRESHOLD_``, ``MALLOC_TRIM_THRESHOLD_`` or
    ``MALLOC_ARENA_MAX`` stays, and other C libraries are left as they are.
    """
    if sys.platform != "linux":
        return
    library = ctypes.CDLL(None)
    for name, (number, value) in _OPTIONS.items():
        if hasattr(library, "mallopt") and name not in os.environ:
            library.mallopt(number, value)


def peak_memory() -> int | None:
    """Largest resident memory of this process so far [bytes].

    Returns
    -------
    int or None
        None where the system does not say, as Windows.
    """
    # Linux hands ru_maxrss on from the process that started this one; VmHWM is this one's own
    lines = STATUS.read_text(encoding="ascii").splitlines() if STATUS.exists() else []
    found = [line.split() for line in lines if line.startswith("VmHWM:")]
    if found:
        return 1024 * int(found[0][1])
    try:
        import resource
    except ImportError:
        return None
    # Linux counts in KiB, macOS in bytes
    unit = 1 if sys.platform == "darwin" else 1024
    return unit * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
