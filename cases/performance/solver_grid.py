"""Which solver is fastest for which solid, and does ``auto`` know? How honest is the stopping?"""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common import Floats
from fe_drivetrain.geometry import MeshSizes, Section, Shaft
from fe_drivetrain.interfaces import eliminate, fixed, rigid_face, rigid_point
from fe_drivetrain.mesh import generate
from fe_drivetrain.operator import assemble
from fe_drivetrain.report import Chart, Results, Table, Text, Verdict, environment, judge
from fe_drivetrain.report import Section as PageSection
from fe_drivetrain.response import build_model, mesh_scene
from fe_drivetrain.scene import MATERIALS, library_scene
from fe_drivetrain.solve import (
    METHODS,
    Options,
    System,
    cost_model,
    direct_solvers,
    factorise,
    multigrid,
    reduce,
)
from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

MANY = 12  # right-hand sides

#: A solver predicted to need more than this is left out of the grid [s].
TIME_LIMIT = 6.0

#: Choices within this of the best are as good: run to run, times differ by that much.
ALLOWED = 1.5

#: Energy error below which a direct solution in double precision is no reference any more.
FLOOR = 1e-8


@dataclass(frozen=True)
class Problem:
    """A system with its loads.

    Attributes
    ----------
    name
        For tables.
    system
        What is solved.
    loads
        (n, 12) twelve right-hand sides.
    """

    name: str
    system: System
    loads: Floats


@dataclass(frozen=True)
class Timing:
    """Cost of one solver on one problem: seconds of set-up and of 1 and 12 right-hand sides."""

    setup: float
    one: float
    many: float
    bytes: int
    iterations: int

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
    """Best of several runs."""
    found = []
    for _ in range(repetitions):
        solver = factorise(problem.system, method)
        one = solver.solve(np.ascontiguousarray(problem.loads[:, :1]))
        many = solver.solve(problem.loads)
        found.append((solver.setup_seconds, one.solve_seconds, many.solve_seconds))
    setup, first, twelve = np.min(found, axis=0).tolist()
    return Timing(setup, first, twelve, solver.bytes, many.iterations)


def study(run: Run, case: Case) -> Results:
    """Time the grid, try the options, watch the stopping."""
    if run.quick:
        grid: list[Callable[[], Problem]] = [
            lambda: shaft_problem(2.0, 0.4, turn=6),
            lambda: shaft_problem(2.0, 0.2, turn=8),
        ]
    else:
        grid = [lambda s=s: shaft_problem(2.0, s) for s in (0.3, 0.09, 0.065, 0.0515)]  # type: ignore[misc]
        grid += [lambda s=s: shaft_problem(14.0, s) for s in (0.3,)]  # type: ignore[misc]
        grid += [lambda s=s: bearing_problem("bonded", s) for s in (2.5, 1.0)]  # type: ignore[misc]
        grid += [lambda: bearing_problem("spherical", 1.0)]
        # These two had no part in fitting the constants of `cost`.
        grid += [lambda: shaft_problem(6.0, 0.1), lambda: bearing_problem("bonded", 1.6)]
    installed = [
        m for m in METHODS if m == "multigrid" or (m != "auto" and direct_solvers.is_installed(m))
    ]
    with run.step("compile"):
        timed(shaft_problem(1.0, 0.5), "multigrid", 1)

    problems, timings = [], []
    for number, make in enumerate(grid, start=1):
        problem = make()
        with run.step(f"grid of solvers ({number} of {len(grid)})"):
            costs = {c.method: c for c in cost_model.predict(problem.system, MANY)}
            methods = [m for m in installed if costs[m].seconds < TIME_LIMIT]
            repetitions = 2 if problem.system.n_free < 30_000 else 1
            timings.append({m: timed(problem, m, repetitions) for m in methods})
        problems.append(problem)
    grid_items, grid_verdicts, worst = _grid_results(problems, timings, installed)

    with run.step("options of multigrid"):
        tried = problems[1:] if run.quick else [problems[1], bearing_problem("spherical", 2.0)]
        tables = [_options_table(problem) for problem in tried]
    with run.step("stopping"):
        stopping_items, stopping_verdicts = _stopping(run.quick)
    ratio = [t["multigrid"].total(MANY) / t["multigrid"].total(1) for t in timings]
    iterating = [t["multigrid"].many / t["multigrid"].one for t in timings]
    verdicts = [
        *grid_verdicts,
        judge(
            f"multigrid, {MANY} right-hand sides against one, set-up included, worst of the grid",
            max(ratio),
            0.0,
            tolerance=4.0,
            relative=False,
            unit="x",
            source="measured side by side",
            reason="all right-hand sides share the hierarchy and every pass over a matrix",
        ),
        *stopping_verdicts,
    ]
    return Results(
        case=case.name,
        title=case.title,
        source=case.source,
        summary=[
            f"The solver that auto chose was at worst {worst:.2f} times as slow as the best one, "
            f"over {len(problems)} systems with 1 and with {MANY} right-hand sides.",
            f"Multigrid takes {min(ratio):.1f} to {max(ratio):.1f} times as long for {MANY} "
            f"right-hand sides as for one ({min(iterating):.1f} to {max(iterating):.1f} times in "
            "the iterations alone).",
        ],
        verdicts=verdicts,
        sections=[
            PageSection(title="Solvers side by side", items=grid_items),
            PageSection(
                title="Options of multigrid that were tried",
                items=[
                    *tables,
                    Text(
                        text="Each row changes one option. Times are of set-up and 12 right-hand "
                        "sides, in this run; a row that stops short of the tolerance says so."
                    ),
                ],
            ),
            PageSection(title="When to stop", items=stopping_items),
        ],
        times=run.times,
        figures={
            "worst_choice": worst,
            "grid": [
                {
                    "problem": problem.name,
                    "unknowns": problem.system.n_free,
                    "nonzeros": problem.system.K.nnz,
                    "width": cost_model.width(problem.system.K),
                    **{m: vars(t) for m, t in timing.items()},
                }
                for problem, timing in zip(problems, timings, strict=True)
            ],
        },
        environment=environment(run.settings, seed=0),
    )


def _grid_results(
    problems: Sequence[Problem], timings: Sequence[dict[str, Timing]], installed: Sequence[str]
) -> tuple[list[Any], list[Verdict], float]:
    rows: list[list[Any]] = []
    choices: list[list[Any]] = []
    worst = 1.0
    for problem, timing in zip(problems, timings, strict=True):
        system = problem.system
        for method in installed:
            t = timing.get(method)
            label = [problem.name, f"{system.n_free:,}", method]
            if t is None:
                rows.append([*label, None, None, None, None, None])
                continue
            memory = t.bytes / 2**20
            rows.append([*label, t.setup, t.one, t.many, memory, t.iterations or None])
        for n_rhs in (1, MANY):
            predicted = next(c for c in cost_model.predict(system, n_rhs) if c.method in timing)
            times = {m: t.total(n_rhs) for m, t in timing.items()}
            best = min(times, key=times.__getitem__)
            slower = times[predicted.method] / times[best]
            worst = max(worst, slower)
            choices.append(
                [
                    problem.name,
                    f"{system.n_free:,}",
                    n_rhs,
                    predicted.method,
                    predicted.seconds,
                    times[predicted.method],
                    best,
                    times[best],
                    slower,
                ]
            )
    verdicts = [
        judge(
            "auto against the best solver, worst of the grid",
            worst,
            1.0,
            tolerance=ALLOWED - 1.0,
            relative=False,
            unit="x",
            source="every installed solver on every system of the grid, in this run",
            reason="times of one solver differ by about that much from run to run",
        )
    ]
    items = [
        _time_chart(problems, timings, installed),
        Table(
            caption=f"Seconds of set-up, one and {MANY} right-hand sides; empty where more than "
            f"{TIME_LIMIT:.0f} s were predicted",
            columns=[
                "system",
                "unknowns",
                "solver",
                "set-up [s]",
                "1 [s]",
                f"{MANY} [s]",
                "memory [MiB]",
                "iterations",
            ],
            rows=rows,
        ),
        Table(
            caption="What auto chose",
            columns=[
                "system",
                "unknowns",
                "right-hand sides",
                "chosen",
                "predicted [s]",
                "measured [s]",
                "best",
                "best [s]",
                "times the best",
            ],
            rows=choices,
        ),
    ]
    return items, verdicts, worst


def _time_chart(
    problems: Sequence[Problem], timings: Sequence[dict[str, Timing]], installed: Sequence[str]
) -> Chart:
    data = []
    marks = {name: k for k, name in enumerate(dict.fromkeys(p.name for p in problems))}
    for method in installed:
        shown = [(p, t[method]) for p, t in zip(problems, timings, strict=True) if method in t]
        data.append(
            {
                "type": "scatter",
                "mode": "markers",
                "name": method,
                "x": [p.system.n_free for p, _ in shown],
                "y": [t.total(MANY) for _, t in shown],
                "text": [p.name for p, _ in shown],
                "marker": {"symbol": [marks[p.name] for p, _ in shown], "size": 10},
            }
        )
    return Chart(
        caption=f"Set-up and {MANY} right-hand sides; a symbol for each solid",
        figure={
            "data": data,
            "layout": {
                "xaxis": {"title": {"text": "unknowns"}, "type": "log"},
                "yaxis": {"title": {"text": "time [s]"}, "type": "log"},
            },
        },
    )


#: One option at a time.
TRIED = {
    "as it is": Options(),
    "smoother of degree 1": Options(degree=1),
    "smoother of degree 3": Options(degree=3),
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


def _options_table(problem: Problem) -> Table:
    system, F = problem.system, problem.loads
    rows: list[list[Any]] = []
    for label, options in TRIED.items():
        start = time.perf_counter()
        hierarchy = multigrid.build(system, options)
        setup = time.perf_counter() - start
        found = multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, 1e-9)
        total = time.perf_counter() - start
        reached = "" if found.energy_error <= 1e-9 else f"stopped at {found.energy_error:.0e}"
        rows.append([label, found.iterations, setup, total, hierarchy.bytes / 2**20, reached])
    columns = ["option", "iterations", "set-up [s]", "total [s]", "memory [MiB]", "remark"]
    return Table(caption=f"{problem.name}, {system.n_free:,} unknowns", columns=columns, rows=rows)


def _stopping(quick: bool) -> tuple[list[Any], list[Verdict]]:
    """Residual, estimate and true energy error, step by step."""
    shapes: dict[str, Callable[[], Problem]] = {
        "chunky, L/D = 2.9": lambda: shaft_problem(2.0, 0.4, turn=8),
        "slender, L/D = 20": lambda: shaft_problem(14.0, 0.4, turn=8),
        "thin tube, D = 3 m, t = 0.02 m": lambda: shaft_problem(1.0, 0.06, 3.0, 2.96),
    }
    if quick:
        del shapes["thin tube, D = 3 m, t = 0.02 m"], shapes["slender, L/D = 20"]
    items: list[Any] = []
    verdicts: list[Verdict] = []
    rows: list[list[Any]] = []
    for name, make in shapes.items():
        problem = make()
        system, F = problem.system, np.ascontiguousarray(problem.loads[:, :6])
        K = system.K
        factor = direct_solvers.factorise(K, "superlu")
        exact = factor.apply(F)
        direct_residual = _residual(K, exact, F)
        exact = exact + factor.apply(F - K @ exact)
        hierarchy = multigrid.build(system)
        history = []
        for found in multigrid.iterates(K, F, hierarchy.precondition):
            error = (_energy(K, found.x - exact) / _energy(K, exact)).max()
            residual = _residual(K, found.x, F)
            history.append((found.iterations, residual, found.energy_error, error))
            if error < FLOOR or found.iterations == multigrid.MAX_ITERATIONS:
                break
        seen = np.array(history)
        above = seen[:, 3] > FLOOR
        honest = float((seen[above, 2] / seen[above, 3]).min())
        items.append(_stopping_chart(name, seen))
        verdicts.append(
            judge(
                f"{name}: estimated over true energy error, least",
                min(honest, 1.0),
                1.0,
                tolerance=0.5,
                relative=False,
                source="a direct solution, refined",
                reason="an estimate that is never half of the truth stops no later than one step",
            )
        )
        solution = factorise(system, "multigrid").solve(F)
        stiffness = np.abs(_work(F, solution.x) / _work(F, exact) - 1.0).max()
        rows.append(
            [
                name,
                f"{system.n_free:,}",
                direct_residual,
                solution.residual,
                solution.energy_error,
                float(stiffness),
                solution.method,
                solution.iterations or None,
                "" if solution.method == "multigrid" else solution.reason,
            ]
        )
        verdicts.append(
            judge(
                f"{name}: stiffness by multigrid or what it falls back to, against direct",
                float(stiffness),
                0.0,
                tolerance=1e-6,
                relative=False,
                source="a direct solution, refined",
                reason="six digits of stiffness, whatever the residual",
            )
        )
    items.append(
        Table(
            caption="What multigrid delivers at its default tolerance, and where it hands over",
            columns=[
                "solid",
                "unknowns",
                "residual, direct",
                "residual",
                "energy error, estimated",
                "error of stiffness",
                "solver",
                "iterations",
                "remark",
            ],
            rows=rows,
        )
    )
    items.append(
        Text(
            text="The residual of a slender solid stays large although its stiffness is right to "
            "many digits: its stiffest and softest motions differ by ten decades. The estimate of "
            "the energy error follows the truth, so iterations stop on that; squared, it is the "
            "error of a load's own stiffness."
        )
    )
    return items, verdicts


def _stopping_chart(name: str, seen: Floats) -> Chart:
    labels = ("relative residual", "energy error, estimated", "energy error, true")
    return Chart(
        caption=f"{name}: worst of six loads",
        figure={
            "data": [
                {
                    "type": "scatter",
                    "mode": "lines+markers",
                    "name": label,
                    "x": seen[:, 0].tolist(),
                    "y": seen[:, k].tolist(),
                }
                for k, label in enumerate(labels, start=1)
            ],
            "layout": {
                "xaxis": {"title": {"text": "iterations"}},
                "yaxis": {
                    "title": {"text": "relative"},
                    "type": "log",
                    "exponentformat": "power",
                },
            },
        },
    )


def _work(F: Floats, x: Floats) -> Floats:
    return np.asarray(np.einsum("nm,nm->m", F, x))


def _energy(K: Any, x: Floats) -> Floats:
    return np.sqrt(_work(x, K @ x))


def _residual(K: Any, x: Floats, F: Floats) -> float:
    return float((np.linalg.norm(K @ x - F, axis=0) / np.linalg.norm(F, axis=0)).max())
