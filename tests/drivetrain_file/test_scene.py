"""Scenes from YAML: what is read, what is refused, and that a file cannot do anything."""

import json
import re

import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.reading import parse_mapping
from fe_drivetrain.drivetrain_file.left_out import left_out
from fe_drivetrain.drivetrain_file.reading import (
    change_scene,
    library_scene,
    parse_scene,
    read_scene,
)

TEXT = """
title: small
shaft: {front: -1.0, sections: [{length: 2.0, outer_diameter: 0.4}]}
bearing_units:
  - {bearing: {name: main_bearing}, housing: {}, interface: sliding}
gearbox: {stiffness: [4e6, 8e7, 8e7, rigid, 0, 0], weight: 1000}
"""


def test_reads_numbers_as_engineers_write_them():
    scene = parse_scene(TEXT)
    assert scene.gearbox.stiffness == (4e6, 8e7, 8e7, "rigid", 0.0, 0.0)
    assert scene.bearing_unit("main_bearing").interface == "sliding"


@pytest.mark.parametrize("name", ["main_bearing_spherical", "main_bearing_bonded"])
def test_library_scenes_are_table_3_1(name):
    scene = library_scene(name)
    assert -scene.shaft.front == pytest.approx(2.145)
    assert scene.shaft.rear == pytest.approx(2.615)
    assert scene.shaft.sections[0].outer_diameter == 0.4
    assert scene.gearbox.stiffness[:3] == (4e6, 8e7, 8e7)
    assert scene.gearbox.weight == 392280


def test_a_bearing_goes_by_its_default_name():
    text = TEXT.replace("{name: main_bearing}", "{width: 0.18}")
    scene = parse_scene(text, {"bearing_units.main_bearing.housing.wall": 0.07})
    assert scene.bearing_units[0].housing.wall == 0.07


def test_round_trip_through_a_change():
    scene = parse_scene(TEXT)
    assert change_scene(scene, {}) == scene
    thinner = change_scene(scene, {"bearing_units.main_bearing.housing.wall": 0.07})
    assert thinner.bearing_units[0].housing.wall == 0.07
    assert (
        change_scene(thinner, {"bearing_units.0.housing.wall": scene.bearing_units[0].housing.wall})
        == scene
    )


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"shaft.sections.0.outer_diameter": -0.4}, "outer_diameter.*-0.4"),
        ({"shaft.sections.0.length": 0}, "length.* 0"),
        ({"shaft.sections.0.inner_diameter": 0.4}, "inner"),
        ({"shaft.sections.0.inner_diameter": 0.5}, "inner"),
        ({"shaft.colour": "red"}, "shaft: unknown key 'colour': use one of name, front, sections"),
        ({"colour": "red"}, "unknown key 'colour'.*gearbox"),
        ({"shaft.material": "cheese"}, "material 'cheese' of shaft is unknown: use one of steel"),
        ({"bearing_units.0.housing.material": "chees"}, "'chees' of main_bearing.housing"),
        ({"gearbox.stiffness": [1, 2, 3]}, "gearbox.stiffness"),
        (
            {"gearbox.stiffness": [-1, 0, 0, 0, 0, 0]},
            "-1 must be 0, a number from 1e-06 to 1e.16 .*, or 'rigid'",
        ),
        ({"gearbox.stiffness": [1e60, 0, 0, 0, 0, 0]}, "1e.60 must be 0, a number from 1e-06 to"),
        (
            {"gearbox.stiffness": ["ridgid", 0, 0, 0, 0, 0]},
            "'ridgid' but must be a number.* or 'rigid'",
        ),
        (
            {"gearbox.weight": "392kN"},
            "is '392kN' but must be a number in SI units, without",
        ),
        (
            {"shaft": {"frnt": -1.0, "sections": []}},
            "unknown key 'frnt'.*did you mean 'front'",
        ),
        ({"shaft.sections.1.length": 1}, "no '1'; there are 0 to 0"),
        ({"gearbox.stiffness": [".nan", 0, 0, 0, 0, 0]}, "gearbox.stiffness"),
        ({"gearbox.stiffness": [1e-300, 0, 0, 0, 0, 0]}, "1e-300 must be 0, a number from 1e-06"),
        ({"gearbox.weight": 1e308}, r"gearbox.weight is 1e\+308 but must be at most 1e\+09"),
        ({"gearbox.weight": -1}, "gearbox.weight is -1 but must be at least 0 .weight"),
        ({"gearbox.stiffness": [True, 0, 0, 0, 0, 0]}, "gearbox.stiffness"),
        ({"bearing_units.0.bearing.name": "gearbox"}, "not be one of shaft, hub, gearbox"),
        ({"bearing_units": [{"bearing": "ring"}], "bearing_units.x.housing.wall": 1}, "no 'x'"),
        ({"bearing_units.0.interface": "glued"}, "interface is 'glued'.*bonded"),
        ({"bearing_units.0.bearing.kind": "ring"}, "cannot have the spherical-joint interface"),
        ({"bearing_units.7.interface": "bonded"}, "there is no '7'"),
        (
            {"uncertainty": {"shaft.nosuch": {"uniform": 0.1}}},
            "uncertainty of 'shaft.nosuch': the scene has no number there",
        ),
        (
            {"uncertainty": {"gearbox.stiffness.5": {"uniform": 0.1}}},
            "'gearbox.stiffness.5': the value is 0, and a spread is relative",
        ),
        (
            {"bearing_units.0.housing.wall": -0.1},
            "bearing unit 'main_bearing': housing: wall is -0.1 but must be at least",
        ),
        (
            {"bearing_units.0.housing.wall": 150},
            "main_bearing.housing: wall is 150 m but must be at most 6 m, .* 0.15 m if this was",
        ),
        (
            {"bearing_units.0.bedplate": [-1, 1e9, 1e9, 1e9, 1e9, 1e9]},
            "bearing_units.main_bearing.bedplate: -1 must be a number from 1e-06 to 1e.16 .*rigid",
        ),
        (
            {"bearing_units.0.bedplate": [0, 1e9, 1e9, 1e9, 1e9, 1e9]},
            "bearing_units.main_bearing.bedplate: 0 must be a number from 1e-06 to 1e.16 .*rigid",
        ),
        (
            {"bearing_units.frnt.housing.wall": 0.1},
            "there is no 'frnt'; there are main_bearing, or by number 0 to 0: use a key",
        ),
        (
            {"bearing_units.0.mounting": {"clearance_class": "C3", "fit": {"shaft": "much6"}}},
            r"mounting.fit.shaft is 'much6'",
        ),
        (
            {"bearing_units.0.catalogue": {"designation": 6309.5, "C": 1e5, "C0": 1e5}},
            "designation is 6309.5 but must be a text, in quotes where it looks like a number",
        ),
        ({"hub.loads_at": 50}, "hub.loads_at is 50 m but must be from -11 to 9 m, at most 5 len"),
        ({"hub.loads_at": -11.5}, "hub.loads_at is -11.5 m but must be from -11 to 9 m"),
        (
            {"materials": {"m": {"youngs_modulus": 210, "poisson_ratio": 0.3, "density": 1}}},
            "youngs",
        ),
        (
            {"materials": {"m": {"youngs_modulus": 1e9, "poisson_ratio": 0.5, "density": 1}}},
            "poisson",
        ),
    ],
)
def test_refuses_with_one_sentence(changes, message):
    with pytest.raises(InputError, match=message) as caught:
        parse_scene(TEXT, changes)
    assert "\n" not in str(caught.value)
    assert "Traceback" not in str(caught.value)


def test_own_material_is_taken():
    scene = parse_scene(
        TEXT,
        {
            "materials.alloy": {"youngs_modulus": "7e10", "poisson_ratio": 0.33, "density": 2700},
            "shaft.material": "alloy",
        },
    )
    assert scene.material_of("shaft").youngs_modulus == 7e10
    assert scene.material_of("main_bearing.housing").density == 7100


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("!!python/object/apply:os.system ['echo hacked > /tmp/hacked']", "not plain YAML"),
        ("a: &a [1]\nb: *a", "anchors and aliases are not allowed"),
        ("[" * 3000 + "]" * 3000, "nested deeper|not plain YAML"),
        ("{" * 30 + "}" * 30, "nested deeper|not plain YAML"),
        ("a: 1\nb: {c: 1, c: 2}", "'c' stands twice"),
        ("just text", "must be a mapping"),
        ("a: [1, 2", r"not plain YAML: (?!.*unicode string).* at line 1"),
        ("a: 1\nb: {d: 0,85, e: 2}", r"line 2: key '85' must be .* decimal point .* 0\.85"),
        ("a: 1\n3: 2", r"line 2: key '3' must be a word: put it in quotes$"),
        ("", "must be a mapping"),
    ],
)
def test_hostile_or_broken_yaml_runs_nothing(text, message):
    with pytest.raises(InputError, match=message):
        parse_scene(text)


def test_file_limits_and_absence(tmp_path):
    with pytest.raises(InputError, match="cannot read scene file"):
        read_scene(tmp_path / "none.yaml")
    big = tmp_path / "big.yaml"
    big.write_text("# " + "x" * 1_000_001)
    with pytest.raises(InputError, match="it has more than 1000000 bytes"):
        read_scene(big)
    binary = tmp_path / "binary.yaml"
    binary.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(InputError, match="cannot read"):
        read_scene(binary)


def test_uncertain_values_may_be_of_materials_that_come_with_the_program():
    spreads = {"materials.steel.youngs_modulus": {"normal": 0.02}}
    assert set(parse_scene(TEXT, {"uncertainty": spreads}).uncertainty) == set(spreads)


def test_hub_loads_may_be_about_the_rotor_or_the_axis_of_the_tower():
    for x in (-2.5, 0.0, 9.0):
        assert parse_scene(TEXT, {"hub.loads_at": x}).loads_at == x


@pytest.mark.parametrize(
    "change", [{"housing.wall": -0.1}, {"bearing.width": -1}, {"housing.foot_thickness": 2}]
)
def test_the_bearing_unit_that_is_wrong_is_named_once(change):
    ((key, value),) = change.items()
    with pytest.raises(InputError, match="bearing unit 'rear': ") as caught:
        change_scene(library_scene("two_bearings"), {f"bearing_units.rear.{key}": value})
    assert str(caught.value).count("rear") == 1
    with pytest.raises(InputError, match=r"bearing_units\.rear\.interface is 'glued'"):
        change_scene(library_scene("two_bearings"), {"bearing_units.rear.interface": "glued"})


def test_truth_values_are_no_numbers_in_lists_of_any_depth_or_of_numpy():
    rows = np.diag([1e9, 1e9, 1e9, 1e8, 1e8, 1e8]).tolist()
    scene = library_scene("main_bearing_bonded")
    unit = {"bearing_units.main_bearing.interface": "spring"}
    key = "bearing_units.main_bearing.stiffness"
    assert change_scene(scene, {**unit, key: rows}).bearing_units[0].interface == "spring"
    for row, column, truth in ((0, 1, False), (3, 3, True), (3, 3, np.True_)):
        wrong = [list(r) for r in rows]
        wrong[row][column] = truth
        with pytest.raises(InputError, match="a truth value has no meaning here"):
            change_scene(scene, {**unit, key: wrong})


def test_what_a_scene_leaves_out_is_listed_with_its_value_and_reason(tmp_path):
    text = """
title: little is given
shaft: {front: -1, sections: [{length: 2.5, outer_diameter: 0.4}]}
bearing_units: [{bearing: {width: 0.2}, housing: {base: fixed}, interface: sliding}]
gearbox: {stiffness: [4e6, 8e7, 8e7, 8e7, 0, 0]}
"""
    rows = {row.key: row for row in left_out(parse_scene(text))}
    assert rows["bearing_units.main_bearing.bearing.raceway_diameter"][1:3] == (0.6, "m")
    assert rows["bearing_units.main_bearing.housing.wall"].value == 0.11
    assert rows["shaft.material"].value == "steel"
    assert rows["gearbox.weight"][1:3] == (0.0, "N")
    assert rows["hub.coupling"].value == "averaged"
    assert all(row.why.startswith("assumed: ") for row in rows.values())
    # what is given, and what nothing uses
    for key in ("bearing.width", "housing.base", "housing.bolt_diameter", "interface"):
        assert f"bearing_units.main_bearing.{key}" not in rows
    given = parse_scene(text, {"gearbox.weight": 0, "shaft.material": "steel"})
    assert {"gearbox.weight", "shaft.material"} == rows.keys() - {r.key for r in left_out(given)}


def test_a_file_that_a_scene_names_and_is_not_there_is_refused_as_it_is_read(tmp_path):
    unit = {"bearing": {}, "housing": {"step": "no.step", "seat": {"radius": 300}, "held": []}}
    held = {"point": [0, 0, -420], "normal": [0, 0, 1]}
    unit["housing"]["held"] = [held]
    data = {
        "title": "t",
        "shaft": {"front": -1, "sections": [{"length": 2.5, "outer_diameter": 0.4}]},
        "bearing_units": [unit | {"interface": "sliding"}],
        "gearbox": {"stiffness": [4e6, 8e7, 8e7, 8e7, 0, 0]},
    }
    file = tmp_path / "mine.yaml"
    file.write_text(json.dumps(data))
    with pytest.raises(InputError, match=r"main_bearing.housing: cannot read .*no.step: there is"):
        read_scene(file)
    (tmp_path / "no.step").write_text("")
    assert read_scene(file).bearing_units[0].foreign is not None


def test_what_is_changed_in_one_reading_of_a_text_is_not_in_the_next() -> None:
    first = parse_mapping("a: {b: [1, 2]}", "text")
    first["a"]["b"].append(3)
    assert parse_mapping("a: {b: [1, 2]}", "text") == {"a": {"b": [1, 2]}}


def test_messages_have_no_names_of_classes_or_of_pydantics_unions() -> None:
    scene = library_scene("two_bearings")
    for changes in (
        {"strength": {"tensile_strength": -1.0, "yield_strength": 1.0}},
        {"bearing_units.0.mounting": {"clearance_class": "C3", "fit": {"shaft": "much6"}}},
        {"bearing_units.0.mounting": {"clearance_class": "C3", "fit": {"shaft": [1, 2]}}},
        {"bearing_units.0.catalogue": {"designation": [1]}},
        {"uncertainty": {"shaft.front": {"unifrm": 0.1}}},
    ):
        with pytest.raises(InputError) as caught:
            change_scene(scene, changes)
        message = str(caught.value)
        assert not re.search(r"constrained|tuple\[|ShaftStrength|CataloguePage|Spread", message)
