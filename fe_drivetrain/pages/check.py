"""A scene on a page: its parts, bearings and supports, its picture, and what it costs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from fe_drivetrain.report.pictures import NoPictureError, picture_of_model
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.response.model import Model
from fe_drivetrain.studies.drivetrain_layout import LAYOUT, drivetrain_layout
from fe_drivetrain.studies.scene_check import CheckResult


def show_check(run: Run, page: Page, result: CheckResult) -> None:
    """Show what a scene is, and what it costs.

    Parameters
    ----------
    run : Run
        Its folder takes the picture.
    page : Page
        Takes the tables.
    result : CheckResult
        What was found.
    """
    page.section("Drivetrain")
    if result.model is not None:
        _picture(run, page, result.model)
    if result.turning is not None:
        page.add(drivetrain_layout(LAYOUT, result.turning.machine))
        if result.turning.machine.stages:
            page.hero(LAYOUT)
    describe(page, result.described)
    if result.model is None:
        return
    page.section("Cost")
    page.table(
        "What each level costs: unknowns of its largest system, time, memory",
        result.tables["levels"],
    )
    page.add(result.chart())
    page.text(
        "Predicted times are those of the solver, fitted on two cores. Times of meshing and "
        "assembly are not in them: they stand below, and the next time a mesh comes from the "
        "cache. "
        + (
            "The level with housings as springs solves every bearing unit for two bounds; the "
            "shaft on these springs was run here. "
            if result.model.scene.bearing_units
            else "The bearings on the nose have no solids: on the same mesh, the assembly (4) "
            "gives the results of solid shaft and solid nose (3). "
        )
        + "The command advise also solves coarser meshes, for the error band of the assembly."
    )


def _picture(run: Run, page: Page, model: Model) -> None:
    """Draw the model; where nothing can be drawn, say why.

    Parameters
    ----------
    run : Run
        Its folder takes the picture.
    page : Page
        Shows it.
    model : Model
        The model.
    """
    with run.step("picture"):
        try:
            picture_of_model(model, run.folder / "model.png")
        except NoPictureError as reason:
            page.text(f"No picture: {reason}")
            return
    caption = f"{model.scene.title}: parts, loads and supports"
    page.image(caption, "model.png")
    page.hero(caption)


def describe(page: Page, described: Mapping[str, Sequence[Record]]) -> None:
    """Tables of the parts, bearings and supports of a scene.

    Parameters
    ----------
    page : Page
        Takes them.
    described : Mapping[str, Sequence[Record]]
        Tables by caption, see `fe_drivetrain.studies.scene_description.description`.
    """
    for caption, rows in described.items():
        page.table(caption, rows)
    page.text(
        "Frame: x downwind along the shaft, z up, y = z cross x. Lengths in m, forces in N, "
        "moments in N m, angles in rad."
    )
