"""One solid or several under given forces and displacements: the shortest way to an answer."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.interfaces.constraints import Constraint, eliminate, held_dofs
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.operator.elasticity import assemble
from fe_drivetrain.elasticity.operator.elements import check_elements
from fe_drivetrain.elasticity.solve.reduction import reduce
from fe_drivetrain.elasticity.solve.solvers import Diagnostics, solve

Lame = tuple[float, float]

Assembly = Callable[[Floats, Ints, Lame, int], sparse.bsr_array]
"""Function of points, cells, Lame's constants and n_dofs, such as `elasticity.assemble`."""


@dataclass(frozen=True)
class Static:
    """Displacements of a solid and what holds it.

    Attributes
    ----------
    u : Floats
        Displacements (n_dofs, m) [m], and motions of reference points.
    reactions : Mapping[str, Floats]
        Nodal forces (n_dofs, m) [N] that each support or interface puts on the solid, by the name
        of its constraint; "prescribed" those that displace it as prescribed.
    energy : Floats
        Strain energy (m,) [J].
    K : sparse.bsr_array
        Stiffness (n_dofs, n_dofs) before any constraint [N/m].
    diagnostics : Diagnostics
        Diagnostics of the solve.
    """

    u: Floats
    reactions: Mapping[str, Floats]
    energy: Floats
    K: sparse.bsr_array
    diagnostics: Diagnostics

    __repr__ = short_repr


def solve_solid(
    points: Floats,
    cells: Ints | Sequence[tuple[Ints, Lame]],
    lame: Lame | None,
    constraints: Sequence[Constraint],
    F: Floats,
    prescribed: tuple[Ints, Floats] | None = None,
    method: str = "auto",
    assembly: Assembly = assemble,
) -> Static:
    """Solve a solid for one load or several.

    Parameters
    ----------
    points : Floats
        Node coordinates (n, 3) [m].
    cells : Ints or Sequence[tuple[Ints, Lame]]
        Node numbers (n_cells, k) in VTK's order; or of several materials the pairs of cells, all of
        one kind, and Lame's constants, with ``lame=None``.
    lame : Lame or None
        Lame's constants (lambda, mu) [Pa].
    constraints : Sequence[Constraint]
        Supports and interfaces, see `fe_drivetrain.elasticity.interfaces.constraints`.
    F : Floats
        Nodal forces (n_dofs,) or (n_dofs, m) [N].
    prescribed : tuple[Ints, Floats] or None
        Degrees of freedom (k,) and their displacements (k,) or (k, m) [m].
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.
    assembly : Assembly
        Assembly of the stiffness: that of `elasticity`, or `incompressible.assemble` for solids
        with nu near 1/2, or `incompatible.assemble` for hexahedra of 8 nodes that must bend.

    Raises
    ------
    InputError
        A cell has a node that there is not, or is folded over; a node belongs to no cell and is
        not held; the solid is not held, or two constraints hold one degree of freedom.
    """
    for some, _ in _parts(cells, lame):
        check_elements(points, some)
    return solve_unchecked(points, cells, lame, constraints, F, prescribed, method, assembly)


def solve_unchecked(
    points: Floats,
    cells: Ints | Sequence[tuple[Ints, Lame]],
    lame: Lame | None,
    constraints: Sequence[Constraint],
    F: Floats,
    prescribed: tuple[Ints, Floats] | None = None,
    method: str = "auto",
    assembly: Assembly = assemble,
) -> Static:
    """`solve_solid` of elements that may be folded over: to see what becomes of the result."""
    parts = _parts(cells, lame)
    loads = F.reshape(len(F), -1)
    n = len(loads)
    with np.errstate(divide="ignore", invalid="ignore"):
        K = sum(assembly(points, some, constants, n) for some, constants in parts)
    if not np.isfinite(K.data).all():
        raise InputError(
            "the stiffness has entries that are no numbers: an element of the mesh has no volume; "
            "find it with fe_drivetrain.elasticity.mesh.measures.jacobians, and mesh that "
            "part again"
        )
    held = list(constraints)
    if prescribed is not None:
        held.append(held_dofs("prescribed", prescribed[0], n))
        loads = np.broadcast_to(loads, (n, max(loads.shape[1], _columns(prescribed[1]))))
    _refuse_orphans(points, parts, held)
    elimination = eliminate(held, n)
    offset = np.zeros_like(loads, dtype=float)
    if prescribed is not None:
        values = np.reshape(prescribed[1], (len(prescribed[0]), -1))
        offset = offset + elimination.particular({"prescribed": values})
    everything = np.vstack([some for some, _ in parts])
    system = reduce(points, everything, K, elimination)
    solution = solve(system, elimination.T.T @ (loads - kernels.product(K, offset)), method)
    u = elimination.T @ solution.x + offset
    Ku = kernels.product(K, u)
    multipliers = elimination.multipliers(Ku - loads)
    reactions = {c.name: c.rows.T @ multipliers[c.name] for c in held}
    return Static(u, reactions, 0.5 * np.einsum("nm,nm->m", u, Ku), K, solution.diagnostics)


def _refuse_orphans(
    points: Floats, parts: Sequence[tuple[Ints, Lame]], held: Sequence[Constraint]
) -> None:
    """Refuse nodes that nothing holds: they belong to no cell, and no constraint has them."""
    alone = np.ones(len(points), dtype=bool)
    for cells, _ in parts:
        alone[cells] = False
    if not alone.any():
        return
    for constraint in held:
        columns = np.unique(constraint.rows.indices) // 3
        alone[columns[columns < len(points)]] = False
    orphans = np.flatnonzero(alone)
    if orphans.size:
        others = f" (and {orphans.size - 1} more nodes)" if orphans.size > 1 else ""
        at = ", ".join(f"{x:.3g}" for x in points[orphans[0]])
        raise InputError(
            f"node {orphans[0]} at ({at}) m belongs to no cell{others}, so that nothing holds it: "
            "remove it with fe_drivetrain.elasticity.mesh.renumbered, or hold it"
        )


def _parts(cells: Ints | Sequence[tuple[Ints, Lame]], lame: Lame | None) -> list[tuple[Ints, Lame]]:
    if isinstance(cells, np.ndarray):
        if lame is None:
            raise TypeError("solve_solid: give Lame's constants of the cells")
        return [(cells, lame)]
    return [(np.asarray(some), constants) for some, constants in cells]


def _columns(values: Floats) -> int:
    return 1 if np.ndim(values) < 2 else np.shape(values)[1]
