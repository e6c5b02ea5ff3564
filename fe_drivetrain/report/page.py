"""The page of a result folder: one HTML file, made from results.json and the images beside it.

The page holds all that it shows and asks nothing of any network; its content-security policy
forbids that, and any script but Plotly's and the few lines that start it. Every string of the
results is data: it is escaped, whatever it says.
"""

from __future__ import annotations

import base64
import hashlib
import json
import math
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any
from urllib.parse import quote

import jinja2
from markupsafe import Markup, escape

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.report.results import (
    Cell,
    Chart,
    Image,
    Limit,
    Problem,
    Results,
    Table,
    Verdict,
    bias_and_scatter,
    read_results,
    results_below,
)
from fe_drivetrain.report.typeset import MINUS, THIN_SPACE, superscript, typeset

DIGITS = 5
"""Significant digits of a number on the page; results.json keeps all of them."""

_TEMPLATES = Path(__file__).parent / "templates"
_PNG = b"\x89PNG\r\n\x1a\n"
_CONTENTS_FROM = 5  # sections from which on a page has a table of contents

# Okabe and Ito 2008, "Color Universal Design", without the yellow, which is too faint on white
_PALETTE = ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#1f2933"]
# line styles of the traces that come after as many as there are colours
_DASHES = ("solid", "dash", "dot", "dashdot")
_AXIS = {
    "exponentformat": "SI",
    "showline": True,
    "linecolor": "#52606d",
    "ticks": "outside",
    "tickcolor": "#52606d",
    "gridcolor": "#e4e7eb",
    "zerolinecolor": "#9aa5b1",
    "automargin": True,
    "title": {"standoff": 10},
}
_CHART_TEMPLATE: dict[str, Any] = {
    "layout": {
        "colorway": _PALETTE,
        "font": {"family": "system-ui, 'Segoe UI', Arial, sans-serif", "size": 14},
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "margin": {"l": 60, "r": 44, "t": 30, "b": 50},
        # beside the plot, not over the last names of the legend
        "modebar": {"orientation": "v"},
        "legend": {"orientation": "h", "y": 1.02, "yanchor": "bottom", "x": 0, "xanchor": "left"},
        "hovermode": "closest",
        "hoverlabel": {"align": "left"},
        "colorscale": {"sequential": "Viridis", "sequentialminus": "Viridis"},
        "xaxis": _AXIS,
        "yaxis": _AXIS,
    },
    "data": {"heatmap": [{"colorscale": "Viridis"}], "contour": [{"colorscale": "Viridis"}]},
}


def write_page(folder: Path) -> Path:
    """Write the page of a result folder.

    Parameters
    ----------
    folder : Path
        Holds results.json and the images that it names.

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
    page.write_text(render(read_results(folder / "results.json"), folder), encoding="utf-8")
    return page


def write_index(folder: Path, problems: Mapping[str, Problem] | None = None) -> Path:
    """Write a page of all results below a folder: every verdict, and bias and scatter of all.

    Where there are limits of methods among them, atlas.html beside it lists these.

    Parameters
    ----------
    folder : Path
        Holds GROUP/NAME/results.json of any number of cases.
    problems : Mapping[str, Problem] or None
        Why a case has no results now, or none of this run, by its name; it is listed with that.

    Returns
    -------
    page
        Path of index.html in the same folder; it appears whole or not at all.
    """
    folder = Path(folder)
    problems = problems or {}
    names = set(results_below(folder))
    rows = []
    for name in sorted(names | set(problems)):
        row: dict[str, Any] = {"name": name, "group": name.partition("/")[0], "results": None}
        row |= {"skipped": False, "pending": False}
        if name in problems:
            row["problem"] = escape(problems[name].message)  # to be typed again, perhaps
            row["skipped"] = problems[name].is_missing_tool
            row["pending"] = problems[name].is_pending
        else:
            try:
                row["results"] = read_results(folder / name / "results.json")
            except (OSError, ValueError):  # of another version, say
                row["problem"] = "its results.json cannot be read: run it again"
        rows.append(row)
    verdicts = [v for row in rows if row["results"] for v in row["results"].verdicts]
    environment = _environment()
    environment.filters["percent"] = lambda share: formatted(100 * share, 3)
    limits = [
        (limit, row["name"]) for row in rows if row["results"] for limit in row["results"].limits
    ]
    quick = {row["name"] for row in rows if row["results"] and row["results"].environment.quick}
    atlas = folder / "atlas.html"
    if limits:
        with atomic_path(atlas) as unfinished:
            content = environment.get_template("atlas.html").render(
                limits=[limit for limit, _ in limits],
                pages=[name for _, name in limits],
                quick=sorted({name for _, name in limits} & quick),
                style=_style(),
            )
            unfinished.write_text(content, encoding="utf-8")
    else:
        atlas.unlink(missing_ok=True)
    page = folder / "index.html"
    with atomic_path(page) as unfinished:
        content = environment.get_template("index.html").render(
            has_atlas=bool(limits),
            rows=rows,
            skipped=sum(row["skipped"] for row in rows),
            pending=sum(row["pending"] for row in rows),
            quick=len(quick),
            passed=sum(row["results"] is not None and row["results"].passed for row in rows),
            verdicts=verdicts,
            statistics=bias_and_scatter(verdicts),
            style=_style(),
        )
        unfinished.write_text(content, encoding="utf-8")
    return page


def _environment() -> jinja2.Environment:
    environment = jinja2.Environment(
        loader=jinja2.FileSystemLoader(_TEMPLATES),
        autoescape=True,
        undefined=jinja2.StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        # of plain strings alone: what is Markup is scripts, styles, and what is to be typed again
        finalize=lambda value: _printed(value) if type(value) is str else value,
    )
    shared: dict[str, Callable[..., str]] = {
        "seconds": lambda s: f"{s:.3g}" if abs(s) < 1000 else f"{s:.0f}",
        "cell": formatted,
        "band": band_text,
        "computed": computed_text,
        "expected": expected_text,
        "error": error_text,
        "tolerance": tolerance_text,
        "safe_range": safe_range,
        "page_of": _page_of,
    }
    environment.filters |= shared
    return environment


def _style() -> Markup:
    # only our own file: never a string of the results
    return Markup((_TEMPLATES / "report.css").read_text(encoding="utf-8"))


def _printed(text: str) -> str:
    """Text as a page prints it; what stands between backticks is code, and stays as it is."""
    if text.count("`") % 2 or "`" not in text:
        return typeset(text)
    parts = [
        Markup("<code>{}</code>").format(part) if i % 2 else escape(typeset(part))
        for i, part in enumerate(text.split("`"))
    ]
    return Markup("").join(parts)


def render(results: Results, folder: Path) -> str:
    """The page as text; see `write_page`."""
    charts = [i for s in results.sections for i in s.items if isinstance(i, Chart)]
    scripts = []
    if charts:
        from plotly.offline import get_plotlyjs

        scripts = [get_plotlyjs(), (_TEMPLATES / "charts.js").read_text(encoding="utf-8")]
    environment = _environment()
    environment.filters |= {
        "number": _is_number,
        "figure": _figure_as_json,
        "unit_unbroken": _unit_unbroken,
        "numeric_columns": _numeric_columns,
        "in_column": _in_column,
        "height": _chart_height,
        "as_given": lambda settings: [(k, escape(_as_given(v))) for k, v in settings.items()],
        "data_url": lambda image: _as_data_url(image, folder),
    }
    passed = sum(verdict.passed for verdict in results.verdicts)
    return environment.get_template("report.html").render(
        results=results,
        passed=passed,
        contents=len(results.sections) + 4 >= _CONTENTS_FROM,
        style=_style(),
        scripts=[Markup(script) for script in scripts],
        script_hashes=[_hash(script) for script in scripts],
    )


def formatted(
    value: float | int | str | bool | None, digits: int = DIGITS, unit: str | None = None
) -> str:
    """A value as an engineer reads it.

    Numbers have at most `digits` significant digits and thin spaces between thousands; very
    large and very small ones a power of ten. It is a multiple of three, as units have prefixes,
    but for percentages and pure numbers (`unit` "%", "" or "-").
    """
    if value is None:
        return "–"
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, str):
        return value
    if not math.isfinite(value):
        return "not a number" if math.isnan(value) else f"{MINUS if value < 0 else ''}∞"
    if value == 0:
        return "0"
    if isinstance(value, int) and abs(value) < 10**9:
        return f"{value:,}".replace(",", THIN_SPACE).replace("-", MINUS)
    # rounded first: 999 999.9 has another exponent than it seems
    rounded, _, exponent_text = f"{value:.{digits - 1}e}".partition("e")
    exponent = int(exponent_text)
    step = 1 if unit in ("%", "", "-") else 3
    power = 0 if -3 <= exponent < 6 else step * (exponent // step)
    decimals = max(digits - 1 - exponent + power, 0)
    shown = float(rounded) * 10 ** (exponent - power) if power else value
    number = f"{shown:,.{decimals}f}"
    if decimals:
        number = number.rstrip("0").rstrip(".")
    number = number.replace(",", THIN_SPACE).replace("-", MINUS)
    return f"{number}\u00a0×\u00a010{superscript(power)}" if power else number


def computed_text(verdict: Verdict) -> str:
    """The computed value; of a statement, whether it holds."""
    if verdict.check == "holds":
        return "yes" if verdict.computed == 1.0 else "no"
    return formatted(verdict.computed, unit=verdict.unit)


def expected_text(verdict: Verdict) -> str:
    """What a check asks for: a reference, zero, a bound, a range, or that a statement holds."""
    reference = formatted(verdict.reference, unit=verdict.unit)
    if verdict.check == "at most":
        return f"≤\u00a0{reference}"
    if verdict.check == "at least":
        return f"≥\u00a0{reference}"
    if verdict.check == "between":
        return f"{reference} to {formatted(verdict.upper, unit=verdict.unit)}"
    return {"vanishes": "0", "holds": "yes"}.get(verdict.check, reference)


def error_text(verdict: Verdict) -> str:
    """The error of a verdict: in percent of the reference, or in the unit; none of a bound."""
    if verdict.check not in ("equals", "vanishes"):
        return "–"
    error = verdict.computed - verdict.reference
    if verdict.relative and verdict.reference != 0:
        return _signed(100 * error / abs(verdict.reference), "%")
    return _signed(error, verdict.unit)


def band_text(verdict: Verdict) -> str:
    """The band of a computed value: in percent of it, or in the unit."""
    if verdict.band is None:
        return "–"
    if verdict.relative and verdict.computed != 0:
        return f"±{formatted(100 * verdict.band / abs(verdict.computed), 2, '%')}\u00a0%"
    return f"±{_with_unit(formatted(verdict.band, 2, verdict.unit), verdict.unit)}"


def safe_range(limit: Limit) -> str:
    """The safe range of a limit, as a table shows it."""
    low, high = (None if end is None else formatted(end, 3) for end in (limit.low, limit.high))
    if low is None:
        return "the whole sweep" if high is None else f"up to {high}"
    return f"from {low}" if high is None else f"{low} to {high}"


def tolerance_text(verdict: Verdict) -> str:
    """The tolerance of a verdict, in percent or in the unit; none of a bound."""
    if verdict.check not in ("equals", "vanishes"):
        return "–" if verdict.check == "holds" else ""
    if verdict.relative:
        return f"±{formatted(100 * verdict.tolerance, 3, '%')}\u00a0%"
    return f"±{_with_unit(formatted(verdict.tolerance, 3, verdict.unit), verdict.unit)}"


def _signed(value: float, unit: str) -> str:
    return _with_unit(("+" if value > 0 else "") + formatted(value, 3, unit), unit)


def _with_unit(number: str, unit: str) -> str:
    return f"{number}\u00a0{unit}" if unit not in ("", "-") else number


def _as_given(value: object) -> str:
    """A setting of the run, exactly."""
    return value if isinstance(value, str) else json.dumps(value, ensure_ascii=False)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _unit_unbroken(heading: str) -> str:
    """A heading whose unit, in brackets, stays on one line."""
    return re.sub(r"\[[^\]]*\]", lambda unit: unit.group().replace(" ", "\u00a0"), heading)


def _numeric_columns(table: Table) -> set[int]:
    """Which columns hold numbers, and perhaps gaps, but nothing else."""
    columns = list(zip(*table.rows, strict=False))
    return {
        number
        for number, cells in enumerate(columns)
        if any(map(_is_number, cells)) and all(c is None or _is_number(c) for c in cells)
    }


def _in_column(value: Cell, heading: str) -> str:
    """A cell: of percentages and pure numbers, which the heading says, with any power of ten."""
    unit = next((unit for unit in ("%", "-") if heading.endswith(f"[{unit}]")), None)
    return formatted(value, unit=unit)


def _chart_height(item: Chart) -> int:
    """Pixels, so that the page does not jump when the chart appears."""
    height = item.figure.get("layout", {}).get("height")
    return int(height) if _is_number(height) and 100 <= height <= 4000 else 460


def _figure_as_json(item: Chart) -> Markup:
    """The figure in the page's look, as JSON that can stand inside a script element."""
    figure = dict(item.figure)
    layout = {**figure.get("layout", {}), "template": _CHART_TEMPLATE, "autosize": True}
    for size in ("width", "height"):
        layout.pop(size, None)
    if layout.get("title"):
        # a title takes the legend's place above the plot
        look = {k: v for k, v in _CHART_TEMPLATE["layout"].items() if k != "legend"}
        layout["template"] = {**_CHART_TEMPLATE, "layout": look}
    # WebGL is missing on many a remote desktop, and a browser allows a page only a few contexts
    traces = [
        {**trace, "type": "scatter"} if trace.get("type") == "scattergl" else trace
        for trace in figure.get("data", [])
    ]
    for axis in ("x", "y"):
        own = layout.get(f"{axis}axis", {})
        if own.get("type") == "log":
            layout[f"{axis}axis"] = {**_log_ticks(axis, traces), **own}
    content = {"data": _distinguished(traces), "layout": layout}
    text = json.dumps(_finite(content), ensure_ascii=True, allow_nan=False)
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return Markup(text)


def _log_ticks(axis: str, traces: list[dict[str, Any]]) -> dict[str, Any]:
    """Labels of a logarithmic axis that do not run into each other: decades, or 1, 2 and 5."""
    values = [v for trace in traces for v in trace.get(axis, []) if _is_number(v) and v > 0]
    decades = math.log10(max(values) / min(values)) if values else 0.0
    if decades > 12:
        return {}
    return {"dtick": 1 if decades >= 2 else "D2" if decades >= 1 else "D1"}


def _distinguished(traces: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The same traces, those in line for a colour a second time drawn in another style."""
    found = []
    place = 0
    for trace in traces:
        own = trace.get("line", {})
        if "color" in own or "color" in trace.get("marker", {}):
            found.append(trace)
            continue
        style = _DASHES[place // len(_PALETTE) % len(_DASHES)]
        place += 1
        dashed = style != "solid" and trace.get("type", "scatter") == "scatter"
        found.append({**trace, "line": {"dash": style, **own}} if dashed else trace)
    return found


def _finite(value: Any) -> Any:
    """The same data, its texts typeset, with null for what JSON has no number for."""
    if isinstance(value, dict):
        return {key: _finite(inner) for key, inner in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(inner) for inner in value]
    if isinstance(value, str):
        return typeset(value)
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _as_data_url(image: Image, folder: Path) -> Markup:
    """A PNG of the folder, embedded; Markup, for its letters and digits are no numbers to set."""
    path = folder / image.file
    if Path(image.file).name != image.file or not path.is_file() or path.is_symlink():
        raise InputError(f"image {image.file!r} of results.json is not a file in {folder}")
    content = path.read_bytes()
    if not content.startswith(_PNG):
        raise InputError(f"image {image.file!r} of results.json is no PNG: write it as one")
    return Markup(f"data:image/png;base64,{base64.b64encode(content).decode()}")


def _hash(script: str) -> Markup:
    """How a content-security policy names a script."""
    digest = base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()
    return Markup(f"'sha256-{digest}'")


def _page_of(case: str) -> Markup:
    """Address of a case's page from that of the index."""
    return Markup(f"{quote(case)}/report.html")
