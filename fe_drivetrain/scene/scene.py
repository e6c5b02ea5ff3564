"""A scene: shaft, bearing units, supports and mesh sizes; typed, validated, and sound."""

from collections.abc import Mapping, Sequence
from typing import Any, Literal

from pydantic import (
    Field,
    model_validator,
)

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import value_by_key
from fe_drivetrain.common.strict_yaml import shown
from fe_drivetrain.geometry import (
    Band,
    Housing,
    MeshSizes,
    Shaft,
    check_bands,
    check_parts,
    refuse_millimetres,
    within_walls,
)
from fe_drivetrain.scene.bearing_unit import SPHERICAL_JOINTS, BearingUnit, Keys, Springs
from fe_drivetrain.scene.entrance import Entrance
from fe_drivetrain.scene.joint_springs import as_numbers
from fe_drivetrain.scene.materials import MATERIALS, Material, known_materials
from fe_drivetrain.scene.nose import Nose, NoseBearing
from fe_drivetrain.scene.shared_parts import check_shared, coupled_units
from fe_drivetrain.scene.standing import check_standing

#: How a reference point holds its face: as its mean motion (RBE3) or as a rigid body (RBE2).
Coupling = Literal["averaged", "rigid"]

#: Largest weight of a part [N]: a hundred times the nacelle of the largest turbines.
HEAVIEST = 1e9

#: Farthest point that hub loads are about from the front face, in lengths of the shaft: the rotor's
#: centre is ahead of it by less than one, the tower's axis behind it by up to five (12 m in the
#: IEA 15 MW turbine, whose shaft is 2.4 m long). Beyond it a force's moment is of another machine.
FARTHEST = 5.0

#: Names that load points cannot have: loads and points of every scene.
_RESERVED = ("hub", "gearbox", "gravity", "shaft", "nose")


def check_material(name: str, defined: Mapping[str, Material], of: str = "") -> None:
    """Refuse a material that neither the program nor a scene has.

    Parameters
    ----------
    name : str
        Name of the material.
    defined : mapping
        Those that the scene defines.
    of : str
        The part, where there are several, as in " of shaft".

    Raises
    ------
    ValueError
    """
    known = known_materials(defined)
    if name not in known:
        raise ValueError(
            f"material {shown(name)}{of} is unknown: use one of {', '.join(known)}, or define it "
            "under 'materials'"
        )


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


class Gearbox(Keys):
    """Springs to ground and a weight, at the centre of the shaft's rear face."""

    stiffness: Springs
    weight: float = Field(default=0.0, ge=0, le=HEAVIEST, description="weight [N], along -z")
    coupling: Coupling = "averaged"

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

    uniform: float | None = Field(default=None, gt=0, lt=1)
    normal: float | None = Field(default=None, gt=0, lt=1)
    lognormal: float | None = Field(default=None, gt=0, lt=10)

    @model_validator(mode="after")
    def _one(self) -> "Spread":
        given = [k for k in ("uniform", "normal", "lognormal") if getattr(self, k) is not None]
        if len(given) != 1:
            raise ValueError(
                f"give one of uniform, normal and lognormal, not {' and '.join(given) or 'none'}"
            )
        return self


class Scene(Keys):
    """A drivetrain: one shaft on any number of bearing units, or round a nose; a hub, a gearbox.

    Whatever is to be done with a scene, it is sound from the start: its parts fit together
    (`fe_drivetrain.geometry.check_parts`), and it is no mechanism (`check_standing`).
    """

    title: str
    shaft: Shaft
    bearing_units: tuple[BearingUnit, ...] = ()
    nose: Nose | None = None
    hub: Hub = Hub()
    gearbox: Gearbox
    load_points: tuple[LoadPoint, ...] = ()
    materials: Mapping[str, Material] = {}
    mesh: MeshSizes = MeshSizes()
    uncertainty: Mapping[str, Spread] = {}

    @model_validator(mode="after")
    def _consistent(self) -> "Scene":
        names = self.bearing_names
        if not names:
            raise ValueError("there is no bearing: give bearing_units, or a nose with bearings")
        if set(names) & set(_RESERVED):
            raise ValueError(f"bearing names {names} must not be one of {', '.join(_RESERVED)}")
        if len(set(names)) < len(names):
            raise ValueError(f"bearing names {names} must differ from each other")
        taken = {*names, *_RESERVED}
        for point in self.load_points:
            if point.name in taken:
                raise ValueError(
                    f"load point {point.name!r} has the name of another point of the scene "
                    f"({', '.join(sorted(taken))}): rename it"
                )
            taken.add(point.name)
        used = [("shaft", self.shaft.material)]
        for unit in self.bearing_units:
            used.append((unit.bearing.name, unit.bearing.material))
            used += [(part, solid.material) for part, solid in unit.housing_parts.items()]
            if unit.interface in SPHERICAL_JOINTS and unit.bearing.kind != "spherical":
                raise ValueError(
                    f"bearing {unit.bearing.name!r} of kind {unit.bearing.kind!r} cannot have the "
                    f"spherical-joint interface {unit.interface!r}: make its kind 'spherical' or "
                    "its interface 'bonded', 'spring' or 'rollers'"
                )
        for part, material in used:
            check_material(material, self.materials, f" of {part}")
        check_parts(
            self.shaft,
            [unit.bearing for unit in self.bearing_units],
            self.blocks,
        )
        if self.nose is not None:
            check_material(self.nose.body.material, self.materials, " of nose")
            refuse_millimetres(
                "nose",
                self.nose.body.length,
                2 * max(map(self.nose.body.outer_radius, self.nose.body.stations)),
            )
            self.nose.check_fits(self.shaft)
        check_shared(self.bearing_units)
        check_bands(self.shaft, self.seats, [unit.bearing for unit in self.bearing_units])
        self._check_hub()
        check_spreads(self)
        gearbox = as_numbers(self.gearbox.stiffness)
        modulus = self.material_of("shaft").youngs_modulus
        check_standing(self.shaft, self.bearing_units, gearbox, modulus, self.nose_bearings)
        return self

    def _check_hub(self) -> None:
        """Refuse hub loads about a point that is on no machine with such a shaft."""
        front, reach = self.shaft.front, FARTHEST * self.shaft.length
        if abs(self.loads_at - front) > reach:
            raise InputError(
                f"hub.loads_at is {self.loads_at:g} m but must be from {front - reach:g} to "
                f"{front + reach:g} m, at most {FARTHEST:g} lengths of the shaft from its front "
                f"face at {front:g} m: give x of the point that your hub loads are about, in m, or "
                "leave it out where that is the front face"
            )

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


def nominal_values(scene: Scene, keys: Sequence[str]) -> list[float]:
    """The numbers that dotted keys lead to; a bearing unit is addressed by its bearing's name.

    Parameters
    ----------
    scene : Scene
        The scene.
    keys : Sequence[str]
        As for `fe_drivetrain.scene.change_scene`.

    Raises
    ------
    InputError
        There is none, or it is no number.
    """
    data = with_materials(scene).model_dump(mode="json")
    return [_number(data, key) for key in keys]


def _number(data: Any, key: str) -> float:
    value = value_by_key(data, key)
    if isinstance(value, bool) or not isinstance(value, int | float):
        raise InputError(
            f"uncertainty of {shown(key)}: the scene has no number there: name a value that it "
            "gives, as in shaft.sections.0.outer_diameter"
        )
    return float(value)


def check_spreads(scene: Scene) -> None:
    """Refuse uncertain values that cannot be uncertain.

    Parameters
    ----------
    scene : Scene
        With spreads, or without any.

    Raises
    ------
    InputError
        A key leads to no number, or to zero, which has no relative spread.
    """
    if not scene.uncertainty:
        return
    keys = list(scene.uncertainty)
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
        Of its mesh sizes; what a thin wall does not allow stays smaller.
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
