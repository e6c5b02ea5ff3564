"""Stiffness of bearings by six by six, of their rollers where a torque and gravity have put them.

In the equilibrium of a machine on the rollers of its catalogued bearings, laminae, clearance and
all, each bearing has the tangent K = dF/du of its forces and moments by its motions, symmetric,
with couplings between shift along, shift across and tilt (Al-Hamadani 2018, Eq 5.8). Springs of
that stiffness are for what a linear model does near that state, such as modes; a motion that begins
at rest with all clearance open lacks the way that the clearance leaves.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.steps import Clock
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.turning_parts import diagonal
from fe_drivetrain.dynamics.bodies.advice import UNCONDENSED, Operation, Rung
from fe_drivetrain.dynamics.bodies.catalogue_seats import catalogued, main_names, on_catalogue
from fe_drivetrain.dynamics.bodies.condensed_rungs import Rungs, plain_rungs, rungs_of, with_rollers
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system, steady_load
from fe_drivetrain.dynamics.bodies.machine import Machine, rated_torque
from fe_drivetrain.dynamics.bodies.roller_seats import OnRollers, rollers_of
from fe_drivetrain.dynamics.bodies.static import static

MATRICES = "bearings by their matrices"
"""Name of the rung with the stiffness of catalogued bearings of the gearbox by six by six."""

_OF_FIVE = (0, 1, 2, 4, 5)  # motions of an inner ring among the six of a body


@dataclass(frozen=True)
class RollerMatrices:
    """Bearings of a gearbox by the stiffness of their rollers, in an equilibrium.

    Attributes
    ----------
    found : OnRollers
        Equilibrium that they belong to.
    stiffness : Mapping[str, Floats]
        Stiffness (6, 6) of each by the name of its springs, as "stage 1 pin 1 upwind", along and
        about x, y, z, of planets along and about x, the radius and the tangent [N/m, N, N m/rad].
    """

    found: OnRollers
    stiffness: Mapping[str, Floats]

    __repr__ = short_repr

    @property
    def diagonals(self) -> dict[str, Floats]:
        """The same without couplings."""
        return {name: np.diag(K.diagonal()) for name, K in self.stiffness.items()}


def in_gearbox(machine: MachineTable) -> list[str]:
    """Names of catalogued bearings beside those of the rotor and the shaft that it drives."""
    mains = main_names(machine)
    return [name for name in catalogued(machine) if name not in mains]


def roller_matrices(
    machine: MachineTable,
    rung: Rung,
    operation: Operation,
    *,
    catalogues: Sequence[str | Path] = (),
    azimuth: float = 0.0,
    hub: ArrayLike = (0.0,) * 6,
) -> RollerMatrices:
    """Stiffness of the catalogued bearings of a gearbox by their rollers in equilibrium.

    What rollers do not resist, such as the shift of a cylindrical bearing along its axis, keeps the
    spring of its row.

    Parameters
    ----------
    machine : MachineTable
        The machine.
    rung, operation : Rung, Operation
        Level and loads, as in `on_catalogue`.
    catalogues : sequence of str or Path
        Catalogue files beside the package's.
    azimuth : float
        Azimuth of the rotor's shaft [rad].
    hub : array_like, (6,)
        Forces and moments on the rotor beside those of the operation [N, N m].

    Raises
    ------
    InputError
        No bearing of the gearbox has a catalogue entry, `on_catalogue` refuses one, or the rollers
        find no equilibrium.
    """
    names = in_gearbox(machine)
    if rung.level is Level.TORSIONAL or not names:
        raise InputError(
            f"no bearing in the gearbox of {machine.title!r} has a catalogue entry and a load, of "
            "whose rollers its stiffness could be: give gearbox.bearings or pins a catalogue"
        )
    found = on_catalogue(
        machine, rung, operation, names, catalogues=catalogues, azimuth=azimuth, hub=hub
    )
    if not found.converged:
        raise InputError(
            "bearings on their rollers find no equilibrium under "
            f"{operation.torque:.4g} N m: a clearance leaves a part loose; give less clearance"
        )
    tangents = rollers_of(found.static.system, found.seats).carried(found.motions)[1]
    rows = {name: diagonal(row.stiffness) for name, row in catalogued(machine).items()}
    stiffness = {}
    for seat, tangent in zip(found.seats, tangents, strict=True):
        K = np.zeros((6, 6))
        K[np.ix_(_OF_FIVE, _OF_FIVE)] = 0.5 * (tangent + tangent.T)
        free = ~K.any(axis=1)
        K[free, free] = np.array(rows[_row_name(seat.name)])[free]
        stiffness[seat.name] = K
    return RollerMatrices(found, stiffness)


def _row_name(name: str) -> str:
    """Name of a bearing's row: that of all planets where it is one of a planet's."""
    before, pin, behind = name.partition(" pin ")
    return f"{before} pin {behind.partition(' ')[2]}".strip() if pin else name


def by_matrices(rung: Rung, stiffness: Mapping[str, Floats], name: str = MATRICES) -> Rung:
    """A level with the stiffness (6, 6) of some bearings, by the names of their springs.

    Parameters
    ----------
    rung : Rung
        The level before.
    stiffness : mapping of str to ndarray (6, 6)
        As `RollerMatrices.stiffness` [N/m, N, N m/rad].
    name : str
        Name of the level.
    """
    own = {**rung.flexible.bearings, **stiffness}
    return replace(rung, name=name, flexible=replace(rung.flexible, bearings=own), seconds=0.0)


def with_matrices(
    rungs: Rungs, machine: Machine, torque: float, catalogues: Sequence[str | Path] = ()
) -> Rungs:
    """The ladder with one level more: gearbox bearings by the stiffness of their rollers.

    It follows the finest level on springs, before one on rollers.

    Parameters
    ----------
    rungs : Rungs
        Ladder of a drivetrain.
    machine : Machine
        Its machine.
    torque : float
        Torque on the rotor of the equilibrium [N m]; gravity acts, too.
    catalogues : sequence of str or Path
        Catalogue files beside the package's.

    Raises
    ------
    InputError
        See `roller_matrices`; or what bearings leave loose within their clearance moves freely.
    """
    springs = [rung for rung in rungs.rungs if not rung.rollers]
    operation, last = Operation(torque), springs[-1]
    found = roller_matrices(machine, last, operation, catalogues=catalogues)
    finer = by_matrices(last, found.stiffness)
    rollers = UNCONDENSED[-1]
    state = f"at {torque:.4g} N m of the rotor, azimuth 0: off it they are stiffer or softer"
    finer = replace(
        finer,
        neglects=tuple(
            "what rollers and clearance change away from that torque" if what == rollers else what
            for what in last.neglects
        ),
        assumes=(*last.assumes, f"stiffness of gearbox bearings: of their rollers {state}"),
    )
    system = machine_system(machine, finer.level, held_generator=True, flexible=finer.flexible)
    try:
        static(system, steady_load(machine, system, torque, np.zeros(6)))
    except InputError as error:
        raise InputError(
            f"bearings by the stiffness of their rollers: {error}; one within its clearance "
            "carries nothing at that torque: give it less clearance, or no catalogue"
        ) from None
    return Rungs((*springs, finer, *(rung for rung in rungs.rungs if rung.rollers)), rungs.left_out)


def asked_rungs(
    drivetrain: Drivetrain,
    machine: Machine,
    *,
    condensed: bool = False,
    matrices: bool = False,
    rollers: bool = False,
    steps: Clock | None = None,
) -> Rungs:
    """The ladder of a drivetrain that a study is asked for.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain.
    machine : Machine
        Its machine.
    condensed : bool
        Whether it goes on with what has to be condensed, see `rungs_of`.
    matrices : bool
        Whether its last level has gearbox bearings by the stiffness of their rollers at rated
        torque, see `with_matrices`.
    rollers : bool
        Whether the last level has catalogued bearings on their rollers, see `with_rollers`.
    steps : Clock or None
        Times each step.

    Raises
    ------
    InputError
        See `rungs_of`, `with_rollers` and `with_matrices`, or no rated torque is known.
    """
    if condensed:
        rungs = rungs_of(drivetrain, steps=steps)
    else:
        rungs = Rungs(plain_rungs(drivetrain, machine), {})
    if rollers:
        rungs = with_rollers(rungs, machine)
    if not matrices:
        return rungs
    rated = rated_torque(drivetrain, machine)
    if rated is None:
        raise InputError(
            f"{drivetrain.title!r} states no torque at which rollers of bearings stand: give "
            "generator.rated_torque, or operation.rated_power and operation.rotor_speed"
        )
    return with_matrices(rungs, machine, rated.torque)
