"""Lines of an IGES file, looked at before OpenCASCADE reads them: of damaged ones it may not end.

Form: IGES 5.3, section 2.2, fixed ASCII lines of 80 columns: data, the letter of a section, and the
number of the line in it; the last line counts them.
"""

from __future__ import annotations

import re
from pathlib import Path

from fe_drivetrain.common.errors import InputError

_SECTIONS = "SGDPT"
_REAL = re.compile(r"(?<![\w.])[-+]?(?:\d+\.\d*|\.\d+)(?:[EeDd][-+]?\d+)?(?=[,;\s]|$)", re.ASCII)
_FARTHEST = 1e9  # any number of a place, in the file's unit


def refuse_damaged(path: str) -> None:
    """Refuse a file whose lines are not all there, or do not refer to one another.

    Parameters
    ----------
    path : str
        File ending in .igs or .iges.

    Raises
    ------
    InputError
        The message names the line.
    """
    name = Path(path).name
    counts = dict.fromkeys(_SECTIONS, 0)
    lines: dict[str, list[str]] = {letter: [] for letter in _SECTIONS}
    last = "S"
    for number, line in enumerate(Path(path).read_text("latin-1").splitlines(), 1):
        if not line.strip() and counts["T"]:
            continue
        letter, of_section = line[72:73], line[73:80].strip().lstrip("0")
        counts[letter] = counts.get(letter, 0) + 1
        if (
            len(line.rstrip()) > 80
            or letter not in lines
            or _SECTIONS.index(letter) < _SECTIONS.index(last)
            or of_section != str(counts[letter])
        ):
            raise _damaged(name, number, "is not one of 80 columns that follow one another")
        last = letter
        lines[letter].append(line[:72])
    if counts["T"] != 1 or _counted(lines["T"][0]) != counts:
        raise _damaged(name, sum(counts.values()), "does not count the lines of the file")
    _refuse_lost_pointers(name, lines, counts)


def _counted(line: str) -> dict[str, int]:
    """Counts of the last line, which is one itself."""
    found = re.findall(r"([SGDP])\s*(\d{1,7})", line, re.ASCII)
    return {**{letter: int(count) for letter, count in found}, "T": 1}


def _refuse_lost_pointers(name: str, lines: dict[str, list[str]], counts: dict[str, int]) -> None:
    """Refuse entries without parameters of their own, and numbers that are far away."""
    before = counts["S"] + counts["G"]
    if counts["D"] % 2:
        raise _damaged(name, before + counts["D"], "is half of an entry")
    for k in range(0, counts["D"], 2):
        first, second = lines["D"][k], lines["D"][k + 1]
        start, length = first[8:16].strip(), second[24:32].strip()
        whole = start.isdecimal() and length.isdecimal() and first[:8] == second[:8]
        if not whole or not 1 <= int(start) <= int(start) + int(length) - 1 <= counts["P"]:
            raise _damaged(name, before + k + 1, "has no parameters of its own")
        own = lines["P"][int(start) - 1 : int(start) - 1 + int(length)]
        kind = first[:8].strip()
        others = any(line[64:72].strip().lstrip("0") != str(k + 1) for line in own)
        if others or not re.match(rf"\s*{re.escape(kind)}\D", own[0]):
            raise _damaged(name, before + k + 1, "has parameters of another entry")
    for k, line in enumerate(lines["P"]):
        for found in _REAL.findall(line[:64]):
            if not abs(float(found.upper().replace("D", "E"))) <= _FARTHEST:
                what = f"has the number {found[:30]}, which must be at most {_FARTHEST:g}"
                raise _damaged(name, before + counts["D"] + k + 1, what)


def _damaged(name: str, line: int, what: str) -> InputError:
    return InputError(
        f"{name} cannot be read as IGES (its line {line} {what}): export it again, whole"
    )
