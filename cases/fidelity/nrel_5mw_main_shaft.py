"""NREL 5 MW main shaft: which level the downwind bearing's force needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: 5 % of a bearing's force is 17 % of its life (exponent 10/3).
SCENE, QUANTITY, TOLERANCE = "nrel_5mw_main_shaft", "downwind.Fz", 0.05


def run(run: Run) -> Any:
    """Climb the whole ladder."""
    from fe_drivetrain.cases.fidelity.ladders import (
        climbed,
    )

    return climbed(CASE, run, SCENE, QUANTITY, TOLERANCE)


CASE = Case(
    name="fidelity/nrel_5mw_main_shaft",
    title="NREL 5 MW main shaft: which level the downwind bearing's force needs",
    source="WISDEM, nrel5mw.yaml; Jonkman et al. 2009, NREL/TP-500-38060",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
