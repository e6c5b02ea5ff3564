"""Peak rollers by models from cheap to expensive: loads, closed form, error against time."""

from collections.abc import Callable

import numpy as np

from fe_drivetrain.bearing import Bearing, equilibrium, superposed_peak
from fe_drivetrain.common import Floats
from fe_drivetrain.report.suite import Page, Record

#: Loads [N, N m]: where closed forms hold, and where they do not.
LOADS = {
    "radial": (0, 0, -4e5, 0, 0),
    "moment": (0, 0, 0, 8e5, 0),
    "combined, in one plane": (2e5, 0, -4e5, 8e5, 0),
    "combined, 45 deg out of plane": (2e5, 0, -4e5, 5.7e5, 5.7e5),
}
CROWN = 0.00045


def closed_form(bearing: Bearing, loads: Floats) -> Floats:
    """Peak rollers from closed forms, each load alone, added."""
    peak = [superposed_peak(bearing, load).max() for load in np.unique(loads, axis=0)]
    return np.full(len(loads), max(peak))


def peaks(solve: Callable[[Bearing, Floats], Floats]) -> Callable[[Bearing, Floats], Floats]:
    """A rung whose answer has all rollers: their peaks."""
    return lambda bearing, loads: solve(bearing, loads).max(axis=1)


FIVE = peaks(lambda bearing, loads: equilibrium(bearing, loads, warm=False).rollers)


def error_against_time(page: Page, rows: list[Record]) -> None:
    """Each rung's error of the peak roller against its time, load by load."""
    page.section("Error against time")
    for kind in LOADS:
        page.sweep(
            f"Peak roller, {kind}",
            [row for row in rows if row["load"] == kind],
            "time per load case [µs]",
            "error [%]",
            by="model",
            log="xy",
            points=True,
        )
