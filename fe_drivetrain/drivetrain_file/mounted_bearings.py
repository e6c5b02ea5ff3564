"""Operating clearance of a drivetrain's bearings, from how its file says they are mounted."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fe_drivetrain.bearing.entry_clearance import entry_clearance
from fe_drivetrain.bearing.mounting import Fit
from fe_drivetrain.bearing.operating_clearance import RING_STEEL, OperatingClearance
from fe_drivetrain.bearing.press_fits import RingMaterial
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import Material
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.turning_parts import BearingData, PinData
from fe_drivetrain.geometry import Housing

if TYPE_CHECKING:
    from fe_drivetrain.bearing.catalogue import Entry


def unit_clearance(scene: Scene, name: str, entry: Entry) -> OperatingClearance | None:
    """Operating clearance of a bearing of the main shaft; None where no mounting is stated.

    The shaft's bore and the shell of a pillow block are those of the scene where `Fit` does not
    state them, materials those of the parts; rings are of the bearing's material.

    Parameters
    ----------
    scene : Scene
        The scene.
    name : str
        Name of the bearing.
    entry : Entry
        Its entry of a catalogue.

    Raises
    ------
    InputError
        A diameter, a clearance class or a coefficient of expansion is missing or wrong.
    """
    unit = scene.bearing_unit(name)
    mounting = unit.mounting
    if mounting is None:
        return None
    fit = mounting.fit
    if fit is not None:
        mounting = mounting.model_copy(update={"fit": _with_seats(scene, name, fit)})
    warm = mounting.temperatures
    if warm is not None:
        housing = next((part for part in unit.housing_parts if part.endswith(".housing")), name)
        stated = {"shaft": scene.temperatures.get("shaft")}
        stated["housing"] = scene.temperatures.get(housing)
        own = {key: value for key, value in stated.items() if getattr(warm, key) is None}
        mounting = mounting.model_copy(update={"temperatures": warm.model_copy(update=own)})
    parts = (name, "shaft", *(part for part in unit.housing_parts if part.endswith(".housing")))
    rings, shaft, *seats = (
        _ring(scene.material_of(part), part, warm is not None) for part in parts
    )
    try:
        return entry_clearance(entry, mounting, shaft, seats[0] if seats else rings, rings)
    except InputError as error:
        raise InputError(f"bearing {name!r}: {error}") from None


def row_clearance(row: BearingData | PinData, entry: Entry) -> OperatingClearance | None:
    """Operating clearance of a bearing of the gearbox, all of steel; None without a mounting.

    Parameters
    ----------
    row : BearingData or PinData
        The bearing.
    entry : Entry
        Its entry of a catalogue.

    Raises
    ------
    InputError
        A diameter or a clearance class is missing or wrong.
    """
    if row.mounting is None:
        return None
    try:
        return entry_clearance(entry, row.mounting)
    except InputError as error:
        raise InputError(f"bearing {row.name!r}: {error}") from None


def clearance_change(given: float | None, found: OperatingClearance | None) -> dict[str, float]:
    """Change of a catalogue entry by a clearance that is given, or that follows from a mounting.

    Parameters
    ----------
    given : float or None
        Along the contact normal [m], as a row of a drivetrain has it.
    found : OperatingClearance or None
        Comes before it.
    """
    if found is not None:
        return {"clearance": found.along_normal.mean}
    return {} if given is None else {"clearance": given}


def _with_seats(scene: Scene, name: str, fit: Fit) -> Fit:
    """The fit with the diameters that the scene knows."""
    unit = scene.bearing_unit(name)
    known: dict[str, float] = {}
    if fit.shaft_bore is None:
        known["shaft_bore"] = 2.0 * scene.shaft.inner_radius(unit.bearing.x)
    if fit.housing_diameter is None and isinstance(unit.housing, Housing):
        known["housing_diameter"] = unit.bearing.raceway_diameter + 2.0 * unit.housing.wall
    return fit.model_copy(update=known)


def _ring(material: Material, part: str, warm: bool) -> RingMaterial:
    return RingMaterial(
        material.youngs_modulus,
        material.poisson_ratio,
        material.density,
        material.expansion(part) if warm else material.thermal_expansion or RING_STEEL.expansion,
    )
