"""Three-point suspension: which level the force into the gearbox needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: 5 % of a bearing's force is 17 % of its life (exponent 10/3).
SCENE, QUANTITY, TOLERANCE = "three_point_suspension", "gearbox.Fz", 0.05


def run(run: Run) -> Any:
    """Climb the whole ladder."""
    from fe_drivetrain.cases.fidelity.ladders import (
        climbed,
    )

    return climbed(CASE, run, SCENE, QUANTITY, TOLERANCE)


CASE = Case(
    name="fidelity/three_point_suspension",
    title="Three-point suspension: which level the force into the gearbox needs",
    source="Sethuraman, Guo and Sheng 2015 (arrangement, bearing); Stirling 2023, Table 3.1 "
    "(springs)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
