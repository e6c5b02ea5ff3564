"""What the adviser found, as a table, a chart of error against time, and a tornado chart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.fidelity.ablation import Effect, effects
from fe_drivetrain.fidelity.adviser import Advice, Quantity, Rung, advise
from fe_drivetrain.report.charts import chart, rounded, trace
from fe_drivetrain.report.results import Cell, Chart, Results, Section, Table, Text, judge
from fe_drivetrain.scene.scene import Scene
from fe_drivetrain.suite.case import OldCase as Case
from fe_drivetrain.suite.case import Run

_LEAST = 1e-6  # what statics decides has no error, and a place on a logarithmic axis


def ladder(advice: Advice) -> Section:
    """The levels: error, time, and what each leaves out."""
    rows: list[list[Cell]] = []
    for number, rung in enumerate(advice.rungs):
        model = rung.model
        rows.append(
            [
                f"{model.level} {model.title}",
                _value(rung),
                _percent(rung.error),
                _percent(advice.step(number)),
                _percent(rung.estimate),
                rung.seconds,
                advice.top.seconds / rung.seconds,
                "chosen" if number == advice.chosen else "",
                "; ".join(model.neglects) or "nothing that the scene has",
            ]
        )
    unit = advice.quantity.unit
    value = f"value [{unit}]" if len(advice.top.values) == 1 else "norm of the row [-]"
    table = Table(
        caption=f"{advice.quantity.name} at each level",
        columns=[
            "level",
            value,
            "error against the last [%]",
            "against the next [%]",
            "own estimate ± [%]",
            "time [s]",
            "times faster than the last",
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
        items.append(Text(text=_ROW))
    return Section(title="The ladder", items=items)


def tornado(advice: Advice, level: str, found: Sequence[Effect]) -> Section:
    """Details, ranked by what they do to the quantity."""
    shown = list(reversed(found))
    bars = {
        "type": "bar",
        "orientation": "h",
        "x": rounded([100 * effect.change for effect in shown]),
        "y": [effect.detail for effect in shown],
    }
    tolerance = 100 * advice.tolerance
    figure = chart(
        f"Change of {advice.quantity.name} when one detail is left out, at level {level}; the "
        "shaded range is within the tolerance",
        [bars],
        x="change [%]",
        y="",
        safe=(-tolerance, tolerance),
    )
    figure.figure["layout"]["yaxis"]["automargin"] = True
    table = Table(
        caption="The same in numbers",
        columns=["left out", "change [%]"],
        rows=[[effect.detail, 100 * effect.change] for effect in found],
    )
    return Section(title="Which detail matters", items=[figure, table])


_NOTE = (
    "Error: difference to the last level that was run, relative to it. Own estimate: of statics 0 "
    "where equilibrium alone decides; of a shaft on housings solved apart, half the difference "
    "between a housing's face that is held in shape and one that moves on average, and the change "
    "from beam to meridian; of the assembly the band of its mesh, from two coarser ones. A level "
    "is good enough where its error and the last one's own estimate together are within the "
    "tolerance. Times are those of a level's value, meshes included; a mesh that was made before "
    "comes from the cache, and what an estimate takes comes on top."
)
_ROW = (
    "No load was given: what is compared is the quantity's answer to each of the six hub loads, a "
    "moment counting as a force at the length of the shaft."
)


def _against_time(advice: Advice) -> Chart:
    known = [rung for rung in advice.rungs if np.isfinite(rung.error)]
    traces: list[Any] = [
        trace(
            f"level {rung.model.level}, {rung.model.title}",
            [rung.seconds],
            [max(100 * (rung.error if rung is not advice.top else rung.estimate), _LEAST)],
            points=True,
            marker={"size": 14 if rung is _chosen(advice) else 9},
        )
        for rung in known
    ]
    times = [rung.seconds for rung in known]
    limit = 100 * advice.tolerance
    traces.append(
        trace("tolerance", [min(times), max(times)], [limit, limit], line={"dash": "dash"})
    )
    return chart(
        "Error against time; of the last level its own band. The largest marker is the level that "
        f"is enough. What statics decides is drawn at {_LEAST:g} %",
        traces,
        x="time [s]",
        y="error [%]",
        logarithmic=("x", "y"),
    )


def _chosen(advice: Advice) -> Rung | None:
    return None if advice.chosen is None else advice.rungs[advice.chosen]


def _value(rung: Rung) -> Cell:
    value = float(rung.values[0]) if len(rung.values) == 1 else float(np.linalg.norm(rung.values))
    return value if np.isfinite(value) else None


def _percent(share: float) -> Cell:
    return 100 * share if np.isfinite(share) else None


def advised(
    case: Case, run: Run, scene: Scene, quantity: Quantity, tolerance: float, to_the_top: bool
) -> Results:
    """Climb the ladder, rank the details, and say both.

    Parameters
    ----------
    case, run
        Whose results these are.
    scene, quantity, tolerance, to_the_top
        See `adviser.advise`.
    """
    with run.step("the ladder"):
        advice = advise(scene, quantity, tolerance, to_the_top, run.report)
    sections = [ladder(advice)]
    level = 2 if advice.chosen is not None and advice.rungs[advice.chosen].model.level == 2 else 1
    if advice.springs:
        with run.step("details"):
            found = effects(scene, quantity, level, advice.springs, run.report)
        sections.append(tornado(advice, f"{level} with housings as springs", found))
    summary = [advice.sentence()]
    if advice.chosen is not None and advice.rungs[advice.chosen].model.neglects:
        summary.append(f"It neglects {', '.join(advice.rungs[advice.chosen].model.neglects)}.")
    known = advice.top if advice.chosen is None else advice.rungs[advice.chosen]
    uncertain = (
        known.estimate
        if known.estimate == 0.0 or known is advice.top
        else (known.error + advice.top.estimate)
    )
    verdict = judge(
        f"{quantity.name}: error of level {known.model.level}, {known.model.title}",
        uncertain,
        0.0,
        tolerance=tolerance,
        relative=False,
        source=f"level {advice.top.model.level}, {advice.top.model.title}, and its own band",
        reason="asked for",
    )
    return case.results(
        run,
        summary=summary,
        verdicts=[verdict],
        sections=sections,
        figures={
            "rungs": [
                {
                    "level": rung.model.level,
                    "title": rung.model.title,
                    "values": rung.values.tolist(),
                    "seconds": rung.seconds,
                    "estimate": None if np.isnan(rung.estimate) else rung.estimate,
                    "error": None if np.isnan(rung.error) else rung.error,
                }
                for rung in advice.rungs
            ]
        },
    )
