"""The adviser's result as a table, a chart of error over time, and a tornado chart."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.pages.drivetrain_sketch import drivetrain_sketch
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.results import Cell, Chart, Section, Table, Text
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.shafts.fidelity.advice import LevelResult
from fe_drivetrain.studies.level_advice import AdviseResult, effects_level_title

QUICK_BAND = "A quick run's mesh is coarser than what was asked for: its band is not judged."


def show_advise(run: Run, page: Page, result: AdviseResult) -> None:
    """Show the model levels, the shaft, and the influence of each detail.

    Parameters
    ----------
    run : Run
        The run.
    page : Page
        Takes sections.
    result : AdviseResult
        What was found.
    """
    page.sections.append(ladder(result))
    page.add(drivetrain_sketch("The drivetrain from the side", result.drivetrain, {}, {}))
    if result.effects:
        page.sections.append(tornado(result))


def ladder(result: AdviseResult) -> Section:
    """The model levels: error, time, and effects that each neglects.

    Parameters
    ----------
    result : AdviseResult
        The levels that were run.

    Returns
    -------
    Section
    """
    advice = result.advice
    rows: list[list[Cell]] = []
    for number, one in enumerate(advice.results):
        model = one.model
        rows.append(
            [
                f"{model.level} {model.title}",
                _value(one),
                _percent(one.error),
                _percent(advice.step(number)),
                _percent(one.estimate),
                one.seconds,
                one.waited,
                advice.top.seconds / one.seconds,
                "chosen" if number == advice.chosen else "",
                "; ".join(model.neglects) or "nothing in this scene",
            ]
        )
    unit = advice.quantity.unit
    value = f"value [{unit}]" if len(advice.top.values) == 1 else "norm over the hub loads [-]"
    table = Table(
        caption=f"{advice.quantity.name} at each level",
        columns=[
            "level",
            value,
            "error relative to the last level [%]",
            "difference to the next level [%]",
            "estimated own error ± [%]",
            "time by itself [s]",
            "found after [s]",
            "speed-up over the last level",
            "",
            "neglects",
        ],
        rows=rows,
    )
    items: list[Text | Table | Chart] = [
        Text(text=advice.sentence()),
        result.chart(),
        table,
        Text(text=_NOTE),
    ]
    if advice.kept:
        items.append(Text(text=_KEPT.format(formatted(advice.kept, 2))))
    if advice.quantity.load is None and len(advice.top.values) > 1:
        items.append(Text(text=_EACH_LOAD))
    return Section(title="Model levels", items=items)


def tornado(result: AdviseResult) -> Section:
    """Details of the scene, ranked by their effect on the quantity.

    Parameters
    ----------
    result : AdviseResult
        With the effects of details.

    Returns
    -------
    Section
    """
    title, found = "Influence of each detail", result.effects
    if not any(effect.change for effect in found):
        details = ", ".join(effect.detail for effect in found)
        level = effects_level_title(result.effects_level)
        none = f"No detail changes {result.advice.quantity.name} at level {level}: {details}."
        return Section(title=title, items=[Text(text=none)])
    table = Table(
        caption="Values of the chart",
        columns=["detail left out", "change [%]"],
        rows=[[effect.detail, 100 * effect.change] for effect in found],
    )
    return Section(title=title, items=[result.effects_chart(), table])


_NOTE = (
    "Error: relative difference to the last level that was run. Estimated own error: zero for "
    "statics if equilibrium alone determines the quantity; for a shaft on separately solved "
    "housings, half the difference between a rigid and an averaged housing face, and the change "
    "from beam to meridian; for the assembly, the discretization error from two coarser meshes or "
    "from recovered stresses, whichever is larger. A "
    "level is accurate enough if its error plus the own error of the last level is within the "
    "tolerance. Time by itself: what the value needs, with meshing, unless the mesh came from the "
    "cache, and without the estimate of its error. Found after: from the beginning, estimates "
    "included."
)
_KEPT = (
    "What another study or an earlier page had solved was not solved again. Its time is the time "
    "that it took then, on this kind of machine with as many threads: {}\u00a0s in all."
)
_EACH_LOAD = (
    "No load was given: the levels are compared by the response of the quantity to each of the six "
    "hub loads. Moments are scaled to forces by the length of the shaft."
)


def _value(result: LevelResult) -> Cell:
    value = (
        float(result.values[0]) if len(result.values) == 1 else float(np.linalg.norm(result.values))
    )
    return value if np.isfinite(value) else None


def _percent(share: float) -> Cell:
    return 100 * share if np.isfinite(share) else None
