"""A preconditioner for thin and slender solids: patches solved apart, soft motions together.

Two-level Schwarz method with a spectral coarse space (GenEO: Spillane, Dolean, Hauret, Nataf,
Pechstein and Scheichl 2014, Numer. Math. 126, 741-770). The solid is cut into patches, each solved
exactly with its neighbours held. What that misses are motions that cost little once a patch is cut
out: rigid ones, the bending of a wall, the ovalisation of a tube. Each patch shows its own, by the
eigenvalue problem

    S v = lambda K v        (S: the patch cut out; K: the patch with its neighbours held)

and all v with lambda below a threshold span the coarse space, solved directly. The number of
iterations is bounded by the threshold and by how many patches meet at a place, not by slenderness,
thinness, contrast, or size (theorem 3.22 there); where a solid is soft, the coarse space grows
instead.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numba import prange
from numpy.typing import NDArray
from scipy import linalg, sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.compiled import njit
from fe_drivetrain.common.errors import SINGULAR, InputError
from fe_drivetrain.common.threads import one_blas_thread
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.solve import direct_solvers
from fe_drivetrain.elasticity.solve.reduction import System
from fe_drivetrain.elasticity.solve.subdomains import (
    CutOut,
    Partition,
    dense_part,
    partition,
    reaches_out,
)

Index = NDArray[np.int32]


@dataclass(frozen=True)
class Options:
    """Options of patches and coarse space; ``cases/stability/thin_walls.py`` shows others.

    Attributes
    ----------
    nodes : int
        Number of nodes of a patch, approximately.
    threshold : float
        Eigenvalues below it belong to the coarse space.
    """

    nodes: int = 100
    threshold: float = 0.1


DEFAULTS = Options()


@dataclass(frozen=True)
class Schwarz:
    """Factors of all patches, the coarse space, and its factor.

    Attributes
    ----------
    K : sparse.bsr_array
        The stiffness.
    partition : Partition
        Partition of the node blocks into patches.
    factors, factor_starts : Floats, Ints
        Lower Cholesky factors of the patches, row after row, and where each begins.
    modes, mode_starts : Floats, Ints
        Coarse basis, (3 blocks, n_modes) of each patch, flat, and where each begins.
    counts : Ints
        (n_patches,) modes of each patch.
    coarse : direct_solvers.Factor
        Factor of the stiffness in the coarse space.
    """

    K: sparse.bsr_array
    partition: Partition
    factors: Floats
    factor_starts: Ints
    modes: Floats
    mode_starts: Ints
    counts: Ints
    coarse: direct_solvers.Factor

    @property
    def n_coarse(self) -> int:
        """Dimension of the coarse space."""
        return int(self.counts.sum())

    @property
    def bytes(self) -> int:
        """Memory beside the stiffness."""
        return int(self.factors.nbytes + self.modes.nbytes + self.coarse.bytes)

    def precondition(self, R: Floats) -> Floats:
        """Coarse space, patches, coarse space again, for all columns of R; symmetric positive."""
        K = self.K
        X = self._coarse(R)
        left, Z = np.empty_like(R), np.empty_like(R)
        kernels.residual(K.indptr, K.indices, K.data, X, R, left)
        parts = self.partition
        solve_patches(parts.blocks, parts.starts, self.factors, self.factor_starts, left, Z)
        X += Z
        kernels.residual(K.indptr, K.indices, K.data, X, R, left)
        return X + self._coarse(left)

    def _coarse(self, R: Floats) -> Floats:
        parts = self.partition
        first = np.concatenate([[0], np.cumsum(self.counts)])
        where = parts.blocks, parts.starts, self.modes, self.mode_starts, first
        small = np.zeros((self.n_coarse, R.shape[1]))
        restrict(*where, R, small)
        X = np.empty_like(R)
        prolong(*where, np.ascontiguousarray(self.coarse.apply(small)), X)
        return X


def build(system: System, options: Options = DEFAULTS) -> Schwarz:
    """Patches and coarse space of a system.

    Raises
    ------
    InputError
        The system is singular, or it is not known what it was made of.
    """
    if system.elements is None:
        raise InputError(
            "solver 'schwarz' cuts a solid into patches of elements, and this system has none: "
            "use 'multigrid' or a direct solver"
        )
    K = system.K
    parts = partition(system.elements, options.nodes, K.shape[0] // 3)
    # Matrices are small: threads of BLAS only wait for each other.
    with one_blas_thread():
        found = _patches(system, parts, options)
        factors, modes = (np.concatenate([f[k].ravel() for f in found]) for k in (0, 1))
        counts = np.array([f[1].shape[1] for f in found])
        factor_starts, mode_starts = (
            np.concatenate([[0], np.cumsum([f[k].size for f in found])[:-1]]) for k in (0, 1)
        )
        coarse = _coarse_stiffness(K, parts, modes, mode_starts, counts)
    method = next(m for m in ("cholmod", "pardiso", "superlu") if direct_solvers.is_installed(m))
    factor = direct_solvers.factorise(coarse, method)
    return Schwarz(K, parts, factors, factor_starts, modes, mode_starts, counts, factor)


def _patches(system: System, parts: Partition, options: Options) -> list[tuple[Floats, Floats]]:
    """Packed factor and coarse modes of each patch."""
    assert system.elements is not None
    K, free, cut_out = system.K, system.elements.free, CutOut(system.elements)
    place = np.full(K.shape[0] // 3, -1)
    found = []
    for patch in range(len(parts)):
        own = parts.blocks_of(patch)
        place[own] = np.arange(len(own))
        A = dense_part(K.indptr, K.indices, K.data, own, place)
        edge = np.repeat(reaches_out(K.indptr, K.indices, own, place), 3)
        place[own] = -1
        try:
            L = np.asarray(np.linalg.cholesky(A), dtype=np.float64)
        except np.linalg.LinAlgError as error:
            raise InputError(SINGULAR) from error
        S = cut_out.stiffness(parts.cells_of(patch), own)
        gone = np.flatnonzero(~free[(3 * own[:, None] + np.arange(3)).ravel()])
        S[gone, gone] = A[gone, gone]
        # What its elements do not hold, such as a spring's end, is no inner degree of freedom
        # either.
        edge |= S.diagonal() < 0.5 * A.diagonal()
        found.append((L[np.tril_indices(len(L))], soft_modes(S, A, edge, options.threshold)))
    return found


def soft_modes(S: Floats, A: Floats, edge: NDArray[np.bool_], threshold: float) -> Floats:
    """Motions (n, m) of a patch that cost little once it is cut out, of unit energy held.

    Cut out and held, a patch differs at its edge alone, by E. With A = S + E the problem is E v =
    (1 - lambda) A v, and inner degrees of freedom follow the edge: where they stand first in the
    factor of A, its last block is that of what the edge feels. The inner part is taken from S
    alone, so that rigid motions cost nothing to the last digit, however well S is known.

    Parameters
    ----------
    S, A : Floats
        Stiffness (n, n), cut out and held.
    edge : NDArray[np.bool_]
        Flags (n,): degrees of freedom in which they differ.
    threshold : float
        Threshold of lambda.
    """
    order = np.argsort(edge, kind="stable")
    n_inner = int((~edge).sum())
    here = np.ix_(order, order)
    E = (A[here] - S[here])[n_inner:, n_inner:]
    held = S[here]
    held[n_inner:, n_inner:] += E
    try:
        L = np.linalg.cholesky(held)
    except np.linalg.LinAlgError:
        if n_inner == 0:
            raise
        return soft_modes(S, A, np.ones_like(edge), threshold)
    rim = L[n_inner:, n_inner:]
    half = linalg.solve_triangular(rim, E, lower=True)
    M = linalg.solve_triangular(rim, half.T, lower=True)
    _, w = linalg.eigh(0.5 * (M + M.T), subset_by_value=(1.0 - threshold, np.inf))
    v = np.zeros((len(A), w.shape[1]))
    v[n_inner:] = w
    modes = np.empty_like(v)
    modes[order] = linalg.solve_triangular(L, v, lower=True, trans="T")
    return modes


def _coarse_stiffness(
    K: sparse.bsr_array, parts: Partition, modes: Floats, mode_starts: Ints, counts: Ints
) -> sparse.csr_array:
    first = np.concatenate([[0], np.cumsum(counts)])
    place = np.empty(len(parts.patch), dtype=np.int64)
    place[parts.blocks] = np.arange(len(parts.blocks)) - np.repeat(
        parts.starts[:-1], np.diff(parts.starts)
    )
    basis = PatchModes(modes, mode_starts, counts)
    rows, columns, values = [], [], []
    for patch, own, around in _neighbours(K, parts):
        slot = np.full(len(parts), -1)
        width = counts[around]
        slot[around] = np.concatenate([[0], np.cumsum(width)[:-1]])
        moved = np.zeros((3 * len(own), int(width.sum())))
        times_modes(K.indptr, K.indices, K.data, own, parts.patch, place, basis, slot, moved)
        start = mode_starts[patch]
        v = modes[start : start + 3 * len(own) * counts[patch]].reshape(3 * len(own), -1)
        block = v.T @ moved
        column = np.concatenate([np.arange(first[j], first[j + 1]) for j in around])
        row = np.arange(first[patch], first[patch + 1])
        rows.append(np.repeat(row, len(column)))
        columns.append(np.tile(column, len(row)))
        values.append(block.ravel())
    n = int(first[-1])
    entries = np.concatenate(values), (np.concatenate(rows), np.concatenate(columns))
    found = sparse.csr_array(entries, shape=(n, n))
    return (0.5 * (found + found.T)).tocsr()


def _neighbours(K: sparse.bsr_array, parts: Partition) -> Iterator[tuple[int, Ints, Ints]]:
    """Each patch, its blocks, and the patches that the stiffness couples it with, itself too."""
    for patch in range(len(parts)):
        own = parts.blocks_of(patch)
        touched = np.concatenate([K.indices[K.indptr[b] : K.indptr[b + 1]] for b in own])
        yield patch, own, np.unique(parts.patch[touched])


class PatchModes(NamedTuple):
    """Modes of all patches, where those of each begin, and how many it has; see `Schwarz`."""

    values: Floats
    starts: Ints
    counts: Ints


@njit(cache=True)
def times_modes(
    indptr: Index,
    indices: Index,
    data: Floats,
    own: Ints,
    patch: Ints,
    place: Ints,
    basis: PatchModes,
    slot: Ints,
    out: Floats,
) -> None:
    """Rows of K times the modes of all patches that they reach, patches side by side in ``out``.

    Parameters
    ----------
    own : Ints
        Node blocks whose rows are taken.
    patch, place : Ints
        Patch (n_blocks,) of each block, and its place in the patch.
    basis : PatchModes
        Modes of the patches.
    slot : Ints
        First column (n_patches,) of each patch in ``out``.
    """
    modes, mode_starts, counts = basis
    for a in range(len(own)):
        for p in range(indptr[own[a]], indptr[own[a] + 1]):
            c = indices[p]
            j = patch[c]
            m = counts[j]
            start = mode_starts[j] + 3 * place[c] * m
            for i in range(3):
                for k in range(3):
                    value = data[p, i, k]
                    for q in range(m):
                        out[3 * a + i, slot[j] + q] += value * modes[start + k * m + q]


@njit(cache=True, parallel=True, fastmath=True)
def solve_patches(
    blocks: Ints, starts: Ints, factors: Floats, factor_starts: Ints, R: Floats, out: Floats
) -> None:
    """Solve on every patch, its neighbours held, for all columns of R."""
    m = R.shape[1]
    for patch in prange(len(starts) - 1):
        n = 3 * (starts[patch + 1] - starts[patch])
        Y = np.empty((n, m))
        for i in range(n):
            b = 3 * blocks[starts[patch] + i // 3] + i % 3
            for k in range(m):
                Y[i, k] = R[b, k]
        row = factor_starts[patch]
        for i in range(n):
            for j in range(i):
                value = factors[row + j]
                for k in range(m):
                    Y[i, k] -= value * Y[j, k]
            for k in range(m):
                Y[i, k] /= factors[row + i]
            row += i + 1
        for i in range(n - 1, -1, -1):
            row -= i + 1
            for k in range(m):
                Y[i, k] /= factors[row + i]
            for j in range(i):
                value = factors[row + j]
                for k in range(m):
                    Y[j, k] -= value * Y[i, k]
        for i in range(n):
            b = 3 * blocks[starts[patch] + i // 3] + i % 3
            for k in range(m):
                out[b, k] = Y[i, k]


@njit(cache=True, parallel=True)
def restrict(
    blocks: Ints,
    starts: Ints,
    modes: Floats,
    mode_starts: Ints,
    first: Ints,
    R: Floats,
    out: Floats,
) -> None:
    """Components of R along the modes, into ``out`` (zero before)."""
    for patch in prange(len(starts) - 1):
        m = first[patch + 1] - first[patch]
        for a in range(3 * (starts[patch + 1] - starts[patch])):
            b = 3 * blocks[starts[patch] + a // 3] + a % 3
            for q in range(m):
                value = modes[mode_starts[patch] + a * m + q]
                for k in range(R.shape[1]):
                    out[first[patch] + q, k] += value * R[b, k]


@njit(cache=True, parallel=True)
def prolong(
    blocks: Ints,
    starts: Ints,
    modes: Floats,
    mode_starts: Ints,
    first: Ints,
    small: Floats,
    out: Floats,
) -> None:
    """Modes times their components."""
    for patch in prange(len(starts) - 1):
        m = first[patch + 1] - first[patch]
        for a in range(3 * (starts[patch + 1] - starts[patch])):
            b = 3 * blocks[starts[patch] + a // 3] + a % 3
            for k in range(small.shape[1]):
                out[b, k] = 0.0
            for q in range(m):
                value = modes[mode_starts[patch] + a * m + q]
                for k in range(small.shape[1]):
                    out[b, k] += value * small[first[patch] + q, k]
