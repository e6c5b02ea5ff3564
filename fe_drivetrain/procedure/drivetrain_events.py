"""Events that a drivetrain goes through, as phases in time: stop, loss of the grid, dip, run-up.

Each begins from steady turning under rated torque, wound up, so that nothing rings before anything
happens. Values of an event are numbers with a stated default: what is not known of a turbine's
controls is an assumption of the result.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING, dataclass, fields, replace
from typing import ClassVar

import numpy as np

from fe_drivetrain.common.arguments import argument
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError, require_known
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics.bodies.equations import varying
from fe_drivetrain.dynamics.bodies.levels import Level, assembly
from fe_drivetrain.dynamics.time.base_motion import read_base_motion
from fe_drivetrain.dynamics.time.brakes import Brake
from fe_drivetrain.dynamics.time.integration import Phase
from fe_drivetrain.dynamics.time.motion import State
from fe_drivetrain.dynamics.time.running import Running
from fe_drivetrain.dynamics.time.steady_turning import with_laws
from fe_drivetrain.dynamics.time.stopping import StopSequence, stop_phases
from fe_drivetrain.procedure.coupling_offset import CouplingOffset
from fe_drivetrain.procedure.gearbox_offset import GearboxOffset
from fe_drivetrain.procedure.steady_running import steady_rotor, steady_run, wound_up
from fe_drivetrain.procedure.voltage_dips import Dip
from fe_drivetrain.turbine_loads.hub_loads.base_history import BaseReading

SIX_MOTIONS = (Level.RIGID, Level.FLEXIBLE)
"""Levels whose bodies have all motions."""

SLIP = 0.01
"""Slip of a generator at rated torque, where nothing else is known."""


@dataclass(frozen=True)
class Planned:
    """An event of a machine, ready for integration.

    Attributes
    ----------
    phases : tuple of Phase
        Phases of the event.
    start : State
        State wound up at the beginning.
    marks : Mapping[str, float]
        What happens when [s].
    reference : Floats or None
        Velocities (n,) of the steady turning that phases and state are beside; None where they
        have it in them.
    """

    __repr__ = short_repr

    phases: tuple[Phase, ...]
    start: State
    marks: Mapping[str, float]
    reference: Floats | None = None


@dataclass(frozen=True)
class Event:
    """An event: its values are the fields of a dataclass, all numbers or words.

    Most are of any level, with teeth of mean stiffness, a known duration, and short steps. Those
    that keep the speed, or nearly so, can have planets that travel.
    """

    levels: ClassVar[tuple[Level, ...]] = tuple(Level)
    keeps_speed: ClassVar[bool] = False
    teeth: ClassVar[bool] = False
    seconds: ClassVar[float]

    @property
    def happens_at(self) -> tuple[Level, ...]:
        """Levels at which it happens with its values."""
        return self.levels

    def plan(self, of: Running, duration: float, slip: float) -> Planned:
        """Phases of the event."""
        raise NotImplementedError

    def step(self, of: Running) -> float:
        """Half a millisecond: what comes at once excites modes of some hundred hertz."""
        return 5e-4

    def lasts(self, of: Running) -> float:
        """Duration that shows the event where none is asked for [s]."""
        return self.seconds


@dataclass(frozen=True)
class EmergencyStop(Event):
    """The generator is off, blades pitch, a disc brake stops the drivetrain.

    Attributes
    ----------
    off : float
        The generator's torque goes to zero, and blades begin to pitch [s].
    pitched : float
        The rotor's torque has fallen, evenly, to `left` [s].
    left : float
        Torque of the rotor that is left, over rated torque.
    braked, rise : float
        The brake is applied, and the time that it takes to grow to full size [s].
    brake : float
        Torque of the brake over the generator's rated torque; 0 for none.
    brake_torque : float
        Torque of the brake on its disc, in place of `brake` [N m]; 0 where not known.
    shaft : str
        Shaft at whose beginning the disc is, or body.
    """

    seconds: ClassVar[float] = 20.0

    off: float = 1.0
    pitched: float = 3.0
    left: float = 0.0
    braked: float = 3.0
    rise: float = 0.2
    brake: float = 1.0
    brake_torque: float = 0.0
    shaft: str = "generator"

    def __post_init__(self) -> None:
        _in_range(self, off=(0.0, 1e4), left=(-1.0, 1.5), rise=(0.0, 60.0), brake=(0.0, 50.0))
        _in_range(self, brake_torque=(0.0, 1e9), braked=(0.0, 1e4))
        _in_order(self, "off", "pitched")

    def lasts(self, of: Running) -> float:
        """Until the disc stands, and some seconds more, if the brake is stronger than the wind."""
        row = of.disc(self.shaft)
        speed = abs(float(row @ of.turning.velocity))
        rotor = float(of.turning.to_rotor @ of.turning.velocity)
        braking = (self.brake_torque or self._torque_on(of, row)) * speed / rotor
        net = braking - self.left * of.turning.torque
        if net <= 0.0:
            return self.seconds
        still = max(self.pitched, self.braked + self.rise) + of.inertia * rotor / net
        return float(min(max(self.seconds, still + 5.0), 10.0 * self.seconds))

    def plan(self, of: Running, duration: float, slip: float) -> Planned:
        """Phases of the stop; marks are the generator's end, blades and brake."""
        _require_within(self, duration, "off", "pitched", "braked")
        when = StopSequence(self.off, self.pitched, self.left, self.braked, duration, self.rise)
        row, discs = of.disc(self.shaft), []
        torque = self.brake_torque or self._torque_on(of, row)
        marks = {"generator off": self.off, "blades pitched": self.pitched}
        if torque:
            discs = [Brake(row, torque, self.braked, self.rise)]
            marks["brake on"] = self.braked
        phases, start = stop_phases(of.equations, of.turning, when, discs, slip)
        return Planned(tuple(phases), start, marks)

    def _torque_on(self, of: Running, row: Floats) -> float:
        """Torque on the disc, of a share of the generator's rated torque at its own speed."""
        speed = float(row @ of.turning.velocity)
        rated = of.turning.generator_torque * of.turning.generator_speed / speed
        return self.brake * abs(rated)


@dataclass(frozen=True)
class GridLoss(Event):
    """The generator's torque is lost at once; blades begin to pitch some time later.

    Attributes
    ----------
    off : float
        The grid is lost [s].
    delay : float
        Time from then until blades begin to pitch, the rotor's torque being held [s].
    pitch : float
        Time in which the rotor's torque falls, evenly, to `left` [s].
    left : float
        Torque of the rotor that is left, over rated torque.
    """

    seconds: ClassVar[float] = 10.0

    off: float = 1.0
    delay: float = 0.2
    pitch: float = 3.0
    left: float = 0.0

    def __post_init__(self) -> None:
        _in_range(self, off=(0.0, 1e4), delay=(0.0, 60.0), pitch=(1e-3, 60.0), left=(-1.0, 1.5))

    def plan(self, of: Running, duration: float, slip: float) -> Planned:
        """Phases of the loss; marks are the loss itself, and the blades."""
        begins, ends = self.off + self.delay, self.off + self.delay + self.pitch
        _require_within(self, duration, "off")
        when = StopSequence(self.off, ends, self.left, ends, duration)
        phases, start = stop_phases(of.equations, of.turning, when, [], slip)
        torque = of.turning.torque
        wind = varying(of.turning.to_rotor, [begins, ends], [torque, self.left * torque])
        last = replace(phases[-1], acting=[wind, *of.turning.loads()])
        marks = {"grid lost": self.off, "blades begin to pitch": begins, "blades pitched": ends}
        return Planned((*phases[:-1], last), start, marks)


@dataclass(frozen=True)
class VoltageDip(GearboxOffset, Event):
    """The generator's torque falls and comes back, as a table has it, whatever its speed.

    The housing of the gearbox may stand beside the main shaft meanwhile, as in `Offset`.

    Attributes
    ----------
    start : float
        When the dip begins [s].
    depth : float
        Share of the torque that is lost; above 1 it is reversed.
    length : float
        Time from its begin to that of the recovery [s].
    fall, recovery : float
        Time to the bottom, and from it back to the full torque [s].
    """

    keeps_speed: ClassVar[bool] = True
    seconds: ClassVar[float] = 6.0

    start: float = 1.0
    depth: float = 0.8
    length: float = 0.15
    fall: float = 0.005
    recovery: float = 0.1

    def __post_init__(self) -> None:
        _in_range(self, start=(0.0, 1e4), depth=(0.0, 3.0), fall=(1e-4, 60.0), length=(0.0, 60.0))
        _in_range(self, recovery=(1e-4, 600.0))
        self.check_gearbox()
        self.dip()

    @property
    def happens_at(self) -> tuple[Level, ...]:
        """All levels, but with a gearbox beside the main shaft those that have its motions."""
        return SIX_MOTIONS if self.gearbox.any() else self.levels

    def dip(self) -> Dip:
        """The dip as a table."""
        return Dip(self.start, self.depth, self.length, self.fall, self.recovery)

    def plan(self, of: Running, duration: float, slip: float) -> Planned:
        """One phase; marks are the begin of the dip, of the recovery, and its end."""
        table, turning = self.dip().table, of.turning
        _require_within(self, duration, "start")
        times, at = np.unique(table.times, return_index=True)
        shares = np.array(table.values)[at]
        pull = varying(-turning.generator_torque * turning.to_generator, times, shares)
        acting = [steady_rotor(of), pull, *turning.loads()]
        made = self.moved(of, of.equations)
        start = wound_up(made, acting, turning.velocity)
        back = self.start + self.length
        marks = {
            "voltage dips": self.start,
            "it begins to recover": back,
            "recovered": back + self.recovery,
        }
        return Planned((Phase(duration, made, acting),), start, marks)

    def step(self, of: Running) -> float:
        """Half a millisecond, or a fifth of the fall."""
        return min(5e-4, self.fall / 5.0)


@dataclass(frozen=True)
class RunUp(Event):
    """Speed rises evenly, so that teeth pass all resonances on the way.

    Attributes
    ----------
    begin, end : float
        Speed at the beginning and at the end, over rated speed.
    share : float
        Torque that the generator holds on the way, over rated torque.
    """

    teeth: ClassVar[bool] = True
    seconds: ClassVar[float] = 5.0

    begin: float = 0.3
    end: float = 1.1
    share: float = 1.0

    def __post_init__(self) -> None:
        _in_range(self, begin=(0.0, 3.0), end=(1e-3, 3.0), share=(0.0, 2.0))
        _in_order(self, "begin", "end")

    def plan(self, of: Running, duration: float, slip: float) -> Planned:
        """One phase; its mark is where the speed is the rated one."""
        turning = of.turning
        speed = float(turning.to_rotor @ turning.velocity)
        rate = (self.end - self.begin) * speed / duration
        torque = self.share * turning.torque
        driving = varying(turning.to_rotor, [0.0], [torque + of.inertia * rate])
        pull = varying(-turning.to_generator, [0.0], [torque / turning.ratio])
        acting = [driving, pull, *turning.loads()]
        start = wound_up(of.equations, acting, self.begin * turning.velocity)
        reached = duration * (1.0 - self.begin) / (self.end - self.begin)
        marks = {"rated speed": reached} if 0.0 < reached < duration else {}
        return Planned((Phase(duration, of.equations, acting),), start, marks)

    def step(self, of: Running) -> float:
        """A twentieth of the shortest period of a mesh, a millisecond at most."""
        s = of.equations.springs
        periods = np.abs(s.turns @ of.turning.velocity).max(initial=0.0)
        return float(min(1e-3, 0.05 / max(self.end * periods, 1e-9)))


@dataclass(frozen=True)
class Offset(GearboxOffset, CouplingOffset, Event):
    """Generator or gearbox stand beside the axis of what they are joined to, and turn steadily."""

    levels: ClassVar[tuple[Level, ...]] = SIX_MOTIONS
    keeps_speed: ClassVar[bool] = True
    seconds: ClassVar[float] = 2.0

    def __post_init__(self) -> None:
        self.check_gearbox()
        if not self.gearbox.any():
            super().__post_init__()
        elif self.coupling:
            self.check_coupling()

    def plan(self, of: Running, duration: float, slip: float) -> Planned:
        """One phase with the coupling's springs; nothing is marked."""
        machine, pull = of.turning.line(slip)
        laws = [self.springs(of, *self.of_generator(of))] if self.coupling else []
        made = with_laws(self.moved(of, of.equations), machine, *laws)
        acting = [steady_rotor(of), pull, *of.turning.loads()]
        start = wound_up(made, acting, of.turning.velocity)
        return Planned((Phase(duration, made, acting),), start, {})

    def step(self, of: Running) -> float:
        """A fiftieth of a turn of the generator, a millisecond at most."""
        return float(min(1e-3, 2.0 * np.pi / abs(of.turning.generator_speed) / 50.0))


@dataclass(frozen=True)
class BaseMoves(Event):
    """The base of the drivetrain moves, as a file says; the drivetrain turns steadily.

    Attributes
    ----------
    file : str
        CSV file of columns "time [s],ux [m],...,rz [rad]", about the rotor's centre, which is run
        as a whole; empty where histories say how the base moves.
    x, y, z : float
        Place of the sensor of histories from the rotor's centre [m].
    mean : str
        Whether the mean of each acceleration of histories is "removed" or "kept".
    """

    levels: ClassVar[tuple[Level, ...]] = SIX_MOTIONS
    keeps_speed: ClassVar[bool] = True
    seconds: ClassVar[float] = 0.0

    file: str = ""
    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    mean: str = "removed"

    def __post_init__(self) -> None:
        _in_range(self, x=(-50.0, 50.0), y=(-50.0, 50.0), z=(-50.0, 50.0))
        require_known("mean of the event", self.mean, ("removed", "kept"))
        if self.file and (self.x or self.y or self.z or self.mean != "removed"):
            raise InputError(
                "x, y, z and mean of a base are of histories, but file is given: leave them out, "
                f"or give {argument('loads')} in place of file"
            )

    def reading(self) -> BaseReading:
        """How histories of the base are read."""
        return BaseReading((self.x, self.y, self.z), self.mean == "kept")

    def require_file(self) -> None:
        """Refuse a base of which nothing says how it moves.

        Raises
        ------
        InputError
            There is no file.
        """
        if not self.file:
            raise InputError(
                f"the motion of a base needs histories: give {argument('loads')}, as in "
                "outputs/*.outb; or a file, as in file=base.csv, with columns 'time [s]' and some "
                "of ux [m] to rz [rad]"
            )

    def plan(self, of: Running, duration: float, slip: float) -> Planned:
        """One phase; nothing is marked."""
        self.require_file()
        bodies = assembly(of.machine, of.level, flexible=of.flexible).bodies
        base = read_base_motion(self.file, of.system, bodies)
        made, acting = steady_run(of, slip)
        start = wound_up(made, acting, of.turning.velocity)
        start = replace(start, time=float(base.times[0]))
        last = float(base.times[-1])
        until = min(start.time + duration, last) if duration else last
        return Planned((Phase(until, made, [*acting, base]),), start, {})

    def step(self, of: Running) -> float:
        """A millisecond."""
        return 1e-3


EVENTS: Mapping[str, type[Event]] = {
    "stop": EmergencyStop,
    "grid_loss": GridLoss,
    "dip": VoltageDip,
    "run_up": RunUp,
    "offset": Offset,
    "base": BaseMoves,
}
"""Events by name, beside "operation", which is of histories."""


def event_of(name: str, values: Mapping[str, float | str]) -> Event:
    """An event from its name and values.

    Parameters
    ----------
    name : str
        One of `EVENTS`.
    values : Mapping[str, float or str]
        Values other than the defaults, by name.

    Raises
    ------
    InputError
        There is no such event or value, or a value is out of its range.
    """
    if name not in EVENTS:
        raise InputError(f"no event {name!r}: use one of operation, {', '.join(EVENTS)}")
    kind = EVENTS[name]
    known = {one.name: one for one in fields(kind)}  # type: ignore[arg-type]
    for key, value in values.items():
        if key not in known:
            raise InputError(f"event {name} has no value {key!r}: use one of {', '.join(known)}")
        words = known[key].default is not MISSING and isinstance(known[key].default, str)
        if words != isinstance(value, str) or isinstance(value, bool):
            what = "a word" if words else "a number"
            raise InputError(f"{key} of event {name} is {value!r} but must be {what}: change it")
    return kind(**values)


def _in_range(event: object, **ranges: tuple[float, float]) -> None:
    """Refuse a value that is out of its range."""
    for key, (low, high) in ranges.items():
        value = getattr(event, key)
        if not low <= value <= high:
            raise InputError(
                f"{key} of the event is {value:g} but must be from {low:g} to {high:g}: change it"
            )


def _in_order(event: object, first: str, later: str) -> None:
    a, b = getattr(event, first), getattr(event, later)
    if not b > a:
        raise InputError(f"{later} of the event is {b:g} but must be above {first}, {a:g}")


def _require_within(event: object, duration: float, *names: str) -> None:
    """Refuse what happens when the run is over."""
    for name in names:
        at = getattr(event, name)
        if not at < duration:
            raise InputError(
                f"{name} of the event is at {at:g} s but the run ends at {duration:g} s: let it "
                "last longer"
            )
