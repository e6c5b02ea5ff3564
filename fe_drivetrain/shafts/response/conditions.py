"""Constraints, reference points and springs of a scene, stated part by part on its mesh."""

from collections.abc import Sequence

import numpy as np

from fe_drivetrain.common.arrays import Floats, Ints
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit, Springs
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.interfaces.constraints import Constraint, ReferencePoint
from fe_drivetrain.elasticity.interfaces.joints import (
    SECTORS,
    Joint,
    condensed_joint,
    nose_joint,
    roller_joint,
    spring_joint,
)
from fe_drivetrain.elasticity.mesh.facets import MEANS, face_weights
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.foreign.assembly import base_centre, bolt_springs, tied
from fe_drivetrain.foreign.further_parts import tie_faces
from fe_drivetrain.shafts.response.foot_contact import foot_holds, is_clamped

_N_GROUPS = 32  # near the square root of the number of nodes on a joint: least fill


def _further_dofs(scene: Scene) -> dict[str, int]:
    """Number of degrees of freedom beside the nodes' own, of each point or joint that has some."""
    extra: dict[str, int] = {}
    for name, coupling in (("hub", scene.hub.coupling), ("gearbox", scene.gearbox.coupling)):
        if coupling == "rigid":
            extra[name] = 6
    for unit in scene.bearing_units:
        name = unit.bearing.name
        if unit.condensed is not None:
            extra[f"{name}.ground"] = 6 * SECTORS
        elif unit.interface == "rigid":
            extra |= {f"{name}.outer": 6, f"{name}.housing.bore": 6}
        elif unit.interface == "averaged":
            extra[f"{name} joint"] = 3 * _N_GROUPS
        elif unit.interface == "spring" and unit.condensed is None:
            extra[f"{name}.joint"] = 6 * SECTORS
        if unit.bedplate is not None:
            extra[f"{name}.base"] = 6
    return extra | {f"{bearing.name}.joint": 6 * SECTORS for bearing in scene.nose_bearings}


class Conditions:
    """Reference points, constraints and springs of a scene, as they are stated part by part.

    Parameters
    ----------
    scene, mesh : Scene, Mesh
        The scene, and the mesh of its parts.

    Attributes
    ----------
    mesh : Mesh
        The mesh; nodes of faces that are tied are where the tie sees the other part.
    conditions : list[Constraint]
        All that were stated so far.
    points : dict[str, ReferencePoint]
        Reference points by name.
    springs : list[tuple[ReferencePoint, Floats]]
        Reference points with their (6, 6) stiffness.
    held : dict[str, Sequence[int]]
        Motions of reference points that are rigidly held.
    n_dofs : int
        Number of degrees of freedom: three a node, and those of points and joints.
    """

    def __init__(self, scene: Scene, mesh: Mesh) -> None:
        n, extra = len(mesh.points), _further_dofs(scene)
        ends = 3 * n + np.cumsum([0, *extra.values()])
        self._first_dof = dict(zip(extra, ends[:-1].tolist(), strict=True))
        self.n_dofs = int(ends[-1])
        together = tied(scene.bearing_units, mesh)
        self._scene, self._n, self.mesh = scene, n, together.mesh
        self.conditions = together.conditions(self.n_dofs)
        self.points: dict[str, ReferencePoint] = {}
        self.springs: list[tuple[ReferencePoint, Floats]] = []
        self.held: dict[str, Sequence[int]] = {}

    def shaft(self) -> None:
        """The ends of the shaft and the points at which further loads act."""
        shaft = self._scene.shaft
        self._point("hub", "shaft.front", shaft.front)
        self._point("gearbox", "shaft.rear", shaft.rear)
        for point in self._scene.load_points:
            self._point(point.name, f"shaft.band.{point.name}", point.x)

    def unit(self, unit: BearingUnit) -> None:
        """A bearing's seat and joint, and what its housing stands on.

        Parameters
        ----------
        unit : BearingUnit
            The bearing with its housing.
        """
        name = unit.bearing.name
        self._point(f"{name}.seat", f"shaft.seat.{name}", unit.bearing.x)
        if unit.condensed is not None:
            self._joined(
                condensed_joint(unit, self.mesh, self._first_dof[f"{name}.ground"], self.n_dofs)
            )
            return
        self._interface(unit)
        self._base(unit)

    def nose(self) -> None:
        """The bearings on a nose, and the nose's root."""
        scene = self._scene
        for bearing in scene.nose_bearings:
            name = bearing.name
            self._point(f"{name}.seat", f"shaft.band.{name}", bearing.x)
            first = self._first_dof[f"{name}.joint"]
            shares, between = nose_joint(bearing, self.mesh, first, self.n_dofs)
            self.conditions.append(shares)
            self.points[between.name] = between
            self.stand(between.name, bearing.stiffness)
        if scene.nose is not None:
            self._point("nose.root", "nose.rear", scene.nose.body.rear)
            self.stand("nose.root", ("rigid",) * 6)

    def stand(self, name: str, stiffness: Springs) -> None:
        """Put a reference point on the ground, or hold a relative motion.

        Parameters
        ----------
        name : str
            Name of the reference point.
        stiffness : Springs
            Stiffness of its six motions [N/m, N m/rad], or "rigid".
        """
        point, numbers = self.points[name], as_numbers(stiffness)
        rigid = np.flatnonzero(np.isinf(numbers)).tolist()
        if rigid:
            self.conditions.append(constraints.held(f"{name} reaction", point, rigid))
            self.held[name] = rigid
        k = np.diag(np.where(np.isinf(numbers), 0.0, numbers))
        if k.any():
            self.springs.append((point, k))

    def _couple(self, name: str, face: str, position: Floats) -> ReferencePoint:
        mesh, n_dofs = self.mesh, self.n_dofs
        nodes = mesh.face_nodes(face)
        if name in self._first_dof:
            point = constraints.rigid_point(name, position, self._first_dof[name], n_dofs)
            self.conditions.append(constraints.rigid_face(name, nodes, mesh.points, point))
            return point
        weights = face_weights(mesh.points, mesh.faces[face], self._n, MEANS)[nodes]
        return constraints.averaged_point(name, nodes, weights, mesh.points, position, n_dofs)

    def _point(self, name: str, face: str, x: float) -> None:
        """A point on the axis that moves with a face."""
        self.points[name] = self._couple(name, face, np.array([x, 0.0, 0.0]))

    def _joined(self, joint: Joint) -> None:
        self.conditions += joint.constraints
        self.springs += joint.springs
        self.points |= {point.name: point for point, _ in joint.springs}

    def _interface(self, unit: BearingUnit) -> None:
        name, mesh, n_dofs = unit.bearing.name, self.mesh, self.n_dofs
        if unit.interface == "rigid":
            centre = np.array([unit.bearing.x, 0.0, 0.0])
            inner, outer = (
                self._couple(face, face, centre)
                for face in (f"{name}.outer", f"{name}.housing.bore")
            )
            self.conditions.append(constraints.equal_translations(f"{name} joint", inner, outer))
        elif unit.interface == "rollers":
            self._joined(roller_joint(unit, mesh, n_dofs))
        elif unit.interface == "spring":
            self._joined(spring_joint(unit, mesh, self._first_dof[f"{name}.joint"], n_dofs))
        elif unit.interface == "averaged" or (unit.interface == "sliding" and not unit.foreign):
            first = self._first_dof.get(f"{name} joint", 0)
            self.conditions.append(_spherical_joint(unit, mesh, first, n_dofs))

    def _base(self, unit: BearingUnit) -> None:
        name, mesh = unit.bearing.name, self.mesh
        base = f"{name}.housing.base"
        if bolts := bolt_springs(unit, mesh, self.n_dofs):
            self.springs += bolts
            self.points |= {point.name: point for point, _ in bolts}
            if is_clamped(unit):
                pressed, holds = foot_holds(self._scene, unit, mesh, self.n_dofs)
                self.conditions += holds
                self.points |= {point.name: point for point in pressed}
                self.held |= {point.name: (0, 1, 2) for point in pressed}
        elif base not in mesh.faces:
            return  # it stands on parts of another unit
        elif unit.bedplate is None:
            self.conditions.append(constraints.fixed(base, mesh.face_nodes(base), self.n_dofs))
        else:
            self.points[f"{name}.base"] = self._couple(
                f"{name}.base", base, base_centre(unit, mesh)
            )
            self.stand(f"{name}.base", unit.bedplate)


def stood_on(scene: Scene, name: str) -> list[str]:
    """Faces of a housing that parts of another unit are tied to, on which alone it stands.

    Parameters
    ----------
    scene, name : Scene, str
        The scene, and which bearing of it.
    """
    return [
        other
        for unit in scene.bearing_units
        for _, other in tie_faces(unit)
        if other.startswith(f"{name}.housing.tie ") and unit.bearing.name != name
    ]


def needed_faces(scene: Scene) -> list[str]:
    """Names of the faces of a mesh that the loads, supports and interfaces of a scene need."""
    names = ["shaft.front", "shaft.rear", *(f"shaft.band.{name}" for name in scene.seats)]
    if scene.nose is not None:
        names += ["nose.rear", *(f"nose.band.{bearing.name}" for bearing in scene.nose_bearings)]
    for unit in scene.bearing_units:
        name = unit.bearing.name
        names += [f"shaft.seat.{name}"]
        if unit.condensed is not None:
            names += [f"{name}.outer"]
            continue
        if name not in scene.guests:
            names += [f"{name}.housing.base"]
        if unit.interface != "bonded":
            names += [f"{name}.outer", f"{name}.housing.bore"]
    return names


def joint_pairs(mesh: Mesh, bearing: str) -> tuple[Ints, Ints]:
    """Nodes of the two sides of a spherical joint, pairwise at the same place.

    Returns
    -------
    inner, outer
        (n,) nodes on the bearing and on the housing.

    Raises
    ------
    InputError
        The two faces do not match.
    """
    from scipy.spatial import cKDTree

    inner = mesh.face_nodes(f"{bearing}.outer")
    outer = mesh.face_nodes(f"{bearing}.housing.bore")
    distance, partner = cKDTree(mesh.points[outer]).query(mesh.points[inner])
    if len(inner) != len(outer) or distance.max(initial=0.0) > 1e-9:
        raise InputError(
            f"the joint of {bearing!r} has {len(inner)} nodes on the bearing and {len(outer)} on "
            f"the housing, up to {distance.max(initial=0.0):.3g} m apart: mesh both sides equally"
        )
    return inner, outer[partner]


def _spherical_joint(unit: BearingUnit, mesh: Mesh, first_dof: int, n_dofs: int) -> Constraint:
    name = unit.bearing.name
    label = f"{name} joint"
    points = mesh.points
    centre = np.array([unit.bearing.x, 0.0, 0.0])
    if unit.interface == "sliding":
        inner, outer = joint_pairs(mesh, name)
        return constraints.sliding_sphere(label, inner, outer, points, centre, n_dofs)
    inner, outer = (mesh.face_nodes(face) for face in (f"{name}.outer", f"{name}.housing.bore"))
    inner_weights, outer_weights = (
        constraints.centred_weights(
            face_weights(points, mesh.faces[face], len(points), MEANS)[nodes], points[nodes], centre
        )
        for face, nodes in ((f"{name}.outer", inner), (f"{name}.housing.bore", outer))
    )
    # Neighbours round the shaft form a group, both sides together.
    nodes = np.concatenate([inner, outer])
    angle = np.arctan2(points[nodes, 2], points[nodes, 1])
    groups = np.floor((angle + np.pi) / (2.0 * np.pi) * _N_GROUPS).astype(np.int64) % _N_GROUPS
    return constraints.averaged_sphere(
        label, inner, outer, inner_weights, outer_weights, groups, first_dof, n_dofs
    )
