"""What the cases of the ladder share: a library scene, climbed to its top, and its stiffness."""

from __future__ import annotations

from fe_drivetrain.cases.fidelity.published_torsion import (
    Published,
    beside_published,
)
from fe_drivetrain.cases.fidelity.stiffness_files import (
    stiffness_files,
)
from fe_drivetrain.commands import advised
from fe_drivetrain.fidelity import Quantity
from fe_drivetrain.report import Results
from fe_drivetrain.scene import change_scene, library_scene
from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: Coarsening of the mesh under --quick.
QUICK = 1.4


def climbed(
    case: Case,
    run: Run,
    name: str,
    quantity: str,
    tolerance: float,
    published: Published | None = None,
) -> Results:
    """All levels of a library scene with the user's changes to it, and its stiffness in files.

    Parameters
    ----------
    case, run
        Whose results these are.
    name
        Of the scene.
    quantity, tolerance
        See `fe_drivetrain.fidelity.adviser`.
    published
        What the shaft's torsion is held against, as long as shaft and materials are the library's.
    """
    original = library_scene(name)
    scene = change_scene(original, run.settings)
    if run.quick:
        scene = scene.model_copy(update={"mesh": scene.mesh.scaled(QUICK)})
    results = advised(case, run, scene, Quantity(quantity), tolerance, to_the_top=True)
    with run.step("stiffness for other models"):
        section, verdicts = stiffness_files(run.folder, scene, Quantity(quantity), results)
    sections, summary = [*results.sections, section], list(results.summary)
    verdicts = [*results.verdicts, *verdicts]
    same = (scene.shaft, scene.materials) == (original.shaft, original.materials)
    if published is not None and same:
        with run.step("torsion beside the published figure"):
            section, said, judged = beside_published(scene, published)
        sections.append(section)
        summary.append(said)
        verdicts += judged
    update = {"sections": sections, "verdicts": verdicts, "summary": summary, "times": run.times}
    return results.model_copy(update=update)
