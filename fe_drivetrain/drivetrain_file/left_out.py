"""What a scene leaves out that changes its physics, and the values that stand in its place."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any, NamedTuple

from pydantic import BaseModel

from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.units import unit_of_field
from fe_drivetrain.geometry import Housing


class LeftOut(NamedTuple):
    """A key that is not given: dotted, the value in its place, its unit, and why that."""

    key: str
    value: float | str
    unit: str
    why: str


#: Why, where the key does not carry the source of its default itself.
_WHY: Mapping[str, str] = MappingProxyType(
    {
        "coupling": "assumed: the reference point moves as the mean of its face (RBE3)",
        "weight": "assumed: no weight hangs there",
        "material": "assumed: see the table of parts for its modulus and density",
        "kind": "assumed: see the bearing's raceway",
        "base": "assumed: the whole underside is held",
        "x": "assumed: in the origin",
        "rows": "assumed: one row in the middle, contact angle 0",
        "rotate": "assumed: as the file has it",
        "contact_angle": "assumed: along the radius",
    }
)

#: Keys without a value of their own, and what holds where they are left out.
_DERIVED: Mapping[str, tuple[str, str, str]] = MappingProxyType(
    {
        "bedplate": ("rigid", "N/m", "assumed: the base stands on the ground"),
        "loads_at": ("front face", "m", "assumed: hub loads of files are about the hub"),
        "unit": ("mm", "", "assumed: what STEP files are written in"),
        "of_yield": ("0.9", "-", "assumed: of the bolts' property class, VDI 2230"),
        "thread_friction": ("0.12", "-", "assumed: of the bolts' property class, VDI 2230"),
    }
)

#: What says nothing of the machine, or is absent where it is left out.
_SILENT = frozenset(
    {
        *("title", "mesh", "uncertainty", "materials", "load_points", "parts", "catalogue", "name"),
        *("nose", "stands_on", "source", "smallest_detail", "fillet", "inner_diameter", "held"),
        # what turns beside the main shaft: studies of it state their assumptions themselves
        *("sources", "assumed", "rotor", "brake", "generator", "operation", "damping", "limits"),
        "whirl",
        *("stages", "shafts", "bearings", "strength"),
    }
)

_OF_BOLTS = frozenset({"bolt_diameter", "bolt_spacing_x", "bolt_spacing_y", "washer_diameter"})


def left_out(scene: Scene) -> list[LeftOut]:
    """Keys of a scene that are not given and have a default that changes physics.

    Parameters
    ----------
    scene : Scene
        As it was read; one that was changed in Python states every value.

    Returns
    -------
    list[LeftOut]
        In the order of the scene's keys.
    """
    return list(_of_model(scene, ""))


def _of_model(model: BaseModel, key: str, given: bool = True) -> Iterator[LeftOut]:
    for name, field in type(model).model_fields.items():
        value, stated = getattr(model, name), given and name in model.model_fields_set
        if name in _SILENT or (name in _OF_BOLTS and _no_bolts(model)):
            continue
        inner = f"{key}.{name}" if key else name
        if isinstance(value, BaseModel):
            yield from _of_model(value, inner, stated)
        elif stated and isinstance(value, tuple):
            yield from _of_list(value, inner)
        elif not stated and (row := _row(model, name, inner, value)) is not None:
            yield row._replace(unit=row.unit or unit_of_field(field))


def _of_list(values: tuple[Any, ...], key: str) -> Iterator[LeftOut]:
    for number, value in enumerate(values):
        if isinstance(value, BaseModel):
            holder = getattr(value, "bearing", value)
            yield from _of_model(value, f"{key}.{getattr(holder, 'name', number)}")


def _row(model: BaseModel, name: str, key: str, value: Any) -> LeftOut | None:
    """What stands in place of a key; None where nothing does."""
    extra = type(model).model_fields[name].json_schema_extra
    source = str(extra.get("source", "")) if isinstance(extra, dict) else ""
    if value is None:
        applies = name in _DERIVED and _applies(model, name)
        return LeftOut(key, *_DERIVED[name]) if applies else None
    if not source and name not in _WHY:
        return None
    shown = value if isinstance(value, int | float | str) else _listed(value)
    return LeftOut(key, shown, "", source or _WHY[name])


def _listed(value: Any) -> str:
    if value and all(isinstance(entry, BaseModel) for entry in value):
        return f"{len(value)}"
    return str(list(value))


def _no_bolts(model: BaseModel) -> bool:
    return isinstance(model, Housing) and model.base == "fixed"


def _applies(model: BaseModel, name: str) -> bool:
    """Whether a key that is derived where it is left out has a meaning beside the others."""
    if name == "unit":
        return getattr(model, "step", None) is not None
    if name in ("of_yield", "thread_friction"):
        return getattr(model, "property_class", None) is not None
    if name == "bedplate":
        return getattr(model, "condensed", None) is None and bool(
            getattr(model, "stands_on", "") == "ground"
        )
    return True
