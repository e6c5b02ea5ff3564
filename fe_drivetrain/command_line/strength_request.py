"""What is asked of ``strength``: its options as typed, and what they mean."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.options import (
    Channels,
    Mapping,
    Resume,
    RotorSpeed,
    SceneName,
    Scheduler,
    Skip,
    WindSite,
)
from fe_drivetrain.command_line.settings import SceneSettings, parse_loads
from fe_drivetrain.studies.strength_options import StrengthOptions

if TYPE_CHECKING:
    from fe_drivetrain.studies.strength_loading import StrengthLoading
    from fe_drivetrain.turbine_loads.histories.sites import Site

_HUB = ("hub.Fx", "hub.Fy", "hub.Fz", "hub.Mx", "hub.My", "hub.Mz")


@dataclass(frozen=True)
class StrengthRequest:
    """Arguments and options of ``strength`` as typed; each help text says what one is."""

    scene: SceneName
    loads: Annotated[
        list[str] | None,
        typer.Option(
            "--loads",
            metavar="FILES",
            help="Hub loads: a file (.out, .outb of OpenFAST, .csv, or of other programs), a "
            "folder, or a pattern in quotes. May be repeated.",
        ),
    ] = None
    load: Annotated[
        list[str] | None,
        typer.Option(
            "--load",
            metavar="NAME=VALUE",
            help="Constant load of the hub in place of files, as in hub.My=1e6 (N, N m), the "
            "rotor's weight in it. May be repeated.",
        ),
    ] = None
    spectrum: Annotated[
        Path | None,
        typer.Option(
            "--spectrum",
            metavar="CSV",
            help="A torque spectrum beside constant loads: columns torque, time and, where it "
            "differs, rotor speed, each with its unit.",
        ),
    ] = None
    site: WindSite = None
    hours: Annotated[
        float | None,
        typer.Option(
            "--hours", metavar="H", help="Required life, without a site. Default: 175200."
        ),
    ] = None
    housings: Annotated[
        bool,
        typer.Option(
            "--housings/--rigid",
            help="Whether housings are elastic, between two bounds, where the loads of the shaft "
            "depend on that. Meshes them once.",
        ),
    ] = StrengthOptions.housings
    elastic: Annotated[
        bool,
        typer.Option(
            "--elastic/--formulas",
            help="Whether stress at fillets is solved by elasticity, with bands; or by formulas "
            "of DIN 743-2 alone.",
        ),
    ] = StrengthOptions.elastic
    weight: Annotated[
        bool,
        typer.Option("--weight/--no-weight", help="Whether gearbox and shaft have their weight."),
    ] = StrengthOptions.weight
    points: Annotated[
        int,
        typer.Option(
            "--points", metavar="COUNT", help="Points round the shaft whose stress is counted."
        ),
    ] = StrengthOptions.points
    channel: Channels = None
    mapping: Mapping = None
    rotor_speed: RotorSpeed = None
    skip: Skip = StrengthOptions.skip
    resume: Resume = False
    scheduler: Scheduler = None
    out: Annotated[
        Path | None,
        typer.Option(
            "--out", metavar="DIR", help="Result folder. Default: reports/strength/SCENE."
        ),
    ] = None
    set_: SceneSettings = None

    @property
    def folder(self) -> Path:
        """The result folder."""
        return self.out or Path("reports", "strength", Path(self.scene).stem)

    def options(self) -> StrengthOptions:
        """Choices of the study.

        Raises
        ------
        InputError
            One of them is none that there is.
        """
        from fe_drivetrain.command_line.option_values import parse_mapping

        return StrengthOptions(
            channels=parse_mapping(self.mapping, self.channel or ()),
            rotor_speed_rpm=self.rotor_speed,
            skip=self.skip,
            hours=self.hours,
            housings=self.housings,
            elastic=self.elastic,
            weight=self.weight,
            points=self.points,
        )

    def loading(self) -> StrengthLoading:
        """Loads of the shaft.

        Raises
        ------
        InputError
            A file is not found, or an option has another form.
        """
        from fe_drivetrain.command_line.option_values import parse_site
        from fe_drivetrain.studies.gear_spectra import read_spectrum
        from fe_drivetrain.studies.strength_loading import StrengthLoading
        from fe_drivetrain.turbine_loads.hub_loads.recorded import recorded_files

        site: Site | None = None if self.site is None else parse_site(self.site)
        hub = parse_loads(self.load or (), _HUB)
        return StrengthLoading(
            recorded_files(self.loads or ()),
            site,
            None if hub is None else {name.removeprefix("hub."): v for name, v in hub.items()},
            None if self.spectrum is None else read_spectrum(self.spectrum),
            self.resume,
        )
