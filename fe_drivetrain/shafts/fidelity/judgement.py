"""Which level is good enough: one rule for studies over loads and for the adviser.

A level is good enough for a quantity if its error relative to the most accurate level, and the
band of that one, are within the tolerance together. Quantities that are slight beside the largest
of their kind do not decide: 40 % of 3 kN beside 1,740 kN change no design.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

SLIGHT = 1e-2
"""Share of the largest quantity of its kind (force or moment) below which one does not decide."""

NEGLIGIBLE = 1e-3
"""Share of the largest force below which a moment over the shaft's length does not decide."""

_UNITS = {"force": "kN", "moment": "kN m"}


@dataclass(frozen=True)
class Judged:
    """A quantity at several levels.

    Attributes
    ----------
    name : str
        What it is, as "gearbox, force".
    kind : str
        "force" or "moment".
    size : float
        Its root mean square at the most accurate level [N or N m].
    errors : Mapping[str, float]
        Error of each level, from cheap to expensive, relative to `size`.
    band : float
        Half width of the band of the most accurate level, relative to `size`.
    """

    name: str
    kind: str
    size: float
    errors: Mapping[str, float]
    band: float = 0.0

    def cheapest(self, tolerance: float) -> str | None:
        """Name of the cheapest level that is good enough; None where there is none."""
        good = (at for at, error in self.errors.items() if is_within(error, self.band, tolerance))
        return next(good, None)

    def words(self, largest: float) -> str:
        """Its name and size, with the largest of its kind where that is another."""
        unit = _UNITS[self.kind]
        beside = f", beside {_sized(largest)} {unit}" if largest > self.size else ""
        return f"{self.name} ({_sized(self.size)} {unit} root mean square{beside})"


@dataclass(frozen=True)
class Judgement:
    """The cheapest level that is good enough for all quantities that decide.

    Attributes
    ----------
    tolerance : float
        Allowed error, relative.
    level : str or None
        That level; None where there is none.
    nearest : str
        That level, or the one of the least error.
    error : float
        Largest error of that level, without the band.
    failing : Judged
        The quantity of that error: where no level is good enough, the one that fails.
    largest : Mapping[str, float]
        Largest size of each kind [N or N m].
    slight : Sequence[Judged]
        The quantities that do not decide.
    """

    tolerance: float
    level: str | None
    nearest: str
    error: float
    failing: Judged
    largest: Mapping[str, float]
    slight: Sequence[Judged]

    def failure(self) -> str:
        """The quantity of the largest error at the nearest level, with its size and band."""
        words = self.failing.words(self.largest[self.failing.kind])
        band = self.failing.band
        with_band = f" (± {100 * band:.2g} % of the assembly's mesh)" if band else ""
        return f"{words} differs by {100 * self.error:.2g} %{with_band}"


def is_within(error: float, band: float, tolerance: float) -> bool:
    """Whether an error and the band of what it is relative to are within a tolerance together."""
    return error + band <= tolerance


def is_slight(kind: str, size: float, largest: Mapping[str, float], length: float) -> bool:
    """Whether a quantity is too small beside others for a level to be judged by it.

    Parameters
    ----------
    kind : str
        "force" or "moment".
    size : float
        Size of the quantity [N or N m].
    largest : Mapping[str, float]
        Largest size of each kind [N, N m].
    length : float
        Length of the shaft [m], which makes moments comparable to forces.
    """
    if size < SLIGHT * largest[kind]:
        return True
    return kind == "moment" and size < NEGLIGIBLE * largest.get("force", 0.0) * length


def judge_levels(quantities: Sequence[Judged], tolerance: float, length: float) -> Judgement:
    """Find the cheapest level that is good enough for all quantities that decide.

    Parameters
    ----------
    quantities : Sequence[Judged]
        One or more, each with errors of the same levels.
    tolerance : float
        Allowed error, relative.
    length : float
        Length of the shaft [m].

    Returns
    -------
    Judgement
        With what fails, where there is no such level.
    """
    largest = dict[str, float]()
    for one in quantities:
        largest[one.kind] = max(one.size, largest.get(one.kind, 0.0))
    slight = [q for q in quantities if is_slight(q.kind, q.size, largest, length)]
    deciding = [q for q in quantities if q not in slight]
    worst = {
        level: max(deciding, key=lambda q: q.errors[level] + q.band)
        for level in quantities[0].errors
    }
    good = (level for level, q in worst.items() if is_within(q.errors[level], q.band, tolerance))
    level = next(good, None)
    nearest = level or min(worst, key=lambda at: worst[at].errors[at] + worst[at].band)
    failing = worst[nearest]
    return Judgement(
        tolerance, level, nearest, failing.errors[nearest], failing, largest, tuple(slight)
    )


def _sized(size: float) -> str:
    """Size in thousands, three digits."""
    return f"{float(f'{size / 1e3:.3g}'):,g}"
