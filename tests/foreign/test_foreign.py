"""Housings from STEP and mesh files: found, placed, tied, held, and as stiff as the same solid."""

import json
import math
import re

import gmsh
import meshio
import numpy as np
import pytest

from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.steps import Steps
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.drivetrain_file.reading import parse_scene, read_scene
from fe_drivetrain.elasticity.mesh.files import write
from fe_drivetrain.elasticity.mesh.measures import area, volume
from fe_drivetrain.foreign.assembly import bolt_stiffness, mesh_parts, solids_of_unit
from fe_drivetrain.foreign.housing import placed_housing
from fe_drivetrain.foreign.reading import read_in_process
from fe_drivetrain.geometry import (
    Bearing,
    ForeignHousing,
    Housing,
    MeshSizes,
    gmsh_session,
    unit_solids,
)
from fe_drivetrain.geometry.step_files import write_step
from fe_drivetrain.shafts.fidelity.bearing_units import unit_stiffness
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

pytestmark = pytest.mark.usefixtures("kept_between_runs")

BEARING = Bearing(kind="ring")
COARSE = MeshSizes(shaft=0.3, bearing=0.12, housing=0.14, bearing_edge=0.12, elements_per_turn=8)
SCENE = """
title: own housing
shaft: {{front: -1.0, sections: [{{length: 2.2, outer_diameter: 0.4}}]}}
bearing_units:
  - bearing: {{name: main_bearing, kind: ring}}
    housing: {{{housing}}}
    {joint}
gearbox: {{stiffness: [0, 0, 0, 0, 0, 0]}}
mesh: {{shaft: 0.3, bearing: 0.12, housing: 0.14, bearing_edge: 0.12, elements_per_turn: 8}}
"""
SPRING = "interface: spring\n    stiffness: [1e10, 1e10, 1e10, 1e8, 1e8, 1e8]"
FOOT = "{point: [0, 0, -420], normal: [0, 0, 1]}"
NO_CACHE = Cache(None)


def scene(housing="", joint="interface: bonded"):
    return parse_scene(SCENE.format(housing=housing, joint=joint))


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """The bolted block as STEP, its faces named and one red, and turned and moved; as meshes."""
    folder = tmp_path_factory.mktemp("foreign")
    with gmsh_session():
        solid = Housing(base="bolted").build(BEARING)
        write_step(folder / "block.step", [solid.volume])
    text = (folder / "block.step").read_text()
    count = iter(range(1, 100))
    text = re.sub(r"ADVANCED_FACE\(''", lambda _: f"ADVANCED_FACE('F{next(count)}'", text)
    face = re.search(r"(#\d+) = ADVANCED_FACE\('F3'", text)[1]
    context = re.search(r"(#\d+) = \( GEOMETRIC_REPRESENTATION_CONTEXT", text)[1]
    style = f"""#9000=COLOUR_RGB('',1.,0.,0.);
#9001=FILL_AREA_STYLE_COLOUR('',#9000);
#9002=FILL_AREA_STYLE('',(#9001));
#9003=SURFACE_STYLE_FILL_AREA(#9002);
#9004=SURFACE_SIDE_STYLE('',(#9003));
#9005=SURFACE_STYLE_USAGE(.BOTH.,#9004);
#9006=PRESENTATION_STYLE_ASSIGNMENT((#9005));
#9007=STYLED_ITEM('color',(#9006),{face});
#9008=MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#9007),{context});
ENDSEC;
END-ISO"""
    (folder / "named.step").write_text(text.replace("ENDSEC;\nEND-ISO", style))
    with gmsh_session():
        solid = Housing(base="bolted").build(BEARING).volume
        occ = gmsh.model.occ
        occ.rotate([(3, solid)], 0, 0, 0, 0, 0, 1, math.radians(90))
        occ.translate([(3, solid)], 1.0, -2.0, 0.5)
        write_step(folder / "turned.step", [solid])
    unit = scene(joint=SPRING).bearing_units[0]
    alone = unit.model_copy(update={"bearing": BEARING.model_copy(update={"bore_diameter": 0.4})})
    mesh = mesh_parts(None, [alone], COARSE)
    for ending in ("msh", "vtu"):
        write(mesh, folder / f"unit.{ending}")
    part = "main_bearing.housing"
    nodes = mesh.part_nodes(part)
    sets = {
        name.upper(): np.searchsorted(nodes, mesh.face_nodes(f"{part}.{name}"))
        for name in ("bore", "base")
    }
    cells = np.searchsorted(nodes, mesh.cells[mesh.part_cells(part)])
    body = meshio.Mesh(1000 * mesh.points[nodes], [("tetra10", cells)], point_sets=sets)
    meshio.write(folder / "unit.inp", body)
    return folder


def step_housing(files, name="block.step", **more):
    given = {"seat": {"radius": 300}, "held": [{"point": [0, 0, -420], "normal": [0, 0, 1]}]}
    return ForeignHousing(step=str(files / name), **(given | more))


@pytest.fixture(scope="module")
def survey(files):
    shown: list[str] = []
    with Steps(lambda step, lane=0: shown.append(step)).step("read"):
        found = read_in_process("look", files / "named.step", {"smallest_detail": 0.0})
    return json.loads(str(found["survey"])), found, shown


def test_the_process_that_reads_tells_what_it_does_to_how_many_faces(survey):
    *_, shown = survey
    assert shown[0] == "read"
    assert shown[-1] == "read: looking for bores and planes in 18 faces"


def test_a_step_file_is_read_in_mm_with_its_volume_labels_colours_and_seats(survey):
    found, arrays, _ = survey
    exact = unit_solids(BEARING, Housing(base="bolted"), 0.4)[1].volume
    for when in ("before", "after"):
        assert found[when]["solids"] == 1
        assert found[when]["volume"] == pytest.approx(1e9 * exact, rel=1e-9)
    assert [face["label"] for face in found["faces"]] == [f"F{k}" for k in range(1, 19)]
    assert [f["label"] for f in found["faces"] if f["colour"] == "#ff0000"] == ["F3"]
    widest, *bolts = found["seats"]
    assert widest["kind"] == "Cylinder"
    assert widest["radius"] == pytest.approx(300)
    assert widest["length"] == pytest.approx(300)
    assert np.allclose(widest["centre"], 0, atol=1e-6)
    assert np.allclose(np.abs(widest["axis"]), [1, 0, 0])
    assert [(round(b["radius"], 6), round(b["length"], 6)) for b in bolts] == 4 * [(26, 100)]
    box = np.ptp(arrays["points"], axis=0)
    assert np.allclose(box, [360, 1250, 830], rtol=2e-3)


def test_a_placed_solid_has_the_volume_the_seat_and_the_washers_of_the_block(files):
    bolts = {"hole_radius": 26, "washer_diameter": 92}
    placed = placed_housing(step_housing(files, bolts=bolts), BEARING, COARSE)
    mesh, part = placed.mesh, "main_bearing.housing"
    assert placed.facts["bolt holes"] == 4
    assert volume(mesh) == pytest.approx(placed.facts["volume after healing [m^3]"], rel=1e-3)
    assert area(mesh, f"{part}.bore") == pytest.approx(math.pi * 0.6 * 0.2, rel=1e-3)
    assert area(mesh, f"{part}.seat") == pytest.approx(math.pi * 0.6 * 0.3, rel=1e-3)
    assert area(mesh, f"{part}.base") == pytest.approx(
        math.pi * (0.046**2 - 0.026**2) * 4, rel=2e-3
    )
    assert np.allclose(mesh.points[mesh.face_nodes(f"{part}.base"), 2], -0.42, atol=1e-12)
    bore = mesh.points[mesh.face_nodes(f"{part}.bore")]
    assert np.allclose(np.hypot(*bore[:, 1:].T), 0.3, atol=1e-9)
    assert np.abs(bore[:, 0]).max() == pytest.approx(0.1)


def test_a_part_elsewhere_in_its_file_is_turned_and_moved_to_its_bearing(files):
    here = placed_housing(step_housing(files), BEARING, COARSE).mesh
    held = [{"point": [1000, -2000, 80], "normal": [0, 0, 1]}]
    other = step_housing(files, "turned.step", rotate=[0, 0, -90], held=held)
    moved = placed_housing(other, BEARING, COARSE).mesh
    assert volume(moved) == pytest.approx(volume(here), rel=1e-4)
    low, high = (getattr(here.points, end)(axis=0) for end in ("min", "max"))
    assert np.allclose(moved.points.min(axis=0), low, atol=1e-9)
    assert np.allclose(moved.points.max(axis=0), high, atol=1e-9)
    with pytest.raises(InputError, match="90 degrees from the scene's x axis"):
        placed_housing(step_housing(files, "turned.step", held=held), BEARING, COARSE)


def test_the_same_block_from_step_is_as_stiff_within_the_error_of_its_mesh(files):
    own = unit_stiffness(scene(joint=SPRING), "main_bearing", method="superlu")
    housing = f"step: {files}/block.step, seat: {{radius: 300}}, held: [{FOOT}]"
    foreign = unit_stiffness(scene(housing, SPRING), "main_bearing", method="superlu")
    # the block stands on its whole foot, and has no bolt holes
    scale = np.sqrt(np.outer(own.diagonal(), own.diagonal()))
    assert np.abs((foreign - own) / scale).max() < 0.02


@pytest.mark.parametrize(
    "housing",
    [
        "mesh: {0}/unit.msh, unit: m, part: main_bearing.housing, translate: [0, 0, 0], "
        "seat: {{label: main_bearing.housing.bore}}, held: [{{label: main_bearing.housing.base}}]",
        "mesh: {0}/unit.msh, unit: m, part: main_bearing.housing, "
        "seat: {{radius: 0.3, axis: [1, 0, 0], point: [0, 0, 0]}}, "
        "held: [{{point: [0, 0, -0.42], normal: [0, 0, 1]}}]",
        "mesh: {0}/unit.vtu, unit: m, part: part 1, seat: {{point: [0, 0, -0.3]}}, "
        "held: [{{point: [0, 0.5, -0.42]}}]",
        "mesh: {0}/unit.inp, unit: mm, seat: {{label: BORE}}, held: [{{label: BASE}}]",
    ],
)
def test_a_mesh_of_ours_read_back_is_as_stiff_to_round_off(files, housing):
    own = unit_stiffness(scene(joint=SPRING), "main_bearing", method="superlu")
    read = unit_stiffness(
        scene(housing.format(files), SPRING), "main_bearing", method="superlu", cache=NO_CACHE
    )
    assert np.abs(read - own).max() < 1e-12 * np.abs(own).max()


def test_a_bonded_bearing_is_tied_to_its_housing_and_all_is_in_balance(files):
    housing = f"step: {files}/block.step, seat: {{radius: 300}}, held: [{FOOT}]"
    own, foreign = scene(), scene(housing)
    tilt = []
    for one in (own, foreign):
        model = build_model(one, mesh_scene(one))
        response = unit_load_response(model, "superlu")
        assert response.equilibrium_error < 1e-8
        tilt.append(response.motions["main_bearing.seat"][4, 4])
    assert tilt[1] == pytest.approx(tilt[0], rel=0.04)


def test_bolts_as_beams_are_softer_than_washers_and_they_than_the_foot(files):
    ways = (
        "",
        ", bolts: {hole_radius: 26, washer_diameter: 92}",
        ", bolts: {hole_radius: 26, washer_diameter: 92, hold: beams, diameter: 48}",
    )
    tilt = []
    for way in ways:
        housing = f"step: {files}/block.step, seat: {{radius: 300}}, held: [{FOOT}]{way}"
        K = unit_stiffness(scene(housing, SPRING), "main_bearing", method="superlu", ring=False)
        tilt.append(K[4, 4])
    assert tilt[0] > tilt[1] > tilt[2]


def test_a_scene_on_bolts_is_in_balance_and_each_bolt_carries_its_share(files):
    bolts = "bolts: {hole_radius: 26, washer_diameter: 92, hold: beams, diameter: 48}"
    housing = f"step: {files}/block.step, seat: {{radius: 300}}, held: [{FOOT}], {bolts}"
    one = scene(housing, SPRING)
    model = build_model(one, mesh_scene(one))
    response = unit_load_response(model, "superlu")
    assert response.equilibrium_error < 1e-8
    pull = 0.0
    for point, k in model.springs:
        if ".bolt " in point.name:
            pull += (k @ response.motions[point.name])[2, 2]
    assert pull == pytest.approx(1.0, rel=1e-8)  # of 1 N along z


def test_a_bolt_is_a_cantilever():
    K = bolt_stiffness(0.05, np.array([0.0, 0.0, 0.2]), np.zeros(3))
    steel = MATERIALS["steel"]
    E, nu = steel.youngs_modulus, steel.poisson_ratio
    inertia, A = math.pi * 0.05**4 / 64, math.pi * 0.05**2 / 4
    u = np.linalg.inv(K)
    assert u[2, 2] == pytest.approx(0.2 / (E * A), rel=1e-9)
    assert u[5, 5] == pytest.approx(0.2 * (1 + nu) / (E * inertia), rel=1e-9)
    shear = 0.2 * (7 + 6 * nu) / 3 / (E * A)  # Cowper 1966
    assert u[0, 0] == pytest.approx(0.2**3 / (3 * E * inertia) + shear, rel=1e-9)
    # pulled along x, the head turns about +y
    assert u[4, 0] == pytest.approx(0.2**2 / (2 * E * inertia), rel=1e-9)
    lying = bolt_stiffness(0.05, np.array([0.2, 0.0, 0.0]), np.zeros(3))
    assert np.allclose(np.linalg.eigvalsh(lying), np.linalg.eigvalsh(K))


def test_mass_and_centre_of_a_housing_from_a_file_are_those_of_the_block(files):
    housing = f"step: {files}/block.step, seat: {{radius: 300}}, held: [{FOOT}]"
    unit = scene(housing).bearing_units[0]
    ring, block = solids_of_unit(unit, 0.4, COARSE).values()
    exact_ring, exact = unit_solids(BEARING, Housing(base="bolted"), 0.4)
    assert ring.volume == pytest.approx(exact_ring.volume, rel=1e-9)
    assert block.volume == pytest.approx(exact.volume, rel=1e-3)
    assert np.allclose(block.centre, exact.centre, atol=1e-3)
    assert np.allclose(block.inertia, exact.inertia, atol=2e-3 * max(exact.inertia))


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"seat": {"radius": 301}}, "must have 0.3 m, half the bearing's raceway_diameter"),
        ({"seat": {"label": "BORE"}}, "no face has label BORE; there are F1, F10"),
        ({"seat": {"colour": "#ff0000"}}, "the seat must be a bore"),
        ({"held": [{"point": [0, 0, -400], "normal": [0, 0, 1]}]}, "no face lies at point"),
        ({"held": [{"radius": 300}]}, "a face of the seat is held, too"),
        ({"translate": [0, 0, 0.1]}, "the seat's axis is 100 mm from the bearing's centre"),
        ({"translate": [0.1, 0, 0]}, "covers 150 mm of the bearing's width of 200 mm"),
        (
            {"bolts": {"hole_radius": 30, "washer_diameter": 92}},
            "no hole of radius 30 mm ends on a held face",
        ),
    ],
)
def test_what_is_wrong_with_a_step_housing_is_said_in_one_sentence(files, changes, words):
    with pytest.raises(InputError, match=words) as error:
        placed_housing(step_housing(files, "named.step", **changes), BEARING, COARSE)
    assert str(error.value).count(". ") == 0


def test_files_are_looked_for_beside_the_scene(files, tmp_path):
    (tmp_path / "block.step").write_bytes((files / "block.step").read_bytes())
    text = SCENE.format(
        housing=f"step: block.step, seat: {{radius: 300}}, held: [{FOOT}]",
        joint="interface: bonded",
    )
    (tmp_path / "mine.yaml").write_text(text)
    assert read_scene(tmp_path / "mine.yaml").bearing_units[0].foreign.file == str(
        tmp_path / "block.step"
    )


def test_the_command_shows_bores_and_planes_and_proposes_a_housing(files, invoke, tmp_path):
    status, out, _ = invoke("part", str(files / "named.step"))
    assert status == 0
    assert "1 solid, 18 faces, 43 edges, 117.263 dm^3" in out
    assert "S1  cylinder  radius 300  length 300" in out
    assert "colour #ff0000" in out
    text = SCENE.format(housing="", joint="interface: bonded")
    proposal = out[out.index("    housing:\n") :]
    text = text.replace("    housing: {}\n", proposal)
    (tmp_path / "named.step").write_bytes((files / "named.step").read_bytes())
    (tmp_path / "mine.yaml").write_text(text)
    housing = read_scene(tmp_path / "mine.yaml").bearing_units[0].foreign
    assert volume(placed_housing(housing, BEARING, COARSE).mesh) > 0.11


def test_the_command_shows_sets_of_a_mesh(files, invoke):
    status, out, _ = invoke("part", str(files / "unit.inp"))
    assert status == 0
    assert "tetrahedra of 10 nodes" in out
    assert "sets of nodes by label: BASE, BORE" in out
