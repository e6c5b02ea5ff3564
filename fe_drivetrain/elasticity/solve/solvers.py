"""Set up once, solve many right-hand sides, and say what it cost and how exact it is.

Symmetric positive definite systems only: interfaces are eliminated before, and mechanisms refused.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import SINGULAR, InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.elasticity.solve import direct_solvers, multigrid, petsc, schwarz
from fe_drivetrain.elasticity.solve.cost_model import iterations, predict
from fe_drivetrain.elasticity.solve.element_system import ElementSystem
from fe_drivetrain.elasticity.solve.reduction import System
from fe_drivetrain.elasticity.solve.rounding import Judged, judged
from fe_drivetrain.elasticity.solve.stopping import TOLERANCE

METHODS = ("auto", "superlu", "cholmod", "pardiso", "multigrid", "schwarz", *petsc.METHODS)

ITERATIVE = ("multigrid", "schwarz", *petsc.METHODS)

_USELESS = 1e-2  # a direct solver's residual; 1e-7 is seen in slender solids whose answer is right
_SURELY = 1e-2  # of a tolerance: a sum of errors is seldom so much less than the maximum
_DOUBTFUL, _LOST = 1e-4, 0.1
"""Bounds of what rounding does, above which it is reported, and refused: of first order, they bound
nothing where they are not small. Mostly it does a tenth to a hundredth of that, see
``cases/stability/slender_shafts.py``."""


@dataclass(frozen=True)
class Diagnostics:
    """Method, accuracy and cost of a solve.

    Attributes
    ----------
    residual : float
        Maximum true relative residual |K x - f| / |f| over the right-hand sides.
    energy_error : float
        Estimate of the maximum relative error in the energy norm. For a direct solver, what one
        step of refinement changed, or would change.
    round_off : float
        Relative change of a solution's energy by the rounding of the stiffness' own entries, at
        worst: no solver can do better, see `rounding.round_off`.
    iterations : int
        Number of iterations of conjugate gradients; 0 for a direct solver.
    method, reason : str
        Solver that was used, and why.
    setup_seconds, solve_seconds : float
        Wall time of factorisation or hierarchy, and of the solve.
    bytes : int
        Memory of factor or hierarchy, beside the stiffness matrix.
    n_unknowns : int
        Number of unknowns of the system.
    """

    residual: float
    energy_error: float
    round_off: float
    iterations: int
    method: str
    reason: str
    setup_seconds: float
    solve_seconds: float
    bytes: int
    n_unknowns: int

    @property
    def seconds(self) -> float:
        """Wall time of set-up and solve."""
        return self.setup_seconds + self.solve_seconds


@dataclass(frozen=True)
class Solution:
    """Solutions of one system, x (n, n_rhs), and how they were found."""

    x: Floats
    diagnostics: Diagnostics

    __repr__ = short_repr


@dataclass(frozen=True)
class Solver:
    """A system with its factor or hierarchy, ready for right-hand sides; made by `factorise`."""

    system: System | ElementSystem
    method: str
    reason: str
    tolerance: float
    setup_seconds: float
    bytes: int
    iterate: Callable[[Floats], multigrid.Iteration]
    precondition: Callable[[Floats], Floats] | None = None
    """What its factor or hierarchy does to right-hand sides; None of processes of their own."""

    __repr__ = short_repr

    def solve(self, F: Floats) -> Solution:
        """Solve for all columns of F at once.

        Parameters
        ----------
        F : Floats
            (n, n_rhs); zero at eliminated degrees of freedom.

        Raises
        ------
        InputError
            The system is singular, or so soft that rounding decides, or the iteration stopped short
            of its tolerance and there is not the memory for what could take its place.
        """
        start = time.perf_counter()
        found = self.iterate(F)
        seconds = time.perf_counter() - start
        by = found if isinstance(found, petsc.Checked) else self._judged(F, found)
        residual, lost = by.residual, by.round_off
        iterative = self.method in ITERATIVE
        # A factor of a singular matrix may well exist, by round-off, with anything in it.
        if not np.isfinite(residual) or (not iterative and residual > _USELESS):
            raise InputError(SINGULAR)
        if found.energy_error > self.tolerance and iterative:
            return self._instead(F, found, residual, seconds)
        if lost > _LOST:
            raise InputError(
                f"the body is so soft beside its elements, or so softly held, that rounding may "
                f"change its motion by {100 * lost:.2g} %, with any solver: use longer elements "
                "along a slender body, or a beam, or stiffer supports"
            )
        reason = self.reason
        if lost > _DOUBTFUL:
            reason += f"; rounding may change the answer by {100 * lost:.2g} %"
        diagnostics = Diagnostics(
            residual,
            found.energy_error,
            lost,
            found.iterations,
            self.method,
            reason,
            self.setup_seconds,
            seconds,
            self.bytes,
            self.system.n_free,
        )
        return Solution(found.x, diagnostics)

    def _judged(self, F: Floats, found: multigrid.Iteration) -> Judged:
        assert isinstance(self.system, System)
        return judged(self.system.K, found.x, F)

    def _instead(
        self, F: Floats, found: multigrid.Iteration, residual: float, seconds: float
    ) -> Solution:
        """Another solver's solution in place of an iteration that did not get there."""
        short = (
            f"{self.method} stopped after {found.iterations} iterations at an energy error of "
            f"about {found.energy_error:.1e} (relative residual {residual:.1e}), short of "
            f"{self.tolerance:.0e}"
        )
        tried = {"schwarz": ("multigrid", "schwarz"), "multigrid": ("multigrid",)}
        left_out = tried.get(self.method, ())
        system = self.system if isinstance(self.system, System) else self.system.whole()
        costs = [c for c in predict(system, F.shape[1], self.tolerance) if c.method not in left_out]
        cost = min(costs, key=lambda c: (not c.fits, c.seconds))
        if not cost.fits:
            what = "patches" if cost.method == "schwarz" else "a direct factor"
            raise InputError(
                f"{short}, and {what} of {self.system.n_free} unknowns needs about "
                f"{cost.bytes / 2**30:.1f} GiB of memory, more than there is: use a coarser mesh "
                "or thicker walls"
            )
        other = factorise(system, cost.method, F.shape[1], self.tolerance)
        solution = other.solve(F)
        after = solution.diagnostics
        diagnostics = replace(
            after,
            reason=f"{short}; {cost.method} instead" + after.reason.removeprefix("as asked"),
            setup_seconds=self.setup_seconds + seconds + after.setup_seconds,
        )
        return Solution(solution.x, diagnostics)


def factorise(
    system: System | ElementSystem,
    method: str = "auto",
    n_rhs: int = 1,
    tolerance: float = TOLERANCE,
) -> Solver:
    """Set up a solver: a factor, a hierarchy of coarser levels, or patches.

    Parameters
    ----------
    system : System or ElementSystem
        System from `reduction.reduce`, or not assembled: ``petsc`` and ``petsc-mumps`` assemble it
        in parts, others here.
    method : str
        ``superlu`` (always there), ``cholmod``, ``pardiso`` (optional packages), ``multigrid``,
        ``schwarz`` (for thin and slender solids of any size), ``petsc`` and ``petsc-mumps`` (in
        parts, on MPI processes: see `petsc`), or ``auto``: the one with the minimum
        predicted time, see `cost_model.predict`.
    n_rhs : int
        Number of right-hand sides that will come, for ``auto``.
    tolerance : float
        Relative error in the energy norm at which an iteration stops.

    Raises
    ------
    InputError
        The method is unknown or not installed, or the matrix is singular.
    """
    if method not in METHODS:
        raise InputError(f"solver {method!r} is unknown: use one of {', '.join(METHODS)}")
    reason = "as asked"
    if isinstance(system, ElementSystem) and method not in petsc.METHODS:
        system = system.whole()
    if method == "auto":
        assert isinstance(system, System)
        chosen, *others = predict(system, n_rhs, tolerance)
        method = chosen.method
        reason = f"{chosen}; {', '.join(map(str, others))}" if others else f"{chosen}"
    start = time.perf_counter()
    if method in petsc.METHODS:
        ranks = petsc.Ranks(system, method)
        held = ranks.bytes

        def iterate(F: Floats) -> multigrid.Iteration:
            return ranks.solve(F, tolerance)

        return Solver(system, method, reason, tolerance, time.perf_counter() - start, held, iterate)
    assert isinstance(system, System)
    if method in ITERATIVE:
        made = multigrid.build(system) if method == "multigrid" else schwarz.build(system)
        held = made.bytes
        by: Callable[[Floats], Floats] = made.precondition

        @cache
        def foreseen() -> float:
            return iterations(system, tolerance) if method == "multigrid" else 0.0

        def iterate(F: Floats) -> multigrid.Iteration:
            return multigrid.conjugate_gradients(system.K, F, by, tolerance, foreseen)

    else:
        factor = direct_solvers.factorise(system.K, method)
        held, by = factor.bytes, factor.apply

        def iterate(F: Floats) -> multigrid.Iteration:
            return _refined(system, factor, F, tolerance)

    seconds = time.perf_counter() - start
    return Solver(system, method, reason, tolerance, seconds, held, iterate, by)


def _refined(
    system: System, factor: direct_solvers.Factor, F: Floats, tolerance: float
) -> multigrid.Iteration:
    """A direct solution with one step of refinement: slender solids lose digits in the factor.

    Where a caller asks for fewer digits than `TOLERANCE` has, and one sum of all residuals says
    that the factor has them, that step is left out, which is half of the time of many loads.
    """
    x = factor.apply(F)
    residual = F - system.K @ x
    energy = np.abs(np.einsum("nm,nm->m", F, x))
    energy[energy == 0.0] = 1.0
    if tolerance > TOLERANCE and F.shape[1] > 1:
        # with random signs, the energy of the sum is on average the sum of energies (Hutchinson)
        signs = np.random.default_rng(0).choice([-1.0, 1.0], F.shape[1])
        summed = (residual @ (signs / np.sqrt(energy)))[:, None]
        error = float(np.sqrt(np.abs(np.vdot(summed, factor.apply(summed)))))
        if error < _SURELY * tolerance:
            return multigrid.Iteration(x, 0, error)
    change = factor.apply(residual)
    x = x + change
    moved = np.abs(np.einsum("nm,nm->m", residual, change)) / energy
    return multigrid.Iteration(x, 0, float(np.sqrt(moved.max())))


def solve(
    system: System | ElementSystem, F: Floats, method: str = "auto", tolerance: float = TOLERANCE
) -> Solution:
    """Set up and solve once; arguments of `factorise` and `Solver.solve`."""
    return factorise(system, method, F.shape[1], tolerance).solve(F)
