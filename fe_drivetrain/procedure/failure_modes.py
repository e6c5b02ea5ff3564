"""Design loads and failure modes by component, and which of them today's load cases cover.

The package's own catalogue is ``failure_modes.yaml``, Tables 4.1 to 4.4, 5.1, 5.2, 6.1 and 6.2 of
PROTEST 2010; a user's file has the same form.
"""

from __future__ import annotations

from functools import cache
from importlib.resources import files as package_files
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import BaseModel, ConfigDict, field_validator, model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping, read_text, validated

Kind = Literal["ultimate", "fatigue", "contact", "rating", "interference", "constraint", "wear"]
"""Kind of a design load: what it is checked for."""

ROTOR_TORQUE = "rotor torque"
REVERSALS = "torque reversals"
MISALIGNMENT = "misalignment in the drivetrain"
DIPS = "low voltage ride through"
RESONANCE = "resonance"
OVERLOAD = "operation at overload"
ELECTRICAL_FAULT = "external or internal electrical fault"
HIGH_SPEED_REVERSALS = "torque oscillation with reversals of the high-speed shaft"
GEAR_RATING = "gear rating: pitting and bending, scuffing, micropitting, static strength"
BEARING_RATING = (
    "bearing rating: subsurface and surface fatigue, adhesive wear, frictional corrosion, overload"
)
TORQUE_AND_BENDING = "torque and bending of main shaft, high-speed shaft, couplings, bearings"
"""Design loads of the catalogue that results of the program are values of."""

Covered = Literal["yes", "partly", "no"]
"""Whether the external condition that brings the load about is one of the load cases."""


LAST_OF_GROUP = {1: 5, 2: 4, 3: 3, 4: 2, 5: 1, 6: 4, 7: 1, 8: 2}
NUMBERS = {
    ("IEC 61400-1", "3"): tuple(
        f"{group}.{k}" for group, last in LAST_OF_GROUP.items() for k in range(1, last + 1)
    )
}
"""Load cases by standard and edition: Table 2 of IEC 61400-1:2005, from memory, not verified."""


class _Row(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class LoadCase(_Row):
    """A design load case; a number means nothing without standard and edition."""

    standard: str
    edition: str
    number: str
    note: str = ""


class DesignLoad(_Row):
    """A load that a component is designed for.

    `system` and `part` are of the breakdown (or "general"), `table` that of the source, `variables`
    the critical design variables, `remedy` what to run where no load case covers the load.
    """

    name: str
    system: str
    part: str
    table: str
    kinds: tuple[Kind, ...]
    covered: Covered
    cases: tuple[LoadCase, ...] = ()
    variables: tuple[str, ...] = ()
    note: str = ""
    remedy: str = ""

    @model_validator(mode="after")
    def _gap_has_a_remedy(self) -> Self:
        if self.covered != "yes" and not self.remedy:
            raise InputError(
                f"design load {self.name!r} is covered {self.covered!r} and has no remedy: state "
                "what is run in its place, as 'remedy: ...'"
            )
        return self


class Catalogue(_Row):
    """Breakdown into components, and their design loads."""

    title: str
    components: dict[str, tuple[str, ...]]
    design_loads: tuple[DesignLoad, ...]

    @field_validator("design_loads")
    @classmethod
    def _one_of_each_name(cls, value: Any) -> Any:
        names = [load.name for load in value]
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"two design loads are called {name!r}: rename one")
        return value

    @model_validator(mode="after")
    def _of_known_parts(self) -> Self:
        for load in self.design_loads:
            known = ("general", *self.components.get(load.system, ()))
            if load.system not in self.components or load.part not in known:
                raise InputError(
                    f"design load {load.name!r} is of {load.system!r}, {load.part!r}, which is not "
                    f"in the breakdown: use a system of {', '.join(self.components)} and one of "
                    "its "
                    "parts, or 'general'"
                )
        return self

    @property
    def uncovered(self) -> tuple[DesignLoad, ...]:
        """Loads that no load case, or none in full, brings about."""
        return tuple(load for load in self.design_loads if load.covered != "yes")

    def of(self, system: str) -> tuple[DesignLoad, ...]:
        """Design loads of one system.

        Parameters
        ----------
        system : str
            System of the breakdown.

        Raises
        ------
        InputError
            There is no such system.
        """
        if system not in self.components:
            raise InputError(
                f"no system {system!r} in the catalogue: use one of {', '.join(self.components)}"
            )
        return tuple(load for load in self.design_loads if load.system == system)


def parse_catalogue(text: str, source: str = "catalogue") -> Catalogue:
    """Read a catalogue from YAML text.

    Parameters
    ----------
    text : str
        YAML in the form of the package's own.
    source : str
        Where it comes from, for messages.

    Returns
    -------
    Catalogue

    Raises
    ------
    InputError
        It is not in that form.
    """
    return validated(Catalogue, parse_mapping(text, source), source)


def read_catalogue(path: str | Path) -> Catalogue:
    """Read a catalogue from a file.

    Parameters
    ----------
    path : str or Path
        YAML in the form of the package's own.

    Returns
    -------
    Catalogue

    Raises
    ------
    InputError
        The file cannot be read, or is not in that form.
    """
    return parse_catalogue(read_text(path, "catalogue"), str(path))


@cache
def protest_catalogue() -> Catalogue:
    """The package's own catalogue: the tables of PROTEST 2010."""
    text = (
        package_files("fe_drivetrain.procedure").joinpath("failure_modes.yaml").read_text("utf-8")
    )
    return parse_catalogue(text, "failure_modes.yaml")
