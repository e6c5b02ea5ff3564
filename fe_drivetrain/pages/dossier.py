"""The first page of a dossier: the drivetrain with its reactions, extremes, lives, and files."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from fe_drivetrain.pages.drivetrain_sketch import drivetrain_sketch
from fe_drivetrain.report.answer import Status
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.results import Cell, Results, Table
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.dossier_overview import (
    AROUND_PEAK,
    DESIGN_LIFE,
    EXTREMES,
    LIVES,
    MODEL,
    REACTIONS,
    SKETCH,
    DossierResult,
    life_chart,
    peak_chart,
)


def show_dossier(run: Run, page: Page, result: DossierResult) -> None:
    """Show the first page of a dossier.

    Parameters
    ----------
    run : Run
        The run.
    page : Page
        Takes tables and charts.
    result : DossierResult
        What was found.
    """
    page.section("The drivetrain")
    rows = {str(row["bearing"]): row for row in result.bearings}
    page.add(
        drivetrain_sketch(
            SKETCH,
            result.drivetrain,
            {name: _words(row) for name, row in rows.items()},
            {name: _status(row) for name, row in rows.items()},
        )
    )
    page.table("Bearings: largest forces and moments, and life", result.bearings)
    page.section("Extremes")
    page.table(
        "The largest of each load and reaction, with its file and its time there",
        result.tables[EXTREMES],
    )
    page.add(peak_chart(result.tables[AROUND_PEAK]))
    if (lives := life_chart(result.tables[LIVES])) is not None:
        page.section("Life")
        page.add(lives)
    _answers(page, result.parts)


def _words(row: Mapping[str, Any]) -> list[str]:
    """What stands at a bearing of the sketch."""
    force = row.get("largest radial force [kN]")
    words = [] if force is None else [f"{value_text(force, 'kN')} radial"]
    if row.get("largest tilting moment [kN m]") is not None:
        words.append(value_text(row["largest tilting moment [kN m]"], "kN m"))
    if row.get("L10mr [years]") is not None:
        words.append(f"{float(row['L10mr [years]']):.3g} years")
    if row.get("min S0 [-]") is not None:
        words.append(f"S0 {float(row['min S0 [-]']):.2g}")
    return words


def _status(row: Mapping[str, Any]) -> Status:
    """How a bearing stands to its limits: static safety of 1, and a life of 20 years."""
    safety, life = row.get("min S0 [-]"), row.get("L10mr [years]")
    if safety is None:
        return "none"
    if float(safety) < 1.0:
        return "bad"
    return "good" if life is not None and float(life) >= DESIGN_LIFE else "watch"


def _answers(page: Page, parts: Mapping[str, Results]) -> None:
    """What each part has answered, with the way to it."""
    page.section("All answers")
    titles = {REACTIONS: "reactions", MODEL: "which model"}
    rows: list[list[Cell]] = [
        [titles.get(name, name), part.answer.verdict if part.answer else " ".join(part.details[:1])]
        for name, part in parts.items()
    ]
    page.add(
        Table(
            caption="Answers of the parts, each a page of its own",
            columns=["part", "answer"],
            rows=rows,
            links=[f"../{name}/report.html" for name in parts],
        )
    )
    page.text(
        "`summary.json`, `stiffness.json`, the mesh and the reactions over time stand beside the "
        "page of reactions. What else other programs can take is on the page Export."
    )
