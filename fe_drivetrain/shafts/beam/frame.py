"""Frames in space: straight Timoshenko beams between rigid bodies, condensed to reference points.

A node is a rigid body with six degrees of freedom at its position. A beam may end off its nodes'
positions: so a cheek that many beams stand on is one node, and a beam's end moves with it as a
rigid body does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.scaling import diagonal_roots, scaled_to_unit_diagonal
from fe_drivetrain.common.spatial import point_motions, rigid_motions, wrench_transport
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.elasticity.solve.condensation import Condensed, condense
from fe_drivetrain.shafts.beam.sections import (
    cowper_shear_coefficient,
    flexibility,
    gauss_points,
    stiffness_of_ends,
)


@dataclass(frozen=True)
class CrossSection:
    """Properties of a beam's section, in its principal axes.

    Attributes
    ----------
    area : float
        Area [m^2].
    shear_areas : tuple[float, float]
        Effective in forces along the section's first and second axis [m^2].
    torsion : float
        Torsion constant [m^4].
    inertias : tuple[float, float]
        Second moments about the first and about the second axis [m^4].
    """

    area: float
    shear_areas: tuple[float, float]
    torsion: float
    inertias: tuple[float, float]


def round_section(outer: float, poisson_ratio: float, inner: float = 0.0) -> CrossSection:
    """Section of a solid or hollow round bar.

    Parameters
    ----------
    outer, inner : float
        Diameters [m].
    poisson_ratio : float
        Poisson ratio, for Cowper's shear coefficient (Cowper 1966).
    """
    area = np.pi / 4 * (outer**2 - inner**2)
    inertia = np.pi / 64 * (outer**4 - inner**4)
    shear = area * float(cowper_shear_coefficient(poisson_ratio, inner / outer))
    return CrossSection(area, (shear, shear), 2 * inertia, (inertia, inertia))


def rectangle(first: float, second: float, poisson_ratio: float) -> CrossSection:
    """Section of a rectangular bar, its sides along the first and the second axis [m].

    Shear coefficient 10 (1 + nu) / (12 + 11 nu) (Cowper 1966); torsion constant by Saint-Venant's
    series (Timoshenko and Goodier 1970, art. 109).
    """
    k = 10 * (1 + poisson_ratio) / (12 + 11 * poisson_ratio)
    area = first * second
    short, long = sorted((first, second))
    odd = np.arange(1, 200, 2)
    series = (np.tanh(odd * np.pi * long / (2 * short)) / odd**5).sum()
    torsion = short**3 * long / 3 * (1 - 192 / np.pi**5 * short / long * float(series))
    inertias = first * second**3 / 12, second * first**3 / 12
    return CrossSection(area, (k * area, k * area), torsion, inertias)


def annular_sector(inner: float, outer: float, angle: float, poisson_ratio: float) -> CrossSection:
    """Section that is a sector of an annulus; the first axis is radial in its middle.

    Shear areas and torsion constant are those of the rectangle that is as high, and as wide along
    the mean circle: for angles of up to a right one, some per cent.

    Parameters
    ----------
    inner, outer : float
        Radii [m].
    angle : float
        Angle of the sector [rad].
    """
    area = angle / 2 * (outer**2 - inner**2)
    square = (outer**4 - inner**4) / 8
    centroid = sector_centroid(inner, outer, angle)
    across = square * (angle - np.sin(angle))
    along = square * (angle + np.sin(angle)) - area * centroid**2
    like = rectangle(outer - inner, angle * (outer + inner) / 2, poisson_ratio)
    return CrossSection(area, like.shear_areas, like.torsion, (across, along))


def sector_centroid(inner: float, outer: float, angle: float) -> float:
    """Radius of the centroid of an annular sector [m]; radii [m], angle [rad]."""
    moment = 2 / 3 * (outer**3 - inner**3) * np.sin(angle / 2)
    return float(moment / (angle / 2 * (outer**2 - inner**2)))


def beam_stiffness(section: CrossSection, length: float, material: Material) -> Floats:
    """(12, 12) of a uniform Timoshenko beam along its own x, ends at 0 and ``length``.

    The first axis of the section is its y, the second its z (Przemieniecki 1968, Theory of Matrix
    Structural Analysis, section 5.6).
    """
    E, G = material.youngs_modulus, material.shear_modulus
    rigidities = np.array(
        [
            E * section.area,
            *(G * area for area in section.shear_areas),
            G * section.torsion,
            *(E * inertia for inertia in section.inertias),
        ]
    )
    # two points are exact: flexibilities are quadratic along a uniform beam
    s, weight = gauss_points(0.0, length, 2)
    compliance = weight[:, None] / rigidities
    return stiffness_of_ends(flexibility(compliance, length - s), length)


@dataclass(frozen=True)
class Member:
    """A beam between two nodes.

    Attributes
    ----------
    nodes : tuple[int, int]
        Numbers of the nodes.
    ends : tuple[Floats, Floats]
        Positions (3,) of both ends of the beam [m].
    section : CrossSection
        Cross-section of the beam.
    first_axis : Floats
        Direction (3,) of the section's first axis, made square to the beam.
    """

    nodes: tuple[int, int]
    ends: tuple[Floats, Floats]
    section: CrossSection
    first_axis: Floats


@dataclass(frozen=True)
class Follower:
    """A reference point that moves as the mean of places on nodes does (RBE3).

    Attributes
    ----------
    name, position : str, Floats
        Name and position (3,) of the point [m].
    nodes : Sequence[int]
        Nodes (k,) that the places belong to.
    places : Floats
        Positions (k, 3) of the places [m].
    weights : Floats
        Weights (k,) of the places.
    """

    name: str
    position: Floats
    nodes: Sequence[int]
    places: Floats
    weights: Floats


@dataclass(frozen=True)
class SpatialFrame:
    """Members between nodes.

    Attributes
    ----------
    positions : Floats
        Positions (n, 3) of the nodes [m].
    members : Sequence[Member]
        The beams.
    material : Material
        Material of all members.
    inertias : dict[int, Floats]
        Mass matrix (6, 6) about the node, of nodes that are bodies of their own [kg, kg m, kg m^2].
    """

    positions: Floats
    members: Sequence[Member]
    material: Material
    inertias: dict[int, Floats] = field(default_factory=dict)

    @property
    def stiffness(self) -> Floats:
        """(6 n, 6 n), free."""
        K = np.zeros((6 * len(self.positions),) * 2)
        for member in self.members:
            start, end = member.ends
            length = float(np.linalg.norm(end - start))
            along = (end - start) / length
            first = member.first_axis - along * (along @ member.first_axis)
            first /= np.linalg.norm(first)
            turn = np.vstack([along, first, np.cross(along, first)])
            own = np.kron(np.eye(4), turn)
            local = own.T @ beam_stiffness(member.section, length, self.material) @ own
            carry = np.zeros((12, 12))
            for k, (node, at) in enumerate(zip(member.nodes, member.ends, strict=True)):
                part = slice(6 * k, 6 * k + 6)
                carry[part, part] = wrench_transport(at - self.positions[node]).T
            rows = np.concatenate([6 * node + np.arange(6) for node in member.nodes])
            K[np.ix_(rows, rows)] += carry.T @ local @ carry
        return K

    @property
    def mass(self) -> Floats:
        """(6 n, 6 n): half of each beam at either end, and the nodes' own."""
        M = np.zeros((6 * len(self.positions),) * 2)
        for member in self.members:
            length = float(np.linalg.norm(member.ends[1] - member.ends[0]))
            half = self.material.density * member.section.area * length / 2
            for node, at in zip(member.nodes, member.ends, strict=True):
                carry = wrench_transport(at - self.positions[node])
                rows = slice(6 * node, 6 * node + 6)
                M[rows, rows] += carry @ np.diag([half, half, half, 0.0, 0.0, 0.0]) @ carry.T
        for node, inertia in self.inertias.items():
            rows = slice(6 * node, 6 * node + 6)
            M[rows, rows] += inertia
        return M

    def condensed(self, followers: Sequence[Follower]) -> Condensed:
        """The free frame at reference points; of its mass, what gravity does to them.

        Raises
        ------
        InputError
            There is one point only, or two move as one.
        """
        K, n = self.stiffness, len(self.positions)
        size = diagonal_roots(K.diagonal())
        scaled = scaled_to_unit_diagonal(K)
        # loads are in balance: what is held only takes the rigid motions out
        left = np.arange(6, 6 * n)
        factor = np.linalg.inv(scaled[np.ix_(left, left)])

        def solved(F: Floats) -> Floats:
            u = np.zeros_like(F)
            u[left] = factor @ (F[left] / size[left, None]) / size[left, None]
            return u

        loads = np.hstack([self._spread(f) for f in followers])
        positions = np.array([f.position for f in followers])
        rigid = point_motions(self.positions, positions[0])
        mass = sparse.csr_array(self.mass)
        names = [f.name for f in followers]
        found = condense(names, positions, loads, mass, rigid, solved)
        return Condensed(found.names, found.positions, found.stiffness, found.gravity)

    def _spread(self, follower: Follower) -> Floats:
        """(6 n, 6) forces on the nodes of unit forces and moments at a reference point."""
        share = np.repeat(follower.weights / np.sum(follower.weights), 3)
        motions = rigid_motions(follower.places, follower.position)
        weighted = share[:, None] * motions
        fit = np.linalg.solve(motions.T @ weighted, weighted.T)
        loads = np.zeros((6 * len(self.positions), 6))
        for k, (node, place) in enumerate(zip(follower.nodes, follower.places, strict=True)):
            carry = wrench_transport(place - self.positions[node])[:, :3]
            loads[6 * node : 6 * node + 6] += carry @ fit[:, 3 * k : 3 * k + 3].T
        return loads


def on_node(name: str, node: int, position: Floats) -> Follower:
    """A reference point that moves with one node, which is a rigid body."""
    places = position + np.vstack([np.eye(3), -np.eye(3)])
    return Follower(name, np.asarray(position), [node] * 6, places, np.ones(6))
