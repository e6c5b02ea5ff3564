"""Exit statuses, errors as one sentence, signals, and streams whose reader went away."""

from __future__ import annotations

import os
import shlex
import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TextIO

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import sentence_about

if TYPE_CHECKING:
    from types import FrameType

PASSED, FAILED, MISTAKE, STOPPED, TERMINATED = 0, 1, 2, 130, 143
"""Exit statuses: all checks pass, one fails, wrong input, stopped by Ctrl-C, stopped by SIGTERM."""

KEPT = "results of an earlier run are unchanged"

_AGAIN = 0.2  # s, until a stop that nothing has taken up is raised again


def as_typed() -> str:
    """The words of this command, to be typed again."""
    return shlex.join(["fe-drivetrain", *sys.argv[1:]])


def guarded(work: Callable[[], int], kept: str = KEPT) -> int:
    """Do the work of a command; mistakes of the user become one sentence on standard error.

    Parameters
    ----------
    work : callable
        Returns the exit status.
    kept : str
        What a stop by Ctrl-C leaves on disk, for the message.

    Returns
    -------
    int
        Exit status: that of the work, `MISTAKE` or `STOPPED`.

    Raises
    ------
    SystemExit
        With `TERMINATED`, on SIGTERM.
    """
    try:
        with _stopped_by_terminate():
            return work()
    except InputError as error:
        message, status = str(error), MISTAKE
    except (KeyboardInterrupt, SystemError) as error:
        # Python makes the second of Ctrl-C in compiled code of a library, as numba's
        if not any(isinstance(e, KeyboardInterrupt) for e in (error, error.__cause__)):
            raise
        message, status = f"stopped; {kept}", STOPPED
    except OSError as error:
        sentence = sentence_about(error)
        if sentence is None:
            raise
        message, status = sentence, MISTAKE
    except RuntimeError as error:
        # what Path.resolve raises before Python 3.13
        if "Symlink loop" not in str(error):
            raise
        message, status = f"cannot write: {error}: give another folder with --out", MISTAKE
    write(sys.stderr, f"fe-drivetrain: {message}\n")
    return status


@contextmanager
def _stopped_by_terminate() -> Iterator[None]:
    """Unwind on SIGTERM as on Ctrl-C, so that no half-written file is left.

    What is raised in a callback of a library is dropped there, as in compiled code that is loaded:
    so it is raised again, until something unwinds.
    """

    def stop(number: int, frame: FrameType | None) -> None:
        if hasattr(signal, "setitimer"):  # not on Windows
            signal.setitimer(signal.ITIMER_REAL, _AGAIN)
        if not isinstance(sys.exc_info()[1], SystemExit):
            raise SystemExit(TERMINATED)

    numbers = [signal.SIGTERM, *([signal.SIGALRM] if hasattr(signal, "SIGALRM") else [])]
    try:
        before = {number: signal.signal(number, stop) for number in numbers}
    except ValueError:  # only the main thread may handle signals
        yield
        return
    try:
        yield
    finally:
        if hasattr(signal, "setitimer"):
            signal.setitimer(signal.ITIMER_REAL, 0.0)
        for number, handler in before.items():
            signal.signal(number, handler)


def write(stream: TextIO, text: str) -> None:
    """Write and flush; it is no error when the reader has gone away, as in ``| head``.

    Parameters
    ----------
    stream : TextIO
        Standard output or standard error.
    text : str
        What to write, with its line ends.
    """
    try:
        stream.write(text)
        stream.flush()
    except BrokenPipeError:
        # what is still in the stream's buffer must not fail again when Python exits
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, stream.fileno())
        os.close(nowhere)


def prepare_streams() -> None:
    """Show warnings as one sentence, and characters that the terminal does not have as "?"."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="replace")
    warnings.showwarning = _show_warning


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    write(sys.stderr, f"fe-drivetrain: warning: {message}\n")
