"""The first stage with all that is guessed about it: loads of the planets' bearings."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import cos, pi, radians, sin
from types import MappingProxyType

import numpy as np

from fe_drivetrain.bearing import Bearing, equilibrium, forces
from fe_drivetrain.cases.dynamics.gear_twist import FaceTwist, with_twist
from fe_drivetrain.cases.dynamics.upwind_guess import RIM_WALL, Guess, Turned
from fe_drivetrain.common import Floats
from fe_drivetrain.common.components import GRAVITY
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.drivetrain_file.couplings import SplineData
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.turning_parts import SixOrMatrix
from fe_drivetrain.dynamics import (
    Flexible,
    Level,
    Machine,
    OnRollers,
    Rim,
    Static,
    System,
    assemble,
    assembly,
    machine_seat,
    planet_seats,
    planetary_set,
    static,
    static_on_rollers,
)
from fe_drivetrain.dynamics.bodies.flexible import Housing
from fe_drivetrain.elasticity.solve.condensation import Condensed

STEEL = Material(youngs_modulus=206e9, poisson_ratio=0.3, density=7850.0)
ELEMENTS = 2
"""Number of elements of each shaft, beside its bearings and steps."""
RIM_HARMONICS = tuple(range(2, 8))
RIGID_SEAT = 1e-13
"""Compliance of a pin's seat where it is rigid [m/N, rad/(N m)]."""
TOOTH = 5e-3
"""Width of a tooth of the spline and its gap, over pi [m]."""


@dataclass(frozen=True)
class FirstStage:
    """The first stage of a machine under the torque of its rotor.

    Attributes
    ----------
    machine : MachineTable
        A machine's rows, with planets on linear bearings.
    torque : float
        On the rotor [N m].
    body : Condensed
        Carrier, free, at hub and pins.
    mount : Flexible
        The housing on its mount; empty where the file gives none.
    rollers : Bearing or None
        Rollers of a planet's bearing.
    cheek : float
        x of the upwind cheek's middle from that of the pins [m].
    slices : int
        Number of slices of the meshes of the first stage.
    steps : int
        Azimuths of the carrier between two planets that means are taken over.
    """

    machine: MachineTable
    torque: float
    body: Condensed
    mount: Flexible
    rollers: Bearing | None
    cheek: float
    slices: int = 7
    steps: int = 1
    _kept: dict[tuple[Guess, float], tuple[System, Floats]] = field(
        default_factory=dict, init=False, compare=False, repr=False
    )

    @property
    def stage(self) -> PlanetaryData:
        """Its data."""
        found = self.machine.stages[0]
        assert isinstance(found, PlanetaryData)
        return found

    @cached_property
    def pins(self) -> tuple[str, str]:
        """Names of the upwind and the downwind bearing of each pin."""
        by_place = sorted(self.stage.pins, key=lambda pin: pin.offset)
        return by_place[0].name, by_place[-1].name

    @property
    def spacing(self) -> float:
        """Distance of a pin's outer bearings [m]."""
        offsets = [pin.offset for pin in self.stage.pins]
        return max(offsets) - min(offsets)

    def few(self) -> Floats:
        """(steps,) azimuths at which planets stand at equal steps of a turn [rad]."""
        return np.arange(self.steps) * 2 * pi / (self.steps * self.stage.planets)

    def turned(self, guess: Guess, azimuths: Floats | None = None) -> Turned:
        """Equilibria at azimuths of the carrier, on linear bearings."""
        at = self.few() if azimuths is None else azimuths
        found = [self._solved(guess, float(azimuth)) for azimuth in at]
        return self.collected(at, found)

    def ratio(self, guess: Guess) -> float:
        """Upwind over downwind, of means over a turn."""
        return self.turned(guess).ratio

    def tangential(self, guess: Guess) -> Floats:
        """(steps, planets, 2) forces of the planets' bearings along their circle, backwards [N]."""
        found = [self._solved(guess, float(azimuth)) for azimuth in self.few()]
        planets = range(1, self.stage.planets + 1)
        names = [[f"stage 1 pin {k} {pin} uz" for pin in self.pins] for k in planets]
        return -np.array([[[one.force(name) for name in row] for row in names] for one in found])

    def on_rollers(
        self,
        guess: Guess,
        azimuths: Floats | None = None,
        carrier: Mapping[str, Bearing] = MappingProxyType({}),
    ) -> Turned:
        """Equilibria with the planets' bearings on rollers with clearance.

        Parameters
        ----------
        guess : Guess
            Its clearances count.
        azimuths : ndarray, (a,), optional
            Azimuths of the carrier [rad].
        carrier : mapping of str to Bearing
            Rollers of the carrier's bearings by name, with their clearance.
        """
        assert self.rollers is not None
        at = self.few() if azimuths is None else azimuths
        tight = replace(guess, clearance=0.0, clearance_difference=0.0)
        found: list[Static | OnRollers] = []
        for azimuth in (float(a) for a in at):
            machine, gives = self._changed(tight), self._flexible(tight)
            system, load = self._system(tight, azimuth)
            parts = assembly(machine, Level.FLEXIBLE, azimuth, ELEMENTS, True, flexible=gives)
            seats = [machine_seat(parts, name, one) for name, one in carrier.items()]
            for pin, side in zip(self.pins, (-0.5, 0.5), strict=True):
                play = guess.clearance + side * guess.clearance_difference
                bearing = self.rollers.with_rows(clearance=play / 2)
                own = planet_seats(machine, 1, bearing, azimuth, gives)
                seats += [one for one in own if one.name.endswith(f" {pin}")]
            found.append(static_on_rollers(system, load, seats, self._gaps(tight)))
        return self.collected(at, found)

    def collected(self, azimuths: Floats, found: Sequence[Static | OnRollers]) -> Turned:
        """Loads of bearings, tilts and slices of equilibria."""
        planets = range(1, self.stage.planets + 1)
        loads, tilts, ring = [], [], []
        for azimuth, one in zip(azimuths, found, strict=True):
            state = one.static if isinstance(one, OnRollers) else one
            loads.append([[one.radial(f"stage 1 pin {k} {p}") for p in self.pins] for k in planets])
            angles = planetary_set(self.machine, 1, turned=float(azimuth)).angles
            of = state.system.motion_of
            own = of("stage 1 carrier", state.q)
            moved = [of(f"stage 1 planet {k}", state.q) - own for k in planets]
            tilts.append(
                [m[4] * cos(a) + m[5] * sin(a) for m, a in zip(moved, angles, strict=True)]
            )
            slices = range(1, self.slices + 1)
            ring.append(
                [
                    [state.force(f"stage 1 ring-planet {k} slice {i}") for i in slices]
                    for k in planets
                ]
            )
        converged = all(one.converged for one in found if isinstance(one, OnRollers))
        return Turned(azimuths, np.array(loads), np.array(tilts), np.array(ring), converged)

    def responses(self, guess: Guess, azimuth: float) -> Floats:
        """(planets, 2, 2, 4) radial and tangential force to gravity, torque, pitch and yaw.

        Parameters
        ----------
        guess : Guess
            Its moments do not count.
        azimuth : float
            Azimuth of the carrier [rad].
        """
        system, _ = self._system(guess, azimuth)
        loads = [self._weight(guess, system)]
        loads += [system.load_on("rotor", np.eye(6)[k]) for k in (3, 4, 5)]
        out = np.zeros((self.stage.planets, 2, 2, len(loads)))
        for j, load in enumerate(loads):
            found = static(system, load)
            for k in range(self.stage.planets):
                for i, pin in enumerate(self.pins):
                    name = f"stage 1 pin {k + 1} {pin}"
                    out[k, i, :, j] = [found.force(f"{name} {u}") for u in ("uy", "uz")]
        return out

    def run_out(self, guess: Guess, eccentricity: float) -> float:
        """Amplitude of the first upwind bearing's load by a sun that is out of round [N].

        Parameters
        ----------
        guess : Guess
            Its linear part.
        eccentricity : float
            Eccentricity of the sun's teeth against its axis [m].
        """
        system, load = self._system(guess, 0.0)
        at = [k for k, name in enumerate(system.spring_names) if name.startswith("stage 1 sun-p")]
        name = f"stage 1 pin 1 {self.pins[0]}"
        still = static(system, load).wrench(name)[1:3]
        along = still / np.hypot(*still)
        moved = []
        for axis in (1, 2):
            gaps = {system.spring_names[k]: eccentricity * system.directions[k, axis] for k in at}
            moved.append(along @ static(system, 0.0 * load, gaps).wrench(name)[1:3])
        return float(np.hypot(*moved))

    def _solved(self, guess: Guess, azimuth: float) -> Static:
        system, load = self._system(guess, azimuth)
        return static(system, load, self._gaps(guess))

    def _system(self, guess: Guess, azimuth: float) -> tuple[System, Floats]:
        """The system and its load; of guesses that differ by gaps alone, the same one."""
        shape = guess.shape
        key = (shape, azimuth)
        if key not in self._kept:
            if len(self._kept) > 40:
                self._kept.clear()
            self._kept[key] = self._built(shape, azimuth)
        return self._kept[key]

    def _built(self, guess: Guess, azimuth: float) -> tuple[System, Floats]:
        machine = self._changed(guess)
        gives = self._flexible(guess)
        parts = assembly(machine, Level.FLEXIBLE, azimuth, ELEMENTS, True, flexible=gives)
        bodies, springs = parts.bodies, parts.springs
        for twist in self._twists(guess):
            more, springs = with_twist(springs, twist)
            bodies = [*bodies, *more]
        system = assemble(bodies, springs, parts.superelements)
        hub = np.array([0.0, 0.0, 0.0, self.torque, guess.pitch, guess.yaw])
        return system, system.load_on("rotor", hub) + self._weight(guess, system)

    def _weight(self, guess: Guess, system: System) -> Floats:
        down = np.array([sin(guess.slope), 0.0, -cos(guess.slope)])
        return system.gravity(GRAVITY * down)

    def _changed(self, guess: Guess) -> MachineTable:
        """The machine with the places and stiffnesses of a guess."""
        pins = tuple(
            pin.model_copy(
                update={
                    "offset": guess.spacing * pin.offset + guess.shift,
                    "stiffness": tuple(guess.bearings * np.asarray(pin.stiffness)),
                }
            )
            for pin in self.stage.pins
        )
        changes: dict[str, object] = {
            "pins": pins,
            "slices": self.slices,
            "sun_planet": guess.meshes * self.stage.sun_planet,
            "ring_planet": guess.meshes * self.stage.ring_planet,
        }
        if guess.bushing or guess.overhung:
            changes["bushing"] = seat_of(guess.bushing, guess.overhung, self.cheek)
        stages = (self.stage.model_copy(update=changes), *self.machine.stages[1:])
        shafts = list(self.machine.shafts)
        if guess.spline:
            shafts[1] = shafts[1].model_copy(update={"spline": self.spline(guess.spline)})
        return self.machine.model_copy(update={"stages": stages, "shafts": tuple(shafts)})

    def spline(self, width: float) -> SplineData:
        """A spline as large as the sun, its teeth as wide as a share of its diameter."""
        diameter = 2 * self.stage.sun_radius
        at = min(self.stage.face_width, 0.5 * self.machine.shafts[1].length)
        teeth = max(6, round(diameter / TOOTH))
        return SplineData(teeth=teeth, diameter=diameter, length=width * diameter, at=at)

    def _flexible(self, guess: Guess) -> Flexible:
        gives = Flexible()
        if guess.mount and isinstance(self.mount.housing, Housing):
            housing = self.mount.housing
            stands = replace(housing, stiffness=housing.stiffness / guess.mount)
            gives = replace(self.mount, housing=stands)
        if guess.carrier:
            soft = replace(self.body, stiffness=self.body.stiffness / guess.carrier)
            gives = replace(gives, carriers={1: soft})
        if guess.rim:
            radius = self.ring_radius
            wall = RIM_WALL * 2 * radius * guess.rim ** (-1 / 3)
            rim = Rim(radius + wall / 2, wall, self.stage.face_width, STEEL)
            gives = replace(gives, rims={1: (rim, RIM_HARMONICS)})
        return gives

    def _twists(self, guess: Guess) -> list[FaceTwist]:
        width, found = self.stage.face_width, []
        if guess.sun_twist:
            rigidity = STEEL.shear_modulus * pi / 32 * self.sun_root**4 / guess.sun_twist
            found.append(FaceTwist("stage 1 sun", rigidity, width, 1))
        if guess.ring_twist:
            inner = 2 * self.ring_radius
            outer = inner * (1 + 2 * RIM_WALL)
            rigidity = STEEL.shear_modulus * pi / 32 * (outer**4 - inner**4) / guess.ring_twist
            found.append(FaceTwist("stage 1 ring", rigidity, width, -1))
        return found

    @property
    def holds_tilt(self) -> bool:
        """Whether the planets' bearings resist tilt about the radius."""
        return all(np.ravel(pin.stiffness)[4] > 0 for pin in self.stage.pins)

    @property
    def has_spline(self) -> bool:
        """Whether the sun's shaft can have a spline."""
        shaft = self.machine.shafts[1]
        return shaft.kind == "shaft" and shaft.spline is None

    @property
    def sun_root(self) -> float:
        """Diameter of the sun's root circle, as if of 2.5 modules of teeth without a shift [m]."""
        stage = self.stage
        teeth = stage.teeth[-1] if stage.teeth else 21
        return 2 * stage.sun_radius * (1 - 2.5 / teeth)

    @property
    def ring_radius(self) -> float:
        """Working pitch radius of the ring [m]."""
        return self.stage.centre_distance + (self.stage.centre_distance - self.stage.sun_radius)

    def _gaps(self, guess: Guess) -> dict[str, float]:
        """Gaps of bearings and slices; the load presses a pin's bearings backwards."""
        gaps: dict[str, float] = {}
        ahead = guess.pin_tilt * guess.spacing * self.spacing / 2 + guess.clearance_difference / 4
        up, down = self.pins
        for k in range(1, self.stage.planets + 1):
            place = guess.pin_place if k == 1 else 0.0
            for pin, across in ((up, place + ahead), (down, place - ahead)):
                gaps[f"stage 1 pin {k} {pin} uz"] = across
                if self.holds_tilt:
                    gaps[f"stage 1 pin {k} {pin} ry"] = guess.pin_tilt
            for mesh, lead in (("sun", guess.sun_lead), ("ring", guess.ring_lead)):
                for i in range(self.slices):
                    at = (i + 0.5) / self.slices - 0.5
                    gaps[f"stage 1 {mesh}-planet {k} slice {i + 1}"] = at * lead
        return {name: gap for name, gap in gaps.items() if gap}


def seat_of(pin: float, cheek: float, at: float) -> Floats:
    """(6, 6) stiffness at a pin's middle of a bushing there and one at a cheek [N/m, N, N m/rad].

    Parameters
    ----------
    pin, cheek : float
        Compliances in tilt of the bushings at the middle and at the cheek [rad/(N m)].
    at : float
        x of the cheek from the middle [m].
    """
    give = RIGID_SEAT * np.eye(6)
    # a force across at the middle has the arm of the place that tilts
    for compliance, x in ((pin, 0.0), (cheek, at)):
        for move, tilt, sign in ((1, 5, 1.0), (2, 4, -1.0)):
            arm = np.zeros(6)
            arm[[move, tilt]] = -sign * x, 1.0
            give += compliance * np.outer(arm, arm)
    stiffness = np.linalg.inv(give)
    return np.asarray((stiffness + stiffness.T) / 2)


def linearised(machine: Machine, rollers: Bearing, torque: float) -> MachineTable:
    """A machine's rows, planets' bearings as stiff as tight rollers at the mean load.

    Parameters
    ----------
    machine, rollers, torque : Machine, Bearing, float
        See `tight_pins`.
    """
    across = tight_pins(machine, rollers, torque)
    return with_pins(machine, lambda old: (np.ravel(old)[0], *across))


def tight_pins(machine: Machine, rollers: Bearing, torque: float) -> tuple[float, ...]:
    """Stiffness of a planet's bearing without clearance at the mean load, but along its axis.

    Parameters
    ----------
    machine : Machine
        With a planetary first stage.
    rollers : Bearing
        Rollers of each bearing.
    torque : float
        On the rotor [N m].

    Returns
    -------
    tuple of float
        Along y and z [N/m], then about x, y and z [N m/rad].
    """
    stage = machine.stages[0]
    assert isinstance(stage, PlanetaryData)
    a, count = stage.centre_distance, len(stage.pins)
    tangential = torque / a / stage.planets / count
    offsets = [pin.offset for pin in stage.pins]
    helix = abs(np.tan(radians(stage.helix)))
    couple = 2 * torque / a / stage.planets / 2 * helix * (a - stage.sun_radius)
    load = float(np.hypot(tangential, couple / (max(offsets) - min(offsets))))
    tight = rollers.with_rows(clearance=0.0)
    K = forces(tight, equilibrium(tight, [0, 0, load, 0, 0]).displacements)[1][0]
    return float(K[2, 2]), float(K[2, 2]), 0.0, float(K[3, 3]), float(K[3, 3])


def with_pins(
    machine: Machine, stiffness: Callable[[SixOrMatrix], Sequence[float]]
) -> MachineTable:
    """A machine's rows, with other bearings of the planets of its first stage.

    Parameters
    ----------
    machine : Machine
        With a planetary first stage.
    stiffness : callable
        Six stiffnesses by those that a bearing has [N/m, N m/rad].
    """
    stage = machine.stages[0]
    assert isinstance(stage, PlanetaryData)
    pins = tuple(
        pin.model_copy(update={"stiffness": tuple(stiffness(pin.stiffness))}) for pin in stage.pins
    )
    first = stage.model_copy(update={"pins": pins})
    rows = MachineTable.model_validate(dict(machine))
    return rows.model_copy(update={"stages": (first, *machine.stages[1:])})
