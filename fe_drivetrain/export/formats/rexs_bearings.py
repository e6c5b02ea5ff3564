"""Bearings of a REXS model as rows of a drivetrain's file: in the housing, and of planets."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from fe_drivetrain.export.formats.rexs_layout import Groups, Stage
from fe_drivetrain.export.formats.rexs_model import Model, Part
from fe_drivetrain.export.formats.rexs_own import own_values
from fe_drivetrain.export.formats.rexs_places import Places
from fe_drivetrain.export.formats.rexs_shafts import SLIVER, Row

RIGID = 1e15
"""Stiffness [N/m, N m/rad] beyond which one stands for rigid, as 1e20 and 1e22 N/m in models: five
and more orders above any bearing's, and as far as equilibrium is found to round-off."""
DIGITS = 12
"""Digits of a place in m behind the point: beyond is round-off of differences."""
SAME = 1e-9
"""Relative difference of a stiffness of our own from REXS's attribute that is round-off."""


@dataclass
class Bearings:
    """Bearings that were found.

    Attributes
    ----------
    housing : list of dict
        Rows of the gearbox's bearings.
    pins : dict of int to list of dict
        Bearings of each planet, by number of the stage.
    unknown : list of tuple
        Row without stiffness, and the number of its stage where it is a planet's.
    rigid : list of str
        Names of those that are stiffer than `RIGID`.
    """

    housing: list[dict[str, Any]] = field(default_factory=list)
    pins: dict[int, list[dict[str, Any]]] = field(default_factory=dict)
    unknown: list[tuple[dict[str, Any], int | None]] = field(default_factory=list)
    rigid: list[str] = field(default_factory=list)


class Seats:
    """Where bearings may be: shafts of the file, and bodies of its stages."""

    def __init__(
        self,
        stages: Sequence[Stage],
        rows: Sequence[Row],
        names: Sequence[str],
        planes: Sequence[tuple[float, float]],
    ) -> None:
        self.groups = {stage.slow: k for k, stage in enumerate(stages)}
        self.groups[stages[-1].fast] = len(stages)
        self._stages, self._rows, self._names, self._planes = stages, rows, names, planes

    def body(self, number: int, fast: bool) -> str:
        """Name of a body of a stage, counted from 0."""
        planetary = self._stages[number].is_planetary
        slow_name, fast_name = ("carrier", "sun") if planetary else ("gear", "pinion")
        return f"stage {number + 1} {fast_name if fast else slow_name}"

    def stated(self, holds: str, x: float) -> float | None:
        """Distance from a shaft or body that is stated by its name; None where there is none."""
        for k, name in enumerate(self._names):
            if holds == name:
                return (x - self._rows[k].begin) * self._rows[k].sense
        if holds == "rotor":
            return (x - self._rows[0].begin) * self._rows[0].sense
        if holds == "generator" and self._rows[-1].length is not None:
            last = self._rows[-1]
            return (x - last.begin) * last.sense - (last.length or 0.0)
        for k, plane in enumerate(self._planes):
            for fast in (False, True):
                if holds == self.body(k, fast):
                    return (x - plane[fast]) * self._rows[k + fast].sense
        return None

    def found(self, number: int, x: float) -> tuple[str, float]:
        """Name of what holds a bearing on the shaft of this number, and its distance from there."""
        row = self._rows[number]
        at = (x - row.begin) * row.sense
        length = row.length
        if length is None:
            return self._names[number], max(at, 0.0)
        if at < -SLIVER and number > 0:
            return self.body(number - 1, True), (x - self._planes[number - 1][1]) * row.sense
        if at > length + SLIVER and number < len(self._stages):
            return self.body(number, False), (x - self._planes[number][0]) * row.sense
        return self._names[number], min(max(at, 0.0), length)


def bearings_of(
    model: Model,
    places: Places,
    groups: Groups,
    stages: Sequence[Stage],
    seats: Seats,
    notes: list[str],
) -> Bearings:
    """All bearings that a drivetrain's file has: of shafts in the casing, and of planets.

    Parameters
    ----------
    model, places, groups, stages, seats : Model, Places, Groups, sequence of Stage, Seats
        The model, and what was found in it.
    notes : list of str
        Sentences on what is assumed are added to it.
    """
    found = Bearings()
    planets = {
        groups.of(shaft): (k, number)
        for k, stage in enumerate(stages)
        for number, (shaft, _) in enumerate(stage.planets)
    }
    pins: dict[tuple[int, int], list[dict[str, Any]]] = {}
    for ends in model.related("side"):
        if not {"assembly", "inner_part", "outer_part"} <= ends.keys():
            continue
        bearing = ends["assembly"]
        if "bearing" not in bearing.type:
            continue
        sides = [groups.of(ends["inner_part"]), groups.of(ends["outer_part"])]
        on = [planets[group] for group in sides if group in planets]
        on_shaft = [seats.groups[group] for group in sides if group in seats.groups]
        if len(on) == 1 and on_shaft == [on[0][0]]:
            gear = stages[on[0][0]].planets[on[0][1]][1]
            row = _pin(bearing, places, gear, on[0], found, notes)
            pins.setdefault(on[0], []).append(row)
        elif len(on_shaft) == 1 and any(groups.holds(group) for group in sides):
            _add(found, bearing, places, seats, on_shaft[0], notes)
        else:
            notes.append(
                f"{bearing} is neither in the casing nor between a planet and its carrier: left out"
            )
    for k, stage in enumerate(stages):
        if stage.is_planetary:
            _add_pins(found, k, stage, pins, notes)
    if found.rigid:
        more = f" and {len(found.rigid) - 3} more" if len(found.rigid) > 3 else ""
        notes.append(
            f"rigid in the model are {', '.join(found.rigid[:3])}{more}: stiffnesses above "
            f"{RIGID:g} N/m or N m/rad are {RIGID:g} here"
        )
    return found


def _pin(
    bearing: Part,
    places: Places,
    gear: Part,
    planet: tuple[int, int],
    found: Bearings,
    notes: list[str],
) -> dict[str, Any]:
    """Keys of a bearing of a planet."""
    offset = float((places.of(bearing) - places.of(gear))[0])
    # as this program names them
    own_prefix = f"stage {planet[0] + 1} planet {planet[1] + 1}"
    row: dict[str, Any] = {"name": bearing.name.removeprefix(own_prefix).strip()}
    row |= {"offset": round(offset, DIGITS)} | _springs(bearing, found, notes)
    return row | _own(bearing, row)


def _add(
    found: Bearings, bearing: Part, places: Places, seats: Seats, number: int, notes: list[str]
) -> None:
    """Add a bearing of a shaft in the casing."""
    x = float(places.of(bearing)[0])
    row: dict[str, Any] = {"name": bearing.name or f"{bearing.type} {bearing.number}"}
    springs = _springs(bearing, found, notes)
    own = _own(bearing, springs)
    stated = own.pop("holds", None)
    at = seats.stated(stated, x) if isinstance(stated, str) else None
    holds = stated if at is not None else None
    if holds is None:
        holds, at = seats.found(number, x)
    row |= {"holds": holds, "at": round(at or 0.0, DIGITS)} | springs | own
    if "stiffness" in row:
        found.housing.append(row)
    else:
        found.unknown.append((row, None))


def _add_pins(
    found: Bearings,
    number: int,
    stage: Stage,
    pins: Mapping[tuple[int, int], Sequence[dict[str, Any]]],
    notes: list[str],
) -> None:
    """Bearings of the first planet stand for those of all."""
    mine = list(pins.get((number, 0), ()))

    def measure(rows: Sequence[dict[str, Any]]) -> list[tuple[float, str]]:
        return sorted((round(row["offset"], 7), str(row.get("stiffness"))) for row in rows)

    for planet in range(1, len(stage.planets)):
        if measure(pins.get((number, planet), ())) != measure(mine):
            notes.append(
                f"stage {number + 1}: bearings of planet {planet + 1} are not those of planet 1, "
                "which are taken for all"
            )
            break
    for row in mine:
        if "stiffness" in row:
            found.pins.setdefault(number, []).append(row)
        else:
            found.unknown.append((row, number))


def _springs(bearing: Part, found: Bearings, notes: list[str]) -> dict[str, Any]:
    """Six stiffnesses along and about x, y, z; none where the model has none."""
    bearing.used = True
    values = {
        "axial": bearing.number_of("axial_stiffness", "stiffness"),
        "radial": bearing.number_of("radial_stiffness", "stiffness"),
        "tilt": bearing.number_of("bending_stiffness", "stiffness in tilt"),
    }
    taken = {name: max(value or 0.0, 0.0) for name, value in values.items()}
    direction = bearing.word("axial_force_absorption")
    if direction == "no_direction":
        taken["axial"] = 0.0
    if bearing.word("radial_force_absorption") == "false":
        taken["radial"] = 0.0
    if not any(taken.values()):
        return {}
    label = bearing.name or str(bearing)
    if direction not in (None, "no_direction") and taken["axial"] == 0:
        notes.append(
            f"{label} takes axial force ({direction}) but its axial stiffness is not given: 0 here"
        )
    elif direction in ("positive", "negative", "positive_direction", "negative_direction"):
        notes.append(f"{label} takes axial force in one direction: both here")
    if max(taken.values()) > RIGID:
        found.rigid.append(label)
    axial, radial, tilt = (min(value, RIGID) for value in taken.values())
    return {"stiffness": [axial, radial, radial, 0.0, tilt, tilt]}


def _own(bearing: Part, row: Mapping[str, Any]) -> dict[str, Any]:
    """Values of our own; the stiffness only where REXS's attributes are still those of it."""
    own = own_values(bearing)
    stiffness = own.pop("stiffness", None)
    given = row.get("stiffness")
    if given is None or not isinstance(stiffness, list) or len(stiffness) != 6:
        return own
    try:
        six = [float(one[k] if isinstance(one, list) else one) for k, one in enumerate(stiffness)]
    except (TypeError, ValueError, IndexError, OverflowError):
        return own
    means = [min(k, RIGID) for k in (six[0], (six[1] + six[2]) / 2, (six[4] + six[5]) / 2)]
    stated = [given[0], given[1], given[4]]
    if all(abs(a - b) <= SAME * max(abs(a), abs(b)) for a, b in zip(means, stated, strict=True)):
        own["stiffness"] = stiffness
    return own
