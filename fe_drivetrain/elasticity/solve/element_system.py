"""A system whose stiffness nobody has assembled: its elements, constraints and springs.

Processes of `petsc` assemble their rows of it, so that no process has the whole matrix.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from scipy import sparse
from scipy.linalg import block_diag

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.interfaces.constraints import Elimination, ReferencePoint
from fe_drivetrain.elasticity.mesh.bodies import connected_bodies
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator.incompressible import (
    assemble_unlocked,
    full_rule,
    unlocked_functions,
)
from fe_drivetrain.elasticity.solve.rank_rows import Reduction, Share
from fe_drivetrain.elasticity.solve.reduction import System, motions_with_points, reduce
from fe_drivetrain.elasticity.solve.sums import Sums, sums_of

Springs = Sequence[tuple[ReferencePoint, Floats]]


@dataclass(frozen=True)
class ElementSystem:
    """K q = T^T f of elements, constraints and springs.

    Attributes
    ----------
    points : Floats
        (n_nodes, 3) [m].
    parts : Sequence[tuple[Ints, tuple[float, float]]]
        Cells (n_cells, k) of each material, all of one kind, and its Lame's constants [Pa].
    elimination : Elimination
        The constraints.
    springs : Sequence[tuple[ReferencePoint, Floats]]
        Reference points with their (6, 6) stiffness [N/m, N, N m/rad].
    """

    points: Floats
    parts: Sequence[tuple[Ints, tuple[float, float]]]
    elimination: Elimination
    springs: Springs = ()

    __repr__ = short_repr

    @property
    def n_blocks(self) -> int:
        """Nodes, and blocks of three degrees of freedom of reference points."""
        return len(self.elimination.free) // 3

    @property
    def n_free(self) -> int:
        """Number of degrees of freedom that are left."""
        return int(self.elimination.free.sum())

    @cached_property
    def cells(self) -> Ints:
        """(n_cells, k) of all materials."""
        return np.vstack([cells for cells, _ in self.parts])

    @cached_property
    def body(self) -> Ints:
        """(n_blocks,) which body each belongs to, -1 of reference points."""
        body = np.full(self.n_blocks, -1)
        body[: len(self.points)] = connected_bodies(self.cells, len(self.points))
        return body

    @cached_property
    def sums(self) -> Sums | None:
        """Joints that take means over faces; None where there are none."""
        constraints = self.elimination.constraints
        means = [c.is_mean for c in constraints] + [point.is_mean for point, _ in self.springs]
        return sums_of(self.elimination, self.springs) if any(means) else None

    def motions(self, apart: bool) -> Floats:
        """(n, 6) rigid motions; of bodies without their joints that take means where ``apart``."""
        sums = self.sums if apart else None
        return motions_with_points(
            self.points, self.elimination if sums is None else sums.elimination
        )

    def whole(self) -> System:
        """The system assembled, here and all of it; see `reduction.reduce`."""
        n = len(self.elimination.free)
        K = sum(assemble_unlocked(self.points, cells, lame, n) for cells, lame in self.parts)
        for point, k in self.springs:
            K = K + (point.motion.T @ sparse.csr_array(k) @ point.motion).tobsr((3, 3))
        return reduce(self.points, self.cells, K, self.elimination, self.springs)


@dataclass(frozen=True)
class Cut:
    """An element system in parts.

    Attributes
    ----------
    system : ElementSystem
        System that is cut.
    order : Ints
        Blocks (n_blocks,) in the order of the parts.
    starts : Ints
        Places (count + 1,) where each part begins in ``order``.
    apart : bool
        Whether shares are to know the bodies without joints that take means, too.
    """

    system: ElementSystem
    order: Ints
    starts: Ints
    apart: bool

    __repr__ = short_repr

    def __len__(self) -> int:
        return len(self.starts) - 1

    @cached_property
    def cells_of(self) -> sparse.csc_array:
        """(n_cells, count) which elements the rows of each part come from."""
        system, n = self.system, len(self.system.points)
        owner = np.empty(system.n_blocks, dtype=np.int32)
        owner[self.order] = np.repeat(np.arange(len(self)), np.diff(self.starts))
        each = np.arange(system.n_blocks)
        own = sparse.csr_array(
            (np.ones(len(each), bool), (each, owner)), shape=(len(each), len(self))
        )
        reached = (own + self._followed @ own).tocsr()[:n]
        n_cells, k = system.cells.shape
        touched = sparse.csr_array(
            (np.ones(n_cells * k, bool), system.cells.ravel(), k * np.arange(n_cells + 1)),
            shape=(n_cells, n),
        )
        return (touched @ reached).tocsc()

    @property
    def halo(self) -> float:
        """Elements that are integrated once more than they would be by one process, as a share."""
        return float(self.cells_of.nnz / len(self.system.cells) - 1.0)

    @cached_property
    def _eliminations(self) -> tuple[Elimination, ...]:
        sums = self.system.sums if self.apart else None
        first = self.system.elimination
        return (first,) if sums is None else (first, sums.elimination)

    @cached_property
    def _followed(self) -> sparse.csr_array:
        """(n_blocks, n_blocks) which blocks each follows by constraints."""
        n = self.system.n_blocks
        found = sparse.csr_array((n, n), dtype=bool)
        for elimination in self._eliminations:
            T = elimination.T.tocoo()
            rows, columns = T.coords
            ones = np.ones(len(rows), bool)
            found = found + sparse.csr_array((ones, (rows // 3, columns // 3)), shape=(n, n))
        return found.tocsr()

    def shares(self) -> Iterator[tuple[Share, tuple[Reduction, ...]]]:
        """Share of each part, in turn: what it makes its rows of.

        Yields
        ------
        share, reductions
            Share with all constraints, and, where it is ``apart``, of bodies without joints that
            take means.
        """
        system, order = self.system, self.order
        n_nodes = len(system.points)
        place = np.empty_like(order)
        place[order] = np.arange(len(order))
        k = system.cells.shape[1]
        rule = full_rule(element_kind(k))
        lame = np.array([constants for _, constants in system.parts])
        functions = np.array([unlocked_functions(k, (lam, mu)) for lam, mu in lame.tolist()])
        material = np.repeat(np.arange(len(lame)), [len(cells) for cells, _ in system.parts])
        springs = self._springs()
        reach = self.cells_of
        for part, (low, high) in enumerate(zip(self.starts[:-1], self.starts[1:], strict=True)):
            chosen = np.sort(reach.indices[reach.indptr[part] : reach.indptr[part + 1]])
            cells = system.cells[chosen]
            nodes = np.unique(cells)
            there = [nodes, self._followed[nodes].indices, order[low:high]]
            blocks = np.sort(place[np.unique(np.concatenate(there))])
            old = order[blocks]
            points = np.zeros((len(blocks), 3))
            points[old < n_nodes] = system.points[old[old < n_nodes]]
            local = np.searchsorted(blocks, place[cells])
            share = Share(
                blocks,
                int(low),
                int(high),
                points,
                local,
                material[chosen],
                lame,
                functions,
                rule,
                system.body[old],
            )
            dofs = (3 * old[:, None] + np.arange(3)).ravel()
            reductions = tuple(
                Reduction(_within(e.T, dofs, place, blocks), e.free[dofs], *spring, grounded[dofs])
                for e, spring, grounded in zip(
                    self._eliminations, springs, self._grounded, strict=True
                )
            )
            yield share, reductions

    @cached_property
    def _grounded(self) -> tuple[Bools, ...]:
        none = np.zeros(3 * self.system.n_blocks, bool)
        if len(self._eliminations) == 1 or self.system.sums is None:
            return (none,)
        return none, np.diff(self.system.sums.rows.tocsc().indptr) > 0

    def _springs(self) -> list[tuple[sparse.csr_array, Floats, float]]:
        """Reduced motions, stiffness and trace of the springs, for each elimination."""
        dofs = (3 * self.order[:, None] + np.arange(3)).ravel()
        all_springs = list(self.system.springs)
        kinds = [all_springs, [(p, k) for p, k in all_springs if not p.is_mean]]
        found = []
        for elimination, springs in zip(self._eliminations, kinds, strict=False):
            motions = sparse.vstack(
                [sparse.csr_array((0, len(dofs))), *(point.motion for point, _ in springs)],
                format="csr",
            )
            stiffness = block_diag(np.zeros((0, 0)), *(k for _, k in springs))
            trace = float(((motions @ motions.T).toarray() * stiffness).sum())
            reduced = (motions @ elimination.T).tocsc()[:, dofs].tocsr()
            found.append((reduced, stiffness, trace))
        return found


def _within(T: sparse.csr_array, dofs: Ints, place: Ints, blocks: Ints) -> sparse.csr_array:
    """Rows of some degrees of freedom, and of their columns those of some blocks (ascending)."""
    rows = T[dofs].tocoo()
    row, column = rows.coords
    at = place[column // 3]
    local = np.searchsorted(blocks, at)
    kept = blocks[np.minimum(local, len(blocks) - 1)] == at
    here = 3 * local[kept] + column[kept] % 3
    return sparse.csr_array((rows.data[kept], (row[kept], here)), shape=(len(dofs), len(dofs)))


def cut(system: ElementSystem, count: int, apart: bool = True) -> Cut:
    """Cut a system into parts of equally many nodes; see `parts`.

    Parameters
    ----------
    system : ElementSystem
        The system.
    count : int
        Number of parts.
    apart : bool
        Whether shares are to know the bodies without joints that take means, too, see `Cut`.
    """
    n = len(system.points)
    # reference points have no place, and go with the last part
    order = np.concatenate([parts(system.points, count), np.arange(n, system.n_blocks)])
    starts = np.concatenate([[0], np.cumsum(sizes(n, count))])
    starts[-1] = system.n_blocks
    return Cut(system, order, starts, apart)


def sizes(n: int, count: int) -> Ints:
    """(count,) of equal parts; the first ones have one more where they are not equal."""
    each, more = divmod(n, count)
    return np.asarray(np.where(np.arange(count) < more, each + 1, each), dtype=np.int64)


def parts(points: Floats, count: int) -> Ints:
    """Order of points in which ``count`` equal runs of them are compact parts.

    They are halved across their maximum length, and each half again (recursive coordinate
    bisection).

    Parameters
    ----------
    points : Floats
        Points (n, 3) [m].
    count : int
        Number of parts, see `sizes`.

    Returns
    -------
    Ints
        Numbers (n,) of the points.
    """

    def halves(chosen: Ints, of: Ints) -> list[Ints]:
        if len(of) == 1:
            return [chosen]
        here = points[chosen]
        axis = int(np.argmax(np.ptp(here, axis=0))) if len(here) else 0
        order = chosen[np.argsort(here[:, axis], kind="stable")]
        middle = len(of) // 2
        left = int(of[:middle].sum())
        return halves(order[:left], of[:middle]) + halves(order[left:], of[middle:])

    return np.concatenate(halves(np.arange(len(points)), sizes(len(points), count)))
