"""The page of a result folder: one HTML file, made from results.json and the images beside it.

Every string of the results is data: it is escaped, whatever it says.
"""

from __future__ import annotations

import base64
import hashlib
import json
import os
import re
from collections import Counter
from collections.abc import Sequence
from functools import lru_cache
from pathlib import Path
from urllib.parse import quote, unquote

import jinja2
from markupsafe import Markup, escape

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.manifest import MANIFEST
from fe_drivetrain.plots.style import is_number
from fe_drivetrain.report.answer import MAX_CAUTIONS, KeyFigure
from fe_drivetrain.report.bundle import place_plotly, plotly_file
from fe_drivetrain.report.chart_style import SWING, chart_height, figure_as_json, script_json
from fe_drivetrain.report.headline import answer_sentence, headline, values_found
from fe_drivetrain.report.history import FILE, Point, points_over_runs, tolerated
from fe_drivetrain.report.number_text import (
    formatted,
    limit_text,
    standing_of_answer,
    standing_text,
    value_with_band,
)
from fe_drivetrain.report.rendering import policy_hash, read_template, templates
from fe_drivetrain.report.results import (
    Chart,
    Figure,
    Image,
    Results,
    Section,
    Solid,
    Table,
    Text,
    Verdict,
    cautions_of,
    read_results,
    verdict_sentence,
)
from fe_drivetrain.report.table_text import cell_texts, numeric_columns
from fe_drivetrain.report.trend import change_text, sparkline
from fe_drivetrain.report.words import FirstUses, words_in

Item = Text | Table | Chart | Image | Solid
"""What stands in a section."""

_PNG = b"\x89PNG\r\n\x1a\n"
_MOST_ROWS = 12  # of a table that is not scrolled inside
_HERO_HEIGHT = 400  # pixels, so that the first screen holds all that answers
_MAY_SHRINK = 560  # charts that are higher than this are bars, which may stand closer
_CLOSER = 0.6  # so close that their names can still be read
_MOST_PIXELS = 700  # of a chart of the first screen that is not scrolled inside
_QUANTITIES = 6  # of a case that are shown over its runs
_FILES = 60  # to which a page links at most
_KINDS = {
    ".3d.json": "what the page shows in three dimensions",
    ".csv": "table, for any spreadsheet",
    ".inp": "model for CalculiX and Abaqus",
    ".json": "numbers with full precision",
    ".msh": "mesh for gmsh",
    ".mtx": "matrix, Matrix Market",
    ".parquet": "table, Parquet",
    ".png": "picture",
    ".vtu": "mesh and fields for ParaView",
    ".yaml": "scene",
}


def write_page(folder: Path, shared: Path | None = None) -> Path:
    """Write the page of a result folder.

    Parameters
    ----------
    folder : Path
        Holds results.json and the images that it names, and the files to which the page links.
    shared : Path or None
        A folder above for what the pages of several cases share: the history of their runs, and
        the program that draws charts. The folder itself where left out.

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
    results = read_results(folder / "results.json")
    if any(isinstance(item, Chart) for section in results.sections for item in section.items):
        place_plotly(shared or folder)
    page.write_text(render(results, folder, shared or folder), encoding="utf-8")
    return page


def render(results: Results, folder: Path, shared: Path) -> str:
    """The page as text; see `write_page`."""
    items = [item for section in results.sections for item in section.items]
    has_charts = any(isinstance(item, Chart) for item in items)
    has_solids = any(isinstance(item, Solid) for item in items)
    swings = any(isinstance(item, Chart) and SWING in item.figure for item in items)
    names = (
        "page.js",
        *(("charts.js",) * has_charts),
        *(("swing.js",) * swings),
        *(("solid.js",) * has_solids),
    )
    scripts = [read_template(name) for name in names]
    words = words_in(_sentences(results))
    above = Markup(quote(os.path.relpath(shared, folder)))
    template = _pages().get_template("report.html")
    return template.render(
        results=results,
        data_url=lambda file: _as_data_url(file, folder),
        solid_json=lambda solid: _as_script_data(solid, folder),
        passed=sum(verdict.passed for verdict in results.verdicts),
        figures=_key_figures(results),
        standing=standing_of_answer(results.answer) if results.answer else None,
        printed=_printed_references(results),
        verdict=verdict_sentence(results),
        words=words,
        linked=FirstUses(words),
        cautions=_cautions(results),
        most_cautions=MAX_CAUTIONS,
        most_rows=_MOST_ROWS,
        most_pixels=_MOST_PIXELS,
        hero=_hero(results, items),
        explained=bool(results.answer and results.details),
        runs=runs_of_page(results, shared),
        files=_files(folder),
        index=above + "/index.html" if (shared / "index.html").is_file() else "",
        plotly=above + f"/{plotly_file()}" if has_charts else "",
        # no string of the results can hold the hash of them all: so no other script is allowed
        nonce=hashlib.sha256(results.model_dump_json().encode()).hexdigest(),
        scripts=scripts,
        script_hashes=[policy_hash(script) for script in scripts],
    )


def _sentences(results: Results) -> list[str]:
    """What the page says in sentences, captions and names, of which words are explained."""
    answer = results.answer
    said = [answer.question, *(figure.name for figure in answer.figures)] if answer else []
    if answer and any(figure.band for figure in answer.figures):
        said.append("band")  # which stands behind ±
    said += [verdict_sentence(results), *results.details, *cautions_of(results)]
    for item in (item for section in results.sections for item in section.items):
        said += [item.text] if isinstance(item, Text) else [item.caption]
        said += item.columns if isinstance(item, Table) else []
    return [results.title, *said, *(check.quantity for check in results.verdicts)]


def _hero(results: Results, items: Sequence[Item]) -> Item | None:
    """What the first screen shows: what the answer names, or of an older file its first picture."""
    if results.answer is None:
        return next((item for item in items if isinstance(item, Image)), None)
    asked = results.answer.hero
    return next((i for i in items if not isinstance(i, Table | Text) and i.caption == asked), None)


def _key_figures(results: Results) -> list[KeyFigure]:
    """The values that answer; of an older file its values, or the check that it names."""
    if results.answer is not None:
        return results.answer.figures
    named = headline(results)
    found: list[Figure | Verdict] = list(results.answers)
    if not found and named is not None:
        found.append(named)
    return [
        KeyFigure(
            name=one.quantity,
            value=one.computed,
            unit=one.unit,
            band=one.band,
            bound="holds" if isinstance(one, Verdict) and one.check == "holds" else "",
            status="none",
        )
        for one in found
    ]


def _printed_references(results: Results) -> list[str]:
    """The reference of each check as its source prints it; empty where that is not known."""
    figures = results.answer.figures if results.answer else []
    known = {(f.quantity, f.unit): f.printed for f in figures if f.bound != "between"}
    return [known.get((check.quantity, check.unit), "") for check in results.verdicts]


def _cautions(results: Results) -> list[tuple[str, str]]:
    """What limits the answer, most severe first, each with its kind for the style."""
    fails = [f"Fails: {answer_sentence(check)}" for check in results.verdicts if not check.passed]
    # the badge of a quick run says it
    badge = "Quick run: " if results.environment.quick else "\0"
    return [
        *(("failing", sentence) for sentence in fails),
        *(
            ("unsettled" if sentence in results.unsettled else "", sentence)
            for sentence in cautions_of(results)
            if not sentence.startswith(badge)
        ),
    ]


def _contents(section: Section) -> str:
    """What a section holds beside text, in words."""
    kinds = Counter("figure" if i.kind in ("image", "solid") else i.kind for i in section.items)
    return ", ".join(
        f"{kinds[kind]} {kind}{'s' * (kinds[kind] > 1)}"
        for kind in ("chart", "figure", "table")
        if kinds[kind]
    )


def _hero_height(item: Chart | Image | Solid) -> int:
    """Pixels of the chart of the first screen; bars stand closer there than in a fold."""
    height = chart_height(item)
    if height <= _MAY_SHRINK:
        return min(height, _HERO_HEIGHT)
    return _HERO_HEIGHT + round(_CLOSER * (height - _MAY_SHRINK))


@lru_cache(maxsize=1)
def _pages() -> jinja2.Environment:
    """The templates, compiled once: a run of many cases writes a page of each."""
    environment = templates()
    environment.filters |= {
        "number": is_number,
        "figure": figure_as_json,
        "unit_unbroken": _unit_unbroken,
        "numeric_columns": numeric_columns,
        "cell_texts": cell_texts,
        "contents": _contents,
        "items_of": lambda of: of.items(),
        "height": chart_height,
        "hero_height": _hero_height,
        "as_given": lambda settings: [(k, escape(_as_given(v))) for k, v in settings.items()],
        "with_band": value_with_band,
        "limit_of": limit_text,
        "standing": standing_text,
        "sparkline": sparkline,
        "change": change_text,
        "unquoted": lambda address: escape(unquote(address)),
    }
    return environment


def runs_of_page(results: Results, shared: Path) -> list[tuple[Figure | Verdict, list[Point]]]:
    """Quantities of a case over its runs so far, this one included: its answer and some others.

    Parameters
    ----------
    results : Results
        Of this run.
    shared : Path
        The folder of the history.

    Returns
    -------
    list of tuple
        Answers and checks, and what each run found; empty where this is the first.
    """
    environment, every = results.environment, values_found(results)
    found = every[:1]
    found += [v for v in every[1:] if isinstance(v, Figure) or v.check == "equals"]
    runs = []
    for value in found[:_QUANTITIES]:
        before = points_over_runs(shared, results, value)
        passed = not isinstance(value, Verdict) or value.passed
        now = Point(environment.date, environment.code, value.computed, passed, tolerated(value))
        if before:
            runs.append((value, [*before, now]))
    return runs


def _files(folder: Path) -> list[tuple[Markup, str, str]]:
    """Address, kind and size of each file beside the page."""
    return [
        (
            Markup(quote(str(file.relative_to(folder)))),
            next((kind for end, kind in _KINDS.items() if file.name.endswith(end)), ""),
            f"{formatted(max(file.stat().st_size / 1000, 0.1), 2)} kB",
        )
        for file in sorted(folder.rglob("*"))
        if file.is_file() and file.name not in ("report.html", FILE, MANIFEST, plotly_file())
    ][:_FILES]


def _as_given(value: object) -> str:
    """A setting of the run, exactly."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _unit_unbroken(heading: str) -> str:
    """A heading whose unit, in brackets, stays on one line."""
    return re.sub(r"\[[^\]]*\]", lambda unit: unit.group().replace(" ", "\u00a0"), heading)


def _as_data_url(name: str, folder: Path) -> Markup:
    """A PNG of the folder, embedded; Markup, for its letters and digits are no numbers to set."""
    content = _file_of(name, folder).read_bytes()
    if not content.startswith(_PNG):
        raise InputError(f"image {name!r} of results.json is no PNG: write it as one")
    return Markup(f"data:image/png;base64,{base64.b64encode(content).decode()}")


def _as_script_data(solid: Solid, folder: Path) -> Markup:
    """The file of a model in three dimensions as JSON that can stand inside a script element."""
    return script_json(json.loads(_file_of(solid.file, folder).read_text(encoding="utf-8")))


def _file_of(name: str, folder: Path) -> Path:
    path = folder / name
    if Path(name).name != name or not path.is_file() or path.is_symlink():
        raise InputError(f"image {name!r} of results.json is not a file in {folder}")
    return path
