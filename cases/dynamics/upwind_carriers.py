"""A carrier as a solid, and how much softer or stiffer it may be."""

from __future__ import annotations

from dataclasses import dataclass, replace

from fe_drivetrain.cases.dynamics.carrier_in_size import carrier_in_size
from fe_drivetrain.cases.dynamics.upwind_guess import RIGID
from fe_drivetrain.cases.dynamics.upwind_model import FirstStage
from fe_drivetrain.drivetrain_file import CarrierComponent
from fe_drivetrain.drivetrain_file.carriers import carriers_of
from fe_drivetrain.elasticity.solve.condensation import Condensed
from fe_drivetrain.report.suite import ChosenDrivetrain, Record, Run
from fe_drivetrain.shafts.fidelity import coarser, solid_component
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame

QUICK, FULL, COARSER = 3.5, 1.35, 1.8
"""Factors on the mesh size of the component: of a quick and a full run, and of variants."""
VARIANTS = {
    "thinner cheeks, narrow webs": (0.7, 0.67),
    "thicker cheeks, wide webs": (1.3, 1.2),
}
"""Thickness of cheeks and angle of webs, over those of the carrier."""


@dataclass(frozen=True)
class Carriers:
    """The carrier, as a solid, and how much softer or stiffer others may be.

    Attributes
    ----------
    body : Condensed
        The carrier, condensed.
    softest, stiffest : float
        Compliance of its variants, over its own.
    rows : list of Record
        What each variant alone gives.
    cheek : float
        x of the upwind cheek's middle from that of the pins [m].
    change : float or None
        Change of the ratio by a mesh of a third coarser; None of a quick run.
    """

    body: Condensed
    softest: float
    stiffest: float
    rows: list[Record]
    cheek: float
    change: float | None


def carriers_for(run: Run, chosen: ChosenDrivetrain, stage: FirstStage) -> Carriers:
    """The carrier as a solid, and its variants: solids, of a quick run beams."""
    given = carriers_of(chosen.drivetrain).get(1)
    radius, planets = stage.stage.centre_distance, stage.stage.planets
    sizes = {} if chosen.own else {"pin_diameter": 0.16, "gap": 0.24}
    own = given or carrier_in_size(radius, planets, **sizes)
    part = own.planet_carrier
    cheek = -(part.gap + part.cheek_thickness) / 2
    body = solid_component(coarser(own, QUICK if run.quick else FULL)).body
    rows: list[Record] = [row_of(stage, "as scaled, solid", body)]
    change = None
    if not run.quick:
        less = solid_component(coarser(own, COARSER)).body
        change = abs(alone(stage, less) - alone(stage, body))
    basis = carrier_frame(own)
    rows.append(row_of(stage, "as scaled, beams between rigid cheeks", basis))
    factors = []
    for name, (cheeks, webs) in VARIANTS.items():
        sizes = {
            "cheek_thickness": cheeks * part.cheek_thickness,
            "web_angle": webs * part.web_angle,
        }
        variant = varied(own, **sizes)
        solid = None if run.quick else solid_component(coarser(variant, COARSER)).body
        varies = solid or carrier_frame(variant)
        base = basis if run.quick else body
        rows.append(row_of(stage, f"{name}, {'beams' if run.quick else 'solid'}", varies))
        factors.append(times_as_soft(stage, base, alone(stage, varies)))
    single = varied(own, walls=1)
    rows.append(row_of(stage, "one cheek, upwind, beams", carrier_frame(single)))
    return Carriers(body, max(*factors, 1.0), min(*factors, 1.0), rows, cheek, change)


def varied(component: CarrierComponent, **changes: float) -> CarrierComponent:
    """A carrier of other dimensions."""
    part = component.planet_carrier
    own = type(part).model_validate({**part.model_dump(), **changes})
    return component.model_copy(update={"planet_carrier": own})


def alone(stage: FirstStage, body: Condensed) -> float:
    """Upwind over downwind by a carrier alone."""
    return replace(stage, body=body).ratio(RIGID.but("carrier", 1.0))


def row_of(stage: FirstStage, name: str, body: Condensed) -> Record:
    """Row of the table of carriers."""
    return {"carrier": name, "upwind over downwind, alone": alone(stage, body)}


def times_as_soft(stage: FirstStage, body: Condensed, ratio: float) -> float:
    """Compliance over that of a carrier, at which it gives a ratio, by steps in proportion."""
    of, times = replace(stage, body=body), 1.0
    for _ in range(3):
        times *= (ratio - 1.0) / (of.ratio(RIGID.but("carrier", times)) - 1.0)
    return times
