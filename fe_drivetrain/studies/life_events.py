"""Lives of bearings with events that come so many times a year, as `transient` has them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.bearing_life.life.roller_damage import KINDS
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.common.progress import Progress
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.procedure.drivetrain_events import EVENTS
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.drivetrain_transient import transient
from fe_drivetrain.studies.life_options import LifeOptions
from fe_drivetrain.studies.life_sums import BearingLife
from fe_drivetrain.studies.part_damage import PartUse
from fe_drivetrain.studies.transient_events import rated_of
from fe_drivetrain.studies.transient_parts import DamageOptions
from fe_drivetrain.turbine_loads.histories.sites import Site

_MOST = 1e6


@dataclass(frozen=True, eq=False)
class LifeEvent:
    """An event of the drivetrain that comes so many times a year.

    Attributes
    ----------
    name : str
        Name of the event, as `transient` has it.
    a_year : float
        How often it comes.
    use : PartUse
        What it does to bearings once.
    """

    name: str
    a_year: float
    use: PartUse

    __repr__ = short_repr

    def damage(self, bearing: str, kind: str) -> float:
        """Damage of a year; 0 of a bearing without forces there."""
        one = self.use.bearings.get(bearing)
        return 0.0 if one is None else self.a_year * one.damage[kind]


def check_events(drivetrain: Drivetrain, events: Mapping[str, float]) -> None:
    """Refuse events that there are not, that come no times, or that need what the file lacks.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    events : Mapping[str, float]
        How often each comes in a year.

    Raises
    ------
    InputError
        See above.
    """
    if events:
        rated_of(drivetrain)
    for name, count in events.items():
        require_known("event", name, tuple(EVENTS))
        if not 0.0 < count <= _MOST:
            raise InputError(
                f"{argument('events', {name: count})}: an event comes {count:g} times a year but "
                f"must come more than 0 and at most {_MOST:g} times: change it"
            )


def life_events(
    drivetrain: Drivetrain, options: LifeOptions, events: Mapping[str, float], report: Progress
) -> tuple[LifeEvent, ...]:
    """What each event does to the bearings once, on flexible shafts, rollers in equilibrium.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain, with rotor, generator and operation.
    options : LifeOptions
        Bearings, lubricants and rules.
    events : Mapping[str, float]
        How often each comes in a year.
    report : Progress
        Called with the name of each step as it begins.

    Raises
    ------
    InputError
        The drivetrain does not have what an event needs.
    """
    damage = DamageOptions(options, rollers=True)
    return tuple(
        LifeEvent(name, count, found.parts)
        for name, count in events.items()
        if (
            found := transient(drivetrain, name, level="flexible", damage=damage, report=report)
        ).parts
        is not None
    )


def years_with(life: BearingLife, events: Sequence[LifeEvent]) -> dict[str, float]:
    """Lives [years] of each kind with the damage of all events beside that of the histories.

    Parameters
    ----------
    life : BearingLife
        The bearing under histories alone.
    events : sequence of LifeEvent
        All events.
    """
    found = {}
    for kind in KINDS:
        whole = 1.0 / life.years[kind] + sum(one.damage(life.name, kind) for one in events)
        found[kind] = 1.0 / whole if whole else np.inf
    return found


def event_rows(lives: Sequence[BearingLife], events: Sequence[LifeEvent]) -> list[Record]:
    """A row for each bearing: lives without and with events, and what each of them takes."""
    rows: list[Record] = []
    for life in lives:
        years = years_with(life, events)
        row: Record = {"bearing": life.name, "L10mr without events [years]": life.years["L10mr"]}
        row |= {f"{kind} with events [years]": years[kind] for kind in KINDS}
        for one in events:
            name = f"{one.a_year:g} {one.name.replace('_', ' ')} a year"
            row[f"damage of a year by {name}, L10mr"] = one.damage(life.name, "L10mr")
            use = one.use.bearings.get(life.name)
            row[f"S0 in {one.name.replace('_', ' ')}"] = None if use is None else use.static_safety
        rows.append(row)
    return rows


def state_events(
    found: Findings,
    lives: Sequence[BearingLife],
    events: Sequence[LifeEvent],
    site: Site | None,
) -> list[KeyFigure]:
    """State lives with events, and the shortest of them as a key figure; none without events.

    Parameters
    ----------
    found : Findings
        Takes table, figures and sentences.
    lives : sequence of BearingLife
        The bearings under histories alone.
    events : sequence of LifeEvent
        All events.
    site : Site or None
        Whose years are asked for.
    """
    if not events:
        return []
    found.data("events", event_rows(lives, events))
    with_all = {life.name: years_with(life, events)["L10mr"] for life in lives}
    for name, years in with_all.items():
        found.found(f"L10mr of bearing {name} with events [years]", years)
    shortest = min(with_all, key=lambda name: with_all[name])
    words = " and ".join(f"{one.a_year:g} {one.name.replace('_', ' ')}" for one in events)
    found.say(
        f"With {words} a year, as `transient` has them, bearing {shortest} lives "
        f"{value_text(with_all[shortest], 'years')} (L10mr), the shortest."
    )
    if lacking := [life.name for life in lives if not _in_all(life, events)]:
        found.note(f"Events have no forces of {', '.join(lacking)}: their lives are without them.")
    name = f"L10mr of bearing {shortest} with events [years]"
    if site is None:
        return [found.value(name, with_all[shortest])]
    years = site.years
    return [found.value(name, with_all[shortest], at_least=years, by="design life")]


def _in_all(life: BearingLife, events: Sequence[LifeEvent]) -> bool:
    return all(life.name in one.use.bearings for one in events)
