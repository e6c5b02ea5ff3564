"""Uncertain values of the bonded main bearing: cheap sensitivities against the assembly's own."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

SCENE = "main_bearing_bonded_uncertain"


def run(run: Run) -> Any:
    """Sensitivities of the beam level, of the assembly by its energy, and by differences."""
    from fe_drivetrain.cases.fidelity.top_slopes import (
        compared,
    )

    return compared(CASE, run, SCENE)


CASE = Case(
    name="fidelity/uncertain_stiffness",
    title="Uncertain values: sensitivities of the cheap level against the assembly's",
    source="Stirling 2023, Table 3.1; spreads: ISO 286-1, ISO 8062-3, JCSS 2001, some assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
