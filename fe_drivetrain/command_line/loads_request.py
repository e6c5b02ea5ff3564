"""What is asked of ``loads``: its options as typed, and what they mean."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

import typer

from fe_drivetrain.command_line.names import complete_scene
from fe_drivetrain.command_line.options import (
    Channels,
    Mapping,
    Resume,
    RotorSpeed,
    Scheduler,
    Skip,
    Slopes,
    require_beside,
)
from fe_drivetrain.common.errors import InputError

if TYPE_CHECKING:
    from fe_drivetrain.studies.load_digest import LoadOptions
    from fe_drivetrain.turbine_loads.histories.sites import Site


@dataclass(frozen=True)
class LoadsRequest:
    """Arguments and options of ``loads`` as typed; each help text says what one is."""

    files: Annotated[
        list[str],
        typer.Argument(
            metavar="FILES",
            help="Hub loads, all six or some, as a torque alone: files (.out, .outb of OpenFAST, "
            ".csv, or of other programs), folders, or patterns in quotes, as in "
            "'outputs/**/*.outb'. Lengths and "
            "steps may differ.",
        ),
    ]
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Result folder.")] = Path(
        "reports/loads"
    )
    channel: Channels = None
    mapping: Mapping = None
    also: Annotated[
        list[str] | None,
        typer.Option(
            "--also",
            metavar="COLUMN",
            help="Another channel of the files, as BldPitch1: statistics, equivalent loads and "
            "multiples of it, too. May be repeated.",
        ),
    ] = None
    rotor_speed: RotorSpeed = None
    skip: Skip = 0.0
    slope: Slopes = None
    frequency: Annotated[
        float,
        typer.Option(
            "--frequency", metavar="HZ", min=1e-6, help="Frequency of damage-equivalent loads."
        ),
    ] = 1.0
    ultimate: Annotated[
        list[str] | None,
        typer.Option(
            "--ultimate",
            metavar="NAME=LOAD",
            help="Load that breaks the part, with its unit, as in 'My=25 MNm': shows cycles about "
            "zero mean by Goodman's line, too. May be repeated.",
        ),
    ] = None
    residue: Annotated[
        str,
        typer.Option(
            "--residue",
            metavar="RULE",
            help="Cycles that the end of a file leaves open: half (ASTM E1049), closed (as whole "
            "ones), or repeated (the file is followed by itself).",
        ),
    ] = "half"
    gate: Annotated[
        str,
        typer.Option(
            "--gate",
            metavar="SHARE",
            help="Leave out cycles below a share of the largest range, as in 1%. The page states "
            "their number.",
        ),
    ] = "0"
    target: Annotated[
        int,
        typer.Option(
            "--target", metavar="COUNT", min=1, help="Windows that each wind speed should have."
        ),
    ] = 6
    winds: Annotated[
        str | None,
        typer.Option(
            "--winds",
            metavar="LOW:HIGH",
            help="Mean wind speeds that the capture matrix should have, as in 4:24, in m/s. "
            "Default: those of the files.",
        ),
    ] = None
    site: Annotated[
        str | None,
        typer.Option(
            "--site",
            metavar="CLASS",
            help="Weight winds over a lifetime: a class of IEC 61400-1 (I, II, III), or the mean "
            "wind speed in m/s.",
        ),
    ] = None
    shape: Annotated[
        float,
        typer.Option(
            "--shape",
            metavar="K",
            min=0.5,
            help="Weibull's exponent of the site's winds; 2 is Rayleigh's distribution.",
        ),
    ] = 2.0
    years: Annotated[
        float, typer.Option("--years", metavar="YEARS", min=0.01, help="Of the lifetime.")
    ] = 20.0
    transient: Annotated[
        list[str] | None,
        typer.Option(
            "--transient",
            metavar="FILES=COUNT",
            help="Events of the lifetime and how many a year, as in 'stops/*.outb=700'; a file is "
            "one event. May be repeated.",
        ),
    ] = None
    against: Annotated[
        list[str] | None,
        typer.Option(
            "--against",
            metavar="FILES",
            help="Another set of histories: says what differs by more than the scatter of seeds. "
            "May be repeated.",
        ),
    ] = None
    scene: Annotated[
        str | None,
        typer.Option(
            "--scene",
            metavar="SCENE",
            autocompletion=complete_scene,
            help="A scene whose bearing reactions to these loads are shown and compared, too.",
        ),
    ] = None
    level: Annotated[
        str,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="Of the scene: 1, a beam on rigid housings, or 4, the assembly of solids.",
        ),
    ] = "1"
    parquet: Annotated[
        bool, typer.Option("--parquet", help="Write each table as Parquet, too (needs pyarrow).")
    ] = False
    resume: Resume = False
    scheduler: Scheduler = None

    def options(self) -> LoadOptions:
        """How histories are read and counted.

        Raises
        ------
        InputError
            An option has another form, or is out of range.
        """
        from fe_drivetrain.command_line.option_values import (
            parse_mapping,
            parse_share,
            parse_ultimate,
        )
        from fe_drivetrain.studies.load_digest import LoadOptions
        from fe_drivetrain.turbine_loads.histories.cycles import RESIDUES
        from fe_drivetrain.turbine_loads.histories.damage import SLOPES

        if self.residue not in RESIDUES:
            raise InputError(f"--residue {self.residue}: choose one of {', '.join(RESIDUES)}")
        return LoadOptions(
            channels=parse_mapping(self.mapping, self.channel or ()),
            rotor_speed_rpm=self.rotor_speed,
            skip=self.skip,
            slopes=tuple(self.slope or SLOPES),
            residue=self.residue,  # type: ignore[arg-type]
            gate=parse_share(self.gate),
            ultimate=parse_ultimate(self.ultimate or ()),
            frequency=self.frequency,
            also=tuple(self.also or ()),
        )

    def place(self, context: typer.Context) -> Site | None:
        """The site of the lifetime; None without one.

        Parameters
        ----------
        context : typer.Context
            Says which options were typed.

        Raises
        ------
        InputError
            There is no such site, or options that need one stand without it.
        """
        from fe_drivetrain.command_line.option_values import parse_site

        if self.site is not None:
            return parse_site(self.site, self.shape, self.years)
        require_beside(
            context,
            {"shape": "--shape", "years": "--years"},
            "--site",
            "says how the winds of a site are weighted",
        )
        if self.transient:
            raise InputError("--transient counts events of a lifetime: give --site, too")
        return None

    def scene_level(self, context: typer.Context) -> Literal[1, 4]:
        """Level of the scene's model.

        Parameters
        ----------
        context : typer.Context
            Says which options were typed.

        Raises
        ------
        InputError
            There is no such level, or no scene.
        """
        if self.level not in ("1", "4"):
            raise InputError(
                f"--level {self.level}: choose 1, a beam, or 4, the assembly of solids"
            )
        if self.scene is None:
            require_beside(context, {"level": "--level"}, "--scene", "is the model of a scene")
        return 1 if self.level == "1" else 4
