"""The command ``loads``: statistics, spectra, cycles, distributions and loops of histories."""

from __future__ import annotations

import sys
from math import pi
from pathlib import Path
from typing import Annotated

import typer

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
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.run import results_text
from fe_drivetrain.command_line.terminal import FAILED, PASSED, as_typed, guarded, write
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import scheduled_by
from fe_drivetrain.common.threads import hold_threads

_KEPT = "files that are done are kept: run again with --resume"


def loads_command(
    context: typer.Context,
    files: Annotated[
        list[str],
        typer.Argument(
            metavar="FILES",
            help="Hub loads: files (.out, .outb of OpenFAST, or .csv), folders, or patterns in "
            "quotes, as in 'outputs/**/*.outb'. Lengths and steps may differ.",
        ),
    ],
    out: Annotated[Path, typer.Option("--out", metavar="DIR", help="Result folder.")] = Path(
        "reports/loads"
    ),
    channel: Channels = None,
    mapping: Mapping = None,
    also: Annotated[
        list[str] | None,
        typer.Option(
            "--also",
            metavar="COLUMN",
            help="Another channel of the files, as BldPitch1: statistics, equivalent loads and "
            "multiples of it, too. May be repeated.",
        ),
    ] = None,
    rotor_speed: RotorSpeed = None,
    skip: Skip = 0.0,
    slope: Slopes = None,
    frequency: Annotated[
        float,
        typer.Option(
            "--frequency", metavar="HZ", min=1e-6, help="Of damage-equivalent loads, in Hz."
        ),
    ] = 1.0,
    ultimate: Annotated[
        list[str] | None,
        typer.Option(
            "--ultimate",
            metavar="NAME=LOAD",
            help="Load that breaks the part, with its unit, as in 'My=25 MNm': shows cycles about "
            "zero mean by Goodman's line, too. May be repeated.",
        ),
    ] = None,
    residue: Annotated[
        str,
        typer.Option(
            "--residue",
            metavar="RULE",
            help="Cycles that the end of a file leaves open: half (ASTM E1049), closed (as whole "
            "ones), or repeated (the file is followed by itself).",
        ),
    ] = "half",
    gate: Annotated[
        str,
        typer.Option(
            "--gate",
            metavar="SHARE",
            help="Leave out cycles below a share of the largest range, as in 1%. How many is on "
            "the page.",
        ),
    ] = "0",
    target: Annotated[
        int,
        typer.Option(
            "--target", metavar="COUNT", min=1, help="Windows that each wind speed should have."
        ),
    ] = 6,
    winds: Annotated[
        str | None,
        typer.Option(
            "--winds",
            metavar="LOW:HIGH",
            help="Mean wind speeds that the capture matrix should have, as in 4:24, in m/s. "
            "Default: those of the files.",
        ),
    ] = None,
    site: Annotated[
        str | None,
        typer.Option(
            "--site",
            metavar="CLASS",
            help="Weight winds over a lifetime: a class of IEC 61400-1 (I, II, III), or the mean "
            "wind speed in m/s.",
        ),
    ] = None,
    shape: Annotated[
        float,
        typer.Option(
            "--shape",
            metavar="K",
            min=0.5,
            help="Weibull's exponent of the site's winds; 2 is Rayleigh's distribution.",
        ),
    ] = 2.0,
    years: Annotated[
        float, typer.Option("--years", metavar="YEARS", min=0.01, help="Of the lifetime.")
    ] = 20.0,
    transient: Annotated[
        list[str] | None,
        typer.Option(
            "--transient",
            metavar="FILES=COUNT",
            help="Events of the lifetime and how many a year, as in 'stops/*.outb=700'; a file is "
            "one event. May be repeated.",
        ),
    ] = None,
    against: Annotated[
        list[str] | None,
        typer.Option(
            "--against",
            metavar="FILES",
            help="Another set of histories: says what differs by more than the scatter of seeds. "
            "May be repeated.",
        ),
    ] = None,
    scene: Annotated[
        str | None,
        typer.Option(
            "--scene",
            metavar="SCENE",
            help="A scene whose bearing reactions to these loads are shown and compared, too.",
        ),
    ] = None,
    level: Annotated[
        str,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="Of the scene: 1, a beam on rigid housings, or 4, the assembly of solids.",
        ),
    ] = "1",
    parquet: Annotated[
        bool, typer.Option("--parquet", help="Write each table as Parquet, too (needs pyarrow).")
    ] = False,
    resume: Resume = False,
    scheduler: Scheduler = None,
) -> None:
    """Show what is in load histories: statistics, spectra, cycles, time at level, load loops.

    Reads one file after the other in bounded memory. The page has statistics by wind, a capture
    matrix, planes of force and moment, spectra with multiples of the rotor's speed, rainflow
    counts with damage-equivalent loads, load duration and revolution distributions, and load
    loops; all tables stand beside it as CSV.

    The exit status is 0 if every check passes.
    """

    def work() -> int:
        hold_threads()
        from fe_drivetrain.command_line.loads_page import show_loads
        from fe_drivetrain.command_line.loads_tables import parquet_writer
        from fe_drivetrain.command_line.loads_words import (
            parse_channels,
            parse_share,
            parse_site,
            parse_transients,
            parse_ultimate,
            parse_winds,
        )
        from fe_drivetrain.command_line.showing import shown
        from fe_drivetrain.drivetrain_file.named_scenes import named_scene
        from fe_drivetrain.report.suite.case import Case
        from fe_drivetrain.report.suite.ownership import check_result_folder
        from fe_drivetrain.report.suite.result_folders import run_case
        from fe_drivetrain.studies.load_digest import LoadOptions
        from fe_drivetrain.studies.load_histories import loads
        from fe_drivetrain.turbine_loads.histories.cycles import RESIDUES
        from fe_drivetrain.turbine_loads.histories.damage import SLOPES
        from fe_drivetrain.turbine_loads.hub_loads.channel_map import read_channel_map
        from fe_drivetrain.turbine_loads.hub_loads.recorded import OWN_NAMES, recorded_files

        check_result_folder(out)
        if residue not in RESIDUES:
            raise InputError(f"--residue {residue}: choose one of {', '.join(RESIDUES)}")
        options = LoadOptions(
            parse_channels(channel or ()),
            skip,
            tuple(slope or SLOPES),
            residue,  # type: ignore[arg-type]
            parse_share(gate),
            None if rotor_speed is None else rotor_speed * pi / 30.0,
            parse_ultimate(ultimate or ()),
            frequency,
            OWN_NAMES if mapping is None else read_channel_map(mapping),
            tuple(also or ()),
        )
        wanted = parse_winds(winds, target)
        place = None if site is None else parse_site(site, shape, years)
        if place is None:
            require_beside(
                context,
                {"shape": "--shape", "years": "--years"},
                "--site",
                "says how the winds of a site are weighted",
            )
        if transient and place is None:
            raise InputError("--transient counts events of a lifetime: give --site, too")
        events = parse_transients(transient or ())
        if level not in ("1", "4"):
            raise InputError(f"--level {level}: choose 1, a beam, or 4, the assembly of solids")
        if scene is None:
            require_beside(context, {"level": "--level"}, "--scene", "is the model of a scene")
        of_scene = None if scene is None else named_scene(scene, {})
        writer = parquet_writer() if parquet else None
        found = recorded_files(files)
        others = recorded_files(against or [])
        count = len(found)
        case = Case(
            "loads/histories",
            f"Load histories of {count} file{'s' * (count > 1)}",
            "the user's files",
            shown(
                lambda run: loads(
                    found,
                    options,
                    wanted,
                    site=place,
                    transients=events,
                    against=others,
                    scene=of_scene,
                    level=1 if level == "1" else 4,
                    resume=resume,
                    report=run.report,
                ),
                lambda run, page, result: show_loads(run, page, result, writer),
            ),
            command=as_typed(),
        )
        with show_steps() as report, scheduled_by(scheduler):
            results = run_case(case, out.resolve(), report=report)
        write(sys.stdout, results_text(results, out / "report.html"))
        return PASSED if results.passed else FAILED

    raise typer.Exit(guarded(work, _KEPT))
