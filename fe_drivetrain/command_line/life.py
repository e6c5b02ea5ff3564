"""The command ``life``: rating life of the rolling bearings of a scene under load histories."""

from __future__ import annotations

import sys
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.options import (
    Catalogues,
    Channels,
    Mapping,
    Resume,
    RotorSpeed,
    SceneName,
    Scheduler,
    Skip,
    left_out,
)
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.run import results_text
from fe_drivetrain.command_line.settings import SceneSettings, parse_settings, refuse_again
from fe_drivetrain.command_line.showing import shown
from fe_drivetrain.command_line.terminal import FAILED, PASSED, as_typed, guarded, write
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import scheduled_by
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import named_scene
from fe_drivetrain.studies.life_options import ASSUMED, LifeOptions

if TYPE_CHECKING:
    from fe_drivetrain.turbine_loads.hub_loads.channel_map import ChannelMap

_KEPT = "files that are done are kept: run again with --resume"


def life_command(
    context: typer.Context,
    scene: SceneName,
    loads: Annotated[
        list[str],
        typer.Option(
            "--loads",
            metavar="FILES",
            help="Hub loads: a file (.out, .outb of OpenFAST, or .csv), a folder, or a pattern in "
            "quotes, as in 'outputs/*.outb'. May be repeated.",
        ),
    ],
    site: Annotated[
        str | None,
        typer.Option(
            "--site",
            metavar="CLASS",
            help="Weight winds: a class of IEC 61400-1, as in class-II, or the mean wind speed of "
            "a Rayleigh distribution in m/s. Without it the files follow each other for ever.",
        ),
    ] = None,
    bearing: Annotated[
        list[str] | None,
        typer.Option(
            "--bearing",
            metavar="NAME=ENTRY",
            help="Entry of the bearing catalogue for a bearing of the scene, before what the scene "
            "says under 'catalogue'. May be repeated.",
        ),
    ] = None,
    only: Annotated[
        str | None,
        typer.Option("--only", metavar="NAME", help="The one bearing whose life is asked for."),
    ] = None,
    catalogue: Catalogues = None,
    lubricant: Annotated[
        str,
        typer.Option(
            "--lubricant",
            metavar="GRADE",
            help="A grade (VG 460, VG 320, VG 220, LGWM 1, LGWM 2), or viscosity at 40 and at "
            "100 degC in mm2/s, as in 460,30.5.",
        ),
    ] = str(LifeOptions.lubricant),
    temperature: Annotated[
        float, typer.Option("--temperature", metavar="DEGC", help="Of the bearing in operation.")
    ] = LifeOptions.temperature,
    supply: Annotated[
        str, typer.Option("--supply", metavar="KIND", help="grease, 'filtered oil' or 'oil bath'.")
    ] = LifeOptions.supply,
    cleanliness: Annotated[
        str | None,
        typer.Option(
            "--cleanliness",
            metavar="CLASS",
            help="Of grease: high, normal, 'slight to typical', severe, 'very severe'; of oil a "
            "code of ISO 4406, as in -/15/12. Default: normal, -/15/12.",
        ),
    ] = None,
    profile: Annotated[
        bool,
        typer.Option(
            "--profile/--straight",
            help="Whether rollers have the standard's logarithmic profile where their entry has "
            "none.",
        ),
    ] = LifeOptions.profile,
    riser: Annotated[
        bool,
        typer.Option(
            "--riser/--no-riser", help="Whether the stress riser of ISO/TS 16281 is applied."
        ),
    ] = LifeOptions.riser,
    turning: Annotated[
        str,
        typer.Option(
            "--turning", metavar="RING", help="The ring that turns against the load: inner, outer."
        ),
    ] = LifeOptions.turning,
    support: Annotated[
        str,
        typer.Option(
            "--support",
            metavar="MODEL",
            help="The shaft on its bearings: rollers (in equilibrium with it), pinned, or K_R in "
            "N m/rad.",
        ),
    ] = str(LifeOptions.support),
    rings: Annotated[
        str,
        typer.Option(
            "--rings",
            metavar="MODEL",
            help="The bearing's rings: rigid, three-degree, or housing (the raceway gives way with "
            "the scene's housing, whose bore it has to be).",
        ),
    ] = LifeOptions.rings,
    reliability: Annotated[
        float,
        typer.Option(
            "--reliability", metavar="PERCENT", help="Of modified lives: 90, 95 to 99, 99.5, 99.9."
        ),
    ] = LifeOptions.reliability_percent,
    channel: Channels = None,
    mapping: Mapping = None,
    rotor_speed: RotorSpeed = None,
    skip: Skip = LifeOptions.skip,
    every: Annotated[
        int, typer.Option("--every", metavar="COUNT", min=1, help="Use every n-th sample.")
    ] = LifeOptions.every,
    weight: Annotated[
        bool,
        typer.Option("--weight/--no-weight", help="Whether gearbox and shaft have their weight."),
    ] = LifeOptions.weight,
    resume: Resume = False,
    scheduler: Scheduler = None,
    out: Annotated[
        Path | None,
        typer.Option("--out", metavar="DIR", help="Result folder. Default: reports/life/SCENE."),
    ] = None,
    set_: SceneSettings = None,
) -> None:
    """Rating life of a scene's rolling bearings under load histories, by ISO 281 and ISO/TS 16281.

    Each load step is brought to equilibrium with shaft and rollers; lives L10, L10m, L10r and L10mr
    stand side by side, with the damage by wind speed, row, ring and place of the rollers, and with
    the time in which the methods do not hold. Tables stand beside the page as CSV.

    The exit status is 0 if every check passes.
    """

    def work() -> int:
        hold_threads()
        from fe_drivetrain.report.suite.ownership import check_result_folder

        name = Path(scene).stem
        target = out or Path("reports") / "life" / name
        check_result_folder(target)
        found = named_scene(scene, parse_settings(set_ or ()))
        from fe_drivetrain.command_line.life_page import show_life
        from fe_drivetrain.command_line.loads_words import parse_site
        from fe_drivetrain.report.suite.case import Case
        from fe_drivetrain.report.suite.result_folders import run_case
        from fe_drivetrain.studies.bearing_lives import DrivetrainBearings, lives_under
        from fe_drivetrain.turbine_loads.hub_loads.recorded import recorded_files

        options = LifeOptions(
            bearings=_pairs(bearing or ()),
            only=only,
            catalogues=tuple(catalogue or ()),
            lubricant=parse_lubricant(lubricant),
            temperature=temperature,
            supply=supply,  # type: ignore[arg-type]
            cleanliness=cleanliness,
            profile=profile,
            riser=riser,
            turning=turning,  # type: ignore[arg-type]
            support=support,
            rings=rings,
            reliability_percent=reliability,
            channels=parse_mapping(mapping, channel or ()),
            rotor_speed_rpm=rotor_speed,
            skip=skip,
            every=every,
            weight=weight,
            stated=tuple(name for name in ASSUMED if not left_out(context, name)),
        )
        place = None if site is None else parse_site(site)
        files = recorded_files(loads)
        with show_steps() as report, scheduled_by(scheduler):
            # before the run: a mistake leaves no trace in a folder of reports
            report("bearings")
            drivetrain = DrivetrainBearings(found, options)
            case = Case(
                f"life/{name}",
                f"{drivetrain.scene.title}: rating life of its bearings",
                "the user's scene and files",
                shown(
                    lambda run: lives_under(
                        drivetrain, files, place, resume=resume, report=run.report
                    ),
                    show_life,
                ),
                command=as_typed(),
            )
            results = run_case(case, target.resolve(), report=report)
        write(sys.stdout, results_text(results, target / "report.html"))
        return PASSED if results.passed else FAILED

    raise typer.Exit(guarded(work, _KEPT))


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


def parse_mapping(file: Path | None, channels: Iterable[str]) -> ChannelMap:
    """How files call their channels, by ``--mapping`` and ``--channel``.

    Parameters
    ----------
    file : Path or None
        File of ``--mapping``.
    channels : iterable of str
        Words of ``--channel``, which goes before the mapping.

    Raises
    ------
    InputError
        The mapping cannot be read, or an option has another form.
    """
    from fe_drivetrain.command_line.loads_words import parse_channels
    from fe_drivetrain.turbine_loads.hub_loads.channel_map import read_channel_map
    from fe_drivetrain.turbine_loads.hub_loads.recorded import OWN_NAMES

    names = OWN_NAMES if file is None else read_channel_map(file)
    return names.with_columns(parse_channels(channels))


def _pairs(texts: Iterable[str]) -> dict[str, str]:
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
