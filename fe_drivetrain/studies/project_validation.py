"""How a project of six steps stands: what each lacks, its evidence, comparisons, signatures."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from itertools import chain
from pathlib import Path
from typing import ClassVar

from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
from fe_drivetrain.procedure.assessment import Measured, StepState, assessed, claims_of
from fe_drivetrain.procedure.channels import missing_file
from fe_drivetrain.procedure.evidence import (
    Claim,
    Subject,
    each_for_one,
    find_evidence,
    subject_of,
)
from fe_drivetrain.procedure.evidence import Found as FoundEvidence
from fe_drivetrain.procedure.failure_modes import Catalogue, protest_catalogue, read_catalogue
from fe_drivetrain.procedure.identified_shaft import Outcome
from fe_drivetrain.procedure.iteration_log import Entry
from fe_drivetrain.procedure.measured_channels import (
    captured,
    compared,
    faults_of_files,
    windows_by_wind,
)
from fe_drivetrain.procedure.project import Project, Signature
from fe_drivetrain.procedure.signatures import content_digest
from fe_drivetrain.procedure.steps import STEPS
from fe_drivetrain.report.charts import bars
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.results import Chart, DrivetrainRecord, expectation
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.result import Result
from fe_drivetrain.turbine_loads.histories.windows import CaptureMatrix

_NAMED = re.compile(r"('[^']+')( .*)", re.DOTALL)


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ValidateResult(Result):
    """The six steps of a project.

    Attributes
    ----------
    project : Project
        As read.
    catalogue : Catalogue
        Its design loads.
    states : tuple[StepState, ...]
        The six steps: decision, evidence, and what each lacks, in sentences.
    measured : Measured
        Comparisons with measured channels, and windows and spreads that they gave.
    matrix : CaptureMatrix or None
        Capture matrix of its campaign.
    drivetrain : DrivetrainRecord or None
        What it is of; None before step 2.
    digest : str
        What a signature is for, 16 hexadecimal digits; empty where a step is not complete.
    reports : Path
        Folder of the evidence.
    log : tuple[Entry, ...]
        Runs that changed something, this one included, where a log is kept; else empty.
    commands : tuple[str, ...]
        What to type next, where the command line says so; else empty.
    """

    STUDY: ClassVar[str] = "validate"

    project: Project
    catalogue: Catalogue = field(repr=False)
    states: tuple[StepState, ...]
    measured: Measured
    matrix: CaptureMatrix | None = field(repr=False)
    drivetrain: DrivetrainRecord | None
    digest: str
    reports: Path
    log: tuple[Entry, ...] = ()
    commands: tuple[str, ...] = ()

    @property
    def complete(self) -> bool:
        """Whether all six steps are complete."""
        return _is_complete(self.states)

    def holds(self, signature: Signature) -> bool:
        """Whether it is this that was signed, and complete."""
        return bool(self.digest) and signature.digest == self.digest

    def chart(self) -> Chart:
        """Evidence of each step: how much of it counts."""
        groups: dict[str, dict[str, float]] = {"counts": {}, "does not count": {}}
        for state in reversed(self.states):
            label = f"{state.number} {STEPS[state.number - 1]}"
            counting = sum(found.counts for found in state.evidence)
            groups["counts"][label] = float(counting)
            groups["does not count"][label] = float(len(state.evidence) - counting)
        return bars("Evidence of the six steps", groups, "results", stacked=True)


def validate(project: Project, folder: Path, *, report: Progress = silent) -> ValidateResult:
    """Find how a project stands, by the files that it names.

    Parameters
    ----------
    project : Project
        See `fe_drivetrain.procedure.read_project`.
    folder : Path
        What names of files, and the project's folder of reports, are relative to: that of the
        project file.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        A file that the project names is faulty, or it names a system or drivetrain that
        does not exist.
    """
    found, steps = Findings(), Steps(report)
    found.seed = None
    catalogue = (
        read_catalogue(folder / project.catalogue) if project.catalogue else protest_catalogue()
    )
    drivetrain = _drivetrain(project, folder)
    subject = None if drivetrain is None else subject_of(drivetrain)
    record = subject.record if subject else None
    with steps.step("evidence"):
        evidence = _evidence(project, folder, subject)
    with steps.step("measured channels"):
        measured, matrix = _measured(project, folder, record)
    states = assessed(project, catalogue, evidence, measured)
    complete = _is_complete(states)
    digest = content_digest(project, states, measured.verdicts, record) if complete else ""
    if record is not None:
        found.drivetrains.append(record)
    _explain(found, project, states)
    _answer(found, project, states, measured, digest)
    _judge(found, project, states, measured, digest)
    _data(found, project, states, record, digest)
    if measured.methods:
        found.data("identification", identification_rows(measured))
    return ValidateResult(
        project=project,
        catalogue=catalogue,
        states=states,
        measured=measured,
        matrix=matrix,
        drivetrain=record,
        digest=digest,
        reports=(folder / project.reports).resolve(),
        **found.frozen(steps.times, subject=project.subject),
    )


def reasons(state: StepState) -> list[str]:
    """Why a step is open, in sentences; what lacks the same in one, what was not run at the end.

    Parameters
    ----------
    state : StepState
        One of the six.
    """
    absent = [one for one in state.evidence if one.results is None]
    same: dict[str, list[FoundEvidence]] = {}
    for one in state.evidence:
        if one.results is not None and not one.counts:
            same.setdefault(one.why, []).append(one)
    said = {f"{one.claim.name}: {one.why}" for one in (*absent, *chain(*same.values()))}
    found = _together(text for text in state.lacks if text not in said)
    found += [f"{', '.join(one.claim.name for one in of)}: {why}" for why, of in same.items()]
    if absent:
        names = ", ".join(dict.fromkeys(one.link.case for one in absent))
        found.append(f"its evidence is not there: run {names}")
    return found


def _together(sentences: Iterable[str]) -> list[str]:
    """Sentences that begin with a name in quotes, those that go on in the same way in one."""
    names: dict[str, list[str]] = {}
    for text in sentences:
        named = _NAMED.match(text)
        name, rest = named.groups() if named else ("", text)
        names.setdefault(rest, []).append(name)
    return [
        f"{', '.join(of)}: each{rest}" if len(of) > 1 else f"{of[0]}{rest}"
        for rest, of in names.items()
    ]


def as_record(found: FoundEvidence) -> Record:
    """Evidence in words and numbers: what was shown of it, what was asked, whether it counts.

    Parameters
    ----------
    found : Found
        Evidence of a link.
    """
    worst = found.worst
    checks, unit, band = "none", "", None
    if worst is not None:
        passed = sum(verdict.passed for verdict in found.verdicts)
        checks, unit, band = f"{passed} of {len(found.verdicts)} pass", worst.unit, worst.band
    value = "" if worst is None else f"{formatted(worst.computed)} {unit}".strip()
    if (answer := found.answer) is not None:
        value, unit, band = answer.value, answer.unit, answer.band or None
    return {
        "case": found.link.case,
        "state": found.state if found.counts else f"{found.state}, does not count",
        "counts": "yes" if found.counts else "no",
        "checks": checks,
        "stands for": ", ".join(found.claim.loads) or "the step",
        "quantity": answer.quantity if answer else worst.quantity if worst else found.link.check,
        "computed": value,
        "asked": answer.asked if answer else expectation(worst) if worst else "",
        "limit from": found.link.limit_from,
        "band": "none" if band is None else f"± {formatted(band)} {unit}".strip(),
        "run": f"{found.date}, {found.version}" if found.date else "",
        "why": found.why,
    }


def identification_rows(measured: Measured) -> list[Record]:
    """What each method of identification finds of a record, as records.

    Parameters
    ----------
    measured : Measured
        What channels gave.
    """
    return [
        {
            "torque": channel,
            "method": one.method,
            "inertia [kg m^2]": one.inertia,
            "damping [N m s/rad]": one.damping,
            "stiffness [N m/rad]": one.stiffness,
            "what else": one.words,
        }
        for channel, answers in measured.methods.items()
        for one in answers
    ]


def _is_complete(states: Sequence[StepState]) -> bool:
    return all(state.complete for state in states)


def _drivetrain(project: Project, folder: Path) -> Drivetrain | None:
    """The drivetrain that the model is of; None before step 2."""
    if project.model is None:
        return None
    name = project.model.drivetrain
    file = folder / name
    return read_drivetrain(str(file) if file.is_file() else name)


def _evidence(
    project: Project, folder: Path, subject: Subject | None
) -> Mapping[Claim, FoundEvidence]:
    """What the results say that each claim of the project rests on."""
    return {
        found.claim: found
        for claims in claims_of(project)
        for found in each_for_one(
            find_evidence(claim, folder / project.reports, project.accept, subject)
            for claim in claims
        )
    }


def _measured(
    project: Project, folder: Path, record: DrivetrainRecord | None
) -> tuple[Measured, CaptureMatrix | None]:
    """What the files of channels give, of those that are there, and the capture matrix."""
    capture = project.campaign.capture if project.campaign else None
    absent = {5: missing_file(capture.files if capture else None, folder)}
    if comparison := project.comparison:
        files = (comparison.measured, comparison.computed)
        absent[6] = next(filter(None, (missing_file(one, folder) for one in files)), "")
    missing = {step: sentence for step, sentence in absent.items() if sentence}
    matrix = captured(capture, folder) if capture and 5 not in missing else None
    outcome = Outcome()
    faults: tuple[str, ...] = ()
    if comparison and 6 not in missing:
        outcome = compared(comparison, folder)
        faults = faults_of_files(capture, comparison, record.hash if record else "", folder)
    measured = Measured(
        windows_by_wind(matrix) if matrix else None,
        outcome.verdicts,
        missing,
        faults,
        outcome.spreads,
        outcome.methods,
    )
    return measured, matrix


def _answer(
    found: Findings,
    project: Project,
    states: Sequence[StepState],
    measured: Measured,
    digest: str,
) -> None:
    """State whether it is complete, or which steps are open."""
    open_steps = [state for state in states if not state.complete]
    evidence = [one for state in states for one in state.evidence]
    counting, absent = sum(one.counts for one in evidence), [e for e in evidence if not e.results]
    taken = sum(one.state != "passed" for one in evidence)
    if open_steps:
        numbers = ", ".join(str(state.number) for state in open_steps)
        word = "step {} of 6 is" if len(open_steps) == 1 else "steps {} of 6 are"
        verdict = f"Not complete: {word.format(numbers)} open, and {counting} of {len(evidence)} "
        verdict += "results that it rests on count."
    else:
        accepted = f", {taken} of them accepted as they are" if taken else ""
        verdict = f"Complete: all 6 steps were taken, and all {len(evidence)} results that they "
        verdict += f"rest on count{accepted}{_other_signatures(project, digest)}."
    figures = [
        found.value("complete steps", len(states) - len(open_steps), at_least=len(states)),
        found.value("results that count", counting, at_least=len(evidence)),
        found.value("results that are not there yet", len(absent), at_most=0),
    ]
    if measured.verdicts:
        agree = sum(one.passed for one in measured.verdicts)
        name = "comparisons with measurements that agree"
        figures.append(found.value(name, agree, at_least=len(measured.verdicts)))
    if project.signed:
        hold = sum(bool(digest) and one.digest == digest for one in project.signed)
        figures.append(found.value("signatures that hold", hold, at_least=len(project.signed)))
    found.answer(f"Is the validation of {project.subject} complete?", verdict, figures)


def _other_signatures(project: Project, digest: str) -> str:
    """How many signatures are of something else, as the end of a sentence; empty without any."""
    others = sum(one.digest != digest for one in project.signed)
    return f", but {others} of {len(project.signed)} signatures hold no more" if others else ""


def _explain(found: Findings, project: Project, states: Sequence[StepState]) -> None:
    """Say why steps are open, and what counts in spite of something."""
    open_steps = [state for state in states if not state.complete]
    for state in open_steps:
        why = "; ".join(reasons(state))
        found.say(f"Step {state.number}, {STEPS[state.number - 1]}: {why}.")
    found.found("complete steps of six", float(len(states) - len(open_steps)))
    hows: dict[str, list[str]] = {}
    for one in (one for state in states for one in state.evidence):
        if one.state != "passed" and one.results is not None:
            how = f"that counts although {one.why}" if one.counts else "that does not count"
            which = one.link.case if one.counts else f"{one.link.case} ({one.state})"
            hows.setdefault(how, []).append(which)
    for how, which_ones in hows.items():
        found.note(f"Evidence {how}: {', '.join(dict.fromkeys(which_ones))}.")
    inputs = project.inputs
    if inputs and inputs.waived:
        names = ", ".join(one.name for one in inputs.waived)
        found.note(f"Inputs of Table 4.7 that the project waives: {names}.")


def _judge(
    found: Findings,
    project: Project,
    states: Sequence[StepState],
    measured: Measured,
    digest: str,
) -> None:
    """Check that each step is complete, the comparisons, and what each signature is for."""
    for state in states:
        found.holds(
            f"step {state.number}, {STEPS[state.number - 1]}: complete",
            state.complete,
            why="; ".join(state.lacks) or "decision, evidence and rules of the step",
            source="PROTEST 2010, section 3: each step is taken once, whatever the order",
        )
    found.checks += measured.verdicts
    for one in project.signed:
        found.holds(
            f"signature of {one.name}: of these six steps, complete",
            bool(digest) and one.digest == digest,
            why="decisions, evidence or comparisons have changed, or a step is not complete: sign "
            "again",
            source="digest of decisions, evidence and comparisons",
        )


def _data(
    found: Findings,
    project: Project,
    states: Sequence[StepState],
    record: DrivetrainRecord | None,
    digest: str,
) -> None:
    """Keep the standing for other programs."""
    if digest:
        found.data("digest", digest)
    if record:
        found.data("drivetrain", record.model_dump(mode="json"))
    found.data("project", project.model_dump(mode="json"))
    found.data(
        "steps",
        [
            {
                "step": state.number,
                "name": STEPS[state.number - 1],
                "begun": state.begun,
                "complete": state.complete,
                "lacks": state.lacks,
                "evidence": [as_record(one) for one in state.evidence],
            }
            for state in states
        ],
    )
