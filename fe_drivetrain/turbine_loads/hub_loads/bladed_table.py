"""Results of Bladed as tables: a header (.%NN) beside samples (.$NN) for each group of channels.

Hub loads that are read without a mapping are the group of the stationary hub, in Bladed's
coordinates after GL (1993): x along the shaft downwind, z up, y = z cross x. A run of a turbine of
5 MW has in it the thrust and the torque positive, and the rotor's weight as a negative Fz.
"""

from __future__ import annotations

import re
import shlex
from collections.abc import Collection, Mapping, Sequence
from pathlib import Path

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.turbine_loads.hub_loads.history_table import Columns, HistoryTable
from fe_drivetrain.turbine_loads.hub_loads.run_files import MOST_SCANS, list_lines
from fe_drivetrain.turbine_loads.hub_loads.run_table import Packed, Run, RunTable

SUFFIX = re.compile(r"\.([%$]\d+|\$pj)", re.IGNORECASE)
"""What names of its files end in."""

_UNITS = {
    **{"F": "N", "FL": "Nm", "A": "rad", "A/T": "rad/s", "L/T": "m/s", "L": "m", "T": "s"},
    **{"M": "kg", "P": "W", "N": ""},
}
_FRAME = "stationary hub: x along the shaft downwind, z up, y = z cross x; about the hub's centre"
_KEYS = (
    "FILE|ACCESS|FORM|RECL|FORMAT|CONTENT|CONFIG|NDIMENS|DIMENS|GENLAB|VARIAB|VARUNIT|AXISLAB|"
    "AXIUNIT|AXIMETH|AXIVAL|AXITICK|MIN|STEP|NVARS|ULOADS"
)
_KINDS = {"R*4": "<f4", "R*8": "<f8", "I*4": "<i4"}


class BladedTable(HistoryTable):
    """Results of Bladed: groups of channels of one run, as far as they have the same times.

    Parameters
    ----------
    file : Path
        A header (.%NN) or samples (.$NN) of a group, or the project (.$PJ) of all.
    kind : str
        What it is, for messages.
    """

    def __init__(self, file: Path, kind: str) -> None:
        super().__init__(file, kind)
        project = file.suffix.lower() == ".$pj"
        named = file.with_name(f"{file.stem}{file.suffix.replace('$', '%')}")
        headers = [
            one
            for one in sorted(file.parent.glob("*"))
            if one.stem == file.stem and re.fullmatch(r"\.%\d+", one.suffix) and one != named
        ]
        self._groups: list[tuple[int, RunTable]] = []
        runs = [] if project else [_bladed_run(named, kind)]
        for header in headers:
            try:
                runs.append(_bladed_run(header, kind))
            except InputError:  # of another layout, like loads along blades
                continue
        hub = [run for run in runs if any("stationary hub" in name.lower() for name in run.names)]
        first = next(iter([*(hub if project else []), *runs]), None)
        if first is None:
            raise self.cannot("no group of channels over time (.%NN) is beside it: copy them, too")
        for run in runs:
            if (run.clock, run.scans) == (first.clock, first.scans):
                table = RunTable(run.file, kind, run, {})
                start = len(self.titles)
                fresh = table.titles if not self.titles else table.titles[1:]
                self._groups.append((start - bool(start), table))
                self.titles += fresh
        self.facts = {"program": "Bladed", "frame of hub loads": _FRAME}
        self.advice = (
            "; of Bladed the group of Stationary hub Fx to Mz is read, in the frame that does not "
            "turn: output it, or map others in `ChannelMap`"
        )

    def columns(self, wanted: Sequence[int], times: Collection[int]) -> Columns:
        """Channels that are wanted, of the groups that have them.

        Parameters
        ----------
        wanted : sequence of int
            Their places.
        times : collection of int
            Not used: time is in seconds.

        Raises
        ------
        InputError
            A file of samples cannot be read.
        """
        values: dict[int, Floats] = {}
        for start, table in self._groups:
            own = {k: k - start for k in wanted if 0 < k - start < len(table.titles)}
            own |= {0: 0} if 0 in wanted and start == 0 else {}
            if own:
                found = table.columns(list(own.values()), times).values
                values |= {k: found[place] for k, place in own.items()}
        return Columns(values, None, "")


def _bladed_run(header: Path, kind: str) -> Run:
    """What the header of a group says."""
    text = " ".join(list_lines(header, kind))
    parts = re.split(rf"(?:^|\s)({_KEYS})(?=\s)", text)
    values = (part.strip() for part in parts[2::2])
    found: Mapping[str, str] = dict(zip(parts[1::2], values, strict=True))
    try:
        if found["NDIMENS"] != "2":
            raise ValueError("it is not of channels over time alone")
        count, scans = (int(cell) for cell in found["DIMENS"].split())
        names, units = shlex.split(found["VARIAB"]), shlex.split(found["VARUNIT"])
        if not 1 <= count == len(names) == len(units) or not 1 <= scans <= MOST_SCANS:
            stated = f"it states {count} channels of {scans} samples"
            raise ValueError(f"{stated}, with {len(names)} names and {len(units)} units")
        step = float(f"{float(found['STEP']):.7g}")  # 0.05 s in single precision is 0.050000001 s
        clock = (float(found["MIN"]), step)
        packed = None
        if found["ACCESS"].upper().startswith("D"):
            packed = Packed(_KINDS[found["FORMAT"].upper()])
    except (KeyError, ValueError) as error:
        why = f"{error.args[0]} is missing" if isinstance(error, KeyError) else str(error)
        raise InputError(
            f"{kind} '{header}': it cannot be read as a header of Bladed ({why}): name the header "
            "(.%NN) of hub loads over time"
        ) from error
    samples = header.with_name(f"{header.stem}{header.suffix.replace('%', '$')}")
    shown_units = [_UNITS.get(unit, unit) for unit in units]
    return Run(samples, names, shown_units, scans, packed, None, clock)
