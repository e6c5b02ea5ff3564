"""The same solid, and the same main bearing, in another frame."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse
from scipy.spatial.transform import Rotation

from fe_drivetrain.cases.references.manufactured import HEIGHT, INNER, LAME, OUTER, quarter_ring
from fe_drivetrain.common import Floats
from fe_drivetrain.elasticity.interfaces import Constraint, ReferencePoint, constraints
from fe_drivetrain.elasticity.mesh import MEANS, brick, face_weights
from fe_drivetrain.elasticity.operator import assemble, body_loads, pressure, traction_loads
from fe_drivetrain.elasticity.solve import solve_solid
from fe_drivetrain.shafts.response import Model, Response, joint_pairs

#: Divisions of the quarter ring.
DIVISIONS = (2, 4, 2)


@dataclass(frozen=True)
class Ring:
    """Results of the quarter ring, as they are in its frame.

    Attributes
    ----------
    displacements, reactions : Floats
        (n, 3, 8) of the nodes [m, N]: six unit loads at the free end, pressure, body force.
    compliance : Floats
        (6, 6) motions of the free end under unit loads along the frame's axes.
    """

    displacements: Floats
    reactions: Floats
    compliance: Floats


def solve_ring(nodes: int, turn: Floats, shift: Floats) -> Ring:
    """The quarter ring, turned and moved with all its loads.

    Parameters
    ----------
    nodes : int
        Of the element.
    turn : Floats
        (3, 3) rotation matrix.
    shift : Floats
        (3,) [m].
    """
    block = brick(DIVISIONS, nodes, lambda p: quarter_ring(p) @ turn.T + shift)
    points, n = block.points, 3 * len(block.points)
    middle = np.array([0.0, 0.5 * (INNER + OUTER), 0.5 * HEIGHT])
    end = constraints.rigid_point("end", turn @ middle + shift, n, n + 6)
    conditions = [
        constraints.fixed("fixed", block.face_nodes("y0"), n + 6),
        constraints.rigid_face("end", block.face_nodes("y1"), points, end),
    ]
    F = np.zeros((n + 6, 8))
    F[n:, :6] = twice(turn)  # unit loads along the body's axes, as they are in the frame
    F[:, 6] = traction_loads(points, block.faces["x0"], pressure(1e6), n + 6)
    F[:, 7] = body_loads(points, block.cells, turn @ np.array([3e4, -5e4, 7e4]), n + 6)
    static = solve_solid(points, block.cells, LAME, conditions, F, method="superlu")
    return Ring(
        static.u[:n].reshape(-1, 3, 8),
        static.reactions["fixed"][:n].reshape(-1, 3, 8),
        static.u[n:, :6] @ twice(turn).T,
    )


def twice(turn: Floats) -> Floats:
    """(6, 6): a rotation of displacements and of rotations."""
    return np.asarray(np.kron(np.eye(2), turn), dtype=float)


def random_frame(seed: int) -> tuple[Floats, Floats]:
    """A rotation matrix (3, 3) and a direction (3,), at random."""
    rng = np.random.default_rng(seed)
    Q = Rotation.random(random_state=rng).as_matrix()
    away = rng.normal(size=3)
    return Q, away / np.linalg.norm(away)


def differences(here: Ring, there: Ring, turn: Floats) -> dict[str, float]:
    """What differs between two frames once results are turned back, relative."""
    back = twice(turn).T @ there.compliance @ twice(turn)
    return {
        "displacements": _by_load(here.displacements, turned_back(there.displacements, turn)),
        "reactions": _by_load(here.reactions, turned_back(there.reactions, turn)),
        "stiffness": _stiffness_difference(here.compliance, back),
    }


def turned_back(vectors: Floats, turn: Floats) -> Floats:
    """(n, 3, m) vectors of the turned frame along the axes of the other one."""
    return np.asarray(np.einsum("ji,njm->nim", turn, vectors))


def _by_load(a: Floats, b: Floats) -> float:
    size = np.abs(a).max(axis=(0, 1))
    return float((np.abs(a - b).max(axis=(0, 1)) / size).max())


def _stiffness_difference(one: Floats, other: Floats) -> float:
    """Largest difference of the stiffness of two compliances, relative to its diagonal."""
    a, b = np.linalg.inv(one), np.linalg.inv(other)
    own = np.sqrt(np.abs(a.diagonal()))
    return float((np.abs(a - b) / np.outer(own, own)).max())


def moved_model(model: Model, turn: Floats, shift: Floats) -> Model:
    """The model of a library scene with its mesh turned and moved.

    Reference points keep the axes of the body: their forces and motions are along its own axes, and
    so are springs and torque reaction. Displacements, and loads of gravity, are in the frame.

    Parameters
    ----------
    model : Model
        With averaged couplings, one bearing, bonded or in a sliding spherical joint.
    turn : Floats
        (3, 3) rotation matrix.
    shift : Floats
        (3,) [m].
    """
    old = model.mesh
    mesh = replace(old, points=old.points @ turn.T + shift)
    n, n_dofs = len(mesh.points), model.n_dofs
    unit = model.scene.bearing_units[0]
    name = unit.bearing.name
    faces = {"hub": "shaft.front", "gearbox": "shaft.rear", f"{name}.seat": f"shaft.seat.{name}"}
    points = {}
    for key, face in faces.items():
        nodes = mesh.face_nodes(face)
        weights = face_weights(mesh.points, mesh.faces[face], n, MEANS)[nodes]
        position = turn @ model.points[key].position + shift
        point = constraints.averaged_point(key, nodes, weights, mesh.points, position, n_dofs)
        own_axes = (sparse.csr_array(twice(turn).T) @ point.motion).tocsr()
        points[key] = ReferencePoint(key, position, own_axes)

    conditions: list[Constraint] = []
    if unit.interface == "sliding":
        inner, outer = joint_pairs(mesh, name)
        centre = turn @ np.array([unit.bearing.x, 0.0, 0.0]) + shift
        conditions.append(
            constraints.sliding_sphere(f"{name} joint", inner, outer, mesh.points, centre, n_dofs)
        )
    base = f"{name}.housing.base"
    conditions.append(constraints.fixed(base, mesh.face_nodes(base), n_dofs))
    held = model.scene.gearbox.held
    conditions.append(constraints.held("gearbox reaction", points["gearbox"], held))
    stiffness = {
        part: assemble(
            mesh.points,
            mesh.cells[mesh.part_cells(part)],
            model.scene.material_of(part).lame,
            n_dofs,
        )
        for part in mesh.part_names
    }
    return replace(
        model,
        mesh=mesh,
        part_stiffness=stiffness,
        points=points,
        constraints=tuple(conditions),
        springs=tuple((points[point.name], k) for point, k in model.springs),
    )


def response_differences(here: Response, there: Response, turn: Floats) -> dict[str, float]:
    """What differs between the responses of a model and of its `moved_model`, relative.

    Of the moved one gravity is along the frame's axes, so its three loads are combined into those
    along the body's; forces and moments at bearing and housing are turned back.
    """
    combine = np.eye(10)
    combine[6:9, 6:9] = turn
    u = turned_back(there.displacements, turn) @ combine
    found = {"displacements": _by_load(here.displacements, u)}
    # Of each load the largest reaction anywhere: some bearings feel nothing of some loads.
    size = np.max([np.abs(r).max(axis=0) for r in here.reactions.values()], axis=0)
    for name, reaction in here.reactions.items():
        other = there.reactions[name] @ combine
        if name != "gearbox":  # along the body's own axes already
            other = twice(turn).T @ other
        found[f"reaction {name}"] = float((np.abs(reaction - other).max(axis=0) / size).max())
    hub, other = (r.motions["hub"][:, :6] for r in (here, there))
    found["stiffness at the hub"] = _stiffness_difference(hub, other)
    return found
