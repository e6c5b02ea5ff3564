"""What is read from a machine that runs: torques, speeds, forces of meshes and bearings in time."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Literal

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.dynamics.bodies.damping_ratios import element_of, mesh_names
from fe_drivetrain.dynamics.bodies.equations import CONSTANT
from fe_drivetrain.dynamics.bodies.flexible import MOUNT, Housing
from fe_drivetrain.dynamics.bodies.levels import assembly
from fe_drivetrain.dynamics.bodies.system import bearing_springs
from fe_drivetrain.dynamics.time.motion import Motion
from fe_drivetrain.dynamics.time.running import Running

Kind = Literal["torque", "mesh", "bearing", "speed"]
"""What a channel is: torque of a shaft, force of a mesh or of a bearing, speed of a body."""

UNITS: dict[Kind, str] = {"torque": "N m", "mesh": "N", "bearing": "N", "speed": "rad/s"}


@dataclass(frozen=True)
class Channels:
    """Channels of a machine that runs, from forces of springs, displacements or velocities.

    Attributes
    ----------
    names : tuple of str
        Names (c,): "torque of HSS", "force of stage 3 mesh", "force of HS-A" (across its axis),
        "axial force of HS-B", "speed of generator".
    kinds : tuple of str
        Kind (c,) of each, see `Kind`.
    along, across : Floats
        Weights (c, m) of the springs' forces: the channel is the first sum, or the length of both
        where `round` says so.
    rates : Floats
        Weights (c, n) of the velocities.
    places : Floats
        Weights (c, n) of the displacements: torques of condensed shafts.
    round : Floats
        Flags (c,), 1 of forces across an axis.
    rated : Floats
        Values (c,) in steady turning at rated torque.
    """

    __repr__ = short_repr

    names: tuple[str, ...]
    kinds: tuple[Kind, ...]
    along: Floats
    across: Floats
    rates: Floats
    places: Floats
    round: Floats
    rated: Floats

    def of(self, motion: Motion) -> Floats:
        """(k, c) values over a motion that recorded all degrees of freedom."""
        return self._values(motion.forces, motion.q, motion.velocity)

    def _values(self, forces: Floats, q: Floats, velocity: Floats) -> Floats:
        m = self.along.shape[1]
        # springs behind those of the system are laws of the generator
        found = forces[:, :m] @ self.along.T
        both = np.flatnonzero(self.round)
        found[:, both] = np.hypot(found[:, both], forces[:, :m] @ self.across[both].T)
        if self.places.any():
            found = found + q @ self.places.T
        return np.asarray(found + velocity @ self.rates.T)

    def unit(self, k: int) -> str:
        """Unit of a channel by its number."""
        return UNITS[self.kinds[k]]


Weights = Mapping[int, float]
"""Weights of springs by their number."""

NOTHING: Weights = MappingProxyType({})


class _Rows:
    """Rows of channels as they are gathered."""

    def __init__(self, of: Running) -> None:
        self.springs = list(of.system.spring_names)
        self.n = len(of.system.names)
        self.rows: list[tuple[str, Kind, Floats, Floats, Floats, Floats, float]] = []

    def add(
        self,
        name: str,
        kind: Kind,
        along: Weights = NOTHING,
        across: Weights = NOTHING,
        rate: Floats | None = None,
        both: bool = False,
        place: Floats | None = None,
    ) -> None:
        """Add a channel of springs with weights by their number, or of a velocity or place."""
        first, second = np.zeros(len(self.springs)), np.zeros(len(self.springs))
        for weights, sums in ((along, first), (across, second)):
            sums[list(weights)] = list(weights.values())
        rates, places = (np.zeros(self.n) if one is None else one for one in (rate, place))
        self.rows.append((name, kind, first, second, rates, places, float(both)))

    def numbers(self, *names: str) -> list[int]:
        """Numbers of springs of these names, those that there are."""
        return [k for k, name in enumerate(self.springs) if name in names]


def machine_channels(of: Running) -> Channels:
    """All channels of a machine at its level; signs are such that torques and meshes, at rated
    torque, are positive.

    Parameters
    ----------
    of : Running
        The machine, turning steadily.
    """
    rows, system = _Rows(of), of.system
    condensed = _condensed_torques(of)
    for shaft in of.machine.shafts:
        if shaft.name in condensed:
            rows.add(f"torque of {shaft.name}", "torque", place=condensed[shaft.name])
        found = rows.numbers(f"{shaft.name} rx", f"{shaft.name} element 1 rx")
        if found and system.rows[found].any():
            rows.add(f"torque of {shaft.name}", "torque", dict.fromkeys(found, 1.0))
    names = [element_of(name) for name in system.spring_names]
    for mesh in mesh_names(of.machine):
        slices = {k: 1.0 for k, name in enumerate(names) if name == mesh}
        rows.add(f"force of {mesh}", "mesh", slices)
    for bearing in _bearings(of):
        _add_bearing(rows, of, bearing)
    for body in _turning_bodies(of):
        rows.add(f"speed of {body}", "speed", rate=of.row(body))
    labels, kinds, along, across, rates, places, both = zip(*rows.rows, strict=True)
    made = Channels(
        labels,
        kinds,
        np.array(along),
        np.array(across),
        np.array(rates),
        np.array(places),
        np.array(both),
        np.zeros(len(labels)),
    )
    return _with_rated(made, of)


def _with_rated(made: Channels, of: Running) -> Channels:
    """Values at rated torque, all torques, mesh forces and speeds then being positive."""
    turning, e = of.turning, of.equations
    # stiffnesses at their mean over a period
    e = replace(e, springs=replace(e.springs, wave=np.full(len(e.springs.rows), CONSTANT)))
    load = turning.torque * turning.to_rotor - turning.generator_torque * turning.to_generator
    load = load if turning.beside is None else load + turning.beside
    q = of.wind_up(e, load, turning.velocity).q
    stretch = e.springs.rows @ q
    gap = np.clip(stretch, e.springs.lower, e.springs.upper)
    forces = e.springs.stiffness * (stretch - gap)
    forces = forces if of.rollers is None else of.rollers.at(forces, q)
    rated = made._values(forces[None], q[None], turning.velocity[None])[0]
    turned = np.array([kind != "bearing" for kind in made.kinds]) & (rated < 0.0)
    sign = np.where(turned, -1.0, 1.0)
    return replace(
        made,
        along=sign[:, None] * made.along,
        rates=sign[:, None] * made.rates,
        places=sign[:, None] * made.places,
        rated=np.asarray(sign * rated),
    )


def of_planet(name: str) -> bool:
    """Whether a channel is a force of a planet's bearing or mesh."""
    return re.fullmatch(r".*force of stage \d+ (pin|sun-planet|ring-planet) .*", name) is not None


def _condensed_torques(of: Running) -> dict[str, Floats]:
    """(n,) weights of displacements for the torque at the front end of each condensed shaft."""
    if not of.flexible.shafts:
        return {}
    system = of.system
    built = assembly(of.machine, of.level, flexible=of.flexible)
    found = {}
    for element in built.superelements:
        if element.name in of.flexible.shafts:
            rows = [6 * system.bodies.index(name) + np.arange(6) for name in element.bodies]
            moved = system.expansion[np.concatenate(rows)]
            found[element.name] = np.asarray(element.stiffness[3] @ moved)
    return found


def _bearings(of: Running) -> list[str]:
    """Names of bearings in the housing, of those of planets, and of the gearbox's mount."""
    found = [bearing.name for bearing in of.machine.bearings]
    for number, stage in enumerate(of.machine.stages, start=1):
        if isinstance(stage, PlanetaryData):
            found += [
                f"stage {number} pin {k + 1} {pin.name}".strip()
                for k in range(stage.planets)
                for pin in stage.pins
            ]
    return [*found, MOUNT] if isinstance(of.flexible.housing, Housing) else found


def _add_bearing(rows: _Rows, of: Running, name: str) -> None:
    """Force across the axis of a bearing, and that along it where it carries one."""
    felt = np.abs(of.system.rows).max(axis=1) > 0.0
    by = {k: of.system.directions[k] for k in bearing_springs(rows.springs, name) if felt[k]}
    x, y, z = ({k: float(d[axis]) for k, d in by.items() if d[axis]} for axis in range(3))
    if y or z:
        rows.add(f"force of {name}", "bearing", y, z, both=True)
    if x:
        rows.add(f"axial force of {name}", "bearing", x)


def _turning_bodies(of: Running) -> list[str]:
    """The rotor, what each stage drives, and the generator."""
    kinds = ["sun" if isinstance(stage, PlanetaryData) else "pinion" for stage in of.machine.stages]
    rear = [f"stage {number} {kind}" for number, kind in enumerate(kinds, start=1)]
    return ["rotor", *rear, "generator"]
