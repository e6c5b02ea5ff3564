"""Files of a study: reactions as CSV, stiffnesses and summary as JSON, the mesh for ParaView."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.csv_cells import SafeWriter, comment_line, table_row
from fe_drivetrain.elasticity.mesh.files import write as write_mesh
from fe_drivetrain.export.formats.stiffness_file import stiffness_matrix, write_stiffness_json
from fe_drivetrain.export.formats.summary import SummaryFile, write_summary
from fe_drivetrain.pages.study_reactions import STATISTICS
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.export_content import prepare_export
from fe_drivetrain.studies.load_facts import channels_of
from fe_drivetrain.studies.scene_study import StudyResult
from fe_drivetrain.turbine_loads.histories.cycles import RULE
from fe_drivetrain.turbine_loads.histories.damage import FREQUENCY
from fe_drivetrain.turbine_loads.histories.windows import COLUMNS
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory

_STIFFNESS, _SUMMARY, _MESH = "stiffness.json", "summary.json", "mesh.vtu"
_UNITS = 3 * ("N",) + 3 * ("N m",)


def write_study(
    run: Run, page: Page, result: StudyResult, histories: Sequence[LoadHistory] = ()
) -> None:
    """Write all files of a study, and list them on its page.

    Parameters
    ----------
    run : Run
        Its folder takes the files.
    page : Page
        Takes the list.
    result : StudyResult
        What was found.
    histories : sequence of LoadHistory
        Load histories whose reactions are written over time.
    """
    folder = run.folder
    with run.step("files"):
        files = {STATISTICS: "reactions of each history: statistics, bands, equivalent loads"}
        write_statistics(folder / STATISTICS, result)
        if histories:
            files["reactions_*.csv"] = "reactions over time"
            write_reactions(folder, result, histories)
        if result.units:
            files[_STIFFNESS] = "6x6 stiffness of each bearing unit, two bounds"
            write_stiffness(folder / _STIFFNESS, result)
        files[_SUMMARY] = "shaft, bearing units, reactions, masses of a drivetrain model"
        _write_summary(folder / _SUMMARY, result)
        files[_MESH] = "the assembly with its unit-load displacements, for ParaView"
        _write_mesh(folder / _MESH, result)
    page.section("Files")
    page.table(
        "Files of this study",
        [{"file": name, "content": content} for name, content in files.items()],
    )
    page.text("'fe-drivetrain export' writes the model for other programs.")


def _write_summary(path: Path, result: StudyResult) -> None:
    content = prepare_export(result.model.scene, "summary", level=2).content
    assert isinstance(content, SummaryFile)
    write_summary(path, content)


def _write_mesh(path: Path, result: StudyResult) -> None:
    displacements = result.response.displacements
    fields = {
        f"displacement {load}": displacements[:, :, k] for k, load in enumerate(result.model.loads)
    }
    write_mesh(result.model.mesh, path, fields)


def write_statistics(path: Path, result: StudyResult) -> None:
    """Statistics of every reaction, over all histories and over each, as CSV.

    Parameters
    ----------
    path : Path
        The file.
    result : StudyResult
        What was found.
    """
    facts = {
        **result.stated.facts(),
        "loads": result.loads.statement,
        "DEL": f"range of a sine of {FREQUENCY:g} Hz with the same damage; {RULE}",
        "mesh band": "by how much the mesh may change min, mean, max or standard deviation",
    }
    histories = result.loads.histories
    if result.loads.own:
        facts |= {f"channels of {history.name}": history.channels for history in histories}
    with path.open("w", encoding="utf-8", newline="") as file:
        table = SafeWriter(file)
        table.comments(f"{fact} = {value}" for fact, value in facts.items())
        columns = ["history", "reaction", "component", "unit", *COLUMNS, "mesh band"]
        table.writerow([*columns, *(f"DEL m={m:g}" for m in result.slopes)])
        for name, of in result.reaction_statistics.items():
            whole = ("all", of.whole)
            each = zip((h.name for h in histories), of.by_history, strict=True)
            for history, one in (whole, *each):
                for c, (component, unit) in enumerate(zip(FORCES, _UNITS, strict=True)):
                    band = "" if one.band is None else f"{one.band[c]:.9g}"
                    numbers = [f"{v:.9g}" for v in one.values[c]]
                    equivalent = [f"{v:.9g}" for v in one.equivalent[c]]
                    table.writerow([history, name, component, unit, *numbers, band, *equivalent])


def write_reactions(folder: Path, result: StudyResult, histories: Sequence[LoadHistory]) -> None:
    """Every reaction of the assembly over time as CSV, a file for each history.

    Parameters
    ----------
    folder : Path
        Takes reactions_NAME.csv.
    result : StudyResult
        What was found.
    histories : sequence of LoadHistory
        The load histories.
    """
    columns = ["time [s]"]
    columns += [
        f"{name} {component} [{unit}]"
        for name in result.reaction_statistics
        for component, unit in zip(FORCES, _UNITS, strict=True)
    ]
    for history in histories:
        facts = {
            "history": history.name,
            **result.stated.facts(),
            "model": "the assembly of solids",
            "channels": channels_of(history),
        }
        values = list(result.reactions(history).values())
        np.savetxt(
            folder / f"reactions_{history.name}.csv",
            np.column_stack([history.time, *values]),
            delimiter=",",
            fmt="%.9g",
            header="\n".join(
                [*(comment_line(f"{f} = {v}") for f, v in facts.items()), table_row(columns)]
            ),
            comments="",
            encoding="utf-8",
        )


def write_stiffness(path: Path, result: StudyResult) -> None:
    """The 6x6 stiffness of each bearing unit, its two bounds, as JSON.

    Parameters
    ----------
    path : Path
        The file.
    result : StudyResult
        What was found.
    """
    write_stiffness_json(
        path,
        result.model.scene.title,
        [
            stiffness_matrix(
                f"{name}, {bound}",
                matrix,
                result.response.positions[name],
                "bearing, housing and bedplate in series at the bearing's centre",
            )
            for bound in ("stiff", "soft")
            for name, matrix in ((n, getattr(unit, bound)) for n, unit in result.units.items())
        ],
        result.response.diagnostics.n_unknowns,
    )
