"""Options that several commands share, and options of a command as one record."""

from __future__ import annotations

from collections.abc import Callable
from collections.abc import Mapping as Pairs
from dataclasses import MISSING, fields
from inspect import Parameter, Signature
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar, get_type_hints

import typer

from fe_drivetrain.command_line.names import complete_scene
from fe_drivetrain.command_line.terminal import guarded
from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from _typeshed import DataclassInstance

    _Request = TypeVar("_Request", bound=DataclassInstance)

SceneName = Annotated[
    str,
    typer.Argument(
        metavar="SCENE",
        autocompletion=complete_scene,
        help="A scene file, or a name of the library, as in two_bearings.",
    ),
]
DrivetrainName = Annotated[
    str,
    typer.Argument(
        metavar="DRIVETRAIN",
        autocompletion=complete_scene,
        help="A drivetrain file with rotor, gearbox and generator, or a name of the library, as in "
        "nrel_5mw.",
    ),
]
LoadFiles = Annotated[
    list[str],
    typer.Option(
        "--loads",
        metavar="FILES",
        help="Hub loads: a file (.out, .outb, .csv, or of other programs), a folder, or a "
        "pattern in quotes, as in 'outputs/*.outb'. May be repeated.",
    ),
]
Channels = Annotated[
    list[str] | None,
    typer.Option(
        "--channel",
        metavar="NAME=COLUMN",
        help="How the files call a channel: NAME is time, Fx, Fy, Fz, Mx, My, Mz, rotor speed or "
        "wind speed, as in --channel 'wind speed=Vhub'; of a nacelle's acceleration ax, ay, az, "
        "arx, ary or arz. May be repeated.",
    ),
]
Mapping = Annotated[
    Path | None,
    typer.Option(
        "--mapping",
        metavar="YAML",
        help="Names, units, frame and origin of channels, for files of other programs "
        "(docs/loads.md). --channel replaces its names.",
    ),
]
RotorSpeed = Annotated[
    float | None,
    typer.Option(
        "--rotor-speed", metavar="RPM", min=0.0, help="Rotor speed of files that have none."
    ),
]
Skip = Annotated[
    float,
    typer.Option(
        "--skip",
        metavar="SECONDS",
        min=0.0,
        help="Time to leave out at the beginning of each file of loads.",
    ),
]
Slopes = Annotated[
    list[float] | None,
    typer.Option(
        "--slope",
        metavar="M",
        help="Exponent of an S-N curve, for damage-equivalent loads. May be repeated. Default: 3, "
        "4 and 10.",
    ),
]
Catalogues = Annotated[
    list[Path] | None,
    typer.Option(
        "--catalogue", metavar="FILE", help="A bearing catalogue of your own. May be repeated."
    ),
]
BearingEntries = Annotated[
    list[str] | None,
    typer.Option(
        "--bearing",
        metavar="NAME=ENTRY",
        help="Entry of the bearing catalogue for a bearing of the drivetrain, in place of the one "
        "in its file, as in 'stage 1 pin upwind=planet_nj2232'. May be repeated.",
    ),
]
WindSite = Annotated[
    str | None,
    typer.Option(
        "--site",
        metavar="CLASS",
        help="Weight winds of the files: a class of IEC 61400-1, as in class-II, or the mean wind "
        "speed of a Rayleigh distribution in m/s. Without it the files repeat for ever.",
    ),
]
Resume = Annotated[
    bool,
    typer.Option(
        "--resume",
        help="Continue a run that was stopped: files that were done with the same options, and "
        "have not changed since, are not read again.",
    ),
]
Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler",
        metavar="ADDRESS",
        help="Do the work on an existing Dask cluster, as in tcp://127.0.0.1:8786 "
        "(docs/clusters.md). Default: processes of this machine.",
    ),
]
Condensed = Annotated[
    bool,
    typer.Option(
        "--condensed",
        help="Further levels, with condensed parts: housings of main bearings at both bounds, "
        "carriers, the main shaft in its meridian. Meshes the housings once.",
    ),
]
Matrices = Annotated[
    bool,
    typer.Option(
        "--matrices",
        help="A last level, with the 6 x 6 stiffness of the rollers (laminae, clearance) of "
        "gearbox bearings that have a catalogue entry, at the rated torque.",
    ),
]


def with_options(
    record: type[_Request], kept: str | None = None
) -> Callable[[Callable[[typer.Context, _Request], int]], Callable[..., None]]:
    """Let a command of typer take its arguments and options as one record.

    Parameters
    ----------
    record : type
        A dataclass, whose fields are annotated as arguments and options of typer.
    kept : str or None
        What a stop by Ctrl-C leaves on disk, see `guarded`.

    Returns
    -------
    callable
        Decorates a function of the context and the record that returns an exit status; a user's
        mistake in it becomes one sentence.
    """
    hints = get_type_hints(record, include_extras=True)
    parameters = [Parameter("context", Parameter.KEYWORD_ONLY, annotation=typer.Context)]
    parameters += [
        Parameter(
            field.name,
            Parameter.KEYWORD_ONLY,
            annotation=hints[field.name],
            default=Parameter.empty if field.default is MISSING else field.default,
        )
        for field in fields(record)
    ]

    def decorate(work: Callable[[typer.Context, _Request], int]) -> Callable[..., None]:
        def command(context: typer.Context, **typed: Any) -> None:
            raise typer.Exit(guarded(lambda: work(context, record(**typed)), kept))

        command.__name__, command.__doc__ = work.__name__, work.__doc__
        command.__annotations__ = {one.name: one.annotation for one in parameters}
        command.__signature__ = Signature(parameters)  # type: ignore[attr-defined]
        return command

    return decorate


OF_FILES = {
    "channel": "--channel",
    "mapping": "--mapping",
    "skip": "--skip",
    "resume": "--resume",
}
"""Options of how files of hub loads are read, by the names of their parameters."""


def require_beside(context: typer.Context, options: Pairs[str, str], beside: str, why: str) -> None:
    """Refuse options that say nothing where another one is not given.

    Parameters
    ----------
    context : typer.Context
        Knows which options were typed.
    options : Mapping
        Options by the names of their parameters.
    beside : str
        The option that they need.
    why : str
        What they are of, as in "weights the winds of a site".

    Raises
    ------
    InputError
        One of them was typed.
    """
    for parameter, option in options.items():
        if not left_out(context, parameter):
            raise InputError(
                f"{option} {context.params[parameter]} {why}: give {beside}, too, or leave "
                f"{option} out"
            )


def left_out(context: typer.Context, parameter: str) -> bool:
    """Whether an option stands at its default.

    Parameters
    ----------
    context : typer.Context
        Context of the command.
    parameter : str
        By its name in Python.
    """
    source = context.get_parameter_source(parameter)
    return source is not None and source.name == "DEFAULT"
