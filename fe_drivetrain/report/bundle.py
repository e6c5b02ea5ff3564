"""The program that draws charts, Plotly's, once in a folder of reports: pages refer to it."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from fe_drivetrain.common.files import atomic_path


@cache
def plotly_file() -> str:
    """Name of the file, with Plotly's version: pages of an older one keep theirs."""
    from importlib.metadata import version

    return f"plotly-{version('plotly')}.min.js"


def place_plotly(folder: Path) -> None:
    """Write the file into a folder where it is not there.

    Parameters
    ----------
    folder : Path
        The folder of reports.
    """
    file = folder / plotly_file()
    if not file.is_file():
        from plotly.offline import get_plotlyjs

        with atomic_path(file) as unfinished:
            unfinished.write_text(get_plotlyjs(), encoding="utf-8")
