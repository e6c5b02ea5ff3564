"""One bedplate under two housings: their supports are coupled, the same at every level."""

import gmsh
import numpy as np
import pytest

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.common.spatial import resultant, wrench_transport
from fe_drivetrain.drivetrain_file.component import Attachment
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.drivetrain_file.reading import change_scene, parse_scene
from fe_drivetrain.elasticity.interfaces import constraints
from fe_drivetrain.elasticity.interfaces.constraints import dofs
from fe_drivetrain.elasticity.solve.coupled_solid import coupled_solid, point_motions_of
from fe_drivetrain.foreign.further_parts import placed_part
from fe_drivetrain.geometry import Bearing, FurtherPart, Housing, MeshSizes, gmsh_session
from fe_drivetrain.geometry.step_files import write_step
from fe_drivetrain.shafts.fidelity.bearing_units import unit_bounds, unit_stiffness
from fe_drivetrain.shafts.fidelity.coupled_units import coupled_stiffness
from fe_drivetrain.shafts.fidelity.ladder import housing_springs, shaft_level, statics_level
from fe_drivetrain.shafts.response.influence_fields import (
    influences_of_all_reactions,
    reaction_influences,
)
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

pytestmark = pytest.mark.usefixtures("kept_between_runs")

SCENE = """
title: two housings on one bedplate
shaft: {{front: -1.0, sections: [{{length: 3.2, outer_diameter: 0.4}}]}}
bearing_units:
  - bearing: {{name: front, kind: ring, raceway_diameter: 0.6, width: {width}}}
    {joint}
    housing: {{material: {housing}}}
    stands_on: parts
    parts:
      - name: bedplate
        step: {path}
        material: {material}
        tied:
          - {{face: {{point: [0, 0, -420], normal: [0, 0, 1]}}, to: housing}}
          - {{face: {{point: [0, 0, -420], normal: [0, 0, 1]}}, to: rear.housing}}
        held: [{{point: [-400, 0, -500], normal: [-1, 0, 0]}}]
  - bearing: {{name: rear, x: 1.5, kind: ring, raceway_diameter: 0.6, width: {width}}}
    {joint}
    housing: {{material: {housing}}}
    stands_on: parts
gearbox: {{stiffness: [0, 0, 0, rigid, 0, 0]}}
materials:
  soft: {{youngs_modulus: 1.0e10, poisson_ratio: 0.3, density: 7850}}
  hard: {{youngs_modulus: 1.0e12, poisson_ratio: 0.3, density: 7850}}
  harder: {{youngs_modulus: 1.0e13, poisson_ratio: 0.3, density: 7850}}
mesh: {{shaft: 0.3, bearing: 0.2, housing: 0.3, bearing_edge: 0.2, elements_per_turn: 8}}
"""
JOINTS = {
    "bonded": "interface: bonded",
    "rigid": "interface: spring\n    stiffness: [rigid, rigid, rigid, rigid, rigid, rigid]",
    "soft": "interface: spring\n    stiffness: [1e9, 2e9, 3e9, 0, 1e8, 1e8]",
}
GROUP, X = ("front", "rear"), (0.0, 1.5)


def plate():
    return gmsh.model.occ.addBox(-0.4, -0.8, -0.72, 2.3, 1.6, 0.3)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("plate") / "plate.step"
    with gmsh_session():
        write_step(path, [plate()])
    return path


def scene_of(file, joint="bonded", material="steel", width=0.2, housing="ductile_iron"):
    given = {"material": material, "width": width, "housing": housing}
    return parse_scene(SCENE.format(path=file, joint=JOINTS[joint], **given))


def together(scene, coupling="rigid"):
    found = coupled_stiffness(scene, GROUP, coupling)
    return np.vstack([found[name] for name in GROUP])


def test_tied_housings_give_as_one_solid_of_everything(file, tmp_path):
    """Housings and bedplate glued in one STEP file, meshed and condensed by itself."""
    K = together(scene_of(file, "rigid", "ductile_iron", width=0.3))
    places = dict(zip(GROUP, X, strict=True))
    ring = {"kind": "ring", "raceway_diameter": 0.6, "width": 0.3}
    bearings = [Bearing(name=name, x=x, **ring) for name, x in places.items()]
    with gmsh_session():
        blocks = [Housing().build(bearing).volume for bearing in bearings]
        gmsh.model.occ.synchronize()
        write_step(tmp_path / "all.step", [*blocks, plate()])
    one = FurtherPart(
        name="all",
        step=str(tmp_path / "all.step"),
        tied=[{"face": {"point": [1000 * x, 0, 300]}, "to": n} for n, x in places.items()],
        held=[{"point": [-400, 0, -500], "normal": [-1, 0, 0]}],
    )
    given = []
    for size in (0.3, 0.15):
        mesh = placed_part(one, bearings[0], MeshSizes(housing=size, elements_per_turn=8)).mesh
        at = [
            Attachment(n, f"front.all.tie {k}", np.array([x, 0, 0]), "averaged")
            for k, (n, x) in enumerate(places.items(), 1)
        ]
        solid = coupled_solid(mesh, {"front.all": MATERIALS["ductile_iron"]}, at)
        base = constraints.fixed("base", mesh.face_nodes("front.all.held"), solid.n_dofs)
        given.append(point_motions_of(solid, [base])[1])
    scale = np.sqrt(np.outer(*2 * [given[1].diagonal()]))
    by_mesh = np.abs((given[0] - given[1]) / scale).max()
    away = np.abs((np.linalg.inv(K) - given[0]) / scale).max()
    assert np.abs(given[0][:6, 6:] / scale[:6, 6:]).max() > 0.3  # one moves the other
    assert away < by_mesh


def test_a_bedplate_that_does_not_give_couples_nothing(file):
    """1000 times as stiff as the housings, it leaves what these give on the ground."""
    # coarser meshes of the same housings apart and together differ by more than is asked here
    sizes = {"mesh.housing": 0.2}
    ground = change_scene(
        scene_of(file, housing="soft"),
        sizes
        | {
            f"bearing_units.{name}.{key}": value
            for name in GROUP
            for key, value in (("stands_on", "ground"), ("parts", []))
        },
    )
    apart = np.zeros((12, 12))
    for k, name in enumerate(GROUP):
        rows = slice(6 * k, 6 * k + 6)
        apart[rows, rows] = np.linalg.inv(unit_stiffness(ground, name, "rigid"))
    scale = np.sqrt(np.outer(*2 * [apart.diagonal()]))
    off = []
    for material in ("soft", "hard", "harder"):
        scene = change_scene(scene_of(file, material=material, housing="soft"), sizes)
        given = np.linalg.inv(together(scene))
        assert np.linalg.eigvalsh((given - apart) / scale)[0] > -1e-3  # it gives only more
        off.append(np.abs((given - apart) / scale).max())
    assert off[0] > 0.5
    assert off[1] < 0.02 * off[0]
    assert off[1] / off[2] == pytest.approx(10, rel=0.1)


def test_a_soft_joint_is_in_series_with_each_housing(file):
    """Compliances of joints add to that of all solids, where joints carry; else nothing does."""
    rigid, soft = (together(scene_of(file, joint)) for joint in ("rigid", "soft"))
    carried = [k for k in range(12) if k % 6 != 3]
    joint = np.tile([1e9, 2e9, 3e9, np.inf, 1e8, 1e8], 2)
    free = np.ix_(carried, carried)
    expected = np.linalg.inv(np.linalg.inv(rigid)[free] + np.diag(1 / joint[carried]))
    scale = np.sqrt(np.outer(*2 * [expected.diagonal()]))
    assert np.abs((soft[free] - expected) / scale).max() < 1e-9
    assert np.abs(soft[[3, 9]]).max() < 1e-15 * soft.max()


@pytest.fixture(scope="module")
def solved(file):
    scene = scene_of(file)
    model = build_model(scene, mesh_scene(scene))
    return scene, model, unit_load_response(model, "superlu")


def test_both_feet_of_the_assembly_are_in_balance_with_what_is_held(solved):
    _, model, response = solved
    assert response.equilibrium_error < 1e-9
    part, mesh = "front.housing", model.mesh
    U = np.vstack([response.displacements.reshape(-1, 10), np.zeros((model.n_dofs, 10))])
    U = U[: model.n_dofs]
    forces = model.part_stiffness[part] @ U - model.part_loads(part)
    foot = mesh.face_nodes("front.housing.tie bedplate 1")
    own = -resultant(mesh.points[foot], forces[dofs(foot)], np.zeros(3))
    bedplate = model.part_mass["front.bedplate"]
    weight = np.zeros((6, 10))
    centre = bedplate @ mesh.points / bedplate.sum()
    weight[:, 6:9] = bedplate.sum() * wrench_transport(centre)[:, :3]
    expected = response.reactions["front"]
    assert np.abs(own + weight - expected).max() < 1e-8 * np.abs(expected).max()
    # what goes through the shaft's seats is what stands on the feet, but for the units' weight
    for name in GROUP:
        hub = response.reactions[f"{name}.seat"][:, :6]
        assert np.abs(hub - response.reactions[name][:, :6]).max() < 1e-7 * np.abs(hub).max()


def test_cheap_levels_agree_with_the_assembly_between_their_bounds(solved):
    scene, _, response = solved
    bounds = []
    for coupling in ("rigid", "averaged"):
        level = shaft_level(scene, 2, housing_springs(scene, coupling)[0])
        bounds.append(level)
        assert "what a bedplate gives under the weight of its housing" in level.neglects
    fixed = shaft_level(scene, 2).reaction_matrices  # rigid supports: what coupling is about
    for name in GROUP:
        for k, load in ((2, 2), (2, 4), (1, 1), (1, 5)):
            ends = sorted(level.reaction_matrices[name][k, load] for level in bounds)
            assert ends[0] < response.reactions[name][k, load] < ends[1]
            assert not ends[0] < fixed[name][k, load] < ends[1]
    soft = bounds[1].compliance.diagonal()[:6]
    assert (response.motions["hub"][:, :6].diagonal() < soft).all()
    total = sum(
        wrench_transport(np.array([x, 0, 0])) @ bounds[0].reaction_matrices[name][:, :6]
        for name, x in zip(GROUP, X, strict=True)
    )
    gearbox = wrench_transport(np.array([2.2, 0, 0])) @ bounds[0].reaction_matrices["gearbox"]
    applied = wrench_transport(np.array([-1.0, 0, 0]))
    assert np.abs(total + gearbox[:, :6] - applied).max() < 1e-6
    assert set(statics_level(scene).reaction_matrices) == {*GROUP, "gearbox"}


def test_influence_functions_give_the_reactions_of_both(solved):
    """Betti: each load puts on a support what a motion of that support moves it by."""
    _, model, response = solved
    F = model.unit_loads()
    every = influences_of_all_reactions(model, "superlu")
    n = 3 * len(model.mesh.points)
    for name in GROUP:
        expected = response.reactions[name]
        within = 1e-8 * np.abs(expected).max(axis=0)
        one = reaction_influences(model, name, range(6), "superlu")
        assert (np.abs(one.T @ F - expected) <= within).all()
        assert (np.abs(every[name].T @ F[:n] - expected) <= within).all()


def test_what_takes_a_unit_by_itself_says_that_it_cannot(solved):
    scene, _, _ = solved
    for asked in (lambda: unit_stiffness(scene, "rear"), lambda: unit_bounds(scene, "front")):
        with pytest.raises(InputError, match="front, rear stand on the same parts"):
            asked()


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"bearing_units.rear.stands_on": "ground"}, "both stand on parts"),
        ({"bearing_units.front.parts.0.tied.1.to": "aft.housing"}, "there is no such solid"),
        ({"bearing_units.front.parts.0.tied.1.to": "housing"}, "'rear' stands on parts"),
        ({"bearing_units.rear.bedplate": [1e9] * 6}, "a bedplate of springs"),
    ],
)
def test_a_scene_that_cannot_be_is_refused_in_one_sentence(file, change, sentence):
    with pytest.raises(InputError, match=sentence):
        change_scene(scene_of(file), change)
