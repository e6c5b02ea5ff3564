"""The page of a project: how each step stands, its evidence with links, and the log of loops."""

from __future__ import annotations

from collections.abc import Sequence

from fe_drivetrain.pages.validate_steps import STEP_SECTIONS, evidence_table
from fe_drivetrain.procedure.iteration_log import Entry, procedure_of
from fe_drivetrain.procedure.steps import STEPS
from fe_drivetrain.report.suite.page import Page
from fe_drivetrain.report.suite.run import Run
from fe_drivetrain.studies.project_validation import ValidateResult


def show_validate(run: Run, page: Page, result: ValidateResult) -> None:
    """Show how the six steps of a project stand, their evidence with links, and the log.

    Parameters
    ----------
    run : Run
        Its folder is where links begin.
    page : Page
        Takes a section for each step.
    result : ValidateResult
        How it stands.
    """
    states = result.states
    _show_states(page, result)
    if result.commands:
        page.section("What to run next")
        for command in result.commands:
            page.text(f"`{command}`")
    for state, show in zip(states, STEP_SECTIONS, strict=True):
        page.section(f"Step {state.number}: {STEPS[state.number - 1]}")
        if not state.begun:
            page.text("Not begun.")
            continue
        page.text(f"Decision: {state.decision}")
        show(page, result)
        if state.evidence:
            page.add(evidence_table(state.evidence, result.reports, run.folder))
        if state.lacks:
            page.table("What it lacks", [[text] for text in state.lacks], ["step is not complete"])
    _show_signatures(page, result)
    _show_log(page, result.project.subject, result.log)
    page.data("log", [entry.model_dump(mode="json", exclude={"steps"}) for entry in result.log])


def _show_states(page: Page, result: ValidateResult) -> None:
    states, of = result.states, result.drivetrain
    page.section("Where it stands")
    if of is not None:
        page.text(f"The project is of the {of.kind} {of.title!r}, hash {of.hash}.")
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
    page.add(result.chart())


def _show_signatures(page: Page, result: ValidateResult) -> None:
    """Who signed, and whether it is this that was signed; the digest, where it can be signed."""
    signed, digest = result.project.signed, result.digest
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
                    "holds": "yes" if result.holds(one) else "no",
                }
                for one in signed
            ],
        )
    if not result.complete:
        page.text("There is no digest to sign: not all six steps are complete.")
    elif not any(result.holds(one) for one in signed):
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
