"""Histories of a drivetrain in time: how they are read, and what they are of a base that moves."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.drivetrain_events import BaseMoves, event_of
from fe_drivetrain.procedure.travelling_planets import STAND
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.history_options import HistoryOptions
from fe_drivetrain.turbine_loads.histories.damage import SLOPES
from fe_drivetrain.turbine_loads.hub_loads.base_history import (
    BaseFacts,
    BaseHistory,
    BaseReading,
    read_base_history,
)
from fe_drivetrain.turbine_loads.hub_loads.drive_history import DriveHistory, read_drive

OPERATION, BASE = "operation", "base"
"""Events that histories drive: the hub's loads, or the base."""

COARSE = 0.05
"""What lines between samples may miss of an acceleration before it is said."""

_ROUNDED = 1e-3  # share of the time between samples, as files of few digits have it


@dataclass(frozen=True, kw_only=True)
class OperationOptions(HistoryOptions):
    """How histories drive a drivetrain, and how what it does is counted.

    Attributes
    ----------
    channels, rotor_speed_rpm, skip
        How files are read, see `HistoryOptions`.
    slopes : Sequence[float]
        Exponents of S-N curves of damage-equivalent loads.
    step : float
        Step of integration [s].
    until : float or None
        Time after the first sample at which a history is left; its end where None [s].
    base : BaseReading or None
        How histories of the base are read; None where they are of the hub's loads.
    """

    slopes: Sequence[float] = SLOPES
    step: float = 5e-3
    until: float | None = None
    base: BaseReading | None = None

    def read(self, file: Path) -> DriveHistory | BaseHistory:
        """The history in a file.

        Parameters
        ----------
        file : Path
            The file.

        Raises
        ------
        InputError
            It cannot be read, has not what is needed, or has samples closer than steps.
        """
        found = self.sampled(file)
        self.require_spacing(found, file)
        return found

    def require_spacing(self, history: DriveHistory | BaseHistory, file: Path) -> None:
        """Refuse a history whose samples are closer than steps.

        Parameters
        ----------
        history : DriveHistory or BaseHistory
            The history.
        file : Path
            Its file, for messages.

        Raises
        ------
        InputError
            They are.
        """
        between = spacing(history)
        if self.step > between * (1.0 + _ROUNDED):
            raise InputError(
                f"{argument('step')} is {self.step:g} s but samples of '{file}' are {between:g} s "
                f"apart, between which steps would leave some out: give {between:g} s or less"
            )

    def sampled(self, file: Path) -> DriveHistory | BaseHistory:
        """The history in a file, however close its samples are.

        Parameters
        ----------
        file : Path
            The file.

        Raises
        ------
        InputError
            It cannot be read, or has not what is needed.
        """
        if self.base is None:
            return read_drive(file, self.names, self.skip)
        return read_base_history(file, self.names, self.skip, self.base)


def spacing(history: DriveHistory | BaseHistory) -> float:
    """Time between samples of a history [s].

    Parameters
    ----------
    history : DriveHistory or BaseHistory
        The history.
    """
    return float(np.median(np.diff(history.time)))


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
    found: Findings, moved: Mapping[str, BaseFacts], values: Mapping[str, float | str]
) -> None:
    """State how the base moves in each history, and what was assumed to read it.

    Parameters
    ----------
    found : Findings
        Takes rows, assumptions and notes.
    moved : Mapping[str, BaseFacts]
        How it moves, by the short names of histories.
    values : Mapping[str, float or str]
        Values of the event that were given.
    """
    found.data("base_motion", [_row(name, one) for name, one in moved.items()])
    if "mean" not in values:
        why = "assumed: a nacelle that goes on standing has none; what a sensor shows is gravity"
        found.assume("mean of each acceleration", "removed", "", why)
    if any(one.turns for one in moved.values()) and not {"x", "y", "z"} & set(values):
        found.assume("place of the sensor", "the rotor's centre", "", "assumed: not stated")
    missed = max(one.missed for one in moved.values())
    if missed > COARSE:
        found.note(
            f"Lines between samples miss up to {percent_text(missed)} of the base's acceleration: "
            "sample faster, or filter what is above a tenth of the sampling rate."
        )


def _row(name: str, one: BaseFacts) -> Record:
    row: Record = {"file": name, "length [s]": one.seconds, "read": one.read}
    for axis, largest, rms in zip("xyz", one.largest, one.rms, strict=False):
        row[f"largest along {axis} [m/s^2]"] = largest
        row[f"RMS along {axis} [m/s^2]"] = rms
    for axis, about in zip("xyz" if one.turns else "", one.largest[3:], strict=False):
        row[f"largest about {axis} [deg/s^2]"] = math.degrees(about)
    row["mean of the file, largest [m/s^2]"] = one.mean
    row["missed between samples [% of RMS]"] = 100.0 * one.missed
    return row
