"""Stepped gearbox shaft: which level the hub's stiffness needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: 10 % of a stiffness is 5 % of a frequency.
SCENE, QUANTITY, TOLERANCE = "stepped_shaft", "hub.stiffness.uz", 0.1


def run(run: Run) -> Any:
    """Climb the whole ladder."""
    from fe_drivetrain.cases.fidelity.ladders import (
        climbed,
    )

    return climbed(CASE, run, SCENE, QUANTITY, TOLERANCE)


CASE = Case(
    name="fidelity/stepped_shaft",
    title="Stepped gearbox shaft: which level the hub's stiffness needs",
    source="all dimensions assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
