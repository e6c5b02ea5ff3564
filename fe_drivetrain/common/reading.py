"""Typed models from YAML text: one reader, one setter by dotted key, one translator of faults.

Every mistake becomes one sentence with the object, the value, the allowed range and the fix.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Mapping, Sequence
from copy import deepcopy
from difflib import get_close_matches
from functools import lru_cache
from pathlib import Path
from typing import Any, TypeVar

import yaml
from pydantic import BaseModel, ValidationError
from pydantic.fields import FieldInfo

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.regular_files import (
    MAX_BYTES,
    NotRegularError,
    TooLargeError,
    content_of,
    require_regular,
)
from fe_drivetrain.common.strict_yaml import PlainLoader, shown

_MAX_BYTES = 1_000_000
_LONGEST_KEY = 100  # characters of a dotted key in a message

_Model = TypeVar("_Model", bound=BaseModel)


def why_unreadable(error: OSError | ValueError) -> str:
    """Why a user's file cannot be read, and what to do: the end of a sentence.

    Parameters
    ----------
    error : OSError or ValueError
        From opening the file, or from decoding all of it.

    Returns
    -------
    str
        As in "there is no such file: check the path".
    """
    if isinstance(error, NotRegularError):
        return f"{error}: write what comes from it to a file, and give that"
    if isinstance(error, TooLargeError):
        return f"{error}: shorten it"
    if isinstance(error, FileNotFoundError | NotADirectoryError):
        return "there is no such file: check the path"
    if isinstance(error, PermissionError):
        return "it may not be read: change its permissions, or copy it"
    if isinstance(error, IsADirectoryError):
        return "it is a folder: give a file"
    if isinstance(error, UnicodeDecodeError):
        line = error.object.count(b"\n", 0, error.start) + 1
        return (
            f"it is not UTF-8 text (byte 0x{error.object[error.start]:02x} in line {line}): save "
            "it as UTF-8"
        )
    if isinstance(error, OSError):
        return f"{error.strerror or error}: give another file"
    return "its name cannot be that of a file: check the path"  # with a null byte


def unreadable(path: str | Path, kind: str, error: OSError | ValueError) -> InputError:
    """The sentence about a user's file that cannot be read.

    Parameters
    ----------
    path : str or Path
        The file.
    kind : str
        What it should hold: "scene file", "ElastoDyn input".
    error : OSError or ValueError
        See `why_unreadable`.

    Returns
    -------
    InputError
        To be raised from the error.
    """
    return InputError(f"cannot read {kind} {path}: {why_unreadable(error)}")


def require_readable(path: str | Path, kind: str) -> None:
    """Refuse a user's file that cannot be read, before a library opens it by its name.

    Parameters
    ----------
    path : str or Path
        The file.
    kind : str
        Kind of file, see `unreadable`.

    Raises
    ------
    InputError
        There is no such file, it is no regular file, or it is too large.
    """
    try:
        require_regular(path, MAX_BYTES)
    except (OSError, ValueError) as error:
        raise unreadable(path, kind, error) from error


def read_text(path: str | Path, kind: str) -> str:
    """Text of a file of at most 1 MB.

    Parameters
    ----------
    path : str or Path
        The file.
    kind : str
        What it should hold, for messages: "scene", "drivetrain".

    Returns
    -------
    str

    Raises
    ------
    InputError
        The file cannot be read, is too large, or is not UTF-8.
    """
    try:
        return content_of(path, _MAX_BYTES).decode("utf-8")
    except (OSError, ValueError) as error:  # no file, no text, or no name of a file
        raise unreadable(path, f"{kind} file", error) from error


def parse_mapping(text: str, source: str) -> dict[str, Any]:
    """Keys and values of plain YAML text.

    Parameters
    ----------
    text : str
        YAML without anchors, aliases or tags, see `strict_yaml`.
    source : str
        Where the text comes from, for messages.

    Returns
    -------
    dict

    Raises
    ------
    InputError
        The text is not such YAML, or not a mapping.
    """
    try:
        data = deepcopy(_parsed(text))
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        said = " ".join(str(error).split()).replace('in "<unicode string>", ', "at ")
        raise InputError(f"{source} is not plain YAML: {said}") from error
    if not isinstance(data, dict):
        raise InputError(
            f"{source} must be a mapping of keys to values: write lines such as 'KEY: VALUE'"
        )
    return data


@lru_cache(maxsize=64)  # as many files as the library has, and more
def _parsed(text: str) -> Any:
    """Content of plain YAML: commands read one file several times, and parsing is most of it."""
    return yaml.load(text, Loader=PlainLoader)


def validated(model: type[_Model], data: Any, source: str) -> _Model:
    """Check data against a model.

    Parameters
    ----------
    model : type
        A pydantic model.
    data : Any
        Mappings, lists, words and numbers.
    source : str
        Where the data come from, for messages.

    Returns
    -------
    model

    Raises
    ------
    InputError
        The first fault in one sentence.
    """
    try:
        return model.model_validate(data)
    except InputError as error:  # from a part, whose message is a sentence already
        raise InputError(f"{source}: {error}") from error
    except ValidationError as error:
        raise InputError(f"{source}: {fault_sentence(error, model, data)}") from error


def changed(instance: _Model, changes: Mapping[str, Any], source: str) -> _Model:
    """A copy of a model with other values by dotted key; see `set_by_key` and `validated`."""
    data = instance.model_dump(mode="json")
    for key, value in changes.items():
        set_by_key(data, key, value)
    return validated(type(instance), data, source)


def set_by_key(data: Any, key: str, value: Any) -> None:
    """Replace one value, in place.

    Parameters
    ----------
    data : dict or list
        Mappings and lists, nested.
    key : str
        Dotted, as in "shaft.sections.0.length". An entry of a list goes by its number from 0 on, or
        by its name: that under "name", of its own or of a mapping in it.
    value : Any
        The new value; mappings on the way to it are made where there are none.

    Raises
    ------
    InputError
        A list has no such entry, or the key leads into a value.
    """
    *path, last = key.split(".")
    target = data
    for part in path:
        if isinstance(target, dict):
            target = target.setdefault(part, {})
        elif (entry := _entry(target, part)) is not None:
            target = target[entry]
        else:
            raise _no_entry(key, part, target)
    if isinstance(target, dict):
        target[last] = value
    elif (entry := _numbered(target, last)) is not None:
        target[entry] = value
    else:
        raise _no_entry(key, last, target)


def value_by_key(data: Any, key: str) -> Any:
    """The value that a dotted key leads to, None where there is none; see `set_by_key`."""
    for part in key.split("."):
        if isinstance(data, dict):
            data = data.get(part)
        elif (entry := _entry(data, part)) is not None:
            data = data[entry]
        else:
            return None
    return data


def value_changes(before: Any, after: Any) -> list[tuple[str, Any, Any]]:
    """What nested mappings and lists state differently.

    Parameters
    ----------
    before, after : dict or list
        Plain data.

    Returns
    -------
    list of tuple
        Dotted key, and both values (None where there is none).
    """
    a, b = _flat(before, ""), _flat(after, "")
    return [(k, a.get(k), b.get(k)) for k in dict.fromkeys([*a, *b]) if a.get(k) != b.get(k)]


def _flat(value: Any, key: str) -> dict[str, Any]:
    """Values of nested mappings and lists by dotted key."""
    if isinstance(value, Mapping):
        parts = list(value.items())
    elif isinstance(value, list):
        parts = list(enumerate(value))
    else:
        return {key: value}
    found: dict[str, Any] = {}
    for name, part in parts:
        found |= _flat(part, f"{key}.{name}" if key else str(name))
    return found


def named_keys(data: Any) -> list[str]:
    """Every dotted key of nested mappings and lists, entries of lists by name where they have one.

    Parameters
    ----------
    data : dict or list
        Plain data; see `set_by_key`.
    """
    found = []
    parts = data.items() if isinstance(data, dict) else enumerate(data)
    for part, value in parts:
        name = next(iter(_names(value)), part) if isinstance(data, list) else part
        inner = named_keys(value) if isinstance(value, dict | list) else []
        found += [str(name), *(f"{name}.{key}" for key in inner)]
    return found


def _numbered(target: Any, part: str) -> int | None:
    """Position in a list by its number; None of what is no list, or has no such entry."""
    if not isinstance(target, list) or not part.isdecimal():
        return None
    # not int(part): it takes numerals of any script, and fails for very many digits
    return next((k for k in range(len(target)) if str(k) == part), None)


def _entry(target: Any, part: str) -> int | None:
    """Position in a list by number or name."""
    number = _numbered(target, part)
    if number is not None or not isinstance(target, list):
        return number
    return next((k for k, entry in enumerate(target) if part in _names(entry)), None)


def _names(entry: Any) -> list[str]:
    """Names that an entry of a list goes by: its own, or those of mappings in it."""
    if not isinstance(entry, dict):
        return []
    inner = (value for value in entry.values() if isinstance(value, dict))
    names = (holder.get("name") for holder in (entry, *inner))
    return [name for name in names if isinstance(name, str)]


def _no_entry(key: str, part: str, target: Any) -> InputError:
    there = ""
    if isinstance(target, list) and target:
        names = [name for entry in target for name in _names(entry)[:1]]
        named = f"{', '.join(names)}, or by number " if names else ""
        there = f"; there are {named}0 to {len(target) - 1}"
    return InputError(
        f"key {shown(key)}: there is no {shown(part)}{there}: use a key that the file has"
    )


#: What a value must do, by pydantic's type of the fault.
_RULES = {
    "greater_than": "be greater than {gt:g}",
    "greater_than_equal": "be at least {ge:g}",
    "less_than": "be less than {lt:g}",
    "less_than_equal": "be at most {le:g}",
    "literal_error": "be {expected}",
    "finite_number": "be a finite number",
    "float_parsing": "be a number in SI units, without the unit",
    "float_type": "be a number in SI units, without the unit",
    "int_from_float": "be a whole number",
    "int_parsing": "be a whole number",
    "int_type": "be a whole number",
    "string_type": "be a text, in quotes where it looks like a number",
    "too_short": "have at least {min_length} values, not {actual_length}",
    "too_long": "have at most {max_length} values, not {actual_length}",
    "model_type": "be a mapping of keys to values",
    "dict_type": "be a mapping of keys to values",
    "tuple_type": "be a list",
    "union_tag_not_found": "be a mapping of keys to values",
}


def fault_sentence(error: ValidationError, model: type[BaseModel], data: Any = None) -> str:
    """The first fault that pydantic found, as key, value, allowed range and fix.

    Parameters
    ----------
    error : ValidationError
        From a validation of `model`.
    model : type
        Its fields, and those of the models in it, give meanings and known keys.
    data : Any
        What was validated: entries of its lists go by their names, where they have any.

    Returns
    -------
    str
        As in "gearbox.weight is -1 but must be at least 0 (weight [N], along -z): correct it".
    """
    faults: Sequence[Any] = error.errors(include_url=False)
    # A misspelt key first: what is missing is often the same key, spelt right.
    fault = min(faults, key=lambda f: f["type"] != "extra_forbidden")
    return _sentence(fault, faults, model, data)


def fault_sentences(
    error: ValidationError, model: type[BaseModel], data: Any = None
) -> Iterator[str]:
    """All faults that pydantic found; see `fault_sentence`.

    Parameters
    ----------
    error : ValidationError
        From a validation of `model`.
    model : type
        Its fields give meanings and known keys.
    data : Any
        What was validated.

    Yields
    ------
    str
        One for each key, misspelt keys first.
    """
    faults: list[Any] = error.errors(include_url=False)
    told: set[str] = set()
    for fault in sorted(faults, key=lambda f: f["type"] != "extra_forbidden"):
        if (key := _key(fault, model, data)) not in told:
            told.add(key)
            yield _sentence(fault, faults, model, data)


def _sentence(fault: Any, faults: Sequence[Any], model: type[BaseModel], data: Any) -> str:
    kind, key = fault["type"], _key(fault, model, data)
    owner, field = _field(model, fault["loc"])
    if kind == "extra_forbidden":
        known = list(owner.model_fields)
        close = get_close_matches(str(fault["loc"][-1]), known, n=1)
        hint = f" (did you mean {close[0]!r}?)" if close else ""
        return f"unknown key {shown(key)}{hint}: use one of {', '.join(known)}"
    meaning = f" ({field.description})" if field is not None and field.description else ""
    if kind == "missing":
        return f"{key}{meaning} is missing: add it"
    given = fault["input"]
    value = f" is {shown(given)}" if isinstance(given, int | float | str) else ""
    if kind not in _RULES:  # a rule of the model's own, with its fix
        message = str(fault["msg"]).removeprefix("Value error, ")
        return f"{key}{value}: {message}".removeprefix(": ")
    rule = _RULES[kind].format(**fault.get("ctx", {}))
    words = [
        f["ctx"]["expected"]
        for f in faults
        if f["type"] == "literal_error" and f is not fault and _key(f, model, data) == key
    ]
    rule = ", or ".join([rule, *words])
    return f"{key}{value}{' but' if value else ''} must {rule}{meaning}: correct it"


_MARK = re.compile(r"(constrained-)?(str|int|float|bool|none|dict|list|tuple|date)|.*\[.*")
"""What pydantic calls a member of a union that is no model."""


def _key(fault: Any, model: type[BaseModel], data: Any) -> str:
    """Dotted key of a fault, without pydantic's marks of the members of a union."""
    parts, models = [], [model]
    for part in fault["loc"]:
        owners = [one for one in models if part in one.model_fields]
        if owners:
            models = [m for one in owners for m in _models_in(one.model_fields[part].annotation)]
        elif not (isinstance(part, int) or (isinstance(data, dict) and part in data)) and (
            _MARK.fullmatch(part) or part in [one.__name__ for one in models]
        ):
            continue
        names: list[str] = []
        if isinstance(data, list | tuple) and isinstance(part, int) and part < len(data):
            data = data[part]
            names = [name for name in _names(data) if re.fullmatch(r"[A-Za-z][\w-]*", name)]
        elif isinstance(data, dict):
            data = data.get(part)
        parts.append(names[0] if names else str(part))
    key = ".".join(parts)
    return key if len(key) <= _LONGEST_KEY else f"{key[: _LONGEST_KEY - 3]}..."


def _field(
    model: type[BaseModel], location: Sequence[int | str]
) -> tuple[type[BaseModel], FieldInfo | None]:
    """The innermost model that a fault's location leads into, and the last field on the way."""
    field: FieldInfo | None = None
    for part in location:
        if isinstance(part, str) and part in model.model_fields:
            field = model.model_fields[part]
            model = next(iter(_models_in(field.annotation)), model)
    return model, field


def _models_in(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [m for inner in getattr(annotation, "__args__", ()) for m in _models_in(inner)]
