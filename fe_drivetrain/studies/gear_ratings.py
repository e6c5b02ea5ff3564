"""Ratings of the gears of a drivetrain: load sharing, load over the face, safety, damage."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics.bodies.condensed_rungs import rungs_of
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.gear_answers import GearAnswer, LevelAnswer, MeshAnswer
from fe_drivetrain.studies.gear_findings import TORQUE_ALONE, gear_chart, state_findings
from fe_drivetrain.studies.gear_loads import GearLoading, check_loading, loads_of
from fe_drivetrain.studies.gear_losses import DrivetrainLosses, check_losses, drivetrain_losses
from fe_drivetrain.studies.gear_machine import GearTrain, gear_train
from fe_drivetrain.studies.gear_meshes import GearMesh, gear_meshes
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_spectra import TorqueSpectrum
from fe_drivetrain.studies.gear_stresses import MeshStresses
from fe_drivetrain.studies.loss_findings import state_losses
from fe_drivetrain.studies.rated_gears import GearRating
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.spline_findings import state_splines
from fe_drivetrain.studies.torque_classes import Rows, torque_classes
from fe_drivetrain.turbine_loads.histories.sites import Site
from fe_drivetrain.turbine_loads.hub_loads.recorded import Files, recorded_files, short_name


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class GearsResult(Result):
    """Ratings of gears, and how their loads are spread.

    ``result.gears["stage 1 sun"].contact_safety`` is a safety factor,
    ``result.meshes["stage 1 sun-planet"].spread.share`` the load sharing over a turn.

    Attributes
    ----------
    gears : Mapping[str, GearAnswer]
        Each flank of each gear that is given in full, by name.
    meshes : Mapping[str, MeshAnswer]
        Each mesh, by name.
    levels : tuple[LevelAnswer, ...]
        The ladder, from the simplest level to the finest.
    enough : str
        Cheapest level within the tolerance.
    torque : float
        Reference torque of the rotor [N m].
    hub : ndarray, (6,)
        Other loads of the hub at that torque [N, N m].
    spectrum : TorqueSpectrum or None
        Torques and turns of the life asked for; None where no speed of the rotor is known.
    hours : float
        Hours of the life asked for.
    level : str
        Level of the rating.
    asked : GearOptions
        Choices of the rating.
    site : Site or None
        Whose winds weight the files.
    varies : bool
        Whether the spectrum is one of several torques, not the reference torque for all hours.
    losses : DrivetrainLosses or None
        Efficiency, heat and torque at the generator; None where they are not asked for.
    """

    STUDY: ClassVar[str] = "gears"
    SCHEMA_VERSION: ClassVar[int] = 1

    gears: Mapping[str, GearAnswer]
    meshes: Mapping[str, MeshAnswer]
    levels: tuple[LevelAnswer, ...]
    enough: str
    torque: float
    hub: Floats
    spectrum: TorqueSpectrum | None
    hours: float
    level: str
    asked: GearOptions
    site: Site | None
    varies: bool
    losses: DrivetrainLosses | None

    def chart(self) -> Chart:
        """Safety factors of all gears with their limits; contact stresses without strength."""
        return gear_chart(self.gears, self.meshes, self.varies)


def gears(
    drivetrain: Drivetrain,
    torque: float | None = None,
    loads: Files = (),
    site: Site | None = None,
    options: GearOptions | None = None,
    *,
    hub: Mapping[str, float] | None = None,
    spectrum: Rows | None = None,
    resume: bool = False,
    report: Progress = silent,
) -> GearsResult:
    """Rate the gears of a drivetrain by ISO 6336 under its own spread of loads.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain; what its stages do not state of ``strength`` is not rated, and is named.
    torque : float or None
        Reference torque of the rotor [N m]; None takes that of the file's rated power and speed.
    loads : str, path, or sequence of these
        Files of hub loads, whose torque and other loads make the spectrum.
    site : Site or None
        Whose winds weight the files; without one they repeat for ever.
    options : GearOptions or None
        Level, numbers of azimuths and slices, hours; None takes all defaults.
    hub : mapping of str to float, or None
        Fx, Fy, Fz, My, Mz of the rotor at the shaft's front beside the torque, its weight in them
        [N, N m]; None is the rotor's weight alone.
    spectrum : sequence of sequence of float, or None
        Torque of the rotor [N m], hours and, where it differs, speed [rad/s] of each class.
    resume : bool
        Take spectra of files that an earlier run kept.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        The drivetrain has no gears, no torque is known, or options contradict each other.
    """
    asked = GearOptions() if options is None else options
    files = recorded_files(loads)
    loading = GearLoading(files, site, hub, spectrum, resume)
    found, steps = Findings(), Steps(report)
    found.seed = None
    found.about(drivetrain)
    train, meshes, left_out = prepared(drivetrain, torque, asked, loading)
    if asked.condensed:
        train = gear_train(drivetrain, asked, torque, rungs_of(drivetrain, steps=steps))
    stresses = {name: MeshStresses(mesh, train.conditions) for name, mesh in meshes.items()}
    with steps.step("torque spectrum"):
        given = loads_of(train, asked, loading, report)
    made = GearRating(train, asked, stresses, given, steps)
    levels, spreads = made.ladder()
    mesh_answers = made.mesh_answers(spreads)
    damage = made.damage()
    answers = made.gear_answers(mesh_answers, damage)
    enough = next(one.name for one in levels if one.difference <= asked.tolerance)
    losses = None
    if asked.losses:
        with steps.step("losses"):
            losses = drivetrain_losses(drivetrain, train, meshes, left_out, given, asked.lubricant)
    result: dict[str, Any] = {
        "gears": answers,
        "meshes": mesh_answers,
        "levels": levels,
        "enough": enough,
        "torque": train.torque,
        "hub": given.hub,
        "spectrum": given.spectrum,
        "hours": given.hours,
        "level": train.rung.name,
        "asked": asked,
        "site": site,
        "varies": given.varies,
        "losses": losses,
    }
    if given.alone:
        found.note(TORQUE_ALONE, first=True)
    if losses is not None:
        state_losses(found, losses)
    state_findings(found, train, left_out, result)
    state_splines(found, train, given.hub, given.weight)
    stated = _plain(asked, loading, torque)
    return GearsResult(**result, **found.frozen(steps.times, **stated))


def prepared(
    drivetrain: Drivetrain, torque: float | None, options: GearOptions, loading: GearLoading
) -> tuple[GearTrain, dict[str, GearMesh], dict[str, str]]:
    """What is rated, with all that can be refused before any work is done.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    torque : float or None
        Reference torque of the rotor [N m].
    options : GearOptions
        Choices of the rating.
    loading : GearLoading
        Loads as asked for.

    Returns
    -------
    train : GearTrain
        The machine, its reference torque and speed.
    meshes : dict of str to GearMesh
        Meshes that are rated.
    left_out : dict of str to str
        Why others are not.

    Raises
    ------
    InputError
        See `gears`.
    """
    check_loading(options, loading)
    train = gear_train(drivetrain, options, torque)
    if loading.spectrum is not None:
        torque_classes(loading.spectrum, train.conditions.speed)
    meshes, left_out = gear_meshes(train.machine, train.strengths)
    if options.losses:
        check_losses(drivetrain, train, options.lubricant)
    return train, meshes, left_out


def _plain(options: GearOptions, loading: GearLoading, torque: float | None) -> dict[str, Any]:
    """What was asked for, as plain data."""
    files, site, hub, spectrum = loading.files, loading.site, loading.hub, loading.spectrum
    channels = options.channels
    return {name: getattr(options, name) for name in vars(options)} | {
        "channels": None if channels is None else channels.model_dump(mode="json"),
        "torque": torque,
        "hub": None if hub is None else {name: float(value) for name, value in hub.items()},
        "files": [short_name(file, files) for file in files],
        "spectrum": None if spectrum is None else [[float(x) for x in row] for row in spectrum],
        "site": None if site is None else asdict(site),
    }
