"""Plain YAML, as in scene files and ``--set``: mappings, lists, words and numbers, and no more.

No anchors, aliases, merges or tags, so that a text cannot do or become anything but what it says.
Numbers are those of YAML 1.2: 010 is ten, and 12:30 and 2026-01-31 are words; YAML 1.1, which
PyYAML reads, makes eight, 750 and a date of them.
"""

from __future__ import annotations

import math
import re
from typing import Any

import yaml

_MAX_DEPTH = 20
_SHOWN = 60  # characters of a value in a message

_OLD_MEANINGS = {f"tag:yaml.org,2002:{kind}" for kind in ("int", "merge", "timestamp", "value")}
_NUMBER = "tag:yaml.org,2002:float"


def shown(value: object) -> str:
    """A value as it stands in a message: quoted, on one line, and not longer than a line."""
    try:
        text = repr(value)
    except ValueError:  # an integer of more digits than Python prints
        text = "a number of too many digits"
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."


def no_truth_value(value: Any) -> Any:
    """For pydantic's ``field_validator("*", mode="before")``: true is no number, and not one.

    Lists are searched to their ends: pydantic makes 1.0 of a true in them.

    Raises
    ------
    ValueError
        The value is true or false, or a list in which one stands.
    """
    # numpy's, too, which need not be loaded for that
    if isinstance(value, bool) or type(value).__name__ in ("bool", "bool_"):
        raise ValueError("a truth value has no meaning here: give a number or a word")
    for entry in value if isinstance(value, list | tuple) else ():
        no_truth_value(entry)
    return value


def digits_as_text(value: Any) -> Any:
    """A name of digits alone, such as 22330, which YAML reads as a number where it has no quotes.

    Parameters
    ----------
    value : Any
        From YAML.

    Returns
    -------
    value : Any
        Text of a whole number; anything else as it is.
    """
    whole = isinstance(value, int) or (isinstance(value, float) and value.is_integer())
    return str(int(value)) if whole and not isinstance(value, bool) else value


def _no_word(key: Any, braces: bool) -> str:
    """The sentence about a key that is no word: in braces it is what a decimal comma makes."""
    line = key.start_mark.line + 1
    fix = "put it in quotes"
    if braces and key.value.isdecimal():
        fix += f", or write a decimal point if it stands behind a comma, as in 0.{key.value}"
    return f"line {line}: key {shown(key.value)} must be a word: {fix}"


class PlainLoader(yaml.SafeLoader):
    """For ``yaml.load``; raises yaml.YAMLError, or ValueError for an integer beyond reason."""

    _depth = 0

    def compose_node(self, parent: Any, index: Any) -> Any:
        if self.check_event(yaml.AliasEvent):
            raise yaml.YAMLError("anchors and aliases are not allowed: write the values out")
        event = self.peek_event()  # type: ignore[no-untyped-call]
        if getattr(event, "anchor", None) is not None:
            raise yaml.YAMLError("anchors and aliases are not allowed: write the values out")
        if getattr(event, "tag", None) is not None:
            raise yaml.YAMLError(f"tags such as {shown(event.tag)} are not allowed")
        try:
            getattr(event, "value", "").encode()
        except UnicodeEncodeError as error:
            raise yaml.YAMLError("half a surrogate pair is no character") from error
        self._depth += 1
        if self._depth > _MAX_DEPTH:
            raise yaml.YAMLError(f"nested deeper than {_MAX_DEPTH} levels")
        node = super().compose_node(parent, index)
        self._depth -= 1
        return node

    def construct_mapping(self, node: Any, deep: bool = False) -> dict[Any, Any]:
        seen: set[str] = set()
        for key, _ in node.value:
            if key.tag != "tag:yaml.org,2002:str":
                raise yaml.YAMLError(_no_word(key, bool(node.flow_style)))
            if key.value in seen:
                raise yaml.YAMLError(f"key {shown(key.value)} stands twice in one mapping")
            seen.add(key.value)
        return super().construct_mapping(node, deep)

    def construct_number(self, node: Any) -> float:
        number = float(node.value)
        if math.isinf(number):
            raise yaml.YAMLError(f"{shown(node.value)} is too large for a number")
        return number

    def construct_whole(self, node: Any) -> int:
        self.construct_number(node)  # so that every whole number is a number, too
        return int(node.value)


PlainLoader.yaml_implicit_resolvers = {
    first: [(tag, regexp) for tag, regexp in found if tag not in (_OLD_MEANINGS | {_NUMBER})]
    for first, found in yaml.SafeLoader.yaml_implicit_resolvers.items()
}
_FIRST = list("-+.0123456789")
PlainLoader.add_implicit_resolver(
    "tag:yaml.org,2002:int", re.compile(r"[-+]?(0|[1-9][0-9]*)$", re.ASCII), _FIRST
)
PlainLoader.add_implicit_resolver(
    _NUMBER,
    re.compile(r"[-+]?(\.[0-9]+|[0-9]+(\.[0-9]*)?)([eE][-+]?[0-9]+)?$", re.ASCII),
    _FIRST,
)
PlainLoader.add_constructor(_NUMBER, PlainLoader.construct_number)
PlainLoader.add_constructor("tag:yaml.org,2002:int", PlainLoader.construct_whole)
