"""What a scene is: tables of its parts, bearings and load points."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import Literal

from fe_drivetrain.bearing.catalogue_page import entry_name
from fe_drivetrain.common.components import MOTIONS
from fe_drivetrain.common.typeset import with_prefix
from fe_drivetrain.drivetrain_file.bearing_unit import SPHERICAL_JOINTS, BearingUnit
from fe_drivetrain.drivetrain_file.nose import NoseBearing
from fe_drivetrain.drivetrain_file.scene import Scene, coarser_scene
from fe_drivetrain.geometry import FurtherPart
from fe_drivetrain.report.suite.records import Record
from fe_drivetrain.shafts.response.model import Model

#: Coarsening of the mesh of a quick study: factor of the sizes, and elements a turn.
_QUICK = (2.0, 8)

_UNITS = (*3 * ("N/m",), *3 * ("N m/rad",))


def quick_scene(scene: Scene) -> Scene:
    """The scene on a coarser mesh, for a first look."""
    return coarser_scene(scene, *_QUICK)


def description(model: Model) -> dict[str, list[Record]]:
    """Tables of the parts, bearings and load points of a scene, by their captions.

    Parameters
    ----------
    model : Model
        The model, meshed, so that masses are those of what is solved.
    """
    scene = model.scene
    parts: list[Record] = [
        {
            "part": part,
            "material": scene.material_name(part),
            "E [GPa]": scene.material_of(part).youngs_modulus / 1e9,
            "density [kg/m³]": scene.material_of(part).density,
            "mass [kg]": float(mass.sum()),
            "size": _size(scene, part),
        }
        for part, mass in model.part_mass.items()
    ]
    tables: dict[str, list[Record]] = {"Parts; masses are those of the mesh": parts}
    if scene.bearing_units:
        rows = [_bearing_row(unit) for unit in scene.bearing_units]
        tables["Bearings" + _of_torque(scene)] = rows
    if scene.nose is not None:
        tables[
            "Bearings between the shaft and its nose: springs between the mean motions of both "
            "faces"
        ] = [_nose_bearing_row(scene, bearing) for bearing in scene.nose_bearings]
    tables["Where loads enter the shaft"] = _point_rows(scene)
    return tables


def _point_rows(scene: Scene) -> list[Record]:
    """Points at which loads enter the shaft."""
    points: list[Record] = [
        {
            "point": "hub (front face), where the hub loads act",
            "x [m]": scene.shaft.front,
            "coupling": scene.hub.coupling,
            "weight [N]": None,
            "held by": "nothing",
        },
        {
            "point": "gearbox (rear face)",
            "x [m]": scene.shaft.rear,
            "coupling": scene.gearbox.coupling,
            "weight [N]": scene.gearbox.weight,
            "held by": springs_in_words(scene.gearbox.stiffness),
        },
    ]
    points[1:1] = [
        {
            "point": f"{point.name} (over {point.width:g} m)",
            "x [m]": point.x,
            "coupling": "averaged",
            "weight [N]": point.weight,
            "held by": "nothing",
        }
        for point in scene.load_points
    ]
    if scene.loads_at != scene.shaft.front:
        points.insert(
            1,
            {
                "point": "what hub loads of files are about (hub.loads_at), moved to the hub",
                "x [m]": scene.loads_at,
                "coupling": None,
                "weight [N]": None,
                "held by": "nothing",
            },
        )
    return points


def _size(scene: Scene, part: str) -> str:
    if part in ("shaft", "nose"):
        shaft = scene.shaft if scene.nose is None or part == "shaft" else scene.nose.body
        widest = max(max(piece.outer_diameter, piece.end_diameter) for piece in shaft.pieces)
        bores = {piece.inner_diameter for piece in shaft.pieces} - {0.0}
        bored = f", bore {_range(bores)} m" if bores else ", no bore"
        return (
            f"{shaft.length:g} m long, {len(shaft.sections)} "
            f"section{'s' if len(shaft.sections) > 1 else ''}"
            f"{' and a flange' if shaft.flange else ''}, up to {widest:g} m wide{bored}"
        )
    name, _, housing = part.partition(".")
    unit = scene.bearing_unit(name)
    solid = unit.housing_parts.get(part)
    if isinstance(solid, FurtherPart):
        onto = ", ".join(dict.fromkeys(tie.to for tie in solid.tied))
        held = ", held" if solid.held else ""
        return f"from {Path(solid.file).name}, tied to {onto}{held}"
    if housing and unit.foreign is not None:
        return f"from {Path(unit.foreign.file).name}, {unit.foreign.held_by}"
    if housing:
        return (
            f"axis {unit.block.centre_height:g} m over its base, wall {unit.block.wall:g} m, "
            f"base {unit.block.base}"
        )
    return f"{unit.bearing.width:g} m wide, raceway {unit.bearing.raceway_diameter:g} m"


def _range(values: set[float]) -> str:
    low, high = min(values), max(values)
    return f"{low:g}" if low == high else f"{low:g} to {high:g}"


def _of_torque(scene: Scene) -> str:
    """Which bearings take hub torque that goes on to the gearbox where a bearing turns."""
    bonded = [u.bearing.name for u in scene.bearing_units if u.interface == "bonded"]
    if not bonded:
        return ""
    return (
        f"; {' and '.join(bonded)}: bonded, so held against turning, too, with hub torque in the "
        "housing as far as that is stiffer there than the gearbox. Where torque or "
        "hub.stiffness.rx counts, take the interface rollers, or spring with 0 about x"
    )


def _bearing_row(unit: BearingUnit) -> Record:
    return {
        "bearing": unit.bearing.name,
        "x [m]": unit.bearing.x,
        "interface": unit.interface,
        "carries moments": "no: spherical joint"
        if unit.interface in SPHERICAL_JOINTS
        else "yes"
        if unit.interface == "bonded"
        else "as its stiffness says",
        "stands on": "the ground" if unit.bedplate is None else springs_in_words(unit.bedplate),
        "rolling bearing": entry_name(unit.catalogue),
    }


def _nose_bearing_row(scene: Scene, bearing: NoseBearing) -> Record:
    assert scene.nose is not None
    return {
        "bearing": bearing.name,
        "x [m]": bearing.x,
        "width [m]": bearing.width,
        "diameter on the nose [m]": 2 * scene.nose.body.outer_radius(bearing.x),
        "diameter in the shaft [m]": 2 * scene.shaft.inner_radius(bearing.x),
        "holds": springs_in_words(bearing.stiffness),
    }


def springs_in_words(stiffness: Iterable[float | Literal["rigid"]]) -> str:
    """Six springs in words, those that are 0 left out.

    Parameters
    ----------
    stiffness : iterable of float or "rigid"
        Along and about x, y, z [N/m, N m/rad].
    """
    found = [
        f"{motion} {k}" if k == "rigid" else f"{motion} {with_prefix(k, unit)}"
        for motion, k, unit in zip(MOTIONS, stiffness, _UNITS, strict=True)
        if k != 0
    ]
    return ", ".join(found) or "nothing"
