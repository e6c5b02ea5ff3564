"""What is asked of ``transient``: its options as typed, and what they mean."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.life_request import bearing_entries
from fe_drivetrain.command_line.options import (
    BearingEntries,
    Catalogues,
    Channels,
    Condensed,
    DrivetrainName,
    Mapping,
    Matrices,
    Resume,
    Scheduler,
    Skip,
    Slopes,
    WindSite,
)
from fe_drivetrain.command_line.settings import DrivetrainSettings, Tolerance, parse_settings
from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from fe_drivetrain.studies.transient_histories import OperationOptions
    from fe_drivetrain.studies.transient_parts import DamageOptions

EVENTS = ("operation", "stop", "grid-loss", "dip", "run-up", "offset", "base")
"""Events as they are typed."""


def complete_event(incomplete: str) -> list[str]:
    """Events that begin with what was typed.

    Parameters
    ----------
    incomplete : str
        What was typed so far.
    """
    return [name for name in EVENTS if name.startswith(incomplete)]


@dataclass(frozen=True)
class TransientRequest:
    """Arguments and options of ``transient`` as typed; each help text says what one is."""

    drivetrain: DrivetrainName
    event: Annotated[
        str,
        typer.Argument(
            metavar="EVENT",
            autocompletion=complete_event,
            help=f"What happens: {', '.join(EVENTS)}.",
        ),
    ]
    loads: Annotated[
        list[str] | None,
        typer.Option(
            "--loads",
            metavar="FILES",
            help="Histories of operation, or of the base's acceleration: a file (.out, .outb, "
            ".csv, or of other programs), a folder, or a pattern in quotes, as in "
            "'outputs/*.outb'. May be repeated.",
        ),
    ] = None
    value: Annotated[
        list[str] | None,
        typer.Option(
            "--value",
            metavar="NAME=VALUE",
            help="A value of the event, as in --value braked=2.5 of a stop, in s, N, m, N m, or "
            "over rated (docs/commands.md). May be repeated.",
        ),
    ] = None
    level: Annotated[
        str | None,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="torsional, rigid (bodies), flexible (shafts), or the name of a condensed one. "
            "Default: all of them, compared, and the cheapest that is enough.",
        ),
    ] = None
    condensed: Condensed = False
    matrices: Matrices = False
    on_rollers: Annotated[
        bool,
        typer.Option(
            "--on-rollers",
            help="A last level, with bearings that have a catalogue entry (also those of planets) "
            "on their rollers, laminae and clearance in each step. For histories.",
        ),
    ] = False
    quantity: Annotated[
        str,
        typer.Option(
            "--quantity",
            metavar="NAME",
            help="Quantity for which the level must be enough: torque, mesh or bearing.",
        ),
    ] = "bearing"
    tolerance: Tolerance = "5%"
    duration: Annotated[
        float | None,
        typer.Option(
            "--duration",
            metavar="SECONDS",
            help="Time that is computed of the event, or of each history. Default: what the event "
            "needs; the whole history.",
        ),
    ] = None
    step: Annotated[
        float | None,
        typer.Option(
            "--step",
            metavar="SECONDS",
            help="Step of integration. Default: what the event needs; for histories 0.005, or the "
            "time between samples where that is less.",
        ),
    ] = None
    backlash: Annotated[
        float,
        typer.Option(
            "--backlash", metavar="M", help="Backlash of all meshes along their lines of action."
        ),
    ] = 0.0
    planets: Annotated[
        str,
        typer.Option(
            "--planets",
            metavar="WORD",
            help="stand at one azimuth, or travel with their carriers, in dip, offset and base.",
        ),
    ] = "stand"
    rollers: Annotated[
        bool,
        typer.Option(
            "--rollers",
            help="Bring rollers of all bearings into equilibrium every 5 ms, for L10r, L10mr and "
            "the largest Hertz pressure. May take minutes.",
        ),
    ] = False
    bearing: BearingEntries = None
    catalogue: Catalogues = None
    channel: Channels = None
    mapping: Mapping = None
    skip: Skip = 0.0
    site: WindSite = None
    slope: Slopes = None
    csv: Annotated[
        bool, typer.Option("--csv", help="Write all channels over time as samples.csv, too.")
    ] = False
    resume: Resume = False
    scheduler: Scheduler = None
    out: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="DIR",
            help="Result folder. Default: reports/transient/DRIVETRAIN-EVENT.",
        ),
    ] = None
    set_: DrivetrainSettings = None

    @property
    def name(self) -> str:
        """Name of the event in Python.

        Raises
        ------
        InputError
            There is no such event.
        """
        if self.event not in EVENTS and self.event.replace("_", "-") not in EVENTS:
            raise InputError(f"no event {self.event!r}: use one of {', '.join(EVENTS)}")
        return self.event.replace("-", "_")

    @property
    def folder(self) -> Path:
        """The result folder."""
        own = f"{Path(self.drivetrain).stem}-{self.event}"
        return self.out or Path("reports", "transient", own)

    @property
    def values(self) -> dict[str, float | str]:
        """Values of the event.

        Raises
        ------
        InputError
            One is no number or word.
        """
        found: dict[str, float | str] = {}
        for key, value in parse_settings(self.value or (), "--value").items():
            if isinstance(value, bool) or not isinstance(value, int | float | str):
                raise InputError(f"--value {key}: {value!r} must be a number or a word")
            found[key] = value if isinstance(value, str) else float(value)
        return found

    def options(self) -> OperationOptions:
        """How histories are read and counted.

        Raises
        ------
        InputError
            An option has another form, or is out of range.
        """
        from fe_drivetrain.command_line.option_values import parse_mapping
        from fe_drivetrain.studies.transient_histories import OperationOptions
        from fe_drivetrain.turbine_loads.histories.damage import SLOPES

        return OperationOptions(
            channels=parse_mapping(self.mapping, self.channel or ()),
            skip=self.skip,
            slopes=tuple(self.slope or SLOPES),
        )

    def damage(self) -> DamageOptions:
        """How damage of gears and bearings is counted.

        Raises
        ------
        InputError
            An option has another form, or is out of range.
        """
        from fe_drivetrain.command_line.option_values import parse_site
        from fe_drivetrain.studies.life_options import LifeOptions
        from fe_drivetrain.studies.transient_parts import DamageOptions

        lives = LifeOptions(
            bearings=bearing_entries(self.bearing or ()), catalogues=tuple(self.catalogue or ())
        )
        site = None if self.site is None else parse_site(self.site)
        return DamageOptions(lives, self.rollers, site)
