"""A scene: shaft, bearing units, supports and mesh sizes; typed, validated, and sound."""

from collections.abc import Mapping, Sequence
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import (
    Field,
    field_validator,
    model_validator,
)

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.near_words import did_you_mean
from fe_drivetrain.common.reading import named_keys, value_by_key
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.drivetrain_file.bearing_unit import BearingUnit, Keys, Springs
from fe_drivetrain.drivetrain_file.drivetrain import Drivetrain, Gears
from fe_drivetrain.drivetrain_file.entrance import Entrance
from fe_drivetrain.drivetrain_file.gate import check_scene
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers, free_to_turn, joint_stiffness
from fe_drivetrain.drivetrain_file.materials import MATERIALS, Material, known_materials
from fe_drivetrain.drivetrain_file.nose import Nose, NoseBearing
from fe_drivetrain.drivetrain_file.shaft_strength import ShaftStrength
from fe_drivetrain.drivetrain_file.shared_parts import coupled_units
from fe_drivetrain.drivetrain_file.turning_gate import check_turning
from fe_drivetrain.drivetrain_file.turning_parts import MAX_INERTIA, BearingData, ShaftRow
from fe_drivetrain.geometry import Band, Housing, MeshSizes, Shaft, within_walls
from fe_drivetrain.geometry.part import in_its_field

#: How a reference point holds its face: as its mean motion (RBE3) or as a rigid body (RBE2).
Coupling = Literal["averaged", "rigid"]

#: Largest weight of a part [N]: a hundred times the nacelle of the largest turbines.
HEAVIEST = 1e9


class Hub(Keys):
    """The reference point of the hub loads, at the centre of the shaft's front face.

    Histories of one's own may be about another point of the shaft's axis: the rotor's centre ahead
    of the flange, say, or a strain gauge behind it.
    """

    coupling: Coupling = "averaged"
    loads_at: float | None = Field(
        default=None,
        ge=-1e3,
        le=1e3,
        description="x of what files of hub loads are about [m], at most five lengths of the "
        "shaft from its front face, which it is if left out",
    )


#: What temperatures of parts are above.
ASSEMBLED = "assembled"

Temperature = Annotated[float, Field(ge=-60, le=250, strict=True)]

Inertia = Annotated[float, Field(gt=0, le=MAX_INERTIA)]


class Gearbox(Gears):
    """Springs to ground and a weight at the centre of the shaft's rear face, and what is inside."""

    stiffness: Springs
    weight: float = Field(default=0.0, ge=0, le=HEAVIEST, description="weight [N], along -z")
    coupling: Coupling = "averaged"
    housing_inertia: tuple[Inertia, Inertia] | None = Field(
        default=None,
        description="inertia of the housing about x and across, for models in which it moves on "
        "its mount, kg m^2; of a thin tube round the largest gear where left out",
    )

    @property
    def held(self) -> list[int]:
        """The motions (0-2 displacements, 3-5 rotations) that are rigidly held."""
        return [c for c, k in enumerate(self.stiffness) if k == "rigid"]


class LoadPoint(Keys):
    """Another point of the shaft where loads enter: a gear, a brake disc, a coupling, a mass.

    Forces and moments act on average on the outer surface of the shaft, over a width.
    """

    name: str = Field(
        pattern=r"^[A-Za-z][A-Za-z0-9_-]*$", description="name: letters, digits, '_' and '-'"
    )
    x: float = Field(ge=-1e3, le=1e3, description="x of the middle of its width [m]")
    width: float = Field(gt=0, le=1e3, description="over which the shaft takes its loads [m]")
    weight: float = Field(default=0.0, ge=0, le=HEAVIEST, description="weight [N], along -z")

    @property
    def span(self) -> tuple[float, float]:
        """x of both ends of its width [m]."""
        return self.x - self.width / 2, self.x + self.width / 2


class Spread(Keys):
    """How certain a value is, relative to it: half the width of an even distribution, the standard
    deviation of a normal one, or the coefficient of variation of a lognormal one about its median.
    """

    uniform: float | None = Field(default=None, gt=0, lt=1, description="share of the value")
    normal: float | None = Field(default=None, gt=0, lt=1, description="share of the value")
    lognormal: float | None = Field(default=None, gt=0, lt=10, description="share of the median")

    @model_validator(mode="before")
    @classmethod
    def _shares(cls, data: Any) -> Any:
        for key, high in (("uniform", 1), ("normal", 1)):
            value = data.get(key) if isinstance(data, dict) else None
            if isinstance(value, int | float) and value >= high:
                raise ValueError(
                    f"{key} is {value:g} but is a share of the value, below {high}: write "
                    f"{{{key}: 0.05}} for 5 %"
                )
        return data

    @model_validator(mode="after")
    def _one(self) -> "Spread":
        given = [k for k in ("uniform", "normal", "lognormal") if getattr(self, k) is not None]
        if len(given) != 1:
            raise ValueError(
                f"give one of uniform, normal and lognormal, not {' and '.join(given) or 'none'}"
            )
        return self


class Scene(Drivetrain):
    """A drivetrain: one shaft on any number of bearing units, or round a nose; a hub, a gearbox.

    Whatever is to be done with a scene, it is sound from the start: see
    `fe_drivetrain.drivetrain_file.gate.check_scene`.
    """

    shaft: Shaft
    bearing_units: tuple[BearingUnit, ...] = ()
    nose: Nose | None = None
    hub: Hub = Hub()
    gearbox: Gearbox
    load_points: tuple[LoadPoint, ...] = ()
    materials: Mapping[str, Material] = {}
    strength: ShaftStrength | None = None
    mesh: MeshSizes = MeshSizes()
    uncertainty: Mapping[str, Spread] = {}
    temperatures: Mapping[str, Temperature] = Field(
        default={},
        description="temperature of parts by their names, 'shaft', 'NAME' of a bearing and "
        "'NAME.housing' [degC]; 'assembled' is that of all others, 20 if left out",
    )

    _strength = field_validator("strength", mode="wrap")(in_its_field)

    @model_validator(mode="after")
    def _consistent(self) -> "Scene":
        check_scene(self, self.gearbox.stiffness, [point.name for point in self.load_points])
        if self.strength is not None:
            self.strength.check_fits(self.shaft)
        check_spreads(self, self.uncertainty)
        check_temperatures(self)
        if self.states_gears or self.limits or self.whirl:
            check_turning(self, main_shaft(self), main_bearings(self))
        return self

    def __repr__(self) -> str:
        """One line: the title, the length of the shaft, and the bearings."""
        units = [unit.bearing.name for unit in self.bearing_units]
        names = ", ".join([*units, *(bearing.name for bearing in self.nose_bearings)])
        return f"<Scene {self.title!r}: shaft of {self.shaft.length:.4g} m, bearings {names}>"

    __str__ = __repr__

    def material_of(self, part: str) -> Material:
        """The material of a part, by the part's name in the mesh."""
        return known_materials(self.materials)[self.material_name(part)]

    def material_name(self, part: str) -> str:
        """The name of a part's material, by the part's name in the mesh."""
        if part == "shaft":
            return self.shaft.material
        if part == "nose" and self.nose is not None:
            return self.nose.body.material
        name, _, housing = part.partition(".")
        unit = self.bearing_unit(name)
        if not housing:
            return unit.bearing.material
        if unit.condensed is not None:
            raise InputError(f"{part} is a stiffness alone, and has no material: leave it out")
        return unit.housing_parts[part].material

    def free_strain(self, part: str) -> float:
        """Strain of a part that is free to expand, by its temperature."""
        assembled = self.temperatures.get(ASSEMBLED, 20.0)
        warmer = self.temperatures.get(part, assembled) - assembled
        return warmer * self.material_of(part).expansion(part) if warmer else 0.0

    @property
    def blocks(self) -> dict[str, Housing]:
        """Parametric housings by the name of the bearing; those from files are none."""
        return {
            unit.bearing.name: unit.housing
            for unit in self.bearing_units
            if isinstance(unit.housing, Housing)
        }

    @property
    def bands(self) -> dict[str, Band]:
        """Where on the shaft each load point's loads enter, by its name."""
        return {point.name: Band(*point.span) for point in self.load_points}

    @property
    def coupled_units(self) -> tuple[tuple[str, ...], ...]:
        """Names of bearings whose housings stand on the same parts, the parts' own unit first."""
        return coupled_units(self.bearing_units)

    @property
    def guests(self) -> frozenset[str]:
        """Names of bearings whose housings stand on parts of another unit alone."""
        return frozenset(name for _, *others in self.coupled_units for name in others)

    @property
    def nose_bearings(self) -> tuple[NoseBearing, ...]:
        """The bearings between shaft and nose; none where there is no nose."""
        return () if self.nose is None else self.nose.bearings

    @property
    def seats(self) -> dict[str, Band]:
        """Faces of the shaft beside its ends and the seats of bearing units: of nose and loads."""
        return {b.name: Band(*b.span, inside=True) for b in self.nose_bearings} | self.bands

    @property
    def bearing_names(self) -> list[str]:
        """Names of all bearings, those of bearing units first."""
        return [
            *(u.bearing.name for u in self.bearing_units),
            *(b.name for b in self.nose_bearings),
        ]

    @property
    def loads_at(self) -> float:
        """x of the point that files of hub loads are about [m]."""
        return self.shaft.front if self.hub.loads_at is None else self.hub.loads_at

    @property
    def entrance(self) -> Entrance:
        """Where loads enter, and which point they are about."""
        return Entrance(
            self.shaft.front,
            self.loads_at,
            tuple(point.name for point in self.load_points),
            tuple(point.weight for point in self.load_points),
        )

    def bearing_unit(self, name: str) -> BearingUnit:
        """The bearing unit of that name."""
        return next(unit for unit in self.bearing_units if unit.bearing.name == name)

    def seat_diameter(self, name: str) -> float:
        """Diameter of the shaft under the bearing of a unit [m]: all that the unit knows of it."""
        bearing = self.bearing_unit(name).bearing
        return self.shaft.seat_diameter(bearing.x, bearing.width, name)


def check_temperatures(scene: Scene) -> None:
    """Refuse temperatures of parts that there are not, or that cannot expand.

    Parameters
    ----------
    scene : Scene
        The scene.

    Raises
    ------
    InputError
    """
    parts = ["shaft"]
    for unit in scene.bearing_units:
        parts += [unit.bearing.name, *unit.housing_parts]
    for name in scene.temperatures:
        if name not in (ASSEMBLED, *parts):
            raise InputError(
                f"temperatures: the scene has no part {shown(name)}: name one of "
                f"{', '.join(parts)}, or '{ASSEMBLED}'"
            )
    if scene.temperatures and scene.nose is not None:
        raise InputError(
            "temperatures of a scene with a nose are not computed: leave one of both out"
        )
    for part in parts:
        scene.free_strain(part)


#: A joint or a mount that holds rigidly, as a spring [N/m, N m/rad]: a hundred times and more what
#: bearings and housings of the largest turbines have.
RIGID = 1e12


def main_shaft(scene: Scene) -> ShaftRow:
    """The scene's main shaft as a row beside the shafts of its gearbox, the flange a section."""
    return ShaftRow(
        name=scene.shaft.name, sections=scene.shaft.pieces, material=scene.material_of("shaft")
    )


def main_bearings(
    scene: Scene, supports: Mapping[str, Floats] | None = None
) -> tuple[BearingData, ...]:
    """Bearings of the scene's main shaft as rows beside those of its gearbox.

    Parameters
    ----------
    scene : Scene
        The scene.
    supports : mapping of str to ndarray (6, 6), optional
        Stiffness of bearings with their housings, at the bearing's centre [N/m, N, N m/rad], see
        `fe_drivetrain.shafts.fidelity.main_supports`; others are the joint alone, in a rigid
        housing. All let the shaft turn: housings carry no torque about x. Without gear stages the
        shaft's rear is held by the springs of ``gearbox.stiffness``.
    """
    given = supports or {}
    held = {
        unit.bearing.name: (unit.bearing.x, joint_stiffness(unit)) for unit in scene.bearing_units
    }
    held |= {b.name: (b.x, np.diag(as_numbers(b.stiffness))) for b in scene.nose_bearings}
    if not scene.gearbox.stages:
        held["gearbox"] = (scene.shaft.rear, np.diag(as_numbers(scene.gearbox.stiffness)))
    found = []
    for name, (x, joint) in held.items():
        K = np.array(given.get(name, joint), dtype=float)
        K[~np.isfinite(K)] = RIGID
        K = free_to_turn(K)
        if not K.any():
            continue
        coupled = np.abs(K - np.diag(K.diagonal())).max() > 0
        stiffness = tuple(map(tuple, K.tolist())) if coupled else tuple(K.diagonal().tolist())
        at = min(max(x - scene.shaft.front, 0.0), scene.shaft.length)
        entry = _entry_of(scene, name)
        found.append(
            BearingData.model_validate(
                {"name": name, "holds": scene.shaft.name, "at": at, "stiffness": stiffness, **entry}
            )
        )
    return tuple(found)


def _entry_of(scene: Scene, name: str) -> dict[str, Any]:
    """The catalogue entry of a bearing unit and its mounting, where it has them."""
    for unit in scene.bearing_units:
        if unit.bearing.name == name and unit.catalogue is not None:
            return {"catalogue": unit.catalogue, "mounting": unit.mounting}
    return {}


def with_materials(scene: Scene) -> Scene:
    """The scene with materials of the program that it uses among its own, where they have keys."""
    used = {scene.shaft.material}
    if scene.nose is not None:
        used.add(scene.nose.body.material)
    for unit in scene.bearing_units:
        solids = (unit.bearing, *unit.housing_parts.values())
        used |= {solid.material for solid in solids}
    own = {name: MATERIALS[name] for name in used if name in MATERIALS}
    return scene.model_copy(update={"materials": own | dict(scene.materials)})


def nominal_values(
    scene: Drivetrain, keys: Sequence[str], what: str = "uncertainty of"
) -> list[float]:
    """The numbers that dotted keys lead to; a bearing unit is addressed by its bearing's name.

    Parameters
    ----------
    scene : Drivetrain
        The scene, or another drivetrain.
    keys : Sequence[str]
        Keys as `fe_drivetrain.drivetrain_file.change_scene` takes them.
    what : str
        What the keys are of, for messages.

    Raises
    ------
    InputError
        There is none, or it is no number.
    """
    data = plain_data(scene)
    return [_number(data, key, what) for key in keys]


def plain_data(scene: Drivetrain) -> dict[str, Any]:
    """All that keys may lead to, the program's materials that are used with it."""
    stated = with_materials(scene) if isinstance(scene, Scene) else scene
    return stated.model_dump(mode="json")


def _number(data: Any, key: str, what: str) -> float:
    value = value_by_key(data, key)
    if isinstance(value, bool) or not isinstance(value, int | float):
        near = did_you_mean(key, named_keys(data))
        raise InputError(
            f"{what} {shown(key)}: the scene has no number there: "
            + (near or "name a value that it gives, as in shaft.sections.0.outer_diameter")
        )
    return float(value)


def check_spreads(scene: Drivetrain, spreads: Mapping[str, Spread]) -> None:
    """Refuse uncertain values that cannot be uncertain.

    Parameters
    ----------
    scene : Drivetrain
        The scene, or another drivetrain.
    spreads : mapping of str to Spread
        Its uncertain values by key; may be empty.

    Raises
    ------
    InputError
        A key leads to no number, or to zero, which has no relative spread.
    """
    if not spreads:
        return
    keys = list(spreads)
    for key, value in zip(keys, nominal_values(scene, keys), strict=True):
        if value == 0.0:
            raise InputError(
                f"uncertainty of {shown(key)}: the value is 0, and a spread is relative to it: "
                "leave it out, or shift the frame so that the value differs from 0"
            )


def coarser_scene(scene: Scene, factor: float, elements_per_turn: int) -> Scene:
    """A scene on a coarser mesh, as far as its walls allow.

    Parameters
    ----------
    scene : Scene
        The scene.
    factor : float
        Factor of its mesh sizes; what a thin wall does not allow stays smaller.
    elements_per_turn : int
        Round any cylinder.
    """
    units = scene.bearing_units
    sizes = within_walls(
        scene.mesh.scaled(factor, elements_per_turn),
        scene.shaft,
        [unit.bearing for unit in units],
        scene.blocks,
    )
    if scene.nose is not None:
        sizes = within_walls(sizes, scene.nose.body, [], {})
    return scene.model_copy(update={"mesh": sizes})
