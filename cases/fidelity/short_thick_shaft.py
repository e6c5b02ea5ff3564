"""Short thick shaft: which level its bearing's moment needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

SCENE, QUANTITY, TOLERANCE = "short_thick_shaft", "main_bearing.My", 0.1


def run(run: Run) -> Any:
    """Climb the whole ladder."""
    from fe_drivetrain.cases.fidelity.ladders import (
        climbed,
    )

    return climbed(CASE, run, SCENE, QUANTITY, TOLERANCE)


CASE = Case(
    name="fidelity/short_thick_shaft",
    title="Short thick shaft: which level its bearing's moment needs",
    source="all dimensions assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
