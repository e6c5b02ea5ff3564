"""The page of a project: how each step stands, its evidence with links, and the log of loops."""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fe_drivetrain.histories.windows import CaptureMatrix
from fe_drivetrain.procedure.assessment import TABLE_4_7, StepState
from fe_drivetrain.procedure.evidence import Found
from fe_drivetrain.procedure.failure_modes import Catalogue
from fe_drivetrain.procedure.iteration_log import Entry, procedure_of
from fe_drivetrain.procedure.project import Project
from fe_drivetrain.procedure.sensors import sampling_rates
from fe_drivetrain.procedure.signatures import content_digest
from fe_drivetrain.procedure.steps import STEPS
from fe_drivetrain.report.charts import heat_map
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.results import Table, Verdict, expectation
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record


@dataclass(frozen=True)
class Standing:
    """A project, and how it stands.

    Attributes
    ----------
    project : Project
        As read.
    catalogue : Catalogue
        Its design loads.
    states : tuple of StepState
        The six steps.
    matrix : CaptureMatrix or None
        Of its campaign.
    verdicts : tuple of Verdict
        Measured against computed.
    """

    project: Project
    catalogue: Catalogue
    states: tuple[StepState, ...]
    matrix: CaptureMatrix | None
    verdicts: tuple[Verdict, ...]


def show_project(
    page: Page, standing: Standing, log: Sequence[Entry], reports: Path, folder: Path
) -> None:
    """Fill the page of a project.

    Parameters
    ----------
    page : Page
        Takes a section for each step, and the checks.
    standing : Standing
        What it shows.
    log : sequence of Entry
        All runs that have changed something, this one included.
    reports : Path
        Folder of the evidence.
    folder : Path
        Of the page, for links.
    """
    page.seed = None
    states = standing.states
    _show_answer(page, states)
    for state in states:
        page.holds(
            f"step {state.number}, {STEPS[state.number - 1]}: complete",
            state.complete,
            why="; ".join(state.lacks) or "decision, evidence and rules of the step",
            source="PROTEST 2010, section 3: each step is taken once, whatever the order",
        )
    page.verdicts += standing.verdicts
    _show_states(page, states)
    shows = (_failure_modes, _model, _load_cases, _inputs, _campaign, _comparison)
    for state, show in zip(states, shows, strict=True):
        page.section(f"Step {state.number}: {STEPS[state.number - 1]}")
        if not state.begun:
            page.text("Not begun.")
            continue
        page.text(f"Decision: {state.decision}")
        show(page, standing)
        if state.evidence:
            page.add(evidence_table(state.evidence, reports, folder))
        if state.lacks:
            page.table("What it lacks", [[text] for text in state.lacks], ["step is not complete"])
    _show_signatures(page, standing)
    _show_log(page, standing.project.subject, log)
    page.data("project", standing.project.model_dump(mode="json"))
    page.data(
        "steps",
        [
            {
                "step": state.number,
                "name": STEPS[state.number - 1],
                "begun": state.begun,
                "complete": state.complete,
                "lacks": state.lacks,
                "evidence": [_as_record(found) for found in state.evidence],
            }
            for state in states
        ],
    )
    page.data("log", [entry.model_dump(mode="json", exclude={"steps"}) for entry in log])


def _show_answer(page: Page, states: Sequence[StepState]) -> None:
    open_steps = [state for state in states if not state.complete]
    if not open_steps:
        page.answer("Complete: all six steps were taken, and all of their evidence counts.")
    else:
        numbers = ", ".join(str(state.number) for state in open_steps)
        word = "step" if len(open_steps) == 1 else "steps"
        page.answer(f"Not complete: {word} {numbers} of 6.")
        for state in open_steps:
            page.answer(f"Step {state.number}, {STEPS[state.number - 1]}: {state.lacks[0]}.")
    page.found("complete steps of six", float(len(states) - len(open_steps)))
    reasons: dict[str, list[str]] = {}
    for found in (one for state in states for one in state.evidence):
        if found.state not in ("passed", "missing"):
            said = found.why if found.counts else f"{found.why} (does not count)"
            reasons.setdefault(f"{found.state}, {said}", []).append(found.link.case)
    for reason, cases in reasons.items():
        page.note(f"Evidence {reason}: {', '.join(dict.fromkeys(cases))}.")


def _show_states(page: Page, states: Sequence[StepState]) -> None:
    page.section("Where it stands")
    page.table(
        "The six steps",
        [
            {
                "step": f"{state.number} {STEPS[state.number - 1]}",
                "state": "complete"
                if state.complete
                else ("not complete" if state.begun else "not begun"),
                "evidence": f"{sum(f.counts for f in state.evidence)} of {len(state.evidence)}"
                if state.evidence
                else "none",
                "lacks": len(state.lacks),
            }
            for state in states
        ],
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
    shown = ("case", "state", "checks", "check shown", "computed", "asked", "band", "run")
    rows: list[Record] = [
        {key: value for key, value in _as_record(found).items() if key in shown}
        for found in evidence
    ]
    above = os.path.relpath(reports, folder).replace(os.sep, "/")
    return Table(
        caption="Evidence",
        columns=list(rows[0]),
        rows=[list(row.values()) for row in rows],
        links=[f"{above}/{f.link.case}/report.html" if f.results else "" for f in evidence],
    )


def _as_record(found: Found) -> Record:
    worst = found.worst
    checks, unit, band = "none", "", None
    if worst is not None:
        passed = sum(verdict.passed for verdict in found.verdicts)
        checks, unit, band = f"{passed} of {len(found.verdicts)} pass", worst.unit, worst.band
    value = "" if worst is None else f"{formatted(worst.computed)} {unit}".strip()
    return {
        "case": found.link.case,
        "state": found.state if found.counts else f"{found.state}, does not count",
        "counts": "yes" if found.counts else "no",
        "checks": checks,
        "check shown": worst.quantity if worst else found.link.check,
        "computed": value,
        "asked": expectation(worst) if worst else "",
        "band": "none" if band is None else f"± {formatted(band)} {unit}".strip(),
        "run": f"{found.date}, {found.version}" if found.date else "",
        "why": found.why,
    }


def _failure_modes(page: Page, standing: Standing) -> None:
    step = standing.project.failure_modes
    assert step is not None
    known = {load.name: load for load in standing.catalogue.design_loads}
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
    for load in standing.catalogue.uncovered:
        if load.system not in standing.project.systems:
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
        for load in standing.catalogue.design_loads
        if load.system in standing.project.systems
        and load.name not in {one.load for one in step.critical}
        and load.covered == "yes"
    ]
    if others:
        page.text(f"Of the catalogue, not held to be critical: {'; '.join(others)}.")


def _model(page: Page, standing: Standing) -> None:
    step = standing.project.model
    assert step is not None
    of = f"scene {step.scene}" if step.scene else f"machine {step.machine}"
    page.table(
        f"Model: {of}, level {step.level}",
        [
            {"quantity that decides": need.quantity, "tolerance [%]": 100 * need.tolerance}
            for need in step.needs
        ],
        ["quantity that decides", "tolerance [%]"],
    )


def _load_cases(page: Page, standing: Standing) -> None:
    step = standing.project.load_cases
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


def _inputs(page: Page, standing: Standing) -> None:
    step = standing.project.inputs
    assert step is not None
    page.table(
        "Inputs, and how certain each is",
        [
            {
                "input": value.name,
                "band ± [%]": None if value.band is None else 100 * value.band,
                "source": value.source,
                "measured by": value.measured_by or "none",
            }
            for value in step.values
        ],
        ["input", "band ± [%]", "source", "measured by"],
    )
    named = {value.name for value in step.values}
    missing = [name for name in TABLE_4_7 if name not in named]
    if missing and {"gearbox", "drivetrain"} & set(standing.project.systems):
        page.text(f"Inputs of Table 4.7 that are not stated: {', '.join(missing)}.")


def _campaign(page: Page, standing: Standing) -> None:
    step = standing.project.campaign
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
    matrix, capture = standing.matrix, step.capture
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


def _comparison(page: Page, standing: Standing) -> None:
    step = standing.project.comparison
    assert step is not None
    if not standing.verdicts:
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
            for v in standing.verdicts
        ],
    )


def _show_signatures(page: Page, standing: Standing) -> None:
    """Who signed, and whether it is this that was signed; the digest, where it can be signed."""
    digest = content_digest(standing.project, standing.states, standing.verdicts)
    complete = all(state.complete for state in standing.states)
    signed = standing.project.signed
    if complete:
        page.data("digest", digest)
    for one in signed:
        page.holds(
            f"signature of {one.name}: of these six steps, complete",
            complete and one.digest == digest,
            why="decisions, evidence or comparisons have changed, or a step is not complete: sign "
            "again",
            source="digest of decisions, evidence and comparisons",
        )
    page.section("Signatures")
    if signed:
        page.table(
            "Signed by",
            [
                {
                    "name": one.name,
                    "role": one.role,
                    "date": one.date,
                    "digest": one.digest,
                    "holds": "yes" if complete and one.digest == digest else "no",
                }
                for one in signed
            ],
        )
    if not complete:
        page.text("It cannot be signed: not all six steps are complete.")
    elif not any(one.digest == digest for one in signed):
        page.text(f"To sign it, state the digest `{digest}` under signed in the project.")


def _show_log(page: Page, subject: str, log: Sequence[Entry]) -> None:
    page.section("Iterations so far")
    procedure = procedure_of(subject, log)
    loops = [
        {"from step": a, "back to step": b, "decision": why}
        for a, b, why in procedure.loops
        if b < a
    ]
    if loops:
        page.table("Loops: each time it went back", loops)
    else:
        page.text("No step was taken again after a later one.")
    page.table(
        "Runs that changed something, the last first",
        [
            {
                "run on": entry.date,
                "version": entry.version,
                "complete": "yes" if entry.complete else "no",
                "what changed": "; ".join(entry.changes),
            }
            for entry in reversed(log)
        ],
    )
