"""Patch test of the interfaces: a constant stress passes through every one of them, or why not."""

from typing import Any

from fe_drivetrain.suite import OldCase as Case
from fe_drivetrain.suite import Run

#: (nodes of the slave's elements, of the master's, divisions of the slave, of the master)
MORTAR = (
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
QUICK_MORTAR = (MORTAR[0], MORTAR[1], MORTAR[2], MORTAR[3], MORTAR[5], MORTAR[7], MORTAR[8])
NAMES = {4: "tet4", 10: "tet10", 8: "hex8", 20: "hex20", 27: "hex27"}

ROUND_OFF = 1e-12
LAME = (1.2, 0.8)  # Poisson's ratio 0.3
SPRING = (2.0, 3.0, 5.0, 1.0, 0.7, 0.4)  # N/m along x, y, z; N m/rad about them


def run(run: Run) -> Any:
    """Every interface under constant stress."""
    import numpy as np

    from fe_drivetrain.report import Section, Table, Text, chart, judge

    with run.step("ties"):
        ties, by_nodes = tied_blocks(QUICK_MORTAR if run.quick else MORTAR)
    with run.step("reference points"):
        points = {**sprung_block(), **averaged_block(), **rigid_block()}
    with run.step("spheres"):
        kinematics = sphere_kinematics()
        divisions = (2, 4) if run.quick else (2, 4, 8)
        spheres = [sphere_error(n) for n in divisions]
    order = float(np.log2(spheres[-2] / spheres[-1]))

    reason = (
        "the discrete equations hold exactly for a constant stress, so only round-off is left: "
        "about a thousand operations at 1e-16 each, and the elements' condition"
    )
    source = "constant stress (Irons and Razzaque 1972, patch test)"
    verdicts = [
        judge(
            name,
            error,
            0.0,
            tolerance=ROUND_OFF,
            relative=False,
            source=source,
            reason=reason,
            measure="identity",
        )
        for name, error in {**ties, **points, **kinematics}.items()
    ]
    verdicts.append(
        judge(
            "sliding sphere under pressure: order that the stress error lacks to two",
            max(2.0 - order, 0.0),
            0.0,
            tolerance=0.1,
            relative=False,
            source="interpolation: normals of quadratic facets are of second order",
            reason="the joint acts along exact normals, the pressure along those of the facets; "
            "a tenth for an order seen on few meshes",
            measure="order",
            band=0.1,
        )
    )
    exact = {**ties, **points}
    bars = [
        {
            "type": "bar",
            "orientation": "h",
            "name": name,
            "y": list(found),
            "x": [max(float(f"{error:.3g}"), 1e-17) for error in found.values()],
        }
        for name, found in (("passes by design", exact), ("tied node by node", by_nodes))
    ]
    figure = chart(
        "Largest error of the stress, of unit stress; interfaces that pass, and ties node by node "
        "beside them",
        bars,
        "error of the stress",
        "",
        logarithmic="x",
    )
    figure.figure["layout"] |= {
        "height": 24 * (len(exact) + len(by_nodes)) + 160,
        "margin": {"l": 330},
        "yaxis": {"autorange": "reversed"},
    }
    worst = max(exact.values())
    return CASE.results(
        run,
        summary=[
            f"Constant stress passes every interface on plane faces to {worst:.1e} of itself, "
            f"{len(ties)} bonds and ties among them, of any mesh ratio, either side the slave. "
            "Tied node by node, meshes that do not match have stress errors of up to "
            f"{max(by_nodes.values()):.1f} times the stress. "
            f"Pressure through the sliding sphere converges with order {order:.1f}.",
        ],
        verdicts=verdicts,
        sections=[
            Section(
                title="Interfaces under constant stress",
                items=[
                    figure,
                    Table(
                        caption="Meshes that do not match, tied node by node: not judged, the "
                        "error is the point",
                        columns=["tie", "largest error of the stress, of unit stress"],
                        rows=[[name, error] for name, error in by_nodes.items()],
                    ),
                    Text(
                        text="Two oblique blocks, or one, loaded on all outer faces by the "
                        "tractions of each of the six states of unit stress, and held at three "
                        "nodes. Elements are skewed; those of the slave are graded, so that meshes "
                        "do not nest. A number after an element is the divisions of the face's "
                        "sides. Node by node passes only where the slave's mesh divides the "
                        "master's. A rigid face can pass only what leaves it plane and "
                        "undeformed: tension along its normal without lateral contraction, here "
                        "with Poisson's ratio zero."
                    ),
                ],
            ),
            Section(
                title="Pressure through a sliding sphere",
                items=[
                    chart(
                        "Root mean square of the stress error, of the pressure",
                        [
                            {
                                "type": "scatter",
                                "mode": "lines+markers",
                                "name": "sliding sphere, tet10",
                                "x": list(divisions),
                                "y": spheres,
                            }
                        ],
                        "elements along a side of the sector",
                        "error of the stress",
                        logarithmic="xy",
                    ),
                    Text(
                        text="An isotropic strain fulfils the joint exactly, sliding and averaged. "
                        "The forces do not balance exactly: the sliding joint pushes each node "
                        "along the sphere's radius, the pressure on a facet is integrated with "
                        "the facet's own normals. The averaged joint carries the sphere's "
                        "resultant only: it passes no pressure, and adds nothing to what presses "
                        "on both faces."
                    ),
                ],
            ),
        ],
        figures={
            "stress errors": exact | by_nodes,
            "sphere": spheres,
            "sphere divisions": divisions,
        },
    )


def oblique(x: Any) -> Any:
    """Skew and turn, so that nothing is parallel to an axis and no angle is a right one."""
    import numpy as np

    return x @ np.array([[0.9, 0.3, -0.4], [-0.2, 1.1, 0.3], [0.5, -0.1, 0.8]]).T


def outer(tied: str, bodies: int) -> list[tuple[int, str]]:
    """Faces of one block, or of two on one another, but for those named or tied."""
    names = ("x0", "x1", "y0", "y1", "z0", "z1")
    inner = {(0, "z1"), (1, "z0")} if bodies == 2 else {(0, tied)}
    return [(b, name) for b in range(bodies) for name in names if (b, name) not in inner]


def tied_blocks(mortar: Any) -> tuple[dict[str, float], dict[str, float]]:
    """Stress errors of ties that pass, and of those node by node that do not."""
    import numpy as np

    from fe_drivetrain.interfaces import mortar_tie, node_tie
    from fe_drivetrain.mesh import brick
    from fe_drivetrain.validation import (
        two_bodies,
    )

    def blocks(nodes: tuple[int, int], divisions: tuple[int, int], power: float) -> Any:
        made = []
        for k, (n, m) in enumerate(zip(nodes, divisions, strict=True)):
            graded = None if k else np.linspace(0.0, 1.0, m + 1) ** power

            def shape(x: Any, bottom: float = 0.5 * k) -> Any:
                return oblique(x * [1.0, 1.0, 0.5] + [0.0, 0.0, bottom])

            made.append(brick((m, m, 1), n, shape, edges=(graded, graded, None)))
        return two_bodies.together(*made)

    def error(bodies: Any, ties: list[Any]) -> float:
        n = bodies.points.size
        K = bodies.stiffness(LAME)
        stresses = two_bodies.unit_stresses()
        free = outer("", 2) if ties else outer("", 1)
        F = np.column_stack([bodies.loads(stress, free) for stress in stresses])
        support = two_bodies.isostatic(bodies.points, np.unique(bodies.faces[-1]["z1"]), n)
        u = two_bodies.solve(K, [*ties, support], F).u
        return max(
            two_bodies.stress_error(bodies, u[:, k], LAME, stress)
            for k, stress in enumerate(stresses)
        )

    def tied(make: Any, nodes: Any, divisions: Any, power: float, **more: Any) -> float:
        bodies = blocks(nodes, divisions, power)
        slave, master = bodies.faces[0]["z1"], bodies.faces[1]["z0"]
        return error(
            bodies, [make("tie", bodies.points, slave, master, bodies.points.size, **more)]
        )

    passing, failing = {}, {}
    for nodes in (10, 27):
        one = two_bodies.together(brick((3, 3, 2), nodes, oblique))
        passing[f"bonded, shared nodes: {NAMES[nodes]}"] = error(one, [])
    passing["tie node by node, matching: tet10"] = tied(node_tie, (10, 10), (3, 3), 1.0)
    for own, other, n, m in mortar:
        label = f"{NAMES[own]} {n} on {NAMES[other]} {m}"
        passing[f"mortar: {label}"] = tied(mortar_tie, (own, other), (n, m), 1.3)
        if (own, other) == (10, 10) or own == other:
            failing[f"node by node: {label}"] = tied(node_tie, (own, other), (n, m), 1.3)
    for own in (10, 20, 27):
        passing[f"mortar, dual multipliers: {NAMES[own]} 2 on tet10 3"] = tied(
            mortar_tie, (own, 10), (2, 3), 1.3, multipliers="dual"
        )
    return passing, failing


def one_block() -> Any:
    from fe_drivetrain.mesh import brick
    from fe_drivetrain.validation import (
        two_bodies,
    )

    return two_bodies.together(brick((3, 2, 2), 10, oblique))


def face_point(bodies: Any, name: str, n_freedoms: int) -> tuple[Any, Any]:
    """The averaged point at the centre of a plane face, and the face's area times normal."""
    import numpy as np

    from fe_drivetrain.interfaces import averaged_point
    from fe_drivetrain.mesh import facet_points
    from fe_drivetrain.operator import traction_loads

    facets = bodies.faces[0][name]
    nodes = np.unique(facets)
    weights = traction_loads(bodies.points, facets, np.array([1.0, 0.0, 0.0]))[3 * nodes]
    centre = weights @ bodies.points[nodes] / weights.sum()
    point = averaged_point(name, nodes, weights, bodies.points, centre, n_freedoms)
    at = facet_points(bodies.points, facets)
    return point, np.einsum("fq,fqi->i", at.areas, at.normals)


def averaged_block() -> dict[str, float]:
    """A face loaded through its averaged point, and the point's motion in a linear field."""
    import numpy as np

    from fe_drivetrain.validation import (
        two_bodies,
    )

    bodies = one_block()
    n = bodies.points.size
    point, area = face_point(bodies, "z0", n)
    stresses = two_bodies.unit_stresses()
    forces = [
        bodies.loads(stress, outer("z0", 1)) + point.motion[:3].T @ (stress @ area)
        for stress in stresses
    ]
    support = two_bodies.isostatic(bodies.points, np.unique(bodies.faces[0]["z1"]), n)
    u = two_bodies.solve(bodies.stiffness(LAME), [support], np.column_stack(forces)).u
    error = max(
        two_bodies.stress_error(bodies, u[:, k], LAME, stress) for k, stress in enumerate(stresses)
    )

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
        "averaged point: stress of a face loaded through it": error,
        "averaged point: motion in a linear field": float(np.abs(moved - expected).max()),
    }


def sprung_block() -> dict[str, float]:
    """A block on springs at the averaged point of a face: the springs add what they carry only."""
    import numpy as np
    from scipy import sparse

    from fe_drivetrain.validation import (
        two_bodies,
    )

    bodies = one_block()
    n = bodies.points.size
    point, area = face_point(bodies, "z0", n)
    stresses = two_bodies.unit_stresses()
    F = np.column_stack([bodies.loads(stress, outer("z0", 1)) for stress in stresses])
    spring = point.motion.T @ sparse.diags_array(np.array(SPRING)) @ point.motion
    u = two_bodies.solve((bodies.stiffness(LAME) + spring).tocsr(), [], F).u
    moved = point.motion @ u
    expected = np.zeros((6, 6))
    expected[:3] = -np.column_stack([stress @ area for stress in stresses])
    expected /= np.array(SPRING)[:, None]
    error = max(
        two_bodies.stress_error(bodies, u[:, k], LAME, stress) for k, stress in enumerate(stresses)
    )
    return {
        "springs: stress of the block that they hold": error,
        "springs: their elongation": float(np.abs(moved - expected).max()),
    }


def rigid_block() -> dict[str, float]:
    """A rigid face: its rigid motions, and the tension that leaves it undeformed."""
    import numpy as np

    from fe_drivetrain.interfaces import held_freedoms, rigid_face, rigid_point
    from fe_drivetrain.validation import (
        two_bodies,
    )

    bodies = one_block()
    n = bodies.points.size + 6
    nodes = np.unique(bodies.faces[0]["z0"])
    centre = bodies.points[nodes].mean(axis=0)
    point = rigid_point("point", centre, bodies.points.size, n)
    face = rigid_face("face", nodes, bodies.points, point)
    held = held_freedoms("held", np.arange(n - 6, n), n)

    K = bodies.stiffness(LAME, n)
    turned = two_bodies.solve(K, [face, held], np.zeros((n, 6)), {"held": np.eye(6)})
    still = max(
        two_bodies.stress_error(bodies, turned.u[:, k], LAME, np.zeros((3, 3))) for k in range(6)
    )

    _, area = face_point(bodies, "z0", n)
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


def spheres(divisions: int) -> Any:
    """Two sectors of shells on one another, their faces at radius 1, and twin nodes there."""
    import numpy as np
    from scipy.spatial import cKDTree

    from fe_drivetrain.mesh import brick
    from fe_drivetrain.validation import (
        two_bodies,
    )

    def sector(bottom: float) -> Any:
        def shape(x: Any) -> Any:
            across = np.tan(np.radians(70.0) * (x[:, :2] - 0.5))
            direction = np.column_stack([across, np.ones(len(x))])
            direction /= np.linalg.norm(direction, axis=1)[:, None]
            return (bottom + 0.4 * x[:, 2:]) * direction

        return brick((divisions, divisions, max(divisions // 2, 1)), 10, shape)

    bodies = two_bodies.together(sector(0.6), sector(1.0))
    inner = np.unique(bodies.faces[0]["z1"])
    outside = np.unique(bodies.faces[1]["z0"])
    match = cKDTree(bodies.points[outside]).query(bodies.points[inner])[1]
    return bodies, inner, outside[match]


def sphere_kinematics() -> dict[str, float]:
    """How far an isotropic strain is from fulfilling both forms of the spherical joint."""
    import numpy as np

    from fe_drivetrain.interfaces import averaged_sphere, centred_weights, sliding_sphere
    from fe_drivetrain.operator import traction_loads

    bodies, inner, outside = spheres(2)
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
    return {
        "sliding sphere: isotropic strain fulfils it": float(np.abs(sliding.rows @ strain).max()),
        "averaged sphere: isotropic strain fulfils it": float(
            np.abs(averaged.rows @ np.append(strain, np.zeros(3))).max()
        ),
    }


def sphere_error(divisions: int) -> float:
    """Stress error of a uniform pressure that passes the sliding sphere, of the pressure."""
    import numpy as np

    from fe_drivetrain.interfaces import held_freedoms, sliding_sphere
    from fe_drivetrain.validation import (
        two_bodies,
    )

    bodies, inner, outside = spheres(divisions)
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
    support = held_freedoms("support", np.array(held), n)
    u = two_bodies.solve(bodies.stiffness(LAME), [joint, support], F).u
    return two_bodies.stress_error(bodies, u[:, 0], LAME, pressure, root_mean_square=True)


CASE = Case(
    name="verification/patch_interfaces",
    title="Patch test: constant stress through every interface, conforming or not",
    source="Irons and Razzaque 1972 (patch test); Puso 2004, Int. J. Numer. Meth. Engng 59, 315",
    run=run,
)

if __name__ == "__main__":
    from fe_drivetrain.commands import main_of_case

    main_of_case(CASE)
