"""The answer on lives of bearings: the shortest of them, and whether the bearing can be used."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.number_text import certain_value, value_text
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.studies.life_assumptions import in_years
from fe_drivetrain.studies.life_inside import beyond
from fe_drivetrain.studies.life_sums import BearingLife, scatter
from fe_drivetrain.studies.shown_units import bearing_in_words
from fe_drivetrain.turbine_loads.histories.sites import Site

_SHOWN = 3  # bearings with a life among the key figures
_FAR = 0.2  # share of the design life below which a life is far below it
_SHORTEST, _LONGEST = 1e-3, 1e4  # years, between which a number needs no power of ten
_STANDARD = "ISO 76"


def state_answer(
    found: Findings,
    lives: Sequence[BearingLife],
    site: Site | None,
    unrated: int = 0,
    with_events: Sequence[KeyFigure] = (),
) -> None:
    """State the shortest life; a bearing that cannot be used comes before it.

    Parameters
    ----------
    found : Findings
        Takes the answer; its notes limit it.
    lives : sequence of BearingLife
        The bearings.
    site : Site or None
        Whose winds are weighted, and whose years are asked for.
    unrated : int
        Number of other bearings, which have no catalogue entry.
    with_events : sequence of KeyFigure
        The shortest life with events, where they are asked for.
    """
    by_life = sorted(lives, key=lambda life: life.years["L10mr"])
    shortest, weakest = by_life[0], hardest_loaded(lives)
    years = {life.name: _years(found, life, site) for life in by_life}
    pressure, safety = _pressure(found, weakest), _safety(found, weakest)
    if weakest.limits.static_safety < 1.0:
        first, second = (pressure, safety) if _is_pressed(weakest) else (safety, pressure)
        own = years.pop(weakest.name)
        verdict = _not_usable(weakest, first, own)
        figures = [first, own, second, *years.values()]
    else:
        among = f"{len(lives)}{' rated' if unrated else ''}"
        verdict = _lives(shortest, years[shortest.name], site, len(lives), safety, among)
        figures = [*[*years.values()][:_SHOWN], pressure, safety]
    figures = [*with_events, *figures][: _SHOWN + 2]
    if shortest.site is not None:
        covered = 100.0 * shortest.site.covered
        figures.append(found.value("time whose winds the files have [%]", covered))
    which = "do the bearings" if len(lives) > 1 else f"does {bearing_in_words(shortest.name)}"
    found.answer(f"How long {which} live under these loads?", verdict, figures)


def hardest_loaded(lives: Sequence[BearingLife]) -> BearingLife:
    """The bearing of the least static safety.

    Parameters
    ----------
    lives : sequence of BearingLife
        The bearings.
    """
    return min(lives, key=lambda life: life.limits.static_safety)


def _is_pressed(life: BearingLife) -> bool:
    """Whether the contact pressure is above its limit."""
    return life.limits.max_pressure > life.bearing.rated.static_pressure


def _years(found: Findings, life: BearingLife, site: Site | None) -> KeyFigure:
    """The life of a bearing, against the design life where a site states one."""
    quantity, value = f"L10mr of bearing {life.name}", life.years["L10mr"]
    name, band = f"{quantity} [years]", scatter(life)
    if life.inside is not None:
        wide = float(np.hypot(band or 0.0, beyond(value, life.inside.years["L10mr"])))
        band = wide if 0.0 < wide < value else band  # a wider one is in a caution, with its ends
    if site is None:
        return found.value(name, value, band)
    one = found.value(name, value, band, at_least=site.years, by="design life")
    known = {figure.quantity for figure in found.figures}
    return one.model_copy(update={"quantity": quantity if quantity in known else ""})


def _pressure(found: Findings, life: BearingLife) -> KeyFigure:
    pressure, inside = life.limits.max_pressure, life.inside
    return found.value(
        f"peak contact pressure in {life.name} [MPa]",
        1e-6 * pressure,
        None if inside is None else 1e-6 * beyond(pressure, inside.pressure) or None,
        at_most=1e-6 * life.bearing.rated.static_pressure,
        by=_STANDARD,
    )


def _safety(found: Findings, life: BearingLife) -> KeyFigure:
    name = f"static safety S0 of {life.name}"
    return found.value(name, life.limits.static_safety, at_least=1.0, by=_STANDARD)


def _life_text(years: KeyFigure) -> str:
    if years.band or _SHORTEST <= years.value < _LONGEST:
        return certain_value(years)
    return in_years(years.value).replace(" ", "\u00a0")


def _not_usable(life: BearingLife, overload: KeyFigure, years: KeyFigure) -> str:
    """What is wrong with a bearing that is loaded beyond its static rating."""
    of, rated = life.limits, life.bearing.rated
    if _is_pressed(life):
        limit = value_text(1e-6 * rated.static_pressure, "MPa")
        why = f"{certain_value(overload)} contact pressure in {bearing_in_words(life.name)}, above "
        why += f"the {limit} limit of {_STANDARD}"
    else:
        load, limit = (value_text(1e-3 * one, "kN") for one in (of.max_static, rated.static))
        why = f"a static load of {load} on {bearing_in_words(life.name)}, above its rating C0 of "
        why += limit
    return f"Not usable: {why}; its rated life is {_life_text(years)}."


def _lives(
    life: BearingLife,
    years: KeyFigure,
    site: Site | None,
    number: int,
    safety: KeyFigure,
    among: str,
) -> str:
    """The shortest life, beside the one that is asked for."""
    who = bearing_in_words(life.name)
    who = f"{who[:1].upper()}{who[1:]}"
    if np.isinf(years.value):
        takes = "No bearing takes" if number > 1 else f"{who} takes no"
        least = certain_value(safety)
        return f"{takes} damage (L10mr) under these loads; static safety is {least} at least."
    shortest = f", the shortest of {among}" if number > 1 else ""
    words = f"{who} lives {_life_text(years)} (L10mr){shortest}"
    if site is None:
        return f"{words}, if these files repeat for ever."
    asked = value_text(site.years, "years")
    at = f"at a mean wind of {value_text(site.mean_wind, 'm/s')}"
    if years.status == "bad":
        far = "far " if years.value < _FAR * site.years else ""
        return f"{words}, {far}below the {asked} of design, {at}."
    doubt = ", but not beyond its scatter" if years.status == "watch" else ""
    return f"{words}, above the {asked} of design{doubt}, {at}."
