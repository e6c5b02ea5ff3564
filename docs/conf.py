"""How Sphinx builds this folder: ``.ci/docs``, or ``make docs``."""

import logging
import os
import re
import sys
from importlib.metadata import version as installed
from pathlib import Path
from typing import Any

from jinja2 import BaseLoader
from jinja2.sandbox import SandboxedEnvironment
from numpydoc import docscrape_sphinx
from sphinx.application import Sphinx
from sphinx.domains.python import PythonDomain

HERE = Path(__file__).parent
sys.path.insert(0, str(HERE))

import dossier_pages  # noqa: E402 - beside this file
import formulas  # noqa: E402
import notebook_runs  # noqa: E402
import result_pages  # noqa: E402
import written_pages  # noqa: E402

written_pages.write_all(HERE / "generated")

project = "fe-drivetrain"
release = version = installed("fe-drivetrain")
extensions = ["formulas", "myst_nb", "numpydoc", "sphinx.ext.autodoc", "sphinx_design"]
root_doc = "index"
exclude_patterns = ["generated/ipython", "generated/static"]

# Headings are link targets as on a repository page.
myst_heading_anchors = 3
myst_enable_extensions = ["colon_fence", "deflist", "dollarmath"]
# Formulas in dollars, and in blocks of "math", as repository hosts show them.
myst_fence_as_directive = ["math"]
html_math_renderer = "mathml"

# Notebooks stand without results: these are what the program finds now, kept until it changes.
nb_execution_mode = "cache"
nb_execution_cache_path = notebook_runs.kept_runs(HERE.parent / "build" / "notebooks")
nb_execution_in_temp = True
nb_execution_raise_on_error = True
nb_execution_timeout = 300
logging.getLogger("traitlets").setLevel(logging.WARNING)
# Figures come without Plotly itself, which the site has once.
os.environ |= {"IPYTHONDIR": notebook_runs.ipython_folder(HERE / "generated" / "ipython")}

# Types stand in the signature; the docstrings say units, shapes and sources.
autodoc_typehints_format = "short"
autodoc_preserve_defaults = True
# Of programs that the system has, or has not.
autodoc_mock_imports = ["mpi4py", "petsc4py"]
# The list of a room's names stands at the top of its page; in every page's menu it would be slow.
toc_object_entries = False
python_maximum_signature_line_length = 88
numpydoc_show_class_members = False
numpydoc_class_members_toctree = False
# `name` in a docstring is a name of the same room where there is one, and code otherwise.
default_role = "py:obj"
# Two rooms may have a class of the same name, and an annotation does not say which is meant.
suppress_warnings = ["ref.python"]

# Arrays have the names of fe_drivetrain.common.
ARRAYS = {"float64": "Floats", "int64": "Ints", "bool_": "Bools", "bool": "Bools"}
ARRAY = re.compile(r"~numpy\.ndarray\[~typing\.Any, ~numpy\.dtype\[~numpy\.(\w+)\]\]")

html_theme = "furo"
html_title = "fe-drivetrain"
html_show_copyright = False
html_copy_source = False
html_show_sourcelink = False
html_static_path = [notebook_runs.static_folder(HERE / "generated" / "static"), formulas.STYLE]
html_css_files = [formulas.STYLE]


def as_plain_text(
    app: Sphinx, what: str, name: str, obj: object, options: object, lines: list[str]
) -> None:
    """Let |x| in a docstring be an absolute value, and x_ a name: neither refers to anything."""
    for i, line in enumerate(lines):
        pieces = re.split(r"(`+[^`]*`+)", line)
        pieces[::2] = [re.sub(r"\||(?<=\w)_(?!\w)", r"\\\g<0>", piece) for piece in pieces[::2]]
        lines[i] = "".join(pieces)


def by_their_names(
    app: Sphinx, what: str, name: str, obj: object, options: object, takes: str, gives: str
) -> tuple[str, str]:
    """Let a signature say Floats, as the code does, and not what that stands for."""

    def named(part: str) -> str:
        return part and ARRAY.sub(lambda found: ARRAYS.get(found[1], found[0]), part)

    return named(takes), named(gives)


def to_docstrings(app: Sphinx, docname: str, source: list[str]) -> None:
    """Let the rooms and modules that the theory names lead to their docstrings."""
    if docname == "theory":
        source[0] = re.sub(
            r"`([a-z_]+(?:\.[a-z_]+)*)`", r"{py:mod}`\1 <fe_drivetrain.\1>`", source[0]
        )


def find_quickly() -> None:
    """Let Sphinx look through all names only for one that some name ends with.

    Each type and parameter of a docstring is looked for, most of them in vain, and each search that
    fails goes through thousands of names: a fifth of the time of a build.
    """
    search = PythonDomain.find_obj
    ends: dict[int, set[str]] = {}  # last parts of all names, by their number, which only grows

    def find_obj(self: PythonDomain, env: Any, modname: str, classname: str, name: str, *more: Any):
        count = len(self.objects)
        if count not in ends:
            ends.clear()
            ends[count] = {full.rpartition(".")[2] for full in self.objects}
        if name.removesuffix("()").rpartition(".")[2] not in ends[count]:
            return []
        return search(self, env, modname, classname, name, *more)

    PythonDomain.find_obj = find_obj


def compile_once() -> None:
    """Let numpydoc compile its template for the first docstring, not again for each of thousands.

    A tenth of the time of a build went there.
    """
    made: dict[str, SandboxedEnvironment] = {}

    def environment(loader: BaseLoader) -> SandboxedEnvironment:
        # one for each kind of loader: all of a kind read the same folders
        return made.setdefault(type(loader).__name__, SandboxedEnvironment(loader=loader))

    docscrape_sphinx.SandboxedEnvironment = environment


DOSSIER = HERE.parent / "build" / "dossier"


def begin_dossier(app: Sphinx) -> None:
    """Make the dossier while pages are read and written."""
    if app.builder.format == "html":
        making = dossier_pages.begun(DOSSIER)

        def copy_dossier(app: Sphinx, error: Exception | None) -> None:
            if error is None:
                dossier_pages.finish(making, DOSSIER, Path(app.outdir))
            else:
                making.terminate()

        app.connect("build-finished", copy_dossier)


def copy_results(app: Sphinx, error: Exception | None) -> None:
    """Put the pages of the last run beside those of the site."""
    if error is None and app.builder.format == "html":
        result_pages.copy_pages(result_pages.results_folder(), Path(app.outdir))


def setup(app: Sphinx) -> dict[str, bool]:
    """Connect what Sphinx calls, before numpydoc reads a docstring."""
    find_quickly()
    compile_once()
    app.connect("autodoc-process-docstring", as_plain_text, priority=100)
    app.connect("autodoc-process-signature", by_their_names)
    app.connect("source-read", to_docstrings)
    app.connect("builder-inited", begin_dossier)
    app.connect("build-finished", copy_results)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
