"""Temperatures of a scene: free growth, held growth, levels against the assembly, and the gate."""

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import Scene, library_scene
from fe_drivetrain.report.number_text import formatted
from fe_drivetrain.shafts.fidelity.ladder import housing_springs
from fe_drivetrain.shafts.fidelity.thermal_levels import thermal_level
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.thermal import thermal_state
from fe_drivetrain.studies.scene_description import quick_scene
from fe_drivetrain.studies.thermal_tables import thermal_caution, thermal_tables

WARM = {"shaft": 60.0, "front": 60.0, "rear": 60.0, "front.housing": 50.0, "rear.housing": 45.0}


def warm(name: str, temperatures: dict[str, float]) -> Scene:
    data = quick_scene(library_scene(name)).model_dump(mode="json")
    return Scene.model_validate({**data, "temperatures": temperatures})


def test_a_shaft_that_nothing_holds_twice_grows_freely() -> None:
    """One bearing: the shaft grows from it, and pushes the gearbox's soft spring alone."""
    scene = warm("main_bearing_spherical", {"shaft": 50.0})
    found = thermal_level(scene)
    at = scene.bearing_units[0].bearing.x
    grown = 12e-6 * 30.0 * (scene.shaft.front - at)
    assert found.motions["hub"][0] == pytest.approx(grown, rel=1e-3)
    spring = float(scene.gearbox.stiffness[0])
    pushed = spring * found.motions["gearbox"][0]
    assert found.reactions["gearbox"][0] == pytest.approx(pushed, rel=1e-9)


def test_two_bearings_that_hold_the_axis_press_by_the_stiffness_between_them() -> None:
    """F = e L / (L / EA + 1 / k1 + 1 / k2), with springs as housings."""
    scene = warm("two_bearings", {"shaft": 60.0})
    k = 2e9
    springs = {name: np.diag([k, 1e12, 1e12, 0.0, 1e9, 1e9]) for name in scene.bearing_names}
    found = thermal_level(scene, 1, springs)
    E = scene.material_of("shaft").youngs_modulus
    sections = ((0.635, 0.8), (0.5, 0.8))  # diameter, length from x = 0 to 1.6
    soft = sum(4 * length / (np.pi * (d**2 - 0.1**2) * E) for d, length in sections) + 2 / k
    # a seat takes its force over its width w: as if the shaft were shorter by up to w / 6
    shorter = sum(
        4 * unit.bearing.width / 6 / (np.pi * (d**2 - 0.1**2) * E)
        for unit, (d, _) in zip(scene.bearing_units, sections, strict=True)
    )
    grown = 12e-6 * 40.0 * 1.6
    assert grown / soft <= found.reactions["rear"][0] <= grown / (soft - shorter)
    assert found.reactions["front"][0] == pytest.approx(-found.reactions["rear"][0], rel=1e-6)
    assert found.imbalance < 1e-9


def test_a_warm_housing_lifts_its_bearing() -> None:
    scene = warm("main_bearing_spherical", {"main_bearing.housing": 70.0})
    height = scene.bearing_units[0].block.centre_height
    rise = 12.5e-6 * 50.0 * height
    found = thermal_level(scene)
    name = scene.bearing_names[0]
    assert found.motions[name][2] == pytest.approx(rise, rel=1e-6)


def test_the_assembly_of_solids_agrees_with_a_beam_on_springs() -> None:
    """The same forces within what housings do to the face between them; in balance; seats grow."""
    scene = warm("two_bearings", WARM)
    springs, _ = housing_springs(scene)
    beam = thermal_level(scene, 1, springs)
    found = thermal_state(build_model(scene, mesh_scene(scene)))
    assert found.imbalance < 1e-7
    assert found.reactions["rear"][0] == pytest.approx(beam.reactions["rear"][0], rel=0.15)
    assert found.motions["hub"][0] == pytest.approx(beam.motions["hub"][0], rel=0.05)
    for name, growth in beam.seats.items():
        assert found.seats[name] == pytest.approx(growth, rel=0.15)


def test_no_difference_of_temperature_does_nothing() -> None:
    scene = warm("two_bearings", {"assembled": 20.0, "shaft": 20.0})
    found = thermal_level(scene)
    assert max(np.abs(one).max() for one in found.reactions.values()) == 0.0


@pytest.mark.parametrize(
    ("temperatures", "message"),
    [({"shift": 50.0}, "no part 'shift'"), ({"shaft": 900.0}, "250")],
)
def test_temperatures_that_cannot_be_are_refused(
    temperatures: dict[str, float], message: str
) -> None:
    with pytest.raises((InputError, ValueError), match=message):
        warm("two_bearings", temperatures)


def test_a_beam_has_rings_as_warm_as_the_shaft_and_says_so() -> None:
    """The assembly alone has both temperatures; a cold ring takes some 5 % of a force from it."""
    ways = [{"shaft": 60.0, "front": ring, "rear": ring} for ring in (20.0, 60.0)]
    cold, same = (thermal_tables(warm("two_bearings", way)) for way in ways)
    assert cold == same
    assert all("inner rings as warm as the shaft" in caption for caption in cold)


def test_the_caution_names_the_bearing_that_is_pushed_most() -> None:
    scene = warm("two_bearings", {"shaft": 60.0})
    said = thermal_caution(thermal_tables(scene))
    reactions = thermal_level(scene).reactions
    name = max(scene.bearing_names, key=lambda one: abs(reactions[one][0]))
    assert said is not None
    assert f"push {name} with {formatted(abs(reactions[name][0]) / 1e3, 3)} kN" in said
    assert thermal_caution({}) is None
    assert thermal_caution(thermal_tables(warm("two_bearings", {"shaft": 20.0}))) is None
