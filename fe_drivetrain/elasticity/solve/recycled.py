"""Solutions of neighbouring systems, kept as a space in which the next iteration starts.

The best start for K x = f in the span of V is Galerkin's, V (V^T K V)^-1 V^T f: its error is the
least in the energy norm, and orthogonal in energy to V (Saad, Yeung, Erhel and Guyomarc'h 2000,
SIAM J. Sci. Comput. 21, 1909-1926, have it for conjugate gradients on a row of systems). The
tolerance of the iteration stays what it was, so that the answer does not depend on the space.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from scipy import linalg, sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.operator import kernels

MOST = 96
"""Vectors in a space at most."""

ROOM = 2**27
"""Memory of the vectors at most, in bytes; their products take twice as much again."""

#: Share of the energy norm of a solution: what it adds to a space by less is as good as known.
KNOWN = 1e-8

_DEPENDENT = 1e-12  # of the largest eigenvalue: vectors that say nothing new


def _as_it_is(X: Floats) -> Floats:
    return X


@dataclass(frozen=True)
class Start:
    """Where an iteration starts.

    Attributes
    ----------
    x : Floats
        (n, m) Galerkin solutions in a subspace: what they lack is orthogonal to them in energy.
    energies : Floats
        (m,) their squared energy norms.
    least_ratio : float
        What iterations with this preconditioner have shown, see `stopping.energy_error`.
    """

    x: Floats
    energies: Floats
    least_ratio: float = 1.0

    __repr__ = short_repr

    def part(self, columns: slice) -> Start:
        """The same of some columns."""
        return replace(self, x=self.x[:, columns], energies=self.energies[columns])


class Recycled:
    """A space of solutions of neighbouring systems.

    Parameters
    ----------
    most : int
        Vectors at most, and no more than `ROOM` holds; where they are more, those that the last
        solution took least of go.
    known : float
        What a solution adds by less is not kept, relative in the energy norm.
    """

    def __init__(self, most: int = MOST, known: float = KNOWN) -> None:
        self.most, self.known = most, known
        self.least_ratio = 1.0
        self._basis: Floats | None = None
        self._taken = np.zeros(0)
        self._work: Floats | None = None

    @property
    def size(self) -> int:
        """Number of vectors."""
        return 0 if self._basis is None else self._basis.shape[1]

    @property
    def bytes(self) -> int:
        """Memory of the vectors, and of their products."""
        held = (self._basis, self._work)
        return sum(array.nbytes for array in held if array is not None)

    def start(
        self, K: sparse.bsr_array, F: Floats, carried: Callable[[Floats], Floats] = _as_it_is
    ) -> Start | None:
        """Galerkin solutions in the space; None where it is empty.

        Parameters
        ----------
        K : sparse.bsr_array
            Stiffness (n, n), symmetric positive definite.
        F : Floats
            Right-hand sides (n, m).
        carried : callable
            Carries vectors (n, k) that are kept to this system, where its nodes have other places.
        """
        if self._basis is None or self._basis.shape[0] != K.shape[0]:
            self._basis = None
            return None
        V = carried(self._basis)
        G = self._gram(K, V)
        values, vectors = linalg.eigh(0.5 * (G + G.T))
        some = values > _DEPENDENT * values[-1]
        inverse = (vectors[:, some] / values[some]) @ vectors[:, some].T
        right = V.T @ F
        coefficients = inverse @ right
        energies = np.maximum(np.einsum("vm,vm->m", right, coefficients), 0.0)
        shares = coefficients**2 * G.diagonal()[:, None]
        size = np.where(energies > 0.0, energies, 1.0)
        self._taken = (shares / size).max(axis=1)
        return Start(V @ coefficients, energies, self.least_ratio)

    def _gram(self, K: sparse.bsr_array, V: Floats) -> Floats:
        """V^T K V, in memory that is kept: new pages take as long as the products."""
        if self._work is None or self._work.shape[1:] != V.shape:
            self._work = np.zeros((2, *V.shape))
        zero, product = self._work
        kernels.residual(*kernels.pattern_of(K), K.data, V, zero, product)
        return np.asarray(-(V.T @ product))

    def learn(
        self,
        K: sparse.bsr_array,
        x: Floats,
        start: Start | None,
        carried: Callable[[Floats], Floats] = _as_it_is,
    ) -> float:
        """Take up what solutions have that the space did not.

        Parameters
        ----------
        K : sparse.bsr_array
            Stiffness (n, n).
        x : Floats
            Solutions (n, m).
        start : Start or None
            Where the iteration to them started.
        carried : callable
            Carries vectors (n, k) of this system to where they are kept.

        Returns
        -------
        float
            Largest energy norm of what a solution lacked in the space, relative to its own.
        """
        new = x if start is None else x - start.x
        G = new.T @ kernels.product(K, new)
        energies = np.maximum(G.diagonal(), 0.0)
        whole = energies if start is None else energies + start.energies
        some = energies > self.known**2 * whole
        shares = np.divide(energies, whole, out=np.zeros_like(whole), where=whole > 0.0)
        missing = float(np.sqrt(shares.max(initial=0.0)))
        if not some.any():
            return missing
        size = np.sqrt(energies[some])
        values, vectors = linalg.eigh(G[np.ix_(some, some)] / np.outer(size, size))
        apart = values > KNOWN * values[-1]
        ways = vectors[:, apart] / np.sqrt(values[apart]) / size[:, None]
        added = np.ascontiguousarray(carried(new[:, some] @ ways))
        if self._basis is None:
            self._basis, self._taken = added, np.ones(added.shape[1])
            return missing
        room = max(min(self.most, ROOM // added[:, :1].nbytes) - added.shape[1], 0)
        stay = np.sort(np.argsort(-self._taken, kind="stable")[:room])
        self._basis = np.hstack([self._basis[:, stay], added])
        self._taken = np.append(self._taken[stay], np.ones(added.shape[1]))
        return missing
