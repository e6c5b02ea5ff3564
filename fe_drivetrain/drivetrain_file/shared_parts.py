"""Bearing units that stand on the same parts: a bedplate under two housings, say.

Such a part belongs to one of the units, its own, and is tied to the housings of others, which stand
on it alone. What the housings give is then coupled.
"""

from __future__ import annotations

from collections.abc import Sequence

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit


def coupled_units(units: Sequence[BearingUnit]) -> tuple[tuple[str, ...], ...]:
    """Names of bearings whose housings stand on the same parts.

    Parameters
    ----------
    units : Sequence[BearingUnit]
        Bearing units of a scene.

    Returns
    -------
    tuple[tuple[str, ...], ...]
        Each the unit that the parts belong to, and then those that stand on these.
    """
    found = []
    for unit in units:
        others = dict.fromkeys(guest for _, guest in _ties(unit))
        if others:
            found.append((unit.bearing.name, *others))
    return tuple(found)


def _ties(unit: BearingUnit) -> list[tuple[str, str]]:
    """Parts of a unit that are tied to another unit's housing, and that unit's bearing."""
    return [
        (part.name, tie.to.removesuffix(".housing"))
        for part in unit.parts
        for tie in part.tied
        if tie.to.endswith(".housing")
    ]


def check_shared(units: Sequence[BearingUnit]) -> None:
    """Refuse housings that stand on nothing, or on parts that cannot carry them.

    Parameters
    ----------
    units : Sequence[BearingUnit]
        Bearing units of a scene.

    Raises
    ------
    InputError
    """
    known = {unit.bearing.name: unit for unit in units}
    on: dict[str, str] = {}
    for unit in units:
        for part, other in _ties(unit):
            what = f"part {part!r} of bearing {unit.bearing.name!r} is tied to '{other}.housing'"
            if other not in known or known[other].condensed is not None:
                solid = [f"'{n}.housing'" for n, u in known.items() if u.condensed is None]
                raise InputError(
                    f"{what}, but there is no such solid: use one of {', '.join(solid)}"
                )
            if known[other].parts or on.setdefault(other, unit.bearing.name) != unit.bearing.name:
                raise InputError(
                    f"{what}, which has parts of its own or stands on those of a third: give all "
                    "parts that couple housings to one of the units"
                )
            if known[other].stands_on != "parts" or unit.stands_on != "parts":
                raise InputError(
                    f"{what}, but the two do not both stand on parts alone: give both bearing "
                    "units stands_on: parts"
                )
            for one in (unit, known[other]):
                if one.bedplate is not None or one.rollers is not None:
                    raise InputError(
                        f"{what}, and bearing {one.bearing.name!r} has "
                        f"{'a bedplate of springs' if one.bedplate is not None else 'rollers'}, "
                        "which housings that share a part cannot have yet: leave that out, or use "
                        "the interface 'spring' or 'bonded'"
                    )
    for name, unit in known.items():
        if unit.stands_on == "parts" and not unit.parts and name not in on:
            raise InputError(
                f"bearing {name!r} stands on parts, of which it has none with a held face: give "
                f"it one, or tie one of another unit to '{name}.housing', or leave stands_on out"
            )


def refuse_coupled(units: Sequence[BearingUnit], name: str) -> None:
    """Refuse a unit that gives together with others where it is asked for by itself.

    Parameters
    ----------
    units : Sequence[BearingUnit]
        Bearing units of the scene.
    name : str
        Name of the bearing.

    Raises
    ------
    InputError
    """
    for group in coupled_units(units):
        if name in group:
            raise InputError(
                f"housings of bearings {', '.join(group)} stand on the same parts, so {name!r} has "
                "no stiffness of its own: use levels 1 to 4, which take all of them together"
            )
