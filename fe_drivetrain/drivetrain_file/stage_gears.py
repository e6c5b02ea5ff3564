"""Gears of a stage that has all of their data, as the pairs that mesh in it."""

from math import radians

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData
from fe_drivetrain.gear.involute import Gear, Pair, Rack


def stage_pairs(stage: PlanetaryData | ParallelData, name: str) -> dict[str, Pair]:
    """Pairs of gears of a stage: "sun-planet" and "ring-planet", or "mesh", the pinion first.

    Parameters
    ----------
    stage : PlanetaryData or ParallelData
        Stage with teeth, module and profile shifts.
    name : str
        Name of the stage in messages.

    Raises
    ------
    InputError
        The stage lacks data, or its gears do not fit.
    """
    gears = _gears(stage, name)
    try:
        if isinstance(stage, PlanetaryData):
            ring, planet, sun = gears
            return {
                "sun-planet": Pair(sun, planet, stage.centre_distance),
                "ring-planet": Pair(planet, ring, stage.centre_distance),
            }
        wheel, pinion = gears
        return {"mesh": Pair(pinion, wheel, stage.centre_distance)}
    except InputError as error:
        raise InputError(f"{name}: {error}") from None


def _gears(stage: PlanetaryData | ParallelData, name: str) -> list[Gear]:
    """Gears of a stage in the order of the teeth."""
    if stage.teeth is None or stage.module is None or stage.shifts is None:
        raise InputError(f"{name} has no full data of its gears: give teeth, module and shifts")
    count = len(stage.teeth)
    fillets = stage.fillets or count * (Rack().fillet,)
    helix = stage.hand * radians(stage.helix)
    planetary = isinstance(stage, PlanetaryData)
    # a sun is opposite to its planets, and they are as their ring; a wheel opposite to its pinion
    helices = (-helix, -helix, helix) if planetary else (helix, -helix)
    signs = (-1, 1, 1) if planetary else (1, 1)
    found = []
    for k, teeth in enumerate(stage.teeth):
        try:
            found.append(
                Gear(
                    signs[k] * teeth,
                    stage.module,
                    stage.faces[k] if stage.faces else stage.face_width,
                    helices[k],
                    stage.shifts[k],
                    pressure_angle=radians(stage.pressure_angle),
                    rack=Rack(dedendum=stage.dedendum, fillet=fillets[k]),
                    tip_diameter=stage.tips[k] if stage.tips else None,
                )
            )
        except InputError as error:
            raise InputError(f"{name}: {error}") from None
    return found
