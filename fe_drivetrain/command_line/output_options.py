"""Options that commands share about what they show: ``--json``, ``--open`` and ``--verbose``."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

import typer
from typer.main import get_command

from fe_drivetrain.common.remarks import show_remarks

LOOK: dict[str, Any] = {
    "pretty_exceptions_enable": False,
    "context_settings": {"help_option_names": ["-h", "--help"]},
}
"""How every command looks, those of scripts of cases, too."""

_asked = {"json": False, "page": False}  # of the command that was read last


def wants_json() -> bool:
    """Whether ``--json`` was typed: standard output then takes JSON and nothing else."""
    return _asked["json"]


def open_if_asked(page: Path) -> None:
    """Open a page in the browser where ``--open`` was typed.

    Parameters
    ----------
    page : Path
        Its HTML file.
    """
    if _asked["page"]:
        import webbrowser

        webbrowser.open(page.resolve().as_uri())


def _ask_for_json(wanted: bool) -> None:
    _asked["json"] = wanted


def _ask_for_page(wanted: bool) -> None:
    _asked["page"] = wanted


def _ask_for_remarks(wanted: bool) -> None:
    if wanted:
        show_remarks()


_Json = Annotated[
    bool,
    typer.Option(
        "--json",
        callback=_ask_for_json,
        expose_value=False,
        help="Print what was found as JSON, for other programs, and nothing else.",
    ),
]
_Open = Annotated[
    bool,
    typer.Option(
        "--open", callback=_ask_for_page, expose_value=False, help="Open the page in the browser."
    ),
]
_Verbose = Annotated[
    bool,
    typer.Option(
        "--verbose",
        "-v",
        callback=_ask_for_remarks,
        expose_value=False,
        help="Print remarks, too, such as that a damaged kept file is made again.",
    ),
]


def with_shared_options(command: Any, has_page: bool = True) -> Any:
    """A command with the options that every one has, as typer makes them of one with no other.

    Parameters
    ----------
    command : click.Command
        Takes them.
    has_page : bool
        Whether it writes a page, which can be opened.

    Returns
    -------
    click.Command
        The same.
    """
    sample = typer.Typer(add_completion=False, **LOOK)

    @sample.command()
    def nothing(json_: _Json = False, open_: _Open = False, verbose: _Verbose = False) -> None:
        pass

    unused = () if has_page else ("open_",)
    command.params += [one for one in get_command(sample).params if one.name not in unused]
    return command
