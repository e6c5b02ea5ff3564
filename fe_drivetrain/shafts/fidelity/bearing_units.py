"""A bearing unit by itself, condensed to a spring between the shaft and the ground.

Joint, housing and bedplate are springs in series.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from scipy import sparse

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions, wrench_transport
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers, joint_stiffness
from fe_drivetrain.drivetrain_file.scene import Coupling, Scene
from fe_drivetrain.drivetrain_file.shared_parts import refuse_coupled
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.interfaces.joints import in_series, roller_joint
from fe_drivetrain.elasticity.operator.mass import mass_matrix
from fe_drivetrain.elasticity.solve.coupled_solid import (
    CoupledSolid,
    assembled_parts,
    coupled_solid,
    point_motions_of,
)
from fe_drivetrain.elasticity.solve.error_estimate import SAFETY, error_energies
from fe_drivetrain.foreign.assembly import Tied, base_centre, bolt_springs
from fe_drivetrain.shafts.fidelity.unit_faces import (
    attached,
    face_of,
    parts_left_out,
    without_shaft,
)
from fe_drivetrain.shafts.response.cached import solved_content
from fe_drivetrain.shafts.response.foot_contact import foot_holds, is_clamped
from fe_drivetrain.shafts.response.solved_arrays import kept_together

_FREE = 1e-9  # of the largest stiffness: rollers hold a motion by far more, or not at all

_COUPLINGS: tuple[Coupling, Coupling] = ("rigid", "averaged")


class UnitSolid(NamedTuple):
    """Bearing and housing without the shaft, assembled once for both ways to couple the face.

    Attributes
    ----------
    scene, name, with_ring : Scene, str, bool
        Whose, of which bearing, and whether with its ring.
    together, parts : Tied, list[str]
        Its mesh, and the parts in it that give.
    stiffness : sparse.bsr_array
        (3 n, 3 n) of the n nodes [N/m].
    """

    scene: Scene
    name: str
    with_ring: bool
    together: Tied
    parts: list[str]
    stiffness: sparse.bsr_array


def unit_stiffness(
    scene: Scene,
    name: str,
    coupling: Coupling = "averaged",
    method: str = "auto",
    ring: bool = True,
    cache: Cache | None = None,
    solids: dict[tuple[str, bool], UnitSolid] | None = None,
) -> Floats:
    """Stiffness of a bearing and its housing, solved without the shaft.

    A bonded bearing, and one on rollers, is solved with its ring and held at its bore; else the
    ring is part of the shaft, and the face is the housing's bore. The shaft keeps that face in
    shape, but not wholly: a face that moves on average (RBE3) is softer than that, and one that
    moves as a rigid body (RBE2) is stiffer. Where the joint itself says how its faces move, that
    holds.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Name of the bearing.
    coupling : Coupling
        Coupling of the face to its reference point.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.
    ring : bool
        Whether such a ring gives; else it is rigid, or part of a solid shaft, and the face is that
        of the housing, or of the rollers.
    cache : Cache or None
        Where it may come from, the same to the last bit; the user's if not given.
    solids : dict or None
        What is assembled of this scene and these sizes is put here, and taken from here, by bearing
        and whether with its ring: for the other coupling.

    Returns
    -------
    (6, 6) at the bearing's centre, of joint, housing and bedplate in series [N/m, N, N m/rad].
    """
    if (given := _given(scene, name)) is not None:
        return given
    with_ring, coupling = face_of(scene, name, ring, coupling)

    known = {} if solids is None else solids

    def solved() -> Iterator[Floats]:
        if (name, with_ring) not in known:
            known[name, with_ring] = _unit_solid(scene, name, with_ring)
        yield _solved_unit(known[name, with_ring], coupling, method).stiffness

    (found,) = _kept(scene, name, [_content(name, with_ring, coupling, method)], cache, solved)
    return found


def unit_stiffnesses(
    scene: Scene, name: str, method: str = "auto", cache: Cache | None = None
) -> dict[Coupling, Floats]:
    """`unit_stiffness` with each of the two couplings, on one mesh.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Name of the bearing.
    method : str
        Solver, see `fe_drivetrain.elasticity.solve.solvers.solve`.
    cache : Cache or None
        Where they may come from, the same to the last bit; the user's if not given.

    Returns
    -------
    dict[Coupling, Floats]
        (6, 6) with a face that is "rigid", and "averaged" [N/m, N, N m/rad].
    """
    if (given := _given(scene, name)) is not None:
        return {"rigid": given, "averaged": given}

    ways = [face_of(scene, name, True, coupling) for coupling in _COUPLINGS]

    def solved() -> Iterator[Floats]:
        unit = _unit_solid(scene, name, ways[0][0])
        stiff = _solved_unit(unit, ways[0][1], method).stiffness
        yield stiff
        yield stiff if ways[1] == ways[0] else _solved_unit(unit, ways[1][1], method).stiffness

    contents = [_content(name, *way, method) for way in ways]
    return dict(zip(_COUPLINGS, _kept(scene, name, contents, cache, solved), strict=True))


class UnitMatrices(NamedTuple):
    """A bearing unit at its bearing's centre, as what the shaft feels there.

    Attributes
    ----------
    stiffness : Floats
        (6, 6) to ground [N/m, N, N m/rad].
    mass : Floats
        (6, 6) [kg, kg m, kg m^2].
    """

    stiffness: Floats
    mass: Floats


def unit_matrices(
    scene: Scene,
    name: str,
    coupling: Coupling = "rigid",
    method: str = "auto",
    cache: Cache | None = None,
) -> UnitMatrices:
    """Stiffness and mass of a bearing and its housing, solved without the shaft.

    The solid follows the shaft as it does in statics, so that its mass is felt as U^T M U, with its
    displacements U for unit motions of the shaft (Guyan 1965, "Reduction of stiffness and mass
    matrices", AIAA Journal 3(2), 380). Frequencies are those of a model that is too stiff, and
    none is there in which the housing moves and the shaft does not.

    The mass is that of housing, further parts, and of a ring that is bonded to the housing or on
    rollers in it: other rings belong to the shaft, see
    `fe_drivetrain.shafts.fidelity.ringed_shaft`. What the joint leaves free the housing does not
    follow; springs of joint and bedplate have no mass.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Name of the bearing.
    coupling, method, cache : Coupling, str, Cache or None
        The same as for `unit_stiffness`.

    Raises
    ------
    InputError
        The housing is a stiffness alone.
    """
    if _given(scene, name) is not None:
        raise InputError(
            f"bearing {name!r} has a housing of a stiffness alone, which has no mass: give the "
            "housing as a solid, or leave its mass out"
        )
    with_ring, coupling = face_of(scene, name, True, coupling)

    def solved() -> Iterator[Floats]:
        of = _unit_solid(scene, name, with_ring)
        unit = _solved_unit(of, coupling, method)
        yield unit.stiffness
        yield _unit_mass(of, unit)

    contents = [
        _content(name, with_ring, coupling, method),
        {"mass of": name, "coupling": coupling, "method": method},
    ]
    return UnitMatrices(*_kept(scene, name, contents, cache, solved))


def banded_unit(scene: Scene, name: str) -> tuple[Floats, StiffnessBands]:
    """Stiffness of a bearing unit, its face held in shape, and its band.

    Two things are in the band. The face between shaft and housing keeps its shape, or moves on
    average only: where the joint itself says which, this leaves nothing open. The mesh makes the
    solid too stiff: that is estimated from recovered stresses, whatever the joint.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Name of the bearing.

    Returns
    -------
    Floats
        (6, 6), see `unit_stiffness` [N/m, N, N m/rad].
    StiffnessBands
        Half widths, of each kind of motion by itself.
    """
    soft, stiff, mesh = unit_bounds(scene, name)
    return stiff, StiffnessBands.of_difference(soft, stiff) + mesh


class UnitBounds(NamedTuple):
    """What is known of a bearing unit's stiffness.

    Attributes
    ----------
    soft, stiff : Floats
        (6, 6) with a face that moves on average, and one that keeps its shape; where the joint
        itself says how it moves, the same [N/m, N, N m/rad].
    mesh : StiffnessBands
        Band of the mesh, relative: by it both may be too stiff.
    """

    soft: Floats
    stiff: Floats
    mesh: StiffnessBands


def unit_bounds(
    scene: Scene, name: str, cache: Cache | None = None, *, of_springs: bool = False
) -> UnitBounds:
    """Stiffness of a bearing unit between its two bounds, and the band of its mesh.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Name of the bearing.
    cache : Cache or None
        Where they may come from, the same to the last bit; the user's if not given.
    of_springs : bool
        Whether the seat of a spring joint is between both bounds, too: such a joint holds its seat
        on average in solid models, and so leaves nothing open there, but rollers keep it in shape
        in part.

    Returns
    -------
    UnitBounds
        See there.
    """

    if (given := _given(scene, name)) is not None:
        return UnitBounds(given, given, StiffnessBands.uniform(0.0))

    ways = [face_of(scene, name, True, coupling) for coupling in _COUPLINGS]
    band: dict[str, Any] = {"mesh band of": name}
    if of_springs and scene.bearing_unit(name).interface == "spring":
        ways = [(with_ring, c) for (with_ring, _), c in zip(ways, _COUPLINGS, strict=True)]
        band["coupling"] = ways[0][1]

    def solved() -> Iterator[Floats]:
        unit = _unit_solid(scene, name, ways[0][0])
        stiff = _solved_unit(unit, ways[0][1], "auto")
        yield stiff.stiffness
        soft = stiff if ways[1] == ways[0] else _solved_unit(unit, ways[1][1], "auto")
        yield soft.stiffness
        yield _mesh_band(scene, stiff)

    contents = [_content(name, *way, "auto") for way in ways]
    stiff, soft, mesh = _kept(scene, name, [*contents, band], cache, solved)
    return UnitBounds(soft, stiff, StiffnessBands.of_motions(mesh))


def _given(scene: Scene, name: str) -> Floats | None:
    """A housing that is a stiffness alone, behind its joint; None of a solid one."""
    unit = scene.bearing_unit(name)
    refuse_coupled(scene.bearing_units, name)
    if unit.condensed is None:
        return None
    return in_series(unit.condensed.matrix, joint_stiffness(unit))


def _content(name: str, with_ring: bool, coupling: Coupling, method: str) -> dict[str, Any]:
    return {"stiffness of": name, "coupling": coupling, "method": method, "ring": with_ring}


def _kept(
    scene: Scene,
    name: str,
    contents: Sequence[Mapping[str, Any]],
    cache: Cache | None,
    solve: Callable[[], Iterator[Floats]],
) -> list[Floats]:
    """What was solved of a scene's bearing unit before, or, where one of it is missing, is now."""
    rooms = {"fe_drivetrain.shafts.fidelity": {"bearing_units.py"}}
    # of the shaft the seat alone, so that other lengths, bores and overhangs find what is kept
    depends = solved_content(scene) | {"shaft": scene.seat_diameter(name)}
    found = kept_together(
        scene, contents, rooms, lambda: ({"0": a} for a in solve()), cache, depends
    )
    return [arrays["0"] for arrays in found]


class _SolvedUnit(NamedTuple):
    """A unit's solid, its parts, displacements (n, 6) and motions (6, 6) for unit loads; stiffness.

    The stiffness (6, 6) is that of joint, solid and bedplate. For unit motions of the shaft, the
    solid's own point moves by ``strained`` (6, 6) against the base, and that by ``carried`` (6, 6).
    """

    solid: CoupledSolid
    parts: list[str]
    displacements: Floats
    compliance: Floats
    stiffness: Floats
    strained: Floats
    carried: Floats


def _unit_mass(of: UnitSolid, unit: _SolvedUnit) -> Floats:
    """(6, 6) mass of a solved unit as the shaft feels it."""
    mesh, n = unit.solid.mesh, unit.solid.mesh.points.size
    motions = unit.displacements[:n] @ np.linalg.solve(unit.compliance, unit.strained)
    described = of.scene.bearing_unit(of.name)
    if described.bedplate is not None:
        motions += rigid_motions(mesh.points, base_centre(described, mesh)) @ unit.carried
    found = np.zeros((6, 6))
    for part in unit.parts:
        density = of.scene.material_of(part).density
        mass = mass_matrix(mesh.points, mesh.cells[mesh.part_cells(part)], density, n)
        found += motions.T @ (mass @ motions)
    return 0.5 * (found + found.T)


def _mesh_band(scene: Scene, unit: _SolvedUnit) -> Floats:
    """(6,) bands of the mesh, relative: joint and bedplate in series only make its share less."""
    mesh = unit.solid.mesh
    parts = [(mesh.cells[mesh.part_cells(p)], scene.material_of(p).lame) for p in unit.parts]
    stiffness = np.linalg.inv(unit.compliance)
    motions = unit.displacements @ stiffness
    shares = error_energies(mesh.points, parts, motions) / (0.5 * stiffness.diagonal())
    return np.asarray(SAFETY * shares)


def _unit_solid(scene: Scene, name: str, with_ring: bool) -> UnitSolid:
    """A bearing unit's solid, with the ring where that gives."""
    together, parts = without_shaft(scene, {name: with_ring})
    materials = {part: scene.material_of(part) for part in parts}
    stiffness = assembled_parts(together.mesh, materials)
    return UnitSolid(scene, name, with_ring, together, parts, stiffness)


def _solved_unit(of: UnitSolid, coupling: Coupling, method: str) -> _SolvedUnit:
    """A bearing and its housing without the shaft, see `unit_stiffness`."""
    scene, name, with_ring, together, parts, assembled = of
    unit, mesh = scene.bearing_unit(name), together.mesh
    materials = {part: scene.material_of(part) for part in parts}
    at = attached(scene, name, with_ring, coupling)
    solid = coupled_solid(mesh, materials, [at], assembled)
    n_dofs = solid.n_dofs
    base = f"{name}.housing.base"
    held = [parts_left_out(solid, [at])]
    springs = bolt_springs(unit, mesh, n_dofs)
    if not springs:
        held.append(constraints.fixed(base, mesh.face_nodes(base), n_dofs))
    elif is_clamped(unit):
        held += foot_holds(scene, unit, mesh, n_dofs, method)[1]
    held += together.conditions(n_dofs)
    if unit.rollers is not None:
        free = _free_motions(joint_stiffness(unit), unit.bearing.raceway_diameter / 2)
        ground = free.T @ free
        springs += [*roller_joint(unit, mesh, n_dofs).springs, (solid.points[0], ground)]
    displacements, compliance = point_motions_of(solid, held, springs, method)
    stiffness = np.linalg.inv(compliance)
    if unit.rollers is not None:
        carried = np.eye(6) - np.linalg.pinv(free) @ free
        stiffness = np.asarray(carried.T @ (stiffness - ground) @ carried)
    strained, carried_along = np.eye(6), np.zeros((6, 6))
    if unit.bedplate is not None:
        # the base moves as a rigid body, so this is exact
        lever = wrench_transport(at.position - base_centre(unit, mesh)).T
        gives = np.diag(1.0 / as_numbers(unit.bedplate))
        softness = lever @ gives @ lever.T
        stiffness = np.linalg.solve(np.eye(6) + stiffness @ softness, stiffness)
        carried_along = gives @ lever.T @ stiffness
        strained -= lever @ carried_along
    stiffness = 0.5 * (stiffness + stiffness.T)
    if unit.rollers is None:
        behind = stiffness
        stiffness = in_series(behind, joint_stiffness(unit))
        follows = np.linalg.solve(behind, stiffness)
        strained, carried_along = strained @ follows, carried_along @ follows
    return _SolvedUnit(solid, parts, displacements, compliance, stiffness, strained, carried_along)


def _free_motions(stiffness: Floats, length: float) -> Floats:
    """(m, 6) rows that feel the motions alone that a stiffness leaves free, as stiff as it is."""
    size = np.repeat([1.0, length], 3)
    values, vectors = np.linalg.eigh(stiffness / np.outer(size, size))
    free = vectors[:, values < _FREE * values[-1]]
    return np.asarray(math.sqrt(values[-1]) * free.T * size)


def scene_supports(scene: Scene, housings: Mapping[str, Floats]) -> dict[str, Floats]:
    """Stiffness to ground (6, 6) of the points of a scene: its bearing units and its gearbox.

    Parameters
    ----------
    scene : Scene
        The scene; what its gearbox holds rigidly has inf on the diagonal.
    housings : Mapping[str, Floats]
        (6, 6) of each bearing unit by name, see `unit_stiffness`; rows of those that give together.
    """
    supports = {unit.bearing.name: housings[unit.bearing.name] for unit in scene.bearing_units}
    gearbox = as_numbers(scene.gearbox.stiffness)
    if gearbox.any():
        supports["gearbox"] = np.diag(gearbox)
    return supports
