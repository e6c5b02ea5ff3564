"""Motions of a machine that no spring feels: found, and named, before it is solved.

A drivetrain turns freely as its teeth say, where no grid holds its generator. Every other free
motion is a mechanism, and a spring that feels the turning belongs to another geometry than the
teeth.
"""

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.free_motions import described_motion, null_space, sparsest
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.dynamics.bodies.bodies import assemble
from fe_drivetrain.dynamics.bodies.levels import Assembly, Level, assembly
from fe_drivetrain.dynamics.bodies.machine_shafts import spline_bodies
from fe_drivetrain.dynamics.bodies.modes import spring_frequencies, system_modes
from fe_drivetrain.dynamics.bodies.system import System, without_massless
from fe_drivetrain.dynamics.torsion.system import resolved

#: Share of what a spring's parts do to its length below which turning that winds it is round-off.
WOUND = 1e-9
#: Motions that are named in one message.
NAMED = 3


def check_held(machine: MachineTable) -> None:
    """Refuse a machine of which something moves freely, or that cannot turn as its teeth say.

    Raises
    ------
    InputError
        See above; each motion by its body and direction.
    """
    made = assembly(machine, Level.RIGID)
    system = assemble(made.bodies, made.springs, made.superelements)
    _check_turning(machine, made, system)
    _check_free(machine, made, system)
    _check_frequencies(machine, made, without_massless(system))


def free_count(machine: MachineTable) -> int:
    """Number of free motions of a drivetrain: it turns, where no grid holds its generator."""
    return 0 if machine.generator.stiffness > 0 else 1


def turning(machine: MachineTable) -> dict[str, float]:
    """Speed of each body about its axis over the rotor's, of its teeth or radii alone."""
    found = {"rotor": 1.0, "generator": machine.speeds[-1]}
    rows = zip(machine.shafts, machine.speeds, strict=True)
    found |= {name: speed for shaft, speed in rows for name in spline_bodies(shaft)}
    for number, stage in enumerate(machine.stages, start=1):
        name, front, rear = f"stage {number}", machine.speeds[number - 1], machine.speeds[number]
        if not isinstance(stage, PlanetaryData):
            found |= {f"{name} gear": front, f"{name} pinion": rear}
            continue
        if stage.teeth is not None:
            ring_over_planet = stage.teeth[0] / stage.teeth[1]
        else:
            planet = stage.centre_distance - stage.sun_radius
            ring_over_planet = (stage.centre_distance + planet) / planet
        found |= {f"{name} carrier": front, f"{name} sun": rear, f"{name} ring": 0.0}
        for k in range(stage.planets):
            found[f"{name} bushed pin {k + 1}"] = front
            found[f"{name} planet {k + 1}"] = front * (1 - ring_over_planet)
    return found


def turning_motion(machine: MachineTable, made: Assembly, system: System) -> Floats:
    """(n,) motion of the system as the rotor turns by 1 rad, planets going round with carriers."""
    speeds, at = turning(machine), {body.name: body.position for body in made.bodies}
    q = np.zeros(len(system.names))
    for i, label in enumerate(system.names):
        name, _, motion = label.rpartition(" ")
        stage, planet, _ = name.replace(" bushed pin ", " planet ").partition(" planet ")
        if motion == "rx":
            q[i] = speeds.get(name, 0.0)
        elif planet and motion in ("uy", "uz"):
            arm = np.subtract(at[name], at[f"{stage} carrier"])
            q[i] = speeds[f"{stage} carrier"] * (-arm[2] if motion == "uy" else arm[1])
    return q


def _check_turning(machine: MachineTable, made: Assembly, system: System) -> None:
    q = turning_motion(machine, made, system)
    wound = np.abs(system.rows @ q) > WOUND * (np.abs(system.rows) @ np.abs(q))
    felt = [system.spring_names[int(k)] for k in np.flatnonzero(wound)]
    felt = [name for name in felt if name != "grid rx"]
    if felt:
        raise InputError(
            f"{felt[0]!r} is wound as the drivetrain turns at the ratios of its teeth or radii, "
            "which its line of action must not be: teeth, radii and centre distance are of two "
            "geometries; correct one of them"
        )


def _check_free(machine: MachineTable, made: Assembly, system: System) -> None:
    """Free motions of the springs as they lie, however stiff."""
    length = sum(shaft.length for shaft in machine.shafts)
    turns = np.array([name.rpartition(" ")[2].startswith("r") for name in system.names])
    scaled = system.rows / np.where(turns, length, 1.0)
    sizes = np.linalg.norm(scaled, axis=1)
    felt = (system.stiffness > 0) & (sizes > 0)
    rows = [np.zeros((1, len(turns))), scaled[felt] / sizes[felt][:, None]]
    null = null_space(rows, known=free_count(machine))
    if not len(null):
        return
    at_bodies = system.expansion / np.where(turns, length, 1.0)
    at_bodies[np.arange(len(at_bodies)) % 6 > 2] *= length
    motions = sparsest(null @ at_bodies.T).reshape(-1, len(made.bodies), 6)
    moved = [np.flatnonzero(np.abs(motion).max(axis=1) > 1e-6) for motion in motions]
    order = sorted(range(len(motions)), key=lambda k: len(moved[k]))
    # what moves most parts is the drivetrain's own turning
    free = order[: len(order) - free_count(machine)]
    said = []
    for k in free[:NAMED]:
        bodies = [made.bodies[int(b)] for b in moved[k]]
        names = [body.name for body in bodies]
        names = names if len(names) <= NAMED else [*names[:NAMED], f"{len(names) - NAMED} others"]
        centre = np.asarray(bodies[0].position)
        said.append(described_motion(names, motions[k][moved[k][0]], centre, length, "freely"))
    more = f"; and {len(free) - NAMED} more such motions" if len(free) > NAMED else ""
    raise InputError(
        f"the drivetrain is a mechanism: {'; '.join(said)}{more}: give the bearing, pins or shaft "
        "there a stiffness in that direction"
    )


def _check_frequencies(machine: MachineTable, made: Assembly, system: System) -> None:
    """Springs and masses so far apart that a motion has 0 Hz but for round-off."""
    try:
        found = spring_frequencies(system)
    except np.linalg.LinAlgError:
        raise InputError(
            "masses and inertias are too far apart for the digits of a computer: correct them"
        ) from None
    at = free_count(machine)
    if resolved(found, at):
        return
    modes = system_modes(system)
    free = modes.shapes[:, modes.frequencies <= found[at]]
    if at:  # what is not the drivetrain's own turning
        t = turning_motion(machine, made, system)
        free = free - np.outer(t, t @ system.mass @ free) / (t @ system.mass @ t)
    moving = int(np.argmax(np.abs(free * (system.mass @ free)).sum(axis=1)))
    raise InputError(
        "stiffnesses or masses are too far apart for the digits of a computer: "
        f"{system.names[moving]} swings at {found[at]:.3g} Hz beside {found[-1]:.3g} Hz: correct "
        "the stiffness or mass there"
    )
