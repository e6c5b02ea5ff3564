"""Errors of a model over histories in the measures that parts are designed by.

An error of half a percent in the mean may be several percent in damage: a damage-equivalent load
counts ranges, and damage is its m-th power.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.turbine_loads.histories.cycles import rainflow_cycles
from fe_drivetrain.turbine_loads.histories.damage import SLOPES, damage_equivalent_load

MEAN, EXTREME, DURATION = "mean", "extreme", "load duration"


@dataclass(frozen=True, eq=False)
class Measured:
    """A load over one history or more.

    Attributes
    ----------
    values, weights : ndarray, (n,)
        All samples, and the time of each as a share.
    equivalent : Mapping[float, float]
        Damage-equivalent loads at 1 Hz by slope.
    """

    values: Floats
    weights: Floats
    equivalent: Mapping[float, float]

    __repr__ = short_repr

    @property
    def mean(self) -> float:
        """Over time."""
        return float(self.weights @ self.values)

    @property
    def extreme(self) -> float:
        """Largest size."""
        return float(np.abs(self.values).max())

    @cached_property
    def ordered(self) -> Floats:
        """Its samples from the least to the largest."""
        return np.sort(self.values)


def measured(
    histories: Sequence[Floats], steps: Sequence[float], slopes: Sequence[float] = SLOPES
) -> Measured:
    """Measure a load.

    Parameters
    ----------
    histories : sequence of ndarray, (n,)
        The load in each.
    steps : sequence of float
        Between two samples of each [s].
    slopes : sequence of float
        Slopes of S-N curves.
    """
    seconds = np.repeat(np.asarray(steps, dtype=float), [len(h) for h in histories])
    total = float(seconds.sum())
    cycles = [rainflow_cycles(history) for history in histories]
    equivalent = {m: damage_equivalent_load(cycles, total, m) for m in slopes}
    return Measured(np.concatenate(histories), seconds / total, equivalent)


def model_errors(model: Measured, reference: Measured) -> dict[str, float]:
    """Errors of a model by measure, as shares.

    Parameters
    ----------
    model, reference : Measured
        Measures of one load over the same histories.

    Returns
    -------
    dict
        "mean": difference of the means over the mean size of the reference; "extreme" and "DEL,
        m = ...": the model's over the reference's, less one (NaN where the reference has none);
        "load duration": area between the two distributions over levels (the distance of Wasserstein
        1969), over the mean size of the reference.
    """
    size = float(reference.weights @ np.abs(reference.values))
    if size == 0.0:
        size = float("nan")
    errors = {
        MEAN: (model.mean - reference.mean) / size,
        EXTREME: _ratio(model.extreme, reference.extreme),
        DURATION: _between(model, reference) / size,
    }
    for slope, load in reference.equivalent.items():
        errors[f"DEL, m = {slope:g}"] = _ratio(model.equivalent[slope], load)
    return errors


def damage_ratio(error: float, slope: float) -> float:
    """Damage over the true one, of a damage-equivalent load with an error: ``(1 + e)^m``.

    Parameters
    ----------
    error : float
        Error of the load, as a share.
    slope : float
        Slope of the S-N curve.
    """
    return float((1.0 + error) ** slope)


USES: Mapping[str, str] = {
    "means": MEAN,
    "load durations": DURATION,
    "extremes": EXTREME,
    "fatigue": "DEL",
}
"""What a level may be good enough for, with the beginning of the measures that it asks for."""


def good_enough_for(
    errors: Mapping[str, Mapping[str, float]], within: float
) -> dict[str, str | None]:
    """The first model that is within a tolerance, by use.

    Parameters
    ----------
    errors : mapping
        By model, from cheap to expensive: errors by measure, the worst of all loads.
    within : float
        As a share, of loads: of ranges for fatigue. A NaN asks nothing: there is no such load.

    Returns
    -------
    dict
        "means", "load durations" (of bearings and gears), "extremes", "fatigue": the model, None
        where none is.
    """
    return {
        use: next(
            (
                model
                for model, own in errors.items()
                if not any(abs(e) > within for name, e in own.items() if name.startswith(measures))
            ),
            None,
        )
        for use, measures in USES.items()
    }


def _ratio(one: float, other: float) -> float:
    return one / other - 1.0 if other else float("nan")


def _between(one: Measured, other: Measured) -> float:
    weights = np.concatenate([one.weights, other.weights])
    equal = len(one.values) == len(other.values) and np.ptp(weights) == 0.0
    if equal:  # the distance is that of the sorted samples
        return float(np.abs(one.ordered - other.ordered).mean())
    from scipy.stats import wasserstein_distance

    return float(wasserstein_distance(one.values, other.values, one.weights, other.weights))
