"""A bearing unit: bearing, housing, and the joint between the two; typed and validated."""

from collections.abc import Mapping
from functools import partial
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import (
    AfterValidator,
    BaseModel,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    field_validator,
    model_validator,
)

from fe_drivetrain.bearing.catalogue_page import EntryOrPage
from fe_drivetrain.bearing.mounting import Mounting
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.scaling import scaled_to_unit_diagonal
from fe_drivetrain.common.strict_yaml import no_truth_value, shown
from fe_drivetrain.geometry import (
    AnyHousing,
    Bearing,
    CondensedHousing,
    ForeignHousing,
    FurtherPart,
    Housing,
)

#: How the bearing's outer face meets the housing's bore.
Interface = Literal["bonded", "spring", "rollers", "sliding", "averaged", "rigid"]
#: The interfaces that carry no moment.
SPHERICAL_JOINTS = ("sliding", "averaged", "rigid")

_STIFFEST = 1e16  # beyond it a spring is rigid, and only harms the conditioning
_SOFTEST = 1e-6  # below it round-off of the smallest turbine's shaft is stiffer


class Keys(BaseModel):
    """A mapping of a scene file: known keys only, and no truth values where numbers stand."""

    model_config = ConfigDict(frozen=True, extra="forbid", defer_build=True)

    _truth = field_validator("*", mode="before")(no_truth_value)


def within_range(value: tuple[float | Literal["rigid"], ...], *, free: bool = True) -> Any:
    """Refuse springs that are neither rigid, nor of a size that is one, nor 0 where that is free.

    Raises
    ------
    ValueError
    """
    for k in value:
        if k != "rigid" and not (free and k == 0) and not _SOFTEST <= k <= _STIFFEST:
            raise ValueError(
                f"{k:g} must be {'0, ' if free else ''}a number from {_SOFTEST:g} to "
                f"{_STIFFEST:g} [N/m, N m/rad], or 'rigid'"
            )
    return value


_Six = Annotated[
    tuple[float | Literal["rigid"], ...],
    Field(min_length=6, max_length=6),
]
#: Along x, y, z [N/m] and about them [N m/rad]: each a number, or "rigid", or 0 for free.
Springs = Annotated[_Six, AfterValidator(within_range)]
#: The same, where nothing is free.
_Held = Annotated[_Six, AfterValidator(partial(within_range, free=False))]
#: The same, or six rows of a full matrix.
_Spring = Annotated[
    tuple[float | Literal["rigid"] | tuple[float, ...], ...],
    Field(min_length=6, max_length=6),
]


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
    stiffness: float = Field(ge=_SOFTEST, le=_STIFFEST, description="stiffness of one roller [N/m]")
    rows: tuple[RollerRow, ...] = Field(default=(RollerRow(),), min_length=1)

    @model_validator(mode="after")
    def _apart(self) -> "Rollers":
        places = [row.x for row in self.rows]
        if len(set(places)) < len(places):
            raise ValueError(f"rows at x = {places} must differ from each other")
        return self


class BearingUnit(Keys):
    """A bearing, its housing, and the interface between the two.

    What rests on the ground is the housing's base and the held faces of further parts, or these
    parts alone; or an elastic bedplate, as springs at the centre of all that.
    """

    bearing: Bearing
    housing: AnyHousing
    interface: Interface
    stiffness: _Spring | None = None
    rollers: Rollers | None = None
    bedplate: _Held | None = None
    parts: tuple[FurtherPart, ...] = Field(
        default=(), max_length=50, description="further parts from files, tied to the housing"
    )
    stands_on: Literal["ground", "parts"] = Field(
        default="ground", description="whether the ground holds the housing's own base, too"
    )
    catalogue: EntryOrPage | None = Field(
        default=None,
        description="its rolling bearing, for lives: name in a bearing catalogue, or a page of one",
    )
    mounting: Mounting | None = Field(
        default=None,
        description="clearance before mounting, fits and temperatures of its rolling bearing",
    )

    @property
    def ring_on_housing(self) -> bool:
        """Whether the bearing's ring counts to the housing, where the shaft is solved apart."""
        return self.interface in ("bonded", "rollers") and self.condensed is None

    @property
    def housing_parts(self) -> dict[str, Housing | ForeignHousing | FurtherPart]:
        """The solids behind its bearing by their names in the mesh; none of a stiffness alone."""
        if isinstance(self.housing, CondensedHousing):
            return {}
        name = self.bearing.name
        further = {f"{name}.{part.name}": part for part in self.parts}
        return {f"{name}.housing": self.housing, **further}

    @property
    def block(self) -> Housing:
        """Its housing, where that is a parametric block.

        Raises
        ------
        InputError
            It is from a file, which has no such dimensions.
        """
        if isinstance(self.housing, Housing):
            return self.housing
        raise InputError(
            f"bearing {self.bearing.name!r} has a housing from a file or of a stiffness alone, but "
            "this needs a parametric one, with dimensions: describe it by these"
        )

    @property
    def foreign(self) -> ForeignHousing | None:
        """Its housing, where that is from a file."""
        return self.housing if isinstance(self.housing, ForeignHousing) else None

    @property
    def condensed(self) -> CondensedHousing | None:
        """Its housing, where that is a stiffness alone."""
        return self.housing if isinstance(self.housing, CondensedHousing) else None

    @model_validator(mode="wrap")
    @classmethod
    def _named(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        """Say which unit is wrong, where its part does not."""
        try:
            return handler(data)
        except InputError as error:
            bearing = data.get("bearing") if isinstance(data, Mapping) else None
            name = bearing.get("name") if isinstance(bearing, Mapping) else None
            if not isinstance(name, str) or any(
                word in str(error) for word in (repr(name), f"{name}.housing")
            ):
                raise
            raise InputError(f"bearing unit {shown(name)}: {error}") from None

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
        if self.condensed is not None and self.bedplate is not None:
            raise ValueError(
                f"bearing {name!r} has a housing of a stiffness alone and a bedplate: put the "
                "bedplate into the stiffness, and leave it out"
            )
        if self.foreign is not None:
            _check_foreign(self, self.foreign)
        _check_parts(self)
        if self.stiffness is not None:
            _check_spring(name, self.stiffness)
        if self.rollers is not None:
            _check_rows(self.bearing, self.rollers)
        return self


def _check_foreign(unit: "BearingUnit", housing: ForeignHousing) -> None:
    name = unit.bearing.name
    if unit.bedplate is not None and housing.bolts is not None and housing.bolts.hold != "washers":
        raise ValueError(
            f"bearing {name!r} has a bedplate and bolts that hold it as {housing.bolts.hold!r}, "
            "which stand on the ground: hold 'washers', or leave the bedplate out"
        )
    housing.check_bearing(unit.bearing)


_TAKEN = ("housing", "outer", "bore", "seat", "joint", "base", "ground", "bolt", "roller")


def _check_parts(unit: "BearingUnit") -> None:
    """Refuse further parts that cannot be distinguished, hang in the air, or hold what stands."""
    name, parts = unit.bearing.name, {p.name: p for p in unit.parts}
    if unit.condensed is not None and parts:
        raise ValueError(
            f"bearing {name!r} has a housing of a stiffness alone, to which no part can be tied: "
            "put the parts into the stiffness, or give the housing as a solid"
        )
    if len(parts) < len(unit.parts) or set(parts) & set(_TAKEN):
        raise ValueError(
            f"parts of bearing {name!r} are named {', '.join(p.name for p in unit.parts)}, but "
            f"each must have a name of its own, and none of {', '.join(_TAKEN)}: rename one"
        )
    for part in unit.parts:
        for tie in part.tied:
            if tie.to.endswith(".housing") and tie.to != f"{name}.housing":
                continue  # of another unit, which the scene knows
            if tie.to not in ({"housing", *parts} - {part.name}):
                known = ", ".join(["housing", *(p for p in parts if p != part.name)])
                raise ValueError(
                    f"part {part.name!r} of bearing {name!r} is tied to {tie.to!r}, but must be "
                    f"tied to one of {known}: correct 'to'"
                )
    _refuse_loose(unit, parts)
    _check_standing(unit)


def _refuse_loose(unit: "BearingUnit", parts: Mapping[str, Any]) -> None:
    """Refuse parts that no other ties to the housing."""
    name, near = unit.bearing.name, {"housing"}
    while more := {
        p.name
        for p in unit.parts
        if p.name not in near
        and (
            near & {t.to for t in p.tied}
            or any(t.to == p.name for q in near - {"housing"} for t in parts[q].tied)
        )
    }:
        near |= more
    if loose := [p for p in parts if p not in near]:
        raise ValueError(
            f"part {loose[0]!r} of bearing {name!r} is tied to no part that is tied to the "
            "housing, but all must hang together: tie it to the housing or to one of these"
        )


def _check_standing(unit: "BearingUnit") -> None:
    """Refuse parts, held faces and bolts that contradict what the bearing stands on."""
    name, parts, housing = unit.bearing.name, unit.parts, unit.foreign
    held = [p.name for p in unit.parts if p.held]
    if unit.stands_on == "parts" and parts and not held:
        raise ValueError(
            f"bearing {name!r} stands on parts, of which none has a held face: give one of them "
            "'held', or leave stands_on out"
        )
    if housing is not None and (unit.stands_on == "parts") == bool(housing.held):
        raise ValueError(
            f"bearing {name!r} stands on {'parts' if housing.held else 'the ground'} and its "
            + (
                "housing has held faces: leave these out, or stands_on"
                if housing.held
                else "housing has no held face: give it 'held', or stands_on: parts"
            )
        )
    if housing is not None and housing.bolts is not None and not housing.held:
        raise ValueError(
            f"bearing {name!r} stands on parts and its housing has bolts to the ground: leave the "
            "bolts out"
        )
    bolts = None if housing is None else housing.bolts
    if (
        bolts is not None
        and parts
        and (bolts.hold == "clamped" or (held and bolts.hold == "beams"))
    ):
        raise ValueError(
            f"bearing {name!r} has bolts that hold it as {bolts.hold!r}, and further parts: hold "
            "'washers', or leave the parts out"
        )


def _check_spring(name: str, stiffness: tuple[Any, ...]) -> None:
    rows = [isinstance(k, tuple) and len(k) == 6 for k in stiffness]
    if not any(isinstance(k, tuple) for k in stiffness):
        within_range(stiffness)
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
        if np.abs(K).max() > _STIFFEST:
            raise ValueError(
                f"stiffness of bearing {name!r} must be at most {_STIFFEST:g} [N/m, N, N m/rad]: "
                "give six numbers, and 'rigid' where nothing gives"
            )
        within_range(tuple(K.diagonal().tolist()))


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
