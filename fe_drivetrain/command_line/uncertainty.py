"""The command ``uncertainty``: what uncertain values of a scene do to its results."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Annotated

import typer

from fe_drivetrain.command_line.options import SceneName, Scheduler, left_out, with_options
from fe_drivetrain.command_line.settings import (
    Loads,
    SceneSettings,
    Tolerance,
    parse_loads,
    parse_settings,
    parse_tolerance,
)
from fe_drivetrain.command_line.showing import Shown
from fe_drivetrain.command_line.studies import OutFolder, loads_of_drivetrain, run_on_scene
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.threads import hold_threads
from fe_drivetrain.drivetrain_file.named_scenes import read_drivetrain

if TYPE_CHECKING:
    from fe_drivetrain.report.suite.run import Run
    from fe_drivetrain.studies.input_uncertainty import UncertaintyResult


@dataclass(frozen=True)
class UncertaintyRequest:
    """Arguments and options of ``uncertainty`` as typed; each help text says what one is."""

    scene: SceneName
    quantity: Annotated[
        list[str] | None,
        typer.Option(
            "--quantity",
            metavar="NAME",
            help="A quantity for which the model level must be accurate, as in main_bearing.My; it "
            "is reported in addition to every stiffness. Or one of all that turns, as in "
            "modes.torsional.1. May be repeated. Default: hub.stiffness.uz.",
        ),
    ] = None
    load: Loads = None
    tolerance: Tolerance = "5%"
    level: Annotated[
        str | None,
        typer.Option(
            "--level",
            metavar="LEVEL",
            help="Sample level 1 (beam) or 2 (meridian) without running the adviser; for modes and "
            "gears torsional, rigid or flexible. The assembly of solids is then not solved, and "
            "the model error is known only as bounds. Or sample level 4, the assembly itself, for "
            "reactions and stiffnesses at the hub: seconds a sample.",
        ),
    ] = None
    samples: Annotated[
        int,
        typer.Option(
            "--samples",
            metavar="COUNT",
            min=40,
            max=100_000,
            help="Number of samples of the Latin hypercube.",
        ),
    ] = 128
    seed: Annotated[
        int, typer.Option("--seed", metavar="NUMBER", min=0, help="Seed of all random samples.")
    ] = 0
    sobol: Annotated[
        bool,
        typer.Option(
            "--sobol",
            help="Also estimate Sobol indices (shares of the variance). This takes N (k + 2) "
            "evaluations, N the largest power of two up to --samples, k the number of uncertain "
            "values.",
        ),
    ] = False
    scheduler: Scheduler = None
    out: OutFolder = None
    set_: SceneSettings = None


@with_options(UncertaintyRequest)
def uncertainty_command(context: typer.Context, asked: UncertaintyRequest) -> int:
    """Propagate the uncertainty of a scene's values to its reactions and stiffnesses.

    The scene states under 'uncertainty' how each uncertain value is distributed. The adviser finds
    the cheapest model level that is accurate enough; sensitivities and the 95 % band of each
    result, from a Latin hypercube, are computed at that level and compared with its own error.

    The exit status is 0 if the level is known to be within the tolerance, 1 if not.
    """
    hold_threads()
    scene = read_drivetrain(asked.scene, parse_settings(asked.set_ or ()))
    from fe_drivetrain.pages.uncertainty import show_uncertainty
    from fe_drivetrain.studies.input_uncertainty import uncertainty

    loads = parse_loads(asked.load or (), loads_of_drivetrain(scene))
    share = parse_tolerance(asked.tolerance)
    level = int(asked.level) if asked.level and asked.level.lstrip("-").isdecimal() else asked.level
    if asked.level is not None and not left_out(context, "tolerance"):
        raise InputError(
            f"--tolerance {asked.tolerance} is for the adviser, which --level {asked.level} leaves "
            "out: give one of the two"
        )

    def study(run: Run) -> UncertaintyResult:
        return uncertainty(
            scene,
            tuple(asked.quantity or ()),
            loads,
            share,
            level,
            asked.samples,
            asked.seed,
            asked.sobol,
            report=run.report,
        )

    return run_on_scene(
        "uncertainty",
        [asked.scene],
        f"{scene.title}: uncertainty of the results",
        asked.out,
        Shown(study, show_uncertainty),
        scheduler=asked.scheduler,
    )
