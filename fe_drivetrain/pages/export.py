"""What other programs can take of a drivetrain, on a page: a part in matrices, parts, formats."""

from __future__ import annotations

from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.export.turning_files import format_rows
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.export_content import ExportResult

_MATRICES = "fe-drivetrain export FILE --format json --what {} --out {}.json"


def show_export(run: Run, page: Page, result: ExportResult) -> None:
    """Show what is condensed, which other parts can be, and in which formats.

    Parameters
    ----------
    run : Run
        The run.
    page : Page
        Takes tables and charts.
    result : ExportResult
        What was condensed.
    """
    drawn = result.chart()
    page.section("Condensed")
    page.add(drawn)
    page.hero(drawn.caption)
    if (points := result.tables.get("points")) is not None:
        page.table("Points that the matrices are at", points)
    if isinstance(result.drivetrain, Scene):
        page.section("What can be exported")
        page.table("Parts, and what to type; FILE is the drivetrain", choices(result.drivetrain))
    page.section("Formats")
    page.table("Formats of matrices, by the name that --format takes", format_rows())


def choices(scene: Scene) -> list[Record]:
    """What other programs can take of a scene.

    Parameters
    ----------
    scene : Scene
        A drivetrain.

    Returns
    -------
    list of dict
        What it is, its usual level, and the command that writes it.
    """
    rows = [
        ("the free shaft", "2 meridian", _MATRICES.format("shaft", "shaft")),
        ("the shaft on its supports", "2 meridian", _MATRICES.format("drivetrain", "drivetrain")),
    ]
    names = [unit.bearing.name for unit in scene.bearing_units]
    rows += [
        (f"bearing {name} with its housing", "4 assembly", _MATRICES.format(name, name))
        for name in names
    ]
    if len(names) > 1:
        rows.append(
            ("all bearings at their seats", "4 assembly", _MATRICES.format("seats", "seats"))
        )
    modes = _MATRICES.format("shaft", "modes") + " --modes 10"
    rows += [
        ("the free shaft with modes (Craig-Bampton)", "2 meridian", modes),
        ("numbers of a drivetrain model", "2 meridian", _MATRICES.format("summary", "summary")),
        ("the whole model with unit loads", "solids", "fe-drivetrain export FILE --out model.inp"),
        ("its mesh", "solids", "fe-drivetrain export FILE --out mesh.vtu"),
    ]
    if scene.rotor is not None and scene.generator is not None:
        turning = _MATRICES.format("turning", "turning")
        rows.append(("matrices of all that turns", "torsional to flexible", turning))
    return [
        {"what": what, "level": level, "command": f"`{command}`"} for what, level, command in rows
    ]
