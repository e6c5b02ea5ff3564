"""Bodies in series whose stiffness is far apart: a shaft in a soft or stiff ring, and a chain."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fe_drivetrain.cases.references.two_bodies import Bodies
from fe_drivetrain.common import Floats, InputError, Ints
from fe_drivetrain.elasticity.interfaces import (
    Constraint,
    eliminate,
    fixed,
    rigid_face,
    rigid_point,
)
from fe_drivetrain.elasticity.mesh import Block, brick, joined
from fe_drivetrain.elasticity.operator import assemble
from fe_drivetrain.elasticity.solve import TOLERANCE, System, factorise, multigrid, reduce

OPTIONS = multigrid.Options(coarsest=50)
"""Few nodes are left to the dense factor, so that small meshes have the levels of large ones."""

E = 200e9


@dataclass(frozen=True)
class Series:
    """Bodies one behind the other, from what is held to what is loaded.

    Attributes
    ----------
    block : Block
        The mesh of all.
    parts : tuple[sparse.bsr_array, ...]
        Stiffness of each body with Young's modulus `E`, in 3x3 blocks [N/m].
    members : Ints
        (n_cells,) which body each cell belongs to.
    support : Constraint
        What is held.
    end : Constraint
        (n,) nodes of the loaded face, rigid.
    load : int
        Component of the load at the end's reference point at the origin of the face, 0-5.
    centre : Floats
        (3,) of that point [m].
    """

    block: Block
    parts: tuple[sparse.bsr_array, ...]
    members: Ints
    support: Constraint
    end: Constraint
    load: int
    centre: Floats

    def bodies(self) -> Bodies:
        """Each body by itself, for a picture."""
        cells = (self.block.cells[self.members == k] for k in range(len(self.parts)))
        return Bodies(self.block.points, tuple(cells), ())

    def system(self, moduli: Sequence[float], rigid: Sequence[int] = ()) -> tuple[System, Floats]:
        """System and load of 1 N or N m.

        Parameters
        ----------
        moduli : Sequence[float]
            Modulus of each body over `E`; those of rigid ones do not count.
        rigid : Sequence[int]
            Bodies that are rigid: eliminated.
        """
        n = 3 * len(self.block.points)
        total = n + 6 * (1 + len(rigid))
        K = sum(
            float(modulus) * part
            for body, (modulus, part) in enumerate(zip(moduli, self.parts, strict=True))
            if body not in rigid
        )
        K = _enlarged(K, total)
        points, cells = self.block.points, self.block.cells
        end = np.unique(self.end.pivots // 3)
        held = fixed("support", np.unique(self.support.pivots // 3), total)
        load_point = rigid_point("end", self.centre, n, total)
        constraints = [held]
        loaded = load_point
        taken = end
        for k, body in enumerate(rigid):
            nodes = np.unique(cells[self.members == body])
            point = rigid_point(f"body {body}", self.centre, n + 6 * (1 + k), total)
            if np.isin(end, nodes).all():
                loaded = point
                taken = np.empty(0, dtype=np.int64)
            constraints.append(rigid_face(f"body {body}", nodes, points, point))
        if len(taken):
            constraints.append(rigid_face("end", taken, points, load_point))
        else:  # the loaded face is a face of a rigid body, and its own point has nothing to do
            constraints.append(_still(n, total))
        elimination = eliminate(constraints, total)
        F = np.zeros((total, 1))
        F[:, 0] = loaded.motion[[self.load]].toarray()[0]
        return reduce(points, cells, K, elimination), np.asarray(elimination.T.T @ F)


def _still(first: int, total: int) -> Constraint:
    columns = first + np.arange(6)
    rows = sparse.csr_array((np.ones(6), (np.arange(6), columns)), shape=(6, total))
    return Constraint("unused", rows, columns)


def _enlarged(K: sparse.bsr_array, total: int) -> sparse.bsr_array:
    blocks = total // 3
    indptr = np.concatenate(
        [K.indptr, np.full(blocks + 1 - len(K.indptr), K.indptr[-1], dtype=K.indptr.dtype)]
    )
    return sparse.bsr_array((K.data, K.indices, indptr), shape=(total, total))


def ring() -> Series:
    """A hollow shaft in a ring, held outside and twisted from inside; the ring is body 0.

    In hexahedra of eight nodes, one along the axis, all nodes of a circle are equal by symmetry and
    turn equally: the two bodies are springs in series exactly, on any mesh.
    """
    bore, seat, outside, width = 0.1, 0.2, 0.3, 0.1

    def shape(unit: Floats) -> Floats:
        r = bore + (outside - bore) * unit[:, 0]
        angle = 2.0 * np.pi * unit[:, 1]
        return np.column_stack([width * unit[:, 2], r * np.cos(angle), r * np.sin(angle)])

    block = joined(brick((6, 24, 1), 8, shape))
    radius = np.hypot(*block.points[:, 1:].T)
    members = np.where(radius[block.cells].mean(axis=1) > seat, 0, 1)
    lame = (E * 0.3 / (1.3 * 0.4), E / 2.6)
    n = block.points.size
    inner, outer = (np.flatnonzero(np.abs(radius - r) < 1e-9) for r in (bore, outside))
    return Series(
        block,
        _parts(block, members, 2, lame),
        members,
        fixed("support", outer, n),
        fixed("end", inner, n),
        3,
        np.array([0.5 * width, 0.0, 0.0]),
    )


def chain(count: int, across: int = 1) -> Series:
    """A bar of cubes, one behind the other, pulled; without lateral contraction.

    Parameters
    ----------
    count : int
        Cubes.
    across : int
        Elements across each.
    """
    block = brick(
        (across * count, across, across), 8, lambda unit: unit * np.array([float(count), 1.0, 1.0])
    )
    members = np.floor(block.points[block.cells, 0].mean(axis=1)).astype(np.int64)
    n = block.points.size
    return Series(
        block,
        _parts(block, members, count, (0.0, 0.5 * E)),
        members,
        fixed("support", block.face_nodes("x0"), n),
        fixed("end", block.face_nodes("x1"), n),
        0,
        np.array([float(count), 0.5, 0.5]),
    )


def _parts(
    block: Block, members: Ints, count: int, lame: tuple[float, float]
) -> tuple[sparse.bsr_array, ...]:
    return tuple(
        assemble(block.points, block.cells[members == body], lame) for body in range(count)
    )


@dataclass(frozen=True)
class Answer:
    """What a solver makes of it.

    Attributes
    ----------
    compliance : float
        Motion of the load per unit load; NaN where the solver refuses.
    iterations : int
        Number of iterations of multigrid.
    arrived : bool
        Whether the iteration says that it got there; True of a direct solver.
    """

    compliance: float
    iterations: int = 0
    arrived: bool = True


def direct(system: System, F: Floats) -> Answer:
    """By SuperLU, as the program does."""
    try:
        found = factorise(system, "superlu").solve(F)
    except InputError:
        return Answer(float("nan"))
    return Answer(float(F[:, 0] @ found.x[:, 0]))


def iterated(system: System, F: Floats) -> Answer:
    """By multigrid alone, without the direct factor that the program falls back to."""
    try:
        hierarchy = multigrid.build(system, OPTIONS)
    except InputError:
        return Answer(float("nan"), 0, False)
    found = multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, TOLERANCE)
    arrived = found.energy_error <= TOLERANCE
    return Answer(float(F[:, 0] @ found.x[:, 0]), found.iterations, arrived)
