"""Solids that bolts hold together: joined round the holes alone, in one STEP file and as parts."""

import itertools

import gmsh
import numpy as np
import pytest
from scipy import sparse
from scipy.sparse.linalg import LinearOperator, eigsh

from fe_drivetrain.common.cache import Cache
from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.drivetrain_file.reading import change_scene, parse_scene
from fe_drivetrain.elasticity.mesh.bodies import connected_bodies
from fe_drivetrain.elasticity.mesh.files import write
from fe_drivetrain.elasticity.mesh.measures import area, volume
from fe_drivetrain.elasticity.operator.incompressible import assemble_unlocked
from fe_drivetrain.elasticity.solve import direct_solvers
from fe_drivetrain.foreign.further_parts import placed_part
from fe_drivetrain.foreign.housing import placed_housing
from fe_drivetrain.geometry import (
    Bearing,
    BoltedJoint,
    ForeignHousing,
    MeshSizes,
    gmsh_session,
)
from fe_drivetrain.geometry.step_files import write_step
from fe_drivetrain.shafts.fidelity.bearing_units import unit_stiffness
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

pytestmark = pytest.mark.usefixtures("kept_between_runs")

BEARING = Bearing(kind="ring")
SIZES = MeshSizes(shaft=0.3, bearing=0.2, housing=0.25, bearing_edge=0.2, elements_per_turn=8)
HOLE, WIDE = 0.03, 0.09  # radius of the bolts' holes, diameter that they press [m]
PLACES = list(itertools.product((-0.08, 0.08), (-0.37, 0.37)))  # x, y of the cap's bolts
RING = np.pi * (WIDE**2 / 4 - HOLE**2)  # m^2
BOLTED = {"hole_radius": 1e3 * HOLE, "pressed_diameter": 1e3 * WIDE}
BOLTED_M = {key: 1e-3 * value for key, value in BOLTED.items()}


def bored(box, places, low, high, seat=True):
    """A box (x, y, z, dx, dy, dz) with holes along z, and the bearing's bore."""
    occ = gmsh.model.occ
    holes = [(3, occ.addCylinder(x, y, low, 0, 0, high - low, HOLE)) for x, y in places]
    if seat:
        holes.append((3, occ.addCylinder(-1, 0, 0, 2, 0, 0, 0.3)))
    ((_, tag),), _ = occ.cut([(3, occ.addBox(*box))], holes)
    return tag


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """Cap on base; a block on a plate as one file, and the plate alone, its holes in the plate."""
    folder = tmp_path_factory.mktemp("bolted")
    paths = {name: folder / f"{name}.step" for name in ("split", "both", "block", "plate")}
    base, cap = (-0.15, -0.45, -0.42, 0.3, 0.9, 0.42), (-0.15, -0.45, 0.0, 0.3, 0.9, 0.42)
    feet = list(itertools.product((-0.08, 0.08), (-0.35, 0.35)))
    plate = (-0.3, -0.6, -0.62, 0.6, 1.2, 0.2)
    with gmsh_session():
        write_step(paths["split"], [bored(b, PLACES, -0.1, 0.1) for b in (base, cap)])
    whole = (-0.15, -0.45, -0.42, 0.3, 0.9, 0.84)
    for name in ("both", "block", "plate"):
        with gmsh_session():
            made = []
            if name != "plate":
                made.append(bored(whole, feet, -0.5, -0.3))
            if name != "block":
                made.append(bored(plate, feet, -0.7, -0.3, seat=False))
            write_step(paths[name], made)
    return paths


def housing(path, held=-420, **more):
    held = [{"point": [0, 0, held], "normal": [0, 0, 1]}]
    return ForeignHousing(step=str(path), seat={"radius": 300}, held=held, **more)


def placed(path, bolted, **more):
    return placed_housing(housing(path, bolted=bolted, **more), BEARING, SIZES).mesh


def test_both_sides_of_an_open_joint_have_nodes_of_their_own(files):
    mesh, part = placed(files["split"], BOLTED), "main_bearing.housing"
    glued = placed(files["split"], None)
    assert volume(mesh) == pytest.approx(volume(glued), rel=1e-3)
    sides = [mesh.faces[f"{part}.joint {k}"] for k in (1, 2)]
    joint = 2 * 0.15 * 0.3 - 4 * np.pi * HOLE**2
    for k in (1, 2):
        assert area(mesh, f"{part}.joint {k}") == pytest.approx(joint - 4 * RING, rel=5e-3)
    shared = np.intersect1d(*sides)
    assert np.allclose(mesh.points[np.concatenate(sides)].reshape(-1, 3)[:, 2], 0.0, atol=1e-9)
    # what they share is the rim of the annuli
    away = np.array(PLACES)[None] - mesh.points[shared][:, None, :2]
    assert np.allclose(np.linalg.norm(away, axis=2).min(axis=1), WIDE / 2, rtol=1e-6)
    assert len(shared) < 0.5 * len(np.unique(sides[0]))
    above = [mesh.points[mesh.cells[np.isin(mesh.cells, s).any(axis=1)]][..., 2] for s in sides]
    assert connected_bodies(mesh.cells, len(mesh.points)).max() == 0
    assert {bool(z.max() > 1e-9) for z in above} == {True}  # cells of the annuli touch both
    assert area(mesh, f"{part}.seat") == pytest.approx(np.pi * 0.6 * 0.3, rel=2e-3)


def test_an_open_joint_keeps_six_free_motions_and_no_more(files):
    mesh = placed(files["split"], BOLTED)
    K = assemble_unlocked(mesh.points, mesh.cells, MATERIALS["steel"].lame, mesh.points.size)
    shift = 1e-6 * K.diagonal().mean()
    shifted = (K + shift * sparse.eye_array(len(mesh.points) * 3)).tobsr((3, 3))
    factor = direct_solvers.factorise(shifted, "superlu")
    inverse = LinearOperator(K.shape, lambda x: factor.apply(x.reshape(-1, 1)), dtype=float)
    values = eigsh(K, 8, sigma=-shift, OPinv=inverse, return_eigenvectors=False)
    values = np.sort(np.abs(values))
    assert values[5] < 1e-6 * values[6]


SCENE = """
title: bolted
shaft: {{front: -1.0, sections: [{{length: 2.2, outer_diameter: 0.4}}]}}
bearing_units:
  - bearing: {{name: main_bearing, kind: ring, raceway_diameter: 0.6}}
    housing: {{step: {file}, seat: {{radius: 300}}, held: [{held}]{more}}}
    interface: bonded
gearbox: {{stiffness: [0, 0, 0, 0, 0, 0]}}
mesh: {{shaft: 0.3, bearing: 0.2, housing: 0.25, bearing_edge: 0.2, elements_per_turn: 8}}
"""
FOOT, UNDER = ({"point": [0, 0, z], "normal": [0, 0, 1]} for z in (-420, -620))  # mm
UNIT = "bearing_units.main_bearing"


def scene(file, held=FOOT, bolted=None):
    more = f", bolted: {bolted}" if bolted else ""
    return parse_scene(SCENE.format(file=file, held=held, more=more))


def compliance(one):
    """(6,) of the seat, which moves on average."""
    K = unit_stiffness(one, "main_bearing", "averaged", "auto", cache=Cache(None))
    return np.diag(np.linalg.inv(K))


def test_the_more_bolts_press_the_stiffer_up_to_the_glued_joint(files):
    found = [
        compliance(scene(files["split"], bolted=BOLTED | {"pressed_diameter": wide}))
        for wide in (75, 90, 3000)
    ]
    glued = compliance(scene(files["split"]))
    for more, less in itertools.pairwise(found):
        assert (more > less * (1 - 1e-3)).all()
    # pulled up, the cap hangs on its bolts
    assert found[0][2] > 1.01 * found[2][2]
    assert found[2] == pytest.approx(glued, rel=1e-3)


def on_plate(files, bolted, **source):
    """The block on the plate as a further part."""
    scale = 1e-3 if source else 1  # of picks in a mesh in m
    top, under = ({"point": [0, 0, scale * z], "normal": [0, 0, 1]} for z in (-420, -620))
    part = {"name": "plate", "material": "ductile_iron", "held": [under]}
    part |= source or {"step": str(files["plate"])}
    tie = {"face": top} | ({"bolted": bolted} if bolted else {})
    keys = {f"{UNIT}.stands_on": "parts", f"{UNIT}.housing.held": []}
    return change_scene(scene(files["block"]), keys | {f"{UNIT}.parts": [part | {"tied": [tie]}]})


@pytest.fixture(scope="module")
def bolted(files):
    """Compliance of the block with the plate bolted to it."""
    return compliance(on_plate(files, BOLTED))


def test_a_bolted_part_gives_as_the_same_solids_in_one_file(files, bolted):
    glued = compliance(on_plate(files, None))
    for tied, joint in ((glued, None), (bolted, BOLTED)):
        one = compliance(scene(files["both"], UNDER, joint))
        assert tied == pytest.approx(one, rel=0.02)
    assert (bolted > glued * (1 - 1e-3)).all()
    assert bolted[4] > 1.1 * glued[4]


def test_an_assembly_of_bolted_parts_is_in_balance(files):
    one = on_plate(files, BOLTED)
    response = unit_load_response(build_model(one, mesh_scene(one)))
    assert response.equilibrium_error < 1e-8


def test_a_bolted_part_from_a_mesh_is_joined_round_the_same_holes(files, bolted, tmp_path):
    one = on_plate(files, BOLTED)
    (part,) = one.bearing_units[0].parts
    mesh = placed_part(part, one.bearing_units[0].bearing, one.mesh).mesh
    assert area(mesh, "main_bearing.plate.tie 1") == pytest.approx(4 * RING, rel=5e-3)
    write(mesh, str(tmp_path / "plate.msh"))
    again = on_plate(files, BOLTED_M, mesh=str(tmp_path / "plate.msh"), unit="m")
    assert compliance(again) == pytest.approx(bolted, rel=1e-6)


def refused(sentence, make):
    with pytest.raises(InputError, match=sentence) as error:
        make()
    assert str(error.value).count(". ") == 0


def test_a_joint_that_cannot_be_is_refused_in_one_sentence(files, tmp_path):
    odd = BOLTED | {"hole_radius": 29}
    refused("no hole of radius 29 mm ends on a face between", lambda: placed(files["split"], odd))
    refused("no hole of radius 30 mm ends on a face", lambda: placed(files["block"], BOLTED))
    refused("no hole of radius 29 mm ends on tied face 1", lambda: mesh_scene(on_plate(files, odd)))
    narrow = {"hole_radius": 30, "pressed_diameter": 60}
    refused("pressed_diameter is 60 but must be greater", lambda: BoltedJoint(**narrow))
    mesh = {"mesh": "a.msh", "unit": "m", "seat": {"radius": 0.3}, "bolted": BOLTED}
    refused("joins solids of one STEP file: give the part as STEP", lambda: ForeignHousing(**mesh))
    one = {"step": "a.step", "part": "cap", "seat": {"radius": 0.3}, "bolted": BOLTED}
    refused("joins solids of one STEP file: leave out part", lambda: ForeignHousing(**one))
    third = tmp_path / "third.step"
    with gmsh_session():
        base, cap = (-0.15, -0.45, -0.42, 0.3, 0.9, 0.42), (-0.15, -0.45, 0.0, 0.3, 0.9, 0.42)
        lid = gmsh.model.occ.addBox(-0.1, -0.1, 0.42, 0.2, 0.2, 0.1)
        write_step(third, [*(bored(b, PLACES, -0.1, 0.1) for b in (base, cap)), lid])
    refused(r"the solid round \(0, 0, 470\) mm is joined to the", lambda: placed(third, BOLTED))
