"""How certain a result is when the inputs are not: sensitivities, samples, shares of variance.

PROTEST's step 4: which inputs are how certain, and what that does to what is reported. Sampling is
over a cheap level of the ladder; which one is the adviser's to say.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import stats
from scipy.stats import qmc

from fe_drivetrain.elasticity import Floats
from fe_drivetrain.errors import InputError
from fe_drivetrain.materials import MATERIALS
from fe_drivetrain.scene import Scene, Spread, change_scene

Evaluate = Callable[[Scene], float]
"""One number of a scene."""

#: Relative step of a central difference: its error is some 1e-6 of a smooth function's.
STEP = 1e-3


@dataclass(frozen=True)
class Samples:
    """A Latin hypercube study.

    Attributes
    ----------
    keys
        Of the d uncertain values.
    inputs, values
        (n, d), and (n,) the result of each sample.
    nominal
        The result without uncertainty.
    """

    keys: tuple[str, ...]
    inputs: Floats
    values: Floats
    nominal: float

    def band(self, share: float = 0.95) -> tuple[float, float]:
        """Between which two values that share of the results lies, as much below as above."""
        outside = (1.0 - share) / 2
        low, high = np.quantile(self.values, [outside, 1.0 - outside])
        return float(low), float(high)

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


def nominal_value(scene: Scene, key: str) -> float:
    """The number that a dotted key leads to; a bearing unit goes by its bearing's name.

    Raises
    ------
    InputError
        There is none, or it is no number.
    """
    data: Any = _with_materials(scene).model_dump(mode="json")
    for part in key.split("."):
        if isinstance(data, list):
            named = {
                u["bearing"]["name"]: u for u in data if isinstance(u, dict) and "bearing" in u
            }
            data = named.get(part) or (
                data[int(part)] if part.isdecimal() and int(part) < len(data) else None
            )
        else:
            data = data.get(part) if isinstance(data, dict) else None
    if isinstance(data, bool) or not isinstance(data, int | float):
        raise InputError(
            f"uncertainty of {key!r}: the scene has no number there: name a value that it gives"
        )
    return float(data)


def with_values(scene: Scene, values: Mapping[str, float]) -> Scene:
    """The scene with other values by dotted key, materials that come with the program included."""
    return change_scene(_with_materials(scene), values)


def sensitivities(
    scene: Scene, evaluate: Evaluate, keys: Sequence[str], step: float = STEP
) -> dict[str, float]:
    """Relative change of the result for the relative change of each value, by central differences.

    Parameters
    ----------
    scene, evaluate
        What is varied, and its result.
    keys
        Values other than zero.
    step
        Relative.

    Raises
    ------
    InputError
        A value, or the result, is zero: it has no relative change.
    """
    base = evaluate(scene)
    if base == 0.0:
        raise InputError("the result is zero, and has no relative change: ask for another")
    found = {}
    for key in keys:
        value = nominal_value(scene, key)
        if value == 0.0:
            raise InputError(f"{key} is zero and has no relative change: leave it out")
        ends = [evaluate(with_values(scene, {key: value * (1 + s)})) for s in (-step, step)]
        found[key] = (ends[1] - ends[0]) / (2 * step * base)
    return found


def sample(
    scene: Scene,
    evaluate: Evaluate,
    spreads: Mapping[str, Spread] | None = None,
    count: int = 128,
    seed: int = 0,
    report: Callable[[str], object] = lambda step: None,
) -> Samples:
    """Results over a Latin hypercube of the uncertain values.

    Parameters
    ----------
    scene, evaluate
        What is varied, and its result.
    spreads
        By dotted key; the scene's own where not given.
    count
        Samples.
    seed
        Of the hypercube.
    report
        Called with what is being done.

    Raises
    ------
    InputError
        Nothing is uncertain, or a sample is no scene.
    """
    known = scene.uncertainty if spreads is None else spreads
    if not known:
        raise InputError(
            f"scene {scene.title!r} says of no value how certain it is: add some under "
            "'uncertainty', as in shaft.sections.0.outer_diameter: {uniform: 0.01}"
        )
    keys = tuple(known)
    quantiles = qmc.LatinHypercube(d=len(keys), seed=seed).random(count)
    inputs = np.column_stack(
        [
            distribution(spread, nominal_value(scene, key)).ppf(quantiles[:, k])
            for k, (key, spread) in enumerate(known.items())
        ]
    )
    values = np.empty(count)
    for number, row in enumerate(inputs):
        report(f"sample {number + 1} of {count}")
        values[number] = evaluate(with_values(scene, dict(zip(keys, row.tolist(), strict=True))))
    return Samples(keys, inputs, values, evaluate(scene))


def sobol_shares(
    scene: Scene,
    evaluate: Evaluate,
    spreads: Mapping[str, Spread] | None = None,
    count: int = 64,
    seed: int = 0,
) -> tuple[Floats, Floats]:
    """First-order and total shares of the variance, (d,) each (Sobol 2001; Saltelli et al. 2010).

    Takes (d + 2) times ``count`` results; ``count`` is a power of two. Of the estimators of
    `scipy.stats.sobol_indices`, whose error falls with the root of the count or faster.
    """
    known = scene.uncertainty if spreads is None else spreads
    keys = tuple(known)
    distributions = [distribution(s, nominal_value(scene, key)) for key, s in known.items()]

    def results(x: Floats) -> Floats:
        rows = np.reshape(x, (len(keys), -1)).T
        found = [
            evaluate(with_values(scene, dict(zip(keys, row.tolist(), strict=True)))) for row in rows
        ]
        return np.reshape(found, x.shape[1:])

    found = stats.sobol_indices(func=results, n=count, dists=distributions, rng=seed)
    return np.asarray(found.first_order).ravel(), np.asarray(found.total_order).ravel()


def distribution(spread: Spread, nominal: float) -> Any:
    """scipy's distribution of a value."""
    if spread.uniform is not None:
        half = spread.uniform * abs(nominal)
        return stats.uniform(nominal - half, 2 * half)
    if spread.normal is not None:
        return stats.norm(nominal, spread.normal * abs(nominal))
    # of the median: the mean of what is positive and may be off by a factor
    return stats.lognorm(np.sqrt(np.log1p(float(spread.lognormal or 0.0) ** 2)), scale=nominal)


def _with_materials(scene: Scene) -> Scene:
    used = {scene.shaft.material}
    for unit in scene.bearing_units:
        used |= {unit.bearing.material, unit.housing.material}
    own = {name: MATERIALS[name] for name in used if name in MATERIALS}
    return scene.model_copy(update={"materials": own | dict(scene.materials)})
