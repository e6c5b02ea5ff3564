"""Loads and contact stresses of gears and bearings, in normal operation and in a shutdown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import cos

import numpy as np

from fe_drivetrain.bearing.geometry import pitch_ratio
from fe_drivetrain.bearing_life.coupled.reaction_paths import carried_loads
from fe_drivetrain.bearing_life.life import rigid_rings
from fe_drivetrain.bearing_life.life.limits import max_pressures
from fe_drivetrain.bearing_life.life.roller_models import balanced
from fe_drivetrain.cases.dynamics.two_mw_machine import Chain
from fe_drivetrain.common import Floats
from fe_drivetrain.dynamics import mesh_springs, pitch_contacts
from fe_drivetrain.dynamics.bodies.bearing_reactions import planet_bearing_name
from fe_drivetrain.gear import LineContact, reduced_modulus
from fe_drivetrain.report.suite import Record
from fe_drivetrain.studies import TransientResult
from fe_drivetrain.studies.part_loads import ForcedBearing
from fe_drivetrain.studies.transient_runs import Extreme, Samples

EVERY, QUICK_EVERY = 0.01, 0.05
"""Time from one equilibrium of rollers to the next [s]."""

Extremes = Mapping[str, Extreme]


def largest(extremes: Extremes, names: Sequence[str]) -> float:
    """Largest value of several channels."""
    return max(extremes[name].most for name in names)


def band_of(extremes: Extremes, names: Sequence[str]) -> float:
    """What the step leaves uncertain of it."""
    name = max(names, key=lambda one: extremes[one].most)
    return extremes[name].most_band or 0.0


@dataclass(frozen=True)
class Change:
    """Largest load of a part in both states; forces in N, bands by the step.

    Attributes
    ----------
    name : str
        The part.
    channels : tuple of str
        Its channels, one for each planet.
    normal, stop : float
        Largest load.
    normal_band, stop_band : float
        Bands by the step.
    least, rated : float
        Least load in the shutdown, and that at rated torque.
    reversals : int
        How often it changes its sign in the shutdown, of one channel at most.
    at : float
        When it is largest [s].
    """

    name: str
    channels: tuple[str, ...]
    normal: float
    stop: float
    normal_band: float
    stop_band: float
    least: float
    rated: float
    reversals: int
    at: float

    @property
    def ratio(self) -> float:
        """Shutdown over normal operation."""
        return self.stop / self.normal

    @property
    def band(self) -> float:
        """Band of the ratio by the step."""
        return self.ratio * (self.normal_band / self.normal + self.stop_band / self.stop)


def change(name: str, channels: Sequence[str], normal: Extremes, stop: Extremes) -> Change:
    """Largest load of a part in both states.

    Parameters
    ----------
    name : str
        The part.
    channels : sequence of str
        Its channels.
    normal, stop : Mapping[str, Extreme]
        Extremes of both.
    """
    of = [stop[one] for one in channels]
    return Change(
        name,
        tuple(channels),
        largest(normal, channels),
        largest(stop, channels),
        band_of(normal, channels),
        band_of(stop, channels),
        min(one.least for one in of),
        float(np.mean([one.rated for one in of])),
        max(one.reversals for one in of),
        max(of, key=lambda one: one.most).most_at,
    )


def mesh_changes(one: Chain, normal: Extremes, stop: Extremes) -> dict[str, Change]:
    """Meshes by name, planets' together.

    Parameters
    ----------
    one : Chain
        The machine.
    normal, stop : Mapping[str, Extreme]
        Extremes of both states.
    """
    return {
        name: change(name, [f"force of {spring}" for spring in springs], normal, stop)
        for name, springs in mesh_springs(one.rig.machine).items()
    }


def bearing_changes(one: Chain, normal: Extremes, stop: Extremes) -> dict[str, Change]:
    """Bearings by name, each planet's apart, with forces across their axes.

    Parameters
    ----------
    one : Chain
        The machine.
    normal, stop : Mapping[str, Extreme]
        Extremes of both states.
    """
    found = {}
    for channel, extreme in stop.items():
        name = channel.removeprefix("force of ")
        if extreme.kind == "bearing" and name != channel and channel in normal:
            found[name] = change(name, [channel], normal, stop)
    return found


def tangential(one: Chain) -> dict[str, float]:
    """Circumferential over normal force of each mesh."""
    return {
        name: cos(contact.mesh.base_helix) * cos(contact.mesh.pressure_angle)
        for name, contact in pitch_contacts(one.rig.machine).items()
    }


def mesh_rows(one: Chain, changes: Mapping[str, Change]) -> list[Record]:
    """A row for each mesh: circumferential force and contact stress in both states.

    Parameters
    ----------
    one : Chain
        The machine.
    changes : Mapping[str, Change]
        See `mesh_changes`.
    """
    contacts, share = pitch_contacts(one.rig.machine), tangential(one)
    rows: list[Record] = []
    for name, of in changes.items():
        normal, stop = (contacts[name].under(force) for force in (of.normal, of.stop))
        rows.append(
            {
                "mesh": name,
                "largest in normal operation [kN]": share[name] * of.normal / 1e3,
                "largest in the shutdown [kN]": share[name] * of.stop / 1e3,
                "shutdown over normal": of.ratio,
                "± by the step": of.band,
                "least in the shutdown [kN]": share[name] * of.least / 1e3,
                "reversals": of.reversals,
                "largest at [s]": of.at,
                "contact stress, normal [MPa]": normal.pressure / 1e6,
                "contact stress, shutdown [MPa]": stop.pressure / 1e6,
                "depth of the largest shear, normal [mm]": 1e3 * normal.max_shear[1],
                "depth, shutdown [mm]": 1e3 * stop.max_shear[1],
                "largest shear, shutdown [MPa]": stop.max_shear[0] / 1e6,
            }
        )
    return rows


@dataclass(frozen=True, eq=False)
class Rolling:
    """What a bearing's rollers do over time.

    Attributes
    ----------
    times : ndarray, (n,)
        [s].
    loads : ndarray, (n,)
        Radial [N].
    pressure : ndarray, (n,)
        Largest Hertz pressure [Pa].
    loaded : ndarray, (n,)
        Number of rollers that carry load.
    """

    times: Floats
    loads: Floats
    pressure: Floats
    loaded: Floats


def rolling(of: ForcedBearing, samples: Samples, name: str, every: float = EVERY) -> Rolling:
    """Rollers of a bearing in equilibrium with its load, at times and at the extreme loads.

    Parameters
    ----------
    of : ForcedBearing
        The bearing.
    samples : Samples
        Loads over time.
    name : str
        Its name among the channels, as "stage 1 pin 2 upwind".
    every : float
        Time from one equilibrium to the next [s].
    """
    force = samples.of(f"force of {name}")
    step = float(samples.times[1] - samples.times[0])
    at = np.arange(0, len(force), max(1, round(every / step)))
    at = np.union1d(at, [force.argmax(), force.argmin()])
    loads = np.zeros((len(at), 6))
    loads[:, 2] = np.maximum(force[at], 1.0)
    if f"axial force of {name}" in samples.names:
        loads[:, 0] = samples.of(f"axial force of {name}")[at]
    laminae = balanced(*rigid_rings(of.rated.bearing)(carried_loads(of.rated, loads).loads))
    loaded = sum((q.sum(axis=2) > 0.0).sum(axis=1) for q in laminae)
    return Rolling(
        samples.times[at],
        force[at],
        max_pressures(of.rated, laminae),
        np.asarray(loaded, dtype=np.float64),
    )


def catalogued(one: Chain) -> dict[str, ForcedBearing]:
    """Bearings with rollers by the names of channels: each planet's apart."""
    found: dict[str, ForcedBearing] = {}
    names = {
        name.removeprefix("force of ")
        for name in one.stop.samples.names
        if name.startswith("force of ")
    }
    for number, stage in enumerate(one.rig.machine.stages, start=1):
        for pin in getattr(stage, "pins", ()):
            known = one.bearings.get(planet_bearing_name(number, pin.name))
            for planet in range(1, getattr(stage, "planets", 0) + 1):
                name = f"stage {number} pin {planet} {pin.name}".strip()
                if known is not None and name in names:
                    found[name] = known
    return found | {name: of for name, of in one.bearings.items() if name in names}


def rolled(one: Chain, every: float = EVERY) -> dict[str, tuple[Rolling, Rolling]]:
    """Rollers of all bearings in normal operation and in the shutdown, see `rolling`."""
    states = one.normal.samples, one.stop.samples
    return {
        name: (rolling(of, states[0], name, every), rolling(of, states[1], name, every))
        for name, of in catalogued(one).items()
    }


def contact_of(of: ForcedBearing, pressure: float) -> LineContact:
    """Contact of a roller with the inner race at a pressure [Pa]."""
    row = of.rated.bearing.rows[0]
    radius = 0.5 * row.diameter * (1.0 - pitch_ratio(row))
    return LineContact(np.pi * radius * pressure**2 / reduced_modulus(), radius, reduced_modulus())


def bearing_rows(
    one: Chain, changes: Mapping[str, Change], rollers: Mapping[str, tuple[Rolling, Rolling]]
) -> list[Record]:
    """A row for each bearing: largest load, pressure, depth and rollers in both states.

    Parameters
    ----------
    one : Chain
        The machine.
    changes : Mapping[str, Change]
        See `bearing_changes`.
    rollers : Mapping[str, tuple of Rolling]
        See `rolled`.
    """
    rows: list[Record] = []
    known = catalogued(one)
    for name, of in changes.items():
        row: Record = {
            "bearing": name,
            "largest in normal operation [kN]": of.normal / 1e3,
            "largest in the shutdown [kN]": of.stop / 1e3,
            "shutdown over normal": of.ratio,
            "± by the step": of.band,
        }
        names = ("normal", "shutdown")
        for state, rolls in zip(names, rollers.get(name, (None, None)), strict=True):
            most = None if rolls is None else float(rolls.pressure.max())
            row[f"pressure, {state} [MPa]"] = None if most is None else most / 1e6
            depth = None if most is None else contact_of(known[name], most).max_shear[1]
            row[f"depth, {state} [mm]"] = None if depth is None else 1e3 * depth
            row[f"fewest rollers loaded, {state}"] = (
                None if rolls is None else int(rolls.loaded.min())
            )
            row[f"most rollers loaded, {state}"] = (
                None if rolls is None else int(rolls.loaded.max())
            )
        rows.append(row)
    return rows


def moments(result: TransientResult, channel: str) -> tuple[float, float, float, float]:
    """Mean, standard deviation, skewness and excess kurtosis of a channel.

    Parameters
    ----------
    result : TransientResult
        The state.
    channel : str
        The channel.
    """
    values = result.samples.of(channel)
    mean, spread = float(values.mean()), float(values.std())
    z = (values - mean) / spread
    return mean, spread, float((z**3).mean()), float((z**4).mean() - 3.0)
