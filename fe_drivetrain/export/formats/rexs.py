"""REXS, the gearbox field's exchange format: a casing with its reduced stiffness (version 1.6).

The casing refers to an assembly group, which holds `reduced_static_stiffness_matrix` and, in an
ordered assembly, one `reduction_point` for each seat: their order is the matrix's (REXS database
1.6, relations `reference` and `ordered_assembly`; rexs.info, "Assembly Groups"). REXS gives the
matrix no unit, and lengths in mm; here it is in N, mm and rad, which a custom attribute states.
"""

from __future__ import annotations

import xml.etree.ElementTree as ET
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.plain_xml import plain_root
from fe_drivetrain.export.formats.statement import (
    comment_lines,
    commented,
    element_of,
    statement,
    text_of,
)
from fe_drivetrain.export.superelement import Superelement

VERSION = "1.6"
UNITS = "N/mm, N/rad, N mm/rad"

_STIFFNESS = "reduced_static_stiffness_matrix"
_HELD = "matrix_with_inertial_environment_boundary"
_CASING, _GROUP, _FIRST = 2, 3, 4
_MILLIMETRES = 1000.0


def write(path: Path, element: Superelement) -> None:
    """Write the stiffness; the mass has no place in REXS."""
    program, _, number = element.origin.program.rpartition(" ")
    model = ET.Element(
        "model",
        version=VERSION,
        applicationId=program or "fe-drivetrain",
        applicationVersion=number or "unknown",
        date=datetime.now(UTC).isoformat(timespec="seconds"),
    )
    # two hyphens end a comment
    entries = {key: value.replace("--", "- -") for key, value in statement(element).items()}
    entries |= {"units of the matrix": UNITS}
    model.append(ET.Comment("\n" + "\n".join(comment_lines(entries, "#")) + "\n"))
    relations, components = ET.SubElement(model, "relations"), ET.SubElement(model, "components")
    seats = range(_FIRST, _FIRST + len(element.points))
    _relate(relations, 1, "assembly", ("assembly", 1, "gear_unit"), ("part", 2, "gear_casing"))
    _relate(
        relations,
        2,
        "reference",
        ("origin", _CASING, "gear_casing"),
        ("referenced", _GROUP, "assembly_group"),
    )
    for order, seat in enumerate(seats, start=1):
        _relate(
            relations,
            2 + order,
            "ordered_assembly",
            ("assembly", _GROUP, "assembly_group"),
            ("part", seat, "reduction_point"),
            order=order,
        )
    ET.SubElement(components, "component", id="1", type="gear_unit", name="drivetrain")
    ET.SubElement(components, "component", id="2", type="gear_casing", name=element.name)
    group = ET.SubElement(components, "component", id="3", type="assembly_group", name=element.name)
    _attribute(group, _HELD, "none").text = str(element.supported).lower()
    _attribute(group, "custom_stiffness_units", "none").text = UNITS
    matrix = ET.SubElement(_attribute(group, _STIFFNESS, "none"), "matrix")
    for row in _in_millimetres(element.stiffness).tolist():
        columns = ET.SubElement(matrix, "r")
        for value in row:
            ET.SubElement(columns, "c").text = repr(value)
    for seat, name, position in zip(seats, element.points, element.positions, strict=True):
        point = ET.SubElement(
            components, "component", id=str(seat), type="reduction_point", name=name
        )
        array = ET.SubElement(_attribute(point, "support_vector", "mm"), "array")
        for value in position.tolist():
            ET.SubElement(array, "c").text = repr(_MILLIMETRES * value)
    ET.indent(model)
    # REXS asks for the mark of UTF-8
    text = '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(model, encoding="unicode")
    path.write_text(text + "\n", encoding="utf-8-sig")


def read(path: Path) -> Superelement:
    """Read a stiffness, its points, and the description in the comment.

    Raises
    ------
    InputError
        The file is no REXS model, or holds no reduced stiffness with its points.
    """
    text = text_of(path, "REXS model").removeprefix("\ufeff")
    model = plain_root(text.encode(), f"{path} is no REXS model with a reduced stiffness")
    try:
        found = {c.get("id"): c for c in model.iterfind("components/component")}
        group = next(
            c for c in found.values() if c.find(f"attribute[@id='{_STIFFNESS}']") is not None
        )
        rows = group.iterfind(f"attribute[@id='{_STIFFNESS}']/matrix/r")
        matrix = np.array([[float(c.text or "") for c in row.iterfind("c")] for row in rows])
        points = [found[seat] for seat in _ordered(model, group.get("id"))]
        positions = [
            [float(c.text or "") for c in point.iterfind("attribute[@id='support_vector']/array/c")]
            for point in points
        ]
    except (StopIteration, ValueError, KeyError, TypeError) as error:
        raise InputError(
            f"{path} is no REXS model with a reduced stiffness: {type(error).__name__} {error}"
        ) from error
    n = len(points)
    if matrix.shape != (6 * n, 6 * n) or any(len(place) != 3 for place in positions):
        raise InputError(
            f"{path} has a stiffness of shape {matrix.shape} for {n} points: six degrees of "
            "freedom for each point, which has x, y and z"
        )
    # a comment's tag is the function that makes one
    lines = [line for c in model if callable(c.tag) for line in (c.text or "").splitlines()]
    entries = commented(lines, "#")
    return element_of(path, entries, _in_metres(matrix), None)


def _relate(
    relations: ET.Element,
    number: int,
    kind: str,
    *ends: tuple[str, int, str],
    order: int | None = None,
) -> None:
    relation = ET.SubElement(relations, "relation", id=str(number), type=kind)
    if order is not None:
        relation.set("order", str(order))
    for role, component, hint in ends:
        ET.SubElement(relation, "ref", id=str(component), role=role, hint=hint)


def _attribute(component: ET.Element, name: str, unit: str) -> ET.Element:
    return ET.SubElement(component, "attribute", id=name, unit=unit)


def _ordered(model: ET.Element, group: str | None) -> list[str]:
    """The components in ordered assembly with a group, by their order."""
    found: list[tuple[int, str]] = []
    for relation in model.iterfind("relations/relation[@type='ordered_assembly']"):
        ends = {ref.get("role"): ref.get("id") or "" for ref in relation.iterfind("ref")}
        if ends.get("assembly") == group:
            found.append((int(relation.get("order", "")), ends["part"]))
    return [part for _, part in sorted(found)]


def _lengths(n: int) -> Floats:
    """What each degree of freedom grows by from m, N m to mm, N mm."""
    return np.tile([1.0, 1.0, 1.0, _MILLIMETRES, _MILLIMETRES, _MILLIMETRES], n // 6)


def _in_millimetres(matrix: Floats) -> Floats:
    """N/m, N/rad, N m/rad to N/mm, N/rad, N mm/rad."""
    size = _lengths(len(matrix))
    return np.asarray(matrix * np.outer(size, size) / _MILLIMETRES)


def _in_metres(matrix: Floats) -> Floats:
    size = _lengths(len(matrix))
    return np.asarray(matrix / np.outer(size, size) * _MILLIMETRES)
