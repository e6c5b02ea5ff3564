"""The commands ``check`` and ``advise``, and how a study of scenes is run with a report."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from fe_drivetrain.command_line.answer_text import show_outcome
from fe_drivetrain.command_line.options import Catalogues, SceneName
from fe_drivetrain.command_line.progress import show_steps
from fe_drivetrain.command_line.settings import (
    Loads,
    SceneSettings,
    Tolerance,
    parse_loads,
    parse_settings,
    parse_tolerance,
)
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.terminal import as_typed, guarded
from fe_drivetrain.common.jobs import scheduled_by
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
    from fe_drivetrain.drivetrain_file.scene import Scene
    from fe_drivetrain.report.results import Results

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

    The page has its picture, parts, bearings, supports, masses and costs. Entries that the scene
    names under 'catalogue' must be in the program's bearing catalogue, or in yours.

    The exit status is 0 if the scene can be solved, 2 if it cannot.
    """

    def work() -> int:
        hold_threads()
        from fe_drivetrain.elasticity.compiled_ahead import compiled_ahead
        from fe_drivetrain.report.pictures.drawing_process import drawing_ready

        with drawing_ready(), compiled_ahead("meridian"):
            found = read_drivetrain(scene, parse_settings(set_ or ()))
            from fe_drivetrain.pages.check import show_check
            from fe_drivetrain.studies.scene_check import check

            title = f"{found.title}: what the drivetrain is, and what it costs"
            entries = tuple(catalogue or ())
            study = Shown(lambda run: check(found, entries, report=run.report), show_check)
            return run_on_scene("check", [scene], title, out, study)

    raise typer.Exit(guarded(work))


def advise_command(
    scene: SceneName,
    quantity: Annotated[
        str | None,
        typer.Option(
            "--quantity",
            metavar="NAME",
            help="The quantity that must be accurate: a reaction, as in main_bearing.My or "
            "gearbox.Fz; a stiffness, hub.stiffness.ux to hub.stiffness.rz; or one of all that "
            "turns, as in modes.torsional.1 or 'gears.stage 3 mesh.K_Hbeta'. Default: Fz of the "
            "first bearing.",
        ),
    ] = None,
    tolerance: Tolerance = "1%",
    load: Loads = None,
    to_the_top: Annotated[
        bool,
        typer.Option(
            "--to-the-top",
            help="Run every level, even if a cheaper one is accurate enough; for modes and gears "
            "also a main shaft and carriers of solids.",
        ),
    ] = False,
    out: OutFolder = None,
    set_: SceneSettings = None,
) -> None:
    """Find the cheapest model of a scene that is accurate enough for a quantity.

    Runs models of rising cost until one is accurate enough: statics, beam, meridian in Fourier
    harmonics, assembly of solids. Ranks the details of the scene by the change that leaving each
    one out causes. For a frequency or a factor of gears it runs what the file has data for:
    torsion, rigid bodies, flexible shafts, housings, mount, carriers, main shaft in its meridian.

    The exit status is 0 if a level is known to be within the tolerance, 1 if none is.
    """

    def work() -> int:
        hold_threads()
        drivetrain = read_drivetrain(scene, parse_settings(set_ or ()))
        share = parse_tolerance(tolerance)
        from fe_drivetrain.drivetrain_file.quantity_names import (
            check_reaction,
            is_turning,
            turning_names,
        )
        from fe_drivetrain.drivetrain_file.reading import with_sections

        if quantity and not is_turning(quantity, drivetrain):
            # before what computes it is loaded, which takes most of the time of a mistake
            check_reaction(quantity, with_sections(drivetrain, scene))
        loads = parse_loads(load or (), loads_of_drivetrain(drivetrain)) if load else None
        turning = turning_names(drivetrain, (quantity,) if quantity else (), loads)
        if turning:
            name, shown = turning[0], _of_turning(drivetrain, turning[0], share, to_the_top)
        else:
            found = with_sections(drivetrain, scene)
            name = quantity or f"{found.bearing_names[0]}.Fz"
            shown = _of_reactions(found, name, share, loads, to_the_top)
        title = f"{drivetrain.title}: the model level that {name} needs"
        from fe_drivetrain.elasticity.compiled_ahead import compiled_ahead

        with compiled_ahead(*(() if turning else ("meridian", "solver"))):
            return run_on_scene("advise", [scene], title, out, shown)

    raise typer.Exit(guarded(work))


def _of_turning(
    drivetrain: Drivetrain, name: str, tolerance: float, to_the_top: bool
) -> Shown[Any]:
    """The adviser for a frequency or a factor of gears; a name that is unknown is refused."""
    from fe_drivetrain.pages.advise_turning import show_advise_turning
    from fe_drivetrain.studies.turning_advice import advise_turning
    from fe_drivetrain.studies.turning_quantities import turning_quantity

    turning_quantity(drivetrain, name)
    return Shown(
        lambda run: advise_turning(drivetrain, name, tolerance, to_the_top, report=run.report),
        show_advise_turning,
    )


def _of_reactions(
    scene: Scene,
    name: str,
    tolerance: float,
    loads: Mapping[str, float] | None,
    to_the_top: bool,
) -> Shown[Any]:
    """The adviser for a reaction or a stiffness; a name that is unknown is refused."""
    from fe_drivetrain.pages.advise import show_advise
    from fe_drivetrain.studies.level_advice import advise

    return Shown(
        lambda run: advise(scene, name, tolerance, loads, to_the_top, report=run.report),
        show_advise,
    )


def loads_of_drivetrain(drivetrain: Drivetrain) -> tuple[str, ...]:
    """Names of loads that reactions may be asked under; none without sections of the main shaft.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    """
    from fe_drivetrain.drivetrain_file.scene import Scene
    from fe_drivetrain.shafts.response.model import scene_loads

    return tuple(scene_loads(drivetrain)) if isinstance(drivetrain, Scene) else ()


def run_on_scene(
    command: str,
    scenes: Sequence[str],
    title: str,
    out: Path | None,
    study: Shown[Any],
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
        Title of the page.
    out : Path or None
        The folder, where the user named one.
    study : Shown
        Makes the study, and fills the page.
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
    return show_outcome(results, page, study.result)


def _results_of_scene(
    command: str,
    scenes: Sequence[str],
    title: str,
    out: Path | None,
    study: Shown[Any],
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
