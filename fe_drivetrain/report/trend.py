"""How a quantity went over the runs so far: a line the size of a word, and its last change."""

from __future__ import annotations

import math
from collections.abc import Sequence

from markupsafe import Markup

from fe_drivetrain.report.history import Point
from fe_drivetrain.report.number_text import formatted

ROUND_OFF = 1e-9
"""Change, relative to the size of a value, up to which it counts as the same."""

_NOTHING = 0.01  # share of what a check allows, up to which what should vanish is the same

_WIDTH, _HEIGHT, _EDGE = 96, 22, 3  # of the drawing, in its own units


def relative_change(before: float, after: float, allowed: float = 0.0) -> float:
    """The change of a value over its size.

    Parameters
    ----------
    before, after : float
        The values.
    allowed : float
        Error that is tolerated, in their unit: of what is smaller this is the size.

    Returns
    -------
    change : float
        0 where it is round-off; infinite from or to what is no number.
    """
    if before == after or (math.isnan(before) and math.isnan(after)):
        return 0.0
    if not (math.isfinite(before) and math.isfinite(after)):
        return math.inf
    if abs(after - before) <= _NOTHING * allowed:
        return 0.0
    change = (after - before) / max(abs(before), abs(after), allowed)
    return change if abs(change) > ROUND_OFF else 0.0


def change_text(points: Sequence[Point]) -> str:
    """The last change among the runs, in words.

    Parameters
    ----------
    points : sequence of Point
        Oldest first.

    Returns
    -------
    str
        Empty of a single run.
    """
    for older, newer in zip(points[-2::-1], points[:0:-1], strict=True):
        change = relative_change(older.computed, newer.computed, newer.allowed)
        if change:
            size = (
                f"{100 * change:+.2g}\u00a0%" if math.isfinite(change) else "to or from no number"
            )
            return f"moved {size}, {newer.date[:10]}"
    return f"the same in {len(points)} runs" if len(points) > 1 else ""


def sparkline(points: Sequence[Point]) -> Markup:
    """The values of a quantity over the runs as a small drawing.

    Parameters
    ----------
    points : sequence of Point
        Oldest first. The height of the drawing is their range; a dot marks the last run, and each
        one whose check failed. What differs by round-off alone is a level line.

    Returns
    -------
    Markup
        An SVG element; empty of a single run.
    """
    if len(points) < 2:
        return Markup("")
    values = [point.computed for point in points if math.isfinite(point.computed)]
    low, high = min(values, default=0.0), max(values, default=0.0)
    level = not relative_change(low, high, points[-1].allowed)
    places = []
    for number, point in enumerate(points):
        across = _EDGE + (_WIDTH - 2 * _EDGE) * number / (len(points) - 1)
        share = (
            0.5
            if level or not math.isfinite(point.computed)
            else (point.computed - low) / (high - low)
        )
        places.append((across, _HEIGHT - _EDGE - (_HEIGHT - 2 * _EDGE) * share))
    line = " ".join(f"{x:.1f},{y:.1f}" for x, y in places)
    dots = [
        Markup('<circle cx="{}" cy="{}" r="2.5" class="{}"/>').format(
            f"{x:.1f}", f"{y:.1f}", "passed" if point.passed else "missed"
        )
        for (x, y), point in zip(places, points, strict=True)
        if point is points[-1] or not point.passed
    ]
    words = (
        f"{len(points)} runs, {formatted(low, 4)} to {formatted(high, 4)}: {change_text(points)}"
    )
    return Markup(
        '<svg class="trend" viewBox="0 0 {} {}" width="{}" height="{}" role="img" '
        'aria-label="{}"><polyline points="{}"/>{}</svg>'
    ).format(_WIDTH, _HEIGHT, _WIDTH, _HEIGHT, words, line, Markup("").join(dots))
