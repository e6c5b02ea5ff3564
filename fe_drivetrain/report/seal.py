"""What results are of, and whether they are as a run has left them: two hashes in results.json.

A drivetrain is known by the hash of all values that describe it, so that a page that is of another
one can be told from its numbers alone. The digest of the results tells a file that was edited; it
guards against mistakes, and against nobody who computes it again.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from typing import Any, Protocol

from fe_drivetrain.report.results import DrivetrainRecord, Results

_WORDS = frozenset({"title", "source", "sources", "assumed"})
"""Keys of a description that are words about it: they change no result."""

_DIGITS = 16


class Described(Protocol):
    """A drivetrain's file, or what is made of it: a machine, or a gear table."""

    @property
    def title(self) -> str:
        """What it is."""

    def model_dump(self, *, mode: str) -> dict[str, Any]:
        """All of its values, defaults included, as plain data."""


def drivetrain_hash(drivetrain: Described) -> str:
    """Hash of all values that describe a drivetrain, defaults included, titles and sources not.

    Parameters
    ----------
    drivetrain : Described
        A drivetrain's file or what is made of it, with all changes made.

    Returns
    -------
    str
        16 hexadecimal digits of SHA-256.
    """
    values = drivetrain.model_dump(mode="json")
    kind = type(drivetrain).__name__.lower()
    stated = {k: v for k, v in values.items() if k not in _WORDS}
    return content_hash({"kind": kind, **stated})[:_DIGITS]


def drivetrain_record(drivetrain: Described, name: str = "") -> DrivetrainRecord:
    """The record by which results state a drivetrain.

    Parameters
    ----------
    drivetrain : Described
        With all changes made.
    name : str
        By which the results call it.
    """
    return DrivetrainRecord(
        kind=type(drivetrain).__name__.lower(),
        name=name,
        title=drivetrain.title,
        hash=drivetrain_hash(drivetrain),
    )


def sealed(results: Results) -> Results:
    """The same results with their digest.

    Parameters
    ----------
    results : Results
        Complete.
    """
    return results.model_copy(update={"digest": results_digest(results.model_dump_json())})


def results_digest(text: str) -> str:
    """Digest of results as a file has them: of all values, but the digest itself.

    Parameters
    ----------
    text : str
        Of results.json, in any layout.

    Returns
    -------
    str
        64 hexadecimal digits.
    """
    content = json.loads(text)
    return content_hash({key: value for key, value in content.items() if key != "digest"})


def content_hash(content: Mapping[str, Any]) -> str:
    """SHA-256 of plain data, whatever the order of its keys."""
    return hashlib.sha256(json.dumps(content, sort_keys=True).encode()).hexdigest()
