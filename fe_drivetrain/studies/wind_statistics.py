"""Statistics of hub loads as records: all samples together, by wind, by wind and turbulence."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.load_digest import CHANNELS, UNIT_OF
from fe_drivetrain.studies.load_totals import LoadStatistics
from fe_drivetrain.studies.load_winds import by_wind, by_wind_and_turbulence
from fe_drivetrain.turbine_loads.histories.windows import COLUMNS

_SCALE = {"N": (1e3, "kN"), "N m": (1e3, "kN m"), "rad/s": (1.0, "rad/s"), "m/s": (1.0, "m/s")}

_BY_WIND = ("Fx", "Mx", "radial force", "bending moment")


def channel_rows(statistics: LoadStatistics) -> list[Record]:
    """Records of each channel that the files have, over all samples together."""
    found = [_record(name, of) for name, of in zip(CHANNELS, statistics.overall, strict=True)]
    return [row for row in found if row]


def wind_rows(statistics: LoadStatistics) -> list[Record]:
    """Records of the main loads at each mean wind speed; none where no file has one."""
    return [
        {"wind [m/s]": one.wind, "windows": one.windows, **row}
        for one in by_wind(statistics)
        for name in _BY_WIND
        if (row := _record(name, one.statistics[CHANNELS.index(name)]))
    ]


def bending_rows(statistics: LoadStatistics) -> list[Record]:
    """Records of the bending moment at each mean wind speed and turbulence intensity."""
    place = CHANNELS.index("bending moment")
    return [
        {
            "wind [m/s]": one.wind,
            "turbulence [%]": 100.0 * float(one.turbulence or 0.0),
            "windows": one.windows,
            **{
                f"{name} [kN m]": value / 1e3
                for name, value in zip(COLUMNS, one.statistics[place].tolist(), strict=True)
            },
        }
        for one in by_wind_and_turbulence(statistics)
        if not np.isnan(one.statistics[place]).any()
    ]


def _record(name: str, values: Sequence[float]) -> Record:
    """Statistics of a channel in the unit that is shown; empty where the files lack it."""
    if np.isnan(values).any():
        return {}
    factor, unit = _SCALE[UNIT_OF[name]]
    shown = [float(value) / factor for value in values]
    return {"channel": f"{name} [{unit}]", **dict(zip(COLUMNS, shown, strict=True))}
