"""Base of every parametric part: frozen, no unknown keys, one-sentence errors."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple, Self

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    ModelWrapValidatorHandler,
    ValidationError,
    field_validator,
    model_validator,
)
from pydantic.fields import FieldInfo

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import fault_sentence
from fe_drivetrain.common.strict_yaml import no_truth_value, shown

LENGTH_TOLERANCE = 1e-9
"""Two lengths closer than this (m) are the same length."""

MINIMUM, MAXIMUM = 1e-6, 1e4
"""A length (m) beyond these is a slip of the pen: CAD cannot tell it from nothing, or from far."""


_SLIP = 100.0
"""Beyond its limit by more than this factor, a length is likely to be in millimetres."""


def slip_of_units(value: float, limit: float) -> str:
    """Sentence that a message adds where a length may have been given in the wrong unit.

    Parameters
    ----------
    value, limit : float
        Length, and what it must be less than, or more, m.

    Returns
    -------
    str
        Text such as " (lengths are in metres: 1.42 m if this was in millimetres)"; empty where the
        length is near to its limit, or in millimetres would be no better.
    """
    if limit > 0 and _SLIP * limit < value:
        return f" (lengths are in metres: {value / 1000:g} m if this was in millimetres)"
    return ""


class Assumption(NamedTuple):
    """One dimension of a part, and where its value comes from."""

    name: str
    value: float | str
    unit: str
    source: str

    @property
    def is_assumed(self) -> bool:
        """Whether it is neither given nor from a source."""
        return self.source.startswith("assumed")


def dimension(
    default: Any = ...,
    *,
    of: str,
    unit: str = "m",
    source: str = "",
    gt: float | None = None,
    ge: float | None = None,
    le: float | None = None,
) -> Any:
    """Declare a field that carries its unit and the source of its default value.

    Parameters
    ----------
    default : Any
        Default value; required where left out.
    of : str
        Quantity that the number measures, in a few words.
    unit : str
        Unit of the number.
    source : str
        Source of the default: a catalogue, or 'assumed: reason'.
    gt, ge : float or None
        Lower bounds, exclusive and inclusive. A length lies between `MINIMUM` and `MAXIMUM`, too,
        where it must be greater than 0; else it is at most `MAXIMUM`, with either sign.
    le : float or None
        Upper bound; of a length `MAXIMUM` where not given.
    """
    if unit == "m":
        ge = MINIMUM if gt == 0 else -MAXIMUM if ge is None else ge
    return Field(
        default,
        description=f"{of}, {unit}" if unit != "-" else of,
        gt=gt,
        ge=ge,
        le=MAXIMUM if unit == "m" and le is None else le,
        json_schema_extra={"unit": unit, "source": source},
    )


def kind_of(row: Any) -> Any:
    """For pydantic's ``Discriminator``: the kind of a part; rows of a file have become parts."""
    return getattr(row, "kind", None)


def rows_of(what: str, of: type[Part] | Mapping[str, type[Part]]) -> Any:
    """For pydantic's ``field_validator(..., mode="before")``: rows of a file become parts.

    A fault names its row, counted from one.

    Parameters
    ----------
    what : str
        Name of a row, in messages.
    of : type or mapping of str to type
        Part of the row, or parts by their ``kind``.

    Returns
    -------
    callable
        Function from a list of mappings, or of anything else, to one with parts for the mappings.
    """

    def one(row: Mapping[str, Any]) -> Part:
        if not isinstance(of, Mapping):
            return of.model_validate(row)
        kind = row.get("kind")
        if not (isinstance(kind, str) and kind in of):
            raise InputError(f"kind is {shown(kind)} but must be one of {', '.join(of)}: change it")
        return of[kind].model_validate(row)

    def rows(value: Any) -> Any:
        if not isinstance(value, list | tuple):
            return value
        found = []
        for number, item in enumerate(value, start=1):
            try:
                found.append(one(item) if isinstance(item, Mapping) else item)
            except InputError as error:
                raise InputError(f"{what} {number}: {bare_sentence(error)}") from None
        return found

    return rows


def in_its_field(value: Any, handler: Any, info: Any) -> Any:
    """For pydantic's ``field_validator(..., mode="wrap")``: a part's fault names its field."""
    try:
        return handler(value)
    except InputError as error:
        raise InputError(f"{info.field_name}: {bare_sentence(error)}") from None


class PartError(InputError):
    """A fault of a part.

    Parameters
    ----------
    sentence : str
        With what kind of part it is of.
    bare : str
        Without, for where a field or a row says so.
    """

    def __init__(self, sentence: str, bare: str = "") -> None:
        super().__init__(sentence)
        self.bare = bare or sentence


def bare_sentence(error: InputError) -> str:
    """A sentence about a part without its kind, for where a field or a row says so."""
    return error.bare if isinstance(error, PartError) else str(error)


def _in_words(name: str) -> str:
    """Name of a class of parts as words: "ForeignHousing" is a foreign housing."""
    words = re.findall(r"[A-Z][a-z]*", name.removesuffix("Data").removesuffix("Row"))
    return " ".join(words).lower()


def _extra(field: FieldInfo, key: str) -> str:
    extra = field.json_schema_extra
    return str(extra.get(key, "")) if isinstance(extra, dict) else ""


class Part(BaseModel):
    """Base of every part: a wrong value raises `InputError` with one sentence.

    `InputError` is no `ValueError`, so pydantic lets it through as it is; that holds for a part
    built in Python as well as for one read from a scene file.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False, defer_build=True)

    _truth = field_validator("*", mode="before")(no_truth_value)

    @model_validator(mode="wrap")
    @classmethod
    def _one_sentence(cls, data: Any, handler: ModelWrapValidatorHandler[Self]) -> Self:
        try:
            return handler(data)
        except ValidationError as error:
            sentence = fault_sentence(error, cls)
            raise PartError(f"{_in_words(cls.__name__)}: {sentence}", sentence) from None

    def assumptions(self) -> list[Assumption]:
        """List every dimension with its value, unit and source.

        Returns
        -------
        list of Assumption
            Assumptions (name, value, unit, source); a value that differs from the default is
            reported as given by the scene, since the source of the default no longer speaks for it.
        """
        rows = []
        for name, field in type(self).model_fields.items():
            source, value = _extra(field, "source"), getattr(self, name)
            if not source:
                continue
            given = value != field.default
            rows.append(
                Assumption(
                    name,
                    value if value is not None else "derived",
                    _extra(field, "unit"),
                    "given by the scene" if given else source,
                )
            )
        return rows


def assumed_in(parts: Sequence[tuple[str, Part]]) -> list[Assumption]:
    """Assumed values of parts, by the name of each part and its key."""
    return [
        row._replace(name=f"{owner}: {row.name}")
        for owner, part in parts
        for row in part.assumptions()
        if row.is_assumed
    ]
