"""A scene's main shaft made ready for its strength: sections, internal forces, joints."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from fe_drivetrain.common.arrays import Floats
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.short_repr import short_repr
from fe_drivetrain.common.steps import Clock
from fe_drivetrain.drivetrain_file.joint_springs import joint_stiffness
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.drivetrain_file.shaft_strength import PressFit, ShaftStrength
from fe_drivetrain.shafts.fidelity.main_supports import main_supports
from fe_drivetrain.shafts.response.cached import whole_content
from fe_drivetrain.shafts.strength.fatigue import Rule
from fe_drivetrain.shafts.strength.joints import press_pressure
from fe_drivetrain.shafts.strength.notches import moduli
from fe_drivetrain.shafts.strength.rated import RatedSection, rated_section, steel_of
from fe_drivetrain.shafts.strength.section_loads import SectionLoads, section_loads
from fe_drivetrain.shafts.strength.sections import shaft_sections
from fe_drivetrain.studies.strength_options import StrengthOptions
from fe_drivetrain.studies.strength_sums import FitSeat, StrengthModel

STATIONS = 49
"""Stations along the shaft of the chart of nominal stress."""

SOFT = 1e8
"""Stiffness [N/m, N m/rad] in place of all joints: do the loads of the shaft depend on it?"""

DEPENDS = 1e-3
"""Share of the largest force of a section beyond which they do."""

NEEDS = (
    "states no strength of its main shaft: give strength in the file, with steel, tensile_strength "
    "and yield_strength (docs/strength.md)"
)


@dataclass(frozen=True, eq=False)
class StrengthShaft:
    """A shaft that is ready for loads.

    Attributes
    ----------
    stated : ShaftStrength
        As the file has it.
    rated : tuple of RatedSection
        Sections from front to rear.
    left_out : mapping of str to str
        Why other sections are not rated, by name.
    model : StrengthModel
        What loads are put on.
    stations : ndarray, (p,)
        Along the shaft [m].
    housings : str
        What housings are, in words.
    content : dict
        All that it depends on, for the cache.
    """

    stated: ShaftStrength
    rated: tuple[RatedSection, ...]
    left_out: Mapping[str, str]
    model: StrengthModel
    stations: Floats
    housings: str
    content: dict[str, Any]

    __repr__ = short_repr


def stated_strength(scene: Scene) -> ShaftStrength:
    """What a scene states of its shaft's strength.

    Parameters
    ----------
    scene : Scene
        The scene.

    Raises
    ------
    InputError
        It states none.
    """
    if scene.strength is None:
        raise InputError(f"{scene.title!r} {NEEDS}")
    return scene.strength


def strength_shaft(scene: Scene, options: StrengthOptions, steps: Clock) -> StrengthShaft:
    """Make a shaft ready for loads.

    Parameters
    ----------
    scene : Scene
        The scene.
    options : StrengthOptions
        Choices of the study.
    steps : Clock
        Times the steps.

    Raises
    ------
    InputError
        The scene states no strength, or cannot be solved.
    """
    stated = stated_strength(scene)
    sections, left_out = shaft_sections(scene, stated)
    if not sections:
        raise InputError(f"{scene.title!r} has no section to assess: give fillets or notches")
    steel, material = steel_of(stated), scene.material_of("shaft")
    with steps.step("stress at fillets"):
        rated = tuple(rated_section(one, steel, material, options.elastic) for one in sections)
    shaft = scene.shaft
    stations = np.linspace(shaft.front, shaft.rear, STATIONS)
    fits = stated.press_fits
    beside = [fit.x - fit.length / 2 for fit in fits]
    x = [*(one.x for one in sections), *stations.tolist(), *beside]
    bounds, housings = _bounds(scene, x, options, steps)
    seats = tuple(_fit_seat(scene, fit, len(sections) + STATIONS + k) for k, fit in enumerate(fits))
    along = np.array(
        [moduli(2.0 * shaft.outer_radius(at), 2.0 * shaft.inner_radius(at)) for at in stations]
    )
    rule = Rule(
        stated.mean_stress,
        (stated.normal_slope, stated.shear_slope),
        stated.knee_cycles,
        stated.below_knee == "haibach",
    )
    model = StrengthModel(
        scene.entrance,
        bounds,
        np.array([one.moduli for one in sections]),
        tuple(one.strength for one in rated),
        rule,
        options.points,
        stated.flange,
        seats,
        along,
    )
    chosen = [options.housings, options.elastic, options.weight, options.points]
    content = {"scene": whole_content(scene), "chosen": chosen}
    return StrengthShaft(stated, rated, left_out, model, stations, housings, content)


def _bounds(
    scene: Scene, x: list[float], options: StrengthOptions, steps: Clock
) -> tuple[tuple[SectionLoads, ...], str]:
    """Internal forces; with housings at both bounds where these change them."""
    rigid = section_loads(scene, x, weight=options.weight)
    if not options.housings:
        return (rigid,), "rigid, as asked for"
    # a change of all joints tells whether statics alone decides the loads of the shaft
    soft = {unit.bearing.name: _softened(joint_stiffness(unit)) for unit in scene.bearing_units}
    other = section_loads(scene, x, soft, options.weight)
    scale = np.abs(rigid.unit).max(axis=(0, 1))
    if (np.abs(other.unit - rigid.unit).max(axis=(0, 1)) <= DEPENDS * scale).all():
        return (rigid,), "of no account: statics decides the loads of the shaft"
    found = main_supports(scene, steps=steps)
    if not found.soft:
        return (rigid,), "rigid: " + "; ".join(sorted(set(found.left_out.values())))
    both = tuple(
        section_loads(scene, x, supports, options.weight) for supports in (found.soft, found.stiff)
    )
    return both, "springs between two bounds, seats that move on average and rigid ones"


def _softened(stiffness: Floats) -> Floats:
    """The joint with what it holds held softly."""
    return np.asarray(np.diag(np.where(np.diag(stiffness) != 0.0, SOFT, 0.0)))


def _fit_seat(scene: Scene, fit: PressFit, section: int) -> FitSeat:
    shaft, material = scene.shaft, scene.material_of("shaft")
    seat = shaft.seat_diameter(fit.x, fit.length, fit.name, "press fit")
    elastic = (material.youngs_modulus, material.poisson_ratio)
    left = fit.interference - fit.smoothing
    if left <= 0.0:
        raise InputError(
            f"press fit {fit.name!r}: smoothing of {fit.smoothing:g} m takes all of the "
            f"interference of {fit.interference:g} m: make the fit tighter"
        )
    pressure = press_pressure(
        seat, 2.0 * shaft.inner_radius(fit.x), fit.hub_diameter, left, elastic
    )
    return FitSeat(fit.name, seat, fit.length, pressure, fit.friction, section)
