"""The cheapest level of a drivetrain's ladder that is accurate enough for what turns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from time import perf_counter
from typing import ClassVar

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.progress import Progress, silent
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics import Asked, Operation, Rung, machine_of, rungs_of
from fe_drivetrain.dynamics.bodies.condensed_rungs import SOFT_SEATS, STIFF_SEATS
from fe_drivetrain.plots.figures import MINIMUM, error_range, error_traces
from fe_drivetrain.report.charts import chart
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.machine_description import assume_housings
from fe_drivetrain.studies.result import Result
from fe_drivetrain.studies.shown_units import in_large_unit, quantity_in_words
from fe_drivetrain.studies.stated_levels import Errors, state_level_errors
from fe_drivetrain.studies.turning_model import TurningModel, TurningQuantity
from fe_drivetrain.studies.turning_quantities import turning_quantity


@dataclass(frozen=True)
class RungValue:
    """A quantity at a level of the ladder.

    Attributes
    ----------
    rung : Rung
        The level: what moves and what gives.
    value : float or None
        Value of the quantity; None where the level has none.
    error : float
        Difference from the finest level, relative; infinite without a value.
    seconds : float
        Wall time of the value, with all that is condensed for it [s].
    """

    rung: Rung
    value: float | None
    error: float
    seconds: float


@dataclass(frozen=True)
class TurningLadder:
    """A quantity at all levels of a drivetrain.

    Attributes
    ----------
    quantity : TurningQuantity
        What was asked for.
    tolerance : float
        Allowed error, relative.
    levels : tuple of RungValue
        Levels from the simplest to the finest.
    own : float
        Error of the finest level, relative: its numerical uncertainty, and what both bounds of the
        main bearings' seats differ by, since it stands at one of them.
    chosen : int or None
        Number of the simplest level from which on all are within the tolerance; None where the
        finest may be off by more.
    """

    quantity: TurningQuantity
    tolerance: float
    levels: tuple[RungValue, ...]
    own: float
    chosen: int | None

    @property
    def finest(self) -> RungValue:
        """The finest level."""
        return self.levels[-1]

    def bound(self, number: int) -> float:
        """Error bound of a level: difference from the finest one and the own error of that."""
        return self.levels[number].error + self.own


@dataclass(frozen=True, eq=False, repr=False, kw_only=True)
class TurningAdvice(Result):
    """Levels of a drivetrain for a quantity of all that turns.

    Attributes
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    ladder : TurningLadder
        The quantity at each level; not part of the JSON.
    """

    STUDY: ClassVar[str] = "advise_turning"
    SCHEMA_VERSION: ClassVar[int] = 1

    drivetrain: Drivetrain
    ladder: TurningLadder

    @property
    def level(self) -> str | None:
        """Name of the cheapest level that is known to be within the tolerance, or None."""
        chosen = self.ladder.chosen
        return None if chosen is None else self.ladder.levels[chosen].rung.name

    def chart(self) -> Chart:
        """Error of each level over its time."""
        return _against_time(self.ladder)


def advise_turning(
    drivetrain: Drivetrain,
    quantity: str,
    tolerance: float = 0.01,
    solids: bool = False,
    *,
    report: Progress = silent,
) -> TurningAdvice:
    """Find the cheapest level that is accurate enough for a frequency, or for a factor of gears.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain, with a rotor and a generator.
    quantity : str
        Quantity that must be accurate, as "modes.torsional.1", "gears.stage 1 sun-planet.sharing"
        or "gears.stage 3 mesh.K_Hbeta".
    tolerance : float
        Allowed error, relative.
    solids : bool
        Whether the finest level has main shaft and carriers of finite elements, which takes
        minutes.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        The drivetrain has no such quantity; the message lists those that it has.
    """
    if not 0.0 < tolerance < 1.0:
        raise InputError(f"tolerance is {tolerance:g} but must be between 0 and 1: change it")
    asked = turning_quantity(drivetrain, quantity)
    found, steps = Findings(), Steps(report)
    found.seed = None
    found.about(drivetrain)
    rungs = rungs_of(drivetrain, solids=solids, steps=steps)
    ladder = turning_ladder(drivetrain, asked, rungs.rungs, tolerance, steps)
    _state(found, ladder)
    if rungs.left_out:
        lacking = "; ".join(f"{name} ({why})" for name, why in rungs.left_out.items())
        found.note(f"The ladder does not have: {lacking}.")
    assume_housings(found, ladder.finest.rung.assumes)
    options = {"quantity": quantity, "tolerance": tolerance, "solids": solids}
    return TurningAdvice(
        drivetrain=drivetrain, ladder=ladder, **found.frozen(steps.times, **options)
    )


def turning_ladder(
    drivetrain: Drivetrain,
    quantity: TurningQuantity,
    rungs: Sequence[Rung],
    tolerance: float,
    steps: Steps,
    reference: Asked | None = None,
) -> TurningLadder:
    """A quantity at all rungs of a drivetrain.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    quantity : TurningQuantity
        The quantity.
    rungs : sequence of Rung
        Rungs from the simplest level to the finest.
    tolerance : float
        Allowed error, relative.
    steps : Steps
        Times each level, and shows it while it runs.
    reference : Asked or None
        Machine whose modes number frequencies; None for this one at its finest level.

    Raises
    ------
    InputError
        The finest level has no value, or it is zero, which has no relative error.
    """
    numbered_by = finest_modes(drivetrain, rungs) if reference is None else reference
    if quantity.numbered:  # solved before the clocks start, so that no level pays for it
        steps.timed("modes of the finest level", lambda: numbered_by.modes)
    found, condensed = [], 0.0
    for rung in rungs:
        with steps.step(rung.name):
            start, condensed = perf_counter(), condensed + rung.seconds
            model = TurningModel(drivetrain, rung, numbered_by)
            value = quantity.of(model)
            found.append((rung, value, perf_counter() - start + condensed))
    finest = quantity.value(model)
    if finest == 0.0:
        raise InputError(f"{quantity.name} is zero, and has no relative error: ask for another")
    levels = tuple(
        RungValue(
            rung, value, float("inf") if value is None else abs(value / finest - 1.0), seconds
        )
        for rung, value, seconds in found
    )
    with steps.step("own error of the finest level"):
        own = quantity.own(model) / abs(finest) + _bounds(levels)
    return TurningLadder(quantity, tolerance, levels, own, _chosen(levels, own, tolerance))


def finest_modes(drivetrain: Drivetrain, rungs: Sequence[Rung]) -> Asked:
    """The machine at the finest rung, whose modes number frequencies.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    rungs : sequence of Rung
        Rungs from the simplest level to the finest, which its data allow.
    """
    return Asked(machine_of(drivetrain), rungs[-1], Operation(0.0))


def _bounds(levels: Sequence[RungValue]) -> float:
    """What both bounds of the seats differ by, relative to the upper; 0 without housings."""
    both = [one.value for one in levels if one.rung.name in (SOFT_SEATS, STIFF_SEATS)]
    if len(both) < 2 or both[0] is None or both[1] is None:
        return 0.0
    return abs(both[0] / both[1] - 1.0)


def _chosen(levels: Sequence[RungValue], own: float, tolerance: float) -> int | None:
    chosen = None
    for number in reversed(range(len(levels))):
        if not levels[number].error + own <= tolerance:
            break
        chosen = number
    return chosen


def level_rows(ladder: TurningLadder) -> list[Record]:
    """Each level as a record, with units in the keys.

    Parameters
    ----------
    ladder : TurningLadder
        The levels.
    """
    return [
        {
            "level": one.rung.name,
            f"value [{ladder.quantity.unit}]": one.value,
            "error relative to the last level [%]": None
            if one.value is None
            else 100.0 * one.error,
            "time [s]": one.seconds,
            "": "chosen" if number == ladder.chosen else "",
            "neglects": "; ".join(one.rung.neglects) or "nothing",
        }
        for number, one in enumerate(ladder.levels)
    ]


def _state(found: Findings, ladder: TurningLadder) -> None:
    """State the level that is enough, with its error, time and value."""
    name, share = quantity_in_words(ladder.quantity.name), f"{100 * ladder.tolerance:g}\u00a0%"
    number = len(ladder.levels) - 1 if ladder.chosen is None else ladder.chosen
    known, own = ladder.levels[number], formatted(100.0 * ladder.own, 2)
    finest, away = ladder.finest.rung.name, formatted(100.0 * known.error, 2)
    if ladder.chosen is None:
        verdict = f"Not known within {share}: the finest level, {finest}, may err by {own}\u00a0%."
    elif len(ladder.levels) == 1:
        verdict = f"The level {finest} is the only one that the file has data for."
    elif known is ladder.finest:
        verdict = f"The finest level, {finest}, is needed within {share}; it may err by "
        verdict += f"{own}\u00a0%."
    else:
        verdict = f"The level {known.rung.name} is enough within {share}: {away}\u00a0% from the "
        verdict += f"finest, {finest}."
    found.data("levels", level_rows(ladder))
    errors = Errors([one.error for one in ladder.levels], ladder.own)
    names = [one.rung.name for one in ladder.levels]
    state_level_errors(found, names, {ladder.quantity.name: errors})
    found.at_most(
        f"{ladder.quantity.name}: error of the level {known.rung.name}",
        ladder.bound(number),
        ladder.tolerance,
        why="the tolerance that was requested",
        source=f"the level {finest}, and its own error",
    )
    assert known.value is not None  # the finest has one, and so has one that is near it
    value, large = in_large_unit(known.value, ladder.quantity.unit)
    unit, band = "" if large == "-" else f" [{large}]", abs(value) * ladder.bound(number)
    found.found(f"{ladder.quantity.name}{unit}", value, band)
    figures = [
        found.value(f"{ladder.quantity.name}{unit}", value, band),
        found.value(
            "error of the level [%]",
            100.0 * known.error,
            100.0 * ladder.own,
            at_most=100.0 * ladder.tolerance,
        ),
        found.value("time of the level [s]", known.seconds),
        found.value("time of the finest level [s]", ladder.finest.seconds),
    ]
    found.answer(f"Which model is enough for {name} within {share}?", verdict, figures)
    if known.rung.neglects:
        found.say(f"It neglects {', '.join(known.rung.neglects)}.")


def _against_time(ladder: TurningLadder) -> Chart:
    levels = ladder.levels
    errors = [*(one.error for one in levels[:-1]), ladder.own]
    bands = [*([ladder.own] * (len(levels) - 1)), 0.0]
    names, seconds = [one.rung.name for one in levels], [one.seconds for one in levels]
    traces = error_traces(names, seconds, errors, ladder.tolerance, ladder.chosen, bands)
    enough = "none is accurate enough" if ladder.chosen is None else "the chosen one is enough"
    caption = f"Error of each level against its time, {enough}; bars: uncertainty of the finest"
    if min(errors) <= MINIMUM:
        caption += f"; errors of zero are drawn at {100 * MINIMUM:g} %"
    found = chart(caption, traces, x="time [s]", y="error [%]", logarithmic=("x", "y"))
    finite = [error for error in errors if error != float("inf")]
    found.figure["layout"]["yaxis"]["range"] = error_range(finite, ladder.tolerance, ladder.own)
    return found
