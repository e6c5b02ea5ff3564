"""What uncertain values of a scene do to all that is reported, beside the error of the model."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.quantity_names import turning_names
from fe_drivetrain.drivetrain_file.reading import with_sections
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import chart
from fe_drivetrain.report.number_text import certain_value, formatted, value_text
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.quantity import named_load
from fe_drivetrain.shafts.uncertainty.input_study import (
    ModelError,
    Study,
    level_error,
    result_at,
    study,
)
from fe_drivetrain.shafts.uncertainty.numbers import figures
from fe_drivetrain.shafts.uncertainty.sampling import SHARE, Band, Shares
from fe_drivetrain.studies.input_effects import InputEffects, QuantityEffects, input_effects
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.shown_units import in_large_unit, quantity_in_words
from fe_drivetrain.studies.turning_uncertainty import TurningSamples, turning_study

ROUND_OFF = 1e-11
"""Share of a value below which what inputs or the model change is none: round-off of statics."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class UncertaintyResult(Result):
    """Bands of all quantities of a scene whose values are uncertain.

    Attributes
    ----------
    effects : InputEffects
        What the uncertain values do to each quantity: statistics of the samples, no samples.
    """

    STUDY: ClassVar[str] = "uncertainty"
    SCHEMA_VERSION: ClassVar[int] = 3

    effects: InputEffects = field(repr=False)

    @property
    def level(self) -> int | str:
        """Level that was sampled: 1 beam, 2 meridian, 4 solids; of all that turns its name."""
        return self.effects.level

    @property
    def units(self) -> dict[str, str]:
        """Unit of each quantity; the mappings below have the same keys, those asked for first."""
        return {one.name: one.unit for one in self.effects.quantities}

    @property
    def nominal(self) -> dict[str, float]:
        """Value of each quantity without uncertainty."""
        return {one.name: one.nominal for one in self.effects.quantities}

    @property
    def bands(self) -> dict[str, Band]:
        """Between which values 95 % of the samples of each quantity are, with standard errors."""
        return {one.name: one.band for one in self.effects.quantities}

    @property
    def errors(self) -> dict[str, ModelError]:
        """Error of the level itself in each quantity, relative."""
        return {one.name: one.error for one in self.effects.quantities}

    @property
    def sensitivities(self) -> dict[str, Mapping[str, float]]:
        """Relative change of each quantity for the relative change of each uncertain value."""
        return {one.name: one.sensitivities for one in self.effects.quantities}

    @property
    def shares(self) -> dict[str, Shares]:
        """Sobol indices of the quantities that vary; empty where they were not asked for."""
        every = self.effects.quantities
        return {one.name: one.shares for one in every if one.shares is not None}

    def rows(self) -> list[Record]:
        """Nominal value, band and errors of each quantity, with units in the keys."""
        return [
            {
                "quantity": one.name,
                "unit": one.unit,
                "nominal": one.nominal,
                "2.5 %": one.band.low,
                "97.5 %": one.band.high,
                "inputs: half the band [%]": 100 * one.half,
                "model: error [%]": 100 * one.error.share,
            }
            for one in self.effects.quantities
        ]

    def all_tables(self) -> Mapping[str, Any]:
        """Tables by name: those of the page, and `rows` as "bands"."""
        return {**self.tables, "bands": self.rows()}

    def chart(self) -> Chart:
        """Half of each band beside the error of the level."""
        return half_bands(self.effects)


MIN_SAMPLES = 40
"""Least number of samples: one of them lies beyond a band of 95 %, on either side."""


def uncertainty(
    scene: Drivetrain,
    quantities: Sequence[str] = (),
    load: Mapping[str, float] | None = None,
    tolerance: float = 0.05,
    level: int | str | None = None,
    samples: int = 128,
    seed: int = 0,
    sobol: bool = False,
    *,
    report: Progress = silent,
) -> UncertaintyResult:
    """Propagate the uncertain values of a drivetrain to its results.

    Parameters
    ----------
    scene : Drivetrain
        Its `uncertainty` states how each uncertain value is distributed.
    quantities : sequence of str
        Quantities for which the level must be accurate, as in "main_bearing.My", reported beside
        every stiffness; or of all that turns alone, as in "modes.torsional.1" or
        "gears.stage 3 mesh.K_Hbeta". Without any, every stiffness; of a main shaft without
        sections "modes.torsional.1".
    load : mapping of str to float or None
        Load that causes the reactions, by component [N, N m, m/s^2]; None for each hub load by
        itself.
    tolerance : float
        Allowed error of the level, relative.
    level : int, str or None
        Level to sample, 1, 2 or 4, for what turns "torsional", "rigid" or "flexible"; None: the
        cheapest that the adviser finds accurate enough, 4 not being one.
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
        See `fe_drivetrain.shafts.uncertainty.input_study.study`; the load has an unknown name,
        there are too few samples for a band, or quantities of reactions and of what turns are asked
        for together.
    """
    _require_samples(samples)
    found, steps = Findings(), Steps(report)
    found.about(scene)
    found.seed = seed
    base = 2 ** (samples.bit_length() - 1) if sobol else 0
    turning = turning_names(scene, quantities, load)
    with steps.step("uncertainty"):
        if turning:
            asked = TurningSamples(turning, tolerance, level, samples, seed, base)
            known = turning_study(scene, asked, found, steps.report)
        else:
            whole = with_sections(scene, scene.title)
            factors = None if load is None else named_load(whole, load)
            known = study(
                whole,
                quantities,
                factors,
                tolerance,
                _shaft_level(level),
                samples,
                seed,
                base,
                steps.report,
            )
    effects = _digested(found, known, tolerance)
    options = {"quantities": quantities, "load": load, "tolerance": tolerance, "level": level}
    options |= {"samples": samples, "sobol": sobol}
    return UncertaintyResult(effects=effects, **found.frozen(steps.times, **options))


def _shaft_level(level: int | str | None) -> int | None:
    """Level of the main shaft; that of what turns is refused."""
    if isinstance(level, str):
        raise InputError(
            f"{argument('level', level)} is one of all that turns: use 1 (beam), 2 (meridian) or 4 "
            "(assembly of solids) for reactions and stiffnesses"
        )
    return level


def _digested(found: Findings, known: Study, tolerance: float) -> InputEffects:
    """State answer, checks and numbers of the samples; what is kept of them."""
    effects = input_effects(known)
    found.say(*_sentences(effects))
    _judge(found, known, tolerance)
    for name, value in figures(known).items():
        found.data(name, value)
    _answer(found, effects, tolerance)
    return effects


def _answer(found: Findings, effects: InputEffects, tolerance: float) -> None:
    """State by how much a quantity may be off, by its inputs and by the model."""
    by_load = [one for one in effects.charted if " of hub." in one.name]
    # of a reaction to each hub load by itself the largest
    first = max(by_load or effects.charted[:1], key=lambda one: abs(one.nominal))
    others = [one for one in effects.charted if one is not first]
    name = quantity_in_words(first.name)
    error = 200.0 * first.half_error
    low, high = (value_text(end, "%", error, False) for end in _ends(first))
    value = found.value(*_nominal(first))
    model = f"{formatted(_percent(first.error.share), 2)}\u00a0%"
    figures = [value, *_uncertainties(found, first, effects, tolerance)]
    if first.changes:
        key = list(first.changes)[-1]
        figures.append(
            found.value(f"change by a deviation of {key} [%]", 100.0 * first.changes[key])
        )
    for other in others[:1]:
        figures += _uncertainties(found, other, effects, tolerance)
    found.answer(
        f"How uncertain is {name}, by its inputs and by the model?",
        f"{name[:1].upper()}{name[1:]} is {certain_value(value)}, {low} to {high} by its inputs "
        f"and ±\u00a0{model} by the model.",
        figures,
    )


def _ends(one: QuantityEffects) -> tuple[float, float]:
    """Ends of a band over the nominal value, less 1 [%]."""
    ends = [_percent(end / one.nominal - 1.0) for end in (one.band.low, one.band.high)]
    return min(ends), max(ends)


def _percent(share: float) -> float:
    """A share in percent; none where it is round-off, as of what statics alone decide."""
    return 100.0 * share if abs(share) > ROUND_OFF else 0.0


def _nominal(one: QuantityEffects) -> tuple[str, float, float]:
    """A quantity with its unit, its nominal value, and the error of the model in it."""
    value, unit = in_large_unit(one.nominal, one.unit)
    return f"{quantity_in_words(one.name)} [{unit}]", value, abs(value) * one.error.share


def _uncertainties(
    found: Findings, one: QuantityEffects, effects: InputEffects, tolerance: float
) -> list[KeyFigure]:
    """What inputs and model leave open of a quantity."""
    name, error = quantity_in_words(one.name), 100.0 * one.error.share
    inputs = found.value(
        f"half the {100 * SHARE:g}\u00a0% range of {name} by the inputs [%]",
        100.0 * one.half,
        200.0 * one.half_error,
    )
    what = f"error of level {effects.level} in {name} [%]"
    if not effects.advices:  # the level was given: nothing was asked of it
        return [inputs, found.value(what, error)]
    return [inputs, found.value(what, error, at_most=100.0 * tolerance)]


def _require_samples(samples: int) -> None:
    """Refuse fewer samples than a band needs."""
    if samples < MIN_SAMPLES:
        raise InputError(
            f"uncertainty: {samples} samples show no band of 95 %: take {MIN_SAMPLES} or more"
        )


def half_bands(found: InputEffects) -> Chart:
    """Half bands and model errors, a pair of bars for each quantity."""
    shown = list(reversed(found.quantities))
    return horizontal_bars(
        "Uncertainty from the inputs, and error of the model",
        {
            "model: error of the level": [100 * one.error.share for one in shown],
            "inputs: half the band": [100 * one.half for one in shown],
        },
        [one.name for one in shown],
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


def _sentences(found: InputEffects) -> list[str]:
    """The answer: the band of each quantity that was asked for, and the error of the model."""
    sentences = []
    for one in found.charted:
        low, high = _ends(one)
        sentences.append(
            f"{one.name}: {one.nominal:.4g} {one.unit}, {low:+.2g} to {high:+.2g} % from the "
            f"inputs ({100 * SHARE:g} % of {found.samples} samples), "
            f"± {_percent(one.error.share):.2g} % from the model at level {found.level}."
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
