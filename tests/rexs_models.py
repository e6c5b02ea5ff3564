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
