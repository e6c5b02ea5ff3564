"""Two sets of histories side by side: what differs by more than the scatter of seeds."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from fe_drivetrain.common.errors import InputError

_K = TypeVar("_K", bound=Hashable)

CHANCE = 0.01
"""Share of quantities that would be named if nothing differed but the seeds."""


@dataclass(frozen=True)
class Difference:
    """One quantity in two sets.

    Attributes
    ----------
    quantity : str
        What it is, with its unit.
    one, other : float
        Means over the histories of each set.
    scatter : float
        Standard deviation from one seed to the next, of both sets together.
    allowed : float
        Difference of the means that seeds alone stay below, but for a share `CHANCE`.
    """

    quantity: str
    one: float
    other: float
    scatter: float
    allowed: float

    @property
    def beyond(self) -> bool:
        """Whether the sets differ by more than their seeds explain."""
        return abs(self.one - self.other) > self.allowed

    @property
    def ratio(self) -> float:
        """The first over the second; NaN where that is zero."""
        return self.one / self.other if self.other else float("nan")


def differences(
    one: Sequence[Mapping[_K, float]],
    other: Sequence[Mapping[_K, float]],
    chance: float = CHANCE,
) -> list[Difference]:
    """Compare quantities of histories of one condition.

    Seeds are taken to scatter equally in both sets, so that a set may be one history (Student
    1908, with the standard deviation pooled).

    Parameters
    ----------
    one, other : sequence of mappings
        Quantities of each history; those that all have are compared. Their text is the name.
    chance : float
        Share of equal quantities that would be named all the same.

    Raises
    ------
    InputError
        There are fewer than three histories, so that nothing is known of their scatter.
    """
    from scipy.stats import t

    first, second = len(one), len(other)
    degrees = first + second - 2
    if min(first, second) < 1 or degrees < 1:
        raise InputError(
            f"sets of {first} and {second} histories: their scatter needs three or more together, "
            "with one or more in each"
        )
    names = [name for name in one[0] if all(name in history for history in (*one, *other))]
    factor = float(t.ppf(1.0 - chance / 2.0, degrees)) * np.sqrt(1.0 / first + 1.0 / second)
    result = []
    for name in names:
        values = [np.array([history[name] for history in own]) for own in (one, other)]
        if not all(np.isfinite(v).all() for v in values):
            continue
        squares = sum(float(((v - v.mean()) ** 2).sum()) for v in values)
        scatter = float(np.sqrt(squares / degrees))
        # what rounding alone makes of a constant channel is no difference
        rounding = 1e-9 * max(float(np.abs(v).max()) for v in values)
        allowed = max(factor * scatter, rounding)
        result.append(
            Difference(
                str(name), float(values[0].mean()), float(values[1].mean()), scatter, allowed
            )
        )
    return result
