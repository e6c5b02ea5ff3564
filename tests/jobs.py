"""Jobs of tests, as other processes import them: each start of one pays for what stands here."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.processes import Processes
from fe_drivetrain.common.progress import Progress

if TYPE_CHECKING:
    import numpy as np


def until(condition: Callable[[], bool]) -> None:
    """Wait for what must come; a hang is a failure."""
    end = time.monotonic() + 60
    while not condition():
        assert time.monotonic() < end
        time.sleep(0.02)


def square(report: Progress, x: float) -> tuple[int, float]:
    return os.getpid(), x * x


def meet(report: Progress, folder: Path, name: str, other: str) -> bool:
    """Ends only if the other job runs at the same time."""
    (folder / name).touch()
    until(lambda: (folder / other).exists())
    return True


def threads(report: Progress) -> tuple[int, dict[str, str]]:
    import numpy as np
    from threadpoolctl import threadpool_info

    np.ones((300, 300)) @ np.ones((300, 300))
    names = ("OMP_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")
    return (
        max(library["num_threads"] for library in threadpool_info()),
        {name: os.environ[name] for name in names},
    )


def steps(report: Progress, name: str) -> int:
    report(f"first of {name}")
    report(f"second of {name}")
    return os.getpid()


def mistake(report: Progress) -> None:
    raise InputError("shaft: length is -1 but must be greater than 0: give a length")


class OddError(Exception):
    """Cannot be made again from its arguments, so cannot be pickled."""

    def __init__(self, one: int, two: int) -> None:
        super().__init__(f"{one} and {two}")


def odd(report: Progress) -> None:
    raise OddError(1, 2)


def fault(report: Progress) -> float:
    return 1 / 0


def end(report: Progress, number: int) -> None:
    if number < 0:
        os.kill(os.getpid(), -number)
    sys.stderr.write("last words\n")
    sys.stderr.flush()
    os._exit(number)


def sleep_for_ever(report: Progress, folder: Path) -> None:
    (folder / str(os.getpid())).touch()
    time.sleep(600)


def talk(report: Progress) -> str:
    print("out")
    os.write(1, b"raw out\n")
    sys.stdin.read()  # nobody types here
    subprocess.run([sys.executable, "-c", "print('child')"], check=True)
    return "done"


def nested(report: Progress) -> tuple[int, int]:
    with Processes(4) as processes:
        return os.getpid(), processes.start(square, 2.0).result()[0]


def large(report: Progress, array: np.ndarray) -> np.ndarray:
    return array[::-1]


#: Standard modules that jobs, or a process that starts, may import.
MODULES = ("random", "signal", "socket", "tempfile", "threading")


def places(report: Progress) -> list[str]:
    return [str(importlib.import_module(name).__file__) for name in MODULES]


def leave_a_child(report: Progress, folder: Path) -> None:
    child = subprocess.Popen([sys.executable, "-c", "import time; time.sleep(600)"])
    (folder / str(child.pid)).touch()
    child.wait()


def hold_a_lock(report: Progress) -> None:
    """Leaves a lock that only the end of its process frees."""
    import multiprocessing

    _held.append(multiprocessing.get_context("spawn").Lock())


_held: list[object] = []
