"""Stages of a file completed by what follows from the rest: sizes, discs, mesh stiffness.

What is given is never replaced. What follows is derived here, and only here, for all levels and
commands; each derived value is an assumption that results state.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import cos, pi, radians, tan
from typing import Any, Literal

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import (
    ParallelData,
    ParallelStage,
    PlanetaryData,
    PlanetaryStage,
)
from fe_drivetrain.drivetrain_file.stage_fields import GearPinion, RingPlanetSun, SunPlanet
from fe_drivetrain.drivetrain_file.stage_gears import stage_gears, stage_pairs
from fe_drivetrain.drivetrain_file.turning_parts import STEEL, RotorBody
from fe_drivetrain.gear.functions import inverse_involute, involute_of
from fe_drivetrain.gear.iso import iso_gear_stiffness
from fe_drivetrain.gear.working_angles import transverse_angle, working_angle

#: Centre distance [m] and face width [m] of a stage without sizes, whose bodies only turn: its
#: frequencies of torsion do not depend on either.
NOMINAL_DISTANCE, NOMINAL_FACE = 1.0, 0.1
#: Addenda of a ring that are tried, from that of its rack on [modules].
ADDENDA = (1.0, 0.95, 0.9, 0.85, 0.8, 0.75, 0.7, 0.65, 0.6)
#: Digits of derived inertias and stiffnesses in assumptions.
DIGITS = ".4g"


class NotGivenError(InputError):
    """A drivetrain's file does not state a value that a model needs."""


@dataclass(frozen=True)
class Completed:
    """A stage with all that a model needs.

    Attributes
    ----------
    stage : PlanetaryData or ParallelData
        The stage.
    derived : dict[str, str]
        What was derived and how, in words, by the key of the stage.
    not_given : tuple[str, ...]
        Keys without which its bodies can only turn.
    """

    stage: PlanetaryData | ParallelData
    derived: dict[str, str]
    not_given: tuple[str, ...]


def completed(stage: PlanetaryStage | ParallelStage, name: str) -> Completed:
    """A stage of a file with what follows from the rest of it.

    Parameters
    ----------
    stage : PlanetaryStage or ParallelStage
        The stage.
    name : str
        Its name in messages, as in "stage 1".

    Raises
    ------
    NotGivenError
        An inertia or a mesh stiffness neither is given nor follows; the message names its key.
    InputError
        What is given contradicts itself.
    """
    data = {key: getattr(stage, key) for key in stage.model_fields_set}
    derived: dict[str, str] = {}
    lost = _sizes(stage, name, data, derived)
    _bodies(stage, name, data, derived, sized=not lost)
    _stiffness(stage, name, data, derived, sized=not lost)
    made: PlanetaryData | ParallelData
    if isinstance(stage, PlanetaryStage):
        made = PlanetaryData.model_validate(data)
    else:
        made = ParallelData.model_validate(data)
    return Completed(made, derived, tuple(lost))


def _sizes(
    stage: PlanetaryStage | ParallelStage, name: str, data: dict[str, Any], derived: dict[str, str]
) -> list[str]:
    """Centre distance, shifts and face width; keys that neither are given nor follow."""
    lost = []
    if stage.centre_distance is None and stage.radii is not None:
        data["centre_distance"] = float(sum(stage.radii))
        derived["centre_distance"] = f"sum of the radii, {sum(stage.radii):.6g} m"
    elif stage.centre_distance is None and stage.module is not None and stage.teeth is not None:
        data["centre_distance"] = a = _of_shifts(stage)
        shifted = "profile shifts" if stage.shifts is not None else "gears without profile shifts"
        derived["centre_distance"] = f"of teeth, module and {shifted}, {a:.6g} m"
    elif stage.centre_distance is None:
        lost.append("centre_distance")
        data["centre_distance"] = NOMINAL_DISTANCE
    if stage.face_width is None:
        lost.append("face_width")
        data["face_width"] = NOMINAL_FACE
        data["slices"] = 1
    if stage.ratio is not None:
        data["radii"] = _nominal_radii(stage, data["centre_distance"])
        data.pop("ratio")
        lost += [key for key in ("teeth",) if key not in lost]
    if stage.module is not None and stage.shifts is None and "centre_distance" not in lost:
        data["shifts"] = shifts = _of_distance(stage, name, data["centre_distance"])
        shown = ", ".join(f"{x:.4g}" for x in shifts)
        derived["shifts"] = (
            f"of the centre distance, in modules: {shown}; the sum of a pair, half to each of "
            f"{'planet and sun' if len(shifts) == 3 else 'gear and pinion'}"
        )
    return lost


def _nominal_radii(
    stage: PlanetaryStage | ParallelStage, a: float
) -> SunPlanet[float] | GearPinion[float]:
    ratio = float(stage.ratio or 1.0)
    if isinstance(stage, PlanetaryStage):
        return SunPlanet(2 * a / ratio, a * (1 - 2 / ratio))
    return GearPinion(a * ratio / (1 + ratio), a / (1 + ratio))


def _angles(stage: PlanetaryStage | ParallelStage) -> tuple[float, float, float, float]:
    """Normal module [m], helix, normal and transverse pressure angle [rad]."""
    helix, normal = radians(stage.helix), radians(stage.pressure_angle)
    return float(stage.module or 0.0), helix, normal, transverse_angle(normal, helix)


def _of_shifts(stage: PlanetaryStage | ParallelStage) -> float:
    """Centre distance without backlash [m], ISO 21771; of planets and sun in a planetary stage."""
    module, helix, normal, transverse = _angles(stage)
    if isinstance(stage, PlanetaryStage):
        teeth = stage.teeth.sun + stage.teeth.planet if stage.teeth else 0
        shifts = stage.shifts.sun + stage.shifts.planet if stage.shifts else 0.0
    else:
        teeth, shifts = sum(stage.teeth or ()), sum(stage.shifts or ())
    opened = float(involute_of(transverse)) + 2 * tan(normal) * shifts / teeth
    working = inverse_involute(opened)
    return module * teeth / (2 * cos(helix)) * cos(transverse) / cos(working)


def _of_distance(
    stage: PlanetaryStage | ParallelStage, name: str, a: float
) -> RingPlanetSun[float] | GearPinion[float]:
    """Profile shifts of a centre distance: half of a pair's sum to each; a ring takes the rest."""
    module, helix, normal, transverse = _angles(stage)

    def asked(teeth: int) -> float:
        try:
            working = working_angle(module, abs(teeth), a, normal, helix)
        except InputError as error:
            raise InputError(
                f"{name}: {error}: correct the teeth, module, helix or distance"
            ) from None
        opened = float(involute_of(working)) - float(involute_of(transverse))
        return opened * teeth / (2 * tan(normal))

    if isinstance(stage, PlanetaryStage):
        ring, planet, sun = stage.teeth or RingPlanetSun(0, 0, 0)
        half = _tidy(asked(sun + planet) / 2)
        return RingPlanetSun(_tidy(asked(planet - ring) - half), half, half)
    half = _tidy(asked(sum(stage.teeth or ())) / 2)
    return GearPinion(half, half)


def _tidy(shift: float) -> float:
    """A shift without round-off: 0 of gears at their reference centre distance."""
    return 0.0 if abs(shift) < 1e-9 else shift


def _bodies(
    stage: PlanetaryStage | ParallelStage,
    name: str,
    data: dict[str, Any],
    derived: dict[str, str],
    *,
    sized: bool,
) -> None:
    """Inertias of gears: discs of steel of the reference diameter, as wide as their faces."""
    parts: tuple[Literal["carrier", "planet", "sun", "gear", "pinion"], ...]
    parts = (
        ("carrier", "planet", "sun") if isinstance(stage, PlanetaryStage) else ("gear", "pinion")
    )
    for part in parts:
        body: RotorBody | None = getattr(stage, part)
        if body is None:
            data[part] = _disc(stage, name, part, derived, sized=sized)
        elif not sized and body.mass is None:
            # of a stage without sizes nothing is known but what turns
            data[part] = body.model_copy(update={"mass": 0.0})


def _disc(
    stage: PlanetaryStage | ParallelStage,
    name: str,
    part: str,
    derived: dict[str, str],
    *,
    sized: bool,
) -> RotorBody:
    if part == "carrier" or not sized or stage.module is None or stage.teeth is None:
        needs = "" if part == "carrier" else ", or module, teeth and face_width for a disc of steel"
        raise NotGivenError(
            f"{name}: the inertia of its {part} is not given: add {part}: {{inertia: ...}} in "
            f"kg m^2{needs}"
        )
    teeth = getattr(stage.teeth, part)
    width = getattr(stage.faces, part) if stage.faces else float(stage.face_width or 0.0)
    radius = stage.module * teeth / (2 * cos(radians(stage.helix)))
    mass = STEEL.density * width * pi * radius**2
    inertia = mass * radius**2 / 2
    derived[part] = (
        f"disc of steel of the reference diameter, as wide as its face: {mass:{DIGITS}} kg, "
        f"{inertia:{DIGITS}} kg m^2"
    )
    return RotorBody(inertia=inertia, mass=mass)


def _with_short_ring(
    made: PlanetaryData | ParallelData, name: str, data: dict[str, Any], derived: dict[str, str]
) -> PlanetaryData | ParallelData:
    """The stage with a ring whose tips do not reach below the planets' involutes.

    A ring's addendum of a module does so at the usual numbers of planets' teeth; makers shorten it.
    Where tips are given, or no shorter ones help, the stage stays as it is.
    """
    if not isinstance(made, PlanetaryData) or made.tips is not None or made.module is None:
        return made
    for addendum in ADDENDA:
        tips = _tips(made, name, addendum)
        tried = made.model_copy(update={"tips": tips})
        try:
            stage_pairs(tried, name)
        except InputError:
            continue
        if addendum < 1.0:
            data["tips"] = tips
            derived["tips"] = (
                f"addendum of a module, of the ring {addendum:g}, whose tips else reach below "
                "the planets' involutes"
            )
            return tried
        return made
    return made


def _tips(stage: PlanetaryData, name: str, addendum: float) -> RingPlanetSun[float]:
    """Tip diameters with an addendum of a module, of the ring of so many [m]."""
    ring, planet, sun = (2 * gear.tip_radius for gear in stage_gears(stage, name))
    return RingPlanetSun(ring + 2 * (1 - addendum) * float(stage.module or 0.0), planet, sun)


def _stiffness(
    stage: PlanetaryStage | ParallelStage,
    name: str,
    data: dict[str, Any],
    derived: dict[str, str],
    *,
    sized: bool,
) -> None:
    """Mesh stiffness by ISO 6336-1, method B, where none is given."""
    keys = (
        {"sun_planet": "sun-planet", "ring_planet": "ring-planet"}
        if isinstance(stage, PlanetaryStage)
        else {"stiffness": "mesh"}
    )
    absent = [key for key in keys if getattr(stage, key) is None]
    if not absent:
        return
    if not sized or stage.module is None:
        raise NotGivenError(
            f"{name}: the mesh stiffness {absent[0]} is not given: add it, with stiffness_of, or "
            "module, teeth and face_width for that of ISO 6336-1"
        )
    if len(absent) < len(keys):
        raise NotGivenError(
            f"{name}: one mesh stiffness is given and {absent[0]} is not: give both, or none for "
            "those of ISO 6336-1"
        )
    nominal = {"stiffness_of": "line", **dict.fromkeys(absent, 1.0)}
    made: PlanetaryData | ParallelData
    if isinstance(stage, PlanetaryStage):
        made = PlanetaryData.model_validate(data | nominal)
    else:
        made = ParallelData.model_validate(data | nominal)
    made = _with_short_ring(made, name, data, derived)
    pairs = stage_pairs(made, name)
    data["stiffness_of"] = "line"
    for key in absent:
        pair = pairs[keys[key]]
        data[key] = k = iso_gear_stiffness(pair, blank=stage.blank).mesh * pair.face_width
        derived[key] = f"c_gamma_alpha of ISO 6336-1 times the face, {k:{DIGITS}} N/m"
