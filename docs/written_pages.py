"""Pages that are written from the code each time the documentation is built.

The validation index comes from what the cases declare, the API from the public names of the rooms,
the gallery from the library of scenes and its pictures (``docs/stills.py``), limits of methods from
results of a run (``docs/result_pages.py``).
"""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from itertools import groupby
from pathlib import Path
from types import ModuleType

import house
from dossier_pages import dossier_page
from face_examples import examples
from result_pages import answer_of, cards_of_cases, limits_page, of_the_run, plain, results
from sphinx.errors import PycodeError
from sphinx.pycode import ModuleAnalyzer
from stills import library

import fe_drivetrain
from fe_drivetrain.drivetrain_file import Component, Scene
from fe_drivetrain.report import Results
from fe_drivetrain.report.suite import Case, all_cases, settings_in_words

#: Folders of modules without a list of names of their own, whose modules users import.
MODULES_OF = {"export": "export.programs"}

#: Folders whose names the room's face shows.
INSIDE = {"dynamics": ("bodies", "time")}


def write_all(folder: Path) -> None:
    """Write all pages below a folder; those that have not changed stay, and are not built again."""
    found = results()
    pages = {"validation.md": validation_index(all_cases().values(), found)}
    rooms = list(public_rooms())
    pages["api.rst"] = api_index(rooms)
    for room in rooms:
        pages[f"api/{room}.rst"] = api_of(room)
    pages["dossier.md"] = dossier_page()
    pages["limits.md"] = limits_page(found)
    pages["gallery.md"] = gallery(library(), cards_of_cases(found, folder / "pictures"))
    for old in (*folder.glob("*.*"), *folder.glob("api/*.*")):
        if old.is_file() and old.relative_to(folder).as_posix() not in pages:
            old.unlink()
    for name, text in pages.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


# --- Validation ---


def validation_index(cases: Iterable[Case], found: Mapping[str, tuple[Results, Path]]) -> str:
    """All cases by group: title, answer of the last run, source of the reference, settings."""
    cases = list(cases)
    lines = [
        "# Validation index",
        "",
        f"The {len(cases)} cases of `fe-drivetrain list`, written from what they declare. "
        "`fe-drivetrain run NAME` runs one, `fe-drivetrain run GROUP` a group; each page states "
        "its checks, references, bands and assumptions. `--set KEY=VALUE` changes a setting.",
        "",
        of_the_run(found),
        "",
    ]
    for group, members in groupby(cases, key=lambda c: c.name.partition("/")[0]):
        about = inspect.getdoc(importlib.import_module(f"fe_drivetrain.cases.{group}")) or ""
        lines += [f"## {group}", "", *([plain(about.split("\n\n")[0])] if about else []), ""]
        for case in members:
            lines += [
                f"`{case.name}`",
                f": {plain(case.title)}.",
                *([f"  **{answer}**"] if (answer := answer_of(case.name, found)) else []),
                f"  *Source:* {plain(case.source).rstrip('.')}.",
                *([f"  *Settings:* {plain(words)}."] if (words := settings_in_words(case)) else []),
                "",
            ]
    return "\n".join(lines)


# --- Gallery ---


def gallery(scenes: Mapping[str, Scene | Component], cards: Sequence[str]) -> str:
    """A card for each scene of the library, then for components, notebooks, and cases if any."""
    cases = all_cases()
    lines = [
        "# Gallery",
        "",
        "## Drivetrains of the library",
        "",
        "The scenes that come with the package, cut open, with loads and supports; components are "
        "deformed by a torque. [The library](../library.md) says where each comes from. "
        "`fe-drivetrain advise`, `export` and `check` take a scene by its name, as does "
        "`read_drivetrain` in Python. Each drivetrain has a case of its name, which runs all "
        "levels.",
        "",
        "::::{grid} 1 2 2 3",
        ":gutter: 3",
        "",
    ]
    for name, scene in sorted(scenes.items(), key=lambda item: isinstance(item[1], Component)):
        case = cases.get(f"fidelity/{name}")
        lines += [
            f":::{{grid-item-card}} {plain(scene.title)}",
            f":img-top: ../gallery/{name}.webp",
            f":img-alt: {name}",
            "",
            f"`{name}`",
            *(["", f"`fe-drivetrain run {case.name}`"] if case else []),
            ":::",
            "",
        ]
    lines += ["::::", "", *section_of_cards("Examples", cards_of_notebooks())]
    lines += section_of_cards("Cases of the last run", cards) if cards else []
    return "\n".join(lines)


def section_of_cards(title: str, cards: Sequence[str]) -> list[str]:
    """A heading and a grid of cards."""
    return [f"## {title}", "", "::::{grid} 1 2 2 3", ":gutter: 3", "", *cards, "::::", ""]


def cards_of_notebooks() -> list[str]:
    """A card for each row of the index's table of examples: picture, title, question."""
    index = (Path(__file__).parent / "index.md").read_text(encoding="utf-8")
    rows = re.findall(
        r"^\| !\[(.*?)\]\((.*?)\) \| \[(.*?)\]\((.*?)\.ipynb\) \| (.*?) \|$", index, re.MULTILINE
    )
    lines = []
    for what, picture, title, notebook, answer in rows:
        lines += [
            f":::{{grid-item-card}} {title}",
            f":img-top: ../{picture}",
            f":img-alt: {what}",
            f":link: ../{notebook}",
            ":link-type: doc",
            "",
            answer[:1].upper() + answer[1:],
            ":::",
            "",
        ]
    return lines


# --- API ---


def public_rooms() -> Iterator[str]:
    """Names of the rooms that have public names, in order."""
    for name in sorted(house.rooms(house.folder_of).keys() - {"cases"}):
        room, _, folder = name.rpartition(".")
        shown = {public for public, origin in house.faces().get(room, {}).items() if origin == name}
        if not room or shown <= {folder}:  # what a room shows of its folder is on the room's page
            yield name


def public_names(room: ModuleType) -> list[str]:
    """Names that users take from a room."""
    return sorted(room.__all__)


def api_index(rooms: Iterable[str]) -> str:
    """What a script needs, each name with an example, and the rooms with what they are for."""
    lines = [
        *heading("API", "="),
        "Users import from a room: ``from fe_drivetrain.elasticity.mesh import Mesh``.",
        "",
    ]
    lines += face_entries()
    lines += ["", ".. toctree::", "   :hidden:", ""]
    lines += [f"   api/{room}" for room in rooms]
    lines += ["", *heading("Rooms", "-")]
    for room in rooms:
        about = inspect.getdoc(importlib.import_module(f"fe_drivetrain.{room}")) or ""
        lines += [f":doc:`api/{room}`", f"   {' '.join(about.split(chr(10) * 2)[0].split())}"]
    return "\n".join([*lines, ""])


def face_entries() -> list[str]:
    """Public names of the package itself, each with a line on it and the example that uses it."""
    lines = ["A script needs no more than what ``fe_drivetrain`` itself has. The examples run in "]
    lines[-1] += "order, as :doc:`/python` has them."
    for names, block in examples():
        lines += [""]
        for name in names:
            value = getattr(fe_drivetrain, name)
            home = house.folder_of(value.__module__.removeprefix("fe_drivetrain."))
            about = (inspect.getdoc(value) or "").partition("\n\n")[0].replace("\n", " ")
            lines.append(f"- :py:obj:`~fe_drivetrain.{home}.{name}`: {about}")
        lines += ["", ".. code-block:: python", ""]
        lines += [f"   {line}".rstrip() for line in block.splitlines()]
    return lines


def api_of(room: str) -> str:
    """One room: what it is for, and all its public names."""
    module = importlib.import_module(f"fe_drivetrain.{room}")
    lines = [*heading(room, "="), f".. automodule:: {module.__name__}", "   :no-members:", ""]
    folders = [f"{room}.{name}" for name in public_names(module) if is_folder(room, name)]
    lines += [f"- :doc:`{name}`" for name in folders]
    names = [name for name in public_names(module) if not is_folder(room, name)]
    lines += [", ".join(f":py:obj:`~{module.__name__}.{name}`" for name in names), ""]
    for name in names:
        lines += entry(module, name)
    lines += heading("Modules", "-") if modules_of(module) else []
    for full in modules_of(module):
        name = full.rpartition(".")[2]
        lines += [*heading(name, "~"), f".. automodule:: {full}", "   :no-members:"]
        # where a public name is that of its module, links lead to the former
        lines += ["   :no-index:", ""] if name in names else [""]
    if room in MODULES_OF:
        folder = importlib.import_module(f"fe_drivetrain.{MODULES_OF[room]}")
        for info in pkgutil.iter_modules(folder.__path__):
            full = f"{folder.__name__}.{info.name}"
            lines += [*heading(full, "-"), f".. automodule:: {full}", "   :members:", ""]
    return "\n".join(lines)


def is_folder(room: str, name: str) -> bool:
    """Whether a public name of a room is a folder of it, which has names of its own."""
    return f"{room}.{name}" in house.faces()


def modules_of(room: ModuleType) -> list[str]:
    """Modules of a room, whose docstrings have equations and sources."""
    inside = INSIDE.get(room.__name__.removeprefix("fe_drivetrain."), ())
    folders = [room, *(importlib.import_module(f"{room.__name__}.{name}") for name in inside)]
    return [
        info.name
        for folder in folders
        for info in pkgutil.iter_modules(folder.__path__, f"{folder.__name__}.")
        if not info.ispkg
    ]


def entry(module: ModuleType, name: str) -> list[str]:
    """Directives for one public name."""
    value = getattr(module, name)
    full = f"{module.__name__}.{name}"
    if inspect.isclass(value):
        hidden = "model_config, model_post_init, model_fields, model_computed_fields"
        return [f".. autoclass:: {full}", "   :members:", f"   :exclude-members: {hidden}", ""]
    if inspect.isroutine(inspect.unwrap(value)) or hasattr(value, "py_func"):
        return [f".. autofunction:: {full}", ""]
    said = comment_of(module, name)
    return [f".. py:data:: {full}", "", *(f"   {line}" for line in said), ""]


def comment_of(module: ModuleType, name: str) -> list[str]:
    """What stands above a constant in the module that makes it, as ``#:`` or below it in quotes."""
    face = Path(str(module.__file__))
    stub = face.with_suffix(".pyi")
    names = (stub if stub.is_file() else face).read_text(encoding="utf-8")
    found = re.search(rf"from \.([\w.]+) import .*\b{name}\b", names)
    if found is None:
        return []
    try:
        comments = ModuleAnalyzer.for_module(f"{module.__name__}.{found[1]}").find_attr_docs()
    except PycodeError:
        return []
    return comments.get(("", name), [])


def heading(text: str, mark: str) -> list[str]:
    """A title in reStructuredText."""
    return [text, mark * len(text), ""]
