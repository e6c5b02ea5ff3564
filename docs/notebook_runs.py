"""How the notebooks of the site are run, and where their results are kept.

What a notebook found is taken again while its cells, the program and all installed packages are the
same; ``build/notebooks`` can be removed at any time.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from importlib.metadata import distributions
from pathlib import Path

from jupyter_cache import get_cache
from plotly.offline import get_plotlyjs

from fe_drivetrain.common.provenance import program_hash

PLOTLY = "plotly.min.js"
"""The program that draws figures, beside the pages."""

STARTUP = f"""
import plotly.io
from plotly.io.base_renderers import MimetypeRenderer

class OnTheSite(MimetypeRenderer):
    def to_mimebundle(self, figure):
        program = "../_static/{PLOTLY}"
        return {{"text/html": plotly.io.to_html(figure, include_plotlyjs=program, full_html=False)}}

plotly.io.renderers["site"] = OnTheSite()
plotly.io.renderers.default = "site"
"""


def ipython_folder(folder: Path) -> str:
    """A profile in which figures come without the 5 MB that draw them."""
    startup = folder / "profile_default" / "startup"
    startup.mkdir(parents=True, exist_ok=True)
    (startup / "figures.py").write_text(STARTUP, encoding="utf-8")
    # it warns that a process of the same machine might listen
    quiet = "get_config().IPKernelApp.log_level = 40\n"
    (startup.parent / "ipython_kernel_config.py").write_text(quiet, encoding="utf-8")
    return str(folder)


def static_folder(folder: Path) -> str:
    """What the site has beside its pages."""
    folder.mkdir(parents=True, exist_ok=True)
    (folder / PLOTLY).write_text(get_plotlyjs(), encoding="utf-8")
    return str(folder)


def kept_runs(folder: Path) -> str:
    """The folder with results of this program, which is empty at first.

    Parameters
    ----------
    folder : Path
        Holds a folder for one state of program and packages; those of others are removed.

    Returns
    -------
    str
        Path for ``nb_execution_cache_path``, whose key within is the content of a notebook.
    """
    packages = sorted(f"{package.name} {package.version}" for package in distributions())
    state = json.dumps([program_hash(), STARTUP, packages])
    kept = folder / hashlib.sha256(state.encode()).hexdigest()[:16]
    for other in folder.glob("*"):
        if other != kept:
            shutil.rmtree(other)
    kept.mkdir(parents=True, exist_ok=True)
    get_cache(kept).list_cache_records()  # before notebooks that run side by side make its tables
    return str(kept)
