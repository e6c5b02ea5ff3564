"""The gate of all that turns: geometry that fits, bearings where they can be, bodies that can be.

Called as a drivetrain or a machine is made, from a file or in Python. What a table does not state
it is not held to: a stage of radii has no teeth to be checked, and one of teeth without a module no
sizes.
"""

from collections.abc import Sequence
from math import degrees, pi, radians, sin, sqrt, tan

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.gear_stages import ParallelData, PlanetaryData, mesh_of
from fe_drivetrain.drivetrain_file.machine_table import MachineTable
from fe_drivetrain.drivetrain_file.stage_gears import stage_pairs
from fe_drivetrain.drivetrain_file.turning_parts import RotorBody, diagonal
from fe_drivetrain.gear.functions import involute_of
from fe_drivetrain.gear.planets import check_assembly
from fe_drivetrain.gear.working_angles import transverse_angle

#: Distance of radii of three digits from the centre distance, over it, that is allowed.
ROUNDED = 1e-3
#: Maximum sum of two profile shifts [modules].
MAX_SHIFTS = 3.0
#: Play of teeth along the line of action [modules] that is no play any more.
MAX_PLAY = 0.5
#: Diameters of the smaller gear that a face may be wide.
WIDEST = 5.0
#: Radius of gyration of a gear over its own radius: it carries part of its shaft, or is a point.
GYRATION = (1e-3, 1e2)
#: Maximum radius of gyration of a rotor, and of a generator [m].
ROTOR_GYRATION, GENERATOR_GYRATION = 150.0, 20.0
#: Names that the program gives to bodies and springs.
RESERVED = ("rotor", "generator", "grid", "housing")


def check_table(machine: MachineTable) -> None:
    """Refuse a machine whose rows do not fit.

    Raises
    ------
    InputError
        Names are not unique; teeth, radii, module, profile shifts and centre distance of a stage
        are of two geometries, planets overlap, or teeth lose contact; a bearing is on nothing or
        far away, or holds what turns; or a body cannot have its inertia.
    """
    check_names(machine)
    for number, stage in enumerate(machine.stages, start=1):
        if any(key.startswith(f"stage {number}:") for key in machine.not_given):
            continue
        name = f"stage {number}" + (f" ({stage.name})" if stage.name else "")
        if isinstance(stage, PlanetaryData):
            check_planetary(stage, name)
        else:
            check_parallel(stage, name)
    if not machine.not_given:
        check_bodies(machine)
    check_bearings(machine)


def check_names(machine: MachineTable) -> None:
    """Refuse shafts and bearings that share a name, or have one of the program's own."""
    names = [shaft.name for shaft in machine.shafts]
    names += [bearing.name for bearing in machine.bearings]
    for name in names:
        own = name in RESERVED or name.startswith("stage ")
        if own or names.count(name) > 1 or not name or name != name.strip():
            raise InputError(
                f"name {name!r} of a shaft or bearing must be one of its own, other than "
                f"{', '.join(RESERVED)} and 'stage ...', and not begin or end with a space: "
                "rename it"
            )
    for number, stage in enumerate(machine.stages, start=1):
        pins = [pin.name for pin in stage.pins] if isinstance(stage, PlanetaryData) else []
        twice = [pin for pin in pins if pins.count(pin) > 1]
        if twice:
            raise InputError(f"stage {number} has two pins {twice[0]!r}: give each its own name")


def check_planetary(stage: PlanetaryData, name: str) -> None:
    """Refuse a planetary stage whose ring, planets and sun are not of one geometry, or overlap."""
    a, planet = stage.centre_distance, stage.centre_distance - stage.sun_radius
    _check_radii(stage.radii, a, name, "sun and planet")
    if stage.teeth is not None:
        ring, of_planet, sun = stage.teeth
        if stage.module is None and ring != sun + 2 * of_planet:
            raise InputError(
                f"{name}: a ring of {ring} teeth does not fit a sun of {sun} with planets of "
                f"{of_planet}, which ask for {sun + 2 * of_planet} where no module is given: "
                "correct the teeth, or give the module, of which profile shifts follow"
            )
        check_assembly(name, sun, ring, stage.planets)
        _check_distance(stage, sun + of_planet, f"{name}, sun and planet")
        _check_distance(stage, of_planet - ring, f"{name}, planet and ring")
    tip = _check_teeth(stage, name).get("planet", planet)
    _check_face(stage, min(planet, stage.sun_radius), name)
    n = stage.planets
    if n > 1 and not a * sin(pi / n) > tip:
        raise InputError(
            f"{name}: {n} planets of radius {tip:.4g} m overlap at a centre distance of {a:g} m, "
            f"where neighbours are {2 * a * sin(pi / n):.4g} m apart: give fewer or smaller ones"
        )
    for pin in stage.pins:
        if abs(pin.offset) > stage.face_width:
            raise InputError(
                f"{name}: pin {pin.name!r} is {pin.offset:g} m from the planet's middle but must "
                f"be within a face width, {stage.face_width:g} m: correct its offset"
            )
        if diagonal(pin.stiffness)[3] > 0:
            raise InputError(
                f"{name}: pin {pin.name!r} holds the planet against turning about its own axis, "
                f"with {diagonal(pin.stiffness)[3]:g} N m/rad: make the fourth of its stiffnesses 0"
            )


def check_parallel(stage: ParallelData, name: str) -> None:
    """Refuse a parallel stage whose gear and pinion are not of one geometry."""
    _check_radii(stage.radii, stage.centre_distance, name, "gear and pinion")
    if stage.teeth is not None:
        _check_distance(stage, sum(stage.teeth), f"{name}, pinion and gear")
    _check_teeth(stage, name)
    smaller = min(stage.gear_radius, stage.centre_distance - stage.gear_radius)
    _check_face(stage, smaller, name)


def _check_radii(radii: tuple[float, float] | None, distance: float, name: str, of: str) -> None:
    if radii is not None and abs(sum(radii) - distance) > ROUNDED * distance:
        raise InputError(
            f"{name}: working radii of {of} are {radii[0]:g} and {radii[1]:g} m, in sum "
            f"{sum(radii):.6g} m, but must be the centre distance, {distance:g} m: correct one of "
            "them"
        )


def _check_face(stage: PlanetaryData | ParallelData, radius: float, name: str) -> None:
    if stage.face_width > 2 * WIDEST * radius:
        raise InputError(
            f"{name}: face width is {stage.face_width:g} m but must be at most {WIDEST:g} "
            f"diameters of the smaller gear, {2 * WIDEST * radius:.4g} m: correct it"
        )


def _check_distance(stage: PlanetaryData | ParallelData, teeth: int, name: str) -> None:
    """Whether the centre distance fits the numbers of teeth, negative of an internal pair."""
    if stage.module is None:
        return
    helix, normal = radians(stage.helix), radians(stage.pressure_angle)
    try:
        working = mesh_of(stage, abs(teeth)).pressure_angle
    except InputError as error:
        raise InputError(f"{name}: {error}: correct the teeth, module, helix or distance") from None
    opened = float(involute_of(working)) - float(involute_of(transverse_angle(normal, helix)))
    shifts = opened * teeth / (2 * tan(normal))
    if abs(shifts) > MAX_SHIFTS:
        raise InputError(
            f"{name}: a centre distance of {stage.centre_distance:g} m asks for profile shifts of "
            f"{shifts:.3g} modules in sum (a working pressure angle of {degrees(working):.3g} deg) "
            f"but the maximum is {MAX_SHIFTS:g}: correct the teeth, module, helix or distance"
        )


def _check_teeth(stage: PlanetaryData | ParallelData, name: str) -> dict[str, float]:
    """Refuse gears with full data that do not mesh; radius of the tips of the planets [m]."""
    if stage.shifts is None:
        return {}
    pairs = stage_pairs(stage, name)
    for mesh, pair in pairs.items():
        play = pair.backlash / pair.first.normal_module
        if play > MAX_PLAY:
            raise InputError(
                f"{name}, {mesh}: play of the teeth is {1e3 * pair.backlash:.4g} mm but must be "
                f"at most {MAX_PLAY:g} modules: profile shifts of "
                f"{pair.first.shift:g} and {pair.second.shift:g} are not those of a centre "
                f"distance of {pair.centre_distance:g} m, of {pair.shift_sum:.4g} in sum; correct "
                "one of them"
            )
    return {"planet": pairs["ring-planet"].first.tip_radius} if "ring-planet" in pairs else {}


def check_bodies(machine: MachineTable) -> None:
    """Refuse a body whose mass and inertia are not of one body of its size."""
    if machine.rotor.mass is None:
        raise InputError(
            "rotor: its mass [kg] is missing, without which nothing has its weight: give it"
        )
    _check_gyration("rotor", machine.rotor, 0.0, ROTOR_GYRATION)
    _check_gyration("generator", machine.generator, 0.0, GENERATOR_GYRATION)
    for number, stage in enumerate(machine.stages, start=1):
        a = stage.centre_distance
        sized: Sequence[tuple[str, RotorBody | None, float]]
        if isinstance(stage, PlanetaryData):
            planet = a - stage.sun_radius
            sized = (
                ("carrier", stage.carrier, a),
                ("planet", stage.planet, planet),
                ("sun", stage.sun, stage.sun_radius),
                ("ring", stage.ring, a + planet),
            )
        else:
            gear = stage.gear_radius
            sized = (("gear", stage.gear, gear), ("pinion", stage.pinion, a - gear))
        for part, body, radius in sized:
            if body is not None:
                _check_gyration(
                    f"stage {number} {part}", body, GYRATION[0] * radius, GYRATION[1] * radius
                )


def _check_gyration(name: str, body: RotorBody, least: float, most: float) -> None:
    if not body.mass:
        return
    radius = sqrt(body.inertia / body.mass)
    if not least <= radius <= most:
        raise InputError(
            f"{name}: {body.inertia:g} kg m^2 of {body.mass:g} kg have a radius of gyration of "
            f"{radius:.3g} m, which must be within {least:.3g} and {most:.3g} m: correct one of "
            "them"
        )


def check_bearings(machine: MachineTable) -> None:
    """Refuse a bearing that is on nothing, is far from what it holds, or holds it from turning."""
    shafts = {shaft.name: shaft for shaft in machine.shafts}
    bodies = ["rotor", "generator"]
    for number, stage in enumerate(machine.stages, start=1):
        parts = ("carrier", "sun") if isinstance(stage, PlanetaryData) else ("gear", "pinion")
        bodies += [f"stage {number} {part}" for part in parts]
    whole = sum(shaft.length for shaft in machine.shafts)
    for bearing in machine.bearings:
        name = f"bearing {bearing.name!r}"
        if bearing.holds not in (*shafts, *bodies):
            raise InputError(
                f"{name} holds {bearing.holds!r}, which is no shaft or body in the housing: use "
                f"one of {', '.join((*shafts, *bodies))}"
            )
        against = diagonal(bearing.stiffness)[3]
        if against > 0:
            raise InputError(
                f"{name} holds {bearing.holds} against turning, with {against:g} N m/rad about x: "
                "make the fourth of its stiffnesses 0"
            )
        if not any(diagonal(bearing.stiffness)):
            raise InputError(f"{name} has no stiffness: give one, or remove the bearing")
        if bearing.holds == "generator" and machine.generator.mass is None:
            raise InputError(
                f"{name} holds a generator without a mass, which only turns: give "
                "generator.mass, or remove the bearing"
            )
        shaft = shafts.get(bearing.holds)
        if shaft is not None and "at" not in bearing.model_fields_set:
            raise InputError(f"{name} on shaft {shaft.name!r} has no place: give at, x in m")
        if shaft is not None and f"shaft {shaft.name!r}: length" in machine.not_given:
            continue
        low, high = (-whole, whole) if shaft is None else (0.0, shaft.length)
        if not low <= bearing.at <= high:
            of = "the length of all shafts" if shaft is None else "its shaft"
            raise InputError(
                f"{name} is at {bearing.at:g} m but must be within {low:g} and {high:g} m, {of}: "
                "correct it"
            )
