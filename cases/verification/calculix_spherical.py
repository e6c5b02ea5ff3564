"""The spherical main bearing by CalculiX, with each form of the joint as linear equations."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

FORMS = ("sliding", "averaged", "rigid")

#: Coarsening of the library's mesh: both programs solve the same equations on any mesh.
FACTOR, QUICK_FACTOR = 4.0, 4.0


def run(run: Run) -> Any:
    """Write the decks, solve each twice, compare."""
    from fe_drivetrain.cases.verification import (
        calculix_decks as decks,
    )
    from fe_drivetrain.export import find_calculix
    from fe_drivetrain.response import mesh_scene
    from fe_drivetrain.scene import change_scene

    find_calculix()
    scene = decks.scene_of("spherical", QUICK_FACTOR if run.quick else FACTOR)
    with run.step("mesh"):
        mesh = mesh_scene(scene)
    scenes = {form: change_scene(scene, {"bearing_units.0.interface": form}) for form in FORMS}
    with run.side_by_side(len(FORMS)) as jobs:
        work = [jobs.start(decks.compare, scenes[form], form, mesh) for form in FORMS]
        found = [job.result() for job in work]
    worst = {one.label: max(float(v.max()) for v in one.differences.values()) for one in found}
    return CASE.results(
        run,
        summary=[
            "CalculiX and this project agree on displacements, reactions and strain energy of the "
            "spherical main bearing, whatever the form of its joint: largest differences "
            f"{', '.join(f'{form} {value:.1e}' for form, value in worst.items())}, the digits that "
            "CalculiX prints.",
        ],
        verdicts=decks.verdicts(found),
        sections=decks.sections(found),
        figures={one.label: {q: v.tolist() for q, v in one.differences.items()} for one in found},
    )


CASE = Case(
    name="verification/calculix_spherical",
    title="Spherical main bearing: CalculiX on the exported decks, three forms of the joint",
    source="CalculiX (Dhondt 2004, The Finite Element Method for Three-Dimensional "
    "Thermomechanical Applications), run here",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
