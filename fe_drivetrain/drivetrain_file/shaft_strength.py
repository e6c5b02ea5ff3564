"""Strength of the main shaft: its steel, what else than steps weakens it, and its joints."""

from __future__ import annotations

from typing import Literal, Self

from pydantic import Field, field_validator, model_validator

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.geometry import Shaft
from fe_drivetrain.geometry.part import Part, dimension, in_its_field, rows_of

Steel = Literal[
    "quenched and tempered", "structural", "case-hardened CrNiMo", "case-hardened", "nitrided"
]
"""Kinds of steel whose strength falls with the diameter in different ways (DIN 743-2)."""

#: Keys that each kind of notch needs beside its place; others are refused.
NOTCH_KEYS = {
    "groove": ("radius", "depth"),
    "hole": ("radius",),
    "keyway": (),
    "two keyways": (),
    "press fit": (),
}


class ShaftNotch(Part):
    """A weak place of the shaft that its sections do not show."""

    name: str = Field(description="name, as results call it")
    x: float = dimension(of="x of its middle, or of the hub's end")
    kind: Literal["groove", "hole", "keyway", "two keyways", "press fit"] = Field(
        description="round groove, hole across the axis, keyway, two keyways, or hub on a press fit"
    )
    radius: float | None = dimension(None, of="radius of the groove's root, or of the hole", gt=0)
    depth: float | None = dimension(None, of="depth of the groove", gt=0)

    @model_validator(mode="after")
    def _complete(self) -> Self:
        needed = NOTCH_KEYS[self.kind]
        given = [key for key in ("radius", "depth") if getattr(self, key) is not None]
        if sorted(given) != sorted(needed):
            raise InputError(
                f"notch {self.name!r} is a {self.kind} and has {' and '.join(given) or 'no size'} "
                f"but needs {' and '.join(needed) or 'none'}: correct its keys"
            )
        return self


class FlangeBolts(Part):
    """Bolts of the front flange, which clamp it to the hub."""

    count: int = Field(ge=3, le=1000, description="number of bolts, evenly round the axis")
    circle: float = dimension(of="diameter of the bolt circle", gt=0)
    preload: float = dimension(of="least preload of each bolt in operation", unit="N", gt=0, le=1e8)
    friction: float = dimension(
        0.15, of="friction of the faces", unit="-", gt=0, le=1, source="assumed: dry steel, 0.15"
    )
    slip_safety: float = dimension(
        1.2, of="least safety against slip", unit="-", gt=0, le=10, source="assumed: 1.2"
    )
    opening_safety: float = dimension(
        1.0,
        of="least safety against separation",
        unit="-",
        gt=0,
        le=10,
        source="assumed: the faces just stay together, 1.0",
    )


class PressFit(Part):
    """A hub that is pressed on the shaft, as of a shrink disc or a coupling, by interference."""

    name: str = Field(description="name, as results call it")
    x: float = dimension(of="x of its middle")
    length: float = dimension(of="length of contact", gt=0)
    hub_diameter: float = dimension(of="outer diameter of the hub", gt=0)
    interference: float = dimension(of="least interference of the diameters", gt=0)
    friction: float = dimension(
        0.12, of="friction of the faces", unit="-", gt=0, le=1, source="assumed: steel, 0.12"
    )
    smoothing: float = dimension(
        0.0,
        of="loss of interference by smoothing, 0.8 of both roughnesses R_z by DIN 7190",
        ge=0,
        source="assumed: none",
    )
    slip_safety: float = dimension(
        1.2, of="least safety against slip", unit="-", gt=0, le=10, source="assumed: 1.2"
    )


class ShaftStrength(Part):
    """What the strength of the main shaft needs beside its shape."""

    steel: Steel = Field(description="kind of steel, by which its strength falls with the diameter")
    tensile_strength: float = dimension(
        of="R_m at the reference diameter", unit="Pa", gt=1e8, le=3e9
    )
    yield_strength: float = dimension(
        of="R_e, R_p0.2 at the reference diameter", unit="Pa", gt=5e7, le=3e9
    )
    reference_diameter: float | None = dimension(
        None,
        of="diameter at which both were measured; that of the tables of DIN 743-3 where left out",
        ge=5e-3,
        le=10,
    )
    bending_limit: float | None = dimension(
        None,
        of="fatigue limit in reversed bending of a plain bar; 0.5 R_m",
        unit="Pa",
        gt=1e7,
        le=2e9,
    )
    tension_limit: float | None = dimension(
        None, of="fatigue limit in tension and compression; 0.4 R_m", unit="Pa", gt=1e7, le=2e9
    )
    torsion_limit: float | None = dimension(
        None, of="fatigue limit in reversed torsion; 0.3 R_m", unit="Pa", gt=1e7, le=2e9
    )
    roughness: float = dimension(
        12.5e-6, of="R_z of the surface", gt=0, le=1e-3, source="assumed: fine turned, 12.5 um"
    )
    hardening: float = dimension(
        1.0,
        of="factor K_V of rolling or shot peening",
        unit="-",
        ge=1,
        le=3,
        source="assumed: none",
    )
    surface: Literal["soft", "hardened"] = Field(
        default="soft", description="soft as the core, or hardened"
    )
    mean_stress: Literal[1, 2] = Field(
        default=2,
        description="case of DIN 743-1: 1, mean stress stays as amplitudes grow; 2, both grow",
        json_schema_extra={"unit": "-", "source": "assumed: loads grow together, case 2"},
    )
    bearing_seats: Literal["press fit", "plain"] = Field(
        default="press fit",
        description="how the ends of bearing seats count",
        json_schema_extra={"unit": "-", "source": "assumed: inner rings as hubs on a press fit"},
    )
    normal_slope: float = dimension(
        5.0,
        of="slope of the S-N curve of normal stress",
        unit="-",
        gt=1,
        le=20,
        source="assumed: 5",
    )
    shear_slope: float = dimension(
        8.0, of="slope of the S-N curve of shear stress", unit="-", gt=1, le=20, source="assumed: 8"
    )
    knee_cycles: float = dimension(
        1e6, of="cycles at the knee of both", unit="-", gt=1e4, le=1e9, source="assumed: 1e6"
    )
    below_knee: Literal["haibach", "elementary"] = Field(
        default="haibach",
        description="slope below the knee: 2 k - 1 after Haibach, or k",
        json_schema_extra={"unit": "-", "source": "assumed: 2 k - 1 after Haibach"},
    )
    fatigue_safety: float = dimension(
        1.2, of="least S_D", unit="-", gt=0, le=10, source="assumed: DIN 743, 1.2"
    )
    static_safety: float = dimension(
        1.2, of="least S_F", unit="-", gt=0, le=10, source="assumed: DIN 743, 1.2"
    )
    notches: tuple[ShaftNotch, ...] = Field(
        default=(), description="weak places that the sections do not show"
    )
    flange: FlangeBolts | None = Field(default=None, description="bolts of the front flange")
    press_fits: tuple[PressFit, ...] = Field(default=(), description="hubs on press fits")

    _notches = field_validator("notches", mode="before")(rows_of("notch", ShaftNotch))
    _fits = field_validator("press_fits", mode="before")(rows_of("press fit", PressFit))
    _flange = field_validator("flange", mode="wrap")(in_its_field)

    @model_validator(mode="after")
    def _sound(self) -> Self:
        if self.yield_strength > self.tensile_strength:
            raise InputError(
                f"yield_strength is {self.yield_strength:g} Pa but must be at most the "
                f"tensile_strength, {self.tensile_strength:g} Pa: exchange or correct them"
            )
        names = [*(one.name for one in self.notches), *(one.name for one in self.press_fits)]
        for name in names:
            if names.count(name) > 1:
                raise InputError(
                    f"notches and press_fits have {name!r} {names.count(name)} times but each name "
                    "once: rename one"
                )
        return self

    def check_fits(self, shaft: Shaft) -> None:
        """Refuse notches and press fits that are not on the shaft, or leave no wall.

        Parameters
        ----------
        shaft : Shaft
            The main shaft.

        Raises
        ------
        InputError
        """
        for notch in self.notches:
            _check_on(shaft, f"notch {notch.name!r}", notch.x, notch.x)
            wall = shaft.outer_radius(notch.x) - shaft.inner_radius(notch.x)
            size = notch.depth if notch.kind == "groove" else notch.radius
            if size is not None and size >= wall:
                raise InputError(
                    f"notch {notch.name!r} at x = {notch.x:g} m has a {notch.kind} of {size:g} m "
                    f"but the wall there is {wall:g} m: make it smaller"
                )
        for fit in self.press_fits:
            half = fit.length / 2
            _check_on(shaft, f"press fit {fit.name!r}", fit.x - half, fit.x + half)
            seat = shaft.seat_diameter(fit.x, fit.length, fit.name, "press fit")
            if fit.hub_diameter <= seat or fit.interference > 0.01 * seat:
                raise InputError(
                    f"press fit {fit.name!r} has a hub of {fit.hub_diameter:g} m and an "
                    f"interference of {fit.interference:g} m on a seat of {seat:g} m: the hub must "
                    "be wider than the seat, and the interference at most 1 % of it"
                )
        if self.flange is not None:
            widest = 2 * shaft.outer_radius(shaft.front)
            if self.flange.circle >= widest:
                raise InputError(
                    f"flange: circle is {self.flange.circle:g} m but must be less than the front "
                    f"face, {widest:g} m: correct it, or the shaft's flange"
                )


def _check_on(shaft: Shaft, what: str, low: float, high: float) -> None:
    if not shaft.front <= low <= high <= shaft.rear:
        raise InputError(
            f"{what} is at x = {low:g} to {high:g} m but must be on the shaft, from "
            f"{shaft.front:g} to {shaft.rear:g} m: move it"
        )
