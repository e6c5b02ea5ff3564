"""A drivetrain's file from a REXS model of a gear unit: what it gives, lacks, and has beside.

The chain of stages is taken from the slow shaft on, which the rotor drives. What a drivetrain's
file needs and the model has not is listed by its key; so is what the model has and no file holds.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Container, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import yaml

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain
from fe_drivetrain.drivetrain_file.gear_stages import PlanetaryData, PlanetaryStage
from fe_drivetrain.drivetrain_file.machine_gate import RESERVED, check_parallel, check_planetary
from fe_drivetrain.drivetrain_file.reading import parse_drivetrain
from fe_drivetrain.drivetrain_file.stage_completion import NotGivenError, completed
from fe_drivetrain.drivetrain_file.turning_parts import CarrierBody
from fe_drivetrain.export.formats.rexs_bearings import Bearings, Seats, bearings_of
from fe_drivetrain.export.formats.rexs_layout import Groups, Stage, stages_of
from fe_drivetrain.export.formats.rexs_model import LATEST, Model, Part, read_model
from fe_drivetrain.export.formats.rexs_own import own_values
from fe_drivetrain.export.formats.rexs_places import Places
from fe_drivetrain.export.formats.rexs_shafts import Row, group_shafts, planes_of, shaft_row
from fe_drivetrain.export.formats.rexs_stages import stage_row

ALL = "check, modes, gears, transient"
"""Commands that need all that turns."""


MOST = 2000
"""Components of one type, as shafts, sections and bearings, that a model may have."""

_COMPARED = ("shaft", "shaft_section", "planetary_stage", "cylindrical_stage")
_PLACES = (
    *("support_vector", "u_axis_vector", "w_axis_vector", "reference_component_for_position"),
)
_LARGE = 1e6  # from which on a number has its power of ten
_LOADS = ("torque_around_u_axis", "rotational_speed")


class Missing(NamedTuple):
    """A key that a drivetrain's file needs and a REXS model does not give.

    Attributes
    ----------
    key : str
        Dotted, as for ``--set``.
    example : str
        Value in the file, with dots for numbers.
    commands : str
        Commands that need it.
    """

    key: str
    example: str
    commands: str


@dataclass(frozen=True)
class GearUnit:
    """A drivetrain's file from a REXS model.

    Attributes
    ----------
    drivetrain : Drivetrain
        The drivetrain, as far as the model gives it.
    text : str
        Its file, with what is missing as comments.
    origin : str
        Version of REXS, program and date.
    chain : str
        Its shafts and stages from the rotor to the generator.
    missing : tuple of Missing
        Keys that the model does not give.
    assumed : tuple of str
        What was taken for something else, and why.
    refused : tuple of str
        What the program refuses in its stages as soon as the missing keys are there.
    not_used : tuple of str
        What the model has beside, by type of component.
    """

    drivetrain: Drivetrain
    text: str
    origin: str
    chain: str
    missing: tuple[Missing, ...]
    assumed: tuple[str, ...]
    refused: tuple[str, ...]
    not_used: tuple[str, ...]

    __repr__ = short_repr


def read_gear_unit(path: str | Path) -> GearUnit:
    """Read a gear unit from a REXS model as a drivetrain's file.

    Parameters
    ----------
    path : str or Path
        A model of version 1.0 to 1.6 in XML (``.rexs``), JSON (``.rexsj``), or a ZIP archive with
        one of them (``.rexsz``).

    Returns
    -------
    GearUnit

    Raises
    ------
    InputError
        The file is no REXS model, or is one of a gear unit that no drivetrain's file can describe:
        bevel gears, a driven ring, branches; or its values contradict each other.
    """
    model = read_model(path)
    try:
        return _gear_unit(model, Path(path).name)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


def _gear_unit(model: Model, file: str) -> GearUnit:
    _check_size(model)
    groups = Groups(model)
    stages = stages_of(model, groups)
    turning = group_shafts(model, groups)
    chain = [*(stage.slow for stage in stages), stages[-1].fast]
    for group in chain:
        if group not in turning:
            raise InputError(
                f"nothing of type shaft carries a gear or carrier of {stages[0].part}: relate "
                "the stage to its shafts"
            )
    places = Places(model, turning[chain[0]][0])
    if planes_of(places, stages[-1:])[0][1] < planes_of(places, stages[:1])[0][0] or (
        len(stages) == 1 and _leads_back(model, places, turning, chain, stages)
    ):
        places.turn_round()
    for group in chain:
        for shaft in turning[group]:
            places.along(shaft)
    planes = planes_of(places, stages)
    notes: list[str] = []
    for stage in stages:
        if stage.ring_alone:
            notes.append(
                f"{stage.gears['ring']} is joined to nothing by the model: it is taken for held"
            )
    rows = [
        shaft_row(model, places, turning[group], _between(planes, k), notes)
        for k, group in enumerate(chain)
    ]
    names = _names(rows)
    if any(row.sense < 0 for row in rows):
        back = ", ".join(name for name, row in zip(names, rows, strict=True) if row.sense < 0)
        notes.append(
            f"{back}: goes back along the axis in the model, and is laid forward here with its "
            "bearings, since each shaft of a drivetrain's file goes on behind the one before"
        )
    made = [stage_row(model, places, stage, k + 1, notes) for k, stage in enumerate(stages)]
    seats = Seats(stages, rows, names, planes)
    bearings = bearings_of(model, places, groups, stages, seats, notes)
    return _written(model, file, (stages, made), (rows, names), bearings, notes)


def _check_size(model: Model) -> None:
    """Refuse more components of a kind than any gear unit has, before they are compared."""
    for kind, count in Counter(part.type for part in model.parts.values()).items():
        if count > MOST and (kind in _COMPARED or "bearing" in kind):
            raise InputError(
                f"the model has {count:,} components of type {shown(kind)} but must have at most "
                f"{MOST:,}: give that of one gear unit"
            )


def _leads_back(
    model: Model,
    places: Places,
    turning: dict[str, list[Part]],
    chain: Sequence[str],
    stages: Sequence[Stage],
) -> bool:
    """Whether the slow shaft of the only stage goes on from it towards greater x."""
    plane = planes_of(places, stages)[0][0]
    return shaft_row(model, places, turning[chain[0]], (None, plane), []).sense < 0


def _between(
    planes: Sequence[tuple[float, float]], number: int
) -> tuple[float | None, float | None]:
    """Where the stages before and behind a shaft stand; None of an end."""
    before = planes[number - 1][1] if number > 0 else None
    behind = planes[number][0] if number < len(planes) else None
    return before, behind


def _names(rows: Sequence[Row]) -> list[str]:
    """Names of shafts, each its own."""
    found: dict[str, None] = {}
    for row in rows:
        found[_own_name(row.parts[0].name, f"shaft {row.parts[0].number}", found)] = None
    return list(found)


def _own_name(name: str, other: str, taken: Container[str]) -> str:
    """A name that the gate of a drivetrain's file takes, as near as can be to one of the model."""
    made = name or other
    if made in RESERVED or made.startswith("stage "):
        made = f"part {made}"
    number, base = 1, made
    while made in taken:
        number += 1
        made = f"{base} ({number})"
    return made


def _written(
    model: Model,
    file: str,
    stages: tuple[Sequence[Stage], list[dict[str, Any]]],
    shafts: tuple[Sequence[Row], Sequence[str]],
    bearings: Bearings,
    notes: list[str],
) -> GearUnit:
    """The file's text, and what is missing and left over."""
    (found, made), (rows, names) = stages, shafts
    taken = set(names)
    for row in (*bearings.housing, *(row for row, stage in bearings.unknown if stage is None)):
        row["name"] = _own_name(row["name"], "bearing", taken)
        taken.add(row["name"])
    for k, pins in bearings.pins.items():
        pin_names: set[str] = set()
        for pin in pins:
            if pin["name"] or pin_names:
                pin["name"] = _own_name(pin["name"], "pin bearing", pin_names)
            pin_names.add(pin["name"])
        made[k]["pins"] = pins
    named = [{"name": name} | row.data for name, row in zip(names, rows, strict=True)]
    units = model.of_type("gear_unit")
    own = own_values(units[0]) if units else {}
    origin = _origin(model)
    head: dict[str, Any] = {
        "title": (units[0].name if units else "") or file,
        "sources": [f"{file}: {origin}"],
    }
    if notes:
        head["assumed"] = notes
    gearbox: dict[str, Any] = {"stages": made, "shafts": named[1:]}
    if bearings.housing:
        gearbox["bearings"] = bearings.housing
    data = head | own | {"shaft": named[0], "gearbox": gearbox}
    missing = tuple(_missing(data, found, rows, bearings))
    not_used = tuple(_not_used(model))
    text = _text(data, origin, file, missing, not_used)
    drivetrain = parse_drivetrain(text, source="as a drivetrain's file")
    between = [
        f"{'planetary' if stage.is_planetary else 'parallel'} stage {k}"
        for k, stage in enumerate(found, start=1)
    ]
    links = [names[0], *(word for pair in zip(between, names[1:], strict=True) for word in pair)]
    refused = tuple(_refused(drivetrain))
    return GearUnit(
        drivetrain, text, origin, " - ".join(links), missing, tuple(notes), refused, not_used
    )


def _refused(drivetrain: Drivetrain) -> Iterator[str]:
    """What the gate will refuse in the stages, once a carrier's inertia is there."""
    for number, stage in enumerate(drivetrain.gearbox.stages, start=1):
        name, trial = f"stage {number}", stage
        if isinstance(stage, PlanetaryStage) and stage.carrier is None:
            trial = stage.model_copy(update={"carrier": CarrierBody(inertia=1.0)})
        try:
            found = completed(trial, name)
            if found.not_given:
                continue
            if isinstance(found.stage, PlanetaryData):
                check_planetary(found.stage, name)
            else:
                check_parallel(found.stage, name)
        except NotGivenError:
            continue
        except InputError as error:
            yield str(error)


def _origin(model: Model) -> str:
    version = f"REXS {model.version[0]}.{model.version[1]}"
    later = ""
    if model.version > LATEST:
        later = f" (later than {LATEST[0]}.{LATEST[1]}, and read in the same way)"
    by = f" of {model.program}" if model.program else ""
    return f"{version}{later}{by}{f', {model.date}' if model.date else ''}"


def _missing(
    data: dict[str, Any], stages: Sequence[Stage], rows: Sequence[Row], bearings: Bearings
) -> list[Missing]:
    """Keys that the model does not give, those without which nothing runs first."""
    found = []
    if "rotor" not in data:
        found.append(Missing("rotor", "{inertia: ..., mass: ...}", ALL))
    for k, (stage, row) in enumerate(zip(stages, data["gearbox"]["stages"], strict=True)):
        key = f"gearbox.stages.{k}"
        if stage.is_planetary and "carrier" not in row:
            found.append(Missing(f"{key}.carrier", "{inertia: ..., mass: ...}", ALL))
        for part in ("planet", "sun") if stage.is_planetary else ("gear", "pinion"):
            if "module" not in row and part not in row:
                found.append(Missing(f"{key}.{part}", "{inertia: ..., mass: ...}", ALL))
        for size in ("module", "face_width"):
            if size not in row and not ({"sun_planet", "stiffness"} & row.keys()):
                found.append(Missing(f"{key}.{size}", "...", ALL))
        if stage.is_planetary and "pins" not in row:
            example = "[{offset: 0, stiffness: [..., ..., ..., 0, ..., ...]}]"
            found.append(Missing(f"{key}.pins", example, "modes and gears beyond torsion"))
    if "generator" not in data:
        found.append(Missing("generator", "{inertia: ...}", ALL))
    for k, shaft in enumerate(rows):
        if not shaft.is_known:
            key = f"gearbox.shafts.{k - 1}" if k else "shaft"
            needs = "the torsion of a shaft" if shaft.length else "all beyond torsion"
            example = "{name: ..., length: ..., outer: ...}"
            found.append(Missing(key, f"{example}, in place of kind: rigid", f"modes, {needs}"))
    for row, stage_number in bearings.unknown:
        line = yaml.safe_dump(row, default_flow_style=True, allow_unicode=True, width=10**6)
        example = f"- {line.strip()[:-1]}, stiffness: [..., ..., ..., 0, ..., ...]}}"
        where = "bearings" if stage_number is None else f"stages.{stage_number}.pins"
        where = f"gearbox.{where}"
        found.append(Missing(where, example, "modes and gears beyond torsion"))
    if "operation" not in data:
        example = "{rated_power: ..., rotor_speed: [..., ...]}"
        found.append(Missing("operation", example, "gears, transient"))
    for k, row in enumerate(data["gearbox"]["stages"]):
        if "strength" not in row:
            gears = "ring, planet and sun" if row["kind"] == "planetary" else "gear and pinion"
            found.append(
                Missing(
                    f"gearbox.stages.{k}.strength",
                    f"{{gears: ..., grade: ...}}, of {gears}",
                    "gears, for the ratings by ISO 6336",
                )
            )
    return found


def _not_used(model: Model) -> list[str]:
    """What of the model no key of the file holds: components, and attributes of used ones."""
    whole: dict[str, list[str]] = {}
    single: dict[str, Counter[str]] = {}
    for part in model.parts.values():
        if not part.used:
            loads = [
                f"{key} {shown(one.value)[1:-1]} {one.unit or ''}".rstrip()
                for key, one in part.attributes.items()
                if key in _LOADS
            ]
            name = part.name or part.number
            whole.setdefault(part.type, []).append(
                f"{name} ({', '.join(loads)})" if loads else name
            )
            continue
        for key, attribute in part.attributes.items():
            if not (attribute.used or key in _PLACES or key.startswith("u_coordinate_on_shaft")):
                single.setdefault(part.type, Counter())[key] += 1
    found = []
    for kind, names in whole.items():
        more = f" and {len(names) - 3} more" if len(names) > 3 else ""
        found.append(f"{kind}: {', '.join(names[:3])}{more}")
    for kind, counts in single.items():
        found.append(f"of {kind}: {', '.join(counts)}")
    return found


def _text(
    data: dict[str, Any],
    origin: str,
    file: str,
    missing: Sequence[Missing],
    not_used: Sequence[str],
) -> str:
    """The file: what is missing as comments at its head, what is left over at its end."""
    head = [f"# From {file}, {origin}. SI units; angles in degrees."]
    if missing:
        head.append("# Not in the model; fill in what your commands need:")
        head += [f"#   {one.key}: {one.example} ({one.commands})" for one in missing]
    tail = ["# In the model and not used here:", *(f"#   {one}" for one in not_used)]
    body = yaml.dump(data, Dumper=_Dumper, sort_keys=False, allow_unicode=True, width=110)
    return "\n".join([*head, body.rstrip(), *(tail if not_used else ()), ""])


class _Dumper(yaml.SafeDumper):
    """Rows of values in one line, no anchors, and large numbers with their powers of ten."""

    def ignore_aliases(self, data: Any) -> bool:
        return True

    def represent_float(self, data: float) -> Any:
        if abs(data) < _LARGE:
            return super().represent_float(data)
        text = np.format_float_scientific(data, trim="0", exp_digits=1)
        return self.represent_scalar("tag:yaml.org,2002:float", text)

    def represent_sequence(self, tag: str, sequence: Any, flow_style: bool | None = None) -> Any:
        flat = not any(isinstance(one, list | dict | str) for one in sequence)
        return super().represent_sequence(tag, sequence, flow_style=flat or flow_style)

    def represent_mapping(self, tag: str, mapping: Any, flow_style: bool | None = None) -> Any:
        flat = not any(
            isinstance(one, dict) or (isinstance(one, list) and not _numbers(one))
            for one in mapping.values()
        )
        return super().represent_mapping(tag, mapping, flow_style=flat or flow_style)


_Dumper.add_representer(float, _Dumper.represent_float)


def _numbers(values: Sequence[Any]) -> bool:
    return all(isinstance(one, int | float) for one in values)
