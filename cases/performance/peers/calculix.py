"""CalculiX: a deck of C3D10 elements, run by ccx, the strain energy read from its .dat file.

ccx knows no mesh in memory: it reads its deck. The clock starts when it says that it has read it
and begins its step, so that it stands where the other tools stand.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import tempfile
import threading
import time
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from fe_drivetrain.cases.performance.peers.runner import Clock, Problem

NAME = "CalculiX"
INSTALL = "apt-get install calculix-ccx"
VARIANTS = {
    "spooles": ("SPOOLES", "direct", "4 points"),
    "scaling": ("ITERATIVE SCALING", "iterative", "4 points"),
    "cholesky": ("ITERATIVE CHOLESKY", "iterative", "4 points"),
    "corrected": ("ITERATIVE CHOLESKY, with Newton corrections", "iterative", "4 points"),
}
_SOLVERS = {"corrected": "ITERATIVE CHOLESKY"}

SMALL = 1e-8
"""Share of the displacement at which a step of large displacements is linear to 1e-8."""


def version() -> str:
    """ccx's version."""
    if shutil.which("ccx") is None:
        raise ImportError("there is no program ccx on the path")
    found = subprocess.run(["ccx", "-v"], capture_output=True, text=True, check=False).stdout
    return found.strip().removeprefix("This is Version").strip()


def load(problem: Problem) -> Problem:
    """The problem as it is: a deck is written for each solver."""
    return problem


def solve(problem: Problem, variant: str, clock: Clock) -> list[float]:
    """The stiffness, from the strain energy that ccx prints."""
    start = time.perf_counter()
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        (folder / "job.inp").write_text(deck(problem, variant), "ascii")
        written = time.perf_counter()
        log = _run(folder)
        ended = time.perf_counter()
        times = read_log(log.lines)
        clock.elsewhere = log.peak_bytes
        clock.steps = {key: times[key] for key in ("assembly", "solve")}
        clock.iterations = times["iterations"]
        clock.notes["threads"] = times["threads"]
        energy = read_energy((folder / "job.dat").read_text("ascii"))
        clock.uncounted = written - start + times["reading"] + time.perf_counter() - ended
    scale = SMALL if variant == "corrected" else 1.0
    return [2 * energy / scale**2]


def deck(problem: Problem, variant: str) -> str:
    """The input deck of a problem for one of ccx's solvers."""
    lines = ["*NODE, NSET=NALL"]
    lines += [
        f"{i},{x:.12e},{y:.12e},{z:.12e}" for i, (x, y, z) in enumerate(problem.points.tolist(), 1)
    ]
    ids = np.arange(1, len(problem.cells) + 1)
    for group, (E, nu) in enumerate(
        zip(problem.youngs_modulus.tolist(), problem.poisson_ratio.tolist(), strict=True)
    ):
        lines.append(f"*ELEMENT, TYPE=C3D10, ELSET=E{group}")
        chosen = problem.material == group
        rows = np.column_stack([ids[chosen], problem.cells[chosen] + 1]).tolist()
        lines += [",".join(map(str, row)) for row in rows]
        lines += [f"*MATERIAL, NAME=M{group}", "*ELASTIC", f"{E!r},{nu!r}"]
        lines.append(f"*SOLID SECTION, ELSET=E{group}, MATERIAL=M{group}")
    lines.append("*ELSET, ELSET=EALL")
    lines += [f"E{group}" for group in range(len(problem.youngs_modulus))]
    corrected = variant == "corrected"
    lines.append("*STEP, NLGEOM" if corrected else "*STEP")
    lines.append(f"*STATIC, SOLVER={_SOLVERS.get(variant, VARIANTS[variant][0])}")
    if corrected:
        # Newton goes on until what the iterative solver left is small beside the forces
        lines += ["1.,1.", "*CONTROLS, PARAMETERS=FIELD", "1e-7,1e-4"]
    lines.append("*BOUNDARY")
    scale = SMALL if corrected else 1.0
    nodes, values = problem.prescribed()
    for node, value in zip((nodes + 1).tolist(), (scale * values).tolist(), strict=True):
        lines += [f"{node},{k},{k},{u:.12e}" for k, u in enumerate(value, 1)]
    lines += ["*EL PRINT, ELSET=EALL, TOTALS=ONLY", "ELSE", "*END STEP", ""]
    return "\n".join(lines)


def read_energy(text: str) -> float:
    """Strain energy of the whole mesh [J] from a .dat file."""
    found = re.findall(r"total internal energy.*?\n\s*([-+0-9.E]+)", text)
    if not found:
        raise ValueError("ccx printed no total internal energy: it did not come to the end")
    return float(found[-1])


def read_log(lines: Sequence[tuple[float, str]]) -> dict[str, Any]:
    """What ccx says while it runs.

    Parameters
    ----------
    lines : Sequence[tuple[float, str]]
        Each line with the time at which it came [s].

    Returns
    -------
    times
        "reading" until the step begins, "assembly" and "solve", summed over Newton's corrections
        [s]; "iterations", None for a direct solver; "threads" in words.
    """
    reading: float | None = None
    iterations: int | None = None
    threads = set()
    sums = {"assembly": 0.0, "solve": 0.0}
    now, since = None, 0.0
    for at, line in lines:
        if reading is None and re.match(r"STEP\s+1$", line):
            reading, now, since = at, "assembly", at
        elif line.startswith(("Factoring the system", "Solving the system")):
            sums["assembly"] += at - since
            now, since = "solve", at
        elif now == "solve" and line.endswith("for the stress calculation."):
            sums["solve"] += at - since
            now, since = "assembly", at
        elif found := re.match(r"# of iterations = (\d+)", line):
            iterations = (iterations or 0) + int(found[1])
        if found := re.match(r"Using up to (\d+) cpu\(s\) for", line):
            threads.add(int(found[1]))
    if reading is None:
        raise ValueError("ccx did not come to its first step")
    return {
        **sums,
        "reading": reading,
        "iterations": iterations,
        "threads": " and ".join(map(str, sorted(threads))),
    }


@dataclass(frozen=True)
class _Log:
    """Lines with the time at which each came [s], and ccx's peak memory [bytes]."""

    lines: list[tuple[float, str]]
    peak_bytes: int


def _run(folder: Path) -> _Log:
    """Run ccx on job.inp.

    Raises
    ------
    RuntimeError
        It failed.
    """
    # on a terminal ccx shows each line at once, in a file at the end
    import pty  # not on Windows, where nothing is launched

    terminal, inner = pty.openpty()
    start = time.perf_counter()
    process = subprocess.Popen(["ccx", "job"], cwd=folder, stdout=inner, stderr=inner)
    os.close(inner)
    peak = _Peak(process.pid)
    lines: list[tuple[float, str]] = []
    rest = b""
    try:
        # at the end of its last writer a terminal has no end of file, but an error
        with suppress(OSError):
            while block := os.read(terminal, 65536):
                *whole, rest = (rest + block).split(b"\n")
                at = time.perf_counter() - start
                lines += [(at, line.decode("utf-8", "replace").strip()) for line in whole]
        status = process.wait()
    finally:
        os.close(terminal)
        if process.poll() is None:
            process.kill()
    if status != 0:
        said = " ".join(line for _, line in lines[-12:] if line)
        raise RuntimeError(f"ccx ended with status {status}: {said}")
    return _Log(lines, peak.bytes)


class _Peak(threading.Thread):
    """Watches the largest resident memory of a process while it lives."""

    def __init__(self, pid: int) -> None:
        super().__init__(daemon=True)
        self.bytes = 0
        self._status = Path(f"/proc/{pid}/status")
        self.start()

    def run(self) -> None:
        while True:
            try:
                text = self._status.read_text("ascii")
            except OSError:
                return
            found = re.search(r"VmHWM:\s+(\d+)", text)
            if found is None:
                return
            self.bytes = 1024 * int(found[1])
            time.sleep(0.005)
