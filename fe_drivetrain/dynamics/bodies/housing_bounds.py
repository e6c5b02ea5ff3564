"""What both bounds of the main bearings' housings do to frequencies and reactions."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.joint_springs import free_to_turn
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.dynamics.bodies.condensed_rungs import plain_rungs
from fe_drivetrain.dynamics.bodies.flexible import Flexible
from fe_drivetrain.dynamics.bodies.levels import Level, machine_system, steady_load
from fe_drivetrain.dynamics.bodies.machine import Machine, machine_of
from fe_drivetrain.dynamics.bodies.modes import system_modes
from fe_drivetrain.dynamics.bodies.static import static
from fe_drivetrain.shafts.fidelity.main_supports import main_supports


@dataclass(frozen=True)
class Between:
    """A number by both bounds.

    Attributes
    ----------
    soft, stiff : float
        Number with seats that move on average, and with rigid ones.
    """

    soft: float
    stiff: float

    @property
    def middle(self) -> float:
        """The mean of both."""
        return (self.soft + self.stiff) / 2

    @property
    def band(self) -> float:
        """Half of their difference."""
        return abs(self.stiff - self.soft) / 2


@dataclass(frozen=True)
class HousingBounds:
    """A drivetrain's answers between the two bounds of its main bearings' housings.

    Attributes
    ----------
    frequencies : tuple[Between, ...]
        First frequencies above zero, counted from the lowest [Hz]. Every one rises with the
        stiffness of the housings, so that it is between both.
    reactions : Mapping[str, Mapping[str, Between]]
        Forces and moments that each main bearing takes from the shaft at its centre, "Fx" to "Mz"
        by bearing [N, N m]. They need not lie between: the band is half of the difference.
    rigid : tuple[float, ...]
        Frequencies with rigid housings [Hz].
    left_out : Mapping[str, str]
        Bearings in a rigid housing, and why.
    """

    frequencies: tuple[Between, ...]
    reactions: Mapping[str, Mapping[str, Between]]
    rigid: tuple[float, ...]
    left_out: Mapping[str, str]

    __repr__ = short_repr


def housing_bounds(
    scene: Scene,
    torque: float = 0.0,
    hub: ArrayLike = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0),
    *,
    modes: int = 6,
    cache: Cache | None = None,
) -> HousingBounds:
    """Frequencies and main bearing reactions with housings at both bounds.

    Parameters
    ----------
    scene : Scene
        The drivetrain, with a rotor and a generator; everything else of it is at the level of
        flexible shafts, see `plain_rungs`.
    torque : float
        Torque on the rotor about x, held by the generator [N m].
    hub : array_like, (6,)
        Other forces and moments on the rotor; gravity acts, too [N, N m].
    modes : int
        Number of frequencies.
    cache : Cache or None
        Where housings may come from; the user's if not given.

    Raises
    ------
    InputError
        `machine_of` refuses the drivetrain, something moves freely, or a housing cannot be meshed.
    """
    machine, found = machine_of(scene), main_supports(scene, cache)
    wrench = np.asarray(hub, dtype=float)
    plain = plain_rungs(scene, machine)[-1].flexible
    ways = [
        replace(plain, bearings={name: free_to_turn(K) for name, K in way.items()})
        for way in (found.soft, found.stiff)
    ]
    loads = [_reactions(machine, scene, way, torque, wrench) for way in ways]
    soft, stiff = (_frequencies(machine, way, modes) for way in ways)
    return HousingBounds(
        tuple(Between(*pair) for pair in zip(soft, stiff, strict=True)),
        {
            name: {
                component: Between(float(low), float(high))
                for component, low, high in zip(FORCES, loads[0][name], loads[1][name], strict=True)
            }
            for name in loads[0]
        },
        _frequencies(machine, plain, modes),
        found.left_out,
    )


def _frequencies(machine: Machine, gives: Flexible, count: int) -> tuple[float, ...]:
    found = system_modes(machine_system(machine, Level.FLEXIBLE, flexible=gives)).frequencies
    return tuple(float(f) for f in found[found > 0][:count])


def _reactions(
    machine: Machine, scene: Scene, gives: Flexible, torque: float, hub: Floats
) -> dict[str, Floats]:
    """(6,) that each main bearing takes from the shaft."""
    system = machine_system(machine, Level.FLEXIBLE, held_generator=True, flexible=gives)
    found = static(system, steady_load(machine, system, torque, hub))
    known = {bearing.name for bearing in machine.bearings}
    return {name: found.wrench(name) for name in scene.bearing_names if name in known}
