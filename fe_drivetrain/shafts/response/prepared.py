"""A model's system, reduced and set up once for all that is solved with it.

Unit loads, influence functions of reactions: all are solutions of the same system, whose
reduction and set-up take about as long as a block of solutions.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from weakref import WeakKeyDictionary

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.elasticity.interfaces.constraints import Elimination, eliminate
from fe_drivetrain.elasticity.solve.reduction import reduce
from fe_drivetrain.elasticity.solve.solvers import Diagnostics, Solver, factorise
from fe_drivetrain.elasticity.solve.stopping import TOLERANCE
from fe_drivetrain.shafts.response.model import Model

#: Of the energy norm. Forces on supports and their sums are linear in what an iteration leaves, and
#: not squared as stiffness is: one digit more.
STOP_AT = 0.1 * TOLERANCE


@dataclass(frozen=True, eq=False)
class Prepared:
    """A model that is ready for right-hand sides.

    Attributes
    ----------
    stiffness : sparse.bsr_array
        (n_dofs, n_dofs) before any constraint [N/m].
    elimination : Elimination
        Elimination of its constraints.
    solver : Solver
        Solver of what is left.
    """

    stiffness: sparse.bsr_array
    elimination: Elimination
    solver: Solver

    def solve(self, F: Floats) -> tuple[Floats, Diagnostics]:
        """Displacements (n_dofs, k) under nodal loads (n_dofs, k), and how they were found.

        Raises
        ------
        InputError
            The system is singular, see `Solver.solve`.
        """
        T = self.elimination.T
        solution = self.solver.solve(T.T @ F)
        return np.asarray(T @ solution.x), solution.diagnostics


_PREPARED: WeakKeyDictionary[Model, tuple[str, Prepared]] = WeakKeyDictionary()
_BY: WeakKeyDictionary[Model, Callable[[Model, str, int], Prepared]] = WeakKeyDictionary()


def prepare_by(model: Model, prepare: Callable[[Model, str, int], Prepared]) -> None:
    """Let a model be made ready, when it is first asked for, with what neighbours have left.

    Parameters
    ----------
    model : Model
        The model.
    prepare : callable
        Takes the arguments of `prepared`.
    """
    _BY[model] = prepare


def prepared(model: Model, method: str, n_rhs: int) -> Prepared:
    """The model with its solver, the same as last time as long as the model is in use.

    Parameters
    ----------
    model : Model
        The model.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.factorise`.
    n_rhs : int
        How many right-hand sides come first, by which "auto" chooses.

    Raises
    ------
    InputError
        The system is singular, see `fe_drivetrain.elasticity.solve.solvers.factorise`.
    """
    found = _PREPARED.get(model)
    if found is None or found[0] != method:
        found = (method, _BY.get(model, prepared_alone)(model, method, n_rhs))
        _PREPARED[model] = found
    return found[1]


def prepared_alone(model: Model, method: str, n_rhs: int) -> Prepared:
    """The model with a solver of its own; arguments and errors of `prepared`."""
    stiffness = model.stiffness
    elimination = eliminate(model.constraints, model.n_dofs)
    mesh = model.mesh
    system = reduce(mesh.points, mesh.cells, stiffness, elimination, model.springs)
    return Prepared(stiffness, elimination, factorise(system, method, n_rhs, STOP_AT))
