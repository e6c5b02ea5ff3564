"""Pages as PDF and charts as pictures, by a browser of the machine that shows no window."""

from __future__ import annotations

import html
import json
import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING

from fe_drivetrain.common.errors import InputError, MissingToolError

if TYPE_CHECKING:
    from fe_drivetrain.report.results import Chart, Results

BROWSERS = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "msedge",
)
"""Names under which a browser that can print is installed."""
_SECONDS = 120
_SIZE = (1200, 720)


def browser() -> str:
    """The browser of this machine that prints.

    Raises
    ------
    MissingToolError
        There is none.
    """
    found = next(filter(None, map(shutil.which, BROWSERS)), None)
    if found is None:
        raise MissingToolError(
            "--pdf and --png need Chromium or Chrome, which is not installed here: install one (of "
            "Debian: apt install chromium), or leave the options out"
        )
    return found


def write_pdf(program: str, page: Path, target: Path) -> None:
    """Print the answer of a page and its sections, without checks, assumptions and how it was made.

    Parameters
    ----------
    program : str
        The browser, of `browser`.
    page : Path
        Its HTML file.
    target : Path
        The PDF.

    Raises
    ------
    InputError
        The browser has printed nothing.
    """
    _run(program, page, f"--print-to-pdf={target}", "--no-pdf-header-footer")
    if not target.is_file() or not target.read_bytes().startswith(b"%PDF"):
        raise InputError(f"{program} has printed no PDF of {page}: try it by hand")


def write_pictures(program: str, results: Results, folder: Path) -> list[Path]:
    """Write each chart of a page as a PNG that says in itself what it shows and where it is from.

    Parameters
    ----------
    program : str
        The browser, of `browser`.
    results : Results
        Results that the page shows.
    folder : Path
        Takes the pictures.

    Returns
    -------
    list of Path
        The pictures.
    """
    from fe_drivetrain.report.bundle import place_plotly, plotly_file
    from fe_drivetrain.report.results import Chart

    charts = [
        item for section in results.sections for item in section.items if isinstance(item, Chart)
    ]
    source = f"{results.title}; fe-drivetrain, {results.environment.date[:10]}"
    written = []
    with tempfile.TemporaryDirectory() as made:
        place_plotly(Path(made))
        for number, chart in enumerate(charts, 1):
            sheet = Path(made) / "sheet.html"
            sheet.write_text(_sheet(chart, source, plotly_file()), encoding="utf-8")
            target = folder / f"{number}-{_file_name(chart.caption)}.png"
            _run(program, sheet, f"--screenshot={target}", f"--window-size={_SIZE[0]},{_SIZE[1]}")
            if not target.is_file():
                raise InputError(
                    f"{program} has drawn no picture of {chart.caption!r}: leave --png out"
                )
            written.append(target)
    return written


def _sheet(chart: Chart, source: str, plotly: str) -> str:
    """A page with one chart, its title and its source."""
    from fe_drivetrain.report.chart_style import figure_as_json

    figure = figure_as_json(chart)
    return (
        "<!DOCTYPE html><meta charset='utf-8'><style>body{margin:16px;font-family:sans-serif;"
        "background:white}h1{font-size:20px;margin:4px 0}p{color:#52606d;font-size:14px}</style>"
        f"<h1>{html.escape(chart.caption)}</h1><div id='c'></div><p>{html.escape(source)}</p>"
        f"<script src='{plotly}'></script><script>const f={figure};"
        f"Object.assign(f.layout,{json.dumps({'width': _SIZE[0] - 40, 'height': _SIZE[1] - 120})});"
        "Plotly.newPlot('c',f.data,f.layout,{staticPlot:true})</script>"
    )


def _file_name(caption: str) -> str:
    """A caption as the name of a file."""
    words = re.findall(r"[a-z0-9]+", caption.lower())
    return "-".join(words[:8]) or "chart"


def _run(program: str, page: Path, *options: str) -> None:
    """Let the browser do one thing with a page, in a profile of its own."""
    with tempfile.TemporaryDirectory() as profile:
        common = [
            "--headless",
            "--disable-gpu",
            "--no-first-run",
            "--disable-background-networking",
            "--disable-quic",
            "--hide-scrollbars",
            f"--user-data-dir={profile}",
            "--virtual-time-budget=10000",
        ]
        try:
            if hasattr(os, "geteuid") and os.geteuid() == 0:
                common.append("--no-sandbox")  # as root it has none
            subprocess.run(
                [program, *common, *options, f"{page.resolve().as_uri()}#brief"],
                check=False,
                capture_output=True,
                timeout=_SECONDS,
            )
        except (OSError, subprocess.TimeoutExpired) as error:
            raise InputError(f"{program} does not print {page}: {error}") from error
