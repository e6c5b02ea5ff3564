"""The command ``modes``: natural frequencies, shapes and resonances of a whole drivetrain."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.names import complete_scene
from fe_drivetrain.command_line.options import Catalogues, Condensed, Matrices, with_options
from fe_drivetrain.command_line.settings import (
    DrivetrainSettings,
    parse_settings,
    parse_tolerance,
    refuse_again,
)
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.studies import run_on_scene
from fe_drivetrain.common.components import ONE_RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.threads import hold_threads

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.procedure import Excitation
    from fe_drivetrain.report.suite.run import Run
    from fe_drivetrain.studies.drivetrain_modes import ModesResult


@dataclass(frozen=True)
class ModesRequest:
    """What the command ``modes`` is asked for."""

    drivetrain: Annotated[
        str,
        typer.Argument(
            metavar="DRIVETRAIN",
            autocompletion=complete_scene,
            help="A drivetrain file, or a name of the library, as in nrel_5mw.",
        ),
    ]
    level: Annotated[
        str | None,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="torsional: bodies turn; rigid: they move in six directions; flexible: shafts "
            "bend, too. Default: the finest that the data allow.",
        ),
    ] = None
    generator: Annotated[
        str,
        typer.Option("--generator", metavar="free|held", help="Whether the generator turns."),
    ] = "free"
    speeds: Annotated[
        str | None,
        typer.Option(
            "--speeds",
            metavar="LOW:HIGH",
            help="Speeds of the rotor in operation, in rpm. Default: operation.rotor_speed of the "
            "file.",
        ),
    ] = None
    speed: Annotated[
        float | None,
        typer.Option(
            "--speed",
            metavar="RPM",
            help="Rotor speed for the frequencies in operation. Default: the largest speed.",
        ),
    ] = None
    blades: Annotated[
        int, typer.Option("--blades", metavar="N", help="Number of blades of the rotor.")
    ] = 3
    excite: Annotated[
        list[str] | None,
        typer.Option(
            "--excite",
            metavar="NAME=HZ",
            help="A further excitation of the generator at a fixed frequency, as of its converter. "
            "May be repeated.",
        ),
    ] = None
    tolerance: Annotated[
        str,
        typer.Option(
            "--tolerance",
            metavar="SHARE",
            help="Error of a frequency that a simpler level may have, as in 5% or 0.05.",
        ),
    ] = "5%"
    whirl: Annotated[
        bool,
        typer.Option(
            "--whirl",
            help="Whirl of each shaft instead: critical speeds, Campbell diagrams of forward and "
            "backward whirl, unbalance, stability.",
        ),
    ] = False
    condensed: Condensed = False
    matrices: Matrices = False
    catalogue: Catalogues = None
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Result folder. Default: reports/modes/DRIVETRAIN."
        ),
    ] = None
    set_: DrivetrainSettings = None


@with_options(ModesRequest)
def modes_command(context: typer.Context, asked: ModesRequest) -> int:
    """Find natural frequencies of a drivetrain, what moves in each mode, and what excites it.

    The page has a Campbell diagram with every excitation that can meet a mode in operation
    (blades, planets, teeth with sidebands, shafts), mode shapes that move, energy by part, a
    resonance register with margins, and the results of each level of the model.

    With --whirl, each shaft is a rotor by itself on its bearings. The file's key whirl has
    unbalance, damping, and stiffness of bearings over the speed.

    The exit status is 0 if the modes were found, 2 if the file or an option is wrong.
    """
    hold_threads()
    speeds = None if asked.speeds is None else parse_speeds(asked.speeds)
    speed = None if asked.speed is None else asked.speed * ONE_RPM
    share = parse_tolerance(asked.tolerance)
    excitations = parse_excitations(asked.excite or ())
    from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain
    from fe_drivetrain.pages.modes import show_modes
    from fe_drivetrain.studies.drivetrain_modes import modes

    drivetrain = read_drivetrain(asked.drivetrain, parse_settings(asked.set_ or ()))
    if asked.whirl:
        return _whirl(asked, drivetrain, speeds)

    def study(run: Run) -> ModesResult:
        return modes(
            drivetrain,
            level=asked.level,
            generator=asked.generator,
            speeds=speeds,
            speed=speed,
            blades=asked.blades,
            excitations=excitations,
            tolerance=share,
            condensed=asked.condensed,
            matrices=asked.matrices,
            catalogues=tuple(asked.catalogue or ()),
            report=run.report,
        )

    title = f"{drivetrain.title}: natural frequencies, and what excites them"
    return run_on_scene("modes", [asked.drivetrain], title, asked.out, Shown(study, show_modes))


def _whirl(asked: ModesRequest, drivetrain: Drivetrain, speeds: tuple[float, float] | None) -> int:
    """Whirl of the shafts."""
    _refuse_beside_whirl(asked)
    from fe_drivetrain.pages.whirl import show_whirl
    from fe_drivetrain.studies.shaft_whirl import WhirlResult, whirl

    def study(run: Run) -> WhirlResult:
        return whirl(drivetrain, speeds=speeds, matrices=asked.matrices, report=run.report)

    title = f"{drivetrain.title}: whirl of its shafts"
    return run_on_scene("whirl", [asked.drivetrain], title, asked.out, Shown(study, show_whirl))


def _refuse_beside_whirl(asked: ModesRequest) -> None:
    """Refuse options that whirl does not take."""
    default = ModesRequest("")
    names = (
        "level",
        "generator",
        "speed",
        "blades",
        "excite",
        "tolerance",
        "condensed",
        "catalogue",
    )
    given = [name for name in names if getattr(asked, name) != getattr(default, name)]
    if given:
        raise InputError(
            f"--{given[0]} is of modes of the whole drivetrain and has no meaning beside --whirl: "
            "leave one of them out"
        )


def parse_speeds(text: str) -> tuple[float, float]:
    """Least and largest speed of ``--speeds LOW:HIGH`` [rad/s].

    Parameters
    ----------
    text : str
        Two numbers in rpm.

    Raises
    ------
    InputError
        It has another form, or is no range.
    """
    low, _, high = text.partition(":")
    try:
        found = float(low), float(high)
    except ValueError:
        found = math.nan, math.nan
    if not 0.0 <= found[0] < found[1] < math.inf:
        raise InputError(
            f"--speeds {text} must be two speeds in rpm, the larger one last: write it as in "
            "--speeds 6.9:12.1"
        )
    return found[0] * ONE_RPM, found[1] * ONE_RPM


def parse_excitations(texts: Iterable[str]) -> tuple[Excitation, ...]:
    """Excitations of the generator by ``--excite NAME=HZ``.

    Parameters
    ----------
    texts : iterable of str
        One for each option.

    Raises
    ------
    InputError
        One has another form, or a name is given twice.
    """
    from fe_drivetrain.procedure import Excitation

    found: dict[str, Excitation] = {}
    for text in texts:
        name, equals, value = (part.strip() for part in text.partition("="))
        try:
            frequency = float(value)
        except ValueError:
            frequency = math.nan
        if not (name and equals and 0.0 < frequency < math.inf):
            raise InputError(
                f"--excite {text} must be a name and a frequency in Hz above 0: write it as in "
                "--excite converter=100"
            )
        refuse_again("--excite", name, found)
        found[name] = Excitation(name, 0.0, ("generator",), frequency)
    return tuple(found.values())
