"""Strength of a main shaft under load histories: static and fatigue safety of every section."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace
from typing import Any, ClassVar

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import ONE_RPM, RPM
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.jobs import mapped
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.shafts.response.entering import entering
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.rotor_speeds import rated_speed
from fe_drivetrain.studies.strength_answers import (
    JointAnswer,
    SectionAnswer,
    joint_answers,
    section_answers,
)
from fe_drivetrain.studies.strength_findings import safety_chart, state_findings
from fe_drivetrain.studies.strength_loading import StrengthLoading
from fe_drivetrain.studies.strength_options import HOURS, StrengthOptions
from fe_drivetrain.studies.strength_sections import StrengthShaft, stated_strength, strength_shaft
from fe_drivetrain.studies.strength_sums import StrengthSums, class_sums, file_sums
from fe_drivetrain.studies.torque_classes import Rows, torque_classes
from fe_drivetrain.turbine_loads.histories.sites import (
    HOURS_A_YEAR,
    Site,
    midpoint_edges,
    require_winds,
    rounded_wind,
)
from fe_drivetrain.turbine_loads.hub_loads.histories import LoadHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import Files, recorded_files, short_name

_MANY = 8  # files for which it pays to start processes


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class StrengthResult(Result):
    """Safety of a shaft's sections and joints.

    ``result.sections["step at x = 0.5 m"].fatigue`` is S_D, ``.static`` is S_F.

    Attributes
    ----------
    sections : Mapping[str, SectionAnswer]
        Each section that is rated, by name, from front to rear.
    joints : Mapping[str, JointAnswer]
        The flange and press fits.
    left_out : Mapping[str, str]
        Why other sections are not rated.
    hours : float
        Hours of the life that is assessed.
    varies : bool
        Whether loads vary: S_D is then over all cycles of the life; else as if they came for ever.
    stations, along : ndarray, (p,)
        Places along the shaft [m], and the largest equivalent nominal stress there [Pa].
    required : tuple of float
        Least S_D and S_F that the file asks for.
    """

    STUDY: ClassVar[str] = "strength"
    SCHEMA_VERSION: ClassVar[int] = 1

    sections: Mapping[str, SectionAnswer]
    joints: Mapping[str, JointAnswer]
    left_out: Mapping[str, str]
    hours: float
    varies: bool
    stations: Floats
    along: Floats
    required: tuple[float, float]

    def chart(self) -> Chart:
        """Safety of all sections over that required."""
        return safety_chart(list(self.sections.values()), self.required, self.varies)


def strength(
    scene: Drivetrain,
    loads: Files = (),
    site: Site | None = None,
    options: StrengthOptions | None = None,
    *,
    hub: Mapping[str, float] | None = None,
    spectrum: Sequence[Sequence[float]] | None = None,
    resume: bool = False,
    report: Progress = silent,
) -> StrengthResult:
    """Static and fatigue safety of a main shaft's sections, and of its joints.

    Parameters
    ----------
    scene : Drivetrain
        A scene that states ``strength``.
    loads : str, path, or sequence of these
        Files of hub loads.
    site : Site or None
        Whose winds weight the files; without one they repeat for ever.
    options : StrengthOptions or None
        Life, points, how files are read; None takes all defaults.
    hub : mapping of str to float, or None
        Constant loads of the hub about the front face, its weight in them, in place of files [N,
        N m].
    spectrum : sequence of sequence of float, or None
        Torque of the rotor [N m], hours and speed [rad/s] of classes beside the constant loads.
    resume : bool
        Take what an earlier run kept of files.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        The scene states no strength, nothing loads it, or a file cannot be read.
    """
    asked = StrengthOptions() if options is None else options
    files = recorded_files(loads)
    loading = StrengthLoading(files, site, hub, spectrum, resume)
    main = checked(scene, asked, loading)
    found, steps = Findings(), Steps(report)
    found.seed = None
    found.about(main)
    shaft = strength_shaft(main, asked, steps)
    with steps.step("loads of all sections"):
        parts = _parts(main, shaft, asked, loading, report)
    varies = bool(files) or spectrum is not None
    repeats, hours = _repeats(parts, loading, asked)
    sections = section_answers(shaft, parts, repeats, hours, varies)
    joints = joint_answers(shaft, parts)
    names = [short_name(file, files) for file in files]
    along = np.max([one.along for one in parts], axis=0)
    required = (shaft.stated.fatigue_safety, shaft.stated.static_safety)
    state_findings(found, shaft, sections, joints, (names, parts, repeats), hours, varies)
    stated = _plain(asked, loading, names)
    return StrengthResult(
        sections={one.name: one for one in sections},
        joints={one.name: one for one in joints},
        left_out=dict(shaft.left_out),
        hours=hours,
        varies=varies,
        stations=shaft.stations,
        along=along,
        required=required,
        **found.frozen(steps.times, **stated),
    )


def checked(scene: Drivetrain, options: StrengthOptions, loading: StrengthLoading) -> Scene:
    """The scene, with all refused that can be before any work is done.

    Parameters
    ----------
    scene : Drivetrain
        The drivetrain.
    options : StrengthOptions
        Choices of the study.
    loading : StrengthLoading
        Loads as asked for.

    Raises
    ------
    InputError
        See `strength`.
    """
    if not isinstance(scene, Scene):
        raise InputError(
            f"{scene.title!r} has a main shaft without sections: give shaft.sections, by which its "
            "stress is known"
        )
    stated_strength(scene)
    loading.check(options)
    loading.wrench()
    if loading.spectrum is not None:
        torque_classes(loading.spectrum, _rated_speed(options, scene))
    return scene


def _parts(
    scene: Scene,
    shaft: StrengthShaft,
    options: StrengthOptions,
    loading: StrengthLoading,
    report: Progress,
) -> list[StrengthSums]:
    """Sums of each file, or of each class of constant loads."""
    if loading.files:
        asked = _with_speed(options, scene)
        items = [
            (file, shaft.model, asked, shaft.content, loading.resume) for file in loading.files
        ]
        return list(mapped(file_sums, items, len(items) if len(items) >= _MANY else 1, report))
    wrench = loading.wrench()
    rows: Rows | None = loading.spectrum
    if rows is None:
        speed = _rated_speed(options, scene) or 0.0
        hours = HOURS if options.hours is None else options.hours
        rows = [(wrench[3], hours, speed)]
    found = []
    for torque, hours, speed in torque_classes(rows, _rated_speed(options, scene)):
        loads = wrench.copy()
        loads[3] = torque
        seconds = 3600.0 * hours
        turns = speed * seconds / (2.0 * np.pi)
        found.append(class_sums(shaft.model, _entered(scene, loads), turns, seconds))
    return found


def _rated_speed(options: StrengthOptions, scene: Scene) -> float | None:
    """Rated speed of the rotor [rad/s], as asked for or of the file."""
    rpm = options.rotor_speed_rpm
    return rated_speed(scene) if rpm is None else rpm * ONE_RPM


def _entered(scene: Scene, wrench: Floats) -> Floats:
    """(6 + 6 m,) constant loads as they enter, with the weights of load points."""
    time = np.arange(4.0)
    history = LoadHistory("constant", time, np.tile(wrench, (4, 1)), about="front face")
    return np.asarray(entering(scene, history).values[0])


def _with_speed(options: StrengthOptions, scene: Scene) -> StrengthOptions:
    """Choices with the rated speed of the file, where none is asked for."""
    rated = rated_speed(scene)
    if options.rotor_speed_rpm is not None or rated is None:
        return options
    return replace(options, rotor_speed_rpm=rated * RPM)


def _repeats(
    parts: Sequence[StrengthSums], loading: StrengthLoading, options: StrengthOptions
) -> tuple[Floats, float]:
    """How often each history comes in the life, and the hours of that."""
    seconds = np.array([one.seconds for one in parts])
    if loading.spectrum is not None or not loading.files:
        hours = float(seconds.sum()) / 3600.0
        asked = hours if options.hours is None else options.hours
        return np.full(len(parts), asked / hours if hours > 0.0 else 1.0), asked
    if loading.site is None:
        asked = HOURS if options.hours is None else options.hours
        return np.full(len(parts), 3600.0 * asked / float(seconds.sum())), asked
    winds = [one.wind for one in parts]
    require_winds(loading.files, winds)
    of = np.array([rounded_wind(wind) for wind in winds])
    speeds = np.unique(of)
    life = loading.site.years * HOURS_A_YEAR
    found = np.zeros(len(parts))
    for speed, share in zip(speeds, loading.site.shares(midpoint_edges(speeds)), strict=True):
        here = of == speed
        found[here] = share * life * 3600.0 / seconds[here].sum()
    return found, life


def _plain(
    options: StrengthOptions, loading: StrengthLoading, names: Sequence[str]
) -> dict[str, Any]:
    """What was asked for, as plain data."""
    hub, site, rows, channels = loading.hub, loading.site, loading.spectrum, options.channels
    return {name: getattr(options, name) for name in vars(options)} | {
        "channels": None if channels is None else channels.model_dump(mode="json"),
        "files": list(names),
        "site": None if site is None else asdict(site),
        "hub": None if hub is None else {name: float(value) for name, value in hub.items()},
        "spectrum": None if rows is None else [[float(x) for x in row] for row in rows],
    }
