"""A uniform shaft on supports, in the plane of x and z, by three methods that share nothing.

The frame of this library, Macaulay's brackets, and solid elements by their sectional compliance.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.cases.references import solid_shafts
from fe_drivetrain.cases.references.shaft_theory import (
    Tube,
    evenly_loaded_shear,
    parabola_shortfall,
    sag,
)
from fe_drivetrain.cases.references.solid_shafts import Compliance, Supported
from fe_drivetrain.cases.references.sprung_beams import Spring, macaulay
from fe_drivetrain.shafts.beam import Beam, BeamSection, Support, solve

EVENLY = "Macaulay's brackets with shear of evenly loaded sections (Hutchinson 2001, as quoted by "
EVENLY += "Stephen 2001; derived again)"
"""Where `SupportedShaft.evenly` comes from."""


@dataclass(frozen=True)
class Load:
    """A load of the shaft.

    Attributes
    ----------
    station : int
        Index of the station where force and moment act.
    force, moment : float
        Along z [N] and about y [N m].
    gravity : float
        Along z [m/s^2].
    """

    station: int
    force: float = 0.0
    moment: float = 0.0
    gravity: float = 0.0


@dataclass(frozen=True)
class SupportedShaft:
    """A shaft on supports at some of its stations.

    Attributes
    ----------
    tube : Tube
        The shaft; its front face is the first station, at x = 0.
    stations : tuple of float
        Where loads and supports act, and motions are read [m]; planes of nodes of the solid.
    supports : tuple of tuple
        (force, moment) stiffness at each station [N/m, N m/rad]; inf is rigid, 0 is none.
    """

    tube: Tube
    stations: tuple[float, ...]
    supports: tuple[tuple[float, float], ...]

    def frame(self, load: Load, shear: bool = True) -> Supported:
        """By the frame of this library, whose last support locates it along x and about x."""
        held = [k for k, stiffness in enumerate(self.supports) if max(stiffness) > 0]
        supports = []
        for i in held:
            k, m = self.supports[i]
            along = np.inf if i == held[-1] else 0.0
            supports.append(Support(str(i), self.stations[i], (along, k, k, along, m, m)))
        sections = [BeamSection(self.tube.length, self.tube.outer, self.tube.inner)]
        beam = Beam(sections, supports, material=self.tube.material, shear=shear)
        wrench = np.array([0.0, 0.0, load.force, 0.0, load.moment, 0.0])
        at, weight = self.stations[load.station], (0.0, 0.0, load.gravity)
        found = solve(beam, at, wrench, list(self.stations), weight)
        reactions = np.zeros((len(self.stations), 2))
        for i in held:
            reactions[i] = -found.reaction(str(i))[[2, 4]]
        return Supported(found.displacements[:, [2, 4]], reactions)

    def beam(self, load: Load, at: ArrayLike | None = None, kGA: float | None = None) -> Supported:
        """By Macaulay's brackets, with shear.

        Parameters
        ----------
        load : Load
            What it carries.
        at : array_like, optional
            Where motions are read [m]; at the stations where left out.
        kGA : float, optional
            Shear rigidity [N]; with Cowper's coefficient where left out.
        """
        held = list(zip(self.stations, self.supports, strict=True))
        springs = [Spring(x, k, m) for x, (k, m) in held]
        acts = [(self.stations[load.station], load.force, -load.moment)]
        weight = self.tube.material.density * self.tube.area * load.gravity
        where = self.stations if at is None else at
        shear = self.tube.kGA if kGA is None else kGA
        found = macaulay(self.tube.length, self.tube.EI, shear, springs, acts, where, weight)
        # the slope is minus the rotation about y
        motions = np.column_stack([found.deflection, -found.slope])
        return Supported(motions, np.column_stack([found.forces, -found.moments]))

    def evenly(self, load: Load) -> Supported:
        """The same beam whose loads and supports act evenly over its sections, as the solid's."""
        return self.beam(load, kGA=evenly_loaded_shear(self.tube))

    def softer(self, load: Load) -> Supported:
        """`evenly`, with supports softer by what evenly spread loads shear and bend locally.

        See `solid_shafts.LOCAL`; a bound to tell beam and solid apart by, not a correction.
        """
        local = solid_shafts.local_compliance(self.tube), solid_shafts.local_rotation(self.tube)
        supports = tuple((_softer(k, local[0]), _softer(m, local[1])) for k, m in self.supports)
        return replace(self, supports=supports).evenly(load)

    def compliance(self, refinement: int, size: float | None = None) -> tuple[int, Compliance]:
        """Elements round a turn of a mesh of the free shaft, and how its sections move.

        Parameters
        ----------
        refinement : int
            Refinement of the family of meshes, see `solid_shafts.solid`.
        size : float, optional
            Longest element of the first of them [m].
        """
        shaft = solid_shafts.straight(self.stations, self.tube.outer, self.tube.inner)
        mesh = solid_shafts.solid(shaft, refinement, size=size)
        found = solid_shafts.sectional_compliance(mesh, self.tube.material, self.stations)
        return mesh.per_turn, found

    def solid(self, compliance: Compliance, load: Load) -> Supported:
        """By solid elements of that compliance."""
        acts = np.zeros((len(self.stations), 2))
        acts[load.station] = load.force, load.moment
        return solid_shafts.on_springs(compliance, self.supports, acts, load.gravity)


def sag_over_beam(tube: Tube) -> tuple[float, float]:
    """Sag of an overhung solid under its weight, over Timoshenko's beam with Cowper's coefficient.

    Returns
    -------
    solid, evenly : float, float
        Values of a mesh of hexahedra, and of the beam with the coefficient of an evenly held root.
        With the mesh's own mass and I, so that what is left is not the section's error.
    """
    shaft = solid_shafts.straight((0.0, tube.length), tube.outer, tube.inner)
    mesh = solid_shafts.solid(shaft, 2, size=tube.outer)
    C = solid_shafts.sectional_compliance(mesh, tube.material, (0.0, tube.length))
    load = float(C.weight_resultant[0]) / tube.length
    EI = tube.material.youngs_modulus * solid_shafts.meshed_moment(mesh) / tube.length / 2
    cowper = sag(load, EI, tube.kGA, tube.length)
    even = sag(load, EI, evenly_loaded_shear(tube), tube.length)
    return float(C.weight[1, 0]) / cowper, even / cowper


def within_evenly(per_turn: int) -> tuple[float, str]:
    """How much parabolic arcs round a turn may miss of a solid's deflection, relative; and why.

    The reason names what evenly spread loads do locally, too; how much that is depends on the
    forces.
    """
    why = f"{per_turn} parabolic arcs round a turn; and loads that enter evenly over a section, "
    why += f"{solid_shafts.LOCAL:.0%} of what one diameter shears"
    return 2 * 4 * parabola_shortfall(per_turn), why


def _softer(stiffness: float, compliance: float) -> float:
    return 1.0 / (1.0 / stiffness + compliance) if stiffness > 0 else stiffness
