"""The page of ``transient``: what a drivetrain does over time, extremes, levels, histories."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.dynamics.time.machine_channels import Kind
from fe_drivetrain.plots.figures import error_range, error_traces
from fe_drivetrain.report.charts import chart, trace
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.transient_ladder import QUANTITIES, finest_band
from fe_drivetrain.studies.transient_parts import damage_chart
from fe_drivetrain.studies.transient_result import TransientResult
from fe_drivetrain.studies.transient_tables import spectrum_of

_SHOWN = 20


def show_transient(run: Run, page: Page, result: TransientResult) -> None:
    """Show what a drivetrain does over time.

    Parameters
    ----------
    run : Run
        Not used: the page has no pictures.
    page : Page
        Takes tables and charts.
    result : TransientResult
        What was found.
    """
    _over_time(page, result)
    _extremes(page, result)
    _parts(page, result)
    if len(result.runs) > 1:
        _levels(page, result)
    if result.files:
        _histories(page, result)


def _over_time(page: Page, result: TransientResult) -> None:
    """Torques, meshes, bearings and speeds, the one of the answer first."""
    page.section("Over time")
    hero = result.chart()
    page.add(hero)
    kinds: tuple[Kind, ...] = ("torque", "mesh", "bearing", "speed")
    for kind in kinds:
        if any(one.kind == kind for one in result.extremes.values()):
            found = result.over_time(kind)
            if found.caption != hero.caption:
                page.add(found)
    if result.files:
        page.text("Of the first history; positive as at rated torque.")


def _extremes(page: Page, result: TransientResult) -> None:
    page.section("Extremes")
    kinds: dict[Kind, str] = {**QUANTITIES, "speed": "speeds"}
    rows = {str(row["channel"]): row for row in result.tables["extremes"]}
    for kind, words in kinds.items():
        of: list[Record] = [
            {key: value for key, value in rows[name].items() if key != "unit"}
            for name, one in result.extremes.items()
            if one.kind == kind
        ]
        if of:
            unit = next(
                rows[name]["unit"] for name, one in result.extremes.items() if one.kind == kind
            )
            page.table(f"{words[0].upper()}{words[1:]} [{unit}]", of)
    page.text(
        "Torques, forces of meshes and speeds are positive as at rated torque; forces of bearings "
        "are those across the axis. ± is what the step leaves uncertain."
    )
    if "instants" in result.tables:
        page.section("Instants of the brake")
        page.table("Peak of the torque by the instant of the brake", result.tables["instants"])
    if "alternating" in result.tables:
        page.section("Forces beside the axis")
        page.table(
            "Forces of bearings and meshes: aligned, mean, and what alternates with the "
            "generator's turns",
            result.tables["alternating"],
        )


def _parts(page: Page, result: TransientResult) -> None:
    """Damage and static safety of gears and bearings."""
    use = result.parts
    if use is None or not (use.gears or use.bearings):
        return
    page.section("Gears and bearings")
    page.add(damage_chart(use))
    if use.gears:
        page.table(
            f"Teeth: damage each {use.per}, static safety at the peak",
            result.tables["gear_damage"],
        )
    if use.bearings:
        page.table(
            f"Bearings: damage each {use.per}, static safety", result.tables["bearing_damage"]
        )
    if "file_damage" in result.tables:
        rows = result.tables["file_damage"]
        more = f": the first {_SHOWN}" if len(rows) > _SHOWN else ""
        page.table(f"Damage of each history, once{more}", rows[:_SHOWN])
    page.text(
        "Teeth: turns at each torque that the force of the mesh stands for, of its own sign, as in "
        "a rating by ISO 6336-6; damage with the safety required, static safety without. Bearings: "
        "loads and speed of the rings in each step, as in a rating life; planets have the mean "
        "damage of all, and the largest load. Damage of 1 is the end of a life."
    )


def _levels(page: Page, result: TransientResult) -> None:
    """Error against time of each level, for torques, meshes and bearings."""
    page.section("Levels of the model")
    kinds = [one.kind for one in result.errors[0]]
    for kind in sorted(kinds, key=lambda kind: kind != result.quantity):
        page.add(_against_time(result, kind))
    page.table("The same in numbers", result.tables["levels"])
    page.text(
        "Error: largest difference of an extreme from that of the finest level, over the largest "
        "value of its channel there; that of the finest, and the bars, are what its step, and "
        "bounds of housings where there are any, leave uncertain. Time: to condense, to build and "
        "to integrate once."
    )
    if "bounds" in result.tables:
        page.table(
            "Largest values at both bounds of the main bearings' housings", result.tables["bounds"]
        )
    if "levels left out" in result.tables:
        page.table("What the ladder does not have", result.tables["levels left out"])


def _against_time(result: TransientResult, kind: Kind) -> Chart:
    errors = [next(e.error for e in of if e.kind == kind) for of in result.errors]
    chosen = result.runs.index(result.chosen)
    band = finest_band(result.runs, kind)
    bands = [band] * (len(errors) - 1) + [0.0]
    errors[-1] = max(errors[-1], band)
    traces = error_traces(
        [run.rung.name for run in result.runs],
        [run.seconds for run in result.runs],
        errors,
        result.tolerance,
        chosen,
        bands,
    )
    found = chart(
        f"Error of {QUANTITIES[kind]} against the time of each level; the finest by its own band",
        traces,
        x="time [s]",
        y="error [%]",
        logarithmic=("x", "y"),
    )
    found.figure["layout"]["yaxis"]["range"] = error_range(errors, result.tolerance, band)
    return found


def _histories(page: Page, result: TransientResult) -> None:
    """Duration spectra, equivalent loads, and each history."""
    page.section("Histories")
    torques = [name for name, one in result.extremes.items() if one.kind == "torque"]
    meshes = [name for name, one in result.extremes.items() if one.kind == "mesh"]
    for what, names in (("torques", torques), ("mesh forces", meshes[:8])):
        traces = []
        for name in names:
            found = spectrum_of(result.files, name)
            x, y = found.edges()[:-1] / result.extremes[name].rated, found.at_least / 3600.0
            traces.append(trace(name, x, y, line={"shape": "hv"}))
        page.chart(
            f"Duration spectra of {what}: time at a level or above",
            traces,
            "level over rated",
            "time [h]",
            "y",
        )
    page.table(
        "Damage-equivalent ranges at 1 Hz, all histories",
        result.tables["equivalent_loads"],
    )
    rows = result.tables["files"]
    page.table("Histories" + (f": the first {_SHOWN}" if len(rows) > _SHOWN else ""), rows[:_SHOWN])
    if "base_motion" in result.tables:
        page.table("How the base moves", result.tables["base_motion"][:_SHOWN])
        page.text(
            "The drivetrain turns under rated torque. Its base has the file's acceleration, "
            "straight between samples; it begins wound up under the first sample."
        )
        return
    apart = max(one.against_file for one in result.files.values())
    page.text(
        "The rotor is driven by the shaft's torque of the file and what its own inertia takes; the "
        f"torque of the first shaft comes back within {100.0 * apart:.2g} % of rated (RMS): what "
        "is left is the drivetrain's own swing, which the file's model does not have."
    )
    if not np.isfinite([one.speed_against_file for one in result.files.values()]).all():
        page.text("A file without a rotor speed runs at rated speed.")
