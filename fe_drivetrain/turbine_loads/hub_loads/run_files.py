"""Results of HAWC2, BHAWC and FLEX as tables, by their published layouts.

HAWC2 (How 2 HAWC2, DTU R-1597) and BHAWC: a list of channels (.sel) beside samples (.dat). FLEX and
HAWC2's FLEX format: packed samples (.int, .res) beside a list of sensors. The readers of weio are
peers in the tests: they read all channels, of a damaged file until memory ends, and refuse runs of
FLEX whose last time rounding moves.
"""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.channels import existing_file
from fe_drivetrain.turbine_loads.hub_loads.openfast_text import decoded
from fe_drivetrain.turbine_loads.hub_loads.run_table import Packed, Run, RunTable

_MOST_CHANNELS, MOST_SCANS = 100_000, 1_000_000_000
_ENOUGH_HEADER = 8_000_000  # bytes of a list of channels


def hawc2_table(file: Path, kind: str) -> RunTable:
    """Results of HAWC2 or BHAWC, text or binary.

    Parameters
    ----------
    file : Path
        The list of channels (.sel), or the samples (.dat) beside it.
    kind : str
        What it is, for messages.

    Raises
    ------
    InputError
        A file is missing, or the list cannot be read.
    """
    listed = _beside(file, ".sel")
    lines = list_lines(listed, kind)
    try:
        run = _hawc2_run(lines, _beside(file, ".dat"))
    except (ValueError, IndexError, StopIteration) as error:
        raise InputError(
            f"{kind} '{listed}': it cannot be read as a list of channels of HAWC2 or BHAWC "
            f"({error}): write it again"
        ) from error
    program = "BHAWC" if "bhawc" in lines[0].lower() else "HAWC2"
    return RunTable(file, kind, run, {"program": program})


def _hawc2_run(lines: list[str], samples: Path) -> Run:
    """What a list of channels says."""
    head = next(k for k, line in enumerate(lines) if re.match(r"\s*scans\s", line, re.IGNORECASE))
    cells = lines[head + 1].split()
    scans, count, of_bhawc = int(cells[0]), int(cells[1]), "bhawc" in lines[0].lower()
    if not (1 <= scans <= MOST_SCANS and 1 <= count <= _MOST_CHANNELS):
        raise ValueError(f"it states {scans} scans of {count} channels")
    numbered = (line for line in lines[head + 2 :] if re.match(r"\s*\d+\s", line))
    names, units = [], []
    for number in range(1, count + 1):
        line = next(numbered, "")
        if line.split()[:1] != [str(number)]:
            raise ValueError(f"channel {number} of {count} is missing")
        name, unit = _of_bhawc(line) if of_bhawc else _of_hawc2(line)
        names.append(name)
        units.append(unit)
    if of_bhawc or cells[3].lower() != "binary":
        return Run(samples, names, units, scans)
    place = next(k for k, line in enumerate(lines) if "scale factors" in line.lower())
    factors = np.array([float(line) for line in lines[place + 1 : place + 1 + count]])
    if len(factors) < count:
        raise ValueError(f"{len(factors)} scale factors of {count} channels")
    seconds = float(cells[2])
    if not 0.0 < seconds < np.inf:
        raise ValueError(f"it states {seconds:g} s")
    packed = Packed("<i2", by_channel=True)
    is_time = names[0].lower() == "time"
    return Run(samples, names, units, scans, packed, factors, seconds=seconds if is_time else None)


def _of_hawc2(line: str) -> tuple[str, str]:
    """Name and unit of a channel; a load's name has its body, node and axes."""
    name, unit, about = line[12:43].strip(), line[43:54].strip(), line[54:].strip()
    return _hawc2_name(name, about), "" if unit == "-" else unit


def _hawc2_name(name: str, about: str) -> str:
    """The name of a channel, as "Mx shaft node 4 in shaft" of "Mx coo: shaft" of a load."""
    load = re.match(r"([FM][xyz])\s+coo:\s*(\S+)", name)
    place = re.search(r"Mbdy:\s*(\S+)\s+nodenr:\s*(\d+)", about)
    if load is None or place is None:
        return name
    return f"{load[1]} {place[1]} node {place[2]} in {load[2]}"


def _of_bhawc(line: str) -> tuple[str, str]:
    """Label and unit of a channel: number, description, label and unit, with tabs between."""
    cells = [cell.strip() for cell in re.split(r"\t+|\s{2,}", line.strip()) if cell.strip()]
    if len(cells) < 3:
        raise ValueError(f"{line.strip()!r} is no channel")
    unit = cells[-1].strip("[]()") if re.match(r"[\[(]", cells[-1]) else ""
    return cells[-2] if unit or len(cells) > 3 else cells[-1], "" if unit == "-" else unit


def flex_table(file: Path, kind: str) -> RunTable:
    """Results of FLEX, or of HAWC2 in FLEX's format.

    Parameters
    ----------
    file : Path
        Samples (.int, .res); sensors are listed beside it in a file sensor, NAME.sensor or
        sensor_NAME.
    kind : str
        What it is, for messages.

    Raises
    ------
    InputError
        There is no list of sensors, or a file cannot be read.
    """
    listed = [
        one
        for one in sorted(file.parent.iterdir())
        if one.name.lower() in (f"{file.stem}.sensor".lower(), f"sensor_{file.stem}".lower())
    ] or [one for one in sorted(file.parent.iterdir()) if one.name.lower() == "sensor"]
    if not listed:
        raise InputError(
            f"{kind} '{file}': the list of its sensors is missing: put the file 'sensor' of the "
            "run beside it, which names channels and units"
        )
    try:
        sensors = [line.split() for line in list_lines(listed[0], kind)[2:] if line.strip()]
        units = [cells[5].strip("()[]-") for cells in sensors]
        run = _flex_run(file, [cells[6] for cells in sensors], units)
        as_they_are = all(float(cells[1]) == 1.0 and float(cells[2]) == 0.0 for cells in sensors)
    except (ValueError, IndexError, StopIteration) as error:
        raise InputError(
            f"{kind} '{file}': it cannot be read as a result of FLEX with the sensors of "
            f"{listed[0].name} ({error}): write both again"
        ) from error
    facts = {"program": "FLEX"}
    if not as_they_are:
        facts["sensors"] = f"gains and offsets of {listed[0].name} are not applied"
    return RunTable(file, kind, run, facts)


def _flex_run(file: Path, names: list[str], units: list[str]) -> Run:
    """What the head of a file of FLEX says: versions 0, 2 and 3."""
    with file.open("rb") as stream:
        head = stream.read(96 + 8 * len(names))
    if len(head) < 96 + 8 * len(names):
        raise ValueError("it ends within its head")
    count = int(np.frombuffer(head, "<i4", 1, 76)[0])
    if count != len(names):
        raise ValueError(f"it has {count} channels, and the list {len(names)} sensors")
    version = int(np.frombuffer(head, "<i4", 1, 84 + 4 * count)[0])
    if version not in (0, 2, 3):
        raise ValueError(f"version {version}, not 0, 2 or 3")
    start, step = np.frombuffer(head, "<f4", 2, 88 + 4 * count).tolist()
    if not 0.0 < step < np.inf:
        raise ValueError(f"its time step is {step:g} s")
    factors = np.frombuffer(head, "<f4", count, 96 + 4 * count).astype(float)
    packed = Packed("<i2", len(head), by_channel=version == 3)
    # in single precision a step of 0.02 s is 0.0199999996 s
    return Run(file, names, units, None, packed, factors, (start, float(f"{step:.7g}")))


def _beside(file: Path, suffix: str) -> Path:
    """The file of the same run with another suffix, in lower or upper case."""
    if file.suffix.lower() == suffix:
        return file
    upper = file.with_suffix(suffix.upper())
    return upper if upper.is_file() else file.with_suffix(suffix)


def list_lines(file: Path, kind: str) -> list[str]:
    """Lines of a list of channels.

    Parameters
    ----------
    file : Path
        The list.
    kind : str
        What it is, for messages.

    Raises
    ------
    InputError
        There is no such file.
    """
    existing_file(file, kind)
    with file.open("rb") as stream:
        return decoded(stream.read(_ENOUGH_HEADER)).splitlines() or [""]
