"""What a reader of ``life`` has to know first: where methods end, and what safety is left."""

from __future__ import annotations

from collections.abc import Sequence

from fe_drivetrain.commands.life_sections import BearingLife
from fe_drivetrain.life.limits import centrifugal_load
from fe_drivetrain.life.roller_damage import LifeRules
from fe_drivetrain.suite.page import Page
from fe_drivetrain.suite.records import Record

PRESSED_OUT = 0.01
"""Centrifugal load over the largest of a rolling element from which on it is spoken of."""


def limits(page: Page, found: Sequence[BearingLife], rules: LifeRules) -> None:
    """Static safety, and time beyond the limits of the methods, with notes on what matters.

    Parameters
    ----------
    page : Page
        Takes them.
    found : sequence of BearingLife
        All bearings.
    rules : LifeRules
        Choices that change lives.
    """
    page.section("Static safety, and limits of the methods")
    rows = [_row(life) for life in found]
    for life, row in zip(found, rows, strict=True):
        _notes(page, life, row)
    if rules.lubricant is not None and rules.lubricant.caution is not None:
        page.note(rules.lubricant.caution)
    first, last = list(rows[0])[:7], list(rows[0])[7:]
    page.table("Static safety", rows, first)
    page.table(
        "Time beyond the limits of the methods, in the files as they are", rows, ["bearing", *last]
    )
    page.data("limits", rows)
    page.text(
        "S0 is the lesser of C0 / P0 of ISO 76, whose P0 knows no moment, and of that of the "
        "rollers: the load at which the most loaded contact has the pressure that C0 stands for "
        "(4,000 MPa on rollers, 4,200 MPa on balls), over what it carries, by the pressure squared "
        "in line contact and cubed in point contact. Above C/2 the load is beyond the range of ISO "
        "281: P, or the radial load that has the life of the rollers, C / L10r^(1/4), of balls "
        "C / L10r^(1/3), in which moments are. Below kappa = 0.1 a_ISO is "
        "its smallest value, 0.1; above 4 it stays that of 4. Below "
        f"{rules.standing_rpm:g} 1/min a bearing stands: marks of standstill and of oscillation "
        "are no fatigue of rolling contact, and no life is computed for them."
    )


def overloaded(life: BearingLife) -> str:
    """What ends the answer of a bearing whose static safety is below 1; empty of others.

    Parameters
    ----------
    life : BearingLife
        The bearing.

    Returns
    -------
    words : str
        With pressure and limit.
    """
    of, rated = life.limits, life.one.rated
    if of.static_safety >= 1.0:
        return ""
    if of.largest_pressure <= rated.static_pressure:
        why = f"P0 of {1e-3 * of.largest_static:,.0f} kN, above C0 of {1e-3 * rated.static:,.0f} kN"
    else:
        why = (
            f"{1e-6 * of.largest_pressure:,.0f} MPa contact pressure, above the "
            f"{1e-6 * rated.static_pressure:,.0f} MPa limit"
        )
    return f"; not usable: static safety S0 is {of.static_safety:.2g}, {why}"


def _row(life: BearingLife) -> Record:
    of, rated = life.limits, life.one.rated
    share = 100.0 / sum(one.damage.seconds for one in life.digests)
    return {
        "bearing": life.one.name,
        "least S0": of.static_safety,
        "largest pressure [MPa]": 1e-6 * of.largest_pressure,
        "largest roller load [kN]": 1e-3 * of.largest_roller,
        "largest P0 / C0": of.largest_static / rated.static,
        "largest P / C": of.largest_load / rated.dynamic,
        "largest P / C of the rollers": of.largest_reference / rated.dynamic,
        "load above C/2 [% of time]": share * of.heavy,
        "S0 below 1 [% of time]": share * of.weak,
        "kappa below 0.1 [% of time]": share * of.thin,
        "kappa above 4 [% of time]": share * of.thick,
        "above the limiting speed [% of time]": share * of.fast,
        "standing [% of time]": share * of.standing,
        "reversals": of.reversals,
    }


def _notes(page: Page, life: BearingLife, row: Record) -> None:
    """What a reader has to know before the lives, most severe first."""
    of, name = life.limits, life.one.name
    for key, words in (
        (
            "S0 below 1 [% of time]",
            f"static safety is below 1, {of.static_safety:.2g} at least, with "
            f"{1e-6 * of.largest_pressure:,.0f} MPa on a raceway",
        ),
        ("load above C/2 [% of time]", "the load is above C/2, beyond the range of ISO 281"),
        (
            "above the limiting speed [% of time]",
            f"it turns faster than its limiting speed, {life.one.rated.limiting_speed_rpm} 1/min",
        ),
        ("kappa below 0.1 [% of time]", "the film is below kappa = 0.1: a_ISO is taken as 0.1"),
        (
            "kappa above 4 [% of time]",
            "the film is above kappa = 4, a_ISO is taken as that of 4: a lubricant that thick may "
            "not reach the contacts",
        ),
        ("standing [% of time]", "the bearing stands: no life is computed for that time"),
    ):
        share = row[key]
        if isinstance(share, float) and share > 0.0:
            page.note(f"Bearing {name}: in {share:.3g} % of the time {words}.")
    pressed = centrifugal_load(life.one.rated.bearing, of.largest_speed_rpm)
    if pressed > PRESSED_OUT * of.largest_roller:
        page.note(
            f"Bearing {name}: at {of.largest_speed_rpm:,.0f} 1/min a rolling element is pressed on "
            f"the outer race by {1e-3 * pressed:.3g} kN of its own, beside a largest load of "
            f"{1e-3 * of.largest_roller:.3g} kN: centrifugal loads are in no life here."
        )
    if of.reversals:
        page.note(
            f"Bearing {name} turns back {of.reversals:g} times: lives are of turning "
            "one way, oscillation is not computed."
        )
