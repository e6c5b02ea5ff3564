"""The adviser's result as a table, a chart of error over time, and a tornado chart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.fidelity.ablation import Effect, effects
from fe_drivetrain.fidelity.adviser import Advice, LevelResult, advise
from fe_drivetrain.fidelity.quantity import Quantity
from fe_drivetrain.report.charts import chart, rounded, trace
from fe_drivetrain.report.pictures.sketch import shaft_with_rings
from fe_drivetrain.report.results import Cell, Chart, Section, Table, Text
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.run import Run

QUICK_BAND = "A quick run's mesh is coarser than what was asked for: its band is not judged."

_LEAST = 1e-6  # in percent; statics has no error, but a logarithmic axis needs one


def ladder(advice: Advice) -> Section:
    """The model levels: error, time, and effects that each neglects.

    Parameters
    ----------
    advice : Advice
        The levels that were run.

    Returns
    -------
    Section
    """
    rows: list[list[Cell]] = []
    for number, result in enumerate(advice.results):
        model = result.model
        rows.append(
            [
                f"{model.level} {model.title}",
                _value(result),
                _percent(result.error),
                _percent(advice.step(number)),
                _percent(result.estimate),
                result.seconds,
                result.waited,
                advice.top.seconds / result.seconds,
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
        _against_time(advice),
        table,
        Text(text=_NOTE),
    ]
    if advice.quantity.load is None and len(advice.top.values) > 1:
        items.append(Text(text=_EACH_LOAD))
    return Section(title="Model levels", items=items)


def tornado(advice: Advice, level: str, found: Sequence[Effect]) -> Section:
    """Details of the scene, ranked by their effect on the quantity.

    Parameters
    ----------
    advice : Advice
        The quantity and its tolerance.
    level : str
        The model level at which details were left out, in words.
    found : sequence of Effect
        Change of the quantity for each detail, largest first.

    Returns
    -------
    Section
    """
    title = "Influence of each detail"
    if not any(effect.change for effect in found):
        details = ", ".join(effect.detail for effect in found)
        none = f"No detail changes {advice.quantity.name} at level {level}: {details}."
        return Section(title=title, items=[Text(text=none)])
    shown = list(reversed(found))
    bars = {
        "type": "bar",
        "orientation": "h",
        "x": rounded([100 * effect.change for effect in shown]),
        "y": [effect.detail for effect in shown],
    }
    tolerance = 100 * advice.tolerance
    figure = chart(
        f"Change of {advice.quantity.name} when one detail is left out, at level {level}; "
        "shaded: within the tolerance",
        [bars],
        x="change [%]",
        y="",
        safe=(-tolerance, tolerance),
    )
    figure.figure["layout"]["yaxis"]["automargin"] = True
    table = Table(
        caption="Values of the chart",
        columns=["detail left out", "change [%]"],
        rows=[[effect.detail, 100 * effect.change] for effect in found],
    )
    return Section(title=title, items=[figure, table])


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
_EACH_LOAD = (
    "No load was given: the levels are compared by the response of the quantity to each of the six "
    "hub loads. Moments are scaled to forces by the length of the shaft."
)


def _against_time(advice: Advice) -> Chart:
    known = [result for result in advice.results if np.isfinite(result.error)]
    traces: list[Any] = [
        trace(
            f"level {result.model.level}, {result.model.title}",
            [result.seconds],
            [max(100 * (result.error if result is not advice.top else result.estimate), _LEAST)],
            points=True,
            marker={"size": 14 if result is _chosen(advice) else 9},
        )
        for result in known
    ]
    times = [result.seconds for result in known]
    limit = 100 * advice.tolerance
    traces.append(
        trace("tolerance", [min(times), max(times)], [limit, limit], line={"dash": "dash"})
    )
    return chart(
        "Error over time; for the last level its estimated own error. The largest marker is the "
        f"level that is accurate enough. Errors of zero are drawn at {_LEAST:g} %",
        traces,
        x="time [s]",
        y="error [%]",
        logarithmic=("x", "y"),
    )


def _chosen(advice: Advice) -> LevelResult | None:
    return None if advice.chosen is None else advice.results[advice.chosen]


def _value(result: LevelResult) -> Cell:
    value = (
        float(result.values[0]) if len(result.values) == 1 else float(np.linalg.norm(result.values))
    )
    return value if np.isfinite(value) else None


def _percent(share: float) -> Cell:
    return 100 * share if np.isfinite(share) else None


def advised(
    run: Run, page: Page, scene: Scene, quantity: Quantity, tolerance: float, to_the_top: bool
) -> None:
    """Find the cheapest level that is accurate enough, and rank the details of the scene.

    Parameters
    ----------
    run : Run
        The run that the levels are steps of.
    page : Page
        Takes the levels, the details and the check of the level that was chosen.
    scene : Scene
        The scene.
    quantity : Quantity
        The quantity that must be accurate.
    tolerance : float
        Allowed relative error.
    to_the_top : bool
        Whether to run every level, even if a cheaper one is accurate enough.

    Raises
    ------
    InputError
        See `fe_drivetrain.fidelity.adviser.advise`.
    """
    page.about(scene)
    with run.step("model levels"):
        advice = advise(scene, quantity, tolerance, to_the_top, run.report)
    chosen = None if advice.chosen is None else advice.results[advice.chosen]
    page.sections.append(ladder(advice))
    bodies = shaft_with_rings(scene)
    page.image("Shaft and bearing rings", run.sketch(*bodies, file="shaft.png"))
    level = 2 if chosen is not None and chosen.model.level == 2 else 1
    if advice.springs:
        with run.step("details"):
            found = effects(scene, quantity, level, advice.springs, run.report)
        page.sections.append(tornado(advice, f"{level} with housings as springs", found))
    page.answer(advice.sentence())
    if chosen is not None and chosen.model.neglects:
        page.answer(f"It neglects {', '.join(chosen.model.neglects)}.")
    known = advice.top if chosen is None else chosen
    is_exact = known.estimate == 0.0 or known is advice.top
    error = known.estimate if is_exact else known.error + advice.top.estimate
    which = f"{quantity.name}: error of level {known.model.level}, {known.model.title}"
    page.found(f"{which} [%]", 100.0 * error)
    if run.quick:
        page.answer(QUICK_BAND)
    else:
        page.at_most(
            which,
            error,
            tolerance,
            why="the tolerance that was requested",
            source=f"level {advice.top.model.level}, {advice.top.model.title}, and its own error "
            "band",
        )
    page.data("quantity", quantity.name)
    page.data(
        "levels",
        [
            {
                "level": result.model.level,
                "title": result.model.title,
                "values": result.values,
                "seconds": result.seconds,
                "waited": result.waited,
                "estimate": None if np.isnan(result.estimate) else result.estimate,
                "error": None if np.isnan(result.error) else result.error,
            }
            for result in advice.results
        ],
    )
