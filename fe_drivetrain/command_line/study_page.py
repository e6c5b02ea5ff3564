"""A study of a scene on a page: K_R, reactions over load histories, and beams against FE."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.command_line.scene_page import describe
from fe_drivetrain.command_line.study_files import (
    STATISTICS,
    STIFFNESS,
    write_reactions,
    write_statistics,
    write_stiffness,
)
from fe_drivetrain.command_line.study_reactions import show_reactions
from fe_drivetrain.elasticity.mesh.files import write
from fe_drivetrain.export.formats.summary import summary, write_summary
from fe_drivetrain.pages.uncertainty import bands, inputs
from fe_drivetrain.pages.uncertainty import slopes as slopes_section
from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.pictures import NoPictureError, picture_of_model
from fe_drivetrain.report.solid_view import deformed_shape
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.fidelity.judgement import Judgement
from fe_drivetrain.shafts.fidelity.over_loads import COARSER_ASSEMBLY, Levels
from fe_drivetrain.shafts.fidelity.quantities import unit_numbers
from fe_drivetrain.shafts.fidelity.shaft_bands import COARSER
from fe_drivetrain.studies.level_errors import ENOUGH
from fe_drivetrain.studies.scene_study import ASSEMBLY, StudyResult
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory


def show_study(
    run: Run, page: Page, result: StudyResult, histories: Sequence[LoadHistory] = ()
) -> None:
    """Show the study of a scene, and write its files.

    Parameters
    ----------
    run : Run
        Its folder takes pictures, CSV files, stiffnesses, summary and mesh.
    page : Page
        Takes tables and charts.
    result : StudyResult
        What was found.
    histories : sequence of LoadHistory
        Load histories whose reactions are written over time.
    """
    page.section("Scene")
    _pictures(run, page, result)
    describe(page, result.described)
    if result.units:
        page.section("Stiffness of the bearing units")
        _stiffness(page, result)
    page.section("Reactions")
    show_reactions(page, result)
    page.section("Beams against FE")
    _errors(page, result)
    page.section("Over time")
    _series(page, result)
    if result.uncertainty is not None:
        spreads = result.uncertainty
        page.sections += [bands(spreads), inputs(spreads), slopes_section(spreads)]
    with run.step("files"):
        _files(run, page, result, histories)


def _pictures(run: Run, page: Page, result: StudyResult) -> None:
    model, mean = result.model, result.loads.mean
    weights = " and all weights" if mean[8] else ""
    with run.step("pictures"):
        try:
            picture_of_model(model, run.folder / "model.png")
            shape = deformed_shape(
                model, result.response, mean, run.folder, f"the mean load{weights}"
            )
        except NoPictureError as reason:
            page.text(f"No picture: {reason}")
            return
    page.image(f"{model.scene.title}: parts, loads and supports", "model.png")
    page.add(shape)


def _stiffness(page: Page, result: StudyResult) -> None:
    """K_R and the other stiffnesses of each unit between two bounds."""
    page.table(
        "Bearing, housing and bedplate without the shaft: the shaft keeps the face between them in "
        "shape, but not wholly, so that the truth is between two bounds (equal where the joint "
        "itself says how its faces move). The mesh makes both too stiff by up to the last column. "
        "Force over motion, all other loads zero",
        result.tables["unit_stiffness"],
    )
    free = {name: unit_numbers(bounds.stiff) for name, bounds in result.units.items()}
    aligning = [name for name, of in free.items() if of["tilt"] == of["yaw"] == 0.0]
    floating = [name for name, of in free.items() if of["axial"] == 0.0]
    if aligning:
        page.text(f"No K_R of {', '.join(aligning)}: the bearing gives way to tilt.")
    if floating:
        page.text(
            f"No axial stiffness of {', '.join(floating)}: the bearing floats, and leaves axial "
            "force to the others at every level."
        )
    if result.secants:
        page.table(
            "K_R in the drivetrain, as a secant over load steps without the weight of shaft, "
            "bearings and housings, and that of the unit alone",
            result.tables["secants"],
        )
        for one in result.secants:
            page.text(f"{one.bearing}: {one.statement}.")


def _errors(page: Page, result: StudyResult) -> None:
    """RMSE of each level against the assembly, and the cheapest level that is enough."""
    levels, tables = result.levels, result.tables
    page.table(
        "Error of each reaction as a vector over all load steps: root mean square of the "
        "difference to the assembly over that of the assembly's [%]",
        tables["error_percent"],
    )
    page.add(result.chart())
    page.table("RMSE of each component against the assembly over all load steps", tables["rmse_kN"])
    page.text(_notes(levels, result.judgement))
    page.table(
        f"The cheapest level that has each reaction within {100 * ENOUGH:g} % over these loads"
        + (", for either bound of the housings" if levels.units else ""),
        tables["advice"],
    )
    page.text(
        "'fe-drivetrain advise' answers for one quantity and another tolerance, ranks the details "
        "of the scene, and says what each level takes."
    )
    counted, count = result.measures.histories, len(result.loads.histories)
    of_all = "" if counted == count else f" in {counted} of the {count} histories"
    worse = ", the worse of both bounds of the housings" if levels.units else ""
    page.table(
        f"Error of each level by what a part is designed for{of_all}: the component across the "
        f"shaft that varies most{worse}. Mean and load duration "
        "over the mean size; extreme, and damage-equivalent load (DEL), over the assembly's",
        tables["design_measures"],
    )
    if result.closed_forms:
        page.table(
            "Closed forms of one bearing on a uniform shaft (Stirling 2023, Eq 3.1, 3.18 and 3.19) "
            "with K_R of the table above, against the assembly without the weight of shaft, "
            "bearing and housing, which they do not have: resultant radial force on the bearing, "
            "means over the histories. Mean error: |F_beam - F_FE| / |F_FE|; samples with a "
            "reference below 0.1 % of its root mean square are left out",
            tables["closed_forms"],
        )


def _notes(levels: Levels, judgement: Judgement) -> str:
    """Notes on the tables: bounds, what the mesh does, and what does not decide."""
    notes = []
    if levels.units:
        notes.append("Stiff and soft housings are the two bounds of the bearing units.")
    if COARSER_ASSEMBLY in levels.models:
        notes.append(
            f"The assembly on a mesh {COARSER:g} times coarser shows what the mesh does to the "
            "reference: differences as small as that are not errors of a beam."
        )
    else:
        notes.append(f"The mesh cannot be {COARSER:g} times coarser: its own error is not shown.")
    if judgement.slight:
        slight = "; ".join(q.words(judgement.largest[q.kind]) for q in judgement.slight)
        notes.append(f"Too small beside the largest of their kind to judge a level by: {slight}.")
    notes.append("Forces and moments that are the mesh's noise are left out.")
    return " ".join(notes)


def _series(page: Page, result: StudyResult) -> None:
    """The beginning of the middle history: radial force of each bearing, FE and beams."""
    levels, shown = result.levels, result.loads.beginning
    (*_, beams) = [models for level, models in levels.bounds.items() if level.startswith("1")]
    labels = [ASSEMBLY, *beams]
    found = {label: result.reactions(shown.loads, label) for label in labels}
    with_weights = " with all weights" if result.loads.gravity else ""
    for name in result.model.scene.bearing_names:
        traces = []
        for label, dash in zip(labels, ("solid", "dash", "dot"), strict=False):
            reaction = found[label][name]
            force = np.hypot(reaction[:, 1], reaction[:, 2]) / 1e3
            traces.append(trace(label, shown.time, force, line={"dash": dash}))
        page.chart(
            f"Radial force on {name}{with_weights}: the beginning of {shown.name}",
            traces,
            "time [s]",
            "radial force [kN]",
        )


def _files(run: Run, page: Page, result: StudyResult, histories: Sequence[LoadHistory]) -> None:
    """Exports beside the page, and a list of them."""
    model = result.model
    write_statistics(run.folder / STATISTICS, result)
    files = {STATISTICS: "reactions of each history: statistics, bands, equivalent loads"}
    if histories:
        write_reactions(run.folder, result, histories)
        files["reactions_*.csv"] = "reactions over time"
    if result.units:
        write_stiffness(run.folder / STIFFNESS, result)
        files[STIFFNESS] = "6x6 stiffness of each bearing unit, two bounds"
    write_summary(run.folder / "summary.json", summary(model.scene, 2))
    files["summary.json"] = "shaft, bearing units, reactions, masses of a drivetrain model"
    fields = {
        f"displacement {load}": result.response.displacements[:, :, k]
        for k, load in enumerate(model.loads)
    }
    write(model.mesh, run.folder / "mesh.vtu", fields)
    files["mesh.vtu"] = "the assembly with its unit-load displacements, for ParaView"
    page.section("Files")
    page.table(
        "Files of this study",
        [{"file": name, "content": content} for name, content in files.items()],
    )
    page.text("'fe-drivetrain export' writes the model for other programs.")
