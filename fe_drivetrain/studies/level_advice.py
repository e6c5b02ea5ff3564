"""The cheapest model level that is accurate enough for a quantity, and which details matter."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from fe_drivetrain.common.arrays import rounded
from fe_drivetrain.common.cache import user_cache
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.reading import with_sections
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.plots import figures
from fe_drivetrain.plots.figures import MINIMUM, error_traces
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import chart
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.fidelity.ablation import Effect, effects
from fe_drivetrain.shafts.fidelity.advice import Advice, LevelResult
from fe_drivetrain.shafts.fidelity.adviser import UNCACHED
from fe_drivetrain.shafts.fidelity.adviser import advise as run_levels
from fe_drivetrain.shafts.fidelity.quantity import (
    ERROR_AGAINST_LAST,
    OWN_ERROR,
    Quantity,
    named_load,
)
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.shown_units import in_large_unit, quantity_in_words


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class AdviseResult(Result):
    """The model levels of a scene, from cheap to expensive, as far as they were run.

    Attributes
    ----------
    drivetrain : Scene
        The scene.
    advice : Advice
        The quantity, its tolerance, and every level that was run; not part of the JSON.
    effects : tuple[Effect, ...]
        Change of the quantity for each detail that is left out, the largest first; empty where
        statics decides or no bearing has a housing.
    effects_level : int
        Level of the shaft at which the details were left out, 1 or 2.
    """

    STUDY: ClassVar[str] = "advise"
    SCHEMA_VERSION: ClassVar[int] = 3

    drivetrain: Scene
    advice: Advice = field(repr=False)
    effects: tuple[Effect, ...]
    effects_level: int

    @property
    def level(self) -> int | None:
        """Cheapest level that is known to be within the tolerance; None where none is."""
        chosen = self.chosen
        return None if chosen is None else chosen.model.level

    @property
    def chosen(self) -> LevelResult | None:
        """Result of that level."""
        advice = self.advice
        return None if advice.chosen is None else advice.results[advice.chosen]

    def all_tables(self) -> Mapping[str, Any]:
        """Tables by name: those of the page, and the change for each detail that is left out."""
        details = [
            {"detail left out": one.detail, "change [%]": 100 * one.change} for one in self.effects
        ]
        return {**self.tables, "details": details}

    def chart(self) -> Chart:
        """Error of each level over its time."""
        return _against_time(self.advice)

    def effects_chart(self) -> Chart:
        """Change of the quantity for each detail that is left out."""
        advice, shown = self.advice, list(reversed(self.effects))
        bars = {
            "type": "bar",
            "orientation": "h",
            "x": rounded([100 * effect.change for effect in shown]),
            "y": [effect.detail for effect in shown],
        }
        tolerance = 100 * advice.tolerance
        figure = chart(
            f"Change of {advice.quantity.name} when one detail is left out, at level "
            f"{effects_level_title(self.effects_level)}; shaded: within the tolerance",
            [bars],
            x="change [%]",
            y="",
            safe=(-tolerance, tolerance),
        )
        figure.figure["layout"]["yaxis"]["automargin"] = True
        return figure


def advise(
    scene: Scene,
    quantity: str,
    tolerance: float = 0.01,
    load: Mapping[str, float] | None = None,
    to_the_top: bool = False,
    *,
    kept: bool = False,
    report: Progress = silent,
) -> AdviseResult:
    """Find the cheapest level that is accurate enough, and rank the details of the scene.

    Parameters
    ----------
    scene : Scene
        The scene; its mesh sizes are those of the most expensive level.
    quantity : str
        Quantity that must be accurate: a reaction, as in "main_bearing.My" or "gearbox.Fz", or a
        stiffness, "hub.stiffness.ux" to "hub.stiffness.rz".
    tolerance : float
        Allowed error, relative.
    load : mapping of str to float or None
        Load that causes a reaction, by component [N, N m, m/s^2]; None for each hub load by itself.
    to_the_top : bool
        Whether to run every level, even if a cheaper one is accurate enough.
    kept : bool
        Whether solutions may come from the cache, with the times that they took when they were
        solved: then a dossier solves nothing twice. Otherwise all is solved and timed now.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        The quantity or a load is unknown, or the quantity is zero at the highest level.
    """
    scene = with_sections(scene, scene.title)
    found, steps = Findings(), Steps(report)
    found.seed = None
    found.about(scene)
    asked = Quantity(quantity, None if load is None else named_load(scene, load))
    with steps.step("model levels"):
        advice = run_levels(
            scene, asked, tolerance, to_the_top, report, cache=user_cache() if kept else UNCACHED
        )
    chosen = None if advice.chosen is None else advice.results[advice.chosen]
    level = 2 if chosen is not None and chosen.model.level == 2 else 1
    ranked: list[Effect] = []
    if advice.springs:
        with steps.step("details"):
            ranked = effects(scene, asked, level, advice.springs, report)
    found.say(advice.sentence())
    if chosen is not None and chosen.model.neglects:
        found.say(f"It neglects {', '.join(chosen.model.neglects)}.")
    _judge(found, advice, advice.top if chosen is None else chosen)
    _data(found, advice)
    _answer(found, advice, ranked)
    return AdviseResult(
        drivetrain=scene,
        advice=advice,
        effects=tuple(ranked),
        effects_level=level,
        **found.frozen(
            steps.times, quantity=quantity, tolerance=tolerance, load=load, to_the_top=to_the_top
        ),
    )


def effects_level_title(level: int) -> str:
    """Words for the level at which details are left out."""
    return f"{level} with housings as springs"


def _judge(found: Findings, advice: Advice, known: LevelResult) -> None:
    """Check the error of the chosen level, else of the highest one, against the tolerance."""
    is_exact = known.estimate == 0.0 or known is advice.top
    error = known.estimate if is_exact else known.error + advice.top.estimate
    which = f"{advice.quantity.name}: error of level {known.model.level}, {known.model.title}"
    found.found(f"{which} [%]", 100.0 * error)
    found.at_most(
        which,
        error,
        advice.tolerance,
        why="the tolerance that was requested",
        source=f"level {advice.top.model.level}, {advice.top.model.title}, and its own error band",
    )


def _answer(found: Findings, advice: Advice, ranked: list[Effect]) -> None:
    """State the level that is enough, with its error, time and value."""
    name, top = quantity_in_words(advice.quantity.name), advice.top
    known = top if advice.chosen is None else advice.results[advice.chosen]
    model, share = known.model, f"{100 * advice.tolerance:g}\u00a0%"
    error = top.estimate if known is top else known.error
    band = None if known is top else 100.0 * top.estimate
    size = formatted(100.0 * error, 2)
    if advice.chosen is None:
        verdict = f"Not known within {share}: the finest model, {model.title}, may err by "
        verdict += f"{size}\u00a0% in {name}."
    elif known is top and model.level == 0 and error == 0.0:
        verdict = f"Level\u00a00 ({model.title}) is enough for {name}: no stiffness decides it."
    elif known is top:
        verdict = f"Level\u00a0{model.level} ({model.title}) is needed to have {name} within "
        verdict += f"{share}; it may err by {size}\u00a0%."
    else:
        verdict = f"Level\u00a0{model.level} ({model.title}) is enough for {name}: {size}\u00a0% "
        verdict += f"from the {top.model.title}, within {share}."
    level = f"level {model.level}"
    figures = [
        found.value(f"error of {level} [%]", 100.0 * error, band, at_most=100.0 * advice.tolerance),
        *_value_of(found, known, advice.quantity, error + (band or 0.0) / 100.0),
        found.value(f"time of {level} [s]", known.seconds),
        found.value("time of the last level [s]", top.seconds),
    ]
    if ranked:
        detail = f"change where {ranked[0].detail} is left out [%]"
        figures.append(found.value(detail, 100.0 * ranked[0].change))
    found.answer(f"Which model is enough for {name} within {share}?", verdict, figures)


def _value_of(
    found: Findings, known: LevelResult, quantity: Quantity, share: float
) -> list[KeyFigure]:
    """The quantity, within that share; none where no load was given, and it has six values."""
    if len(known.values) != 1:
        return []
    value, unit = in_large_unit(float(known.values[0]), quantity.unit)
    name = f"{quantity_in_words(quantity.name)} [{unit}]"
    return [found.value(name, value, abs(value) * share if np.isfinite(share) else None)]


def _data(found: Findings, advice: Advice) -> None:
    """Keep the levels for other programs."""
    found.data("quantity", advice.quantity.name)
    found.data("levels", [_level(result, advice.quantity.unit) for result in advice.results])


def _level(result: LevelResult, unit: str) -> Record:
    return {
        "level": result.model.level,
        "title": result.model.title,
        "unit": unit,
        "values": result.values,
        "time [s]": result.seconds,
        "time since the first level began [s]": result.waited,
        OWN_ERROR: None if np.isnan(result.estimate) else result.estimate,
        ERROR_AGAINST_LAST: None if np.isnan(result.error) else result.error,
    }


def _against_time(advice: Advice) -> Chart:
    # errors are differences from the last level: its own error is the band of each
    bands = [advice.top.estimate] * (len(advice.results) - 1) + [0.0]
    traces = error_traces(*advice.ladder, advice.tolerance, advice.chosen, bands)
    enough = "none is accurate enough" if advice.chosen is None else "the chosen one is enough"
    caption = f"Error of each level against its time, {enough}; bars: uncertainty of the finest"
    if min(advice.ladder[2][:-1], default=1.0) <= MINIMUM:
        caption += f"; errors of zero are drawn at {100 * MINIMUM:g} %"
    found = chart(
        caption,
        traces,
        x="time [s]",
        y="error [%]",
        logarithmic=("x", "y"),
    )
    errors = advice.ladder[2]
    found.figure["layout"]["yaxis"]["range"] = figures.error_range(
        errors, advice.tolerance, advice.top.estimate
    )
    return found
