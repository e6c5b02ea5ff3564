"""The commands ``check``, ``study``, ``advise``, ``uncertainty``: one scene, with a report."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.options import (
    Catalogues,
    Mapping,
    SceneName,
    Scheduler,
    Skip,
    Slopes,
    left_out,
)
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.run import Quick, results_text, tables_text
from fe_drivetrain.command_line.settings import (
    Loads,
    SceneSettings,
    Tolerance,
    parse_loads,
    parse_settings,
    parse_tolerance,
)
from fe_drivetrain.command_line.showing import shown
from fe_drivetrain.command_line.terminal import FAILED, PASSED, as_typed, guarded, write
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import scheduled_by
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import named_scene
from fe_drivetrain.report.suite.ownership import check_result_folder

if TYPE_CHECKING:
    from fe_drivetrain.report.results import Results
    from fe_drivetrain.report.suite.page import Page
    from fe_drivetrain.report.suite.run import Run
    from fe_drivetrain.studies.input_uncertainty import UncertaintyResult

OutFolder = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Result folder. Default: reports/COMMAND/SCENE."),
]


def check_command(
    scene: SceneName,
    catalogue: Catalogues = None,
    out: OutFolder = None,
    set_: SceneSettings = None,
) -> None:
    """Check a scene, describe and draw it, and predict what each level of the ladder costs.

    Prints parts, bearings, supports, masses and costs; the report has the picture, too. Entries
    that the scene names under 'catalogue' must be in the program's bearing catalogue, or in yours.

    The exit status is 0 if the scene can be solved, 2 if it cannot.
    """

    def work() -> int:
        hold_threads()
        found = named_scene(scene, parse_settings(set_ or ()))
        from fe_drivetrain.command_line.scene_page import show_check
        from fe_drivetrain.studies.scene_check import check

        title = f"{found.title}: what the scene is, and what it costs"
        results, page = _results_of_scene(
            "check",
            [scene],
            title,
            out,
            shown(lambda run: check(found, tuple(catalogue or ()), report=run.report), show_check),
        )
        write(sys.stdout, tables_text(results, page))
        return PASSED

    raise typer.Exit(guarded(work))


def study_command(
    scene: SceneName,
    loads: Annotated[
        list[str] | None,
        typer.Option(
            "--loads",
            metavar="FILES",
            help="Hub loads: a file (.out, .outb of OpenFAST, or .csv), a folder, or a pattern in "
            "quotes, as in 'outputs/*.outb'. May be repeated. Default: a surrogate of a generic "
            "2 MW rotor.",
        ),
    ] = None,
    skip: Skip = 0.0,
    mapping: Mapping = None,
    slope: Slopes = None,
    weight: Annotated[
        bool,
        typer.Option(
            "--weight/--no-weight",
            help="Whether reactions have the weight of gearbox, shaft, bearings and housings.",
        ),
    ] = True,
    quick: Quick = False,
    scheduler: Scheduler = None,
    out: OutFolder = None,
    set_: SceneSettings = None,
) -> None:
    """Study any scene over hub loads: K_R of its bearing units, reactions, beams against FE.

    Solves the assembly of solids and the cheaper levels for unit loads; the reactions of every load
    step are then one matrix product, now and for other loads later. Of your own files the reactions
    are also written as CSV, with the weight of all parts. Histories may differ in length and step.

    The exit status is 0 if every check passes.
    """

    def work() -> int:
        hold_threads()
        check_result_folder(out or Path("reports", "study", _name_of([scene])))
        found = named_scene(scene, parse_settings(set_ or ()))
        if skip and loads is None:
            raise InputError(
                f"--skip {skip:g} leaves out the beginning of your own files, and there are none: "
                "give them with --loads, or leave --skip out"
            )
        from fe_drivetrain.command_line.study_page import show_study
        from fe_drivetrain.studies.scene_study import study
        from fe_drivetrain.studies.study_loads import own_loads
        from fe_drivetrain.turbine_loads.histories.damage import SLOPES, check_slope
        from fe_drivetrain.turbine_loads.hub_loads.channel_map import read_channel_map

        for exponent in slope or ():
            check_slope(exponent)
        if mapping is not None and loads is None:
            raise InputError("--mapping says how files call their channels: give --loads, too")
        names = None if mapping is None else read_channel_map(mapping)

        # before the work: a fault in a file is reported at once
        own = None if loads is None else own_loads(loads, skip, found, names)
        histories = () if own is None else own.histories
        return run_on_scene(
            "study",
            [scene],
            f"{found.title}: stiffness, reactions, and beams against FE",
            out,
            shown(
                lambda run: study(
                    found, own, slope or SLOPES, weight, run.quick, report=run.report
                ),
                lambda run, page, result: show_study(run, page, result, histories),
            ),
            quick,
            scheduler,
        )

    raise typer.Exit(guarded(work))


def advise_command(
    scene: SceneName,
    quantity: Annotated[
        str | None,
        typer.Option(
            "--quantity",
            metavar="NAME",
            help="The quantity that must be accurate: a reaction, as in main_bearing.My or "
            "gearbox.Fz, or a stiffness, hub.stiffness.ux to hub.stiffness.rz. Default: Fz of the "
            "first bearing.",
        ),
    ] = None,
    tolerance: Tolerance = "1%",
    load: Loads = None,
    to_the_top: Annotated[
        bool,
        typer.Option(
            "--to-the-top", help="Run every level, even if a cheaper one is accurate enough."
        ),
    ] = False,
    out: OutFolder = None,
    set_: SceneSettings = None,
) -> None:
    """Find the cheapest model of a scene that is accurate enough for a quantity.

    Runs models of rising cost until one is accurate enough: statics, beam, meridian in Fourier
    harmonics, assembly of solids. Ranks the details of the scene by the change that leaving each
    one out causes.

    The exit status is 0 if a level is known to be within the tolerance, 1 if none is.
    """

    def work() -> int:
        hold_threads()
        found = named_scene(scene, parse_settings(set_ or ()))
        from fe_drivetrain.pages.advice import show_advise
        from fe_drivetrain.shafts.fidelity.quantity import Quantity
        from fe_drivetrain.shafts.response.model import scene_loads
        from fe_drivetrain.studies.level_advice import advise

        name = quantity or f"{found.bearing_names[0]}.Fz"
        loads = parse_loads(load or (), scene_loads(found))
        Quantity(name).check(found)
        share = parse_tolerance(tolerance)
        return run_on_scene(
            "advise",
            [scene],
            f"{found.title}: the model level that {name} needs",
            out,
            shown(
                lambda run: advise(found, name, share, loads, to_the_top, report=run.report),
                show_advise,
            ),
        )

    raise typer.Exit(guarded(work))


def uncertainty_command(
    context: typer.Context,
    scene: SceneName,
    quantity: Annotated[
        list[str] | None,
        typer.Option(
            "--quantity",
            metavar="NAME",
            help="A quantity for which the model level must be accurate, as in main_bearing.My; it "
            "is reported in addition to every stiffness. May be repeated. Default: "
            "hub.stiffness.uz.",
        ),
    ] = None,
    load: Loads = None,
    tolerance: Tolerance = "5%",
    level: Annotated[
        int | None,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="Sample level 1 (beam) or 2 (meridian) without running the adviser. The assembly "
            "of solids is then not solved, and the model error is known only as bounds.",
        ),
    ] = None,
    samples: Annotated[
        int,
        typer.Option(
            "--samples",
            metavar="COUNT",
            min=40,
            max=100_000,
            help="Number of samples of the Latin hypercube.",
        ),
    ] = 128,
    seed: Annotated[
        int, typer.Option("--seed", metavar="NUMBER", min=0, help="Seed of all random samples.")
    ] = 0,
    sobol: Annotated[
        bool,
        typer.Option(
            "--sobol",
            help="Also estimate Sobol indices (shares of the variance). This takes N (k + 2) "
            "evaluations, N the largest power of two up to --samples, k the number of uncertain "
            "values.",
        ),
    ] = False,
    scheduler: Scheduler = None,
    out: OutFolder = None,
    set_: SceneSettings = None,
) -> None:
    """Propagate the uncertainty of a scene's values to its reactions and stiffnesses.

    The scene states under 'uncertainty' how each uncertain value is distributed. The adviser finds
    the cheapest model level that is accurate enough; sensitivities and the 95 % band of each
    result, from a Latin hypercube, are computed at that level and compared with its own error.

    The exit status is 0 if the level is known to be within the tolerance, 1 if not.
    """

    def work() -> int:
        hold_threads()
        found = named_scene(scene, parse_settings(set_ or ()))
        from fe_drivetrain.pages.uncertainty import show_uncertainty
        from fe_drivetrain.shafts.response.model import scene_loads
        from fe_drivetrain.studies.input_uncertainty import uncertainty

        loads = parse_loads(load or (), scene_loads(found))
        share = parse_tolerance(tolerance)
        if level is not None and not left_out(context, "tolerance"):
            raise InputError(
                f"--tolerance {tolerance} is for the adviser, which --level {level} leaves out: "
                "give one of the two"
            )
        asked = tuple(quantity or ())

        def study(run: Run) -> UncertaintyResult:
            return uncertainty(
                found, asked, loads, share, level, samples, seed, sobol, report=run.report
            )

        return run_on_scene(
            "uncertainty",
            [scene],
            f"{found.title}: uncertainty of the results",
            out,
            shown(study, show_uncertainty),
            scheduler=scheduler,
        )

    raise typer.Exit(guarded(work))


def run_on_scene(
    command: str,
    scenes: Sequence[str],
    title: str,
    out: Path | None,
    study: Callable[[Run, Page], None],
    quick: bool = False,
    scheduler: str | None = None,
) -> int:
    """Run a study as a case of its own and print its outcome.

    Parameters
    ----------
    command : str
        What is done, for the folder.
    scenes : sequence of str
        Names or files of the scenes, for the folder and the source.
    title : str
        Of the page.
    out : Path or None
        The folder, where the user named one.
    study : callable
        Fills the page.
    quick : bool
        Whether it is a quick run.
    scheduler : str or None
        Address of the cluster that does the work.

    Returns
    -------
    int
        The exit status.
    """
    with scheduled_by(scheduler):
        results, page = _results_of_scene(command, scenes, title, out, study, quick)
    write(sys.stdout, results_text(results, page))
    return PASSED if results.passed else FAILED


def _results_of_scene(
    command: str,
    scenes: Sequence[str],
    title: str,
    out: Path | None,
    study: Callable[[Run, Page], None],
    quick: bool = False,
) -> tuple[Results, Path]:
    """Run a study as a case of its own; its results, and its report."""
    from fe_drivetrain.report.suite.case import Case
    from fe_drivetrain.report.suite.result_folders import run_case

    stems = [Path(scene).stem for scene in scenes]
    names = " and ".join(stems if len(set(stems)) == len(stems) else scenes)
    source = f"the scene{'s' * (len(scenes) > 1)} {names}"
    name = _name_of(scenes)
    case = Case(f"{command}/{name}", title, source, study, command=as_typed())
    folder = Path("reports", command, name) if out is None else out
    with show_steps() as report:
        results = run_case(case, folder.resolve(), quick=quick, report=report)
    return results, folder / "report.html"


def _name_of(scenes: Sequence[str]) -> str:
    """Their names, each once, as the folder has them."""
    return "-".join(dict.fromkeys(Path(scene).stem for scene in scenes))
