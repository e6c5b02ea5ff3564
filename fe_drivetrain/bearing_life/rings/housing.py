"""The housing of a scene as the outer ring of a bearing: its compliance at the rollers.

The bore is the raceway. Each roller presses on a window of it: what its length meets along the
contact normals, and round the axis as far as its neighbours' places, falling off evenly. So wide, a
window leaves out the approach close to the contact, which is part of the contact's own law. On any
mesh, a load on a window has the resultant of the roller's, so that a ring that moves as a rigid
body moves its windows as rigid rings do.
"""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import asdict, dataclass

import numpy as np

from fe_drivetrain.bearing.geometry import Bearing, RollerRow, angles
from fe_drivetrain.bearing.races import Races
from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.shared_parts import refuse_coupled
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.mesh.facets import facet_points
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.operator.incompressible import assemble_unlocked
from fe_drivetrain.elasticity.solve.reduction import reduce
from fe_drivetrain.elasticity.solve.solid import Assembly
from fe_drivetrain.elasticity.solve.solvers import solve
from fe_drivetrain.foreign.assembly import base_centre, mesh_parts
from fe_drivetrain.shafts.response.solved_arrays import kept_arrays

#: Maximum radius of the bore over a row's pitch radius: above, it is another bearing's.
MAX_BORE = 1.25

MADE_BY: Mapping[str, Set[str] | None] = {
    "fe_drivetrain.bearing_life.rings": None,
    "fe_drivetrain.bearing": None,
}
"""Whose sources solutions at rollers depend on, see `kept_arrays`."""

_DEGREE = 8  # of the quadrature of a window, which is not smooth


@dataclass(frozen=True, eq=False)
class HousingSolid:
    """A housing without its shaft, and the places where the rollers of a bearing touch it.

    Attributes
    ----------
    mesh : Mesh
        Mesh of the housing; other parts of it have no stiffness.
    name : str
        Name of the bearing in its scene.
    contacts : Floats
        Nodal forces (3 n, 2 total) of a unit load along the contact normal, outwards, and of a unit
        moment of each roller; transposed, recession and lean.
    """

    mesh: Mesh
    name: str
    contacts: Floats

    __repr__ = short_repr


def housing_races(scene: Scene, name: str, bearing: Bearing, method: str = "auto") -> Races:
    """Compliance of a scene's housing under the rollers of a bearing; its inner ring is rigid.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Name of the bearing, one of the scene's, whose housing it is.
    bearing : Bearing
        Bearing with rows of rollers, about the same centre.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.

    Returns
    -------
    races : Races
        Compliance relative to the ground; the ring's rigid motion on its housing and bedplate is
        part of it.

    Raises
    ------
    InputError
        The bearing does not fit the bore.
    """
    content = {"housing races": name, "bearing": asdict(bearing), "method": method}
    kept = kept_arrays(
        scene,
        content,
        MADE_BY,
        lambda: {"compliance": _compliance(scene, name, bearing, method)},
    )
    return Races(bearing, kept["compliance"])


def _compliance(scene: Scene, name: str, bearing: Bearing, method: str) -> Floats:
    """(2 total, 2 total) of the housing at the rollers, bedplate included."""
    solid = housing_solid(scene, name, bearing)
    mesh, F = solid.mesh, solid.contacts
    part = f"{name}.housing"
    C = contact_compliance(mesh, part, scene.material_of(part), F, f"{part}.base", method)
    unit = scene.bearing_unit(name)
    if unit.bedplate is not None:
        # the base moves as a rigid body, so this is exact
        under = base_centre(unit, mesh)
        motions = F.T @ rigid_motions(mesh.points, under)
        C = C + motions @ np.diag(1.0 / as_numbers(unit.bedplate)) @ motions.T
    return C


def contact_compliance(
    mesh: Mesh,
    part: str,
    material: Material,
    contacts: Floats,
    fixed: str,
    method: str = "auto",
    assembly: Assembly = assemble_unlocked,
) -> Floats:
    """Compliance of a part that stands on a fixed face, at contacts.

    Parameters
    ----------
    mesh : Mesh
        The mesh; other parts of it are left out.
    part, material : str, Material
        Name of the part, and its material.
    contacts : Floats
        Nodal forces (3 n, m) of a unit load on each contact.
    fixed : str
        Name of the face that does not move.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.
    assembly : Assembly
        Assembly of the stiffness.

    Returns
    -------
    compliance : Floats
        Compliance (m, m).
    """
    n_dofs = len(contacts)
    cells = mesh.cells[mesh.part_cells(part)]
    K = assembly(mesh.points, cells, material.lame, n_dofs)
    left_out = np.setdiff1d(np.arange(len(mesh.points)), cells)
    held = [
        constraints.fixed("fixed", mesh.face_nodes(fixed), n_dofs),
        constraints.fixed("parts left out", left_out, n_dofs),
    ]
    elimination = constraints.eliminate(held, n_dofs)
    system = reduce(mesh.points, cells, K, elimination)
    u = elimination.T @ solve(system, elimination.T.T @ contacts, method).x
    C = contacts.T @ u
    return np.asarray(0.5 * (C + C.T))


def housing_solid(scene: Scene, name: str, bearing: Bearing) -> HousingSolid:
    """Mesh a scene's housing, and find where the rollers of a bearing touch its bore.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Name of the bearing, one of the scene's.
    bearing : Bearing
        Bearing with rows of rollers.

    Returns
    -------
    solid : HousingSolid
        Solid with the nodal forces of the rollers.

    Raises
    ------
    InputError
        The bearing does not fit the bore.
    """
    unit = scene.bearing_unit(name)
    seat = scene.seat_diameter(name)
    inner = unit.bearing.model_copy(update={"bore_diameter": seat})
    bolts = unit.foreign.bolts if unit.foreign is not None else None
    if bolts is not None and bolts.hold != "washers":
        raise InputError(
            f"{name}.housing stands on bolts as bodies (hold {bolts.hold!r}), but for rollers on "
            "its bore it must be fixed: hold 'washers'"
        )
    refuse_coupled(scene.bearing_units, name)
    if unit.parts:
        raise InputError(
            f"{name}.housing has further parts ({', '.join(p.name for p in unit.parts)}), but for "
            "rollers on its bore it must stand by itself: leave the parts out, or put them into "
            "one STEP file with the housing"
        )
    alone = unit.model_copy(update={"bearing": inner, "interface": "rigid"})
    mesh = mesh_parts(None, [alone], scene.mesh)
    contacts = contact_rows(mesh, f"{name}.housing.bore", unit.bearing.x, bearing)
    return HousingSolid(mesh, name, contacts)


def contact_rows(mesh: Mesh, face: str, centre: float, bearing: Bearing) -> Floats:
    """Nodal forces of unit loads and moments of rollers on a bore.

    Parameters
    ----------
    mesh : Mesh
        The mesh.
    face : str
        The bore, a cylinder or a sphere about the x axis.
    centre : float
        Axial place x of the bearing's centre [m].
    bearing : Bearing
        Bearing with rows of rollers.

    Returns
    -------
    contacts : Floats
        Nodal forces (3 n, 2 total): loads of all rollers along their contact normals, outwards,
        then moments, of loads that grow with x.

    Raises
    ------
    InputError
        A roller lies outside of the bore.
    """
    facets = mesh.faces[face]
    at = facet_points(mesh.points, facets, _DEGREE)
    x, y, z = np.moveaxis(at.positions, -1, 0)
    psi, radius = np.arctan2(z, -y), np.hypot(y, z)
    on_face = mesh.points[np.unique(facets)]
    low, high = on_face[:, 0].min(), on_face[:, 0].max()
    bore = float(np.hypot(on_face[:, 1], on_face[:, 2]).max())
    loads: list[Floats] = []
    moments: list[Floats] = []
    for number, row in enumerate(bearing.rows, 1):
        if not isinstance(row, RollerRow):
            raise InputError(f"row {number} of {bearing.name} has balls: give rows of rollers")
        sin, cos = np.sin(row.angle), np.cos(row.angle)
        # where the contact line of a roller meets the bore
        if not row.radius < bore < MAX_BORE * row.radius:
            raise InputError(
                f"{bearing.name} has a pitch diameter of {2e3 * row.radius:g} mm, but the bore of "
                f"its housing is {2e3 * bore:.6g} mm: give a bore larger than that by about "
                "the diameter of a roller, as raceway_diameter of the scene's bearing"
            )
        middle = centre + row.place + (bore - row.radius) * sin / cos
        if row.aligning and np.ptp(radius) > 1e-6 * bore:
            middle = centre + bore * sin  # on a sphere
        half = 0.5 * row.length / cos
        if middle - half < low - 1e-6 or middle + half > high + 1e-6:
            raise InputError(
                f"row {number} of {bearing.name} reaches from x = {middle - half:.4g} m to "
                f"{middle + half:.4g} m, beyond the bore from {low:.4g} m to {high:.4g} m: give "
                "the scene's bearing a larger width"
            )
        along = (x - middle) * cos
        on = (np.abs(x - middle) <= half) * at.areas
        pitch = 2.0 * np.pi / row.rollers
        for angle in angles(row):
            away = np.abs(np.angle(np.exp(1j * (psi - angle))))
            share = np.maximum(1.0 - away / pitch, 0.0) * on
            e_r = np.array([0.0, -np.cos(angle), np.sin(angle)])
            normal = cos * e_r + [sin, 0.0, 0.0]
            tangent = np.array([0.0, -np.sin(angle), -np.cos(angle)])
            place = (row.place + centre) * np.array([1.0, 0.0, 0.0]) + row.radius * e_r
            off = along - (share * along).sum() / share.sum()
            spread = np.zeros(len(mesh.points))
            np.add.at(spread, facets, share @ at.values**2)
            near = np.flatnonzero(spread)
            rigid = rigid_motions(mesh.points[near], place)
            weighted = np.repeat(spread[near], 3)[:, None] * rigid
            for found, weights, motion in (
                (loads, share / share.sum(), np.r_[normal, 0.0, 0.0, 0.0]),
                (moments, share * off / (share * off**2).sum(), np.r_[0.0, 0.0, 0.0, tangent]),
            ):
                nodal = np.zeros(len(mesh.points))
                np.add.at(nodal, facets, weights @ at.values)
                column = np.outer(nodal, normal)
                left = motion - rigid.T @ column[near].ravel()
                column[near] += (weighted @ np.linalg.solve(rigid.T @ weighted, left)).reshape(
                    -1, 3
                )
                found.append(column.ravel())
    return np.column_stack([*loads, *moments])
