"""What uncertain values of a scene do to all that is reported, beside the error of the model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.charts import chart
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.quantities import Number
from fe_drivetrain.shafts.fidelity.quantity import named_load
from fe_drivetrain.shafts.uncertainty.input_study import (
    ModelError,
    Study,
    level_error,
    result_at,
    study,
)
from fe_drivetrain.shafts.uncertainty.numbers import figures, half_band
from fe_drivetrain.shafts.uncertainty.sampling import SHARE, Band, Shares
from fe_drivetrain.studies.result import Result

_CHARTED = 6  # quantities with their own charts; the tables have all of them


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class UncertaintyResult(Result):
    """Bands of all quantities of a scene whose values are uncertain.

    Attributes
    ----------
    level : int
        Model level that was sampled: 1 beam, 2 meridian.
    units : Mapping[str, str]
        Unit of each quantity; the mappings below have the same keys, those asked for first.
    nominal : Mapping[str, float]
        Value of each quantity without uncertainty.
    bands : Mapping[str, Band]
        Between which values 95 % of the samples of each quantity are, with standard errors.
    errors : Mapping[str, ModelError]
        Error of the level itself in each quantity, relative.
    sensitivities : Mapping[str, Mapping[str, float]]
        Relative change of each quantity for the relative change of each uncertain value, by key.
    shares : Mapping[str, Shares]
        Sobol indices of the quantities that vary; empty where they were not asked for.
    study : Study
        Samples and surfaces that all this comes from, of which pages draw histograms; not part of
        the JSON but for the samples.
    """

    STUDY: ClassVar[str] = "uncertainty"

    level: int
    units: Mapping[str, str]
    nominal: Mapping[str, float]
    bands: Mapping[str, Band]
    errors: Mapping[str, ModelError]
    sensitivities: Mapping[str, Mapping[str, float]]
    shares: Mapping[str, Shares]
    study: Study = field(repr=False)

    def rows(self) -> list[Record]:
        """Nominal value, band and errors of each quantity, with units in the keys."""
        return [
            {
                "quantity": name,
                "unit": self.units[name],
                "nominal": self.nominal[name],
                "2.5 %": band.low,
                "97.5 %": band.high,
                "inputs: half the band [%]": 100 * half_band(self.study.samples[name]),
                "model: error [%]": 100 * self.errors[name].share,
            }
            for name, band in self.bands.items()
        ]

    def all_tables(self) -> Mapping[str, Any]:
        """Tables by name: those of the page, and `rows` as "bands"."""
        return {**self.tables, "bands": self.rows()}

    def chart(self) -> Chart:
        """Half of each band beside the error of the level."""
        return half_bands(self.study)


MIN_SAMPLES = 40
"""Least number of samples: one of them lies beyond a band of 95 %, on either side."""


def uncertainty(
    scene: Scene,
    quantities: Sequence[str] = (),
    load: Mapping[str, float] | None = None,
    tolerance: float = 0.05,
    level: int | None = None,
    samples: int = 128,
    seed: int = 0,
    sobol: bool = False,
    *,
    report: Progress = silent,
) -> UncertaintyResult:
    """Propagate the uncertain values of a scene to its reactions and stiffnesses.

    Parameters
    ----------
    scene : Scene
        Its `uncertainty` states how each uncertain value is distributed.
    quantities : sequence of str
        Quantities for which the level must be accurate, as in "main_bearing.My"; they are reported
        beside every stiffness.
    load : mapping of str to float or None
        Load that causes the reactions, by component [N, N m, m/s^2]; None for each hub load by
        itself.
    tolerance : float
        Allowed error of the level, relative.
    level : int or None
        Level to sample, 1 or 2; None: the cheapest that the adviser finds accurate enough.
    samples : int
        Samples of the Latin hypercube.
    seed : int
        Seed of all random samples.
    sobol : bool
        Whether to estimate Sobol indices, too, from N (k + 2) evaluations, N the largest power of
        two up to `samples`, k the number of uncertain values.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        See `fe_drivetrain.shafts.uncertainty.input_study.study`; the load has an unknown name, or
        there are too few samples for a band.
    """
    if samples < MIN_SAMPLES:
        raise InputError(
            f"uncertainty: {samples} samples show no band of 95 %: take {MIN_SAMPLES} or more"
        )
    found, steps = Findings(), Steps(report)
    found.about(scene)
    found.seed = seed
    factors = None if load is None else named_load(scene, load)
    base = 2 ** (samples.bit_length() - 1) if sobol else 0
    with steps.step("uncertainty"):
        known = study(
            scene, quantities, factors, tolerance, level, samples, seed, base, steps.report
        )
    found.answer(*_sentences(known))
    _judge(found, known, tolerance)
    for name, value in figures(known).items():
        found.data(name, value)
    options = {
        "quantities": quantities,
        "load": load,
        "tolerance": tolerance,
        "level": level,
        "samples": samples,
        "sobol": sobol,
    }
    return UncertaintyResult(
        level=known.level,
        units={number.name: number.unit for number in known.numbers},
        nominal={number.name: known.samples[number.name].nominal for number in known.numbers},
        bands={number.name: known.samples[number.name].band() for number in known.numbers},
        errors=known.errors,
        sensitivities=known.slopes,
        shares=known.shares,
        study=known,
        **found.frozen(steps.times, **options),
    )


def charted(found: Study) -> list[Number]:
    """Quantities that have charts of their own: those requested, else stiffnesses at the hub."""
    asked = [number for number in found.numbers if found.is_asked(number)]
    return (asked or [n for n in found.numbers if n.name.startswith("hub.stiffness.")])[:_CHARTED]


def sample_count(found: Study) -> int:
    """Samples of the hypercube."""
    return len(next(iter(found.samples.values())).values)


def half_bands(found: Study) -> Chart:
    """Half bands and model errors, a pair of bars for each quantity."""
    shown = [number.name for number in reversed(found.numbers)]
    halves = [100 * half_band(found.samples[name]) for name in shown]
    errors = [100 * found.errors[name].share for name in shown]
    return horizontal_bars(
        "Uncertainty from the inputs, and error of the model",
        {"model: error of the level": errors, "inputs: half the band": halves},
        shown,
        "± [%]",
    )


def horizontal_bars(
    caption: str, groups: Mapping[str, Sequence[float]], labels: Sequence[str], x: str
) -> Chart:
    """Bars to the right, with room for each and its label; a group without a name has no legend."""
    bars: list[dict[str, Any]] = [
        {"type": "bar", "orientation": "h", "x": rounded(values), "y": list(labels)}
        | ({"name": name} if name else {})
        for name, values in groups.items()
    ]
    figure = chart(caption, bars, x=x, y="")
    layout = figure.figure["layout"]
    layout["yaxis"] |= {"automargin": True, "dtick": 1}
    layout["height"] = 140 + 22 * len(groups) * len(labels)
    return figure


def _sentences(found: Study) -> list[str]:
    """The answer: the band of each quantity that was asked for, and the error of the model."""
    sentences = []
    for number in charted(found):
        samples, error = found.samples[number.name], found.errors[number.name]
        band = samples.band()
        low, high = (100 * (end / samples.nominal - 1.0) for end in (band.low, band.high))
        sentences.append(
            f"{number.name}: {samples.nominal:.4g} {number.unit}, {min(low, high):+.2g} to "
            f"{max(low, high):+.2g} % from the inputs ({100 * SHARE:g} % of {sample_count(found)} "
            f"samples), ± {100 * error.share:.2g} % from the model at level {found.level}."
        )
    return sentences


def _judge(found: Findings, known: Study, tolerance: float) -> None:
    """Check the error of the level that was sampled, of each quantity that has a ladder."""
    for advice in known.advices:
        found.at_most(
            f"{advice.quantity.name}: error of level {known.level}, "
            f"{result_at(advice, known.level).model.title}",
            level_error(advice, known.level),
            tolerance,
            why="the tolerance that was requested",
            source=f"level {advice.top.model.level}, {advice.top.model.title}, and its own error "
            "band",
        )
