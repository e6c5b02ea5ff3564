"""A scene on a page: its parts, bearings and supports, its picture, and what it costs."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from fe_drivetrain.report.pictures import NoPictureError, Picture, picture_of_model
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
    chart = None
    if result.model is not None:
        drawn = _begin_picture(run, result.model)
        chart = result.chart()
        _picture(run, page, result.model, drawn)
    if result.turning is not None:
        page.add(drivetrain_layout(LAYOUT, result.turning.machine))
        if result.turning.machine.stages:
            page.hero(LAYOUT)
    describe(page, result.described)
    if result.model is None or chart is None:
        return
    page.section("Cost")
    page.table(
        "What each level costs: unknowns of its largest system, time, memory",
        result.tables["levels"],
    )
    page.add(chart)
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


def _begin_picture(run: Run, model: Model) -> Picture | NoPictureError:
    """Begin to draw the model, beside what comes next; why not, where nothing can be drawn."""
    with run.step("picture"):
        try:
            return picture_of_model(model, run.folder / "model.png")
        except NoPictureError as reason:
            return reason


def _picture(run: Run, page: Page, model: Model, drawn: Picture | NoPictureError) -> None:
    """Show the model."""
    if isinstance(drawn, NoPictureError):
        page.text(f"No picture: {drawn}")
        return
    with run.step("picture"):
        drawn.wait()
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
