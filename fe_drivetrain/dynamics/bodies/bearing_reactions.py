"""Loads on all bearings of a machine under loads on its hub: one linear solve per level.

A machine of springs is linear, so that the load on a bearing's inner ring is a matrix times the
hub's loads, plus that of the weight. A history of any length is then one matrix product. Hub loads
are those of the rotor on its shaft, with the rotor's weight in them. Planets turn with their
carrier: a planet's bearing has such a matrix for each azimuth of the carrier, in the frame of its
pin, on which its inner ring stands.
"""

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from math import cos, sin

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.common.scaling import scaled_solve
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import along_x, wrench_transport
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.bodies import assemble
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import (
    Assembly,
    Level,
    assembly,
    azimuths,
    planetary_set,
)
from fe_drivetrain.dynamics.bodies.static import static
from fe_drivetrain.dynamics.bodies.system import System

AZIMUTHS = 6
"""Azimuths of a carrier over a turn. A load with a constant part and one that turns once has a
fourth power of four harmonics, whose mean six equal steps give exactly."""

SAME = 1e-6
"""Difference over the maximum up to which a bearing's loads are the same at all azimuths: round-off
of solves between stiffnesses that are many powers of ten apart."""


_FORCES, _MOMENTS, _HUB, _WEIGHT = slice(3), slice(3, 6), slice(6), slice(6, 7)


@dataclass(frozen=True)
class Reactions:
    """Load on the inner ring of a bearing by the loads of its machine.

    Attributes
    ----------
    name : str
        Name of the bearing: "HS-A"; of planets "stage 1 pin upwind", which is that of each planet.
    by_hub : Floats
        Load (a, 6, 6) on the inner ring [N, N m] under each unit load on the hub: one matrix where
        it is the same at all azimuths, else one for each.
    by_weight : Floats
        Load (a, 6) under the weight of all but the rotor [N, N m].
    speed_ratio : float
        Speed of one ring against the other over that of the rotor, without a sign.
    planets : int
        Number of planets with such a bearing, whose frame is that of the pin: x, outwards from the
        stage's axis, and along the tangent about +x. 0 of a bearing in the housing, in the frame
        of the machine.
    """

    name: str
    by_hub: Floats
    by_weight: Floats
    speed_ratio: float
    planets: int = 0

    __repr__ = short_repr

    def under(self, hub: ArrayLike, weight: bool = True) -> Floats:
        """Loads on the inner ring.

        Parameters
        ----------
        hub : array_like, (n, 6)
            Forces and moments of the rotor on the hub [N, N m].
        weight : bool
            Whether bodies behind the rotor have their weight.

        Returns
        -------
        loads : ndarray, (n, a, 6)
            For each azimuth [N, N m].
        """
        loads = np.einsum("aij,nj->nai", self.by_hub, np.asarray(hub, dtype=float))
        return np.asarray(loads + self.by_weight if weight else loads)


class BearingModel:
    """A machine at a level, for the loads of its bearings.

    The generator is held, so that the rotor's torque is in equilibrium; meshes are without
    friction, and nothing accelerates.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    level : Level
        Level from rigid bodies on.
    count : int
        Number of azimuths of the carriers over a turn.
    flexible : Flexible, optional
        Carriers and housing that give.

    Raises
    ------
    InputError
        The level is torsional, which has forces of meshes alone; or a body moves freely.
    """

    def __init__(
        self,
        machine: MachineTable,
        level: Level = Level.FLEXIBLE,
        count: int = AZIMUTHS,
        flexible: Flexible | None = None,
    ) -> None:
        if level is Level.TORSIONAL:
            raise InputError(
                f"a torsional model of {machine.title!r} has no forces of bearings: give rigid "
                "bodies or flexible shafts"
            )
        self.machine = machine
        turning = any(isinstance(stage, PlanetaryData) for stage in machine.stages)
        turned = [float(a) for a in azimuths(count if turning else 1)]
        # a planet sees the azimuth of its own carrier: all carriers stand at the same one
        stages = range(1, len(machine.stages) + 1)
        self._at = [_Azimuth(machine, level, dict.fromkeys(stages, a), a, flexible) for a in turned]

        self._steady = frozenset(
            name for name, loads in self._loads({}, False).items() if _same(loads)
        )

    @property
    def degrees(self) -> int:
        """Number of degrees of freedom."""
        return len(self._at[0].system.names)

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all bearings: in the housing in the order of the machine, then of planets."""
        return tuple(self._at[0].rings)

    def reactions(
        self, factors: Mapping[str, float] | None = None, of: Collection[str] | None = None
    ) -> dict[str, Reactions]:
        """Loads of bearings.

        Parameters
        ----------
        factors : mapping of str to float, optional
            Factors on the stiffness of bearings by name; 1 where none is given.
        of : collection of str, optional
            Names of the bearings whose loads are asked for; all where left out.

        Returns
        -------
        found : dict of str to Reactions
            In the order of `names`.

        Raises
        ------
        InputError
            There is no bearing of a name.
        """
        names = self.names if of is None else tuple(of)
        for name in (*(factors or {}), *names):
            require_known("bearing", name, self.names)
        found, each = {}, self._loads(factors or {}, self._steady.issuperset(names))
        for name in names:
            ring = self._at[0].rings[name]
            loads = each[name][:1] if name in self._steady else each[name]
            found[name] = Reactions(
                name, loads[:, :, :6], loads[:, :, 6], ring.speed_ratio, ring.planets
            )
        return found

    def _loads(self, factors: Mapping[str, float], first: bool) -> dict[str, Floats]:
        """(a, 6, 7) loads of all bearings at all azimuths, or at the first alone."""
        each = [at.loads(factors) for at in (self._at[:1] if first else self._at)]
        return {name: np.array([of[name] for of in each]) for name in self._at[0].rings}


def bearing_reactions(
    machine: MachineTable,
    level: Level = Level.FLEXIBLE,
    count: int = AZIMUTHS,
    flexible: Flexible | None = None,
) -> dict[str, Reactions]:
    """Loads of all bearings of a machine by its hub loads; arguments as those of `BearingModel`."""
    return BearingModel(machine, level, count, flexible).reactions()


def planet_bearing_name(stage: int, pin: str) -> str:
    """Name of the bearing of each planet, such as "stage 1 pin upwind"; the pin's may be empty."""
    return f"stage {stage} pin {pin}".strip()


@dataclass(frozen=True)
class _Ring:
    """Inner ring of a bearing: the springs by which it is held, where it is, and how it turns."""

    springs: str
    body: str
    at: Floats
    angle: float
    speed_ratio: float
    planets: int


class _Azimuth:
    """A machine with its carriers at one azimuth."""

    def __init__(
        self,
        machine: MachineTable,
        level: Level,
        azimuth: Mapping[int, float],
        angle: float,
        flexible: Flexible | None,
    ) -> None:
        built = assembly(machine, level, azimuth, held_generator=True, flexible=flexible)
        # with bodies without mass: springs by which they are eliminated could not change
        self.system = assemble(built.bodies, built.springs, built.superelements)
        self.load = _unit_loads(self.system, machine.rotor.apart[0])
        static(self.system, self.load[:, 6])  # refuses what moves freely
        self.rings = {**_housing_rings(built), **_planet_rings(machine, built, angle)}
        self._of = [name.rpartition(" ")[0] for name in self.system.spring_names]
        self._rows = {name: self._wrenches(built, ring) for name, ring in self.rings.items()}

    def loads(self, factors: Mapping[str, float]) -> dict[str, Floats]:
        """(6, 7) load on each bearing's inner ring under the hub's unit loads and gravity."""
        system, k = self.system, self.system.stiffness.copy()
        for name, factor in factors.items():
            ring = self.rings[name]
            own = [_same_bearing(of, ring) for of in self._of]
            k[own] *= factor
        K = system.rows.T @ (k[:, None] * system.rows) + system.extra
        forces = k[:, None] * (system.rows @ scaled_solve(K, self.load))
        return {name: rows @ forces for name, rows in self._rows.items()}

    def _wrenches(self, built: Assembly, ring: _Ring) -> Floats:
        """(6, springs) load on the inner ring at the bearing's centre by the springs' forces."""
        centre = next(b.position for b in built.bodies if b.name == ring.body)
        moved = _turned(ring.angle) @ wrench_transport(np.subtract(centre, ring.at))
        found = np.zeros((6, len(built.springs)))
        for i, (of, spring) in enumerate(zip(self._of, built.springs, strict=True)):
            if of == ring.springs:
                found[:, i] = moved @ spring.by[ring.body]
        return found


def _unit_loads(system: System, rotor: float) -> Floats:
    """(n, 7) unit loads on the hub, and gravity on all but the rotor's mass [kg]."""
    hub = [system.load_on("rotor", one) for one in np.eye(6)]
    weight = system.gravity(np.array([0.0, 0.0, -GRAVITY])) + GRAVITY * rotor * hub[2]
    return np.column_stack([*hub, weight])


def _housing_rings(built: Assembly) -> dict[str, _Ring]:
    """Bearings in the housing, by name."""
    speeds = {body.name: body.speed for body in built.bodies}
    return {
        name: _Ring(name, body, np.asarray(at), 0.0, abs(speeds[body]), 0)
        for name, (body, at) in built.seats.items()
    }


def _planet_rings(machine: MachineTable, built: Assembly, angle: float) -> dict[str, _Ring]:
    """Bearings of the first planet of each stage, whose carrier is at an angle [rad], by name."""
    bodies, found = {body.name: body for body in built.bodies}, {}
    for number, stage in enumerate(machine.stages, start=1):
        if not isinstance(stage, PlanetaryData):
            continue
        planets = planetary_set(machine, number, turned=angle)
        label = f"stage {number} pin"
        carrier = f"stage {number} carrier"
        pin = f"{label} body 1"
        speed = abs(bodies[f"stage {number} planet 1"].speed - bodies[carrier].speed)
        for place in planets.bearings:
            at = np.asarray(planets.centre(0)) + along_x(place.offset)
            inner = pin if pin in bodies else carrier
            springs = f"{label} 1 {place.name}".strip()
            found[planet_bearing_name(number, place.name)] = _Ring(
                springs, inner, at, planets.angles[0], speed, stage.planets
            )
    return found


def _same(loads: Floats) -> bool:
    """Whether loads (a, 6, 7) are the same at all azimuths; hub loads of 1 N and 1 N m compare."""
    parts = [loads[:, rows, of] for rows in (_FORCES, _MOMENTS) for of in (_HUB, _WEIGHT)]
    return all(np.abs(one - one[:1]).max() <= SAME * np.abs(one).max() for one in parts)


def _same_bearing(springs: str, ring: _Ring) -> bool:
    """Whether springs are those of a bearing, on any planet."""
    if not ring.planets:
        return springs == ring.springs
    before, _, after = ring.springs.partition(" pin 1")
    return any(springs == f"{before} pin {k}{after}" for k in range(1, ring.planets + 1))


def _turned(angle: float) -> Floats:
    """(6, 6) from the machine's frame into one that is turned about x from y to z."""
    turn = np.array([[1, 0, 0], [0, cos(angle), sin(angle)], [0, -sin(angle), cos(angle)]])
    return np.kron(np.eye(2), turn)
