"""A whole scene on rollers: shaft, inner rings and housings as solids, rollers that lift off.

The solids are solved once, with weak springs in place of the rollers that hold them together. From
this follows, exactly, what all solids do at the rollers once the springs are gone: deflections z of
the contacts (approach and lean of each roller) under contact loads p and the loads f of the scene
are ``S z = G f - p``. S holds the shapes of the solids, of which the softest are the unknowns of a
load case; the motions of the shaft as a rigid body are among them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy import sparse

from fe_drivetrain.bearing.geometry import Bearing
from fe_drivetrain.bearing.race_newton import Body
from fe_drivetrain.bearing.races import (
    SOFTEST_LEFT_OUT,
    contact_compliance,
    ring_loads,
    roller_lengths,
    soft_springs,
    solve_on_body,
)
from fe_drivetrain.bearing.rolling import TOLERANCE
from fe_drivetrain.bearing_life.rings.housing import MADE_BY, contact_rows
from fe_drivetrain.common.arrays import Bools, Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.bearing_unit import RollerRow as SceneRow
from fe_drivetrain.drivetrain_file.bearing_unit import Rollers
from fe_drivetrain.drivetrain_file.entrance import AT_HUB, Entrance
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.interfaces.constraints import eliminate
from fe_drivetrain.elasticity.solve.reduction import reduce
from fe_drivetrain.elasticity.solve.solvers import solve
from fe_drivetrain.shafts.response.entering import Factors, factor_values
from fe_drivetrain.shafts.response.model import LOADS, Model, build_model, mesh_scene
from fe_drivetrain.shafts.response.solved_arrays import kept_arrays

#: Stiffness of the springs that hold the solids together while they are solved, over a contact's.
WEAK = 0.05

# Negative stiffness, over the maximum stiffness, beyond which it is no round-off.
_NEGATIVE = 1e-6


@dataclass(frozen=True, eq=False)
class RollerAssembly:
    """A scene's solids at the rollers of its bearings.

    Attributes
    ----------
    bearings : Mapping
        Bearings with rows of rollers, by name.
    stiffness : Floats
        Stiffness (2 total, 2 total) S over the approach of all rollers [m], then their leans [rad].
    loads : Floats
        Contact loads (2 total, 10) G of the loads of `response.LOADS` [N, N m].
    points : Mapping
        Reference points of the scene by name: their motions (6, 10) under the loads with the
        springs, and (6, 2 total) for unit contact loads.
    springs : Floats
        Stiffness (2 total,) of the springs that the solids were solved with [N/m]; zero of leans.
    entrance : Entrance
        Point where loads enter the scene.
    """

    bearings: Mapping[str, Bearing]
    stiffness: Floats
    loads: Floats
    points: Mapping[str, tuple[Floats, Floats]]
    springs: Floats
    entrance: Entrance = AT_HUB

    __repr__ = short_repr

    @property
    def together(self) -> Bearing:
        """All rows as those of one bearing."""
        rows = tuple(row for bearing in self.bearings.values() for row in bearing.rows)
        return Bearing(" and ".join(self.bearings), rows)

    def shapes(self, count: int | None = None) -> tuple[Floats, Floats]:
        """The softest shapes of the solids at the contacts, rigid motions first.

        Parameters
        ----------
        count : int, optional
            Number of shapes; if left out, all with more than a twentieth of a contact's compliance.

        Returns
        -------
        shapes : Floats
            Approach and lean (2 total, k) of each roller.
        stiffness : Floats
            Stiffness (k,) of the shapes [N/m].
        """
        lengths = roller_lengths(self.together)
        values, vectors = np.linalg.eigh(self.stiffness / np.outer(lengths, lengths))
        if count is None:
            softness = contact_compliance(self.together)
            count = int((values < 1.0 / (SOFTEST_LEFT_OUT * softness)).sum())
        return vectors[:, :count] / lengths[:, None], np.maximum(values[:count], 0.0)


@dataclass(frozen=True, eq=False)
class AssemblyEquilibrium:
    """Equilibrium of a scene on its rollers.

    Attributes
    ----------
    assembly : RollerAssembly
        The scene.
    factors : Floats
        Factors (n, 10) of the loads.
    deflections : Floats
        Approach (n, 2 total) of all rollers [m], then their leans [rad].
    rollers, moments : Floats
        Load (n, total) of each roller [N], bearing by bearing, and its moment [N m].
    residuals : Floats
        Residual (n,) of the balance, over what `converged` allows.
    converged : Bools
        Flags (n,): whether the case has converged.
    iterations : Ints
        Number (n,) of Newton steps.
    """

    assembly: RollerAssembly
    factors: Floats
    deflections: Floats
    rollers: Floats
    moments: Floats
    residuals: Floats
    converged: Bools
    iterations: Ints

    __repr__ = short_repr

    def of(self, name: str) -> Floats:
        """Rollers (n, k) of one bearing [N].

        Parameters
        ----------
        name : str
            The bearing.

        Returns
        -------
        rollers : Floats
            Row by row.
        """
        return self.rollers[:, self._columns(name)]

    def bearing_loads(self, name: str) -> Floats:
        """Loads (n, 5) of a bearing's rollers on its outer ring, about its centre [N, N m].

        Parameters
        ----------
        name : str
            The bearing.

        Returns
        -------
        loads : Floats
            Fx, Fy, Fz, My, Mz.
        """
        at = self._columns(name)
        bearing = self.assembly.bearings[name]
        return ring_loads(bearing, self.rollers[:, at], self.moments[:, at])

    def motions(self, name: str) -> Floats:
        """Motions (n, 6) of a reference point of the scene, as "hub" [m, rad].

        Parameters
        ----------
        name : str
            The point.

        Returns
        -------
        motions : Floats
            Displacements and rotations.
        """
        of_loads, of_contacts = self.assembly.points[name]
        pushes = np.hstack([self.rollers, self.moments])
        freed = pushes - self.deflections * self.assembly.springs
        return np.asarray(self.factors @ of_loads.T - freed @ of_contacts.T)

    def _columns(self, name: str) -> slice:
        first = 0
        for other, bearing in self.assembly.bearings.items():
            if other == name:
                return slice(first, first + sum(bearing.counts))
            first += sum(bearing.counts)
        raise InputError(
            f"there is no bearing {name!r}: name one of {', '.join(self.assembly.bearings)}"
        )


def roller_assembly(
    scene: Scene, bearings: Mapping[str, Bearing], method: str = "auto"
) -> RollerAssembly:
    """Solve a scene's solids once, for any load on the rollers of its bearings.

    Parameters
    ----------
    scene : Scene
        The scene; the interfaces of these bearings become rollers.
    bearings : Mapping
        Bearings with rows of rollers that fill the bores of the scene, by name: all bearings of the
        scene.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.

    Returns
    -------
    assembly : RollerAssembly
        Scene condensed to the rollers.

    Raises
    ------
    InputError
        A bearing of the scene is left out, does not fit its bore, or nothing holds the scene.
    """
    names = [unit.bearing.name for unit in scene.bearing_units]
    if set(names) != set(bearings):
        raise InputError(
            f"bearings {', '.join(bearings)} are given, but the scene has {', '.join(names)}: give "
            "each of them"
        )
    content = {
        "rollers of": {name: asdict(bearing) for name, bearing in bearings.items()},
        "method": method,
        "weak": WEAK,
    }
    found = kept_arrays(scene, content, MADE_BY, lambda: _solved(scene, bearings, method))
    points = zip(found["points"], found["motions"], found["pushes"], strict=True)
    return RollerAssembly(
        dict(bearings),
        found["stiffness"],
        found["loads"],
        {str(name): (motion, push) for name, motion, push in points},
        found["springs"],
        scene.entrance,
    )


def _solved(scene: Scene, bearings: Mapping[str, Bearing], method: str) -> dict[str, NDArray[Any]]:
    """Arrays of a `RollerAssembly`, its points as names, "motions" and "pushes"."""
    model, contacts, springs = _model(scene, bearings)
    elimination = eliminate(model.constraints, model.n_dofs)
    total = len(springs) // 2
    pushes = sparse.csr_array(contacts[:, :total] * np.sqrt(springs[:total]))
    K = model.stiffness + (pushes @ pushes.T).tobsr((3, 3))
    system = reduce(model.mesh.points, model.mesh.cells, K, elimination, model.springs)
    F = np.hstack([contacts, model.unit_loads()])
    u = elimination.T @ solve(system, elimination.T.T @ F, method).x
    size = contacts.shape[1]
    C = contacts.T @ u[:, :size]
    lengths = roller_lengths(Bearing("all", tuple(r for b in bearings.values() for r in b.rows)))
    scale = np.outer(lengths, lengths)
    inverse = np.linalg.inv(0.5 * (C + C.T) * scale) * scale
    S = 0.5 * (inverse + inverse.T) - np.diag(springs)
    least = np.linalg.eigvalsh(S / scale)
    if least[0] < -_NEGATIVE * least[-1]:
        raise InputError(
            f"the scene without its rollers has a negative eigenvalue of stiffness, {least[0]:.3g} "
            'N/m: the solver was not exact enough; give method="superlu"'
        )
    points = model.points.values()
    return {
        "stiffness": S,
        "loads": inverse @ (contacts.T @ u[:, size:]),
        "points": np.array(list(model.points), dtype=np.str_),
        "motions": np.array([point.motion @ u[:, size:] for point in points]),
        "pushes": np.array([point.motion @ u[:, :size] for point in points]),
        "springs": springs,
    }


def assembly_equilibrium(
    assembly: RollerAssembly,
    factors: Factors | ArrayLike,
    *,
    shapes: int | None = None,
    tolerance: float = TOLERANCE,
    warm: bool = True,
) -> AssemblyEquilibrium:
    """The rollers of a scene under each load case.

    Parameters
    ----------
    assembly : RollerAssembly
        The scene at its rollers.
    factors : Factors or array_like
        Factors (n, 10) or (10,) of the loads of `response.LOADS`.
    shapes : int, optional
        Number of shapes of the solids, see `RollerAssembly.shapes`.
    tolerance : float
        Maximum residual over the load.
    warm : bool
        Start each case from the one before it, where its load is near.

    Returns
    -------
    found : AssemblyEquilibrium
        Each case converged, or flagged.

    Raises
    ------
    InputError
        The factors have another shape, one is no number, or `response.factor_values` refuses them.
    """
    f = np.atleast_2d(factor_values(assembly, factors))
    if f.ndim != 2 or f.shape[1] != len(LOADS) or not np.isfinite(f).all():
        raise InputError(
            f"factors of the loads have the shape {f.shape}: give finite numbers "
            f"(n, {len(LOADS)}), for {', '.join(LOADS)}"
        )
    together = assembly.together
    every, k = assembly.shapes(len(assembly.stiffness))
    kept = len(assembly.shapes(shapes)[1])
    V, stiffness = every[:, :kept], k[:kept]
    total = sum(together.counts)
    approach, lean = np.ascontiguousarray(V[:total]), np.ascontiguousarray(V[total:])
    body = Body(approach, lean, stiffness, soft_springs(together, approach, lean))
    G = f @ assembly.loads.T
    found = solve_on_body(body, together, G @ V, tolerance, warm=warm)
    # the shapes that were left out follow the others
    pushes = G - np.hstack([found.rollers, found.moments])
    others = every[:, kept:]
    rest = (pushes @ others / k[kept:]) @ others.T
    return AssemblyEquilibrium(
        assembly,
        f,
        found.unknowns @ V.T + rest,
        found.rollers,
        found.moments,
        found.residuals,
        found.residuals <= 1.0,
        found.steps,
    )


def _model(scene: Scene, bearings: Mapping[str, Bearing]) -> tuple[Model, Floats, Floats]:
    """The scene without its rollers, their contacts, and weak springs in their place."""
    units = []
    for unit in scene.bearing_units:
        bearing = bearings[unit.bearing.name]
        half = 0.5 * unit.bearing.raceway_diameter
        ball = unit.bearing.kind == "spherical"
        rows = tuple(
            SceneRow(x=half * np.sin(row.angle))
            if ball
            else SceneRow(
                x=row.place + (half - row.radius) * np.tan(row.angle),
                contact_angle=np.degrees(row.angle),
            )
            for row in bearing.rows
        )
        # few are enough to say that the scene is no mechanism; they are taken out again
        rollers = Rollers(count=3, stiffness=1.0 / contact_compliance(bearing), rows=rows)
        units.append(
            unit.model_copy(update={"interface": "rollers", "rollers": rollers, "stiffness": None})
        )
    on_rollers = scene.model_copy(update={"bearing_units": tuple(units)})
    model = build_model(on_rollers, mesh_scene(on_rollers))
    loads: list[Floats] = []
    moments: list[Floats] = []
    springs: list[Floats] = []
    for unit in units:
        name, bearing = unit.bearing.name, bearings[unit.bearing.name]
        inner, outer = (
            contact_rows(model.mesh, face, unit.bearing.x, bearing)
            for face in (f"{name}.outer", f"{name}.housing.bore")
        )
        columns = np.zeros((model.n_dofs, inner.shape[1]))
        columns[: len(inner)] = inner - outer
        total = sum(bearing.counts)
        loads.append(columns[:, :total])
        moments.append(columns[:, total:])
        springs.append(np.full(total, WEAK / contact_compliance(bearing)))
    whole = np.concatenate(springs)
    return (
        replace(
            model,
            springs=tuple(one for one in model.springs if ".roller " not in one[0].name),
            points={name: p for name, p in model.points.items() if ".roller " not in name},
        ),
        np.hstack([*loads, *moments]),
        np.concatenate([whole, np.zeros_like(whole)]),
    )
