"""Statistics of loads by wind speed and turbulence, and the capture matrix."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.studies.load_digest import CHANNELS
from fe_drivetrain.studies.load_totals import LoadStatistics
from fe_drivetrain.turbine_loads.histories.sites import WIND_BIN
from fe_drivetrain.turbine_loads.histories.windows import CaptureMatrix, capture_matrix

TURBULENCE_BIN = 0.02
"""Height of the capture matrix's rows; its columns are `WIND_BIN` wide, about whole m/s."""


@dataclass(frozen=True)
class CaptureTarget:
    """What the capture matrix should hold.

    Attributes
    ----------
    windows : int
        At each mean wind speed.
    low, high : float or None
        Least and largest mean wind speed that it should have [m/s]; those of the files where None.
    """

    windows: int = 6
    low: float | None = None
    high: float | None = None


@dataclass(frozen=True, eq=False)
class Condition:
    """Statistics of the windows of one wind speed, or of one wind speed and turbulence.

    Attributes
    ----------
    wind : float
        Mean wind speed, rounded [m/s].
    turbulence : float or None
        Middle of the class of turbulence intensity; None of all turbulences.
    windows : int
        How many windows.
    statistics : ndarray, (channels, 4)
        Min, mean, max, standard deviation.
    """

    wind: float
    turbulence: float | None
    windows: int
    statistics: Floats


def by_wind(statistics: LoadStatistics) -> list[Condition]:
    """Statistics at each mean wind speed; none where no file has one."""
    joined = statistics.joined
    wind = joined.values[:, CHANNELS.index("wind speed"), 1]
    middle = WIND_BIN * np.round(wind / WIND_BIN)
    found = []
    for speed in np.unique(middle[~np.isnan(middle)]).tolist():
        chosen = middle == speed
        values = joined.chosen(chosen).together()
        found.append(Condition(speed, None, int(chosen.sum()), values))
    return found


def by_wind_and_turbulence(statistics: LoadStatistics) -> list[Condition]:
    """Statistics at each mean wind speed and turbulence; none where no file has a wind speed."""
    joined = statistics.joined
    wind = joined.values[:, CHANNELS.index("wind speed")]
    bins = np.column_stack(
        [
            WIND_BIN * np.round(wind[:, 1] / WIND_BIN),
            TURBULENCE_BIN * (np.floor(wind[:, 3] / wind[:, 1] / TURBULENCE_BIN) + 0.5),
        ]
    )
    found = []
    for speed, turbulence in np.unique(bins[~np.isnan(bins).any(axis=1)], axis=0).tolist():
        chosen = (bins == [speed, turbulence]).all(axis=1)
        values = joined.chosen(chosen).together()
        found.append(Condition(speed, turbulence, int(chosen.sum()), values))
    return found


@dataclass(frozen=True, eq=False)
class Capture:
    """How many windows each wind speed has, and how many it needs.

    Attributes
    ----------
    matrix : CaptureMatrix
        Windows by turbulence and mean wind speed.
    middles : ndarray, (c,)
        Middle of each column [m/s].
    asked, missing : ndarray, (c,)
        Windows that each column should have, and that it still needs.
    target : CaptureTarget
        What was asked for.
    unknown : int
        Windows without a wind speed, which are in none.
    """

    matrix: CaptureMatrix
    middles: Floats
    asked: Ints
    missing: Ints
    target: CaptureTarget
    unknown: int

    @property
    def sentence(self) -> str:
        """How many windows are missing."""
        if not self.missing.any():
            return f"Capture matrix: every wind speed has {self.target.windows} windows or more."
        return (
            f"Capture matrix: {int(self.missing.sum())} windows are missing at "
            f"{int(np.count_nonzero(self.missing))} of {int(np.count_nonzero(self.asked))} wind "
            "speeds."
        )


def captured(statistics: LoadStatistics, target: CaptureTarget) -> Capture | None:
    """Count windows by wind speed and turbulence; None where no file has a wind speed.

    Parameters
    ----------
    statistics : LoadStatistics
        All windows.
    target : CaptureTarget
        What the matrix should hold.
    """
    wind = statistics.joined.values[:, CHANNELS.index("wind speed")]
    known = ~np.isnan(wind).any(axis=1)
    if not known.any():
        return None
    mean, deviation = wind[known, 1], wind[known, 3]
    least = min(float(mean.min()), np.inf if target.low is None else target.low)
    highest = max(float(mean.max()), -np.inf if target.high is None else target.high)
    low = WIND_BIN * np.floor(least / WIND_BIN + 0.5) - 0.5 * WIND_BIN
    columns = np.arange(low, highest + WIND_BIN, WIND_BIN)
    most = float((deviation / mean).max())
    rows = TURBULENCE_BIN * np.arange(np.floor(most / TURBULENCE_BIN) + 2)
    matrix = capture_matrix(mean, deviation, columns, rows)
    middles = 0.5 * (columns[1:] + columns[:-1])
    within = (middles >= (target.low or -np.inf)) & (middles <= (target.high or np.inf))
    asked = np.where(within, target.windows, 0)
    missing = np.maximum(asked - matrix.counts.sum(axis=0), 0)
    return Capture(matrix, middles, asked, missing, target, int((~known).sum()))


def winds_not_used(target: CaptureTarget, capture: Capture | None) -> list[str]:
    """A sentence on a range of winds that says nothing, since no file has a wind speed."""
    if target.low is None or capture is not None:
        return []
    return [
        f"`CaptureTarget(low={target.low}, high={target.high})` m/s is not used: no file has a "
        "wind speed. Name its channel, as in `ChannelMap(channels={'wind speed': 'Vhub'})`."
    ]
