"""A hierarchy in single precision beside one in double: where does it fail, what protects?"""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, eigsh

from fe_drivetrain.cases import case
from fe_drivetrain.cases.references import layers, slivers
from fe_drivetrain.cases.references import solver_trials as trials
from fe_drivetrain.cases.references import thin_bodies as bodies
from fe_drivetrain.common import Floats
from fe_drivetrain.comparison import FOUR_DIGITS, safe_range
from fe_drivetrain.drivetrain_file import (
    MAX_POISSON_RATIO,
    change_scene,
    coarser_scene,
    library_scene,
)
from fe_drivetrain.elasticity.interfaces import eliminate, fixed, rigid_face, rigid_point
from fe_drivetrain.elasticity.mesh import FLATTEST, generate
from fe_drivetrain.elasticity.operator import assemble
from fe_drivetrain.elasticity.solve import TOLERANCE, System, multigrid, reduce
from fe_drivetrain.geometry import MeshSizes
from fe_drivetrain.report import trace
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.report.suite import Page, Record, Run
from fe_drivetrain.shafts.response import build_model, mesh_scene

Solid = tuple[System, Floats]

#: Below the default, so that small solids have aggregates, too.
OPTIONS = multigrid.Options(coarsest=50)

SLENDERNESS, QUICK_SLENDERNESS = (5, 10, 20, 50, 100, 200), (5, 20)
CONTRAST, QUICK_CONTRAST = np.logspace(-6, 10, 17), np.logspace(-2, 4, 3)
UNITS, QUICK_UNITS = np.logspace(-60, 60, 13), np.logspace(-60, 60, 3)
THINNESS, QUICK_THINNESS = (2, 3, 5, 7, 10, 20, 40, 75, 150, 400, 2000), (3, 40)
#: Tubes in elements round, and along.
TUBE, QUICK_TUBE = (14, 4), (8, 3)
HEIGHTS, QUICK_HEIGHTS = np.append(np.logspace(-14, -1, 14), 0.5), (1e-6, 1e-2)
DISTANCES, QUICK_DISTANCES = (1e-6, 1e-5, 1e-4, 1e-3, 3e-3, 1e-2, 3e-2, 0.1, 0.2), (1e-4, 0.2)
FACTORS, QUICK_FACTORS = (1.5, 2.0, 3.0, 4.0), (4.0, 5.0)
#: Eigenvalues over the bound beyond which a smoother of degree one makes errors larger.
SMOOTHED = 1.0 + OPTIONS.smoothed


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
    beyond : float
        The largest eigenvalue that the finest smoother meets over the bound that Lanczos gave it.
    answered : str
        The solver that answers where multigrid was asked for and does not converge, or that the
        program refuses; empty where it converges.
    error : float
        Of the work in that answer, against a direct factor, refined; NaN where there is none.
    round_off : float
        What the program says that round-off may have done to it.
    """

    value: float
    double: int
    single: int
    difference: float
    stored: str
    beyond: float
    answered: str = ""
    error: float = np.nan
    round_off: float = np.nan


def tried(solid: Callable[[float], Solid], value: float) -> Trial:
    """Conjugate gradients without what the program falls back to."""
    system, F = solid(value)
    work, iterations, stored = [], [], ""
    for single in (False, True):
        made = multigrid.build(system, replace(OPTIONS, single=single))
        found = multigrid.conjugate_gradients(system.K, F, made.precondition, TOLERANCE)
        arrived = found.energy_error <= TOLERANCE
        iterations.append(found.iterations if arrived else -1)
        work.append(np.einsum("nm,nm->m", F, found.x))
        bodies_alone = made.hierarchy if isinstance(made, multigrid.Joined) else made
        stored = str(bodies_alone.levels[0].K.data.dtype)
    K = made.joints.bodies.K if isinstance(made, multigrid.Joined) else system.K
    beyond = beyond_bound(K, bodies_alone.levels[0])
    by_double, by_single = iterations
    if min(iterations) >= 0:
        difference = float(np.abs(work[1] / work[0] - 1.0).max())
        return Trial(value, by_double, by_single, difference, stored, beyond)
    instead = trials.answered(system, F, "multigrid")
    if instead.compliance is None:
        return Trial(value, by_double, by_single, 0.0, stored, beyond, "refused")
    exact = trials.factored(system, F, "superlu").refined
    error = float(np.abs(instead.compliance / exact - 1.0).max())
    return Trial(
        value, by_double, by_single, 0.0, stored, beyond, instead.method, error, instead.round_off
    )


def beyond_bound(K: sparse.bsr_array, level: multigrid.Level) -> float:
    """The largest eigenvalue of diag^-1 K over the bound of it that a level has."""
    count = len(level.inverse)
    pointers, columns = np.arange(count + 1), np.arange(count)
    inverse = sparse.bsr_array((level.inverse, columns, pointers), shape=K.shape)
    diagonal = sparse.bsr_array((np.linalg.inv(level.inverse), columns, pointers), shape=K.shape)
    largest = eigsh(
        LinearOperator(K.shape, matvec=lambda x: K @ x, dtype=float),
        1,
        diagonal,
        which="LA",
        Minv=LinearOperator(K.shape, matvec=lambda x: inverse @ x, dtype=float),
        v0=np.random.default_rng(1).standard_normal(K.shape[0]),
        tol=1e-3,
        return_eigenvectors=False,
    )
    return float(largest[0] / level.largest)


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


def thin(thinness: float, mesh: tuple[int, int]) -> Solid:
    """A tube with a free end, twisted, and under a pressure that makes it oval."""
    shaft = bodies.uniform(3.0, 1.5 / thinness, 3.0)
    turn, along = mesh
    problem = bodies.cantilever(shaft, 3.0 / along * (1.0 + 1e-9), turn, rigid=False)
    return problem.system, problem.F


def flat(height: float) -> Solid:
    """A bar with a layer of slivers, bent."""
    return slivers.loaded(slivers.bar(height, 2))


def nearly_incompressible(distance: float) -> Solid:
    """A tube of two diameters in curved tetrahedra, Poisson's ratio so far from one half."""
    nu, shaft = 0.5 - distance, bodies.uniform(0.7, 0.175, 1.4)
    mesh = generate(shaft, sizes=MeshSizes(shaft=0.3, elements_per_turn=6))
    n = mesh.points.size
    front = rigid_point("front", np.zeros(3), n, n + 6)
    elimination = eliminate(
        [
            fixed("rear", mesh.face_nodes("shaft.rear"), n + 6),
            rigid_face("front", mesh.face_nodes("shaft.front"), mesh.points, front),
        ],
        n + 6,
    )
    modulus = bodies.STEEL.youngs_modulus
    lame = modulus * nu / ((1 + nu) * (1 - 2 * nu)), modulus / (2 * (1 + nu))
    K = assemble(mesh.points, mesh.cells, lame, n + 6)
    F = np.zeros((n + 6, 2))
    F[[n + 3, n + 4], [0, 1]] = 1.0
    system = reduce(mesh.points, mesh.cells, K, elimination)
    return system, np.asarray(elimination.T.T @ F)


def averaged(factor: float) -> Solid:
    """The library's main bearing with an averaged joint, and its unit loads."""
    scene = coarser_scene(library_scene("main_bearing_spherical"), factor, 6)
    scene = change_scene(scene, {"bearing_units.0.interface": "averaged"})
    model = build_model(scene, mesh_scene(scene))
    elimination = eliminate(model.constraints, model.n_dofs)
    system = reduce(model.mesh.points, model.mesh.cells, model.stiffness, elimination)
    return system, np.asarray(elimination.T.T @ model.unit_loads())


@dataclass(frozen=True)
class Sweep:
    """Solids over a parameter, and what protects where it goes too far, beside another solver."""

    solid: Callable[[float], Solid]
    values: Sequence[float]
    protects: str = ""


def sweeps(quick: bool) -> dict[str, Sweep]:
    """All of them, in short where the run is quick."""

    def of(full: Iterable[float], short: Iterable[float]) -> list[float]:
        return [float(x) for x in (short if quick else full)]

    return {
        "L/D of a shaft": Sweep(slender, of(SLENDERNESS, QUICK_SLENDERNESS)),
        "modulus of a ring over that of its shaft": Sweep(ring, of(CONTRAST, QUICK_CONTRAST)),
        IN_UNITS: Sweep(
            in_units,
            of(UNITS, QUICK_UNITS),
            "keeps double precision where single precision lacks the range",
        ),
        THIN_WALLS: Sweep(
            partial(thin, mesh=QUICK_TUBE if quick else TUBE), of(THINNESS, QUICK_THINNESS)
        ),
        "height of slivers over the size of their cubes": Sweep(
            flat,
            of(HEIGHTS, QUICK_HEIGHTS),
            f"refuses meshes with elements flatter than {FLATTEST:g}",
        ),
        "distance of Poisson's ratio from 1/2": Sweep(
            nearly_incompressible,
            of(DISTANCES, QUICK_DISTANCES),
            f"refuses ratios above {MAX_POISSON_RATIO:g} in a scene",
        ),
        "mesh sizes of a main bearing with an averaged joint, factor": Sweep(
            averaged, of(FACTORS, QUICK_FACTORS)
        ),
    }


IN_UNITS = "stiffness in other units, factor"
THIN_WALLS = "radius over wall of a tube"
STEPS = "iterations with the single-precision hierarchy over those with the double one, worst"
STATED = "answers of the program where neither converges: error over what is stated, worst"


@case(
    "A multigrid hierarchy in single precision: where it fails, and what protects",
    source="Smoothing with a rounded matrix: its error in the energy norm is the rounding times "
    "the root of the condition number; measured against a hierarchy in double precision",
)
def run(run: Run, page: Page) -> None:
    """Sweep shape, mesh, material, joint and units; count iterations with either precision."""
    asked = sweeps(run.quick)
    found = {
        name: [run.timed(f"{name}: {x:.3g}", tried, sweep.solid, x) for x in sweep.values]
        for name, sweep in asked.items()
    }
    every = [trial for swept in found.values() for trial in swept]
    check(page, every, found[IN_UNITS])
    answer(page, every, found[THIN_WALLS])
    page.say(
        "Where the range of single precision ends, the program keeps double precision.",
        *in_their_place(every),
    )
    sentences = beyond_bounds(found)
    if sentences:
        page.section("Bounds of the largest eigenvalue")
    for sentence in sentences:
        page.text(sentence)
    for name, swept in found.items():
        limit_of(page, name, swept, asked[name].protects)
        show(page, name, swept)
    page.image("A shaft of five diameters", run.sketch(bodies.uniform(0.7, 0.175, 3.5)))


def answer(page: Page, every: list[Trial], walls: list[Trial]) -> None:
    """State what single precision costs, and where neither precision converges."""
    lost = [t for t in every if t.double >= 0 > t.single]
    both = [t for t in every if max(t.single, t.double) < 0]
    more = max(t.single - t.double for t in every if min(t.single, t.double) >= 0)
    most = f"at most {more}" if more > 0 else "no"
    thinnest = safe_values(walls)[1]
    figures = [
        page.value("iterations more than in double precision, at worst", more),
        page.judged(STEPS, "ratio of iterations to those in double precision, at worst"),
        page.value(
            f"solids that fail in single precision alone, of {len(every)}", len(lost), at_most=0.0
        ),
        page.value(f"solids that fail in both precisions, of {len(every)}", len(both)),
    ]
    if thinnest is not None:
        figures.append(page.value("largest radius over wall with which a tube converges", thinnest))
    if any(not np.isnan(t.error) for t in every):
        figures.append(
            page.judged(
                STATED, "error of the program's results beyond, over the error that it states"
            )
        )
    page.answer(
        "May the multigrid preconditioner work in single precision?",
        (
            f"Yes: on {len(every)} solids it costs {most} extra iterations; "
            if not lost
            else f"No: on {len(lost)} of {len(every)} solids it alone fails; "
        )
        + f"{len(both)}"
        + (f", such as tubes with walls under 1/{thinnest:g} of the radius," if thinnest else "")
        + " fail in both precisions.",
        figures,
        hero=caption_of_iterations(THIN_WALLS),
        cautions=[
            "Only the preconditioner is in single precision: the stiffness and the iteration stay "
            "in double precision."
        ],
    )


def caption_of_iterations(name: str) -> str:
    """Caption of the chart of one sweep."""
    return (
        f"Iterations to an energy error of {formatted(TOLERANCE, 2, '')} over the {name}; shaded: "
        "both precisions converge"
    )


def check(page: Page, every: list[Trial], in_units: list[Trial]) -> None:
    """Check that single precision needs as many iterations, to the same answers."""
    page.vanishes(
        "solids on which the double-precision hierarchy converges and the single one does not",
        sum(t.double >= 0 > t.single for t in every),
        within=0.0,
        why="half the bytes must not cost robustness",
        source="the same solids, both hierarchies",
    )
    page.at_most(
        STEPS,
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
    answers = [t for t in every if not np.isnan(t.error)]
    if answers:
        page.at_most(
            STATED,
            max(t.error / (t.round_off + TOLERANCE) for t in answers),
            1.0,
            why="another solver takes over, and says what round-off may have done; beyond that the "
            "tolerance of iterations",
            source="a direct factor, refined",
        )
    beyond = [t for t in in_units if not 1e-45 < t.value < 1e28]
    page.holds(
        "stiffnesses beyond the range of single precision stay in double precision",
        all(t.stored == "float64" for t in beyond),
        why="an infinite entry is no preconditioner",
        source="the hierarchy's own choice",
    )


def show(page: Page, name: str, swept: list[Trial]) -> None:
    """Show the iterations of one sweep."""
    page.section(name)
    at = [t.value for t in swept if t.double >= 0], [t.value for t in swept if t.single >= 0]
    page.chart(
        caption_of_iterations(name),
        [
            trace("double precision", at[0], [t.double for t in swept if t.double >= 0]),
            trace("single precision", at[1], [t.single for t in swept if t.single >= 0], True),
        ],
        name,
        "iterations",
        "x",
        safe_values(swept),
    )
    page.table("Iterations to the same", [row_of(t) for t in swept])


def in_their_place(every: list[Trial]) -> list[str]:
    """Who answers where neither converges, in a sentence."""
    lost = [t for t in every if t.answered]
    if not lost:
        return []
    names = ", ".join(
        f"{name} {sum(t.answered == name for t in lost)}"
        for name in sorted({t.answered for t in lost})
    )
    return [
        f"On {len(lost)} neither converges. Asked for multigrid, whose coarsest level is larger in "
        f"the program, these answer: {names}."
    ]


def beyond_bounds(found: dict[str, list[Trial]]) -> list[str]:
    """Where the smoother's bound of the largest eigenvalue is none, and what that does."""
    sentences = []
    for name, swept in found.items():
        over = [t for t in swept if t.beyond > SMOOTHED]
        if over:
            lost = sum(t.double < 0 for t in over)
            values = ", ".join(f"{t.value:.0e}" for t in over)
            sentences.append(
                f"{multigrid.LANCZOS_STEPS} steps of Lanczos miss the largest eigenvalue, which "
                f"is up to {max(t.beyond for t in over):.2f} times their bound, where {name} is "
                f"{values}. On {lost} of these {len(over)} solids iterations do not converge, "
                "with either precision."
            )
    return sentences


def safe_values(swept: list[Trial]) -> tuple[float | None, float | None]:
    """Range of values over which single precision converges."""
    return safe_range(
        [t.value for t in swept], [0.0 if t.single >= 0 else np.inf for t in swept], 0.5
    )


def limit_of(page: Page, name: str, swept: list[Trial], protects: str) -> None:
    """Over which values both hierarchies converge; beyond, neither does."""
    low, high = safe_values(swept)
    page.limit(
        "multigrid in single precision",
        name,
        low=low,
        high=high,
        criterion=f"reaches the solvers' tolerance within {multigrid.MAX_ITERATIONS} iterations",
        beyond="neither precision converges" if (low, high) != (None, None) else "no limit found",
        program="takes a direct factor or patches where iterations do not converge"
        + (f"; {protects}" if protects else ""),
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
        "largest eigenvalue over its bound": trial.beyond,
        "answered by": trial.answered or None,
        "error of the answer": None if np.isnan(trial.error) else trial.error,
        "round-off, as stated": None if np.isnan(trial.round_off) else trial.round_off,
    }
