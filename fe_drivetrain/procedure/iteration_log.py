"""The log of a project: each run of ``validate`` adds what has changed since the run before.

It lies beside the project file, a line of JSON for each run, so that it can be kept with it; a run
in which nothing has changed adds nothing.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ConfigDict, ValidationError

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.common.reading import value_changes, why_unreadable
from fe_drivetrain.common.regular_files import text_of
from fe_drivetrain.procedure.assessment import StepState
from fe_drivetrain.procedure.project import SECTIONS, Project
from fe_drivetrain.procedure.steps import STEPS, Evidence, Procedure, Visit

_SHOWN = 60  # characters of a value in a sentence


class _Line(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class LoggedEvidence(_Line):
    """Evidence as it was."""

    case: str
    quantity: str
    state: str
    counts: bool
    band: float | None
    date: str
    version: str


class LoggedStep(_Line):
    """A step as it was; `content` is its section of the project."""

    content: dict[str, Any] | None
    complete: bool
    evidence: tuple[LoggedEvidence, ...]


class Entry(_Line):
    """One run: when, by which version, what had changed, and how everything stood."""

    date: str
    version: str
    changes: tuple[str, ...]
    visited: tuple[int, ...]
    complete: bool
    steps: tuple[LoggedStep, ...]


def log_file(project: Path) -> Path:
    """Where the log of a project file lies.

    Parameters
    ----------
    project : Path
        As in mine.yaml, of which it is mine.log.jsonl.
    """
    return project.with_name(f"{project.stem}.log.jsonl")


def read_log(path: Path) -> tuple[Entry, ...]:
    """All runs so far; none where there is no log.

    Parameters
    ----------
    path : Path
        Path from `log_file`.

    Raises
    ------
    InputError
        The log cannot be read.
    """
    if not path.exists():
        return ()
    entries = []
    try:
        lines = text_of(path).splitlines()
    except (OSError, ValueError) as error:
        raise InputError(
            f"cannot read the log {path}: {why_unreadable(error)}, or restore or move the log"
        ) from error
    for number, line in enumerate(lines, start=1):
        try:
            entries.append(Entry.model_validate_json(line))
        except ValidationError as error:
            raise InputError(
                f"line {number} of the log {path} is no run: restore the log, or move it away"
            ) from error
    return tuple(entries)


def next_entry(
    before: Sequence[Entry],
    project: Project,
    states: Sequence[StepState],
    date: str,
    version: str,
) -> Entry | None:
    """What this run adds; None where nothing has changed.

    Parameters
    ----------
    before : sequence of Entry
        The log so far.
    project : Project
        As it is now.
    states : sequence of StepState
        Its six steps.
    date, version : str
        Date and version of this run.

    Returns
    -------
    Entry or None
    """
    now = tuple(_logged(project, state) for state in states)
    nothing = LoggedStep(content=None, complete=False, evidence=())
    old = before[-1].steps if before else (nothing,) * len(STEPS)
    changes, visited = [], []
    for number, (was, is_) in enumerate(zip(old, now, strict=True), start=1):
        decided = _of_content(was, is_)
        found = [*decided, *_of_evidence(was, is_)]
        if was.complete != is_.complete:
            found.append("complete" if is_.complete else "no longer complete")
        changes += [f"step {number}: {text}" for text in found]
        if decided and is_.content is not None:
            visited.append(number)
    if not changes:
        return None
    return Entry(
        date=date,
        version=version,
        changes=tuple(changes),
        visited=tuple(visited),
        complete=all(step.complete for step in now),
        steps=now,
    )


def write_log(path: Path, entries: Sequence[Entry]) -> None:
    """Write the log, which appears whole.

    Parameters
    ----------
    path : Path
        Path from `log_file`.
    entries : sequence of Entry
        All runs.
    """
    with atomic_path(path) as hidden:
        hidden.write_text("".join(f"{one.model_dump_json()}\n" for one in entries), "utf-8")


def procedure_of(subject: str, entries: Sequence[Entry]) -> Procedure:
    """The visits that a log tells, in their order, the last of each step with today's evidence.

    A step is taken again where its section has changed; evidence alone that was run again, or has
    become stale, is no loop.

    Parameters
    ----------
    subject : str
        Subject of the project.
    entries : sequence of Entry
        The log.
    """
    taken = [(entry, number) for entry in entries for number in entry.visited]
    last = {number: place for place, (_, number) in enumerate(taken)}
    found = Procedure(subject)
    for place, (entry, number) in enumerate(taken):
        content = entry.steps[number - 1].content
        assert content is not None
        of = entries[-1] if place == last[number] else entry
        evidence = tuple(
            Evidence(e.case, e.quantity, e.counts, e.band) for e in of.steps[number - 1].evidence
        )
        found = found.after(Visit(number, str(content["decision"]), evidence))
    return found


def _logged(project: Project, state: StepState) -> LoggedStep:
    section = getattr(project, SECTIONS[state.number - 1])
    return LoggedStep(
        content=None if section is None else section.model_dump(mode="json"),
        complete=state.complete,
        evidence=tuple(
            LoggedEvidence(
                case=one.link.case,
                quantity=one.logged.quantity,
                state=one.state,
                counts=one.counts,
                band=one.logged.band,
                date=one.date,
                version=one.version,
            )
            for one in state.evidence
        ),
    )


def _of_content(was: LoggedStep, is_: LoggedStep) -> list[str]:
    if was.content is None or is_.content is None:
        if was.content is is_.content:
            return []
        return ["begun" if was.content is None else "taken out"]
    return [
        f"{key}: {_short(old)} -> {_short(new)}"
        for key, old, new in value_changes(was.content, is_.content)
    ]


def _of_evidence(was: LoggedStep, is_: LoggedStep) -> list[str]:
    old = {(one.case, one.quantity): one for one in was.evidence}
    found = []
    for one in is_.evidence:
        before = old.get((one.case, one.quantity))
        if before is None or before.state != one.state:
            earlier = f"{before.state} -> " if before else ""
            found.append(f"{one.case}: {earlier}{one.state}")
        elif before.date != one.date:
            found.append(f"{one.case}: run again on {one.date}")
    return found


def _short(value: Any) -> str:
    text = "none" if value is None else str(value)
    return text if len(text) <= _SHOWN else f"{text[: _SHOWN - 3]}..."
