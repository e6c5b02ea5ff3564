"""Which level a question needs: each level's answer beside that of the finest, and its cost."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.levels import Level, machine_system, steady_load, torsional
from fe_drivetrain.dynamics.modes import system_modes
from fe_drivetrain.dynamics.static import Static, load_sharing, static
from fe_drivetrain.dynamics.system import System
from fe_drivetrain.dynamics.tables import Machine, ParallelData, PlanetaryData
from fe_drivetrain.torsion.system import natural_modes


@dataclass(frozen=True)
class Operation:
    """What a drivetrain carries while it is asked.

    Attributes
    ----------
    torque : float
        On the rotor about x [N m].
    moment : float
        On the rotor about y, tilting it [N m].
    """

    torque: float
    moment: float = 0.0


Question = Callable[[Machine, Level, Operation], float | None]
"""A number of a machine at a level; None where the level has no answer."""


def torsional_frequency(number: int) -> Question:
    """Of the torsional mode of that number above zero, and of the mode most like it [Hz].

    None where no mode has half of it: the mode has become several.
    """

    def asked(machine: Machine, level: Level, operation: Operation) -> float | None:
        del operation
        simple = torsional(machine)
        modes = natural_modes(simple)
        chosen = int(np.flatnonzero(modes.frequencies > 0)[number - 1])
        if level is Level.TORSIONAL:
            return float(modes.frequencies[chosen])
        system = machine_system(machine, level)
        found = system_modes(system)
        rows = [system.place(f"{name} rx") for name in modes.names]
        likeness = (modes.shapes[:, chosen] * simple.J) @ found.shapes[rows]
        best = int(np.abs(likeness).argmax())
        return float(found.frequencies[best]) if likeness[best] ** 2 > 0.5 else None

    return asked


def _loaded(machine: Machine, level: Level, operation: Operation) -> Static | None:
    if level is Level.TORSIONAL:
        return None
    system = machine_system(machine, level, held_generator=True)
    hub = np.array([0.0, 0.0, 0.0, 0.0, operation.moment, 0.0])
    return static(system, steady_load(machine, system, operation.torque, hub))


def planet_bearing_load(machine: Machine, level: Level, operation: Operation) -> float | None:
    """Largest radial load of a bearing of the first stage's planets [kN]."""
    found = _loaded(machine, level, operation)
    stage = machine.stages[0]
    if found is None or not isinstance(stage, PlanetaryData):
        return None
    return max(pin_loads(found, stage, 1).values()) / 1e3


def pin_loads(found: Static, stage: PlanetaryData, number: int) -> dict[str, float]:
    """Radial load of each planet's bearings by their names, such as "stage 1 pin 1 upwind" [N]."""
    names = [
        f"stage {number} pin {k + 1} {pin.name}".strip()
        for k in range(stage.planets)
        for pin in stage.pins
    ]
    return {
        name: float(np.hypot(found.force(f"{name} uy"), found.force(f"{name} uz")))
        for name in names
    }


def planet_sharing(machine: Machine, level: Level, operation: Operation) -> float | None:
    """Load of the ring's mesh that has most, over the mean of the first stage's."""
    found = _loaded(machine, level, operation)
    stage = machine.stages[0]
    if found is None or not isinstance(stage, PlanetaryData):
        return None
    forces = [found.force(f"stage 1 ring-planet {k + 1}") for k in range(stage.planets)]
    return load_sharing(np.array(forces))


def face_load(machine: Machine, level: Level, operation: Operation) -> float | None:
    """Largest load of a slice over the mean, of the last parallel stage's mesh."""
    found = _loaded(machine, level, operation)
    numbers = [k for k, stage in enumerate(machine.stages, 1) if isinstance(stage, ParallelData)]
    if found is None or not numbers or machine.stages[numbers[-1] - 1].slices == 1:
        return None
    return load_sharing(slices_of(found, f"stage {numbers[-1]} mesh"))


def slices_of(found: Static, mesh: str) -> Floats:
    """Forces of the slices of a mesh along the face [N]."""
    names = found.system.spring_names
    return found.forces[[k for k, n in enumerate(names) if n.startswith(f"{mesh} slice ")]]


QUESTIONS: Mapping[str, Question] = {
    "first torsional frequency [Hz]": torsional_frequency(1),
    "largest load of a planet's bearing [kN]": planet_bearing_load,
    "load sharing of the planets": planet_sharing,
    "face load of the last gear pair": face_load,
}
"""What is asked most, by its name and unit."""


@dataclass(frozen=True)
class Answer:
    """One level's answers.

    Attributes
    ----------
    level : Level
        That gave them.
    degrees : int
        Number of degrees of freedom.
    seconds : float
        Taken for all questions.
    values : Mapping[str, float or None]
        By question; None where the level has no answer.
    """

    level: Level
    degrees: int
    seconds: float
    values: Mapping[str, float | None]


def ladder(
    machine: Machine, operation: Operation, questions: Mapping[str, Question] = QUESTIONS
) -> list[Answer]:
    """The answers of all levels, from the simplest.

    Parameters
    ----------
    machine : Machine
        With a rotor that has a mass.
    operation : Operation
        Torque and moment of the statics.
    questions : mapping
        By name.
    """
    found = []
    for level in Level:
        start = perf_counter()
        values = {name: ask(machine, level, operation) for name, ask in questions.items()}
        seconds = perf_counter() - start
        size: System = machine_system(machine, level)
        found.append(Answer(level, len(size.names), seconds, values))
    return found


def needed_level(answers: Sequence[Answer], question: str, tolerance: float) -> Level:
    """The simplest level whose answer is within a tolerance of the finest one's.

    Parameters
    ----------
    answers : sequence of Answer
        Of `ladder`, from the simplest level to the finest.
    question : str
        One of those that were asked.
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
    chosen = answers[-1].level
    for answer in reversed(answers):
        value = answer.values[question]
        if value is None or abs(value - finest) > tolerance * abs(finest):
            break
        chosen = answer.level
    return chosen
