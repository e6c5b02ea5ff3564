"""Evidence of a decision: results of cases, with verdict, band, date, version; what is stale.

Results are those of a folder of reports. They are stale where the program has changed since, or
where they are of another scene than the project's.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass
from difflib import get_close_matches
from pathlib import Path
from typing import Literal

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.made_by import program_hash
from fe_drivetrain.common.reading import value_changes
from fe_drivetrain.procedure.project import Accepted, EvidenceLink
from fe_drivetrain.procedure.steps import Evidence
from fe_drivetrain.report.results import Results, Verdict, read_results
from fe_drivetrain.scene.reading import parse_scene
from fe_drivetrain.scene.scene import Scene

OF_SCENES = ("check", "study", "advise", "uncertainty")
"""Commands whose results are of a scene that the user names."""

State = Literal["passed", "failed", "missing", "stale", "quick"]


@dataclass(frozen=True)
class Found:
    """What a link leads to.

    Attributes
    ----------
    link : EvidenceLink
        As the project has it.
    state : str
        "passed" and "failed" are verdicts; "missing" has no results; "stale" and "quick" would have
        passed, but are of another version or scene, or of a quick run.
    why : str
        Of a state that is not "passed", in words; of one that is accepted, too.
    counts : bool
        Whether a decision may rest on it.
    verdicts : tuple of Verdict
        Of the checks.
    results : Results or None
        None where there are none.
    """

    link: EvidenceLink
    state: State
    why: str
    counts: bool
    verdicts: tuple[Verdict, ...] = ()
    results: Results | None = None

    @property
    def name(self) -> str:
        """Case, and check where one is named."""
        return f"{self.link.case}: {self.link.check}" if self.link.check else self.link.case

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
        """Of the program that ran it, with the beginning of the hash of its sources."""
        if self.results is None:
            return ""
        made = self.results.environment
        return f"{made.versions.get('fe-drivetrain', '')} {made.code[:8]}".strip()

    @property
    def logged(self) -> Evidence:
        """As the log of the procedure keeps it."""
        worst = self.worst
        return Evidence(
            self.link.case,
            worst.quantity if worst else self.link.check or "all checks",
            self.counts,
            worst.band if worst else None,
        )


def find_evidence(
    link: EvidenceLink, reports: Path, accept: Collection[Accepted], scene: Scene | None = None
) -> Found:
    """Look up what a decision rests on.

    Parameters
    ----------
    link : EvidenceLink
        Case and check.
    reports : Path
        Folder of results.
    accept : collection of str
        "quick", "other version": what counts all the same.
    scene : Scene, optional
        The project's, for results that state a scene of their own.

    Returns
    -------
    Found
    """
    file = reports.joinpath(*link.case.split("/"), "results.json")
    if not file.is_file():
        return Found(link, "missing", f"there is no {file}: run the case", False)
    try:
        results = read_results(file)
    except (OSError, ValueError):
        return Found(link, "missing", f"{file} cannot be read: run the case again", False)
    verdicts = tuple(v for v in results.verdicts if link.check in ("", v.quantity))
    if not verdicts and link.check:
        names = [v.quantity for v in results.verdicts]
        close = get_close_matches(link.check, names, n=1, cutoff=0.3)
        hint = f" (did you mean {close[0]!r}?)" if close else ""
        why = f"{link.case} has no check {link.check!r}{hint}: name one of its checks"
        return Found(link, "missing", why, False, (), results)
    if not verdicts:
        why = f"{link.case} has no checks: link a case that has"
        return Found(link, "missing", why, False, (), results)
    failed = [v.quantity for v in verdicts if not v.passed]
    if failed:
        why = f"{failed[0]!r} does not pass"
        return Found(link, "failed", why, False, verdicts, results)
    scenes = _other_scene(results, scene)
    if scenes:
        return Found(link, "stale", scenes, False, verdicts, results)
    made = results.environment
    if made.code != program_hash():
        why = "of another version of the program: run it again"
        return Found(link, "stale", why, "other version" in accept, verdicts, results)
    if made.quick:
        why = "of a quick run"
        return Found(link, "quick", why, "quick" in accept, verdicts, results)
    return Found(link, "passed", "", True, verdicts, results)


def _other_scene(results: Results, scene: Scene | None) -> str:
    """In which values results of a scene differ from the project's; empty where they do not."""
    if scene is None or not results.scene or results.case.split("/")[0] not in OF_SCENES:
        return ""
    try:
        before = parse_scene(results.scene)
    except InputError:
        return "its scene is not one that this version reads: run it again"
    changes = value_changes(before.model_dump(mode="json"), scene.model_dump(mode="json"))
    if not changes:
        return ""
    key, old, new = changes[0]
    more = f" and {len(changes) - 1} more" if len(changes) > 1 else ""
    return f"of another scene: {key} was {old} and is {new}{more}: run it again"
