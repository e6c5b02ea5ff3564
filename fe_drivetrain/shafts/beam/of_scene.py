"""The beam model of a scene: the same shaft, supports and gearbox at level 1."""

from collections.abc import Mapping, Sequence
from dataclasses import replace

from numpy.typing import ArrayLike

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.joint_springs import as_numbers
from fe_drivetrain.drivetrain_file.scene import Scene
from fe_drivetrain.geometry import Bearing
from fe_drivetrain.shafts.beam.beam import Beam, Support
from fe_drivetrain.shafts.beam.closed_forms import MainBearingBeam
from fe_drivetrain.shafts.beam.sections import BeamSection


def beam_of_scene(
    scene: Scene,
    bearing_stiffness: Mapping[str, ArrayLike],
    shear: bool = True,
    rings: bool = False,
) -> Beam:
    """A Timoshenko beam on springs with the scene's shaft and gearbox.

    Parameters
    ----------
    scene : Scene
        The scene. Shoulder fillets are left out; the flange is a section of its own.
    bearing_stiffness : Mapping[str, ArrayLike]
        Stiffness (6,) or (6, 6) of bearing and housing for each bearing; inf is rigid. A beam
        cannot know what a housing does, so none is assumed.
    shear : bool
        Whether shear deforms the shaft.
    rings : bool
        Whether the body of each bearing stiffens the shaft over its width as if turned from one
        piece with it: stiffer than the solid, as a shaft without rings is softer.
    """
    shaft = scene.shaft
    sections = []
    if shaft.flange is not None:
        bore = shaft.sections[0].inner_diameter
        sections.append(BeamSection(shaft.flange.thickness, shaft.flange.outer_diameter, bore))
    for section in shaft.sections:
        sections.append(
            BeamSection(
                section.length,
                section.outer_diameter,
                section.inner_diameter,
                outer_diameter_end=section.outer_diameter_end,
            )
        )
    if rings:
        for unit in scene.bearing_units:
            sections = _with_ring(sections, shaft.front, unit.bearing)
    supports = [
        Support(unit.bearing.name, unit.bearing.x, bearing_stiffness[unit.bearing.name])
        for unit in scene.bearing_units
    ]
    gearbox = as_numbers(scene.gearbox.stiffness)
    if gearbox.any():
        supports.append(Support("gearbox", shaft.rear, gearbox))
    return Beam(
        sections=sections,
        supports=supports,
        start=shaft.front,
        material=scene.material_of("shaft"),
        shear=shear,
    )


def _with_ring(
    sections: Sequence[BeamSection], start: float, bearing: Bearing
) -> list[BeamSection]:
    """The sections with the one under a bearing cut in three, the middle one thicker."""
    low, high = bearing.x - bearing.width / 2, bearing.x + bearing.width / 2
    result: list[BeamSection] = []
    for section in sections:
        end = start + section.length
        if start - 1e-9 <= low and high <= end + 1e-9:
            before, after = low - start, end - high
            result += [replace(section, length=before)] if before > 1e-9 else []
            result.append(
                replace(section, length=high - low, outer_diameter=bearing.raceway_diameter)
            )
            result += [replace(section, length=after)] if after > 1e-9 else []
        else:
            result.append(section)
        start = end
    return result


def main_bearing_beam(scene: Scene, tilt: float = 0.0, yaw: float = 0.0) -> MainBearingBeam:
    """Parameters of the closed forms (Stirling 2023, Eq 3.1, 3.18, 3.19) for a scene.

    Parameters
    ----------
    scene : Scene
        One bearing, a uniform shaft, equal radial gearbox stiffness along y and z.
    tilt, yaw : float
        K_R about y and about z [N m/rad]; 0 is pinned.

    Raises
    ------
    InputError
        The scene is not of that kind; the message says what to change.
    """
    shaft = scene.shaft
    uniform = (
        len(shaft.sections) == 1
        and shaft.flange is None
        and shaft.sections[0].outer_diameter_end in (None, shaft.sections[0].outer_diameter)
    )
    axial, *radial = scene.gearbox.stiffness[:3]
    if len(scene.bearing_units) != 1:
        reason = f"{len(scene.bearing_units)} bearing units where the closed forms have one"
    elif scene.load_points:
        reason = f"loads at {', '.join(scene.bands)} where the closed forms have them at the hub"
    elif not uniform:
        reason = "a shaft of several diameters where the closed forms have one"
    elif any(k != 0 for k in scene.gearbox.stiffness[4:]):
        reason = "gearbox stiffness about y or z where the closed forms have none"
    elif 0 in radial:
        reason = "no radial gearbox stiffness (gearbox.stiffness along y and z)"
    elif radial[0] != radial[1]:
        reason = "different gearbox stiffness along y and z where the closed forms have one K1"
    else:
        x = scene.bearing_units[0].bearing.x
        section = shaft.sections[0]
        k1, k2 = as_numbers([radial[0], axial]).tolist()
        return MainBearingBeam(
            overhang=x - shaft.front,
            span=shaft.rear - x,
            radial_stiffness=k1,
            axial_stiffness=k2,
            gearbox_weight=scene.gearbox.weight,
            shaft_diameter=section.outer_diameter,
            bore=section.inner_diameter,
            tilt_stiffness=tilt,
            yaw_stiffness=yaw,
            material=scene.material_of("shaft"),
        )
    raise InputError(
        f"scene {scene.title!r} has {reason}: compare it with the general beam (fe-drivetrain "
        "study, or beam_of_scene) or simplify the scene"
    )
