"""Which level a question needs: each level's answer beside that of the finest, and its cost."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from time import perf_counter

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.gear_pairs import pitch_contacts
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system, steady_load, torsional
from fe_drivetrain.dynamics.bodies.machine import Machine
from fe_drivetrain.dynamics.bodies.modes import SystemModes, distinct, system_modes
from fe_drivetrain.dynamics.bodies.static import Static, load_sharing, static
from fe_drivetrain.dynamics.bodies.system import System
from fe_drivetrain.dynamics.torsion.system import natural_modes


@dataclass(frozen=True)
class Operation:
    """Loads of a drivetrain for which the questions are asked.

    Attributes
    ----------
    torque : float
        Torque on the rotor about x [N m].
    moment : float
        Moment on the rotor about y, tilting it [N m].
    """

    torque: float
    moment: float = 0.0


@dataclass(frozen=True)
class Rung:
    """A level, and what gives beside it.

    Attributes
    ----------
    level : Level
        Level of the model: what may move.
    flexible : Flexible
        Carriers and housing that give.
    name : str
        Name of the rung, in words.
    neglects : tuple[str, ...]
        What the model leaves out.
    assumes : tuple[str, ...]
        Values that no file gives, and why so.
    seconds : float
        Time that it took to condense what gives, beyond the rung before [s].
    rollers : bool
        Whether bearings with a catalogue entry are on their rollers, in statics.
    """

    level: Level
    flexible: Flexible
    name: str
    neglects: tuple[str, ...] = ()
    assumes: tuple[str, ...] = ()
    seconds: float = 0.0
    rollers: bool = False


#: What models without anything condensed leave out.
UNCONDENSED = (
    "housings of main bearings that give",
    "a gearbox housing that moves",
    "carriers that give",
    "what steps, ends and rings of bearings do to the sections of the main shaft",
    "clearance and rollers of bearings",
)
#: What each level leaves out beside it.
_LEVELS = {
    Level.TORSIONAL: ("every motion but turning: loads of bearings, uneven sharing",),
    Level.RIGID: ("shafts that bend between their bearings",),
    Level.FLEXIBLE: (),
}

RUNGS = tuple(
    Rung(level, Flexible(), level.value, (*_LEVELS[level], *UNCONDENSED)) for level in Level
)
"""The levels without flexible carriers or housing, from the simplest."""


@dataclass(frozen=True)
class Asked:
    """A machine at a level and what it carries; what several questions need is solved once.

    Attributes
    ----------
    machine : Machine
        Table of the machine.
    rung : Rung
        Level, and what gives.
    operation : Operation
        Loads.
    held : bool
        Whether the generator is held in modes, too; in statics it is.
    """

    machine: Machine
    rung: Rung
    operation: Operation
    held: bool = False

    @cached_property
    def modes(self) -> SystemModes:
        """Modes of the system at rest."""
        return system_modes(self.system)

    @cached_property
    def system(self) -> System:
        """System of the modes."""
        return machine_system(
            self.machine,
            self.rung.level,
            held_generator=self.held,
            flexible=self.rung.flexible,
        )

    @cached_property
    def loaded(self) -> Static | None:
        """Equilibrium with gravity; none at the torsional level."""
        if self.rung.level is Level.TORSIONAL:
            return None
        system = machine_system(
            self.machine, self.rung.level, held_generator=True, flexible=self.rung.flexible
        )
        hub = np.array([0.0, 0.0, 0.0, 0.0, self.operation.moment, 0.0])
        return static(system, steady_load(self.machine, system, self.operation.torque, hub))

    @cached_property
    def turned(self) -> Static:
        """Equilibrium at any level; at the torsional one of the torque alone."""
        if self.loaded is not None:
            return self.loaded
        system = machine_system(self.machine, self.rung.level, held_generator=True)
        return static(system, steady_load(self.machine, system, self.operation.torque, np.zeros(6)))


Question = Callable[[Asked], float | None]
"""A number of a machine at a level; None where the level has no answer."""


def torsional_frequency(number: int) -> Question:
    """Frequency of a torsional mode, counted above zero, and of the mode most like it [Hz].

    None where no mode has half of it: the mode has become several.
    """

    def asked(of: Asked) -> float | None:
        simple = torsional(of.machine, of.held)
        modes = natural_modes(simple)
        chosen = int(np.flatnonzero(modes.frequencies > 0)[number - 1])
        if of.rung.level is Level.TORSIONAL:
            return float(modes.frequencies[chosen])
        rows = [of.system.place(f"{name} rx") for name in modes.names]
        likeness = (modes.shapes[:, chosen] * simple.J) @ of.modes.shapes[rows]
        best = int(np.abs(likeness).argmax())
        return float(of.modes.frequencies[best]) if likeness[best] ** 2 > 0.5 else None

    return asked


def like_mode(finest: Asked, number: int) -> Question:
    """Frequency of the mode most like one of the finest level's, counted above zero [Hz].

    Modes within a thousandth of a frequency are taken together: their shapes come in any
    combination. None where those have less than half of it.

    Parameters
    ----------
    finest : Asked
        Machine at the finest level; shapes are compared in what moves at both levels. Nodes of
        shafts that one of them has condensed are left out: they are at other places.
    number : int
        Number of its mode, from 1.
    """

    def asked(of: Asked) -> float | None:
        chosen = int(np.flatnonzero(finest.modes.frequencies > 0)[number - 1])
        if of.rung is finest.rung and of.machine is finest.machine:
            return float(finest.modes.frequencies[chosen])
        solid = tuple(
            f"{shaft} node " for one in (of, finest) for shaft in one.rung.flexible.shafts
        )
        there = set(finest.system.names)
        both = [k for k, n in enumerate(of.system.names) if n in there and not n.startswith(solid)]
        rows = [finest.system.place(of.system.names[k]) for k in both]
        shape = finest.modes.shapes[rows, chosen]
        shares = (of.modes.shapes[both].T @ (of.system.mass[np.ix_(both, both)] @ shape)) ** 2
        shares[of.modes.frequencies == 0.0] = 0.0
        best: tuple[float, float | None] = (0.5, None)
        first = 0
        for _, count in distinct(of.modes.frequencies, 1e-3):
            group = shares[first : first + count]
            if group.sum() > best[0]:
                at = first + int(group.argmax())
                best = (float(group.sum()), float(of.modes.frequencies[at]))
            first += count
        return best[1]

    return asked


def planet_bearing_load(of: Asked) -> float | None:
    """Maximum radial load of a bearing of the first stage's planets [kN]."""
    stage = of.machine.stages[0]
    if of.loaded is None or not isinstance(stage, PlanetaryData):
        return None
    return max(pin_loads(of.loaded, stage, 1).values()) / 1e3


def pin_loads(found: Static, stage: PlanetaryData, number: int) -> dict[str, float]:
    """Radial load of each planet's bearings by their names, such as "stage 1 pin 1 upwind" [N]."""
    names = [
        f"stage {number} pin {k + 1} {pin.name}".strip()
        for k in range(stage.planets)
        for pin in stage.pins
    ]
    return {name: found.radial(name) for name in names}


def planet_sharing(of: Asked) -> float | None:
    """Maximum load of a ring's mesh over the mean of the first stage's."""
    stage = of.machine.stages[0]
    if of.loaded is None or not isinstance(stage, PlanetaryData):
        return None
    forces = [of.loaded.force(f"stage 1 ring-planet {k + 1}") for k in range(stage.planets)]
    return load_sharing(np.array(forces))


def face_load(of: Asked) -> float | None:
    """Maximum load of a slice over the mean, of the last parallel stage's mesh."""
    stages = of.machine.stages
    numbers = [k for k, stage in enumerate(stages, 1) if isinstance(stage, ParallelData)]
    if of.loaded is None or not numbers or stages[numbers[-1] - 1].slices == 1:
        return None
    return load_sharing(slices_of(of.loaded, f"stage {numbers[-1]} mesh"))


def contact_stress(of: Asked) -> float:
    """Maximum contact stress of a gear: one pair of teeth at the pitch point [MPa].

    Hertz pressure of the slice and planet with the maximum load. A torsional level has an answer,
    too: planets share equally there, and so does the face width.
    """
    largest = 0.0
    for mesh, contact in pitch_contacts(of.machine).items():
        stage = of.machine.stages[int(mesh.split(" ")[1]) - 1]
        planets = range(1, stage.planets + 1) if isinstance(stage, PlanetaryData) else ()
        for name in [f"{mesh} {k}" for k in planets] or [mesh]:
            forces = slices_of(of.turned, name)
            if not forces.size:
                forces = np.array([of.turned.force(name)])
            pressed = float((forces * np.sign(forces.sum())).max())
            largest = max(largest, contact.under(pressed, 1 / len(forces)).pressure / 1e6)
    return largest


def slices_of(found: Static, mesh: str) -> Floats:
    """Forces of the slices of a mesh along the face [N]."""
    names = found.system.spring_names
    return found.forces[[k for k, n in enumerate(names) if n.startswith(f"{mesh} slice ")]]


QUESTIONS: Mapping[str, Question] = {
    "first torsional frequency [Hz]": torsional_frequency(1),
    "largest load of a planet's bearing [kN]": planet_bearing_load,
    "load sharing of the planets": planet_sharing,
    "face load of the last gear pair": face_load,
    "largest contact stress of a gear [MPa]": contact_stress,
}
"""Questions that are asked most often, by name and unit."""


@dataclass(frozen=True)
class Answer:
    """One level's answers.

    Attributes
    ----------
    name : str
        Name of the level.
    degrees : int
        Number of degrees of freedom.
    seconds : float
        Time taken for all questions, and to condense what gives [s].
    values : Mapping[str, float or None]
        Answers by question; None where the level has no answer.
    """

    name: str
    degrees: int
    seconds: float
    values: Mapping[str, float | None]


def ladder(
    machine: Machine,
    operation: Operation,
    rungs: Sequence[Rung] = RUNGS,
    questions: Mapping[str, Question] = QUESTIONS,
    held: bool = False,
) -> list[Answer]:
    """The answers of all levels, from the simplest.

    Parameters
    ----------
    machine : Machine
        Machine with a rotor that has a mass.
    operation : Operation
        Torque and moment of the statics.
    rungs : sequence of Rung
        Rungs, from the simplest level to the finest.
    questions : mapping
        Questions by name.
    held : bool
        Whether the generator is held in modes, too.
    """
    found, condensed = [], 0.0
    for rung in rungs:
        start, condensed = perf_counter(), condensed + rung.seconds
        asked = Asked(machine, rung, operation, held)
        values = {name: ask(asked) for name, ask in questions.items()}
        size = len(asked.system.names)
        found.append(Answer(rung.name, size, perf_counter() - start + condensed, values))
    return found


def needed_level(answers: Sequence[Answer], question: str, tolerance: float) -> str:
    """Name of the simplest level whose answer is within a tolerance of the finest one's.

    Parameters
    ----------
    answers : sequence of Answer
        Answers from `ladder`, from the simplest level to the finest.
    question : str
        Question, one of those that were asked.
    tolerance : float
        Relative difference, such as 0.05.

    Raises
    ------
    InputError
        The question was not asked, or the finest level has no answer.
    """
    if question not in answers[-1].values:
        known = ", ".join(answers[-1].values)
        raise InputError(f"no question {question!r} was asked: use one of {known}")
    finest = answers[-1].values[question]
    if finest is None:
        raise InputError(f"no level answers {question!r}: its stages are not of that kind")
    chosen = answers[-1].name
    for answer in reversed(answers):
        value = answer.values[question]
        if value is None or abs(value - finest) > tolerance * abs(finest):
            break
        chosen = answer.name
    return chosen
