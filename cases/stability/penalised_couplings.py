"""One bar with a coupling, three kinds of it, eliminated or penalised: as hard as one likes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.drivetrain_file import MATERIALS
from fe_drivetrain.elasticity.interfaces import (
    Constraint,
    averaged_point,
    eliminate,
    fixed,
    held,
    mortar_tie,
    rigid_face,
    rigid_point,
)
from fe_drivetrain.elasticity.mesh import MEANS, Block, brick, face_weights
from fe_drivetrain.elasticity.operator import assemble, body_loads
from fe_drivetrain.elasticity.solve import (
    TOLERANCE,
    System,
    factorise,
    in_blocks,
    multigrid,
    reduce,
)

LENGTH, SIDE = 1.0, 0.25
MATERIAL = MATERIALS["steel"]

KINDS = ("tie", "rigid", "averaged")

#: Few nodes are left to the dense factor, so that this small bar has the levels of a large one.
OPTIONS = multigrid.Options(coarsest=50)


@dataclass(frozen=True)
class Bar:
    """A bar of elastic blocks, fixed at one end, with a coupling that is not yet made.

    Attributes
    ----------
    points, cells : Floats, np.ndarray
        Hexahedra of 27 nodes.
    K : sparse.bsr_array
        Stiffness without any constraint, in 3x3 blocks [N/m].
    support, coupling : Constraint
        Constraints.
    F : Floats
        (n_dofs, m) loads [N].
    """

    points: Floats
    cells: np.ndarray
    K: sparse.bsr_array
    support: Constraint
    coupling: Constraint
    F: Floats


def bar(kind: str, across: int) -> Bar:
    """The bar with one kind of coupling.

    Parameters
    ----------
    kind : str
        "tie": two halves whose meshes do not match, by the mortar method. "rigid": the free end is
        a rigid face, loaded at its reference point. "averaged": the mean motion of the free end is
        held, and the bar loaded by its weight.
    across : int
        Hexahedra across; the tied half has one less.
    """
    along = 4 * across
    if kind == "tie":
        halves = [
            _block(0.0, 0.5, 2 * across, across),
            _block(0.5, 1.0, 2 * across, max(1, across - 1)),
        ]
    else:
        halves = [_block(0.0, 1.0, along, across)]
    first, last = halves[0], halves[-1]
    shift = 0 if first is last else len(first.points)
    points = first.points if first is last else np.vstack([first.points, last.points])
    cells = first.cells if first is last else np.vstack([first.cells, last.cells + shift])
    n = 3 * len(points)
    total = n + 6 if kind == "rigid" else n
    end = np.unique(last.faces["x1"]) + shift
    centre = np.array([LENGTH, 0.0, 0.0])
    weights = face_weights(points, last.faces["x1"] + shift, len(points), MEANS)[end]
    mean = averaged_point("end", end, weights, points, centre, total)
    support = fixed("support", first.face_nodes("x0"), total)
    F = np.zeros((total, 3))
    coupling: Constraint
    if kind == "tie":
        slave, master = first.faces["x1"], last.faces["x0"] + shift
        coupling = mortar_tie("tie", points, slave, master, total)
        F[:] = mean.motion[[0, 2, 3]].T.toarray()
    elif kind == "rigid":
        point = rigid_point("end", centre, n, total)
        coupling = rigid_face("end", end, points, point)
        F[:] = point.motion[[0, 2, 3]].T.toarray()
    else:
        coupling = held("end", mean, range(6))
        for axis in range(3):
            F[:n, axis] = body_loads(points, cells, np.eye(3)[axis])
    K = assemble(points, cells, MATERIAL.lame, total)
    return Bar(points, cells, K, support, coupling, F)


def _block(start: float, end: float, along: int, across: int) -> Block:
    def shape(unit: Floats) -> Floats:
        x = LENGTH * (start + (end - start) * unit[:, 0])
        return np.column_stack([x, SIDE * (unit[:, 1:] - 0.5)])

    return brick((along, across, across), 27, shape)


def eliminated(found: Bar) -> tuple[System, Floats]:
    """System and loads with the coupling eliminated."""
    elimination = eliminate([found.support, found.coupling], found.K.shape[0])
    system = reduce(found.points, found.cells, found.K, elimination)
    return system, np.asarray(elimination.T.T @ found.F)


def penalised(found: Bar, penalty: float) -> tuple[System, Floats]:
    """System and loads with the coupling as springs of a stiffness.

    Parameters
    ----------
    penalty : float
        Stiffness of the spring on each row of the coupling, of unit length, over the mean diagonal
        of the bar's stiffness.
    """
    rows = found.coupling.rows
    lengths = np.sqrt(np.asarray(rows.multiply(rows).sum(axis=1)).ravel())
    C = sparse.diags_array(1.0 / lengths) @ rows
    scale = float(found.K.diagonal().mean())
    springs = (penalty * scale) * (C.T @ C)
    K = in_blocks(found.K + springs.tocsr().tobsr((3, 3)))
    elimination = eliminate([found.support], K.shape[0])
    system = reduce(found.points, found.cells, K, elimination)
    return system, np.asarray(elimination.T.T @ found.F)


def work(system: System, F: Floats, method: str) -> Floats:
    """(m,) work of each load on its own displacements [J], or NaN where the solver refuses."""
    try:
        found = factorise(system, method, F.shape[1]).solve(F)
    except InputError:
        return np.full(F.shape[1], np.nan)
    return np.asarray(np.einsum("nm,nm->m", F, found.x))


def iterated(system: System, F: Floats) -> tuple[Floats, int, bool]:
    """Work of each load by multigrid alone, iterations, and whether it says that it got there."""
    try:
        hierarchy = multigrid.build(system, OPTIONS)
    except InputError:
        return np.full(F.shape[1], np.nan), 0, False
    found = multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, TOLERANCE)
    worked = np.einsum("nm,nm->m", F, found.x)
    return np.asarray(worked), found.iterations, found.energy_error <= TOLERANCE
