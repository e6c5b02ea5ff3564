"""Step 5 and 6 on channels: windows of a campaign by wind, and measured against computed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.procedure.channels import ChannelFile, Channels, read_channels
from fe_drivetrain.procedure.identified_shaft import Outcome, identified
from fe_drivetrain.procedure.methods import MethodAnswer
from fe_drivetrain.procedure.project import Capture, Compared, Comparison
from fe_drivetrain.report.results import Results, Verdict, judge, read_results
from fe_drivetrain.turbine_loads.histories.cycles import rainflow_cycles
from fe_drivetrain.turbine_loads.histories.damage import damage_equivalent_load
from fe_drivetrain.turbine_loads.histories.windows import (
    CaptureMatrix,
    capture_matrix,
    window_statistics,
)

WIND = "wind speed"
"""Channel of a capture matrix."""

_TURBULENCE = np.arange(0.0, 0.52, 0.02)


def captured(capture: Capture, folder: Path) -> CaptureMatrix:
    """Windows of ten minutes by mean wind, in bins of 1 m/s about whole numbers, and turbulence.

    Parameters
    ----------
    capture : Capture
        File and range of winds.
    folder : Path
        What the file's name is relative to.

    Returns
    -------
    CaptureMatrix

    Raises
    ------
    InputError
        The file cannot be read, or has no wind in m/s.
    """
    channels = read_channels(capture.files, folder, frozenset({WIND}))
    if channels.units[WIND] != "m/s":
        raise InputError(f"{channels.source}: {WIND} must be in m/s: correct it under units")
    wind = channels.of(WIND)
    windows = window_statistics(np.arange(len(wind)) * channels.step, wind[:, None])
    low, high = round(capture.winds[0]), round(capture.winds[1])
    return capture_matrix(
        windows.values[:, 0, 1],
        windows.values[:, 0, 3],
        np.arange(low - 0.5, high + 1.0),
        _TURBULENCE,
    )


def windows_by_wind(matrix: CaptureMatrix) -> Mapping[int, int]:
    """Windows for each mean wind in whole m/s, over all turbulence.

    Parameters
    ----------
    matrix : CaptureMatrix
        With bins of 1 m/s about whole numbers.
    """
    winds = 0.5 * (matrix.wind[1:] + matrix.wind[:-1])
    counts = matrix.counts.sum(axis=0)
    return {round(float(v)): int(n) for v, n in zip(winds, counts, strict=True)}


def statistic(values: Floats, step: float, which: Compared) -> float:
    """One statistic of a channel, in its unit.

    Parameters
    ----------
    values : ndarray, (n,)
        The channel.
    step : float
        Between two samples [s].
    which : Compared
        Mean, standard deviation, least, largest, or damage-equivalent load at 1 Hz.
    """
    if which.statistic == "equivalent load":
        cycles = [rainflow_cycles(values)]
        return damage_equivalent_load(cycles, len(values) * step, which.slope)
    found = {
        "mean": values.mean(),
        "standard deviation": values.std(),
        "least": values.min(),
        "largest": values.max(),
    }
    return float(found[which.statistic])


def faults_of_files(
    capture: Capture | None, comparison: Comparison, drivetrain: str, folder: Path
) -> tuple[str, ...]:
    """Why files of campaign and comparison are none of one measurement, in sentences.

    Channels that a case wrote are no measurement, and those of another drivetrain none of this one.
    Wind and measured channels are of one run where they begin and end together, or are one file.

    Parameters
    ----------
    capture : Capture or None
        Capture of step 5.
    comparison : Comparison
        Comparison of step 6, whose file is there.
    drivetrain : str
        Hash of the project's.
    folder : Path
        What names of files are relative to.
    """
    faults = []
    made = _made_by(comparison.measured, folder)
    if made is not None:
        faults.append(
            f"{comparison.measured.file} is no measurement: {made.case} made it by a model: record "
            "these channels on the machine"
        )
    for name, given in (("measured", comparison.measured), ("computed", comparison.computed)):
        by = _made_by(given, folder) if given else None
        if by is not None and drivetrain not in {one.hash for one in by.drivetrains}:
            of = ", ".join(repr(one.title) for one in by.drivetrains) or "no stated drivetrain"
            faults.append(
                f"{name} channels of {by.case} are of {of}: give those of this drivetrain"
            )
    faults += _twice(comparison, folder)
    if capture is not None and (folder / capture.files.file).is_file():
        faults += _apart(capture, comparison, folder)
    return tuple(faults)


def _twice(comparison: Comparison, folder: Path) -> list[str]:
    """Columns that are compared with themselves, in a sentence."""
    one, other = comparison.measured, comparison.computed
    if other is None or (folder / one.file).resolve() != (folder / other.file).resolve():
        return []
    names = dict.fromkeys(q.channel for q in comparison.quantities)
    same = [n for n in names if one.channels.get(n, n) == other.channels.get(n, n)]
    if not same:
        return []
    return [
        f"{', '.join(same)} of {one.file} stands for measured and for computed: give the model's "
        "own channels"
    ]


def _made_by(given: ChannelFile, folder: Path) -> Results | None:
    """The results of the case that wrote a file; None of a file that no case wrote."""
    beside = (folder / given.file).with_name("results.json")
    try:
        return read_results(beside) if beside.is_file() else None
    except (OSError, ValueError):
        return None


def _apart(capture: Capture, comparison: Comparison, folder: Path) -> list[str]:
    if (folder / capture.files.file).resolve() == (folder / comparison.measured.file).resolve():
        return []
    both = [
        read_channels(given, folder, frozenset()) for given in (capture.files, comparison.measured)
    ]
    late = [abs(a - b) for a, b in zip(both[0].span, both[1].span, strict=True)]
    if max(late) <= max(one.step for one in both):
        return []
    spans = [f"{one.span[0]:.6g} to {one.span[1]:.6g} s" for one in both]
    return [
        f"{capture.files.file} is from {spans[0]} and {comparison.measured.file} from {spans[1]}: "
        "they are not of one run: give wind and measured channels that begin and end together"
    ]


def compared(comparison: Comparison, folder: Path) -> Outcome:
    """Statistics of the model against those measured, and what signals determine.

    Parameters
    ----------
    comparison : Comparison
        Files, channels and tolerances.
    folder : Path
        What names of files are relative to.

    Returns
    -------
    Outcome

    Raises
    ------
    InputError
        A file cannot be read, has no such channel, or units differ.
    """
    names = frozenset(q.channel for q in comparison.quantities)
    angles = {n for one in comparison.identified for n in (one.torque, one.front, one.rear)}
    measured = read_channels(comparison.measured, folder, names | angles)
    verdicts = []
    if comparison.quantities and comparison.computed is not None:
        computed = read_channels(comparison.computed, folder, names)
        verdicts = [_judged(q, measured, computed) for q in comparison.quantities]
    spreads: dict[str, float] = {}
    methods: dict[str, tuple[MethodAnswer, ...]] = {}
    for one in comparison.identified:
        found = identified(one, measured)
        verdicts += found.verdicts
        spreads |= found.spreads
        methods |= found.methods
    return Outcome(tuple(verdicts), spreads, methods)


def _judged(which: Compared, measured: Channels, computed: Channels) -> Verdict:
    units = measured.units[which.channel], computed.units[which.channel]
    if units[0] != units[1]:
        raise InputError(
            f"channel {which.channel!r} is in {units[0]} in {measured.source} and in {units[1]} in "
            f"{computed.source}: map the same quantity"
        )
    slope = f", m {which.slope:g}" if which.statistic == "equivalent load" else ""
    return judge(
        f"{which.channel}: {which.statistic}{slope}",
        statistic(computed.of(which.channel), computed.step, which),
        statistic(measured.of(which.channel), measured.step, which),
        tolerance=which.tolerance,
        reason="the project's tolerance",
        source=f"measured: {Path(measured.source).name}",
        unit=units[0],
    )
