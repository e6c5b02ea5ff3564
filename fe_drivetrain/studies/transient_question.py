"""What is asked of a drivetrain in time: its levels, its event, and how long it lasts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from math import inf
from typing import Any

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics.bodies.advice import RUNGS, Rung
from fe_drivetrain.dynamics.bodies.condensed_rungs import Rungs
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.dynamics.time.machine_channels import Kind
from fe_drivetrain.procedure.drivetrain_events import Event
from fe_drivetrain.procedure.travelling_planets import STAND, TRAVEL
from fe_drivetrain.studies.mode_levels import WORDS, named_rung
from fe_drivetrain.studies.transient_parts import PartQuestion
from fe_drivetrain.studies.transient_runs import Rated

LONGEST = 3600.0
"""Longest event [s]."""


@dataclass(frozen=True)
class TransientQuestion:
    """What is asked of a drivetrain in time.

    Attributes
    ----------
    drivetrain, machine : Drivetrain, Machine
        The drivetrain, and what of it moves.
    event, values : str, dict
        Name of the event, and those of its values that are stated.
    rated : Rated
        Rated values.
    rungs : Rungs
        Levels that the drivetrain has.
    level : str or None
        The one that is asked for; None for all.
    asking : dict of str to bool
        Which further levels were asked for, by their option.
    quantity, tolerance : Kind, float
        For which the level has to be enough, and within which share.
    duration, step : float or None
        End of the run and step of integration [s]; None for what the event needs.
    travels : bool
        Whether planets travel with their carriers.
    parts : PartQuestion
        How gears and bearings are counted.
    """

    drivetrain: Drivetrain
    machine: Machine
    event: str
    values: dict[str, float | str]
    rated: Rated
    rungs: Rungs
    level: str | None
    asking: dict[str, bool]
    quantity: Kind
    tolerance: float
    duration: float | None
    step: float | None
    travels: bool
    parts: PartQuestion

    def levels(self, possible: Sequence[Level]) -> list[Rung]:
        """Levels to run.

        Parameters
        ----------
        possible : Sequence[Level]
            At which the event can happen.

        Raises
        ------
        InputError
            None of them can be run, or the one that is asked for is not possible.
        """
        every = self.rungs.rungs
        if self.level is None:
            found = [rung for rung in every if rung.level in possible]
            if not found:
                raise InputError(
                    f"event {self.event} needs all motions of {self.machine.title!r}, whose file "
                    f"does not state {', '.join(self.machine.not_given)}: add it"
                )
            return found
        if self.level in WORDS and WORDS[self.level] not in possible:
            words = [word for word, one in WORDS.items() if one in possible]
            having = " with its values" if self.values else ""
            raise InputError(
                f"event {self.event}{having} does not happen at the level {self.level}: choose "
                f"one of {', '.join(words)}"
            )
        return [named_rung(self.level, every, self.machine)]

    def plain(self) -> dict[str, Any]:
        """All of it as plain data."""
        return {
            "event": self.event,
            "values": self.values,
            "rated": self.rated.plain(),
            "level": self.level,
            **self.asking,
            "quantity": self.quantity,
            "tolerance": self.tolerance,
            "duration": self.duration,
            "step": self.step,
            "planets": TRAVEL if self.travels else STAND,
        }

    def lasts(self, event: Event) -> float:
        """How long the run of an event is [s].

        Parameters
        ----------
        event : Event
            What happens.

        Raises
        ------
        InputError
            The duration that was asked for is out of its range.
        """
        if self.duration is None:
            return event.lasts(self.rated.running(self.machine, RUNGS[0]))
        require_span("duration", self.duration, (0.0, LONGEST))
        return self.duration


def require_span(name: str, value: float | None, within: tuple[float, float]) -> None:
    """Refuse a time that is out of its range.

    Parameters
    ----------
    name : str
        Name of the argument.
    value : float or None
        The time [s]; None is in every range.
    within : tuple of float
        Least and longest [s]; a least of 0 is not in the range itself.

    Raises
    ------
    InputError
        It is out of its range.
    """
    low, high = within
    if value is None or (low <= value <= high and value > 0.0):
        return
    least = f"from {low:g}" if low else "above 0 s"
    most = "" if high == inf else f" to {high:g} s" if low else f" and at most {high:g} s"
    raise InputError(f"{argument(name)} is {value:g} s but must be {least}{most}: change it")
