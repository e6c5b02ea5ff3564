"""A model with its elements integrated as CalculiX integrates them, for comparison to round-off."""

from dataclasses import replace

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator import element_loops
from fe_drivetrain.elasticity.operator.elasticity import sparsity
from fe_drivetrain.shafts.response.model import Model


def four_point_model(model: Model) -> Model:
    """The model with its elements integrated as ccx integrates its C3D10: at four points.

    Four points (degree 2) are exact where edges are straight. In curved elements they are not, so
    that two programs agree to round-off only if both use them.
    """
    mesh = model.mesh
    return replace(
        model,
        part_stiffness={
            part: four_point_stiffness(
                mesh.points,
                mesh.cells[mesh.part_cells(part)],
                model.scene.material_of(part).lame,
                model.n_dofs,
            )
            for part in mesh.part_names
        },
    )


def four_point_stiffness(
    points: Floats, cells: Ints, lame: tuple[float, float], n_dofs: int
) -> sparse.bsr_array:
    """Stiffness of cells integrated at four points, see `four_point_model`.

    Parameters
    ----------
    points, cells : Floats, Ints
        (n, 3) node coordinates [m], and (n_cells, 10) nodes in VTK's order.
    lame : tuple of float
        Lame's constants (lambda, mu) [Pa].
    n_dofs : int
        Number of degrees of freedom of the result, three a node or more.

    Returns
    -------
    stiffness : sparse.bsr_array
        (n_dofs, n_dofs) [N/m].
    """
    gradients, weights = element_kind(cells.shape[1]).table(2)
    pattern = sparsity(cells, n_dofs // 3)
    data = np.zeros((len(pattern.indices), 3, 3))
    nodes = np.ascontiguousarray(cells, dtype=np.int32)
    every = np.arange(len(cells))
    element_loops.add_elements(points, nodes, every, gradients, weights, *lame, pattern.slots, data)
    shape = (n_dofs, n_dofs)
    return sparse.bsr_array((data, pattern.indices, pattern.indptr), shape=shape)
