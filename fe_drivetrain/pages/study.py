"""A study of a scene on a page: K_R, reactions over load histories, and beams against FE."""

from __future__ import annotations

from fe_drivetrain.pages.check import describe
from fe_drivetrain.pages.study_reactions import reaction_sections
from fe_drivetrain.pages.uncertainty import bands, inputs
from fe_drivetrain.pages.uncertainty import slopes as slopes_section
from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.solid_view import model_pictures
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.fidelity.judgement import Judgement
from fe_drivetrain.shafts.fidelity.over_loads import COARSER_ASSEMBLY, Levels
from fe_drivetrain.shafts.fidelity.shaft_bands import COARSER
from fe_drivetrain.studies.level_errors import ENOUGH
from fe_drivetrain.studies.scene_study import StudyResult

_DASHES = ("solid", "dash", "dot")


def show_study(run: Run, page: Page, result: StudyResult) -> None:
    """Show the study of a scene.

    Parameters
    ----------
    run : Run
        Its folder takes the pictures.
    page : Page
        Takes tables and charts.
    result : StudyResult
        What was found.
    """
    page.section("Scene")
    _pictures(run, page, result)
    describe(page, result.described)
    if result.units:
        page.section("Stiffness of the bearing units")
        _stiffness(page, result)
    page.section("Reactions")
    reaction_sections(page, result)
    page.section("Beams against FE")
    _errors(page, result)
    page.section("Over time")
    _over_time(page, result)
    if result.uncertainty is not None:
        spreads = result.uncertainty
        page.sections += [bands(spreads), inputs(spreads), slopes_section(spreads)]


def _pictures(run: Run, page: Page, result: StudyResult) -> None:
    model, mean = result.model, result.loads.mean
    weights = " and all weights" if mean[8] else ""
    with run.step("pictures"):
        what = f"the mean load{weights}"
        page.add(*model_pictures(model, result.response, mean, run.folder, what))


def _stiffness(page: Page, result: StudyResult) -> None:
    """K_R and the other stiffnesses of each unit between two bounds."""
    page.table(
        "Stiffness of bearing, housing and bedplate together, without the shaft: force over "
        "motion, all other loads zero. The shaft holds the face where they meet in shape only in "
        "part. The true stiffness is therefore between two bounds: the face is free to deform and "
        "its average motion counts (soft), or it stays rigid (stiff). Both are equal where the "
        "joint itself prescribes how the face moves. The mesh makes both too stiff, by at most the "
        "last column",
        result.tables["unit_stiffness"],
    )
    if result.aligning:
        page.text(f"No K_R of {', '.join(result.aligning)}: the bearing gives way to tilt.")
    if result.floating:
        page.text(
            f"No axial stiffness of {', '.join(result.floating)}: the bearing floats, and leaves "
            "axial force to the others at every level."
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


def _over_time(page: Page, result: StudyResult) -> None:
    """The beginning of the middle history: radial force of each bearing, FE and beams."""
    shown = result.beginning
    with_weights = " with all weights" if result.loads.gravity else ""
    captions = {
        name: f"Radial force on {name}{with_weights}: the beginning of {shown.name}"
        for name in shown.radial_forces
    }
    if len(shown.time) > 1:
        page.hero(captions[max(captions, key=result.peak_across)])
    for name, forces in shown.radial_forces.items():
        page.chart(
            captions[name],
            [
                trace(model, shown.time, force / 1e3, line={"dash": dash})
                for (model, force), dash in zip(forces.items(), _DASHES, strict=False)
            ],
            "time [s]",
            "radial force [kN]",
        )
