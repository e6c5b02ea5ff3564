"""Matrices of Nastran OUTPUT4: text and binary of both byte orders, dense and sparse.

Format: MSC Nastran DMAP Programmer's Guide, module OUTPUT4, "Remarks". Sparse columns are strings
of terms; in the form BIGMAT, whose count of rows is negative, a string has two words before it.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

from fe_drivetrain.common import regular_files
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import unreadable

MAX_SIZE = 6000
"""Rows and columns of a matrix that is read: a thousand points of six degrees of freedom."""

_HEAD = re.compile(r"\d*P?,?(\d+)[EDG](\d+)\.\d+", re.IGNORECASE)


class _Head(NamedTuple):
    columns: int
    rows: int
    big: bool
    form: int
    precision: int
    name: str

    @property
    def words(self) -> int:
        """Words of one number, as strings count them."""
        return 2 if self.precision in (2, 4) else 1

    @property
    def kept(self) -> bool:
        """Whether the matrix is real, and of a size that points can have."""
        return self.precision in (1, 2) and max(self.columns, self.rows) <= MAX_SIZE

    def empty(self) -> Floats:
        """The matrix of zeros; of one that is not kept there is nothing to put numbers into."""
        return np.zeros((self.rows, self.columns) if self.kept else (0, 0))


def matrices_of(path: Path) -> dict[str, Floats]:
    """All real matrices of a file by name; complex and larger ones are left out.

    Parameters
    ----------
    path : Path
        The file.

    Raises
    ------
    InputError
        It cannot be read, is no OUTPUT4, or has no such matrix.
    """
    try:
        content = regular_files.content_of(path)
    except OSError as error:
        raise unreadable(path, "OUTPUT4", error) from error
    binary = len(content) > 4 and any(
        struct.unpack(f"{order}i", content[:4])[0] in (24, 48) for order in "<>"
    )
    found: dict[str, Floats] = {}
    left_out: list[str] = []
    try:
        for head, matrix in _binary(content) if binary else _text(content):
            if head.kept:
                found[head.name] = _whole(head, matrix)
            else:
                left_out.append(head.name)
    except (ValueError, IndexError, struct.error) as error:
        raise InputError(
            f"{path} is no OUTPUT4 file, or is cut off ({error}): write it again, whole"
        ) from error
    if not found:
        raise InputError(
            f"{path} holds no real matrix of at most {MAX_SIZE} rows and columns "
            f"({', '.join(left_out) or 'nor any other'}): write that of the points that are needed"
        )
    return found


def _whole(head: _Head, matrix: Floats) -> Floats:
    """The matrix, of a symmetric one with the triangle that is left out."""
    upper = not np.tril(matrix, -1).any()
    if head.form == 6 and head.rows == head.columns and (upper or not np.triu(matrix, 1).any()):
        with np.errstate(all="ignore"):
            return matrix + matrix.T - np.diag(np.diag(matrix))
    return matrix


def _checked(head: _Head) -> _Head:
    if not re.fullmatch(r"\w{1,8}", head.name, re.ASCII):
        raise ValueError(f"a matrix has the name {head.name!r}")
    if head.precision not in (1, 2, 3, 4) or head.columns < 1 or head.rows < 1:
        raise ValueError(
            f"matrix {head.name} is of type {head.precision}, of {head.rows} by {head.columns}"
        )
    return head


def _put(head: _Head, matrix: Floats, column: int, row: int, values: Floats) -> None:
    if not head.kept:
        return
    if not 1 <= row <= row + len(values) - 1 <= head.rows:
        raise ValueError(f"column {column} of {head.name} has no rows {row} to {row + len(values)}")
    matrix[row - 1 : row - 1 + len(values), column - 1] = values


def _string(head: _Head, words: list[int]) -> tuple[int, int]:
    """First row of a string, and how many numbers it has."""
    if head.big:
        length, row = words[0] - 1, words[1]
    else:
        length = words[0] // 65536 - 1
        row = words[0] - 65536 * (length + 1)
    if length < head.words or length % head.words:
        raise ValueError(f"a string of {head.name} has {length} words")
    return row, length // head.words


# --- text --------------------------------------------------------------------------


def _text(content: bytes) -> Iterator[tuple[_Head, Floats]]:
    lines = iter(content.decode("ascii").splitlines())
    for line in lines:
        if line.strip():
            yield _text_matrix(line, lines)


def _next(lines: Iterator[str]) -> str:
    line = next(lines, None)
    if line is None:
        raise ValueError("it ends within a matrix")
    return line


def _integers(line: str, count: int) -> list[int]:
    """Whole numbers of a line: in columns of 8 or of 16 characters, or apart by blanks."""
    parts = line.split()
    if len(parts) != count:
        width = 16 if len(line.rstrip()) > 8 * count else 8
        parts = [line[width * k : width * (k + 1)] for k in range(count)]
    return [int(part) for part in parts]


def _text_matrix(line: str, lines: Iterator[str]) -> tuple[_Head, Floats]:
    width = 8 if re.match(r"[A-Za-z]", line[32:33]) else 16
    columns, rows, form, precision = (int(line[width * k : width * (k + 1)]) for k in range(4))
    name = line[4 * width : 4 * width + 8].strip()
    head = _checked(_Head(columns, abs(rows), rows < 0, form, precision, name))
    described = line[4 * width + 8 :].strip() or "1P,5E16.9"
    form_of = _HEAD.search(described)
    if form_of is None:
        raise ValueError(f"matrix {name} has numbers of the form {described!r}")
    per_line, digits = int(form_of[1]), int(form_of[2])
    matrix = head.empty()
    while True:
        column, row, count = _integers(_next(lines), 3)
        if not 1 <= column <= head.columns + 1:
            raise ValueError(f"matrix {name} has a column {column}")
        if column > head.columns:
            _next(lines)
            return head, matrix
        if row:
            _put(head, matrix, column, row, _numbers(lines, count, per_line, digits))
            continue
        while count > 0:
            words = _integers(_next(lines), 1 + head.big)
            row, length = _string(head, words)
            _put(head, matrix, column, row, _numbers(lines, length, per_line, digits))
            count -= length * head.words + 1 + head.big


def _numbers(lines: Iterator[str], count: int, per_line: int, width: int) -> Floats:
    found: list[float] = []
    while len(found) < count:
        line = _next(lines)
        wanted = min(per_line, count - len(found))
        for k in range(wanted):
            found.append(float(line[width * k : width * (k + 1)].replace("D", "E")))
    return np.array(found)


# --- binary --------------------------------------------------------------------------


class _Records:
    """Records of a binary file, each with its length before and after it."""

    def __init__(self, content: bytes) -> None:
        self.content, self.at = content, 0
        self.order = "<" if struct.unpack("<i", content[:4])[0] in (24, 48) else ">"

    def next(self) -> bytes | None:
        if self.at >= len(self.content):
            return None
        (length,) = struct.unpack_from(f"{self.order}i", self.content, self.at)
        end = self.at + 4 + length
        if length < 0 or end + 4 > len(self.content):
            raise ValueError("a record is longer than the file")
        if struct.unpack_from(f"{self.order}i", self.content, end)[0] != length:
            raise ValueError("a record ends with another length than it begins with")
        record = self.content[self.at + 4 : end]
        self.at = end + 4
        return record


def _binary(content: bytes) -> Iterator[tuple[_Head, Floats]]:
    records = _Records(content)
    while (record := records.next()) is not None:
        yield _binary_matrix(records, record)


def _binary_matrix(records: _Records, record: bytes) -> tuple[_Head, Floats]:
    if len(record) not in (24, 48):
        raise ValueError(f"a matrix begins with {len(record)} bytes")
    size = len(record) // 6  # of a word
    whole = np.dtype(f"{records.order}i{size}")
    columns, rows, form, precision = np.frombuffer(record, whole, 4).tolist()
    name = record[4 * size :].decode("ascii").replace("\0", " ").strip()
    name = name.split()[0] if name else ""
    head = _checked(_Head(columns, abs(rows), rows < 0, form, precision, name))
    kind = np.dtype(f"{records.order}f{8 if precision in (2, 4) or size == 8 else 4}")
    words = head.words if size == 4 else 1
    matrix = head.empty()
    while True:
        record_of = records.next()
        if record_of is None:
            raise ValueError("it ends within a matrix")
        column, row, _ = np.frombuffer(record_of, whole, 3).tolist()
        if not 1 <= column <= head.columns + 1:
            raise ValueError(f"matrix {name} has a column {column}")
        if column > head.columns:
            return head, matrix
        data = record_of[3 * size :]
        if row:
            _put(head, matrix, column, row, np.frombuffer(data, kind).astype(float))
            continue
        _put_strings(head, matrix, column, data, (whole, kind, words))


def _put_strings(
    head: _Head,
    matrix: Floats,
    column: int,
    data: bytes,
    forms: tuple[np.dtype[np.signedinteger], np.dtype[np.floating], int],
) -> None:
    """Put the strings of a sparse column into the matrix."""
    whole, kind, words = forms
    at, before = 0, (1 + head.big) * whole.itemsize
    own = head._replace(precision=words)  # in files of 64 bits all numbers are one word
    while at < len(data):
        marks = np.frombuffer(data, whole, 1 + head.big, at).tolist()
        row, length = _string(own, marks)
        values = np.frombuffer(data, kind, length, at + before).astype(float)
        _put(head, matrix, column, row, values)
        at += before + length * kind.itemsize
