"""Which cases of a run that was stopped are done: their results would be the same again."""

from __future__ import annotations

import json
import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.manifest import read_manifest
from fe_drivetrain.report.suite.case import Case
from fe_drivetrain.report.suite.result_folders import result_folder
from fe_drivetrain.report.suite.settings import settings_by_case

if TYPE_CHECKING:
    from fe_drivetrain.report.results import Environment

_log = logging.getLogger(__name__)

#: Settings that name files, whose content may have changed since.
_FILES = ("scene", "loads")


def finished_cases(
    cases: Sequence[Case],
    out: Path,
    settings: Mapping[str, Any] | None = None,
    quick: bool = False,
) -> list[str]:
    """Cases whose results were made by the same program with the same settings in the same mode.

    A case that was given a file of the user's is never among them, nor one of whose files any has
    changed since it was written.

    Parameters
    ----------
    cases : sequence of Case
        Of the run.
    out : Path
        The folder above their result folders.
    settings : mapping, optional
        Of the run.
    quick : bool
        Whether the run is coarser and smaller.

    Returns
    -------
    list of str
        Their names, in order.
    """
    from fe_drivetrain.report.environment import environment
    from fe_drivetrain.report.results import read_results

    taken = settings_by_case(cases, settings or {})
    found = []
    for case in cases:
        folder = result_folder(out, case)
        own = taken[case.name]
        if any(key in own for key in _FILES) or not _as_written(case, folder):
            continue
        try:
            before = read_results(folder / "results.json").environment
        except (OSError, ValueError):
            continue  # not there, or of another version
        if _same(before, environment(own, quick=quick)):
            found.append(case.name)
    return found


def _as_written(case: Case, folder: Path) -> bool:
    """Whether all that the run wrote is there, with the content that it was written with."""
    try:
        listed = read_manifest(folder)
    except InputError as error:
        _log.info("results of %s are made again: %s", case.name, error)
        return False
    if listed is None:
        return False
    changed = [name for name in listed.files if not listed.has(name, folder / name)]
    if changed:
        _log.info("results of %s are made again: %s", case.name, f"{changed[0]} has changed")
    return not changed


def _same(before: Environment, now: Environment) -> bool:
    """Whether a run would find the same."""
    depends = {"python", "platform", "versions", "settings", "quick", "code"}
    # as it was written: a tuple, say, is a list there
    one, other = (json.loads(e.model_dump_json(include=depends)) for e in (before, now))
    return bool(one == other) and bool(before.code)
