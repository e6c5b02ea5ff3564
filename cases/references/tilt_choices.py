"""Tilt stiffness K_R of the main bearing's housing by every tetrahedron, and as a user asks for it.

The sweep of elements and solvers assembles the bonded scene itself, since the model of a scene is
of curved elements alone; `ten_unit_loads` goes through the model, as users do.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from dataclasses import dataclass
from functools import partial

import numpy as np

from fe_drivetrain.cases.references.stiffness_choices import (
    CURVED,
    P1,
    REPEATS,
    STEPS,
    STRAIGHT,
    Assembled,
    Outcome,
    Solve,
    solved,
    timed,
)
from fe_drivetrain.common import Floats, Ints, Times
from fe_drivetrain.drivetrain_file import Scene
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.mesh import MEANS, Mesh, face_weights, first_order, straightened
from fe_drivetrain.elasticity.operator import assemble
from fe_drivetrain.elasticity.solve import reduce
from fe_drivetrain.geometry import MeshSizes
from fe_drivetrain.shafts.response import (
    PLANES,
    build_model,
    mesh_scene,
    tilt_by_plane,
    unit_load_response,
)

#: What is compared: K_R by plane and by estimator of `bearing_stiffness.tilt_stiffness`.
QUANTITIES = tuple((plane.name, kind) for kind in ("energy", "averaged seat") for plane in PLANES)

#: Element sizes that converge together; the shaft stays coarse, since its ends and its bending
#: converge fast and K_R does not count its deformation.
BALANCED = MeshSizes(
    shaft=0.25, bearing=0.08, housing=0.07, bearing_edge=0.035, elements_per_turn=8
)


def balanced(factor: float) -> MeshSizes:
    """`BALANCED` sizes times a factor, but for the shaft, on which elements a turn count, too."""
    sizes = BALANCED.scaled(factor, BALANCED.elements_per_turn)
    return sizes.model_copy(update={"shaft": BALANCED.shaft})


def sizes_in_words(sizes: MeshSizes) -> str:
    """The four sizes, for a table."""
    four = (sizes.shaft, sizes.bearing, sizes.housing, sizes.bearing_edge)
    return " / ".join(f"{1000 * size:.3g}" for size in four) + " mm"


@dataclass(frozen=True)
class TiltMesh:
    """The bonded main bearing in any tetrahedra.

    Attributes
    ----------
    points : ndarray
        (n, 3), m.
    cells : ndarray of int
        (ne, 4) or (ne, 10) node ids.
    cells_of : dict of str to ndarray of int
        Indices of each part's cells.
    base : ndarray of int
        Nodes of the housing's base.
    hub, seat : tuple of two ndarrays
        Nodes of the shaft's front face and of the bearing's seat, and the integrals of their shape
        functions [m^2].
    """

    points: Floats
    cells: Ints
    cells_of: dict[str, Ints]
    base: Ints
    hub: tuple[Ints, Floats]
    seat: tuple[Ints, Floats]


def in_element(mesh: Mesh, bearing: str, element: str) -> TiltMesh:
    """A mesh of curved tetrahedra in the element asked for."""
    points, cells = mesh.points, mesh.cells
    faces = {
        name: mesh.faces[face]
        for name, face in (
            ("hub", "shaft.front"),
            ("seat", f"shaft.seat.{bearing}"),
            ("base", f"{bearing}.housing.base"),
        )
    }
    if element == STRAIGHT:
        points = straightened(points, cells)
    elif element == P1:
        linear = first_order(points, cells)
        points, cells = linear.points, linear.cells
        faces = {name: linear.number[face[:, :3]] for name, face in faces.items()}

    def weighed(name: str) -> tuple[Ints, Floats]:
        nodes = np.unique(faces[name])
        return nodes, face_weights(points, faces[name], len(points), MEANS)[nodes]

    return TiltMesh(
        points,
        cells,
        {part: mesh.part_cells(part) for part in mesh.part_names},
        np.unique(faces["base"]),
        weighed("hub"),
        weighed("seat"),
    )


def assemble_tilt(scene: Scene, mesh: TiltMesh) -> Assembled:
    """Base fixed, six unit loads at the hub, no gearbox; the quantities are `QUANTITIES`."""
    bearing = scene.bearing_units[0].bearing
    n_dofs = mesh.points.size
    stiffness = {
        part: assemble(mesh.points, mesh.cells[cells], scene.material_of(part).lame, n_dofs)
        for part, cells in mesh.cells_of.items()
    }
    hub, seat = (
        constraints.averaged_point(name, *face, mesh.points, np.array([x, 0.0, 0.0]), n_dofs)
        for name, face, x in (
            ("hub", mesh.hub, scene.shaft.front),
            ("seat", mesh.seat, bearing.x),
        )
    )
    elimination = constraints.eliminate([constraints.fixed("base", mesh.base, n_dofs)], n_dofs)
    T = elimination.T

    def quantities(x: Floats) -> Floats:
        U = T @ x
        found = {}
        for plane in PLANES:
            u = U[:, plane.moment]
            energy = sum(
                u @ (stiffness[part] @ u) for part in (bearing.name, f"{bearing.name}.housing")
            )
            found[plane.name, "energy"] = 1.0 / energy
            found[plane.name, "averaged seat"] = 1.0 / (seat.motion @ u)[plane.moment]
        return np.array([found[key] for key in QUANTITIES])

    loads = np.asarray(T.T @ hub.motion.T.toarray())
    system = reduce(mesh.points, mesh.cells, sum(stiffness.values()), elimination)
    return Assembled(system, loads, quantities)


def tilt_outcomes(
    scene: Scene,
    sizes: MeshSizes,
    elements: tuple[str, ...],
    solves: list[Solve],
    repeats: int = REPEATS,
) -> Iterator[Outcome]:
    """Mesh once, then K_R by each element and each way to solve.

    Parameters
    ----------
    scene : Scene
        The bonded main bearing without gearbox stiffness.
    """
    scene = scene.model_copy(update={"mesh": sizes})
    bearing = scene.bearing_units[0].bearing.name
    mesh, meshing = timed(partial(mesh_scene, scene), repeats)
    for element in elements:
        made, converting = timed(partial(in_element, mesh, bearing, element), repeats)
        assembled, assembling = timed(partial(assemble_tilt, scene, made), repeats)
        both = Times(tuple(seconds + converting.median for seconds in meshing.seconds))
        steps = both, assembling
        yield from solved(element, sizes_in_words(sizes), assembled, steps, solves, repeats)


def ten_unit_loads(scene: Scene, sizes: MeshSizes) -> Outcome:
    """K_R as users get it: mesh, model, response to all ten unit loads.

    Assembly includes what the response does beside its solution: the constraints' elimination,
    reactions, energies, checks.
    """
    scene = scene.model_copy(update={"mesh": sizes})
    times = [time.perf_counter()]
    mesh = mesh_scene(scene)
    times.append(time.perf_counter())
    model = build_model(scene, mesh)
    response = unit_load_response(model)
    times.append(time.perf_counter())
    bearing = scene.bearing_units[0].bearing.name
    found = {
        (plane, kind): value
        for plane, values in tilt_by_plane(model, response, bearing).items()
        for kind, value in values.items()
    }
    meshing, rest = np.diff(times)
    seconds = dict.fromkeys(STEPS, 0.0)
    seconds |= {
        "mesh": meshing,
        "assembly": rest - response.diagnostics.seconds,
        "solve": response.diagnostics.seconds,
    }
    return Outcome(
        element=CURVED,
        mesh=sizes_in_words(sizes),
        solve=Solve("auto"),
        used=response.diagnostics.method,
        unknowns=response.diagnostics.n_unknowns,
        iterations=0,
        bytes=0,
        times={step: Times((float(s),)) for step, s in seconds.items()},
        values=np.array([found[key] for key in QUANTITIES]),
    )
