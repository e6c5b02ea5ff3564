"""Verdicts as JUnit XML, which continuous-integration servers read."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING
from xml.etree import ElementTree

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path, check_writable
from fe_drivetrain.report.results import expectation, verdict_sentence

if TYPE_CHECKING:
    from fe_drivetrain.report.results import Problem, Results

# the head of what `write_junit` writes
_OURS = re.compile(rb"<\?xml [^>]*\?>\s*<testsuites name=\"fe-drivetrain\"")


def check_junit(path: Path) -> None:
    """Refuse a file that cannot be written, or that holds something else, before any work.

    Parameters
    ----------
    path : Path
        New, empty, or of an earlier run.

    Raises
    ------
    InputError
        It is something else.
    """
    check_writable(path)
    if path.exists() and path.stat().st_size and not _is_ours(path):
        raise InputError(
            f"--junit {path} exists and is no JUnit file of fe-drivetrain: name another file, or "
            "move it away"
        )


def _is_ours(path: Path) -> bool:
    try:
        with path.open("rb") as file:
            return bool(_OURS.match(file.read(200)))
    except OSError:
        return False


def _properties(results: Results) -> dict[str, str]:
    """What is to be known of results beside their checks."""
    said = {"quick": "true"} if results.environment.quick else {}
    if results.answer is not None:
        said |= {
            "question": results.answer.question,
            "verdict": verdict_sentence(results),
            "status": results.answer.status,
        }
    return said


def write_junit(
    path: Path,
    names: Sequence[str],
    results: Mapping[str, Results],
    problems: Mapping[str, Problem],
) -> None:
    """Write a test suite for each case, and in it a test for each verdict.

    A suite of a quick run has the property "quick", one with an answer its question, verdict and
    status.

    Parameters
    ----------
    path : Path
        The file; it appears whole or not at all.
    names : Sequence[str]
        Of the cases, in order.
    results, problems : Mapping[str, Results], Mapping[str, Problem]
        Of each case, one or the other.
    """
    root = ElementTree.Element("testsuites", name="fe-drivetrain")
    for name in names:
        found = results.get(name)
        suite = ElementTree.SubElement(root, "testsuite", name=name)
        if found is None:
            problem = problems[name]
            test = ElementTree.SubElement(suite, "testcase", classname=name, name="runs")
            outcome = "skipped" if problem.state == "skipped" else "error"
            ElementTree.SubElement(test, outcome, message=problem.message)
        else:
            said = _properties(found)
            if said:
                properties = ElementTree.SubElement(suite, "properties")
            for key, value in said.items():
                ElementTree.SubElement(properties, "property", name=key, value=value)
            suite.set("time", f"{sum(found.times.values()):.3f}")
            for verdict in found.verdicts:
                test = ElementTree.SubElement(
                    suite, "testcase", classname=name, name=verdict.quantity
                )
                if not verdict.passed:
                    message = f"computed {verdict.computed:.6g}, {expectation(verdict)}"
                    failure = ElementTree.SubElement(test, "failure", message=message)
                    failure.text = f"{verdict.reason}\n{verdict.source}"
        for kind, tag in (("failures", "failure"), ("errors", "error"), ("skipped", "skipped")):
            suite.set(kind, str(len(suite.findall(f"testcase/{tag}"))))
        suite.set("tests", str(len(suite.findall("testcase"))))
    ElementTree.indent(root)
    with atomic_path(path) as unfinished:
        ElementTree.ElementTree(root).write(unfinished, encoding="utf-8", xml_declaration=True)
