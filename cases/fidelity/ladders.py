"""Library scenes at all their model levels, and their stiffness in files."""

from dataclasses import replace
from typing import Any

from fe_drivetrain.cases import cases
from fe_drivetrain.cases.fidelity.ladder_answers import answer
from fe_drivetrain.cases.fidelity.published_torsion import Published, beside_published
from fe_drivetrain.cases.fidelity.stiffness_files import stiffness_files
from fe_drivetrain.drivetrain_file import change_scene, coarser_scene, library_scene
from fe_drivetrain.pages import QUICK_BAND, show_advise
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.fidelity import Quantity
from fe_drivetrain.studies import advise

#: The mesh of a quick run: sizes times this, where the table says no other, and elements a turn.
COARSER, TURN = 2.2, 6


@cases("ladders.yaml", changes="scene")
def run(run: Run, page: Page, row: Record) -> None:
    """All levels of a library scene with the user's changes to it, and its stiffness in files."""
    original = library_scene(row["scene"])
    finer = {} if run.quick else {f"mesh.{key}": size for key, size in row.get("mesh", {}).items()}
    scene = change_scene(original, finer | dict(run.settings))
    if run.quick:
        scene = coarser_scene(scene, row.get("coarser", COARSER), TURN)
    page.about(scene)
    result = advise(scene, row["quantity"], row["tolerance"], to_the_top=True, report=run.report)
    if run.quick:
        result = replace(result, checks=(), details=(*result.details, QUICK_BAND))
    run.take(result)
    page.take(result)
    show_advise(run, page, result)
    with run.step("stiffness for other models"):
        stiffness_files(page, run.folder, scene, Quantity(row["quantity"]))
    published: dict[str, Any] | None = row.get("published")
    torsion = None
    # the source describes the library's shaft, not one that the user changed
    if published and (scene.shaft, scene.materials) == (original.shaft, original.materials):
        with run.step("torsion beside the published figure"):
            torsion = beside_published(page, scene, Published(**published))
    answer(page, result, row, torsion, run.quick)
