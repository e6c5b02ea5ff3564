"""The shaft of a scene condensed to its hub, seats and gearbox: as a beam, in its meridian, solid.

Three levels of the same thing, so that all else of a model can stay as it is.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.drivetrain_file.component import Attachment
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.mesh.cached import cached_mesh
from fe_drivetrain.elasticity.revolution import harmonics
from fe_drivetrain.elasticity.revolution.meridian_mesh import Meridian, meridian
from fe_drivetrain.elasticity.solve.condensation import Condensed, condense
from fe_drivetrain.elasticity.solve.coupled_solid import CondensedSolid, condensed_solid
from fe_drivetrain.geometry import LENGTH_TOLERANCE, Band, Shaft
from fe_drivetrain.shafts.beam.condensed import condensed_beam
from fe_drivetrain.shafts.beam.of_scene import beam_of_scene


def reference_points(scene: Scene) -> tuple[tuple[str, ...], Floats]:
    """Names and (n, 3) positions [m] of hub, bearings, load points and gearbox of a scene."""
    units = {unit.bearing.name: unit.bearing.x for unit in scene.bearing_units}
    loaded = {name: (band.low + band.high) / 2 for name, band in scene.seats.items()}
    stations = {"hub": scene.shaft.front, **units, **loaded, "gearbox": scene.shaft.rear}
    positions = np.zeros((len(stations), 3))
    positions[:, 0] = list(stations.values())
    return tuple(stations), positions


def ringed_shaft(scene: Scene) -> tuple[Shaft, frozenset[str]]:
    """The shaft with the rings of its bearings turned on it, and of which bearings.

    A ring belongs to the shaft where its joint is outside of it, at the housing, and where it is of
    the shaft's material; one that is bonded to the housing, or on rollers in it, belongs to that. A
    spherical ring becomes a cylinder of the same volume.
    """
    rings = {
        unit.bearing.name: unit.bearing
        for unit in scene.bearing_units
        if not unit.ring_on_housing
        and scene.material_of(unit.bearing.name) == scene.material_of("shaft")
    }
    shaft = scene.shaft.cut(end for ring in rings.values() for end in ring.span)
    start = shaft.front
    sections = []
    for section in shaft.sections:
        middle = start + section.length / 2
        under = [ring for ring in rings.values() if abs(middle - ring.x) < ring.width / 2]
        if under:
            width = under[0].width if under[0].kind == "spherical" else 0.0
            diameter = math.sqrt(under[0].raceway_diameter ** 2 - width**2 / 3)
            change = {"outer_diameter": diameter, "outer_diameter_end": diameter}
            section = section.model_copy(update=change)
        sections.append(section)
        start += section.length
    return shaft.model_copy(update={"sections": tuple(sections)}), frozenset(rings)


def beam_shaft(scene: Scene, shear: bool = True, rings: bool = True) -> Condensed:
    """The shaft as a Timoshenko beam.

    Parameters
    ----------
    scene : Scene
        The scene.
    shear : bool
        Whether shear deforms it.
    rings : bool
        Whether it has its rings, see `ringed_shaft`; to a beam they are wholly part of it, which is
        stiffer than a solid is.
    """
    names, positions = reference_points(scene)
    nothing = {unit.bearing.name: np.zeros(6) for unit in scene.bearing_units}
    if rings:
        scene = scene.model_copy(update={"shaft": ringed_shaft(scene)[0]})
    return condensed_beam(beam_of_scene(scene, nothing, shear), names, positions[:, 0])


def shaft_meridian(
    scene: Scene,
    size: float | None = None,
    order: int | None = None,
    rings: bool = True,
    layers: int | None = None,
    per_fillet: int = 6,
) -> tuple[Meridian, list[Ints]]:
    """The meridian of a scene's shaft, and its sides that each reference point moves with.

    For the arguments see `meridian_shaft`.
    """
    shaft = ringed_shaft(scene)[0] if rings else scene.shaft
    spans = [Band(*unit.bearing.span) for unit in scene.bearing_units]
    spans += scene.seats.values()
    ends = [end for span in spans for end in span[:2]]
    corners = [(x, _radius(shaft, span)) for span in spans for x in span[:2]]
    widest = max(max(p.outer_diameter, p.end_diameter) for p in shaft.pieces)
    # fillets take triangles, of which gmsh makes many where corners are sharp: 2 layers are 4e-4
    if layers is None:
        layers = 2 if any(p.fillet > 0 for p in shaft.pieces) else 4
    mesh = meridian(
        shaft.cut(ends),
        widest if size is None else size,
        order=order,
        layers=layers,
        per_fillet=per_fillet,
        corners=corners,
    )
    return mesh, _coupled_sides(mesh, shaft, spans)


def meridian_shaft(
    scene: Scene,
    size: float | None = None,
    order: int | None = None,
    rings: bool = True,
    layers: int | None = None,
    per_fillet: int = 6,
) -> Condensed:
    """The shaft in its meridian, exact elasticity of a body of revolution.

    Hub and gearbox move as the mean of the end faces, the bearings as that of their seats, or of
    the rings there, all without stiffening these (RBE3).

    Parameters
    ----------
    scene : Scene
        The scene; housings have no part in this.
    size : float or None
        Largest edge length [m]; the largest diameter where not given, for elements are of high
        order and graded to steps and to the ends of seats: stiffness is right to about 1e-3; see
        `fe_drivetrain.shafts.fidelity.shaft_bands` for the band of a shaft.
    order : int or None
        See `fe_drivetrain.elasticity.revolution.meridian_mesh.meridian`.
    rings : bool
        Whether it has its rings, see `ringed_shaft`.
    layers : int or None
        Number of layers of ever smaller elements at corners; 4 where not given, 2 with fillets.
    per_fillet : int
        See `fe_drivetrain.elasticity.revolution.meridian_mesh.meridian`.
    """
    names, positions = reference_points(scene)
    material = scene.material_of("shaft")
    mesh, sides = shaft_meridian(scene, size, order, rings, layers, per_fillet)
    mass = harmonic_mass(mesh, material.density, 0)
    axial = _harmonic(mesh, material, 0, (0, 3), names, positions, sides, mass)
    mass = mass * (harmonics.turn(1) / harmonics.turn(0))
    sideways = _harmonic(mesh, material, 1, (1, 5), names, positions, sides, mass)
    n = len(names)
    # along z and about y as along y and about z, but the rotation has the other sense
    along_y, along_z = (np.add.outer(6 * np.arange(n), rows).ravel() for rows in ([1, 5], [2, 4]))
    sense = np.tile([1.0, -1.0], n)
    matrices = []
    for first, second in ((axial.stiffness, sideways.stiffness), (axial.mass, sideways.mass)):
        both = np.asarray(first) + np.asarray(second)
        both[np.ix_(along_z, along_z)] = np.outer(sense, sense) * both[np.ix_(along_y, along_y)]
        matrices.append(both)
    gravity = axial.gravity + sideways.gravity
    gravity[along_z, 2] = sense * gravity[along_y, 1]
    return Condensed(names, positions, matrices[0], gravity, matrices[1])


def shaft_solid(scene: Scene, method: str = "auto") -> CondensedSolid:
    """The shaft with the rings of its bearings as a solid, in curved tetrahedra of second order.

    Hub and gearbox move as the mean of the end faces, the bearings as that of their outer faces.

    Parameters
    ----------
    scene : Scene
        The scene; the housings have no part in this.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.

    Returns
    -------
    CondensedSolid
        With its mesh, and what leads back to its nodes.
    """
    names, positions = reference_points(scene)
    bearings = [unit.bearing for unit in scene.bearing_units]
    mesh = cached_mesh(scene.shaft, bearings, {}, scene.mesh, frozenset(), bands=scene.seats)
    loaded = [f"shaft.band.{name}" for name in scene.seats]
    faces = ["shaft.front", *(f"{b.name}.outer" for b in bearings), *loaded, "shaft.rear"]
    attachments = [
        Attachment(name, face, position, "averaged")
        for name, face, position in zip(names, faces, positions, strict=True)
    ]
    materials = {part: scene.material_of(part) for part in mesh.part_names}
    return condensed_solid(mesh, materials, attachments, method)


def solid_shaft(scene: Scene, method: str = "auto") -> Condensed:
    """The solid shaft condensed to its reference points, see `shaft_solid`."""
    return shaft_solid(scene, method).body


def condensed_shaft(scene: Scene, level: int) -> Condensed:
    """The shaft at a level of the ladder: 1 beam, 2 meridian, 3 solid."""
    condensers: dict[int, Callable[[Scene], Condensed]] = {
        1: beam_shaft,
        2: meridian_shaft,
        3: solid_shaft,
    }
    return condensers[level](scene)


def _radius(shaft: Shaft, span: Band) -> float:
    """Radius of the face of a shaft that a bearing or a load is on."""
    middle = (span.low + span.high) / 2
    return shaft.inner_radius(middle) if span.inside else shaft.outer_radius(middle)


def _coupled_sides(mesh: Meridian, shaft: Shaft, spans: Sequence[Band]) -> list[Ints]:
    """Sides of the meridian that each reference point moves with."""

    def end(at: float) -> Ints:
        return mesh.sides(lambda x, r: np.abs(x - at) < LENGTH_TOLERANCE)

    def seat(span: Band) -> Ints:
        low, high, _ = span
        radius = _radius(shaft, span)
        return mesh.sides(
            lambda x, r: (
                (np.abs(r - radius) < LENGTH_TOLERANCE)
                & (x > low - LENGTH_TOLERANCE)
                & (x < high + LENGTH_TOLERANCE)
            )
        )

    return [end(shaft.front), *(seat(span) for span in spans), end(shaft.rear)]


def motion_traction(mesh: Meridian, n: int, sides: Ints, place: float, k: int) -> Floats:
    """Nodal forces of a traction as large as the k-th rigid motion about x = place."""
    return harmonics.surface_loads(
        mesh, n, sides, lambda at, _: harmonics.rigid_motions_at(at - [place, 0.0], n)[:, :, k]
    )


def _harmonic(
    mesh: Meridian,
    material: Material,
    n: int,
    kept: tuple[int, int],
    names: tuple[str, ...],
    positions: Floats,
    sides: list[Ints],
    mass: sparse.csr_array,
) -> Condensed:
    """The share of one harmonic with its mass matrix: components ``kept`` of each point."""
    x, r = mesh.nodes.T
    columns = []
    for place, where in zip(positions[:, 0], sides, strict=True):
        tractions = np.column_stack([motion_traction(mesh, n, where, place, k) for k in (0, 1)])
        here = harmonics.rigid_motions(mesh, n, place).T
        # scaled to do unit work on these motions, tractions take the face's mean one, as RBE3 does
        columns.append(tractions @ np.linalg.inv(here @ tractions))
    # loads are in balance: what is held only takes the rigid motions out
    ends = [int(np.lexsort((-r, sense * x))[0]) for sense in (1.0, -1.0)]
    held = {
        0: np.concatenate([harmonics.dofs(np.array(ends[:1]), c) for c in (0, 2)]),
        1: harmonics.dofs(np.array(ends), 1),
    }[n]
    solved = harmonics.harmonic_solver(mesh, material, n, held)
    rigid = harmonics.rigid_motions(mesh, n, positions[0, 0])
    return condense(names, positions, np.hstack(columns), mass, rigid, solved, kept)


def harmonic_mass(mesh: Meridian, density: float, n: int) -> sparse.csr_array:
    """(3 n_nodes, 3 n_nodes) mass matrix in harmonic n [kg]."""
    element = mesh.element
    nodes = mesh.nodes[mesh.cells]
    (xs, rs), (xt, rt) = np.moveaxis(element.gradients @ nodes[:, None], (2, 3), (0, 1))
    volume = (xs * rt - rs * xt) * element.weights * (nodes[..., 1] @ element.values.T)
    local = harmonics.turn(n) * density * (element.values.T @ (volume[..., None] * element.values))
    rows = np.broadcast_to(mesh.cells[:, :, None], local.shape).ravel()
    columns = np.broadcast_to(mesh.cells[:, None, :], local.shape).ravel()
    size = len(mesh.nodes)
    scalar = sparse.coo_array((local.ravel(), (rows, columns)), shape=(size, size)).tocsr()
    # the same of each component: every row three times, its columns three apart
    turned = scalar[np.repeat(np.arange(size), 3)]
    component = np.repeat(np.tile(np.arange(3), size), np.diff(turned.indptr))
    return sparse.csr_array(
        (turned.data, 3 * turned.indices + component, turned.indptr), shape=(3 * size, 3 * size)
    )
