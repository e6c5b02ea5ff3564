"""The page of a drivetrain's modes: Campbell diagram, moving shapes, energy, crossings, levels."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.pages.mode_shapes import shape_charts
from fe_drivetrain.report.charts import bars, marked
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.drivetrain_modes import SHOWN, ModesResult
from fe_drivetrain.studies.mode_findings import crossing_row, excited, level_rows, mode_rows
from fe_drivetrain.studies.mode_register import defect_rows, margin_chart, register_rows

DRAWN = 8
"""Number of modes whose shapes are drawn."""
_LEAST = 0.1  # share of energy of a part that has a colour of its own
_OTHERS = "others"


def show_modes(run: Run, page: Page, result: ModesResult) -> None:
    """Show the modes of a drivetrain.

    Parameters
    ----------
    run : Run
        The run.
    page : Page
        Takes sections.
    result : ModesResult
        What was found.
    """
    page.section("Natural frequencies")
    page.add(result.chart())
    page.table("The first modes, at rest and in operation", mode_rows(result, SHOWN))
    page.text(_BANDS)
    page.section("Mode shapes")
    page.text(_SHAPES)
    if result.machine.not_given:
        page.text(
            "Lengths and radii that the file does not state are drawn as long as can be seen."
        )
    page.add(*shape_charts(result, DRAWN))
    page.section("Energy by part")
    for kind, parts in (("kinetic", result.kinetic), ("strain", result.strain)):
        page.add(energy_chart(kind, parts, min(SHOWN, len(result.frequencies))))
    if result.speeds is not None:
        _show_register(page, result)
    _show_levels(page, result)


def energy_chart(kind: str, parts: Mapping[str, Floats], count: int) -> Chart:
    """Shares of parts in the energy of the first modes, as bars.

    Parameters
    ----------
    kind : str
        "kinetic" or "strain".
    parts : mapping of str to ndarray
        Shares (n,) by part.
    count : int
        Number of modes.
    """
    groups: dict[str, dict[str, float]] = {}
    rest = np.ones(count)
    for name, shares in sorted(parts.items(), key=lambda one: -float(one[1][:count].sum())):
        if shares[:count].max() >= _LEAST:
            groups[name] = {f"mode {k + 1}": float(shares[k]) for k in range(count)}
            rest -= shares[:count]
    if rest.max() > 1e-3:
        groups[_OTHERS] = {f"mode {k + 1}": max(float(rest[k]), 0.0) for k in range(count)}
    percent = {name: {k: 100 * v for k, v in of.items()} for name, of in groups.items()}
    return bars(f"Share of each part in the {kind} energy", percent, "share [%]", stacked=True)


def _show_register(page: Page, result: ModesResult) -> None:
    """Show which excitations meet modes in operation, or come near."""
    page.section("Resonance register")
    rows = [crossing_row(one, result) for one in excited(result)]
    if rows:
        page.table("Excitations that meet a mode that they can drive, or come near", rows)
    else:
        page.text("No excitation meets a mode that it can drive, or comes near.")
    page.table(
        "Every excitation over the range of speeds, and the mode that it can drive next to it",
        register_rows(result),
    )
    margins = margin_chart(result)
    if margins is not None:
        page.add(margins)
    counts = {
        word: sum(one.verdict == word for one in result.meetings)
        for word in ("resonance", "near", "clear", "not excited")
    }
    page.table(
        "Every excitation against every mode",
        [{"verdict": word, "pairs": count} for word, count in counts.items()],
    )
    page.text(_REGISTER)
    if result.bearing_defects:
        page.section("Defects of bearings")
        page.table("Defect frequencies of the rolling bearings", defect_rows(result))
        page.text(_DEFECTS)


def _show_levels(page: Page, result: ModesResult) -> None:
    """Show each level's frequencies beside those of the finest, and its time."""
    page.section("Levels of the model")
    page.table("Frequencies of the finest level's modes at every level", level_rows(result))
    finest = result.ladder[-1].values
    curves = []
    for name, best in finest.items():
        points = [
            (answer.seconds, 100.0 * abs(value / best - 1.0))
            for answer in result.ladder[:-1]
            if best and (value := answer.values[name]) is not None
        ]
        shown = [(seconds, error) for seconds, error in points if error > 1e-6]
        if shown:
            curves.append(marked(name.partition(" [")[0], *zip(*shown, strict=True)))
    if curves:
        page.chart(
            "Difference from the finest level against the time that a level takes",
            curves,
            "time [s]",
            "difference [%]",
            ("x", "y"),
        )
    page.table(
        f"The simplest level within {100.0 * result.tolerance:g} % of the finest",
        [
            {"mode of the finest level": name.partition(" [")[0], "level": level}
            for name, level in result.enough.items()
        ],
    )


_BANDS = (
    "Bands are of the numerical model alone: with flexible shafts of the number of elements of "
    "each shaft, by three numbers; at simpler levels the distance to the mode of the finest level "
    "that moves in the same way, where there is one. In operation the gyroscopic terms of what "
    "spins are in the frequencies, at rest they are not."
)
_SHAPES = (
    "Drawn obliquely from the side, to scale but for the rotor and the generator. Turning is drawn "
    "over the gear ratio, so that all bodies of a drivetrain that turns as one turn together. "
    "Motions are as large as can be seen: only their proportions count."
)
_REGISTER = (
    "An excitation can drive a mode where the parts at which it acts have 1 % or more of its "
    "energy: the rotor, gears and generator by their motion, meshes by their strain. Margin: least "
    "distance of the two frequencies in operation, over that of the mode; near is below 10 %. What "
    "acts with a defect alone counts neither in the answer nor in the chart of margins."
)
_DEFECTS = (
    "Rolling without slip at the contact angle without load; real bearings differ by 1 % or 2 %. "
    "BPFO and BPFI: rolling elements that pass a place of the outer and of the inner ring; BSF: "
    "turns of an element, which strikes twice in each; FTF: turns of the cage. Bearings of planets "
    "in the frame of their carrier, where the ring on the pin stands still: at a sensor in the "
    "housing, passing planets modulate them."
)
