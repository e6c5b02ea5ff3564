"""The one gate of scenes: all that can be known of a scene from its values, whoever made it.

Every `Scene` passes it as it is made, from a file, from changes or in Python: so what one command
takes no other refuses for these reasons. What only a CAD model or a file that a scene names can say
comes later: `fe_drivetrain.foreign` and `fe_drivetrain.elasticity.mesh`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Protocol

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.bearing_unit import SPHERICAL_JOINTS, BearingUnit, Springs
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers
from fe_drivetrain.drivetrain_file.materials import Material, check_material
from fe_drivetrain.drivetrain_file.nose import Nose, NoseBearing
from fe_drivetrain.drivetrain_file.shared_parts import check_shared
from fe_drivetrain.drivetrain_file.standing import check_standing
from fe_drivetrain.geometry import (
    WIDEST,
    Band,
    ForeignFile,
    Housing,
    MeshSizes,
    Shaft,
    check_bands,
    check_counts,
    check_parts,
    check_sizes,
    refuse_millimetres,
    refuse_oversize,
)

#: Names that load points cannot have: loads and points of every scene.
_RESERVED = ("hub", "gearbox", "gravity", "shaft", "nose")

#: Farthest point that hub loads are about from the front face, in lengths of the shaft: the rotor's
#: centre is ahead of it by less than one, the tower's axis behind it by up to five (12 m in the
#: IEA 15 MW turbine, whose shaft is 2.4 m long). Beyond it a force's moment is of another machine.
FARTHEST = 5.0


class Described(Protocol):
    """The parts of a scene; see `fe_drivetrain.drivetrain_file.Scene`, which is one."""

    @property
    def shaft(self) -> Shaft: ...
    @property
    def bearing_units(self) -> Sequence[BearingUnit]: ...
    @property
    def nose(self) -> Nose | None: ...
    @property
    def nose_bearings(self) -> Sequence[NoseBearing]: ...
    @property
    def materials(self) -> Mapping[str, Material]: ...
    @property
    def mesh(self) -> MeshSizes: ...
    @property
    def bearing_names(self) -> Sequence[str]: ...
    @property
    def blocks(self) -> Mapping[str, Housing]: ...
    @property
    def seats(self) -> Mapping[str, Band]: ...
    @property
    def loads_at(self) -> float: ...
    def material_of(self, part: str) -> Material: ...


def check_scene(scene: Described, gearbox: Springs, load_points: Sequence[str]) -> None:
    """Refuse a scene whose values cannot be those of a drivetrain.

    Its parts have names and materials that are known, fit together, are of a plausible size, can be
    meshed with the sizes given, and are held.

    Parameters
    ----------
    scene : Described
        Each value of it is within its own range.
    gearbox : Springs
        At the gearbox [N/m, N m/rad].
    load_points : Sequence[str]
        Names of the points where further loads enter.

    Raises
    ------
    InputError, ValueError
    """
    _check_names(scene.bearing_names, load_points)
    _check_materials(scene)
    bearings = [unit.bearing for unit in scene.bearing_units]
    bores = check_parts(scene.shaft, bearings, scene.blocks)
    refuse_oversize(scene.shaft, bearings, scene.blocks)
    if scene.nose is not None:
        _check_nose(scene.nose)
        scene.nose.check_fits(scene.shaft)
        for unit in scene.bearing_units:
            if unit.bearing.name in scene.blocks:
                unit.block.check_clear(unit.bearing, scene.nose.body, "nose")
    check_shared(scene.bearing_units)
    check_bands(scene.shaft, scene.seats, bearings)
    _check_hub(scene)
    modulus = scene.material_of("shaft").youngs_modulus
    springs = as_numbers(gearbox)
    check_standing(scene.shaft, scene.bearing_units, springs, modulus, scene.nose_bearings)
    _check_mesh(scene, bores)


def check_files(units: Sequence[BearingUnit]) -> None:
    """Refuse parts whose files are not there, whether a model level asks for them or not.

    Parameters
    ----------
    units : Sequence[BearingUnit]
        Bearing units of a scene read from a file; the names of their files lead somewhere.

    Raises
    ------
    InputError
    """
    for unit in units:
        for part, solid in unit.housing_parts.items():
            if isinstance(solid, ForeignFile) and not Path(solid.file).is_file():
                there = "it is no file" if Path(solid.file).exists() else "there is no such file"
                raise InputError(
                    f"{part}: cannot read {solid.file}: {there}: give a STEP or mesh file"
                )


def _check_names(names: Sequence[str], load_points: Sequence[str]) -> None:
    if not names:
        raise ValueError("there is no bearing: give bearing_units, or a nose with bearings")
    if set(names) & set(_RESERVED):
        raise ValueError(f"bearing names {names} must not be one of {', '.join(_RESERVED)}")
    if len(set(names)) < len(names):
        raise ValueError(f"bearing names {names} must differ from each other")
    taken = {*names, *_RESERVED}
    for point in load_points:
        if point in taken:
            raise ValueError(
                f"load point {point!r} has the name of another point of the scene "
                f"({', '.join(sorted(taken))}): rename it"
            )
        taken.add(point)


def _check_materials(scene: Described) -> None:
    used = [("shaft", scene.shaft.material)]
    for unit in scene.bearing_units:
        used.append((unit.bearing.name, unit.bearing.material))
        used += [(part, solid.material) for part, solid in unit.housing_parts.items()]
        if unit.interface in SPHERICAL_JOINTS and unit.bearing.kind != "spherical":
            raise ValueError(
                f"bearing {unit.bearing.name!r} of kind {unit.bearing.kind!r} cannot have the "
                f"spherical-joint interface {unit.interface!r}: make its kind 'spherical' or "
                "its interface 'bonded', 'spring' or 'rollers'"
            )
    if scene.nose is not None:
        used.append(("nose", scene.nose.body.material))
    for part, material in used:
        check_material(material, scene.materials, f" of {part}")


def _check_nose(nose: Nose) -> None:
    widest = 2 * max(map(nose.body.outer_radius, nose.body.stations))
    refuse_millimetres("nose", nose.body.length, widest, WIDEST)


def _check_hub(scene: Described) -> None:
    """Refuse hub loads about a point that is on no machine with such a shaft."""
    front, reach = scene.shaft.front, FARTHEST * scene.shaft.length
    if abs(scene.loads_at - front) > reach:
        raise InputError(
            f"hub.loads_at is {scene.loads_at:g} m but must be from {front - reach:g} to "
            f"{front + reach:g} m, at most {FARTHEST:g} lengths of the shaft from its front "
            f"face at {front:g} m: give x of the point that your hub loads are about, in m, or "
            "leave it out where that is the front face"
        )


def _check_mesh(scene: Described, bores: dict[str, float]) -> None:
    """Refuse mesh sizes that no sound mesh has, or that make too many elements."""
    bearings = [unit.bearing for unit in scene.bearing_units]
    check_sizes(scene.shaft, bearings, scene.blocks, bores, scene.mesh)
    check_counts(scene.shaft, bearings, scene.blocks, bores, scene.mesh, scene.seats)
    if scene.nose is not None:
        bands = {b.name: Band(*b.span) for b in scene.nose_bearings}
        try:
            check_sizes(scene.nose.body, [], {}, {}, scene.mesh)
            check_counts(scene.nose.body, [], {}, {}, scene.mesh, bands)
        except InputError as error:
            raise InputError(f"nose, which is meshed as a shaft: {error}") from error
