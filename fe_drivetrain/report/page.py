"""The page of a result folder: one HTML file, made from results.json and the images beside it.

Every string of the results is data: it is escaped, whatever it says.
"""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path

from markupsafe import Markup, escape

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.report.chart_style import chart_height, figure_as_json, is_number
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.rendering import policy_hash, read_template, templates
from fe_drivetrain.report.results import Cell, Chart, Image, Results, Table, read_results

_PNG = b"\x89PNG\r\n\x1a\n"
_CONTENTS_FROM = 5  # sections from which on a page has a table of contents


def write_page(folder: Path, shared: Path | None = None) -> Path:
    """Write the page of a result folder.

    Parameters
    ----------
    folder : Path
        Holds results.json and the images that it names.
    shared : Path or None
        A folder above for what the pages of several cases share: the history of their runs. That
        of the page itself where left out.

    Returns
    -------
    page
        Path of report.html in the same folder.

    Raises
    ------
    InputError
        An image that results.json names is not there, is no PNG, or lies elsewhere.
    """
    folder = Path(folder)
    page = folder / "report.html"
    text = render(read_results(folder / "results.json"), folder, shared or folder)
    page.write_text(text, encoding="utf-8")
    return page


def render(results: Results, folder: Path, shared: Path) -> str:
    """The page as text; see `write_page`."""
    charts = [i for s in results.sections for i in s.items if isinstance(i, Chart)]
    scripts = []
    if charts:
        from plotly.offline import get_plotlyjs

        scripts = [get_plotlyjs(), read_template("charts.js")]
    environment = templates()
    environment.filters |= {
        "number": is_number,
        "figure": figure_as_json,
        "unit_unbroken": _unit_unbroken,
        "numeric_columns": _numeric_columns,
        "in_column": _in_column,
        "height": chart_height,
        "as_given": lambda settings: [(k, escape(_as_given(v))) for k, v in settings.items()],
        "data_url": lambda image: _as_data_url(image, folder),
    }
    passed = sum(verdict.passed for verdict in results.verdicts)
    return environment.get_template("report.html").render(
        results=results,
        passed=passed,
        contents=len(results.sections) + 4 >= _CONTENTS_FROM,
        scripts=[Markup(script) for script in scripts],
        script_hashes=[policy_hash(script) for script in scripts],
    )


def _as_given(value: object) -> str:
    """A setting of the run, exactly."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _unit_unbroken(heading: str) -> str:
    """A heading whose unit, in brackets, stays on one line."""
    return re.sub(r"\[[^\]]*\]", lambda unit: unit.group().replace(" ", "\u00a0"), heading)


def _numeric_columns(table: Table) -> set[int]:
    """Which columns hold numbers, and perhaps gaps, but nothing else."""
    columns = list(zip(*table.rows, strict=False))
    return {
        number
        for number, cells in enumerate(columns)
        if any(map(is_number, cells)) and all(c is None or is_number(c) for c in cells)
    }


def _in_column(value: Cell, heading: str) -> str:
    """A cell: of percentages and pure numbers, which the heading says, with any power of ten."""
    unit = next((unit for unit in ("%", "-") if heading.endswith(f"[{unit}]")), None)
    return formatted(value, unit=unit)


def _as_data_url(image: Image, folder: Path) -> Markup:
    """A PNG of the folder, embedded; Markup, for its letters and digits are no numbers to set."""
    path = folder / image.file
    if Path(image.file).name != image.file or not path.is_file() or path.is_symlink():
        raise InputError(f"image {image.file!r} of results.json is not a file in {folder}")
    content = path.read_bytes()
    if not content.startswith(_PNG):
        raise InputError(f"image {image.file!r} of results.json is no PNG: write it as one")
    return Markup(f"data:image/png;base64,{base64.b64encode(content).decode()}")
