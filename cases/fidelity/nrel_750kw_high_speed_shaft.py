"""NREL 750 kW high-speed shaft: which level its floating bearing's force needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: 5 % of a bearing's force is 17 % of its life (exponent 10/3).
SCENE, QUANTITY, TOLERANCE = "nrel_750kw_high_speed_shaft", "floating.Fz", 0.05
#: K_HSS [N m/rad], to the middle of the pinion.
TORSION, TO = 2.08e6, 0.2128


def run(run: Run) -> Any:
    """Climb the whole ladder, and hold the torsion of the shaft against the published one."""
    from fe_drivetrain.cases.fidelity.ladders import (
        climbed,
    )
    from fe_drivetrain.cases.fidelity.published_torsion import (
        Published,
    )

    published = Published(
        "K_HSS",
        TO,
        TORSION,
        half_digit=0.005e6,
        source="Al-Hamadani 2018, Table 4.2",
        rounding=0.05e-3,
    )
    return climbed(CASE, run, SCENE, QUANTITY, TOLERANCE, published)


CASE = Case(
    name="fidelity/nrel_750kw_high_speed_shaft",
    title="NREL 750 kW high-speed shaft: which level its floating bearing's force needs",
    source="Al-Hamadani 2018, Table 4.2 and section 5.2; sizes and housings assumed",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
