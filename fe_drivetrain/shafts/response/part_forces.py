"""Internal forces of each part of a solved model, without the stiffness of each part.

Where a node belongs to one part alone, its row of the whole stiffness is that part's. Only the
elements at nodes that parts share, or that springs act on, are assembled by part.
"""

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats
from fe_drivetrain.elasticity.interfaces.constraints import dofs
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.operator.incompressible import assemble_unlocked
from fe_drivetrain.shafts.response.model import Model, PartStiffness


def part_forces(model: Model, U: Floats, forces: Floats) -> dict[str, Floats]:
    """Forces (n_dofs, k) that strain each part, by its name.

    Parameters
    ----------
    model : Model
        The model.
    U : Floats
        (n_dofs, k) displacements [m, rad].
    forces : Floats
        (n_dofs, k) the same of the whole model, its springs included [N, N m].
    """
    if not isinstance(model.part_stiffness, PartStiffness):
        return {part: k @ U for part, k in model.part_stiffness.items()}
    mesh, n = model.mesh, len(model.mesh.points)
    parts = {part: mesh.cells[mesh.part_cells(part)] for part in mesh.part_names}
    members = np.zeros((len(parts), n), dtype=bool)
    for own, cells in zip(members, parts.values(), strict=True):
        own[cells] = True
    mixed = (np.count_nonzero(members, axis=0) > 1) | _held_by_springs(model)
    number = np.empty(n, dtype=np.int64)
    found = {}
    for own, (part, cells) in zip(members, parts.items(), strict=True):
        of_part = np.zeros_like(U)
        alone = dofs(np.flatnonzero(own & ~mixed))
        of_part[alone] = forces[alone]
        some = cells[mixed[cells].any(axis=1)]
        if len(some):
            here = np.zeros(n, dtype=bool)
            here[some] = True
            nodes = np.flatnonzero(here)
            number[nodes] = np.arange(len(nodes))
            lame = model.scene.material_of(part).lame
            K = assemble_unlocked(mesh.points[nodes], number[some], lame)
            strained = kernels.product(K, U[dofs(nodes).ravel()])
            shared = mixed[nodes]
            of_part[dofs(nodes[shared])] = strained[dofs(np.flatnonzero(shared))]
        found[part] = of_part
    return found


def _held_by_springs(model: Model) -> Bools:
    """Which nodes move points that springs hold: (n_nodes,)."""
    n = len(model.mesh.points)
    found = np.zeros(n, dtype=bool)
    for point, _ in model.springs:
        nodes = point.motion.tocsr().indices // 3
        found[nodes[nodes < n]] = True
    return found
