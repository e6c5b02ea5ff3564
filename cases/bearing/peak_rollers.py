"""Peak rollers by models from cheap to expensive: loads, closed form, error against time."""

import time
from collections.abc import Callable, Iterable

import numpy as np

from fe_drivetrain.bearing import Bearing, catalogue_bearing, equilibrium, superposed_peak
from fe_drivetrain.common import Floats
from fe_drivetrain.report.suite import Page, Record, grouped

COMBINED = "combined, in one plane"
PEAK_CHART = "Error of the peak roller against time, the star is the model chosen: {}"
WORST_CHART = PEAK_CHART.format("largest over all loads")
TIME, ERROR = "time per load case [µs]", "error [%]"

#: Loads [N, N m]: where closed forms hold, and where they do not.
LOADS = {
    "radial": (0, 0, -4e5, 0, 0),
    "moment": (0, 0, 0, 8e5, 0),
    COMBINED: (2e5, 0, -4e5, 8e5, 0),
    "combined, 45 deg out of plane": (2e5, 0, -4e5, 5.7e5, 5.7e5),
}
CROWN = 0.00045

Solve = Callable[[Bearing, Floats], Floats]
#: Name, changes of the bearing, and how its peak roller is found.
Rung = tuple[str, dict[str, float], Solve]


def closed_form(bearing: Bearing, loads: Floats) -> Floats:
    """Peak rollers from closed forms, each load alone, added."""
    peak = [superposed_peak(bearing, load).max() for load in np.unique(loads, axis=0)]
    return np.full(len(loads), max(peak))


def peaks(solve: Solve) -> Solve:
    """A rung whose answer has all rollers: their peaks."""
    return lambda bearing, loads: solve(bearing, loads).max(axis=1)


FIVE = peaks(lambda bearing, loads: equilibrium(bearing, loads, warm=False).rollers)


def peak_row(kind: str, name: str, seconds: float, found: float, exact: float) -> Record:
    """The peak roller [N] of one rung under a kind of load, and the time [s] that it takes."""
    return {
        "load": kind,
        "model": name,
        TIME: 1e6 * seconds,
        "peak roller [kN]": found / 1e3,
        ERROR: 100.0 * abs(found / exact - 1.0),
    }


def timed_rungs(
    kind: str, rungs: Iterable[Rung], entry: str, loads: Floats, exact: float
) -> list[Record]:
    """Each rung on a bearing of the catalogue, over many equal loads of a kind."""
    rows = []
    for name, changes, solve in rungs:
        bearing = catalogue_bearing(entry, **changes)
        solve(bearing, loads[:1])  # compiles, and fills caches
        begin = time.perf_counter()
        found = float(solve(bearing, loads)[0])
        rows.append(peak_row(kind, name, (time.perf_counter() - begin) / len(loads), found, exact))
    return rows


def largest_of_loads(rows: list[Record]) -> list[Record]:
    """Largest error and time of each model that was solved for all kinds of loads."""
    return [
        {"model": model, **{key: max(row[key] for row in of) for key in (TIME, ERROR)}}
        for model, of in grouped(rows, "model")
        if len(of) == len(LOADS)
    ]


def error_against_time(page: Page, rows: list[Record], chosen: str) -> None:
    """Each rung's error of the peak roller against its time; one is marked.

    The first chart has the largest error and time of all loads, the others each load.
    """
    page.section("Error against time")
    by_load = ((PEAK_CHART.format(kind), of) for kind, of in grouped(rows, "load"))
    for caption, of in ((WORST_CHART, largest_of_loads(rows)), *by_load):
        page.sweep(caption, of, TIME, ERROR, by="model", log="xy", points=True, chosen_curve=chosen)
