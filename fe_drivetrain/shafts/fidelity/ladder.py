"""The fidelity ladder: one scene at levels 0 to 4, each answering through the same interface.

0 statics, 1 beam, 2 meridian in harmonics, 3 solid shaft, 4 assembly of solids. Levels 1 to 3
differ in how the shaft was condensed and in nothing else; their housings are rigid, or springs that
were solved apart. Each level states what it neglects.
"""

from __future__ import annotations

import time
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.components import FORCES, MOTIONS
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.kept_time import working_time
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import point_motions, wrench_transport
from fe_drivetrain.drivetrain_file.entrance import AT_HUB, Entrance
from fe_drivetrain.drivetrain_file.joint_springs import joint_stiffness
from fe_drivetrain.drivetrain_file.scene import Coupling, Scene
from fe_drivetrain.elasticity.solve.condensation import Condensed, supported
from fe_drivetrain.foreign.assembly import solids_of_unit
from fe_drivetrain.shafts.fidelity.bearing_units import UnitSolid, scene_supports, unit_stiffness
from fe_drivetrain.shafts.fidelity.coupled_units import coupled_stiffness
from fe_drivetrain.shafts.fidelity.nose import on_nose
from fe_drivetrain.shafts.fidelity.shafts import (
    beam_shaft,
    condensed_shaft,
    reference_points,
    ringed_shaft,
)
from fe_drivetrain.shafts.response.entering import Factors, factor_values
from fe_drivetrain.shafts.response.model import LOADS, Model, scene_loads
from fe_drivetrain.shafts.response.neighbours import NOTHING, Neighbours
from fe_drivetrain.shafts.response.unit_loads import Response

TITLES = (
    "statics",
    "Timoshenko beam",
    "meridian in harmonics",
    "solid shaft",
    "assembly of solids",
)

#: Wall over radius below which a tube gives way noticeably where a load enters.
_THIN = 0.02
_ROUND_A_NOSE = "rings of bearings on the nose, and the bedplate that holds it"  # left out
_OPENING = "contact that opens: joints are linear"


@dataclass(frozen=True)
class Cost:
    """What a model took.

    Attributes
    ----------
    seconds : float
        Wall time, meshes and solutions included.
    unknowns : int
        Number of unknowns of its largest system.
    """

    seconds: float
    unknowns: int


@dataclass(frozen=True)
class LevelModel:
    """A scene at one level, solved for its n unit loads, or a component for its own.

    The loads are those of `model.scene_loads`.

    Attributes
    ----------
    level : int
        0 to 4.
    title : str
        Title of the level, with what its housings are.
    neglects : tuple[str, ...]
        What it leaves out.
    cost : Cost
        What it took.
    reaction_matrices : Mapping[str, Floats]
        (6, n) by bearing, and "gearbox": what the drivetrain puts on its surroundings, moments
        about the bearing's centre; NaN where the level cannot tell.
    points, compliance : tuple[str, ...], Floats
        Names of n points, and (6 n, 6 n) motions of each for unit forces and moments at each, on
        the scene's supports; no points at level 0.
    entrance : Entrance
        Where loads enter the scene.
    """

    level: int
    title: str
    neglects: tuple[str, ...]
    cost: Cost
    reaction_matrices: Mapping[str, Floats]
    points: tuple[str, ...] = ()
    compliance: Floats = field(default_factory=lambda: np.zeros((0, 0)))
    entrance: Entrance = AT_HUB

    __repr__ = short_repr

    def reactions(self, load: Factors | ArrayLike) -> dict[str, Floats]:
        """Reactions (..., 6) [N, N m] to loads (..., n), factors of `model.scene_loads`.

        Raises
        ------
        InputError
            `response.factor_values` refuses them.
        """
        factors = factor_values(self, load)
        return {name: factors @ matrix.T for name, matrix in self.reaction_matrices.items()}

    def stiffness(self, at: Sequence[str]) -> Floats:
        """(6 n, 6 n) stiffness at n points of the scene on its supports [N/m, N, N m/rad].

        Raises
        ------
        InputError
            The level has no stiffness there, or a motion there is held rigidly.
        """
        missing = [name for name in at if name not in self.points]
        if missing:
            known = ", ".join(self.points) or "none: it has no stiffness at all"
            raise InputError(
                f"level {self.level} ({self.title}) has no stiffness at {', '.join(missing)}: "
                f"it has {known}"
            )
        rows = np.concatenate([6 * self.points.index(name) + np.arange(6) for name in at])
        compliance = self.compliance[np.ix_(rows, rows)]
        stuck = [
            f"{name} {c}"
            for name, part in zip(at, np.split(compliance.diagonal(), len(at)), strict=True)
            for c, value in zip(MOTIONS, part, strict=True)
            if value <= 0.0
        ]
        if stuck:
            raise InputError(
                f"the stiffness at {', '.join(at)} is infinite in {', '.join(stuck)}, which the "
                "scene holds rigidly: leave that point out, or make its support a spring"
            )
        inverse = np.linalg.inv(0.5 * (compliance + compliance.T))
        return np.asarray(0.5 * (inverse + inverse.T))


def statics_level(scene: Scene) -> LevelModel:
    """Level 0: what equilibrium alone decides."""
    start = time.perf_counter()
    names, positions = reference_points(scene)
    first = positions[0]
    carried: list[tuple[str, int]] = []
    for unit in scene.bearing_units:
        stiffness = joint_stiffness(unit)
        carried += [(unit.bearing.name, c) for c in range(6) if stiffness[c].any()]
    for bearing in scene.nose_bearings:
        carried += [(bearing.name, c) for c, k in enumerate(bearing.stiffness) if k != 0]
    carried += [("gearbox", c) for c, k in enumerate(scene.gearbox.stiffness) if k != 0]
    at = dict(zip(names, positions, strict=True))
    A = np.column_stack([wrench_transport(at[name] - first)[:, c] for name, c in carried])
    size = float(np.ptp(positions[:, 0]))
    scale = np.array([1.0, 1.0, 1.0, size, size, size])
    _, values, vectors = np.linalg.svd(A / scale[:, None])
    null = vectors[(values > 1e-9 * values[0]).sum() :]
    decided = np.abs(null).max(axis=0, initial=0.0) < 1e-9
    loads = _applied(scene, beam_shaft(scene), positions)
    found = np.linalg.lstsq(A / scale[:, None], loads / scale[:, None], rcond=1e-12)[0]
    matrices = {name: np.zeros(loads.shape) for name in (*scene.bearing_names, "gearbox")}
    for (name, c), row, sure in zip(carried, found, decided, strict=True):
        matrices[name][c] = row if sure else np.nan
    unknown = [
        f"{name} {FORCES[c]}" for (name, c), s in zip(carried, decided, strict=True) if not s
    ]
    neglects = ["every stiffness"]
    if unknown:
        neglects.append(f"cannot tell {', '.join(unknown)}: statics does not decide their shares")
    cost = Cost(time.perf_counter() - start, len(carried))
    reactions = _Weighed(matrices, scene, on_shaft=ringed_shaft(scene)[1])
    return LevelModel(0, TITLES[0], tuple(neglects), cost, reactions, entrance=scene.entrance)


def shaft_level(
    scene: Scene,
    level: int,
    housings: Mapping[str, Floats] | None = None,
    body: Condensed | None = None,
) -> LevelModel:
    """Levels 1 to 3: a condensed shaft on springs.

    Parameters
    ----------
    scene : Scene
        The scene.
    level : int
        1 beam, 2 meridian, 3 solid.
    housings : Mapping[str, Floats] or None
        (6, 6) stiffness of each bearing unit by name, see `housing_springs`; rigid where not given.
        Of k units on the same parts (6, 6 k), rows of one stiffness.
    body : Condensed or None
        The condensed shaft, where there is one already.
    """
    start = time.perf_counter()
    body = condensed_shaft(scene, level) if body is None else body
    neglects = []
    everywhere = {unit.bearing.name for unit in scene.bearing_units}
    on_shaft = frozenset(everywhere) if level == 3 else ringed_shaft(scene)[1]
    if on_shaft != everywhere:
        neglects.append("what the rings of bearings do to the shaft")
    if level == 1:
        pieces = scene.shaft.pieces
        if any(piece.fillet > 0 for piece in pieces):
            neglects.append("fillets")
        neglects.append("sections that do not stay plane near steps and seats")
        if any(p.outer_diameter - p.inner_diameter < _THIN * p.outer_diameter for p in pieces):
            neglects.append("bending of the shaft's thin wall where loads enter")
    if scene.nose is not None:
        neglects.append(_ROUND_A_NOSE)
    if not scene.bearing_units:
        housings, title = {}, TITLES[level]
    elif housings is None:
        neglects.append("housings and bedplates that give: they are rigid")
        housings = {unit.bearing.name: joint_stiffness(unit) for unit in scene.bearing_units}
        title = f"{TITLES[level]}, rigid housings"
    else:
        neglects.append("what shaft and housing do to the shape of the face between them")
        on_bedplate = any(unit.bedplate is not None for unit in scene.bearing_units)
        if on_bedplate or scene.coupled_units:
            neglects.append("what a bedplate gives under the weight of its housing")
        title = f"{TITLES[level]}, housings as springs"
    neglects.append(_OPENING)
    standing = None if scene.nose is None else on_nose(scene, scene.nose, level, body)
    body = body if standing is None else standing.body
    found = supported(body, scene_supports(scene, housings), scene.coupled_units)
    n = len(body.names)
    columns = point_loads(scene, body)
    reactions = {name: R @ columns for name, R in found.reactions.items()}
    if standing is not None:
        on_bearings = standing.reactions(found.motions)
        reactions |= {name: R @ columns for name, R in on_bearings.items()}
    reactions.setdefault("gearbox", np.zeros((6, columns.shape[1])))
    cost = Cost(time.perf_counter() - start, 6 * n)
    motions = found.motions[:, : 6 * n]
    weighed = _Weighed(reactions, scene, on_shaft)
    return LevelModel(
        level, title, tuple(neglects), cost, weighed, body.names, motions, scene.entrance
    )


def assembly_level(scene: Scene, cache: Cache | None = None) -> LevelModel:
    """Level 4: shaft, bearings and housings as solids; stiffness at the hub.

    Parameters
    ----------
    scene : Scene
        The scene.
    cache : Cache or None
        Where its solution may come from; the user's if not given. The time of one that was kept is
        that of reading it.
    """
    return solved_assembly(scene, cache)[0]


def solved_assembly(
    scene: Scene, cache: Cache | None = None, neighbours: Neighbours | None = None
) -> tuple[LevelModel, Model, Response]:
    """Level 4, the model that was solved, and its response.

    Parameters
    ----------
    scene, cache : Scene, Cache or None
        See `assembly_level`.
    neighbours : Neighbours or None
        What designs before have left of this mesh; nothing where not given.
    """
    start = time.perf_counter()
    if neighbours is None:
        neighbours = Neighbours(NOTHING)
    model, response = neighbours.solved(scene, cache)
    return level_of_response(scene, response, time.perf_counter() - start), model, response


def level_of_response(scene: Scene, response: Response, seconds: float) -> LevelModel:
    """Level 4 of a scene that was solved, and the wall time that took [s]."""
    names = (*scene.bearing_names, "gearbox")
    reactions = {name: response.reactions[name] for name in names}
    cost = Cost(seconds, response.diagnostics.n_unknowns)
    neglects = (_OPENING,) if scene.nose is None else (_ROUND_A_NOSE, _OPENING)
    motions = response.motions["hub"][:, :6]
    return LevelModel(4, TITLES[4], neglects, cost, reactions, ("hub",), motions, scene.entrance)


def housing_springs(
    scene: Scene,
    coupling: Coupling = "averaged",
    level: int = 2,
    cache: Cache | None = None,
    solids: dict[tuple[str, bool], UnitSolid] | None = None,
) -> tuple[dict[str, Floats], float]:
    """Stiffness of every bearing unit, solved apart, and the wall time that took [s].

    The time of what is kept is the time that it took when it was solved.

    Of k units that stand on the same parts it is (6, 6 k), see `coupled_units.coupled_stiffness`.

    Parameters
    ----------
    scene, coupling : Scene, Coupling
        See `bearing_units.unit_stiffness`.
    level : int
        Level of the shaft that they are for: a solid one (3) has all rings itself.
    cache : Cache or None
        Where they may come from; the user's if not given.
    solids : dict or None
        See `bearing_units.unit_stiffness`.
    """
    start = working_time()
    found: dict[str, Floats] = {}
    for group in scene.coupled_units:
        found |= coupled_stiffness(scene, group, coupling, ring=level < 3, cache=cache)
    for unit in scene.bearing_units:
        name = unit.bearing.name
        if name not in found:
            found[name] = unit_stiffness(
                scene, name, coupling, ring=level < 3, cache=cache, solids=solids
            )
    return found, working_time() - start


class _Weighed(Mapping[str, Floats]):
    """Reactions with what the mass of housings, and of rings that are no part of the shaft, adds.

    It rests on the ground and bends no shaft, except as the housing deforms under its weight. It is
    added when a reaction is first asked for: its geometry takes longer than a shaft on springs, and
    a stiffness needs none of it.
    """

    def __init__(
        self, reactions: dict[str, Floats], scene: Scene, on_shaft: frozenset[str]
    ) -> None:
        self._bare, self._scene, self._on_shaft = reactions, scene, on_shaft

    @cached_property
    def _found(self) -> dict[str, Floats]:
        found, scene = dict(self._bare), self._scene
        for unit in scene.bearing_units:
            bearing = unit.bearing
            bore = scene.seat_diameter(bearing.name)
            solids = solids_of_unit(unit, bore, scene.mesh)
            ring = solids.pop(bearing.name)
            if bearing.name not in self._on_shaft:
                solids[bearing.name] = ring
            added = np.zeros((6, 3))
            for part, solid in solids.items():
                arm = np.array(solid.centre) - [bearing.x, 0.0, 0.0]
                mass = scene.material_of(part).density * solid.volume
                added += mass * wrench_transport(arm)[:, :3]
            found[bearing.name] = found[bearing.name].copy()
            found[bearing.name][:, 6:9] += added
        return found

    def __getitem__(self, name: str) -> Floats:
        return self._found[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._bare)

    def __len__(self) -> int:
        return len(self._bare)


def point_loads(scene: Scene, body: Condensed) -> Floats:
    """(6 n + 3, n_loads): a scene's unit loads, of those at n points and of gravity."""
    n = len(body.names)
    columns = np.zeros((6 * n + 3, len(scene_loads(scene))))
    for k, name in enumerate(scene.bands):
        first = len(LOADS) + 6 * k
        columns[body.rows(name), first : first + 6] = np.eye(6)
    columns[body.rows("hub"), :6] = np.eye(6)
    columns[6 * n :, 6:9] = np.eye(3)
    columns[6 * body.names.index("gearbox") + 2, 9] = -1.0
    return columns


def _applied(scene: Scene, body: Condensed, positions: Floats) -> Floats:
    """(6, n_loads) resultants of a scene's unit loads about the hub."""
    n = len(body.names)
    carry = point_motions(positions, positions[0]).T
    return carry @ np.hstack([np.eye(6 * n), body.gravity]) @ point_loads(scene, body)
