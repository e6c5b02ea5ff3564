"""A drivetrain in time: torque, speeds, forces of meshes and bearings, in events and operation."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from math import inf, nan
from pathlib import Path
from typing import Any

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.dynamics.bodies.catalogue_seats import main_names
from fe_drivetrain.dynamics.bodies.damping_ratios import first_mode_damping
from fe_drivetrain.dynamics.bodies.equations import equations_of_motion, spring_laws, steady
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import machine_of
from fe_drivetrain.dynamics.bodies.roller_matrices import asked_rungs
from fe_drivetrain.dynamics.time.integration import integrate
from fe_drivetrain.dynamics.time.machine_channels import Kind
from fe_drivetrain.procedure.drivetrain_events import EVENTS, BaseMoves, event_of
from fe_drivetrain.procedure.travelling_planets import (
    STAND,
    travels,
)
from fe_drivetrain.report.number_text import percent_text
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.machine_description import housings_in_words
from fe_drivetrain.studies.mode_levels import WORDS
from fe_drivetrain.studies.part_damage import PartUse
from fe_drivetrain.studies.stated_levels import Errors, state_level_errors
from fe_drivetrain.studies.torque_limits import note_limits, torque_limits
from fe_drivetrain.studies.transient_answers import Beside, state_answer
from fe_drivetrain.studies.transient_digest import (
    FileDigest,
    digests,
    driven,
    moving_under,
)
from fe_drivetrain.studies.transient_events import prepared_event, rated_of, values_of_file
from fe_drivetrain.studies.transient_findings import (
    judge_run,
    state_assumptions,
    state_bounds,
    state_figures,
)
from fe_drivetrain.studies.transient_histories import (
    BASE,
    OPERATION,
    OperationOptions,
    driving_options,
    spacing,
    state_base,
    takes_histories,
)
from fe_drivetrain.studies.transient_instants import ByInstant, by_instant
from fe_drivetrain.studies.transient_ladder import (
    QUANTITIES,
    cheapest_level,
    finest_band,
    level_error,
)
from fe_drivetrain.studies.transient_loads import design_loads
from fe_drivetrain.studies.transient_parts import (
    DAMAGE,
    DamageOptions,
    history_damage_rows,
    part_question,
    state_parts,
)
from fe_drivetrain.studies.transient_question import TransientQuestion, require_span
from fe_drivetrain.studies.transient_result import TransientResult
from fe_drivetrain.studies.transient_runs import (
    Extreme,
    LevelRun,
    Prepared,
    Samples,
    telling_torque,
    with_bands,
)
from fe_drivetrain.studies.transient_tables import (
    alternating_rows,
    digest_rows,
    equivalent_rows,
    extreme_rows,
    instant_rows,
    level_rows,
    over_files,
    spectrum_rows,
)
from fe_drivetrain.turbine_loads.hub_loads.base_history import BaseHistory
from fe_drivetrain.turbine_loads.hub_loads.recorded import Files, recorded_files, short_name

EVENT_NAMES = (OPERATION, *EVENTS)
"""Names of all events."""

SLOW = 2e-3
"""Damping ratio of the first mode below which swings need eighty periods to fall to a third."""

STEPS = (1e-7, 1.0)
"""Shortest and longest step of integration [s]."""

WINDOW = 60.0
"""Part of the first history in which levels and steps are compared [s]."""


def transient(
    drivetrain: Drivetrain,
    event: str,
    values: Mapping[str, float | str] | None = None,
    *,
    loads: Files = (),
    level: str | None = None,
    condensed: bool = False,
    matrices: bool = False,
    rollers: bool = False,
    quantity: Kind = "bearing",
    tolerance: float = 0.05,
    duration: float | None = None,
    step: float | None = None,
    backlash: float = 0.0,
    planets: str = STAND,
    options: OperationOptions | None = None,
    resume: bool = False,
    damage: DamageOptions | None = DAMAGE,
    report: Progress = silent,
) -> TransientResult:
    """Compute what a drivetrain does in an event, or in operation, by the cheapest level that is
    enough.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain, with rotor and generator; its brake, damping and operation where it has
        them.
    event : str
        "stop" (emergency stop with brake), "grid_loss", "dip" (of the voltage), "run_up", "offset"
        (of the generator or the gearbox), "base" (which moves), or "operation" under histories.
    values : Mapping[str, float or str], optional
        Values of the event other than its defaults, by name: see the classes of
        `fe_drivetrain.procedure.drivetrain_events`.
    loads : str, path, or sequence of these
        Histories of operation, or of the base's acceleration: files (.out, .outb, .csv,
        or of other programs), folders, patterns.
    level : str, optional
        "torsional", "rigid" or "flexible", or the name of a condensed level; all are run and
        compared where left out. All but the torsional one have the gearbox's housing on its mount
        where the file states one.
    condensed : bool
        Whether levels go on with what has to be condensed, see `fe_drivetrain.dynamics.rungs_of`:
        housings of main bearings at both bounds, carriers, the main shaft in its meridian.
    matrices : bool
        Whether the last level has gearbox bearings with a catalogue entry by the 6 x 6 stiffness of
        their rollers at rated torque, see `fe_drivetrain.dynamics.with_matrices`.
    rollers : bool
        Whether the last level has catalogued bearings on their rollers in each step, laminae and
        clearance, under histories.
    quantity : str
        For which the level has to be enough: "torque", "mesh", "bearing".
    tolerance : float
        Allowed error against the finest level.
    duration : float, optional
        End of the run, or how much of each history [s].
    step : float, optional
        Step of integration; what the event needs where left out [s].
    backlash : float
        Backlash of all meshes along their lines of action [m].
    planets : str
        "stand" at one azimuth, or "travel" with their carriers, in events at about rated speed.
    options : OperationOptions, optional
        How histories are read and counted.
    resume : bool
        Take digests of histories that an earlier run kept.
    damage : DamageOptions or None
        How damage of gears and bearings is counted; None leaves it out.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        The event, a value or a level is unknown or out of range, a rated value is missing, or the
        drivetrain does not have what the event needs.
    """
    require_known("event", event, EVENT_NAMES)
    require_known("quantity", quantity, tuple(QUANTITIES))
    if not 0.0 < tolerance < 1.0:
        raise InputError(
            f"{argument('tolerance')} is {tolerance:g} but must be between 0 and 1: change it"
        )
    stated = {**values_of_file(drivetrain, event), **(values or {})}
    by_histories = takes_histories(event, bool(loads))
    files = recorded_files(loads) if by_histories else []
    if not by_histories:  # said before a level is built
        if rollers:
            raise InputError(
                f"bearings are on their rollers under histories, not in {event}: leave rollers "
                f"out, or give {argument('loads')} with {OPERATION} or {BASE}"
            )
        happens = event_of(event, stated)
        if isinstance(happens, BaseMoves):
            happens.require_file()
    steps, machine = Steps(report), machine_of(drivetrain)
    rated = rated_of(drivetrain, backlash)
    named = None if level is None else WORDS.get(level)
    asking = {"condensed": condensed, "matrices": matrices, "rollers": rollers}
    rungs = asked_rungs(drivetrain, machine, **asking, steps=steps)
    asked = TransientQuestion(
        drivetrain,
        machine,
        event,
        stated,
        rated,
        rungs,
        level,
        asking,
        quantity,
        tolerance,
        duration,
        step,
        travels(event, planets, machine, named),
        part_question(drivetrain, machine, damage),
    )
    if by_histories:
        return _operated(asked, files, options or OperationOptions(), resume, steps)
    return _happened(asked, steps)


def _happened(asked: TransientQuestion, steps: Steps) -> TransientResult:
    """An event, at all levels that were asked for."""
    event = event_of(asked.event, asked.values)
    duration = asked.lasts(event)

    made: dict[str, Prepared] = {}

    def at(rung: Rung) -> Callable[[float | None], LevelRun]:
        counted, travels = asked.parts.counted, asked.travels
        found = prepared_event(asked.machine, asked.rated, event, duration, rung, counted, travels)
        made[rung.name], run = found
        return run

    found = _findings(asked)
    runs, number = _compared(asked, asked.levels(event.happens_at), at, asked.step, steps)
    run = runs[number]
    torque, instants = telling_torque(run.extremes), None
    if torque and asked.event == "stop":
        with steps.step("instants of the brake"):
            instants = by_instant(made[run.rung.name], event, torque, run.step)
    with steps.step("gears and bearings"):
        use = asked.parts.of_event(run, asked.rated.torque)
    return _result(
        asked, found, steps, runs, number, run.extremes, run.samples, {}, {}, instants, use
    )


def _compared(
    asked: TransientQuestion,
    levels: Sequence[Rung],
    at: Callable[[Rung], Callable[[float | None], LevelRun]],
    step: float | None,
    steps: Steps,
) -> tuple[list[LevelRun], int]:
    """Runs at all levels, the chosen and the finest with their bands; number of the chosen one."""
    require_span("step", step, STEPS)
    with steps.step("compiled loops"):
        _load_loops()
    runs, again = [], []
    names = [rung.name for rung in asked.rungs.rungs]
    for rung in levels:
        before = asked.rungs.rungs[: names.index(rung.name) + 1]
        condensed = sum(one.seconds for one in before)
        with steps.step(rung.name):
            again.append(at(rung))
            run = again[-1](step)
            runs.append(replace(run, seconds=run.seconds + condensed))
    number = cheapest_level(runs, asked.quantity, asked.tolerance)
    for k in sorted({number, len(runs) - 1}):
        with steps.step("longer steps"):
            runs[k] = with_bands(runs[k], again[k])
    return runs, number


def _load_loops() -> None:
    """Let compiled loops be there, so that the first level does not pay for them."""
    one = equations_of_motion([1.0], spring_laws([[1.0]], 1.0))
    integrate(one, steady([0.0]), 1.0, 1.0)


def _operated(
    asked: TransientQuestion,
    files: Sequence[Path],
    options: OperationOptions,
    resume: bool,
    steps: Steps,
) -> TransientResult:
    """Operation under histories, or on a base that they move, one by one."""
    if not files:
        raise InputError(
            f"operation needs histories: give {argument('loads')}, as in outputs/*.outb"
        )
    options = replace(
        driving_options(asked.event, asked.values, options, asked.travels),
        step=options.step if asked.step is None else asked.step,
        until=options.until if asked.duration is None else asked.duration,
    )
    require_span("duration", options.until, (0.0, inf))
    require_span("step", options.step, STEPS)
    first = options.sampled(files[0])
    if asked.step is None:
        options = replace(options, step=min(options.step, spacing(first)))
    options.require_spacing(first, files[0])
    hub = None if isinstance(first, BaseHistory) else first
    asked.parts.require_winds(files, nan if hub is None else hub.wind)
    window = min(WINDOW if options.until is None else options.until, WINDOW, first.seconds)
    counted = asked.parts.counted
    made: dict[str, Prepared] = {}

    def at(rung: Rung) -> Callable[[float | None], LevelRun]:
        of = made[rung.name] = Prepared(
            asked.machine,
            rung,
            asked.rated,
            hub_loads=hub is not None and hub.has_all,
            parts=counted,
        )
        moving = moving_under(of.of, first, asked.rated.slip)
        return lambda step: of.window(moving, options.step if step is None else step, window)

    found = _findings(asked)
    possible = list(Level) if hub is not None else BaseMoves.levels
    runs, number = _compared(asked, asked.levels(possible), at, options.step, steps)
    rung = runs[number].rung
    names = [short_name(path, files) for path in files]
    with steps.step("files"):
        begun, samples = driven(made[rung.name], first, options)
        rest = digests(
            files[1:],
            asked.machine,
            rung,
            asked.rated,
            options,
            resume,
            steps.report,
            counted,
        )
        of_files = dict(zip(names, [begun, *rest], strict=True))
    good = not any(one.not_converged for one in of_files.values())
    runs[number] = replace(runs[number], converged=runs[number].converged and good)
    extremes = over_files(of_files, runs[number])
    more = {
        "files": names,
        **{key: getattr(options, key) for key in ("skip", "step", "until")},
        "slopes": [float(slope) for slope in options.slopes],
    }
    found.data("equivalent_loads", equivalent_rows(of_files, extremes, options.slopes))
    found.data("duration_spectra", spectrum_rows(of_files, extremes))
    found.data("files", digest_rows(of_files, extremes))
    if moved := {name: one.base for name, one in of_files.items() if one.base is not None}:
        state_base(found, moved, asked.values)
    with steps.step("gears and bearings"):
        use = asked.parts.of_operation(of_files, files, runs[number], asked.rated.torque)
    if use is not None and (use.gears or use.bearings):
        found.data("file_damage", history_damage_rows(use, names))
    return _result(asked, found, steps, runs, number, extremes, samples, of_files, more, None, use)


def _findings(asked: TransientQuestion) -> Findings:
    found = Findings()
    found.seed = None
    found.about(asked.drivetrain)
    if asked.machine.not_given:
        found.note(
            "Bodies only turn, since the file does not state "
            f"{', '.join(asked.machine.not_given)}: there are no forces of bearings."
        )
    return found


def _result(
    asked: TransientQuestion,
    found: Findings,
    steps: Steps,
    runs: Sequence[LevelRun],
    number: int,
    extremes: Mapping[str, Extreme],
    samples: Samples,
    files: Mapping[str, FileDigest],
    more: Mapping[str, Any],
    instants: ByInstant | None,
    use: PartUse | None,
) -> TransientResult:
    """State what was found, and freeze it."""
    run = runs[number]
    kinds = [kind for kind in QUANTITIES if any(e.kind == kind for e in extremes.values())]
    errors = tuple(tuple(level_error(one, runs[-1], kind) for kind in kinds) for one in runs)
    imbalance = max([run.imbalance, *(one.imbalance for one in files.values())])
    limits = torque_limits(asked.drivetrain, extremes)
    found.data("extremes", extreme_rows(extremes, limits))
    found.data("levels", level_rows(runs, errors, number))
    of_kinds = {
        QUANTITIES[kind]: Errors([of[k].error for of in errors], finest_band(runs, kind))
        for k, kind in enumerate(kinds)
    }
    state_level_errors(found, [one.rung.name for one in runs], of_kinds)
    if asked.event == "offset":
        found.data("alternating", alternating_rows(run))
    if instants is not None:
        found.data("instants", instant_rows(instants))
    judge_run(found, asked.event, run, imbalance, asked.rated)
    state_assumptions(found, asked.event, asked.values, asked.drivetrain, run.rung)
    state_bounds(found, runs, asked.rungs.left_out)
    loads = design_loads(asked.event, extremes, main_names(asked.machine))
    state_figures(found, extremes, run, loads)
    damping = first_mode_damping(asked.machine, asked.rated.damping)
    if damping < SLOW:
        found.note(
            f"Swings hardly decay: the first mode's damping ratio is {percent_text(damping)} by "
            "the ratios of each shaft and mesh between its own two bodies."
        )
    note_limits(found, limits, extremes)
    beside = Beside(instants, use, limits)
    state_answer(found, asked.event, extremes, run, runs, number, files, asked.quantity, beside)
    found.note(housings_in_words(run.rung, asked.machine))
    if use is not None:
        state_parts(found, use, asked.parts, run.rung.level)
    return TransientResult(
        event=asked.event,
        level=run.word,
        runs=tuple(runs),
        errors=errors,
        quantity=asked.quantity,
        tolerance=asked.tolerance,
        extremes=extremes,
        marks=run.marks,
        imbalance=imbalance,
        samples=samples,
        files=files,
        by_instant=instants,
        parts=use,
        **found.frozen(steps.times, **{**asked.plain(), **more}),
    )
