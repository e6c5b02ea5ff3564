"""What a transient says of gears and bearings: damage, static safety, what is left out."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics.bodies.levels import Level
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.report.answer import KeyFigure
from fe_drivetrain.report.charts import bars
from fe_drivetrain.report.number_text import value_text
from fe_drivetrain.report.results import Chart
from fe_drivetrain.report.suite.findings import Findings
from fe_drivetrain.report.suite.key_figures import KeyLimit
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.studies.life_options import LifeOptions
from fe_drivetrain.studies.part_bearings import counted_parts
from fe_drivetrain.studies.part_damage import BearingUse, PartRating, PartUse, times_a_year
from fe_drivetrain.studies.part_gears import FlankUse
from fe_drivetrain.studies.part_loads import NO_PARTS, CountedParts
from fe_drivetrain.studies.transient_digest import FileDigest
from fe_drivetrain.studies.transient_runs import LevelRun
from fe_drivetrain.turbine_loads.histories.sites import Site, require_winds

LEAST = 1e-15
"""Damage from which on it is drawn."""


@dataclass(frozen=True)
class DamageOptions:
    """How damage of gears and bearings is counted.

    Attributes
    ----------
    lives : LifeOptions
        Catalogues and entries of bearings, lubricants, and rules of lives.
    rollers : bool
        Whether rollers of all bearings are brought into equilibrium every 5 ms, for L10r, L10mr and
        the Hertz pressure of all of these; else that is of the largest load alone.
    site : Site or None
        Whose winds weight histories of operation; they repeat for ever without one.
    """

    lives: LifeOptions = field(default_factory=LifeOptions)
    rollers: bool = False
    site: Site | None = None


DAMAGE = DamageOptions()
"""All defaults."""


@dataclass(frozen=True)
class PartQuestion:
    """Gears and bearings of a drivetrain whose damage is asked for; nothing without options.

    Attributes
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    options : DamageOptions or None
        How damage is counted; None leaves it out.
    counted : CountedParts
        Bearings of the catalogue.
    unnamed : tuple of str
        Bearings without an entry.
    """

    drivetrain: Drivetrain
    options: DamageOptions | None
    counted: CountedParts = NO_PARTS
    unnamed: tuple[str, ...] = ()

    def require_winds(self, files: Sequence[Path], wind: float) -> None:
        """Refuse files that a site's winds cannot weight, before any of them is computed.

        Parameters
        ----------
        files : sequence of Path
            All histories.
        wind : float
            Mean wind speed of the first [m/s]; NaN where it has none.

        Raises
        ------
        InputError
            The first has no wind speed, or is the only one.
        """
        asked = self.options is not None and self.options.site is not None
        if asked and (len(files) == 1 or np.isnan(wind)):
            require_winds(files[:1], [wind])

    def of_event(self, run: LevelRun, torque: float) -> PartUse | None:
        """What an event does, once."""
        if self.options is None or run.parts is None:
            return None
        rating = PartRating(self.drivetrain, run.rung, torque, self.counted)
        pair = None if run.coarser is None else (run.parts, run.coarser)
        return rating.use("event", [run.parts], [1.0], pair)

    def of_operation(
        self,
        of_files: Mapping[str, FileDigest],
        files: Sequence[Path],
        begun: LevelRun,
        torque: float,
    ) -> PartUse | None:
        """What a year of operation does, as histories and the site's winds have it."""
        if self.options is None:
            return None
        known = [one for one in of_files.values() if one.parts is not None]
        digests = [one.parts for one in known if one.parts is not None]
        winds = [one.wind for one in known]
        times = times_a_year([one.seconds for one in digests], winds, self.options.site, files)
        # teeth share as springs let them: rollers in statics at each torque take minutes
        rung, pair = replace(begun.rung, rollers=False), None
        rating = PartRating(self.drivetrain, rung, torque, self.counted)
        if begun.parts is not None and begun.coarser is not None:
            pair = (begun.parts, begun.coarser)
        return rating.use("year", digests, times, pair)


def part_question(
    drivetrain: Drivetrain,
    machine: Machine,
    options: DamageOptions | None,
    strict: bool = True,
) -> PartQuestion:
    """Gears and bearings whose damage is asked for.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    machine : Machine
        Its machine.
    options : DamageOptions or None
        How damage is counted; None leaves it out.
    strict : bool
        Whether entries that are in no catalogue are refused, see `counted_parts`.

    Raises
    ------
    InputError
        An entry of the catalogue is unknown, and `strict`.
    """
    if options is None:
        return PartQuestion(drivetrain, None)
    if machine.not_given:  # bodies only turn, and have no forces of bearings
        return PartQuestion(drivetrain, options)
    counted, unnamed = counted_parts(drivetrain, machine, options.lives, options.rollers, strict)
    return PartQuestion(drivetrain, options, counted, unnamed)


def gear_damage_rows(use: PartUse) -> list[Record]:
    """A row for each flank."""
    return [
        {
            "gear": one.name,
            "mesh": one.mesh,
            f"damage of the flank each {use.per}": one.damage.flank,
            f"damage of the other flank each {use.per}": one.damage.back,
            f"damage of the root each {use.per}": max(one.damage.root, one.damage.root_back),
            f"largest damage each {use.per}": one.damage.largest,
            "± of it": one.band if np.isfinite(one.band) else None,
            _borne(use): _over(one.damage.largest),
            "largest torque of the rotor by its mesh [kN m]": one.peak / 1e3,
            "S_H at the peak": one.contact_safety,
            "least S_H": one.required[0],
            "S_F at the peak": one.root_safety,
            "least S_F": one.required[1],
        }
        for one in use.gears.values()
    ]


def bearing_damage_rows(use: PartUse) -> list[Record]:
    """A row for each bearing."""
    rows: list[Record] = []
    for one in use.bearings.values():
        row: Record = {"bearing": one.name, "entry": one.entry}
        for kind, damage in one.damage.items():
            row[f"damage by {kind} each {use.per}"] = damage
            row |= {"± of it": one.band} if kind == "L10" else {}
        row |= {
            **{f"{_borne(use)}, {kind}": _over(damage) for kind, damage in one.damage.items()},
            "S0": one.static_safety,
            "largest P_0 [kN]": one.static_load / 1e3,
            "at [s]": one.at,
            "largest Hertz pressure [MPa]": one.pressure / 1e6,
            f"turns each {use.per}": one.turns,
            f"standing each {use.per} [s]": one.standing,
            "largest force on flanges [kN]": one.flanges / 1e3,
        }
        rows.append(row)
    return rows


def history_damage_rows(use: PartUse, names: Sequence[str]) -> list[Record]:
    """A row for each history: the largest damage of each mesh, and that of bearings by L10."""
    meshes = list(dict.fromkeys(one.mesh for one in use.gears.values()))
    rows: list[Record] = []
    for k, name in enumerate(names):
        row: Record = {"file": name}
        for mesh in meshes:
            of = [one.of_histories[k] for one in use.gears.values() if one.mesh == mesh]
            row[f"damage of {mesh}"] = max(of)
        for bearing in use.bearings.values():
            row[f"damage of {bearing.name} by L10"] = bearing.of_histories[k]
        rows.append(row)
    return rows


def damage_chart(use: PartUse) -> Chart:
    """Damage of all flanks and bearings, largest of each, over logarithmic ranges."""
    groups = {
        "flanks": {one.name: max(one.damage.flank, one.damage.back) for one in _gears(use)},
        "roots": {one.name: max(one.damage.root, one.damage.root_back) for one in _gears(use)},
        "bearings, L10": {one.name: one.damage["L10"] for one in use.bearings.values()},
    }
    known = {
        name: {part: min(value, 1e3) for part, value in values.items() if value > LEAST}
        for name, values in groups.items()
    }
    known = {name: values for name, values in known.items() if values}
    positive = [value for values in known.values() for value in values.values()]
    least = min(positive, default=LEAST) / 3.0
    without = "; parts without any are left out"
    return bars(
        f"Damage of gears and bearings each {use.per}, 1 is the end of a life{without}",
        known,
        f"damage each {use.per}",
        least=least,
    )


def state_parts(found: Findings, use: PartUse, question: PartQuestion, level: Level) -> None:
    """State damage and safety as figures and tables, and what is left out.

    Parameters
    ----------
    found : Findings
        Takes them.
    use : PartUse
        What was found.
    question : PartQuestion
        What was asked for.
    level : Level
        What may move.
    """
    for flank in use.gears.values():
        band = flank.band if np.isfinite(flank.band) else None
        found.found(f"damage of {flank.name} each {use.per}", flank.damage.largest, band)
    for one in use.bearings.values():
        found.found(f"damage of {one.name} by L10 each {use.per}", one.damage["L10"], one.band)
        found.found(f"S0 of {one.name}", one.static_safety, one.static_band)
    if use.gears:
        found.data("gear_damage", gear_damage_rows(use))
    if use.bearings:
        found.data("bearing_damage", bearing_damage_rows(use))
    for sentence in (*use.left_out, *_not_rated(question, level)):
        found.note(sentence)
    _assume(found, use, question)
    said = _worst(use)
    if said:
        found.say(*said)


def part_figures(found: Findings, use: PartUse | None) -> list[KeyFigure]:
    """Largest damage, and least static safety, of gears and bearings: two key figures at most."""
    if use is None:
        return []
    figures = []
    damages = {**_largest(use), **{one.name: one.damage["L10"] for one in _bearings(use)}}
    if damages:
        name = max(damages, key=lambda each: damages[each])
        of = use.gears.get(name)
        band = use.bearings[name].band if of is None else of.band
        limit: KeyLimit = {}
        if damages[name] > 1.0:  # a life ends within it; below that no design life is known
            limit = {"at_most": 1.0, "by": "the end of a life"}
        figures.append(
            found.value(
                f"damage of {name}, each {use.per}",
                damages[name],
                band if np.isfinite(band) else None,
                **limit,
            )
        )
    if use.bearings:
        least = min(_bearings(use), key=lambda one: one.static_safety)
        figures.append(
            found.value(
                f"static safety S0 of {least.name}",
                least.static_safety,
                least.static_band,
                at_least=1.0,
                by="ISO 76",
            )
        )
    elif use.gears:
        flank = min(_gears(use), key=lambda one: one.contact_safety / one.required[0])
        figures.append(
            found.value(
                f"static S_H of {flank.name}",
                flank.contact_safety,
                at_least=flank.required[0],
                by="required",
            )
        )
    return figures


def _gears(use: PartUse) -> list[FlankUse]:
    return list(use.gears.values())


def _bearings(use: PartUse) -> list[BearingUse]:
    return list(use.bearings.values())


def _largest(use: PartUse) -> Mapping[str, float]:
    return {one.name: one.damage.largest for one in _gears(use)}


def _borne(use: PartUse) -> str:
    """What a life is counted in."""
    return "events in a life" if use.per == "event" else "life [years]"


def _over(damage: float) -> float:
    """How often a damage comes until it is 1; infinite without any."""
    return 1.0 / damage if damage else np.inf


def _worst(use: PartUse) -> list[str]:
    """The gear and the bearing that wear most, as sentences."""
    said = []
    damages = _largest(use)
    for what, of in (
        ("gears", damages),
        ("bearings", {one.name: one.damage["L10"] for one in _bearings(use)}),
    ):
        if not of:
            continue
        name = max(of, key=lambda each: of[each])
        damage = of[name]
        by = "" if what == "gears" else " by L10"
        if damage == 0.0:
            said.append(f"No flank or root of the {what} is loaded above what it endures for ever.")
        elif not np.isfinite(damage):
            said.append(
                f"The {name} is loaded beyond its static strength, with the safety that is "
                "required: it does not bear this once."
            )
        elif use.per == "event":
            said.append(
                f"Of the {what} the {name} is damaged most: its life{by} bears "
                f"{value_text(1.0 / damage)} such events."
            )
        else:
            said.append(
                f"Of the {what} the {name} is damaged most: its life{by} is "
                f"{value_text(1.0 / damage, 'years')}."
            )
    return said


def _not_rated(question: PartQuestion, level: Level) -> Iterator[str]:
    """Bearings that have no damage, and why."""
    if question.counted.bearings and level is Level.TORSIONAL:
        names = ", ".join(one.name for one in question.counted.bearings)
        yield (
            f"Bodies only turn at the level torsional, without forces of bearings: {names} are "
            "not rated."
        )
    if question.unnamed:
        yield f"Not rated, for want of a catalogue entry: {', '.join(question.unnamed)}."


def _assume(found: Findings, use: PartUse, question: PartQuestion) -> None:
    """State what ratings in time take for granted."""
    if use.gears:
        found.assume(
            "load of each planet and along the face",
            "as statics have it at the mesh's torque",
            "",
            "assumed: planets pass all azimuths; K_v beside it, K_A = 1",
        )
    if use.bearings:
        rules = question.options
        assert rules is not None
        found.assume(
            "damage of bearings that stand",
            "none",
            "",
            "assumed: turns below the speed of standing are not counted, nor false brinelling",
        )
