"""The elastic operator beside scikit-fem's generic form: same matrix, other time."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run


def run(run: Run) -> Any:
    """Assemble every element kind both ways, and the shaft of 110 000 unknowns."""
    from fe_drivetrain.cases.performance.assembly import (
        study,
    )

    return study(run, CASE)


CASE = Case(
    name="performance/operator",
    title="The elastic operator against scikit-fem's generic assembly",
    source="scikit-fem (Gustafsson, McBain 2020), measured in one run",
    run=run,
    alone=True,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
