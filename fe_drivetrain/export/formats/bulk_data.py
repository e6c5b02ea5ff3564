"""Nastran bulk data as others write it: GRID, CORD2R, EXTRN, ASET and DMIG by their cards.

Free, small and large fields (MSC Nastran Quick Reference Guide, "Format of Bulk Data Entries").
Comments say nothing here; continuation lines stand behind their entry.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.labelled_matrices import Degree, Matrix, Place

_REAL = re.compile(r"([-+]?(?:\d+\.?\d*|\.\d+))(?:[EeDd]([-+]?\d+)|([-+]\d+))?", re.ASCII)
_CHOSEN = re.compile(r"(?i)\s*([KM])2(?:GG|PP)\s*=\s*(\w+)")
_OTHER_SYSTEMS = ("CORD2C", "CORD2S", "CORD1R", "CORD1C", "CORD1S")
_SYMMETRIC = (6,)


class Entry(NamedTuple):
    """A bulk data entry: its name, its fields behind the name, and the line it begins in."""

    name: str
    fields: list[str]
    line: int


@dataclass
class BulkData:
    """What a file says of points and matrices.

    Attributes
    ----------
    places : dict
        Places of points by number.
    order : list
        Degrees of freedom in the order of a matrix, of EXTRN or ASET entries.
    matrices : dict
        Matrices of DMIG by name.
    stiffness, mass : str
        Names of DMIG in the case control (K2GG, M2GG); empty where there are none.
    """

    places: dict[int, Place] = field(default_factory=dict)
    order: list[Degree] = field(default_factory=list)
    matrices: dict[str, Matrix] = field(default_factory=dict)
    stiffness: str = ""
    mass: str = ""


def bulk_data(text: str) -> BulkData:
    """Points and matrices of bulk data.

    Parameters
    ----------
    text : str
        All of the file; a case control before BEGIN BULK may be in it.

    Raises
    ------
    InputError
        An entry is none; the message begins with its line.
    """
    found = BulkData()
    entries: dict[str, list[Entry]] = {}
    for entry in _entries(text, found):
        entries.setdefault(entry.name, []).append(entry)
    if included := entries.get("INCLUDE"):
        raise InputError(f"line {included[0].line}: it includes another file: write all into one")
    systems = _systems(entries)
    for grid in entries.get("GRID", []):
        number = _integer(grid, 0)
        if number in found.places:
            raise InputError(f"line {grid.line}: GRID {number} is there before: leave one out")
        found.places[number] = _place(grid, systems)
    found.order = _order(entries)
    found.matrices = _matrices(entries.get("DMIG", []))
    return found


# --- fields --------------------------------------------------------------------------


def _entries(text: str, found: BulkData) -> Iterator[Entry]:
    """Entries with their continuations; names in the case control are put into what is found."""
    entry: Entry | None = None
    for number, raw in enumerate(text.splitlines(), 1):
        if chosen := _CHOSEN.match(raw):
            setattr(found, {"K": "stiffness", "M": "mass"}[chosen[1].upper()], chosen[2].upper())
            continue
        line = raw.partition("$")[0].expandtabs(8).rstrip()
        if not line:
            continue
        if re.match(r"(?i)\s*enddata\b", line):
            break
        if re.match(r"(?i)\s*include\b", line):
            yield Entry("INCLUDE", [], number)
            continue
        name, fields = _fields(line)
        if name in ("", "*", "+") or name[0] in "*+":
            if entry is not None:
                entry.fields.extend(fields)
            continue
        if entry is not None:
            yield entry
        entry = Entry(name.rstrip("*").upper(), fields, number)
    if entry is not None:
        yield entry


def _fields(line: str) -> tuple[str, list[str]]:
    """The first field, and those of data: eight of a line, or four in large fields."""
    if "," in line:
        cells = [cell.strip() for cell in line.split(",")]
        count = 4 if "*" in cells[0] else 8
        return cells[0], [*cells[1 : 1 + count], *[""] * count][:count]
    first = line[:8].strip()
    width, count = (16, 4) if "*" in first else (8, 8)
    rest = line[8:].ljust(width * count)
    return first, [rest[width * k : width * (k + 1)].strip() for k in range(count)]


def _integer(entry: Entry, k: int, default: int | None = None) -> int:
    text = entry.fields[k] if k < len(entry.fields) else ""
    if not text and default is not None:
        return default
    if not re.fullmatch(r"[-+]?\d{1,9}", text, re.ASCII):
        raise InputError(
            f"line {entry.line}: {entry.name} has {text[:20]!r} in its field {k + 2}, which must "
            "be a whole number: correct it"
        )
    return int(text)


def _real(entry: Entry, k: int) -> float:
    text = entry.fields[k] if k < len(entry.fields) else ""
    if not text:
        return 0.0
    parts = _REAL.fullmatch(text)
    if parts is None:
        raise InputError(
            f"line {entry.line}: {entry.name} has {text[:20]!r} in its field {k + 2}, which must "
            "be a number: correct it"
        )
    return float(f"{parts[1]}e{parts[2] or parts[3] or 0}")


# --- points --------------------------------------------------------------------------


def _systems(entries: dict[str, list[Entry]]) -> dict[int, tuple[Floats, Floats]]:
    """Origin (3,) and axes (3, 3), as columns, of rectangular systems by number."""
    systems = {0: (np.zeros(3), np.eye(3))}
    waiting = {_integer(entry, 0): entry for entry in entries.get("CORD2R", [])}
    while waiting:
        ready = [n for n, entry in waiting.items() if _integer(entry, 1, 0) in systems]
        if not ready:
            first = next(iter(waiting.values()))
            raise InputError(
                f"line {first.line}: CORD2R {first.fields[0]} is defined in a system that is not "
                "there, or is not rectangular: define it in the basic one"
            )
        for number in ready:
            entry = waiting.pop(number)
            start, axes = systems[_integer(entry, 1, 0)]
            a, b, c = (
                start + axes @ np.array([_real(entry, 2 + 3 * k + i) for i in range(3)])
                for k in range(3)
            )
            z, x = b - a, c - a
            y = np.cross(z, x)
            if not np.linalg.norm(y) > 0.0:
                raise InputError(f"line {entry.line}: CORD2R {number} has its points on one line")
            z, y = z / np.linalg.norm(z), y / np.linalg.norm(y)
            systems[number] = a, np.column_stack([np.cross(y, z), y, z])
    return systems


def _place(grid: Entry, systems: dict[int, tuple[Floats, Floats]]) -> Place:
    own, moves = _integer(grid, 1, 0), _integer(grid, 5, 0)
    for number in (own, moves):
        if number not in systems:
            raise InputError(
                f"line {grid.line}: GRID {grid.fields[0]} is in the coordinate system {number}, "
                "which is no CORD2R of the file: write it in the basic one"
            )
    start, axes = systems[own]
    at = start + axes @ np.array([_real(grid, k) for k in (2, 3, 4)])
    return Place(at, systems[moves][1])


def _order(entries: dict[str, list[Entry]]) -> list[Degree]:
    """Degrees of freedom of EXTRN, else of ASET, BSET and their like, in order of numbers."""
    for names in (("EXTRN",), ("ASET", "ASET1", "BSET", "BSET1", "CSET", "QSET", "QSET1")):
        found: set[Degree] = set()
        for entry in (entry for name in names for entry in entries.get(name, [])):
            found.update(_degrees_of(entry))
        if found:
            return sorted(found)
    return []


def _degrees_of(entry: Entry) -> Iterator[Degree]:
    if entry.name.endswith("1"):
        components, rest = entry.fields[0] or "0", entry.fields[1:]
        numbers = _listed(entry, rest)
        pairs = [(number, components) for number in numbers]
    else:
        filled = [cell for cell in entry.fields if cell]
        if len(filled) % 2:
            raise InputError(
                f"line {entry.line}: {entry.name} must have pairs of a point and its components"
            )
        own = Entry(entry.name, filled, entry.line)
        pairs = [(_integer(own, k), filled[k + 1]) for k in range(0, len(filled), 2)]
    for number, components in pairs:
        if not re.fullmatch("0|[1-6]{1,6}", components):
            raise InputError(
                f"line {entry.line}: {entry.name} has the components {components[:20]!r}, which "
                "must be 0 or digits from 1 to 6"
            )
        yield from ((number, int(digit)) for digit in components)


def _listed(entry: Entry, cells: list[str]) -> list[int]:
    """Numbers of a list, or of a range with THRU."""
    filled = [cell for cell in cells if cell]
    own = Entry(entry.name, filled, entry.line)
    if len(filled) == 3 and filled[1].upper() == "THRU":
        first, last = _integer(own, 0), _integer(own, 2)
        if not first <= last <= first + 10_000:
            raise InputError(f"line {entry.line}: {entry.name} has a range of too many points")
        return list(range(first, last + 1))
    return [_integer(own, k) for k in range(len(filled))]


# --- matrices --------------------------------------------------------------------------


def _matrices(entries: list[Entry]) -> dict[str, Matrix]:
    """Matrices of DMIG entries, square ones of real numbers."""
    heads: dict[str, Entry] = {}
    terms: dict[str, dict[tuple[Degree, Degree], float]] = {}
    for entry in entries:
        name = entry.fields[0].upper()
        if entry.fields[1] == "0":
            _check_head(name, entry)
            heads[name] = entry
            terms.setdefault(name, {})
            continue
        if name not in heads:
            raise InputError(f"line {entry.line}: DMIG {name} has no header before its columns")
        _take_column(entry, terms[name])
    return {
        name: _matrix(terms[name], _integer(head, 2) in _SYMMETRIC)
        for name, head in heads.items()
        if _integer(head, 2) in (1, 6)
    }


def _check_head(name: str, entry: Entry) -> None:
    form, kind = _integer(entry, 2), _integer(entry, 3)
    if form not in (1, 2, 6, 8, 9) or kind not in (1, 2, 3, 4):
        raise InputError(
            f"line {entry.line}: DMIG {name} has the form {form} and the type {kind}, which must "
            "be 1, 2, 6, 8 or 9, and 1 to 4: correct it"
        )
    if kind > 2:
        raise InputError(f"line {entry.line}: DMIG {name} is complex: write the real matrix")


def _take_column(entry: Entry, terms: dict[tuple[Degree, Degree], float]) -> None:
    """Put the terms of one column: behind its degree of freedom and a blank, four fields each."""
    column = _degree(entry, 1)
    for k in range(4, len(entry.fields), 4):
        if not any(entry.fields[k : k + 3]):
            continue
        place = (_degree(entry, k), column)
        if place in terms:
            raise InputError(
                f"line {entry.line}: DMIG {entry.fields[0]} has the term of row {place[0]} and "
                f"column {column} twice: leave one out"
            )
        terms[place] = _real(entry, k + 2)


def _degree(entry: Entry, k: int) -> Degree:
    number, component = _integer(entry, k), _integer(entry, k + 1, 0)
    if not (number > 0 and 0 <= component <= 6):
        raise InputError(
            f"line {entry.line}: DMIG {entry.fields[0]} has the point {number} with component "
            f"{component}, which must be from 1 on and 0 to 6: correct it"
        )
    return number, component


def _matrix(terms: dict[tuple[Degree, Degree], float], symmetric: bool) -> Matrix:
    degrees = sorted({degree for place in terms for degree in place})
    at = {degree: k for k, degree in enumerate(degrees)}
    values = np.zeros((len(degrees), len(degrees)))
    for (row, column), value in terms.items():
        values[at[row], at[column]] = value
        if symmetric:
            values[at[column], at[row]] = value
    return Matrix(degrees, values)
