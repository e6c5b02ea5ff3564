"""The program ``fe-drivetrain``: its commands, and the same options for the script of a case.

Exit status: 0 if every check passes, 1 if one fails, 2 for wrong input, 130 when stopped by Ctrl-C.
Nothing heavy is imported before a command does its work, so that help is quick.
"""

from __future__ import annotations

import shlex
import sys
from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import TYPE_CHECKING, Annotated, Any

import typer
from typer.main import get_command

from fe_drivetrain.command_line.compare_runs import compare_runs_command
from fe_drivetrain.command_line.designs import compare_command
from fe_drivetrain.command_line.examples import examples_text, unfolded
from fe_drivetrain.command_line.export import export_command
from fe_drivetrain.command_line.gears import gears_command
from fe_drivetrain.command_line.history import history_command
from fe_drivetrain.command_line.life import life_command
from fe_drivetrain.command_line.loads import loads_command
from fe_drivetrain.command_line.modes import modes_command
from fe_drivetrain.command_line.new_scene import new_command
from fe_drivetrain.command_line.output_options import LOOK, with_shared_options
from fe_drivetrain.command_line.part import part_command
from fe_drivetrain.command_line.report import report_command
from fe_drivetrain.command_line.run import (
    HelpOfCases,
    OutFolder,
    Quick,
    list_command,
    run_and_print,
    run_command,
)
from fe_drivetrain.command_line.settings import CaseSettings
from fe_drivetrain.command_line.strength import strength_command
from fe_drivetrain.command_line.studies import advise_command, check_command
from fe_drivetrain.command_line.study import study_command
from fe_drivetrain.command_line.terminal import ended, prepare_streams, write
from fe_drivetrain.command_line.transient import transient_command
from fe_drivetrain.command_line.typed_words import WithFiles
from fe_drivetrain.command_line.uncertainty import uncertainty_command
from fe_drivetrain.command_line.validate import validate_command
from fe_drivetrain.common.memory import collect_lasting_seldom
from fe_drivetrain.common.remarks import show_remarks_if_asked

if TYPE_CHECKING:
    from fe_drivetrain.report.suite.case import Case

app = typer.Typer(no_args_is_help=True, **LOOK)
"""The commands of ``fe-drivetrain``."""

_DESCRIBE, _STUDY = "Describe a drivetrain", "Study it"
_PROVE, _HAND_OVER = "Prove it", "Hand it over"

_COMMANDS: tuple[tuple[str, str, Callable[..., None]], ...] = (
    (_DESCRIBE, "new", new_command),
    (_DESCRIBE, "check", check_command),
    (_STUDY, "study", study_command),
    (_STUDY, "advise", advise_command),
    (_STUDY, "modes", modes_command),
    (_STUDY, "loads", loads_command),
    (_STUDY, "life", life_command),
    (_STUDY, "gears", gears_command),
    (_STUDY, "strength", strength_command),
    (_STUDY, "transient", transient_command),
    (_STUDY, "compare", compare_command),
    (_STUDY, "uncertainty", uncertainty_command),
    (_STUDY, "report", report_command),
    (_PROVE, "run", run_command),
    (_PROVE, "list", list_command),
    (_PROVE, "validate", validate_command),
    (_PROVE, "history", history_command),
    (_PROVE, "compare-runs", compare_runs_command),
    (_HAND_OVER, "export", export_command),
    (_HAND_OVER, "part", part_command),
)
_WITHOUT_PAGE = ("new", "list", "history", "compare-runs", "export", "part")

for _panel, _name, _function in _COMMANDS:
    app.command(
        _name,
        cls=HelpOfCases if _name == "run" else WithFiles,
        help=unfolded(_function.__doc__ or ""),
        epilog=examples_text(_name),
        rich_help_panel=_panel,
    )(_function)


def _show_version(wanted: bool) -> None:
    if wanted:
        from importlib.metadata import version

        write(sys.stdout, f"fe-drivetrain {version('fe-drivetrain')}\n")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option(
            "--version", callback=_show_version, is_eager=True, help="Show the version and exit."
        ),
    ] = False,
) -> None:
    """Main bearings, shafts and gears of wind turbines: loads, lives, stiffness, and proofs."""


def main(arguments: list[str] | None = None) -> None:
    """Entry point of ``fe-drivetrain``; ends with its exit status.

    Parameters
    ----------
    arguments : list of str, optional
        The words after the name of the program; those of the shell where left out.
    """
    _typed(lambda: _command()(arguments, prog_name="fe-drivetrain"))


def _typed(command: Callable[[], object]) -> None:
    """Do what was typed, and end."""
    prepare_streams()
    collect_lasting_seldom()
    show_remarks_if_asked()
    ended(command)


@cache
def _command() -> Callable[..., Any]:
    """All commands with their options, built once where a program calls several."""
    group: Any = get_command(app)
    for name, command in group.commands.items():
        with_shared_options(command, has_page=name not in _WITHOUT_PAGE)
    return group  # type: ignore[no-any-return]


def main_of_case(case: Case) -> None:
    """Run a case of a user's own script, outside of the repository.

    The script has the options of ``fe-drivetrain run`` and ends with its exit status. (Scripts
    under ``cases/`` need no such call: `fe_drivetrain.cases.case` makes it for them.)

    Parameters
    ----------
    case : Case
        The case to run. Its function takes a `fe_drivetrain.report.suite.Run` and fills a
        `fe_drivetrain.report.suite.Page`.
    """
    from rich.markup import escape

    from fe_drivetrain.report.suite.settings import settings_in_words

    script = typer.Typer(add_completion=False, **LOOK)
    taken = settings_in_words(case) or "nothing"

    words = f"{case.title}\n\nSource: {case.source}\n\n--set changes: {taken}"

    @script.command(help=escape(words))  # "[m]" is no style of text
    def run_script(out: OutFolder = None, set_: CaseSettings = None, quick: Quick = False) -> None:
        typed = replace(case, command=shlex.join(["python", *sys.argv]))
        raise typer.Exit(run_and_print(lambda: [typed], out, set_ or (), quick))

    _typed(with_shared_options(get_command(script)))
