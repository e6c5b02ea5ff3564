"""What a study of uncertain values says of each value and each quantity, without the samples."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.drivetrain_file.scene import Spread
from fe_drivetrain.shafts.fidelity.advice import Advice
from fe_drivetrain.shafts.fidelity.quantity import Reported
from fe_drivetrain.shafts.uncertainty.input_study import ModelError, Study
from fe_drivetrain.shafts.uncertainty.numbers import (
    changes_by_spread,
    first_order,
    half_band,
    relative_spread,
)
from fe_drivetrain.shafts.uncertainty.response_surface import UnitSurface
from fe_drivetrain.shafts.uncertainty.sampling import (
    SHARE,
    Band,
    Samples,
    Shares,
    distribution,
    nominal_value,
    spreads_of,
)

_CHARTED = 6  # quantities with their own charts; the tables have all of them
_BINS = 16


@dataclass(frozen=True)
class ValueSpread:
    """An uncertain value of a scene.

    Attributes
    ----------
    key : str
        Dotted key of the scene.
    nominal, low, high : float
        Value without uncertainty, and between which two 95 % of it are [SI].
    spread : Spread
        Its distribution.
    deviation : float
        Standard deviation, relative to the nominal value.
    """

    key: str
    nominal: float
    low: float
    high: float
    spread: Spread
    deviation: float


@dataclass(frozen=True, eq=False)
class Scatter:
    """How the samples of a quantity scatter, and what that comes from.

    Attributes
    ----------
    deviation, first_order : float
        Standard deviation of the samples, and that of the sensitivities, relative.
    linear_share : float
        Share of the variance that a linear fit to the samples explains.
    contributions : ndarray, (d,)
        Share of each value in the variance by that fit.
    counts, edges : ndarray, (b,), (b + 1,)
        Histogram of the samples.
    """

    deviation: float
    first_order: float
    linear_share: float
    contributions: Floats
    counts: Ints
    edges: Floats


@dataclass(frozen=True, eq=False)
class QuantityEffects:
    """What the uncertain values do to a quantity.

    Attributes
    ----------
    name, unit : str
        Name and unit of the quantity.
    nominal : float
        Value without uncertainty.
    band : Band
        Between which values 95 % of the samples are.
    half, half_error : float
        Half the width of the band and its standard error, relative to the nominal value.
    soft_half : float or None
        The same half with housings whose faces move on average, where that matters.
    error : ModelError
        Error of the model level.
    sensitivities, changes : mapping of str to float
        Relative change for the relative change of each value; and for one standard deviation of
        it, the smallest first.
    scatter : Scatter or None
        Scatter of the samples; None where no value matters to the quantity.
    shares : Shares or None
        Sobol indices, where they were asked for.
    """

    name: str
    unit: str
    nominal: float
    band: Band
    half: float
    half_error: float
    soft_half: float | None
    error: ModelError
    sensitivities: Mapping[str, float]
    changes: Mapping[str, float]
    scatter: Scatter | None
    shares: Shares | None


@dataclass(frozen=True, eq=False)
class InputEffects:
    """Effects of all uncertain values of a scene on all quantities.

    Attributes
    ----------
    level : int or str
        Model level that was sampled; one of all that turns has a name.
    samples : int
        How often.
    values : tuple of ValueSpread
        The uncertain values.
    quantities : tuple of QuantityEffects
        All quantities, those that were asked for first.
    charted : tuple of QuantityEffects
        Quantities that have charts of their own: those asked for, else stiffnesses at the hub.
    surfaces : sequence of UnitSurface
        Response surfaces of bearing units that depend on uncertain values.
    advices : sequence of Advice
        Errors of the model levels; none where the level was given.
    """

    level: int | str
    samples: int
    values: tuple[ValueSpread, ...]
    quantities: tuple[QuantityEffects, ...]
    charted: tuple[QuantityEffects, ...]
    surfaces: Sequence[UnitSurface]
    advices: Sequence[Advice]

    @property
    def keys(self) -> list[str]:
        """Keys of the uncertain values."""
        return [value.key for value in self.values]


def input_effects(study: Study) -> InputEffects:
    """Digest a study of uncertain values.

    Parameters
    ----------
    study : Study
        Samples, sensitivities and errors of the level.
    """
    quantities = {number.name: _effects(study, number) for number in study.numbers}
    asked = [number.name for number in study.numbers if study.is_asked(number)]
    charted = asked or [name for name in quantities if name.startswith("hub.stiffness.")]
    return InputEffects(
        study.level,
        len(next(iter(study.samples.values())).values),
        tuple(
            _value(key, nominal_value(study.scene, key), spread)
            for key, spread in spreads_of(study.scene).items()
        ),
        tuple(quantities.values()),
        tuple(quantities[name] for name in charted[:_CHARTED]),
        study.surfaces,
        study.advices,
    )


def _value(key: str, nominal: float, spread: Spread) -> ValueSpread:
    known = distribution(spread, nominal)
    low, high = (float(known.ppf(q)) for q in ((1 - SHARE) / 2, (1 + SHARE) / 2))
    return ValueSpread(key, nominal, low, high, spread, relative_spread(spread))


def _effects(study: Study, number: Reported) -> QuantityEffects:
    name, samples = number.name, study.samples[number.name]
    band, soft = samples.band(), study.soft_samples.get(name)
    changes = changes_by_spread(study, number)
    return QuantityEffects(
        name=name,
        unit=number.unit,
        nominal=samples.nominal,
        band=band,
        half=half_band(samples),
        half_error=math.hypot(band.low_error, band.high_error) / 2 / abs(samples.nominal),
        soft_half=None if soft is None else half_band(soft),
        error=study.errors[name],
        sensitivities=study.slopes[name],
        changes=dict(sorted(changes.items(), key=lambda item: abs(item[1]))),
        scatter=_scatter(samples, first_order(study, number)) if samples.varies else None,
        shares=study.shares.get(name),
    )


def _scatter(samples: Samples, of_slopes: float) -> Scatter:
    counts, edges = np.histogram(samples.values, bins=_BINS)
    return Scatter(
        samples.deviation / abs(samples.nominal),
        of_slopes,
        samples.linear_share,
        samples.contributions(),
        counts,
        edges,
    )
