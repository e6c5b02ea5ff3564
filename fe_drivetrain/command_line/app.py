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
from fe_drivetrain.command_line.export import export_command
from fe_drivetrain.command_line.history import history_command
from fe_drivetrain.command_line.life import life_command
from fe_drivetrain.command_line.loads import loads_command
from fe_drivetrain.command_line.new_scene import new_command
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
from fe_drivetrain.command_line.studies import advise_command, check_command
from fe_drivetrain.command_line.study import study_command
from fe_drivetrain.command_line.terminal import ended, prepare_streams, write
from fe_drivetrain.command_line.uncertainty import uncertainty_command
from fe_drivetrain.command_line.validate import validate_command
from fe_drivetrain.common.memory import collect_lasting_seldom
from fe_drivetrain.common.remarks import show_remarks, show_remarks_if_asked

if TYPE_CHECKING:
    from fe_drivetrain.report.suite.case import Case

_LOOK: dict[str, Any] = {
    "add_completion": False,
    "pretty_exceptions_enable": False,
    "context_settings": {"help_option_names": ["-h", "--help"]},
}

app = typer.Typer(no_args_is_help=True, **_LOOK)
"""The commands of ``fe-drivetrain``."""

app.command("new")(new_command)
app.command("part")(part_command)
app.command("check")(check_command)
app.command("study")(study_command)
app.command("loads")(loads_command)
app.command("life")(life_command)
app.command("report")(report_command)
app.command("list")(list_command)
app.command("run", cls=HelpOfCases)(run_command)
app.command("history")(history_command)
app.command("compare-runs")(compare_runs_command)
app.command("export")(export_command)
app.command("advise")(advise_command)
app.command("compare")(compare_command)
app.command("uncertainty")(uncertainty_command)
app.command("validate")(validate_command)


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
    """Finite-element validation cases for wind-turbine drivetrains."""


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


def _ask_for_remarks(verbose: bool) -> None:
    if verbose:
        show_remarks()


_Verbose = Annotated[
    bool,
    typer.Option(
        "--verbose",
        "-v",
        callback=_ask_for_remarks,
        expose_value=False,
        help="Say what is otherwise done without a word, as to make a damaged kept file again.",
    ),
]


def _with_verbose(command: Any) -> Any:
    """A command with the option that every one has, as typer makes it of one with no other."""
    sample = typer.Typer(**_LOOK)

    @sample.command()
    def nothing(verbose: _Verbose = False) -> None:
        pass

    command.params += get_command(sample).params
    return command


@cache
def _command() -> Callable[..., Any]:
    """All commands with their options, built once where a program calls several."""
    group: Any = get_command(app)
    for command in group.commands.values():
        _with_verbose(command)
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

    script = typer.Typer(**_LOOK)
    taken = settings_in_words(case) or "nothing"

    words = f"{case.title}\n\nSource: {case.source}\n\n--set changes: {taken}"

    @script.command(help=escape(words))  # "[m]" is no style of text
    def run_script(out: OutFolder = None, set_: CaseSettings = None, quick: Quick = False) -> None:
        typed = replace(case, command=shlex.join(["python", *sys.argv]))
        raise typer.Exit(run_and_print(lambda: [typed], out, set_ or (), quick))

    _typed(_with_verbose(get_command(script)))
