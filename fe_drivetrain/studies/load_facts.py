"""What the hub loads of a study are, without their samples: statistics, times, channels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.comparison.time_weighted import weighted_statistics
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.shown_units import SHOWN_UNITS
from fe_drivetrain.studies.study_loads import EnteredLoads
from fe_drivetrain.turbine_loads.histories.windows import COLUMNS
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory


@dataclass(frozen=True)
class HistoryFacts:
    """Time of a load history, and the channels of its file.

    Attributes
    ----------
    name : str
        Its name.
    start, end, step : float
        First and last time, and time between two samples [s].
    samples : int
        Number of its load steps.
    share : float
        Its share in the time of all histories.
    channels : str
        Columns that were read, with their sign and rotation.
    """

    name: str
    start: float
    end: float
    step: float
    samples: int
    share: float
    channels: str


@dataclass(frozen=True, eq=False)
class LoadFacts:
    """Hub loads of a study.

    Attributes
    ----------
    statement : str
        What they are, as a sentence.
    own : bool
        Whether they are the user's.
    gravity : float
        Acceleration along -z that gives all parts their weight [m/s^2]; 0 where it is left out.
    statistics : ndarray, (6 + 6 m, 4)
        Min, mean, max, standard deviation of each component at the hub and at m load points, with
        their weights, over all histories [N, N m].
    mean : ndarray, (10 + 6 m,)
        Factors of the unit loads of the mean load with all weights.
    histories : tuple of HistoryFacts
        Each history.
    """

    statement: str
    own: bool
    gravity: float
    statistics: Floats
    mean: Floats
    histories: tuple[HistoryFacts, ...]

    __repr__ = short_repr


def load_facts(scene: Scene, loads: EnteredLoads) -> LoadFacts:
    """What hub loads are.

    Parameters
    ----------
    scene : Scene
        The scene that they enter.
    loads : EnteredLoads
        The loads.
    """
    given = loads.given
    statistics = weighted_statistics(loads.together.values, given.weights)
    mean = statistics[:, 1]
    weights = [0.0, 0.0, -given.gravity, scene.gearbox.weight]
    return LoadFacts(
        given.statement,
        given.own,
        given.gravity,
        statistics,
        np.concatenate([mean[:6], weights, mean[6:]]),
        tuple(_facts(history, given.seconds) for history in given.histories),
    )


def history_rows(histories: Sequence[HistoryFacts]) -> list[Record]:
    """Records of histories: when each is, and its share of the time."""
    return [
        {
            "history": one.name,
            "from [s]": one.start,
            "to [s]": one.end,
            "step [s]": one.step,
            "samples": one.samples,
            "share of the time [%]": 100.0 * one.share,
        }
        for one in histories
    ]


def channels_of(history: LoadHistory) -> str:
    """Columns of its file that were read, with their sign and rotation."""
    return str(history.attributes.get("channels", "as in the file"))


def _facts(history: LoadHistory, whole: float) -> HistoryFacts:
    return HistoryFacts(
        history.name,
        float(history.time[0]),
        float(history.time[-1]),
        history.step,
        len(history),
        history.seconds / whole,
        channels_of(history),
    )


def hub_load_rows(statistics: Floats) -> list[Record]:
    """Records of the range of each hub load, where a wrong sign or unit shows [kN, kN m].

    Parameters
    ----------
    statistics : ndarray, (6 or more, 4)
        Min, mean, max, standard deviation of each component [N, N m].
    """
    return [
        {
            "component": f"{component} [{unit}]",
            **dict(zip(COLUMNS, (values / 1e3).tolist(), strict=True)),
        }
        for component, unit, values in zip(FORCES, SHOWN_UNITS, statistics, strict=False)
    ]
