"""Names that a shell completes: of cases and their groups, and of library scenes."""

from __future__ import annotations


def complete_case(incomplete: str) -> list[str]:
    """Groups and names of cases that begin with what was typed.

    Parameters
    ----------
    incomplete : str
        What was typed so far.

    Returns
    -------
    list of str
    """
    from fe_drivetrain.report.suite.case import all_cases

    names = list(all_cases())
    known = [*dict.fromkeys(name.partition("/")[0] for name in names), *names]
    return [name for name in known if name.startswith(incomplete)]


def complete_scene(incomplete: str) -> list[str]:
    """Names of library scenes that begin with what was typed, and scene files beside it.

    Parameters
    ----------
    incomplete : str
        What was typed so far.

    Returns
    -------
    list of str
    """
    from pathlib import Path

    from fe_drivetrain.drivetrain_file.reading import library_names

    files = [str(path) for end in ("yaml", "yml") for path in Path().glob(f"{incomplete}*.{end}")]
    return [*(name for name in library_names() if name.startswith(incomplete)), *sorted(files)]
