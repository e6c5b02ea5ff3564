"""IEA 15 MW main shaft: which level the hub's tilt needs."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: A tenth of what the tilt takes from the generator's air gap.
SCENE, QUANTITY, TOLERANCE = "iea_15mw_main_shaft", "hub.stiffness.ry", 0.1
#: DTTorSpr of the OpenFAST model [N m/rad], from the front face to the second bearing.
TORSION, TO = 69_737_644_900.0, 1.2


def run(run: Run) -> Any:
    """Climb the whole ladder, and hold the torsion of the shaft against the published one."""
    from fe_drivetrain.cases.fidelity.ladders import (
        climbed,
    )
    from fe_drivetrain.cases.fidelity.published_torsion import (
        Published,
    )

    published = Published(
        "DTTorSpr", TO, TORSION, half_digit=50.0, source="IEA-15-240-RWT, OpenFAST model"
    )
    return climbed(CASE, run, SCENE, QUANTITY, TOLERANCE, published)


CASE = Case(
    name="fidelity/iea_15mw_main_shaft",
    title="IEA 15 MW main shaft: which level the hub's tilt needs",
    source="IEA-15-240-RWT (Gaertner et al. 2020, NREL/TP-5000-75698)",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
