"""NREL 750 kW low-speed shaft: which level its torsion needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Of torsion, 1 % is half a percent of a frequency; measured ones have three digits.
SCENE, QUANTITY, TOLERANCE = "nrel_750kw_low_speed_shaft", "hub.stiffness.rx", 0.01
#: K_LSS [N m/rad], to the rear face.
TORSION, TO = 3.69e7, 1.698


def run(run: Run) -> Any:
    """Climb the whole ladder, and hold the torsion of the shaft against the published one."""
    from fe_drivetrain.cases.fidelity.ladders import (
        climbed,
    )
    from fe_drivetrain.cases.fidelity.published_torsion import (
        Published,
    )

    published = Published(
        "K_LSS",
        TO,
        TORSION,
        half_digit=0.005e7,
        source="Al-Hamadani 2018, Table 4.2",
        rounding=0.5e-3,
    )
    return climbed(CASE, run, SCENE, QUANTITY, TOLERANCE, published)


CASE = Case(
    name="fidelity/nrel_750kw_low_speed_shaft",
    title="NREL 750 kW low-speed shaft: which level its torsion needs",
    source="Al-Hamadani 2018, Eq 4.4, 4.5 and Table 4.2; shape and housing assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
