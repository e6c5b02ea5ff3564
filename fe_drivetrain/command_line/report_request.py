"""What ``report`` is asked: its arguments and options."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fe_drivetrain.command_line.options import Catalogues, LoadFiles, RotorSpeed, SceneName, Skip
from fe_drivetrain.command_line.options import Mapping as ChannelMapping
from fe_drivetrain.command_line.run import Quick
from fe_drivetrain.command_line.settings import SceneSettings

if TYPE_CHECKING:
    from fe_drivetrain.turbine_loads.histories.sites import Site
    from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap


@dataclass(frozen=True)
class ReportRequest:
    """Arguments and options of ``report`` as typed; each help text says what one is."""

    scene: SceneName
    loads: LoadFiles
    site: Annotated[
        str | None,
        typer.Option(
            "--site",
            metavar="CLASS",
            help="Weight winds for lives: a class of IEC 61400-1, as in class-II, or a mean wind "
            "speed in m/s.",
        ),
    ] = None
    skip: Skip = 0.0
    mapping: ChannelMapping = None
    rotor_speed: RotorSpeed = None
    catalogue: Catalogues = None
    quick: Quick = False
    pdf: Annotated[
        bool,
        typer.Option(
            "--pdf",
            help="Print the first page as printed/dossier.pdf, too; needs Chromium or Chrome.",
        ),
    ] = False
    png: Annotated[
        bool,
        typer.Option(
            "--png",
            help="Write the charts of the first page as pictures into printed, too, each with "
            "title and source; needs Chromium or Chrome.",
        ),
    ] = False
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Folder. Default: reports/dossiers/SCENE."),
    ] = None
    set_: SceneSettings = None

    @property
    def folder(self) -> Path:
        """The folder of the dossier."""
        return self.out or Path("reports", "dossiers", Path(self.scene).stem)

    @property
    def channels(self) -> ChannelMap | None:
        """How files of other programs call their channels."""
        from fe_drivetrain.turbine_loads.hub_loads.channel_map import read_channel_map

        return None if self.mapping is None else read_channel_map(self.mapping)

    @property
    def reading(self) -> dict[str, Any]:
        """How the files are read, as options of studies call it."""
        return {
            "skip": self.skip,
            "channels": self.channels,
            "rotor_speed_rpm": self.rotor_speed,
        }

    @property
    def place(self) -> Site | None:
        """The site whose winds are weighted; None without one."""
        from fe_drivetrain.command_line.option_values import parse_site

        return None if self.site is None else parse_site(self.site)
