"""The dossier of a drivetrain: what its parts have found, in one answer for who decides."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import bars, mark_events, trace
from fe_drivetrain.report.charts import chart as line_chart
from fe_drivetrain.report.number_text import certain_value, value_text, value_with_band
from fe_drivetrain.report.results import Chart, Figure, Results, cautions_of
from fe_drivetrain.report.suite.case import QUICK
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.load_extremes import around_largest, load_extremes
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.scene_study import StudyResult
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory

REACTIONS, LIFE, LOADS, MODEL, CHECK = "reactions", "life", "loads", "model", "check"
MODES, GEARS, STRENGTH, STOP, EXPORT = "modes", "gears", "strength", "stop", "export"
"""Parts of a dossier."""
_SEVERE_FIRST = (LIFE, GEARS, STRENGTH, REACTIONS, STOP, MODES, LOADS, MODEL, CHECK, EXPORT)
DESIGN_LIFE = 20.0
"""Years that a wind turbine is designed for, at least (IEC 61400-1, 6.2)."""

EXTREMES, AROUND_PEAK = "extremes", "around_the_peak"
"""Tables that the part of reactions has beside those of a study."""
LIVES = "lives"
"""Table of the life of each rated bearing, those of the gearbox among them."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class DossierResult(Result):
    """What a dossier says on its first page.

    Attributes
    ----------
    drivetrain : Scene
        What it is of.
    parts : Mapping[str, Results]
        What its parts have found; not part of the JSON.
    bearings : tuple of dict
        Place of each bearing, its largest forces, and its life where it has one.
    """

    STUDY: ClassVar[str] = "dossier"

    drivetrain: Scene
    parts: Mapping[str, Results]
    bearings: tuple[Record, ...]

    def chart(self) -> Chart:
        """Radial force of the bearings around the largest of them."""
        return peak_chart(self.tables[AROUND_PEAK])


def extremes_of(result: StudyResult, histories: Sequence[LoadHistory]) -> dict[str, Any]:
    """Tables of extremes that a dossier has beside those of a study.

    Parameters
    ----------
    result : StudyResult
        The study of the histories.
    histories : sequence of LoadHistory
        Hub loads that were studied.

    Returns
    -------
    dict
        Records of `EXTREMES`, and `AROUND_PEAK`.
    """
    each = [result.reactions(history) for history in histories]
    reactions = {name: [of[name] for of in each] for name in each[0]}
    bearings = {name: of for name, of in reactions.items() if name != "gearbox"}
    found = load_extremes(histories, reactions)
    around = around_largest(histories, bearings, found)
    return {EXTREMES: [one.row() for one in found], AROUND_PEAK: around.table()}


def dossier(scene: Scene, parts: Mapping[str, Results]) -> DossierResult:
    """Put the answers of the parts together.

    Parameters
    ----------
    scene : Scene
        The drivetrain.
    parts : mapping of str to Results
        By `REACTIONS`, which has to be there, `LIFE`, `LOADS`, `MODEL`, `CHECK`, `MODES`,
        `GEARS`, `STRENGTH`, `STOP` and `EXPORT`.

    Returns
    -------
    DossierResult
    """
    found, steps = Findings(), Steps()
    found.about(scene)
    reactions = parts[REACTIONS]
    extremes = reactions.figures[EXTREMES]
    rows = _bearing_rows(scene, extremes, parts.get(LIFE))
    found.data("bearings", rows)
    found.data(LIVES, _lives(parts.get(LIFE)))
    found.data(EXTREMES, extremes)
    found.data(AROUND_PEAK, reactions.figures[AROUND_PEAK])
    for name, part in parts.items():
        found.checks += [
            check.model_copy(update={"quantity": f"{name}: {check.quantity}"})
            for check in part.verdicts
        ]
        found.unsettled += [f"{name}: {sentence}" for sentence in part.unsettled]
        found.skipped += part.skipped
        found.figures += part.answers
        for row in part.assumptions:
            if row not in found.assumptions:
                found.assumptions.append(row)
    _answer(found, rows, parts)
    return DossierResult(
        drivetrain=scene, parts=parts, bearings=tuple(rows), **found.frozen(steps.times)
    )


def _bearing_rows(
    scene: Scene, extremes: Sequence[Mapping[str, Any]], life: Results | None
) -> list[Record]:
    """Place of each bearing, what it carries at most, and how long it lives."""
    lives = {row["bearing"]: row for row in life.figures.get("lives", ())} if life else {}
    limits = {row["bearing"]: row for row in life.figures.get("limits", ())} if life else {}
    places = {unit.bearing.name: unit.bearing.x for unit in scene.bearing_units}
    places |= {bearing.name: bearing.x for bearing in scene.nose_bearings}
    rows: list[Record] = []
    for name, place in places.items():
        largest = {e["load"]: e for e in extremes if e["place"] == name}
        row: dict[str, Any] = {"bearing": name, "x [m]": place}
        for load in ("radial force", "axial force Fx"):
            row[f"largest {load} [kN]"] = largest.get(load, {}).get("largest [kN]")
        row["largest tilting moment [kN m]"] = largest.get("tilting moment", {}).get(
            "largest [kN m]"
        )
        if life is not None:
            row["L10mr [years]"] = lives.get(name, {}).get("L10mr [years]")
            row["min S0 [-]"] = limits.get(name, {}).get("min S0")
            row["max pressure [MPa]"] = limits.get(name, {}).get("max pressure [MPa]")
        rows.append(row)
    return rows


def _lives(life: Results | None) -> list[Record]:
    """Life and limits of each rated bearing, those of the gearbox among them."""
    if life is None:
        return []
    limits = {row["bearing"]: row for row in life.figures.get("limits", ())}
    return [
        {
            "bearing": row["bearing"],
            "L10mr [years]": row["L10mr [years]"],
            "min S0 [-]": limits[row["bearing"]]["min S0"],
            "max pressure [MPa]": limits[row["bearing"]]["max pressure [MPa]"],
        }
        for row in life.figures.get("lives", ())
        if row.get("L10mr [years]") is not None and row["bearing"] in limits
    ]


def _answer(found: Findings, rows: Sequence[Record], parts: Mapping[str, Results]) -> None:
    """The answer: loads, lives, and what is not enough."""
    most: Any = max(rows, key=lambda row: float(row["largest radial force [kN]"] or 0.0))  # type: ignore[arg-type]
    peak = _peak_figure(found, parts[REACTIONS], str(most["bearing"]), most)
    figures = [peak]
    said = f"Bearing {most['bearing']} carries at most {certain_value(peak)}"
    lived = _lives(parts.get(LIFE))
    if lived:
        shortest: Any = min(lived, key=lambda row: float(row["L10mr [years]"]))  # type: ignore[arg-type]
        weakest: Any = min(lived, key=lambda row: float(row["min S0 [-]"]))  # type: ignore[arg-type]
        life = _life_figure(found, parts[LIFE], shortest)
        safety = found.value(
            f"static safety S0 of {weakest['bearing']}",
            weakest["min S0 [-]"],
            at_least=1.0,
            by="ISO 76",
        )
        figures += [life, safety]
        if safety.status == "bad":
            pressure = value_text(weakest["max pressure [MPa]"], "MPa")
            said = (
                f"Not usable: bearing {weakest['bearing']} has a static safety of "
                f"{certain_value(safety)}, with {pressure} contact pressure"
            )
        elif life.status == "bad":
            lives = f"{shortest['bearing']} lives {certain_value(life)}"
            said += f"; {lives}, less than {DESIGN_LIFE:g}"
        elif life.status == "watch":
            lives = f"{shortest['bearing']} lives {value_with_band(life)}"
            said += f"; {lives}, not surely {DESIGN_LIFE:g}"
        elif len(lived) == 1:
            said += f"; {shortest['bearing']} lives {certain_value(life)}"
        else:
            said += f"; the bearings live {certain_value(life)} or more"
    for name, weak in ((GEARS, "gears are too weak"), (STRENGTH, "the shaft is too weak")):
        answer = parts[name].answer if name in parts else None
        if answer is not None:
            figures += [figure for figure in answer.figures if figure.quantity][:1]
            said += f"; {weak}" if answer.status == "bad" else ""
    figures += _others(parts)
    found.answer(
        "What do these loads do to this drivetrain?",
        f"{said}.",
        figures[:6],
        hero=SKETCH,
        cautions=_cautions(parts),
    )


def _cautions(parts: Mapping[str, Results]) -> list[str]:
    """Cautions of all parts, those that several of them say once, with the names of these."""
    of: dict[str, list[str]] = {}
    for name in sorted(parts, key=_SEVERE_FIRST.index):
        for sentence in cautions_of(parts[name]):
            if sentence != QUICK and sentence not in parts[name].unsettled:
                of.setdefault(sentence, []).append(name)
    return [f"{', '.join(names)}: {sentence}" for sentence, names in of.items()]


SKETCH = "The drivetrain from the side, with what its bearings carry at most"
"""Caption of the hero."""


def _peak_figure(found: Findings, part: Results, name: str, row: Mapping[str, Any]) -> KeyFigure:
    """The largest radial force, with the band that the study states for it, if it does."""
    value = float(row["largest radial force [kN]"])
    stated = _figure_of(part, f"on {name}", "kN")
    band = None
    if stated is not None and stated.band and stated.computed:
        band = abs(value * stated.band / stated.computed)
    return found.value(f"largest radial force of {name} [kN]", value, band)


def _life_figure(found: Findings, part: Results, row: Mapping[str, Any]) -> KeyFigure:
    """The shortest life, beside what turbines are designed for."""
    name = str(row["bearing"])
    stated = _figure_of(part, f"L10mr of bearing {name}", "years")
    band = None if stated is None else stated.band
    # the answer's figure has the band of insides that fit a catalogue's page, too
    answered = part.answer.figures if part.answer is not None else ()
    wide = [one.band for one in answered if one.name == f"L10mr of bearing {name}" and one.band]
    band = max(wide, default=band)
    return found.value(
        f"L10mr of {name} [years]",
        float(row["L10mr [years]"]),
        band,
        at_least=DESIGN_LIFE,
        by="IEC 61400-1",
    )


def _figure_of(part: Results, words: str, unit: str) -> Figure | None:
    """The first figure of a unit whose quantity ends with these words."""
    return next((f for f in part.answers if f.quantity.endswith(words) and f.unit == unit), None)


def _others(parts: Mapping[str, Results]) -> list[KeyFigure]:
    """The first key figures of the parts that are values or checks of theirs."""
    others: list[KeyFigure] = []
    for name in (REACTIONS, MODEL, LOADS):
        answer = parts[name].answer if name in parts else None
        if answer is not None:
            others += [f for f in answer.figures if f.quantity][:2]
    return others


def peak_chart(table: Mapping[str, Any]) -> Chart:
    """Radial force of the bearings around the largest of them, which is marked.

    Parameters
    ----------
    table : mapping
        What `Around.table` returns.

    Returns
    -------
    Chart
    """
    time = table["time [s]"]
    traces = [trace(name, time, values) for name, values in table["radial force [kN]"].items()]
    words = f"{table['bearing']}: {value_text(table['peak [kN]'], 'kN')}"
    traces.append(
        trace(
            words,
            [table["at [s]"]],
            [table["peak [kN]"]],
            True,
            marker={"symbol": "circle-open", "size": 13, "line": {"width": 3}},
        )
    )
    caption = f"Radial force of the bearings around the largest, in {table['file']}"
    return line_chart(caption, traces, "time [s]", "radial force [kN]")


def life_chart(rows: Sequence[Mapping[str, Any]]) -> Chart | None:
    """Life of each bearing; None where none of them has one that ends.

    Parameters
    ----------
    rows : sequence of dict
        The table `LIVES` of a dossier.

    Returns
    -------
    Chart or None
    """
    lives = {
        str(row["bearing"]): float(row["L10mr [years]"])
        for row in rows
        if 0.0 < float(row.get("L10mr [years]") or 0.0) < math.inf
    }
    if not lives:
        return None
    caption = "Life of each bearing, L10mr"
    # on an axis from zero, a bearing that hardly carries hides all others, also one that fails
    found = bars(caption, {"L10mr": lives}, "life [years]", min(lives.values()))
    return mark_events(found, {f"{DESIGN_LIFE:g} years": DESIGN_LIFE})
