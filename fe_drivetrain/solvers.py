"""Set up once, solve many right-hand sides, and say what it cost and how exact it is.

Symmetric positive definite systems only: interfaces are eliminated before, and mechanisms refused.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain import direct, multigrid
from fe_drivetrain.cost import predict
from fe_drivetrain.elasticity import Floats
from fe_drivetrain.errors import SINGULAR, InputError
from fe_drivetrain.reduction import System

METHODS = ("auto", "superlu", "cholmod", "pardiso", "multigrid")

TOLERANCE = 1e-9
"""Energy error at which iterations stop, relative; squared, that of a load's own stiffness."""

_USELESS = 1e-2  # a direct solver's residual; 1e-7 is seen in slender solids whose answer is right


@dataclass(frozen=True)
class Solution:
    """Solutions of one system and their diagnostics.

    Attributes
    ----------
    x
        (n, n_rhs).
    residual
        Largest true relative residual |K x - f| / |f| over the right-hand sides.
    energy_error
        Estimate of the largest relative error in the energy norm. Of a direct solver, what one
        step of refinement changed.
    iterations
        Of conjugate gradients; 0 of a direct solver.
    method, reason
        The solver that was used, and why.
    setup_seconds, solve_seconds
        Wall time of factorisation or hierarchy, and of the solve.
    bytes
        Memory of factor or hierarchy, beside the stiffness matrix.
    """

    x: Floats
    residual: float
    energy_error: float
    iterations: int
    method: str
    reason: str
    setup_seconds: float
    solve_seconds: float
    bytes: int

    @property
    def seconds(self) -> float:
        """Wall time of set-up and solve."""
        return self.setup_seconds + self.solve_seconds


@dataclass(frozen=True)
class Solver:
    """A system with its factor or hierarchy, ready for right-hand sides; made by `factorise`."""

    system: System
    method: str
    reason: str
    tolerance: float
    setup_seconds: float
    bytes: int
    iterate: Callable[[Floats], multigrid.Iteration]

    def solve(self, F: Floats) -> Solution:
        """Solve for all columns of F at once.

        Parameters
        ----------
        F
            (n, n_rhs); zero at eliminated freedoms.

        Raises
        ------
        InputError
            The system is singular, or the iteration stopped short of its tolerance and there is
            not the memory for a direct factor.
        """
        start = time.perf_counter()
        found = self.iterate(F)
        seconds = time.perf_counter() - start
        K = self.system.K
        size = np.linalg.norm(F, axis=0)
        size[size == 0.0] = 1.0
        residual = float((np.linalg.norm(K @ found.x - F, axis=0) / size).max())
        # A factor of a singular matrix may well come out, by round-off, with anything in it.
        if not np.isfinite(residual) or (self.method != "multigrid" and residual > _USELESS):
            raise InputError(SINGULAR)
        if found.energy_error > self.tolerance and self.method == "multigrid":
            return self._instead(F, found, residual, seconds)
        return Solution(
            found.x,
            residual,
            found.energy_error,
            found.iterations,
            self.method,
            self.reason,
            self.setup_seconds,
            seconds,
            self.bytes,
        )

    def _instead(
        self, F: Floats, found: multigrid.Iteration, residual: float, seconds: float
    ) -> Solution:
        """A direct solution in place of an iteration that did not get there."""
        short = (
            f"multigrid stopped after {found.iterations} iterations at an energy error of about "
            f"{found.energy_error:.1e} (relative residual {residual:.1e}), short of "
            f"{self.tolerance:.0e}"
        )
        costs = predict(self.system, F.shape[1])
        cost = min(
            (c for c in costs if c.method != "multigrid"), key=lambda c: (not c.fits, c.seconds)
        )
        if not cost.fits:
            raise InputError(
                f"{short}, and a direct factor of {self.system.n_free} unknowns needs about "
                f"{cost.bytes / 2**30:.1f} GiB of memory, more than there is: use a coarser mesh "
                "or thicker walls"
            )
        other = factorise(self.system, cost.method, F.shape[1], self.tolerance)
        solution = other.solve(F)
        return replace(
            solution,
            reason=f"{short}; {cost.method} instead",
            setup_seconds=self.setup_seconds + seconds + solution.setup_seconds,
        )


def factorise(
    system: System, method: str = "auto", n_rhs: int = 1, tolerance: float = TOLERANCE
) -> Solver:
    """Set up a solver: a factor, or a hierarchy of coarser levels.

    Parameters
    ----------
    system
        From `reduction.reduce`.
    method
        ``superlu`` (always there), ``cholmod``, ``pardiso`` (optional packages), ``multigrid``, or
        ``auto``: the one with the least predicted time, see `cost.predict`.
    n_rhs
        How many right-hand sides will come, for ``auto``.
    tolerance
        Relative error in the energy norm at which an iteration stops.

    Raises
    ------
    InputError
        The method is unknown or not installed, or the matrix is singular.
    """
    if method not in METHODS:
        raise InputError(f"solver {method!r} is unknown: use one of {', '.join(METHODS)}")
    reason = "as asked"
    if method == "auto":
        chosen, *others = predict(system, n_rhs)
        method = chosen.method
        reason = f"{chosen}; {', '.join(map(str, others))}" if others else f"{chosen}"
    if method in direct.PACKAGES and not direct.is_installed(method):
        raise InputError(
            f"solver {method!r} is not installed: pip install 'fe-drivetrain[{method}]', "
            "or choose 'multigrid' or 'superlu'"
        )
    start = time.perf_counter()
    if method == "multigrid":
        hierarchy = multigrid.build(system)
        held = hierarchy.bytes

        def iterate(F: Floats) -> multigrid.Iteration:
            return multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, tolerance)

    else:
        factor = direct.factorise(system.K, method)
        held = factor.bytes

        def iterate(F: Floats) -> multigrid.Iteration:
            return _refined(system, factor, F)

    return Solver(system, method, reason, tolerance, time.perf_counter() - start, held, iterate)


def _refined(system: System, factor: direct.Factor, F: Floats) -> multigrid.Iteration:
    """A direct solution with one step of refinement: slender solids lose digits in the factor."""
    x = factor.apply(F)
    residual = F - system.K @ x
    change = factor.apply(residual)
    x = x + change
    energy = np.abs(np.einsum("nm,nm->m", F, x))
    energy[energy == 0.0] = 1.0
    moved = np.abs(np.einsum("nm,nm->m", residual, change)) / energy
    return multigrid.Iteration(x, 0, float(np.sqrt(moved.max())))


def solve(
    system: System, F: Floats, method: str = "auto", tolerance: float = TOLERANCE
) -> Solution:
    """Set up and solve once; arguments as of `factorise` and `Solver.solve`."""
    return factorise(system, method, F.shape[1], tolerance).solve(F)
