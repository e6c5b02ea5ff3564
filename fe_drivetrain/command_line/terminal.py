"""Exit statuses, errors as one sentence, signals, and streams whose reader went away."""

from __future__ import annotations

import io
import os
import shlex
import signal
import sys
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, TextIO

from fe_drivetrain.command_line.option_names import with_options
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import sentence_about
from fe_drivetrain.common.stopped import STOPPED, TERMINATED, left_by_stop, replacing, stop_status

if TYPE_CHECKING:
    from types import FrameType

PASSED, FAILED, MISTAKE = 0, 1, 2
"""Exit statuses: all checks pass, one fails, wrong input."""

_AGAIN = 0.2  # s, until a stop that nothing has taken up is raised again

_unwinding = False  # whether handlers are in place: for a program, from its first moments on


def as_typed() -> str:
    """The words of this command, to be typed again."""
    return shlex.join(["fe-drivetrain", *sys.argv[1:]])


def guarded(work: Callable[[], int], kept: str | None = None) -> int:
    """Do the work of a command; mistakes of the user become one sentence on standard error.

    Parameters
    ----------
    work : callable
        Returns the exit status.
    kept : str or None
        What a stop by Ctrl-C leaves on disk, for the message; None for what it leaves of results.

    Returns
    -------
    int
        Exit status: that of the work, `MISTAKE` or `STOPPED`.

    Raises
    ------
    SystemExit
        With `TERMINATED`, on SIGTERM.
    """
    replacing(False)
    try:
        with _unwound_by_signals():
            return work()
    except BaseException as error:
        stop = stop_status(error)
        if stop == TERMINATED:
            raise SystemExit(TERMINATED) from error
        sentence = f"stopped; {kept or left_by_stop()}" if stop == STOPPED else _sentence(error)
        if sentence is None:
            raise
    write(sys.stderr, f"fe-drivetrain: {sentence}\n")
    return stop or MISTAKE


def ended(command: Callable[[], object]) -> None:
    """Do what was typed; a stop that comes outside of `guarded` ends the program as one inside.

    Raises
    ------
    SystemExit
        What reads the words typed may have made another status of a stop.
    """
    try:
        with _unwound_by_signals():
            command()
    except BaseException as error:
        stop = stop_status(error)
        if stop is None:
            raise
        raise SystemExit(stop) from error


def _sentence(error: BaseException) -> str | None:
    """What the user can do about an error; None where it is the program's own."""
    if isinstance(error, InputError):
        return with_options(str(error))
    if isinstance(error, OSError):
        return sentence_about(error)
    # what Path.resolve raises before Python 3.13
    if isinstance(error, RuntimeError) and "Symlink loop" in str(error):
        return f"cannot write: {error}: give another folder with --out"
    return None


@contextmanager
def _unwound_by_signals() -> Iterator[None]:
    """Unwind on SIGTERM as on Ctrl-C, so that no half-written file is left.

    What is raised in a callback of a library is dropped there, as in compiled code that is loaded,
    and where any error of a library is caught: so it is raised again, until all is unwound.
    """
    global _unwinding
    if _unwinding:
        try:
            yield
        finally:
            _forget_stop()
        return
    raised: dict[int, Callable[[], BaseException]] = {
        signal.SIGTERM: lambda: SystemExit(TERMINATED),
        signal.SIGINT: KeyboardInterrupt,
    }
    sent = signal.SIGTERM

    def stop(number: int, frame: FrameType | None) -> None:
        nonlocal sent
        sent = signal.Signals(number) if number in raised else sent
        if hasattr(signal, "setitimer"):  # not on Windows
            signal.setitimer(signal.ITIMER_REAL, _AGAIN)
        if stop_status(sys.exc_info()[1]) is None:
            raise raised[sent]()

    numbers = [signal.SIGTERM, *([signal.SIGALRM] if hasattr(signal, "SIGALRM") else [])]
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:  # or it is ignored
        numbers.append(signal.SIGINT)
    try:
        before = {number: signal.signal(number, stop) for number in numbers}
    except ValueError:  # only the main thread may handle signals
        yield
        return
    _unwinding, dropped = True, sys.unraisablehook
    sys.unraisablehook = lambda error: None if stop_status(error.exc_value) else dropped(error)
    try:
        yield
    finally:
        _forget_stop()
        _unwinding, sys.unraisablehook = False, dropped
        for number, handler in before.items():
            signal.signal(number, handler)


def _forget_stop() -> None:
    """Raise no stop again, for all has been unwound."""
    if hasattr(signal, "setitimer"):
        signal.setitimer(signal.ITIMER_REAL, 0.0)


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


class Stream(io.TextIOBase):
    """A stream for rich; it is no error when its reader has gone away.

    Parameters
    ----------
    stream : TextIO
        Standard output or standard error, as it is now.
    """

    def __init__(self, stream: TextIO) -> None:
        self._stream = stream

    def write(self, text: str) -> int:
        """Write and flush; number of characters."""
        write(self._stream, text)
        return len(text)

    def isatty(self) -> bool:
        """Whether it is a terminal."""
        return self._stream.isatty()

    def fileno(self) -> int:
        """Number of its file."""
        return self._stream.fileno()


def prepare_streams() -> None:
    """Show warnings as one sentence, and characters that the terminal does not have as "?"."""
    for stream in (sys.stdout, sys.stderr):
        reconfigure = getattr(stream, "reconfigure", None)
        if reconfigure is not None:
            reconfigure(errors="replace")
    warnings.showwarning = _show_warning


def _show_warning(message: Warning | str, *_: Any, **__: Any) -> None:
    write(sys.stderr, f"fe-drivetrain: warning: {message}\n")
