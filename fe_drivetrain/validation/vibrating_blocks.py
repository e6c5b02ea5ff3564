"""Natural modes of a block of one material, however it is held."""

from __future__ import annotations

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.interfaces import Constraint
from fe_drivetrain.interfaces.constraints import eliminate
from fe_drivetrain.mesh import Block
from fe_drivetrain.operator import assemble, mass_matrix
from fe_drivetrain.scene import Material
from fe_drivetrain.solve import factorise, in_blocks, reduce
from fe_drivetrain.solve.vibration import lowest_modes


def block_modes(
    block: Block, material: Material, held: Constraint, count: int, below: float
) -> tuple[Floats, Floats]:
    """Frequencies and shapes of the lowest modes, free motions among them.

    Parameters
    ----------
    block : Block
        The mesh.
    material : Material
        Of all of it, with its density.
    held : Constraint
        What holds it, if not altogether.
    count : int
        How many modes.
    below : float
        A frequency below those that matter [Hz]: the stiffness is shifted by its square, so that a
        body that moves freely can be factorised.

    Returns
    -------
    frequencies, shapes : Floats
        (count,) ascending, those of free motions about 0 [Hz]; (count, n, 3) of unit mass.
    """
    n = block.points.size
    shift = -((2.0 * np.pi * below) ** 2)
    M = mass_matrix(block.points, block.cells, material.density, n)
    K = in_blocks(assemble(block.points, block.cells, material.lame) - shift * M)
    elimination = eliminate([held], n)
    solver = factorise(reduce(block.points, block.cells, K, elimination), n_rhs=4 * count)
    T, free = elimination.T, np.flatnonzero(elimination.free)
    M = (T.T @ M @ T).tocsr()[free][:, free]

    def solved(forces: Floats) -> Floats:
        F = np.zeros((n, 1))
        F[free, 0] = forces
        return np.asarray(solver.solve(F).x[free, 0])

    values, modes = lowest_modes(solved, M, count, shift)
    shapes = np.zeros((n, count))
    shapes[free] = modes
    frequencies = np.sqrt(np.maximum(values, 0.0)) / (2.0 * np.pi)
    return frequencies, (T @ shapes).T.reshape(count, -1, 3)
