"""How certain a result is when the inputs are not: sensitivities, samples, shares of variance.

PROTEST's step 4: how certain each input is, and the effect on the reported results. Sampling uses
a cheap level of the ladder, which the adviser selects, see `input_study`. One
evaluation of a scene answers every quantity.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from types import MappingProxyType
from typing import Any, TypeVar, cast

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import changed
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.lumped import LumpedDrivetrain
from fe_drivetrain.drivetrain_file.scene import Scene, Spread, nominal_values, with_materials
from fe_drivetrain.shafts.uncertainty.kept_rows import evaluated_rows

Stated = TypeVar("Stated", bound=Drivetrain)

Evaluate = Callable[[Stated], Mapping[str, float]]
"""Numbers of a scene, or of another drivetrain, by name."""

#: Relative step of a central difference: its error is some 1e-6 of a smooth function's.
STEP = 1e-3

#: Share of the results that a band holds.
SHARE = 0.95

NOTHING: Mapping[str, int] = MappingProxyType({})

FINER = (0.5, 0.25, 0.125, 0.0625)
"""Factors of mesh sizes, where a wall asks for smaller ones."""

_RESAMPLES = 999
_CONSTANT = 1e-9  # relative: below it no input matters to a result


@dataclass(frozen=True)
class Band:
    """Between which two values a share of the results lies, as much below as above.

    Attributes
    ----------
    low, high : float
        The two.
    low_error, high_error : float
        Standard errors, of so many samples.
    """

    low: float
    high: float
    low_error: float
    high_error: float


@dataclass(frozen=True)
class Samples:
    """One quantity over a Latin hypercube.

    Attributes
    ----------
    keys : tuple[str, ...]
        Keys of the d uncertain values.
    inputs, values : Floats
        (n, d), and (n,) the result of each sample.
    nominal : float
        The result without uncertainty.
    """

    keys: tuple[str, ...]
    inputs: Floats
    values: Floats
    nominal: float

    __repr__ = short_repr

    @property
    def varies(self) -> bool:
        """Whether any input matters to the quantity."""
        return bool(np.ptp(self.values) > _CONSTANT * abs(self.nominal))

    @property
    def deviation(self) -> float:
        """Standard deviation of the samples, in the quantity's unit."""
        return float(self.values.std(ddof=1))

    def band(self, share: float = SHARE, seed: int = 0) -> Band:
        """The band, with its errors from resampling the samples (Efron 1979) as if independent.

        Those of a Latin hypercube are about as large or smaller (Owen 1997, Ann. Statist. 25(4)).
        Resampling takes tens of milliseconds, so that a band is kept for who asks again.
        """
        if (share, seed) not in self._bands:
            self._bands[share, seed] = self._resampled(share, seed)
        return self._bands[share, seed]

    @cached_property
    def _bands(self) -> dict[tuple[float, int], Band]:
        """Bands so far, by share and seed."""
        return {}

    def _resampled(self, share: float, seed: int) -> Band:
        outside = (1.0 - share) / 2
        ends = np.quantile(self.values, [outside, 1.0 - outside])
        errors = [0.0, 0.0]
        if self.varies:
            from scipy import stats

            errors = [
                float(
                    stats.bootstrap(
                        (self.values,),
                        lambda x, axis, q=q: np.quantile(x, q, axis=axis),
                        n_resamples=_RESAMPLES,
                        vectorized=True,
                        method="percentile",
                        rng=seed,
                    ).standard_error
                )
                for q in (outside, 1.0 - outside)
            ]
        return Band(float(ends[0]), float(ends[1]), errors[0], errors[1])

    @property
    def linear_share(self) -> float:
        """Share of the variance that a plane through the samples explains, R^2."""
        return float(1.0 - np.var(self._residual()) / np.var(self.values))

    def contributions(self) -> Floats:
        """(d,) squared standardised coefficients of that plane: shares of the variance, where it
        holds and inputs are independent (Saltelli et al. 2008, Global Sensitivity Analysis, 1.2.5).
        """
        return np.asarray((self._plane() * self.inputs.std(axis=0) / self.values.std()) ** 2)

    def _plane(self) -> Floats:
        centred = self.inputs - self.inputs.mean(axis=0)
        size = centred.std(axis=0)
        found = np.linalg.lstsq(centred / size, self.values - self.values.mean(), rcond=None)[0]
        return np.asarray(found / size)

    def _residual(self) -> Floats:
        centred = self.inputs - self.inputs.mean(axis=0)
        return np.asarray(self.values - self.values.mean() - centred @ self._plane())


@dataclass(frozen=True)
class Shares:
    """Sobol's shares of the variance of one quantity.

    Attributes
    ----------
    keys : tuple[str, ...]
        Keys of the d uncertain values.
    first, total : Floats
        (d,) what each value does alone, and with all in which it has a part.
    first_error, total_error : Floats
        (d,) standard errors from resampling.
    """

    keys: tuple[str, ...]
    first: Floats
    total: Floats
    first_error: Floats
    total_error: Floats

    __repr__ = short_repr


def nominal_value(scene: Drivetrain, key: str) -> float:
    """The number that a dotted key leads to; a bearing unit is addressed by its bearing's name.

    Raises
    ------
    InputError
        There is none, or it is no number.
    """
    return nominal_values(scene, [key])[0]


def with_values(
    scene: Stated, values: Mapping[str, Any], sizes: Sequence[float] = (1.0, *FINER)
) -> Stated:
    """The scene with other values by dotted key, materials that come with the program included.

    Where a thinner wall does not allow the scene's mesh sizes, a half or less of these.

    Parameters
    ----------
    scene : Drivetrain
        The scene, or a drivetrain without sections.
    values : mapping of str to Any
        Values by dotted key.
    sizes : sequence of float
        Factors on its mesh sizes, those first that are tried first.

    Raises
    ------
    InputError
        The values are not allowed, whatever the sizes.
    """
    if not isinstance(scene, Scene):
        return changed(scene, values, "drivetrain")
    whole = cast("Stated", with_materials(scene))
    for factor in sizes:
        scaled = whole.model_copy(update={"mesh": scene.mesh.scaled(factor)})
        with suppress(InputError):
            return changed(scaled, values, "scene")
    return changed(whole, values, "scene")  # for its words


def spreads_of(drivetrain: Drivetrain) -> Mapping[str, Spread]:
    """Uncertain values of a drivetrain, by key; empty where its file states none."""
    if isinstance(drivetrain, Scene | LumpedDrivetrain):
        return drivetrain.uncertainty
    return {}


def check_spreads(scene: Drivetrain) -> None:
    """Refuse a scene without uncertain values; those that it has were checked as it was read.

    Raises
    ------
    InputError
        Nothing is uncertain.
    """
    if not spreads_of(scene):
        key = "shaft.sections.0.outer_diameter" if isinstance(scene, Scene) else "rotor.inertia"
        raise InputError(
            f"scene {scene.title!r} has no uncertain values: add some under "
            f"'uncertainty', as in {key}: {{uniform: 0.01}}"
        )


def sensitivities(
    scene: Stated, evaluate: Evaluate[Stated], keys: Sequence[str], step: float = STEP
) -> dict[str, dict[str, float]]:
    """Relative change of each result for the relative change of each value: central differences.

    Parameters
    ----------
    scene, evaluate : Scene, Evaluate
        What is varied, and its results.
    keys : Sequence[str]
        Values other than zero.
    step : float
        Relative.

    Returns
    -------
    By result, and by key.

    Raises
    ------
    InputError
        A value, or a result, is zero: it has no relative change.
    """
    base = evaluate(scene)
    for name, result in base.items():
        if result == 0.0:
            raise InputError(f"{name} is zero, and has no relative change: ask for another")
    found: dict[str, dict[str, float]] = {name: {} for name in base}
    for key in keys:
        value = nominal_value(scene, key)
        if value == 0.0:
            raise InputError(f"{key} is zero and has no relative change: leave it out")
        low, high = (evaluate(with_values(scene, {key: value * (1 + s)})) for s in (-step, step))
        for name, result in base.items():
            found[name][key] = (high[name] - low[name]) / (2 * step * result)
    return found


def sample(
    scene: Stated,
    evaluate: Evaluate[Stated],
    count: int = 128,
    seed: int = 0,
    report: Callable[[str], object] = lambda step: None,
    content: Mapping[str, Any] | None = None,
    drawn: Mapping[str, int] = NOTHING,
) -> dict[str, Samples]:
    """Results over a Latin hypercube of the scene's uncertain values, by name.

    Parameters
    ----------
    scene, evaluate : Scene, Evaluate
        What is varied, and its results.
    count : int
        Samples.
    seed : int
        Seed of the hypercube.
    report : callable
        Called with what is being done.
    content : mapping or None
        All that `evaluate` depends on, as plain data: its results are kept as they come. None
        keeps nothing.
    drawn : mapping of str to int
        Keys that each sample gives a number from 0 to below so many, each as likely: which of
        several a part is, which is no value of `Samples.inputs`.

    Raises
    ------
    InputError
        Nothing is uncertain, or a sample is no scene.
    """
    keys, rows = latin_hypercube(scene, count, seed, drawn)
    values = evaluated_rows(
        rows,
        lambda row: _evaluated(scene, evaluate, keys, row, tuple(drawn)),
        content,
        lambda number: report(f"samples ({number} of {count})"),
    )
    return {
        name: Samples(keys, rows[:, : len(keys)], values[name], nominal)
        for name, nominal in evaluate(scene).items()
    }


def latin_hypercube(
    scene: Drivetrain, count: int, seed: int = 0, drawn: Mapping[str, int] = NOTHING
) -> tuple[tuple[str, ...], Floats]:
    """Keys of the d uncertain values of a scene, and (count, d + m) samples of them.

    Parameters
    ----------
    scene : Drivetrain
        What is varied.
    count, seed : int
        Number of samples, and seed of the hypercube.
    drawn : mapping of str to int
        Numbers of m further keys, as in `sample`: the last columns.

    Raises
    ------
    InputError
        Nothing is uncertain.
    """
    check_spreads(scene)
    keys = tuple(spreads_of(scene))
    from scipy.stats import qmc

    quantiles = qmc.LatinHypercube(d=len(keys) + len(drawn), rng=seed).random(count).T
    of_keys, of_drawn = quantiles[: len(keys)], quantiles[len(keys) :]
    inputs = [d.ppf(q) for d, q in zip(_spreads(scene), of_keys, strict=True)]
    numbers = [np.floor(n * q) for n, q in zip(drawn.values(), of_drawn, strict=True)]
    return keys, np.column_stack([*inputs, *numbers])


def sobol_shares(
    scene: Stated,
    evaluate: Evaluate[Stated],
    names: Sequence[str],
    count: int = 64,
    seed: int = 0,
    report: Callable[[str], object] = lambda step: None,
    content: Mapping[str, Any] | None = None,
) -> dict[str, Shares]:
    """First-order and total shares of the variance (Sobol 2001; Saltelli et al. 2010), by name.

    Parameters
    ----------
    scene, evaluate : Scene, Evaluate
        What is varied, and its results.
    names : Sequence[str]
        Names of results that vary.
    count : int
        Base samples, a power of two; (d + 2) times as many evaluations of d values.
    seed : int
        Seed of the samples.
    report : callable
        Called with what is being done.
    content : mapping or None
        Content of the key, see `sample`.
    """
    check_spreads(scene)
    keys = tuple(spreads_of(scene))
    total = count * (len(keys) + 2)
    done = 0

    def results(rows: Floats) -> Floats:
        """(s, n) of (n, d) values."""
        nonlocal done
        before = done
        values = evaluated_rows(
            rows,
            lambda row: _evaluated(scene, evaluate, keys, row),
            content,
            lambda number: report(f"samples of Sobol's shares ({before + number} of {total})"),
        )
        done += len(rows)
        return np.array([values[name] for name in names])

    found = variance_shares(results, dict(zip(keys, _spreads(scene), strict=True)), count, seed)
    return dict(zip(names, found, strict=True))


def variance_shares(
    results: Callable[[Floats], Floats],
    distributions: Mapping[str, Any],
    count: int = 64,
    seed: int = 0,
) -> list[Shares]:
    """First-order and total shares of the variance of any function of independent inputs.

    Parameters
    ----------
    results : callable
        The s results (s, n) of rows (n, d) of values. It is called with the base samples, twice
        `count` rows of independent inputs, and then with each input exchanged.
    distributions : mapping
        scipy's distribution of each of d values, by name.
    count : int
        Base samples, a power of two; (d + 2) times as many evaluations.
    seed : int
        Seed of the samples.

    Returns
    -------
    shares : list of Shares
        Shares of each of the s results (Sobol 2001; Saltelli et al. 2010).
    """
    keys = tuple(distributions)
    d = len(keys)
    from scipy import stats

    quantiles = stats.qmc.Sobol(d=2 * d, rng=seed).random(count)
    spreads = list(distributions.values())
    A, B = (
        np.column_stack([spread.ppf(q) for spread, q in zip(spreads, half.T, strict=True)])
        for half in (quantiles[:, :d], quantiles[:, d:])
    )
    f_A, f_B = results(A), results(B)
    f_AB = np.array([results(np.where(np.arange(d) == k, B, A)) for k in range(d)])

    def shares(chosen: Ints) -> Floats:
        """(2, s, d) first and total."""
        known = {"f_A": f_A[:, chosen], "f_B": f_B[:, chosen], "f_AB": f_AB[..., chosen]}
        found = stats.sobol_indices(func=known, n=count)
        return np.reshape([found.first_order, found.total_order], (2, len(f_A), d))

    draws = np.random.default_rng(seed).integers(count, size=(_RESAMPLES, count))
    errors = np.std([shares(draw) for draw in draws], axis=0, ddof=1)
    first, whole = shares(np.arange(count))
    return [Shares(keys, first[k], whole[k], errors[0, k], errors[1, k]) for k in range(len(f_A))]


def distribution(spread: Spread, nominal: float) -> Any:
    """scipy's distribution of a value."""
    from scipy import stats  # half a second, which what draws no samples need not wait for

    if spread.uniform is not None:
        half = spread.uniform * abs(nominal)
        return stats.uniform(nominal - half, 2 * half)
    if spread.normal is not None:
        return stats.norm(nominal, spread.normal * abs(nominal))
    # of the median: the mean of a positive value that may be wrong by a factor
    return stats.lognorm(np.sqrt(np.log1p(float(spread.lognormal or 0.0) ** 2)), scale=nominal)


def _spreads(scene: Drivetrain) -> list[Any]:
    spreads = spreads_of(scene)
    nominal = nominal_values(scene, list(spreads))
    return [distribution(s, v) for s, v in zip(spreads.values(), nominal, strict=True)]


def _evaluated(
    scene: Stated,
    evaluate: Evaluate[Stated],
    keys: Sequence[str],
    row: Floats,
    drawn: Sequence[str] = (),
) -> Mapping[str, float]:
    values: dict[str, Any] = dict(zip(keys, row[: len(keys)].tolist(), strict=True))
    values |= {key: int(n) for key, n in zip(drawn, row[len(keys) :], strict=True)}
    try:
        return evaluate(with_values(scene, values))
    except InputError as error:
        raise InputError(
            f"a value within its uncertainty gives no valid scene: {error} (or make the spread of "
            f"{', '.join(keys)} smaller)"
        ) from error
