"""The finite-element model of a scene: operators of its parts, constraints, springs, unit loads."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.elasticity.interfaces.constraints import Constraint, ReferencePoint
from fe_drivetrain.elasticity.interfaces.mechanisms import (
    refuse_mechanisms,
    warn_of_weak_restraints,
)
from fe_drivetrain.elasticity.mesh.cached import cached_mesh
from fe_drivetrain.elasticity.mesh.checks import refuse_unsound
from fe_drivetrain.elasticity.mesh.facets import volume_weights
from fe_drivetrain.elasticity.mesh.mesh import Mesh
from fe_drivetrain.elasticity.mesh.side_by_side import beside, renamed
from fe_drivetrain.elasticity.operator.elasticity import Pattern
from fe_drivetrain.elasticity.operator.incompressible import (
    assemble_materials,
    assemble_unlocked,
    warn_of_averaging,
)
from fe_drivetrain.foreign.assembly import mesh_parts
from fe_drivetrain.foreign.further_parts import open_sides, tie_faces
from fe_drivetrain.geometry import Band
from fe_drivetrain.shafts.response.conditions import Conditions, needed_faces

#: The unit loads of every scene, the first columns of every response: hub forces [N] and moments
#: [N m], a uniform acceleration [m/s^2] along each axis, 1 N of gearbox weight (along -z).
LOADS = (
    *(f"hub.{c}" for c in FORCES),
    "gravity.x",
    "gravity.y",
    "gravity.z",
    "gearbox.weight",
)


def scene_loads(scene: Scene) -> tuple[str, ...]:
    """Names of all unit loads of a scene, in the order of the columns of its responses.

    Those of `LOADS` come first, then forces [N] and moments [N m] at each of its load points.
    """
    return (*LOADS, *(f"{point.name}.{c}" for point in scene.load_points for c in FORCES))


@dataclass(frozen=True, eq=False)
class Model:
    """A scene's finite-element model, before it is solved.

    Attributes
    ----------
    scene, mesh : Scene, Mesh
        What it was built from.
    part_stiffness : Mapping[str, sparse.bsr_array]
        (n_dofs, n_dofs) stiffness of each part alone [N/m].
    part_mass : Mapping[str, Floats]
        (n_nodes,) integrals of density times shape function of each part [kg].
    points : Mapping[str, ReferencePoint]
        Reference points by name: "hub", "gearbox", "NAME.seat" for each bearing, the load points by
        their names; where there are
        such, "NAME.base" (on a bedplate that gives), "NAME.bolt K" (bolts as beams, to ground),
        "NAME.foot K" (patches of a clamped foot that are pressed) or
        "NAME.ground" (of a housing that is a stiffness alone),
        "NAME.joint" or "NAME.roller K", whose
        motion is that of the bearing against its housing, or of the shaft against its nose; and
        "nose.root", the nose's rear face.
    constraints : tuple[Constraint, ...]
        All interfaces, couplings and supports.
    springs : tuple[tuple[ReferencePoint, Floats], ...]
        Reference points with their (6, 6) stiffness.
    held : Mapping[str, Sequence[int]]
        Motions (0-2 displacements, 3-5 rotations) of reference points that are rigidly held; their
        constraint is "NAME reaction".
    n_dofs : int
        Three a node, and six for each rigid reference point.
    warnings : tuple[str, ...]
        Sentences for the user, about motions that soft springs hardly restrain, and parts that are
        nearly incompressible.
    """

    scene: Scene
    mesh: Mesh
    part_stiffness: Mapping[str, sparse.bsr_array]
    part_mass: Mapping[str, Floats]
    points: Mapping[str, ReferencePoint]
    constraints: tuple[Constraint, ...]
    springs: tuple[tuple[ReferencePoint, Floats], ...]
    held: Mapping[str, Sequence[int]]
    n_dofs: int
    warnings: tuple[str, ...] = ()

    __repr__ = short_repr

    def standing(self, name: str) -> list[str]:
        """Reference points that a bearing's housing stands on: a bedplate, bolts, or a foot."""
        given = (f"{name}.base", f"{name}.ground")
        kinds = (f"{name}.bolt ", f"{name}.foot ")
        return [p for p in self.points if p in given or p.startswith(kinds)]

    @property
    def loads(self) -> tuple[str, ...]:
        """Names of its unit loads, see `scene_loads`."""
        return scene_loads(self.scene)

    @property
    def stiffness(self) -> sparse.bsr_array:
        """Stiffness of all parts and springs, before any constraint [N/m]."""
        return self.assembled()

    def assembled(self, pattern: Pattern | None = None) -> sparse.bsr_array:
        """Stiffness of all parts and springs, before any constraint [N/m].

        Parameters
        ----------
        pattern : Pattern or None
            Pattern of its elements, where it is known: of a mesh that was moved it is the same.
        """
        springs: sparse.bsr_array | None = None
        for point, k in self.springs:
            spring = (point.motion.T @ sparse.csr_array(k) @ point.motion).tobsr((3, 3))
            springs = spring if springs is None else springs + spring
        if isinstance(self.part_stiffness, PartStiffness):
            return self.part_stiffness.together(springs, pattern)
        total = sum(self.part_stiffness.values())
        return total if springs is None else total + springs

    @property
    def mass(self) -> Floats:
        """(n_nodes,) integrals of density times shape function over all parts [kg]."""
        return np.asarray(np.sum(list(self.part_mass.values()), axis=0))

    def unit_loads(self) -> Floats:
        """(n_dofs, n_loads): the loads of `scene_loads`, one a column."""
        F = np.zeros((self.n_dofs, len(self.loads)))
        F[:, :6] = self.points["hub"].motion.T.toarray()
        mass = self.mass
        for axis in range(3):
            F[axis : 3 * len(mass) : 3, 6 + axis] = mass
        F[:, 9] = -self.points["gearbox"].motion[[2]].toarray()[0]
        for k, point in enumerate(self.scene.load_points):
            first = len(LOADS) + 6 * k
            F[:, first : first + 6] = self.points[point.name].motion.T.toarray()
        return F

    def part_loads(self, part: str) -> Floats:
        """(n_dofs, n_loads): the share of `unit_loads` that acts inside one part (its gravity)."""
        F = np.zeros((self.n_dofs, len(self.loads)))
        mass = self.part_mass[part]
        for axis in range(3):
            F[axis : 3 * len(mass) : 3, 6 + axis] = mass
        return F


class PartStiffness(Mapping[str, sparse.bsr_array]):
    """Stiffness by part, assembled when it is first asked for: a kept solution needs none."""

    def __init__(self, scene: Scene, mesh: Mesh, n_dofs: int) -> None:
        self._scene, self._mesh, self._n_dofs = scene, mesh, n_dofs
        self._known: dict[str, sparse.bsr_array] = {}

    def __getitem__(self, part: str) -> sparse.bsr_array:
        if part not in self._known:
            mesh = self._mesh
            cells = mesh.cells[mesh.part_cells(part)]
            lame = self._scene.material_of(part).lame
            self._known[part] = assemble_unlocked(mesh.points, cells, lame, self._n_dofs)
        return self._known[part]

    def together(
        self, springs: sparse.bsr_array | None = None, pattern: Pattern | None = None
    ) -> sparse.bsr_array:
        """Stiffness of all parts and of springs [N/m], assembled in one: a sum takes longer."""
        mesh = self._mesh
        materials = [
            (mesh.part == number, self._scene.material_of(part).lame)
            for number, part in enumerate(mesh.part_names)
        ]
        return assemble_materials(
            mesh.points, mesh.cells, materials, self._n_dofs, springs, pattern
        )

    def __iter__(self) -> Iterator[str]:
        return iter(self._mesh.part_names)

    def __len__(self) -> int:
        return len(self._mesh.part_names)


def mesh_scene(scene: Scene, cache: Cache | None = None) -> Mesh:
    """Build and mesh the parts of a scene; bonded bearings share nodes with their housings.

    Housings from files have meshes of their own, and bonded bearings are tied to them.

    A mesh that was generated before comes from the cache, see `fe_drivetrain.common.cache`.

    Parameters
    ----------
    scene : Scene
        The scene.
    cache : Cache or None
        Cache of meshes; the user's if not given.

    Raises
    ------
    InputError
        A mesh size is too large for a wall, or the file of a housing has a fault.
    """
    mesh = mesh_parts(scene.shaft, scene.bearing_units, scene.mesh, scene.seats, cache)
    if scene.nose is None:
        return mesh
    bands = {b.name: Band(*b.span) for b in scene.nose_bearings}
    try:
        nose = cached_mesh(scene.nose.body, [], {}, scene.mesh, frozenset(), cache, bands)
    except InputError as error:
        raise InputError(f"nose, which is meshed as a shaft: {error}") from error
    return beside(mesh, renamed(nose, "shaft", "nose"))


def build_model(scene: Scene, mesh: Mesh, checked: bool = False) -> Model:
    """Assemble all parts of a scene and state its constraints.

    Parameters
    ----------
    scene, mesh : Scene, Mesh
        The scene and its mesh.
    checked : bool
        Whether the mesh is known to be sound, as one is that was moved from a sound one.

    Raises
    ------
    InputError
        The mesh has a fault, see `elasticity.mesh.checks`; or the scene is a mechanism, exactly
        or within round-off; the message names the part and its place or motion.
    """
    units = scene.bearing_units
    apart = [u.bearing.name for u in units if u.interface != "bonded" or u.foreign is not None]
    ties = [pair for unit in units for pair in tie_faces(unit)]
    if not checked:
        refuse_unsound(mesh, needed_faces(scene), [*apart, *ties, *open_sides(units)])
    n = len(mesh.points)
    stated = Conditions(scene, mesh)
    stated.shaft()
    for unit in units:
        stated.unit(unit)
    stated.nose()
    stated.stand("gearbox", scene.gearbox.stiffness)
    mesh, conditions, springs = stated.mesh, stated.conditions, stated.springs

    refuse_mechanisms(mesh, conditions, springs)
    moduli = {part: scene.material_of(part).youngs_modulus for part in mesh.part_names}
    warnings = warn_of_weak_restraints(mesh, conditions, springs, moduli)

    part_mass = {}
    for part in mesh.part_names:
        material = scene.material_of(part)
        cells = mesh.cells[mesh.part_cells(part)]
        warnings += warn_of_averaging(part, material.lame)
        part_mass[part] = material.density * volume_weights(mesh.points, cells, n)
    return Model(
        scene,
        mesh,
        PartStiffness(scene, mesh, stated.n_dofs),
        part_mass,
        stated.points,
        tuple(conditions),
        tuple(springs),
        stated.held,
        stated.n_dofs,
        warnings,
    )
