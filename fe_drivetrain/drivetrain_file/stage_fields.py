"""What fields of gear stages are made of: values of each gear by name, and their ranges."""

from typing import Annotated, Any, Generic, NamedTuple, TypeVar

from pydantic import BeforeValidator, Field, PlainSerializer

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.turning_parts import MAX_DAMPING
from fe_drivetrain.geometry.part import dimension

T = TypeVar("T")


class RingPlanetSun(NamedTuple, Generic[T]):
    """A value of each gear of a planetary stage."""

    ring: T
    planet: T
    sun: T


class GearPinion(NamedTuple, Generic[T]):
    """A value of each gear of a parallel stage."""

    gear: T
    pinion: T


class SunPlanet(NamedTuple, Generic[T]):
    """A value of the gears that determine the size of a planetary stage without teeth."""

    sun: T
    planet: T


def _by_name(value: Any) -> Any:
    """Refuse a list in a file, whose order a reader would have to know."""
    if isinstance(value, list):
        raise InputError(
            f"{value} is a list but must name each gear, as in {{ring: 99, planet: 39, sun: 21}} "
            "or {gear: 82, pinion: 23}: name them"
        )
    return value


NAMED = BeforeValidator(_by_name), PlainSerializer(lambda value: value and value._asdict())

Shift = Annotated[float, Field(gt=-3, lt=3)]
Fillet = Annotated[float, Field(ge=0, le=1)]


def shifts() -> Any:
    """Declare profile shifts of all gears of a stage; none where nothing is given."""
    return Field(default=None, description="profile shifts in modules; of a ring as ISO 21771")


def _of_each(of: str, source: str) -> Any:
    """Declare numbers of all gears of a stage; none where nothing is given."""
    return Field(default=None, description=of, json_schema_extra={"unit": "", "source": source})


def tips() -> Any:
    """Declare tip diameters."""
    return _of_each("tip diameters, m", "assumed: an addendum of a module")


def faces() -> Any:
    """Declare face widths."""
    return _of_each("face widths, m", "assumed: each as wide as the face in contact")


def fillets() -> Any:
    """Declare tip radii of racks."""
    return _of_each("tip radii of the racks, in modules", "assumed: 0.38 modules, ISO 53")


def mesh_damping() -> Any:
    """Declare the damping of a mesh, as ``stiffness_of`` says."""
    return dimension(
        0.0,
        of="damping of the mesh, as stiffness_of says, N s/m or",
        unit="N m s/rad",
        ge=0,
        le=MAX_DAMPING,
        source="assumed: meshes without damping",
    )
