"""Patches of a solid: which nodes belong together, and what each is like when it is cut out.

A patch is a handful of elements that lie together. Cut out along them, it is held by nothing but
its supports, and its softest motions are those that a solver must know of the whole solid.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, sparse

from fe_drivetrain.common.arrays import CHUNK, Floats, Ints, chunks
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.common.errors import SINGULAR, InputError
from fe_drivetrain.elasticity.mesh.mapping import jacobian
from fe_drivetrain.elasticity.mesh.shapes import element_kind
from fe_drivetrain.elasticity.operator import element_loops
from fe_drivetrain.elasticity.solve.reduction import Elements

_DIGITS = 3
_WIDE = 12  # degrees of freedom that an eliminated one may depend on, in elements that count
_LOOSE = (1e-14, 1e-12, 1e-10, 1e-8, 1e-6)  # of the mean diagonal, ascending


@dataclass(frozen=True)
class Partition:
    """Node blocks in patches, and the elements that each is cut out along.

    Attributes
    ----------
    patch : Ints
        Patch (n_blocks,) of each node block.
    blocks, starts : Ints
        Blocks in the order of their patches, and the place (n_patches + 1,) where each patch
        begins.
    cells, cell_starts : Ints
        The same of elements. Patches of reference points have none.
    """

    patch: Ints
    blocks: Ints
    starts: Ints
    cells: Ints
    cell_starts: Ints

    def __len__(self) -> int:
        return len(self.starts) - 1

    def blocks_of(self, patch: int) -> Ints:
        """Node blocks of a patch, ascending."""
        return self.blocks[self.starts[patch] : self.starts[patch + 1]]

    def cells_of(self, patch: int) -> Ints:
        """Elements that it is cut out along."""
        return self.cells[self.cell_starts[patch] : self.cell_starts[patch + 1]]


def partition(elements: Elements, nodes: int, n_blocks: int) -> Partition:
    """Cut a solid into patches, each time across its maximum length.

    Parameters
    ----------
    elements : Elements
        Elements of the solid.
    nodes : int
        Number of nodes of a patch, approximately.
    n_blocks : int
        Number of node blocks of the system: what comes after the nodes makes patches of its own.
    """
    points, cells = elements.points, elements.cells
    each = max(1, round(nodes * len(cells) / len(points)))
    of_cell = _bisected(points[cells].mean(axis=1), each)
    patch = np.empty(n_blocks, dtype=np.int64)
    patch[: len(points)] = of_cell.max() + 1
    np.minimum.at(patch, cells.ravel(), np.repeat(of_cell, cells.shape[1]))
    # Reference points have two blocks each.
    patch[len(points) :] = of_cell.max() + 2 + np.arange(n_blocks - len(points)) // 2
    there, patch = np.unique(patch, return_inverse=True)
    order = np.argsort(of_cell, kind="stable")
    ends = np.searchsorted(of_cell[order], np.arange(there[-1] + 2))
    first, last = ends[there], ends[there + 1]
    kept = [order[a:b] for a, b in zip(first, last, strict=True)]
    cell_starts = np.concatenate([[0], np.cumsum(last - first)])
    blocks = np.argsort(patch, kind="stable")
    starts = np.searchsorted(patch[blocks], np.arange(len(there) + 1))
    return Partition(patch, blocks, starts, np.concatenate(kept), cell_starts)


def _bisected(centres: Floats, each: int) -> Ints:
    """Part of each centre, for parts of about equal numbers: halved across the maximum length."""
    part = np.zeros(len(centres), dtype=np.int64)
    waiting, count = [np.arange(len(centres))], 0
    while waiting:
        some = waiting.pop()
        pieces = -(-len(some) // each)
        if pieces == 1:
            part[some] = count
            count += 1
            continue
        offset = centres[some] - centres[some].mean(axis=0)
        along = offset @ np.linalg.eigh(offset.T @ offset)[1][:, -1]
        cut = (pieces // 2) * len(some) // pieces
        order = np.argpartition(along, cut)
        waiting += [some[order[:cut]], some[order[cut:]]]
    return part


def shown_lame(elements: Elements) -> Floats:
    """Lame's constants (n_cells, 2) [Pa] that the diagonal blocks of a stiffness show.

    At a node that is inside one material the block is lambda H + mu (H^T + tr H I), with H the
    integral of the outer product of the gradient of its shape function: two unknowns in nine
    equations. An element takes what fits best at its nodes. Only as good as its best node, which
    is enough to tell soft motions from stiff ones.
    """
    points, cells = elements.points, elements.cells
    kind = element_kind(cells.shape[1])
    gradients, weights = kind.table(2 if kind.n_corners == 4 else kind.degree)
    H = np.zeros((len(points), 3, 3))
    for rows in chunks(len(cells), CHUNK // 4):
        some = cells[rows]
        physical, determinant = jacobian(points, some, gradients)
        weighted = physical * (np.abs(determinant) * weights)[..., None, None]
        each = np.einsum("eqia,eqja->eaij", weighted, physical, optimize=True)
        np.add.at(H, some.ravel(), each.reshape(-1, 3, 3))
    first = H.reshape(-1, 9)
    trace = np.einsum("nii->n", H)
    second = (H.transpose(0, 2, 1) + trace[:, None, None] * np.eye(3)).reshape(-1, 9)
    K = elements.diagonal.reshape(-1, 9)
    pairs = ((first, first), (first, second), (second, second), (first, K), (second, K))
    aa, ab, bb, ak, bk = (np.einsum("nk,nk->n", a, b) for a, b in pairs)
    determinant = aa * bb - ab * ab
    tiny = determinant <= 1e-14 * aa * bb
    determinant[tiny] = 1.0
    lam, mu = (bb * ak - ab * bk) / determinant, (aa * bk - ab * ak) / determinant
    misfit = np.linalg.norm(lam[:, None] * first + mu[:, None] * second - K, axis=1)
    misfit /= np.maximum(np.linalg.norm(K, axis=1), 1e-300)
    misfit[tiny | (mu <= 0.0) | (lam < 0.0)] = np.inf
    best = cells[np.arange(len(cells)), misfit[cells].argmin(axis=1)]
    found = np.column_stack([lam[best], mu[best]])
    # Where no node fits, as little as any material has.
    poor = ~np.isfinite(misfit[best])
    found[poor] = found[~poor].min(axis=0) if not poor.all() else 0.0
    scale = 10.0 ** (np.floor(np.log10(np.maximum(found, 1e-300))) - _DIGITS + 1)
    return np.asarray(np.round(found / scale) * scale)


class CutOut:
    """Stiffness of patches of a solid, cut out."""

    def __init__(self, elements: Elements) -> None:
        self._elements = elements
        self._lame = shown_lame(elements)
        kind = element_kind(elements.cells.shape[1])
        self._table = kind.table(2 if kind.n_corners == 4 else kind.degree)
        counts = np.diff(elements.T.indptr)
        bare = elements.free & (counts == 1)
        self._plain = bare.reshape(-1, 3).all(axis=1)
        self._wide = (counts > _WIDE).reshape(-1, 3).any(axis=1)

    def stiffness(self, cells: Ints, blocks: Ints) -> Floats:
        """Stiffness (3 k, 3 k) of elements, as the degrees of freedom of some node blocks feel it.

        Degrees of freedom of these elements in other blocks are condensed out.

        Parameters
        ----------
        cells : Ints
            Numbers of the elements.
        blocks : Ints
            Numbers (k,) of the node blocks, ascending.
        """
        S = np.zeros((3 * len(blocks), 3 * len(blocks)))
        chosen = self._elements.cells[cells]
        kept = ~self._wide[chosen].any(axis=1)
        if not kept.any():
            return S
        chosen = chosen[kept]
        nodes, local = np.unique(chosen, return_inverse=True)
        B = self._assembled(nodes, local.reshape(chosen.shape), self._lame[cells[kept]])
        dofs = (3 * nodes[:, None] + np.arange(3)).ravel()
        if not self._plain[nodes].all():
            rows = self._elements.T[dofs]
            dofs, place = np.unique(rows.indices, return_inverse=True)
            T = sparse.csr_array(
                (rows.data, place, rows.indptr), shape=(len(B), len(dofs))
            ).toarray()
            B = T.T @ B @ T
        at = np.searchsorted(blocks, dofs // 3)
        inside = blocks[np.minimum(at, len(blocks) - 1)] == dofs // 3
        own, other = np.flatnonzero(inside), np.flatnonzero(~inside)
        found = B[np.ix_(own, own)]
        if len(other):
            half = linalg.solve_triangular(
                _factor(B[np.ix_(other, other)]), B[np.ix_(other, own)], lower=True
            )
            found = found - half.T @ half
        where = 3 * at[own] + dofs[own] % 3
        S[np.ix_(where, where)] = found
        return S

    def _assembled(self, nodes: Ints, cells: Ints, lame: Floats) -> Floats:
        n = len(nodes)
        slots = (cells[:, :, None] * n + cells[:, None, :]).astype(np.int32)
        data = np.zeros((n * n, 3, 3))
        cells32 = cells.astype(np.int32)
        points = self._elements.points[nodes]
        for lam, mu in np.unique(lame, axis=0):
            some = np.flatnonzero((lame == (lam, mu)).all(axis=1))
            element_loops.add_elements(points, cells32, some, *self._table, lam, mu, slots, data)
        return data.reshape(n, n, 3, 3).transpose(0, 2, 1, 3).reshape(3 * n, 3 * n)


def _factor(loose: Floats) -> Floats:
    """Lower factor of a matrix that may be singular: then of one a little stiffer.

    Nothing is added where that can be helped: whatever holds a patch, be it 1e-10 of its own
    stiffness, is stiffer than the bending of a shaft a hundred times as long as it is thick.
    """
    for share in (0.0, *_LOOSE):
        try:
            diagonal = share * loose.diagonal().mean() * np.eye(len(loose))
            return np.asarray(np.linalg.cholesky(loose + diagonal))
        except np.linalg.LinAlgError:
            continue
    raise InputError(SINGULAR)


Index = NDArray[np.int32]


@njit(cache=True)
def dense_part(indptr: Index, indices: Index, data: Floats, blocks: Ints, place: Ints) -> Floats:
    """The part of a matrix in blocks that belongs to some of them, dense.

    Parameters
    ----------
    blocks : Ints
        Numbers (k,) of the blocks.
    place : Ints
        Places (n_blocks,) that they go to, -1 of all others.
    """
    k = len(blocks)
    A = np.zeros((3 * k, 3 * k))
    for a in range(k):
        b = blocks[a]
        row = 3 * place[b]
        for p in range(indptr[b], indptr[b + 1]):
            c = place[indices[p]]
            if c >= 0:
                for i in range(3):
                    for j in range(3):
                        A[row + i, 3 * c + j] = data[p, i, j]
    return A


@njit(cache=True)
def reaches_out(indptr: Index, indices: Index, blocks: Ints, place: Ints) -> NDArray[np.bool_]:
    """Which of some blocks a matrix couples with others; (k,)."""
    out = np.zeros(len(blocks), np.bool_)
    for a in range(len(blocks)):
        for p in range(indptr[blocks[a]], indptr[blocks[a] + 1]):
            if place[indices[p]] < 0:
                out[a] = True
                break
    return out
