"""Bands over errors: columns of a record, what is required, and bins of a histogram."""

from collections.abc import Iterable
from itertools import pairwise
from typing import Any

import numpy as np

from fe_drivetrain.report.suite import Record, column

#: Required: share of the bands that hold, and median of the bands over their errors.
COVERED, WIDE = 0.95, 5.0
#: Edges of the histogram's bins.
EDGES = (0.0, 0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 10.0, np.inf)
BINS = [
    f"{low:g} to {high:g}" if high < np.inf else f"above {low:g}" for low, high in pairwise(EDGES)
]

BAND, ERROR, RATIO = "band, relative", "error, relative", "band over error"
LEFT, HOLDS = "left of the reference, relative", "holds"


def coverage(rows: list[Record]) -> Record:
    """How many bands hold, and how wide they are."""
    return {
        "bands that hold": sum(column(rows, HOLDS)),
        "coverage [%]": 100 * float(np.mean(column(rows, HOLDS))),
        "median band over error": float(np.median(column(rows, RATIO))),
    }


def histogram(kinds: Iterable[tuple[str, list[Record]]]) -> list[Any]:
    """Bars of bands over errors, by kind."""
    return [{"type": "bar", "name": kind, "x": BINS, "y": counted(rows)} for kind, rows in kinds]


def counted(rows: list[Record]) -> list[int]:
    """How many bands over errors are in each of the `BINS`."""
    return [int(n) for n in np.histogram(column(rows, RATIO), EDGES)[0]]
