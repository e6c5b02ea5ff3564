"""Two main bearings: which level the rear one's force needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

SCENE, QUANTITY, TOLERANCE = "two_bearings", "rear.Fz", 0.1


def run(run: Run) -> Any:
    """Climb the whole ladder."""
    from fe_drivetrain.cases.fidelity.ladders import (
        climbed,
    )

    return climbed(CASE, run, SCENE, QUANTITY, TOLERANCE)


CASE = Case(
    name="fidelity/two_bearings",
    title="Two main bearings: which level the rear one's force needs",
    source="four-point suspension in 2 MW size, assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
