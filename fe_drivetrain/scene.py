"""A scene: parts, materials, interfaces, supports and mesh sizes; typed, validated, from YAML."""

from collections.abc import Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Any, Literal, TypeVar

import yaml
from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from fe_drivetrain.errors import InputError
from fe_drivetrain.geometry import Bearing, Housing, MeshSizes, Shaft
from fe_drivetrain.materials import MATERIALS, Material
from fe_drivetrain.plain_yaml import PlainLoader, no_truth_value, shown

#: How the bearing's outer face meets the housing's bore.
Interface = Literal["bonded", "sliding", "averaged", "rigid"]
#: How a reference point holds its face: as its mean motion (RBE3) or as a rigid body (RBE2).
Coupling = Literal["averaged", "rigid"]

_MAX_BYTES = 1_000_000
_STIFFEST = 1e16  # beyond it a spring is rigid, and only harms the conditioning

_Model = TypeVar("_Model", bound=BaseModel)


class _Part(BaseModel):
    model_config = ConfigDict(frozen=True, extra="forbid")

    _truth = field_validator("*", mode="before")(no_truth_value)


class BearingUnit(_Part):
    """A bearing, its housing, and the interface between the two."""

    bearing: Bearing
    housing: Housing
    interface: Interface


class Hub(_Part):
    """The reference point of the hub loads, at the centre of the shaft's front face."""

    coupling: Coupling = "averaged"


class Gearbox(_Part):
    """Springs to ground and a weight, at the centre of the shaft's rear face.

    Each stiffness is a number, or "rigid", or 0 for free: N/m along x, y, z, N m/rad about them.
    """

    stiffness: tuple[float | Literal["rigid"], ...] = Field(min_length=6, max_length=6)
    weight: float = Field(default=0.0, ge=0, allow_inf_nan=False, description="[N], along -z")
    coupling: Coupling = "averaged"

    @field_validator("stiffness", mode="before")
    @classmethod
    def _no_booleans(cls, value: Any) -> Any:
        if isinstance(value, list | tuple) and any(isinstance(k, bool) for k in value):
            raise ValueError("each stiffness must be a number from 0 on, or 'rigid'")
        return value

    @field_validator("stiffness")
    @classmethod
    def _not_negative(
        cls, value: tuple[float | Literal["rigid"], ...]
    ) -> tuple[float | Literal["rigid"], ...]:
        for k in value:
            if k != "rigid" and not 0 <= k <= _STIFFEST:
                raise ValueError(
                    f"{k:g} must be a number from 0 to {_STIFFEST:g} [N/m, N m/rad], or 'rigid'"
                )
        return value

    @property
    def held(self) -> list[int]:
        """The motions (0-2 displacements, 3-5 rotations) that are rigidly held."""
        return [c for c, k in enumerate(self.stiffness) if k == "rigid"]


class Spread(_Part):
    """How certain a value is, relative to it: half the width of an even distribution, the standard
    deviation of a normal one, or the coefficient of variation of a lognormal one about its median.
    """

    uniform: float | None = Field(default=None, gt=0, lt=1)
    normal: float | None = Field(default=None, gt=0, lt=1)
    lognormal: float | None = Field(default=None, gt=0, lt=10)

    @model_validator(mode="after")
    def _one(self) -> "Spread":
        given = [k for k in ("uniform", "normal", "lognormal") if getattr(self, k) is not None]
        if len(given) != 1:
            raise ValueError(
                f"give one of uniform, normal and lognormal, not {' and '.join(given) or 'none'}"
            )
        return self


class Scene(_Part):
    """A drivetrain: one shaft on any number of bearing units, with a hub and a gearbox."""

    title: str
    shaft: Shaft
    bearing_units: tuple[BearingUnit, ...] = Field(min_length=1)
    hub: Hub = Hub()
    gearbox: Gearbox
    materials: Mapping[str, Material] = {}
    mesh: MeshSizes = MeshSizes()
    uncertainty: Mapping[str, Spread] = {}

    @model_validator(mode="after")
    def _consistent(self) -> "Scene":
        names = [unit.bearing.name for unit in self.bearing_units]
        if len(set(names)) < len(names):
            raise ValueError(f"bearing names {names} must differ from each other")
        used = [("shaft", self.shaft.material)]
        for unit in self.bearing_units:
            used.append((unit.bearing.name, unit.bearing.material))
            used.append((f"{unit.bearing.name}.housing", unit.housing.material))
            if unit.interface != "bonded" and unit.bearing.kind != "spherical":
                raise ValueError(
                    f"bearing {unit.bearing.name!r} of kind {unit.bearing.kind!r} cannot have the "
                    f"spherical-joint interface {unit.interface!r}: make its kind 'spherical' or "
                    "its interface 'bonded'"
                )
        known = {**MATERIALS, **self.materials}
        for part, material in used:
            if material not in known:
                raise ValueError(
                    f"material {shown(material)} of {part} is unknown: use one of "
                    f"{', '.join(known)}, or define it under 'materials'"
                )
        return self

    def material_of(self, part: str) -> Material:
        """The material of a part, by the part's name in the mesh."""
        known = {**MATERIALS, **self.materials}
        if part == "shaft":
            return known[self.shaft.material]
        name, _, housing = part.partition(".")
        unit = self.bearing_unit(name)
        return known[unit.housing.material if housing else unit.bearing.material]

    def bearing_unit(self, name: str) -> BearingUnit:
        """The bearing unit of that name."""
        return next(unit for unit in self.bearing_units if unit.bearing.name == name)


def read_scene(path: str | Path, changes: Mapping[str, Any] | None = None) -> Scene:
    """Read a scene from a YAML file.

    Parameters
    ----------
    path
        A file of at most 1 MB, plain YAML without anchors, aliases or tags.
    changes
        Values by dotted key that replace what the file says, as in
        ``{"shaft.sections.0.inner_diameter": 0.2}``; a bearing unit goes by its bearing's name.

    Raises
    ------
    InputError
        The file cannot be read, is not such YAML, or does not describe a scene.
    """
    path = Path(path)
    try:
        with path.open("rb") as file:
            content = file.read(_MAX_BYTES + 1)
        if len(content) > _MAX_BYTES:
            raise InputError(f"{path} is larger than {_MAX_BYTES} bytes, the most of a scene file")
        text = content.decode("utf-8")
    except (OSError, ValueError) as error:  # no file, no text, or no name of a file
        raise InputError(f"cannot read scene file {path}: {error}") from error
    return parse_scene(text, changes, source=str(path))


def parse_scene(
    text: str, changes: Mapping[str, Any] | None = None, source: str = "scene"
) -> Scene:
    """A scene from YAML text; see `read_scene`."""
    try:
        data = yaml.load(text, Loader=PlainLoader)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"{source} is not plain YAML: {reason}") from error
    if not isinstance(data, dict):
        raise InputError(f"{source} must be a mapping with keys such as 'shaft' and 'gearbox'")
    for key, value in (changes or {}).items():
        _set(data, key, value)
    return validated(Scene, data, source)


def library_scene(name: str) -> Scene:
    """A scene that comes with the package, by name: "main_bearing_spherical", "..._bonded"."""
    folder = files("fe_drivetrain.geometry") / "library"
    names = sorted(f.name.removesuffix(".yaml") for f in folder.iterdir())
    if name not in names:
        raise InputError(f"no scene {name!r} in the library: use one of {', '.join(names)}")
    return parse_scene((folder / f"{name}.yaml").read_text("utf-8"), source=name)


def change_scene(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """A copy of the scene with other values by dotted key; see `read_scene`."""
    data = scene.model_dump(mode="json")
    for key, value in changes.items():
        _set(data, key, value)
    return validated(Scene, data, "scene")


def validated(model: type[_Model], data: Any, source: str) -> _Model:
    """Validate data against a model; the first fault as an InputError in one sentence."""
    try:
        return model.model_validate(data)
    except InputError as error:  # from a part, which speaks for itself
        raise InputError(f"{source}: {error}") from error
    except ValidationError as error:
        # A misspelt key first: what is missing is often the same key, spelt right.
        faults = error.errors(include_url=False)
        fault = min(faults, key=lambda f: f["type"] != "extra_forbidden")
        where = ".".join(str(part) for part in fault["loc"] if not _is_type_tag(part))
        raise InputError(f"{source}: {_sentence(_cut(where), fault, model)}") from error


_WORDS = {
    "missing": "is missing: add it",
    "greater_than": "must be greater than {gt}",
    "greater_than_equal": "must be at least {ge}",
    "less_than": "must be less than {lt}",
    "less_than_equal": "must be at most {le}",
    "literal_error": "must be {expected}",
    "finite_number": "must be a finite number",
    "float_parsing": "must be a number, in SI and without its unit",
    "float_type": "must be a number, in SI and without its unit",
    "string_type": "must be a text",
    "too_short": "must have at least {min_length} values, not {actual_length}",
    "too_long": "must have at most {max_length} values, not {actual_length}",
    "model_type": "must be a mapping of keys to values",
    "dict_type": "must be a mapping of keys to values",
    "tuple_type": "must be a list",
}


def _sentence(where: str, fault: Any, model: type[BaseModel]) -> str:
    """One fault of pydantic's as object, value, allowed range, mend."""
    if fault["type"] == "extra_forbidden":
        return f"{where}: unknown key; known here: {', '.join(_known_keys(model, fault['loc']))}"
    given = fault["input"]
    value = f" = {shown(given)}" if isinstance(given, int | float | str) else ""
    words = _WORDS.get(fault["type"])
    if words is None:
        message = str(fault["msg"]).removeprefix("Value error, ")
        return f"{where}{value}: {message}".removeprefix(": ")
    if "rigid" in fault["loc"] or where.startswith("gearbox.stiffness."):
        words = "must be a number or 'rigid'"
    return f"{where}{value if fault['type'] != 'missing' else ''} " + words.format(
        **fault.get("ctx", {})
    )


def _cut(text: str, most: int = 100) -> str:
    return text if len(text) <= most else f"{text[: most - 3]}..."


def _is_type_tag(part: object) -> bool:
    return isinstance(part, str) and (part in {"float", "rigid"} or "[" in part)


def _known_keys(model: type[BaseModel], location: Sequence[int | str]) -> list[str]:
    """The field names of the model that a fault's location leads into."""
    current: Any = model
    for part in location[:-1]:
        if isinstance(part, int):
            continue
        annotation = current.model_fields[part].annotation if part in current.model_fields else None
        found = [m for m in _models_in(annotation)]
        if not found:
            return []
        current = found[0]
    return list(current.model_fields)


def _models_in(annotation: Any) -> list[type[BaseModel]]:
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    return [m for inner in getattr(annotation, "__args__", ()) for m in _models_in(inner)]


def _set(data: Any, key: str, value: Any) -> None:
    """Replace one value by dotted key, in place."""
    target = data
    *path, last = key.split(".")
    for part in path:
        target = _step(target, part, key)
    if isinstance(target, dict):
        target[last] = value
    elif isinstance(target, list) and (at := _place(last, target)) is not None:
        target[at] = value
    else:
        raise InputError(
            f"key {shown(key)}: there is no {shown(last)} to set{_choices(target)}: name another"
        )


def _step(target: Any, part: str, key: str) -> Any:
    if isinstance(target, dict):
        return target.setdefault(part, {})
    if isinstance(target, list):
        if (at := _place(part, target)) is not None:
            return target[at]
        default = Bearing.model_fields["name"].default
        for unit in target:
            bearing = unit.get("bearing") if isinstance(unit, dict) else None
            if isinstance(bearing, dict) and bearing.get("name", default) == part:
                return unit
    raise InputError(f"key {shown(key)}: there is no {shown(part)}{_choices(target)}: name another")


def _place(part: str, target: Sequence[Any]) -> int | None:
    """The place in a list that part of a key names by its number, if it does."""
    # not int(part) first: it takes numerals of any script, and fails for very many digits
    places = range(len(target))
    return next((k for k in places if str(k) == part), None) if part.isdecimal() else None


def _choices(target: Any) -> str:
    """What a list offers, for a message."""
    return f"; there are 0 to {len(target) - 1}" if isinstance(target, list) and target else ""
