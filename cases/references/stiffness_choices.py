"""Every choice a user has for a stiffness, measured: element, mesh, solver, tolerance."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, replace
from functools import partial
from typing import Any, NamedTuple, TypeVar

import numpy as np

from fe_drivetrain.common import RUNS, Floats, Ints, Times, timed_runs
from fe_drivetrain.drivetrain_file import Material
from fe_drivetrain.elasticity.interfaces import ReferencePoint, constraints
from fe_drivetrain.elasticity.mesh import (
    UNGRADED,
    Grading,
    Nodes,
    element_kind,
    first_order,
    generate,
    shaft_hexahedra,
    straightened,
)
from fe_drivetrain.elasticity.operator import assemble
from fe_drivetrain.elasticity.solve import TOLERANCE, System, direct_solvers, reduce, solvers
from fe_drivetrain.geometry import MeshSizes, Shaft

STEPS = ("mesh", "assembly", "set-up", "solve")

P1, STRAIGHT, CURVED = "P1", "P2 straight", "P2 curved"
HEXAHEDRA: dict[str, Nodes] = {"hex 8": 8, "hex 20": 20, "hex 27": 27}
ELEMENTS = (P1, STRAIGHT, CURVED, *HEXAHEDRA)

#: What takes less than this is measured so often, anything else once.
SHORT_SECONDS = 2.0
REPEATS = RUNS

#: Largest systems that each direct solver is tried on, unknowns.
MAX_UNKNOWNS = {"superlu": 12_000, "cholmod": 70_000, "pardiso": 70_000}
#: Largest systems on which an iteration is driven further than `FAR_ENOUGH`.
SWEPT = 60_000
FAR_ENOUGH = 1e-6

_Made = TypeVar("_Made")


class Solve(NamedTuple):
    """How a system is solved; the tolerance is the energy error that iterations stop at."""

    method: str
    tolerance: float = TOLERANCE


@dataclass(frozen=True)
class Outcome:
    """What one choice gives and what it costs.

    Attributes
    ----------
    element, mesh : str
        The choice, with `solve`.
    solve : Solve
        The choice, with `element` and `mesh`.
    used : str
        Solver that gave the solution: another than the one asked for where that fell back.
    unknowns, iterations, bytes : int
        Unknowns of the system, iterations, and bytes held by factor or hierarchy.
    times : dict of str to Times
        Wall times of each of `STEPS`.
    values : ndarray
        (q,) the quantities that were computed.
    volume_error : float
        Relative error of the mesh's volume; 0 where it is not known.
    """

    element: str
    mesh: str
    solve: Solve
    used: str
    unknowns: int
    iterations: int
    bytes: int
    times: dict[str, Times]
    values: Floats
    volume_error: float = 0.0

    @property
    def seconds(self) -> dict[str, float]:
        """Median wall time of each step [s]."""
        return {step: times.median for step, times in self.times.items()}

    @property
    def total(self) -> float:
        """Wall time of all steps, each the median of its runs [s]."""
        return sum(self.seconds.values())

    @property
    def least(self) -> float:
        """The same of the quickest runs [s]."""
        return sum(times.least for times in self.times.values())

    @property
    def most(self) -> float:
        """And of the slowest [s]."""
        return sum(times.most for times in self.times.values())

    @property
    def runs(self) -> int:
        """Runs of the step with the fewest."""
        return min(len(times.seconds) for times in self.times.values())

    @property
    def solver(self) -> str:
        """The solver in words."""
        method, tolerance = self.solve
        if method == "auto":
            return f"auto ({self.used})"
        if method == "multigrid":
            fell_back = "" if self.used == method else f", fell back on {self.used}"
            return f"multigrid to {tolerance:.0e}{fell_back}"
        return method


@dataclass(frozen=True)
class Level:
    """One mesh of one element.

    Attributes
    ----------
    element : str
        One of `ELEMENTS`.
    size : float
        Element size [m].
    turn : int
        Elements round any cylinder, at least.
    grading : Grading
        Grading of hexahedra.
    refinement : int
        Number of parts into which each hexahedron is cut along its three directions.
    """

    element: str
    size: float
    turn: int
    grading: Grading = UNGRADED
    refinement: int = 1

    @property
    def name(self) -> str:
        """The mesh in words."""
        text = f"{1000 * self.size:.4g} mm, {self.turn} a turn"
        if self.refinement > 1:
            text += f", cut in {self.refinement}"
        if self.grading.steps or self.grading.ends:
            text += f", {self.grading.steps} + {self.grading.ends} layers x {self.grading.ratio:g}"
        return text


class SolidShaft(NamedTuple):
    """A mesh of a shaft with its two ends."""

    points: Floats
    cells: Ints
    front: Ints
    rear: Ints


def mesh_shaft(shaft: Shaft, level: Level) -> SolidShaft:
    """Mesh a shaft with the element of a level."""
    if level.element in HEXAHEDRA:
        hexahedra = shaft_hexahedra(
            shaft,
            level.size,
            HEXAHEDRA[level.element],
            elements_per_turn=level.turn,
            refinement=level.refinement,
            grading=level.grading,
        )
        return SolidShaft(hexahedra.points, hexahedra.cells, hexahedra.front, hexahedra.rear)
    mesh = generate(shaft, sizes=MeshSizes(shaft=level.size, elements_per_turn=level.turn))
    front, rear = mesh.face_nodes("shaft.front"), mesh.face_nodes("shaft.rear")
    if level.element == P1:
        linear = first_order(mesh.points, mesh.cells)
        return SolidShaft(linear.points, linear.cells, linear.nodes(front), linear.nodes(rear))
    points = mesh.points
    if level.element == STRAIGHT:
        points = straightened(points, mesh.cells)
    return SolidShaft(points, mesh.cells, front, rear)


class Assembled(NamedTuple):
    """A reduced system with its loads, and what turns its solutions into quantities."""

    system: System
    loads: Floats
    quantities: Callable[[Floats], Floats]


def assemble_shaft(shaft: Shaft, material: Material, mesh: SolidShaft) -> Assembled:
    """Both ends rigid, the rear one fixed, six unit loads on the front one.

    The quantities are (3,): torsional stiffness [N m/rad], bending stiffness [N m/rad] as a pure
    moment over the tilt of the front face, free to move sideways, and axial stiffness [N/m]; each
    1 over its place on the diagonal of the 6x6 compliance.
    """
    n = len(mesh.points)
    n_dofs = 3 * n + 6
    K = assemble(mesh.points, mesh.cells, material.lame, n_dofs)
    centre = np.array([shaft.front, 0.0, 0.0])
    point = constraints.rigid_point("front", centre, 3 * n, n_dofs)
    elimination = constraints.eliminate(
        [
            constraints.fixed("rear", mesh.rear, n_dofs),
            constraints.rigid_face("front", mesh.front, mesh.points, point),
        ],
        n_dofs,
    )
    T = elimination.T

    def quantities(x: Floats) -> Floats:
        return np.asarray(1.0 / (point.motion @ (T @ x)).diagonal()[[3, 4, 0]])

    return Assembled(reduce(mesh.points, mesh.cells, K, elimination), _loads(T, point), quantities)


def _loads(T: Any, point: ReferencePoint) -> Floats:
    """The six unit loads at a reference point on the remaining degrees of freedom, (n, 6)."""
    return np.asarray(T.T @ point.motion.T.toarray())


def shaft_outcomes(
    shaft: Shaft,
    material: Material,
    level: Level,
    solves: Iterable[Solve],
    repeats: int = REPEATS,
    short: float = SHORT_SECONDS,
) -> Iterator[Outcome]:
    """Mesh and assemble once, then solve in each way.

    Parameters
    ----------
    solves : iterable of Solve
        Those that need not be tried on a system of this size are left out.
    repeats : int, optional
        How often what takes little time is done.
    short : float, optional
        What takes longer is done once [s].
    """
    mesh, meshing = timed(lambda: mesh_shaft(shaft, level), repeats, short)
    assembled, assembling = timed(lambda: assemble_shaft(shaft, material, mesh), repeats, short)
    volume_error = abs(volume(mesh) / exact_volume(shaft) - 1.0)
    steps = meshing, assembling
    for outcome in solved(level.element, level.name, assembled, steps, solves, repeats, short):
        yield replace(outcome, volume_error=volume_error)


def volume(mesh: SolidShaft) -> float:
    """Volume of a mesh of any element [m^3]."""
    gradients, weights = element_kind(mesh.cells.shape[1]).table(4)
    total = 0.0
    for cells in np.array_split(mesh.cells, len(mesh.cells) // 10_000 + 1):
        matrices = np.einsum("eai,qka->eqik", mesh.points[cells], gradients)
        total += float((np.linalg.det(matrices) @ weights).sum())
    return total


def exact_volume(shaft: Shaft) -> float:
    """Volume of a shaft without fillets [m^3]: cylinders and frusta of cones."""
    total = 0.0
    for piece in shaft.pieces:
        a, b, bore = piece.outer_diameter, piece.end_diameter, piece.inner_diameter
        total += np.pi / 4.0 * piece.length * ((a * a + a * b + b * b) / 3.0 - bore**2)
    return float(total)


def solved(
    element: str,
    mesh: str,
    assembled: Assembled,
    before: tuple[Times, Times],
    solves: Iterable[Solve],
    repeats: int = REPEATS,
    short: float = SHORT_SECONDS,
) -> Iterator[Outcome]:
    """Solve one system in several ways.

    Parameters
    ----------
    element, mesh : str
        What it is a system of.
    before : tuple of two Times
        Wall times of mesh and of assembly.
    solves : iterable of Solve
        The same as for `shaft_outcomes`.
    repeats, short : optional
        The same as for `shaft_outcomes`.
    """
    system, loads, quantities = assembled
    for how in solves:
        if not _worth_a_try(system.n_free, how):
            continue
        runs = list(repeated(partial(solvers.solve, system, loads, *how), repeats, short))
        solution = runs[0]
        steps = (
            *before,
            Times(tuple(s.diagnostics.setup_seconds for s in runs)),
            Times(tuple(s.diagnostics.solve_seconds for s in runs)),
        )
        yield Outcome(
            element=element,
            mesh=mesh,
            solve=how,
            used=solution.diagnostics.method,
            unknowns=system.n_free,
            iterations=solution.diagnostics.iterations,
            bytes=solution.diagnostics.bytes,
            times=dict(zip(STEPS, steps, strict=True)),
            values=quantities(solution.x),
        )


def _worth_a_try(unknowns: int, how: Solve) -> bool:
    if how.method == "multigrid" and how.tolerance < FAR_ENOUGH:
        return unknowns <= SWEPT
    return unknowns <= MAX_UNKNOWNS.get(how.method, np.inf)


def repeated(
    work: Callable[[], _Made], repeats: int, short: float = SHORT_SECONDS
) -> Iterator[_Made]:
    """Do something that takes little time several times, anything else once."""
    made, first = timed_runs(work, 1)
    yield made
    if first.most < short:
        for _ in range(repeats - 1):
            yield work()


def timed(
    work: Callable[[], _Made], repeats: int = REPEATS, short: float = SHORT_SECONDS
) -> tuple[_Made, Times]:
    """What something makes, and the wall times it takes: of several runs, if short."""
    runs = list(repeated(partial(timed_runs, work, 1), repeats, short))
    return runs[-1][0], Times(tuple(times.most for _, times in runs))


def available() -> list[str]:
    """The solvers that are installed here, multigrid last."""
    return [*(m for m in direct_solvers.PACKAGES if direct_solvers.is_installed(m)), "multigrid"]


def every_solve(tolerances: Iterable[float]) -> list[Solve]:
    """`auto`, every direct solver installed, multigrid to each tolerance."""
    methods = [Solve("auto"), *(Solve(m) for m in available() if m != "multigrid")]
    return [*methods, *(Solve("multigrid", t) for t in tolerances)]


def warm_up(shaft: Shaft, material: Material, elements: Iterable[str]) -> None:
    """Compile the kernels and load the solvers, so that no measured choice pays for it."""
    for element in elements:
        level = Level(element, shaft.length, 8)
        for _ in shaft_outcomes(shaft, material, level, every_solve([1e-4]), repeats=1):
            pass
