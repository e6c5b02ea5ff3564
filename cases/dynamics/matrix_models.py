"""Gearbox bearings by springs, by six by six and on rollers: loads over a turn, and frequencies."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.dynamics import (
    Asked,
    Machine,
    OnRollers,
    Operation,
    RollerMatrices,
    Rung,
    Static,
    assemble,
    assembly,
    by_matrices,
    like_mode,
    on_catalogue,
    static,
    steady_load,
)
from fe_drivetrain.dynamics.bodies.mesh_loads import mesh_springs
from fe_drivetrain.dynamics.bodies.roller_matrices import in_gearbox
from fe_drivetrain.dynamics.bodies.system import springs_named

FILE, DIAGONAL, MATRIX = "springs of the file", "diagonal of the rollers' stiffness", "six by six"
ROLLERS = "rollers"
LINEAR = (FILE, DIAGONAL, MATRIX)
COUNTED = 0.1
"""Share of the largest load in the gearbox from which a bearing's error counts."""
MODES = 20
"""Modes of the model by six by six that those of the others are looked for."""


@dataclass(frozen=True)
class Turned:
    """Loads of one model over a turn of the rotor.

    Attributes
    ----------
    radial : Mapping[str, Floats]
        Radial load (a,) of each bearing by the name of its springs [N].
    slices : Mapping[str, Floats]
        Forces (a, p, s) of the slices of each mesh [N].
    """

    radial: Mapping[str, Floats]
    slices: Mapping[str, Floats]

    __repr__ = short_repr

    def face_load(self, mesh: str) -> float:
        """K_Hbeta: the largest load of a slice over the mean of its planet's mesh."""
        of = self.slices[mesh]
        return float((of / of.mean(axis=2, keepdims=True)).max())

    def sharing(self, mesh: str) -> float:
        """K_gamma: the largest load of a planet's mesh over the mean of all."""
        each = self.slices[mesh].sum(axis=2)
        return float((each / each.mean(axis=1, keepdims=True)).max())


def rungs_of_models(rung: Rung, matrices: RollerMatrices) -> dict[str, Rung]:
    """The level with each kind of linear bearings."""
    return {
        FILE: rung,
        DIAGONAL: by_matrices(rung, matrices.diagonals, DIAGONAL),
        MATRIX: by_matrices(rung, matrices.stiffness, MATRIX),
    }


def turned(
    machine: Machine,
    rung: Rung,
    operation: Operation,
    angles: Floats,
    names: Sequence[str],
    rollers: bool = False,
) -> Turned:
    """Equilibria of one model at one azimuth of the rotor after the other.

    Parameters
    ----------
    machine : Machine
        The machine.
    rung : Rung
        Level, with the stiffness of its bearings.
    operation : Operation
        Loads; gravity acts, too.
    angles : ndarray, (a,)
        Azimuths of the rotor [rad].
    names : sequence of str
        Names of the springs of the bearings.
    rollers : bool
        Whether catalogued bearings of the gearbox are on their rollers.

    Raises
    ------
    InputError
        Rollers find no equilibrium.
    """
    meshes = mesh_springs(machine)
    pressing = [spring for springs in meshes.values() for spring in springs]
    radial: dict[str, list[float]] = {name: [] for name in names}
    slices: dict[str, list[Floats]] = {name: [] for name in meshes}
    for azimuth in angles.tolist():
        asked = machine, rung, operation, azimuth, pressing
        source: OnRollers | Static = on_rollers(*asked) if rollers else at_rest(*asked)
        state = source.static if isinstance(source, OnRollers) else source
        for name in names:
            radial[name].append(source.radial(name))
        known = state.system.spring_names
        for mesh, springs in meshes.items():
            places = [springs_named(known, one) for one in springs]
            slices[mesh].append(state.forces[np.array(places)])
    return Turned(
        {name: np.array(found) for name, found in radial.items()},
        {name: np.array(found) for name, found in slices.items()},
    )


def on_rollers(
    machine: Machine, rung: Rung, operation: Operation, azimuth: float, pressing: Sequence[str]
) -> OnRollers:
    """Equilibrium with catalogued bearings of the gearbox on their rollers.

    Raises
    ------
    InputError
        There is none.
    """
    names = in_gearbox(machine)
    found = on_catalogue(machine, rung, operation, names, azimuth=azimuth, pressing=pressing)
    if not found.converged:
        raise InputError(
            f"{machine.title!r}: rollers find no equilibrium at {azimuth:.3g} rad: a clearance "
            "leaves a part loose; give less clearance"
        )
    return found


def at_rest(
    machine: Machine, rung: Rung, operation: Operation, azimuth: float, pressing: Sequence[str]
) -> Static:
    """Equilibrium with linear bearings, the slices of meshes only pressing."""
    parts = assembly(machine, rung.level, azimuth, held_generator=True, flexible=rung.flexible)
    system = assemble(parts.bodies, parts.springs, parts.superelements)
    hub = np.array([0.0, 0.0, 0.0, 0.0, operation.moment, 0.0])
    load = steady_load(machine, system, operation.torque, hub)
    names = system.spring_names
    contacts = [names[k] for mesh in pressing for k in springs_named(names, mesh)]
    return static(system, load, contacts=contacts)


def row_name(name: str) -> str:
    """A bearing by its row: "stage 1 pin upwind" of those of all planets."""
    before, pin, behind = name.partition(" pin ")
    return f"{before} pin {behind.partition(' ')[2]}".strip() if pin else name


def load_errors(of: Turned, rollers: Turned) -> dict[str, float]:
    """Largest error of each row's load, over its peak on rollers; of those that count."""
    rows: dict[str, list[str]] = {}
    for name in rollers.radial:
        rows.setdefault(row_name(name), []).append(name)
    peaks = {row: peak_load(rollers, names) for row, names in rows.items()}
    most = max(peaks.values())
    return {
        row: max(float(np.abs(of.radial[n] - rollers.radial[n]).max()) for n in names) / peaks[row]
        for row, names in rows.items()
        if peaks[row] >= COUNTED * most
    }


def peak_load(of: Turned, names: Sequence[str]) -> float:
    """Largest radial load of some bearings [N]."""
    return max(float(of.radial[name].max()) for name in names)


def second_over_first(of: Turned, name: str) -> float:
    """Amplitude at twice the speed of the rotor over that at once, of a bearing's radial load."""
    amplitudes = np.abs(np.fft.rfft(of.radial[name]))
    return float(amplitudes[2] / amplitudes[1])


def frequencies(machine: Machine, rungs: Mapping[str, Rung]) -> dict[str, list[float | None]]:
    """Frequencies of the modes of the six by six, and of those like them in each model [Hz].

    The first is the first torsional one; None where a model has no such mode.
    """
    load = Operation(0.0)
    finest = Asked(machine, rungs[MATRIX], load)
    moving = [f for f in finest.modes.frequencies.tolist() if f > 0.0][:MODES]
    found: dict[str, list[float | None]] = {MATRIX: list(moving)}
    for name in (FILE, DIAGONAL):
        own = Asked(machine, rungs[name], load)
        found[name] = [like_mode(finest, k + 1)(own) for k in range(len(moving))]
    return found


def coupling(K: Floats) -> float:
    """Largest coupling of a stiffness (6, 6) over the roots of its diagonal."""
    root = np.sqrt(K.diagonal())
    held = root > 0.0
    scaled = K[np.ix_(held, held)] / np.outer(root[held], root[held])
    return float(np.abs(scaled - np.diag(scaled.diagonal())).max())


def softened(half: RollerMatrices, full: RollerMatrices) -> dict[str, float]:
    """Largest change of each row's stiffness across its axis from half to all of the torque."""
    found: dict[str, float] = {}
    for name, K in full.stiffness.items():
        across = K.diagonal()[1:3]
        change = float(np.abs(half.stiffness[name].diagonal()[1:3] / across - 1.0).max())
        found[row_name(name)] = max(found.get(row_name(name), 0.0), change)
    return found
