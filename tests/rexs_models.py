"""REXS models for tests: of a drivetrain of the library, in other forms, units, axes, and wrong."""

import io
import json
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np

from fe_drivetrain.drivetrain_file import Drivetrain
from fe_drivetrain.dynamics import Level
from fe_drivetrain.export.formats.rexs_own import PREFIX
from fe_drivetrain.export.turning import turning_of
from fe_drivetrain.export.turning_files import write_turning

#: The same value in another unit of REXS: that unit, and the factor.
OTHER_UNITS = {
    "mm": ("m", 1e-3),
    "°": ("rad", np.pi / 180),
    "N / m": ("N / mm", 1e-3),
    "N mm / rad": ("N m / rad", 1e-3),
    "kg / dm^3": ("kg / m^3", 1e3),
    "N / mm^2": ("Pa", 1e6),
}
WORDS = ("", "nan", "inf", "-1", "0", "1e308", "-1e308", "1e999", "x", "9" * 40, "none", "mm", "2")


def model_of(drivetrain: Drivetrain, path: Path) -> ET.Element:
    """What this program writes of a drivetrain."""
    write_turning(path, turning_of(drivetrain, Level.TORSIONAL), "rexs")
    return ET.fromstring(path.read_bytes())


def without_own(model: ET.Element) -> ET.Element:
    """The same without attributes of our own, as another program would write it."""
    for component in model.iterfind("components/component"):
        for attribute in list(component):
            if attribute.get("id", "").startswith(PREFIX):
                component.remove(attribute)
    return model


def in_other_units(model: ET.Element) -> ET.Element:
    """The same values in other units."""
    for attribute in model.iter("attribute"):
        unit, factor = OTHER_UNITS.get(attribute.get("unit", ""), ("", 1.0))
        if not unit or attribute.get("id", "").endswith("_axis_vector"):
            continue
        attribute.set("unit", unit)
        for cell in attribute.iter("c") if len(attribute) else (attribute,):
            cell.text = repr(float(cell.text or "nan") * factor)
    return model


def turned(model: ET.Element, axes: Any, origin: Any) -> ET.Element:
    """The same gear unit elsewhere: its own axes in columns (3, 3), and its place [mm]."""
    unit = model.find("components/component[@type='gear_unit']")
    assert unit is not None
    place = {"support_vector": origin, "u_axis_vector": axes[:, 0], "w_axis_vector": axes[:, 2]}
    for key, values in place.items():
        array = ET.SubElement(ET.SubElement(unit, "attribute", id=key, unit="mm"), "array")
        for value in values:
            ET.SubElement(array, "c").text = repr(float(value))
    return model


def as_json(model: ET.Element) -> bytes:
    """The model in REXS's form of JSON, with types of values as they look."""

    def value(attribute: ET.Element) -> dict[str, Any]:
        array = attribute.find("array")
        if array is not None:
            return {"floating_point_array": [float(cell.text or "nan") for cell in array]}
        text = attribute.text or ""
        try:
            return {"floating_point": float(text)}
        except ValueError:
            return {"string": text}

    components = [
        {
            **{key: int(v) if key == "id" else v for key, v in one.attrib.items()},
            "attributes": [{**a.attrib, **value(a)} for a in one.iterfind("attribute")],
        }
        for one in model.iterfind("components/component")
    ]
    relations = [
        {
            **{key: int(v) if key == "id" else v for key, v in one.attrib.items()},
            "refs": [
                {key: int(v) if key == "id" else v for key, v in ref.attrib.items()} for ref in one
            ],
        }
        for one in model.iterfind("relations/relation")
    ]
    data = {**model.attrib, "relations": relations, "components": components}
    return json.dumps({"model": data}, ensure_ascii=False, indent=1).encode("utf-8-sig")


def zipped(**files: bytes) -> bytes:
    """An archive; underscores of names are points."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(name.replace("_", "."), content)
    return buffer.getvalue()


AXES = {5: (47.02148907341676, -24.45362069957225), 36: (50.33350037591513, 32.45007497243242)}
SECTIONS = {
    4: ("ANW [4]", 0.0, [(154.0, 22.0)]),
    5: ("RW3 [5]", 137.5, [(2.5, 14.8), (10.0, 15.0), (13.5, 16.0), (23.0, 14.0), (10.5, 15.0)]),
    36: (
        "RW5 [36]",
        128.5,
        [(7, 14.6), (14, 15), (52, 20), (5, 25.91), (41, 18.403), (9, 25.91), (12, 17), (3, 16.8)],
    ),
}
GEARS = {
    23: (4, 154.0, 23, 1.0, 30.0, 16.0, 0.581),
    34: (5, 156.5, 67, 1.0, -30.0, 11.0, 0.5131),
    38: (5, 175.0, 13, 1.25, -10.0, 23.0, 0.521),
    52: (36, 177.5, 76, 1.25, 10.0, 15.0, -0.094),
}
ROLLERS = {
    20: ("6305-Z-J", 4, 65.5, "both_directions"),
    32: ("6202-J [32]", 5, 144.0, "negative"),
    33: ("6202-J [33]", 5, 192.0, "positive"),
    49: ("6302-J", 36, 142.0, "negative"),
    50: ("NUP204E", 36, 194.5, "no_direction"),
    51: ("6303-J", 36, 263.5, "positive"),
}


def two_parallel_stages() -> bytes:
    """Two stages of SEW's published gearbox in REXS 1.0, which rexs-api-java (FVA) tests with.

    Numbers are its own [mm, degrees], but the fast shaft's, whose sections are one here.
    """
    model = ET.Element("model", version="1.0", applicationId="FVA Workbench")
    relations, components = ET.SubElement(model, "relations"), ET.SubElement(model, "components")

    def relate(kind: str, **ends: int) -> None:
        one = ET.SubElement(relations, "relation", id=str(len(relations) + 1), type=kind)
        for role, number in ends.items():
            ET.SubElement(one, "ref", id=str(number), role=role)

    def add(number: int, kind: str, name: str, place: Any = None, **values: Any) -> None:
        one = ET.SubElement(components, "component", id=str(number), type=kind, name=name)
        for key, (unit, value) in values.items():
            ET.SubElement(one, "attribute", id=key, unit=unit).text = str(value)
        if place is not None:
            row = ET.SubElement(ET.SubElement(one, "attribute", id="support_vector"), "array")
            for value in place:
                ET.SubElement(row, "c").text = str(value)

    add(1, "gear_unit", "Gear unit [1]")
    add(2, "gear_casing", "Casing [2]")
    number = 1000
    for shaft, (name, x, sections) in SECTIONS.items():
        add(shaft, "shaft", name, (x, *AXES.get(shaft, (0, 0))))
        for length, diameter in sections:
            number += 1
            ends = ("outer_diameter_begin", "outer_diameter_end")
            add(
                number,
                "shaft_section",
                "",
                length=("mm", length),
                **dict.fromkeys(ends, ("mm", diameter)),
            )
            relate("assembly", assembly=shaft, part=number)
    for gear, (shaft, x, teeth, module, helix, width, shift) in GEARS.items():
        geometry = {
            "number_of_teeth": ("none", teeth),
            "normal_module": ("mm", module),
            "helix_angle_reference_diameter": ("°", helix),
            "face_width": ("mm", width),
        }
        add(gear, "cylindrical_gear", f"gear {gear}", (x, *AXES.get(shaft, (0, 0))), **geometry)
        relate("assembly", assembly=shaft, part=gear)
        for side in (0, 1):
            flank = {"addendum_modification_coefficient": ("none", shift)}
            add(
                2000 + 2 * gear + side,
                "flank_geometry",
                "",
                normal_pressure_angle=("°", 20.0),
                **flank,
            )
        relate("flank", gear=gear, left=2000 + 2 * gear, right=2001 + 2 * gear)
    for stage, (first, second, distance) in {6: (23, 34, 53.0), 37: (38, 52, 57.0)}.items():
        add(
            stage, "cylindrical_stage", f"Stirnradstufe [{stage}]", center_distance=("mm", distance)
        )
        relate("stage", stage=stage, gear_1=first, gear_2=second)
    for bearing, (name, shaft, x, taken) in ROLLERS.items():
        springs = {
            "radial_stiffness": ("N / m", 9.999999999999999e22),
            "axial_stiffness": ("N / m", 0.0),
            "bending_stiffness": ("N mm / rad", 0.0),
            "axial_force_absorption": ("none", taken),
        }
        kind, place = "rolling_bearing_with_catalog_geometry", (x, *AXES.get(shaft, (0, 0)))
        add(bearing, kind, name, place, **springs)
        relate("side", assembly=bearing, inner_part=shaft, outer_part=2)
    return ET.tostring(model)


def wrong_models(model: ET.Element, count: int, seed: int) -> Iterator[bytes]:
    """Well-formed models with up to four slips: elements gone or twice, other values and words."""
    random = np.random.default_rng(seed)
    sound = ET.tostring(model)
    for _ in range(count):
        changed = ET.fromstring(sound)
        for _ in range(1 + int(random.integers(4))):
            _slip(changed, random)
        yield ET.tostring(changed)


def _slip(model: ET.Element, random: np.random.Generator) -> None:
    elements = [one for one in model.iter() if isinstance(one.tag, str)]
    parents = {child: parent for parent in elements for child in parent}
    one = elements[int(random.integers(3, len(elements)))]
    kind = int(random.integers(6))
    if kind == 0:
        parents[one].remove(one)
    elif kind == 1:
        parents[one].append(one)
    elif kind <= 3 and one.attrib:
        key = list(one.attrib)[int(random.integers(len(one.attrib)))]
        others = [*WORDS, *(e.get(key, "") for e in elements)]
        one.set(key, others[int(random.integers(len(others)))])
    elif kind == 4:
        one.text = WORDS[int(random.integers(len(WORDS)))]
    else:
        one.text = repr(float(random.normal() * 10.0 ** random.integers(-3, 6)))
