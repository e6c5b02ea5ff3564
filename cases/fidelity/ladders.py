"""What the cases of the ladder share: a library scene, climbed to its top."""

from __future__ import annotations

from fe_drivetrain.advice_page import advised
from fe_drivetrain.adviser import Quantity
from fe_drivetrain.case import Case, Run
from fe_drivetrain.results import Results
from fe_drivetrain.scene import change_scene, library_scene

#: Coarsening of the mesh under --quick.
QUICK = 1.4


def climbed(case: Case, run: Run, name: str, quantity: str, tolerance: float) -> Results:
    """All levels of a library scene, with the user's changes to it."""
    scene = change_scene(library_scene(name), run.settings)
    if run.quick:
        scene = scene.model_copy(update={"mesh": scene.mesh.scaled(QUICK)})
    return advised(case, run, scene, Quantity(quantity), tolerance, to_the_top=True)
