"""Closed forms of how planets share their load, and a stage that they are exact for."""

from dataclasses import dataclass, replace
from math import cos, radians

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.dynamics.bodies.bodies import PLANE, assemble
from fe_drivetrain.dynamics.bodies.planetary import (
    Inertias,
    PinBearing,
    PlanetarySet,
    bodies_of,
    equal_angles,
    springs_of,
)
from fe_drivetrain.dynamics.bodies.springs import Place, bushing
from fe_drivetrain.dynamics.bodies.static import Static, static
from fe_drivetrain.gear.working_angles import Mesh


def shared_load(
    planets: int, nominal: float, stiffness: float, error: float, floating: bool
) -> Floats:
    """Mesh forces with one pin's error, all meshes in contact [N].

    A branch of stiffness K a planet, in parallel on a sun that moves in its plane and turns (three
    motions) or turns alone: with the cosines and sines of equal angles square to each other, what
    is left of the error on planet 1 is 1 - 3/N, or 1 - 1/N.

    Parameters
    ----------
    planets : int
        N, three or more.
    nominal : float
        Mean mesh force, T / (N r_b) [N].
    stiffness : float
        Of a branch along the line of action [N/m].
    error : float
        Of planet 1, along the line of action; positive presses it [m].
    floating : bool
        Whether the sun moves in its plane.
    """
    psi = np.array(equal_angles(planets))
    free = np.array([np.ones(planets), np.cos(psi), np.sin(psi)])[: 3 if floating else 1]
    basis = np.linalg.qr(free.T)[0]
    own = np.zeros(planets)
    own[0] = stiffness * error
    return np.asarray(nominal + own - basis @ (basis.T @ own))


def branch_stiffness(sun: float, ring: float, pin: float, pressure_angle: float) -> float:
    """Stiffness of a planet between sun and ring on a pin as stiff in both directions [N/m].

    Both meshes carry F and the pin 2 F cos(alpha) along the tangent; the planet's own turning makes
    the two equal.

    Parameters
    ----------
    sun, ring, pin : float
        Stiffnesses [N/m].
    pressure_angle : float
        Of both meshes [rad].
    """
    return 1 / (1 / sun + 1 / ring + 4 * cos(pressure_angle) ** 2 / pin)


@dataclass(frozen=True)
class SharingStage:
    """Planets on pins of a carrier that is held, in a ring that is held; torque on the sun.

    Attributes
    ----------
    planets : int
        Number.
    floating : bool
        Whether the sun moves in its plane.
    weak : float
        Stiffness that holds a floating sun, and planets without contact [N/m]: so weak that its
        force may be left out.
    """

    planets: int
    floating: bool = True
    weak: float = 0.0

    MESH = 4e8
    PIN = 3e8
    ANGLE = radians(22.0)

    @property
    def stage(self) -> PlanetarySet:
        """Its geometry, driven by the carrier."""
        light = Inertias(1.0, 1.0, 1.0)
        return PlanetarySet(
            "",
            0.3,
            0.2,
            Mesh(self.ANGLE),
            Mesh(self.ANGLE),
            equal_angles(self.planets),
            light,
            light,
            light,
            light,
            self.MESH,
            self.MESH,
            (PinBearing((0, self.PIN, self.PIN, 0.01 * self.weak, 0, 0)),),
            free=PLANE,
        )

    @property
    def branch(self) -> float:
        """Stiffness of a planet's branch [N/m]."""
        return branch_stiffness(self.MESH, self.MESH, self.PIN, self.ANGLE)

    def solved(
        self, nominal: float, pin_errors: dict[int, float], only_press: bool = False
    ) -> Static:
        """Equilibrium under the torque of a mean mesh force.

        Parameters
        ----------
        nominal : float
            T / (N r_b) [N].
        pin_errors : dict of int to float
            Tangential error [m] of pins by number from 1, positive ahead, which presses.
        only_press : bool
            Whether teeth part where they would pull.
        """
        built = self.stage
        if any(not 1 <= k <= self.planets for k in pin_errors):
            raise InputError(f"pins are numbered from 1 to {self.planets}: correct {pin_errors}")
        held = {"carrier", "ring"}
        bodies = [
            replace(b, free=frozenset() if b.name in held else b.free) for b in bodies_of(built)
        ]
        springs = springs_of(built)
        sun = Place("sun", (0.0, 0.0, 0.0))
        across = self.weak if self.floating else 1e6 * self.MESH
        springs += bushing("sun support", sun, None, sun.centre, (0, across, across, 0, 0, 0))
        system = assemble(bodies, springs)
        torque = -nominal * self.planets * built.sun_base_radius
        load = system.load_on("sun", np.array([0, 0, 0, torque, 0, 0]))
        gaps = {f"pin {k} uz": error for k, error in pin_errors.items()}
        meshes = [n for n in system.spring_names if "-planet" in n]
        return static(system, load, gaps, meshes if only_press else ())

    def over_mean(self, error: float, shares: Floats) -> Floats:
        """Mesh forces over their mean, by the torque, where teeth only press.

        Parameters
        ----------
        error : float
            Tangential, of the first pin [m].
        shares : ndarray
            (n,) mean load of a mesh over the load that the error alone presses a branch with.

        Returns
        -------
        over : ndarray
            (n, planets).
        """
        scale = self.branch * 2 * cos(self.ANGLE) * error
        solved = (self.solved(share * scale, {1: error}, only_press=True) for share in shares)
        forces = np.array([self.mesh_forces(found) for found in solved])
        return np.asarray(forces / forces.mean(axis=1, keepdims=True))

    def mesh_forces(self, found: Static) -> Floats:
        """(planets,) of the sun's meshes [N]."""
        return np.array([found.force(f"sun-planet {k + 1}") for k in range(self.planets)])
