"""Shutdown of a torsional drivetrain: generator off, blades pitched, disc brake, standstill.

The sequence of Al-Hamadani 2018, section 4.5, on the torsional systems of
`fe_drivetrain.dynamics.torsion`: normal operation, then the aerodynamic torque falls and the
generator is off at once, then a disc brake on the high-speed shaft until it stands, and the rotor
swings against it.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.dynamics.bodies.equations import (
    Equations,
    equations_of_motion,
    spring_laws,
    varying,
)
from fe_drivetrain.dynamics.bodies.steady_state import wind_up
from fe_drivetrain.dynamics.time.brakes import Brake
from fe_drivetrain.dynamics.time.integration import Phase, transient
from fe_drivetrain.dynamics.time.motion import Motion, State
from fe_drivetrain.dynamics.time.steady_turning import Turning, with_laws
from fe_drivetrain.dynamics.torsion.damping import shaft_damping
from fe_drivetrain.dynamics.torsion.gear_table import (
    GENERATOR,
    ROTOR,
    GearTable,
    gear_masses,
    gear_speeds,
    two_masses,
)
from fe_drivetrain.dynamics.torsion.system import Torsional, damped


@dataclass(frozen=True)
class StopSequence:
    """Times of the events of a shutdown.

    Attributes
    ----------
    off : float
        The generator's torque goes to zero, and the blades begin to pitch [s].
    pitched : float
        The aerodynamic torque has fallen, evenly, to `left` [s].
    left : float
        Remaining torque over rated torque.
    braked : float
        The disc brake is applied [s].
    end : float
        End of the sequence [s].
    rise : float
        Time in which the brake grows to full size [s].
    back : float or None
        The generator is on again after a dip of the grid [s]; stays off where none.
    """

    off: float = 1.0
    pitched: float = 3.0
    left: float = 0.0
    braked: float = 3.0
    end: float = 30.0
    rise: float = 0.0
    back: float | None = None


@dataclass(frozen=True)
class Shutdown:
    """Response of a drivetrain to a shutdown.

    Attributes
    ----------
    system : Torsional
        Masses of the drivetrain, with the springs between them.
    speeds : dict[str, float]
        Speed of each mass, over that of the rotor.
    torque : float
        Rated torque at the rotor [N m].
    motion : Motion
        Angles, speeds, torques; springs are the elements of the system, and the generator.
    """

    system: Torsional
    speeds: dict[str, float]
    torque: float
    motion: Motion

    def ratio(self, element: str) -> Floats:
        """(k,) torque of an element over its torque in steady operation at rated torque."""
        names = [e.name for e in self.system.elements]
        forces = self.motion.forces[:, names.index(element)]
        return np.asarray(forces / self.rated(element))

    def rated(self, element: str) -> float:
        """Torque of an element at rated torque, by statics [N m]."""
        return float(_static(self.system, self.speeds, self.torque)[_number(self.system, element)])


def _number(system: Torsional, element: str) -> int:
    return [e.name for e in system.elements].index(element)


def _static(system: Torsional, speeds: dict[str, float], torque: float) -> Floats:
    """Torque of each element at a torque on the rotor that the generator holds."""
    load = np.zeros(len(system.inertias))
    load[system.place(ROTOR)] = torque
    load[system.place(GENERATOR)] = -torque / speeds[GENERATOR]
    equations = torsional_equations(system)
    return np.asarray(system.k * (system.B @ wind_up(equations, load).q))


def damped_by_ratio(system: Torsional, ratios: Mapping[str, float]) -> Torsional:
    """Dampers beside the springs of a torsional system, from damping ratios.

    The ratio is that of the element alone: C = 2 zeta sqrt(k J) with J the inertia that its two
    sides oppose to each other, 1 / (b M^-1 b^T) of its row b (Al-Hamadani 2018, Eq 4.5 and 4.7 as
    they must be meant).

    Parameters
    ----------
    system : Torsional
        Inertias and springs.
    ratios : Mapping[str, float]
        zeta by the name of the element; others keep their dampers.

    Returns
    -------
    system : Torsional
    """
    inertia = 1.0 / (system.B**2 @ (1.0 / system.J))
    c = {
        e.name: shaft_damping(ratios[e.name], float(J), e.stiffness)
        for e, J in zip(system.elements, inertia, strict=True)
        if e.name in ratios
    }
    return damped(system, c)


def torsional_equations(system: Torsional) -> Equations:
    """Equations of motion of a torsional system."""
    damping = np.array([element.damping for element in system.elements])
    return equations_of_motion(system.J, spring_laws(system.B, system.k, damping))


def shutdown(
    table: GearTable,
    torque: float,
    rotor_speed: float,
    brake: float,
    sequence: StopSequence | None = None,
    *,
    dt: float = 1e-3,
    lumped: bool = False,
    slip: float = 0.01,
    ratios: tuple[float, float] | None = None,
    backlash: float = 0.0,
) -> Shutdown:
    """Compute how a drivetrain stops.

    Parameters
    ----------
    table : GearTable
        Inertias and stiffnesses.
    torque, rotor_speed : float
        Rated torque and speed of the rotor [N m, rad/s].
    brake : float
        Torque of the brake on the generator's shaft, over the generator's rated torque; 0 for none.
    sequence : StopSequence, optional
        Times of the events.
    dt : float
        Length of a step [s].
    lumped : bool
        Whether two masses stand in place of one for each gear.
    slip : float
        Slip of the generator at rated torque.
    ratios : tuple of float, optional
        Damping ratios of shafts and of meshes, see `damped_by_ratio`, in place of the dampers of
        the table.
    backlash : float
        Backlash of all meshes, about the axis that their stiffness is about [rad]: where torque is
        reversed, teeth part and touch with their other flanks.

    Returns
    -------
    found : Shutdown
    """
    when = sequence or StopSequence()
    system = (two_masses if lumped else gear_masses)(table, "free")
    if ratios is not None:
        shafts = {shaft.name for shaft in table.shafts} | {"shafts"}
        named = {e.name: ratios[0 if e.name in shafts else 1] for e in system.elements}
        system = damped_by_ratio(system, named)
    speeds = {ROTOR: 1.0, GENERATOR: 1.0} if lumped else dict(gear_speeds(table))
    to_rotor, to_generator = np.zeros(len(speeds)), np.zeros(len(speeds))
    to_rotor[system.place(ROTOR)] = 1.0
    to_generator[system.place(GENERATOR)] = 1.0
    chain = torsional_equations(system)
    if backlash:
        shafts = {shaft.name for shaft in table.shafts} | {"shafts"}
        half = np.array([0.0 if e.name in shafts else backlash / 2.0 for e in system.elements])
        chain = replace(chain, springs=replace(chain.springs, lower=-half, upper=half))
    velocity = rotor_speed * np.array([speeds[name] for name in system.names])
    turning = Turning(to_rotor, to_generator, torque, speeds[GENERATOR], velocity)
    rated = turning.generator_torque
    discs = [Brake(to_generator, abs(brake * rated), when.braked, when.rise)] if brake else []
    phases, start = stop_phases(chain, turning, when, discs, slip)
    return Shutdown(system, speeds, torque, transient(phases, dt, start))


def stop_phases(
    chain: Equations, turning: Turning, when: StopSequence, discs: Sequence[Brake], slip: float
) -> tuple[list[Phase], State]:
    """Phases of a stop, or of a loss of the grid, and the state wound up from which it begins.

    Parameters
    ----------
    chain : Equations
        Equations of motion without the generator's law.
    turning : Turning
        Steady turning before.
    when : StopSequence
        Times of the events; those of the discs are their own.
    discs : sequence of Brake
        Disc brakes.
    slip : float
        Slip of the generator at its torque.
    """
    machine, pull = turning.line(slip)
    on, off = with_laws(chain, machine), with_laws(chain, turning.off())
    torque, beside = turning.torque, turning.loads()
    wind = varying(turning.to_rotor, [when.off, when.pitched], [torque, when.left * torque])
    both = np.column_stack([turning.to_rotor, pull.patterns[:, 0]])
    normal = varying(both, [0.0], [[torque, 1.0]])
    load = sum((one.at(0.0) for one in beside), normal.at(0.0))
    start = wind_up(on, load, turning.velocity)
    phases = [
        Phase(when.off, on, [normal, *beside]),
        Phase(when.back or when.end, off, [wind, *beside, *discs]),
    ]
    if when.back is not None:
        phases.append(Phase(when.end, on, [wind, pull, *beside, *discs]))
    return phases, State(start.q, turning.velocity, start.acceleration)
