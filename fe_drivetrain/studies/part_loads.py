"""What a history does to gears and bearings, counted as it comes: turns at each torque, damage.

Each mesh has the turns of the rotor by the torque that its own force stands for; each bearing its
damage by ISO 281 and its largest load. Both come from forces and speeds in time, in little memory.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from fe_drivetrain.bearing.catalogue import Entry
from fe_drivetrain.bearing_life.coupled.reaction_paths import carried_loads, damage_of_forces
from fe_drivetrain.bearing_life.life.life_rules import LifeRules
from fe_drivetrain.bearing_life.life.limits import Limits, max_pressures, static_use
from fe_drivetrain.bearing_life.life.rated import RatedBearing
from fe_drivetrain.bearing_life.life.roller_damage import Damage
from fe_drivetrain.bearing_life.life.roller_models import balanced, rigid_rings
from fe_drivetrain.bearing_life.life.standard_damage import StandardDamage, standard_damage
from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.components import RPM
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.mesh_loads import mesh_springs
from fe_drivetrain.dynamics.time.bearing_forces import BearingForces, bearing_forces
from fe_drivetrain.dynamics.time.machine_channels import Channels
from fe_drivetrain.dynamics.time.motion import Motion
from fe_drivetrain.dynamics.time.running import Running
from fe_drivetrain.studies.gear_options import GearOptions
from fe_drivetrain.studies.gear_spectra import TorqueSpectrum, merged, spectrum_of
from fe_drivetrain.turbine_loads.hub_loads.drive_history import DriveHistory

ROLLER_STEP = 5e-3
"""Time from one equilibrium of rollers to the next, where steps are shorter [s]."""


@dataclass(frozen=True, eq=False)
class ForcedBearing:
    """A bearing of the catalogue whose loads are those of a history in time.

    Attributes
    ----------
    name, entry_name : str
        In the drivetrain, and in the catalogue.
    entry : Entry
        Entry of the catalogue.
    rated : RatedBearing
        With ratings.
    rules : LifeRules
        Its lubricant, and the ring that turns.
    """

    name: str
    entry_name: str
    entry: Entry
    rated: RatedBearing
    rules: LifeRules

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class CountedParts:
    """Parts of a drivetrain whose damage is counted.

    Attributes
    ----------
    bearings : tuple of ForcedBearing
        Those with an entry of the catalogue.
    rollers : bool
        Whether rollers of bearings are brought into equilibrium, see `ROLLER_STEP`.
    """

    bearings: tuple[ForcedBearing, ...] = ()
    rollers: bool = False

    __repr__ = short_repr

    @property
    def content(self) -> list[Any]:
        """All of it, for the cache."""
        return [self.rollers, *([b.name, repr(b.rated), repr(b.rules)] for b in self.bearings)]


NO_PARTS = CountedParts()
"""Gears alone."""


@dataclass(frozen=True, eq=False)
class BearingDigest:
    """A bearing over a history; of planets the mean damage and the largest load of all.

    Attributes
    ----------
    standard : StandardDamage
        Turns, and damage by L10 and L10m.
    rollers : Damage or None
        Damage with its rollers in equilibrium, where that is asked for.
    peak : Floats
        (5,) what rolling elements carry where the static equivalent load is largest [N, N m].
    static_load, at : float
        That load P_0 [N], and when it is [s].
    flanges : float
        Largest axial force that rolling elements do not carry [N].
    """

    standard: StandardDamage
    rollers: Damage | None
    peak: Floats
    static_load: float
    at: float
    flanges: float

    __repr__ = short_repr

    def __add__(self, other: BearingDigest) -> BearingDigest:
        """Damage adds up, the larger of both loads stays."""
        larger = self if self.static_load >= other.static_load else other
        rollers = self.rollers
        if rollers is not None and other.rollers is not None:
            rollers = rollers + other.rollers
        return replace(
            larger,
            standard=self.standard + other.standard,
            rollers=rollers,
            flanges=max(self.flanges, other.flanges),
        )

    def limits(self, rated: RatedBearing) -> Limits:
        """Static safety and largest Hertz pressure at the peak, and of all steps with rollers."""
        laminae, converged = rigid_rings(rated.bearing)(self.peak[None])
        pressures = max_pressures(rated, balanced(laminae, converged))
        use = static_use(rated, self.peak[None], pressures)
        found = Limits(
            max_static=self.static_load,
            max_pressure=float(pressures.max()),
            max_use=float(use.max()),
        )
        return found if self.rollers is None else found + self.rollers.limits


@dataclass(frozen=True, eq=False)
class PartDigest:
    """Gears and bearings over a history.

    Attributes
    ----------
    seconds : float
        Length of the history [s].
    meshes : Mapping[str, TorqueSpectrum]
        Turns of the rotor by the torque of the rotor that the force of each mesh stands for.
    peaks : Mapping[str, tuple of float]
        Largest and least of these torques [N m].
    bearings : Mapping[str, BearingDigest]
        Each bearing of the catalogue, where the level has forces of bearings.
    alone : float
        1 where the torque acts without the other loads of the hub.
    """

    seconds: float
    meshes: Mapping[str, TorqueSpectrum]
    peaks: Mapping[str, tuple[float, float]]
    bearings: Mapping[str, BearingDigest]
    alone: float = 1.0

    __repr__ = short_repr


@dataclass(frozen=True, eq=False)
class _Mesh:
    """A mesh by its channels: those of all its planets, and the speed of what it drives."""

    name: str
    forces: Ints
    speed: int


@dataclass(eq=False)
class PartReader:
    """What is read of gears and bearings from a machine that runs.

    Attributes
    ----------
    of : Running
        The machine.
    channels : Channels
        Its channels.
    parts : CountedParts
        Whose damage is counted.
    """

    of: Running
    channels: Channels
    parts: CountedParts
    meshes: list[_Mesh] = field(init=False)
    bearings: dict[str, BearingForces] = field(init=False)

    def __post_init__(self) -> None:
        names = self.channels.names
        driven = [n for n in names if n.startswith("speed of stage ")]
        self.meshes = []
        for mesh, springs in mesh_springs(self.of.machine).items():
            stage = int(mesh.split(" ")[1])
            forces = np.array([names.index(f"force of {spring}") for spring in springs])
            self.meshes.append(_Mesh(mesh, forces, names.index(driven[stage - 1])))
        known = bearing_forces(self.of) if self.parts.bearings else {}
        asked = {one.name for one in self.parts.bearings}
        self.bearings = {name: one for name, one in known.items() if name in asked}

    def counter(self, history: DriveHistory | None = None) -> PartCounter:
        """A count of a history, or of an event, which has no loads of the hub beside torque."""
        return PartCounter(self, history)


class PartCounter:
    """A count of what a history does to gears and bearings.

    Parameters
    ----------
    reader : PartReader
        Machine and parts.
    history : DriveHistory or None
        Loads of the hub over time; None of an event.
    """

    def __init__(self, reader: PartReader, history: DriveHistory | None) -> None:
        self.reader, self.history = reader, history
        self.seconds = 0.0
        self.meshes: dict[str, TorqueSpectrum] = {}
        self.peaks: dict[str, tuple[float, float]] = {}
        self.bearings: dict[str, BearingDigest] = {}

    def add(self, motion: Motion, values: Floats) -> None:
        """Add a piece of motion, the first of whose records the piece before ended with.

        Parameters
        ----------
        motion : Motion
            k records of all degrees of freedom.
        values : ndarray, (k, c)
            The channels.
        """
        seconds, times = np.diff(motion.times), motion.times[1:]
        self.seconds += float(seconds.sum())
        hub = self._hub(times)
        for mesh in self.reader.meshes:
            self._add_mesh(mesh, values[1:], seconds, hub)
        for one in self.reader.parts.bearings:
            if one.name in self.reader.bearings:
                self._add_bearing(one, motion, seconds)

    def digest(self) -> PartDigest:
        """All of it."""
        absent = self.history is None or not self.history.has_all
        return PartDigest(self.seconds, self.meshes, self.peaks, self.bearings, float(absent))

    def _hub(self, times: Floats) -> Floats:
        """(k, 6) loads of the hub; zero where a history has the torque alone."""
        if self.history is None or not self.history.has_all:
            return np.zeros((len(times), 6))
        known = self.history
        return np.column_stack([np.interp(times, known.time, load) for load in known.loads.T])

    def _add_mesh(self, mesh: _Mesh, values: Floats, seconds: Floats, hub: Floats) -> None:
        of, channels = self.reader.of.turning, self.reader.channels
        force = values[:, mesh.forces].mean(axis=1) / channels.rated[mesh.forces].mean()
        speed = values[:, mesh.speed] / channels.rated[mesh.speed]
        rotor = abs(float(of.to_rotor @ of.velocity))
        turns = np.abs(speed) * rotor * seconds / (2.0 * np.pi)
        torque, width = of.torque * force, of.torque / GearOptions.classes
        found = spectrum_of(torque, hub, turns, seconds, width)
        before, high, low = self.meshes.get(mesh.name), float(torque.max()), float(torque.min())
        if before is not None:
            found = merged([before, found], width)
            most, least = self.peaks[mesh.name]
            high, low = max(high, most), min(low, least)
        self.meshes[mesh.name], self.peaks[mesh.name] = found, (high, low)

    def _add_bearing(self, one: ForcedBearing, motion: Motion, seconds: Floats) -> None:
        loads, speeds = self.reader.bearings[one.name].of(self.reader.of, motion)
        count = loads.shape[1]  # planets share the time, so that damage is that of their mean
        each, turned = loads[1:].reshape(-1, 6), np.abs(speeds[1:]).ravel() * RPM
        lasting = np.repeat(seconds / count, count)
        carried = carried_loads(one.rated, each)
        static = one.rated.static_load(carried.loads)
        k = int(static.argmax())
        rollers = None
        if self.reader.parts.rollers:
            rollers = _rollers_of(one, loads[1:], np.abs(speeds[1:]) * RPM, seconds)
        found = BearingDigest(
            standard_damage(one.rated, carried.loads, turned, lasting, one.rules),
            rollers,
            carried.loads[k],
            float(static[k]),
            float(motion.times[1 + k // count]),
            float(carried.flanges.max()),
        )
        before = self.bearings.get(one.name)
        self.bearings[one.name] = found if before is None else before + found


def _rollers_of(one: ForcedBearing, loads: Floats, rpm: Floats, seconds: Floats) -> Damage:
    """Damage with rollers in equilibrium, of loads (k, p, 6) every `ROLLER_STEP` at most."""
    every, count = max(1, int(ROLLER_STEP / seconds.mean() + 1e-6)), loads.shape[1]
    first = np.arange(0, len(loads), every)
    lasting = np.repeat(np.add.reduceat(seconds, first) / count, count)
    return damage_of_forces(
        one.rated, loads[first].reshape(-1, 6), rpm[first].ravel(), lasting, one.rules
    )
