"""Force and moment of histories across the shaft: where they point, and their loops."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.turbine_loads.histories.classes import Classes, added, in_classes
from fe_drivetrain.turbine_loads.histories.polar import direction
from fe_drivetrain.turbine_loads.hub_loads.histories import MIN_SAMPLES
from fe_drivetrain.turbine_loads.hub_loads.loops import (
    SHARE,
    Loops,
    find_loops,
    loop_statistics,
    time_on_loops,
)

PLANES = (("force", 1), ("moment", 4))
"""Names, and where the component along y stands among the six."""

SECTORS = 36
"""Number of directions across the shaft; the first is about 0 deg, which is right."""


@dataclass(frozen=True, eq=False)
class PlaneDigest:
    """The force, or the moment, of one history across the shaft.

    Attributes
    ----------
    positions : Classes
        Time [s] by components to the right and up, looking downwind.
    directions : ndarray, (36,)
        Time in each of `SECTORS` directions [s].
    loops : ndarray, (3, n)
        Duration [s], swept angle [deg] and range of the magnitude [N, N m] of each load loop.
    loop_seconds : float
        Time on loops [s].
    over_passing : float
        Loops over passages of a blade (3P); NaN where the rotor's speed is not known.
    """

    positions: Classes
    directions: Floats
    loops: Floats
    loop_seconds: float
    over_passing: float


def plane_digest(
    time: Floats,
    y: Floats,
    z: Floats,
    step: float | Floats,
    rotor_speed: Floats | None,
    pieces: Sequence[slice] = (slice(None),),
) -> PlaneDigest:
    """Where a force or a moment points across the shaft, and which loops it runs through.

    Parameters
    ----------
    time : ndarray, (n,)
        [s].
    y, z : ndarray, (n,)
        Its components, to the left and up, looking downwind [N, N m].
    step : float or ndarray, (n,)
        Time that each sample stands for [s].
    rotor_speed : ndarray, (n,) or None
        [rad/s].
    pieces : sequence of slice
        Samples between gaps: no loop leads over a gap.
    """
    sector = (direction(y, z) * (SECTORS / (2.0 * np.pi)) + 0.5).astype(int) % SECTORS
    loops = _loops(time, y, z, pieces)
    passing = (
        None if rotor_speed is None else 3.0 * float(np.abs(rotor_speed).mean()) / (2.0 * np.pi)
    )
    numbers = loop_statistics(loops, len(y) * float(np.mean(step)), passing or None)
    return PlaneDigest(
        in_classes(-y, z, weights=np.full(len(y), step)),
        np.asarray(np.bincount(sector, np.full(len(y), step), SECTORS), dtype=np.float64),
        np.stack([loops.duration, np.degrees(loops.swept), loops.highest - loops.lowest]),
        time_on_loops(loops),
        numbers.get("rate over 3P", np.nan),
    )


def _loops(time: Floats, y: Floats, z: Floats, pieces: Sequence[slice]) -> Loops:
    """Loops of all pieces, in their order; each leads away by a share of the mean of them all."""
    if len(pieces) < 2:
        return find_loops(time, y, z)
    excursion = SHARE * float(np.hypot(y, z).mean()) or None
    found = [
        find_loops(time[one], y[one], z[one], excursion=excursion)
        for one in pieces
        if one.stop - one.start >= MIN_SAMPLES
    ]
    names = [field.name for field in fields(Loops)]
    return Loops(*(np.concatenate([getattr(one, n) for one in found]) for n in names))


@dataclass(frozen=True, eq=False)
class PlaneTotals:
    """The force, or the moment, of all histories across the shaft.

    Attributes
    ----------
    positions : Classes
        Time [s] by components to the right and up, looking downwind.
    directions : ndarray, (36,)
        Time in each of `SECTORS` directions [s].
    loops : tuple of ndarray
        (3, n) of each history: duration [s], swept angle [deg] and range of the magnitude [N, N m]
        of each load loop.
    loop_seconds, seconds : float
        Time on loops, and of all histories [s].
    over_passing_seconds : float
        Loops over passages of a blade (3P), summed over the time of histories [s]; NaN where a
        history has no rotor speed.
    """

    positions: Classes
    directions: Floats
    loops: tuple[Floats, ...]
    loop_seconds: float
    seconds: float
    over_passing_seconds: float

    @property
    def count(self) -> int:
        """How many loops there are."""
        return sum(one.shape[1] for one in self.loops)

    @property
    def share(self) -> float:
        """Share of time on loops."""
        return self.loop_seconds / self.seconds

    @property
    def over_passing(self) -> float | None:
        """Loops over passages of a blade (3P); None where a history has no rotor speed."""
        mean = self.over_passing_seconds / self.seconds
        return None if np.isnan(mean) else mean


class PlaneSums:
    """Sums over histories, one after the other, of which `PlaneTotals` are made."""

    def __init__(self) -> None:
        self._positions: Classes | None = None
        self._directions = np.zeros(SECTORS)
        self._loops: list[Floats] = []
        self._sums = np.zeros(3)
        self._absent = False

    def add(self, found: PlaneDigest | None, seconds: float) -> None:
        """Add a history that lasts so many seconds; None of one that lacks a component."""
        if found is None:
            self._absent = True
            return
        own, before = found.positions, self._positions
        self._positions = own if before is None else added([before, own])
        self._directions = self._directions + found.directions
        self._loops.append(found.loops.reshape(3, -1))
        self._sums += [found.loop_seconds, seconds, found.over_passing * seconds]

    def totals(self) -> PlaneTotals | None:
        """All histories so far, one or more; None where one lacks a component."""
        if self._absent or self._positions is None:
            return None
        return PlaneTotals(
            self._positions, self._directions, tuple(self._loops), *self._sums.tolist()
        )
