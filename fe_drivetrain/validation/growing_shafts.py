"""One shaft of one size in a process of its own: what it takes in time and, at its peak, memory.

Run as a module with the size of the elements, the elements a turn and the solver; the answer is a
line of JSON.
"""

from __future__ import annotations

import json
import subprocess
import sys
from dataclasses import dataclass

from fe_drivetrain.common import peak_memory, run_python
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.validation import stiffness_choices as choices

STEPPED = Shaft(
    front=-2.0,
    sections=(
        Section(length=1.0, outer_diameter=0.7, inner_diameter=0.3),
        Section(length=1.0, outer_diameter=0.5, inner_diameter=0.3),
    ),
)
MATERIAL = MATERIALS["steel"]

MOST_SECONDS = 600.0


@dataclass(frozen=True)
class Grown:
    """What one size took.

    Attributes
    ----------
    unknowns : int
        Of the system.
    used : str
        The solver.
    seconds : dict of str to float
        Wall time of each step.
    peak_bytes : int
        Largest resident memory of the process, interpreter and libraries included.
    """

    unknowns: int
    used: str
    seconds: dict[str, float]
    peak_bytes: int

    @property
    def total(self) -> float:
        """Wall time of all steps [s]."""
        return sum(self.seconds.values())


def grown(size: float, turn: int, method: str = "auto") -> Grown | None:
    """Mesh, assemble and solve the stepped shaft in a process of its own.

    Parameters
    ----------
    size : float
        Element size [m].
    turn : int
        Elements round any cylinder.
    method : str, optional
        Of `fe_drivetrain.solve.solvers`.

    Returns
    -------
    Grown or None
        None where the process failed or took too long: no time is made up for it.
    """
    command = ["-m", __name__, str(size), str(turn), method]
    try:
        done = run_python(*command, timeout=MOST_SECONDS)
        done.check_returncode()
    except (subprocess.CalledProcessError, subprocess.TimeoutExpired):
        return None
    return Grown(**json.loads(done.stdout.splitlines()[-1]))


def _measure(size: float, turn: int, method: str) -> Grown:
    choices.warm_up(STEPPED, MATERIAL, [choices.CURVED])
    level = choices.Level(choices.CURVED, size, turn)
    solve = choices.Solve(method)  # type: ignore[arg-type]
    (outcome,) = choices.shaft_outcomes(STEPPED, MATERIAL, level, [solve])
    return Grown(outcome.unknowns, outcome.used, outcome.seconds, peak_memory() or 0)


if __name__ == "__main__":
    from dataclasses import asdict

    print(json.dumps(asdict(_measure(float(sys.argv[1]), int(sys.argv[2]), sys.argv[3]))))
