"""Round bars held behind the section that theory calls the wall, and what their sections do.

A clamped end disturbs the stress for about a diameter, and its rim is singular; theory knows
nothing of that. So the bar goes on behind its root, and is clamped there: at the root the stresses
are then those that follow from force and moment alone (Saint-Venant), and displacements are taken
against the root's own motion.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.cases.references.loaded_blocks import Traction
from fe_drivetrain.cases.references.ring_solids import facets_where
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import averaged_point, fixed
from fe_drivetrain.elasticity.mesh import element_kind, shaft_hexahedra
from fe_drivetrain.elasticity.operator import stresses, traction_loads
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.geometry import Section, Shaft

BEHIND = 2.0
"""Diameters between root and clamp: self-equilibrated stress of a round bar decays at least as
exp(-2.7 x / r), here to 2e-5."""

ROUNDED_LATERAL = (
    "curved elements hold axial strain and shear exactly, but miss (2 pi / n)^2 / 12 of the "
    "lateral one, 0.8 % with n = 20 elements round and 2.3 % with 12; 2 nu^2 / ((1 + nu)(1 - 2 "
    "nu)) = 0.35 of that reaches the stress. Rounded up to 1 and 1.5 %"
)
"""Why `section_stresses` of a bent steel bar have an error of 1 or 1.5 %, for a check's page."""


@dataclass(frozen=True)
class Bar:
    """A straight solid bar along x with its root at x = 0.

    Attributes
    ----------
    points, cells : Floats, Ints
        Hexahedra of 27 nodes.
    clamp, root, end : Ints
        Nodes of the three sections.
    """

    points: Floats
    cells: Ints
    clamp: Ints
    root: Ints
    end: Ints


def round_bar(diameter: float, length: float, around: int, far: int) -> Bar:
    """Mesh a bar: even elements about the root, longer ones beyond two diameters.

    Parameters
    ----------
    diameter, length : float
        [m]; the length from the root.
    around : int
        Elements round the bar, a multiple of 4; with 16, one is a diameter long about the root.
    far : int
        Diameters that the rest counts as in the number of its elements.
    """
    near = BEHIND * diameter
    sections = tuple(
        Section(length=x, outer_diameter=diameter) for x in (near, near, far * diameter)
    )
    mesh = shaft_hexahedra(
        Shaft(front=-near, sections=sections),
        16.0 / around * diameter,
        elements_per_turn=around,
    )
    points = mesh.points.copy()
    x = points[:, 0]
    beyond = x > near
    points[beyond, 0] = near + (x[beyond] - near) * (length - near) / (far * diameter)
    root = np.flatnonzero(np.abs(points[:, 0]) < 1e-9 * length)
    return Bar(points, mesh.cells, mesh.front, root, mesh.rear)


@dataclass(frozen=True)
class LoadedBar:
    """A bar under a load on its end.

    Attributes
    ----------
    bar : Bar
        The mesh.
    material : Material
        Material of all of it.
    u : Floats
        (3 n,) displacements [m].
    """

    bar: Bar
    material: Material
    u: Floats

    def end_motion(self, *tip: float) -> Floats:
        """Mean motion of the end against that of the root, both at the tip's x, y and z [m].

        Returns
        -------
        motion : Floats
            (6,) displacement [m] and rotation [rad].
        """
        bar = self.bar
        end, root = (
            section_motion(bar.points, bar.cells, section, self.u, tip)
            for section in (bar.end, bar.root)
        )
        return end - root

    def stresses_at(self, nodes: Ints) -> Floats:
        """Stresses (m, 6) [Pa] at nodes of a section, from the elements' own shape functions."""
        bar = self.bar
        return section_stresses(bar.points, bar.cells, nodes, self.u, self.material.lame)


def solve_bar(bar: Bar, material: Material, traction: Traction) -> LoadedBar:
    """Solve a bar that is clamped behind its root, under a traction on its end [Pa]."""
    points = bar.points
    F = traction_loads(points, facets_where(bar.cells, bar.end), traction)
    clamp = fixed("clamp", bar.clamp, points.size)
    return LoadedBar(
        bar, material, solve_solid(points, bar.cells, material.lame, [clamp], F).u[:, 0]
    )


def section_motion(points: Floats, cells: Ints, section: Ints, u: Floats, at: ArrayLike) -> Floats:
    """Mean motion of a section.

    Parameters
    ----------
    points, cells : Floats, Ints
        The mesh.
    section : Ints
        Nodes of the section.
    u : Floats
        (3 n,) displacements [m].
    at : ArrayLike
        (3,) where the displacement is taken, as if it moved with the section [m].

    Returns
    -------
    (6,) displacement [m] and rotation [rad].
    """
    facets = facets_where(cells, section)
    weights = traction_loads(points, facets, np.array([1.0, 0.0, 0.0]))[3 * section]
    where = np.asarray(at, dtype=float)
    point = averaged_point("section", section, weights, points, where, points.size)
    return np.asarray(point.motion @ u[: points.size])


def section_stresses(
    points: Floats, cells: Ints, section: Ints, u: Floats, lame: tuple[float, float]
) -> Floats:
    """Stresses at the nodes of a section, straight from the elements' own shape functions.

    What is recovered from Gauss points is linear in an element, and misses (2 pi / n)^2 / 12 of a
    stress that varies as the cosine of the angle, with n elements round: 1.3 % of 16. The axial
    strains of bending and the shear of torsion are x times the coordinates of the section, which
    curved elements hold exactly; so here nothing is interpolated, and elements are only averaged.

    Returns
    -------
    (n_section, 6) [Pa].
    """
    near = cells[np.isin(cells, section).any(axis=1)]
    kind = element_kind(cells.shape[1])
    s = stresses(points, near, u, lame, kind.places.T)
    total, count = np.zeros((len(points), 6)), np.zeros(len(points))
    np.add.at(total, near, s)
    np.add.at(count, near, 1.0)
    return np.asarray(total[section] / count[section][:, None])
