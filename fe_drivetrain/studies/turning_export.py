"""All that turns of a drivetrain for other programs: what is written, and what is left out."""

from __future__ import annotations

from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.drivetrain_file import Component, Drivetrain
from fe_drivetrain.dynamics import machine_of
from fe_drivetrain.export.turning import Turning, turning_of
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import bars
from fe_drivetrain.report.number_text import certain_value
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.mode_levels import named_level

STATES = ("free", "held")
"""Whether the generator turns."""


def turning_content(
    drivetrain: Drivetrain | Component, level: int | str | None, generator: str
) -> Turning:
    """The matrices that are written.

    Parameters
    ----------
    drivetrain : Drivetrain or Component
        A drivetrain; a component is refused.
    level : str or None
        "torsional", "rigid" or "flexible"; None for the finest that the data allow.
    generator : str
        "free" to turn, or "held".

    Raises
    ------
    InputError
        It is a component, an option is unknown, or the drivetrain lacks data.
    """
    if not isinstance(drivetrain, Drivetrain):
        raise InputError(
            f"all that turns is of a drivetrain, and {drivetrain.title!r} is a component: name a "
            "drivetrain"
        )
    require_known("generator", generator, STATES)
    number = named_level(None if level is None else str(level), machine_of(drivetrain))
    return turning_of(drivetrain, number, generator == "held")


def state_turning(found: Findings, drivetrain: Drivetrain, turning: Turning) -> None:
    """State what the matrices hold, the one spring beside them, and what is in neither.

    Parameters
    ----------
    found : Findings
        Takes figures, tables and the answer.
    drivetrain : Drivetrain
        What it is of.
    turning : Turning
        The matrices.
    """
    one = turning.spring
    found.say(
        f"{', '.join(turning.matrices)} of {len(turning.names)} degrees of freedom, "
        f"level {turning.options['level']}, generator {turning.options['generator']}"
    )
    found.data("origin", turning.source())
    found.data("degrees of freedom", list(turning.names))
    figures = [
        found.value("DTTorSpr [N m/rad]", one.torsion.spring),
        found.value("DTTorDmp [N m s/rad]", one.torsion.damper),
        found.value("first torsional frequency, free-free [Hz]", one.free),
        found.value("first torsional frequency, generator held [Hz]", one.held),
        found.value("one spring, free-free [Hz]", one.free_of_two),
        found.value("degrees of freedom", len(turning.names)),
    ]
    for name, value in turning.spring_record().items():
        found.found(name, value)
    found.note(f"Not in the model: {turning.not_here}.")
    if drivetrain.damping is None and not turning.damping.any():
        found.note(
            "The file states no damping, so that DTTorDmp and the damping matrix are 0: give "
            "damping: {shafts: ..., meshes: ...}."
        )
    found.say(
        "One spring with the inertias of rotor and generator alone has its first frequency at "
        f"{one.free_of_two / one.free:.4g} times that of the whole, free-free, and a damping ratio "
        f"of {100.0 * one.ratio:.3g} %."
    )
    found.assume_all(turning.machine.assumptions())
    _answer(found, drivetrain, figures)


def _answer(found: Findings, drivetrain: Drivetrain, figures: list[KeyFigure]) -> None:
    spring, _, free, held, *_ = figures
    found.answer(
        f"What do other programs take of all that turns in {drivetrain.title}?",
        f"Its torsion is one spring of {certain_value(spring)}; the whole swings at "
        f"{certain_value(free)}, with the generator held at {certain_value(held)}.",
        figures,
    )


def turning_chart(turning: Turning) -> Chart:
    """First torsional frequencies of the whole and of the one spring."""
    one = turning.spring
    groups = {
        "whole drivetrain": {"free-free": one.free, "generator held": one.held},
        "one spring": {"free-free": one.free_of_two, "generator held": one.held_of_two},
    }
    return bars("First torsional frequency", groups, "frequency [Hz]")
