"""Bytes that the phases of a solve by multigrid move at least, and with every access."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy import sparse

from fe_drivetrain.cases.performance.peers import Problem
from fe_drivetrain.common import Floats
from fe_drivetrain.elasticity.operator import Pattern
from fe_drivetrain.elasticity.solve import System, multigrid

#: Steps of set-up, of which each is timed by itself, and what is left.
EIGENVALUES, COARSE = "set-up: eigenvalues", "set-up: product for linear elements"
REST = "set-up: all else"
STEPS = (EIGENVALUES, COARSE, REST)

#: Bytes of a 3x3 block in double and in single precision, each with its column.
DOUBLE, SINGLE = 9 * 8 + 4, 9 * 4 + 4


def held_bytes(*arrays: NDArray[Any]) -> float:
    """Memory of some arrays."""
    return float(sum(array.nbytes for array in arrays))


def matrix_bytes(*matrices: sparse.sparray) -> float:
    """Memory of some matrices."""
    return sum(held_bytes(of.data, of.indices, of.indptr) for of in matrices)


def element_bytes(problem: Problem, pattern: Pattern, blocks: Floats) -> float:
    """Nodes, cells and each element's places are read, and blocks written, once."""
    return held_bytes(problem.points, problem.cells, pattern.slots, blocks)


def reduction_bytes(problem: Problem, system: System) -> float:
    """Nodes, cells and the pattern are read; the diagonal, and what leads to linear elements, made.

    The blocks of the diagonal are read, too.
    """
    assert system.elements is not None
    transfer = matrix_bytes(system.prolongation) + held_bytes(system.near_nullspace, system.body)
    mesh = held_bytes(problem.points, problem.cells, system.K.indices)
    return mesh + 2.0 * held_bytes(system.elements.diagonal) + transfer


def accessed_bytes(pattern: Pattern, system: System) -> dict[str, float]:
    """Bytes of every access of phases whose accesses are indirect.

    The pattern is made in two passes over the pairs of each cell's nodes, which read a node and a
    marker; elements read and write a block for each pair, and its place; the product for linear
    elements reads a block, and reads and writes the sum that it belongs to, for half of the parents
    of each row.
    """
    assert system.prolongation is not None
    pairs = float(pattern.slots.size)
    parents = np.diff(system.prolongation.indptr)[::3]
    added = 0.5 * float(np.diff(system.K.indptr) @ parents)
    return {
        "pattern": pairs * (2 * 8 + 4),
        "elements": pairs * (2 * 72 + 4),
        COARSE: added * 3 * 72,
    }


def level_bytes(level: multigrid.Level) -> float:
    """One pass over the stiffness of a level."""
    return float((SINGLE if level.K.data.dtype == np.float32 else DOUBLE) * len(level.K.indices))


def set_up_bytes(system: System, hierarchy: multigrid.Hierarchy) -> dict[str, float]:
    """Bytes of set-up, and of each of its steps.

    The stiffness of each level is read and what smooths written; read as often as Lanczos has
    steps; and read once more with the prolongation, of which the stiffness of the next level is
    made. The prolongation is written in both directions.
    """
    eigenvalues = multigrid.LANCZOS_STEPS * sum(map(level_bytes, hierarchy.levels))
    rest, products = 0.0, []
    for number, level in enumerate(hierarchy.levels):
        exact = float(DOUBLE * len(level.K.indices))
        coarser = hierarchy.levels[number + 1 : number + 2]
        following = [float(DOUBLE * len(of.K.indices)) for of in coarser]
        last = following or [float(hierarchy.coarsest[0].nbytes)]
        products.append(exact + matrix_bytes(level.prolongation) + last[0])
        rest += exact + level_bytes(level) + held_bytes(level.inverse)
        rest += matrix_bytes(level.prolongation, level.restriction)
    rest += sum(products[1:])
    return {
        "set-up": eigenvalues + products[0] + rest,
        EIGENVALUES: eigenvalues,
        COARSE: products[0],
        REST: rest,
    }


def iteration_bytes(system: System, hierarchy: multigrid.Hierarchy) -> float:
    """The product of conjugate gradients, and of each level what a cycle reads.

    A smoother of degree d before, which begins at zero, reads the stiffness d - 1 times, the
    residual once, the smoother behind d times; a correction goes down and up once.
    """
    n = system.K.shape[0]
    total: float = DOUBLE * len(system.K.indices) + 8.0 * n * VECTORS
    for level in hierarchy.levels:
        between = float(level.prolongation.nnz + level.restriction.nnz)
        vectors = 8.0 * level.inverse.shape[0] * 3 * VECTORS_OF_LEVEL
        total += 2 * level.degree * level_bytes(level) + 12.0 * between + vectors
    return total


#: Vectors that an iteration reads or writes: in the product, in two sums, in two updates.
VECTORS = 2 + 4 + 6 + 3
#: And a level in a cycle: first step, residual, restriction, correction, last step with its blocks.
VECTORS_OF_LEVEL = 3 + 3 + 3 + 1 + 3 + 6 + 2 * 3
