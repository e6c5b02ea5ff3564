"""Strength of the gears of a stage: steels, roughness, accuracy, load factors that are given."""

from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self

from pydantic import Field, field_validator, model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.geometry.part import Assumption, Part, dimension

#: Allowable stress numbers sigma_Hlim and sigma_Flim [Pa] of ISO 6336-5 by steel and quality; of
#: case-hardened MQ the lowest of its three root limits, of a core of 25 HRC. UNVERIFIED: from
#: memory, no public text prints the tables. Of case-hardened MQ alone a public source has numbers:
#: reports of KISSsoft 03/2017 (gfsReboucas/Drivetrain) rate 18CrNiMo7-6, "ISO 6336-5 Figure 9/10
#: (MQ), Core hardness >= 25HRC", with 1500 and 430 MPa, 1 % above the root limit here.
QUALITIES = {
    "case-hardened": {"ML": (1300e6, 312e6), "MQ": (1500e6, 425e6), "ME": (1650e6, 525e6)},
    "nitrided": {"ML": (1125e6, 270e6), "MQ": (1250e6, 420e6), "ME": (1450e6, 468e6)},
}

#: Names of the meshes of a stage with these gears.
MESHES_OF: dict[tuple[str, ...], tuple[str, ...]] = {
    ("planet", "ring", "sun"): ("ring_planet", "sun_planet"),
    ("gear", "pinion"): ("mesh",),
}

Factor = Annotated[float, Field(ge=1.0, le=10.0)]


class GearSteel(Part):
    """Steel of one gear, and how smooth its teeth are."""

    steel: Literal["case-hardened", "through-hardened", "nitrided"] = Field(
        description="material and heat treatment: case-hardened, through-hardened or nitrided"
    )
    quality: Literal["ML", "MQ", "ME"] | None = Field(
        default=None, description="quality of ISO 6336-5, which gives both limits; or give them"
    )
    contact_limit: float | None = dimension(
        None, of="sigma_Hlim, contact pressure endured", unit="Pa", gt=1e8, le=3e9
    )
    root_limit: float | None = dimension(
        None, of="sigma_Flim, nominal root stress endured", unit="Pa", gt=1e7, le=1e9
    )
    yield_strength: float | None = dimension(
        None, of="yield strength of through-hardened steel", unit="Pa", gt=1e8, le=2e9
    )
    brinell: float | None = dimension(
        None, of="hardness of through-hardened steel, HB", unit="-", gt=100, le=700
    )
    flank_roughness: float = dimension(
        4.8e-6, of="R_z of the flanks", ge=1e-7, le=1e-4, source="assumed: ground flanks, 4.8 um"
    )
    root_roughness: float = dimension(
        20e-6, of="R_z of the fillets", ge=1e-7, le=1e-4, source="assumed: 20 um"
    )
    rim: float | None = dimension(
        None, of="rim thickness below the teeth", gt=0, le=5, source="assumed: a thick rim"
    )

    @model_validator(mode="after")
    def _limits(self) -> Self:
        given = (self.contact_limit is not None, self.root_limit is not None)
        if self.quality is not None:
            if any(given):
                raise InputError(
                    f"steel has quality {self.quality} and a limit of its own: give the quality, "
                    "or both contact_limit and root_limit"
                )
            if self.steel not in QUALITIES:
                raise InputError(
                    f"quality {self.quality} of a {self.steel} steel gives no limits here, since "
                    "they depend on its hardness: give contact_limit and root_limit in Pa"
                )
        elif not all(given):
            raise InputError(
                f"a {self.steel} steel needs contact_limit and root_limit in Pa, or a quality of "
                "ISO 6336-5 (ML, MQ, ME): give them"
            )
        if self.steel == "through-hardened" and None in (self.yield_strength, self.brinell):
            raise InputError(
                "a through-hardened steel needs its yield_strength in Pa and its hardness, "
                "brinell, in HB: give both"
            )
        return self

    def assumptions(self) -> list[Assumption]:
        """Say what is assumed, and that limits by quality are not verified."""
        rows = super().assumptions()
        if self.quality is None:
            return rows
        source = f"assumed: {self.steel} of ISO 6336-5, quality {self.quality}; unverified"
        named = zip(("contact_limit", "root_limit"), self.limits, strict=True)
        return [*rows, *(Assumption(name, value, "Pa", source) for name, value in named)]

    @property
    def limits(self) -> tuple[float, float]:
        """Contact and root limit, sigma_Hlim and sigma_Flim [Pa]."""
        if self.quality is not None:
            return QUALITIES[self.steel][self.quality]
        return self.contact_limit or 0.0, self.root_limit or 0.0


class GearStrength(Part):
    """What a rating by ISO 6336 needs of a stage beside its geometry."""

    gears: dict[str, GearSteel] = Field(
        description="steels by gear: ring, planet and sun, or gear and pinion"
    )
    grade: int | None = Field(
        default=None, ge=1, le=12, description="accuracy grade of ISO 1328-1, for K_v and K_Halpha"
    )
    application: Factor | None = Field(
        default=None, description="application factor K_A of the rated torque"
    )
    sharing: Factor | None = Field(
        default=None, description="mesh load factor K_gamma of the torsional level"
    )
    face_load: dict[str, Factor] | None = Field(
        default=None,
        description="face load factors K_Hbeta of the torsional level by mesh: ring_planet and "
        "sun_planet, or mesh",
    )
    dynamic: dict[str, Factor] | None = Field(
        default=None, description="dynamic factors K_v by mesh, in place of those by the grade"
    )
    contact_safety: float = dimension(
        1.25, of="least S_H", unit="-", gt=0, le=10, source="assumed: IEC 61400-4, 1.25"
    )
    root_safety: float = dimension(
        1.56, of="least S_F", unit="-", gt=0, le=10, source="assumed: IEC 61400-4, 1.56"
    )

    @field_validator("gears", mode="before")
    @classmethod
    def _steels(cls, value: Any) -> Any:
        if not isinstance(value, Mapping):
            return value
        found = {}
        for name, steel in value.items():
            try:
                given = isinstance(steel, Mapping)
                found[name] = GearSteel.model_validate(steel) if given else steel
            except InputError as error:
                raise InputError(f"gears: {name}: {error}") from None
        return found

    @model_validator(mode="after")
    def _of_one_stage(self) -> Self:
        gears = tuple(sorted(self.gears))
        if gears not in MESHES_OF:
            raise InputError(
                f"a strength has the gears {', '.join(self.gears) or 'none'} but must have ring, "
                "planet and sun of a planetary stage, or gear and pinion of a parallel one: name "
                "them"
            )
        for name in ("face_load", "dynamic"):
            given = getattr(self, name)
            if given is not None and not set(given) <= set(MESHES_OF[gears]):
                raise InputError(
                    f"{name} of a strength has {', '.join(given)} but its meshes are "
                    f"{' and '.join(MESHES_OF[gears])}: name these"
                )
        return self

    def assumptions(self) -> list[Assumption]:
        """Say what is assumed, of each gear too."""
        of_gears = [
            row._replace(name=f"{name}: {row.name}")
            for name, steel in self.gears.items()
            for row in steel.assumptions()
        ]
        return [*super().assumptions(), *of_gears]
