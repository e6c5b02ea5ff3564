"""Tolerances that follow from how a number was made: printed digits, roundings of doubles."""

from __future__ import annotations

from typing import TypedDict

import numpy as np


class AsPrinted(TypedDict):
    """What a check is given of a printed number: `reference`, `within` in its unit, and why."""

    reference: float
    within: float
    relative: bool
    why: str


class Rounded(TypedDict):
    """What a check is given of an identity: `within`, and why."""

    within: float
    why: str


def digit(printed: str) -> float:
    """One unit of the last digit of a number as printed, such as "3.69e7"."""
    mantissa, _, power = printed.lower().partition("e")
    decimals = len(mantissa.partition(".")[2])
    return float(10.0 ** (int(power or 0) - decimals))


def as_printed(printed: str) -> AsPrinted:
    """A printed number as the reference of a check, half of its last digit as the tolerance.

    Parameters
    ----------
    printed : str
        The number with the digits that count, such as "2.45e4" of 24500 that ends in rounded ones.

    Returns
    -------
    dict
        For ``page.equals(quantity, computed, **as_printed("2.886"), source=...)``.
    """
    return {
        "reference": float(printed),
        "within": 0.5 * digit(printed),
        "relative": False,
        "why": f"half of the last digit that is printed, {printed}",
    }


def round_off(roundings: float, of: str) -> Rounded:
    """Tolerance of numbers that are equal but for the roundings on the way.

    Parameters
    ----------
    roundings : float
        How many of them add up at most, each as often as cancellation or a condition number
        enlarges it; relative to the number, or to what it is divided by.
    of : str
        What is rounded, and why as often.

    Returns
    -------
    dict
        For ``page.vanishes(quantity, computed, **round_off(40, "sums of ..."), source=...)``.
    """
    within = float(roundings * np.finfo(float).eps)
    return {"within": within, "why": f"{of}: {roundings:.2g} roundings of 2.2e-16"}
