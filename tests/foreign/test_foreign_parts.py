"""Several solids of a STEP file, glued; further parts, tied to housings: placed, and as stiff."""

import json
import shutil

import gmsh
import meshio
import numpy as np
import pytest

from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.drivetrain_file.reading import change_scene, parse_scene, read_scene
from fe_drivetrain.elasticity.interfaces.constraints import eliminate
from fe_drivetrain.elasticity.mesh.bodies import connected_bodies
from fe_drivetrain.elasticity.mesh.facets import face_weights
from fe_drivetrain.elasticity.mesh.measures import area, volume
from fe_drivetrain.elasticity.mesh.mesh import boundary
from fe_drivetrain.elasticity.mesh.side_by_side import beside
from fe_drivetrain.elasticity.operator.incompressible import assemble_unlocked
from fe_drivetrain.foreign.assembly import solids_of_unit
from fe_drivetrain.foreign.further_parts import placed_part, slave_first, tie_of, touching
from fe_drivetrain.foreign.housing import placed_housing
from fe_drivetrain.foreign.reading import read_in_process
from fe_drivetrain.foreign.step_solid import opened
from fe_drivetrain.geometry import (
    Bearing,
    ForeignHousing,
    FurtherPart,
    MeshSizes,
    gmsh_session,
    write_sample,
)
from fe_drivetrain.geometry.step_files import write_step
from fe_drivetrain.shafts.fidelity.bearing_units import unit_stiffness
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

pytestmark = pytest.mark.usefixtures("kept_between_runs")

BEARING = Bearing(kind="ring")
SIZES = MeshSizes(shaft=0.3, bearing=0.2, housing=0.25, bearing_edge=0.2, elements_per_turn=8)


def written(path, *boxes, bore=False):
    """Boxes (x, y, z, dx, dy, dz) [m] as solids of one STEP file, with a bore of 0.6 m about x."""
    occ = gmsh.model.occ
    with gmsh_session():
        tags = [occ.addBox(*box) for box in boxes]
        if bore:
            for tag in tags:
                occ.cut([(3, tag)], [(3, occ.addCylinder(-1, 0, 0, 2, 0, 0, 0.3))])
        occ.synchronize()
        write_step(path, [t for _, t in occ.getEntities(3)])
    return path


def test_the_same_part_is_the_same_file(tmp_path):
    """Whenever it is written, so that its mesh is found under the file's content."""
    files = [tmp_path / "one.step", tmp_path / "two.step"]
    for file in files:
        written(file, (0, 0, 0, 1, 1, 1))
        assert gmsh_date(file) == "1970-01-01T00:00:00"
    one, two = (file.read_bytes() for file in files)
    assert one == two


def gmsh_date(file):
    """The second entry of the header's FILE_NAME."""
    return file.read_text().split("FILE_NAME(", 1)[1].split("'")[3]


BASE, CAP = (-0.15, -0.45, -0.42, 0.3, 0.9, 0.42), (-0.15, -0.4, 0.0, 0.3, 0.8, 0.4)


@pytest.fixture(scope="module")
def split(tmp_path_factory):
    """A base and a narrower cap round a bore, which touch in two planes at its height."""
    return written(tmp_path_factory.mktemp("parts") / "split.step", BASE, CAP, bore=True)


def housing(path, **more):
    held = [{"point": [0, 0, -420], "normal": [0, 0, 1]}]
    return ForeignHousing(step=str(path), seat={"radius": 300}, held=held, **more)


def test_solids_that_touch_are_one_body_with_one_seat(split):
    placed = placed_housing(housing(split), BEARING, SIZES)
    mesh, part = placed.mesh, "main_bearing.housing"
    exact = 0.3 * (0.9 * 0.42 + 0.8 * 0.4) - np.pi * 0.3**2 * 0.3
    assert placed.facts["solids"] == 2
    assert placed.facts["volume after healing [m^3]"] == pytest.approx(exact, rel=1e-9)
    assert volume(mesh) == pytest.approx(exact, rel=2e-3)
    assert connected_bodies(mesh.cells, len(mesh.points)).max() == 0
    assert area(mesh, f"{part}.seat") == pytest.approx(np.pi * 0.6 * 0.3, rel=2e-3)
    assert area(mesh, f"{part}.base") == pytest.approx(0.9 * 0.3, rel=1e-9)
    # neither cap nor base has an outer face left in the joint, but where the base is wider
    at_joint = np.abs(mesh.points[:, 2]) < 1e-9
    within = np.abs(mesh.points[:, 1]) < 0.4 + 1e-9
    owners = [
        np.isin(np.flatnonzero(at_joint & within), mesh.cells[side])
        for side in (
            mesh.points[mesh.cells[:, :4], 2].mean(axis=1) > 0,
            mesh.points[mesh.cells[:, :4], 2].mean(axis=1) < 0,
        )
    ]
    assert owners[0].all()
    assert owners[1].all()
    assert owners[0].size > 10


def test_a_gap_of_rounding_is_closed_and_one_solid_alone_is_taken_by_name(tmp_path):
    lifted = (*CAP[:2], 2e-7, *CAP[3:])
    path = written(tmp_path / "gap.step", BASE, lifted)
    with gmsh_session():
        both = opened(str(path))
        assert both["after"]["solids"] == 2
        # six faces each; the base's upper one in three, of which one is the joint
        assert len(both["faces"]) == 12
    with gmsh_session():
        alone = opened(str(path), part="solid 2")
        assert alone["after"]["volume"] == pytest.approx(0.3 * 0.8 * 0.4 * 1e9, rel=1e-6)
    with gmsh_session(), pytest.raises(InputError, match=r"0 solids are named 'cap'.*solid 2"):
        opened(str(path), part="cap")


@pytest.mark.parametrize(
    ("box", "words"),
    [
        ((2, 0, 0, 1, 1, 1), r"of 1e\+09 mm\^3 round \(2500, 500, 500\) mm touches none"),
        ((1, 1, 0, 1, 1, 1), "touches none of the others in a face"),  # along an edge alone
        ((0.5, 0, 0, 1, 1, 1), r"overlap in 5e\+08 mm\^3 round \(750, 500, 500\) mm"),
    ],
)
def test_solids_that_are_loose_or_overlap_are_refused_with_their_place(tmp_path, box, words):
    path = written(tmp_path / "two.step", (0, 0, 0, 1, 1, 1), box)
    with gmsh_session(), pytest.raises(InputError, match=words) as error:
        opened(str(path))
    assert str(error.value).count(". ") == 0


def test_the_sample_of_cap_and_base_is_the_split_housing_cut_in_two(tmp_path):
    cut = write_sample("cap_and_base", tmp_path / "cut.step")
    whole = write_sample("split_housing", tmp_path / "whole.step")
    assert cut == pytest.approx(whole, rel=1e-9)
    found = read_in_process("look", tmp_path / "cut.step", {"smallest_detail": 0.0})
    survey = json.loads(str(found["survey"]))
    assert [s["volume"] for s in survey["solids"]] == pytest.approx(
        [8.42472e7, 3.41073e7], rel=1e-5
    )
    assert survey["seats"][0]["length"] == pytest.approx(300)
    assert len(survey["seats"]) == 13


# two blocks on one another, meshed apart


def block(path, size, tie, **more):
    part = FurtherPart(
        name=path.stem, step=str(path), material="steel", tied=[{"face": tie}], **more
    )
    return placed_part(part, BEARING, SIZES.model_copy(update={"housing": size})).mesh


@pytest.fixture(scope="module")
def tied_blocks(tmp_path_factory):
    """A column of 1 m on a larger slab of another mesh, and the tie between them."""
    folder = tmp_path_factory.mktemp("blocks")
    column = written(folder / "column.step", (0, 0, 0, 1, 1, 1))
    slab = written(folder / "slab.step", (0, 0, -0.5, 1, 1, 0.5))
    mesh = beside(
        block(column, 0.45, {"point": [0, 0, 0], "normal": [0, 0, 1]}),
        block(slab, 0.6, {"point": [0, 0, 0], "normal": [0, 0, 1]}),
    )
    face = mesh.faces["main_bearing.column.tie 1"]
    other = touching("tie", mesh.points, face, boundary(mesh, "main_bearing.slab"))
    return mesh, tie_of("tie", mesh.points, face, other), face, other


def reduced(mesh, tie):
    lame = MATERIALS["steel"].lame
    K = assemble_unlocked(mesh.points, mesh.cells, lame, mesh.points.size)
    T = eliminate([tie], mesh.points.size).T
    kept = np.flatnonzero(np.diff(T.tocsc().indptr))
    T = T.tocsc()[:, kept]
    return T, (T.T @ K @ T).toarray()


def test_tied_blocks_have_six_free_motions_and_no_more(tied_blocks):
    mesh, tie, *_ = tied_blocks
    T, K = reduced(mesh, tie)
    values = np.linalg.eigvalsh(K)
    assert np.count_nonzero(values < 1e-9 * values[-1]) == 6
    motions = rigid_motions(mesh.points, np.zeros(3))
    assert np.abs(tie.rows @ motions).max() < 1e-12
    assert T.shape[1] == mesh.points.size - len(tie.pivots)


def test_a_uniform_stress_passes_the_tie_to_rounding(tied_blocks):
    mesh, tie, *_ = tied_blocks
    T, K = reduced(mesh, tie)
    steel, n = MATERIALS["steel"], len(mesh.points)
    outside = boundary(mesh)
    F = np.zeros((n, 3))
    for z, pull in ((1.0, 1.0), (-0.5, -1.0)):
        end = outside[np.abs(mesh.points[outside, 2] - z).max(axis=1) < 1e-9]
        F[:, 2] += pull * face_weights(mesh.points, end, n)
    u = (T @ (np.linalg.pinv(K, rcond=1e-11) @ (T.T @ F.ravel()))).reshape(-1, 3)
    E, nu = steel.youngs_modulus, steel.poisson_ratio
    exact = mesh.points * np.array([-nu, -nu, 1.0]) / E
    motions = rigid_motions(mesh.points, np.zeros(3))
    away = (u - exact).ravel()
    away -= motions @ np.linalg.lstsq(motions, away, rcond=None)[0]
    assert np.abs(away).max() < 1e-9 * np.abs(exact).max()


def test_the_finer_of_equal_faces_is_the_slave_else_the_covered_one(tied_blocks, tmp_path):
    mesh, _, face, other = tied_blocks
    assert slave_first(mesh.points, other, face)[0] is face
    wide = written(tmp_path / "wide.step", (-1, -1, -0.5, 3, 3, 0.5))
    on = beside(mesh, block(wide, 0.6, {"point": [0, 0, 0], "normal": [0, 0, 1]}))
    top = on.faces["main_bearing.wide.tie 1"]
    found = touching("tie", on.points, top, boundary(on, "main_bearing.column"))
    assert np.allclose(on.points[found][..., 2], 0.0)
    assert len(found) == len(face)
    assert slave_first(on.points, top, found)[0] is found


@pytest.mark.parametrize(
    ("box", "words"),
    [
        ((0.5, 0, -0.5, 1, 1, 0.5), "50 % of the face lies on it, and neither covers the other"),
        ((5, 0, -0.5, 1, 1, 0.5), "touches nothing there, the nearest node is"),
        ((0, 0, -0.505, 1, 1, 0.5), r"lie 0.005 m apart, but must touch within 0.000\d+ m"),
    ],
)
def test_faces_that_do_not_fit_are_refused_in_one_sentence(tied_blocks, tmp_path, box, words):
    mesh, *_ = tied_blocks
    other = written(tmp_path / "other.step", box)
    tie = {"point": [0, 0, 1000 * (box[2] + box[5])], "normal": [0, 0, 1]}
    both = beside(mesh, block(other, 0.6, tie))
    face = both.faces["main_bearing.other.tie 1"]
    with pytest.raises(InputError, match=words) as error:
        tie_of(
            "a",
            both.points,
            face,
            touching("a", both.points, face, boundary(both, "main_bearing.column")),
        )
    assert str(error.value).count(". ") == 0


def perforated(n, radii, up=True):
    """Nodes (z = 0) and facets between a round hole and polygons round it, n edges a turn."""
    angles = 2 * np.pi * np.arange(n) / n
    ray = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=1)
    corners = np.concatenate([radius * ray for radius in radii])
    a, b = (n * np.arange(len(radii) - 1)[:, None] + (np.arange(n) + step) % n for step in (0, 1))
    triangles = np.concatenate(
        [np.stack(t, -1).reshape(-1, 3) for t in ((a, a + n, b + n), (a, b + n, b))]
    )
    triangles = triangles if up else triangles[:, ::-1]
    edges = np.sort(triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    ends, middle = np.unique(edges, axis=0, return_inverse=True)
    middles = corners[ends].mean(axis=1)
    rim = (ends < n).all(axis=1)
    middles[rim] *= radii[0] / np.linalg.norm(middles[rim], axis=1)[:, None]
    facets = np.hstack([triangles, len(corners) + middle.reshape(-1, 3)])
    return np.concatenate([corners, middles]), facets


def on_one_another(one, two):
    (points, face), (others, other) = one, two
    return np.concatenate([points, others]), face, other + len(points)


@pytest.mark.parametrize(
    ("own", "other", "relaxed"),
    [(6, 6, 1), (12, 12, 1), (12, 12, 12), (12, 8, 1), (6, 16, 0), (8, 12, 0), (16, 12, 0)],
)
def test_rims_of_one_hole_may_be_divided_and_curved_in_their_own_ways(own, other, relaxed):
    hole = 0.5
    near = 1.05 * hole / np.cos(2 * np.pi / own)  # there the facets at the rim are nearly flat
    foot, facets = perforated(own, (hole, near, 1.5), up=False)
    for k in range(relaxed):  # middles of edges are drawn half way to their chords
        turn = 2 * np.pi * (k + 0.5) / own
        middle = np.linalg.norm(foot - [hole * np.cos(turn), hole * np.sin(turn), 0], axis=1)
        foot[middle.argmin()] *= (1 + np.cos(np.pi / own)) / 2
    points, face, under = on_one_another((foot, facets), perforated(other, (hole, 1.2, 3.0)))
    assert touching("tie", points, under, face).tolist() == face.tolist()
    found = touching("tie", points, face, under)
    assert slave_first(points, found, face)[0] is face
    tied = np.unique(tie_of("tie", points, face, found).pivots // 3)
    assert tied.tolist() == np.unique(face).tolist()


@pytest.mark.parametrize(
    ("foot", "plate"),
    [((0.39, 0.7, 1.0), (0.4, 0.7, 3.0)), ((0.4, 0.7, 1.002), (0.3, 0.7, 1.0))],
)
def test_what_reaches_over_a_hole_or_an_edge_is_refused_beside_curved_rims(foot, plate):
    one, other = perforated(24, foot, up=False), perforated(24, plate)
    points, face, under = on_one_another(one, other)
    for picked, outside in ((face, under), (under, face)):
        with pytest.raises(InputError, match="and neither covers the other whole"):
            touching("tie", points, picked, outside)


# scenes

SCENE = """
title: a housing on a plate
shaft: {{front: -1.0, sections: [{{length: 2.2, outer_diameter: 0.4}}]}}
bearing_units:
  - bearing: {{name: main_bearing, kind: ring}}
    housing: {housing}
    interface: bonded
    {parts}
gearbox: {{stiffness: [0, 0, 0, 0, 0, 0]}}
materials: {{rigid: {{youngs_modulus: {E}, poisson_ratio: 0.3, density: 7850}}}}
mesh: {{shaft: 0.3, bearing: 0.2, housing: 0.25, bearing_edge: 0.2, elements_per_turn: 8}}
"""
FOOT, UNDER = (f"{{point: [0, 0, {z}], normal: [0, 0, 1]}}" for z in (-420, -620))
PLATE = f"""parts:
      - {{name: plate, step: PATH, material: MATERIAL, tied: [{{face: {FOOT}}}], held: [{UNDER}]}}
    stands_on: parts"""


@pytest.fixture(scope="module")
def plate(tmp_path_factory):
    """A plate of 200 mm that is larger than the foot of the parametric block, which it is under."""
    box = (-0.4, -0.8, -0.62, 0.8, 1.6, 0.2)
    return written(tmp_path_factory.mktemp("plate") / "plate.step", box)


def scene(parts="", housing="{}", E=2.1e11):
    return parse_scene(SCENE.format(parts=parts, housing=housing, E=E))


def on_plate(plate, material="steel", **more):
    parts = PLATE.replace("PATH", str(plate)).replace("MATERIAL", material)
    return scene(parts, **more)


def stiffness(one):
    return unit_stiffness(one, "main_bearing", "rigid", "superlu", cache=Cache(None))


def test_a_housing_on_a_plate_is_softer_and_tends_to_the_fixed_foot(plate):
    fixed = stiffness(scene())
    K = [stiffness(on_plate(plate, "rigid", E=E)) for E in (2.1e11, 1e12, 1e13)]
    for softer, stiffer in ((K[0], K[1]), (K[1], K[2]), (K[2], fixed)):
        gain = np.linalg.eigvalsh(stiffer - softer)
        assert gain[0] > -1e-6 * np.abs(stiffer).max()
    away = [np.abs(k - fixed).max() / np.abs(fixed).max() for k in K]
    assert away[0] > 0.05
    # what the plate gives falls as one over its modulus
    assert away[2] == pytest.approx(away[1] / 10, rel=0.1)


def test_a_plate_that_a_collar_of_the_shaft_reaches_is_refused_by_assembly_and_unit(plate):
    """Its top is 0.42 m under the axis; the collar is clear of the housing, from x = 0.25 m on."""
    clear = on_plate(plate)
    for diameter, reaches in ((0.8, False), (0.9, True)):
        lengths = ((1.25, 0.4), (0.1, diameter), (0.85, 0.4))
        sections = [{"length": length, "outer_diameter": d} for length, d in lengths]
        one = change_scene(clear, {"shaft.sections": sections})
        if not reaches:
            mesh_scene(one)
            continue
        for solve in (mesh_scene, stiffness):
            with pytest.raises(InputError, match=r"overlaps the shaft: at x = 0\.\d+ m it"):
                solve(one)


def test_an_assembly_on_a_plate_is_in_balance_and_weighs_all_its_parts(plate):
    one = on_plate(plate)
    model = build_model(one, mesh_scene(one))
    response = unit_load_response(model, "superlu")
    assert response.equilibrium_error < 1e-8
    assert response.reactions["main_bearing"][2, 8] == pytest.approx(
        sum(mass.sum() for mass in model.part_mass.values()), rel=1e-9
    )
    assert model.part_mass["main_bearing.plate"].sum() == pytest.approx(
        0.8 * 1.6 * 0.2 * 7850, rel=1e-9
    )
    base = model.mesh.points[model.mesh.face_nodes("main_bearing.housing.base")]
    assert np.allclose(base[:, 2], -0.62)
    solid = solids_of_unit(one.bearing_units[0], 0.4, one.mesh)["main_bearing.plate"]
    assert solid.volume == pytest.approx(0.8 * 1.6 * 0.2, rel=1e-9)
    assert np.allclose(solid.centre, (0, 0, -0.52))


def test_a_mesh_file_and_a_chain_of_parts_stand_as_one_plate(plate, tmp_path):
    whole = stiffness(on_plate(plate))
    upper = written(tmp_path / "upper.step", (-0.4, -0.8, -0.52, 0.8, 1.6, 0.1))
    lower = placed_part(
        FurtherPart(
            name="lower",
            step=str(written(tmp_path / "lower.step", (-0.4, -0.8, -0.62, 0.8, 1.6, 0.1))),
            tied=[{"face": {"point": [0, 0, -520], "normal": [0, 0, 1]}}],
        ),
        BEARING,
        SIZES,
    ).mesh
    meshio.write(tmp_path / "lower.vtu", meshio.Mesh(lower.points, [("tetra10", lower.cells)]))
    parts = f"""parts:
      - {{name: upper, step: {upper}, material: steel, tied: [{{face: {FOOT}}}]}}
      - name: lower
        mesh: {tmp_path}/lower.vtu
        unit: m
        material: steel
        tied: [{{face: {{point: [0, 0, -0.52], normal: [0, 0, 1]}}, to: upper}}]
        held: [{{point: [0, 0, -0.62], normal: [0, 0, 1]}}]
    stands_on: parts"""
    halves = stiffness(scene(parts))
    scale = np.sqrt(np.outer(whole.diagonal(), whole.diagonal()))
    assert np.abs((halves - whole) / scale).max() < 0.01


def test_a_part_beside_a_fixed_foot_stiffens(tmp_path):
    arm = written(tmp_path / "arm.step", (-0.12, 0.625, -0.41, 0.24, 0.4, 0.08))
    part = (
        f"parts: [{{name: arm, step: {arm}, tied: [{{face: {{point: [0, 625, -370], "
        "normal: [0, 1, 0]}}], held: [{point: [0, 1025, -370], normal: [0, 1, 0]}]}]"
    )
    alone, held = stiffness(scene()), stiffness(scene(part))
    loose = stiffness(
        scene(part.replace(", held: [{point: [0, 1025, -370], normal: [0, 1, 0]}]", ""))
    )
    assert np.linalg.eigvalsh(held - loose)[0] > -1e-6 * np.abs(alone).max()
    assert held[1, 1] > loose[1, 1] > alone[1, 1]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("name: plate", "name: housing", "none of housing, outer, bore"),
        ("tied: [{face", "tied: [{to: foot, face", "is tied to 'foot', but must be tied to one of"),
        ("tied: [{face", "tied: [{to: plate, face", "is tied to 'plate', but must be"),
        (f", held: [{UNDER}]", "", "stands on parts, of which none has a held face"),
        ("material: steel", "material: wood", "material 'wood' of main_bearing.plate is unknown"),
        ("plate.step", "plate.stl", r"of part 'plate' must end in .step or .stp"),
        (f"tied: [{{face: {FOOT}}}]", "tied: []", "tied"),
        (UNDER, "{label: FOOT, point: [0, 0, 0]}", "a pick of a face has the keys"),
    ],
)
def test_a_wrong_part_is_refused_when_the_scene_is_read(plate, old, new, words):
    text = PLATE.replace("PATH", str(plate)).replace("MATERIAL", "steel")
    assert old in text
    with pytest.raises(InputError, match=words):
        scene(text.replace(old, new))


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("    stands_on: parts", "", "face that the ground holds, too: give stands_on: parts"),
        (UNDER, FOOT, r"the face round \(.*\) mm is picked twice"),
        (UNDER, "{radius: 20}", "there is no face for the held face: no bore has radius 20"),
        ("material", "translate: [0, 0, -0.01], material", "lie 0.01 m apart"),
        ("material", "unit: m, material", "elements of 0.25 mm make about"),
    ],
)
def test_a_part_that_does_not_fit_is_refused_before_any_level(plate, old, new, words):
    text = PLATE.replace("PATH", str(plate)).replace("MATERIAL", "steel")
    one = scene(text.replace(old, new))
    with pytest.raises(InputError, match=words):
        build_model(one, mesh_scene(one))


def test_parts_are_looked_for_beside_the_scene_and_changed_by_their_names(plate, tmp_path):
    text = PLATE.replace("PATH", "plate.step").replace("MATERIAL", "steel")
    (tmp_path / "mine.yaml").write_text(SCENE.format(parts=text, housing="{}", E=2.1e11))
    with pytest.raises(InputError, match=r"plate\.step: there is no such file"):
        read_scene(tmp_path / "mine.yaml")
    shutil.copy(plate, tmp_path / "plate.step")
    one = read_scene(tmp_path / "mine.yaml")
    assert one.bearing_units[0].parts[0].file == str(tmp_path / "plate.step")
    changes = {"bearing_units.main_bearing.parts.plate.material": "ductile_iron"}
    assert change_scene(one, changes).material_name("main_bearing.plate") == "ductile_iron"


def test_a_housing_from_a_file_stands_on_parts_without_held_faces(split, plate):
    given = f"{{step: {split}, seat: {{radius: 300}}HELD}}"
    parts = PLATE.replace("PATH", str(plate)).replace("MATERIAL", "steel")
    one = scene(parts, given.replace("HELD", ""))
    model = build_model(one, mesh_scene(one))
    assert unit_load_response(model, "superlu").equilibrium_error < 1e-8
    with pytest.raises(InputError, match="stands on parts and its housing has held faces"):
        scene(parts, given.replace("HELD", f", held: [{FOOT}]"))
    with pytest.raises(InputError, match="stands on the ground and its housing has no held face"):
        scene("", given.replace("HELD", ""))


def test_a_command_ends_with_status_2_and_one_sentence_on_a_part_that_does_not_fit(
    plate, tmp_path, invoke
):
    text = PLATE.replace("PATH", str(plate)).replace("MATERIAL", "steel")
    text = text.replace("material", "translate: [0, 0, -0.01], material")
    (tmp_path / "mine.yaml").write_text(SCENE.format(parts=text, housing="{}", E=2.1e11))
    status, _, error = invoke("check", str(tmp_path / "mine.yaml"))
    assert status == 2
    assert "the two faces lie 0.01 m apart, but must touch within" in error
    assert "Traceback" not in error
