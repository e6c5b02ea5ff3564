"""The one place where gmsh is opened and closed."""

from __future__ import annotations

import signal
import threading
from collections.abc import Iterator
from contextlib import contextmanager

import gmsh
import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError


@contextmanager
def gmsh_session(name: str = "drivetrain", threads: int = 1) -> Iterator[None]:
    """Open gmsh with an empty model, silent and deterministic, and close it whatever happens.

    No command-line arguments and no user's configuration file are read, so that the same input
    gives the same mesh everywhere; signals do what they did before, so that Ctrl-C works.

    Parameters
    ----------
    name : str
        Name of the gmsh model.
    threads : int
        Threads for gmsh; one by default, because only then is the mesh sure to repeat.

    Raises
    ------
    InputError
        gmsh is already open in this process, or gmsh could not build or mesh the parts (its last
        message is quoted).
    """
    if gmsh.isInitialized():
        raise InputError(
            "gmsh is already open in this process, but a mesh needs a session of its own: "
            "call gmsh.finalize() first"
        )
    gmsh.initialize(argv=[], readConfigFiles=False, run=False, interruptible=False)
    try:
        _take_back_signals()
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.option.setNumber("General.NumThreads", threads)
        gmsh.option.setNumber("Mesh.RandomSeed", 1)
        gmsh.model.add(name)
        try:
            yield
        except Exception as error:
            # gmsh reports its own failures as bare Exception; every subclass is someone else's.
            if type(error) is not Exception:
                raise
            reason = gmsh.logger.getLastError() or str(error) or "no reason given"
            raise InputError(
                f"gmsh could not build or mesh {name}: {reason}; check that the parts' dimensions "
                "fit together and that no mesh size is larger than the wall it has to fill"
            ) from error
    finally:
        gmsh.finalize()


def integrate_sizes() -> None:
    """Let fields of sizes place nodes along curves to 1e-4 of an edge.

    gmsh's own 1e-9 may take ten times as long as all else of a coarse mesh.
    """
    gmsh.option.setNumber("Mesh.LcIntegrationPrecision", 1e-4)


def numbered_nodes() -> tuple[Floats, Ints]:
    """Nodes of the open gmsh model, and which of them has a tag.

    Returns
    -------
    points : ndarray, (n, 3)
        Points in the units of the model.
    number : ndarray
        Row of the points by gmsh's tag; -1 where there is none.
    """
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    number = np.full(int(tags.max()) + 1, -1, dtype=np.int64)
    number[tags] = np.arange(len(tags))
    return np.asarray(coordinates, dtype=np.float64).reshape(-1, 3), number


def _take_back_signals() -> None:
    """Undo what gmsh does behind Python's back.

    From then on a terminate signal ends the process at once, and so does writing to a pipe that
    is not read any more.
    """
    if threading.current_thread() is not threading.main_thread():
        return  # only there can it be undone
    changed = {"SIGINT", "SIGTERM", "SIGPIPE"}  # not every system has all of them
    for number in (number for number in signal.Signals if number.name in changed):
        handler = signal.getsignal(number)
        if handler is not None:  # None: not set from Python
            signal.signal(number, handler)
