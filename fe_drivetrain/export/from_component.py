"""Superelements of a component: the free body at its points, and it on its supports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from importlib.metadata import version

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.drivetrain_file.component import Component, HousingComponent
from fe_drivetrain.elasticity.mesh.measures import mean_size
from fe_drivetrain.elasticity.solve.condensation import Condensed, keep_points
from fe_drivetrain.export.superelement import Origin, Superelement, refuse_one_point
from fe_drivetrain.report.seal import drivetrain_hash
from fe_drivetrain.shafts.fidelity.component_frames import carrier_frame, housing_frame
from fe_drivetrain.shafts.fidelity.component_levels import (
    motions_on_supports,
    stiffness_on_supports,
)
from fe_drivetrain.shafts.fidelity.component_solid import (
    SolidComponent,
    recovered_band,
    solid_component,
)
from fe_drivetrain.shafts.fidelity.shaft_bands import APART, COARSER, ORDER

BODY, SUPPORTED = "body", "supported"


def component_superelement(
    component: Component,
    what: str = BODY,
    at: Sequence[str] | None = None,
    level: int = 3,
    solids: tuple[SolidComponent, SolidComponent] | None = None,
) -> Superelement:
    """A component, condensed.

    The band of a solid is the larger of two: of the difference to element size zero estimated from
    a coarser mesh, where there is one, and of recovered stresses. That of a frame is not known.

    Parameters
    ----------
    component : Component
        The component.
    what : str
        "body": the free body, with its mass. "supported": on its bushings, or held at its flange.
    at : Sequence[str] or None
        Points that are kept. Where not given, all of the body, and of the supported component
        those that loads come in by.
    level : int
        1 frame of beams (without mass), 3 solid.
    solids : tuple[SolidComponent, SolidComponent] or None
        The component's solid, and that with mesh sizes times `shaft_bands.COARSER`, where
        they are solved already.

    Raises
    ------
    InputError
        There is no such part, level or point, a point is given twice or held rigidly, or the free
        body is asked for at one point.
    """
    if what not in (BODY, SUPPORTED):
        raise InputError(f"{what!r} of a component cannot be exported: use {BODY} or {SUPPORTED}")
    if at is not None and (not at or len(set(at)) < len(at)):
        raise InputError(f"the points {', '.join(at) or 'none'} must be one or more, each once")
    if level not in (1, 3):
        raise InputError(f"level {level} of a component is unknown: use 1 or 3")
    names = [a.name for a in component.attachments]
    if at is None:
        at = names if what == BODY else component.loaded
    for name in at:
        if name not in names:
            raise InputError(f"point {name!r} is unknown: use {', '.join(names)}")
    kind = "gearbox_housing" if isinstance(component, HousingComponent) else "planet_carrier"
    if what == BODY:
        refuse_one_point(kind.replace("_", " "), at, names, SUPPORTED)
    if level == 1:
        bodies = [_frame(component)]
        level_title, mesh = "1 frame of beams", "none"
    else:
        if solids is None:
            coarse = component.model_copy(update={"mesh": component.mesh.scaled(COARSER)})
            solids = solid_component(component), solid_component(coarse)
        found = solids[0]
        bodies = [solid.body for solid in solids]
        level_title = "3 solid"
        mesh = (
            f"curved tetrahedra of second order, {found.unknowns:,} unknowns, "
            f"{found.sizes.edge:.3g} m along inner edges"
        )
    fine, *others = [_part(component, body, what, at) for body in bodies]
    band = None
    if level == 3 and solids is not None:
        supports = component.supports if what == SUPPORTED else {}
        motions = motions_on_supports(solids[0].body, supports, at)
        band = recovered_band(component, solids[0], motions, fine.stiffness)
        ratio = mean_size(solids[1].mesh) / mean_size(solids[0].mesh)
        if ratio > APART:  # else the coarser mesh had to be made finer
            change = StiffnessBands.of_difference(others[0].stiffness, fine.stiffness)
            band = band | change.each(lambda c: c / (ratio**ORDER - 1.0))
    program = f"fe-drivetrain {version('fe-drivetrain')}"
    origin = Origin(component.title, drivetrain_hash(component), level_title, mesh, program)
    return Superelement(
        kind,
        fine.names,
        fine.positions,
        fine.stiffness,
        fine.mass,
        supported=what == SUPPORTED,
        band=band,
        origin=origin,
    )


def _frame(component: Component) -> Condensed:
    if isinstance(component, HousingComponent):
        return housing_frame(component, ring_gives=True)
    return carrier_frame(component)


def _part(component: Component, body: Condensed, what: str, at: Sequence[str]) -> Condensed:
    if what == BODY:
        return keep_points(body, at)
    K = stiffness_on_supports(body, component.supports, at)
    return replace(keep_points(body, at), stiffness=K, mass=None)
