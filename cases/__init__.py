"""Validation cases: one script each, which describes a problem, runs it and judges the answers.

A script is ``cases/GROUP/NAME.py`` with one function that `case` declares, or, where many problems
differ in a few values only, one that `cases` declares for each row of a table beside it. What the
declaration says of a case is read without importing it, so it is made of literals.
"""

import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Literal, TypeVar

_Function = TypeVar("_Function", bound=Callable[..., None])


def case(
    title: str,
    *,
    source: str,
    name: str = "",
    alone: bool | Literal["full"] = False,
    settings: Mapping[str, str] | tuple[str, ...] = (),
    changes: str = "",
) -> Callable[[_Function], _Function]:
    """Declare the function that runs the case of its file.

    Parameters
    ----------
    title : str
        One line.
    source : str
        Where the problem and its reference come from.
    name : str
        Name of the case within its group where it is not that of the script.
    alone : bool or "full"
        It measures time or memory: nothing may run beside it, and nothing it uses comes from the
        cache. "full" where no check of its quick form depends on time: that may run beside others.
    settings : mapping or tuple of str
        Keys of ``--set`` that are the case's own. The command refuses keys that no case takes. Of
        each what it is where nobody sets it, as typed, and in brackets what else it may be, as in
        ``"5 (quick 1; from 1)"``; a word in capitals where it has no value then.
    changes : str
        What other keys change: "scene", or a kind of component, as in "planet_carrier".

    Notes
    -----
    The function takes a `fe_drivetrain.report.suite.Run` and fills a
    `fe_drivetrain.report.suite.Page`. As a script the file runs its case, with the options of
    ``fe-drivetrain run``.
    """

    def declared(function: _Function) -> _Function:
        if function.__module__ == "__main__":
            group, script = Path(function.__code__.co_filename).resolve().with_suffix("").parts[-2:]
            _run([f"{group}/{name or script}", *sys.argv[1:]])
        return function

    return declared


def cases(
    table: str, *, settings: Mapping[str, str] | tuple[str, ...] = (), changes: str = ""
) -> Callable[[_Function], _Function]:
    """Declare the function that runs each case of a table.

    Parameters
    ----------
    table : str
        Name of a YAML file beside the script: by name of the case its title, its source, and what
        else the function takes of it.
    settings, changes : mapping or tuple of str, str
        As in `case`, for each of them.

    Notes
    -----
    The function takes a `fe_drivetrain.report.suite.Run`, a `fe_drivetrain.report.suite.Page`, and
    its row. As a script the file runs the cases that are named after it.
    """

    def declared(function: _Function) -> _Function:
        if function.__module__ == "__main__":
            _run(sys.argv[1:])
        return function

    return declared


def _run(arguments: list[str]) -> None:
    from fe_drivetrain.command_line import main

    main(["run", *arguments])
