"""A scene that can move without deforming is found and named before anything is solved.

Without strain, each body (parts that share nodes) has six rigid motions. A combination of them
that fulfils every constraint and stretches no spring is a mechanism. One that stretches soft
springs only is nearly one: round-off of the stiffness of the bodies, which the motion should not
feel at all, is then no longer small beside that of the springs, and digits of the result are lost.
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.free_motions import NULL, described_motion, null_space, sparsest
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.elasticity.interfaces.constraints import Constraint, ReferencePoint
from fe_drivetrain.elasticity.mesh.bodies import connected_bodies
from fe_drivetrain.elasticity.mesh.mesh import Mesh

_EPSILON = float(np.finfo(np.float64).eps)

WEAK = 1e-9
"""Restraint of a motion, relative to the bodies' own stiffness, below which it is warned of.

Round-off leaves an error of about 2e-16 over this ratio, and of an averaged joint up to a hundred
times as much (``cases/stability/near_mechanisms.py``): of the seven digits that are left here two
may go there, and four is what a stiffness needs.
"""


@dataclass(frozen=True)
class WeakMotion:
    """A motion without strain that soft springs alone restrain.

    Attributes
    ----------
    description : str
        Sentence on what moves and how, as in "shaft can nearly turn about x through (0, 0, 0) m".
    ratio : float
        Work of the springs over that of a spring of the bodies' own scale, Young's modulus times
        length, which is stretched by the maximum displacement anywhere in the body.
    """

    description: str
    ratio: float

    @property
    def digits_lost(self) -> float:
        """Decades from the springs to the bodies, of the sixteen digits of a double."""
        return -math.log10(min(max(self.ratio, _EPSILON), 1.0))

    def __str__(self) -> str:
        return (
            f"{self.description}: the only restraint is {self.ratio:.1g} of the stiffness of what "
            f"moves (Young's modulus times length); results in that direction lose "
            f"{self.digits_lost:.0f} of 16 digits"
        )


@dataclass(frozen=True)
class _StrainFree:
    """Rigid motions of all bodies, then the degrees of freedom that belong to no body, as columns.

    Attributes
    ----------
    motions : Floats
        Displacements (n_dofs, 6 n_bodies + n_extra); turning is measured by its `length`.
    body_of_node : Ints
        Body (n_nodes,) of each node.
    names : list[tuple[str, ...]]
        Names of the parts of each body.
    centres : Floats
        Centres (n_bodies, 3) that the bodies turn about [m].
    length : float
        Length [m]: turning by 1 / length moves the far end of the scene by about one.
    extents : Floats
        Maximum dimension (n_bodies,) of each body [m].
    """

    motions: Floats
    body_of_node: Ints
    names: list[tuple[str, ...]]
    centres: Floats
    length: float
    extents: Floats

    def largest(self, motion: Floats) -> Floats:
        """Maximum displacement (n_bodies,) of any node of each body in a motion (m,)."""
        moved = (self.motions @ motion)[: 3 * len(self.body_of_node)].reshape(-1, 3)
        found = np.zeros(len(self.names))
        np.maximum.at(found, self.body_of_node, np.linalg.norm(moved, axis=1))
        return found


def named_bodies(mesh: Mesh) -> tuple[Ints, list[tuple[str, ...]]]:
    """Which body each node belongs to, and the names of the parts of each body.

    Returns
    -------
    body_of_node, part_names
        (n_nodes,) and one tuple of names for each body.
    """
    body_of_node = connected_bodies(mesh.cells, len(mesh.points))
    body_of_cell = body_of_node[mesh.cells[:, 0]]
    names = [
        tuple(mesh.part_names[p] for p in np.unique(mesh.part[body_of_cell == body]))
        for body in range(body_of_node.max() + 1)
    ]
    return body_of_node, names


def find_mechanisms(
    mesh: Mesh,
    constraints: Sequence[Constraint],
    springs: Sequence[tuple[ReferencePoint, Floats]],
) -> list[str]:
    """Describe every motion that costs no energy; empty where the scene stands still.

    Parameters
    ----------
    mesh : Mesh
        The whole scene.
    constraints : Sequence[Constraint]
        All interfaces and supports.
    springs : Sequence[tuple[ReferencePoint, Floats]]
        Reference points with their (6, 6) stiffness to ground.
    """
    free = _strain_free(mesh, _n_dofs(mesh, constraints, springs))
    motions = free.motions
    restraints = [np.zeros((1, motions.shape[1]))]
    restraints += [constraint.rows @ motions for constraint in constraints]
    for point, stiffness in springs:
        values, vectors = np.linalg.eigh(stiffness)
        active = vectors[:, values > 0.0]
        restraints.append(active.T @ (point.motion @ motions))
    null = null_space(restraints)[:, : 6 * len(free.names)]
    null = null[np.abs(null).max(axis=1) > NULL] if null.size else null
    return [_describe(motion.reshape(-1, 6), free, "freely") for motion in sparsest(null)]


def refuse_mechanisms(
    mesh: Mesh,
    constraints: Sequence[Constraint],
    springs: Sequence[tuple[ReferencePoint, Floats]],
) -> None:
    """Raise an InputError that names every free motion, where there is one."""
    found = find_mechanisms(mesh, constraints, springs)
    if found:
        raise InputError(
            "the scene is a mechanism: " + "; ".join(found) + ": add a support, or a gearbox "
            "stiffness in that direction"
        )


def weak_restraints(
    mesh: Mesh,
    constraints: Sequence[Constraint],
    springs: Sequence[tuple[ReferencePoint, Floats]],
    moduli: Mapping[str, float],
    below: float = WEAK,
) -> list[WeakMotion]:
    """Every motion without strain that the constraints allow and springs hardly restrain.

    Parameters
    ----------
    mesh, constraints, springs : Mesh, Sequence[Constraint], Sequence[tuple[ReferencePoint, Floats]]
        Arguments of `find_mechanisms`; the scene is no mechanism.
    moduli : Mapping[str, float]
        Young's modulus of each part [Pa]; of a body of several parts the maximum counts.
    below : float
        Ratio of the restraint to the bodies' own stiffness that a motion must be below.

    Returns
    -------
    motions
        Weak motions, in ascending order of restraint.
    """
    if not springs:
        return []
    free = _strain_free(mesh, _n_dofs(mesh, constraints, springs))
    n_moving = 6 * len(free.names)
    null = null_space(
        [np.zeros((1, free.motions.shape[1])), *(c.rows @ free.motions for c in constraints)]
    )
    # Roots of energies, so that soft and stiff springs side by side do not drown each other.
    rows = []
    for point, stiffness in springs:
        values, vectors = np.linalg.eigh(stiffness)
        root = np.sqrt(np.maximum(values, 0.0))[:, None] * vectors.T
        rows.append(root @ (point.motion @ free.motions))
    springs_root = np.vstack(rows)
    moduli_of = [max(moduli[part] for part in names) for names in free.names]
    own = np.array(moduli_of) * free.extents
    # The bodies' scale as the unit; what belongs to no body follows the bodies.
    scaled = null[:, :n_moving] * np.repeat(np.sqrt(own), 6)
    left, sizes, _ = np.linalg.svd(scaled, full_matrices=False)
    kept = sizes > NULL * sizes.max(initial=0.0)
    basis = (left[:, kept] / sizes[kept]).T @ null
    sizes, right = np.linalg.svd(springs_root @ basis.T)[1:]
    sizes = np.append(sizes, np.zeros(len(basis) - len(sizes)))
    # Here a body that turns is measured by the length of the scene: never less than what its nodes
    # move, but where it moves along as well.
    weak = right[sizes**2 < 2.0 * below] @ basis
    scale = np.abs(weak[:, :n_moving]).max(axis=1, initial=0.0)
    found = []
    for motion in sparsest(weak / scale[:, None], n_moving):
        work = float(((springs_root @ motion) ** 2).sum())
        ratio = work / float(own @ free.largest(motion) ** 2)
        if ratio < below:
            moved = motion[:n_moving].reshape(-1, 6)
            found.append(WeakMotion(_describe(moved, free, "nearly"), ratio))
    return sorted(found, key=lambda motion: motion.ratio)


def warn_of_weak_restraints(
    mesh: Mesh,
    constraints: Sequence[Constraint],
    springs: Sequence[tuple[ReferencePoint, Floats]],
    moduli: Mapping[str, float],
) -> tuple[str, ...]:
    """One sentence for each motion of `weak_restraints`.

    Raises
    ------
    InputError
        A restraint is so weak that round-off leaves no digit of the result.
    """
    found = weak_restraints(mesh, constraints, springs, moduli)
    lost = [motion for motion in found if motion.ratio < _EPSILON]
    if lost:
        raise InputError(
            "the scene is a mechanism within round-off: "
            + "; ".join(map(str, lost))
            + f": give the spring there at least {WEAK:g} of that stiffness, or hold it rigidly"
        )
    return tuple(map(str, found))


def _strain_free(mesh: Mesh, n_dofs: int) -> _StrainFree:
    body_of_node, names = named_bodies(mesh)
    n = len(mesh.points)
    length = float(np.ptp(mesh.points, axis=0).max())
    centres = np.array([mesh.points[body_of_node == b].mean(axis=0) for b in range(len(names))])
    extra = n_dofs - 3 * n
    motions = np.zeros((n_dofs, 6 * len(names) + extra))
    extents = np.zeros(len(names))
    for b in range(len(names)):
        nodes = np.flatnonzero(body_of_node == b)
        extents[b] = np.ptp(mesh.points[nodes], axis=0).max()
        # Turning about a body's own centre, by the angle that moves its far end by about one.
        rigid = rigid_motions(mesh.points[nodes], centres[b])
        rigid[:, 3:] /= length
        rows = (3 * nodes[:, None] + np.arange(3)).ravel()
        motions[rows, 6 * b : 6 * b + 6] = rigid
    motions[3 * n :, 6 * len(names) :] = np.eye(extra)
    return _StrainFree(motions, body_of_node, names, centres, length, extents)


def _n_dofs(
    mesh: Mesh,
    constraints: Sequence[Constraint],
    springs: Sequence[tuple[ReferencePoint, Floats]],
) -> int:
    if constraints:
        return int(constraints[0].rows.shape[1])
    return int(springs[0][0].motion.shape[1]) if springs else 3 * len(mesh.points)


def _describe(motion: Floats, free: _StrainFree, how: str) -> str:
    """Who moves and how: "freely" or "nearly"."""
    moving = [b for b in range(len(free.names)) if np.abs(motion[b]).max() > 1e-6]
    parts = [name for b in moving for name in free.names[b]]
    first = moving[0]
    return described_motion(parts, motion[first], free.centres[first], free.length, how)
