"""Patches with a spectral coarse space, on tubes and shafts that are thin and slender."""

import numpy as np
import pytest
from scipy import linalg

from fe_drivetrain.common.errors import InputError
from fe_drivetrain.drivetrain_file.materials import MATERIALS
from fe_drivetrain.elasticity.interfaces.constraints import (
    eliminate,
    fixed,
    rigid_face,
    rigid_point,
)
from fe_drivetrain.elasticity.mesh.generation import generate
from fe_drivetrain.elasticity.mesh.hexahedra import shaft_hexahedra
from fe_drivetrain.elasticity.operator.elasticity import assemble
from fe_drivetrain.elasticity.solve import cost_model, direct_solvers, multigrid, schwarz, solvers
from fe_drivetrain.elasticity.solve.reduction import System, reduce
from fe_drivetrain.elasticity.solve.subdomains import dense_part
from fe_drivetrain.geometry import MeshSizes, Section, Shaft


def cantilever(diameter, wall, length, size, turn, nodes=27):
    """A tube held at the rear; six unit loads at its rigid front."""
    bore = diameter - 2.0 * wall
    section = Section(length=length, outer_diameter=diameter, inner_diameter=bore)
    shaft = Shaft(sections=[section], front=0.0)
    if nodes == 10:
        mesh = generate(shaft, [], {}, MeshSizes(shaft=size, elements_per_turn=turn))
        points, cells = mesh.points, mesh.cells
        front, rear = (mesh.face_nodes(f"shaft.{end}") for end in ("front", "rear"))
    else:
        mesh = shaft_hexahedra(shaft, size, nodes, elements_per_turn=turn)
        points, cells, front, rear = mesh.points, mesh.cells, mesh.front, mesh.rear
    n = points.size
    hub = rigid_point("hub", np.zeros(3), n, n + 6)
    constraints = [fixed("wall", rear, n + 6), rigid_face("face", front, points, hub)]
    elimination = eliminate(constraints, n + 6)
    K = assemble(points, cells, MATERIALS["steel"].lame, n + 6)
    F = np.zeros((n + 6, 6))
    F[n + np.arange(6), np.arange(6)] = 1.0
    return reduce(points, cells, K, elimination), elimination.T.T @ F


@pytest.fixture(scope="module")
def tube():
    """Wall 1/75 of the radius."""
    return cantilever(3.0, 0.02, 3.0, 0.8, 10)


@pytest.fixture(scope="module")
def patches(tube):
    """Of the tube."""
    return schwarz.build(tube[0])


def iterations(system, F, options=schwarz.DEFAULTS):
    made = schwarz.build(system, options)
    found = multigrid.conjugate_gradients(system.K, F, made.precondition, 1e-9)
    assert found.energy_error <= 1e-9
    return found


def energy_error(system, F, x):
    factor = direct_solvers.factorise(system.K, "superlu")
    exact = factor.apply(F)
    exact += factor.apply(F - system.K @ exact)
    energy = [np.einsum("nm,nm->m", v, system.K @ v) for v in (x - exact, exact)]
    return float(np.sqrt(energy[0] / energy[1]).max())


def test_preconditioner_is_symmetric_and_positive(tube, patches, rng):
    system, _ = tube
    R = rng.standard_normal((system.K.shape[0], 6))
    Z = patches.precondition(R)
    products = R.T @ Z
    np.testing.assert_allclose(products, products.T, atol=1e-8 * np.abs(products).max())
    assert linalg.eigvalsh(0.5 * (products + products.T))[0] > 0.0


@pytest.mark.parametrize("thinness", [20, 75, 400])
def test_iterations_do_not_grow_with_thinness(thinness):
    system, F = cantilever(3.0, 1.5 / thinness, 3.0, 0.8, 10)
    found = iterations(system, F)
    assert found.iterations < 60
    assert energy_error(system, F, found.x) < 3e-9 * max(1.0, (thinness / 40) ** 2)


@pytest.mark.parametrize("slenderness", [20, 100])
def test_iterations_do_not_grow_with_slenderness(slenderness):
    system, F = cantilever(0.7, 0.175, 0.7 * slenderness, 0.7 * slenderness / 12, 8)
    assert iterations(system, F).iterations < 60


def test_multigrid_fails_where_patches_hold(tube):
    """Or else patches would not be needed."""
    system, F = tube
    hierarchy = multigrid.build(system)
    found = multigrid.conjugate_gradients(system.K, F, hierarchy.precondition, 1e-9)
    assert found.energy_error > 1e-9


@pytest.mark.parametrize("nodes", [8, 20, 10])
def test_other_elements(nodes):
    system, F = cantilever(0.7, 0.2, 2.0, 0.2, 8, nodes)
    found = iterations(system, F)
    assert found.iterations < 60
    assert energy_error(system, F, found.x) < 2e-9


def test_a_joint_between_bodies(spherical_responses):
    model, _ = spherical_responses["averaged"]
    elimination = eliminate(model.constraints, model.n_dofs)
    system = reduce(model.mesh.points, model.mesh.cells, model.stiffness, elimination)
    found = iterations(system, elimination.T.T @ model.unit_loads()[:, :2])
    assert found.iterations < 100


def test_coarse_stiffness_is_the_galerkin_product(tube, patches):
    """Of the modes as `prolong` spreads them."""
    system, _ = tube
    made, parts = patches, patches.partition
    first = np.concatenate([[0], np.cumsum(made.counts)])
    V = np.empty((system.K.shape[0], made.n_coarse))
    where = parts.blocks, parts.starts, made.modes, made.mode_starts, first
    schwarz.prolong(*where, np.eye(made.n_coarse), V)
    small = np.random.default_rng(1).standard_normal((made.n_coarse, 2))
    product = V.T @ (system.K @ (V @ made.coarse.apply(small)))
    np.testing.assert_allclose(product, small, atol=1e-6)
    back = np.zeros((made.n_coarse, 2))
    R = np.random.default_rng(2).standard_normal((len(V), 2))
    schwarz.restrict(*where, R, back)
    np.testing.assert_allclose(back, V.T @ R, atol=1e-9 * np.abs(back).max())


def test_patches_are_solved_exactly(tube, patches, rng):
    system, _ = tube
    made, parts = patches, patches.partition
    R = rng.standard_normal((system.K.shape[0], 2))
    out = np.empty_like(R)
    schwarz.solve_patches(parts.blocks, parts.starts, made.factors, made.factor_starts, R, out)
    own = parts.blocks_of(3)
    place = np.full(len(parts.patch), -1)
    place[own] = np.arange(len(own))
    A = dense_part(system.K.indptr, system.K.indices, system.K.data, own, place)
    dofs = (3 * own[:, None] + np.arange(3)).ravel()
    np.testing.assert_allclose(A @ out[dofs], R[dofs], atol=1e-7)


@pytest.mark.parametrize("n_inner", [0, 6])
def test_soft_modes_are_those_of_the_pencil(rng, n_inner):
    """Against a dense generalised eigenvalue problem."""
    n = 12
    B = rng.standard_normal((n - 4, n))
    S = B.T @ B  # four soft motions that cost nothing
    edge = np.arange(n) >= n_inner
    G = rng.standard_normal((n - n_inner, n - n_inner))
    A = S.copy()
    A[n_inner:, n_inner:] += G @ G.T
    values = linalg.eigh(S, A, eigvals_only=True)
    threshold = 0.5 * (values[5] + values[6])
    modes = schwarz.soft_modes(S, A, edge, threshold)
    assert modes.shape[1] == 6
    np.testing.assert_allclose(modes.T @ A @ modes, np.eye(6), atol=1e-9)
    np.testing.assert_allclose(linalg.eigvalsh(modes.T @ S @ modes), values[:6], atol=1e-8)


def test_a_larger_threshold_takes_fewer_iterations(tube):
    system, F = tube
    few, many = (schwarz.Options(threshold=t) for t in (0.03, 0.3))
    assert schwarz.build(system, few).n_coarse < schwarz.build(system, many).n_coarse
    assert iterations(system, F, many).iterations < iterations(system, F, few).iterations


def test_without_elements_there_are_no_patches(tube):
    system, _ = tube
    bare = System(system.K, system.prolongation, system.near_nullspace, system.body, system.n_free)
    with pytest.raises(InputError, match="has none"):
        schwarz.build(bare)


def test_patches_take_the_place_of_multigrid_where_no_factor_fits(tube, monkeypatch):
    """Two GiB, of which a factor is told to need more."""
    system, F = tube
    costly = {m: d._replace(bytes=1e12) for m, d in cost_model.DIRECT.items()}
    monkeypatch.setattr("fe_drivetrain.elasticity.solve.cost_model.DIRECT", costly)
    monkeypatch.setattr(
        "fe_drivetrain.elasticity.solve.cost_model.available_memory", lambda: 2.0 * 2**30
    )
    solution = solvers.solve(system, F, "multigrid")
    assert solution.diagnostics.method == "schwarz"
    assert "multigrid stopped" in solution.diagnostics.reason
    assert energy_error(system, F, solution.x) < 1e-8
    assert solvers.solve(system, F).diagnostics.method == "schwarz"
