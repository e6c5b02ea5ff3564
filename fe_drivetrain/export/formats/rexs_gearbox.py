"""REXS: shafts, gears, stages and bearings of a drivetrain as a model of a gear unit (version 1.6).

Components, attributes and relations are those of models that gearbox programs exchange: a planetary
stage has a sun's and a ring's shaft (`central_shaft`), a carrier's, planets on theirs, and a
cylindrical stage for each mesh (rexs.info, "Planetary Stages"). Lengths are in mm, angles in
degrees. The comment at the head states what REXS has no attribute for: it is in attributes of our
own (`rexs_own`), by which `rexs_reading` reads the same drivetrain back.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from math import cos, sin
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData
from fe_drivetrain.drivetrain_file.turning_parts import BearingData, PinData, ShaftData
from fe_drivetrain.dynamics.bodies.planetary import equal_angles
from fe_drivetrain.export.formats.rexs import VERSION
from fe_drivetrain.export.formats.rexs_own import (
    BEARING_KEYS,
    SHAFT_KEYS,
    STAGE_KEYS,
    own_attributes,
)
from fe_drivetrain.export.formats.statement import comment_lines
from fe_drivetrain.export.turning import Turning
from fe_drivetrain.export.turning_files import TURNING_FORMATS
from fe_drivetrain.geometry.part import Part

_MM = 1000.0
Place = tuple[float, float, float]


class _Model:
    """A REXS model that is being written: components and relations with their numbers."""

    def __init__(self, turning: Turning) -> None:
        program, _, number = turning.program.rpartition(" ")
        self.root = ET.Element(
            "model",
            version=VERSION,
            applicationId=program,
            applicationVersion=number,
            date=datetime.now(UTC).isoformat(timespec="seconds"),
        )
        entries = {**turning.source(), "left out": TURNING_FORMATS["rexs"].left_out}
        # two hyphens end a comment
        stated = {key: value.replace("--", "- -") for key, value in entries.items()}
        self.root.append(ET.Comment("\n" + "\n".join(comment_lines(stated, "#")) + "\n"))
        self.relations = ET.SubElement(self.root, "relations")
        self.components = ET.SubElement(self.root, "components")
        self.kinds: list[str] = []
        down = {"u": 0.0, "v": 0.0, "w": -1.0}
        gravity = {f"direction_vector_gravity_{k}": ("none", v) for k, v in down.items()}
        own = own_attributes(_of_drivetrain(turning.drivetrain))
        self.unit = self.component("gear_unit", turning.title, None, **gravity, **own)
        self.casing = self.part_of(self.unit, "gear_casing", "casing")

    def component(
        self, kind: str, name: str, at: Place | None = None, **attributes: tuple[str, object]
    ) -> int:
        """Add a component with its attributes, each a unit and a value; its number."""
        self.kinds.append(kind)
        number = len(self.kinds)
        found = ET.SubElement(self.components, "component", id=str(number), type=kind, name=name)
        if at is not None:
            _attribute(found, "reference_component_for_position", "none", 1)
            _array(found, "support_vector", [_MM * value for value in at])
            _array(found, "u_axis_vector", [1.0, 0.0, 0.0])
            _array(found, "w_axis_vector", [0.0, 0.0, 1.0])
        for key, (unit, value) in attributes.items():
            _attribute(found, key, unit, value)
        return number

    def part_of(
        self,
        whole: int,
        kind: str,
        name: str,
        at: Place | None = None,
        **attributes: tuple[str, object],
    ) -> int:
        """Add a component that is a part of another."""
        number = self.component(kind, name, at, **attributes)
        self.relate("assembly", assembly=whole, part=number)
        return number

    def relate(self, relation: str, order: int | None = None, **ends: int) -> None:
        """Add a relation between components by their roles, and by its place among such."""
        number = str(len(self.relations) + 1)
        found = ET.SubElement(self.relations, "relation", id=number, type=relation)
        if order is not None:
            found.set("order", str(order))
        for role, component in ends.items():
            hint = self.kinds[component - 1]
            ET.SubElement(found, "ref", id=str(component), role=role, hint=hint)


def write(path: Path, turning: Turning) -> None:
    """Write the gear unit.

    Raises
    ------
    InputError
        The drivetrain's file does not state the geometry of what turns.
    """
    machine = turning.machine
    if machine.not_given:
        raise InputError(
            f"{machine.title!r} as a gear unit needs what its file does not state: "
            f"{', '.join(machine.not_given)}: add it, or export matrices of level 'torsional'"
        )
    model = _Model(turning)
    axes = machine.axes
    shafts = [_shaft(model, shaft, at) for shaft, at in zip(machine.shafts, axes, strict=True)]
    names = [shaft.name for shaft in machine.shafts]
    seats = dict(zip(names, zip(shafts, axes, strict=True), strict=True))
    for shaft, one in zip(shafts, machine.shafts, strict=True):
        _material(model, shaft, one)
    seats["rotor"] = shafts[0], axes[0]
    x, y, z = axes[-1]
    seats["generator"] = shafts[-1], (x + machine.shafts[-1].length, y, z)
    for k, stage in enumerate(machine.stages):
        name, on = f"stage {k + 1}", (shafts[k], shafts[k + 1])
        own = own_attributes(_without(turning.drivetrain.gearbox.stages[k], STAGE_KEYS))
        places = (axes[k + 1][0], *axes[k][1:]), axes[k + 1]
        if isinstance(stage, PlanetaryData):
            _planetary(model, name, stage, on, places[0], own)
        else:
            _parallel(model, name, stage, on, places, own)
        parts = ("carrier", "sun") if isinstance(stage, PlanetaryData) else ("gear", "pinion")
        for part, seat in zip(parts, zip(on, places, strict=True), strict=True):
            seats[f"{name} {part}"] = seat
    for bearing in machine.bearings:
        shaft, (x, y, z) = seats[bearing.holds]
        _bearing(model, bearing.name, bearing, (x + bearing.at, y, z), shaft, model.casing)
    ET.indent(model.root)
    # REXS asks for the mark of UTF-8
    head = '<?xml version="1.0" encoding="UTF-8"?>\n'
    text = head + ET.tostring(model.root, encoding="unicode")
    path.write_text(text + "\n", encoding="utf-8-sig")


def _of_drivetrain(drivetrain: Drivetrain) -> dict[str, Any]:
    """What a file states beside its gearbox, as plain data."""
    keys = ("sources", "assumed", "rotor", "generator", "brake", "operation", "damping", "limits")
    stated = drivetrain.model_dump(mode="json", exclude_unset=True)
    return {key: stated[key] for key in keys if stated.get(key) is not None}


def _without(part: Part, keys: Sequence[str]) -> dict[str, Any]:
    """What is stated of a part beside some keys, as plain data."""
    stated = part.model_dump(mode="json", exclude_unset=True)
    return {key: one for key, one in stated.items() if key not in keys and one is not None}


def _shaft(model: _Model, shaft: ShaftData, at: Place) -> int:
    """Add a shaft with its sections; of one given by its stiffness, its place and our own."""
    own = _without(shaft, SHAFT_KEYS)
    if own.get("kind") == "shaft":
        del own["kind"]
    if shaft.has_mass:
        del own["length"]
    number = model.part_of(model.unit, "shaft", shaft.name, at, **own_attributes(own))
    u = 0.0
    for length, outer, end, inner in _sections(shaft):
        model.part_of(
            number,
            "shaft_section",
            f"{shaft.name} at {u:g} m",
            u_coordinate_on_shaft=("mm", _MM * u),
            length=("mm", _MM * length),
            outer_diameter_begin=("mm", _MM * outer),
            outer_diameter_end=("mm", _MM * end),
            inner_diameter_begin=("mm", _MM * inner),
            inner_diameter_end=("mm", _MM * inner),
        )
        u += length
    return number


def _sections(shaft: ShaftData) -> list[tuple[float, float, float, float]]:
    """Length, outer diameters at both ends and bore of each section [m]."""
    if shaft.sections is not None:
        return [
            (one.length, one.outer_diameter, one.end_diameter, one.inner_diameter)
            for one in shaft.sections
        ]
    if shaft.outer is None:
        return []
    return [(shaft.length, shaft.outer, shaft.outer, shaft.inner)]


def _material(model: _Model, number: int, shaft: ShaftData) -> None:
    """Add the material of a shaft that has sections."""
    if not shaft.has_mass:
        return
    one = shaft.material
    material = model.component(
        "material",
        f"{shaft.name} material",
        elastic_modulus=("N / mm^2", one.youngs_modulus / 1e6),
        poisson_ratio=("none", one.poisson_ratio),
        density=("kg / dm^3", one.density / 1e3),
    )
    model.relate("reference", origin=number, referenced=material)


def _planetary(
    model: _Model,
    name: str,
    stage: PlanetaryData,
    shafts: tuple[int, int],
    at: Place,
    own: dict[str, tuple[str, object]],
) -> None:
    """Add a planetary stage between the carrier's and the sun's shaft, its ring in the casing."""
    number = model.part_of(model.unit, "planetary_stage", stage.name or name, at, **own)
    carrier = model.part_of(number, "planet_carrier", f"{name} carrier", at)
    model.relate("assembly", assembly=carrier, part=shafts[0])
    model.relate("planet_carrier_shaft", planetary_stage=number, shaft=shafts[0])
    model.relate("central_shaft", planetary_stage=number, shaft=shafts[1])
    ring_shaft = model.part_of(model.unit, "shaft", f"{name} ring", at)
    model.relate("central_shaft", planetary_stage=number, shaft=ring_shaft)
    held = model.part_of(
        model.unit,
        "coupling",
        f"{name} ring in the casing",
        at,
        **_stiffnesses(stage.ring_support or (1e20,) * 6),
        rotational_stiffness=("N mm / rad", 1e20 * _MM),
    )
    model.relate("side", assembly=held, inner_part=ring_shaft, outer_part=model.casing)
    # planets lean the other way than the sun, and with the ring
    sun = _gear(model, f"{name} sun", stage, -1, shafts[1], at, stage.hand)
    ring = _gear(model, f"{name} ring", stage, 0, ring_shaft, at, -stage.hand)
    for k, angle in enumerate(equal_angles(stage.planets), start=1):
        turn = float(angle)
        a = stage.centre_distance
        place = (at[0], at[1] + a * cos(turn), at[2] + a * sin(turn))
        shaft = model.part_of(model.unit, "shaft", f"{name} planet {k}", place)
        model.relate("planet_shaft", planetary_stage=number, shaft=shaft)
        planet = _gear(model, f"{name} planet {k}", stage, 1, shaft, place, -stage.hand)
        _mesh(model, f"{name} sun-planet {k}", stage, number, (sun, planet))
        _mesh(model, f"{name} ring-planet {k}", stage, number, (planet, ring))
        pin = model.part_of(carrier, "shaft", f"{name} pin {k}", place)
        model.relate("planet_pin", planetary_stage=number, shaft=pin)
        for one in stage.pins:
            label = f"{name} planet {k} {one.name}".rstrip()
            seat = (place[0] + one.offset, *place[1:])
            _bearing(model, label, one, seat, pin, shaft)


def _parallel(
    model: _Model,
    name: str,
    stage: ParallelData,
    shafts: tuple[int, int],
    places: tuple[Place, Place],
    own: dict[str, tuple[str, object]],
) -> None:
    """Add a gear, a pinion and their mesh."""
    gear = _gear(model, f"{name} gear", stage, 0, shafts[0], places[0], stage.hand)
    pinion = _gear(model, f"{name} pinion", stage, 1, shafts[1], places[1], -stage.hand)
    _mesh(model, stage.name or name, stage, model.unit, (gear, pinion), own)


def _gear(
    model: _Model,
    name: str,
    stage: PlanetaryData | ParallelData,
    which: int,
    shaft: int,
    at: Place,
    hand: int,
) -> int:
    """Add a gear on its shaft, with its flanks; ``which`` is its place among teeth and shifts."""
    found: dict[str, tuple[str, object]] = {
        "face_width": ("mm", _MM * (stage.faces[which] if stage.faces else stage.face_width)),
        "helix_angle_reference_diameter": ("deg", hand * stage.helix + 0.0),
    }
    if stage.teeth is not None:
        found["number_of_teeth"] = ("none", stage.teeth[which])
    if stage.module is not None:
        found["normal_module"] = ("mm", _MM * stage.module)
    if stage.tips is not None:
        found["tip_diameter"] = ("mm", _MM * stage.tips[which])
    kind = "ring_gear" if name.endswith(" ring") else "cylindrical_gear"
    number = model.part_of(shaft, kind, name, at, **found)
    flank: dict[str, tuple[str, object]] = {
        "normal_pressure_angle": ("deg", stage.pressure_angle),
    }
    if stage.shifts is not None:
        flank["addendum_modification_coefficient"] = ("none", stage.shifts[which])
    left, right = (
        model.component("flank_geometry", f"{name}, {side} flank", None, **flank)
        for side in ("left", "right")
    )
    model.relate("flank", gear=number, left=left, right=right)
    _tool(model, name, stage, which, number)
    return number


def _tool(
    model: _Model, name: str, stage: PlanetaryData | ParallelData, which: int, gear: int
) -> None:
    """Add what cuts a gear, as far as it is stated: its addendum becomes the gear's dedendum."""
    found: dict[str, tuple[str, object]] = {}
    if "dedendum" in stage.model_fields_set:
        found["addendum_coefficient_reference_profile"] = ("none", stage.dedendum)
    if stage.fillets is not None:
        found["tip_radius_factor"] = ("none", stage.fillets[which])
    kind = "rack_shaped_tool"
    if isinstance(stage, PlanetaryData) and stage.cutter is not None and which == 0:
        kind = "cutter_wheel_tool"
        found["number_of_teeth"] = ("none", stage.cutter)
    if found:
        tool = model.component(kind, f"{name}, tool", None, **found)
        model.relate("ordered_reference", order=1, origin=gear, referenced=tool)


def _mesh(
    model: _Model,
    name: str,
    stage: PlanetaryData | ParallelData,
    whole: int,
    gears: tuple[int, int],
    own: Mapping[str, tuple[str, object]] = MappingProxyType({}),
) -> None:
    """Add a cylindrical stage of two gears."""
    number = model.part_of(
        whole,
        "cylindrical_stage",
        name,
        None,
        center_distance=("mm", _MM * stage.centre_distance),
        common_face_width=("mm", _MM * stage.face_width),
        **own,
    )
    model.relate("stage", stage=number, gear_1=gears[0], gear_2=gears[1])


def _bearing(
    model: _Model, name: str, row: BearingData | PinData, at: Place, inner: int, outer: int
) -> None:
    """Add a bearing by its stiffness, between what it holds and what holds it."""
    stiffness = np.asarray(row.stiffness, dtype=float)
    six = stiffness.diagonal() if stiffness.ndim == 2 else stiffness
    own = _without(row, BEARING_KEYS)
    if stiffness.ndim == 2 or six[1] != six[2] or six[4] != six[5] or six[3]:
        own["stiffness"] = stiffness.tolist()
    number = model.part_of(
        model.unit,
        "concept_bearing",
        name,
        at,
        radial_force_absorption=("none", "true"),
        axial_force_absorption=("none", "both_directions" if six[0] > 0.0 else "no_direction"),
        **_stiffnesses(six.tolist()),
        **own_attributes(own),
    )
    model.relate("side", assembly=number, inner_part=inner, outer_part=outer)


def _stiffnesses(six: Sequence[float]) -> dict[str, tuple[str, object]]:
    """Axial stiffness, and means of both directions of the radial one and of that in tilt."""
    return {
        "axial_stiffness": ("N / m", six[0]),
        "radial_stiffness": ("N / m", (six[1] + six[2]) / 2.0),
        "bending_stiffness": ("N mm / rad", _MM * (six[4] + six[5]) / 2.0),
    }


def _attribute(component: ET.Element, key: str, unit: str, value: object) -> None:
    # REXS has the sign of a degree
    mark = "°" if unit == "deg" else unit
    ET.SubElement(component, "attribute", id=key, unit=mark).text = str(value)


def _array(component: ET.Element, key: str, values: Sequence[float]) -> None:
    attribute = ET.SubElement(component, "attribute", id=key, unit="mm")
    array = ET.SubElement(attribute, "array")
    for value in values:
        ET.SubElement(array, "c").text = repr(float(value))
