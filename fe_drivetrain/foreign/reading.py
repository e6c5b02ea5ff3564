"""Files of other programs, read in a process of limited memory, time and output.

Such a file may be damaged, huge, or made to harm: libraries that read it may then crash, run for
hours or take all memory. Here, that ends in one sentence.
"""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import scratch_folder
from fe_drivetrain.common.progress import DETAILS
from fe_drivetrain.common.reading import why_unreadable
from fe_drivetrain.common.regular_files import MAX_BYTES, require_regular
from fe_drivetrain.common.threads import thread_limits

Arrays = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Limits:
    """Limits on reading one file.

    Attributes
    ----------
    file : int
        Maximum size of the file [bytes].
    memory : int
        Address space of the process [bytes].
    seconds : int
        Processor time of the process [s]; the wall time may be twice as long.
    result : int
        Maximum size of what it hands back [bytes].
    """

    file: int = MAX_BYTES
    memory: int = 6_000_000_000
    seconds: int = 900
    result: int = 1_000_000_000


LIMITS = Limits()

_LOOK = 0.2  # seconds between looks at how far the process is
_TOO_LATE = -1000  # in place of the exit status of a process that waits for long


def read_in_process(
    action: str, path: str | Path, request: Mapping[str, Any], limits: Limits = LIMITS
) -> Arrays:
    """Have a file read by a process of its own.

    Parameters
    ----------
    action : str
        "look", "mesh step", "mesh further part" or "read mesh", see `child`; or a function as in
        "package.module:function", which is given the request and returns arrays by name.
    path : str or Path
        The file.
    request : Mapping[str, Any]
        Further values that the action needs, as plain data.
    limits : Limits
        Limits on the process.

    Returns
    -------
    dict
        Arrays by name.

    Raises
    ------
    InputError
        There is no such file, it is too large, it takes more than the limits, or it has a fault.
    """
    file = Path(path)
    _check_file(file, limits)
    with scratch_folder() as folder:
        asked, result = folder / "request.json", folder / "result.npz"
        bounds = {"bytes": limits.memory, "seconds": limits.seconds, "file": limits.result}
        content = {**request, "action": action, "file": str(file.resolve()), "limits": bounds}
        asked.write_text(json.dumps(content))
        environment = {**os.environ, **thread_limits(1), "PYTHONSAFEPATH": "1"}
        command = [sys.executable, "-m", "fe_drivetrain.foreign.child", str(asked), str(result)]
        with (folder / "printed").open("w+b") as printed:
            process = subprocess.Popen(
                command,
                cwd=folder,
                env=environment,
                stdin=subprocess.DEVNULL,
                stdout=printed,
                stderr=printed,
            )
            status = _watched(process, told_file(result), 2.0 * limits.seconds)
        if status == 0:
            with np.load(result, allow_pickle=False) as archive:
                return {name: archive[name] for name in archive.files}
        sentence = result.with_suffix(".txt")
        if status == 3 and sentence.exists() and (text := sentence.read_text()) != "MEMORY":
            raise InputError(text)
    raise InputError(_ended(file, status, limits))


def told_file(result: str | Path) -> Path:
    """File beside a result to which the process writes how far it is, a line for each step."""
    return Path(result).with_suffix(".steps")


def _watched(process: subprocess.Popen[bytes], told: Path, seconds: float) -> int:
    """Exit status of a process, of which each step is shown as it begins; it ends with this one."""
    show, shown, end = DETAILS.get(), 0, time.monotonic() + seconds
    try:
        while True:
            with suppress(subprocess.TimeoutExpired):
                process.wait(_LOOK)
            shown = _show_told(told, shown, show)
            if process.returncode is not None:
                return process.returncode
            if time.monotonic() > end:
                return _TOO_LATE
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()


def _show_told(told: Path, shown: int, show: Callable[[str], None]) -> int:
    """Show the last step that a process has told of after as many; how many there are now."""
    if not told.exists():
        return shown
    steps = told.read_text("utf-8").split("\n")[:-1]
    if len(steps) > shown:
        show(steps[-1])
    return len(steps)


def _check_file(file: Path, limits: Limits) -> None:
    try:
        require_regular(file)
    except (OSError, ValueError) as error:
        raise InputError(f"cannot read {file}: {why_unreadable(error)}") from error
    size = file.stat().st_size
    if not 0 < size <= limits.file:
        raise InputError(
            f"{file.name} has {size} bytes but must have 1 to {limits.file}: save the one part "
            "alone, without details that carry nothing"
        )


def _named(status: int) -> str:
    """An exit status in words: the name of the signal that ended a process, if one did."""
    with suppress(ValueError):
        return signal.Signals(-status).name
    return f"status {status}"


def _ended(file: Path, status: int, limits: Limits) -> str:
    if status in (-getattr(signal, "SIGXCPU", 24), -getattr(signal, "SIGKILL", 9)):
        what = f"takes more than {limits.seconds} s of processor time"
    elif status == _TOO_LATE:
        what = f"takes more than {2 * limits.seconds} s"
    elif status == -getattr(signal, "SIGPROF", 27):
        what = "makes its reader go on without end, for it is damaged or cut off"
    elif status == 3:
        what = f"takes more than {limits.memory / 1e9:g} GB of memory"
    elif status in (-getattr(signal, "SIGXFSZ", 25),):
        what = f"makes more than {limits.result / 1e9:g} GB of data"
    else:
        what = (
            f"makes its reader fail, most likely for want of memory ({limits.memory / 1e9:g} GB) "
            f"or because it is damaged (the reader ended with {_named(status)})"
        )
    return f"{file.name} {what}: write it again, whole, with fewer and larger faces or elements"
