"""A ball joint whose answer is known: two concentric spherical shells with a joint between them.

The inner shell sits on a rigid core, the outer one in a rigid surrounding. Under a displacement of
the core, or under pressure, the displacements are u_r = f(r) cos(theta), u_theta = g(r) sin(theta),
or u_r = f(r), and Navier's equation leaves a few powers of r for f and g: a small linear system
gives the exact answer, whatever the joint between the shells.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
from scipy.spatial import cKDTree

from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.elasticity.interfaces import Constraint, constraints
from fe_drivetrain.elasticity.mesh import Block, brick, facet_points, joined
from fe_drivetrain.elasticity.operator import pressure as pressure_of
from fe_drivetrain.elasticity.operator import traction_loads
from fe_drivetrain.elasticity.solve import direct_solvers, solve_solid

Joint = Literal["sliding", "averaged", "rigid", "bonded"]
JOINTS: tuple[Joint, ...] = ("sliding", "averaged", "rigid", "bonded")

POWERS = np.array([0.0, 2.0, -1.0, -3.0])
"""Of r, in the solutions with one wave round the sphere."""

_CENTRE = np.zeros(3)


@dataclass(frozen=True)
class Shell:
    """A spherical shell of an isotropic material.

    Attributes
    ----------
    inner, outer : float
        Radii [m].
    lame : tuple[float, float]
        Lame's constants (lambda, mu) [Pa].
    """

    inner: float
    outer: float
    lame: tuple[float, float]


@dataclass(frozen=True)
class Wave:
    """u_r = f cos(theta), u_theta = g sin(theta), as sums of the four powers of r.

    Attributes
    ----------
    shell : Shell
        Where it holds.
    factors : Floats
        (4,) of the solutions of `amplitudes`, in the unit of the displacement.
    """

    shell: Shell
    factors: Floats

    def at(self, r: Floats) -> Floats:
        """(4, n): f, g [m], radial stress over cos(theta), shear stress over sin(theta) [Pa]."""
        return np.asarray(np.einsum("kpn,p->kn", amplitudes(self.shell, r), self.factors))

    def displacement(self, points: Floats) -> Floats:
        """(n, 3) displacements at points, theta being counted from the x axis [m]."""
        r = np.linalg.norm(points, axis=1)
        e_r = points / r[:, None]
        f, g = self.at(r)[:2]
        # e_theta sin(theta) = cos(theta) e_r - e_x
        cosine = e_r[:, 0]
        return np.asarray(
            ((f + g) * cosine)[:, None] * e_r - g[:, None] * np.array([1.0, 0.0, 0.0])
        )


def amplitudes(shell: Shell, r: Floats) -> Floats:
    """The four solutions of Navier's equation that are proportional to cos(theta) and sin(theta).

    A rigid translation (r^0), a bending of the sphere (r^2), Kelvin's point force (r^-1) and the
    gradient of a dipole (r^-3); radii count in those of the shell's outside.

    Returns
    -------
    (4, 4, n): f, g, radial stress, shear stress; by power; at each radius.
    """
    lam, mu = shell.lame
    nu = 0.5 * lam / (lam + mu)
    a = np.array([1.0, 1.0 - 4.0 * nu, 4.0 * (1.0 - nu), 2.0])[:, None]
    b = np.array([-1.0, 3.0 - 2.0 * nu, -(3.0 - 4.0 * nu), 1.0])[:, None]
    s = POWERS[:, None]
    x = np.atleast_1d(r) / shell.outer
    slope = x ** (s - 1.0) / shell.outer
    divergence = (s + 2.0) * a + 2.0 * b
    radial = (lam * divergence + 2.0 * mu * s * a) * slope
    shear = mu * ((s - 1.0) * b - a) * slope
    return np.stack([a * x**s, b * x**s, radial, shear])


def displaced_core(inner: Shell, outer: Shell, joint: Joint) -> tuple[Wave, Wave]:
    """The exact answer where the core moves by 1 m along x and the outside is held.

    Parameters
    ----------
    inner, outer : Shell
        The shells, which meet at the joint.
    joint : Joint
        "sliding": equal normal displacement, no shear stress. "averaged": equal mean displacement,
        tractions the same everywhere on a face. "rigid": each face moves as a rigid sphere.
        "bonded": one piece.
    """
    # columns: factors of the inner shell, then of the outer one; a row each for f, g, S, T
    none = np.zeros((4, 4))
    core, held = amplitudes(inner, np.array([inner.inner]))[:, :, 0], none
    core = np.hstack([core, none])
    held = np.hstack([none, amplitudes(outer, np.array([outer.outer]))[:, :, 0]])
    one = np.hstack([amplitudes(inner, np.array([inner.outer]))[:, :, 0], none])
    two = np.hstack([none, amplitudes(outer, np.array([outer.inner]))[:, :, 0]])
    f1, g1, s1, t1 = one
    f2, g2, s2, t2 = two
    meet = {
        "sliding": (f1 - f2, s1 - s2, t1, t2),
        "averaged": (f1 - 2 * g1 - f2 + 2 * g2, s1 + t1, s2 + t2, s1 - s2),
        "rigid": (f1 + g1, f2 + g2, f1 - f2, s1 - 2 * t1 - s2 + 2 * t2),
        "bonded": (f1 - f2, g1 - g2, s1 - s2, t1 - t2),
    }[joint]
    rows = np.array([core[0], core[1], held[0], held[1], *meet])
    right = np.array([1.0, -1.0, *np.zeros(6)])
    scale = np.abs(rows).max(axis=1)
    factors = np.linalg.solve(rows / scale[:, None], right / scale)
    return Wave(inner, factors[:4]), Wave(outer, factors[4:])


def force(wave: Wave, r: float) -> float:
    """Force along x that what is outside a sphere puts on what is inside [N]."""
    _, _, radial, shear = wave.at(np.array([r]))[:, 0]
    return float(4.0 * np.pi * r**2 * (radial - 2.0 * shear) / 3.0)


def core_stiffness(inner: Shell, outer: Shell, joint: Joint) -> float:
    """Force over displacement of the core, exact [N/m]."""
    return -force(displaced_core(inner, outer, joint)[0], inner.inner)


@dataclass(frozen=True)
class Squeezed:
    """Two shells on a held core under pressure from outside: u_r = A r + B / r^2 in each.

    Attributes
    ----------
    inner, outer : tuple[float, float]
        (A, B) of the two shells [-, m^3].
    contact : float
        Pressure on the joint [Pa].
    """

    inner: tuple[float, float]
    outer: tuple[float, float]
    contact: float


def squeezed(inner: Shell, outer: Shell, pressure: float) -> Squeezed:
    """Lame's solution of both shells; sliding and bonded are the same."""

    def row(shell: Shell, r: float) -> tuple[Floats, Floats]:
        lam, mu = shell.lame
        return np.array([r, r**-2]), np.array([3.0 * lam + 2.0 * mu, -4.0 * mu * r**-3])

    none = np.zeros(2)
    (u1, s1), (u2, s2) = row(inner, inner.outer), row(outer, outer.inner)
    rows = np.array(
        [
            np.concatenate([row(inner, inner.inner)[0], none]),
            np.concatenate([u1, -u2]),
            np.concatenate([s1, -s2]),
            np.concatenate([none, row(outer, outer.outer)[1]]),
        ]
    )
    right = np.array([0.0, 0.0, 0.0, -pressure])
    scale = np.abs(rows).max(axis=1)
    a1, b1, a2, b2 = np.linalg.solve(rows / scale[:, None], right / scale).tolist()
    return Squeezed((a1, b1), (a2, b2), float(-(s1 @ [a1, b1])))


@dataclass(frozen=True)
class Mesh:
    """Both shells in 27-node hexahedra; their nodes on the joint are at the same places.

    Attributes
    ----------
    points : Floats
        (n, 3) [m].
    cells : tuple[Ints, Ints]
        Of the inner and of the outer shell.
    core, inner, outer, outside : Ints
        Facets on the core, the two sides of the joint, and the outside.
    """

    points: Floats
    cells: tuple[Ints, Ints]
    core: Ints
    inner: Ints
    outer: Ints
    outside: Ints

    def pairs(self) -> tuple[Ints, Ints]:
        """Nodes of the two sides of the joint, pairwise."""
        inner, outer = np.unique(self.inner), np.unique(self.outer)
        apart, partner = cKDTree(self.points[outer]).query(self.points[inner])
        if len(inner) != len(outer) or apart.max() > 1e-9:
            raise ValueError("nodes of the two sides of the joint do not pair")
        return inner, outer[partner]

    def weights(self, facets: Ints) -> Floats:
        """(n,) integrals of the shape functions over facets, for every node [m^2]."""
        at = facet_points(self.points, facets)
        weights = np.zeros(len(self.points))
        np.add.at(weights, facets, np.einsum("qn,fq->fn", at.values, at.areas))
        return weights


def mesh_of(inner: Shell, outer: Shell, across: int, through: int, bonded: bool = False) -> Mesh:
    """Mesh both shells from six sides of a cube each.

    Parameters
    ----------
    across : int
        Elements along an edge of the cube, a quarter of a turn.
    through : int
        Elements through each shell.
    bonded : bool
        Whether the shells share their nodes.
    """
    first, second = (_sphere(shell, across, through) for shell in (inner, outer))
    n = len(first.points)
    both = Block(
        np.vstack([first.points, second.points]),
        np.vstack([first.cells, second.cells + n]),
        {
            "core": first.faces["z0"],
            "inner": first.faces["z1"],
            "outer": second.faces["z0"] + n,
            "outside": second.faces["z1"] + n,
        },
    )
    if bonded:
        both = joined(both)
    cells = both.cells[: len(first.cells)], both.cells[len(first.cells) :]
    names = ("core", "inner", "outer", "outside")
    return Mesh(both.points, cells, *(both.faces[name] for name in names))


def cut_open(mesh: Mesh) -> Mesh:
    """The half with y > 0, for a picture; an even number of elements across has a plane there."""
    least = -1e-6 * float(np.abs(mesh.points).max())
    inner, outer = (own[(mesh.points[own, 1] > least).all(axis=1)] for own in mesh.cells)
    return replace(mesh, cells=(inner, outer))


def _sphere(shell: Shell, across: int, through: int) -> Block:
    """A shell as six sides of a cube, blown up; rays of equal angle."""
    blocks = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            e = np.roll(np.eye(3), axis, axis=1)
            first, second, out = sign * e[0], e[1], sign * e[2]

            def shape(
                unit: Floats, first: Floats = first, second: Floats = second, out: Floats = out
            ) -> Floats:
                x, y = np.tan(0.25 * np.pi * (2.0 * unit[:, :2] - 1.0)).T
                ray = out + x[:, None] * first + y[:, None] * second
                ray /= np.linalg.norm(ray, axis=1)[:, None]
                radius = shell.inner + (shell.outer - shell.inner) * unit[:, 2]
                return np.asarray(radius[:, None] * ray)

            blocks.append(brick((across, across, through), 27, shape))
    starts = np.cumsum([0, *(len(b.points) for b in blocks[:-1])])
    return joined(
        Block(
            np.vstack([b.points for b in blocks]),
            np.vstack([b.cells + s for b, s in zip(blocks, starts, strict=True)]),
            {
                name: np.vstack([b.faces[name] + s for b, s in zip(blocks, starts, strict=True)])
                for name in ("z0", "z1")
            },
        )
    )


def _joint(mesh: Mesh, joint: Joint, first: int, n: int) -> list[Constraint]:
    """The joint as the drivetrain's model has it; ``first`` of its own degrees of freedom."""
    if joint == "bonded":
        return []
    inner, outer = mesh.pairs()
    if joint == "sliding":
        return [constraints.sliding_sphere("joint", inner, outer, mesh.points, _CENTRE, n)]
    if joint == "rigid":
        ends = [constraints.rigid_point(f"face {k}", _CENTRE, first + 6 * k, n) for k in (0, 1)]
        faces = [
            constraints.rigid_face(point.name, nodes, mesh.points, point)
            for point, nodes in zip(ends, (inner, outer), strict=True)
        ]
        return [*faces, constraints.equal_translations("joint", *ends)]
    first_weights, second_weights = [
        constraints.centred_weights(mesh.weights(facets)[nodes], mesh.points[nodes], _CENTRE)
        for facets, nodes in ((mesh.inner, inner), (mesh.outer, outer))
    ]
    both = mesh.points[np.concatenate([inner, outer])]
    # neighbours round the x axis form a group, of both sides: a matter of sparsity only
    order = np.argsort(np.arctan2(both[:, 2], both[:, 1]), kind="stable")
    groups = np.empty(len(both), dtype=np.int64)
    groups[order] = np.arange(len(both)) * _n_groups(mesh) // len(both)
    return [
        constraints.averaged_sphere(
            "joint", inner, outer, first_weights, second_weights, groups, first, n
        )
    ]


def _n_groups(mesh: Mesh) -> int:
    """Groups of an averaged joint: near the square root of the number of nodes there."""
    return round(math.sqrt(len(np.unique(mesh.inner))))


@dataclass(frozen=True)
class Moved:
    """What the finite elements answer to a core that moves by 1 m along x, and turns by 1 rad.

    Attributes
    ----------
    stiffness : float
        Force along x over displacement [N/m].
    across : float
        Largest force along y and z, over that along x.
    moments : Floats
        (3,) on the core that turns, about the centre [N m].
    displacements : Floats
        (n, 3) where the core moves [m].
    unknowns : int
        Number of degrees of freedom that are left.
    """

    stiffness: float
    across: float
    moments: Floats
    displacements: Floats
    unknowns: int


def _direct() -> str:
    """The fastest direct solver that is installed."""
    return next(
        (name for name in ("pardiso", "cholmod") if direct_solvers.is_installed(name)), "superlu"
    )


#: The core turns about this axis, which is none of the mesh's.
AXIS = np.array([2.0, -1.0, 3.0]) / np.sqrt(14.0)


def move_core(mesh: Mesh, shells: Sequence[Shell], joint: Joint) -> Moved:
    """Move and turn the core of a meshed joint.

    Parameters
    ----------
    mesh : Mesh
        From `mesh_of`, bonded where the joint is.
    shells : Sequence[Shell]
        The inner and the outer one.
    joint : Joint
        Its form.
    """
    nodes = mesh.points.size
    own = {"rigid": 12, "averaged": 3 * _n_groups(mesh)}.get(joint, 0)
    n = nodes + own + 6
    core = constraints.rigid_point("core", _CENTRE, nodes + own, n)
    conditions = [
        constraints.rigid_face("face on the core", np.unique(mesh.core), mesh.points, core),
        constraints.fixed("outside", np.unique(mesh.outside), n),
        *_joint(mesh, joint, nodes, n),
    ]
    motions = np.zeros((6, 2))
    motions[0, 0] = 1.0
    motions[3:, 1] = AXIS
    static = solve_solid(
        mesh.points,
        [(cells, shell.lame) for cells, shell in zip(mesh.cells, shells, strict=True)],
        None,
        conditions,
        np.zeros((n, 2)),
        prescribed=(nodes + own + np.arange(6), motions),
        # multigrid stalls on the means of whole spheres, and would hand over to a direct solver
        method=_direct() if joint == "averaged" else "auto",
    )
    onto_core = static.reactions["prescribed"][nodes + own :]
    return Moved(
        stiffness=float(onto_core[0, 0]),
        across=float(np.abs(onto_core[1:3, 0]).max() / abs(onto_core[0, 0])),
        moments=np.asarray(onto_core[3:, 1]),
        displacements=static.u[:nodes, 0].reshape(-1, 3),
        unknowns=n - sum(len(c.pivots) for c in conditions) - 6,
    )


@dataclass(frozen=True)
class Pressed:
    """What the finite elements answer to pressure from outside.

    Attributes
    ----------
    outside, joint : float
        Mean radial displacement of the outside and of the outer shell's face at the joint [m].
    contact : float
        Mean pressure on the joint [Pa].
    """

    outside: float
    joint: float
    contact: float


def press(mesh: Mesh, shells: Sequence[Shell], pressure: float) -> Pressed:
    """Press on the outside of a sliding joint whose core is held.

    The outer shell could turn on the joint: three displacements of two nodes on its outside are
    held, which the exact solution has not.

    Parameters
    ----------
    mesh : Mesh
        From `mesh_of`, not bonded.
    shells : Sequence[Shell]
        The inner and the outer one.
    pressure : float
        [Pa]
    """
    n = mesh.points.size
    outside = np.unique(mesh.outside)
    ends = [outside[[mesh.points[outside, axis].argmax()]] for axis in (0, 1)]
    static = solve_solid(
        mesh.points,
        [(cells, shell.lame) for cells, shell in zip(mesh.cells, shells, strict=True)],
        None,
        [
            constraints.fixed("core", np.unique(mesh.core), n),
            *_joint(mesh, "sliding", n, n),
            constraints.held_nodes("no turning about y and z", ends[0], (1, 2), n),
            constraints.held_nodes("no turning about x", ends[1], (2,), n),
        ],
        traction_loads(mesh.points, mesh.outside, pressure_of(pressure), n),
    )
    u = static.u[:, 0].reshape(-1, 3)
    normal = mesh.points / np.linalg.norm(mesh.points, axis=1)[:, None]
    radial = np.einsum("ni,ni->n", u, normal)
    face = np.unique(mesh.outer)
    onto = static.reactions["joint"][:, 0].reshape(-1, 3)[face]
    total = float(np.einsum("ni,ni->", onto, normal[face]))
    far, near = mesh.weights(mesh.outside), mesh.weights(mesh.outer)
    return Pressed(
        outside=float(far @ radial / far.sum()),
        joint=float(near @ radial / near.sum()),
        contact=total / (4.0 * np.pi * shells[1].inner ** 2),
    )


def turning_stiffness(inner: Shell, outer: Shell) -> float:
    """Moment over rotation of the core where the shells are bonded, exact [N m/rad].

    Each sphere turns about the axis by A + B / r^3, and the moment is 8 pi mu B: shells in series.
    """
    return 8.0 * np.pi / sum((s.inner**-3 - s.outer**-3) / s.lame[1] for s in (inner, outer))
