"""Units of the values of a scene, by their dotted keys."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain

_SPRINGS = ("N/m", "N/m", "N/m", "N m/rad", "N m/rad", "N m/rad")


def unit_of_key(scene: Drivetrain, key: str) -> str:
    """Unit of a value of a scene.

    Parameters
    ----------
    scene : Drivetrain
        The scene, or another drivetrain.
    key : str
        Dotted, as for `fe_drivetrain.drivetrain_file.change_scene`.

    Returns
    -------
    str
        As in "m"; empty where the value has none, or none is stated.
    """
    *path, last = key.split(".")
    target: Any = scene
    for part in path:
        target = _inner(target, part)
    if isinstance(target, BaseModel):
        field = type(target).model_fields.get(last)
        return "" if field is None else unit_of_field(field)
    springs = isinstance(target, tuple) and len(target) == len(_SPRINGS)
    if springs and path[-1] in ("stiffness", "bedplate") and last.isdecimal():
        return _SPRINGS[int(last)] if int(last) < len(_SPRINGS) else ""
    return ""


def _inner(target: Any, part: str) -> Any:
    """What a part of a key leads to: a field, an entry of a mapping, or one of a list."""
    if isinstance(target, BaseModel):
        return getattr(target, part, None)
    if isinstance(target, Mapping):
        return target.get(part)
    if not isinstance(target, tuple):
        return None
    if part.isdecimal():
        return target[int(part)] if int(part) < len(target) else None
    named = [one for one in target if part in (_name(one), _name(getattr(one, "bearing", None)))]
    return named[0] if named else None


def _name(one: Any) -> Any:
    return getattr(one, "name", None)


def unit_of_field(field: FieldInfo) -> str:
    """Unit of a value that a field declares; empty where it states none."""
    extra = field.json_schema_extra
    if isinstance(extra, dict) and "unit" in extra:
        unit = str(extra["unit"])
    else:
        stated = re.search(r"\[([^\],]+)\]", field.description or "")
        unit = stated.group(1) if stated else ""
    return "" if unit == "-" else unit
