"""Housings that preloaded bolts clamp: condensed to seat, foot and bolts; how they stand then."""

from __future__ import annotations

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache, user_cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit
from fe_drivetrain.drivetrain_file.component import Attachment
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.interfaces.constraints import Constraint, ReferencePoint
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.solve.cost_model import predict
from fe_drivetrain.elasticity.solve.coupled_solid import DISPLACEMENTS, compliance_of, coupled_solid
from fe_drivetrain.elasticity.solve.reduction import System, reduce
from fe_drivetrain.elasticity.solve.solvers import solve
from fe_drivetrain.foreign.assembly import bolt_springs, face_middle
from fe_drivetrain.foreign.foot import ClampedFoot, foot_patches
from fe_drivetrain.foreign.housing import placed_housing
from fe_drivetrain.shafts.response.solution_keys import mesh_hash, solved_by

# Iterations of multigrid, over those of other solids: 54 to 138 were seen with rigid seats, and 27
# are expected. Loads are many, so that too few cost ten times the direct solution.
_RIGID = 5.0


def is_clamped(unit: BearingUnit) -> bool:
    """Whether preloaded bolts clamp its housing.

    Parameters
    ----------
    unit : BearingUnit
        The bearing unit.
    """
    housing = unit.foreign
    return housing is not None and housing.bolts is not None and housing.bolts.hold == "clamped"


def clamped_foot(
    scene: Scene,
    name: str,
    method: str = "auto",
    size: float | None = None,
    ground: float = float("inf"),
    cache: Cache | None = None,
) -> ClampedFoot:
    """Condense a housing from a file to its seat, patches of its foot, and its bolts.

    The seat keeps its shape. Neither bearing nor shaft is in it, nor the housing's weight, which
    would press the foot a little more.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Name of a bearing whose housing has bolts with the hold "clamped".
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.
    size : float or None
        Most of a patch's sides [m]; the washers' diameter if not given. The levels use that.
    ground : float
        Stiffness of the ground over its area, along and across [N/m^3].
    cache : Cache or None
        Where it may come from, the same to the last bit; the user's if not given.

    Returns
    -------
    ClampedFoot
        See there.

    Raises
    ------
    InputError
        The housing is held in another way, or its file has a fault.
    """
    unit = scene.bearing_unit(name)
    if not is_clamped(unit):
        raise InputError(
            f"{name}.housing is not clamped by preloaded bolts: give it a file, and bolts with the "
            "hold 'clamped'"
        )
    housing = unit.foreign
    assert housing is not None
    assert housing.bolts is not None
    mesh = placed_housing(housing, unit.bearing, scene.mesh, cache).mesh
    size = housing.bolts.washer_diameter * housing.scale if size is None else size
    used = user_cache() if cache is None else cache
    content = {
        "foot of": name,
        "at": unit.bearing.x,
        "mesh": mesh_hash(mesh),
        "material": scene.material_of(f"{name}.housing").model_dump(mode="json"),
        "size": size,
        "method": method,
        "made by": solved_by(),
    }
    arrays = used.load("solutions", content)
    if arrays is None:
        compliance, rigid = _condensed(scene, unit, mesh, size, method)
        arrays = {"compliance": compliance, "rigid": rigid}
        used.keep("solutions", content, arrays)
    patches = foot_patches(mesh, name, size, mesh.points.size)
    springs = bolt_springs(unit, mesh, mesh.points.size)
    return ClampedFoot(
        arrays["compliance"],
        arrays["rigid"],
        patches.areas,
        np.array([point.position for point in patches.points]),
        patches.directions,
        np.array([stiffness for _, stiffness in springs]),
        _axes(mesh, name),
        np.full(len(springs), housing.bolts.tightened(housing.scale)),
        ground,
    )


def _condensed(
    scene: Scene, unit: BearingUnit, mesh: Mesh, size: float, method: str
) -> tuple[Floats, Floats]:
    """Compliance of patches and heads with the seat held, and their rigid motions with it."""
    name = unit.bearing.name
    part, centre = f"{name}.housing", np.array([unit.bearing.x, 0.0, 0.0])
    seat = Attachment(name, f"{part}.bore", centre, "rigid")
    solid = coupled_solid(mesh, {part: scene.material_of(part)}, [seat])
    patches = foot_patches(mesh, name, size, solid.n_dofs)
    springs = bolt_springs(unit, mesh, solid.n_dofs)
    directions = [*patches.directions, *[np.eye(6)] * len(springs)]
    turn = sparse.block_diag([sparse.csr_array(d) for d in directions], format="csr")
    motions = [*(p.motion[:3] for p in patches.points), *(p.motion for p, _ in springs)]
    rows = turn @ sparse.vstack(motions, format="csr")
    held = constraints.held(f"{name} seat", solid.points[0], range(6))
    elimination = constraints.eliminate([held, *solid.rigid_faces], solid.n_dofs)
    system = reduce(mesh.points, solid.cells, solid.stiffness, elimination)
    loads = elimination.T.T @ rows.T.toarray()
    method = _chosen(system, loads.shape[1]) if method == "auto" else method
    C = compliance_of(system.K, loads, solve(system, loads, method, DISPLACEMENTS).x)
    rigid = rows[:, : mesh.points.size] @ rigid_motions(mesh.points, centre)
    return np.ascontiguousarray(0.5 * (C + C.T)), np.ascontiguousarray(rigid)


def _chosen(system: System, n_loads: int) -> str:
    """The solver with the least predicted time, where a face is rigid."""
    costs = predict(system, n_loads, DISPLACEMENTS)
    return min(
        [cost for cost in costs if cost.fits] or costs,
        key=lambda cost: cost.seconds * (_RIGID if cost.method == "multigrid" else 1.0),
    ).method


def _axes(mesh: Mesh, name: str) -> Floats:
    """(B, 3) of the bolts from the ground to their heads."""
    found = []
    part = f"{name}.housing"
    count = sum(face.startswith(f"{part}.head ") for face in mesh.faces)
    for number in range(1, count + 1):
        along = face_middle(mesh, f"{part}.head {number}") - face_middle(
            mesh, f"{part}.foot {number}"
        )
        found.append(along / np.linalg.norm(along))
    return np.array(found)


def foot_holds(
    scene: Scene, unit: BearingUnit, mesh: Mesh, n_dofs: int, method: str = "auto"
) -> tuple[list[ReferencePoint], list[Constraint]]:
    """What holds a clamped foot while it stays as it is after tightening.

    Parameters
    ----------
    scene : Scene
        The scene.
    unit : BearingUnit
        One whose housing is clamped, see `is_clamped`.
    mesh : Mesh
        With the housing.
    n_dofs : int
        Degrees of freedom of the model.
    method : str
        Solver, as of `clamped_foot`.

    Returns
    -------
    list[ReferencePoint]
        Patches that are pressed, "NAME.foot K".
    list[Constraint]
        Their mean displacements are zero: "NAME.foot K reaction".
    """
    housing, name = unit.foreign, unit.bearing.name
    assert housing is not None
    assert housing.bolts is not None
    closed = clamped_foot(scene, name, method).tightened.closed
    size = housing.bolts.washer_diameter * housing.scale
    patches = foot_patches(mesh, name, size, n_dofs)
    pressed = [p for p, is_closed in zip(patches.points, closed, strict=True) if is_closed]
    return pressed, [constraints.held(f"{p.name} reaction", p, (0, 1, 2)) for p in pressed]
