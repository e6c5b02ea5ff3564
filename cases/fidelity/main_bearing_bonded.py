"""Bonded main bearing: which level its moment needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

SCENE, QUANTITY, TOLERANCE = "main_bearing_bonded", "main_bearing.My", 0.1


def run(run: Run) -> Any:
    """Climb the whole ladder."""
    from fe_drivetrain.cases.fidelity.ladders import (
        climbed,
    )

    return climbed(CASE, run, SCENE, QUANTITY, TOLERANCE)


CASE = Case(
    name="fidelity/main_bearing_bonded",
    title="Bonded main bearing: which level its moment needs",
    source="Stirling 2023, Table 3.1; housing assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
