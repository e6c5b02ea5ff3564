"""Cards of an Abaqus or CalculiX deck: keywords with parameters, and the lines of data after them.

Rules: Abaqus Keywords Reference, "Input syntax rules"; CalculiX CrunchiX User's Manual, "Input deck
format". Neither case nor blanks matter; a keyword line that ends with a comma goes on.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from fe_drivetrain.common.errors import InputError

_INTEGER = re.compile(r"\+?[0-9]{1,15}")
_REAL = re.compile(r"[-+]?(?:[0-9]+\.?[0-9]*|\.[0-9]+)(?:[eEdD][-+]?[0-9]+)?")


@dataclass
class Card:
    """A keyword with its parameters and data.

    Attributes
    ----------
    keyword : str
        In capitals, with single blanks, as in "NODE" or "NODE FILE".
    parameters : dict of str
        Values as the file has them, without quotes, by names in capitals; empty of a mere flag.
    line : int
        Number of its line, from 1 on.
    data : list of tuple
        Number and text of each line of data that is neither blank nor a comment.
    """

    keyword: str
    parameters: dict[str, str]
    line: int
    data: list[tuple[int, str]] = field(default_factory=list)


def cards(text: str) -> Iterator[Card]:
    """Keywords of a deck with their data, in the order of the file.

    Parameters
    ----------
    text : str
        The whole deck.
    """
    card: Card | None = None
    head, begun = "", 0  # a keyword line that is not yet whole
    for number, raw in enumerate(text.splitlines(), 1):
        line = raw.strip()
        if not line or line.startswith("**"):
            continue
        if head:
            head += line
        elif line.startswith("*"):
            if card is not None:
                yield card
            card, head, begun = None, line, number
        elif card is not None:
            card.data.append((number, line))
        if head and not head.endswith(","):
            card, head = _card(head, begun), ""
    if head:
        card = _card(head, begun)
    if card is not None:
        yield card


def _card(head: str, line: int) -> Card:
    keyword, *parts = head.removeprefix("*").split(",")
    parameters = {}
    for part in parts:
        key, _, value = part.partition("=")
        if key.strip():
            parameters[" ".join(key.upper().split())] = value.strip().strip("\"'").strip()
    return Card(" ".join(keyword.upper().split()), parameters, line)


def fields(line: str) -> list[str]:
    """Fields of a line of data, without blanks; a comma at its end opens no further one."""
    found = [field.strip() for field in line.split(",")]
    return found[:-1] if len(found) > 1 and not found[-1] else found


def is_integer(text: str) -> bool:
    """Whether a field is the number of a node or element, and no name."""
    return _INTEGER.fullmatch(text) is not None


def integer(text: str, where: str) -> int:
    """The number of a node or element.

    Raises
    ------
    InputError
        It is none.
    """
    if not is_integer(text):
        raise InputError(
            f"{where}: {text[:40]!r} must be the whole number of a node or element: correct it"
        )
    return int(text)


def real(text: str, where: str) -> float:
    """A coordinate; left blank it is 0, as in Abaqus.

    Raises
    ------
    InputError
        It is no number.
    """
    if not text:
        return 0.0
    if not _REAL.fullmatch(text):
        raise InputError(f"{where}: {text[:40]!r} must be a number: correct it")
    return float(text.replace("D", "E").replace("d", "e"))
