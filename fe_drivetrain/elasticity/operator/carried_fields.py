"""Fields of a mesh at the places of its nodes after a move: what they were there before it.

Displacements of nodes that move with a surface are not those of the places that they move to: in a
slender shaft that turns far and strains little, they would be strains larger than its own.
"""

from __future__ import annotations

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import CHUNK, Floats, Ints, chunks
from fe_drivetrain.elasticity.mesh.mapping import jacobian
from fe_drivetrain.elasticity.mesh.shapes import TETRAHEDRON_EDGES, element_kind
from fe_drivetrain.elasticity.operator.elasticity import Pattern

_NODES = np.concatenate([np.eye(4), np.eye(4)[TETRAHEDRON_EDGES].mean(axis=1)])[:, 1:]
"""Places of the ten nodes of a tetrahedron in its reference coordinates."""


def change_by_shift(
    points: Floats, cells: Ints, pattern: Pattern, shift: Floats
) -> sparse.bsr_array:
    """A with which u + A u are displacements at shifted places, exactly of a linear field.

    A is the gradient at each node, the mean of the elements that have it and over each of them,
    times the shift. A mean is smooth: what is rough in u would grow with the shift.

    Parameters
    ----------
    points : Floats
        Nodes (n, 3) that u is of [m].
    cells : Ints
        Node ids (ne, 10).
    pattern : Pattern
        Pattern of these cells, of n blocks or more.
    shift : Floats
        (n, 3) from the nodes to the places [m].

    Returns
    -------
    sparse array
        In 3x3 blocks.
    """
    gradients = np.ascontiguousarray(element_kind(10).shape(_NODES.T)[1])
    elements = np.bincount(cells.ravel(), minlength=len(points))
    along = shift / np.maximum(elements, 1)[:, None]
    data = np.zeros(len(pattern.indices))
    for chunk in chunks(len(cells), CHUNK // 4):
        some = cells[chunk]
        mean = jacobian(points, some, gradients)[0].mean(axis=1)
        values = np.einsum("eck,eqc->eqk", mean, along[some])
        data += np.bincount(pattern.slots[chunk].ravel(), values.ravel(), minlength=len(data))
    blocks = np.zeros((len(data), 3, 3))
    blocks[:, range(3), range(3)] = data[:, None]
    size = 3 * (len(pattern.indptr) - 1)
    return sparse.bsr_array((blocks, pattern.indices, pattern.indptr), shape=(size, size))
