"""A file in OpenCASCADE's own text form (.brep), looked at before it is read, and read in time.

Where its text ends early or a number is none, OpenCASCADE reads on for ever.
"""

from __future__ import annotations

import re
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

from fe_drivetrain.common.errors import InputError

_SECONDS, _SECONDS_PER_MB = 3.0, 20.0  # many times what a sound file takes


def refuse_cut_off(path: str) -> None:
    """Refuse a file that does not begin as such, or ends before all of its shapes.

    Parameters
    ----------
    path : str
        File ending in .brep.

    Raises
    ------
    InputError
        The message says what is missing.
    """
    text = Path(path).read_text("latin-1")
    count = re.search(r"^TShapes (\d+)\s*$", text, re.MULTILINE)
    if "CASCADE Topology V" not in text[:500] or count is None:
        raise _damaged(path, "it has no head of CASCADE Topology, or no TShapes")
    shapes = re.findall(r"^(?:Ve|Ed|Wi|Fa|Sh|So|CS|Co)\s*$", text[count.end() :], re.MULTILINE)
    if len(shapes) != int(count[1]):
        raise _damaged(path, f"it has {len(shapes)} shapes, not the {count[1]} that it states")
    if not re.search(r"[-+]\d+ \d+\s*$", text[-100:], re.ASCII):
        raise _damaged(path, "it ends within a shape")


@contextmanager
def in_time(path: str) -> Iterator[None]:
    """End this process where reading takes much longer than a sound file of that size.

    Parameters
    ----------
    path : str
        The file.
    """
    if not hasattr(signal, "setitimer"):  # there is none on Windows
        yield
        return
    seconds = _SECONDS + _SECONDS_PER_MB * Path(path).stat().st_size / 1e6
    signal.signal(signal.SIGPROF, signal.SIG_DFL)
    signal.setitimer(signal.ITIMER_PROF, seconds)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_PROF, 0.0)


def _damaged(path: str, why: str) -> InputError:
    return InputError(f"{Path(path).name} cannot be read as BREP ({why}): export it again, whole")
