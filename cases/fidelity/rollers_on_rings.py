"""Rollers on the raceway of a ring: by harmonics, as a solid, on feet, in a rigid housing."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from fe_drivetrain.cases.references.ring_solids import on_plane, ring_sector, sector_symmetry
from fe_drivetrain.common import Floats
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.operator import traction_loads
from fe_drivetrain.elasticity.revolution import (
    InfluenceFunctions,
    Meridian,
    Strip,
    carried,
    dofs,
    influence_functions,
    meridian,
    roller_forces,
)
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.geometry import Section, Shaft

SIZE, THICK_SIZE = 0.02, 0.03
"""Of the meridian's elements [m]; of rings of more than half a metre's radius."""


def ring_meridian(
    inner: float, outer: float, width: float, size: float, order: int = 6
) -> Meridian:
    """Meridian of a ring of rectangular section; all in m."""
    section = Section(length=width, outer_diameter=2 * outer, inner_diameter=2 * inner)
    return meridian(Shaft(front=0.0, sections=(section,)), size, order=order, layers=0)


def squeezed(found: InfluenceFunctions) -> tuple[float, float]:
    """Radial displacement under two opposite pushes of 1 N, and across them [m], by harmonics."""
    C = found.matrix(np.array([0.0, np.pi, np.pi / 2]))[::2, ::2]
    return C[0, 0] + C[0, 1], C[2, 0] + C[2, 1]


@dataclass(frozen=True)
class Pressed:
    """Forces of the rollers [N] under a load [N], and how far the shaft moves [m]."""

    forces: Floats
    down: float
    load: float

    @property
    def factor(self) -> float:
        """The most loaded roller's force over the mean of the load over all."""
        return float(len(self.forces) * self.forces.max() / self.load)


@dataclass(frozen=True)
class RollerRing:
    """A ring whose raceway is its bore, and rollers at equal angles in it.

    Attributes
    ----------
    raceway, outside, width : float
        Radii of the ring, and its width [m].
    roller : float
        Length of the rollers, in the middle of the width [m].
    rollers : int
        How many there are, the first in the direction of the load.
    material : Material
        Of the ring.
    """

    raceway: float
    outside: float
    width: float
    roller: float
    rollers: int
    material: Material

    @property
    def angles(self) -> Floats:
        """(rollers,) from the load [rad]."""
        return 2 * np.pi / self.rollers * np.arange(self.rollers, dtype=np.float64)

    @property
    def half(self) -> float:
        """Half of a patch's angle: it is as wide as half of the distance between rollers [rad]."""
        return 2 * np.pi / self.rollers / 4

    def strips(self) -> list[Strip]:
        """Raceway and outside, as long as a roller."""
        margin = (self.width - self.roller) / 2
        return [Strip(r, margin, self.width - margin) for r in (self.raceway, self.outside)]

    def functions(self, highest: int, anchor: int = 1, order: int = 6) -> InfluenceFunctions:
        """Influence functions of the free ring's raceway and outside, relative to one of them.

        Parameters
        ----------
        highest : int
            Harmonic.
        anchor : int
            0 for the raceway, 1 for the outside.
        order : int
            Of the elements.
        """
        both, size = self.strips(), SIZE if self.outside < 0.5 else THICK_SIZE
        mesh = ring_meridian(self.raceway, self.outside, self.width, size, order)
        return influence_functions(
            mesh, self.material, both, highest, self.half, anchor=both[anchor]
        )

    def on_feet(self, found: InfluenceFunctions, feet: float) -> Floats:
        """(rollers, rollers) compliance on two feet at plus and minus an angle, held nowhere else.

        Neither its raceway nor anything else but the feet is fixed.

        Parameters
        ----------
        found : InfluenceFunctions
            Of the free ring.
        feet : float
            From the direction of the load [rad].
        """
        n = self.rollers
        everywhere = np.concatenate([self.angles, [feet, -feet]])
        rigid = np.column_stack([np.cos(everywhere), np.sin(everywhere)])
        chosen = np.concatenate([2 * np.arange(n), 2 * np.arange(n, n + 2) + 1])
        matrix = found.matrix(everywhere)[np.ix_(chosen, chosen)]
        return carried(matrix, rigid, [n, n + 1])

    def in_rigid_housing(self, highest: int) -> Floats:
        """(rollers, rollers) compliance where the outside does not move."""
        mesh = ring_meridian(self.raceway, self.outside, self.width, SIZE)
        still = np.flatnonzero(np.abs(mesh.nodes[:, 1] - self.outside) < 1e-9)
        held = np.concatenate([dofs(still, c) for c in range(3)])
        raceway = self.strips()[:1]
        found = influence_functions(mesh, self.material, raceway, highest, self.half, held=held)
        return found.matrix(self.angles)

    def press(self, compliance: Floats, load: float, stiffness: float, exponent: float) -> Pressed:
        """Forces that carry a load [N], the shaft rigid, no clearance.

        Parameters
        ----------
        compliance : Floats
            (rollers, rollers) of the ring [m/N].
        load : float
            In the direction of the first roller [N].
        stiffness, exponent : float
            Of a roller and its two contacts [N/m^exponent].
        """
        towards = np.cos(self.angles)

        def forces(down: float) -> Floats:
            return roller_forces(compliance, down * towards, stiffness, exponent)

        largest = 20 * load * (1 / stiffness + np.abs(compliance).max())
        down = brentq(lambda d: forces(d) @ towards - load, 0.0, largest, xtol=1e-16)
        return Pressed(forces(down), down, load)

    def solid(self, level: int) -> tuple[float, float]:
        """Mean radial displacement under two opposite pushes of 1 N, and across them, of a solid.

        Parameters
        ----------
        level : int
            Elements of the coarsest mesh are divided into so many, each way.
        """
        quarter, share = 0.5 * np.pi, self.roller / self.width
        fine = np.arange(0, 3 * level + 1) * self.half / level
        last = quarter - fine[::-1]
        middle = np.linspace(fine[-1], last[0], 9 * level + 1)
        around = np.concatenate([fine, middle[1:-1], last]) / quarter
        pressed = np.linspace(0.0, share, 2 * level + 1)
        along = np.concatenate([pressed, np.linspace(share, 1.0, level + 1)[1:]])
        radii, divisions = (self.raceway, self.outside), (2 * level, 1, 1)
        edges = (None, around, along)
        block = ring_sector(*radii, self.width / 2, quarter, divisions, 27, edges)
        area = self.raceway * self.half * self.roller / 2

        def outwards(x: Floats, _: Floats) -> Floats:
            radial = np.column_stack([0 * x[:, 0], x[:, 1], x[:, 2]])
            return np.asarray(radial / (np.hypot(x[:, 1], x[:, 2])[:, None] * 4 * area))

        def push(at: float) -> Floats:
            centres = block.points[block.faces["x0"]].mean(axis=1)
            angle = np.arctan2(centres[:, 2], centres[:, 1])
            near = (np.abs(angle - at) < self.half) & (centres[:, 0] < self.roller / 2)
            return traction_loads(block.points, block.faces["x0"][near], outwards)

        held = [
            *sector_symmetry(block, quarter),
            on_plane("middle", block.face_nodes("z0"), (1.0, 0.0, 0.0), block.points.size),
        ]
        lame = self.material.lame
        u = solve_solid(block.points, block.cells, lame, held, push(0.0)).u[:, 0]
        return 4 * float(push(0.0) @ u), 4 * float(push(quarter) @ u)
