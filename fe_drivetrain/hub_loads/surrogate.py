"""Made hub loads: 144 ten-minute histories of a generic 2 MW turbine, so that nothing is fetched.

The grid is that of Stirling 2023, section 3.1 (whose own histories are not public): mean wind 10,
12, 16, 20 m/s; low, medium, high turbulence; power-law shear exponent 0.2 and 0.6; six seeds each.
One group of six seeds is a common parameter load set.  Wind is made by `wind` and
turned into loads by `aero_rotor`, whose docstrings say what is left out.

Repeatability: a history depends on its condition, the rotor, the duration and the rate alone, not
on what else is made, in which order, or from where (made anew or kept on disk).  The random numbers
come from a NumPy ``SeedSequence`` of all parts of the condition, so equal seed numbers under
different conditions share nothing, and no two of the histories share a wind field.  On another
machine the linear algebra may round differently, in single precision in the wind.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path
from typing import Literal, overload

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache, user_cache
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.hub_loads.aero_rotor import (
    CUT_IN,
    CUT_OUT,
    OperatingPoint,
    Rotor,
    aerodynamic_hub_loads,
    assumptions,
    operating_point,
)
from fe_drivetrain.hub_loads.histories import MIN_SAMPLES, Attribute, LoadHistory
from fe_drivetrain.hub_loads.wind import (
    REFERENCE_INTENSITY,
    DiscTurbulence,
    at_azimuth,
    disc_turbulence,
    length_scales,
    power_law,
    turbulence_sigma,
)

__all__ = [
    "Condition",
    "HubLoadSet",
    "assumptions",
    "hub_load_set",
    "hub_loads",
    "surrogate_grid",
]


VERSION = 2
"""Raise whenever a change alters the histories: kept ones of another version are not used."""

_KIND: Literal["hub-loads"] = "hub-loads"

WIND_SPEEDS = (10.0, 12.0, 16.0, 20.0)
TURBULENCES = ("low", "medium", "high")
SHEARS = (0.2, 0.6)
SEEDS = (1, 2, 3, 4, 5, 6)

DURATION = 600.0
RATE = 20.0


@dataclass(frozen=True)
class Condition:
    """The wind of one history.

    Parameters
    ----------
    wind_speed [m/s]
        Mean at hub height, within the operating range.
    turbulence
        ``"low"``, ``"medium"``, ``"high"`` (IEC classes C, B, A) or ``"none"``.
    shear
        Power-law exponent, 0 to 1.
    seed
        Of the random numbers, not negative.

    Raises
    ------
    InputError
        If a value is out of range.
    """

    wind_speed: float
    turbulence: str
    shear: float
    seed: int

    def __post_init__(self) -> None:
        if not CUT_IN <= self.wind_speed <= CUT_OUT:
            raise InputError(
                f"condition: wind_speed is {self.wind_speed} m/s; choose {CUT_IN:g} to {CUT_OUT:g}"
            )
        if self.turbulence not in REFERENCE_INTENSITY:
            raise InputError(
                f"condition: turbulence is '{self.turbulence}'; choose one of "
                f"{', '.join(REFERENCE_INTENSITY)}"
            )
        if not 0.0 <= self.shear <= 1.0:
            raise InputError(f"condition: shear exponent is {self.shear}; choose 0 to 1")
        if self.seed < 0 or self.seed != int(self.seed):
            raise InputError(f"condition: seed is {self.seed}; choose a whole number from 0")
        # 12, 12.0 and NumPy's 12 are one condition, with one file and one wind.
        object.__setattr__(self, "wind_speed", float(self.wind_speed))
        object.__setattr__(self, "shear", float(self.shear))
        object.__setattr__(self, "seed", int(self.seed))

    @property
    def name(self) -> str:
        """For example ``"12 m/s, high turbulence, shear 0.6, seed 3"``."""
        return (
            f"{self.wind_speed:g} m/s, {self.turbulence} turbulence, shear {self.shear:g}, "
            f"seed {self.seed}"
        )

    def generator(self) -> np.random.Generator:
        """Random numbers of this condition and no other."""
        # Floats enter by their bits: no two different values can fall together by rounding.
        bits = np.array([self.wind_speed, self.shear]).view(np.uint32)
        turbulence = list(REFERENCE_INTENSITY).index(self.turbulence)
        entropy = [*(int(b) for b in bits), turbulence, self.seed]
        return np.random.default_rng(np.random.SeedSequence(entropy))


def surrogate_grid() -> list[Condition]:
    """The 144 conditions of Stirling 2023, section 3.1, the seeds of one group side by side."""
    return [Condition(*c) for c in product(WIND_SPEEDS, TURBULENCES, SHEARS, SEEDS)]


@dataclass(frozen=True, eq=False)
class HubLoadSet(Sequence[LoadHistory]):
    """Histories that share their time, stacked so that a study is one matrix product.

    Attributes
    ----------
    conditions : (m,)
    time : (n,) [s]
    loads : (m, n, 6) [N, N m]
    """

    conditions: tuple[Condition, ...]
    time: Floats
    loads: Floats

    def __len__(self) -> int:
        return len(self.conditions)

    @overload
    def __getitem__(self, index: int) -> LoadHistory: ...

    @overload
    def __getitem__(self, index: slice) -> list[LoadHistory]: ...

    def __getitem__(self, index: int | slice) -> LoadHistory | list[LoadHistory]:
        """One history, or a list of them for a slice."""
        if isinstance(index, slice):
            return [self[i] for i in range(*index.indices(len(self)))]
        return _history(self.conditions[index], self.time, self.loads[index])

    def __iter__(self) -> Iterator[LoadHistory]:
        return (self[i] for i in range(len(self)))


def hub_loads(
    condition: Condition,
    duration: float = DURATION,
    rate: float = RATE,
    rotor: Rotor | None = None,
) -> LoadHistory:
    """Make one history, without looking on disk.

    Parameters
    ----------
    condition
    duration [s], rate [Hz]
    rotor
        The default rotor if not given.

    Raises
    ------
    InputError
        If duration or rate leave too few samples, or the rotor cannot work in this wind.
    """
    rotor = rotor or Rotor()
    time = _time(duration, rate)
    state = _mean_state(rotor, condition.wind_speed, duration, rate)
    return _history(condition, time, _make(rotor, condition, time, state))


def hub_load_set(
    conditions: Sequence[Condition] | None = None,
    duration: float = DURATION,
    rate: float = RATE,
    rotor: Rotor | None = None,
    *,
    cache: bool | str | os.PathLike[str] = True,
    progress: Callable[[int, int], None] | None = None,
) -> HubLoadSet:
    """Make all histories of a grid, or take those that were kept.

    Each history is kept on its own as soon as it is made, so stopping loses at most the ones in
    work.  A kept file that is damaged, or a directory that cannot be written, costs time only.

    Parameters
    ----------
    conditions
        ``surrogate_grid()`` if not given.
    duration [s], rate [Hz], rotor
        As for ``hub_loads``.
    cache
        Whether to keep histories in the user's cache, or another folder for them.
    progress
        Called with the number done and the number of all.

    Raises
    ------
    InputError
        As ``hub_loads``.
    """
    rotor = rotor or Rotor()
    grid = tuple(surrogate_grid() if conditions is None else conditions)
    time = _time(duration, rate)
    loads = np.empty((len(grid), time.size, len(FORCES)))
    kept = _cache(cache)
    done = 0

    def report() -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, len(grid))

    missing: dict[float, list[int]] = {}
    for i, condition in enumerate(grid):
        history = _load(kept, rotor, condition, duration, rate, loads[i].shape)
        if history is None:
            missing.setdefault(condition.wind_speed, []).append(i)
        else:
            loads[i] = history
            report()

    for wind_speed, indices in missing.items():
        state = _mean_state(rotor, wind_speed, duration, rate)
        for i in indices:
            loads[i] = _make(rotor, grid[i], time, state)
            kept.keep(_KIND, _content(rotor, grid[i], duration, rate), {"loads": loads[i]})
            report()
    loads.setflags(write=False)
    return HubLoadSet(grid, time, loads)


def not_kept(
    conditions: Sequence[Condition],
    duration: float = DURATION,
    rate: float = RATE,
    rotor: Rotor | None = None,
) -> list[Condition]:
    """Those that the user's cache does not hold; none where nothing can be kept."""
    cache = user_cache()
    if cache.folder is None:
        return []
    used = rotor or Rotor()
    return [c for c in conditions if not cache.has(_KIND, _content(used, c, duration, rate))]


# --- making --------------------------------------------------------------------------------------


def _mean_state(
    rotor: Rotor, wind_speed: float, duration: float, rate: float
) -> tuple[OperatingPoint, DiscTurbulence]:
    """What all histories of one mean wind speed share."""
    point = operating_point(rotor, wind_speed)
    scales = length_scales(rotor.hub_height)
    field = disc_turbulence(point.radius, rotor.harmonics, wind_speed, *scales, duration, rate)
    return point, field


def _make(
    rotor: Rotor,
    condition: Condition,
    time: Floats,
    state: tuple[OperatingPoint, DiscTurbulence],
) -> Floats:
    """Hub loads (n, 6) [N, N m] of one condition."""
    point, field = state
    generator = condition.generator()
    start = generator.uniform(0.0, 2.0 * np.pi)
    azimuth = start + point.rotor_speed * time
    sigma = turbulence_sigma(condition.wind_speed, condition.turbulence)
    coefficients = field.draw(generator) if sigma > 0.0 else None

    wind = np.empty((rotor.blades, time.size, point.radius.size))
    for blade in range(rotor.blades):
        angle = azimuth + 2.0 * np.pi * blade / rotor.blades
        above_hub = np.outer(np.cos(angle), point.radius) * np.cos(rotor.shaft_tilt)
        height = rotor.hub_height + above_hub
        wind[blade] = power_law(condition.wind_speed, height, rotor.hub_height, condition.shear)
        if coefficients is not None:
            wind[blade] += sigma * at_azimuth(coefficients, angle)
    return aerodynamic_hub_loads(rotor, point, wind, azimuth) + rotor.weight()


def _time(duration: float, rate: float) -> Floats:
    if not (np.isfinite(duration * rate) and rate > 0.0 and duration * rate >= MIN_SAMPLES):
        raise InputError(
            f"surrogate: {duration} s at {rate} Hz is no history; give a positive duration and "
            f"rate with at least {MIN_SAMPLES} samples"
        )
    return np.arange(round(duration * rate)) / rate


def _history(condition: Condition, time: Floats, loads: Floats) -> LoadHistory:
    attributes: dict[str, Attribute] = {**asdict(condition), "source": "surrogate"}
    return LoadHistory(condition.name, time, loads, attributes)


# --- keeping -------------------------------------------------------------------------------------


def _cache(cache: bool | str | os.PathLike[str]) -> Cache:
    if isinstance(cache, bool):
        return user_cache() if cache else Cache(None)
    return Cache(Path(cache))


def _content(rotor: Rotor, condition: Condition, duration: float, rate: float) -> dict[str, object]:
    """All that one history depends on."""
    return {
        "version": VERSION,
        "rotor": asdict(rotor),
        "condition": asdict(condition),
        "duration": float(duration),
        "rate": float(rate),
    }


def _load(
    cache: Cache,
    rotor: Rotor,
    condition: Condition,
    duration: float,
    rate: float,
    shape: tuple[int, ...],
) -> Floats | None:
    """A kept history, or None if it is not there or not sound."""
    arrays = cache.load(_KIND, _content(rotor, condition, duration, rate))
    loads = None if arrays is None else arrays.get("loads")
    if loads is None or loads.shape != shape or loads.dtype != np.float64:
        return None
    return loads if bool(np.isfinite(loads).all()) else None
