"""Tables whose channels are listed in one file and whose samples are in another.

Programs that simulate turbines write them so: packed or plain numbers, sample after sample or
channel after channel, and a list of names, units and factors beside them.
"""

from __future__ import annotations

import re
from array import array
from collections.abc import Collection, Sequence
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.turbine_loads.hub_loads.channels import existing_file, is_load_unit, without_unit
from fe_drivetrain.turbine_loads.hub_loads.history_table import Columns, HistoryTable
from fe_drivetrain.turbine_loads.hub_loads.openfast_text import decoded, fortran_number


def _map_loads(loads: Sequence[str]) -> str:
    """What to do where a program has no one frame of hub loads, as the end of a sentence."""
    listed = ", ".join(loads[:12]) + (" and others" if len(loads) > 12 else "")
    first = re.sub("['`]", "", without_unit(next(iter(loads), "Thrust")))
    return (
        "; which channels are hub loads, in which frame and with which sign, depends on the model: "
        f"state it in `ChannelMap`, as in `ChannelMap(channels={{'Fx': '-{first}'}})`; it has "
        f"{listed or 'no forces and moments'}"
    )


class Packed(NamedTuple):
    """Numbers of a file without text.

    Attributes
    ----------
    kind : str
        Type of numpy.
    start : int
        Bytes before the first number.
    by_channel : bool
        All samples of a channel follow each other, rather than all channels of a sample.
    """

    kind: str
    start: int = 0
    by_channel: bool = False


class Run(NamedTuple):
    """What a run wrote, and how.

    Attributes
    ----------
    file : Path
        The samples.
    names, units : list of str
        Names and units of the channels that the file of samples holds.
    scans : int or None
        How many samples there are; None where the file alone says it.
    packed : Packed or None
        None of text.
    factors : ndarray or None
        By which numbers of each channel are multiplied.
    clock : tuple of float or None
        First time and step [s], where time is no channel of its own.
    seconds : float or None
        How long the run is, where its packed time is the first channel, too coarse to be used.
    """

    file: Path
    names: list[str]
    units: list[str]
    scans: int | None = None
    packed: Packed | None = None
    factors: Floats | None = None
    clock: tuple[float, float] | None = None
    seconds: float | None = None


class RunTable(HistoryTable):
    """The channels of a run.

    Parameters
    ----------
    file : Path
        The file that the user named.
    kind : str
        What it is, for messages.
    run : Run
        What the run wrote.
    facts : dict
        What is stated of the program, as its frame.
    """

    def __init__(self, file: Path, kind: str, run: Run, facts: dict[str, str]) -> None:
        super().__init__(file, kind)
        existing_file(run.file, kind)
        self._run = run
        self._first = 0 if run.clock is None else 1
        names = [*(["Time"] * self._first), *_distinct(run.names)]
        units = [*(["s"] * self._first), *run.units]
        self.titles = [f"{n} [{u}]" if u else n for n, u in zip(names, units, strict=True)]
        self.facts = facts
        self.frame_known = False
        self.advice = _map_loads([title for title in self.titles if is_load_unit(title)])

    def columns(self, wanted: Sequence[int], times: Collection[int]) -> Columns:
        """Channels that are wanted.

        Parameters
        ----------
        wanted : sequence of int
            Their places.
        times : collection of int
            Not used: time is in seconds.

        Raises
        ------
        InputError
            The file of samples cannot be read.
        """
        run, places = self._run, [k - self._first for k in wanted if k >= self._first]
        rows: Sequence[int] | None = None
        if run.packed is not None:
            table = _packed(run, places)
        else:
            table, rows = _plain(run, places)
        if run.scans is not None and len(table) != run.scans:
            raise self.cannot(
                f"{run.file.name} has {len(table)} of {run.scans} scans: run the program to its "
                "end, or correct the number of scans"
            )
        if run.factors is not None:
            table = table * run.factors[places]
        values = dict(zip([k + self._first for k in places], table.T, strict=True))
        if run.clock is not None and 0 in wanted:
            values[0] = run.clock[0] + run.clock[1] * np.arange(len(table))
        words = ""
        if run.seconds is not None and 0 in wanted:
            assert run.factors is not None
            values[0] = _counted(values[0], run.seconds)
            coarse = f"the packed time has steps of {run.factors[0]:.2g} s"
            words = f"time counted by scans, since {coarse}"
        return Columns(values, rows, words)


def _counted(time: Floats, seconds: float) -> Floats:
    """Even times of a run, about the mean of those that packing made coarse."""
    step = seconds / len(time)
    return np.asarray(time.mean() + step * (np.arange(len(time)) - 0.5 * (len(time) - 1)))


def _distinct(names: Sequence[str]) -> list[str]:
    """Names without brackets, which are for units; one that is there again has its number."""
    plain = [" ".join(re.sub(r"[\[\]()]", " ", name).split()) for name in names]
    seen: set[str] = set()
    found = []
    for number, name in enumerate(plain, start=1):
        again = name.lower() in seen or not name
        found.append(f"{name} #{number}".strip() if again else name)
        seen.add(name.lower())
    return found


def _packed(run: Run, places: Sequence[int]) -> NDArray[np.float64]:
    """Samples (n, chosen) of a file of numbers."""
    packed, count = run.packed, len(run.names)
    assert packed is not None
    kind = np.dtype(packed.kind)
    size = run.file.stat().st_size - packed.start
    samples = max(size, 0) // (kind.itemsize * count)
    if run.scans is not None:
        samples = min(samples, run.scans)
    elif size % (kind.itemsize * count):
        raise InputError(
            f"hub loads '{run.file}': it ends within a sample of {count} channels: run the program "
            "again"
        )
    if samples < 1:
        raise InputError(f"hub loads '{run.file}': it has no samples: run the program again")
    shape = (count, samples) if packed.by_channel else (samples, count)
    table = np.memmap(run.file, kind, "r", packed.start, shape)
    chosen = table[list(places)].T if packed.by_channel else table[:, list(places)]
    return np.asarray(chosen, dtype=float)


def _plain(run: Run, places: Sequence[int]) -> tuple[NDArray[np.float64], Sequence[int]]:
    """Samples (n, chosen) of a file of text, and the line of each."""
    values, rows, count = array("d"), array("q"), len(run.names)
    with run.file.open("rb") as stream:
        for number, line in enumerate(stream, start=1):
            cells = line.split()
            if not cells:
                continue
            where = f"hub loads '{run.file}': line {number}"
            if len(cells) != count:
                raise InputError(
                    f"{where} has {len(cells)} values for {count} channels: run the program again"
                )
            rows.append(number)
            try:
                values.extend([float(cells[k]) for k in places])
            except ValueError:
                for k in places:
                    try:
                        values.append(fortran_number(cells[k]))
                    except ValueError as error:
                        raise InputError(
                            f"{where}, channel {run.names[k]}: {shown(decoded(cells[k]))} is not a "
                            "number: run the program again"
                        ) from error
    return np.array(values).reshape(len(rows), len(places)), rows
