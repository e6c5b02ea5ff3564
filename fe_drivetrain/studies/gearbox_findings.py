"""What lives of bearings say of the drivetrain's statics: levels, assumptions, the unrated."""

from __future__ import annotations

from collections.abc import Sequence

from fe_drivetrain.bearing_life.life.lubricants import VISCOSITY_INDEX
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.gearbox_bearings import MachineBearings
from fe_drivetrain.studies.life_sums import BearingLife
from fe_drivetrain.studies.life_tables import ENOUGH, enough
from fe_drivetrain.studies.machine_description import assume_housings

FLANGED = 0.01
"""Axial force on flanges over the largest load of the rollers from which on it is spoken of."""


def say_levels(found: Findings, lives: Sequence[BearingLife], machine: MachineBearings) -> None:
    """State which level of the drivetrain's statics is enough for the loads of its bearings.

    Parameters
    ----------
    found : Findings
        Takes the sentence.
    lives : sequence of BearingLife
        The bearings; those on rollers in equilibrium with the shaft have no levels.
    machine : MachineBearings
        Has the degrees of freedom of each level.
    """
    asked = [life for life in lives if life.levels]
    if not asked:
        return
    names = list(machine.degrees)
    cheapest, finest = names[0], names[-1]
    apart = {life.name: life.levels[cheapest] / life.levels[finest] - 1.0 for life in asked}
    most = max(apart, key=lambda name: abs(apart[name]))
    short = [life.name for life in asked if enough(life) != cheapest]
    sizes = f"{cheapest} ({machine.degrees[cheapest]} degrees of freedom)"
    text = (
        f"Loads of bearings by {finest} ({machine.degrees[finest]} degrees of freedom): with "
        f"{sizes} equivalent loads differ by {100 * abs(apart[most]):.2g} % at most ({most})"
    )
    if short:
        found.say(f"{text}; {finest} are needed for {', '.join(short)}, to {100 * ENOUGH:g} %.")
    else:
        found.say(f"{text}, so that these are enough, to {100 * ENOUGH:g} %.")


def name_unrated(found: Findings, machine: MachineBearings) -> None:
    """Name the bearings that have no catalogue entry.

    Parameters
    ----------
    found : Findings
        Takes the sentence.
    machine : MachineBearings
        Has them.
    """
    if machine.lacks is not None:
        found.note(f"Bearings of the gearbox are not rated: {machine.lacks}.")
    if names := [one.name for one in machine.unrated]:
        option = argument("LifeOptions.bearings", {names[0]: "ENTRY"})
        found.note(
            f"Not rated, for want of a catalogue entry: {', '.join(names)}. Name one under "
            f"'catalogue' in the drivetrain's file, or with {option}."
        )


def assume_reactions(
    found: Findings, lives: Sequence[BearingLife], machine: MachineBearings
) -> None:
    """State what the loads of bearings by reactions assume, and what they leave to flanges.

    Parameters
    ----------
    found : Findings
        Takes assumptions and cautions.
    lives : sequence of BearingLife
        The bearings.
    machine : MachineBearings
        Says what the gearbox's housing stands on.
    """
    asked = [life for life in lives if life.levels]
    if not asked:
        return
    names = ", ".join(life.name for life in asked)
    found.assume(
        "loads of gearbox bearings",
        "linear statics of each load step, all stiffnesses as stated, meshes without friction",
        "",
        f"no accelerations and no clearance; of {names}",
    )
    assume_housings(found, machine.assumes)
    found.assume("rings of gearbox bearings", "rigid", "", "no housing gives way")
    for life in asked:
        if life.bearing.planets:
            found.assume(
                f"{life.name}: planets",
                f"the mean over {life.bearing.path.repeats} azimuths of the carrier",
                "",
                f"each of {life.bearing.planets} equal planets; the outer ring turns",
            )
    if oil := next((life.bearing.oil for life in asked if life.bearing.oil is not None), None):
        of = oil.lubricant
        for name, value, unit in (
            ("temperature", of.temperature, "degC"),
            ("lubricant", of.viscosity_40, "mm2/s at 40 degC"),
            ("cleanliness", of.cleanliness, ""),
        ):
            stated = "assumed, not stated" if name in oil.assumed else "as stated"
            option = argument(f"LifeOptions.gearbox_{name}")
            found.assume(f"gearbox oil: {name}", value, unit, f"{stated}; {option}")
        if "viscosity index" in oil.assumed:
            found.assume("gearbox oil: viscosity index", VISCOSITY_INDEX, "-", "assumed: mineral")
    _flanges(found, asked)


def _flanges(found: Findings, lives: Sequence[BearingLife]) -> None:
    for life in lives:
        if life.flanges > FLANGED * life.limits.max_load:
            found.note(
                f"Bearing {life.name}: up to {1e-3 * life.flanges:.3g} kN of axial force are on "
                "rollers that carry none: flanges have it, or another bearing, and no life here "
                "counts it. Set the axial stiffness of the bearing to 0 where it floats."
            )
