"""A scene that can move without deforming is found and named before anything is solved.

Without strain, each body (parts that share nodes) has six rigid motions. A combination of them
that fulfils every constraint and stretches no spring is a mechanism.
"""

from collections.abc import Sequence

import numpy as np
from scipy import linalg, sparse
from scipy.sparse.csgraph import connected_components

from fe_drivetrain.elasticity import Floats, Ints, rigid_motions
from fe_drivetrain.errors import InputError
from fe_drivetrain.interfaces import AXES, Constraint, ReferencePoint
from fe_drivetrain.mesh import Mesh

# Relative to constraint rows of size one: far above round-off, far below any real restraint.
_NULL = 1e-9


def bodies(mesh: Mesh) -> tuple[Ints, list[tuple[str, ...]]]:
    """Which body each node belongs to, and the names of the parts of each body.

    Returns
    -------
    body_of_node, part_names
        (n_nodes,) and one tuple of names for each body.
    """
    n = len(mesh.points)
    first = np.repeat(mesh.cells[:, 0], mesh.cells.shape[1])
    graph = sparse.coo_array((np.ones(first.size), (first, mesh.cells.ravel())), shape=(n, n))
    count, body_of_node = connected_components(graph, directed=False)
    body_of_cell = body_of_node[mesh.cells[:, 0]]
    names = [
        tuple(mesh.part_names[p] for p in np.unique(mesh.part[body_of_cell == body]))
        for body in range(count)
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
    mesh
        The whole scene.
    constraints
        All interfaces and supports.
    springs
        Reference points with their (6, 6) stiffness to ground.
    """
    body_of_node, names = bodies(mesh)
    n_freedoms = _n_freedoms(mesh, constraints, springs)
    n = len(mesh.points)
    length = float(np.ptp(mesh.points, axis=0).max())
    centres = np.array([mesh.points[body_of_node == b].mean(axis=0) for b in range(len(names))])
    extra = n_freedoms - 3 * n
    motions = np.zeros((n_freedoms, 6 * len(names) + extra))
    for b in range(len(names)):
        nodes = np.flatnonzero(body_of_node == b)
        # Turning about a body's own centre, by the angle that moves its far end by about one.
        rigid = rigid_motions(mesh.points[nodes], centres[b])
        rigid[:, 3:] /= length
        rows = (3 * nodes[:, None] + np.arange(3)).ravel()
        motions[rows, 6 * b : 6 * b + 6] = rigid
    motions[3 * n :, 6 * len(names) :] = np.eye(extra)

    restraints = [np.zeros((1, motions.shape[1]))]
    restraints += [constraint.rows @ motions for constraint in constraints]
    for point, stiffness in springs:
        values, vectors = np.linalg.eigh(stiffness)
        active = vectors[:, values > 0.0]
        restraints.append(active.T @ (point.motion @ motions))
    A = linalg.qr(np.vstack(restraints), mode="r")[0]
    _, sizes, right = np.linalg.svd(A)
    rank = int((sizes > _NULL * max(sizes[0], 1.0)).sum()) if sizes.size else 0
    null = right[rank:, : 6 * len(names)]
    null = null[np.abs(null).max(axis=1) > _NULL] if null.size else null
    return [_describe(motion.reshape(-1, 6), names, centres, length) for motion in _sparsest(null)]


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


def _n_freedoms(
    mesh: Mesh,
    constraints: Sequence[Constraint],
    springs: Sequence[tuple[ReferencePoint, Floats]],
) -> int:
    if constraints:
        return int(constraints[0].rows.shape[1])
    return int(springs[0][0].motion.shape[1]) if springs else 3 * len(mesh.points)


def _sparsest(null: Floats) -> Floats:
    """Reduced row echelon form of a null space: each motion moves as few things as it can."""
    basis = null.copy()
    rank = 0
    # Rotations first: "turns about x" says more than a translation that comes with it.
    columns = sorted(range(basis.shape[1]), key=lambda c: (c // 6, c % 6 < 3, c))
    for column in columns:
        if rank == len(basis):
            break
        row = rank + int(np.argmax(np.abs(basis[rank:, column])))
        if abs(basis[row, column]) < 1e-6:
            continue
        basis[[rank, row]] = basis[[row, rank]]
        basis[rank] /= basis[rank, column]
        others = [r for r in range(len(basis)) if r != rank]
        basis[others] -= np.outer(basis[others, column], basis[rank])
        rank += 1
    return basis[:rank]


def _describe(
    motion: Floats, names: Sequence[tuple[str, ...]], centres: Floats, length: float
) -> str:
    moving = [b for b in range(len(names)) if np.abs(motion[b]).max() > 1e-6]
    parts = [name for b in moving for name in names[b]]
    subject = " and ".join([", ".join(parts[:-1]), parts[-1]] if len(parts) > 1 else parts)
    translation, rotation = motion[moving[0]][:3], motion[moving[0]][3:] / length
    turn = np.linalg.norm(rotation)
    if turn * length < 1e-6:
        return f"{subject} can move freely along {_direction(translation)}"
    # The point of the axis that is nearest to the body's centre.
    through = centres[moving[0]] + np.cross(rotation, translation) / turn**2
    through = through - rotation * (rotation @ through) / turn**2
    at = ", ".join(f"{x:.3g}" for x in np.where(np.abs(through) < 1e-6 * length, 0.0, through))
    return f"{subject} can turn freely about {_direction(rotation)} through ({at}) m"


def _direction(vector: Floats) -> str:
    unit = vector / np.linalg.norm(vector)
    axis = int(np.argmax(np.abs(unit)))
    if abs(unit[axis]) > 1 - 1e-6:
        return AXES[axis]
    return "the direction (" + ", ".join(f"{x:.3g}" for x in unit) + ")"
