"""Sections of the page of ``loads``: bearing reactions of a scene, and other channels."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from fe_drivetrain.report.charts import trace
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.studies.load_digest import LOADS
from fe_drivetrain.studies.load_histories import LoadsResult
from fe_drivetrain.studies.load_reactions import SceneReactions
from fe_drivetrain.studies.load_records import reaction_loop_rows
from fe_drivetrain.studies.load_totals import LoadTotals
from fe_drivetrain.turbine_loads.histories.spectra import SEGMENT


def reactions_section(page: Page, result: LoadsResult, of: SceneReactions) -> None:
    """Add the section of bearing reactions.

    Parameters
    ----------
    page : Page
        Takes tables and charts.
    result : LoadsResult
        What was found.
    of : SceneReactions
        What solved the scene.
    """
    model = of.model
    page.section("Bearing reactions")
    page.text(
        f"{model.title}"
        + (f"; left out: {'; '.join(model.neglects)}. " if model.neglects else ". ")
        + of.stated.sentences()
    )
    page.table(
        f"Reactions over all files; DEL: damage-equivalent load at {result.asked.frequency:g} Hz; "
        f"{result.asked.counted}",
        result.tables["reactions"],
    )
    page.table("Load loops of reactions, across the shaft", reaction_loop_rows(result.reactions))
    for chosen, unit in ((("Fy", "Fz"), "kN"), (("My", "Mz"), "kN m")):
        traces = _spectra(result.reactions, chosen)
        if traces:
            page.chart(
                f"Power spectral density of {' and '.join(chosen)} of each reaction, segments of "
                f"{SEGMENT:g} s",
                traces,
                "frequency [Hz]",
                f"density [({unit})²/Hz]",
                "xy",
            )


def others_section(page: Page, result: LoadsResult) -> None:
    """Add the section of other channels, where there are some."""
    if result.others:
        page.section("Other channels")
        page.table(
            f"In the files' units; DEL: damage-equivalent at {result.asked.frequency:g} Hz; "
            f"{result.asked.counted}",
            result.tables["other_channels"],
        )


def _spectra(found: Mapping[str, LoadTotals], chosen: Sequence[str]) -> list[Any]:
    traces = []
    for name, one in found.items():
        density, frequency = one.spectra.density / 1e6, one.spectra.frequency[1:]
        traces += [
            trace(f"{name}, {load}", frequency, density[LOADS.index(load), 1:])
            for load in chosen
            if len(frequency) and density[LOADS.index(load), 1:].max() > 0.0
        ]
    return traces
