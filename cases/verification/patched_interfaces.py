"""Blocks joined or held by each interface of the library, under a constant stress.

Blocks are oblique, their elements skewed, so that nothing is parallel to an axis. Errors are of
the unit stress, or of the unit of what they are named after.
"""

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from scipy import sparse
from scipy.spatial import cKDTree

from fe_drivetrain.cases.references import two_bodies
from fe_drivetrain.cases.references.two_bodies import Bodies
from fe_drivetrain.common import Floats, Ints
from fe_drivetrain.elasticity.interfaces import (
    Constraint,
    ReferencePoint,
    averaged_point,
    averaged_sphere,
    centred_weights,
    held_dofs,
    mortar_tie,
    node_tie,
    rigid_face,
    rigid_point,
    sliding_sphere,
)
from fe_drivetrain.elasticity.mesh import Block, brick, facet_points
from fe_drivetrain.elasticity.operator import traction_loads

LAME = (1.2, 0.8)
"""Poisson's ratio 0.3 [Pa]."""
SPRING = (2.0, 3.0, 5.0, 1.0, 0.7, 0.4)
"""N/m along x, y, z; N m/rad about them."""
NAMES = {4: "tet4", 10: "tet10", 8: "hex8", 20: "hex20", 27: "hex27"}

Pair = tuple[int, int, int, int]
"""Nodes of the slave's elements, of the master's, divisions of the slave, of the master."""

MESHES = (
    (10, 10, 3, 3),
    (10, 10, 2, 3),
    (10, 10, 3, 2),
    (10, 10, 1, 4),
    (10, 10, 4, 1),
    (10, 10, 5, 1),
    (10, 10, 1, 5),
    (27, 10, 2, 3),
    (10, 27, 2, 3),
    (20, 10, 3, 2),
    (10, 20, 3, 2),
    (8, 4, 2, 3),
    (10, 8, 3, 2),
    (4, 4, 3, 2),
)
"""Pairs of meshes: nodes of the slave's elements, of the master's, divisions of either."""
QUICK_MESHES = (MESHES[0], MESHES[1], MESHES[2], MESHES[3], MESHES[5], MESHES[7], MESHES[8])


def oblique(x: Floats) -> Floats:
    """Skew and turn, so that nothing is parallel to an axis and no angle is a right one."""
    skew = np.array([[0.9, 0.3, -0.4], [-0.2, 1.1, 0.3], [0.5, -0.1, 0.8]])
    return np.asarray(x @ skew.T)


def outer(tied: str, bodies: int) -> list[tuple[int, str]]:
    """Faces of one block, or of two on one another, but for those named or tied."""
    names = ("x0", "x1", "y0", "y1", "z0", "z1")
    inner = {(0, "z1"), (1, "z0")} if bodies == 2 else {(0, tied)}
    return [(b, name) for b in range(bodies) for name in names if (b, name) not in inner]


def tied_blocks(pairs: Sequence[Pair]) -> tuple[dict[str, float], dict[str, float]]:
    """Stress errors of two tied blocks.

    Parameters
    ----------
    pairs : sequence of tuple
        Meshes that are tied by mortars, and where both sides have the same elements node by node.

    Returns
    -------
    passing, failing : dict
        By name: ties that pass a constant stress by design, and those node by node of meshes that
        do not match.
    """
    passing, failing = {}, {}
    for nodes in (10, 27):
        one = two_bodies.together(brick((3, 3, 2), nodes, oblique))
        passing[f"bonded, shared nodes: {NAMES[nodes]}"] = _error_of(one, [])
    passing["tie node by node, matching: tet10"] = _tied(node_tie, (10, 10, 3, 3), 1.0)
    for pair in pairs:
        own, other, n, m = pair
        label = f"{NAMES[own]} {n} on {NAMES[other]} {m}"
        passing[f"mortar: {label}"] = _tied(mortar_tie, pair, 1.3)
        if own == other:
            failing[f"node by node: {label}"] = _tied(node_tie, pair, 1.3)
    for own in (10, 20, 27):
        passing[f"mortar, dual multipliers: {NAMES[own]} 2 on tet10 3"] = _tied(
            mortar_tie, (own, 10, 2, 3), 1.3, multipliers="dual"
        )
    return passing, failing


def _tied(make: Callable[..., Constraint], pair: Pair, power: float, **more: Any) -> float:
    """Stress error of two blocks, the slave's elements graded by a power."""
    bodies = two_blocks(pair, power)
    slave, master = bodies.faces[0]["z1"], bodies.faces[1]["z0"]
    tie = make("tie", bodies.points, slave, master, bodies.points.size, **more)
    return _error_of(bodies, [tie])


def two_blocks(pair: Pair, power: float = 1.3) -> Bodies:
    """Two oblique blocks on one another, not yet tied.

    Parameters
    ----------
    pair : tuple
        Nodes of an element of the lower one, the slave, and of the upper; divisions of their sides.
    power : float
        By which the slave's elements are graded.
    """
    made = []
    for k, (nodes, n) in enumerate(zip(pair[:2], pair[2:], strict=True)):
        graded = None if k else np.linspace(0.0, 1.0, n + 1) ** power

        def shape(x: Floats, bottom: float = 0.5 * k) -> Floats:
            return oblique(x * [1.0, 1.0, 0.5] + [0.0, 0.0, bottom])

        made.append(brick((n, n, 1), nodes, shape, edges=(graded, graded, None)))
    return two_bodies.together(*made)


def _error_of(bodies: Bodies, ties: list[Constraint]) -> float:
    n = bodies.points.size
    stresses = two_bodies.unit_stresses()
    free = outer("", 2) if ties else outer("", 1)
    F = np.column_stack([bodies.loads(stress, free) for stress in stresses])
    support = two_bodies.isostatic(bodies.points, np.unique(bodies.faces[-1]["z1"]), n)
    u = two_bodies.solve(bodies.stiffness(LAME), [*ties, support], F).u
    return _worst_stress(bodies, u, stresses)


def _worst_stress(bodies: Bodies, u: Floats, stresses: Sequence[Floats]) -> float:
    return max(
        two_bodies.stress_error(bodies, u[:, k], LAME, stress) for k, stress in enumerate(stresses)
    )


def _one_block() -> Bodies:
    return two_bodies.together(brick((3, 2, 2), 10, oblique))


def _face_point(bodies: Bodies, name: str) -> tuple[ReferencePoint, Floats]:
    """The averaged point at the centre of a plane face, and the face's area times normal."""
    facets = bodies.faces[0][name]
    nodes = np.unique(facets)
    weights = traction_loads(bodies.points, facets, np.array([1.0, 0.0, 0.0]))[3 * nodes]
    centre = weights @ bodies.points[nodes] / weights.sum()
    point = averaged_point(name, nodes, weights, bodies.points, centre, bodies.points.size)
    at = facet_points(bodies.points, facets)
    return point, np.einsum("fq,fqi->i", at.areas, at.normals)


def averaged_block() -> dict[str, float]:
    """Errors of a face loaded through its averaged point, and of its motion in a linear field."""
    bodies = _one_block()
    point, area = _face_point(bodies, "z0")
    stresses = two_bodies.unit_stresses()
    forces = [
        bodies.loads(stress, outer("z0", 1)) + point.motion[:3].T @ (stress @ area)
        for stress in stresses
    ]
    top = np.unique(bodies.faces[0]["z1"])
    support = two_bodies.isostatic(bodies.points, top, bodies.points.size)
    u = two_bodies.solve(bodies.stiffness(LAME), [support], np.column_stack(forces)).u

    # Of u = G x: the centre's displacement, and omega = I^-1 mean(r x G r) over the parallelogram.
    gradient = np.array([[0.3, -0.7, 0.2], [0.5, 0.1, -0.4], [-0.6, 0.9, 0.8]])
    sides = oblique(np.eye(3))[:2]
    second = sides.T @ sides / 12.0
    inertia = np.trace(second) * np.eye(3) - second
    turning = gradient @ second
    moment = np.array(
        [
            turning[2, 1] - turning[1, 2],
            turning[0, 2] - turning[2, 0],
            turning[1, 0] - turning[0, 1],
        ]
    )
    expected = np.concatenate(
        [gradient @ oblique(np.array([0.5, 0.5, 0.0])), np.linalg.solve(inertia, moment)]
    )
    moved = point.motion @ (bodies.points @ gradient.T).ravel()
    return {
        "averaged point: stress of a face loaded through it": _worst_stress(bodies, u, stresses),
        "averaged point: motion in a linear field": float(np.abs(moved - expected).max()),
    }


def sprung_block() -> dict[str, float]:
    """Errors of a block on springs at the averaged point of a face, which add what they carry."""
    bodies = _one_block()
    point, area = _face_point(bodies, "z0")
    stresses = two_bodies.unit_stresses()
    F = np.column_stack([bodies.loads(stress, outer("z0", 1)) for stress in stresses])
    spring = point.motion.T @ sparse.diags_array(np.array(SPRING)) @ point.motion
    u = two_bodies.solve((bodies.stiffness(LAME) + spring).tocsr(), [], F).u
    moved = point.motion @ u
    expected = np.zeros((6, 6))
    expected[:3] = -np.column_stack([stress @ area for stress in stresses])
    expected /= np.array(SPRING)[:, None]
    return {
        "springs: stress of the block that they hold": _worst_stress(bodies, u, stresses),
        "springs: their elongation": float(np.abs(moved - expected).max()),
    }


def rigid_block() -> dict[str, float]:
    """Errors of a rigid face: in its rigid motions, and in tension that leaves it undeformed."""
    bodies = _one_block()
    n = bodies.points.size + 6
    nodes = np.unique(bodies.faces[0]["z0"])
    centre = bodies.points[nodes].mean(axis=0)
    point = rigid_point("point", centre, bodies.points.size, n)
    face = rigid_face("face", nodes, bodies.points, point)
    held = held_dofs("held", np.arange(n - 6, n), n)

    K = bodies.stiffness(LAME, n)
    turned = two_bodies.solve(K, [face, held], np.zeros((n, 6)), {"held": np.eye(6)})
    still = _worst_stress(bodies, turned.u, [np.zeros((3, 3))] * 6)

    _, area = _face_point(bodies, "z0")
    normal = area / np.linalg.norm(area)
    tension = np.outer(normal, normal)
    no_contraction = (0.0, 0.8)
    K = bodies.stiffness(no_contraction, n)
    pulled = two_bodies.solve(K, [face, held], bodies.loads(tension, outer("z0", 1), n)[:, None])
    reaction = pulled.carried("held")[n - 6 : n - 3, 0]
    return {
        "rigid face: stress in its rigid motions": still,
        "rigid face: stress in tension along its normal": two_bodies.stress_error(
            bodies, pulled.u[:, 0], no_contraction, tension
        ),
        "rigid face: its reaction in tension": float(np.abs(reaction - tension @ area).max()),
    }


def _spheres(divisions: int) -> tuple[Bodies, Ints, Ints]:
    """Two sectors of shells on one another, their faces at radius 1, and twin nodes there."""

    def sector(bottom: float) -> Block:
        def shape(x: Floats) -> Floats:
            across = np.tan(np.radians(70.0) * (x[:, :2] - 0.5))
            direction = np.column_stack([across, np.ones(len(x))])
            direction /= np.linalg.norm(direction, axis=1)[:, None]
            return np.asarray((bottom + 0.4 * x[:, 2:]) * direction)

        return brick((divisions, divisions, max(divisions // 2, 1)), 10, shape)

    bodies = two_bodies.together(sector(0.6), sector(1.0))
    inner = np.unique(bodies.faces[0]["z1"])
    outside = np.unique(bodies.faces[1]["z0"])
    match = cKDTree(bodies.points[outside]).query(bodies.points[inner])[1]
    return bodies, inner, outside[match]


def sphere_kinematics() -> dict[str, float]:
    """How far an isotropic strain is from fulfilling both forms of the spherical joint."""
    bodies, inner, outside = _spheres(2)
    centre = np.zeros(3)
    size = bodies.points.size
    strain = bodies.points.ravel()
    sliding = sliding_sphere("joint", inner, outside, bodies.points, centre, size)

    along = np.array([1.0, 0.0, 0.0])
    pairs = ((inner, bodies.faces[0]["z1"]), (outside, bodies.faces[1]["z0"]))
    own, other = (
        centred_weights(
            traction_loads(bodies.points, facets, along)[3 * nodes], bodies.points[nodes], centre
        )
        for nodes, facets in pairs
    )
    groups = np.zeros(2 * len(inner), dtype=np.int64)
    averaged = averaged_sphere("joint", inner, outside, own, other, groups, size, size + 3)
    # the sum of the one group is zero
    moved = averaged.rows @ np.append(strain, np.zeros(3))
    return {
        "sliding sphere: isotropic strain fulfils it": float(np.abs(sliding.rows @ strain).max()),
        "averaged sphere: isotropic strain fulfils it": float(np.abs(moved).max()),
    }


def sphere_error(divisions: int) -> float:
    """Stress error of a uniform pressure that passes the sliding sphere, of the pressure.

    Parameters
    ----------
    divisions : int
        Elements along a side of the sector.

    Returns
    -------
    error : float
        Root mean square.
    """
    bodies, inner, outside = _spheres(divisions)
    n = bodies.points.size
    joint = sliding_sphere("joint", inner, outside, bodies.points, np.zeros(3), n)
    pressure = -np.eye(3)
    F = bodies.loads(pressure, outer("", 2))[:, None]
    # Nodes on the axis of either body, and one in the plane y = 0: the exact strain leaves the
    # held ones where they are, but for a motion of the whole along z.
    held = []
    for faces in bodies.faces:
        for name in ("z0", "z1"):
            nodes = np.unique(faces[name])
            axis = int(nodes[np.argmin(np.abs(bodies.points[nodes, :2]).sum(axis=1))])
            held += [3 * axis, 3 * axis + 1]
        nodes = np.unique(faces["x1"])
        held.append(3 * int(nodes[np.argmin(np.abs(bodies.points[nodes, 1]))]) + 1)
    held.append(3 * axis + 2)
    support = held_dofs("support", np.array(held), n)
    u = two_bodies.solve(bodies.stiffness(LAME), [joint, support], F).u
    return two_bodies.stress_error(bodies, u[:, 0], LAME, pressure, root_mean_square=True)
