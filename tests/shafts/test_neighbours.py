"""Designs solved from what neighbours have left, beside each design for itself."""

import pickle
import weakref
from dataclasses import replace

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.reading import change_scene
from fe_drivetrain.shafts.response.model import LOADS, build_model
from fe_drivetrain.shafts.response.neighbours import EVERYTHING, NOTHING, Neighbours, Reuse
from fe_drivetrain.shafts.response.unit_loads import some_responses, unit_load_response
from fe_drivetrain.shafts.uncertainty.assembly_samples import SAMPLED_ERROR, assembly_of
from fe_drivetrain.shafts.uncertainty.input_study import study
from fe_drivetrain.shafts.uncertainty.sampling import with_values

BORE = "shaft.sections.0.inner_diameter"
STEEL, IRON = "materials.steel.youngs_modulus", "materials.ductile_iron.youngs_modulus"
SPREADS = {STEEL: {"lognormal": 0.03}, BORE: {"uniform": 0.05}}


@pytest.fixture(scope="module")
def scene():
    return coarse_scene("bonded", **{BORE: 0.1, "uncertainty": SPREADS})


def stiffness(response):
    return 1.0 / response.motions["hub"][:, :6].diagonal()


@pytest.mark.parametrize("method", ["multigrid", "superlu"])
def test_reuse_changes_nothing_on_the_same_mesh(scene, method):
    near = Neighbours()
    for bore in (0.1, 0.105, 0.11, 0.095):
        model = near.model(change_scene(scene, {BORE: bore}))
        found = unit_load_response(model, method)
        alone = unit_load_response(build_model(model.scene, model.mesh), method)
        np.testing.assert_allclose(stiffness(found), stiffness(alone), rtol=1e-9)
        for name, reaction in alone.reactions.items():
            scale = np.abs(reaction).max()
            np.testing.assert_allclose(found.reactions[name], reaction, atol=1e-7 * scale)
        assert found.equilibrium_error < 1e-7
    first, *others = near.steps
    assert first.meshed
    assert first.set_up
    for step in others:
        assert step.meshed == ""
        assert not step.set_up
        assert step.started < 0.5
    assert others[-1].iterations < max(others[0].iterations, first.iterations)


def test_a_moved_mesh_is_as_good_as_a_mesh_of_its_own(scene):
    changed = change_scene(scene, {BORE: 0.11})
    near, alone = Neighbours(), Neighbours(NOTHING)
    near.model(scene)
    moved, own = (unit_load_response(some.model(changed)) for some in (near, alone))
    finer = changed.model_copy(update={"mesh": changed.mesh.scaled(0.6)})
    exact = stiffness(unit_load_response(alone.model(finer)))
    errors = [np.abs(stiffness(r) / exact - 1.0) for r in (moved, own)]
    assert (errors[0] < 1.2 * errors[1] + 2e-3).all()


@pytest.mark.parametrize("reuse", [EVERYTHING, NOTHING])
def test_a_design_goes_when_nobody_uses_it(scene, reuse):
    near = Neighbours(reuse)
    used = []
    for bore in (0.1, 0.105, 0.11):
        model = near.model(change_scene(scene, {BORE: bore}))
        some_responses(model, range(6))
        used.append(weakref.ref(model))
        del model
    assert [one() for one in used] == [None, None, None]


def test_moduli_density_and_springs_need_no_other_mesh(scene):
    near = Neighbours()
    mesh = near.model(scene).mesh
    changes = {IRON: 1.8e11, "materials.steel.density": 7000.0, "gearbox.stiffness.1": 1e8}
    other = near.model(with_values(scene, changes | {"materials.steel.poisson_ratio": 0.29}))
    np.testing.assert_array_equal(other.mesh.points, mesh.points)
    assert near.steps[-1].stretch == 1.0


def test_all_moduli_and_springs_together_scale_the_stiffness(scene):
    near = Neighbours()
    before = some_responses(near.model(scene), range(6))[1]["hub"][:, :6]
    springs = [2.0 * k if isinstance(k, float) else k for k in scene.gearbox.stiffness]
    parts = {STEEL: "shaft", IRON: "main_bearing.housing"}
    twice = {k: 2.0 * scene.material_of(part).youngs_modulus for k, part in parts.items()}
    changed = with_values(scene, twice | {"gearbox.stiffness": springs})
    after = some_responses(near.model(changed), range(6))[1]["hub"][:, :6]
    np.testing.assert_allclose(2.0 * after, before, atol=1e-9 * np.abs(before).max())
    assert near.steps[-1].started < 1e-6  # the space has it already


def test_what_differs_much_is_meshed_and_kept_beside(scene):
    near = Neighbours()
    for bore in (0.1, 0.2, 0.205, 0.1):
        near.model(change_scene(scene, {BORE: bore}))
    assert [bool(step.meshed) for step in near.steps] == [True, True, False, False]
    assert "of its shape" in near.steps[1].meshed


def test_a_hierarchy_that_is_worn_is_made_again(scene):
    near = Neighbours()
    unit_load_response(near.model(scene), "multigrid")
    for modulus in (2e10, 2.02e10):
        changed = with_values(scene, {IRON: modulus})
        unit_load_response(near.model(changed), "multigrid")
    first, worn, after = near.steps
    assert worn.iterations > first.iterations
    assert after.set_up
    assert after.iterations < worn.iterations


def test_each_for_itself_is_what_it_was(scene):
    alone = unit_load_response(Neighbours(NOTHING).model(scene))
    near = Neighbours(Reuse(vectors=0))
    np.testing.assert_array_equal(
        unit_load_response(near.model(scene)).displacements, alone.displacements
    )


def test_another_process_begins_anew(scene):
    near = Neighbours(Reuse(vectors=3))
    near.model(scene)
    other = pickle.loads(pickle.dumps(near))
    assert other.steps == []
    assert other.reuse == near.reuse
    assert other.model(scene).mesh.cells.shape == near.model(scene).mesh.cells.shape


def test_some_loads_are_those_of_all(scene):
    model = Neighbours(NOTHING).model(scene)
    whole = unit_load_response(model)
    columns = [4, 2, LOADS.index("gearbox.weight")]
    reactions, motions = some_responses(model, columns)
    for name, found in reactions.items():
        scale = np.abs(whole.reactions[name]).max()
        np.testing.assert_allclose(
            found[:, columns], whole.reactions[name][:, columns], atol=1e-7 * scale
        )
        assert np.isnan(np.delete(found, columns, axis=1)).all()
    np.testing.assert_allclose(
        motions["hub"][:, columns], whole.motions["hub"][:, columns], rtol=1e-7, atol=1e-16
    )
    assert some_responses(model, columns, forces=False)[0] == {}


def test_samples_of_an_assembly(scene):
    load = np.zeros(len(LOADS))
    load[4] = 1e6
    found = study(scene, ["main_bearing.My"], load, level=4, count=12)
    assert found.level == 4
    exact = assembly_of(scene, ["main_bearing.My"], load)
    alone = replace(exact, neighbours=Neighbours())
    changed = with_values(
        scene, dict(zip(found.samples["main_bearing.My"].keys, (1.9e11, 0.104), strict=True))
    )
    for some in (exact, alone):
        some.evaluate(scene)
    one, other = exact.sampled(changed), alone.evaluate(changed)
    for name, value in one.items():
        assert value == pytest.approx(other[name], rel=10 * SAMPLED_ERROR)
    assert found.errors["hub.stiffness.uz"].share > 0.0
    # a shaft of steel in steel: what is left of the elasticities is iron's and the springs'
    assert 0.0 < found.slopes["hub.stiffness.ux"][STEEL] < 1.0
    assert found.slopes["hub.stiffness.rx"][BORE] < 0.0


def test_a_part_by_itself_is_refused(scene):
    with pytest.raises(InputError, match=r"no stiffness of a part by itself, shaft\.axial"):
        assembly_of(scene, ["shaft.axial"])
