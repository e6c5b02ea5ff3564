"""Files of an export beside its page: the shaft in every format that can hold it."""

from __future__ import annotations

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export import write_superelement
from fe_drivetrain.export.files import FORMATS
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.export_content import ExportResult


def write_shaft(run: Run, page: Page, result: ExportResult) -> None:
    """Write a condensed part in each format that needs no extra, and list the files.

    Parameters
    ----------
    run : Run
        Its folder takes the files.
    page : Page
        Takes the list, and which formats cannot hold the part, with the reason.
    result : ExportResult
        A part condensed to points.
    """
    element = result.content
    assert isinstance(element, Superelement)
    rows = []
    with run.step("files"):
        for one in FORMATS.values():
            file = f"{element.name}-{one.name}{one.suffix}"
            if one.extra:
                continue
            try:
                write_superelement(run.folder / file, element, one.name)
            except InputError as error:
                rows.append({"file": "", "format": one.name, "read by": f"not written: {error}"})
                continue
            rows.append({"file": file, "format": one.name, "read by": one.reader})
    page.section("Files")
    page.table("The condensed part, in each format that needs no extra", rows)
