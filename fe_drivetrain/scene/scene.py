"""A scene: parts, materials, interfaces, supports and mesh sizes; typed, validated, from YAML."""

from collections.abc import Iterable, Mapping, Sequence
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any, Literal, TypeVar

import numpy as np
import yaml
from numpy.typing import NDArray
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    field_validator,
    model_validator,
)

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.strict_yaml import PlainLoader, no_truth_value, shown
from fe_drivetrain.geometry import Bearing, Housing, MeshSizes, Shaft
from fe_drivetrain.scene.materials import MATERIALS, Material

#: How the bearing's outer face meets the housing's bore.
Interface = Literal["bonded", "spring", "rollers", "sliding", "averaged", "rigid"]
#: The interfaces that carry no moment.
SPHERICAL_JOINTS = ("sliding", "averaged", "rigid")
#: How a reference point holds its face: as its mean motion (RBE3) or as a rigid body (RBE2).
Coupling = Literal["averaged", "rigid"]

#: Keys that make a file one of a component, see `fe_drivetrain.scene.component`.
COMPONENT_KINDS = ("gearbox_housing", "planet_carrier")

_MAX_BYTES = 1_000_000
_STIFFEST = 1e16  # beyond it a spring is rigid, and only harms the conditioning

_Model = TypeVar("_Model", bound=BaseModel)


class Keys(BaseModel):
    """A mapping of a scene file: known keys only, and no truth values where numbers stand."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    _truth = field_validator("*", mode="before")(no_truth_value)


def _no_booleans(value: Any) -> Any:
    if isinstance(value, list | tuple) and any(isinstance(k, bool) for k in value):
        raise ValueError("each stiffness must be a number from 0 on, or 'rigid'")
    return value


def _not_negative(value: tuple[float | Literal["rigid"], ...]) -> Any:
    for k in value:
        if k != "rigid" and not 0 <= k <= _STIFFEST:
            raise ValueError(
                f"{k:g} must be a number from 0 to {_STIFFEST:g} [N/m, N m/rad], or 'rigid'"
            )
    return value


#: Along x, y, z [N/m] and about them [N m/rad]: each a number, or "rigid", or 0 for free.
Springs = Annotated[
    tuple[float | Literal["rigid"], ...],
    Field(min_length=6, max_length=6),
    BeforeValidator(_no_booleans),
    AfterValidator(_not_negative),
]
#: The same, or six rows of a full matrix.
_Spring = Annotated[
    tuple[float | Literal["rigid"] | tuple[float, ...], ...],
    Field(min_length=6, max_length=6),
    BeforeValidator(_no_booleans),
]


def as_numbers(springs: Iterable[float | Literal["rigid"]]) -> NDArray[np.float64]:
    """Springs as numbers, inf where they are "rigid"."""
    return np.array([np.inf if k == "rigid" else k for k in springs], dtype=float)


def check_material(name: str, own: Mapping[str, Material], of: str = "") -> None:
    """Refuse a material that neither the program nor a scene has.

    Parameters
    ----------
    name, own
        Of the material, and those that the scene defines.
    of
        The part, where there are several, as in " of shaft".

    Raises
    ------
    ValueError
    """
    known = {**MATERIALS, **own}
    if name not in known:
        raise ValueError(
            f"material {shown(name)}{of} is unknown: use one of {', '.join(known)}, or define it "
            "under 'materials'"
        )


class RollerRow(Keys):
    """One row of rollers: x from the bearing's centre [m], and its contact angle [deg].

    The angle leans the line of contact from the radius towards +x on its way out. That of a
    spherical raceway is given by x: the line goes through the centre.
    """

    x: float = Field(default=0.0, allow_inf_nan=False)
    contact_angle: float = Field(default=0.0, gt=-90, lt=90)


class Rollers(Keys):
    """Rollers as springs along their lines of contact, which push and pull."""

    count: int = Field(ge=3, le=1000, description="rollers in a row")
    stiffness: float = Field(gt=0, le=_STIFFEST, description="of one roller [N/m]")
    rows: tuple[RollerRow, ...] = Field(default=(RollerRow(),), min_length=1)

    @model_validator(mode="after")
    def _apart(self) -> "Rollers":
        places = [row.x for row in self.rows]
        if len(set(places)) < len(places):
            raise ValueError(f"rows at x = {places} must differ from each other")
        return self


class BearingUnit(Keys):
    """A bearing, its housing, and the interface between the two.

    What stands on the ground is the housing's base, or a bedplate that gives, as springs at the
    centre of the base.
    """

    bearing: Bearing
    housing: Housing
    interface: Interface
    stiffness: _Spring | None = None
    rollers: Rollers | None = None
    bedplate: Springs | None = None

    @property
    def ring_on_housing(self) -> bool:
        """Whether the bearing's ring counts to the housing, where the shaft is solved apart."""
        return self.interface in ("bonded", "rollers")

    @field_validator("bedplate")
    @classmethod
    def _stands(cls, value: Springs | None) -> Springs | None:
        if value is not None and 0 in value:
            raise ValueError("each stiffness must be greater than 0, or 'rigid'")
        return value

    @model_validator(mode="after")
    def _has_what_its_interface_needs(self) -> "BearingUnit":
        name = self.bearing.name
        for interface, key in (("spring", "stiffness"), ("rollers", "rollers")):
            given = getattr(self, key) is not None
            if given != (self.interface == interface):
                raise ValueError(
                    f"bearing {name!r} has interface {self.interface!r} and "
                    + (f"{key}: leave {key} out" if given else f"no {key}: add it")
                    + f", or make the interface {'' if given else 'another than '}{interface!r}"
                )
        if self.stiffness is not None:
            _check_spring(name, self.stiffness)
        if self.rollers is not None:
            _check_rows(self.bearing, self.rollers)
        return self


def _check_spring(name: str, stiffness: tuple[Any, ...]) -> None:
    rows = [isinstance(k, tuple) and len(k) == 6 for k in stiffness]
    if not any(isinstance(k, tuple) for k in stiffness):
        _not_negative(stiffness)
    elif not all(rows):
        raise ValueError(
            f"stiffness of bearing {name!r} must be six numbers (or 'rigid'), or six rows of six "
            "numbers"
        )
    else:
        K = np.array(stiffness)
        scaled = scaled_to_unit_diagonal(K, np.maximum(K.diagonal(), 1e-300))
        if not np.isfinite(K).all() or np.abs(scaled - scaled.T).max() > 1e-6:
            raise ValueError(f"stiffness of bearing {name!r} must be six symmetric rows of numbers")
        if np.linalg.eigvalsh(scaled)[0] < -1e-9:
            raise ValueError(
                f"stiffness of bearing {name!r} must resist every motion or leave it free; it "
                "drives one: check its signs"
            )


def _check_rows(bearing: Bearing, rollers: Rollers) -> None:
    for row in rollers.rows:
        if abs(row.x) >= bearing.width / 2:
            raise ValueError(
                f"bearing {bearing.name!r}: a row of rollers at x = {row.x:g} m must be within "
                f"half the bearing's width, {bearing.width / 2:g} m"
            )
        if bearing.kind == "spherical" and row.contact_angle:
            raise ValueError(
                f"bearing {bearing.name!r}: contact_angle is {row.contact_angle:g} deg, but a "
                "spherical raceway has that of its row's x: leave it out"
            )


class Hub(Keys):
    """The reference point of the hub loads, at the centre of the shaft's front face."""

    coupling: Coupling = "averaged"


class Gearbox(Keys):
    """Springs to ground and a weight, at the centre of the shaft's rear face."""

    stiffness: Springs
    weight: float = Field(default=0.0, ge=0, allow_inf_nan=False, description="[N], along -z")
    coupling: Coupling = "averaged"

    @property
    def held(self) -> list[int]:
        """The motions (0-2 displacements, 3-5 rotations) that are rigidly held."""
        return [c for c, k in enumerate(self.stiffness) if k == "rigid"]


class Spread(Keys):
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


class Scene(Keys):
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
            if unit.interface in SPHERICAL_JOINTS and unit.bearing.kind != "spherical":
                raise ValueError(
                    f"bearing {unit.bearing.name!r} of kind {unit.bearing.kind!r} cannot have the "
                    f"spherical-joint interface {unit.interface!r}: make its kind 'spherical' or "
                    "its interface 'bonded', 'spring' or 'rollers'"
                )
        for part, material in used:
            check_material(material, self.materials, f" of {part}")
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
    return parse_scene(file_text(path), changes, source=str(path))


def file_text(path: str | Path) -> str:
    """The text of a scene file; see `read_scene`."""
    path = Path(path)
    try:
        with path.open("rb") as file:
            content = file.read(_MAX_BYTES + 1)
        if len(content) > _MAX_BYTES:
            raise InputError(f"{path} is larger than {_MAX_BYTES} bytes, the most of a scene file")
        return content.decode("utf-8")
    except (OSError, ValueError) as error:  # no file, no text, or no name of a file
        raise InputError(f"cannot read scene file {path}: {error}") from error


def parse_scene(
    text: str, changes: Mapping[str, Any] | None = None, source: str = "scene"
) -> Scene:
    """A scene from YAML text; see `read_scene`."""
    data = parse_mapping(text, changes, source)
    for kind in COMPONENT_KINDS:
        if kind in data:
            raise InputError(
                f"{source} is a component, for it has {kind!r}, and no scene of a shaft: "
                "components can be exported, and have cases of their own"
            )
    return validated(Scene, data, source)


def parse_mapping(
    text: str, changes: Mapping[str, Any] | None = None, source: str = "scene"
) -> dict[str, Any]:
    """Plain YAML text as keys and values, with changes by dotted key; see `read_scene`."""
    try:
        data = yaml.load(text, Loader=PlainLoader)
    except (yaml.YAMLError, RecursionError, ValueError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"{source} is not plain YAML: {reason}") from error
    if not isinstance(data, dict):
        raise InputError(f"{source} must be a mapping with keys such as 'shaft' and 'gearbox'")
    for key, value in (changes or {}).items():
        set_by_key(data, key, value)
    return data


def library_scene(name: str) -> Scene:
    """A scene that comes with the package, by name: "main_bearing_spherical", "..._bonded"."""
    return parse_scene(library_text(name), source=name)


def library_text(name: str) -> str:
    """The text of a file of the library, by its name without ending."""
    folder = files("fe_drivetrain.geometry") / "library"
    names = sorted(f.name.removesuffix(".yaml") for f in folder.iterdir())
    if name not in names:
        raise InputError(f"no scene {name!r} in the library: use one of {', '.join(names)}")
    return (folder / f"{name}.yaml").read_text("utf-8")


def change_scene(scene: Scene, changes: Mapping[str, Any]) -> Scene:
    """A copy of the scene with other values by dotted key; see `read_scene`."""
    data = scene.model_dump(mode="json")
    for key, value in changes.items():
        set_by_key(data, key, value)
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


def set_by_key(data: Any, key: str, value: Any) -> None:
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
