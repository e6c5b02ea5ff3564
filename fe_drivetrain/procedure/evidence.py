"""Evidence of a decision: results of cases, and whether a decision may rest on them.

Results count where they are of the project's drivetrain, by its hash, as the run has left them, by
this version of the program, with all checks made and passed. What stands for a design load must
answer it, besides: a quantity of that load within a limit that the project states.
"""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, replace
from difflib import get_close_matches
from pathlib import Path
from typing import Literal

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.provenance import program_hash
from fe_drivetrain.common.reading import value_changes
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.reading import parse_drivetrain
from fe_drivetrain.procedure.answers import Answer, answer_of, quantities_of
from fe_drivetrain.procedure.project import Accepted, EvidenceLink
from fe_drivetrain.procedure.steps import Evidence
from fe_drivetrain.procedure.tolerances import is_guess, is_vacuous, why_no_limit
from fe_drivetrain.report.results import DrivetrainRecord, Figure, Results, Verdict, is_met
from fe_drivetrain.report.seal import Described, drivetrain_record, results_digest

State = Literal[
    "passed",
    "failed",
    "missing",
    "edited",
    "of another drivetrain",
    "skipped checks",
    "not converged",
    "vacuous",
    "no limit",
    "no answer",
    "beyond its limit",
    "used twice",
    "stale",
    "quick",
]


@dataclass(frozen=True)
class Claim:
    """A link, and what it stands for.

    Attributes
    ----------
    link : EvidenceLink
        As the project has it.
    loads : tuple of str
        Design loads, one of which it must answer; none of a step's own evidence.
    gap : bool
        Whether that is a load that load cases do not cover.
    """

    link: EvidenceLink
    loads: tuple[str, ...] = ()
    gap: bool = False

    @property
    def name(self) -> str:
        """Case, what of it, and for which load."""
        link = self.link
        what = link.quantity or link.check
        of = f"{link.case}: {what}" if what else link.case
        return f"{of}, for {self.loads[0]!r}" if self.gap else of


@dataclass(frozen=True)
class Subject:
    """The drivetrain of a project.

    Attributes
    ----------
    record : DrivetrainRecord
        Its title and hash.
    drivetrain : Drivetrain or None
        The drivetrain itself: in which values another one differs is said.
    """

    record: DrivetrainRecord
    drivetrain: Drivetrain | None = None


@dataclass(frozen=True)
class Found:
    """What a link leads to.

    Attributes
    ----------
    claim : Claim
        The link, and what it stands for.
    state : str
        "passed" where it counts without more words; else why it does not, in one or two words.
    why : str
        The same in a sentence; of a state that is accepted, too.
    counts : bool
        Whether a decision may rest on it.
    verdicts : tuple of Verdict
        Verdicts of the checks.
    results : Results or None
        None where there are none.
    answer : Answer or None
        The quantity against its limit, of a link that names one.
    record : DrivetrainRecord or None
        How the results call the project's drivetrain; None where they are not of it.
    """

    claim: Claim
    state: State
    why: str
    counts: bool
    verdicts: tuple[Verdict, ...] = ()
    results: Results | None = None
    answer: Answer | None = None
    record: DrivetrainRecord | None = None

    @property
    def link(self) -> EvidenceLink:
        """The link as the project has it."""
        return self.claim.link

    @property
    def worst(self) -> Verdict | None:
        """The check that failed, or the first one."""
        failed = [verdict for verdict in self.verdicts if not verdict.passed]
        return next(iter([*failed, *self.verdicts]), None)

    @property
    def date(self) -> str:
        """When the case ran; empty where it did not."""
        return self.results.environment.date if self.results else ""

    @property
    def version(self) -> str:
        """Version of the program that ran it, with the beginning of the hash of its sources."""
        if self.results is None:
            return ""
        made = self.results.environment
        return f"{made.versions.get('fe-drivetrain', '')} {made.code[:8]}".strip()

    @property
    def logged(self) -> Evidence:
        """The evidence as the log of the procedure keeps it."""
        worst, answer = self.worst, self.answer
        if answer is not None:
            return Evidence(self.link.case, answer.quantity, self.counts, answer.band or None)
        return Evidence(
            self.link.case,
            worst.quantity if worst else self.link.check or "all checks",
            self.counts,
            worst.band if worst else None,
        )


def find_evidence(
    claim: Claim, reports: Path, accept: Collection[Accepted], subject: Subject | None
) -> Found:
    """Look up what a decision rests on.

    Parameters
    ----------
    claim : Claim
        Case, what of it, and what that stands for.
    reports : Path
        Folder of results.
    accept : collection of str
        "quick", "other version": what counts all the same.
    subject : Subject or None
        The project's drivetrain; None before step 2, and then nothing counts.

    Returns
    -------
    Found
    """
    file = reports.joinpath(*claim.link.case.split("/"), "results.json")
    if not file.is_file():
        return Found(claim, "missing", f"there is no {file}: run the case", False)
    try:
        text = file.read_text("utf-8")
        results = Results.model_validate_json(text)
    except (OSError, ValueError):
        return Found(claim, "missing", f"{file} cannot be read: run the case again", False)
    found = _judged(claim, results, subject)
    if results.digest != results_digest(text):
        why = "its results.json was edited after the run, or has no digest: run it again"
        return replace(found, state="edited", why=why, counts=False)
    return _accepted(found, results, accept) if found.counts else found


def each_for_one(evidence: Iterable[Found]) -> tuple[Found, ...]:
    """The same evidence, of which one value for two gaps counts for neither.

    Parameters
    ----------
    evidence : iterable of Found
        Evidence of a step.
    """
    found = tuple(evidence)
    uses: dict[tuple[str, str], set[str]] = {}
    for one in found:
        if one.claim.gap:
            uses.setdefault((one.link.case, one.link.quantity), set()).add(one.claim.loads[0])

    def told_apart(one: Found) -> Found:
        loads = uses.get((one.link.case, one.link.quantity), set()) if one.claim.gap else set()
        if len(loads) < 2 or not one.counts:
            return one
        names = " and ".join(map(repr, sorted(loads)))
        why = f"one value is linked for {names}: it answers one of them at most"
        return replace(one, state="used twice", why=why, counts=False)

    return tuple(told_apart(one) for one in found)


def _judged(claim: Claim, results: Results, subject: Subject | None) -> Found:
    """All but how, by which version and whether as it was left: what the results themselves say."""

    def no(state: State, why: str) -> Found:
        return Found(claim, state, why, False, verdicts, results, answer, record)

    verdicts: tuple[Verdict, ...] = ()
    answer, record = None, _record_in(results, subject)
    if record is None:
        return no("of another drivetrain", _why_other(results, subject))
    verdicts = _checks_of(claim.link, results, record.hash)
    if not verdicts:
        return no("missing", _why_no_check(claim.link, results, record.hash))
    failed = [v.quantity for v in results.verdicts if not (v.passed and is_met(v))]
    if failed:
        return no("failed", f"{failed[0]!r} does not pass")
    if results.skipped:
        return no("skipped checks", f"not all of its checks were made: {results.skipped[0]}")
    if results.unsettled:
        return no("not converged", f"an answer has not converged: {results.unsettled[0]}")
    if not (claim.link.quantity or claim.loads) and all(map(_says_nothing, verdicts)):
        what = repr(verdicts[0].quantity)
        return no("vacuous", f"the tolerance of {what} is so wide that it says nothing")
    if claim.link.quantity:
        answer = answer_of(claim.link, results, record.hash)
    if why := _why_no_answer(claim, results, answer, record.hash):
        return no("no answer", why)
    if answer is not None:
        if why := why_no_limit(answer.computed, answer.unit, answer.at_most, answer.at_least):
            return no("no limit", why)
        if is_guess(claim.link.limit_from):
            source = claim.link.limit_from or "not stated"
            why = f"the source of its limit is {source!r}: name a document under limit_from"
            return no("no limit", why)
        if not answer.met:
            return no(
                "beyond its limit", f"{answer.quantity} is {answer.value}, asked: {answer.asked}"
            )
    return Found(claim, "passed", "", True, verdicts, results, answer, record)


def _accepted(found: Found, results: Results, accept: Collection[Accepted]) -> Found:
    """What is quick or of another version counts where the project accepts all that it is."""
    made, reasons = results.environment, []
    if made.code != program_hash():
        reasons.append(("other version", "of another version of the program: run it again"))
    if made.quick:
        reasons.append(("quick", "of a quick run"))
    if not reasons:
        return found
    counts = all(key in accept for key, _ in reasons)
    open_ones = [one for one in reasons if one[0] not in accept] or reasons
    state: State = "quick" if open_ones[0][0] == "quick" else "stale"
    return replace(found, state=state, why=", ".join(why for _, why in open_ones), counts=counts)


def _record_in(results: Results, subject: Subject | None) -> DrivetrainRecord | None:
    if subject is None:
        return None
    own = subject.record.hash
    return next((record for record in results.drivetrains if record.hash == own), None)


def _why_other(results: Results, subject: Subject | None) -> str:
    """Name the drivetrain of the results, and that of the project."""
    if subject is None:
        return "the project does not say of which drivetrain it is: name it under model"
    ours = f"the project is of {subject.record.title!r} ({subject.record.hash})"
    if not results.drivetrains:
        return f"its results do not say of which drivetrain they are, and {ours}"
    theirs = ", ".join(f"{one.title!r} ({one.hash})" for one in results.drivetrains)
    return f"of {theirs}, and {ours}{_changed_values(results, subject)}"


def _changed_values(results: Results, subject: Subject) -> str:
    """In which values the drivetrain of results differs from the project's."""
    own = subject.drivetrain
    if own is None or not results.scene:
        return ""
    try:
        before = parse_drivetrain(results.scene)
    except InputError:
        return "; its drivetrain is not one that this version reads"
    changes = value_changes(before.model_dump(mode="json"), own.model_dump(mode="json"))
    if not changes:
        return ""
    key, old, new = changes[0]
    more = f" and {len(changes) - 1} more" if len(changes) > 1 else ""
    return f": {key} was {old} and is {new}{more}"


def _checks_of(link: EvidenceLink, results: Results, drivetrain: str) -> tuple[Verdict, ...]:
    """The checks of the project's drivetrain, or the one that a link names."""
    own = [one for one in quantities_of(results, drivetrain) if isinstance(one, Verdict)]
    return tuple(v for v in own if link.check in ("", v.quantity))


def _why_no_check(link: EvidenceLink, results: Results, drivetrain: str) -> str:
    if not link.check:
        return f"{link.case} has no checks of this drivetrain: link a case that has"
    names = [
        v.quantity for v in _checks_of(link.model_copy(update={"check": ""}), results, drivetrain)
    ]
    close = get_close_matches(link.check, names, n=1, cutoff=0.3)
    hint = f" (did you mean {close[0]!r}?)" if close else ""
    return f"{link.case} has no check {link.check!r}{hint}: name one of its checks"


def _says_nothing(verdict: Verdict) -> bool:
    """Whether a check would pass with a value of another size."""
    if verdict.check != "equals" or not verdict.reference:
        return False
    size = 1.0 if verdict.relative else abs(verdict.reference)
    return is_vacuous(verdict.tolerance / size)


def _why_no_answer(claim: Claim, results: Results, answer: Answer | None, drivetrain: str) -> str:
    """Why a quantity does not answer what it stands for; empty where it does."""
    link = claim.link
    if answer is None and not (link.quantity or claim.loads):
        return ""
    answering = [
        f"{one.quantity!r} [{one.unit or '-'}]"
        for one in quantities_of(results, drivetrain)
        if isinstance(one, Figure) and (not claim.loads or set(claim.loads) & set(one.loads))
    ]
    loads = " or ".join(map(repr, claim.loads)) or "this step"
    known = f"of {loads} it has {', '.join(answering) or 'no value'}"
    if not link.quantity:
        return f"it names no quantity that answers {loads}: name one with its limit; {known}"
    if answer is None:
        unit = f" in {link.unit}" if link.unit else " without a unit"
        return f"its results have no quantity {link.quantity!r}{unit}: {known}"
    if claim.loads and not set(claim.loads) & set(answer.loads):
        of = ", ".join(map(repr, answer.loads)) or "no design load"
        return f"{link.quantity!r} is a value of {of}, and not of {loads}: {known}"
    return ""


def subject_of(drivetrain: Described) -> Subject:
    """The drivetrain of a project by its values.

    Parameters
    ----------
    drivetrain : Described
        A drivetrain's file, or what is made of it.
    """
    own = drivetrain if isinstance(drivetrain, Drivetrain) else None
    return Subject(drivetrain_record(drivetrain), own)
