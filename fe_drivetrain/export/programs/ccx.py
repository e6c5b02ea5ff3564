"""CalculiX's solver ccx, run on a deck."""

import os
import shutil
import subprocess
from pathlib import Path

from fe_drivetrain.common.errors import MissingToolError

INSTALL = "apt-get install calculix-ccx"


def find_calculix(executable: str = "ccx") -> str:
    """Path of CalculiX's solver.

    Raises
    ------
    MissingToolError
        There is no such program.
    """
    program = shutil.which(executable)
    if program is None:
        raise MissingToolError(
            f"CalculiX: there is no program {executable!r} on the path: install it with {INSTALL}"
        )
    return program


def run_calculix(path: str | Path, executable: str = "ccx", threads: int = 1) -> Path:
    """Run ccx on a deck; its output is written beside it.

    Parameters
    ----------
    path : str or Path
        The deck.
    executable : str
        Name or path of CalculiX's solver.
    threads : int
        That it may use.

    Returns
    -------
    dat
        The .dat file, for `read_dat` and `read_response`.

    Raises
    ------
    MissingToolError
        There is no such program.
    RuntimeError
        It did not finish; the message has its last output.
    """
    program = find_calculix(executable)
    deck = Path(path).resolve()
    dat = deck.with_suffix(".dat")
    dat.unlink(missing_ok=True)
    wanted = {name: str(threads) for name in ("OMP_NUM_THREADS", "CCX_NPROC_EQUATION_SOLVER")}
    process = subprocess.run(
        [program, "-i", deck.stem],
        cwd=deck.parent,
        env=os.environ | wanted,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        check=False,
    )
    if process.returncode != 0 or "*ERROR" in process.stdout or not dat.is_file():
        last = process.stdout.splitlines()[-12:]
        last_words = " ".join(line.strip() for line in last if line.strip())
        raise RuntimeError(f"ccx ended with status {process.returncode}: {last_words}")
    return dat
