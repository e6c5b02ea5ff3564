"""What a signature under a project is for: a digest of its six steps and of what they rest on.

A signature states the digest of what was signed. Where decisions, evidence or comparisons have
changed since, the digest is another, and the signature no longer holds.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence

from fe_drivetrain.procedure.assessment import StepState
from fe_drivetrain.procedure.project import Project
from fe_drivetrain.report.results import DrivetrainRecord, Verdict

_DIGITS = 16


def content_digest(
    project: Project,
    states: Sequence[StepState],
    verdicts: Sequence[Verdict],
    drivetrain: DrivetrainRecord | None,
) -> str:
    """Digest of all that is signed: decisions, drivetrain, evidence with its values, comparisons.

    Parameters
    ----------
    project : Project
        As read; its signatures are no part of it.
    states : sequence of StepState
        Its six steps.
    verdicts : sequence of Verdict
        Measured against computed.
    drivetrain : DrivetrainRecord or None
        What the project is of, by the hash of its values.

    Returns
    -------
    str
        16 hexadecimal digits. A case that was run again with the same result leaves it as it is.
    """
    content = {
        "project": project.model_dump(mode="json", exclude={"signed"}),
        "drivetrain": drivetrain.hash if drivetrain else "",
        "evidence": [
            [found.link.model_dump(), found.state, found.counts, found.version]
            + [f"{found.answer.value}, {found.answer.asked}" if found.answer else ""]
            + [v.model_dump(mode="json") for v in found.verdicts]
            for state in states
            for found in state.evidence
        ],
        "comparisons": [verdict.model_dump(mode="json") for verdict in verdicts],
    }
    text = json.dumps(content, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()[:_DIGITS]
