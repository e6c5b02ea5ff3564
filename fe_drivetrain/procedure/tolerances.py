"""When a tolerance, a spread, a limit or a source says nothing: rules with their reasons.

A share w allows values from 1 - w to 1 + w. Where the ends are a factor of two or more apart, w
from a third on, it says nothing of a drivetrain: a load that acts at once has twice the effect of
one that comes slowly, and a load on one of two bearings is twice that on both, so that a model
without dynamics, or without the load path, would pass as well as the right one.

A lower limit of 0 or less is met by every margin. A limit that is more than a hundred times the
value away from 0 is no limit of that load: safety factors are one to ten, and a unit that was
mistaken (N for kN) is a factor of a thousand.
"""

from __future__ import annotations

import re

APART = 2.0
"""Ratio of both ends of a tolerance from which on it says nothing."""

WIDEST = (APART - 1.0) / (APART + 1.0)
"""The share at which they are so far apart: a third."""

FARTHEST = 100.0
"""Ratio of a limit to the value from which on it is none of that load."""

EXAMPLE = 0.05
"""A share that says something, for sentences."""

_GUESS = re.compile(
    r"\b(guess\w*|assum\w*|estimat\w*|unknown|unclear|tbd|tbc|n/?a|none|rule of thumb|experience)\b"
    r"|^\W*$",
    re.IGNORECASE,
)


def is_vacuous(share: float) -> bool:
    """Whether a tolerance or half width says nothing.

    Parameters
    ----------
    share : float
        Share of the value, 0.05 of 5 %.
    """
    # written so that a third, and what is no number, are vacuous
    return not (1.0 + share) < APART * (1.0 - share)


def why_vacuous(what: str, share: float, key: str) -> str:
    """That a tolerance says nothing, in a sentence; empty where it says something.

    Parameters
    ----------
    what : str
        As "accuracy of 'torque'".
    share : float
        Half width over the value.
    key : str
        Place of the share in the project, as in "campaign.signals: accuracy".
    """
    if not is_vacuous(share):
        return ""
    return (
        f"{what} of {100 * share:g} % says nothing, since {100 * (1 - share):g} to "
        f"{100 * (1 + share):g} % of the right value would pass: {must_be_below(key)}"
    )


def must_be_below(key: str) -> str:
    """The range that is allowed, and the key to set, as the end of a sentence.

    Parameters
    ----------
    key : str
        Place of the share in the project, as in "campaign.signals: accuracy".
    """
    section, _, name = key.partition(": ")
    return (
        f"it must be above 0 and below {100 * WIDEST:.3g} %: under {section} set {name} to less "
        f"than {WIDEST:.3g}, for instance {name}: {EXAMPLE:g}"
    )


def is_guess(source: str) -> bool:
    """Whether a source is a guess by its own words, or no words at all.

    Parameters
    ----------
    source : str
        As the project has it.
    """
    return _GUESS.search(source) is not None


def why_no_limit(value: float, unit: str, at_most: float | None, at_least: float | None) -> str:
    """That a limit is none, in a sentence; empty where it is one.

    Parameters
    ----------
    value : float
        What is held against it.
    unit : str
        Unit of both; a margin has none.
    at_most, at_least : float or None
        The limit.
    """
    if at_most is None and at_least is None:
        return "no limit is stated: give at_most, as a capacity, or at_least, as a margin"
    if at_least is not None and at_least <= 0.0 and unit in ("", "-"):
        return f"at_least {at_least:g} says nothing, as every margin has it: give one above 0"
    far = FARTHEST * abs(value)
    for side, limit, beyond in (
        ("at_most", at_most, at_most is not None and at_most > far),
        ("at_least", at_least, at_least is not None and at_least < -far),
    ):
        if beyond and value != 0.0:
            return (
                f"{side} {limit:g} is more than {FARTHEST:g} times the value, {value:.4g}: it is "
                "no limit of this load: correct its unit, or give that of the part"
            )
    return ""
