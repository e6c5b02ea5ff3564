"""Extremes of hub loads and reactions: how large, in which file, when, and what is around it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats, rounded
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory

HUB = "hub"
AROUND = 30.0
"""Time before and after the largest reaction that is shown [s]."""
_MOST_POINTS = 1500


@dataclass(frozen=True)
class Extreme:
    """The largest value of a load over all histories.

    Attributes
    ----------
    place : str
        "hub", a bearing, or "gearbox".
    load : str
        Which load, as in "My" or "radial force".
    unit : str
        "kN" or "kN m".
    value : float
        The value with its sign; of a resultant its size.
    history : str
        In which history.
    time : float
        When, by the clock of that history [s].
    number : int
        Which of the histories, from 0: several may have one name.
    """

    place: str
    load: str
    unit: str
    value: float
    history: str
    time: float
    number: int

    def row(self) -> Record:
        """As a record for a table; forces and moments have columns of their own."""
        return {
            "place": self.place,
            "load": self.load,
            "largest [kN]": self.value if self.unit == "kN" else None,
            "largest [kN m]": self.value if self.unit == "kN m" else None,
            "file": self.history,
            "time [s]": self.time,
        }


def load_extremes(
    histories: Sequence[LoadHistory], reactions: Mapping[str, Sequence[Floats]]
) -> list[Extreme]:
    """The largest of each hub load, and of each reaction its radial and axial force and its moment.

    Parameters
    ----------
    histories : sequence of LoadHistory
        Hub loads.
    reactions : mapping of str to sequence of ndarray
        By bearing, and "gearbox": (n, 6) of each history [N, N m].

    Returns
    -------
    list of Extreme
        The hub first; a reaction that is zero throughout is left out.
    """
    found = [
        _largest(
            HUB, name, "kN" if k < 3 else "kN m", histories, [h.loads[:, k] for h in histories]
        )
        for k, name in enumerate(FORCES)
    ]
    for place, each in reactions.items():
        ways: list[tuple[str, str, list[Floats]]] = [
            ("radial force", "kN", [np.hypot(r[:, 1], r[:, 2]) for r in each]),
            ("axial force Fx", "kN", [r[:, 0] for r in each]),
            ("tilting moment", "kN m", [np.hypot(r[:, 4], r[:, 5]) for r in each]),
        ]
        size = max(float(np.abs(r).max()) for r in each)
        found += [
            _largest(place, name, unit, histories, values)
            for name, unit, values in ways
            if max(float(np.abs(v).max()) for v in values) > 1e-6 * size
        ]
    return found


def _largest(
    place: str, load: str, unit: str, histories: Sequence[LoadHistory], values: Sequence[Floats]
) -> Extreme:
    peaks = [int(np.abs(of).argmax()) for of in values]
    which = int(np.argmax([abs(of[at]) for of, at in zip(values, peaks, strict=True)]))
    history, at = histories[which], peaks[which]
    return Extreme(
        place,
        load,
        unit,
        float(values[which][at]) / 1e3,
        history.name,
        float(history.time[at]),
        which,
    )


@dataclass(frozen=True, eq=False)
class Around:
    """Radial force of each bearing around the largest of them.

    Attributes
    ----------
    history : str
        In which history.
    time : ndarray, (n,)
        By the clock of that history [s].
    radial : mapping of str to ndarray, (n,)
        By bearing [N].
    peak : Extreme
        The largest.
    """

    history: str
    time: Floats
    radial: Mapping[str, Floats]
    peak: Extreme

    def table(self) -> dict[str, object]:
        """As plain data, with units in the keys."""
        return {
            "file": self.history,
            "time [s]": rounded(self.time),
            "radial force [kN]": {n: rounded(values / 1e3) for n, values in self.radial.items()},
            "bearing": self.peak.place,
            "peak [kN]": self.peak.value,
            "at [s]": self.peak.time,
        }


def around_largest(
    histories: Sequence[LoadHistory],
    reactions: Mapping[str, Sequence[Floats]],
    extremes: Sequence[Extreme],
) -> Around:
    """Radial force of each bearing from half a minute before the largest to half a minute after.

    Parameters
    ----------
    histories : sequence of LoadHistory
        Hub loads.
    reactions : mapping of str to sequence of ndarray
        By bearing: (n, 6) of each history [N, N m].
    extremes : sequence of Extreme
        What `load_extremes` returns.

    Returns
    -------
    Around
    """
    peak = max(
        (one for one in extremes if one.place in reactions and one.load == "radial force"),
        key=lambda one: one.value,
    )
    time = histories[peak.number].time
    window = np.flatnonzero(np.abs(time - peak.time) <= AROUND)
    window = window[:: max(1, -(-len(window) // _MOST_POINTS))]
    shown = {name: each[peak.number][window] for name, each in reactions.items()}
    radial = {name: np.hypot(of[:, 1], of[:, 2]) for name, of in shown.items()}
    return Around(peak.history, time[window], radial, peak)
