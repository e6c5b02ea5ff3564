"""Which solver is fastest for which solid, and does ``auto`` know? How honest is the stopping?"""

from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial

import numpy as np
from scipy import sparse

from fe_drivetrain.cases import case
from fe_drivetrain.cases.performance import cost_fit
from fe_drivetrain.cases.performance.solver_answer import ALLOWED, MANY, SHARED, TIMES, answer
from fe_drivetrain.common import Floats, Times, timed_runs
from fe_drivetrain.drivetrain_file import MATERIALS, library_scene
from fe_drivetrain.elasticity.interfaces import eliminate, fixed, rigid_face, rigid_point
from fe_drivetrain.elasticity.mesh import generate
from fe_drivetrain.elasticity.operator import assemble
from fe_drivetrain.elasticity.solve import (
    METHODS,
    Options,
    System,
    cost_model,
    direct_solvers,
    factorise,
    multigrid,
    reduce,
)
from fe_drivetrain.geometry import MeshSizes, Section, Shaft
from fe_drivetrain.report import Chart, chart, error_bars, marked, trace
from fe_drivetrain.report.suite import Page, Record, Run, column, goal, grouped
from fe_drivetrain.shafts.response import build_model, mesh_scene

ENDS = f"set-up and {MANY}, least [s]", "in all [s]", "most [s]"

#: A solver predicted to need more than this is left out of the grid [s].
TIME_LIMIT = 6.0

#: Systems of the grid on which constants of the cost model are fitted; the others only test them.
FITTED = 8

#: Energy error below which a direct solution in double precision is no reference any more.
FLOOR = 1e-8


@dataclass(frozen=True)
class Problem:
    """A system with its loads.

    Attributes
    ----------
    name : str
        For tables.
    system : System
        What is solved.
    loads : ndarray
        (n, 12) twelve right-hand sides.
    """

    name: str
    system: System
    loads: Floats


@dataclass(frozen=True)
class Timing:
    """Cost of one solver on one problem: medians of set-up and of 1 and 12 right-hand sides [s]."""

    setup: float
    one: float
    many: float
    bytes: int
    iterations: int
    #: Set-up and 12 right-hand sides of each run.
    runs: Times

    def total(self, n_rhs: int) -> float:
        """Set-up and solve of 1 or of 12 right-hand sides [s]."""
        return self.setup + (self.one if n_rhs == 1 else self.many)


def shaft_problem(
    length: float, size: float, outer: float = 0.7, inner: float = 0.3, turn: int = 12
) -> Problem:
    """A hollow shaft held at the rear, its front face a rigid reference point."""
    section = Section(length=length, outer_diameter=outer, inner_diameter=inner)
    sizes = MeshSizes(shaft=size, elements_per_turn=turn)
    mesh = generate(Shaft(sections=(section,), front=0.0), [], {}, sizes)
    points, n = mesh.points, mesh.points.size + 6
    front = rigid_point("front", np.zeros(3), mesh.points.size, n)
    elimination = eliminate(
        [
            rigid_face("front", mesh.face_nodes("shaft.front"), points, front),
            fixed("rear", mesh.face_nodes("shaft.rear"), n),
        ],
        n,
    )
    K = assemble(points, mesh.cells, MATERIALS["steel"].lame, n)
    system = reduce(points, mesh.cells, K, elimination)
    ends = front.motion.T.toarray()
    # Six loads at the end, and six spread over the body.
    weight = np.zeros((n, 6))
    for k in range(6):
        weight[k % 3 : points.size : 3, k] = np.cos((1 + k // 3) * np.pi * points[:, 0] / length)
    loads = elimination.T.T @ np.hstack([ends, weight / len(points)])
    return Problem(f"shaft, L/D = {length / outer:.3g}", system, loads)


def bearing_problem(kind: str, scale: float) -> Problem:
    """The main bearing of the library; the ten unit loads, and two sums of them."""
    scene = library_scene(f"main_bearing_{kind}")
    scene = scene.model_copy(update={"mesh": scene.mesh.scaled(scale)})
    model = build_model(scene, mesh_scene(scene))
    elimination = eliminate(model.constraints, model.n_dofs)
    system = reduce(model.mesh.points, model.mesh.cells, model.stiffness, elimination)
    loads = elimination.T.T @ model.unit_loads()
    loads = np.hstack([loads, loads[:, :2] + loads[:, 2:4]])
    return Problem(f"main bearing, {kind}", system, loads)


def timed(problem: Problem, method: str, repetitions: int) -> Timing:
    """Several runs, each with a set-up of its own."""
    found = []
    for _ in range(repetitions):
        solver = factorise(problem.system, method)
        one = solver.solve(np.ascontiguousarray(problem.loads[:, :1]))
        many = solver.solve(problem.loads)
        found.append(
            (solver.setup_seconds, one.diagnostics.solve_seconds, many.diagnostics.solve_seconds)
        )
    setup, first, twelve = np.median(found, axis=0).tolist()
    runs = Times(tuple(setup + many for setup, _, many in found))
    return Timing(setup, first, twelve, solver.bytes, many.diagnostics.iterations, runs)


@case(
    "Solvers side by side, what auto chooses, and when to stop",
    source="Vanek, Mandel, Brezina 1996; Meurant, Papez, Tichy 2021; measured in one run",
    settings={"repeats": "5 (quick 1; from 1)"},
    alone="full",
)
def run(run: Run, page: Page) -> None:
    """Time the grid, try the options, watch the stopping."""
    with run.step("compile"):
        timed(shaft_problem(1.0, 0.5), "multigrid", 1)
    repeats = run.count("repeats", 1 if run.quick else 5)
    problems, timings = measured(run, repeats)
    choices = compare_choices(page, problems, timings)
    worst = float(max(column(choices, "times the best")))
    ratio = [t["multigrid"].total(MANY) / t["multigrid"].total(1) for t in timings]
    iterating = [t["multigrid"].many / t["multigrid"].one for t in timings]
    page.say(
        f"Multigrid takes {min(ratio):.1f} to {max(ratio):.1f} times as long for {MANY} right-hand "
        f"sides as for one ({min(iterating):.1f} to {max(iterating):.1f} times in the iterations "
        "alone)."
    )
    page.section("Goals")
    page.table(
        "Times of one solver differ by half from run to run; all right-hand sides share "
        "multigrid's hierarchy and every pass over a matrix",
        [
            goal("auto against the best solver, worst of the grid [x]", worst, most=ALLOWED),
            goal(
                f"multigrid, {MANY} right-hand sides against one, set-up included, worst of the "
                "grid [x]",
                max(ratio),
                most=SHARED,
            ),
        ],
    )
    page.section("Options of multigrid that were tried")
    with run.step("options of multigrid"):
        for problem in (
            problems[:1] if run.quick else [problems[1], bearing_problem("spherical", 2)]
        ):
            unknowns = problem.system.n_free
            page.table(f"{problem.name}, {unknowns:,} unknowns", option_rows(problem, repeats))
    page.text(
        "Each row changes one option. Times are of set-up and 12 right-hand sides; a "
        "row that stops short of the tolerance says so."
    )
    page.section("When to stop")
    with run.step("stopping"):
        check_stopping(page, run.quick)
    answer(page, choices, max(ratio))


def measured(run: Run, repeats: int) -> tuple[list[Problem], list[dict[str, Timing]]]:
    """Every installed solver on every system of the grid that it is not too slow for."""
    grid: list[Callable[[], Problem]] = []
    if run.quick:
        grid += [
            partial(shaft_problem, 2.0, 0.4, turn=6),
            partial(shaft_problem, 2.0, 0.2, turn=8),
        ]
    else:
        grid += [partial(shaft_problem, 2.0, size) for size in (0.3, 0.09, 0.065, 0.0515)]
        grid += [partial(shaft_problem, 14.0, 0.3)]
        grid += [partial(bearing_problem, "bonded", scale) for scale in (2.5, 1.0)]
        grid += [partial(bearing_problem, "spherical", 1.0)]
        # These two have no part in fitting the constants of `cost_model`.
        grid += [partial(shaft_problem, 6.0, 0.1), partial(bearing_problem, "bonded", 1.6)]
    problems, timings = [], []
    for number, make in enumerate(grid, start=1):
        problem = make()
        with run.step(f"grid of solvers ({number} of {len(grid)})"):
            costs = {c.method: c for c in cost_model.predict(problem.system, MANY)}
            methods = [m for m in installed() if costs[m].seconds < TIME_LIMIT]
            timings.append({m: timed(problem, m, repeats) for m in methods})
        problems.append(problem)
    return problems, timings


def installed() -> list[str]:
    """Multigrid, and the direct solvers that are installed here."""
    return [
        m for m in METHODS if m == "multigrid" or (m != "auto" and direct_solvers.is_installed(m))
    ]


def compare_choices(
    page: Page, problems: list[Problem], timings: list[dict[str, Timing]]
) -> list[Record]:
    """What every solver took; the choices of ``auto`` beside the best ones."""
    rows = [
        side_by_side(problem, method, timing.get(method))
        for problem, timing in zip(problems, timings, strict=True)
        for method in installed()
    ]
    choices = [
        choice(problem, timing, n_rhs)
        for problem, timing in zip(problems, timings, strict=True)
        for n_rhs in (1, MANY)
    ]
    worst = max(column(choices, "times the best"))
    page.section("Solvers side by side")
    page.add(time_chart(rows))
    page.table(
        f"Medians of set-up, of one and of {MANY} right-hand sides; empty where more than "
        f"{TIME_LIMIT:.0f} s were predicted",
        rows,
        [key for key in rows[0] if key not in ("n", "in all [s]")],
    )
    page.table("What auto chose", choices)
    page.table(
        "Constants of the cost model: those in use, and those that this run's times ask for (least "
        "squares of relative errors). Ratios between solvers are what counts",
        constants(problems, timings),
    )
    page.data("worst_choice", worst)
    page.data(
        "grid",
        [
            {
                "problem": problem.name,
                "unknowns": problem.system.n_free,
                "nonzeros": problem.system.K.nnz,
                "width": cost_model.width(problem.system.K),
                **{m: asdict(t) for m, t in timing.items()},
            }
            for problem, timing in zip(problems, timings, strict=True)
        ],
    )
    return choices


def labels(problem: Problem) -> Record:
    """Name and size of a system."""
    return {"system": problem.name, "unknowns": f"{problem.system.n_free:,}"}


def side_by_side(problem: Problem, method: str, t: Timing | None) -> Record:
    """Costs of one solver for a system; empty where it was not tried."""
    return {
        **labels(problem),
        "solver": method,
        "set-up [s]": t and t.setup,
        "1 [s]": t and t.one,
        f"{MANY} [s]": t and t.many,
        f"set-up and {MANY}, least [s]": t and t.runs.least,
        "median [s]": t and t.runs.median,
        "most [s]": t and t.runs.most,
        "memory [MiB]": t and t.bytes / 2**20,
        "iterations": (t and t.iterations) or None,
        "n": problem.system.n_free,
        "in all [s]": t and t.total(MANY),
    }


def choice(problem: Problem, timing: dict[str, Timing], n_rhs: int) -> Record:
    """The choice of auto for `n_rhs` right-hand sides, beside the best of the solvers tried."""
    costs = cost_model.predict(problem.system, n_rhs)
    predicted = next(c for c in costs if c.method in timing)
    times = {m: t.total(n_rhs) for m, t in timing.items()}
    best = min(times, key=times.__getitem__)
    return {
        **labels(problem),
        "right-hand sides": n_rhs,
        "chosen": predicted.method,
        "predicted [s]": predicted.seconds,
        "measured [s]": times[predicted.method],
        "best": best,
        "best [s]": times[best],
        "times the best": times[predicted.method] / times[best],
    }


def constants(problems: list[Problem], timings: list[dict[str, Timing]]) -> list[Record]:
    """Constants of `cost_model` for every solver, in use and fitted."""
    known = list(zip(problems, timings, strict=True))[:FITTED]
    rows = []
    for method in installed():
        timed_here = [(p.system, t[method]) for p, t in known if method in t]
        if timed_here:
            systems, times = zip(*timed_here, strict=True)
            rows += cost_fit.rows_of(method, systems, times, (1, MANY))
    return rows


def time_chart(rows: list[Record]) -> Chart:
    """Time against unknowns, a symbol for each solid."""
    marks = {name: k for k, (name, _) in enumerate(grouped(rows, "system"))}
    traces = [
        trace(
            method,
            column(shown, "n"),
            column(shown, "in all [s]"),
            points=True,
            text=column(shown, "system"),
            **error_bars("y", *(column(shown, end) for end in ENDS)),
            marker={"symbol": [marks[row["system"]] for row in shown], "size": 10},
        )
        for method, shown in grouped([row for row in rows if row["in all [s]"]], "solver")
    ]
    return chart(
        TIMES,
        traces,
        "unknowns",
        "time [s]",
        "xy",
    )


#: One option at a time.
TRIED = {
    "as it is": Options(),
    "levels in double precision": Options(single=False),
    "smoother of degree 2 on the finest level, too": Options(degree=2),
    "smoother of degree 3 on the finest level": Options(degree=3),
    "smoother of degree 1 on all levels": Options(coarse_degree=1),
    "smoother from 0.1 of the largest eigenvalue": Options(smoothed=0.1),
    "smoother from 0.3 of the largest eigenvalue": Options(smoothed=0.3),
    "no linear level: aggregates of quadratic nodes": Options(linear_level=False),
    "strength of connection 0.02": Options(strength=0.02),
    "strength of connection 0.25": Options(strength=0.25),
    "tentative prolongation": Options(prolongation_smoother=None),
    "energy-minimising prolongation": Options(prolongation_smoother="energy"),
    "larger coarsest level": Options(coarsest=900),
    "aggregates across joints": Options(apart=False),
}


def option_rows(problem: Problem, repeats: int) -> list[Record]:
    """What each option of multigrid takes, and where it stops."""
    system, F = problem.system, problem.loads
    rows = []
    for label, options in TRIED.items():

        def whole(
            options: Options = options,
        ) -> tuple[multigrid.Hierarchy | multigrid.Joined, Times, multigrid.Iteration]:
            hierarchy, setup = timed_runs(partial(multigrid.build, system, options), 1)
            found = multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, 1e-9)
            return hierarchy, setup, found

        (hierarchy, setup, found), total = timed_runs(whole, repeats)
        rows.append(
            {
                "option": label,
                "iterations": found.iterations,
                "set-up of the last [s]": setup.most,
                **total.columns("both"),
                "memory [MiB]": hierarchy.bytes / 2**20,
                "remark": ""
                if found.energy_error <= 1e-9
                else f"stopped at {found.energy_error:.0e}",
            }
        )
    return rows


def check_stopping(page: Page, quick: bool) -> None:
    """Residual, estimate and true energy error, step by step."""
    shapes: dict[str, Callable[[], Problem]] = {
        "chunky, L/D = 2.9": partial(shaft_problem, 2.0, 0.4, turn=8)
    }
    if not quick:
        shapes["slender, L/D = 20"] = partial(shaft_problem, 14.0, 0.4, turn=8)
        shapes["thin tube, D = 3 m, t = 0.02 m"] = partial(shaft_problem, 1.0, 0.06, 3.0, 2.96)
    rows = [check_stop(page, name, make()) for name, make in shapes.items()]
    page.table("What multigrid delivers at its default tolerance, and where it hands over", rows)
    page.text(
        "The residual of a slender solid stays large although its stiffness is right to many "
        "digits: its stiffest and softest motions differ by ten decades. The estimate of the "
        "energy error follows the truth, so iterations stop on that; squared, it is the error of a "
        "load's own stiffness."
    )


def check_stop(page: Page, name: str, problem: Problem) -> Record:
    """One solid: its chart and checks; a row of the table."""
    system, F = problem.system, np.ascontiguousarray(problem.loads[:, :6])
    K = system.K
    factor = direct_solvers.factorise(K, "superlu")
    exact = factor.apply(F)
    direct_residual = residual(K, exact, F)
    exact = exact + factor.apply(F - K @ exact)
    hierarchy = multigrid.build(system)
    history = []
    for found in multigrid.iterates(K, F, hierarchy.precondition):
        error = (energy(K, found.x - exact) / energy(K, exact)).max()
        history.append((found.iterations, residual(K, found.x, F), found.energy_error, error))
        if error < FLOOR or found.iterations == multigrid.MAX_ITERATIONS:
            break
    iterations, residuals, estimated, true = np.array(history).T
    above = true > FLOOR
    page.at_least(
        f"{name}: estimated over true energy error, least",
        (estimated[above] / true[above]).min(),
        0.5,
        why="an estimate that is never half of the truth stops no later than one step",
        source="a direct solution, refined",
    )
    solution = factorise(system, "multigrid").solve(F)
    stiffness = np.abs(work(F, solution.x) / work(F, exact) - 1.0).max()
    page.vanishes(
        f"{name}: stiffness by multigrid or what it falls back to, against direct",
        stiffness,
        within=1e-6,
        why="six digits of stiffness, whatever the residual",
        source="a direct solution, refined",
    )
    page.chart(
        f"{name}: worst of six loads",
        [
            marked(label, iterations, values)
            for label, values in (
                ("relative residual", residuals),
                ("energy error, estimated", estimated),
                ("energy error, true", true),
            )
        ],
        "iterations",
        "relative",
        "y",
    )
    return {
        "solid": name,
        "unknowns": f"{system.n_free:,}",
        "residual, direct": direct_residual,
        "residual": solution.diagnostics.residual,
        "energy error, estimated": solution.diagnostics.energy_error,
        "error of stiffness": stiffness,
        "solver": solution.diagnostics.method,
        "iterations": solution.diagnostics.iterations or None,
        "remark": "" if solution.diagnostics.method == "multigrid" else solution.diagnostics.reason,
    }


def work(F: Floats, x: Floats) -> Floats:
    return np.asarray(np.einsum("nm,nm->m", F, x))


def energy(K: sparse.bsr_array, x: Floats) -> Floats:
    return np.sqrt(work(x, K @ x))


def residual(K: sparse.bsr_array, x: Floats, F: Floats) -> float:
    return float((np.linalg.norm(K @ x - F, axis=0) / np.linalg.norm(F, axis=0)).max())
