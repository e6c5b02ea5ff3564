"""Spherical joints between bearings and housings from files, against the parametric housing."""

import gmsh
import numpy as np
import pytest

from fe_drivetrain.common.spatial import rigid_motions
from fe_drivetrain.drivetrain_file.reading import parse_scene
from fe_drivetrain.elasticity.mesh.files import write
from fe_drivetrain.foreign.assembly import tied
from fe_drivetrain.geometry import Bearing, Housing, gmsh_session
from fe_drivetrain.geometry.step_files import write_step
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

pytestmark = pytest.mark.usefixtures("kept_between_runs")

FORMS = ("sliding", "averaged", "rigid")
SCENE = """
title: a spherical bearing in its own housing
shaft: {{front: -1.0, sections: [{{length: 2.2, outer_diameter: 0.4}}]}}
bearing_units:
  - {{bearing: {{name: main_bearing, kind: spherical}}, housing: {{{housing}}}, interface: {form}}}
gearbox: {{stiffness: [rigid, 1e8, 1e8, 1e8, 0, 0]}}
mesh: {{shaft: 0.3, bearing: 0.12, housing: 0.14, bearing_edge: 0.12, elements_per_turn: 8}}
"""
PART = "main_bearing.housing"


def scene(form, housing=""):
    return parse_scene(SCENE.format(form=form, housing=housing))


@pytest.fixture(scope="module")
def housings(tmp_path_factory):
    """The parametric block as a STEP file and as the mesh of its own scene, as a scene has them."""
    folder = tmp_path_factory.mktemp("spherical")
    with gmsh_session():
        solid = Housing().build(Bearing(kind="spherical")).volume
        gmsh.model.occ.synchronize()
        write_step(folder / "block.step", [solid])
    write(mesh_scene(scene("sliding")), folder / "block.msh")
    foot = "held: [{point: [0, 0, -420], normal: [0, 0, 1]}]"
    mesh = (
        f"mesh: {folder}/block.msh, unit: m, part: {PART}, translate: [0, 0, 0], seat: "
        f"{{label: {PART}.bore}}, held: [{{label: {PART}.base}}]"
    )
    return {"step": f"step: {folder}/block.step, seat: {{radius: 300}}, {foot}", "mesh": mesh}


def solved(one):
    return unit_load_response(build_model(one, mesh_scene(one)), "superlu")


@pytest.mark.parametrize("form", FORMS)
def test_a_spherical_joint_in_a_housing_from_a_file_gives_as_the_parametric_one(housings, form):
    own = solved(scene(form)).motions["hub"]
    scale = np.sqrt(np.outer(*2 * [own[:, :6].diagonal()]))
    for kind, within in (("mesh", 2e-3), ("step", 0.02)):  # the ring alone, and all is meshed again
        found = solved(scene(form, housings[kind]))
        assert found.equilibrium_error < 1e-8
        assert np.abs((found.motions["hub"][:, :6] - own[:, :6]) / scale).max() < within


def test_a_sliding_joint_over_meshes_that_differ_resists_no_rotation_and_every_displacement(
    housings,
):
    unit = scene("sliding", housings["step"]).bearing_units[0]
    mesh = mesh_scene(scene("sliding", housings["step"]))
    together = tied([unit], mesh)
    (joint,) = together.ties
    points, ring = together.mesh.points, mesh.part_nodes("main_bearing")
    moves = np.zeros((len(points), 3, 6))
    moves[ring] = rigid_motions(points, np.zeros(3)).reshape(-1, 3, 6)[ring]
    jump = joint.rows @ moves.reshape(-1, 6)
    assert np.abs(jump[:, 3:]).max() < 1e-12  # rad times m
    for k in range(3):  # the mean of a direction cosine's square over the seat is some share of one
        assert 0.05 < (jump[:, k] ** 2).mean() < 0.6
    assert len(joint.pivots) == len(np.unique(joint.pivots)) == len(jump)
