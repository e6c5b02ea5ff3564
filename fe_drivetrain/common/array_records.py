"""Frozen dataclasses as arrays by name, as the cache keeps them, and back.

The name of an array is its path through fields and keys of mappings, as in ``cycles/ranges/Mx``,
with ``/`` and ``~`` in a key written as in a JSON pointer (RFC 6901). A field may be an array, a
number, text, a tuple of numbers, of arrays or of dataclasses, a mapping by text, a dataclass, or
one of these or None.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields, is_dataclass
from types import UnionType
from typing import Any, TypeVar, Union, get_args, get_origin, get_type_hints

import numpy as np
from numpy.typing import NDArray

from fe_drivetrain.common.kept_files import UnfitError

_T = TypeVar("_T")

_Tree = dict[str, Any]  # arrays, and branches of the same kind


def as_arrays(value: Any) -> dict[str, NDArray[Any]]:
    """All that a dataclass holds, as arrays by path.

    Parameters
    ----------
    value : dataclass
        Its fields are of the kinds that the module names.
    """
    found: dict[str, NDArray[Any]] = {}
    _put(found, "", value)
    return found


def from_arrays(kind: type[_T], arrays: Mapping[str, NDArray[Any]]) -> _T:
    """The dataclass that `as_arrays` has taken apart.

    Parameters
    ----------
    kind : type
        The dataclass.
    arrays : Mapping[str, ndarray]
        By path.

    Raises
    ------
    UnfitError
        Arrays are missing, or of another form: a program of another version has written them.
    """
    tree: _Tree = {}
    for path, array in arrays.items():
        *branches, last = (_key(part) for part in path.split("/"))
        place = tree
        for branch in branches:
            place = place.setdefault(branch, {})
            if not isinstance(place, dict):
                raise UnfitError(f"it has another form, with both {path!r} and a part of it")
        place[last] = array
    made: _T = _made(kind, tree, "")
    return made


def _put(found: dict[str, NDArray[Any]], path: str, value: Any) -> None:
    if value is None:
        return
    if is_dataclass(value):
        inner = {field.name: getattr(value, field.name) for field in fields(value)}
    elif isinstance(value, Mapping):
        inner = dict(value)
    elif isinstance(value, tuple) and any(np.ndim(p) or is_dataclass(p) for p in value):
        inner = {str(k): part for k, part in enumerate(value)}
    else:
        found[path] = np.asarray(value)
        return
    for name, part in inner.items():
        _put(found, f"{path}/{_part(name)}" if path else _part(name), part)


def _made(hint: Any, node: Any, path: str) -> Any:
    """What a type stands for, of a branch or an array; None where there is none."""
    origin, within = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType):
        (hint,) = (one for one in within if one is not type(None))
        return None if node is None else _made(hint, node, path)
    # since numpy 2.5 that of an array is an alias, and no class
    if isinstance(origin, type) and issubclass(origin, Mapping):
        branch = _branch(node, path)
        return {name: _made(within[1], part, f"{path}/{name}") for name, part in branch.items()}
    if origin is tuple and isinstance(node, dict):
        parts = ((f"{path}/{k}", node.get(str(k))) for k in range(len(node)))
        return tuple(_made(within[0], part, at) for at, part in parts)
    if is_dataclass(hint):
        return _record(hint, _branch(node, path), path)
    if not isinstance(node, np.ndarray):
        raise UnfitError(f"it has another form, without an array {path.removeprefix('/')!r}")
    if hint in (int, float, str, bool):
        return hint(node.item())
    return tuple(node.tolist()) if origin is tuple else node


def _record(kind: Any, branch: _Tree, path: str) -> Any:
    hints = get_type_hints(kind)
    names = [field.name for field in fields(kind)]
    if more := branch.keys() - set(names):
        raise UnfitError(f"it has another form, with {min(more)!r}")
    return kind(**{name: _made(hints[name], branch.get(name), f"{path}/{name}") for name in names})


def _branch(node: Any, path: str) -> _Tree:
    if isinstance(node, np.ndarray):
        raise UnfitError(f"it has another form, with an array {path.removeprefix('/')!r}")
    return node or {}


def _part(key: str) -> str:
    return key.replace("~", "~0").replace("/", "~1")


def _key(part: str) -> str:
    return part.replace("~1", "/").replace("~0", "~")
