"""Sections of the page of a project: what each of the six steps decided, and on what it rests."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from fe_drivetrain.procedure.evidence import Found
from fe_drivetrain.procedure.project import InputValue
from fe_drivetrain.procedure.sensors import sampling_rates
from fe_drivetrain.report.charts import heat_map
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.results import Table
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.project_validation import (
    ValidateResult,
    as_record,
    identification_rows,
)


def evidence_table(evidence: Sequence[Found], reports: Path, folder: Path) -> Table:
    """Evidence with verdict, band, date and version; each row leads to the page of its case.

    Parameters
    ----------
    evidence : sequence of Found
        Of a step.
    reports, folder : Path
        Of the evidence, and of the page.

    Returns
    -------
    Table
    """
    shown = ("case", "stands for", "state", "quantity", "computed", "asked", "checks", "run")
    rows: list[Record] = [
        {key: value for key, value in as_record(found).items() if key in shown}
        for found in evidence
    ]
    above = os.path.relpath(reports, folder).replace(os.sep, "/")
    return Table(
        caption="Evidence",
        columns=list(rows[0]),
        rows=[list(row.values()) for row in rows],
        links=[f"{above}/{f.link.case}/report.html" if f.results else "" for f in evidence],
    )


def _failure_modes(page: Page, result: ValidateResult) -> None:
    step = result.project.failure_modes
    assert step is not None
    known = {load.name: load for load in result.catalogue.design_loads}
    rows: list[Record] = []
    for one in step.critical:
        load = known.get(one.load)
        rows.append(
            {
                "critical design load": one.load,
                "system": f"{load.system}, {load.part}" if load else "unknown",
                "for": ", ".join(load.kinds) if load else "",
                "critical design variables": ", ".join(
                    one.variables or (load.variables if load else ())
                ),
                "covered by load cases": load.covered if load else "",
                "table": load.table if load else "",
            }
        )
    if rows:
        page.table("Critical failure modes and design variables", rows)
    answered = {gap.load: gap for gap in step.gaps}
    gaps: list[Record] = []
    for load in result.catalogue.uncovered:
        if load.system not in result.project.systems:
            continue
        gap = answered.get(load.name)
        run = ", ".join(link.case for link in gap.evidence) if gap else ""
        gaps.append(
            {
                "not covered by load cases": load.name,
                "covered": load.covered,
                "to be run": load.remedy,
                "was run": run or (f"dismissed: {gap.dismissed}" if gap else "no"),
            }
        )
    if gaps:
        page.table("What today's load cases leave out", gaps)
    others = [
        load.name
        for load in result.catalogue.design_loads
        if load.system in result.project.systems
        and load.name not in {one.load for one in step.critical}
        and load.covered == "yes"
    ]
    if others:
        page.text(f"Of the catalogue, not held to be critical: {'; '.join(others)}.")


def _model(page: Page, result: ValidateResult) -> None:
    step = result.project.model
    assert step is not None
    page.table(
        f"Model: drivetrain {step.drivetrain}, level {step.level}",
        [
            {"quantity that decides": need.quantity, "tolerance [%]": 100 * need.tolerance}
            for need in step.needs
        ],
        ["quantity that decides", "tolerance [%]"],
    )


def _load_cases(page: Page, result: ValidateResult) -> None:
    step = result.project.load_cases
    assert step is not None
    page.table(
        "Load cases by standard and edition",
        [
            {
                "standard": case.standard,
                "edition": case.edition,
                "number": case.number,
                "brings about": ", ".join(case.loads),
                "run in": ", ".join(link.case for link in case.evidence),
            }
            for case in step.cases
        ],
        ["standard", "edition", "number", "brings about", "run in"],
    )


def _inputs(page: Page, result: ValidateResult) -> None:
    step = result.project.inputs
    assert step is not None
    page.table(
        "Inputs, and how certain each is",
        [
            {
                "input": value.name,
                "value": "" if value.value is None else f"{value.value:g} {value.unit}".strip(),
                "known by": value.known_by or "not stated",
                "band ± [%]": _spread(value, result),
                "source": value.source,
                "measured by": value.measured_by or "none",
            }
            for value in step.values
        ],
        ["input", "value", "band ± [%]", "known by", "source", "measured by"],
    )
    if step.waived:
        page.table(
            "Inputs of Table 4.7 that the project waives",
            [{"input": one.name, "reason": one.reason} for one in step.waived],
        )


def _spread(value: InputValue, result: ValidateResult) -> float | None:
    """Half width [%]: as stated, or as signals determine it."""
    spread = value.band if value.band is not None else result.measured.spreads.get(value.name)
    return None if spread is None else 100 * spread


def _campaign(page: Page, result: ValidateResult) -> None:
    step = result.project.campaign
    assert step is not None
    rows: list[Record] = []
    for signal in step.signals:
        least, better = sampling_rates(signal.highest)
        rows.append(
            {
                "signal": signal.name,
                "interface": signal.interface,
                "rate [Hz]": signal.rate,
                "highest frequency [Hz]": signal.highest,
                "least rate [Hz]": least,
                "better rate [Hz]": better,
                "accuracy ± [%]": 100 * signal.accuracy,
            }
        )
    if rows:
        page.table("Signals", rows)
    matrix, capture = result.matrix, step.capture
    if matrix is None or capture is None:
        return
    winds = 0.5 * (matrix.wind[1:] + matrix.wind[:-1])
    middles = 50.0 * (matrix.turbulence[1:] + matrix.turbulence[:-1])
    used = np.flatnonzero(matrix.counts.sum(axis=1))
    if used.size:
        shown = slice(int(used[0]), int(used[-1]) + 1)
        counts = matrix.counts[shown].astype(float)
        page.add(
            heat_map(
                f"Capture matrix: windows of ten minutes, {matrix.counts.sum()} in all, "
                f"{matrix.outside} outside; mean turbulence {100 * matrix.mean_turbulence:.1f} %",
                winds,
                middles[shown],
                np.where(counts > 0, counts, np.nan),
                ("mean wind speed [m/s]", "turbulence intensity [%]", "windows"),
            )
        )
    page.table(
        f"Windows by mean wind, of {capture.target} each",
        [
            {"mean wind [m/s]": float(v), "windows": int(n), "missing": max(capture.target - n, 0)}
            for v, n in zip(winds, matrix.counts.sum(axis=0).tolist(), strict=True)
        ],
    )


def _comparison(page: Page, result: ValidateResult) -> None:
    step = result.project.comparison
    assert step is not None
    if not result.measured.verdicts:
        return
    page.table(
        f"Computed against measured ({step.measured.file})",
        [
            {
                "quantity": v.quantity,
                "measured": f"{formatted(v.reference)} {v.unit}".strip(),
                "computed": f"{formatted(v.computed)} {v.unit}".strip(),
                "difference [%]": 100 * (v.computed / v.reference - 1) if v.reference else None,
                "allowed [%]": 100 * v.tolerance,
                "how": v.source,
            }
            for v in result.measured.verdicts
        ],
    )
    if result.measured.methods:
        page.table(
            "Stiffness, damping and inertia by each method of PROTEST 2010, and by fits",
            identification_rows(result.measured),
        )
        page.text(
            "Equations 4 to 13 are taken as printed; a shaft's torque has no inertia in it, and "
            "ranges drop the phase, so that methods A to C do not hold. What is judged is the fit "
            "of spectra, and the decrement where a stop is stated."
        )


STEP_SECTIONS = (_failure_modes, _model, _load_cases, _inputs, _campaign, _comparison)
"""What fills the section of each of the six steps."""
