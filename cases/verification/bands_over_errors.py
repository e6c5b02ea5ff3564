"""Bands over errors: columns of a record, what is required, and bins of a histogram."""

from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import numpy as np

from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, column

#: Required: share of the bands that hold, and median of the bands over their errors.
COVERED, WIDE = 0.95, 5.0
#: Edges of the histogram's bins.
EDGES = (0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 10.0, np.inf)
BINS = [
    f"{low:g} to {high:g}" if high < np.inf else f"above {low:g}" for low, high in pairwise(EDGES)
]

BAND, ERROR, RATIO = "band, relative", "error, relative", "band over error"
LEFT, HOLDS = "left of the reference, relative", "holds"
HISTOGRAM = "Histogram of bands over true errors: below 1 a band is too small"


def coverage(rows: list[Record]) -> Record:
    """How many bands hold, and how wide they are."""
    return {
        "bands that hold": sum(column(rows, HOLDS)),
        "coverage [%]": 100 * float(np.mean(column(rows, HOLDS))),
        "median band over error": float(np.median(column(rows, RATIO))),
    }


def share_that_holds(page: Page, rows: list[Record], quick: bool) -> KeyFigure:
    """Share of the bands that hold; a quick run has too few for the share that is required."""
    name, share = "bands that contain the true value [%]", 100 * float(np.mean(column(rows, HOLDS)))
    if quick:
        return page.value(name, share)
    return page.value(name, share, at_least=100 * COVERED, by="asked for")


def words_of_share(rows: list[Record], quick: bool) -> str:
    """How many of the bands hold, and what that says of the share that is required."""
    hold, asked = sum(column(rows, HOLDS)), f"{100 * COVERED:g}\u00a0%"
    share = 100 * hold / len(rows)
    judged = f"{asked} are asked for"
    if quick:
        judged = f"too few to confirm {asked}"
    elif share < 100 * COVERED:
        judged = f"not the {asked} that are asked for"
    contain = f"{hold} of {len(rows)} uncertainty bands contain the true value"
    return f"{contain} ({formatted(share, 3)}\u00a0%: {judged})"


def histogram(kinds: Iterable[tuple[str, list[Record]]]) -> list[Any]:
    """Bars of bands over errors, by kind."""
    return [{"type": "bar", "name": kind, "x": BINS, "y": counted(rows)} for kind, rows in kinds]


def counted(rows: list[Record]) -> list[int]:
    """How many bands over errors are in each of the `BINS`."""
    return [int(n) for n in np.histogram(column(rows, RATIO), EDGES)[0]]
