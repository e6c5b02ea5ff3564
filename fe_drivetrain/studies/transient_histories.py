"""Histories of a drivetrain in time: how they are read, and what they are of a base that moves."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.drivetrain_events import BaseMoves, event_of
from fe_drivetrain.procedure.travelling_planets import STAND
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.transient_digest import OperationOptions, spacing
from fe_drivetrain.turbine_loads.hub_loads.base_history import BaseHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import short_name

OPERATION, BASE = "operation", "base"
"""Events that histories drive: the hub's loads, or the base."""

COARSE = 0.05
"""What lines between samples may miss of an acceleration before it is said."""


def takes_histories(event: str, given: bool) -> bool:
    """Whether an event is driven by histories.

    Parameters
    ----------
    event : str
        Name of the event.
    given : bool
        Whether any are given.

    Raises
    ------
    InputError
        Some are given, and the event takes none.
    """
    if given and event not in (OPERATION, BASE):
        raise InputError(
            f"event {event} takes no histories: leave {argument('loads')} out, or ask for "
            f"{OPERATION} or {BASE}"
        )
    return event == OPERATION or given


def no_coarser(options: OperationOptions, file: Path) -> OperationOptions:
    """Options whose steps are no longer than the time between samples of a history.

    Parameters
    ----------
    options : OperationOptions
        How histories are read.
    file : Path
        The history.

    Raises
    ------
    InputError
        It cannot be read, or has not what is needed.
    """
    return replace(options, step=min(options.step, spacing(options.sampled(file))))


def driving_options(
    event: str,
    values: Mapping[str, float | str],
    options: OperationOptions,
    planets_travel: bool,
) -> OperationOptions:
    """How histories are read in an event.

    Parameters
    ----------
    event : str
        "operation" or "base".
    values : Mapping[str, float or str]
        Values of the event.
    options : OperationOptions
        What else is asked of histories.
    planets_travel : bool
        Whether planets are to travel.

    Raises
    ------
    InputError
        A value does not apply.
    """
    if event == OPERATION:
        if values:
            raise InputError(f"operation has no value {next(iter(values))!r}: leave it out")
        return options
    if values.get("file"):
        raise InputError(
            f"{argument('loads')} and file both say how the base moves: leave one of them out"
        )
    if planets_travel:
        raise InputError(
            f"planets do not travel under histories: let {argument('planets')} {STAND}, or give "
            f"the motion of the base as file in place of {argument('loads')}"
        )
    happens = event_of(event, values)
    assert isinstance(happens, BaseMoves)
    return replace(options, base=happens.reading())


def state_base(
    found: Findings,
    first: BaseHistory,
    files: Sequence[Path],
    options: OperationOptions,
    values: Mapping[str, float | str],
) -> None:
    """State how the base moves in each history, and what was assumed to read it.

    Parameters
    ----------
    found : Findings
        Takes rows, assumptions and notes.
    first : BaseHistory
        The first history.
    files : sequence of Path
        All of them.
    options : OperationOptions
        How they are read.
    values : Mapping[str, float or str]
        Values of the event that were given.
    """
    rows, turns, missed = [], False, 0.0
    for k, file in enumerate(files):
        one = options.read(file) if k else first
        assert isinstance(one, BaseHistory)
        rows.append(_row(short_name(file, files), one))
        turns, missed = turns or one.turns, max(missed, one.missed)
    found.data("base_motion", rows)
    if "mean" not in values:
        why = "assumed: a nacelle that goes on standing has none; what a sensor shows is gravity"
        found.assume("mean of each acceleration", "removed", "", why)
    if turns and not {"x", "y", "z"} & set(values):
        found.assume("place of the sensor", "the rotor's centre", "", "assumed: not stated")
    if missed > COARSE:
        found.note(
            f"Lines between samples miss up to {percent_text(missed)} of the base's acceleration: "
            "sample faster, or filter what is above a tenth of the sampling rate."
        )


def _row(name: str, one: BaseHistory) -> Record:
    a = one.accelerations
    row: Record = {"file": name, "length [s]": one.seconds, "read": one.read}
    for k, axis in enumerate("xyz"):
        row[f"largest along {axis} [m/s^2]"] = float(np.abs(a[:, k]).max())
        row[f"RMS along {axis} [m/s^2]"] = float(np.sqrt((a[:, k] ** 2).mean()))
    for k, axis in enumerate("xyz" if one.turns else ""):
        row[f"largest about {axis} [deg/s^2]"] = float(np.degrees(np.abs(a[:, 3 + k]).max()))
    row["mean of the file, largest [m/s^2]"] = float(np.abs(one.mean[:3]).max())
    row["missed between samples [% of RMS]"] = 100.0 * one.missed
    return row
