"""Damage of gears and bearings by histories in time: of an event, or of a year of operation."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from functools import reduce
from operator import add
from pathlib import Path

from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.dynamics.bodies.advice import Rung
from fe_drivetrain.studies.gear_machine import gear_train
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.part_gears import FlankUse, GearUses
from fe_drivetrain.studies.part_loads import BearingDigest, CountedParts, PartDigest
from fe_drivetrain.turbine_loads.histories.sites import (
    HOURS_A_YEAR,
    Site,
    midpoint_edges,
    require_winds,
    rounded_wind,
)


@dataclass(frozen=True, eq=False)
class BearingUse:
    """What histories do to a bearing; of planets the mean damage and the largest load of all.

    Attributes
    ----------
    name, entry : str
        In the drivetrain, and in the catalogue.
    damage : Mapping[str, float]
        Damage of an event, or of a year, by L10 and L10m, and by L10r and L10mr where its rollers
        are in equilibrium; 1 is the end of that life.
    band : float
        Numerical uncertainty of the damage by L10.
    static_safety, static_band : float
        Least S0, and its numerical uncertainty.
    static_load, at : float
        Largest static equivalent load P_0 [N], and when it is [s].
    pressure : float
        Largest Hertz pressure of its rolling elements, at that load, or in all steps where rollers
        are in equilibrium [Pa].
    turns : float
        Turns of one ring against the other.
    standing : float
        Time below the speed of standing, which does no damage here [s].
    flanges : float
        Largest axial force that rolling elements do not carry [N].
    of_histories : tuple of float
        Damage by L10 of each history, as often as it is itself.
    """

    name: str
    entry: str
    damage: Mapping[str, float]
    band: float
    static_safety: float
    static_band: float
    static_load: float
    at: float
    pressure: float
    turns: float
    standing: float
    flanges: float
    of_histories: tuple[float, ...] = ()

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class PartUse:
    """What histories do to gears and bearings.

    Attributes
    ----------
    per : str
        What damage is of: "event" or "year".
    seconds : float
        Length of the event, or of all histories [s].
    gears : Mapping[str, FlankUse]
        Flanks of all gears that are rated.
    bearings : Mapping[str, BearingUse]
        Bearings that are rated.
    left_out : tuple of str
        What is not rated and why, as sentences.
    alone : bool
        Whether histories have the torque without the other loads of the hub.
    """

    per: str
    seconds: float
    gears: Mapping[str, FlankUse] = field(default_factory=dict)
    bearings: Mapping[str, BearingUse] = field(default_factory=dict)
    left_out: tuple[str, ...] = ()
    alone: bool = False

    __repr__ = short_repr

    def of_mesh(self, mesh: str) -> FlankUse | None:
        """The flank of a mesh with most damage; None where none is rated."""
        of = [one for one in self.gears.values() if one.mesh == mesh]
        return max(of, key=lambda one: one.damage.largest, default=None)


def times_a_year(
    seconds: Sequence[float], winds: Sequence[float], site: Site | None, files: Sequence[Path]
) -> list[float]:
    """How often each history comes in a year: all for ever, or weighted by the winds of a site.

    Parameters
    ----------
    seconds : sequence of float
        Length of each [s].
    winds : sequence of float
        Mean wind speed of each [m/s].
    site : Site or None
        Whose winds weight them; the time outside of all of them has no load.
    files : sequence of Path
        Where they are from.

    Raises
    ------
    InputError
        A site is given and histories have no wind speed, or one alone.
    """
    year = HOURS_A_YEAR * 3600.0
    if site is None:
        return [year / sum(seconds)] * len(seconds)
    require_winds(files, winds)
    at: dict[float, float] = {}
    for wind, lasts in zip(winds, seconds, strict=True):
        at[rounded_wind(wind)] = at.get(rounded_wind(wind), 0.0) + lasts
    speeds = sorted(at)
    shares = dict(zip(speeds, site.shares(midpoint_edges(speeds)).tolist(), strict=True))
    return [shares[rounded_wind(wind)] * year / at[rounded_wind(wind)] for wind in winds]


class PartRating:
    """Ratings of gears and bearings of a drivetrain at a level, ready for what histories count.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    rung : Rung
        Level by which meshes spread their load, and what gives.
    torque : float
        Rated torque of the rotor [N m].
    parts : CountedParts
        Its bearings.
    """

    def __init__(
        self, drivetrain: Drivetrain, rung: Rung, torque: float, parts: CountedParts
    ) -> None:
        self.parts = parts
        gears = drivetrain.gearbox.stages
        self.gears = (
            GearUses(gear_train(drivetrain, GearOptions(), torque), rung) if gears else None
        )

    def use(
        self,
        per: str,
        digests: Sequence[PartDigest],
        times: Sequence[float],
        coarser: tuple[PartDigest, PartDigest] | None = None,
    ) -> PartUse:
        """What histories that come so many times do to all parts.

        Parameters
        ----------
        per : str
            What damage is of: "event" or "year".
        digests : sequence of PartDigest
            Each history.
        times : sequence of float
            How often each comes.
        coarser : tuple of PartDigest, optional
            The same history with a step and with twice that step, for the band of the step.
        """
        alone = any(one.alone for one in digests)
        gears: dict[str, FlankUse] = {}
        left_out: tuple[str, ...] = ()
        if self.gears is not None:
            gears = self.gears.under(digests, times, coarser)
            left_out = self.gears.left_out
        bearings = {}
        for one in self.parts.bearings:
            found = [digest.bearings.get(one.name) for digest in digests]
            known = [each for each in found if each is not None]
            if len(known) == len(digests):
                pairs = None
                if coarser is not None:
                    pairs = (coarser[0].bearings[one.name], coarser[1].bearings[one.name])
                bearings[one.name] = _bearing_use(self.parts, one.name, known, times, pairs)
        seconds = sum(one.seconds for one in digests)
        return PartUse(per, seconds, gears, bearings, left_out, alone)


def _bearing_use(
    parts: CountedParts,
    name: str,
    digests: Sequence[BearingDigest],
    times: Sequence[float],
    coarser: tuple[BearingDigest, BearingDigest] | None,
) -> BearingUse:
    """A bearing under histories that come so many times."""
    one = next(each for each in parts.bearings if each.name == name)

    def weighted(value: Callable[[BearingDigest], float]) -> float:
        return sum(n * value(digest) for n, digest in zip(times, digests, strict=True))

    damage = {
        "L10": weighted(lambda each: float(each.standard.of_standard[0])),
        "L10m": weighted(lambda each: float(each.standard.of_standard[1])),
    }
    if parts.rollers:
        damage["L10r"] = weighted(lambda each: _of_rollers(each, "L10r"))
        damage["L10mr"] = weighted(lambda each: _of_rollers(each, "L10mr"))
    whole = reduce(add, digests)
    limits = whole.limits(one.rated)
    shares = [0.0, 0.0]
    if coarser is not None:
        sizes = ([float(of.standard.of_standard[0]), of.static_load] for of in coarser)
        shares = [abs(b / a - 1.0) if a else 0.0 for a, b in zip(*sizes, strict=True)]
    return BearingUse(
        name,
        one.entry_name,
        damage,
        damage["L10"] * shares[0],
        limits.static_safety,
        limits.static_safety * shares[1],
        limits.max_static,
        whole.at,
        limits.max_pressure,
        weighted(lambda each: each.standard.turns),
        weighted(lambda each: each.standard.standing),
        whole.flanges,
        tuple(float(one.standard.of_standard[0]) for one in digests),
    )


def _of_rollers(digest: BearingDigest, kind: str) -> float:
    """Damage by a kind of life that needs rollers; 0 without them."""
    return 0.0 if digest.rollers is None else digest.rollers.totals[kind]
