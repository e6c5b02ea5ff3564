"""One shaft of one size in a process of its own: what it takes in time and, at its peak, memory.

Run as a module with the size of the elements, the elements a turn, the solver and how often each
step is done; the answer is a line of JSON.
"""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import asdict, dataclass

from fe_drivetrain.cases.references import stiffness_choices as choices
from fe_drivetrain.common import Times, peak_memory, run_python, until_stopped
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.geometry import Section, Shaft

STEPPED = Shaft(
    front=-2.0,
    sections=(
        Section(length=1.0, outer_diameter=0.7, inner_diameter=0.3),
        Section(length=1.0, outer_diameter=0.5, inner_diameter=0.3),
    ),
)
MATERIAL = MATERIALS["steel"]

MAX_SECONDS = 1800.0

#: Steps that take less than this are done several times [s].
SHORT_SECONDS = 60.0


@dataclass(frozen=True)
class Grown:
    """What one size took.

    Attributes
    ----------
    unknowns : int
        Number of unknowns of the system.
    used : str
        The solver.
    seconds : dict of str to list of float
        Wall times of each step.
    peak_bytes : int
        Largest resident memory of the process, interpreter and libraries included.
    """

    unknowns: int
    used: str
    seconds: dict[str, list[float]]
    peak_bytes: int

    @property
    def times(self) -> dict[str, Times]:
        """Time of each step."""
        return {step: Times(tuple(seconds)) for step, seconds in self.seconds.items()}

    @property
    def total(self) -> float:
        """Wall time of all steps, each the median of its runs [s]."""
        return sum(times.median for times in self.times.values())


def grown(
    size: float, turn: int, method: str = "auto", repeats: int = choices.REPEATS
) -> Grown | None:
    """Mesh, assemble and solve the stepped shaft in a process of its own.

    Parameters
    ----------
    size : float
        Element size [m].
    turn : int
        Elements round any cylinder.
    method : str, optional
        Method of `fe_drivetrain.elasticity.solve.solvers`.
    repeats : int, optional
        How often each step is done that takes less than `SHORT_SECONDS`.

    Returns
    -------
    Grown or None
        None where the process failed or took too long: no time is made up for it.
    """
    command = ["-m", __name__, str(size), str(turn), method, str(repeats)]
    try:
        done = run_python(*command, timeout=MAX_SECONDS)
        done.check_returncode()
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired):
        return None
    return Grown(**json.loads(done.stdout.splitlines()[-1]))


def _measure(size: float, turn: int, method: str, repeats: int) -> Grown:
    choices.warm_up(STEPPED, MATERIAL, [choices.CURVED])
    level = choices.Level(choices.CURVED, size, turn)
    solve = choices.Solve(method)  # type: ignore[arg-type]
    (outcome,) = choices.shaft_outcomes(STEPPED, MATERIAL, level, [solve], repeats, SHORT_SECONDS)
    seconds = {step: list(times.seconds) for step, times in outcome.times.items()}
    return Grown(outcome.unknowns, outcome.used, seconds, peak_memory() or 0)


def _main(size: str, turn: str, method: str, repeats: str) -> None:
    print(json.dumps(asdict(_measure(float(size), int(turn), method, int(repeats)))))


if __name__ == "__main__":
    sys.exit(until_stopped(lambda: _main(*sys.argv[1:])))
