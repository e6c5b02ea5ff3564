"""A component: one solid with reference points on its faces, on springs; typed and validated.

The second kind of scene, beside the drivetrain of `Scene`. A key of the file's top
level says which component it is: "gearbox_housing" or "planet_carrier".
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, NamedTuple, TypeVar

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.drivetrain_file.bearing_unit import Keys, within_range
from fe_drivetrain.drivetrain_file.materials import Material, check_material, known_materials
from fe_drivetrain.drivetrain_file.scene import HEAVIEST, Coupling
from fe_drivetrain.drivetrain_file.standing import RigidBody, check_held
from fe_drivetrain.geometry import BodySizes, GearboxHousing, PlanetCarrier


class Attachment(NamedTuple):
    """A reference point of a body, and the face that it moves with.

    Attributes
    ----------
    name : str
        Name of the point.
    face : str
        The face that it moves with, by its name in the mesh.
    position : Floats
        (3,) [m].
    coupling : Coupling
        How it holds the face: "averaged" (RBE3) or "rigid" (RBE2).
    """

    name: str
    face: str
    position: Floats
    coupling: Coupling


class Reference(Keys):
    """How a reference point holds its face."""

    coupling: Coupling = "averaged"


class RigidReference(Keys):
    """The same, of a face that a stiff neighbour keeps in shape."""

    coupling: Coupling = "rigid"


class Bushings(Keys):
    """The elastic bushing in each eye, to ground, and how its outer sleeve holds the eye.

    Stiffness is along x, y, z [N/m] and about them [N m/rad].
    """

    stiffness: Annotated[tuple[float, ...], AfterValidator(within_range)] = Field(
        min_length=6, max_length=6
    )
    coupling: Coupling = "rigid"


class HousingComponent(Keys):
    """A gearbox housing's section on two bushings, loaded at the middle of its ring."""

    title: str
    gearbox_housing: GearboxHousing
    bushings: Bushings
    ring: Reference = Reference()
    weight: float = Field(default=0.0, ge=0, le=HEAVIEST, description="weight [N], along -z")
    materials: Mapping[str, Material] = {}
    mesh: BodySizes = BodySizes()

    __repr__ = short_repr
    __str__ = short_repr

    @model_validator(mode="after")
    def _known_material(self) -> HousingComponent:
        check_material(self.gearbox_housing.material, self.materials)
        return self

    @property
    def body(self) -> GearboxHousing:
        """The solid."""
        return self.gearbox_housing

    @property
    def attachments(self) -> tuple[Attachment, ...]:
        """The ring, and the left (at +y) and the right bushing."""
        x, y, z = self.gearbox_housing.eye
        hold = self.bushings.coupling
        return (
            Attachment("ring", "housing.ring", np.zeros(3), self.ring.coupling),
            Attachment("left", "housing.left", np.array([x, y, z]), hold),
            Attachment("right", "housing.right", np.array([x, -y, z]), hold),
        )

    @property
    def loaded(self) -> tuple[str, ...]:
        """Names of the points that loads come in by."""
        return ("ring",)

    @property
    def supports(self) -> dict[str, Floats]:
        """(6, 6) stiffness to ground by point; inf on the diagonal where it is rigid."""
        given = np.diag(self.bushings.stiffness)
        return {"left": given, "right": given}


class CarrierComponent(Keys):
    """A planet carrier, its flange held, loaded at the middle of each pin."""

    title: str
    planet_carrier: PlanetCarrier
    hub: RigidReference = RigidReference()
    pins: Reference = Reference()
    materials: Mapping[str, Material] = {}
    mesh: BodySizes = BodySizes()

    __repr__ = short_repr
    __str__ = short_repr

    @model_validator(mode="after")
    def _known_material(self) -> CarrierComponent:
        check_material(self.planet_carrier.material, self.materials)
        return self

    @property
    def body(self) -> PlanetCarrier:
        """The solid."""
        return self.planet_carrier

    @property
    def attachments(self) -> tuple[Attachment, ...]:
        """The hub, and the pins from the one at the top on."""
        pins = [
            Attachment(name, f"carrier.{name}", np.array(centre), self.pins.coupling)
            for name, centre in zip(self.loaded, self.planet_carrier.pin_centres(), strict=True)
        ]
        return (Attachment("hub", "carrier.hub", np.zeros(3), self.hub.coupling), *pins)

    @property
    def loaded(self) -> tuple[str, ...]:
        """Names of the points that loads come in by."""
        return tuple(f"pin_{k + 1}" for k in range(self.planet_carrier.planets))

    @property
    def supports(self) -> dict[str, Floats]:
        """(6, 6) stiffness to ground by point; inf on the diagonal where it is rigid."""
        return {"hub": np.diag(np.full(6, np.inf))}


Component = HousingComponent | CarrierComponent
SomeComponent = TypeVar("SomeComponent", HousingComponent, CarrierComponent)

#: By the key that makes a file one of such a component.
COMPONENTS: dict[str, type[HousingComponent] | type[CarrierComponent]] = {
    "gearbox_housing": HousingComponent,
    "planet_carrier": CarrierComponent,
}


def material_of(component: Component) -> Material:
    """What the component is made of."""
    return known_materials(component.materials)[component.body.material]


def check_component_standing(component: Component) -> None:
    """Refuse a component that can move as a rigid body on its supports.

    To be called before it is solved there. Its free body, and what its loaded points feel of it,
    need no such check: two bushings side by side are a hinge, which a shaft in the ring holds.

    Raises
    ------
    InputError
        It is a mechanism; every free motion is named.
    """
    positions = {a.name: a.position for a in component.attachments}
    middle = np.array(component.body.volume_and_centre()[1])
    apart = np.array(list(positions.values())) - middle
    reach = float(np.linalg.norm(apart, axis=1).max())
    body = RigidBody(
        ("housing" if isinstance(component, HousingComponent) else "carrier",),
        middle,
        2.0 * reach,
        middle + reach * np.vstack([np.eye(3), -np.eye(3)]),
        material_of(component).youngs_modulus,
    )
    supports = [(positions[name], k) for name, k in component.supports.items()]
    check_held(
        "component",
        body,
        supports,
        "give the bushings a stiffness in that direction (two side by side are a hinge about y)",
    )
