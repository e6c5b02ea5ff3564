"""A hierarchy in single precision beside one in double: where does it fail, what protects?"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fe_drivetrain.cases import case
from fe_drivetrain.common import Floats
from fe_drivetrain.compare import FOUR_DIGITS, safe_range
from fe_drivetrain.report import trace
from fe_drivetrain.solve import System, multigrid, solvers
from fe_drivetrain.suite import Page, Record, Run
from fe_drivetrain.validation import layers
from fe_drivetrain.validation import thin_bodies as bodies

Solid = tuple[System, Floats]

#: Below the default, so that small solids have aggregates, too.
OPTIONS = multigrid.Options(coarsest=50)

SLENDERNESS, QUICK_SLENDERNESS = (5, 10, 20, 50, 100, 200), (5, 20)
CONTRAST, QUICK_CONTRAST = np.logspace(-6, 10, 17), np.logspace(-2, 4, 3)
UNITS, QUICK_UNITS = np.logspace(-60, 60, 13), np.logspace(-60, 60, 3)


@dataclass(frozen=True)
class Trial:
    """One system by both hierarchies.

    Attributes
    ----------
    value : float
        Of the parameter that is swept.
    double, single : int
        Iterations to the solvers' tolerance; -1 where it was not reached.
    difference : float
        Largest relative one of the loads' work, where both arrive; otherwise 0.
    stored : str
        Type of the numbers of the finest level, of which single precision was asked.
    """

    value: float
    double: int
    single: int
    difference: float
    stored: str


def tried(solid: Callable[[float], Solid], value: float) -> Trial:
    """Conjugate gradients without what the program falls back to."""
    system, F = solid(value)
    work, iterations, stored = [], [], ""
    for single in (False, True):
        made = multigrid.build(system, replace(OPTIONS, single=single))
        found = multigrid.conjugate_gradients(system.K, F, made.precondition, solvers.TOLERANCE)
        arrived = found.energy_error <= solvers.TOLERANCE
        iterations.append(found.iterations if arrived else -1)
        work.append(np.einsum("nm,nm->m", F, found.x))
        bodies_alone = made.hierarchy if isinstance(made, multigrid.Joined) else made
        stored = str(bodies_alone.levels[0].K.data.dtype)
    both = min(iterations) >= 0
    difference = float(np.abs(work[1] / work[0] - 1.0).max()) if both else 0.0
    return Trial(value, iterations[0], iterations[1], difference, stored)


def slender(slenderness: float) -> Solid:
    """A tube of some diameters, held at one end, with an element a diameter along it."""
    shaft = bodies.uniform(0.7, 0.175, 0.7 * slenderness)
    problem = bodies.cantilever(shaft, 0.7 * (1.0 + 1e-9), 6)
    return problem.system, problem.F


def ring(contrast: float) -> Solid:
    """A shaft in a ring of another modulus."""
    return layers.ring().system((contrast, 1.0))


def in_units(factor: float) -> Solid:
    """A shaft of five diameters, its stiffness in other units."""
    system, F = slender(5.0)
    return replace(system, K=system.K * factor), F * factor**0.5


SWEEPS: dict[str, tuple[Callable[[float], Solid], Sequence[float], Sequence[float]]] = {
    "L/D of a shaft": (slender, SLENDERNESS, QUICK_SLENDERNESS),
    "modulus of a ring over that of its shaft": (ring, CONTRAST.tolist(), QUICK_CONTRAST.tolist()),
    "stiffness in other units, factor": (in_units, UNITS.tolist(), QUICK_UNITS.tolist()),
}


@case(
    "A multigrid hierarchy in single precision: where it fails, and what protects",
    source="Smoothing with a rounded matrix: its error in the energy norm is the rounding times "
    "the root of the condition number; measured against a hierarchy in double precision",
)
def run(run: Run, page: Page) -> None:
    """Sweep slenderness, contrast and units; count iterations with either precision."""
    trials = {
        name: [run.timed(f"{name}: {x:.3g}", tried, solid, x) for x in values]
        for name, (solid, full, quick) in SWEEPS.items()
        for values in [quick if run.quick else full]
    }
    every = [trial for swept in trials.values() for trial in swept]
    page.vanishes(
        "solids on which the double-precision hierarchy converges and the single one does not",
        sum(t.double >= 0 > t.single for t in every),
        within=0.0,
        why="half the bytes must not cost robustness",
        source="the same solids, both hierarchies",
    )
    page.at_most(
        "iterations with the single-precision hierarchy over those with the double one, worst",
        max(t.single / t.double for t in every if min(t.single, t.double) > 0),
        1.5,
        why="a third of the time of an iteration is conjugate gradients in double precision; with "
        "half more iterations nothing would be gained",
        source="time of passes over the matrix: 8 bytes an entry, and 4",
    )
    page.vanishes(
        "work of a load, single against double: largest relative difference",
        max(t.difference for t in every),
        within=FOUR_DIGITS**2,
        why="both stop at the solvers' tolerance of the energy error, whose square is the error of "
        "the work; the rest is round-off of the slenderest solid, in either",
        source="conjugate gradients have the stiffness in double precision",
    )
    beyond = [t for t in trials["stiffness in other units, factor"] if not 1e-45 < t.value < 1e28]
    page.holds(
        "stiffnesses beyond the range of single precision stay in double precision",
        all(t.stored == "float64" for t in beyond),
        why="an infinite entry is no preconditioner",
        source="the hierarchy's own choice",
    )
    page.answer(
        f"On {len(every)} solids the hierarchy in single precision takes at most "
        f"{max(t.single - t.double for t in every)} iterations more than one in double precision, "
        "and gives the same answers; where the range of single precision ends, the program keeps "
        "double precision."
    )
    for name, swept in trials.items():
        limit_of(page, name, swept)
        page.section(name)
        at = [t.value for t in swept if t.double >= 0], [t.value for t in swept if t.single >= 0]
        page.chart(
            f"Iterations to an energy error of {solvers.TOLERANCE:.0e}",
            [
                trace("double precision", at[0], [t.double for t in swept if t.double >= 0]),
                trace("single precision", at[1], [t.single for t in swept if t.single >= 0], True),
            ],
            name,
            "iterations",
            "x",
        )
        page.table("Iterations to the same", [row_of(t) for t in swept])
    page.image("A shaft of five diameters", run.sketch(bodies.uniform(0.7, 0.175, 3.5)))


def limit_of(page: Page, name: str, swept: list[Trial]) -> None:
    """Over which values both hierarchies converge; beyond, neither does."""
    low, high = safe_range(
        [t.value for t in swept], [0.0 if t.single >= 0 else np.inf for t in swept], 0.5
    )
    page.limit(
        "multigrid in single precision",
        name,
        low=low,
        high=high,
        criterion=f"reaches the solvers' tolerance within {multigrid.MAX_ITERATIONS} iterations",
        beyond="neither precision converges" if (low, high) != (None, None) else "no limit found",
        program="keeps double precision where single precision lacks the range; takes a direct "
        "factor or patches where iterations do not converge",
        remedy="none needed",
    )


def row_of(trial: Trial) -> Record:
    """A row of the table."""
    return {
        "value": trial.value,
        "double: iterations": trial.double if trial.double >= 0 else "not reached",
        "single: iterations": trial.single if trial.single >= 0 else "not reached",
        "difference of the work": trial.difference if trial.single >= 0 else None,
        "numbers of the finest level": trial.stored,
    }
