"""Conjugate gradients, preconditioned by a hierarchy: quadratic elements, linear ones, aggregates.

The quadratic level is smoothed by Chebyshev polynomials in the block-Jacobi preconditioned
stiffness, and corrected by the linear elements on the same corners (p-multigrid). Below that,
smoothed aggregation (Vanek, Mandel, Brezina 1996) with the rigid motions as near-nullspace. Up to
sixteen right-hand sides go through together: the matrices are read once for all.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray
from scipy import linalg, sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import SINGULAR, InputError
from fe_drivetrain.common.threads import one_blas_thread
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.operator.vectors import LANES
from fe_drivetrain.elasticity.solve.aggregates import coarsened, of_nodes, within_bodies
from fe_drivetrain.elasticity.solve.coarse_product import coarse_product
from fe_drivetrain.elasticity.solve.recycled import Start
from fe_drivetrain.elasticity.solve.reduction import Joints, System, diagonal_blocks, in_blocks
from fe_drivetrain.elasticity.solve.stopping import (
    LAST_DIGIT,
    energy_error,
    is_hopeless,
    tail_ratio,
)

MAX_ITERATIONS = 150

LANCZOS_STEPS, _MAX_LEVELS = 12, 10

# Diagonals whose rows single precision has the range for; no entry is larger than the diagonal's.
_SINGLE = np.finfo(np.float32)
_MINIMUM, _MAXIMUM = float(_SINGLE.tiny / _SINGLE.eps), float(_SINGLE.max)


@dataclass(frozen=True)
class Options:
    """Options of a hierarchy; the defaults measured best, ``cases/performance/solvers.py``.

    Attributes
    ----------
    degree, coarse_degree : int
        Degree of the Chebyshev smoother on the finest level, and on the others. A degree more there
        takes two passes over the matrix an iteration, and does not save as many; below it costs
        little.
    smoothed : float
        Eigenvalue, relative to the maximum, from which on the smoother works.
    linear_level : bool
        Whether linear elements come between the quadratic ones and aggregates.
    strength : float
        Threshold of the symmetric strength of connection.
    prolongation_smoother : str or None
        Smoother of the prolongation: "jacobi", "energy" or None, as in pyamg.
    apart : bool
        Whether bodies that a joint couples keep apart in aggregates.
    coarsest : int
        Nodes or aggregates at which aggregation ends and a dense factor begins.
    single : bool
        Whether levels keep their stiffness in single precision, where it has the range.
    """

    degree: int = 1
    coarse_degree: int = 2
    smoothed: float = 0.05
    linear_level: bool = True
    strength: float = 0.0
    prolongation_smoother: str | None = "jacobi"
    apart: bool = True
    coarsest: int = 100
    single: bool = True


class Rounded(NamedTuple):
    """A matrix in 3x3 blocks, (n, 3, 3), which may be of single precision."""

    indptr: NDArray[np.int32]
    indices: NDArray[np.int32]
    data: Floats


@dataclass(frozen=True)
class Level:
    """One level and the way to the next coarser one.

    Attributes
    ----------
    K : Rounded
        Stiffness; in single precision where that has the range: half the bytes for a smoother to
        read. Conjugate gradients have the finest one in double precision, so answers are as exact.
        Rounding is symmetric, and so is the hierarchy.
    inverse : Floats
        Inverses (n_blocks, 3, 3) of its diagonal blocks.
    largest : float
        Upper bound of the eigenvalues of diag^-1 K.
    degree : int
        Degree of its Chebyshev smoother.
    prolongation, restriction : sparse.csr_array
        Transfer to and from the next level.
    """

    K: Rounded
    inverse: Floats
    largest: float
    degree: int
    prolongation: sparse.csr_array
    restriction: sparse.csr_array


@dataclass(frozen=True)
class Hierarchy:
    """All levels, finest first, and the factor of the coarsest."""

    levels: tuple[Level, ...]
    coarsest: tuple[Floats, bool]
    options: Options

    @property
    def bytes(self) -> int:
        """Memory of everything that the finest stiffness itself does not hold."""
        matrices = [m for level in self.levels for m in (level.prolongation, level.restriction)]
        matrices += [level.K for level in self.levels[1:]]
        held = sum(m.data.nbytes + m.indices.nbytes + m.indptr.nbytes for m in matrices)
        # the finest pattern is the system's, and in double precision its entries are, too
        rounded = (level.K.data for level in self.levels[:1] if level.K.data.dtype == np.float32)
        held += sum(data.nbytes for data in rounded)
        held += sum(level.inverse.nbytes for level in self.levels)
        return int(held + self.coarsest[0].nbytes)

    def precondition(self, R: Floats) -> Floats:
        """One V-cycle for all columns of R; symmetric positive definite."""
        columns = R.shape[1]
        if columns > 1 and columns % LANES:
            return self._cycle(0, kernels.in_lanes(R))[:, :columns]
        return self._cycle(0, np.ascontiguousarray(R))

    def _cycle(self, number: int, B: Floats) -> Floats:
        if number == len(self.levels):
            factor, lower = self.coarsest
            found = linalg.lapack.dpotrs(factor, B, lower)[0]  # without the checks of cho_solve
            return np.ascontiguousarray(found)
        level = self.levels[number]
        X = smooth(level, None, B, self.options)
        R = np.empty_like(B)
        kernels.residual(*level.K, X, B, R)
        coarse = np.zeros((level.restriction.shape[0], B.shape[1]))
        kernels.add_product(level.restriction, R, coarse)
        kernels.add_product(level.prolongation, self._cycle(number + 1, coarse), X)
        return smooth(level, X, B, self.options)


@dataclass(frozen=True)
class Joined:
    """A hierarchy of bodies, corrected for joints that take means over faces.

    On coarse levels such a joint is a penalty which smoothing does not see, and conjugate gradients
    hardly converge. So the hierarchy V is of the bodies alone, and each application of it is
    corrected exactly for the joints' few rows N of flexibility F, zero of a condition (Woodbury
    1950, Princeton Statistical Research Group, memorandum 42): V - V N^T (F + N V N^T)^-1 N V is as
    good a preconditioner of bodies and joints together as V is of the bodies.
    """

    hierarchy: Hierarchy
    joints: Joints
    spread: Floats
    factor: tuple[Floats, bool]

    @property
    def bytes(self) -> int:
        """Memory of everything that the finest stiffness itself does not hold."""
        K = self.joints.bodies.K
        return int(self.hierarchy.bytes + self.spread.nbytes + K.data.nbytes + K.indices.nbytes)

    def precondition(self, R: Floats) -> Floats:
        """One V-cycle for all columns of R, with the joints; symmetric positive definite."""
        sums = self.joints.sums
        lifted = R + sums.shares.T @ R[sums.dofs]
        lifted[sums.dofs] = 0.0
        X = self.hierarchy.precondition(lifted)
        X -= self.spread @ linalg.cho_solve(self.factor, sums.rows @ X)
        X[sums.dofs] = sums.shares @ X
        X[~self.joints.free] = 0.0
        return X


def smooth(level: Level, X: Floats | None, B: Floats, options: Options) -> Floats:
    """Chebyshev iteration for K X = B (Saad 2003, algorithm 12.1); X = 0 where not given."""
    high, low = level.largest, options.smoothed * level.largest
    centre, half = 0.5 * (high + low), 0.5 * (high - low)
    momentum, step, rho = 0.0, 1.0 / centre, half / centre
    D = np.empty_like(B)
    for number in range(level.degree):
        if X is None:
            kernels.times_blocks(level.inverse, B, step, D)
            X = D.copy() if level.degree > 1 else D
        else:
            out = np.empty_like(X)
            kernels.chebyshev_step(*level.K, level.inverse, X, B, D, out, momentum, step)
            X = out
        if number + 1 < level.degree:
            following = 1.0 / (2.0 * centre / half - rho)
            momentum, step, rho = following * rho, 2.0 * following / half, following
    assert X is not None
    return X


DEFAULTS = Options()


def build(system: System, options: Options = DEFAULTS) -> Hierarchy | Joined:
    """The hierarchy of a system, or that of its bodies with their joints.

    Raises
    ------
    InputError
        The system is singular.
    """
    with one_blas_thread():
        if system.joints is None:
            return _hierarchy(system, options)
        return _joined(system.joints(), options)


def _joined(joints: Joints, options: Options) -> Joined:
    hierarchy = _hierarchy(joints.bodies, options)
    rows = joints.sums.rows
    some = kernels.together(rows.shape[0])
    spread = np.hstack([hierarchy.precondition(rows[k].T.toarray()) for k in some])
    met = rows @ spread
    try:
        factor = linalg.cho_factor(np.diag(joints.sums.flexibility) + 0.5 * (met + met.T))
    except linalg.LinAlgError as error:
        raise InputError(SINGULAR) from error
    return Joined(hierarchy, joints, spread, factor)


def _hierarchy(system: System, options: Options) -> Hierarchy:
    # half a second with what it imports, which a kept solution need not wait for
    from pyamg.strength import symmetric_strength_of_connection

    levels: list[Level] = []
    K, motions, body = system.K, system.near_nullspace, system.body
    if system.prolongation is not None and options.linear_level:
        P = system.prolongation
        levels.append(Level(*_smoothing(K, options), options.degree, _in_rows(P), _in_rows(P.T)))
        K = coarse_product(K, P, levels[-1].restriction)
    elif system.prolongation is not None:
        motions, body = system.prolongation @ motions, np.zeros(K.shape[0] // 3, dtype=np.int64)
    connected = within_bodies(*kernels.pattern_of(K), body) if options.apart else None
    K, width = in_blocks(K), 3
    while K.shape[0] // width > options.coarsest and len(levels) < _MAX_LEVELS:
        # Six degrees of freedom an aggregate below the first level: two blocks of three.
        if connected is None and options.strength == 0.0:
            connected = within_bodies(*of_nodes(K, width // 3))
        elif connected is None:
            connected = symmetric_strength_of_connection(K.tobsr((width, width)), options.strength)
        smoothing = _smoothing(K, options)
        degree = options.coarse_degree if levels else options.degree
        P, motions = coarsened(K, motions, connected, options.prolongation_smoother, *smoothing[1:])
        levels.append(Level(*smoothing, degree, _in_rows(P), _in_rows(P.T)))
        K = coarse_product(K, levels[-1].prolongation, levels[-1].restriction)
        connected, width = None, 6
    last = K.toarray()
    # Aggregates too small for six motions leave empty rows.
    empty = np.flatnonzero(last.diagonal() <= 0.0)
    last[empty, empty] = 1.0
    try:
        return Hierarchy(tuple(levels), linalg.cho_factor(last), options)
    except linalg.LinAlgError as error:
        raise InputError(SINGULAR) from error


def _in_rows(P: sparse.sparray) -> sparse.csr_array:
    """The matrix in rows, with 32-bit indices as `kernels` is compiled for."""
    P = P.tocsr()
    indptr, indices = kernels.pattern_of(P)
    return sparse.csr_array((P.data, indices, indptr), shape=P.shape)


def _smoothing(K: sparse.bsr_array, options: Options) -> tuple[Rounded, Floats, float]:
    """Stiffness, inverse blocks and maximum eigenvalue of a level."""
    diagonal = diagonal_blocks(K)
    sizes = np.einsum("nii->ni", diagonal)  # a view
    sizes[sizes <= 0.0] = 1.0
    inverse = np.empty_like(diagonal)
    kernels.invert(diagonal, inverse)
    single = options.single and sizes.min() > _MINIMUM and sizes.max() < _MAXIMUM
    data = np.empty(K.data.shape, np.float32) if single else K.data
    if single:
        kernels.rounded(K.data, data)
    blocks = Rounded(K.indptr, K.indices, data)
    return blocks, inverse, max_eigenvalue(blocks, inverse)


def max_eigenvalue(K: Rounded | sparse.bsr_array, inverse: Floats) -> float:
    """An upper bound of the eigenvalues of diag^-1 K, by a few steps of Lanczos.

    A single flat element has an eigenvalue far above the others, that a power method hardly sees;
    where the smoother does not know of it, it makes errors larger and is no preconditioner. The
    last residual of Lanczos is added (Zhou and Li 2011, Linear Algebra Appl. 435, 480-493).

    Parameters
    ----------
    K : Rounded or sparse.bsr_array
        Stiffness (n, n), symmetric positive semi-definite, 3x3 blocks.
    inverse : Floats
        (n / 3, 3, 3) inverses of its diagonal blocks.
    """
    r = np.random.default_rng(0).standard_normal((3 * len(inverse), 1))
    zero, Kp, z = np.zeros_like(r), np.empty_like(r), np.empty_like(r)
    kernels.times_blocks(inverse, r, 1.0, z)
    # x is what conjugate gradients would find: nobody asks, but its step is one loop with that of r
    x, p, rz = np.zeros_like(r), z.copy(), float(kernels.dots(r, z)[0])
    diagonal, beside = [], []
    alpha, beta = 1.0, 0.0
    for _ in range(LANCZOS_STEPS):
        kernels.residual(K.indptr, K.indices, K.data, p, zero, Kp)
        curvature = -float(kernels.dots(p, Kp)[0])
        if curvature <= 0.0 or rz <= 0.0:
            break
        before, alpha = alpha, rz / curvature
        diagonal.append(1.0 / alpha + beta / before)
        kernels.advance(x, r, p, Kp, np.array([alpha]))
        kernels.times_blocks(inverse, r, 1.0, z)
        new = float(kernels.dots(r, z)[0])
        beta, rz = new / rz, new
        beside.append(math.sqrt(max(beta, 0.0)) / alpha)
        kernels.redirect(p, z, np.array([beta]))
    values, vectors = linalg.eigh_tridiagonal(diagonal, beside[:-1])
    return float(values[-1] + beside[-1] * abs(vectors[-1, -1]))


@dataclass(frozen=True)
class Iteration:
    """Result of conjugate gradients.

    Attributes
    ----------
    x : Floats
        Solutions (n, m).
    iterations : int
        Number of them.
    energy_error : float
        Maximum estimate, over the columns, of the relative error in the energy norm; infinite where
        stiffness or preconditioner turned out not to be positive.
    tail_ratio : float
        What the estimate rests on, see `stopping.tail_ratio`, of the worst column.
    """

    x: Floats
    iterations: int
    energy_error: float
    tail_ratio: float = field(default=1.0, kw_only=True)


def conjugate_gradients(
    K: sparse.bsr_array,
    F: Floats,
    precondition: Callable[[Floats], Floats],
    tolerance: float,
    foreseen: Callable[[], float] = lambda: 0.0,
    start: Start | None = None,
) -> Iteration:
    """Solve K x = F for all columns at once, until the energy error is small enough.

    Parameters
    ----------
    K : sparse.bsr_array
        Stiffness (n, n), symmetric positive definite.
    F : Floats
        Right-hand sides (n, m).
    precondition : callable
        Symmetric positive definite, of all columns.
    tolerance : float
        Relative error |x - x_k|_K / |x|_K to stop at. Squared, it is the relative error of the
        stiffness that belongs to a load.
    foreseen : callable
        Gives the number of iterations that it was thought to take: patience with a slow beginning,
        see `stopping.is_hopeless`.
    start : Start or None
        Where to start; at zero where not given.

    Returns
    -------
    iteration
        The last one: of `MAX_ITERATIONS`, or of fewer once it is plain that these will not do,
        where the tolerance is not reached.
    """
    found = [
        _solved(
            K,
            F[:, columns],
            precondition,
            tolerance,
            foreseen,
            None if start is None else start.part(columns),
        )
        for columns in kernels.together(F.shape[1])
    ]
    return Iteration(
        np.hstack([part.x for part in found]),
        max(part.iterations for part in found),
        max(part.energy_error for part in found),
        tail_ratio=max(part.tail_ratio for part in found),
    )


def _solved(
    K: sparse.bsr_array,
    F: Floats,
    precondition: Callable[[Floats], Floats],
    tolerance: float,
    foreseen: Callable[[], float],
    start: Start | None = None,
) -> Iteration:
    """Conjugate gradients for a few columns, as `conjugate_gradients`."""
    count = F.shape[1]
    if count > 1:
        F = kernels.in_lanes(F)
        if start is not None:
            energies = np.append(start.energies, np.zeros(F.shape[1] - count))
            start = replace(start, x=kernels.in_lanes(start.x), energies=energies)
    found = Iteration(np.zeros_like(F), 0, 0.0)  # where all columns are zero
    errors: list[float] = []
    with one_blas_thread():
        for found in iterates(K, F, precondition, start):
            errors.append(found.energy_error)
            too_long = found.iterations == MAX_ITERATIONS
            too_long |= is_hopeless(errors, tolerance, MAX_ITERATIONS, foreseen)
            if found.energy_error <= tolerance or too_long:
                break
    return replace(found, x=found.x[:, :count])


def iterates(
    K: sparse.bsr_array,
    F: Floats,
    precondition: Callable[[Floats], Floats],
    start: Start | None = None,
) -> Iterator[Iteration]:
    """Conjugate gradients, a step at a time; ``x`` is overwritten by the next step.

    Their error is estimated in the energy norm, see `stopping`.
    """
    R = np.array(F, order="C")
    X = np.zeros_like(R)
    before: Floats | float = 0.0
    least = 1.0
    if start is not None:
        X = np.array(start.x, order="C")
        before, least = start.energies, start.least_ratio
        kernels.residual(K.indptr, K.indices, K.data, X, np.ascontiguousarray(F), R)
    P = np.ascontiguousarray(precondition(R))  # for others each loop would be compiled once more
    rz = kernels.dots(R, P)
    first = rz
    KP, zero = np.empty_like(R), np.zeros_like(R)
    terms: list[Floats] = []
    alive = np.full(len(rz), True)
    while alive.any():
        kernels.residual(K.indptr, K.indices, K.data, P, zero, KP)
        curvature = -kernels.dots(P, KP)
        # Columns that are zero, or solved to the last digit, stand still.
        alive = np.abs(rz) > LAST_DIGIT * np.abs(first)
        if (alive & ((rz < 0.0) | ~(curvature > 0.0))).any():
            yield Iteration(X, len(terms), math.inf)
            return
        alpha = np.divide(rz, curvature, out=np.zeros_like(rz), where=alive)
        kernels.advance(X, R, P, KP, alpha)
        terms.append(alpha * rz)
        added = np.array(terms)
        error = energy_error(added, before, least)
        yield Iteration(X, len(terms), error, tail_ratio=float(tail_ratio(added).max()))
        Z = np.ascontiguousarray(precondition(R))
        new = kernels.dots(R, Z)
        kernels.redirect(P, Z, np.divide(new, rz, out=np.zeros_like(rz), where=alive))
        rz = new
