"""Stress concentration of a shoulder fillet in bending, against the published fits."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run


def run(run: Run) -> Any:
    """Sweep the step and the fillet."""
    from fe_drivetrain.cases.verification import fillets

    return fillets.against_two_fits(run, CASE, "bending")


CASE = Case(
    name="verification/fillet_bending",
    title="Shoulder fillet of a shaft in bending: stress concentration",
    source="Pilkey and Pilkey 2008, Peterson's Stress Concentration Factors, chart 3.10; "
    "Tipton, Sorem and Rolovic 1996",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
