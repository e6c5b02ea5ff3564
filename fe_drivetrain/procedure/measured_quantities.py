"""What is to be measured at interfaces of gearbox, pitch and yaw system, and tables of it.

The package's list is ``measured_quantities.yaml``, Tables 4.5, 5.3, 6.3 and 6.4 of PROTEST 2010. A
table is filled from channels by name, simulated or measured: what a list asks for and no channel
gives is a row that says so.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cache
from importlib.resources import files as package_files
from typing import Any, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping, validated
from fe_drivetrain.procedure.duty import thermal_torque
from fe_drivetrain.turbine_loads.histories.cycles import rainflow_cycles
from fe_drivetrain.turbine_loads.histories.damage import damage_equivalent_load
from fe_drivetrain.turbine_loads.histories.levels import even_levels, time_at_level

Analysis = Literal["extreme", "mean", "durations", "cycles", "peak", "rms", "rms durations"]
"""Asked for: of a load or motion its extremes, mean, time at level, rainflow cycles, largest size,
worst root mean square of ten minutes, time at level of root mean squares."""

LEVELS = 20
"""Number of levels at which time is counted."""

_SECOND = 1.0  # of a root mean square of which durations are taken


class _Row(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class Quantities(_Row):
    """Channels of one kind at one interface.

    `channels` are names in the unit `unit`; `analyses` what is asked for of each; `rank`
    "mandatory" or "recommended" where the source has it.
    """

    table: str
    interface: str
    kind: Literal["loads", "kinematics", "dynamics", "synchronous", "temperature"]
    side: Literal["external", "internal"]
    unit: str
    channels: tuple[str, ...]
    analyses: tuple[Analysis, ...] = ()
    rank: str = ""
    note: str = ""


class QuantityList(_Row):
    """All that is asked for."""

    title: str
    quantities: tuple[Quantities, ...]

    def of(self, table: str) -> tuple[Quantities, ...]:
        """Rows of one table of the source.

        Parameters
        ----------
        table : str
            As in "5.3".

        Raises
        ------
        InputError
            There is no such table.
        """
        found = tuple(q for q in self.quantities if q.table == table)
        if not found:
            known = dict.fromkeys(q.table for q in self.quantities)
            raise InputError(f"no table {table!r} of quantities: use one of {', '.join(known)}")
        return found


@cache
def listed_quantities() -> QuantityList:
    """Tables 4.5, 5.3, 6.3 and 6.4 of PROTEST 2010."""
    name = "measured_quantities.yaml"
    text = (package_files("fe_drivetrain.procedure") / name).read_text("utf-8")
    return validated(QuantityList, parse_mapping(text, name), name)


def filled_table(
    quantities: tuple[Quantities, ...],
    channels: Mapping[str, Floats],
    step: float,
    slope: float = 4.0,
) -> list[dict[str, Any]]:
    """Every channel that is asked for, with its analyses, or without where it is not given.

    Parameters
    ----------
    quantities : tuple of Quantities
        As `QuantityList.of` gives them.
    channels : mapping of str to ndarray
        Histories by name, of one step, in the units of the list.
    step : float
        Between two samples [s].
    slope : float
        Exponent of the damage-equivalent range at 1 Hz, of cycles.

    Returns
    -------
    list of dict
        Table, interface, channel, unit, rank, given, and "mean", "least", "largest", "equivalent
        range", "rms of 600 s", "levels" with "seconds", each None where it is not asked for.
    """
    rows = []
    for of in quantities:
        for name in of.channels:
            signal = channels.get(name)
            row: dict[str, Any] = {
                "table": of.table,
                "interface": of.interface,
                "channel": name,
                "unit": of.unit,
                "rank": of.rank,
                "given": signal is not None,
            }
            given = {} if signal is None else _analysed(of.analyses, signal, step, slope)
            rows.append(row | {key: given.get(key) for key in _COLUMNS})
    return rows


_COLUMNS = ("mean", "least", "largest", "equivalent range", "rms of 600 s", "levels", "seconds")


def _analysed(
    analyses: tuple[Analysis, ...], signal: Floats, step: float, slope: float
) -> dict[str, Any]:
    values = np.asarray(signal, dtype=np.float64)
    found: dict[str, Any] = {}
    if "mean" in analyses:
        found["mean"] = float(values.mean())
    if "extreme" in analyses:
        found |= {"least": float(values.min()), "largest": float(values.max())}
    if "peak" in analyses:
        found["largest"] = float(np.abs(values).max())
    if "cycles" in analyses:
        cycles = [rainflow_cycles(values)]
        found["equivalent range"] = damage_equivalent_load(cycles, len(values) * step, slope)
    if "rms" in analyses or "rms durations" in analyses:
        found["rms of 600 s"] = thermal_torque(values, step)
    if "durations" in analyses or "rms durations" in analyses:
        at, each = values, step
        if "rms durations" in analyses:
            length = max(round(_SECOND / step), 1)
            whole = values[: len(values) // length * length].reshape(-1, length)
            at, each = np.sqrt((whole**2).mean(axis=1)), length * step
        levels = time_at_level(at, each, even_levels(float(at.min()), float(at.max()), LEVELS))
        found |= {"levels": levels.edges.tolist(), "seconds": levels.amount.tolist()}
    return found
