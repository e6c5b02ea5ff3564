"""Gearbox models in REXS as drivetrains' files: of other programs, and back from our own export."""

import copy
import json
import re
from collections import Counter
from collections.abc import Callable
from math import pi
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as ET

import numpy as np
import pytest
import yaml
from file_mutants import COUNT, mutants, outcome
from rexs_models import (
    as_json,
    in_other_units,
    model_of,
    turned,
    two_parallel_stages,
    without_own,
    wrong_models,
    zipped,
)

from fe_drivetrain.common import plain_xml
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file import parse_drivetrain, read_drivetrain
from fe_drivetrain.dynamics import Level, Machine, machine_of
from fe_drivetrain.export import read_superelement
from fe_drivetrain.export.formats import rexs_model
from fe_drivetrain.export.formats.rexs_reading import GearUnit, read_gear_unit
from fe_drivetrain.export.turning import turning_of

FOREIGN = Path(__file__).parents[3] / "shared" / "data" / "rexs" / "planetary_stage_1.1.rexs"
GEARED = "nrel_750kw"
SIX = "[1.0e9, 1.0e9, 1.0e9, 0, 0, 0]"
FILLED = {
    "rotor": {"inertia": 1.0, "mass": 50.0},
    "generator": {"inertia": 0.5},
    "operation": {"rated_power": 2.5e5, "rotor_speed": [10.0, 34.2]},
}


@pytest.fixture(scope="module")
def own(tmp_path_factory: pytest.TempPathFactory) -> ET.Element:
    """A drivetrain of the library as this program writes it."""
    return model_of(read_drivetrain(GEARED), tmp_path_factory.mktemp("own") / "a.rexs")


def read(path: Path, content: ET.Element | bytes) -> GearUnit:
    path.write_bytes(content if isinstance(content, bytes) else ET.tostring(content))
    return read_gear_unit(path)


def values(machine: Any, key: str = "") -> dict[str, Any]:
    """All values by dotted keys."""
    if isinstance(machine, Machine):
        machine = machine.model_dump(mode="json")
    if isinstance(machine, dict):
        entries = list(machine.items())
    elif isinstance(machine, list | tuple):
        entries = list(enumerate(machine))
    else:
        return {key: machine}
    return {k: v for name, one in entries for k, v in values(one, f"{key}.{name}").items()}


def assert_same(one: Machine, other: Machine) -> None:
    """To round-off of a unit more or less, and of differences of places."""
    expected, found = values(one), values(other)
    assert found.keys() == expected.keys()
    for key, value in expected.items():
        if isinstance(value, float):
            assert found[key] == pytest.approx(value, rel=1e-12, abs=1e-12), key
        else:
            assert found[key] == value, key


# Round trip


@pytest.mark.parametrize("name", [GEARED, "park_2021", "synthetic_2mw"])
def test_what_is_written_is_read_back_as_the_same_drivetrain(name: str, tmp_path: Path) -> None:
    drivetrain = read_drivetrain(name)
    unit = read(tmp_path / "a.rexs", model_of(drivetrain, tmp_path / "a.rexs"))
    assert_same(machine_of(drivetrain), machine_of(unit.drivetrain))
    for key in ("brake", "operation", "damping", "limits", "sources", "assumed"):
        assert getattr(unit.drivetrain, key) == getattr(drivetrain, key), key
    # no assumption and no loss: what is left is what the drivetrain itself does not state
    assert unit.assumed == unit.refused == ()
    assert {one.key for one in unit.missing} <= {
        "operation",
        *(f"gearbox.stages.{k}.strength" for k in range(3)),
    }
    first, second = (turning_of(one, Level.RIGID) for one in (drivetrain, unit.drivetrain))
    assert first.names == second.names
    for kind, matrix in first.matrices.items():
        size = np.abs(matrix).max() or 1.0
        np.testing.assert_allclose(second.matrices[kind], matrix, rtol=0, atol=1e-13 * size)


def test_the_shaft_of_a_scene_keeps_its_sections(tmp_path: Path) -> None:
    scene = read_drivetrain("grc_750kw")
    unit = read(tmp_path / "a.rexs", model_of(scene, tmp_path / "a.rexs"))
    before, after = machine_of(scene), machine_of(unit.drivetrain)
    np.testing.assert_allclose(before.axes, after.axes, rtol=0, atol=1e-12)
    assert [b.holds for b in before.bearings] == [b.holds for b in after.bearings]
    sections = [shaft.sections for shaft in (before.shafts[0], after.shafts[0])]
    assert sections[0]
    assert sections[1]
    for one, other in zip(*sections, strict=True):
        for key in ("length", "outer_diameter", "end_diameter", "inner_diameter"):
            assert getattr(other, key) == pytest.approx(getattr(one, key), rel=1e-12)
    assert after.shafts[0].material == before.shafts[0].material


def test_forms_units_and_axes_make_no_difference(own: ET.Element, tmp_path: Path) -> None:
    expected = machine_of(read(tmp_path / "a.rexs", own).drivetrain)
    other = in_other_units(copy.deepcopy(own))
    axes = np.linalg.qr(np.random.default_rng(3).standard_normal((3, 3)))[0]
    axes[:, 2] *= np.sign(np.linalg.det(axes))
    place = turned(copy.deepcopy(own), axes, [300.0, -20.0, 7.0])
    forms: dict[str, ET.Element | bytes] = {
        "units.rexs": other,
        "elsewhere.rexs": place,
        "a.rexsj": as_json(own),
        "utf16.rexs": ET.tostring(own, encoding="utf-16"),
        "a.rexs.zip": zipped(**{"model_rexs": ET.tostring(own), "readme_txt": b"x"}),
        "b.rexsz": zipped(**{"in/a_rexs_json": as_json(own)}),
        "spaces.rexs": ET.tostring(own).replace(b"<model ", b'<model xmlns="urn:rexs" '),
    }
    for name, content in forms.items():
        assert_same(expected, machine_of(read(tmp_path / name, content).drivetrain))


def test_a_model_laid_the_other_way_is_turned_round(own: ET.Element, tmp_path: Path) -> None:
    """Half a turn about the vertical: hands of helices stay, and the rotor is in front again."""
    round_about = turned(copy.deepcopy(own), np.diag([-1.0, -1.0, 1.0]), [0.0, 0.0, 0.0])
    for shaft in round_about.iterfind("components/component[@type='shaft']"):
        array = shaft.find("attribute[@id='u_axis_vector']/array")
        assert array is not None
        array[0].text = "-1.0"  # along the gear unit's own x, against that of the world
    expected = machine_of(read(tmp_path / "a.rexs", own).drivetrain)
    assert_same(expected, machine_of(read(tmp_path / "b.rexs", round_about).drivetrain))


def test_an_edited_stiffness_goes_before_our_own(own: ET.Element, tmp_path: Path) -> None:
    edited = copy.deepcopy(own)
    bearing = edited.find("components/component[@name='main bearing']")
    assert bearing is not None
    own_matrix = ET.SubElement(bearing, "attribute", id="custom_fe_drivetrain_stiffness")
    own_matrix.text = "[5e8, 3e9, 5e9, 0, 0, 0]"  # mean of both as it stands, 4e9
    six = read(tmp_path / "a.rexs", edited).drivetrain.gearbox.bearings[0].stiffness
    assert six == (5e8, 3e9, 5e9, 0, 0, 0)
    radial = bearing.find("attribute[@id='radial_stiffness']")
    assert radial is not None
    radial.text = "6e9"
    six = read(tmp_path / "a.rexs", edited).drivetrain.gearbox.bearings[0].stiffness
    assert six == (5e8, 6e9, 6e9, 0, 0, 0)


# What other programs write


def test_what_is_not_in_the_model_is_listed_and_enough(own: ET.Element, tmp_path: Path) -> None:
    """With the missing keys alone it has a machine; without any one of the first three, none."""
    unit = read(tmp_path / "a.rexs", without_own(copy.deepcopy(own)))
    keys = [one.key for one in unit.missing]
    needed = ["rotor", "gearbox.stages.0.carrier", "generator"]
    assert keys[:3] == needed
    shafts = ["shaft", *(f"gearbox.shafts.{k}" for k in range(3))]
    assert keys[3:7] == shafts
    assert keys[7:] == ["operation", *(f"gearbox.stages.{k}.strength" for k in range(3))]
    for line in ("rotor: {inertia: ..., mass: ...}", "operation: {rated_power: ..."):
        assert f"#   {line}" in unit.text
    given = {
        "rotor": {"inertia": 998138.0, "mass": 1.2e4},
        "gearbox.stages.0.carrier": {"inertia": 65.2, "mass": 500.0},
        "generator": {"inertia": 24.0},
    }
    machine = machine_of(parse_drivetrain(unit.text, given))
    # of the last shaft, the model has no end
    assert machine.not_given == ("shaft 'HSS': length",)
    machine = machine_of(parse_drivetrain(unit.text, {**given, f"{shafts[3]}.length": 0.6}))
    assert not machine.not_given
    assert [shaft.length for shaft in machine.shafts] == pytest.approx([2.0, 0.6, 0.4, 0.6])
    assert [stage.teeth for stage in machine.stages] == [(99, 39, 21), (82, 23), (88, 22)]
    for key in needed:
        with pytest.raises(InputError, match=key.rpartition(".")[2]):
            machine_of(parse_drivetrain(unit.text, {k: v for k, v in given.items() if k != key}))
    # shafts are given by their stiffness alone, which REXS does not have
    assert sum("no shaft_section" in sentence for sentence in unit.assumed) == 4


@pytest.mark.skipif(not FOREIGN.exists(), reason="needs the foreign model, which is not shipped")
def test_a_foreign_planetary_stage_by_the_values_of_its_drawing(
    invoke: Callable[..., Any], tmp_path: Path
) -> None:
    """Teeth, places and diameters as a reader of the XML finds them, in m, N and degrees."""
    status, out, _ = invoke("new", "mine.yaml", "--from", str(FOREIGN))
    assert status == 0
    data = yaml.safe_load((tmp_path / "mine.yaml").read_text("utf-8"))
    (stage,) = data["gearbox"]["stages"]
    assert stage["teeth"] == {"ring": 61, "planet": 22, "sun": 17}
    assert (stage["planets"], stage["module"], stage["centre_distance"]) == (3, 0.004, 0.078)
    assert (stage["face_width"], stage["pressure_angle"], stage["cutter"]) == (0.05, 20.0, 23)
    assert stage["fillets"] == {"ring": 0.0, "planet": 0.25, "sun": 0.25}
    assert [pin["offset"] for pin in stage["pins"]] == [-0.0125, 0.0125]  # 112.5, 137.5 of 125 mm
    assert data["shaft"]["name"] == "Steg 1 [4]"
    assert data["shaft"]["material"]["youngs_modulus"] == 2.1e11
    (sun,) = data["gearbox"]["shafts"]
    assert (sun["name"], sun["length"], sun["outer"]) == ("Sonnenwelle [34]", 0.125, 0.034)
    at = {row["name"]: (row["holds"], row["at"]) for row in data["gearbox"]["bearings"]}
    assert at == {
        "Sonnenlager [36]": ("Sonnenwelle [34]", 0.05),  # 175 of 125 mm
        "Sonnenlager [37]": ("Sonnenwelle [34]", 0.1025),
        "Steglager [59]": ("Steg 1 [4]", 0.025),
        "Steglager [60]": ("Steg 1 [4]", 0.075),
    }
    axial = [row["stiffness"][0] > 0 for row in data["gearbox"]["bearings"]]
    assert axial == [True, False, True, False]  # both_directions, no_direction
    for said in ("rotor: {inertia: ..., mass: ...}", "torque_around_u_axis 1591.5", "ISO-VG-100"):
        assert said in out
    assert "'Shaft [260]' turns with Steg 1 [4]" in out
    assert "17 teeth with a profile shift of 0 is undercut" in out
    # two shafts and what is between by hand: 2.1e11 / 2.6 Pa, pi / 32 (D^4 - d^4) / L
    text = (tmp_path / "mine.yaml").read_text("utf-8")
    given = {"gearbox.stages.0.carrier": {"inertia": 0.05, "mass": 10.0}, **FILLED}
    drivetrain = parse_drivetrain(text, {"gearbox.stages.0.dedendum": 1.15, **given})
    machine = machine_of(drivetrain)
    assert machine.speeds[-1] == 1 + 61 / 17
    spring = turning_of(drivetrain, Level.TORSIONAL).spring.torsion.spring
    of_shafts = [
        2.1e11 / 2.6 * pi / 32 * (outer**4 - inner**4) / length
        for outer, inner, length in ((0.08, 0.06, 0.1), (0.034, 0.0, 0.125))
    ]
    slow, fast = of_shafts[0], of_shafts[1] * machine.speeds[-1] ** 2
    assert spring < 1 / (1 / slow + 1 / fast)
    stage = machine.stages[0]
    alpha = np.radians(20)
    turns = 0.078 * np.cos(alpha)  # each mesh moves by so much of the carrier's turn
    meshes = [3 * stage.sun_planet * (2 * turns) ** 2, 3 * stage.ring_planet * (2 * turns) ** 2]
    assert spring == pytest.approx(1 / sum(1 / k for k in (slow, fast, *meshes)), rel=1e-9)


def test_a_published_gearbox_of_parallel_stages_by_hand(tmp_path: Path) -> None:
    """It is driven at its fast end: read from the slow one, and looked at from the other side."""
    unit = read(tmp_path / "a.rexs", two_parallel_stages())
    names = "RW5 [36] - parallel stage 1 - RW3 [5] - parallel stage 2 - ANW [4]"
    assert unit.chain == names
    one, two = unit.drivetrain.gearbox.stages
    assert (one.teeth, two.teeth) == ((76, 13), (67, 23))
    assert (one.shifts, two.shifts) == ((-0.094, 0.521), (0.5131, 0.581))
    assert (one.helix, one.hand, two.helix, two.hand) == (10, 1, 30, -1)
    assert (one.face_width, one.faces) == (0.015, (0.015, 0.023))
    assert (one.centre_distance, two.centre_distance) == (0.057, 0.053)
    # from (50.33, 32.45) to (47.02, -24.45) mm, y the other way round
    y, z = 50.33350037591513 - 47.02148907341676, -24.45362069957225 - 32.45007497243242
    assert one.angle == pytest.approx(np.degrees(np.arctan2(z, y)))  # type: ignore[union-attr]
    data = yaml.safe_load(unit.text)
    rows = [data["shaft"], *data["gearbox"]["shafts"]]
    lengths = [[section["length"] for section in row.get("sections", [])] for row in rows]
    # from 271.5 to 177.5, and from 175 to 156.5 mm
    assert lengths[0] == pytest.approx([0.003, 0.012, 0.009, 0.041, 0.005, 0.024])
    assert lengths[1] == pytest.approx([0.0115, 0.007])
    assert [s["outer_diameter"] for s in rows[1]["sections"]] == [0.014, 0.016]
    assert (rows[2]["length"], rows[2]["outer"]) == pytest.approx((0.154, 0.022))
    at = {row["name"]: (row["holds"], row["at"]) for row in data["gearbox"]["bearings"]}
    assert at == {
        "6303-J": ("RW5 [36]", 0.008),
        "NUP204E": ("RW5 [36]", 0.077),
        "6302-J": ("stage 1 gear", 0.0355),
        "6202-J [33]": ("stage 1 pinion", -0.017),
        "6202-J [32]": ("stage 2 gear", 0.0125),
        "6305-Z-J": ("ANW [4]", 0.0885),
    }
    assert sum("its axial stiffness is not given" in line for line in unit.assumed) == 5
    assert any(line.startswith("rigid in the model are 6305") for line in unit.assumed)
    assert not unit.refused


def test_the_command_answers_in_json_and_refuses_in_one_sentence(
    own: ET.Element, invoke: Callable[..., Any], tmp_path: Path
) -> None:
    (tmp_path / "a.rexs").write_bytes(ET.tostring(own))
    status, out, _ = invoke("new", "mine.yaml", "--from", "a.rexs", "--json")
    assert status == 0
    answer = json.loads(out)
    assert answer["chain"].startswith("LSS - planetary stage 1 - IS1 - parallel stage 2")
    assert answer["missing"][0]["key"] == "gearbox.stages.0.strength"
    assert answer["assumed"] == []
    assert any("pin 1" in line for line in answer["not_used"])
    (tmp_path / "mine.yaml").write_text("title: mine\n")
    for words, sentence in (
        (("mine.yaml", "--from", "a.rexs"), "mine.yaml exists"),
        (("b.yaml", "--from", "none.rexs"), "none.rexs: there is no such file"),
        (("b.yaml", "--from", "a.rexs", "--arrangement", "two-bearings"), "give one of them"),
        (("b.yaml", "--from", "mine.yaml"), "mine.yaml is no REXS model"),
    ):
        status, _, err = invoke("new", *words)
        assert status == 2
        assert sentence in err
    assert not (tmp_path / "b.yaml").exists()
    status, _, err = invoke("check", "a.rexs")
    assert status == 2
    assert "a.rexs is a gearbox model in REXS, and no drivetrain's file" in err


REFUSED = [
    (r'version="1.6"', 'version="2.0"', "of REXS 2.0, and 1.0 to 1.6 are"),
    (r'version="1.6"', 'version="new"', "version is 'new' but must be one such as 1.6"),
    (r'"planetary_stage"', '"bevel_stage"', "bevel_stage .* is not read"),
    (r'(id="number_of_teeth" unit="none">)99', r"\g<1>99.5", "is 99.5 but must be whole"),
    (r'(id="normal_module" unit=)"mm">10', r'\1"N">10', "normal_module is in 'N' but must be"),
    (r'(id="normal_module" unit="mm">)10.0', r"\g<1>nan", "is 'nan' but must be a finite number"),
    (r'"ring_gear"', '"cylindrical_gear"', "2 suns, 0 rings and 3 planets"),
    (r'type="stage"', 'type="stages"', "no two gears|0 suns"),
    (r'id="3" type="shaft"', 'id="4" type="shaft"', "two components have the id 4"),
    (r'ref id="3"', 'ref id="999"', "component '999', which there is not"),
    (r'unit="none">1<', 'unit="none">99<', "placed by component 99|in a circle"),
    (r"<c>1.0</c>", "<c>0.0</c>", "must be perpendicular and not zero"),
    (r'"central_shaft"', '"central_shafts"', ""),
    (r"(fe_drivetrain_rotor\D+>).*<", r"\1{inertia<", "must be a value in JSON"),
    (r"(center_distance\D+)450.0", r"\g<1>0.450", "stage 2"),
]


@pytest.mark.parametrize(("old", "new", "message"), REFUSED)
def test_what_cannot_be_is_refused_in_one_sentence(
    own: ET.Element, tmp_path: Path, old: str, new: str, message: str
) -> None:
    text = re.sub(old, new, ET.tostring(own, encoding="unicode"))
    assert text != ET.tostring(own, encoding="unicode")
    if not message:  # a relation that nothing here needs
        assert read(tmp_path / "a.rexs", text.encode()).missing
        return
    with pytest.raises(InputError, match=message) as caught:
        read(tmp_path / "a.rexs", text.encode())
    assert str(caught.value).startswith(str(tmp_path / "a.rexs"))


def part(model: ET.Element, name: str) -> ET.Element:
    found = model.find(f"components/component[@name='{name}']")
    assert found is not None
    return found


def attribute(model: ET.Element, name: str, key: str) -> ET.Element:
    found = part(model, name).find(f"attribute[@id='{key}']")
    assert found is not None
    return found


def joined(model: ET.Element, role: str, whom: str) -> ET.Element:
    """The model with another shaft at one side of the coupling between ring and casing."""
    coupling = part(model, "stage 1 ring in the casing").get("id")
    for relation in model.iterfind("relations/relation[@type='side']"):
        ends = {ref.get("role"): ref for ref in relation}
        if ends["assembly"].get("id") == coupling:
            ends[role].set("id", part(model, whom).get("id", ""))
    return model


def test_who_is_held_in_a_planetary_stage_is_seen(own: ET.Element, tmp_path: Path) -> None:
    path = tmp_path / "a.rexs"
    for whom, said in (("LSS", "its carrier is held"), ("IS1", "its sun is held")):
        with pytest.raises(InputError, match=said):
            read(path, joined(copy.deepcopy(own), "inner_part", whom))
    free = copy.deepcopy(own)
    attribute(free, "stage 1 ring in the casing", "rotational_stiffness").text = "0"
    unit = read(path, free)
    assert unit.assumed == (
        "ring_gear 15 'stage 1 ring' is joined to nothing by the model: it is taken for held",
    )
    driven = joined(copy.deepcopy(own), "outer_part", "HSS")
    with pytest.raises(InputError, match="its ring turns with another stage"):
        read(path, driven)


def test_places_in_a_circle_and_axes_across_are_refused(own: ET.Element, tmp_path: Path) -> None:
    circle, across, down = (copy.deepcopy(own) for _ in range(3))
    for one, other in (("LSS", "IS1"), ("IS1", "LSS")):
        reference = attribute(circle, one, "reference_component_for_position")
        reference.text = part(circle, other).get("id")
    with pytest.raises(InputError, match="by a component that is placed by it, in a circle"):
        read(tmp_path / "a.rexs", circle)
    cells = list(attribute(across, "IS2", "u_axis_vector").iter("c"))
    cells[0].text, cells[1].text = "0.0", "1.0"
    with pytest.raises(InputError, match="an axis that is not parallel"):
        read(tmp_path / "a.rexs", across)
    # where gravity is along v, v is down: 60 degrees from y to z are 60 - 90
    unit = "NREL 750 kW drivetrain of the Gearbox Reliability Collaborative"
    attribute(down, unit, "direction_vector_gravity_v").text = "1"
    attribute(down, unit, "direction_vector_gravity_w").text = "0"
    stages = read(tmp_path / "a.rexs", down).drivetrain.gearbox.stages
    assert getattr(stages[2], "angle") == pytest.approx(-30.0)  # noqa: B009 - of one kind alone


BOMB = "".join(
    f'<!ENTITY {b} "{f"&{a};" * 10}">' for a, b in zip("abcdefgh", "bcdefghi", strict=True)
)
HOSTILE = {
    "bomb": f'<!DOCTYPE m [<!ENTITY a "aaaaaaaaaa">{BOMB}]><model version="1.6">&i;</model>',
    "file": '<!DOCTYPE m [<!ENTITY x SYSTEM "file:///etc/passwd">]><model>&x;</model>',
    "type": '<!DOCTYPE m SYSTEM "http://localhost/m.dtd"><model version="1.6"/>',
    "deep": "<model>" + "<a>" * 10**5,
    "deep json": '{"model": ' + "[" * 10**5,
    "digits": '{"model": {"version": ' + "9" * 10**4,
    "empty": "",
    "no object": '{"model": 3}',
    "no lists": '{"model": {"version": "1.6", "components": {"a": 1}}}',
    "other": "<html/>",
}


@pytest.mark.parametrize("name", HOSTILE)
def test_bombs_and_files_of_others_are_refused(name: str, tmp_path: Path) -> None:
    path = tmp_path / "a.rexs"
    path.write_text(HOSTILE[name])
    fate, sentence = outcome(lambda: read_gear_unit(path))
    assert fate == "refused", sentence
    assert "no REXS model" in sentence
    assert "root:" not in sentence
    if name in ("bomb", "file", "type"):
        assert "<!DOCTYPE" in sentence
        # the reader of stiffnesses goes through the same door
        with pytest.raises(InputError, match="<!DOCTYPE"):
            read_superelement(path, "rexs")


def test_what_is_too_large_is_refused_before_it_is_made(
    own: ET.Element, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.rexsz"
    monkeypatch.setattr(rexs_model, "MAX_CONTENT", 10_000)
    with pytest.raises(InputError, match="more than 10,000 bytes"):
        read(path, zipped(a_rexs=b" " * 10**6))  # a thousandth of it in the archive
    with pytest.raises(InputError, match="more than 10000 bytes"):
        read(path, ET.tostring(own))
    for archive, said in (
        (zipped(a_rexs=b"x", b_rexsj=b"y"), "2 REXS models"),
        (zipped(a_txt=b"x"), "0 REXS models"),
        (zipped(a_rexs=b"<model/>")[:-30], "no sound ZIP archive"),
    ):
        with pytest.raises(InputError, match=said):
            read(path, archive)
    monkeypatch.undo()
    many = "".join(f'<component id="{k}" type="shaft_section"/>' for k in range(1000, 4000))
    sections = ET.tostring(own, encoding="unicode").replace("</components>", f"{many}</components>")
    with pytest.raises(InputError, match="3,000 components of type 'shaft_section' but must have"):
        read(tmp_path / "a.rexs", sections.encode())
    monkeypatch.setattr(plain_xml, "MAX_ELEMENTS", 100)
    with pytest.raises(InputError, match="more than 100 elements"):
        read(path, b"<model>" + b"<a/>" * 200 + b"</model>")


@pytest.mark.parametrize("form", ["a.rexs", "a.rexsj", "a.rexsz", "slips.rexs"])
def test_a_mutant_is_read_or_refused_in_one_sentence(
    own: ET.Element, tmp_path: Path, form: str
) -> None:
    """A few of each form; 500 by FE_DRIVETRAIN_MUTANTS=500."""
    sound = ET.tostring(own)
    count = COUNT or 4
    wrong = {
        "a.rexs": lambda: mutants(sound, count, seed=48),
        "a.rexsj": lambda: mutants(as_json(own), count, seed=48),
        "a.rexsz": lambda: mutants(zipped(a_rexs=sound), count, seed=48),
        "slips.rexs": lambda: wrong_models(own, count, seed=48),
    }[form]()
    path, fates, faults = tmp_path / form, Counter[str](), []
    for number, content in enumerate(wrong):
        fate, what = outcome(lambda content=content: read(path, content).text)  # type: ignore[misc]
        fates[fate] += 1
        if fate == "refused":
            fine = form in what and what.isprintable() and 10 < len(what) < 900
        else:
            fine = fate == "read"
        if not fine:
            faults.append(f"{number}: {fate}, {what}")
    print(f"{form}: {dict(fates)}")
    assert not faults
