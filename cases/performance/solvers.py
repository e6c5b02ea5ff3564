"""Which solver is fastest for which solid, and does ``auto`` know? How honest is the stopping?"""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run


def run(run: Run) -> Any:
    """Time the grid, try the options, watch the stopping."""
    from fe_drivetrain.cases.performance.solver_grid import (
        study,
    )

    return study(run, CASE)


CASE = Case(
    name="performance/solvers",
    title="Solvers side by side, what auto chooses, and when to stop",
    source="Vanek, Mandel, Brezina 1996; Meurant, Papez, Tichy 2021; measured in one run",
    run=run,
    alone=True,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
