"""Designs that differ little, solved one after the other, each from what those before have left.

A neighbour's mesh is moved (`fe_drivetrain.elasticity.mesh.moving`), its factor or hierarchy
preconditions the moved stiffness, and its solutions are where the iteration starts
(`fe_drivetrain.elasticity.solve.recycled`). The tolerance is that of a design alone, so that what
is kept decides on the time, and not on the answer; the mesh is another one of the same sizes.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np

from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.interfaces.constraints import Constraint, Elimination, eliminate
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.mesh.moving import LEAST_SHAPE, MOST_STRETCH, MovableMesh
from fe_drivetrain.elasticity.mesh.surface_shifts import Parts
from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.operator.carried_fields import change_by_shift
from fe_drivetrain.elasticity.operator.elasticity import Pattern, sparsity
from fe_drivetrain.elasticity.solve import multigrid
from fe_drivetrain.elasticity.solve.element_system import ElementSystem
from fe_drivetrain.elasticity.solve.recycled import KNOWN, MOST, Recycled
from fe_drivetrain.elasticity.solve.reduction import System, reduce, reduced_stiffness
from fe_drivetrain.elasticity.solve.solvers import ITERATIVE, Solver, factorise
from fe_drivetrain.geometry import Housing
from fe_drivetrain.shafts.response.cached import cached_response
from fe_drivetrain.shafts.response.model import Model, build_model, mesh_scene
from fe_drivetrain.shafts.response.prepared import STOP_AT, Prepared, prepare_by
from fe_drivetrain.shafts.response.unit_loads import Response

GROWTH = 1.2
"""Iterations for each decade of the error, over those of a factor or hierarchy of the design
itself, at which a neighbour's is given up."""

FAMILIES = 3
"""Meshes that are kept to be moved; a fourth takes the place of the oldest but the first."""

_JUDGED_FROM = 2.0  # decades: fewer say little about how fast an iteration converges
_OF_A_POINT = 6  # rows of a constraint that holds the motions of one point
_PACE_OF_FACTOR = 2.0  # iterations a decade that a factor of another design is kept for


@dataclass(frozen=True)
class Reuse:
    """What of a neighbour is used, and how far.

    Attributes
    ----------
    least_shape, most_stretch : float
        Limits of a moved mesh, see `MovableMesh.moved`; a stretch of 1 moves none.
    growth : float
        See `GROWTH`; 0 makes a factor or hierarchy for each design.
    vectors : int
        Vectors of solutions that are kept at most, see `Recycled`; 0 starts at zero.
    known : float
        What a solution adds to them by less is not kept, relative in the energy norm.
    """

    least_shape: float = LEAST_SHAPE
    most_stretch: float = MOST_STRETCH
    growth: float = GROWTH
    vectors: int = MOST
    known: float = KNOWN


#: All that a neighbour has left.
EVERYTHING = Reuse()

#: Every design for itself.
NOTHING = Reuse(most_stretch=1.0, growth=0.0, vectors=0)


@dataclass(frozen=True)
class Step:
    """How one design was solved.

    Attributes
    ----------
    meshed : str
        Why it was meshed; empty where a mesh was moved, or stayed.
    shape, stretch : float
        See `fe_drivetrain.elasticity.mesh.moving.Moved`.
    set_up : bool
        Whether a factor or hierarchy was made for it.
    iterations : int
        Number of iterations of all its solutions.
    started : float
        Error that the first iteration started with, relative in the energy norm; 1 from zero.
    """

    meshed: str = ""
    shape: float = 1.0
    stretch: float = 1.0
    set_up: bool = False
    iterations: int = 0
    started: float = 1.0


@dataclass(eq=False)
class _Family:
    """A mesh, and what designs on it have left."""

    movable: MovableMesh
    space: Recycled | None
    solver: Solver | None = None
    pace: float = math.inf
    """Iterations for each decade with a factor or hierarchy of the design itself."""
    worn: bool = False
    free: Bools | None = None
    pivots: dict[str, Ints] = field(default_factory=dict)
    checked: bool = False
    pattern: Pattern | None = None


@dataclass
class Neighbours:
    """Solves designs that differ little.

    Attributes
    ----------
    reuse : Reuse
        What of one design is used for the next.
    steps : list of Step
        How each design so far was solved.
    meshes : Cache or None
        Where meshes that are not moved may come from; the user's if not given.
    """

    reuse: Reuse = EVERYTHING
    steps: list[Step] = field(default_factory=list)
    meshes: Cache | None = None
    _families: list[_Family] = field(default_factory=list, repr=False)

    def model(self, scene: Scene, tolerance: float = STOP_AT) -> Model:
        """The model of a design, on a mesh of its own or on a neighbour's that was moved.

        Parameters
        ----------
        scene : Scene
            The design.
        tolerance : float
            Relative error in the energy norm at which its iterations will stop.

        Raises
        ------
        InputError
            See `mesh_scene` and `build_model`.
        """
        mesh, family = self._mesh(scene)
        model = build_model(scene, mesh, checked=bool(family and family.checked))
        if family is not None:
            family.checked = True
            prepare_by(model, _Preparation(self, family, tolerance))
        return model

    def solved(self, scene: Scene, cache: Cache | None = None) -> tuple[Model, Response]:
        """Model of a design and its responses to unit loads, kept or solved; see `model`."""
        model = self.model(scene)
        return model, cached_response(model, cache=cache)

    def __getstate__(self) -> dict[str, object]:
        """Settings alone: what another process does, it begins from nothing."""
        return {"reuse": self.reuse, "steps": [], "meshes": self.meshes, "_families": []}

    def note(self, **changes: object) -> None:
        """Change what is said of the last design."""
        self.steps[-1] = replace(self.steps[-1], **changes)  # type: ignore[arg-type]

    def _mesh(self, scene: Scene) -> tuple[Mesh, _Family | None]:
        """The mesh of a design, and the family that it belongs to."""
        parts = parts_of(scene)
        if self.reuse == NOTHING:
            self.steps.append(Step("each design is meshed"))
            return mesh_scene(scene, self.meshes), None
        if parts is None:
            self.steps.append(Step("it has parts that are not of the program's own shapes"))
            return mesh_scene(scene, self.meshes), None
        reason = "it is the first" if not self._families else ""
        for family in self._families:
            found = family.movable.moved(parts, self.reuse.least_shape, self.reuse.most_stretch)
            if found.mesh is not None:
                self.steps.append(Step("", found.shape, found.stretch))
                return found.mesh, family
            reason = found.reason
        self.steps.append(Step(reason))
        mesh = mesh_scene(scene, self.meshes)
        space = Recycled(self.reuse.vectors, self.reuse.known) if self.reuse.vectors else None
        family = _Family(MovableMesh(mesh, parts), space)
        if len(self._families) == FAMILIES:
            del self._families[1]
        self._families.append(family)
        return mesh, family


@dataclass(frozen=True, eq=False)
class _Between:
    """Carries displacements between a family's first mesh and one that was moved from it."""

    points: Floats
    mesh: Mesh
    pattern: Pattern
    elimination: Elimination

    def there(self, U: Floats) -> Floats:
        """Free displacements of the moved mesh, of all of the first one's."""
        found = self._shifted(U, self.points, self.mesh.points - self.points)
        return np.ascontiguousarray(found * self.elimination.free[:, None])

    def back(self, q: Floats) -> Floats:
        """Displacements of the first mesh, of free ones of the moved one."""
        U = np.asarray(self.elimination.T @ q)
        return self._shifted(U, self.mesh.points, self.points - self.mesh.points)

    def _shifted(self, U: Floats, points: Floats, shift: Floats) -> Floats:
        if not shift.any():
            return U
        A = change_by_shift(points, self.mesh.cells, self.pattern, shift)
        return np.asarray(U + kernels.product(A, U))


@dataclass(frozen=True, eq=False)
class _Preparation:
    """Makes a model of a family ready for right-hand sides."""

    neighbours: Neighbours
    family: _Family
    tolerance: float

    def __call__(self, model: Model, method: str, n_rhs: int) -> Prepared:
        family, kept = self.family, self.family.solver
        if family.pattern is None:
            family.pattern = sparsity(model.mesh.cells, model.n_dofs // 3)
        stiffness = model.assembled(family.pattern)
        elimination = eliminate(self._with_pivots(model), model.n_dofs)
        free = family.free
        same = free is not None and np.array_equal(free, elimination.free)
        mesh, springs = model.mesh, model.springs
        between = _Between(family.movable.mesh.points, mesh, family.pattern, elimination)
        worn = family.worn or self.neighbours.reuse.growth == 0.0

        def whole() -> System:  # without the model, which its solver would then keep for good
            return reduce(mesh.points, mesh.cells, stiffness, elimination, springs)

        if kept is None or worn or not same or method not in ("auto", kept.method):
            family.free = elimination.free
            kept = self._set_up(whole(), method, n_rhs)
            solver = self._going_on(kept, kept.system, between, None)
        else:
            K = reduced_stiffness(stiffness, elimination)
            n_free = int(elimination.free.sum())
            none = np.zeros((0, 6)), np.zeros(0, dtype=np.int64)
            solver = self._going_on(kept, System(K, None, *none, n_free), between, whole)
        return Prepared(stiffness, elimination, solver)

    def _with_pivots(self, model: Model) -> list[Constraint]:
        """Constraints of a model, those of points solved for the same unknowns as at first.

        Where weights are equal but for round-off, each mesh would choose others, and what is
        eliminated decides on a hierarchy.
        """
        known = self.family.pivots
        for constraint in model.constraints:
            if len(constraint.pivots) <= _OF_A_POINT:
                known.setdefault(constraint.name, constraint.pivots)
        return [replace(c, pivots=known.get(c.name, c.pivots)) for c in model.constraints]

    def _set_up(self, system: System, method: str, n_rhs: int) -> Solver:
        """A solver of the design's own, kept for those that follow."""
        family = self.family
        family.solver = factorise(system, method, n_rhs, self.tolerance)
        family.pace = math.inf if family.solver.method in ITERATIVE else _PACE_OF_FACTOR
        family.worn = False
        self.neighbours.note(set_up=True)
        return family.solver

    def _going_on(
        self,
        kept: Solver,
        system: System | ElementSystem,
        between: _Between,
        whole: Callable[[], System] | None,
    ) -> Solver:
        """A solver of a system by what is kept; `whole` makes it one for another set-up."""
        by = kept.precondition
        if by is None or not isinstance(system, System):
            return kept

        def iterate(F: Floats) -> multigrid.Iteration:
            return self._iterated(system, kept, between, whole, F)

        own = whole is None
        reason = kept.reason if own else f"{kept.method} of a neighbour"
        seconds = kept.setup_seconds if own else 0.0
        held = kept.bytes + (self.family.space.bytes if self.family.space else 0)
        return Solver(system, kept.method, reason, self.tolerance, seconds, held, iterate, by)

    def _iterated(
        self,
        system: System,
        kept: Solver,
        between: _Between,
        whole: Callable[[], System] | None,
        F: Floats,
    ) -> multigrid.Iteration:
        """Solve from what the space has, and keep what it had not."""
        K, space = system.K, self.family.space
        assert kept.precondition is not None
        begin = None if space is None else space.start(K, F, between.there)
        if whole is None and begin is None:
            found = kept.iterate(F)
        else:
            found = multigrid.conjugate_gradients(
                K, F, kept.precondition, self.tolerance, start=begin
            )
        if whole is not None and found.energy_error > self.tolerance:
            tried = found.iterations
            found = self._set_up(whole(), kept.method, F.shape[1]).iterate(F)
            found = replace(found, iterations=tried + found.iterations)
        missing = 1.0
        if space is not None:
            missing = space.learn(K, found.x, begin, between.back)
            space.least_ratio = max(space.least_ratio, found.tail_ratio)
        self._judge(found, missing, whole is None)
        return found

    def _judge(self, found: multigrid.Iteration, missing: float, own: bool) -> None:
        """Note how fast the iteration was, and whether the hierarchy is worn."""
        family, step = self.family, self.neighbours.steps[-1]
        decades = math.log10(max(missing / self.tolerance, 1.0))
        first = {} if step.iterations else {"started": missing}
        self.neighbours.note(iterations=step.iterations + found.iterations, **first)
        if decades < _JUDGED_FROM or not found.iterations:
            return
        pace = found.iterations / decades
        if own:
            family.pace = min(family.pace, pace)
        elif pace > self.neighbours.reuse.growth * family.pace:
            family.worn = True


def parts_of(scene: Scene) -> Parts | None:
    """What the mesh of a scene is generated from; None where it has parts from files, or a nose."""
    blocks: dict[str, Housing] = {}
    for unit in scene.bearing_units:
        if unit.parts or not isinstance(unit.housing, Housing):
            return None
        blocks[unit.bearing.name] = unit.housing
    if scene.nose is not None:
        return None
    bonded = frozenset(u.bearing.name for u in scene.bearing_units if u.interface == "bonded")
    bearings = [unit.bearing for unit in scene.bearing_units]
    return Parts(scene.shaft, bearings, blocks, scene.mesh, bonded, scene.seats)
