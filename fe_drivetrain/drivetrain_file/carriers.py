"""Planet carriers that give: components that stages of a drivetrain's file name."""

from __future__ import annotations

from pathlib import Path

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.component import CarrierComponent
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryStage
from fe_drivetrain.drivetrain_file.reading import library_component, read_component
from fe_drivetrain.drivetrain_file.stage_completion import NotGivenError, completed

#: Distance of pins from the circle of the planets, over its diameter, that is allowed.
PLACED = 1e-6


def carriers_of(drivetrain: Drivetrain) -> dict[int, CarrierComponent]:
    """Carriers of planetary stages by number, from 1, as far as the file names their components.

    Parameters
    ----------
    drivetrain : Drivetrain
        The drivetrain; stages without all that turns are not held to a circle.

    Raises
    ------
    InputError
        A component is not there, is no planet carrier, has another number of pins, or pins on
        another circle.
    """
    found = {}
    for number, stage in enumerate(drivetrain.gearbox.stages, start=1):
        if not isinstance(stage, PlanetaryStage) or stage.carrier is None:
            continue
        if stage.carrier.component is not None:
            found[number] = _carrier(stage, stage.carrier.component, f"stage {number}")
    return found


def _carrier(stage: PlanetaryStage, name: str, of: str) -> CarrierComponent:
    component = read_component(name) if Path(name).suffix else library_component(name)
    if not isinstance(component, CarrierComponent):
        raise InputError(
            f"{of}: carrier.component {name!r} is no planet carrier: name a component with the "
            "key planet_carrier"
        )
    body = component.planet_carrier
    if body.planets != stage.planets:
        raise InputError(
            f"{of}: carrier {name!r} has {body.planets} pins but the stage has {stage.planets} "
            "planets: make them the same"
        )
    try:
        circle = 2 * completed(stage, of).stage.centre_distance
    except NotGivenError:
        return component
    if abs(body.pin_circle_diameter - circle) > PLACED * circle:
        raise InputError(
            f"{of}: pins of carrier {name!r} are on a circle of {body.pin_circle_diameter:g} m but "
            f"the planets on one of {circle:.7g} m, twice the centre distance: correct "
            "planet_carrier.pin_circle_diameter"
        )
    return component
