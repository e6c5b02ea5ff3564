"""A whole drivetrain in one file: what follows from the rest, what is missing, what contradicts."""

import json
import re
from copy import deepcopy
from math import cos, fsum, pi, radians, tan
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import (
    LumpedDrivetrain,
    NotGivenError,
    Scene,
    completed,
    library_scene,
    main_bearings,
    main_shaft,
    named_scene,
    parse_drivetrain,
    read_drivetrain,
    scene_text,
)
from fe_drivetrain.drivetrain_file.gear_stages import ParallelStage, PlanetaryStage
from fe_drivetrain.dynamics import (
    Level,
    library_machine,
    machine_of,
    machine_system,
    rated_torque,
    system_modes,
    torsional,
)
from fe_drivetrain.dynamics.torsion import natural_modes
from fe_drivetrain.gear import Gear, iso_gear_stiffness, meshing_without_backlash

ROOT = Path(__file__).parents[2]

PAIR: dict[str, Any] = {
    "kind": "parallel",
    "teeth": {"gear": 82, "pinion": 23},
    "module": 0.008,
    "helix": 10,
    "hand": 1,
    "face_width": 0.2,
}
SET: dict[str, Any] = {
    "kind": "planetary",
    "teeth": {"ring": 99, "planet": 39, "sun": 21},
    "planets": 3,
    "module": 0.01,
    "face_width": 0.2,
    "carrier": {"inertia": 60.0},
}


def plain(stage: PlanetaryStage | ParallelStage) -> Any:
    return completed(stage, "stage 1").stage


def test_a_stage_of_teeth_and_module_has_what_follows_from_them() -> None:
    found = completed(ParallelStage.model_validate(PAIR), "stage 1")
    stage = found.stage
    transverse = 0.008 / cos(radians(10))
    assert stage.centre_distance == pytest.approx(transverse * (82 + 23) / 2, rel=1e-12)
    assert tuple(stage.shifts or ()) == (0.0, 0.0)
    # a disc of steel of the reference diameter
    mass = 7850 * 0.2 * pi * (transverse * 23 / 2) ** 2
    assert stage.pinion.mass == pytest.approx(mass, rel=1e-12)
    assert stage.pinion.inertia == pytest.approx(mass * (transverse * 23 / 2) ** 2 / 2, rel=1e-12)
    helix = radians(10)
    gears = (Gear(23, 0.008, 0.2, -helix), Gear(82, 0.008, 0.2, helix))
    k = iso_gear_stiffness(meshing_without_backlash(*gears)).mesh * 0.2
    assert stage.stiffness == pytest.approx(k, rel=1e-9)
    assert found.not_given == ()
    assert {"centre_distance", "shifts", "gear", "pinion", "stiffness"} == found.derived.keys()


def test_the_distance_follows_from_the_shifts_and_the_shifts_from_the_distance() -> None:
    of_shifts = plain(ParallelStage.model_validate(PAIR | {"shifts": {"gear": 0.2, "pinion": 0.3}}))
    helix, normal = radians(10), radians(20)
    pair = meshing_without_backlash(
        Gear(23, 0.008, 0.2, -helix, shift=0.3), Gear(82, 0.008, 0.2, helix, shift=0.2)
    )
    assert of_shifts.centre_distance == pytest.approx(pair.centre_distance, rel=1e-12)
    back = plain(
        ParallelStage.model_validate(PAIR | {"centre_distance": of_shifts.centre_distance})
    )
    assert sum(back.shifts) == pytest.approx(0.5, rel=1e-9)
    assert tan(normal) > 0


def test_planets_and_ring_of_a_stage_share_its_distance() -> None:
    found = plain(PlanetaryStage.model_validate(SET | {"centre_distance": 0.302}))
    ring, planet, sun = found.shifts
    assert planet == sun
    # ISO 21771: 2 tan(alpha) (x1 + x2) = (z1 + z2) (inv alpha_w - inv alpha), both meshes
    working = np.arccos(0.01 * 60 / 2 * cos(radians(20)) / 0.302)
    opened = np.tan(working) - working - (tan(radians(20)) - radians(20))
    assert planet + sun == pytest.approx(60 * opened / (2 * tan(radians(20))), rel=1e-9)
    assert planet + ring == pytest.approx(-60 * opened / (2 * tan(radians(20))), rel=1e-9)


@pytest.mark.parametrize(
    ("row", "message"),
    [
        (SET | {"carrier": None}, "stage 1: the inertia of its carrier is not given: add carrier"),
        (PAIR | {"face_width": None}, "stage 1: the inertia of its gear is not given: add gear"),
        (
            {"kind": "parallel", "ratio": 4.0, "gear": {"inertia": 1.0}, "pinion": {"inertia": 1}},
            "stage 1: the mesh stiffness stiffness is not given: add it, with stiffness_of",
        ),
        (
            SET | {"stiffness_of": "line", "sun_planet": 1e9},
            "one mesh stiffness is given and ring_planet is not",
        ),
    ],
)
def test_what_is_missing_is_named_by_its_key(row: dict[str, Any], message: str) -> None:
    kind = PlanetaryStage if row["kind"] == "planetary" else ParallelStage
    given = {key: value for key, value in row.items() if value is not None}
    with pytest.raises(NotGivenError, match=message):
        completed(kind.model_validate(given), "stage 1")


@pytest.mark.parametrize(
    ("row", "message"),
    [
        (PAIR | {"teeth": [82, 23]}, "is a list but must name each gear"),
        (PAIR | {"ratio": 4.0}, "needs one of teeth, radii and ratio, not several"),
        (PAIR | {"stiffness": 1e9}, "a mesh stiffness needs stiffness_of"),
        (PAIR | {"teeth": {"gear": 82}}, "pinion"),
        (PAIR | {"faces": {"gear": 0.1, "pinion": 0.3}}, "must be at least the face"),
    ],
)
def test_a_row_that_contradicts_itself_is_refused(row: dict[str, Any], message: str) -> None:
    with pytest.raises(InputError, match=message):
        ParallelStage.model_validate(row)


TORSION = """
title: two stages by their ratios
rotor: {inertia: 1.0e6}
shaft: {torsion: 1.0e8}
gearbox:
  stages:
    - {kind: planetary, ratio: 5, planets: 3, stiffness_of: axis, carrier: {inertia: 60},
       planet: {inertia: 3}, sun: {inertia: 1}, sun_planet: 6.0e7, ring_planet: 6.0e7}
    - {kind: parallel, ratio: 4, stiffness_of: axis, gear: {inertia: 30}, pinion: {inertia: 1},
       stiffness: 5.0e7}
  shafts:
    - {name: intermediate, torsion: 3.0e7}
    - {name: high speed, torsion: 2.0e6}
generator: {inertia: 30}
"""


def test_a_drivetrain_of_ratios_turns_and_does_no_more() -> None:
    drivetrain = parse_drivetrain(TORSION)
    assert isinstance(drivetrain, LumpedDrivetrain)
    machine = machine_of(drivetrain)
    assert machine.speeds == pytest.approx((1.0, 5.0, -20.0))
    assert {"rotor: mass", "stage 1: centre_distance", "stage 2: face_width"} <= {
        *machine.not_given
    }
    system = torsional(machine)
    free = natural_modes(system)
    turned = dict(zip(free.names, free.shapes[:, 0] / free.shapes[0, 0], strict=True))
    assert turned["generator"] == pytest.approx(-20.0, rel=1e-9)
    with pytest.raises(InputError, match="at level 'rigid bodies' needs what its file does not"):
        machine_system(machine, Level.RIGID)
    with pytest.raises(InputError, match="the main shaft has no sections, which this needs"):
        named_scene("park_2021")


def test_sizes_do_not_matter_to_torsion_of_ratios() -> None:
    of_ratio = natural_modes(torsional(machine_of(parse_drivetrain(TORSION)))).frequencies
    sized = TORSION.replace("ratio: 5,", "ratio: 5, centre_distance: 0.4, face_width: 0.2,")
    sized = sized.replace("planet: {inertia: 3}", "planet: {inertia: 3, mass: 0}")
    found = natural_modes(torsional(machine_of(parse_drivetrain(sized)))).frequencies
    assert found == pytest.approx(of_ratio, rel=1e-9)


def changed(name: str, change: dict[str, Any]) -> dict[str, Any]:
    data = deepcopy(read_drivetrain(name).model_dump(mode="json", exclude_unset=True))
    for key, value in change.items():
        *path, last = (int(part) if part.isdecimal() else part for part in key.split("."))
        row: Any = data
        for part in path:
            row = row[part]
        row[last] = value
    return data


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"gearbox.shafts": []}, "3 stages and 0 shafts behind the main shaft"),
        ({"brake": {"shaft": "LLS", "torque": 1e4}}, "brake is on shaft 'LLS', which is none: use"),
        (
            {"limits": {"peak_torque": {"X": 1e9}}},
            "peak_torque is of shaft 'X', which is none",
        ),
        (
            {"limits": {"peak_torque": {"HSS": 10.0}}},
            "'HSS' is 10 N m but must be at least its",
        ),
        ({"limits": {"peak_torque": {"HSS": -1.0}}}, "limits"),
        ({"gearbox.bearings.0.holds": "stage 9 carrier"}, "which is no shaft or body"),
        ({"gearbox.stages.0.teeth.ring": 60}, "stage 1 .*: a centre distance of"),
        ({"gearbox.bearings.0.stiffness": [[1e9] * 6] * 5}, "stiffness"),
        ({"operation.rotor_speed": [2.0, 1.0]}, "must be the least and the rated speed"),
        ({"rotor.inertia": "heavy"}, "rotor"),
    ],
)
def test_what_does_not_fit_is_refused_as_the_file_is_read(
    change: dict[str, Any], message: str
) -> None:
    with pytest.raises(InputError, match=message):
        parse_drivetrain(json.dumps(changed("grc_750kw", change)), source="mine")


def test_the_whole_5_mw_drivetrain_has_main_bearings_of_its_units() -> None:
    scene = library_scene("nrel_5mw")
    rows = {row.name: row for row in main_bearings(scene)}
    assert rows["INP-A"].at == pytest.approx(0.333)
    assert tuple(rows["INP-B"].stiffness) == (4.06e8, 1.54e10, 1.54e10, 0, 0, 0)
    assert main_shaft(scene).name == "LSS"
    machine = library_machine("nrel_5mw")
    assert [bearing.name for bearing in machine.bearings[:3]] == ["INP-A", "INP-B", "PLC-A"]
    K = np.diag([0.0, 1e9, 2e9, 1e6, 3e6, 4e6])
    K[1, 5] = K[5, 1] = 1e7
    softer = machine_of(scene, {"INP-A": K}).bearings[0]
    assert softer.stiffness[1] == (0.0, 1e9, 0.0, 0.0, 0.0, 1e7)
    assert softer.stiffness[3] == (0.0,) * 6  # lets the shaft turn


def test_a_direct_drive_swings_as_two_inertias_on_its_shaft() -> None:
    machine = library_machine("iea_15mw_main_shaft")
    found = natural_modes(torsional(machine)).frequencies[1]
    shaft = machine.shafts[0]
    assert shaft.sections is not None
    section = shaft.sections[0]
    polar = pi / 32 * (section.outer_diameter**4 - section.inner_diameter**4)
    k = shaft.material.shear_modulus * polar / shaft.length
    half = shaft.material.density * polar * shaft.length / 2
    inverse = 1 / (machine.rotor.inertia + half) + 1 / (machine.generator.inertia + half)
    assert found == pytest.approx(np.sqrt(k * inverse) / (2 * pi), rel=1e-9)


def test_the_documented_drivetrain_is_held_and_turns() -> None:
    blocks = re.findall(
        r"```yaml\n(.*?)```", (ROOT / "docs/scene.md").read_text("utf-8"), re.DOTALL
    )
    (text,) = (block for block in blocks if "stages:" in block)
    machine = machine_of(parse_drivetrain(text))
    assert machine.speeds[-1] == pytest.approx(-82 / 23)
    assert len(machine_system(machine, Level.FLEXIBLE).names) > 20


def test_a_whole_drivetrain_is_written_and_read_as_the_same() -> None:
    scene = library_scene("grc_750kw")
    assert isinstance(scene, Scene)
    assert parse_drivetrain(scene_text(scene)) == scene


def test_a_rated_torque_that_the_power_contradicts_is_refused() -> None:
    """At the rotor; losses of a quarter are none, a factor is."""
    power = 5.0e6 / 1.2671 / (75 / 19 * 111 / 18 * 95 / 24)  # N m at the generator
    for share in (0.9, 1.3):
        read_drivetrain("nrel_5mw", {"generator.rated_torque": share * power})
    for share in (0.1, 0.85, 1.4):
        with pytest.raises(InputError, match=r"at the rotor by the ratio 96\.3[0-9]* of all"):
            read_drivetrain("nrel_5mw", {"generator.rated_torque": share * power})


def test_the_generators_torque_comes_before_the_power_which_has_no_losses() -> None:
    whole = read_drivetrain("nrel_5mw")
    found = rated_torque(whole, machine_of(whole))
    assert found is not None
    assert found.torque == pytest.approx(43093.55 * 75 / 19 * 111 / 18 * 95 / 24, rel=1e-12)
    changed = read_drivetrain("nrel_5mw", {"generator.rated_torque": None})
    found = rated_torque(changed, machine_of(changed))
    assert found is not None
    assert found.torque == pytest.approx(5.0e6 / 1.2671, rel=1e-12)


def test_sums_that_round_make_no_element_without_a_length() -> None:
    """The main shaft of a stranger: 0.16 + 0.29 + ... + 0.4 m is no 2.53 m in binary numbers."""
    lengths = (0.16, 0.29, 0.3, 1.1, 0.28, 0.4)
    assert fsum(lengths) != 2.53

    def frequencies(*lengths: float) -> Any:
        sections = [{"length": one, "outer_diameter": 0.7} for one in lengths]
        places = {"shaft.front": -0.6, "bearing_units.1.bearing.x": 1.05 + 1e-9}
        found = read_drivetrain("nrel_5mw", {**places, "shaft.sections": sections})
        return system_modes(machine_system(machine_of(found), Level.FLEXIBLE)).frequencies

    assert frequencies(*lengths)[:8] == pytest.approx(frequencies(2.53)[:8], rel=2e-3, abs=1e-3)
