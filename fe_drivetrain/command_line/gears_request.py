"""What is asked of ``gears``: its options as typed, and what they mean."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.options import (
    Channels,
    Condensed,
    DrivetrainName,
    Mapping,
    Matrices,
    Resume,
    Scheduler,
    Skip,
    WindSite,
)
from fe_drivetrain.command_line.settings import DrivetrainSettings, parse_loads, parse_tolerance
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies.gear_options import GearOptions

if TYPE_CHECKING:
    from fe_drivetrain.studies.gear_loads import GearLoading
    from fe_drivetrain.turbine_loads.histories.sites import Site

_HUB = ("hub.Fx", "hub.Fy", "hub.Fz", "hub.My", "hub.Mz")


@dataclass(frozen=True)
class GearsRequest:
    """Arguments and options of ``gears`` as typed; each help text says what one is."""

    drivetrain: DrivetrainName
    torque: Annotated[
        float | None,
        typer.Option(
            "--torque",
            metavar="NM",
            help="Reference torque of the rotor in N m. Default: that of the file's "
            "generator.rated_torque, or of its rated_power and rotor_speed.",
        ),
    ] = None
    load: Annotated[
        list[str] | None,
        typer.Option(
            "--load",
            metavar="NAME=VALUE",
            help="Load of the hub beside the torque, as in hub.My=1e6 (N, N m), the rotor's weight "
            "in it. May be repeated. Default: the rotor's weight alone.",
        ),
    ] = None
    loads: Annotated[
        list[str] | None,
        typer.Option(
            "--loads",
            metavar="FILES",
            help="Hub loads, whose torque and other loads make the spectrum: a file (.out, .outb "
            "of OpenFAST, .csv, or of other programs), a folder, or a pattern in quotes. May be "
            "repeated.",
        ),
    ] = None
    spectrum: Annotated[
        Path | None,
        typer.Option(
            "--spectrum",
            metavar="CSV",
            help="A torque spectrum: columns torque, time and, where it differs, rotor speed, each "
            "with its unit (docs/gear_rating.md).",
        ),
    ] = None
    site: WindSite = None
    hours: Annotated[
        float | None,
        typer.Option(
            "--hours", metavar="H", help="Required life, without a site. Default: 175200."
        ),
    ] = None
    level: Annotated[
        str | None,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="Level of the rating: torsional (load shared by formula), rigid, flexible, or the "
            "name of a condensed one. Default: the finest.",
        ),
    ] = None
    condensed: Condensed = False
    matrices: Matrices = False
    rollers: Annotated[
        bool,
        typer.Option(
            "--rollers",
            help="The last level has bearings with a catalogue entry on their rollers, with their "
            "clearance: up to minutes for each torque.",
        ),
    ] = False
    losses: Annotated[
        bool,
        typer.Option(
            "--losses",
            help="Find losses of teeth and bearings, too: efficiency, heat of each part, torque at "
            "the generator, at the reference torque and over the spectrum.",
        ),
    ] = False
    tolerance: Annotated[
        str,
        typer.Option(
            "--tolerance",
            metavar="SHARE",
            help="Allowed difference in contact stress from the finest level, as in 5%.",
        ),
    ] = "5%"
    azimuths: Annotated[
        int,
        typer.Option("--azimuths", metavar="COUNT", help="Positions over a turn of the rotor."),
    ] = GearOptions.azimuths
    slices: Annotated[
        int, typer.Option("--slices", metavar="COUNT", help="Slices of each mesh over the face.")
    ] = GearOptions.slices
    lubricant: Annotated[
        str | None,
        typer.Option(
            "--lubricant",
            metavar="GRADE",
            help="Oil, as in 'VG 320' or 320 (mm2/s at 40 degC; other grades than 220, 320 "
            "and 460 have a viscosity index of 95). Default: operation.lubricant.",
        ),
    ] = None
    rotor_speed: Annotated[
        float | None,
        typer.Option(
            "--rotor-speed",
            metavar="RPM",
            min=0.0,
            help="Rated speed of the rotor, and that of files that have none. Default: "
            "operation.rotor_speed.",
        ),
    ] = None
    channel: Channels = None
    mapping: Mapping = None
    skip: Skip = GearOptions.skip
    resume: Resume = False
    scheduler: Scheduler = None
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Result folder. Default: reports/gears/NAME."),
    ] = None
    set_: DrivetrainSettings = None

    @property
    def folder(self) -> Path:
        """The result folder."""
        return self.out or Path("reports", "gears", Path(self.drivetrain).stem)

    @property
    def place(self) -> Site | None:
        """The site whose winds are weighted; None without one."""
        from fe_drivetrain.command_line.option_values import parse_site

        return None if self.site is None else parse_site(self.site)

    def options(self) -> GearOptions:
        """Choices of the rating.

        Raises
        ------
        InputError
            One of them is none that there is.
        """
        from fe_drivetrain.command_line.option_values import parse_mapping

        return GearOptions(
            level=self.level,
            condensed=self.condensed,
            rollers=self.rollers,
            matrices=self.matrices,
            losses=self.losses,
            tolerance=parse_tolerance(self.tolerance),
            azimuths=self.azimuths,
            slices=self.slices,
            hours=self.hours,
            lubricant=None if self.lubricant is None else parse_grade(self.lubricant),
            channels=parse_mapping(self.mapping, self.channel or ()),
            rotor_speed_rpm=self.rotor_speed,
            skip=self.skip,
        )

    def loading(self) -> GearLoading:
        """Loads of the gears.

        Raises
        ------
        InputError
            A file is not found, or an option has another form.
        """
        from fe_drivetrain.studies.gear_loads import GearLoading
        from fe_drivetrain.studies.gear_spectra import read_spectrum
        from fe_drivetrain.turbine_loads.hub_loads.recorded import recorded_files

        hub = parse_loads(self.load or (), _HUB)
        return GearLoading(
            recorded_files(self.loads or ()),
            self.place,
            None if hub is None else {name.removeprefix("hub."): v for name, v in hub.items()},
            None if self.spectrum is None else read_spectrum(self.spectrum),
            self.resume,
        )


def parse_grade(text: str) -> float:
    """Viscosity at 40 degC of ``--lubricant`` [mm2/s].

    Parameters
    ----------
    text : str
        "VG 320" or "320".

    Raises
    ------
    InputError
        It is neither.
    """
    try:
        return float(text.upper().removeprefix("VG").strip())
    except ValueError as error:
        raise InputError(
            f"--lubricant {text}: give a grade as in 'VG 320', or its viscosity at 40 degC in "
            "mm2/s, as in 320"
        ) from error
