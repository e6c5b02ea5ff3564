"""A scene: parts, materials, interfaces, supports and mesh sizes; typed and validated."""

from collections.abc import Iterable, Mapping
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    field_validator,
    model_validator,
)

from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.strict_yaml import no_truth_value, shown
from fe_drivetrain.geometry import Bearing, Housing, MeshSizes, Shaft
from fe_drivetrain.scene.materials import Material, known_materials

#: How the bearing's outer face meets the housing's bore.
Interface = Literal["bonded", "spring", "rollers", "sliding", "averaged", "rigid"]
#: The interfaces that carry no moment.
SPHERICAL_JOINTS = ("sliding", "averaged", "rigid")
#: How a reference point holds its face: as its mean motion (RBE3) or as a rigid body (RBE2).
Coupling = Literal["averaged", "rigid"]

_STIFFEST = 1e16  # beyond it a spring is rigid, and only harms the conditioning


class Keys(BaseModel):
    """A mapping of a scene file: known keys only, and no truth values where numbers stand."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    _truth = field_validator("*", mode="before")(no_truth_value)


def _no_booleans(value: Any) -> Any:
    if isinstance(value, list | tuple) and any(isinstance(k, bool) for k in value):
        raise ValueError("each stiffness must be a number of at least 0, or 'rigid'")
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


def check_material(name: str, defined: Mapping[str, Material], of: str = "") -> None:
    """Refuse a material that neither the program nor a scene has.

    Parameters
    ----------
    name : str
        Name of the material.
    defined : mapping
        Those that the scene defines.
    of : str
        The part, where there are several, as in " of shaft".

    Raises
    ------
    ValueError
    """
    known = known_materials(defined)
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

    count: int = Field(ge=3, le=1000, description="number of rollers in a row")
    stiffness: float = Field(gt=0, le=_STIFFEST, description="stiffness of one roller [N/m]")
    rows: tuple[RollerRow, ...] = Field(default=(RollerRow(),), min_length=1)

    @model_validator(mode="after")
    def _apart(self) -> "Rollers":
        places = [row.x for row in self.rows]
        if len(set(places)) < len(places):
            raise ValueError(f"rows at x = {places} must differ from each other")
        return self


class BearingUnit(Keys):
    """A bearing, its housing, and the interface between the two.

    What rests on the ground is the housing's base, or an elastic bedplate, as springs at the
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
                f"stiffness of bearing {name!r} must be positive semidefinite, but it "
                "drives a motion: check its signs"
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
    weight: float = Field(
        default=0.0, ge=0, allow_inf_nan=False, description="weight [N], along -z"
    )
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
        known = known_materials(self.materials)
        if part == "shaft":
            return known[self.shaft.material]
        name, _, housing = part.partition(".")
        unit = self.bearing_unit(name)
        return known[unit.housing.material if housing else unit.bearing.material]

    def bearing_unit(self, name: str) -> BearingUnit:
        """The bearing unit of that name."""
        return next(unit for unit in self.bearing_units if unit.bearing.name == name)
