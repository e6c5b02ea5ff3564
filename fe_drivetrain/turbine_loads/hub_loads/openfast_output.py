"""Channels of OpenFAST output files, text (.out) or binary (.outb), in the memory of those wanted.

The readers of openfast_io hold every number of a file as an object of Python, some 50 times the
size of a binary file: they are peers in the tests. The layout of a binary file is that of
NREL's ReadFASTbinary.m (Jonkman 2012) and of OpenFAST's WrBinFAST.
"""

from __future__ import annotations

import re
from collections.abc import Collection
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.channels import Channel
from fe_drivetrain.turbine_loads.hub_loads.openfast_text import MoreRunsError, decoded, text_columns

_WITH_TIME, _UNPACKED, _LONG_NAMES = 1, 3, 4
_MAX_HEADER = 12  # bytes of a binary file up to its number of samples
_BLOCK = 1 << 21  # values that are unpacked at once


def openfast_channels(file: Path, wanted: Collection[str] | None = None) -> dict[str, Channel]:
    """Channels of an OpenFAST output file, by their names in lower case.

    A channel whose sign OutList reversed, with a leading -, _ or m, has its own sign and name.

    Parameters
    ----------
    file : Path
        Text (.out) or binary (.outb).
    wanted : collection of str, optional
        Names in lower case; other channels have no values, so that a large file is read in the
        memory of what is used.

    Raises
    ------
    InputError
        The file cannot be read.
    """
    try:
        if file.suffix.lower() == ".outb":
            names, units, values = _binary(file, wanted)
        else:
            names, units, values = text_columns(file, lambda found: _chosen(found, wanted))
    except MoreRunsError as error:
        raise InputError(f"hub loads '{file}': {error}") from error
    except (OSError, ValueError, IndexError, OverflowError) as error:
        raise InputError(
            f"hub loads '{file}': it cannot be read as OpenFAST output ({error}); run OpenFAST "
            "again"
        ) from error
    by_name: dict[str, Channel] = {}
    places = {name: place for place, name in enumerate(_chosen(names, wanted))}
    for place, (name, unit) in enumerate(zip(names, units, strict=True)):
        found = values[:, places[place]] if place in places else np.zeros(0)
        by_name.setdefault(
            _key(name), Channel(name, unit, -found if reversed_name(name) else found)
        )
    return by_name


def reversed_name(name: str) -> re.Match[str] | None:
    """Whether OutList reversed the sign of a channel: with a leading -, _, m or M.

    Parameters
    ----------
    name : str
        Name of the channel, as the file has it.
    """
    return re.fullmatch(r"[-_m]((?:LSS|Rot|Azimuth).*)", name, re.IGNORECASE)


def _key(name: str) -> str:
    reversed_sign = reversed_name(name)
    return (reversed_sign[1] if reversed_sign else name).lower()


def _chosen(names: list[str], wanted: Collection[str] | None) -> list[int]:
    """Places of the channels that have values."""
    return [k for k, name in enumerate(names) if wanted is None or _key(name) in wanted]


def _binary(
    file: Path, wanted: Collection[str] | None
) -> tuple[list[str], list[str], NDArray[np.float64]]:
    """Names, units and values (samples, chosen) of a .outb, time first."""
    size = file.stat().st_size
    with file.open("rb") as stream:
        (identifier,) = _numbers(stream, "<i2", 1)
        if identifier not in (1, 2, 3, 4):
            raise ValueError(f"format identifier {identifier}, not 1 to 4")
        length = int(_numbers(stream, "<i2", 1)[0]) if identifier == _LONG_NAMES else 10
        channels, samples = _numbers(stream, "<i4", 2).tolist()
        kind = np.dtype("<f8" if identifier == _UNPACKED else "<i2")
        least = channels * samples * kind.itemsize
        if channels < 1 or samples < 1 or length < 1 or least > size:
            raise ValueError(f"it states {channels} channels of {samples} samples")
        first, second = _numbers(stream, "<f8", 2).tolist()
        scale, offset = np.ones(channels), np.zeros(channels)
        if identifier != _UNPACKED:
            scale, offset = (_numbers(stream, "<f4", channels).astype(float) for _ in range(2))
        stream.seek(int(_numbers(stream, "<i4", 1)[0]), 1)  # the description
        names, units = (_texts(stream, channels + 1, length) for _ in range(2))
        if identifier == _WITH_TIME:
            time = (_numbers(stream, "<i4", samples) - second) / first
        else:
            time = first + second * np.arange(samples)
        chosen = _chosen(names, wanted)
        columns = np.array([place - 1 for place in chosen if place > 0], dtype=int)
        values = np.empty((samples, len(columns)))
        rows = max(1, _BLOCK // channels)
        for start in range(0, samples, rows):
            count = min(rows, samples - start)
            part = _numbers(stream, kind.str, count * channels).reshape(count, channels)
            values[start : start + count] = (part[:, columns] - offset[columns]) / scale[columns]
        if _begins_a_run(stream.read(_MAX_HEADER), size):
            raise MoreRunsError(
                f"a second run begins after the {samples} samples of the first: give each run a "
                "file of its own"
            )
    if 0 in chosen:
        values = np.column_stack([time, values])
    return names, [unit.strip("()") for unit in units], values


def _begins_a_run(block: bytes, size: int) -> bool:
    """Whether bytes after a run are the header of another; other bytes may follow old files."""
    if len(block) < _MAX_HEADER:
        return False
    (identifier,) = np.frombuffer(block[:2], "<i2").tolist()
    at = 4 if identifier == _LONG_NAMES else 2
    channels, samples = np.frombuffer(block[at : at + 8], "<i4").tolist()
    return bool(1 <= identifier <= _LONG_NAMES and 0 < channels * samples < size and channels > 0)


def _numbers(stream: BinaryIO, kind: str, count: int) -> NDArray[np.generic]:
    values: NDArray[np.generic] = np.frombuffer(
        stream.read(count * np.dtype(kind).itemsize), dtype=kind
    )
    if len(values) < count:
        raise ValueError(f"it ends after {len(values)} of {count} values")
    return values


def _texts(stream: BinaryIO, count: int, length: int) -> list[str]:
    block = stream.read(count * length)
    return [decoded(block[length * k : length * (k + 1)]).strip(" \0") for k in range(count)]
