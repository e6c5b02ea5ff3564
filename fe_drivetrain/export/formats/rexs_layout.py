"""What turns together in a REXS model, and how its stages follow each other from slow to fast.

Shafts, side plates and carriers that couplings join are one group; stages stand between groups
(spec.rexs.info 1.6, "Planetary stages", "Cylindrical stages"; relations `side`, `central_shaft`,
`planet_carrier_shaft`, `planet_shaft`, `planet_pin`, `stage`).
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.export.formats.rexs_model import Model, Part

CASING = "casing"
"""Group of all that stands."""
OTHER_STAGES = ("bevel_stage", "worm_stage", "hypoid_stage", "beveloid_stage", "face_gear_stage")
"""Stages that a drivetrain's file has none of."""


@dataclass(frozen=True)
class Stage:
    """A gear stage: the group that drives it, that which it drives, and its gears by role.

    Attributes
    ----------
    part : Part
        The planetary or cylindrical stage.
    slow, fast : str
        Group of the carrier and of the sun, or of the gear and of the pinion.
    gears : dict of str to Part
        Ring, planet (the first) and sun; or gear and pinion.
    planets : list of tuple
        Shaft and gear of each planet.
    meshes : list of Part
        Cylindrical stages: of a planetary one, those of sun and planets first.
    """

    part: Part
    slow: str
    fast: str
    gears: dict[str, Part]
    planets: Sequence[tuple[Part, Part]]
    meshes: Sequence[Part]
    ring_alone: bool = False

    @property
    def is_planetary(self) -> bool:
        """Whether it has planets."""
        return bool(self.planets)


class Groups:
    """What turns together, by the numbers of components."""

    def __init__(self, model: Model) -> None:
        self.model = model
        self._above: dict[str, str] = {}
        for casing in model.of_type("gear_casing"):
            casing.used = True
            self._join(CASING, casing.number)
        for carrier in model.of_type("planet_carrier"):
            for ends in model.related("assembly", assembly=carrier):
                if ends.get("part", carrier).type in ("shaft", "side_plate"):
                    self._join(carrier.number, ends["part"].number)
        for relation in ("planet_carrier_shaft", "planet_pin"):
            for ends in model.related(relation):
                if "planetary_stage" in ends and "shaft" in ends:
                    self._join(ends["planetary_stage"].number, ends["shaft"].number)
        for stage in model.of_type("planetary_stage"):
            for ends in model.related("assembly", assembly=stage):
                if ends.get("part", stage).type == "planet_carrier":
                    ends["part"].used = True
                    self._join(stage.number, ends["part"].number)
        for ends in model.related("side"):
            if {"assembly", "inner_part", "outer_part"} <= ends.keys() and _joins(
                ends["assembly"], model
            ):
                ends["assembly"].used = True
                self._join(ends["inner_part"].number, ends["outer_part"].number)

    def of(self, part: Part | str) -> str:
        """The group of a component, by the number of one that stands for it."""
        number = part if isinstance(part, str) else part.number
        while (above := self._above.get(number, number)) != number:
            self._above[number] = self._above.get(above, above)
            number = above
        return number

    def holds(self, group: str) -> bool:
        """Whether a group stands."""
        return group == self.of(CASING)

    def _join(self, one: str, other: str) -> None:
        a, b = self.of(one), self.of(other)
        if a != b:
            self._above[b] = a


def _joins(assembly: Part, model: Model) -> bool:
    """Whether an assembly makes its two sides turn together."""
    if "coupling" not in assembly.type and not assembly.type.endswith("connection"):
        return False
    stiffness = assembly.number_of("rotational_stiffness", "stiffness in tilt")
    if stiffness is not None and stiffness <= 0:
        return False
    engaged = assembly.attributes.get("is_engaged")
    if engaged is None:
        return True
    engaged.used = True
    states = engaged.value if isinstance(engaged.value, list) else [engaged.value]
    shift = 1.0
    for unit in model.of_type("gear_unit"):
        shift = unit.number_of("gear_shift_index", "number") or 1.0
    number = int(shift) if 1 <= shift <= len(states) else 1
    return not states or str(states[number - 1]).strip().lower() != "false"


def shaft_of(model: Model, gear: Part) -> Part:
    """The shaft that a gear is on.

    Raises
    ------
    InputError
        It is on none.
    """
    for ends in model.related("assembly", part=gear):
        shaft = ends.get("assembly")
        if shaft is not None and shaft.type == "shaft":
            return shaft
    raise InputError(
        f"{gear} is on no shaft: relate both by an assembly of the shaft and its part, the gear"
    )


def stages_of(model: Model, groups: Groups) -> list[Stage]:
    """All stages, from the one that the slow side drives on.

    Raises
    ------
    InputError
        There is none, or one that a drivetrain's file cannot have, or they are no chain.
    """
    for part in model.of_type(*OTHER_STAGES):
        raise InputError(
            f"{part} is not read: a drivetrain's file has planetary and cylindrical stages on "
            "parallel axes: model the drivetrain by hand"
        )
    found = [_planetary(model, groups, part) for part in model.of_type("planetary_stage")]
    inside = {mesh.number for stage in found for mesh in stage.meshes}
    for mesh in model.of_type("cylindrical_stage"):
        if mesh.number not in inside:
            found.append(_parallel(model, groups, mesh))
    if not found:
        raise InputError(
            "the model has no planetary_stage and no cylindrical_stage with gears: give a gear unit"
        )
    for stage in found:
        stage.part.used = True
    return _chain(found, groups)


def _pair(model: Model, mesh: Part) -> tuple[Part, Part]:
    """The two gears of a cylindrical stage."""
    for ends in model.related("stage", stage=mesh):
        if "gear_1" in ends and "gear_2" in ends:
            mesh.used = ends["gear_1"].used = ends["gear_2"].used = True
            return ends["gear_1"], ends["gear_2"]
    raise InputError(
        f"{mesh} has no two gears: relate it by a relation of type stage to gear_1 and gear_2"
    )


def _planetary(model: Model, groups: Groups, part: Part) -> Stage:
    """A planetary stage with its meshes, sun and ring."""
    related = model.related("planet_shaft", planetary_stage=part)
    shafts = [ends["shaft"] for ends in related if "shaft" in ends]
    on = {shaft.number: shaft for shaft in shafts}
    suns: dict[str, Part] = {}
    rings: dict[str, Part] = {}
    planets: dict[str, tuple[Part, Part]] = {}
    of_sun: list[Part] = []
    of_ring: list[Part] = []
    for mesh in model.of_type("cylindrical_stage"):
        ends = list(model.related("stage", stage=mesh))
        if not ends:
            continue
        pair = _pair(model, mesh)
        seats = [shaft_of(model, gear) for gear in pair]
        inner = [k for k in (0, 1) if seats[k].number in on]
        if not inner:
            continue
        if len(inner) == 2:
            raise InputError(
                f"{part}: {mesh} is of two planets, which no stage of a drivetrain's file has: "
                "model the drivetrain by hand"
            )
        planet, other = pair[inner[0]], pair[1 - inner[0]]
        planets.setdefault(seats[inner[0]].number, (seats[inner[0]], planet))
        internal = other.type == "ring_gear" or (_teeth(other) or 0) < 0
        (rings if internal else suns)[other.number] = other
        (of_ring if internal else of_sun).append(mesh)
    if len(suns) != 1 or len(rings) != 1 or not planets:
        raise InputError(
            f"{part} has {len(suns)} suns, {len(rings)} rings and {len(planets)} planets in mesh "
            "but must have one sun, one ring and planets: model the drivetrain by hand"
        )
    (sun,), (ring,) = suns.values(), rings.values()
    slow, fast = groups.of(part), groups.of(shaft_of(model, sun))
    _check_held(part, groups, slow, fast)
    ring_group = groups.of(shaft_of(model, ring))
    first = next(iter(planets.values()))[1]
    return Stage(
        part,
        slow,
        fast,
        {"ring": ring, "planet": first, "sun": sun},
        list(planets.values()),
        [*of_sun, *of_ring],
        ring_alone=not groups.holds(ring_group),
    )


def _check_held(part: Part, groups: Groups, carrier: str, sun: str) -> None:
    for name, group in (("carrier", carrier), ("sun", sun)):
        if groups.holds(group):
            raise InputError(
                f"{part}: its {name} is held in the casing, but a stage of a drivetrain's file "
                "has a held ring, a driven carrier and a sun that drives: model it by hand"
            )
    if carrier == sun:
        raise InputError(
            f"{part}: carrier and sun turn together, by couplings between them: remove them"
        )


def _parallel(model: Model, groups: Groups, mesh: Part) -> Stage:
    """A cylindrical stage on fixed axes: the gear of more teeth is the slow one."""
    pair = _pair(model, mesh)
    if any(gear.type == "ring_gear" or (_teeth(gear) or 1) < 0 for gear in pair):
        raise InputError(
            f"{mesh} has a ring on a fixed axis, which no stage of a drivetrain's file has: model "
            "the drivetrain by hand"
        )
    teeth = [_teeth(gear) or 0 for gear in pair]
    gear, pinion = pair if teeth[0] >= teeth[1] else pair[::-1]
    slow, fast = (groups.of(shaft_of(model, one)) for one in (gear, pinion))
    if slow == fast:
        raise InputError(
            f"{mesh}: both gears turn together, on one shaft or by couplings: correct the relations"
        )
    return Stage(mesh, slow, fast, {"gear": gear, "pinion": pinion}, (), [mesh])


def _teeth(gear: Part) -> float | None:
    return gear.number_of("number_of_teeth", "number")


def _chain(stages: Sequence[Stage], groups: Groups) -> list[Stage]:
    """Stages one after the other."""
    rings = [(s, groups.of(shaft_of(groups.model, s.gears["ring"]))) for s in stages if s.planets]
    between = {group for stage in stages for group in (stage.slow, stage.fast)}
    for stage, ring in rings:
        if ring in between:
            raise InputError(
                f"{stage.part}: its ring turns with another stage or with its own sun or carrier, "
                "but a stage of a drivetrain's file has a held ring: model it by hand"
            )
    driven = {stage.slow: stage for stage in stages}
    driving = {stage.fast for stage in stages}
    first = [stage for stage in stages if stage.slow not in driving]
    if len(driven) != len(stages) or len(driving) != len(stages) or len(first) != 1:
        raise InputError(
            f"the stages {_listed(stage.part for stage in stages)} are no chain from one slow "
            "shaft to one fast one, as a drivetrain's file has it: take what branches off, or "
            "other gears of a change gear, out of the model"
        )
    found = [first[0]]
    while (after := driven.get(found[-1].fast)) is not None and len(found) < len(stages):
        found.append(after)
    if len(found) != len(stages):
        raise InputError(
            f"the stages {_listed(stage.part for stage in stages)} are in a circle or apart, but "
            "a drivetrain's file has one chain: correct the relations"
        )
    return found


def _listed(parts: Iterable[Part]) -> str:
    """Components in a sentence, not more than a few."""
    names = [str(part) for part in parts]
    more = f" and {len(names) - 4} more" if len(names) > 4 else ""
    return ", ".join(names[:4]) + more
