"""A housing that is a stiffness alone stands in a scene as the solid that it was condensed from."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene, parse_scene
from fe_drivetrain.export.condensed_housing import condensed_housing
from fe_drivetrain.export.files import write_superelement
from fe_drivetrain.export.superelement import Superelement
from fe_drivetrain.shafts.fidelity.bearing_units import unit_bounds, unit_stiffness
from fe_drivetrain.shafts.fidelity.ladder import housing_springs, shaft_level
from fe_drivetrain.shafts.response.model import build_model, mesh_scene
from fe_drivetrain.shafts.response.unit_loads import unit_load_response

NAME = "main_bearing"
ROWS = np.diag([4e9, 3e9, 8e9, 5e8, 9e7, 8e7])
ROWS[0, 4] = ROWS[4, 0] = 5e7


def on_stiffness(rows=ROWS, **changes):
    housing = {"stiffness": np.asarray(rows).tolist()}
    return change_scene(coarse_scene("bonded"), {"bearing_units.0.housing": housing, **changes})


@pytest.fixture(scope="module")
def model():
    scene = on_stiffness()
    return build_model(scene, mesh_scene(scene))


def test_the_assembly_is_in_balance_and_has_no_housing(model):
    assert model.mesh.part_names == ("shaft", NAME)
    response = unit_load_response(model, "superlu")
    assert response.equilibrium_error < 1e-8
    carried = ROWS @ response.motions[f"{NAME}.ground"]
    assert np.allclose(
        carried, response.reactions[NAME], rtol=1e-7, atol=1e-7 * np.abs(carried).max()
    )


def test_the_beam_level_agrees_with_the_assembly(model):
    scene = model.scene
    reaction = unit_load_response(model, "superlu").reactions[NAME]
    springs, _ = housing_springs(scene)
    beam = shaft_level(scene, 2, springs).reaction_matrices[NAME]
    assert beam[2, 2] == pytest.approx(reaction[2, 2], rel=0.01)
    assert beam[4, 4] == pytest.approx(reaction[4, 4], rel=0.03)


def test_its_stiffness_is_given_with_no_band(model):
    assert np.allclose(unit_stiffness(model.scene, NAME), ROWS, rtol=1e-12)
    bounds = unit_bounds(model.scene, NAME)
    assert bounds.mesh.largest == 0.0
    assert np.array_equal(bounds.soft, bounds.stiff)


def test_a_joint_is_in_series_with_it():
    spring = {
        "bearing_units.0.interface": "spring",
        "bearing_units.0.stiffness": [1e9] * 3 + [1e8] * 3,
    }
    K = unit_stiffness(on_stiffness(np.diag([1e9] * 6), **spring), NAME)
    assert np.allclose(K.diagonal(), [5e8] * 3 + [1e9 / 11] * 3)


@pytest.mark.parametrize("format", ["json", "csv"])
def test_a_superelement_of_a_solid_housing_stands_in_its_place(tmp_path, invoke, format):
    solid = coarse_scene("bonded")
    K = unit_stiffness(solid, NAME)
    element = Superelement("unit", (NAME,), np.zeros((1, 3)), K, supported=True)
    write_superelement(tmp_path / f"unit.{format}", element, format)
    status, out, _ = invoke("part", f"unit.{format}")
    assert status == 0
    rows = (
        parse_scene(
            "title: t\nshaft: {front: -1.0, sections: [{length: 2.2, outer_diameter: 0.4}]}\n"
            f"bearing_units:\n  - bearing: {{name: {NAME}, kind: ring}}\n    interface: bonded\n"
            + out[out.index("    housing:") :]
            + "gearbox: {stiffness: [0, 0, 0, 0, 0, 0]}\n"
        )
        .bearing_units[0]
        .housing.matrix
    )
    assert np.allclose(rows, K, rtol=1e-12, atol=1e-12 * np.abs(K).max())


def test_a_free_superelement_is_condensed_to_its_bore():
    k, length = 3e8, 0.5  # a bar of springs between two points along x
    arm = np.eye(6)
    arm[1, 5], arm[2, 4] = length, -length
    bar = k * np.eye(6)
    K = np.block([[bar, -bar @ arm], [-arm.T @ bar, arm.T @ bar @ arm]])
    positions = np.array([[0.0, 0, 0], [-length, 0, 0]])
    element = Superelement("bar", ("bore", "foot"), positions, K)
    assert np.allclose(condensed_housing(element, "bore", ["foot"]).matrix, bar)
    with pytest.raises(InputError, match="must hold every motion"):
        condensed_housing(element, "bore")
    with pytest.raises(InputError, match="no point 'top'"):
        condensed_housing(element, "top")


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        (ROWS + np.triu(np.full((6, 6), 1e9), 1), "must be symmetric"),
        (np.diag([1e9, 1e9, 1e9, 0.0, 1e8, 1e8]), "must hold every motion"),
        (-ROWS, "must hold every motion"),
    ],
)
def test_what_is_no_stiffness_of_a_housing_is_refused(rows, words):
    with pytest.raises(InputError, match=words):
        on_stiffness(rows)
