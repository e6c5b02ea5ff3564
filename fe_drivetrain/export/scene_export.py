"""Which superelement of a scene is exported: the same names for the command line and Python."""

from __future__ import annotations

from collections.abc import Sequence

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.export.from_scene import (
    shaft_superelement,
    supported_superelement,
    unit_superelement,
)
from fe_drivetrain.export.seat_superelements import seats_superelement
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.shafts.fidelity.ladder import assembly_level, housing_springs, shaft_level
from fe_drivetrain.shafts.fidelity.shafts import condensed_shaft

SHAFT, DRIVETRAIN, SEATS = "shaft", "drivetrain", "seats"
AUTO = "auto"

#: Level taken for "auto", and those there are.
_LEVELS = {SHAFT: (2, (1, 2, 3)), DRIVETRAIN: (2, (1, 2, 3, 4))}
_UNIT_LEVELS = (4, (4,))


def superelement_of(
    scene: Scene,
    what: str = SHAFT,
    at: Sequence[str] | None = None,
    level: int | str = AUTO,
) -> Superelement:
    """The part of a scene that is to be exported, condensed to points.

    Parameters
    ----------
    scene : Scene
        The scene.
    what : str
        "shaft": the free shaft. "drivetrain": the shaft on its supports; up to level 3 its
        housings are springs, solved apart, and what their two ways to hold the shaft differ by is
        the band (errors of the meshes are not in it). "seats": all bearings with their housings,
        one node a seat. Or the name of a bearing: it and its housing, on the ground.
    at : Sequence[str] or None
        Names of points: "hub", "gearbox", those of bearings. Where not given, all points of the
        shaft, and the hub of the drivetrain.
    level : int or str
        Level of the ladder, or "auto": 2 of shaft and drivetrain, 4 of a bearing.

    Raises
    ------
    InputError
        There is no such part, point or level, or a point is given twice.
    """
    units = [unit.bearing.name for unit in scene.bearing_units]
    if what not in (SHAFT, DRIVETRAIN, SEATS, *units):
        known = ", ".join((SHAFT, DRIVETRAIN, SEATS, *units))
        raise InputError(f"{what!r} cannot be exported: use one of {known}")
    if at is not None and (not at or len(set(at)) < len(at)):
        raise InputError(f"the points {', '.join(at) or 'none'} must be one or more, each once")
    usual, levels = _LEVELS.get(what, _UNIT_LEVELS)
    chosen = usual if level == AUTO else level
    if chosen not in levels:
        choices = ", ".join(map(str, levels))
        raise InputError(f"level {level!r} of {what} is unknown: use {AUTO} or one of {choices}")
    assert isinstance(chosen, int)
    if what == SHAFT:
        return shaft_superelement(scene, chosen, at)
    if what == DRIVETRAIN:
        return _drivetrain(scene, at or ("hub",), chosen)
    if what == SEATS:
        if at is not None and list(at) != units:
            raise InputError(f"seats are all of {', '.join(units)}: leave the points out")
        return seats_superelement(scene)
    if at is not None and list(at) != [what]:
        raise InputError(
            f"bearing {what!r} has no point {', '.join(at)}: its only point is {what!r}"
        )
    return unit_superelement(scene, what)


def _drivetrain(scene: Scene, at: Sequence[str], level: int) -> Superelement:
    if level == 4:
        return supported_superelement(scene, assembly_level(scene), at)
    body = condensed_shaft(scene, level)
    stiff, soft = (
        shaft_level(scene, level, housing_springs(scene, coupling, level)[0], body)
        for coupling in ("rigid", "averaged")
    )
    band = StiffnessBands.of_difference(soft.stiffness(at), stiff.stiffness(at))
    return supported_superelement(scene, stiff, at, band)
