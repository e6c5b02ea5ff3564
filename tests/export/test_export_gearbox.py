"""Files for gearbox, multibody and system programs: REXS, SIMPACK, windIO and WISDEM."""

import warnings
import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest
import yaml
from coarse_scenes import coarse_scene

from fe_drivetrain import export
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.stiffness_bands import StiffnessBands
from fe_drivetrain.drivetrain_file.reading import library_scene
from fe_drivetrain.export.formats import rexs, simpack, windio
from fe_drivetrain.export.formats.elastodyn import Torsion
from fe_drivetrain.export.from_scene import unit_superelement
from fe_drivetrain.export.seat_superelements import seats_superelement
from fe_drivetrain.export.superelement import Origin, Superelement

TURBINE = """\
# a turbine, with a comment
components:
    hub: {diameter: 4.0} # flow style
    drivetrain:
        outer_shape:
            gear_ratio: 80.0   # high over low
        elastic_properties:
            mass: 1.0e+5
            inertia: [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]
            location: [0.0, 0.0, 0.0]
            spring_constant: 69737644923.05057 # of WISDEM's shaft
            damping_coefficient: 49372801.6
    yaw:
        elastic_properties: {mass: 2.0}
"""
NEW = Torsion(87876717.58333518, 1e16)
OVERRIDE = "components.drivetrain.spring_constant_user"


def two_seats(mass: bool = False) -> Superelement:
    rng = np.random.default_rng(5)
    root = rng.standard_normal((12, 12)) * 10.0 ** rng.uniform(3, 5, 12)[:, None]
    M = np.diag(np.arange(1.0, 13.0)) if mass else None
    K = root @ root.T
    return Superelement(
        "casing",
        ("front", "rear"),
        np.array([[0.0, 0.1, 0.2], [1.5, 0.0, -0.25]]),
        0.5 * (K + K.T),
        M,
        supported=True,
        band=StiffnessBands(0.04, 0.001, 0.05),
        origin=Origin("a -- scene <&>", "00ff", "4 solid", "0.1 m", "fe-drivetrain 1.2"),
    )


# REXS


def test_rexs_relates_casing_group_and_points_as_its_database_allows(tmp_path: Path) -> None:
    path = tmp_path / "casing.rexs"
    export.write_superelement(path, two_seats(), "rexs")
    content = path.read_bytes()
    assert content.startswith(b"\xef\xbb\xbf<?xml")  # REXS asks for the byte order mark
    model = ET.fromstring(content)
    assert model.tag == "model"
    assert {"version", "applicationId", "applicationVersion", "date"} <= set(model.attrib)
    kinds = {c.get("id"): c.get("type") for c in model.iterfind("components/component")}
    assert (
        list(kinds.values())
        == ["gear_unit", "gear_casing", "assembly_group"] + ["reduction_point"] * 2
    )
    related = [
        (r.get("type"), r.get("order"), *((ref.get("role"), kinds[ref.get("id")]) for ref in r))
        for r in model.iterfind("relations/relation")
    ]
    points = ("assembly", "assembly_group"), ("part", "reduction_point")
    assert related == [
        ("assembly", None, ("assembly", "gear_unit"), ("part", "gear_casing")),
        ("reference", None, ("origin", "gear_casing"), ("referenced", "assembly_group")),
        ("ordered_assembly", "1", *points),
        ("ordered_assembly", "2", *points),
    ]
    for relation in model.iterfind("relations/relation"):
        for ref in relation:
            assert ref.get("hint") == kinds[ref.get("id")]


def test_rexs_is_in_millimetres(tmp_path: Path) -> None:
    """1 N moves a point by as much in either unit, and a moment of 1000 N mm is 1 N m."""
    element = two_seats()
    path = tmp_path / "casing.rexs"
    export.write_superelement(path, element, "rexs")
    model = ET.fromstring(path.read_bytes())
    rows = model.iterfind(".//attribute[@id='reduced_static_stiffness_matrix']/matrix/r")
    K = np.array([[float(c.text or "nan") for c in row] for row in rows])
    metres = np.tile([1e3, 1e3, 1e3, 1.0, 1.0, 1.0], 2)  # of m in mm, rad in rad
    motion = np.random.default_rng(0).standard_normal(12)
    energy = motion @ element.stiffness @ motion  # N m
    assert (metres * motion) @ K @ (metres * motion) == pytest.approx(1e3 * energy, rel=1e-12)
    places = [
        [float(c.text or "nan") for c in p.iterfind(".//c")]
        for p in model.iterfind("components/component[@type='reduction_point']")
    ]
    np.testing.assert_allclose(places, 1e3 * element.positions, rtol=1e-15)
    units = model.find(".//attribute[@id='custom_stiffness_units']")
    assert units is not None
    assert units.text == "N/mm, N/rad, N mm/rad"


def test_rexs_keeps_the_order_of_the_relations(tmp_path: Path) -> None:
    """Points belong to the matrix by the order in the relations, not in the file."""
    path = tmp_path / "casing.rexs"
    export.write_superelement(path, two_seats(), "rexs")
    text = path.read_text("utf-8-sig")
    swapped = text.replace('order="1"', 'order="9"').replace('id="4"', 'id="7"')
    path.write_text(swapped, "utf-8-sig")
    model = ET.fromstring(swapped.encode())
    assert rexs._ordered(model, "3") == ["5", "7"]


def test_rexs_says_what_it_is(tmp_path: Path) -> None:
    path, element = tmp_path / "casing.rexs", two_seats()
    export.write_superelement(path, element, "rexs")
    back = export.read_superelement(path, "rexs")
    assert back.points == element.points
    assert back.band == element.band
    assert back.supported
    assert back.origin.scene == "a - - scene <&>"  # two hyphens would end the comment
    assert back.origin.scene_hash == "00ff"


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("reduced_static_stiffness_matrix", "other", "StopIteration"),
        ("<r>", "<r><c>1.0</c>", "shape"),
        ("<array>", "<array><c>1.0</c>", "x, y and z"),
        ("ordered_assembly", "assembly", "for 0 points"),
        ("<c>0.0</c>", "<c>zero</c>", "ValueError"),
    ],
)
def test_rexs_of_other_content(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = tmp_path / "casing.rexs"
    export.write_superelement(path, two_seats(), "rexs")
    path.write_text(path.read_text("utf-8-sig").replace(old, new))
    with pytest.raises(InputError, match=message) as caught:
        export.read_superelement(path, "rexs")
    assert str(path) in str(caught.value)


def test_seats_of_a_scene(tmp_path: Path) -> None:
    scene = coarse_scene("bonded")
    seats, unit = seats_superelement(scene), unit_superelement(scene, "main_bearing")
    assert seats.points == ("main_bearing",)
    np.testing.assert_array_equal(seats.stiffness, unit.stiffness)
    path = tmp_path / "seats.rexs"
    export.write_superelement(path, seats, "rexs")
    np.testing.assert_allclose(
        export.read_superelement(path, "rexs").stiffness, seats.stiffness, rtol=1e-14
    )


def test_two_seats_have_a_node_each_and_nothing_between(tmp_path: Path) -> None:
    scene = library_scene("two_bearings")
    scene = scene.model_copy(update={"mesh": scene.mesh.scaled(3.0)})
    path = tmp_path / "seats.rexs"
    export.write_superelement(path, seats_superelement(scene), "rexs")
    seats = export.read_superelement(path, "rexs")
    assert seats.points == tuple(unit.bearing.name for unit in scene.bearing_units)
    for k, unit in enumerate(scene.bearing_units):
        assert seats.positions[k, 0] == pytest.approx(unit.bearing.x, rel=1e-15)
    assert not seats.stiffness[:6, 6:].any()
    for first in (0, 6):  # spherical joints: the rotations may be free
        seat = seats.stiffness[first : first + 3, first : first + 3]
        assert np.linalg.eigvalsh(seat)[0] > 0


# SIMPACK


def test_subvar_has_each_entry_once_and_keeps_every_digit(tmp_path: Path) -> None:
    path, element = tmp_path / "casing.subvar", two_seats(mass=True)
    export.write_superelement(path, element, "simpack")
    lines = path.read_text().splitlines()
    assert lines[0].startswith("!file.version=")
    given = [line for line in lines if line and not line.startswith("!")]
    assert len(given) == 2 * 78 + 2 * 3
    assert all(line.startswith("subvar($_casing_") for line in given)
    assert "subvar($_casing_x_2, str= '1.5') ! [m] rear" in given
    value = float(element.stiffness[2, 8])
    assert f"subvar($_casing_K_3_9, str= '{value!r}') ! [N/m] front uz, rear uz" in given
    back = export.read_superelement(path, "simpack")
    np.testing.assert_array_equal(back.stiffness, element.stiffness)
    assert back.mass is not None
    assert element.mass is not None
    np.testing.assert_array_equal(back.mass, element.mass)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("!file", "! file", "must state its version"),
        ("$_casing_K_3_9", "$_casing_K_3_99", "has no variable 'casing_K_3_9'"),
        ("str= '1.5'", "str= '1.5", "no SIMPACK|superelement|casing"),
        ("_M_2_2, str= '2.0'", "_M_2_2, str= '$_other'", "no number"),
    ],
)
def test_subvar_of_other_content(tmp_path: Path, old: str, new: str, message: str) -> None:
    path = tmp_path / "casing.subvar"
    export.write_superelement(path, two_seats(mass=True), "simpack")
    path.write_text(path.read_text().replace(old, new))
    if "1.5" in old:  # a position stands in the comments, too: they decide
        assert simpack.read(path).positions[1, 0] == 1.5
        return
    with pytest.raises(InputError, match=message):
        simpack.read(path)


# windIO and WISDEM


@pytest.fixture
def turbine(tmp_path: Path) -> Path:
    path = tmp_path / "turbine.yaml"
    path.write_text(TURBINE)
    return path


def test_only_the_values_of_the_program_change(turbine: Path) -> None:
    expected = yaml.safe_load(TURBINE)
    drivetrain = expected["components"]["drivetrain"]
    elastic = drivetrain["elastic_properties"]
    new = turbine.with_name("new.yaml")

    done = windio.write_torsion(turbine, new, NEW, "windio")
    elastic["spring_constant"], elastic["damping_coefficient"] = NEW
    assert yaml.safe_load(new.read_text()) == expected  # every digit
    assert windio.read_torsion(new) == dict(zip(done, NEW, strict=True))
    lines = new.read_text().splitlines()
    assert len(lines) == len(TURBINE.splitlines())
    assert "            spring_constant: 87876717.58333518 # of WISDEM's shaft" in lines

    windio.write_torsion(new, new, NEW, "wisdem", overwrite=True)
    drivetrain["spring_constant_user"], drivetrain["damping_coefficient_user"] = NEW
    assert yaml.safe_load(new.read_text()) == expected
    assert len(new.read_text().splitlines()) == len(lines) + 2
    # a second time replaces what the first one put in
    windio.write_torsion(new, new, Torsion(2e8, 3e6), "wisdem", overwrite=True)
    assert len(new.read_text().splitlines()) == len(lines) + 2
    assert windio.read_torsion(new)[OVERRIDE] == 2e8


def test_line_endings_stay_as_they_are(turbine: Path) -> None:
    turbine.write_bytes(b"components:\r\n  drivetrain:\r\n    outer_shape: {gear_ratio: 1.0}\r\n")
    done = windio.write_torsion(turbine, turbine, NEW, overwrite=True)
    assert done == (OVERRIDE, "components.drivetrain.damping_coefficient_user")
    assert turbine.read_bytes().count(b"\r\n") == turbine.read_bytes().count(b"\n") == 5
    assert windio.read_torsion(turbine)[OVERRIDE] == NEW.spring
    with pytest.raises(InputError, match="windIO needs mass"):
        windio.write_torsion(turbine, turbine, NEW, "windio", overwrite=True)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "has no components.drivetrain"),
        (b"components: {drivetrain: {a: 1}}", "block style"),
        (b"components: [", "no windIO turbine file"),
        (bytes(range(128, 256)), "not UTF-8 text"),
        (b"components:\n  drivetrain:\n    spring_constant_user: stiff\n", "is no number"),
    ],
)
def test_what_is_no_turbine_file(turbine: Path, content: bytes, message: str) -> None:
    turbine.write_bytes(content)
    with pytest.raises(InputError, match=message) as caught:
        windio.write_torsion(turbine, turbine, NEW, overwrite=True)
    assert str(turbine) in str(caught.value)
    assert turbine.read_bytes() == content


def test_windio_is_not_overwritten_unless_told(turbine: Path) -> None:
    with pytest.raises(InputError, match="exists"):
        windio.write_torsion(turbine, turbine, NEW)
    with pytest.raises(InputError, match="must be positive"):
        windio.write_torsion(turbine, turbine.with_name("b"), Torsion(0.0, 1.0))
    with pytest.raises(InputError, match="there is no such file"):
        windio.write_torsion(turbine.with_name("none"), turbine.with_name("b"), NEW)


@pytest.mark.needs("windIO")
def test_windio_reads_its_own_example_with_ours_in_it(tmp_path: Path) -> None:
    import windIO

    source = Path(windIO.__file__).parent / "examples" / "turbine" / "IEA-15-240-RWT.yaml"
    target = tmp_path / "iea15.yaml"
    windio.write_torsion(source, target, NEW, "windio")
    assert set(windio.read_torsion(source).values()) == {69737644923.05057, 49372801.61198211}
    windIO.validate(target, "turbine/turbine_schema")
    elastic = windIO.load_yaml(target)["components"]["drivetrain"]["elastic_properties"]
    assert (elastic["spring_constant"], elastic["damping_coefficient"]) == NEW


@pytest.mark.needs("wisdem")
def test_wisdem_takes_the_override_from_a_turbine_file(tmp_path: Path) -> None:
    """WISDEM's own reader, and its component of the drivetrain's torsion, that reads it there."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        import openmdao.api as om
        import wisdem
        from wisdem.drivetrainse.drive_components import DriveDynamics
        from wisdem.inputs import load_geometry_yaml

        examples = Path(wisdem.__file__).parents[1] / "examples" / "02_reference_turbines"
        source = examples / "IEA-3p4-130-RWT.yaml"
        if not source.exists():
            pytest.skip("WISDEM's examples are not installed")
        target = tmp_path / "turbine.yaml"
        windio.write_torsion(source, target, Torsion(8.7e7, 1.5e5))
        drivetrain = load_geometry_yaml(str(target))["components"]["drivetrain"]
        problem = om.Problem(reports=False)
        problem.model.add_subsystem("torsion", DriveDynamics(), promotes=["*"])
        problem.setup()
        problem["lss_spring_constant"], problem["gear_ratio"] = 6e8, 1.0
        problem.run_model()
        assert problem["drivetrain_spring_constant"] == 6e8
        for key in ("spring_constant_user", "damping_coefficient_user"):
            problem[f"drivetrain_{key}"] = drivetrain[key]
        problem.run_model()
    assert problem["drivetrain_spring_constant"] == 8.7e7
    assert problem["drivetrain_damping_coefficient"] == 1.5e5
