"""Forces inside each part, from rows of the whole stiffness and from elements where parts meet."""

import numpy as np
import pytest
from coarse_scenes import coarse_scene

from fe_drivetrain.elasticity.operator import kernels
from fe_drivetrain.elasticity.operator.incompressible import assemble_materials, assemble_unlocked
from fe_drivetrain.shafts.response.model import Model, build_model, mesh_scene
from fe_drivetrain.shafts.response.part_forces import part_forces

RUBBER = {
    f"materials.ductile_iron.{key}": value
    for key, value in {"youngs_modulus": 1e9, "poisson_ratio": 0.48, "density": 1100.0}.items()
}


@pytest.fixture(scope="module", params=["rigid", "averaged", "rubber"])
def model(request: pytest.FixtureRequest) -> Model:
    """Springs of a gearbox on a point of its own, or on nodes; a part that averages dilatation."""
    changes = RUBBER if request.param == "rubber" else {"gearbox.coupling": request.param}
    scene = coarse_scene("bonded", **changes)
    return build_model(scene, mesh_scene(scene))


def test_forces_of_parts_are_those_of_their_own_stiffness(
    model: Model, rng: np.random.Generator
) -> None:
    U = rng.standard_normal((model.n_dofs, 3))
    found = part_forces(model, U, kernels.product(model.stiffness, U))
    assert list(found) == list(model.mesh.part_names)
    for part, K in model.part_stiffness.items():
        exact = K @ U
        np.testing.assert_allclose(found[part], exact, atol=1e-13 * np.abs(exact).max())


def test_the_whole_is_the_sum_of_its_parts_and_springs(model: Model) -> None:
    K = sum(model.part_stiffness.values()).tocsr()
    for point, k in model.springs:
        K = K + point.motion.T @ k @ point.motion
    assert abs(model.stiffness.tocsr() - K).max() <= 1e-14 * abs(K).max()
    assert model.stiffness.has_sorted_indices


def test_elements_of_no_material_have_no_stiffness(model: Model) -> None:
    mesh, lame = model.mesh, model.scene.material_of("shaft").lame
    some = mesh.part == mesh.part_names.index("shaft")
    K = assemble_materials(mesh.points, mesh.cells, [(some, lame)])
    alone = assemble_unlocked(mesh.points, mesh.cells[some], lame)
    assert abs(K - alone).max() <= 1e-14 * abs(alone).max()
