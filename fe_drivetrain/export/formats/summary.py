"""Input of a drivetrain model from a scene, beside matrices at points, as one JSON file.

Stiffness of the shaft along and about its axis and in bending, K_R of each bearing unit in both
planes, the matrices from loads to reactions, and mass and inertia of each part.
"""

from __future__ import annotations

from pathlib import Path
from typing import Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.components import FORCES
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.files import atomic_path
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.export.formats.superelement_json import OriginFile, read_content
from fe_drivetrain.export.from_scene import scene_origin
from fe_drivetrain.export.superelement import FRAME, UNITS
from fe_drivetrain.export.unit_statement import stated_of_drivetrain
from fe_drivetrain.foreign.assembly import solids_of_unit
from fe_drivetrain.shafts.fidelity.bearing_units import UnitBounds, unit_bounds
from fe_drivetrain.shafts.fidelity.ladder import LevelModel, assembly_level, shaft_level
from fe_drivetrain.shafts.fidelity.quantities import shaft_numbers, unit_numbers
from fe_drivetrain.shafts.fidelity.shafts import meridian_shaft
from fe_drivetrain.shafts.response.model import scene_loads


class _File(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


class ShaftFile(_File):
    """Stiffness between hub and gearbox, the gearbox end held."""

    axial: float = Field(description="force over motion along x [N/m]")
    torsional: float = Field(description="torque over twist [N m/rad]")
    lateral: float = Field(description="force over deflection, free to turn [N/m]")
    bending: float = Field(description="moment over rotation, free to move [N m/rad]")


class UnitFile(_File):
    """A bearing with its housing, between bounds: its face moves on average, or keeps its shape.

    The lower one is less the band of the mesh, so that there is a range where the joint itself says
    how the face moves.
    """

    tilt: tuple[float, float] | None = Field(
        description="K_R about y, vertical plane [N m/rad]; null of a joint that carries no moment"
    )
    yaw: tuple[float, float] | None = Field(description="K_R about z, horizontal plane [N m/rad]")
    radial_y: tuple[float, float] = Field(description="[N/m]")
    radial_z: tuple[float, float] = Field(description="[N/m]")
    axial: tuple[float, float] = Field(description="[N/m]")


class PartFile(_File):
    """A rigid body."""

    mass: float = Field(description="[kg]")
    centre: tuple[float, float, float] = Field(description="[m]")
    inertia: list[list[float]] = Field(description="about the centre [kg m^2]")


class ReactionsFile(_File):
    """Loads to reactions."""

    level: str
    loads: list[str] = Field(description="columns: unit loads, 1 N, 1 N m, 1 m/s^2")
    components: list[str] = Field(description="rows: what the drivetrain puts on the support")
    matrices: dict[str, list[list[float]]] = Field(
        description="by support, moments about the bearing's centre, or the shaft's rear end"
    )


class SummaryFile(_File):
    """The content of a summary."""

    kind: Literal["drivetrain summary"] = "drivetrain summary"
    schema_version: Literal[1, 2] = 2
    bound: str = Field(
        default="",
        description="which bound of its bearing units the reactions are of; empty without such "
        "units, and in version 1",
    )
    rollers: str = Field(default="", description="whether rollers of bearing units give")
    frame: str = FRAME
    units: str = UNITS
    shaft: ShaftFile
    bearing_units: dict[str, UnitFile]
    reactions: ReactionsFile
    parts: dict[str, PartFile]
    origin: OriginFile


def summary(scene: Scene, level: int = 2) -> SummaryFile:
    """Condense a scene to the numbers of a drivetrain model.

    Parameters
    ----------
    scene : Scene
        The scene.
    level : int
        Level of the reactions: 1 to 3 with housings as springs, faces in shape, or 4. The shaft's
        stiffness is of the meridian, level 2.

    Raises
    ------
    InputError
        There is no such level.
    """
    if level not in (1, 2, 3, 4):
        raise InputError(f"level {level} of a summary is unknown: use 1, 2, 3 or 4")
    names = [unit.bearing.name for unit in scene.bearing_units]
    bounds = {name: unit_bounds(scene, name) for name in names}
    springs = {name: unit.stiff for name, unit in bounds.items()}
    meridian = meridian_shaft(scene)
    if level == 4:
        model = assembly_level(scene)
    else:
        model = shaft_level(scene, level, springs, meridian if level == 2 else None)
    bound, rollers = stated_of_drivetrain(scene, level)
    return SummaryFile(
        bound=bound,
        rollers=rollers,
        shaft=ShaftFile(**shaft_numbers(meridian)),
        bearing_units={name: _unit(unit) for name, unit in bounds.items()},
        reactions=_reactions(scene, model),
        parts=_parts(scene),
        origin=OriginFile(**vars(scene_origin(scene, f"{level} {model.title}", "see the scene"))),
    )


def write_summary(path: str | Path, content: SummaryFile) -> None:
    """Write a summary; the file appears whole or not at all."""
    with atomic_path(Path(path)) as unfinished:
        unfinished.write_text(content.model_dump_json(indent=1), encoding="utf-8")


def read_summary(path: str | Path) -> SummaryFile:
    """Read and validate a summary.

    Raises
    ------
    InputError
        The file is not of this schema.
    """
    return read_content(Path(path), SummaryFile, "drivetrain summary")


def _unit(bounds: UnitBounds) -> UnitFile:
    soft, stiff = unit_numbers(bounds.soft), unit_numbers(bounds.stiff)
    # a mesh makes the solid too stiff, never too soft
    found = {name: (soft[name] / (1.0 + bounds.mesh.largest), stiff[name]) for name in soft}
    tilt, yaw = (pair if any(pair) else None for pair in (found.pop("tilt"), found.pop("yaw")))
    return UnitFile(tilt=tilt, yaw=yaw, **found)


def _reactions(scene: Scene, model: LevelModel) -> ReactionsFile:
    return ReactionsFile(
        level=f"{model.level} {model.title}",
        loads=list(scene_loads(scene)),
        components=list(FORCES),
        matrices={name: matrix.tolist() for name, matrix in model.reaction_matrices.items()},
    )


def _parts(scene: Scene) -> dict[str, PartFile]:
    # the bare shaft: rings are parts of their own
    found = {"shaft": _body(np.asarray(_bare_inertia(scene)), scene.shaft.front)}
    for unit in scene.bearing_units:
        bore = scene.seat_diameter(unit.bearing.name)
        for part, solid in solids_of_unit(unit, bore, scene.mesh).items():
            density = scene.material_of(part).density
            found[part] = PartFile(
                mass=density * solid.volume,
                centre=solid.centre,
                inertia=(density * np.reshape(solid.inertia, (3, 3))).tolist(),
            )
    return found


def _bare_inertia(scene: Scene) -> Floats:
    body = meridian_shaft(scene, rings=False)
    motions = body.rigid_motions
    return np.asarray(motions.T @ np.asarray(body.mass) @ motions)


def _body(inertia: Floats, x: float) -> PartFile:
    """A body of revolution from its (6, 6) mass matrix about (x, 0, 0)."""
    mass = float(inertia[0, 0])
    # m (c x) couples a motion along y with a turn about z
    away = float(inertia[1, 5]) / mass
    about = inertia[3:, 3:] - mass * away**2 * np.diag([0.0, 1.0, 1.0])
    return PartFile(mass=mass, centre=(x + away, 0.0, 0.0), inertia=about.tolist())
