"""What a catalogue's page says of a bearing, checked: all faults at once in one message."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from typing import Annotated, Any, Literal, Self

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    ValidationError,
    field_validator,
    model_validator,
)

from fe_drivetrain.bearing.designations import Designation, Kind, Sizes, read_designation
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import fault_sentences
from fe_drivetrain.common.strict_yaml import digits_as_text, no_truth_value

MEMBERS = 24
"""Insides that fit a page where no number of them is asked for."""

_SINGLE, _DOUBLE = 0.6, (0.675, 1.005)
"""e times Y of rollers in one row, and times Y1 and Y2 in two: 1.5 tan(alpha) times 0.4, 0.45 and
0.67 cot(alpha) (ISO 281, table 8)."""

_APART = 0.09
"""Relative difference of e times Y from these that two digits of either explain."""

_FILLED = (4e6, 1.2e8)
"""C over D times width [Pa]: catalogues have 1e7 to 6e7; beyond these a unit is wrong."""

_STATIC = (0.3, 5.0)
"""C0 over C: catalogues have 0.4 to 3.6."""

_FATIGUE = (5.0, 60.0)
"""C0 over Cu: 8.2 of small roller and 22 of small ball bearings, more of large ones."""


def _length(what: str, most: float = 10.0) -> Any:
    return Field(default=None, gt=1e-4, le=most, description=f"{what} [m]")


class PageError(InputError):
    """Faults of a page, in one sentence.

    Parameters
    ----------
    faults : sequence of str
        One or more, each with its fix.
    name : str
        What the page is called.
    """

    def __init__(self, faults: Sequence[str], name: str) -> None:
        self.faults = tuple(faults)
        if len(self.faults) == 1:
            super().__init__(f"{name}: {self.faults[0]}")
            return
        listed = "; ".join(f"({number}) {one}" for number, one in enumerate(self.faults, start=1))
        super().__init__(f"{name} has {len(self.faults)} faults: {listed}")


class CataloguePage(BaseModel):
    """A bearing by what its catalogue prints; lengths in m, ratings in N, angles in deg."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    designation: str = Field(
        min_length=2,
        max_length=60,
        description="as printed, such as 240/600 ECA/W33 or NU 2220; any name where kind is given",
    )
    C: float = Field(gt=0, le=1e10, description="basic dynamic load rating [N]")
    C0: float = Field(gt=0, le=1e10, description="basic static load rating [N]")
    Cu: float | None = Field(
        default=None, gt=0, le=1e10, description="fatigue load limit, C_u or P_u [N]"
    )
    kind: Kind | None = Field(
        default=None, description="kind of bearing; of the designation where left out"
    )
    arrangement: Literal["X", "O"] | None = Field(
        default=None, description="of two tapered rows: X face to face, O back to back"
    )
    rows: int | None = Field(
        default=None, ge=1, le=2, description="rows of a cylindrical bearing; by the designation"
    )
    d: float | None = _length("bore; by the designation where left out")
    D: float | None = _length("outside diameter; by the designation where left out")
    B: float | None = _length("width; by the designation where left out")
    T: float | None = _length("width of a tapered bearing over both rings")
    e: float | None = Field(default=None, ge=0.1, lt=3, description="limit of F_a / F_r [-]")
    Y: float | None = Field(default=None, gt=0, le=20, description="axial factor of one row [-]")
    Y1: float | None = Field(
        default=None, gt=0, le=20, description="axial factor of two rows up to e [-]"
    )
    Y2: float | None = Field(
        default=None, gt=0, le=20, description="axial factor of two rows beyond e [-]"
    )
    Y0: float | None = Field(default=None, gt=0, le=20, description="static axial factor [-]")
    f0: float | None = Field(
        default=None, ge=5, le=20, description="factor f_0 of deep groove ball bearings [-]"
    )
    F: float | None = _length("raceway diameter of the inner ring, of NU and NJ")
    E: float | None = _length("raceway diameter of the outer ring, of N and NCF")
    elements: int | None = Field(
        default=None, ge=3, le=500, description="rolling elements of one row, where known"
    )
    element_diameter: float | None = _length("diameter of a roller or ball, where known")
    element_length: float | None = _length("effective length of a roller, where known")
    pitch_diameter: float | None = _length("circle of the elements' middles, where known")
    contact_angle: float | None = Field(
        default=None, gt=0, lt=80, description="contact angle, where known [deg]"
    )
    clearance: float | None = Field(
        default=None, ge=-1e-3, le=1e-2, description="clearance along the contact normal [m]"
    )
    limiting_speed_rpm: float | None = Field(
        default=None, gt=0, description="that the catalogue allows [1/min]"
    )
    inside: int | None = Field(
        default=None,
        ge=0,
        lt=MEMBERS,
        description=f"number of one of the {MEMBERS} insides that fit the page; where left out, "
        "the one nearest to the medians of all",
    )
    source: str = Field(
        default="given", min_length=1, max_length=200, description="which catalogue, which page"
    )

    _truth = field_validator("*", mode="before")(no_truth_value)

    @field_validator("designation", mode="before")
    @classmethod
    def _as_text(cls, value: Any) -> Any:
        return digits_as_text(value)

    @classmethod
    def read(cls, data: Any, name: str) -> Self:
        """A page from mappings, or all of its faults in one message.

        Parameters
        ----------
        data : Any
            Keys and values.
        name : str
            What the page is called, for the message.

        Raises
        ------
        InputError
            One sentence that lists every fault.
        """
        try:
            return cls.model_validate(data)
        except PageError as error:
            found = list(error.faults)
        except ValidationError as error:
            found = [*fault_sentences(error, cls, data), *_further(cls, data, error)]
        raise PageError(found, name)

    @model_validator(mode="after")
    def _sound(self) -> Self:
        if faults := list(_faults(self)):
            raise PageError(faults, self.designation)
        return self

    @property
    def read_as(self) -> Designation | None:
        """What the designation says; None where it says nothing, and the page itself all."""
        try:
            return read_designation(self.designation)
        except InputError:
            return None

    @property
    def of_kind(self) -> Kind:
        """Kind of the bearing."""
        found = self.kind or (self.read_as.kind if self.read_as else None)
        assert found is not None  # checked
        return found

    @property
    def sizes(self) -> Sizes:
        """Bore, outside diameter and width [m]: those given, then those of the designation."""
        return _sizes(self)

    @property
    def row_count(self) -> int:
        """Rows of rolling elements."""
        if self.of_kind in ("spherical_roller", "double_row_tapered"):
            return 2
        if self.rows is not None:
            return self.rows
        return self.read_as.rows if self.read_as else 1

    @property
    def mean_diameter(self) -> float:
        """Mean of bore and outside diameter [m], which ISO 281 takes for D_pw."""
        return 0.5 * (self.sizes.bore + self.sizes.outside)

    @property
    def angle(self) -> float | None:
        """Contact angle [deg] that the page states: itself, by e, or by Y; None where by none."""
        if self.contact_angle is not None:
            return self.contact_angle
        if self.read_as is not None and self.read_as.contact_angle_deg is not None:
            return self.read_as.contact_angle_deg
        if self.of_kind == "ball":
            return 0.0
        if self.of_kind in ("cylindrical", "toroidal"):
            return 0.0
        if self.e is not None:
            return math.degrees(math.atan(self.e / 1.5))
        for Y, factor in ((self.Y, 0.4), (self.Y1, 0.45), (self.Y2, 0.67)):
            if Y is not None:
                return math.degrees(math.atan(factor / Y))
        return None


def _further(model: type[CataloguePage], data: Any, error: ValidationError) -> tuple[str, ...]:
    """Faults of the values that are each in range, where others are not."""
    wrong = {str(fault["loc"][0]) for fault in error.errors(include_url=False) if fault["loc"]}
    if not isinstance(data, Mapping):
        return ()
    try:
        model.model_validate({key: value for key, value in data.items() if key not in wrong})
    except PageError as more:
        return more.faults
    except ValidationError:
        return ()
    return ()


def _sizes(page: CataloguePage) -> Sizes:
    given = page.d, page.D, page.T if page.T is not None else page.B
    known = page.read_as.sizes if page.read_as is not None else None
    if known is None:
        bore = page.read_as.bore if page.read_as is not None else None
        known = Sizes(bore, None, None)  # type: ignore[arg-type]
    found = [k if g is None else g for g, k in zip(given, known, strict=True)]
    return Sizes(*found)


def _faults(page: CataloguePage) -> Iterator[str]:
    """What does not fit in a page whose values are each in range."""
    if page.kind is None and page.read_as is None:
        try:
            read_designation(page.designation)
        except InputError as error:
            yield str(error)
        return
    read = page.read_as
    if page.kind and read and page.kind != read.kind:
        yield (
            f"kind is {page.kind}, but the designation is that of {read.kind}: correct one of them"
        )
    missing = [k for k, v in zip(("d", "D", "B"), page.sizes, strict=True) if v is None]
    if missing:
        more = "T instead of B, " if page.of_kind == "single_row_tapered" else ""
        yield (
            f"{', '.join(missing)} of this size stand in no table here: give {more}"
            f"{' and '.join(missing)} in m, as the page prints them"
        )
        return
    yield from _wrong_sizes(page)
    yield from _wrong_ratings(page)
    yield from _wrong_factors(page)
    yield from _wrong_kind(page)


def _wrong_sizes(page: CataloguePage) -> Iterator[str]:
    bore, outside, width = page.sizes
    if not bore < outside:
        yield f"d is {bore:g} m but must be less than D, {outside:g} m: correct one of them"
    for key, value in zip("dD", (page.d, page.D), strict=True):
        stated = page.read_as.sizes if page.read_as else None
        table = stated[0 if key == "d" else 1] if stated else None
        if value is not None and table is not None and abs(value / table - 1.0) > 1e-3:
            yield (
                f"{key} is {value:g} m, but {page.designation} has {table:g} m: correct it, or "
                "give kind and another designation"
            )
    if not 0.02 * bore < width < 1.5 * outside:
        yield (
            f"width is {width:g} m but must be {0.02 * bore:.4g} to {1.5 * outside:.4g} m, 0.02 d "
            "to 1.5 D: correct it"
        )
    limits = {"F": (bore, outside), "E": (bore, outside), "pitch_diameter": (bore, outside)}
    for key, (low, high) in limits.items():
        value = getattr(page, key)
        if value is not None and not low < value < high:
            yield f"{key} is {value:g} m but must be between d and D, {low:g} and {high:g} m"
    if page.F is not None and page.E is not None and not page.F < page.E:
        yield f"F is {page.F:g} m but must be less than E, {page.E:g} m: exchange them"


def _wrong_ratings(page: CataloguePage) -> Iterator[str]:
    _, outside, width = page.sizes
    filled = page.C / (outside * width)
    if not _FILLED[0] < filled < _FILLED[1]:
        size = f"D of {outside:g} m and a width of {width:g} m"
        low, high = (f"{limit * outside * width:.2g}" for limit in _FILLED)
        yield (
            f"C is {page.C:g} N but must be {low} to {high} N with {size}: ratings are in N (1 kN "
            "is 1000), lengths in m"
        )
    elif not _STATIC[0] < page.C0 / page.C < _STATIC[1]:
        yield (
            f"C0 is {page.C0:g} N but must be {_STATIC[0] * page.C:.4g} to "
            f"{_STATIC[1] * page.C:.4g} N, {_STATIC[0]:g} to {_STATIC[1]:g} times C of "
            f"{page.C:g} N: correct one of them"
        )
    if page.Cu is not None and not _FATIGUE[0] < page.C0 / page.Cu < _FATIGUE[1]:
        least, most = (page.C0 / part for part in reversed(_FATIGUE))
        yield (
            f"Cu is {page.Cu:g} N but must be {least:.4g} to {most:.4g} N, C0 of {page.C0:g} N "
            f"over {_FATIGUE[1]:g} to {_FATIGUE[0]:g}: correct one of them"
        )


def _wrong_factors(page: CataloguePage) -> Iterator[str]:
    if page.e is None or page.of_kind == "ball":
        return
    two = page.row_count == 2
    pairs = (("Y", page.Y, _SINGLE), ("Y1", page.Y1, _DOUBLE[0]), ("Y2", page.Y2, _DOUBLE[1]))
    for key, Y, product in pairs:
        if Y is None or (key == "Y") == two:
            continue
        if abs(page.e * Y / product - 1.0) > _APART:
            yield (
                f"e is {page.e:g} and {key} {Y:g}, but their product must be {product:g} to "
                f"{100 * _APART:.0f} %, as of one contact angle: correct one of them"
            )


def _wrong_kind(page: CataloguePage) -> Iterator[str]:
    kind, two = page.of_kind, page.row_count == 2
    if (page.arrangement is not None) != (kind == "double_row_tapered"):
        yield (
            "arrangement is given: leave it out, or make kind double_row_tapered"
            if page.arrangement
            else "arrangement is missing: give X (face to face) or O of two tapered rows"
        )
    if page.Y is not None and two:
        yield "Y is that of one row: give Y1 and Y2, as the page prints them of two"
    if (page.Y1 is not None or page.Y2 is not None) and not two:
        yield "Y1 and Y2 are those of two rows: give Y"
    if kind in ("cylindrical", "toroidal"):
        stated = [k for k in ("e", "Y", "Y0", "contact_angle") if getattr(page, k) is not None]
        if stated:
            yield (
                f"{', '.join(stated)} of a {kind} bearing, which carries no axial force here: "
                f"leave {'it' if len(stated) == 1 else 'them'} out"
            )
    if (page.F is not None or page.E is not None) and kind != "cylindrical":
        yield f"F and E are those of cylindrical bearings, not of kind {kind}: leave them out"
    if page.rows is not None and kind != "cylindrical":
        yield f"rows are those of cylindrical bearings, not of kind {kind}: leave them out"
    if page.f0 is not None and kind != "ball":
        yield f"f0 is that of ball bearings, not of kind {kind}: leave it out"
    if page.element_length is not None and kind == "ball":
        yield "element_length is that of rollers, not of balls: leave it out"


def _stated(value: Any) -> Any:
    if isinstance(value, Mapping):
        return CataloguePage.read(dict(value), "catalogue")
    return digits_as_text(value)


#: The name of an entry of a bearing catalogue, or what a catalogue's page prints.
EntryOrPage = Annotated[
    Annotated[str, Field(min_length=1, max_length=100)] | CataloguePage, BeforeValidator(_stated)
]


def entry_name(named: str | CataloguePage | None) -> str | None:
    """Name of a catalogue's entry, or the designation of a page; None of none."""
    return named.designation if isinstance(named, CataloguePage) else named
