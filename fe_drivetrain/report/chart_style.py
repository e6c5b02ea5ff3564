"""A chart as a page holds it: its height, and its figure as JSON."""

from __future__ import annotations

import json
from typing import Any

from markupsafe import Markup

from fe_drivetrain.plots.style import is_number, styled
from fe_drivetrain.report.results import Chart, Image, Solid

SWING = "swing"
"""Key of a figure with a trace that can swing: its number under "trace", its points at rest "x" and
"y", and how far they swing, "dx" and "dy"."""


def chart_height(item: Chart | Image | Solid) -> int:
    """Pixels, so that the page does not jump when the chart appears; of a picture 460, unused."""
    figure = item.figure if isinstance(item, Chart) else {}
    height = figure.get("layout", {}).get("height")
    return int(height) if is_number(height) and 100 <= height <= 4000 else 460


def figure_as_json(item: Chart) -> Markup:
    """The figure in the project's look, as JSON that can stand inside a script element."""
    sizes = ("width", "height")
    own = {k: v for k, v in item.figure.get("layout", {}).items() if k not in sizes}
    content = styled(item.figure.get("data", []), {**own, "autosize": True})
    if SWING in item.figure:
        content[SWING] = item.figure[SWING]
    return script_json(content)


def script_json(content: Any) -> Markup:
    """Plain data as JSON that can stand inside a script element, whatever its texts say."""
    text = json.dumps(content, ensure_ascii=True, allow_nan=False)
    for character in "<>&":
        text = text.replace(character, f"\\u{ord(character):04x}")
    return Markup(text)
