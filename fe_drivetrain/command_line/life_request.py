"""What is asked of ``life``: its options as typed, and what they mean."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.options import (
    BearingEntries,
    Catalogues,
    Channels,
    LoadFiles,
    Mapping,
    Resume,
    RotorSpeed,
    SceneName,
    Scheduler,
    Skip,
    WindSite,
    left_out,
)
from fe_drivetrain.command_line.settings import SceneSettings, refuse_again
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.studies.life_options import ASSUMED, LifeOptions

if TYPE_CHECKING:
    from fe_drivetrain.turbine_loads.histories.sites import Site


@dataclass(frozen=True)
class LifeRequest:
    """Arguments and options of ``life`` as typed; each help text says what one is."""

    scene: SceneName
    loads: LoadFiles
    site: WindSite = None
    event: Annotated[
        list[str] | None,
        typer.Option(
            "--event",
            metavar="NAME=COUNT",
            help="An event of `transient` that comes so many times a year beside the files, as in "
            "stop=700. May be repeated.",
        ),
    ] = None
    bearing: BearingEntries = None
    only: Annotated[
        str | None,
        typer.Option("--only", metavar="NAME", help="The one bearing whose life is asked for."),
    ] = None
    catalogue: Catalogues = None
    lubricant: Annotated[
        str,
        typer.Option(
            "--lubricant",
            metavar="GRADE",
            help="A grade (VG 460, VG 320, VG 220, LGWM 1, LGWM 2), or viscosity at 40 and at "
            "100 degC in mm2/s, as in 460,30.5.",
        ),
    ] = str(LifeOptions.lubricant)
    temperature: Annotated[
        float,
        typer.Option(
            "--temperature", metavar="DEGC", help="Temperature of the bearing in operation."
        ),
    ] = LifeOptions.temperature
    supply: Annotated[
        str, typer.Option("--supply", metavar="KIND", help="grease, 'filtered oil' or 'oil bath'.")
    ] = LifeOptions.supply
    cleanliness: Annotated[
        str | None,
        typer.Option(
            "--cleanliness",
            metavar="CLASS",
            help="Class of grease: high, normal, 'slight to typical', severe, 'very severe'; of "
            "oil a code of ISO 4406, as in -/15/12. Default: normal, -/15/12.",
        ),
    ] = None
    profile: Annotated[
        bool,
        typer.Option(
            "--profile/--straight",
            help="Whether rollers have the standard's logarithmic profile where their entry has "
            "none.",
        ),
    ] = LifeOptions.profile
    riser: Annotated[
        bool,
        typer.Option(
            "--riser/--no-riser", help="Whether the stress riser of ISO/TS 16281 is applied."
        ),
    ] = LifeOptions.riser
    turning: Annotated[
        str,
        typer.Option(
            "--turning", metavar="RING", help="The ring that turns against the load: inner, outer."
        ),
    ] = LifeOptions.turning
    support: Annotated[
        str,
        typer.Option(
            "--support",
            metavar="MODEL",
            help="The shaft on its bearings: rollers (in equilibrium with it), pinned, or K_R in "
            "N m/rad.",
        ),
    ] = str(LifeOptions.support)
    rings: Annotated[
        str,
        typer.Option(
            "--rings",
            metavar="MODEL",
            help="The bearing's rings: rigid, three-degree, or housing (the raceway deforms with "
            "the scene's housing; it must be the housing's bore).",
        ),
    ] = LifeOptions.rings
    reliability: Annotated[
        float,
        typer.Option(
            "--reliability",
            metavar="PERCENT",
            help="Reliability of modified lives: 90, 95 to 99, 99.5, 99.9.",
        ),
    ] = LifeOptions.reliability_percent
    channel: Channels = None
    mapping: Mapping = None
    rotor_speed: RotorSpeed = None
    skip: Skip = LifeOptions.skip
    every: Annotated[
        int, typer.Option("--every", metavar="COUNT", min=1, help="Use every n-th sample.")
    ] = LifeOptions.every
    series: Annotated[
        list[str] | None,
        typer.Option(
            "--series",
            metavar="NAME",
            help="Write loads over time, a CSV for each file: 'raceways', or 'roller=21' for the "
            "load of that place, counted from the right upward, looking downwind, beside them. May "
            "be repeated.",
        ),
    ] = None
    weight: Annotated[
        bool,
        typer.Option("--weight/--no-weight", help="Whether gearbox and shaft have their weight."),
    ] = LifeOptions.weight
    gearbox_lubricant: Annotated[
        str | None,
        typer.Option(
            "--gearbox-lubricant",
            metavar="GRADE",
            help="Oil of the gearbox's bearings, as --lubricant. Default: that of the drivetrain's "
            "operation, or VG 320.",
        ),
    ] = None
    gearbox_temperature: Annotated[
        float | None,
        typer.Option(
            "--gearbox-temperature",
            metavar="DEGC",
            help="Of the gearbox's bearings in operation. Default: that of the drivetrain's "
            "operation, or 60.",
        ),
    ] = LifeOptions.gearbox_temperature
    gearbox_cleanliness: Annotated[
        str | None,
        typer.Option(
            "--gearbox-cleanliness",
            metavar="CLASS",
            help="Of the gearbox's oil, which circulates through a filter: a code of ISO 4406. "
            "Default: -/17/14.",
        ),
    ] = LifeOptions.gearbox_cleanliness
    resume: Resume = False
    scheduler: Scheduler = None
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Result folder. Default: reports/life/SCENE."),
    ] = None
    set_: SceneSettings = None

    @property
    def folder(self) -> Path:
        """The result folder."""
        return self.out or Path("reports", "life", Path(self.scene).stem)

    @property
    def events(self) -> dict[str, float]:
        """How often each event comes in a year.

        Raises
        ------
        InputError
            One has no number, or is given twice.
        """
        found: dict[str, float] = {}
        for text in self.event or ():
            name, _, count = text.partition("=")
            try:
                number = float(count)
            except ValueError:
                raise InputError(
                    f"--event {text}: write NAME=COUNT, as in --event stop=700"
                ) from None
            refuse_again("--event", name, found)
            found[name.strip().replace("-", "_")] = number
        return found

    @property
    def place(self) -> Site | None:
        """The site whose winds are weighted; None without one."""
        from fe_drivetrain.command_line.option_values import parse_site

        return None if self.site is None else parse_site(self.site)

    def options(self, context: typer.Context) -> LifeOptions:
        """Choices of the study.

        Parameters
        ----------
        context : typer.Context
            Says which of them were typed.

        Raises
        ------
        InputError
            One of them is none that there is.
        """
        from fe_drivetrain.command_line.option_values import parse_mapping

        return LifeOptions(
            bearings=bearing_entries(self.bearing or ()),
            only=self.only,
            catalogues=tuple(self.catalogue or ()),
            lubricant=parse_lubricant(self.lubricant),
            temperature=self.temperature,
            supply=self.supply,  # type: ignore[arg-type]
            cleanliness=self.cleanliness,
            profile=self.profile,
            riser=self.riser,
            turning=self.turning,  # type: ignore[arg-type]
            support=self.support,
            rings=self.rings,
            reliability_percent=self.reliability,
            channels=parse_mapping(self.mapping, self.channel or ()),
            rotor_speed_rpm=self.rotor_speed,
            skip=self.skip,
            every=self.every,
            weight=self.weight,
            gearbox_lubricant=None
            if self.gearbox_lubricant is None
            else parse_lubricant(self.gearbox_lubricant),
            gearbox_temperature=self.gearbox_temperature,
            gearbox_cleanliness=self.gearbox_cleanliness,
            series=rollers_of(self.series),
            stated=tuple(name for name in ASSUMED if not left_out(context, name)),
        )


def parse_lubricant(text: str) -> str | tuple[float, float]:
    """The grade of ``--lubricant``, or its viscosities at 40 and at 100 degC [mm2/s].

    Parameters
    ----------
    text : str
        A grade, or two viscosities with a comma between them.
    """
    try:
        at_40, at_100 = (float(part) for part in text.split(","))
    except ValueError:
        return text  # a grade, or refused with those that there are
    return at_40, at_100


def rollers_of(texts: Sequence[str] | None) -> tuple[int, ...] | None:
    """Rolling elements of ``--series``; none of raceways alone.

    Parameters
    ----------
    texts : sequence of str or None
        Words as typed; None where the option is not given.

    Raises
    ------
    InputError
        One is neither "raceways" nor a roller with its number.
    """
    if texts is None:
        return None
    found: list[int] = []
    for text in texts:
        name, _, number = (part.strip() for part in text.partition("="))
        if text.strip() == "raceways":
            continue
        if name != "roller" or not (number.isascii() and number.isdigit()):
            raise InputError(f"--series {text}: write raceways, or roller=21 with its number")
        refuse_again("--series", f"roller={int(number)}", [f"roller={n}" for n in found])
        found.append(int(number))
    return tuple(found)


def bearing_entries(texts: Iterable[str]) -> dict[str, str]:
    """Entries by name of ``--bearing NAME=ENTRY``."""
    found: dict[str, str] = {}
    for text in texts:
        name, equals, entry = (part.strip() for part in text.partition("="))
        if not equals or not name or not entry:
            raise InputError(
                f"--bearing {text}: write NAME=ENTRY, as in --bearing main_bearing=bearing_s"
            )
        refuse_again("--bearing", name, found)
        found[name] = entry
    return found
