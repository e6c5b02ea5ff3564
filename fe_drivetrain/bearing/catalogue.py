"""Bearings by name, from catalogue files in YAML: every number with its source.

The package's own is ``bearings.yaml``; files of a user extend it, and replace entries of the same
name.
"""

from __future__ import annotations

import math
from functools import cache
from importlib.resources import files as package_files
from pathlib import Path
from typing import Any, Literal, Self, TypeAlias

from pydantic import BaseModel, ConfigDict, Field, field_validator, model_validator

from fe_drivetrain.bearing.arrangements import (
    Arrangement,
    ball_row,
    cylindrical,
    double_row_tapered,
    spherical_roller,
    tapered_row,
    toroidal,
)
from fe_drivetrain.bearing.catalogue_page import MEMBERS, CataloguePage
from fe_drivetrain.bearing.contact import ContactLaw, houpert, iso_line
from fe_drivetrain.bearing.designations import Kind
from fe_drivetrain.bearing.fitted_rollers import FittedRollers, fitted_rollers
from fe_drivetrain.bearing.geometry import LAMINAE, Bearing
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping, read_text, validated
from fe_drivetrain.common.strict_yaml import no_truth_value

Named: TypeAlias = str | CataloguePage
"""What a drivetrain's file says of a bearing: the name of an entry, or a catalogue's page."""

_SOURCED = (
    "elements",
    "element_diameter",
    "element_length",
    "pitch_diameter",
    "contact_angle",
    "spread",
    "bore",
    "ratings",
    "limiting_speed_rpm",
)

#: What each kind needs beside number, diameter and pitch diameter, and nothing else of these.
_NEEDS = {
    "double_row_tapered": ("arrangement", "element_length", "contact_angle", "spread", "law"),
    "single_row_tapered": ("element_length", "contact_angle", "law"),
    "spherical_roller": ("element_length", "contact_angle", "law"),
    "cylindrical": ("element_length", "law"),
    "toroidal": ("element_length", "law"),
    "ball": ("contact_angle",),
}


FITTED = "assumed: one of the insides that fit the page"
"""Source of an inside that nobody states."""


class Printed(BaseModel):
    """Ratings as a catalogue prints them [N]."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    C: float | None = Field(default=None, gt=0, description="basic dynamic load rating [N]")
    C0: float | None = Field(default=None, gt=0, description="basic static load rating [N]")
    Cu: float | None = Field(default=None, gt=0, description="fatigue load limit [N]")


class Entry(BaseModel):
    """One bearing of a catalogue; lengths in m, angles in deg."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)

    title: str = Field(description="one line")
    kind: Kind = Field(description="kind of bearing")
    arrangement: Arrangement | None = Field(default=None, description="X or O")
    elements: int = Field(description="rolling elements of one row")
    element_diameter: float = Field(description="diameter of a roller's middle, or a ball [m]")
    element_length: float | None = Field(default=None, description="effective length [m]")
    pitch_diameter: float = Field(description="circle of the elements' middles [m]")
    contact_angle: float | None = Field(default=None, description="contact angle [deg]")
    spread: float | None = Field(default=None, description="distance of the rows' middles [m]")
    bore: float | None = Field(default=None, gt=0, description="bore of the inner ring [m]")
    law: Literal["houpert", "iso"] | None = Field(default=None, description="contact law")
    clearance: float = Field(default=0.0, description="clearance along the contact normal [m]")
    laminae: int = Field(default=LAMINAE, description="laminae of a roller; 0 is the closed form")
    crown: float = Field(default=0.0, description="profile factor over the diameter [-]")
    ratings: Printed | None = Field(default=None, description="ratings as printed in a catalogue")
    series: str | None = Field(
        default=None, min_length=1, description="series of a maker's catalogue, for its friction"
    )
    seal_diameter: float | None = Field(
        default=None, gt=0, description="diameter on which both of its seals rub [m], for friction"
    )
    limiting_speed_rpm: float | None = Field(
        default=None, gt=0, description="that the catalogue allows [1/min]"
    )
    scenes: list[str] = Field(default=[], description="library scenes that it stands in")
    groove: tuple[float, float] = Field(
        default=(0.52, 0.53), description="radii of the grooves over the diameter of balls [-]"
    )
    page: CataloguePage | None = Field(
        default=None, description="what the catalogue's page prints beside: D, B, e, Y and so on"
    )
    sources: dict[str, str] = Field(description="where each number comes from, or assumed: why")

    _truth = field_validator("*", mode="before")(no_truth_value)

    @model_validator(mode="after")
    def _complete(self) -> Self:
        needs = _NEEDS[self.kind]
        for name in ("arrangement", "element_length", "contact_angle", "spread", "law"):
            given = getattr(self, name) is not None
            if given != (name in needs):
                raise InputError(
                    f"{name} of {self.title!r} is {'given' if given else 'missing'}: a bearing of "
                    f"kind {self.kind} needs {', '.join(needs)}, and no more"
                )
        stated = {name for name in _SOURCED if getattr(self, name) is not None}
        if stated != self.sources.keys():
            wrong = ", ".join(sorted(stated ^ self.sources.keys()))
            raise InputError(
                f"sources of {self.title!r} must name each number that is given, and no other; see "
                f"{wrong}: say where it comes from, or 'assumed: why'"
            )
        if self.bore is not None and self.bore >= self.inside:
            raise InputError(
                f"bore of {self.title!r} is {self.bore:g} m but must be less than {self.inside:g} "
                "m, the diameter inside its rolling elements: correct one of them"
            )
        return self

    @property
    def inside(self) -> float:
        """Diameter of the circle that the rolling elements touch from outside, about [m]."""
        angle = math.radians(self.contact_angle or 0.0)
        return self.pitch_diameter - self.element_diameter * math.cos(angle)

    @property
    def assumed(self) -> list[str]:
        """The numbers that no source gives."""
        return [name for name, text in self.sources.items() if text.startswith("assumed")]

    @property
    def fitted(self) -> bool:
        """Whether its inside is one of those that fit its page, and not known."""
        return self.page is not None and self.sources["elements"] == FITTED

    def bearing(self, name: str) -> Bearing:
        """The bearing.

        Parameters
        ----------
        name : str
            Name for messages and reports.

        Returns
        -------
        bearing : Bearing
            Upwind row first; a single tapered row carries an inner ring that is pushed downwind.

        Raises
        ------
        InputError
            Sizes that do not fit each other.
        """
        size = (self.elements, self.element_diameter)
        angle = self.contact_angle or 0.0
        if self.kind == "ball":
            return Bearing(
                name,
                (
                    ball_row(
                        *size,
                        self.pitch_diameter,
                        angle,
                        inner_conformity=self.groove[0],
                        outer_conformity=self.groove[1],
                        radial_clearance=2 * self.clearance,
                    ),
                ),
            )
        assert self.element_length is not None
        law: ContactLaw = (
            houpert(self.element_length, self.element_diameter)
            if self.law == "houpert"
            else iso_line(self.element_length)
        )
        more: dict[str, Any] = {
            "clearance": self.clearance,
            "laminae": self.laminae,
            "crown": self.crown * self.element_diameter,
            "law": law,
        }
        body = (*size, self.element_length, self.pitch_diameter)
        if self.kind == "double_row_tapered":
            assert self.spread is not None
            assert self.arrangement is not None
            return double_row_tapered(name, *body, angle, self.spread, self.arrangement, **more)
        if self.kind == "single_row_tapered":
            return Bearing(name, (tapered_row(*body, angle, **more),))
        if self.kind == "spherical_roller":
            return spherical_roller(name, *body, angle, **more)
        if self.kind == "cylindrical" and self.page is not None and self.page.row_count == 2:
            apart = 0.25 * self.page.sizes.width
            return cylindrical(name, *body, places=(-apart, apart), **more)
        make = cylindrical if self.kind == "cylindrical" else toroidal
        return make(name, *body, **more)


def read_bearing_catalogue(*more: str | Path) -> dict[str, Entry]:
    """All bearings by name: the package's, and those of files.

    Parameters
    ----------
    *more : str or Path
        Catalogue files, later ones before earlier ones.

    Returns
    -------
    entries : dict
        Entries by name.

    Raises
    ------
    InputError
        A file cannot be read, or an entry is wrong.
    """
    entries = dict(_own())
    for path in more:
        entries |= read_entries(path)
    return entries


def read_entries(path: str | Path) -> dict[str, Entry]:
    """All bearings of one file by name, without those of the package.

    Parameters
    ----------
    path : str or Path
        The catalogue file.

    Returns
    -------
    entries : dict
        Entries by name.

    Raises
    ------
    InputError
        The file cannot be read, or an entry is wrong.
    """
    return _parsed(read_text(path, "bearing catalogue"), str(path))


def catalogue_bearing(name: Named, *more: str | Path, **changes: Any) -> Bearing:
    """A bearing of the catalogue, with other values where given.

    Parameters
    ----------
    name : str or CataloguePage
        Name of the entry, or a page, whose inside is then fitted.
    *more : str or Path
        Catalogue files beside the package's.
    **changes : Any
        Fields of `Entry`, as ``contact_angle=20``.

    Returns
    -------
    bearing : Bearing
        Bearing named as the entry.

    Raises
    ------
    InputError
        No such entry, or values that do not fit.
    """
    return catalogue_entry(name, *more, **changes).bearing(name_of(name))


def catalogue_entry(name: Named, *more: str | Path, **changes: Any) -> Entry:
    """Catalogue entry of a bearing; see `catalogue_bearing`.

    Parameters
    ----------
    name : str or CataloguePage
        Name of the entry, or a page, whose inside is then fitted.
    *more : str or Path
        Catalogue files beside the package's.
    **changes : Any
        Fields of `Entry`.

    Returns
    -------
    entry : Entry
        Entry with its changes, checked.

    Raises
    ------
    InputError
        No such entry, or values that do not fit.
    """
    if isinstance(name, CataloguePage):
        entry = fitted_entry(name)
    else:
        entries = read_bearing_catalogue(*more)
        if name not in entries:
            known = ", ".join(entries)
            raise InputError(f"bearing {name!r} is in no catalogue: use one of {known}")
        entry = entries[name]
    return changed_entry(entry, name_of(name), **changes)


def changed_entry(entry: Entry, name: str, **changes: Any) -> Entry:
    """An entry with other values, checked; the same one where none is given.

    Parameters
    ----------
    entry : Entry
        The entry.
    name : str
        Its name, for messages.
    **changes : Any
        Fields of `Entry`.

    Raises
    ------
    InputError
        Values that do not fit.
    """
    if not changes:
        return entry
    stated = entry.model_dump(include=entry.model_fields_set)
    return validated(Entry, stated | changes, f"bearing {name}")


def name_of(named: Named) -> str:
    """Name of an entry, or designation of a page."""
    return named.designation if isinstance(named, CataloguePage) else named


def insides_of_page(page: CataloguePage) -> FittedRollers:
    """All insides that fit a page, whichever of them it states."""
    return fitted_rollers(page.model_copy(update={"inside": None}), MEMBERS)


def fitted_entry(
    page: CataloguePage, member: int | None = None, fitted: FittedRollers | None = None
) -> Entry:
    """A bearing with one of the insides that fit a catalogue's page.

    Parameters
    ----------
    page : CataloguePage
        The page.
    member : int, optional
        Which of them; where left out, that of the page, or the one nearest to the medians of all.
    fitted : FittedRollers, optional
        The insides; `MEMBERS` of them where left out.

    Returns
    -------
    entry : Entry
        With the page, and its rollers as assumed. Its profile is that of the standard, times that
        of the member where ``member`` is given, for which `FittedRollers.crown` is.

    Raises
    ------
    InputError
        No inside fits.
    """
    member = page.inside if member is None else member
    found = insides_of_page(page) if fitted is None else fitted
    if member is not None and member >= len(found):
        raise InputError(
            f"inside of {page.designation} is {member} but must be from 0 to {len(found) - 1}, of "
            "those that fit its page: correct it, or leave it out"
        )
    inside = found.fields(found.middle if member is None else member)
    data: dict[str, Any] = {
        "title": f"{page.designation}, by its catalogue's page",
        "kind": page.of_kind,
        "bore": page.sizes.bore,
        "ratings": {"C": page.C, "C0": page.C0, "Cu": page.Cu},
        "page": page,
        **inside,
        "sources": {key: FITTED for key in inside if key in _SOURCED}
        | {"bore": "the page", "ratings": page.source},
    }
    if page.of_kind == "ball":
        if member is not None:
            data["groove"] = (float(found.conformity[member]),) * 2
        if page.angle == 0.0:
            data["contact_angle"] = 0.0
    else:
        data["law"] = "iso"
    for key in ("arrangement", "clearance", "limiting_speed_rpm"):
        if getattr(page, key) is not None:
            data[key] = getattr(page, key)
    if page.limiting_speed_rpm is not None:
        data["sources"]["limiting_speed_rpm"] = page.source
    return validated(Entry, data, f"page of {page.designation}")


@cache
def _own() -> dict[str, Entry]:
    text = package_files("fe_drivetrain.bearing").joinpath("bearings.yaml").read_text("utf-8")
    return _parsed(text, "bearings.yaml")


def _parsed(text: str, source: str) -> dict[str, Entry]:
    found = {}
    faults: list[str] = []
    for name, data in parse_mapping(text, source).items():
        try:
            found[name] = _one_parsed(data, f"{source}: {name}")
            found[name].bearing(name)  # sizes that fit each other
        except InputError as error:
            faults.append(str(error))
    if len(faults) > 1:
        listed = "; ".join(f"[{number}] {one}" for number, one in enumerate(faults, start=1))
        raise InputError(f"{source} has {len(faults)} entries with faults: {listed}")
    if faults:
        raise InputError(faults[0])
    return found


def _one_parsed(data: Any, source: str) -> Entry:
    """An entry of a file: a bearing with its inside, or a catalogue's page."""
    if isinstance(data, dict) and "designation" in data:
        return fitted_entry(CataloguePage.read(data, source))
    return validated(Entry, data, source)
