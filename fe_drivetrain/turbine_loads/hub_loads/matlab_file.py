"""Variables of files of MATLAB, versions 5 to 7.2, as their published layout has them.

Elements follow each other: a type, a size and data, packed by zlib or not. scipy's reader ends the
process on damaged files: it is a peer in the tests.

Source: MAT-File Format, MathWorks (R2019b), chapter 1.
"""

from __future__ import annotations

import zlib
from collections.abc import Iterator
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

_TYPES = {
    **{1: "i1", 2: "u1", 3: "i2", 4: "u2", 5: "i4", 6: "u4", 7: "f4", 9: "f8", 12: "i8", 13: "u8"},
    **{16: "u1", 17: "u2", 18: "u4"},
}
_MATRIX, _PACKED, _UTF8 = 14, 15, 16
_CELL, _STRUCT, _CHAR, _NUMBERS = 1, 2, 4, range(6, 16)
_COMPLEX = 0x0800
_HEAD = 128
_MOST = 4_000_000_000  # bytes of one variable, unpacked
_DEEPEST = 8  # structs within structs


class _Element(NamedTuple):
    """Type and data of an element."""

    kind: int
    data: memoryview


def matlab_variables(content: bytes) -> dict[str, Any]:
    """Variables by name: arrays without dimensions of one, text, structs as dicts, cells as lists.

    Others, like tables and functions, are None.

    Parameters
    ----------
    content : bytes
        Bytes of the whole file.

    Raises
    ------
    ValueError
        It is none of these versions, or is damaged.
    """
    if content[512:516] == b"\x89HDF":
        raise ValueError("it is of version 7.3: save it with '-v7'")
    order = {b"IM": "<", b"MI": ">"}.get(content[126:128])
    if order is None:
        raise ValueError("it is none of MATLAB 5 to 7.2")
    found = {}
    for element in _elements(memoryview(content)[_HEAD:], order):
        if element.kind == _PACKED:
            unpacked = zlib.decompressobj()
            data = unpacked.decompress(element.data, _MOST)
            if unpacked.unconsumed_tail:
                raise ValueError("a variable is too large")
            element = next(_elements(memoryview(data), order))
        if element.kind == _MATRIX:
            name, value = _variable(element.data, order, 0)
            found[name] = value
    return found


def _elements(data: memoryview, order: str) -> Iterator[_Element]:
    """Elements one after the other, each but packed ones filled up to eight bytes."""
    place = 0
    while place + 8 <= len(data):
        kind, size = np.frombuffer(data, f"{order}u4", 2, place).tolist()
        start = place + 8
        if kind >> 16:  # in short form
            kind, size, start = kind & 0xFFFF, kind >> 16, place + 4
            place += 8
        else:
            place = start + size + (0 if kind == _PACKED else -size % 8)
        if start + size > len(data):
            raise ValueError(f"it ends within an element of {size} bytes")
        yield _Element(kind, data[start : start + size])


def _variable(data: memoryview, order: str, depth: int) -> tuple[str, Any]:
    """Name and value of a variable."""
    if depth > _DEEPEST:
        raise ValueError("structs within structs go too deep")
    parts = _elements(data, order)
    flags = int(_array(next(parts, None), order)[0])
    shape = _array(next(parts, None), order).tolist()
    name = bytes(_array(next(parts, None), order).astype("u1")).decode("latin-1")
    kind, count = flags & 0xFF, 1
    for one in shape:
        if one < 0:
            raise ValueError(f"{name} has the size {one}")
        count *= one
    if kind == _CHAR:
        return name, _text(next(parts, None), order)
    if kind in _NUMBERS:
        values = _array(next(parts, None), order)
        if len(values) != count:
            raise ValueError(f"{name} has {len(values)} of {count} values")
        return name, None if flags & _COMPLEX else np.squeeze(values.reshape(shape, order="F"))
    if kind == _CELL:
        return name, [_variable(part.data, order, depth + 1)[1] for part in parts]
    if kind == _STRUCT and count == 1:
        return name, _fields(parts, order, depth)
    return name, None


def _fields(parts: Iterator[_Element], order: str, depth: int) -> dict[str, Any]:
    """Values of a struct by the names of its fields."""
    length = int(_array(next(parts, None), order)[0])
    if length < 1:
        raise ValueError("names of a struct have no length")
    text = bytes(_array(next(parts, None), order).astype("u1"))
    names = [text[k : k + length].split(b"\0")[0] for k in range(0, len(text), length)]
    values = [_variable(part.data, order, depth + 1)[1] for part in parts]
    return dict(zip((name.decode("latin-1") for name in names), values, strict=False))


def _text(element: _Element | None, order: str) -> str:
    """Letters of an element; of a matrix of letters one column after the other."""
    if element is not None and element.kind == _UTF8:
        return bytes(element.data).decode("utf-8", "replace")
    codes = _array(element, order).astype("u4")
    return codes.astype("<u4").tobytes().decode("utf-32-le", "replace")


def _array(element: _Element | None, order: str) -> NDArray[Any]:
    """Numbers of an element."""
    if element is None or element.kind not in _TYPES:
        raise ValueError("an element is missing, or has another type than it must have")
    kind = np.dtype(f"{order}{_TYPES[element.kind]}")
    if len(element.data) % kind.itemsize:
        raise ValueError("an element ends within a number")
    return np.frombuffer(element.data, kind)
