"""What was not stated, and what it does to a life: each assumption by its own sensitivity.

A sample of the load steps of each file is rated again with another value of each assumption; the
ratio of the two damages stands for that of the whole file. Steps come into the sample as often as
they do damage, by the fourth power of the loads of their rollers, and weigh the less there.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from math import cos, floor, log10, radians

import numpy as np

from fe_drivetrain.bearing.geometry import Bearing, max_clearance
from fe_drivetrain.bearing_life.coupled.reaction_paths import ReactionPath
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.lubricants import GRADES, SUPPLIES
from fe_drivetrain.bearing_life.life.rated import RatedBearing
from fe_drivetrain.bearing_life.life.roller_damage import damage_of_steps
from fe_drivetrain.bearing_life.life.steps import Steps
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.studies.rolling_bearings import PROFILE, Choices, OneBearing
from fe_drivetrain.turbine_loads.hub_loads.point_loads import PointLoads

PLAYED = 1.0 / 4000.0
"""Clearance to compare with over the pitch diameter: 0.2 mm at 0.8 m. A size of what bearings have
between loose and tight fits, of no table: ISO 5753 and the fits of a seat say more."""

PRELOADED = 0.1
"""Preload to compare with over that clearance."""

WARMER = 10.0
"""Kelvin above a temperature that was not stated."""

LESS = 0.9
"""Share of load ratings that follow from assumed rolling elements."""

NEGLIGIBLE = 0.05
"""Change of L10mr up to which nothing is said."""

SAMPLE = (24, 100)
"""Steps of a file at least, where there are as many, and one of how many."""


@dataclass(frozen=True)
class WhatIf:
    """One assumption, and what could be instead.

    Attributes
    ----------
    assumed, instead : str
        What is taken though nobody stated it, and what it is compared with.
    rated : RatedBearing
        The bearing then.
    rules : LifeRules
        The choices then.
    path : ReactionPath or None
        The way of its load then; None where it stays what it is.
    clearance : float or None
        Clearance along the contact normal then [m], where that is what differs.
    stated : bool
        Whether what is taken was stated, so that the other value only shows what it does.
    """

    assumed: str
    instead: str
    rated: RatedBearing
    rules: LifeRules
    path: ReactionPath | None = None
    clearance: float | None = None
    stated: bool = False


@dataclass(frozen=True)
class Assumption:
    """Something that was not stated, and the life with another value of it.

    Attributes
    ----------
    assumed, instead : str
        What is taken though nobody stated it, and what it is compared with.
    years : float
        L10mr with that [years].
    clearance : float or None
        Clearance along the contact normal then [m], where that is what differs.
    stated : bool
        Whether what is taken was stated, after all.
    """

    assumed: str
    instead: str
    years: float
    clearance: float | None = None
    stated: bool = False


def what_ifs(one: OneBearing, rules: LifeRules, choices: Choices) -> tuple[WhatIf, ...]:
    """Assumptions of the bearing that nobody stated.

    Parameters
    ----------
    one : OneBearing
        The bearing.
    rules : LifeRules
        Choices that change its life, as `OneBearing.rules` has them.
    choices : Choices
        With the options that stayed at their default.

    Returns
    -------
    found : tuple of WhatIf
        None where all is stated.
    """
    return (
        *(WhatIf(o.assumed, o.instead, one.rated, rules, o.path) for o in one.others),
        *_of_clearance(one, rules),
        *_of_stated_clearance(one, rules),
        *_of_rollers(one, rules, choices),
        *_of_lubricant(one, rules, choices),
    )


def effects(
    one: OneBearing,
    rules: LifeRules,
    ifs: Sequence[WhatIf],
    loads: PointLoads,
    speed_rpm: Floats,
    weights: Floats,
) -> Floats:
    """Damage and pressure with each of the other values, over those that are taken.

    Parameters
    ----------
    one : OneBearing
        The bearing.
    rules : LifeRules
        Choices.
    ifs : sequence of WhatIf
        Other values, those of `what_ifs` among them.
    loads : PointLoads
        Load steps as they enter the body, (n, 6) or more [N, N m].
    speed_rpm : Floats
        (n,) [1/min].
    weights : Floats
        (n,) about in proportion to the damage of each step, as the fourth power of its rollers.

    Returns
    -------
    effects : Floats
        (len(ifs), 3) damage by L10r, by L10mr, and largest contact pressure, from a sample of a
        hundredth of the steps; 1 where there is none.
    """
    if not ifs or not weights.any():
        return np.ones((len(ifs), 3))
    part, seconds = sampled(weights)
    taken = list(one.path.steps(loads[part], speed_rpm[part], seconds))
    found = []
    for other in ifs:
        there = taken
        if other.path is not None:
            there = list(other.path.steps(loads[part], speed_rpm[part], seconds))
        elif other.rated.bearing != one.rated.bearing:
            there = list(
                one.path_with(other.rated.bearing).steps(loads[part], speed_rpm[part], seconds)
            )
        before, after = np.zeros(3), np.zeros(3)
        for mine, its in _balanced(taken, there):
            for sums, done in (
                (before, damage_of_steps(mine, one.rated, rules)),
                (after, damage_of_steps(its, other.rated, other.rules)),
            ):
                sums[:2] += done.of_bearing
                sums[2] = max(sums[2], done.limits.max_pressure)
        found.append(np.divide(after, before, out=np.ones(3), where=before > 0.0))
    return np.array(found)


def sampled(weights: Floats) -> tuple[Ints, Floats]:
    """Steps that stand for all, drawn evenly along the sum of their weights.

    Parameters
    ----------
    weights : Floats
        (n,) not negative, not all zero.

    Returns
    -------
    steps : Ints
        (m,) each once, in order.
    times : Floats
        (m,) how many steps each stands for: sums over the sample are about those over all, exactly
        where what is summed goes with the weights. All, once each, where there are few.
    """
    least, apart = SAMPLE
    n = len(weights)
    if n <= least:
        return np.arange(n), np.ones(n)
    count = max(least, n // apart)
    whole = np.cumsum(weights)
    places = (np.arange(count) + 0.5) / count * whole[-1]
    steps, drawn = np.unique(np.searchsorted(whole, places), return_counts=True)
    return steps, drawn * whole[-1] / count / weights[steps]


def in_words(name: str, years: float, assumptions: Sequence[Assumption]) -> str | None:
    """The assumptions that matter for a life, the most severe first, as a sentence.

    Parameters
    ----------
    name : str
        Name of the bearing.
    years : float
        Its L10mr [years].
    assumptions : sequence of Assumption
        What was not stated, with the life that it is compared with.

    Returns
    -------
    sentence : str or None
        None where no change is more than 5 %, or the life has no end.
    """
    if np.isinf(years):
        return None
    matter = sorted(
        (one for one in assumptions if abs(one.years / years - 1.0) > NEGLIGIBLE),
        key=lambda one: one.years,
    )
    if not matter:
        return None
    parts = [
        f"{one.assumed} ({one.instead}: {in_years(float(f'{one.years:.2g}'))})" for one in matter
    ]
    return (
        f"Bearing {name}: its L10mr of {in_years(years)} assumes what was not stated, in "
        "brackets what it would be with another value: "
        f"{'; '.join(parts)}."
    )


def in_years(value: float) -> str:
    """A life [years] in words."""
    if np.isinf(value):
        return "without end"
    return f"{value:,.0f} years" if value >= 1000.0 else f"{value:.3g} years"


def _of_clearance(one: OneBearing, rules: LifeRules) -> Iterator[WhatIf]:
    if "clearance" in one.entry.model_fields_set:
        return
    bearing = one.rated.bearing
    most = min(max_clearance(row) for row in bearing.rows)
    play = min(_rounded(PLAYED * one.rated.pitch_diameter), most)
    yield _changed(
        one,
        rules,
        "clearance 0",
        f"{1e3 * play:g} mm along the contact normal",
        bearing.with_rows(clearance=play),
        play,
    )
    if one.entry.contact_angle and "spherical" not in one.entry.kind:
        tight = PRELOADED * play
        yield _changed(
            one,
            rules,
            "preload 0",
            f"{1e3 * tight:g} mm",
            bearing.with_rows(clearance=-tight),
            -tight,
        )


def _of_stated_clearance(one: OneBearing, rules: LifeRules) -> Iterator[WhatIf]:
    """Zero clearance, and both ends of the band of an operating clearance."""
    if "clearance" not in one.entry.model_fields_set:
        return
    taken = one.entry.clearance
    others = {"zero": 0.0}
    if one.clearance is not None:
        band = one.clearance.along_normal
        others = {"least": band.least, "most": band.most, "zero": 0.0}
    for name, value in others.items():
        if value != taken:
            bearing = one.rated.bearing.with_rows(clearance=_of_row(one, value))
            yield replace(
                _changed(one, rules, "clearance", name, bearing), clearance=value, stated=True
            )


def _of_row(one: OneBearing, value: float) -> float:
    """Clearance of the rows for one of the entry: a row of balls has it by its contact angle."""
    if one.entry.kind == "ball":
        return value * cos(radians(one.entry.contact_angle or 0.0))
    return value


def _of_rollers(one: OneBearing, rules: LifeRules, choices: Choices) -> Iterator[WhatIf]:
    own = one.rated
    if own.sources[0].startswith("from its") and one.entry.assumed:
        less = replace(
            own, dynamic=LESS * own.dynamic, static=LESS * own.static, fatigue=LESS * own.fatigue
        )
        yield WhatIf("ratings of assumed rolling elements", "10 % less", less, rules)
    profiled = choices.profiled and not one.entry.crown and one.entry.kind in PROFILE
    if profiled and "profile" in choices.assumed:
        straight = replace(rules, riser="none")
        bearing = own.bearing.with_rows(crown=0.0)
        words = "the standard's profile of rollers", "straight, without stress riser"
        yield _changed(one, straight, *words, bearing)
    if not own.balls and rules.riser == "standard" and "riser" in choices.assumed:
        none = replace(rules, riser="none")
        yield WhatIf("the standard's stress riser at their ends", "none", own, none)
    if one.turning is None and rules.turning == "inner" and "turning" in choices.assumed:
        outer = replace(rules, turning="outer")
        yield WhatIf("the inner ring turns against the load", "the outer", own, outer)


def _of_lubricant(one: OneBearing, rules: LifeRules, choices: Choices) -> Iterator[WhatIf]:
    oil = rules.lubricant
    if oil is None:
        return
    assumed = choices.assumed if one.oil is None else one.oil.assumed
    if "temperature" in assumed and oil.temperature + WARMER <= oil.range[1]:
        warm = replace(oil, temperature=oil.temperature + WARMER)
        words = f"{oil.temperature:g} degC", f"{warm.temperature:g} degC"
        yield WhatIf(*words, one.rated, replace(rules, lubricant=warm))
    if "lubricant" in assumed:
        words = ("VG 460", "VG 320") if one.oil is None else ("VG 320", "VG 220")
        at_40, at_100 = GRADES[words[1]]
        thinner = replace(oil, viscosity_40=at_40, viscosity_100=at_100)
        yield WhatIf(*words, one.rated, replace(rules, lubricant=thinner))
    classes = list(SUPPLIES[oil.supply])
    worse = classes[classes.index(oil.cleanliness) + 1 :]
    if "cleanliness" in assumed and worse:
        dirty = replace(oil, cleanliness=worse[0])
        words = f"cleanliness {oil.cleanliness!r}", repr(worse[0])
        yield WhatIf(*words, one.rated, replace(rules, lubricant=dirty))


def _changed(
    one: OneBearing,
    rules: LifeRules,
    assumed: str,
    instead: str,
    bearing: Bearing,
    clearance: float | None = None,
) -> WhatIf:
    rated = replace(one.rated, bearing=bearing)
    return WhatIf(assumed, instead, rated, rules, clearance=clearance)


def _balanced(one: Sequence[Steps], other: Sequence[Steps]) -> Iterator[tuple[Steps, Steps]]:
    """Both chunk by chunk, as long as each other, with the steps that both have in equilibrium."""
    for mine, its in zip(one, other, strict=True):
        both = mine.converged & its.converged
        yield replace(mine, converged=both), replace(its, converged=both)


def _rounded(value: float) -> float:
    """To one digit."""
    unit = 10.0 ** floor(log10(value))
    return round(value / unit) * unit
