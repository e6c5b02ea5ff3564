"""Solid shafts for finite elements: meshes refined similarly, loads on ends, motions of sections.

A section's motion is its mean displacement and its least-squares rotation (an averaged reference
point). These means are Cowper's (1966), so Timoshenko's beam with his coefficient speaks of the
same deflection and rotation as the solid does. Loads that enter through such a point are uniform
shear and linear normal stress, no longer Saint-Venant's: see `shaft_theory.evenly_loaded_shear`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike
from scipy import sparse

from fe_drivetrain.cases.references.shaft_theory import Tube
from fe_drivetrain.common import Floats, InputError, Ints
from fe_drivetrain.comparison import band_of
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import averaged_point
from fe_drivetrain.elasticity.mesh import (
    UNGRADED,
    Grading,
    element_kind,
    face_weights,
    jacobian,
    local_facets,
    shaft_hexahedra,
)
from fe_drivetrain.elasticity.operator import body_loads
from fe_drivetrain.elasticity.solve import Static, solve_solid
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Section, Shaft

SLICE = 3.0
"""Length along x of the elements of the coarsest mesh, per radius."""
BASE_TURN = 4
"""Elements round the axis of the coarsest mesh; the r-th mesh has r times as many, each way."""

VERTICAL = (2, 4)
"""Components of bending in the plane of x and z: u_z and the rotation about y."""


@dataclass(frozen=True)
class Solid:
    """Hexahedra of 27 nodes of a shaft.

    Attributes
    ----------
    points, cells : Floats, Ints
        (n, 3) [m] and (n_cells, 27).
    facets : Ints
        (n_facets, 9) of all cells, turned outward from their cells.
    front, rear : float
        x of the end faces [m].
    per_turn : int
        Elements round the axis.
    """

    points: Floats
    cells: Ints
    facets: Ints
    front: float
    rear: float
    per_turn: int

    @property
    def n_unknowns(self) -> int:
        """Displacements."""
        return int(self.points.size)

    def section_nodes(self, x: float) -> Ints:
        """Nodes of the section at x, a plane of nodes."""
        return np.flatnonzero(np.abs(self.points[:, 0] - x) < LENGTH_TOLERANCE)

    def section_facets(self, x: float) -> Ints:
        """(n, 9) facets of the section at x, each once.

        Raises
        ------
        InputError
            No elements meet in that plane.
        """
        there = (np.abs(self.points[self.facets, 0] - x) < LENGTH_TOLERANCE).all(axis=1)
        facets = self.facets[there]
        if not len(facets):
            raise InputError(f"no elements meet at x = {x:g} m: give a station of the mesh")
        first = np.unique(np.sort(facets, axis=1), axis=0, return_index=True)[1]
        return np.asarray(facets[first])


def straight(stations: Sequence[float], outer: float, inner: float = 0.0) -> Shaft:
    """A uniform shaft with planes of nodes at the stations [m]; diameters [m]."""
    return Shaft(
        front=stations[0],
        sections=tuple(
            Section(length=b - a, outer_diameter=outer, inner_diameter=inner)
            for a, b in pairwise(stations)
        ),
    )


def stepped(outer: Sequence[float], length: float, bore: float = 0.0) -> Shaft:
    """Parts of one length with sharp steps between them; diameters and length in m."""
    sections = [Section(length=length, outer_diameter=d, inner_diameter=bore) for d in outer]
    return Shaft(front=0.0, sections=tuple(sections))


def cone(radii: tuple[float, float], half_angle: float) -> Shaft:
    """A solid cone between flat ends, its apex at the origin; radii in m, angle in degrees."""
    start, end = (r / np.tan(np.radians(half_angle)) for r in radii)
    thin, thick = (2 * r for r in radii)
    length = float(end - start)
    section = Section(length=length, outer_diameter=thin, outer_diameter_end=thick)
    return Shaft(front=float(start), sections=(section,))


def solid(
    shaft: Shaft,
    refinement: int,
    grading: Grading = UNGRADED,
    base_turn: int = BASE_TURN,
    size: float | None = None,
) -> Solid:
    """The r-th of a family of meshes, each element of the first cut into r x r x r.

    Parameters
    ----------
    shaft, grading : Shaft, Grading
        The same as for `hexahedra.shaft_hexahedra`.
    refinement : int
        r.
    base_turn : int
        Elements round the axis of the first.
    size : float or None
        Largest length of its elements [m]; `SLICE` radii where not given.
    """
    radius = max(piece.outer_diameter for piece in shaft.pieces) / 2
    mesh = shaft_hexahedra(
        shaft,
        SLICE * radius if size is None else size,
        27,
        elements_per_turn=base_turn,
        refinement=refinement,
        grading=grading,
    )
    facets = mesh.cells[:, local_facets(27)].reshape(-1, 9)
    turn = base_turn * refinement
    return Solid(mesh.points, mesh.cells, facets, shaft.front, shaft.rear, turn)


def mesh_band(refinements: Sequence[int], values: ArrayLike, order: float = 4.0) -> float:
    """Half width of the numerical band of the finest value.

    Parameters
    ----------
    refinements, values : Sequence[int], ArrayLike
        Two meshes or more of the family, coarse first; see `fe_drivetrain.comparison.band_of`.
    order : float
        Order of the theory: fourth for energies of smooth solutions, and of parabolas for circles.
    """
    return band_of(1.0 / np.asarray(refinements, dtype=float), values, order)


def meshed_moment(mesh: Solid) -> float:
    """Integral of y^2 + z^2 over the mesh [m^5], with the quadrature of its stiffness."""
    kind = element_kind(27)
    gradients, weights = kind.table(kind.degree)
    from skfem.quadrature import get_quadrature

    X, _ = get_quadrature(kind.element.refdom, kind.degree)
    values, _ = kind.shape(X)
    determinant = jacobian(mesh.points, mesh.cells, gradients)[1]
    at = np.einsum("qn,eni->eqi", values, mesh.points[mesh.cells])
    return float((determinant * weights * (at[..., 1] ** 2 + at[..., 2] ** 2)).sum())


def rotation_of(points: Floats, angle: float | Floats) -> Floats:
    """Displacements (n, 3) of a small rotation about x, angle in rad."""
    turned = np.zeros_like(points)
    turned[:, 1], turned[:, 2] = -angle * points[:, 2], angle * points[:, 1]
    return turned


def resultant(points: Floats, forces: Floats, about: float = 0.0) -> Floats:
    """(6,) force and moment about (x, 0, 0) of nodal forces (3 n,)."""
    f = forces[: points.size].reshape(-1, 3)
    arm = points - np.array([about, 0.0, 0.0])
    return np.concatenate([f.sum(axis=0), np.cross(arm, f).sum(axis=0)])


def prescribed_on(mesh: Solid, nodes: Ints, field: Floats) -> tuple[Ints, Floats]:
    """Degrees of freedom of the nodes, and their values in a field (n, 3) of all nodes."""
    return (3 * nodes[:, None] + np.arange(3)).ravel(), field[nodes].ravel()


def pinned_like(mesh: Solid, field: Floats) -> tuple[Ints, Floats]:
    """Six degrees of freedom of three nodes of the front face, held where a field (n, 3) has them.

    They hold the solid statically, so they carry nothing where the loads are in equilibrium.
    """
    nodes = mesh.section_nodes(mesh.front)
    y, z = mesh.points[nodes, 1], mesh.points[nodes, 2]
    right, left, top = nodes[y.argmax()], nodes[y.argmin()], nodes[z.argmax()]
    held = [(right, 0), (right, 1), (right, 2), (left, 0), (left, 2), (top, 0)]
    columns = np.array([3 * node + axis for node, axis in held])
    return columns, field.ravel()[columns]


@dataclass(frozen=True)
class Compliance:
    """How sections of a shaft move, its first section held by its mean motion.

    Attributes
    ----------
    stations : Floats
        (n,) [m].
    components : tuple[int, ...]
        Components of force and motion, 0-5.
    matrix : Floats
        (n, c, n, c) motion of a section for a unit load on one [m, rad per N, N m].
    weight : Floats
        (n, c) motions under gravity of 1 m/s^2 along z.
    weight_resultant : Floats
        (c,) force and moment of that weight about the first station [N, N m].
    unknowns, seconds : int, float
        Number of unknowns and duration of the solution.
    """

    stations: Floats
    components: tuple[int, ...]
    matrix: Floats
    weight: Floats
    weight_resultant: Floats
    unknowns: int
    seconds: float


def sectional_compliance(
    mesh: Solid,
    material: Material,
    stations: Sequence[float],
    components: tuple[int, ...] = VERTICAL,
) -> Compliance:
    """Motions of sections for unit loads on sections and for the weight, from one solution.

    Every load is balanced by its reaction on the first section, so that three nodes can hold the
    solid without carrying anything; the rigid motion that is left is then taken off.

    Parameters
    ----------
    mesh, material : Solid, Material
        The shaft.
    stations : Sequence[float]
        Planes of nodes [m], the front face first.
    components : tuple[int, ...]
        Components of the loads and motions: 0-2 along, 3-5 about x, y and z.
    """
    n, chosen = mesh.n_unknowns, list(components)
    points = [
        averaged_point(
            f"section {x:g}",
            *_weighted(mesh, x),
            mesh.points,
            np.array([x, 0.0, 0.0]),
            n,
        ).motion
        for x in stations
    ]
    carry = np.array([_carried(x - stations[0]) for x in stations])
    spread = [sparse.csr_array(p.T).toarray()[:, chosen] for p in points]
    loads = [s - points[0].T @ c[:, chosen] for s, c in zip(spread, carry, strict=True)]
    gravity = np.zeros(3)
    gravity[2] = material.density
    own = body_loads(mesh.points, mesh.cells, gravity)
    whole = resultant(mesh.points, own, stations[0])
    F = np.column_stack([*loads, own - points[0].T @ whole])
    found = solve_solid(
        mesh.points, mesh.cells, material.lame, [], F, pinned_like(mesh, np.zeros((n // 3, 3)))
    )
    motion = np.array([p @ found.u for p in points])
    # the rigid motion that brings the first section back
    motion = motion - np.einsum("sij,jl->sil", np.swapaxes(carry, 1, 2), motion[0])
    motion = motion[:, chosen]
    count = len(stations)
    return Compliance(
        np.asarray(stations, dtype=float),
        components,
        motion[:, :, :-1].reshape(count, len(chosen), count, len(chosen)),
        motion[:, :, -1],
        whole[chosen],
        n,
        found.diagnostics.seconds,
    )


def _weighted(mesh: Solid, x: float) -> tuple[Ints, Floats]:
    weights = face_weights(mesh.points, mesh.section_facets(x), len(mesh.points))
    nodes = np.flatnonzero(weights != 0.0)
    return nodes, weights[nodes]


def _carried(distance: float) -> Floats:
    """(6, 6): a force and moment at a distance along x as their equal at the origin."""
    matrix = np.eye(6)
    matrix[4, 2], matrix[5, 1] = -distance, distance
    return matrix


@dataclass(frozen=True)
class Supported:
    """A shaft on springs: motions (n, 2) and reactions (n, 2) of the vertical plane.

    Motions are u_z [m] and the rotation about y [rad]; reactions are what the springs put on the
    shaft [N, N m].
    """

    motions: Floats
    reactions: Floats


def on_springs(
    compliance: Compliance, stiffness: ArrayLike, loads: ArrayLike, gravity: float = 0.0
) -> Supported:
    """Put a solid shaft on springs at its stations, by its compliance (the force method).

    Parameters
    ----------
    compliance : Compliance
        In the vertical plane.
    stiffness : ArrayLike
        (n, 2) [N/m, N m/rad], inf is rigid, 0 is free.
    loads : ArrayLike
        (n, 2) forces along z and moments about y [N, N m].
    gravity : float
        Along z [m/s^2].
    """
    k, load = np.asarray(stiffness, dtype=float).ravel(), np.asarray(loads, dtype=float).ravel()
    n = len(k)
    C = compliance.matrix.reshape(n, n)
    x = compliance.stations - compliance.stations[0]
    rigid = np.zeros((n, 2))
    rigid[0::2, 0], rigid[0::2, 1], rigid[1::2, 1] = 1.0, -x, 1.0
    held = np.flatnonzero(k > 0)
    soft = np.array([0.0 if np.isinf(k[i]) else 1.0 / k[i] for i in held])
    own = gravity * compliance.weight.ravel()
    # forces in units of one over the compliance's size, so that the equations are of one size
    scale = 1.0 / np.abs(C).max()
    matrix = np.zeros((len(held) + 2, len(held) + 2))
    matrix[: len(held), : len(held)] = scale * (C[np.ix_(held, held)] + np.diag(soft))
    matrix[: len(held), len(held) :] = rigid[held]
    matrix[len(held) :, : len(held)] = rigid[held].T
    right = np.concatenate(
        [
            -(C @ load + own)[held],
            -(rigid.T @ load + gravity * compliance.weight_resultant) / scale,
        ]
    )
    found = np.linalg.solve(matrix, right)
    reaction = np.zeros(n)
    reaction[held] = scale * found[: len(held)]
    motion = C @ (load + reaction) + own + rigid @ found[len(held) :]
    return Supported(motion.reshape(-1, 2), reaction.reshape(-1, 2))


def axial_torque(mesh: Solid, found: Static) -> float:
    """Torque [N m] that a prescribed rear face takes."""
    nodes = mesh.section_nodes(mesh.rear)
    forces = np.zeros_like(mesh.points)
    forces[nodes] = found.reactions["prescribed"][:, 0].reshape(-1, 3)[nodes]
    return float(resultant(mesh.points, forces.ravel())[3])


def twist(mesh: Solid, material: Material, angle: float = 1e-3) -> tuple[Static, float, float]:
    """Turn the rear face by an angle [rad], the front face held, both as rigid planes.

    Returns
    -------
    found, by_torque, by_energy
        The solution, and the stiffness [N m/rad] as torque over angle and as 2 U over its square.
    """
    field = np.zeros_like(mesh.points)
    rear = mesh.section_nodes(mesh.rear)
    field[rear] = rotation_of(mesh.points[rear], angle)
    ends = np.concatenate([mesh.section_nodes(mesh.front), rear])
    found = solve_solid(
        mesh.points,
        mesh.cells,
        material.lame,
        [],
        np.zeros(mesh.n_unknowns),
        prescribed_on(mesh, ends, field),
    )
    torque = axial_torque(mesh, found)
    return found, torque / angle, 2 * float(found.energy[0]) / angle**2


#: What a load that enters evenly over a section of a solid shaft adds to its deflection, as a share
#: of what one diameter of the shaft shears under it; and a moment to its rotation, of what one
#: diameter bends. Uniform shear is not Saint-Venant's; the difference has no resultant and dies out
#: within a fraction of a diameter, so that the share is a few per cent. Bored shafts yield more.
LOCAL = 0.05


def local_compliance(tube: Tube) -> float:
    """That deflection [m/N]: a bound to tell beam and solid apart by, not a correction."""
    return LOCAL * tube.outer / tube.kGA


def local_rotation(tube: Tube) -> float:
    """The same of a moment's rotation [rad/(N m)], of what one diameter bends."""
    return LOCAL * tube.outer / tube.EI
