"""Gear stages of a REXS model as rows of a drivetrain's file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import atan2, degrees, hypot
from typing import Any

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.rexs_layout import Stage
from fe_drivetrain.export.formats.rexs_model import Model, Part
from fe_drivetrain.export.formats.rexs_own import own_values
from fe_drivetrain.export.formats.rexs_places import Places

SAME = 1e-6
"""Relative difference of values of two gears that are the same."""


def stage_row(
    model: Model, places: Places, stage: Stage, number: int, notes: list[str]
) -> dict[str, Any]:
    """Keys of a stage, without its pins.

    Parameters
    ----------
    model, places, stage : Model, Places, Stage
        The model, where its components are, and the stage.
    number : int
        Number of the stage, from one on.
    notes : list of str
        Sentences on what is assumed are added to it.

    Raises
    ------
    InputError
        Its gears contradict each other.
    """
    row: dict[str, Any] = {"kind": "planetary" if stage.is_planetary else "parallel"}
    if stage.part.name and stage.part.name != f"stage {number}":
        row["name"] = stage.part.name
    if stage.is_planetary:
        row["planets"] = len(stage.planets)
    else:
        row |= _angle(places, stage)
    gears = stage.gears
    _same_planets(model, stage)
    teeth = _of_each(gears, "number_of_teeth", "number")
    if teeth is not None:
        row["teeth"] = {name: _whole(gears[name], abs(value)) for name, value in teeth.items()}
    module = _common(gears, "normal_module", "length")
    if module is not None:
        row["module"] = module
    row |= _helix(gears)
    row |= _flanks(model, gears)
    tips = _of_each(gears, "tip_diameter", "length")
    if tips is not None:
        row["tips"] = {name: abs(value) for name, value in tips.items()}
    row |= _faces(stage) | _distance(places, stage)
    row |= _tools(model, stage, number, notes) | _bodies(model, stage)
    own = own_values(stage.part)
    if teeth is None and not own.keys() & {"radii", "ratio"}:
        raise InputError(
            f"{stage.part}: its gears have no number_of_teeth: give it to each of "
            f"{', '.join(map(str, gears.values()))}"
        )
    return row | own


def _same_planets(model: Model, stage: Stage) -> None:
    """Refuse planets of different gears."""
    planets = {str(number): gear for number, (_, gear) in enumerate(stage.planets)}
    for key, dimension in (
        ("number_of_teeth", "number"),
        ("normal_module", "length"),
        ("face_width", "length"),
        ("tip_diameter", "length"),
        ("helix_angle_reference_diameter", "angle [deg]"),
    ):
        _common(planets, key, dimension)
    shifts = _flanks(model, planets).get("shifts", {}).values()
    if shifts and max(shifts) - min(shifts) > SAME:
        raise InputError(
            f"{stage.part}: its planets have profile shifts of {min(shifts):g} and "
            f"{max(shifts):g} but must have the same: correct them"
        )


def _of_each(gears: Mapping[str, Part], key: str, dimension: str) -> dict[str, float] | None:
    """A value of each gear; None unless all have it."""
    found = {name: gear.number_of(key, dimension) for name, gear in gears.items()}
    values = {name: value for name, value in found.items() if value is not None}
    return values if len(values) == len(gears) else None


def _common(gears: Mapping[str, Part], key: str, dimension: str) -> float | None:
    """A value that all gears of a stage share; None where none has it."""
    found = [(gear, gear.number_of(key, dimension)) for gear in gears.values()]
    given = [(gear, value) for gear, value in found if value is not None]
    for gear, value in given[1:]:
        if abs(value - given[0][1]) > SAME * abs(given[0][1]):
            raise InputError(
                f"{key} of {given[0][0]} is {given[0][1]:g} and of {gear} {value:g} (SI, degrees) "
                "but must be the same in a stage: correct one of them"
            )
    return given[0][1] if given else None


def _whole(gear: Part, teeth: float) -> int:
    if teeth != int(teeth):
        raise InputError(f"{gear}: number_of_teeth is {teeth:g} but must be whole: correct it")
    return int(teeth)


def _helix(gears: Mapping[str, Part]) -> dict[str, Any]:
    """Helix angle, and its hand: of the sun or of the gear, positive to the right."""
    leading = gears.get("sun") or gears["gear"]
    found = {
        name: gear.number_of("helix_angle_reference_diameter", "angle [deg]")
        for name, gear in gears.items()
    }
    angle = leading.number_of("helix_angle_reference_diameter", "angle [deg]")
    for name, value in found.items():
        if value is not None and angle is not None and abs(abs(value) - abs(angle)) > SAME * 90:
            raise InputError(
                f"helix_angle_reference_diameter of {leading} is {angle:g} deg and of "
                f"{gears[name]} {value:g} deg but gears in mesh share it: correct one of them"
            )
    if not angle:
        return {}
    return {"helix": abs(angle), "hand": 1 if angle > 0 else -1}


def _flanks(model: Model, gears: Mapping[str, Part]) -> dict[str, Any]:
    """Pressure angle and profile shifts, of flanks or of the gears themselves."""
    angles: dict[str, Part] = {}
    shifts: dict[str, float] = {}
    for name, gear in gears.items():
        holders = [gear]
        for ends in model.related("flank", gear=gear):
            holders += [ends[side] for side in ("left", "right") if side in ends]
        for key in ("normal_pressure_angle", "addendum_modification_coefficient"):
            _same_on_both(gear, [one for one in holders if one.has(key)], key)
        for one in holders:
            if one.has("normal_pressure_angle"):
                angles.setdefault(name, one)
            shift = one.number_of("addendum_modification_coefficient", "number")
            if shift is not None:
                shifts.setdefault(name, shift)
    row: dict[str, Any] = {}
    angle = _common(angles, "normal_pressure_angle", "angle [deg]")
    if angle is not None:
        row["pressure_angle"] = angle
    if len(shifts) == len(gears):
        row["shifts"] = shifts
    return row


def _same_on_both(gear: Part, holders: Sequence[Part], key: str) -> None:
    dimension = "angle [deg]" if key.endswith("angle") else "number"
    values = [one.number_of(key, dimension) or 0.0 for one in holders]
    if values and max(values) - min(values) > SAME * max(1.0, max(map(abs, values))):
        raise InputError(
            f"{gear}: {key} is {values[0]:g} and {values[-1]:g} on its two flanks, but a stage of "
            "a drivetrain's file has the same on both: correct one of them"
        )


def _faces(stage: Stage) -> dict[str, Any]:
    """Face width in contact, and of each gear where they differ."""
    faces = _of_each(stage.gears, "face_width", "length")
    common = [mesh.number_of("common_face_width", "length") for mesh in stage.meshes]
    contact = min((width for width in common if width), default=None)
    if contact is None and faces is not None:
        contact = min(faces.values())
    if contact is None:
        return {}
    differ = faces is not None and any(
        abs(width - contact) > SAME * contact for width in faces.values()
    )
    return {"face_width": contact} | ({"faces": faces} if differ else {})


def _distance(places: Places, stage: Stage) -> dict[str, Any]:
    """Centre distance, of the stage or of the places of its gears."""
    found = [(mesh, mesh.number_of("center_distance", "length")) for mesh in stage.meshes]
    given = [(mesh, abs(value)) for mesh, value in found if value is not None]
    for mesh, value in given[1:]:
        if abs(value - given[0][1]) > SAME * given[0][1]:
            raise InputError(
                f"center_distance of {given[0][0]} is {given[0][1]:g} m and of {mesh} {value:g} m "
                "but must be the same of all meshes of a stage: correct one of them"
            )
    if given:
        return {"centre_distance": given[0][1]}
    pair = list(stage.gears.values())[-2:]
    if not all(gear.has("support_vector") for gear in pair):
        return {}
    apart = places.of(pair[1]) - places.of(pair[0])
    return {"centre_distance": hypot(apart[1], apart[2])}


def _angle(places: Places, stage: Stage) -> dict[str, Any]:
    """Where the pinion is, seen from the gear, from y to z."""
    gear, pinion = stage.gears["gear"], stage.gears["pinion"]
    if not (gear.has("support_vector") and pinion.has("support_vector")):
        return {}
    _, y, z = places.of(pinion) - places.of(gear)
    angle = degrees(atan2(z, y))
    return {"angle": angle} if abs(angle) > 1e-9 else {}


def _tools(model: Model, stage: Stage, number: int, notes: list[str]) -> dict[str, Any]:
    """Dedendum and fillets by the racks that cut the gears, and the cutter of the ring.

    What a tool has as its addendum becomes the gear's dedendum.
    """
    addenda: dict[str, float] = {}
    fillets: dict[str, float] = {}
    row: dict[str, Any] = {}
    for name, gear in stage.gears.items():
        for relation in ("ordered_reference", "reference"):
            for ends in model.related(relation, origin=gear):
                tool = ends.get("referenced", gear)
                if tool.type not in ("rack_shaped_tool", "cutter_wheel_tool"):
                    continue
                key = "addendum_coefficient_reference_profile"
                addendum = tool.number_of(key, "number")
                radius = tool.number_of("tip_radius_factor", "number")
                if addendum is not None:
                    addenda[name] = addendum
                if radius is not None:
                    fillets[name] = radius
                teeth = tool.number_of("number_of_teeth", "number")
                if tool.type == "cutter_wheel_tool" and name == "ring" and teeth:
                    row["cutter"] = _whole(tool, teeth)
    if len(addenda) == len(stage.gears):
        if max(addenda.values()) - min(addenda.values()) <= SAME:
            row["dedendum"] = next(iter(addenda.values()))
        else:
            notes.append(
                f"stage {number}: tools of its gears have different addenda, and a stage has one "
                "dedendum: left out"
            )
    if len(fillets) == len(stage.gears):
        row["fillets"] = fillets
    return row


def _bodies(model: Model, stage: Stage) -> dict[str, Any]:
    """Inertias and masses of gears and of the carrier, where the model has them."""
    parts = {name: gear for name, gear in stage.gears.items() if name != "ring"}
    if stage.is_planetary:
        for ends in model.related("assembly", assembly=stage.part):
            if ends.get("part", stage.part).type == "planet_carrier":
                parts["carrier"] = ends["part"]
    row = {}
    for name, part in parts.items():
        inertia = part.number_of("moment_of_inertia_u_axis", "inertia")
        mass = part.number_of("mass", "mass")
        if inertia:
            row[name] = {"inertia": inertia} | ({} if mass is None else {"mass": mass})
    return row
