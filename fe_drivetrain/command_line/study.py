"""The command ``study``: K_R and reactions of a scene over hub loads, and beams against FE."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.options import (
    Mapping,
    SceneName,
    Scheduler,
    Skip,
    Slopes,
    with_options,
)
from fe_drivetrain.command_line.run import Quick
from fe_drivetrain.command_line.settings import SceneSettings, parse_settings
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.studies import OutFolder, run_on_scene
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import named_scene
from fe_drivetrain.report.suite.ownership import check_result_folder

if TYPE_CHECKING:
    from fe_drivetrain.drivetrain_file.scene import Scene
    from fe_drivetrain.studies.study_loads import StudyLoads


@dataclass(frozen=True)
class StudyRequest:
    """Arguments and options of ``study`` as typed; each help text says what one is."""

    scene: SceneName
    loads: Annotated[
        list[str] | None,
        typer.Option(
            "--loads",
            metavar="FILES",
            help="Hub loads: a file (.out, .outb, .csv, or of other programs), a folder, or a "
            "pattern in "
            "quotes, as in 'outputs/*.outb'. May be repeated. Default: a surrogate of a generic "
            "2 MW rotor.",
        ),
    ] = None
    skip: Skip = 0.0
    mapping: Mapping = None
    slope: Slopes = None
    weight: Annotated[
        bool,
        typer.Option(
            "--weight/--no-weight",
            help="Whether reactions have the weight of gearbox, shaft, bearings and housings.",
        ),
    ] = True
    quick: Quick = False
    scheduler: Scheduler = None
    out: OutFolder = None
    set_: SceneSettings = None

    def slopes(self) -> tuple[float, ...]:
        """Slopes of S-N curves.

        Raises
        ------
        InputError
            One of them is out of range.
        """
        from fe_drivetrain.turbine_loads.histories.damage import SLOPES, check_slope

        for exponent in self.slope or ():
            check_slope(exponent)
        return tuple(self.slope or SLOPES)

    def own_loads(self, scene: Scene) -> StudyLoads | None:
        """The user's hub loads; None without any.

        Parameters
        ----------
        scene : Scene
            Says which point of the shaft they are about.

        Raises
        ------
        InputError
            A file cannot be read, or an option of files stands without any.
        """
        from fe_drivetrain.studies.study_loads import own_loads
        from fe_drivetrain.turbine_loads.hub_loads.channel_map import read_channel_map

        if self.loads is not None:
            names = None if self.mapping is None else read_channel_map(self.mapping)
            return own_loads(self.loads, self.skip, scene, names)
        if self.skip:
            raise InputError(
                f"--skip {self.skip:g} leaves out the beginning of your own files, and there are "
                "none: give them with --loads, or leave --skip out"
            )
        if self.mapping is not None:
            raise InputError("--mapping says how files call their channels: give --loads, too")
        return None


@with_options(StudyRequest)
def study_command(context: typer.Context, asked: StudyRequest) -> int:
    """Study any scene over hub loads: K_R of its bearing units, reactions, beams against FE.

    Solves the assembly of solids and the cheaper levels for unit loads; the reactions of every load
    step are then one matrix product, now and for other loads later. Of your own files the reactions
    are also written as CSV, with the weight of all parts. Histories may differ in length and step.

    The exit status is 0 if every check passes.
    """
    hold_threads()
    check_result_folder(asked.out or Path("reports", "study", Path(asked.scene).stem))
    scene = named_scene(asked.scene, parse_settings(asked.set_ or ()))
    from fe_drivetrain.elasticity.compiled_ahead import compiled_ahead

    with compiled_ahead("solver", "meridian"):
        return _studied(asked, scene)


def _studied(asked: StudyRequest, scene: Scene) -> int:
    """Study a scene and print the outcome; the exit status."""
    from fe_drivetrain.command_line.study_files import write_study
    from fe_drivetrain.pages.study import show_study
    from fe_drivetrain.studies.scene_study import study

    # before the work: a fault in a file is reported at once
    slopes, own = asked.slopes(), asked.own_loads(scene)
    histories = () if own is None else own.histories
    return run_on_scene(
        "study",
        [asked.scene],
        f"{scene.title}: stiffness, reactions, and beams against FE",
        asked.out,
        Shown(
            lambda run: study(scene, own, slopes, asked.weight, run.quick, report=run.report),
            show_study,
            lambda run, page, result: write_study(run, page, result, histories),
            draws=True,
        ),
        asked.quick,
        asked.scheduler,
    )
