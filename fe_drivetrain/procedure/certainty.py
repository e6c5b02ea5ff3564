"""Step 4: how certain the inputs of Table 4.7 are, and which of them a project does without.

PROTEST 2010, section 4.6.2.4: Table 4.7 lists the inputs of a drivetrain's model. Of the masses
alone is the certainty known there, 3 %.
"""

from __future__ import annotations

from collections.abc import Mapping

from fe_drivetrain.procedure.project import Inputs, InputValue, Project
from fe_drivetrain.procedure.tolerances import is_guess, is_vacuous, must_be_below, why_vacuous

TABLE_4_7 = (
    "mass of blades",
    "mass of drivetrain parts",
    "mass of tower",
    "inertia of drivetrain parts",
    "stiffness of blades",
    "stiffness of tower",
    "stiffness of shafts",
    "stiffness of meshes",
    "stiffness of gearbox mount",
    "damping of blades",
    "damping of tower",
    "damping of shafts",
    "damping of meshes",
)
"""Inputs of a drivetrain's model, as Table 4.7 has them."""

_BAND = "inputs.values: band"

_ITS_SYSTEMS = frozenset({"gearbox", "drivetrain"})


def row_of(name: str) -> str:
    """The input of Table 4.7 that a name is of: "stiffness of shafts: LSS" is one of its row.

    Parameters
    ----------
    name : str
        Name of an input of a project.
    """
    return name.partition(":")[0].strip()


def lacks_of_inputs(project: Project, spreads: Mapping[str, float]) -> list[str]:
    """What step 4 lacks, in sentences.

    Parameters
    ----------
    project : Project
        With that step.
    spreads : mapping of str to float
        Half width, as a share, of inputs that signals have determined.

    Returns
    -------
    list of str
    """
    step = project.inputs
    assert step is not None
    lacks = [] if step.values else ["no input is named: add some under values"]
    signals = {signal.name for signal in project.campaign.signals} if project.campaign else None
    for value in step.values:
        lacks += _of_value(value) + _of_spread(value, signals, spreads, _identified(project))
    if _ITS_SYSTEMS & set(project.systems):
        lacks += _of_table(step)
    return lacks


def _identified(project: Project) -> set[str]:
    """Inputs that step 6 is to determine."""
    rows = project.comparison.identified if project.comparison else ()
    return {name for one in rows for name in (one.stiffness_of, one.damping_of)}


def _of_value(value: InputValue) -> list[str]:
    """What a value lacks but its spread: number, unit, source."""
    lacks = []
    if value.value is None or not value.unit:
        lacks.append(f"{value.name!r} has no value with a unit: state value and unit")
    if value.known_by is None:
        lacks.append(f"{value.name!r} does not say how it is known: state known_by, as in weighing")
    elif value.known_by == "assumption":
        lacks.append(f"{value.name!r} is an assumption: measure or compute it, or waive it")
    if is_guess(value.source):
        lacks.append(
            f"{value.name!r} has the source {value.source!r}, which is a guess: name a document"
        )
    return lacks


def _of_spread(
    value: InputValue,
    signals: set[str] | None,
    spreads: Mapping[str, float],
    identified: set[str],
) -> list[str]:
    """What its spread lacks: it is stated, or signals have determined it."""
    if value.measured_by and signals is not None and value.measured_by not in signals:
        return [
            f"{value.name!r} is measured by {value.measured_by!r}, which is no signal of the "
            "campaign: add it there"
        ]
    if value.band is not None:
        why = why_vacuous(f"the band of {value.name!r}", value.band, _BAND)
        return [why] if why else []
    if not value.measured_by:
        return [
            f"{value.name!r} has no band, and no signal measures it: state either, or go back to "
            "step 2 for a model that does not need it"
        ]
    spread = spreads.get(value.name)
    if spread is None:
        why = "the channels that determine it are not there"
        if value.name not in identified:
            why = "nothing under identified of step 6 is named to be it: name it there"
        return [
            f"{value.name!r} has no band yet: {value.measured_by!r} is to measure it, and {why}"
        ]
    if is_vacuous(spread):
        return [
            f"{value.name!r}: the band of {100 * spread:.3g} % that {value.measured_by!r} leaves "
            "says nothing: record it for longer or more accurately, or state the band of a "
            f"document: {must_be_below(_BAND)}"
        ]
    return []


def _of_table(step: Inputs) -> list[str]:
    """Inputs of Table 4.7 that are neither stated nor waived, and waivers of others."""
    named = {row_of(value.name) for value in step.values}
    waived = [one.name for one in step.waived]
    lacks = [
        f"{name!r} of Table 4.7 is not stated: add it under values, or waive it with a reason"
        for name in TABLE_4_7
        if name not in named and name not in waived
    ]
    for one in step.waived:
        if one.name not in TABLE_4_7:
            lacks.append(
                f"{one.name!r} is waived but is no input of Table 4.7: use one of "
                f"{', '.join(TABLE_4_7)}"
            )
        elif one.name in named:
            lacks.append(f"{one.name!r} is stated and waived: take one of them out")
        if is_guess(one.reason):
            lacks.append(f"{one.name!r} is waived without a reason: state why under reason")
    return lacks
