"""Stress concentration of a shoulder fillet in tension, against the published fits."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run


def run(run: Run) -> Any:
    """Sweep the step and the fillet."""
    from fe_drivetrain.cases.verification import fillets

    return fillets.against_two_fits(run, CASE, "tension")


CASE = Case(
    name="verification/fillet_tension",
    title="Shoulder fillet of a shaft in tension: stress concentration",
    source="Pilkey and Pilkey 2008, Peterson's Stress Concentration Factors, chart 3.4; Tipton "
    "et al. 1996",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
