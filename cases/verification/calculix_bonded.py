"""The bonded main bearing by CalculiX, on the deck that `fe-drivetrain export` writes."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Coarsening of the library's mesh: both programs solve the same equations on any mesh.
FACTOR, QUICK_FACTOR = 2.0, 4.0


def run(run: Run) -> Any:
    """Write the deck, solve it twice, compare."""
    from fe_drivetrain.cases.verification import (
        calculix_decks as decks,
    )
    from fe_drivetrain.export import find_calculix
    from fe_drivetrain.response import mesh_scene

    find_calculix()
    scene = decks.scene_of("bonded", QUICK_FACTOR if run.quick else FACTOR)
    with run.step("mesh"):
        mesh = mesh_scene(scene)
    found = [decks.compare(run, scene, "bonded", mesh)]
    worst = max(float(v.max()) for v in found[0].differences.values())
    usual = float(found[0].usual["displacements of all nodes"].max())
    return CASE.results(
        run,
        summary=[
            "CalculiX and this project agree on displacements, reactions and strain energy of the "
            f"bonded main bearing to {worst:.1e} under each unit load: the digits that "
            "CalculiX prints.",
            "With this project's usual integration of curved elements displacements differ by "
            f"{usual:.1e} on this coarse mesh.",
        ],
        verdicts=decks.verdicts(found),
        sections=decks.sections(found),
        figures={one.label: {q: v.tolist() for q, v in one.differences.items()} for one in found},
    )


CASE = Case(
    name="verification/calculix_bonded",
    title="Bonded main bearing: CalculiX on the exported deck",
    source="CalculiX (Dhondt 2004, The Finite Element Method for Three-Dimensional "
    "Thermomechanical Applications), run here",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
