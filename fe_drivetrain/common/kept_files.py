"""The form of a kept file: full key, layout and SHA-256 of all that it holds, compared on reading.

The first two lines say the form's version, and the digest and length of the two lines after them:
layout with the digest of the data, and key. The data follow, array by array, as they lie in memory.
Each bit of a file is thus compared with a digest, or decides on what is compared.
"""

from __future__ import annotations

import hashlib
import json
import math
import os
import re
from collections.abc import Callable, Mapping
from io import BufferedReader
from pathlib import Path
from typing import Any, BinaryIO

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.regular_files import opened

FORM = 1
"""Version of the form: files of another one are made again."""

SUFFIX = ".arrays"

_START = re.compile(rb"fe-drivetrain kept file (\d{4})\n([0-9a-f]{64}) (\d{16})\n")
_START_LENGTH = 24 + 5 + 64 + 1 + 16 + 1
_BLOCK = 1 << 20  # bytes read and hashed at a time, while they are in the processor's cache


class UnfitError(Exception):
    """A kept file is damaged, or of something else; the message says which."""


def write_kept(stream: BinaryIO, kind: str, key: str, arrays: Mapping[str, NDArray[Any]]) -> None:
    """Write arrays with what they were made from.

    Parameters
    ----------
    stream : file
        Open for writing bytes, at its beginning.
    kind : str
        What it is.
    key : str
        All that the arrays depend on, in one line.
    arrays : Mapping[str, ndarray]
        By name, of numbers or text.

    Raises
    ------
    TypeError
        An array holds objects or records.
    """
    whole = {name: _contiguous(np.asarray(array)) for name, array in arrays.items()}
    data = hashlib.sha256()
    for array in whole.values():
        data.update(_bytes(array))
    layout = {
        "kind": kind,
        "arrays": [[name, *_layout(array)] for name, array in whole.items()],
        "sha256": data.hexdigest(),
    }
    head = f"{json.dumps(layout)}\n{key}\n".encode()
    digest = hashlib.sha256(head).hexdigest()
    stream.write(f"fe-drivetrain kept file {FORM:04d}\n{digest} {len(head):016d}\n".encode())
    stream.write(head)
    for array in whole.values():
        stream.write(_bytes(array))


def read_kept(file: Path, kind: str, key: str) -> dict[str, NDArray[Any]]:
    """Arrays by name, with the same layout in memory as when they were written.

    Each is read straight into its place and hashed on the way: memory holds it once.

    Parameters
    ----------
    file : Path
        The kept file.
    kind, key : str
        As it was written.

    Raises
    ------
    OSError
        It cannot be read.
    UnfitError
        It is damaged, of another version, or of another key.
    """
    with opened(file) as stream:
        layout = _head(stream, kind, key)
        forms = [
            (name, np.dtype(text), shape, order) for name, text, shape, order in layout["arrays"]
        ]
        promised = sum(dtype.itemsize * math.prod(shape) for _, dtype, shape, _ in forms)
        if promised != os.fstat(stream.fileno()).st_size - stream.tell():
            raise UnfitError("it is cut off, or something was added to it")
        data = hashlib.sha256()
        arrays: dict[str, NDArray[Any]] = {}
        for name, dtype, shape, order in forms:
            arrays[name] = np.empty(shape, dtype, order)
            _fill(_bytes(arrays[name]), stream, data.update)
    if data.hexdigest() != layout["sha256"]:
        raise UnfitError("its data are damaged")
    return arrays


def _head(stream: BufferedReader, kind: str, key: str) -> dict[str, Any]:
    """The layout of a file, whose head is sound and has this key."""
    start = _START.fullmatch(stream.read(_START_LENGTH))
    if start is None or int(start[1]) != FORM:
        raise UnfitError("it is damaged, or of another version")
    length = int(start[3])
    if length > os.fstat(stream.fileno()).st_size:
        raise UnfitError("it is cut off")
    head = stream.read(length)
    if hashlib.sha256(head).hexdigest().encode() != start[2]:
        raise UnfitError("it is damaged")
    first, second, _ = head.decode().split("\n")
    layout: dict[str, Any] = json.loads(first)
    if (layout["kind"], second) != (kind, key):
        raise UnfitError("it is of something else")
    return layout


def _fill(place: memoryview, stream: BufferedReader, update: Callable[[Any], None]) -> None:
    """Read bytes into their place, and hash them on the way."""
    for begin in range(0, len(place), _BLOCK):
        block = place[begin : begin + _BLOCK]
        if stream.readinto(block) != len(block):
            raise UnfitError("it is cut off")
        update(block)


def _contiguous(array: NDArray[Any]) -> NDArray[Any]:
    """The array, in one piece of memory and of a type that its name tells whole."""
    if array.dtype.kind not in "biufcSU":
        raise TypeError(f"an array of {array.dtype} cannot be kept: give numbers or text")
    return array if array.flags.forc else np.array(array, order="C")


def _layout(array: NDArray[Any]) -> tuple[str, tuple[int, ...], str]:
    return array.dtype.str, array.shape, "C" if array.flags.c_contiguous else "F"


def _bytes(array: NDArray[Any]) -> memoryview:
    """The memory of an array in one piece, as bytes in their order."""
    return array.ravel("A").view(np.uint8).data
