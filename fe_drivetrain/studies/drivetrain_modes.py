"""Natural modes of a drivetrain: frequencies, shapes, energy, and which excitations meet them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import ClassVar, NamedTuple

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file import Drivetrain, Scene
from fe_drivetrain.dynamics import (
    Level,
    Machine,
    Rung,
    Rungs,
    machine_of,
    machine_system,
    system_modes,
)
from fe_drivetrain.dynamics.bodies.damping_ratios import with_damping_ratios
from fe_drivetrain.dynamics.bodies.roller_matrices import asked_rungs
from fe_drivetrain.procedure import (
    BearingDefects,
    Excitation,
    bearing_defects,
    drivetrain_excitations,
)
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.machine_description import assume_housings
from fe_drivetrain.studies.mode_charts import campbell_chart, frequency_chart
from fe_drivetrain.studies.mode_findings import note_unknown, state_modes
from fe_drivetrain.studies.mode_levels import compared_levels, frequency_bands, named_rung
from fe_drivetrain.studies.mode_parts import described
from fe_drivetrain.studies.mode_record import Modes
from fe_drivetrain.studies.mode_speeds import in_operation
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.rotor_speeds import FARTHEST, check_speed, rated_speed

SHOWN = 16
"""Number of modes that are described, and whose shapes are kept."""
FIXED = 1e-6
"""Width of the range of a rotor of fixed speed, over that speed."""
PASSINGS = 3
"""Multiples of blade passing that excite: 3P, 6P and 9P of three blades."""


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class ModesResult(Modes, Result):
    """Natural modes of a drivetrain at one level, and how they stand to its excitations.

    Beside what `Result` has: ``frequencies``, ``bands``, ``kinds`` and ``words`` of all modes,
    ``kinetic`` and ``strain`` energy by part, ``shapes`` by body, ``running`` frequencies and
    ``damping``, ``campbell``, ``meetings`` of excitations with modes, ``ladder`` of levels.

    Attributes
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    machine : Machine
        Its bodies, shafts, stages and bearings.
    """

    STUDY: ClassVar[str] = "modes"
    SCHEMA_VERSION: ClassVar[int] = 1

    drivetrain: Drivetrain
    machine: Machine = field(repr=False)

    def chart(self) -> Chart:
        """Campbell diagram; the frequencies by kind where no speeds are known."""
        return frequency_chart(self) if self.speeds is None else campbell_chart(self)


def modes(
    drivetrain: Drivetrain,
    *,
    level: str | None = None,
    generator: str = "free",
    speeds: tuple[float, float] | None = None,
    speed: float | None = None,
    blades: int = 3,
    excitations: Sequence[Excitation] = (),
    tolerance: float = 0.05,
    condensed: bool = False,
    matrices: bool = False,
    catalogues: Sequence[str | Path] = (),
    report: Progress = silent,
) -> ModesResult:
    """Compute natural modes of a drivetrain, and which excitations meet them in operation.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain, with a rotor and a generator.
    level : str or None
        "torsional", "rigid" (bodies with six degrees of freedom) or "flexible" (shafts that bend);
        None for the finest that the data allow. The last two have the gearbox's housing on its
        mount where the file states one.
    generator : str
        "free" to turn, or "held".
    speeds : tuple of float or None
        Least and largest speed of the rotor in operation [rad/s]; None for ``rotor_speed`` of its
        operation. Where neither is known, excitations are left out.
    speed : float or None
        Speed of the rotor of the frequencies in operation [rad/s]; None for the largest.
    blades : int
        Number of blades of the rotor.
    excitations : sequence of Excitation
        Others beside those that follow from blades, planets, teeth and shafts, as a controller's.
    tolerance : float
        Relative error of a frequency that a simpler level may have.
    condensed : bool
        Whether levels are compared with those beyond, too, as far as the file states what they
        need: housings of main bearings at both bounds, carriers, the main shaft in its meridian;
        see `fe_drivetrain.dynamics.rungs_of`. Housings are meshed once.
    matrices : bool
        Whether the last level has gearbox bearings with a catalogue entry by the 6 x 6 stiffness of
        their rollers at rated torque, see `fe_drivetrain.dynamics.with_matrices`.
    catalogues : sequence of str or Path
        Bearing catalogues beside the program's own, for defect frequencies.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        An option is out of its range, or the drivetrain lacks data that the level needs; the
        message names them.
    """
    _check(generator, speeds, speed, blades, tolerance)
    for name, turns in (("range of operation", speeds and speeds[1]), ("rotor", speed)):
        if turns is not None:
            check_speed(name, turns, rated_speed(drivetrain), FARTHEST, "change it")
    found, steps = Findings(), Steps(report)
    found.seed = None
    found.about(drivetrain)
    machine = machine_of(drivetrain)
    acting = (*drivetrain_excitations(machine.stages, blades, PASSINGS), *excitations)
    plain = asked_rungs(drivetrain, machine, matrices=matrices).rungs
    asked = _Asked(plain, named_rung(level, plain, machine), generator == "held", tolerance)
    over = _speeds_of(drivetrain) if speeds is None else speeds
    rungs = None
    if condensed:
        rungs = asked_rungs(drivetrain, machine, condensed=True, matrices=matrices, steps=steps)
    defects, unknown = bearing_defects(machine, catalogues)
    record = _record(drivetrain, machine, asked, (acting, defects), over, speed, steps, rungs)
    assume_housings(found, asked.rung.assumes)
    if rungs is not None:
        _state_rungs(found, rungs, asked.rung)
    if asked.rung.level is not Level.TORSIONAL:
        _note_housings(found, drivetrain)
    state_modes(found, machine, record, SHOWN)
    note_unknown(found, unknown)
    options = {"level": level, "generator": generator, "speeds": over, "speed": speed}
    others = [one.name for one in excitations]
    return ModesResult(
        drivetrain=drivetrain,
        machine=machine,
        **vars(record),
        **found.frozen(
            steps.times,
            **options,
            blades=blades,
            excitations=others,
            tolerance=tolerance,
            condensed=condensed,
            matrices=matrices,
            catalogues=[Path(one).name for one in catalogues],
        ),
    )


def _note_housings(found: Findings, drivetrain: Drivetrain) -> None:
    """State that housings of main bearings are left out."""
    if isinstance(drivetrain, Scene) and drivetrain.bearing_units:
        found.note("Housings of the main bearings are rigid here: soft ones lower frequencies.")


def _state_rungs(found: Findings, rungs: Rungs, rung: Rung) -> None:
    """State what the condensed levels assume beside a rung, and what the file lacks for others."""
    assume_housings(found, [a for a in rungs.rungs[-1].assumes if a not in rung.assumes])
    rows = [{"level or part": name, "because": why} for name, why in rungs.left_out.items()]
    found.data("levels left out", rows)


class _Asked(NamedTuple):
    """Levels and state of the model, and the error that a simpler level may have."""

    plain: tuple[Rung, ...]
    rung: Rung
    held: bool
    tolerance: float


def _record(
    drivetrain: Drivetrain,
    machine: Machine,
    asked: _Asked,
    exciting: tuple[tuple[Excitation, ...], tuple[BearingDefects, ...]],
    speeds: tuple[float, float] | None,
    speed: float | None,
    steps: Steps,
    rungs: Rungs | None,
) -> Modes:
    """What is known of the modes."""
    with steps.step("modes at rest"):
        level, gives = asked.rung.level, asked.rung.flexible
        system = machine_system(machine, level, held_generator=asked.held, flexible=gives)
        if drivetrain.damping is not None:
            system = with_damping_ratios(machine, system, drivetrain.damping)
        solved = system_modes(system)
        own = described(machine, system, solved, SHOWN)
    with steps.step("levels"):
        finer = asked.plain if rungs is None else rungs.rungs
        answers, enough = compared_levels(machine, asked.held, asked.tolerance, finer)
    with steps.step("bands"):
        count = len(own.frequencies)
        bands = frequency_bands(machine, asked.plain, asked.rung, asked.held, count)
    acting, defects = exciting
    parts = solved.energy_shares
    striking = tuple(one for bearing in defects for one in bearing.excitations(parts))
    with steps.step("modes in operation"):
        running = in_operation(system, solved, (*acting, *striking), speeds, speed)
    names = {one.name for one in striking}
    by_defects = tuple(one for one in running.meetings if one.excitation in names)
    others = tuple(one for one in running.meetings if one.excitation not in names)
    running = replace(running, meetings=others)
    return Modes(
        level=level,
        bands=bands,
        speeds=speeds,
        excitations=acting,
        bearing_defects=defects,
        defects=striking,
        defect_meetings=by_defects,
        ladder=tuple(answers),
        enough=enough,
        tolerance=asked.tolerance,
        **vars(own),
        **vars(running),
    )


def _speeds_of(drivetrain: Drivetrain) -> tuple[float, float] | None:
    """Speeds of the rotor in operation by the file [rad/s]; those about a fixed one."""
    operation = drivetrain.operation
    if operation is None or operation.rotor_speed is None:
        return None
    low, high = operation.rotor_speed
    return low, max(high, low * (1.0 + FIXED))


def _check(
    generator: str,
    speeds: tuple[float, float] | None,
    speed: float | None,
    blades: int,
    tolerance: float,
) -> None:
    """Refuse options that are out of their range."""
    if generator not in ("free", "held"):
        raise InputError(f"generator is {generator!r} but must be free or held: change it")
    if speeds is not None and not 0.0 <= speeds[0] < speeds[1] < math.inf:
        raise InputError(
            f"speeds of the rotor are {speeds[0]:g} to {speeds[1]:g} rad/s but the least must be "
            "from 0 and the largest above it: change them"
        )
    if speed is not None and not 0.0 < speed < math.inf:
        raise InputError(
            f"speed of the rotor is {speed:g} rad/s, {30.0 / math.pi * speed:.6g} rpm, but must be "
            "above 0: change it"
        )
    if blades < 1:
        raise InputError(f"the rotor has {blades} blades but must have 1 at least: change it")
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"tolerance is {tolerance:g} but must be between 0 and 1: change it")
