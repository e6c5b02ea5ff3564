"""Other Python interpreters: fresh ones that import what this process does, and the system's."""

import os
import shutil
import subprocess
import sys
from collections.abc import Mapping


def run_python(
    *arguments: str, environment: Mapping[str, str] | None = None, timeout: float | None = None
) -> subprocess.CompletedProcess[str]:
    """Run Python with these arguments in a process of its own, and wait for its end.

    It searches modules where this process does, so that both use the same package, and not in the
    current folder, where a module of the user could hide one of ours. It reads nothing from the
    terminal.

    Parameters
    ----------
    *arguments : str
        Arguments of the interpreter, as in ``"-m", "fe_drivetrain.cases.group.name", "5.0"``.
    environment : mapping, optional
        Variables that differ from those of this process.
    timeout : float, optional
        The longest time that it may take [s].

    Returns
    -------
    done : subprocess.CompletedProcess
        Its status and, as text, what it wrote.

    Raises
    ------
    subprocess.TimeoutExpired
        It took longer, and was ended.
    """
    path = os.pathsep.join(str(folder) for folder in sys.path if folder)
    return subprocess.run(
        [sys.executable, "-P", *arguments],
        env={**os.environ, "PYTHONPATH": path, **(environment or {})},
        stdin=subprocess.DEVNULL,
        capture_output=True,
        text=True,
        timeout=timeout,
        check=False,
    )


def interpreters() -> list[str]:
    """This Python, and the system's own, where packages of the distribution are."""
    system = shutil.which("python3", path=os.defpath)
    return [sys.executable, *([system] if system else [])]
