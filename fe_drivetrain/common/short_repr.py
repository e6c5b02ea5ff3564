"""Records with arrays in one line: names, shapes and sizes instead of their numbers."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import fields, is_dataclass
from itertools import islice
from typing import Any

import numpy as np

LONGEST = 300
"""Characters of the line, without the name of the class."""

_SHOWN = 3  # names or numbers of a collection
_TEXT = 60  # characters of a text
_NAME = 30  # characters of one of several


def short_repr(record: object) -> str:
    """One line on a record: shapes of arrays, names in mappings, the first few of a sequence.

    ``__repr__ = short_repr`` stands in the body of the class.

    Parameters
    ----------
    record : object
        A dataclass, a named tuple, or a model of pydantic.
    """
    return f"{type(record).__name__}({', '.join(_within(_parts(record)))})"


def _parts(record: object) -> Iterator[str]:
    for name in _names(record):
        yield f"{name}={in_short(getattr(record, name))}"


def _names(record: object) -> Iterable[str]:
    if is_dataclass(record):
        return [one.name for one in fields(record) if one.repr]
    kind: Any = type(record)
    names: Iterable[str] = kind._fields if hasattr(kind, "_fields") else kind.model_fields
    return names


def _within(parts: Iterator[str]) -> Iterator[str]:
    """Parts until the line is full, then three dots."""
    length = 0
    for part in parts:
        length += len(part) + 2
        if length > LONGEST:
            yield "..."
            return
        yield part


def in_short(value: object) -> str:
    """A value in a few words, whatever it is.

    Parameters
    ----------
    value : object
        A row of numbers or a sequence as its first few or as its length, an array or matrix as its
        shape, a mapping as its keys, a record as the name of its class.
    """
    shape = getattr(value, "shape", None)
    if isinstance(value, np.ndarray) and value.ndim == 1:
        return f"[{_listed([f'{one:.4g}' for one in value[:_SHOWN]], value.size)}]"
    if isinstance(shape, tuple) and shape:
        return f"{'x'.join(map(str, shape))} array"
    if isinstance(value, str):
        return repr(value if len(value) <= _TEXT else f"{value[: _TEXT - 3]}...")
    if isinstance(value, Mapping):
        return f"{{{_listed([str(key) for key in islice(value, _SHOWN)], len(value))}}}"
    if isinstance(value, Sequence):
        return f"[{_sequence(value)}]"
    return _single(value)


def _sequence(values: Sequence[object]) -> str:
    if all(_is_plain(value) for value in values[:_SHOWN]):
        return _listed([_single(value) for value in values[:_SHOWN]], len(values))
    return f"{len(values)} of {type(values[0]).__name__}"


def _listed(first: Sequence[str], count: int) -> str:
    short = [text if len(text) <= _NAME else f"{text[: _NAME - 3]}..." for text in first]
    return ", ".join([*short, *([f"... {count} in all"] if count > len(first) else [])])


def _is_plain(value: object) -> bool:
    return value is None or isinstance(value, str | bool | int | float)


def _single(value: object) -> str:
    if isinstance(value, float):
        return f"{value:g}"
    return repr(value) if _is_plain(value) else type(value).__name__
