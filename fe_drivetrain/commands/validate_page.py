"""The page of a project: how each step stands, its evidence with links, and the log of loops."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from fe_drivetrain.commands.validate_steps import STEP_SECTIONS, Standing, as_record, evidence_table
from fe_drivetrain.procedure.iteration_log import Entry, procedure_of
from fe_drivetrain.procedure.signatures import content_digest
from fe_drivetrain.procedure.steps import STEPS
from fe_drivetrain.suite.page import Page


def show_project(
    page: Page,
    standing: Standing,
    log: Sequence[Entry],
    reports: Path,
    folder: Path,
    commands: Sequence[str],
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
    commands : sequence of str
        What to type next.
    """
    page.seed = None
    states = standing.states
    _show_answer(page, standing)
    for state in states:
        page.holds(
            f"step {state.number}, {STEPS[state.number - 1]}: complete",
            state.complete,
            why="; ".join(state.lacks) or "decision, evidence and rules of the step",
            source="PROTEST 2010, section 3: each step is taken once, whatever the order",
        )
    page.verdicts += standing.measured.verdicts
    _show_states(page, standing)
    if commands:
        page.section("What to run next")
        for command in commands:
            page.text(f"`{command}`")
    for state, show in zip(states, STEP_SECTIONS, strict=True):
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
    if standing.drivetrain:
        page.data("drivetrain", standing.drivetrain.model_dump(mode="json"))
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
                "evidence": [as_record(found) for found in state.evidence],
            }
            for state in states
        ],
    )
    page.data("log", [entry.model_dump(mode="json", exclude={"steps"}) for entry in log])


def _show_answer(page: Page, standing: Standing) -> None:
    states = standing.states
    open_steps = [state for state in states if not state.complete]
    if standing.complete:
        taken = [f.state for state in states for f in state.evidence if f.state != "passed"]
        accepted = f"; the project accepts {len(taken)} of it as it is" if taken else ""
        page.answer(
            f"Complete: all six steps were taken, and all of their evidence counts{accepted}."
        )
    else:
        numbers = ", ".join(str(state.number) for state in open_steps)
        word = "step" if len(open_steps) == 1 else "steps"
        page.answer(f"Not complete: {word} {numbers} of 6.")
        for state in open_steps:
            why = "; ".join(standing.reasons(state))
            page.answer(f"Step {state.number}, {STEPS[state.number - 1]}: {why}.")
    page.found("complete steps of six", float(len(states) - len(open_steps)))
    reasons: dict[str, list[str]] = {}
    for found in (one for state in states for one in state.evidence):
        if found.state != "passed" and found.results is not None:
            how = f"that counts although {found.why}" if found.counts else "that does not count"
            which = found.link.case if found.counts else f"{found.link.case} ({found.state})"
            reasons.setdefault(how, []).append(which)
    for how, which_ones in reasons.items():
        page.note(f"Evidence {how}: {', '.join(dict.fromkeys(which_ones))}.")
    inputs = standing.project.inputs
    if inputs and inputs.waived:
        names = ", ".join(one.name for one in inputs.waived)
        page.note(f"Inputs of Table 4.7 that the project waives: {names}.")


def _show_states(page: Page, standing: Standing) -> None:
    states, of = standing.states, standing.drivetrain
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


def _show_signatures(page: Page, standing: Standing) -> None:
    """Who signed, and whether it is this that was signed; the digest, where it can be signed."""
    digest = content_digest(
        standing.project, standing.states, standing.measured.verdicts, standing.drivetrain
    )
    complete = standing.complete
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
        page.text("There is no digest to sign: not all six steps are complete.")
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
