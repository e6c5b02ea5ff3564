"""The text of a STEP file, ISO 10303-21: what its reader hangs on, or silently leaves out."""

from __future__ import annotations

import re
from pathlib import Path

from fe_drivetrain.common.errors import InputError

_FARTHEST = 1e9  # any number of a place, in the file's unit
_WORDS = re.compile(r"'(?:[^']|'')*'|/\*.*?\*/", re.DOTALL)
_DATA = re.compile(r"\bDATA\s*(?:\([^;]*\))?\s*;(.*?)\bENDSEC\s*;", re.DOTALL)
_ENTITY = re.compile(r"\s*#(\d+)\s*=\s*[A-Z_0-9!]*\s*\(.*\)\s*\Z", re.DOTALL)
_PLACE = re.compile(r"#(\d+)\s*=\s*(?:CARTESIAN_POINT|DIRECTION)\s*\(\s*'[^']*'\s*,\s*\(([^()]*)\)")


def refuse_damaged_step(path: str) -> None:
    """Refuse a file of which an entity is not whole, or a place is no number or far away.

    Parameters
    ----------
    path : str
        The file.

    Raises
    ------
    InputError
        With the number of the entity.
    """
    name, text = Path(path).name, Path(path).read_text("latin-1")
    bare = _WORDS.sub("", text)
    for section in _DATA.findall(bare):
        before = "the beginning"
        for entity in section.split(";")[:-1]:
            found = _ENTITY.match(entity)
            if found is None or entity.count("(") != entity.count(")"):
                number = re.match(r"\s*#(\d+)\s*=", entity)
                where = f"its entity #{number[1]}" if number else f"what follows {before}"
                start = " ".join(entity.split())[:60]
                raise InputError(
                    f"{name}: {where} is not whole ({start} ...), but must be as in #1=NAME(...); "
                    "export it again, whole"
                )
            before = f"#{found[1]}"
    for number, values in _PLACE.findall(text):
        try:
            sound = all(abs(float(value)) <= _FARTHEST for value in values.split(","))
        except ValueError:
            sound = False
        if not sound:
            raise InputError(
                f"{name}: its entity #{number} is at ({' '.join(values.split())[:80]}), "
                f"but must have numbers of at most {_FARTHEST:g}: export it again, whole"
            )
