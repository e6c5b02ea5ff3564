"""A housing on a flexible bedplate: which level the main bearing's tilting moment needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

SCENE, QUANTITY, TOLERANCE = "housing_on_bedplate", "main_bearing.My", 0.1


def run(run: Run) -> Any:
    """Climb the whole ladder."""
    from fe_drivetrain.cases.fidelity.ladders import (
        climbed,
    )

    return climbed(CASE, run, SCENE, QUANTITY, TOLERANCE)


CASE = Case(
    name="fidelity/housing_on_bedplate",
    title="A housing on a flexible bedplate: which level the main bearing's moment needs",
    source="Stirling 2023, Table 3.1 (shaft); bedplate assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
