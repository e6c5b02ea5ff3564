"""Torsional drivetrains from a table of inertias, stiffnesses and ratios, as lumped masses.

Rotor, shafts and gear stages by turns, generator; each row holds what belongs to its own axis.
`dynamics.gear_table` makes the table of a drivetrain's file. Three models of the same table
(Al-Hamadani 2018, chapter 4):

- `two_masses`: the rotor and all the rest, the shafts in series (Eq 4.28-4.30, 4.33-4.35);
- `stage_masses`: one mass a stage, gear meshes rigid (Eq 4.8-4.21, 4.24-4.26); five of them with
  three stages;
- `gear_masses`: a mass each for carriers, planets, suns, gears and pinions, meshes as springs
  (Eq 4.36-4.37); eleven with one planetary stage of three planets and two parallel ones.

The first two are in angles seen from the rotor's shaft, the third in those of the parts, all about
the same direction (a planet's about its own centre, in a frame that does not turn): pinions and
planets go the other way round than what drives them.
"""

from __future__ import annotations

from math import cos, pi, radians, sin
from typing import Annotated, Any, Literal, Self

import numpy as np
from pydantic import Discriminator, Field, Tag, field_validator, model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.dynamics.torsion.system import (
    Element,
    Inertia,
    Torsional,
    chain,
    natural_modes,
    resolved,
)
from fe_drivetrain.geometry.part import (
    Assumption,
    Part,
    assumed_in,
    dimension,
    in_its_field,
    kind_of,
    rows_of,
)

GeneratorState = Literal["fixed", "free"]
"""Generator on the grid, its spring to the ground; or off it, with none (variable speed)."""

ROTOR, GENERATOR, GRID = "rotor", "generator", "grid"
"""Names of the first and the last inertia, and of the generator's spring."""

STIFFNESS, DAMPING, INERTIA = "N m/rad", "N m s/rad", "kg m^2"

UNDAMPED = "assumed: without damping"

Teeth = Annotated[int, Field(ge=5, le=5000)]

#: Cosines of working pressure angles of both meshes of a planet, 10 to 35 degrees, of each other.
MAX_SHIFTED = cos(radians(10)) / cos(radians(35))


def _inertia(of: str) -> Any:
    return dimension(of=of, unit=INERTIA, ge=1e-9, le=1e10)


def _stiffness(of: str) -> Any:
    return dimension(of=of, unit=STIFFNESS, gt=0, le=1e20)


def _damping(of: str) -> Any:
    return dimension(0.0, of=of, unit=DAMPING, ge=0, le=1e12, source=UNDAMPED)


class ShaftRow(Part):
    """A shaft between two stages, or between a stage and the rotor or generator."""

    name: str = Field(description="name of the shaft")
    stiffness: float = _stiffness("torsional stiffness")
    damping: float = _damping("torsional damping")


class _Stage(Part):
    ratio: float | None = dimension(None, of="speed ratio", unit="-", gt=1, le=1000)
    teeth: tuple[Teeth, Teeth] | None = Field(
        default=None, description="teeth of ring and sun, or of gear and pinion, for the ratio"
    )

    @model_validator(mode="after")
    def _one_ratio(self) -> Self:
        kind = type(self).__name__
        if (self.ratio is None) == (self.teeth is None):
            raise InputError(f"{kind} needs a ratio or the teeth, and not both: give one of them")
        if self.teeth is not None and not self.teeth[1] < self.teeth[0]:
            raise InputError(
                f"{kind}: teeth are {list(self.teeth)} but must be two numbers above 0, the larger "
                "first: swap or correct them"
            )
        return self


class PlanetaryStage(_Stage):
    """Carrier driven, ring fixed, sun driving the next shaft.

    Mesh stiffnesses are about the planet's axis, r_b^2 k of one planet's mesh [N m/rad].
    """

    kind: Literal["planetary"] = Field(default="planetary", description="the word planetary")
    planets: int = Field(ge=1, le=50, description="number of planets")
    planet_teeth: Teeth | None = Field(
        default=None,
        description="teeth of a planet, beside those of ring and sun; without, (ring - sun) / 2, "
        "as in stages without profile shift",
        json_schema_extra={"unit": "-", "source": "assumed: (ring - sun) / 2, no profile shift"},
    )
    carrier: float = _inertia("inertia of the carrier, planets as points")
    planet: float = _inertia("inertia of one planet about its own axis")
    sun: float = _inertia("inertia of the sun")
    ring_planet: float = _stiffness("mesh stiffness about the planet")
    sun_planet: float = _stiffness("mesh stiffness about the planet")
    ring_planet_damping: float = _damping("mesh damping")
    sun_planet_damping: float = _damping("mesh damping")

    @model_validator(mode="after")
    def _room_for_planets(self) -> Self:
        if self.speed_ratio <= 2:
            raise InputError(
                f"PlanetaryStage: ratio is {self.speed_ratio:g} but must be greater than 2, or no "
                "planet fits between sun and ring: raise it"
            )
        if self.planet_teeth is not None and self.teeth is None:
            raise InputError(
                f"PlanetaryStage: planets have {self.planet_teeth} teeth, but ring and sun have a "
                "ratio alone: give their teeth, or leave out those of the planets"
            )
        if self.planet_over_sun >= self.speed_ratio - 1:
            ring, sun = self.teeth or (0, 0)
            raise InputError(
                f"PlanetaryStage: planets have {self.planet_teeth} teeth but must have fewer than "
                f"the ring, {ring}; beside a sun of {sun} they have about {(ring - sun) // 2}: "
                "correct one of them"
            )
        self._check_fit()
        return self

    def _check_fit(self) -> None:
        """Refuse planets that both sun and ring cannot have at one centre distance, or overlap."""
        p = self.planet_over_sun
        inside = (self.speed_ratio - 1 - p) / (1 + p)
        if not 1 / MAX_SHIFTED <= inside <= MAX_SHIFTED:
            ring, sun = self.teeth or (0, 0)
            raise InputError(
                f"PlanetaryStage: ring and planet have {ring} - {self.planet_teeth} teeth, planet "
                f"and sun {self.planet_teeth} + {sun}, which must be equal but for profile shifts, "
                f"within a factor of {MAX_SHIFTED:.3g}: correct one of them"
            )
        n = self.planets
        if n > 1 and not (1 + p) * sin(pi / n) > p:
            raise InputError(
                f"PlanetaryStage: {n} planets of {p:.4g} times the radius of the sun overlap: give "
                "fewer planets, or a smaller ratio"
            )

    def assumptions(self) -> list[Assumption]:
        """Say what is assumed, and that torsion ignores unequal angles of planets."""
        rows = super().assumptions()
        if self.teeth is not None and sum(self.teeth) % self.planets:
            why = (
                f"assumed: ring and sun, {self.teeth[0]} + {self.teeth[1]} teeth, are no multiple "
                f"of {self.planets} planets, which stand at unequal angles"
            )
            rows.append(Assumption("angles of planets", "unequal", "", why))
        return rows

    @property
    def speed_ratio(self) -> float:
        """Speed of the sun over that of the carrier: 1 + ring / sun."""
        return 1 + self.teeth[0] / self.teeth[1] if self.teeth else float(self.ratio or 0.0)

    @property
    def planet_over_sun(self) -> float:
        """Base radius, or teeth, of a planet over that of the sun.

        Where the planets' teeth are not known, the ring is as wide as the sun and two planets;
        stages with profile shift may have a tooth or two fewer.
        """
        if self.teeth is not None and self.planet_teeth is not None:
            return self.planet_teeth / self.teeth[1]
        return (self.speed_ratio - 2) / 2

    @property
    def windings(self) -> tuple[float, float]:
        """Windings of a planet's meshes with ring and sun about its axis, per turn of the carrier.

        The line of action moves by a cos(alpha_w), which is the difference of the base radii of
        ring and planet in the one mesh and the sum of those of planet and sun in the other,
        whatever the profile shifts: (z_r - z_p) / z_p and (z_s + z_p) / z_p.
        """
        p = self.planet_over_sun
        return (self.speed_ratio - 1 - p) / p, (1 + p) / p

    @property
    def planet_speed(self) -> float:
        """Speed of a planet, in a frame that does not turn, over the carrier's; negative."""
        return -self.windings[0]


class ParallelStage(_Stage):
    """A gear that drives a pinion; the mesh stiffness is about the gear's axis, r_b^2 k."""

    kind: Literal["parallel"] = Field(default="parallel", description="the word parallel")
    gear: float = _inertia("inertia of the gear")
    pinion: float = _inertia("inertia of the pinion")
    mesh: float = _stiffness("mesh stiffness about the gear")
    mesh_damping: float = _damping("mesh damping about the gear")

    @property
    def speed_ratio(self) -> float:
        """Speed of the pinion over that of the gear, both counted positive."""
        return self.teeth[0] / self.teeth[1] if self.teeth else float(self.ratio or 0.0)


Stage = Annotated[
    Annotated[PlanetaryStage, Tag("planetary")] | Annotated[ParallelStage, Tag("parallel")],
    Discriminator(kind_of),
]
"""A stage of either kind: rows of a file have become stages before this type is used."""
_KINDS: dict[str, type[Part]] = {"planetary": PlanetaryStage, "parallel": ParallelStage}


class GeneratorRow(Part):
    """The generator's rotor, and the spring that the field is when the speed is fixed."""

    inertia: float = _inertia("inertia of the generator")
    stiffness: float = dimension(
        0.0,
        of="electrical stiffness",
        unit=STIFFNESS,
        ge=0,
        le=1e20,
        source="assumed: off the grid, or of variable speed",
    )
    damping: float = _damping("electrical damping")


class GearTable(Part):
    """A table of a drivetrain, from the rotor to the generator."""

    title: str = Field(description="what it is, and whose numbers")
    rotor: float = _inertia("inertia of the rotor")
    shafts: tuple[ShaftRow, ...] = Field(min_length=1, description="shafts from the rotor on")
    stages: tuple[Stage, ...] = Field(default=(), description="gear stages from the rotor on")
    generator: GeneratorRow = Field(description="the generator")

    _end = field_validator("generator", mode="wrap")(in_its_field)
    _shafts = field_validator("shafts", mode="before")(rows_of("shaft", ShaftRow))
    _stages = field_validator("stages", mode="before")(rows_of("stage", _KINDS))

    @model_validator(mode="after")
    def _one_shaft_more(self) -> Self:
        if len(self.shafts) != len(self.stages) + 1:
            raise InputError(
                f"drivetrain {shown(self.title)} has {len(self.shafts)} shafts and "
                f"{len(self.stages)} stages but must have one shaft more than stages, the first at "
                "the rotor and the last at the generator: add or remove some"
            )
        names = [shaft.name for shaft in self.shafts]
        taken = {ROTOR, GENERATOR, GRID}
        for name in names:
            if names.count(name) > 1 or name in taken or name.startswith("stage "):
                raise InputError(
                    f"shaft {shown(name)} must have a name of its own, other than "
                    f"{', '.join(sorted(taken))} and 'stage ...': rename it"
                )
        return self

    @model_validator(mode="after")
    def _within_digits(self) -> Self:
        system = gear_masses(self, "free")
        modes = natural_modes(system)
        if not resolved(modes.frequencies, 1):
            wound = np.abs(system.B @ modes.shapes[:, :2])
            softest = system.elements[int(np.argmax(wound.max(axis=1)))]
            raise InputError(
                f"drivetrain {shown(self.title)}: stiffnesses or inertias are too far apart for "
                f"the digits of a computer: {softest.name} has {softest.stiffness:g} N m/rad; "
                "correct it, or the inertias"
            )
        return self

    def assumptions(self) -> list[Assumption]:
        """Assumptions of all rows: what the table does not give."""
        named: list[tuple[str, Part]] = [(f"shaft {shaft.name}", shaft) for shaft in self.shafts]
        named += [(f"stage {k}", stage) for k, stage in enumerate(self.stages, start=1)]
        return assumed_in([*named, ("generator", self.generator)])

    @property
    def speeds(self) -> tuple[float, ...]:
        """Speed of each shaft over the rotor's."""
        speeds = [1.0]
        for stage in self.stages:
            speeds.append(speeds[-1] * stage.speed_ratio)
        return tuple(speeds)


def stage_masses(table: GearTable, generator: GeneratorState = "fixed") -> Torsional:
    """One mass a stage, beside rotor and generator, on the rotor's side (Eq 4.8-4.21, 4.24-4.26).

    Gear meshes are rigid. As in the source, planets turn with no inertia of their own (Eq 4.9).
    Masses are called "stage 1" and so on.
    """
    speeds = table.speeds
    parts = [Inertia(ROTOR, table.rotor)]
    for number, (stage, before, after) in enumerate(
        zip(table.stages, speeds, speeds[1:], strict=False), start=1
    ):
        front, rear = (
            (stage.carrier, stage.sun)
            if isinstance(stage, PlanetaryStage)
            else (stage.gear, stage.pinion)
        )
        parts.append(Inertia(f"stage {number}", before**2 * front + after**2 * rear))
    last = speeds[-1] ** 2
    parts.append(Inertia(GENERATOR, last * table.generator.inertia))
    shafts = [
        (shaft.name, s**2 * shaft.stiffness, s**2 * shaft.damping)
        for shaft, s in zip(table.shafts, speeds, strict=True)
    ]
    field = table.generator
    ground = (GRID, last * field.stiffness, last * field.damping)
    return chain(parts, shafts, ground if _on_grid(table, generator) else None)


def two_masses(table: GearTable, generator: GeneratorState = "fixed") -> Torsional:
    """The rotor, and all the rest as one generator (Eq 4.28-4.30, 4.33-4.35).

    Dampers are put in series as springs are (Eq 4.30), which holds for each alone; without any
    in one shaft there is none. The spring between is called "shafts".
    """
    full = stage_masses(table, generator)
    between = full.elements[: len(table.shafts)]
    stiffness = 1 / sum(1 / e.stiffness for e in between)
    dampings = [e.damping for e in between]
    damping = 1 / sum(1 / c for c in dampings) if all(dampings) else 0.0
    grid = full.elements[len(table.shafts) :]
    return chain(
        [
            full.inertias[0],
            Inertia(GENERATOR, sum(part.inertia for part in full.inertias[1:])),
        ],
        [("shafts", stiffness, damping)],
        (GRID, grid[0].stiffness, grid[0].damping) if grid else None,
    )


def gear_masses(table: GearTable, generator: GeneratorState = "fixed") -> Torsional:
    """A mass for each part of the gearbox, meshes as springs (Eq 4.36-4.37).

    The ring stands still. Each mesh is wound by the sliding of the base circles along the line of
    action, about the axis that its stiffness is given for: the planet's, or the gear's. (Eq 4.37
    writes r_2 cos(alpha) theta_2 for what the carrier adds; with r_2 that of the planets' centres
    and the working angle of each mesh this is the same where the stage turns without load, as it
    must: no mesh is wound then. The angles differ where z_s + 2 z_p is not z_r, as in profile-
    shifted stages with `planet_teeth`.)
    Parts are called "stage 1 carrier", "... planet 1", "... sun", "... gear", "... pinion", meshes
    "stage 1 ring-planet 1", "... sun-planet 1", "... mesh".
    """
    parts, elements = [Inertia(ROTOR, table.rotor)], []
    shafts = iter(table.shafts)
    driving = ROTOR
    for number, stage in enumerate(table.stages, start=1):
        name = f"stage {number}"
        if isinstance(stage, PlanetaryStage):
            front, rear = f"{name} carrier", f"{name} sun"
            masses, meshes = _planetary(name, front, rear, stage)
        else:
            front, rear = f"{name} gear", f"{name} pinion"
            masses = [Inertia(front, stage.gear), Inertia(rear, stage.pinion)]
            meshes = [
                Element(
                    f"{name} mesh",
                    {front: 1.0, rear: 1.0 / stage.speed_ratio},
                    stage.mesh,
                    stage.mesh_damping,
                )
            ]
        elements += [_shaft(next(shafts), driving, front), *meshes]
        parts += masses
        driving = rear
    field = table.generator
    parts.append(Inertia(GENERATOR, field.inertia))
    elements.append(_shaft(next(shafts), driving, GENERATOR))
    if _on_grid(table, generator):
        elements.append(Element(GRID, {GENERATOR: 1.0}, field.stiffness, field.damping))
    return Torsional(tuple(parts), tuple(elements))


def gear_speeds(table: GearTable) -> dict[str, float]:
    """Speed of each part of `gear_masses` over the rotor's, where nothing is wound up."""
    speeds, speed = {ROTOR: 1.0}, 1.0
    for number, stage in enumerate(table.stages, start=1):
        name = f"stage {number}"
        if isinstance(stage, PlanetaryStage):
            speeds[f"{name} carrier"] = speed
            for planet in range(1, stage.planets + 1):
                speeds[f"{name} planet {planet}"] = speed * stage.planet_speed
            speed *= stage.speed_ratio
            speeds[f"{name} sun"] = speed
        else:
            speeds[f"{name} gear"] = speed
            speed *= -stage.speed_ratio
            speeds[f"{name} pinion"] = speed
    return {**speeds, GENERATOR: speed}


def _planetary(
    name: str, carrier: str, sun: str, stage: PlanetaryStage
) -> tuple[list[Inertia], list[Element]]:
    by_ring, by_sun = stage.windings
    planets = [f"{name} planet {i + 1}" for i in range(stage.planets)]
    masses = [
        Inertia(carrier, stage.carrier),
        *(Inertia(planet, stage.planet) for planet in planets),
        Inertia(sun, stage.sun),
    ]
    meshes = []
    for i, planet in enumerate(planets, start=1):
        meshes += [
            Element(
                f"{name} ring-planet {i}",
                {carrier: by_ring, planet: 1.0},
                stage.ring_planet,
                stage.ring_planet_damping,
            ),
            Element(
                f"{name} sun-planet {i}",
                {carrier: by_sun, planet: -1.0, sun: -1 / stage.planet_over_sun},
                stage.sun_planet,
                stage.sun_planet_damping,
            ),
        ]
    return masses, meshes


def _shaft(row: ShaftRow, front: str, rear: str) -> Element:
    return Element(row.name, {front: 1.0, rear: -1.0}, row.stiffness, row.damping)


def _on_grid(table: GearTable, generator: GeneratorState) -> bool:
    if generator == "fixed" and table.generator.stiffness == 0:
        raise InputError(
            f"drivetrain {shown(table.title)} has no electrical stiffness, so that its generator "
            "cannot be fixed: give generator.stiffness, or ask for the free generator"
        )
    return generator == "fixed"
