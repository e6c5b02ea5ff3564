"""Damage of gears and bearings in 20 years by normal operation and by shutdowns, counted twice."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.cases.dynamics.two_mw_loads import Rolling
from fe_drivetrain.cases.dynamics.two_mw_machine import ALLOWED, Chain
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import mesh_springs, pitch_contacts
from fe_drivetrain.report.suite import Record
from fe_drivetrain.turbine_loads.histories import rainflow_cycles
from fe_drivetrain.turbine_loads.histories.sites import HOURS_A_YEAR

HOURS = 161950.0
"""Hours of operation in 20 years: Al-Hamadani 2018, Table 7.1."""

STOPS = 22000.0
"""Shutdowns in 20 years: 1100 a year, section 7.2.1."""

SLOPE = 13.22
"""Exponent of contact stress: pitting of case-hardened gears from 1e5 to 5e7 loads, ISO 6336-2."""

BEARING_SLOPE = 20.0 / 3.0
"""Exponent of the pressure of rollers: 10/3 of their load."""

KNEE = 5e7
"""Loads that gears endure at the allowed stress."""


@dataclass(frozen=True)
class Share:
    """Damage of a part in 20 years.

    Attributes
    ----------
    normal, stop : float
        By normal operation and by shutdowns; 1 is the end of life.
    """

    normal: float
    stop: float

    @property
    def share(self) -> float:
        """Share of shutdowns in all of it; 0 of a part without damage."""
        whole = self.normal + self.stop
        return self.stop / whole if whole else 0.0


@dataclass(frozen=True, eq=False)
class Shares:
    """Damage of all parts.

    Attributes
    ----------
    gears, bearings : Mapping[str, Share]
        By ISO 6336 and ISO 281: each pass of a tooth or roller counts.
    his : Mapping[str, Share]
        Shares of meshes and bearings by cycles of the contact stress over time, as in the thesis.
    """

    gears: Mapping[str, Share]
    bearings: Mapping[str, Share]
    his: Mapping[str, Share]

    def rows(self) -> list[Record]:
        """A row for each part."""
        return [
            {
                "part": name,
                "counted": by,
                "normal operation, 20 years": one.normal,
                "shutdowns, 20 years": one.stop,
                "share of shutdowns": one.share,
            }
            for by, kind in (
                ("each pass, ISO 6336", self.gears),
                ("each pass, ISO 281", self.bearings),
                ("cycles of the stress, as in the thesis", self.his),
            )
            for name, one in kind.items()
        ]


def damage_shares(one: Chain, rollers: Mapping[str, tuple[Rolling, Rolling]]) -> Shares | None:
    """Damage in 20 years of the normal operation and the shutdowns of the thesis.

    Parameters
    ----------
    one : Chain
        The machine.
    rollers : Mapping[str, tuple of Rolling]
        Rollers of its bearings in both states.
    """
    normal, stop = one.normal.parts, one.stop.parts
    if normal is None or stop is None:
        return None
    years = HOURS / HOURS_A_YEAR
    gears = {
        name: Share(years * use.damage.largest, STOPS * stop.gears[name].damage.largest)
        for name, use in normal.gears.items()
    }
    bearings = {
        name: Share(years * use.damage["L10"], STOPS * stop.bearings[name].damage["L10"])
        for name, use in normal.bearings.items()
    }
    return Shares(gears, bearings, by_cycles(one, rollers))


def by_cycles(one: Chain, rollers: Mapping[str, tuple[Rolling, Rolling]]) -> dict[str, Share]:
    """Damage by rainflow cycles of the contact stress, each as often as its history comes.

    Parameters
    ----------
    one : Chain
        The machine.
    rollers : Mapping[str, tuple of Rolling]
        Rollers of its bearings in both states.
    """
    times = HOURS * 3600.0 / float(np.ptp(one.normal.samples.times))
    contacts = pitch_contacts(one.rig.machine)
    found = {}
    for name, springs in mesh_springs(one.rig.machine).items():
        unit = contacts[name].under(1.0).pressure
        of = [
            unit * np.sqrt(np.abs(state.samples.of(f"force of {springs[0]}")))
            for state in (one.normal, one.stop)
        ]
        each = [cycle_damage(stress, SLOPE, ALLOWED, KNEE) for stress in of]
        found[name] = Share(times * each[0], STOPS * each[1])
    for name, pair in rollers.items():
        # the size of the damage, and no share, depends on the pressure that a million loads end at
        each = [cycle_damage(rolls.pressure, BEARING_SLOPE, 1e9, 1e6) for rolls in pair]
        if each[0] > 0.0:
            found[name] = Share(times * each[0], STOPS * each[1])
    return found


def cycle_damage(stress: Floats, slope: float, allowed: float, loads: float) -> float:
    """Damage of the rainflow cycles of a history, as ranges of stress.

    Parameters
    ----------
    stress : ndarray, (n,)
        Over time [Pa].
    slope : float
        Exponent of the S-N line.
    allowed, loads : float
        A point of it: stress [Pa] that so many loads end.
    """
    cycles = rainflow_cycles(stress, "repeated")
    return float(cycles.counts @ (cycles.ranges / allowed) ** slope) / loads
