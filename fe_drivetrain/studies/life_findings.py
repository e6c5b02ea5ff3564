"""What lives say in sentences: answer, cautions, assumptions and checks."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from fe_drivetrain.bearing.rolling import TOLERANCE
from fe_drivetrain.bearing_life.coupled.load_paths import LoadPath
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.limits import centrifugal_load
from fe_drivetrain.bearing_life.life.lubricants import Lubricant
from fe_drivetrain.bearing_life.life.reference_life import RINGS
from fe_drivetrain.common.arguments import argument
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.procedure.failure_modes import BEARING_RATING, TORQUE_AND_BENDING
from fe_drivetrain.report.number_text import value_with_band
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.clearance_tables import state_clearance
from fe_drivetrain.studies.life_assumptions import in_words, in_years
from fe_drivetrain.studies.life_options import LifeOptions
from fe_drivetrain.studies.life_sums import BearingLife, scatter
from fe_drivetrain.studies.rolling_bearings import rollers_in_words, row_names
from fe_drivetrain.studies.thermal_tables import thermal_caution, thermal_tables
from fe_drivetrain.studies.unused import choices_not_used, speed_not_used
from fe_drivetrain.turbine_loads.histories.sites import Site
from fe_drivetrain.turbine_loads.hub_loads.recorded import short_name
from fe_drivetrain.turbine_loads.hub_loads.turbines import different_turbines

BALANCE = 100.0 * TOLERANCE
"""Part of a load that the sum of rollers' forces may leave: the solver's residual, and rounding."""

PRESSED_OUT = 0.01
"""Centrifugal load over the largest of a rolling element from which on it is spoken of."""

UNVERIFIED = (
    "No constant here was read in ISO 281, ISO 76 or ISO/TS 16281. Those of capacities, reference "
    "lives, a_ISO, nu_1, and of X, Y and e of rollers agree with public code, reference lives of a "
    "ball bearing with MASTA; those of contamination are from memory, with two numbers of MASTA "
    "beside them."
)


def answers(
    found: Findings, lives: Sequence[BearingLife], rules: LifeRules, site: Site | None
) -> None:
    """State the life of each bearing, and what takes most of it.

    Parameters
    ----------
    found : Findings
        Takes sentences and figures.
    lives : sequence of BearingLife
        The bearings.
    rules : LifeRules
        Choices that change lives.
    site : Site or None
        Whose winds are weighted.
    """
    _shortest(found, lives)
    for life in lives:
        years, band = life.years, scatter(life)
        shown, loads = in_years(years["L10mr"]), _loads(life)
        if np.isfinite(years["L10mr"]):
            found.found(f"L10mr of bearing {life.name} [years]", years["L10mr"], band, loads)
        if band is not None:
            shown = f"{value_with_band(found.figures[-1])} (two standard errors of files of the "
            shown += "same wind)"
        found.say(
            f"Bearing {life.name}: L10mr {shown}, L10r {in_years(years['L10r'])}, L10 "
            f"{in_years(years['L10'])}, {_under(life, site)}{_takes_longest(life, rules)}."
        )
        if sentence := _clearance_in_words(life):
            found.say(sentence)


def _clearance_in_words(life: BearingLife) -> str | None:
    """The operating clearance with its band, and what that does to L10mr."""
    clearance = life.bearing.clearance
    if clearance is None:
        return None
    band = clearance.radial
    least, mean, most = (f"{1e6 * value:.0f}" for value in (band.least, band.mean, band.most))
    then = {one.instead: in_years(one.years) for one in life.clearances}
    return (
        f"Bearing {life.name} runs with a radial clearance of {mean} µm, from {least} to {most} µm "
        f"by its tolerances, with which L10mr is {then.get('least', 'the same')} and "
        f"{then.get('most', 'the same')}."
    )


def _insides(found: Findings, lives: Sequence[BearingLife]) -> None:
    """State bands of lives of bearings that are given by their catalogue's page."""
    for life in lives:
        band = life.inside
        if band is None or not np.isfinite(life.years["L10mr"]):
            continue
        low, high = band.years["L10mr"]
        ends = f"{in_years(low)} to {in_years(high)}"
        found.note(
            f"Bearing {life.name}: its page does not print what is inside. With {band.insides} "
            f"insides that fit it, L10mr is {ends}; give what is known of the inside to narrow it.",
            first=high - low > life.years["L10mr"],
        )


def _loads(life: BearingLife) -> tuple[str, ...]:
    """The design load that lives of a bearing are values of: one of a gearbox has its oil."""
    return (TORQUE_AND_BENDING if life.bearing.oil is None else BEARING_RATING,)


def _shortest(found: Findings, lives: Sequence[BearingLife]) -> None:
    """The shortest life and the least static safety of main bearings, and of a gearbox's."""
    for whose, of_gearbox in (("main bearings", False), ("gearbox bearings", True)):
        of = [life for life in lives if (life.bearing.oil is not None) is of_gearbox]
        if of:
            first = min(of, key=lambda life: life.years["L10mr"])
            years, loads = first.years["L10mr"], _loads(first)
            if np.isfinite(years):
                found.found(f"shortest L10mr of {whose} [years]", years, scatter(first), loads)
            found.found(
                f"least static safety S0 of {whose}",
                min(life.limits.static_safety for life in of),
                loads=loads,
            )


def _under(life: BearingLife, site: Site | None) -> str:
    """Under what the bearing lives."""
    if site is None or life.site is None:
        return "if these files repeat for ever"
    return (
        f"at a mean wind of {site.mean_wind:g} m/s, where the winds of these files blow "
        f"{100 * life.site.covered:.3g} % of the time and the rest is taken to do no damage"
    )


def _takes_longest(life: BearingLife, rules: LifeRules) -> str:
    """Ring and wind that take most of the life."""
    parts = life.damage.of_rows(rules.lubricant is not None)
    row, ring = np.unravel_index(int(np.argmax(parts)), parts.shape)
    whole, words = parts.sum(), ""
    if whole:
        words = (
            f"; the {RINGS[ring]} ring of the {row_names(len(parts))[row]} takes "
            f"{100 * parts[row, ring] / whole:.0f} % of the damage"
        )
    if life.site is not None:
        shares = life.site.of_winds("L10mr")
        most = life.site.speeds[np.argmax(shares)]
        words += f", winds about {most:g} m/s {100 * shares.max():.0f} %"
        if whole:
            always = in_years(life.years["L10mr"] * life.site.covered)
            words += f"; if these winds blew all the time it would live {always}"
    return words


def cautions(
    found: Findings,
    drivetrain: Drivetrain,
    lives: Sequence[BearingLife],
    options: LifeOptions,
    limits: Sequence[Record],
) -> None:
    """State what must be known before the lives, most severe first.

    Parameters
    ----------
    found : Findings
        Takes the sentences.
    drivetrain : Drivetrain
        The drivetrain.
    lives : sequence of BearingLife
        The bearings.
    options : LifeOptions
        What was asked for.
    limits : sequence of dict
        Time beyond the limits of the methods, of each bearing.
    """
    for life in lives:
        if life.bearing.misfit is not None:
            found.note(life.bearing.misfit)
    for life, row in zip(lives, limits, strict=True):
        _beyond_limits(found, life, row)
    _beyond_limits_together(found, lives, limits)
    _insides(found, lives)
    for life in _spoken_of(lives):
        if sentence := in_words(life.name, life.years["L10mr"], life.assumptions):
            found.note(sentence)
    if isinstance(drivetrain, Scene) and (heat := thermal_caution(thermal_tables(drivetrain))):
        found.note(f"{heat} No life has these.", first=True)
    files = [one.file for one in lives[0].files]
    vertical = {short_name(one.file, files): one.vertical for one in lives[0].files}
    if unlike := different_turbines(vertical):
        found.note(unlike, first=True)
    used = [life.bearing.rules(options.rules).lubricant for life in lives]
    for caution in dict.fromkeys(one.caution for one in used if one is not None):
        if caution is not None:
            found.note(caution)
    own_speeds = [one.own_speeds for one in lives[0].files]
    if unused := speed_not_used(options.rotor_speed_rpm, own_speeds):
        found.note(unused, first=True)
    for unused in choices_not_used(drivetrain, options.choices, [life.bearing for life in lives]):
        found.note(unused, first=True)
    found.note(UNVERIFIED)


def _spoken_of(lives: Sequence[BearingLife]) -> list[BearingLife]:
    """Bearings on rollers in equilibrium with the shaft, and of the others the shortest-lived."""
    others = sorted((one for one in lives if one.levels), key=lambda one: one.years["L10mr"])
    return [*(one for one in lives if not one.levels), *others[:1]]


BEYOND = {
    "load above C/2 [% of time]": "the load is above C/2, beyond the range of ISO 281",
    "kappa below 0.1 [% of time]": "the film is below kappa = 0.1: a_ISO is taken as 0.1",
    "kappa above 4 [% of time]": "the film is above kappa = 4, a_ISO is taken as that of 4: a "
    "lubricant that thick may not reach the contacts",
    "standing [% of time]": "the bearing stands: no life is computed for that time",
}
"""What is said of time beyond a limit of the methods, by the column of its share."""


def _beyond_limits_together(
    found: Findings, lives: Sequence[BearingLife], limits: Sequence[Record]
) -> None:
    """State the same limits of several bearings of a gearbox in one sentence each."""
    for key, words in BEYOND.items():
        shares = {
            life.name: row[key]
            for life, row in zip(lives, limits, strict=True)
            if life.levels and isinstance(row[key], float)
        }
        past = {name: share for name, share in shares.items() if share > 0.0}
        if past:
            several = "Bearing" if len(past) == 1 else "Bearings"
            most = f"{'up to ' if len(past) > 1 else ''}{max(past.values()):.3g}"
            found.note(f"{several} {', '.join(past)}: in {most} % of the time {words}.")


def _beyond_limits(found: Findings, life: BearingLife, row: Record) -> None:
    of, name = life.limits, life.name
    own = {
        "S0 below 1 [% of time]": f"static safety is below 1, {of.static_safety:.2g} at least, "
        f"with {1e-6 * of.max_pressure:,.0f} MPa on a raceway",
        "above the limiting speed [% of time]": "it turns faster than its limiting speed, "
        f"{life.bearing.rated.limiting_speed_rpm} 1/min",
    }
    for key, words in (own if life.levels else own | BEYOND).items():
        share = row[key]
        if isinstance(share, float) and share > 0.0:
            found.note(f"Bearing {name}: in {share:.3g} % of the time {words}.")
    pressed = centrifugal_load(life.bearing.rated.bearing, of.max_speed_rpm)
    if pressed > PRESSED_OUT * of.max_roller_load:
        found.note(
            f"Bearing {name}: at {of.max_speed_rpm:,.0f} 1/min a rolling element is pressed on "
            f"the outer race by {1e-3 * pressed:.3g} kN of its own, beside a largest load of "
            f"{1e-3 * of.max_roller_load:.3g} kN: centrifugal loads are in no life here."
        )
    if of.reversals:
        found.note(
            f"Bearing {name} turns back {of.reversals:g} times: lives are of turning "
            "one way, oscillation is not computed."
        )


def assumptions(found: Findings, lives: Sequence[BearingLife], options: LifeOptions) -> None:
    """State the values that nobody stated, or that were chosen, and where they come from.

    Parameters
    ----------
    found : Findings
        Takes them.
    lives : sequence of BearingLife
        The bearings.
    options : LifeOptions
        What was asked for.
    """
    rules = options.rules
    for life in lives:
        _of_entry(found, life, rules)
    if rules.lubricant is not None and any(life.bearing.oil is None for life in lives):
        _of_lubricant(found, rules.lubricant)
    found.assume(
        "lambda nu taken out of C", rules.reduction, "-", "0.83 with a stress riser, else 1"
    )
    found.assume(
        "a_1", rules.reliability, "-", f"{_option('reliability_percent')}, as public code has it"
    )
    share = "C_u over the number of rows" if rules.limit_per_row else "the whole C_u"
    found.assume("fatigue limit of a row", share, "", "loads P_ks are those of a row")
    if any(life.bearing.turning is None for life in lives):
        found.assume("ring that turns against the load", rules.turning, "", _option("turning"))
    if not all(life.levels for life in lives):
        _of_support(found, options, _sliding(lives))
    files = len(lives[0].files)
    found.assume("samples", f"one of {options.every}", "", f"{_option('every')}; {files} files")


def _of_lubricant(found: Findings, oil: Lubricant) -> None:
    """State the lubricant of main bearings."""
    found.assume("temperature", oil.temperature, "degC", _option("temperature"))
    found.assume("viscosity there", oil.viscosity, "mm2/s", f"{_option('lubricant')}, by ASTM D341")
    found.assume("lubrication", oil.supply, "", _option("supply"))
    found.assume("cleanliness", oil.cleanliness, "", _option("cleanliness"))


def _sliding(lives: Sequence[BearingLife]) -> tuple[str, ...]:
    """Bearings whose outer ring slides, of the shaft that is in equilibrium with its rollers."""
    paths = (life.bearing.path for life in lives)
    return next((path.body.sliding for path in paths if isinstance(path, LoadPath)), ())


def _of_support(found: Findings, options: LifeOptions, sliding: Sequence[str]) -> None:
    """State how shaft and rings are modelled where rollers are in equilibrium with the shaft."""
    words = {
        "rollers": "bearings in equilibrium with the shaft, a beam",
        "pinned": "pinned bearings: no moment on them",
    }.get(str(options.support), f"springs with K_R of {options.support} N m/rad")
    found.assume("shaft", words, "", _option("support"))
    for name in sliding:
        words = "free along x in the file: its ring slides there, and holds no axial force"
        found.assume(f"{name}: housing", words, "", "joint of the bearing unit")
    found.assume(
        "rings", options.rings, "", f"{_option('rings')}; housings are rigid but for 'housing'"
    )


def _option(name: str) -> str:
    """The option that a value comes from."""
    return argument(f"LifeOptions.{name}")


def _of_entry(found: Findings, life: BearingLife, rules: LifeRules) -> None:
    """State what a catalogue entry assumes, or leaves open."""
    entry, name = life.bearing.entry, life.name
    for field in entry.assumed:
        if field == "ratings":  # those that are given stand in a table with their source
            continue
        value: Any = getattr(entry, field)
        unit = {"elements": "-", "contact_angle": "deg"}.get(field, "m")
        found.assume(f"{name}: {field.replace('_', ' ')}", value, unit, entry.sources[field])
    if life.bearing.clearance is not None:
        state_clearance(found, name, life.bearing.clearance)
    if "clearance" not in entry.model_fields_set:
        found.assume(f"{name}: clearance", 0.0, "m", "not stated in its catalogue entry")
    words = rollers_in_words(life.bearing, rules.riser)
    found.assume(
        f"{name}: rolling elements", words, "", f"{_option('profile')} and {_option('riser')}"
    )


def checks(found: Findings, lives: Sequence[BearingLife], rings: str) -> None:
    """Check that rollers hold each load, that their damage adds up, and that all steps count.

    Parameters
    ----------
    found : Findings
        Takes the checks.
    lives : sequence of BearingLife
        The bearings.
    rings : str
        How rings share loads among the rollers, as `LifeOptions.rings`.
    """
    for life in lives:
        _balance(found, life, rings)
        for kind, modified in (("L10r", False), ("L10mr", True)):
            parts = sum(life.damage.of_positions(r, modified).sum() for r in range(len(life.rows)))
            whole = float(life.damage.totals[kind])
            found.vanishes(
                f"{life.name}: damage of places by {kind}, less that of all, as a share",
                float(parts / whole - 1.0) if whole else 0.0,
                within=1e-9,
                why="each place takes its part: rounding of the sums",
                source="lives of the steps, by Miner's rule",
                basis="self-consistency",
            )
        found.vanishes(
            f"{life.name}: time without equilibrium [s]",
            life.limits.lost,
            within=0.0,
            why="steps without equilibrium do no damage, and the life would be too long",
            source="residual of 1e-8 of each step's load",
        )


def _balance(found: Findings, life: BearingLife, rings: str) -> None:
    """Whether the rollers' forces add up to the load on the bearing."""
    left = life.limits.max_unbalanced
    if np.isnan(left):
        return  # balls, whose contacts turn under load
    if rings == "three-degree" and not life.levels:
        found.note(
            f"Bearing {life.name}: rings of three degrees of freedom leave up to "
            f"{100.0 * left:.2g} % of a step's load without balance, what acts across the plane of "
            "the radial force and the moment; rigid rings leave none."
        )
        return
    found.vanishes(
        f"{life.name}: load of a step less the forces of its rollers, largest, over the load",
        left,
        within=BALANCE,
        why="rollers hold the ring: forces and moments add up but for the residual of the solver, "
        f"{TOLERANCE:g} of the load",
        source="statics of the ring by virtual work, without the solver's loops",
    )
