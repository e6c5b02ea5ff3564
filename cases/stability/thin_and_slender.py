"""What solvers make of tubes and shafts: iterations, residuals, true errors, condition numbers."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, onenormest
from skfem.quadrature import get_quadrature

from fe_drivetrain.common import Floats, InputError
from fe_drivetrain.geometry import Section, Shaft
from fe_drivetrain.interfaces import eliminate, fixed, rigid_face, rigid_point
from fe_drivetrain.mesh import (
    Hexahedra,
    element_kind,
    facet_points,
    jacobian,
    local_facets,
    shaft_hexahedra,
)
from fe_drivetrain.operator import assemble
from fe_drivetrain.report import Chart, Table, chart, trace
from fe_drivetrain.scene import MATERIALS
from fe_drivetrain.solve import System, direct_solvers, multigrid, reduce, schwarz, solvers

STEEL = MATERIALS["steel"]

#: Iterations go on to here where the program gives up before.
ITERATIONS = 150

#: Elements of a short shaft, and diameters beyond which an element is long.
SHORT, LONG = 4, 10.0

#: Of a residual that is commonly taken for an answer.
RESIDUAL = 1e-8

RIGHT, WRONG = 1e-4, 1e-3
"""Error of a compliance below which an answer has four digits, and above which it has not three."""


@dataclass(frozen=True)
class Problem:
    """A body with its loads.

    Attributes
    ----------
    mesh, shaft
        Of the body.
    system
        Constraints eliminated.
    F
        (n, m) loads.
    """

    mesh: Hexahedra
    shaft: Shaft
    system: System
    F: Floats

    def compliance(self, x: Floats) -> Floats:
        """(m,) work of each load on its own motion [m/N, rad/(N m), or J]."""
        return np.asarray(np.einsum("nm,nm->m", self.F, x))


def uniform(diameter: float, wall: float, length: float) -> Shaft:
    """A tube along x from 0."""
    bore = diameter - 2.0 * wall
    return Shaft(
        front=0.0,
        sections=(Section(length=length, outer_diameter=diameter, inner_diameter=bore),),
    )


def cantilever(
    shaft: Shaft, size: float, turn: int, rigid: bool = True, refinement: int = 1
) -> Problem:
    """A shaft held at its rear end; torsion, and bending or an oval pressure.

    Parameters
    ----------
    shaft, size, turn, refinement
        Elements of 27 nodes: their length [m], and how many go round, before each is cut into so
        many in every direction.
    rigid
        A rigid front end with a moment about x and one about y; else a free end, twisted by
        tractions, and a pressure of 1 Pa times cos 2t on the outer surface.
    """
    mesh = shaft_hexahedra(shaft, size, 27, elements_per_turn=turn, refinement=refinement)
    n = mesh.points.size
    n_dofs = n + 6 if rigid else n
    F = np.zeros((n_dofs, 2))
    constraints = [fixed("rear", mesh.rear, n_dofs)]
    if rigid:
        front = rigid_point("front", np.array([shaft.front, 0.0, 0.0]), n, n_dofs)
        constraints.append(rigid_face("front", mesh.front, mesh.points, front))
        F[[n + 3, n + 4], [0, 1]] = 1.0
    else:
        F[:, 0] = _twist(mesh)
        F[:, 1] = _oval(mesh, shaft)
    K = assemble(mesh.points, mesh.cells, STEEL.lame, n_dofs)
    elimination = eliminate(constraints, n_dofs)
    system = reduce(mesh.points, mesh.cells, K, elimination)
    return Problem(mesh, shaft, system, np.asarray(elimination.T.T @ F))


def torsional_compliance(problem: Problem) -> float:
    """L / (G J) of the meshed cross-section [rad/(N m)].

    The motion u = theta x e_x cross r is in the space of the elements, so that this is the exact
    answer on any mesh: what is missing to it is a solver's fault.
    """
    mesh, kind = problem.mesh, element_kind(problem.mesh.cells.shape[1])
    gradients, weights = kind.table(kind.degree)
    values = kind.shape(get_quadrature(kind.element.refdom, kind.degree)[0])[0]
    total = 0.0
    for start in range(0, len(mesh.cells), 512):
        some = mesh.cells[start : start + 512]
        volumes = np.abs(jacobian(mesh.points, some, gradients)[1]) * weights
        at = np.einsum("qn,eni->eqi", values, mesh.points[some])
        total += float((volumes * (at[..., 1] ** 2 + at[..., 2] ** 2)).sum())
    length = problem.shaft.length
    return length / (STEEL.shear_modulus * total / length)


def bending_compliance(diameter: float, wall: float, size: float, turn: int, count: int) -> float:
    """Turn of the front under a moment of 1 N m [rad/(N m)], of a shaft of so many equal elements.

    The moment is the same everywhere, so that each element along the shaft adds the same turn, a s,
    to what the held end takes from it, b(s). Both are found on short shafts, whose solutions have
    ten digits: a where s is the diameter, and b(s), which is in proportion to s where elements are
    long, at no more than `LONG` diameters. `SHORT` elements on, the two ends still feel each other
    to about 1e-6 of the turn: that is how exact it is.
    """

    def turned(s: float, n: int) -> float:
        shaft = uniform(diameter, wall, n * s)
        problem = cantilever(shaft, s * (1.0 + 1e-9), turn)
        return float(factored(problem, fastest()).refined[1])

    a = (turned(diameter, 2 * SHORT) - turned(diameter, SHORT)) / (SHORT * diameter)
    s = min(size, LONG * diameter)
    b = turned(s, SHORT) - SHORT * s * a
    return float(count * size * a + b * size / s)


def _facets(mesh: Hexahedra, chosen: np.ndarray) -> np.ndarray:
    """Facets whose nodes are all chosen."""
    facets = mesh.cells[:, local_facets(27)].reshape(-1, 9)
    return np.asarray(facets[chosen[facets].all(axis=1)])


def _twist(mesh: Hexahedra) -> Floats:
    """Tractions of pure torsion on the front end, of moment 1 N m."""
    front = np.zeros(len(mesh.points), dtype=bool)
    front[mesh.front] = True
    facets = _facets(mesh, front)
    at = facet_points(mesh.points, facets)
    moved = np.zeros_like(at.positions)
    moved[..., 1], moved[..., 2] = -at.positions[..., 2], at.positions[..., 1]
    F = np.zeros((len(mesh.points), 3))
    np.add.at(F, facets, np.einsum("qn,fq,fqi->fni", at.values, at.areas, moved))
    moment = (at.areas * (moved**2).sum(axis=-1)).sum()
    return np.asarray((F / moment).ravel())


def _oval(mesh: Hexahedra, shaft: Shaft) -> Floats:
    """A pressure of cos 2t outward on the outer surface [Pa]."""
    radius = shaft.sections[0].outer_diameter / 2.0
    outer = np.abs(np.hypot(mesh.points[:, 1], mesh.points[:, 2]) - radius) < 1e-9 * radius
    facets = _facets(mesh, outer)
    at = facet_points(mesh.points, facets)
    angle = np.arctan2(at.positions[..., 2], at.positions[..., 1])
    pressure = np.cos(2.0 * angle)[..., None] * at.normals
    F = np.zeros((len(mesh.points), 3))
    np.add.at(F, facets, np.einsum("qn,fq,fqi->fni", at.values, at.areas, pressure))
    return F.ravel()


def oval_work(shaft: Shaft, elements: int = 8) -> float:
    """Work of that pressure on the same tube, from its meridian in the harmonic cos 2t [J]."""
    from fe_drivetrain.revolution import dofs, harmonic_response, meridian, surface_loads

    radius = shaft.sections[0].outer_diameter / 2.0
    mesh = meridian(shaft, shaft.length / elements, order=8, layers=4)
    x = mesh.nodes[:, 0]
    sides = mesh.sides(lambda x, r: np.abs(r - radius) < 1e-9 * radius)
    loads = surface_loads(
        mesh, 2, sides, lambda at, normals: np.tile([0.0, 1.0, 0.0], (len(at), 1))
    )
    rear = np.flatnonzero(np.abs(x - shaft.rear) < 1e-9)
    which = np.concatenate([dofs(rear, k) for k in range(3)])
    found = harmonic_response(mesh, STEEL, 2, loads, (which, np.zeros(len(which))))
    return float(2.0 * found.energy[0])


@dataclass(frozen=True)
class Iterated:
    """Conjugate gradients, however far they came.

    Attributes
    ----------
    iterations, energy_error
        At the end: where the estimate reached the solvers' tolerance, or of `ITERATIONS`. Infinite
        where round-off left nothing positive to begin with.
    residual
        Largest relative residual.
    compliance
        (m,) that it gives.
    """

    iterations: int
    energy_error: float
    residual: float
    compliance: Floats

    @property
    def arrived(self) -> bool:
        """Whether it got there."""
        return self.energy_error <= solvers.TOLERANCE


def iterated(problem: Problem, method: str) -> Iterated:
    """Conjugate gradients preconditioned by "multigrid" or "schwarz", nothing behind them."""
    K, F = problem.system.K, problem.F
    system = problem.system
    try:
        made = multigrid.build(system) if method == "multigrid" else schwarz.build(system)
    except InputError:
        return Iterated(ITERATIONS, math.inf, math.inf, np.full(F.shape[1], np.nan))
    for found in multigrid.iterates(K, F, made.precondition):
        if found.energy_error <= solvers.TOLERANCE or found.iterations >= ITERATIONS:
            break
    residual = np.linalg.norm(K @ found.x - F, axis=0) / np.linalg.norm(F, axis=0)
    return Iterated(
        found.iterations,
        found.energy_error,
        float(residual.max()),
        problem.compliance(found.x),
    )


@dataclass(frozen=True)
class Factored:
    """A direct solver's answers.

    Attributes
    ----------
    once, refined
        (m,) compliance as the factor gives it, and after two steps of refinement.
    residual
        Largest relative residual, unrefined.
    condition
        Estimate of the condition number of the stiffness, its diagonal scaled to one; in the
        1-norm (Higham and Tisseur 2000, SIAM J. Matrix Anal. Appl. 21, 1185-1201).
    """

    once: Floats
    refined: Floats
    residual: float
    condition: float


def factored(problem: Problem, method: str) -> Factored:
    """One direct solver, refined and not."""
    K, F = problem.system.K, problem.F
    factor = direct_solvers.factorise(K, method)
    x = factor.apply(F)
    left = F - K @ x
    residual = float((np.linalg.norm(left, axis=0) / np.linalg.norm(F, axis=0)).max())
    once = problem.compliance(x)
    for _ in range(2):
        x = x + factor.apply(F - K @ x)
    scale = np.sqrt(K.diagonal())

    def inverse(V: Floats) -> Floats:
        V = V.reshape(len(scale), -1)
        return np.asarray(factor.apply(np.ascontiguousarray(scale[:, None] * V)) * scale[:, None])

    n = len(scale)
    operator = LinearOperator(
        (n, n), matvec=inverse, rmatvec=inverse, matmat=inverse, rmatmat=inverse, dtype=float
    )
    state = np.random.get_state()  # noqa: NPY002 (the estimate draws its first vectors from it)
    np.random.seed(0)  # noqa: NPY002
    try:
        smallest = onenormest(operator)
    finally:
        np.random.set_state(state)  # noqa: NPY002
    by = sparse.diags_array(1.0 / scale)
    largest = float(abs(by @ K.tocsr() @ by).sum(axis=0).max())
    return Factored(once, problem.compliance(x), residual, float(smallest) * largest)


@dataclass(frozen=True)
class Answer:
    """What the program answers by itself.

    Attributes
    ----------
    method, reason
        That it took in the end; "" where it refused.
    compliance
        (m,); None where it refused.
    round_off
        Its bound of what rounding may have done; infinite where it refused.
    """

    method: str
    reason: str
    compliance: Floats | None
    round_off: float


def answered(problem: Problem, method: str) -> Answer:
    """Through `solvers.solve`, with all that stands behind it."""
    try:
        found = solvers.solve(problem.system, problem.F, method)
    except InputError as error:
        return Answer("", str(error), None, math.inf)
    return Answer(found.method, found.reason, problem.compliance(found.x), found.round_off)


@dataclass(frozen=True)
class Point:
    """All that is measured of one body.

    Attributes
    ----------
    value
        Of the parameter.
    unknowns
        Of the system.
    reference
        (m,) compliance.
    iterations
        Of conjugate gradients by preconditioner.
    factors
        By direct solver; None where the matrix turned out not to be positive definite.
    answers
        Of the program by the method that it was asked for.
    """

    value: float
    unknowns: int
    reference: Floats
    iterations: dict[str, Iterated]
    factors: dict[str, Factored | None]
    answers: dict[str, Answer]

    def error(self, compliance: Floats | None) -> float:
        """Largest relative error of a compliance; NaN of none."""
        if compliance is None:
            return math.nan
        return float(np.abs(compliance / self.reference - 1.0).max())

    def iterations_error(self, method: str) -> float:
        """Of conjugate gradients as far as they came."""
        return self.error(self.iterations[method].compliance)

    def factored_error(self, method: str, refined: bool) -> float:
        """Of a direct solver."""
        found = self.factors[method]
        if found is None:
            return math.nan
        return self.error(found.refined if refined else found.once)

    @property
    def condition(self) -> float:
        """Estimated; NaN where no factor was to be had."""
        return next((f.condition for f in self.factors.values() if f is not None), math.nan)

    @property
    def silently_wrong(self) -> list[str]:
        """Methods whose answer is off by more than it admits: its bound, or four digits."""
        return [
            method
            for method, answer in self.answers.items()
            if answer.compliance is not None
            and not self.error(answer.compliance) <= max(answer.round_off, RIGHT)
        ]

    @property
    def failure(self) -> str:
        """What becomes of multigrid to its last iteration: a true failure, a false one, or none."""
        found = self.iterations["multigrid"]
        if found.arrived:
            return "false" if found.residual > RESIDUAL else "none"
        error = self.error(found.compliance)
        return "true" if not error <= WRONG else "short" if error > RIGHT else "false"


def measured(value: float, problem: Problem, reference: Floats) -> Point:
    """One point of a sweep: every solver, alone and with what the program puts behind it."""
    factors: dict[str, Factored | None] = {}
    for method in installed():
        try:
            factors[method] = factored(problem, method)
        except InputError:
            factors[method] = None
    return Point(
        value,
        problem.system.n_free,
        reference,
        {method: iterated(problem, method) for method in solvers.ITERATIVE},
        factors,
        {method: answered(problem, method) for method in ("auto", "multigrid", "schwarz")},
    )


def installed() -> list[str]:
    """Direct solvers that can be used here, fastest first."""
    return [method for method in direct_solvers.PACKAGES if direct_solvers.is_installed(method)]


def factor_memory(K: sparse.bsr_array) -> float | None:
    """Memory that PARDISO's factor of a matrix takes [bytes], from its symbolic analysis alone.

    None where PARDISO is not installed.
    """
    if not direct_solvers.is_installed("pardiso"):
        return None
    from pypardiso import PyPardisoSolver

    upper = sparse.csr_matrix(sparse.triu(K.tocsr(), format="csr"))
    upper.sort_indices()
    solver = PyPardisoSolver(mtype=2)
    solver.set_phase(11)
    solver._call_pardiso(upper, np.zeros((K.shape[0], 1)))
    needed = 1024.0 * (solver.get_iparm(16) + solver.get_iparm(17))
    solver.free_memory(everything=True)
    return float(needed)


def fastest() -> str:
    """The fastest direct solver that is installed."""
    return installed()[0]


def largest_safe(values: list[float], safe: list[bool]) -> float | None:
    """The last value before the first that is not safe, None where all are or the first is not."""
    if all(safe) or not safe[0]:
        return None
    return values[safe.index(False) - 1]


WORDS = {
    "none": "none",
    "false": "false: residual above 1e-8, answer right",
    "short": "stops short: three digits",
    "true": "true: answer wrong",
}


def rows_of(points: list[Point]) -> list[list[Any]]:
    """Of the table of `COLUMNS`."""
    return [
        [
            p.value,
            p.unknowns,
            p.condition,
            p.iterations["multigrid"].iterations,
            p.iterations["multigrid"].residual,
            p.iterations_error("multigrid"),
            WORDS[p.failure],
            p.iterations["schwarz"].iterations,
            p.iterations["schwarz"].residual,
            p.iterations_error("schwarz"),
            p.factored_error(fastest(), False),
            p.factored_error(fastest(), True),
            p.answers["auto"].method or "refused",
            p.answers["auto"].round_off,
        ]
        for p in points
    ]


def table_of(points: list[Point], parameter: str) -> Table:
    """All points of a sweep."""
    return Table(caption="All points", columns=[parameter, *COLUMNS], rows=rows_of(points))


COLUMNS = [
    "unknowns",
    "condition number",
    "multigrid: iterations",
    "its residual",
    "its true error",
    "its failure",
    "patches: iterations",
    "their residual",
    "their true error",
    "direct: true error",
    "the same, refined",
    "auto takes",
    "bound of round-off",
]


Range = tuple[float | None, float | None]


def iteration_chart(points: list[Point], x: str, safe: Range) -> Chart:
    """Iterations of multigrid and of patches."""
    values = [p.value for p in points]
    multigrid_found = [p.iterations["multigrid"] for p in points]
    stopped = [k for k, found in enumerate(multigrid_found) if not found.arrived]
    return chart(
        f"Iterations to an energy error of {solvers.TOLERANCE:.0e}. Shaded: multigrid gets there; "
        f"crosses: after {ITERATIONS} it has not",
        [
            trace("multigrid", values, [i.iterations for i in multigrid_found]),
            trace(
                "multigrid, not there",
                [values[k] for k in stopped],
                [multigrid_found[k].iterations for k in stopped],
                True,
                marker={"symbol": "x", "size": 10},
            ),
            trace(
                "patches with a spectral coarse space",
                values,
                [p.iterations["schwarz"].iterations for p in points],
                mode="lines+markers",
            ),
        ],
        x=x,
        y="iterations",
        logarithmic=("x", "y"),
        safe=safe,
    )


def error_chart(points: list[Point], x: str, safe: Range, caption: str) -> Chart:
    """Residuals beside true errors, and the bound that the program gives."""
    method = fastest()
    curves = {
        "multigrid: residual": [p.iterations["multigrid"].residual for p in points],
        "multigrid: true error": [p.iterations_error("multigrid") for p in points],
        "patches: residual": [p.iterations["schwarz"].residual for p in points],
        "patches: true error": [p.iterations_error("schwarz") for p in points],
        f"{method}: true error": [p.factored_error(method, False) for p in points],
        f"{method}, refined: true error": [p.factored_error(method, True) for p in points],
        "bound of round-off, as the program gives it": [
            p.answers["schwarz"].round_off for p in points
        ],
    }
    traces = []
    for name, values in curves.items():
        there = [k for k, v in enumerate(values) if np.isfinite(v) and v > 0.0]
        dash: dict[str, Any] = {"line": {"dash": "dot"}} if name.startswith("bound") else {}
        traces.append(
            trace(name, [points[k].value for k in there], [values[k] for k in there], **dash)
        )
    return chart(
        caption,
        traces,
        x=x,
        y="relative error, relative residual",
        logarithmic=("x", "y"),
        safe=safe,
    )


def condition_chart(points: list[Point], x: str, safe: Range) -> Chart:
    """Estimated condition number."""
    there = [p for p in points if np.isfinite(p.condition)]
    return chart(
        "Estimated condition number of the stiffness, its diagonal scaled to one",
        [trace("estimate", [p.value for p in there], [p.condition for p in there])],
        x=x,
        y="condition number",
        logarithmic=("x", "y"),
        safe=safe,
    )


def failures(points: list[Point], x: str) -> str:
    """Which failures of multigrid are false, and which are true."""

    def at(*kinds: str) -> str:
        return ", ".join(f"{p.value:g}" for p in points if p.failure in kinds) or "none"

    return (
        "A residual says little here. False failures, a residual above "
        f"{RESIDUAL:.0e} with the answer right to four digits: multigrid at {x} = {at('false')}. "
        f"Stopped short, with three digits: {x} = {at('short')}. True failures, the answer wrong "
        f"by more than {WRONG:.0e} after {ITERATIONS} iterations: {x} = {at('true')}. They look "
        "alike to a solver that watches its residual; the estimate of the energy error tells them "
        "apart."
    )
